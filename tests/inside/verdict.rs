//! Verdicts against hand-made figures, the JSON of results, and the inputs that the files state.

use crate::inside::reference::*;
use dtg_passport::calibration::document::{CalibrationDocument, Subject};
use dtg_passport::calibration::stated::{NotStated, TemperatureOutside};
use dtg_passport::calibration::verdict::{Decision, Found, against_earlier, against_type, change_in_uncertainties};
use dtg_passport::calibration::{InputUncertainty, Parameter, Setup};
use dtg_passport::coefficients::EarthRate;
use dtg_passport::gyro::{DecisionRule, GyroParameters, GyroType, Rule};
use dtg_passport::laboratory::Laboratory;
use dtg_passport::site::Site;
use dtg_passport::stand::{Certificate, Stand};
use dtg_passport::units::radians_from_arcseconds;

const G: f64 = 9.80665;

fn found(change: impl Fn(&mut [f64; 8]), u: [f64; 8]) -> Found {
    let mut values = gvk_6().to_vector();
    change(&mut values);
    Found {
        parameters: GyroParameters::from_vector(&values),
        standard_uncertainty: u,
        degrees_of_freedom: [f64::INFINITY; 8],
        gravity_m_per_s2: G,
        gravity_u_m_per_s2: 0.0,
    }
}

const SMALL: [f64; 8] = [0.005, 0.01, 0.01, 0.005, 0.002, 0.002, 0.002, 0.002];

fn by(rule: Rule, guard_band_of_u: Option<f64>) -> GyroType {
    GyroType { decision: Some(DecisionRule { rule, guard_band_of_u }), ..GyroType::gvk_6() }
}

/// Expected: the contract: a band above 0 and at most 1, none with simple acceptance, no other rule.
#[test]
fn decision_rules_of_files() {
    let file = |decision: &str| {
        let text = include_str!("../../docs/gvk-6.yaml").to_owned() + decision;
        GyroType::from_yaml("gyro.yaml", text.as_bytes())
    };
    for (decision, band) in [
        ("", 1.0),
        ("decision: {rule: \"guarded\"}\n", 1.0),
        ("decision: {rule: \"guarded\", guard_band_of_u: 0.5}\n", 0.5),
        ("decision: {rule: \"guarded\", guard_band_of_u: 1}\n", 1.0),
        ("decision: {rule: \"simple\"}\n", 0.0),
    ] {
        assert_eq!(file(decision).unwrap().decision_rule().guard_band(), band, "{decision}");
    }
    for (decision, said) in [
        ("{rule: \"lenient\"}", "decision.rule: found \"lenient\", expected \"guarded\" or \"simple\""),
        ("{guard_band_of_u: 0.5}", "decision.rule: missing"),
        ("{rule: \"guarded\", guard_band_of_u: 0}", "found 0, expected a number above 0, at most 1"),
        ("{rule: \"guarded\", guard_band_of_u: 1.01}", "found 1.01, expected a number above 0, at most 1"),
        ("{rule: \"simple\", guard_band_of_u: 0.5}", "found 0.5, expected no guard band, because the rule is simple"),
    ] {
        let refused = file(&format!("decision: {decision}\n")).unwrap_err().to_string();
        assert!(refused.contains(said), "{refused}");
    }
}

/// Expected by hand, tolerances 0.05 % of 95 = 0.0475, 0.5 % of 9.5 = 0.0475, 0.01; the risks are Φ of the standard
/// uncertainties to the tolerance's edge, and a negligible other tail.
#[test]
fn decisions() {
    use Decision::{Fail, Pass, Undecided};

    let verdict = against_type(&found(|_| {}, SMALL), &GyroType::gvk_6());
    assert_eq!((verdict.overall, verdict.parameters.len()), (Pass, 8));
    assert!(verdict.parameters.iter().all(|p| p.simple == Pass && p.guarded == Pass));
    let (guarded, simple) = (GyroType::gvk_6(), by(Rule::Simple, None));
    let [one_u, three_quarters] = [0.158_655_253_931_457, 0.226_627_352_376_868];
    for (out, u, gyro, overall, by_guard, risk) in [
        // ω_0x out by 0.008 with U = 0.004: within by simple acceptance, not decided by guarded.
        (0.008, SMALL, guarded.clone(), Undecided, Undecided, None),
        (0.008, SMALL, simple.clone(), Pass, Undecided, Some(one_u)),
        // A guard band of half of U is 0.002: just enough. One of a quarter decides 0.0115 to be out.
        (0.007_999, SMALL, by(Rule::Guarded, Some(0.5)), Pass, Pass, Some(0.158_534_298_815)),
        (0.011_5, SMALL, by(Rule::Guarded, Some(0.25)), Fail, Fail, Some(three_quarters)),
        // Simply out, not decided; the same risk from the other side.
        (-0.012, SMALL, simple, Fail, Undecided, Some(one_u)),
        (0.015, SMALL, guarded.clone(), Fail, Fail, Some(0.006_209_665_325_776)),
        // An exact result leaves no doubt.
        (0.011, [0.0; 8], guarded, Fail, Fail, Some(0.0)),
    ] {
        let verdict = against_type(&found(|v| v[4] += out, u), &gyro);
        let row = &verdict.parameters[4];
        assert_eq!((row.parameter.key(), row.unit), ("omega_0x", "deg/h"));
        assert_eq!((verdict.overall, row.decision, row.guarded), (overall, overall, by_guard), "{row:?}");
        assert_eq!(row.simple, if f64::abs(out) > 0.01 { Fail } else { Pass }, "{row:?}");
        assert_eq!(row.specific_risk.is_some(), risk.is_some(), "{row:?}");
        assert!((row.specific_risk.unwrap_or(0.0) - risk.unwrap_or(0.0)).abs() < 1e-9, "{row:?}");
        assert!((row.expanded_uncertainty - 2.0 * u[4]).abs() < 1e-15, "{row:?}");
    }
    // K_x in percent: 0.095 of 95 is 0.1 %.
    let verdict = against_type(&found(|v| v[0] += 0.095, SMALL), &GyroType::gvk_6());
    let k_x = &verdict.parameters[0];
    assert_eq!((k_x.parameter.key(), k_x.unit, k_x.tolerance), ("k_x", "%", 0.05));
    assert!((k_x.deviation - 0.1).abs() < 1e-12 && k_x.guarded == Fail);
    // K_xy of a type without cross-coupling, in its own unit: 0.03 within 0.05 by U = 0.02, just so.
    let mut uncoupled = GyroType::gvk_6();
    uncoupled.nominal.k_deg_per_h_per_ma = [[95.0, 0.0], [0.0, 95.0]];
    (uncoupled.tolerance.k_cross_percent, uncoupled.tolerance.k_cross_deg_per_h_per_ma) = (None, Some(0.05));
    let verdict = against_type(&found(|v| (v[1], v[2]) = (0.0299, -0.04), SMALL), &uncoupled);
    let (k_xy, k_yx) = (&verdict.parameters[1], &verdict.parameters[2]);
    assert_eq!((k_xy.parameter.key(), k_xy.unit, k_xy.tolerance), ("k_xy", "deg/h/mA", 0.05));
    assert_eq!((k_xy.deviation, k_xy.guarded, k_yx.guarded), (0.0299, Pass, Undecided));
}

/// Expected by hand: the general model has no ω_g and ω_k, so a gyro cannot be within all eight tolerances, however good
/// the other six are; one of these out of tolerance is enough to fail. The same is true of a change.
#[test]
fn a_gyro_without_omega_g_and_omega_k_does_not_pass() {
    let general = |out: f64| {
        let per_g = |v: &mut [f64; 8]| {
            v[4] += out;
            (v[6], v[7]) = (f64::NAN, f64::NAN);
        };
        found(per_g, SMALL)
    };
    let verdict = against_type(&general(0.0), &GyroType::gvk_6());
    assert_eq!((verdict.overall, verdict.parameters.len()), (Decision::Undecided, 6));
    assert!(verdict.parameters.iter().all(|row| row.guarded == Decision::Pass));
    assert_eq!(verdict.not_found(), [Parameter::OmegaG, Parameter::OmegaK]);
    assert_eq!(against_type(&general(0.02), &GyroType::gvk_6()).overall, Decision::Fail);
    assert_eq!(against_earlier(&general(0.0), &found(|_| {}, SMALL), &GyroType::gvk_6()).overall, Decision::Undecided);
}

/// Expected: the factors for 95.45 % in table G.2 of JCGM 100; the risks P(T < -1) + P(T < -9) from mpmath.
#[test]
fn few_degrees_of_freedom_need_a_larger_factor() {
    for (degrees_of_freedom, k, risk) in [
        (1.0, 13.97, 0.285223287477),
        (2.0, 4.53, 0.217385695452),
        (3.0, 3.31, 0.196949015559),
        (4.0, 2.87, 0.187372399409),
        (10.0, 2.28, 0.170448635176),
        (50.0, 2.05, 0.161062822553),
    ] {
        let few = Found { degrees_of_freedom: [degrees_of_freedom; 8], ..found(|_| {}, SMALL) };
        let verdict = against_type(&few, &GyroType { gravity_m_per_s2: Some(G), ..GyroType::gvk_6() });
        for row in &verdict.parameters {
            assert!((row.coverage_factor - k).abs() <= 0.005, "{row:?}");
            let unit = if row.unit == "%" { row.reference_value / 100.0 } else { 1.0 };
            assert!((row.expanded_uncertainty * unit - row.coverage_factor * row.standard_uncertainty).abs() < 1e-12);
        }
        // The tightest tolerances are those of K_y and K_xy, 0.0475 with u = 0.01.
        assert_eq!(verdict.overall, if k < 4.75 { Decision::Pass } else { Decision::Undecided });
        // ω_0x is one standard uncertainty within its tolerance.
        let edge = Found { degrees_of_freedom: [degrees_of_freedom; 8], ..found(|v| v[4] += 0.008, SMALL) };
        let found = against_type(&edge, &by(Rule::Simple, None)).parameters[4].specific_risk.unwrap();
        assert!((found - risk).abs() < 1e-9, "{found} instead of {risk}");
    }
}

/// Expected: table G.2 of JCGM 100. The order of the keys is not that of the parameters.
#[test]
fn an_earlier_result_is_judged_by_its_own_degrees_of_freedom() {
    let u = r#"{"k_deg_per_h_per_ma": [[0.01, 0.01], [0.01, 0.01]], "omega0_deg_per_h": [0.002, 0.002],
        "omega_n_deg_per_h_per_g": [[0, 0], [0, 0]], "omega_g_deg_per_h_per_g": 0.002, "omega_k_deg_per_h_per_g": 0.002}"#;
    let result = format!(
        r#"{{"passport_id": "a/b/c/1", "passport_verified": true, "gravity_m_per_s2": 9.80665,
        "degrees_of_freedom": {{"omega_0y": 10, "k_y": 3, "k_xy": 2}}, "results": [{{"method": "analytic",
        "k_deg_per_h_per_ma": [[95, 9.5], [9.5, 95]], "omega0_deg_per_h": [20, 20],
        "omega_n_deg_per_h_per_g": [[10, -10], [10, 10]], "omega_g_deg_per_h_per_g": 10, "omega_k_deg_per_h_per_g": 10,
        "standard_uncertainty": {u}, "chi_square": {{"value": 1, "degrees_of_freedom": 8, "probability": 0.9}},
        "residuals_deg_per_h": []}}]}}"#
    );
    let earlier = CalibrationDocument::from_json("earlier.json", result.as_bytes()).unwrap();
    let verdict = against_type(&earlier.valid().unwrap(), &GyroType::gvk_6());
    for row in verdict.parameters {
        let k = match row.parameter.key() {
            "k_xy" => 4.53,
            "k_y" => 3.31,
            "omega_0y" => 2.28,
            _ => 2.0,
        };
        assert!((row.coverage_factor - k).abs() <= 0.005, "{row:?}");
    }
}

/// Expected by hand: 10 °/h/g under a g known to 0.005 of 10 m/s² adds 0.005; a change under the same g does not see it,
/// one under another g does, twice.
#[test]
fn what_is_known_of_gravity_enters_with_the_types_g() {
    let at = |gravity_m_per_s2: f64| Found { gravity_m_per_s2, gravity_u_m_per_s2: 0.005, ..found(|_| {}, SMALL) };
    let gyro = GyroType { gravity_m_per_s2: Some(10.0), ..GyroType::gvk_6() };
    let expanded = |one: &Found, earlier: Option<&Found>| {
        let verdict = earlier.map_or_else(|| against_type(one, &gyro), |earlier| against_earlier(one, earlier, &gyro));
        verdict.parameters[6].expanded_uncertainty
    };
    let squares = |squares: f64| 2.0 * squares.sqrt();
    assert!((expanded(&at(10.0), None) - squares(0.002_f64.powi(2) + 0.005_f64.powi(2))).abs() < 1e-12);
    assert!((expanded(&at(10.0), Some(&at(10.0))) - squares(2.0 * 0.002_f64.powi(2))).abs() < 1e-12);
    let elsewhere = Found { gravity_m_per_s2: 10.000_000_1, ..at(10.0) };
    let due = squares(2.0 * (0.002_f64.powi(2) + 0.005_f64.powi(2)));
    assert!((expanded(&at(10.0), Some(&elsewhere)) - due).abs() < 1e-9);
}

/// Deviation = value − reference of the numbers shown, in the unit shown: drifts at the type's g, scale factors in percent of
/// the nominal value. Expected by hand: 10 °/h/g under 9.8 m/s² are 10 · 9.80665/9.8 under the type's.
#[test]
fn the_deviation_is_the_difference_of_the_numbers_shown() {
    let gyro = GyroType::gvk_6();
    let here = Found { gravity_m_per_s2: 9.8, ..found(|v| v[0] += 0.02, SMALL) };
    let earlier = Found { gravity_m_per_s2: 9.79, ..found(|v| v[7] += 0.5, SMALL) };
    for verdict in [against_type(&here, &gyro), against_earlier(&here, &earlier, &gyro)] {
        assert_eq!(verdict.gravity_m_per_s2, G);
        for (row, nominal) in verdict.parameters.iter().zip([95.0, 9.5, 9.5, 95.0, 20.0, 20.0, 10.0, 10.0]) {
            let unit = if row.unit == "%" { nominal / 100.0 } else { 1.0 };
            assert!((row.value - row.reference_value - row.deviation * unit).abs() < 1e-12, "{row:?}");
            assert!((row.standard_uncertainty * 2.0 - row.expanded_uncertainty * unit).abs() < 1e-12, "{row:?}");
        }
        assert!((verdict.parameters[6].value - 10.0 * 9.80665 / 9.8).abs() < 1e-12, "{verdict:?}");
    }
    let verdict = against_earlier(&here, &earlier, &gyro);
    assert!((verdict.parameters[7].reference_value - 10.5 * 9.80665 / 9.79).abs() < 1e-12);
    let verdict = against_type(&here, &gyro);
    assert_eq!((verdict.parameters[0].reference_value, verdict.parameters[6].guarded), (95.0, Decision::Undecided));
}

const HOLLOMAN: &str = "format: \"dtg-site/1\"\nid: \"holloman\"\nlatitude_deg: 32.8525\nlongitude_deg: -106.1064\n";

/// What is said of a gyro with these drifts under the type's g, measured at Holloman under the local g that is there, with the
/// uncertainty of a good meter.
fn at_holloman(site: &str, omega_g: f64) -> dtg_passport::calibration::verdict::ParameterVerdict {
    // By hand: sin²(32.8525°) = 0.294283; Somigliana 9.7803253359 (1 + 0.00193185265 · 0.294283)/√(1 − 0.00669438 · 0.294283)
    // = 9.795539; less 3.0855e-6 for each of 1,225 m: 9.791759.
    const LOCAL_G: f64 = 9.791_759;
    let site = Site::from_yaml("holloman.yaml", site.as_bytes()).unwrap();
    let measured = Found {
        gravity_m_per_s2: site.earth().gravity_m_per_s2,
        gravity_u_m_per_s2: site.gravity_u_m_per_s2().unwrap(),
        ..found(|values| values[6] = omega_g * LOCAL_G / G, [0.01, 0.01, 0.01, 0.01, 0.003, 0.003, 0.0013, 0.0013])
    };
    against_type(&measured, &GyroType::gvk_6()).parameters[6].clone()
}

/// Gravity at 0 m is out by 3.8e-3 m/s² there, in ω_g 0.0039 °/h/g. So a nominal gyro does not pass for certain, and one that
/// is out of tolerance does not either. With the height it is decided, rightly.
#[test]
fn an_unknown_height_leaves_drifts_undecided() {
    for omega_g in [10.0, 10.0115, 9.9885] {
        let row = at_holloman(HOLLOMAN, omega_g);
        assert!((row.deviation - (omega_g - 10.0) + 0.0039).abs() < 1e-4, "{row:?}");
        // 10 · 7.1e-3/9.8 = 0.00724, and the readings' 0.0013: 0.00736.
        assert!((row.expanded_uncertainty - 2.0 * 0.00736).abs() < 5e-5, "{row:?}");
        assert!(row.decision == Decision::Undecided && row.specific_risk.is_none(), "{row:?}");
        assert!(row.is_mostly_from_gravity());
    }
    let known = format!("{HOLLOMAN}height_m: 1225.0\n");
    let nominal = at_holloman(&known, 10.0);
    assert!(nominal.deviation.abs() < 1e-5 && nominal.guarded == Decision::Pass, "{nominal:?}");
    assert!(!nominal.is_mostly_from_gravity());
    let shipped = at_holloman(include_str!("../../sites/holloman-cigtf.yaml"), 10.0);
    assert!(shipped.deviation.abs() < 1e-4 && shipped.guarded == Decision::Pass, "{shipped:?}");
}

/// A standard uncertainty that is negative or no number, and degrees of freedom that are none, are refused by name.
#[test]
fn uncertainties_that_are_none_are_refused() {
    type Change = fn(&mut InputUncertainty);
    let cases: [(Change, &str); 5] = [
        (|u| u.angles_rad[3][1] = -1e-6, "certified angle is -0.000001"),
        (|u| u.level_rad = f64::NAN, "the level is NaN"),
        (|u| u.meter.gain = f64::INFINITY, "the gain of the meter is inf"),
        (|u| u.angles_degrees_of_freedom[0] = 0.0, "degrees of freedom of a certified angle are 0"),
        (|u| u.repeatability_degrees_of_freedom = f64::NAN, "degrees of freedom of the repeatability are NaN"),
    ];
    for (change, words) in cases {
        let mut uncertainty = InputUncertainty::of_meter(paper_meter());
        uncertainty.angles_rad = vec![[1e-6; 3]; 8];
        uncertainty.angles_degrees_of_freedom = vec![4.0; 8];
        change(&mut uncertainty);
        let refused = Setup::new(&eight([[0.0; 3]; 8]), EarthRate::at_astronomic_latitude(50.0), uncertainty);
        let said = refused.unwrap_err().to_string();
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn changes_since_an_earlier_result() {
    let earlier = found(|_| {}, SMALL);
    let now = found(|v| v[5] += 0.02, SMALL);
    let verdict = against_earlier(&now, &earlier, &GyroType::gvk_6());
    assert_eq!((verdict.parameters[5].guarded, verdict.overall), (Decision::Fail, Decision::Fail));
    assert!((verdict.parameters[5].expanded_uncertainty - 2.0 * 0.002 * 2.0_f64.sqrt()).abs() < 1e-12);
    assert!((change_in_uncertainties(&now, &earlier)[5] - 0.02 / (0.002 * 2.0_f64.sqrt())).abs() < 1e-9);
}

const STAND: &str = r#"format: "dtg-stand/1"
stand: {model: "SPS-2", serial: "0017"}
certificate: {number: "1", issued: "2026-11-02", laboratory: "x", repeatability_arcsec: 1.5, common_platform_arcsec: 0.8}
positions:
  - {i: 1, j: 1, theta_deg: 0, phi_deg: 0, alpha_arcsec: 12.4, beta_arcsec: -31.0, gamma_arcsec: 7.7, u_alpha_arcsec: 1.2, u_beta_arcsec: 1.3, u_gamma_arcsec: 2.0}
"#;

const SITE: &str = r#"format: "dtg-site/1"
id: "moscow"
latitude_deg: 55.7658
uncertainty: {latitude_arcsec: 1.0, azimuth_arcsec: 30.0, level_arcsec: 5.0}
"#;

/// What the files state is used, what they do not is named, what the laboratory measured replaces the site's.
#[test]
fn inputs_as_stated() {
    let stand = Stand::from_yaml("stand.yaml", STAND.as_bytes()).unwrap();
    let site = Site::from_yaml("moscow.yaml", SITE.as_bytes()).unwrap();
    let mut laboratory = Laboratory::paper();
    let (setup, missing) = Setup::stated(&stand.certificate, &stand.positions, &site, &laboratory).unwrap();
    let uncertainty = setup.uncertainty();
    let arcsec = radians_from_arcseconds;
    assert_eq!(uncertainty.angles_rad, [[1.2, 1.3, 2.0].map(arcsec)]);
    assert_eq!(uncertainty.repeatability_rad, arcsec(1.5));
    // Deflection unknown: 10″ beside the 1″ that the site states, each an input of its own.
    assert_eq!(uncertainty.latitude_rad, arcsec(1.0));
    assert_eq!(uncertainty.deflection_rad, arcsec(10.0));
    assert_eq!(uncertainty.azimuth_rad, arcsec(30.0));
    let words: Vec<&str> = missing.iter().map(|what| what.words()).collect();
    let [gain, offset] = ["gain of the meter (meter.gain_percent)", "offset of the meter (meter.offset_ma)"];
    assert_eq!(words, ["common part of the base (common_base_arcsec)", "gyro seat (seating_arcsec)", gain, offset]);
    laboratory.base = Some(dtg_passport::laboratory::Base { azimuth_arcsec: Some(10.0), level_arcsec: None });
    let (setup, missing) = Setup::stated(&stand.certificate, &stand.positions, &site, &laboratory).unwrap();
    assert_eq!(setup.uncertainty().azimuth_rad, arcsec(10.0));
    assert_eq!(setup.uncertainty().level_rad, arcsec(5.0));
    assert_eq!((setup.coefficients().positions.len(), missing.len()), (1, 4));
}

/// A stated part does not hide one that is missing: latitude and deflection, base and mark, g. A stated 0 counts as
/// missing.
#[test]
fn every_part_that_is_not_stated_is_named() {
    let stand = Stand::from_yaml("stand.yaml", STAND.as_bytes()).unwrap();
    let laboratory = Laboratory::paper();
    let missing = |site: &str| {
        let site = Site::from_yaml("moscow.yaml", site.as_bytes()).unwrap();
        let (_, missing) = Setup::stated(&stand.certificate, &stand.positions, &site, &laboratory).unwrap();
        missing
            .into_iter()
            .filter(|what| ![NotStated::Base, NotStated::Seat, NotStated::Gain, NotStated::Offset].contains(what))
            .map(NotStated::words)
            .collect::<Vec<_>>()
    };
    let mark = "azimuth_mark: {name: \"m\", latitude_deg: 55.776, longitude_deg: 37.6856, pillar_latitude_deg: 55.7658, \
                pillar_longitude_deg: 37.6856, position_u_m: 0.02}\n";
    let [latitude, deflection, azimuth, of_mark, gravity] = [
        "latitude (latitude_arcsec)",
        "deflection of the vertical (deflection_arcsec.u)",
        "azimuth of the base (azimuth_arcsec)",
        "azimuth of the mark (position_u_m, deflection_arcsec.u)",
        "gravity (gravity_u_m_per_s2)",
    ];
    assert!(missing(SITE).is_empty());
    assert_eq!(missing(&SITE.replace("latitude_arcsec: 1.0, ", "")), [latitude]);
    assert_eq!(missing(&SITE.replace("latitude_arcsec: 1.0, ", "latitude_arcsec: 0.0, ")), [latitude]);
    assert_eq!(missing(&format!("{SITE}deflection_arcsec: {{xi: 1.0, eta: 2.0}}\n")), [deflection]);
    assert_eq!(missing(&format!("{}{mark}", SITE.replace("azimuth_arcsec: 30.0, ", ""))), [azimuth]);
    assert_eq!(missing(&format!("{SITE}{}", mark.replace(", position_u_m: 0.02", ""))), [of_mark]);
    assert_eq!(missing(&format!("{SITE}gravity_m_per_s2: 9.8156\n")), [gravity]);
    assert!(missing(&SITE.replace("latitude_deg", "astronomic_latitude_deg")).is_empty());
}

/// Expected: both ends of a certified range belong to it, and nothing is said of what is not stated.
#[test]
fn a_temperature_outside_the_certified_range_is_told() {
    let stand = Stand::from_yaml("stand.yaml", STAND.as_bytes()).unwrap();
    let of = |here_c: Option<f64>, range: Option<[f64; 2]>| {
        let certificate = Certificate { temperature_range_c: range, ..stand.certificate.clone() };
        let subject = Subject { temperature_c: here_c, ..Subject::default() };
        let laboratory = Laboratory { temperature_c: here_c, ..Laboratory::paper() };
        let other = Laboratory { temperature_c: Some(99.0), ..Laboratory::paper() };
        let outside = TemperatureOutside::of(&certificate, &Subject::default(), Some(&laboratory));
        if here_c.is_some() {
            assert_eq!(TemperatureOutside::of(&certificate, &subject, Some(&other)), outside);
        }
        outside
    };
    for (here_c, range) in [(Some(18.0), Some([18.0, 22.0])), (Some(22.0), Some([18.0, 22.0])), (Some(30.0), None)] {
        assert_eq!(of(here_c, range), None);
    }
    assert_eq!(of(None, Some([18.0, 22.0])), None);
    for here_c in [17.5, 22.5] {
        let outside = of(Some(here_c), Some([18.0, 22.0]));
        assert_eq!(outside, Some(TemperatureOutside { here_c, low_c: 18.0, high_c: 22.0 }));
    }
    assert_eq!(
        of(Some(17.5), Some([18.0, 22.0])).unwrap().to_string(),
        "the temperature in the laboratory is 17.5 °C; the deviations are certified from 18 to 22 °C, and no uncertainty includes \
         the effect of this"
    );
}
