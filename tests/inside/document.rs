//! Form of a signed document: payload, signature line, armor, and nothing else.

use super::fixtures;
use crate::document::{Form, SignedText, parse};
use crate::passport::content::Content;
use crate::passport::{FORM, NAMESPACE};
use crate::trust::{SignatureError, SigningKey};

fn signed(payload: &str) -> String {
    fixtures::signed(payload, &SigningKey::generate().unwrap())
}

#[test]
fn what_was_joined_is_split_again() {
    let text = signed("a: 1\n");
    let split = SignedText::split("x", text.as_bytes(), &FORM).unwrap();
    assert_eq!(split.signed_payload(None, None).unwrap(), "a: 1\n");
}

#[test]
fn nothing_may_stand_after_the_armor_or_beside_it() {
    let good = signed("a: 1\n");
    let bad = [
        format!("{good}\n"),
        format!("{good}  \n"),
        format!("{good}b: 2\n"),
        format!("{good}# comment\n"),
        good.trim_end().to_owned(),
        good.replace("signature: |\n", "signature: |-\n"),
        good.replace("signature: |\n", "signature: |\n\n"),
        good.replace("signature: |\n", "\"signature\": |\n"),
        good.replace("signature: |\n", "signature: |\r\n"),
        good.replace("signature: |\n", "signature: |\u{85}"),
        good.replace("signature: |\n", "signature: |\u{2028}"),
        good.replace("  -----END", "   -----END"),
        good.replace("a: 1\n", "a: 1\nsignature: |\n"),
    ];
    for text in bad {
        assert!(SignedText::split("x", text.as_bytes(), &FORM).is_err(), "{text}");
    }
    let other = SignedText::split("x", good.as_bytes(), &Form { namespace: "dtg-register", ..FORM }).unwrap_err();
    let expected = "dtg-register".to_owned();
    let due = SignatureError::WrongNamespace { found: NAMESPACE.to_owned(), expected };
    assert_eq!(other.signature.as_deref(), Some(&due));
}

/// Expected: by hand, the first line of a passport that is not in its form, the column of what is left to read.
#[test]
fn text_that_is_not_canonical_is_refused_with_its_place() {
    let passport = include_str!("../../passports/SPS-1/0203/moscow-bmstu-1.yaml");
    let payload = &passport[..passport.find("signature: |\n").unwrap()];
    let refusal = |from: &str, to: &str| {
        let altered = payload.replacen(from, to, 1);
        assert_ne!(altered, payload, "{from}");
        let line = altered.lines().zip(payload.lines()).take_while(|(a, b)| a == b).count() + 1;
        let read = parse("p.yaml", &altered, &FORM, Content::check);
        (read.unwrap_err().to_string(), line)
    };
    let other_form = |from: &str, to: &str, expected: &str| {
        let (words, line) = refusal(from, to);
        assert!(words.starts_with(&format!("p.yaml:{line}:")), "{words}");
        assert!(words.contains(expected), "{words}");
    };
    other_form("revision: 1", "revision: 01", "found `  revision: 01`, expected `  revision: 1`");
    other_form("stand:\n", "stand:\n  colour: \"red\"\n", "found `  colour: \"red\"`, expected the next key");
    other_form("  model: ", "  modell: ", "modell: ");
    other_form("  revision: 1\n", "", "expected the next key of this format");
    // An error in the content is reported with its field.
    let (words, _) = refusal("latitude_deg: 55.7658", "latitude_deg: 95.7658");
    assert!(words.contains("latitude_deg: found 95.7658"), "{words}");
}
