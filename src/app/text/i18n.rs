//! The language of the window, switchable while it runs.
//!
//! Every text stands in English where it is used, as `tr!("Open measurement…")`; the translation is
//! looked up under the English text in `assets/locales/zh_CN.po` (gettext's format, which
//! translators' tools read). Numbers are formatted before they go in:
//! `tr!("{} rows", count)`. A text that comes out of a table goes through [`translated`]: `translated(parameter.help())`.
//! A message of the core, an error say, has its texts in [`crate::app::text::messages`].
//! Names of parameters, models and files are the same in all languages.

use crate::app::platform;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::cell::Cell;
use std::collections::HashMap;
use std::sync::OnceLock;
use tr::{Translator, tr};

/// A language of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Language {
    English,
    Chinese,
}

impl Language {
    pub const ALL: [Self; 2] = [Self::English, Self::Chinese];

    /// Its name in itself.
    pub fn name(self) -> &'static str {
        match self {
            Self::English => "English",
            Self::Chinese => "简体中文",
        }
    }

    /// Its name in English.
    pub fn english_name(self) -> &'static str {
        match self {
            Self::English => "English",
            Self::Chinese => "Chinese",
        }
    }

    /// Its code in lessons.
    pub fn code(self) -> &'static str {
        match self {
            Self::English => "en",
            Self::Chinese => "zh",
        }
    }

    /// That of the environment; English unless it says Chinese.
    pub fn of_environment() -> Self {
        let said = platform::language();
        if said.is_some_and(|value| value.starts_with("zh")) { Self::Chinese } else { Self::English }
    }
}

const CHINESE: &str = include_str!("../../../assets/locales/zh_CN.po");

/// Texts in Chinese by those in English.
struct Catalogue {
    chinese: HashMap<String, String>,
}

/// The catalogue, once it is made known.
static CATALOGUE: OnceLock<Catalogue> = OnceLock::new();

/// Entries of gettext's text form that have a translation; none where it is damaged, which a test
/// rules out.
fn entries(po: &str) -> Option<impl Iterator<Item = (String, String)>> {
    let file = rspolib::pofile(po).ok()?;
    Some(file.entries.into_iter().filter_map(|entry| Some((entry.msgid, entry.msgstr.filter(|text| !text.is_empty())?))))
}

impl Catalogue {
    fn from_po(po: &str) -> Option<Self> {
        Some(Self { chinese: entries(po)?.collect() })
    }
}

impl Translator for &'static Catalogue {
    fn translate<'a>(&'a self, text: &'a str, _context: Option<&'a str>) -> Cow<'a, str> {
        let translated = match current() {
            Language::English => None,
            Language::Chinese => self.chinese.get(text),
        };
        #[cfg(test)]
        if current() == Language::Chinese && translated.is_none() {
            MISSED.with_borrow_mut(|missed| missed.insert(text.to_owned()));
        }
        Cow::Borrowed(translated.map_or(text, String::as_str))
    }

    /// Chinese has no plural: the text is looked up under the English one of many.
    fn ntranslate<'a>(&'a self, n: u64, singular: &'a str, plural: &'a str, context: Option<&'a str>) -> Cow<'a, str> {
        self.translate(if n == 1 && current() == Language::English { singular } else { plural }, context)
    }
}

#[cfg(test)]
thread_local! {
    /// Texts that were looked up in vain, those out of tables among them.
    pub static MISSED: std::cell::RefCell<std::collections::BTreeSet<String>> = const { std::cell::RefCell::new(std::collections::BTreeSet::new()) };
}

/// A text out of a table, in the language of the window.
pub fn translated(text: &str) -> String {
    // An empty text is the head of the catalogue.
    if text.is_empty() { String::new() } else { tr!(text) }
}

/// A text that may stand in the catalogue, such as a label of a figure, or be data, such as the
/// name of a file.
pub fn label(text: &str) -> String {
    match (current(), CATALOGUE.get()) {
        (Language::Chinese, Some(catalogue)) if !text.is_empty() => catalogue.chinese.get(text).map_or(text, String::as_str).to_owned(),
        _ => text.to_owned(),
    }
}

/// Makes the catalogue known.
pub fn install() {
    static ONCE: std::sync::Once = std::sync::Once::new();
    ONCE.call_once(|| {
        if let Some(catalogue) = Catalogue::from_po(CHINESE) {
            let catalogue: &'static Catalogue = CATALOGUE.get_or_init(|| catalogue);
            tr::set_translator!(catalogue);
        }
    });
}

pub use switch::set;

thread_local! { static IN_ENGLISH: Cell<bool> = const { Cell::new(false) }; }

/// The language of the window; English inside [`in_english`].
pub fn current() -> Language {
    if IN_ENGLISH.get() { Language::English } else { switch::current() }
}

/// What texts are in English, whatever the window speaks.
pub fn in_english<R>(texts: impl FnOnce() -> R) -> R {
    IN_ENGLISH.set(true);
    let result = texts();
    IN_ENGLISH.set(false);
    result
}

/// One language for the whole program: jobs write sentences too.
#[cfg(not(test))]
mod switch {
    use super::Language;
    use std::sync::atomic::{AtomicBool, Ordering};

    static IS_CHINESE: AtomicBool = AtomicBool::new(false);

    pub fn current() -> Language {
        if IS_CHINESE.load(Ordering::Relaxed) { Language::Chinese } else { Language::English }
    }

    pub fn set(language: Language) {
        IS_CHINESE.store(language == Language::Chinese, Ordering::Relaxed);
    }
}

/// One language for each test: they run side by side.
#[cfg(test)]
mod switch {
    use super::Language;
    use std::cell::Cell;

    thread_local! { static CURRENT: Cell<Language> = const { Cell::new(Language::English) }; }

    pub fn current() -> Language {
        CURRENT.get()
    }

    pub fn set(language: Language) {
        CURRENT.set(language);
    }
}

#[cfg(test)]
mod tests {
    use super::{CHINESE, Catalogue, Language, install, set};
    use crate::app::tests::sources::{literals_after, sources};
    use std::collections::BTreeSet;
    use tr::tr;

    #[test]
    fn texts_follow_the_language() {
        install();
        assert_eq!(tr!("File"), "File");
        set(Language::Chinese);
        assert_eq!(tr!("File"), "文件");
        set(Language::English);
        assert_eq!(tr!("File"), "File");
    }

    #[test]
    fn every_text_of_the_window_is_translated() {
        let catalogue = Catalogue::from_po(CHINESE).expect("the catalogue is well-formed");
        // Chinese has no singular: the text of many is looked up.
        let is_singular = |source: &str, text: &str| source.contains(&format!("{text:?} | \""));
        let of = |source: &str| -> Vec<String> {
            let texts = TEXTS.iter().flat_map(|words| literals_after(source, words));
            texts.filter(|text| !is_singular(source, text)).collect()
        };
        let texts: BTreeSet<String> = of_window().iter().flat_map(|(_, source)| of(source)).filter(|text| !text.is_empty()).collect();
        let missing: Vec<String> = texts.into_iter().filter(|text| !catalogue.chinese.contains_key(text)).collect();
        assert!(missing.is_empty(), "not in assets/locales/zh_CN.po: {missing:#?}");
    }

    /// The sources of the window, without this file.
    fn of_window() -> Vec<(String, String)> {
        sources("src/app").into_iter().filter(|(path, _)| !path.ends_with("i18n.rs")).collect()
    }

    /// Behind what stands a text of the window: in the program, or in a table out of which it goes
    /// through `translated`.
    const TEXTS: [&str; 7] = ["tr!(", "translated(", "text: ", "help: ", "tooltip: ", "word: ", "meaning: "];
}
