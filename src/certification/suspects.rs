//! A position that scatters more than the others, a reading that is out: named, never dropped.

use super::Header;
use super::components::Components;
use crate::coefficients::PositionIndex;
use crate::statistics::outlier::{Bartlett, bartlett, grubbs_probability};

/// What is less probable than this is named (a straggler, by [ISO 5725-2](crate::bibliography::Bibliography::Iso5725)).
pub const STRAGGLER: f64 = 0.05;

/// What is less probable than this is called an outlier.
pub const OUTLIER: f64 = 0.01;

/// The names of the axes of the case, in whose turns scatter is measured.
pub const AXES: [&str; 3] = ["x", "y", "z"];

/// A position that is worse than the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorsePosition {
    /// Which.
    pub index: PositionIndex,
    /// Its standard deviation over that of all positions.
    pub ratio: f64,
}

/// A reading that is out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outlier {
    /// Which position.
    pub index: PositionIndex,
    /// Which run.
    pub run: u32,
    /// About which axis of the case: 0, 1, 2 for x, y, z (α, β, γ of a small deviation).
    pub axis: usize,
    /// How far it is from what the other readings let expect, arcsec.
    pub residual_arcsec: f64,
    /// Probability that any reading of the series is so far out by chance.
    pub probability: f64,
}

/// What the tests say.
#[derive(Debug, Clone, PartialEq)]
pub struct Suspects {
    /// Whether all positions scatter alike; `None` when the test cannot be made.
    pub positions: Option<Bartlett>,
    /// Whether x, y and z scatter alike.
    pub axes: Option<Bartlett>,
    /// The worst position, when they do not scatter alike.
    pub worse: Option<WorsePosition>,
    /// Readings that are out, the least probable first.
    pub outliers: Vec<Outlier>,
}

impl Suspects {
    pub(crate) fn of(header: &Header, runs: &[u32], components: &Components) -> Self {
        let groups = |variances: &[super::Variance]| -> Vec<(f64, f64)> {
            variances.iter().map(|v| (v.value, v.degrees_of_freedom)).collect()
        };
        let positions = bartlett(&groups(&components.position_squares));
        let differ = positions.is_some_and(|test| test.probability < STRAGGLER);
        let each = header.positions.iter().zip(&components.position_squares);
        let worst = each.max_by(|(_, a), (_, b)| a.value.total_cmp(&b.value));
        let worse = worst.filter(|_| differ);
        Self {
            positions,
            axes: bartlett(&groups(&components.axis_squares_arcsec2)),
            worse: worse.map(|(at, variance)| WorsePosition { index: at.index(), ratio: variance.value.sqrt() }),
            outliers: outliers(header, runs, components),
        }
    }

    /// A sentence for everything that is suspect.
    pub(crate) fn warnings(&self) -> Vec<String> {
        let mut said = Vec::new();
        if let (Some(worse), Some(test)) = (&self.worse, &self.positions) {
            said.push(format!(
                "{}: position {} scatters {:.1} times as much as all together (Bartlett's test: probability {:.2e}); \
                 every position therefore states its own scatter",
                grade(test.probability),
                worse.index,
                worse.ratio,
                test.probability
            ));
        }
        for out in &self.outliers {
            said.push(format!(
                "{}: position {}, run {}, is {:+.2} arcsec out about {} (Grubbs' test: probability {:.2e}); it was kept",
                grade(out.probability),
                out.index,
                out.run,
                out.residual_arcsec,
                AXES[out.axis],
                out.probability
            ));
        }
        if let Some(test) = self.axes.filter(|test| test.probability < OUTLIER) {
            said.push(format!(
                "x, y and z do not scatter alike (Bartlett's test: probability {:.2e}): repeatability_arcsec is their root mean \
                 square, too large for one axis and too small for another",
                test.probability
            ));
        }
        said
    }
}

fn grade(probability: f64) -> &'static str {
    if probability < OUTLIER { "outlier" } else { "straggler" }
}

/// Readings whose residual no chance explains: Grubbs' test over all readings, each axis by its own scatter.
fn outliers(header: &Header, runs: &[u32], components: &Components) -> Vec<Outlier> {
    let mut found = Vec::new();
    let values = runs.len() * components.kept.len();
    // A difference from the mean of R runs keeps 1 − 1/R of a reading's variance.
    let of_mean = 1.0 - 1.0 / runs.len() as f64;
    for (run, residuals) in runs.iter().zip(&components.residuals) {
        for (row, residual) in residuals.iter().enumerate() {
            let scatter = &components.axis_squares_arcsec2[row % 3];
            let g = residual.abs() / (scatter.value * components.kept[row] * of_mean).sqrt();
            let probability = grubbs_probability(g, values, scatter.degrees_of_freedom);
            if probability < STRAGGLER {
                let (index, axis) = (header.positions[row / 3].index(), row % 3);
                found.push(Outlier { index, run: *run, axis, residual_arcsec: *residual, probability });
            }
        }
    }
    found.sort_by(|a, b| {
        a.probability.total_cmp(&b.probability).then(b.residual_arcsec.abs().total_cmp(&a.residual_arcsec.abs()))
    });
    found
}
