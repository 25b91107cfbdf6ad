//! A set of parameters as text on the clipboard: written as files and options have it, read as
//! people write it.

use crate::app::text::localized::Localized as _;
use pbrdf::model::{Parameter, ParameterSet, Parameters, assignments_from_text, text_from_parameters};
use tr::tr;

/// All nine, with all digits.
pub fn text(parameters: &Parameters) -> String {
    text_from_parameters(parameters, ParameterSet::ALL)
}

/// Puts the parameters that a text names in the place of those at hand, or says why not.
pub fn read(text: &str, before: Parameters) -> Result<Parameters, String> {
    let refuse = |reason: &str| {
        let text = text.trim();
        let start = text.char_indices().nth(40).map_or_else(|| text.to_owned(), |(end, _)| format!("{}…", &text[..end]));
        tr!("The pasted text {0} is no set of parameters such as n=2.07, k=2.9: {1}.", format!("{start:?}"), reason)
    };
    let assignments = assignments_from_text(&plain(text)).map_err(|error| refuse(&error.localized()))?;
    if assignments.is_empty() {
        return Err(refuse(&tr!("it is empty")));
    }
    let mut parameters = before;
    for (parameter, value) in assignments {
        parameters[parameter] = value;
    }
    Ok(parameters)
}

/// The same in the form of files: symbols as keys, a colon as an equals sign, no quotes, braces,
/// units or errors; with semicolons between the pairs, commas are decimal commas.
fn plain(text: &str) -> String {
    let rows = rows_of_table(text);
    let text = rows.as_deref().unwrap_or(text);
    let decimal_comma = text.contains(';');
    let mut plain: String = text
        .chars()
        .filter(|c| !"{}\"'".contains(*c))
        .map(|c| match c {
            ':' => '=',
            '−' => '-',
            ',' if decimal_comma => '.',
            c => c,
        })
        .collect();
    // Longer symbols first: σ is a part of σ_v.
    for parameter in [Parameter::SigmaV, Parameter::Sigma, Parameter::Ks, Parameter::Kd, Parameter::Kv] {
        plain = plain.replace(parameter.symbol(), parameter.key());
    }
    let pairs = plain.split([',', '\n', ';']).map(without_error);
    pairs.collect::<Vec<_>>().join(", ")
}

/// The pairs of a table of cells or of Markdown: a row for each parameter, its value in the next
/// cell. None where no row begins with a parameter.
fn rows_of_table(text: &str) -> Option<String> {
    let is_parameter = |name: &str| Parameter::ALL.iter().any(|parameter| name == parameter.key() || name == parameter.symbol());
    let pairs = text.lines().filter(|line| line.contains(['|', '\t'])).filter_map(|line| {
        let bare = |cell: &str| cell.trim().trim_matches(['*', '`', '$', '_']).to_owned();
        let mut cells = line.split(['|', '\t']).map(bare).filter(|cell| !cell.is_empty());
        let (name, value) = (cells.next()?, cells.next()?);
        is_parameter(&name).then(|| format!("{name}={}", if value.contains('.') { value } else { value.replace(',', ".") }))
    });
    let pairs: Vec<String> = pairs.collect();
    (!pairs.is_empty()).then(|| pairs.join("\n"))
}

/// `n=2.07` of `n=2.07 ± 0.02`, `n=2.07(2)` and `n=2.07 +0.03 −0.02 (68 %)`.
fn without_error(pair: &str) -> String {
    let Some((name, value)) = pair.split_once('=') else { return pair.to_owned() };
    // Blanks part the pairs.
    if value.contains('=') {
        return pair.to_owned();
    }
    let is_number = |value: &str| value.parse::<f64>().is_ok();
    let first = value.split_whitespace().next().unwrap_or_default();
    let first = first.split(['(', '±']).next().unwrap_or_default();
    format!("{}={}", name.trim(), if is_number(first) { first } else { value.trim() })
}

#[cfg(test)]
mod tests {
    use super::{read, text};
    use pbrdf::model::Parameters;

    #[test]
    fn what_is_copied_is_pasted_with_all_digits() {
        let parameters = Parameters { n: 0.1 + 0.2, sigma: 1e-3 / 3.0, c: -0.7, ..Parameters::default() };
        assert_eq!(read(&text(&parameters), Parameters::default()), Ok(parameters));
    }

    #[test]
    fn text_is_read_as_people_write_it() {
        let expected = Parameters { n: 2.07, k: 2.9, ..Parameters::default() };
        for given in ["n=2.07, k=2.9", "n = 2.07 , k = 2.9,", "n: 2.07\nk: 2.9\n", "n=2,07; k=2,9", "{\"n\": 2.07, \"k\": 2.9}"] {
            assert_eq!(read(given, Parameters::default()), Ok(expected), "{given:?}");
        }
        let wide = read("σ=0.5, σ_v=0.25 rad, k_d=0.2, c=−0.25", Parameters::default()).expect("symbols and units are read");
        assert_eq!((wide.sigma, wide.sigma_v, wide.kd, wide.c), (0.5, 0.25, 0.2, -0.25));
    }

    #[test]
    fn tables_and_values_with_errors_are_read() {
        let expected = Parameters { n: 2.07, k: 2.9, ..Parameters::default() };
        for given in [
            "n\t2,07\nk\t2,9",
            "n\t2.07\t0.02\nk\t2.9\tfixed",
            "| parameter | value |\n|---|---|\n| n | 2.07 ± 0.02 |\n| **k** | 2.9(1) |",
            "n=2.07 ± 0.02, k=2.9(23)",
            "n = 2.07 +0.31 −0.24 (68 %)\nk = 2.9",
            "n=2.07 k=2.9",
        ] {
            assert_eq!(read(given, Parameters::default()), Ok(expected), "{given:?}");
        }
    }

    #[test]
    fn what_is_no_set_of_parameters_is_refused_with_a_sentence() {
        for (given, expected) in [
            ("", "empty"),
            ("hello", "expected name=value"),
            ("No file dialog can open: there is neither a portal", "there is neithe…\""),
            ("m=3", "\"m\" is no parameter"),
            ("n=abc", "not a finite number"),
            ("n=1, k=-2", "k = -2 is not allowed"),
            ("q=1", "from 1.000000000001 to 1e12"),
        ] {
            let sentence = read(given, Parameters::default()).expect_err("this is not a set of parameters");
            assert!(sentence.contains(expected), "{given:?}: {sentence}");
        }
    }
}
