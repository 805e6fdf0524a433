//! One stand over the years as a picture file: the time line above, below it the change of every deviation since the
//! first certificate, all to one scale.

use super::drawing::{Anchor, Field, Point, Scale, Ticks, coordinate, label, line, mark, rectangle, symbols, words};
use super::file::{caption, file};
use crate::attitude::ANGLE_SYMBOLS;
use crate::calibration::verdict::COVERAGE_FACTOR;
use crate::history::drift::{DRIFTS, Drift, Series};
use crate::history::{History, PastPassport};
use crate::register::State;
use crate::wording::Language;
use jiff::Timestamp;
use jiff::civil::Date;
use maud::{Markup, html};

const WIDTH: f64 = 760.0;
/// Left and right end of the time line.
const ACROSS: Point = [130.0, 740.0];
/// First baseline, height of a row of the time line, half-height of a bar.
const TOP: f64 = 64.0;
const ROW: f64 = 20.0;
const BAR_HALF: f64 = 5.0;
/// A small panel: distance between their left ends, width of the plot area, distance between their upper ends, height.
const COLUMN: f64 = 240.0;
const PLOT_WIDTH: f64 = 186.0;
const PANEL_ROW: f64 = 74.0;
const PLOT_HEIGHT: f64 = 52.0;
const LEFT: f64 = 56.0;

/// Draws the history as of `now`.
pub(crate) fn history(history: &History, now: Timestamp) -> String {
    let time = time_scale(history, now);
    let rows = history.sites().len() as f64 + 1.0;
    let bottom = TOP + ROW * rows;
    let panels_top = bottom + 92.0;
    // A single certificate shows no change.
    let changes = history.drift.series.iter().any(|series| series.values.len() > 1);
    let positions = history.drift.series.len().div_ceil(ANGLE_SYMBOLS.len()) as f64;
    let height = if changes { panels_top + PANEL_ROW * positions + 24.0 } else { bottom + 40.0 };
    let day = now.to_zoned(jiff::tz::TimeZone::UTC).date();
    let as_of = format!("as of {day}");
    let title = format!("Stand {} over the years, {as_of}", history.stand);
    let drawing = [
        words([20.0, 20.0], Anchor::Start, "title", &title),
        time_line(history, (now, &as_of), &time, bottom),
        html! { @if changes { (drift(&history.drift, panels_top)) } },
    ];
    file("history", [WIDTH, height], &title, &in_words(history), &drawing)
}

/// Decimal year of a date, for the horizontal axis.
fn year_of(date: Date) -> f64 {
    let days = f64::from(if date.in_leap_year() { 366 } else { 365 });
    f64::from(date.year()) + (f64::from(date.day_of_year()) - 1.0) / days
}

fn year_of_time(time: Timestamp) -> f64 {
    let seconds = time.as_second().rem_euclid(86_400) as f64 / 86_400.0;
    year_of(time.to_zoned(jiff::tz::TimeZone::UTC).date()) + seconds / 366.0
}

fn time_scale(history: &History, now: Timestamp) -> Scale {
    let certificates = history.certificates.iter().map(|at| year_of(at.stand.certificate.measured()));
    let issued = history.passports.iter().map(|at| year_of_time(at.row.issued_at));
    let ends = history.passports.iter().filter_map(|at| at.expires_at).map(year_of_time);
    let (low, high) = certificates
        .chain(issued)
        .chain(ends)
        .chain([year_of_time(now)])
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (f64::min(low, at), f64::max(high, at)));
    // Whole years, which have the numbers.
    let (low, high) = (low.floor(), high.ceil());
    Scale { values: [low, high.max(low + 1.0)], places: ACROSS }
}

fn time_line(history: &History, (now, as_of): (Timestamp, &str), time: &Scale, bottom: f64) -> Markup {
    let (sure, unsure) = ("bar", "frame-line");
    let row = |place: usize| TOP + ROW * place as f64;
    html! {
        (caption([20.0, 42.0], "", &[
            (rectangle([2.0, 2.5], [26.0, 11.5], sure, None), "in force"),
            (ahead([2.0, 2.5], [26.0, 11.5]), "until it expires"),
            (rectangle([2.0, 2.5], [26.0, 11.5], unsure, None), "withdrawn later"),
            (mark([14.0, 7.0], 1, "mark"), "measured for a certificate"),
            (line([14.0, 0.0], [14.0, 14.0], "zero"), as_of),
        ]))
        @for year in Ticks::between(time.values[0], time.values[1], 8).values.into_iter().filter(|year| year.fract() == 0.0) {
            @let x = time.place(year);
            (line([x, TOP - 10.0], [x, bottom], "grid"))
            (words([x, bottom + 14.0], Anchor::Middle, "small", &year.to_string()))
        }
        (words([ACROSS[0] - 8.0, row(0) + 4.0], Anchor::End, "small", "certificates"))
        @for at in &history.certificates {
            (mark([time.place(year_of(at.stand.certificate.measured())), row(0)], 1, "mark"))
        }
        @for (place, site) in (1..).zip(history.sites()) {
            (words([ACROSS[0] - 8.0, row(place) + 4.0], Anchor::End, "small", &shortened(site)))
            @for passport in history.passports.iter().filter(|at| at.row.site == site) {
                (bar(passport, now, time, row(place)))
            }
        }
        @let x = time.place(year_of_time(now));
        (line([x, TOP - 10.0], [x, bottom], "zero"))
    }
}

/// Draws the time in which a passport was in force; if it still is, until `now`, and paler from then until it expires.
fn bar(passport: &PastPassport, now: Timestamp, time: &Scale, y: f64) -> Markup {
    let from = year_of_time(passport.row.issued_at);
    let until = year_of_time(passport.ended_at.unwrap_or(now));
    let class = if passport.row.state == State::Withdrawn { "frame-line" } else { "bar" };
    let corner = |at: f64, side: f64| [time.clamped(at), y + side * BAR_HALF];
    html! {
        (rectangle(corner(from, -1.0), corner(until, 1.0), class, None))
        @if let Some(end) = passport.expires_at { (ahead(corner(until, -1.0), corner(year_of_time(end), 1.0))) }
    }
}

/// Draws the part of a bar that is later than the history.
fn ahead(one: Point, other: Point) -> Markup {
    rectangle(one, other, "grid", Some("#dddddd"))
}

/// Shortens the name of a site to the room on the left.
fn shortened(site: &str) -> String {
    const MOST: usize = 20;
    if site.chars().count() <= MOST {
        return site.to_owned();
    }
    site.chars().take(MOST - 1).chain(['…']).collect()
}

fn first_arcsec(series: &Series) -> f64 {
    series.values.first().map_or(0.0, |at| at.arcsec)
}

/// Returns years, change since the first certificate, and expanded uncertainty of each value, arcsec.
fn changes(series: &Series) -> impl Iterator<Item = [f64; 3]> {
    let first = first_arcsec(series);
    series.values.iter().map(move |at| [at.years, at.arcsec - first, COVERAGE_FACTOR * at.u_arcsec.unwrap_or(0.0)])
}

fn drift(drift: &Drift, top: f64) -> Markup {
    let all = || drift.series.iter().flat_map(changes);
    let ends = all().flat_map(|[_, change, half]| [change - half, change + half]);
    let (low, high) = ends.fold((-1.0, 1.0), |(low, high), end| (f64::min(low, end), f64::max(high, end)));
    // No whisker ends on an axis.
    let margin = 0.06 * (high - low);
    let (low, high) = (low - margin, high + margin);
    let last = all().map(|[years, ..]| years).fold(0.0, f64::max);
    let years = [-0.06 * last.max(1.0), 1.06 * last.max(1.0)];
    let sample = html! { (whisker(14.0, 1.0, 13.0)) (mark([14.0, 7.0], 1, "mark")) };
    let legend = [
        (sample, "change since the first certificate, ± 2 u"),
        (line([1.0, 7.0], [27.0, 7.0], "series"), "line of a deviation that drifts"),
        (line([1.0, 7.0], [27.0, 7.0], "grid"), "other line"),
    ];
    html! {
        (caption([20.0, top - 30.0], "″ over years:", &legend))
        @for (place, series) in drift.series.iter().enumerate() {
            @let (column, row) = ((place % 3) as f64, (place / 3) as f64);
            @let left = LEFT + COLUMN * column;
            @let upper = top + PANEL_ROW * row;
            @let field = Field {
                x: Scale { values: years, places: [left, left + PLOT_WIDTH] },
                y: Scale { values: [low, high], places: [upper + PLOT_HEIGHT, upper] },
            };
            // Only the lowest panel of a column has the numbers of its horizontal axis.
            (panel(series, &field, place + ANGLE_SYMBOLS.len() >= drift.series.len()))
        }
    }
}

fn panel(series: &Series, field: &Field, lowest: bool) -> Markup {
    let language = Language::English;
    let years = Ticks::along(&field.x, language).marks(language).into_iter().filter(|(year, _)| *year >= 0.0);
    let years = years.map(|(year, printed)| (year, if lowest { printed } else { String::new() }));
    let ticks = Ticks::between(field.y.values[0], field.y.values[1], 3).marks(language);
    let drifts = series.corrected_probability.is_some_and(|p| p < DRIFTS);
    let [left, right] = field.x.places;
    let title = format!(
        "{} {}{}",
        ANGLE_SYMBOLS[series.angle],
        series.index,
        match (drifts, &series.jump) {
            (true, _) => ": drifts",
            (false, Some(_)) => ": jump",
            (false, None) => "",
        }
    );
    html! {
        g {
            (field.axes(&years.collect::<Vec<_>>(), &ticks))
            (line([left, field.y.place(0.0)], [right, field.y.place(0.0)], "grid"))
            @if let Some(fitted) = &series.line {
                @let end = |x: f64| [field.x.place(x), field.y.clamped(fitted.at(x) - first_arcsec(series))];
                @let last = series.values.last().map_or(0.0, |at| at.years);
                (line(end(0.0), end(last), if drifts { "series" } else { "grid" }))
            }
            @for [years, change, half] in changes(series) {
                @let (x, y) = (field.x.place(years), |arcsec: f64| field.y.clamped(arcsec));
                @if half > 0.0 { (whisker(x, y(change - half), y(change + half))) }
                (mark([x, y(change)], 1, "mark"))
            }
            (label([right, field.y.places[1] - 3.0], Anchor::End, if drifts { "title" } else { "small" }, &symbols(&title)))
        }
    }
}

fn whisker(x: f64, from: f64, to: f64) -> Markup {
    let [left, right, middle, from, to] = [x - 2.5, x + 2.5, x, from, to].map(coordinate);
    let d = format!("M{middle},{from}V{to}M{left},{from}H{right}M{left},{to}H{right}");
    html! { path.frame-line d=(d) {} }
}

fn in_words(history: &History) -> String {
    let certificates = history.certificates.iter().map(|at| {
        format!("certificate {} measured on {}", at.stand.certificate.number, at.stand.certificate.measured())
    });
    let passports = history.passports.iter().map(|at| {
        let expires = at.expires_at.map_or_else(String::new, |end| format!(", expires {end}"));
        let ended = at.ended_at.map_or_else(|| format!("in force{expires}"), |end| format!("until {end}"));
        format!("passport {} from {}, {ended}", at.row.id, at.row.issued_at)
    });
    let drifts = history.drift.series.iter().filter_map(|series| {
        let fitted = series.line.as_ref()?;
        let (name, index) = (ANGLE_SYMBOLS[series.angle], series.index);
        Some(format!("{name} {index} {:+.3} arcsec per year, u = {:.3}", fitted.slope, fitted.u_slope))
    });
    let all: Vec<String> = certificates
        .chain(passports)
        .chain(drifts)
        .chain([crate::report::history::in_english(&history.drift, ANGLE_SYMBOLS)])
        .collect();
    all.join("; ") + "."
}
