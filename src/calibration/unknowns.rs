//! The equations of all positions, linear in the unknowns (paper, eq. (2) and (5)):
//! K J + ω_0 + ω_n n (+ anisoelasticity · n n_z) = ω_3, or K J + ω_0 + G (n_x, n_y, n_z)' = ω_3 in the general model.

use super::analytic::g_drifts;
use super::parameter::Parameter;
use crate::coefficients::PositionCoefficients;
use crate::gyro::GyroParameters;
use crate::text::words;
use nalgebra::{DMatrix, DVector, Matrix2x3, Vector2, Vector3};

words! {
    /// Model of the g-sensitive drift that least squares fits.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    #[non_exhaustive]
    pub enum Model: pub(crate) key {
        /// The paper's model, eq. (5): ω_g and ω_k.
        #[default]
        Paper = "paper",
        /// The paper's model with the anisoelastic coefficient of eq. (2).
        Anisoelastic = "paper",
        /// General model: a full 2×3 matrix of g-sensitive drift replaces ω_g and ω_k.
        General = "general",
    }
}

impl Model {
    /// Returns the parameters in the order of the columns.
    pub(crate) fn parameters(self) -> &'static [Parameter] {
        match self {
            Self::Paper => &Parameter::EIGHT,
            Self::Anisoelastic => &Parameter::NINE,
            Self::General => &Parameter::TWELVE,
        }
    }

    pub(crate) fn columns(self) -> usize {
        self.parameters().len()
    }

    /// Returns the column of a parameter, or `None` if the model does not have it.
    pub(crate) fn column(self, parameter: Parameter) -> Option<usize> {
        self.parameters().iter().position(|one| *one == parameter)
    }
}

/// Values of the unknowns of the drift model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Unknowns {
    /// In the general model ω_g and ω_k are those of the matrix nearest to the paper's.
    pub(crate) parameters: GyroParameters,
    /// Anisoelastic coefficient, °/(h·g²); 0 if it is not fitted.
    pub(crate) anisoelasticity_deg_per_h_per_g2: f64,
    /// G less [[ω_g, −ω_k, 0], [ω_k, ω_g, 0]], °/(h·g), 2×3; 0 in the paper's model.
    pub(crate) beyond_the_paper_deg_per_h_per_g: Matrix2x3<f64>,
}

/// Returns [[ω_g, −ω_k, 0], [ω_k, ω_g, 0]], °/(h·g), 2×3.
fn of_the_paper(parameters: &GyroParameters) -> Matrix2x3<f64> {
    let w = parameters.omega_n_deg_per_h_per_g();
    Matrix2x3::new(w.m11, w.m12, 0.0, w.m21, w.m22, 0.0)
}

impl Unknowns {
    /// Creates the unknowns of the paper's model.
    pub(crate) fn of(parameters: GyroParameters) -> Self {
        let none = Matrix2x3::zeros();
        Self { parameters, anisoelasticity_deg_per_h_per_g2: 0.0, beyond_the_paper_deg_per_h_per_g: none }
    }

    /// Creates the unknowns from a vector in the order of the columns of `model`.
    pub(crate) fn from_vector(model: Model, vector: &DVector<f64>) -> Self {
        let value = |place: usize| vector.get(place).copied().unwrap_or(0.0);
        if model != Model::General {
            let eight = std::array::from_fn(value);
            let anisoelasticity_deg_per_h_per_g2 = if model == Model::Anisoelastic { value(8) } else { 0.0 };
            return Self { anisoelasticity_deg_per_h_per_g2, ..Self::of(GyroParameters::from_vector(&eight)) };
        }
        let g = Matrix2x3::from_fn(|row, column| value(6 + 3 * row + column));
        let [omega_g, omega_k] = g_drifts(&g.fixed_columns::<2>(0).into_owned());
        let [kx, kxy, kyx, ky, x, y] = std::array::from_fn(value);
        let parameters = GyroParameters::from_vector(&[kx, kxy, kyx, ky, x, y, omega_g, omega_k]);
        Self { beyond_the_paper_deg_per_h_per_g: g - of_the_paper(&parameters), ..Self::of(parameters) }
    }

    /// Returns the unknowns changed by a step in the order of the columns of `model`.
    pub(crate) fn plus(&self, model: Model, step: &DVector<f64>) -> Self {
        let step = Self::from_vector(model, step);
        let mut sum = self.parameters.to_vector();
        for (value, change) in sum.iter_mut().zip(step.parameters.to_vector()) {
            *value += change;
        }
        Self {
            parameters: GyroParameters::from_vector(&sum),
            anisoelasticity_deg_per_h_per_g2: self.anisoelasticity_deg_per_h_per_g2
                + step.anisoelasticity_deg_per_h_per_g2,
            beyond_the_paper_deg_per_h_per_g: self.beyond_the_paper_deg_per_h_per_g
                + step.beyond_the_paper_deg_per_h_per_g,
        }
    }

    /// Returns the value of a parameter in its unit; 0 for turn-ons and drifts, which are not among the unknowns.
    pub(crate) fn value(&self, parameter: Parameter) -> f64 {
        match parameter {
            Parameter::Anisoelasticity => self.anisoelasticity_deg_per_h_per_g2,
            Parameter::G(row, column) => self.g_matrix_deg_per_h_per_g()[(usize::from(row), usize::from(column))],
            other => self.parameters.to_vector().get(other.place()).copied().unwrap_or(0.0),
        }
    }

    /// Returns the matrix G of g-sensitive drift, °/(h·g), 2×3, which multiplies (n_x, n_y, n_z).
    pub(crate) fn g_matrix_deg_per_h_per_g(&self) -> Matrix2x3<f64> {
        of_the_paper(&self.parameters) + self.beyond_the_paper_deg_per_h_per_g
    }

    /// Returns G v less the paper's part, °/h.
    pub(crate) fn beyond_the_paper(&self, vector: &Vector3<f64>) -> Vector2<f64> {
        self.beyond_the_paper_deg_per_h_per_g * vector
    }

    /// Returns the rate that the torquers must balance in a position, °/h: ω_3 − ω_0 − ω_n n − anisoelasticity · n n_z, in
    /// the general model ω_3 − ω_0 − G n.
    fn torqued(&self, at: &PositionCoefficients) -> Vector2<f64> {
        let parameters = &self.parameters;
        let anisoelastic = at.specific_force_g * at.specific_force_z_g * self.anisoelasticity_deg_per_h_per_g2;
        at.earth_rate_deg_per_h
            - parameters.omega0_deg_per_h
            - parameters.omega_n_deg_per_h_per_g() * at.specific_force_g
            - anisoelastic
            - self.beyond_the_paper(&at.specific_force_g.push(at.specific_force_z_g))
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

/// Returns the coefficients of the two equations of a position (rows x and y, columns as in `model`; the rest is 0).
fn equations(at: &PositionCoefficients, current_ma: &Vector2<f64>, model: Model) -> [[f64; 12]; 2] {
    let (jx, jy) = (current_ma.x, current_ma.y);
    let (nx, ny, nz) = (at.specific_force_g.x, at.specific_force_g.y, at.specific_force_z_g);
    match model {
        Model::Paper | Model::Anisoelastic => [
            [jx, jy, 0.0, 0.0, 1.0, 0.0, nx, -ny, nx * nz, 0.0, 0.0, 0.0],
            [0.0, 0.0, jx, jy, 0.0, 1.0, ny, nx, ny * nz, 0.0, 0.0, 0.0],
        ],
        Model::General => [
            [jx, jy, 0.0, 0.0, 1.0, 0.0, nx, ny, nz, 0.0, 0.0, 0.0],
            [0.0, 0.0, jx, jy, 0.0, 1.0, 0.0, 0.0, 0.0, nx, ny, nz],
        ],
    }
}

/// Returns the design matrix of all positions: two rows per position, and the columns of `model`.
pub(crate) fn design(positions: &[PositionCoefficients], currents_ma: &[Vector2<f64>], model: Model) -> DMatrix<f64> {
    let columns = model.columns();
    let mut matrix = DMatrix::zeros(2 * positions.len(), columns);
    for (place, (at, current)) in positions.iter().zip(currents_ma).enumerate() {
        for (axis, row) in equations(at, current, model).iter().enumerate() {
            for (column, value) in row.iter().take(columns).enumerate() {
                matrix[(2 * place + axis, column)] = *value;
            }
        }
    }
    matrix
}
