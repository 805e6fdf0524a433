//! A laboratory's day in its workspace: the passport is found, results are kept, and each is compared with the last.

use crate::deliver::Place;
use crate::programs;
use serde_json::Value;
use std::ffi::OsString;
use std::fs;

/// A laboratory that has received both passports of a stand, states its place, and has currents of gyro 4711.
fn laboratory() -> Place {
    let place = Place::new();
    place.good("deliver SPS-2/0017 -o d.zip --workspace factory");
    let fingerprint = place.fingerprint("factory/factory.key.pub");
    place.good(&format!("receive d.zip lab --fingerprint {fingerprint}"));
    for (from, to) in [
        ("docs/currents.csv", "lab/readings/4711.csv"),
        ("docs/gvk-6.yaml", "lab/gyro.yaml"),
        ("docs/laboratory.yaml", "lab/laboratory.yaml"),
    ] {
        fs::copy(programs::project(from), place.path(to)).unwrap();
    }
    state(&place, "# gyro =", "gyro =");
    state(&place, "# laboratory =", "laboratory =");
    place
}

/// Changes a line of the laboratory's dtg-passport.toml.
fn state(place: &Place, old: &str, new: &str) {
    let path = place.path("lab/dtg-passport.toml");
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains(old), "{text}");
    fs::write(path, text.replacen(old, new, 1)).unwrap();
}

fn result(place: &Place, name: &str) -> Value {
    serde_json::from_slice(&fs::read(place.path("lab/results").join(name)).unwrap()).unwrap()
}

/// The change of each parameter that a result states, to nine digits.
fn changes_of(result: &Value) -> Vec<String> {
    let parameters = result["change"]["parameters"].as_array().unwrap();
    parameters.iter().map(|parameter| format!("{:.9}", parameter["deviation"].as_f64().unwrap())).collect()
}

/// The differences of the deviations from the nominal values, which two results state independently.
fn changes_between(first: &Value, second: &Value) -> Vec<String> {
    let deviations = |result: &Value| -> Vec<f64> {
        let parameters = result["verdict"]["parameters"].as_array().unwrap();
        parameters.iter().map(|parameter| parameter["deviation"].as_f64().unwrap()).collect()
    };
    let pairs = deviations(second).into_iter().zip(deviations(first));
    pairs.map(|(second, first)| format!("{:.9}", second - first)).collect()
}

#[test]
fn one_word_calibrates_a_gyro() {
    let place = laboratory();
    // Two places are possible, until one is stated.
    let output = place.run("calibrate lab/readings/4711.csv --workspace lab");
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(2) && said.contains("state the place of the stand with `at`"), "{said}");
    state(&place, "# at = \"55.7658,37.6856\"", "at = \"55°45′56.9″N,37°41′08.2″E\"");
    assert!(!place.path("lab/results/x").exists() && fs::read_dir(place.path("lab/results")).unwrap().count() == 0);

    place.good("calibrate lab/readings/4711.csv --workspace lab --date 2026-11-27");
    let first = result(&place, "4711-2026-11-27.json");
    assert_eq!(first["passport_id"], "SPS-2/0017/moscow-bmstu/1");
    assert_eq!(first["passport_verified"], true);
    assert_eq!(first["subject"]["gyro_serial"], "4711");
    assert_eq!(first["register"]["sequence"], 1);
    assert!(first["change"].is_null());
    let page = fs::read_to_string(place.path("lab/results/4711-2026-11-27.html")).unwrap();
    assert!(page.contains("4711"));
    // Expected: what `calibrate` finds when everything is stated.
    let stated = place.good(
        "calibrate lab/passports/SPS-2/0017/moscow-bmstu-1.yaml lab/readings/4711.csv --trust lab/allowed_signers --gyro \
         lab/gyro.yaml --laboratory lab/laboratory.yaml --format json",
    );
    let stated: Value = serde_json::from_str(&stated).unwrap();
    assert_eq!((&first["results"], &first["verdict"]), (&stated["results"], &stated["verdict"]));

    // The second of a day gets a number, a year later the last one is compared, and nothing is replaced.
    let currents = fs::read_to_string(place.path("lab/readings/4711.csv")).unwrap();
    fs::write(place.path("lab/readings/4711.csv"), currents.replace("1,1,", "1, 1,")).unwrap();
    place.good("calibrate lab/readings/4711.csv --workspace lab --date 2026-11-27");
    let second = result(&place, "4711-2026-11-27-2.json");
    let keys = |of: &Value| of.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    assert_eq!(keys(&second["change"]), keys(&second["verdict"]));
    assert_eq!(changes_of(&second), changes_between(&first, &second));
    assert_eq!(result(&place, "4711-2026-11-27.json"), first);
    place.good("calibrate lab/readings/4711.csv --workspace lab --date 2026-11-28 --gyro-serial B-2");
    assert!(result(&place, "B-2-2026-11-28.json")["change"].is_null(), "another gyro");

    // At another place, of another stand, or when it has expired, it is refused, and nothing is written.
    let before = place.files();
    place.refused("calibrate lab/readings/4711.csv --workspace lab --at 40.2455,116.2240", "(wrong_place)");
    place.refused("calibrate lab/readings/4711.csv --workspace lab --time 2031-01-01", "(expired)");
    for arguments in ["--serial 0018", "--no-verify"] {
        let output = place.run(&format!("calibrate lab/readings/4711.csv --workspace lab {arguments}"));
        assert_eq!(output.status.code(), Some(2), "{arguments}");
    }
    fs::copy(place.path("lab/readings/4711.csv"), place.path("no serial.csv")).unwrap();
    let output = place.command(&["calibrate", "no serial.csv", "--workspace", "lab"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("expected the serial number of the gyro"));
    fs::remove_file(place.path("no serial.csv")).unwrap();
    assert!(place.files() == before);
}

#[test]
fn thirty_gyros_are_calibrated_in_one_command() {
    let place = laboratory();
    state(&place, "# at =", "at =");
    let currents = fs::read_to_string(place.path("lab/readings/4711.csv")).unwrap();
    fs::remove_file(place.path("lab/readings/4711.csv")).unwrap();
    // Gyros differ in their readings: each current of gyro n is n nA higher than that of the example.
    let header = currents.lines().find(|line| line.starts_with("i,j")).unwrap();
    let rows: Vec<Vec<f64>> = currents
        .lines()
        .skip_while(|line| *line != header)
        .skip(1)
        .filter(|line| !line.starts_with('#'))
        .map(|line| line.split(',').map(|cell| cell.trim().parse().unwrap()).collect())
        .collect();
    let jx = header.split(',').position(|name| name == "jx_ma").unwrap();
    for year in [0, 1] {
        for gyro in 1..=30 {
            let shift = 1e-6 * f64::from(gyro + 40 * year);
            let row = |row: &Vec<f64>| {
                let cells = row.iter().enumerate().map(|(place, cell)| if place == jx { cell + shift } else { *cell });
                cells.map(|cell| cell.to_string()).collect::<Vec<_>>().join(",")
            };
            let lines: Vec<String> = rows.iter().map(row).collect();
            fs::write(place.path(&format!("lab/readings/G-{gyro}.csv")), format!("{header}\n{}\n", lines.join("\n")))
                .unwrap();
        }
        place.good(&format!("calibrate lab/readings --workspace lab --date 2026-11-{}", 27 + year));
    }
    let names: Vec<_> =
        fs::read_dir(place.path("lab/results")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    let with = |end: &str| names.iter().filter(|name| name.to_str().unwrap().ends_with(end)).count();
    assert_eq!((with(".json"), with(".html")), (60, 60));
    for gyro in 1..=30 {
        let [first, second] = [27, 28].map(|day| result(&place, &format!("G-{gyro}-2026-11-{day}.json")));
        assert_eq!(second["subject"]["gyro_serial"], format!("G-{gyro}"));
        assert!(first["change"].is_null());
        assert_eq!(changes_of(&second), changes_between(&first, &second));
        let page = fs::read_to_string(place.path(&format!("lab/results/G-{gyro}-2026-11-28.html"))).unwrap();
        assert!(page.contains(&format!("G-{gyro}")), "{gyro}");
    }
}

#[test]
fn status_says_what_is_in_force_and_until_when() {
    let place = Place::new();
    place.good("register factory/passports --renew --fresh-until 2027-11-20 --workspace factory");
    place.good("deliver SPS-2/0017/moscow-bmstu -o d.zip --workspace factory");
    let fingerprint = place.fingerprint("factory/factory.key.pub");
    place.good(&format!("receive d.zip lab --fingerprint {fingerprint}"));
    let said = place.good("status --workspace lab");
    for words in
        ["NO ALARMS", "1 in force", "register 2", "fresh until 2027-11-20", "SPS-2/0017/moscow-bmstu/1  valid until"]
    {
        assert!(said.contains(words), "lacks {words}\n{said}");
    }
    for words in ["torino", "Stands", "Sites"] {
        assert!(!said.contains(words), "{words} is not the laboratory's\n{said}");
    }
}

/// A real browser prints the report next to the result. Expected: poppler reads the serial number in it.
#[cfg(unix)]
#[test]
fn a_report_is_printed_into_the_results() {
    let place = laboratory();
    state(&place, "# at =", "at =");
    let mut calibrate = std::process::Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
    calibrate.args("calibrate lab/readings/4711.csv --workspace lab --date 2026-11-27".split(' '));
    // As root, Chromium starts only without its sandbox.
    calibrate.current_dir(place.path("")).env("DTG_PASSPORT_BROWSER", "chromium --no-sandbox");
    programs::output(calibrate);
    let mut names: Vec<_> =
        fs::read_dir(place.path("lab/results")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["html", "json", "pdf"].map(|end| format!("4711-2026-11-27.{end}").into()) as [OsString; 3]);
    let mut text = programs::on_path("pdftotext");
    text.arg(place.path("lab/results/4711-2026-11-27.pdf")).arg("-");
    assert!(programs::output(text).contains("4711"));
}

/// Expected: at most 230 characters, with the line ends, for two commands on each side; workspaces by the environment.
#[test]
fn a_moved_stand_is_handed_over_in_four_commands() {
    let place = Place::before_issue();
    place.good("issue SPS-2/0017 --site moscow-bmstu --workspace factory");
    place.good("deliver SPS-2/0017 -o old.zip --workspace factory");
    let fingerprint = place.fingerprint("factory/factory.key.pub");
    place.good(&format!("receive old.zip lab --fingerprint {fingerprint}"));
    fs::copy(programs::project("docs/currents.csv"), place.path("4711.csv")).unwrap();
    let mut characters = 0;
    for (workspace, typed) in [
        ("factory", "dtg-passport reissue SPS-2/0017/moscow-bmstu/1 --site torino-inrim --moved --reason sold"),
        ("factory", "dtg-passport deliver SPS-2/0017 -o d.zip"),
        ("lab", "dtg-passport receive d.zip"),
        ("lab", "dtg-passport calibrate 4711.csv"),
    ] {
        characters += typed.chars().count() + 1;
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
        command.args(typed.split(' ').skip(1)).current_dir(place.path(""));
        command.env("DTG_PASSPORT_WORKSPACE", workspace).env("DTG_PASSPORT_BROWSER", "no-browser-of-this-name");
        programs::output(command);
    }
    println!("{characters} characters");
    assert!(characters <= 230, "{characters}");
    let results: Vec<_> = fs::read_dir(place.path("lab/results")).unwrap().collect();
    assert_eq!(results.len(), 2, "JSON and HTML");
}
