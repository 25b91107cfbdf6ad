//! Bytes as a short text that may stand in a link: zlib (RFC 1950), whose checksum tells damage, then
//! the letters of base64url (RFC 4648, 5) without padding.

use base64::Engine as _;
use base64::engine::general_purpose::URL_SAFE_NO_PAD;

/// How hard deflate tries, 0 to 10.
const LEVEL: u8 = 9;

/// Compresses bytes into a text.
pub fn pack(bytes: &[u8]) -> String {
    URL_SAFE_NO_PAD.encode(miniz_oxide::deflate::compress_to_vec_zlib(bytes, LEVEL))
}

/// The bytes of a text; none where it is damaged, or where they would be more than so many.
pub fn unpack(text: &str, most: usize) -> Option<Vec<u8>> {
    miniz_oxide::inflate::decompress_to_vec_zlib_with_limit(&URL_SAFE_NO_PAD.decode(text).ok()?, most).ok()
}

/// Numbers to the bit as letters.
#[cfg(any(test, target_arch = "wasm32"))]
pub fn text_of(numbers: &[f64]) -> String {
    URL_SAFE_NO_PAD.encode(numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>())
}

/// The numbers of such a text; none where it is damaged.
#[cfg(any(test, target_arch = "wasm32"))]
pub fn numbers_of(text: &str) -> Option<Vec<f64>> {
    let bytes = URL_SAFE_NO_PAD.decode(text).ok()?;
    let (numbers, rest) = bytes.as_chunks::<8>();
    rest.is_empty().then(|| numbers.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect())
}

#[cfg(test)]
mod tests {
    use super::{URL_SAFE_NO_PAD, numbers_of, pack, text_of, unpack};
    use base64::Engine as _;
    use proptest::prelude::{any, proptest};

    fn encode(bytes: &[u8]) -> String {
        URL_SAFE_NO_PAD.encode(bytes)
    }

    fn decode(text: &str) -> Option<Vec<u8>> {
        URL_SAFE_NO_PAD.decode(text).ok()
    }

    #[test]
    fn letters_are_those_of_the_standard() {
        // RFC 4648, 10, without padding; the last one tells base64url from base64.
        for (bytes, text) in
            [("", ""), ("f", "Zg"), ("fo", "Zm8"), ("foo", "Zm9v"), ("foob", "Zm9vYg"), ("fooba", "Zm9vYmE"), ("foobar", "Zm9vYmFy")]
        {
            assert_eq!((encode(bytes.as_bytes()).as_str(), decode(text)), (text, Some(bytes.as_bytes().to_vec())));
        }
        assert_eq!(encode(&[0xfb, 0xff]), "-_8");
        // The last two hold bits that belong to no byte.
        for text in ["Z", "Zm9vY", "Zg==", "Zm 8", "Zm+/", "é", "Zh", "Zm9"] {
            assert_eq!(decode(text), None, "{text}");
        }
    }

    #[test]
    fn numbers_come_back_to_the_bit() {
        let numbers = [0.0, -0.0, 1.0 / 3.0, f64::NAN, f64::NEG_INFINITY, 5e-324];
        let back = numbers_of(&text_of(&numbers)).expect("numbers");
        assert_eq!(back.iter().map(|number| number.to_bits()).collect::<Vec<_>>(), numbers.map(f64::to_bits));
        assert_eq!(numbers_of("Zm9v"), None, "three bytes are no number");
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
