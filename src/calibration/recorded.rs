//! Limits of the readings that their digits show: rounding to the last digit, and repeated readings without any scatter.

use super::{MeterUncertainty, PositionReadings, Setup, Visit};
use crate::statistics::coincidences::step_of_meter;
use nalgebra::Vector2;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Standard deviation of readings, in units of their last digit, above which the mean of several readings is free of the
/// rounding of each.
pub(crate) const SPREAD_OVER_DIGITS: f64 = 0.5;

/// Digits and scatter of the currents of a file.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Recorded {
    /// Step of the coarser channel and of the coarsest range of the meter, mA; that of double precision if the currents
    /// were computed.
    pub(crate) last_digit_ma: f64,
    /// Standard deviation of the readings of a position within a turn-on, mA; `None` if no position has several.
    pub(crate) spread_ma: Option<f64>,
    /// `true` if the rows of every visit were identical, and one of each was kept.
    pub(crate) identical_rows: bool,
    /// `true` if the visits to every position were identical, and one of each was kept.
    pub(crate) identical_visits: bool,
}

result! {
    /// Limits of the readings that a result must state.
    #[derive(Copy, Default)]
    pub(crate) struct Digits {
        /// Last digit to which the currents are recorded, mA, if its rounding is larger than the floor of the meter and has
        /// taken its place.
        pub(crate) last_digit_ma: Option<f64> = default,
        /// `true` if the rows of every visit are identical and count as one.
        pub(crate) identical_rows: bool = default,
        /// `true` if the visits to every position are identical and count as one.
        pub(crate) identical_visits: bool = default,
    }
}

impl Recorded {
    /// Keeps one of identical rows and one of identical visits, and returns what the digits show.
    ///
    /// Identical readings show no scatter, whether they are copies or the last digit is too coarse. They are not evidence
    /// of a noise of 0, and do not reduce an uncertainty.
    pub(crate) fn of(positions: &mut [PositionReadings]) -> Self {
        let visits = || positions.iter().flat_map(|at| &at.visits);
        let same_rows = |visit: &Visit| visit.each_ma.iter().all(|row| *row == visit.each_ma[0]);
        let identical_rows = visits().any(|visit| visit.each_ma.len() > 1) && visits().all(same_rows);
        let rows = || visits().flat_map(|visit| &visit.each_ma);
        // Both channels together may show what one alone has too few readings for.
        let each = [0, 1].map(|axis| step_of_meter(rows().map(|row| row[axis])));
        let last_digit_ma = each.into_iter().fold(step_of_meter(rows().flat_map(|row| [row.x, row.y])), f64::max);
        for visit in positions.iter_mut().flat_map(|at| &mut at.visits).filter(|_| identical_rows) {
            visit.each_ma.truncate(1);
            visit.mean_ma = visit.each_ma[0];
        }
        let same_visits = |at: &PositionReadings| at.visits.iter().all(|visit| visit.each_ma == at.visits[0].each_ma);
        let identical_visits = positions.iter().any(|at| at.visits.len() > 1) && positions.iter().all(same_visits);
        for at in positions.iter_mut() {
            at.visits.truncate(if identical_visits { 1 } else { at.visits.len() });
            *at = PositionReadings::new(at.index, std::mem::take(&mut at.visits));
        }
        Self { last_digit_ma, spread_ma: spread_ma(positions), identical_rows, identical_visits }
    }

    /// Returns the standard uncertainty of the rounding, mA, or 0 if the readings spread over several digits.
    pub(crate) fn rounding_ma(&self, meter: &MeterUncertainty) -> f64 {
        let spread = self.spread_ma.unwrap_or(meter.noise_ma);
        if spread < SPREAD_OVER_DIGITS * self.last_digit_ma { rounding_of(self.last_digit_ma) } else { 0.0 }
    }

    /// Returns the limits that a result must state, given the stated uncertainties of `meter`; `None` if there are none.
    pub(crate) fn digits(&self, meter: &MeterUncertainty) -> Option<Digits> {
        let last_digit_ma = (self.rounding_ma(meter) > meter.floor_ma).then_some(self.last_digit_ma);
        let Self { identical_rows, identical_visits, .. } = *self;
        let found = Digits { last_digit_ma, identical_rows, identical_visits };
        (found != Digits::default()).then_some(found)
    }

    /// Returns the setup, in which the rounding replaces the floor of the meter if it is larger.
    pub(crate) fn applied_to(self, setup: &Setup) -> Cow<'_, Setup> {
        let meter = &setup.uncertainty().meter;
        let rounding_ma = self.rounding_ma(meter);
        if rounding_ma <= meter.floor_ma {
            return Cow::Borrowed(setup);
        }
        Cow::Owned(setup.clone().with(|u| u.meter.floor_ma = rounding_ma))
    }
}

/// Returns the standard uncertainty of a rounding to `last_digit`, in its unit: that of a rectangular distribution of this
/// width ([GUM](crate::bibliography::Bibliography::Gum), F.2.2.1).
pub(crate) fn rounding_of(last_digit: f64) -> f64 {
    last_digit / 12_f64.sqrt()
}

/// Returns the standard deviation of the readings of a position within a turn-on, mA, of both channels together.
fn spread_ma(positions: &[PositionReadings]) -> Option<f64> {
    let (mut sum, mut degrees_of_freedom) = (0.0, 0);
    for here in positions.iter().flat_map(|at| at.visits.chunk_by(|one, other| one.cycle == other.cycle)) {
        let rows = || here.iter().flat_map(|visit| &visit.each_ma);
        let count = rows().count();
        let mean = rows().sum::<Vector2<f64>>() / count as f64;
        sum += rows().map(|row| (row - mean).norm_squared()).sum::<f64>();
        degrees_of_freedom += 2 * (count - 1);
    }
    (degrees_of_freedom > 0).then(|| (sum / f64::from(degrees_of_freedom as u32)).sqrt())
}
