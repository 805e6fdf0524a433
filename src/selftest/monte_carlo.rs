//! Examples 9.2 and 9.3 of JCGM 101:2008 (Supplement 1 to the GUM): distributions propagated by Monte Carlo, with the
//! program's own random numbers and bins.
//!
//! The limits follow from the origin of the numbers, not from the agreement found: half a unit of the last digit
//! printed plus four standard errors of a million trials.
//!
//! Example 9.3 is itself one run of the guide's adaptive procedure, with fewer trials. The location of the shortest
//! interval is a flat minimum: both ends move up and down together, and their scatter decreases with the cube root of
//! the number of trials, not with the square root. In repeated runs of 720,000 trials the standard deviation of the
//! ends is 0.0009 mg, and that of the width is 0.00036 mg; 20 million trials give u = 0.07547 mg and
//! [1.0846, 1.3836] mg. The guide's interval [1.0834, 1.3825] mg therefore has the right width, 0.2991 mg, and is
//! 0.0011 mg low by chance. The tolerance is 0.004 mg for its ends and 0.0016 mg for its width. The inputs (table 5)
//! are also those of the R package `propagate`, which contains this example.

use super::Case;
use crate::statistics::summary::Summary;
use dtg_passport_trials::bins::{BINS, bin, quantile, shortest};
use dtg_passport_trials::wide_random::{Column, WIDTH, WideRandom};

/// Number of columns of trials of each example; the guide's number of trials, in whole columns.
const COLUMNS: usize = 1_000_000 / WIDTH;

/// Seed of the random numbers; any other seed gives results within the limits.
const SEED: u64 = 101;

const COVERAGE: f64 = 0.95;

/// Numbers printed for one example, each with its limit.
struct Printed {
    example: &'static str,
    source: &'static str,
    standard_uncertainty: (f64, f64),
    interval: [f64; 2],
    /// Tolerance of the interval's ends.
    limit: f64,
    /// Tolerance of the width of the shortest interval; `None` if the interval has equal tails.
    shortest: Option<f64>,
    /// Approximate mean and standard deviation, which place the bins.
    scale: (f64, f64),
}

pub(crate) fn cases() -> Vec<Case> {
    let normals = Printed {
        example: "JCGM 101 9.2.2 four normal inputs",
        source: "JCGM 101:2008, 9.2.2, table 2",
        standard_uncertainty: (2.00, 0.011),
        interval: [-3.92, 3.92],
        limit: 0.026,
        shortest: None,
        scale: (0.0, 2.0),
    };
    let rectangles = Printed {
        example: "JCGM 101 9.2.3 four rectangular inputs",
        source: "JCGM 101:2008, 9.2.3, table 3 (also in closed form: 2 √3 (2 − (3/5)^¼))",
        interval: [-3.88, 3.88],
        ..normals
    };
    let one_larger = Printed {
        example: "JCGM 101 9.2.4 one input ten times larger",
        source: "JCGM 101:2008, 9.2.4, table 4",
        standard_uncertainty: (10.1, 0.08),
        interval: [-17.0, 17.0],
        limit: 0.072,
        scale: (0.0, 10.1),
        ..normals
    };
    let mass = Printed {
        example: "JCGM 101 9.3 mass calibration",
        source: "JCGM 101:2008, 9.3.2.3, table 6 (a Monte Carlo result)",
        standard_uncertainty: (0.0754, 0.0004),
        interval: [1.0834, 1.3825],
        limit: 0.004,
        shortest: Some(0.0016),
        scale: (1.234, 0.0754),
    };
    [
        compared(&normals, |lanes| sum(&normal_columns(lanes))),
        compared(&rectangles, |lanes| sum(&[1.0; 4].map(|u| rectangle(lanes, u)))),
        compared(&one_larger, |lanes| sum(&[10.0, 1.0, 1.0, 1.0].map(|u| rectangle(lanes, u)))),
        compared(&mass, mass_difference_mg),
    ]
    .concat()
}

fn normal_columns(lanes: &mut WideRandom) -> [Column; 4] {
    let mut columns = [[0.0; WIDTH]; 4];
    let [a, b, c, d] = &mut columns;
    lanes.normals(a, b);
    lanes.normals(c, d);
    columns
}

/// Returns random numbers of a rectangular distribution with mean 0 and standard deviation `u`.
fn rectangle(lanes: &mut WideRandom, u: f64) -> Column {
    let mut column = [0.0; WIDTH];
    lanes.uniform(&mut column);
    column.map(|share| share * u * 3_f64.sqrt())
}

fn sum(columns: &[Column; 4]) -> Column {
    std::array::from_fn(|trial| columns.iter().map(|column| column[trial]).sum())
}

/// Returns δm = (m_R,c + δm_R,c) (1 + (ρ_a − 1.2 kg/m³)(1/ρ_W − 1/ρ_R)) − 100 g, mg (9.3.1.3, eq. (24), with the inputs
/// of table 5).
fn mass_difference_mg(lanes: &mut WideRandom) -> Column {
    const NOMINAL_MG: f64 = 100_000.0;
    let (mut reference, mut difference) = ([0.0; WIDTH], [0.0; WIDTH]);
    lanes.normals(&mut reference, &mut difference);
    let [air, weight, standard] = [0.10, 1000.0, 50.0].map(|half_width| {
        let mut column = [0.0; WIDTH];
        lanes.uniform(&mut column);
        column.map(|share| share * half_width)
    });
    std::array::from_fn(|trial| {
        let mass_mg = NOMINAL_MG + 0.050 * reference[trial] + 1.234 + 0.020 * difference[trial];
        let buoyancy = 1.0 / (8000.0 + weight[trial]) - 1.0 / (8000.0 + standard[trial]);
        mass_mg * (1.0 + air[trial] * buoyancy) - NOMINAL_MG
    })
}

fn compared(printed: &Printed, draw: impl Fn(&mut WideRandom) -> Column) -> Vec<Case> {
    let (centre, unit) = printed.scale;
    let mut lanes = WideRandom::new(SEED);
    let mut summary = Summary::default();
    let mut counts = vec![0_u32; BINS];
    for _ in 0..COLUMNS {
        for value in draw(&mut lanes) {
            let scaled = (value - centre) / unit;
            summary.add(scaled);
            counts[bin(scaled)] += 1;
        }
    }
    let (kind, ends) = match printed.shortest {
        Some(_) => ("shortest", shortest(&counts, COVERAGE)),
        None => ("symmetric", [0.5 - COVERAGE / 2.0, 0.5 + COVERAGE / 2.0].map(|share| quantile(&counts, share))),
    };
    let [low, high] = ends.map(|end| centre + unit * end);
    let case = |quantity: &str, expected, tolerance, found| {
        Case::new(printed.example, printed.source, quantity, [expected, tolerance, found])
    };
    let (u, u_limit) = printed.standard_uncertainty;
    let mut cases = vec![
        case("standard uncertainty", u, u_limit, unit * summary.standard_deviation()),
        case(&format!("{kind} 95 % interval, low"), printed.interval[0], printed.limit, low),
        case(&format!("{kind} 95 % interval, high"), printed.interval[1], printed.limit, high),
    ];
    if let Some(limit) = printed.shortest {
        let [due_low, due_high] = printed.interval;
        // Rounded to the printed digits, because a difference of binary numbers has more.
        let due = ((due_high - due_low) * 1e4).round() / 1e4;
        cases.push(case(&format!("{kind} 95 % interval, width"), due, limit, high - low));
    }
    cases
}
