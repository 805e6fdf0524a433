//! First-order uncertainties against a simulation of everything that they are to cover: certified angles, returns,
//! platform, seat, base with level and azimuth, latitude, meter. The simulation turns matrices by finite rotations and
//! knows nothing of the sensitivities.

use super::current;
use crate::inside::reference::*;
use dtg_passport::attitude::{self, Deviation};
use dtg_passport::calibration::parameter::Parameter;
use dtg_passport::calibration::readings::Reading;
use dtg_passport::calibration::{InputUncertainty, Method, Options, Readings, calibrate};
use dtg_passport::coefficients::{EarthRate, Position};
use dtg_passport::gyro::GyroParameters;
use dtg_passport::statistics::random::{Run, Stream};
use dtg_passport::statistics::summary::Summary;
use dtg_passport::units::{degrees_from_radians, radians_from_arcseconds};
use nalgebra::{Matrix3, Vector2, Vector3};

/// The passive turn of coordinates when the axes turn by the vector `turn`: Rz·Ry·Rx is enough for arcseconds.
fn turned(turn: Vector3<f64>) -> Matrix3<f64> {
    attitude::deviation(&Deviation { alpha_rad: turn.x, beta_rad: turn.y, gamma_rad: turn.z })
}

fn normal(stream: &mut Stream, u: [f64; 3]) -> Vector3<f64> {
    Vector3::from(u.map(|u| u * stream.normal()))
}

/// Visits of each position, and readings of each visit.
const VISITS: u32 = 2;
const ROWS: u32 = 3;

/// One set of readings, [`ROWS`] in each of [`VISITS`] visits, of a gyro on a stand that is not quite what its certificate
/// says, at a place that is not quite where it should be, through a meter that is not quite right.
pub(super) fn read(
    stream: &mut Stream,
    certified: &[Position],
    u: &InputUncertainty,
    gyro: &GyroParameters,
) -> Vec<Reading> {
    let platform = turned(normal(stream, [u.common_platform_rad; 3])) * turned(normal(stream, u.seating_rad));
    let base = turned(normal(stream, [u.common_base_rad; 3]))
        * turned(normal(stream, [u.level_rad, u.level_rad, u.azimuth_rad]));
    let latitude_deg = LATITUDE_DEG + degrees_from_radians(u.latitude_rad * stream.normal());
    let (gain, offset) = (1.0 + u.meter.gain * stream.normal(), u.meter.offset_ma * stream.normal());
    let mut readings = Vec::new();
    for (position, angles) in certified.iter().zip(&u.angles_rad) {
        let error = normal(stream, *angles);
        let mut real = *position;
        real.deviation.alpha_rad += error.x;
        real.deviation.beta_rad += error.y;
        real.deviation.gamma_rad += error.z;
        let real = attitude::actual(real.theta_deg, real.phi_deg, &real.deviation);
        // The meter's specification: the same error whenever this current is read.
        let of_meter = Vector2::from_fn(|_, _| stream.normal());
        for visit in 1..=VISITS {
            let returned = turned(normal(stream, [u.repeatability_rad; 3]));
            let exact = current(gyro, &(returned * platform * real * base), latitude_deg);
            for _ in 0..ROWS {
                let current_ma = exact.zip_map(&of_meter, |j, error| {
                    let own = u.meter.own_variance_ma2(j).sqrt() * error + u.meter.noise_ma * stream.normal();
                    j * gain + offset + own
                });
                readings.push(Reading { visit: Some(visit), ..Reading::new(position.index, current_ma) });
            }
        }
    }
    readings
}

/// Returns a stand as certified, and the uncertainties of everything that [`read`] draws.
pub(super) fn inputs() -> (Vec<Position>, InputUncertainty) {
    let arcsec = radians_from_arcseconds;
    let u = InputUncertainty {
        angles_rad: (0..8).map(|place| [4.0, 3.0, 6.0 + f64::from(place)].map(arcsec)).collect(),
        repeatability_rad: arcsec(4.0),
        common_platform_rad: arcsec(3.0),
        common_base_rad: arcsec(3.0),
        latitude_rad: arcsec(12.0),
        azimuth_rad: arcsec(15.0),
        level_rad: arcsec(8.0),
        seating_rad: [5.0, 6.0, 10.0].map(arcsec),
        ..InputUncertainty::of_meter(paper_meter())
    };
    let u = InputUncertainty {
        meter: dtg_passport::calibration::MeterUncertainty { gain: 5e-5, offset_ma: 2e-5, noise_ma: 2e-5, ..u.meter },
        // A gyro that is known not to drift from visit to visit; what is not stated would be estimated.
        visit_deg_per_h: Some(0.0),
        ..u
    };
    (drawn_stand(&mut Stream::new(21), 5.0), u)
}

#[test]
fn uncertainties_cover_what_they_state() {
    let (certified, u) = inputs();
    let earth = EarthRate::at_astronomic_latitude(LATITUDE_DEG);
    let setup = dtg_passport::calibration::Setup::new(&certified, earth, u.clone()).unwrap();
    let trials = 10_000;
    let options = Options { methods: vec![Method::Analytic, Method::LeastSquares], ..Options::default() };
    // Errors in units of their uncertainty, by method and parameter; chi-square below its 5 % point; false alarms;
    // scatter of visits and of rows below its 5 % point.
    let blocks = Run::new(trials, 22).blocks(|stream, trials| {
        let mut errors = [[Summary::default(); 8]; 2];
        let (mut improbable, mut scattered, mut noisy) = (0_u64, 0_u64, 0_u64);
        let (mut residuals, mut differences) = (Summary::default(), Summary::default());
        for _ in 0..trials {
            let readings = Readings::of_rows(setup.coefficients(), &read(stream, &certified, &u, &gvk_6())).unwrap();
            let found = calibrate(&setup, &readings, &options).unwrap();
            for (errors, result) in errors.iter_mut().zip(&found.results) {
                let nominal = gvk_6().to_vector();
                for parameter in Parameter::EIGHT {
                    let error = result.value(parameter).unwrap() - nominal[parameter.place()];
                    errors[parameter.place()].add(error / result.standard_uncertainty(parameter).unwrap());
                }
                for at in &result.document.residuals_deg_per_h {
                    [(at.x, at.u_x), (at.y, at.u_y)]
                        .into_iter()
                        .for_each(|(value, u)| residuals.add(value / u.unwrap()));
                }
            }
            found.results[0].document.from_least_squares.unwrap().iter().for_each(|value| differences.add(*value));
            improbable += u64::from(found.results[0].chi_square.probability < 0.05);
            scattered += u64::from(found.scatter.unwrap().probability < 0.05);
            noisy += u64::from(found.row_scatter.unwrap().probability.unwrap() < 0.05);
        }
        (errors, [improbable, scattered, noisy], residuals, differences)
    });
    for (method, name) in ["analytic", "least squares"].iter().enumerate() {
        for parameter in Parameter::EIGHT {
            let each = blocks.iter().map(|block| block.0[method][parameter.place()]);
            let sum = each.fold(Summary::default(), |sum, block| sum.with(&block));
            let deviation = sum.standard_deviation();
            // The standard error of a standard deviation of 10,000 is 0.7 %.
            assert!((deviation - 1.0).abs() < 0.03, "{name}, {}: {deviation}", parameter.symbol());
            assert!(sum.mean().abs() < 0.05, "{name}, {}: mean {}", parameter.symbol(), sum.mean());
        }
    }
    let percent = |count: u64| 100.0 * count as f64 / trials as f64;
    let shares = [0, 1, 2].map(|which| percent(blocks.iter().map(|block| block.1[which]).sum()));
    assert!(shares.iter().all(|share| (share - 5.0).abs() < 0.7), "{shares:?}");
    let residuals = blocks.iter().fold(Summary::default(), |sum, block| sum.with(&block.2));
    assert!((residuals.standard_deviation() - 1.0).abs() < 0.02, "{residuals:?}");
    let differences = blocks.iter().fold(Summary::default(), |sum, block| sum.with(&block.3));
    assert!((differences.standard_deviation() - 1.0).abs() < 0.02, "{differences:?}");
}
