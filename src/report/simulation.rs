//! Tables of simulations, with the paper's figures next to ours.

use super::columns;
use crate::simulation::accuracy::Accuracy;
use crate::simulation::convergence::{Convergence, ConvergenceRow};
use crate::statistics::summary::upper_limit_without_a_case;
use crate::units::printed;
use std::fmt::Write;

/// Returns the paper's table: worst error and standard deviation of every parameter by every method.
pub(crate) fn accuracy(found: &Accuracy) -> String {
    let mut out = String::new();
    let stands = match found.limit_deg {
        Some(limit) => format!("all deviations uniform within {limit}°"),
        None => "the specified stand".to_owned(),
    };
    let (trials, seed, latitude) = (found.trials, found.seed, found.latitude_deg);
    let _ = writeln!(out, "{trials} trials, seed {seed}, {stands}, latitude {latitude:.4}°");
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
            row.parameter.symbol(),
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
    let names = ["limit, °", "angles", "mean", "95th perc.", "most", "not converged, %"];
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
            not_converged(row),
        );
    }
    out.push_str("  ±: standard uncertainty; < and >: limit at 95 %, where all stands converged or none did\n");
    out
}

/// Formats the share of stands that did not converge, percent. If all converged or none did, the binomial standard error
/// is 0, which would claim a certainty that no number of stands gives.
pub(crate) fn not_converged(row: &ConvergenceRow) -> String {
    let (percent, u) = (row.not_converged_percent, row.not_converged_u_percent);
    if u > 0.0 {
        let decimals = columns::decimals(u);
        return format!("{percent:.decimals$} ± {u:.decimals$}");
    }
    let limit = 100.0 * upper_limit_without_a_case(row.stands);
    if percent == 0.0 {
        format!("< {}", columns::two_digits(limit))
    } else {
        format!("> {:.*}", columns::decimals(limit), 100.0 - limit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected by hand from the binomial distribution: 17 of 200 are 8.5 % ± √(0.085 · 0.915 / 200) = 1.97 %; no case in
    /// 200 has the probability 0.05 if the share is 1.49 %, as 0.9851²⁰⁰ = 0.0497.
    #[test]
    fn a_share_of_none_or_all_is_a_limit() {
        for (not_converged_percent, not_converged_u_percent, due) in
            [(8.5, 1.97, "8.5 ± 2.0"), (0.0, 0.0, "< 1.5"), (100.0, 0.0, "> 98.5")]
        {
            let (mean, percentile_95, most) = (None, None, None);
            let row = ConvergenceRow {
                limit_deg: 15.0,
                deviations: "corners",
                mean,
                percentile_95,
                most,
                not_converged_percent,
                not_converged_u_percent,
                stands: 200,
            };
            assert_eq!(not_converged(&row), due);
        }
    }
}
