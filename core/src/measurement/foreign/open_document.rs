//! Workbooks of `OpenDocument` (.ods) are checked before they are read: calamine waits without end for the end of an element that a damaged
//! file lacks.

use quick_xml::events::Event;
use std::io::{BufReader, Cursor};

/// The part that holds the sheets.
const CONTENT: &str = "content.xml";

/// Whether the bytes are those of such a workbook; the kind stands first in it, unpacked.
pub(crate) fn is_open_document(bytes: &[u8]) -> bool {
    const KIND: &[u8] = b"opendocument.spreadsheet";
    bytes.starts_with(b"PK\x03\x04") && bytes.windows(KIND.len()).any(|window| window == KIND)
}

/// Checks that every element of the sheets has its end.
///
/// # Errors
/// What is wrong, in words.
pub(crate) fn check(bytes: &[u8]) -> Result<(), String> {
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).map_err(|error| error.to_string())?;
    let content = archive.by_name(CONTENT).map_err(|error| error.to_string())?;
    let mut reader = quick_xml::Reader::from_reader(BufReader::new(content));
    let mut buffer = Vec::new();
    let mut open: u64 = 0;
    loop {
        buffer.clear();
        match reader.read_event_into(&mut buffer).map_err(|error| error.to_string())? {
            Event::Start(_) => open += 1,
            Event::End(_) => open = open.saturating_sub(1),
            Event::Eof if open > 0 => return Err("its sheets end in the middle".to_owned()),
            Event::Eof => return Ok(()),
            _ => {}
        }
    }
}
