//! Iterative method ([the paper](crate::bibliography::Bibliography::Tang17), eq. (17)-(19)).
//!
//! A step is K_λ = B J_1⁻¹ + K_{λ−1} T with T = J_2 Δ J_1⁻¹. The iteration therefore converges if and only if the
//! spectral radius ρ(T) < 1, and its fixed point is the analytic solution (13). After any step the remainder is exactly
//! (K_λ − K_{λ−1}) T (1 − T)⁻¹. The size of a step is not a bound of the remainder, because T is not normal.

use super::analytic::{AnalyticSolution, g_drifts, mean_misclosure, of_the_eight};
use crate::coefficients::{Coefficients, Matrices, pair_differences};
use crate::gyro::GyroParameters;
use nalgebra::{Matrix2, Vector2};
use serde::{Deserialize, Serialize};

/// Maximum number of steps; a longer iteration counts as not converged.
pub(crate) const LARGEST_NUMBER_OF_STEPS: u32 = 200;

/// Stop rule of the iteration: the paper's Δ₁ and Δ₂.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "struct StopRuleDocument")]
pub struct StopRule {
    /// Δ₁: largest change of K_x and K_y in the last step, percent.
    pub delta1_percent: f64,
    /// Δ₂: largest change of ω_g and ω_k in the last step, °/(h·g) (the paper says °/h).
    pub delta2_deg_per_h: f64,
}

impl Default for StopRule {
    /// Returns the paper's values: 0.1 % and 0.001 °/h.
    fn default() -> Self {
        Self { delta1_percent: 0.1, delta2_deg_per_h: 0.001 }
    }
}

/// Reason why the iterative method gives no result.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoIterativeSolution {
    /// Some of the paper's eight positions have no currents, and the method requires all of them.
    #[error(
        "some of the eight positions that the iterative method requires have no readings; use least squares, which \
             takes any positions"
    )]
    EightPositionsMissing,
    /// The matrix J_1 has no inverse, so there is no first approximation.
    #[error("there is no first approximation, because J_1 has no inverse; use the analytic method or least squares")]
    SingularCurrents,
    /// Divergence: ρ(T) ≥ 1.
    #[error(
        "the iterative method diverges: the spectral radius is {0:.4}, but must be below 1; use the \
         analytic method or least squares"
    )]
    Diverges(f64),
    /// No convergence after 200 steps, with this ρ(T).
    #[error(
        "the iterative method did not converge in {LARGEST_NUMBER_OF_STEPS} steps (spectral radius \
         {0:.4}); use the analytic method or least squares"
    )]
    TooManySteps(f64),
}

/// Change in one step of the parameters that the stop rule compares.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "struct ChangeDocument")]
#[doc(hidden)]
pub struct StepChange {
    /// Number of the step; the first approximation is step 1.
    pub step: u32,
    /// Larger change of K_x and K_y, percent of the value.
    pub main_scale_factors_percent: f64,
    /// Larger change of ω_g and ω_k, °/(h·g).
    pub g_drifts_deg_per_h_per_g: f64,
}

/// Solution by the iterative method, with the course of the iteration.
#[derive(Debug, Clone, PartialEq)]
#[doc(hidden)]
pub struct IterativeSolution {
    /// Parameters K, ω_0, ω_g and ω_k at the last step.
    pub parameters: GyroParameters,
    /// ω_n at the last step, °/(h·g), 2×2, four independent numbers.
    pub omega_n_deg_per_h_per_g: Matrix2<f64>,
    /// Number of steps; the first approximation counts as 1.
    pub steps: u32,
    /// Changes of the parameters in each step after the first approximation.
    pub changes: Vec<StepChange>,
    /// Spectral radius ρ(T), known before the first step.
    pub spectral_radius: f64,
    /// Last change of K, K_λ − K_{λ−1}, °/(h·mA), 2×2.
    pub last_change_k_deg_per_h_per_ma: Matrix2<f64>,
    /// Exact remainder of K, (K_λ − K_{λ−1}) T (1 − T)⁻¹, by which the analytic solution differs from the last step,
    /// °/(h·mA), 2×2.
    pub remainder_k_deg_per_h_per_ma: Matrix2<f64>,
    /// Exact remainder of ω_n, °/(h·g), 2×2.
    pub remainder_omega_n_deg_per_h_per_g: Matrix2<f64>,
}

/// Quantities of the iteration that are known before the first step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Plan {
    /// K_(1) = ω_31 J_1⁻¹ (paper, eq. (17)).
    first_k: Matrix2<f64>,
    j1_inverse: Matrix2<f64>,
    /// J_2 n_2⁻¹.
    j2_per_n2: Matrix2<f64>,
    /// T = J_2 Δ J_1⁻¹.
    t: Matrix2<f64>,
    matrices: Matrices,
}

impl Plan {
    /// Creates the plan from the currents (J_x, J_y) of `coefficients.positions`, mA, in the same order.
    pub(crate) fn new(coefficients: &Coefficients, currents_ma: &[Vector2<f64>]) -> Result<Self, NoIterativeSolution> {
        let eight = of_the_eight(coefficients, currents_ma);
        let (&matrices, eight) = eight.ok_or(NoIterativeSolution::EightPositionsMissing)?;
        let (j1, j2) = pair_differences(|position| currents_ma[eight[position]]);
        let j1_inverse = j1.try_inverse().ok_or(NoIterativeSolution::SingularCurrents)?;
        let plan = Self {
            first_k: matrices.omega1_deg_per_h * j1_inverse,
            j1_inverse,
            j2_per_n2: j2 * matrices.n2_inverse,
            t: j2 * matrices.delta * j1_inverse,
            matrices,
        };
        let finite = plan.t.iter().chain(plan.first_k.iter()).all(|x| x.is_finite());
        if finite { Ok(plan) } else { Err(NoIterativeSolution::SingularCurrents) }
    }

    /// Returns ρ(T). The method converges if it is below 1; each step then leaves about this fraction of the error.
    pub(crate) fn spectral_radius(&self) -> f64 {
        let half_trace = 0.5 * (self.t.m11 + self.t.m22);
        let half_difference = 0.5 * (self.t.m11 - self.t.m22);
        // The eigenvalues are half_trace ± √discriminant. If they are complex, the determinant is their squared
        // modulus.
        let discriminant = half_difference * half_difference + self.t.m12 * self.t.m21;
        if discriminant < 0.0 {
            return (half_trace * half_trace - discriminant).sqrt();
        }
        half_trace.abs() + discriminant.sqrt()
    }

    /// Returns ω_n for a given K (paper, eq. (18)).
    fn omega_n(&self, k: &Matrix2<f64>) -> Matrix2<f64> {
        self.matrices.c_deg_per_h_per_g - k * self.j2_per_n2
    }

    /// Returns the next K for the last ω_n (paper, eq. (19)).
    fn next_k(&self, omega_n: &Matrix2<f64>) -> Matrix2<f64> {
        self.first_k - omega_n * self.matrices.n1 * self.j1_inverse
    }

    /// Iterates until the rule is met, and returns the last step, or `None` if 200 steps are not enough.
    fn run(&self, rule: &StopRule, mut watch: impl FnMut(StepChange)) -> Option<LastStep> {
        let (mut k, mut omega_n) = (self.first_k, self.omega_n(&self.first_k));
        for step in 2..=LARGEST_NUMBER_OF_STEPS {
            let next_k = self.next_k(&omega_n);
            let next_omega_n = self.omega_n(&next_k);
            let (change, change_omega_n) = (next_k - k, next_omega_n - omega_n);
            (k, omega_n) = (next_k, next_omega_n);
            let moved = StepChange::new(step, &k, &change, &change_omega_n);
            watch(moved);
            if moved.meets(rule) {
                return Some(LastStep { k, omega_n, change, steps: step });
            }
        }
        None
    }

    /// Returns the number of steps until the rule is met, or `None` if 200 are not enough.
    pub(crate) fn steps(&self, rule: &StopRule) -> Option<u32> {
        self.run(rule, |_| ()).map(|last| last.steps)
    }
}

struct LastStep {
    k: Matrix2<f64>,
    omega_n: Matrix2<f64>,
    /// K_λ − K_{λ−1}.
    change: Matrix2<f64>,
    steps: u32,
}

impl StepChange {
    fn new(step: u32, k: &Matrix2<f64>, change: &Matrix2<f64>, change_omega_n: &Matrix2<f64>) -> Self {
        let [omega_g, omega_k] = g_drifts(change_omega_n);
        // A value that passes through 0 changes by more than any percentage, but JSON needs finite numbers.
        let percent = |change: f64, value: f64| match change {
            0.0 => 0.0,
            change => (100.0 * (change / value).abs()).min(f64::MAX),
        };
        Self {
            step,
            main_scale_factors_percent: percent(change.m11, k.m11).max(percent(change.m22, k.m22)),
            g_drifts_deg_per_h_per_g: omega_g.abs().max(omega_k.abs()),
        }
    }

    /// Returns `true` if the paper's stop rule (under eq. (19)) is met.
    fn meets(&self, rule: &StopRule) -> bool {
        self.main_scale_factors_percent <= rule.delta1_percent && self.g_drifts_deg_per_h_per_g <= rule.delta2_deg_per_h
    }
}

/// Solves for the gyro parameters by the iterative method, with ω_0 from (8).
///
/// `currents_ma` contains (J_x, J_y) of `coefficients.positions`, in the same order.
///
/// # Errors
/// Returns [`NoIterativeSolution`] if the eight positions are incomplete, the number of currents is wrong, J_1 is
/// singular, or the iteration does not converge.
#[doc(hidden)]
pub fn solve(
    coefficients: &Coefficients,
    currents_ma: &[Vector2<f64>],
    rule: &StopRule,
) -> Result<IterativeSolution, NoIterativeSolution> {
    let plan = Plan::new(coefficients, currents_ma)?;
    let spectral_radius = plan.spectral_radius();
    if spectral_radius >= 1.0 {
        return Err(NoIterativeSolution::Diverges(spectral_radius));
    }
    let too_many = NoIterativeSolution::TooManySteps(spectral_radius);
    let mut changes = Vec::new();
    let LastStep { k, omega_n, change, steps } = plan.run(rule, |change| changes.push(change)).ok_or(too_many)?;
    let rest = (Matrix2::identity() - plan.t).try_inverse().ok_or(too_many)?;
    let remainder = change * plan.t * rest;
    let omega0 = mean_misclosure(coefficients, currents_ma, &k, &omega_n);
    Ok(IterativeSolution {
        parameters: AnalyticSolution::new(k, omega_n, omega0).parameters,
        omega_n_deg_per_h_per_g: omega_n,
        steps,
        changes,
        spectral_radius,
        last_change_k_deg_per_h_per_ma: change,
        remainder_k_deg_per_h_per_ma: remainder,
        remainder_omega_n_deg_per_h_per_g: -remainder * plan.j2_per_n2,
    })
}
