//! A surface whose height over the image plane is a sum of waves: its slopes are exact at every point.

use std::sync::LazyLock;

/// The field that ships, made by `assets/make_relief.py`.
const RELIEF: &str = include_str!("../../../assets/relief.csv");

/// The columns of a file.
const HEADER: [&str; 4] = ["kx", "ky", "height", "phase"];
/// Most waves of a field: every pixel adds all of them.
const MOST_WAVES: usize = 1000;

/// `z(x, y) = Σ height sin(kx x + ky y + phase)`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HeightField {
    waves: Vec<Wave>,
}

/// One of its waves.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Wave {
    kx: f64,
    ky: f64,
    height: f64,
    phase: f64,
}

/// Why a text is no height field.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum HeightFieldError {
    /// Nothing but comments.
    #[error("no header; expected the line kx,ky,height,phase")]
    Empty,
    /// Another header.
    #[error("line {line}: found the header {found:?}; expected kx,ky,height,phase")]
    Header {
        /// Counted from 1.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// A row of another length.
    #[error("line {line}: {found} cells; expected 4, kx,ky,height,phase")]
    Cells {
        /// Counted from 1.
        line: usize,
        /// How many there are.
        found: usize,
    },
    /// A cell that is no finite number.
    #[error("line {line}, column {column}: {found:?} is not a finite number")]
    Number {
        /// Counted from 1.
        line: usize,
        /// Name of the column.
        column: &'static str,
        /// What stands there.
        found: String,
    },
    /// No row or more than a thousand.
    #[error("{0} waves; expected 1 to {MOST_WAVES}")]
    Count(usize),
}

impl HeightField {
    /// The rough relief that ships.
    #[must_use]
    pub fn relief() -> &'static Self {
        #[expect(clippy::expect_used, reason = "the asset is part of the program, and a test reads it")]
        static FIELD: LazyLock<HeightField> = LazyLock::new(|| HeightField::from_text(RELIEF).expect("the asset is a height field"));
        &FIELD
    }

    /// From text: a line `kx,ky,height,phase` and a row for each wave, wave numbers in radians per unit of x and y, the phase in radians.
    /// Lines that begin with `#` and empty lines say nothing.
    ///
    /// # Errors
    ///
    /// [`HeightFieldError`] with the line where the text is not in this form.
    pub fn from_text(text: &str) -> Result<Self, HeightFieldError> {
        let mut lines = (1..).zip(text.lines().map(str::trim)).filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        let (line, header) = lines.next().ok_or(HeightFieldError::Empty)?;
        if !header.split(',').map(str::trim).eq(HEADER) {
            return Err(HeightFieldError::Header { line, found: header.to_owned() });
        }
        let waves = lines.map(|(line, row)| wave(line, row)).collect::<Result<Vec<_>, _>>()?;
        if (1..=MOST_WAVES).contains(&waves.len()) { Ok(Self { waves }) } else { Err(HeightFieldError::Count(waves.len())) }
    }

    /// Height over the image plane.
    #[must_use]
    pub fn height(&self, x: f64, y: f64) -> f64 {
        self.waves.iter().map(|wave| wave.height * libm::sin(wave.kx * x + wave.ky * y + wave.phase)).sum()
    }

    /// ∂z/∂x and ∂z/∂y.
    #[must_use]
    pub fn slopes(&self, x: f64, y: f64) -> [f64; 2] {
        self.waves.iter().fold([0.0; 2], |[along_x, along_y], wave| {
            let rise = wave.height * libm::cos(wave.kx * x + wave.ky * y + wave.phase);
            [along_x + wave.kx * rise, along_y + wave.ky * rise]
        })
    }
}

fn wave(line: usize, row: &str) -> Result<Wave, HeightFieldError> {
    let cells: Vec<&str> = row.split(',').map(str::trim).collect();
    if cells.len() != HEADER.len() {
        return Err(HeightFieldError::Cells { line, found: cells.len() });
    }
    let mut numbers = [0.0; 4];
    for ((number, cell), column) in numbers.iter_mut().zip(cells).zip(HEADER) {
        let found = || HeightFieldError::Number { line, column, found: cell.to_owned() };
        *number = cell.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(found)?;
    }
    let [kx, ky, height, phase] = numbers;
    Ok(Wave { kx, ky, height, phase })
}

#[cfg(test)]
mod tests {
    use super::{HeightField, HeightFieldError};

    #[test]
    fn slopes_are_those_of_the_height() {
        let (field, step) = (HeightField::relief(), 1e-5);
        for (x, y) in [(-0.9, 0.3), (0.1, 0.2), (0.77, -0.5)] {
            let slopes = field.slopes(x, y);
            let differences = [
                (field.height(x + step, y) - field.height(x - step, y)) / (2.0 * step),
                (field.height(x, y + step) - field.height(x, y - step)) / (2.0 * step),
            ];
            // Third derivatives of waves of number 16 times step²/6.
            assert!(slopes.iter().zip(differences).all(|(a, b)| (a - b).abs() < 1e-7), "{slopes:?} {differences:?}");
        }
    }

    #[test]
    fn damaged_files_are_refused_with_line_and_cause() {
        let read = |text: &str| HeightField::from_text(text).expect_err("damaged").to_string();
        assert_eq!(HeightField::from_text("# nothing\n\n"), Err(HeightFieldError::Empty));
        assert!(read("kx,ky,height\n1,2,3\n").contains("line 1"));
        assert_eq!(read("# a\nkx,ky,height,phase\n1,2,0.1,0\n1,2,0.1\n"), "line 4: 3 cells; expected 4, kx,ky,height,phase");
        assert_eq!(read("kx,ky,height,phase\n1,2,x,0\n"), "line 2, column height: \"x\" is not a finite number");
        assert!(read("kx,ky,height,phase\n1,2,inf,0\n").contains("\"inf\" is not a finite number"));
        assert_eq!(read("kx,ky,height,phase\n"), "0 waves; expected 1 to 1000");
    }
}
