//! Statements of `calibrate` on readings that are missing or could be added, checked against the calibrations with those
//! readings; and on the signs of the gyro type.

use crate::place::Place;
use crate::programs::in_one_line;
use serde_json::Value;

const CALIBRATE: &str =
    "calibrate passports/SPS-2/0017/moscow-bmstu-1.yaml --trust docs/allowed_signers --time 2026-11-20T08:00:00Z";
const CURRENTS: &str = "docs/currents.csv";
const LABORATORY: &str = "--laboratory docs/laboratory.yaml";
const GYRO: &str = "--gyro docs/gvk-6.yaml";

/// A folder with the example and the files that it is calibrated with.
fn folder() -> Place {
    let passport = "passports/SPS-2/0017/moscow-bmstu-1.yaml";
    let files = [passport, CURRENTS, "docs/allowed_signers", "docs/laboratory.yaml", "docs/gvk-6.yaml"];
    Place::of(&files.map(|name| (name, name)))
}

/// The text, in one line, and the JSON of a calibration of a gyro of the type on a file of currents.
fn calibrated(folder: &Place, currents: &str) -> (String, Value) {
    let run = |format: &str| folder.said(&format!("{CALIBRATE} {currents} {LABORATORY} {GYRO} --format {format}")).1;
    (in_one_line(&run("text")), serde_json::from_str(&run("json")).unwrap())
}

/// A number of every parameter of the decision, by its name.
fn each<'a>(result: &'a Value, key: &'a str) -> impl Iterator<Item = (&'a str, f64)> {
    let rows = result["verdict"]["parameters"].as_array().unwrap();
    rows.iter().map(move |row| (row["parameter"].as_str().unwrap(), row[key].as_f64().unwrap()))
}

/// The name of the parameter with the largest ratio of two numbers, and the ratio.
fn largest<'a>(
    above: impl Iterator<Item = (&'a str, f64)>,
    below: impl Iterator<Item = (&'a str, f64)>,
) -> (&'a str, f64) {
    let ratios = above.zip(below).map(|((name, above), (_, below))| (name, above / below));
    ratios.max_by(|one, other| one.1.total_cmp(&other.1)).unwrap()
}

/// Expected: exit code 1 for a current that is 0.1 mA off, alone, with a type, and among others.
#[test]
fn a_result_that_is_not_valid_is_refused() {
    let folder = folder();
    folder.write("off.csv", folder.read(CURRENTS).replace("-0.3002995", "-0.4002995"));
    let both = format!("{CURRENTS} off.csv");
    for (files, code) in [
        (CURRENTS, 0),
        ("off.csv", 1),
        (&format!("off.csv {GYRO}"), 1),
        (&both, 1),
        (&format!("{both} --format json"), 1),
    ] {
        folder.ends(&format!("{CALIBRATE} -j 1 {files}"), code, "");
    }
}

/// A wrong current of one position also fits with the frame's axis to the north or the south, but as another gyro: its K would be
/// turned by 90°. Only the gyro type tells.
#[test]
fn causes_that_make_the_readings_those_of_another_gyro_are_not_named() {
    let folder = folder();
    let right = folder.read(CURRENTS);
    let row = right.lines().find(|line| line.starts_with("1,3,")).unwrap();
    let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
    let [jx, jy] = [cells[2] + 1e-4, cells[3]];
    folder.write("wrong.csv", right.replace(row, &format!("1,3,{jx:.7},{jy:.7}")));
    let (with_type, result) = calibrated(&folder, "wrong.csv");
    let without_type = in_one_line(&folder.said(&format!("{CALIBRATE} wrong.csv {LABORATORY}")).1);
    const SAID: &str = "Position (1, 3) did not repeat";
    let causes = result["causes"].to_string();
    for (words, position, due) in
        [(with_type.as_str(), SAID, false), (&causes, SAID, false), (&without_type, SAID, true)]
    {
        assert!(words.contains(position), "{words}");
        assert_eq!(words.contains("axis of the frame"), due, "{words}");
    }
    // Of parameters that are not valid, nothing is decided.
    for row in result["verdict"]["parameters"].as_array().unwrap() {
        assert_eq!([&row["simple"], &row["guarded"]], ["undecided", "undecided"], "{row}");
    }
}

/// The site has no height, so most of U of ω_g and ω_k comes from local g, which no reading reduces.
#[test]
fn the_effect_of_positions_is_that_of_their_readings() {
    const U: &str = "expanded_uncertainty";
    let folder = folder();
    let full = folder.read(CURRENTS);
    let of = |begins: &[&str]| {
        let row = |begin: &&str| full.lines().find(|line| line.starts_with(begin)).unwrap().to_owned() + "\n";
        folder.write("some.csv", begins.iter().map(row).collect::<String>());
        calibrated(&folder, "some.csv")
    };
    let first = ["i,j", "1,1", "1,2", "1,3", "1,4", "2,1"];
    let (text, short) = of(&first);
    let (_, longer) = of(&[&first[..], &["2,2"]].concat());
    let (_, all) = calibrated(&folder, CURRENTS);

    let (worst, share) = largest(each(&short, U), each(&short, "tolerance"));
    assert_eq!(worst, "omega_g");
    let of_worst = |result| each(result, U).find(|(name, _)| *name == worst).unwrap().1;
    let reduced = 100.0 * (1.0 - of_worst(&longer) / of_worst(&short));
    let due = format!(
        "Largest U relative to its tolerance: ω_g, {:.0} %. A further visit to position (2, 2) would reduce it most, by {reduced:.0} %.",
        100.0 * share
    );
    assert!(text.contains(&due), "{due}\n{text}");

    let (most, ratio) = largest(each(&short, U), each(&all, U));
    assert_eq!(most, "k_x");
    assert!(text.contains(&format!("u(K_x) is {ratio:.2} times as large as with all positions.")), "{ratio}\n{text}");
}
