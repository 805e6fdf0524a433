//! The unknowns of the drift model, eq. (2).

use crate::gyro::{GyroParameters, Tolerance};
use nalgebra::{Matrix2, Vector2};

/// Unknown of the drift model (paper, eq. (2)).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Parameter {
    /// Main scale factor K_x, °/(h·mA).
    Kx,
    /// Cross-axis scale factor K_xy, °/(h·mA).
    Kxy,
    /// Cross-axis scale factor K_yx, °/(h·mA).
    Kyx,
    /// Main scale factor K_y, °/(h·mA).
    Ky,
    /// Constant drift ω_0x, °/h.
    Omega0x,
    /// Constant drift ω_0y, °/h.
    Omega0y,
    /// g-sensitive drift ω_g, °/(h·g).
    OmegaG,
    /// g-sensitive drift ω_k, °/(h·g).
    OmegaK,
    /// Anisoelastic coefficient, called ω_n in eq. (2), °/(h·g²).
    Anisoelasticity,
    /// Element (row, column) of the matrix of g-sensitive drift of the general model, °/(h·g); rows x and y, columns of
    /// n_x, n_y, n_z, from 0.
    G(u8, u8),
    /// Difference of ω_0 between turn-ons of the gyro, °/h, about axis x or y, counted from 0.
    TurnOn(u8),
    /// Linear drift of ω_0 in time, °/h², about axis x or y, counted from 0.
    Drift(u8),
}

impl Parameter {
    /// The eight parameters of every calibration, in the order of vectors and covariances.
    pub const EIGHT: [Self; 8] =
        [Self::Kx, Self::Kxy, Self::Kyx, Self::Ky, Self::Omega0x, Self::Omega0y, Self::OmegaG, Self::OmegaK];

    /// The eight parameters in the order of the paper's table, for pages and terminal output.
    pub(crate) const AS_IN_THE_PAPER: [Self; 8] =
        [Self::Kx, Self::Ky, Self::Kxy, Self::Kyx, Self::Omega0x, Self::Omega0y, Self::OmegaG, Self::OmegaK];

    /// The eight parameters, then the anisoelastic coefficient.
    pub(crate) const NINE: [Self; 9] = [
        Self::Kx,
        Self::Kxy,
        Self::Kyx,
        Self::Ky,
        Self::Omega0x,
        Self::Omega0y,
        Self::OmegaG,
        Self::OmegaK,
        Self::Anisoelasticity,
    ];

    /// The parameters of the general model: G by rows takes the place of ω_g and ω_k.
    pub(crate) const TWELVE: [Self; 12] = [
        Self::Kx,
        Self::Kxy,
        Self::Kyx,
        Self::Ky,
        Self::Omega0x,
        Self::Omega0y,
        Self::G(0, 0),
        Self::G(0, 1),
        Self::G(0, 2),
        Self::G(1, 0),
        Self::G(1, 1),
        Self::G(1, 2),
    ];

    /// Returns the key of the parameter in JSON results.
    pub fn key(self) -> &'static str {
        match self {
            Self::Kx => "k_x",
            Self::Kxy => "k_xy",
            Self::Kyx => "k_yx",
            Self::Ky => "k_y",
            Self::Omega0x => "omega_0x",
            Self::Omega0y => "omega_0y",
            Self::OmegaG => "omega_g",
            Self::OmegaK => "omega_k",
            Self::Anisoelasticity => "anisoelasticity",
            Self::G(row, column) => G_KEYS[usize::from(row)][usize::from(column)],
            Self::TurnOn(axis) => ["turn_on_x", "turn_on_y"][usize::from(axis)],
            Self::Drift(axis) => ["drift_x", "drift_y"][usize::from(axis)],
        }
    }

    /// Returns `true` for the elements of K, whose tolerances are in percent.
    pub(crate) fn is_scale_factor(self) -> bool {
        matches!(self, Self::Kx | Self::Kxy | Self::Kyx | Self::Ky)
    }

    /// Returns the symbol of the parameter in the paper.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Kx => "K_x",
            Self::Kxy => "K_xy",
            Self::Kyx => "K_yx",
            Self::Ky => "K_y",
            Self::Omega0x => "ω_0x",
            Self::Omega0y => "ω_0y",
            Self::OmegaG => "ω_g",
            Self::OmegaK => "ω_k",
            Self::Anisoelasticity => "ω_n (anisoelasticity)",
            Self::G(row, column) => G_SYMBOLS[usize::from(row)][usize::from(column)],
            Self::TurnOn(axis) => ["the turn-ons about x", "the turn-ons about y"][usize::from(axis)],
            Self::Drift(axis) => ["the drift in time about x", "the drift in time about y"][usize::from(axis)],
        }
    }

    /// Returns the unit of the parameter as in JSON results.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Kx | Self::Kxy | Self::Kyx | Self::Ky => "deg/h/mA",
            Self::Omega0x | Self::Omega0y | Self::TurnOn(_) => "deg/h",
            Self::OmegaG | Self::OmegaK | Self::G(..) => "deg/h/g",
            Self::Anisoelasticity => "deg/h/g^2",
            Self::Drift(_) => "deg/h/h",
        }
    }

    /// Returns the index of one of [`Self::NINE`] in vectors of parameters.
    pub(crate) fn place(self) -> usize {
        Self::NINE.iter().position(|one| *one == self).unwrap_or(usize::MAX)
    }
}

const G_KEYS: [[&str; 3]; 2] = [["g_xx", "g_xy", "g_xz"], ["g_yx", "g_yy", "g_yz"]];
const G_SYMBOLS: [[&str; 3]; 2] = [["G_xx", "G_xy", "G_xz"], ["G_yx", "G_yy", "G_yz"]];

impl Tolerance {
    /// Returns the tolerance of one of the eight parameters: in percent for scale factors, otherwise in the unit of the
    /// parameter; infinite for other parameters, of which a type states nothing.
    pub(crate) fn of(&self, parameter: Parameter) -> f64 {
        match parameter {
            Parameter::Kx | Parameter::Ky => self.k_main_percent,
            Parameter::Kxy | Parameter::Kyx => self.k_cross_percent,
            Parameter::Omega0x | Parameter::Omega0y => self.omega0_deg_per_h,
            Parameter::OmegaG => self.omega_g_deg_per_h_per_g,
            Parameter::OmegaK => self.omega_k_deg_per_h_per_g,
            _ => f64::INFINITY,
        }
    }

    /// Returns the tolerance of a parameter of this `size` in the unit of the parameter.
    pub(crate) fn absolute(&self, parameter: Parameter, size: f64) -> f64 {
        let of_size = if parameter.is_scale_factor() { size.abs() / 100.0 } else { 1.0 };
        self.of(parameter) * of_size
    }
}

impl GyroParameters {
    /// Returns the eight parameters in the order of [`Parameter::EIGHT`].
    pub fn to_vector(&self) -> [f64; 8] {
        let k = &self.k_deg_per_h_per_ma;
        let omega0 = &self.omega0_deg_per_h;
        let (w_g, w_k) = (self.omega_g_deg_per_h_per_g, self.omega_k_deg_per_h_per_g);
        [k.m11, k.m12, k.m21, k.m22, omega0.x, omega0.y, w_g, w_k]
    }

    /// Creates the parameters from eight numbers in the order of [`Parameter::EIGHT`].
    pub fn from_vector(values: &[f64; 8]) -> Self {
        let [kx, kxy, kyx, ky, omega0x, omega0y, omega_g, omega_k] = *values;
        Self {
            k_deg_per_h_per_ma: Matrix2::new(kx, kxy, kyx, ky),
            omega0_deg_per_h: Vector2::new(omega0x, omega0y),
            omega_g_deg_per_h_per_g: omega_g,
            omega_k_deg_per_h_per_g: omega_k,
        }
    }
}
