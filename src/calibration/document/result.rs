//! The JSON of one method, and what belongs to it.

use crate::calibration::chi_square::ChiSquare;
use crate::calibration::iterative::{StepChange, StopRule};
use crate::calibration::noise::{DriftNoise, NoiseSource};
use crate::calibration::repeats::Repeats;
use crate::calibration::result::{Cycle, ModelTest};
use crate::calibration::unknowns::Model;
use crate::calibration::verdict::Found;
use crate::gyro::GyroParameters;
use nalgebra::SMatrix;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

result! {
    /// JSON result of one method.
    #[derive(Default)]
    pub(crate) struct ResultDocument {
        pub(crate) method: String,
        /// Model of the g-sensitive drift: paper or general.
        #[serde(default = "paper")]
        pub(crate) model: String,
        /// K, °/(h·mA): [[K_x, K_xy], [K_yx, K_y]].
        pub(crate) k_deg_per_h_per_ma: [[f64; 2]; 2],
        /// ω_0, °/h: [x, y].
        pub(crate) omega0_deg_per_h: [f64; 2],
        /// ω_n, °/(h·g), 2×2: four independent numbers for the paper's methods.
        pub(crate) omega_n_deg_per_h_per_g: Option<[[f64; 2]; 2]> = default,
        /// ω_g, °/h per local g; absent in the general model, as ω_n and ω_k are.
        pub(crate) omega_g_deg_per_h_per_g: Option<f64> = default,
        /// ω_k, °/h per local g.
        pub(crate) omega_k_deg_per_h_per_g: Option<f64> = default,
        /// Matrix of g-sensitive drift of the general model, °/h per local g, 2×3, for (n_x, n_y, n_z).
        pub(crate) g_matrix_deg_per_h_per_g: Option<[[f64; 3]; 2]> = default,
        /// F test of whether the paper's model is enough; present with a larger one.
        pub(crate) model_test: Option<ModelTest> = default,
        /// Linear drift of ω_0 in time, °/h per hour: [x, y]; ω_0 is then that at the mean time of the readings.
        pub(crate) drift_deg_per_h_per_h: Option<[f64; 2]> = default,
        /// ω_0 of each turn-on of the gyro.
        pub(crate) cycles: Vec<Cycle> = default,
        /// Noise of the gyro's drift that the uncertainties contain; absent in results of earlier versions.
        pub(crate) noise: Option<NoiseDocument> = default,
        /// Anisoelastic coefficient, °/(h·g²); absent if it was not fitted.
        pub(crate) anisoelasticity_deg_per_h_per_g2: Option<f64> = default,
        pub(crate) iterations: Option<u32> = default,
        /// Stop rule of the iteration, Δ₁ and Δ₂.
        pub(crate) stop_rule: Option<StopRule> = default,
        /// Changes of the parameters in each step after the first approximation.
        pub(crate) changes: Option<Vec<StepChange>> = default,
        pub(crate) spectral_radius: Option<f64> = default,
        /// Exact remainder of K, °/(h·mA), 2×2.
        pub(crate) remainder_k_deg_per_h_per_ma: Option<[[f64; 2]; 2]> = default,
        /// Exact remainder of ω_n, °/(h·g), 2×2.
        pub(crate) remainder_omega_n_deg_per_h_per_g: Option<[[f64; 2]; 2]> = default,
        /// Standard uncertainties, under the keys of the values.
        pub(crate) standard_uncertainty: UncertaintyDocument,
        /// Differences from least squares in units of their standard uncertainties: K_x, K_xy, K_yx, K_y, ω_0x, ω_0y, ω_g,
        /// ω_k.
        pub(crate) from_least_squares: Option<[f64; 8]> = default,
        pub(crate) chi_square: ChiSquareDocument,
        /// Residuals of each position, °/h; absent without degrees of freedom.
        pub(crate) residuals_deg_per_h: Vec<ResidualDocument> = default,
        /// Key of results of earlier versions.
        #[serde(skip_serializing, default)]
        pub(crate) iterations_predicted: IgnoredAny,
    }
}

fn paper() -> String {
    Model::Paper.key().to_owned()
}

result! {
    /// Noise of the gyro's drift: from visit to visit, and from one turn-on to the next.
    pub(crate) struct NoiseDocument {
        /// Standard deviation from visit to visit, each axis; absent if it is not known.
        pub(crate) visit_deg_per_h: Option<f64> = default,
        /// stated, estimated or not_stated.
        pub(crate) visit_source: String,
        /// Degrees of freedom of an estimate.
        pub(crate) visit_degrees_of_freedom: Option<f64> = default,
        /// Standard deviation of ω_0 from one turn-on to the next, each axis; absent if it is not known.
        pub(crate) turn_on_deg_per_h: Option<f64> = default,
        /// stated, estimated or not_stated.
        pub(crate) turn_on_source: String,
        /// Degrees of freedom of an estimate.
        pub(crate) turn_on_degrees_of_freedom: Option<f64> = default,
    }
}

impl NoiseDocument {
    /// Returns the noise from visit to visit, and that between turn-ons: standard deviation, °/h, and degrees of freedom, or
    /// `None` if it is not known.
    pub(super) fn each(&self) -> [Option<(f64, f64)>; 2] {
        let freedom = |limited: Option<f64>| limited.unwrap_or(f64::INFINITY);
        [
            self.visit_deg_per_h.map(|noise| (noise, freedom(self.visit_degrees_of_freedom))),
            self.turn_on_deg_per_h.map(|noise| (noise, freedom(self.turn_on_degrees_of_freedom))),
        ]
    }

    pub(crate) fn new(repeats: &Repeats) -> Self {
        let known = |noise: &DriftNoise| (noise.source != NoiseSource::NotStated).then_some(noise.deg_per_h);
        let (visit, turn_on) = (&repeats.visit, &repeats.turn_on);
        Self {
            visit_deg_per_h: known(visit),
            visit_source: visit.source.key().to_owned(),
            visit_degrees_of_freedom: finite(visit.degrees_of_freedom),
            turn_on_deg_per_h: known(turn_on),
            turn_on_source: turn_on.source.key().to_owned(),
            turn_on_degrees_of_freedom: finite(turn_on.degrees_of_freedom),
        }
    }
}

result! {
    /// Standard uncertainties of the values of one method, each under the key and in the unit of its value, and absent where
    /// the value is.
    #[derive(Default)]
    pub(crate) struct UncertaintyDocument {
        pub(crate) k_deg_per_h_per_ma: [[f64; 2]; 2],
        pub(crate) omega0_deg_per_h: [f64; 2],
        pub(crate) omega_n_deg_per_h_per_g: Option<[[f64; 2]; 2]> = default,
        pub(crate) omega_g_deg_per_h_per_g: Option<f64> = default,
        pub(crate) omega_k_deg_per_h_per_g: Option<f64> = default,
        pub(crate) g_matrix_deg_per_h_per_g: Option<[[f64; 3]; 2]> = default,
        pub(crate) drift_deg_per_h_per_h: Option<[f64; 2]> = default,
        pub(crate) anisoelasticity_deg_per_h_per_g2: Option<f64> = default,
    }
}

result! {
    /// Chi-square test of a fit.
    #[derive(Default)]
    pub(crate) struct ChiSquareDocument {
        pub(crate) value: f64,
        /// Number of readings minus number of parameters.
        pub(crate) degrees_of_freedom: usize,
        /// Probability of a larger value if the readings agree with all stated uncertainties; absent without degrees of
        /// freedom.
        pub(crate) probability: Option<f64> = default,
        /// Degrees of freedom of the uncertainties from which chi-square is computed; absent if infinite.
        pub(crate) uncertainty_degrees_of_freedom: Option<f64> = default,
    }
}

result! {
    /// Residuals of one position along x and y and their standard uncertainties, °/h. Results of earlier versions have no
    /// uncertainties.
    pub(crate) struct ResidualDocument {
        pub(crate) i: u32,
        pub(crate) j: u32,
        pub(crate) x: f64,
        pub(crate) y: f64,
        pub(crate) u_x: Option<f64> = default,
        pub(crate) u_y: Option<f64> = default,
    }
}

impl ChiSquareDocument {
    pub(crate) fn new(found: &ChiSquare) -> Self {
        Self {
            value: found.value,
            degrees_of_freedom: found.degrees_of_freedom,
            probability: found.judges().then_some(found.probability),
            uncertainty_degrees_of_freedom: finite(found.of_uncertainties),
        }
    }
}

/// Share of a standard uncertainty below which a remaining error is rounding, not a result.
const NEGLIGIBLE: f64 = 1e-3;

/// Returns a matrix as a list of rows.
pub(crate) fn rows<const C: usize>(matrix: &SMatrix<f64, 2, C>) -> [[f64; C]; 2] {
    [0, 1].map(|row| std::array::from_fn(|column| matrix[(row, column)]))
}

impl ResultDocument {
    /// Returns the largest remaining error of the iterative method in K, °/(h·mA), and in ω_n, °/(h·g), each `None` if it is
    /// negligible; or `None` for other methods.
    pub(crate) fn remaining_errors(&self) -> Option<[Option<f64>; 2]> {
        let largest =
            |rows: [[f64; 2]; 2]| rows.into_iter().flatten().fold(0.0, |most, x: f64| f64::max(most, x.abs()));
        let u_k = self.standard_uncertainty.k_deg_per_h_per_ma.into_iter().flatten().fold(f64::INFINITY, f64::min);
        let u_omega = self.standard_uncertainty.omega_g_deg_per_h_per_g.unwrap_or(0.0);
        let errors = [(self.remainder_k_deg_per_h_per_ma?, u_k), (self.remainder_omega_n_deg_per_h_per_g?, u_omega)];
        Some(errors.map(|(error, u)| Some(largest(error)).filter(|most| *most >= NEGLIGIBLE * u)))
    }

    pub(crate) fn found(&self, gravity_m_per_s2: f64, gravity_u_m_per_s2: Option<f64>) -> Found {
        let u = &self.standard_uncertainty;
        let eight = |[[kx, kxy], [kyx, ky]]: [[f64; 2]; 2], [x, y]: [f64; 2], per_g: [Option<f64>; 2]| {
            let [omega_g, omega_k] = per_g.map(|value| value.unwrap_or(f64::NAN));
            [kx, kxy, kyx, ky, x, y, omega_g, omega_k]
        };
        let per_g = [self.omega_g_deg_per_h_per_g, self.omega_k_deg_per_h_per_g];
        let u_per_g = [u.omega_g_deg_per_h_per_g, u.omega_k_deg_per_h_per_g];
        let values = eight(self.k_deg_per_h_per_ma, self.omega0_deg_per_h, per_g);
        Found {
            parameters: GyroParameters::from_vector(&values),
            standard_uncertainty: eight(u.k_deg_per_h_per_ma, u.omega0_deg_per_h, u_per_g),
            degrees_of_freedom: [f64::INFINITY; 8],
            gravity_m_per_s2,
            gravity_u_m_per_s2: gravity_u_m_per_s2.unwrap_or(0.0),
        }
    }
}

/// Returns a number if JSON can have it.
pub(crate) fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
