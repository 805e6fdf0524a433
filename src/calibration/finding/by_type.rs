//! Causes that leave no residuals but change the result, recognised by its distance from the gyro type.
//!
//! Each is a change of the set-up or of the readings that is fitted again: exchanged, reversed or scaled currents, the passport
//! of another site, a gyro or a base that is rotated, positions with other numbers. A result is explained by the only change
//! that brings it clearly nearest to the type.

use super::fits::{LARGEST_ROTATION_DEG, fitted, numberings};
use super::{Finding, Kind, Scope, minimum};
use crate::calibration::data::{Data, Observation};
use crate::calibration::{Found, Model, Options, Readings, Setup, Verdict, against_type};
use crate::earth::{NORMAL_GRAVITY_WITHOUT_HEIGHT_U_M_PER_S2, normal_gravity_m_per_s2};
use crate::gyro::{GyroParameters, GyroType};
use nalgebra::Matrix2;

/// Ratio of distances above which a cause clearly explains a result: the result as read, or with any other cause, is this
/// many times farther from the gyro type.
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

/// Largest latitude at which a place is searched; nearer to a pole K cannot be determined.
const MOST_DEG: f64 = 89.9;

/// Step of the search for a place, °.
const COARSE_DEG: f64 = 3.0;

/// Least probability of chi-square, and largest difference of chi-square from the best, of another numbering.
const NUMBERING: (f64, f64) = (0.001, 10.0);

/// Causes that are only recognised by comparison with a gyro type.
pub(crate) const NEED_A_GYRO_TYPE: [&str; 4] = [
    "currents exchanged, reversed, or in a unit that is wrong by a factor below 1000",
    "passport of another site",
    "gyro rotated in its seat, or base about the vertical",
    "positions numbered differently",
];

/// A calibration that is compared with a type.
struct Case<'a> {
    setup: &'a Setup,
    data: Data,
    model: Model,
    found: &'a Found,
    gyro_type: &'a GyroType,
}

/// Causes that act together, and the distance with them.
type Tried = (f64, Vec<Finding>);

/// Returns the causes that clearly explain the result of readings that fit, judged by the gyro type or, without one, by the size
/// of the `usual` parameters.
pub(crate) fn causes(
    (setup, readings, options): (&Setup, &Readings, &Options),
    found: &Found,
    gyro_type: Option<&GyroType>,
    usual: &GyroParameters,
) -> Vec<Finding> {
    let Some(gyro_type) = gyro_type else { return by_size(&found.parameters, usual) };
    // A result that is near enough to the type needs no explanation.
    let as_read = distance(&against_type(found, gyro_type));
    if as_read < CLEARLY {
        return Vec::new();
    }
    let setup = &*setup.of_readings(readings);
    let Ok(Observation { data, fit, .. }) = Observation::plain(setup, readings, options.model, (options.drift, false))
    else {
        return Vec::new();
    };
    let case = Case { setup, data, model: fit.of, found, gyro_type };
    let by_size =
        || if has_drifts(found, gyro_type) { by_size(&found.parameters, &case.nominal()) } else { Vec::new() };
    let each: [&dyn Fn() -> Vec<Finding>; 4] =
        [&|| case.nearest(as_read), &|| case.scaled(as_read), &by_size, &|| case.renumbered(as_read)];
    each.iter().map(|of| of()).find(|causes| !causes.is_empty()).unwrap_or_default()
}

/// Drops the causes of readings that do not fit whose parameters are far from the gyro type, if those of another are near it.
pub(crate) fn narrow(causes: &mut Vec<Finding>, found: &Found, gyro_type: &GyroType) {
    let distance = |cause: &Finding| {
        cause.parameters.map(|parameters| distance(&against_type(&Found { parameters, ..*found }, gyro_type)))
    };
    let nearest = causes.iter().filter_map(distance).fold(f64::INFINITY, f64::min);
    if nearest < CLEARLY {
        causes.retain(|cause| distance(cause).is_none_or(|far| far < CLEARLY * nearest.max(1.0)));
    }
}

/// Returns an error of the unit if the scale factors are a thousand times or more too small or too large.
pub(crate) fn by_size(found: &GyroParameters, usual: &GyroParameters) -> Vec<Finding> {
    let power = power_of_ten(found, usual);
    let range = || Finding::new(Kind::Range, Scope::default(), Some((libm::pow(10.0, power.into()), "1")), 0.0);
    (power.abs() >= IMPLAUSIBLE_POWER).then(range).into_iter().collect()
}

/// Returns `true` if the drifts, which do not depend on the unit of the currents, are not far from those of the gyro type.
fn has_drifts(found: &Found, gyro_type: &GyroType) -> bool {
    let verdict = against_type(found, gyro_type);
    let mut drifts = verdict.parameters.iter().filter(|row| row.parameter.place() >= 4);
    drifts.all(|row| row.deviation.abs() <= FAR_OUT * (row.tolerance + row.expanded_uncertainty))
}

/// Returns the power of ten by which the currents would be too large if this alone made K too small.
fn power_of_ten(found: &GyroParameters, expected: &GyroParameters) -> i32 {
    let ratio = expected.k_deg_per_h_per_ma.norm() / found.k_deg_per_h_per_ma.norm();
    if ratio.is_normal() { libm::round(libm::log10(ratio)) as i32 } else { 0 }
}

/// Returns the distance of a result from its type: the largest deviation of a parameter, in units of its tolerance plus
/// its expanded uncertainty.
fn distance(verdict: &Verdict) -> f64 {
    let rows = verdict.parameters.iter();
    rows.map(|row| row.deviation.abs() / (row.tolerance + row.expanded_uncertainty)).fold(0.0, f64::max)
}

/// Returns a cause that acts everywhere.
fn one(kind: Kind, size: (f64, &str)) -> Vec<Finding> {
    vec![Finding::new(kind, Scope::default(), Some(size), 0.0)]
}

impl Case<'_> {
    fn nominal(&self) -> GyroParameters {
        self.gyro_type.nominal.to_model()
    }

    fn distance(&self, found: &Found) -> f64 {
        distance(&against_type(found, self.gyro_type))
    }

    /// Returns the result of other readings on another set-up. Its uncertainties are those of the result, relative to K.
    fn refitted(&self, setup: &Setup, data: &Data) -> Option<Found> {
        let fit = data.settled(setup, self.model)?;
        let (parameters, found) = (fit.unknowns.parameters, &self.found);
        let scale = parameters.k_deg_per_h_per_ma.norm() / found.parameters.k_deg_per_h_per_ma.norm();
        let values = found.parameters.to_vector();
        let each = parameters.to_vector();
        let kept = std::array::from_fn(|place| if values[place].is_nan() { f64::NAN } else { each[place] });
        let mut standard_uncertainty = found.standard_uncertainty;
        standard_uncertainty[..4].iter_mut().for_each(|u| *u *= scale);
        Some(Found { parameters: GyroParameters::from_vector(&kept), standard_uncertainty, ..*self.found })
    }

    /// Returns causes with the distance of the result from the type with them.
    fn tried(&self, setup: &Setup, data: &Data, causes: Vec<Finding>) -> Tried {
        let Some(found) = self.refitted(setup, data) else { return (f64::INFINITY, causes) };
        let causes = causes.into_iter().map(|cause| cause.with(found.parameters)).collect();
        (self.distance(&found), causes)
    }

    /// Returns the readings if the currents were J, where the readings are J′ with J = M J′.
    fn mapped(&self, map: Matrix2<f64>) -> Data {
        let mut mapped = self.data.clone();
        mapped.currents_ma.iter_mut().for_each(|current| *current = map * *current);
        mapped
    }

    /// Returns the causes whose removal brings the result clearly nearest to the gyro type.
    fn nearest(&self, as_read: f64) -> Vec<Finding> {
        let mut tried = self.currents();
        let of_currents = tried.iter().map(|(distance, _)| *distance).fold(f64::INFINITY, f64::min);
        tried.extend(self.other_site(as_read));
        tried.push(self.rotated());
        // A gyro with small drifts that is rotated has the currents of exchanged or reversed columns, whose words name the seat.
        let turned = [90.0, 180.0, 270.0].into_iter().flat_map(|by_deg| {
            let azimuth_deg = self.setup.turned(by_deg).frame_axis_azimuth_deg();
            [
                self.tried(&self.setup.case_turned(by_deg), &self.data, one(Kind::GyroTurned, (by_deg, "deg"))),
                self.tried(&self.setup.turned(by_deg), &self.data, one(Kind::FrameAxis, (azimuth_deg, "deg"))),
            ]
        });
        tried.extend(turned.filter(|(near, _)| *near < CLEARLY && of_currents >= CLEARLY * near.max(1.0)));
        tried.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        let second = tried.get(1).map_or(as_read, |(second, _)| second.min(as_read));
        // A cause that leaves a gyro far outside its tolerances explains nothing: it may be in the file of the type.
        let best = tried.into_iter().next().filter(|(best, _)| *best < FAR_OUT && second >= CLEARLY * best.max(1.0));
        best.map_or_else(Vec::new, |(_, causes)| causes)
    }

    /// Returns every signed permutation of the currents, alone and in another unit, and the unit alone.
    fn currents(&self) -> Vec<Tried> {
        let power = power_of_ten(&self.found.parameters, &self.nominal());
        let powers = if power == 0 { vec![0] } else { vec![0, power] };
        let each =
            powers.into_iter().flat_map(|power| (0..8).map(move |bits| (power, [1, 2, 4].map(|bit| bits & bit != 0))));
        let tried =
            each.filter(|(power, bits)| *power != 0 || bits.contains(&true)).map(|(power, [exchanged, x, y])| {
                let sign = |reversed: bool| if reversed { -1.0 } else { 1.0 };
                // The columns are first exchanged, then reversed: J = P⁻¹ J′.
                let turn = match exchanged {
                    true => Matrix2::new(0.0, sign(y), sign(x), 0.0),
                    false => Matrix2::new(sign(x), 0.0, 0.0, sign(y)),
                };
                let of = |kind, axis: Option<usize>| {
                    Finding::new(kind, axis.into_iter().fold(Scope::default(), Scope::channel), None, 0.0)
                };
                let reversed = (x || y).then(|| of(Kind::ColumnReversed, (x != y).then_some(usize::from(y))));
                let factor = libm::pow(10.0, f64::from(power));
                let unit = (power != 0).then(|| one(Kind::Range, (factor, "1")));
                let causes = exchanged.then(|| of(Kind::ColumnsExchanged, None)).into_iter().chain(reversed);
                let causes = causes.chain(unit.into_iter().flatten()).collect();
                self.tried(self.setup, &self.mapped(turn / factor), causes)
            });
        tried.collect()
    }

    /// Returns the small rotation of the gyro or of the base with which the result is nearest to the type.
    fn rotated(&self) -> Tried {
        let of = |by_deg: f64, base: bool| {
            let setup = if base { self.setup.turned(by_deg) } else { self.setup.case_turned(by_deg) };
            self.tried(&setup, &self.data, one(Kind::Rotated, (by_deg.abs(), "deg")))
        };
        let nearest = [false, true]
            .map(|base| of(minimum(-LARGEST_ROTATION_DEG, LARGEST_ROTATION_DEG, |by_deg| of(by_deg, base).0), base));
        let [gyro, base] = nearest;
        if gyro.0 <= base.0 { gyro } else { base }
    }

    /// Returns the latitude whose passport would give the result nearest to the type. Returns `None` if the result as read, or
    /// with other scale factors alone, is not much farther, because the drifts then do not confirm the latitude.
    fn other_site(&self, as_read: f64) -> Option<Tried> {
        let of = |latitude_deg: f64| {
            let there = self.refitted(&self.setup.at_latitude(latitude_deg), &self.data)?;
            Some(Found {
                gravity_m_per_s2: normal_gravity_m_per_s2(latitude_deg, 0.0),
                gravity_u_m_per_s2: NORMAL_GRAVITY_WITHOUT_HEIGHT_U_M_PER_S2,
                ..there
            })
        };
        let at = |latitude_deg| of(latitude_deg).map_or(f64::INFINITY, |found| self.distance(&found));
        // A hemisphere has one minimum, except near the equator, where both hemispheres may lead to the same minimum.
        let coarse = (-29..=29).map(|step| COARSE_DEG * f64::from(step)).map(|deg| (at(deg), deg));
        let (_, coarse) = coarse.min_by(|(one, _), (other, _)| one.total_cmp(other))?;
        let latitude_deg = minimum((coarse - COARSE_DEG).max(-MOST_DEG), (coarse + COARSE_DEG).min(MOST_DEG), at);
        let (best, factor) = (at(latitude_deg), self.scale());
        let scaled = self.refitted(self.setup, &self.mapped(Matrix2::identity() / factor))?;
        let otherwise = self.distance(&scaled).min(as_read);
        let mut cause = one(Kind::OtherSite, (latitude_deg, "deg"));
        cause[0].parameters = of(latitude_deg).map(|found| found.parameters);
        (otherwise >= CLEARLY_ELSEWHERE * best.max(1.0)).then_some((best, cause))
    }

    /// Returns the factor with which all scale factors come nearest to the nominal ones.
    fn scale(&self) -> f64 {
        let k = &self.found.parameters.k_deg_per_h_per_ma;
        k.dot(&self.nominal().k_deg_per_h_per_ma) / k.norm_squared()
    }

    /// Returns the factor of the currents, of one channel, or of all values of the gyro type, with which a result becomes that
    /// of the type, if it is larger than any change of a torquer.
    fn scaled(&self, as_read: f64) -> Vec<Finding> {
        let (k, nominal) = (&self.found.parameters.k_deg_per_h_per_ma, self.nominal().k_deg_per_h_per_ma);
        let is_large = |factor: f64| {
            !(1.0 / LARGEST_CHANGE_OF_SCALE * 1.001..LARGEST_CHANGE_OF_SCALE * 0.999).contains(&factor.abs())
        };
        let of_channel = [0, 1].map(|axis| {
            let factor = k.column(axis).dot(&nominal.column(axis)) / k.column(axis).norm_squared();
            let mut map = Matrix2::identity();
            map[(axis, axis)] = 1.0 / factor;
            (factor, map, Scope::default().channel(axis))
        });
        let factor = self.scale();
        let of_all = (factor, Matrix2::identity() / factor, Scope::default());
        let each = [of_all].into_iter().chain(of_channel).filter(|(factor, ..)| is_large(*factor));
        let mut tried: Vec<Tried> = each
            .map(|(factor, map, scope)| {
                let cause = Finding::new(Kind::Range, scope, Some((factor, "1")), 0.0);
                self.tried(self.setup, &self.mapped(map), vec![cause])
            })
            .collect();
        if is_large(factor) && factor > 0.0 {
            let values = self.found.parameters.to_vector().map(|value| value * factor);
            let parameters = GyroParameters::from_vector(&values);
            let standard_uncertainty = self.found.standard_uncertainty.map(|u| u * factor);
            let found = Found { parameters, standard_uncertainty, ..*self.found };
            tried.push((self.distance(&found), one(Kind::TypeUnit, (1.0 / factor, "1"))));
        }
        let explains = |(near, _): &Tried| *near < CLEARLY && as_read >= CLEARLY * near.max(1.0);
        tried.into_iter().find(explains).map_or_else(Vec::new, |(_, causes)| causes)
    }

    /// Returns the numbering of the positions with which the readings fit too and the result becomes that of the gyro type, if
    /// there is only one.
    fn renumbered(&self, as_read: f64) -> Vec<Finding> {
        let (least, worse) = NUMBERING;
        let near = numberings(self.setup).filter_map(|(numbers, places)| {
            let data = self.data.at(&places);
            let (fit, parameters) = fitted(self.setup, &data, self.model).filter(|(fit, _)| fit.probability > least)?;
            let distance = self.distance(&Found { parameters, ..*self.found });
            let scope = Scope { numbers: Some(numbers), ..Scope::default() };
            let cause = Finding::new(Kind::Renumbered, scope, None, 0.0).with(parameters);
            (distance < CLEARLY && as_read >= CLEARLY * distance.max(1.0)).then_some((fit.value, cause))
        });
        let mut near: Vec<(f64, Finding)> = near.collect();
        near.sort_by(|one, other| one.0.total_cmp(&other.0));
        let only = near.get(1).is_none_or(|second| second.0 > near[0].0 + worse);
        near.into_iter().take(usize::from(only)).map(|(_, cause)| cause).collect()
    }
}
