//! Refusals of least squares, and the parameters that equations do not determine.

use super::LARGEST_CONDITION;
use crate::calibration::parameter::Parameter;
use crate::statistics::least_squares::Condition;
use nalgebra::DVector;

/// Reason why least squares gives no result.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoLeastSquares {
    /// Readings of other positions than those of the coefficients, or in another order.
    #[error("the readings and the coefficients are for different positions")]
    OtherPositions,
    /// Equations that do not determine all parameters.
    #[error("{}", in_words(.groups, *.condition))]
    Inseparable {
        /// Groups of parameters that cannot be separated; a group of one parameter is not determined at all.
        groups: Vec<Vec<Parameter>>,
        /// Condition number of the equations.
        condition: f64,
    },
    /// A drift in time is asked for, but a reading has no time.
    #[error("a drift in time cannot be fitted without the time of every reading: add the column time_s")]
    NoTimes,
    /// A drift in time is asked for, but all readings have the same time.
    #[error("a drift in time cannot be fitted, because all readings have the same time_s")]
    ConstantTime,
    /// A drift in time is asked for, but would leave the noise of the gyro from visit to visit without degrees of freedom.
    #[error(
        "a drift in time cannot be fitted, because the repeated visits cannot tell it from the noise of the gyro: visit \
         more positions again, or state noise.visit_deg_per_h in the gyro type"
    )]
    DriftOrNoise,
    /// A current or an uncertainty that is not finite, or a meter without any uncertainty.
    #[error("every current must be finite and every uncertainty positive")]
    NotUsable,
}

impl NoLeastSquares {
    /// Creates the refusal of equations with this condition; `names` are the parameters of their columns.
    pub(super) fn inseparable(found: &Condition, names: &[Parameter]) -> Self {
        Self::Inseparable { groups: mixed(&found.undetermined, names), condition: found.number }
    }
}

fn in_words(groups: &[Vec<Parameter>], condition: f64) -> String {
    let words = groups.iter().map(|group| {
        let symbols: Vec<&str> = group.iter().map(|parameter| parameter.symbol()).collect();
        match symbols.as_slice() {
            [] => "determine the parameters".to_owned(),
            [one] => format!("determine {one}"),
            [one, rest @ ..] => format!("separate {one} from {}", rest.join(" and ")),
        }
    });
    let words: Vec<String> = words.collect();
    let words = words.join(", nor ");
    let is_extra = |parameter: &Parameter| matches!(parameter, Parameter::Anisoelasticity | Parameter::G(..));
    let advice = match groups.iter().flatten().any(is_extra) {
        true => "; fit the paper's model, or read further positions",
        false => "",
    };
    format!(
        "readings of these positions cannot {words} (condition number {condition:.0e}, at most {LARGEST_CONDITION}){advice}"
    )
}

/// Returns the groups of parameters that the undetermined directions mix.
///
/// Elimination with the largest element as pivot leaves each direction with as few parameters as possible. Two
/// parameters that are undetermined independently then do not seem to be mixed with each other.
fn mixed(directions: &[DVector<f64>], names: &[Parameter]) -> Vec<Vec<Parameter>> {
    let mut rows: Vec<DVector<f64>> = directions.to_vec();
    for pivot_row in 0..rows.len() {
        let pivot = rows[pivot_row].iamax();
        let divisor = rows[pivot_row][pivot];
        if divisor == 0.0 {
            continue;
        }
        let normalised = &rows[pivot_row] / divisor;
        for (other, row) in rows.iter_mut().enumerate() {
            if other != pivot_row {
                let factor = row[pivot];
                row.axpy(-factor, &normalised, 1.0);
            }
        }
        rows[pivot_row] = normalised;
    }
    let involved = |row: &DVector<f64>| {
        let limit = 0.1 * row.amax();
        names.iter().zip(row.iter()).filter(|(_, x)| x.abs() > limit).map(|(name, _)| *name).collect()
    };
    let mut groups: Vec<Vec<Parameter>> = rows.iter().map(involved).collect();
    // Which direction comes first is a matter of rounding.
    groups.sort_by_key(|group| names.iter().position(|name| group.first() == Some(name)));
    groups
}
