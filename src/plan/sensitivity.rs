//! Errors that all positions share: what they change in the parameters, and what they leave in the residuals.
//!
//! An error e of the misclosures changes the parameters by b = Σ G_p e_p and leaves r_p = e_p − F_p b. It is computed from
//! the sensitivities of the calibration, so nothing here says beforehand which errors a plan can see.

use super::candidates::Design;
use crate::calibration::Cause;
use crate::calibration::sensitivity::Sensitivity;
use crate::gyro::{GyroParameters, Parameters};
use crate::units::radians_from_arcseconds;
use nalgebra::SVector;
use serde::{Serialize, Serializer};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CommonError {
    pub cause: Cause,
    pub name: &'static str,
    /// Size for which the effects are stated, in the [unit](Cause::unit) of the cause.
    pub size: f64,
}

/// Errors in the order of tables.
const COMMON_ERRORS: [CommonError; 9] = [
    CommonError { cause: Cause::Azimuth, name: "azimuth of the base", size: 30.0 },
    CommonError { cause: Cause::Level(1), name: "level about north", size: 5.0 },
    CommonError { cause: Cause::Level(0), name: "level about east", size: 5.0 },
    CommonError { cause: Cause::Seat(2), name: "gyro seat about z", size: 30.0 },
    CommonError { cause: Cause::Seat(0), name: "gyro seat about x", size: 5.0 },
    CommonError { cause: Cause::Seat(1), name: "gyro seat about y", size: 5.0 },
    CommonError { cause: Cause::Latitude, name: "latitude", size: 10.0 },
    CommonError { cause: Cause::Gain, name: "gain of the meter", size: 0.01 },
    CommonError { cause: Cause::Offset, name: "offset of the meter", size: 1e-4 },
];

impl CommonError {
    /// Returns the size in the unit of the sensitivities: rad, share, or mA.
    fn in_model_unit(self) -> f64 {
        match self.cause.unit() {
            "arcsec" => radians_from_arcseconds(self.size),
            "%" => self.size / 100.0,
            _ => self.size,
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
    #[serde(serialize_with = "by_parameter")]
    pub change: [f64; 8],
    pub largest_over_tolerance: f64,
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

pub(crate) fn effects(design: &Design) -> Vec<Effect> {
    let sensitivity = Sensitivity::new(&design.candidates.setup, &design.candidates.unknowns);
    COMMON_ERRORS.map(|error| effect(design, &sensitivity, error)).to_vec()
}

fn effect(design: &Design, sensitivity: &Sensitivity, error: CommonError) -> Effect {
    let currents_ma = &design.candidates.currents_ma;
    let misclosure = |place: usize| sensitivity.to(place, &currents_ma[place], error.cause) * error.in_model_unit();
    let mut over_tolerance = SVector::<f64, 8>::zeros();
    for (place, _) in design.visited() {
        let (response, misclosure) = (design.response(place), misclosure(place));
        (0..2).for_each(|axis| over_tolerance += response.column(axis) * misclosure[axis]);
    }
    let (mut largest_residual, mut square) = (0.0_f64, 0.0);
    for (place, _) in design.visited() {
        let residual = misclosure(place) - design.misclosure(place, &over_tolerance);
        largest_residual = largest_residual.max(residual.amax());
        square += design.weighted_square(place, &residual);
    }
    Effect {
        error,
        change: over_tolerance.component_mul(&SVector::from(design.candidates.tolerance)).into(),
        largest_over_tolerance: over_tolerance.amax(),
        largest_residual_deg_per_h: largest_residual,
        residuals_over_noise: square.sqrt(),
    }
}

pub(super) fn parameters(values: &[f64; 8]) -> Parameters {
    Parameters::of(&GyroParameters::from_vector(values))
}

/// Writes numbers in the order of [`Parameter::EIGHT`](crate::calibration::Parameter::EIGHT) under the keys of a gyro type.
pub(super) fn by_parameter<S: Serializer>(values: &[f64; 8], serializer: S) -> Result<S::Ok, S::Error> {
    parameters(values).serialize(serializer)
}
