//! JCGM 101:2008 (Supplement 1 to the GUM), 9.2 and 9.3: distributions propagated by drawing.
//!
//! Intervals may be off by the guide's numerical tolerance (7.9.2): half a unit of the last of the significant digits that
//! it asks for, two in 9.2 and one in 9.3.

use super::Case;
use crate::statistics::random::{Run, Stream};
use crate::statistics::summary::Summary;

/// Trials of each example, as the guide has.
const TRIALS: u64 = 1_000_000;

/// The seed; any other gives the same within the tolerance.
const SEED: u64 = 101;

/// What one example prints.
struct Printed {
    example: &'static str,
    source: &'static str,
    standard_uncertainty: f64,
    interval: [f64; 2],
    /// Of the interval's ends.
    tolerance: f64,
    /// Of the standard uncertainty.
    u_tolerance: f64,
    /// The shortest interval, or the one with equal tails.
    shortest: bool,
}

/// The four examples.
pub fn cases(threads: usize) -> Vec<Case> {
    let mut cases = Vec::new();
    let normals = Printed {
        example: "JCGM 101 9.2.2 four normal inputs",
        source: "JCGM 101:2008, 9.2.2",
        standard_uncertainty: 2.00,
        interval: [-3.92, 3.92],
        tolerance: 0.05,
        u_tolerance: 0.05,
        shortest: false,
    };
    cases.extend(compared(&normals, threads, |stream| (0..4).map(|_| stream.normal()).sum()));
    let rectangles = Printed {
        example: "JCGM 101 9.2.3 four rectangular inputs",
        source: "JCGM 101:2008, 9.2.3 (also in closed form)",
        interval: [-3.88, 3.88],
        ..normals
    };
    cases.extend(compared(&rectangles, threads, |stream| (0..4).map(|_| rectangle(stream)).sum()));
    let one_larger = Printed {
        example: "JCGM 101 9.2.4 one input ten times larger",
        source: "JCGM 101:2008, 9.2.4",
        standard_uncertainty: 10.1,
        interval: [-17.0, 17.0],
        tolerance: 0.5,
        u_tolerance: 0.5,
        ..normals
    };
    cases.extend(compared(&one_larger, threads, |stream| {
        10.0 * rectangle(stream) + (0..3).map(|_| rectangle(stream)).sum::<f64>()
    }));
    // The guide's own run was short (one significant digit asked for); 1e7 draws give 0.07547 and [1.0845, 1.3836].
    let mass = Printed {
        example: "JCGM 101 9.3 mass calibration",
        source: "JCGM 101:2008, 9.3.2 (Monte Carlo, shortest)",
        standard_uncertainty: 0.0754,
        interval: [1.0834, 1.3825],
        tolerance: 0.005,
        u_tolerance: 0.005,
        shortest: true,
    };
    cases.extend(compared(&mass, threads, mass_difference_mg));
    cases
}

/// Rectangular, mean 0 and standard deviation 1.
fn rectangle(stream: &mut Stream) -> f64 {
    stream.within(3_f64.sqrt())
}

/// δm = (m_R,c + δm_R,c) (1 + (ρ_a − 1.2 kg/m³)(1/ρ_W − 1/ρ_R)) − 100 g, in mg (9.3.1, with the inputs of 9.3.2).
fn mass_difference_mg(stream: &mut Stream) -> f64 {
    const NOMINAL_MG: f64 = 100_000.0;
    let reference_mg = NOMINAL_MG + 0.050 * stream.normal();
    let difference_mg = 1.234 + 0.020 * stream.normal();
    let air = stream.within(0.10);
    let weight = 8000.0 + stream.within(1000.0);
    let reference = 8000.0 + stream.within(50.0);
    (reference_mg + difference_mg) * (1.0 + air * (1.0 / weight - 1.0 / reference)) - NOMINAL_MG
}

fn compared(printed: &Printed, threads: usize, draw: impl Fn(&mut Stream) -> f64 + Sync) -> Vec<Case> {
    let run = Run { threads, ..Run::new(TRIALS, SEED) };
    let blocks = run.blocks(|stream, trials| (0..trials).map(|_| draw(stream)).collect::<Vec<f64>>());
    let mut values: Vec<f64> = blocks.into_iter().flatten().collect();
    let mut summary = Summary::default();
    values.iter().for_each(|value| summary.add(*value));
    values.sort_by(f64::total_cmp);
    let [low, high] = interval_95(&values, printed.shortest);
    let kind = if printed.shortest { "shortest" } else { "symmetric" };
    let case = |quantity: String, expected, tolerance, found| Case {
        example: printed.example,
        quantity,
        source: printed.source,
        expected,
        tolerance,
        found,
        digits: None,
    };
    vec![
        case(
            "standard uncertainty".into(),
            printed.standard_uncertainty,
            printed.u_tolerance,
            summary.standard_deviation(),
        ),
        case(format!("{kind} 95 % interval, low"), printed.interval[0], printed.tolerance, low),
        case(format!("{kind} 95 % interval, high"), printed.interval[1], printed.tolerance, high),
    ]
}

/// The interval that holds 95 % of `sorted` values (7.7.2): with 2.5 % on either side, or the shortest.
fn interval_95(sorted: &[f64], shortest: bool) -> [f64; 2] {
    let inside = (0.95 * sorted.len() as f64).round() as usize;
    let beyond = sorted.len() - inside;
    let at = |first: usize| [sorted[first], sorted[first + inside]];
    let length = |first: &usize| sorted[first + inside] - sorted[*first];
    let best = if shortest { (0..beyond).min_by(|a, b| length(a).total_cmp(&length(b))) } else { None };
    at(best.unwrap_or(beyond / 2))
}
