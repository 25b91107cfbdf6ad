//! Numbers as text.

/// The shortest text that reads back to the same f64, with an exponent where it would be long without; −0 as 0.
#[must_use]
pub fn shortest(number: f64) -> String {
    // Adding 0 turns −0 into 0.
    let number = number + 0.0;
    if number == 0.0 || (1e-4..1e16).contains(&number.abs()) || !number.is_finite() { number.to_string() } else { format!("{number:e}") }
}
