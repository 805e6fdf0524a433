//! What a calibration takes for known: coefficients, and how uncertain everything that stands behind them is.

use crate::attitude::{self, Deviation};
use crate::coefficients::{Coefficients, EarthRate, Position, SingularPositions, StandGeometry};
use crate::laboratory::Meter;
use nalgebra::{Matrix3, Vector3};

/// Standard uncertainties of everything that enters a calibration. Zero is "exact".
///
/// Parts that are shared by several readings are kept apart from those of each reading, so nothing counts twice.
#[derive(Debug, Clone, PartialEq)]
pub struct InputUncertainty {
    /// Of the certified α, β, γ of every position, its own part; in the order of the coefficients. Positions beyond
    /// its end are exact.
    pub angles_rad: Vec<[f64; 3]>,
    /// Degrees of freedom of the three uncertainties of every position; positions beyond its end have infinitely many.
    pub angles_degrees_of_freedom: Vec<f64>,
    /// Of one return to a position, per axis of the platform; every visit returns once.
    pub repeatability_rad: f64,
    /// Degrees of freedom of that one estimate.
    pub repeatability_degrees_of_freedom: f64,
    /// Shared by all positions, per axis of the platform (turns E·A from the left).
    pub common_platform_rad: f64,
    /// Degrees of freedom of that one estimate.
    pub common_platform_degrees_of_freedom: f64,
    /// Shared by all positions, per axis of the base (turns it from the right).
    pub common_base_rad: f64,
    /// Degrees of freedom of that one estimate.
    pub common_base_degrees_of_freedom: f64,
    /// Of the latitude as stated.
    pub latitude_rad: f64,
    /// Of ξ, through which a geodetic latitude becomes the astronomic one.
    pub deflection_rad: f64,
    /// Of the base's azimuth: from the mark, or whatever gives north, to the base.
    pub azimuth_rad: f64,
    /// Of the azimuth from the pillar to the mark.
    pub mark_rad: f64,
    /// Of the base's level, about east and about north.
    pub level_rad: f64,
    /// Of the gyro's seat, about x, y and z of the case.
    pub seating_rad: [f64; 3],
    /// Of the currents.
    pub meter: MeterUncertainty,
}

/// Standard uncertainties of the currents.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeterUncertainty {
    /// The meter's specification, own of each position and channel, as a share of the reading. Reading again does not
    /// make it smaller.
    pub reading: f64,
    /// The part of the specification that does not depend on the size of the reading, mA; positive.
    pub floor_ma: f64,
    /// Noise of every single reading, mA; 0 where it is not stated.
    pub noise_ma: f64,
    /// Of the gain that all readings share.
    pub gain: f64,
    /// Of the offset that all readings share.
    pub offset_ma: f64,
}

impl From<&Meter> for MeterUncertainty {
    fn from(meter: &Meter) -> Self {
        Self {
            reading: meter.reading_percent / 100.0,
            floor_ma: meter.floor_ma,
            noise_ma: meter.noise_ma.unwrap_or(0.0),
            gain: meter.gain_percent / 100.0,
            offset_ma: meter.offset_ma,
        }
    }
}

impl MeterUncertainty {
    /// Returns the variance that the specification gives the current `current_ma` of one position and channel, mA².
    pub(crate) fn own_variance_ma2(&self, current_ma: f64) -> f64 {
        let share = self.reading * current_ma;
        share * share + self.floor_ma * self.floor_ma
    }
}

impl InputUncertainty {
    /// A meter on an exact stand at an exact place.
    pub fn of_meter(meter: MeterUncertainty) -> Self {
        Self {
            angles_rad: Vec::new(),
            angles_degrees_of_freedom: Vec::new(),
            repeatability_rad: 0.0,
            repeatability_degrees_of_freedom: f64::INFINITY,
            common_platform_rad: 0.0,
            common_platform_degrees_of_freedom: f64::INFINITY,
            common_base_rad: 0.0,
            common_base_degrees_of_freedom: f64::INFINITY,
            latitude_rad: 0.0,
            deflection_rad: 0.0,
            azimuth_rad: 0.0,
            mark_rad: 0.0,
            level_rad: 0.0,
            seating_rad: [0.0; 3],
            meter,
        }
    }
}

/// The stand at its site as a calibration takes it.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    coefficients: Coefficients,
    turns: Vec<Turn>,
    earth: EarthRate,
    uncertainty: InputUncertainty,
}

/// How one position turns when its angles change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Turn {
    /// Ã, 3×3, base to case.
    pub(crate) attitude: Matrix3<f64>,
    /// A, 3×3.
    pub(crate) nominal: Matrix3<f64>,
    /// Certified α, β, γ.
    pub(crate) certified: Deviation,
    /// The axes, in case coordinates, that α, β and γ turn about: E = Rz(γ)·Ry(β)·Rx(α).
    pub(crate) axes: [Vector3<f64>; 3],
}

/// Why there is no setup.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoSetup {
    /// n_2 has no inverse.
    #[error(transparent)]
    Singular(#[from] SingularPositions),
    /// A standard uncertainty that is none.
    #[error("the standard uncertainty of {0} is {1}, but must be finite and ≥ 0")]
    Uncertainty(&'static str, f64),
    /// Degrees of freedom that are none.
    #[error("the degrees of freedom of {0} are {1}, but must be positive")]
    DegreesOfFreedom(&'static str, f64),
}

impl InputUncertainty {
    /// Whether every number is one that an uncertainty can be.
    fn check(&self) -> Result<(), NoSetup> {
        let angles = self.angles_rad.iter().flatten().map(|u| ("a certified angle", *u));
        let seat = self.seating_rad.map(|u| ("the gyro seat", u));
        let rest = [
            ("the repeatability", self.repeatability_rad),
            ("the platform", self.common_platform_rad),
            ("the base of the stand", self.common_base_rad),
            ("the latitude", self.latitude_rad),
            ("the deflection", self.deflection_rad),
            ("the azimuth", self.azimuth_rad),
            ("the mark", self.mark_rad),
            ("the level", self.level_rad),
            ("a reading", self.meter.reading),
            ("the floor of the meter", self.meter.floor_ma),
            ("the noise of the meter", self.meter.noise_ma),
            ("the gain of the meter", self.meter.gain),
            ("the offset of the meter", self.meter.offset_ma),
        ];
        let is_none = |(_, u): &(&str, f64)| !(u.is_finite() && *u >= 0.0);
        if let Some((what, u)) = angles.chain(seat).chain(rest).find(is_none) {
            return Err(NoSetup::Uncertainty(what, u));
        }
        let known = self.angles_degrees_of_freedom.iter().map(|known| ("a certified angle", *known));
        let known = known.chain([
            ("the repeatability", self.repeatability_degrees_of_freedom),
            ("the platform", self.common_platform_degrees_of_freedom),
            ("the base of the stand", self.common_base_degrees_of_freedom),
        ]);
        match known.into_iter().find(|(_, known)| known.is_nan() || *known <= 0.0) {
            Some((what, known)) => Err(NoSetup::DegreesOfFreedom(what, known)),
            None => Ok(()),
        }
    }
}

impl Setup {
    /// `positions` of a stand at a place with the Earth rate `earth`.
    ///
    /// # Errors
    /// See [`NoSetup`].
    pub fn new(positions: &[Position], earth: EarthRate, uncertainty: InputUncertainty) -> Result<Self, NoSetup> {
        uncertainty.check()?;
        let coefficients = StandGeometry::new(positions)?.at(earth);
        Ok(Self { coefficients, turns: positions.iter().map(Turn::of).collect(), earth, uncertainty })
    }

    /// What the mathematics takes.
    pub fn coefficients(&self) -> &Coefficients {
        &self.coefficients
    }

    /// How uncertain everything is.
    pub fn uncertainty(&self) -> &InputUncertainty {
        &self.uncertainty
    }

    /// The same without one position; the paper's matrices are gone with it.
    pub(crate) fn without(&self, place: usize) -> Self {
        let mut rest = self.clone();
        rest.coefficients.positions.remove(place);
        rest.coefficients.matrices = None;
        rest.turns.remove(place);
        if place < rest.uncertainty.angles_rad.len() {
            rest.uncertainty.angles_rad.remove(place);
        }
        if place < rest.uncertainty.angles_degrees_of_freedom.len() {
            rest.uncertainty.angles_degrees_of_freedom.remove(place);
        }
        rest
    }

    pub(crate) fn turns(&self) -> &[Turn] {
        &self.turns
    }

    /// The Earth rate in base axes: east, north, up.
    pub(crate) fn earth_rate_in_base(&self) -> Vector3<f64> {
        Vector3::new(0.0, self.earth.horizontal_deg_per_h, self.earth.vertical_deg_per_h)
    }
}

impl Turn {
    pub(crate) fn of(position: &Position) -> Self {
        let deviation = attitude::deviation(&position.deviation);
        let (sin_gamma, cos_gamma) = libm::sincos(position.deviation.gamma_rad);
        let nominal = attitude::nominal(position.theta_deg, position.phi_deg);
        Self {
            attitude: deviation * nominal,
            nominal,
            certified: position.deviation,
            // α turns before β and γ: its axis is E's first column. β's is turned by γ alone, γ's stays.
            axes: [deviation.column(0).into_owned(), Vector3::new(sin_gamma, cos_gamma, 0.0), Vector3::z()],
        }
    }
}
