//! Time of one calibration by all three methods: `cargo run --release --example calibration_time`.

use dtg_passport::calibration::{InputUncertainty, Options, Readings, Setup, calibrate};
use dtg_passport::coefficients::{EarthRate, PositionIndex};
use dtg_passport::gyro::GyroType;
use dtg_passport::laboratory::Laboratory;
use dtg_passport::simulation::accuracy::PAPER_LATITUDE_DEG;
use dtg_passport::simulation::draw::{self, CurrentError, Deviations};
use dtg_passport::statistics::random::Stream;
use dtg_passport::units::radians_from_arcseconds;
use nalgebra::Vector2;
use std::hint::black_box;
use std::time::Instant;

/// Calibrations in a round.
const CALIBRATIONS: u32 = 5_000;

fn main() {
    let mut stream = Stream::new(1);
    let stand = draw::stand(&mut stream, Deviations::Uniform, 5.0);
    let arcsec = radians_from_arcseconds;
    let uncertainty = InputUncertainty {
        angles_rad: vec![[arcsec(1.5); 3]; 8],
        repeatability_rad: arcsec(1.5),
        common_platform_rad: arcsec(0.8),
        common_base_rad: arcsec(0.8),
        latitude_rad: arcsec(1.0),
        azimuth_rad: arcsec(10.0),
        level_rad: arcsec(3.0),
        seating_rad: [arcsec(5.0); 3],
        ..InputUncertainty::of_meter((&Laboratory::paper().meter).into())
    };
    let earth = EarthRate::at_astronomic_latitude(PAPER_LATITUDE_DEG);
    let Ok(setup) = Setup::new(&stand, earth, uncertainty) else { return };
    let gyro = GyroType::gvk_6().nominal.to_model();
    let positions = &setup.coefficients().positions;
    let mut currents: Vec<Vector2<f64>> = positions.iter().filter_map(|at| gyro.currents_ma(at)).collect();
    CurrentError::Independent.add(&mut stream, 0.015, &mut currents);
    let each: Vec<(PositionIndex, Vector2<f64>)> = positions.iter().map(|at| at.index).zip(currents).collect();
    let Ok(readings) = Readings::new(setup.coefficients(), &each) else { return };
    for _ in 0..5 {
        let start = Instant::now();
        for _ in 0..CALIBRATIONS {
            let found = calibrate(black_box(&setup), black_box(&readings), &Options::default());
            assert!(black_box(found).is_ok_and(|found| found.results.len() == 3));
        }
        println!("{:.1} us for one calibration", start.elapsed().as_secs_f64() * 1e6 / f64::from(CALIBRATIONS));
    }
}
