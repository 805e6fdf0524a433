//! Records of certifications, as the program writes them, against the result that it gives to programs.

use crate::pages::{Page, browsed, strings};
use crate::programs;
use dtg_passport::report::Language::{English, Russian};
use dtg_passport::report::{Language, Languages};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

/// One record: its languages, its readings, and what else `certify` is asked.
struct Record {
    name: &'static str,
    languages: &'static [Language],
    readings: &'static str,
    asked: &'static [&'static str],
}

/// The reason for an exclusion, which would be markup anywhere else.
const HOSTILE: &str = "</p></section><script>alert('x')</script> & co, лампа";

const RECORDS: &[Record] = &[
    Record { name: "record-en", languages: &[English], readings: "angles.csv", asked: &[] },
    Record {
        name: "record-ru",
        languages: &[Russian],
        readings: "angles.csv",
        asked: &["--exclude", "1,3,2", "--why", HOSTILE],
    },
    Record {
        name: "record-both",
        languages: &[Russian, English],
        readings: "later.csv",
        asked: &[
            "--against",
            "first.yaml",
            "--exclude",
            "4",
            "--why",
            "the lamp failed",
            "--exclude",
            "1,3,2",
            "--why",
            "the door was opened",
        ],
    },
    // An outlier, and a position that scatters more: the tests name them.
    Record {
        name: "record-odd-both",
        languages: &[English, Russian],
        readings: "odd.csv",
        asked: &["--against", "first.yaml"],
    },
];

/// Records and what was found on them.
pub struct Certified {
    folder: PathBuf,
    languages: Vec<Languages>,
    found: Value,
}

/// The records are written and opened once for all tests.
pub static CERTIFIED: LazyLock<Certified> = LazyLock::new(|| {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("record");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    files(&folder);
    RECORDS.iter().for_each(|record| record.write(&folder));
    let found = browsed(&folder, RECORDS.iter().map(|record| record.name));
    let languages = |record: &Record| Languages::new(record.languages[0], record.languages[1..].iter().copied());
    Certified { languages: RECORDS.iter().map(languages).collect(), folder, found }
});

impl Certified {
    /// Each record as a page.
    pub fn pages(&self) -> impl Iterator<Item = Page<'_>> {
        RECORDS.iter().zip(&self.languages).map(|(record, languages)| Page {
            name: record.name,
            folder: &self.folder,
            languages,
            own_words: "C-2028-0007 C-2026-0143",
            found: &self.found[record.name],
        })
    }
}

impl Record {
    fn write(&self, folder: &Path) {
        let tags: Vec<&str> = self.languages.iter().map(|language| language.tag()).collect();
        let mut certify = certify(folder, self.readings, "header.yaml", &format!("{}.yaml", self.name));
        certify.args(["--format", "json", "--lang", &tags.join(","), "--report", &format!("{}.html", self.name)]);
        let output = certify.args(self.asked).output().unwrap();
        assert!(folder.join(format!("{}.html", self.name)).exists(), "{}", String::from_utf8_lossy(&output.stderr));
        fs::write(folder.join(format!("{}.json", self.name)), output.stdout).unwrap();
    }
}

fn certify(folder: &Path, readings: &str, header: &str, stand: &str) -> Command {
    let mut certify = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
    certify.current_dir(folder).args(["certify", readings, "--stand", header, "-o", stand]);
    certify
}

/// The readings of the guide, and later ones of the same stand with one position changed.
fn files(folder: &Path) {
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
    let example = |name: &str| fs::read_to_string(programs::project(name)).unwrap();
    let (angles, header) = (example("docs/angles.csv"), example("docs/header.yaml"));
    let changed = |by: &dyn Fn(&[String]) -> f64| -> String {
        let lines = angles.lines().enumerate().map(|(number, line)| {
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            if cells.len() == 6 && cells[0] != "i" {
                let noise = (number * 7 % 13) as f64 / 26.0;
                cells[5] = format!("{:.3}", cells[5].parse::<f64>().unwrap() + noise + by(&cells));
            }
            cells.join(",") + "\n"
        });
        lines.collect()
    };
    write("angles.csv", &angles);
    write("first-header.yaml", &header);
    programs::output(certify(folder, "angles.csv", "first-header.yaml", "first.yaml"));
    let type_b = "  type_b: [{source: \"autocollimator\", acts_on: \"position\", u_arcsec: 0.3}, \
                  {source: \"level\", acts_on: \"base\", u_arcsec: 0.4, degrees_of_freedom: 8}]\ndatum:";
    write("header.yaml", &header.replace("C-2026-0143", "C-2028-0007").replace("datum:", type_b));
    write("later.csv", &changed(&|cells| if cells[0] == "2" && cells[1] == "3" { 9.0 } else { 0.0 }));
    write("odd.csv", &changed(&|cells| if cells[..3] == ["1", "2", "3"] { 60.0 } else { 0.0 }));
}

/// Every number of a document, at any depth.
fn numbers(value: &Value, found: &mut Vec<f64>) {
    match value {
        Value::Number(number) => found.push(number.as_f64().unwrap()),
        Value::Array(items) => items.iter().for_each(|item| numbers(item, found)),
        Value::Object(entries) => entries.values().for_each(|item| numbers(item, found)),
        _ => {}
    }
}

/// Expected: the JSON of `certify`, U by contributions from it, the readings file, and the reason as it was typed.
#[test]
fn a_record_has_the_numbers_of_the_certificate() {
    for record in RECORDS {
        let said = &CERTIFIED.found[record.name]["said"];
        let json = fs::read_to_string(CERTIFIED.folder.join(format!("{}.json", record.name))).unwrap();
        let result: Value = serde_json::from_str(&json).unwrap();
        let mut due = Vec::new();
        numbers(&result, &mut due);
        let mut marked: Vec<f64> = Vec::new();
        for table in said["tables"].as_array().unwrap() {
            for cell in table["rows"].as_array().unwrap().iter().flat_map(|row| row.as_array().unwrap()) {
                marked.extend(strings(&cell["values"]).iter().map(|value| value.parse::<f64>().unwrap()));
            }
        }
        assert!(marked.len() > 100, "{}: {} numbers", record.name, marked.len());
        let stand = &result["certification"]["stand"];
        let common =
            ["common_platform_arcsec", "common_base_arcsec"].map(|key| stand["certificate"][key].as_f64().unwrap());
        for at in stand["positions"].as_array().unwrap() {
            for key in ["alpha_arcsec", "beta_arcsec", "gamma_arcsec", "degrees_of_freedom"] {
                assert!(marked.contains(&at[key].as_f64().unwrap()), "{}: {key} {}", record.name, at[key]);
            }
            // Alpha and gamma take the part of a rotation that the angle beta leaves them.
            let share = libm::cos((at["beta_arcsec"].as_f64().unwrap() / 3600.0).to_radians());
            for (key, share) in [("u_alpha_arcsec", share), ("u_beta_arcsec", 1.0), ("u_gamma_arcsec", share)] {
                let own = at[key].as_f64().unwrap();
                let expanded = 2.0 * common.iter().fold(own * own, |sum, u| sum + (u / share).powi(2)).sqrt();
                let is_there = marked.iter().any(|value| (value / expanded - 1.0).abs() < 1e-12);
                assert!(is_there, "{}: U of {key} is {expanded}", record.name);
            }
        }
        for key in ["own_arcsec", "run_turns", "findings"] {
            let mut of_key = Vec::new();
            match key {
                "own_arcsec" => numbers(&result["certification"][key], &mut of_key),
                "run_turns" => result["certification"][key].as_array().unwrap().iter().for_each(|turn| {
                    numbers(&turn["platform_arcsec"], &mut of_key);
                }),
                _ => of_readings(&result).for_each(|found| numbers(&found["size"], &mut of_key)),
            }
            for number in of_key {
                assert!(
                    marked.iter().any(|value| (value / number - 1.0).abs() < 1e-12),
                    "{}: {key} {number}",
                    record.name
                );
            }
        }
        // The annex is the file, and its SHA-256 is in the certificate.
        let file = fs::read_to_string(CERTIFIED.folder.join(record.readings)).unwrap();
        assert_eq!(said["annex"].as_str().unwrap(), file);
        let sha256 = result["certification"]["stand"]["certificate"]["evidence"]["readings_sha256"].as_str().unwrap();
        assert!(strings(&said["codes"]).contains(&sha256));
        if record.asked.contains(&HOSTILE) {
            assert!(strings(&said["given"]).contains(&HOSTILE), "{}", said["given"]);
        }
    }
}

/// Expected: the certificate's own uncertainties, before the first heading, and the deviations below that.
#[test]
fn a_record_begins_with_its_result() {
    for record in RECORDS {
        let page = fs::read_to_string(CERTIFIED.folder.join(format!("{}.html", record.name))).unwrap();
        let (_, band) = page.split_once("<dl class=\"band\">").unwrap();
        let (band, sections) = band.split_once("</dl>").unwrap();
        let json = fs::read_to_string(CERTIFIED.folder.join(format!("{}.json", record.name))).unwrap();
        let result: Value = serde_json::from_str(&json).unwrap();
        let certificate = &result["certification"]["stand"]["certificate"];
        for key in ["repeatability_arcsec", "common_platform_arcsec", "common_base_arcsec"] {
            assert!(band.contains(&format!("value=\"{}\"", certificate[key])), "{}: {key} in {band}", record.name);
        }
        // Each with its degrees of freedom; the common parts share a cell.
        assert_eq!(band.matches("ν</i>\u{a0}=\u{a0}").count(), 2, "{}: {band}", record.name);
        let (_, of_parts) = band.rsplit_once("ν</i>\u{a0}=\u{a0}").unwrap();
        assert_eq!(of_parts.matches("<data value=").count(), 2, "{}: {band}", record.name);
        let until = format!("datetime=\"{}\"", certificate["valid_until"].as_str().unwrap());
        assert!(band.contains(&until), "{}: {until} in {band}", record.name);
        let (_, first) = sections.split_once("<section id=\"").unwrap();
        assert!(first.starts_with("result\""), "{}", record.name);
    }
}

#[test]
fn a_record_says_whether_the_stand_has_changed() {
    let headline = |name: &str| CERTIFIED.found[name]["said"]["headline"].as_str().unwrap();
    assert_eq!(headline("record-en"), "● Positions certified: 8; runs: 5");
    assert_eq!(
        headline("record-both"),
        "✕ Стенд изменился после выдачи сертификата C-2026-0143 The stand has changed since certificate C-2026-0143"
    );
    let said = &CERTIFIED.found["record-both"]["said"];
    assert_eq!(strings(&said["sections"]), ["1", "2", "3", "4", "5", "6"]);
    let given = said["given"].to_string();
    assert!(given.contains("the lamp failed") && given.contains("the door was opened"), "{given}");
    let words = said["words"].to_string().replace('\u{a0}', " ");
    for finding in ["Position (2, 3) has changed", "Положение (2, 3) изменилось"] {
        assert!(words.contains(finding), "{finding} in {words}");
    }
}

/// Expected: the warnings in the JSON of the same certification.
#[test]
fn a_record_begins_with_the_number_of_warnings() {
    for record in RECORDS {
        let json = fs::read_to_string(CERTIFIED.folder.join(format!("{}.json", record.name))).unwrap();
        let json: Value = serde_json::from_str(&json).unwrap();
        let warnings = json["certification"]["warnings"].as_array().unwrap().len();
        let verdicts = strings(&CERTIFIED.found[record.name]["said"]["verdicts"]).concat().replace('\u{a0}', " ");
        let words = if record.languages[0] == English {
            "Warnings of the program"
        } else {
            "Предупреждений программы"
        };
        let due = format!("{words}: {warnings};");
        assert!(verdicts.contains(&due), "{}: {due} in {verdicts}", record.name);
    }
}

/// Findings that concern the comparison, or say that chance is as likely.
const NOT_OF_READINGS: [&str; 7] =
    ["stand_changed", "chance", "computed", "unit", "rows_exchanged", "column_reversed", "columns_exchanged"];

/// Returns the findings on the readings themselves.
fn of_readings(result: &Value) -> impl Iterator<Item = &Value> {
    let findings = result["findings"].as_array().unwrap();
    findings.iter().filter(|found| !NOT_OF_READINGS.contains(&found["kind"].as_str().unwrap()))
}

/// Expected: by the probabilities and numbers of the JSON, with the limits of ISO 5725-2, 7.3.2.1: 5 % and 1 %.
#[test]
fn every_test_has_a_result_with_its_mark() {
    for record in RECORDS {
        let json = fs::read_to_string(CERTIFIED.folder.join(format!("{}.json", record.name))).unwrap();
        let result: Value = serde_json::from_str(&json).unwrap();
        let tables = CERTIFIED.found[record.name]["said"]["tables"].as_array().unwrap();
        let of_tests =
            |table: &&Value| ["Finding", "Вывод"].iter().any(|head| strings(&table["heads"])[0].starts_with(head));
        let rows = tables.iter().find(of_tests).map_or(&Vec::new(), |table| table["rows"].as_array().unwrap()).clone();
        assert_eq!(rows.len(), of_readings(&result).count(), "{}", record.name);
        for row in &rows {
            let said = row[1]["text"].as_str().unwrap();
            // A very small one is only said to be below a limit.
            let below = row[3]["text"].as_str().unwrap().starts_with('<').then_some(0.0);
            let p = strings(&row[3]["values"]).first().map(|p| p.parse::<f64>().unwrap()).or(below);
            let mark = if p.unwrap() < 0.01 { "✕ " } else { "◐ " };
            assert!(said.starts_with(mark) && said.chars().count() > 4, "{}: {said} of {row}", record.name);
        }
        // In two languages each heading has the unit.
        let heads = tables.iter().flat_map(|table| strings(&table["heads"]));
        for head in heads.filter(|head| head.contains("было") && head.contains("before")) {
            assert!(
                ["было,\u{a0}″", "before,\u{a0}″"].iter().all(|named| head.contains(named)),
                "{}: {head}",
                record.name
            );
        }
    }
}
