//! What a calibration says about readings that it does not have, against calibrations that have them.

use crate::programs;
use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// The text and the JSON of a calibration of the first gyro of the documentation on the file of currents.
fn calibrated(currents: &Path) -> (String, Value) {
    let run = |format: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
        command.current_dir(programs::project("")).args(["calibrate", "passports/SPS-2/0017/moscow-bmstu-1.yaml"]);
        command.arg(currents).args(["--trust", "docs/allowed_signers", "--time", "2026-11-20T08:00:00Z"]);
        command.args(["--gyro", "docs/gvk-6.yaml", "--laboratory", "docs/laboratory.yaml", "--format", format]);
        String::from_utf8(command.env("COLUMNS", "200").output().unwrap().stdout).unwrap()
    };
    (run("text"), serde_json::from_str(&run("json")).unwrap())
}

/// The expanded uncertainties of a result, each divided by that of another.
fn ratios(result: &Value, other: &Value) -> Vec<(String, f64)> {
    let all = |result: &Value| {
        let rows = result["verdict"]["parameters"].as_array().unwrap().clone();
        rows.into_iter()
            .map(|row| (row["parameter"].as_str().unwrap().to_owned(), row["expanded_uncertainty"].as_f64().unwrap()))
    };
    all(result).zip(all(other)).map(|((name, here), (_, there))| (name, here / there)).collect()
}

/// A maker that counts ω_k in the other direction.
#[test]
fn a_parameter_with_the_other_sign_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let gyro = std::fs::read_to_string(programs::project("docs/gvk-6.yaml")).unwrap();
    let turned = gyro.replace("omega_k_deg_per_h_per_g: 10}", "omega_k_deg_per_h_per_g: -10}");
    assert_ne!(gyro, turned);
    let gyro = folder.path().join("gyro.yaml");
    std::fs::write(&gyro, turned).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
    command.current_dir(programs::project("")).args(["calibrate", "passports/SPS-2/0017/moscow-bmstu-1.yaml"]);
    command.args(["docs/currents.csv", "--trust", "docs/allowed_signers", "--time", "2026-11-20T08:00:00Z", "--gyro"]);
    let output = command.arg(gyro).env("COLUMNS", "200").output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
            .contains("With the other sign these would be within the tolerance: ω_k."),
        "{text}"
    );
}

/// The site has no height, so most of U of ω_g and ω_k comes from local g, which no reading reduces.
#[test]
fn the_effect_of_positions_is_that_of_their_readings() {
    let folder = tempfile::tempdir().unwrap();
    let full = std::fs::read_to_string(programs::project("docs/currents.csv")).unwrap();
    let of = |name: &str, begins: &[&str]| {
        let rows =
            begins.iter().map(|begin| full.lines().find(|line| line.starts_with(begin)).unwrap().to_owned() + "\n");
        let path = folder.path().join(name);
        std::fs::write(&path, rows.collect::<String>()).unwrap();
        calibrated(&path)
    };
    let first = ["i,j", "1,1", "1,2", "1,3", "1,4", "2,1"];
    let (text, short) = of("short.csv", &first);
    let (_, longer) = of("longer.csv", &[&first[..], &["2,2"]].concat());
    let (_, all) = calibrated(&programs::project("docs/currents.csv"));

    let reduced = ratios(&longer, &short).into_iter().find(|(name, _)| name == "omega_g").unwrap().1;
    let due = format!("A further visit to position (2, 2) would reduce it most, by {:.0} %.", 100.0 * (1.0 - reduced));
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains(&format!("Largest U relative to its tolerance: ω_g, 152 %. {due}")), "{due}\n{text}");

    let (most, ratio) = ratios(&short, &all).into_iter().max_by(|one, other| one.1.total_cmp(&other.1)).unwrap();
    assert_eq!(most, "k_x");
    assert!(text.contains(&format!("u(K_x) is {ratio:.2} times as large as with all positions.")), "{ratio}\n{text}");
}
