//! Tables of simulations, with the paper's figures next to ours.

use super::style::Outcome;
use super::{columns, style};
use crate::simulation::draw::CurrentError;
use crate::simulation::{AccuracyOptions, AccuracyTable, Convergence, ConvergenceRow, PAPER_LATITUDE_DEG};
use crate::statistics::summary::upper_limit_without_a_case;
use crate::units::printed;
use crate::wording::number::Number;
use crate::wording::words::grouped;
use crate::wording::{Language, plain};
use std::fmt::Write;

/// Returns the paper's table: worst error and standard deviation of every parameter by every method, and whether the worst
/// error is within the paper's bound.
pub(crate) fn accuracy(found: &AccuracyTable, options: &AccuracyOptions) -> String {
    let stands = match found.limit_deg {
        Some(limit) => format!("Each deviation is drawn uniformly within ±{limit}°."),
        None => "The deviations are those of the specified stand.".to_owned(),
    };
    let (trials, seed, latitude) = (grouped(found.trials, ","), found.seed, found.latitude_deg);
    let mut out = String::new();
    let bounded: Vec<bool> = found.rows.iter().filter_map(|row| Some(row.worst < row.paper_bound?)).collect();
    if !bounded.is_empty() {
        let (within, all) = (bounded.iter().filter(|within| **within).count(), bounded.len());
        let words = match all - within {
            0 => format!("WITHIN  All {all} worst errors are within the paper's bounds."),
            beyond => format!("BEYOND  {beyond} of {all} worst errors exceed the paper's bounds."),
        };
        let _ = writeln!(out, "{}", style::marked(Some(within == all), &words));
    }
    let errors = match options.current_error {
        CurrentError::Independent => "Each current has an error of its own",
        CurrentError::Channel => "The currents of each axis have a common error",
        CurrentError::Common => "All currents have a common error",
    };
    let gyro = if options.within_tolerance {
        "The gyro is drawn within its tolerance, and errors are relative to the nominal values."
    } else {
        "The gyro has the nominal parameters."
    };
    let words = format!(
        "{trials} trials, seed {seed}, latitude {latitude:.4}°. {stands} {errors}, drawn uniformly within ±{} %. {gyro}",
        options.current_percent
    );
    columns::paragraph(&mut out, "", &words);
    let as_in_the_paper = options.within_tolerance && options.current_error == CurrentError::Common;
    if !bounded.is_empty() && !as_in_the_paper {
        columns::paragraph(
            &mut out,
            "",
            "To reproduce the paper's bounds, use --within-tolerance --current-error common.",
        );
    }
    let rows = found.rows.iter().map(|row| {
        // NaN if no trial gave a result.
        let three_digits = |value: f64| match value {
            value if value.is_nan() => "-".to_owned(),
            // Rounding alone.
            value if value < 1e-11 => "0".to_owned(),
            value => format!("{value:.*}", columns::decimals(value) + 1),
        };
        let judged = row.paper_bound.map(|bound| match row.worst < bound {
            true => style::marked(Outcome::Passed, "within"),
            false => style::marked(Outcome::Failed, "BEYOND"),
        });
        let without = (row.not_solved > 0).then(|| format!("{} trials gave no result", grouped(row.not_solved, ",")));
        vec![
            row.method.to_string(),
            row.parameter.symbol().to_owned(),
            printed(row.unit),
            three_digits(row.worst),
            three_digits(row.standard_deviation),
            row.paper_bound.map_or_else(|| "-".to_owned(), |bound| bound.to_string()),
            judged.into_iter().chain(without).collect::<Vec<_>>().join("; "),
        ]
    });
    columns::table(&mut out, 1, &["method", "parameter", "unit", "worst", "std. dev.", "paper's bound", ""], rows);
    out
}

/// Returns the paper's Fig. 4 as numbers.
pub(crate) fn convergence(found: &Convergence) -> String {
    let (trials, seed) = (grouped(found.trials, ","), found.seed);
    let mut out = format!(
        "Number of steps of the iterative method: {trials} stands at each limit, seed {seed}, latitude \
         {PAPER_LATITUDE_DEG:.4}°\n"
    );
    let rows = found.rows.iter().map(|row| {
        let or_dash = |value: Option<String>| value.unwrap_or_else(|| "-".to_owned());
        vec![
            row.limit_deg.to_string(),
            row.deviations.to_owned(),
            or_dash(row.mean.map(|mean| format!("{mean:.*}", columns::decimals(row.mean_u.unwrap_or(1.0))))),
            or_dash(row.percentile_95.map(|steps| steps.to_string())),
            or_dash(row.most.map(|steps| steps.to_string())),
            not_converged(row),
            if row.stands < found.trials { format!("{} stands", grouped(row.stands, ",")) } else { String::new() },
        ]
    });
    columns::table(&mut out, 1, &["limit, °", "angles", "mean", "95th perc.", "maximum", "not converged, %", ""], rows);
    out.push_str("  Mean, 95th percentile and maximum are those of the stands that converged.\n");
    out.push_str("  The number after ± is the standard uncertainty. Where all stands converged or none did,\n");
    out.push_str("  < and > precede the 95 % limit of the share.\n");
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
        format!("< {}", plain(&Number::scientific(limit, 2).text(Language::English)))
    } else {
        format!("> {:.*}", columns::decimals(limit), 100.0 - limit)
    }
}
