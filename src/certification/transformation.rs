//! Transformations of all angles of a file or a run: another unit, other signs, columns or rows than those of a reference,
//! which is the certificate or the other runs.

use super::found::{Found, Scope};
use super::kind::Kind;
use crate::attitude::{ANGLE_SYMBOLS, ANGLES};
use crate::coefficients::PositionIndex;
use crate::statistics::student::f_beyond;
use crate::text::words::first_few;
use crate::units::{ARCSECONDS_PER_DEGREE, ARCSECONDS_PER_RADIAN};
use crate::wording::number::Number;
use crate::wording::texts::transformations as texts;
use crate::wording::{Text, Words};
use nalgebra::{DVector, Vector3};

/// Units of angles: key, words, and size in arcseconds. That of an autocollimator may turn by twice the angle of the mirror.
const UNITS: [(&str, Text, f64); 11] = [
    ("deg", texts::DEGREES, ARCSECONDS_PER_DEGREE),
    ("arcmin", texts::ARCMINUTES, 60.0),
    ("rad", texts::RADIANS, ARCSECONDS_PER_RADIAN),
    ("turn", texts::TURNS, 1_296_000.0),
    ("gon", texts::GONS, 3240.0),
    ("mgon", texts::MILLIGONS, 3.24),
    ("mil", texts::MILS, 202.5),
    ("beam", texts::BEAM, 0.5),
    // Of two units that agree with a measured factor about as well, the first is named first.
    ("mrad", texts::MILLIRADIANS, 1e-3 * ARCSECONDS_PER_RADIAN),
    ("urad", texts::MICRORADIANS, 1e-6 * ARCSECONDS_PER_RADIAN),
    ("mdeg", texts::MILLIDEGREES, 3.6),
];

/// Factor by which a transformation must reduce the sum of the squared differences, a fifth of the difference. By chance
/// none does, not even with three positions and angles that are all scatter.
pub(super) const CLEARLY: f64 = 25.0;

/// Least relative standard uncertainty of a measured factor, by the digits of the angles.
const LEAST_U: f64 = 5e-4;

/// Largest difference of a measured factor from that of a unit, in standard uncertainties.
const AGREES: f64 = 3.0;

/// Root of the difference of two squared differences, in standard uncertainties, below which either unit is likely.
const ABOUT_AS_WELL: f64 = 2.0;

/// Column of the file for each angle, with its sign.
type Axes = [(usize, f64); 3];

/// Row for each position; `None` if the file does not contain it.
pub(super) type Rows = Vec<Option<usize>>;

#[derive(Debug, Clone, PartialEq)]
enum Change {
    /// Angles to be multiplied by a factor, with its standard uncertainty.
    Scale(f64, f64),
    Axes(Axes),
    Rows(Rows),
}

/// Change that brings angles nearest to those of a reference.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Transformation {
    change: Change,
    /// Sums of squared differences from the reference with and without the change, and that of the reference from zero.
    pub(super) left: f64,
    before: f64,
    reference: f64,
    /// Probability that chance makes any transformation explain as much.
    probability: f64,
}

/// Unit that has a factor.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Named {
    /// Key, or `None` of angles that were converted from a unit as if they were in `other`.
    key: Option<&'static str>,
    unit: Text,
    other: Option<Text>,
    factor: f64,
}

impl Transformation {
    /// Returns the transformation that brings the angles `read` (α, β, γ of every position) nearest to those of a
    /// `reference`, by the square of what `rest` leaves of them, which is linear; `None` if they are equal. `rows` are the
    /// orders of the rows to be tried.
    pub(super) fn nearest(
        read: &[Vector3<f64>],
        reference: &[Vector3<f64>],
        rows: impl IntoIterator<Item = Rows>,
        rest: &dyn Fn(&[Vector3<f64>]) -> DVector<f64>,
    ) -> Option<Self> {
        let (own, due) = (rest(read), rest(reference));
        let freedom = own.len() as f64 - 1.0;
        let factor = own.dot(&due) / own.norm_squared();
        let u =
            (((&own * factor - &due).norm_squared() / freedom / own.norm_squared()).sqrt()).max(LEAST_U * factor.abs());
        let mut axes = axes().into_iter().skip(1).map(Change::Axes);
        let opposite = axes.next();
        let changes = opposite.into_iter().chain([Change::Scale(factor, u)]).chain(axes);
        let sums: Vec<(f64, Change)> = changes
            .chain(rows.into_iter().map(Change::Rows))
            .map(|change| ((rest(&change.corrected(read, reference)) - &due).norm_squared(), change))
            .collect();
        let count = sums.len() as f64;
        let least = sums.iter().map(|(sum, _)| *sum).fold(f64::INFINITY, f64::min);
        // An angle near zero does not show its sign: of about equal changes the simplest.
        let (left, change) = sums.into_iter().find(|(sum, _)| *sum <= 2.0 * least)?;
        let before = (own - &due).norm_squared();
        let probability = (count * f_beyond(before / left.max(f64::MIN_POSITIVE), freedom, freedom)).min(1.0);
        Some(Self { change, left, before, reference: due.norm_squared(), probability })
    }

    /// Returns `true` if the change explains all but a share of the difference, at least `usual`. The corrected angles must
    /// also resemble the reference: divided by a large factor, any angles come near to those of a good stand.
    pub(super) fn explains(&self, factor: f64, usual: f64) -> bool {
        factor * self.left.max(usual) < self.before.min(self.reference)
    }

    /// Returns `true` if angles that were converted twice, or as another unit, explain a difference of any size.
    pub(super) fn is_known_factor(&self) -> bool {
        matches!(self.change, Change::Scale(factor, u) if !named(factor, u).is_empty())
    }

    pub(super) fn corrected(&self, read: &[Vector3<f64>], reference: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
        self.change.corrected(read, reference)
    }

    /// Returns what is wrong with a file whose `reference` is the certificate, as a finding.
    pub(super) fn found(&self) -> Found {
        let found = self.of(texts::OF_CERTIFICATE.into(), &[], Scope::default());
        Found { words: Words::Capital(Box::new(vec![found.words, ".".into()].into())), ..found }
    }

    /// Returns what is wrong, in words about the angles of a `reference`, with exchanged `positions` (in the order of the
    /// rows) in a `scope`.
    pub(super) fn of(&self, reference: Words, positions: &[PositionIndex], scope: Scope) -> Found {
        let new = |kind, scope: Scope, words: Words| Found::new(kind, scope, self.probability, words);
        match &self.change {
            Change::Scale(factor, u) => {
                let units = named(*factor, *u);
                let unit = units.first().and_then(|unit| unit.key);
                let words = scaled(*factor, *u, units.first(), reference);
                let found = new(Kind::Unit, scope, words).advised(convert(&units));
                Found { size: Some(*factor), unit, ..found }
            }
            Change::Axes(axes) => {
                let changed: Vec<usize> = (0..3).filter(|axis| axes[*axis] != (*axis, 1.0)).collect();
                let angles: Vec<&str> = changed.iter().map(|axis| ANGLES[*axis]).collect();
                let scope = match angles[..] {
                    [angle] => Scope { angle: Some(angle), ..scope },
                    _ => Scope { angles, ..scope },
                };
                let each = changed.iter().map(|axis| {
                    let (column, sign) = axes[*axis];
                    let minus = if sign < 0.0 { "−" } else { "" };
                    format!("{minus}{} → {}", ANGLE_SYMBOLS[column], ANGLE_SYMBOLS[*axis])
                });
                let each = each.collect::<Vec<_>>().join(", ");
                if changed.iter().any(|axis| axes[*axis].0 != *axis) {
                    new(Kind::ColumnsExchanged, scope, texts::other_axes(reference, each)).advised(texts::DO_COLUMNS)
                } else if changed.len() == 3 {
                    new(Kind::ColumnReversed, scope, texts::opposite_sign(reference)).advised(texts::DO_SIGN)
                } else {
                    new(Kind::ColumnReversed, scope, texts::other_axes(reference, each)).advised(texts::DO_SIGN)
                }
            }
            Change::Rows(rows) => {
                let moved = || (0..rows.len()).filter(|place| rows[*place] != Some(*place));
                let pair =
                    |place: usize| rows[place].filter(|other| rows[*other] == Some(place) && moved().count() == 2);
                let between = moved()
                    .find_map(|place| Some([place, pair(place)?]))
                    .map(|pair| pair.map(|place| positions[place]).map(|at| [at.i, at.j]));
                let each =
                    moved().filter_map(|place| Some(format!("{} → {}", positions[rows[place]?], positions[place])));
                let words = texts::other_rows(reference, first_few(&each.collect::<Vec<_>>()));
                new(Kind::RowsExchanged, Scope { between, ..scope }, words).advised(texts::DO_ROWS)
            }
        }
    }
}

impl Change {
    fn corrected(&self, read: &[Vector3<f64>], reference: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
        match self {
            Self::Scale(factor, _) => read.iter().map(|angles| angles * *factor).collect(),
            Self::Axes(axes) => {
                read.iter().map(|angles| axes.map(|(column, sign)| sign * angles[column]).into()).collect()
            }
            Self::Rows(rows) => {
                let places = rows.iter().zip(reference);
                places.map(|(row, due)| row.map_or(*due, |row| read[row])).collect()
            }
        }
    }
}

/// Returns rows of which those are exchanged whose angles are nearest to each other's; `None` if there are none.
pub(super) fn exchanged(read: &[Vector3<f64>], due: &[Vector3<f64>]) -> Option<Rows> {
    let nearest: Vec<usize> = read
        .iter()
        .map(|angles| {
            let distance = |place: usize| (angles - due[place]).norm_squared();
            (0..due.len()).min_by(|one, other| distance(*one).total_cmp(&distance(*other))).unwrap_or_default()
        })
        .collect();
    let row = |place: usize| if nearest[nearest[place]] == place { nearest[place] } else { place };
    let rows: Rows = (0..read.len()).map(|place| Some(row(place))).collect();
    rows.iter().enumerate().any(|(place, row)| *row != Some(place)).then_some(rows)
}

/// Returns every order of the three columns with every choice of signs: first none changed, then all signs, then those that
/// change the fewest columns.
fn axes() -> Vec<Axes> {
    let orders = [[0, 1, 2], [1, 0, 2], [2, 1, 0], [0, 2, 1], [1, 2, 0], [2, 0, 1]];
    let signed = orders.into_iter().flat_map(|order| {
        (0..8_u8)
            .map(move |signs| [0, 1, 2].map(|axis| (order[axis], if signs & (1 << axis) == 0 { 1.0 } else { -1.0 })))
    });
    let mut all: Vec<Axes> = signed.collect();
    all.sort_by_key(|axes| match (0..3).filter(|axis| axes[*axis] != (*axis, 1.0)).count() {
        3 if axes.iter().enumerate().all(|(axis, (column, _))| axis == *column) => 1,
        0 => 0,
        count => count + 1,
    });
    all
}

/// Returns the units whose factors agree with a measured one, about as well as any.
fn named(factor: f64, u: f64) -> Vec<Named> {
    let one = |(key, unit, size): (&'static str, Text, f64)| {
        let named = |factor| Named { key: Some(key), unit, other: None, factor };
        [named(size), named(1.0 / size)]
    };
    let as_another = |unit, other, factor| Named { key: None, unit, other: Some(other), factor };
    let mixed = [as_another(texts::GONS, texts::DEGREES, 0.9), as_another(texts::DEGREES, texts::GONS, 1.0 / 0.9)];
    let apart = move |unit: &Named| (factor / unit.factor - 1.0).abs() / (u / factor.abs());
    let mut all: Vec<Named> = UNITS.into_iter().flat_map(one).chain(mixed).collect();
    let least = all.iter().map(apart).fold(AGREES, f64::min);
    all.retain(|unit| apart(unit) <= AGREES.min(libm::hypot(least, ABOUT_AS_WELL)));
    all
}

/// Returns the sentence that angles are those of a reference up to a factor: that of the unit, and the measured one.
fn scaled(factor: f64, u: f64, unit: Option<&Named>, reference: Words) -> Words {
    let is_smaller = factor.abs() >= 1.0;
    let (turned, u) = if is_smaller { (factor, u) } else { (1.0 / factor, u / (factor * factor)) };
    let [measured, u] = [Number::measured(turned, u), Number::significant(u, 2)];
    let by = match unit.map(|unit| if is_smaller { unit.factor } else { 1.0 / unit.factor }) {
        Some(due) => texts::factor_of_unit(Number::exact((due * 1000.0).round() / 1000.0), measured, u),
        None => texts::factor(measured, u),
    };
    if is_smaller { texts::smaller(reference, by) } else { texts::larger(reference, by) }
}

/// Returns what to do about angles in other units, any of which may be theirs.
fn convert(units: &[Named]) -> Words {
    let [first, others @ ..] = units else { return texts::DO_CHECK_FACTOR.into() };
    let names = others.iter().fold(Words::from(first.unit), |names, other| texts::or(names, other.unit));
    match first {
        Named { other: Some(other), unit, .. } => texts::do_convert_as(*unit, *other),
        Named { key: Some("beam"), .. } => texts::DO_MIRROR.into(),
        // A unit larger than an arcsecond makes angles smaller; otherwise they were converted twice.
        Named { factor, key, .. } if (*factor >= 1.0) == (*key != Some("urad")) => texts::do_convert(names),
        _ => texts::do_convert_once(names),
    }
}
