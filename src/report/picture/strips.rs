//! Strips in the cells of tables, and what their marks mean: certified deviations, residuals and changes, parameters within
//! their tolerances, shares of a tolerance and of a variance. The strips of a column have one scale, and an axis below them.

use super::drawing::{
    Anchor, Point, Scale, Ticks, arrow, coordinate, crowding, line, polygon, power_of_ten, rectangle, strip, whisker,
    width, with_power, words,
};
use crate::calibration::document::{ResidualDocument, ResultDocument};
use crate::calibration::verdict::COVERAGE_FACTOR;
use crate::calibration::{Decision, Found, Parameter, ParameterVerdict, Verdict, against_type};
use crate::passport::Accuracy;
use crate::stand::CertifiedPosition;
use crate::units::ARCSECONDS_PER_DEGREE;
use crate::wording::number::LARGEST_IN_ARCSEC;
use crate::wording::texts::{pictures as texts, units};
use crate::wording::{Language, Text, Words};
use maud::{Markup, html};

/// Samples of marks with their meanings.
pub(crate) type Key = Vec<(Markup, Words)>;

/// A column of strips: width and height of each, and their scale, which leaves room for the outer numbers of the axis.
#[derive(Debug, Clone, Copy)]
struct Column {
    size: Point,
    scale: Scale,
}

impl Column {
    fn strip(&self, drawing: &Markup) -> Markup {
        strip(self.size, drawing)
    }

    fn middle(&self) -> f64 {
        0.5 * self.size[1]
    }

    /// Draws a bar, `half` high to both sides; its part beyond the axis is left out.
    fn bar(&self, ends: [f64; 2], half: f64, class: &str) -> Markup {
        let ([from, to], y) = (ends.map(|end| self.scale.clamped(end)), self.middle());
        rectangle([from, y - half], [to, y + half], class, None)
    }

    /// Draws a line across the strip.
    fn upright(&self, value: f64, class: &str) -> Markup {
        let x = self.scale.place(value);
        line([x, 0.0], [x, self.size[1]], class)
    }

    /// Returns the axis, whose numbers are the values times `factor`.
    fn axis(&self, factor: f64) -> Axis {
        let scale = Scale { values: self.scale.values.map(|value| factor * value), ..self.scale };
        Axis { width: self.size[0], scale, power: 0, unit: None }
    }
}

/// The axis below the strips of a column: round values with their numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Axis {
    width: f64,
    scale: Scale,
    /// Power of ten that is factored out of the numbers, and their unit, where no heading states it; both to their right.
    power: i32,
    unit: Option<Text>,
}

impl Axis {
    pub(crate) fn drawn(&self, language: Language) -> Markup {
        const HALF_LETTER: f64 = 4.1;
        let unit = with_power(self.power, self.unit.map_or("", |unit| unit.of(language)), language);
        let drawing = html! {
            @if !unit.is_empty() { (words([self.width, 14.0], Anchor::End, "small", &unit)) }
            @for (value, text) in Ticks::along(&self.scale, language).marks(language) {
                @let x = self.scale.place(value);
                @let half = HALF_LETTER * text.chars().count() as f64;
                // A long number at the end would be cut off.
                @if x > half && x < self.width - half {
                    (line([x, 0.0], [x, 4.0], "grid"))
                    (words([x, 14.0], Anchor::Middle, "small", &text))
                }
            }
        };
        strip([self.width, 17.0], &drawing)
    }
}

/// Certified deviations as bars, with their uncertainties as whiskers if stated: a column for each of α, β, γ, all to one
/// scale.
#[derive(Clone, Copy)]
pub(crate) struct Deviations {
    column: Column,
    /// Largest uncertainty, if one is stated.
    pub largest_u: Option<f64>,
}

impl Deviations {
    /// Creates bars to the scale of the largest deviation of `positions`.
    pub(crate) fn of(positions: &[CertifiedPosition]) -> Self {
        /// Largest value on an axis: 180°. The uncertainties themselves have no limit.
        const LARGEST_ARCSEC: f64 = 648_000.0;
        let all = positions.iter().flat_map(|at| at.angles_arcsec().into_iter().zip(at.u_arcsec()));
        let ends = all.clone().flat_map(|(value, u)| {
            let half = COVERAGE_FACTOR * u.unwrap_or(0.0);
            [value - half, value + half]
        });
        let (low, high) = ends.fold((0.0, 0.0), |(low, high), end| (f64::min(low, end), f64::max(high, end)));
        let (low, high) = (low.max(-LARGEST_ARCSEC), high.min(LARGEST_ARCSEC));
        let high = if high > low { high } else { 1.0 };
        let scale = Scale { values: [low, high], places: [13.0, 103.0] };
        // Longer bars have a number on their own side of 0: an end not far from one moves out to it.
        let step = Ticks::along(&scale, Language::English).step;
        let widened = |end: f64| if end >= 0.5 * step && end < step { step } else { end };
        let scale = Scale { values: [-widened(-low), widened(high)], ..scale };
        let largest_u = all.filter_map(|(_, u)| u).reduce(f64::max);
        Self { column: Column { size: [116.0, 13.0], scale }, largest_u }
    }

    pub(crate) fn bar(&self, (value, u): (f64, Option<f64>)) -> Markup {
        /// Length of a whisker from which its ends have marks; those of shorter ones would run together.
        const SHORTEST_WITH_MARKS: f64 = 5.0;
        let half = COVERAGE_FACTOR * u.unwrap_or(0.0);
        let ends = [value - half, value + half].map(|end| self.column.scale.clamped(end));
        let whisker = || whisker(ends, [ends[1] - ends[0] >= SHORTEST_WITH_MARKS; 2], self.column.middle(), 3.0);
        self.column.strip(&html! {
            (self.column.bar([0.0, value], 4.0, "bar"))
            @if u.is_some() { (whisker()) }
            (self.column.upright(0.0, "zero"))
        })
    }

    /// Returns the axis, in degrees if there would be no room for the numbers in arcseconds.
    pub(crate) fn axis(&self) -> Axis {
        self.column.axis(if self.unit() == units::DEGREES { 1.0 / ARCSECONDS_PER_DEGREE } else { 1.0 })
    }

    /// Returns the unit of the axis.
    pub(crate) fn unit(&self) -> Text {
        let [low, high] = self.column.scale.values;
        if high.max(-low) > LARGEST_IN_ARCSEC { units::DEGREES } else { units::ARCSEC }
    }

    /// Returns the key; the whiskers are expanded uncertainties or twice an own part.
    pub(crate) fn key(&self, is_expanded: bool) -> Key {
        /// Length from which a whisker is seen beside the end of its bar.
        const SHORTEST_SEEN: f64 = 2.0;
        let length =
            |u: f64| self.column.scale.place(COVERAGE_FACTOR * u) - self.column.scale.place(-COVERAGE_FACTOR * u);
        let (is_drawn, of_u) = match self.largest_u.map(length) {
            None => (false, texts::DEVIATION_NO_U),
            Some(short) if short < SHORTEST_SEEN && is_expanded => (false, texts::DEVIATION_EXPANDED_UNSEEN),
            Some(short) if short < SHORTEST_SEEN => (false, texts::DEVIATION_WHISKER_UNSEEN),
            Some(_) if is_expanded => (true, texts::DEVIATION_WHISKER_EXPANDED),
            Some(_) => (true, texts::DEVIATION_WHISKER),
        };
        let whisker = if is_drawn {
            whisker([2.0, 26.0], [true; 2], 7.0, 3.0)
        } else {
            html! {}
        };
        vec![(sample_bar("bar", 4.5), texts::DEVIATION_BAR.into()), (whisker, of_u.into())]
    }
}

/// Draws the sample of a bar, `half` high to both sides.
fn sample_bar(class: &str, half: f64) -> Markup {
    rectangle([2.0, 7.0 - half], [26.0, 7.0 + half], class, None)
}

/// A function that returns a residual along one axis and its standard uncertainty, deg/h.
pub(crate) type Along = fn(&ResidualDocument) -> (f64, Option<f64>);

/// Axes of the case, and the functions that return the residuals along them.
pub(crate) const AXES: [(&str, Along); 2] = [("x", |at| (at.x, at.u_x)), ("y", |at| (at.y, at.u_y))];

/// Residuals of the equations after the fit, or changes of deviations, as bars to one scale: values that are 0 but for
/// their uncertainty.
#[derive(Clone, Copy)]
pub(crate) struct Residuals(Column);

impl Residuals {
    /// Limits, in standard uncertainties of a value on either side.
    const LIMIT: f64 = 2.0;

    pub(crate) fn of(result: &ResultDocument) -> Self {
        Self::over(result.residuals_deg_per_h.iter().flat_map(|at| AXES.map(|(_, along)| along(at))))
    }

    /// Creates bars to the scale of the largest value or limit; a value comes with its standard uncertainty, if known.
    pub(crate) fn over(values: impl Iterator<Item = (f64, Option<f64>)>) -> Self {
        let reach = |(value, u): (f64, Option<f64>)| value.abs().max(Self::LIMIT * u.unwrap_or(0.0));
        let reach = values.map(reach).fold(0.0, f64::max);
        let reach = if reach > 0.0 && reach.is_finite() { 1.05 * reach } else { 1.0 };
        Self(Column { size: [170.0, 13.0], scale: Scale { values: [-reach, reach], places: [14.0, 118.0] } })
    }

    /// Draws a value within its limits.
    pub(crate) fn bar(&self, (value, u): (f64, Option<f64>)) -> Markup {
        let Self(column) = self;
        column.strip(&html! {
            @if let Some(u) = u { (column.bar([-Self::LIMIT * u, Self::LIMIT * u], 5.5, "limits")) }
            (column.bar([0.0, value], 2.5, "bar"))
            (column.upright(0.0, "zero"))
        })
    }

    /// Returns the axis; with the unit, if the heading does not have it.
    pub(crate) fn axis(&self, unit: Option<Text>) -> Axis {
        let power = crowding(self.0.scale.values[1]);
        Axis { power, unit, ..self.0.axis(1.0 / power_of_ten(power)) }
    }

    /// Returns the key, with these words for a bar and its limits.
    pub(crate) fn key(bar: Text, limits: Text) -> Key {
        vec![(sample_bar("bar", 3.0), bar.into()), (sample_bar("limits", 6.0), limits.into())]
    }
}

/// Parameters of a gyro within the tolerance of its type: deviation, expanded uncertainty, and the decision. The column has
/// this width.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tolerances(f64);

/// Strips beside deviations and decisions, and wider ones beside values alone.
pub(crate) const BESIDE_DECISIONS: Tolerances = Tolerances(140.0);
pub(crate) const BESIDE_VALUES: Tolerances = Tolerances(400.0);

impl Tolerances {
    /// Beside the ends of the axis, for the arrow from the mark of a value that is beyond one of them.
    const ROOM_FOR_ARROW: f64 = 16.0;
    /// The axis, in tolerances: to both limits and half as far again, so that strips of all reports compare. The mark of a
    /// value beyond it stands at its end, with an arrow outwards.
    const REACH: f64 = 1.5;

    fn column(self) -> Column {
        let places = [Self::ROOM_FOR_ARROW, self.0 - Self::ROOM_FOR_ARROW];
        Column { size: [self.0, 17.0], scale: Scale { values: [-Self::REACH, Self::REACH], places } }
    }

    /// Returns the axis, in percent of the tolerance.
    pub(crate) fn axis(self) -> Axis {
        self.column().axis(100.0)
    }

    /// Returns `true` if a deviation is within the axis.
    fn reaches(row: &ParameterVerdict, deviation: f64) -> bool {
        (deviation / row.tolerance).abs() <= Self::REACH
    }

    /// Returns the ends of the interval of a deviation with its expanded uncertainty.
    fn ends(row: &ParameterVerdict) -> [f64; 2] {
        [-1.0, 1.0].map(|sign| row.deviation + sign * row.expanded_uncertainty)
    }

    /// Draws a parameter of a verdict: only the limits if its tolerance is 0.
    pub(crate) fn of_parameter(self, verdict: &Verdict, row: &ParameterVerdict) -> Markup {
        let column = self.column();
        let guarded = (row.tolerance - verdict.guard_band(row)) / row.tolerance;
        let (y, place) = (column.middle(), |value: f64| column.scale.clamped(value / row.tolerance));
        let (x, outwards) = (place(row.deviation), row.deviation.signum() * (Self::ROOM_FOR_ARROW - 1.0));
        column.strip(&html! {
            @if row.tolerance > 0.0 {
                @if guarded > 0.0 { (column.bar([-guarded, guarded], 6.0, "limits")) }
                (column.upright(0.0, "grid"))
            }
            // Below the marks: a value close to a limit is on one side of it.
            @for limit in [-1.0, 1.0] { (column.upright(limit, "limit")) }
            @if row.tolerance > 0.0 {
                @let ends = Self::ends(row);
                @let within = ends.map(|end| Self::reaches(row, end));
                (whisker(ends.map(place), within, y, 4.0))
                @for end in ends.iter().zip(within).filter(|(_, within)| !within).map(|(end, _)| place(*end)) {
                    (arrow([x, y], [end, y], "meridian"))
                }
                @if !Self::reaches(row, row.deviation) { (arrow([x, y], [x + outwards, y], "meridian")) }
                (decided([x, y], verdict.decision(row)))
            }
        })
    }

    pub(crate) fn key<'a>(verdicts: impl Iterator<Item = &'a Verdict> + Clone) -> Key {
        let entry = |found: Option<Decision>| (decided([21.0, 7.0], found), decision(found));
        let decisions = match verdicts.clone().all(|verdict| verdict.withheld) {
            true => vec![entry(None)],
            false => [Decision::Pass, Decision::Undecided, Decision::Fail].map(|found| entry(Some(found))).to_vec(),
        };
        let is_cut =
            |row: &ParameterVerdict| row.tolerance > 0.0 && !Self::ends(row).iter().all(|end| Self::reaches(row, *end));
        let beyond = verdicts.flat_map(|verdict| &verdict.parameters).any(is_cut);
        let arrow = beyond.then(|| (arrow([2.0, 7.0], [26.0, 7.0], "meridian"), texts::TOLERANCES_BEYOND));
        let parts = [
            (whisker([2.0, 26.0], [true; 2], 7.0, 4.0), texts::TOLERANCES_WHISKER),
            (line([21.0, 0.0], [21.0, 14.0], "limit"), texts::TOLERANCES_LIMIT),
            (sample_bar("limits", 5.0), texts::TOLERANCES_GUARDED),
        ];
        decisions.into_iter().chain(arrow).chain(parts).map(|(sample, text)| (sample, text.into())).collect()
    }
}

/// Draws the mark of a decision: a disc, a disc half filled, or a cross; a circle if there is none.
fn decided([x, y]: Point, decision: Option<Decision>) -> Markup {
    let (cx, cy) = (coordinate(x), coordinate(y));
    let found = match decision {
        None => html! { circle.site cx=(cx) cy=(cy) r="4.2" {} },
        Some(Decision::Pass) => html! { circle.mark cx=(cx) cy=(cy) r="4.4" {} },
        Some(Decision::Undecided) => {
            let [top, bottom] = [y - 4.2, y + 4.2].map(coordinate);
            html! {
                circle.site cx=(cx) cy=(cy) r="4.2" {}
                path.half d={ "M" (cx) " " (top) "A4.2 4.2 0 0 0 " (cx) " " (bottom) "Z" } {}
            }
        }
        Some(Decision::Fail) => {
            let (a, b) = (5.2, 1.7);
            let arms = [[-a, -a + b], [-b, 0.0], [-a, a - b], [-a + b, a], [0.0, b], [a - b, a], [a, a - b], [b, 0.0]];
            let rest = [[a, -a + b], [a - b, -a], [0.0, -b], [-a + b, -a]];
            let points: Vec<Point> = arms.iter().chain(&rest).map(|[dx, dy]| [x + dx, y + dy]).collect();
            polygon(&points, "mark")
        }
    };
    html! { circle.ground cx=(cx) cy=(cy) r="5.8" {} (found) }
}

/// Returns a decision as a text for pages.
pub(crate) fn decision(decision: Option<Decision>) -> Text {
    decision.map_or(texts::NOT_ASSESSED, |decision| texts::decision!(Decision, decision))
}

/// Shares of the tolerances that the expected standard uncertainties have; `None` if the tolerance is 0.
#[derive(Clone, Copy)]
pub(crate) struct Accuracies {
    shares: [Option<f64>; 8],
    column: Column,
}

impl Accuracies {
    /// Largest share of the tolerance on the axis. Larger values are drawn at its end.
    const LARGEST_SHARE: f64 = 20.0;

    /// Creates the shares that a passport states. `gravity_m_per_s2` is the passport's, because the tolerances of the
    /// drifts are compared at the type's g.
    pub(crate) fn of(accuracy: &Accuracy, gravity_m_per_s2: f64) -> Self {
        let gyro = &accuracy.gyro;
        // The verdict on a gyro with exactly this uncertainty gives tolerance and uncertainty in one unit and at one g.
        // The passport states its values per local g, so the uncertainty of g is not included.
        let found = Found {
            parameters: gyro.nominal.to_model(),
            standard_uncertainty: accuracy.standard_uncertainty.to_model().to_vector(),
            degrees_of_freedom: [f64::INFINITY; 8],
            gravity_m_per_s2,
            gravity_u_m_per_s2: 0.0,
        };
        let verdict = against_type(&found, gyro);
        let shares = Parameter::AS_IN_THE_PAPER.map(|parameter| {
            let row = verdict.parameter(parameter)?;
            (row.tolerance > 0.0).then(|| row.expanded_uncertainty / COVERAGE_FACTOR / row.tolerance)
        });
        let largest = shares.into_iter().flatten().fold(0.5, f64::max);
        let reach = (1.08 * COVERAGE_FACTOR * largest).clamp(1.25, Self::LARGEST_SHARE);
        let scale = Scale { values: [0.0, reach], places: [10.0, 282.0] };
        Self { shares, column: Column { size: [300.0, 13.0], scale } }
    }

    /// Draws the share of the parameter at a place of the paper's order.
    pub(crate) fn strip(&self, place: usize) -> Markup {
        let bar = |share: f64, class: &str| self.column.bar([0.0, share], 4.0, class);
        self.column.strip(&html! {
            @if let Some(share) = self.shares[place] { (bar(COVERAGE_FACTOR * share, "bar-open")) (bar(share, "bar")) }
            (self.column.upright(0.0, "zero"))
            (self.column.upright(1.0, "limit"))
        })
    }

    /// Returns the axis, in percent.
    pub(crate) fn axis(&self) -> Axis {
        self.column.axis(100.0)
    }

    pub(crate) fn key() -> Key {
        vec![
            (sample_bar("bar", 4.5), texts::ACCURACY_U.into()),
            (sample_bar("bar-open", 4.5), texts::ACCURACY_EXPANDED.into()),
            (line([14.0, 0.0], [14.0, 14.0], "limit"), texts::ACCURACY_LIMIT.into()),
        ]
    }
}

/// Shares of the inputs in a variance, in percent: strips as long as the whole variance.
const VARIANCE: Column = Column { size: [560.0, 19.0], scale: Scale { values: [0.0, 100.0], places: [8.0, 548.0] } };

/// Names of the parts: not A and B, which are types of evaluation. What remains of a variance has none.
pub(crate) const LETTERS: [&str; 5] = ["P", "Q", "R", "S", "T"];

/// Draws the shares of one variance in the order of `LETTERS`; they are at most 1 together.
pub(crate) fn shares(shares: &[f64]) -> Markup {
    /// Share below which a part is one of the others: its outline would be all that is seen.
    const LEAST: f64 = 0.01;
    let mut end = 0.0;
    let large = shares.iter().enumerate().filter(|(_, share)| **share >= LEAST);
    let parts = large.map(|(place, share)| {
        let from = end;
        end += 100.0 * share;
        part(place, [from, end])
    });
    let parts: Vec<Markup> = parts.collect();
    VARIANCE.strip(&html! {
        @if end < 100.0 { (VARIANCE.bar([end, 100.0], 8.0, "share rest")) }
        @for part in &parts { (part) }
    })
}

fn part(place: usize, ends: [f64; 2]) -> Markup {
    /// Length of a part that its name leaves free.
    const MARGIN: f64 = 4.0;
    let [from, to] = ends.map(|end| VARIANCE.scale.clamped(end));
    let letter = LETTERS.get(place).copied().unwrap_or_default();
    let names = [format!("{letter}\u{a0}{:.0}", ends[1] - ends[0]), letter.to_owned()];
    let name = names.into_iter().find(|name| width(name) + MARGIN <= to - from);
    html! {
        (VARIANCE.bar(ends, 8.0, &class_of_share(Some(place))))
        @if let Some(name) = name { (words([0.5 * (from + to), VARIANCE.middle() + 4.0], Anchor::Middle, "small", &name)) }
    }
}

/// Returns the axis of the strips of shares, in percent of the variance.
pub(crate) fn axis_of_shares() -> Axis {
    VARIANCE.axis(1.0)
}

/// Draws the sample of a part for a key; `None` for the remainder.
pub(crate) fn sample_of_share(place: Option<usize>) -> Markup {
    html! {
        (sample_bar(&class_of_share(place), 6.0))
        @if let Some(letter) = place.and_then(|place| LETTERS.get(place)) {
            (words([14.0, 11.0], Anchor::Middle, "small", letter))
        }
    }
}

fn class_of_share(place: Option<usize>) -> String {
    place.map_or_else(|| "share rest".to_owned(), |place| format!("share part-{}", place + 1))
}
