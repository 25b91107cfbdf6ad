//! Sentences with parts that vary, found again in a finished text: the core writes its errors and verdicts in English and knows no other
//! language, so the window recognises the sentence and says it anew.
//!
//! A template is written like the format string that made the text, with a name in each hole: `the row has {found} cells; expected {expected}`.
//! What stands in a hole goes into the translation as it is, but for the holes named in [`NUMBERS`], which only a number fills, and those
//! named in [`AGAIN`], which hold a phrase that is translated in its turn, and for [`LIST`], which holds several. Of several readings the one is meant that understands most of the
//! text.

use std::collections::HashMap;

/// Holes that only a number fills.
const NUMBERS: [&str; 7] = ["line", "column", "byte", "number", "count", "low", "high"];
/// Holes that hold a phrase themselves.
const AGAIN: [&str; 7] = ["kind", "expected", "reason", "what", "one", "other", "rest"];
/// A hole that holds phrases with semicolons between them.
const LIST: &str = "list";
/// How deep phrases stand inside phrases at most: an error in a kind in a place in a file.
const DEPTH: usize = 6;

/// A text in parts: what stands before the first hole, then each hole with what follows it.
struct Template {
    before: String,
    holes: Vec<(String, String)>,
}

/// Phrases of one language under those in English.
#[derive(Default)]
pub struct Phrases {
    whole: HashMap<String, String>,
    /// English and translation.
    templates: Vec<(Template, Template)>,
}

impl Template {
    /// None where there is no hole, or nothing but holes.
    fn new(text: &str) -> Option<Self> {
        let mut parts = text.split('{');
        let before = parts.next().unwrap_or_default().to_owned();
        let hole = |part: &str| part.split_once('}').map(|(name, after)| (name.to_owned(), after.to_owned()));
        let template = Self { before, holes: parts.map(hole).collect::<Option<_>>()? };
        (!template.holes.is_empty() && template.length() > 0).then_some(template)
    }

    /// How many bytes are its own.
    fn length(&self) -> usize {
        self.before.len() + self.holes.iter().map(|(_, after)| after.len()).sum::<usize>()
    }

    /// The text with those parts in its holes.
    fn filled(&self, parts: &[(&str, String)]) -> String {
        let part = |name: &str| parts.iter().find(|(other, _)| *other == name).map_or("", |(_, part)| part.as_str());
        let rest: String = self.holes.iter().map(|(name, after)| format!("{}{after}", part(name))).collect();
        format!("{}{rest}", self.before)
    }

    /// What stands in each hole, if the text is of this form.
    fn parts<'a>(&self, text: &'a str) -> Option<Vec<&'a str>> {
        fill(&self.holes, text.strip_prefix(self.before.as_str())?)
    }
}

/// The shortest parts that fit, from the left.
fn fill<'a>(holes: &[(String, String)], text: &'a str) -> Option<Vec<&'a str>> {
    let [(name, after), rest @ ..] = holes else { return text.is_empty().then(Vec::new) };
    let may_hold = |part: &str| !NUMBERS.contains(&name.as_str()) || part.parse::<f64>().is_ok();
    if rest.is_empty() {
        return text.strip_suffix(after.as_str()).filter(|part| may_hold(part)).map(|part| vec![part]);
    }
    text.match_indices(after.as_str()).filter(|(at, _)| may_hold(&text[..*at])).find_map(|(at, _)| {
        let mut parts = fill(rest, &text[at + after.len()..])?;
        parts.insert(0, &text[..at]);
        Some(parts)
    })
}

impl Phrases {
    /// Of pairs of English and translation.
    pub fn new(pairs: impl Iterator<Item = (String, String)>) -> Self {
        let mut phrases = Self::default();
        for (english, translation) in pairs {
            match Template::new(&english).zip(Template::new(&translation)) {
                Some(both) => phrases.templates.push(both),
                None => _ = phrases.whole.insert(english, translation),
            }
        }
        phrases
    }

    /// The text in the other language, if it is known; `word` knows texts of other catalogues.
    pub fn translate<'a>(&'a self, text: &str, word: &dyn Fn(&str) -> Option<&'a str>) -> Option<String> {
        self.read(DEPTH, text, word).map(|(_, said)| said)
    }

    /// How much of the text is understood, in bytes, and the translation.
    fn read<'a>(&'a self, depth: usize, text: &str, word: &dyn Fn(&str) -> Option<&'a str>) -> Option<(usize, String)> {
        if let Some(whole) = self.whole.get(text).map(String::as_str).or_else(|| word(text)) {
            return Some((text.len(), whole.to_owned()));
        }
        let depth = depth.checked_sub(1)?;
        let readings = self.templates.iter().filter_map(|(english, translation)| {
            let parts = english.parts(text)?;
            let mut understood = english.length();
            let said: Vec<(&str, String)> = english
                .holes
                .iter()
                .zip(parts)
                .map(|((name, _), part)| {
                    let (length, said) = match name.as_str() {
                        LIST => self.read_list(depth, part, word),
                        name if AGAIN.contains(&name) => self.read_or_keep(depth, part, word),
                        _ => (0, part.to_owned()),
                    };
                    understood += length;
                    (name.as_str(), said)
                })
                .collect();
            Some((understood, translation.filled(&said)))
        });
        // Of equals the first.
        readings.reduce(|best, next| if next.0 > best.0 { next } else { best })
    }

    /// The same; what is not known stays as it is.
    fn read_or_keep<'a>(&'a self, depth: usize, text: &str, word: &dyn Fn(&str) -> Option<&'a str>) -> (usize, String) {
        self.read(depth, text, word).unwrap_or_else(|| (0, text.to_owned()))
    }

    fn read_list<'a>(&'a self, depth: usize, text: &str, word: &dyn Fn(&str) -> Option<&'a str>) -> (usize, String) {
        let (lengths, said): (Vec<usize>, Vec<String>) = text.split("; ").map(|part| self.read_or_keep(depth, part, word)).unzip();
        (lengths.into_iter().sum(), said.join("；"))
    }

    /// Whether there is an entry whose own text is this, whatever its holes are called.
    #[cfg(test)]
    pub fn has(&self, text: &str) -> bool {
        let own = |template: &Template| {
            let after = template.holes.iter().map(|(_, after)| after.clone());
            std::iter::once(template.before.clone()).chain(after).collect::<Vec<_>>()
        };
        match Template::new(text) {
            Some(wanted) => self.templates.iter().any(|(english, _)| own(english) == own(&wanted)),
            None => self.whole.contains_key(text),
        }
    }

    /// English texts whose translation lacks a hole, or has one that is not theirs.
    #[cfg(test)]
    pub fn torn(&self) -> Vec<String> {
        let names = |template: &Template| {
            let mut names: Vec<String> = template.holes.iter().map(|(name, _)| name.clone()).collect();
            names.sort();
            names
        };
        let text = |template: &Template| {
            let holes: String = template.holes.iter().map(|(name, after)| format!("{{{name}}}{after}")).collect();
            format!("{}{holes}", template.before)
        };
        let mut torn: Vec<String> =
            self.templates.iter().filter(|(english, other)| names(english) != names(other)).map(|(english, _)| text(english)).collect();
        torn.extend(self.whole.keys().filter(|english| english.contains('{')).cloned());
        torn
    }
}

#[cfg(test)]
mod tests {
    use super::Phrases;

    fn phrases() -> Phrases {
        let pairs = [
            ("line {line}: {kind}", "第 {line} 行：{kind}"),
            ("line {line}, column {column} ({name}): {kind}", "第 {line} 行第 {column} 列（{name}）：{kind}"),
            ("found {found}, expected {expected}", "读到 {found}，应为{expected}"),
            ("{one} wins over {other}", "{one}胜过{other}"),
            ("{name} is no {found}", "{name}不是{found}"),
            ("among {list}.", "其中有{list}。"),
            ("Gauss", "高斯"),
            ("a number", "一个数"),
        ];
        Phrases::new(pairs.into_iter().map(|(english, chinese)| (english.to_owned(), chinese.to_owned())))
    }

    fn translated(text: &str) -> Option<String> {
        phrases().translate(text, &|word| (word == "copper").then_some("铜"))
    }

    #[test]
    fn a_phrase_is_found_by_its_own_text_and_parts_are_put_where_they_belong() {
        for (english, chinese) in [
            ("line 3: found \"x\", expected a number", "第 3 行：读到 \"x\"，应为一个数"),
            ("line 3, column 2 (copper): found x, expected a number", "第 3 行第 2 列（copper）：读到 x，应为一个数"),
            ("line 3: n is no number", "第 3 行：n不是number"),
            (
                "among copper; x; line 3: a number; Gauss; copper; copper; copper; Gauss.",
                "其中有铜；x；第 3 行：一个数；高斯；铜；铜；铜；高斯。",
            ),
            ("found a number, expected copper", "读到 a number，应为铜"),
            ("Cauchy wins over Gauss", "Cauchy胜过高斯"),
        ] {
            assert_eq!(translated(english).as_deref(), Some(chinese));
        }
    }

    #[test]
    fn what_does_not_fit_stays() {
        for text in ["", "line three: a number", "line 3", "Gauss wins", "found"] {
            assert_eq!(translated(text), None, "{text:?}");
        }
        assert_eq!(translated("line 3: disk full").as_deref(), Some("第 3 行：disk full"));
    }

    #[test]
    fn entries_are_known_whatever_their_holes_are_called() {
        let phrases = phrases();
        assert!(phrases.has("found {0}, expected {1}") && phrases.has("Gauss") && !phrases.has("found {0}"));
        assert!(phrases.torn().is_empty());
        let torn = Phrases::new([("a {x}".to_owned(), "b {y}".to_owned()), ("c {z}".to_owned(), "d".to_owned())].into_iter());
        assert_eq!(torn.torn().len(), 2);
    }
}
