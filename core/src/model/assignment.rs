//! Parameters as text: `n=2.07, k=3, sigma_v=0.5`, as in options, files and on the clipboard.
//!
//! Names are those of files; values lie in the domain of the parameter. Assignments are separated by commas, semicolons, blanks or
//! line ends; blanks around the equals sign are allowed.

use crate::model::{Domain, Parameter, ParameterSet, Parameters};
use crate::optics::shortest;

/// Why a text is no assignment.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AssignmentError {
    /// No `name=value`.
    #[error("expected name=value, such as n=2, found {0:?}")]
    Form(String),
    /// A name that is none of the nine.
    #[error("{0:?} is no parameter; expected one of {names}", names = Parameter::keys())]
    Name(String),
    /// A value that is no finite number.
    #[error("{0:?} is not a finite number")]
    Number(String),
    /// A value outside the domain.
    #[error("{} = {} is not allowed: expected {expected}", .parameter.key(), shortest(*.value))]
    Outside {
        /// Which parameter.
        parameter: Parameter,
        /// Its value.
        value: f64,
        /// The domain.
        expected: Domain,
    },
    /// The same name twice.
    #[error("{} is given twice", .0.key())]
    Twice(Parameter),
}

/// One `name=value`.
///
/// # Errors
///
/// [`AssignmentError`] where the text has another form, or the value lies outside the parameter's domain.
pub fn assignment_from_text(text: &str) -> Result<(Parameter, f64), AssignmentError> {
    let (name, value) = text.split_once('=').ok_or_else(|| AssignmentError::Form(text.to_owned()))?;
    let parameter = Parameter::from_key(name.trim()).ok_or_else(|| AssignmentError::Name(name.trim().to_owned()))?;
    let value: f64 = value
        .trim()
        .parse()
        .ok()
        .filter(|value: &f64| value.is_finite())
        .ok_or_else(|| AssignmentError::Number(value.trim().to_owned()))?;
    let expected = parameter.domain();
    if expected.contains(value) { Ok((parameter, value)) } else { Err(AssignmentError::Outside { parameter, value, expected }) }
}

/// A list of assignments, each parameter at most once; an empty text is an empty list.
///
/// # Errors
///
/// [`AssignmentError`] of the first part that is no assignment, or assigns a parameter again.
pub fn assignments_from_text(text: &str) -> Result<Vec<(Parameter, f64)>, AssignmentError> {
    let mut assignments: Vec<(Parameter, f64)> = Vec::new();
    for part in parts(text) {
        let (parameter, value) = assignment_from_text(&part)?;
        if assignments.iter().any(|(other, _)| *other == parameter) {
            return Err(AssignmentError::Twice(parameter));
        }
        assignments.push((parameter, value));
    }
    Ok(assignments)
}

/// The pieces between separators, blanks around equals signs taken out.
fn parts(text: &str) -> Vec<String> {
    let glued = text.split('=').map(str::trim).collect::<Vec<_>>().join("=");
    glued.split(|c: char| c == ',' || c == ';' || c.is_whitespace()).filter(|part| !part.is_empty()).map(str::to_owned).collect()
}

/// Those parameters as text that [`assignments_from_text`] reads back to the last bit.
#[must_use]
pub fn text_from_parameters(parameters: &Parameters, shown: ParameterSet) -> String {
    shown.iter().map(|parameter| format!("{}={}", parameter.key(), parameters[parameter])).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::{AssignmentError, assignment_from_text, assignments_from_text, text_from_parameters};
    use crate::model::{Parameter, ParameterSet, Parameters};

    #[test]
    fn assignments_know_parameters_and_domains() {
        assert_eq!(assignment_from_text("sigma_v=0.5"), Ok((Parameter::SigmaV, 0.5)));
        assert_eq!(assignment_from_text("c=-0.5"), Ok((Parameter::C, -0.5)));
        for wrong in ["n", "n=", "m=1", "q=1", "n=-1", "sigma=nan", "k=inf"] {
            assert!(assignment_from_text(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn lists_are_read_whatever_separates_them() {
        let expected = Ok(vec![(Parameter::N, 2.0), (Parameter::K, 3.5)]);
        for text in ["n=2,k=3.5", " n = 2 ; k= 3.5\n", "n=2 k=3.5"] {
            assert_eq!(assignments_from_text(text), expected, "{text:?}");
        }
        assert_eq!(assignments_from_text("  "), Ok(Vec::new()));
        assert_eq!(assignments_from_text("n=1, n=2"), Err(AssignmentError::Twice(Parameter::N)));
    }

    #[test]
    fn what_is_written_is_read_back_to_the_last_bit() {
        let parameters = Parameters { n: 1.0 / 3.0, sigma: 1e-30, kd: 1e-100, c: -0.1, ..Parameters::default() };
        let text = text_from_parameters(&parameters, ParameterSet::ALL);
        let read = assignments_from_text(&text).expect("its own text");
        assert!(read.iter().all(|&(parameter, value)| parameters[parameter] == value) && read.len() == 9, "{text}");
    }
}
