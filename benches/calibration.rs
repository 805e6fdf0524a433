//! Time of one calibration by all three methods, and of linear propagation in addition (budget of all parameters with
//! covariance, degrees of freedom and coverage factors):
//! `cargo bench --bench calibration`.

use dtg_passport::calibration::{InputUncertainty, Method, Options, Readings, Setup, calibrate};
use dtg_passport::coefficients::{EarthRate, PositionIndex};
use dtg_passport::gyro::GyroType;
use dtg_passport::laboratory::Laboratory;
use dtg_passport::simulation::draw::{self, CurrentError, Deviations};
use dtg_passport::simulation::{PAPER_LATITUDE_DEG, Stream};
use dtg_passport::uncertainty::Budget;
use nalgebra::Vector2;
use std::hint::black_box;
use std::time::Instant;

/// Calibrations in a round.
const CALIBRATIONS: u32 = 5_000;

fn main() {
    let mut stream = Stream::new(1);
    let stand = draw::stand(&mut stream, Deviations::Uniform, 5.0);
    let arcsec = |value: f64| (value / 3600.0).to_radians();
    let uncertainty = InputUncertainty {
        angles_rad: vec![[arcsec(1.5); 3]; 8],
        angles_degrees_of_freedom: vec![8.0; 8],
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
    let mut run = "cycle,i,j,jx_ma,jy_ma\n".to_owned();
    for cycle in 1..=3 {
        for (PositionIndex { i, j }, current_ma) in &each {
            let [x, y] = [current_ma.x, current_ma.y].map(|ma| ma + stream.within(2e-4));
            run += &format!("{cycle},{i},{j},{x},{y}\n");
        }
    }
    let Ok(run) = Readings::from_csv("run.csv", run.as_bytes(), setup.coefficients(), 1000.0) else { return };
    for _ in 0..5 {
        let one =
            time(CALIBRATIONS, || calibrate(&setup, &readings, &Options::default()).map(|found| found.results.len()));
        let of_run =
            time(CALIBRATIONS, || calibrate(&setup, &run, &Options::default()).map(|found| found.results.len()));
        let of_parameters = time(CALIBRATIONS / 10, || {
            Budget::new(&setup, &readings, Method::LeastSquares, &Options::default()).map(|budget| budget.covariance())
        });
        println!(
            "{one:.1} us for one calibration, {of_run:.1} us with 24 visits in 3 turn-ons; first order: {of_parameters:.0} us for a budget"
        );
    }
}

/// Returns the mean time of `count` runs, microseconds.
fn time<T>(count: u32, work: impl Fn() -> T) -> f64 {
    let start = Instant::now();
    for _ in 0..count {
        black_box(work());
    }
    start.elapsed().as_secs_f64() * 1e6 / f64::from(count)
}
