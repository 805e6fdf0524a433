//! History of a stand: its certificates and passports in order, and the drift of each deviation; and as JSON.

use crate::attitude::{ANGLE_SYMBOLS, ANGLES};
use crate::calibration::document::finite;
use crate::certification::found::{self, Found, Scope, together};
use crate::certification::kind::{Kind, Part};
use crate::history::drift::{CommonJump, DRIFTS, Drift, Jump, SUSPECTED, Series, Value};
use crate::history::{History, PastCertificate, PastPassport};
use crate::report::columns::decimals;
use crate::report::doc::{Block, Rows, Words, given, heading, line, marked, probability, say, strong, symbol};
use crate::report::register::state;
use crate::wording::number::Probability;
use crate::wording::texts::history as texts;
use crate::wording::{Language, Number, Outcome, Text, plain};
use jiff::Timestamp;
use jiff::civil::Date;
use jiff::tz::TimeZone;
use nalgebra::Vector3;
use serde_json::json;
use std::collections::BTreeSet;

/// Returns the history as JSON: `{stand, certificates, passports, places, withdrawals, drift, remarks, findings}`.
pub(crate) fn to_json(history: &History) -> serde_json::Value {
    json!({
        "stand": history.stand,
        "certificates": history.certificates.iter().map(certificate_json).collect::<Vec<_>>(),
        "passports": history.passports.iter().map(passport_json).collect::<Vec<_>>(),
        "places": history.places,
        "withdrawals": history.withdrawals().into_iter().map(|row| {
            json!({"id": row.id, "sha256": row.sha256, "revoked_at": row.since, "reason": row.reason})
        }).collect::<Vec<_>>(),
        "drift": drift_json(&history.drift),
        "remarks": history.remarks,
        "findings": found::to_json(&findings(&history.drift)),
    })
}

/// Returns what has changed: rotations of the whole, then the positions that jumped, drift, or may drift.
pub(crate) fn findings(drift: &Drift) -> Vec<Found> {
    let common = drift.common.iter().map(|jump| {
        let (part, turns) = largest_part(jump);
        let scope = Scope { part: Some(part.key()), certificates: jump.certificates.to_vec(), ..Scope::default() };
        let words = Words::Capital(Box::new(vec![rotated(jump), ".".into()].into()));
        Found::new(Kind::CommonTurn, scope, jump.probability, words).sized(Vector3::from(turns).norm())
    });
    let of_series = |series: &Series, tests: usize| {
        let scope = Scope { position: Some(series.index), angle: Some(ANGLES[series.angle]), ..Scope::default() };
        let is_jump = series.line.is_none_or(|line| line.degrees_of_freedom == 0);
        let (what, probability) = change(series);
        let words = vec![name(ANGLES, series), " ".into(), what, ", ".into()];
        let words = words.into_iter().chain([texts::by_chance(Probability(probability), tests), ".".into()]);
        let tested: Vec<&Value> = series.tested_values().collect();
        let ends = tested.first().zip(tested.last()).map(|(a, b)| [a, b].map(|at| at.certificate.clone()));
        let (kind, size, certificates) = match (&series.jump, series.change()) {
            (Some(jump), _) => (Kind::PositionJump, jump.change_arcsec, jump.certificates.to_vec()),
            (_, Some((change, _))) if is_jump => (Kind::PositionJump, change, ends.into_iter().flatten().collect()),
            _ => (Kind::PositionDrift, series.line.map_or(0.0, |line| line.slope), Vec::new()),
        };
        let found =
            Found::new(kind, Scope { certificates, ..scope }, probability, words.collect::<Vec<_>>()).sized(size);
        if kind == Kind::PositionDrift { Found { unit: Some("arcsec/year"), ..found } } else { found }
    };
    let own = drift.series.iter().map(|series| (series, drift.tested()));
    let hidden = drift.hidden_change().map(|series| (series, drift.relative.len()));
    let mut changed: Vec<Found> = own.chain(hidden).map(|(series, tests)| of_series(series, tests)).collect();
    changed.retain(|found| found.probability < SUSPECTED);
    // Of the angles of a position, the one of which chance explains least.
    changed.sort_by(|a, b| a.probability.total_cmp(&b.probability));
    let mut known = BTreeSet::new();
    changed.retain(|found| known.insert(found.scope.position));
    common.chain(changed).collect()
}

/// Returns the part of the stand that has rotated most between two certificates, with its rotation, arcsec.
fn largest_part(jump: &CommonJump) -> (Part, [f64; 3]) {
    let turn = jump.turn;
    let is_base = Vector3::from(turn.base_arcsec).norm() > Vector3::from(turn.platform_arcsec).norm();
    if is_base { (Part::Base, turn.base_arcsec) } else { (Part::Platform, turn.platform_arcsec) }
}

/// The sentence on a rotation of all positions together.
fn rotated(jump: &CommonJump) -> Words {
    let ([from, to], (part, turns)) = (&jump.certificates, largest_part(jump));
    let [x, y, z] = together(turns);
    texts::rotated(given(from), given(to), x, y, z, part.axes(), Probability(jump.probability))
}

fn passport_json(at: &PastPassport) -> serde_json::Value {
    let mut json = json!(at.row);
    json["issued_at"] = json!(at.row.issued_at);
    json["ended_at"] = json!(at.ended_at);
    json["predecessor"] = json!(at.predecessor);
    // That of the re-issue; that of a withdrawal is among the withdrawals.
    json["reason"] = json!(at.reason);
    json
}

fn certificate_json(at: &PastCertificate) -> serde_json::Value {
    let certificate = &at.stand.certificate;
    json!({
        "number": certificate.number,
        "issued": certificate.issued,
        "performed": certificate.performed,
        "valid_until": certificate.valid_until,
        "laboratory": certificate.laboratory,
        "runs": certificate.evidence.as_ref().map(|evidence| evidence.runs),
        "readings_sha256": certificate.evidence.as_ref().map(|evidence| &evidence.readings_sha256),
        "passports": at.passports,
        "withdrawn": !at.counts,
    })
}

fn drift_json(drift: &Drift) -> serde_json::Value {
    let worst = drift.most_significant();
    json!({
        "drifts": drift.drifts(),
        "tested": drift.tested(),
        "probability": worst.and_then(|series| series.corrected_probability),
        "detectable_arcsec_per_year": drift.detectable_arcsec_per_year(),
        "sentence": in_english(drift, ANGLES),
        "relative": drift.hidden_change().map(series_json),
        "deviations": drift.series.iter().map(series_json).collect::<Vec<_>>(),
    })
}

fn series_json(series: &Series) -> serde_json::Value {
    let line = series.line.as_ref();
    json!({
        "i": series.index.i, "j": series.index.j, "angle": ANGLES[series.angle],
        "values": series.values,
        "slope_arcsec_per_year": line.map(|line| line.slope),
        "u_slope_arcsec_per_year": line.map(|line| line.u_slope),
        "degrees_of_freedom": line.and_then(|line| finite(line.slope_degrees_of_freedom)),
        "probability": line.map(|line| line.probability()),
        "corrected_probability": series.corrected_probability,
        "chi_square": line.or(series.jump.as_ref().map(|jump| &jump.line)).map(|line| {
            json!({"value": line.chi_square, "degrees_of_freedom": line.degrees_of_freedom})
        }),
        "jump": series.jump,
    })
}

/// Returns the result of the test for drift in English, with the given names of the angles α, β, γ.
pub(crate) fn in_english(drift: &Drift, angles: [&str; 3]) -> String {
    plain(&sentence(drift, angles).plain(Language::English))
}

/// Returns the result of the test for drift, with the given names of the angles α, β, γ, without a full stop.
fn sentence(drift: &Drift, angles: [&str; 3]) -> Words {
    let of_each = match drift.worst_jump() {
        Some((series, jump)) if drift.most_significant().is_none() => jumped(drift, angles, series, jump),
        Some((series, jump)) => texts::and_others(jumped(drift, angles, series, jump), of_lines(drift, angles)),
        None => of_lines(drift, angles),
    };
    let of_each = match drift.hidden_change() {
        Some(series) => texts::but(of_each, relative(drift, angles, series)),
        None => of_each,
    };
    drift.common.iter().rev().fold(of_each, |others, jump| texts::without_rotation(rotated(jump), others))
}

/// A change or a rate with its standard uncertainty.
fn measured(words: fn(Number, Number) -> Words, value: f64, u: f64) -> Words {
    words(change_of(value, u), Number::fixed(u, decimals(u)))
}

fn change_of(value: f64, u: f64) -> Number {
    Number::fixed(value, decimals(u)).signed()
}

fn name(angles: [&str; 3], series: &Series) -> Words {
    texts::angle_of(angles[series.angle], series.index)
}

/// What has happened to a deviation, with its probability.
fn change(series: &Series) -> (Words, f64) {
    match (&series.jump, &series.line) {
        (Some(Jump { certificates: [from, to], change_arcsec, u_arcsec, corrected_probability, .. }), _) => {
            let change = measured(texts::change_of, *change_arcsec, *u_arcsec);
            (texts::has_jumped(change, given(from), given(to)), *corrected_probability)
        }
        (None, line) => {
            let (slope, u) = line.map_or((0.0, 0.0), |line| (line.slope, line.u_slope));
            let rate = measured(texts::rate_of, slope, u);
            (texts::drifts_by(rate), series.corrected_probability.unwrap_or(1.0))
        }
    }
}

/// The sentence on a change of one deviation that the parts common to all positions hide.
fn relative(drift: &Drift, angles: [&str; 3], series: &Series) -> Words {
    let (what, probability) = change(series);
    let by_chance = texts::by_chance(Probability(probability), drift.relative.len());
    texts::hidden(name(angles, series), what, by_chance)
}

/// The sentence on the deviations that are not on a line.
fn jumped(drift: &Drift, angles: [&str; 3], series: &Series, jump: &Jump) -> Words {
    let [from, to] = &jump.certificates;
    texts::the_stand_jumped(
        drift.jumps().count(),
        drift.tested(),
        name(angles, series),
        measured(texts::change_of, jump.change_arcsec, jump.u_arcsec),
        given(from),
        given(to),
        Number::fixed(jump.line.chi_square, 1),
        jump.line.degrees_of_freedom,
        texts::by_chance(Probability(jump.corrected_probability), drift.tested()),
    )
}

/// The result of the test for drift of the deviations that are on a line.
fn of_lines(drift: &Drift, angles: [&str; 3]) -> Words {
    let tested = drift.most_significant().and_then(|worst| Some((worst, worst.corrected_probability?)));
    let Some((worst, probability)) = tested else { return texts::NEEDS_TWO.into() };
    let (name, tested) = (name(angles, worst), drift.tested());
    let by_chance = texts::by_chance(Probability(probability), tested);
    let rate = worst.line.map_or_else(|| "".into(), |line| measured(texts::rate_of, line.slope, line.u_slope));
    let drifting = drift.series.iter().filter(|at| at.corrected_probability.is_some_and(|p| p < DRIFTS)).count();
    let between_two = worst.line.filter(|line| line.degrees_of_freedom == 0).and_then(|_| worst.change());
    if let Some((change, u)) = between_two.filter(|_| probability < DRIFTS) {
        texts::the_stand_changed(drifting, tested, name, measured(texts::change_of, change, u), by_chance)
    } else if probability < DRIFTS {
        texts::the_stand_drifts(drifting, tested, name, rate, by_chance)
    } else if probability < SUSPECTED {
        texts::is_suspected(name, rate, by_chance)
    } else {
        let smallest = drift.detectable_arcsec_per_year();
        let found = smallest.map_or_else(|| "".into(), |rate| texts::detectable(Number::scientific(rate, 2)));
        texts::none_found(name, rate, by_chance, found)
    }
}

/// Returns the answer, the time line, the sites, and the drift of each deviation.
pub(crate) fn document(history: &History) -> Vec<Block> {
    let [certificates, passports, sites, withdrawals] =
        [history.certificates.len(), history.passports.len(), history.sites().len(), history.withdrawals().len()];
    let counts = texts::counts(certificates, passports, sites, withdrawals);
    let first = vec![answer(&history.drift), "  ".into(), strong(history.stand.as_str()), ": ".into(), counts];
    let sentence = Words::Capital(Box::new(sentence(&history.drift, ANGLE_SYMBOLS)));
    let stays = history.places.iter().map(|stay| {
        let from = day(stay.from);
        let time = stay.until.map_or_else(|| texts::from(from), |until| texts::from_to(from, day(until)));
        vec![time, given(&stay.site)]
    });
    let mut doc = vec![
        line(first),
        say([vec![sentence, ".".into()]]),
        Block::Gap,
        Block::Lines("  ", time_line(history)),
        heading(texts::SITES),
        Block::Lines("  ", stays.collect()),
    ];
    doc.extend(drift(&history.drift));
    doc.extend(history.remarks.iter().map(|remark| line(texts::remark(given(remark)))));
    doc
}

/// The result of the test for drift in a word.
fn answer(drift: &Drift) -> Words {
    let least = drift.most_significant().and_then(|worst| worst.corrected_probability);
    let (outcome, word) = match drift.drifts() {
        None => (Outcome::NotAsked, texts::NOT_TESTED),
        Some(true)
            if drift.common.is_empty() && drift.jumps().next().is_none() && drift.series.iter().any(is_steady) =>
        {
            (Outcome::Failed, texts::DRIFTS)
        }
        Some(_) if drift.has_changed() => (Outcome::Failed, texts::CHANGED),
        Some(_) if least.is_some_and(|p| p < SUSPECTED) => (Outcome::Undecided, texts::SUSPECTED),
        Some(_) => (Outcome::Passed, texts::NO_DRIFT),
    };
    marked(outcome, word)
}

/// Returns `true` if more than two certificates show a drift of a deviation; two do not show whether it is a jump.
fn is_steady(series: &Series) -> bool {
    series.is_drift() && series.line.as_ref().is_some_and(|line| line.degrees_of_freedom > 0)
}

/// Returns the date of an instant, in UTC.
fn day(time: Timestamp) -> Date {
    time.to_zoned(TimeZone::UTC).date()
}

/// The events in the order of time: date, kind, words.
fn time_line(history: &History) -> Vec<Vec<Words>> {
    let mut events: Vec<(Option<Date>, Text, Words)> = Vec::new();
    for at in &history.certificates {
        let certificate = &at.stand.certificate;
        let runs = certificate.evidence.as_ref().map_or_else(|| "".into(), |evidence| texts::runs(evidence.runs));
        let withdrawn = if at.counts { "".into() } else { Words::from(texts::ALL_WITHDRAWN) };
        let (number, laboratory) = (given(&certificate.number), given(&certificate.laboratory));
        let words = texts::certificate(number, laboratory, runs, certificate.issued, withdrawn);
        let kind = if certificate.performed.is_some() { texts::MEASURED } else { texts::CERTIFIED };
        events.push((Some(certificate.measured()), kind, words));
    }
    for passport in &history.passports {
        events.push((Some(day(passport.row.issued_at)), texts::ISSUED, issued(passport)));
    }
    for row in history.withdrawals() {
        let words = vec![given(&row.id), ": ".into(), given(row.reason.as_deref().unwrap_or_default())];
        events.push((row.since.map(day), texts::WITHDRAWN, words.into()));
    }
    // The sort is stable: on one day the measurement comes before the passports, and these before a withdrawal.
    events.sort_by_key(|(day, ..)| *day);
    let cells = |(day, kind, words): (Option<Date>, Text, Words)| {
        vec![day.map_or_else(|| "".into(), Words::Date), kind.into(), words]
    };
    events.into_iter().map(cells).collect()
}

fn issued(passport: &PastPassport) -> Words {
    let row = &passport.row;
    let reissued = match (&passport.predecessor, &passport.reason) {
        (Some(from), Some(reason)) => texts::reissued(given(from), given(reason)),
        _ => "".into(),
    };
    let until = row.valid_until.filter(|_| row.is_in_force()).map_or_else(|| "".into(), texts::valid_until);
    texts::passport(given(&row.id), given(&row.certificate), state(row), until, reissued)
}

/// The drift of each tested deviation. One that has jumped has no rate.
fn drift(drift: &Drift) -> Vec<Block> {
    let tested: Vec<&Series> =
        drift.series.iter().filter(|series| series.jump.is_some() || series.line.is_some()).collect();
    if tested.is_empty() {
        return Vec::new();
    }
    let line = |series: &&Series| series.line.filter(|_| series.jump.is_none());
    let corrected = |series: &&Series| series.corrected_probability.filter(|_| series.jump.is_none());
    let mark = |series: &&Series| match corrected(series) {
        _ if series.jump.is_some() => marked(Outcome::Failed, texts::JUMP),
        Some(p) if p < DRIFTS => {
            marked(Outcome::Failed, if is_steady(series) { texts::DRIFTS } else { texts::CHANGED })
        }
        Some(p) if p < SUSPECTED => marked(Outcome::Undecided, texts::MAY_DRIFT),
        _ => "".into(),
    };
    let table = Rows::of(&tested, "numbers")
        .named(symbol("i"), |series| series.index.i)
        .named(symbol("j"), |series| series.index.j)
        .named(texts::ANGLE, |series| symbol(ANGLE_SYMBOLS[series.angle]))
        .column(texts::VALUES, |series| series.tested_values().count())
        .column(texts::CHANGE, |series| series.change().map(|(change, u)| change_of(change, u)))
        .column(texts::RATE, |series| line(series).map(|line| change_of(line.slope, line.u_slope)))
        .column(symbol("u"), |series| line(series).map(|line| Number::fixed(line.u_slope, decimals(line.u_slope))))
        .column(texts::PROBABILITY, |series| line(series).map(|line| probability(line.probability())))
        .column(texts::CORRECTED, |series| corrected(series).map(probability))
        .column("", mark);
    vec![heading(texts::DRIFT), table.called(texts::DRIFT)]
}
