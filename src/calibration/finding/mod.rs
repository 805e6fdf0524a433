//! Causes of readings that do not agree: one list, with one level of false alarms for all of them together.
//!
//! A cause changes the set-up or the readings, and the readings are fitted again. Causes within turn-ons and visits are
//! compared by F tests on the differences between visits (`visits`, `layer`), causes of the whole run by the fit of the positions
//! (`fits`), and what leaves no residuals by the distance from the gyro type (`by_type`). `words` has the sentences.
//!
//! Half of [`LEVEL`] is that of chi-square of the fit, the other half is shared by the other tests. A finding states the
//! probability that chance makes any test of a good run alarm as much.

pub(crate) mod by_type;
pub(crate) mod fits;
pub(crate) mod layer;
pub(crate) mod rows;
pub(crate) mod visits;
mod words;

use super::chi_square::ALARM;
use super::data::Observation;
use super::drift::{drift_can_be_fitted, drift_test};
use super::readings::Exclusion;
use super::{ChiSquare, Options, Readings, Scatter, Setup};
use crate::coefficients::PositionIndex;
use crate::gyro::GyroParameters;
use crate::wording::Language;
use serde::{Deserialize, Serialize};

/// Probability that a good run alarms in any test.
pub(crate) const LEVEL: f64 = 2.0 * ALARM;

/// Probability above which chance is named among the causes.
const BY_CHANCE: f64 = 0.001;

/// Number of tests beside chi-square: visit, K of turn-ons, drift, settling and backlash; scatter of visits and of turn-ons;
/// row, correlation and scatter of rows; a fit that is too good.
const TESTS: f64 = 11.0;

/// Step of the readings, relative to the largest current, from which gyros that differ by the tolerance of the paper give the
/// same readings.
const COARSE: f64 = 5e-4;

/// Returns the probability that any test beside chi-square alarms by chance, for one that has `probability`.
pub(crate) fn jointly(probability: f64) -> f64 {
    (2.0 * TESTS * probability).min(1.0)
}

/// Kind of a cause, as in the JSON.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Kind {
    /// The currents of x and y are exchanged.
    ColumnsExchanged,
    /// Currents have the wrong sign: both, or one channel.
    ColumnReversed,
    /// Currents are too large by a factor: another unit or range.
    Range,
    /// The gyro is rotated in its seat by quarters.
    GyroTurned,
    /// The gyro, or the base about the vertical, is rotated by a small angle.
    Rotated,
    /// The axis of the frame points to another azimuth.
    FrameAxis,
    /// The passport is that of another site.
    OtherSite,
    /// The positions have other numbers than in the certificate.
    Renumbered,
    /// The readings of two positions are exchanged.
    PositionsExchanged,
    /// The values of the gyro type are in another unit.
    TypeUnit,
    /// K differs between turn-ons.
    KDiffers,
    /// ω_0 varies between turn-ons more than stated.
    TurnOnScatter,
    /// ω_0 drifts in time.
    Drift,
    /// ω_0 settles after turn-on.
    Settling,
    /// The drift of the gyro varies from visit to visit.
    GyroNoise,
    /// The g-sensitive drift needs the general model.
    GeneralModel,
    /// A position depends on the direction from which it was approached.
    Backlash,
    /// The last digit of the currents is too coarse.
    CoarseDigits,
    /// A position did not repeat, or its reading is wrong.
    Position,
    /// A visit differs from the others.
    Visit,
    /// A row differs from the others of its visit.
    Row,
    /// Successive rows of a visit are correlated.
    RowsCorrelated,
    /// The meter is worse than stated.
    Meter,
    /// The passport is that of another stand.
    Stand,
    /// The currents were computed, not measured.
    Computed,
    /// Chance.
    Chance,
}

result! {
    /// Part of the readings on which a cause acts. An absent key is no restriction.
    #[derive(Default)]
    pub struct Scope {
        /// Turn-on.
        pub cycle: Option<u32> = default,
        /// Frame index.
        pub i: Option<u32> = default,
        /// Platform index.
        pub j: Option<u32> = default,
        /// Number of the visit within its turn-on and position.
        pub visit: Option<u32> = default,
        /// Number of the row within the visit.
        pub row: Option<usize> = default,
        /// Channel of the currents, x or y.
        pub channel: Option<char> = default,
        /// Two positions (i, j).
        pub between: Option<[[u32; 2]; 2]> = default,
        /// Numbers of the readings and those of the passport.
        pub numbers: Option<String> = default,
    }
}

impl Scope {
    pub(crate) fn of(index: PositionIndex) -> Self {
        Self { i: Some(index.i), j: Some(index.j), ..Self::default() }
    }

    /// Returns the scope of one channel, 0 for x and 1 for y.
    pub(crate) fn channel(self, axis: usize) -> Self {
        Self { channel: Some(['x', 'y'][axis]), ..self }
    }
}

result! {
    /// A cause that explains readings.
    #[serde(expecting = "struct CauseDocument")]
    pub struct Finding {
        /// Kind of the cause.
        pub kind: Kind,
        /// Readings on which the cause acts.
        pub scope: Scope,
        /// Size of the cause in `unit`; `None` for a cause without a size.
        pub size: Option<f64> = default,
        /// Unit of the size; 1 for a factor.
        pub unit: Option<String> = default,
        /// Probability that chance makes any test alarm as much.
        pub probability: f64,
        /// The finding and what to do, in English.
        pub words: String,
        /// Two values along x and y, in the unit that the sentences of its kind have.
        #[serde(skip)]
        pub(crate) pair: [f64; 2],
        /// `true` if another cause of the list may be meant instead: the readings do not tell which.
        #[serde(skip)]
        pub(crate) one_of_several: bool,
        /// Parameters with the cause.
        #[serde(skip)]
        pub(crate) parameters: Option<GyroParameters>,
    }
}

impl Finding {
    pub(crate) fn new(kind: Kind, scope: Scope, size: Option<(f64, &str)>, probability: f64) -> Self {
        let (size, unit) = size.map(|(size, unit)| (size, unit.to_owned())).unzip();
        let (words, pair) = (String::new(), [0.0; 2]);
        Self { kind, scope, size, unit, probability, words, pair, one_of_several: false, parameters: None }
    }

    pub(crate) fn with(self, parameters: GyroParameters) -> Self {
        Self { parameters: Some(parameters), ..self }
    }

    /// Returns the finding with its sentences in English.
    pub(super) fn in_words(self) -> Self {
        Self { words: crate::wording::plain(&self.said().plain(Language::English)), ..self }
    }

    /// Returns `true` if the result is not that of the gyro even though the readings fit.
    pub(crate) fn invalidates(&self) -> bool {
        use Kind::{
            Chance, CoarseDigits, Computed, Drift, GyroNoise, KDiffers, Meter, Row, RowsCorrelated, Settling,
            TurnOnScatter, Visit,
        };
        let only_warns = matches!(
            self.kind,
            Chance | CoarseDigits | Computed | Drift | Settling | KDiffers | TurnOnScatter | GyroNoise | Visit | Row
        );
        !only_warns && !matches!(self.kind, RowsCorrelated | Meter | Kind::Backlash)
    }

    /// Returns `true` if a visit or a row is probably wrong.
    pub(crate) fn is_reading(&self) -> bool {
        matches!(self.kind, Kind::Visit | Kind::Row)
    }

    /// Returns the readings without the visit or row.
    pub(crate) fn left_out(&self, readings: &Readings) -> Option<Readings> {
        let Scope { i, j, cycle, visit, row, .. } = self.scope;
        let (i, j, visit) = (i?, j?, visit?);
        let mut rest = readings.clone();
        match row {
            Some(row) => {
                rest.leave_out_row(PositionIndex { i, j }, (cycle?, visit), row.checked_sub(1)?)?;
            }
            None => rest.exclude(Exclusion { i, j, visit, cycle, why: String::new() }).ok()?,
        }
        Some(rest)
    }
}

/// Returns the causes of a result, most likely first, and whether the readings fit the stand.
pub(crate) fn all(
    setup: &Setup,
    readings: &Readings,
    (observation, explained): (&Observation, &[visits::Explained]),
    options: &Options,
    chi_square: &ChiSquare,
) -> (Vec<Finding>, bool) {
    let Observation { data, fit, seen, .. } = observation;
    let mut causes = visits::causes(setup, readings, (observation, explained), options);
    let is_layered = !causes.is_empty();
    let mut consistent = !causes.iter().any(Finding::invalidates);
    causes.extend(rows::causes(setup, readings, observation, options));
    // A chi-square that is NaN is not a good fit either.
    let is_good = !chi_square.judges() || chi_square.probability >= ALARM;
    if consistent && is_good && !is_layered && !options.drift {
        causes.extend(drift(setup, readings, options));
    }
    if consistent && !is_good {
        let probability = (2.0 * chi_square.probability).min(1.0);
        let drifts = causes.iter().any(|cause| cause.kind == Kind::Drift);
        let of_fit = fits::causes(setup, readings, (data, fit), options, chi_square);
        let others = of_fit.into_iter().filter(|cause| !(drifts && cause.kind == Kind::Drift));
        causes.extend(others.map(|cause| Finding { probability, ..cause }));
    }
    consistent &= is_good;
    let scattered = |scatter: Option<Scatter>, cause: &dyn Fn(f64) -> Finding| {
        let probability = jointly(scatter?.probability);
        (probability < LEVEL).then(|| cause(probability))
    };
    let noise = data.repeats.visit.deg_per_h;
    causes.extend(scattered(seen.turn_ons, &|p| {
        Finding::new(Kind::TurnOnScatter, Scope::default(), Some((data.repeats.turn_on.deg_per_h, "deg/h")), p)
    }));
    if !is_layered && setup.uncertainty().visit_deg_per_h.is_some() {
        let factor = data.repeats.visit_factor.sqrt();
        causes.extend(scattered(seen.visits, &|p| {
            Finding::new(Kind::GyroNoise, Scope::default(), Some((noise * factor, "deg/h")), p)
        }));
    }
    causes.extend(limits(setup, readings, observation, chi_square));
    let probability = causes.iter().map(|cause| cause.probability).fold(1.0, f64::min);
    if (BY_CHANCE..LEVEL).contains(&probability) {
        causes.push(Finding::new(Kind::Chance, Scope::default(), None, probability));
    }
    (causes, consistent)
}

/// Returns what the digits of the readings, and a fit that is too good, show.
fn limits(setup: &Setup, readings: &Readings, of: &Observation, chi_square: &ChiSquare) -> Vec<Finding> {
    let digits = readings.recorded.digits(&setup.uncertainty().meter);
    let step_ma = digits.and_then(|digits| digits.last_digit_ma);
    let largest = of.data.currents_ma.iter().map(|current| current.amax()).fold(0.0, f64::max);
    let coarse = step_ma.filter(|step_ma| *step_ma > COARSE * largest);
    let coarse = coarse.map(|step_ma| Finding::new(Kind::CoarseDigits, Scope::default(), Some((step_ma, "mA")), 0.0));
    let probability = jointly(1.0 - chi_square.probability);
    let estimated = of.data.repeats.visit.is_estimated() || of.data.repeats.visit_factor > 1.0;
    let too_good = chi_square.judges() && digits.is_none() && !estimated && probability < LEVEL;
    let computed = too_good.then(|| Finding::new(Kind::Computed, Scope::default(), None, probability));
    coarse.into_iter().chain(computed).collect()
}

/// Returns a drift in time of readings whose visits are not repeated often enough for the differences to show it.
fn drift(setup: &Setup, readings: &Readings, options: &Options) -> Option<Finding> {
    drift_can_be_fitted(setup, readings).ok()?;
    let (drift, probability, _) = drift_test(setup, readings, options).filter(|(.., explains)| *explains)?;
    let probability = jointly(probability);
    let size = Some((drift.norm(), "deg/h/h"));
    let found = Finding { pair: drift.into(), ..Finding::new(Kind::Drift, Scope::default(), size, probability) };
    (probability < LEVEL).then_some(found)
}

/// Returns the minimum point of a function with one minimum between `low` and `high`, to 1e-6 of their distance.
pub(crate) fn minimum(mut low: f64, mut high: f64, of: impl Fn(f64) -> f64) -> f64 {
    const STEPS: usize = 29;
    /// The golden section: of the two points between the ends, one is a point of the next step too.
    const SECTION: f64 = 0.618_033_988_749_894_8;
    let lower = |low: f64, high: f64| high - SECTION * (high - low);
    let upper = |low: f64, high: f64| low + SECTION * (high - low);
    let mut inner = [lower(low, high), upper(low, high)];
    let mut values = inner.map(&of);
    for _ in 0..STEPS {
        if values[0] <= values[1] {
            high = inner[1];
            inner = [lower(low, high), inner[0]];
            values = [of(inner[0]), values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], upper(low, high)];
            values = [values[1], of(inner[1])];
        }
    }
    (low + high) / 2.0
}
