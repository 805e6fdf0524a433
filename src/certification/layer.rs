//! Layers of a measurement, and least-squares fits of shifts to them.
//!
//! What differs between the runs has two layers: what remains in the readings once a rotation of platform and base is
//! fitted to each run, and these rotations themselves. In both, a shift is a contrast between the runs times a pattern of
//! the rows, so a fit needs only inner products of contrasts and of patterns. Each group of rows has its own variance.

use nalgebra::{DMatrix, DVector};

/// Share of its own variance in its residual below which a shift is determined by itself alone.
const LEAST_KEPT: f64 = 1e-6;

/// Contrast between the runs, by their places.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Runs {
    One(usize),
    From(usize),
    Line,
}

/// Shift: a contrast between the runs, and a pattern of the rows as far as the layer keeps it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Column {
    pub(super) runs: Runs,
    pub(super) kept: DVector<f64>,
}

#[derive(Debug, Clone)]
pub(super) struct Layer {
    /// Values, rows × runs; their sum over the runs is 0.
    pub(super) values: DMatrix<f64>,
    /// Share of each row in the value of each row.
    pub(super) keeps: DMatrix<f64>,
    /// Group of each row.
    pub(super) group: Vec<usize>,
    groups: usize,
    /// `true` if the patterns of shifts contain what the layer no longer keeps.
    pub(super) is_reduced: bool,
    /// Numbers of the runs less their mean.
    times: Vec<f64>,
    /// Sums of the values and of the times over a run and all later ones; the values along the times.
    later: DMatrix<f64>,
    later_times: Vec<f64>,
    along_times: DVector<f64>,
    /// Sum of the squares of the times, and those of the values by group.
    times_squared: f64,
    squares: DVector<f64>,
}

/// Fit of shifts to a layer.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    pub(super) sizes: DVector<f64>,
    /// Covariance of the sizes for values with variance 1.
    pub(super) spread: DMatrix<f64>,
    /// Sum of squares that each group keeps, and its degrees of freedom.
    pub(super) rest: Vec<[f64; 2]>,
}

impl Layer {
    pub(super) fn new(values: DMatrix<f64>, keeps: DMatrix<f64>, group: Vec<usize>, runs: &[u32]) -> Self {
        let mean = runs.iter().map(|run| f64::from(*run)).sum::<f64>() / runs.len() as f64;
        let times: Vec<f64> = runs.iter().map(|run| f64::from(*run) - mean).collect();
        let along_times = &values * DVector::from_column_slice(&times);
        let (mut later, mut later_times) = (values.clone(), times.clone());
        for run in (1..runs.len()).rev() {
            let sum = later.column(run - 1) + later.column(run);
            later.set_column(run - 1, &sum);
            later_times[run - 1] += later_times[run];
        }
        let groups = group.iter().max().map_or(0, |last| last + 1);
        let times_squared = times.iter().map(|time| time * time).sum();
        let mut squares = DVector::zeros(groups);
        group.iter().enumerate().for_each(|(row, group)| squares[*group] += values.row(row).norm_squared());
        let is_reduced = false;
        Self {
            values,
            keeps,
            group,
            groups,
            is_reduced,
            times,
            later,
            later_times,
            along_times,
            times_squared,
            squares,
        }
    }

    /// Returns the number of runs less one.
    pub(super) fn changes(&self) -> f64 {
        self.times.len() as f64 - 1.0
    }

    /// Returns a shift as far as the layer keeps it.
    pub(super) fn kept(&self, column: Column) -> Column {
        if self.is_reduced { Column { kept: &self.keeps * column.kept, ..column } } else { column }
    }

    /// Returns the inner product of two contrasts, less their means.
    fn product(&self, one: Runs, other: Runs) -> f64 {
        match (one, other) {
            (Runs::One(run), contrast) | (contrast, Runs::One(run)) => self.contrast(contrast, run),
            (Runs::From(from), Runs::Line) | (Runs::Line, Runs::From(from)) => self.later_times[from],
            (Runs::Line, Runs::Line) => self.times_squared,
            (Runs::From(one), Runs::From(other)) => {
                let count = self.times.len();
                let each = |from: usize| (count - from) as f64;
                each(one.max(other)) - each(one) * each(other) / count as f64
            }
        }
    }

    /// Returns a contrast, less its mean, in a run.
    fn contrast(&self, contrast: Runs, run: usize) -> f64 {
        let share = |runs: usize| runs as f64 / self.times.len() as f64;
        match contrast {
            Runs::One(one) => f64::from(u8::from(run == one)) - share(1),
            Runs::From(first) => f64::from(u8::from(run >= first)) - share(self.times.len() - first),
            Runs::Line => self.times[run],
        }
    }

    /// Returns the sum over the rows of `pattern` times the values along a contrast, by group.
    fn along(&self, runs: Runs, pattern: &DVector<f64>) -> DVector<f64> {
        let values = match runs {
            Runs::One(run) => self.values.column(run),
            Runs::From(first) => self.later.column(first),
            Runs::Line => self.along_times.column(0),
        };
        self.by_group(|row| pattern[row] * values[row])
    }

    fn by_group(&self, each: impl Fn(usize) -> f64) -> DVector<f64> {
        let mut sums = DVector::zeros(self.groups);
        self.group.iter().enumerate().for_each(|(row, group)| sums[*group] += each(row));
        sums
    }

    /// Returns the least-squares fit of shifts, or `None` if the values do not determine them.
    pub(super) fn fit(&self, columns: &[&Column]) -> Option<Fit> {
        let count = columns.len();
        let mut normal = DMatrix::zeros(count, count);
        let mut shared = Vec::with_capacity(count * (count + 1) / 2);
        for (a, one) in columns.iter().enumerate() {
            for (b, other) in columns[..=a].iter().enumerate() {
                let product = self.product(one.runs, other.runs);
                let both = self.by_group(|row| product * one.kept[row] * other.kept[row]);
                normal[(a, b)] = both.sum();
                normal[(b, a)] = normal[(a, b)];
                shared.push((a, b, both));
            }
        }
        let along: Vec<DVector<f64>> = columns.iter().map(|column| self.along(column.runs, &column.kept)).collect();
        let is_determined = |pivot: &f64| pivot * pivot > LEAST_KEPT;
        let root = normal.cholesky();
        let spread = root.filter(|root| root.l_dirty().diagonal().iter().all(is_determined))?.inverse();
        let sizes = &spread * DVector::from_iterator(count, along.iter().map(DVector::sum));
        let changes = self.changes();
        let mut squares = self.squares.clone();
        let mut freedom = self.by_group(|row| self.keeps[(row, row)] * changes);
        along.iter().zip(&sizes).for_each(|(along, size)| squares -= along * (2.0 * size));
        for (a, b, both) in &shared {
            let twice = if a == b { 1.0 } else { 2.0 };
            squares += both * (twice * sizes[*a] * sizes[*b]);
            freedom -= both * (twice * spread[(*a, *b)]);
        }
        let rest = squares.iter().zip(&freedom).map(|(squares, freedom)| [squares.max(0.0), *freedom]).collect();
        Some(Fit { sizes, spread, rest })
    }

    /// Returns the values without fitted shifts.
    pub(super) fn residual(&self, columns: &[&Column], fit: &Fit) -> DMatrix<f64> {
        let shifts = columns.iter().zip(&fit.sizes);
        shifts
            .fold(self.values.clone(), |values, (column, size)| values - self.shift(column.runs, &column.kept) * *size)
    }

    /// Returns what the `fit` of shifts, with the `residual` values, leaves without orthonormal combinations of the rows, in
    /// every run.
    pub(super) fn without(&self, residual: &DMatrix<f64>, fit: &Fit, combinations: &DMatrix<f64>) -> Fit {
        let left = residual - combinations * combinations.tr_mul(residual);
        let squares = self.by_group(|row| left.row(row).norm_squared());
        let changes = self.changes();
        let taken = self.by_group(|row| combinations.row(row).norm_squared() * changes);
        let rest = fit.rest.iter().zip(squares.iter().zip(&taken));
        Fit { rest: rest.map(|([_, freedom], (squares, taken))| [*squares, freedom - taken]).collect(), ..fit.clone() }
    }

    /// Returns a pattern of the rows along a contrast, less its mean over the runs.
    pub(super) fn shift(&self, runs: Runs, pattern: &DVector<f64>) -> DMatrix<f64> {
        let each = DVector::from_fn(self.times.len(), |run, _| self.contrast(runs, run));
        pattern * each.transpose()
    }
}
