//! Analytic method ([the paper](crate::bibliography::Bibliography::Tang17), eq. (8), (13)-(16)).

use crate::coefficients::{Coefficients, Matrices, pair_differences};
use crate::gyro::GyroParameters;
use nalgebra::{Matrix2, Vector2};

/// Solution by the analytic method: ω_n as the four numbers of (15), and the parameters of (2) computed from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct AnalyticSolution {
    /// Parameters K, ω_0, ω_g and ω_k (paper, eq. (8), (13), (14), (16)).
    pub parameters: GyroParameters,
    /// ω_n, °/(h·g), 2×2, four independent numbers (paper, eq. (15)).
    pub omega_n_deg_per_h_per_g: Matrix2<f64>,
}

/// Reason why the analytic method gives no result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoAnalyticSolution {
    /// Some of the paper's eight positions have no currents, and the method requires all of them.
    #[error(
        "some of the eight positions that the analytic method requires have no readings; least squares does not require them"
    )]
    EightPositionsMissing,
    /// The matrix J_1 − J_2 Δ has no inverse.
    #[error("the currents do not determine K: J_1 - J_2 Delta has no inverse")]
    SingularCurrents,
}

/// Solves for the gyro parameters: K by (13), ω_n by (15), ω_g and ω_k by (16), ω_0 by (8) as the mean over all
/// positions.
///
/// `currents_ma` contains (J_x, J_y) of `coefficients.positions`, in the same order.
pub(crate) fn solve(
    coefficients: &Coefficients,
    currents_ma: &[Vector2<f64>],
) -> Result<AnalyticSolution, NoAnalyticSolution> {
    let AnalyticMap { inverse, j2, matrices, .. } = AnalyticMap::new(coefficients, currents_ma)?;
    // K = B J_1⁻¹ (1 − J_2 Δ J_1⁻¹)⁻¹ = B (J_1 − J_2 Δ)⁻¹: J_1 itself need not have an inverse.
    let k = matrices.b_deg_per_h * inverse;
    let omega_n = matrices.c_deg_per_h_per_g - k * j2 * matrices.n2_inverse;
    let omega0 = mean_misclosure(coefficients, currents_ma, &k, &omega_n);
    Ok(AnalyticSolution::new(k, omega_n, omega0))
}

/// Returns the paper's matrices, and the places of its eight positions; `None` if one is missing, or if there is not one pair
/// of currents for each position.
pub(super) fn of_the_eight<'a>(
    coefficients: &'a Coefficients,
    currents_ma: &[Vector2<f64>],
) -> Option<(&'a Matrices, [usize; 8])> {
    let has_currents = currents_ma.len() == coefficients.positions.len();
    coefficients.matrices.as_ref().zip(coefficients.eight()).filter(|_| has_currents)
}

/// First-order response of the analytic solution to misclosures of the equations.
///
/// If the equations of position p have the misclosure e_p, (9)-(11) become δK J_1 + δω_n n_1 = e_1 and
/// δK J_2 + δω_n n_2 = e_2.
#[derive(Debug, Clone)]
pub(crate) struct AnalyticMap<'a> {
    coefficients: &'a Coefficients,
    currents_ma: &'a [Vector2<f64>],
    /// (J_1 − J_2 Δ)⁻¹.
    inverse: Matrix2<f64>,
    j2: Matrix2<f64>,
    matrices: &'a Matrices,
    /// Indices of the eight positions among all positions.
    eight: [usize; 8],
}

impl<'a> AnalyticMap<'a> {
    pub(crate) fn new(
        coefficients: &'a Coefficients,
        currents_ma: &'a [Vector2<f64>],
    ) -> Result<Self, NoAnalyticSolution> {
        let (matrices, eight) =
            of_the_eight(coefficients, currents_ma).ok_or(NoAnalyticSolution::EightPositionsMissing)?;
        let (j1, j2) = pair_differences(|position| currents_ma[eight[position]]);
        let inverse = (j1 - j2 * matrices.delta).try_inverse().ok_or(NoAnalyticSolution::SingularCurrents)?;
        Ok(Self { coefficients, currents_ma, inverse, j2, matrices, eight })
    }

    /// Returns the change of the solution for the misclosures of all positions, °/h.
    pub(crate) fn apply(&self, misclosures: &[Vector2<f64>]) -> AnalyticSolution {
        let (e1, e2) = pair_differences(|position| misclosures[self.eight[position]]);
        let k = (e1 - e2 * self.matrices.delta) * self.inverse;
        let omega_n = (e2 - k * self.j2) * self.matrices.n2_inverse;
        let each = self.coefficients.positions.iter().zip(self.currents_ma).zip(misclosures);
        let sum: Vector2<f64> =
            each.map(|((at, current), misclosure)| misclosure - k * current - omega_n * at.specific_force_g).sum();
        AnalyticSolution::new(k, omega_n, sum / misclosures.len() as f64)
    }
}

impl AnalyticSolution {
    /// Creates a solution with ω_g and ω_k computed from ω_n by (16).
    pub(super) fn new(k: Matrix2<f64>, omega_n: Matrix2<f64>, omega0: Vector2<f64>) -> Self {
        let [omega_g_deg_per_h_per_g, omega_k_deg_per_h_per_g] = g_drifts(&omega_n);
        let parameters = GyroParameters {
            k_deg_per_h_per_ma: k,
            omega0_deg_per_h: omega0,
            omega_g_deg_per_h_per_g,
            omega_k_deg_per_h_per_g,
        };
        Self { parameters, omega_n_deg_per_h_per_g: omega_n }
    }
}

/// Returns ω_g and ω_k of a given ω_n, or of a change of it (paper, eq. (16)).
pub(super) fn g_drifts(omega_n: &Matrix2<f64>) -> [f64; 2] {
    [(omega_n.m11 + omega_n.m22) / 2.0, (omega_n.m21 - omega_n.m12) / 2.0]
}

/// Returns ω_0, °/h: the mean of ω_3 − K J − ω_n n over all positions (paper, eq. (8)).
pub(crate) fn mean_misclosure(
    coefficients: &Coefficients,
    currents_ma: &[Vector2<f64>],
    k: &Matrix2<f64>,
    omega_n: &Matrix2<f64>,
) -> Vector2<f64> {
    let positions = &coefficients.positions;
    let each = positions.iter().zip(currents_ma);
    let sum: Vector2<f64> =
        each.map(|(at, current)| at.earth_rate_deg_per_h - k * current - omega_n * at.specific_force_g).sum();
    sum / positions.len() as f64
}
