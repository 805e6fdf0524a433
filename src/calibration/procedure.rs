//! The whole calibration: every requested method with its uncertainty and its fit.

use super::analytic::{self, AnalyticMap, NoAnalyticSolution};
use super::diagnosis;
use super::inputs::Setup;
use super::iterative::{self, NoIterativeSolution, StopRule};
use super::least_squares::{Fit, NoLeastSquares};
use super::parameter::Parameter;
use super::propagation::{Propagation, chi_square, covariance, standard_deviations};
use super::readings::Readings;
use super::result::{Calibration, ChiSquare, Iteration, Method, MethodRefusal, MethodResult, Residual};
use super::scatter::{Observed, Repeats};
use super::sensitivity::Sensitivity;
use super::unknowns::Unknowns;
use crate::gyro::GyroParameters;
use nalgebra::{DMatrix, Matrix2, Vector2};

/// Options of a calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Requested methods, in the order of the results.
    pub methods: Vec<Method>,
    /// Stop rule of the iterative method.
    pub stop_rule: StopRule,
    /// `true` if least squares also fits the anisoelastic coefficient of eq. (2).
    pub anisoelasticity: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { methods: Method::ALL.to_vec(), stop_rule: StopRule::default(), anisoelasticity: false }
    }
}

/// Calibrates the gyro whose currents are `readings` with the requested methods.
///
/// # Errors
/// Returns [`NoLeastSquares`] if the readings are for other positions or do not determine a gyro; the results of other
/// methods would then be meaningless. A refusal of a single method is in [`Calibration::refused`].
pub fn calibrate(setup: &Setup, readings: &Readings, options: &Options) -> Result<Calibration, NoLeastSquares> {
    let indices = readings.positions().iter().map(|position| position.index);
    if !indices.eq(setup.coefficients().positions.iter().map(|at| at.index)) {
        return Err(NoLeastSquares::OtherPositions);
    }
    let mut data = Data::new(setup, readings);
    let mut fit = data.fit(setup, false)?;
    let Observed { rows, visits } = data.observe(setup, readings, &mut fit)?;
    let evaluation = Evaluation::new(setup, &data, &fit);
    let hint = diagnosis::hint(setup, &data, &evaluation.chi_square);
    let settled = fit.settled;
    let (results, refused) = (Vec::new(), Vec::new());
    let mut calibration = Calibration { results, refused, scatter: visits, row_scatter: rows, settled, hint };
    for &method in &options.methods {
        let result = match method {
            Method::Analytic => evaluation.analytic().map_err(MethodRefusal::from),
            Method::Iterative => evaluation.iterative(&options.stop_rule),
            Method::LeastSquares if options.anisoelasticity => data
                .fit(setup, true)
                .map(|fit| Evaluation::new(setup, &data, &fit).least_squares())
                .map_err(MethodRefusal::from),
            Method::LeastSquares => Ok(evaluation.least_squares()),
        };
        match result {
            Ok(result) => calibration.results.push(result),
            Err(refusal) => calibration.refused.push((method, refusal)),
        }
    }
    Ok(calibration)
}

/// First-order response of a calibration to small changes of all its inputs.
#[derive(Debug, Clone)]
pub(crate) struct Linearised {
    /// Weighted fit at which the derivatives are taken.
    pub(crate) fit: Fit,
    /// Result of the method: that of the fit, or the analytic solution, to which the iterative method converges.
    pub(crate) found: Unknowns,
    /// Numbers of visits and readings of each position.
    pub(crate) repeats: Repeats,
    /// L: response of the parameters to the misclosures (parameters × misclosures, two per position). L F is the spread
    /// of the parameters.
    pub(crate) response: DMatrix<f64>,
}

/// Returns the fit of [`calibrate`] and the response of `method` there, from which budgets and Monte Carlo start.
pub(crate) fn linearise(
    setup: &Setup,
    readings: &Readings,
    method: Method,
    anisoelasticity: bool,
) -> Result<Linearised, MethodRefusal> {
    let mut data = Data::new(setup, readings);
    let anisoelasticity = anisoelasticity && method == Method::LeastSquares;
    let mut fit = data.fit(setup, false)?;
    data.observe(setup, readings, &mut fit)?;
    if anisoelasticity {
        fit = data.fit(setup, true)?;
    }
    let propagation = Propagation::new(setup, &fit);
    let (found, response) = match method {
        Method::LeastSquares => (fit.unknowns, propagation.response_of_least_squares()),
        Method::Analytic | Method::Iterative => {
            let parameters = analytic::solve(setup.coefficients(), &data.currents_ma)?.parameters;
            let map = AnalyticMap::new(setup.coefficients(), &fit.currents_ma);
            let map = map.ok_or(match setup.coefficients().matrices {
                Some(_) => NoAnalyticSolution::SingularCurrents,
                None => NoAnalyticSolution::EightPositionsMissing,
            })?;
            let found = Unknowns { parameters, anisoelasticity_deg_per_h_per_g2: 0.0 };
            (found, propagation.response_of_analytic(&map))
        }
    };
    Ok(Linearised { found, repeats: data.repeats, response, fit })
}

/// Mean currents of all positions, the input of a fit.
#[derive(Debug, Clone)]
pub(crate) struct Data {
    /// Mean currents (J_x, J_y), mA, in the order of the coefficients.
    pub(crate) currents_ma: Vec<Vector2<f64>>,
    /// Numbers of visits and readings behind each mean, and their scatter.
    pub(crate) repeats: Repeats,
}

impl Data {
    pub(crate) fn new(setup: &Setup, readings: &Readings) -> Self {
        Self { currents_ma: readings.means_ma(), repeats: Repeats::stated(setup, readings) }
    }

    /// Updates the errors of visits and readings from their scatter, and fits again if they differ from those stated.
    fn observe(&mut self, setup: &Setup, readings: &Readings, fit: &mut Fit) -> Result<Observed, NoLeastSquares> {
        let stated = self.repeats.clone();
        let observed = self.repeats.observe(setup, readings, fit);
        if self.repeats != stated {
            *fit = self.fit(setup, false)?;
        }
        Ok(observed)
    }

    /// Returns a copy without position `place`.
    pub(crate) fn without(&self, place: usize) -> Self {
        let mut rest = self.clone();
        rest.currents_ma.remove(place);
        rest.repeats.shares.remove(place);
        rest
    }

    /// Returns a copy with the readings of two positions exchanged.
    pub(crate) fn exchanged(&self, one: usize, other: usize) -> Self {
        let mut exchanged = self.clone();
        exchanged.currents_ma.swap(one, other);
        exchanged.repeats.shares.swap(one, other);
        exchanged
    }

    /// Returns the weighted fit at `setup`.
    pub(crate) fn fit(&self, setup: &Setup, anisoelasticity: bool) -> Result<Fit, NoLeastSquares> {
        Fit::new(setup.coefficients(), &self.currents_ma, anisoelasticity, |place, unknowns, current| {
            Sensitivity::new(setup, unknowns).own_covariance(place, current, &self.repeats)
        })
    }
}

/// Returns a value in units of its standard uncertainty, or 0 if it can only be rounding.
fn in_units(value: f64, u: f64) -> f64 {
    if u > 1e-12 { value / u } else { 0.0 }
}

/// Quantities common to all methods.
struct Evaluation<'a> {
    setup: &'a Setup,
    currents_ma: &'a [Vector2<f64>],
    fit: &'a Fit,
    propagation: Propagation<'a>,
    chi_square: ChiSquare,
}

impl<'a> Evaluation<'a> {
    fn new(setup: &'a Setup, data: &'a Data, fit: &'a Fit) -> Self {
        let propagation = Propagation::new(setup, fit);
        let chi_square = ChiSquare::new(chi_square(setup, fit, data));
        Self { setup, currents_ma: &data.currents_ma, fit, propagation, chi_square }
    }

    fn least_squares(&self) -> MethodResult {
        let solution = self.fit.solution();
        let spread = self.propagation.least_squares();
        let covariance = covariance(&spread);
        let [u_g, u_k] = [Parameter::OmegaG, Parameter::OmegaK].map(|p| covariance[(p.place(), p.place())].sqrt());
        MethodResult {
            method: Method::LeastSquares,
            parameters: solution.parameters,
            omega_n_deg_per_h_per_g: solution.parameters.omega_n_deg_per_h_per_g(),
            anisoelasticity_deg_per_h_per_g2: solution.anisoelasticity_deg_per_h_per_g2,
            iteration: None,
            residuals: self.residuals(&self.fit.unknowns, &spread),
            covariance,
            omega_n_uncertainty_deg_per_h_per_g: Matrix2::new(u_g, u_k, u_k, u_g),
            from_least_squares: None,
            chi_square: self.chi_square,
        }
    }

    fn analytic(&self) -> Result<MethodResult, NoAnalyticSolution> {
        let solution = analytic::solve(self.setup.coefficients(), self.currents_ma)?;
        let refusal = NoAnalyticSolution::SingularCurrents;
        let (parameters, omega_n) = (solution.parameters, solution.omega_n_deg_per_h_per_g);
        self.of_the_paper(Method::Analytic, parameters, omega_n, None).ok_or(refusal)
    }

    fn iterative(&self, rule: &StopRule) -> Result<MethodResult, MethodRefusal> {
        let coefficients = self.setup.coefficients();
        let found = iterative::solve(coefficients, self.currents_ma, rule)?;
        let predicted_steps = iterative::Plan::new(coefficients, self.currents_ma)?.predicted_steps(rule);
        let iteration = Iteration {
            stop_rule: *rule,
            steps: found.steps,
            changes: found.changes,
            predicted_steps,
            spectral_radius: found.spectral_radius,
            remainder_k_deg_per_h_per_ma: found.remainder_k_deg_per_h_per_ma,
            remainder_omega_n_deg_per_h_per_g: found.remainder_omega_n_deg_per_h_per_g,
        };
        let (parameters, omega_n) = (found.parameters, found.omega_n_deg_per_h_per_g);
        let result = self.of_the_paper(Method::Iterative, parameters, omega_n, Some(iteration));
        result.ok_or(NoIterativeSolution::SingularCurrents.into())
    }

    /// Returns the result of one of the paper's methods, or `None` if there is no analytic solution. Both methods have
    /// the uncertainty of the analytic solution, because it is the fixed point of the iteration. The remainder of the
    /// iteration is stated separately.
    fn of_the_paper(
        &self,
        method: Method,
        parameters: GyroParameters,
        omega_n: Matrix2<f64>,
        iteration: Option<Iteration>,
    ) -> Option<MethodResult> {
        let map = AnalyticMap::new(self.setup.coefficients(), &self.fit.currents_ma)?;
        let (spread, spread_omega_n) = self.propagation.analytic(&map);
        let u = standard_deviations(&spread_omega_n);
        let unknowns = Unknowns { parameters, anisoelasticity_deg_per_h_per_g2: 0.0 };
        Some(MethodResult {
            method,
            parameters,
            omega_n_deg_per_h_per_g: omega_n,
            anisoelasticity_deg_per_h_per_g2: None,
            iteration,
            residuals: self.residuals(&unknowns, &spread),
            covariance: covariance(&spread),
            omega_n_uncertainty_deg_per_h_per_g: Matrix2::from_row_slice(&u),
            from_least_squares: Some(self.difference_to_least_squares(&parameters, &spread)),
            chi_square: self.chi_square,
        })
    }

    /// Returns the differences from least squares divided by their standard uncertainties.
    fn difference_to_least_squares(&self, parameters: &GyroParameters, spread: &DMatrix<f64>) -> [f64; 8] {
        let u = standard_deviations(&(spread - self.propagation.least_squares()));
        let (found, answer) = (parameters.to_vector(), self.fit.unknowns.parameters.to_vector());
        std::array::from_fn(|place| in_units(found[place] - answer[place], u[place]))
    }

    fn residuals(&self, unknowns: &Unknowns, spread: &DMatrix<f64>) -> Vec<Residual> {
        let u = self.propagation.of_residuals(spread);
        let each = self.setup.coefficients().positions.iter().zip(self.currents_ma).zip(u.chunks_exact(2));
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
