//! Specific force, Earth rate and currents of every position, computed from standard deviates.
//!
//! Rotations are applied exactly: Ã = T · E(α + δα, β + δβ, γ + δγ) · A · Rz(90° − ψ) · R, where ψ is the azimuth of the
//! frame's axis, R rotates the base about east, north and up, and T the case (by the sum of the small vectors of
//! platform, seat and repeatability). A small rotation by a vector δ is exactly v + s₁ v×δ + s₂ (v×δ)×δ with
//! s₁ = sin|δ|/|δ| and s₂ = (1 − cos|δ|)/δ².

use crate::draw::Slot;
use crate::elementary::{SMALL_RAD, small_cos_less_one, small_sin};
use crate::wide_random::{Column, WIDTH};

/// Quantities of one position in every trial of a chunk.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct At {
    /// Specific force along x and y, g.
    pub n: [Column; 2],
    /// Earth rate along x and y, °/h.
    pub omega: [Column; 2],
    /// Currents of x and y, mA.
    pub current: [Column; 2],
}

/// Column of an input's deviates, with its standard uncertainty.
pub type Scaled = (Slot, f64);

/// Constants and inputs of one position.
#[derive(Debug, Clone)]
pub struct Place {
    /// Sine and cosine of the certified α, β, γ.
    pub sin_cos: [(f64, f64); 3],
    /// Certified α, β, γ, rad.
    pub certified_rad: [f64; 3],
    /// Vertical after A, which E acts on if the base does not rotate.
    pub vertical: [f64; 3],
    /// Earth rate after A, °/h.
    pub earth: [f64; 3],
    /// Matrix A, row by row.
    pub nominal: [[f64; 3]; 3],
    /// Changes of α, β, γ, rad.
    pub angles: [Scaled; 3],
    /// Repeatability about each axis, rad.
    pub returns: [Scaled; 3],
    /// Mean currents of x and y, mA.
    pub means_ma: [f64; 2],
    /// Errors of the meter, mA.
    pub currents: [Scaled; 2],
    /// Noise of the means, mA.
    pub noise: [Scaled; 2],
    /// Drift from visit to visit, °/h.
    pub visits: [Scaled; 2],
}

/// Model of all positions.
#[derive(Debug, Clone)]
pub struct Kernel {
    /// Each position.
    pub places: Vec<Place>,
    /// Rotations of the case about each axis: the part that is known, and the part estimated with few degrees of freedom.
    pub case: [[Scaled; 2]; 3],
    /// Rotations of the base about east, north and up, in the same two parts.
    pub base: [[Scaled; 2]; 3],
    /// Latitude, rad.
    pub latitude: Scaled,
    /// Gain of the meter, a fraction.
    pub gain: Scaled,
    /// Offset of the meter, mA.
    pub offset: Scaled,
    /// Drift from turn-on to turn-on about x and y, °/h.
    pub turn_on: [Scaled; 2],
    /// Scatter of K from turn-on to turn-on, row by row, °/(h mA).
    pub scale: [[Scaled; 2]; 2],
    /// `true` if the gyro's drift or K has noise.
    pub drifts: bool,
    /// Earth rate to the east, north and up, °/h.
    pub earth: [f64; 3],
    /// `true` if the case rotates in any position.
    pub case_turns: bool,
    /// `true` if the base rotates.
    pub base_turns: bool,
    /// `true` if a small angle may be beyond [`SMALL_RAD`].
    pub may_be_large: bool,
}

impl Kernel {
    /// Computes all positions from the deviates of a chunk.
    #[inline(always)]
    pub fn run(&self, deviates: &[Column], positions: &mut [At]) {
        let exact = self.may_be_large && self.has_large(deviates);
        match (exact, self.case_turns, self.base_turns) {
            (false, false, false) => self.run_as::<false, false, false>(deviates, positions),
            (false, true, false) => self.run_as::<false, true, false>(deviates, positions),
            (false, false, true) => self.run_as::<false, false, true>(deviates, positions),
            (false, true, true) => self.run_as::<false, true, true>(deviates, positions),
            (true, ..) => self.run_exactly(deviates, positions),
        }
    }

    /// Returns `true` if an angle of the chunk is beyond the range of the polynomials.
    #[inline(always)]
    fn has_large(&self, deviates: &[Column]) -> bool {
        let angles = self.places.iter().flat_map(|place| place.angles.iter().chain(&place.returns));
        let shared = self.case.as_flattened().iter().chain(self.base.as_flattened());
        let mut largest = [0.0; WIDTH];
        for (slot, u) in angles.chain(shared).chain([&self.latitude]) {
            // Unlike `f64::max`, this needs no instructions for NaN.
            for (largest, deviate) in largest.iter_mut().zip(&deviates[*slot]) {
                let size = (deviate * u).abs();
                *largest = if size > *largest { size } else { *largest };
            }
        }
        largest.iter().any(|largest| 4.0 * largest > SMALL_RAD)
    }

    /// Computes all quantities of a chunk with the sine and cosine of libm.
    #[cold]
    #[inline(never)]
    fn run_exactly(&self, deviates: &[Column], positions: &mut [At]) {
        self.run_as::<true, true, true>(deviates, positions);
    }

    #[inline(always)]
    fn run_as<const EXACT: bool, const CASE: bool, const BASE: bool>(&self, deviates: &[Column], positions: &mut [At]) {
        let base = if BASE { self.base_vectors::<EXACT>(deviates) } else { [[[0.0; WIDTH]; 3]; 2] };
        let case = if CASE { turn(&self.case, deviates) } else { [[0.0; WIDTH]; 3] };
        for (place, at) in self.places.iter().zip(positions) {
            place.vectors::<EXACT, CASE, BASE>(&case, &base, deviates, at);
            self.currents(place, deviates, at);
            if self.drifts {
                self.drift(place, deviates, at);
            }
        }
    }

    /// Returns the vertical and the Earth rate in the axes of the base as actually oriented.
    #[inline(always)]
    fn base_vectors<const EXACT: bool>(&self, deviates: &[Column]) -> [[Column; 3]; 2] {
        let [x, y, z] = turn(&self.base, deviates);
        let latitude = (&deviates[self.latitude.0], self.latitude.1);
        let mut vectors = [[[0.0; WIDTH]; 3]; 2];
        for trial in 0..WIDTH {
            let turn = [x[trial], y[trial], z[trial]];
            let (s1, s2) = turn_factors::<EXACT>(&turn);
            let (sin, less) = sin_cos_less_one::<EXACT>(latitude.1 * latitude.0[trial]);
            let [_, north, up] = self.earth;
            // ω_Γ decreases and ω_B increases with the latitude.
            let earth = [0.0, north + (north * less - up * sin), up + (up * less + north * sin)];
            let vertical = turned(&[0.0, 0.0, 1.0], &turn, s1, s2);
            let earth = turned(&earth, &turn, s1, s2);
            for axis in 0..3 {
                vectors[0][axis][trial] = vertical[axis];
                vectors[1][axis][trial] = earth[axis];
            }
        }
        vectors
    }

    /// Takes the gyro's noise from the Earth rate, which the equations have on the other side.
    #[inline(always)]
    fn drift(&self, place: &Place, deviates: &[Column], at: &mut At) {
        for axis in 0..2 {
            let [(own, u), (turn_on, u_turn_on)] =
                [place.visits[axis], self.turn_on[axis]].map(|(slot, u)| (&deviates[slot], u));
            for trial in 0..WIDTH {
                at.omega[axis][trial] -= u * own[trial] + u_turn_on * turn_on[trial];
            }
            for ((slot, u), current_ma) in
                self.scale[axis].iter().zip(&place.means_ma).filter(|((slot, _), _)| *slot > 0)
            {
                for (omega, deviate) in at.omega[axis].iter_mut().zip(&deviates[*slot]) {
                    *omega -= u * current_ma * deviate;
                }
            }
        }
    }

    #[inline(always)]
    fn currents(&self, place: &Place, deviates: &[Column], at: &mut At) {
        let (gain, offset) = (&deviates[self.gain.0], &deviates[self.offset.0]);
        for axis in 0..2 {
            let [(own, u), (noise, u_noise)] =
                [place.currents[axis], place.noise[axis]].map(|(slot, u)| (&deviates[slot], u));
            let mean = place.means_ma[axis];
            let mut current = [0.0; WIDTH];
            for trial in 0..WIDTH {
                let read = mean + (u * own[trial] + u_noise * noise[trial]);
                current[trial] = read + (read * (self.gain.1 * gain[trial]) + self.offset.1 * offset[trial]);
            }
            at.current[axis] = current;
        }
    }
}

impl Place {
    #[inline(always)]
    fn vectors<const EXACT: bool, const CASE: bool, const BASE: bool>(
        &self,
        case: &[Column; 3],
        base: &[[Column; 3]; 2],
        deviates: &[Column],
        at: &mut At,
    ) {
        let angle = |place: usize| (&deviates[self.angles[place].0], self.angles[place].1);
        let ((alpha, u_alpha), (beta, u_beta), (gamma, u_gamma)) = (angle(0), angle(1), angle(2));
        let own = self.returns.map(|(slot, u)| (&deviates[slot], u));
        let (mut n, mut omega) = ([[0.0; WIDTH]; 2], [[0.0; WIDTH]; 2]);
        for trial in 0..WIDTH {
            let a = self.changed::<EXACT>(0, u_alpha * alpha[trial]);
            let b = self.changed::<EXACT>(1, u_beta * beta[trial]);
            let g = self.changed::<EXACT>(2, u_gamma * gamma[trial]);
            let (vertical, earth) = if BASE {
                let of = |vector: &[Column; 3]| [vector[0][trial], vector[1][trial], vector[2][trial]];
                (times(&self.nominal, &of(&base[0])), times(&self.nominal, &of(&base[1])))
            } else {
                (self.vertical, self.earth)
            };
            let mut seen = [deviated(&vertical, a, b, g), deviated(&earth, a, b, g)];
            if CASE {
                let part = |axis: usize| case[axis][trial] + own[axis].1 * own[axis].0[trial];
                let turn = [part(0), part(1), part(2)];
                let (s1, s2) = turn_factors::<EXACT>(&turn);
                seen = [turned(&seen[0], &turn, s1, s2), turned(&seen[1], &turn, s1, s2)];
            }
            n[0][trial] = seen[0][0];
            n[1][trial] = seen[0][1];
            omega[0][trial] = seen[1][0];
            omega[1][trial] = seen[1][1];
        }
        at.n = n;
        at.omega = omega;
    }

    /// Returns (sin, cos) of a certified angle changed by a small one: s + (c sin δ + s (cos δ − 1)).
    #[inline(always)]
    fn changed<const EXACT: bool>(&self, angle: usize, change_rad: f64) -> (f64, f64) {
        if EXACT {
            return libm::sincos(self.certified_rad[angle] + change_rad);
        }
        let (sin, cos) = self.sin_cos[angle];
        let (small, less) = (small_sin(change_rad), small_cos_less_one(change_rad));
        (sin + (cos * small + sin * less), cos + (cos * less - sin * small))
    }
}

/// Returns the rotation common to all positions, about each axis, rad.
#[inline(always)]
fn turn(of: &[[Scaled; 2]; 3], deviates: &[Column]) -> [Column; 3] {
    of.map(|[(one, u), (other, v)]| {
        let (one, other) = (&deviates[one], &deviates[other]);
        let mut sum = [0.0; WIDTH];
        for trial in 0..WIDTH {
            sum[trial] = u * one[trial] + v * other[trial];
        }
        sum
    })
}

/// Returns E v = Rz(γ) Ry(β) Rx(α) v (paper, above eq. (4)), computed axis by axis.
#[inline(always)]
fn deviated(v: &[f64; 3], (sa, ca): (f64, f64), (sb, cb): (f64, f64), (sg, cg): (f64, f64)) -> [f64; 3] {
    let (y1, z1) = (ca * v[1] + sa * v[2], ca * v[2] - sa * v[1]);
    let (x2, z2) = (cb * v[0] - sb * z1, sb * v[0] + cb * z1);
    [cg * x2 + sg * y1, cg * y1 - sg * x2, z2]
}

#[inline(always)]
fn times([x, y, z]: &[[f64; 3]; 3], v: &[f64; 3]) -> [f64; 3] {
    let row = |row: &[f64; 3]| row[0] * v[0] + row[1] * v[1] + row[2] * v[2];
    [row(x), row(y), row(z)]
}

#[inline(always)]
fn cross(v: &[f64; 3], d: &[f64; 3]) -> [f64; 3] {
    [v[1] * d[2] - v[2] * d[1], v[2] * d[0] - v[0] * d[2], v[0] * d[1] - v[1] * d[0]]
}

/// Returns the coordinates of v after a rotation by the vector δ.
#[inline(always)]
fn turned(v: &[f64; 3], turn: &[f64; 3], s1: f64, s2: f64) -> [f64; 3] {
    let once = cross(v, turn);
    let twice = cross(&once, turn);
    [
        v[0] + (s1 * once[0] + s2 * twice[0]),
        v[1] + (s1 * once[1] + s2 * twice[1]),
        v[2] + (s1 * once[2] + s2 * twice[2]),
    ]
}

/// Returns sin|δ|/|δ| and (1 − cos|δ|)/δ².
#[inline(always)]
fn turn_factors<const EXACT: bool>(turn: &[f64; 3]) -> (f64, f64) {
    let square = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2];
    if EXACT && square > SMALL_RAD * SMALL_RAD {
        let angle = square.sqrt();
        let (sin, cos) = libm::sincos(angle);
        return (sin / angle, (1.0 - cos) / square);
    }
    // For |δ| ≤ 0.02 the omitted terms are at most 8e-20 of s1 and 1e-17 of s2.
    let s1 = 1.0 + square * (-1.0 / 6.0 + square * (1.0 / 120.0 + square * (-1.0 / 5040.0)));
    let s2 = 0.5 + square * (-1.0 / 24.0 + square * (1.0 / 720.0));
    (s1, s2)
}

#[inline(always)]
fn sin_cos_less_one<const EXACT: bool>(x: f64) -> (f64, f64) {
    if EXACT && x.abs() > SMALL_RAD {
        let (sin, cos) = libm::sincos(x);
        return (sin, cos - 1.0);
    }
    (small_sin(x), small_cos_less_one(x))
}
