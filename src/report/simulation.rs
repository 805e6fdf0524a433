//! Tables of simulations, with the paper's figures next to ours.

use crate::report::columns::decimals;
use crate::report::doc::{Block, Rows, Words, joined, line, marked, say, typed};
use crate::simulation::draw::CurrentError;
use crate::simulation::{AccuracyOptions, AccuracyRow, AccuracyTable, Convergence, ConvergenceRow, PAPER_LATITUDE_DEG};
use crate::statistics::summary::upper_limit_without_a_case;
use crate::units::printed;
use crate::wording::words::grouped;
use crate::wording::{Language, Number, plain};

/// Returns the paper's table: worst error and standard deviation of every parameter by every method, and whether the worst
/// error is within the paper's bound.
pub(crate) fn accuracy(found: &AccuracyTable, options: &AccuracyOptions) -> String {
    let stands = match found.limit_deg {
        Some(limit) => format!("Each deviation is drawn uniformly within ±{limit}°."),
        None => "The deviations are those of the specified stand.".to_owned(),
    };
    let bounded: Vec<bool> = found.rows.iter().filter_map(|row| Some(row.worst < row.paper_bound?)).collect();
    let (all, beyond) = (bounded.len(), bounded.iter().filter(|within| !**within).count());
    let answer = match beyond {
        0 => format!("WITHIN  All {all} worst errors are within the paper's bounds."),
        beyond => format!("BEYOND  {beyond} of {all} worst errors exceed the paper's bounds."),
    };
    let errors = match options.current_error {
        CurrentError::Independent => "Each current has an error of its own",
        CurrentError::Channel => "The currents of each axis have a common error",
        CurrentError::Common => "All currents have a common error",
    };
    let gyro = match options.within_tolerance {
        true => "The gyro is drawn within its tolerance, and errors are relative to the nominal values.",
        false => "The gyro has the nominal parameters.",
    };
    let (trials, seed, latitude) = (grouped(found.trials, ","), found.seed, found.latitude_deg);
    let words = format!(
        "{trials} trials, seed {seed}, latitude {latitude:.4}°. {stands} {errors}, drawn uniformly within ±{} %. {gyro}",
        options.current_percent
    );
    let as_in_the_paper = options.within_tolerance && options.current_error == CurrentError::Common;
    let remedy = "To reproduce the paper's bounds, use --within-tolerance --current-error common.";
    let three_digits = |value: f64| match value {
        // NaN if no trial gave a result; below the least there is rounding alone.
        value if value.is_nan() => "-".to_owned(),
        value if value < 1e-11 => "0".to_owned(),
        value => format!("{value:.*}", decimals(value) + 1),
    };
    let judged = |row: &AccuracyRow| {
        let is_within = row.paper_bound.map(|bound| row.worst < bound);
        let judged = is_within.map(|is| marked(Some(is), if is { "within" } else { "BEYOND" }));
        let without = (row.not_solved > 0).then(|| format!("{} trials gave no result", grouped(row.not_solved, ",")));
        joined(judged.into_iter().chain(without.map(Words::from)), "; ")
    };
    let table = Rows::of(&found.rows, "")
        .named("method", |row| row.method.to_string())
        .column("parameter", |row| row.parameter.symbol())
        .column("unit", |row| printed(row.unit))
        .column("worst", |row| three_digits(row.worst))
        .column("std. dev.", |row| three_digits(row.standard_deviation))
        .column("paper's bound", |row| row.paper_bound)
        .column("", judged);
    let answer = (all > 0).then(|| line(marked(Some(beyond == 0), answer)));
    let remedy = (all > 0 && !as_in_the_paper).then(|| line(remedy));
    let doc: Vec<Block> =
        answer.into_iter().chain([line(words)]).chain(remedy).chain([Block::Table(table.table)]).collect();
    typed(&doc, Language::English)
}

/// Returns the paper's Fig. 4 as numbers.
pub(crate) fn convergence(found: &Convergence) -> String {
    let (trials, seed) = (grouped(found.trials, ","), found.seed);
    let head = format!(
        "Number of steps of the iterative method: {trials} stands at each limit, seed {seed}, latitude \
         {PAPER_LATITUDE_DEG:.4}°"
    );
    let stands = |row: &ConvergenceRow| format!("{} stands", grouped(row.stands, ","));
    let table = Rows::of(&found.rows, "")
        .named("limit, °", |row| row.limit_deg)
        .column("angles", |row| row.deviations)
        .column("mean", |row| row.mean.map(|mean| format!("{mean:.*}", decimals(row.mean_u.unwrap_or(1.0)))))
        .column("95th perc.", |row| row.percentile_95)
        .column("maximum", |row| row.most)
        .column("not converged, %", not_converged)
        .column("", |row| if row.stands < found.trials { stands(row) } else { String::new() });
    let notes = [
        "Mean, 95th percentile and maximum are those of the stands that converged.",
        "The number after ± is the standard uncertainty. Where all stands converged or none did,",
        "< and > precede the 95 % limit of the share.",
    ];
    let mut doc = vec![line(head), Block::Table(table.table)];
    doc.extend(notes.map(|note| say([note])));
    typed(&doc, Language::English)
}

/// Formats the share of stands that did not converge, percent. If all converged or none did, the binomial standard error
/// is 0, which would claim a certainty that no number of stands gives.
pub(crate) fn not_converged(row: &ConvergenceRow) -> String {
    let (percent, u) = (row.not_converged_percent, row.not_converged_u_percent);
    if u > 0.0 {
        let decimals = decimals(u);
        return format!("{percent:.decimals$} ± {u:.decimals$}");
    }
    let limit = 100.0 * upper_limit_without_a_case(row.stands);
    if percent == 0.0 {
        format!("< {}", plain(&Number::scientific(limit, 2).text(Language::English)))
    } else {
        format!("> {:.*}", decimals(limit), 100.0 - limit)
    }
}
