//! Weighted least squares in every trial of a chunk.
//!
//! The estimator is that of a calibration with the weights of its best fit. The
//! regressors are the currents that the solution gives, so each step uses the currents of the step before. The normal
//! equations are solved for the change from the best fit, so they lose only digits of a small number. Their matrix is
//! that of the first step; its change from step to step has only a third-order effect.

use crate::kernel::At;
use crate::wide_random::{Column, WIDTH};
use crate::{PAIRS, Solutions, pair};

/// Number of steps from the best fit; the remaining error is of third order in the uncertainties.
const STEPS: usize = 2;

/// Least-squares solver, with the best fit and its weights.
#[derive(Debug, Clone)]
pub struct Refit {
    /// Parameters of the best fit: K_x, K_xy, K_yx, K_y, ω_0x, ω_0y, ω_g, ω_k.
    pub start: [f64; 8],
    /// Weights P = W'W of every position: p11, p12, p22.
    pub weights: Vec<[f64; 3]>,
}

impl Refit {
    /// Computes the parameters of every trial.
    #[inline(always)]
    pub fn solve(&self, positions: &[At], solutions: &mut Solutions) {
        let mut parameters = self.start.map(|value| [value; WIDTH]);
        let mut normal = [[0.0; WIDTH]; PAIRS];
        for (at, weight) in positions.iter().zip(&self.weights) {
            add_normal(at, weight, &parameters, &mut normal);
        }
        factorise(&mut normal);
        for _ in 0..STEPS {
            let mut right = [[0.0; WIDTH]; 8];
            for (at, weight) in positions.iter().zip(&self.weights) {
                add_right(at, weight, &parameters, &mut right);
            }
            substitute(&normal, &mut right);
            for (value, step) in parameters.iter_mut().zip(&right) {
                for trial in 0..WIDTH {
                    value[trial] += step[trial];
                }
            }
        }
        *solutions = parameters;
    }
}

/// Returns the rate that the torquers balance in a position, ω_3 − ω_0 − ω_n n, and the currents for it by the
/// parameters.
#[inline(always)]
fn balance(at: &At, trial: usize, parameters: &Solutions) -> ([f64; 2], [f64; 2]) {
    // Not `map` over the columns: it may be called instead of inlined, and then the loop over the trials is not wide.
    let [kx, kxy, kyx, ky, o_x, o_y, w_g, w_k] = parameters;
    let (kx, kxy, kyx, ky) = (kx[trial], kxy[trial], kyx[trial], ky[trial]);
    let (o_x, o_y, w_g, w_k) = (o_x[trial], o_y[trial], w_g[trial], w_k[trial]);
    let (nx, ny) = (at.n[0][trial], at.n[1][trial]);
    let x = at.omega[0][trial] - o_x - (w_g * nx - w_k * ny);
    let y = at.omega[1][trial] - o_y - (w_k * nx + w_g * ny);
    let factor = 1.0 / (kx * ky - kxy * kyx);
    ([x, y], [(ky * x - kxy * y) * factor, (kx * y - kyx * x) * factor])
}

/// Adds X'P X of one position, where X has the rows (j_x, j_y, 0, 0, 1, 0, n_x, −n_y) and (0, 0, j_x, j_y, 0, 1, n_y,
/// n_x) with the currents j that the parameters give.
#[inline(always)]
fn add_normal(at: &At, &[p11, p12, p22]: &[f64; 3], parameters: &Solutions, normal: &mut [Column; PAIRS]) {
    for trial in 0..WIDTH {
        let (_, [jx, jy]) = balance(at, trial, parameters);
        let (nx, ny) = (at.n[0][trial], at.n[1][trial]);
        let (xx, xy, yy) = (jx * jx, jx * jy, jy * jy);
        // P times the columns of ω_g and of ω_k.
        let (g1, g2) = (p11 * nx + p12 * ny, p12 * nx + p22 * ny);
        let (k1, k2) = (p12 * nx - p11 * ny, p22 * nx - p12 * ny);
        #[rustfmt::skip]
        let triangle = [
            p11 * xx,
            p11 * xy, p11 * yy,
            p12 * xx, p12 * xy, p22 * xx,
            p12 * xy, p12 * yy, p22 * xy, p22 * yy,
            p11 * jx, p11 * jy, p12 * jx, p12 * jy, p11,
            p12 * jx, p12 * jy, p22 * jx, p22 * jy, p12, p22,
            jx * g1, jy * g1, jx * g2, jy * g2, g1, g2, nx * g1 + ny * g2,
            jx * k1, jy * k1, jx * k2, jy * k2, k1, k2, nx * k1 + ny * k2, nx * k2 - ny * k1,
        ];
        for (element, value) in triangle.into_iter().enumerate() {
            normal[element][trial] += value;
        }
    }
}

/// Adds X'P e of one position, where e are the misclosures.
#[inline(always)]
fn add_right(at: &At, &[p11, p12, p22]: &[f64; 3], parameters: &Solutions, right: &mut Solutions) {
    for trial in 0..WIDTH {
        let ([torqued_x, torqued_y], [jx, jy]) = balance(at, trial, parameters);
        let [kx, kxy, kyx, ky, ..] = parameters;
        let (read_x, read_y) = (at.current[0][trial], at.current[1][trial]);
        let error_x = torqued_x - (kx[trial] * read_x + kxy[trial] * read_y);
        let error_y = torqued_y - (kyx[trial] * read_x + ky[trial] * read_y);
        let (e1, e2) = (p11 * error_x + p12 * error_y, p12 * error_x + p22 * error_y);
        let (nx, ny) = (at.n[0][trial], at.n[1][trial]);
        let errors = [jx * e1, jy * e1, jx * e2, jy * e2, e1, e2, nx * e1 + ny * e2, nx * e2 - ny * e1];
        for (element, value) in errors.into_iter().enumerate() {
            right[element][trial] += value;
        }
    }
}

/// Computes L of N = L L' in place, with the reciprocals of its diagonal on the diagonal.
#[inline(always)]
fn factorise(normal: &mut [Column; PAIRS]) {
    for row in 0..8 {
        for column in 0..=row {
            let mut sum = normal[pair(row, column)];
            for inner in 0..column {
                let (one, other) = (&normal[pair(row, inner)], &normal[pair(column, inner)]);
                for trial in 0..WIDTH {
                    sum[trial] -= one[trial] * other[trial];
                }
            }
            if column < row {
                let diagonal = &normal[pair(column, column)];
                for trial in 0..WIDTH {
                    sum[trial] *= diagonal[trial];
                }
            } else {
                for value in &mut sum {
                    *value = 1.0 / value.sqrt();
                }
            }
            normal[pair(row, column)] = sum;
        }
    }
}

/// Solves L L' x = b in place.
#[inline(always)]
fn substitute(lower: &[Column; PAIRS], right: &mut [Column; 8]) {
    for row in 0..8 {
        let mut sum = right[row];
        for inner in 0..row {
            for trial in 0..WIDTH {
                sum[trial] -= lower[pair(row, inner)][trial] * right[inner][trial];
            }
        }
        for trial in 0..WIDTH {
            sum[trial] *= lower[pair(row, row)][trial];
        }
        right[row] = sum;
    }
    for row in (0..8).rev() {
        let mut sum = right[row];
        for inner in row + 1..8 {
            for trial in 0..WIDTH {
                sum[trial] -= lower[pair(inner, row)][trial] * right[inner][trial];
            }
        }
        for trial in 0..WIDTH {
            sum[trial] *= lower[pair(row, row)][trial];
        }
        right[row] = sum;
    }
}
