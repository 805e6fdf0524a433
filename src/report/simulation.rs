//! Tables of simulations, with the paper's figures next to ours.

use super::tolerance::symbol_of;
use crate::simulation::accuracy::Accuracy;
use crate::simulation::convergence::Convergence;
use crate::units::printed;
use std::fmt::Write;

/// Returns the paper's table: worst error and standard deviation of every parameter by every method.
pub(crate) fn accuracy(found: &Accuracy) -> String {
    let mut out = String::new();
    let stands = match found.limit_deg {
        Some(limit) => format!("all deviations uniform within {limit} degrees"),
        None => "the specified stand".to_owned(),
    };
    let _ = writeln!(out, "{} trials, seed {}, {stands}", found.trials, found.seed);
    let _ = writeln!(
        out,
        "  {:<13}  {:<9}  {:>10}  {:>10}  {:>9}  unit",
        "method", "parameter", "worst", "std. dev.", "paper"
    );
    for row in &found.rows {
        let or_dash = |value: f64, decimals: usize| match value.is_nan() {
            true => "-".to_owned(),
            false => format!("{value:.decimals$}"),
        };
        let paper = row.paper_bound.map_or_else(|| "-".to_owned(), |bound| format!("< {bound}"));
        let _ = writeln!(
            out,
            "  {:<13}  {:<9}  {:>10}  {:>10}  {paper:>9}  {}",
            row.method,
            symbol_of(row.parameter),
            or_dash(row.worst, 5),
            or_dash(row.standard_deviation, 6),
            printed(row.unit)
        );
        if row.not_solved > 0 {
            let _ = writeln!(out, "                 {} trials gave no result", row.not_solved);
        }
    }
    out
}

/// Returns the paper's Fig. 4 as numbers.
pub(crate) fn convergence(found: &Convergence) -> String {
    let mut out = String::new();
    let _ = writeln!(out, "Steps of the iterative method, {} stands at each limit, seed {}", found.trials, found.seed);
    let names = ["limit, deg", "angles", "mean", "95th perc.", "most", "not converged, %"];
    let [limit, angles, mean, percentile, most, not] = names;
    let _ = writeln!(out, "  {limit:>10}  {angles:<8}  {mean:>7}  {percentile:>10}  {most:>5}  {not:>16}");
    for row in &found.rows {
        let or_dash = |value: Option<String>| value.unwrap_or_else(|| "-".to_owned());
        let fewer = if row.stands < found.trials { format!("  ({} stands)", row.stands) } else { String::new() };
        let _ = writeln!(
            out,
            "  {:>10}  {:<8}  {:>7}  {:>10}  {:>5}  {:>16}{fewer}",
            row.limit_deg,
            row.deviations,
            or_dash(row.mean.map(|mean| format!("{mean:.2}"))),
            or_dash(row.percentile_95.map(|steps| steps.to_string())),
            or_dash(row.most.map(|steps| steps.to_string())),
            format!("{:.2} ± {:.2}", row.not_converged_percent, row.not_converged_u_percent),
        );
    }
    out
}
