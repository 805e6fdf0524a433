//! First page: what the passport is for, until when it is in force, where, on whose word, and how to check it.

use super::PassportPage;
use super::checks::{refusal, table, withdrawal_not_checked};
use crate::report::doc::{self, Block, Words, given, marked, note, told};
use crate::report::page::code;
use crate::report::page::language::{Languages, Text};
use crate::report::page::number::{LATITUDES, LONGITUDES, Number};
use crate::report::page::parts::{self, signature};
use crate::report::passport::{deviations, general};
use crate::report::picture::stand::stand as picture;
use crate::wording::texts::{checks, passport as texts, record, units};
use maud::{Markup, html};

/// Writes the head of the page: kind of the document, the stand, and the id.
pub(super) fn title(page: &PassportPage, languages: &Languages) -> Markup {
    let stand = &page.content.stand;
    let name = stand.name.as_deref().map_or_else(|| languages.inline(record::TEST_STAND), parts::given);
    html! {
        header.title {
            p.kind { (languages.label(texts::TITLE)) }
            h1 { (name) " " (parts::given(stand.model.as_str())) " №\u{a0}" (parts::given(stand.serial.as_str())) }
            p.subject { (parts::given(&page.content.passport.id)) }
        }
    }
}

/// Writes the first page; `contents` stands below the answers, which come first on a telephone too.
pub(super) fn section(page: &PassportPage, languages: &Languages, contents: &Markup) -> Markup {
    let heading = "verification-heading";
    html! {
        section id="verification" aria-labelledby=(heading) {
            h2.unseen id=(heading) { (languages.label(texts::FRONT)) }
            (languages.blocks(&refusal(page).into_iter().chain([answers(page)]).collect::<Vec<_>>()))
            (contents)
            div.front {
                (languages.figure("stand", &picture(languages, page.content.site.frame_axis_azimuth_deg()), texts::FIGURE_STAND))
                (proof(page, languages))
                div.note { (languages.paragraph(texts::PAPER_IS_NOT_SIGNED)) }
            }
            (languages.blocks(&[table(page)]))
            (languages.blocks(&general::of_the_passport(&page.content.passport, Some(&page.key))))
        }
    }
}

/// The four answers on the front of a passport: its validity, its site, its certificate, and how to check the file.
fn answers(page: &PassportPage) -> Block {
    let content = &page.content;
    let (site, certificate) = (&content.site, &content.certificate);
    let valid = page.verification.valid();
    let status = match valid {
        true => {
            Words::Styled("headline", Box::new(marked(Some(true), Words::First(Box::new(checks::IN_FORCE.into())))))
        }
        false => Words::Styled("failed", Box::new(marked(Some(false), checks::NOT_TO_BE_USED))),
    };
    // A second language begins with the status, which the large words do not say in it.
    let then = |rest: Text, before: Vec<Words>| {
        let before = [checks::IN_FORCE.into()].into_iter().chain(before).collect::<Vec<_>>();
        note(Words::Whole(Box::new(Words::All(vec![Words::Others(Box::new(before.into())), rest.into()]))))
    };
    let unchecked = valid && withdrawal_not_checked(page);
    let until = match content.last_day() {
        Some((day, _)) if valid => {
            let rest = if unchecked { texts::INCLUSIVE_NOT_CHECKED } else { texts::INCLUSIVE };
            let large = vec![Words::First(Box::new(texts::UNTIL.into())), " ".into(), day.into()];
            let until = vec![" ".into(), texts::UNTIL.into(), " ".into(), told(day), " ".into()];
            vec![Block::Note("large", large.into()), then(rest, until)]
        }
        // Below "Not to be used", "until" would say that it may be used later.
        Some((day, _)) => vec![note(told(texts::period(day)))],
        None if valid => {
            vec![then(if unchecked { texts::NO_END_NOT_CHECKED } else { texts::NO_END }, vec!["; ".into()])]
        }
        None => vec![note(texts::NO_END)],
    };
    let latitude = site.latitude_deg.or(site.astronomic_latitude_deg).unwrap_or(content.earth.latitude_deg);
    let around = if site.longitude_deg.is_some() { texts::AROUND } else { texts::AROUND_PARALLEL };
    let mut coordinates = vec![around.into(), " ".into(), Words::Coordinate(Number::exact(latitude), LATITUDES)];
    coordinates.extend(
        site.longitude_deg
            .into_iter()
            .flat_map(|longitude| [", ".into(), Words::Coordinate(Number::exact(longitude), LONGITUDES)]),
    );
    let place = vec![Block::Each(coordinates.into()), note(given(site.name.as_deref().unwrap_or(site.id.as_str())))];
    let u =
        deviations::expanded_range(content).map_or_else(|| texts::WITHOUT_UNCERTAINTY.into(), texts::expanded_of_each);
    let radius = Words::Quantity(Number::fixed(content.earth.valid_radius_m, 0), units::METRES);
    let sha256 = Block::Note("sha256", doc::code(&page.sha256));
    Block::Band(vec![
        (texts::STATUS, status, until),
        // Below "Not to be used", "use within" would contradict.
        (if valid { texts::WHERE } else { texts::RADIUS }, radius, place),
        (texts::WORD, given(&certificate.number), vec![note(given(&certificate.laboratory)), note(u)]),
        (texts::CHECKING, "SHA-256".into(), vec![sha256, note(texts::CHECKING_HOW)]),
    ])
}

/// Writes the SHA-256 as a QR code, next to the fields for signature and stamp.
fn proof(page: &PassportPage, languages: &Languages) -> Markup {
    html! {
        div.proof {
            @if let Some(picture) = code::picture(&page.sha256, languages.spoken(texts::CODE)) { (picture) }
            (languages.blocks(&[signature(record::ISSUED_BY)]))
        }
    }
}
