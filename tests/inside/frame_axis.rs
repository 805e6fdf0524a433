//! A stand whose frame axis points to another azimuth than the paper's east: against 60-digit reference values
//! (tests/vectors/frame_axis.py), and through passport, verification, re-issue and calibration.

use crate::inside::programs;
use crate::inside::reference::*;
use dtg_passport::attitude::Deviation;
use dtg_passport::calibration::sensitivity::VectorChange;
use dtg_passport::calibration::{InputUncertainty, Method, Model, Options, Setup, analytic, calibrate, least_squares};
use dtg_passport::coefficients::{Coefficients, EarthRate, Position, PositionIndex, StandGeometry, pair_differences};
use dtg_passport::units::radians_from_arcseconds;
use nalgebra::{Matrix2, Vector2, Vector3};
use serde_json::Value;

/// Largest difference from the reference, in units of the largest value of its kind.
const LIMIT: f64 = 1e-13;

/// The parameters of the gyro of the reference, which is also that of self-checks.
const REFERENCE_GYRO: [f64; 8] = [95.0, 9.3, -8.7, 93.0, 20.0, -15.0, 10.0, -7.0];

fn cases() -> Vec<Value> {
    let reference: Value = serde_json::from_str(include_str!("../vectors/frame_axis.json")).unwrap();
    let cases = reference["cases"].as_array().unwrap().clone();
    assert_eq!(cases.len(), 4);
    cases
}

fn earth(case: &Value) -> EarthRate {
    let frame_axis_azimuth_deg = case["frame_axis_azimuth_deg"].as_f64().unwrap();
    EarthRate { frame_axis_azimuth_deg, ..EarthRate::at_astronomic_latitude(case["latitude_deg"].as_f64().unwrap()) }
}

fn positions(case: &Value) -> Vec<Position> {
    let integer = |value: &Value| u32::try_from(value.as_u64().unwrap()).unwrap();
    let each = case["positions"].as_array().unwrap().iter().map(|at| {
        let angles = numbers(&at["deviations_arcsec"]);
        let [alpha_rad, beta_rad, gamma_rad] = [angles[0], angles[1], angles[2]].map(radians_from_arcseconds);
        Position {
            index: PositionIndex { i: integer(&at["i"]), j: integer(&at["j"]) },
            theta_deg: at["theta_deg"].as_f64().unwrap(),
            phi_deg: at["phi_deg"].as_f64().unwrap(),
            deviation: Deviation { alpha_rad, beta_rad, gamma_rad },
        }
    });
    each.collect()
}

fn setup_of(case: &Value) -> Setup {
    Setup::new(&positions(case), earth(case), InputUncertainty::of_meter(paper_meter())).unwrap()
}

fn pair(value: &Value) -> Vector2<f64> {
    let found = numbers(value);
    Vector2::new(found[0], found[1])
}

fn each(case: &Value, key: &str) -> Vec<Vector2<f64>> {
    case["positions"].as_array().unwrap().iter().map(|at| pair(&at[key])).collect()
}

#[test]
fn the_vectors_are_those_of_their_program() {
    let file = std::env::temp_dir().join(format!("frame-axis-{}.json", std::process::id()));
    let mut python = programs::python();
    python.arg(programs::project("tests/vectors/frame_axis.py")).arg(&file);
    programs::output(python);
    let written = std::fs::read_to_string(&file).unwrap();
    std::fs::remove_file(&file).unwrap();
    assert!(written == include_str!("../vectors/frame_axis.json"), "run tests/vectors/frame_axis.py");
}

#[test]
fn specific_force_and_earth_rate_are_those_of_the_reference() {
    let mut worst: f64 = 0.0;
    for case in cases() {
        let found = setup_of(&case);
        let lines = case["positions"].as_array().unwrap();
        for (at, line) in found.coefficients().positions.iter().zip(lines) {
            let rate = (at.earth_rate_deg_per_h - pair(&line["omega_deg_per_h"])).abs().max() / 15.0;
            let force = (at.specific_force_g - pair(&line["n"])).abs().max();
            let along_z = (at.specific_force_z_g - line["n_z"].as_f64().unwrap()).abs();
            worst = worst.max(rate).max(force).max(along_z);
        }
    }
    println!("largest error of specific force and Earth rate at other azimuths: {worst:.1e}");
    assert!(worst < LIMIT, "{worst:e}");
}

/// Expected: Δ, B, C by their definitions (paper, under eq. (13) and (15)) from the reference's n and ω_3.
#[test]
fn the_matrices_are_those_of_the_reference() {
    let mut compared = 0;
    for case in cases() {
        let Some(found) = setup_of(&case).coefficients().matrices else { continue };
        let (n, omega) = (each(&case, "n"), each(&case, "omega_deg_per_h"));
        let (n1, n2) = pair_differences(|position| n[position]);
        let (omega1, omega2) = pair_differences(|position| omega[position]);
        let inverse = n2.try_inverse().unwrap();
        let expected = [
            (found.delta, inverse * n1),
            (found.b_deg_per_h, omega1 - omega2 * inverse * n1),
            (found.c_deg_per_h_per_g, omega2 * inverse),
            (found.omega1_deg_per_h, omega1),
            (found.omega2_deg_per_h, omega2),
        ];
        for (found, expected) in expected {
            let error = (found - expected).abs().max() / expected.abs().max();
            assert!(error < LIMIT, "{found} {expected}");
        }
        compared += 1;
    }
    assert_eq!(compared, 2, "two cases have the paper's eight positions");
}

/// Expected: numerical derivatives of the reference, with the base rotated about east, north and up, from the right of
/// Rz(90° − azimuth), and the latitude changed.
#[test]
fn errors_of_the_base_are_about_east_north_and_up() {
    for case in cases() {
        let setup = setup_of(&case);
        for (place, line) in case["positions"].as_array().unwrap().iter().enumerate() {
            let changes = &line["changes_east_north_up_latitude"];
            let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
            let of_base = axes.iter().map(|axis| setup.base_turned(place, axis));
            let found: Vec<VectorChange> = of_base.chain([setup.latitude_changed(place)]).collect();
            let found = found.iter().flat_map(|change| [change.earth_rate_deg_per_h.xy(), change.vertical.xy()]);
            let (found, expected): (Vec<_>, _) = (found.flat_map(<[f64; 2]>::from).collect(), numbers(changes));
            assert_eq!(found.len(), expected.len());
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((found - expected).abs() < 15.0 * LIMIT, "{found} {expected}");
            }
        }
    }
}

/// Expected: the gyro of the reference, from its currents, to 1e-10 of each parameter, by every method that applies.
#[test]
fn exact_currents_give_the_gyro_back_at_any_azimuth() {
    let mut worst: f64 = 0.0;
    for case in cases() {
        let setup = setup_of(&case);
        let currents = each(&case, "currents_ma");
        let readings = readings(&setup, &currents);
        let methods = vec![Method::Analytic, Method::LeastSquares];
        let found = calibrate(&setup, &readings, &Options { methods, ..Options::default() }).unwrap();
        let applicable = if setup.coefficients().matrices.is_some() { 2 } else { 1 };
        assert_eq!(found.results.len(), applicable, "{:?}", found.refused);
        for result in found.results {
            for (found, expected) in result.parameters.to_vector().into_iter().zip(REFERENCE_GYRO) {
                worst = worst.max((found / expected - 1.0).abs());
            }
        }
    }
    println!("largest relative error of a parameter at other azimuths: {worst:.1e}");
    assert!(worst < 1e-10, "{worst:e}");
}

/// Passports of turned bases; they need the factory.
#[cfg(feature = "factory")]
mod passports {
    use crate::inside::{fixtures, written};
    use dtg_passport::calibration::{Method, Options, Readings, Setup, calibrate};
    use dtg_passport::coefficients::PositionIndex;
    use dtg_passport::laboratory::Laboratory;
    use dtg_passport::passport::checks::Code;
    use dtg_passport::passport::reissue::{Reissue, changes};
    use dtg_passport::passport::{Content, Verification, reissue, verify};
    use dtg_passport::site::Site;
    use dtg_passport::stand::{CertifiedPosition, Stand};
    use dtg_passport::trust::SigningKey;
    use nalgebra::Vector2;

    /// The site of the fixtures with its frame's axis at an azimuth.
    fn site_at(azimuth_deg: f64) -> Site {
        Site { frame_axis_azimuth_deg: Some(azimuth_deg), ..fixtures::site(fixtures::SITE) }
    }

    /// A stand with positions at θ = 90° and 270° alone: those of the fixtures at 90°, and copies of them at 270°.
    fn turned_stand() -> Stand {
        let mut stand = fixtures::stand(fixtures::ARC_MINUTES);
        stand.positions.retain(|at| at.i == 2);
        let further: Vec<CertifiedPosition> =
            stand.positions.iter().map(|at| CertifiedPosition { i: 4, theta_deg: 270.0, ..at.clone() }).collect();
        stand.positions.extend(further);
        stand
    }

    fn asked(content: &Content, key: &SigningKey) -> Verification {
        verify("turned.yaml", written(content, key).as_bytes(), &fixtures::trust(key), &fixtures::question())
    }

    #[test]
    fn a_stated_90_gives_the_same_bits_as_none() {
        for stand in [fixtures::ARC_MINUTES, fixtures::DEGREES] {
            let stand = fixtures::stand(stand);
            let [absent, stated] =
                [fixtures::site(fixtures::SITE), site_at(90.0)].map(|site| fixtures::drafted(&stand, &site, 1));
            let numbers = |content: &Content| {
                let Content { earth, matrices, vectors, self_check, .. } = content.clone();
                (earth, matrices, vectors, self_check)
            };
            assert_eq!(numbers(absent.content()), numbers(stated.content()));
            let line = "  frame_axis_azimuth_deg: 90.0\n";
            assert_eq!(stated.payload().replacen(line, "", 1), absent.payload());
        }
    }

    #[test]
    fn a_passport_follows_the_azimuth_of_its_site() {
        let key = SigningKey::generate().unwrap();
        let stand = fixtures::stand(fixtures::DEGREES);
        let east = fixtures::content(&stand, &fixtures::site(fixtures::SITE));
        let north = fixtures::content(&stand, &site_at(0.0));
        let (before, after) = (east.matrices.clone().unwrap(), north.matrices.clone().unwrap());
        assert_eq!((before.delta, before.n2_inverse), (after.delta, after.n2_inverse));
        assert_ne!(before.b_deg_per_h, after.b_deg_per_h);
        assert_ne!(before.c_deg_per_h_per_g, after.c_deg_per_h_per_g);
        assert_eq!(east.earth, north.earth);
        for content in [&east, &north] {
            let verification = asked(content, &key);
            assert!(verification.valid(), "{:?}", verification.checks());
        }
        // The azimuth of another set-up does not go with these numbers.
        for (content, azimuth_deg) in [(&north, None), (&north, Some(1e-9)), (&east, Some(89.0))] {
            let mut wrong = content.clone();
            wrong.site.frame_axis_azimuth_deg = azimuth_deg;
            let verification = asked(&wrong, &key);
            let failed = verification.checks().iter().find(|check| check.passed() == Some(false)).unwrap();
            assert_eq!(failed.code, Code::WrongNumber, "{azimuth_deg:?}: {}", failed.detail);
        }
        let mut beyond = north.clone();
        beyond.site.frame_axis_azimuth_deg = Some(360.0);
        assert!(!asked(&beyond, &key).valid());
    }

    /// Expected: without the positions at θ = 0° there are no matrices and the passport says so; its self-check is one for
    /// least squares, which gives the reference gyro back.
    #[test]
    fn positions_at_90_and_270_alone_have_a_self_check_and_no_matrices() {
        let (stand, site) = (turned_stand(), site_at(0.0));
        let draft = fixtures::drafted(&stand, &site, 1);
        let content = draft.content();
        assert_eq!(content.matrices, None);
        let words = "Some of the eight standard positions are not certified; there are no matrices, and only least";
        assert!(draft.remarks().absences().iter().any(|sentence| sentence.starts_with(words)));
        assert!(draft.payload().contains("# Axes: base xi (axis of the frame) at the azimuth 0.0 deg, clockwise"));
        assert!(!draft.payload().contains("base xi east"));
        let check = content.self_check.as_ref().expect("the positions determine the parameters");
        let (certificate, laboratory) = (&stand.certificate, Laboratory::paper());
        let (setup, _) = Setup::stated(certificate, &stand.positions, &site, &laboratory).unwrap();
        let each: Vec<_> = check
            .currents
            .iter()
            .map(|at| (PositionIndex { i: at.i, j: at.j }, Vector2::new(at.jx_ma, at.jy_ma)))
            .collect();
        let readings = Readings::new(setup.coefficients(), &each).unwrap();
        let options = Options { methods: vec![Method::LeastSquares], ..Options::default() };
        let found = calibrate(&setup, &readings, &options).unwrap().results.remove(0).parameters.to_vector();
        for (found, expected) in found.into_iter().zip(super::REFERENCE_GYRO) {
            assert!((found / expected - 1.0).abs() < 1e-10, "{found} {expected}");
        }
        let key = SigningKey::generate().unwrap();
        assert!(asked(content, &key).valid());
    }

    #[test]
    fn a_reissue_after_the_base_was_turned_says_so() {
        let key = SigningKey::generate().unwrap();
        let stand = fixtures::stand(fixtures::ARC_MINUTES);
        let old = fixtures::content(&stand, &fixtures::site(fixtures::SITE));
        assert!(changes(&old, &stand, &site_at(0.0), fixtures::ISSUER).contains("frame_axis_azimuth_deg nothing -> 0"));
        let text = written(&old, &key);
        let order = Reissue {
            site: Some(site_at(0.0)),
            ..Reissue::new(fixtures::ISSUER, fixtures::issued_plus(60), "the base was turned to the north")
        };
        let successor = reissue::successor(text.as_bytes(), &asked(&old, &key), &order).unwrap();
        let new = successor.draft(2).unwrap().content().clone();
        assert_eq!(new.matrices, fixtures::content(&stand, &site_at(0.0)).matrices);
        // From the passport alone, without files: the azimuth comes along.
        let kept = Reissue { site: None, issued_at: fixtures::issued_plus(120), ..order };
        let text = written(&new, &key);
        let successor = reissue::successor(text.as_bytes(), &asked(&new, &key), &kept).unwrap();
        assert_eq!(successor.draft(3).unwrap().content().vectors, new.vectors);
    }
}

/// Expected: at azimuth ψ the base's ξ points to (sin ψ, cos ψ) east and north, so Rz(90° − ψ) has that as its first row.
#[test]
fn the_axis_points_to_its_azimuth() {
    for azimuth_deg in [0.0, 30.0, 90.0, 200.0, 359.0] {
        let base = dtg_passport::attitude::base(azimuth_deg);
        let (sin, cos) = libm::sincos(azimuth_deg.to_radians());
        assert!((base.row(0).transpose() - Vector3::new(sin, cos, 0.0)).abs().max() < 1e-15);
        assert_eq!(base.row(2).transpose(), Vector3::z());
        assert!((base.determinant() - 1.0).abs() < 1e-15);
    }
    assert_eq!(dtg_passport::attitude::base(90.0), nalgebra::Matrix3::identity());
    let north = dtg_passport::attitude::base(0.0);
    assert_eq!(north.fixed_view::<2, 2>(0, 0), Matrix2::new(0.0, 1.0, -1.0, 0.0));
}

/// Expected: at the paper's azimuth the very bits of the equations without a rotation of the base.
#[test]
fn an_axis_that_points_east_changes_no_bit() {
    for case in cases() {
        let positions = positions(&case);
        let plain = EarthRate::at_astronomic_latitude(case["latitude_deg"].as_f64().unwrap());
        assert_eq!(plain.frame_axis_azimuth_deg, 90.0);
        let found = StandGeometry::new(&positions).unwrap().at(plain);
        for (at, position) in found.positions.iter().zip(&positions) {
            let attitude = dtg_passport::attitude::actual(position.theta_deg, position.phi_deg, &position.deviation);
            let (h, v) = (plain.horizontal_deg_per_h, plain.vertical_deg_per_h);
            let omega = [attitude.m12 * h + attitude.m13 * v, attitude.m22 * h + attitude.m23 * v];
            assert_eq!(<[f64; 2]>::from(at.earth_rate_deg_per_h), omega);
            assert_eq!(<[f64; 2]>::from(at.specific_force_g), [attitude.m13, attitude.m23]);
        }
    }
}

/// Expected: with exact currents, any azimuth from 0° to 360° gives the gyro back, by both closed and least-squares
/// methods, on ideal stands and those of the reference.
#[test]
fn any_azimuth_is_as_good_as_another_for_exact_currents() {
    let stand = eight([[0.02, -0.03, 0.01]; 8]);
    let gyro = gvk_6();
    for step in 0..72 {
        let frame_axis_azimuth_deg = 5.0 * f64::from(step);
        let earth = EarthRate { frame_axis_azimuth_deg, ..EarthRate::at_astronomic_latitude(LATITUDE_DEG) };
        let at: Coefficients = StandGeometry::new(&stand).unwrap().at(earth);
        let currents: Vec<_> = at.positions.iter().map(|position| gyro.currents_ma(position).unwrap()).collect();
        let closed = analytic::solve(&at, &currents).unwrap().parameters;
        let fitted = least_squares::solve(&at, &currents, &paper_meter(), Model::Paper).unwrap();
        for found in [closed, fitted] {
            for (found, expected) in found.to_vector().into_iter().zip(gyro.to_vector()) {
                assert!((found / expected - 1.0).abs() < 1e-10, "{frame_axis_azimuth_deg}: {found} {expected}");
            }
        }
    }
}
