//! The self-test passes, says so, and fails where it should.

#![cfg(feature = "cli")]

use assert_cmd::Command;
use dtg_passport::report::selftest::{text, to_json};
use dtg_passport::selftest::Case;

#[test]
fn every_case_is_as_published() {
    let output = Command::cargo_bin("dtg-passport").unwrap().args(["selftest", "--format", "json"]).output().unwrap();
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let failed: Vec<_> = found["cases"].as_array().unwrap().iter().filter(|case| case["passed"] == false).collect();
    assert!(output.status.success() && failed.is_empty(), "{failed:#?}");
    for example in ["H.1", "H.2", "H.3", "9.2.2", "9.2.3", "9.2.4", "9.3", "Norris", "Longley", "model"] {
        assert!(
            found["cases"].as_array().unwrap().iter().any(|case| case["example"].as_str().unwrap().contains(example))
        );
    }
}

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
    assert!(text(&cases).ends_with("FAILED: 2 of 3 cases.\n"));
    assert_eq!(to_json(&cases)["failed"], 2);
}
