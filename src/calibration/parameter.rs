//! The unknowns of the drift model, eq. (2).

use crate::gyro::{GyroParameters, Tolerance};
use crate::wording::texts::units;
use crate::wording::words::{listed, symbol};
use crate::wording::{Text, Words};
use nalgebra::{Matrix2, Vector2};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Returns the symbols of parameters with commas between them.
pub(crate) fn symbols(parameters: impl IntoIterator<Item = Parameter>) -> Words {
    listed(parameters.into_iter().map(|parameter| symbol(parameter.symbol())))
}

/// Returns the unit of a parameter on pages.
pub(crate) fn unit(parameter: Parameter) -> Text {
    match parameter {
        Parameter::Kx | Parameter::Kxy | Parameter::Kyx | Parameter::Ky => units::DEG_PER_H_PER_MA,
        Parameter::Omega0x | Parameter::Omega0y | Parameter::TurnOn(_) => units::DEG_PER_H,
        Parameter::OmegaG | Parameter::OmegaK | Parameter::G(..) => units::DEG_PER_H_PER_G,
        Parameter::Drift(_) => units::DEG_PER_H2,
        Parameter::Anisoelasticity => units::DEG_PER_H_PER_G2,
    }
}

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
    pub(crate) const NINE: [Self; 9] = {
        let [kx, kxy, kyx, ky, x, y, omega_g, omega_k] = Self::EIGHT;
        [kx, kxy, kyx, ky, x, y, omega_g, omega_k, Self::Anisoelasticity]
    };

    /// The parameters of the general model: G by rows takes the place of ω_g and ω_k.
    pub(crate) const TWELVE: [Self; 12] = {
        let [kx, kxy, kyx, ky, x, y, ..] = Self::EIGHT;
        let [xx, xy, xz] = [Self::G(0, 0), Self::G(0, 1), Self::G(0, 2)];
        let [yx, yy, yz] = [Self::G(1, 0), Self::G(1, 1), Self::G(1, 2)];
        [kx, kxy, kyx, ky, x, y, xx, xy, xz, yx, yy, yz]
    };

    /// Returns key, symbol and unit.
    fn words(self) -> [&'static str; 3] {
        match self {
            Self::Kx => ["k_x", "K_x", "deg/h/mA"],
            Self::Kxy => ["k_xy", "K_xy", "deg/h/mA"],
            Self::Kyx => ["k_yx", "K_yx", "deg/h/mA"],
            Self::Ky => ["k_y", "K_y", "deg/h/mA"],
            Self::Omega0x => ["omega_0x", "ω_0x", "deg/h"],
            Self::Omega0y => ["omega_0y", "ω_0y", "deg/h"],
            Self::OmegaG => ["omega_g", "ω_g", "deg/h/g"],
            Self::OmegaK => ["omega_k", "ω_k", "deg/h/g"],
            Self::Anisoelasticity => ["anisoelasticity", "ω_n (anisoelasticity)", "deg/h/g^2"],
            Self::G(row, column) => G[usize::from(row)][usize::from(column)],
            Self::TurnOn(0) => ["turn_on_x", "the turn-ons about x", "deg/h"],
            Self::TurnOn(_) => ["turn_on_y", "the turn-ons about y", "deg/h"],
            Self::Drift(0) => ["drift_x", "the drift in time about x", "deg/h/h"],
            Self::Drift(_) => ["drift_y", "the drift in time about y", "deg/h/h"],
        }
    }

    /// Returns the key of the parameter in JSON results.
    pub fn key(self) -> &'static str {
        self.words()[0]
    }

    /// Returns the symbol of the parameter in the paper.
    pub fn symbol(self) -> &'static str {
        self.words()[1]
    }

    /// Returns the unit of the parameter as in JSON results.
    pub fn unit(self) -> &'static str {
        self.words()[2]
    }

    /// Returns rows about parameters in the order of the paper's table; those of parameters beyond it follow.
    pub(crate) fn in_paper_order<T>(rows: impl IntoIterator<Item = T>, of: impl Fn(&T) -> Self) -> Vec<T> {
        let mut rows: Vec<T> = rows.into_iter().collect();
        rows.sort_by_key(|row| Self::AS_IN_THE_PAPER.iter().position(|one| *one == of(row)).unwrap_or(usize::MAX));
        rows
    }

    /// Returns `true` for the elements of K.
    pub(crate) fn is_scale_factor(self) -> bool {
        matches!(self, Self::Kx | Self::Kxy | Self::Kyx | Self::Ky)
    }

    /// Returns the index of one of [`Self::NINE`] in vectors of parameters.
    pub(crate) fn place(self) -> usize {
        Self::NINE.iter().position(|one| *one == self).unwrap_or(usize::MAX)
    }
}

/// Serialises a parameter as its key, such as `k_x`.
impl Serialize for Parameter {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.key())
    }
}

/// Reads the key of an unknown of one of the models.
impl<'de> Deserialize<'de> for Parameter {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let key = String::deserialize(deserializer)?;
        let found = Self::NINE.into_iter().chain(Self::TWELVE).find(|one| one.key() == key);
        found.ok_or_else(|| serde::de::Error::custom("unknown parameter"))
    }
}

/// Words of the elements of G.
const G: [[[&str; 3]; 3]; 2] = [
    [["g_xx", "G_xx", "deg/h/g"], ["g_xy", "G_xy", "deg/h/g"], ["g_xz", "G_xz", "deg/h/g"]],
    [["g_yx", "G_yx", "deg/h/g"], ["g_yy", "G_yy", "deg/h/g"], ["g_yz", "G_yz", "deg/h/g"]],
];

impl Tolerance {
    /// Returns the tolerance of one of the eight parameters: in percent of the nominal value or in the unit of the parameter,
    /// as [`Self::is_in_percent`] says; infinite for other parameters, of which a type states nothing.
    pub(crate) fn of(&self, parameter: Parameter) -> f64 {
        match parameter {
            Parameter::Kx | Parameter::Ky => self.k_main_percent,
            Parameter::Kxy | Parameter::Kyx => {
                self.k_cross_deg_per_h_per_ma.or(self.k_cross_percent).unwrap_or(f64::INFINITY)
            }
            Parameter::Omega0x | Parameter::Omega0y => self.omega0_deg_per_h,
            Parameter::OmegaG => self.omega_g_deg_per_h_per_g,
            Parameter::OmegaK => self.omega_k_deg_per_h_per_g,
            _ => f64::INFINITY,
        }
    }

    /// Returns `true` if the tolerance of a parameter is in percent of the nominal value.
    pub(crate) fn is_in_percent(&self, parameter: Parameter) -> bool {
        let is_main = matches!(parameter, Parameter::Kx | Parameter::Ky);
        is_main || parameter.is_scale_factor() && self.k_cross_deg_per_h_per_ma.is_none()
    }

    /// Returns the tolerance of a parameter of this `size` in the unit of the parameter.
    pub(crate) fn absolute(&self, parameter: Parameter, size: f64) -> f64 {
        let of_size = if self.is_in_percent(parameter) { size.abs() / 100.0 } else { 1.0 };
        self.of(parameter) * of_size
    }
}

impl GyroParameters {
    /// Returns the eight parameters in the order of [`Parameter::EIGHT`].
    pub(crate) fn to_vector(self) -> [f64; 8] {
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
