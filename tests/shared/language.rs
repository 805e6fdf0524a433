//! Distinction of English from Russian by letters.

/// Latin words that also occur in Russian texts: names of standards, programs, files and units of time.
pub const LATIN_IN_RUSSIAN: &[&str] =
    &["SHA", "WGS", "UTC", "binary", "dtg", "passport", "verify", "ssh", "keygen", "yaml", "JCGM", "QR", "ISO", "IEC"];

pub fn cyrillic(c: char) -> bool {
    ('\u{0400}'..='\u{04FF}').contains(&c)
}

/// Returns runs of two or more Latin letters. Single letters are omitted, because symbols of quantities are alike in
/// both languages.
pub fn latin_words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_ascii_alphabetic()).filter(|word| word.len() > 1)
}
