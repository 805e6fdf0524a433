//! Certification: simulated stands whose components are known come back with the uncertainty stated.

#![cfg(feature = "cli")]

use dtg_passport::attitude;
use dtg_passport::certification::comparison::compare;
use dtg_passport::certification::{AngleReadings, Certification, Header, NotCertified, certify};
use dtg_passport::coefficients::EIGHT_POSITIONS;
use dtg_passport::stand::Stand;
use dtg_passport::statistics::beta::student_factor;
use dtg_passport::statistics::random::Stream;
use nalgebra::{Matrix3, Vector3};

const HEADER: &str = r#"format: "dtg-stand/1"
stand: {model: "SPS-2", serial: "0017"}
certificate: {number: "C-1", issued: "2026-11-02", laboratory: "Example"}
positions:
  - {i: 1, j: 1, theta_deg: 0, phi_deg: 0}
  - {i: 1, j: 2, theta_deg: 0, phi_deg: 90}
  - {i: 1, j: 3, theta_deg: 0, phi_deg: 180}
  - {i: 1, j: 4, theta_deg: 0, phi_deg: 270}
  - {i: 2, j: 1, theta_deg: 90, phi_deg: 0}
  - {i: 2, j: 2, theta_deg: 90, phi_deg: 90}
  - {i: 2, j: 3, theta_deg: 90, phi_deg: 180}
  - {i: 2, j: 4, theta_deg: 90, phi_deg: 270}
"#;

fn header() -> Header {
    Header::from_yaml("header.yaml", HEADER.as_bytes()).unwrap()
}

/// Standard deviations of a simulated measurement, arcsec.
#[derive(Clone, Copy)]
struct Truth {
    angles_arcsec: [Vector3<f64>; 8],
    own: [f64; 3],
    platform: f64,
    base: f64,
}

impl Truth {
    /// Deviations up to a degree, so that rotations are not just numbers added.
    fn new(own: [f64; 3], platform: f64, base: f64) -> Self {
        let mut stream = Stream::new(7);
        let angles_arcsec = [(); 8].map(|()| Vector3::from([(); 3].map(|()| stream.within(3600.0).round())));
        Self { angles_arcsec, own, platform, base }
    }

    /// Readings by exact rotations: the base turned, then the platform, then the angles of the product taken.
    fn measured(&self, stream: &mut Stream, runs: usize) -> AngleReadings {
        let mut each = vec![Vec::new(); 8];
        for _ in 0..runs {
            let platform = normal(stream, [self.platform; 3]);
            let base = normal(stream, [self.base; 3]);
            for (place, (_, theta, phi)) in EIGHT_POSITIONS.iter().enumerate() {
                let own = normal(stream, self.own);
                each[place].push(self.read(place, *theta, *phi, platform + own, base));
            }
        }
        AngleReadings::new((1..=runs as u32).collect(), each).unwrap()
    }

    fn read(&self, place: usize, theta: f64, phi: f64, case: Vector3<f64>, base: Vector3<f64>) -> Vector3<f64> {
        let nominal = attitude::nominal(theta, phi);
        let deviation = turn(case) * turn(self.angles_arcsec[place]) * nominal * turn(base) * nominal.transpose();
        angles(&deviation)
    }
}

const ARCSEC: f64 = std::f64::consts::PI / 648_000.0;

/// Rz(γ)·Ry(β)·Rx(α) of three angles in arcsec.
fn turn(angles_arcsec: Vector3<f64>) -> Matrix3<f64> {
    let a = angles_arcsec * ARCSEC;
    attitude::deviation(&attitude::Deviation { alpha_rad: a.x, beta_rad: a.y, gamma_rad: a.z })
}

/// The angles of E, from its elements: sin β, −sin α cos β, −cos β sin γ (see the matrix above eq. (4)).
fn angles(e: &Matrix3<f64>) -> Vector3<f64> {
    let beta = libm::asin(e[(2, 0)]);
    Vector3::new(libm::atan2(-e[(2, 1)], e[(2, 2)]), beta, libm::atan2(-e[(1, 0)], e[(0, 0)])) / ARCSEC
}

fn normal(stream: &mut Stream, sigma: [f64; 3]) -> Vector3<f64> {
    Vector3::from(sigma.map(|sigma| sigma * stream.normal()))
}

fn certified(truth: &Truth, stream: &mut Stream, runs: usize) -> Certification {
    certify(&header(), &truth.measured(stream, runs)).unwrap()
}

/// The mean of the estimated variances is the true one, for every component, at 3 and 6 runs.
#[test]
fn variance_components_are_unbiased() {
    for (runs, seed) in [(3, 11), (6, 12)] {
        let truth = Truth::new([1.0, 1.5, 2.5], 3.0, 4.0);
        let mut stream = Stream::new(seed);
        let trials = 600;
        let mut sums = [0.0; 6];
        for _ in 0..trials {
            let found = certified(&truth, &mut stream, runs).components;
            let own = found.own_arcsec2.map(|variance| variance.value);
            let base = found.base.unwrap().between_runs_arcsec2;
            let all = [own[0], own[1], own[2], found.pooled_arcsec2.value, found.platform.between_runs_arcsec2, base];
            sums.iter_mut().zip(all).for_each(|(sum, value)| *sum += value);
        }
        let expected = [1.0, 2.25, 6.25, 9.5 / 3.0, 9.0, 16.0];
        for (sum, expected) in sums.iter().zip(expected) {
            let ratio = sum / f64::from(trials) / expected;
            assert!((ratio - 1.0).abs() < 0.1, "{runs} runs: {ratio} of {expected}");
        }
    }
}

/// 95 % intervals of every angle, from u_*, common_platform and common_base of the certificate alone.
#[test]
fn certified_angles_are_within_their_intervals() {
    for (runs, low, high) in [(3, 0.90, 0.98), (5, 0.93, 0.97)] {
        let truth = Truth::new([1.0; 3], 2.0, 2.0);
        let mut stream = Stream::new(3);
        let (mut inside, mut all) = (0.0, 0.0);
        for _ in 0..500 {
            let found = certified(&truth, &mut stream, runs);
            let certificate = &found.stand.certificate;
            let platform = certificate.common_platform_arcsec.unwrap();
            let base = certificate.common_base_arcsec.unwrap();
            let common = (platform * platform, base * base);
            let freedom =
                (found.components.platform.degrees_of_freedom, found.components.base.unwrap().degrees_of_freedom);
            for (at, angles) in found.stand.positions.iter().zip(truth.angles_arcsec) {
                let own = at.u_alpha_arcsec.unwrap() * at.u_alpha_arcsec.unwrap();
                let variance = own + common.0 + common.1;
                let parts = [(own, at.degrees_of_freedom.unwrap()), (common.0, freedom.0), (common.1, freedom.1)];
                let effective = variance * variance / parts.iter().map(|(v, nu)| v * v / nu).sum::<f64>();
                let expanded = student_factor(0.05, effective) * variance.sqrt();
                inside += f64::from(u8::from((at.alpha_arcsec - angles.x).abs() <= expanded));
                all += 1.0;
            }
        }
        let coverage = inside / all;
        println!("{runs} runs: {:.1} % of 95 % intervals hold the true angle", 100.0 * coverage);
        assert!((low..high).contains(&coverage), "{runs} runs: {coverage}");
    }
}

/// What is common is found common: nothing of it is left in the scatter, and the other way round.
#[test]
fn one_cause_comes_back_as_itself() {
    let mut stream = Stream::new(5);
    let only_common = certified(&Truth::new([0.01; 3], 5.0, 0.0), &mut stream, 40).components;
    assert!(only_common.pooled_arcsec2.value.sqrt() < 0.02, "{only_common:?}");
    assert!((only_common.platform.between_runs_arcsec2.sqrt() / 5.0 - 1.0).abs() < 0.25);
    assert!(only_common.base.unwrap().between_runs_arcsec2.sqrt() < 0.02);
    let only_own = certified(&Truth::new([2.0; 3], 0.0, 0.0), &mut stream, 40).components;
    assert!((only_own.pooled_arcsec2.value.sqrt() / 2.0 - 1.0).abs() < 0.1);
    assert!(
        only_own.platform.between_runs_arcsec2.sqrt() < 0.5 && only_own.base.unwrap().between_runs_arcsec2.sqrt() < 0.5
    );
    assert!(only_own.platform.upper_limit_arcsec2 >= only_own.platform.between_runs_arcsec2);
}

/// With positions of one frame angle, a turn of the base about the vertical is one of the platform about z.
#[test]
fn what_cannot_be_told_apart_is_said() {
    let text: String = HEADER.lines().filter(|line| !line.contains("i: 2")).map(|line| format!("{line}\n")).collect();
    let header = Header::from_yaml("h.yaml", text.as_bytes()).unwrap();
    let whole = Truth::new([1.0; 3], 3.0, 3.0).measured(&mut Stream::new(2), 5);
    let readings = AngleReadings::new(whole.runs().to_vec(), whole.each_arcsec()[..4].to_vec()).unwrap();
    let found = certify(&header, &readings).unwrap();
    assert_eq!(found.components.base_axes, 2);
    assert!(
        found.warnings.iter().any(|words| words.contains("only 2 of the base's three axes")),
        "{:?}",
        found.warnings
    );
    let one =
        text.lines().filter(|line| !line.contains("i: 1, j: 2") && !line.contains("j: 3") && !line.contains("j: 4"));
    let one = Header::from_yaml("h.yaml", one.map(|line| format!("{line}\n")).collect::<String>().as_bytes()).unwrap();
    let readings = AngleReadings::new(whole.runs().to_vec(), whole.each_arcsec()[..1].to_vec()).unwrap();
    assert_eq!(certify(&one, &readings), Err(NotCertified::TooFewPositions));
}

/// Good stands: Bartlett's and Grubbs' tests at 5 % name something in about 5 % of them.
#[test]
fn tests_have_their_level() {
    let (mut worse, mut out) = (0, 0);
    let truth = Truth::new([1.0; 3], 2.0, 2.0);
    let mut stream = Stream::new(21);
    for _ in 0..1000 {
        let found = certified(&truth, &mut stream, 5);
        worse += u32::from(found.suspects.worse.is_some());
        out += u32::from(!found.suspects.outliers.is_empty());
    }
    println!("of 1000 good stands {worse} have a worse position, {out} a reading that is out");
    assert!((30..80).contains(&worse) && (30..80).contains(&out), "{worse} {out}");
}

/// One reading moved, one position made worse: both are named, and nothing is dropped.
#[test]
fn suspects_are_named() {
    let truth = Truth::new([1.0; 3], 2.0, 2.0);
    let good = truth.measured(&mut Stream::new(8), 5);
    let mut each = good.each_arcsec().to_vec();
    each[4][2].y += 15.0;
    let found = certify(&header(), &AngleReadings::new(good.runs().to_vec(), each.clone()).unwrap()).unwrap();
    let first = found.suspects.outliers.first().unwrap();
    assert_eq!((first.index.i, first.index.j, first.run, first.axis), (2, 1, 3, 1));
    assert!(
        found.warnings.iter().any(|words| words.contains("position (2, 1), run 3") && words.contains("it was kept"))
    );
    let mean = each[4].iter().map(|run| run.y).sum::<f64>() / 5.0;
    assert!((found.stand.positions[4].beta_arcsec - mean).abs() < 1e-3);
    let mut each = good.each_arcsec().to_vec();
    let mut stream = Stream::new(9);
    each[6].iter_mut().for_each(|run| *run += normal(&mut stream, [6.0; 3]));
    let found = certify(&header(), &AngleReadings::new(good.runs().to_vec(), each).unwrap()).unwrap();
    let worse = found.suspects.worse.unwrap();
    assert_eq!((worse.index.i, worse.index.j), (2, 3));
    assert!(found.own_scatter);
    let u = |place: usize| found.stand.positions[place].u_alpha_arcsec.unwrap();
    assert!(u(6) > 2.0 * u(0), "{} {}", u(6), u(0));
}

#[test]
fn what_cannot_be_certified_is_refused() {
    let truth = Truth::new([1.0; 3], 2.0, 2.0);
    let one = truth.measured(&mut Stream::new(1), 1);
    assert_eq!(certify(&header(), &one), Err(NotCertified::OneRun));
    let copied = vec![one.each_arcsec()[0].clone(); 1];
    assert!(matches!(
        certify(&header(), &AngleReadings::new(vec![1], copied).unwrap()),
        Err(NotCertified::OtherPositions { .. })
    ));
    let twice: Vec<Vec<_>> = one.each_arcsec().iter().map(|runs| vec![runs[0], runs[0]]).collect();
    assert_eq!(
        certify(&header(), &AngleReadings::new(vec![1, 2], twice).unwrap()),
        Err(NotCertified::Constant("alpha"))
    );
    let shifted: Vec<Vec<_>> =
        one.each_arcsec().iter().map(|runs| vec![runs[0].map(f64::round), runs[0].map(|x| x.round() + 0.5)]).collect();
    let found = certify(&header(), &AngleReadings::new(vec![1, 2], shifted).unwrap());
    assert!(found.is_err() || found.unwrap().components.pooled_arcsec2.value < 1e-3);
    assert!(AngleReadings::new(vec![1, 2], one.each_arcsec().to_vec()).is_err());
}

/// The stand file is canonical, says how it came about, and gives back what was certified.
#[test]
fn the_stand_file_reads_back() {
    let found = certified(&Truth::new([1.0; 3], 2.0, 0.0), &mut Stream::new(4), 3);
    let text = found.to_yaml("stand.yaml").unwrap();
    assert_eq!(Stand::from_yaml("stand.yaml", text.as_bytes()).unwrap(), found.stand);
    dtg_passport::text::rule::check("stand.yaml", text.as_bytes()).unwrap();
    for words in
        ["# From 3 runs", "# Means of 3 runs", "repeatability_degrees_of_freedom: ", "# Warning: 3 runs are few"]
    {
        assert!(text.contains(words), "no {words:?} in\n{text}");
    }
}

/// Check runs of the same stand: about 1 % are refused. A moved position is named; a turned stand is told from it.
#[test]
fn a_check_run() {
    let truth = Truth::new([1.0; 3], 2.0, 2.0);
    let mut stream = Stream::new(31);
    let certificate = certified(&truth, &mut stream, 5).stand;
    let header = header();
    let against = |readings: &AngleReadings| {
        let again = certify(&header, readings).ok();
        compare(&certificate, &header, readings, again.as_ref()).unwrap()
    };
    let good = |stream: &mut Stream, runs: usize| {
        let certificate = certified(&truth, stream, 5).stand;
        let readings = truth.measured(stream, runs);
        let again = certify(&header, &readings).ok();
        compare(&certificate, &header, &readings, again.as_ref()).unwrap().same_stand
    };
    let refused = (0..400).filter(|_| !good(&mut stream, 1)).count();
    println!("of 400 check runs of the same stand {refused} are refused");
    assert!(refused <= 20, "{refused}");
    let mut moved = truth;
    moved.angles_arcsec[5].z += 12.0;
    let found = against(&moved.measured(&mut stream, 1));
    assert!(!found.same_stand);
    let out: Vec<_> = found.positions.iter().filter(|at| !at.repeats).map(|at| (at.index.i, at.index.j)).collect();
    assert_eq!(out, [(2, 2)]);
    assert!((found.positions[5].turn_arcsec[2] - 12.0).abs() < 5.0, "{:?}", found.positions[5]);
    assert!(found.common.test.is_none() && found.words.iter().any(|words| words.contains("two runs of the check")));
    let mut turned = truth;
    turned.angles_arcsec.iter_mut().for_each(|angles| angles.z += 60.0);
    let found = against(&turned.measured(&mut stream, 5));
    assert!(!found.same_stand && found.positions.iter().all(|at| at.repeats), "{found:?}");
    assert!(found.words.iter().any(|words| words.contains("turned together")));
    assert!((found.common.platform_arcsec[2] - 60.0).abs() < 10.0);
    let other = Truth::new([1.0; 3], 2.0, 2.0).measured(&mut stream, 1);
    let backwards: Vec<_> = other.each_arcsec().iter().rev().cloned().collect();
    let found = against(&AngleReadings::new(vec![1], backwards).unwrap());
    assert!(found.words.iter().any(|words| words.contains("another stand")), "{:?}", found.words);
    let again = (0..200).filter(|_| !good(&mut stream, 3)).count();
    println!("of 200 checks of three runs {again} are refused");
    assert!(again <= 14, "{again}");
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
    assert!(found.words.iter().any(|words| words.contains("taken as exact")));
}
