//! What may be wrong where the readings do not fit, as far as residuals can tell.

use super::inputs::Setup;
use super::least_squares::Fit;
use super::procedure::Data;
use super::propagation;
use super::result::ChiSquare;
use super::sensitivity::Sensitivity;
use crate::coefficients::PositionIndex;
use crate::units::arcseconds_from_radians;
use nalgebra::{Matrix2, Matrix2x3, Vector2, Vector3};
use std::fmt;

/// A fit whose chi-square is less probable than this is looked into. So of good calibrations this share gets a false
/// alarm when errors are normal, and less when they are uniform.
pub(crate) const ALARM: f64 = 0.005;

/// An explanation is taken for possible when what it leaves is more probable than this.
const POSSIBLE: f64 = 0.001;

/// Of two possible explanations the one worse by more than this, in chi-square, is dropped: e^(10/2) = 150 times less
/// likely.
const WORSE: f64 = 10.0;

/// Chi-square that an explanation with two free numbers must gain over one without, to be preferred.
const PRICE_OF_TWO_NUMBERS: f64 = 4.0;

/// Positions looked into, one by one and two by two; a stand may have a thousand.
const MOST_SUSPECTS: usize = 24;

/// What residuals can never tell, and what can.
pub(crate) const CANNOT_TELL: &str = "Small residuals do not exclude all errors. The following leave no residuals but change \
                               the result: the passport of another site (latitude), a base tilted about east, a gyro \
                               rotated in its seat about the spin axis, the gain and offset of the meter, x and y \
                               exchanged, one sign reversed. A base rotated in azimuth leaves almost no residuals. To \
                               detect these errors, check the serial number of the stand, the site of the passport, \
                               the specification of the gyro and its previous calibration.";

/// What may be wrong.
#[derive(Debug, Clone, PartialEq)]
pub struct Hint {
    /// Possible explanations, the best first. Empty: none of those looked for, so several positions at once.
    pub explanations: Vec<Explanation>,
    /// How far every position would have to be out for such a fit, in arcseconds: a rough size.
    pub size_arcsec: f64,
}

/// One explanation.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Explanation {
    /// The readings of two positions are exchanged.
    Exchanged(PositionIndex, PositionIndex),
    /// One position did not repeat, or its reading is wrong.
    DidNotRepeat {
        /// Which.
        index: PositionIndex,
        /// The smallest turn of the case that explains it.
        angle_arcsec: f64,
        /// Errors of J_x and J_y that explain it, microamperes.
        current_ua: Vector2<f64>,
    },
}

impl fmt::Display for Explanation {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Exchanged(one, other) => write!(f, "positions {one} and {other} are exchanged"),
            Self::DidNotRepeat { index, angle_arcsec, current_ua } => write!(
                f,
                "position {index} did not repeat: by {angle_arcsec:.0} arcsec if the angle changed, or by {:.2} uA in \
                 J_x and {:.2} uA in J_y if the currents are wrong",
                current_ua.x, current_ua.y
            ),
        }
    }
}

impl fmt::Display for Hint {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.explanations.as_slice() {
            [] => write!(
                f,
                "the readings do not fit, and no single position and no exchange of two positions explains this; the \
                 passport may be that of another stand (all positions differ by about {:.0} arcsec), or the gyro may \
                 have drifted, or the stand may have moved, during the run",
                self.size_arcsec
            ),
            [one] => write!(f, "the readings do not fit; possible cause: {one}"),
            several => {
                write!(f, "the readings do not fit; possible causes: ")?;
                for (place, explanation) in several.iter().enumerate() {
                    write!(f, "{}{explanation}", if place > 0 { ", or " } else { "" })?;
                }
                Ok(())
            }
        }
    }
}

/// A hint when chi-square is improbable.
pub(crate) fn hint(setup: &Setup, data: &Data, chi_square: &ChiSquare) -> Option<Hint> {
    // A chi-square that is not a number is no good fit either.
    if chi_square.degrees_of_freedom == 0 || chi_square.probability >= ALARM {
        return None;
    }
    let fit = data.fit(setup, false).ok()?;
    let suspects = suspects(setup, data, &fit);
    let mut possible: Vec<(f64, Explanation)> = exchanges(setup, data, &suspects);
    possible.extend(single_positions(setup, data, &suspects));
    possible.sort_by(|(one, _), (other, _)| one.total_cmp(other));
    let best = possible.first().map_or(0.0, |(score, _)| *score);
    possible.retain(|(score, _)| *score <= best + WORSE);
    let explanations = possible.into_iter().map(|(_, explanation)| explanation).collect();
    Some(Hint { explanations, size_arcsec: size_arcsec(setup, &fit, chi_square) })
}

/// The positions to look into, in their order: of many, those with the largest misclosures.
fn suspects(setup: &Setup, data: &Data, fit: &Fit) -> Vec<usize> {
    let positions = &setup.coefficients().positions;
    let misclosure = |place: usize| {
        (fit.whitening[place] * fit.unknowns.misclosure(&positions[place], &data.currents_ma[place])).norm()
    };
    let mut places: Vec<usize> = (0..positions.len()).collect();
    places.sort_by(|&one, &other| misclosure(other).total_cmp(&misclosure(one)));
    places.truncate(MOST_SUSPECTS);
    places.sort_unstable();
    places
}

/// Every exchange of two positions that makes the readings fit, with its score.
fn exchanges(setup: &Setup, data: &Data, suspects: &[usize]) -> Vec<(f64, Explanation)> {
    let positions = &setup.coefficients().positions;
    let mut possible = Vec::new();
    for (rank, &one) in suspects.iter().enumerate() {
        for &other in &suspects[rank + 1..] {
            let found = chi_square(setup, &data.exchanged(one, other));
            if let Some(found) = found.filter(|found| found.probability > POSSIBLE) {
                let explanation = Explanation::Exchanged(positions[one].index, positions[other].index);
                possible.push((found.value, explanation));
            }
        }
    }
    possible
}

/// Every position without which the others fit, with its score.
fn single_positions(setup: &Setup, data: &Data, suspects: &[usize]) -> Vec<(f64, Explanation)> {
    let possible = suspects.iter().filter_map(|&place| {
        let (rest, others) = (setup.without(place), data.without(place));
        let fit = others.fit(&rest, false).ok()?;
        let found = ChiSquare::new(propagation::chi_square(&rest, &fit, &others));
        if found.degrees_of_freedom == 0 || found.probability <= POSSIBLE {
            return None;
        }
        let at = &setup.coefficients().positions[place];
        let misclosure = fit.unknowns.misclosure(at, &data.currents_ma[place]);
        let turns = turns(&Sensitivity::new(setup, &fit.unknowns), place);
        // The smallest turn δ with S δ = misclosure: S' (S S')⁻¹ misclosure.
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

/// Sensitivity of a position's misclosure to turns of the case about x, y, z.
fn turns(sensitivity: &Sensitivity, place: usize) -> Matrix2x3<f64> {
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    Matrix2x3::from_columns(&axes.map(|axis| sensitivity.to_case_turn(place, &axis)))
}

fn chi_square(setup: &Setup, data: &Data) -> Option<ChiSquare> {
    let fit = data.fit(setup, false).ok().filter(|fit| fit.settled)?;
    let found = ChiSquare::new(propagation::chi_square(setup, &fit, data));
    found.value.is_finite().then_some(found)
}

/// The uncertainty that every angle of every position would need for chi-square to be as expected, roughly.
fn size_arcsec(setup: &Setup, fit: &Fit, chi_square: &ChiSquare) -> f64 {
    let sensitivity = Sensitivity::new(setup, &fit.unknowns);
    let per_radian: f64 = fit
        .whitening
        .iter()
        .enumerate()
        .map(|(place, whiten)| (whiten * turns(&sensitivity, place)).norm_squared())
        .sum();
    let rows = 2 * fit.whitening.len();
    let excess = (chi_square.value / chi_square.degrees_of_freedom as f64 - 1.0).max(0.0);
    arcseconds_from_radians((excess * rows as f64 / per_radian).sqrt())
}
