//! Pictures of a calibration.

use crate::inside::picture::{Axis, number, of_class, reach, tip, whole};
use dtg_passport::calibration::Parameter;
use dtg_passport::calibration::verdict::{Decision, ParameterVerdict, Verdict};
use dtg_passport::gyro::GyroType;
use dtg_passport::report::page::Language;
use dtg_passport::report::picture::strips::BESIDE_DECISIONS;
use roxmltree::Document;

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
fn strips(parameters: Vec<ParameterVerdict>) -> (Vec<String>, Axis) {
    let rule = GyroType::gvk_6().decision_rule();
    let verdict = Verdict { overall: Decision::Fail, rule, gravity_m_per_s2: 9.8, parameters, withheld: false };
    let each = verdict.parameters.iter().map(|row| whole(&[BESIDE_DECISIONS.of_parameter(&verdict, row)])).collect();
    (each, Axis::drawn_along_x(BESIDE_DECISIONS.axis().drawn(Language::English)))
}

/// An interval of 128 tolerances to both sides, where the axis ends at one and a half: it has no ends there.
#[test]
fn an_interval_beyond_the_axis_has_arrows_at_its_ends() {
    let (drawn, axis) = strips(vec![row(Parameter::Kx, 0.01, 6.4, 0.05, Decision::Undecided)]);
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
