//! Possible causes if the readings do not fit, as far as the residuals show them.

use super::chi_square::{self, ChiSquare};
use super::data::Data;
use super::inputs::Setup;
use super::least_squares::Fit;
use super::sensitivity::Sensitivity;
use super::unknowns::Model;
use crate::coefficients::PositionIndex;
use crate::text::number::{exponent_as_printed, two_digits};
use crate::units::arcseconds_from_radians;
use nalgebra::{Matrix2, Vector2};
use std::fmt;

/// Probability of chi-square below which a fit is examined. A correct calibration is therefore examined with this
/// probability if errors are normal, and with a smaller one if they are uniform.
pub(crate) const ALARM: f64 = 0.005;

/// Probability of the remaining chi-square above which an explanation is possible.
const POSSIBLE: f64 = 0.001;

/// Difference of chi-square above which the worse of two possible explanations is dropped: it is e^(10/2) = 150 times
/// less likely.
const WORSE: f64 = 10.0;

/// Chi-square that an explanation with two free numbers must gain over one without, to be preferred.
const PRICE_OF_TWO_NUMBERS: f64 = 4.0;

/// Maximum number of positions that are examined one by one and in pairs; a stand may have many more.
const MOST_SUSPECTS: usize = 24;

/// Consequence of readings that do not fit the stand, as a sentence without a full stop.
pub(crate) const INCONSISTENT: &str =
    "the readings are not consistent with this stand; the parameters are not valid until the cause has been found";

/// Possible causes of readings that do not fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Hint {
    /// Possible explanations, the best first. If empty, none of the known errors explains the readings; several
    /// positions differ at once.
    pub explanations: Vec<Explanation>,
    /// Rough size of the angular errors of all positions that would explain the fit, arcsec.
    pub size_arcsec: f64,
}

/// Possible explanation of readings that do not fit.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Explanation {
    /// Exchanged readings of two positions.
    Exchanged(PositionIndex, PositionIndex),
    /// A position that did not repeat, or whose reading is wrong.
    DidNotRepeat {
        /// Index (i, j) of the position.
        index: PositionIndex,
        /// Smallest rotation of the case that explains the readings, arcsec.
        angle_arcsec: f64,
        /// Errors of J_x and J_y that explain the readings, µA.
        current_ua: Vector2<f64>,
    },
}

impl fmt::Display for Explanation {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Exchanged(one, other) => write!(f, "positions {one} and {other} are exchanged"),
            Self::DidNotRepeat { index, angle_arcsec, current_ua } => {
                let digits = 1 - exponent_as_printed(current_ua.amax(), 2);
                let (scale, decimals) = (libm::pow(10.0, digits.into()), usize::try_from(digits).unwrap_or(0));
                // Adding zero turns -0.0 into 0.0.
                let rounded = |error: f64| format!("{:.decimals$}", (error * scale).round() / scale + 0.0);
                let [x, y] = [current_ua.x, current_ua.y].map(rounded);
                write!(
                    f,
                    "position {index} did not repeat: by {}″ if the angle changed, or by {x} µA in J_x and \
                     {y} µA in J_y if the currents are wrong",
                    two_digits(*angle_arcsec)
                )
            }
        }
    }
}

impl fmt::Display for Hint {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.explanations.as_slice() {
            [] => write!(
                f,
                "the readings do not fit, and no single position and no exchange of two positions explains this; the \
                 passport may be that of another stand (all positions differ by about {}″), or the gyro may \
                 have drifted, or the stand may have moved, during the run",
                two_digits(self.size_arcsec)
            ),
            some => {
                let causes: Vec<String> = some.iter().map(ToString::to_string).collect();
                let plural = if causes.len() > 1 { "s" } else { "" };
                write!(f, "the readings do not fit; possible cause{plural}: {}", causes.join(", or "))
            }
        }
    }
}

/// Returns a hint if chi-square is improbable, otherwise `None`.
pub(crate) fn hint(setup: &Setup, data: &Data, model: Model, chi_square: &ChiSquare) -> Option<Hint> {
    // A chi-square that is NaN is not a good fit either.
    if chi_square.degrees_of_freedom == 0 || chi_square.probability >= ALARM {
        return None;
    }
    let fit = data.fit(setup, model).ok()?;
    let suspects = suspects(setup, data, &fit);
    let mut possible: Vec<(f64, Explanation)> = exchanges(setup, data, model, &suspects);
    possible.extend(single_positions(setup, data, model, &suspects));
    possible.sort_by(|(one, _), (other, _)| one.total_cmp(other));
    let best = possible.first().map_or(0.0, |(score, _)| *score);
    possible.retain(|(score, _)| *score <= best + WORSE);
    let explanations = possible.into_iter().map(|(_, explanation)| explanation).collect();
    Some(Hint { explanations, size_arcsec: size_arcsec(setup, &fit, chi_square) })
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

/// Returns every exchange of two positions that makes the readings fit, with its score.
fn exchanges(setup: &Setup, data: &Data, model: Model, suspects: &[usize]) -> Vec<(f64, Explanation)> {
    let positions = &setup.coefficients().positions;
    let mut possible = Vec::new();
    for (rank, &one) in suspects.iter().enumerate() {
        for &other in &suspects[rank + 1..] {
            let found = chi_square(setup, &data.exchanged(one, other), model);
            if let Some(found) = found.filter(|found| found.probability > POSSIBLE) {
                let explanation = Explanation::Exchanged(positions[one].index, positions[other].index);
                possible.push((found.value, explanation));
            }
        }
    }
    possible
}

/// Returns every position without which the other positions fit, with its score.
fn single_positions(setup: &Setup, data: &Data, model: Model, suspects: &[usize]) -> Vec<(f64, Explanation)> {
    let possible = suspects.iter().filter_map(|&place| {
        let (rest, others) = (setup.without(place), data.without(place));
        let fit = others.fit(&rest, model).ok()?;
        let found = chi_square::chi_square(&rest, &fit, &others);
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
        Some((found.value + PRICE_OF_TWO_NUMBERS, explanation))
    });
    possible.collect()
}

fn chi_square(setup: &Setup, data: &Data, model: Model) -> Option<ChiSquare> {
    let fit = data.fit(setup, model).ok().filter(|fit| fit.settled)?;
    let found = chi_square::chi_square(setup, &fit, data);
    found.value.is_finite().then_some(found)
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
