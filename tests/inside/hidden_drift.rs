//! Drift of one position that the seating of the platform hides: found in simulated histories of a stand.

use crate::certification::found::Found;
use crate::certification::kind::Kind;
use crate::coefficients::PositionIndex;
use crate::history::drift::{Drift, SUSPECTED, Series};
use crate::inside::simulated_stands::{Truth, angles, certified, turn};
use crate::report::history::findings;
use crate::stand::{Evidence, Stand};
use crate::statistics::random::Stream;
use jiff::civil::Date;
use nalgebra::Vector3;

const DATES: [&str; 5] = ["2020-02-29", "2021-03-01", "2022-06-15", "2023-12-31", "2026-01-10"];
const OWN_ARCSEC: f64 = 0.5;
const COMMON_ARCSEC: f64 = 10.0;

/// Five certificates of a stand whose platform is seated anew for each, and γ of (2, 3) drifts.
fn history(seed: u64, arcsec_per_year: f64) -> Drift {
    let mut stream = Stream::new(seed);
    let file = include_bytes!("../../passports/SPS-2/0017/stand.yaml");
    let stands = DATES.map(|date| {
        let mut stand = Stand::from_yaml("stand", file).unwrap();
        stand.certificate.number = date.to_owned();
        stand.certificate.performed = Some(date.parse().unwrap());
        stand.certificate.common_platform_arcsec = Some(COMMON_ARCSEC);
        (stand.certificate.common_base_arcsec, stand.certificate.type_b) = (Some(0.0), None);
        let since = |date: &str| date.parse::<Date>().unwrap().since(DATES[0].parse::<Date>().unwrap()).unwrap();
        let years = f64::from(since(date).get_days()) / 365.25;
        // A small turn of the platform changes α, β and γ of every position alike.
        let seated = [0; 3].map(|_| COMMON_ARCSEC * stream.normal());
        for at in &mut stand.positions {
            let mut drawn = || OWN_ARCSEC * stream.normal();
            at.alpha_arcsec += seated[0] + drawn();
            at.beta_arcsec += seated[1] + drawn();
            at.gamma_arcsec += seated[2] + drawn();
            if (at.i, at.j) == (2, 3) {
                at.gamma_arcsec += arcsec_per_year * years;
            }
            let u = Some(OWN_ARCSEC);
            (at.u_alpha_arcsec, at.u_beta_arcsec, at.u_gamma_arcsec) = (u, u, u);
            at.degrees_of_freedom = None;
        }
        stand
    });
    Drift::of(&stands.each_ref())
}

/// Expected: 3 arcsec a year are found in every history, as those of γ of (2, 3), with the uncertainty of a line through
/// five values of u = 0.5 √(8/7) relative to the mean of the other seven: about 0.11 arcsec a year.
#[test]
fn a_drift_that_the_seating_hides_is_found() {
    let mut hidden = 0;
    for seed in 0..20 {
        let found = history(seed, 3.0);
        let Some(worst) = found.hidden_change() else {
            // By chance the seating changed in the same direction.
            assert!(found.series.iter().any(Series::is_drift), "seed {seed}");
            continue;
        };
        hidden += 1;
        let line = worst.line.unwrap();
        assert_eq!((worst.index, worst.angle), (PositionIndex { i: 2, j: 3 }, 2));
        assert_eq!(found.drifts(), Some(true));
        assert!((0.10..0.13).contains(&line.u_slope), "{}", line.u_slope);
        assert!((line.slope - 3.0).abs() < 4.0 * line.u_slope, "{}", line.slope);
    }
    assert!(hidden >= 15, "{hidden}");
}

/// Expected: without a drift, at most one history in twenty is suspected (Holm); 200 histories have a standard deviation
/// of 1.5 %.
#[test]
fn the_seating_alone_is_no_drift() {
    let suspected = |seed| {
        let found = history(seed, 0.0);
        let least = found.relative.iter().filter_map(|at| at.corrected_probability).fold(1.0, f64::min);
        least < SUSPECTED || found.relative.iter().any(|at| at.jump.is_some())
    };
    let count = (0..200).filter(|seed| suspected(*seed)).count();
    assert!(count <= 20, "{count} of 200");
}

/// Three certificates of a stand whose mirror is mounted anew before the second one, turned by two minutes of arc, and of
/// which one position may have moved as well.
fn remounted(seed: u64, by: Vector3<f64>, moved_arcsec: f64) -> Drift {
    let mut stream = Stream::new(seed);
    let mut truth = Truth::new([1.0; 3], 1.0, 1.0);
    let stands = ["2023-01-10", "2024-01-10", "2025-01-10"].map(|date| {
        if date == "2024-01-10" {
            truth.angles_arcsec = truth.angles_arcsec.map(|at| angles(&(turn(by) * turn(at))));
            truth.angles_arcsec[6].z += moved_arcsec;
        }
        let mut stand = certified(&truth, &mut stream, 5).stand;
        stand.certificate.number = date.to_owned();
        stand.certificate.performed = Some(date.parse().unwrap());
        stand.certificate.evidence = Some(Evidence { readings_sha256: "0".repeat(64), runs: 5, excluded: None });
        stand
    });
    Drift::of(&stands.each_ref())
}

/// Expected: a mirror that was mounted anew is one rotation of all positions between the two certificates, within four standard
/// deviations of what was set (√2 × 1.2″ / √5 about each axis), and no position has moved; one that moved as well is named
/// beside it, and by itself. Without either, at most one history in fifty has a rotation.
#[test]
fn a_remounted_mirror_is_one_rotation() {
    let by = Vector3::new(120.0, -90.0, 60.0);
    for seed in 0..10 {
        let found = remounted(seed, by, 0.0);
        let [common] = &found.common[..] else { panic!("{seed}: {:?}", found.common) };
        assert_eq!(common.certificates, ["2023-01-10", "2024-01-10"]);
        assert!((Vector3::from(common.turn.platform_arcsec) - by).amax() < 4.0, "{common:?}");
        // Some may be suspected by chance.
        let findings = |found: &Drift| findings(found).into_iter().filter(Found::accuses).collect::<Vec<_>>();
        let kinds: Vec<Kind> = findings(&found).iter().map(|found| found.kind).collect();
        assert_eq!(kinds, [Kind::CommonTurn], "{seed}");
        assert!(found.has_changed() && found.jumps().count() == 0);
        // The certified deviations are stated as they are.
        assert!(found.series.iter().any(|at| (at.values[1].arcsec - at.values[0].arcsec).abs() > 50.0));
        for by in [by, Vector3::zeros()] {
            let found = findings(&remounted(seed, by, 60.0));
            let moved: Vec<_> = found.iter().filter(|found| found.kind == Kind::PositionJump).collect();
            assert_eq!(moved.len(), 1, "{seed}: {found:?}");
            assert_eq!(moved[0].scope.position, Some(PositionIndex { i: 2, j: 3 }));
            assert_eq!(moved[0].scope.certificates, ["2023-01-10", "2024-01-10"]);
            assert_eq!(found.len(), if by == Vector3::zeros() { 1 } else { 2 }, "{seed}: {found:?}");
        }
    }
    let turned = (0..100).filter(|seed| !remounted(*seed, Vector3::zeros(), 0.0).common.is_empty()).count();
    assert!(turned <= 4, "{turned}");
}
