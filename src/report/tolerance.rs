//! Decisions on the tolerances of a gyro type as text.

use super::page::Number;
use super::page::language::{Language, Text, values};
use super::page::texts::calibration as texts;
use super::picture::tolerances::unit_of;
use super::style::Outcome;
use super::{columns, style};
use crate::calibration::verdict::COVERAGE_FACTOR;
use crate::calibration::{CalibrationDocument, Decision, Parameter, ParameterVerdict, Verdict};
use crate::text::printable;
use crate::units::quantity;
use std::fmt::Write;

/// Returns the outcome of a calibration with its word, and the reasons: which parameters pass, fail and are undecided by
/// their values and by their change, or why no statement is made.
pub(super) fn headline(document: &CalibrationDocument, gyro_type: Option<&str>) -> ((Outcome, String), String) {
    let judged = gyro_type.zip(document.verdict.as_ref());
    let because = |text: Text| text.of(Language::English).to_owned();
    let (outcome, word, mut words) = match judged {
        _ if document.hint.is_some() => (Outcome::Failed, "INVALID".to_owned(), because(texts::DOES_NOT_FIT)),
        _ if document.mistake.is_some() => (Outcome::Failed, "INVALID".to_owned(), because(texts::MISTAKE)),
        None => (Outcome::NotAsked, "CALIBRATED".to_owned(), because(texts::NO_TYPE_WORDS)),
        Some((_, verdict)) if verdict.withheld => {
            (Outcome::NotAsked, "CALIBRATED".to_owned(), because(texts::NOT_VERIFIED))
        }
        Some((name, verdict)) => {
            // Nothing is decided on a change that is not assessed.
            let worst = verdict.with_change(document.change.as_ref());
            let of_change = match document.change.as_ref() {
                Some(change) if change.withheld => ". Change since the previous calibration: not assessed".to_owned(),
                Some(change) => format!(". {}", counted(change, texts::CHANGE_PASSED)),
                None => String::new(),
            };
            let words = format!("gyro type {}: {}{of_change}", printable(name), counted(verdict, texts::PASSED));
            (worst.into(), word(Some(worst)).to_uppercase(), words)
        }
    };
    if let Some((name, _)) = judged.filter(|(_, verdict)| verdict.withheld) {
        words = format!("{words}. {}", texts::NO_STATEMENT.filled(Language::English, &[("type", &printable(name))]));
    }
    ((outcome, word), words)
}

/// Returns how many parameters pass by guarded acceptance, in the words of `passed`, and which are undecided or fail.
fn counted(verdict: &Verdict, passed: Text) -> String {
    let of = |decision: Decision| -> Vec<&str> {
        let rows = verdict.parameters.iter().filter(|row| row.guarded == decision);
        rows.map(|row| row.parameter.symbol()).collect()
    };
    let counts = values! { passed: of(Decision::Pass).len(), all: Parameter::EIGHT.len() };
    let mut words = passed.filled(Language::English, counts);
    for (what, which) in [("fail", of(Decision::Fail)), ("undecided", of(Decision::Undecided))] {
        if !which.is_empty() {
            let _ = write!(words, "; {what}: {}", which.join(", "));
        }
    }
    if let Some(not_found) = not_found(verdict) {
        let _ = write!(words, "; {not_found}");
    }
    words
}

/// Returns which parameters were not decided, because the general model does not have them.
fn not_found(verdict: &Verdict) -> Option<String> {
    let names: Vec<&str> = verdict.not_found().into_iter().map(Parameter::symbol).collect();
    let words = || texts::NOT_IN_THE_MODEL.filled(Language::English, &[("names", &names.join(", "))]);
    (!names.is_empty()).then(words)
}

/// Returns a decision with its mark, or that none was made.
pub(super) fn decided(decision: Option<Decision>) -> String {
    style::marked(Outcome::of(decision), word(decision))
}

fn word(decision: Option<Decision>) -> &'static str {
    match decision {
        Some(Decision::Pass) => "pass",
        Some(Decision::Fail) => "FAIL",
        Some(Decision::Undecided) => "undecided",
        None => "not assessed",
    }
}

/// Returns the coverage factor of several expanded uncertainties, or its range: 2, or that of Student's t for few degrees
/// of freedom.
pub(super) fn coverage_factor(factors: impl Iterator<Item = f64>, language: Language) -> String {
    let [least, most] = factors.fold([f64::INFINITY, 0.0], |[least, most], k| [k.min(least), k.max(most)]);
    let printed = |k: f64| Number::fixed(k, 2).text(language);
    match (printed(least), printed(most)) {
        (_, most) if most == printed(COVERAGE_FACTOR) => Number::fixed(COVERAGE_FACTOR, 0).text(language),
        (least, most) if least == most => texts::STUDENT.filled(language, values! { k: most }),
        (least, most) => texts::STUDENT.filled(language, values! { k: format!("{least}–{most}") }),
    }
}

/// Appends the lines of a verdict; `deviation` is the heading of the differences.
pub(super) fn verdict_table(out: &mut String, verdict: &Verdict, deviation: &str) {
    let rows = verdict.parameters.iter().map(|row| {
        let digits = columns::decimals(row.expanded_uncertainty);
        let places = columns::decimals(row.expanded_uncertainty_of_value());
        let mut cells = vec![
            row.parameter.symbol().to_owned(),
            format!("{:.places$}", row.value),
            columns::signed(row.deviation, digits),
            format!("{:.digits$}", row.expanded_uncertainty),
            format!("{} {}", row.tolerance, unit_of(row).of(Language::English)),
        ];
        if verdict.has_simple() {
            cells.extend([
                decided(Some(row.simple)),
                row.specific_risk.map_or_else(|| "–".to_owned(), columns::probability),
            ]);
        }
        cells.push(decided(verdict.decision(row)));
        cells
    });
    let mut names = vec!["", "result", deviation, "U", "tolerance", "simple", "risk", "guarded"];
    if !verdict.has_simple() {
        names.drain(5..7);
    }
    columns::table(out, &names, rows);
    let overall = (!verdict.withheld).then_some(verdict.overall);
    let words = style::marked(Outcome::of(overall), &word(overall).to_uppercase());
    let _ = writeln!(out, "  Overall, by guarded acceptance: {words}");
    let close = verdict.parameters.iter().any(ParameterVerdict::is_close) && !verdict.withheld;
    if close && verdict.overall == Decision::Undecided {
        columns::paragraph(out, "  ", "undecided: the uncertainty does not permit a decision.");
    }
    for (text, which) in [
        (texts::TOO_UNCERTAIN, verdict.too_uncertain()),
        (texts::OPPOSITE, verdict.opposite()),
        (texts::DEPENDENT, verdict.dependent()),
    ] {
        if !which.is_empty() && !verdict.withheld {
            let names = which.into_iter().map(Parameter::symbol).collect::<Vec<_>>().join(", ");
            columns::paragraph(out, "  ", &text.filled(Language::English, values! { names }));
        }
    }
    if let Some(not_found) = not_found(verdict) {
        columns::paragraph(out, "  ", &format!("{not_found}."));
    }
}

/// Returns how much the conversion from the local g changes the deviations of the drifts, and how much the local g adds to
/// their uncertainties, where that is most of them.
pub(super) fn from_gravity(verdict: &Verdict, u_m_per_s2: Option<f64>, without_height: bool) -> Vec<String> {
    let u = quantity(&columns::two_digits(u_m_per_s2.unwrap_or(0.0)), "m/s²");
    let part = |(row, part): (&ParameterVerdict, f64)| {
        let gravity = format!("{} {}", columns::two_digits(part), unit_of(row).of(Language::English));
        texts::FROM_GRAVITY_PART.filled(Language::English, values! { gravity, parameter: row.parameter.symbol() })
    };
    let each = gravity_contributes(without_height).into_iter().zip(verdict.parts_from_gravity());
    let said = each.filter(|(_, parts)| !parts.is_empty()).map(|(text, parts)| {
        let parts = parts.into_iter().map(part).collect::<Vec<_>>().join(", ");
        text.filled(Language::English, values! { parts, u })
    });
    said.collect()
}

/// Returns the sentences on the parts from converting g and from the uncertainty of local g: on normal gravity without a height,
/// what it assumes.
pub(super) fn gravity_contributes(without_height: bool) -> [Text; 2] {
    [texts::CONVERSION_OF_G, if without_height { texts::FROM_UNKNOWN_HEIGHT } else { texts::FROM_GRAVITY }]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coverage_factor_that_is_not_2_is_named() {
        let words = |factors: &[f64]| coverage_factor(factors.iter().copied(), Language::English);
        assert_eq!(words(&[2.0, 2.0]), "2");
        assert_eq!(words(&[2.43, 2.43]), "2.43, Student’s t");
        assert_eq!(words(&[2.0, 2.4463, 2.0]), "2.00–2.45, Student’s t");
        assert_eq!(coverage_factor([2.0, 2.4463].into_iter(), Language::Russian), "2,00–2,45, коэффициент Стьюдента");
    }
}
