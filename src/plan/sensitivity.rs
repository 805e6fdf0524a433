//! Errors that all positions share: what they change in the parameters, and what they leave in the residuals.
//!
//! An error e of the misclosures changes the parameters by b = Σ G_p e_p and leaves r_p = e_p − F_p b. It is computed from
//! the sensitivities of the calibration, so nothing here says beforehand which errors a plan can see.

use super::candidates::Design;
use crate::calibration::causes::Cause;
use crate::calibration::sensitivity::Sensitivity;
use crate::text::words;
use crate::units::radians_from_arcseconds;
use serde::Serialize;

words! {
    /// Error that all positions share, in the order of tables; its word is its name.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub(crate) enum CommonError: pub(crate) name {
        Azimuth = "azimuth of the base",
        LevelAboutNorth = "level about north",
        LevelAboutEast = "level about east",
        SeatAboutZ = "gyro seat about z",
        SeatAboutX = "gyro seat about x",
        SeatAboutY = "gyro seat about y",
        Latitude = "latitude",
        Gain = "gain of the meter",
        Offset = "offset of the meter",
    }
}

impl CommonError {
    /// Returns the size for which the effects are stated, and its unit.
    pub(crate) fn size(self) -> (f64, &'static str) {
        match self {
            Self::Azimuth | Self::SeatAboutZ => (30.0, "arcsec"),
            Self::LevelAboutNorth | Self::LevelAboutEast | Self::SeatAboutX | Self::SeatAboutY => (5.0, "arcsec"),
            Self::Latitude => (10.0, "arcsec"),
            Self::Gain => (0.01, "%"),
            Self::Offset => (1e-4, "mA"),
        }
    }

    /// Returns the size in the unit of the sensitivities: rad, share, or mA.
    fn in_model_unit(self) -> f64 {
        let (size, unit) = self.size();
        match unit {
            "arcsec" => radians_from_arcseconds(size),
            "%" => size / 100.0,
            _ => size,
        }
    }

    fn cause(self) -> Cause {
        match self {
            Self::Azimuth => Cause::Azimuth,
            Self::LevelAboutNorth => Cause::Level(1),
            Self::LevelAboutEast => Cause::Level(0),
            Self::SeatAboutZ => Cause::Seat(2),
            Self::SeatAboutX => Cause::Seat(0),
            Self::SeatAboutY => Cause::Seat(1),
            Self::Latitude => Cause::Latitude,
            Self::Gain => Cause::Gain,
            Self::Offset => Cause::Offset,
        }
    }
}

/// Smallest change of a parameter, in units of its tolerance, that counts as an effect.
const SMALLEST_EFFECT: f64 = 1e-3;

/// Effect of an error on a design.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Effect {
    #[serde(skip)]
    pub error: CommonError,
    /// Changes of the parameters in their units, in the order of [`crate::calibration::parameter::Parameter::EIGHT`].
    #[serde(serialize_with = "super::document::by_parameter")]
    pub change: [f64; 8],
    /// Largest change in units of its tolerance.
    pub largest_over_tolerance: f64,
    /// Largest residual, °/h.
    pub largest_residual_deg_per_h: f64,
    /// √(Σ r' C⁻¹ r): the residuals in units of their own noise, the root of the chi-square that they add.
    pub residuals_over_noise: f64,
}

impl Effect {
    /// Returns `true` if the error changes a parameter noticeably, by more than a thousandth of its tolerance.
    pub(crate) fn matters(&self) -> bool {
        self.largest_over_tolerance > SMALLEST_EFFECT
    }

    /// Returns `true` if the residuals that the error leaves are hidden in their noise.
    pub(crate) fn is_hidden(&self) -> bool {
        self.residuals_over_noise < 1.0
    }
}

/// Returns the effect of every common error on a design.
pub(crate) fn effects(design: &Design) -> Vec<Effect> {
    let sensitivity = Sensitivity::new(&design.candidates.setup, &design.candidates.unknowns);
    let each = CommonError::ALL.map(|error| effect(design, &sensitivity, error));
    each.to_vec()
}

fn effect(design: &Design, sensitivity: &Sensitivity, error: CommonError) -> Effect {
    let currents_ma = &design.candidates.currents_ma;
    let misclosure = |place: usize| sensitivity.to(place, &currents_ma[place], error.cause()) * error.in_model_unit();
    let mut over_tolerance = [0.0; 8];
    for (place, _) in design.visited() {
        let (of_axes, misclosure) = (design.response(place), misclosure(place));
        for (response, misclosure) in of_axes.iter().zip(misclosure.iter()) {
            over_tolerance.iter_mut().zip(response).for_each(|(sum, value)| *sum += value * misclosure);
        }
    }
    let (mut largest_residual, mut square) = (0.0_f64, 0.0);
    for (place, _) in design.visited() {
        let residual = misclosure(place) - design.misclosure(place, &over_tolerance);
        largest_residual = largest_residual.max(residual.amax());
        square += design.weighted_square(place, &residual);
    }
    let mut change = over_tolerance;
    change.iter_mut().zip(&design.candidates.tolerance).for_each(|(value, unit)| *value *= unit);
    Effect {
        error,
        change,
        largest_over_tolerance: over_tolerance.iter().fold(0.0, |most, value| most.max(value.abs())),
        largest_residual_deg_per_h: largest_residual,
        residuals_over_noise: square.sqrt(),
    }
}
