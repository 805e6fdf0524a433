//! Checks of the order and the times of the rows of currents: what cannot be is refused, what is doubtful is a remark.

use super::Reading;
use crate::coefficients::PositionIndex;
use crate::text::number::two_digits;
use crate::text::table::{Row, Table};
use crate::text::{Advice, Problem, RefusalCause};
use crate::units::SECONDS_PER_HOUR;
use std::collections::{BTreeMap, BTreeSet};

/// Returns a problem for the first row, in the order of time, that continues a visit after another position was visited.
/// Without times the rows of a visit may stand in any order.
pub(super) fn torn_visits(table: &Table, readings: &[Reading]) -> Vec<Problem> {
    let timed = |(reading, row): (&Reading, _)| Some((reading.time_s?, *reading, row));
    let Some(mut rows) = readings.iter().zip(&table.rows).map(timed).collect::<Option<Vec<_>>>() else {
        return Vec::new();
    };
    rows.sort_by(|(one, ..), (other, ..)| one.total_cmp(other));
    let mut ended = BTreeSet::new();
    let mut before: Option<(PositionIndex, u32, u32)> = None;
    for (_, reading, row) in rows {
        let Some(visit) = reading.visit else { continue };
        let here = (reading.index, reading.cycle, visit);
        if before.is_some_and(|before| before != here) {
            ended.extend(before);
        }
        before = Some(here);
        if ended.contains(&here) {
            let found = format!("visit {visit} of position {} again, later than another visit", reading.index);
            let advice = "give a later visit to the position the next number, or check the times";
            let column = table.place("visit").unwrap_or(0);
            return vec![table.problem(&row[column], column, found, "a visit that is not interrupted", advice)];
        }
    }
    Vec::new()
}

/// Returns a problem for the first row after midnight, if the times of all rows rise except at midnight.
pub(super) fn over_midnight(table: &Table, readings: &[Reading]) -> Vec<Problem> {
    let Some(column) = table.place("time_s") else { return Vec::new() };
    let time_s = |reading: &Reading| reading.time_s.unwrap_or_default();
    let pairs = readings.windows(2).zip(table.rows.iter().skip(1));
    let falls = pairs.filter(|(pair, _)| time_s(&pair[1]) < time_s(&pair[0]));
    let falls: Vec<_> = falls.map(|(pair, row)| (time_s(&pair[0]), time_s(&pair[1]), row)).collect();
    if !falls.iter().all(|(before_s, time_s, _)| is_midnight(*before_s, *time_s)) {
        return Vec::new();
    }
    let problem = |(before_s, time_s, row): &(f64, f64, &Row)| {
        let expected = format!("a time not before that of the row above, {before_s} s");
        table.problem(&row[column], column, format!("{time_s} s"), &expected, RefusalCause::Midnight)
    };
    falls.first().map(problem).into_iter().collect()
}

/// Returns a problem for the first row whose time cannot be: earlier than the row before it where the order of rows tells
/// the visits, or in a cycle that begins before an earlier one ends.
pub(super) fn impossible_times(table: &Table, readings: &[Reading]) -> Vec<Problem> {
    let Some(column) = table.place("time_s") else { return Vec::new() };
    let mut last: BTreeMap<u32, f64> = BTreeMap::new();
    for reading in readings {
        let end = last.entry(reading.cycle).or_insert(f64::NEG_INFINITY);
        *end = end.max(reading.time_s.unwrap_or(f64::NEG_INFINITY));
    }
    let mut before = f64::NEG_INFINITY;
    for (reading, row) in readings.iter().zip(&table.rows) {
        let time_s = reading.time_s.unwrap_or(before);
        let refuse = |expected: &str, advice: Advice| {
            vec![table.problem(&row[column], column, format!("{time_s} s"), expected, advice)]
        };
        if let Some((cycle, end)) = last.range(..reading.cycle).find(|(_, end)| **end > time_s) {
            let expected = format!("a time after the last one of cycle {cycle}, {end} s");
            let otherwise = "count the time from the first reading of the run, not of each cycle";
            return refuse(&expected, on_fall(*end, time_s, otherwise));
        }
        if reading.visit.is_none() && time_s < before {
            let expected = format!("a time not before that of the row above, {before} s");
            let otherwise = "sort the rows by time, or number the visits in the column visit";
            return refuse(&expected, on_fall(before, time_s, otherwise));
        }
        before = time_s;
    }
    // Where visits are numbered, the rows may stand in any order.
    let numbered =
        |(reading, row): (&Reading, _)| Some(((reading.cycle, reading.index, reading.visit?), reading.time_s?, row));
    let mut visits: Vec<_> = readings.iter().zip(&table.rows).filter_map(numbered).collect();
    visits.sort_by_key(|(visit, ..)| *visit);
    for pair in visits.windows(2) {
        let [((cycle, index, one), before, _), ((of, at, other), time_s, row)] = pair else { continue };
        if (cycle, index) == (of, at) && one < other && time_s < before {
            let found = format!("{time_s} s for visit {other} of position {index}");
            let expected = format!("a time not before that of visit {one}, {before} s");
            let advice = on_fall(*before, *time_s, "number the visits in the order of time, or check the times");
            return vec![table.problem(&row[column], column, found, &expected, advice)];
        }
    }
    Vec::new()
}

/// Returns the advice on a time, s, that is before an earlier one; `otherwise` if neither midnight nor a clock explains it.
fn on_fall(before_s: f64, time_s: f64, otherwise: &str) -> Advice {
    match before_s - time_s {
        _ if is_midnight(before_s, time_s) => RefusalCause::Midnight.into(),
        fall if (0.5 * SECONDS_PER_HOUR..=SECONDS_PER_HOUR).contains(&fall) => {
            "the clock seems to have been set back by an hour: add 3600 s to the times from there on".into()
        }
        _ => otherwise.into(),
    }
}

/// Returns `true` if a time, s, that follows another seems to be that of a clock on the next day.
fn is_midnight(before_s: f64, time_s: f64) -> bool {
    const DAY_S: f64 = 24.0 * SECONDS_PER_HOUR;
    before_s <= DAY_S && before_s - time_s > 0.5 * DAY_S
}

/// Returns the number of moves to another position within the turn-ons, and the time that these took, s. Without times or
/// moves, and if all times of a turn-on are the same, which says nothing, it returns `None`.
fn moves(readings: &[Reading]) -> Option<(usize, f64)> {
    let mut rows: Vec<(u32, f64, PositionIndex)> =
        readings.iter().map(|reading| Some((reading.cycle, reading.time_s?, reading.index))).collect::<Option<_>>()?;
    rows.sort_by(|one, other| one.0.cmp(&other.0).then(one.1.total_cmp(&other.1)));
    let (mut moves, mut span_s) = (0, 0.0);
    for turn_on in rows.chunk_by(|one, other| one.0 == other.0) {
        moves += turn_on.windows(2).filter(|pair| pair[0].2 != pair[1].2).count();
        span_s += turn_on[turn_on.len() - 1].1 - turn_on[0].1;
    }
    (moves > 0 && span_s > 0.0).then_some((moves, span_s))
}

/// Returns a problem if the times leave less than a second for each move to another position: spreadsheets count days, and
/// loggers may count hours.
pub(super) fn times_in_another_unit(readings: &[Reading]) -> Vec<Problem> {
    let Some((moves, span_s)) = moves(readings) else { return Vec::new() };
    if span_s >= moves as f64 {
        return Vec::new();
    }
    let found = format!("time_s: {moves} moves to another position within {} s", two_digits(span_s));
    vec![Problem::whole(found, "seconds", "convert the times to seconds; dates of a spreadsheet are in days")]
}

/// Returns a remark if the rows of a visit are not next to each other: they may be returns to the position.
pub(super) fn scattered_visit(readings: &[Reading]) -> Option<String> {
    let mut ended = BTreeSet::new();
    for pair in readings.windows(2) {
        let [here, next] = [&pair[0], &pair[1]].map(|reading| (reading.cycle, reading.index, reading.visit));
        if here == next {
            continue;
        }
        ended.insert(here);
        if let (true, (_, index, Some(visit))) = (ended.contains(&next), next) {
            return Some(format!(
                "rows of visit {visit} to position {index} are not next to each other, and count as readings of one visit; give \
                 every visit to the position its own number"
            ));
        }
    }
    None
}

/// Average time of a move to another position below which times may be minutes, and above which they may be milliseconds, s.
const USUAL_MOVE_S: [f64; 2] = [10.0, 4.0 * SECONDS_PER_HOUR];

/// Returns a remark if the moves to other positions within a turn-on are so fast or so slow that the times may be in another
/// unit: the currents fit as well with it, but a drift in time has the wrong size.
pub(super) fn doubtful_times(readings: &[Reading]) -> Option<String> {
    let (moves, span_s) = moves(readings)?;
    let each_s = span_s / moves as f64;
    let (unit, factor) = match USUAL_MOVE_S {
        [least, _] if each_s < least => ("minutes", "60 times too large"),
        [_, most] if each_s > most => ("milliseconds", "1000 times too small"),
        _ => return None,
    };
    let (span, each) = (two_digits(span_s), two_digits(each_s));
    Some(format!(
        "time_s: {moves} moves to another position within {span} s, {each} s for each; if the times are in {unit}, convert them \
         to seconds, because a drift in time would be stated {factor}"
    ))
}
