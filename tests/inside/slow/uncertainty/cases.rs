//! Three calibrations with every kind of input uncertain: a good stand, a bad one, and a worse one on a base whose frame
//! axis does not point east.

use crate::inside::reference::*;
use dtg_passport::calibration::{InputUncertainty, MeterUncertainty, Readings, Setup};
use dtg_passport::coefficients::{EarthRate, Position};
use dtg_passport::statistics::random::Stream;
use dtg_passport::units::{radians_from_arcseconds, radians_from_degrees};
use nalgebra::Matrix3;

/// A calibration of the paper's gyro with exact currents.
pub struct Case {
    /// The latitude.
    pub latitude_deg: f64,
    /// The azimuth of the frame's axis.
    pub frame_axis_azimuth_deg: f64,
    /// The stand.
    pub positions: Vec<Position>,
    /// Stand, site, and how uncertain all is.
    pub setup: Setup,
    /// The currents.
    pub readings: Readings,
}

impl Case {
    /// Rz(90° − ψ), from east, north, up to the axes of the base.
    pub fn base(&self) -> Matrix3<f64> {
        let (sin, cos) = libm::sincos(radians_from_degrees(90.0 - self.frame_axis_azimuth_deg));
        Matrix3::new(cos, sin, 0.0, -sin, cos, 0.0, 0.0, 0.0, 1.0)
    }
}

/// Everything uncertain; angles with few degrees of freedom when `known` is finite.
pub fn everything(stream: &mut Stream, known: f64) -> InputUncertainty {
    let arcsec = radians_from_arcseconds;
    let mut angle = || arcsec(1.0 + 2.0 * stream.unit());
    InputUncertainty {
        angles_rad: (0..8).map(|_| [angle(), angle(), angle()]).collect(),
        angles_degrees_of_freedom: (0..8).map(|place| known + f64::from(place)).collect(),
        repeatability_rad: arcsec(1.5),
        common_platform_rad: arcsec(0.8),
        common_base_rad: arcsec(0.7),
        latitude_rad: arcsec(1.0),
        deflection_rad: arcsec(2.0),
        azimuth_rad: arcsec(10.0),
        level_rad: arcsec(3.0),
        seating_rad: [arcsec(4.0), arcsec(5.0), arcsec(20.0)],
        meter: MeterUncertainty { reading: 8.7e-5, floor_ma: 1e-6, noise_ma: 0.0, gain: 2e-5, offset_ma: 2e-6 },
        ..InputUncertainty::of_meter(paper_meter())
    }
}

/// The three of every comparison.
pub fn three() -> Vec<Case> {
    let mut stream = Stream::new(17);
    let of = |latitude_deg: f64, frame_axis_azimuth_deg: f64, limit_deg: f64, known: f64, stream: &mut Stream| {
        let positions = drawn_stand(stream, limit_deg);
        let uncertainty = everything(stream, known);
        let earth = EarthRate { frame_axis_azimuth_deg, ..EarthRate::at_astronomic_latitude(latitude_deg) };
        let setup = Setup::new(&positions, earth, uncertainty).expect("n_2 has an inverse");
        let readings = readings(&setup, &currents(&setup, &gvk_6()));
        Case { latitude_deg, frame_axis_azimuth_deg, positions, setup, readings }
    };
    vec![
        of(LATITUDE_DEG, 90.0, 0.05, f64::INFINITY, &mut stream),
        of(40.2, 90.0, 5.0, 4.0, &mut stream),
        of(-43.6, 217.3, 15.0, 9.0, &mut stream),
    ]
}
