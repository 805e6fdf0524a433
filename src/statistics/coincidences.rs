//! The last digit of readings, and readings that are identical to an earlier one more often than chance explains: copies.

use super::distributions::chi_square_larger;
use std::collections::BTreeMap;

/// Probability by chance below which identical readings are taken for copies.
pub(crate) const COPIED: f64 = 1e-4;

/// Decimals of a number in scientific notation that count; further ones are rounding of a computation in binary.
const MOST_DECIMALS: usize = 14;

/// Ratio of a last digit to the number below which the number was computed.
const COMPUTED: f64 = 1e-11;

/// Ratio of a last digit to the number below which single precision does not show it.
const SINGLE: f64 = 1e-6;

/// Probability by chance below which numbers without a last digit, or with a common divisor, are taken for coarser ones.
const BY_CHANCE: f64 = 1.5e-4;

/// Reading that is identical to an earlier one of the same quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Coincidence {
    /// Quantity, counted from 0.
    pub(crate) quantity: usize,
    /// Reading, counted from 0 among those of the quantity.
    pub(crate) reading: usize,
    /// First reading with the same numbers.
    pub(crate) earlier: usize,
}

/// Returns the readings that are identical to an earlier one in all `N` numbers if there are more than chance explains;
/// otherwise none. `quantities` contains the independent readings of each quantity.
///
/// Two readings agree in one number with at most the ratio of its step to the usual difference of two readings as
/// probability, so that coincidences of readings with few digits are not taken for copies. The number of coincidences by
/// chance has about a Poisson distribution.
pub(crate) fn copies<const N: usize>(quantities: &[Vec<[f64; N]>]) -> Vec<Coincidence> {
    let mut found = Vec::new();
    for (quantity, readings) in quantities.iter().enumerate() {
        let mut first = BTreeMap::new();
        for (reading, numbers) in readings.iter().enumerate() {
            let earlier = *first.entry(numbers.map(|number| (number + 0.0).to_bits())).or_insert(reading);
            if earlier != reading {
                found.push(Coincidence { quantity, reading, earlier });
            }
        }
    }
    if found.is_empty() {
        return found;
    }
    let agree = |column: usize| {
        let of = |readings: &Vec<[f64; N]>| readings.iter().map(|reading| reading[column]).collect::<Vec<_>>();
        let step = step(&quantities.iter().map(of).collect::<Vec<_>>());
        let differing = quantities.iter().flat_map(|readings| readings.windows(2)).filter(|pair| pair[0] != pair[1]);
        let mut differences: Vec<f64> = differing.map(|pair| (pair[1][column] - pair[0][column]).abs()).collect();
        differences.sort_by(f64::total_cmp);
        let usual = differences.get(differences.len() / 2).copied().unwrap_or(0.0);
        if usual > step { step / usual } else { 1.0 }
    };
    let pairs: f64 =
        quantities.iter().map(|readings| readings.len() as f64 * (readings.len() as f64 - 1.0) / 2.0).sum();
    let expected = pairs * (0..N).map(agree).product::<f64>();
    if by_chance(expected, found.len()) > COPIED { Vec::new() } else { found }
}

/// Returns the probability of so many coincidences or more that are not copies, of which as many as `expected` occur on
/// average.
pub(crate) fn by_chance(expected: f64, found: usize) -> f64 {
    // P(N ≥ k) of a Poisson distribution with mean λ is P(χ² < 2λ) with 2k degrees of freedom.
    1.0 - chi_square_larger(2.0 * expected, 2 * found)
}

/// Returns the step of numbers, a multiple of their last digit, or, if they were computed, their smallest difference within
/// a quantity.
fn step(quantities: &[Vec<f64>]) -> f64 {
    let all = || quantities.iter().flatten().copied();
    let (last, largest) = (last_digit(all()), all().fold(0.0, |largest: f64, number| largest.max(number.abs())));
    if last > COMPUTED * largest {
        return last * divisor(all(), last);
    }
    let smallest = quantities.iter().filter_map(|numbers| {
        let mut sorted = numbers.clone();
        sorted.sort_by(f64::total_cmp);
        let gaps = sorted.windows(2).map(|pair| pair[1] - pair[0]);
        gaps.filter(|gap| *gap > COMPUTED * largest).reduce(f64::min)
    });
    smallest.reduce(f64::min).unwrap_or(largest)
}

/// Returns the greatest common divisor of numbers in units of their last digit; 0 if all are 0.
fn divisor(numbers: impl Iterator<Item = f64>, last: f64) -> f64 {
    numbers.map(|number| (number / last).abs().round() as u64).fold(0, common_divisor) as f64
}

/// Returns the greatest common divisor of two numbers, one of which may be 0.
fn common_divisor(one: u64, other: u64) -> u64 {
    if other == 0 { one } else { common_divisor(other, one % other) }
}

/// Returns the last decimal digit to which any of the numbers is written, or 0 if all are 0.
pub(crate) fn last_digit(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.filter_map(last_place).min().map_or(0.0, power_of_ten)
}

/// Returns the step of a meter that has shown the numbers, or 0 if all are 0: that of the coarsest of its ranges.
///
/// The largest numbers are of the coarsest range if all of them lack the last digit of the others, and are too many to end
/// in zeros by chance. The step of a range is a multiple of its last digit. Numbers that were once stored in single
/// precision have the digits that they had before.
pub(crate) fn step_of_meter(numbers: impl Iterator<Item = f64>) -> f64 {
    let mut sizes: Vec<f64> = numbers.map(f64::abs).filter(|size| *size > 0.0).collect();
    sizes.sort_by(|one, other| other.total_cmp(one));
    sizes.dedup();
    let Some(largest) = sizes.first().copied() else { return 0.0 };
    // Numbers that were stored in single precision are those nearest to much shorter ones; others are not.
    let single: Vec<f64> = sizes.iter().filter_map(|size| (*size as f32).to_string().parse().ok()).collect();
    let [short, written] = [&single, &sizes].map(|sizes| last_digit(sizes.iter().copied()));
    if short > SINGLE * largest && short > 50.0 * written {
        sizes = single;
    }
    coarsest(&sizes)
}

/// Returns the step of the coarsest range of numbers in descending order.
fn coarsest(sizes: &[f64]) -> f64 {
    let places: Vec<i32> = sizes.iter().filter_map(|size| last_place(*size)).collect();
    let Some(finest) = places.iter().copied().min() else { return 0.0 };
    let coarse = places.iter().take_while(|place| **place > finest).count();
    let by_chance = |divisor: f64, count: usize| libm::pow(divisor, -(count as f64)) > BY_CHANCE;
    if !by_chance(10.0, coarse) {
        return coarsest(&sizes[..coarse]);
    }
    let last = power_of_ten(finest);
    let divisor = divisor(sizes.iter().copied(), last);
    if by_chance(divisor, sizes.len()) { last } else { last * divisor }
}

/// Returns the place (power of ten) of the last digit of a number; `None` for 0.
fn last_place(number: f64) -> Option<i32> {
    let written = format!("{number:.MOST_DECIMALS$e}");
    let (mantissa, exponent) = written.split_once('e')?;
    let decimals = mantissa.trim_end_matches('0').split_once('.')?.1.len() as i32;
    let exponent: i32 = exponent.parse().ok()?;
    (number != 0.0).then_some(exponent - decimals)
}

fn power_of_ten(place: i32) -> f64 {
    libm::pow(10.0, f64::from(place))
}

#[cfg(all(test, feature = "monte-carlo"))]
mod tests {
    use super::*;
    use crate::statistics::random::Stream;

    /// Normal readings of `quantities` in several runs, rounded to a `step` in standard deviations.
    fn read<const N: usize>(stream: &mut Stream, [quantities, runs]: [usize; 2], step: f64) -> Vec<Vec<[f64; N]>> {
        let reading = |stream: &mut Stream| [(); N].map(|()| (stream.normal() / step).round() * step);
        (0..quantities).map(|_| (0..runs).map(|_| reading(stream)).collect()).collect()
    }

    /// Independent readings are not copies, with fine and with coarse steps. The bound on the probability is far from reached,
    /// so that none of 6,000 sets may be.
    #[test]
    fn independent_readings_are_no_copies() {
        let mut stream = Stream::new(51);
        for step in [1e-3, 0.1, 0.3, 1.0, 3.0, 10.0] {
            for _ in 0..500 {
                assert_eq!(copies(&read::<3>(&mut stream, [8, 5], step)), []);
                assert_eq!(copies(&read::<2>(&mut stream, [8, 3], step)), []);
            }
        }
    }

    /// Means of two rows have no last digit; on a coarse grid they are often identical all the same.
    #[test]
    fn means_of_coarse_readings_are_no_copies() {
        let mut stream = Stream::new(53);
        for step in [0.3, 1.0, 3.0] {
            for _ in 0..300 {
                let rows = [(); 3].map(|()| read::<3>(&mut stream, [8, 5], step));
                let mean = |quantity: usize, run: usize| {
                    std::array::from_fn(|axis| rows.iter().map(|rows| rows[quantity][run][axis]).sum::<f64>() / 3.0)
                };
                let means: Vec<Vec<[f64; 3]>> = (0..8).map(|at| (0..5).map(|run| mean(at, run)).collect()).collect();
                assert_eq!(copies(&means), []);
            }
        }
    }

    /// Two readings of run 1 that stand again in run 4 are found, each with its first place.
    #[test]
    fn copies_are_found_at_their_places() {
        let mut stream = Stream::new(52);
        for _ in 0..100 {
            let mut angles = read::<3>(&mut stream, [8, 5], 1e-3);
            (angles[2][3], angles[6][3]) = (angles[2][0], angles[6][0]);
            let copy = |quantity| Coincidence { quantity, reading: 3, earlier: 0 };
            assert_eq!(copies(&angles), [copy(2), copy(6)]);
            let mut currents = read::<2>(&mut stream, [8, 3], 1e-3);
            currents.iter_mut().for_each(|readings| readings[2] = readings[1]);
            assert_eq!(copies(&currents).len(), 8);
        }
    }
}
