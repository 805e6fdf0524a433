//! Texts made to keep their reader busy, up to the size limit and above it: each is refused, within the bound on memory.
//! Before they were bounded the same texts took hours.
//!
//! A signature is no help against them: anybody has a key of his own, and with it comes as far as the parser.

use super::alone::alone;
use crate::fuzzing::memory::{bound, peak};
use crate::inside::fixtures;
use dtg_passport::passport::{content_from_anyone, verify};
use dtg_passport::site::Site;
use dtg_passport::stand::Stand;
use dtg_passport::text::LARGEST_DOCUMENT_BYTES;
use dtg_passport::trust::SigningKey;

/// Room for a signature below the size limit.
const FULL: usize = LARGEST_DOCUMENT_BYTES - 1000;

/// `unit` as often as it fits into the size limit.
fn filled(unit: &str) -> String {
    unit.repeat(FULL / unit.len())
}

/// Payloads that obey the text rule, so that with any key they reach the parser.
fn payloads() -> Vec<(&'static str, String)> {
    let list = |item: &str| format!("a: [{}]\n", &filled(item)[..FULL - 10 - FULL % item.len()]);
    let half = FULL / 2 - 10;
    let unknown: String = (0..FULL / 12).map(|index| format!("a{index}: 1\n")).collect();
    let indented: String = (0..1400).map(|depth| format!("{:depth$}-\n", "")).collect();
    vec![
        ("open brackets", format!("a: {}\n", "[".repeat(FULL - 10))),
        ("nested brackets", format!("a: {}{}\n", "[".repeat(half), "]".repeat(half))),
        ("nested braces", format!("a: {}{}\n", "{a: ".repeat(half / 4), "}".repeat(half / 4))),
        // In a plain word a quote begins no string, and hides nothing from a parser.
        ("brackets behind a quote in a word", format!("a: [x\",{}\"\n", "[".repeat(FULL - 10))),
        ("braces behind a quote in a word", format!("a: [x\",{}\"\n", "{a: ".repeat(FULL / 4 - 10))),
        ("brackets on lines of their own", format!("a:\n{}", "  [\n".repeat(FULL / 4 - 4))),
        ("a list of numbers", list("0,")),
        ("a list of lists", list("[],")),
        ("a list of texts", list("\"\",")),
        ("a list of keys", list("a: ,")),
        ("unknown keys", unknown),
        ("one key again and again", filled("a: 1\n")),
        ("positions without anything", format!("positions:\n{}", "  - {}\n".repeat(FULL / 7 - 10))),
        ("unknown keys in vectors", format!("vectors:\n{}", "  - {i: 1, j: 1, x: 1}\n".repeat(FULL / 23 - 10))),
        ("a long key", format!("{}: 1\n", "a".repeat(FULL - 10))),
        ("a long text", format!("a: \"{}\"\n", "a".repeat(FULL - 10))),
        ("a long number", format!("a: {}.0\n", "1".repeat(FULL - 10))),
        ("a long comment", format!("# {}\na: 1\n", "a".repeat(FULL - 10))),
        ("comments alone", filled("#\n")),
        ("blank lines alone", filled("\n")),
        ("lists in lists", indented),
        ("lists in lists on one line", format!("{}a\n", "- ".repeat(FULL / 2 - 10))),
        ("a text over many lines", format!("a:\n{}", "  a\n".repeat(FULL / 4 - 10))),
    ]
}

/// Runs it, and fails when it takes more memory than `input` of bytes allows.
fn within_bound<T>(name: &str, input: &[u8], run: impl FnOnce() -> T) -> T {
    let (result, most) = peak(run);
    assert!(most <= bound(input.len()), "{name}: {most} bytes for an input of {}", input.len());
    result
}

#[test]
fn payloads_that_anybody_signed_are_refused_soon() {
    alone(|| {
        let key = SigningKey::generate().unwrap();
        let trust = fixtures::trust(&SigningKey::generate().unwrap());
        for (name, payload) in payloads() {
            let file = fixtures::signed(&payload, &key);
            assert!(file.len() <= LARGEST_DOCUMENT_BYTES, "{name}: {}", file.len());
            let answer =
                within_bound(name, file.as_bytes(), || verify(name, file.as_bytes(), &trust, &fixtures::question()));
            assert!(!answer.valid(), "{name}");
            let said: usize = answer.checks().iter().map(|check| check.detail.len()).sum();
            assert!(said < 100_000, "{name}: {said} bytes of words");
            assert!(
                within_bound(name, file.as_bytes(), || content_from_anyone(name, file.as_bytes())).is_err(),
                "{name}"
            );
        }
    });
}

/// Stand and site files need not obey the text rule: aliases, merge keys and block scalars reach their parser.
#[test]
fn files_of_hand_are_refused_soon() {
    alone(|| {
        let aliases = |level: usize| {
            let nine = vec![format!("*a{}", level - 1); 9].join(", ");
            format!("a{level}: &a{level} [{nine}]\n")
        };
        let bomb: String = std::iter::once("a0: &a0 [1, 1]\n".to_owned()).chain((1..30).map(aliases)).collect();
        let stand = "format: \"dtg-stand/1\"\nstand: {model: \"a\", serial: \"b\"}\n\
                     certificate: {number: \"1\", issued: \"2026-01-01\", laboratory: \"x\"}\npositions:\n";
        let position = "  - {i: 1, j: 1, theta_deg: 0, phi_deg: 0, alpha_arcsec: 0, beta_arcsec: 0, gamma_arcsec: 0}\n";
        let mut texts = payloads();
        texts.extend([
            ("an alias bomb", bomb),
            ("a long text and its aliases", {
                format!("a: &a \"{}\"\nb: [{}]\n", "x".repeat(FULL / 2), "*a,".repeat(FULL / 6 - 10))
            }),
            ("a long list and its aliases", {
                format!("a: &a [{}]\nb: [{}]\n", "1,".repeat(FULL / 4), "*a,".repeat(FULL / 6 - 10))
            }),
            ("merge keys", format!("a: &a {{x: 1}}\nb: {{{}}}\n", "<<: *a,".repeat(FULL / 7 - 10))),
            ("tags", format!("a: [{}]\n", "!x 1,".repeat(FULL / 5 - 10))),
            ("a folded text", format!("a: >\n{}", "  x\n".repeat(FULL / 4 - 10))),
            ("explicit keys", filled("? a\n: b\n")),
            ("one position again and again", format!("{stand}{}", position.repeat(FULL / position.len() - 10))),
        ]);
        for (name, text) in texts {
            let refused = within_bound(name, text.as_bytes(), || Stand::from_yaml(name, text.as_bytes()))
                .unwrap_err()
                .to_string();
            assert!(refused.len() < 100_000, "{name}: {} bytes of words", refused.len());
            assert!(within_bound(name, text.as_bytes(), || Site::from_yaml(name, text.as_bytes())).is_err(), "{name}");
        }
    });
}

#[test]
fn of_many_mistakes_the_first_are_reported_and_that_there_are_more() {
    let keys = |count: usize| (0..count).map(|index| format!("a{index}: 1\n")).collect::<String>();
    let refused = |text: &str| Stand::from_yaml("f", text.as_bytes()).unwrap_err();
    // 40 unknown keys, and 4 that are missing.
    assert_eq!(refused(&keys(40)).problems().len(), 44);
    let many = refused(&keys(1000));
    assert_eq!(many.problems().len(), 51);
    assert!(
        many.to_string().ends_with("f: found further errors, expected none; correct the errors above first"),
        "{many}"
    );
    assert!(many.problems()[..50].iter().all(|problem| problem.location.is_some()));
}

#[test]
fn aliases_that_repeat_little_and_brackets_in_texts_are_no_attack() {
    let stand = include_str!("../../../passports/SPS-2/0017/stand.yaml");
    let with_alias = stand.replacen("method: \"", "method: &method \"", 1).replacen(
        "level: \"upper face of the base plate\"",
        "level: *method",
        1,
    );
    assert!(with_alias.contains("&method") && with_alias.contains("*method"));
    Stand::from_yaml("aliases", with_alias.as_bytes()).unwrap();
    let brackets = stand.replacen("upper face", &"[".repeat(1000), 1).replacen("# A good", &"# {".repeat(1000), 1);
    Stand::from_yaml("brackets", brackets.as_bytes()).unwrap();
}

#[test]
fn above_the_size_limit_nothing_is_looked_at() {
    alone(|| {
        let trust = fixtures::trust(&SigningKey::generate().unwrap());
        let large = [
            ("100 MB of brackets", vec![b'['; 100 << 20]),
            ("100 MB of zeros", vec![0; 100 << 20]),
            ("a byte too many", vec![b'\n'; LARGEST_DOCUMENT_BYTES + 1]),
        ];
        for (name, bytes) in large {
            // No copy is made of it either.
            let answer = within_bound(name, b"", || verify(name, &bytes, &trust, &fixtures::question()));
            let refused = answer.checks().iter().find(|check| check.passed() == Some(false)).unwrap();
            assert!(refused.detail.contains("more than 1048576 bytes"), "{}", refused.detail);
            assert!(within_bound(name, b"", || Stand::from_yaml(name, &bytes)).is_err());
        }
        // At the limit, whatever is in the place of the armor.
        for (name, text) in [
            ("an endless armor", format!("a: 1\nsignature: |\n{}", "  AAAA\n".repeat(FULL / 7))),
            ("an armor in one line", format!("a: 1\nsignature: |\n  {}\n", "A".repeat(FULL - 100))),
            ("signature lines", "signature: |\n".repeat(FULL / 13)),
            ("almost signature lines", "\nsignature: ".repeat(FULL / 12)),
        ] {
            assert!(
                !within_bound(name, text.as_bytes(), || verify(name, text.as_bytes(), &trust, &fixtures::question()))
                    .valid(),
                "{name}"
            );
        }
    });
}
