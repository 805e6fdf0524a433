//! Claimed kind of a file, by its content, when it cannot be read as that kind.

use crate::passport::content::PASSPORT_FORMAT;
use crate::revocation::REVOCATION_FORMAT;
use crate::text::LARGEST_DOCUMENT_BYTES;
use std::path::Path;

/// First line of the armor of every SSH signature.
const ARMOR: &str = "-----BEGIN SSH SIGNATURE-----";

/// Kind of document that a file claims to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Claim {
    List,
    /// Passport, or a signed or empty file that may have been one.
    Passport,
}

impl Claim {
    /// Returns the claim of a file, or `None` if it has no mark of a passport or a list. Marks in UTF-16 and UTF-32 are
    /// also found, in either byte order.
    pub(super) fn of(path: &Path, bytes: &[u8]) -> Option<Self> {
        let ascii: Vec<u8>;
        let text = if bytes.contains(&0) {
            ascii = bytes.iter().copied().filter(|byte| *byte != 0).collect();
            &ascii
        } else {
            bytes
        };
        let has = |mark: &str| memchr::memmem::find(text, mark.as_bytes()).is_some();
        if has(REVOCATION_FORMAT) {
            return Some(Self::List);
        }
        let is_whole = bytes.len() <= LARGEST_DOCUMENT_BYTES;
        let is_empty =
            || is_whole && is_yaml(path) && text.iter().all(|byte| b" \t\r\n\xEF\xBB\xBF\xFE\xFF".contains(byte));
        (has(PASSPORT_FORMAT) || has(ARMOR) || is_empty()).then_some(Self::Passport)
    }
}

pub(super) fn is_yaml(path: &Path) -> bool {
    path.extension().is_some_and(|found| found.eq_ignore_ascii_case("yaml") || found.eq_ignore_ascii_case("yml"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(name: &str, bytes: &[u8]) -> Option<Claim> {
        Claim::of(Path::new(name), bytes)
    }

    fn utf_16(text: &str, to_bytes: fn(u16) -> [u8; 2]) -> Vec<u8> {
        text.encode_utf16().flat_map(to_bytes).collect()
    }

    #[test]
    fn a_claim_is_seen_in_every_encoding() {
        let cases = [
            ("format: \"dtg-passport/1\"\n", Claim::Passport),
            ("format: \"dtg-revocation/1\"\n", Claim::List),
            ("  -----BEGIN SSH SIGNATURE-----\n", Claim::Passport),
        ];
        for (text, claim) in cases {
            for bytes in [
                text.as_bytes().to_vec(),
                format!("\u{FEFF}{text}").into_bytes(),
                utf_16(text, u16::to_le_bytes),
                utf_16(&format!("\u{FEFF}{text}"), u16::to_be_bytes),
            ] {
                assert_eq!(of("notes.txt", &bytes), Some(claim), "{bytes:?}");
            }
        }
    }

    #[test]
    fn empty_yaml_may_have_been_anything_and_junk_is_nothing() {
        for empty in [&b""[..], b"\n", b" \r\n\t", b"\0\0\0\0", b"\xEF\xBB\xBF\n", b"\xFF\xFE"] {
            assert_eq!(of("here-1.yaml", empty), Some(Claim::Passport));
            assert_eq!(of("HERE-1.YML", empty), Some(Claim::Passport));
            assert_eq!(of("here.txt", empty), None);
        }
        for junk in [&b"hello\n"[..], b"format: \"dtg-stand/1\"\n", b"\0\0\x01", b"dtg-passport"] {
            assert_eq!(of("here-1.yaml", junk), None);
        }
    }
}
