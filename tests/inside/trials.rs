//! The crate of the trials: random numbers, elementary functions, bins and sums.

use crate::calibration::{InputUncertainty, Method};
use crate::inside::reference::*;
use crate::statistics::distributions::{normal_below, normal_quantile};
use crate::uncertainty::Engine;
use dtg_passport_trials::PARAMETERS;
use dtg_passport_trials::accumulator::{Accumulator, Scale};
use dtg_passport_trials::bins::{BINS, bin, quantile, shortest};
use dtg_passport_trials::elementary::{SMALL_RAD, ln, octant_sin_cos, small_cos_less_one, small_sin};
use dtg_passport_trials::student::chi_square;
use dtg_passport_trials::wide_random::{GENERATORS, WIDTH, WideRandom};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

/// In units of the last place of `due`.
fn units(found: f64, due: f64) -> f64 {
    let unit = f64::from_bits(due.abs().to_bits() + 1) - due.abs();
    (found - due).abs() / unit
}

/// Expected: libm, which is within one unit itself.
#[test]
fn sines_and_cosines() {
    for step in -20_000_i32..=20_000 {
        let x = SMALL_RAD * f64::from(step) / 20_000.0;
        assert!(x == 0.0 || units(small_sin(x), libm::sin(x)) <= 1.0, "{x}");
        assert!(units(1.0 + small_cos_less_one(x), libm::cos(x)) <= 1.0, "{x}");
        let x = std::f64::consts::FRAC_PI_4 * f64::from(step.abs()) / 20_000.0;
        let (sin, cos) = octant_sin_cos(x);
        assert!(x == 0.0 || units(sin, libm::sin(x)) <= 2.0, "{x}");
        assert!(units(cos, libm::cos(x)) <= 2.0, "{x}");
    }
}

/// Expected: libm.
#[test]
fn logarithms() {
    let mut x = 1e-300_f64;
    while x < 1e300 {
        let due = libm::log(x);
        assert!((ln(x) - due).abs() <= 4.5e-16 * due.abs().max(1.0), "{x}");
        x *= 1.000_37 * (1.0 + x.fract().abs() * 0.01);
    }
    assert_eq!(ln(1.0), 0.0);
    for x in [f64::from_bits(0x3ff0_0000_0000_0001), 0.999_999, 0.70, 0.71, 2.0_f64.powi(-52)] {
        assert!((ln(x) / libm::log(x) - 1.0).abs() < 1e-15, "{x}");
    }
}

/// Expected: rand_xoshiro's generator, jumps and seeding.
#[test]
fn generators_are_those_of_rand_xoshiro() {
    for blocks in [0, 1, 3] {
        let mut lanes = WideRandom::new(42);
        (0..blocks).for_each(|_| lanes.jump());
        let mut first = Xoshiro256PlusPlus::seed_from_u64(42);
        let mut due = Vec::new();
        for _ in 0..GENERATORS {
            let mut generator = first.clone();
            (0..blocks).for_each(|_| generator.jump());
            due.push(generator);
            first.long_jump();
        }
        for _ in 0..100 {
            let numbers: Vec<u64> = due.iter_mut().map(Rng::next_u64).collect();
            assert_eq!(lanes.next_numbers().to_vec(), numbers);
        }
    }
}

/// Expected: the normal distribution: moments within five standard errors, and its distribution function within the
/// limit of Kolmogorov and Smirnov (probability 1e-6: 2.7/√n).
#[test]
fn normals_are_normal() {
    let mut lanes = WideRandom::new(7);
    let mut values: Vec<f64> = Vec::new();
    let (mut one, mut other) = ([0.0; WIDTH], [0.0; WIDTH]);
    let mut products = 0.0;
    for _ in 0..10_000 {
        lanes.normals(&mut one, &mut other);
        products += one.iter().zip(&other).map(|(a, b)| a * b).sum::<f64>();
        values.extend(one.iter().chain(&other));
    }
    let n = values.len() as f64;
    let moment = |power: i32| values.iter().map(|x| x.powi(power)).sum::<f64>() / n;
    for (power, due, variance) in [(1, 0.0, 1.0), (2, 1.0, 2.0), (3, 0.0, 15.0), (4, 3.0, 96.0)] {
        let error = (moment(power) - due) / f64::sqrt(variance / n);
        assert!(error.abs() < 5.0, "moment {power}: {error} standard errors");
    }
    assert!((products / (n / 2.0).sqrt()).abs() < 5.0);
    values.sort_by(f64::total_cmp);
    let each = values.iter().enumerate();
    let furthest = each.map(|(rank, x)| (normal_below(*x) - (rank as f64 + 0.5) / n).abs()).fold(0.0, f64::max);
    assert!(furthest < 2.7 / n.sqrt(), "{furthest}");
    let mut uniform = [0.0; WIDTH];
    let mut sum = 0.0;
    for _ in 0..10_000 {
        lanes.uniform(&mut uniform);
        assert!(uniform.iter().all(|x| (-1.0..1.0).contains(x)));
        sum += uniform.iter().map(|x| x * x).sum::<f64>();
    }
    assert!((sum / (10_000.0 * WIDTH as f64) - 1.0 / 3.0).abs() < 5.0 * (4.0_f64 / 45.0 / 320_000.0).sqrt());
}

/// Expected: chi-square has mean ν, variance 2 ν and third central moment 8 ν; five standard errors of the first two.
#[test]
fn chi_squares() {
    let mut lanes = WideRandom::new(9);
    for degrees_of_freedom in [1.0, 2.0, 5.0, 38.0, 0.7, 4.5, 60.0] {
        let n = 3000 * WIDTH;
        let mut values = Vec::with_capacity(n);
        for _ in 0..3000 {
            values.extend(chi_square(&mut lanes, degrees_of_freedom));
        }
        let n = n as f64;
        let mean = values.iter().sum::<f64>() / n;
        let variance = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n;
        assert!((mean - degrees_of_freedom).abs() < 5.0 * (2.0 * degrees_of_freedom / n).sqrt(), "{mean}");
        let scatter = ((48.0 * degrees_of_freedom + 8.0 * degrees_of_freedom * degrees_of_freedom) / n).sqrt();
        assert!((variance - 2.0 * degrees_of_freedom).abs() < 5.0 * scatter, "{degrees_of_freedom}: {variance}");
    }
}

/// Expected: quantiles of the normal distribution by `normal_quantile`, of a sample that is its own quantiles; the
/// shortest interval of a symmetric density is the symmetric one, of an exponential one it begins at its beginning.
#[test]
fn intervals() {
    let shares = (0..200_000).map(|rank| (f64::from(rank) + 0.5) / 200_000.0);
    let mut counts = vec![0_u32; BINS];
    shares.clone().for_each(|share| counts[bin(normal_quantile(share))] += 1);
    for share in [0.025, 0.3, 0.5, 0.975] {
        assert!((quantile(&counts, share) - normal_quantile(share)).abs() < 2e-4, "{share}");
    }
    let [low, high] = shortest(&counts, 0.95);
    assert!((high - low - 2.0 * 1.959_964).abs() < 1e-3 && (low + 1.96).abs() < 0.05, "{low} {high}");
    let mut counts = vec![0_u32; BINS];
    shares.for_each(|share| counts[bin(-libm::log(share))] += 1);
    let [low, high] = shortest(&counts, 0.95);
    assert!(low.abs() < 0.005 && (high + libm::log(0.05)).abs() < 0.01, "{low} {high}");
    assert_eq!(quantile(&[0_u32; BINS], 0.5), 0.0);
    assert_eq!([-1e300, f64::NEG_INFINITY, 1e300].map(bin), [0, 0, BINS - 1]);
}

/// Expected: moments and quantiles of the normal distribution, of a sample that is its own quantiles.
#[test]
fn moments_and_quantiles_of_a_normal_sample() {
    let scale = Scale { centre: [5.0; PARAMETERS], unit: [2.0; PARAMETERS] };
    let mut tally = Accumulator::new(scale);
    let chunks = 4000;
    for chunk in 0..chunks {
        let column = std::array::from_fn(|trial| {
            let share = ((chunk * WIDTH + trial) as f64 + 0.5) / (chunks * WIDTH) as f64;
            5.0 + 2.0 * normal_quantile(share)
        });
        tally.add(&[column; PARAMETERS]);
    }
    let mut all = vec![[0; BINS]; PARAMETERS];
    let summary = tally.end_of_block(&mut all);
    assert_eq!((summary.count, summary.failed), ((chunks * WIDTH) as u64, 0));
    for (place, counts) in all.iter().enumerate() {
        for found in [summary.quantiles[place][1], quantile(counts, 0.975)] {
            assert!((found - 1.959_964).abs() < 2e-4, "{found}");
        }
        assert!(summary.sums[place].abs() < 1e-6);
    }
    assert!((summary.products[0] / summary.count as f64 - 1.0).abs() < 1e-3);
}

#[test]
fn a_trial_that_fails_is_told() {
    let mut tally = Accumulator::new(Scale { centre: [0.0; PARAMETERS], unit: [1.0; PARAMETERS] });
    let mut column = [0.5; WIDTH];
    column[3] = f64::NAN;
    column[4] = f64::INFINITY;
    tally.add(&[column; PARAMETERS]);
    let summary = tally.end_of_block(&mut vec![[0; BINS]; PARAMETERS]);
    assert_eq!((summary.count, summary.failed), (WIDTH as u64 - 2, 2));
    assert!((summary.sums[0] - 15.0).abs() < 1e-12);
    // The rest is all in one bin: so are its lowest and its highest value.
    let [low, high] = summary.quantiles[0];
    assert!(low > 0.49 && high < 0.51, "{low} {high}");
}

/// Creates an engine for an ideal stand with uncertain inputs; the angles have `known` degrees of freedom.
fn engine(method: Method, known: f64) -> Engine {
    let uncertainty = InputUncertainty {
        angles_rad: vec![[1e-5, 2e-5, 3e-5]; 8],
        angles_degrees_of_freedom: vec![known; 8],
        repeatability_rad: 1e-5,
        level_rad: 1e-5,
        ..InputUncertainty::of_meter(paper_meter())
    };
    let setup = with_uncertainty(&eight([[0.0; 3]; 8]), 50.0, uncertainty);
    Engine::new(&setup, &readings(&setup, &currents(&setup, &gvk_6())), method).unwrap()
}

/// The widest instructions of this machine and scalar ones give the same bits.
#[test]
fn results_do_not_depend_on_the_width_of_instructions() {
    for method in [Method::Analytic, Method::LeastSquares] {
        for known in [f64::INFINITY, 4.0, 4.5] {
            let computation = engine(method, known).computation;
            let [wide, narrow] = [false, true].map(|narrow| computation.samples(&mut WideRandom::new(5), narrow));
            assert!(wide.map(bits) == narrow.map(bits));
        }
    }
}

fn bits(values: Vec<f64>) -> Vec<u64> {
    values.into_iter().map(f64::to_bits).collect()
}
