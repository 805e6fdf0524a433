//! Uncertain inputs of a calibration, one by one and by name, from which budgets are made.
//!
//! The covariance of the misclosures is F F', with one column of F for each independent cause of one standard
//! uncertainty. A fit needs only sums of them (the own part of each position as one 2×2 block). Here each cause has a
//! column of its own.

use super::data::Data;
use super::estimates::{Basis, Estimates};
use super::inputs::Setup;
use super::least_squares::Fit;
use super::repeats::Repeats;
use super::sensitivity::Sensitivity;
use crate::attitude::ANGLES;
use crate::coefficients::PositionIndex;
use crate::wording::texts::causes as names;
use crate::wording::{Language, Words};
use nalgebra::DMatrix;

/// Uncertain input quantity. Axes are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Cause {
    /// Certified angle of a position: 0, 1, 2 for α, β, γ.
    Angle(PositionIndex, usize),
    /// Repeatability of a position, about axis x, y or z of the case.
    Return(PositionIndex, usize),
    /// Specification of the meter in a position, as a fraction of the reading of J_x or J_y.
    Reading(PositionIndex, usize),
    /// Floor of the meter in a position: part of the specification that does not depend on the reading of J_x or J_y.
    Floor(PositionIndex, usize),
    /// Noise of the mean reading of J_x or J_y in a position.
    Noise(PositionIndex, usize),
    /// Noise of the gyro's drift from visit to visit, in the mean of a position, about axis x or y.
    Visits(PositionIndex, usize),
    /// Differences between visits, from which turn-ons and a drift in time are found.
    Differences(usize),
    /// Bias of the turn-ons of the gyro, in their mean, about axis x or y.
    TurnOn(usize),
    /// Scatter of K between turn-ons, in their mean: the element K_x, K_xy, K_yx or K_y, counted from 0.
    Scale(usize),
    /// Common part of the platform, about its axis x, y or z.
    Platform(usize),
    /// Gyro seat, about axis x, y or z of the case.
    Seat(usize),
    /// Common part of the base of the stand, about east, north or up.
    Base(usize),
    /// Level of the base in the laboratory, about east or north.
    Level(usize),
    /// Azimuth of the base in the laboratory.
    Azimuth,
    /// Azimuth from the pillar to the mark.
    Mark,
    /// Latitude as stated.
    Latitude,
    /// Deflection of the vertical, component ξ.
    Deflection,
    /// Gain of the meter, common to all readings.
    Gain,
    /// Offset of the meter, common to all readings.
    Offset,
}

const XYZ: [&str; 3] = ["x", "y", "z"];

impl Cause {
    /// Returns the name of the cause, including its position.
    pub(crate) fn name(self) -> String {
        match self {
            Self::Angle(index, angle) => format!("certified {} of {index}", ANGLES[angle]),
            Self::Return(index, axis) => format!("positioning in {index} about {}", XYZ[axis]),
            Self::Reading(index, axis) => format!("reading of J_{} in {index}", XYZ[axis]),
            Self::Floor(index, axis) => format!("floor of J_{} in {index}", XYZ[axis]),
            Self::Noise(index, axis) => format!("noise of J_{} in {index}", XYZ[axis]),
            Self::Visits(index, axis) => format!("gyro noise in {index} about {}", XYZ[axis]),
            _ => self.kind(),
        }
    }

    /// Returns the kind, the source and the unit.
    fn words(self) -> (Words, &'static str, &'static str) {
        // No letters of the base axes, because the frame's axis ξ may point to any azimuth.
        let axis: Words = match self {
            Self::TurnOn(axis) | Self::Platform(axis) | Self::Seat(axis) => XYZ[axis].into(),
            Self::Base(axis) | Self::Level(axis) => {
                [names::ABOUT_EAST, names::ABOUT_NORTH, names::ABOUT_UP][axis].into()
            }
            _ => "".into(),
        };
        match self {
            Self::Angle(..) => {
                (names::ANGLE.into(), "certificate: u_alpha_arcsec, u_beta_arcsec, u_gamma_arcsec", "arcsec")
            }
            Self::Return(..) => (names::RETURN.into(), "certificate: repeatability_arcsec", "arcsec"),
            Self::Reading(..) => (names::READING.into(), "laboratory: meter.reading_percent", "%"),
            Self::Floor(..) => (names::FLOOR.into(), "laboratory: meter.floor_ma, or the last digit recorded", "mA"),
            Self::Noise(..) => (names::NOISE.into(), "laboratory: meter.noise_ma, or repeated rows", "mA"),
            Self::Visits(..) => (names::VISITS.into(), "gyro type: noise.visit_deg_per_h, or repeated visits", "deg/h"),
            Self::Differences(_) => (names::DIFFERENCES.into(), "all of a visit", "1"),
            Self::TurnOn(_) => {
                (names::turn_on(axis), "gyro type: noise.turn_on_deg_per_h, or repeated turn-ons", "deg/h")
            }
            Self::Scale(element) => {
                (names::scale(["K_x", "K_xy", "K_yx", "K_y"][element]), "repeated turn-ons", "deg/(h mA)")
            }
            Self::Platform(_) => (names::platform(axis), "certificate: common_platform_arcsec", "arcsec"),
            Self::Seat(_) => (names::seat(axis), "laboratory: seating_arcsec", "arcsec"),
            Self::Base(_) => (names::base(axis), "certificate: common_base_arcsec", "arcsec"),
            Self::Level(_) => (names::level(axis), "laboratory or site: level_arcsec", "arcsec"),
            Self::Azimuth => (names::AZIMUTH.into(), "laboratory or site: azimuth_arcsec", "arcsec"),
            Self::Mark => (names::MARK.into(), "passport: earth.azimuth_u_arcsec", "arcsec"),
            Self::Latitude => (names::LATITUDE.into(), "site: uncertainty.latitude_arcsec", "arcsec"),
            Self::Deflection => (names::DEFLECTION.into(), "site: deflection_arcsec.u (10 if unknown)", "arcsec"),
            Self::Gain => (names::GAIN.into(), "laboratory: meter.gain_percent", "%"),
            Self::Offset => (names::OFFSET.into(), "laboratory: meter.offset_ma", "mA"),
        }
    }

    /// Returns the name of the kind of cause, which is the name of its line in a budget.
    pub(crate) fn kind(self) -> String {
        self.kind_words().plain(Language::English)
    }

    /// Returns the [kind](Self::kind) in every language.
    pub(crate) fn kind_words(self) -> Words {
        self.words().0
    }

    /// Returns the file that states the uncertainty, and the key.
    pub(crate) fn source(self) -> &'static str {
        self.words().1
    }

    /// Returns the unit in which the uncertainty is shown: arcsec, %, mA or deg/h; 1 for differences in units of their
    /// own uncertainty.
    pub(crate) fn unit(self) -> &'static str {
        self.words().2
    }

    /// Returns `true` if both causes are of the same [kind](Self::kind): those of single positions, whatever the position,
    /// and the differences.
    pub(crate) fn is_alike(self, other: Self) -> bool {
        let of_many = self.position().is_some() || matches!(self, Self::Differences(_));
        self == other || of_many && std::mem::discriminant(&self) == std::mem::discriminant(&other)
    }

    /// Returns the position on which the cause acts, or `None` if it acts on all positions.
    pub(crate) fn position(self) -> Option<PositionIndex> {
        match self {
            Self::Angle(index, _)
            | Self::Return(index, _)
            | Self::Reading(index, _)
            | Self::Floor(index, _)
            | Self::Noise(index, _)
            | Self::Visits(index, _) => Some(index),
            _ => None,
        }
    }

    /// Converts an uncertainty from its internal unit (rad, fraction of the reading, mA) to [`Self::unit`].
    pub(crate) fn shown(self, uncertainty: f64) -> f64 {
        match self.unit() {
            "%" => 100.0 * uncertainty,
            "mA" | "deg/h" | "deg/(h mA)" | "1" => uncertainty,
            _ => crate::units::arcseconds_from_radians(uncertainty),
        }
    }
}

/// Uncertain input: a cause with its standard uncertainty and degrees of freedom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Input {
    /// Cause of the uncertainty.
    pub cause: Cause,
    /// Standard uncertainty of the mean of all readings: rad, fraction of the reading, or mA.
    pub standard_uncertainty: f64,
    /// Degrees of freedom of the standard uncertainty; infinite if it is taken as known.
    pub degrees_of_freedom: f64,
    /// Estimates of variances on which the uncertainty rests; inputs may share them.
    pub basis: Basis,
}

/// Returns all inputs with a positive uncertainty, and F: the change of the misclosures, °/h, for one standard
/// uncertainty of each input (two rows per position, then one per row of the differences of visits × inputs).
pub(crate) fn inputs(setup: &Setup, data: &Data, fit: &Fit) -> (Vec<Input>, DMatrix<f64>) {
    let (sensitivity, currents_ma) = (Sensitivity::new(setup, &fit.unknowns), &fit.currents_ma);
    let estimates = Estimates::new(setup, &data.repeats);
    let (rows, differences) = (2 * currents_ma.len(), data.offsets.rows.nrows());
    let of_differences = (0..differences).map(|row| (Cause::Differences(row), 1.0, estimates.visits));
    let each = table(setup, &data.repeats, &estimates).into_iter().chain(of_differences);
    let inputs: Vec<Input> = each.filter_map(|(cause, u, basis)| estimates.input(cause, u, basis)).collect();
    let each: Vec<_> = inputs.iter().map(|input| (input.cause, input.standard_uncertainty)).collect();
    let mut columns = sensitivity.columns(currents_ma, &each).resize_vertically(rows + differences, 0.0);
    for (column, (cause, _)) in each.iter().enumerate() {
        if let Cause::Differences(row) = cause {
            columns[(rows + row, column)] = 1.0;
        }
    }
    (inputs, columns)
}

/// Returns the inputs behind the misclosures of the positions with their standard uncertainties and what these rest on: those of
/// stand and site, then those that a calibration adds. Exact ones have an uncertainty of 0.
pub(crate) fn table(setup: &Setup, repeats: &Repeats, estimates: &Estimates) -> Vec<(Cause, f64, Basis)> {
    let u = setup.uncertainty();
    let positions = || setup.coefficients().positions.iter().map(|at| at.index).enumerate();
    let mut inputs = Vec::new();
    for (place, index) in positions() {
        let angles = u.angles_rad.get(place).copied().unwrap_or_default().into_iter().zip(estimates.angles[place]);
        inputs.extend(angles.enumerate().map(|(angle, (u, basis))| (Cause::Angle(index, angle), u, basis)));
    }
    inputs.extend([0, 1, 2].map(|axis| (Cause::Platform(axis), u.common_platform_rad, estimates.platform)));
    inputs.extend([0, 1, 2].map(|axis| (Cause::Base(axis), u.common_base_rad, estimates.base)));
    let of_site = [
        (Cause::Level(0), u.level_rad),
        (Cause::Level(1), u.level_rad),
        (Cause::Azimuth, u.azimuth_rad),
        (Cause::Mark, u.mark_rad),
        (Cause::Latitude, u.latitude_rad),
        (Cause::Deflection, u.deflection_rad),
    ];
    inputs.extend(of_site.map(|(cause, u)| (cause, u, Basis::Known)));
    for (place, index) in positions() {
        let of_returns = u.repeatability_rad * repeats.return_share(place).sqrt();
        inputs.extend([0, 1, 2].map(|axis| (Cause::Return(index, axis), of_returns, estimates.returns)));
        for axis in 0..2 {
            inputs.extend([
                (Cause::Reading(index, axis), u.meter.reading, Basis::Known),
                (Cause::Floor(index, axis), u.meter.floor_ma, Basis::Known),
                (Cause::Noise(index, axis), repeats.noise_variance_ma2(place).sqrt(), estimates.noise),
                (Cause::Visits(index, axis), repeats.drift_variance(place).sqrt(), estimates.visits),
            ]);
        }
    }
    inputs.extend([0, 1, 2].map(|axis| (Cause::Seat(axis), u.seating_rad[axis], Basis::Known)));
    inputs.extend([(Cause::Gain, u.meter.gain, Basis::Known), (Cause::Offset, u.meter.offset_ma, Basis::Known)]);
    let turn_on = repeats.turn_on_of_mean_deg_per_h();
    inputs.extend([0, 1].map(|axis| (Cause::TurnOn(axis), turn_on, estimates.turn_ons)));
    inputs.extend(
        [0, 1, 2, 3].map(|element| (Cause::Scale(element), repeats.scale_of_mean(element), estimates.scale[element])),
    );
    inputs
}

impl Estimates {
    /// Returns the input with this basis, or `None` if its uncertainty is 0.
    pub(crate) fn input(&self, cause: Cause, standard_uncertainty: f64, basis: Basis) -> Option<Input> {
        let degrees_of_freedom = self.degrees_of_freedom(basis);
        (standard_uncertainty > 0.0).then_some(Input { cause, standard_uncertainty, degrees_of_freedom, basis })
    }
}
