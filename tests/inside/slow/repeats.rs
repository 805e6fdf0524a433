//! Rows and visits: what reading again makes smaller, and whether the scatter is what was stated.

use super::{equations, errors_of, least_squares_only};
use crate::inside::reference::*;
use dtg_passport::calibration::noise::NoiseSource;
use dtg_passport::calibration::parameter::Parameter;
use dtg_passport::calibration::readings::Reading;
use dtg_passport::calibration::scatter::Agreement;
use dtg_passport::calibration::{
    Calibration, CalibrationDocument, Finding, InputUncertainty, Kind, Method, Options, Readings, Setup, calibrate,
};
use dtg_passport::interface::calibrated::Done;
use dtg_passport::report::calibration as report;
use dtg_passport::statistics::random::Stream;
use dtg_passport::uncertainty::engine::Engine;
use dtg_passport::uncertainty::{Budget, monte_carlo};
use dtg_passport::units::radians_from_arcseconds;
use dtg_passport::wording::Language;
use nalgebra::{Matrix2, SMatrix, Vector2};

const REPEATABILITY_ARCSEC: f64 = 4.0;

/// A stand that returns within [`REPEATABILITY_ARCSEC`], and a meter of the paper's accuracy with the noise `noise_ma`.
fn bench(noise_ma: f64) -> Setup {
    with_noise(noise_ma, Some(0.0))
}

/// Returns the set-up of a bench whose gyro has a noise from visit to visit.
fn with_noise(noise_ma: f64, visit_deg_per_h: Option<f64>) -> Setup {
    let mut u = InputUncertainty::of_meter(paper_meter());
    u.meter.noise_ma = noise_ma;
    u.visit_deg_per_h = visit_deg_per_h;
    u.repeatability_rad = radians_from_arcseconds(REPEATABILITY_ARCSEC);
    with_uncertainty(&drawn_stand(&mut Stream::new(8), 2.0), LATITUDE_DEG, u)
}

/// Exact currents of the paper's gyro with errors added: `error(place, visit, row)`, mA.
fn rows(setup: &Setup, visits: u32, rows: u32, mut error: impl FnMut(usize, u32, u32) -> Vector2<f64>) -> Vec<Reading> {
    let exact = currents(setup, &gvk_6());
    let mut all = Vec::new();
    for visit in 1..=visits {
        for (place, (at, exact)) in setup.coefficients().positions.iter().zip(&exact).enumerate() {
            for row in 0..rows {
                all.push(Reading::new(at.index, exact + error(place, visit, row)));
            }
        }
    }
    all
}

fn solved(setup: &Setup, rows: &[Reading]) -> Calibration {
    let readings = Readings::of_rows(setup.coefficients(), rows).unwrap();
    calibrate(setup, &readings, &Options::default()).unwrap()
}

/// Returns the text that `calibrate` prints for a calibration without remarks.
fn text_of(setup: &Setup, readings: Readings, calibration: Calibration) -> String {
    let done = Done {
        setup: setup.clone(),
        readings,
        missing: Vec::new(),
        document: CalibrationDocument::new("SPS-2/0017/here/1", true, (9.8, None), &calibration, &[]),
        calibration,
        earlier: None,
        unknown_gyro: None,
        cost_of_missing: None,
        further: None,
        warning: None,
        unchecked_range_c: None,
        without_height: false,
    };
    let details = report::Said { language: Language::English, meter_assumed: false, checks: &[] };
    report::text(&done, None, &report::Report::of(&done, None, &[], true), &details)
}

fn u(calibration: &Calibration, parameter: Parameter) -> f64 {
    calibration.results.last().unwrap().standard_uncertainty(parameter).unwrap()
}

/// Ten rows in place repeat the meter's error of that position and the return: they are no ten returns.
#[test]
fn rows_in_place_make_neither_the_specification_nor_the_return_smaller() {
    let setup = bench(0.0);
    let mut stream = Stream::new(31);
    let mut alarms = 0;
    for _ in 0..40 {
        let own = errors_of(setup.uncertainty().meter, &currents(&setup, &gvk_6()), &mut stream);
        let mut noise = || Vector2::from_fn(|_, _| 1e-7 * stream.normal());
        let ten = solved(&setup, &rows(&setup, 1, 10, |place, _, _| own[place] + noise()));
        let one = solved(&setup, &rows(&setup, 1, 1, |place, _, _| own[place]));
        for parameter in Parameter::EIGHT {
            let ratio = u(&ten, parameter) / u(&one, parameter);
            assert!((ratio - 1.0).abs() < 1e-3, "{}: {ratio}", parameter.symbol());
        }
        assert_eq!(ten.scatter, None);
        let scatter = ten.row_scatter.unwrap();
        assert!((scatter.standard_deviation_ma / 1e-7 - 1.0).abs() < 0.25, "{scatter:?}");
        assert!(scatter.degrees_of_freedom == 144 && scatter.chi_square.is_none(), "{scatter:?}");
        alarms += u32::from(!ten.consistent);
    }
    assert!(alarms <= 1, "{alarms}");
}

/// Expected by hand: of rows −2, −1, 0, 1, 2 about their mean the products of successive ones have the sum 4, and the squares
/// 10. The errors of a logger that reads faster than its filter settles; independent errors are not named.
#[test]
fn correlated_rows_are_named() {
    let setup = bench(0.0);
    let ramp = rows(&setup, 3, 5, |_, _, row| Vector2::repeat(1e-6 * (f64::from(row) - 2.0)));
    let found = solved(&setup, &ramp);
    let of =
        |found: &Calibration| found.causes.iter().find(|one| one.kind == Kind::RowsCorrelated).and_then(|one| one.size);
    assert!((of(&found).unwrap() - 0.4).abs() < 1e-9, "{:?}", found.causes);
    let text = text_of(&setup, Readings::of_rows(setup.coefficients(), &ramp).unwrap(), found);
    assert!(text.contains("Successive readings of a visit are correlated (0.40)"), "{text}");

    let mut stream = Stream::new(77);
    let independent = (0..300).filter(|_| {
        let rows = rows(&setup, 1, 8, |_, _, _| Vector2::from_fn(|_, _| 1e-6 * stream.normal()));
        of(&solved(&setup, &rows)).is_some()
    });
    // Nominal: 0.14.
    assert_eq!(independent.count(), 0);
    let mut filtered = Vector2::zeros();
    let slow = rows(&setup, 1, 60, |_, _, _| {
        filtered = 0.9 * filtered + Vector2::from_fn(|_, _| 1e-7 * stream.normal());
        filtered
    });
    // Expected: 0.9, less (1 + 4 · 0.9)/60 (bias of 60 rows, Kendall), within four standard deviations of 16 series.
    let found = of(&solved(&setup, &slow)).unwrap();
    let error = 4.0 * ((1.0 - 0.9_f64.powi(2)) / (60.0 * 16.0)).sqrt();
    assert!((found - (0.9 - 4.6 / 60.0)).abs() < error, "{found}");
}

/// Expected: C_p = K [diag((ρ J)² + f²) + ν²/(m k)] K′ + R/m with returns R, and u² = diag (Σ F_p′ C_p⁻¹ F_p)⁻¹ with the
/// rows (J, 1, n) of a position: by dense matrices, nothing of the library's but the vectors of the positions and R,
/// which follows from u of one visit without noise.
#[test]
fn uncertainties_are_those_of_the_formula() {
    let noise_ma = 3e-5;
    let setup = bench(noise_ma);
    let (visits, reads) = (3, 4);
    let mut stream = Stream::new(5);
    // Small errors, so that nothing scatters more than stated; nor so little that it matters here.
    let mut error = |_, _, _| Vector2::from_fn(|_, _| noise_ma * stream.normal());
    let found = solved(&setup, &rows(&setup, visits, reads, &mut error));
    let meter = setup.uncertainty().meter;
    let gyro = gvk_6();
    let k = gyro.k_deg_per_h_per_ma;
    let earth = dtg_passport::coefficients::EarthRate::at_astronomic_latitude(LATITUDE_DEG);
    let mut information = SMatrix::<f64, 8, 8>::zeros();
    for (at, j) in drawn_stand(&mut Stream::new(8), 2.0).iter().zip(currents(&setup, &gyro)) {
        let attitude = dtg_passport::attitude::actual(at.theta_deg, at.phi_deg, &at.deviation);
        let rate = attitude * nalgebra::Vector3::new(0.0, earth.horizontal_deg_per_h, earth.vertical_deg_per_h);
        let n = attitude.column(2).into_owned();
        let mut returns = Matrix2::zeros();
        for axis in 0..3 {
            let turn = nalgebra::Vector3::from_fn(|row, _| if row == axis { 1.0 } else { 0.0 });
            let change = rate.cross(&turn).xy() - gyro.omega_n_deg_per_h_per_g() * n.cross(&turn).xy();
            returns += change * change.transpose() * radians_from_arcseconds(REPEATABILITY_ARCSEC).powi(2);
        }
        let specification = j.map(|j| (meter.reading * j).powi(2) + meter.floor_ma.powi(2));
        let noise = noise_ma * noise_ma / f64::from(visits * reads);
        let own = Matrix2::from_diagonal(&specification.map(|variance| variance + noise));
        let covariance = k * own * k.transpose() + returns / f64::from(visits);
        let equations = equations(j, n.xy());
        information += equations.transpose() * covariance.try_inverse().unwrap() * equations;
    }
    let due = information.try_inverse().unwrap();
    for parameter in Parameter::EIGHT {
        let place = parameter.place();
        let ratio = u(&found, parameter) / due[(place, place)].sqrt();
        // The fit takes its currents from the readings, whose errors are 1e-4 of them.
        assert!((ratio - 1.0).abs() < 2e-3, "{}: {ratio}", parameter.symbol());
    }
    assert_eq!(found.scatter.unwrap().degrees_of_freedom, 2 * 2 * 8);
    assert_eq!(found.row_scatter.unwrap().degrees_of_freedom, 2 * 3 * 3 * 8);
}

/// Visits that agree better than the stand returns are no visits; rows that are noisier than stated are noisy.
#[test]
fn scatter_is_judged_in_both_tails() {
    let setup = bench(2e-5);
    let with = |visit_ma: f64, row_ma: f64| {
        let mut stream = Stream::new(12);
        let mut of_visit = Vector2::zeros();
        let read = rows(&setup, 6, 3, |_, _, row| {
            if row == 0 {
                of_visit = Vector2::from_fn(|_, _| visit_ma * stream.normal());
            }
            of_visit + Vector2::from_fn(|_, _| row_ma * stream.normal())
        });
        let found = solved(&setup, &read);
        let (visits, rows) = (found.scatter.unwrap(), found.row_scatter.unwrap().against_stated().unwrap());
        (
            visits.agreement(),
            rows.agreement(),
            rows.variance_factor,
            text_of(&setup, Readings::of_rows(setup.coefficients(), &read).unwrap(), found),
        )
    };
    let (visits, rows, factor, text) = with(0.0, 1e-6);
    assert_eq!((visits, rows, factor), (Agreement::Less, Agreement::Less, 1.0));
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        text.contains("less than stated. Readings taken without leaving the position belong to one visit"),
        "{text}"
    );
    assert!(text.contains("less than stated. Check whether the readings are copies of one reading"), "{text}");
    let (visits, rows, factor, text) = with(1e-3, 2e-4);
    assert_eq!((visits, rows), (Agreement::More, Agreement::More));
    // By hand: ten times the stated standard deviation; 192 degrees of freedom leave 10 %.
    assert!((factor / 100.0 - 1.0).abs() < 0.35, "{factor}");
    assert!(text.contains("factor applied to the variance"), "{text}");
}

/// What nobody states of rows or visits, repeated readings show; expected by hand. Two rows of a visit are no two visits.
#[test]
fn noise_that_is_not_stated_is_found_from_the_readings() {
    let setup = setup(&drawn_stand(&mut Stream::new(8), 2.0), LATITUDE_DEG);
    let sign = |row: u32| Vector2::repeat(if row == 0 { 1e-5 } else { -1e-5 });
    let found = solved(&setup, &rows(&setup, 1, 2, |_, _, row| sign(row)));
    let of_rows = found.row_scatter.unwrap();
    // Σ squares 2 · 8 · 2 · (1e-5)², 2 · 8 degrees of freedom.
    assert!((of_rows.standard_deviation_ma / (2.0_f64.sqrt() * 1e-5) - 1.0).abs() < 1e-9, "{of_rows:?}");
    assert_eq!((found.scatter, of_rows.degrees_of_freedom, of_rows.chi_square), (None, 16, None));
    let visited = solved(&setup, &rows(&setup, 2, 1, |_, visit, _| sign(visit - 1)));
    assert_eq!((visited.row_scatter, visited.scatter), (None, None));
    // Each visit is K (1e-5, 1e-5) mA off the mean of its position: 2 · 8 squares, 2 · 8 degrees of freedom, and K of the
    // paper's gyro gives |K (1, 1)| = √2 · 104.5 °/(h·mA).
    let noise = visited.visit_noise;
    assert_eq!((noise.source, noise.degrees_of_freedom), (NoiseSource::Estimated, 16.0));
    assert!((noise.deg_per_h / (2.0_f64.sqrt() * 104.5e-5) - 1.0).abs() < 1e-3, "{noise:?}");
}

/// Monte Carlo draws what first order adds up: visits, rows, and an estimate that the angles share.
#[test]
fn monte_carlo_draws_the_same_structure() {
    let mut u = bench(4e-5).uncertainty().clone();
    u.angles_rad = vec![[radians_from_arcseconds(3.0); 3]; 8];
    u.angles_degrees_of_freedom = vec![60.0; 8];
    u.repeatability_degrees_of_freedom = 180.0;
    u.common_platform_rad = radians_from_arcseconds(2.0);
    u.common_platform_degrees_of_freedom = 40.0;
    u.common_base_rad = radians_from_arcseconds(2.0);
    u.common_base_degrees_of_freedom = 40.0;
    // What is not stated would be estimated, with few degrees of freedom.
    u.visit_deg_per_h = Some(0.0);
    let setup = with_uncertainty(&drawn_stand(&mut Stream::new(8), 2.0), LATITUDE_DEG, u);
    let mut stream = Stream::new(5);
    let rows = rows(&setup, 2, 2, |_, _, _| Vector2::from_fn(|_, _| 4e-5 * stream.normal()));
    let readings = Readings::of_rows(setup.coefficients(), &rows).unwrap();
    for method in [Method::Analytic, Method::LeastSquares] {
        let engine = Engine::new(&setup, &readings, method).unwrap();
        let budget = Budget::new(&setup, &readings, method, &Options::default()).unwrap();
        let trials = monte_carlo::Trials { trials: Some(150_000), seed: 4, threads: 2, cancel: None, progress: None };
        let found = monte_carlo::monte_carlo(&engine, &budget, &trials);
        for (line, trials) in budget.parameters.iter().zip(&found.parameters) {
            // Student's t with 40 degrees of freedom and more has up to 2.5 % more standard deviation than its scale.
            let ratio = trials.standard_uncertainty / line.standard_uncertainty;
            assert!((0.995..1.028).contains(&ratio), "{}: {ratio}", line.parameter.key());
            let end = (trials.symmetric[1] - line.value) / line.expanded_uncertainty();
            assert!((end - 1.0).abs() < 0.02, "{}: {end}", line.parameter.key());
        }
    }
}

/// Four positions give eight numbers for eight unknowns: any readings fit.
#[test]
fn too_few_readings_to_judge() {
    let all = drawn_stand(&mut Stream::new(8), 2.0);
    let four: Vec<_> = [0, 1, 5, 6].map(|place| all[place]).into();
    let setup = setup(&four, LATITUDE_DEG);
    let mut exact = currents(&setup, &gvk_6());
    exact[2] *= 1.5;
    let found = calibrate(&setup, &readings(&setup, &exact), &least_squares_only()).unwrap();
    let chi_square = found.results[0].chi_square;
    assert!(!chi_square.judges() && chi_square.value == 0.0, "{chi_square:?}");
    let document = CalibrationDocument::new("a/b/c/1", true, (9.8, None), &found, &[]);
    let json: serde_json::Value = serde_json::to_value(&document).unwrap();
    let result = &json["results"][0];
    assert_eq!(result["chi_square"], serde_json::json!({"value": 0.0, "degrees_of_freedom": 0}));
    assert!(result.get("residuals_deg_per_h").is_none());
    let bytes = serde_json::to_vec(&document).unwrap();
    assert_eq!(CalibrationDocument::from_json("earlier.json", &bytes).unwrap(), document);
    let text = text_of(&setup, readings(&setup, &exact), found);
    assert!(text.contains("The fit cannot be tested") && !text.contains("chi-square"), "{text}");
    assert!(!text.contains("x/u_x"), "{text}");
}

/// Runs in which the gyro drifts from visit to visit by 0.001 °/h, not stated, with `cycles` turn-ons (0.01 °/h), `visits`
/// to each position and `count` rows of each, whose noise is 1e-6 mA; rounded to `digits`. `error` is added to one row.
fn run(
    stream: &mut Stream,
    [cycles, visits, count]: [u32; 3],
    digits: usize,
    error: impl Fn([u32; 3]) -> f64,
) -> String {
    let setup = bench(0.0);
    let gyro = currents(&setup, &gvk_6());
    let mut text = "i,j,jx_ma,jy_ma,cycle,visit\n".to_owned();
    for cycle in 1..=cycles {
        let turn_on = Vector2::new(stream.normal(), stream.normal()) * (0.01 / 95.0);
        for visit in 1..=visits {
            for (place, (at, exact)) in setup.coefficients().positions.iter().zip(&gyro).enumerate() {
                let of_visit = exact + turn_on + Vector2::new(stream.normal(), stream.normal()) * (0.001 / 95.0);
                for row in 1..=count {
                    let noise = Vector2::new(stream.normal(), stream.normal()) * 1e-6;
                    let off = if place == 6 { error([cycle, visit, row]) } else { 0.0 };
                    let [x, y] = (of_visit + noise).data.0[0];
                    let (i, j) = (at.index.i, at.index.j);
                    text += &format!("{i},{j},{:.digits$},{y:.digits$},{cycle},{visit}\n", x + off);
                }
            }
        }
    }
    text
}

/// Position and visit of a suspect.
fn place(found: &Finding) -> (u32, u32, u32) {
    (found.scope.i.unwrap(), found.scope.j.unwrap(), found.scope.visit.unwrap())
}

fn suspects(text: &str) -> Vec<Finding> {
    suspects_of(text, 0.0, None)
}

fn suspects_of(text: &str, noise_ma: f64, visit_deg_per_h: Option<f64>) -> Vec<Finding> {
    let setup = with_noise(noise_ma, visit_deg_per_h);
    let readings = Readings::from_csv("run.csv", text.as_bytes(), setup.coefficients(), 1.0).unwrap();
    calibrate(&setup, &readings, &least_squares_only()).unwrap().suspects().cloned().collect()
}

/// Designs: turn-ons, visits and rows, and the digits of the currents. In the last the rows differ by hardly a digit.
const DESIGNS: [([u32; 3], usize); 5] =
    [([3, 1, 1], 9), ([1, 2, 1], 9), ([1, 4, 1], 9), ([1, 2, 10], 9), ([1, 2, 10], 6)];

/// Digits with which the visits of [`run`] hardly differ.
const COARSE: [([u32; 3], usize); 3] = [([1, 2, 1], 4), ([1, 4, 1], 4), ([1, 2, 10], 4)];

/// Good runs of each kind. Of 2000, 2 or 4 are expected to have a suspect; more than 12 have a probability below 1e-3.
fn good_runs() -> u64 {
    super::trials(2_000)
}

/// Good readings are suspect as rarely as the probability says: 0.1 % for the visits, and again for the rows.
#[test]
fn good_readings_are_hardly_ever_suspect() {
    let runs = good_runs();
    for (number, (design, digits)) in DESIGNS.into_iter().chain(COARSE).enumerate() {
        let mut stream = Stream::new(400 + number as u64);
        let suspect = (0..runs).filter(|_| !suspects(&run(&mut stream, design, digits, |_| 0.0)).is_empty()).count();
        println!("{design:?} (turn-ons, visits, rows), {digits} digits: {suspect} of {runs} good runs with a suspect");
        assert!(1000 * suspect as u64 <= 6 * runs, "{design:?}: {suspect}");
    }
}

/// Only one or two positions are visited twice. Their visits are compared with the fit of all readings, or with the stated
/// noise. Without a stated noise, the residuals of the fit show that of the gyro.
#[test]
fn a_closing_visit_is_compared_with_the_fit() {
    let runs = good_runs();
    for (again, stated, error_ma) in
        [(vec!["2,3,"], None, 4e-4), (vec!["2,3,"], Some(0.001), 2e-4), (vec!["2,3,", "1,1,"], Some(0.001), 2e-4)]
    {
        let closing = |stream: &mut Stream, off: u32| {
            let all = run(stream, [1, 2, 1], 9, |[_, visit, _]| if visit == off { error_ma } else { 0.0 });
            let is_again = |line: &str| again.iter().any(|position| line.starts_with(position));
            let kept = all.lines().filter(|line| !line.ends_with(",2") || is_again(line));
            suspects_of(&kept.map(|line| line.to_owned() + "\n").collect::<String>(), 0.0, stated)
        };
        let case = format!("visited again: {again:?}, stated noise {stated:?}");
        let mut stream = Stream::new(600);
        let suspect = (0..runs).filter(|_| !closing(&mut stream, 0).is_empty()).count();
        println!("{case}: {suspect} of {runs} good runs with a suspect");
        assert!(1000 * suspect as u64 <= 6 * runs, "{case}: {suspect}");
        for off in [1, 2] {
            let found = (0..200).map(|_| closing(&mut stream, off));
            let is_named = |found: &Vec<Finding>| found.iter().any(|one| place(one) == (2, 3, off));
            let named = found.filter(|found| is_named(found) && !found[0].one_of_several).count();
            println!("{case}: {named} of 200 wrong visits {off} named alone");
            assert!(named > 180, "{case}, {off}: {named}");
        }
    }
}

/// A visit that is off by 19 times the gyro's noise and a row that is off by 20 times the meter's are named, and no other.
#[test]
fn one_visit_off_and_one_row_off_are_named() {
    let runs = 200_usize;
    for (number, (design @ [cycles, visits, rows], digits)) in DESIGNS.into_iter().enumerate() {
        let mut stream = Stream::new(500 + number as u64);
        let (mut named, mut others) = (0, 0);
        for _ in 0..runs {
            let of_visit = run(&mut stream, design, digits, |at| if at[..2] == [cycles, visits] { 2e-4 } else { 0.0 });
            let found = suspects(&of_visit);
            let right = |found: &Finding| {
                (place(found), found.scope.cycle, found.scope.row) == ((2, 3, visits), Some(cycles), None)
            };
            named += usize::from(found.iter().any(right));
            others += found.iter().filter(|one| !right(one) && !one.one_of_several).count();
        }
        println!("{design:?}, {digits} digits: {named} of {runs} wrong visits named, {others} others");
        assert!(named > 9 * runs / 10 && 50 * others <= runs, "{design:?}: {named}, {others}");
        if rows > 1 {
            let at = |place: [u32; 3]| if place == [1, 2, 4] { 2e-5 } else { 0.0 };
            let found = (0..runs).map(|_| suspects(&run(&mut stream, design, digits, at)));
            let named = |found: &Vec<Finding>| {
                found.first().is_some_and(|one| (place(one), one.scope.row) == ((2, 3, 2), Some(4)))
            };
            assert!(found.filter(named).count() > 9 * runs / 10);
            // Twice the noise that is stated for a reading is no error, although the readings scatter less.
            let found = (0..runs).flat_map(|_| suspects_of(&run(&mut stream, design, digits, at), 1e-5, None));
            assert_eq!(found.filter(|one| one.scope.row.is_some()).count(), 0);
        }
    }
}
