//! A run that is rotated as a whole is named, whatever else is right or wrong in it; good runs are not.

use crate::inside::simulated_stands::{Truth, header, normal};
use dtg_passport::certification::comparison::{Comparison, compare};
use dtg_passport::certification::rotated_runs::{Pattern, RotatedRuns, most_suspect};
use dtg_passport::certification::{AngleReadings, Certification, certify};
use dtg_passport::coefficients::EIGHT_POSITIONS;
use dtg_passport::stand::{Evidence, Stand};
use dtg_passport::statistics::random::Stream;
use nalgebra::Vector3;

fn truth() -> Truth {
    Truth::new([1.5; 3], 2.0, 1.0)
}

/// Returns readings of which the run at place `bumped` is rotated exactly, about the axes of the platform and of the base,
/// and whose rotations from run to run have standard deviations of their own about each axis.
pub(super) fn measured(
    truth: &Truth,
    stream: &mut Stream,
    runs: usize,
    of_runs: ([f64; 3], [f64; 3]),
    bumped: Option<(usize, [f64; 3], [f64; 3])>,
) -> AngleReadings {
    let at = bumped.map_or(runs, |(at, ..)| at);
    let [platform, base] = bumped.map_or([[0.0; 3]; 2], |(_, platform, base)| [platform, base]).map(Vector3::from);
    in_order(truth, stream, runs, of_runs, |run| if run == at { [platform, base] } else { [Vector3::zeros(); 2] })
}

/// Returns readings whose runs are rotated as `rotation` says for each, about the axes of the platform and of the base.
fn in_order(
    truth: &Truth,
    stream: &mut Stream,
    runs: usize,
    of_runs: ([f64; 3], [f64; 3]),
    rotation: impl Fn(usize) -> [Vector3<f64>; 2],
) -> AngleReadings {
    let mut each = vec![Vec::new(); 8];
    for run in 0..runs {
        let (mut platform, mut base) = (normal(stream, of_runs.0), normal(stream, of_runs.1));
        let [of_platform, of_base] = rotation(run);
        platform += of_platform;
        base += of_base;
        for (place, (_, theta, phi)) in EIGHT_POSITIONS.iter().enumerate() {
            let own = normal(stream, truth.own);
            each[place].push(truth.read(place, *theta, *phi, platform + own, base));
        }
    }
    AngleReadings::new((1..=runs as u32).collect(), each).unwrap()
}

pub(super) const USUAL: ([f64; 3], [f64; 3]) = ([2.0; 3], [1.0; 3]);

pub(super) fn found(readings: &AngleReadings) -> Certification {
    certify(&header(), readings).unwrap()
}

fn runs_of(found: &[RotatedRuns]) -> Vec<(u32, usize)> {
    found.iter().filter_map(|at| Some((at.run()?, at.axis.0))).collect()
}

/// Expected by hand: rotations of five runs about x of the platform 0, 2, 1, 3, 104, and none about the other axes. The
/// last is 102.5 from the mean of the others, 20.5 of it in the mean of all. Their variance is 5/3, so Student's t is
/// 102.5/√(5/3 · 5/4) = 71.01 with 3 degrees of freedom: P(|t| > 71.01) = 6.1536e-6 (SciPy, 2 stats.t.sf(71.014, 3)),
/// times 2 groups of axes
/// and 8 patterns: 5 runs, 2 moves with two runs or more on each side, and a drift.
#[test]
fn one_run_by_hand() {
    let quiet = Truth { angles_arcsec: [Vector3::zeros(); 8], ..Truth::new([1e-4; 3], 0.0, 0.0) };
    let measured = quiet.measured(&mut Stream::new(1), 5);
    let mut each = measured.each_arcsec.clone();
    each.iter_mut().for_each(|runs| runs.iter_mut().zip([0.0, 2.0, 1.0, 3.0, 104.0]).for_each(|(at, x)| at.x += x));
    let found = found(&AngleReadings::new(vec![1, 2, 3, 4, 5], each).unwrap());
    let [at] = found.rotated_runs[..] else { panic!("{:?}", found.rotated_runs) };
    assert_eq!((at.run(), at.axis.0), (Some(5), 0));
    assert!((at.turn_arcsec() - 102.5).abs() < 1e-3 && (at.in_the_mean_arcsec()[0] - 20.5).abs() < 1e-3, "{at:?}");
    assert!((at.probability / 9.8458e-5 - 1.0).abs() < 0.01, "{at:?}");
    let words = &found.warnings[0];
    assert!(
        ["102″, ", "103″, "]
            .iter()
            .any(|x| words.starts_with(&format!("Outlier: all positions of run 5 are rotated by {x}")))
            && words.contains("″ about x, y, z of the platform relative")
            && ["20″", "21″"].iter().any(|effect| words.contains(&format!("by up to {effect}")))
            && words.contains("--exclude 5"),
        "{words}"
    );
}

/// Expected by hand: rotations about x of 0, 2, 1, 3, 6. The last is 4.5 from the mean of the others, t = 4.5/√(5/3 · 5/4) =
/// 3.1177 with 3 degrees of freedom, P(|t| > 3.1177) = 0.052566, times 16 as above.
#[test]
fn the_most_suspect_run_by_hand() {
    let quiet = Truth { angles_arcsec: [Vector3::zeros(); 8], ..Truth::new([1e-4; 3], 0.0, 0.0) };
    let mut each = quiet.measured(&mut Stream::new(1), 5).each_arcsec;
    each.iter_mut().for_each(|runs| runs.iter_mut().zip([0.0, 2.0, 1.0, 3.0, 6.0]).for_each(|(at, x)| at.x += x));
    let found = found(&AngleReadings::new(vec![1, 2, 3, 4, 5], each).unwrap());
    assert_eq!(found.rotated_runs, []);
    let at = most_suspect(&found.components, &[], &[], false).unwrap();
    assert_eq!((at.run(), at.axis.0), (Some(5), 0));
    assert!((at.turn_arcsec() - 4.5).abs() < 1e-3 && (at.probability / 0.841_053 - 1.0).abs() < 1e-3, "{at:?}");
}

/// All α of one run of five wrong by 300″; the level of the base by 120″; one run of three.
#[test]
fn a_bumped_run_is_named() {
    for seed in 0..20 {
        let of = |runs, platform, base| {
            let mut stream = Stream::new(seed);
            found(&measured(&truth(), &mut stream, runs, USUAL, Some((2, platform, base)))).rotated_runs
        };
        let platform = of(5, [300.0, 0.0, 0.0], [0.0; 3]);
        assert_eq!(runs_of(&platform), [(3, 0)], "{platform:?}");
        // u of a difference of one run from four: √((2² + 1.5²/8) · 5/4), about 2.4; a second-order effect of deviations
        // of a degree, 300″ · 0.02, adds to it.
        assert!((platform[0].turn_arcsec() - 300.0).abs() < 16.0, "{platform:?}");
        assert_eq!(platform[0].in_the_mean_arcsec()[0], platform[0].turn_arcsec() / 5.0);
        assert_eq!(runs_of(&of(5, [0.0; 3], [120.0, 0.0, 0.0])), [(3, 3)]);
        assert_eq!(runs_of(&of(5, [0.0; 3], [0.0, 0.0, -120.0])), [(3, 5)]);
        assert_eq!(runs_of(&of(4, [0.0, 80.0, 0.0], [0.0; 3])), [(3, 1)]);
    }
}

/// A single wrong reading is not a wrong run, and a run with a wrong reading can still be a wrong run.
#[test]
fn a_wrong_reading_is_not_a_wrong_run() {
    let (mut named, mut others) = (0, 0);
    for seed in 0..100 {
        let off = |bumped| {
            let good = measured(&truth(), &mut Stream::new(seed), 5, USUAL, bumped);
            let mut each = good.each_arcsec.clone();
            each[6][2].y += 200.0;
            found(&AngleReadings::new(good.runs.clone(), each).unwrap())
        };
        let reading = off(None);
        assert_eq!(reading.suspects.outliers[0].run, 3);
        named += usize::from(!reading.rotated_runs.is_empty());
        let both = off(Some((2, [300.0, 0.0, 0.0], [0.0; 3])));
        assert_eq!((both.suspects.outliers[0].run, runs_of(&both.rotated_runs)[0]), (3, (3, 0)));
        others += both.rotated_runs.len() - 1;
    }
    // Nominal: 5 of 100 each.
    assert!(named <= 10 && others <= 10, "{named}, {others} of 100");
}

/// docs/figures.md: good stands, whose runs vary alike about all axes, or ten times more about the vertical.
#[test]
fn good_runs_are_rarely_named() {
    for (what, of_runs) in [("equal", USUAL), ("unequal", ([1.0, 1.0, 10.0], [1.0, 1.0, 10.0]))] {
        for runs in [3, 4, 5, 6] {
            let mut stream = Stream::new(31);
            let mut named = [0; 2];
            for _ in 0..1000 {
                let found = found(&measured(&truth(), &mut stream, runs, of_runs, None)).rotated_runs;
                named[0] += u32::from(!found.is_empty());
                named[1] += u32::from(found.iter().any(|run| run.probability < 0.01));
            }
            println!(
                "{what} axes, {runs} runs: of 1000 good stands {} name a run, {} as an outlier",
                named[0], named[1]
            );
            // Nominal: at most 50 and 10; their standard deviations are 7 and 3.
            assert!(named[0] <= 64 && named[1] <= 19, "{what} {runs}: {named:?}");
        }
    }
}

/// docs/figures.md: a bump about oblique axes of the platform or of the base is found as one about an axis is, and its three
/// components are stated. The bounds are 7 u of a difference of one run from four, about 2.4″ (platform), and what a
/// rotation of 300″ adds at deviations of a degree, 300″ · 0.02 · √3.
#[test]
fn oblique_bumps_are_named() {
    let directions = [[1.0, 1.0, 0.0], [1.0, 0.5, 0.0], [1.0, 0.3, 0.0], [1.0, 1.0, 1.0], [-1.0, 2.0, 3.0]];
    let mut named = [0; 2];
    for direction in directions.map(Vector3::from) {
        for (size, named) in [60.0, 300.0].into_iter().zip(&mut named) {
            for seed in 0..20 {
                let bump = direction.normalize() * size;
                let [platform, base] = if seed % 2 == 0 { [bump, Vector3::zeros()] } else { [Vector3::zeros(), bump] };
                let readings =
                    measured(&truth(), &mut Stream::new(seed), 5, USUAL, Some((1, platform.into(), base.into())));
                let found = found(&readings).rotated_runs;
                let Some(at) = found.iter().find(|at| at.run() == Some(2)) else { continue };
                let off = Vector3::from(at.turns_arcsec) - bump;
                assert_eq!(at.axis.is_of_the_base(), seed % 2 == 1, "{at:?}");
                assert!(off.amax() < 7.0 * 2.4 + 0.02 * size * 1.8, "{at:?}: {off}");
                *named += 1;
            }
        }
    }
    println!("5 runs: of 100 with a run bumped by 60″, 300″ about oblique axes {named:?} name it");
    assert!(named[0] >= 90 && named[1] == 100, "{named:?}");
}

/// docs/figures.md: how large a bump is found.
#[test]
fn of_100_bumped_runs() {
    for runs in [3, 5] {
        let named = [20.0, 60.0, 300.0].map(|bump| {
            let mut stream = Stream::new(32);
            let mut of = || found(&measured(&truth(), &mut stream, runs, USUAL, Some((1, [bump, 0.0, 0.0], [0.0; 3]))));
            (0..100).filter(|_| runs_of(&of().rotated_runs).contains(&(2, 0))).count()
        });
        println!("{runs} runs: of 100 with a run bumped by 20″, 60″, 300″ {named:?} name it");
        if runs == 5 {
            assert!(named[0] >= 60 && named[1] == 100 && named[2] == 100, "{named:?}");
        } else {
            assert!(named[2] >= 80, "{named:?}");
        }
    }
}

/// Returns a random unit vector.
fn direction(stream: &mut Stream) -> Vector3<f64> {
    normal(stream, [1.0; 3]).normalize()
}

pub(super) const SMALL: ([f64; 3], [f64; 3]) = ([1.0; 3], [1.0; 3]);

/// docs/figures.md: a stand that moves for good between two runs is named with the runs and the rotation.
#[test]
fn a_move_is_named_once() {
    for (runs, moved) in [(4, 2), (5, 2), (6, 3)] {
        let named = [20.0, 60.0, 300.0].map(|size| {
            let mut stream = Stream::new(33);
            let mut of = || {
                let [turn, zero] = [direction(&mut stream) * size, Vector3::zeros()];
                let base = |run| if run >= runs - moved { [zero, turn] } else { [zero; 2] };
                let readings = in_order(&Truth::new([1.0; 3], 1.0, 1.0), &mut stream, runs, SMALL, base);
                let found = found(&readings);
                let last = (runs - moved) as u32;
                let [at] = found.rotated_runs[..] else { return false };
                if at.pattern != Pattern::Move(last, last + 1) || !at.axis.is_of_the_base() {
                    return false;
                }
                let words = &found.warnings[0];
                assert!(words.contains(&format!("moved between runs {last} and {}", last + 1)), "{words}");
                // 7 u of a difference of means of two runs, √(1 + 1/8), and the second order at a degree, 0.02.
                let off = (Vector3::from(at.turns_arcsec) - turn).amax();
                assert!(off < 7.0 * 1.06 + 0.02 * size * 1.8, "{at:?}: {off}");
                true
            };
            (0..100).filter(|_| of()).count()
        });
        println!("{runs} runs, the last {moved} moved by 20″, 60″, 300″: of 100 {named:?} name the move");
        assert!(named[1] >= 90 && named[2] == 100 && (runs == 4 || named[0] >= 80), "{runs}: {named:?}");
    }
}

/// docs/figures.md: a stand that rotates by the same amount from run to run.
#[test]
fn a_drift_is_named() {
    let named = [1.0, 2.0, 4.0, 8.0].map(|rate| {
        let mut stream = Stream::new(34);
        let mut of = || {
            let drift = |run| [Vector3::z() * rate * run as f64, Vector3::zeros()];
            let found = found(&in_order(&Truth::new([1.0; 3], 1.0, 1.0), &mut stream, 6, SMALL, drift)).rotated_runs;
            match found[..] {
                [at] if at.pattern == Pattern::Drift => {
                    // 5 u of a slope, √((1 + 1/8)/17.5) with Σ (run − mean)² = 17.5.
                    assert!(at.axis.0 == 2 && (at.turn_arcsec() - rate).abs() < 5.0 * 0.254, "{at:?}");
                    true
                }
                _ => false,
            }
        };
        (0..100).filter(|_| of()).count()
    });
    println!("6 runs: of 100 with a drift of 1″, 2″, 4″, 8″ per run {named:?} name it");
    assert!(named[2] >= 80 && named[3] >= 95, "{named:?}");
}

/// Expected by hand: rotations 0, 1, 100, 101 about z of the platform: the step after the second run is 100. It leaves
/// residuals of ±1/2, a variance of 1/2 with 2 degrees of freedom, and t is 100/√(1/2) = √20000:
/// P(|t| > √20000) = 1 − √(20000/20002) = 4.99963e-5 (closed form for 2 degrees of freedom), times 2 groups of axes and 6
/// patterns: 4 runs, a move and a drift.
#[test]
fn a_move_by_hand() {
    let quiet = Truth { angles_arcsec: [Vector3::zeros(); 8], ..Truth::new([1e-4; 3], 0.0, 0.0) };
    let mut each = quiet.measured(&mut Stream::new(1), 4).each_arcsec;
    each.iter_mut().for_each(|runs| runs.iter_mut().zip([0.0, 1.0, 100.0, 101.0]).for_each(|(at, z)| at.z += z));
    // A second session is numbered from where it likes.
    let found = found(&AngleReadings::new(vec![1, 2, 5, 6], each).unwrap()).rotated_runs;
    let [at] = found[..] else { panic!("{found:?}") };
    assert_eq!((at.pattern, at.axis.0), (Pattern::Move(2, 5), 2), "{at:?}");
    assert!((at.turn_arcsec() - 100.0).abs() < 1e-3, "{at:?}");
    assert!((at.probability / (12.0 * 4.99963e-5) - 1.0).abs() < 0.01, "{at:?}");
}

fn against(certificate: &Stand, readings: &AngleReadings) -> Comparison {
    let again = certify(&header(), readings).ok();
    compare(certificate, &header(), readings, again.as_ref()).unwrap()
}

/// A check with a run bumped about an oblique axis is not the same stand: the bump leaves the variance that tests it.
#[test]
fn a_check_with_an_oblique_bump_is_not_the_same_stand() {
    for seed in 0..20 {
        let mut stream = Stream::new(seed);
        let mut certificate = found(&measured(&truth(), &mut stream, 5, USUAL, None)).stand;
        certificate.certificate.evidence = Some(Evidence { readings_sha256: "0".repeat(64), runs: 5, excluded: None });
        let bumped = Some((1, [0.0; 3], [173.0; 3]));
        let check = against(&certificate, &measured(&truth(), &mut stream, 5, USUAL, bumped));
        assert!(!check.same_stand, "{:?}", check.common);
        assert!(!check.words.iter().any(|words| words.contains("datum surface")), "{:?}", check.words);
        assert!(check.words[0].starts_with("All positions of run 2 are rotated by"), "{:?}", check.words);
        assert!(check.words[0].contains("about east, north, up of the base"), "{:?}", check.words);
    }
}

/// A stand that moved during the check by much more than it repeats is not the same stand.
#[test]
fn a_check_with_a_move_is_not_the_same_stand() {
    for seed in 0..20 {
        let mut stream = Stream::new(seed);
        let mut certificate = found(&measured(&truth(), &mut stream, 5, USUAL, None)).stand;
        certificate.certificate.evidence = Some(Evidence { readings_sha256: "0".repeat(64), runs: 5, excluded: None });
        let base = |run| [Vector3::zeros(), Vector3::repeat(if run < 3 { 0.0 } else { 173.0 })];
        let check = against(&certificate, &in_order(&truth(), &mut stream, 5, USUAL, base));
        assert!(!check.same_stand, "{:?}", check.common);
        assert!(check.words[0].starts_with("The stand seems to have moved between runs 3 and 4"), "{:?}", check.words);
        assert!(!check.words.iter().any(|words| words.contains("datum surface")), "{:?}", check.words);
    }
}

/// A check with a bumped run is not the same stand in silence: the run must not inflate the variance that tests it.
#[test]
fn a_check_with_a_bumped_run_says_so() {
    for seed in 0..20 {
        let mut stream = Stream::new(seed);
        let mut certificate = found(&measured(&truth(), &mut stream, 5, USUAL, None)).stand;
        certificate.certificate.evidence = Some(Evidence { readings_sha256: "0".repeat(64), runs: 5, excluded: None });
        let bumped = Some((2, [300.0, 0.0, 0.0], [0.0; 3]));
        let check = against(&certificate, &measured(&truth(), &mut stream, 5, USUAL, bumped));
        assert!(!check.same_stand, "{:?}", check.common);
        assert!(check.words[0].starts_with("All positions of run 3 are rotated by"), "{:?}", check.words);
        assert!(check.words[0].contains("about x, y, z of the platform"), "{:?}", check.words);
        assert!(!check.words.iter().any(|words| words.contains("datum surface")), "{:?}", check.words);
    }
}
