//! Axes about which whole runs rotate more than about the others, although the common parts are pooled from all three.

use super::AngleReadings;
use super::components::Components;
use super::rotated_runs::{CommonAxis, RotatedRuns, left_squares, turns};
use super::suspects::OUTLIER;
use crate::calibration::recorded::rounding_of;
use crate::statistics::outlier::cochran_probability;
use crate::statistics::student::student_factor;
use std::ops::Range;

/// Axis about which the runs rotate more than about the other two of platform or base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct UnequalAxis {
    pub axis: CommonAxis,
    /// Standard deviation from run to run about that axis, arcsec.
    pub deviation_arcsec: f64,
    /// Degrees of freedom of `deviation_arcsec`.
    pub degrees_of_freedom: usize,
    /// Standard deviation from run to run about the other two axes, arcsec.
    pub others_arcsec: f64,
    /// Standard uncertainty of type B with which an interval of the normal distribution for the common part, pooled otherwise,
    /// is Student's about the axis, arcsec.
    pub missing_arcsec: f64,
    /// Probability that an axis of platform or base stands out this much by chance.
    pub probability: f64,
}

/// Returns the axes about which the runs, without what is named in `rotated`, rotate more than about the other two: the
/// common parts are pooled from three axes, and too small about such an axis (Cochran's test).
pub(crate) fn find(readings: &AngleReadings, components: &Components, rotated: &[RotatedRuns]) -> Vec<UnequalAxis> {
    let model = &components.model;
    let (squares, degrees_of_freedom) = left_squares(turns(components), rotated);
    let changes = degrees_of_freedom as f64;
    // The variance of a single axis has few degrees of freedom, and those of the common parts are not in the file.
    let widened = student_factor(0.05, changes) / student_factor(0.05, f64::INFINITY);
    // Axes of the base that cannot be distinguished from the platform do not vary, so the others cannot be compared.
    let groups = &[0..3, 3..6][..if components.base_axes == 3 { 2 } else { 1 }];
    let unequal = |axes: &Range<usize>| {
        // The scatter of visits varies the rotations too, by an amount that may differ from axis to axis.
        let of_scatter = |at: usize| {
            let row = if at < 3 {
                model.solve.row(at).into_owned()
            } else {
                model.base_axes.row(at - 3) * model.solve.rows(3, 3)
            };
            row.iter()
                .enumerate()
                .map(|(row, share)| share * share * components.own_arcsec2[row % 3].value)
                .sum::<f64>()
        };
        let parts: Vec<(f64, f64)> = axes.clone().map(|at| (squares[at] / changes, of_scatter(at))).collect();
        let between = parts.iter().map(|(seen, scatter)| seen - scatter).sum::<f64>().max(0.0) / 3.0;
        let relative: Vec<(f64, f64)> = parts.iter().map(|(seen, of)| (seen / (between + of), changes)).collect();
        let worst = (0..3).max_by(|a, b| relative[*a].0.total_cmp(&relative[*b].0))?;
        let (seen, scatter) = parts[worst];
        let own = (seen - scatter).max(0.0);
        Some(UnequalAxis {
            axis: CommonAxis(axes.start + worst),
            deviation_arcsec: own.sqrt(),
            degrees_of_freedom,
            others_arcsec: ((3.0 * between - own) / 2.0).max(0.0).sqrt(),
            missing_arcsec: ((own * widened * widened - between).max(0.0) / readings.runs.len() as f64).sqrt(),
            probability: (groups.len() as f64 * cochran_probability(&relative, worst)).min(1.0),
        })
    };
    // Runs of coarse readings may agree about two axes; a variation within the rounding is none.
    let is_found =
        |at: &UnequalAxis| at.probability < OUTLIER && at.deviation_arcsec > rounding_of(readings.step_arcsec);
    groups.iter().filter_map(unequal).filter(is_found).collect()
}
