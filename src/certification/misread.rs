//! Errors of a whole file of readings that a certificate shows: another unit, the opposite sign, exchanged or reversed axes.

use super::found::{Found, Kind, Scope};
use super::readings::whole_runs::{Axes, CLEARLY, UNITS, axes_of_runs, differing};
use crate::attitude::ANGLE_SYMBOLS;
use crate::wording::Words;
use crate::wording::number::Number;
use crate::wording::texts::remarks as texts;
use nalgebra::Vector3;

/// Units of autocollimators near an arcsecond, with their factors. Converted twice, they would be taken for one another.
const NEAR_AN_ARCSECOND: [Misread; 2] =
    [Misread::Smaller(3.6, "millidegrees"), Misread::SmallerUnit(4.848_136_811, "microradians")];

/// Returns the name of a unit in every language.
fn unit_words(unit: &str) -> Words {
    match unit {
        "millidegrees" => texts::MILLIDEGREES.into(),
        "microradians" => texts::MICRORADIANS.into(),
        "arcminutes" => texts::ARCMINUTES.into(),
        "degrees" => texts::DEGREES.into(),
        _ => texts::MILLIRADIANS.into(),
    }
}

/// Way in which all angles of a file differ from those of the certificate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Misread {
    /// Angles that are smaller by a factor, in the unit of this name.
    Smaller(f64, &'static str),
    /// Angles that are larger by a factor, because the unit of this name is smaller than an arcsecond.
    SmallerUnit(f64, &'static str),
    /// Angles that are larger by a factor, as if converted twice from the unit of this name.
    Larger(f64, &'static str),
    /// Angles with the opposite sign.
    Sign,
    /// Angles in other columns or with other signs.
    Axes(Axes),
}

impl Misread {
    /// Returns the error that makes the angles `read` (α, β, γ of every position) differ from the `certified` ones; `None` if
    /// none explains at least a factor of five in the difference. The corrected angles must also resemble the certified ones:
    /// divided by a large factor, any angles come near to those of a good stand.
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
            .chain(NEAR_AN_ARCSECOND)
            .chain(axes)
            .map(|misread| (sum(&|angles| misread.corrected(angles)), misread))
            .collect();
        let least = sums.iter().map(|(sum, _)| *sum).fold(f64::INFINITY, f64::min);
        // An angle near zero does not show its sign: of about equal errors the simplest.
        let found = sums.into_iter().find(|(sum, _)| *sum <= 2.0 * least)?;
        let of_no_resemblance = certified.iter().map(Vector3::norm_squared).sum::<f64>();
        (CLEARLY * found.0 < sum(&|angles| *angles).min(of_no_resemblance)).then_some(found.1)
    }

    fn corrected(&self, angles: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Smaller(factor, _) => angles * *factor,
            Self::SmallerUnit(factor, _) | Self::Larger(factor, _) => angles / *factor,
            Self::Sign => -angles,
            Self::Axes(axes) => Vector3::from(axes.map(|(column, sign)| sign * angles[column])),
        }
    }

    /// Returns the error as a finding.
    pub(super) fn found(&self) -> Found {
        let kind = match self {
            Self::Smaller(..) | Self::SmallerUnit(..) | Self::Larger(..) => Kind::Unit,
            Self::Sign => Kind::ColumnReversed,
            Self::Axes(axes) if axes.iter().enumerate().all(|(axis, (column, _))| axis == *column) => {
                Kind::ColumnReversed
            }
            Self::Axes(_) => Kind::ColumnsExchanged,
        };
        Found::new(kind, Scope::default(), 0.0, self.words()).advised(self.advice())
    }

    /// Returns the error as a sentence.
    fn words(&self) -> Words {
        let factor = |by: &f64| Number::whole_or_two_digits(*by);
        match self {
            Self::Smaller(by, _) => texts::smaller_unit(factor(by)),
            Self::SmallerUnit(by, _) | Self::Larger(by, _) => texts::larger_unit(factor(by)),
            Self::Sign => texts::OPPOSITE_SIGN.into(),
            Self::Axes(axes) => {
                let each = differing(axes).map(|(axis, column, sign)| {
                    format!("{}{} → {}", sign.replace('-', "−"), ANGLE_SYMBOLS[column], ANGLE_SYMBOLS[axis])
                });
                texts::other_axes(each.collect::<Vec<_>>().join(", "))
            }
        }
    }

    fn advice(&self) -> Words {
        match self {
            Self::Smaller(_, unit) | Self::SmallerUnit(_, unit) => texts::do_convert(unit_words(unit)),
            Self::Larger(_, unit) => texts::do_convert_once(unit_words(unit)),
            Self::Sign => texts::DO_SIGN.into(),
            Self::Axes(_) => texts::DO_COLUMNS.into(),
        }
    }
}
