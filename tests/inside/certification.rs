//! Certification: simulated stands whose components are known come back with the uncertainty stated.

use crate::inside::simulated_stands::{HEADER, Truth, certified, csv, header, read};
use dtg_passport::attitude;
use dtg_passport::certification::found::Found;
use dtg_passport::certification::kind::Kind;
use dtg_passport::certification::{AngleReadings, Header, NotCertified, certify};
use dtg_passport::coefficients::EIGHT_POSITIONS;
use dtg_passport::stand::Stand;
use dtg_passport::statistics::random::Stream;
use dtg_passport::statistics::student::student_factor;
use nalgebra::{DMatrix, Matrix3, Vector3};

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
            let of_platform = (platform * platform, found.components.platform.degrees_of_freedom);
            let of_base = (base * base, found.components.base.unwrap().degrees_of_freedom);
            for (at, angles) in found.stand.positions.iter().zip(truth.angles_arcsec) {
                let own = at.u_alpha_arcsec.unwrap() * at.u_alpha_arcsec.unwrap();
                let parts = [(own, at.degrees_of_freedom.unwrap()), of_platform, of_base];
                let variance = parts.iter().map(|(v, _)| v).sum::<f64>();
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
    let text: String = HEADER.split_inclusive('\n').filter(|line| !line.contains("i: 2")).collect();
    let header = Header::from_yaml("h.yaml", text.as_bytes()).unwrap();
    let whole = Truth::new([1.0; 3], 3.0, 3.0).measured(&mut Stream::new(2), 5);
    let readings = AngleReadings::new(whole.runs.clone(), whole.each_arcsec[..4].to_vec()).unwrap();
    let found = certify(&header, &readings).unwrap();
    assert_eq!(found.components.base_axes, 2);
    assert!(found.warnings.iter().any(|words| words.contains("about 2 of three axes only")), "{:?}", found.warnings);
    let one: String =
        text.split_inclusive('\n').filter(|line| !line.contains("i: 1, j: ") || line.contains("j: 1")).collect();
    let one = Header::from_yaml("h.yaml", one.as_bytes()).unwrap();
    let readings = AngleReadings::new(whole.runs.clone(), whole.each_arcsec[..1].to_vec()).unwrap();
    assert_eq!(certify(&one, &readings), Err(NotCertified::TooFewPositions));
}

#[test]
fn what_cannot_be_certified_is_refused() {
    let truth = Truth::new([1.0; 3], 2.0, 2.0);
    let one = truth.measured(&mut Stream::new(1), 1);
    assert_eq!(certify(&header(), &one), Err(NotCertified::OneRun));
    let first = &one.each_arcsec[..1];
    let found = certify(&header(), &AngleReadings::new(vec![1], first.to_vec()).unwrap());
    assert!(matches!(found, Err(NotCertified::OtherPositions { .. })));
    let of_two_runs = |runs: fn(Vector3<f64>) -> [Vector3<f64>; 2]| {
        let each = one.each_arcsec.iter().map(|position| runs(position[0]).to_vec()).collect();
        certify(&header(), &AngleReadings::new(vec![1, 2], each).unwrap())
    };
    assert_eq!(of_two_runs(|angles| [angles; 2]), Err(NotCertified::Constant("alpha")));
    let found = of_two_runs(|angles| [angles.map(f64::round), angles.map(|x| x.round() + 0.5)]);
    assert!(found.is_err() || found.unwrap().components.pooled_arcsec2.value < 1e-3);
    assert!(AngleReadings::new(vec![1, 2], one.each_arcsec.clone()).is_err());
}

/// The stand file is canonical, says how it came about, and gives back what was certified.
#[test]
fn the_stand_file_reads_back() {
    let found = certified(&Truth::new([1.0; 3], 2.0, 0.0), &mut Stream::new(4), 3);
    let text = found.to_yaml("stand.yaml").unwrap();
    assert_eq!(Stand::from_yaml("stand.yaml", text.as_bytes()).unwrap(), found.stand);
    dtg_passport::text::rule::check("stand.yaml", text.as_bytes(), 1 << 20).unwrap();
    for words in [
        "# Repeatability of one visit, without",
        "# Means of 3 runs",
        "repeatability_degrees_of_freedom: ",
        "# Warning: The common part is estimated from 3 runs",
    ] {
        assert!(text.contains(words), "no {words:?} in\n{text}");
    }
}

/// docs/certification.md: the turns of platform and base together have the condition 1 + √2. By hand: their normal matrix is 8 on the
/// diagonal and the sum of the eight attitudes beside it, whose only row is (0, −4, 4), of length 4 √2.
#[test]
fn platform_and_base_can_be_told_apart() {
    let mut both = DMatrix::zeros(24, 6);
    for (place, (_, theta, phi)) in EIGHT_POSITIONS.iter().enumerate() {
        both.fixed_view_mut::<3, 3>(3 * place, 0).copy_from(&Matrix3::identity());
        both.fixed_view_mut::<3, 3>(3 * place, 3).copy_from(&attitude::nominal(*theta, *phi));
    }
    let values = both.singular_values();
    assert!((values.max() / values.min() - (1.0 + 2.0_f64.sqrt())).abs() < 1e-12, "{values}");
}

/// The readings rounded to whole arcseconds.
fn whole(exact: &AngleReadings) -> AngleReadings {
    let each = exact.each_arcsec.iter().map(|each| each.iter().map(|angles| angles.map(f64::round)).collect());
    AngleReadings::new(exact.runs.clone(), each.collect()).unwrap()
}

/// Readings to whole arcseconds that vary by a fifth of that: 95 % of the certified angles or more are within their intervals
/// (an error of rounding is never larger than half a step), no single step is called an outlier, and the rounding is named. With
/// more digits, or more scatter, it is not. Expected: the simulated angles; GUM F.2.2.1.
#[test]
fn rounding_of_readings_is_included() {
    let mut stream = Stream::new(81);
    for (own, runs) in [(0.2, 5), (0.15, 3)] {
        let (mut inside, mut all) = (0.0, 0.0);
        for trial in 0..100 {
            let mut truth = Truth::new([own; 3], 0.05, 0.05);
            // A stand whose angles are not whole arcseconds.
            for angles in &mut truth.angles_arcsec {
                *angles += Vector3::from([(); 3].map(|()| stream.within(0.5)));
            }
            let found = match certify(&header(), &whole(&truth.measured(&mut stream, runs))) {
                Err(NotCertified::Constant(_)) => continue,
                found => found.unwrap(),
            };
            let is_step = |at: &Found| at.kind == Kind::Angle && at.size.is_some_and(|size| size.abs() <= 1.5);
            assert!(!found.findings.iter().any(is_step), "{:?}", found.warnings);
            assert!(found.warnings.iter().any(|words| words.contains("step of 1″")), "{trial}: {:?}", found.warnings);
            for (at, angles) in found.stand.positions.iter().zip(truth.angles_arcsec) {
                let factor = student_factor(0.05, at.degrees_of_freedom.unwrap());
                let apart = [at.alpha_arcsec - angles.x, at.beta_arcsec - angles.y, at.gamma_arcsec - angles.z];
                for (apart, u) in apart.into_iter().zip(at.u_arcsec()) {
                    inside += f64::from(u8::from(apart.abs() <= factor * u.unwrap()));
                    all += 1.0;
                }
            }
        }
        let coverage = inside / all;
        println!("{runs} runs: {:.1} % of 95 % intervals hold the true angle", 100.0 * coverage);
        assert!(coverage > 0.95, "{coverage}");
    }
    let fine = certify(&header(), &read(&csv(&Truth::new([0.2; 3], 0.05, 0.05).measured(&mut stream, 5)))).unwrap();
    let coarse = Truth::new([2.0; 3], 0.05, 0.05).measured(&mut stream, 10);
    let coarse = certify(&header(), &whole(&coarse)).unwrap();
    for found in [fine, coarse] {
        assert!(!found.warnings.iter().any(|words| words.contains("step of")), "{:?}", found.warnings);
    }
}

/// Expected: the nominal angles of the header; φ counted the other way round is that of another position.
#[test]
fn nominal_angles_of_a_row_are_compared() {
    let text = csv(&Truth::new([1.0; 3], 0.0, 0.0).measured(&mut Stream::new(5), 2));
    let with = |phi_deg: [f64; 8]| {
        let angles = EIGHT_POSITIONS.iter().zip(phi_deg).map(|((_, theta_deg, _), phi_deg)| (theta_deg, phi_deg));
        let rows = text.lines().skip(1).zip(angles.collect::<Vec<_>>().repeat(2));
        let rows: String = rows.map(|(row, (theta_deg, phi_deg))| format!("{row},{theta_deg},{phi_deg}\n")).collect();
        let header = format!("{},theta_deg,phi_deg", text.lines().next().unwrap());
        AngleReadings::from_csv("a.csv", format!("{header}\n{rows}").as_bytes(), &self::header().positions)
    };
    let good = with([0.0, 90.0, 180.0, 270.0, 0.0, 90.0, 180.0, 270.0]).unwrap();
    assert_eq!((good.each_arcsec, good.remark), (read(&text).each_arcsec, None));
    let error = with([0.0, 270.0, 180.0, 90.0, 0.0, 270.0, 180.0, 90.0]).unwrap_err().to_string();
    assert!(error.contains("a.csv:3:") && error.contains("found 270, expected 90, the nominal angle"), "{error}");
}

/// Without four positions of one θ in one run only the deviations of the stand tell its platform from its base, and the
/// predictions would be worse than a reading by a factor of ten (deviations of 1°) to thousands (arcseconds): refused. Any
/// three positions of a run can be predicted from the five others. Expected: the simulated angles; 95 % of them within
/// their intervals.
#[test]
fn excluded_readings_are_determined_by_the_others() {
    use dtg_passport::coefficients::PositionIndex;
    use dtg_passport::stand::Excluded;

    let without = |places: &[usize], readings: &AngleReadings| {
        let out = |place: &usize| {
            let PositionIndex { i, j } = EIGHT_POSITIONS[*place].0;
            Excluded { i: Some(i), j: Some(j), run: 2, why: "bump".to_owned() }
        };
        let excluded: Vec<Excluded> = places.iter().map(out).collect();
        let positions = header().positions;
        let readings = AngleReadings::from_csv_without("a.csv", csv(readings).as_bytes(), &positions, &excluded, None);
        certify(&header(), &readings.unwrap())
    };
    let mut stream = Stream::new(61);
    let mut truth = Truth::new([1.0; 3], 0.0, 0.0);
    let deviations = truth.angles_arcsec;
    for (scale, runs) in [(0.001, 3), (0.1, 4), (1.0, 5)] {
        truth.angles_arcsec = deviations.map(|angles| angles * scale);
        for half in [[4, 5, 6, 7], [0, 1, 2, 3]] {
            let refused = without(&half, &truth.measured(&mut stream, runs));
            assert_eq!(refused, Err(NotCertified::Undetermined), "{scale} {half:?}");
        }
    }
    let (mut inside, mut all) = (0.0, 0.0);
    for places in (0..256_usize).map(|set| (0..8).filter(|place| set >> place & 1 == 1).collect::<Vec<_>>()) {
        if !(1..=3).contains(&places.len()) {
            continue;
        }
        let found = without(&places, &truth.measured(&mut stream, 3)).unwrap();
        for (at, angles) in found.stand.positions.iter().zip(truth.angles_arcsec) {
            let factor = student_factor(0.05, at.degrees_of_freedom.unwrap());
            for (angle, u) in
                [(at.alpha_arcsec - angles.x, at.u_alpha_arcsec), (at.gamma_arcsec - angles.z, at.u_gamma_arcsec)]
            {
                inside += f64::from(u8::from(angle.abs() <= factor * u.unwrap()));
                all += 1.0;
            }
        }
    }
    let coverage = inside / all;
    println!("{:.1} % of {all} intervals hold the true angle", 100.0 * coverage);
    assert!((0.93..0.97).contains(&coverage), "{coverage}");
}
