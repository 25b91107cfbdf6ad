//! Bytes as a short text that may stand in a link: zlib (RFC 1950), whose checksum tells damage, then
//! the letters of base64url (RFC 4648, 5) without padding.

const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

/// How hard deflate tries, 0 to 10.
const LEVEL: u8 = 9;

/// Compresses bytes into a text.
pub fn pack(bytes: &[u8]) -> String {
    encode(&miniz_oxide::deflate::compress_to_vec_zlib(bytes, LEVEL))
}

/// The bytes of a text; none where it is damaged, or where they would be more than so many.
pub fn unpack(text: &str, most: usize) -> Option<Vec<u8>> {
    miniz_oxide::inflate::decompress_to_vec_zlib_with_limit(&decode(text)?, most).ok()
}

fn encode(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let word = group.iter().fold(0_usize, |word, byte| word << 8 | usize::from(*byte)) << (8 * (3 - group.len()));
        // Three bytes have four letters, two have three, one has two.
        text.extend((0..=group.len()).map(|letter| char::from(LETTERS[word >> (18 - 6 * letter) & 63])));
    }
    text
}

fn value(letter: u8) -> Option<u32> {
    Some(u32::from(match letter {
        b'A'..=b'Z' => letter - b'A',
        b'a'..=b'z' => letter - b'a' + 26,
        b'0'..=b'9' => letter - b'0' + 52,
        b'-' => 62,
        b'_' => 63,
        _ => return None,
    }))
}

fn decode(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 2);
    for group in text.as_bytes().chunks(4) {
        let word = group.iter().try_fold(0_u32, |word, letter| Some(word << 6 | value(*letter)?))? << (6 * (4 - group.len()));
        let whole = match group.len() {
            1 => return None,
            letters => letters - 1,
        };
        bytes.extend(&word.to_be_bytes()[1..=whole]);
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::{decode, encode, pack, unpack};
    use proptest::prelude::{any, proptest};

    #[test]
    fn letters_are_those_of_the_standard() {
        // RFC 4648, 10, without padding; the last one tells base64url from base64.
        for (bytes, text) in
            [("", ""), ("f", "Zg"), ("fo", "Zm8"), ("foo", "Zm9v"), ("foob", "Zm9vYg"), ("fooba", "Zm9vYmE"), ("foobar", "Zm9vYmFy")]
        {
            assert_eq!((encode(bytes.as_bytes()).as_str(), decode(text)), (text, Some(bytes.as_bytes().to_vec())));
        }
        assert_eq!(encode(&[0xfb, 0xff]), "-_8");
        for text in ["Z", "Zm9vY", "Zg==", "Zm 8", "Zm+/", "é"] {
            assert_eq!(decode(text), None, "{text}");
        }
    }

    proptest! {
        #[test]
        fn bytes_come_back(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
            assert_eq!(unpack(&pack(&bytes), bytes.len()), Some(bytes));
        }

        #[test]
        fn any_text_is_bytes_or_nothing(text in ".{0,60}") {
            let _ = unpack(&text, 1000);
        }
    }

    #[test]
    fn a_text_of_more_bytes_than_allowed_is_refused() {
        let zeros = pack(&vec![0; 1 << 20]);
        assert!(zeros.len() < 3000, "{}", zeros.len());
        assert_eq!(unpack(&zeros, (1 << 20) - 1), None);
    }
}
