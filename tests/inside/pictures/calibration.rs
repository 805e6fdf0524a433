//! Pictures of a calibration.

use crate::inside::picture::{Axis, end, number, of_class, reach, tip, whole};
use dtg_passport::calibration::Parameter;
use dtg_passport::calibration::document::{CalibrationDocument, ResultDocument};
use dtg_passport::calibration::verdict::{Decision, ParameterVerdict, Verdict};
use dtg_passport::gyro::GyroType;
use dtg_passport::report::page::Language;
use dtg_passport::report::picture::strips::{BESIDE_DECISIONS, Residuals};
use dtg_passport::wording::texts::units;
use roxmltree::Document;

/// A result as a file holds it, its numbers made up: two positions.
fn made_up_result() -> ResultDocument {
    let u = r#"{"k_deg_per_h_per_ma": [[0,0],[0,0]], "omega0_deg_per_h": [0,0], "omega_n_deg_per_h_per_g": [[0,0],[0,0]],
        "omega_g_deg_per_h_per_g": 0, "omega_k_deg_per_h_per_g": 0}"#;
    let text = format!(
        r#"{{"passport_id": "a/b/c/1", "passport_verified": true, "gravity_m_per_s2": 9.8, "results": [{{
        "method": "analytic", "k_deg_per_h_per_ma": [[95,9.5],[9.5,95]], "omega0_deg_per_h": [20,20],
        "omega_n_deg_per_h_per_g": [[10,-10],[10,10]], "omega_g_deg_per_h_per_g": 10, "omega_k_deg_per_h_per_g": 10,
        "standard_uncertainty": {u},
        "chi_square": {{"value": 1, "degrees_of_freedom": 8, "probability": 0.9}}, "residuals_deg_per_h": [
            {{"i": 1, "j": 1, "x": 0.001, "y": -0.002, "u_x": 0.0015, "u_y": 0.001}},
            {{"i": 1, "j": 2, "x": -0.003, "y": 0, "u_x": 0.001, "u_y": 0.0005}}]}}]}}"#
    );
    CalibrationDocument::from_json("made up", text.as_bytes()).unwrap().results.remove(0)
}

#[test]
fn residuals_stand_within_limits_of_two_uncertainties() {
    let result = made_up_result();
    let bars = Residuals::of(&result);
    let axis = whole(&[bars.axis(Some(units::DEG_PER_H)).drawn(Language::English)]);
    let axis = Document::parse(&axis).unwrap();
    let axis = Axis::along_x(axis.root_element());
    for (value, u) in [(0.001, 0.0015), (-0.003, 0.001), (-0.002, 0.001), (0.0, 0.0005)] {
        let text = whole(&[bars.bar((value, Some(u)))]);
        let page = Document::parse(&text).unwrap();
        let (bar, limits) = (of_class(page.root(), "bar")[0], of_class(page.root(), "limits")[0]);
        axis.says(number(of_class(page.root(), "zero")[0], "x1"), 0.0);
        axis.says(end(bar, value), value);
        axis.says(end(limits, -1.0), -2.0 * u);
        axis.says(end(limits, 1.0), 2.0 * u);
    }
}

fn row(
    parameter: Parameter,
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
        coverage_factor: 2.0,
        expanded_uncertainty_from_gravity: None,
        simple,
        guarded,
        decision: guarded,
        specific_risk: Some(0.0),
        conversion_of_g: None,
    }
}

/// The strips of a verdict, each as a document, and the axis below them.
fn strips(parameters: Vec<ParameterVerdict>) -> (Vec<String>, String) {
    let rule = GyroType::gvk_6().decision_rule();
    let verdict = Verdict { overall: Decision::Fail, rule, gravity_m_per_s2: 9.8, parameters, withheld: false };
    let each = verdict.parameters.iter().map(|row| whole(&[BESIDE_DECISIONS.of_parameter(&verdict, row)])).collect();
    (each, whole(&[BESIDE_DECISIONS.axis().drawn(Language::English)]))
}

/// An interval of 128 tolerances to both sides, where the axis ends at one and a half: it has no ends there.
#[test]
fn an_interval_beyond_the_axis_has_arrows_at_its_ends() {
    let (drawn, axis) = strips(vec![row(Parameter::Kx, 0.01, 6.4, 0.05, Decision::Undecided)]);
    let axis = Document::parse(&axis).unwrap();
    let axis = Axis::along_x(axis.root_element());
    let page = Document::parse(&drawn[0]).unwrap();
    let [left, right] = of_class(page.root(), "meridian")[..] else { panic!("{drawn:?}") };
    axis.says(tip(left)[0], -150.0);
    axis.says(tip(right)[0], 150.0);
    let [whisker] = of_class(page.root(), "whisker")[..] else { panic!("{drawn:?}") };
    assert!(!whisker.attribute("d").unwrap().contains('V'), "{drawn:?}");
}

/// Ten tolerances off to the right, and nine to the left, where the axis ends at one and a half; then 1.59 ± 0.63 tolerances,
/// whose interval begins within the axis and in the tolerance.
#[test]
fn an_arrow_points_outwards_from_a_value_that_the_axis_does_not_reach() {
    let (drawn, axis) = strips(vec![
        row(Parameter::Kx, 0.5, 0.02, 0.05, Decision::Fail),
        row(Parameter::Ky, -0.45, 0.02, 0.05, Decision::Fail),
        row(Parameter::Omega0x, 0.0159, 0.0063, 0.01, Decision::Undecided),
    ]);
    let axis = Document::parse(&axis).unwrap();
    let axis = Axis::along_x(axis.root_element());
    let due = [(150.0, 150.0, "mark"), (-150.0, -150.0, "mark"), (96.0, 150.0, "site")];
    for (text, (from, to, class)) in drawn.iter().zip(due) {
        let page = Document::parse(text).unwrap();
        let [arrow] = of_class(page.root(), "meridian")[..] else { panic!("{text}") };
        let (start, tip) = (number(arrow.first_element_child().unwrap(), "x1"), tip(arrow)[0]);
        axis.says(start, to);
        assert!((tip - start) * to > 0.0 && (1.0..=139.0).contains(&tip), "{text}");
        let [low, high] = reach(of_class(page.root(), "whisker")[0]);
        axis.says(low, from);
        axis.says(high, to);
        let caps = of_class(page.root(), "whisker")[0].attribute("d").unwrap().matches('V').count();
        assert_eq!(caps, usize::from(from != to));
        assert_eq!(of_class(page.root(), class).len(), 1, "{text}");
    }
}

#[test]
fn parameters_stand_where_they_are_in_their_tolerance() {
    let (drawn, axis) = strips(vec![
        row(Parameter::Kx, 0.01, 0.02, 0.05, Decision::Pass),
        row(Parameter::Ky, -0.045, 0.02, 0.05, Decision::Undecided),
        row(Parameter::Kxy, 0.7, 0.1, 0.5, Decision::Fail),
        row(Parameter::Kyx, 0.1, 0.1, 0.0, Decision::Fail),
    ]);
    let axis = Document::parse(&axis).unwrap();
    let axis = Axis::along_x(axis.root_element());
    let pages: Vec<Document> = drawn.iter().map(|text| Document::parse(text).unwrap()).collect();
    for page in &pages {
        for (line, due) in of_class(page.root(), "limit").into_iter().zip([-100.0, 100.0]) {
            axis.says(number(line, "x1"), due);
        }
    }
    // A disc that passes at a fifth of its tolerance, a ring that is undecided at nine tenths, a cross at seven fifths.
    axis.says(number(of_class(pages[0].root(), "mark")[0], "cx"), 20.0);
    axis.says(number(of_class(pages[1].root(), "site")[0], "cx"), -90.0);
    let cross = of_class(pages[2].root(), "mark")[0];
    assert!(cross.has_tag_name("polygon"));
    // Guarded acceptance of the first: three fifths of the tolerance either way; a tolerance of 0 has no picture.
    let guarded = of_class(pages[0].root(), "limits")[0];
    axis.says(number(guarded, "x"), -60.0);
    axis.says(number(guarded, "x") + number(guarded, "width"), 60.0);
    let drawn = ["limits", "whisker", "mark"].map(|class| of_class(pages[3].root(), class).len());
    assert_eq!(drawn, [0, 0, 0]);
}
