//! What is drawn in the report of a calibration, read off by the marks of its axes, against the result of the same run for
//! programs.

use crate::picture::{Axis, end, middle, number, of_class, reach, row, svgs};
use crate::programs;
use roxmltree::{Document, Node};
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
        calibrate.arg(currents).args(["--no-verify", "--laboratory", "docs/laboratory.yaml", "--format", "json"]);
        calibrate.args(["--gyro", "docs/gvk-6.yaml"]);
        calibrate
    };
    std::fs::write(&earlier, programs::output(calibrate(&currents))).unwrap();
    let mut calibrate = calibrate("docs/currents.csv".as_ref());
    calibrate.arg("--previous").arg(&earlier).arg("--report").arg(&page);
    let result = serde_json::from_str(&programs::output(calibrate)).unwrap();
    (std::fs::read_to_string(&page).unwrap(), result)
});

/// A figure of the report.
fn figure(name: &str) -> &'static str {
    let page = &CALIBRATED.0;
    let from = page.find(&format!("<figure id=\"figure-{name}\"")).unwrap_or_else(|| panic!("no figure {name}"));
    let end = "</figure>";
    &page[from..from + page[from..].find(end).unwrap() + end.len()]
}

fn get(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap()
}

#[test]
fn residuals_are_where_their_axes_say() {
    let page = Document::parse(figure("residuals")).unwrap();
    let result = &CALIBRATED.1["results"][2];
    assert_eq!(result["method"], "least-squares");
    let residuals = result["residuals_deg_per_h"].as_array().unwrap();
    for (panel, (key, key_u)) in svgs(&page).into_iter().zip([("x", "u_x"), ("y", "u_y")]) {
        let axis = Axis::along_x(panel);
        let (bars, limits) = (of_class(panel, "bar"), of_class(panel, "limits"));
        assert_eq!((bars.len(), limits.len()), (8, 8));
        for ((at, bar), limits) in residuals.iter().zip(bars).zip(limits) {
            let (value, u) = (get(at, key), get(at, key_u));
            axis.says(end(bar, value), value);
            axis.says(end(limits, -1.0), -2.0 * u);
            axis.says(end(limits, 1.0), 2.0 * u);
            assert_eq!(row(panel, middle(bar)), (format!("({}, {})", at["i"], at["j"]), vec![value]));
        }
    }
}

#[test]
fn verdict_and_change_are_where_their_axes_say() {
    for (name, key) in [("tolerances", "verdict"), ("changes", "change")] {
        let page = Document::parse(figure(name)).unwrap();
        let svg = svgs(&page)[0];
        let axis = Axis::along_x(svg);
        for (line, due) in of_class(svg, "limit").into_iter().zip([-100.0, 100.0]) {
            axis.says(number(line, "x1"), due);
        }
        let lines = CALIBRATED.1[key]["parameters"].as_array().unwrap();
        let whiskers = of_class(svg, "whisker");
        assert_eq!((lines.len(), whiskers.len()), (8, 8));
        for (line, whisker) in lines.iter().zip(whiskers) {
            let (deviation, expanded) = (get(line, "deviation"), get(line, "expanded_uncertainty"));
            let percent = |value: f64| 100.0 * value / get(line, "tolerance");
            let [from, to] = reach(whisker);
            axis.says(from, percent(deviation - expanded));
            axis.says(to, percent(deviation + expanded));
            let y: f64 = whisker.attribute("d").unwrap().split([',', 'H']).nth(1).unwrap().parse().unwrap();
            let symbol = line["parameter"].as_str().unwrap().replace("omega_", "ω").replace("k_", "K");
            assert_eq!(row(svg, y), (symbol, vec![deviation, expanded]));
            // The band of guarded acceptance, and the mark of what was decided with it.
            let in_row = |node: &Node| (middle(*node) - y).abs() < 0.2;
            let band = of_class(svg, "limits").into_iter().find(in_row);
            let accepted = get(line, "tolerance") - expanded;
            assert_eq!(band.is_some(), accepted > 0.0, "{line}");
            if let Some(band) = band {
                axis.says(end(band, 1.0), percent(accepted));
            }
            let circle = |class: &str| {
                let all = of_class(svg, class).into_iter();
                all.filter(|node| node.has_tag_name("circle")).find(|node| (number(*node, "cy") - y).abs() < 0.2)
            };
            let (mark, other) = match line["guarded"].as_str().unwrap() {
                "pass" => (circle("mark").unwrap(), circle("site")),
                "undecided" => (circle("site").unwrap(), circle("mark")),
                decision => panic!("{decision} is not the example's"),
            };
            axis.says(number(mark, "cx"), percent(deviation));
            assert!(other.is_none());
        }
    }
}

#[test]
fn steps_are_where_their_axes_say() {
    let page = Document::parse(figure("convergence")).unwrap();
    let svg = svgs(&page)[0];
    let (x, y) = (Axis::along_x(svg), Axis::of_decades(svg));
    let result = &CALIBRATED.1["results"][1];
    let steps = result["changes"].as_array().unwrap();
    let keys = [("main_scale_factors_percent", "delta1_percent"), ("g_drifts_deg_per_h_per_g", "delta2_deg_per_h")];
    let drawn = of_class(svg, "series");
    assert_eq!((drawn.len(), steps.len()), (2, 2));
    for (line, (key, limit)) in drawn.into_iter().zip(keys) {
        let points: Vec<&str> = line.attribute("points").unwrap().split(' ').collect();
        assert_eq!(points.len(), steps.len());
        for (point, step) in points.into_iter().zip(steps) {
            let (at_x, at_y) = point.split_once(',').unwrap();
            x.says(at_x.parse().unwrap(), get(step, "step"));
            y.says(at_y.parse().unwrap(), libm::log10(get(step, key) / get(&result["stop_rule"], limit)));
        }
    }
}
