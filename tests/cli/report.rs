//! The report of a calibration against the result that programs get, and what it must say large.

use crate::programs;
use serde_json::Value;
use std::path::PathBuf;
use std::process::{Command, Output};

const PASSPORT: &str = "passports/SPS-2/0017/moscow-bmstu-1.yaml";
const VERIFIED: &[&str] = &["--trust", "docs/allowed_signers", "--time", "2026-11-20T08:00:00Z"];
const LABORATORY: &[&str] = &["--laboratory", "docs/laboratory.yaml"];
const GYRO: &[&str] = &["--gyro", "docs/gvk-6.yaml"];

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) -> String {
        std::fs::write(self.path(name), text).unwrap();
        self.path(name).display().to_string()
    }

    fn calibrate(&self, currents: &str, report: &str, options: &[&[&str]]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
        command.current_dir(programs::project("")).args(["calibrate", PASSPORT, currents, "--format", "json"]);
        command.args(options.concat()).arg("--report").arg(self.path(report)).output().unwrap()
    }

    /// The page, and the result as JSON.
    fn page(&self, currents: &str, options: &[&[&str]]) -> (String, Value) {
        let output = self.calibrate(currents, "report.html", &[options, &[&["--force"]]].concat());
        let words = String::from_utf8_lossy(&output.stderr);
        let page = std::fs::read_to_string(self.path("report.html")).unwrap_or_else(|_| panic!("no report: {words}"));
        (page, serde_json::from_slice(&output.stdout).unwrap_or(Value::Null))
    }
}

const CURRENTS: &str = "docs/currents.csv";

/// Every number of a document.
fn numbers(value: &Value, found: &mut Vec<f64>) {
    match value {
        Value::Number(number) => found.push(number.as_f64().unwrap()),
        Value::Array(items) => items.iter().for_each(|item| numbers(item, found)),
        Value::Object(entries) => entries.values().for_each(|item| numbers(item, found)),
        _ => {}
    }
}

/// The numbers that a page marks: value, digits, and whether they stand in a sentence of the language `second`; those of
/// pictures too.
fn marked(page: &str, second: &str) -> Vec<(f64, String, bool)> {
    let between = |start: &'static str, end: &'static str| {
        page.match_indices(start).map(move |(at, _)| {
            let (value, rest) = page[at + start.len()..].split_once("\">").unwrap();
            (value.parse().unwrap(), rest.split_once(end).unwrap().0.to_owned(), is_within(&page[..at], second))
        })
    };
    between("<data value=\"", "</data>").chain(between("data-value=\"", "</tspan>")).collect()
}

/// Whether what follows `before` stands in an element whose last attribute is the language `second`.
fn is_within(before: &str, second: &str) -> bool {
    let Some(opened) = before.rfind(&format!(" lang=\"{second}\">")) else { return false };
    let name = before[before[..opened].rfind('<').unwrap() + 1..opened].split(' ').next().unwrap();
    !before[opened..].contains(&format!("</{name}>"))
}

/// A printed number and half the unit of its last place, read by its digits.
fn read(printed: &str, comma: bool) -> (f64, f64) {
    assert!(!printed.contains(if comma { '\u{d7}' } else { '\u{b7}' }), "{printed}: the sign of the other language");
    let plain: String = printed.chars().filter(|c| !"\u{202f}\u{b7}\u{d7}".contains(*c)).collect();
    let plain = plain.replace('\u{2212}', "-");
    assert!(!plain.contains(if comma { '.' } else { ',' }), "{printed}: the mark of the other language");
    let superscript =
        |c: char| "⁻⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|s| s == c).map(|at| "-0123456789".chars().nth(at).unwrap());
    let (digits, power) = match plain.find(|c| superscript(c).is_some()) {
        Some(at) => (plain[..at].strip_suffix("10").unwrap(), plain[at..].chars().filter_map(superscript).collect()),
        None => (plain.as_str(), "0".to_owned()),
    };
    let power: i32 = power.parse().unwrap();
    let decimals = digits.split([',', '.']).nth(1).map_or(0, str::len) as i32;
    let number: f64 = format!("{}e{power}", digits.replace(',', ".")).parse().unwrap();
    (number, 0.5 * 10_f64.powi(power - decimals))
}

#[test]
fn every_number_is_the_results_own_rounded_once() {
    let folder = Folder::new();
    let more: &[&str] = &["--budget", "--monte-carlo", "--trials", "16384"];
    for (lang, comma, second) in [("en", false, "-"), ("ru", true, "-"), ("ru,en", true, "en")] {
        let (page, result) = folder.page(CURRENTS, &[VERIFIED, LABORATORY, GYRO, more, &["--lang", lang]]);
        let mut known = Vec::new();
        numbers(&result, &mut known);
        // The expanded uncertainty of a parameter is U = k u.
        for row in result["verdict"]["parameters"].as_array().unwrap() {
            let factor = row["coverage_factor"].as_f64().unwrap();
            known.push(factor * row["standard_uncertainty"].as_f64().unwrap());
            // The budget has the part of the local g in u.
            known.extend(row["expanded_uncertainty_from_gravity"].as_f64().map(|part| part / factor));
        }
        // What the laboratory's file states of its meter.
        known.extend([0.0087, 0.0, 1.0, 1e-6]);
        // Limits that sentences name: of the probability of chi-square, and of the differences between methods.
        known.extend([0.005, 3.0]);
        let marked = marked(&page, second);
        assert!(marked.len() > 200, "{}", marked.len());
        assert_eq!(marked.iter().any(|(.., in_second)| *in_second), second == "en");
        for (value, printed, in_second) in marked {
            assert!(known.iter().any(|known| known.abs() == value.abs()), "{value} is not in the result");
            let (number, half) = read(&printed, comma != in_second);
            assert!((number - value).abs() <= half * (1.0 + 1e-9), "{printed} is not {value} rounded");
        }
    }
}

/// The paper's conventions (JCGM 100, 7.2.6) by hand: u of K_x is 0.011, so K_x has three decimals.
#[test]
fn values_have_the_digits_of_their_uncertainty() {
    let folder = Folder::new();
    let (page, result) = folder.page(CURRENTS, &[VERIFIED, LABORATORY, GYRO]);
    let squares = &result["results"][0];
    let (k, u) = (&squares["k_deg_per_h_per_ma"][0][0], &squares["standard_uncertainty"]["k_deg_per_h_per_ma"][0][0]);
    assert!((0.0105..0.0115).contains(&u.as_f64().unwrap()));
    let due = format!("<data value=\"{k}\">{:.3}</data>", k.as_f64().unwrap());
    assert!(page.contains(&due), "{due}");
}

/// Returns the words of the paragraph on the previous calibration.
fn previous_calibration(page: &str) -> String {
    let markup = page.split_once("Previous calibration: ").unwrap().1.split_once("</p>").unwrap().0;
    markup.split('<').map(|part| part.split_once('>').map_or(part, |(_, words)| words)).collect()
}

#[test]
fn the_annex_is_the_result() {
    let folder = Folder::new();
    let (page, result) = folder.page(CURRENTS, &[VERIFIED, LABORATORY, GYRO]);
    let annex = page.split_once("<pre").unwrap().1.split_once('>').unwrap().1.split_once("</pre>").unwrap().0;
    // Each line is an element of its own, so that it has a number.
    let annex = ["", " class=\"c\"", " class=\"c w\"", " class=\"n\""]
        .iter()
        .fold(annex.replace("</span>", ""), |annex, class| annex.replace(&format!("<span{class}>"), ""));
    let annex = annex.replace("&quot;", "\"").replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
    assert_eq!(serde_json::from_str::<Value>(&annex).unwrap(), result);
    // A later calibration can be compared with it.
    let earlier = folder.write("earlier.json", &annex);
    let (page, result) = folder.page(CURRENTS, &[VERIFIED, LABORATORY, GYRO, &["--previous", &earlier]]);
    assert!(result["change"].is_object());
    assert!(page.contains("Change since the previous calibration"));
    let of_earlier = previous_calibration(&page);
    let sha256 = &result["subject"]["currents_sha256"].as_str().unwrap()[..8];
    for words in ["date not stated", "SPS-2/0017/moscow-bmstu/1", sha256, "Not confirmed by serial number"] {
        assert!(of_earlier.contains(words), "{words}: {of_earlier}");
    }
}

/// Three earlier results, given in any order: the page has the parameters of each below one another, by date, and the result
/// is compared with the latest.
#[test]
fn earlier_results_stand_in_the_order_of_their_dates() {
    let folder = Folder::new();
    let currents = std::fs::read_to_string(programs::project(CURRENTS)).unwrap();
    let (head, rows) = currents.split_at(currents.find("1,1,").unwrap());
    let mut k_x = std::collections::BTreeMap::new();
    for (date, factor) in [("2026-05-12", 1.0002), ("2024-11-03", 1.0001), ("2025-06-30", 0.9999)] {
        let larger: String = rows
            .lines()
            .map(|row| {
                let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
                format!("{},{},{:.7},{:.7}\n", cells[0], cells[1], factor * cells[2], factor * cells[3])
            })
            .collect();
        let larger = folder.write("larger.csv", &format!("{head}{larger}"));
        let (_, result) = folder.page(&larger, &[VERIFIED, LABORATORY, &["--date", date, "--gyro-serial", "4711"]]);
        k_x.insert(date, result["results"][0]["k_deg_per_h_per_ma"][0][0].to_string());
        folder.write(&format!("{date}.json"), &result.to_string());
    }
    let previous: Vec<String> = ["2026-05-12", "2024-11-03", "2025-06-30"]
        .iter()
        .flat_map(|date| ["--previous".to_owned(), folder.path(&format!("{date}.json")).display().to_string()])
        .collect();
    let previous: Vec<&str> = previous.iter().map(String::as_str).collect();
    let asked = [VERIFIED, LABORATORY, GYRO, &previous, &["--date", "2026-11-20", "--gyro-serial", "4711"]];
    let (page, result) = folder.page(CURRENTS, &asked);
    let of_earlier = previous_calibration(&page);
    assert!(of_earlier.contains("2026-05-12") && !of_earlier.contains("Serial numbers"), "{of_earlier}");
    let now = result["results"][0]["k_deg_per_h_per_ma"][0][0].to_string();
    assert_eq!(result["change"]["parameters"][0]["reference_value"].to_string(), k_x["2026-05-12"]);
    let table = page.split_once("Calibrations compared").unwrap().1.split_once("</table>").unwrap().0;
    let places: Vec<usize> = k_x.values().chain([&now]).map(|value| table.find(value.as_str()).unwrap()).collect();
    assert!(places.is_sorted(), "{places:?}");
    for date in k_x.keys().chain([&"2026-11-20"]) {
        assert_eq!(table.matches(&format!(">{date}<")).count(), 8, "{date}");
    }
    assert_eq!(table.matches("class=\"picture strip\"").count(), 8 * 4 + 1);
    // Without a type there are no strips.
    let (page, _) = folder.page(CURRENTS, &[VERIFIED, LABORATORY, &previous]);
    let table = page.split_once("Calibrations compared").unwrap().1.split_once("</table>").unwrap().0;
    assert!(!table.contains("strip") && table.contains("2024-11-03"));
}

#[test]
fn it_says_with_what_the_gyro_was_calibrated() {
    let folder = Folder::new();
    let (page, _) = folder.page(CURRENTS, &[VERIFIED, LABORATORY, GYRO]);
    for file in [PASSPORT, CURRENTS] {
        // By another program.
        let mut sum = Command::new("sha256sum");
        let sum = programs::output({
            sum.arg(programs::project(file));
            sum
        });
        let sum = sum.split(' ').next().unwrap().to_owned();
        assert!(page.contains(&sum), "{file}: {sum}");
    }
    let key = programs::project("tests/keys/examples.pub");
    let mut keygen = Command::new("ssh-keygen");
    keygen.args(["-l", "-f"]).arg(key);
    let fingerprint = programs::output(keygen).split(' ').nth(1).unwrap().to_owned();
    for words in [&fingerprint, "examples@", "SPS-2/0017/moscow-bmstu/1", "GVK-6", "2026-11-20"] {
        assert!(page.contains(words), "{words}");
    }
    assert!(!page.contains("NOT VERIFIED"));
}

/// Nobody is said to have signed what nobody verified.
#[test]
fn an_unverified_passport_is_said_to_be_one() {
    let folder = Folder::new();
    let (page, _) = folder.page(CURRENTS, &[&["--no-verify", "--lang", "en,ru"], LABORATORY]);
    let first = page.find("<p class=\"headline\">").unwrap();
    assert!(page[..first].ends_with("<div class=\"verdict refused\">"));
    let headline = page[first..].split_once("</p>").unwrap().0;
    assert!(headline.contains("Passport NOT VERIFIED") && headline.contains("Паспорт НЕ ПРОВЕРЕН"), "{headline}");
    assert!(page.contains("@top-right { content: \"Passport NOT VERIFIED / Паспорт НЕ ПРОВЕРЕН\""), "on every sheet");
    assert!(!page.contains("SHA256:") && !page.contains("examples@"));
}

#[test]
fn readings_that_do_not_fit_are_said_not_to() {
    let folder = Folder::new();
    let good = std::fs::read_to_string(programs::project(CURRENTS)).unwrap();
    // J_x of (1, 3) off by 1e-3 mA, or 0.1 deg/h.
    let row = good.lines().find(|line| line.starts_with("1,3,")).unwrap();
    let jx: f64 = row.split(',').nth(2).unwrap().parse().unwrap();
    let bad = good.replace(row, &row.replace(row.split(',').nth(2).unwrap(), &format!("{:.7}", jx + 1e-3)));
    let bad = folder.write("bad.csv", &bad);
    let (page, _) = folder.page(&bad, &[VERIFIED, LABORATORY, &["--lang", "ru,en"]]);
    assert!(page.contains("The readings are not consistent with this stand"));
    assert!(page.contains("Position (1, 3) did not repeat"), "and which position it may be");
    assert!(page.contains("Положение (1, 3) не воспроизведено"));
}

/// Three rounds of the eight positions, J_x increasing by 3e-5 mA with each visit: paper and JSON name the drift.
#[test]
fn a_drift_in_the_order_of_the_rows_is_named() {
    let folder = Folder::new();
    let good = std::fs::read_to_string(programs::project(CURRENTS)).unwrap();
    let rows: Vec<Vec<&str>> =
        good.lines().filter(|line| line.starts_with(['1', '2'])).map(|line| line.split(',').collect()).collect();
    let table = |drift_ma: f64| {
        let visits = rows.iter().cycle().take(3 * rows.len()).enumerate().map(|(visit, row)| {
            // Visits that are equal to the last digit would be copies.
            let [jx, jy]: [f64; 2] = [2, 3].map(|column| row[column].parse().unwrap());
            let noise = [7, 11].map(|factor| 2e-7 * (visit * factor % 13) as f64);
            let jx = jx + drift_ma * visit as f64 + noise[0];
            format!("{},{},{jx:.7},{:.7}\n", row[0], row[1], jy + noise[1])
        });
        format!("i,j,jx_ma,jy_ma\n{}", visits.collect::<String>())
    };
    for (drift_ma, is_named) in [(3e-5, true), (0.0, false)] {
        let currents = folder.write("rounds.csv", &table(drift_ma));
        let (page, result) = folder.page(&currents, &[VERIFIED, LABORATORY, GYRO, &["--lang", "en,ru"]]);
        let remarks = result["remarks"].to_string();
        for (text, words) in [(&page, "To fit it, state the time"), (&page, "увеличивает"), (&remarks, "per visit")]
        {
            let text = text.replace('\u{a0}', " ");
            assert_eq!(text.contains(words), is_named, "{drift_ma}: {words}");
        }
    }
}

/// Expected: U of ω_g is at least 2·10 °/(h·g)·0.0071/9.8157 = 0.0145 °/(h·g) without a height, over its tolerance of 0.01.
#[test]
fn parameters_that_no_gyro_can_pass_are_named_with_the_reason() {
    let folder = Folder::new();
    let (page, _) = folder.page(CURRENTS, &[VERIFIED, LABORATORY, GYRO, &["--lang", "en,ru"]]);
    let mut terminal = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
    terminal.current_dir(programs::project("")).args(["calibrate", PASSPORT, CURRENTS]);
    let text = terminal.args([VERIFIED, LABORATORY, GYRO].concat()).output().unwrap().stdout;
    let text = String::from_utf8(text).unwrap();
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        text.contains("No value of ω_g, ω_k can pass by guarded acceptance: the guard band exceeds the tolerance."),
        "{text}"
    );
    assert!(
        text.contains(
            "The height is not stated, so g is that at 0 m; its standard uncertainty, 0.0071 m/s², is the r.m.s. error"
        ),
        "{text}"
    );
    let page = page.replace('\u{a0}', " ");
    for words in ["can pass by guarded acceptance", "приёмка с защитной полосой невозможна", "The height is not stated"]
    {
        assert!(page.contains(words), "{words}");
    }
}

#[test]
fn what_nobody_stated_is_named() {
    let folder = Folder::new();
    let (page, result) = folder.page(CURRENTS, &[VERIFIED]);
    assert_eq!(result["not_stated"].as_array().unwrap().len(), 8);
    let gyro = ["gyro noise from visit to visit", "gyro noise from turn-on to turn-on"];
    let meter = ["gain of the meter", "offset of the meter"];
    for words in
        ["latitude", "azimuth of the base", "level of the base", "gyro seat"].into_iter().chain(meter).chain(gyro)
    {
        assert!(page.contains(&format!("{words}</")), "{words}");
    }
    assert!(page.contains("No gyro type was specified"), "and no verdict is made up");
}

#[test]
fn an_existing_report_is_not_replaced() {
    let folder = Folder::new();
    folder.write("report.html", "mine");
    let output = folder.calibrate(CURRENTS, "report.html", &[VERIFIED]);
    assert_eq!(output.status.code(), Some(1));
    let refusal: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(refusal["error"]["code"], "exists");
    assert!(String::from_utf8_lossy(&output.stderr).contains("--force"));
    assert_eq!(std::fs::read_to_string(folder.path("report.html")).unwrap(), "mine");
    folder.page(CURRENTS, &[VERIFIED]);
    assert_ne!(std::fs::read_to_string(folder.path("report.html")).unwrap(), "mine");
}

/// Words of a gyro's file cannot become markup.
#[test]
fn hostile_words_stay_words() {
    let folder = Folder::new();
    let gyro = std::fs::read_to_string(programs::project("docs/gvk-6.yaml")).unwrap();
    let hostile = format!("<script>alert(1)</script>&amp; {}", "unbroken".repeat(60));
    let gyro = folder.write("gyro.yaml", &gyro.replace("\"GVK-6\"", &format!("\"{hostile}\"")));
    let (page, _) = folder.page(CURRENTS, &[VERIFIED, LABORATORY, &["--gyro", &gyro]]);
    assert!(!page.contains("<script"));
    assert!(page.contains("&lt;script&gt;alert(1)&lt;/script&gt;&amp;amp; unbroken"));
}
