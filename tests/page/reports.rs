//! Reports of calibrations, as the program writes them, against the result that it gives to programs.

use crate::cases;
use crate::pages::{Page, browsed, strings};
use crate::programs;
use dtg_passport::passport::verify;
use dtg_passport::report::Language::{English, Russian};
use dtg_passport::report::{Language, Languages};
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

/// One report: its languages, and what `calibrate` is asked; files of the reports' own folder begin with `@`.
struct Report {
    name: &'static str,
    languages: &'static [Language],
    asked: &'static [&'static [&'static str]],
}

/// The usual passport, verified; its gyro's currents, its laboratory, its type.
const USUAL: &[&str] =
    &["passports/SPS-2/0017/moscow-bmstu-1.yaml", "--trust", "docs/allowed_signers", "--time", "2026-11-20T08:00:00Z"];
/// A passport for a site of known height, whose currents are those of its self-check but for ω_0x.
const SURVEYED: &[&str] = &[
    "@issued/SPS-2/0017/braunschweig-ptb-1.yaml",
    "--trust",
    "@allowed_signers",
    "--time",
    "2026-11-20T08:00:00Z",
    "--gyro-serial",
    "G-0042",
    "--date",
    "2026-11-19",
];
const CURRENTS: &[&str] = &["docs/currents.csv"];
const LABORATORY: &[&str] = &["--laboratory", "docs/laboratory.yaml"];
const GYRO: &[&str] = &["--gyro", "docs/gvk-6.yaml"];
const WHOLE: &[&str] = &["--budget", "--monte-carlo", "--trials", "65536"];
const PREVIOUS: &[&str] = &["--previous", "@earlier.json"];
const SEVERAL: &[&str] = &["--previous", "@earlier.json", "--previous", "@older.json"];

const REPORTS: &[Report] = &[
    Report { name: "brief-en", languages: &[English], asked: &[USUAL, CURRENTS, LABORATORY, GYRO] },
    Report {
        name: "brief-budget-en",
        languages: &[English],
        asked: &[USUAL, CURRENTS, LABORATORY, GYRO, &["--budget"]],
    },
    Report {
        name: "brief-both",
        languages: &[Russian, English],
        asked: &[USUAL, CURRENTS, LABORATORY, GYRO, PREVIOUS],
    },
    Report { name: "calibrated-en", languages: &[English], asked: &[USUAL, CURRENTS, LABORATORY, GYRO] },
    Report { name: "calibrated-ru", languages: &[Russian], asked: &[USUAL, CURRENTS, LABORATORY, GYRO] },
    Report { name: "whole-ru", languages: &[Russian], asked: &[USUAL, CURRENTS, LABORATORY, GYRO, WHOLE, PREVIOUS] },
    Report {
        name: "history-en",
        languages: &[English],
        asked: &[USUAL, CURRENTS, LABORATORY, GYRO, SEVERAL, &["--gyro-serial", "G-0042", "--date", "2026-11-18"]],
    },
    // Repeated readings; a laboratory that is too warm, with a poor seat.
    Report {
        name: "repeated-en",
        languages: &[English],
        asked: &[USUAL, &["@repeated.csv", "--laboratory", "@warm.yaml", "--budget"], GYRO],
    },
    Report {
        name: "changed-both",
        languages: &[English, Russian],
        asked: &[USUAL, CURRENTS, LABORATORY, GYRO, WHOLE, PREVIOUS],
    },
    Report { name: "bad-both", languages: &[Russian, English], asked: &[USUAL, &["@bad.csv"], LABORATORY, GYRO] },
    Report {
        name: "failed-en",
        languages: &[English],
        asked: &[USUAL, CURRENTS, LABORATORY, &["--gyro", "@other-type.yaml"]],
    },
    // The longest words of a decision beside the numbers with most digits: g is known here.
    Report {
        name: "failed-ru",
        languages: &[Russian],
        asked: &[SURVEYED, &["@failed.csv", "--gyro", "@surveyed-type.yaml"], LABORATORY],
    },
    // A meter so coarse that the parameters do not follow its errors linearly.
    Report {
        name: "coarse-both",
        languages: &[English, Russian],
        asked: &[USUAL, CURRENTS, &["--laboratory", "@coarse.yaml", "--monte-carlo", "--trials", "400000"], GYRO],
    },
    // Neither type nor laboratory, one method alone.
    Report { name: "plain-ru", languages: &[Russian], asked: &[USUAL, CURRENTS, &["--method", "iterative"]] },
    Report {
        name: "unverified-many-en",
        languages: &[English],
        asked: &[&["@many.yaml", "@many.csv", "--no-verify", "--budget"], LABORATORY],
    },
];

/// A type that the example's gyro is not of, with a name that would be markup anywhere else.
const HOSTILE_TYPE: &str = "GVK-7 </h1></style><script>alert('x')</script> & co";

/// Reports and what was found on them.
pub struct Reported {
    folder: PathBuf,
    languages: Vec<Languages>,
    own_words: String,
    found: Value,
}

/// The reports are written and opened once for all tests.
pub static REPORTED: LazyLock<Reported> = LazyLock::new(|| {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("report");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    files(&folder);
    REPORTS.iter().for_each(|report| report.write(&folder));
    let found = browsed(&folder, REPORTS.iter().map(|report| report.name));
    let languages = |report: &Report| Languages::new(report.languages[0], report.languages[1..].iter().copied());
    let sums: Vec<String> = REPORTS.iter().map(|report| report.sum_of_currents(&folder)).collect();
    let own_words =
        format!("SPS-2/0017/moscow-bmstu/1 GVK-6 examples@dtg-passport.test meter.reading_percent {}", sums.join(" "));
    Reported { languages: REPORTS.iter().map(languages).collect(), own_words, folder, found }
});

impl Reported {
    /// Each report as a page.
    pub fn pages(&self) -> impl Iterator<Item = Page<'_>> {
        REPORTS.iter().zip(&self.languages).map(|(report, languages)| Page {
            name: report.name,
            folder: &self.folder,
            languages,
            own_words: &self.own_words,
            found: &self.found[report.name],
        })
    }

    fn said(&self, name: &str) -> &Value {
        &self.found[name]["said"]
    }
}

impl Report {
    /// The first digits of the SHA-256 of its currents.
    fn sum_of_currents(&self, folder: &Path) -> String {
        let asked = words(folder, &self.asked.concat());
        let currents = asked.iter().find(|file| file.extension().is_some_and(|kind| kind == "csv")).unwrap();
        let bytes = fs::read(programs::project("").join(currents)).unwrap();
        format!("{:x}", Sha256::digest(bytes))[..8].to_owned()
    }

    /// All that a report can have, but for the usual ones.
    fn details(&self) -> Option<&'static str> {
        (!self.name.starts_with("brief") && self.name != "coarse-both").then_some("--details")
    }

    /// Has the program write the page, and the result for programs.
    fn write(&self, folder: &Path) {
        let tags: Vec<&str> = self.languages.iter().map(|language| language.tag()).collect();
        let page = folder.join(format!("{}.html", self.name));
        let mut calibrate = calibrate(folder, &self.asked.concat());
        calibrate.args(self.details()).args(["--lang", &tags.join(","), "--format", "json", "--report"]).arg(&page);
        let output = calibrate.output().unwrap();
        assert!(page.exists(), "{}: {}", self.name, String::from_utf8_lossy(&output.stderr));
        fs::write(folder.join(format!("{}.json", self.name)), output.stdout).unwrap();
    }
}

/// The words of the command line.
fn words(folder: &Path, asked: &[&str]) -> Vec<PathBuf> {
    let word = |word: &&str| word.strip_prefix('@').map_or_else(|| PathBuf::from(word), |name| folder.join(name));
    asked.iter().map(word).collect()
}

fn calibrate(folder: &Path, asked: &[&str]) -> Command {
    let mut calibrate = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
    calibrate.current_dir(programs::project("")).arg("calibrate").args(words(folder, asked));
    calibrate
}

/// What reports are made of, besides the examples.
fn files(folder: &Path) {
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
    let example = |name: &str| fs::read_to_string(programs::project(name)).unwrap();
    let currents = example("docs/currents.csv");
    let (head, rows) = currents.split_at(currents.find("1,1,").unwrap());
    let changed = |by: &dyn Fn(&str, f64, f64) -> (f64, f64)| -> String {
        let row = |row: &str| {
            let cells: Vec<&str> = row.split(',').collect();
            let (jx, jy) = by(&cells[..2].join(","), cells[2].parse().unwrap(), cells[3].parse().unwrap());
            format!("{},{},{jx:.7},{jy:.7}\n", cells[0], cells[1])
        };
        rows.lines().map(row).collect()
    };
    // J_x of (1, 3) off by a thousandth of a milliampere.
    let bad = changed(&|at, jx, jy| (if at == "1,3" { jx + 1e-3 } else { jx }, jy));
    write("bad.csv", &format!("{head}{bad}"));
    let again = changed(&|_, jx, jy| (jx + 5e-6, jy - 9e-6));
    write("repeated.csv", &format!("{head}{rows}{again}"));
    // Currents that were a little larger are scale factors that were a little smaller.
    let larger = changed(&|_, jx, jy| (1.0001 * jx, 1.0002 * jy));
    write("earlier.csv", &format!("{head}{larger}"));
    write("older.csv", &format!("{head}{}", changed(&|_, jx, jy| (0.9998 * jx, 1.0001 * jy))));
    for (currents, result) in [("@earlier.csv", "earlier.json"), ("@older.csv", "older.json")] {
        let earlier = [USUAL, &[currents, "--format", "json"], LABORATORY].concat();
        write(result, &programs::output(calibrate(folder, &earlier)));
    }
    let seat = example("docs/laboratory.yaml").replace("about_z: 10.0", "about_z: 100.0");
    let coarse = example("docs/laboratory.yaml").replace("reading_percent: 0.0087", "reading_percent: 3.0");
    write("coarse.yaml", &coarse);
    write("warm.yaml", &(seat + "temperature_c: 35.5\n"));
    let other = example("docs/gvk-6.yaml").replace("GVK-6", HOSTILE_TYPE).replace("[[95, 9.5]", "[[95.2, 9.5]");
    write("other-type.yaml", &other);

    let program = |words: &[&str]| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
        program.current_dir(folder).args(words);
        programs::output(program)
    };
    let [stand, site] = ["passports/SPS-2/0017/stand.yaml", "sites/braunschweig-ptb.yaml"].map(programs::project);
    program(&["keygen", "key", "--identity", "f", "--allowed-signers", "allowed_signers", "--no-passphrase"]);
    let [stand, site] = [&stand, &site].map(|path| path.to_str().unwrap());
    let when = ["--issued-at", "2026-11-10", "--out", "issued"];
    program(&[&["issue", stand, "--site", site, "--key", "key", "--identity", "f"], &when[..]].concat());
    let passport = "issued/SPS-2/0017/braunschweig-ptb-1.yaml";
    let shown = program(&["show", passport, "--trust", "allowed_signers", "--time", "2026-11-20", "--format", "json"]);
    let shown: Value = serde_json::from_str(&shown).unwrap();
    let check = &shown["self_check"];
    let keys = ["k_deg_per_h_per_ma", "omega0_deg_per_h", "omega_g_deg_per_h_per_g", "omega_k_deg_per_h_per_g"];
    let nominal = keys.map(|key| format!("{key}: {}", check[key])).join(", ");
    let surveyed = example("docs/gvk-6.yaml");
    let line = surveyed.lines().find(|line| line.starts_with("nominal")).unwrap();
    write("surveyed-type.yaml", &surveyed.replace(line, &format!("nominal: {{{nominal}}}")));
    let currents = check["currents"].as_array().unwrap();
    let row = |at: &Value| {
        let [jx, jy] = ["jx_ma", "jy_ma"].map(|key| at[key].as_f64().unwrap());
        format!("{},{},{},{}\n", at["i"], at["j"], jx - 5e-4, jy - 2e-5)
    };
    write("failed.csv", &format!("i,j,jx_ma,jy_ma\n{}", currents.iter().map(row).collect::<String>()));

    // Twenty-four positions, with the currents of the gyro of the self-check.
    let many = cases::all().into_iter().find(|case| case.name == "many-en").unwrap();
    let answer = verify("many", many.passport.as_bytes(), &many.trust, &many.question);
    let passport = answer.passport().unwrap();
    let currents = &passport.content().self_check.as_ref().unwrap().currents;
    let rows: String = currents.iter().map(|at| format!("{},{},{},{}\n", at.i, at.j, at.jx_ma, at.jy_ma)).collect();
    write("many.yaml", &many.passport);
    write("many.csv", &format!("i,j,jx_ma,jy_ma\n{rows}"));
}

/// The worst is said first and large.
#[test]
fn the_headline_is_the_verdict() {
    let due = [
        ("calibrated-en", "◐ Conformity with gyro type GVK-6 is undecided", false),
        ("calibrated-ru", "◐ Соответствие типу GVK-6 не определено", false),
        (
            "bad-both",
            "✕ Показания не согласуются с\u{a0}этим стендом The readings are not consistent with this stand",
            true,
        ),
        ("plain-ru", "○ Параметры определены, соответствие не оценивалось", false),
        ("unverified-many-en", "○ Passport NOT VERIFIED", true),
    ];
    let failed = format!("✕ NOT within the tolerances of gyro type {HOSTILE_TYPE}");
    for (name, words, refused) in due.into_iter().chain([("failed-en", failed.as_str(), true)]) {
        let said = REPORTED.said(name);
        assert_eq!(said["headline"].as_str().unwrap(), words, "{name}");
        assert_eq!(said["refused"].as_bool().unwrap(), refused, "{name}");
    }
}

/// Expected: the remark in the JSON of the same result; the SHA-256 of the currents in the JSON of each earlier result. No
/// list of withdrawn passports was given, and every letter of a legend stands in a strip.
#[test]
fn a_front_says_what_its_result_depends_on() {
    let page = |name: &str| fs::read_to_string(REPORTED.folder.join(format!("{name}.html"))).unwrap();
    let json = |name: &str| fs::read_to_string(REPORTED.folder.join(format!("{name}.json"))).unwrap();
    let unit = "meter.reading_percent of the laboratory is 3 %, more than 1";
    assert!(json("coarse-both").contains(unit));
    let said = |name: &str, words: &str| {
        strings(&REPORTED.said(name)["blocks"]).iter().any(|block| block.replace('\u{a0}', " ").contains(words))
    };
    assert!(said("coarse-both", unit));
    assert!(said("coarse-both", "Значение meter.reading_percent лаборатории"));
    // Of the stand's certificate: who issued it, and to what it is traceable.
    let passport = fs::read_to_string(programs::project("passports/SPS-2/0017/moscow-bmstu-1.yaml")).unwrap();
    for key in ["laboratory", "traceability"] {
        let (_, rest) = passport.split_once(&format!("\n  {key}: \"")).unwrap();
        let (value, _) = rest.split_once('"').unwrap();
        assert!(said("calibrated-en", value) && said("bad-both", value), "{key}: {value}");
    }
    assert!(page("repeated-en").contains(", and the temperature."));
    assert!(page("calibrated-en").contains("; withdrawal not checked"));
    for earlier in ["earlier", "older"] {
        let earlier: Value = serde_json::from_str(&json(earlier)).unwrap();
        let sha256 = earlier["subject"]["currents_sha256"].as_str().unwrap();
        let named = |number: u32| {
            page("history-en").contains(&format!("{number}, <span class=\"n\">SHA-256</span> {}…", &sha256[..8]))
        };
        assert!(named(1) || named(2), "{sha256}");
    }
    for name in ["whole-ru", "repeated-en", "changed-both", "unverified-many-en"] {
        let page = page(name);
        for part in (1..=5).map(|number| format!("share part-{number}\"")) {
            // Once in the legend, and then at least once in a strip.
            assert_ne!(page.matches(&part).count(), 1, "{name}: {part}");
        }
    }
}

/// Expected: the gyro's type and serial number as they were asked for, the day, and the SHA-256 by another implementation.
#[test]
fn a_report_is_named_after_the_gyro_and_its_currents() {
    let due = [
        ("calibrated-en", "GVK-6, currents", ["not stated"]),
        ("calibrated-ru", "GVK-6, токи", ["не указано"]),
        ("plain-ru", "Тип и\u{a0}номер не указаны, токи", ["не указано"]),
        ("history-en", "GVK-6 №\u{a0}G-0042, 2026-11-18, currents", ["G-0042"]),
    ];
    for (name, gyro, serials) in due {
        let report = REPORTS.iter().find(|report| report.name == name).unwrap();
        let named = format!("{gyro} {}", report.sum_of_currents(&REPORTED.folder));
        let said = REPORTED.said(name);
        assert!(said["title"].as_str().unwrap().ends_with(&format!(" {named}")), "{name}: {}", said["title"]);
        assert!(strings(&said["margins"]).iter().any(|margin| margin.ends_with(&named)), "{name}: {}", said["margins"]);
        assert!(strings(&said["blocks"]).iter().any(|block| block.ends_with(&named)), "{name}: the end");
        assert_eq!(strings(&said["serials"]), serials, "{name}");
    }
}

/// Expected: the name in docs/laboratory.yaml, the date as it was asked for; the 64 digits have their place beside the checks.
#[test]
fn a_report_begins_with_laboratory_and_date() {
    for (name, laboratory, day, serial) in [
        ("history-en", "Gyro laboratory", "datetime=\"2026-11-18\"", None),
        ("calibrated-en", "Gyro laboratory", "not stated", Some("Serial number of the gyro")),
        ("plain-ru", "не указано", "не указано", Some("Заводской номер гироскопа")),
    ] {
        let page = fs::read_to_string(REPORTED.folder.join(format!("{name}.html"))).unwrap();
        let (_, band) = page.split_once("<dl class=\"band\">").unwrap();
        let (band, rest) = band.split_once("</dl>").unwrap();
        assert!(band.contains(laboratory) && band.contains(day), "{name}: {band}");
        // The title has the serial number; the band says that there is none.
        for words in ["Serial number", "Заводской номер"] {
            assert_eq!(band.contains(words), serial.is_some_and(|serial| serial.starts_with(words)), "{name}: {band}");
        }
        let report = REPORTS.iter().find(|report| report.name == name).unwrap();
        let sum = format!("<code>{}", report.sum_of_currents(&REPORTED.folder));
        assert!(!band.contains(&sum) && rest.contains(&sum), "{name}: {band}");
    }
}

/// Sections that were not asked for leave no gap.
#[test]
fn sections_are_counted() {
    for page in REPORTED.pages() {
        let numbers: Vec<usize> =
            strings(&page.found["said"]["sections"]).into_iter().map(|number| number.parse().unwrap()).collect();
        assert!(numbers.len() >= 4, "{}: {numbers:?}", page.name);
        assert!(numbers.iter().copied().eq(1..=numbers.len()), "{}: {numbers:?}", page.name);
    }
}

/// In the page's own language, with the numbers of the sentence that programs get.
#[test]
fn what_the_budget_comes_to_is_said_in_every_language() {
    let due = [
        (
            "whole-ru",
            "ru",
            "Наибольшая неопределённость относительно допуска без учёта местного g: ",
            "Без этого источника u составила бы ",
        ),
        (
            "changed-both",
            "ru",
            "Наибольшая неопределённость относительно допуска без учёта местного g: ",
            "Без этого источника u составила бы ",
        ),
        (
            "changed-both",
            "en",
            "Largest uncertainty relative to tolerance, excluding local g: ",
            "Without this source, u would be ",
        ),
        (
            "repeated-en",
            "en",
            "Largest uncertainty relative to tolerance, excluding local g: ",
            "To halve u, reduce the uncertainty of this source to ",
        ),
        ("unverified-many-en", "en", "Largest uncertainty relative to the value: ", "Without this source, u would be "),
    ];
    for (name, lang, beginning, effect) in due {
        let result: Value =
            serde_json::from_slice(&fs::read(REPORTED.folder.join(format!("{name}.json"))).unwrap()).unwrap();
        let words = REPORTED.said(name)["words"].as_array().unwrap();
        let said: String = words
            .iter()
            .filter(|word| word["section"] == "budget" && word["lang"] == lang)
            .map(|word| word["text"].as_str().unwrap())
            .collect();
        assert!(said.contains(beginning) && said.contains(effect), "{name}: {said}");
        let said = said.replace(',', if lang == "ru" { "." } else { "," });
        let sentence = result["budget"]["sentence"].as_str().unwrap();
        let numbers = sentence.split([' ', '″', '(']).filter(|word| word.parse::<f64>().is_ok());
        let numbers: Vec<&str> = numbers.collect();
        assert_eq!(numbers.len(), 3, "{sentence}");
        for number in numbers {
            assert!(said.contains(number), "{name}: {number} of {sentence:?} in {said}");
        }
    }
}

/// Expected: `first_order_valid` of each parameter in the result for programs.
#[test]
fn the_verdict_says_where_the_linear_approximation_is_not_valid() {
    for (name, words) in [
        ("coarse-both", ["linear approximation behind U is not valid for ", "вычислена U, неприменимо для "]),
        ("whole-ru", ["not valid", "неприменимо"]),
    ] {
        let json = fs::read_to_string(REPORTED.folder.join(format!("{name}.json"))).unwrap();
        let result: Value = serde_json::from_str(&json).unwrap();
        let lines = result["monte_carlo"]["parameters"].as_array().unwrap();
        let refuted = lines.iter().filter(|line| line["first_order_valid"] == false);
        let mut due: Vec<String> =
            refuted.map(|line| line["parameter"].as_str().unwrap().replace("k_", "K").replace("omega_", "ω")).collect();
        assert_eq!(due.is_empty(), name == "whole-ru", "{name}: {due:?}");
        due.sort();
        let verdicts = strings(&REPORTED.said(name)["verdicts"]).concat().replace('\u{a0}', " ");
        for words in words {
            let found = verdicts.split_once(words).map(|(_, rest)| {
                let (names, _) = rest.split_once(" (JCGM 101, 8)").unwrap();
                let mut names: Vec<&str> = names.split(", ").collect();
                names.sort_unstable();
                names
            });
            assert_eq!(found.unwrap_or_default(), due, "{name}: {verdicts}");
        }
    }
}

/// Every number of the page, those in its sentences too, is the result's own, or one of a file that went into it, rounded once;
/// what has an uncertainty has its digits; what stands in a table stands in the right row and column.
#[test]
fn every_number_is_that_of_the_result() {
    let pages = REPORTED.folder.join("found.json");
    for report in REPORTS {
        let mut python = programs::python();
        python.arg(programs::project("tests/page/result.py")).arg(&pages).arg(report.name);
        python.arg(REPORTED.folder.join(format!("{}.json", report.name)));
        python.current_dir(programs::project("")).args(words(&REPORTED.folder, &report.asked.concat()));
        python.args(report.details());
        assert_eq!(programs::output(python).trim(), "", "{}", report.name);
    }
}
