//! Chi-square of a fit, and the parts of its covariance that rest on estimates, against dense matrices.

use crate::inside::reference::*;
use dtg_passport::calibration::analytic::{self, AnalyticMap};
use dtg_passport::calibration::causes;
use dtg_passport::calibration::chi_square::{ChiSquare, Estimated, chi_square, quadratic_form};
use dtg_passport::calibration::data::Data;
use dtg_passport::calibration::data::Observation;
use dtg_passport::calibration::estimates::{Basis, Estimates};
use dtg_passport::calibration::procedure::observe;
use dtg_passport::calibration::propagation::Propagation;
use dtg_passport::calibration::unknowns::Unknowns;
use dtg_passport::calibration::{InputUncertainty, MeterUncertainty, Method, Model, Options, Readings, Setup};
use dtg_passport::statistics::random::Stream;
use nalgebra::{DMatrix, DVector};

/// Uncertainties of both tests.
fn uncertainty(noise_ma: f64) -> InputUncertainty {
    InputUncertainty {
        angles_rad: vec![[1e-5, 2e-5, 3e-5]; 8],
        common_platform_rad: 2e-5,
        latitude_rad: 3e-5,
        azimuth_rad: 5e-5,
        seating_rad: [3e-5; 3],
        ..InputUncertainty::of_meter(MeterUncertainty {
            reading: 1e-4,
            floor_ma: 1e-6,
            noise_ma,
            gain: 1e-4,
            offset_ma: 1e-5,
        })
    }
}

/// P = C⁻¹ − C⁻¹ X (X' C⁻¹ X)⁻¹ X' C⁻¹ from dense matrices, where C is the sum over the columns of all inputs.
fn projected(columns: &DMatrix<f64>, design: &DMatrix<f64>) -> DMatrix<f64> {
    let inverse = (columns * columns.transpose()).try_inverse().unwrap();
    let weighted = &inverse * design;
    &inverse - &weighted * (design.tr_mul(&weighted)).try_inverse().unwrap() * weighted.transpose()
}

/// Checks [`chi_square`] against r' C⁻ r by the pseudo-inverse of the residuals' covariance, for two methods.
#[test]
fn chi_square_is_that_of_the_residuals_of_any_method() {
    let mut stream = Stream::new(1);
    let uncertainty = InputUncertainty { level_rad: 2e-5, ..uncertainty(0.0) };
    let setup = with_uncertainty(&drawn_stand(&mut stream, 8.0), 40.0, uncertainty);
    let positions = &setup.coefficients().positions;
    let mut currents = currents(&setup, &gvk_6());
    currents.iter_mut().for_each(|current| *current = current.map(|j| j * (1.0 + stream.within(2e-4))));
    let data = Data::new(&setup, &readings(&setup, &currents));
    let fit = data.fit(&setup, Model::Paper).unwrap();
    let propagation = Propagation::new(&setup, &data, &fit);
    let ChiSquare { value: expected, degrees_of_freedom, .. } = chi_square(&propagation);
    assert_eq!(degrees_of_freedom, 8);
    let map = AnalyticMap::new(setup.coefficients(), &fit.currents_ma).unwrap();
    let closed = Unknowns::of(analytic::solve(setup.coefficients(), &currents).unwrap().parameters);
    let methods =
        [(fit.unknowns, propagation.least_squares()), (closed, propagation.analytic(&map, &propagation.causes).0)];
    for (unknowns, spread) in methods {
        let rows = positions.iter().zip(&currents).flat_map(|(at, j)| <[f64; 2]>::from(unknowns.misclosure(at, j)));
        let residuals = DVector::from_iterator(16, rows);
        let left = &propagation.causes - &propagation.design * &spread;
        let inverse = (&left * left.transpose()).pseudo_inverse(1e-14).unwrap();
        let found = residuals.dot(&(inverse * &residuals));
        assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
    }
}

/// Expected: tr P D and tr P D P D from dense matrices, where D is the sum of the inputs on one estimate.
#[test]
fn parts_are_those_of_dense_matrices() {
    let mut stream = Stream::new(5);
    let uncertainty = InputUncertainty {
        angles_degrees_of_freedom: vec![6.0; 8],
        repeatability_rad: 2e-5,
        repeatability_degrees_of_freedom: 18.0,
        common_platform_degrees_of_freedom: 3.0,
        common_base_rad: 1e-5,
        common_base_degrees_of_freedom: 4.0,
        ..uncertainty(1e-6)
    };
    let setup = with_uncertainty(&drawn_stand(&mut stream, 0.5), 55.0, uncertainty);
    let mut run = "cycle,i,j,jx_ma,jy_ma\n".to_owned();
    for (cycle, count) in [(1, 8), (2, 8), (3, 5)] {
        for (at, exact) in setup.coefficients().positions.iter().zip(currents(&setup, &gvk_6())).take(count) {
            let [x, y] = <[f64; 2]>::from(exact).map(|j| j + stream.within(1e-4));
            run += &format!("{cycle},{},{},{x},{y}\n", at.index.i, at.index.j);
        }
    }
    let readings = Readings::from_csv("run.csv", run.as_bytes(), setup.coefficients(), 1000.0).unwrap();
    for options in [Options::default(), Options { model: Model::General, ..Options::default() }] {
        let observation = observe(&setup, &readings, Method::LeastSquares, &options).unwrap();
        let Observation { fit, data, .. } = &observation;
        let (_, Estimated { parts, .. }) = quadratic_form(&Propagation::new(&setup, data, fit));
        let estimates = Estimates::new(&setup, &data.repeats);
        assert!(parts.len() >= 6, "angles, returns and noise, platform, base and turn-ons: {parts:?}");
        let (inputs, columns) = causes::inputs(&setup, data, fit);
        let design = fit.design(&data.offsets);
        let p = projected(&columns, &design);
        for (estimate, part) in parts.iter().enumerate() {
            let mut of_estimate = DMatrix::zeros(design.nrows(), design.nrows());
            for (input, column) in inputs.iter().zip(columns.column_iter()) {
                for (_, share) in input.basis.shares().filter(|(place, _)| *place == estimate) {
                    of_estimate.ger(share, &column, &column, 1.0);
                }
            }
            let seen = &p * of_estimate;
            let (trace, square) = (seen.trace(), (&seen * &seen).trace());
            assert_eq!(part.degrees_of_freedom, estimates.degrees_of_freedom[estimate]);
            // ω_0 absorbs the mean of the turn-ons, so nothing of it is left.
            let is = |found: f64, expected: f64| (found - expected).abs() < 1e-7 * expected.abs().max(1e-5);
            assert!(is(part.trace, trace), "{estimate}: {part:?} {trace}");
            assert!(is(part.square, square), "{estimate}: {part:?} {square}");
        }
        terms_are_those_of_dense_matrices(&setup, &observation);
    }
}

/// Checks chi-square with other variances of the visits, which scale the columns of that estimate, against y' P y.
fn terms_are_those_of_dense_matrices(setup: &Setup, Observation { fit, data, .. }: &Observation) {
    let (_, Estimated { visits, .. }) = quadratic_form(&Propagation::new(setup, data, fit));
    let (of_visits, terms) = visits.expect("a noise of the gyro that is estimated");
    let (inputs, columns) = causes::inputs(setup, data, fit);
    let design = fit.design(&data.offsets);
    let mut y: Vec<f64> = Vec::new();
    for (place, current) in data.currents_ma.iter().enumerate() {
        y.extend(fit.misclosure(place, current).iter());
    }
    y.extend(fit.of_differences(&data.offsets).iter());
    let y = DVector::from_vec(y);
    for factor in [0.05, 0.2, 1.0, 7.0] {
        let mut scaled = columns.clone();
        for (input, mut column) in inputs.iter().zip(scaled.column_iter_mut()) {
            column *= if input.basis == Basis::Estimate(of_visits) { f64::sqrt(factor) } else { 1.0 };
        }
        let due = y.dot(&(projected(&scaled, &design) * &y));
        let found: f64 = terms.iter().map(|term| term.with(factor)).sum();
        assert!((found / due - 1.0).abs() < 1e-6, "{factor}: {found} {due}");
    }
}

/// Expected: dense matrices, for a run whose noise of visits is far larger than stated.
#[cfg(feature = "factory")]
#[test]
fn terms_of_a_run_with_a_jolt_are_those_of_dense_matrices() {
    use dtg_passport::laboratory::Laboratory;
    use dtg_passport::site::Site;
    use dtg_passport::stand::Stand;

    let stand = Stand::from_yaml("stand.yaml", include_bytes!("../cmd/files/stand.yaml")).unwrap();
    let site = Site::from_yaml("here.yaml", include_bytes!("../cmd/files/sites/here.yaml")).unwrap();
    let (setup, _) = Setup::stated(&stand.certificate, &stand.positions, &site, &Laboratory::paper()).unwrap();
    let jolt = include_str!("../cmd/files/run.csv").replace("2,4,-0.22799247,", "2,4,-0.22749247,");
    assert_ne!(jolt, include_str!("../cmd/files/run.csv"));
    let readings = Readings::from_csv("jolt.csv", jolt.as_bytes(), setup.coefficients(), 1.0).unwrap();
    let observation = observe(&setup, &readings, Method::LeastSquares, &Options::default()).unwrap();
    terms_are_those_of_dense_matrices(&setup, &observation);
}
