//! Checks of a verification in words. A page is made only if text, signature, content, signer and numbers pass, so
//! failures of these checks are never printed.

use super::PassportPage;
use crate::passport::place::Nearness;
use crate::passport::{Check, CheckName, Code, Dated};
use crate::report::page::language::{Language, Languages, Text, values};
use crate::report::page::number::Number;
use crate::report::page::parts::{Table, boxed, marked, time_text};
use crate::report::page::spacing::BLANK;
use crate::report::page::texts::{checks as texts, units};
use crate::wording::date_text;
use maud::{Markup, html};

fn word(passed: Option<bool>) -> Text {
    match passed {
        Some(true) => texts::PASSED,
        None => texts::NOT_ASKED,
        Some(false) => texts::FAILED,
    }
}

/// Returns `true` if nothing shows whether the passport has been withdrawn.
pub(crate) fn withdrawal_not_checked(page: &PassportPage) -> bool {
    page.verification.code(CheckName::Revocation) == Some(Code::NotAsked)
}

/// Writes every check as a mark with its name, and the number of checks with each result.
pub(crate) fn line(page: &PassportPage, languages: &Languages) -> Markup {
    let checks = page.verification.checks();
    let count = |result| checks.iter().filter(|check| check.passed() == result).count();
    let counted = |language: Language| {
        let [passed, not_asked, failed] = [Some(true), None, Some(false)].map(count);
        let text = if failed == 0 { texts::COUNTED } else { texts::COUNTED_FAILED };
        let time = time_text(language, page.question.time);
        text.filled(language, values! { time, passed, not_asked, failed })
    };
    html! {
        (languages.paragraph_with(|language| html! { (counted(language)) }))
        ul.marks {
            @for check in checks {
                li {
                    (marked(check.passed(), &languages.inline(name(check.name))))
                    span.unseen { ": " (languages.spoken(word(check.passed()))) }
                }
            }
        }
    }
}

/// Writes why the passport may not be used, in large letters; nothing if it may.
pub(crate) fn refusal(page: &PassportPage, languages: &Languages) -> Markup {
    if page.verification.valid() {
        return html! {};
    }
    let time = |language| texts::GENUINE.filled(language, values! { time: time_text(language, page.question.time) });
    let why = html! {
        p { (languages.label_with(time)) }
        ul { @for check in failed(page) { li { (languages.label_with(|language| words(page, check, language))) } } }
    };
    let headline = languages.label_with(|language| headline(page, language));
    boxed("verdict refused", marked(Some(false), &headline), why)
}

/// Returns "In force", or the reasons why the passport may not be used.
pub(crate) fn headline(page: &PassportPage, language: Language) -> String {
    let failed: Vec<String> = failed(page).map(|check| reason(check.code).words(language)).collect();
    if failed.is_empty() {
        return texts::IN_FORCE.words(language);
    }
    format!("{}: {}", texts::NOT_TO_BE_USED.words(language), failed.join(", "))
}

/// Returns the warning for the head of every sheet, empty for a valid passport; in two languages it has no room for reasons.
pub(crate) fn warning(page: &PassportPage, languages: &Languages) -> String {
    match (page.verification.valid(), languages.single()) {
        (true, _) => String::new(),
        (false, true) => headline(page, languages.first()),
        (false, false) => languages.plain(texts::NOT_TO_BE_USED),
    }
}

fn failed<'a>(page: &'a PassportPage) -> impl Iterator<Item = &'a Check> {
    page.verification.checks().iter().filter(|check| check.passed() == Some(false))
}

fn reason(code: Code) -> Text {
    match code {
        Code::Expired => texts::EXPIRED,
        Code::NotYetValid => texts::NOT_YET,
        Code::WrongStand => texts::ANOTHER_STAND,
        Code::WrongPlace => texts::ANOTHER_PLACE,
        Code::Superseded => texts::SUPERSEDED,
        Code::Moved => texts::MOVED,
        Code::Withdrawn => texts::WITHDRAWN,
        _ => texts::REFUSED,
    }
}

/// Writes every check with its result; those that were not asked have one row.
pub(crate) fn table(page: &PassportPage, languages: &Languages) -> Markup {
    let caption = languages.label_with(|language| {
        texts::CAPTION.filled(language, values! { time: time_text(language, page.question.time) })
    });
    let named = |passed| marked(passed, &languages.label(word(passed)));
    let (not_asked, asked): (Vec<&Check>, Vec<_>) =
        page.verification.checks().iter().partition(|check| check.passed().is_none());
    let row = |check: &Check| {
        let words = languages.label_with(|language| words(page, check, language));
        vec![languages.label(name(check.name)), named(check.passed()), words]
    };
    let mut rows: Vec<_> = asked.into_iter().map(row).collect();
    if !not_asked.is_empty() {
        let joined = |of: fn(CheckName) -> Text, between| {
            // Only the first name of a list has its capital letter.
            let words = |language| {
                let words = not_asked.iter().map(|check| of(check.name).words(language)).enumerate();
                words.map(|(place, words)| if place == 0 { words } else { words.to_lowercase() }).collect::<Vec<_>>()
            };
            languages.label_with(|language| words(language).join(between))
        };
        rows.push(vec![joined(name, ", "), marked(None, &languages.label(texts::NOT_ASKED)), joined(absent, "; ")]);
    }
    let table = Table {
        headings: [texts::CHECK, texts::RESULT, texts::FOUND].map(|text| languages.label(text)).into(),
        rows,
        row_headings: 1,
        class: "checks",
        ..Table::default()
    };
    // Not a caption, which some browsers part from its table in print.
    html! { p.caption { (caption) } (table.markup(languages.spoken(texts::CHECK))) }
}

fn name(check: CheckName) -> Text {
    match check {
        CheckName::Grammar => texts::GRAMMAR,
        CheckName::Signature => texts::SIGNATURE,
        CheckName::Schema => texts::SCHEMA,
        CheckName::Signer => texts::SIGNER,
        CheckName::Revocation => texts::REVOCATION,
        CheckName::Recomputed => texts::RECOMPUTED,
        CheckName::InForce => texts::VALIDITY,
        CheckName::Issuer => texts::ISSUER,
        CheckName::Stand => texts::STAND,
        CheckName::Place => texts::PLACE,
        CheckName::Register => texts::REGISTER,
    }
}

/// Returns what was not given for a check that was not asked.
fn absent(check: CheckName) -> Text {
    match check {
        CheckName::Revocation => texts::REVOCATION_NO_LIST,
        CheckName::Issuer => texts::ISSUER_NOT_ASKED,
        CheckName::Stand => texts::STAND_NOT_ASKED,
        CheckName::Place => texts::PLACE_NOT_ASKED,
        CheckName::Register => texts::REGISTER_NOT_ASKED,
        _ => texts::NOT_RUN,
    }
}

fn words(page: &PassportPage, check: &Check, language: Language) -> String {
    let content = &page.content;
    let issuer = content.passport.issuer.as_str();
    let plain = |text: Text| text.words(language);
    match check.name {
        CheckName::Grammar => plain(texts::GRAMMAR_OK),
        CheckName::Signature => plain(texts::SIGNATURE_OK),
        CheckName::Schema => texts::SCHEMA_OK.filled(language, values! { format: content.format }),
        CheckName::Signer => texts::SIGNER_OK.filled(language, values! { issuer }),
        CheckName::Recomputed => plain(texts::RECOMPUTED_OK),
        CheckName::Revocation => plain(texts::REVOCATION_OK),
        CheckName::InForce => validity(page, check.code, language),
        CheckName::Issuer => texts::ISSUER_OK.filled(language, values! { issuer }),
        CheckName::Stand => stand(page, check.code, language),
        CheckName::Place => place(page, language),
        CheckName::Register => register(page, check.code, language),
    }
}

/// Returns what the register says, with its number, time, SHA-256 and freshness.
fn register(page: &PassportPage, code: Code, language: Language) -> String {
    let text = match code {
        Code::Ok => texts::REGISTER_OK,
        Code::Superseded => texts::REGISTER_SUPERSEDED,
        Code::Moved => texts::REGISTER_MOVED,
        Code::Withdrawn => texts::REGISTER_WITHDRAWN,
        Code::NotListed => texts::REGISTER_NOT_LISTED,
        Code::RegisterStale => texts::REGISTER_STALE,
        Code::RegisterOlder => texts::REGISTER_OLDER,
        Code::RegisterContradicted => texts::REGISTER_CONTRADICTED,
        _ => texts::REGISTER_UNKNOWN,
    };
    let Some(used) = page.verification.register() else { return text.words(language) };
    let time = time_text(language, used.issued_at);
    let fresh = used.fresh_until.map_or_else(String::new, |last| {
        texts::REGISTER_FRESH.filled(language, values! { day: date_text(language, last) })
    });
    let sha256 = &used.sha256[..16];
    let used = texts::REGISTER_USED.filled(language, values! { sequence: used.sequence, time, sha256, fresh });
    format!("{}; {used}", text.words(language))
}

fn validity(page: &PassportPage, code: Code, language: Language) -> String {
    let last = page.content.last_day();
    let day = last.map(|(day, _)| date_text(language, day)).unwrap_or_default();
    let text = match (code, last) {
        (Code::NotYetValid, _) => {
            let time = time_text(language, page.content.passport.issued_at);
            return texts::VALIDITY_NOT_YET.filled(language, values! { time });
        }
        (Code::Ok, None) => texts::VALIDITY_NO_END,
        (Code::Ok, Some(_)) => texts::VALIDITY_OK,
        (_, Some((_, Dated::Certificate))) => texts::VALIDITY_CERTIFICATE_EXPIRED,
        _ => texts::VALIDITY_EXPIRED,
    };
    text.filled(language, values! { day })
}

fn stand(page: &PassportPage, code: Code, language: Language) -> String {
    let text = if code == Code::Ok { texts::STAND_OK } else { texts::STAND_WRONG };
    let asked = page.question.serial.as_deref().unwrap_or_default();
    text.filled(language, values! { serial: page.content.stand.serial, asked })
}

fn place(page: &PassportPage, language: Language) -> String {
    let Some(place) = page.question.place else { return String::new() };
    let nearness = Nearness::of(&page.content, place);
    let text = if nearness.within() { texts::PLACE_OK } else { texts::PLACE_WRONG };
    let [distance, radius] = [nearness.distance_m, nearness.radius_m].map(|metres| length(metres, language));
    text.filled(language, values! { distance, radius })
}

/// Returns a length in metres, or in kilometres above 10 km.
fn length(metres: f64, language: Language) -> String {
    let (value, unit) = if metres < 1e4 { (metres, units::METRES) } else { (metres / 1000.0, units::KILOMETRES) };
    format!("{}{BLANK}{}", Number::fixed(value, 0).text(language), unit.words(language))
}
