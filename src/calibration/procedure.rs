//! The whole calibration: every requested method with its uncertainty and its fit.

use super::analytic::{self, AnalyticMap, AnalyticSolution};
use super::chi_square::chi_square;
use super::data::{Data, Observation};
use super::drift::drift_can_be_fitted;
use super::finding::{self, by_type::by_size, visits};
use super::iterative::{self, IterativeSolution, NoIterativeSolution, StopRule};
use super::least_squares::Fit;
use super::propagation::{Propagation, covariance, standard_deviations};
use super::result::{Cycle, Drift, GMatrix, ModelTest};
use super::unknowns::Unknowns;
use super::{
    Calibration, ChiSquare, Iteration, Method, MethodRefusal, MethodResult, Model, NoAnalyticSolution, NoLeastSquares,
    Options, Parameter, Readings, Residual, Setup,
};
use crate::gyro::{GyroParameters, GyroType};
use nalgebra::{DMatrix, Matrix2, Matrix2x3, Vector2};

/// Calibrates the gyro whose currents are `readings` with the requested methods.
///
/// # Errors
/// Returns [`NoLeastSquares`] if the readings are for other positions or do not determine the parameters of the model; the
/// results of other methods would then be meaningless, or answer another question. A refusal of one of the paper's methods
/// is in [`Calibration::refused`].
pub fn calibrate(setup: &Setup, readings: &Readings, options: &Options) -> Result<Calibration, NoLeastSquares> {
    let digits = readings.recorded.digits(&setup.uncertainty().meter);
    let setup = &*setup.of_readings(readings);
    let indices = readings.positions().iter().map(|position| position.index);
    if !indices.eq(setup.coefficients().positions.iter().map(|at| at.index)) {
        return Err(NoLeastSquares::OtherPositions);
    }
    let possible = drift_can_be_fitted(setup, readings);
    if options.drift {
        possible.clone()?;
    }
    let (observation, explained) = visits::observe(setup, readings, options.model, options.drift)?;
    let Observation { data, fit, seen, .. } = &observation;
    let evaluation = Evaluation::new(Propagation::new(setup, data, fit));
    let (causes, consistent) =
        finding::all(setup, readings, (&observation, &explained), options, &evaluation.chi_square);
    let mut calibration = Calibration {
        results: Vec::new(),
        refused: Vec::new(),
        digits,
        scatter: seen.visits,
        row_scatter: seen.rows,
        turn_on_scatter: seen.turn_ons,
        visit_noise: data.repeats.visit,
        turn_on_noise: data.repeats.turn_on,
        drift_or_noise: possible == Err(NoLeastSquares::DriftOrNoise),
        settled: fit.settled,
        consistent,
        causes,
    };
    let closed = options.model != Model::General && !options.drift && data.offsets.are_balanced();
    let paper = if fit.of == Model::Paper { None } else { Some(data.fit(setup, Model::Paper)?) };
    let paper = paper.as_ref().map(|paper| Evaluation::new(Propagation::new(setup, data, paper)));
    let of_the_paper = paper.as_ref().unwrap_or(&evaluation);
    let of_closed = of_the_paper.closed();
    for &method in &options.methods {
        let result = match method {
            Method::Analytic | Method::Iterative if !closed => Err(MethodRefusal::NotThisModel),
            Method::Analytic => of_the_paper.analytic(of_closed.as_ref()).map_err(MethodRefusal::from),
            Method::Iterative => of_the_paper.iterative(of_closed.as_ref(), &options.stop_rule),
            Method::LeastSquares => {
                let model_test =
                    paper.as_ref().and_then(|paper| ModelTest::new(&paper.chi_square, &evaluation.chi_square));
                Ok(MethodResult { model_test, ..evaluation.least_squares() })
            }
        };
        match result {
            Ok(result) => calibration.results.push(result),
            Err(refusal) => calibration.refused.push((method, refusal)),
        }
    }
    let usual = GyroType::gvk_6().nominal.to_model();
    let valid = calibration.adopted().filter(|_| calibration.fits());
    let range = valid.map_or_else(Vec::new, |found| by_size(&found.parameters, &usual));
    calibration.with_words(range);
    Ok(calibration)
}

/// First-order response of a calibration to small changes of all its inputs.
#[derive(Debug, Clone)]
pub(crate) struct Linearised {
    /// Weighted fit at which the derivatives are taken.
    pub(crate) fit: Fit,
    /// Result of the method: that of the fit, or the analytic solution, to which the iterative method converges.
    pub(crate) found: Unknowns,
    /// Mean currents with their repeats and offsets.
    pub(crate) data: Data,
    /// L: response of the parameters to the misclosures (parameters × misclosures, two per position). L F is the spread
    /// of the parameters.
    pub(crate) response: DMatrix<f64>,
}

/// Returns the fit of [`calibrate`] and the response of `method` there, from which budgets and Monte Carlo start.
pub(crate) fn linearise(
    setup: &Setup,
    readings: &Readings,
    method: Method,
    options: &Options,
) -> Result<Linearised, MethodRefusal> {
    let setup = &*setup.of_readings(readings);
    let model = if method == Method::LeastSquares { options.model } else { Model::Paper };
    let (Observation { data, fit, .. }, _) = visits::observe(setup, readings, model, options.drift)?;
    let propagation = Propagation::new(setup, &data, &fit);
    let (found, response) = match method {
        Method::LeastSquares => (fit.unknowns, propagation.response_of_least_squares()),
        Method::Analytic | Method::Iterative => {
            let parameters = analytic::solve(setup.coefficients(), &data.currents_ma)?.parameters;
            let map = AnalyticMap::new(setup.coefficients(), &fit.currents_ma)?;
            let rows = propagation.causes.nrows();
            (Unknowns::of(parameters), propagation.analytic(&map, &DMatrix::identity(rows, rows)).0)
        }
    };
    Ok(Linearised { fit, found, data, response })
}

/// Returns a value in units of its standard uncertainty, or 0 if it can only be rounding.
fn in_units(value: f64, u: f64) -> f64 {
    if u > 1e-12 { value / u } else { 0.0 }
}

struct Evaluation<'a> {
    propagation: Propagation<'a>,
    /// L F of least squares (parameters × causes).
    spread: DMatrix<f64>,
    chi_square: ChiSquare,
}

/// Uncertainties of the paper's two methods. Both have those of the analytic solution, because it is the fixed point of
/// the iteration.
struct Closed {
    /// Covariance of the parameters, 8×8.
    covariance: DMatrix<f64>,
    /// Standard uncertainties of the elements of ω_n, °/(h·g), 2×2.
    omega_n_deg_per_h_per_g: Matrix2<f64>,
    /// Standard uncertainties of the residuals, °/h.
    residuals_deg_per_h: Vec<f64>,
    /// Standard uncertainties of the differences of the parameters from least squares.
    from_least_squares: Vec<f64>,
}

impl<'a> Evaluation<'a> {
    fn new(propagation: Propagation<'a>) -> Self {
        let (spread, chi_square) = (propagation.least_squares(), chi_square(&propagation));
        Self { propagation, spread, chi_square }
    }

    /// Returns the uncertainties of the paper's methods, or `None` if there is no analytic solution.
    fn closed(&self) -> Option<Closed> {
        let Propagation { setup, fit, .. } = self.propagation;
        let map = AnalyticMap::new(setup.coefficients(), &fit.currents_ma).ok()?;
        let (spread, of_omega_n) = self.propagation.analytic(&map, &self.propagation.causes);
        Some(Closed {
            covariance: covariance(&spread),
            omega_n_deg_per_h_per_g: Matrix2::from_row_slice(&standard_deviations(&of_omega_n)),
            residuals_deg_per_h: self.propagation.of_residuals(&spread),
            from_least_squares: standard_deviations(&(&spread - self.spread.rows(0, spread.nrows()))),
        })
    }

    fn least_squares(&self) -> MethodResult {
        let Propagation { data, fit, .. } = self.propagation;
        let (unknowns, model) = (&fit.unknowns, fit.of);
        let parameters = unknowns.parameters;
        let anisoelasticity = unknowns.anisoelasticity_deg_per_h_per_g2;
        let all = covariance(&self.spread);
        let covariance = all.view((0, 0), (model.columns(), model.columns())).into_owned();
        let u = |p| model.column(p).map_or(0.0, |column| covariance[(column, column)].sqrt());
        let [u_g, u_k] = [Parameter::OmegaG, Parameter::OmegaK].map(u);
        let g_matrix = (model == Model::General).then(|| GMatrix {
            deg_per_h_per_g: unknowns.g_matrix_deg_per_h_per_g(),
            standard_uncertainty_deg_per_h_per_g: Matrix2x3::from_fn(|row, column| {
                let place = 6 + 3 * row + column;
                covariance[(place, place)].sqrt()
            }),
        });
        let drift = fit.drift(&data.offsets).map(|deg_per_h_per_h| {
            let place = all.nrows() - 2;
            let u = [0, 1].map(|axis| all[(place + axis, place + axis)].sqrt());
            Drift { deg_per_h_per_h, standard_uncertainty_deg_per_h_per_h: u.into() }
        });
        MethodResult {
            method: Method::LeastSquares,
            model,
            parameters,
            omega_n_deg_per_h_per_g: parameters.omega_n_deg_per_h_per_g(),
            anisoelasticity_deg_per_h_per_g2: (model == Model::Anisoelastic).then_some(anisoelasticity),
            g_matrix,
            model_test: None,
            drift,
            cycles: self.cycles(&parameters),
            iteration: None,
            residuals: self.residuals(unknowns, &self.propagation.of_residuals(&self.spread)),
            covariance,
            omega_n_uncertainty_deg_per_h_per_g: Matrix2::new(u_g, u_k, u_k, u_g),
            from_least_squares: None,
            chi_square: self.chi_square,
        }
    }

    /// Returns ω_0 of each turn-on, whose mean is that of `parameters`.
    fn cycles(&self, parameters: &GyroParameters) -> Vec<Cycle> {
        let Propagation { data, fit, .. } = self.propagation;
        let (offsets, omega0) = (&data.offsets, parameters.omega0_deg_per_h);
        let turn_ons = offsets.turn_ons();
        let each = turn_ons.row_iter().zip(&offsets.cycles).map(|(row, &cycle)| {
            let bias = row.iter().zip(fit.changing.chunks_exact(2));
            let bias = bias.fold(Vector2::zeros(), |sum, (a, x)| sum + Vector2::new(x[0], x[1]) * *a);
            Cycle { cycle, omega0_deg_per_h: (omega0 + bias).into() }
        });
        each.collect()
    }

    fn analytic(&self, closed: Option<&Closed>) -> Result<MethodResult, NoAnalyticSolution> {
        let Propagation { setup, data, .. } = self.propagation;
        let found = analytic::solve(setup.coefficients(), &data.currents_ma)?;
        let closed = closed.ok_or(NoAnalyticSolution::SingularCurrents)?;
        Ok(self.of_the_paper(Method::Analytic, found, None, closed))
    }

    fn iterative(&self, closed: Option<&Closed>, rule: &StopRule) -> Result<MethodResult, MethodRefusal> {
        let Propagation { setup, data, .. } = self.propagation;
        let IterativeSolution { parameters, omega_n_deg_per_h_per_g, iteration, .. } =
            iterative::solve(setup.coefficients(), &data.currents_ma, rule)?;
        let closed = closed.ok_or(NoIterativeSolution::SingularCurrents)?;
        let found = AnalyticSolution { parameters, omega_n_deg_per_h_per_g };
        Ok(self.of_the_paper(Method::Iterative, found, Some(iteration), closed))
    }

    /// Returns the result of one of the paper's methods. The remainder of the iteration is stated separately.
    fn of_the_paper(
        &self,
        method: Method,
        AnalyticSolution { parameters, omega_n_deg_per_h_per_g }: AnalyticSolution,
        iteration: Option<Iteration>,
        closed: &Closed,
    ) -> MethodResult {
        let (found, answer) = (parameters.to_vector(), self.propagation.fit.unknowns.parameters.to_vector());
        let difference = |place| in_units(found[place] - answer[place], closed.from_least_squares[place]);
        MethodResult {
            method,
            model: Model::Paper,
            parameters,
            omega_n_deg_per_h_per_g,
            anisoelasticity_deg_per_h_per_g2: None,
            g_matrix: None,
            model_test: None,
            drift: None,
            cycles: self.cycles(&parameters),
            iteration,
            residuals: self.residuals(&Unknowns::of(parameters), &closed.residuals_deg_per_h),
            covariance: closed.covariance.clone(),
            omega_n_uncertainty_deg_per_h_per_g: closed.omega_n_deg_per_h_per_g,
            from_least_squares: Some(std::array::from_fn(difference)),
            chi_square: self.chi_square,
        }
    }

    /// Returns the residuals with their standard uncertainties `u`, °/h.
    fn residuals(&self, unknowns: &Unknowns, u: &[f64]) -> Vec<Residual> {
        let Propagation { data, fit, .. } = self.propagation;
        let each = fit.positions.iter().zip(&data.currents_ma).zip(u.chunks_exact(2));
        each.map(|((at, current), u)| {
            let residual = unknowns.misclosure(at, current);
            Residual {
                index: at.index,
                residual_deg_per_h: residual,
                standard_uncertainty_deg_per_h: Vector2::new(u[0], u[1]),
                normalised: Vector2::new(in_units(residual.x, u[0]), in_units(residual.y, u[1])),
            }
        })
        .collect()
    }
}
