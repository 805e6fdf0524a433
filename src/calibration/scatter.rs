//! Whether rows of one visit, and visits of one position, agree as well as meter and stand promise.
//!
//! Rows of a visit differ by the noise of a reading alone. Visits differ by the return to the position too. The meter's
//! specification is the same error every time, so it makes no scatter.

use super::estimates::{Basis, Estimates};
use super::inputs::Setup;
use super::least_squares::{Fit, whitening_of};
use super::readings::{PositionReadings, Readings};
use super::sensitivity::Sensitivity;
use crate::statistics::distributions::chi_square_larger;
use crate::statistics::scaled_f::{Part, ScaledF};
use nalgebra::{Matrix2, Vector2};

/// Scatter with a smaller probability than this, of more or of less, is not what was stated.
pub(crate) const IMPROBABLE: f64 = 0.001;

/// A scatter against what was stated of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scatter {
    /// Sum of squares in units of the stated variance.
    pub chi_square: f64,
    /// Two for each visit of a position, or each row of a visit, beyond its first.
    pub degrees_of_freedom: usize,
    /// Probability of more when the statement holds.
    pub probability: f64,
    /// By how much the stated variance was enlarged for this calibration: 1 when it was not.
    pub variance_factor: f64,
}

/// How a scatter compares with what was stated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Agreement {
    /// More: the variance was enlarged.
    More,
    /// As stated.
    AsStated,
    /// Less: perhaps the readings are not what they are taken for.
    Less,
}

/// The noise of a reading as repeated rows show it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RowScatter {
    /// Standard deviation of one reading, mA.
    pub standard_deviation_ma: f64,
    /// Degrees of freedom of that.
    pub degrees_of_freedom: usize,
    /// Against the noise that the laboratory states; `None` where it states none, and the standard deviation is
    /// used in its place.
    pub against_stated: Option<Scatter>,
}

impl Scatter {
    fn new(chi_square: f64, degrees_of_freedom: usize, probability: f64) -> Self {
        let enlarged = probability < IMPROBABLE;
        let variance_factor = if enlarged { chi_square / degrees_of_freedom as f64 } else { 1.0 };
        Self { chi_square, degrees_of_freedom, probability, variance_factor }
    }

    /// Returns whether there is more or less of it than was stated.
    pub(crate) fn agreement(&self) -> Agreement {
        match self.probability {
            more if more < IMPROBABLE => Agreement::More,
            less if less > 1.0 - IMPROBABLE => Agreement::Less,
            _ => Agreement::AsStated,
        }
    }
}

/// How often every position was read, and what is taken for the errors of a visit and of a reading.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Repeats {
    /// Of each position: the share of its variance that an error of every visit, and of every reading, keeps in the mean.
    pub(crate) shares: Vec<[f64; 2]>,
    /// Standard deviation of a reading in place, mA, and its degrees of freedom where repeated rows showed it.
    pub(crate) noise_ma: f64,
    pub(crate) noise_degrees_of_freedom: f64,
    /// By how much the variance of a visit, return and noise together, is enlarged, and the degrees of freedom of that.
    pub(crate) visit_factor: f64,
    pub(crate) visit_degrees_of_freedom: f64,
}

impl Repeats {
    /// As the laboratory states it.
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

    /// Share of the variance of one return that the mean of a position keeps.
    pub(crate) fn return_share(&self, place: usize) -> f64 {
        self.visit_factor * self.shares[place][0]
    }

    /// Variance of the mean of a position by the noise of its readings, mA².
    pub(crate) fn noise_variance_ma2(&self, place: usize) -> f64 {
        self.visit_factor * self.shares[place][1] * self.noise_ma * self.noise_ma
    }

    /// Takes in what rows and visits say of themselves at a fit; it changes where they say more than was stated, or where
    /// nothing was stated.
    pub(crate) fn observe(&mut self, setup: &Setup, readings: &Readings, fit: &Fit) -> Observed {
        let mut of_rows = Squares::default();
        for visit in readings.positions().iter().flat_map(|at| &at.visits) {
            of_rows.add(&visit.each_ma, &visit.mean_ma);
        }
        let nothing_stated = self.noise_ma == 0.0 && setup.uncertainty().repeatability_rad == 0.0;
        if nothing_stated && of_rows.sum == 0.0 {
            // Then visits are readings like any others.
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

/// What repeated readings say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Observed {
    pub(crate) rows: Option<RowScatter>,
    pub(crate) visits: Option<Scatter>,
}

/// Squares of both currents about means.
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

/// Shares of the scatter of visits that rest on estimates.
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
