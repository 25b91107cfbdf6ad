//! What a fit came to, as comment lines of a table: `# fitted_n: 2.0487; 68.3 %: 2.0254 to 2.0721`.
//!
//! What simulated data say of themselves, `# n: 2.07`, is called `# simulated_n` there, so that truth and fit cannot be taken for each
//! other.

use pbrdf::fit::{Edge, Estimate, EstimateStatus, Interval};
use pbrdf::measurement::Measurement;
use pbrdf::model::Parameter;
use pbrdf::optics::shortest;
use pbrdf::rounding::significant;
use std::fmt::Display;

/// Begins the names of what was fitted.
const FITTED: &str = "fitted_";
/// Begins the names of what simulated data were made with.
const SIMULATED: &str = "simulated_";

/// The lines of a fit: its model, ΔE of Eq. (18), and each estimate by its name, `n` or `n@B.csv`.
#[must_use]
pub fn fit_comments<'a, N: Display>(
    model: &str,
    objective: Option<f64>,
    estimates: impl IntoIterator<Item = (N, &'a Estimate)>,
) -> Vec<(String, String)> {
    let head =
        [("model".to_owned(), model.to_owned()), ("delta_e".to_owned(), objective.map_or_else(|| "not defined".to_owned(), shortest))];
    let estimates = estimates.into_iter().map(|(name, estimate)| (name.to_string(), estimate_text(estimate)));
    head.into_iter().chain(estimates).map(|(key, value)| (format!("{FITTED}{key}"), value)).collect()
}

/// Value, intervals, and what there is to know of it.
fn estimate_text(estimate: &Estimate) -> String {
    let mut parts = vec![shortest(estimate.value)];
    let mut add = |level: &str, interval: Option<Interval>| {
        let end = |value: f64| significant(value, 6);
        parts.extend(interval.and_then(|interval| match (interval.low, interval.high) {
            (Some(low), Some(high)) => Some(format!("{level}: {} to {}", end(low), end(high))),
            (Some(low), None) => Some(format!("{level}: above {}", end(low))),
            (None, Some(high)) => Some(format!("{level}: below {}", end(high))),
            (None, None) => None,
        }));
    };
    add("68.3 %", estimate.interval68);
    add("95 %", estimate.interval95);
    match estimate.status() {
        EstimateStatus::Determined(error) => parts.push(format!("standard error {}", significant(error, 3))),
        EstimateStatus::Fixed => parts.push("fixed".to_owned()),
        EstimateStatus::UncertaintyUnknown => parts.push("uncertainty unknown".to_owned()),
        EstimateStatus::Undetermined => parts.push("not determined".to_owned()),
        EstimateStatus::AtBound(_) | EstimateStatus::Within(_) => {}
    }
    if let Some(edge) = estimate.at_bound {
        parts.push(if edge == Edge::Lower { "at lower bound" } else { "at upper bound" }.to_owned());
    }
    parts.join("; ")
}

/// What metadata are called in a table of a fit; none for those of an earlier fit.
fn renamed(key: &str, is_simulated: bool) -> Option<String> {
    let is_truth = is_simulated && (key == "model" || Parameter::from_key(key).is_some());
    (!key.starts_with(FITTED)).then(|| if is_truth { format!("{SIMULATED}{key}") } else { key.to_owned() })
}

fn is_simulated(measurement: &Measurement) -> bool {
    measurement.metadata("simulated") == Some("true")
}

/// The metadata of a measurement beside those of its fit.
#[must_use]
pub fn with_fit(measurement: &Measurement, comments: &[(String, String)]) -> Vec<(String, String)> {
    let is_simulated = is_simulated(measurement);
    let own = measurement.metadata.iter().filter_map(|(key, value)| Some((renamed(key, is_simulated)?, value.clone())));
    own.chain(comments.iter().cloned()).collect()
}

/// A table with the comment lines of a fit above its header; its other lines stay as they are.
#[must_use]
pub fn insert_comments(table: &[u8], measurement: &Measurement, comments: &[(String, String)]) -> Vec<u8> {
    const BYTE_ORDER_MARK: &[u8] = "\u{feff}".as_bytes();
    let is_simulated = is_simulated(measurement);
    let (mark, text) = table.strip_prefix(BYTE_ORDER_MARK).map_or((&b""[..], table), |rest| (BYTE_ORDER_MARK, rest));
    let line_end = if text.contains(&b'\n') { b'\n' } else { b'\r' };
    let end: &[u8] = if text.windows(2).any(|pair| pair == b"\r\n") { b"\r\n" } else { &[line_end] };
    let mut out = mark.to_vec();
    let mut waiting = Some(comments);
    for line in text.split_inclusive(|&byte| byte == line_end) {
        let is_comment = line.iter().find(|byte| !byte.is_ascii_whitespace()) == Some(&b'#');
        if !is_comment && !line.trim_ascii().is_empty() {
            for (key, value) in waiting.take().into_iter().flatten() {
                out.extend([b"# ", key.as_bytes(), b": ", value.as_bytes(), end].concat());
            }
        }
        let key = if is_comment { key_of(line) } else { None };
        match key.map(|key| (key, renamed(key, is_simulated))) {
            Some((_, None)) => {}
            Some((key, Some(new))) if new != key => {
                let rest = line.iter().position(|&byte| byte == b':').map_or(&b""[..], |colon| &line[colon..]);
                out.extend([b"# ", new.as_bytes(), rest].concat());
            }
            _ => out.extend_from_slice(line),
        }
    }
    out
}

/// The key of a line `# key: value`.
fn key_of(line: &[u8]) -> Option<&str> {
    let (key, _) = std::str::from_utf8(line).ok()?.trim_start().trim_start_matches('#').split_once(':')?;
    Some(key.trim())
}

#[cfg(test)]
mod tests {
    use super::{fit_comments, insert_comments, with_fit};
    use pbrdf::fit::{Edge, Estimate, Fit, Interval, Intervals, Starts};
    use pbrdf::measurement::Measurement;
    use pbrdf::model::{Model, Parameter};

    /// Estimates of n, k and k_s, such as fits have.
    fn estimates() -> [Estimate; 3] {
        let data = Measurement::read("theta_i,theta_r,dolp\n30,40,0.1\n50,50,0.25\n".as_bytes()).expect("a measurement");
        let fit = Fit::new(&data, Model::SPECULAR).fix(Parameter::Ks, 1.0).intervals(Intervals::None).starts(Starts::One);
        let fit = fit.run().expect("a fit");
        let interval = |low, high| Some(Interval { low, high });
        let [mut n, mut k, ks] =
            [Parameter::N, Parameter::K, Parameter::Ks].map(|parameter| *fit.estimate(parameter).expect("an estimate"));
        (n.value, n.std_error, n.at_bound) = (2.05, Some(0.02), None);
        (n.interval68, n.interval95) = (interval(Some(2.03), Some(2.07)), interval(Some(2.0), Some(2.1)));
        (k.value, k.std_error, k.at_bound) = (0.0, None, Some(Edge::Lower));
        (k.interval68, k.interval95) = (interval(None, Some(0.5)), None);
        [n, k, ks]
    }

    #[test]
    fn a_table_says_what_was_fitted_and_what_was_simulated() {
        let text = "# simulated: true\r\n# n: 0.4\r\n# seed: 1\r\n# fitted_n: 9\r\ntheta_i,theta_r,dolp\r\n30,40,0.1\r\n# c: no key\r\n";
        let measurement = Measurement::read(text.as_bytes()).expect("a measurement");
        let estimates = estimates();
        let comments = fit_comments("specular", Some(3.5e-4), estimates.iter().map(|estimate| (estimate.parameter.key(), estimate)));
        let expected = [
            "# simulated: true",
            "# simulated_n: 0.4",
            "# seed: 1",
            "# fitted_model: specular",
            "# fitted_delta_e: 0.00035",
            "# fitted_n: 2.05; 68.3 %: 2.03000 to 2.07000; 95 %: 2.00000 to 2.10000; standard error 0.0200",
            "# fitted_k: 0; 68.3 %: below 0.500000; at lower bound",
            "# fitted_ks: 1; fixed",
            "theta_i,theta_r,dolp",
            "30,40,0.1",
            "# simulated_c: no key",
        ];
        let written = insert_comments(text.as_bytes(), &measurement, &comments);
        assert_eq!(String::from_utf8(written.clone()).expect("UTF-8").split("\r\n").collect::<Vec<_>>(), [&expected[..], &[""]].concat());
        // A second fit of that table takes the place of the first.
        let again = Measurement::read(&written[..]).expect("a measurement");
        assert_eq!(insert_comments(&written, &again, &comments), written);
        let keys: Vec<String> = with_fit(&measurement, &comments).into_iter().map(|(key, _)| key).collect();
        assert_eq!(keys[..4], ["simulated", "simulated_n", "seed", "simulated_c"]);
        assert_eq!(keys.iter().filter(|key| *key == "fitted_n").count(), 1);
    }
}
