//! Errors that do not show in the fit but change the result, recognised by comparison with the expected gyro.
//!
//! Let K, ω_0, ω_n be the actual values and K′, ω_0′, ω_n′ those found. Currents J′ = 10^p P J instead of J, where P is
//! a signed permutation of x and y, give K′ = K P⁻¹ 10^−p and leave the drifts unchanged. A passport of another site,
//! with ω_Γ′ and ω_B′ instead of the acting ω_Γ and ω_B, gives K′ = sK, ω_0′ = sω_0, ω_n′ = sω_n + (ω_B′ − sω_B)·1 with
//! s = ω_Γ′/ω_Γ. A gyro rotated by δ about its spin axis gives K′ = R⁻¹K, ω_0′ = R⁻¹ω_0, ω_n′ = ω_n, where R is Rz(δ) of the
//! x and y axes. A base rotated by δ clockwise gives K′ = RK, ω_0′ = Rω_0, W′ − ω_n′ = R(W − ω_n), where W is ω_B·1 − ω_Γ sin(90° −
//! ψ − δ)·R(−90°), and W′ is W for δ = 0: exactly for 180°, for quarter turns on a stand of the paper's eight positions
//! without deviations. Each of these errors can be undone.

use super::diagnosis::{Hint, Numbering, WORSE};
use super::{Calibration, Found, Verdict, against_type};
use crate::coefficients::EarthRate;
use crate::earth::{NORMAL_GRAVITY_WITHOUT_HEIGHT_U_M_PER_S2, normal_gravity_m_per_s2};
use crate::gyro::{GyroParameters, GyroType};
use crate::units::sin_cos_of_degrees;
use nalgebra::{Matrix2, Vector2};
use serde::{Deserialize, Serialize};

/// Ratio of distances above which an error clearly explains a result: the result as read, or with any other error
/// undone, is this many times farther from the gyro type.
const CLEARLY: f64 = 3.0;

/// Ratio of distances for a passport of another site. It is larger because some latitude always comes near. A site
/// less than about 30 km farther north or south is not recognised.
const CLEARLY_ELSEWHERE: f64 = 10.0;

/// Power of ten in the scale factors from which they are implausible for any gyro, if no type is given.
const IMPLAUSIBLE_POWER: i32 = 3;

/// Deviation of a drift, in units of its tolerance plus its expanded uncertainty, that is not the unit of the currents.
const FAR_OUT: f64 = 100.0;

/// Factor of all scale factors together that no gyro changes by.
const LARGEST_CHANGE_OF_SCALE: f64 = 2.0;

/// Largest angle by which a gyro or a base is rotated, besides quarters.
pub(super) const LARGEST_ROTATION_DEG: f64 = 10.0;

/// Largest latitude at which a place is searched; nearer to a pole K cannot be determined.
const MOST_DEG: f64 = 89.9;

/// Error that explains why a result is not that of the gyro.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Mistake {
    /// Columns of currents that are exchanged, reversed or in another unit.
    Currents(CurrentsMistaken),
    /// A passport of another site.
    OtherPlace {
        /// Astronomic latitude of the site that would explain the result, degrees; the longitude has no effect.
        latitude_deg: f64,
    },
    /// A gyro rotated in its seat about the spin axis.
    GyroTurned {
        /// Angle from the seat to the gyro, anticlockwise about z: 90, 180 or 270 degrees.
        by_deg: u16,
    },
    /// A gyro that is rotated in its seat about the spin axis, or a base about the vertical, by a small angle.
    Rotated {
        /// Angle, degrees, positive.
        by_deg: f64,
    },
    /// A base that was set up with the frame's axis to another quarter.
    OtherAxis {
        /// Azimuth of the frame's axis that would explain the result, degrees clockwise from north.
        frame_axis_azimuth_deg: f64,
    },
    /// Currents that are all too large by a factor that is not a power of ten, such as the voltage across a shunt.
    Scaled {
        /// Factor; below 1 if the currents are too small.
        factor: f64,
    },
    /// Gyro type whose values are all in another unit, such as degrees per second.
    TypeScaled {
        /// Factor by which the parameters are larger than the nominal values.
        factor: f64,
    },
    /// Positions that are numbered differently from the certificate, such as φ in the other direction.
    Renumbered {
        /// Certified i of the readings with i = 1, 2.
        i: [u32; 2],
        /// Certified j of the readings with j = 1, 2, 3, 4.
        j: [u32; 4],
    },
}

/// Difference of the columns of currents from J_x and J_y in mA: first exchanged, then reversed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct CurrentsMistaken {
    /// `true` if the column of x contains J_y, and that of y contains J_x.
    pub exchanged: bool,
    /// `true` if the column of x has the wrong sign.
    pub x_reversed: bool,
    /// `true` if the column of y has the wrong sign.
    pub y_reversed: bool,
    /// Power of ten by which the currents are too large compared with mA; 3 for microamperes.
    pub power_of_ten: i32,
}

impl Mistake {
    /// Errors that are only recognised by comparison with a gyro type.
    pub(crate) const NEED_A_GYRO_TYPE: [&str; 4] = [
        "currents exchanged, reversed, or in a unit that is wrong by a factor below 1000",
        "passport of another site",
        "gyro rotated in its seat, or base about the vertical",
        "positions numbered differently",
    ];

    /// Returns the only error that clearly explains the result, judged by the gyro type or, without one, by the size of
    /// the `usual` parameters. `used` is the Earth rate of the passport.
    ///
    /// Returns `None` if the readings do not fit, because the parameters are then not comparable; [`Calibration::hint`]
    /// contains possible causes.
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
        let Some(gyro_type) = gyro_type else { return Self::by_size(calibration, usual) };
        let by_size =
            || Self::by_size(calibration, &gyro_type.nominal.to_model()).filter(|_| has_drifts(found, gyro_type));
        by_type(found, used, gyro_type).or_else(|| scaled(found, gyro_type)).or_else(by_size)
    }

    /// Returns an error of the unit if the readings fit, and the scale factors are a thousand times or more too small or too
    /// large.
    pub(super) fn by_size(calibration: &Calibration, usual: &GyroParameters) -> Option<Self> {
        let found = calibration.adopted().filter(|_| calibration.hint.is_none() && calibration.settled)?;
        let power_of_ten = power_of_ten(&found.parameters, usual);
        (power_of_ten.abs() >= IMPLAUSIBLE_POWER)
            .then(|| Self::Currents(CurrentsMistaken { power_of_ten, ..CurrentsMistaken::default() }))
    }

    /// Returns the numbering of the positions with which a result that fits, but is not that of the gyro type, becomes it, if
    /// there is only one.
    pub(crate) fn of_numbering(
        found: &Found,
        gyro_type: &GyroType,
        others: impl FnOnce() -> Vec<Numbering>,
    ) -> Option<Self> {
        let distance = |found: &Found| distance(&against_type(found, gyro_type));
        let as_read = distance(found);
        if as_read < CLEARLY {
            return None;
        }
        let near = |other: &Numbering| {
            let distance = distance(&Found { parameters: other.parameters, ..*found });
            distance < CLEARLY && as_read >= CLEARLY * distance.max(1.0)
        };
        let mut near: Vec<Numbering> = others().into_iter().filter(near).collect();
        near.sort_by(|one, other| one.chi_square.total_cmp(&other.chi_square));
        match near.as_slice() {
            [one] => Some(one),
            [one, second, ..] if second.chi_square > one.chi_square + WORSE => Some(one),
            _ => None,
        }
        .map(|Numbering { i, j, .. }| Self::Renumbered { i: *i, j: *j })
    }
}

/// Drops the possible causes of readings that do not fit whose parameters are far from the gyro type, if those of another
/// are near it.
pub(crate) fn narrow_by_type(hint: &mut Hint, found: &Found, gyro_type: &GyroType) {
    let distance = |parameters| distance(&against_type(&Found { parameters, ..*found }, gyro_type));
    let nearest = hint.parameters.iter().map(|&parameters| distance(parameters)).fold(f64::INFINITY, f64::min);
    if nearest < CLEARLY {
        hint.retain(|&parameters| distance(parameters) < CLEARLY * nearest.max(1.0));
    }
}

/// Returns the factor of the currents, or of all values of the gyro type, with which a result becomes that of the type, if it
/// is larger than any change of a torquer.
fn scaled(found: &Found, gyro_type: &GyroType) -> Option<Mistake> {
    let as_read = distance(&against_type(found, gyro_type));
    let factor = scale_to(found, &gyro_type.nominal.to_model());
    if (1.0 / LARGEST_CHANGE_OF_SCALE..=LARGEST_CHANGE_OF_SCALE).contains(&factor) || factor <= 0.0 {
        return None;
    }
    let of_k = |found: &Found, factors: [f64; 8]| {
        let values = found.parameters.to_vector();
        Found {
            parameters: GyroParameters::from_vector(&std::array::from_fn(|place| values[place] * factors[place])),
            standard_uncertainty: std::array::from_fn(|place| found.standard_uncertainty[place] * factors[place]),
            ..*found
        }
    };
    let [k, one] = [factor, 1.0];
    let each = [
        ([k, k, k, k, one, one, one, one], Mistake::Scaled { factor }),
        ([factor; 8], Mistake::TypeScaled { factor: 1.0 / factor }),
    ];
    let explains = |(factors, _): &([f64; 8], Mistake)| {
        let near = distance(&against_type(&of_k(found, *factors), gyro_type));
        near < CLEARLY && as_read >= CLEARLY * near.max(1.0)
    };
    each.into_iter().find(explains).map(|(_, mistake)| mistake)
}

/// Returns `true` if the drifts, which do not depend on the unit of the currents, are not far from those of the gyro type.
fn has_drifts(found: &Found, gyro_type: &GyroType) -> bool {
    let verdict = against_type(found, gyro_type);
    let mut drifts = verdict.parameters.iter().filter(|row| row.parameter.place() >= 4);
    drifts.all(|row| row.deviation.abs() <= FAR_OUT * (row.tolerance + row.expanded_uncertainty))
}

/// Returns the factor with which all scale factors come nearest to the expected ones.
fn scale_to(found: &Found, expected: &GyroParameters) -> f64 {
    let k = &found.parameters.k_deg_per_h_per_ma;
    k.dot(&expected.k_deg_per_h_per_ma) / k.norm_squared()
}

/// Returns the error whose removal brings the result clearly nearest to the gyro type.
fn by_type(found: &Found, used: &EarthRate, gyro_type: &GyroType) -> Option<Mistake> {
    let nominal = gyro_type.nominal.to_model();
    let distance = |found: &Found| distance(&against_type(found, gyro_type));
    let as_read = distance(found);
    // A result that is near enough to the type needs no explanation.
    if as_read < CLEARLY {
        return None;
    }
    let mut candidates: Vec<(f64, Mistake)> = CurrentsMistaken::all(power_of_ten(&found.parameters, &nominal))
        .map(|mistaken| (distance(&mistaken.undone(found)), Mistake::Currents(mistaken)))
        .collect();
    let of_currents = candidates.iter().map(|(distance, _)| *distance).fold(f64::INFINITY, f64::min);
    candidates.extend(other_place(found, used, &nominal, distance));
    candidates.extend(rotated(found, used, distance));
    // A gyro with small drifts that is rotated has the currents of exchanged or reversed columns, whose words name the seat.
    let turned = turned(found, used).map(|(undone, mistake)| (distance(&undone), mistake));
    candidates.extend(turned.filter(|(near, _)| *near < CLEARLY && of_currents >= CLEARLY * near.max(1.0)));
    candidates.sort_by(|(one, _), (other, _)| one.total_cmp(other));
    let &(best, mistake) = candidates.first()?;
    let second = candidates.get(1).map_or(as_read, |(second, _)| second.min(as_read));
    // An error that leaves a gyro far outside its tolerances explains nothing: it may be in the file of the type.
    (best < FAR_OUT && second >= CLEARLY * best.max(1.0)).then_some(mistake)
}

/// Returns the distance of a result from its type: the largest deviation of a parameter, in units of its tolerance plus
/// its expanded uncertainty.
fn distance(verdict: &Verdict) -> f64 {
    let rows = verdict.parameters.iter();
    rows.map(|row| row.deviation.abs() / (row.tolerance + row.expanded_uncertainty)).fold(0.0, f64::max)
}

/// Returns the power of ten by which the currents would be too large if this alone made K too small.
fn power_of_ten(found: &GyroParameters, expected: &GyroParameters) -> i32 {
    let ratio = expected.k_deg_per_h_per_ma.norm() / found.k_deg_per_h_per_ma.norm();
    if ratio.is_normal() { libm::round(libm::log10(ratio)) as i32 } else { 0 }
}

impl CurrentsMistaken {
    /// Returns every signed permutation with the power of ten 0 or `power`, except the identity.
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

    /// Returns the result with this error undone: K = 10^p K′ P, and its uncertainties likewise.
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

/// Returns the result with each turn of the gyro or of the base by a quarter, a half and three quarters undone.
fn turned(found: &Found, used: &EarthRate) -> impl Iterator<Item = (Found, Mistake)> {
    [90_u16, 180, 270].into_iter().flat_map(move |by_deg| {
        let [gyro, base] = turn_undone(found, used, by_deg.into());
        let azimuth_deg = used.frame_axis_azimuth_deg + f64::from(by_deg);
        let other_axis = Mistake::OtherAxis { frame_axis_azimuth_deg: azimuth_deg % 360.0 };
        [(gyro, Mistake::GyroTurned { by_deg }), (base, other_axis)]
    })
}

/// Returns the small rotation of the gyro or of the base without which the result is nearest to the expected one, with its
/// distance.
fn rotated(found: &Found, used: &EarthRate, distance: impl Fn(&Found) -> f64) -> Option<(f64, Mistake)> {
    let nearest = |which: usize| {
        let of = |by_deg| distance(&turn_undone(found, used, by_deg)[which]);
        let by_deg = minimum(-LARGEST_ROTATION_DEG, LARGEST_ROTATION_DEG, of);
        (of(by_deg), Mistake::Rotated { by_deg: by_deg.abs() })
    };
    [nearest(0), nearest(1)].into_iter().min_by(|(one, _), (other, _)| one.total_cmp(other))
}

/// Returns the result with a turn of the gyro by this angle undone, and with that of the base.
fn turn_undone(found: &Found, used: &EarthRate, by_deg: f64) -> [Found; 2] {
    let (sin, cos) = sin_cos_of_degrees(by_deg);
    let turn = Matrix2::new(cos, -sin, sin, cos);
    // ω_n and W have the form [[g, −k], [k, g]], and so has R: (g, k) stands for the matrix.
    let rate = |azimuth_deg: f64| {
        let (sin, _) = sin_cos_of_degrees(90.0 - azimuth_deg);
        Vector2::new(used.vertical_deg_per_h, -used.horizontal_deg_per_h * sin)
    };
    let azimuth_deg = used.frame_axis_azimuth_deg + by_deg;
    let (w_g, w_k) = (found.parameters.omega_g_deg_per_h_per_g, found.parameters.omega_k_deg_per_h_per_g);
    let omega_n = rate(azimuth_deg) - turn * (rate(used.frame_axis_azimuth_deg) - Vector2::new(w_g, w_k));
    let mut base = turned_back(found, &turn);
    base.parameters.omega_g_deg_per_h_per_g = omega_n.x;
    base.parameters.omega_k_deg_per_h_per_g = omega_n.y;
    [turned_back(found, &turn.transpose()), base]
}

/// Returns the result with R K and R ω_0 instead of K and ω_0.
fn turned_back(found: &Found, turn: &Matrix2<f64>) -> Found {
    let mut back = *found;
    back.parameters.k_deg_per_h_per_ma = turn * found.parameters.k_deg_per_h_per_ma;
    back.parameters.omega0_deg_per_h = turn * found.parameters.omega0_deg_per_h;
    let [x_x, x_y, y_x, y_y, x, y, ..] = found.standard_uncertainty;
    let (k, omega0) = (turn.abs() * Matrix2::new(x_x, x_y, y_x, y_y), turn.abs() * Vector2::new(x, y));
    back.standard_uncertainty[..6].copy_from_slice(&[k.m11, k.m12, k.m21, k.m22, omega0.x, omega0.y]);
    back
}

/// Returns the latitude whose passport would give the result nearest to the expected one, with its distance. Returns
/// `None` if the result as read, or with other scale factors alone, is not much farther, because the drifts then do not
/// confirm the latitude.
fn other_place(
    found: &Found,
    used: &EarthRate,
    expected: &GyroParameters,
    distance: impl Fn(&Found) -> f64,
) -> Option<(f64, Mistake)> {
    let at = |latitude_deg: f64| distance(&at_latitude(found, used, latitude_deg));
    // A hemisphere has one minimum, except near the equator, where both hemispheres may lead to the same minimum.
    let coarse = (-89..=89).map(f64::from).min_by(|one, other| at(*one).total_cmp(&at(*other)))?;
    let latitude_deg = minimum((coarse - 1.0).max(-MOST_DEG), (coarse + 1.0).min(MOST_DEG), at);
    let best = at(latitude_deg);
    let mut scaled = *found;
    scaled.parameters.k_deg_per_h_per_ma *= scale_to(found, expected);
    let otherwise = distance(&scaled).min(distance(found));
    (otherwise >= CLEARLY_ELSEWHERE * best.max(1.0)).then_some((best, Mistake::OtherPlace { latitude_deg }))
}

/// Returns the result as it would be with the passport of a place at this astronomic latitude, with normal gravity at
/// 0 m.
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
        degrees_of_freedom: found.degrees_of_freedom,
        gravity_m_per_s2: normal_gravity_m_per_s2(latitude_deg, 0.0),
        gravity_u_m_per_s2: NORMAL_GRAVITY_WITHOUT_HEIGHT_U_M_PER_S2,
    }
}

/// Returns the minimum point of a function with one minimum between `low` and `high`, by ternary search to 1e-6 of
/// their distance.
pub(super) fn minimum(mut low: f64, mut high: f64, of: impl Fn(f64) -> f64) -> f64 {
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
