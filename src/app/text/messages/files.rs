//! Messages about files.

use crate::app::text::localized::Localized;
use crate::figure::PngError;
use crate::files::export::{EndingError, Endings};
use crate::files::open_file::OpenError;
use tr::tr;

impl Localized for OpenError {
    fn localized(&self) -> String {
        match self {
            Self::Directory => tr!("this is a directory; expected a file"),
            Self::NotFound => tr!("there is no such file"),
            Self::Denied => tr!("permission to read the file is denied"),
            Self::Other(error) => tr!("the file cannot be opened: {}", error.localized()),
        }
    }
}

impl Localized for EndingError {
    fn localized(&self) -> String {
        let expected = match self.expected {
            Endings::Picture => tr!(".svg or .png"),
            Endings::Report => tr!(".html or .md"),
            Endings::Stokes => tr!(".png, .exr or .csv"),
            Endings::Table => tr!(".csv, .md or .tex"),
            Endings::Only(ending) => format!(".{ending}"),
        };
        tr!("{0}: expected a name that ends in {1}", self.path.display(), expected)
    }
}

impl Localized for PngError {
    fn localized(&self) -> String {
        match self {
            Self::Size { width_mm, height_mm, dpi } => {
                tr!("an image of {0} mm × {1} mm at {2} dots per inch is too large or too small", width_mm, height_mm, dpi)
            }
            Self::Drawing(error) => tr!("the drawing cannot be rendered: {}", error),
            Self::Encoding(error) => tr!("the image cannot be encoded: {}", error),
        }
    }
}
