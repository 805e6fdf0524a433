//! The paper's coefficients and its analytic solution in every trial of a chunk (paper, eq. (8)-(16)), with 2×2
//! matrices written out.

use crate::Solutions;
use crate::kernel::At;
use crate::wide_random::WIDTH;

/// 2×2 matrix, row by row.
type M2 = [f64; 4];

#[inline(always)]
fn times(a: &M2, b: &M2) -> M2 {
    [a[0] * b[0] + a[1] * b[2], a[0] * b[1] + a[1] * b[3], a[2] * b[0] + a[3] * b[2], a[2] * b[1] + a[3] * b[3]]
}

#[inline(always)]
fn minus(a: &M2, b: &M2) -> M2 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]]
}

#[inline(always)]
fn inverse(a: &M2) -> M2 {
    let factor = 1.0 / (a[0] * a[3] - a[1] * a[2]);
    [a[3] * factor, -a[1] * factor, -a[2] * factor, a[0] * factor]
}

/// Solves for the parameters of every trial; `eight` are the places of the eight positions.
#[inline(always)]
pub fn solve(eight: &[usize; 8], positions: &[At], solutions: &mut Solutions) {
    let e = eight.map(|place| &positions[place]);
    let mut found = [[0.0; WIDTH]; 8];
    // Sums over all positions, for eq. (8).
    let mut sums = [[0.0; WIDTH]; 6];
    for at in positions {
        for trial in 0..WIDTH {
            for axis in 0..2 {
                sums[axis][trial] += at.omega[axis][trial];
                sums[2 + axis][trial] += at.current[axis][trial];
                sums[4 + axis][trial] += at.n[axis][trial];
            }
        }
    }
    let share = 1.0 / positions.len() as f64;
    for trial in 0..WIDTH {
        let n1 = pair(trial, |at, axis| &at.n[axis], [e[0], e[2], e[1], e[3]]);
        let n2 = pair(trial, |at, axis| &at.n[axis], [e[4], e[6], e[5], e[7]]);
        let w1 = pair(trial, |at, axis| &at.omega[axis], [e[0], e[2], e[1], e[3]]);
        let w2 = pair(trial, |at, axis| &at.omega[axis], [e[4], e[6], e[5], e[7]]);
        let j1 = pair(trial, |at, axis| &at.current[axis], [e[0], e[2], e[1], e[3]]);
        let j2 = pair(trial, |at, axis| &at.current[axis], [e[4], e[6], e[5], e[7]]);
        let n2_inverse = inverse(&n2);
        let delta = times(&n2_inverse, &n1);
        let b = minus(&w1, &times(&w2, &delta));
        let k = times(&b, &inverse(&minus(&j1, &times(&j2, &delta))));
        let omega_n = times(&minus(&w2, &times(&k, &j2)), &n2_inverse);
        let sum = |quantity: usize| sums[quantity][trial];
        for place in 0..4 {
            found[place][trial] = k[place];
        }
        for axis in 0..2 {
            let row = 2 * axis;
            let balanced = k[row] * sum(2) + k[row + 1] * sum(3) + omega_n[row] * sum(4) + omega_n[row + 1] * sum(5);
            found[4 + axis][trial] = (sum(axis) - balanced) * share;
        }
        found[6][trial] = 0.5 * (omega_n[0] + omega_n[3]);
        found[7][trial] = 0.5 * (omega_n[2] - omega_n[1]);
    }
    *solutions = found;
}

/// Returns the 2×2 matrix with the columns p − q and r − s.
#[inline(always)]
fn pair<'a>(
    trial: usize,
    of: impl Fn(&'a At, usize) -> &'a crate::wide_random::Column,
    [p, q, r, s]: [&'a At; 4],
) -> M2 {
    let difference = |one: &'a At, other: &'a At, axis: usize| of(one, axis)[trial] - of(other, axis)[trial];
    [difference(p, q, 0), difference(r, s, 0), difference(p, q, 1), difference(r, s, 1)]
}
