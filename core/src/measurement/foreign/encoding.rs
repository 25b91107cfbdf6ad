//! Stage 1 of a foreign table: bytes to text.

use crate::measurement::{ReadError, ReadErrorKind};
use encoding_rs::{Encoding, GB18030, UTF_8, WINDOWS_1252};

/// Characters that a table in Chinese has in its header: angle, degree, polarisation, wavelength.
const CHINESE: [char; 5] = ['角', '度', '偏', '波', '样'];

/// A text and the encoding that it was in.
#[derive(Debug, Clone, PartialEq)]
pub struct Decoded {
    /// The text, without byte order mark, its lines ended by line feeds.
    pub text: String,
    /// Name of the encoding, as of the Encoding Standard.
    pub encoding: &'static str,
}

/// The text of a file: by its byte order mark, else UTF-8, GB 18030 where that gives Chinese words,
/// else Windows-1252.
///
/// # Errors
/// The file is empty, or has NUL bytes, as UTF-16 without a byte order mark has.
pub(crate) fn decode(bytes: Vec<u8>) -> Result<Decoded, ReadError> {
    let (text, encoding) = match Encoding::for_bom(&bytes) {
        Some((encoding, _)) => (encoding.decode(&bytes).0.into_owned(), encoding),
        None => match String::from_utf8(bytes) {
            Ok(text) => (text, UTF_8),
            Err(error) => legacy(error.as_bytes()),
        },
    };
    if let Some(position) = text.find('\0') {
        let line = text[..position].matches('\n').count() as u64 + 1;
        return Err(ReadErrorKind::Nul.at_line(line));
    }
    if text.trim().is_empty() {
        return Err(ReadErrorKind::EmptyText.anywhere());
    }
    let text = if text.contains('\r') { text.replace("\r\n", "\n").replace('\r', "\n") } else { text };
    Ok(Decoded { text, encoding: encoding.name() })
}

fn legacy(bytes: &[u8]) -> (String, &'static Encoding) {
    let (chinese, _, has_errors) = GB18030.decode(bytes);
    if !has_errors && chinese.contains(CHINESE) {
        return (chinese.into_owned(), GB18030);
    }
    (WINDOWS_1252.decode(bytes).0.into_owned(), WINDOWS_1252)
}

#[cfg(test)]
mod tests {
    use super::decode;

    #[test]
    fn usual_encodings_are_told_apart() {
        let utf_16 = |text: &str| [vec![0xff, 0xfe], text.encode_utf16().flat_map(u16::to_le_bytes).collect()].concat();
        for (bytes, text, encoding) in [
            (b"\xef\xbb\xbfa\r\nb\rc".to_vec(), "a\nb\nc", "UTF-8"),
            (utf_16("θ\t1"), "θ\t1", "UTF-16LE"),
            (b"\xfe\xff\x00a".to_vec(), "a", "UTF-16BE"),
            (b"Stra\xdfe 30\xb0".to_vec(), "Straße 30°", "windows-1252"),
            (b"\xc8\xeb\xc9\xe4\xbd\xc7,30".to_vec(), "入射角,30", "gb18030"),
        ] {
            let decoded = decode(bytes).expect(text);
            assert_eq!((decoded.text.as_str(), decoded.encoding), (text, encoding));
        }
        assert!(decode(b"t\0h\0".to_vec()).is_err() && decode(b" \n".to_vec()).is_err());
    }
}
