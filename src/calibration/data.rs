//! Mean currents of all positions with their errors as stated or observed, and fits to them.

use super::inputs::{Setup, at_places};
use super::least_squares::{Fit, NoLeastSquares, Problem, SETTLED};
use super::offsets::{Differences, Offsets};
use super::readings::Readings;
use super::repeats::Repeats;
use super::scatter::Observed;
use super::sensitivity::Sensitivity;
use super::unknowns::{Model, Unknowns};
use nalgebra::{Matrix2, Vector2};

/// Number of repeated fits with differences of visits after which their change no longer matters; two or three do.
const MOST_OBSERVATIONS: usize = 8;

/// Relative change of turn-ons and drift from one fit to the next that does not matter.
const SAME_OFFSET: f64 = 1e-12;

/// Mean currents of all positions, the input of a fit.
#[derive(Debug, Clone)]
pub(crate) struct Data {
    /// Mean currents (J_x, J_y), mA, in the order of the coefficients.
    pub(crate) currents_ma: Vec<Vector2<f64>>,
    /// Numbers of visits and readings behind each mean, and their scatter.
    pub(crate) repeats: Repeats,
    /// Drift that changes during the run.
    pub(crate) offsets: Offsets,
}

/// The fit of a model, with the errors of visits, readings and turn-ons as observed.
#[derive(Debug, Clone)]
pub(crate) struct Observation {
    pub(crate) data: Data,
    pub(crate) fit: Fit,
    pub(crate) seen: Observed,
    /// Differences between the visits to each position; `None` if no position has two.
    pub(crate) differences: Option<Differences>,
}

impl Observation {
    /// Fits with the errors as stated, updates them from their scatter, and fits again while that changes anything. The pair
    /// says whether a drift in time is fitted, and whether a K of each turn-on is.
    pub(crate) fn plain(
        setup: &Setup,
        readings: &Readings,
        model: Model,
        changing: (bool, bool),
    ) -> Result<Self, NoLeastSquares> {
        let mut data = Data::new(setup, readings);
        let mut fit = data.fit(setup, model)?;
        data.offsets = Offsets::new(readings, changing);
        let stated = data.repeats.clone();
        let differences = Differences::new(readings, &data.offsets);
        let mut seen = data.repeats.observe(setup, readings, differences.as_ref(), &mut data.offsets, &fit);
        if data.repeats != stated || data.offsets.columns() > 0 {
            fit = data.problem(setup, model).solve_again(&fit)?;
        }
        // Differences of visits depend on K, which depends on them.
        for _ in 0..MOST_OBSERVATIONS {
            if data.offsets.columns() == 0 || data.offsets.rows.nrows() == 0 {
                break;
            }
            let before = fit.changing.clone();
            data.repeats = stated.clone();
            seen = data.repeats.observe(setup, readings, differences.as_ref(), &mut data.offsets, &fit);
            fit = data.problem(setup, model).solve_again(&fit)?;
            let u = fit.own_uncertainties_of_offsets();
            let close = |((now, before), u): ((&f64, &f64), f64)| {
                (now - before).abs() <= (SAME_OFFSET * before.abs()).max(SETTLED * u)
            };
            if fit.changing.iter().zip(&before).zip(u).all(close) {
                break;
            }
        }
        seen.turn_ons = data.repeats.observe_turn_ons(&data.offsets, &fit);
        data.repeats.observe_scale(&data.offsets, &fit);
        Ok(Self { data, fit, seen, differences })
    }
}

impl Data {
    pub(crate) fn new(setup: &Setup, readings: &Readings) -> Self {
        let (currents_ma, repeats) = (readings.means_ma(), Repeats::stated(setup, readings));
        Self { currents_ma, repeats, offsets: Offsets::default() }
    }

    /// Returns a copy with the readings of the positions `places` in their order, instead of those of the setup.
    pub(crate) fn at(&self, places: &[usize]) -> Self {
        let (mut repeats, mut offsets) = (self.repeats.clone(), self.offsets.clone());
        repeats.shares = at_places(&repeats.shares, places);
        offsets.means = at_places(&offsets.means, places);
        Self { currents_ma: at_places(&self.currents_ma, places), repeats, offsets }
    }

    pub(crate) fn fit(&self, setup: &Setup, model: Model) -> Result<Fit, NoLeastSquares> {
        self.problem(setup, model).solve()
    }

    /// Returns the fit if it settles, because some gyro could give the readings.
    pub(crate) fn settled(&self, setup: &Setup, model: Model) -> Option<Fit> {
        self.fit(setup, model).ok().filter(|fit| fit.settled)
    }

    /// Returns the fit if it settles soon: see [`Problem::solve_soon`].
    pub(crate) fn settled_soon(&self, setup: &Setup, model: Model) -> Option<Fit> {
        self.problem(setup, model).solve_soon()
    }

    fn problem<'a>(
        &'a self,
        setup: &'a Setup,
        model: Model,
    ) -> Problem<'a, impl Fn(usize, &Unknowns, &Vector2<f64>) -> Matrix2<f64>> {
        let own_covariance = |place, unknowns: &Unknowns, current: &Vector2<f64>| {
            Sensitivity::new(setup, unknowns).own_covariance(place, current, &self.repeats)
        };
        let (coefficients, currents_ma, offsets) = (setup.coefficients(), &self.currents_ma, &self.offsets);
        Problem { coefficients, currents_ma, model, offsets, own_covariance }
    }
}
