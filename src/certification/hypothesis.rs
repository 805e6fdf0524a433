//! What may be wrong with a measurement, as one list of hypotheses, and the search for those that explain it.
//!
//! Each hypothesis shifts the values of a layer or lets some of them scatter more, and is a larger fit; one F test compares
//! it with the smaller one. The likeliest is accepted, and the others are tested again with it, up to [`MOST`], so that two
//! cannot hide each other ([Rosner](crate::bibliography::Bibliography::Rosner83)'s procedure). What the others explain as well is then dropped. Bonferroni's bound counts
//! all hypotheses together: each kind has a share of the level, which its hypotheses divide equally.

use super::components::{Combinations, Components};
use super::kind::{Kind, OUTLIER, Part, STEPS_OF_ROUNDING, STRAGGLER, Setting};
use super::layer::{Column, Fit, Layer, Runs};
use super::{AngleReadings, Header};
use crate::calibration::inputs::Turn;
use crate::calibration::recorded::rounding_of;
use crate::statistics::student::f_beyond;
use nalgebra::{DMatrix, DVector, Matrix3, Matrix3xX};
use std::collections::BTreeMap;
use std::rc::Rc;

/// Largest number of hypotheses of a layer that are accepted; with more, the readings do not show what is wrong.
const MOST: usize = 4;

/// Gain of the likeliest shift below which it hides no others.
const LEAST_GAIN: f64 = -4.0;

/// Number of runs above which pairs are not compared: there are too many pairs, and one copy has little effect.
const MOST_PAIRED: usize = 100;

/// Ratio of variances that runs which are no copies of each other may have beyond chance.
const TOO_WELL: f64 = 0.1;

/// Cause to be tried: the rows that it changes, and the form of the change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cause {
    pub(crate) kind: Kind,
    pub(crate) at: At,
    pub(crate) change: Change,
}

/// Readings that a cause concerns; places are counted from 0, in the order of header and runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum At {
    Position(usize),
    /// Angle of a position.
    Angle(usize, usize),
    /// Positions with one value of a setting, degrees.
    Positions(Setting, f64),
    /// All positions that share a value of a setting.
    Setting(Setting),
    /// Rotation of a part between two visits of a run, the places of which are given.
    Visits(Part, [usize; 2]),
    /// Rotation of a part in whole runs.
    Part(Part),
    Axis(usize),
    /// 0, 1, 2 for x, y, z of the platform, 3, 4, 5 for east, north, up of the base.
    RunAxis(usize),
    Runs(usize, usize),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Change {
    /// Shift along one contrast.
    Shift(Runs),
    /// Scatter of the combinations of the rows in every run.
    Scatter,
}

/// Returns the share of a kind in the level of all hypotheses together, with this number of runs.
fn share(kind: Kind, runs: usize) -> f64 {
    match kind {
        Kind::Angle | Kind::RunTurned | Kind::SettingScatter if runs == 3 => 1.0,
        Kind::RunAxisScatter if runs == 3 => 0.25,
        Kind::Angle => 0.65,
        Kind::SettingScatter | Kind::RunTurned => 0.4,
        Kind::Reading => 0.3,
        Kind::Bump | Kind::PositionScatter | Kind::StandMoved => 0.2,
        _ => 0.1,
    }
}

#[derive(Debug, Clone)]
struct Hypothesis {
    cause: Cause,
    rows: Rc<Rows>,
}

/// Rows that change together.
#[derive(Debug)]
struct Rows {
    /// Pattern of the change: rows × sizes.
    pattern: DMatrix<f64>,
    /// Orthonormal combinations of what the layer keeps of it.
    basis: Combinations,
}

/// Accepted hypothesis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Accepted {
    pub(crate) cause: Cause,
    /// Shift along the axes of the pattern, or standard deviation of a scatter along it beyond the usual one, arcsec.
    pub(crate) sizes_arcsec: DVector<f64>,
    /// Probability that chance makes any hypothesis explain as much.
    pub(crate) probability: f64,
}

/// What explains a measurement, and the fit with it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Explanation {
    /// Accepted hypotheses, the most likely first.
    pub(crate) accepted: Vec<Accepted>,
    /// Largest part of the accepted shifts in each row of the means, arcsec.
    pub(crate) biases_arcsec: DVector<f64>,
    /// Components without the accepted shifts of readings.
    pub(crate) components: Components,
    /// Sums of squares of the rotations of the runs without what is accepted of them, by axis, arcsec², and their degrees of
    /// freedom.
    pub(crate) of_runs: Vec<[f64; 2]>,
}

/// What a larger fit explains.
struct Gain {
    /// Probability of explaining as much by chance.
    probability: f64,
    /// Twice the logarithm of the ratio of the likelihoods, less the price of the numbers that were fitted (Schwarz).
    gain: f64,
    sizes_arcsec: DVector<f64>,
}

pub(super) struct Measurement<'a> {
    pub(super) header: &'a Header,
    pub(super) readings: &'a AngleReadings,
    pub(super) components: &'a Components,
}

/// Layer with what is accepted, the columns of its shifts, their fit and what it leaves.
struct Fitted {
    layer: Layer,
    columns: Vec<Column>,
    fit: Fit,
    residual: DMatrix<f64>,
}

impl Measurement<'_> {
    /// Returns the pattern of a rotation of `part` in `places`, rows × axes.
    fn rotation(&self, part: Part, places: &[usize]) -> DMatrix<f64> {
        let model = &self.components.model;
        let axes = if part == Part::Platform { &DMatrix::identity(3, 3) } else { &model.base_axes };
        let attitude = |turn: &Turn| if part == Part::Platform { Matrix3::identity() } else { turn.attitude };
        self.in_places(places, axes.ncols(), |place| attitude(&model.turns[place]) * axes)
    }

    fn in_places(&self, places: &[usize], columns: usize, of: impl Fn(usize) -> Matrix3xX<f64>) -> DMatrix<f64> {
        let mut pattern = DMatrix::zeros(self.components.keeps.nrows(), columns);
        places.iter().for_each(|&place| pattern.view_mut((3 * place, 0), (3, columns)).copy_from(&of(place)));
        pattern
    }

    /// Returns everything that may be wrong.
    fn hypotheses(&self) -> Vec<Hypothesis> {
        let (keeps, runs) = (&self.components.keeps, self.readings.runs.len());
        let turns = &self.components.model.turns;
        let mut all = Vec::new();
        let of_readings = |pattern: DMatrix<f64>| {
            let basis = Combinations::of(&(keeps * &pattern)).filter(|found| found.shared.ncols() > 0)?;
            Some(Rc::new(Rows { pattern, basis }))
        };
        let every_row = DMatrix::identity(keeps.nrows(), keeps.nrows());
        let of_places = |places: &[usize]| {
            let rows: Vec<usize> = places.iter().flat_map(|place| 3 * place..3 * place + 3).collect();
            of_readings(every_row.select_columns(&rows))
        };
        let mut add = |kind, at, change, rows: &Option<Rc<Rows>>| {
            let cause = Cause { kind, at, change };
            all.extend(rows.iter().map(|rows| Hypothesis { cause, rows: Rc::clone(rows) }));
        };
        // A step needs two runs on each side; with one it is that run's.
        let steps = (2..(runs - 1).max(2)).map(|after| Change::Shift(Runs::From(after)));
        let is_read = |place, run: &usize| !self.readings.missing.contains(&(place, *run));
        for (place, turn) in turns.iter().enumerate() {
            let (at, whole) = (At::Position(place), of_places(&[place]));
            let along = |axis| self.in_places(&[place], 1, |_| Matrix3xX::from_columns(&[axis]));
            let axes = turn.axes.map(|axis| of_readings(along(axis)));
            // Of two runs each differs as much from the other.
            for run in (0..if runs == 2 { 1 } else { runs }).filter(|run| is_read(place, run)) {
                let shift = Change::Shift(Runs::One(run));
                (0..3).for_each(|angle| add(Kind::Angle, At::Angle(place, angle), shift, &axes[angle]));
                add(Kind::Reading, at, shift, &whole);
            }
            steps.clone().for_each(|step| add(Kind::PositionMoved, at, step, &whole));
            if runs > 2 {
                add(Kind::PositionScatter, at, Change::Scatter, &whole);
            }
        }
        for setting in Setting::ALL {
            let values = setting.values(&self.header.positions);
            let groups: Vec<Vec<usize>> = values.iter().map(|value| self.places(setting, *value)).collect();
            let axis = |place: usize| Matrix3xX::from_columns(&[setting.axis(&turns[place])]);
            let several = groups.iter().filter(|places| places.len() > 1);
            let shared: Vec<_> = several.map(|places| self.in_places(places, 1, axis).column(0).into_owned()).collect();
            if !shared.is_empty() {
                let rows = of_readings(DMatrix::from_columns(&shared));
                add(Kind::SharedSetting, At::Setting(setting), Change::Scatter, &rows);
            }
            for (value, places) in values.iter().zip(&groups).filter(|(_, places)| groups.len() > 1 && places.len() > 1)
            {
                let at = At::Positions(setting, *value);
                add(Kind::SettingScatter, at, Change::Scatter, &of_places(places));
            }
        }
        if runs < 3 {
            return all;
        }
        for (part, axes) in self.parts() {
            let mut known: BTreeMap<Vec<usize>, Option<Rc<Rows>>> = BTreeMap::new();
            for run in 0..runs {
                let order = self.order(run);
                for first in 2..=order.len().saturating_sub(2) {
                    let mut places = order[first..].to_vec();
                    places.sort_unstable();
                    let of_visits = |places: &Vec<usize>| of_readings(self.rotation(part, places));
                    let rows = known.entry(places).or_insert_with_key(of_visits);
                    let at = At::Visits(part, [order[first - 1], order[first]]);
                    add(Kind::Bump, at, Change::Shift(Runs::One(run)), rows);
                }
            }
            let size = 3 + self.components.base_axes;
            let pattern = DMatrix::identity(size, size).columns_range(axes).into_owned();
            let rows = Combinations::of(&pattern).map(|basis| Rc::new(Rows { pattern, basis }));
            let at = At::Part(part);
            (0..runs).for_each(|run| add(Kind::RunTurned, at, Change::Shift(Runs::One(run)), &rows));
            steps.clone().for_each(|step| add(Kind::StandMoved, at, step, &rows));
            if runs > 3 {
                add(Kind::StandDrift, at, Change::Shift(Runs::Line), &rows);
            }
        }
        all
    }

    /// Returns the parts that can be distinguished, with their rows in the layer of the runs.
    fn parts(&self) -> impl Iterator<Item = (Part, std::ops::Range<usize>)> {
        let parts = [(Part::Platform, 0..3), (Part::Base, 3..3 + self.components.base_axes)];
        parts.into_iter().filter(|(_, axes)| !axes.is_empty())
    }

    fn places(&self, setting: Setting, value: f64) -> Vec<usize> {
        let positions = &self.header.positions;
        (0..positions.len()).filter(|place| setting.of(&positions[*place]) == value).collect()
    }

    /// Returns the places of a run in the order of the rows.
    fn order(&self, run: usize) -> Vec<usize> {
        let is_read = |place: &usize| !self.readings.missing.contains(&(*place, run));
        let mut order: Vec<usize> = (0..self.header.positions.len()).filter(is_read).collect();
        order.sort_by_key(|place| self.readings.line(*place, run));
        order
    }

    /// Returns the readings within the runs as a layer, with what was `accepted` of their scatter.
    fn readings_layer(&self, accepted: &[&Hypothesis]) -> Layer {
        let components = self.components;
        let (mut values, mut keeps) = (DMatrix::from_columns(&components.residuals), components.keeps.clone());
        let mut group: Vec<usize> = (0..keeps.nrows()).map(|row| row % 3).collect();
        let mut is_reduced = false;
        for at in accepted.iter().filter(|at| at.is_scatter()) {
            let Some(places) = self.scattering(at.cause) else {
                let shared = &at.rows.basis.shared;
                values -= shared * shared.tr_mul(&values);
                keeps -= shared * shared.transpose();
                is_reduced = true;
                continue;
            };
            let next = group.iter().max().map_or(0, |last| last + 1);
            places.iter().flat_map(|place| 3 * place..3 * place + 3).for_each(|row| group[row] = next + row % 3);
        }
        let mut layer = Layer::new(values, keeps, group, &self.readings.runs);
        layer.is_reduced = is_reduced;
        layer
    }

    /// Returns a layer with what is accepted; the missing readings, which are predictions, are shifts of their own.
    fn fitted(&self, layer: usize, accepted: &[&Hypothesis]) -> Option<Fitted> {
        let within: Vec<&Hypothesis> = accepted.iter().filter(|at| at.layer() == 0).copied().collect();
        let readings = self.readings_layer(&within);
        let missing = missing_columns(self.components, &self.readings.missing);
        let mut columns: Vec<Column> = missing.map(|column| readings.kept(column)).collect();
        let first = columns.len();
        columns.extend(within.iter().flat_map(|at| at.columns()).map(|column| readings.kept(column)));
        if layer == 0 {
            return Fitted::of(readings, columns);
        }
        // Shifts of readings also rotate their runs.
        let size = 3 + self.components.base_axes;
        let mut values = DMatrix::from_columns(&self.components.effects);
        if let (Some(fit), true) = (readings.fit(&columns.iter().collect::<Vec<_>>()), columns.len() > first) {
            let mut next = first;
            for at in within {
                let Change::Shift(runs) = at.cause.change else { continue };
                let count = at.rows.basis.shared.ncols();
                let turn = at.turn(&fit.sizes.rows(next, count).into_owned());
                values -= readings.shift(runs, &(&self.components.model.solve * &at.rows.pattern * turn));
                next += count;
            }
        }
        let runs = Layer::new(values, DMatrix::identity(size, size), (0..size).collect(), &self.readings.runs);
        Fitted::of(runs, accepted.iter().filter(|at| at.layer() == 1).flat_map(|at| at.columns()).collect())
    }

    /// Returns the places of positions that scatter more than the others, or `None` if a cause concerns no whole positions.
    fn scattering(&self, cause: Cause) -> Option<Vec<usize>> {
        match (cause.change, cause.at) {
            (Change::Scatter, At::Position(place)) => Some(vec![place]),
            (Change::Scatter, At::Positions(setting, value)) => Some(self.places(setting, value)),
            _ => None,
        }
    }

    /// Returns the groups of positions that scatter more than the others.
    pub(super) fn worse(&self, explanation: &Explanation) -> Vec<Vec<usize>> {
        explanation.accepted.iter().filter_map(|at| self.scattering(at.cause)).collect()
    }

    /// Returns the largest part of the shifts of readings in each row of the means, arcsec.
    fn biases_arcsec(&self, accepted: &[&Hypothesis], found: &[Accepted]) -> DVector<f64> {
        let runs = self.readings.runs.len();
        let mut biases = DVector::zeros(self.components.keeps.nrows());
        for (at, found) in accepted.iter().zip(found).filter(|(at, _)| at.layer() == 0) {
            let Change::Shift(shifted) = at.cause.change else { continue };
            let count = if let Runs::From(after) = shifted { after.max(runs - after) } else { 1 };
            biases += &at.rows.pattern * &found.sizes_arcsec * (count as f64 / runs as f64);
        }
        biases
    }

    /// Returns what explains the measurement.
    pub(super) fn explained(&self) -> Option<Explanation> {
        let all = self.hypotheses();
        let is_coarse = self.readings.is_coarse(self.components.pooled_arcsec2.value.sqrt());
        let least_arcsec = STEPS_OF_ROUNDING * self.readings.step_arcsec;
        let mut counts = [0.0; Kind::ALL.len()];
        all.iter().for_each(|at| counts[at.cause.kind as usize] += 1.0);
        let alike = |at: &Hypothesis| counts[at.cause.kind as usize];
        let test = |fitted: &Fitted, at: &Hypothesis| {
            let found = fitted.test(at)?;
            // What is within the rounding is none.
            let span =
                self.readings.runs.last().zip(self.readings.runs.first()).map_or(1, |(last, first)| last - first);
            let is_rounding = match at.cause.change {
                Change::Shift(Runs::Line) => found.sizes_arcsec.amax() * f64::from(span) <= least_arcsec,
                Change::Shift(_) => found.sizes_arcsec.amax() <= least_arcsec,
                Change::Scatter => is_coarse,
            };
            let probability = (alike(at) / share(at.cause.kind, self.readings.runs.len()) * found.probability).min(1.0);
            // Three angles make a reading: neither is likelier for their number.
            let among = if at.cause.kind == Kind::Angle { alike(at) / 3.0 } else { alike(at) };
            let gain = found.gain - 2.0 * libm::log(among);
            (!is_rounding).then_some(Gain { probability, gain, ..found })
        };
        let mut accepted: Vec<&Hypothesis> = Vec::new();
        let mut found: Vec<Accepted> = Vec::new();
        for layer in [0, 1] {
            let greedy = |from_scatter: bool| {
                let mut path: Vec<&Hypothesis> = Vec::new();
                let (mut last, mut gains, mut gain) = (0, 0.0, 0.0);
                while path.len() < MOST {
                    let least = if path.is_empty() && !from_scatter { LEAST_GAIN } else { 0.0 };
                    let known: Vec<&Hypothesis> = accepted.iter().chain(&path).copied().collect();
                    let Some(fitted) = self.fitted(layer, &known) else { break };
                    let others = all
                        .iter()
                        .filter(|at| at.layer() == layer && known.iter().all(|other| other.cause != at.cause));
                    let others = others.filter(|at| !path.is_empty() || at.is_scatter() == from_scatter);
                    let tests = others.filter_map(|at| Some((at, test(&fitted, at)?)));
                    let best = tests.max_by(|(_, a), (_, b)| a.gain.total_cmp(&b.gain));
                    let Some((at, explained)) = best.filter(|(_, best)| best.gain > least) else { break };
                    path.push(at);
                    gains += explained.gain;
                    if explained.probability < STRAGGLER {
                        (last, gain) = (path.len(), gains);
                    }
                }
                path.truncate(last);
                (gain, path)
            };
            let [shifts, scatter] = [false, true].map(|from_scatter| {
                let (gain, path) = greedy(from_scatter);
                (gain, self.pruned(layer, &accepted, path, &test))
            });
            // Shifts of a position in several runs are scatter, and hide it where they are accepted first.
            let is_scatter = scatter.0 > shifts.0 && scatter.1.iter().any(|(at, _)| at.is_scatter());
            let (path, of_path): (Vec<_>, Vec<_>) = if is_scatter { scatter.1 } else { shifts.1 }.into_iter().unzip();
            found.extend(of_path);
            accepted.extend(path);
        }
        let shifts: Vec<&Hypothesis> = accepted.iter().filter(|at| !at.is_scatter()).copied().collect();
        let (readings, runs) = (self.fitted(0, &shifts)?, self.fitted(1, &accepted)?);
        let biases_arcsec = self.biases_arcsec(&accepted, &found);
        if !is_coarse {
            let within = self.fitted(0, &accepted)?;
            found.extend((0..3).map(|axis| {
                let by_chance = 3.0 * beyond_others(&within.fit.rest[..3], axis);
                self.found(Kind::AxisScatter, At::Axis(axis), by_chance)
            }));
        }
        let mut components = self.components.clone();
        components
            .without_shifts(readings.residual.column_iter().map(|run| run.into_owned()).collect(), &readings.fit.rest);
        found.extend(self.unequal(&components, &runs.fit.rest));
        found.extend(self.copied(&readings.residual));
        found.retain(|at| at.probability < STRAGGLER);
        found.sort_by(|a, b| a.probability.total_cmp(&b.probability));
        Some(Explanation { accepted: found, biases_arcsec, components, of_runs: runs.fit.rest })
    }

    /// Returns the hypotheses of a `path` without those that the others explain as well.
    fn pruned<'h>(
        &self,
        layer: usize,
        accepted: &[&Hypothesis],
        mut path: Vec<&'h Hypothesis>,
        test: &dyn Fn(&Fitted, &Hypothesis) -> Option<Gain>,
    ) -> Vec<(&'h Hypothesis, Accepted)> {
        let (mut left, mut place) = (Vec::new(), 0);
        while place < path.len() {
            let mut others: Vec<&Hypothesis> = accepted.iter().chain(&path).copied().collect();
            others.remove(accepted.len() + place);
            let explained = self.fitted(layer, &others).and_then(|fitted| test(&fitted, path[place]));
            match explained.filter(|explained| explained.probability < STRAGGLER) {
                Some(Gain { probability, sizes_arcsec, .. }) => {
                    left.push((path[place], Accepted { cause: path[place].cause, sizes_arcsec, probability }));
                    place += 1;
                }
                None => {
                    path.remove(place);
                    (left, place) = (Vec::new(), 0);
                }
            }
        }
        left
    }

    /// Returns a cause without a shift that chance explains with this probability, all of its kind together.
    fn found(&self, kind: Kind, at: At, by_chance: f64) -> Accepted {
        let probability = (by_chance / share(kind, self.readings.runs.len())).min(1.0);
        let cause = Cause { kind, at, change: Change::Scatter };
        Accepted { cause, sizes_arcsec: DVector::zeros(0), probability }
    }

    /// Returns the axes about which the runs rotate more than about the other two of their part.
    fn unequal(&self, components: &Components, of_runs: &[[f64; 2]]) -> Vec<Accepted> {
        let parts: Vec<_> = self.parts().filter(|(_, axes)| axes.len() == 3 && self.readings.runs.len() > 2).collect();
        let count = 3.0 * parts.len() as f64;
        let unequal = parts.into_iter().flat_map(|(_, axes)| axes).filter_map(|axis| {
            let variation = components.variation(of_runs, axis);
            // Runs of coarse readings may agree about two axes; a variation within the rounding is none.
            let is_seen = variation.own_arcsec2.sqrt() > rounding_of(self.readings.step_arcsec);
            let freedom = of_runs[axis][1];
            let by_chance = count * f_beyond(variation.ratio, freedom, 2.0 * freedom);
            is_seen.then(|| self.found(Kind::RunAxisScatter, At::RunAxis(axis), by_chance))
        });
        unequal.collect()
    }

    /// Returns the pairs of runs that agree too well for two measurements, but for a rotation of the whole.
    fn copied(&self, residual: &DMatrix<f64>) -> Vec<Accepted> {
        let runs = self.readings.runs.len();
        // Coarse readings repeat by themselves.
        let repeats = self.components.pooled_arcsec2.value.sqrt() < self.readings.step_arcsec;
        if repeats || !(3..=MOST_PAIRED).contains(&runs) {
            return Vec::new();
        }
        let freedom = self.components.keeps.trace();
        let pairs = (0..runs).flat_map(|other| (0..other).map(move |one| (one, other)));
        let pairs = pairs.map(|(one, other)| {
            let apart = (residual.column(one) - residual.column(other)).norm_squared() / 2.0;
            let rest = (residual.norm_squared() - apart).max(f64::MIN_POSITIVE);
            let of_rest = freedom * (runs as f64 - 2.0);
            // Positions that scatter differently agree by chance within a few times of it.
            let ratio = TOO_WELL * rest / of_rest * freedom / apart.max(f64::MIN_POSITIVE);
            let chance = f_beyond(ratio, of_rest, freedom);
            self.found(Kind::RunsCopied, At::Runs(one, other), (runs * (runs - 1)) as f64 / 2.0 * chance)
        });
        pairs.filter(|at| at.probability < OUTLIER).collect()
    }
}

/// Returns the fit with a shift for each of the angles of `missing` readings (places of position and run).
pub(super) fn predictions(components: &Components, missing: &[(usize, usize)], runs: &[u32]) -> Option<Fit> {
    let columns: Vec<Column> = missing_columns(components, missing).collect();
    let group = (0..components.keeps.nrows()).map(|row| row % 3).collect();
    let values = DMatrix::from_columns(&components.residuals);
    Layer::new(values, components.keeps.clone(), group, runs).fit(&columns.iter().collect::<Vec<_>>())
}

fn missing_columns(components: &Components, missing: &[(usize, usize)]) -> impl Iterator<Item = Column> {
    let kept = |place: usize, axis| components.keeps.column(3 * place + axis).into_owned();
    missing.iter().flat_map(move |(place, run)| {
        (0..3).map(move |axis| Column { runs: Runs::One(*run), kept: kept(*place, axis) })
    })
}

impl Fitted {
    fn of(layer: Layer, columns: Vec<Column>) -> Option<Self> {
        let each: Vec<&Column> = columns.iter().collect();
        let fit = layer.fit(&each)?;
        let residual = layer.residual(&each, &fit);
        Some(Self { fit, residual, layer, columns })
    }

    /// Returns what a hypothesis explains, given what is accepted.
    fn test(&self, at: &Hypothesis) -> Option<Gain> {
        let is_of_runs = at.layer() == 1;
        if at.is_scatter() {
            let larger = self.layer.without(&self.residual, &self.fit, &at.rows.basis.shared);
            return gain(&self.fit, &larger, None, is_of_runs).map(|(gain, excess)| {
                let size = excess / (self.layer.changes() * at.rows.basis.lengths.norm_squared());
                Gain { sizes_arcsec: DVector::from_element(1, size.max(0.0).sqrt()), ..gain }
            });
        }
        let own: Vec<Column> = at.columns().into_iter().map(|column| self.layer.kept(column)).collect();
        let larger = self.layer.fit(&self.columns.iter().chain(&own).collect::<Vec<_>>())?;
        let sizes = larger.sizes.rows(self.columns.len(), own.len()).into_owned();
        gain(&self.fit, &larger, Some(at.turn(&sizes)), is_of_runs).map(|(gain, _)| gain)
    }
}

/// Returns what a `larger` fit explains, by F of what it leaves, and the sum of squares beyond what chance explains of it; a
/// scatter has no sizes.
///
/// Degrees of freedom are Satterthwaite's, because the groups vary differently. With `few` of them, which are too many where
/// a variance is small by chance, one group alone must show it by its own variance, and all together by a common one.
fn gain(smaller: &Fit, larger: &Fit, sizes_arcsec: Option<DVector<f64>>, few: bool) -> Option<(Gain, f64)> {
    let is_scatter = sizes_arcsec.is_none();
    let (mut seen, mut due, mut squares, mut doubt) = (0.0, 0.0, 0.0, 0.0);
    let (mut all, mut own) = ([0.0; 2], f64::INFINITY);
    let mut shares = Vec::new();
    for ([before, of_before], [after, of_after]) in smaller.rest.iter().zip(&larger.rest) {
        let share = of_before - of_after;
        if share < 1e-9 {
            continue;
        }
        if *of_after < 1e-9 {
            return None;
        }
        let variance = after / of_after;
        seen += before - after;
        due += share * variance;
        squares += share * variance * variance;
        doubt += (share * variance) * (share * variance) / of_after;
        all = [all[0] + share, all[1] + of_after];
        own = own.min(f_beyond((before - after) / share / variance, share, *of_after));
        shares.push((*before, *of_before, *after, *of_after, share, variance));
    }
    let left: f64 = shares.iter().map(|(_, _, after, ..)| after).sum();
    let probability = match few {
        true => own.max(f_beyond(seen / all[0] / (left / all[1]), all[0], all[1])),
        false => f_beyond(seen / due, due * due / squares, due * due / doubt),
    };
    let ratio = libm::log(seen / due);
    let gain = shares.iter().map(|(before, of_before, after, of_after, share, variance)| match is_scatter {
        true => {
            of_before * libm::log(before / of_before)
                - of_after * libm::log(after / of_after)
                - share * (ratio + libm::log(*variance))
        }
        false => of_before * libm::log(before / after),
    });
    let count = smaller.rest.iter().map(|[_, freedom]| freedom).sum::<f64>();
    let price = libm::log(count) * if is_scatter { 1.0 } else { all[0] };
    let gain = gain.sum::<f64>() - price;
    let sizes_arcsec = sizes_arcsec.unwrap_or_else(|| DVector::zeros(0));
    (!probability.is_nan()).then_some((Gain { probability, gain, sizes_arcsec }, seen - due))
}

/// Returns the probability that one of several groups, given by sum of squares and degrees of freedom, varies as much more than
/// the others by chance.
fn beyond_others(groups: &[[f64; 2]], own: usize) -> f64 {
    let [squares, freedom] = groups[own];
    let others = groups.iter().enumerate().filter(|(group, _)| *group != own).map(|(_, rest)| rest);
    let [rest, of_rest] = others.fold([0.0; 2], |[a, b], [squares, freedom]| [a + squares, b + freedom]);
    f_beyond(squares / freedom / (rest / of_rest), freedom, of_rest)
}

impl Hypothesis {
    fn is_scatter(&self) -> bool {
        self.cause.change == Change::Scatter
    }

    /// Returns 0 for the readings within the runs, 1 for the rotations of the runs.
    fn layer(&self) -> usize {
        usize::from(matches!(self.cause.at, At::Part(_)))
    }

    fn columns(&self) -> Vec<Column> {
        let Change::Shift(runs) = self.cause.change else { return Vec::new() };
        self.rows.basis.shared.column_iter().map(|kept| Column { runs, kept: kept.into_owned() }).collect()
    }

    /// Returns the sizes of the pattern from those of its orthonormal combinations.
    fn turn(&self, sizes: &DVector<f64>) -> DVector<f64> {
        self.rows.basis.shares.tr_mul(&sizes.component_div(&self.rows.basis.lengths))
    }
}
