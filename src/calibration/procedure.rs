//! One calibration: every method asked for, its uncertainty, its fit.

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

/// What is asked of a calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Which methods.
    pub methods: Vec<Method>,
    /// When successive approximation stops.
    pub stop_rule: StopRule,
    /// Whether least squares also fits the anisoelastic coefficient of (2).
    pub anisoelasticity: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { methods: Method::ALL.to_vec(), stop_rule: StopRule::default(), anisoelasticity: false }
    }
}

/// Calibrates: currents `readings` at `setup`, with the methods of `options`.
///
/// # Errors
/// [`NoLeastSquares`] when the readings do not determine a gyro: then no method's result would mean anything.
/// What a single method cannot do is in [`Calibration::refused`].
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

/// A calibration's answer to small changes of everything that enters it.
#[derive(Debug, Clone)]
pub(crate) struct Linearised {
    /// The best fit, which is where derivatives are taken.
    pub(crate) fit: Fit,
    /// The method's own result: the fit's, or the closed solution of the readings, to which iteration leads too.
    pub(crate) found: Unknowns,
    /// How often every position was read.
    pub(crate) repeats: Repeats,
    /// L: parameters × misclosures (two a position). L F is the spread of the parameters.
    pub(crate) response: DMatrix<f64>,
}

/// What budgets and Monte Carlo start from: the fit of [`calibrate`], and the response of `method` there.
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

/// Mean currents as a fit takes them.
#[derive(Debug, Clone)]
pub(crate) struct Data {
    /// Means (J_x, J_y), in the order of the coefficients.
    pub(crate) currents_ma: Vec<Vector2<f64>>,
    /// How many visits and readings each is the mean of, and how much these scatter.
    pub(crate) repeats: Repeats,
}

impl Data {
    pub(crate) fn new(setup: &Setup, readings: &Readings) -> Self {
        Self { currents_ma: readings.means_ma(), repeats: Repeats::stated(setup, readings) }
    }

    /// Takes in what repeated readings say of themselves, and fits again where that is not what was stated.
    fn observe(&mut self, setup: &Setup, readings: &Readings, fit: &mut Fit) -> Result<Observed, NoLeastSquares> {
        let stated = self.repeats.clone();
        let observed = self.repeats.observe(setup, readings, fit);
        if self.repeats != stated {
            *fit = self.fit(setup, false)?;
        }
        Ok(observed)
    }

    /// Without one position.
    pub(crate) fn without(&self, place: usize) -> Self {
        let mut rest = self.clone();
        rest.currents_ma.remove(place);
        rest.repeats.shares.remove(place);
        rest
    }

    /// Two positions exchanged.
    pub(crate) fn exchanged(&self, one: usize, other: usize) -> Self {
        let mut exchanged = self.clone();
        exchanged.currents_ma.swap(one, other);
        exchanged.repeats.shares.swap(one, other);
        exchanged
    }

    /// The weighted fit at `setup`.
    pub(crate) fn fit(&self, setup: &Setup, anisoelasticity: bool) -> Result<Fit, NoLeastSquares> {
        Fit::new(setup.coefficients(), &self.currents_ma, anisoelasticity, |place, unknowns, current| {
            Sensitivity::new(setup, unknowns).own_covariance(place, current, &self.repeats)
        })
    }
}

/// A value in units of its standard uncertainty; 0 where rounding is all that it can be.
fn in_units(value: f64, u: f64) -> f64 {
    if u > 1e-12 { value / u } else { 0.0 }
}

/// All that methods share.
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

    /// A result of one of the paper's methods. Both have the closed solution's uncertainty: it is the fixed point of
    /// the other, whose remainder is stated apart.
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

    /// Differences to least squares over their standard uncertainty.
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
