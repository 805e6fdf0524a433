//! What is drawn, read off by the marks of its axes: against the signed file, and against the result of a calibration as
//! programs get it.

use crate::axis::{Axis, words};
use crate::passport::passport;
use crate::svg::{english, number, of_class, svgs, tip, whole};
use crate::{made, tools};
use dtg_passport::passport::content::Content;
use dtg_passport::passport::read;
use dtg_passport::report::picture::{accuracy, deviations, positions, vectors};
use roxmltree::{Document, Node};
use serde_json::Value;
use std::process::Command;
use std::sync::LazyLock;

/// Passports with deviations of minutes and of degrees, and the project's own.
fn passports() -> Vec<Content> {
    let own = include_bytes!("../../passports/SPS-2/0017/moscow-bmstu-1.yaml");
    let minutes = passport(made::ARC_MINUTES, made::SITE).0;
    let degrees = passport(made::DEGREES, made::SITE).0;
    vec![minutes, degrees, read::unverified("own", own).unwrap()]
}

/// From where to where a whisker reaches.
fn reach(whisker: Node) -> [f64; 2] {
    let path = whisker.attribute("d").unwrap();
    ['M', 'H'].map(|letter| {
        let rest = &path[path.find(letter).unwrap() + 1..];
        rest.split([',', 'M']).next().unwrap().parse().unwrap()
    })
}

/// What stands in the row of a bar: its name, and the number that carries a value.
fn row(svg: Node, y: f64) -> (String, Vec<f64>) {
    let of_row = |node: &Node| node.has_tag_name("text") && (number(*node, "y") - 4.0 - y).abs() < 0.2;
    let texts: Vec<Node> = svg.descendants().filter(of_row).collect();
    let values = texts.iter().flat_map(|text| text.descendants()).filter_map(|node| node.attribute("data-value"));
    (words(texts[0]), values.map(|value| value.parse().unwrap()).collect())
}

/// Half as far down as its rectangle reaches.
fn middle(rectangle: Node) -> f64 {
    number(rectangle, "y") + 0.5 * number(rectangle, "height")
}

/// The middle of a mark: a circle of the first frame index, a square of the second.
fn centre(mark: Node) -> [f64; 2] {
    match mark.tag_name().name() {
        "circle" => [number(mark, "cx"), number(mark, "cy")],
        _ => [number(mark, "x") + 0.5 * number(mark, "width"), middle(mark)],
    }
}

/// The end of a bar that is not at zero.
fn end(bar: Node, value: f64) -> f64 {
    number(bar, "x") + if value > 0.0 { number(bar, "width") } else { 0.0 }
}

#[test]
fn deviations_are_where_their_axes_say() {
    for content in passports() {
        let text = whole(&[deviations::deviations(&english(), &content.positions)]);
        let page = Document::parse(&text).unwrap();
        for (place, panel) in svgs(&page).into_iter().enumerate() {
            let axis = Axis::along_x(panel);
            axis.says(number(of_class(panel, "zero")[0], "x1"), 0.0);
            let bars = of_class(panel, "bar");
            assert_eq!(bars.len(), content.positions.len());
            for (index, (at, bar)) in content.positions.iter().zip(bars).enumerate() {
                let value = [at.alpha_arcsec, at.beta_arcsec, at.gamma_arcsec][place];
                let u = [at.u_alpha_arcsec, at.u_beta_arcsec, at.u_gamma_arcsec][place];
                axis.says(end(bar, value), value);
                if let Some(u) = u {
                    let [from, to] = reach(of_class(panel, "whisker")[index]);
                    axis.says(from, value - 2.0 * u);
                    axis.says(to, value + 2.0 * u);
                }
                assert_eq!(row(panel, middle(bar)), (format!("({}, {})", at.i, at.j), vec![value]));
            }
        }
    }
}

/// Index and nominal angles of each position; and north and up, which all share.
#[test]
fn positions_are_named_as_in_the_file() {
    for content in passports() {
        let text = whole(&[positions::positions(&english(), &content.positions)]);
        let page = Document::parse(&text).unwrap();
        for (at, panel) in content.positions.iter().zip(svgs(&page)) {
            let said: Vec<String> = panel.descendants().filter(|node| node.has_tag_name("text")).map(words).collect();
            let angles = format!("θ {}°\u{2002}φ {}°", at.theta_deg, at.phi_deg);
            assert_eq!(said, [&format!("({}, {})", at.i, at.j), &angles, "N", "up", "x", "y", "z"]);
        }
    }
}

/// By hand after eq. (5): what a perfect stand would have, in the order of the positions, from ω_Γ and ω_B, or from 0 and 1.
fn ideal(h: f64, v: f64) -> [[f64; 2]; 8] {
    [[0.0, h], [h, 0.0], [0.0, -h], [-h, 0.0], [0.0, v], [v, 0.0], [0.0, -v], [-v, 0.0]]
}

#[test]
fn vectors_end_where_their_axes_say() {
    for content in passports() {
        let rates = ideal(content.earth.horizontal_deg_per_h, content.earth.vertical_deg_per_h);
        let text = whole(&[vectors::vectors(&english(), &content)]);
        let page = Document::parse(&text).unwrap();
        let panels = svgs(&page);
        assert_eq!(panels.len(), 4);
        for (place, panel) in panels.into_iter().enumerate() {
            let (x, y) = (Axis::along_x(panel), Axis::along_y(panel));
            // Every tip has its mark; a vector that is too short to be seen has no arrow.
            let tips: Vec<[f64; 2]> = of_class(panel, "mark").into_iter().map(centre).collect();
            assert_eq!(tips.len(), 8);
            for arrow in of_class(panel, "real").into_iter().map(tip) {
                let near = |mark: &&[f64; 2]| (mark[0] - arrow[0]).abs() < 0.2 && (mark[1] - arrow[1]).abs() < 0.2;
                assert!(tips.iter().any(|mark| near(&mark)), "{arrow:?} has no mark");
            }
            for (index, at) in content.vectors.iter().enumerate() {
                let real = [at.omega_deg_per_h, at.specific_force_g][place / 2];
                let ideal = [rates, ideal(0.0, 1.0)][place / 2][index];
                let due = if place % 2 == 0 { real } else { [0, 1].map(|k| real[k] - ideal[k]) };
                x.says(tips[index][0], due[0]);
                y.says(tips[index][1], due[1]);
            }
        }
    }
}

/// By hand: a tolerance of K_x is 0.05 % of 95, of K_xy 0.5 % of 9.5, of a drift 0.01.
#[test]
fn accuracy_is_where_its_axis_says() {
    let (content, _) = passport(made::ARC_MINUTES, made::SITE);
    let (stated, gravity) = (content.accuracy.as_ref().unwrap(), content.earth.gravity_m_per_s2);
    let text = whole(&[accuracy::accuracy(&english(), stated, gravity)]);
    let page = Document::parse(&text).unwrap();
    let svg = svgs(&page)[0];
    let axis = Axis::along_x(svg);
    axis.says(number(of_class(svg, "limit")[0], "x1"), 100.0);
    let u = &stated.standard_uncertainty;
    let [[kx, kxy], [kyx, ky]] = u.k_deg_per_h_per_ma;
    let [x, y] = u.omega0_deg_per_h;
    let per_g = 9.80665 / gravity;
    let due = [
        ("Kx", kx, 0.0475, 1.0),
        ("Kxy", kxy, 0.0475, 1.0),
        ("Kyx", kyx, 0.0475, 1.0),
        ("Ky", ky, 0.0475, 1.0),
        ("ω0x", x, 0.01, 1.0),
        ("ω0y", y, 0.01, 1.0),
        ("ωg", u.omega_g_deg_per_h_per_g, 0.01, per_g),
        ("ωk", u.omega_k_deg_per_h_per_g, 0.01, per_g),
    ];
    for ((name, u, tolerance, factor), bar) in due.into_iter().zip(of_class(svg, "bar")) {
        axis.says(end(bar, u), 100.0 * factor * u / tolerance);
        assert_eq!(row(svg, middle(bar)), (name.to_owned(), vec![u]));
    }
}

/// A report of the example's calibration, against an earlier one whose currents were a little larger, and the result of the same
/// run for programs.
static CALIBRATED: LazyLock<(String, Value)> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let example = std::fs::read_to_string(tools::project("docs/currents.csv")).unwrap();
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
        calibrate.current_dir(tools::project("")).args(["calibrate", "passports/SPS-2/0017/moscow-bmstu-1.yaml"]);
        calibrate.arg(currents).args(["--no-verify", "--laboratory", "docs/laboratory.yaml", "--format", "json"]);
        calibrate.args(["--gyro", "docs/gvk-6.yaml"]);
        calibrate
    };
    std::fs::write(&earlier, tools::output(calibrate(&currents))).unwrap();
    let mut calibrate = calibrate("docs/currents.csv".as_ref());
    calibrate.arg("--previous").arg(&earlier).arg("--report").arg(&page);
    let result = serde_json::from_str(&tools::output(calibrate)).unwrap();
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
