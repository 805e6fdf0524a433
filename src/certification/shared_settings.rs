//! Settings of an angle that several positions of a run share, although their errors are taken as independent.
//!
//! If θ is set once for all positions with the same θ, its error rotates them alike about the axis of the frame; φ that is
//! set once rotates its positions about z of the platform. The readings of a run show the differences of these rotations.
//! They are compared with what remains of the residuals (F test), also without each run in turn.

use super::Header;
use super::components::{Components, by_axis};
use super::header::NominalPosition;
use super::suspects::OUTLIER;
use crate::calibration::inputs::Turn;
use crate::statistics::student::{effective_degrees_of_freedom, f_larger};
use crate::text::words;
use nalgebra::{DMatrix, DVector, Vector3};

words! {
    /// Angle that is set.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub(crate) enum Setting: pub(crate) key {
        /// Angle θ of the frame.
        Theta = "theta",
        /// Angle φ of the platform.
        Phi = "phi",
    }
}

impl Setting {
    pub(crate) fn symbol(self) -> &'static str {
        if self == Self::Theta { "θ" } else { "φ" }
    }

    /// Returns the nominal value of the angle in a position, degrees.
    pub(super) fn of(self, at: &NominalPosition) -> f64 {
        if self == Self::Theta { at.theta_deg } else { at.phi_deg }
    }

    /// Returns the nominal values of the angle in the positions, ascending, degrees.
    pub(super) fn values(self, positions: &[NominalPosition]) -> Vec<f64> {
        let mut values: Vec<f64> = positions.iter().map(|at| self.of(at)).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values
    }

    /// Returns the axis of the angle, along the axes of the case.
    pub(super) fn axis(self, turn: &Turn) -> Vector3<f64> {
        match self {
            // The axis of the frame does not turn with θ: along the base it is x.
            Self::Theta => turn.attitude.column(0).into_owned(),
            Self::Phi => Vector3::z(),
        }
    }
}

/// Error of a setting that positions share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SharedSetting {
    pub setting: Setting,
    /// Standard deviation of the error from run to run, arcsec.
    pub deviation_arcsec: f64,
    /// Probability that the errors of either angle seem to be shared this much by chance.
    pub probability: f64,
}

pub(crate) fn find(header: &Header, components: &Components) -> Vec<SharedSetting> {
    let each = Setting::ALL.into_iter().filter_map(|setting| of(setting, header, components));
    each.filter(|at| at.probability < OUTLIER).collect()
}

fn of(setting: Setting, header: &Header, components: &Components) -> Option<SharedSetting> {
    let turns = &components.model.turns;
    let angle = |at: &NominalPosition| setting.of(at);
    let mut values = setting.values(&header.positions);
    let count = |value: f64| header.positions.iter().filter(|at| angle(at) == value).count();
    values.retain(|value| count(*value) > 1);
    if values.is_empty() {
        return None;
    }
    // Rotation of the positions with each value, as rotations of the case.
    let mut rotations = DMatrix::zeros(3 * turns.len(), values.len());
    for (place, (at, turn)) in header.positions.iter().zip(turns).enumerate() {
        if let Some(column) = values.iter().position(|value| *value == angle(at)) {
            rotations.fixed_view_mut::<3, 1>(3 * place, column).copy_from(&setting.axis(turn));
        }
    }
    let shared = components.combinations(&rotations)?.shared;
    let length = shared.tr_mul(&rotations).norm_squared();
    let runs = &components.residuals;
    // An error that is shared shows in every run, one wrong reading only in its own.
    let without = |run: usize| {
        let others = runs.iter().enumerate().filter(|(other, _)| *other != run).map(|(_, residual)| residual);
        test(&others.collect::<Vec<_>>(), &shared, &components.keeps).map(|(_, p)| p)
    };
    let p = (0..runs.len()).map(without).collect::<Option<Vec<_>>>()?.into_iter().fold(0.0, f64::max);
    let (variance, _) = test(&runs.iter().collect::<Vec<_>>(), &shared, &components.keeps)?;
    Some(SharedSetting {
        setting,
        deviation_arcsec: (variance / length).sqrt(),
        probability: (Setting::ALL.len() as f64 * p).min(1.0),
    })
}

/// Returns the variance of the residuals of runs in the `shared` combinations beyond that by chance, and the probability of a
/// larger one by chance; `None` if there are too few runs.
fn test(runs: &[&DVector<f64>], shared: &DMatrix<f64>, keeps: &DMatrix<f64>) -> Option<(f64, f64)> {
    let changes = runs.len() as f64 - 1.0;
    let mean = runs.iter().copied().sum::<DVector<f64>>() / runs.len() as f64;
    let mut seen = 0.0;
    let mut rest = [0.0; 3];
    for run in runs {
        let residual = *run - &mean;
        let effect = shared.tr_mul(&residual);
        seen += effect.norm_squared() / changes;
        for (row, left) in (residual - shared * effect).iter().enumerate() {
            rest[row % 3] += left * left;
        }
    }
    // Share of each axis in the combinations, and what they leave of its degrees of freedom.
    let share = |row: usize| shared.row(row).norm_squared();
    let shares = by_axis((0..shared.nrows()).map(share));
    let freedom = by_axis((0..shared.nrows()).map(|row| (keeps[(row, row)] - share(row)) * changes));
    let numerator = shared.ncols() * (runs.len() - 1);
    if numerator == 0 || freedom.iter().any(|freedom| *freedom <= 0.0) {
        return None;
    }
    let due = [0, 1, 2].map(|axis| shares[axis] * rest[axis] / freedom[axis]);
    let by_chance: f64 = due.iter().sum();
    let contributions = [0, 1, 2].map(|axis| (due[axis].sqrt(), freedom[axis]));
    let p = f_larger(seen / by_chance, numerator, effective_degrees_of_freedom(&contributions));
    Some(((seen - by_chance).max(0.0), p))
}
