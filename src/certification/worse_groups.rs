//! Positions with the same θ that scatter more than the others, although none of them stands out alone.
//!
//! An F test compares them with the others: the residuals of each group from rotations of its own, so that the scatter of one
//! group is not in the residuals of the other. Without any one of the positions the others must scatter more too, below 5 %,
//! because one position is not a group.

use super::Header;
use super::components::{Components, RunModel, Variance};
use super::shared_settings::Setting;
use super::suspects::{OUTLIER, Outlier, STRAGGLER};
use crate::statistics::student::f_beyond;
use nalgebra::DVector;

/// Positions with the same θ that scatter more than the others.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct WorseGroup {
    /// Angle θ that the positions share, deg.
    pub theta_deg: f64,
    /// Standard deviation of these positions over that of the others.
    pub ratio: f64,
    /// Probability that the positions of any θ scatter this much more than the others by chance.
    pub probability: f64,
    /// Variance of the visits to each position, relative to those of the axes.
    pub(crate) scatter: Vec<Variance>,
}

impl WorseGroup {
    /// Returns the variance of the visits to each position relative to the mean of all.
    pub(super) fn relative(&self) -> Vec<f64> {
        let mean = self.scatter.iter().map(|of| of.value).sum::<f64>() / self.scatter.len() as f64;
        self.scatter.iter().map(|of| of.value / mean).collect()
    }
}

/// Returns the least probable group, if its probability is that of an outlier. Positions with `outliers`, which are suspect
/// already, do not count.
pub(super) fn find(header: &Header, components: &Components, outliers: &[Outlier]) -> Option<WorseGroup> {
    let all = &header.positions;
    let angles = Setting::Theta.values(all);
    let number = angles.len() as f64;
    let is_good = |place: &usize| outliers.iter().all(|out| out.place != *place);
    let each = angles.into_iter().filter_map(|theta_deg| {
        let (places, others): (Vec<usize>, Vec<usize>) = (0..all.len()).partition(|at| all[*at].theta_deg == theta_deg);
        let [good, rest] = [&places, &others].map(|group| group.iter().copied().filter(is_good).collect::<Vec<_>>());
        let (square, rest_square) = (mean_square(&good, components)?, mean_square(&rest, components)?);
        let beyond = |of: Variance| {
            f_beyond(of.value / rest_square.value, of.degrees_of_freedom, rest_square.degrees_of_freedom)
        };
        for out in 0..if outliers.is_empty() { good.len() } else { 0 } {
            let left = [&good[..out], &good[out + 1..]].concat();
            mean_square(&left, components).filter(|left| beyond(*left) < STRAGGLER)?;
        }
        let scatter = (0..all.len()).map(|place| if places.contains(&place) { square } else { rest_square }).collect();
        let ratio = (square.value / rest_square.value).sqrt();
        Some(WorseGroup { theta_deg, ratio, probability: (number * beyond(square)).min(1.0), scatter })
    });
    each.filter(|group| group.probability < OUTLIER).min_by(|a, b| a.probability.total_cmp(&b.probability))
}

/// Returns the mean square of the residuals of positions from their own common rotations, relative to the variances of the
/// axes; `None` if these rotations leave no degrees of freedom.
fn mean_square(places: &[usize], components: &Components) -> Option<Variance> {
    let model = RunModel::new(places.iter().map(|place| components.model.turns[*place]).collect())?;
    let keeps = model.keeps()?;
    let (rows, columns) = model.design.shape();
    let residuals = |run: &DVector<f64>| &keeps * DVector::from_fn(rows, |row, _| run[3 * places[row / 3] + row % 3]);
    let square = |(row, residual): (usize, &f64)| residual * residual / components.own_arcsec2[row % 3].value;
    let sum: f64 =
        components.residuals.iter().map(|run| residuals(run).iter().enumerate().map(square).sum::<f64>()).sum();
    let degrees_of_freedom = (rows - columns) as f64 * (components.residuals.len() as f64 - 1.0);
    Some(Variance { value: sum / degrees_of_freedom, degrees_of_freedom })
}
