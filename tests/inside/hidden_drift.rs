//! Drift of one position that the seating of the platform hides: found in simulated histories of a stand.

use crate::coefficients::PositionIndex;
use crate::history::drift::{Drift, SUSPECTED, Series};
use crate::stand::Stand;
use crate::statistics::random::Stream;
use jiff::civil::Date;

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
