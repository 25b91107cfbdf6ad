//! The core's errors as exceptions: one sentence, with its hint.

use pyo3::exceptions::PyValueError;
use pyo3::{PyErr, create_exception};
use std::fmt::Display;

create_exception!(pbrdf, PbrdfError, PyValueError, "An argument or a file that pbrdf refuses; the text says why and what helps.");

/// An exception of that text.
pub fn refused(text: impl Display) -> PyErr {
    PbrdfError::new_err(text.to_string())
}

/// The same with what helps, where something does.
pub fn refused_with(text: impl Display, hint: Option<impl Display>) -> PyErr {
    match hint {
        Some(hint) => refused(format_args!("{text}; {hint}")),
        None => refused(text),
    }
}
