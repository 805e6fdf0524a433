//! Calibration as programs in other languages call it: from a passport and currents to JSON.

use dtg_passport::calibration::{CalibrationDocument, Method, Options};
use dtg_passport::gyro::{GyroNoise, GyroType};
use dtg_passport::interface::{Order, calibrate_json, earlier};
use dtg_passport::passport::content_from_anyone;
use serde_json::Value;

const PASSPORT: &[u8] = include_bytes!("../../passports/SPS-2/0017/moscow-bmstu-1.yaml");
const CURRENTS: &str = include_str!("../../docs/currents.csv");

fn default() -> Order {
    "{}".parse().unwrap()
}

/// The result of the shipped passport with these currents, valid or not.
fn calibrated(currents: &str, order: &Order) -> String {
    let content = content_from_anyone("p", PASSPORT).unwrap();
    calibrate_json(&content, None, ("c", currents.as_bytes()), order).unwrap_or_else(|failed| failed.result.unwrap())
}

fn json(result: &str) -> Value {
    serde_json::from_str(result).unwrap()
}

/// The currents are those of a gyro on another stand.
#[test]
fn readings_that_do_not_fit_pass_nothing_and_say_so() {
    let other = include_bytes!("../../passports/SPS-1/0203/moscow-bmstu-1.yaml");
    let content = content_from_anyone("p", other).unwrap();
    let mut wide = GyroType::gvk_6();
    (wide.tolerance.k_main_percent, wide.tolerance.k_cross_percent) = (20.0, Some(100.0));
    (wide.tolerance.omega0_deg_per_h, wide.tolerance.omega_g_deg_per_h_per_g) = (1e3, 1e3);
    wide.tolerance.omega_k_deg_per_h_per_g = 1e3;
    let order = Order { gyro: Some(wide), ..default() };
    let failed = calibrate_json(&content, None, ("c", CURRENTS.as_bytes()), &order).unwrap_err();
    assert!(failed.message.starts_with("the readings are not consistent with this stand"), "{failed}");
    let text = failed.result.clone().unwrap();
    assert_eq!((failed.to_json(), earlier(&text)), (text.clone(), Err(failed)));
    let result = json(&text);
    assert_eq!((&result["consistent"], &result["verdict"]["overall"]), (&false.into(), &"undecided".into()));
    let remarks = result["remarks"].as_array().unwrap();
    let is_said = |remark: &Value| remark.as_str().unwrap().starts_with("The readings are not consistent");
    assert!(remarks.iter().any(is_said), "{remarks:?}");
    // Where nothing is decided, no decision can be wrong.
    let rows = result["verdict"]["parameters"].as_array().unwrap();
    assert_eq!((rows.len(), rows.iter().filter(|row| row.get("specific_risk").is_some()).count()), (8, 0));
    let found = calibrated(CURRENTS, &order);
    let result = json(&found);
    assert_eq!((&result["consistent"], &result["verdict"]["overall"]), (&true.into(), &"pass".into()));
    assert_eq!((&result["adopted"], result.get("remarks"), earlier(&found)), (&"least-squares".into(), None, Ok(())));
}

/// Expected: the uncertainties of a change between two results that both include the noise. The small differences come from
/// the weights of the result without noise.
#[test]
fn a_noise_that_only_one_result_includes_counts_in_both() {
    let second = CURRENTS.replace("-0.2003831", "-0.2003841");
    let noisy = GyroNoise { visit_deg_per_h: Some(0.001), turn_on_deg_per_h: Some(0.005) };
    let with_noise = |currents: &str, noise: Option<&GyroNoise>, previous: Option<&str>| {
        let previous = previous.map(|json| CalibrationDocument::from_json("r", json.as_bytes()).unwrap());
        let gyro = Some(GyroType { noise: noise.cloned(), ..GyroType::gvk_6() });
        let options = Options { methods: vec![Method::LeastSquares], ..Options::default() };
        let order = Order { gyro, options, previous: previous.into_iter().collect(), ..default() };
        calibrated(currents, &order)
    };
    let change = |now: Option<&GyroNoise>, before: Option<&GyroNoise>| {
        let previous = with_noise(CURRENTS, before, None);
        let found = json(&with_noise(&second, now, Some(&previous)));
        let parameters = found["change"]["parameters"].as_array().unwrap();
        let u = parameters.iter().map(|line| line["standard_uncertainty"].as_f64().unwrap()).collect::<Vec<_>>();
        let remarks = found["remarks"].as_array().into_iter().flatten();
        let said = remarks.filter(|words| words.as_str().unwrap().starts_with("Only one of the two")).count();
        (u, said)
    };
    let (both, said) = change(Some(&noisy), Some(&noisy));
    let (neither, _) = change(None, None);
    assert_eq!((said, both.len()), (0, 8));
    assert!(both[4] > 1.5 * neither[4], "{both:?} {neither:?}");
    for one in [change(Some(&noisy), None), change(None, Some(&noisy))] {
        assert_eq!(one.1, 1);
        for (one, both) in one.0.iter().zip(&both) {
            assert!((one / both - 1.0).abs() < 1e-4, "{one:?} {both:?}");
        }
    }
}

#[test]
fn a_tolerance_in_percent_of_nothing_is_refused() {
    let content = content_from_anyone("p", PASSPORT).unwrap();
    let mut gyro = GyroType::gvk_6();
    gyro.nominal.k_deg_per_h_per_ma[0][1] = 0.0;
    let order = Order { gyro: Some(gyro), ..default() };
    let refused = calibrate_json(&content, None, ("c", CURRENTS.as_bytes()), &order).unwrap_err();
    assert!(refused.to_string().contains("no tolerance of K_xy"), "{refused}");
}

/// Expected: the currents of docs/currents.csv ten times too small give scale factors ten times too large, which only the gyro
/// type shows.
#[test]
fn what_needs_a_gyro_type_is_said_to_be_untested_without_one() {
    let tenth = |cell: &str| cell.parse::<f64>().map_or_else(|_| cell.to_owned(), |ma| format!("{:.7}", ma / 10.0));
    let line = |line: &str| match line.split(',').collect::<Vec<_>>()[..] {
        [i, j, x, y] => format!("{i},{j},{},{}\n", tenth(x), tenth(y)),
        _ => String::new(),
    };
    let csv: String = CURRENTS.lines().map(line).collect();
    let found = |order: &Order| json(&calibrated(&csv, order));
    let without = found(&default());
    assert!(without["consistent"] == true && without.get("mistake").is_none(), "{without}");
    assert!(without["not_tested"][0].as_str().unwrap().contains("unit"), "{without}");
    let with = found(&Order { gyro: Some(GyroType::gvk_6()), ..default() });
    assert!(with.get("not_tested").is_none(), "{with}");
    assert_eq!((&with["mistake"]["kind"], &with["mistake"]["size"]), (&"range".into(), &0.1.into()), "{with}");
    assert_eq!(with["verdict"]["overall"], "undecided");
}

/// Expected: a drift of 10 °/(h·g) at the local g of Moscow, 9.81572 m/s², is 9.99076 at 9.80665 m/s² (by hand), 0.00924 less;
/// nothing else depends on g.
#[test]
fn a_verdict_states_what_converting_g_contributed() {
    let conversions = |gravity_m_per_s2: Option<f64>| -> Vec<Option<f64>> {
        let gyro = Some(GyroType { gravity_m_per_s2, ..GyroType::gvk_6() });
        let found = json(&calibrated(CURRENTS, &Order { gyro, ..default() }));
        let rows = found["verdict"]["parameters"].as_array().unwrap();
        rows.iter().map(|row| row.get("conversion_of_g").and_then(Value::as_f64)).collect()
    };
    let [none @ .., omega_g, omega_k] = &conversions(None)[..] else { panic!() };
    assert!(none.iter().all(Option::is_none));
    assert!((omega_g.unwrap() + 0.00924).abs() < 2e-5 && (omega_k.unwrap() + 0.00924).abs() < 2e-5, "{omega_g:?}");
    let content = content_from_anyone("p", PASSPORT).unwrap();
    assert_eq!(conversions(Some(content.earth.gravity_m_per_s2))[6..], [Some(0.0), Some(0.0)]);
}

#[test]
fn the_adopted_method_comes_first() {
    use Method::{Analytic, Iterative, LeastSquares};

    for (methods, due) in [
        (vec![Analytic, Iterative, LeastSquares], ["least-squares", "analytic", "iterative"].as_slice()),
        (vec![Analytic, Iterative], &["iterative", "analytic"]),
        (vec![Analytic], &["analytic"]),
    ] {
        let options = Options { methods, ..Options::default() };
        let found = json(&calibrated(CURRENTS, &Order { options, ..default() }));
        let methods: Vec<_> = found["results"].as_array().unwrap().iter().map(|result| &result["method"]).collect();
        assert_eq!(methods, due);
        assert_eq!(found["adopted"], due[0]);
    }
}
