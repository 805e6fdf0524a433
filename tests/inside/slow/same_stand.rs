//! Check runs against a certificate: the same stand passes, a moved position and a turned stand are told from it.

use crate::inside::simulated_stands::{HEADER, Truth, certified, header, normal};
use dtg_passport::certification::comparison::{Comparison, compare, detectable_arcsec};
use dtg_passport::certification::{AngleReadings, Header, certify};
use dtg_passport::coefficients::EIGHT_POSITIONS;
use dtg_passport::stand::{Evidence, Stand};
use dtg_passport::statistics::random::Stream;
use nalgebra::Vector3;

/// The certificate of a stand measured in so many runs, as `certify` writes it from a file.
pub(super) fn certificate(truth: &Truth, stream: &mut Stream, runs: u32) -> Stand {
    with_evidence(certified(truth, stream, runs as usize).stand, runs)
}

fn with_evidence(mut stand: Stand, runs: u32) -> Stand {
    stand.certificate.evidence = Some(Evidence { readings_sha256: "0".repeat(64), runs, excluded: None });
    stand
}

pub(super) fn against(certificate: &Stand, readings: &AngleReadings) -> Comparison {
    let again = certify(&header(), readings).ok();
    compare(certificate, &header(), readings, again.as_ref()).unwrap()
}

/// A stand turned by `turn_arcsec` about the platform's z.
fn turned(truth: &Truth, turn_arcsec: f64) -> Truth {
    let mut turned = *truth;
    turned.angles_arcsec.iter_mut().for_each(|angles| angles.z += turn_arcsec);
    turned
}

fn has_words(found: &Comparison, words: &str) -> bool {
    found.words.iter().any(|said| said.contains(words))
}

/// Of `trials` certificates and checks of a stand turned by `turn_arcsec` about the platform's z between them: how many are
/// taken for the same stand, and how many common turns alone are taken for chance.
fn taken_for_the_same(truth: &Truth, runs: (u32, usize), turn_arcsec: f64, trials: u64, seed: u64) -> (u64, u64) {
    let mut stream = Stream::new(seed);
    let turned = turned(truth, turn_arcsec);
    let (mut same, mut chance) = (0, 0);
    for _ in 0..trials {
        let certificate = certificate(truth, &mut stream, runs.0);
        let found = against(&certificate, &turned.measured(&mut stream, runs.1));
        same += u64::from(found.same_stand);
        chance += u64::from(found.common.test.unwrap().probability >= 0.01);
    }
    (same, chance)
}

/// Run-to-run scatter of 1″, own scatter of 1″.
fn quiet() -> Truth {
    Truth::new([1.0; 3], 1.0, 1.0)
}

/// The tables of docs/certification.md.
#[test]
#[ignore = "minutes"]
fn figures_of_the_common_turn() {
    let others = [Truth::new([1.0; 3], 3.0, 0.0), Truth::new([1.0; 3], 0.0, 0.0)];
    let all = [(5, 1), (5, 2), (5, 3), (5, 5), (3, 1), (3, 3), (2, 1), (2, 2), (2, 5)];
    let cases = all.map(|runs| (quiet(), runs)).into_iter();
    for (truth, runs) in cases.chain(others.into_iter().flat_map(|truth| [(truth, (5, 1)), (truth, (5, 3))])) {
        let (same, chance) = taken_for_the_same(&truth, runs, 0.0, 1000, 1);
        let [large, small] = [60.0, 12.0].map(|turn| taken_for_the_same(&truth, runs, turn, 1000, 2).0);
        let (refused, turned) = (1000 - same, 1000 - chance);
        println!(
            "| {}, {} | {} | {} | {refused} | {turned} | {large} | {small} |",
            truth.platform, truth.base, runs.0, runs.1
        );
    }
}

#[test]
fn the_same_stand_passes_and_a_turned_one_does_not() {
    let trials = super::trials(200);
    for runs in [(5, 1), (5, 3), (3, 2)] {
        let (same, chance) = taken_for_the_same(&quiet(), runs, 0.0, trials, 3);
        let (refused, turned) = (trials - same, trials - chance);
        println!("{runs:?}: of {trials} checks of the same stand {refused} are refused, {turned} for a common turn");
        // Asked for: 1 % of common turns, 1 % of the positions all together, 1 % of the worst of them.
        assert!(turned * 100 <= trials * 3 && refused * 100 <= trials * 7, "{runs:?}: {refused} {turned}");
        assert_eq!(taken_for_the_same(&quiet(), runs, 60.0, 40, 4).0, 0, "{runs:?}");
    }
    let (missed, _) = taken_for_the_same(&quiet(), (5, 3), 12.0, 40, 5);
    assert!(missed <= 2, "{missed}");
}

/// A stand that repeats five times worse than certified is not called another one, or one with positions that have changed;
/// neither is a good one with an instrument that reads to whole arcseconds, or one that is half as bad again, which is the
/// same stand. Expected: the simulated scatter.
#[test]
fn a_larger_scatter_is_told_from_a_change() {
    let mut stream = Stream::new(9);
    let (good, worse) = (Truth::new([0.2; 3], 1.0, 1.0), Truth::new([1.0; 3], 1.0, 1.0));
    let scatters = |found: &Comparison| has_words(found, "repeats worse");
    let (mut worse_named, mut undecided, mut named) = (0, 0, 0);
    for _ in 0..100 {
        let certificate = certificate(&good, &mut stream, 5);
        for runs in [2, 5] {
            let found = against(&certificate, &worse.measured(&mut stream, runs));
            assert!(!found.same_stand, "{:?}", found.words);
            worse_named += u32::from(scatters(&found));
            undecided += u32::from(found.is_undecided());
            let mut coarse = good.measured(&mut stream, runs).each_arcsec;
            coarse.iter_mut().flatten().for_each(|angles| *angles = angles.map(f64::round));
            let coarse = AngleReadings::new((1..=runs as u32).collect(), coarse).unwrap();
            named += u32::from(scatters(&against(&certificate, &coarse)));
        }
    }
    let half = Truth::new([0.3; 3], 1.0, 1.0);
    let of_half = |_: &u32| {
        let found = against(&certificate(&good, &mut stream, 5), &half.measured(&mut stream, 5));
        scatters(&found) && found.same_stand
    };
    let same = (0..100).filter(of_half).count();
    println!("half as much again: {same} of 100 named and the same stand");
    assert!(same >= 80, "{same}");
    println!(
        "five times the scatter: {worse_named} of 200 named, {undecided} undecided; whole arcseconds: {named} of 200 named"
    );
    // In 1 % a reading is named as an outlier instead, in 1 % each all positions or the worst of them as changed.
    assert!(worse_named >= 194 && undecided >= 190 && named <= 4, "{worse_named} {undecided} {named}");
}

/// The rotations that a check of an unchanged stand says it would find, arcsec: of a position and of the platform.
fn detected(comparison: &Comparison) -> Option<[f64; 2]> {
    let said = comparison.findings.iter().any(|found| found.to_string().contains(" would be detected"));
    said.then_some([detectable_arcsec(&comparison.positions)?, comparison.common.detectable_arcsec()?])
}

/// A check of an unchanged stand says what it would have found: a stand that has changed by so much is named in 95 % of the
/// checks, and one that has changed by half as much in far fewer.
#[test]
fn an_unchanged_stand_has_not_changed_by_what_is_said() {
    let mut stream = Stream::new(12);
    for runs in [1, 3] {
        let said: Vec<[f64; 2]> = (0..50)
            .filter_map(|_| {
                let certificate = certificate(&quiet(), &mut stream, 5);
                detected(&against(&certificate, &quiet().measured(&mut stream, runs)))
            })
            .collect();
        assert!(said.len() >= 40, "{}", said.len());
        for (of, places) in [(0, 4..5), (1, 0..8)] {
            let mean = said.iter().map(|at| at[of]).sum::<f64>() / said.len() as f64;
            let mut named = |turn_arcsec: f64| {
                let mut changed = quiet();
                places.clone().for_each(|place| changed.angles_arcsec[place].z += turn_arcsec);
                let of_trial = |_: &u32| {
                    let certificate = certificate(&quiet(), &mut stream, 5);
                    !against(&certificate, &changed.measured(&mut stream, runs)).same_stand
                };
                (0..100).filter(of_trial).count()
            };
            let (whole, half) = (named(mean), named(mean / 2.0));
            println!("{runs} runs, {places:?} turned by {mean:.1}″: named {whole} of 100; by half of it: {half}");
            assert!(whole >= 88 && half <= 75, "{runs} {places:?}: {whole} {half}");
        }
    }
}

/// Scatter of the runs by hand: about one axis the mean of three, 0, 1 and 2, differs by 60 from the certificate; their variance
/// is 1, the certificate's is 1/3. Nothing else varies, so χ² is near 60²/(1/3 + 1/3) when the variance is of one axis, three times
/// that when the other two axes do not vary, for the variance is one for the three.
#[test]
fn the_scale_is_the_runs_own_variance() {
    let quiet = Truth::new([1e-3; 3], 0.0, 0.0);
    let mut stream = Stream::new(6);
    let of_runs = |shift: f64, stream: &mut Stream| {
        let measured = quiet.measured(stream, 3);
        let mut each = measured.each_arcsec.clone();
        each.iter_mut().for_each(|runs| runs.iter_mut().zip([0.0, 1.0, 2.0]).for_each(|(at, run)| at.z += run + shift));
        AngleReadings::new(vec![1, 2, 3], each).unwrap()
    };
    let stand = with_evidence(certify(&header(), &of_runs(0.0, &mut stream)).unwrap().stand, 3);
    let test = against(&stand, &of_runs(60.0, &mut stream)).common.test.unwrap();
    let expected = 3.0 * 60.0 * 60.0 / (1.0 / 3.0 + 1.0 / 3.0);
    assert!((test.chi_square / expected - 1.0).abs() < 0.01, "{}, not {expected}", test.chi_square);
    assert_eq!(test.degrees_of_freedom, 6);
    // Check and certificate vary alike and are pooled. F(6, 12) = 2700: P = I_x(6, 3) at x = 1/1351, which is 28 x⁶ for small x.
    assert!((test.probability / (28.0 / 1351.0_f64.powi(6)) - 1.0).abs() < 0.05, "{}", test.probability);
}

/// Without the runs of the certificate a check of one run does not judge a common turn, and says so.
#[test]
fn one_run_needs_evidence() {
    let truth = quiet();
    let mut stream = Stream::new(7);
    let mut stand = certificate(&truth, &mut stream, 5);
    let turned = turned(&truth, 60.0);
    let one = turned.measured(&mut stream, 1);
    let found = against(&stand, &one);
    assert!(!found.same_stand && has_words(&found, "rotated together"), "{found:?}");
    stand.certificate.evidence = None;
    let found = against(&stand, &one);
    assert!(found.same_stand && found.common.test.is_none());
    let due = "Rotation of the stand as a whole was not tested: one run does not show";
    assert!(has_words(&found, due), "{:?}", found.words);
    // Several runs show it themselves.
    let found = against(&stand, &turned.measured(&mut stream, 3));
    assert!(!found.same_stand, "{found:?}");
    stand.certificate.common_platform_arcsec = None;
    let found = against(&stand, &turned.measured(&mut stream, 3));
    assert!(has_words(&found, "They are common_platform_arcsec"), "{:?}", found.words);
}

/// What repeating cannot show is in common_* and not in what runs vary by. The turn is so large that what the other axes add to
/// chi-square does not matter.
#[test]
fn type_b_is_not_scatter_of_runs() {
    let truth = quiet();
    let mut stream = Stream::new(8);
    let text = HEADER.replace(
        "laboratory: \"Example\"",
        "laboratory: \"Example\", type_b: [{source: \"cube\", acts_on: \"platform\", u_arcsec: 100.0}]",
    );
    let with = Header::from_yaml("h.yaml", text.as_bytes()).unwrap();
    let readings = truth.measured(&mut stream, 5);
    let [bare, full] = [&header(), &with].map(|of| with_evidence(certify(of, &readings).unwrap().stand, 5));
    let check = turned(&truth, 3000.0).measured(&mut stream, 1);
    let variance_z = |stand: &Stand| {
        let test = against(stand, &check).common.test.unwrap();
        3000.0 * 3000.0 / test.chi_square
    };
    // Once: of the certified mean. Five times it would be 100²·(1 + 5).
    assert!((variance_z(&full) / 1e4 - 1.0).abs() < 0.2, "{}", variance_z(&full));
    assert!(variance_z(&bare) < 10.0, "{}", variance_z(&bare));
}

/// A moved position is named; a turned stand is told from it, and another stand.
#[test]
fn what_has_changed_is_named() {
    let truth = Truth::new([1.0; 3], 2.0, 2.0);
    let mut stream = Stream::new(31);
    let certificate = certificate(&truth, &mut stream, 5);
    let against = |readings: &AngleReadings| against(&certificate, readings);
    let mut moved = truth;
    moved.angles_arcsec[5].z += 12.0;
    let found = against(&moved.measured(&mut stream, 1));
    assert!(!found.same_stand);
    let out: Vec<_> = found.positions.iter().filter(|at| !at.repeats).map(|at| (at.index.i, at.index.j)).collect();
    assert_eq!(out, [(2, 2)]);
    assert!((found.positions[5].turn_arcsec[2] - 12.0).abs() < 5.0, "{:?}", found.positions[5]);
    assert!(found.common.test.unwrap().probability > 0.01, "one position does not make a common turn");
    let found = against(&turned(&truth, 60.0).measured(&mut stream, 5));
    assert!(!found.same_stand && found.positions.iter().all(|at| at.repeats), "{found:?}");
    assert!(has_words(&found, "rotated together"));
    assert!((found.common.platform_arcsec[2] - 60.0).abs() < 10.0);
    let other = Truth::new([1.0; 3], 2.0, 2.0).measured(&mut stream, 1);
    // The angles of each position belong to the next one, so no two are exchanged.
    let mut shifted = other.each_arcsec.clone();
    shifted.rotate_left(1);
    let found = against(&AngleReadings::new(vec![1], shifted).unwrap());
    assert!(has_words(&found, "another stand"), "{:?}", found.words);
}

#[test]
fn a_check_needs_the_same_stand_and_an_uncertainty() {
    let truth = Truth::new([1.0; 3], 2.0, 2.0);
    let mut stream = Stream::new(41);
    let certificate = certified(&truth, &mut stream, 5).stand;
    let one = truth.measured(&mut stream, 1);
    let other = Header::from_yaml("h.yaml", HEADER.replace("0017", "0018").as_bytes()).unwrap();
    let error = compare(&certificate, &other, &one, None).unwrap_err().to_string();
    assert!(error.contains("SPS-2 0017") && error.contains("SPS-2 0018"), "{error}");
    let mut fewer = header();
    fewer.positions.pop();
    assert!(compare(&certificate, &fewer, &one, None).unwrap_err().to_string().contains("(2, 4)"));
    let mut bare = certificate.clone();
    bare.certificate.repeatability_arcsec = None;
    assert!(compare(&bare, &header(), &one, None).unwrap_err().to_string().contains("no repeatability"));
    let mut exact = certificate;
    exact.positions[0].u_alpha_arcsec = None;
    let found = compare(&exact, &header(), &one, None).unwrap();
    assert!(has_words(&found, "treated as exact"));
}

/// Readings of pairs of positions in each other's rows, each also rotated by what runs vary by: the pairs are named, and
/// nothing else has changed. Four positions of eight with new angles are another stand: the other four might as well be the
/// ones that have changed.
#[test]
fn exchanged_positions_are_named() {
    let truth = quiet();
    let mut stream = Stream::new(71);
    let stand = certificate(&truth, &mut stream, 5);
    for (runs, pairs) in
        [(1, vec![(1, 3)]), (3, vec![(5, 7)]), (1, vec![(1, 3), (5, 7)]), (3, vec![(0, 4), (1, 2), (6, 7)])]
    {
        let mut check = truth.measured(&mut stream, runs);
        pairs.iter().for_each(|(one, other)| check.each_arcsec.swap(*one, *other));
        let found = against(&stand, &check);
        let index = |place: usize| stand.positions[place].index();
        let named: Vec<_> = pairs
            .iter()
            .map(|(one, other)| format!("Positions {} and {} are exchanged", index(*one), index(*other)))
            .collect();
        assert!(!found.same_stand && found.words.len() == named.len(), "{:?}", found.words);
        for (said, due) in found.words.iter().zip(&named) {
            assert!(said.contains(due), "{said}, not {due}");
        }
    }
    let mut other = truth;
    other.angles_arcsec.iter_mut().take(4).for_each(|angles| *angles *= -0.5);
    let found = against(&stand, &other.measured(&mut stream, 3));
    assert!(found.positions.iter().all(|at| !at.repeats), "{found:?}");
    assert!(found.words[0].contains("another stand"), "{:?}", found.words);
}

/// Expected: a stand whose positions have all moved by 20″, a hundredth of its deviations, has changed; of stands that have
/// nothing to do with the certificate the test takes 1 % for it, within four standard deviations of 400 trials.
#[test]
fn a_worn_stand_is_told_from_another() {
    let truth = quiet();
    let mut stream = Stream::new(73);
    let stand = certificate(&truth, &mut stream, 5);
    let mut is_worn = |kept: f64, change_arcsec: f64, runs: usize| {
        let mut other = truth;
        other.angles_arcsec.iter_mut().for_each(|angles| {
            *angles = *angles * kept + Vector3::from_fn(|_, _| change_arcsec * stream.normal());
        });
        let found = against(&stand, &other.measured(&mut stream, runs));
        assert!(
            !found.same_stand && !found.is_undecided() && found.positions.iter().all(|at| !at.repeats),
            "{found:?}"
        );
        let is_worn = found.words[0].contains("the stand has changed in most positions");
        assert_ne!(is_worn, found.words[0].contains("another stand"), "{:?}", found.words);
        is_worn
    };
    for runs in [1, 3] {
        assert!((0..20).all(|_| is_worn(1.0, 20.0, runs)), "{runs}");
    }
    let alike = (0..400).filter(|_| is_worn(0.0, 1000.0, 1)).count();
    assert!(alike <= 12, "{alike}");
}

/// Expected: all positions with θ = 90° rotated by 60″ about the axis of the frame, x of the base, as by a stop that has moved:
/// that setting is named with its rotation, within five standard deviations of the mean of eight visits, and nothing else.
#[test]
fn a_setting_that_has_changed_is_named() {
    // Without rotations of whole runs, which all positions of a run would share.
    let truth = Truth::new([1.0; 3], 0.0, 0.0);
    let mut stream = Stream::new(74);
    let stand = certificate(&truth, &mut stream, 5);
    for runs in [1, 3] {
        let mut check = truth.measured(&mut stream, runs);
        for (place, (_, theta, phi)) in EIGHT_POSITIONS.iter().enumerate().filter(|(_, (_, theta, _))| *theta == 90.0) {
            for reading in &mut check.each_arcsec[place] {
                *reading = truth.read(place, *theta, *phi, normal(&mut stream, [1.0; 3]), Vector3::new(60.0, 0.0, 0.0));
            }
        }
        let found = against(&stand, &check);
        assert!(!found.same_stand && found.words.len() == 1, "{:?}", found.words);
        let words = found.words[0].strip_prefix("The positions with θ = 90° have rotated by ").expect(&found.words[0]);
        let (turn, rest) = words.split_once('″').unwrap();
        assert!((turn.parse::<f64>().unwrap() - 60.0).abs() < 5.0, "{turn}");
        assert!(rest.contains("about the axis of θ"), "{rest}");
    }
}

/// Expected: of a stand whose deviations have become many times larger, in other directions, as after a repair, that it is
/// another one. Divided by 60, its angles are nearer to the certified ones, as any small angles are.
#[test]
fn a_stand_with_larger_deviations_is_not_in_another_unit() {
    let mut stream = Stream::new(75);
    let mut truth = quiet();
    truth.angles_arcsec.iter_mut().for_each(|angles| *angles /= 40.0);
    let stand = certificate(&truth, &mut stream, 5);
    let mut rebuilt = truth;
    rebuilt.angles_arcsec.iter_mut().for_each(|angles| *angles = normal(&mut stream, [2000.0; 3]));
    let found = against(&stand, &rebuilt.measured(&mut stream, 3));
    assert!(!found.same_stand && found.words.len() == 1, "{:?}", found.words);
    assert!(found.words[0].contains("another stand"), "{:?}", found.words);
}
