//! Simulated stands: readings by exact rotations of platform, base and single returns, whose sizes are known.

// Every file of tests is a program of its own, and none uses all of this.
#![allow(dead_code)]

use dtg_passport::attitude;
use dtg_passport::certification::{AngleReadings, Certification, Header, certify};
use dtg_passport::coefficients::EIGHT_POSITIONS;
use dtg_passport::statistics::random::Stream;
use nalgebra::{Matrix3, Vector3};
use std::fmt::Write;

pub const HEADER: &str = r#"format: "dtg-stand/1"
stand: {model: "SPS-2", serial: "0017"}
certificate: {number: "C-1", issued: "2026-11-02", laboratory: "Example"}
positions:
  - {i: 1, j: 1, theta_deg: 0, phi_deg: 0}
  - {i: 1, j: 2, theta_deg: 0, phi_deg: 90}
  - {i: 1, j: 3, theta_deg: 0, phi_deg: 180}
  - {i: 1, j: 4, theta_deg: 0, phi_deg: 270}
  - {i: 2, j: 1, theta_deg: 90, phi_deg: 0}
  - {i: 2, j: 2, theta_deg: 90, phi_deg: 90}
  - {i: 2, j: 3, theta_deg: 90, phi_deg: 180}
  - {i: 2, j: 4, theta_deg: 90, phi_deg: 270}
"#;

pub fn header() -> Header {
    Header::from_yaml("header.yaml", HEADER.as_bytes()).unwrap()
}

/// Standard deviations of a simulated measurement, arcsec.
#[derive(Clone, Copy)]
pub struct Truth {
    pub angles_arcsec: [Vector3<f64>; 8],
    pub own: [f64; 3],
    pub platform: f64,
    pub base: f64,
}

impl Truth {
    /// Deviations up to a degree, so that rotations are not just numbers added.
    pub fn new(own: [f64; 3], platform: f64, base: f64) -> Self {
        let mut stream = Stream::new(7);
        let angles_arcsec = [(); 8].map(|()| Vector3::from([(); 3].map(|()| stream.within(3600.0).round())));
        Self { angles_arcsec, own, platform, base }
    }

    /// Readings by exact rotations: the base turned, then the platform, then the angles of the product taken.
    pub fn measured(&self, stream: &mut Stream, runs: usize) -> AngleReadings {
        let mut each = vec![Vec::new(); 8];
        for _ in 0..runs {
            let platform = normal(stream, [self.platform; 3]);
            let base = normal(stream, [self.base; 3]);
            for (place, (_, theta, phi)) in EIGHT_POSITIONS.iter().enumerate() {
                let own = normal(stream, self.own);
                each[place].push(self.read(place, *theta, *phi, platform + own, base));
            }
        }
        AngleReadings::new((1..=runs as u32).collect(), each).unwrap()
    }

    pub fn read(&self, place: usize, theta: f64, phi: f64, case: Vector3<f64>, base: Vector3<f64>) -> Vector3<f64> {
        let nominal = attitude::nominal(theta, phi);
        let deviation = turn(case) * turn(self.angles_arcsec[place]) * nominal * turn(base) * nominal.transpose();
        angles(&deviation)
    }
}

pub const ARCSEC: f64 = std::f64::consts::PI / 648_000.0;

/// Rz(γ)·Ry(β)·Rx(α) of three angles in arcsec.
pub fn turn(angles_arcsec: Vector3<f64>) -> Matrix3<f64> {
    let a = angles_arcsec * ARCSEC;
    attitude::deviation(&attitude::Deviation { alpha_rad: a.x, beta_rad: a.y, gamma_rad: a.z })
}

/// The angles of E, from its elements: sin β, −sin α cos β, −cos β sin γ (see the matrix above eq. (4)).
pub fn angles(e: &Matrix3<f64>) -> Vector3<f64> {
    let beta = libm::asin(e[(2, 0)]);
    Vector3::new(libm::atan2(-e[(2, 1)], e[(2, 2)]), beta, libm::atan2(-e[(1, 0)], e[(0, 0)])) / ARCSEC
}

pub fn normal(stream: &mut Stream, sigma: [f64; 3]) -> Vector3<f64> {
    Vector3::from(sigma.map(|sigma| sigma * stream.normal()))
}

pub fn certified(truth: &Truth, stream: &mut Stream, runs: usize) -> Certification {
    certify(&header(), &truth.measured(stream, runs)).unwrap()
}

/// The file that readings are read from.
pub fn csv(readings: &AngleReadings) -> String {
    let mut text = String::from("i,j,run,alpha_arcsec,beta_arcsec,gamma_arcsec\n");
    for (run, number) in readings.runs.iter().enumerate() {
        for ((at, ..), each) in EIGHT_POSITIONS.iter().zip(&readings.each_arcsec) {
            let angles = each[run];
            writeln!(text, "{},{},{number},{:.2},{:.2},{:.2}", at.i, at.j, angles.x, angles.y, angles.z).unwrap();
        }
    }
    text
}

/// The readings of a file.
pub fn read(text: &str) -> AngleReadings {
    AngleReadings::from_csv("angles.csv", text.as_bytes(), &header().positions)
        .unwrap_or_else(|error| panic!("{error}"))
}
