//! Causes that act within turn-ons and visits, found by F tests on the differences between the visits to each position.
//!
//! A cause adds columns to the equations of the visits. What it explains of the sum of squares is compared with what it
//! leaves. What was found is removed, and the rest is tried again. A single visit is the case of
//! [Stefansky's test](crate::bibliography::Bibliography::Stefansky72); the probability is Bonferroni's bound.

use super::{Finding, Kind, LEVEL, Scope, jointly};
use crate::calibration::chi_square::{ChiSquare, chi_square};
use crate::calibration::data::Observation;
use crate::calibration::offsets::VisitRows;
use crate::calibration::propagation::Propagation;
use crate::calibration::scatter::{IMPROBABLE, VisitErrors};
use crate::calibration::sensitivity::Sensitivity;
use crate::calibration::{Model, NoLeastSquares, NoiseSource, Options, Readings, Setup, Visit};
use crate::statistics::distributions::chi_square_larger;
use crate::statistics::student::f_larger;
use crate::units::{SECONDS_PER_HOUR, arcseconds_from_radians, sin_cos_of_degrees};
use nalgebra::{DMatrix, DVector, Matrix2, Vector2, Vector3};

/// Most causes that are looked for one after the other.
const MOST: usize = 4;

/// Length of a column, relative to its own, below which it is a combination of others.
const ALONE: f64 = 1e-4;

/// Probability of a larger scatter from which one is as stated.
const AS_STATED: f64 = 0.05;

/// Relative difference of two sums of squares that are equal but for rounding.
const EQUAL: f64 = 1e-6;

/// Time constants of settling that are tried, as fractions of the longest turn-on.
pub(super) const SETTLING: [f64; 3] = [0.05, 0.15, 0.5];

/// Largest difference of K of a turn-on from that which an exchange of currents explains, relative to K.
const SAME_K: f64 = 0.02;

/// Smallest factor that is another range.
const OTHER_RANGE: f64 = 1.5;

/// Probability of the F test below which u(K) contains the scatter of K between turn-ons.
const MAY_DIFFER: f64 = 0.3;

/// Difference of ω_0 between turn-ons that is usual, °/h.
const USUAL_DEG_PER_H: f64 = 0.1;

/// Cause that was found: the columns that it adds, and what they explain.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Explained {
    pub(crate) kind: Kind,
    scope: Scope,
    pub(crate) probability: f64,
    /// Values of the columns.
    values: Vec<f64>,
}

/// Vectors of the columns of a cause in a visit, by the indices of position and visit.
pub(crate) type Columns<'a> = Box<dyn Fn(usize, usize) -> Vec<Vector2<f64>> + 'a>;

struct Candidate<'a> {
    kind: Kind,
    scope: Scope,
    /// Number of candidates of this kind.
    count: usize,
    columns: Columns<'a>,
}

/// Equations of the visits, less what is explained.
pub(crate) struct Layer {
    rows: VisitRows,
    /// Orthonormal directions that are explained.
    taken: Vec<DVector<f64>>,
    left: DVector<f64>,
    degrees_of_freedom: usize,
    /// Least variance of a residual in any case, and whether it is the whole variance as stated.
    least: f64,
    is_stated: bool,
}

impl Layer {
    fn new(setup: &Setup, readings: &Readings, of: &Observation) -> Option<Self> {
        let Observation { data, fit, differences, .. } = of;
        let errors = VisitErrors::new(setup, readings, fit, data.repeats.noise_ma);
        let visit = data.repeats.visit;
        let of_visit = |place, number| errors.with_noise(place, number, visit.deg_per_h);
        let differences = differences.as_ref()?;
        let rows = differences.rows(&fit.unknowns.parameters.k_deg_per_h_per_ma, of_visit)?;
        // An estimated noise contains what is suspect; what is stated explains this much of the scatter in any case.
        let stated = if visit.source == NoiseSource::Estimated { 0.0 } else { visit.deg_per_h };
        let explained =
            |place, number| errors.with_noise(place, number, stated).trace() / of_visit(place, number).trace();
        let least = rows.each.iter().map(|row| explained(row.place, row.visit)).fold(1.0, f64::min);
        Some(Self::of(rows, differences.degrees_of_freedom(), least))
    }

    /// Returns the equations `rows` with these degrees of freedom, whose residuals have `least` as variance in any case; 1 is the
    /// whole variance as stated.
    pub(crate) fn of(mut rows: VisitRows, degrees_of_freedom: usize, least: f64) -> Self {
        let design = std::mem::replace(&mut rows.design, DMatrix::zeros(0, 0));
        let (left, is_stated) = (rows.rates.clone(), least >= 1.0);
        let mut layer = Self { rows, taken: Vec::new(), left, degrees_of_freedom, least, is_stated };
        layer.take(&design);
        layer.degrees_of_freedom = degrees_of_freedom;
        layer
    }

    /// Returns the whitened columns of a cause, less their mean over the visits to each position.
    pub(crate) fn columns(&self, of: &Columns) -> DMatrix<f64> {
        let each: Vec<Vec<Vector2<f64>>> = self.rows.each.iter().map(|row| of(row.place, row.visit)).collect();
        let count = each.first().map_or(0, Vec::len);
        let mut columns = DMatrix::zeros(2 * each.len(), count);
        let mut first = 0;
        for visits in self.rows.each.chunk_by(|one, other| one.place == other.place) {
            let here = || visits.iter().zip(first..);
            for (column, mut filled) in columns.column_iter_mut().enumerate() {
                let mean: Vector2<f64> = here().map(|(row, at)| row.share * each[at][column]).sum();
                for (row, at) in here() {
                    filled.fixed_rows_mut::<2>(2 * at).copy_from(&(row.whitening * (each[at][column] - mean)));
                }
            }
            first += visits.len();
        }
        columns
    }

    /// Returns the orthonormal directions that columns add.
    fn directions(&self, columns: &DMatrix<f64>) -> Vec<DVector<f64>> {
        let mut new: Vec<DVector<f64>> = Vec::new();
        for column in columns.column_iter() {
            let mut left = column.into_owned();
            // Twice, because the first time leaves rounding of the size of the column.
            for _ in 0..2 {
                for taken in self.taken.iter().chain(&new) {
                    left.axpy(-taken.dot(&left), taken, 1.0);
                }
            }
            if left.norm() > ALONE * column.norm() {
                new.push(left.normalize());
            }
        }
        new
    }

    fn take(&mut self, columns: &DMatrix<f64>) {
        for direction in self.directions(columns) {
            self.left.axpy(-direction.dot(&self.left), &direction, 1.0);
            self.taken.push(direction);
            self.degrees_of_freedom = self.degrees_of_freedom.saturating_sub(1);
        }
    }

    /// Returns what columns explain, as probability for one of `count` and as a score, the least of which is the best; `None`
    /// if they explain nothing that can be compared.
    pub(crate) fn tried(&self, columns: &DMatrix<f64>, count: usize) -> Option<(f64, f64, f64)> {
        let directions = self.directions(columns);
        let rank = directions.len();
        let rest = self.degrees_of_freedom.checked_sub(rank).filter(|rest| rank > 0 && *rest > 0)?;
        let gain: f64 = directions.iter().map(|direction| direction.dot(&self.left).powi(2)).sum();
        let others = (self.left.norm_squared() - gain).max(0.0);
        let variance = (others / rest as f64).max(self.least);
        // Of a noise that is stated, and with which the others agree, the variance is known.
        let is_known = self.is_stated && chi_square_larger(others / self.least, rest) >= AS_STATED;
        let freedom = if is_known { f64::INFINITY } else { rest as f64 };
        let probability = (count as f64 * f_larger(gain / rank as f64 / variance, rank, freedom)).min(1.0);
        let all = (rest + rank) as f64;
        let score = all * libm::log(others.max(self.least * all)) + rank as f64 * libm::log(all + 1.0);
        Some((probability, score + 2.0 * libm::log(count as f64), gain))
    }

    /// Returns the values of columns with which they explain most.
    pub(crate) fn values(&self, columns: &DMatrix<f64>) -> Vec<f64> {
        let mut left = columns.clone();
        for (mut column, original) in left.column_iter_mut().zip(columns.column_iter()) {
            for taken in &self.taken {
                column.axpy(-taken.dot(&original), taken, 1.0);
            }
        }
        let found = left.svd(true, true).solve(&self.left, ALONE);
        found.map_or_else(|_| vec![0.0; columns.ncols()], |found| found.data.into())
    }
}

/// Fits the readings with one K of all turn-ons, and with one of each if the differences between visits show that they differ.
/// Returns the fit, and what explains these differences.
pub(crate) fn observe(
    setup: &Setup,
    readings: &Readings,
    model: Model,
    drift: bool,
) -> Result<(Observation, Vec<Explained>), NoLeastSquares> {
    let plain = Observation::plain(setup, readings, model, (drift, false))?;
    let (explained, scale) = explained(setup, readings, &plain);
    let each = if scale { Observation::plain(setup, readings, model, (drift, true)).ok() } else { None };
    Ok((each.unwrap_or(plain), explained))
}

/// Returns the causes that explain the differences between visits, the first one first, and whether every turn-on must have a K
/// of its own. This needs less evidence than naming it, because an uncertainty without the scatter of K would be too small.
fn explained(setup: &Setup, readings: &Readings, of: &Observation) -> (Vec<Explained>, bool) {
    let Some(mut layer) = Layer::new(setup, readings, of) else { return (Vec::new(), false) };
    let mut candidates = candidates(setup, readings, of);
    // A turn-on with few positions has no K of its own.
    let is_determined = |columns: &Columns| {
        let columns = layer.columns(columns);
        layer.directions(&columns).len() == columns.ncols()
    };
    candidates.retain(|candidate| candidate.kind != Kind::KDiffers || is_determined(&candidate.columns));
    let columns: Vec<DMatrix<f64>> = candidates.iter().map(|candidate| layer.columns(&candidate.columns)).collect();
    let of_k = candidates.iter().zip(&columns).filter(|(candidate, _)| candidate.kind == Kind::KDiffers);
    let may_differ =
        of_k.filter_map(|(_, columns)| layer.tried(columns, 1)).any(|(probability, ..)| probability < MAY_DIFFER);
    let mut found: Vec<Explained> = Vec::new();
    while found.len() < MOST {
        let tried = candidates.iter().zip(&columns).filter_map(|(candidate, columns)| {
            let (probability, score, gain) = layer.tried(columns, candidate.count)?;
            Some((candidate, columns, jointly(probability), score, gain))
        });
        let tried: Vec<_> = tried.filter(|(.., probability, _, _)| *probability < LEVEL).collect();
        let Some(best) = tried.iter().min_by(|one, other| one.3.total_cmp(&other.3)) else { break };
        // Of two visits to a position either may be the wrong one.
        let alike = |other: &&(&Candidate, &DMatrix<f64>, f64, f64, f64)| {
            other.0.kind == best.0.kind
                && other.4 * (1.0 + EQUAL) > best.4
                && (best.0.kind == Kind::Visit || other.3 == best.3)
        };
        let explained =
            |(candidate, columns, probability, ..): &(&Candidate, &DMatrix<f64>, f64, f64, f64)| Explained {
                kind: candidate.kind,
                scope: candidate.scope.clone(),
                probability: *probability,
                values: layer.values(columns),
            };
        found.extend(tried.iter().filter(alike).map(explained));
        let columns = best.1.clone();
        layer.take(&columns);
    }
    let differs = found.first().map_or(may_differ, |first| first.kind == Kind::KDiffers);
    (found, differs)
}

/// Returns the time of a visit, h, or its place in the order of the readings; `None` if neither is known of all.
fn time(readings: &Readings) -> Option<impl Fn(&Visit) -> f64> {
    let timed = readings.visits().all(|visit| visit.time_s.is_some());
    let ordered = readings.visits().all(|visit| visit.before.is_some());
    (timed || ordered).then_some(move |visit: &Visit| match visit.time_s.filter(|_| timed) {
        Some(time_s) => time_s / SECONDS_PER_HOUR,
        None => visit.before.unwrap_or(0) as f64,
    })
}

/// Returns the readings with exp(−t/τ) in hours as the time, where t is the time since the first reading of the turn-on and τ
/// this fraction of the longest turn-on; `None` if times are not known or do not differ.
pub(super) fn settling(readings: &Readings, fraction: f64) -> Option<Readings> {
    let time = time(readings)?;
    let range = |cycle: u32| {
        let times = readings.visits().filter(|visit| visit.cycle == cycle).map(&time);
        times.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], t| [least.min(t), most.max(t)])
    };
    let longest = readings.cycles().into_iter().map(|cycle| range(cycle)[1] - range(cycle)[0]).fold(0.0, f64::max);
    let starts: Vec<(u32, f64)> = readings.cycles().into_iter().map(|cycle| (cycle, range(cycle)[0])).collect();
    let of = |visit: &Visit| {
        let start = starts.iter().find(|(cycle, _)| *cycle == visit.cycle).map_or(0.0, |(_, start)| *start);
        SECONDS_PER_HOUR * libm::exp((start - time(visit)) / (fraction * longest))
    };
    (longest > 0.0).then(|| readings.timed_by(of))
}

/// Returns what may explain the differences between visits.
fn candidates<'a>(setup: &'a Setup, readings: &'a Readings, of: &'a Observation) -> Vec<Candidate<'a>> {
    let (positions, offsets) = (readings.positions(), &of.data.offsets);
    let axes = |size: f64| vec![Vector2::new(size, 0.0), Vector2::new(0.0, size)];
    let each =
        positions.iter().enumerate().flat_map(|(place, at)| (0..at.visits.len()).map(move |visit| (place, visit)));
    let each: Vec<(usize, usize)> = each.filter(|(place, _)| positions[*place].visits.len() > 1).collect();
    let count = each.len();
    let of_visit = |(place, visit): (usize, usize)| {
        let found = &positions[place].visits[visit];
        let (cycle, number) = (Some(found.cycle), Some(found.number));
        let scope = Scope { cycle, visit: number, ..Scope::of(positions[place].index) };
        let columns: Columns = Box::new(move |at, one| axes(f64::from(u8::from((at, one) == (place, visit)))));
        Candidate { kind: Kind::Visit, scope, count, columns }
    };
    let mut all: Vec<Candidate> = each.iter().copied().map(of_visit).collect();
    let all_of = |kind, count, columns: Columns<'a>| Candidate { kind, scope: Scope::default(), count, columns };
    if offsets.cycles.len() > 1 && !offsets.scale {
        let (last, others) =
            offsets.cycles.split_last().map_or((0, Vec::new()), |(last, others)| (*last, others.to_vec()));
        all.push(all_of(
            Kind::KDiffers,
            1,
            Box::new(move |place, visit| {
                let (at, cycle) = (&positions[place], positions[place].visits[visit].cycle);
                let of = |other: &u32| if cycle == last { -1.0 } else { f64::from(u8::from(cycle == *other)) };
                others.iter().flat_map(|other| [0, 1].map(|axis| of(other) * at.mean_ma[axis])).flat_map(axes).collect()
            }),
        ));
    }
    let Some(time) = time(readings) else { return all };
    let mut order: Vec<(f64, usize, usize)> = positions
        .iter()
        .enumerate()
        .flat_map(|(place, at)| at.visits.iter().enumerate().map(move |(visit, found)| (found, place, visit)))
        .map(|(found, place, visit)| (time(found), place, visit))
        .collect();
    order.sort_by(|one, other| one.0.total_cmp(&other.0));
    if !offsets.drift {
        all.push(all_of(Kind::Drift, 1, Box::new(move |place, visit| axes(time(&positions[place].visits[visit])))));
    }
    for settled in SETTLING.iter().filter_map(|fraction| settling(readings, *fraction)) {
        let of = move |place: usize, visit: usize| {
            axes(settled.positions()[place].visits[visit].time_s.unwrap_or(0.0) / SECONDS_PER_HOUR)
        };
        // A drift is simpler, and comes first unless settling explains clearly more.
        all.push(all_of(Kind::Settling, 4 * SETTLING.len(), Box::new(of)));
    }
    let sensitivity = Sensitivity::new(setup, &of.fit.unknowns);
    let frame = setup.frame_axis();
    for axis in 0..2 {
        let turned = |place: usize| {
            let about = if axis == 1 { Vector3::z() } else { setup.turns[place].attitude * frame };
            sensitivity.to_case_turns(place) * about
        };
        let mut approach: Vec<Vec<f64>> = positions.iter().map(|at| vec![0.0; at.visits.len()]).collect();
        for pair in order.windows(2) {
            let [from, to] = [pair[0].1, pair[1].1].map(|place| setup.turns[place].angles_deg[axis]);
            if to != from {
                approach[pair[1].1][pair[1].2] = (to - from).signum();
            }
        }
        let columns: Vec<Vector2<f64>> = (0..positions.len()).map(turned).collect();
        let of = move |place: usize, visit: usize| vec![columns[place] * approach[place][visit]];
        all.push(all_of(Kind::Backlash, 2, Box::new(of)));
    }
    all
}

/// Returns what was found in the differences between visits: causes, and turn-ons whose currents are exchanged.
pub(super) fn causes(
    setup: &Setup,
    readings: &Readings,
    (of, explained): (&Observation, &[Explained]),
    options: &Options,
) -> Vec<Finding> {
    let mut found = Vec::new();
    let mut visits = Vec::new();
    for one in explained {
        let Explained { kind, scope, probability, values } = one;
        let new = |size: Option<(f64, &str)>| Finding::new(*kind, scope.clone(), size, *probability);
        let pair = [values[0], values.get(1).copied().unwrap_or(0.0)];
        let norm = libm::hypot(pair[0], pair[1]);
        match kind {
            Kind::KDiffers => {
                let exchanged = turn_ons(setup, readings, of, options, *probability);
                let percent = values.iter().map(|value| value * value).sum::<f64>().sqrt()
                    / of.fit.unknowns.parameters.k_deg_per_h_per_ma.norm()
                    * 100.0;
                found.extend(if exchanged.is_empty() { vec![new(Some((percent, "%")))] } else { exchanged });
            }
            Kind::Visit => {
                let inverse = of.fit.unknowns.parameters.k_deg_per_h_per_ma.try_inverse().unwrap_or_default();
                let current = -(inverse * Vector2::from(pair)) * 1000.0;
                visits.push(Finding { pair: current.into(), ..new(Some((norm, "deg/h"))) });
            }
            Kind::Backlash => found.push(new(Some((2.0 * arcseconds_from_radians(values[0].abs()), "arcsec")))),
            Kind::Drift => found.push(Finding { pair, ..new(Some((norm, drift_unit(readings)))) }),
            _ => found.push(Finding { pair, ..new(Some((norm, "deg/h"))) }),
        }
    }
    if visits.is_empty() && found.is_empty() {
        visits = alone(readings, of);
    }
    found.extend(by_fit(setup, readings, options, visits));
    found
}

fn drift_unit(readings: &Readings) -> &'static str {
    if readings.visits().all(|visit| visit.time_s.is_some()) { "deg/h/h" } else { "deg/h per visit" }
}

/// Returns the visits of which one may be wrong if there are no other differences to compare them with.
fn alone(readings: &Readings, of: &Observation) -> Vec<Finding> {
    let alone = of.differences.as_ref().filter(|differences| differences.degrees_of_freedom() == 2);
    let several = readings.positions().iter().filter(|at| at.visits.len() > 1);
    let each = several.flat_map(|at| at.visits.iter().map(move |visit| (at, visit)));
    alone
        .map(|_| each)
        .into_iter()
        .flatten()
        .map(|(at, visit)| {
            let (cycle, number) = (Some(visit.cycle), Some(visit.number));
            let scope = Scope { cycle, visit: number, ..Scope::of(at.index) };
            let departure = (visit.mean_ma - at.mean_ma) / (1.0 - at.visit_share());
            let rate = of.fit.unknowns.parameters.k_deg_per_h_per_ma * departure;
            let found = Finding::new(Kind::Visit, scope, Some((rate.norm(), "deg/h")), 1.0);
            Finding { pair: (departure * 1000.0).into(), ..found }
        })
        .collect()
}

/// Returns those of several visits or rows, of which one is wrong, that may be the wrong one: if the readings fit the stand
/// far better without another of them, one is not.
///
/// The fits without each of them are compared by Fisher's F, in units of the residuals of the best fit; by chi-square if the
/// noise of the gyro is stated and that fit agrees with it. If there is nothing else to compare them with, this also tells
/// whether any of them is wrong.
pub(super) fn by_fit(setup: &Setup, readings: &Readings, options: &Options, several: Vec<Finding>) -> Vec<Finding> {
    if several.len() < 2 {
        return several;
    }
    let without = |one: &Finding| {
        let rest = one.left_out(readings)?;
        let Observation { data, fit, .. } =
            Observation::plain(setup, &rest, options.model, (options.drift, false)).ok()?;
        Some(chi_square(&Propagation::new(setup, &data, &fit))).filter(ChiSquare::judges)
    };
    let fits: Vec<ChiSquare> = several.iter().map_while(without).collect();
    let best = fits.iter().min_by(|one, other| one.value.total_cmp(&other.value));
    let probabilities: Vec<f64> = best.filter(|_| fits.len() == several.len()).map_or_else(Vec::new, |best| {
        let is_known = setup.uncertainty().visit_deg_per_h.is_some() && best.probability >= AS_STATED;
        let of_residuals = if is_known { f64::INFINITY } else { best.degrees_of_freedom as f64 };
        let freedom = of_residuals.min(best.of_uncertainties);
        let variance = (best.value / best.degrees_of_freedom as f64).max(1.0);
        let squares = fits.iter().map(|fit| (fit.value - best.value) / 2.0 / variance);
        squares.map(|f| (several.len() as f64 * f_larger(f, 2, freedom)).min(1.0)).collect()
    });
    let refuted = probabilities.iter().copied().filter(|probability| *probability < IMPROBABLE).reduce(f64::max);
    let mut rest: Vec<Finding> = match refuted {
        None => several.into_iter().filter(|one| one.probability < LEVEL).collect(),
        Some(refuted) => {
            let rest = several.into_iter().zip(probabilities).filter(|(_, probability)| *probability >= IMPROBABLE);
            let of_all = jointly(refuted);
            rest.map(|(one, _)| Finding { probability: one.probability.min(of_all), ..one }).collect()
        }
    };
    let one_of_several = rest.len() > 1;
    rest.iter_mut().for_each(|one| one.one_of_several = one_of_several);
    rest
}

/// Returns the turn-ons whose K is that of the others with exchanged or reversed currents, another range, or a gyro that is
/// turned in its seat. Of two turn-ons either may be meant.
fn turn_ons(setup: &Setup, readings: &Readings, of: &Observation, options: &Options, probability: f64) -> Vec<Finding> {
    let cycles = &of.data.offsets.cycles;
    let alone = |cycle: &u32| {
        let alone = readings.of_cycle(*cycle);
        let found = Observation::plain(&setup.of_readings(&alone), &alone, options.model, (false, false)).ok()?;
        let parameters = found.fit.unknowns.parameters;
        Some((parameters.k_deg_per_h_per_ma, parameters.omega0_deg_per_h))
    };
    let Some(each) = cycles.iter().map(alone).collect::<Option<Vec<_>>>() else { return Vec::new() };
    let mut found: Vec<(f64, Finding, Matrix2<f64>)> = Vec::new();
    for (place, cycle) in cycles.iter().enumerate() {
        let others = || each.iter().enumerate().filter(|(other, _)| *other != place).map(|(_, one)| one);
        let count = (cycles.len() - 1) as f64;
        let k = others().map(|(k, _)| k).sum::<Matrix2<f64>>() / count;
        // The others must agree with each other.
        let unlike = others().map(|(one, _)| (one - k).norm() / k.norm()).fold(0.0, f64::max);
        let omega0 = others().map(|(_, omega0)| omega0).sum::<Vector2<f64>>() / count;
        let (own, own0) = &each[place];
        let Some(inverse) = k.try_inverse() else { continue };
        let ratio = inverse * own;
        let scope = || Scope { cycle: Some(*cycle), ..Scope::default() };
        let mut add = |kind, scope: Scope, size: Option<(f64, &str)>, map: Matrix2<f64>, expected: Vector2<f64>| {
            let off = ((own - k * map).norm() / k.norm()).max(unlike);
            let bias = (own0 - expected).norm() / USUAL_DEG_PER_H;
            if off < SAME_K {
                let new = Finding::new(kind, scope, size, probability);
                found.push((off / SAME_K + libm::log(1.0 + bias * bias), new, map));
            }
        };
        add(Kind::ColumnsExchanged, scope(), None, Matrix2::new(0.0, 1.0, 1.0, 0.0), omega0);
        add(Kind::ColumnReversed, scope(), None, -Matrix2::identity(), omega0);
        for axis in 0..2 {
            let mut one = Matrix2::identity();
            one[(axis, axis)] = -1.0;
            add(Kind::ColumnReversed, scope().channel(axis), None, one, omega0);
            one[(axis, axis)] = ratio[(axis, axis)];
            if libm::log(one[(axis, axis)].abs()).abs() > libm::log(OTHER_RANGE) {
                add(Kind::Range, scope().channel(axis), Some((1.0 / one[(axis, axis)], "1")), one, omega0);
            }
        }
        let both = ratio.trace() / 2.0;
        if libm::log(both.abs()).abs() > libm::log(OTHER_RANGE) {
            add(Kind::Range, scope(), Some((1.0 / both, "1")), Matrix2::identity() * both, omega0);
        }
        for by_deg in [90.0, 180.0, 270.0] {
            let (sin, cos) = sin_cos_of_degrees(by_deg);
            let back = Matrix2::new(cos, -sin, sin, cos);
            add(Kind::GyroTurned, scope(), Some((by_deg, "deg")), inverse * back * k, back * omega0);
        }
    }
    let best = found.iter().map(|(score, ..)| *score).fold(f64::INFINITY, f64::min);
    found.retain(|(score, ..)| *score < best + 1.0);
    found.sort_by(|one, other| one.0.total_cmp(&other.0));
    let fitted = |map: &Matrix2<f64>, cycle: u32| {
        let mended = readings.mapped(cycle, map);
        let fitted = Observation::plain(setup, &mended, options.model, (options.drift, false)).ok()?;
        Some(fitted.fit.unknowns.parameters)
    };
    found
        .into_iter()
        .map(|(_, one, map)| {
            let parameters = one.scope.cycle.and_then(|cycle| fitted(&map, cycle));
            Finding { parameters, ..one }
        })
        .collect()
}
