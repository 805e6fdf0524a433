//! Mistakes that leave a fit as good as it was and change the result, recognised by what the gyro should be.
//!
//! With K, ω_0, ω_n as they are and K′, ω_0′, ω_n′ as they were found: currents J′ = 10^p P J in place of J, with a signed
//! permutation P of x and y, give K′ = K P⁻¹ 10^−p and touch no drift; the passport of another place, with ω_Γ′ and ω_B′
//! where ω_Γ and ω_B act, gives K′ = sK, ω_0′ = sω_0, ω_n′ = sω_n + (ω_B′ − sω_B)·1 with s = ω_Γ′/ω_Γ. Each can be undone.

use super::result::Calibration;
use super::verdict::{Found, Verdict, against_type};
use crate::coefficients::EarthRate;
use crate::earth::{NORMAL_GRAVITY_WITHOUT_HEIGHT_U_M_PER_S2, normal_gravity_m_per_s2};
use crate::gyro::{GyroParameters, GyroType};
use nalgebra::Matrix2;
use serde::Serialize;

/// A mistake explains a result clearly when the result as it was read, and with any other mistake undone, is this many
/// times farther from what the gyro should be.
const CLEARLY: f64 = 3.0;

/// The same of another place: among all latitudes there is always one that comes near, so more is asked of it. A place less than
/// some 30 km farther north or south is not recognised.
const CLEARLY_ELSEWHERE: f64 = 10.0;

/// Without a type, scale factors that are so many powers of ten too small or too large are no gyro's.
const IMPLAUSIBLE_POWER: i32 = 3;

/// No passport is looked for nearer to a pole, where K cannot be found.
const MOST_DEG: f64 = 89.9;

/// A mistake that explains why a result is not that of the gyro.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Mistake {
    /// The columns of the currents are not what they are taken for.
    Currents(CurrentsMistaken),
    /// The passport is of another place.
    OtherPlace {
        /// Astronomic latitude of the place that would explain the result; the longitude is not seen.
        latitude_deg: f64,
    },
}

/// How the columns of the currents differ from J_x and J_y in mA: exchanged first, then reversed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct CurrentsMistaken {
    /// Whether the column of x holds J_y, and that of y J_x.
    pub exchanged: bool,
    /// Whether the column of x has the wrong sign.
    pub x_reversed: bool,
    /// Whether the column of y has the wrong sign.
    pub y_reversed: bool,
    /// The currents are 10 to this power times what they are in mA: 3 for microamperes.
    pub power_of_ten: i32,
}

impl Mistake {
    /// The one mistake that explains clearly what the readings, taken as they are, do not: by the gyro's type, or without
    /// one by the size that is `usual`. `used` is the Earth rate of the passport.
    ///
    /// `None` where the readings do not fit: then no parameters can be compared, and [`Calibration::hint`] says more.
    pub(crate) fn explaining(
        calibration: &Calibration,
        found: &Found,
        used: &EarthRate,
        gyro_type: Option<&GyroType>,
        usual: &GyroParameters,
    ) -> Option<Self> {
        if calibration.hint.is_some() || !calibration.settled {
            return None;
        }
        match gyro_type {
            Some(gyro_type) => {
                by_type(found, used, gyro_type).or_else(|| by_size(found, &gyro_type.nominal.to_model()))
            }
            None => by_size(found, usual),
        }
    }
}

/// By scale factors that are thousands of times too small or too large.
fn by_size(found: &Found, usual: &GyroParameters) -> Option<Mistake> {
    let power_of_ten = power_of_ten(found, usual);
    (power_of_ten.abs() >= IMPLAUSIBLE_POWER)
        .then(|| Mistake::Currents(CurrentsMistaken { power_of_ten, ..CurrentsMistaken::default() }))
}

/// By the verdict against a type on the result with each mistake undone.
fn by_type(found: &Found, used: &EarthRate, gyro_type: &GyroType) -> Option<Mistake> {
    let nominal = gyro_type.nominal.to_model();
    let distance = |found: &Found| distance(&against_type(found, gyro_type));
    let as_read = distance(found);
    // Where the result is close enough as it is, there is nothing to explain.
    if as_read < CLEARLY {
        return None;
    }
    let mut candidates: Vec<(f64, Mistake)> = CurrentsMistaken::all(power_of_ten(found, &nominal))
        .map(|mistaken| (distance(&mistaken.undone(found)), Mistake::Currents(mistaken)))
        .collect();
    candidates.extend(other_place(found, used, &nominal, distance));
    candidates.sort_by(|(one, _), (other, _)| one.total_cmp(other));
    let &(best, mistake) = candidates.first()?;
    let second = candidates.get(1).map_or(as_read, |(second, _)| second.min(as_read));
    (second >= CLEARLY * best.max(1.0)).then_some(mistake)
}

/// How far a result is from its type, in units of what tolerance and expanded uncertainty allow: the farthest parameter
/// counts.
fn distance(verdict: &Verdict) -> f64 {
    let rows = verdict.parameters.iter();
    rows.map(|row| row.deviation.abs() / (row.tolerance + row.expanded_uncertainty)).fold(0.0, f64::max)
}

/// The power of ten by which currents are too large, when it is that which makes K too small.
fn power_of_ten(found: &Found, expected: &GyroParameters) -> i32 {
    let ratio = expected.k_deg_per_h_per_ma.norm() / found.parameters.k_deg_per_h_per_ma.norm();
    if ratio.is_normal() { libm::round(libm::log10(ratio)) as i32 } else { 0 }
}

impl CurrentsMistaken {
    /// Every signed permutation with the power of ten 0 or `power`, but for the one that changes nothing.
    fn all(power: i32) -> impl Iterator<Item = Self> {
        let powers = if power == 0 { vec![0] } else { vec![0, power] };
        let each = powers.into_iter().flat_map(|power_of_ten| {
            (0..8).map(move |bits| Self {
                exchanged: bits & 1 != 0,
                x_reversed: bits & 2 != 0,
                y_reversed: bits & 4 != 0,
                power_of_ten,
            })
        });
        each.filter(|mistaken| *mistaken != Self::default())
    }

    /// K = 10^p K′ P, its uncertainties likewise.
    fn undone(&self, found: &Found) -> Found {
        let sign = |reversed: bool| if reversed { -1.0 } else { 1.0 };
        let (x, y) = (sign(self.x_reversed), sign(self.y_reversed));
        let turn = if self.exchanged { Matrix2::new(0.0, x, y, 0.0) } else { Matrix2::new(x, 0.0, 0.0, y) };
        let scale = libm::pow(10.0, f64::from(self.power_of_ten));
        let mut undone = *found;
        undone.parameters.k_deg_per_h_per_ma *= turn * scale;
        let [x_x, x_y, y_x, y_y, ..] = found.standard_uncertainty;
        let u = Matrix2::new(x_x, x_y, y_x, y_y) * turn.abs() * scale;
        undone.standard_uncertainty[..4].copy_from_slice(&[u.m11, u.m12, u.m21, u.m22]);
        undone
    }
}

/// The latitude whose passport would have led nearest to what is expected, with its distance; `None` where the result as it
/// is, or with other scale factors alone, is not much farther, so that the drifts do not confirm the latitude.
fn other_place(
    found: &Found,
    used: &EarthRate,
    expected: &GyroParameters,
    distance: impl Fn(&Found) -> f64,
) -> Option<(f64, Mistake)> {
    let at = |latitude_deg: f64| distance(&at_latitude(found, used, latitude_deg));
    // A hemisphere has one minimum, but for places near the equator, where both may lead to the same one.
    let coarse = (-89..=89).map(f64::from).min_by(|one, other| at(*one).total_cmp(&at(*other)))?;
    let latitude_deg = minimum((coarse - 1.0).max(-MOST_DEG), (coarse + 1.0).min(MOST_DEG), at);
    let best = at(latitude_deg);
    let mut scaled = *found;
    let k = &found.parameters.k_deg_per_h_per_ma;
    let scale = k.dot(&expected.k_deg_per_h_per_ma) / k.norm_squared();
    scaled.parameters.k_deg_per_h_per_ma *= scale;
    let otherwise = distance(&scaled).min(distance(found));
    (otherwise >= CLEARLY_ELSEWHERE * best.max(1.0)).then_some((best, Mistake::OtherPlace { latitude_deg }))
}

/// The result as the passport of a place at this astronomic latitude would have led to it; gravity is normal gravity at 0 m.
fn at_latitude(found: &Found, used: &EarthRate, latitude_deg: f64) -> Found {
    let there = EarthRate::at_astronomic_latitude(latitude_deg);
    let s = used.horizontal_deg_per_h / there.horizontal_deg_per_h;
    let GyroParameters { k_deg_per_h_per_ma, omega0_deg_per_h, .. } = found.parameters;
    let shift = used.vertical_deg_per_h - s * there.vertical_deg_per_h;
    Found {
        parameters: GyroParameters {
            k_deg_per_h_per_ma: k_deg_per_h_per_ma / s,
            omega0_deg_per_h: omega0_deg_per_h / s,
            omega_g_deg_per_h_per_g: (found.parameters.omega_g_deg_per_h_per_g - shift) / s,
            omega_k_deg_per_h_per_g: found.parameters.omega_k_deg_per_h_per_g / s,
        },
        standard_uncertainty: found.standard_uncertainty.map(|u| u / s),
        gravity_m_per_s2: normal_gravity_m_per_s2(latitude_deg, 0.0),
        gravity_u_m_per_s2: NORMAL_GRAVITY_WITHOUT_HEIGHT_U_M_PER_S2,
    }
}

/// The minimum of a function that has one between `low` and `high`, by ternary search to 1e-6 of their distance.
fn minimum(mut low: f64, mut high: f64, of: impl Fn(f64) -> f64) -> f64 {
    const STEPS: usize = 34;
    for _ in 0..STEPS {
        let third = (high - low) / 3.0;
        if of(low + third) <= of(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    (low + high) / 2.0
}
