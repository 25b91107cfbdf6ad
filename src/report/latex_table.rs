//! The layout of a table of results in LaTeX: rules of `booktabs`, models under their measurements, columns that a page has room for.

use std::fmt::Write as _;
use std::ops::Range;

/// Columns under one head, with the rules of `booktabs`.
pub fn tabular(head: &[String], rows: &[Vec<String>], first_of_goodness: usize) -> Vec<String> {
    // Ends above and below a value need room to those of the next row.
    let room = |cells: &[String]| if cells.iter().any(|cell| cell.contains("}_{-")) { "[0.8ex]" } else { "" };
    let line = |cells: &[String]| format!("{} \\\\{}", cells.join(" & "), room(cells));
    let mut lines = vec![format!("\\begin{{tabular}}{{l{}}}", "r".repeat(head.len() - 1)), "\\toprule".to_owned()];
    match spanned(head) {
        Some((groups, rules, models)) => lines.extend([line(&groups), rules, line(&models)]),
        None => lines.push(line(head)),
    }
    lines.push("\\midrule".to_owned());
    lines.extend(rows[..first_of_goodness].iter().map(|row| line(row)));
    lines.push("\\midrule".to_owned());
    lines.extend(rows[first_of_goodness..].iter().map(|row| line(row)));
    lines.extend(["\\bottomrule".to_owned(), "\\end{tabular}".to_owned()]);
    lines
}

/// Width of a page of the class `article`, of a letter at its 10 pt, and between two columns, in points.
const PAGE: f64 = 345.0;
const LETTER: f64 = 5.0;
const BETWEEN: f64 = 12.0;

/// The columns beside the names that stand side by side on a page: a table that is wider goes on below itself, with the models of one
/// measurement together where they have room.
pub fn parts_of_a_page(head: &[String], rows: &[Vec<String>]) -> Vec<Range<usize>> {
    let model = |title: &str| title.rsplit_once(", ").map_or(title, |(_, model)| model).to_owned();
    let is_spanned = spanned(head).is_some();
    let width = |column: usize| {
        let title = if is_spanned { model(&head[column]) } else { head[column].clone() };
        let cells = rows.iter().map(|row| printed_letters(&row[column]));
        BETWEEN + LETTER * cells.fold(printed_letters(&title), f64::max)
    };
    let widths: Vec<f64> = (0..head.len()).map(width).collect();
    let measurement = |title: &str| title.rsplit_once(", ").map(|(name, _)| name.to_owned());
    let mut parts: Vec<Range<usize>> = Vec::new();
    let mut used = 0.0;
    let mut column = 1;
    while column < head.len() {
        let name = measurement(&head[column]).filter(|_| is_spanned);
        let is_same = |other: &String| name.is_some() && measurement(other) == name;
        let group = column + head[column..].iter().take_while(|title| is_same(title)).count().max(1);
        let (whole, room) = (widths[column..group].iter().sum::<f64>(), PAGE - widths[0]);
        // The models of a measurement stay together; those that no page has room for begin a part of their own.
        if used == 0.0 || used + whole > room {
            parts.push(column..column);
            used = 0.0;
        }
        for (index, &width) in widths.iter().enumerate().take(group).skip(column) {
            if used > 0.0 && used + width > room {
                parts.push(index..index);
                used = 0.0;
            }
            if let Some(part) = parts.last_mut() {
                part.end = index + 1;
            }
            used += width;
        }
        column = group;
    }
    parts
}

/// About how many letters a cell of LaTeX prints: of two ends one above the other the wider, smaller ones by their size.
fn printed_letters(cell: &str) -> f64 {
    const SMALL: f64 = 0.7;
    let mut letters = 0.0;
    let mut rest = cell;
    while let Some(letter) = rest.chars().next() {
        if let Some((inside, after)) = ["\\textsuperscript{", "^{"].iter().find_map(|begins| rest.strip_prefix(begins)?.split_once('}')) {
            let (below, after) = after.strip_prefix("_{").and_then(|after| after.split_once('}')).unwrap_or(("", after));
            #[expect(clippy::cast_precision_loss, reason = "a number of letters")]
            let wider = inside.chars().count().max(below.chars().count()) as f64;
            letters += SMALL * wider;
            rest = after;
        } else if letter == '\\' {
            let name = rest[1..].chars().take_while(char::is_ascii_alphabetic).count();
            rest = &rest[1 + name..];
            letters += if name > 0 { 1.0 } else { 0.0 };
        } else {
            letters += if "${}".contains(letter) { 0.0 } else { 1.0 };
            rest = &rest[letter.len_utf8()..];
        }
    }
    letters
}

/// Titles *measurement, model* in two lines, a measurement above all of its models: cells, the rules under them, and the second line.
/// None where a title has no such parts, or no measurement has two models.
fn spanned(head: &[String]) -> Option<(Vec<String>, String, Vec<String>)> {
    let titles: Vec<(&str, &str)> = head[1..].iter().map(|title| title.rsplit_once(", ")).collect::<Option<_>>()?;
    let groups: Vec<&[(&str, &str)]> = titles.chunk_by(|one, next| one.0 == next.0).collect();
    if groups.iter().all(|group| group.len() == 1) {
        return None;
    }
    let mut last = 1;
    let (mut cells, mut rules) = (vec![String::new()], String::new());
    for group in groups {
        let first = last + 1;
        last += group.len();
        cells.push(format!("\\multicolumn{{{}}}{{c}}{{{}}}", group.len(), group[0].0));
        let _ = write!(rules, "\\cmidrule(lr){{{first}-{last}}}");
    }
    let models = std::iter::once(String::new()).chain(titles.iter().map(|(_, model)| (*model).to_owned()));
    Some((cells, rules, models.collect()))
}

#[cfg(test)]
mod tests {
    use super::{parts_of_a_page, printed_letters, spanned};

    #[test]
    fn models_of_a_measurement_stand_under_its_name() {
        let head = |titles: &[&str]| titles.iter().map(|title| (*title).to_owned()).collect::<Vec<String>>();
        let (cells, rules, models) = spanned(&head(&["", "a, b.csv, gauss", "a, b.csv, cauchy", "c, cauchy"])).expect("two lines");
        assert_eq!(cells, ["", r"\multicolumn{2}{c}{a, b.csv}", r"\multicolumn{1}{c}{c}"]);
        assert_eq!((rules.as_str(), models), (r"\cmidrule(lr){2-3}\cmidrule(lr){4-4}", head(&["", "gauss", "cauchy", "cauchy"])));
        assert_eq!(spanned(&head(&["", "a.csv", "b.csv"])), None);
        assert_eq!(spanned(&head(&["", "a, cauchy", "b, cauchy"])), None);
    }

    #[test]
    fn a_table_that_is_wider_than_a_page_goes_on_below_itself() {
        let head = |titles: &[&str]| std::iter::once("").chain(titles.iter().copied()).map(str::to_owned).collect::<Vec<String>>();
        let row = |columns: usize| vec![vec!["$1.937(26)$".to_owned(); columns + 1]];
        assert_eq!(parts_of_a_page(&head(&["a", "b", "c"]), &row(3)), std::iter::once(1..4).collect::<Vec<_>>());
        // Each column takes 12 + 9 · 5 = 57 of 345 points, the names as much.
        assert_eq!(parts_of_a_page(&head(&["a"; 9]), &row(9)), [1..6, 6..10]);
        let titles = ["a, x", "a, y", "a, z", "b, x", "b, y", "b, z", "c, x"];
        assert_eq!(parts_of_a_page(&head(&titles), &row(7)), [1..4, 4..8], "a measurement stays together");
        let many: Vec<String> = (0..7).map(|model| format!("a, m{model}")).collect();
        let many: Vec<&str> = many.iter().map(String::as_str).collect();
        assert_eq!(parts_of_a_page(&head(&many), &row(7)), [1..6, 6..8]);
        for (cell, letters) in
            [("$1.937(26)$", 9.0), (r"$1$\textsuperscript{a,b}", 3.1), (r"$0.43^{+1.04}_{-0.1}$", 7.5), (r"$\sigma$", 1.0)]
        {
            assert!((printed_letters(cell) - letters).abs() < 1e-9, "{cell}: {}", printed_letters(cell));
        }
    }
}
