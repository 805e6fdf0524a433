//! Telling English from Russian by letters.

/// Words of Latin letters that Russian texts have too: names of standards, programs, files and units of time.
pub const LATIN_IN_RUSSIAN: &[&str] =
    &["SHA", "WGS", "UTC", "binary", "dtg", "passport", "verify", "ssh", "keygen", "yaml", "JCGM"];

pub fn cyrillic(c: char) -> bool {
    ('\u{0400}'..='\u{04FF}').contains(&c)
}

/// Runs of Latin letters, one letter aside: symbols of quantities are alike in both languages.
pub fn latin_words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_ascii_alphabetic()).filter(|word| word.len() > 1)
}
