//! Positions of a template: the paper's, or those of a plan.

use crate::certification::NominalPosition;
use crate::coefficients::{EIGHT_POSITIONS, PositionIndex};
use crate::plan::document::Planned;

/// Positions of a plan, or without one the paper's eight.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Positions(pub Option<Planned>);

/// Angles of the frame, degrees, of i = 1, 2, …; the first two are the paper's.
const FRAME_DEG: [f64; 6] = [0.0, 90.0, 180.0, 270.0, 45.0, 225.0];

/// Angles of the platform, degrees, of j = 1, 2, …; these are the paper's.
const PLATFORM_DEG: [f64; 4] = [0.0, 90.0, 180.0, 270.0];

impl Positions {
    /// Returns the positions, each once.
    pub(super) fn nominal(&self) -> Vec<NominalPosition> {
        let of_the_paper = |(PositionIndex { i, j }, theta_deg, phi_deg)| NominalPosition { i, j, theta_deg, phi_deg };
        self.0.as_ref().map_or_else(|| EIGHT_POSITIONS.map(of_the_paper).to_vec(), planned)
    }

    /// Returns the positions in the order of the visits of one run: as often as a plan visits them, otherwise once.
    pub(super) fn visits(&self) -> Vec<NominalPosition> {
        let all = self.nominal();
        let Some(plan) = &self.0 else { return all };
        let of = |angles: &[f64; 2]| all.iter().find(|at| [at.theta_deg, at.phi_deg] == *angles).cloned();
        plan.order.iter().filter_map(of).collect()
    }

    /// Returns the azimuth of the frame's axis, degrees clockwise from north, or `None` without a plan.
    pub(super) fn frame_axis_azimuth_deg(&self) -> Option<f64> {
        self.0.as_ref().map(|plan| plan.frame_axis_azimuth_deg)
    }

    /// Returns the remark above the positions of a file.
    pub(super) fn remark(&self) -> String {
        match self.frame_axis_azimuth_deg() {
            None => "# The paper's eight positions.\n".to_owned(),
            Some(azimuth) => format!(
                "# Positions of the plan, which is for a frame's axis at azimuth {azimuth} degrees: state it in the site.\n"
            ),
        }
    }

    /// Returns the rows of `positions` in a file; `rest` is what follows the nominal angles.
    pub(super) fn rows(&self, rest: &str) -> String {
        let row = |NominalPosition { i, j, theta_deg, phi_deg }| {
            format!("  - {{i: {i}, j: {j}, theta_deg: {theta_deg}, phi_deg: {phi_deg}{rest}}}\n")
        };
        self.nominal().into_iter().map(row).collect()
    }
}

/// Returns the positions of a plan, sorted by their indices: those of the stand that was planned for, otherwise the
/// paper's for its angles and the next ones for all others.
fn planned(plan: &Planned) -> Vec<NominalPosition> {
    let (mut frames, mut platforms) = (FRAME_DEG.to_vec(), PLATFORM_DEG.to_vec());
    let number = |of: &mut Vec<f64>, angle_deg: f64| {
        let at = of.iter().position(|known| *known == angle_deg).unwrap_or_else(|| {
            of.push(angle_deg);
            of.len() - 1
        });
        u32::try_from(at + 1).unwrap_or(u32::MAX)
    };
    let each = plan.readings.iter().map(|at| {
        let (theta_deg, phi_deg) = (at.theta_deg, at.phi_deg);
        let new = || PositionIndex { i: number(&mut frames, theta_deg), j: number(&mut platforms, phi_deg) };
        let PositionIndex { i, j } = at.index().unwrap_or_else(new);
        NominalPosition { i, j, theta_deg, phi_deg }
    });
    let mut found: Vec<NominalPosition> = each.collect();
    found.sort_by_key(NominalPosition::index);
    found
}
