//! Numbers of visits and readings, and the errors assumed for each: stated, or replaced by what their scatter shows.

use super::{DriftNoise, PositionReadings, Readings, Setup};

/// Numbers of visits and readings of each position, and the errors assumed for a visit and a reading.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Repeats {
    /// For each position: fractions of its variance that an error of a single visit, and of a single reading, has in
    /// the mean.
    pub(crate) shares: Vec<[f64; 2]>,
    /// Standard deviation of a single reading, mA, and its degrees of freedom if estimated from repeated rows.
    pub(crate) noise_ma: f64,
    pub(crate) noise_degrees_of_freedom: f64,
    /// Factor by which the variance of a visit (repeatability, readings and gyro together) is enlarged, and its degrees
    /// of freedom if it is estimated.
    pub(crate) visit_factor: f64,
    pub(crate) visit_degrees_of_freedom: f64,
    /// Noise of the gyro's drift from visit to visit, and from one turn-on to the next.
    pub(crate) visit: DriftNoise,
    pub(crate) turn_on: DriftNoise,
    /// Number of turn-ons.
    pub(crate) cycles: usize,
    /// Standard deviation of the elements of K from turn-on to turn-on, °/(h·mA), by rows; 0 if K does not differ.
    pub(crate) scale: [f64; 4],
}

impl Repeats {
    /// Creates the errors as the laboratory and the certificate state them.
    pub(crate) fn stated(setup: &Setup, readings: &Readings) -> Self {
        let shares = |at: &PositionReadings| [at.visit_share(), at.reading_share()];
        Self {
            shares: readings.positions().iter().map(shares).collect(),
            noise_ma: setup.uncertainty().meter.noise_ma,
            noise_degrees_of_freedom: f64::INFINITY,
            visit_factor: 1.0,
            visit_degrees_of_freedom: f64::INFINITY,
            visit: DriftNoise::stated(setup.uncertainty().visit_deg_per_h),
            turn_on: DriftNoise::stated(setup.uncertainty().turn_on_deg_per_h),
            cycles: readings.cycles().len(),
            scale: [0.0; 4],
        }
    }

    /// Returns the variance of the mean of a position from the gyro's noise from visit to visit, (°/h)², each axis.
    pub(crate) fn drift_variance(&self, place: usize) -> f64 {
        self.return_share(place) * self.visit.deg_per_h * self.visit.deg_per_h
    }

    /// Returns the standard uncertainty of the mean of the turn-ons, °/h, each axis.
    pub(crate) fn turn_on_of_mean_deg_per_h(&self) -> f64 {
        self.turn_on.deg_per_h / (self.cycles as f64).sqrt()
    }

    /// Returns the standard uncertainty of an element of the mean K of the turn-ons, °/(h·mA), from their scatter.
    pub(crate) fn scale_of_mean(&self, element: usize) -> f64 {
        self.scale[element] / (self.cycles as f64).sqrt()
    }

    /// Returns the fraction of the variance of one visit that the mean of a position has.
    pub(crate) fn return_share(&self, place: usize) -> f64 {
        self.visit_factor * self.shares[place][0]
    }

    /// Returns the variance of the mean of a position from the noise of its readings, mA².
    pub(crate) fn noise_variance_ma2(&self, place: usize) -> f64 {
        self.visit_factor * self.shares[place][1] * self.noise_ma * self.noise_ma
    }

    /// Returns the degrees of freedom of the scatter of two elements of K between turn-ons.
    pub(crate) fn scale_degrees_of_freedom(&self) -> f64 {
        2.0 * self.cycles.saturating_sub(1) as f64
    }
}
