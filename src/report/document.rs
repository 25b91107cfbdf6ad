//! A document of headings, paragraphs, tables and figures, as one self-contained HTML file or as
//! Markdown.

use crate::figure::{Figure, escape};
use std::fmt::Write as _;

/// A part of a document.
#[derive(Debug, Clone, PartialEq)]
pub enum DocumentPart {
    /// A heading under the title.
    Heading(String),
    /// A paragraph.
    Paragraph(String),
    /// Items, one below the other.
    List(Vec<String>),
    /// A table: head and rows of as many cells.
    Table {
        /// Names of the columns; empty for a table of keys and values.
        head: Vec<String>,
        /// What stands in them.
        rows: Vec<Vec<String>>,
    },
    /// Metadata of the data file, key and value; never translated.
    Quoted(Vec<(String, String)>),
    /// A figure with words under it.
    Picture {
        /// Part of the name of its file, where it has one: letters, digits and dashes.
        name: String,
        /// The words.
        caption: String,
        /// The figure.
        figure: Box<Figure>,
    },
}

/// A title and what stands under it. All of it is plain text, whatever characters there are.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReportDocument {
    /// Its title.
    pub title: String,
    /// Code of its language where that is not English.
    pub language: Option<&'static str>,
    /// Its parts.
    pub parts: Vec<DocumentPart>,
}

const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem;color:#1a1a1a;background:#fff}\
h1{font-size:1.7rem}h2{font-size:1.25rem;margin-top:2rem;border-bottom:1px solid #ccc}\
table{border-collapse:collapse;margin:1rem 0;font-variant-numeric:tabular-nums}\
th,td{padding:.2rem .7rem;border-bottom:1px solid #ddd;text-align:left;vertical-align:top;overflow-wrap:anywhere}\
thead th{border-bottom:2px solid #888}figure{margin:1.5rem 0}figcaption{color:#444;font-size:.9rem}svg{max-width:100%;height:auto}";

impl ReportDocument {
    /// As one HTML file. Figures are embedded as SVG; the file loads and runs nothing.
    #[must_use]
    pub fn html(&self) -> String {
        let title = escape(&self.title);
        let language = self.language.unwrap_or("en");
        let mut out = format!(
            "<!DOCTYPE html>\n<html lang=\"{language}\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n\
             <meta name=\"viewport\" content=\"width=device-width\">\n<title>{title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n\
             <h1>{title}</h1>\n"
        );
        for part in &self.parts {
            // Writing to a string does not fail.
            let _ = match part {
                DocumentPart::Heading(text) => writeln!(out, "<h2>{}</h2>", escape(text)),
                DocumentPart::Paragraph(text) => writeln!(out, "<p>{}</p>", escape(text)),
                DocumentPart::List(items) => {
                    let items: String = items.iter().map(|item| format!("<li>{}</li>\n", escape(item))).collect();
                    writeln!(out, "<ul>\n{items}</ul>")
                }
                DocumentPart::Table { head, rows } => writeln!(out, "{}", html_table(head, rows)),
                DocumentPart::Quoted(pairs) => writeln!(out, "{}", html_table(&[], &rows_of(pairs))),
                DocumentPart::Picture { caption, figure, .. } => {
                    writeln!(out, "<figure>\n{}<figcaption>{}</figcaption>\n</figure>", figure.svg(), escape(caption))
                }
            };
        }
        out.push_str("</body>\n</html>\n");
        out
    }

    /// As Markdown with the figures as files: `file_of` gives the path of the figure of that name, as the
    /// text links it.
    #[must_use]
    pub fn markdown(&self, file_of: impl Fn(&str) -> String) -> String {
        let mut out = format!("# {}\n", plain(&self.title));
        for part in &self.parts {
            out.push('\n');
            // Writing to a string does not fail.
            let _ = match part {
                DocumentPart::Heading(text) => writeln!(out, "## {}", plain(text)),
                DocumentPart::Paragraph(text) => writeln!(out, "{}", plain_line(text)),
                DocumentPart::List(items) => {
                    let items: String = items.iter().map(|item| format!("- {}\n", plain_line(item))).collect();
                    write!(out, "{items}")
                }
                DocumentPart::Table { head, rows } => write!(out, "{}", markdown_table(head, rows)),
                DocumentPart::Quoted(pairs) => write!(out, "{}", markdown_table(&[], &rows_of(pairs))),
                DocumentPart::Picture { name, caption, .. } => {
                    writeln!(out, "![{}](<{}>)\n\n*{}*", plain(caption), address(&file_of(name)), plain(caption))
                }
            };
        }
        out
    }

    /// The figures with their names.
    pub fn figures(&self) -> impl Iterator<Item = (&str, &Figure)> {
        self.parts.iter().filter_map(|part| match part {
            DocumentPart::Picture { name, figure, .. } => Some((name.as_str(), &**figure)),
            _ => None,
        })
    }
}

fn rows_of(pairs: &[(String, String)]) -> Vec<Vec<String>> {
    pairs.iter().map(|(key, value)| vec![key.clone(), value.clone()]).collect()
}

fn html_table(head: &[String], rows: &[Vec<String>]) -> String {
    let row = |cells: &[String], tag: &str| -> String {
        let cells: String = cells.iter().map(|cell| format!("<{tag}>{}</{tag}>", escape(cell))).collect();
        format!("<tr>{cells}</tr>\n")
    };
    let head = if head.is_empty() { String::new() } else { format!("<thead>\n{}</thead>\n", row(head, "th")) };
    let body: String = rows.iter().map(|cells| row(cells, "td")).collect();
    format!("<table>\n{head}<tbody>\n{body}</tbody>\n</table>")
}

fn markdown_table(head: &[String], rows: &[Vec<String>]) -> String {
    let columns = head.len().max(rows.iter().map(Vec::len).max().unwrap_or(0));
    let line = |cells: &[String]| -> String {
        let cells: String = (0..columns).map(|j| format!(" {} |", cells.get(j).map_or_else(String::new, |cell| plain(cell)))).collect();
        format!("|{cells}\n")
    };
    let rule = "---|".repeat(columns);
    let body: String = rows.iter().map(|cells| line(cells)).collect();
    format!("{}|{rule}\n{body}", line(head))
}

/// Text that Markdown shows as it is, on one line.
fn plain(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '\n' | '\r' | '\t' => out.push(' '),
            control if control.is_control() => out.push('\u{fffd}'),
            // `<` and `&` begin HTML, which Markdown lets through.
            '<' => out.push_str("&lt;"),
            '&' => out.push_str("&amp;"),
            '\\' | '`' | '*' | '_' | '[' | ']' | '|' | '#' | '!' | '~' | '$' | '>' => {
                out.push('\\');
                out.push(letter);
            }
            letter => out.push(letter),
        }
    }
    out
}

/// The same at the beginning of a line, where it must not begin a list or a heading.
fn plain_line(text: &str) -> String {
    let out = plain(text);
    match out.chars().next() {
        Some('-' | '+' | '=') => format!("\\{out}"),
        Some(digit) if digit.is_ascii_digit() => {
            let digits = out.chars().take_while(char::is_ascii_digit).count();
            if matches!(out.as_bytes().get(digits), Some(b'.' | b')')) { format!("{}\\{}", &out[..digits], &out[digits..]) } else { out }
        }
        _ => out,
    }
}

/// A path between the angle brackets of a Markdown link.
fn address(path: &str) -> String {
    let mut out = String::with_capacity(path.len());
    for letter in path.chars() {
        match letter {
            '<' => out.push_str("%3C"),
            '>' => out.push_str("%3E"),
            '\\' => out.push('/'),
            '\n' | '\r' => out.push(' '),
            letter => out.push(letter),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{DocumentPart, ReportDocument, plain, plain_line};
    use crate::figure::Figure;

    const HOSTILE: &str = "<script>alert(1)</script> & \"x\" | *b* _i_ `c` [l](javascript:1) \u{0}\n# h";

    fn document() -> ReportDocument {
        let text = || HOSTILE.to_owned();
        ReportDocument {
            title: text(),
            language: None,
            parts: vec![
                DocumentPart::Heading(text()),
                DocumentPart::Paragraph(text()),
                DocumentPart::List(vec![text()]),
                DocumentPart::Table { head: vec![text()], rows: vec![vec![text()], Vec::new()] },
                DocumentPart::Picture {
                    name: "dolp".to_owned(),
                    caption: text(),
                    figure: Box::new(Figure { title: text(), ..Figure::default() }),
                },
            ],
        }
    }

    #[test]
    fn html_shows_texts_as_they_are_and_runs_nothing() {
        let html = document().html();
        assert!(!html.contains("<script"));
        assert_eq!(
            html.matches("&lt;script&gt;alert(1)").count(),
            11,
            "title twice, five texts, caption, and the figure's label, title and words"
        );
        assert!(html.contains("default-src 'none'") && html.contains("<svg"));
        // With its void elements closed it is XML.
        let body = &html[html.find("<body>").unwrap()..html.find("</html>").unwrap()];
        let document = roxmltree::Document::parse(body).unwrap();
        assert_eq!(document.descendants().filter(|node| node.has_tag_name("td")).count(), 1);
    }

    #[test]
    fn markdown_shows_texts_as_they_are() {
        let markdown = document().markdown(|name| format!("my file <{name}>.svg"));
        assert!(!markdown.contains("<script"));
        assert!(markdown.contains("](<my file %3Cdolp%3E.svg>)"));
        assert!(markdown.matches("](javascript").count() == markdown.matches("\\](javascript").count(), "{markdown}");
        let table: Vec<&str> = markdown.lines().filter(|line| line.starts_with('|')).collect();
        let bars = |line: &str| line.matches('|').count() - line.matches("\\|").count();
        assert_eq!(table.iter().map(|line| bars(line)).collect::<Vec<_>>(), [2; 4]);
    }

    #[test]
    fn a_line_does_not_begin_a_list_or_heading_by_accident() {
        assert_eq!(plain_line("- 3"), "\\- 3");
        assert_eq!(plain_line("12. steel"), "12\\. steel");
        assert_eq!(plain_line("#1 k_s"), "\\#1 k\\_s");
        assert_eq!(plain("-2.07"), "-2.07");
    }
}
