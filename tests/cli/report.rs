//! The report of a calibration against the result that programs get, and what it must say large.

use crate::place::Place;
use crate::programs;
use serde_json::Value;
use std::process::Command;

const PASSPORT: &str = "passports/SPS-2/0017/moscow-bmstu-1.yaml";
const CURRENTS: &str = "docs/currents.csv";
const VERIFIED: &str = "--trust docs/allowed_signers --time 2026-11-20T08:00:00Z --laboratory docs/laboratory.yaml";
const GYRO: &str = "--gyro docs/gvk-6.yaml";

/// A folder with the example and the files that it is calibrated with.
fn folder() -> Place {
    let files = [PASSPORT, CURRENTS, "docs/allowed_signers", "docs/laboratory.yaml", "docs/gvk-6.yaml"];
    Place::of(&files.map(|name| (name, name)))
}

/// Calibrates, verified and with the laboratory: the page, and the result as JSON.
fn page(folder: &Place, currents: &str, options: &str) -> (String, Value) {
    let calibrate = format!("calibrate {PASSPORT} {currents} {VERIFIED} {options} --report report.html --force");
    let (_, stdout, said) = folder.said(&format!("{calibrate} --format json"));
    assert!(folder.path("report.html").exists(), "no report: {said}");
    (folder.read("report.html"), serde_json::from_str(&stdout).unwrap_or(Value::Null))
}

/// Returns the words of the paragraph on the previous calibration.
fn previous_calibration(page: &str) -> String {
    let markup = page.split_once("Previous calibration: ").unwrap().1.split_once("</p>").unwrap().0;
    markup.split('<').map(|part| part.split_once('>').map_or(part, |(_, words)| words)).collect()
}

#[test]
fn the_annex_is_the_result() {
    let folder = folder();
    let (html, result) = page(&folder, CURRENTS, GYRO);
    let annex = html.split_once("<pre").unwrap().1.split_once('>').unwrap().1.split_once("</pre>").unwrap().0;
    // Each line is an element of its own, so that it has a number.
    let annex = ["", " class=\"c\"", " class=\"c w\"", " class=\"n\""]
        .iter()
        .fold(annex.replace("</span>", ""), |annex, class| annex.replace(&format!("<span{class}>"), ""));
    let annex = annex.replace("&quot;", "\"").replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
    assert_eq!(serde_json::from_str::<Value>(&annex).unwrap(), result);
    // A later calibration can be compared with it.
    folder.write("earlier.json", &annex);
    let (html, result) = page(&folder, CURRENTS, &format!("{GYRO} --previous earlier.json"));
    assert!(result["change"].is_object());
    assert!(html.contains("Change since the previous calibration"));
    let of_earlier = previous_calibration(&html);
    let sha256 = &result["subject"]["currents_sha256"].as_str().unwrap()[..8];
    for words in ["date not stated", "SPS-2/0017/moscow-bmstu/1", sha256, "Not confirmed by serial number"] {
        assert!(of_earlier.contains(words), "{words}: {of_earlier}");
    }
}

/// Three earlier results, given in any order: the page has the parameters of each below one another, by date, and the result
/// is compared with the latest.
#[test]
fn earlier_results_stand_in_the_order_of_their_dates() {
    let folder = folder();
    let currents = folder.read(CURRENTS);
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
        folder.write("larger.csv", format!("{head}{larger}"));
        let (_, result) = page(&folder, "larger.csv", &format!("--date {date} --gyro-serial 4711"));
        k_x.insert(date, result["results"][0]["k_deg_per_h_per_ma"][0][0].to_string());
        folder.write(format!("{date}.json"), result.to_string());
    }
    let previous = "--previous 2026-05-12.json --previous 2024-11-03.json --previous 2025-06-30.json";
    let asked = format!("{GYRO} {previous} --date 2026-11-20 --gyro-serial 4711");
    let (html, result) = page(&folder, CURRENTS, &asked);
    let of_earlier = previous_calibration(&html);
    assert!(of_earlier.contains("2026-05-12") && !of_earlier.contains("Serial numbers"), "{of_earlier}");
    let now = result["results"][0]["k_deg_per_h_per_ma"][0][0].to_string();
    assert_eq!(result["change"]["parameters"][0]["reference_value"].to_string(), k_x["2026-05-12"]);
    let table = html.split_once("Calibrations compared").unwrap().1.split_once("</table>").unwrap().0;
    let places: Vec<usize> = k_x.values().chain([&now]).map(|value| table.find(value.as_str()).unwrap()).collect();
    assert!(places.is_sorted(), "{places:?}");
    for date in k_x.keys().chain([&"2026-11-20"]) {
        assert_eq!(table.matches(&format!(">{date}<")).count(), 8, "{date}");
    }
    assert_eq!(table.matches("class=\"picture strip\"").count(), 8 * 4 + 1);
    // Without a type there are no strips.
    let (html, _) = page(&folder, CURRENTS, previous);
    let table = html.split_once("Calibrations compared").unwrap().1.split_once("</table>").unwrap().0;
    assert!(!table.contains("strip") && table.contains("2024-11-03"));
}

#[test]
fn it_says_with_what_the_gyro_was_calibrated() {
    let (page, _) = page(&folder(), CURRENTS, GYRO);
    for file in [PASSPORT, CURRENTS] {
        // By another program.
        let sum = programs::sha256(&programs::project(file));
        assert!(page.contains(&sum), "{file}: {sum}");
    }
    let key = programs::project("tests/keys/examples.pub");
    let printed = programs::output(Command::new("ssh-keygen").args(["-l", "-f"]).arg(key));
    let fingerprint = printed.split(' ').nth(1).unwrap();
    for words in [fingerprint, "examples@", "SPS-2/0017/moscow-bmstu/1", "GVK-6", "2026-11-20"] {
        assert!(page.contains(words), "{words}");
    }
    assert!(!page.contains("NOT VERIFIED"));
}

/// Expected: U of ω_g is at least 2·10 °/(h·g)·0.0071/9.8157 = 0.0145 °/(h·g) without a height, over its tolerance of 0.01.
#[test]
fn parameters_that_no_gyro_can_pass_are_named_with_the_reason() {
    let folder = folder();
    let (page, _) = page(&folder, CURRENTS, &format!("{GYRO} --lang en,ru"));
    let (_, text, _) = folder.said(&format!("calibrate {PASSPORT} {CURRENTS} {VERIFIED} {GYRO}"));
    let text = programs::in_one_line(&text);
    for words in [
        "No value of ω_g, ω_k can pass by guarded acceptance: the guard band exceeds the tolerance.",
        "The height is not stated, so g is that at 0 m; its standard uncertainty, 0.0071 m/s², is the r.m.s. error",
    ] {
        assert!(text.contains(words), "{text}");
    }
    let page = page.replace('\u{a0}', " ");
    for words in ["can pass by guarded acceptance", "приёмка с защитной полосой невозможна", "The height is not stated"]
    {
        assert!(page.contains(words), "{words}");
    }
}
