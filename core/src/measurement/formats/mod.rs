//! The forms of files that become measurements, one file a form.
//!
//! A new form is one file with a [`Format`] and one line in [`FORMATS`]. What a form has to be told
//! is a [`Question`], what it has to say an [`ImportNote`]; the command line and the window know
//! these alone.

mod ellipsometer_table;
mod error;
mod film_sense;
mod format;
mod imported;
mod native;
mod pbsdf;
mod pgii;
mod question;
mod recognition;
mod spectraray;
mod table;
mod text_line;
mod wavelength_unit;
mod woollam;
mod zemax;

pub use crate::measurement::note::{ImportNote, LineList};
pub use error::ImportError;
pub use format::{ForeignFile, Format};
pub use imported::Imported;
pub use native::{append_columns, write_measurements};
pub use pbsdf::{
    TensorAxis, TensorCount, TensorError, TensorErrorKind, TensorGrid, TensorResolution, TensorShape, TensorType, is_tensor, write_tensor,
};
pub use question::{ImportOptions, Question, TableSample};
pub use recognition::{FORMATS, Opened, extensions, open, recognise};
pub use woollam::is_woollam;
