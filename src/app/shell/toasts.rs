//! Sentences to the user: one about a success goes by itself, one about a file that cannot be read goes when another one is, every other
//! one stays until it is dismissed.

use egui::Color32;

/// What the window has to say at the moment, the oldest first.
#[derive(Debug, Default)]
pub struct Notices {
    all: Vec<Notice>,
}

/// A sentence.
#[derive(Debug)]
pub struct Notice {
    pub text: String,
    /// Whether it goes by itself.
    pub transient: bool,
    /// Whether it tells why a file cannot be read.
    is_of_reading: bool,
    /// When it goes, in seconds of the window's clock; not known before it was shown.
    until: Option<f64>,
}

/// How long a brief sentence stays, in seconds.
const BRIEF: f64 = 6.0;
/// More than these nobody reads: the oldest go.
const MOST: usize = 12;

impl Notices {
    /// A sentence that stays until it is dismissed.
    pub fn say(&mut self, text: String) {
        self.push(Notice { text, transient: false, is_of_reading: false, until: None });
    }

    /// Why a file cannot be read: stays until another one is, or until it is dismissed.
    pub fn load_error(&mut self, text: String) {
        self.push(Notice { text, transient: false, is_of_reading: true, until: None });
    }

    /// A file was read: what was said of those before is past.
    pub fn reading_succeeded(&mut self) {
        self.all.retain(|notice| !notice.is_of_reading);
    }

    /// A sentence that goes by itself.
    pub fn info(&mut self, text: String) {
        self.push(Notice { text, transient: true, is_of_reading: false, until: None });
    }

    fn push(&mut self, notice: Notice) {
        self.all.retain(|other| other.text != notice.text);
        self.all.push(notice);
        let surplus = self.all.len().saturating_sub(MOST);
        self.all.drain(..surplus);
    }

    pub fn iter(&self) -> impl Iterator<Item = &Notice> {
        self.all.iter()
    }

    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    pub fn clear(&mut self) {
        self.all.clear();
    }

    /// Lets go what was shown long enough; how many seconds the next one stays, if one goes by itself.
    pub fn rest(&mut self, now: f64) -> Option<f64> {
        for notice in self.all.iter_mut().filter(|notice| notice.transient) {
            notice.until.get_or_insert(now + BRIEF);
        }
        self.all.retain(|notice| notice.until.is_none_or(|until| now < until));
        self.all.iter().filter_map(|notice| notice.until).map(|until| until - now).reduce(f64::min)
    }

    /// All of them, line by line.
    #[cfg(test)]
    pub fn text(&self) -> Option<String> {
        let lines: Vec<&str> = self.iter().map(|notice| notice.text.as_str()).collect();
        (!lines.is_empty()).then(|| lines.join("\n"))
    }

    /// The same, and away with them.
    #[cfg(test)]
    pub fn take(&mut self) -> Option<String> {
        let text = self.text();
        self.clear();
        text
    }
}

impl Notice {
    pub fn color(&self, visuals: &egui::Visuals) -> Color32 {
        if self.transient { visuals.text_color() } else { crate::app::plots::theme::warning(visuals.dark_mode) }
    }
}
