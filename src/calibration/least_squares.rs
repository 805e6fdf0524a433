//! Weighted least squares on all readings of any positions, with weights from the own part of each position.
//!
//! The currents are measured and are part of the regressors; Earth rate and specific force are known far better.
//! Therefore Σ e' (K D K')⁻¹ e is minimised, where e are the misclosures and D is the covariance of the currents. This
//! is the sum of squared errors *of the currents* in units of their uncertainty, and the result is unbiased. Each step
//! computes its regressors and its weights from the currents that the last solution gives (effective variance,
//! iterated), never from the noisy readings.

use super::offsets::Offsets;
use super::unknowns::{Unknowns, design};
use super::{MeterUncertainty, Model, Parameter};
use crate::coefficients::{Coefficients, PositionCoefficients};
use crate::gyro::GyroParameters;
use crate::statistics::least_squares::{Factorised, condition, whitening_of};
use crate::text::number::exponent_as_printed;
use nalgebra::{DMatrix, DVector, Matrix2, Vector2};

/// Condition number above which positions do not determine all parameters; noise would grow by this factor.
///
/// Columns are compared in units of the largest current, 1 °/h and 1 g. For the paper's eight positions and its gyro,
/// the condition number is 12 without deviations. The largest of 40,000 stands drawn within ±15° is 16.5. Within ±45°
/// it is 71, and the tail is heavy: 99.99 % are below 47, and the largest of two other draws were 55 and 89. The
/// condition number grows towards the poles, to 74 at a latitude of 85°. With the anisoelastic coefficient it is
/// infinite without deviations, above 500 at ±10′ and below 100 from about ±15° on.
pub(crate) const LARGEST_CONDITION: f64 = 300.0;

/// Condition number above which turn-ons or a drift cannot be told from other unknowns at all.
const SINGULAR: f64 = 1e6;

/// Maximum number of steps of the fit; usually it needs three or four.
const LARGEST_NUMBER_OF_STEPS: usize = 30;

/// Number of steps after which the fit of a possible cause is given up. The larger the residuals are relative to the currents,
/// the more steps a fit takes; one that explains the readings leaves small ones.
const STEPS_OF_A_CAUSE: usize = 8;

/// Length of the last step, as a fraction of the solution's own uncertainty, below which the fit is settled.
pub(crate) const SETTLED: f64 = 1e-6;

/// Solves for the gyro parameters from one reading (J_x, J_y) of each of `coefficients.positions`, mA, in the same
/// order.
pub(crate) fn solve(
    coefficients: &Coefficients,
    currents_ma: &[Vector2<f64>],
    meter: &MeterUncertainty,
    model: Model,
) -> Result<GyroParameters, NoLeastSquares> {
    let (offsets, own_covariance) = (&Offsets::default(), own_covariance_of(meter));
    let fit = Problem { coefficients, currents_ma, model, offsets, own_covariance }.solve()?;
    Ok(fit.unknowns.parameters)
}

/// Returns the standard uncertainties of [`Parameter::EIGHT`], to first order, for one reading of the exact currents of
/// `gyro` in each position, if only the own errors of `meter` act.
///
/// Returns `None` if the positions do not determine all eight parameters.
pub(crate) fn expected_uncertainties(
    coefficients: &Coefficients,
    gyro: &GyroParameters,
    meter: &MeterUncertainty,
) -> Option<[f64; 8]> {
    let unknowns = Unknowns::of(*gyro);
    let currents_ma = unknowns.currents_ma(&coefficients.positions)?;
    let own_covariance = own_covariance_of(meter);
    let (model, offsets) = (Model::Paper, &Offsets::default());
    let problem = Problem { coefficients, currents_ma: &currents_ma, model, offsets, own_covariance };
    problem.conditioned(largest_current(&currents_ma)).ok()?;
    let (fit, _) = problem.equations(&Solution { unknowns, changing: Vec::new() }, Some(&currents_ma))?;
    // The covariance of the parameters is R⁻¹ R⁻¹'.
    let r_inverse = &fit.model.r_inverse;
    Some(std::array::from_fn(|place| r_inverse.row(place).norm()))
}

/// Returns a function for the covariance of a position's misclosure from the own errors of a meter, (°/h)², 2×2.
fn own_covariance_of(meter: &MeterUncertainty) -> impl Fn(usize, &Unknowns, &Vector2<f64>) -> Matrix2<f64> {
    |_, unknowns, current| {
        let k = unknowns.parameters.k_deg_per_h_per_ma;
        let noise = meter.noise_ma * meter.noise_ma;
        let variance = current.map(|current| meter.own_variance_ma2(current) + noise);
        k * Matrix2::from_diagonal(&variance) * k.transpose()
    }
}

/// Ratio of the largest currents of x and y from which one is in another unit or range, and has its own unit here.
const OTHER_RANGE: f64 = 10.0;

/// Returns the units of the columns of K, mA: the largest current, or 1 if all are 0.
fn largest_current(currents_ma: &[Vector2<f64>]) -> Vector2<f64> {
    let each = currents_ma.iter().fold(Vector2::zeros(), |a: Vector2<f64>, current| a.sup(&current.abs()));
    let each =
        if each.max() > OTHER_RANGE * each.min() && each.min() > 0.0 { each } else { Vector2::repeat(each.max()) };
    each.map(|largest| if largest == 0.0 { 1.0 } else { largest })
}

/// Unknowns of the drift model, and x of the [`Offsets`].
#[derive(Debug, Clone, PartialEq)]
struct Solution {
    unknowns: Unknowns,
    changing: Vec<f64>,
}

/// Fitted unknowns, with the quantities from which their covariance is computed.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    pub(crate) unknowns: Unknowns,
    /// x of the offsets: biases of turn-ons, °/h, and drift in time, °/h².
    pub(crate) changing: Vec<f64>,
    /// Positions with the Earth rate less the offset of their mean.
    pub(crate) positions: Vec<PositionCoefficients>,
    /// Currents (J_x, J_y) that follow from the unknowns, mA.
    pub(crate) currents_ma: Vec<Vector2<f64>>,
    /// W for every position, with W C W' = 1, where C is the covariance of its own part.
    pub(crate) whitening: Vec<Matrix2<f64>>,
    /// Whitened equations, factorised.
    pub(crate) model: Factorised,
    /// `true` if the steps converged. Otherwise the readings are far from any gyro's, and the regressors are measured
    /// currents.
    pub(crate) settled: bool,
    /// Model of the g-sensitive drift.
    pub(crate) of: Model,
}

impl Fit {
    /// Returns the drift in time about x and y, °/h²; `None` if it was not fitted.
    pub(crate) fn drift(&self, offsets: &Offsets) -> Option<Vector2<f64>> {
        let &[.., x, y] = self.changing.as_slice() else { return None };
        offsets.drift.then_some(Vector2::new(x, y))
    }

    /// Returns the standard uncertainties of the offsets from the own parts of the positions, °/h or °/h².
    pub(crate) fn own_uncertainties_of_offsets(&self) -> impl Iterator<Item = f64> {
        let r_inverse = &self.model.r_inverse;
        (self.of.columns()..r_inverse.nrows()).map(|row| r_inverse.row(row).norm())
    }

    /// Returns the unwhitened equations, with the rows and columns of the offsets.
    pub(crate) fn design(&self, offsets: &Offsets) -> DMatrix<f64> {
        whole_design(&self.positions, &self.currents_ma, self.of, offsets)
    }

    /// Returns the misclosure of the mean of a position, °/h.
    pub(crate) fn misclosure(&self, place: usize, current_ma: &Vector2<f64>) -> Vector2<f64> {
        self.unknowns.misclosure(&self.positions[place], current_ma)
    }

    /// Returns the misclosures of the rows that the differences of visits add, in units of their standard uncertainty.
    pub(crate) fn of_differences(&self, offsets: &Offsets) -> DVector<f64> {
        &offsets.right - &offsets.rows * DVector::from_column_slice(&self.changing)
    }
}

fn whole_design(
    positions: &[PositionCoefficients],
    currents_ma: &[Vector2<f64>],
    model: Model,
    offsets: &Offsets,
) -> DMatrix<f64> {
    let design = design(positions, currents_ma, model);
    if offsets.columns() == 0 {
        return design;
    }
    let (rows, columns) = design.shape();
    let mut whole = design.resize(rows + offsets.rows.nrows(), columns + offsets.columns(), 0.0);
    offsets.write(&mut whole, columns);
    whole
}

pub(crate) struct Problem<'a, F> {
    pub(crate) coefficients: &'a Coefficients,
    pub(crate) currents_ma: &'a [Vector2<f64>],
    pub(crate) model: Model,
    pub(crate) offsets: &'a Offsets,
    /// Returns the covariance, 2×2, of the own part of a position for given unknowns and current.
    pub(crate) own_covariance: F,
}

impl<F: Fn(usize, &Unknowns, &Vector2<f64>) -> Matrix2<f64>> Problem<'_, F> {
    pub(crate) fn solve(&self) -> Result<Fit, NoLeastSquares> {
        let start = self.first()?;
        if let Some(fit) = self.settle(start.clone(), LARGEST_NUMBER_OF_STEPS) {
            return Ok(fit);
        }
        // No gyro gives such readings. One step with the measured currents as regressors is the best available fit.
        let (step, mut fit) = self.step(&start, Some(self.currents_ma)).ok_or(NoLeastSquares::NotUsable)?;
        self.advance(&mut fit, &step.0);
        fit.settled = false;
        Ok(fit)
    }

    /// Returns the fit if it settles soon, because the readings nearly fit.
    pub(crate) fn solve_soon(&self) -> Option<Fit> {
        self.settle(self.first().ok()?, STEPS_OF_A_CAUSE)
    }

    /// Fits the parameters again after a change of weights or offsets, from the solution of `last` on.
    pub(crate) fn solve_again(&self, last: &Fit) -> Result<Fit, NoLeastSquares> {
        let mut start = Solution { unknowns: last.unknowns, changing: last.changing.clone() };
        if start.changing.len() != self.offsets.columns() {
            start.changing = vec![0.0; self.offsets.columns()];
            self.offsets_determined(&last.currents_ma)?;
        }
        match self.settle(start, LARGEST_NUMBER_OF_STEPS) {
            Some(fit) if last.settled => Ok(fit),
            _ => self.solve(),
        }
    }

    /// Returns the unweighted equations with measured currents in the units `unit_ma`, after a check of rank and
    /// condition. Columns of offsets are only checked.
    fn conditioned(&self, unit_ma: Vector2<f64>) -> Result<Factorised, NoLeastSquares> {
        let positions = &self.coefficients.positions;
        if self.currents_ma.len() != positions.len() {
            return Err(NoLeastSquares::OtherPositions);
        }
        if self.offsets.columns() > 0 {
            self.offsets_determined(self.currents_ma)?;
        }
        let scaled: Vec<_> = self.currents_ma.iter().map(|current| current.component_div(&unit_ma)).collect();
        self.determined(&design(positions, &scaled, self.model), LARGEST_CONDITION)
    }

    /// Returns the unweighted solution with measured currents.
    fn first(&self) -> Result<Solution, NoLeastSquares> {
        let positions = &self.coefficients.positions;
        let unit_ma = largest_current(self.currents_ma);
        let model = self.conditioned(unit_ma)?;
        let rates = positions.iter().flat_map(|at| at.earth_rate_deg_per_h.iter().copied());
        let mut right = DMatrix::from_iterator(2 * positions.len(), 1, rates);
        model.rotate(&mut right);
        let (mut solution, _) = model.solve_rotated(&right);
        (0..4).for_each(|element| solution[element] /= unit_ma[element % 2]);
        let unknowns = Unknowns::from_vector(self.model, &solution);
        Ok(Solution { unknowns, changing: vec![0.0; self.offsets.columns()] })
    }

    /// Returns the equations, factorised, if their condition number is small enough. It is computed only if its bound, which
    /// costs less, is too large.
    fn determined(&self, design: &DMatrix<f64>, largest: f64) -> Result<Factorised, NoLeastSquares> {
        let model = Factorised::new(design.clone());
        if let Some(model) = model.filter(|model| model.condition_bound() <= largest) {
            return Ok(model);
        }
        let found = condition(design, largest).ok_or(NoLeastSquares::NotUsable)?;
        if found.undetermined.is_empty() {
            return Factorised::new(design.clone()).ok_or(NoLeastSquares::NotUsable);
        }
        let groups = mixed(&found.undetermined, &self.names());
        Err(NoLeastSquares::Inseparable { groups, condition: found.number })
    }

    /// Checks that no offset is mixed with another unknown. How well each is known, its uncertainty tells.
    fn offsets_determined(&self, currents_ma: &[Vector2<f64>]) -> Result<(), NoLeastSquares> {
        // Differences of visits alone may determine all of them.
        if self.offsets.rows.nrows() == self.offsets.columns() {
            return Ok(());
        }
        let mut design = whole_design(&self.coefficients.positions, currents_ma, self.model, self.offsets);
        // Rows of differences are in units of their uncertainty, which has no place here.
        let first = 2 * self.coefficients.positions.len();
        let largest = design.rows_range(first..).amax();
        if largest > 0.0 {
            design.rows_range_mut(first..).unscale_mut(largest);
        }
        // Columns of length 1, so that their units do not matter; columns of zeros stay.
        for mut column in design.column_iter_mut() {
            column.try_normalize_mut(0.0);
        }
        self.determined(&design, SINGULAR).map(drop)
    }

    fn names(&self) -> Vec<Parameter> {
        let turn_ons = (0..self.offsets.of_cycles()).flat_map(|_| [Parameter::TurnOn(0), Parameter::TurnOn(1)]);
        let drift = self.offsets.drift.then_some([Parameter::Drift(0), Parameter::Drift(1)]);
        self.model.parameters().iter().copied().chain(turn_ons).chain(drift.into_iter().flatten()).collect()
    }

    /// Iterates from `start` until a step is negligible, or returns `None` if no step is within this number.
    fn settle(&self, start: Solution, largest_number: usize) -> Option<Fit> {
        let mut solution = start;
        for _ in 0..largest_number {
            let ((step, length), mut fit) = self.step(&solution, None)?;
            self.advance(&mut fit, &step);
            if length < SETTLED {
                return Some(fit);
            }
            solution = Solution { unknowns: fit.unknowns, changing: fit.changing };
        }
        None
    }

    /// Adds a step to the solution of `fit`.
    fn advance(&self, fit: &mut Fit, step: &DVector<f64>) {
        fit.unknowns = fit.unknowns.plus(self.model, step);
        if self.offsets.columns() > 0 {
            for (value, change) in fit.changing.iter_mut().zip(step.iter().skip(self.model.columns())) {
                *value += change;
            }
            fit.positions = self.positions(&fit.changing);
        }
    }

    /// Returns the positions with the Earth rate less the offset of their mean.
    fn positions(&self, changing: &[f64]) -> Vec<PositionCoefficients> {
        let mut positions = self.coefficients.positions.clone();
        if self.offsets.columns() > 0 {
            for (place, at) in positions.iter_mut().enumerate() {
                at.earth_rate_deg_per_h -= self.offsets.of_mean(place, changing);
            }
        }
        positions
    }

    /// Returns one step from a solution and its length in units of the solution's own uncertainty; `None` if the
    /// equations cannot be factorised. The regressors are these currents, or those that follow from the solution.
    fn step(&self, from: &Solution, regressors_ma: Option<&[Vector2<f64>]>) -> Option<((DVector<f64>, f64), Fit)> {
        let (fit, mut right) = self.equations(from, regressors_ma)?;
        fit.model.rotate(&mut right);
        Some((fit.model.solve_rotated(&right), fit))
    }

    /// Returns the weighted equations of [`Self::step`], factorised, as the fit of a solution, and their right-hand side.
    fn equations(&self, of: &Solution, regressors_ma: Option<&[Vector2<f64>]>) -> Option<(Fit, DMatrix<f64>)> {
        let Solution { unknowns, changing } = of;
        let positions = self.positions(changing);
        let regressors_ma = match regressors_ma {
            Some(currents_ma) => currents_ma.to_vec(),
            None => unknowns.currents_ma(&positions)?,
        };
        let mut design = whole_design(&positions, &regressors_ma, self.model, self.offsets);
        let mut right = DMatrix::zeros(design.nrows(), 1);
        let mut whitening = Vec::with_capacity(positions.len());
        for (place, at) in positions.iter().enumerate() {
            let covariance = (self.own_covariance)(place, unknowns, &regressors_ma[place]);
            let whiten = whitening_of(&covariance)?;
            let misclosure = whiten * unknowns.misclosure(at, &self.currents_ma[place]);
            right.fixed_view_mut::<2, 1>(2 * place, 0).copy_from(&misclosure);
            multiply_rows(&mut design, place, &whiten);
            whitening.push(whiten);
        }
        let model = Factorised::new(design)?;
        let (unknowns, changing, currents_ma, of) = (*unknowns, changing.clone(), regressors_ma, self.model);
        let fit = Fit { unknowns, changing, positions, currents_ma, whitening, model, settled: true, of };
        if self.offsets.columns() > 0 {
            right
                .rows_mut(2 * fit.positions.len(), self.offsets.rows.nrows())
                .copy_from(&fit.of_differences(self.offsets));
        }
        Some((fit, right))
    }
}

/// Multiplies the two rows of a position by a matrix, in place.
pub(crate) fn multiply_rows(matrix: &mut DMatrix<f64>, place: usize, by: &Matrix2<f64>) {
    for column in 0..matrix.ncols() {
        let (x, y) = (matrix[(2 * place, column)], matrix[(2 * place + 1, column)]);
        matrix[(2 * place, column)] = by.m11 * x + by.m12 * y;
        matrix[(2 * place + 1, column)] = by.m21 * x + by.m22 * y;
    }
}

/// Reason why least squares gives no result.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoLeastSquares {
    /// Readings of other positions than those of the coefficients, or in another order.
    #[error("the readings and the coefficients are for different positions")]
    OtherPositions,
    /// Equations that do not determine all parameters.
    #[error("{}", in_words(.groups, *.condition))]
    Inseparable {
        /// Groups of parameters that cannot be separated; a group of one parameter is not determined at all.
        groups: Vec<Vec<Parameter>>,
        /// Condition number of the equations.
        condition: f64,
    },
    /// A drift in time is asked for, but a reading has no time.
    #[error("a drift in time cannot be fitted without the time of every reading: add the column time_s")]
    NoTimes,
    /// A drift in time is asked for, but all readings have the same time.
    #[error("a drift in time cannot be fitted, because all readings have the same time_s")]
    ConstantTime,
    /// A drift in time is asked for, but would leave the noise of the gyro from visit to visit without degrees of freedom.
    #[error(
        "a drift in time cannot be fitted, because the repeated visits cannot tell it from the noise of the gyro: visit \
         more positions again, or state noise.visit_deg_per_h in the gyro type"
    )]
    DriftOrNoise,
    /// A current or an uncertainty that is not finite, or a meter without any uncertainty.
    #[error("every current must be finite and every uncertainty positive")]
    NotUsable,
}

/// Condition number from which only this limit is printed.
const LARGEST_PRINTED: f64 = 1e6;

fn in_words(groups: &[Vec<Parameter>], condition: f64) -> String {
    let symbols = |group: &[Parameter]| group.iter().map(|parameter| parameter.symbol()).collect::<Vec<_>>();
    let (alone, mixed): (Vec<_>, Vec<_>) = groups.iter().partition(|group| group.len() < 2);
    let alone: Vec<&str> = alone.into_iter().flat_map(|group| symbols(group)).collect();
    let separate = mixed.iter().map(|group| match symbols(group).as_slice() {
        [one, rest @ ..] => format!("separate {one} from {}", rest.join(" and ")),
        [] => String::new(),
    });
    let determine = match alone.as_slice() {
        [] if groups.iter().any(|group| group.len() > 1) => None,
        [] => Some("determine the parameters".to_owned()),
        [one] => Some(format!("determine {one}")),
        [first @ .., last] => Some(format!("determine {} and {last}", first.join(", "))),
    };
    let words = separate.chain(determine).collect::<Vec<_>>().join(", or ");
    let is_extra = |parameter: &Parameter| matches!(parameter, Parameter::Anisoelasticity | Parameter::G(..));
    let advice = match groups.iter().flatten().any(is_extra) {
        true => "; fit the paper's model, or read further positions",
        false => "",
    };
    let condition = match exponent_as_printed(condition, 1) {
        exponent if condition < LARGEST_PRINTED => {
            let unit = libm::pow(10.0, exponent.into());
            format!("{:.0}", (condition / unit).round() * unit)
        }
        _ => "over 10⁶".to_owned(),
    };
    format!(
        "readings of these positions cannot {words} (condition number {condition}, expected at most \
         {LARGEST_CONDITION}){advice}"
    )
}

/// Returns the groups of parameters that the undetermined directions mix.
///
/// Elimination with the largest element as pivot leaves each direction with as few parameters as possible. Two
/// parameters that are undetermined independently then do not seem to be mixed with each other.
fn mixed(directions: &[DVector<f64>], names: &[Parameter]) -> Vec<Vec<Parameter>> {
    let mut rows: Vec<DVector<f64>> = directions.to_vec();
    for pivot_row in 0..rows.len() {
        let pivot = rows[pivot_row].iamax();
        let divisor = rows[pivot_row][pivot];
        if divisor == 0.0 {
            continue;
        }
        let normalised = &rows[pivot_row] / divisor;
        for (other, row) in rows.iter_mut().enumerate() {
            if other != pivot_row {
                let factor = row[pivot];
                row.axpy(-factor, &normalised, 1.0);
            }
        }
        rows[pivot_row] = normalised;
    }
    let involved = |row: &DVector<f64>| {
        let limit = 0.1 * row.amax();
        names.iter().zip(row.iter()).filter(|(_, x)| x.abs() > limit).map(|(name, _)| *name).collect()
    };
    let mut groups: Vec<Vec<Parameter>> = rows.iter().map(involved).collect();
    // Which direction comes first is a matter of rounding.
    groups.sort_by_key(|group| names.iter().position(|name| group.first() == Some(name)));
    groups
}
