//! Old workbooks (.xls) are checked before they are read: calamine follows chains of sectors without end and takes the memory that a damaged
//! size asks for.
//!
//! Frame: Compound File Binary ([MS-CFB]). Records within: type and length, two bytes each, and data ([MS-XLS] 2.1.4).

use std::io::{Cursor, Read as _};

/// What every compound file begins with.
const MAGIC: &[u8] = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1";
/// Sheets: where one begins in the stream ([MS-XLS] 2.4.28).
const BOUND_SHEET: u16 = 0x0085;
/// First and last row and column of a sheet ([MS-XLS] 2.4.90).
const DIMENSIONS: u16 = 0x0200;
/// Records of cells that begin with row and column: Number, Label, `RString`, `BoolErr`, RK, `LabelSst`, `MulRk`, Formula.
const CELLS: [u16; 8] = [0x0203, 0x0204, 0x00d6, 0x0205, 0x027e, 0x00fd, 0x00bd, 0x0006];
/// Rows and columns that a sheet may have ([MS-XLS] 2.5.53, 2.5.227).
const MOST_ROWS: u32 = 0x1_0000;
const MOST_COLUMNS: u32 = 0x100;

/// Whether the bytes are those of an old workbook.
pub(crate) fn is_old_workbook(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// Checks that sectors form chains with an end, and that no sheet claims more cells than it can have.
///
/// # Errors
/// What is wrong, in words.
pub(crate) fn check(bytes: &[u8]) -> Result<(), String> {
    let mut file = cfb::CompoundFile::open(Cursor::new(bytes)).map_err(|error| error.to_string())?;
    let mut stream = Vec::new();
    let name = ["/Workbook", "/Book"].into_iter().find(|name| file.is_stream(name)).ok_or("it has no workbook stream")?;
    let mut reader = file.open_stream(name).map_err(|error| error.to_string())?.take(bytes.len() as u64);
    reader.read_to_end(&mut stream).map_err(|error| error.to_string())?;
    for (kind, data) in Records(&stream) {
        if kind == BOUND_SHEET
            && let Some(place) = number(data, 0, 4)
        {
            check_sheet(stream.get(place as usize..).unwrap_or_default())?;
        }
    }
    Ok(())
}

fn check_sheet(stream: &[u8]) -> Result<(), String> {
    for (kind, data) in Records(stream) {
        let (last_row, last_column) = match (kind, data.len()) {
            (DIMENSIONS, ..12) => (number(data, 2, 2), number(data, 6, 2)),
            (DIMENSIONS, _) => (number(data, 4, 4), number(data, 10, 2)),
            _ if CELLS.contains(&kind) => (number(data, 0, 2), number(data, 2, 2)),
            _ => continue,
        };
        let (rows, columns) = (last_row.unwrap_or(0), last_column.unwrap_or(0));
        if rows > MOST_ROWS || columns > MOST_COLUMNS {
            return Err(format!("a sheet claims {rows} rows of {columns} columns"));
        }
    }
    Ok(())
}

/// The records of a stream, up to its end or the first that is cut.
struct Records<'a>(&'a [u8]);

impl<'a> Iterator for Records<'a> {
    type Item = (u16, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        let (head, rest) = self.0.split_at_checked(4)?;
        let kind = u16::from_le_bytes([head[0], head[1]]);
        let (data, rest) = rest.split_at_checked(usize::from(u16::from_le_bytes([head[2], head[3]])))?;
        self.0 = rest;
        Some((kind, data))
    }
}

/// A number of so many bytes, the lowest first.
fn number(data: &[u8], from: usize, bytes: usize) -> Option<u32> {
    let digits = data.get(from..from + bytes)?;
    Some(digits.iter().rev().fold(0, |number, &digit| (number << 8) | u32::from(digit)))
}
