//! Inputs of a calibration: the coefficients, and the standard uncertainties of everything behind them.

use super::readings::Readings;
use crate::attitude::{self, Deviation};
use crate::coefficients::{
    Coefficients, EIGHT_POSITIONS, EarthRate, Position, PositionCoefficients, PositionIndex, SingularPositions,
    StandGeometry,
};
use crate::gyro::GyroNoise;
use crate::laboratory::Meter;
use crate::units::sin_cos_of_degrees;
use nalgebra::{Matrix3, Vector3};
use std::borrow::Cow;

/// Standard uncertainties of all inputs of a calibration. Zero means exact.
///
/// Parts common to several readings are kept separate from those of each reading, so that nothing counts twice.
#[derive(Debug, Clone, PartialEq)]
pub struct InputUncertainty {
    /// Standard uncertainties of the certified α, β, γ of each position, rad: own parts only, in the order of the
    /// coefficients. Positions beyond the end of the list are exact.
    pub angles_rad: Vec<[f64; 3]>,
    /// Degrees of freedom of the three angle uncertainties of each position; infinite for positions beyond the end.
    pub angles_degrees_of_freedom: Vec<f64>,
    /// Repeatability of positioning: standard deviation of one visit, rad, per axis of the platform.
    pub repeatability_rad: f64,
    /// Degrees of freedom of the repeatability.
    pub repeatability_degrees_of_freedom: f64,
    /// Standard uncertainty common to all positions, rad, per axis of the platform (rotation applied to E·A from the
    /// left).
    pub common_platform_rad: f64,
    /// Degrees of freedom of the common part of the platform.
    pub common_platform_degrees_of_freedom: f64,
    /// Standard uncertainty common to all positions, rad, per axis of the base (rotation applied from the right).
    pub common_base_rad: f64,
    /// Degrees of freedom of the common part of the base.
    pub common_base_degrees_of_freedom: f64,
    /// Standard uncertainty of the latitude as stated, rad.
    pub latitude_rad: f64,
    /// Standard uncertainty of ξ, which converts a geodetic latitude to the astronomic one, rad.
    pub deflection_rad: f64,
    /// Standard uncertainty of the azimuth of the base relative to the mark or other north reference, rad.
    pub azimuth_rad: f64,
    /// Standard uncertainty of the azimuth from the pillar to the mark, rad.
    pub mark_rad: f64,
    /// Standard uncertainty of the level of the base, rad, per axis (about east and about north).
    pub level_rad: f64,
    /// Standard uncertainties of the gyro seat, rad: rotations about x, y and z of the case.
    pub seating_rad: [f64; 3],
    /// Standard uncertainties of the currents.
    pub meter: MeterUncertainty,
    /// Noise of the gyro's drift from visit to visit, each axis, °/h; `None` if it is not stated.
    pub visit_deg_per_h: Option<f64>,
    /// Noise of ω_0 from one turn-on of the gyro to the next, each axis, °/h; `None` if it is not stated.
    pub turn_on_deg_per_h: Option<f64>,
}

/// Standard uncertainties of the current meter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeterUncertainty {
    /// Specification as a fraction of the reading; independent for each position and channel, and not reduced by
    /// repeated readings.
    pub reading: f64,
    /// Floor: part of the specification that does not depend on the reading, mA; positive.
    pub floor_ma: f64,
    /// Noise of a single reading, mA; 0 if it is not stated.
    pub noise_ma: f64,
    /// Relative standard uncertainty of the gain, common to all readings.
    pub gain: f64,
    /// Standard uncertainty of the offset, common to all readings, mA.
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
    /// Returns the variance of a current by the specification, mA²; independent for each position and channel.
    pub(crate) fn own_variance_ma2(&self, current_ma: f64) -> f64 {
        let share = self.reading * current_ma;
        share * share + self.floor_ma * self.floor_ma
    }
}

impl InputUncertainty {
    /// Creates the uncertainties of a calibration with this meter, on an exact stand at an exact site.
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
            visit_deg_per_h: None,
            turn_on_deg_per_h: None,
        }
    }
}

/// A stand at its site with all uncertainties: the input of a calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    coefficients: Coefficients,
    pub(crate) turns: Vec<Turn>,
    earth: EarthRate,
    uncertainty: InputUncertainty,
}

/// Orientation of one position, and the axes about which its angles rotate it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Turn {
    /// Ã = E·A·Rz(90° − ψ): rotation matrix, east-north-up to case axes, 3×3.
    pub(crate) attitude: Matrix3<f64>,
    /// A·Rz(90° − ψ): nominal rotation matrix, east-north-up to platform axes, 3×3.
    pub(crate) nominal: Matrix3<f64>,
    /// Nominal θ and φ.
    pub(crate) angles_deg: [f64; 2],
    /// Certified deviation α, β, γ.
    pub(crate) certified: Deviation,
    /// Axes of the rotations α, β and γ, in case coordinates; E = Rz(γ)·Ry(β)·Rx(α).
    pub(crate) axes: [Vector3<f64>; 3],
}

/// Reason why a [`Setup`] cannot be created.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoSetup {
    /// The matrix n_2 has no inverse.
    #[error(transparent)]
    Singular(#[from] SingularPositions),
    /// A standard uncertainty that is negative or not finite, with its name.
    #[error("the standard uncertainty of {0} is {1}, but must be finite and ≥ 0")]
    Uncertainty(&'static str, f64),
    /// Degrees of freedom that are not positive, with the name of their quantity.
    #[error("the degrees of freedom of {0} are {1}, but must be positive")]
    DegreesOfFreedom(&'static str, f64),
}

impl InputUncertainty {
    /// Checks that every uncertainty is finite and not negative, and all degrees of freedom are positive.
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
            ("the noise of the gyro from visit to visit", self.visit_deg_per_h.unwrap_or(0.0)),
            ("the noise of the gyro from turn-on to turn-on", self.turn_on_deg_per_h.unwrap_or(0.0)),
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
    /// Creates the setup of a stand with `positions` at a site with the Earth rate `earth`.
    ///
    /// # Errors
    /// Returns [`NoSetup`] if n_2 of the eight positions has no inverse, or an uncertainty or its degrees of freedom
    /// are invalid.
    pub fn new(positions: &[Position], earth: EarthRate, uncertainty: InputUncertainty) -> Result<Self, NoSetup> {
        uncertainty.check()?;
        let coefficients = StandGeometry::new(positions)?.at(earth);
        let base = attitude::base(earth.frame_axis_azimuth_deg);
        Ok(Self { coefficients, turns: positions.iter().map(|at| Turn::of(at, &base)).collect(), earth, uncertainty })
    }

    /// Returns the setup with the noise that the type of the gyro states; without one it is left out of account, or
    /// estimated from repeated readings.
    #[must_use]
    pub(crate) fn of_gyro(self, noise: Option<&GyroNoise>) -> Self {
        self.with(|u| {
            u.visit_deg_per_h = noise.and_then(|noise| noise.visit_deg_per_h);
            u.turn_on_deg_per_h = noise.and_then(|noise| noise.turn_on_deg_per_h);
        })
    }

    /// Returns the setup with other uncertainties, all of them still finite and not negative.
    #[must_use]
    pub(crate) fn with(mut self, change: impl FnOnce(&mut InputUncertainty)) -> Self {
        change(&mut self.uncertainty);
        self
    }

    /// Returns the coefficients of the calibration equations.
    pub fn coefficients(&self) -> &Coefficients {
        &self.coefficients
    }

    /// Returns the standard uncertainties of all inputs.
    pub fn uncertainty(&self) -> &InputUncertainty {
        &self.uncertainty
    }

    /// Returns the setup with the positions that have readings, and with the rounding of the readings where it is larger
    /// than the floor of the meter. The analytic and iterative methods need all of the paper's eight positions.
    pub(crate) fn of_readings(&self, readings: &Readings) -> Cow<'_, Self> {
        let recorded = readings.recorded.applied_to(self);
        let is_left_out = |index: &PositionIndex| readings.left_out.contains(index);
        let positions = &self.coefficients.positions;
        let places: Vec<usize> = (0..positions.len()).filter(|place| !is_left_out(&positions[*place].index)).collect();
        if places.len() == positions.len() {
            return recorded;
        }
        let mut rest = recorded.at(&places);
        if !EIGHT_POSITIONS.iter().any(|(index, ..)| is_left_out(index)) {
            rest.coefficients.matrices = self.coefficients.matrices;
        }
        Cow::Owned(rest)
    }

    /// Returns a copy with only the positions `places`, in ascending order, and without Δ, B, C.
    pub(crate) fn at(&self, places: &[usize]) -> Self {
        let Self { coefficients, turns, earth, uncertainty } = self;
        let uncertainty = InputUncertainty {
            angles_rad: at_places(&uncertainty.angles_rad, places),
            angles_degrees_of_freedom: at_places(&uncertainty.angles_degrees_of_freedom, places),
            ..uncertainty.clone()
        };
        let coefficients = Coefficients { positions: at_places(&coefficients.positions, places), matrices: None };
        Self { coefficients, turns: at_places(turns, places), earth: *earth, uncertainty }
    }

    /// Returns a copy with the frame's axis rotated clockwise by this many degrees, and without Δ, B, C.
    pub(crate) fn turned(&self, by_deg: f64) -> Self {
        let base = attitude::base(90.0 + by_deg);
        let frame_axis_azimuth_deg = self.earth.frame_axis_azimuth_deg + by_deg;
        self.changed_to(EarthRate { frame_axis_azimuth_deg, ..self.earth }, |turn, _| {
            turn.attitude *= base;
            turn.nominal *= base;
        })
    }

    /// Returns a copy at another astronomic latitude, without Δ, B, C.
    pub(crate) fn at_latitude(&self, latitude_deg: f64) -> Self {
        let frame_axis_azimuth_deg = self.earth.frame_axis_azimuth_deg;
        let earth = EarthRate::at_astronomic_latitude(latitude_deg);
        self.changed_to(EarthRate { frame_axis_azimuth_deg, ..earth }, |_, _| ())
    }

    /// Returns a copy with a gyro that is rotated about its spin axis, anticlockwise, and without Δ, B, C.
    pub(crate) fn case_turned(&self, by_deg: f64) -> Self {
        let (sin, cos) = sin_cos_of_degrees(by_deg);
        let rotation = Matrix3::new(cos, sin, 0.0, -sin, cos, 0.0, 0.0, 0.0, 1.0);
        self.changed_to(self.earth, |turn, at| {
            turn.attitude = rotation * turn.attitude;
            turn.axes = turn.axes.map(|axis| rotation * axis);
            at.specific_force_g = turn.attitude.column(2).xy();
        })
    }

    /// Returns a copy with another Earth rate and with every position changed, without Δ, B, C.
    fn changed_to(&self, earth: EarthRate, change: impl Fn(&mut Turn, &mut PositionCoefficients)) -> Self {
        let mut changed = Self { earth, ..self.clone() };
        changed.coefficients.matrices = None;
        let rate = changed.earth_rate_east_north_up();
        for (turn, at) in changed.turns.iter_mut().zip(&mut changed.coefficients.positions) {
            change(turn, at);
            at.earth_rate_deg_per_h = (turn.attitude * rate).xy();
        }
        changed
    }

    /// Returns the direction of the frame's axis (east, north, up).
    pub(crate) fn frame_axis(&self) -> Vector3<f64> {
        let (sin, cos) = sin_cos_of_degrees(self.earth.frame_axis_azimuth_deg);
        Vector3::new(sin, cos, 0.0)
    }

    /// Returns the azimuth of the frame's axis, degrees clockwise from north, from 0 to less than 360.
    pub(crate) fn frame_axis_azimuth_deg(&self) -> f64 {
        self.earth.frame_axis_azimuth_deg.rem_euclid(360.0)
    }

    /// Returns the Earth rate (east, north, up), °/h.
    pub(crate) fn earth_rate_east_north_up(&self) -> Vector3<f64> {
        Vector3::new(0.0, self.earth.horizontal_deg_per_h, self.earth.vertical_deg_per_h)
    }
}

/// Returns the elements at `places`, as far as a list has them; a list may end before the last position.
pub(super) fn at_places<T: Clone>(all: &[T], places: &[usize]) -> Vec<T> {
    places.iter().filter_map(|&place| all.get(place).cloned()).collect()
}

impl Turn {
    /// Returns the matrix that gives (α, β, γ) of a small rotation of the case, in the unit of the rotation.
    pub(crate) fn angles_of_rotation(&self) -> Matrix3<f64> {
        // The angles solve axes · angles = rotation; the three axes are never coplanar while the angles are within ±45°.
        Matrix3::from_columns(&self.axes).try_inverse().unwrap_or_else(Matrix3::identity)
    }

    /// Returns the orientation of a position; `base` is [`attitude::base`], or the identity if only the axes of the
    /// stand matter.
    pub(crate) fn of(position: &Position, base: &Matrix3<f64>) -> Self {
        let deviation = attitude::deviation(&position.deviation);
        let (sin_gamma, cos_gamma) = libm::sincos(position.deviation.gamma_rad);
        let nominal = attitude::nominal(position.theta_deg, position.phi_deg) * base;
        Self {
            attitude: deviation * nominal,
            nominal,
            angles_deg: [position.theta_deg, position.phi_deg],
            certified: position.deviation,
            // α is applied before β and γ, so its axis is the first column of E. Only γ rotates the axis of β.
            axes: [deviation.column(0).into_owned(), Vector3::new(sin_gamma, cos_gamma, 0.0), Vector3::z()],
        }
    }
}
