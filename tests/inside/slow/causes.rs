//! The causes of a calibration: how often good gyros are accused, how large a fault must be to be named, whether the right one
//! is, and whether intervals cover when K or ω_0 varies. The figures of docs/laboratory.md and docs/development/figures.md:
//! `DTG_TRIALS=4000 cargo test --release --lib inside::slow::causes -- --nocapture`.

use super::{errors_of, least_squares_only, shares};
use crate::inside::reference::*;
use dtg_passport::calibration::readings::Reading;
use dtg_passport::calibration::{Calibration, InputUncertainty, Kind, Method, Options, Readings, Setup, calibrate};
use dtg_passport::coefficients::Position;
use dtg_passport::statistics::random::Stream;
use dtg_passport::uncertainty::Budget;
use dtg_passport::units::radians_from_arcseconds;
use nalgebra::{Matrix2, Vector2};

/// Noise of the drift from visit to visit, and of ω_0 from turn-on to turn-on, °/h.
const VISIT: f64 = 0.002;
const TURN_ON: f64 = 0.01;

/// Time from visit to visit, and from turn-on to turn-on, s.
const PERIOD_S: f64 = 120.0;
const TURN_ON_S: f64 = 4560.0;

fn trials() -> u64 {
    super::trials(200)
}

/// What is wrong with a run, with its size.
#[derive(Clone, Copy, Default)]
struct Fault {
    visit_deg_per_h: f64,
    k_percent: f64,
    drift_deg_per_h2: f64,
    settling_deg_per_h: f64,
    backlash_arcsec: f64,
    position_arcsec: f64,
    noise_deg_per_h: f64,
    turn_on_deg_per_h: f64,
    stand_arcsec: f64,
    row_ma: f64,
    /// Currents of the second turn-on.
    of_turn_on: Option<fn(Vector2<f64>) -> Vector2<f64>>,
    exchanged: bool,
}

/// A run: turn-ons, visits to each position in a turn-on, and rows of a visit; whether the noise is stated.
#[derive(Clone, Copy)]
struct Design {
    turn_ons: u32,
    visits: usize,
    rows: usize,
    stated: bool,
}

const fn design(turn_ons: u32, visits: usize, rows: usize, stated: bool) -> Design {
    Design { turn_ons, visits, rows, stated }
}

fn bench(design: Design) -> (Vec<Position>, Setup) {
    let mut u = InputUncertainty::of_meter(paper_meter());
    u.meter.reading = 8.7e-5;
    if design.stated {
        (u.visit_deg_per_h, u.turn_on_deg_per_h) = (Some(VISIT), Some(TURN_ON));
    }
    let stand = drawn_stand(&mut Stream::new(8), 3.0);
    let setup = with_uncertainty(&stand, LATITUDE_DEG, u);
    (stand, setup)
}

/// Returns the readings of a run.
fn run(stream: &mut Stream, (stand, setup): &(Vec<Position>, Setup), of: Design, fault: &Fault) -> Readings {
    let gyro = gvk_6();
    let moved = stream.below(8);
    let axes: Vec<[f64; 3]> = (0..8).map(|_| [0, 1, 2].map(|_| fault.stand_arcsec * stream.normal())).collect();
    // The stand when a position is approached from one side, from neither, and from the other.
    let setups = [-1.0, 0.0, 1.0].map(|side: f64| {
        let mut real = stand.clone();
        for (place, (at, [x, y, z])) in real.iter_mut().zip(&axes).enumerate() {
            let off = if place == moved { fault.position_arcsec } else { 0.0 };
            at.deviation.alpha_rad += radians_from_arcseconds(*x);
            at.deviation.beta_rad += radians_from_arcseconds(*y);
            at.deviation.gamma_rad += radians_from_arcseconds(z + off + side * fault.backlash_arcsec / 2.0);
        }
        crate::inside::reference::setup(&real, LATITUDE_DEG)
    });
    let own = errors_of(setup.uncertainty().meter, &currents(setup, &gyro), stream);
    let off = (
        stream.below(of.turn_ons as usize) as u32 + 1,
        stream.below(of.visits),
        stream.below(8),
        stream.below(of.rows),
    );
    let mut taken_at: [usize; 8] = std::array::from_fn(|place| place);
    if fault.exchanged {
        taken_at.swap(moved, (moved + 1) % 8);
    }
    let mut rows = Vec::new();
    let mean_s = f64::from(of.turn_ons - 1) * TURN_ON_S / 2.0;
    for cycle in 1..=of.turn_ons {
        let mut of_cycle = gyro;
        let change = Matrix2::from_diagonal(&Vector2::from_fn(|_, _| 0.01 * fault.k_percent * stream.normal()));
        of_cycle.k_deg_per_h_per_ma += change * gyro.k_deg_per_h_per_ma;
        let bias = Vector2::from_fn(|_, _| libm::hypot(TURN_ON, fault.turn_on_deg_per_h) * stream.normal());
        let inverse = of_cycle.k_deg_per_h_per_ma.try_inverse().unwrap();
        let exact = setups.each_ref().map(|setup| currents(setup, &of_cycle));
        let mut before: Option<usize> = None;
        for visit in 0..of.visits {
            let mut order: Vec<usize> = (0..8).collect();
            // The first visits in one order, the others in random ones, so that positions are approached from both sides.
            if visit > 0 {
                (1..8).rev().for_each(|place| order.swap(place, stream.below(place + 1)));
            }
            for (number, &place) in order.iter().enumerate() {
                let since_s = PERIOD_S * (8 * visit + number) as f64;
                let time_s = f64::from(cycle - 1) * TURN_ON_S + since_s;
                let noise = if fault.noise_deg_per_h > 0.0 { fault.noise_deg_per_h } else { VISIT };
                let noise = Vector2::from_fn(|_, _| noise * stream.normal());
                let is_off = (off.0, off.1, off.2) == (cycle, visit, place);
                let mut rate =
                    bias + noise + Vector2::new(1.0, -0.5) * fault.drift_deg_per_h2 * (time_s - mean_s) / 3600.0;
                rate += Vector2::new(1.0, -1.0) * fault.settling_deg_per_h * libm::exp(-since_s / 200.0);
                if is_off {
                    rate += Vector2::new(0.8, 0.6) * fault.visit_deg_per_h;
                }
                let turned_deg = before.map_or(0.0, |before| stand[place].phi_deg - stand[before].phi_deg);
                let side = 1 + usize::from(turned_deg > 0.0) - usize::from(turned_deg < 0.0);
                before = Some(place);
                let mut current = exact[side][taken_at[place]] + own[place] - inverse * rate;
                if let Some(map) = fault.of_turn_on.filter(|_| cycle == 2) {
                    current = map(current);
                }
                for row in 0..of.rows {
                    let mut read = current;
                    if of.rows > 1 {
                        read += Vector2::from_fn(|_, _| 1e-6 * stream.normal());
                    }
                    if is_off && row == off.3 {
                        read.x += fault.row_ma;
                    }
                    let at = Reading::new(setup.coefficients().positions[place].index, read);
                    rows.push(Reading { cycle, visit: Some(visit as u32 + 1), time_s: Some(time_s), ..at });
                }
            }
        }
    }
    Readings::of_rows(setup.coefficients(), &rows).unwrap()
}

fn solved(setup: &Setup, readings: &Readings) -> Calibration {
    calibrate(setup, readings, &least_squares_only()).unwrap()
}

/// Share of runs for which `is` holds, in percent.
fn share(seed: u64, count: u64, of: Design, fault: Fault, is: impl Fn(&Calibration) -> bool + Sync) -> f64 {
    let bench = bench(of);
    let [share] = shares(count, seed, |stream| [is(&solved(&bench.1, &run(stream, &bench, of, &fault)))]);
    share
}

/// Designs of good runs: one visit, two visits, turn-ons, rows; with and without a stated noise.
const DESIGNS: [Design; 6] = [
    design(1, 1, 1, true),
    design(1, 2, 1, true),
    design(1, 3, 1, false),
    design(3, 1, 1, true),
    design(3, 1, 1, false),
    design(3, 1, 4, true),
];

/// Expected: all tests together are at 1 %.
#[test]
fn good_gyros_are_hardly_ever_accused() {
    for (number, of) in DESIGNS.into_iter().enumerate() {
        let count = trials().max(1000);
        let wrong = share(900 + number as u64, count, of, Fault::default(), |found| {
            !found.consistent || !found.causes.is_empty()
        });
        println!(
            "good: {} turn-ons, {} visits, {} rows, stated {}: {wrong:.2} %",
            of.turn_ons, of.visits, of.rows, of.stated
        );
        let error = 3.0 * (0.01_f64 / count as f64).sqrt() * 100.0;
        assert!(wrong <= 1.0 + error, "{number}: {wrong}");
    }
}

/// A fault with a size: name, design, kind, the size in the table of docs/laboratory.md, and what has this size.
type Sized = (&'static str, Design, Kind, f64, fn(&mut Fault) -> &mut f64);

const FAULTS: [Sized; 10] = [
    ("visit", design(3, 1, 1, true), Kind::Visit, 0.013, |fault| &mut fault.visit_deg_per_h),
    ("row", design(1, 1, 4, true), Kind::Row, 6e-6, |fault| &mut fault.row_ma),
    ("k_differs", design(3, 1, 1, true), Kind::KDiffers, 0.028, |fault| &mut fault.k_percent),
    ("drift", design(1, 2, 1, true), Kind::Drift, 0.012, |fault| &mut fault.drift_deg_per_h2),
    ("settling", design(1, 3, 1, true), Kind::Settling, 0.0066, |fault| &mut fault.settling_deg_per_h),
    ("backlash", design(1, 4, 1, true), Kind::Backlash, 91.0, |fault| &mut fault.backlash_arcsec),
    ("position", design(1, 1, 1, true), Kind::Position, 315.0, |fault| &mut fault.position_arcsec),
    ("gyro_noise", design(1, 1, 1, false), Kind::GyroNoise, 0.0022, |fault| &mut fault.noise_deg_per_h),
    ("turn_on_scatter", design(5, 1, 1, true), Kind::TurnOnScatter, 0.017, |fault| &mut fault.turn_on_deg_per_h),
    ("stand", design(1, 1, 1, true), Kind::Stand, 141.0, |fault| &mut fault.stand_arcsec),
];

/// A fault of the size in the table is named first in half of the runs, and in nearly all at three times this size.
#[test]
fn the_right_cause_is_named_first() {
    let count = trials().min(400);
    for (number, (name, of, kind, detectable, size)) in FAULTS.into_iter().enumerate() {
        let [named, right] = [1.0, 3.0].map(|times| {
            let mut fault = Fault::default();
            *size(&mut fault) = times * detectable;
            share(700 + number as u64, count, of, fault, |found| {
                found.causes.first().is_some_and(|cause| cause.kind == kind)
            })
        });
        println!("{name}: first for {detectable:.1e} {named:.1} %; for three times this {right:.1} %");
        // Three standard errors of 200 runs are 10.6 %; the sizes are rounded.
        assert!((named - 50.0).abs() <= 15.0, "{name}: {named}");
        assert!(right >= 95.0, "{name}: {right}");
    }
}

/// Faults without a size.
#[test]
fn exchanged_currents_and_positions_are_named() {
    type Map = fn(Vector2<f64>) -> Vector2<f64>;
    let of_turn_on: [(&str, Kind, Map); 5] = [
        ("columns_exchanged", Kind::ColumnsExchanged, |j| j.yx()),
        ("column_reversed", Kind::ColumnReversed, |j| -j),
        ("column_reversed x", Kind::ColumnReversed, |j| Vector2::new(-j.x, j.y)),
        ("range y", Kind::Range, |j| Vector2::new(j.x, 10.0 * j.y)),
        ("range", Kind::Range, |j| j / 2.0),
    ];
    let count = trials().min(400);
    for (number, (name, kind, map)) in of_turn_on.into_iter().enumerate() {
        for stated in [false, true] {
            let fault = Fault { of_turn_on: Some(map), ..Fault::default() };
            let right = share(600 + number as u64, count, design(3, 1, 1, stated), fault, |found| {
                let first = found.mistake();
                !found.consistent && first.is_some_and(|cause| cause.kind == kind && cause.scope.cycle == Some(2))
            });
            println!("{name} of one turn-on, noise stated {stated}: right first {right:.1} %");
            assert!(right >= 97.0, "{name}: {right}");
        }
    }
    let fault = Fault { exchanged: true, ..Fault::default() };
    let right = share(650, count, design(1, 1, 1, true), fault, |found| {
        found.mistake().is_some_and(|cause| cause.kind == Kind::PositionsExchanged)
    });
    println!("positions_exchanged: right first {right:.1} %");
    assert!(right >= 95.0, "{right}");
}

/// Share of 95 % intervals that cover the true value, in percent.
fn coverage(seed: u64, of: Design, fault: Fault, drift: bool) -> [f64; 8] {
    let bench = bench(of);
    // ω_0 is that at the mean time of the readings.
    let drifted = fault.drift_deg_per_h2 * PERIOD_S * (8 * of.visits - 1) as f64 / 2.0 / 3600.0;
    let mut due = gvk_6().to_vector();
    due[4] += drifted;
    due[5] -= 0.5 * drifted;
    shares(trials().max(200), seed, |stream| {
        let mut readings = run(stream, &bench, of, &fault);
        if fault.visit_deg_per_h > 0.0 {
            // What the result advises: without the visit that is named.
            let named = solved(&bench.1, &readings).causes.into_iter().find(|cause| cause.kind == Kind::Visit);
            readings = named.and_then(|cause| cause.left_out(&readings)).unwrap_or(readings);
        }
        let options = Options { drift, ..least_squares_only() };
        let budget = Budget::new(&bench.1, &readings, Method::LeastSquares, &options).unwrap();
        std::array::from_fn(|place| {
            let line = &budget.parameters[place];
            (line.value - due[place]).abs() <= line.expanded_uncertainty()
        })
    })
}

/// Expected: 95 %, within 1.5 percentage points and three standard errors of the share. Two turn-ons have a single difference of
/// K, and their intervals cover less; docs/development/figures.md has them.
#[test]
fn intervals_cover_if_k_varies_and_if_a_drift_is_fitted() {
    let error = 1.5 + 300.0 * (0.95_f64 * 0.05 / trials().max(200) as f64).sqrt();
    let check = |name: &str, turn_ons: u32, found: [f64; 8], least: f64| {
        println!("{name}, {turn_ons} turn-ons: {found:.1?} %");
        for share in found {
            assert!(share > least && share < 95.0 + error, "{name}, {turn_ons}: {found:?}");
        }
    };
    for (number, turn_ons) in [2, 3, 5].into_iter().enumerate() {
        let (of, number) = (design(turn_ons, 1, 1, false), number as u64);
        let due = 95.0 - error;
        let of_k = coverage(800 + number, of, Fault { k_percent: 0.05, ..Fault::default() }, false);
        check("K varies by 0.05 %", turn_ons, of_k, if turn_ons == 2 { due - 3.0 } else { due });
        let of_drift = coverage(810 + number, of, Fault { drift_deg_per_h2: 0.02, ..Fault::default() }, true);
        check("--drift", turn_ons, of_drift, due);
    }
    let of = design(3, 1, 1, true);
    let without = coverage(820, of, Fault { visit_deg_per_h: 0.04, ..Fault::default() }, false);
    check("without a visit that is named", 3, without, 95.0 - error);
}
