//! Agreement of the rows of a visit, and of the visits of a position, with the stated uncertainties.
//!
//! Rows of a visit differ only by the noise of a reading. Visits differ also by the repeatability of positioning. The
//! specification of the meter contributes no scatter, because its error is the same every time.

use super::estimates::{Basis, Estimates};
use super::inputs::Setup;
use super::least_squares::{Fit, whitening_of};
use super::readings::{PositionReadings, Readings};
use super::sensitivity::Sensitivity;
use crate::statistics::distributions::chi_square_larger;
use crate::statistics::scaled_f::{Part, ScaledF};
use nalgebra::{Matrix2, Vector2};

/// Probability below which a scatter, larger or smaller, does not agree with what was stated.
pub(crate) const IMPROBABLE: f64 = 0.001;

/// Scatter compared with what was stated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scatter {
    /// Sum of squares in units of the stated variance.
    pub chi_square: f64,
    /// Degrees of freedom: two for each visit of a position, or row of a visit, after its first.
    pub degrees_of_freedom: usize,
    /// Probability of more scatter if the stated variance is correct.
    pub probability: f64,
    /// Factor by which the stated variance was enlarged for this calibration; 1 if it was not.
    pub variance_factor: f64,
}

/// Result of the comparison of a scatter with what was stated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Agreement {
    /// More scatter than stated; the variance was enlarged.
    More,
    /// Scatter as stated.
    AsStated,
    /// Less scatter than stated; for visits, perhaps because the position was not left between them.
    Less,
}

/// Noise of a reading, from repeated rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RowScatter {
    /// Standard deviation of one reading, mA.
    pub standard_deviation_ma: f64,
    /// Degrees of freedom of the standard deviation.
    pub degrees_of_freedom: usize,
    /// Comparison with the noise that the laboratory states. If it states none, this is `None` and the standard
    /// deviation is used as the noise.
    pub against_stated: Option<Scatter>,
}

impl Scatter {
    fn new(chi_square: f64, degrees_of_freedom: usize, probability: f64) -> Self {
        let enlarged = probability < IMPROBABLE;
        let variance_factor = if enlarged { chi_square / degrees_of_freedom as f64 } else { 1.0 };
        Self { chi_square, degrees_of_freedom, probability, variance_factor }
    }

    /// Returns whether the scatter is larger than, as, or smaller than stated.
    pub(crate) fn agreement(&self) -> Agreement {
        match self.probability {
            more if more < IMPROBABLE => Agreement::More,
            less if less > 1.0 - IMPROBABLE => Agreement::Less,
            _ => Agreement::AsStated,
        }
    }
}

/// Numbers of visits and readings of each position, and the errors assumed for a visit and a reading.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Repeats {
    /// For each position: fractions of its variance that an error of a single visit, and of a single reading, has in
    /// the mean.
    pub(crate) shares: Vec<[f64; 2]>,
    /// Standard deviation of a single reading, mA, and its degrees of freedom if estimated from repeated rows.
    pub(crate) noise_ma: f64,
    pub(crate) noise_degrees_of_freedom: f64,
    /// Factor by which the variance of a visit (repeatability and noise together) is enlarged, and its degrees of
    /// freedom.
    pub(crate) visit_factor: f64,
    pub(crate) visit_degrees_of_freedom: f64,
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
        }
    }

    /// Returns the fraction of the variance of one visit that the mean of a position has.
    pub(crate) fn return_share(&self, place: usize) -> f64 {
        self.visit_factor * self.shares[place][0]
    }

    /// Returns the variance of the mean of a position from the noise of its readings, mA².
    pub(crate) fn noise_variance_ma2(&self, place: usize) -> f64 {
        self.visit_factor * self.shares[place][1] * self.noise_ma * self.noise_ma
    }

    /// Compares the scatter of rows and visits at a fit with what was stated. Replaces the errors if the scatter is
    /// larger than stated, or if nothing was stated.
    pub(crate) fn observe(&mut self, setup: &Setup, readings: &Readings, fit: &Fit) -> Observed {
        let mut of_rows = Squares::default();
        for visit in readings.positions().iter().flat_map(|at| &at.visits) {
            of_rows.add(&visit.each_ma, &visit.mean_ma);
        }
        let nothing_stated = self.noise_ma == 0.0 && setup.uncertainty().repeatability_rad == 0.0;
        if nothing_stated && of_rows.sum == 0.0 {
            // In this case visits are treated as single readings.
            let mut of_visits = Squares::default();
            for at in readings.positions() {
                let means: Vec<_> = at.visits.iter().map(|visit| visit.mean_ma).collect();
                of_visits.add(&means, &at.mean_ma);
            }
            return Observed { rows: self.observe_rows(&of_visits), visits: None };
        }
        let rows = self.observe_rows(&of_rows);
        Observed { rows, visits: self.observe_visits(setup, readings, fit) }
    }

    fn observe_rows(&mut self, found: &Squares) -> Option<RowScatter> {
        let stated = self.noise_ma;
        let &Squares { sum, degrees_of_freedom } = found;
        if degrees_of_freedom == 0 {
            return None;
        }
        let standard_deviation_ma = (sum / degrees_of_freedom as f64).sqrt();
        let against_stated = (stated > 0.0).then(|| {
            let chi_square = sum / (stated * stated);
            Scatter::new(chi_square, degrees_of_freedom, chi_square_larger(chi_square, degrees_of_freedom))
        });
        if against_stated.is_none_or(|found| found.variance_factor > 1.0) && sum > 0.0 {
            self.noise_ma = standard_deviation_ma;
            self.noise_degrees_of_freedom = degrees_of_freedom as f64;
        }
        Some(RowScatter { standard_deviation_ma, degrees_of_freedom, against_stated })
    }

    fn observe_visits(&mut self, setup: &Setup, readings: &Readings, fit: &Fit) -> Option<Scatter> {
        let sensitivity = Sensitivity::new(setup, &fit.unknowns);
        let estimates = Estimates::new(setup, self);
        let k = fit.unknowns.parameters.k_deg_per_h_per_ma;
        let (mut chi_square, mut degrees_of_freedom) = (0.0, 0);
        let mut parts = Parts::new(&estimates);
        for (place, at) in readings.positions().iter().enumerate().filter(|(_, at)| at.visits.len() > 1) {
            let returns = sensitivity.of_return(place);
            let of_noise = |visit: usize| {
                k * k.transpose() * (self.noise_ma * self.noise_ma / at.visits[visit].each_ma.len() as f64)
            };
            let whiten: Option<Vec<Matrix2<f64>>> =
                (0..at.visits.len()).map(|visit| whitening_of(&(returns + of_noise(visit)))).collect();
            let whiten = whiten?;
            let weights = whiten.iter().map(|w| w.transpose() * w);
            let misclosures: Vec<Vector2<f64>> = at.visits.iter().map(|visit| k * visit.mean_ma).collect();
            let sum: Vector2<f64> = weights.clone().zip(&misclosures).map(|(weight, at)| weight * at).sum();
            let mean = weights.sum::<Matrix2<f64>>().try_inverse()? * sum;
            chi_square += whiten.iter().zip(&misclosures).map(|(w, at)| (w * (at - mean)).norm_squared()).sum::<f64>();
            degrees_of_freedom += 2 * (at.visits.len() - 1);
            let kept = 1.0 - at.visit_share();
            for (visit, w) in whiten.iter().enumerate() {
                parts.add(estimates.returns, kept, &(w * returns * w.transpose()));
                parts.add(estimates.noise, kept, &(w * of_noise(visit) * w.transpose()));
            }
        }
        if degrees_of_freedom == 0 || chi_square.is_nan() {
            return None;
        }
        let probability = ScaledF::new(degrees_of_freedom, &parts.parts).larger(chi_square);
        let found = Scatter::new(chi_square, degrees_of_freedom, probability);
        if found.variance_factor > 1.0 {
            self.visit_factor = found.variance_factor;
            self.visit_degrees_of_freedom = degrees_of_freedom as f64;
        }
        Some(found)
    }
}

/// Scatter of rows and visits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Observed {
    pub(crate) rows: Option<RowScatter>,
    pub(crate) visits: Option<Scatter>,
}

/// Sum of squared differences of both currents from means, mA².
#[derive(Default)]
struct Squares {
    sum: f64,
    degrees_of_freedom: usize,
}

impl Squares {
    fn add(&mut self, each_ma: &[Vector2<f64>], mean_ma: &Vector2<f64>) {
        self.sum += each_ma.iter().map(|reading| (reading - mean_ma).norm_squared()).sum::<f64>();
        self.degrees_of_freedom += 2 * (each_ma.len() - 1);
    }
}

/// Parts of the covariance of the visits that rest on estimates.
struct Parts {
    parts: Vec<Part>,
}

impl Parts {
    fn new(estimates: &Estimates) -> Self {
        let part = |&degrees_of_freedom: &f64| Part { degrees_of_freedom, trace: 0.0, square: 0.0 };
        Self { parts: estimates.degrees_of_freedom.iter().map(part).collect() }
    }

    fn add(&mut self, basis: Basis, kept: f64, whitened: &Matrix2<f64>) {
        for (place, share) in basis.shares() {
            let part = whitened * share;
            self.parts[place].trace += kept * part.trace();
            self.parts[place].square += kept * (part * part).trace();
        }
    }
}
