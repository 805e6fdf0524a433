//! `certify` on the command line: what it writes, and every way in which its input is refused.

use assert_cmd::Command;
use std::fs;
use std::path::{Path, PathBuf};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn example(name: &str) -> String {
    fs::read_to_string(Path::new(ROOT).join("docs").join(name)).unwrap()
}

/// A folder of its own for a test, with the examples of the documentation.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("certify").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    for file in ["angles.csv", "check.csv", "header.yaml"] {
        fs::write(folder.join(file), example(file)).unwrap();
    }
    folder
}

/// Exit code, standard output, standard error.
fn run(folder: &Path, arguments: &str) -> (i32, String, String) {
    let mut command = Command::cargo_bin("dtg-passport").unwrap();
    let output = command.current_dir(folder).arg("certify").args(arguments.split(' ')).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

/// Runs with other readings; gives the exit code and what was said.
fn with_readings(folder: &Path, readings: &str) -> (i32, String) {
    fs::write(folder.join("r.csv"), readings).unwrap();
    let (code, _, said) = run(folder, "r.csv --stand header.yaml -o out.yaml");
    assert!(code == 0 || !folder.join("out.yaml").exists(), "a refusal leaves no file");
    let _ = fs::remove_file(folder.join("out.yaml"));
    (code, said)
}

/// The line of position (i, j) in a run, its number replaced.
fn replaced(place: &str, column: usize, value: impl Fn(&str) -> String) -> String {
    let lines = example("angles.csv");
    let lines = lines.lines().map(|line| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if line.starts_with(place) {
            cells[column] = value(&cells[column]);
        }
        cells.join(",") + "\n"
    });
    lines.collect()
}

#[test]
fn bad_readings_are_refused_with_their_place() {
    let folder = folder("bad");
    let good = example("angles.csv");
    let without =
        |start: &str| good.lines().filter(|line| !line.starts_with(start)).map(|line| format!("{line}\n")).collect();
    let one_run: String = good
        .lines()
        .filter(|line| line.starts_with(['#', 'i']) || line.split(',').nth(2) == Some("1"))
        .map(|line| format!("{line}\n"))
        .collect();
    let degrees = |text: &str| format!("{}", text.parse::<f64>().unwrap() / 3600.0);
    let twice = |text: &str| format!("{}", text.parse::<f64>().unwrap() * 3600.0);
    let cases: Vec<(String, i32, &[&str])> = vec![
        (one_run, 1, &["one run", "repeatability can be estimated", "better five"]),
        (without("2,3,4,"), 2, &["no reading of position (2, 3) in run 4", "omit the whole run"]),
        (without("2,3,"), 2, &["no reading of position (2, 3), expected a reading of every position", "of this stand"]),
        (good.replace("\n2,4,", "\n3,4,"), 2, &["r.csv:10:1", "position (3, 4)", "readings of this stand"]),
        (replaced("1,2,3,", 3, degrees), 2, &["r.csv:20:7: alpha_arcsec", "convert it from degrees to arcseconds"]),
        (replaced("1,1,2,", 3, twice), 2, &["r.csv:11:7: alpha_arcsec", "convert it to arcseconds only once"]),
        (replaced("1,1,2,", 3, |_| "10012.4".into()), 2, &["check the digits, the sign and the position"]),
        (replaced("1,1,2,", 3, |_| "170000".into()), 2, &["45 degrees", "in arcseconds"]),
        (replaced("1,1,2,", 3, |_| "x".into()), 2, &["r.csv:11:7", "a number"]),
        (replaced("1,1,2,", 2, |_| "0".into()), 2, &["run", "a whole number from 1"]),
        (good.replace("run,", ""), 2, &["no column run"]),
        (String::new(), 2, &["empty file"]),
    ];
    for (readings, code, words) in cases {
        let (found, said) = with_readings(&folder, &readings);
        assert_eq!(found, code, "{said}");
        words.iter().for_each(|word| assert!(said.contains(word), "{said:?} without {word:?}"));
    }
}

#[test]
fn bad_headers_are_refused_with_their_place() {
    let folder = folder("header");
    let good = example("header.yaml");
    let cases = [
        (
            "datum:",
            "  repeatability_arcsec: 1.5\ndatum:",
            &["certificate.repeatability_arcsec", "it is computed from the readings"][..],
        ),
        (
            "theta_deg: 90, phi_deg: 180}",
            "theta_deg: 90, phi_deg: 180, alpha_arcsec: 1}",
            &["unknown key \"alpha_arcsec\""],
        ),
        ("i: 2, j: 4, theta_deg: 90", "i: 2, j: 4, theta_deg: 80", &["theta_deg", "90 for position (2, 4)"]),
        ("i: 2, j: 4,", "i: 2, j: 3,", &["duplicate position (2, 3)"]),
        ("dtg-stand/1", "dtg-site/1", &["check that this is the right file"]),
    ];
    for (from, to, words) in cases {
        fs::write(folder.join("header.yaml"), good.replace(from, to)).unwrap();
        let (code, _, said) = run(&folder, "angles.csv --stand header.yaml -o out.yaml");
        assert_eq!(code, 2, "{said}");
        words.iter().for_each(|word| assert!(said.contains(word), "{said:?} without {word:?}"));
    }
}

/// Rows of a position and run that stand twice are one return read twice; columns and rows come in any order.
#[test]
fn form_does_not_matter() {
    let folder = folder("form");
    let lines: Vec<String> = example("angles.csv").lines().skip(1).map(str::to_owned).collect();
    let turned = lines.iter().rev().map(|line| line.split(',').rev().collect::<Vec<_>>().join(" , "));
    let mut turned: Vec<String> = turned.collect();
    turned.insert(0, turned[turned.len() - 1].clone());
    let last = turned.len() - 1;
    turned[last] = turned[1].clone();
    fs::write(folder.join("r.csv"), turned.join("\r\n")).unwrap();
    let (code, text, said) = run(&folder, "r.csv --stand header.yaml -o other.yaml");
    assert_eq!(code, 0, "{said}");
    assert!(text.contains("of the same visit: 1."), "{text}");
    assert_eq!(run(&folder, "angles.csv --stand header.yaml -o stand.yaml").0, 0);
    // The digest alone tells that it was another file.
    let read = |name: &str| {
        let text = fs::read_to_string(folder.join(name)).unwrap();
        text.lines().filter(|line| !line.contains("readings_sha256")).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(read("other.yaml"), read("stand.yaml"));
}

#[test]
fn files_are_not_replaced_unless_told() {
    let folder = folder("force");
    let certify = "angles.csv --stand header.yaml -o stand.yaml";
    assert_eq!(run(&folder, certify).0, 0);
    let (code, _, said) = run(&folder, certify);
    assert!(code == 1 && said.contains("to replace it, use --force"), "{said}");
    assert_eq!(run(&folder, &format!("{certify} --force")).0, 0);
    assert_eq!(run(&folder, "angles.csv -o stand.yaml").0, 2);
    assert_eq!(run(&folder, "angles.csv --stand header.yaml").0, 2);
    assert_eq!(run(&folder, "nothing.csv --stand header.yaml -o x.yaml").0, 2);
}

/// A check: exit code 1 when it is not the same stand, and the position by name; another stand is refused.
#[test]
fn a_check_has_an_exit_code() {
    let folder = folder("check");
    assert_eq!(run(&folder, "angles.csv --stand header.yaml -o stand.yaml").0, 0);
    let (code, text, _) = run(&folder, "check.csv --against stand.yaml");
    assert!(code == 1 && text.contains("position (2, 3) has changed"), "{text}");
    let (code, text, _) = run(&folder, "check.csv --against stand.yaml --format json");
    let found: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert!(code == 1 && found["comparison"]["same_stand"] == false, "{text}");
    assert!(found["not_certified"].as_str().unwrap().starts_with("found one run"));
    let (code, text, said) = run(&folder, "angles.csv --against stand.yaml --format json");
    let found: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert!(code == 0 && found["comparison"]["same_stand"] == true, "{said}{text}");
    assert_eq!(found["certification"]["stand"]["positions"].as_array().unwrap().len(), 8);
    fs::write(folder.join("header.yaml"), example("header.yaml").replace("0017", "0018")).unwrap();
    let (code, _, said) = run(&folder, "check.csv --stand header.yaml --against stand.yaml");
    assert!(code == 1 && said.contains("SPS-2 0017") && said.contains("SPS-2 0018"), "{said}");
}

/// The cells of every line of a run, changed.
fn run_changed(run: &str, change: impl Fn(Vec<String>) -> Vec<String>) -> String {
    let lines = example("angles.csv");
    let lines = lines.lines().map(|line| {
        let cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        let changed = cells.len() == 6 && cells[2] == run;
        (if changed { change(cells) } else { cells }).join(",") + "\n"
    });
    lines.collect()
}

fn scaled(run: &str, factor: f64) -> String {
    run_changed(run, |mut cells| {
        cells[3..].iter_mut().for_each(|cell| *cell = format!("{:.4}", cell.parse::<f64>().unwrap() * factor));
        cells
    })
}

#[test]
fn mistakes_of_a_whole_run_are_named() {
    let folder = folder("runs");
    let good = example("angles.csv");
    let copy_as = |from: &str, to: &str| -> String {
        let copied = good.lines().filter(|line| line.split(',').nth(2) == Some(from));
        let renamed = copied.map(|line| {
            let mut cells: Vec<&str> = line.split(',').collect();
            cells[2] = to;
            cells.join(",") + "\n"
        });
        renamed.collect()
    };
    let identical: String =
        good.lines().filter(|line| line.split(',').nth(2) != Some("3")).map(|line| format!("{line}\n")).collect();
    let two = good.lines().filter(|line| line.starts_with(['#', 'i']) || line.split(',').nth(2) == Some("1"));
    let two: String = two.map(|line| format!("{line}\n")).collect();
    let cases: Vec<(String, &[&str])> = vec![
        (
            good.clone() + &copy_as("2", "6"),
            &["r.csv:43:5: run", "run 6 with the same angles as run 2", "delete the copy"],
        ),
        (identical + &copy_as("5", "3"), &["run 5 with the same angles as run 3"]),
        (two + &copy_as("1", "2"), &["run 2 with the same angles as run 1"]),
        (scaled("3", 1.0 / 60.0), &["r.csv:19:5: run", "run 3", "divided by 60", "arcminutes"]),
        (scaled("1", 1.0 / 3600.0), &["run 1", "divided by 3600", "degrees"]),
        (scaled("4", 60.0), &["run 4", "60 times those of the other runs"]),
        (scaled("2", -1.0), &["run 2", "opposite sign", "correct the sign"]),
    ];
    for (readings, words) in cases {
        let (code, said) = with_readings(&folder, &readings);
        assert_eq!(code, 2, "{said}");
        words.iter().for_each(|word| assert!(said.contains(word), "{said:?} without {word:?}"));
        assert_eq!(said.matches("r.csv:").count(), 1, "one run is named: {said}");
    }
}

/// Other angles never go under a number that is there, --force or not.
#[test]
fn a_number_keeps_its_angles() {
    let folder = folder("number");
    assert_eq!(run(&folder, "angles.csv --stand header.yaml -o stand.yaml").0, 0);
    let old = fs::read(folder.join("stand.yaml")).unwrap();
    fs::write(folder.join("new.csv"), replaced("1,1,", 3, |text| format!("{}", text.parse::<f64>().unwrap() + 3.0)))
        .unwrap();
    for arguments in [
        "new.csv --against stand.yaml -o new.yaml",
        "new.csv --against stand.yaml --stand header.yaml -o new.yaml",
        "new.csv --against stand.yaml --stand header.yaml -o new.yaml --force",
        "new.csv --stand header.yaml -o stand.yaml --force",
    ] {
        let (code, _, said) = run(&folder, arguments);
        assert_eq!(code, 1, "{arguments}: {said}");
        assert!(said.contains("certificate C-2026-0142") && said.contains("position (1, 1)"), "{said}");
        assert!(
            !folder.join("new.yaml").exists() && fs::read(folder.join("stand.yaml")).unwrap() == old,
            "{arguments}"
        );
    }
    // The same angles under the old number, and no header that says when: nothing to write.
    let (code, _, said) = run(&folder, "angles.csv --against stand.yaml -o new.yaml");
    assert!(code == 2 && said.contains("--stand HEADER.yaml"), "{said}");
    let header = example("header.yaml").replace("C-2026-0142", "C-2027-0007");
    fs::write(folder.join("header.yaml"), header).unwrap();
    let (code, _, said) = run(&folder, "new.csv --against stand.yaml --stand header.yaml -o new.yaml");
    assert!(said.contains("wrote new.yaml"), "{code} {said}");
}

#[test]
fn what_is_odd_is_said() {
    let folder = folder("odd");
    let header = example("header.yaml").replace("temperature_c: 20.0", "temperature_c: 293.15");
    fs::write(folder.join("header.yaml"), header).unwrap();
    let (code, text, _) = run(&folder, "angles.csv --stand header.yaml -o stand.yaml");
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(code == 0 && text.contains("WARNING: temperature_c is 293.15") && text.contains("in kelvin"), "{text}");
    let shifted = replaced("2,1,", 3, |text| format!("{:.1}", text.parse::<f64>().unwrap() + 67_833.0));
    fs::write(folder.join("r.csv"), shifted).unwrap();
    let (code, text, _) = run(&folder, "r.csv --stand header.yaml -o odd.yaml");
    assert!(code == 0 && text.contains("alpha_arcsec of position (2, 1) is 678"), "{text}");
}
