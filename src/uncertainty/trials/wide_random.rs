//! Many random numbers at a time, from interleaved streams that the compiler can vectorise.
//!
//! Eight xoshiro256++ generators run side by side. Generator k of block n is k long jumps (2^192 numbers each) and n
//! jumps (2^128 each) from the seed. No two ever overlap, and block n has the same numbers whichever thread computes
//! it. Only whole numbers, sums, products, quotients and square roots are used, so every platform gives the same bytes.
//!
//! Source: Blackman and Vigna, their generator and jump polynomials; Box and Muller.

use crate::elementary::{ln, on_circle};
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

/// Number of generators that run side by side.
pub const GENERATORS: usize = 8;

/// Number of trials that run side by side.
pub const WIDTH: usize = 32;

/// Column of numbers, one for each of the trials that run side by side.
pub type Column = [f64; WIDTH];

/// Random numbers of one block of trials.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WideRandom {
    state: [[u64; GENERATORS]; 4],
}

/// Bits of 1.0; with 52 random bits in the mantissa the number is uniform in [1, 2).
const ONE: u64 = 0x3ff0_0000_0000_0000;

impl WideRandom {
    /// Creates block 0 of a seed.
    pub fn new(seed: u64) -> Self {
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

    /// Advances to the next block.
    pub fn jump(&mut self) {
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
                self.next_numbers();
            }
        }
        self.state = sum;
    }

    /// Returns the next number of every generator.
    #[inline(always)]
    pub fn next_numbers(&mut self) -> [u64; GENERATORS] {
        let [mut s0, mut s1, mut s2, mut s3] = self.state;
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
        self.state = [s0, s1, s2, s3];
        numbers
    }

    #[inline(always)]
    fn bits(&mut self) -> [u64; WIDTH] {
        let mut bits = [0; WIDTH];
        for group in bits.chunks_exact_mut(GENERATORS) {
            group.copy_from_slice(&self.next_numbers());
        }
        bits
    }

    /// Fills `column` with uniform numbers in [-1, 1), 52 bits each.
    #[inline(always)]
    pub fn uniform(&mut self, column: &mut Column) {
        let bits = self.bits();
        for (value, bits) in column.iter_mut().zip(&bits) {
            *value = 2.0 * f64::from_bits((bits >> 12) | ONE) - 3.0;
        }
    }

    /// Fills two columns with standard normal numbers; none is beyond ±8.5.
    #[inline(always)]
    pub fn normals(&mut self, one: &mut Column, other: &mut Column) {
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
