//! Budgets and covariances against GTC and suncal, and their own rules.

use super::cases::{Case, three};
use crate::inside::programs;
use crate::inside::reference::*;
use dtg_passport::attitude;
use dtg_passport::calibration::causes::Cause;
use dtg_passport::calibration::parameter::Parameter;
use dtg_passport::calibration::{InputUncertainty, Method, Options, calibrate};
use dtg_passport::gyro::GyroType;
use dtg_passport::uncertainty::Budget;
use dtg_passport::units::{radians_from_arcseconds, radians_from_degrees};
use serde_json::{Value, json};
use std::io::Write;
use std::process::Stdio;

/// Samples of suncal's Monte Carlo.
const SAMPLES: f64 = 20_000.0;

/// What another program needs to know of a case.
fn described(case: &Case) -> Value {
    let u = case.setup.uncertainty();
    let currents = case.readings.means_ma();
    let positions: Vec<Value> = case
        .positions
        .iter()
        .enumerate()
        .map(|(place, at)| {
            let nominal = attitude::nominal(at.theta_deg, at.phi_deg) * case.base();
            let rows: Vec<Vec<f64>> = nominal.row_iter().map(|row| row.iter().copied().collect()).collect();
            let df = u.angles_degrees_of_freedom[place];
            json!({
                "nominal": rows,
                "angles": [at.deviation.alpha_rad, at.deviation.beta_rad, at.deviation.gamma_rad],
                "u": u.angles_rad[place],
                "df": df.is_finite().then_some(df),
                "currents": [currents[place].x, currents[place].y],
            })
        })
        .collect();
    json!({
        "samples": SAMPLES,
        "latitude": radians_from_degrees(case.latitude_deg),
        "rate": dtg_passport::earth::rotation_deg_per_h(),
        "positions": positions,
        "u": {
            "return": u.repeatability_rad, "platform": u.common_platform_rad, "base": u.common_base_rad,
            "latitude": u.latitude_rad, "deflection": u.deflection_rad, "azimuth": u.azimuth_rad,
            "level": u.level_rad, "seat": u.seating_rad, "reading": u.meter.reading, "floor": u.meter.floor_ma,
            "gain": u.meter.gain, "offset": u.meter.offset_ma,
        },
    })
}

/// What the Python script of that name says of each case.
fn asked(script: &str, cases: &[Case]) -> Vec<Value> {
    let mut python = programs::python();
    python.arg(programs::project(&format!("tests/inside/slow/uncertainty/{script}")));
    let mut child = python.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("Python runs");
    let described: Value = cases.iter().map(described).collect();
    child.stdin.take().expect("a pipe").write_all(described.to_string().as_bytes()).expect("it reads");
    let output = child.wait_with_output().expect("it ends");
    assert!(output.status.success(), "{script} failed");
    serde_json::from_slice(&output.stdout).expect("JSON")
}

fn budget(case: &Case, method: Method) -> Budget {
    Budget::new(&case.setup, &case.readings, method, &Options::default()).unwrap()
}

/// Expected: GTC's covariances (automatic differentiation), 1e-9 of the two standard deviations; its degrees of freedom.
#[test]
fn covariances_are_those_of_gtc() {
    let (mut worst, mut of_freedom) = (0.0_f64, 0.0_f64);
    let cases = three();
    for (case, theirs) in cases.iter().zip(asked("gtc_budget.py", &cases)) {
        let budget = budget(case, Method::Analytic);
        let (ours, due) = (budget.covariance(), numbers(&theirs["covariance"]));
        for row in 0..8 {
            for column in 0..8 {
                let scale = (ours[(row, row)] * ours[(column, column)]).sqrt();
                worst = worst.max((ours[(row, column)] - due[8 * row + column]).abs() / scale);
            }
            let found = budget.parameters[row].effective_degrees_of_freedom;
            match theirs["degrees_of_freedom"][row].as_f64() {
                Some(due) => of_freedom = of_freedom.max((found / due - 1.0).abs()),
                None => assert!(found.is_infinite()),
            }
        }
    }
    println!(
        "largest difference from GTC, of the standard deviations: {worst:.1e}; of degrees of freedom: {of_freedom:.1e}"
    );
    assert!(worst < 1e-9 && of_freedom < 1e-9, "{worst:e} {of_freedom:e}");
}

/// The contributions add up to what a calibration states, for every method.
#[test]
fn a_budget_adds_up_to_the_uncertainty_of_the_calibration() {
    for case in three() {
        let calibration = calibrate(&case.setup, &case.readings, &Options::default()).unwrap();
        for result in &calibration.results {
            let budget = budget(&case, result.method);
            let covariance = budget.covariance();
            for (row, line) in budget.parameters.iter().enumerate() {
                let u = result.standard_uncertainty(line.parameter).unwrap();
                assert!((line.standard_uncertainty / u - 1.0).abs() < 1e-10);
                let shares: f64 = line.contributions.iter().map(|part| part.share).sum();
                assert!((shares - 1.0).abs() < 1e-12);
                assert!(line.contributions.is_sorted_by(|a, b| a.contribution >= b.contribution));
                // A gyro that is turned about its spin axis has the same ω_g and ω_k (see `calibration::finding::by_type`): a
                // contribution of the seat is only rounding.
                if matches!(line.parameter, Parameter::OmegaG | Parameter::OmegaK) {
                    let seat = line.contributions.iter().find(|part| part.cause.kind() == "gyro seat about z").unwrap();
                    assert_eq!((seat.contribution, seat.share), (0.0, 0.0));
                }
                for column in 0..8 {
                    let scale = (covariance[(row, row)] * covariance[(column, column)]).sqrt();
                    assert!((covariance[(row, column)] - result.covariance[(row, column)]).abs() < 1e-10 * scale);
                }
            }
        }
    }
}

/// Expected: reproduction.md, a seat 30" off about the spin axis costs 0.145 % of K_xy; half of that is at 15".
#[test]
fn the_sentence_is_computed() {
    let seat = |arcsec: f64| {
        let mut uncertainty = InputUncertainty::of_meter(paper_meter());
        uncertainty.meter.reading = 1e-6;
        uncertainty.seating_rad[2] = radians_from_arcseconds(arcsec);
        let setup = with_uncertainty(&eight([[0.0; 3]; 8]), LATITUDE_DEG, uncertainty);
        let readings = readings(&setup, &currents(&setup, &gvk_6()));
        Budget::new(&setup, &readings, Method::LeastSquares, &Options::default()).unwrap()
    };
    let said = seat(30.0).to_json(Some(&GyroType::gvk_6().tolerance))["sentence"].to_string();
    let due = "\"Largest uncertainty relative to tolerance: ω_0x, u = 0.0029 °/h. One source contributes nearly all of its variance (100 %): gyro seat about z. To halve u, reduce the uncertainty of this source to 14″ or less.\"";
    assert!(said == due || said == due.replace("0x", "0y"), "{said}");
    // Compared with their own size alone, the cross scale factors are the worst.
    let said = seat(30.0).to_json(None)["sentence"].to_string();
    assert!(said.contains(": K_xy, u = 0.15 %.") || said.contains(": K_yx, u = 0.15 %."), "{said}");
    // What it asks for does halve.
    let (before, after) = (seat(30.0), seat(14.0));
    assert!(after.parameters[1].standard_uncertainty < 0.5 * before.parameters[1].standard_uncertainty);
    let seats: Vec<_> = before.inputs.iter().filter(|input| matches!(input.cause, Cause::Seat(_))).collect();
    assert_eq!(seats.len(), 1);
    assert_eq!(before.parameters[0].parameter, Parameter::Kx);
}

/// Expected: suncal's Monte Carlo, within five standard errors of a standard deviation, u/√(2n).
#[test]
fn uncertainties_are_those_of_suncal() {
    let (cases, mut worst) = (three(), 0.0_f64);
    for (case, theirs) in cases.iter().zip(asked("suncal_budget.py", &cases)) {
        for (place, line) in budget(case, Method::Analytic).parameters.iter().enumerate() {
            let ratio = theirs[place].as_f64().unwrap() / line.standard_uncertainty - 1.0;
            worst = worst.max(ratio.abs() * (2.0 * SAMPLES).sqrt());
        }
    }
    println!("largest difference from suncal: {worst:.1} standard errors of its Monte Carlo");
    assert!(worst < 5.0, "{worst}");
}
