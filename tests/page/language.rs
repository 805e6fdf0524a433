//! The table of texts, and what of it reaches a page: no Russian in English, no English in Russian.

use crate::every::every;
use dtg_passport::report::page::{Language, texts};
use std::collections::BTreeSet;

/// Words of Latin letters that Russian texts have too: names of standards, programs, files and units of time.
const LATIN_IN_RUSSIAN: &[&str] =
    &["SHA", "WGS", "UTC", "binary", "dtg", "passport", "verify", "ssh", "keygen", "yaml", "JCGM"];

fn cyrillic(c: char) -> bool {
    ('\u{0400}'..='\u{04FF}').contains(&c)
}

/// Runs of Latin letters, one letter aside: symbols of quantities are alike in both languages.
fn latin_words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_ascii_alphabetic()).filter(|word| word.len() > 1)
}

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
    for (table, texts) in texts::TABLES {
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

/// Words that are not the file's own: in the language that their element names.
#[test]
fn pages_have_no_leftovers_of_the_other_language() {
    for page in every() {
        let own: BTreeSet<&str> = page.own_words.split(|c: char| !c.is_ascii_alphabetic()).collect();
        let words = page.found["said"]["words"].as_array().unwrap();
        let mut seen = BTreeSet::new();
        for word in words {
            let (text, lang) = (word["text"].as_str().unwrap(), word["lang"].as_str().unwrap());
            seen.insert(lang);
            // A picture's words stand in all languages of the page, one beside the other.
            if word["picture"].as_bool().unwrap() && !page.languages.single() {
                continue;
            }
            if lang == Language::English.tag() {
                assert!(!text.chars().any(cyrillic), "{}: {text:?} in English", page.name);
            } else {
                for latin in latin_words(text) {
                    // Ids, names of files and issuers stand within sentences.
                    let known = LATIN_IN_RUSSIAN.contains(&latin)
                        || ["cos", "sin", "xy", "yx", "ij", "Kx", "Ky", "Kxy", "Kyx"].contains(&latin);
                    assert!(known || own.contains(latin), "{}: {latin:?} of {text:?} in Russian", page.name);
                }
            }
            let untouched = text.contains('{') && !text.contains("{serial}");
            assert!(!untouched, "{}: a name was not filled in: {text:?}", page.name);
        }
        let due: BTreeSet<&str> = page.languages.iter().map(Language::tag).collect();
        assert_eq!(seen, due, "{}", page.name);
    }
}
