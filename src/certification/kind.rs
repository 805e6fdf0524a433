//! Kinds of findings, the parts of a stand and the settings that they concern, and the probabilities at which they are reported.

use super::header::NominalPosition;
use crate::calibration::inputs::Turn;
use crate::text::words;
use crate::wording::Text;
use crate::wording::texts::findings as texts;
use nalgebra::Vector3;

/// Largest difference from the other runs, in steps of the readings, that rounding explains: one step, if both are within
/// half a step of it.
pub(super) const STEPS_OF_ROUNDING: f64 = 1.5;

/// Probability below which a finding is reported: a straggler in
/// [ISO 5725-2](crate::bibliography::Bibliography::Iso5725).
pub(crate) const STRAGGLER: f64 = 0.05;

/// Probability below which a finding accuses: an outlier.
pub(crate) const OUTLIER: f64 = 0.01;

/// Names of the axes of the case about which scatter is computed.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];

words! {
    /// Kind of a finding.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub(crate) enum Kind: pub(crate) code {
        Angle = "angle",
        Reading = "reading",
        Bump = "bump",
        RunTurned = "run_turned",
        StandMoved = "stand_moved",
        StandDrift = "stand_drift",
        PositionMoved = "position_moved",
        PositionScatter = "position_scatter",
        SettingScatter = "setting_scatter",
        SharedSetting = "shared_setting",
        AxisScatter = "axis_scatter",
        RunAxisScatter = "run_axis_scatter",
        Unit = "unit",
        ColumnReversed = "column_reversed",
        ColumnsExchanged = "columns_exchanged",
        RowsExchanged = "rows_exchanged",
        ChannelCopied = "channel_copied",
        ChannelConstant = "channel_constant",
        RunsCopied = "runs_copied",
        Computed = "computed",
        Chance = "chance",
        StandChanged = "stand_changed",
        CommonTurn = "common_turn",
        PositionJump = "position_jump",
        PositionDrift = "position_drift",
    }
}

words! {
    /// Part of the stand that rotates.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub(crate) enum Part: pub(crate) key {
        Platform = "platform",
        Base = "base",
    }
}

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

impl Part {
    pub(crate) fn axes(self) -> Text {
        if self == Self::Base { texts::AXES_OF_BASE } else { texts::AXES_OF_PLATFORM }
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
