//! Causes of readings that do not fit, each a change of the set-up or of the readings that is fitted again.

use super::visits::{SETTLING, settling};
use super::{Finding, Kind, Scope, minimum};
use crate::calibration::chi_square::{self, ChiSquare};
use crate::calibration::data::{Data, Observation};
use crate::calibration::drift::drift_can_be_fitted;
use crate::calibration::least_squares::Fit;
use crate::calibration::propagation::Propagation;
use crate::calibration::sensitivity::Sensitivity;
use crate::calibration::{Model, NoiseSource, Options, Readings, Setup};
use crate::coefficients::PositionIndex;
use crate::gyro::GyroParameters;
use crate::units::arcseconds_from_radians;
use nalgebra::{Matrix2, Vector2};

/// Probability of the remaining chi-square above which a cause is possible.
const POSSIBLE: f64 = 0.001;

/// Difference of chi-square above which the worse of two possible causes is dropped: it is e^(10/2) = 150 times less likely.
const WORSE: f64 = 10.0;

/// Difference of chi-square above which an unstated noise of the gyro is dropped. It is likelier than a fault before any reading.
const UNSTATED: f64 = 20.0;

/// Chi-square that a cause must gain for each number that it chooses.
const PRICE_OF_A_NUMBER: f64 = 2.0;

/// Chi-square that must be gained to suspect the model, or the meter, and the stand, before cheaper causes.
const SUSPICION: [f64; 2] = [4.0, 8.0];

/// Chi-square that a meter must gain for each factor e by which it is worse than stated.
const PRICE_OF_A_FACTOR: f64 = 4.0;

/// Smallest change of an angle that is less likely than a mistake in recording the reading, arcsec.
const GROSS_ARCSEC: f64 = 3600.0;

/// Largest angle by which a gyro or a base is rotated, besides quarters.
pub(super) const LARGEST_ROTATION_DEG: f64 = 10.0;

/// Maximum number of positions that are examined one by one and in pairs; a stand may have many more.
const MOST_SUSPECTS: usize = 24;

/// Cause with which the readings fit, and chi-square with the price of what it chooses.
type Possible = (f64, Finding);

/// The readings, and how they are fitted.
struct Case<'a> {
    setup: &'a Setup,
    readings: &'a Readings,
    data: &'a Data,
    fit: &'a Fit,
    options: &'a Options,
}

/// Returns the causes of readings that do not fit, the most likely first.
pub(super) fn causes(
    setup: &Setup,
    readings: &Readings,
    (data, fit): (&Data, &Fit),
    options: &Options,
    chi_square: &ChiSquare,
) -> Vec<Finding> {
    let case = Case { setup, readings, data, fit, options };
    let suspects = case.suspects();
    let mut possible = case.exchanges(&suspects);
    possible.extend(case.single_positions(&suspects));
    for (index, (score, slip)) in case.slips(&suspects) {
        // An error of any size would rarely equal a reversed or exchanged reading by chance, unless it is small.
        possible.retain(|(other, cause)| {
            let is_here = cause.kind == Kind::Position && cause.scope == Scope::of(index);
            !is_here || cause.size.is_some_and(|arcsec| arcsec < GROSS_ARCSEC) || other + WORSE < score
        });
        possible.push((score, slip));
    }
    let renumbered = numberings(setup).filter_map(|(numbers, places)| {
        let scope = Scope { numbers: Some(numbers), ..Scope::default() };
        possibility(setup, &data.at(&places), fit.of, Finding::new(Kind::Renumbered, scope, None, 0.0))
    });
    let of_all = renumbered.chain(case.other_axes());
    possible.extend(of_all.filter(|(score, _)| score + WORSE <= chi_square.value));
    possible.extend(case.in_time());
    possible.extend(case.general_model());
    possible.extend(case.components());
    possible.sort_by(|one, other| one.0.total_cmp(&other.0));
    let best = possible.first().map_or(0.0, |(score, _)| *score);
    let is_noise = |cause: &Finding| cause.kind == Kind::GyroNoise;
    let is_likely = |(score, cause): &Possible| *score <= best + if is_noise(cause) { UNSTATED } else { WORSE };
    let mut likely: Vec<Finding> = possible.into_iter().filter(is_likely).map(|(_, cause)| cause).collect();
    // An unstated noise of the gyro is listed before a fault of the stand, the meter or the model.
    let accuses = |cause: &Finding| !matches!(cause.kind, Kind::Drift | Kind::Settling | Kind::GyroNoise);
    if let Some(noise) = likely.iter().position(is_noise) {
        let before = likely.iter().position(accuses).unwrap_or(noise).min(noise);
        likely[before..=noise].rotate_right(1);
    }
    likely
}

impl Case<'_> {
    /// Returns the positions to examine, in ascending order: those with the largest misclosures.
    fn suspects(&self) -> Vec<usize> {
        let (fit, data) = (self.fit, self.data);
        let misclosure = |place: usize| (fit.whitening[place] * fit.misclosure(place, &data.currents_ma[place])).norm();
        let mut places: Vec<usize> = (0..data.currents_ma.len()).collect();
        places.sort_by(|&one, &other| misclosure(other).total_cmp(&misclosure(one)));
        places.truncate(MOST_SUSPECTS);
        places.sort_unstable();
        places
    }

    fn index(&self, place: usize) -> PositionIndex {
        self.setup.coefficients().positions[place].index
    }

    fn possibility(&self, data: &Data, cause: Finding) -> Option<Possible> {
        possibility(self.setup, data, self.fit.of, cause)
    }

    /// Returns every exchange of two positions that makes the readings fit.
    fn exchanges(&self, suspects: &[usize]) -> Vec<Possible> {
        let pairs =
            suspects.iter().enumerate().flat_map(|(rank, one)| suspects[rank + 1..].iter().map(|two| (*one, *two)));
        let possible = pairs.filter_map(|(one, other)| {
            let mut places: Vec<usize> = (0..self.data.currents_ma.len()).collect();
            places.swap(one, other);
            let between = Some([one, other].map(|place| [self.index(place).i, self.index(place).j]));
            let scope = Scope { between, ..Scope::default() };
            self.possibility(&self.data.at(&places), Finding::new(Kind::PositionsExchanged, scope, None, 0.0))
        });
        possible.collect()
    }

    /// Returns every position whose reading fits with the sign of a current reversed or with both currents exchanged.
    fn slips(&self, suspects: &[usize]) -> Vec<(PositionIndex, Possible)> {
        let possible = suspects.iter().flat_map(|&place| {
            let (index, [x, y]) = (self.index(place), self.data.currents_ma[place].into());
            let of = |kind, axis: Option<usize>| {
                let scope = axis.into_iter().fold(Scope::of(index), Scope::channel);
                Finding::new(kind, scope, None, 0.0)
            };
            let meant = [
                (Vector2::new(-x, y), of(Kind::ColumnReversed, Some(0))),
                (Vector2::new(x, -y), of(Kind::ColumnReversed, Some(1))),
                (Vector2::new(y, x), of(Kind::ColumnsExchanged, None)),
            ];
            meant.into_iter().filter_map(move |(current_ma, cause)| {
                let mut meant = self.data.clone();
                meant.currents_ma[place] = current_ma;
                Some((index, self.possibility(&meant, cause)?))
            })
        });
        possible.collect()
    }

    /// Returns every quarter by which the frame's axis may be rotated so that the readings fit, and the small angle with which
    /// they fit best.
    fn other_axes(&self) -> Vec<Possible> {
        let of = |by_deg: f64| {
            let turned = self.setup.turned(by_deg);
            let fit = self.data.settled(&turned, self.fit.of);
            fit.map_or(f64::INFINITY, |fit| chi_square::quadratic_form(&Propagation::new(&turned, self.data, &fit)).0)
        };
        let small = minimum(-LARGEST_ROTATION_DEG, LARGEST_ROTATION_DEG, of);
        let angles = [(90.0, 0.0), (180.0, 0.0), (270.0, 0.0), (small, PRICE_OF_A_NUMBER)];
        let possible = angles.into_iter().filter_map(|(by_deg, price)| {
            let turned = self.setup.turned(by_deg);
            let azimuth_deg = (turned.frame_axis_azimuth_deg() * 10.0).round() / 10.0 % 360.0;
            let cause = Finding::new(Kind::FrameAxis, Scope::default(), Some((azimuth_deg, "deg")), 0.0);
            let (score, cause) = possibility(&turned, self.data, self.fit.of, cause)?;
            Some((score + price, cause))
        });
        possible.collect()
    }

    /// Returns a drift in time, and a settling after turn-on, with which the readings fit.
    fn in_time(&self) -> Vec<Possible> {
        if self.options.drift {
            return Vec::new();
        }
        let timed = self.readings.timed_by_order();
        let timed = timed.as_ref().unwrap_or(self.readings);
        let settled = SETTLING.iter().filter_map(|fraction| Some((Kind::Settling, settling(timed, *fraction)?, 3.0)));
        let each = [(Kind::Drift, timed.clone(), 2.0)].into_iter().chain(settled);
        let possible = each.filter_map(|(kind, readings, numbers)| {
            drift_can_be_fitted(self.setup, &readings).ok()?;
            let with = Observation::plain(self.setup, &readings, self.fit.of, (true, false)).ok()?;
            let found = chi_square::chi_square(&Propagation::new(self.setup, &with.data, &with.fit));
            let drift =
                with.fit.drift(&with.data.offsets).filter(|_| found.probability > POSSIBLE && found.judges())?;
            let in_order = self.readings.visits().any(|visit| visit.time_s.is_none());
            let unit = match kind {
                Kind::Settling => "deg/h",
                _ if in_order => "deg/h per visit",
                _ => "deg/h/h",
            };
            let cause = Finding::new(kind, Scope::default(), Some((drift.norm(), unit)), 0.0);
            let cause = Finding { pair: drift.into(), ..cause }.with(with.fit.unknowns.parameters);
            Some((found.value + numbers * PRICE_OF_A_NUMBER, cause))
        });
        // Of the time constants the best is meant.
        let (drift, settling): (Vec<Possible>, Vec<Possible>) =
            possible.partition(|(_, cause)| cause.kind == Kind::Drift);
        let settling = settling.into_iter().min_by(|one, other| one.0.total_cmp(&other.0));
        drift.into_iter().chain(settling).collect()
    }

    /// Returns the general model if the readings, which do not fit the paper's model, fit with it.
    fn general_model(&self) -> Option<Possible> {
        const FURTHER_NUMBERS: f64 = 4.0;
        let cause = Finding::new(Kind::GeneralModel, Scope::default(), None, 0.0);
        let (score, cause) =
            possibility(self.setup, self.data, Model::General, cause).filter(|_| self.fit.of == Model::Paper)?;
        Some((score + FURTHER_NUMBERS * PRICE_OF_A_NUMBER + SUSPICION[0], cause))
    }

    /// Returns every position without which the other positions fit.
    fn single_positions(&self, suspects: &[usize]) -> Vec<Possible> {
        let possible = suspects.iter().filter_map(|&place| {
            let places: Vec<usize> = (0..self.data.currents_ma.len()).filter(|other| *other != place).collect();
            let (rest, others) = (self.setup.at(&places), self.data.at(&places));
            let fit = others.fit(&rest, self.fit.of).ok()?;
            let found = chi_square::chi_square(&Propagation::new(&rest, &others, &fit));
            if found.degrees_of_freedom == 0 || found.probability <= POSSIBLE {
                return None;
            }
            let at = &self.setup.coefficients().positions[place];
            let misclosure = fit.unknowns.misclosure(at, &self.data.currents_ma[place]);
            let turns = Sensitivity::new(self.setup, &fit.unknowns).to_case_turns(place);
            // Smallest rotation δ with S δ = misclosure: S' (S S')⁻¹ misclosure.
            let angle = (turns * turns.transpose())
                .try_inverse()
                .map_or(f64::NAN, |inverse: Matrix2<f64>| (turns.transpose() * inverse * misclosure).norm());
            let inverse = fit.unknowns.parameters.k_deg_per_h_per_ma.try_inverse()?;
            let size = Some((arcseconds_from_radians(angle), "arcsec"));
            let cause = Finding::new(Kind::Position, Scope::of(at.index), size, 0.0).with(fit.unknowns.parameters);
            let pair = (-(inverse * misclosure) * 1000.0).into();
            Some((found.value + 2.0 * PRICE_OF_A_NUMBER, Finding { pair, ..cause }))
        });
        possible.collect()
    }

    /// Returns what would explain the residuals of all positions together as a further scatter: a noise of the gyro that is not
    /// stated, a meter that is worse than stated, and deviations of another stand, each with its size.
    ///
    /// The score is −2 ln of the likelihood of the residuals relative to that with the stated uncertainties.
    fn components(&self) -> Vec<Possible> {
        let (setup, fit, data) = (self.setup, self.fit, self.data);
        let propagation = Propagation::new(setup, data, fit);
        let sensitivity = propagation.sensitivity();
        let k = fit.unknowns.parameters.k_deg_per_h_per_ma;
        let share = |place: usize| data.repeats.return_share(place);
        let noise = |place: usize| Matrix2::from_diagonal_element(share(place));
        let meter = |place: usize| {
            let variance = fit.currents_ma[place].map(|current| setup.uncertainty().meter.own_variance_ma2(current));
            k * Matrix2::from_diagonal(&variance) * k.transpose()
        };
        let stand = |place: usize| {
            let turns = sensitivity.to_case_turns(place);
            turns * turns.transpose()
        };
        let of = |own: &dyn Fn(usize) -> Matrix2<f64>,
                  kind,
                  unit: &str,
                  size: &dyn Fn(f64) -> f64,
                  price: &dyn Fn(f64) -> f64| {
            let own: Vec<Matrix2<f64>> =
                fit.whitening.iter().enumerate().map(|(place, w)| w * own(place) * w.transpose()).collect();
            let terms = chi_square::terms_of(&propagation, &own)?;
            let score = |log: f64| terms.iter().map(|term| term.score(libm::exp(log))).sum::<f64>();
            let log = minimum(-40.0, 40.0, score);
            let size = size(libm::exp(log / 2.0));
            Some((
                score(log) + PRICE_OF_A_NUMBER + price(size),
                Finding::new(kind, Scope::default(), Some((size, unit)), 0.0),
            ))
        };
        // What repeated visits show, or the type states, is no unstated noise.
        let of_gyro = (data.repeats.visit.source == NoiseSource::NotStated).then(|| {
            let (score, cause) = of(&noise, Kind::GyroNoise, "deg/h", &|size| size, &|_| 0.0)?;
            let noisy = setup.clone().with(|u| u.visit_deg_per_h = cause.size);
            let refit = Data::new(&noisy, self.readings).fit(&noisy, fit.of).ok()?;
            Some((score, cause.with(refit.unknowns.parameters)))
        });
        // Few meters are worse than their specification by a large factor; another stand has any deviations.
        let far = |factor: f64| SUSPICION[0] + PRICE_OF_A_FACTOR * libm::log(factor);
        let of_meter = of(&meter, Kind::Meter, "1", &|size| libm::hypot(size, 1.0), &far);
        let of_stand = of(&stand, Kind::Stand, "arcsec", &arcseconds_from_radians, &|_| SUSPICION[1]);
        of_gyro.flatten().into_iter().chain(of_meter).chain(of_stand).collect()
    }
}

/// Returns every other numbering of the paper's eight positions in words, with the place of the reading for each position: θ
/// exchanged, φ counted in the other direction or from another position, or several of these. An exchange of two positions
/// is none.
pub(super) fn numberings(setup: &Setup) -> impl Iterator<Item = (String, Vec<usize>)> {
    let positions = &setup.coefficients().positions;
    let place_of = |i, j| positions.iter().position(|at| at.index == PositionIndex { i, j });
    let numberings = [[1, 2], [2, 1]].into_iter().flat_map(|i| {
        (0..8).map(move |step| (i, [0, 1, 2, 3].map(|j| 1 + (step + if step < 4 { j } else { 4 - j }) % 4)))
    });
    numberings.skip(1).filter_map(move |(i, j)| {
        let mut places: Vec<usize> = (0..positions.len()).collect();
        for (from_i, to_i) in (1..).zip(i) {
            for (from_j, to_j) in (1..).zip(j) {
                places[place_of(to_i, to_j)?] = place_of(from_i, from_j)?;
            }
        }
        Some((numbering(&i, &j), places))
    })
}

/// Returns the numbers of the readings and those of the passport, without those that are the same.
fn numbering(i: &[u32], j: &[u32]) -> String {
    let with_commas = |all: &[u32]| all.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    let other = [("i", i), ("j", j)].into_iter().filter_map(|(name, certified)| {
        let read: Vec<u32> = (1..).zip(certified).map(|(number, _)| number).collect();
        (read != certified).then(|| format!("{name} = {} → {}", with_commas(&read), with_commas(certified)))
    });
    other.collect::<Vec<_>>().join("; ")
}

/// Returns a cause if the readings fit with it: `setup` and `data` are those that it states.
fn possibility(setup: &Setup, data: &Data, model: Model, cause: Finding) -> Option<Possible> {
    let (found, parameters) = fitted(setup, data, model).filter(|(found, _)| found.probability > POSSIBLE)?;
    Some((found.value, cause.with(parameters)))
}

/// Returns chi-square and the parameters of readings.
pub(super) fn fitted(setup: &Setup, data: &Data, model: Model) -> Option<(ChiSquare, GyroParameters)> {
    let fit = data.settled_soon(setup, model)?;
    let found = chi_square::chi_square(&Propagation::new(setup, data, &fit));
    found.value.is_finite().then_some((found, fit.unknowns.parameters))
}
