//! Forms of files that are told by name and not read.

/// A form of files that is not read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OtherFormat {
    /// Its name.
    pub name: &'static str,
    /// What to do with such a file.
    pub advice: &'static str,
    /// Options of `import` that read it, by an example.
    pub options: Option<&'static str>,
}

const TO_CSV: &str = "save the values as a CSV table with angles of incidence and view, and import that";
const NAME_COLUMNS: &str = "name its columns by their order behind VARS=, as in --columns theta_i=1,theta_r=3,brdf=5";

/// How the bytes begin, and the form that they are.
const BEGINNINGS: [(&[u8], &str, &str); 9] = [
    (b"\x89HDF", "an HDF5 file", TO_CSV),
    (b"%PDF", "a PDF document", TO_CSV),
    (b"\x89PNG", "a picture (PNG)", TO_CSV),
    (b"\xff\xd8\xff", "a picture (JPEG)", TO_CSV),
    (b"II*\0", "a picture (TIFF)", TO_CSV),
    (b"\x1f\x8b", "a file packed by gzip", "unpack it first"),
    (b"MATLAB 5.0 MAT-file", "a MATLAB file", TO_CSV),
    (b"\x93NUMPY", "an array of numpy", "write it as text with numpy.savetxt and a header"),
    (b"CDF\x01", "a NetCDF file", TO_CSV),
];

impl OtherFormat {
    /// The form of a file that is known and not read.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Option<Self> {
        if let Some((_, name, advice)) = BEGINNINGS.iter().find(|(beginning, ..)| bytes.starts_with(beginning)) {
            return Some(Self { name, advice, options: None });
        }
        let head = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]);
        let begins = |mark: &str| head.lines().any(|line| line.trim_start().to_ascii_lowercase().starts_with(mark));
        let start = head.trim_start_matches('\u{feff}').trim_start();
        let (name, advice, options) = if begins("vars=") || begins("vars =") {
            ("BSDF text after ASTM E1392", NAME_COLUMNS, Some("--columns theta_i=1,theta_r=3,brdf=5"))
        } else if head.contains("<WindowElement") || head.contains("<DataDefinition") {
            ("a BSDF in the XML of Radiance and WINDOW", TO_CSV, None)
        } else if start.starts_with("<?xml") {
            ("an XML document", TO_CSV, None)
        } else if ["{", "<!DOCTYPE", "<html"].iter().any(|mark| start.starts_with(mark)) {
            ("JSON or a web page", TO_CSV, None)
        } else {
            return None;
        };
        Some(Self { name, advice, options })
    }
}

/// `this is an HDF5 file, which is not read; save …`
impl std::fmt::Display for OtherFormat {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "this is {}, which is not read as it is; {}", self.name, self.advice)
    }
}
