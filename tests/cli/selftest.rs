//! The self-test passes, and says so.

use assert_cmd::Command;

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
