//! The self-test fails where it should.

use dtg_passport::report::selftest::{text, to_json};
use dtg_passport::report::style::plain;
use dtg_passport::selftest::Case;

/// A number that is off, and one that is none, fail.
#[test]
fn what_is_off_fails() {
    let good = Case {
        example: "e",
        quantity: "q".into(),
        source: "s",
        expected: 1.0,
        tolerance: 0.1,
        found: 1.05,
        digits: None,
    };
    let off = Case { found: 1.2, ..good.clone() };
    let none = Case { found: f64::NAN, ..good.clone() };
    assert!(good.passed() && !off.passed() && !none.passed());
    let cases = [good, off, none];
    let text = plain(&text(&cases));
    assert!(text.starts_with("✕ FAILED  2 of 3 values differ from their references.\n"), "{text}");
    assert_eq!(to_json(&cases)["failed"], 2);
}
