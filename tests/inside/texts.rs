//! The table of texts: no Russian in English, no English in Russian, the same values in both.

use crate::inside::language::{LATIN_IN_RUSSIAN, cyrillic, latin_words};
use dtg_passport::wording::texts::TABLES;
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
    for (table, texts) in TABLES {
        for (name, text) in *texts {
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

/// Words of the glossary's predecessors, by language: `en` or `ru`, a forbidden wording (`*` stands for any ending), and
/// the term to use. A line may end with texts that are allowed to use it.
const NEVER: &str = include_str!("never.txt");

/// Returns `true` if `text` contains the words of `pattern`, in any case.
fn says(text: &str, pattern: &str) -> bool {
    let words = |text: &str| -> Vec<String> {
        let parts = text.split(|c: char| !(c.is_alphanumeric() || "*_-/№°″".contains(c)));
        parts.filter(|word| !word.is_empty()).map(str::to_lowercase).collect()
    };
    let (text, pattern) = (words(text), words(pattern));
    let alike = |word: &String, due: &String| match due.strip_suffix('*') {
        Some(stem) => word.starts_with(stem),
        None => word == due,
    };
    text.windows(pattern.len()).any(|at| at.iter().zip(&pattern).all(|(word, due)| alike(word, due)))
}

/// Returns the rules for a language: forbidden wording, term, and texts that may use it.
fn never(language: &str) -> Vec<(&'static str, &'static str, Vec<&'static str>)> {
    let lines = NEVER.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    let rules = lines.map(|line| line.split('|').map(str::trim).collect::<Vec<_>>());
    let of = |rule: Vec<&'static str>| {
        let but = rule.get(3).map_or_else(Vec::new, |names| names.split_whitespace().collect());
        (rule[0] == language).then(|| (rule[1], rule[2], but))
    };
    rules.filter_map(of).collect()
}

/// Returns what is wrong with the words of a text in `language`: each forbidden wording, and the term to use.
pub(crate) fn wrong(language: &str, name: &str, said: &str) -> Vec<String> {
    let forbidden = never(language).into_iter().filter(|(pattern, _, but)| says(said, pattern) && !but.contains(&name));
    forbidden.map(|(pattern, term, _)| format!("{name}: {pattern:?} in {said:?}; write {term:?}")).collect()
}

#[test]
fn one_term_for_each_concept() {
    assert!(says("The last days of it", "last day*") && !says("at last, daylight", "last day"));
    assert!(says("Столб, отмеченный", "столб") && !says("столбец x", "столб"));
    let mut found = Vec::new();
    for (table, texts) in TABLES {
        for (name, text) in *texts {
            for (language, said) in [("en", text.en), ("ru", text.ru)] {
                let said = without_names(said).replace('\u{a0}', " ");
                found.extend(wrong(language, &format!("{table}::{name}"), &said));
            }
        }
    }
    assert_eq!(found, Vec::<String>::new());
}
