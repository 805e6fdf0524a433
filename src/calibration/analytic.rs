//! The paper's closed solution ([the paper](crate::bibliography::Bibliography::Tang17), eq. (8), (13)-(16)).

use crate::coefficients::{Coefficients, EIGHT_POSITIONS, pair_differences};
use crate::gyro::GyroParameters;
use nalgebra::{Matrix2, Vector2};

/// What the closed solution gives: ω_n as the four numbers of (15), and the parameters of (2) in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnalyticSolution {
    /// K, ω_0, ω_g and ω_k (paper, eq. (8), (13), (14), (16)).
    pub parameters: GyroParameters,
    /// ω_n, 2×2, four free numbers (paper, eq. (15)).
    pub omega_n_deg_per_h_per_g: Matrix2<f64>,
}

/// Why there is no closed solution.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NoAnalyticSolution {
    /// The method is for the paper's eight positions.
    #[error("the stand has not all of the eight positions that the analytic method needs")]
    EightPositionsMissing,
    /// The number of current pairs is not that of the positions.
    #[error("{found} pairs of currents for {expected} positions")]
    WrongNumberOfCurrents {
        /// Pairs of currents given.
        found: usize,
        /// Positions of the stand.
        expected: usize,
    },
    /// J_1 − J_2 Δ has no inverse.
    #[error("the currents do not determine K: J_1 - J_2 Delta has no inverse")]
    SingularCurrents,
}

/// Solves for the gyro: K by (13), ω_n by (15), ω_g and ω_k by (16), ω_0 by (8) as the mean over all positions.
///
/// `currents_ma` are (J_x, J_y) of `coefficients.positions`, in the same order.
///
/// # Errors
/// See [`NoAnalyticSolution`].
pub fn solve(
    coefficients: &Coefficients,
    currents_ma: &[Vector2<f64>],
) -> Result<AnalyticSolution, NoAnalyticSolution> {
    let positions = &coefficients.positions;
    if currents_ma.len() != positions.len() {
        let (found, expected) = (currents_ma.len(), positions.len());
        return Err(NoAnalyticSolution::WrongNumberOfCurrents { found, expected });
    }
    let matrices = coefficients.matrices.as_ref().ok_or(NoAnalyticSolution::EightPositionsMissing)?;
    let (j1, j2) = current_differences(coefficients, currents_ma).ok_or(NoAnalyticSolution::EightPositionsMissing)?;
    // K = B J_1⁻¹ (1 − J_2 Δ J_1⁻¹)⁻¹ = B (J_1 − J_2 Δ)⁻¹: J_1 itself need not have an inverse.
    let inverse = (j1 - j2 * matrices.delta).try_inverse().ok_or(NoAnalyticSolution::SingularCurrents)?;
    let k = matrices.b_deg_per_h * inverse;
    let omega_n = matrices.c_deg_per_h_per_g - k * j2 * matrices.n2_inverse;
    let sum: Vector2<f64> = positions
        .iter()
        .zip(currents_ma)
        .map(|(at, current)| at.earth_rate_deg_per_h - k * current - omega_n * at.specific_force_g)
        .sum();
    let parameters = GyroParameters {
        k_deg_per_h_per_ma: k,
        omega0_deg_per_h: sum / positions.len() as f64,
        omega_g_deg_per_h_per_g: (omega_n.m11 + omega_n.m22) / 2.0,
        omega_k_deg_per_h_per_g: (omega_n.m21 - omega_n.m12) / 2.0,
    };
    Ok(AnalyticSolution { parameters, omega_n_deg_per_h_per_g: omega_n })
}

/// J_1 and J_2, the differences of the currents of the paper's eight positions (eq. (11)).
fn current_differences(
    coefficients: &Coefficients,
    currents_ma: &[Vector2<f64>],
) -> Option<(Matrix2<f64>, Matrix2<f64>)> {
    let mut eight = [Vector2::zeros(); 8];
    for (slot, (index, _, _)) in eight.iter_mut().zip(EIGHT_POSITIONS) {
        let place = coefficients.positions.iter().position(|at| at.index == index)?;
        *slot = *currents_ma.get(place)?;
    }
    Some(pair_differences(|position| eight[position]))
}
