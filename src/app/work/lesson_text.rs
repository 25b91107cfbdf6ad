//! How lessons are written down: Markdown with a short head, or lines `key: text`.
//!
//! In Markdown a head between two lines `---` has `title` and `about`. `## Heading` begins a step; a
//! list item `- key: text` is a setting; a paragraph that begins with `**Move**`, `**Watch**` or
//! `**Why**` is what the step says. A language stands behind a dot: `title.zh`, `**Move.zh**`. Lines
//! that begin with `<!--` are comments.

use crate::app::work::lesson_error::{LessonError, LessonErrorKind};

/// A key with its text, continuations included.
pub struct LessonEntry {
    /// Line of the file, from 1.
    pub line: usize,
    pub key: String,
    pub language: Option<String>,
    pub text: String,
}

impl LessonEntry {
    fn new(line: usize, key: &str, text: &str) -> Self {
        let (key, language) = match key.split_once('.') {
            Some((key, language)) => (key, Some(language.trim().to_owned())),
            None => (key, None),
        };
        Self { line, key: key.trim().to_owned(), language, text: text.trim().to_owned() }
    }

    /// Goes on with the text.
    fn continue_with(&mut self, more: &str) {
        // Chinese has no blanks between words, and none where a line is broken.
        let glue = if self.text.is_empty() || self.text.ends_with(|c: char| c >= '\u{2e80}') { "" } else { " " };
        self.text = format!("{}{glue}{more}", self.text);
    }
}

/// What a file says, key by key; a head makes it Markdown.
///
/// # Errors
/// The first line that has neither form.
pub fn entries(text: &str) -> Result<Vec<LessonEntry>, LessonError> {
    let text = text.trim_start_matches('\u{feff}');
    let is_markdown = text.lines().map(str::trim).find(|line| !line.is_empty()) == Some(HEAD);
    if is_markdown { markdown(text) } else { plain(text) }
}

/// Before and after the head.
const HEAD: &str = "---";

/// The lines `key: text` with their continuations, comments and blank lines left out.
fn plain(text: &str) -> Result<Vec<LessonEntry>, LessonError> {
    let mut entries: Vec<LessonEntry> = Vec::new();
    for (number, raw) in text.lines().enumerate() {
        let line = number + 1;
        let trimmed = raw.trim();
        if trimmed.is_empty() || trimmed.starts_with('#') {
            continue;
        }
        let form = || LessonError { line, kind: LessonErrorKind::Form(trimmed.to_owned()) };
        if raw.starts_with([' ', '\t']) {
            entries.last_mut().ok_or_else(form)?.continue_with(trimmed);
            continue;
        }
        let (key, text) = trimmed.split_once(':').ok_or_else(form)?;
        entries.push(LessonEntry::new(line, key, text));
    }
    Ok(entries)
}

/// Where in a Markdown file a line is.
#[derive(PartialEq)]
enum Part {
    BeforeHead,
    Head,
    Steps,
}

fn markdown(text: &str) -> Result<Vec<LessonEntry>, LessonError> {
    let mut entries: Vec<LessonEntry> = Vec::new();
    let mut part = Part::BeforeHead;
    // Whether the line before is a text that this one may go on with.
    let mut is_open = false;
    for (number, raw) in text.lines().enumerate() {
        let line = number + 1;
        let trimmed = raw.trim();
        let form = || LessonError { line, kind: LessonErrorKind::Form(trimmed.to_owned()) };
        if trimmed.is_empty() || trimmed.starts_with("<!--") {
            is_open = false;
        } else if trimmed == HEAD && part != Part::Steps {
            part = if part == Part::BeforeHead { Part::Head } else { Part::Steps };
            is_open = false;
        } else if let Some(entry) = entry_of(trimmed, line, &part) {
            entries.push(entry);
            is_open = true;
        } else if let Some(entry) = entries.last_mut().filter(|_| is_open) {
            entry.continue_with(trimmed);
        } else {
            return Err(form());
        }
    }
    Ok(entries)
}

/// What begins in that line, if anything does.
fn entry_of(line: &str, number: usize, part: &Part) -> Option<LessonEntry> {
    if *part == Part::Head {
        let (key, text) = line.split_once(':')?;
        return Some(LessonEntry::new(number, key, text));
    }
    if let Some(heading) = line.strip_prefix("## ") {
        return Some(LessonEntry::new(number, "step", heading));
    }
    if let Some(setting) = line.strip_prefix("- ") {
        let (key, text) = setting.split_once(':')?;
        return Some(LessonEntry::new(number, key, text));
    }
    let (label, text) = line.strip_prefix("**")?.split_once("**")?;
    // Keys are words of the file's form, whatever the language of its texts.
    let key = label.trim_end_matches([':', '.', ' ']).to_ascii_lowercase();
    matches!(key.split('.').next(), Some("move" | "watch" | "why"))
        .then(|| LessonEntry::new(number, &key, text.trim_start_matches([':', ' '])))
}

#[cfg(test)]
mod tests {
    use super::entries;

    #[test]
    fn a_line_of_no_form_is_named() {
        for (text, line) in [
            ("---\ntitle: a\n---\nhello\n", 4),
            ("---\ntitle\n---\n", 2),
            ("---\ntitle: a\n---\n## b\n\n**Note** c\n", 6),
            ("---\ntitle: a\n---\n## b\n- n\n\n- k 3\n", 7),
        ] {
            assert_eq!(entries(text).err().map(|error| error.line), Some(line), "{text:?}");
        }
    }
}
