//! Orientation of the gyro's case on the stand: nominal (A), deviation (E), actual (Ã).
//!
//! The base axes ξηζ are east, north and up in the paper. A base may also be rotated about the plumb line: its axis ξ,
//! the frame's axis, then points to another azimuth, and ζ stays up. The case axes are xyz with z along the spin axis.
//! All rotation matrices are passive: the case coordinates of a vector are Ã times its base coordinates. Source:
//! [the paper](crate::bibliography::Bibliography::Tang17), eq. (3) and (4).

use crate::units::sin_cos_of_degrees;
use nalgebra::Matrix3;

/// Deviation of one position from its nominal orientation: rotations about the platform's own axes, in the order α
/// about x, β about y, γ about z.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Deviation {
    /// Deviation α about the platform's x axis, rad.
    pub alpha_rad: f64,
    /// Deviation β about the platform's y axis, rad.
    pub beta_rad: f64,
    /// Deviation γ about the platform's z axis, which is the gyro's spin axis, rad.
    pub gamma_rad: f64,
}

impl Deviation {
    pub(crate) fn of([alpha_rad, beta_rad, gamma_rad]: [f64; 3]) -> Self {
        Self { alpha_rad, beta_rad, gamma_rad }
    }
}

/// Names of the angles of a deviation.
pub(crate) const ANGLES: [&str; 3] = ["alpha", "beta", "gamma"];

/// Symbols of the angles of a deviation.
pub(crate) const ANGLE_SYMBOLS: [&str; 3] = ["α", "β", "γ"];

/// Returns the nominal rotation matrix A = Rz(φ)·Rx(θ), base to platform axes (3×3), for the frame angle θ and the
/// platform angle φ (paper, eq. (3)).
///
/// At whole quadrants its elements are exactly 0 and ±1.
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

/// Azimuth of the frame's axis in the paper, degrees clockwise from north: ξ points east.
pub(crate) const PAPER_FRAME_AXIS_AZIMUTH_DEG: f64 = 90.0;

/// Returns the rotation matrix Rz(90° − ψ), east-north-up to base axes (3×3), of a levelled base whose frame axis ξ
/// points to the azimuth ψ, degrees clockwise from north.
///
/// At whole quadrants its elements are exactly 0 and ±1; at the paper's 90° it is the identity.
pub(crate) fn base(frame_axis_azimuth_deg: f64) -> Matrix3<f64> {
    // sin(90° − ψ) = cos ψ and cos(90° − ψ) = sin ψ.
    let (sin, cos) = sin_cos_of_degrees(frame_axis_azimuth_deg);
    #[rustfmt::skip]
    let matrix = Matrix3::new(
        sin, cos, 0.0,
        -cos, sin, 0.0,
        0.0, 0.0, 1.0,
    );
    matrix
}

/// Returns the rotation matrix of the deviation, E = Rz(γ)·Ry(β)·Rx(α), nominal to actual platform axes (3×3) (paper,
/// the matrix above eq. (4)).
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

/// Returns the actual rotation matrix Ã = E·A, base to case axes (3×3) (paper, eq. (4)).
///
/// The elements a = Ã₁₂, b = Ã₂₂ multiply the horizontal component of the Earth rate along x and y; c = Ã₁₃, d = Ã₂₃
/// multiply the vertical component along x and y. In the paper's printed matrix b and c are exchanged: see
/// docs/development/reproduction.md, erratum 1.
pub fn actual(theta_deg: f64, phi_deg: f64, angles: &Deviation) -> Matrix3<f64> {
    deviation(angles) * nominal(theta_deg, phi_deg)
}
