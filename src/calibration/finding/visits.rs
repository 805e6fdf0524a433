//! Causes that act within turn-ons and visits, found by F tests on the differences between the visits to each position.
//!
//! A cause adds columns to the equations of the visits. What it explains of the sum of squares is compared with what it
//! leaves. What was found is removed, and the rest is tried again. A single visit is the case of
//! [Stefansky's test](crate::bibliography::Bibliography::Stefansky72); the probability is Bonferroni's bound.

use super::layer::{AS_STATED, Columns, Explains, Layer};
use super::{Finding, Kind, LEVEL, Scope, jointly};
use crate::calibration::chi_square::{ChiSquare, chi_square};
use crate::calibration::data::Observation;
use crate::calibration::inputs::Turn;
use crate::calibration::offsets::VisitRow;
use crate::calibration::propagation::Propagation;
use crate::calibration::scatter::{IMPROBABLE, VisitErrors};
use crate::calibration::sensitivity::Sensitivity;
use crate::calibration::{Model, NoLeastSquares, NoiseSource, Options, Readings, Setup, Visit};
use crate::statistics::student::f_larger;
use crate::units::{SECONDS_PER_HOUR, arcseconds_from_radians, sin_cos_of_degrees};
use nalgebra::{DMatrix, Matrix2, Vector2, Vector3};
use std::collections::BTreeMap;

/// Most causes that are looked for one after the other.
const MOST: usize = 4;

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

struct Candidate {
    kind: Kind,
    scope: Scope,
    /// Number of candidates of this kind.
    count: usize,
    columns: Columns,
}

/// Returns the equations of the visits; `None` if no position has two.
fn layer(setup: &Setup, readings: &Readings, of: &Observation) -> Option<Layer> {
    let Observation { data, fit, differences, .. } = of;
    let errors = VisitErrors::new(setup, readings, fit, data.repeats.noise_ma);
    let visit = data.repeats.visit;
    let of_visit = |place, number| errors.with_noise(place, number, visit.deg_per_h);
    let differences = differences.as_ref()?;
    let rows = differences.rows(&fit.unknowns.parameters.k_deg_per_h_per_ma, of_visit)?;
    // An estimated noise contains what is suspect; what is stated explains this much of the scatter in any case.
    let stated = if visit.source == NoiseSource::Estimated { 0.0 } else { visit.deg_per_h };
    let explained = |place, number| errors.with_noise(place, number, stated).trace() / of_visit(place, number).trace();
    let least = rows.each.iter().map(|row| explained(row.place, row.visit)).fold(1.0, f64::min);
    Some(Layer::of(rows, differences.degrees_of_freedom(), least))
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
    let Some(mut layer) = layer(setup, readings, of) else { return (Vec::new(), false) };
    let mut candidates = candidates(setup, readings, of, &layer);
    // A turn-on with few positions has no K of its own.
    candidates.retain(|candidate| candidate.kind != Kind::KDiffers || candidate.columns.are_independent());
    let mut may_differ = None;
    let mut found: Vec<Explained> = Vec::new();
    while found.len() < MOST {
        let tried = candidates.iter().map(|one| Some((one, layer.tried(&one.columns, one.count)?)));
        let tried: Vec<(&Candidate, Explains)> = tried.flatten().collect();
        may_differ.get_or_insert_with(|| {
            tried.iter().any(|(one, explains)| one.kind == Kind::KDiffers && explains.probability < MAY_DIFFER)
        });
        let alarms = || tried.iter().filter(|(_, explains)| jointly(explains.probability) < LEVEL);
        let best = alarms().min_by(|(_, one), (_, other)| one.score.total_cmp(&other.score));
        let Some((candidate, best)) = best.copied() else { break };
        // Of two visits to a position either may be the wrong one.
        let alike = alarms().filter(|(other, explains)| {
            other.kind == candidate.kind
                && explains.squares * (1.0 + EQUAL) > best.squares
                && (candidate.kind == Kind::Visit || explains.score == best.score)
        });
        found.extend(alike.map(|(one, explains)| Explained {
            kind: one.kind,
            scope: one.scope.clone(),
            probability: jointly(explains.probability),
            values: layer.values(&one.columns),
        }));
        layer.take(&candidate.columns);
        candidates.iter_mut().for_each(|one| layer.reduce(&mut one.columns));
    }
    let differs = found.first().map_or(may_differ == Some(true), |first| first.kind == Kind::KDiffers);
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

/// Returns the function exp(−t/τ) of a visit, where t is the time since the first reading of the turn-on and τ this fraction of
/// the longest turn-on; `None` if times are not known or do not differ.
fn decay(readings: &Readings, fraction: f64) -> Option<impl Fn(&Visit) -> f64> {
    let time = time(readings)?;
    let mut ranges: BTreeMap<u32, [f64; 2]> = BTreeMap::new();
    for visit in readings.visits() {
        let [first, last] = ranges.entry(visit.cycle).or_insert([f64::INFINITY, f64::NEG_INFINITY]);
        (*first, *last) = (first.min(time(visit)), last.max(time(visit)));
    }
    let longest = ranges.values().map(|[first, last]| last - first).fold(0.0, f64::max);
    let of = move |visit: &Visit| libm::exp((ranges[&visit.cycle][0] - time(visit)) / (fraction * longest));
    (longest > 0.0).then_some(of)
}

/// Returns the readings with [`decay`] in hours as the time, or `None` if there is none.
pub(super) fn settling(readings: &Readings, fraction: f64) -> Option<Readings> {
    decay(readings, fraction).map(|decay| readings.timed_by(|visit| SECONDS_PER_HOUR * decay(visit)))
}

/// Returns what may explain the differences between visits.
fn candidates(setup: &Setup, readings: &Readings, of: &Observation, layer: &Layer) -> Vec<Candidate> {
    let (positions, offsets, rows) = (readings.positions(), &of.data.offsets, &layer.rows);
    let found = |row: &VisitRow| &positions[row.place].visits[row.visit];
    let one = |kind, count, each| Candidate { kind, scope: Scope::default(), count, columns: layer.columns(each) };
    // A number of each visit, or several, acts about x and y alike.
    let alike = |each: DMatrix<f64>| each.kronecker(&Matrix2::identity());
    let by = |of: &dyn Fn(&Visit) -> f64| alike(DMatrix::from_fn(rows.len(), 1, |row, _| of(found(&rows[row]))));
    let of_visit = |(number, row): (usize, &VisitRow)| {
        let Visit { cycle, number: visit, .. } = found(row);
        let scope = Scope { cycle: Some(*cycle), visit: Some(*visit), ..Scope::of(positions[row.place].index) };
        let alone = DMatrix::from_fn(rows.len(), 1, |row, _| f64::from(u8::from(row == number)));
        Candidate { scope, ..one(Kind::Visit, rows.len(), alike(alone)) }
    };
    let mut all: Vec<Candidate> = rows.iter().enumerate().map(of_visit).collect();
    if let Some((last, others)) = offsets.cycles.split_last().filter(|(_, others)| !others.is_empty() && !offsets.scale)
    {
        let of = |row: &VisitRow, other: u32| {
            let cycle = found(row).cycle;
            if cycle == *last { -1.0 } else { f64::from(u8::from(cycle == other)) }
        };
        let each = DMatrix::from_fn(rows.len(), 2 * others.len(), |row, column| {
            of(&rows[row], others[column / 2]) * positions[rows[row].place].mean_ma[column % 2]
        });
        all.push(one(Kind::KDiffers, 1, alike(each)));
    }
    let Some(time) = time(readings) else { return all };
    if !offsets.drift {
        all.push(one(Kind::Drift, 1, by(&time)));
    }
    let decays = SETTLING.iter().filter_map(|fraction| decay(readings, *fraction));
    // A drift is simpler, and comes first unless settling explains clearly more.
    all.extend(decays.map(|decay| one(Kind::Settling, 4 * SETTLING.len(), by(&decay))));
    let places = positions.iter().enumerate();
    let visits = places.flat_map(|(place, at)| at.visits.iter().enumerate().map(move |visit| (place, visit)));
    let mut order: Vec<(f64, usize, usize)> =
        visits.map(|(place, (number, visit))| (time(visit), place, number)).collect();
    order.sort_by(|one, other| one.0.total_cmp(&other.0));
    let (sensitivity, frame) = (Sensitivity::new(setup, &of.fit.unknowns), setup.frame_axis());
    all.extend([0, 1].map(|axis| {
        let turned = |turn: &Turn| if axis == 1 { Vector3::z() } else { turn.attitude * frame };
        let angle = |place: usize| setup.turns[place].angles_deg[axis];
        let moves = order.windows(2).map(|pair| {
            let moved = angle(pair[1].1) - angle(pair[0].1);
            ((pair[1].1, pair[1].2), if moved == 0.0 { 0.0 } else { moved.signum() })
        });
        let approach: BTreeMap<(usize, usize), f64> = moves.collect();
        let each = rows.iter().flat_map(|VisitRow { place, visit, .. }| {
            let column = sensitivity.to_case_turns(*place) * turned(&setup.turns[*place]);
            let [x, y]: [f64; 2] = (column * approach.get(&(*place, *visit)).copied().unwrap_or(0.0)).into();
            [x, y]
        });
        one(Kind::Backlash, 2, DMatrix::from_iterator(2 * rows.len(), 1, each))
    }));
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
