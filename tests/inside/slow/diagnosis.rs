//! What residuals tell and what they do not; whether uncertainties are honest.

use super::{errors_of, least_squares_only, shares};
use crate::inside::reference::*;
use dtg_passport::attitude::Deviation;
use dtg_passport::calibration::finding::by_type;
use dtg_passport::calibration::parameter::Parameter;
use dtg_passport::calibration::unknowns::Model;
use dtg_passport::calibration::{
    Calibration, CalibrationDocument, Finding, InputUncertainty, Kind, Options, Scope, Setup, calibrate,
};
use dtg_passport::coefficients::{EarthRate, Position};
use dtg_passport::earth::{STANDARD_GRAVITY_M_PER_S2, normal_gravity_m_per_s2};
use dtg_passport::gyro::{GyroParameters, GyroType, Parameters};
use dtg_passport::statistics::random::Stream;
use nalgebra::{Rotation2, Vector2, Vector3};

/// Trials of each kind. The figures of docs/development/reproduction.md:
/// `DTG_TRIALS=10000 cargo test --release --lib inside::slow::diagnosis -- --nocapture`.
fn trials() -> u64 {
    super::trials(1_000)
}

fn solve(setup: &Setup, currents_ma: &[Vector2<f64>]) -> Calibration {
    calibrate(setup, &readings(setup, currents_ma), &least_squares_only()).expect("eight good positions")
}

/// Readings on a stand for a gyro whose type states its noise as 0: a scatter of the residuals is not that of the gyro.
fn solve_quiet(setup: &Setup, currents_ma: &[Vector2<f64>]) -> Calibration {
    let quiet = InputUncertainty { visit_deg_per_h: Some(0.0), ..setup.uncertainty().clone() };
    solve(&setup.clone().with(|u| *u = quiet), currents_ma)
}

/// A stand with deviations of 10′.
fn good_stand(stream: &mut Stream) -> Vec<Position> {
    drawn_stand(stream, 10.0 / 60.0)
}

/// A stand whose frame axis has this azimuth.
fn on_base(stand: &[Position], frame_axis_azimuth_deg: f64) -> Setup {
    let rate = EarthRate { frame_axis_azimuth_deg, ..EarthRate::at_astronomic_latitude(LATITUDE_DEG) };
    Setup::new(stand, rate, InputUncertainty::of_meter(paper_meter())).unwrap()
}

fn noisy(stream: &mut Stream, currents_ma: &[Vector2<f64>]) -> Vec<Vector2<f64>> {
    currents_ma.iter().map(|current| current.map(|j| j * (1.0 + stream.within(1.5e-4)))).collect()
}

/// Answer to a mistake: the right cause is named first, it is among several, nothing is named, or only wrong causes are.
fn outcome(calibration: &Calibration, is_right: impl Fn(&Finding) -> bool) -> [bool; 4] {
    let right: Vec<bool> = calibration.causes.iter().map(is_right).collect();
    let (first, named) = (right.first() == Some(&true), right.contains(&true));
    [first, named && !first, right.is_empty(), !named && !right.is_empty()]
}

/// Percentages that are due: at least so many causes named first, and at all; at most so many wrong ones alone.
struct Due {
    first: f64,
    named: f64,
    wrong: f64,
}

fn named(what: &str, seed: u64, due: &Due, trial: impl Fn(&mut Stream) -> [bool; 4] + Sync) {
    let [first, among, nothing, wrong] = shares(trials(), seed, trial);
    let found = format!("{what}: first {first:.2} %, among several {among:.2}, nothing {nothing:.2}, wrong {wrong:.2}");
    println!("{found}");
    assert!(first >= due.first && first + among >= due.named && wrong <= due.wrong, "{found}");
}

/// Two exchanged positions, among stands of 10′.
#[test]
fn exchanged_positions_are_named() {
    named("exchanged", 1, &Due { first: 90.0, named: 0.0, wrong: 1.0 }, |stream| {
        let setup = setup(&good_stand(stream), LATITUDE_DEG);
        let mut currents = noisy(stream, &currents(&setup, &gvk_6()));
        let one = stream.below(8);
        let other = (one + 1 + stream.below(7)) % 8;
        currents.swap(one, other);
        let index = |place: usize| setup.coefficients().positions[place].index;
        let between = Some([one.min(other), one.max(other)].map(index).map(|index| [index.i, index.j]));
        outcome(&solve(&setup, &currents), |found| found.scope.between == between)
    });
}

/// Gyros with 0.05 °/(h·g) along the spin axis, which the paper's model does not have, on stands of 10′.
#[test]
fn drift_along_the_spin_axis_names_the_general_model() {
    named("spin axis", 9, &Due { first: 0.0, named: 95.0, wrong: 100.0 }, |stream| {
        let setup = setup(&good_stand(stream), LATITUDE_DEG);
        let gyro = gvk_6();
        let further = gyro.k_deg_per_h_per_ma.try_inverse().unwrap() * Vector2::new(0.05, -0.05);
        let mut currents = currents(&setup, &gyro);
        for (current, at) in currents.iter_mut().zip(&setup.coefficients().positions) {
            *current -= further * at.specific_force_z_g;
        }
        let currents = noisy(stream, &currents);
        let options = Options { model: Model::General, ..least_squares_only() };
        let general = calibrate(&setup, &readings(&setup, &currents), &options).unwrap();
        // Four degrees of freedom are left, and the F test alone finds it only in some.
        assert!(general.adopted().unwrap().document.model_test.unwrap().is_significant());
        outcome(&solve_quiet(&setup, &currents), |found| found.kind == Kind::GeneralModel)
    });
}

/// Stands with deviations of 10′, on which one reading has a reversed sign or exchanged currents. It differs by more than 20 µA
/// from the right one: the sign of a current near zero cannot be seen, nor an exchange of two that are nearly equal.
#[test]
fn a_slip_in_one_reading_is_named() {
    named("slips", 9, &Due { first: 99.0, named: 0.0, wrong: 0.0 }, |stream| {
        let setup = setup(&good_stand(stream), LATITUDE_DEG);
        let mut currents = noisy(stream, &currents(&setup, &gvk_6()));
        let each = setup.coefficients().positions.iter().zip(&currents).enumerate();
        let slips = each.flat_map(|(place, (at, current))| {
            let (on, [x, y]) = (Scope::of(at.index), (*current).into());
            let slips = [
                (Vector2::new(-x, y), (Kind::ColumnReversed, on.clone().channel(0))),
                (Vector2::new(x, -y), (Kind::ColumnReversed, on.clone().channel(1))),
                (Vector2::new(y, x), (Kind::ColumnsExchanged, on)),
            ];
            slips.map(|(read, due)| (place, read, due))
        });
        let slips: Vec<_> = slips.filter(|(place, read, _)| (read - currents[*place]).norm() > 0.02).collect();
        let (place, read, due) = slips[stream.below(slips.len())].clone();
        currents[place] = read;
        outcome(&solve(&setup, &currents), |found| (found.kind, found.scope.clone()) == due)
    });
}

/// One position turned by 10′ about a random axis.
#[test]
fn a_position_that_did_not_repeat_is_named() {
    let angle = dtg_passport::units::radians_from_arcseconds(600.0);
    named("did not repeat", 2, &Due { first: 0.0, named: 85.0, wrong: 2.0 }, |stream| {
        let stand = good_stand(stream);
        let place = stream.below(8);
        let turn = Vector3::from([(); 3].map(|()| stream.normal())).normalize() * angle;
        let mut moved = stand.clone();
        let Deviation { alpha_rad, beta_rad, gamma_rad } = &mut moved[place].deviation;
        [alpha_rad, beta_rad, gamma_rad].into_iter().zip(&turn).for_each(|(angle, turn)| *angle += turn);
        let currents = noisy(stream, &currents(&setup(&moved, LATITUDE_DEG), &gvk_6()));
        outcome(&solve_quiet(&setup(&stand, LATITUDE_DEG), &currents), |found| {
            found.kind == Kind::Position && found.scope == Scope::of(stand[place].index) && found.size.unwrap() < 700.0
        })
    });
}

/// Positions numbered in another way, on stands of 1°, and a base turned by quarters or a few degrees, on stands of 5°.
#[test]
fn another_numbering_and_another_axis_are_named() {
    named("another numbering", 4, &Due { first: 90.0, named: 0.0, wrong: 1.0 }, |stream| {
        let setup = setup(&drawn_stand(stream, 1.0), LATITUDE_DEG);
        // Readings of (i, j) taken at (3 - i, j), with φ in the other direction, from another position, or both.
        let (exchanged, reversed, from) = (stream.below(2), stream.below(2), stream.below(4));
        if exchanged + reversed + from == 0 {
            return [true, false, false, false];
        }
        let taken_at = |place: usize| {
            let (i, j) = ((place / 4 + exchanged) % 2, place % 4);
            4 * i + (from + if reversed == 1 { 4 - j } else { j }) % 4
        };
        let exact = currents(&setup, &gvk_6());
        let currents = noisy(stream, &(0..8).map(|place| exact[taken_at(place)]).collect::<Vec<_>>());
        let j = [0, 1, 2, 3].map(|place| taken_at(place) as u32 % 4 + 1);
        let due = numbers(if exchanged == 1 { [2, 1] } else { [1, 2] }, j);
        outcome(&solve(&setup, &currents), |found| found.scope.numbers.as_deref() == Some(due.as_str()))
    });
    named("another axis", 5, &Due { first: 0.0, named: 90.0, wrong: 1.0 }, |stream| {
        let stand = drawn_stand(stream, 5.0);
        let azimuth = [0.0, 180.0, 86.0, 93.0][stream.below(4)];
        let currents = noisy(stream, &currents(&on_base(&stand, azimuth), &gvk_6()));
        outcome(&solve(&setup(&stand, LATITUDE_DEG), &currents), |found| {
            // A small angle is named if it is at least three times its uncertainty.
            let off_deg = if azimuth % 90.0 == 0.0 { 0.0 } else { 1.5 };
            found.kind == Kind::FrameAxis && (found.size.unwrap() - azimuth).abs() <= off_deg
        })
    });
}

/// The currents of one stand with the passport of another.
#[test]
fn the_passport_of_another_stand_is_noticed() {
    named("another stand", 3, &Due { first: 95.0, named: 0.0, wrong: 100.0 }, |stream| {
        let [setup, other] = [(); 2].map(|()| setup(&good_stand(stream), LATITUDE_DEG));
        let currents = noisy(stream, &currents(&other, &gvk_6()));
        outcome(&solve_quiet(&setup, &currents), |found| matches!(found.kind, Kind::Stand | Kind::Meter))
    });
}

/// Good calibrations with normal errors: few false alarms, chi-square as it should be, intervals that cover.
#[test]
fn good_calibrations_are_left_alone_and_intervals_cover() {
    let meter = paper_meter();
    let [alarms, below, covered @ ..] = shares::<10>(10_000, 4, |stream| {
        let mut uncertainty = InputUncertainty::of_meter(meter);
        (uncertainty.meter.gain, uncertainty.meter.offset_ma) = (1e-4, 5e-5);
        let setup = with_uncertainty(&drawn_stand(stream, 5.0), LATITUDE_DEG, uncertainty);
        let exact = currents(&setup, &gvk_6());
        let (gain, offset) = (1.0 + 1e-4 * stream.normal(), 5e-5 * stream.normal());
        let own = errors_of(meter, &exact, stream);
        let currents: Vec<_> = exact.iter().zip(own).map(|(at, own)| at.map(|j| j * gain + offset) + own).collect();
        let found = solve(&setup, &currents);
        let result = &found.results[0];
        std::array::from_fn(|kind| match kind {
            0 => !found.consistent,
            1 => result.chi_square.probability < 0.05,
            _ => {
                let parameter = Parameter::EIGHT[kind - 2];
                let error = result.value(parameter).unwrap() - gvk_6().to_vector()[kind - 2];
                error.abs() <= 1.959_964 * result.standard_uncertainty(parameter).unwrap()
            }
        })
    });
    println!(
        "false alarms {alarms:.2} %, chi-square improbable at 5 % {below:.2} %, 95 % intervals cover {covered:.2?} %"
    );
    assert!(alarms <= 1.0, "{alarms}");
    assert!((below - 5.0).abs() <= 0.7, "{below}");
    assert!(covered.iter().all(|share| (share - 95.0).abs() <= 0.7), "{covered:?}");
}

/// Expected: docs/model.md, "Errors that the residuals do not show": these leave chi-square where it was.
#[test]
fn what_residuals_cannot_tell() {
    let stand = drawn_stand(&mut Stream::new(6), 3.0);
    let honest = setup(&stand, LATITUDE_DEG);
    let good = currents(&honest, &gvk_6());
    let wrong_place = setup(&stand, 50.0);
    let mut turned = stand.clone();
    turned.iter_mut().for_each(|position| position.deviation.gamma_rad += 1e-3);
    let turned = currents(&setup(&turned, LATITUDE_DEG), &gvk_6());
    let read = |map: fn(&Vector2<f64>) -> Vector2<f64>| good.iter().map(map).collect();
    let cases = [
        ("another latitude", &wrong_place, good.clone()),
        ("seat", &honest, turned),
        ("offset", &honest, read(|j| j.add_scalar(1e-3))),
        ("gain", &honest, read(|j| j * 1.01)),
        ("x and y", &honest, read(|j| j.yx())),
        ("sign", &honest, read(|j| Vector2::new(-j.x, j.y))),
    ];
    for (what, setup, currents) in cases {
        let found = solve(setup, &currents);
        assert!(found.results[0].chi_square.value < 1e-6, "{what}: {:?}", found.results[0].chi_square);
        assert!(found.consistent);
    }
    // Exactly as model.md says: K′ = sK, ω_0′ = sω_0, ω_n′ = sω_n + (ω_B′ − sω_B)·1, s = ω_Γ′/ω_Γ.
    let [here, there] = [LATITUDE_DEG, 50.0].map(EarthRate::at_astronomic_latitude);
    let s = there.horizontal_deg_per_h / here.horizontal_deg_per_h;
    let found = solve(&wrong_place, &good).results[0].parameters;
    assert!((found.k_deg_per_h_per_ma - gvk_6().k_deg_per_h_per_ma * s).amax() < 1e-9);
    let omega_g = s * 10.0 + there.vertical_deg_per_h - s * here.vertical_deg_per_h;
    assert!((found.omega_g_deg_per_h_per_g - omega_g).abs() < 1e-9);
}

/// Uniform errors have no tails: fewer improbable fits. Expected: docs/development/reproduction.md, 2.0 % below the 5 % point.
#[test]
fn uniform_errors_alarm_less() {
    let [percent] = shares(super::trials(4_000).max(4_000), 9, |stream| {
        let setup = setup(&drawn_stand(stream, 5.0), LATITUDE_DEG);
        let currents = noisy(stream, &currents(&setup, &gvk_6()));
        [solve(&setup, &currents).results[0].chi_square.probability < 0.05]
    });
    println!("uniform errors: chi-square improbable at 5 % in {percent:.2} %");
    assert!((percent - 2.0).abs() < 0.7, "{percent}");
}

/// One reading wrong by so many microamperes, small and gross: the position and the size are named.
#[test]
fn a_wrong_reading_is_named_with_its_size() {
    let stand = drawn_stand(&mut Stream::new(11), 0.2);
    let setup = setup(&stand, LATITUDE_DEG);
    let good = currents(&setup, &gvk_6());
    for place in 0..8 {
        for (x_ua, y_ua) in [(1.0, 0.0), (0.0, -3.0), (-20.0, 30.0), (150.0, -90.0)] {
            let mut currents = good.clone();
            currents[place] += Vector2::new(x_ua, y_ua) * 1e-3;
            let index = setup.coefficients().positions[place].index;
            let found = solve_quiet(&setup, &currents);
            let found =
                found.causes.iter().find(|cause| cause.kind == Kind::Position && cause.scope == Scope::of(index));
            let found = found.unwrap_or_else(|| panic!("{index} {x_ua} {y_ua}"));
            let error = Vector2::from(found.pair) - Vector2::new(x_ua, y_ua);
            assert!(error.amax() < 0.01, "{index}: {found:?} for {x_ua}, {y_ua}");
            assert!(found.words.contains(&format!("Position {index} did not repeat")), "{found:?}");
        }
    }
}

/// Returns the mistakes that explain currents calibrated with the passport of this stand for this latitude: with the paper's
/// type, and without a type.
fn explained(stand: &[Position], latitude_deg: f64, currents_ma: &[Vector2<f64>]) -> [Vec<Finding>; 2] {
    explained_for([Some(&GyroType::gvk_6()), None], stand, latitude_deg, currents_ma)
}

/// Returns the mistake that explains currents for each of two types; `None` is no type.
fn explained_for(
    types: [Option<&GyroType>; 2],
    stand: &[Position],
    latitude_deg: f64,
    currents_ma: &[Vector2<f64>],
) -> [Vec<Finding>; 2] {
    let setup = setup(stand, latitude_deg);
    let (readings, options) = (readings(&setup, currents_ma), least_squares_only());
    let calibration = calibrate(&setup, &readings, &options).expect("eight good positions");
    if !calibration.fits() {
        return [Vec::new(), Vec::new()];
    }
    // The adopted result at the normal gravity of the latitude.
    let gravity = (normal_gravity_m_per_s2(latitude_deg, 0.0), Some(7.1e-3));
    let found = CalibrationDocument::new("a/b/c/1", true, gravity, &calibration, &[]).found().unwrap();
    types.map(|gyro_type| by_type::causes((&setup, &readings, &options), &found, gyro_type, &gvk_6()))
}

/// The causes, each with its channel and its size.
fn each(found: &[Finding]) -> Vec<(Kind, Option<char>, Option<f64>)> {
    found.iter().map(|one| (one.kind, one.scope.channel, one.size)).collect()
}

/// Numbers of the readings and of the passport in words.
fn numbers(i: [u32; 2], j: [u32; 4]) -> String {
    let with_commas = |all: &[u32]| all.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    let of_i = (i != [1, 2]).then(|| format!("i = 1, 2 → {}", with_commas(&i)));
    let of_j = (j != [1, 2, 3, 4]).then(|| format!("j = 1, 2, 3, 4 → {}", with_commas(&j)));
    of_i.into_iter().chain(of_j).collect::<Vec<_>>().join("; ")
}

/// A gyro within the paper's tolerance, its drifts per the g of a latitude at 100 m.
fn good_gyro(stream: &mut Stream, latitude_deg: f64) -> GyroParameters {
    let tolerance = [0.0475, 0.0475, 0.0475, 0.0475, 0.01, 0.01, 0.01, 0.01];
    let per_g = normal_gravity_m_per_s2(latitude_deg, 100.0) / STANDARD_GRAVITY_M_PER_S2;
    let mut values = gvk_6().to_vector();
    for (place, (value, limit)) in values.iter_mut().zip(tolerance).enumerate() {
        *value = (*value + stream.within(limit)) * if place < 6 { 1.0 } else { per_g };
    }
    GyroParameters::from_vector(&values)
}

/// The noisy currents of a gyro within tolerance on a stand at a latitude.
fn good_currents(stream: &mut Stream, stand: &[Position], latitude_deg: f64) -> Vec<Vector2<f64>> {
    let gyro = good_gyro(stream, latitude_deg);
    noisy(stream, &currents(&setup(stand, latitude_deg), &gyro))
}

/// Exchanged and reversed channels, other units, and both at once: each is named, whatever the stand and the noise.
#[test]
fn mistaken_currents_are_recognised() {
    type Mistaken = fn(&Vector2<f64>) -> Vector2<f64>;
    let exchanged = (Kind::ColumnsExchanged, None, None);
    let reversed = |channel| (Kind::ColumnReversed, channel, None);
    let range = |factor| (Kind::Range, None, Some(factor));
    let cases: [(Mistaken, Vec<_>); 12] = [
        (|j| j.yx(), vec![exchanged]),
        (|j| Vector2::new(-j.x, j.y), vec![reversed(Some('x'))]),
        (|j| Vector2::new(j.x, -j.y), vec![reversed(Some('y'))]),
        (|j| -j, vec![reversed(None)]),
        (|j| Vector2::new(-j.y, j.x), vec![exchanged, reversed(Some('x'))]),
        (|j| Vector2::new(j.y, -j.x), vec![exchanged, reversed(Some('y'))]),
        (|j| -j.yx(), vec![exchanged, reversed(None)]),
        (|j| j * 1e3, vec![range(1e3)]),
        (|j| j * 1e-3, vec![range(1e-3)]),
        (|j| j * 10.0, vec![range(10.0)]),
        (|j| j * 1e6, vec![range(1e6)]),
        (|j| j.yx() * 1e3, vec![exchanged, range(1e3)]),
    ];
    let mut stream = Stream::new(21);
    for (mistake, due) in &cases {
        for _ in 0..10 {
            let stand = drawn_stand(&mut stream, 3.0);
            let good = good_currents(&mut stream, &stand, LATITUDE_DEG);
            let currents: Vec<_> = good.iter().map(mistake).collect();
            let [by_type, by_size] = explained(&stand, LATITUDE_DEG, &currents);
            assert_eq!(each(&by_type), *due);
            // Without a type only what is thousands of times off is no gyro's.
            let size = due.iter().filter(|(.., size)| size.is_some_and(|size| !(1e-2..=1e2).contains(&size)));
            assert_eq!(each(&by_size), size.copied().collect::<Vec<_>>());
        }
    }
    // As the laboratory sees it: K_x 9.5, K_xy 95; and K_x −95, K_xy −9.5.
    let stand = drawn_stand(&mut stream, 3.0);
    let honest = setup(&stand, LATITUDE_DEG);
    let good = currents(&honest, &gvk_6());
    for (mistake, due) in [(cases[0].0, [9.5, 95.0]), (cases[3].0, [-95.0, -9.5])] {
        let read: Vec<_> = good.iter().map(mistake).collect();
        let k = solve(&honest, &read).results[0].parameters.k_deg_per_h_per_ma;
        assert!((k.m11 - due[0]).abs() < 1e-9 && (k.m12 - due[1]).abs() < 1e-9, "{k}");
    }
}

/// The passport of another place, in both hemispheres, near the equator and near a pole: the latitude of the stand is found.
///
/// Expected: K as docs/model.md has it, sK with s = cos 10.6°/cos 55.7658° = 0.98294/0.56258 = 1.7472, so 166 for 95.
#[test]
fn the_passport_of_another_place_is_recognised() {
    let mut stream = Stream::new(22);
    let places =
        [(55.7658, 10.6), (55.7658, -33.78), (55.7658, 78.93), (55.7658, 48.0), (1.2956, 55.7658), (-33.78, 55.7658)];
    for (there, used) in places {
        for _ in 0..20 {
            let stand = drawn_stand(&mut stream, 3.0);
            let currents = good_currents(&mut stream, &stand, there);
            match explained(&stand, used, &currents) {
                [of_type, without]
                    if without.is_empty() && of_type.len() == 1 && of_type[0].kind == Kind::OtherSite =>
                {
                    let latitude_deg = of_type[0].size.unwrap();
                    assert!((latitude_deg - there).abs() < 0.3, "{latitude_deg} for {there}");
                }
                other => panic!("{other:?} for the passport of {used} at {there}"),
            }
        }
    }
    let stand = drawn_stand(&mut stream, 3.0);
    let exact = currents(&setup(&stand, 55.7658), &gvk_6());
    let k = solve(&setup(&stand, 10.6), &exact).results[0].parameters.k_deg_per_h_per_ma;
    assert!((k.m11 - 95.0 * 1.7472).abs() < 0.01, "{k}");
}

/// The currents of a gyro that is turned in its seat: those of the drift model, eq. (5), with n and ω_3 in the turned axes.
fn turned_in_seat(stream: &mut Stream, stand: &[Position], gyro: &GyroParameters, by_deg: f64) -> Vec<Vector2<f64>> {
    let turn = Rotation2::new(-by_deg.to_radians());
    let setup = setup(stand, LATITUDE_DEG);
    let exact = setup.coefficients().positions.iter().map(|at| {
        let (n, omega) = (turn * at.specific_force_g, turn * at.earth_rate_deg_per_h);
        let (w_g, w_k) = (gyro.omega_g_deg_per_h_per_g, gyro.omega_k_deg_per_h_per_g);
        let drift = gyro.omega0_deg_per_h + Vector2::new(w_g * n.x - w_k * n.y, w_k * n.x + w_g * n.y);
        gyro.k_deg_per_h_per_ma.try_inverse().unwrap() * (omega - drift)
    });
    noisy(stream, &exact.collect::<Vec<_>>())
}

/// A gyro turned in its seat by quarter turns, on stands of 3°, and a frame's axis to another quarter than the passport's: the
/// opposite one on stands of 3°, the others on stands of 7″, because on worse ones the readings do not fit. Both by a few
/// degrees, too.
#[test]
fn a_turned_gyro_and_a_turned_base_are_recognised() {
    let mut stream = Stream::new(25);
    for _ in 0..trials().min(1_000) / 20 {
        let stand = drawn_stand(&mut stream, 3.0);
        let gyro = good_gyro(&mut stream, LATITUDE_DEG);
        for by_deg in [90.0, 180.0, 270.0] {
            let currents = turned_in_seat(&mut stream, &stand, &gyro, by_deg);
            let found = explained(&stand, LATITUDE_DEG, &currents).map(|found| each(&found));
            assert_eq!(found, [vec![(Kind::GyroTurned, None, Some(by_deg))], Vec::new()]);
        }
        for by_deg in [-5.0_f64, 0.5, 8.0] {
            let rotated = |stand: &[Position], currents_ma: &[Vector2<f64>]| {
                let [found, _] = explained(stand, LATITUDE_DEG, currents_ma);
                let [(Kind::Rotated, None, Some(found))] = each(&found)[..] else { panic!("{found:?}") };
                assert!((found - by_deg.abs()).abs() < 0.1, "{found} instead of {by_deg}");
            };
            rotated(&stand, &turned_in_seat(&mut stream, &stand, &gyro, by_deg));
            let stand = drawn_stand(&mut stream, 0.002);
            let exact = currents(&on_base(&stand, 90.0 + by_deg), &gyro);
            rotated(&stand, &noisy(&mut stream, &exact));
        }
        for (azimuth_deg, limit_deg) in [(0.0, 0.002), (180.0, 0.002), (270.0, 3.0)] {
            let stand = drawn_stand(&mut stream, limit_deg);
            let currents = noisy(&mut stream, &currents(&on_base(&stand, azimuth_deg), &gyro));
            let found = explained(&stand, LATITUDE_DEG, &currents).map(|found| each(&found));
            assert_eq!(found, [vec![(Kind::FrameAxis, None, Some(azimuth_deg))], Vec::new()]);
        }
    }
}

/// On stands of 7″, whose readings fit in any numbering: φ in the other direction, θ exchanged, φ from another position and
/// several of these are named. A gyro turned by quarters has the currents of φ from another position, and its words say so. A
/// gyro out of tolerance gets no word.
#[test]
fn another_numbering_is_recognised_by_the_parameters() {
    let mut stream = Stream::new(31);
    for _ in 0..trials().min(1_000) / 50 {
        let stand = drawn_stand(&mut stream, 0.002);
        let good = good_currents(&mut stream, &stand, LATITUDE_DEG);
        let numberings = [[1_u32, 2], [2, 1]].into_iter().flat_map(|i| (0..8_u32).map(move |step| (i, step)));
        for (i, step) in numberings.skip(1) {
            let j = [0, 1, 2, 3].map(|j| 1 + (step + if step < 4 { j } else { 4 - j }) % 4);
            let mut read = good.clone();
            for (row, place) in i.into_iter().flat_map(|i| j.map(|j| 4 * (i - 1) + j - 1)).enumerate() {
                read[row] = good[place as usize];
            }
            let due = match (i, step) {
                ([1, 2], 1..4) => (Kind::GyroTurned, None),
                _ => (Kind::Renumbered, Some(numbers(i, j))),
            };
            let [found, _] = explained(&stand, LATITUDE_DEG, &read);
            let found: Vec<_> = found.into_iter().map(|one| (one.kind, one.scope.numbers)).collect();
            assert_eq!(found, [due]);
        }
        let mut bad = good_gyro(&mut stream, LATITUDE_DEG).to_vector();
        bad[stream.below(8)] *= 1.0 + 0.5 * stream.within(1.0);
        let read = noisy(&mut stream, &currents(&setup(&stand, LATITUDE_DEG), &GyroParameters::from_vector(&bad)));
        assert_eq!(explained(&stand, LATITUDE_DEG, &read), [Vec::new(), Vec::new()]);
    }
}

/// Expected: the factor with which the currents were multiplied, as of a voltage across a shunt of 499 Ω; 3600 for a type in °/s,
/// and not a unit of the currents.
#[test]
fn another_factor_is_recognised() {
    let mut stream = Stream::new(32);
    let stand = drawn_stand(&mut stream, 3.0);
    let good = good_currents(&mut stream, &stand, LATITUDE_DEG);
    let recognised = |kind, channel, due: f64, gyro_type: &GyroType, currents_ma: &[Vector2<f64>]| {
        let [found, _] = explained_for([Some(gyro_type), None], &stand, LATITUDE_DEG, currents_ma);
        let [(of, on, Some(factor))] = each(&found)[..] else { panic!("{due}: {found:?}") };
        assert_eq!((of, on), (kind, channel), "{due}");
        assert!((factor / due - 1.0).abs() < 1e-3, "{factor} for {due}");
    };
    for due in [499.0, 4.99, 0.2] {
        let scaled: Vec<_> = good.iter().map(|current| current * due).collect();
        recognised(Kind::Range, None, due, &GyroType::gvk_6(), &scaled);
    }
    // One channel in another range: both numbers of a column of K share the factor.
    for (axis, due) in [(0, 10.0), (1, 0.5), (0, 2.0), (1, 1000.0), (0, 0.001)] {
        let mut scaled = good.clone();
        scaled.iter_mut().for_each(|current| current[axis] *= due);
        recognised(Kind::Range, Some(['x', 'y'][axis]), due, &GyroType::gvk_6(), &scaled);
    }
    for due in [3600.0, 60.0, 1.0 / 3600.0] {
        let mut per_second = GyroType::gvk_6();
        let values = gvk_6().to_vector().map(|value| value / due);
        per_second.nominal = Parameters::of(&GyroParameters::from_vector(&values));
        let tolerance = &mut per_second.tolerance;
        tolerance.omega0_deg_per_h /= due;
        tolerance.omega_g_deg_per_h_per_g /= due;
        tolerance.omega_k_deg_per_h_per_g /= due;
        recognised(Kind::TypeUnit, None, due, &per_second, &good);
    }
}

/// Nothing is explained away: good gyros, gyros out of tolerance in one parameter or in all, a meter with a wrong gain, and
/// readings that do not fit at all get no word of a mistake.
#[test]
fn what_is_no_mistake_is_not_called_one() {
    let [called] = shares(trials(), 23, |stream| {
        let stand = drawn_stand(stream, 3.0);
        let good = good_gyro(stream, LATITUDE_DEG);
        let mut one = good.to_vector();
        let place = stream.below(8);
        // Up to half of its size, small ones as probable as large ones.
        one[place] *= 1.0 + 0.5 * stream.within(1.0).powi(5);
        let mut all = good.to_vector();
        all.iter_mut().for_each(|value| *value *= 1.0 + 0.03 * stream.within(1.0).powi(3));
        let mut scaled = good;
        scaled.k_deg_per_h_per_ma *= 1.0 + 0.3 * stream.within(1.0).powi(3);
        let gyros = [good, GyroParameters::from_vector(&one), GyroParameters::from_vector(&all), scaled];
        let found = gyros.map(|gyro| {
            let currents = noisy(stream, &currents(&setup(&stand, LATITUDE_DEG), &gyro));
            explained(&stand, LATITUDE_DEG, &currents)
        });
        [found.iter().flatten().any(|found| !found.is_empty())]
    });
    println!("called a mistake: {called} % of {} times four gyros", trials());
    assert_eq!(called, 0.0);
    let mut stream = Stream::new(24);
    let (stand, other) = (drawn_stand(&mut stream, 1.0), drawn_stand(&mut stream, 1.0));
    let crossed: Vec<_> = currents(&setup(&other, LATITUDE_DEG), &gvk_6()).iter().map(|j| j.yx()).collect();
    assert_eq!(explained(&stand, LATITUDE_DEG, &crossed), [Vec::new(), Vec::new()]);
}

/// Common errors are in the covariance of the residuals: with a huge one stated and present, the fit is still good.
#[test]
fn chi_square_takes_every_stated_input() {
    let stand = drawn_stand(&mut Stream::new(8), 5.0);
    let mut turned = stand.clone();
    // The base turned about its own axes is a turn of every Ã from the right: a platform turn of each position.
    turned.iter_mut().for_each(|position| position.deviation.alpha_rad += 2e-3);
    let currents = currents(&setup(&turned, LATITUDE_DEG), &gvk_6());
    let silent = solve(&setup(&stand, LATITUDE_DEG), &currents);
    assert!(silent.results[0].chi_square.probability < 1e-3, "{:?}", silent.results[0].chi_square);
    let mut uncertainty = InputUncertainty::of_meter(paper_meter());
    uncertainty.seating_rad = [2e-3; 3];
    let stated = solve(&with_uncertainty(&stand, LATITUDE_DEG, uncertainty), &currents);
    assert!(stated.results[0].chi_square.probability > 0.05, "{:?}", stated.results[0].chi_square);
    assert!(stated.consistent);
}
