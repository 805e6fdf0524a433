//! What is wrong with readings is named, and nothing that is right: one reading, one position, a whole run.

use crate::inside::simulated_stands::{Truth, csv, header, normal, read};
use dtg_passport::certification::found::Found;
use dtg_passport::certification::kind::Kind;
use dtg_passport::certification::{AngleReadings, Certification, certify};
use dtg_passport::coefficients::PositionIndex;
use dtg_passport::statistics::random::Stream;
use nalgebra::Vector3;

/// Returns good readings with one angle of position `place` in run `run` (both from 0) moved by `off`.
fn with_one_off(good: &AngleReadings, (place, run, axis): (usize, usize, usize), off: f64) -> AngleReadings {
    let mut each = good.each_arcsec.clone();
    each[place][run][axis] += off;
    AngleReadings::new(good.runs.clone(), each).unwrap()
}

fn certified(readings: &AngleReadings) -> Certification {
    certify(&header(), readings).unwrap()
}

fn truth() -> Truth {
    Truth::new([1.5; 3], 2.0, 2.0)
}

const INDEX: PositionIndex = PositionIndex { i: 2, j: 3 };

/// Returns the finding on the reading of position (2, 3) in run 2, which comes first.
fn of_the_reading(found: &Certification) -> &Found {
    let first = found.findings.first().unwrap_or_else(|| panic!("{:?}", found.warnings));
    assert!(matches!(first.kind, Kind::Angle | Kind::Reading), "{:?}", found.warnings);
    assert_eq!((first.scope.position, first.scope.run), (Some(INDEX), Some(2)), "{:?}", found.warnings);
    first
}

/// One angle of one position in one of three or five runs is off by 45″. Expected: it is named with its line and not excluded,
/// the other positions state what they do without it, and the angle itself is within its interval (k = 2).
#[test]
fn one_reading_off_is_named_and_no_innocent() {
    let mut angles = 0;
    for seed in 0..10 {
        for runs in [3, 5] {
            let good = truth().measured(&mut Stream::new(seed), runs);
            // Position (2, 3), run 2, beta.
            let text = csv(&with_one_off(&good, (6, 1, 1), 45.0));
            let found = certified(&read(&text));
            let out = of_the_reading(&found);
            angles += u32::from(out.kind == Kind::Angle && out.scope.angle == Some("beta"));
            // Its own scatter and that of the others, of which the fit keeps a part: 1.5 √(1 + 1/2)/√0.75 = 2.1.
            assert!((out.size.unwrap() - 45.0).abs() < 9.0 && out.probability < 1e-3, "{out:?}");
            let line = text.lines().position(|line| line.starts_with("2,3,2,")).unwrap() + 1;
            let named = |words: &str| words.contains(&format!("(line {line} of the readings)"));
            assert!(named(&found.warnings[0]) && found.warnings[0].contains("not excluded"), "{}", found.warnings[0]);
            let mean = read(&text).each_arcsec[6].iter().map(|run| run.y).sum::<f64>() / runs as f64;
            // To four digits of its u.
            assert!((found.stand.positions[6].beta_arcsec - mean).abs() < 0.01, "{mean}");
            let good = certified(&good).stand.positions;
            for (place, (at, good)) in found.stand.positions.iter().zip(&good).enumerate() {
                let [u, without] = [at, good].map(|at| at.u_beta_arcsec.unwrap());
                match place {
                    6 => assert!((at.beta_arcsec - truth().angles_arcsec[6].y).abs() < 2.0 * u, "{at:?}"),
                    _ => assert!((0.5..2.0).contains(&(u / without)), "{seed} {place}: {u} {without}"),
                }
            }
        }
    }
    assert!(angles >= 17, "{angles} of 20 are named as one angle");
}

/// Two that are out hide one another from a test of the worst alone.
#[test]
fn two_readings_off_are_both_named() {
    let good = truth().measured(&mut Stream::new(3), 5);
    let found = certified(&with_one_off(&with_one_off(&good, (6, 1, 1), 45.0), (2, 0, 1), -45.0)).findings;
    let mut named: Vec<_> = found.iter().map(|at| (at.scope.position.unwrap(), at.scope.run, at.scope.angle)).collect();
    named.sort_unstable();
    let [one, other] = [(PositionIndex { i: 1, j: 3 }, Some(1), Some("beta")), (INDEX, Some(2), Some("beta"))];
    assert_eq!(named, [one, other]);
}

/// Two runs are as far from one another as each from the other.
#[test]
fn two_runs_do_not_tell_which_is_off() {
    let good = truth().measured(&mut Stream::new(4), 2);
    let found = certified(&with_one_off(&good, (6, 1, 1), 60.0));
    let named: Vec<_> = found.findings.iter().map(|at| (at.scope.position, at.scope.runs.clone())).collect();
    assert!(named.contains(&(Some(INDEX), vec![1, 2])), "{named:?}");
    assert!(found.warnings.iter().any(|words| words.contains("Two runs do not show whether")), "{:?}", found.warnings);
}

/// A position all of whose readings scatter is named as a position, and the others keep their own scatter.
#[test]
fn a_worse_position_is_not_a_worse_reading() {
    let mut stream = Stream::new(5);
    let good = truth().measured(&mut stream, 5);
    let mut each = good.each_arcsec.clone();
    each[6].iter_mut().for_each(|run| *run += normal(&mut stream, [15.0; 3]));
    let found = certified(&AngleReadings::new(good.runs.clone(), each).unwrap());
    let first = &found.findings[0];
    assert_eq!((first.kind, first.scope.position), (Kind::PositionScatter, Some(INDEX)), "{:?}", found.warnings);
    let u = |place: usize| found.stand.positions[place].u_alpha_arcsec.unwrap();
    assert!(
        u(6) > 4.0 && (0..8).filter(|place| *place != 6).all(|place| u(place) < 1.2),
        "{:?}",
        found.stand.positions
    );
}

/// A position that is better than the others makes none of them worse.
#[test]
fn a_better_position_accuses_nobody() {
    let mut stream = Stream::new(6);
    let mut each = truth().measured(&mut stream, 6).each_arcsec.clone();
    let mean = each[0].iter().sum::<Vector3<f64>>() / 6.0;
    let runs: Vec<Vector3<f64>> =
        (0..6).map(|run| (1..8).map(|at| each[at][run]).sum::<Vector3<f64>>() / 7.0).collect();
    let shared = runs.iter().sum::<Vector3<f64>>() / 6.0;
    each[0] = runs.iter().map(|run| mean + run - shared).collect();
    let found = certified(&AngleReadings::new((1..=6).collect(), each).unwrap()).warnings;
    assert!(!found.iter().any(|words| words.contains("osition")), "{found:?}");
}

/// A copy that was turned as a whole has other angles, and scatters as no other run does: not at all.
#[test]
fn a_shifted_copy_is_named() {
    let good = truth().measured(&mut Stream::new(7), 3);
    let each: Vec<Vec<_>> = good
        .each_arcsec
        .iter()
        .map(|runs| runs.iter().copied().chain([runs[0] + Vector3::new(0.5, -0.25, 1.0)]).collect())
        .collect();
    let found = certified(&AngleReadings::new(vec![1, 2, 3, 4], each).unwrap());
    assert!(
        found.findings.iter().any(|at| at.kind == Kind::RunsCopied && at.scope.runs == [1, 4]),
        "{:?}",
        found.warnings
    );
}

/// A gross reading is refused with its own line, and with no line of a run that is good.
#[test]
fn a_gross_reading_does_not_accuse_the_good_ones() {
    for runs in [3, 4, 5] {
        let good = truth().measured(&mut Stream::new(8), runs);
        for off in [1200.0, -1200.0] {
            let text = csv(&with_one_off(&good, (3, 1, 2), off));
            let line = text.lines().position(|line| line.starts_with("1,4,2,")).unwrap() + 1;
            let refused =
                AngleReadings::from_csv("a.csv", text.as_bytes(), &header().positions).unwrap_err().to_string();
            assert!(refused.contains(&format!("a.csv:{line}:")) && refused.contains("gamma_arcsec"), "{refused}");
            assert_eq!(refused.matches("a.csv:").count(), 1, "{refused}");
        }
    }
}
