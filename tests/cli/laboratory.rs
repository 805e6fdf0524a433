//! A laboratory's day in its workspace: the passport is found, results are kept, and each is compared with the last.

use crate::place::Place;
use crate::programs;
use serde_json::Value;
use std::fs;

/// A laboratory that has received both passports of a stand, states its place, and has currents of gyro 4711.
fn laboratory() -> Place {
    let (place, fingerprint) = Place::with_delivery("SPS-2/0017");
    place.good(&format!("receive d.zip lab --fingerprint {fingerprint}"));
    place.copy("docs/currents.csv", "lab/readings/4711.csv");
    place.copy("docs/gvk-6.yaml", "lab/gyro.yaml");
    place.copy("docs/laboratory.yaml", "lab/laboratory.yaml");
    place.change(SETTINGS, "# gyro =", "gyro =");
    place.change(SETTINGS, "# laboratory =", "laboratory =");
    place
}

const SETTINGS: &str = "lab/dtg-passport.toml";

fn result(place: &Place, name: &str) -> Value {
    serde_json::from_str(&place.read(format!("lab/results/{name}"))).unwrap()
}

/// Fails unless the change of each parameter that a result states is, to nine digits, the difference of its deviations
/// from the nominal value, which both results state independently.
fn has_changed_since(second: &Value, first: &Value) {
    let deviations = |of: &Value| -> Vec<f64> {
        let parameters = of["parameters"].as_array().unwrap();
        parameters.iter().map(|parameter| parameter["deviation"].as_f64().unwrap()).collect()
    };
    let nine_digits = |number: f64| format!("{number:.9}");
    let due = deviations(&second["verdict"]).into_iter().zip(deviations(&first["verdict"]));
    let due: Vec<_> = due.map(|(second, first)| nine_digits(second - first)).collect();
    assert_eq!(deviations(&second["change"]).into_iter().map(nine_digits).collect::<Vec<_>>(), due);
}

#[test]
fn one_word_calibrates_a_gyro() {
    let place = laboratory();
    // Two places are possible, until one is stated.
    place.ends("calibrate lab/readings/4711.csv --workspace lab", 2, "state the place of the stand with `at`");
    place.change(SETTINGS, "# at = \"55.7658,37.6856\"", "at = \"55°45′56.9″N,37°41′08.2″E\"");
    assert!(place.names("lab/results").is_empty());

    place.good("calibrate lab/readings/4711.csv --workspace lab --date 2026-11-27");
    let first = result(&place, "4711-2026-11-27.json");
    assert_eq!(first["passport_id"], "SPS-2/0017/moscow-bmstu/1");
    assert_eq!(first["passport_verified"], true);
    assert_eq!(first["subject"]["gyro_serial"], "4711");
    assert_eq!(first["register"]["sequence"], 1);
    assert!(first["change"].is_null());
    assert!(place.read("lab/results/4711-2026-11-27.html").contains("4711"));
    // Expected: what `calibrate` finds when everything is stated.
    let stated = place.json(
        "calibrate lab/passports/SPS-2/0017/moscow-bmstu-1.yaml lab/readings/4711.csv --trust lab/allowed_signers --gyro \
         lab/gyro.yaml --laboratory lab/laboratory.yaml",
        0,
    );
    assert_eq!((&first["results"], &first["verdict"]), (&stated["results"], &stated["verdict"]));

    // The second of a day gets a number, a year later the last one is compared, and nothing is replaced.
    place.change("lab/readings/4711.csv", "1,1,", "1, 1,");
    place.good("calibrate lab/readings/4711.csv --workspace lab --date 2026-11-27");
    let second = result(&place, "4711-2026-11-27-2.json");
    let keys = |of: &Value| of.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    assert_eq!(keys(&second["change"]), keys(&second["verdict"]));
    has_changed_since(&second, &first);
    assert_eq!(result(&place, "4711-2026-11-27.json"), first);
    place.good("calibrate lab/readings/4711.csv --workspace lab --date 2026-11-28 --gyro-serial B-2");
    assert!(result(&place, "B-2-2026-11-28.json")["change"].is_null(), "another gyro");

    // At another place, of another stand, or when it has expired, it is refused, and nothing is written.
    let before = place.files();
    place.refused("calibrate lab/readings/4711.csv --workspace lab --at 40.2455,116.2240", "(wrong_place)");
    place.refused("calibrate lab/readings/4711.csv --workspace lab --time 2031-01-01", "(expired)");
    for arguments in ["--serial 0018", "--no-verify"] {
        place.ends(&format!("calibrate lab/readings/4711.csv --workspace lab {arguments}"), 2, "");
    }
    fs::copy(place.path("lab/readings/4711.csv"), place.path("no serial.csv")).unwrap();
    let output = place.program().args(["calibrate", "no serial.csv", "--workspace", "lab"]).output().unwrap();
    assert!(String::from_utf8_lossy(&output.stderr).contains("expected the serial number of the gyro"));
    fs::remove_file(place.path("no serial.csv")).unwrap();
    assert!(place.files() == before);
}

#[test]
fn thirty_gyros_are_calibrated_in_one_command() {
    let place = laboratory();
    place.change(SETTINGS, "# at =", "at =");
    let currents = place.read("lab/readings/4711.csv");
    fs::remove_file(place.path("lab/readings/4711.csv")).unwrap();
    for year in [0, 1] {
        for gyro in 1..=30 {
            // Gyros differ in their readings: each J_x of gyro n is n nA higher than that of the example.
            let shift = 1e-6 * f64::from(gyro + 40 * year);
            let row = |line: &str| match line.split(',').collect::<Vec<_>>()[..] {
                [i, j, x, y] if i != "i" => format!("{i},{j},{},{y}\n", x.parse::<f64>().unwrap() + shift),
                _ => format!("{line}\n"),
            };
            place.write(format!("lab/readings/G-{gyro}.csv"), currents.lines().map(row).collect::<String>());
        }
        place.good(&format!("calibrate lab/readings --workspace lab --date 2026-11-{}", 27 + year));
    }
    let names = place.names("lab/results");
    let with = |end: &str| names.iter().filter(|name| name.ends_with(end)).count();
    assert_eq!((with(".json"), with(".html")), (60, 60));
    for gyro in 1..=30 {
        let [first, second] = [27, 28].map(|day| result(&place, &format!("G-{gyro}-2026-11-{day}.json")));
        assert_eq!(second["subject"]["gyro_serial"], format!("G-{gyro}"));
        assert!(first["change"].is_null());
        has_changed_since(&second, &first);
        let page = place.read(format!("lab/results/G-{gyro}-2026-11-28.html"));
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
    place.change(SETTINGS, "# at =", "at =");
    let mut calibrate = place.program();
    calibrate.args("calibrate lab/readings/4711.csv --workspace lab --date 2026-11-27".split(' '));
    // As root, Chromium starts only without its sandbox.
    programs::output(calibrate.env("DTG_PASSPORT_BROWSER", "chromium --no-sandbox"));
    assert_eq!(place.names("lab/results"), ["html", "json", "pdf"].map(|end| format!("4711-2026-11-27.{end}")));
    let pdf = place.path("lab/results/4711-2026-11-27.pdf");
    assert!(programs::output(programs::on_path("pdftotext").arg(pdf).arg("-")).contains("4711"));
}

/// Expected: at most 230 characters, with the line ends, for two commands on each side; workspaces by the environment.
#[test]
fn a_moved_stand_is_handed_over_in_four_commands() {
    let place = Place::before_issue();
    place.good("issue SPS-2/0017 --site moscow-bmstu --workspace factory");
    place.good("deliver SPS-2/0017 -o old.zip --workspace factory");
    let fingerprint = place.fingerprint("factory/factory.key.pub");
    place.good(&format!("receive old.zip lab --fingerprint {fingerprint}"));
    place.copy("docs/currents.csv", "4711.csv");
    let mut characters = 0;
    for (workspace, typed) in [
        ("factory", "dtg-passport reissue SPS-2/0017/moscow-bmstu/1 --site torino-inrim --moved --reason sold"),
        ("factory", "dtg-passport deliver SPS-2/0017 -o d.zip"),
        ("lab", "dtg-passport receive d.zip"),
        ("lab", "dtg-passport calibrate 4711.csv"),
    ] {
        characters += typed.chars().count() + 1;
        let words = typed.split(' ').skip(1);
        programs::output(place.program().args(words).env("DTG_PASSPORT_WORKSPACE", workspace));
    }
    println!("{characters} characters");
    assert!(characters <= 230, "{characters}");
    assert_eq!(place.names("lab/results").len(), 2, "JSON and HTML");
}
