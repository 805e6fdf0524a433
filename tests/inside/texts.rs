//! The table of texts: no Russian in English, no English in Russian, the same values in both.

use crate::inside::language::{LATIN_IN_RUSSIAN, cyrillic, latin_words};
use dtg_passport::report::page::texts;
use std::collections::BTreeSet;

/// The names in braces.
fn names(text: &str) -> BTreeSet<&str> {
    text.split('{').skip(1).filter_map(|rest| Some(rest.split_once('}')?.0)).collect()
}

fn without_names(text: &str) -> String {
    names(text).iter().fold(text.to_owned(), |text, name| text.replace(&format!("{{{name}}}"), " "))
}

#[test]
fn every_text_is_in_its_own_language_with_the_same_values() {
    let mut count = 0;
    let certificates = ("dcc", dtg_passport::dcc::words::ALL);
    for (table, texts) in texts::TABLES.into_iter().chain([certificates]) {
        for (name, text) in texts {
            count += 1;
            let (en, ru) = (without_names(text.en), without_names(text.ru));
            assert!(!en.chars().any(cyrillic), "{table}::{name}: Cyrillic in {en:?}");
            for word in latin_words(&ru) {
                let shared = LATIN_IN_RUSSIAN.contains(&word) || ["cos", "sin"].contains(&word);
                assert!(shared, "{table}::{name}: {word:?} in {ru:?}");
            }
            // What is words in English is words in Russian.
            let words = en.split(|c: char| !c.is_ascii_alphabetic()).any(|word| word.len() > 2);
            let shared = latin_words(&en).all(|word| LATIN_IN_RUSSIAN.contains(&word));
            assert!(ru.chars().any(cyrillic) || !words || shared, "{table}::{name}: {en:?} is not translated");
            assert_eq!(names(text.en), names(text.ru), "{table}::{name}");
            for said in [text.en, text.ru] {
                assert_eq!(said, said.trim(), "{table}::{name}");
                assert!(!said.contains("  ") && !said.is_empty(), "{table}::{name}: {said:?}");
                assert_eq!(said.matches('{').count(), said.matches('}').count(), "{table}::{name}");
            }
        }
    }
    assert!(count > 150, "{count} texts");
}
