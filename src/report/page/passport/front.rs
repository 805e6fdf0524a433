//! First page: what the passport is for, until when it is in force, where, on whose word, and how to check it.

use super::{PassportPage, checks};
use crate::report::doc;
use crate::report::page::code;
use crate::report::page::language::{Language, Languages, Text};
use crate::report::page::number::{LATITUDES, LONGITUDES, Number};
use crate::report::page::parts::{band, coordinate, date, figure, given, marked, quantity, signature};
use crate::report::passport::{deviations, general};
use crate::report::picture::stand::stand as picture;
use crate::wording::date_text;
use crate::wording::texts::{checks as check_texts, passport as texts, record, units};
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
            (doc::blocks(&[checks::table(page)], languages))
            (doc::blocks(&general::of_the_passport(&page.content.passport, Some(&page.key)), languages))
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
            p { (languages.label_with(|language| texts::period(date_text(language, day)).plain(language))) }
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
    let u =
        deviations::expanded_range(content).map_or_else(|| texts::WITHOUT_UNCERTAINTY.into(), texts::expanded_of_each);
    let word = html! {
        p { (given(&certificate.laboratory)) }
        p { (u.label(languages)) }
    };
    let radius = quantity(languages, &Number::fixed(content.earth.valid_radius_m, 0), units::METRES);
    band(
        languages,
        [
            (texts::STATUS, status, until),
            // Below "Not to be used", "use within" would contradict.
            (if valid { texts::WHERE } else { texts::RADIUS }, radius, place),
            (texts::WORD, given(&certificate.number), word),
            (
                texts::CHECKING,
                html! { "SHA-256" },
                html! { p.sha256 { code { (page.sha256) } } p { (languages.label(texts::CHECKING_HOW)) } },
            ),
        ],
    )
}

/// Writes the SHA-256 as a QR code, next to the fields for signature and stamp.
fn proof(page: &PassportPage, languages: &Languages) -> Markup {
    html! {
        div.proof {
            @if let Some(picture) = code::picture(&page.sha256, languages.spoken(texts::CODE)) { (picture) }
            (signature(languages, record::ISSUED_BY))
        }
    }
}
