//! Pictures of a calibration.

use crate::inside::picture::{Axis, both, english, number, of_class, svgs, tip, whole};
use dtg_passport::calibration::document::{CalibrationDocument, ResultDocument};
use dtg_passport::calibration::verdict::{Decision, ParameterVerdict, Verdict};
use dtg_passport::report::picture::{convergence, residuals, tolerances};
use roxmltree::Document;

/// A result as a file holds it, its numbers made up: two positions, and three steps that fall by 1000 and by 100.
fn made_up_result() -> ResultDocument {
    let u = r#"{"k_deg_per_h_per_ma": [[0,0],[0,0]], "omega0_deg_per_h": [0,0], "omega_n_deg_per_h_per_g": [[0,0],[0,0]],
        "omega_g_deg_per_h_per_g": 0, "omega_k_deg_per_h_per_g": 0}"#;
    let text = format!(
        r#"{{"passport_id": "a/b/c/1", "passport_verified": true, "gravity_m_per_s2": 9.8, "results": [{{
        "method": "iterative", "k_deg_per_h_per_ma": [[95,9.5],[9.5,95]], "omega0_deg_per_h": [20,20],
        "omega_n_deg_per_h_per_g": [[10,-10],[10,10]], "omega_g_deg_per_h_per_g": 10, "omega_k_deg_per_h_per_g": 10,
        "iterations": 4, "stop_rule": {{"delta1_percent": 0.1, "delta2_deg_per_h": 0.001}}, "changes": [
            {{"step": 2, "main_scale_factors_percent": 10, "g_drifts_deg_per_h_per_g": 0.1}},
            {{"step": 3, "main_scale_factors_percent": 0.01, "g_drifts_deg_per_h_per_g": 0.001}},
            {{"step": 4, "main_scale_factors_percent": 0.00001, "g_drifts_deg_per_h_per_g": 0}}],
        "spectral_radius": 0.001, "standard_uncertainty": {u},
        "chi_square": {{"value": 1, "degrees_of_freedom": 8, "probability": 0.9}}, "residuals_deg_per_h": [
            {{"i": 1, "j": 1, "x": 0.001, "y": -0.002, "u_x": 0.0015, "u_y": 0.001}},
            {{"i": 1, "j": 2, "x": -0.003, "y": 0, "u_x": 0.001, "u_y": 0.0005}}]}}]}}"#
    );
    CalibrationDocument::from_json("made up", text.as_bytes()).unwrap().results.remove(0)
}

#[test]
fn residuals_stand_within_limits_of_two_uncertainties() {
    let text = whole(&[residuals::residuals(&both(), &made_up_result())]);
    let page = Document::parse(&text).unwrap();
    let panels = svgs(&page);
    // The first of y, 0.002, gives the scale.
    let scale = number(of_class(panels[1], "bar")[0], "width") / 0.002;
    for (panel, rows) in panels.into_iter().zip([[(0.001, 0.0015), (-0.003, 0.001)], [(-0.002, 0.001), (0.0, 0.0005)]])
    {
        let zero = number(of_class(panel, "zero")[0], "x1");
        for (index, (value, u)) in rows.into_iter().enumerate() {
            let (bar, limits) = (of_class(panel, "bar")[index], of_class(panel, "limits")[index]);
            let left = f64::min(zero, zero + scale * value);
            assert!(
                (number(bar, "x") - left).abs() < 0.2 && (number(bar, "width") - scale * f64::abs(value)).abs() < 0.2
            );
            assert!((number(limits, "x") - (zero - 2.0 * scale * u)).abs() < 0.2);
            assert!((number(limits, "width") - 4.0 * scale * u).abs() < 0.2);
        }
    }
}

fn row(
    parameter: &'static str,
    deviation: f64,
    expanded_uncertainty: f64,
    tolerance: f64,
    guarded: Decision,
) -> ParameterVerdict {
    let (unit, simple) = ("%", Decision::Pass);
    ParameterVerdict {
        parameter,
        value: 1.0,
        reference_value: 1.0,
        standard_uncertainty: 1.0,
        unit,
        deviation,
        tolerance,
        expanded_uncertainty,
        expanded_uncertainty_from_gravity: None,
        simple,
        guarded,
        specific_risk: 0.0,
    }
}

/// Ten tolerances off to the right, and nine to the left, where the axis ends at four.
#[test]
fn an_arrow_points_to_what_the_axis_does_not_reach() {
    let parameters = vec![row("k_x", 0.5, 0.02, 0.05, Decision::Fail), row("k_y", -0.45, 0.02, 0.05, Decision::Fail)];
    let verdict = Verdict { overall: Decision::Fail, gravity_m_per_s2: 9.8, parameters };
    let text = whole(&[tolerances::tolerances(&english(), "tolerances", &verdict)]);
    let page = Document::parse(&text).unwrap();
    let svg = svgs(&page)[0];
    let axis = Axis::along_x(svg);
    let tips: Vec<f64> = of_class(svg, "meridian").into_iter().map(|arrow| tip(arrow)[0]).collect();
    assert_eq!(tips.len(), 2);
    axis.says(tips[0], 400.0);
    axis.says(tips[1], -400.0);
    assert!(of_class(svg, "whisker").is_empty());
    assert!(text.contains("data-value=\"0.5\"") && text.contains("data-value=\"-0.45\""));
}

#[test]
fn parameters_stand_where_they_are_in_their_tolerance() {
    let parameters = vec![
        row("k_x", 0.01, 0.02, 0.05, Decision::Pass),
        row("k_y", -0.045, 0.02, 0.05, Decision::Undecided),
        row("k_xy", 0.7, 0.1, 0.5, Decision::Fail),
        row("k_yx", 0.1, 0.1, 0.0, Decision::Fail),
    ];
    let verdict = Verdict { overall: Decision::Fail, gravity_m_per_s2: 9.8, parameters };
    let text = whole(&[tolerances::tolerances(&both(), "tolerances", &verdict)]);
    let page = Document::parse(&text).unwrap();
    let svg = svgs(&page)[0];
    let limits: Vec<f64> = of_class(svg, "limit").into_iter().map(|line| number(line, "x1")).collect();
    let (zero, unit) = (0.5 * (limits[0] + limits[1]), 0.5 * (limits[1] - limits[0]));
    // A disc that passes at a fifth of its tolerance, a ring that is undecided at nine tenths.
    let disc = of_class(svg, "mark").into_iter().find(|node| node.has_tag_name("circle")).unwrap();
    let ring = of_class(svg, "site")[0];
    assert!((number(disc, "cx") - (zero + 0.2 * unit)).abs() < 0.2);
    assert!((number(ring, "cx") - (zero - 0.9 * unit)).abs() < 0.2);
    // Guarded acceptance of the first: three fifths of the tolerance either way; a tolerance of 0 has no picture.
    let guarded = of_class(svg, "limits");
    assert_eq!((guarded.len(), of_class(svg, "whisker").len()), (3, 3));
    assert!((number(guarded[0], "width") - 2.0 * 0.6 * unit).abs() < 0.2);
    assert!(text.contains("Kyx") && text.contains("undecided") && text.contains("не определено"));
}

#[test]
fn convergence_is_drawn_in_decades() {
    let text = whole(&[convergence::convergence(&both(), &made_up_result()).unwrap()]);
    let page = Document::parse(&text).unwrap();
    let svg = svgs(&page)[0];
    let lines: Vec<Vec<[f64; 2]>> = of_class(svg, "series")
        .into_iter()
        .map(|line| {
            let points = line.attribute("points").unwrap().split(' ');
            points
                .map(|at| at.split_once(',').map(|(x, y)| [x.parse().unwrap(), y.parse().unwrap()]).unwrap())
                .collect()
        })
        .collect();
    let limit = number(of_class(svg, "limit")[0], "y1");
    // Over their limits: 100, 0.1, 0.0001 and 100, 1, nothing.
    let decade = (lines[0][1][1] - lines[0][0][1]) / 3.0;
    assert!(decade > 5.0);
    assert!((limit - lines[0][0][1] - 2.0 * decade).abs() < 0.2);
    assert!((lines[0][2][1] - lines[0][1][1] - 3.0 * decade).abs() < 0.2);
    assert!((lines[1][0][1] - lines[0][0][1]).abs() < 0.2 && (lines[1][1][1] - limit).abs() < 0.2);
    // What did not move at all is at the lower end of the axis.
    let lowest = of_class(svg, "zero").into_iter().map(|line| number(line, "y2")).fold(0.0, f64::max);
    assert_eq!(lines[1][2][1], lowest);
    let steps = [0, 1].map(|k| lines[0][k + 1][0] - lines[0][k][0]);
    assert!((steps[0] - steps[1]).abs() < 0.2, "a step is as wide as the next");
}

#[test]
fn other_methods_have_no_steps_to_draw() {
    let result = ResultDocument { changes: None, stop_rule: None, ..made_up_result() };
    assert!(convergence::convergence(&english(), &result).is_none());
}
