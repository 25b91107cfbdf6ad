//! What every message can do: say itself in the language of the window.

/// A value that has words in the language of the window.
pub trait Localized {
    /// A sentence, or a phrase without a capital and a full stop, as `Display` has it in English.
    fn localized(&self) -> String;
}
