//! How much noisier a calibration is on a stand than on a perfect one.
//!
//! First order, least squares on all readings, the same independent error in every current. A stand's deviations
//! make the regressors less distinct; this says by how much that costs.

use crate::attitude::Deviation;
use crate::coefficients::{Coefficients, EarthRate, Position, StandGeometry};
use crate::gyro::{GyroParameters, Parameters};
use crate::stand::CertifiedPosition;
use nalgebra::{DMatrix, Matrix2, SVector};

/// Ratios of standard uncertainties, this stand's to a perfect one's with the same positions at the same site.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseGrowth {
    /// The worst of K_x, K_xy, K_yx, K_y.
    pub k: f64,
    /// The worse of ω_0x, ω_0y.
    pub omega0: f64,
    /// ω_g.
    pub omega_g: f64,
    /// ω_k.
    pub omega_k: f64,
}

impl NoiseGrowth {
    /// The worst of all.
    pub fn worst(&self) -> f64 {
        self.k.max(self.omega0).max(self.omega_g).max(self.omega_k)
    }
}

/// Compares the stand with a perfect one; `None` when its positions do not determine all eight parameters.
pub fn growth(positions: &[CertifiedPosition], earth: EarthRate, gyro: &Parameters) -> Option<NoiseGrowth> {
    let gyro = gyro.to_model();
    let real: Vec<Position> = positions.iter().map(CertifiedPosition::to_model).collect();
    let none = Deviation { alpha_rad: 0.0, beta_rad: 0.0, gamma_rad: 0.0 };
    let perfect: Vec<Position> = real.iter().map(|position| Position { deviation: none, ..*position }).collect();
    let uncertainties = |stand: &[Position]| uncertainty_per_current(&StandGeometry::new(stand).ok()?.at(earth), &gyro);
    let ratio = uncertainties(&real)?.component_div(&uncertainties(&perfect)?);
    Some(NoiseGrowth {
        k: ratio.fixed_rows::<4>(0).max(),
        omega0: ratio.fixed_rows::<2>(4).max(),
        omega_g: ratio[6],
        omega_k: ratio[7],
    })
}

/// Standard uncertainties of K_x, K_xy, K_yx, K_y, ω_0x, ω_0y, ω_g, ω_k for a unit error in every current.
fn uncertainty_per_current(at: &Coefficients, gyro: &GyroParameters) -> Option<SVector<f64, 8>> {
    // An error δJ enters an equation as K δJ; K⁻¹ times the pair of equations makes the errors independent again.
    let k_inverse = gyro.k_deg_per_h_per_ma.try_inverse()?;
    let mut design = DMatrix::zeros(2 * at.positions.len(), 8);
    for (row, position) in at.positions.iter().enumerate() {
        let current = gyro.currents_ma(position)?;
        let (jx, jy) = (current.x, current.y);
        let (nx, ny) = (position.specific_force_g.x, position.specific_force_g.y);
        // Columns in pairs: (K_x, K_yx), (K_xy, K_y), ω_0, and (ω_g, ω_k), each a 2×2 block of (5).
        let blocks = [
            (0, 2, Matrix2::identity() * jx),
            (1, 3, Matrix2::identity() * jy),
            (4, 5, Matrix2::identity()),
            (6, 7, Matrix2::new(nx, -ny, ny, nx)),
        ];
        for (first, second, block) in blocks {
            let whitened = k_inverse * block;
            design.fixed_view_mut::<2, 1>(2 * row, first).copy_from(&whitened.column(0));
            design.fixed_view_mut::<2, 1>(2 * row, second).copy_from(&whitened.column(1));
        }
    }
    // Columns of one size, so that the rank does not depend on units.
    let scales: Vec<f64> = design.column_iter().map(|column| column.norm()).collect();
    for (mut column, scale) in design.column_iter_mut().zip(&scales) {
        column /= if *scale > 0.0 { *scale } else { 1.0 };
    }
    let svd = design.svd(false, true);
    let (largest, smallest) = (svd.singular_values.max(), svd.singular_values.min());
    if svd.singular_values.len() < 8 || smallest < 1e-9 * largest {
        return None;
    }
    let v = svd.v_t?.transpose();
    Some(SVector::from_fn(|parameter, _| {
        let terms = svd.singular_values.iter().enumerate().map(|(k, value)| (v[(parameter, k)] / value).powi(2));
        terms.sum::<f64>().sqrt() / scales[parameter]
    }))
}
