//! Checks of a verification in words. A page is made only if text, signature, content, signer and numbers pass, so
//! failures of these checks are never printed.

use super::PassportPage;
use crate::passport::place::Nearness;
use crate::passport::{Check, CheckName, Code, Dated};
use crate::report::page::language::{Language, Languages, Text};
use crate::report::page::number::Number;
use crate::report::page::parts::{Table, date_text, time_text};
use crate::report::page::texts::checks as texts;
use maud::{Markup, html};

/// Writes the verdict in large letters, and the time of the verification.
pub(crate) fn verdict(page: &PassportPage, languages: &Languages) -> Markup {
    let good = page.verification.valid();
    let when = if good { texts::ALL_PASSED } else { texts::GENUINE };
    html! {
        div.verdict.refused[!good] {
            p.headline { (languages.label_with(|language| headline(page, language))) }
            (languages.paragraph_with(|language| {
                html! { (when.filled(language, &[("time", &time_text(language, page.question.time))])) }
            }))
        }
    }
}

/// Returns "In force", or the reasons why the passport may not be used.
pub(crate) fn headline(page: &PassportPage, language: Language) -> String {
    let failed: Vec<&str> = failed(page).map(|check| reason(check.code).of(language)).collect();
    if failed.is_empty() {
        return texts::IN_FORCE.words(language);
    }
    format!("{}: {}", texts::NOT_TO_BE_USED.of(language), failed.join(", "))
}

fn failed<'a>(page: &'a PassportPage) -> impl Iterator<Item = &'a Check> {
    page.verification.checks().iter().filter(|check| check.code != Code::Ok)
}

fn reason(code: Code) -> Text {
    match code {
        Code::Expired => texts::EXPIRED,
        Code::NotYetValid => texts::NOT_YET,
        Code::WrongStand => texts::ANOTHER_STAND,
        Code::WrongPlace => texts::ANOTHER_PLACE,
        Code::Superseded => texts::SUPERSEDED,
        Code::PassportRevoked => texts::WITHDRAWN,
        _ => texts::REFUSED,
    }
}

/// Writes every check with its result.
pub(crate) fn table(page: &PassportPage, languages: &Languages) -> Markup {
    let caption = languages
        .label_with(|language| texts::CAPTION.filled(language, &[("time", &time_text(language, page.question.time))]));
    let rows = page.verification.checks().iter().map(|check| {
        let result = match check.passed() {
            Some(true) => html! { span.passed { (languages.label(texts::PASSED)) } },
            Some(false) => html! { strong.failed { (languages.label(texts::FAILED)) } },
            None => languages.label(texts::NOT_RUN),
        };
        vec![languages.label(name(check.name)), result, languages.label_with(|language| words(page, check, language))]
    });
    let table = Table {
        caption: Some(caption),
        headings: [texts::CHECK, texts::RESULT, texts::FOUND].map(|text| languages.label(text)).into(),
        rows: rows.collect(),
        row_headings: 1,
        class: "checks",
        ..Table::default()
    };
    table.markup(languages.spoken(texts::CHECK))
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

fn words(page: &PassportPage, check: &Check, language: Language) -> String {
    let content = &page.content;
    let issuer = content.passport.issuer.as_str();
    let plain = |text: Text| text.words(language);
    match check.name {
        CheckName::Grammar => plain(texts::GRAMMAR_OK),
        CheckName::Signature => plain(texts::SIGNATURE_OK),
        CheckName::Schema => texts::SCHEMA_OK.filled(language, &[("format", &content.format)]),
        CheckName::Signer => texts::SIGNER_OK.filled(language, &[("issuer", issuer)]),
        CheckName::Recomputed => plain(texts::RECOMPUTED_OK),
        CheckName::Revocation => revocation(page, language),
        CheckName::InForce => validity(page, check.code, language),
        CheckName::Issuer => texts::ISSUER_OK.filled(language, &[("issuer", issuer)]),
        CheckName::Stand => stand(page, check.code, language),
        CheckName::Place => place(page, language),
        CheckName::Register if check.code == Code::Ok => plain(texts::REGISTER_OK),
        CheckName::Register if check.code == Code::RegisterUnknown => plain(texts::REGISTER_UNKNOWN),
        CheckName::Register => plain(texts::REGISTER_SUPERSEDED),
    }
}

fn revocation(page: &PassportPage, language: Language) -> String {
    let withdrawn = &page.trust.withdrawn;
    if let Some(entry) = withdrawn.entry(&page.sha256) {
        let time = time_text(language, entry.revoked_at);
        return texts::REVOCATION_WITHDRAWN.filled(language, &[("time", &time), ("reason", &entry.reason)]);
    }
    match withdrawn.newest() {
        Some(list) => {
            let (sequence, time) = (list.sequence.to_string(), time_text(language, list.issued_at));
            texts::REVOCATION_LIST.filled(language, &[("sequence", &sequence), ("time", &time)])
        }
        None if page.trust.revoked.is_empty() => texts::REVOCATION_NO_LIST.words(language),
        None => texts::REVOCATION_KEYS_ONLY.words(language),
    }
}

fn validity(page: &PassportPage, code: Code, language: Language) -> String {
    let last = page.content.last_day();
    let day = last.map(|(day, _)| date_text(language, day)).unwrap_or_default();
    let text = match (code, last) {
        (Code::NotYetValid, _) => {
            let time = time_text(language, page.content.passport.issued_at);
            return texts::VALIDITY_NOT_YET.filled(language, &[("time", &time)]);
        }
        (Code::Ok, None) => texts::VALIDITY_NO_END,
        (Code::Ok, Some(_)) => texts::VALIDITY_OK,
        (_, Some((_, Dated::Certificate))) => texts::VALIDITY_CERTIFICATE_EXPIRED,
        _ => texts::VALIDITY_EXPIRED,
    };
    text.filled(language, &[("day", &day)])
}

fn stand(page: &PassportPage, code: Code, language: Language) -> String {
    let text = if code == Code::Ok { texts::STAND_OK } else { texts::STAND_WRONG };
    let asked = page.question.serial.as_deref().unwrap_or_default();
    text.filled(language, &[("serial", page.content.stand.serial.as_str()), ("asked", asked)])
}

fn place(page: &PassportPage, language: Language) -> String {
    let Some(place) = page.question.place else { return String::new() };
    let nearness = Nearness::of(&page.content, place);
    let text = if nearness.within() { texts::PLACE_OK } else { texts::PLACE_WRONG };
    let [distance, radius] =
        [nearness.distance_m, nearness.radius_m].map(|metres| Number::fixed(metres, 0).text(language));
    text.filled(language, &[("distance", &distance), ("radius", &radius)])
}
