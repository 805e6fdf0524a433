//! Agreement of the rows of a visit, of the visits of a position and of the turn-ons with what was stated of their errors,
//! which are estimated from their scatter if it is larger, or if nothing was stated.
//!
//! Rows of a visit differ only by the noise of a reading. Visits differ also by the repeatability of positioning. The
//! specification of the meter contributes no scatter, because its error is the same every time.

use super::estimates::Estimates;
use super::least_squares::Fit;
use super::noise;
use super::offsets::{Differences, Offsets};
use super::repeats::Repeats;
use super::sensitivity::Sensitivity;
use super::{Basis, DriftNoise, NoiseSource, PositionReadings, Readings, Setup, Visit};
use crate::statistics::distributions::chi_square_larger;
use crate::statistics::least_squares::whitening_of;
use crate::statistics::scaled_f::{Part, ScaledF};
use nalgebra::{DMatrix, DVector, Matrix2};
use serde::{Deserialize, Serialize};

/// Probability below which a scatter, larger or smaller, does not agree with what was stated.
pub(crate) const IMPROBABLE: f64 = 0.001;

/// Noise of a visit with which differences between visits are weighted if they show none, °/h.
const LEAST_DEG_PER_H: f64 = 1e-9;

/// Scatter compared with what was stated.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
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

result! {
    /// Noise of a reading, from repeated rows, compared with the noise that the laboratory states. If it states none, the
    /// standard deviation is used as the noise.
    #[derive(Copy)]
    #[serde(expecting = "struct RowScatterDocument")]
    pub struct RowScatter {
        /// Standard deviation of one reading, mA.
        pub standard_deviation_ma: f64,
        /// Degrees of freedom: two for each row after a visit's first.
        pub degrees_of_freedom: usize,
        /// Sum of squares in units of the stated variance; absent if no noise is stated.
        pub chi_square: Option<f64> = default,
        /// Probability of more scatter if the stated noise is correct; close to 1 if there is less than stated.
        pub probability: Option<f64> = default,
        /// Factor by which the variance of a reading was enlarged.
        pub variance_factor: Option<f64> = default,
    }
}

impl RowScatter {
    /// Returns the comparison with the stated noise, if there is one.
    pub(crate) fn against_stated(&self) -> Option<Scatter> {
        let Self { degrees_of_freedom, .. } = *self;
        let (chi_square, probability) = self.chi_square.zip(self.probability)?;
        Some(Scatter { chi_square, degrees_of_freedom, probability, variance_factor: self.variance_factor? })
    }
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

impl Repeats {
    /// Compares the scatter of rows and visits at a fit with what was stated. Replaces the errors if the scatter is larger
    /// than stated, or if nothing was stated; `offsets` takes over what differences between visits say.
    pub(crate) fn observe(
        &mut self,
        setup: &Setup,
        readings: &Readings,
        differences: Option<&Differences>,
        offsets: &mut Offsets,
        fit: &Fit,
    ) -> Observed {
        let rows = self.observe_rows(readings);
        let visits = differences.and_then(|found| self.observe_visits(setup, readings, found, offsets, fit));
        Observed { rows, visits, turn_ons: None }
    }

    fn observe_rows(&mut self, readings: &Readings) -> Option<RowScatter> {
        let squares = |visit: &Visit| visit.each_ma.iter().map(|row| (row - visit.mean_ma).norm_squared()).sum::<f64>();
        let sum: f64 = readings.visits().map(squares).sum();
        let degrees_of_freedom: usize = readings.visits().map(|visit| 2 * (visit.each_ma.len() - 1)).sum();
        if degrees_of_freedom == 0 {
            return None;
        }
        let stated = self.noise_ma;
        let standard_deviation_ma = (sum / degrees_of_freedom as f64).sqrt();
        let against_stated = (stated > 0.0).then(|| {
            let chi_square = sum / (stated * stated);
            Scatter::new(chi_square, degrees_of_freedom, chi_square_larger(chi_square, degrees_of_freedom))
        });
        if against_stated.is_none_or(|found| found.variance_factor > 1.0) && sum > 0.0 {
            self.noise_ma = standard_deviation_ma;
            self.noise_degrees_of_freedom = degrees_of_freedom as f64;
        }
        let [chi_square, probability, variance_factor] = against_stated
            .map_or([None; 3], |found| [found.chi_square, found.probability, found.variance_factor].map(Some));
        Some(RowScatter { standard_deviation_ma, degrees_of_freedom, chi_square, probability, variance_factor })
    }

    fn observe_visits(
        &mut self,
        setup: &Setup,
        readings: &Readings,
        differences: &Differences,
        offsets: &mut Offsets,
        fit: &Fit,
    ) -> Option<Scatter> {
        let k = fit.unknowns.parameters.k_deg_per_h_per_ma;
        let errors = VisitErrors::new(setup, readings, fit, self.noise_ma);
        let known = |place, visit| errors.known(place, visit);
        let of_stated = |place, visit| errors.with_noise(place, visit, self.visit.deg_per_h);
        let found = differences.condensed(&k, of_stated);
        let scatter = found.as_ref().filter(|found| found.degrees_of_freedom > 0).map(|found| {
            let parts = self.parts(setup, &errors, of_stated);
            let probability = ScaledF::new(found.degrees_of_freedom, &parts).larger(found.chi_square);
            Scatter::new(found.chi_square, found.degrees_of_freedom, probability)
        });
        // A noise that is stated as 0, where nothing else scatters, cannot be compared with a scatter that is there.
        if self.visit.source == NoiseSource::NotStated || found.is_none() {
            let (deg_per_h, degrees_of_freedom) = noise::of_visits(differences, &k, known)?;
            self.visit = DriftNoise::estimated(deg_per_h, degrees_of_freedom);
            if deg_per_h > 0.0 {
                self.visit_degrees_of_freedom = degrees_of_freedom as f64;
            }
            let of_visit = |place, visit| errors.with_noise(place, visit, deg_per_h.max(LEAST_DEG_PER_H));
            offsets.with(differences.condensed(&k, of_visit)?);
            return scatter.map(|scatter| Scatter { variance_factor: 1.0, ..scatter });
        }
        let factor = scatter.map_or(1.0, |scatter| scatter.variance_factor);
        offsets.with(differences.condensed(&k, |place, visit| of_stated(place, visit) * factor)?);
        if let Some(scatter) = scatter.filter(|scatter| scatter.variance_factor > 1.0) {
            self.visit_factor = scatter.variance_factor;
            self.visit_degrees_of_freedom = scatter.degrees_of_freedom as f64;
        }
        scatter
    }

    /// Returns the parts of the covariance of the visits that rest on estimates.
    fn parts(&self, setup: &Setup, errors: &VisitErrors, of_visit: impl Fn(usize, usize) -> Matrix2<f64>) -> Vec<Part> {
        let estimates = Estimates::new(setup, self);
        let part = |&degrees_of_freedom: &f64| Part { degrees_of_freedom, trace: 0.0, square: 0.0 };
        let mut parts: Vec<Part> = estimates.degrees_of_freedom.iter().map(part).collect();
        let mut add = |basis: Basis, kept: f64, whitened: Matrix2<f64>| {
            for (place, share) in basis.shares() {
                let part = whitened * share;
                parts[place].trace += kept * part.trace();
                parts[place].square += kept * (part * part).trace();
            }
        };
        for (place, at) in errors.positions.iter().enumerate().filter(|(_, at)| at.visits.len() > 1) {
            // Visits with the same number of rows have the same covariance.
            let mut first = 0;
            for visits in at.visits.chunk_by(|one, other| one.each_ma.len() == other.each_ma.len()) {
                let kept = visits.len() as f64 * (1.0 - at.visit_share());
                let visit = first;
                first += visits.len();
                let Some(w) = whitening_of(&of_visit(place, visit)) else { continue };
                add(estimates.returns, kept, w * errors.returns[place] * w.transpose());
                add(estimates.noise, kept, w * errors.of_noise(place, visit) * w.transpose());
            }
        }
        parts
    }

    /// Compares the biases of the turn-ons with what the gyro type states; estimates their scatter if it states nothing,
    /// or too little.
    pub(crate) fn observe_turn_ons(&mut self, offsets: &Offsets, fit: &Fit) -> Option<Scatter> {
        let cycles = offsets.cycles.len();
        if cycles < 2 {
            return None;
        }
        // A drift is found within turn-ons; its error changes their biases in proportion to their times, which say little of
        // their scatter. Of two turn-ons only this is left, and all of it is taken for scatter.
        let along_time = offsets.drift && cycles > 2;
        let degrees_of_freedom = 2 * (cycles - 1 - usize::from(along_time));
        let map = if along_time { offsets.beside_times() * offsets.turn_ons() } else { offsets.turn_ons() };
        let each = [0, 1].map(|axis| of_turn_ons(&map, fit, 0, axis));
        let [squares, of_noise] = each.iter().fold([0.0, 0.0], |[a, b], [one, other]| [a + one, b + other]);
        let of_noise = if offsets.drift && cycles == 2 { 0.0 } else { of_noise };
        let [variance, of_noise] = [squares, of_noise].map(|sum| sum / degrees_of_freedom as f64);
        let estimate = DriftNoise::estimated((variance - of_noise).max(0.0).sqrt(), degrees_of_freedom);
        if self.turn_on.source == NoiseSource::NotStated {
            self.turn_on = estimate;
            return None;
        }
        let stated = self.turn_on.deg_per_h * self.turn_on.deg_per_h + of_noise;
        let chi_square = squares / stated;
        let found = Scatter::new(chi_square, degrees_of_freedom, chi_square_larger(chi_square, degrees_of_freedom));
        if found.variance_factor > 1.0 {
            self.turn_on = estimate;
        }
        Some(found)
    }

    /// Estimates how much K varies from turn-on to turn-on, if each has its own: K_x and K_y by the same fraction, and K_xy and
    /// K_yx by the same amount.
    pub(crate) fn observe_scale(&mut self, offsets: &Offsets, fit: &Fit) {
        let freedom = self.scale_degrees_of_freedom();
        if !offsets.scale || freedom == 0.0 {
            return;
        }
        let (map, k) = (offsets.turn_ons(), fit.unknowns.parameters.k_deg_per_h_per_ma);
        for (pair, units) in [([0, 3], [k.m11.abs(), k.m22.abs()]), ([1, 2], [1.0, 1.0])] {
            let squares = pair.iter().zip(units).map(|(element, unit)| {
                let [squares, of_noise] = of_turn_ons(&map, fit, 1 + element % 2, element / 2);
                (squares - of_noise) / (unit * unit)
            });
            let each = (squares.sum::<f64>().max(0.0) / freedom).sqrt();
            pair.into_iter().zip(units).for_each(|(element, unit)| self.scale[element] = each * unit);
        }
    }
}

/// Returns the sum of the squares of what turn-ons add to ω_0, or to a column of K, about an axis, and of its uncertainties.
fn of_turn_ons(map: &DMatrix<f64>, fit: &Fit, group: usize, axis: usize) -> [f64; 2] {
    let (count, r_inverse) = (map.ncols(), &fit.model.r_inverse);
    let place = |term: usize| 2 * (group * count + term) + axis;
    let x = DVector::from_fn(count, |term, _| fit.changing[place(term)]);
    let first = fit.of.columns();
    let rows = DMatrix::from_fn(count, r_inverse.ncols(), |term, inner| r_inverse[(first + place(term), inner)]);
    [(map * x).norm_squared(), (map * rows).norm_squared()]
}

/// Covariances of the errors of single visits, (°/h)², 2×2.
pub(crate) struct VisitErrors<'a> {
    positions: &'a [PositionReadings],
    returns: Vec<Matrix2<f64>>,
    reading: Matrix2<f64>,
    rounding: Matrix2<f64>,
}

impl<'a> VisitErrors<'a> {
    /// Creates the errors with which the visits of `readings` differ, given the noise of a reading.
    pub(crate) fn new(setup: &Setup, readings: &'a Readings, fit: &Fit, noise_ma: f64) -> Self {
        let sensitivity = Sensitivity::new(setup, &fit.unknowns);
        let k = fit.unknowns.parameters.k_deg_per_h_per_ma;
        let positions = readings.positions();
        // Each visit has its own rounding, so the visits differ by it.
        let meter = &setup.uncertainty().meter;
        let rounding_ma = Some(readings.recorded.rounding_ma(meter)).filter(|rounding| *rounding >= meter.floor_ma);
        let of_current = |ma: f64| k * k.transpose() * (ma * ma);
        Self {
            positions,
            returns: (0..positions.len()).map(|place| sensitivity.of_return(place)).collect(),
            reading: of_current(noise_ma),
            rounding: of_current(rounding_ma.unwrap_or(0.0)),
        }
    }

    fn of_noise(&self, place: usize, visit: usize) -> Matrix2<f64> {
        self.reading / self.positions[place].visits[visit].each_ma.len() as f64
    }

    /// Returns the covariance from stand and meter.
    fn known(&self, place: usize, visit: usize) -> Matrix2<f64> {
        self.returns[place] + self.rounding + self.of_noise(place, visit)
    }

    /// Returns the covariance with the gyro's noise from visit to visit.
    pub(crate) fn with_noise(&self, place: usize, visit: usize, deg_per_h: f64) -> Matrix2<f64> {
        self.known(place, visit) + Matrix2::from_diagonal_element(deg_per_h * deg_per_h)
    }
}

/// Scatter of rows and visits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Observed {
    pub(crate) rows: Option<RowScatter>,
    pub(crate) visits: Option<Scatter>,
    pub(crate) turn_ons: Option<Scatter>,
}
