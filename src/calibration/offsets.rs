//! Drift that changes during a run: the bias of each turn-on of the gyro (cycle), and a linear drift in time.
//!
//! In visit v the gyro drifts by ω_0 + Σ a_v x, where a_v are known numbers (one for each turn-on but the last, so that
//! the turn-ons have mean zero, and the time since the mean time) and x is unknown, two components each. The mean of the
//! visits to a position contains the mean of their a_v. Differences between its visits contain nothing but x and the
//! errors of visits, because everything else is the same. What they say of x is condensed into at most as many rows as x
//! has components, and the rest is the scatter of visits.

use super::readings::{PositionReadings, Readings, Visit};
use crate::statistics::least_squares::whitening_of;
use crate::units::SECONDS_PER_HOUR;
use nalgebra::{DMatrix, DVector, Matrix2, Vector2};
use std::ops::{AddAssign, SubAssign};

/// Eigenvalue, relative to the largest, below which differences of visits do not determine a combination of a_v.
const UNDETERMINED: f64 = 1e-12;

/// Mean of a_v below which visits to a position are balanced.
const BALANCED: f64 = 1e-12;

/// Numbers a_v of all visits, and what differences between visits say of x.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Offsets {
    /// Turn-ons in ascending order; empty if there is only one.
    pub(crate) cycles: Vec<u32>,
    /// `true` if every turn-on has a K of its own; x then contains its differences from their mean too.
    pub(crate) scale: bool,
    /// `true` if a linear drift is fitted.
    pub(crate) drift: bool,
    /// Mean time of all readings, s.
    mean_time_s: f64,
    /// Mean time of each turn-on, s; 0 if times are not known.
    cycle_times_s: Vec<f64>,
    /// For each position: mean of a_v over its visits.
    pub(crate) means: Vec<Vec<f64>>,
    /// Rows for x from the differences of visits, with unit covariance, and their right-hand side.
    pub(crate) rows: DMatrix<f64>,
    pub(crate) right: DVector<f64>,
}

impl Offsets {
    /// Creates the offsets of readings; differences of visits are added by [`Self::with`].
    pub(crate) fn new(readings: &Readings, (drift, scale): (bool, bool)) -> Self {
        let cycles = readings.cycles();
        let cycles = if cycles.len() > 1 { cycles } else { Vec::new() };
        let mean_time_s = readings.mean_time_s().unwrap_or(0.0);
        let mut offsets = Self { cycles, drift, scale, mean_time_s, ..Self::default() };
        let mean_time_s = |cycle: &u32| {
            let times =
                || readings.visits().filter(|visit| visit.cycle == *cycle).map(|visit| visit.time_s.unwrap_or(0.0));
            times().sum::<f64>() / times().count() as f64
        };
        offsets.cycle_times_s = offsets.cycles.iter().map(mean_time_s).collect();
        if offsets.terms() > 0 {
            offsets.rows = DMatrix::zeros(0, offsets.columns());
            offsets.means = readings.positions().iter().map(|at| offsets.mean(at)).collect();
        }
        offsets
    }

    /// Returns the number of elements of a_v; x has two components for each.
    pub(crate) fn terms(&self) -> usize {
        self.of_cycles() + usize::from(self.drift)
    }

    /// Returns the number of elements of a_v for the turn-ons: one for ω_0, and two for the columns of K.
    pub(crate) fn of_cycles(&self) -> usize {
        self.cycles.len().saturating_sub(1) * if self.scale { 3 } else { 1 }
    }

    pub(crate) fn columns(&self) -> usize {
        2 * self.terms()
    }

    /// Returns `true` if x changes the mean of no position, so that the means are those of one constant ω_0.
    pub(crate) fn are_balanced(&self) -> bool {
        self.means.iter().flatten().all(|mean| mean.abs() < BALANCED)
    }

    fn of_visit(&self, at: &PositionReadings, visit: &Visit) -> Vec<f64> {
        let mut terms = vec![0.0; self.terms()];
        if let Some((last, others)) = self.cycles.split_last() {
            let factors = [1.0, at.mean_ma.x, at.mean_ma.y];
            for (group, factor) in
                terms.chunks_mut(others.len()).zip(factors.iter().take(if self.scale { 3 } else { 1 }))
            {
                for (term, cycle) in group.iter_mut().zip(others) {
                    let own = f64::from(u8::from(visit.cycle == *cycle));
                    *term = factor * if visit.cycle == *last { -1.0 } else { own };
                }
            }
        }
        if self.drift
            && let Some(term) = terms.last_mut()
        {
            *term = (visit.time_s.unwrap_or(self.mean_time_s) - self.mean_time_s) / SECONDS_PER_HOUR;
        }
        terms
    }

    fn mean(&self, at: &PositionReadings) -> Vec<f64> {
        let mut mean = vec![0.0; self.terms()];
        for visit in &at.visits {
            for (mean, term) in mean.iter_mut().zip(self.of_visit(at, visit)) {
                *mean += term * at.visit_share();
            }
        }
        mean
    }

    /// Returns Σ a x for the mean of the visits to a position, °/h.
    pub(crate) fn of_mean(&self, place: usize, x: &[f64]) -> Vector2<f64> {
        let terms = self.means.get(place).into_iter().flatten().zip(x.chunks_exact(2));
        terms.fold(Vector2::zeros(), |sum, (a, x)| sum + Vector2::new(x[0], x[1]) * *a)
    }

    /// Writes the columns of x into the rows of all positions and adds the rows from differences, from column `first` on.
    pub(crate) fn write(&self, design: &mut DMatrix<f64>, first: usize) {
        for (place, means) in self.means.iter().enumerate() {
            for (term, a) in means.iter().enumerate() {
                design[(2 * place, first + 2 * term)] = *a;
                design[(2 * place + 1, first + 2 * term + 1)] = *a;
            }
        }
        let top = 2 * self.means.len();
        design.view_mut((top, first), self.rows.shape()).copy_from(&self.rows);
    }

    /// Returns the biases of the turn-ons, °/h, in the order of [`Self::cycles`], as a linear map of x: one row of
    /// coefficients for each turn-on, the same for both axes.
    pub(crate) fn turn_ons(&self) -> DMatrix<f64> {
        let count = self.cycles.len();
        DMatrix::from_fn(count, count.saturating_sub(1), |row, column| match row {
            _ if row + 1 == count => -1.0,
            _ => f64::from(u8::from(row == column)),
        })
    }

    /// Returns the projection of the turn-ons that leaves nothing of their mean and of what is linear in their mean times.
    pub(crate) fn beside_times(&self) -> DMatrix<f64> {
        let count = self.cycles.len();
        let times = DVector::from_column_slice(&self.cycle_times_s);
        let times = times.add_scalar(-times.mean());
        let along = &times * times.transpose() / times.norm_squared().max(f64::MIN_POSITIVE);
        DMatrix::identity(count, count).add_scalar(-1.0 / count as f64) - along
    }

    /// Takes over what differences between visits say of x.
    pub(crate) fn with(&mut self, found: Condensed) {
        (self.rows, self.right) = (found.rows, found.right);
    }
}

/// Differences between the visits to each position.
#[derive(Debug, Clone)]
pub(crate) struct Differences {
    /// Number of elements of a_v.
    terms: usize,
    /// Orthonormal combinations of a_v that the differences determine (terms × combinations); `None` if they determine
    /// every element.
    determined: Option<DMatrix<f64>>,
    /// Indices of the positions with several visits, and their visits.
    positions: Vec<(usize, Vec<Departure>)>,
    /// Number of differences, two for each visit after the first to its position.
    count: usize,
}

/// Departure of a visit from the mean of the visits to its position.
#[derive(Debug, Clone)]
struct Departure {
    /// Combinations of a_v.
    combinations: Vec<f64>,
    current_ma: Vector2<f64>,
}

/// Information on x from the differences between visits.
pub(crate) struct Condensed {
    /// Rows for x, with unit covariance, and their right-hand side.
    rows: DMatrix<f64>,
    right: DVector<f64>,
    /// Sum of squares that no x explains, in units of the covariance of visits.
    pub(crate) chi_square: f64,
    pub(crate) degrees_of_freedom: usize,
}

/// All visits as rows of unit covariance.
pub(crate) struct VisitRows {
    /// Two rows for each visit; the columns are x.
    pub(crate) design: DMatrix<f64>,
    /// Rates −K J less the mean of the position, whitened.
    pub(crate) rates: DVector<f64>,
    pub(crate) each: Vec<VisitRow>,
}

/// Visit with the matrices of its rows.
pub(crate) struct VisitRow {
    pub(crate) place: usize,
    pub(crate) visit: usize,
    /// L⁻¹ of the covariance L L' of the errors of the visit, (°/h)².
    pub(crate) whitening: Matrix2<f64>,
    /// Share of the visit in the mean of the visits to the position.
    pub(crate) share: Matrix2<f64>,
}

impl Differences {
    /// Returns the differences between visits, or `None` if no position has two.
    pub(crate) fn new(readings: &Readings, offsets: &Offsets) -> Option<Self> {
        let terms = offsets.terms();
        let mut positions = Vec::new();
        let (mut products, mut count) = (DMatrix::zeros(terms, terms), 0);
        for (place, at) in readings.positions().iter().enumerate().filter(|(_, at)| at.visits.len() > 1) {
            count += 2 * (at.visits.len() - 1);
            let mean = offsets.mean(at);
            let departures = at.visits.iter().map(|visit| {
                let combinations = offsets.of_visit(at, visit).iter().zip(&mean).map(|(a, mean)| a - mean).collect();
                Departure { combinations, current_ma: visit.mean_ma - at.mean_ma }
            });
            let departures: Vec<Departure> = departures.collect();
            for Departure { combinations, .. } in &departures {
                for (row, a) in combinations.iter().enumerate() {
                    for (column, b) in combinations.iter().enumerate() {
                        products[(row, column)] += a * b;
                    }
                }
            }
            positions.push((place, departures));
        }
        let determined = determined(products);
        if let Some(determined) = &determined {
            for departure in positions.iter_mut().flat_map(|(_, departures)| departures) {
                let each = DVector::from_column_slice(&departure.combinations);
                departure.combinations = determined.tr_mul(&each).data.into();
            }
        }
        (count > 0).then_some(Self { terms, determined, positions, count })
    }

    /// Returns the number of differences that no x explains.
    pub(crate) fn degrees_of_freedom(&self) -> usize {
        self.count - 2 * self.determined.as_ref().map_or(self.terms, DMatrix::ncols)
    }

    /// Returns all visits as rows of unit covariance for x, two for each, from which the best mean of their position is
    /// taken. `k` and `covariance` are those of [`Self::condensed`]; the result is `None` if a covariance has no inverse.
    pub(crate) fn rows(
        &self,
        k: &Matrix2<f64>,
        covariance: impl Fn(usize, usize) -> Matrix2<f64>,
    ) -> Option<VisitRows> {
        let visits: usize = self.positions.iter().map(|(_, departures)| departures.len()).sum();
        let combinations = self.determined.as_ref().map_or(self.terms, DMatrix::ncols);
        let mut design = DMatrix::zeros(2 * visits, 2 * combinations);
        let (mut rates, mut each) = (DVector::zeros(2 * visits), Vec::with_capacity(visits));
        for (place, departures) in &self.positions {
            let first = each.len();
            let mut weight = Matrix2::zeros();
            for visit in 0..departures.len() {
                let whitening = whitening_of(&covariance(*place, visit))?;
                weight += whitening.transpose() * whitening;
                each.push(VisitRow { place: *place, visit, whitening, share: Matrix2::zeros() });
            }
            let of_mean = weight.try_inverse()?;
            let (mut mean, mut mean_terms) = (Vector2::zeros(), vec![Matrix2::zeros(); combinations]);
            for (departure, row) in departures.iter().zip(&mut each[first..]) {
                row.share = of_mean * row.whitening.transpose() * row.whitening;
                mean -= row.share * (k * departure.current_ma);
                mean_terms.iter_mut().zip(&departure.combinations).for_each(|(mean, a)| *mean += row.share * *a);
            }
            for (at, departure) in departures.iter().enumerate() {
                let (row, whitening) = (2 * (first + at), each[first + at].whitening);
                rates.fixed_rows_mut::<2>(row).copy_from(&(whitening * (-(k * departure.current_ma) - mean)));
                for (term, (a, mean)) in departure.combinations.iter().zip(&mean_terms).enumerate() {
                    let own = whitening * (Matrix2::from_diagonal_element(*a) - mean);
                    design.fixed_view_mut::<2, 2>(row, 2 * term).copy_from(&own);
                }
            }
        }
        Some(VisitRows { design, rates, each })
    }

    /// Returns what the differences say of x; `k` is K, and `covariance` returns the covariance of the errors of a visit,
    /// (°/h)², 2×2, by the indices of position and visit. The result is `None` if a covariance has no inverse.
    ///
    /// The mean of the visits to a position is not known. With weights W_v = C_v⁻¹, its best value leaves of Σ a W b, for
    /// any two columns a and b, Σ a W b − (Σ a W) (Σ W)⁻¹ (Σ W b).
    pub(crate) fn condensed(
        &self,
        k: &Matrix2<f64>,
        covariance: impl Fn(usize, usize) -> Matrix2<f64>,
    ) -> Option<Condensed> {
        let combinations = self.determined.as_ref().map_or(self.terms, DMatrix::ncols);
        let columns = 2 * combinations;
        let (mut normal, mut right) = (DMatrix::zeros(columns, columns), DVector::zeros(columns));
        let mut squares = 0.0;
        let mut weighted = vec![Matrix2::zeros(); combinations];
        for (place, departures) in &self.positions {
            weighted.fill(Matrix2::zeros());
            let (mut weight, mut weighted_rate) = (Matrix2::zeros(), Vector2::zeros());
            for (visit, Departure { combinations, current_ma }) in departures.iter().enumerate() {
                let own = covariance(*place, visit).try_inverse()?;
                let rate = -(k * current_ma);
                let own_rate = own * rate;
                weight += own;
                weighted_rate += own_rate;
                squares += rate.dot(&own_rate);
                for (row, a) in combinations.iter().enumerate() {
                    weighted[row] += own * *a;
                    right.fixed_rows_mut::<2>(2 * row).add_assign(own_rate * *a);
                    for (column, b) in combinations.iter().enumerate().take(row + 1) {
                        normal.fixed_view_mut::<2, 2>(2 * row, 2 * column).add_assign(own * (a * b));
                    }
                }
            }
            let covariance = weight.try_inverse()?;
            let mean = covariance * weighted_rate;
            squares -= weighted_rate.dot(&mean);
            for (row, of_row) in weighted.iter().enumerate() {
                right.fixed_rows_mut::<2>(2 * row).sub_assign(of_row * mean);
                for (column, of_column) in weighted.iter().enumerate().take(row + 1) {
                    normal.fixed_view_mut::<2, 2>(2 * row, 2 * column).sub_assign(of_row * covariance * of_column);
                }
            }
        }
        // Rows L' of unit covariance for normal equations L L' x = right; only the lower triangle is read.
        let lower = normal.cholesky()?.unpack();
        lower.solve_lower_triangular_mut(&mut right);
        let rows = match &self.determined {
            Some(determined) => determined.kronecker(&Matrix2::identity()) * lower,
            None => lower,
        }
        .transpose();
        let chi_square = (squares - right.norm_squared()).max(0.0);
        Some(Condensed { rows, right, chi_square, degrees_of_freedom: self.degrees_of_freedom() })
    }
}

/// Returns the eigenvectors of a sum of products (terms × combinations) whose eigenvalues are not negligible, or `None` if
/// none is.
fn determined(products: DMatrix<f64>) -> Option<DMatrix<f64>> {
    if products.is_empty() {
        return None;
    }
    let eigen = products.symmetric_eigen();
    let least = UNDETERMINED * eigen.eigenvalues.max().max(0.0);
    let known: Vec<usize> = (0..eigen.eigenvalues.len()).filter(|place| eigen.eigenvalues[*place] > least).collect();
    (known.len() < eigen.eigenvalues.len()).then(|| eigen.eigenvectors.select_columns(&known))
}
