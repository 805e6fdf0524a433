//! First page: what the passport is for, until when it is in force, where, on whose word, and how to check it.

use super::{PassportPage, checks};
use crate::report::page::code;
use crate::report::page::language::{Language, Languages, Text, values};
use crate::report::page::number::{LATITUDES, LONGITUDES, Number};
use crate::report::page::parts::{
    band, coordinate, date, fields, figure, given, marked, quantity, signature, stated, time, wide_stated,
};
use crate::report::page::texts::{checks as check_texts, passport as texts, record, units, words};
use crate::report::picture::stand::stand as picture;
use crate::wording::date_text;
use maud::{Markup, html};

/// Writes the head of the page: kind of the document, the stand, and the id.
pub(super) fn title(page: &PassportPage, languages: &Languages) -> Markup {
    let stand = &page.content.stand;
    let name = stand.name.as_deref().map_or_else(|| languages.inline(record::TEST_STAND), given);
    html! {
        header.title {
            p.kind { (languages.label(texts::TITLE)) }
            h1 { (name) " " (given(stand.model.as_str())) " №\u{a0}" (given(stand.serial.as_str())) }
            p.subject { (given(&page.content.passport.id)) }
        }
    }
}

/// Writes the first page; `contents` stands below the answers, which come first on a telephone too.
pub(super) fn section(page: &PassportPage, languages: &Languages, contents: &Markup) -> Markup {
    let heading = "verification-heading";
    html! {
        section id="verification" aria-labelledby=(heading) {
            h2.unseen id=(heading) { (languages.label(texts::FRONT)) }
            (checks::refusal(page, languages))
            (answers(page, languages))
            (contents)
            div.front {
                (figure(languages, "stand", &picture(languages, page.content.site.frame_axis_azimuth_deg()), texts::FIGURE_STAND))
                (proof(page, languages))
                div.note { (languages.paragraph(texts::PAPER_IS_NOT_SIGNED)) }
            }
            div.checked { (checks::line(page, languages)) }
            (signed(page, languages))
            (predecessor(page, languages))
        }
    }
}

/// Writes whether the passport is in force, where it may be used, on whose word, and how to check it.
fn answers(page: &PassportPage, languages: &Languages) -> Markup {
    let content = &page.content;
    let (site, certificate) = (&content.site, &content.certificate);
    let valid = page.verification.valid();
    let status = match valid {
        true => html! { p.headline { (marked(Some(true), &html! { (languages.spoken(check_texts::IN_FORCE)) })) } },
        false => html! { span.failed { (marked(Some(false), &languages.label(check_texts::NOT_TO_BE_USED))) } },
    };
    // A second language begins with the status, which the large words do not say in it.
    let then = |rest: Text, before: &dyn Fn(Language) -> String| {
        languages.label_with(|language| match language == languages.first() {
            true => rest.words(language),
            false => check_texts::IN_FORCE.words(language) + &before(language) + &rest.words(language),
        })
    };
    let unchecked = valid && checks::withdrawal_not_checked(page);
    let until = match content.last_day() {
        Some((day, _)) if valid => {
            let rest = if unchecked { texts::INCLUSIVE_NOT_CHECKED } else { texts::INCLUSIVE };
            let until = |language| format!(" {} {} ", texts::UNTIL.words(language), date_text(language, day));
            html! {
                p.large { (languages.spoken(texts::UNTIL)) " " (date(languages, day)) }
                p { (then(rest, &until)) }
            }
        }
        // Below "Not to be used", "until" would say that it may be used later.
        Some((day, _)) => html! {
            p { (languages.label_with(|language| texts::PERIOD.filled(language, values! { day: date_text(language, day) }))) }
        },
        None if valid => {
            let rest = if unchecked { texts::NO_END_NOT_CHECKED } else { texts::NO_END };
            html! { p { (then(rest, &|_| "; ".to_owned())) } }
        }
        None => html! { p { (languages.label(texts::NO_END)) } },
    };
    let latitude = site.latitude_deg.or(site.astronomic_latitude_deg).unwrap_or(content.earth.latitude_deg);
    let coordinates = |language: Language| {
        let one = Languages::from(language);
        let latitude = coordinate(&one, latitude, LATITUDES);
        let around = if site.longitude_deg.is_some() { texts::AROUND } else { texts::AROUND_PARALLEL };
        html! {
            (around.words(language)) " " (latitude)
            @if let Some(longitude) = site.longitude_deg { ", " (coordinate(&one, longitude, LONGITUDES)) }
        }
    };
    let place = html! {
        (languages.lines_with(coordinates))
        p { (given(site.name.as_deref().unwrap_or(site.id.as_str()))) }
    };
    let word = html! {
        p { (given(&certificate.laboratory)) }
        @if content.positions.iter().any(|at| at.u_alpha_arcsec.is_none()) {
            p { (languages.label(texts::WITHOUT_UNCERTAINTY)) }
        }
        p.name { (languages.label(texts::PASSPORT_ISSUER)) }
        p { (given(&content.passport.issuer)) }
    };
    let radius = quantity(languages, &Number::fixed(content.earth.valid_radius_m, 0), units::METRES);
    band(
        languages,
        [
            (texts::STATUS, status, until),
            // Below "Not to be used", "use within" would contradict.
            (if valid { texts::WHERE } else { texts::RADIUS }, radius, place),
            (texts::WORD, given(&certificate.number), word),
            (texts::CHECKING, html! { "SHA-256" }, html! { p { (languages.label(texts::CHECKING_HOW)) } }),
        ],
    )
}

/// Writes the SHA-256 as a QR code and as text, next to the fields for signature and stamp.
fn proof(page: &PassportPage, languages: &Languages) -> Markup {
    html! {
        div.proof {
            @if let Some(picture) = code::picture(&page.sha256, languages.spoken(texts::CODE)) { (picture) }
            (signature(languages, record::ISSUED_BY))
            div.sum {
                p.sum-name { (languages.label(texts::SHA256)) }
                p.sha256 { code { (page.sha256) } }
            }
        }
    }
}

fn signed(page: &PassportPage, languages: &Languages) -> Markup {
    let header = &page.content.passport;
    fields([
        stated(languages, texts::REVISION, Some(html! { (header.revision) })),
        stated(languages, texts::ISSUED, Some(time(languages, header.issued_at))),
        stated(languages, texts::VALID_UNTIL, header.valid_until.map(|day| date(languages, day))),
        stated(languages, texts::ISSUED_WITH, header.issued_with.as_deref().map(given)),
        wide_stated(languages, texts::KEY, Some(html! { code { (page.key.fingerprint()) } })),
    ])
}

fn predecessor(page: &PassportPage, languages: &Languages) -> Markup {
    let Some(old) = &page.content.passport.reissued_from else { return html! {} };
    let superseded = if page.content.passport.supersedes == Some(true) { words::YES } else { words::NO };
    fields([
        stated(languages, texts::REISSUED_FROM, Some(given(&old.id))),
        stated(languages, texts::REISSUE_SUPERSEDES, Some(languages.inline(superseded))),
        wide_stated(languages, texts::REISSUE_REASON, Some(given(&old.reason))),
        wide_stated(languages, texts::REISSUE_CHANGED, Some(given(&old.changed))),
        wide_stated(languages, texts::REISSUED_SHA256, Some(html! { code { (old.sha256) } })),
    ])
}
