//! Positions to choose from, at one azimuth of the frame's axis, and what their visits tell about the parameters.
//!
//! For m visits of position p the misclosures have the covariance C_p = A_p + B_p/m. A_p is the part that no visit
//! reduces: the specification of the meter, and the certified angles. B_p is that of one visit: noise of the meter and
//! of the gyro, and the repeatability of positioning. The information is M = Σ F_p' C_p⁻¹ F_p with the two rows
//! F_p = (J, 1, n) of each position, and the covariance of the parameters M⁻¹; the scatter of turn-ons adds to ω_0.

use super::criterion::{Criterion, Matrix8, cholesky, inverse_of_lower};
use super::{NoPlan, Question, Visited};
use crate::attitude::{Deviation, PAPER_FRAME_AXIS_AZIMUTH_DEG};
use crate::calibration::sensitivity::Sensitivity;
use crate::calibration::unknowns::Unknowns;
use crate::calibration::{InputUncertainty, Model, NoLeastSquares, NotStated, Parameter, Setup, least_squares};
use crate::coefficients::{Coefficients, EIGHT_POSITIONS, Position, PositionIndex, eight_positions};
use crate::gyro::GyroType;
use crate::passport::accuracy::at_gravity;
use crate::site::Site;
use crate::stand::CertifiedPosition;
use nalgebra::{Matrix2, SMatrix, SVector, Vector2};

/// Nominal angles of the candidates without a stand: every θ with every φ, multiples of this step, degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Angles(f64);

/// Smallest step of the angles, degrees: 1296 candidates.
const SMALLEST_STEP_DEG: f64 = 10.0;

/// First index of positions of a grid. Not 1, because (1, 1) to (2, 4) are the paper's.
const FIRST_OF_GRID: u32 = 1001;

impl Angles {
    /// Multiples of 90°.
    pub(crate) const QUADRANTS: Self = Self(90.0);

    /// Form of a step in words.
    pub(crate) const EXPECTED: &str = "a step from 10 to 180 degrees that divides 360";

    /// Returns the multiples of `step_deg`, or `None` if it does not divide a full circle or is less than 10°.
    pub(crate) fn every(step_deg: f64) -> Option<Self> {
        let is_usable = (SMALLEST_STEP_DEG..=180.0).contains(&step_deg) && (360.0 / step_deg).fract() == 0.0;
        is_usable.then_some(Self(step_deg))
    }

    pub(crate) fn positions(self) -> Vec<Position> {
        let Self(step_deg) = self;
        let steps = (360.0 / step_deg) as u32;
        let each = (0..steps).flat_map(|i| (0..steps).map(move |j| (i, j)));
        let each = each.map(|(i, j)| Position {
            index: PositionIndex { i: FIRST_OF_GRID + i, j: FIRST_OF_GRID + j },
            theta_deg: step_deg * f64::from(i),
            phi_deg: step_deg * f64::from(j),
            deviation: Deviation::default(),
        });
        each.collect()
    }
}

#[derive(Debug, Clone)]
struct Candidate {
    position: Position,
    /// F: two rows, eight parameters in units of their tolerances.
    rows: SMatrix<f64, 2, 8>,
    /// A: covariance that no visit reduces, (°/h)².
    fixed: Matrix2<f64>,
    /// B: covariance of one visit, (°/h)².
    of_visit: Matrix2<f64>,
}

impl Candidate {
    /// Returns C⁻¹ of the mean of `visits` visits, (h/°)²; zero without a visit.
    fn weight(&self, visits: u32) -> Matrix2<f64> {
        if visits == 0 {
            return Matrix2::zeros();
        }
        let covariance = self.fixed + self.of_visit / f64::from(visits);
        // Positive definite, because the floor of the meter is positive. Symmetric to the last digit.
        let inverse = covariance.try_inverse().unwrap_or_default();
        Matrix2::new(inverse.m11, inverse.m12, inverse.m12, inverse.m22)
    }

    /// Returns F' C⁻¹ F.
    fn information(&self, visits: u32) -> Matrix8 {
        self.rows.transpose() * self.weight(visits) * self.rows
    }
}

/// All positions to choose from, at one azimuth of the frame's axis.
#[derive(Debug, Clone)]
pub(crate) struct Candidates {
    /// Azimuth of the frame's axis, degrees.
    pub frame_axis_azimuth_deg: f64,
    /// Tolerances, in the units of the parameters and the order of [`Parameter::EIGHT`].
    pub tolerance: [f64; 8],
    /// Variance that the scatter of turn-ons adds to ω_0x and ω_0y, in units of their tolerance.
    pub turn_on: f64,
    pub(crate) setup: Setup,
    /// Parameters of the gyro, drifts per local g.
    pub(crate) unknowns: Unknowns,
    /// Currents of the gyro in each candidate, mA.
    pub(crate) currents_ma: Vec<Vector2<f64>>,
    candidates: Vec<Candidate>,
    certified: bool,
    /// Inputs of single positions whose uncertainty the certificate does not state.
    pub(super) not_stated: Vec<NotStated>,
    /// Number of positions left out, because the meter cannot read their currents.
    pub(super) beyond_range: usize,
}

impl Candidates {
    /// Prepares the candidates of a question, with the frame's axis at an azimuth.
    pub(crate) fn new(question: &Question, azimuth_deg: f64) -> Result<Self, NoPlan> {
        let prepared = |question: &Question, azimuth_deg: f64, left_out: &[PositionIndex]| {
            Self::of(question, azimuth_deg, question.angles.positions(), |index| !left_out.contains(&index))
        };
        let all = prepared(question, azimuth_deg, &[])?;
        let beyond = all.beyond(question.laboratory.meter.range_ma);
        let in_range = match beyond.len() {
            0 => all,
            every if every == all.len() => return Err(NoPlan::Range(question.laboratory.meter.range_ma)),
            some => Self { beyond_range: some, ..prepared(question, azimuth_deg, &beyond)? },
        };
        in_range.determine().map_err(|why| {
            let earth = question.site.earth();
            let (latitude_deg, horizontal_deg_per_h) = (earth.latitude_deg, earth.horizontal_deg_per_h);
            let nominal = Question { stand: None, angles: Angles::QUADRANTS, ..question.clone() };
            let others = [0.0, PAPER_FRAME_AXIS_AZIMUTH_DEG].map(|azimuth_deg| prepared(&nominal, azimuth_deg, &[]));
            match others.iter().flatten().any(|others| others.determine().is_ok()) {
                true => NoPlan::Undetermined(why),
                false => NoPlan::NearThePole { latitude_deg, horizontal_deg_per_h },
            }
        })?;
        Ok(in_range)
    }

    /// Checks that all candidates together determine the parameters.
    fn determine(&self) -> Result<(), NoLeastSquares> {
        let meter = self.setup.uncertainty().meter;
        least_squares::solve(self.setup.coefficients(), &self.currents_ma, &meter, Model::Paper).map(|_| ())
    }

    /// Returns the positions in which the gyro needs more than `range_ma`, which the meter cannot read.
    fn beyond(&self, range_ma: f64) -> Vec<PositionIndex> {
        let each = self.candidates.iter().zip(&self.currents_ma);
        each.filter(|(_, current)| current.amax() > range_ma).map(|(at, _)| at.position.index).collect()
    }

    /// Prepares the paper's eight positions; returns `None` if the stand lacks one, or the meter cannot read one.
    pub(crate) fn paper(question: &Question, azimuth_deg: f64) -> Result<Option<Self>, NoPlan> {
        let is_of_paper = |index| EIGHT_POSITIONS.iter().any(|(of_paper, ..)| *of_paper == index);
        if question.stand.is_some_and(|stand| stand.positions.iter().filter(|at| is_of_paper(at.index())).count() < 8) {
            return Ok(None);
        }
        let eight = Self::of(question, azimuth_deg, eight_positions(Deviation::default).to_vec(), is_of_paper)?;
        Ok(eight.beyond(question.laboratory.meter.range_ma).is_empty().then_some(eight))
    }

    /// Prepares those positions of the stand of a question, or without one those of the `nominal` ones, that are `chosen`.
    fn of(
        question: &Question,
        azimuth_deg: f64,
        mut nominal: Vec<Position>,
        chosen: impl Fn(PositionIndex) -> bool,
    ) -> Result<Self, NoPlan> {
        let site = Site { frame_axis_azimuth_deg: Some(azimuth_deg), ..question.site.clone() };
        let (setup, missing, positions) = match question.stand {
            Some(stand) => {
                let positions: Vec<_> = stand.positions.iter().filter(|at| chosen(at.index())).cloned().collect();
                let (setup, missing) = Setup::stated(&stand.certificate, &positions, &site, question.laboratory)?;
                (setup, missing, positions.iter().map(CertifiedPosition::to_model).collect())
            }
            None => {
                nominal.retain(|at| chosen(at.index));
                let uncertainty = InputUncertainty::of_meter((&question.laboratory.meter).into());
                (Setup::new(&nominal, site.earth().rate(&site), uncertainty)?, Vec::new(), nominal)
            }
        };
        let of_positions =
            |input: &NotStated| matches!(input, NotStated::Angles | NotStated::SomeAngles | NotStated::Return);
        let tolerance = tolerances(question.gyro)?;
        let setup = setup.of_gyro(question.gyro.noise.as_ref());
        let gyro = at_gravity(question.gyro, question.site.earth().gravity_m_per_s2);
        let unknowns = Unknowns::of(gyro);
        let currents_ma = unknowns.currents_ma(&setup.coefficients().positions).ok_or(NoPlan::SingularGyro)?;
        let turn_on = setup.uncertainty().turn_on_deg_per_h.unwrap_or(0.0) / tolerance[Parameter::Omega0x.place()];
        let candidates: Vec<Candidate> = positions
            .iter()
            .enumerate()
            .map(|(place, position)| candidate(&setup, &unknowns, (place, position), currents_ma[place], &tolerance))
            .collect();
        let finite = candidates
            .iter()
            .all(|at| at.rows.iter().chain(&at.fixed).chain(&at.of_visit).all(|value| value.is_finite()));
        if !finite {
            return Err(NoPlan::SingularGyro);
        }
        Ok(Self {
            frame_axis_azimuth_deg: azimuth_deg,
            tolerance,
            turn_on: turn_on * turn_on,
            setup,
            unknowns,
            currents_ma,
            candidates,
            certified: question.stand.is_some(),
            not_stated: missing.into_iter().filter(of_positions).collect(),
            beyond_range: 0,
        })
    }

    pub(crate) fn len(&self) -> usize {
        self.candidates.len()
    }

    /// Returns the information of `visits` visits of the candidate at `place`, in units of the tolerances.
    pub(crate) fn information(&self, place: usize, visits: u32) -> Matrix8 {
        self.candidates[place].information(visits)
    }

    /// Returns the information of all visits, in units of the tolerances.
    pub(crate) fn information_of(&self, visits: &[u32]) -> Matrix8 {
        visits.iter().enumerate().map(|(place, visits)| self.information(place, *visits)).sum()
    }

    /// Returns `true` if each of the paper's eight positions is visited.
    pub(crate) fn has_eight(&self, visits: &[u32]) -> bool {
        EIGHT_POSITIONS.iter().all(|(index, theta_deg, phi_deg)| {
            self.candidates.iter().zip(visits).any(|(candidate, visits)| {
                let at = &candidate.position;
                let is_it =
                    at.index == *index || !self.certified && (at.theta_deg, at.phi_deg) == (*theta_deg, *phi_deg);
                is_it && *visits > 0
            })
        })
    }
}

fn candidate(
    setup: &Setup,
    unknowns: &Unknowns,
    (place, position): (usize, &Position),
    current_ma: Vector2<f64>,
    tolerance: &[f64; 8],
) -> Candidate {
    let u = setup.uncertainty();
    let sensitivity = Sensitivity::new(setup, unknowns);
    let k = &unknowns.parameters.k_deg_per_h_per_ma;
    let of_currents = |variance_ma2: Vector2<f64>| k * Matrix2::from_diagonal(&variance_ma2) * k.transpose();
    let visit = u.visit_deg_per_h.unwrap_or(0.0);
    let specification = of_currents(current_ma.map(|current| u.meter.own_variance_ma2(current)));
    let noise = of_currents(Vector2::repeat(u.meter.noise_ma * u.meter.noise_ma));
    let n = &setup.coefficients().positions[place].specific_force_g;
    let (jx, jy) = (current_ma.x, current_ma.y);
    let of_axes = [[jx, jy, 0.0, 0.0, 1.0, 0.0, n.x, -n.y], [0.0, 0.0, jx, jy, 0.0, 1.0, n.y, n.x]];
    Candidate {
        position: *position,
        rows: SMatrix::from_fn(|axis, parameter| of_axes[axis][parameter] * tolerance[parameter]),
        fixed: specification + sensitivity.of_certified_angles(place),
        of_visit: noise + sensitivity.of_return(place) + Matrix2::identity() * (visit * visit),
    }
}

/// Returns the tolerances in the units of the parameters.
fn tolerances(gyro: &GyroType) -> Result<[f64; 8], NoPlan> {
    let nominal = gyro.nominal.to_model().to_vector();
    let mut tolerances = [0.0; 8];
    for parameter in Parameter::EIGHT {
        let place = parameter.place();
        tolerances[place] = gyro.tolerance.absolute(parameter, nominal[place]);
        if tolerances[place] <= 0.0 {
            return Err(NoPlan::NoTolerance(parameter));
        }
    }
    Ok(tolerances)
}

/// Chosen numbers of visits, with the covariance of the parameters that they give.
#[derive(Debug, Clone)]
pub(crate) struct Design<'a> {
    pub(super) candidates: &'a Candidates,
    pub(super) visits: Vec<u32>,
    /// Covariance of the fit without the scatter of turn-ons, in units of the tolerances.
    covariance: Matrix8,
}

impl<'a> Design<'a> {
    /// Creates the design of `visits` visits of each candidate; returns `None` if they do not determine the parameters.
    pub(crate) fn new(candidates: &'a Candidates, visits: &[u32]) -> Option<Self> {
        let inverse = inverse_of_lower(&cholesky(&candidates.information_of(visits))?);
        let product = |row, column| inverse.column(row).iter().zip(&inverse.column(column)).map(|(a, b)| a * b).sum();
        let covariance = Matrix8::from_fn(product);
        Some(Self { candidates, visits: visits.to_vec(), covariance })
    }

    /// Returns the places of the candidates that are visited, with their numbers of visits.
    pub(crate) fn visited(&self) -> impl Iterator<Item = (usize, u32)> {
        self.visits.iter().copied().enumerate().filter(|(_, visits)| *visits > 0)
    }

    /// Returns G = M⁻¹ F' C⁻¹ of the candidate at `place`: the change of each parameter, in units of its tolerance, for a
    /// misclosure of 1 °/h in the mean of its visits about x and about y.
    pub(crate) fn response(&self, place: usize) -> SMatrix<f64, 8, 2> {
        let candidate = &self.candidates.candidates[place];
        self.covariance * (candidate.rows.transpose() * candidate.weight(self.visits[place]))
    }

    /// Returns the misclosure that a change of the parameters (in units of the tolerances) makes at `place`, °/h.
    pub(crate) fn misclosure(&self, place: usize, change: &SVector<f64, 8>) -> Vector2<f64> {
        self.candidates.candidates[place].rows * change
    }

    /// Returns r' C⁻¹ r for the residual r at `place`, °/h.
    pub(crate) fn weighted_square(&self, place: usize, residual: &Vector2<f64>) -> f64 {
        residual.dot(&(self.candidates.candidates[place].weight(self.visits[place]) * residual))
    }

    pub(crate) fn readings(&self) -> Vec<Visited> {
        let certified = self.candidates.certified;
        let visited = self.visited().map(|(place, visits)| {
            let Position { index, theta_deg, phi_deg, .. } = self.candidates.candidates[place].position;
            Visited { theta_deg, phi_deg, index: certified.then_some(index), visits }
        });
        visited.collect()
    }

    /// Returns the value of the design by a criterion.
    pub(crate) fn value(&self, criterion: Criterion) -> f64 {
        criterion.value(&self.candidates.information_of(&self.visits), self.candidates.turn_on)
    }

    /// Returns the standard uncertainties in the order of [`Parameter::EIGHT`].
    pub(crate) fn standard_uncertainty(&self) -> [f64; 8] {
        let Candidates { tolerance, turn_on, .. } = self.candidates;
        Parameter::EIGHT.map(|parameter| {
            let place = parameter.place();
            let is_omega0 = matches!(parameter, Parameter::Omega0x | Parameter::Omega0y);
            let variance = self.covariance[(place, place)] + if is_omega0 { *turn_on } else { 0.0 };
            tolerance[place] * variance.sqrt()
        })
    }

    /// Returns `true` if the visited positions also determine the full 2×3 matrix of g-sensitive drift.
    pub(crate) fn determines_general_model(&self) -> bool {
        let Candidates { setup, currents_ma, .. } = self.candidates;
        let places: Vec<usize> = self.visited().map(|(place, _)| place).collect();
        let positions = places.iter().map(|place| setup.coefficients().positions[*place]).collect();
        let currents: Vec<_> = places.iter().map(|place| currents_ma[*place]).collect();
        let visited = Coefficients { positions, matrices: None };
        least_squares::solve(&visited, &currents, &setup.uncertainty().meter, Model::General).is_ok()
    }
}
