//! The best positions to certify, or to read on a certified stand: the number of visits to each, their order, and the
//! azimuth of the frame's axis.
//!
//! A reading is one visit to a position. Its errors are those of a calibration by least squares: specification and
//! noise of the meter, noise of the gyro from visit to visit, repeatability and certified angles of the stand. Errors
//! that all positions share do not depend on the choice in this way; [`sensitivity`] computes what they cost and
//! whether the residuals would show them.
//!
//! * `candidates`: positions to choose from, with the information that their visits give.
//! * `criterion`: what a plan is compared by.
//! * `search`: the best numbers of visits, by enumeration or by exchange.
//! * `order`: the order of visits that a drift of ω_0 affects least.
//! * `sensitivity`: errors that all positions share.
//! * `document`: the plan as JSON.

pub(crate) mod candidates;
pub(crate) mod criterion;
pub(crate) mod document;
pub(crate) mod order;
pub(crate) mod search;
pub(crate) mod sensitivity;

use crate::attitude::PAPER_FRAME_AXIS_AZIMUTH_DEG;
use crate::calibration::{NoLeastSquares, NoSetup, NotStated, Parameter};
use crate::coefficients::PositionIndex;
use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::site::Site;
use crate::stand::Stand;
use candidates::{Angles, Candidates, Design};
use criterion::Criterion;
use order::Order;
use sensitivity::Effect;
use serde::Serialize;

/// Smallest number of readings: each gives two equations, and there are eight parameters.
pub(crate) const FEWEST_READINGS: u32 = 4;

pub(crate) const MOST_READINGS: u32 = 256;

/// Smallest growth of an uncertainty that is reported.
const GROWTH: f64 = 1.005;

/// Purpose and limits of a plan.
#[derive(Debug, Clone)]
pub(crate) struct Question<'a> {
    /// Site; its azimuth of the frame's axis is replaced by each of `azimuths_deg`.
    pub site: &'a Site,
    /// Certified stand to read; without one, `angles` are the candidates.
    pub stand: Option<&'a Stand>,
    /// Nominal angles of candidates without a stand.
    pub angles: Angles,
    pub gyro: &'a GyroType,
    /// Laboratory; only its meter and gyro seat are used.
    pub laboratory: &'a Laboratory,
    /// Number of readings, [`FEWEST_READINGS`] to [`MOST_READINGS`].
    pub readings: u32,
    /// Azimuths of the frame's axis to choose from, degrees; if there are none, that of the site.
    pub azimuths_deg: Vec<f64>,
    pub criterion: Criterion,
}

/// Reason why there is no plan.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(crate) enum NoPlan {
    /// A stand whose matrix n_2 has no inverse, or an invalid uncertainty.
    #[error(transparent)]
    Setup(#[from] NoSetup),
    #[error("the gyro type's scale factors have no inverse; correct nominal.k_deg_per_h_per_ma")]
    SingularGyro,
    #[error(
        "the tolerance of {} is 0, and a plan weighs the uncertainties in units of the tolerances; state a positive \
         one, for K_xy and K_yx with a nominal value of 0 as k_cross_deg_per_h_per_ma",
        .0.symbol()
    )]
    NoTolerance(Parameter),
    /// A meter that cannot read the gyro in any position.
    #[error("in every position the gyro type needs more than {0} mA, the range of the meter; correct meter.range_ma")]
    Range(f64),
    /// Candidates that do not determine the parameters, however often they are read.
    #[error(
        "{0}; certify other positions, such as the paper's eight or theta = 90 and 270 deg with the frame's axis north"
    )]
    Undetermined(NoLeastSquares),
    /// Site where no positions determine the parameters.
    #[error(
        "no choice of positions determines the parameters of this gyro at latitude {latitude_deg:.2}°, where the horizontal Earth \
         rate is only {horizontal_deg_per_h:.2} °/h; calibrate the gyro at another site"
    )]
    NearThePole {
        /// Astronomic latitude, degrees.
        latitude_deg: f64,
        /// Horizontal component of the Earth rate, °/h.
        horizontal_deg_per_h: f64,
    },
    #[error("no choice of {0} readings determines the eight parameters; allow more with --readings")]
    TooFew(u32),
}

/// Position of a plan.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct Visited {
    pub theta_deg: f64,
    pub phi_deg: f64,
    /// Index of the certified position; `None` without a stand.
    #[serde(flatten)]
    pub index: Option<PositionIndex>,
    pub visits: u32,
}

/// Value of a design, with its uncertainties.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Evaluation {
    pub value: f64,
    /// Standard uncertainties in the order of [`Parameter::EIGHT`].
    #[serde(serialize_with = "sensitivity::by_parameter")]
    pub standard_uncertainty: [f64; 8],
    /// Effects of errors that all positions share.
    #[serde(skip)]
    pub effects: Vec<Effect>,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Plan {
    pub criterion: Criterion,
    /// Azimuth of the frame's axis, degrees.
    pub frame_axis_azimuth_deg: f64,
    /// Positions with at least one visit, in the order of the candidates.
    pub readings: Vec<Visited>,
    pub order: Order,
    pub evaluation: Evaluation,
    /// The paper's eight positions with the frame's axis east and as many readings; `None` if the stand lacks one of
    /// them, or eight does not divide the number of readings.
    pub paper: Option<Evaluation>,
    /// Tolerances in the units of the parameters, in the order of [`Parameter::EIGHT`].
    pub tolerance: [f64; 8],
    /// Standard uncertainty that the local g adds to ω_g or ω_k at the g of the type, the larger in units of its tolerance.
    pub gravity_over_tolerance: f64,
    /// Noise of the gyro between turn-ons, of which the plan has one, in units of the tolerance of ω_0.
    pub turn_on_over_tolerance: f64,
    pub candidates: usize,
    /// Number of positions that are not candidates, because the meter cannot read the currents of the gyro in them.
    pub beyond_range: usize,
    /// `true` if every choice was compared; `false` if the plan was found by exchange.
    pub exhaustive: bool,
    /// `true` if the paper's eight positions are in the plan, so that its matrices exist and its analytic and iterative methods apply.
    pub has_matrices: bool,
    /// `true` if the plan also determines the twelve parameters of the general model.
    pub has_general_model: bool,
    /// Inputs of single positions whose uncertainty the certificate does not state; they count as 0.
    pub of_positions_not_stated: Vec<NotStated>,
    /// `true` if the gyro type states no noise from visit to visit, which then counts as 0.
    pub noise_not_stated: bool,
}

impl Plan {
    /// Returns the parameters whose uncertainty is larger than that of the paper's eight, with the ratio.
    pub(crate) fn worse(&self) -> Vec<(Parameter, f64)> {
        let Some(paper) = &self.paper else { return Vec::new() };
        let ratio = |parameter: Parameter| {
            let place = parameter.place();
            self.evaluation.standard_uncertainty[place] / paper.standard_uncertainty[place]
        };
        let each = Parameter::EIGHT.into_iter().map(|parameter| (parameter, ratio(parameter)));
        each.filter(|(_, ratio)| *ratio > GROWTH).collect()
    }
}

pub(crate) fn plan(question: &Question) -> Result<Plan, NoPlan> {
    let mut best: Option<(Candidates, search::Found)> = None;
    let of_site = question.azimuths_deg.is_empty().then(|| question.site.frame_axis_azimuth_deg());
    for azimuth_deg in question.azimuths_deg.iter().copied().chain(of_site) {
        let candidates = Candidates::new(question, azimuth_deg)?;
        let found = search::best(&candidates, question.readings, question.criterion);
        let Some(found) = found else { continue };
        if best.as_ref().is_none_or(|(_, best)| search::is_better(&found, best)) {
            best = Some((candidates, found));
        }
    }
    let Some((candidates, found)) = best else { return Err(NoPlan::TooFew(question.readings)) };
    let design = Design::new(&candidates, &found.visits).ok_or(NoPlan::TooFew(question.readings))?;
    let has_matrices = candidates.has_eight(&found.visits);
    Ok(Plan {
        criterion: question.criterion,
        frame_axis_azimuth_deg: candidates.frame_axis_azimuth_deg,
        readings: design.readings(),
        order: order::best(&design),
        evaluation: design.evaluation(question.criterion),
        paper: paper(question)?,
        tolerance: candidates.tolerance,
        gravity_over_tolerance: gravity_over_tolerance(question, &candidates.tolerance),
        turn_on_over_tolerance: candidates.turn_on.sqrt(),
        candidates: candidates.len(),
        beyond_range: candidates.beyond_range,
        exhaustive: found.exhaustive,
        has_matrices,
        has_general_model: design.determines_general_model(),
        of_positions_not_stated: candidates.not_stated.clone(),
        noise_not_stated: question.gyro.noise.as_ref().is_none_or(|noise| noise.visit_deg_per_h.is_none()),
    })
}

impl Design<'_> {
    pub(crate) fn evaluation(&self, criterion: Criterion) -> Evaluation {
        let (value, standard_uncertainty) = (self.value(criterion), self.standard_uncertainty());
        Evaluation { value, standard_uncertainty, effects: sensitivity::effects(self) }
    }
}

/// Returns what the uncertainty of the local g adds to ω_g or ω_k in a decision, the larger in units of its tolerance.
fn gravity_over_tolerance(question: &Question, tolerance: &[f64; 8]) -> f64 {
    let relative = question.site.gravity_u_m_per_s2().unwrap_or(0.0) / question.site.earth().gravity_m_per_s2;
    let nominal = question.gyro.nominal.to_model().to_vector();
    let places = [Parameter::OmegaG, Parameter::OmegaK].map(Parameter::place);
    places.into_iter().map(|place| nominal[place].abs() * relative / tolerance[place]).fold(0.0, f64::max)
}

/// Evaluates the paper's eight positions with the frame's axis east, each visited an eighth of the readings.
fn paper(question: &Question) -> Result<Option<Evaluation>, NoPlan> {
    if !question.readings.is_multiple_of(8) {
        return Ok(None);
    }
    let Some(candidates) = Candidates::paper(question, PAPER_FRAME_AXIS_AZIMUTH_DEG)? else { return Ok(None) };
    let visits = vec![question.readings / 8; candidates.len()];
    Ok(Design::new(&candidates, &visits).map(|design| design.evaluation(question.criterion)))
}
