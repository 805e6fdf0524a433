//! Many random numbers at a time, from interleaved streams that the compiler can vectorise.
//!
//! Eight xoshiro256++ generators run side by side. Generator k of block n is k long jumps (2^192 numbers each) and n
//! jumps (2^128 each) from the seed. No two ever overlap, and block n has the same numbers whichever thread computes
//! it. Only whole numbers, sums, products, quotients and square roots are used, so every platform gives the same bytes.
//!
//! Source: [Blackman and Vigna](crate::bibliography::Bibliography::Xoshiro), their generator and jump
//! polynomials; [Box and Muller](crate::bibliography::Bibliography::BoxMuller58).

use super::elementary::{ln, on_circle};
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

/// Number of generators that run side by side.
const GENERATORS: usize = 8;

/// Number of trials that run side by side.
pub(crate) const WIDTH: usize = 32;

/// Column of numbers, one for each of the trials that run side by side.
pub(crate) type Column = [f64; WIDTH];

/// Random numbers of one block of trials.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct WideRandom {
    state: [[u64; GENERATORS]; 4],
}

/// Bits of 1.0; with 52 random bits in the mantissa the number is uniform in [1, 2).
const ONE: u64 = 0x3ff0_0000_0000_0000;

impl WideRandom {
    /// Creates block 0 of a seed.
    pub(crate) fn new(seed: u64) -> Self {
        let mut words = SplitMix64::seed_from_u64(seed);
        let mut state = [(); 4].map(|()| [words.next_u64(); GENERATORS]);
        for from in 1..GENERATORS {
            let mut rest = Self { state };
            rest.ahead(&LONG_JUMP);
            for (word, ahead) in state.iter_mut().zip(rest.state) {
                word[from..].copy_from_slice(&ahead[from..]);
            }
        }
        Self { state }
    }

    pub(crate) fn jump(&mut self) {
        self.ahead(&JUMP);
    }

    /// Advances all generators by the jump with the given polynomial.
    fn ahead(&mut self, polynomial: &[u64; 4]) {
        let mut sum = [[0; GENERATORS]; 4];
        for word in polynomial {
            for bit in 0..64 {
                if word >> bit & 1 == 1 {
                    for (sum, state) in sum.iter_mut().flatten().zip(self.state.iter().flatten()) {
                        *sum ^= state;
                    }
                }
                self.next();
            }
        }
        self.state = sum;
    }

    #[inline(always)]
    fn next(&mut self) -> [u64; GENERATORS] {
        let [s0, s1, s2, s3] = &mut self.state;
        let mut numbers = [0; GENERATORS];
        for lane in 0..GENERATORS {
            numbers[lane] = s0[lane].wrapping_add(s3[lane]).rotate_left(23).wrapping_add(s0[lane]);
            let shifted = s1[lane] << 17;
            s2[lane] ^= s0[lane];
            s3[lane] ^= s1[lane];
            s1[lane] ^= s2[lane];
            s0[lane] ^= s3[lane];
            s2[lane] ^= shifted;
            s3[lane] = s3[lane].rotate_left(45);
        }
        numbers
    }

    #[inline(always)]
    fn bits(&mut self) -> [u64; WIDTH] {
        let mut bits = [0; WIDTH];
        for group in bits.chunks_exact_mut(GENERATORS) {
            group.copy_from_slice(&self.next());
        }
        bits
    }

    /// Fills `column` with uniform numbers in [-1, 1), 52 bits each.
    #[inline(always)]
    pub(crate) fn uniform(&mut self, column: &mut Column) {
        let bits = self.bits();
        for (value, bits) in column.iter_mut().zip(&bits) {
            *value = 2.0 * f64::from_bits((bits >> 12) | ONE) - 3.0;
        }
    }

    /// Fills two columns with standard normal numbers; none is beyond ±8.5.
    #[inline(always)]
    pub(crate) fn normals(&mut self, one: &mut Column, other: &mut Column) {
        let (of_radius, of_angle) = (self.bits(), self.bits());
        let (mut first, mut second) = ([0.0; WIDTH], [0.0; WIDTH]);
        for trial in 0..WIDTH {
            // In (0, 1], so that the logarithm is finite.
            let share = 2.0 - f64::from_bits((of_radius[trial] >> 12) | ONE);
            let radius = (-2.0 * ln(share)).sqrt();
            // The upper 52 bits give the place in an octant, the lowest 3 bits the octant.
            let angle = f64::from_bits((of_angle[trial] >> 12) | ONE) - 1.0;
            let (sin, cos) = on_circle(angle, of_angle[trial]);
            first[trial] = radius * cos;
            second[trial] = radius * sin;
        }
        *one = first;
        *other = second;
    }
}

const JUMP: [u64; 4] = [0x180e_c6d3_3cfd_0aba, 0xd5a6_1266_f0c9_392c, 0xa958_2618_e03f_c9aa, 0x39ab_dc45_29b1_661c];
const LONG_JUMP: [u64; 4] =
    [0x76e1_5d3e_fefd_cbbf, 0xc500_4e44_1c52_2fb3, 0x7771_0069_854e_e241, 0x3910_9bb0_2acb_e635];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::distributions::normal_below;
    use rand_xoshiro::Xoshiro256PlusPlus;

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
                assert_eq!(lanes.next().to_vec(), numbers);
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
}
