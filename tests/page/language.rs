//! What of the table of texts reaches a page: no Russian in English, no English in Russian.

use crate::pages::all_pages;
use crate::words::{LATIN_IN_RUSSIAN, cyrillic, latin_words};
use dtg_passport::report::Language;
use std::collections::BTreeSet;

/// Words that are not the file's own: in the language that their element names.
#[test]
fn pages_have_no_leftovers_of_the_other_language() {
    for page in all_pages() {
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

/// The drawing of the stand names its parts and directions in every language of the page.
#[test]
fn parts_of_the_stand_are_named_in_every_language() {
    let names = [("frame", "рамка"), ("platform", "платформа"), ("base", "основание"), ("north", "север")];
    let mut counted = 0;
    for page in all_pages().filter(|page| !page.languages.single()) {
        let words = page.found["said"]["words"].as_array().unwrap();
        let drawn: String = words
            .iter()
            .filter(|word| word["drawn"].as_bool().unwrap())
            .map(|word| format!("{}\n", word["text"].as_str().unwrap()))
            .collect();
        let named = |name: &str| drawn.split(['\n', '/']).any(|word| word.trim() == name);
        if named("frame") {
            counted += 1;
            for (english, russian) in names {
                assert!(named(english) && named(russian), "{}: {english}, {russian}", page.name);
            }
        }
    }
    assert!(counted >= 4, "{counted}");
}
