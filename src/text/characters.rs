//! Characters: those that signed texts may contain, and those that look like others.

use std::ops::RangeInclusive;

/// Characters beyond ASCII that a quoted string may contain: letters, punctuation and symbols that are drawn alone and
/// from left to right, and that no YAML reader takes for a line ending.
const BEYOND_ASCII: [RangeInclusive<char>; 22] = [
    '\u{00A1}'..='\u{00AC}',
    '\u{00AE}'..='\u{02AF}',
    '\u{0370}'..='\u{0373}',
    '\u{0375}'..='\u{0377}',
    '\u{037A}'..='\u{037D}',
    '\u{037F}'..='\u{037F}',
    '\u{0384}'..='\u{0386}',
    '\u{0388}'..='\u{0482}',
    '\u{048A}'..='\u{052F}',
    '\u{2010}'..='\u{2027}',
    '\u{2030}'..='\u{205E}',
    '\u{20AC}'..='\u{20AC}',
    '\u{2103}'..='\u{2103}',
    '\u{2116}'..='\u{2116}',
    '\u{2190}'..='\u{22FF}',
    '\u{3001}'..='\u{3003}',
    '\u{3005}'..='\u{3011}',
    '\u{3041}'..='\u{3096}',
    '\u{309D}'..='\u{30FF}',
    '\u{4E00}'..='\u{9FFF}',
    '\u{AC00}'..='\u{D7A3}',
    '\u{FF01}'..='\u{FF5E}',
];

/// Returns `true` if a string of a signed document may contain `c`.
pub(crate) fn allowed_in_string(c: char) -> bool {
    (' '..='~').contains(&c) || BEYOND_ASCII.iter().any(|range| range.contains(&c))
}

pub(super) fn is_printable_ascii(bytes: &[u8]) -> bool {
    // Do not stop at the first other byte, so that the compiler can test many bytes at once.
    bytes.iter().fold(true, |good, byte| good & (b' '..=b'~').contains(byte))
}

pub(super) fn character(c: char) -> String {
    let script = match c {
        '\u{0400}'..='\u{052F}' => "Cyrillic letter ",
        '\u{0370}'..='\u{03FF}' => "Greek letter ",
        _ => "",
    };
    format!("{script}{c:?} (U+{:04X})", u32::from(c))
}

/// Letters of other alphabets that look like Latin ones, in the order of those below.
const ALIKE: &str = "аеорсухіјѕԁһАВЕКМНОРСТХІЈЅοανρτυχΑΒΕΖΗΙΚΜΝΟΡΤΥΧ";
const LATIN: &str = "aeopcyxijsdhABEKMHOPCTXIJSoavptuxABEZHIKMNOPTYX";

/// Returns the text with each letter of another alphabet that looks Latin replaced by the Latin letter.
pub(crate) fn with_latin(text: &str) -> String {
    let alike = |c: char| ALIKE.chars().zip(LATIN.chars()).find(|(alike, _)| *alike == c).map_or(c, |(_, latin)| latin);
    text.chars().map(alike).collect()
}

/// Returns the text as [`with_latin`] does, and a description of the first letter that was replaced; `None` if there are none,
/// or if letters of other alphabets remain.
pub(crate) fn latin(text: &str) -> Option<(String, String)> {
    let odd = text.chars().find(|c| !c.is_ascii())?;
    let latin = with_latin(text);
    latin.is_ascii().then(|| (latin, character(odd)))
}

/// Returns `true` if a text has the form that [`sha256_hex`](super::scalar::sha256_hex) returns.
pub(crate) fn is_sha256_hex(text: &str) -> bool {
    text.len() == 64 && text.bytes().all(|byte| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte))
}

/// Returns the bytes of a hand-written file after its byte order mark, if it has one.
pub(crate) fn without_byte_order_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: Unicode's names of the characters.
    #[test]
    fn letters_that_look_latin_are_told() {
        assert_eq!(ALIKE.chars().count(), LATIN.chars().count());
        let (latin_text, odd) = latin("\u{430}lph\u{430}_arcsec").unwrap();
        assert_eq!((latin_text.as_str(), odd.as_str()), ("alpha_arcsec", "Cyrillic letter 'а' (U+0430)"));
        assert_eq!(latin("\u{3BF}mega").unwrap().1, "Greek letter 'ο' (U+03BF)");
        assert!(latin("alpha").is_none() && latin("альфа").is_none());
    }

    #[test]
    fn a_sha_256_has_64_lower_case_digits() {
        assert!(is_sha256_hex(&"0123456789abcdef".repeat(4)));
        for other in ["a".repeat(63), "a".repeat(65), "g".repeat(64), "A".repeat(64), "/".repeat(64)] {
            assert!(!is_sha256_hex(&other), "{other}");
        }
    }
}
