//! Possible causes if the readings do not fit, as far as the residuals show them.

use super::chi_square;
use super::data::{Data, Observation};
use super::least_squares::Fit;
use super::mistake::{LARGEST_ROTATION_DEG, minimum};
use super::propagation::Propagation;
use super::readings::Readings;
use super::sensitivity::Sensitivity;
use super::{ChiSquare, Model, Setup};
use crate::coefficients::PositionIndex;
use crate::gyro::GyroParameters;
use crate::text::number::{exponent_as_printed, two_digits};
use crate::units::{ARCSECONDS_PER_DEGREE, arcseconds_from_radians};
use nalgebra::{Matrix2, Vector2};
use std::fmt;

/// Probability of chi-square below which a fit is examined. A correct calibration is therefore examined with this
/// probability if errors are normal, and with a smaller one if they are uniform.
pub(crate) const ALARM: f64 = 0.005;

/// Probability of the remaining chi-square above which an explanation is possible.
const POSSIBLE: f64 = 0.001;

/// Difference of chi-square above which the worse of two possible explanations is dropped: it is e^(10/2) = 150 times
/// less likely.
pub(super) const WORSE: f64 = 10.0;

/// Chi-square that an explanation with two free numbers must gain over one without, to be preferred.
const PRICE_OF_TWO_NUMBERS: f64 = 4.0;

/// Chi-square that an explanation with one free number must gain over one without, to be preferred.
const PRICE_OF_ONE_NUMBER: f64 = 2.0;

/// Smallest change of an angle that is less likely than a mistake in recording the reading, arcsec.
const GROSS_ARCSEC: f64 = ARCSECONDS_PER_DEGREE;

/// Maximum number of positions that are examined one by one and in pairs; a stand may have many more.
const MOST_SUSPECTS: usize = 24;

/// Consequence of readings that do not fit the stand, as a sentence without a full stop.
pub(crate) const INCONSISTENT: &str = "the readings are not consistent with this stand; the parameters are not valid: \
                                       find the cause and repeat the calibration";

/// Possible causes of readings that do not fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Hint {
    /// Possible explanations, the best first. If empty, none of the known errors explains the readings; several
    /// positions differ at once.
    pub explanations: Vec<Explanation>,
    /// Parameters with each explanation.
    pub(crate) parameters: Vec<GyroParameters>,
    /// Rough size of the angular errors of all positions that would explain the fit, arcsec.
    pub size_arcsec: f64,
}

/// Possible explanation of readings that do not fit.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Explanation {
    /// Exchanged readings of two positions.
    #[error("positions {0} and {1} are exchanged")]
    Exchanged(PositionIndex, PositionIndex),
    /// Reversed sign of the current along an axis, 0 for x and 1 for y, in one position.
    #[error("the sign of J_{} in position {index} is reversed", ["x", "y"][*axis])]
    Sign {
        /// Index (i, j) of the position.
        index: PositionIndex,
        /// Axis of the current.
        axis: usize,
    },
    /// Exchanged currents of one position.
    #[error("J_x and J_y of position {0} are exchanged")]
    ExchangedCurrents(PositionIndex),
    /// Positions that are numbered differently from the certificate.
    #[error("the positions are numbered in another way (readings → passport): {}", numbering(i, j))]
    Renumbered {
        /// Certified i of the readings with i = 1, 2.
        i: [u32; 2],
        /// Certified j of the readings with j = 1, 2, 3, 4.
        j: [u32; 4],
    },
    /// Base that was set up with the frame's axis to another azimuth.
    #[error(
        "the axis of the frame points to an azimuth of about {frame_axis_azimuth_deg}°, not to that of the passport"
    )]
    OtherAxis {
        /// Azimuth of the frame's axis that explains the readings, degrees clockwise from north, to a tenth.
        frame_axis_azimuth_deg: f64,
    },
    /// A gyro with other g-sensitive drifts than those of the paper's model.
    #[error(
        "the gyro has g-sensitive drifts that the paper's model does not describe; --model general fits the readings"
    )]
    OtherModel,
    /// A position that did not repeat, or whose reading is wrong.
    #[error("position {index} did not repeat: {}", either(*angle_arcsec, current_ua))]
    DidNotRepeat {
        /// Index (i, j) of the position.
        index: PositionIndex,
        /// Smallest rotation of the case that explains the readings, arcsec.
        angle_arcsec: f64,
        /// Errors of J_x and J_y that explain the readings, µA.
        current_ua: Vector2<f64>,
    },
}

/// Returns the numbers of the readings and those of the passport, without those that are the same.
pub(crate) fn numbering(i: &[u32], j: &[u32]) -> String {
    let other = [("i", i), ("j", j)].into_iter().filter_map(|(name, certified)| {
        let read: Vec<u32> = (1..).zip(certified).map(|(number, _)| number).collect();
        (read != certified).then(|| format!("{name} = {} → {}", with_commas(&read), with_commas(certified)))
    });
    other.collect::<Vec<_>>().join("; ")
}

/// Returns the change of the angle or the errors of the currents that explain a reading, in words.
fn either(angle_arcsec: f64, current_ua: &Vector2<f64>) -> String {
    let digits = 1 - exponent_as_printed(current_ua.amax(), 2);
    let (scale, decimals) = (libm::pow(10.0, digits.into()), usize::try_from(digits).unwrap_or(0));
    // Adding zero turns -0.0 into 0.0.
    let rounded = |error: f64| format!("{:.decimals$}", (error * scale).round() / scale + 0.0);
    let [x, y] = [current_ua.x, current_ua.y].map(rounded);
    let currents = format!("its currents are wrong by {x} µA in J_x and {y} µA in J_y");
    match angle_arcsec / ARCSECONDS_PER_DEGREE {
        _ if angle_arcsec < GROSS_ARCSEC => {
            format!("its angle changed by {}″, or {currents}", two_digits(angle_arcsec))
        }
        // No stand turns so far by itself.
        angle_deg if angle_deg > 90.0 => currents,
        angle_deg => format!("{currents}, or its angle changed by {}°", two_digits(angle_deg)),
    }
}

impl Hint {
    /// Returns `true` if an explanation concerns all positions: deviations that are little larger than the noise may agree
    /// with it by chance, although the stand is another one.
    pub(crate) fn may_be_another_stand(&self) -> bool {
        let is_of_all = |explanation: &Explanation| {
            matches!(explanation, Explanation::Renumbered { .. } | Explanation::OtherAxis { .. })
        };
        self.explanations.iter().any(is_of_all)
    }

    /// Drops the explanations whose parameters `is_possible` rejects.
    pub(crate) fn retain(&mut self, is_possible: impl Fn(&GyroParameters) -> bool) {
        let all = self.explanations.drain(..).zip(self.parameters.drain(..));
        (self.explanations, self.parameters) = all.filter(|(_, found)| is_possible(found)).unzip();
    }

    /// Returns the possible causes as a sentence without a full stop.
    pub(crate) fn causes(&self) -> String {
        if self.explanations.is_empty() {
            return format!(
                "no single position, no exchange or other numbering of positions and no other azimuth of the frame's axis \
                 explains this; the passport may be that of another stand (all positions differ by about {}″), or the gyro \
                 may have drifted, or the stand may have moved, during the run, or the uncertainties of the meter in the \
                 laboratory file are too small",
                two_digits(self.size_arcsec)
            );
        }
        let causes = self.each_cause();
        let plural = if causes.len() > 1 { "s" } else { "" };
        format!("possible cause{plural}: {}", causes.join(", or "))
    }

    /// Returns each possible cause in words; none if no known error explains the readings.
    pub(crate) fn each_cause(&self) -> Vec<String> {
        let mut causes: Vec<String> = self.explanations.iter().map(ToString::to_string).collect();
        causes.extend(self.may_be_another_stand().then(|| "the passport is that of another stand".to_owned()));
        causes
    }
}

impl fmt::Display for Hint {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let and = if self.explanations.is_empty() { ", and" } else { ";" };
        write!(f, "the readings do not fit{and} {}", self.causes())
    }
}

fn with_commas(indices: &[u32]) -> String {
    indices.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

/// Returns a hint if chi-square is improbable, otherwise `None`.
pub(crate) fn hint(setup: &Setup, data: &Data, model: Model, chi_square: &ChiSquare) -> Option<Hint> {
    // A chi-square that is NaN is not a good fit either.
    if chi_square.degrees_of_freedom == 0 || chi_square.probability >= ALARM {
        return None;
    }
    let fit = data.fit(setup, model).ok()?;
    let suspects = suspects(setup, data, &fit);
    let mut possible = exchanges(setup, data, model, &suspects);
    possible.extend(single_positions(setup, data, model, &suspects));
    for (index, slip) in slips(setup, data, model, &suspects) {
        // An error of any size would rarely equal a reversed or exchanged reading by chance, unless it is small.
        possible.retain(|other| match other.explanation {
            Explanation::DidNotRepeat { index: of, angle_arcsec, .. } => {
                of != index || angle_arcsec < GROSS_ARCSEC || other.score + WORSE < slip.score
            }
            _ => true,
        });
        possible.push(slip);
    }
    let renumbered = numberings(setup)
        .filter_map(|(i, j, places)| possibility(setup, &data.at(&places), model, Explanation::Renumbered { i, j }));
    let of_all = renumbered.chain(other_axes(setup, data, model));
    possible.extend(of_all.filter(|found| found.score + WORSE <= chi_square.value));
    possible.extend(other_model(setup, data, model));
    possible.sort_by(|one, other| one.score.total_cmp(&other.score));
    let best = possible.first().map_or(0.0, |found| found.score);
    possible.retain(|found| found.score <= best + WORSE);
    let (explanations, parameters) = possible.iter().map(|found| (found.explanation, found.parameters)).unzip();
    Some(Hint { explanations, parameters, size_arcsec: size_arcsec(setup, &fit, chi_square) })
}

/// Explanation with which the readings fit.
struct Possible {
    /// Chi-square of the fit, plus the price of the numbers that the explanation has chosen.
    score: f64,
    explanation: Explanation,
    parameters: GyroParameters,
}

/// Returns the indices of the positions to examine, in ascending order: at most `MOST_SUSPECTS`, with the largest
/// misclosures.
fn suspects(setup: &Setup, data: &Data, fit: &Fit) -> Vec<usize> {
    let positions = &setup.coefficients().positions;
    let misclosure = |place: usize| (fit.whitening[place] * fit.misclosure(place, &data.currents_ma[place])).norm();
    let mut places: Vec<usize> = (0..positions.len()).collect();
    places.sort_by(|&one, &other| misclosure(other).total_cmp(&misclosure(one)));
    places.truncate(MOST_SUSPECTS);
    places.sort_unstable();
    places
}

/// Returns every exchange of two positions that makes the readings fit.
fn exchanges(setup: &Setup, data: &Data, model: Model, suspects: &[usize]) -> Vec<Possible> {
    let positions = &setup.coefficients().positions;
    let mut possible = Vec::new();
    for (rank, &one) in suspects.iter().enumerate() {
        for &other in &suspects[rank + 1..] {
            let mut places: Vec<usize> = (0..positions.len()).collect();
            places.swap(one, other);
            let explanation = Explanation::Exchanged(positions[one].index, positions[other].index);
            possible.extend(possibility(setup, &data.at(&places), model, explanation));
        }
    }
    possible
}

/// Returns every position whose reading fits with the sign of a current reversed or with both currents exchanged.
fn slips(setup: &Setup, data: &Data, model: Model, suspects: &[usize]) -> Vec<(PositionIndex, Possible)> {
    let possible = suspects.iter().flat_map(|&place| {
        let index = setup.coefficients().positions[place].index;
        let [x, y] = data.currents_ma[place].into();
        let meant = [
            (Vector2::new(-x, y), Explanation::Sign { index, axis: 0 }),
            (Vector2::new(x, -y), Explanation::Sign { index, axis: 1 }),
            (Vector2::new(y, x), Explanation::ExchangedCurrents(index)),
        ];
        meant.into_iter().filter_map(move |(current_ma, explanation)| {
            let mut meant = data.clone();
            meant.currents_ma[place] = current_ma;
            Some((index, possibility(setup, &meant, model, explanation)?))
        })
    });
    possible.collect()
}

/// Returns every other numbering of the paper's eight positions, with the place of the reading for each position: θ
/// exchanged, φ counted in the other direction or from another position, or several of these. An exchange of two positions
/// is none.
fn numberings(setup: &Setup) -> impl Iterator<Item = ([u32; 2], [u32; 4], Vec<usize>)> {
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
        Some((i, j, places))
    })
}

/// Other numbering of the positions with which the readings fit, and their parameters with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Numbering {
    pub(crate) i: [u32; 2],
    pub(crate) j: [u32; 4],
    pub(crate) chi_square: f64,
    pub(crate) parameters: GyroParameters,
}

/// Returns the other numberings of the positions with which readings fit that also fit as they are numbered: deviations that
/// are no larger than the noise do not show the numbering, but the parameters do.
pub(crate) fn other_numberings(setup: &Setup, readings: &Readings, model: Model, drift: bool) -> Vec<Numbering> {
    let setup = &*setup.of_readings(readings);
    let Ok(Observation { data, .. }) = Observation::new(setup, readings, model, drift) else { return Vec::new() };
    let possible = numberings(setup).filter_map(|(i, j, places)| {
        let data = data.at(&places);
        let fit = data.fit(setup, model).ok().filter(|fit| fit.settled)?;
        let found = chi_square::chi_square(&Propagation::new(setup, &data, &fit));
        let parameters = fit.unknowns.parameters;
        (found.probability > POSSIBLE).then_some(Numbering { i, j, chi_square: found.value, parameters })
    });
    possible.collect()
}

/// Returns every quarter by which the frame's axis may be rotated so that the readings fit, and the small angle with which
/// they fit best.
fn other_axes(setup: &Setup, data: &Data, model: Model) -> Vec<Possible> {
    let of = |by_deg: f64| fitted(&setup.turned(by_deg), data, model).map_or(f64::INFINITY, |(found, _)| found.value);
    let small = minimum(-LARGEST_ROTATION_DEG, LARGEST_ROTATION_DEG, of);
    let angles = [(90.0, 0.0), (180.0, 0.0), (270.0, 0.0), (small, PRICE_OF_ONE_NUMBER)];
    let possible = angles.into_iter().filter_map(|(by_deg, price)| {
        let turned = setup.turned(by_deg);
        let frame_axis_azimuth_deg = (turned.frame_axis_azimuth_deg() * 10.0).round() / 10.0 % 360.0;
        let found = possibility(&turned, data, model, Explanation::OtherAxis { frame_axis_azimuth_deg })?;
        Some(Possible { score: found.score + price, ..found })
    });
    possible.collect()
}

/// Returns the general model as an explanation if the readings, which do not fit the paper's model, fit with it.
fn other_model(setup: &Setup, data: &Data, model: Model) -> Option<Possible> {
    const FURTHER_NUMBERS: f64 = 4.0;
    if model != Model::Paper {
        return None;
    }
    let found = possibility(setup, data, Model::General, Explanation::OtherModel)?;
    Some(Possible { score: found.score + FURTHER_NUMBERS * PRICE_OF_ONE_NUMBER, ..found })
}

/// Returns an explanation if the readings fit with it: `setup` and `data` are those that it states.
fn possibility(setup: &Setup, data: &Data, model: Model, explanation: Explanation) -> Option<Possible> {
    let (found, parameters) = fitted(setup, data, model).filter(|(found, _)| found.probability > POSSIBLE)?;
    Some(Possible { score: found.value, explanation, parameters })
}

/// Returns every position without which the other positions fit.
fn single_positions(setup: &Setup, data: &Data, model: Model, suspects: &[usize]) -> Vec<Possible> {
    let possible = suspects.iter().filter_map(|&place| {
        let places: Vec<usize> = (0..data.currents_ma.len()).filter(|other| *other != place).collect();
        let (rest, others) = (setup.at(&places), data.at(&places));
        let fit = others.fit(&rest, model).ok()?;
        let found = chi_square::chi_square(&Propagation::new(&rest, &others, &fit));
        if found.degrees_of_freedom == 0 || found.probability <= POSSIBLE {
            return None;
        }
        let at = &setup.coefficients().positions[place];
        let misclosure = fit.unknowns.misclosure(at, &data.currents_ma[place]);
        let turns = Sensitivity::new(setup, &fit.unknowns).to_case_turns(place);
        // Smallest rotation δ with S δ = misclosure: S' (S S')⁻¹ misclosure.
        let angle = (turns * turns.transpose())
            .try_inverse()
            .map_or(f64::NAN, |inverse: Matrix2<f64>| (turns.transpose() * inverse * misclosure).norm());
        let inverse = fit.unknowns.parameters.k_deg_per_h_per_ma.try_inverse()?;
        let explanation = Explanation::DidNotRepeat {
            index: at.index,
            angle_arcsec: arcseconds_from_radians(angle),
            current_ua: -(inverse * misclosure) * 1000.0,
        };
        let parameters = fit.unknowns.parameters;
        Some(Possible { score: found.value + PRICE_OF_TWO_NUMBERS, explanation, parameters })
    });
    possible.collect()
}

/// Returns chi-square and the parameters of readings.
fn fitted(setup: &Setup, data: &Data, model: Model) -> Option<(ChiSquare, GyroParameters)> {
    let fit = data.fit(setup, model).ok().filter(|fit| fit.settled)?;
    let found = chi_square::chi_square(&Propagation::new(setup, data, &fit));
    found.value.is_finite().then_some((found, fit.unknowns.parameters))
}

/// Returns the approximate uncertainty, arcsec, that every angle would need for chi-square to have its expected value.
fn size_arcsec(setup: &Setup, fit: &Fit, chi_square: &ChiSquare) -> f64 {
    let sensitivity = Sensitivity::new(setup, &fit.unknowns);
    let per_radian: f64 = fit
        .whitening
        .iter()
        .enumerate()
        .map(|(place, whiten)| (whiten * sensitivity.to_case_turns(place)).norm_squared())
        .sum();
    let rows = 2 * fit.whitening.len();
    let excess = (chi_square.value / chi_square.degrees_of_freedom as f64 - 1.0).max(0.0);
    arcseconds_from_radians((excess * rows as f64 / per_radian).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_are_the_same_are_left_out() {
        let words = |i: [u32; 2], j: [u32; 4]| numbering(&i, &j);
        assert_eq!(words([1, 2], [2, 3, 4, 1]), "j = 1, 2, 3, 4 → 2, 3, 4, 1");
        assert_eq!(words([2, 1], [1, 2, 3, 4]), "i = 1, 2 → 2, 1");
        assert_eq!(words([2, 1], [2, 3, 4, 1]), "i = 1, 2 → 2, 1; j = 1, 2, 3, 4 → 2, 3, 4, 1");
    }
}
