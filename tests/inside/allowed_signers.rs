//! Lists of allowed signers: their lines, their errors, and their verdicts.

use crate::trust::{AllowedSigners, NotAuthorised, PublicKey, SigningKey};
use jiff::Timestamp;

const NAMESPACE: &str = "dtg-passport";

fn key() -> PublicKey {
    SigningKey::generate().unwrap().public_key()
}

fn parsed(text: &str) -> AllowedSigners {
    AllowedSigners::parse("allowed_signers", text.as_bytes()).unwrap()
}

fn refused(text: &str) -> String {
    AllowedSigners::parse("f", text.as_bytes()).unwrap_err().to_string()
}

fn at(text: &str) -> Timestamp {
    text.parse().unwrap()
}

#[test]
fn of_several_lines_any_that_fits_counts_else_the_nearest_miss() {
    let key = key();
    let line = key.to_openssh();
    let now = at("2026-06-01T12:00:00Z");
    let misses = format!(
        "b {line}\n\"c d\" {line}\na namespaces=\"git\" {line}\na valid-after=\"20270101Z\" {line}\n\
         a valid-before=\"20250101Z\" {line}\na valid-before=\"20260101Z\" {line}\n"
    );
    let verdict = |count: usize| {
        let text: String = misses.lines().take(count).map(|line| format!("{line}\r\n")).collect();
        parsed(&text).authorise(&key, "a", NAMESPACE, now).unwrap_err()
    };
    let allowed = vec!["b".to_owned(), "c d".to_owned()];
    assert_eq!(verdict(2), NotAuthorised::WrongPrincipal(allowed));
    assert_eq!(verdict(3), NotAuthorised::WrongNamespace("git".to_owned()));
    assert_eq!(verdict(4), NotAuthorised::NotYetValid(at("2027-01-01T00:00:00Z")));
    assert_eq!(verdict(6), NotAuthorised::Expired(at("2026-01-01T00:00:00Z")));
    assert_eq!(parsed(&format!("{misses}a {line}")).authorise(&key, "a", NAMESPACE, now), Ok(()));
}

/// Expected: the order of the variants of [`NotAuthorised`], whatever the order of the lines.
#[test]
fn the_nearest_miss_is_reported_in_any_order_of_the_lines() {
    let key = key();
    let line = key.to_openssh();
    let verdict = |one: &str, other: &str| {
        let text = format!("{one} {line}\n{other} {line}\n");
        parsed(&text).authorise(&key, "a", NAMESPACE, at("2026-06-01T12:00:00Z")).unwrap_err()
    };
    let until = at("2026-01-01T00:00:00Z");
    assert_eq!(verdict("a valid-before=\"20260101Z\"", "b"), NotAuthorised::Expired(until));
    let namespaces = |allowed: &str| NotAuthorised::WrongNamespace(allowed.to_owned());
    assert_eq!(verdict("a namespaces=\"git\"", "a namespaces=\"git\""), namespaces("git"));
    assert_eq!(verdict("a namespaces=\"git\"", "a namespaces=\"file\""), namespaces("git or file"));
}

#[test]
fn options_are_strict() {
    let key = key().to_openssh();
    for (options, words) in [
        ("namespaces=\"a\",namespaces=\"b\"", "f:1:18: namespaces: found a duplicate option"),
        ("namespaces=dtg-passport", "found `dtg-passport`, expected a value in double quotes"),
        ("namespaces=\"a\"b", "found `\"a\"b`, expected a value in double quotes"),
        ("namespaces=\"a\"\"b\"", "found `\"a\"\"b\"`, expected a value in double quotes"),
        ("namespaces=\"\"", "found an empty list"),
        ("namespaces", "found no value, expected namespaces=\"…\""),
        ("namespaces=\"a\",", "found nothing after a comma"),
        (",namespaces=\"a\"", "found nothing, expected namespaces"),
        ("no-touch-required", "found `no-touch-required`, expected namespaces"),
        ("valid-before=\"20260101Z\",valid-after=\"20260101Z\"", "expected a time after valid-after"),
        ("valid-before=\"20260230Z\"", "a calendar date"),
        ("namespaces=\"a", "f:1:14: found a quote that is not closed"),
    ] {
        let refused = refused(&format!("a {options} {key}"));
        assert!(refused.contains(words), "{options}: {refused}");
    }
    assert!(refused(&format!("{} {key}", "a".repeat(1023))).contains("a pattern of 1023 bytes"));
    assert!(refused(&format!("\"\" {key}")).contains("found an empty list"));
    assert!(refused(&format!("a\"b\" {key}")).contains("a quote within the list"));
    assert!(refused(&format!("\"a\"b {key}")).contains("text immediately after the closing quote"));
    assert!(refused(&format!("a {key}\u{7}")).contains("found control character U+0007"));
    assert!(refused(&format!(" a\"b\" {key}")).starts_with("f:1:3: principals: found a quote within the list"));
    assert!(refused("# nobody so far\n").contains("found no key"));
}

/// Expected: the lines as counted by hand.
#[test]
fn the_same_mistake_in_many_lines_is_one_error_with_a_count() {
    let key = key().to_openssh();
    let of = |lines: usize, line: &str| refused(&format!("# keys\n{}", format!("{line}\n").repeat(lines)));
    let dated = format!("a valid-before=\"20270101\" {key}");
    let twenty = of(20, &dated);
    assert_eq!(twenty.lines().count(), 1, "{twenty}");
    let due = "f:2:16: valid-before: found \"20270101\" (and 19 more of this kind, up to line 21), expected";
    assert!(twenty.starts_with(due), "{twenty}");
    assert_eq!(of(3, &dated).lines().count(), 3);
    // Another mistake among them is seen.
    let mixed =
        refused(&format!("{}a colour {key}\n{}", format!("{dated}\n").repeat(60), format!("{dated}\n").repeat(60)));
    assert!(mixed.contains("(and 119 more of this kind, up to line 121)"), "{mixed}");
    assert!(mixed.contains("\nf:61:3: found `colour`, expected") && mixed.lines().count() == 2, "{mixed}");
    let very_many = of(5_000, &dated);
    assert!(very_many.contains("(and at least 999 more of this kind, up to line 1001 or beyond)"), "{very_many}");
    let sixty: Vec<_> = (0..60).map(|number| format!("x{number}")).collect();
    let sixty = refused(&format!("a {} {key}", sixty.join(",")));
    assert!(sixty.contains("found `x0` (and 59 more of this kind, up to line 1), expected"), "{sixty}");
}

#[test]
fn quotes_inside_values_are_kept_and_keys_of_other_types_are_counted() {
    let rsa = "ssh-rsa AAAAB3NzaC1yc2EAAAADAQABAAAAAwUAAQ==";
    let signers = parsed(&format!("a namespaces=\"x\\\"y,z\" {}\nb {rsa}", key().to_openssh()));
    assert_eq!(signers.lines()[0].options.namespaces.as_deref(), Some("x\"y,z"));
    assert_eq!((signers.lines().len(), signers.skipped), (1, vec!["ssh-rsa".to_owned()]));
}
