//! Digits of the readings: their rounding, and repeated readings that are identical.

use crate::inside::reference::*;
use dtg_passport::calibration::parameter::Parameter;
use dtg_passport::calibration::{Calibration, InputUncertainty, Options, Readings, Setup, calibrate};
use dtg_passport::statistics::random::Stream;

/// Last digit of a meter that shows milliamperes with four decimals.
const DIGIT_MA: f64 = 1e-4;

/// A stand with an exact certificate, and a meter whose stated floor is far below the digit.
fn bench(seed: u64, noise_ma: f64) -> Setup {
    let mut u = InputUncertainty::of_meter(paper_meter());
    (u.meter.reading, u.meter.noise_ma) = (1e-7, noise_ma);
    with_uncertainty(&drawn_stand(&mut Stream::new(seed), 2.0), LATITUDE_DEG, u)
}

/// CSV of `rows` readings of each position with normal noise, mA, each written with `decimals`.
fn written(setup: &Setup, rows: usize, (stream, noise_ma): (&mut Stream, f64), decimals: usize) -> Vec<u8> {
    let mut csv = "i,j,jx_ma,jy_ma\n".to_owned();
    for (at, exact) in setup.coefficients().positions.iter().zip(currents(setup, &gvk_6())) {
        for _ in 0..rows {
            let read = exact.map(|j| j + noise_ma * stream.normal());
            csv += &format!("{},{},{:.decimals$},{:.decimals$}\n", at.index.i, at.index.j, read.x, read.y);
        }
    }
    csv.into_bytes()
}

/// CSV of one reading of each position without noise, each current as `shown`.
fn exact(setup: &Setup, shown: impl Fn(f64) -> String) -> Vec<u8> {
    let each = setup.coefficients().positions.iter().zip(currents(setup, &gvk_6()));
    let rows = each.map(|(at, j)| format!("{},{},{},{}\n", at.index.i, at.index.j, shown(j.x), shown(j.y)));
    format!("i,j,jx_ma,jy_ma\n{}", rows.collect::<String>()).into_bytes()
}

fn solved(setup: &Setup, csv: &[u8]) -> Calibration {
    let readings = Readings::from_csv("currents.csv", csv, setup.coefficients(), 1.0).unwrap();
    calibrate(setup, &readings, &Options::default()).unwrap()
}

fn u(calibration: &Calibration, parameter: Parameter) -> f64 {
    calibration.adopted().unwrap().standard_uncertainty(parameter).unwrap()
}

/// Mean of chi-square per degree of freedom, and the share of the parameters of `count` gyros on different stands that are
/// within two standard uncertainties of the truth.
fn over_stands(count: u64, rows: usize, noise_ma: f64, stated_ma: f64) -> (f64, f64) {
    let (mut fit, mut covered) = (0.0, 0.0);
    for seed in 0..count {
        let (setup, mut stream) = (bench(seed, stated_ma), Stream::new(seed + 1000));
        let found = solved(&setup, &written(&setup, rows, (&mut stream, noise_ma), 4));
        let answer = found.adopted().unwrap();
        fit += answer.chi_square.value / answer.chi_square.degrees_of_freedom as f64;
        let (values, truth) = (answer.parameters.to_vector(), gvk_6().to_vector());
        let near = |parameter: &Parameter| {
            let place = parameter.place();
            (values[place] - truth[place]).abs() <= 2.0 * u(&found, *parameter)
        };
        covered += Parameter::EIGHT.iter().filter(|parameter| near(parameter)).count() as f64 / 8.0;
    }
    (fit / count as f64, covered / count as f64)
}

/// Expected: a digit of 1e-4 mA has the standard uncertainty 1e-4/√12 mA (JCGM 100, F.2.2.1). With it chi-square has its
/// degrees of freedom as the mean, and two standard uncertainties cover 95 % of a normal distribution; the mean of 200
/// fits with 8 degrees of freedom has a standard deviation of √(2/8/200) = 0.035.
#[test]
fn readings_with_few_digits_have_the_uncertainty_of_their_rounding() {
    let (fit, covered) = over_stands(200, 1, 0.0, 0.0);
    assert!((fit - 1.0).abs() < 4.0 * 0.035, "{fit}");
    assert!((0.93..0.975).contains(&covered), "{covered}");
}

/// Expected: as above; noise of one digit makes the roundings of ten rows independent, so that their mean is better than
/// the digit. The noise is estimated from the rows.
#[test]
fn noise_that_spreads_over_digits_takes_the_rounding_with_it() {
    let (fit, covered) = over_stands(200, 10, DIGIT_MA, 0.0);
    assert!((fit - 1.0).abs() < 4.0 * 0.035, "{fit}");
    assert!((0.93..0.975).contains(&covered), "{covered}");
    let setup = bench(1, 0.0);
    let found = solved(&setup, &written(&setup, 10, (&mut Stream::new(2), DIGIT_MA), 4));
    assert_eq!(found.digits, None);
}

/// Expected: the uncertainty is proportional to the digit, and does not change where the stated floor is larger.
#[test]
fn the_rounding_takes_the_place_of_a_smaller_floor_only() {
    let setup = bench(1, 0.0);
    let of_decimals = |setup: &Setup, decimals: usize| solved(setup, &exact(setup, |j| format!("{j:.decimals$}")));
    let found = [2, 3, 4].map(|decimals| of_decimals(&setup, decimals));
    let digits = found.each_ref().map(|found| found.digits.unwrap().last_digit_ma.unwrap());
    for (digit, expected) in digits.into_iter().zip([1e-2, 1e-3, 1e-4]) {
        assert!((digit / expected - 1.0).abs() < 1e-12, "{digit}");
    }
    let [_, coarse, fine] = found.each_ref().map(|found| u(found, Parameter::Omega0x));
    assert!((coarse / fine / 10.0 - 1.0).abs() < 0.02, "{coarse} {fine}");
    assert_eq!(of_decimals(&setup, 7).digits, None);
    let stated = of_decimals(&setup.with(|u| u.meter.floor_ma = 3e-5), 4);
    assert_eq!(stated.digits, None);
    assert!((u(&stated, Parameter::Omega0x) / fine - 3e-5 / (1e-4 / 12_f64.sqrt())).abs() < 1e-3);
}

/// Expected: a meter that changes its range shows four significant digits of every current; the largest are a few tenths
/// of a milliampere, so that a reading is uncertain by at most 1e-4/√12 mA, as with four decimals.
#[test]
fn a_meter_of_fixed_significant_digits_has_the_digit_of_its_largest_current() {
    let setup = bench(1, 0.0);
    let fixed = solved(&setup, &exact(&setup, |j| format!("{j:.4}")));
    let ranged = solved(&setup, &exact(&setup, |j| format!("{j:.3e}")));
    assert_eq!(ranged.digits, fixed.digits);
    assert!((u(&ranged, Parameter::Kx) / u(&fixed, Parameter::Kx) - 1.0).abs() < 1e-3);
    assert!(ranged.adopted().unwrap().chi_square.probability > 0.01);
}

/// Expected: by hand. Four decimals from 0.2 mA on and five below are uncertain by at most the rounding of four; the steps
/// of a converter are multiples of 5e-5 mA; and numbers with four decimals in single precision have four decimals.
#[test]
fn the_step_of_a_meter_may_differ_from_the_last_digit() {
    let setup = bench(1, 0.0);
    let autorange = |j: f64| if j.abs() >= 0.2 { format!("{j:.4}") } else { format!("{j:.5}") };
    let half = |j: f64| format!("{:.5}", (j / 5e-5).round() * 5e-5);
    fn rounded(j: f64) -> f64 {
        (j * 1e4).round() / 1e4
    }
    let single = |j: f64| format!("{:.8e}", rounded(j) as f32);
    let cast = |j: f64| format!("{}", f64::from(rounded(j) as f32));
    for (shown, expected) in [(autorange as fn(f64) -> String, 1e-4), (half, 5e-5), (single, 1e-4), (cast, 1e-4)] {
        let step = solved(&setup, &exact(&setup, shown)).digits.unwrap().last_digit_ma.unwrap();
        assert!((step / expected - 1.0).abs() < 1e-12, "{step} {expected}");
    }
}

/// A number from a computation in binary has no last digit, but one that a spreadsheet converted from microamperes has.
#[test]
fn the_last_digit_is_that_of_the_decimal_number() {
    let setup = bench(1, 0.0);
    let digits = |scale: fn(f64) -> f64| solved(&setup, &exact(&setup, |j| scale(j).to_string())).digits;
    assert_eq!(digits(|exact| exact), None);
    assert_eq!(digits(|exact| f64::from(exact as f32)), None);
    let converted = digits(|exact| (exact * 1e4).round() * 0.1 * 1e-3).unwrap().last_digit_ma.unwrap();
    assert!((converted / DIGIT_MA - 1.0).abs() < 1e-12, "{converted}");
}

/// Expected: visits that differ by their rounding alone show no noise of the gyro beyond a third of that rounding.
#[test]
fn rounding_is_not_taken_for_noise_of_the_gyro() {
    let setup = bench(3, 0.0);
    let mut noises = Vec::new();
    for seed in 0..50 {
        // Readings within half a digit of each other, which are rounded to different digits here and there.
        let rows = written(&setup, 3, (&mut Stream::new(seed), 0.15 * DIGIT_MA), 4);
        let rows = std::str::from_utf8(&rows).unwrap().lines().skip(1).enumerate();
        let visits: String = rows.map(|(row, line)| format!("{line},{}\n", row % 3 + 1)).collect();
        let found = solved(&setup, format!("i,j,jx_ma,jy_ma,visit\n{visits}").as_bytes());
        assert!(found.digits.unwrap().last_digit_ma.is_some());
        noises.push(found.visit_noise.deg_per_h / (95.0 * DIGIT_MA / 12_f64.sqrt()));
    }
    let mean = noises.iter().sum::<f64>() / noises.len() as f64;
    assert!(mean < 0.5, "{mean}");
}

/// Expected: copies of rows or of visits add nothing to one reading, neither a smaller uncertainty nor a noise of 0.
#[test]
fn copies_of_readings_count_as_one() {
    let setup = bench(1, 2e-6);
    let once = written(&setup, 1, (&mut Stream::new(2), 2e-6), 8);
    let rows: Vec<&str> = std::str::from_utf8(&once).unwrap().lines().skip(1).collect();
    let one = solved(&setup, &once);
    let thrice = |repeated: Vec<String>, head: &str| format!("{head}\n{}\n", repeated.join("\n")).into_bytes();
    let of_rows = thrice(rows.iter().flat_map(|row| [*row; 3].map(str::to_owned)).collect(), "i,j,jx_ma,jy_ma");
    let numbered = |number: usize| rows.iter().map(move |row| format!("{number},{row}"));
    let of = |what: &str| thrice((1..=3).flat_map(numbered).collect(), &format!("{what},i,j,jx_ma,jy_ma"));
    for (csv, [identical_rows, identical_visits]) in
        [(of_rows, [true, false]), (of("visit"), [false, true]), (of("cycle"), [false, true])]
    {
        let found = solved(&setup, &csv);
        let digits = found.digits.unwrap();
        assert_eq!([digits.identical_rows, digits.identical_visits], [identical_rows, identical_visits]);
        assert_eq!(
            (&found.results, found.visit_noise, found.turn_on_noise),
            (&one.results, one.visit_noise, one.turn_on_noise)
        );
        assert_eq!((found.row_scatter, found.scatter), (None, None));
        assert_eq!(found.noise_not_stated().count(), 2);
    }
}
