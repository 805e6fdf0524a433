//! The self-test passes, and says so.

use crate::programs;
use assert_cmd::Command;
use std::fs;

const SETS: [&str; 11] = [
    "Norris", "Pontius", "NoInt1", "NoInt2", "Filip", "Longley", "Wampler1", "Wampler2", "Wampler3", "Wampler4",
    "Wampler5",
];

#[test]
fn every_case_is_as_published() {
    let output = Command::cargo_bin("dtg-passport").unwrap().args(["selftest", "--format", "json"]).output().unwrap();
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let cases = found["cases"].as_array().unwrap();
    let failed: Vec<_> = cases.iter().filter(|case| case["passed"] == false).collect();
    assert!(output.status.success() && failed.is_empty(), "{failed:#?}");
    assert_eq!((found["passed"].as_u64(), found["failed"].as_u64()), (Some(cases.len() as u64), Some(0)));
    let of = |name: &'static str| cases.iter().filter(move |case| case["example"].as_str().unwrap().ends_with(name));
    for example in ["end gauge", "impedance", "thermometer", "9.2.2", "9.2.3", "9.2.4", "9.3", "model"] {
        assert!(cases.iter().any(|case| case["example"].as_str().unwrap().contains(example)), "{example}");
    }
    // Two values for each term of the eleven models, and one residual.
    let values = SETS.map(|name| of(name).count());
    assert_eq!(values, [5, 7, 3, 3, 23, 15, 13, 13, 13, 13, 13]);
    // Expected: the digits that programs with a QR factorisation in binary64 are reported to reach. By the normal equations
    // there would be none.
    let digits = of("Filip").map(|case| case["digits"].as_f64().unwrap()).fold(f64::INFINITY, f64::min);
    assert!(digits >= 7.0, "{digits}");
}

/// Each certified value is the solution of its set in rational numbers, to all of its digits.
#[test]
fn the_certified_values_are_solutions() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("nist_strd.json");
    let mut python = programs::python();
    python.arg(programs::project("tests/vectors/nist_strd.py")).arg(&file);
    programs::output(python);
    let written = fs::read_to_string(file).unwrap();
    assert!(written == include_str!("../vectors/nist_strd.json"), "run tests/vectors/nist_strd.py");
}
