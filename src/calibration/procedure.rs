//! The whole calibration: every requested method with its uncertainty and its fit.

use super::analytic::{self, AnalyticMap, AnalyticSolution};
use super::chi_square::chi_square;
use super::data::Observation;
use super::document::result::{
    ChiSquareDocument, NoiseDocument, ResidualDocument, ResultDocument, UncertaintyDocument, rows,
};
use super::drift::drift_can_be_fitted;
use super::finding::{self, by_type::by_size, visits};
use super::iterative::{self, NoIterativeSolution, StopRule};
use super::propagation::{Propagation, covariance, standard_deviations};
use super::result::{Cycle, ModelTest};
use super::unknowns::Unknowns;
use super::{
    Calibration, ChiSquare, Method, MethodRefusal, MethodResult, Model, NoAnalyticSolution, NoLeastSquares, Parameter,
    Readings, Setup,
};
use crate::coefficients::PositionIndex;
use crate::gyro::{GyroParameters, GyroType};
use nalgebra::{DMatrix, Matrix2, Vector2};

/// Options of a calibration.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// Requested methods, in the order of the results.
    pub methods: Vec<Method>,
    /// Stop rule of the iterative method.
    pub stop_rule: StopRule,
    /// Model of the g-sensitive drift that least squares fits; the paper's methods have the paper's.
    pub model: Model,
    /// `true` if least squares also fits a linear drift of ω_0 in time.
    pub drift: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { methods: Method::ALL.to_vec(), stop_rule: StopRule::default(), model: Model::Paper, drift: false }
    }
}

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
    let closed = options.model != Model::General && !options.drift && data.offsets.are_balanced();
    let paper = if fit.of == Model::Paper { None } else { Some(data.fit(setup, Model::Paper)?) };
    let paper = paper.as_ref().map(|paper| Evaluation::new(Propagation::new(setup, data, paper)));
    let of_the_paper = paper.as_ref().unwrap_or(&evaluation);
    let of_closed = of_the_paper.closed();
    let (mut results, mut refused) = (Vec::new(), Vec::new());
    for &method in &options.methods {
        let result = match method {
            Method::Analytic | Method::Iterative if !closed => Err(MethodRefusal::NotThisModel),
            Method::Analytic => of_the_paper.analytic(of_closed.as_ref()).map_err(MethodRefusal::from),
            Method::Iterative => of_the_paper.iterative(of_closed.as_ref(), &options.stop_rule),
            Method::LeastSquares => Ok(evaluation.least_squares(paper.as_ref().map(|paper| &paper.chi_square))),
        };
        match result {
            Ok(result) => results.push(result),
            Err(refusal) => refused.push((method, refusal)),
        }
    }
    let mut calibration = Calibration {
        results,
        refused,
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
        observation,
    };
    let usual = GyroType::gvk_6().nominal.to_model();
    let valid = calibration.adopted().filter(|_| calibration.fits());
    let range = valid.map_or_else(Vec::new, |found| by_size(&found.parameters, &usual));
    calibration.with_words(range);
    Ok(calibration)
}

/// Returns the result of least squares for readings that have no cause to look for, because they are exact; `None` if they
/// do not determine the parameters.
pub(super) fn without_causes(setup: &Setup, readings: &Readings, options: &Options) -> Option<MethodResult> {
    let setup = &*setup.of_readings(readings);
    let Observation { data, fit, .. } =
        Observation::plain(setup, readings, options.model, (options.drift, false)).ok()?;
    Some(Evaluation::new(Propagation::new(setup, &data, &fit)).least_squares(None))
}

/// Returns the fit of [`calibrate`] with the model of `method`, from which budgets and Monte Carlo start.
pub(crate) fn observe(
    setup: &Setup,
    readings: &Readings,
    method: Method,
    options: &Options,
) -> Result<Observation, NoLeastSquares> {
    let (observation, _) =
        visits::observe(&setup.of_readings(readings), readings, method.model(options), options.drift)?;
    Ok(observation)
}

/// Returns the result of a method, for the iterative method the analytic solution to which it converges, and L: the response
/// of the parameters to the misclosures (parameters × misclosures, two per position). L F is the spread of the parameters.
pub(crate) fn response(
    setup: &Setup,
    Observation { data, fit, .. }: &Observation,
    method: Method,
) -> Result<(Unknowns, DMatrix<f64>), NoAnalyticSolution> {
    let propagation = Propagation::new(setup, data, fit);
    if method == Method::LeastSquares {
        return Ok((fit.unknowns, propagation.response_of_least_squares()));
    }
    let parameters = analytic::solve(setup.coefficients(), &data.currents_ma)?.parameters;
    let map = AnalyticMap::new(setup.coefficients(), &fit.currents_ma)?;
    let rows = propagation.causes.nrows();
    Ok((Unknowns::of(parameters), propagation.analytic(&map, &DMatrix::identity(rows, rows)).0))
}

impl Method {
    /// Returns the model that the method fits; the paper's methods have the paper's.
    pub(crate) fn model(self, options: &Options) -> Model {
        if self == Self::LeastSquares { options.model } else { Model::Paper }
    }
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

    /// Returns the result of least squares; `paper` is chi-square with the paper's model, if another one is fitted.
    fn least_squares(&self, paper: Option<&ChiSquare>) -> MethodResult {
        let Propagation { data, fit, .. } = self.propagation;
        let (unknowns, model) = (fit.unknowns, fit.of);
        let all = covariance(&self.spread);
        let u = |place: usize| all[(place, place)].sqrt();
        let of_g = if model == Model::General { [0.0; 2] } else { [6, 7].map(u) };
        let omega_n = [unknowns.parameters.omega_n_deg_per_h_per_g(), Matrix2::new(of_g[0], of_g[1], of_g[1], of_g[0])];
        let covariance = all.view((0, 0), (model.columns(), model.columns())).into_owned();
        let residuals = self.propagation.of_residuals(&self.spread);
        let mut result = self.result(Method::LeastSquares, (model, unknowns), omega_n, covariance, &residuals);
        let document = &mut result.document;
        document.model_test = paper.and_then(|paper| ModelTest::new(paper, &self.chi_square));
        document.drift_deg_per_h_per_h = fit.drift(&data.offsets).map(Into::into);
        document.standard_uncertainty.drift_deg_per_h_per_h =
            document.drift_deg_per_h_per_h.map(|_| [2, 1].map(|from_end| u(all.nrows() - from_end)));
        result
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
        Ok(self.of_the_paper(Method::Analytic, found, closed))
    }

    /// Returns the result of the iterative method. The remainder of the iteration is stated separately.
    fn iterative(&self, closed: Option<&Closed>, rule: &StopRule) -> Result<MethodResult, MethodRefusal> {
        let Propagation { setup, data, .. } = self.propagation;
        let solution = iterative::solve(setup.coefficients(), &data.currents_ma, rule)?;
        let closed = closed.ok_or(NoIterativeSolution::SingularCurrents)?;
        let (parameters, omega_n_deg_per_h_per_g) = (solution.parameters, solution.omega_n_deg_per_h_per_g);
        let found = AnalyticSolution { parameters, omega_n_deg_per_h_per_g };
        let result = self.of_the_paper(Method::Iterative, found, closed);
        let document = ResultDocument {
            iterations: Some(solution.steps),
            stop_rule: Some(*rule),
            changes: Some(solution.changes),
            spectral_radius: Some(solution.spectral_radius),
            remainder_k_deg_per_h_per_ma: Some(rows(&solution.remainder_k_deg_per_h_per_ma)),
            remainder_omega_n_deg_per_h_per_g: Some(rows(&solution.remainder_omega_n_deg_per_h_per_g)),
            ..result.document
        };
        Ok(MethodResult { document, ..result })
    }

    /// Returns the result of one of the paper's methods.
    fn of_the_paper(&self, method: Method, found: AnalyticSolution, closed: &Closed) -> MethodResult {
        let unknowns = Unknowns::of(found.parameters);
        let omega_n = [found.omega_n_deg_per_h_per_g, closed.omega_n_deg_per_h_per_g];
        let of = (Model::Paper, unknowns);
        let mut result = self.result(method, of, omega_n, closed.covariance.clone(), &closed.residuals_deg_per_h);
        let (found, answer) = (found.parameters.to_vector(), self.propagation.fit.unknowns.parameters.to_vector());
        let difference = |place| in_units(found[place] - answer[place], closed.from_least_squares[place]);
        result.document.from_least_squares = Some(std::array::from_fn(difference));
        result
    }

    /// Returns the result of a method, with ω_n and its standard uncertainties, the covariance of the parameters, and the standard
    /// uncertainties of the residuals, °/h.
    fn result(
        &self,
        method: Method,
        (model, unknowns): (Model, Unknowns),
        [omega_n, u_omega_n]: [Matrix2<f64>; 2],
        covariance: DMatrix<f64>,
        u_of_residuals: &[f64],
    ) -> MethodResult {
        let Propagation { data, fit, .. } = self.propagation;
        let parameters = unknowns.parameters;
        let is_general = model == Model::General;
        let value = |parameter| model.column(parameter).map(|_| unknowns.value(parameter));
        let variance = |parameter| model.column(parameter).map(|column| covariance[(column, column)]);
        let u = |parameter| variance(parameter).map(f64::sqrt);
        let [u_kx, u_kxy, u_kyx, u_ky, u_x, u_y, ..] = Parameter::EIGHT.map(|parameter| u(parameter).unwrap_or(0.0));
        let standard_uncertainty = UncertaintyDocument {
            k_deg_per_h_per_ma: [[u_kx, u_kxy], [u_kyx, u_ky]],
            omega0_deg_per_h: [u_x, u_y],
            omega_n_deg_per_h_per_g: (!is_general).then(|| rows(&u_omega_n)),
            omega_g_deg_per_h_per_g: u(Parameter::OmegaG),
            omega_k_deg_per_h_per_g: u(Parameter::OmegaK),
            g_matrix_deg_per_h_per_g: is_general
                .then(|| [0, 1].map(|row| [0, 1, 2].map(|column| u(Parameter::G(row, column)).unwrap_or(0.0)))),
            drift_deg_per_h_per_h: None,
            anisoelasticity_deg_per_h_per_g2: u(Parameter::Anisoelasticity),
        };
        let residuals = fit.positions.iter().zip(&data.currents_ma).zip(u_of_residuals.chunks_exact(2));
        let residuals = residuals.filter(|_| self.chi_square.judges()).map(|((at, current), u)| {
            let (PositionIndex { i, j }, value) = (at.index, unknowns.misclosure(at, current));
            ResidualDocument { i, j, x: value.x, y: value.y, u_x: Some(u[0]), u_y: Some(u[1]) }
        });
        let document = ResultDocument {
            method: method.key().to_owned(),
            model: model.key().to_owned(),
            k_deg_per_h_per_ma: rows(&parameters.k_deg_per_h_per_ma),
            omega0_deg_per_h: parameters.omega0_deg_per_h.into(),
            omega_n_deg_per_h_per_g: (!is_general).then(|| rows(&omega_n)),
            omega_g_deg_per_h_per_g: value(Parameter::OmegaG),
            omega_k_deg_per_h_per_g: value(Parameter::OmegaK),
            g_matrix_deg_per_h_per_g: is_general.then(|| rows(&unknowns.g_matrix_deg_per_h_per_g())),
            cycles: self.cycles(&parameters),
            noise: Some(NoiseDocument::new(&data.repeats)),
            anisoelasticity_deg_per_h_per_g2: value(Parameter::Anisoelasticity),
            standard_uncertainty,
            chi_square: ChiSquareDocument::new(&self.chi_square),
            residuals_deg_per_h: residuals.collect(),
            ..ResultDocument::default()
        };
        MethodResult { method, model, parameters, unknowns, covariance, chi_square: self.chi_square, document }
    }
}
