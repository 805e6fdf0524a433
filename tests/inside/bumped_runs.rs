//! A run that is rotated as a whole is named, whatever else is right or wrong in it; good runs are not.

use crate::inside::simulated_stands::{Truth, header, normal};
use dtg_passport::certification::bumped_runs::BumpedRun;
use dtg_passport::certification::comparison::{Comparison, compare};
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
fn measured(
    truth: &Truth,
    stream: &mut Stream,
    runs: usize,
    of_runs: ([f64; 3], [f64; 3]),
    bumped: Option<(usize, [f64; 3], [f64; 3])>,
) -> AngleReadings {
    let mut each = vec![Vec::new(); 8];
    for run in 0..runs {
        let (mut platform, mut base) = (normal(stream, of_runs.0), normal(stream, of_runs.1));
        if let Some((_, of_platform, of_base)) = bumped.filter(|(place, ..)| *place == run) {
            platform += Vector3::from(of_platform);
            base += Vector3::from(of_base);
        }
        for (place, (_, theta, phi)) in EIGHT_POSITIONS.iter().enumerate() {
            let own = normal(stream, truth.own);
            each[place].push(truth.read(place, *theta, *phi, platform + own, base));
        }
    }
    AngleReadings::new((1..=runs as u32).collect(), each).unwrap()
}

const USUAL: ([f64; 3], [f64; 3]) = ([2.0; 3], [1.0; 3]);

fn found(readings: &AngleReadings) -> Certification {
    certify(&header(), readings).unwrap()
}

fn runs_of(found: &[BumpedRun]) -> Vec<(u32, usize)> {
    found.iter().map(|at| (at.run, at.axis)).collect()
}

/// Expected by hand: rotations of five runs about x of the platform 0, 1, 2, 3, 104, and none about the other axes. The
/// last is 102.5 from the mean of the others, 20.5 of it in the mean of all. Their variance is 5/3, so Student's t is
/// 102.5/√(5/3 · 5/4) = 71.01 with 3 degrees of freedom: P(|t| > 71.01) = 6.1536e-6 (SciPy, 2 stats.t.sf(71.014, 3)),
/// times 5 runs and 2 groups of axes.
#[test]
fn one_run_by_hand() {
    let quiet = Truth { angles_arcsec: [Vector3::zeros(); 8], ..Truth::new([1e-4; 3], 0.0, 0.0) };
    let measured = quiet.measured(&mut Stream::new(1), 5);
    let mut each = measured.each_arcsec.clone();
    each.iter_mut().for_each(|runs| runs.iter_mut().zip([0.0, 1.0, 2.0, 3.0, 104.0]).for_each(|(at, x)| at.x += x));
    let found = found(&AngleReadings::new(vec![1, 2, 3, 4, 5], each).unwrap());
    let [at] = found.bumped_runs[..] else { panic!("{:?}", found.bumped_runs) };
    assert_eq!((at.run, at.axis), (5, 0));
    assert!((at.turn_arcsec() - 102.5).abs() < 1e-3 && (at.in_the_mean_arcsec()[0] - 20.5).abs() < 1e-3, "{at:?}");
    assert!((at.probability / 6.1536e-5 - 1.0).abs() < 0.01, "{at:?}");
    let words = &found.warnings[0];
    assert!(
        words.starts_with("outlier: all positions of run 5 are rotated by +102.50, ")
            && words.contains("arcsec about x, y, z of the platform relative")
            && words.contains("by up to 20.50 arcsec")
            && words.contains("--exclude 5"),
        "{words}"
    );
}

/// All α of one run of five wrong by 300″; the level of the base by 120″; one run of three.
#[test]
fn a_bumped_run_is_named() {
    for seed in 0..20 {
        let of = |runs, platform, base| {
            let mut stream = Stream::new(seed);
            found(&measured(&truth(), &mut stream, runs, USUAL, Some((2, platform, base)))).bumped_runs
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
        named += usize::from(!reading.bumped_runs.is_empty());
        let both = off(Some((2, [300.0, 0.0, 0.0], [0.0; 3])));
        assert_eq!((both.suspects.outliers[0].run, runs_of(&both.bumped_runs)[0]), (3, (3, 0)));
        others += both.bumped_runs.len() - 1;
    }
    // Nominal: 5 of 100 each.
    assert!(named <= 10 && others <= 10, "{named}, {others} of 100");
}

/// docs/figures.md: good stands, whose runs vary alike about all axes, or ten times more about the vertical.
#[test]
fn good_runs_are_rarely_named() {
    for (what, of_runs) in [("equal", USUAL), ("unequal", ([1.0, 1.0, 10.0], [1.0, 1.0, 10.0]))] {
        for runs in [3, 5] {
            let mut stream = Stream::new(31);
            let mut named = [0; 2];
            for _ in 0..1000 {
                let found = found(&measured(&truth(), &mut stream, runs, of_runs, None)).bumped_runs;
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
                let found = found(&readings).bumped_runs;
                let Some(at) = found.iter().find(|at| at.run == 2) else { continue };
                let off = Vector3::from(at.turns_arcsec) - bump;
                assert_eq!(at.is_of_the_base(), seed % 2 == 1, "{at:?}");
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
            (0..100).filter(|_| runs_of(&of().bumped_runs).contains(&(2, 0))).count()
        });
        println!("{runs} runs: of 100 with a run bumped by 20″, 60″, 300″ {named:?} name it");
        if runs == 5 {
            assert!(named[0] >= 60 && named[1] == 100 && named[2] == 100, "{named:?}");
        } else {
            assert!(named[2] >= 80, "{named:?}");
        }
    }
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
        assert!(check.words[0].starts_with("all positions of run 2 of the check are rotated by"), "{:?}", check.words);
        assert!(check.words[0].contains("about east, north, up of the base"), "{:?}", check.words);
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
        assert!(check.words[0].starts_with("all positions of run 3 of the check are rotated by"), "{:?}", check.words);
        assert!(check.words[0].contains("about x, y, z of the platform"), "{:?}", check.words);
        assert!(!check.words.iter().any(|words| words.contains("datum surface")), "{:?}", check.words);
    }
}
