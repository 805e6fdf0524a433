//! Errors of a whole file of readings that a certificate shows: another unit, the opposite sign, exchanged or reversed axes.

use super::readings::whole_runs::{Axes, CLEARLY, UNITS, axes_of_runs, differing};
use crate::attitude::ANGLES;
use nalgebra::Vector3;

/// Way in which all angles of a file differ from those of the certificate.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub(crate) enum Misread {
    /// Angles that are smaller by a factor, in the unit of this name.
    #[error("the angles are those of the certificate divided by {0:.0}; convert them from {1} to arcseconds")]
    Smaller(f64, &'static str),
    /// Angles that are larger by a factor, as if converted twice from the unit of this name.
    #[error("the angles are {0:.0} times those of the certificate; convert them from {1} to arcseconds only once")]
    Larger(f64, &'static str),
    #[error("the angles are those of the certificate with the opposite sign; correct the sign")]
    Sign,
    #[error("the readings have {}; put the angles into their columns, with their signs", in_other_columns(.0))]
    Axes(Axes),
}

impl Misread {
    /// Returns the error that makes the angles `read` (α, β, γ of every position) differ from the `certified` ones; `None` if
    /// none explains at least a factor of five in the difference.
    pub(crate) fn of(read: &[Vector3<f64>], certified: &[Vector3<f64>]) -> Option<Self> {
        let units =
            UNITS.into_iter().flat_map(|(factor, unit)| [Self::Smaller(factor, unit), Self::Larger(factor, unit)]);
        let axes = axes_of_runs().into_iter().skip(1).map(Self::Axes);
        let sum = |correct: &dyn Fn(&Vector3<f64>) -> Vector3<f64>| {
            read.iter().zip(certified).map(|(read, certified)| (correct(read) - certified).norm_squared()).sum::<f64>()
        };
        let sums: Vec<(f64, Self)> = [Self::Sign]
            .into_iter()
            .chain(units)
            .chain(axes)
            .map(|misread| (sum(&|angles| misread.corrected(angles)), misread))
            .collect();
        let least = sums.iter().map(|(sum, _)| *sum).fold(f64::INFINITY, f64::min);
        // An angle near zero does not show its sign: of about equal errors the simplest.
        let found = sums.into_iter().find(|(sum, _)| *sum <= 2.0 * least)?;
        (CLEARLY * found.0 < sum(&|angles| *angles)).then_some(found.1)
    }

    fn corrected(&self, angles: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Smaller(factor, _) => angles * *factor,
            Self::Larger(factor, _) => angles / *factor,
            Self::Sign => -angles,
            Self::Axes(axes) => Vector3::from(axes.map(|(column, sign)| sign * angles[column])),
        }
    }

    /// Returns the columns that differ: each found, with its sign, and the one that the certificate has.
    pub(crate) fn columns(axes: &Axes) -> Vec<(String, &'static str)> {
        differing(axes).map(|(axis, column, sign)| (format!("{sign}{}", ANGLES[column]), ANGLES[axis])).collect()
    }
}

fn in_other_columns(axes: &Axes) -> String {
    let each = Misread::columns(axes).into_iter();
    each.map(|(found, due)| format!("{found} where the certificate has {due}")).collect::<Vec<_>>().join(", ")
}
