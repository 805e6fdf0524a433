//! Result of a Monte Carlo run as text.

use crate::report::columns;
use crate::uncertainty::MonteCarlo;
use crate::uncertainty::budget::COVERAGE;
use std::fmt::Write;

/// Returns uncertainties and coverage intervals, and for every parameter whether the linear approximation is valid.
pub(crate) fn text(found: &MonteCarlo) -> String {
    let mut out = String::new();
    let _ = writeln!(
        out,
        "\nMonte Carlo ({}), {} trials, seed {}; {:.0} % coverage intervals",
        found.method.key(),
        found.trials,
        found.seed,
        100.0 * COVERAGE
    );
    let names = ["", "mean", "u", "symmetric", "shortest", "difference", "allowed", "linear"];
    columns::table(&mut out, &names, found.parameters.iter().map(row));
    let words = "difference: of the ends of the interval by linear approximation from those of the symmetric one (the \
                 larger of the two); allowed: half a unit of the second digit of u (JCGM 101, clause 8); linear: \
                 whether the linear approximation is valid.";
    columns::paragraph(&mut out, "  ", words);
    if !found.stable {
        let words = "WARNING: not all stated digits are stable; more trials (JCGM 101, 7.9) would change some of them.";
        columns::paragraph(&mut out, "  ", words);
    }
    if found.failed > 0 {
        let words = format!("WARNING: {} trials gave no finite parameters and were excluded.", found.failed);
        columns::paragraph(&mut out, "  ", &words);
    }
    out
}

fn row(line: &crate::uncertainty::monte_carlo::Distribution) -> Vec<String> {
    let digits = columns::decimals(line.standard_uncertainty);
    let interval = |[low, high]: [f64; 2]| format!("{low:.digits$} to {high:.digits$}");
    let first = &line.first_order;
    vec![
        line.parameter.symbol().to_owned(),
        format!("{:.digits$}", line.mean),
        format!("{:.digits$}", line.standard_uncertainty),
        interval(line.symmetric),
        interval(line.shortest),
        format!("{:.*}", digits + 2, first.differences[0].max(first.differences[1])),
        format!("{:.*}", digits + 1, first.tolerance),
        match first.valid {
            Some(true) => "valid".to_owned(),
            Some(false) => "NOT VALID".to_owned(),
            None => "too few trials".to_owned(),
        },
    ]
}
