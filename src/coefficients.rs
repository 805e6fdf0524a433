//! Coefficients of the calibration equations of a stand at a site: specific force and Earth rate in the case axes of
//! every position, and the paper's Δ, B, C with their parts.
//!
//! [`StandGeometry`] contains all that does not depend on the site; [`StandGeometry::at`] adds the two numbers of a
//! site, ω_Γ and ω_B. One stand can therefore be used at many sites. Source:
//! [the paper](crate::bibliography::Bibliography::Tang17), eq. (5) and (9)-(15).

use crate::attitude::{self, Deviation};
use crate::text::record;
use nalgebra::{Matrix2, Matrix3, Vector2};
use serde::{Deserialize, Serialize};

/// Index (i, j) of a position: frame index i and platform index j, both counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PositionIndex {
    /// Frame index, from 1.
    pub i: u32,
    /// Platform index, from 1.
    pub j: u32,
}

impl std::fmt::Display for PositionIndex {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "({}, {})", self.i, self.j)
    }
}

/// The eight positions of the paper: index, θ in degrees, φ in degrees (paper, fig. 3).
pub const EIGHT_POSITIONS: [(PositionIndex, f64, f64); 8] = [
    (PositionIndex { i: 1, j: 1 }, 0.0, 0.0),
    (PositionIndex { i: 1, j: 2 }, 0.0, 90.0),
    (PositionIndex { i: 1, j: 3 }, 0.0, 180.0),
    (PositionIndex { i: 1, j: 4 }, 0.0, 270.0),
    (PositionIndex { i: 2, j: 1 }, 90.0, 0.0),
    (PositionIndex { i: 2, j: 2 }, 90.0, 90.0),
    (PositionIndex { i: 2, j: 3 }, 90.0, 180.0),
    (PositionIndex { i: 2, j: 4 }, 90.0, 270.0),
];

/// Position of a stand: nominal angles and deviation from them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Position {
    /// Index (i, j) of the position.
    pub index: PositionIndex,
    /// Frame angle θ about ξ, degrees.
    pub theta_deg: f64,
    /// Platform angle φ about the spin axis, degrees.
    pub phi_deg: f64,
    /// Certified deviation from the nominal orientation.
    pub deviation: Deviation,
}

/// Returns the paper's eight positions, each with its own deviation.
pub(crate) fn eight_positions(mut deviation: impl FnMut() -> Deviation) -> [Position; 8] {
    EIGHT_POSITIONS.map(|(index, theta_deg, phi_deg)| Position { index, theta_deg, phi_deg, deviation: deviation() })
}

/// Earth rate at a site, and the azimuth of the frame's axis, which determines its components in base axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EarthRate {
    /// Horizontal component ω_Γ, positive to the north, °/h.
    pub horizontal_deg_per_h: f64,
    /// Vertical component ω_B, positive upwards, °/h.
    pub vertical_deg_per_h: f64,
    /// Azimuth ψ of the frame's axis ξ, degrees clockwise from north; 90 in the paper.
    pub frame_axis_azimuth_deg: f64,
}

/// Refusal of a stand whose n_2 of the eight positions has no inverse, so that the matrices Δ, B, C do not exist.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "the g-sensitive drift cannot be determined, because the differences of specific force n_2 have no inverse \
     (condition number {condition:.1e})"
)]
pub struct SingularPositions {
    /// Condition number of n_2.
    pub condition: f64,
}

/// Orientations of all positions of a stand, which do not depend on the site.
#[derive(Debug, Clone, PartialEq)]
pub struct StandGeometry {
    positions: Vec<(PositionIndex, Matrix3<f64>)>,
    eight: Option<EightGeometry>,
}

/// Differences of the paper's eight positions, and the matrices computed from them. They do not depend on the azimuth of
/// the frame's axis.
#[derive(Debug, Clone, Copy, PartialEq)]
struct EightGeometry {
    /// Differences of the first two columns of E·A, along ξ and η: θ = 0°, θ = 90°.
    horizontal: [(Matrix2<f64>, Matrix2<f64>); 2],
    n1: Matrix2<f64>,
    n2: Matrix2<f64>,
    n2_inverse: Matrix2<f64>,
    delta: Matrix2<f64>,
}

impl StandGeometry {
    /// Creates the geometry of `positions`, in their order. The paper's eight positions may be among them or not.
    ///
    /// # Errors
    /// Returns [`SingularPositions`] if the eight positions are present and n_2 cannot be inverted.
    pub fn new(positions: &[Position]) -> Result<Self, SingularPositions> {
        let positions: Vec<_> = positions
            .iter()
            .map(|position| {
                (position.index, attitude::actual(position.theta_deg, position.phi_deg, &position.deviation))
            })
            .collect();
        let eight = places_of_the_eight(positions.iter().map(|(index, _)| *index));
        let eight = eight.map(|places| EightGeometry::new(&places.map(|place| positions[place].1))).transpose()?;
        Ok(Self { positions, eight })
    }

    /// Returns `true` if the paper's eight positions are present; Δ, B, C then exist at every site.
    pub(crate) fn has_eight(&self) -> bool {
        self.eight.is_some()
    }

    /// Returns the coefficients at a site with the Earth rate `earth` (paper, eq. (5), (12), (13), (15)).
    ///
    /// The orientation is Ã = E·A·Rz(90° − ψ), where ψ is the azimuth of the frame's axis; the paper's Ã = E·A has ψ = 90°.
    /// B = ω_Γ (A_1 − A_2 Δ) and C = ω_B·1 + ω_Γ A_2 n_2⁻¹ are the paper's B and C, with the part that does not depend
    /// on the site separated.
    pub fn at(&self, earth: EarthRate) -> Coefficients {
        let EarthRate { horizontal_deg_per_h: w_h, vertical_deg_per_h: w_v, frame_axis_azimuth_deg } = earth;
        let base = attitude::base(frame_axis_azimuth_deg);
        let positions = self.positions.iter().map(|(index, attitude)| {
            let attitude = attitude * base;
            let (a, b) = (attitude.m12, attitude.m22);
            let (c, d) = (attitude.m13, attitude.m23);
            PositionCoefficients {
                index: *index,
                specific_force_g: Vector2::new(c, d),
                specific_force_z_g: attitude.m33,
                earth_rate_deg_per_h: Vector2::new(a * w_h + c * w_v, b * w_h + d * w_v),
            }
        });
        let matrices = self.eight.map(|g| {
            let (a1, a2) = g.north(&base);
            Matrices {
                delta: g.delta,
                b_deg_per_h: (a1 - a2 * g.delta) * w_h,
                c_deg_per_h_per_g: Matrix2::identity() * w_v + a2 * g.n2_inverse * w_h,
                n1: g.n1,
                n2: g.n2,
                n2_inverse: g.n2_inverse,
                omega1_deg_per_h: a1 * w_h + g.n1 * w_v,
                omega2_deg_per_h: a2 * w_h + g.n2 * w_v,
            }
        });
        Coefficients { positions: positions.collect(), matrices }
    }
}

/// Returns the places of the paper's eight positions among `indices`, in its order, or `None` if one is missing.
pub(crate) fn places_of_the_eight(indices: impl Iterator<Item = PositionIndex> + Clone) -> Option<[usize; 8]> {
    let mut places = [0; 8];
    for (place, (eighth, ..)) in places.iter_mut().zip(EIGHT_POSITIONS) {
        *place = indices.clone().position(|index| index == eighth)?;
    }
    Some(places)
}

impl Coefficients {
    /// Returns the places of the paper's eight positions, in its order, or `None` if one is missing.
    pub(crate) fn eight(&self) -> Option<[usize; 8]> {
        places_of_the_eight(self.positions.iter().map(|at| at.index))
    }
}

impl EightGeometry {
    fn new(eight: &[Matrix3<f64>; 8]) -> Result<Self, SingularPositions> {
        // X_1 = (x_11 - x_13, x_12 - x_14), X_2 = (x_21 - x_23, x_22 - x_24), as columns (paper, eq. (11)).
        let along = |axis: usize| {
            pair_differences(|position| Vector2::new(eight[position][(0, axis)], eight[position][(1, axis)]))
        };
        let (n1, n2) = along(2);
        let singular_values = n2.singular_values();
        let condition = singular_values.max() / singular_values.min();
        let n2_inverse = n2.try_inverse().filter(|_| condition < 1e12).ok_or(SingularPositions { condition })?;
        Ok(Self { horizontal: [along(0), along(1)], n1, n2, n2_inverse, delta: n2_inverse * n1 })
    }

    /// Returns A_1 and A_2, the differences of (a, b), the second column of Ã = E·A·R with R = `base`.
    fn north(&self, base: &Matrix3<f64>) -> (Matrix2<f64>, Matrix2<f64>) {
        let [(xi1, xi2), (eta1, eta2)] = self.horizontal;
        (xi1 * base.m12 + eta1 * base.m22, xi2 * base.m12 + eta2 * base.m22)
    }
}

/// Returns X_1 and X_2 (2×2) of the vectors x of the eight positions in their order: differences of opposite positions
/// as columns (paper, eq. (9)-(11)).
pub(crate) fn pair_differences(x: impl Fn(usize) -> Vector2<f64>) -> (Matrix2<f64>, Matrix2<f64>) {
    let first = Matrix2::from_columns(&[x(0) - x(2), x(1) - x(3)]);
    let second = Matrix2::from_columns(&[x(4) - x(6), x(5) - x(7)]);
    (first, second)
}

/// Coefficients of the calibration equations of one stand at one site.
#[derive(Debug, Clone, PartialEq)]
pub struct Coefficients {
    /// Specific force and Earth rate of every position, in the order of the stand's positions.
    pub positions: Vec<PositionCoefficients>,
    /// The paper's matrices; `None` if one of its eight positions is missing.
    pub matrices: Option<Matrices>,
}

/// Specific force and Earth rate in the case axes of one position (paper, eq. (5)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionCoefficients {
    /// Index (i, j) of the position.
    pub index: PositionIndex,
    /// Specific force n = (c, d) along x and y, g.
    pub specific_force_g: Vector2<f64>,
    /// Specific force Ã₃₃ along the spin axis, g.
    pub specific_force_z_g: f64,
    /// Earth rate ω_3 = (a ω_Γ + c ω_B, b ω_Γ + d ω_B) along x and y, °/h.
    pub earth_rate_deg_per_h: Vector2<f64>,
}

/// The paper's matrices, each 2×2 (eq. (12), (13), (15)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Matrices {
    /// Δ = n_2⁻¹ n_1, dimensionless.
    pub delta: Matrix2<f64>,
    /// B = ω_31 − ω_32 n_2⁻¹ n_1, °/h.
    pub b_deg_per_h: Matrix2<f64>,
    /// C = ω_32 n_2⁻¹, °/(h·g).
    pub c_deg_per_h_per_g: Matrix2<f64>,
    /// Differences n_1 of specific force in the positions with θ = 0°, g.
    pub n1: Matrix2<f64>,
    /// Differences n_2 of specific force in the positions with θ = 90°, g.
    pub n2: Matrix2<f64>,
    /// Inverse n_2⁻¹, 1/g.
    pub n2_inverse: Matrix2<f64>,
    /// Differences ω_31 of Earth rate in the positions with θ = 0°, °/h.
    pub omega1_deg_per_h: Matrix2<f64>,
    /// Differences ω_32 of Earth rate in the positions with θ = 90°, °/h.
    pub omega2_deg_per_h: Matrix2<f64>,
}

/// A 2×2 matrix, row by row.
pub(crate) type Rows = [[f64; 2]; 2];

record! {
    /// Matrices of the paper at the site, each a list of two rows.
    pub struct MatrixRows {
        /// Δ = n_2⁻¹ n_1.
        pub delta: Rows,
        /// B = ω_31 − ω_32 n_2⁻¹ n_1.
        pub b_deg_per_h: Rows,
        /// C = ω_32 n_2⁻¹.
        pub c_deg_per_h_per_g: Rows,
        /// n_1.
        pub n1: Rows,
        /// n_2.
        pub n2: Rows,
        /// n_2⁻¹.
        pub n2_inverse: Rows,
        /// ω_31.
        pub omega1_deg_per_h: Rows,
        /// ω_32.
        pub omega2_deg_per_h: Rows,
    }
}

impl MatrixRows {
    pub(crate) fn from_model(m: &Matrices) -> Self {
        Self {
            delta: rows(&m.delta),
            b_deg_per_h: rows(&m.b_deg_per_h),
            c_deg_per_h_per_g: rows(&m.c_deg_per_h_per_g),
            n1: rows(&m.n1),
            n2: rows(&m.n2),
            n2_inverse: rows(&m.n2_inverse),
            omega1_deg_per_h: rows(&m.omega1_deg_per_h),
            omega2_deg_per_h: rows(&m.omega2_deg_per_h),
        }
    }

    pub(crate) fn to_model(&self) -> Matrices {
        Matrices {
            delta: matrix(&self.delta),
            b_deg_per_h: matrix(&self.b_deg_per_h),
            c_deg_per_h_per_g: matrix(&self.c_deg_per_h_per_g),
            n1: matrix(&self.n1),
            n2: matrix(&self.n2),
            n2_inverse: matrix(&self.n2_inverse),
            omega1_deg_per_h: matrix(&self.omega1_deg_per_h),
            omega2_deg_per_h: matrix(&self.omega2_deg_per_h),
        }
    }
}

fn rows(matrix: &Matrix2<f64>) -> Rows {
    // Products of exact zeros can be -0.0. Adding zero makes them 0.0, the only zero that a document can contain.
    [[matrix.m11 + 0.0, matrix.m12 + 0.0], [matrix.m21 + 0.0, matrix.m22 + 0.0]]
}

fn matrix(rows: &Rows) -> Matrix2<f64> {
    let [[m11, m12], [m21, m22]] = *rows;
    Matrix2::new(m11, m12, m21, m22)
}
