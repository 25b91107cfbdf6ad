//! Sentences to the user. A success disappears by itself, an error about a file when another file
//! opens, any other error when the user dismisses it.

use egui::Color32;

/// The sentences on screen, the oldest first.
#[derive(Debug, Default)]
pub struct Toasts {
    all: Vec<Toast>,
}

/// A sentence.
#[derive(Debug)]
pub struct Toast {
    pub text: String,
    /// Whether it disappears by itself.
    pub transient: bool,
    /// Whether it says why a file cannot be read.
    is_load_error: bool,
    /// When it disappears, in seconds of egui's clock; `None` before the first frame that shows it.
    expires_at: Option<f64>,
}

/// Seconds for which a transient sentence stays.
const TRANSIENT_SECONDS: f64 = 6.0;
/// Sentences on screen at most; the oldest make room.
const CAPACITY: usize = 12;

impl Toasts {
    /// Shows a sentence until the user dismisses it.
    pub fn error(&mut self, text: String) {
        self.push(Toast { text, transient: false, is_load_error: false, expires_at: None });
    }

    /// Shows why a file cannot be read, until another file opens or the user dismisses it.
    pub fn load_error(&mut self, text: String) {
        self.push(Toast { text, transient: false, is_load_error: true, expires_at: None });
    }

    /// Dismisses what is said about files before, since a file has opened.
    pub fn dismiss_load_errors(&mut self) {
        self.all.retain(|toast| !toast.is_load_error);
    }

    /// Shows a sentence that disappears by itself.
    pub fn info(&mut self, text: String) {
        self.push(Toast { text, transient: true, is_load_error: false, expires_at: None });
    }

    fn push(&mut self, toast: Toast) {
        self.all.retain(|other| other.text != toast.text);
        self.all.push(toast);
        let surplus = self.all.len().saturating_sub(CAPACITY);
        self.all.drain(..surplus);
    }

    pub fn iter(&self) -> impl Iterator<Item = &Toast> {
        self.all.iter()
    }

    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Dismisses the one at that place.
    pub fn dismiss(&mut self, place: usize) {
        if place < self.all.len() {
            self.all.remove(place);
        }
    }

    pub fn clear(&mut self) {
        self.all.clear();
    }

    /// Removes expired sentences at that time; returns the seconds until the next one expires.
    pub fn expire(&mut self, now: f64) -> Option<f64> {
        for toast in self.all.iter_mut().filter(|toast| toast.transient) {
            toast.expires_at.get_or_insert(now + TRANSIENT_SECONDS);
        }
        self.all.retain(|toast| toast.expires_at.is_none_or(|expires_at| now < expires_at));
        self.all.iter().filter_map(|toast| toast.expires_at).map(|expires_at| expires_at - now).reduce(f64::min)
    }

    /// All of them, line by line.
    #[cfg(test)]
    pub fn text(&self) -> Option<String> {
        let lines: Vec<&str> = self.iter().map(|toast| toast.text.as_str()).collect();
        (!lines.is_empty()).then(|| lines.join("\n"))
    }

    /// The same; dismisses them all.
    #[cfg(test)]
    pub fn take(&mut self) -> Option<String> {
        let text = self.text();
        self.clear();
        text
    }
}

impl Toast {
    pub fn color(&self, visuals: &egui::Visuals) -> Color32 {
        if self.transient { visuals.text_color() } else { crate::app::plots::theme::warning(visuals.dark_mode) }
    }
}
