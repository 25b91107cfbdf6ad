//! Results of fits as a table for a paper: one row per parameter, one column per fit, values with their uncertainty in brackets.
//!
//! `2.049(23)` is 2.049 ± 0.023: the brackets count in the last digit of the value. `2.05(+31/−24)` has the interval 1.81 … 2.36. An uncertainty
//! from 1 on is written with its decimal point, `15.3(1.2)`. What is no value with an uncertainty carries a mark that a note explains.

use crate::figure::with_unit;
use crate::report::language::ReportLanguage;
use crate::report::latex_table::{parts_of_a_page, tabular};
use crate::report::number::{Number, symmetric, within};
use pbrdf::fit::rounding::{significant, trimmed};
use pbrdf::fit::{Edge, Estimate, EstimateStatus, FitResult, JointResult};
use pbrdf::model::{Parameter, ParameterSet};

/// The form of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableFormat {
    /// For a spreadsheet; notes are lines that begin with `#`.
    Csv,
    /// For a text.
    Markdown,
    /// For a paper, with the rules of the package `booktabs`.
    Latex,
    /// For a screen: cells alone.
    Plain,
}

/// A fit in a table.
#[derive(Debug, Clone, PartialEq)]
pub struct ResultColumn {
    /// What stands above it: the measurement, the model, or both.
    pub title: String,
    /// The estimates.
    pub estimates: Vec<Estimate>,
    /// The parameters that it shares with the columns beside it.
    pub shared: ParameterSet,
    /// ΔE of Eq. (18).
    pub delta_e: Option<f64>,
    /// Akaike's corrected criterion, of all measurements that were fitted together.
    pub aicc: Option<f64>,
    /// Rows in use.
    pub rows: usize,
}

impl ResultColumn {
    /// Of the fit of one measurement.
    #[must_use]
    pub fn single(title: String, result: &FitResult, rows: usize) -> Self {
        Self {
            title,
            estimates: result.estimates.clone(),
            shared: ParameterSet::EMPTY,
            delta_e: result.objective,
            aicc: result.statistics.aicc,
            rows,
        }
    }

    /// Of one measurement of a joint fit.
    #[must_use]
    pub fn of_set(title: String, result: &JointResult, set: usize, rows: usize) -> Self {
        let shared = result.shared.iter().map(|estimate| estimate.parameter).collect();
        Self { shared, ..Self::single(title, &result.of_set(set), rows) }
    }
}

/// Fits side by side.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ResultTable {
    /// The fits.
    pub columns: Vec<ResultColumn>,
}

/// What a note under the table explains.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Mark {
    Shared,
    Fixed,
    Lower,
    Upper,
    Uneven,
    Undetermined,
    UncertaintyUnknown,
    Joint,
}

impl Mark {
    const ALL: [Self; 8] =
        [Self::Shared, Self::Fixed, Self::Lower, Self::Upper, Self::Uneven, Self::Undetermined, Self::UncertaintyUnknown, Self::Joint];

    /// The note, English.
    fn note(self) -> &'static str {
        match self {
            Self::Shared => "one value for all measurements fitted together",
            Self::Fixed => "held fixed",
            Self::Lower => "at its lower bound",
            Self::Upper => "at its upper bound",
            Self::Uneven => "the interval at 68.3 %; its ends lie very unevenly about the best fit",
            Self::Undetermined => "not determined by the data; the value of the best fit",
            Self::UncertaintyUnknown => "the uncertainty is unknown: no degree of freedom is left, or none was asked for",
            Self::Joint => "of all measurements fitted together",
        }
    }
}

/// A value, its uncertainty and its marks.
struct Cell {
    value: Number,
    marks: Vec<Mark>,
}

/// A value with its uncertainty in brackets in plain text, `2.049(23)`, without marks.
#[must_use]
pub fn bracketed(estimate: &Estimate) -> String {
    Writer { format: TableFormat::Plain, used: Vec::new() }.number(&cell_of(estimate).value)
}

/// The texts of a table.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ResultCells {
    /// Names of the columns; the first one, of the names, is empty.
    pub head: Vec<String>,
    /// The cells of each row, its name first.
    pub rows: Vec<Vec<String>>,
    /// The row from which on the quality of the fits is stated.
    pub first_of_goodness: usize,
    /// What the marks mean.
    pub notes: Vec<String>,
}

impl ResultTable {
    /// In that form and language.
    #[must_use]
    pub fn text(&self, format: TableFormat, words: &dyn ReportLanguage) -> String {
        let (writer, cells) = self.written(format, words);
        writer.table(&cells)
    }

    /// The cells in plain text; a mark is a letter in brackets.
    #[must_use]
    pub fn cells(&self, words: &dyn ReportLanguage) -> ResultCells {
        self.written(TableFormat::Plain, words).1
    }

    fn written(&self, format: TableFormat, words: &dyn ReportLanguage) -> (Writer, ResultCells) {
        let parameters: Vec<Parameter> = Parameter::ALL.into_iter().filter(|&parameter| self.has(parameter)).collect();
        let writer = Writer { format, used: self.marks(&parameters) };
        let mut rows: Vec<Vec<String>> = parameters.iter().map(|&parameter| self.row(parameter, &writer)).collect();
        let first_of_goodness = rows.len();
        let number = |value: Option<f64>, digits: usize| {
            writer.number(&value.map_or(Number::None, |value| Number::Text(significant(value, digits))))
        };
        let joint = if self.is_joint() { writer.marks(&[Mark::Joint]) } else { String::new() };
        let line = |name: String, cell: &dyn Fn(&ResultColumn) -> String| -> Vec<String> {
            std::iter::once(name).chain(self.columns.iter().map(cell)).collect()
        };
        let delta_e = if format == TableFormat::Latex { r"$\Delta E$" } else { "ΔE" };
        rows.push(line(delta_e.to_owned(), &|column| number(column.delta_e, 3)));
        rows.push(line(format!("AICc{joint}"), &|column| {
            writer.number(&column.aicc.map_or(Number::None, |aicc| Number::Text(format!("{aicc:.1}"))))
        }));
        rows.push(line(writer.plain(&words.text("rows")), &|column| column.rows.to_string()));
        let head: Vec<String> =
            std::iter::once(String::new()).chain(self.columns.iter().map(|column| writer.plain(&column.title))).collect();
        let notes: Vec<String> = writer.used.iter().map(|&mark| writer.note(mark, words)).collect();
        (writer, ResultCells { head, rows, first_of_goodness, notes })
    }

    fn has(&self, parameter: Parameter) -> bool {
        self.columns.iter().any(|column| column.estimates.iter().any(|estimate| estimate.parameter == parameter))
    }

    fn is_joint(&self) -> bool {
        self.columns.iter().any(|column| !column.shared.is_empty())
    }

    fn row(&self, parameter: Parameter, writer: &Writer) -> Vec<String> {
        let shared = self.columns.iter().any(|column| column.shared.contains(parameter));
        let symbol = writer.symbol(parameter) + &writer.marks(if shared { &[Mark::Shared] } else { &[] });
        let name = if writer.format == TableFormat::Csv { symbol } else { with_unit(&symbol, parameter.unit()) };
        let cell = |column: &ResultColumn| {
            let estimate = column.estimates.iter().find(|estimate| estimate.parameter == parameter);
            let Cell { value, marks } = estimate.map_or(Cell { value: Number::None, marks: Vec::new() }, cell_of);
            writer.number(&value) + &writer.marks(&marks)
        };
        std::iter::once(name).chain(self.columns.iter().map(cell)).collect()
    }

    /// The marks that the table needs, in their order.
    fn marks(&self, parameters: &[Parameter]) -> Vec<Mark> {
        let estimates = self.columns.iter().flat_map(|column| &column.estimates);
        let mut used: Vec<Mark> = estimates.flat_map(|estimate| cell_of(estimate).marks).collect();
        if parameters.iter().any(|&parameter| self.columns.iter().any(|column| column.shared.contains(parameter))) {
            used.push(Mark::Shared);
        }
        if self.is_joint() {
            used.push(Mark::Joint);
        }
        Mark::ALL.into_iter().filter(|mark| used.contains(mark)).collect()
    }
}

fn cell_of(estimate: &Estimate) -> Cell {
    let value = estimate.value;
    let edge = estimate.at_bound.map(|edge| if edge == Edge::Lower { Mark::Lower } else { Mark::Upper });
    let (value, mark) = match estimate.status() {
        EstimateStatus::Fixed => (Number::Text(trimmed(value, 6)), Some(Mark::Fixed)),
        EstimateStatus::AtBound(_) => (Number::Text(trimmed(value, 6)), None),
        EstimateStatus::Determined(error) => (symmetric(value, error), None),
        EstimateStatus::UncertaintyUnknown => (Number::Text(trimmed(value, 6)), Some(Mark::UncertaintyUnknown)),
        EstimateStatus::Within(interval) => {
            let number = within(value, interval);
            let is_uneven = matches!(number, Number::Between(_));
            (number, is_uneven.then_some(Mark::Uneven))
        }
        EstimateStatus::Undetermined => (Number::Text(trimmed(value, 3)), Some(Mark::Undetermined)),
    };
    Cell { value, marks: mark.into_iter().chain(edge).collect() }
}

/// Writes the parts of a table in one form.
struct Writer {
    format: TableFormat,
    /// The marks of the table; the first one is a, the second b, and so on.
    used: Vec<Mark>,
}

impl Writer {
    fn letter(&self, mark: Mark) -> char {
        let letters = 'a'..='z';
        self.used.iter().zip(letters).find(|(used, _)| **used == mark).map_or('?', |(_, letter)| letter)
    }

    fn marks(&self, marks: &[Mark]) -> String {
        if marks.is_empty() {
            return String::new();
        }
        let mut letters: Vec<String> = marks.iter().map(|&mark| self.letter(mark).to_string()).collect();
        letters.sort_unstable();
        let letters = letters.join(",");
        match self.format {
            TableFormat::Csv | TableFormat::Plain => format!(" [{}]", letters.replace(',', "")),
            TableFormat::Markdown => format!("<sup>{letters}</sup>"),
            TableFormat::Latex => format!("\\textsuperscript{{{letters}}}"),
        }
    }

    fn note(&self, mark: Mark, words: &dyn ReportLanguage) -> String {
        let note = self.plain(&words.text(mark.note()));
        let letter = self.letter(mark);
        match self.format {
            TableFormat::Csv => format!("# [{letter}] {note}"),
            TableFormat::Plain => format!("[{letter}] {note}"),
            TableFormat::Markdown => format!("<sup>{letter}</sup> {note}"),
            TableFormat::Latex => format!("\\textsuperscript{{{letter}}}~{note}"),
        }
    }

    /// A text as the form shows it.
    fn plain(&self, text: &str) -> String {
        let line: String = text.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect();
        match self.format {
            TableFormat::Csv | TableFormat::Plain => line,
            TableFormat::Markdown => escaped(&line, |letter| {
                Some(match letter {
                    '<' => "&lt;".to_owned(),
                    '&' => "&amp;".to_owned(),
                    '\\' | '`' | '*' | '_' | '[' | ']' | '|' | '#' | '~' | '$' => format!("\\{letter}"),
                    _ => return None,
                })
            }),
            TableFormat::Latex => escaped(&line, |letter| {
                Some(match letter {
                    '\\' => "\\textbackslash{}".to_owned(),
                    '~' => "\\textasciitilde{}".to_owned(),
                    '^' => "\\textasciicircum{}".to_owned(),
                    '#' | '$' | '%' | '&' | '_' | '{' | '}' => format!("\\{letter}"),
                    _ => return None,
                })
            }),
        }
    }

    /// A parameter's symbol; its key where a program reads.
    fn symbol(&self, parameter: Parameter) -> String {
        match self.format {
            TableFormat::Csv => parameter.key().to_owned(),
            TableFormat::Plain => parameter.symbol().to_owned(),
            TableFormat::Markdown => self.plain(parameter.symbol()),
            TableFormat::Latex => {
                let symbol = match parameter {
                    Parameter::N => "n",
                    Parameter::K => "k",
                    Parameter::Sigma => r"\sigma",
                    Parameter::Ks => r"k_\mathrm{s}",
                    Parameter::Kd => r"k_\mathrm{d}",
                    Parameter::Kv => r"k_\mathrm{v}",
                    Parameter::Q => "q",
                    Parameter::C => "c",
                    Parameter::SigmaV => r"\sigma_\mathrm{v}",
                };
                format!("${symbol}$")
            }
        }
    }

    fn number(&self, number: &Number) -> String {
        let is_latex = self.format == TableFormat::Latex;
        let power = |exponent: i32| match exponent {
            0 => String::new(),
            _ if is_latex => format!(r"\times10^{{{exponent}}}"),
            _ => format!("e{exponent}"),
        };
        let text = match number {
            Number::None => return if is_latex { "--".to_owned() } else { "–".to_owned() },
            Number::Text(text) => self.digits(text),
            Number::Symmetric { value, error, exponent } => format!("{value}({error}){}", power(*exponent)),
            Number::Asymmetric { value, ends: [above, below], exponent, .. } if is_latex => {
                let number = format!("{value}^{{+{above}}}_{{-{below}}}");
                if *exponent == 0 { number } else { format!("({number}){}", power(*exponent)) }
            }
            Number::Asymmetric { value, in_digits: [above, below], exponent, .. } => {
                format!("{value}(+{above}/−{below}){}", power(*exponent))
            }
            Number::Between([low, high]) if is_latex => format!(r"{}\ldots{}", self.digits(low), self.digits(high)),
            Number::Between([low, high]) => format!("{low} … {high}"),
            Number::Above(low) => format!("> {}", self.digits(low)),
            Number::Below(high) => format!("< {}", self.digits(high)),
        };
        if is_latex { format!("${text}$") } else { text }
    }

    /// Digits with a power of ten as LaTeX has it.
    fn digits(&self, text: &str) -> String {
        match text.split_once('e') {
            Some((digits, exponent)) if self.format == TableFormat::Latex => format!(r"{digits}\times10^{{{exponent}}}"),
            _ => text.to_owned(),
        }
    }

    fn table(&self, cells: &ResultCells) -> String {
        let ResultCells { head, rows, first_of_goodness, notes } = cells;
        let mut lines: Vec<String> = Vec::new();
        match self.format {
            TableFormat::Csv | TableFormat::Plain => {
                let line = |cells: &[String]| cells.iter().map(|cell| quoted(cell)).collect::<Vec<_>>().join(",");
                lines.push(format!("parameter{}", line(head)));
                lines.extend(rows.iter().map(|row| line(row)));
                lines.extend_from_slice(notes);
            }
            TableFormat::Markdown => {
                let line = |cells: &[String]| format!("| {} |", cells.join(" | "));
                lines.push(line(head));
                lines.push(format!("|---|{}", "---:|".repeat(head.len() - 1)));
                lines.extend(rows.iter().map(|row| line(row)));
                if !notes.is_empty() {
                    lines.extend([String::new(), notes.join("; ") + "."]);
                }
            }
            TableFormat::Latex => {
                lines.push("% \\usepackage{booktabs}".to_owned());
                for (place, columns) in parts_of_a_page(head, rows).into_iter().enumerate() {
                    if place > 0 {
                        lines.push("\n\\medskip\n".to_owned());
                    }
                    let part = |cells: &[String]| -> Vec<String> { cells[..1].iter().chain(&cells[columns.clone()]).cloned().collect() };
                    let rows: Vec<Vec<String>> = rows.iter().map(|row| part(row)).collect();
                    lines.extend(tabular(&part(head), &rows, *first_of_goodness));
                }
                if !notes.is_empty() {
                    lines.push(format!("\n\\smallskip\n{{\\footnotesize {}.}}", notes.join("; ")));
                }
            }
        }
        lines.join("\n") + "\n"
    }
}

fn escaped(text: &str, replacement: impl Fn(char) -> Option<String>) -> String {
    text.chars().map(|letter| replacement(letter).unwrap_or_else(|| letter.to_string())).collect()
}

/// A cell of a CSV table, in quotes where it needs them.
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '#']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::{Mark, Number, Writer};
    use crate::report::number::{symmetric, within};
    use crate::report::result_table::TableFormat;
    use pbrdf::fit::Interval;

    fn text(number: &Number, format: TableFormat) -> String {
        Writer { format, used: Vec::new() }.number(number)
    }

    #[test]
    fn brackets_count_in_the_last_digit() {
        let plain = |value, error| text(&symmetric(value, error), TableFormat::Csv);
        assert_eq!(plain(2.0487, 0.0234), "2.049(23)");
        assert_eq!(plain(15.28, 1.21), "15.3(1.2)");
        assert_eq!(plain(150.2, 12.1), "150(12)");
        assert_eq!(plain(0.3, 0.000_12), "0.30000(12)");
        assert_eq!(plain(-0.4, 0.05), "-0.400(50)");
        assert_eq!(plain(1.5e-7, 2.0e-8), "1.50(20)e-7");
        assert_eq!(text(&symmetric(1.5e-7, 2.0e-8), TableFormat::Latex), r"$1.50(20)\times10^{-7}$");
        assert_eq!(plain(2.0, 0.0), "2");
    }

    #[test]
    fn intervals_have_two_ends_or_one() {
        let both = |low, high| {
            let number = within(2.05, Interval { low, high });
            [TableFormat::Markdown, TableFormat::Latex].map(|format| text(&number, format))
        };
        assert_eq!(both(Some(1.81), Some(2.36)), ["2.05(+31/−24)", "$2.05^{+0.31}_{-0.24}$"]);
        assert_eq!(both(Some(1.81), Some(2.29)), ["2.05(24)", "$2.05(24)$"]);
        assert_eq!(both(Some(2.05), Some(2.29)), ["2.05(+24/−0)", "$2.05^{+0.24}_{-0.00}$"]);
        assert_eq!(both(Some(0.85), Some(5.25)), ["2.0(+3.2/−1.2)", "$2.0^{+3.2}_{-1.2}$"]);
        // One end from 1 on, one below: both have their decimal point.
        assert_eq!(both(Some(1.58), Some(4.28)), ["2.05(+2.23/−0.47)", "$2.05^{+2.23}_{-0.47}$"]);
        assert_eq!(both(Some(2.04), Some(1e6)), ["2.0 … 1.0e6", r"$2.0\ldots1.0\times10^{6}$"]);
        assert_eq!(both(Some(1.2), None), ["> 1.20", "$> 1.20$"]);
        assert_eq!(both(None, Some(2.5)), ["< 2.50", "$< 2.50$"]);
    }

    #[test]
    fn letters_of_a_cell_are_in_their_order() {
        let writer = Writer { format: TableFormat::Plain, used: vec![Mark::Lower, Mark::Undetermined] };
        assert_eq!(writer.marks(&[Mark::Undetermined, Mark::Lower]), " [ab]");
    }

    #[test]
    fn texts_stay_what_they_are() {
        let plain = |format| Writer { format, used: Vec::new() }.plain("a_b|50%&{x}\n$");
        assert_eq!(plain(TableFormat::Latex), r"a\_b|50\%\&\{x\} \$");
        assert_eq!(plain(TableFormat::Markdown), r"a\_b\|50%&amp;{x} \$");
    }
}
