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
