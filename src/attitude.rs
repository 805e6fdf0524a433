//! The orientation of the gyro's case on the stand: nominal (A), deviation (E), real (Ã).
//!
//! Frames: base ξηζ with ξ east, η north, ζ up; case xyz with z along the spin axis. Every matrix turns coordinates
//! (it is passive): the case's coordinates of a vector are Ã times its base coordinates.
//! Source: [the paper](crate::bibliography::Bibliography::Tang17), eq. (3) and (4).

use crate::units::sin_cos_of_degrees;
use nalgebra::Matrix3;

/// The deviation of one position from its nominal orientation: turns about the platform's own axes, in the order
/// α about x, β about y, γ about z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// α, about the platform's x axis.
    pub alpha_rad: f64,
    /// β, about the platform's y axis.
    pub beta_rad: f64,
    /// γ, about the platform's z axis, which is the gyro's spin axis.
    pub gamma_rad: f64,
}

/// A = Rz(φ)·Rx(θ): base to platform as designed, for frame angle θ and platform angle φ (paper, eq. (3)).
///
/// Elements are exactly 0 and ±1 at whole quadrants.
pub fn nominal(theta_deg: f64, phi_deg: f64) -> Matrix3<f64> {
    let (s_theta, c_theta) = sin_cos_of_degrees(theta_deg);
    let (s_phi, c_phi) = sin_cos_of_degrees(phi_deg);
    #[rustfmt::skip]
    let matrix = Matrix3::new(
        c_phi, c_theta * s_phi, s_theta * s_phi,
        -s_phi, c_theta * c_phi, s_theta * c_phi,
        0.0, -s_theta, c_theta,
    );
    matrix
}

/// E = Rz(γ)·Ry(β)·Rx(α): platform as designed to platform as it is (paper, the matrix above eq. (4)).
pub fn deviation(angles: &Deviation) -> Matrix3<f64> {
    let (sa, ca) = libm::sincos(angles.alpha_rad);
    let (sb, cb) = libm::sincos(angles.beta_rad);
    let (sg, cg) = libm::sincos(angles.gamma_rad);
    #[rustfmt::skip]
    let matrix = Matrix3::new(
        cb * cg, ca * sg + sa * sb * cg, sa * sg - ca * sb * cg,
        -cb * sg, ca * cg - sa * sb * sg, sa * cg + ca * sb * sg,
        sb, -sa * cb, ca * cb,
    );
    matrix
}

/// Ã = E·A: base to case as it is (paper, eq. (4)).
///
/// With Ã's elements a = Ã₁₂, b = Ã₂₂ (Earth's horizontal rate along x and y) and c = Ã₁₃, d = Ã₂₃ (the vertical
/// along x and y). The paper's printed matrix has b and c exchanged: see docs/model.md, erratum 1.
pub fn actual(theta_deg: f64, phi_deg: f64, angles: &Deviation) -> Matrix3<f64> {
    deviation(angles) * nominal(theta_deg, phi_deg)
}
