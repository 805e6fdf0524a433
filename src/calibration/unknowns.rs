//! The equations of all positions, linear in the unknowns (paper, eq. (2) and (5)):
//! K J + ω_0 + ω_n n (+ anisoelasticity · n n_z) = ω_3.

use super::parameter::Parameter;
use crate::coefficients::PositionCoefficients;
use crate::gyro::GyroParameters;
use nalgebra::{DMatrix, DVector, Vector2};

/// Values of the unknowns of the drift model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Unknowns {
    pub(crate) parameters: GyroParameters,
    /// Anisoelastic coefficient, °/(h·g²); 0 if it is not fitted.
    pub(crate) anisoelasticity_deg_per_h_per_g2: f64,
}

impl Unknowns {
    /// Creates the unknowns from a vector of 8 or 9 elements in the order of [`Parameter::NINE`].
    pub(crate) fn from_vector(vector: &DVector<f64>) -> Self {
        let value = |parameter: Parameter| vector.get(parameter.place()).copied().unwrap_or(0.0);
        Self {
            parameters: GyroParameters::from_vector(&Parameter::EIGHT.map(value)),
            anisoelasticity_deg_per_h_per_g2: value(Parameter::Anisoelasticity),
        }
    }

    pub(crate) fn plus(&self, step: &DVector<f64>) -> Self {
        let step = Self::from_vector(step);
        let mut sum = self.parameters.to_vector();
        for (value, change) in sum.iter_mut().zip(step.parameters.to_vector()) {
            *value += change;
        }
        Self {
            parameters: GyroParameters::from_vector(&sum),
            anisoelasticity_deg_per_h_per_g2: self.anisoelasticity_deg_per_h_per_g2
                + step.anisoelasticity_deg_per_h_per_g2,
        }
    }

    /// Returns the rate that the torquers must balance in a position: ω_3 − ω_0 − ω_n n − anisoelasticity · n n_z, °/h.
    fn torqued(&self, at: &PositionCoefficients) -> Vector2<f64> {
        let parameters = &self.parameters;
        let anisoelastic = at.specific_force_g * at.specific_force_z_g * self.anisoelasticity_deg_per_h_per_g2;
        at.earth_rate_deg_per_h
            - parameters.omega0_deg_per_h
            - parameters.omega_n_deg_per_h_per_g() * at.specific_force_g
            - anisoelastic
    }

    /// Returns the misclosure of a position, °/h: e = ω_3 − K J − ω_0 − ω_n n − anisoelasticity · n n_z.
    pub(crate) fn misclosure(&self, at: &PositionCoefficients, current_ma: &Vector2<f64>) -> Vector2<f64> {
        self.torqued(at) - self.parameters.k_deg_per_h_per_ma * current_ma
    }

    /// Returns the currents (J_x, J_y) that follow from these unknowns, mA, or `None` if K has no inverse or a current
    /// is not finite.
    pub(crate) fn currents_ma<'a>(
        &self,
        positions: impl IntoIterator<Item = &'a PositionCoefficients>,
    ) -> Option<Vec<Vector2<f64>>> {
        let inverse = self.parameters.k_deg_per_h_per_ma.try_inverse()?;
        let currents: Vec<_> = positions.into_iter().map(|at| inverse * self.torqued(at)).collect();
        currents.iter().all(|current| current.iter().all(|x| x.is_finite())).then_some(currents)
    }
}

/// Returns the coefficients of the two equations of a position (rows x and y, columns in the order of
/// [`Parameter::NINE`]).
pub(crate) fn equations(at: &PositionCoefficients, current_ma: &Vector2<f64>) -> [[f64; 9]; 2] {
    let (jx, jy) = (current_ma.x, current_ma.y);
    let (nx, ny, nz) = (at.specific_force_g.x, at.specific_force_g.y, at.specific_force_z_g);
    [[jx, jy, 0.0, 0.0, 1.0, 0.0, nx, -ny, nx * nz], [0.0, 0.0, jx, jy, 0.0, 1.0, ny, nx, ny * nz]]
}

/// Returns the design matrix of all positions: two rows per position, and `columns` (8 or 9) unknowns.
pub(crate) fn design(positions: &[PositionCoefficients], currents_ma: &[Vector2<f64>], columns: usize) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(2 * positions.len(), columns);
    for (place, (at, current)) in positions.iter().zip(currents_ma).enumerate() {
        for (axis, row) in equations(at, current).iter().enumerate() {
            for (column, value) in row.iter().take(columns).enumerate() {
                matrix[(2 * place + axis, column)] = *value;
            }
        }
    }
    matrix
}
