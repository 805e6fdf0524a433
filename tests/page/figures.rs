//! What is drawn in the report of a calibration, read off by the marks of its axes, against the result of the same run for
//! programs.

use crate::picture::{Axis, end, number, of_class, reach};
use crate::programs;
use roxmltree::Document;
use serde_json::Value;
use std::process::Command;
use std::sync::LazyLock;

/// A report of the example's calibration, against an earlier one whose currents were a little larger, and the result of the same
/// run for programs.
static CALIBRATED: LazyLock<(String, Value)> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let example = std::fs::read_to_string(programs::project("docs/currents.csv")).unwrap();
    let larger = example.lines().map(|line| match line.rsplit_once(',') {
        Some((rest, jy)) if jy.parse::<f64>().is_ok() => {
            format!("{rest},{:.7}\n", 1.0002 * jy.parse::<f64>().unwrap())
        }
        _ => format!("{line}\n"),
    });
    let [currents, earlier, page] = ["earlier.csv", "earlier.json", "report.html"].map(|name| folder.path().join(name));
    std::fs::write(&currents, larger.collect::<String>()).unwrap();
    let calibrate = |currents: &std::path::Path| {
        let mut calibrate = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
        calibrate.current_dir(programs::project("")).args(["calibrate", "passports/SPS-2/0017/moscow-bmstu-1.yaml"]);
        calibrate.arg(currents).args(["--trust", "tests/keys/allowed_signers", "--time", "2026-11-20"]);
        calibrate.args(["--laboratory", "docs/laboratory.yaml", "--format", "json"]);
        calibrate.args(["--gyro", "docs/gvk-6.yaml"]);
        calibrate
    };
    std::fs::write(&earlier, programs::output(calibrate(&currents))).unwrap();
    let mut calibrate = calibrate("docs/currents.csv".as_ref());
    calibrate.arg("--previous").arg(&earlier).args(["--budget", "--details", "--report"]).arg(&page);
    let result = serde_json::from_str(&programs::output(calibrate)).unwrap();
    (std::fs::read_to_string(&page).unwrap(), result)
});

/// The tables of a class, with the strips in their cells.
fn table(class: &str) -> Vec<&'static str> {
    let (page, end) = (&CALIBRATED.0, "</table>");
    let begins =
        page.match_indices(&format!("<table class=\"numbers {class}\"")).map(|(from, _)| from).collect::<Vec<_>>();
    begins.into_iter().map(|from| &page[from..from + page[from..].find(end).unwrap() + end.len()]).collect()
}

fn get(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap()
}

#[test]
fn residuals_are_where_their_axes_say() {
    let page = Document::parse(table("residuals")[0]).unwrap();
    let result = &CALIBRATED.1["results"][0];
    assert_eq!(result["method"], "least-squares");
    let residuals = result["residuals_deg_per_h"].as_array().unwrap();
    let strips = of_class(page.root(), "strip");
    assert_eq!((residuals.len(), strips.len()), (8, 18));
    for (column, (key, key_u)) in [("x", "u_x"), ("y", "u_y")].into_iter().enumerate() {
        let axis = Axis::along_x(strips[16 + column]);
        for (line, at) in residuals.iter().enumerate() {
            let strip = strips[2 * line + column];
            let (value, u) = (get(at, key), get(at, key_u));
            axis.says(end(of_class(strip, "bar")[0], value), value);
            let limits = of_class(strip, "limits")[0];
            axis.says(end(limits, -1.0), -2.0 * u);
            axis.says(end(limits, 1.0), 2.0 * u);
        }
    }
}

/// The tables of the result and of its change since the earlier one: in each row the strip is drawn to the axis below, where
/// the numbers of the result are, and the row's numbers are those.
#[test]
fn verdict_and_change_are_where_their_axes_say() {
    let tables = table("result");
    assert_eq!(tables.len(), 2);
    for (table, key) in tables.into_iter().zip(["verdict", "change"]) {
        let page = Document::parse(table).unwrap();
        let strips = of_class(page.root(), "strip");
        let lines = CALIBRATED.1[key]["parameters"].as_array().unwrap();
        assert_eq!((lines.len(), strips.len()), (8, 9));
        let axis = Axis::along_x(strips[8]);
        let body = page.descendants().find(|node| node.has_tag_name("tbody")).unwrap();
        let rows = body.children().filter(|node| node.has_tag_name("tr"));
        // Pages have the paper's order: K_x, K_y, K_xy, K_yx.
        let lines = [0, 3, 1, 2, 4, 5, 6, 7].map(|place| &lines[place]);
        for ((line, row), strip) in lines.into_iter().zip(rows).zip(&strips) {
            let (deviation, expanded) = (get(line, "deviation"), get(line, "expanded_uncertainty"));
            let percent = |value: f64| 100.0 * value / get(line, "tolerance");
            for (limit, due) in of_class(*strip, "limit").into_iter().zip([-100.0, 100.0]) {
                axis.says(number(limit, "x1"), due);
            }
            let [from, to] = reach(of_class(*strip, "whisker")[0]);
            // The axis ends at one and a half tolerances; arrows point to what is beyond.
            let ends = [deviation - expanded, deviation + expanded].map(percent);
            axis.says(from, ends[0].max(-150.0));
            axis.says(to, ends[1].min(150.0));
            let beyond = ends.iter().filter(|end| end.abs() > 150.0).count();
            assert_eq!(of_class(*strip, "meridian").len(), beyond, "{line}");
            let values: Vec<f64> = row
                .descendants()
                .filter(|node| node.has_tag_name("data"))
                .map(|node| node.attribute("value").unwrap().parse().unwrap())
                .collect();
            assert!(values.contains(&deviation) && values.contains(&expanded), "{line}: {values:?}");
            // The band of guarded acceptance, and the mark of what was decided with it.
            let band = of_class(*strip, "limits");
            let accepted = get(line, "tolerance") - expanded;
            assert_eq!(!band.is_empty(), accepted > 0.0, "{line}");
            if let Some(band) = band.first() {
                axis.says(end(*band, 1.0), percent(accepted));
            }
            let (class, other) = match line["decision"].as_str().unwrap() {
                "pass" => ("mark", "site"),
                "undecided" => ("site", "mark"),
                decision => panic!("{decision} is not the example's"),
            };
            axis.says(number(of_class(*strip, class)[0], "cx"), percent(deviation));
            assert!(of_class(*strip, other).is_empty());
        }
    }
}

/// Every part of a strip is as long as the share of one input, and each strip as long as its variance; that of a drift per g is
/// the variance of the decision, of which local g is a part.
#[test]
fn shares_of_a_variance_are_as_long_as_in_the_result() {
    let page = Document::parse(table("shares")[0]).unwrap();
    let strips = of_class(page.root(), "strip");
    let lines = CALIBRATED.1["budget"]["parameters"].as_array().unwrap();
    assert_eq!((lines.len(), strips.len()), (8, 9));
    let axis = Axis::along_x(strips[8]);
    let us = page.descendants().filter(|node| node.has_tag_name("data"));
    let decided = CALIBRATED.1["verdict"]["parameters"].as_array().unwrap();
    let (mut parts_drawn, mut with_gravity) = (0, 0);
    for (u, strip) in us.zip(&strips) {
        let u: f64 = u.attribute("value").unwrap().parse().unwrap();
        let of_decision = decided.iter().find(|line| get(line, "standard_uncertainty") == u);
        let from_gravity = of_decision.and_then(|line| line["expanded_uncertainty_from_gravity"].as_f64());
        let gravity =
            from_gravity.map_or(0.0, |part| (part / get(of_decision.unwrap(), "expanded_uncertainty")).powi(2));
        let line = match of_decision.filter(|_| from_gravity.is_some()) {
            Some(at_type) => lines.iter().find(|line| line["parameter"] == at_type["parameter"]).unwrap(),
            None => lines.iter().find(|line| get(line, "standard_uncertainty") == u).unwrap(),
        };
        with_gravity += usize::from(from_gravity.is_some());
        let inputs = line["contributions"].as_array().unwrap().iter();
        let mut shares: Vec<f64> = inputs.map(|part| 100.0 * (1.0 - gravity) * get(part, "share")).collect();
        shares.push(100.0 * gravity);
        let (mut parts, mut end) = (of_class(*strip, "share"), 0.0);
        let rest = parts.remove(0);
        axis.says(number(parts[0], "x"), 0.0);
        for part in parts {
            axis.says(number(part, "x"), end);
            let to = axis.value(number(part, "x") + number(part, "width"));
            // The nearest, because small shares differ by less than a line's width.
            let off = |share: &f64| (to - end - share).abs();
            let nearest = (0..shares.len()).min_by(|one, other| off(&shares[*one]).total_cmp(&off(&shares[*other])));
            let share = shares.remove(nearest.unwrap());
            assert!(off(&share) <= 4.0 * axis.fineness(), "{} of {line}", to - end);
            end += share;
            parts_drawn += 1;
        }
        axis.says(number(rest, "x"), end);
        axis.says(number(rest, "x") + number(rest, "width"), 100.0);
    }
    assert!(parts_drawn > 16 && with_gravity == 2, "{parts_drawn}, {with_gravity}");
}
