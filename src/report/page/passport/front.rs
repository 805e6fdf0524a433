//! First page: what the passport is for, until when it is in force, where, on whose word, and how to check it.

use super::PassportPage;
use super::checks::{table, withdrawal_not_checked};
use crate::report::doc::{self, Block, Words, drawn, given, marked, note, say, told};
use crate::report::page::parts::{self, signature};
use crate::report::passport::{deviations, general};
use crate::report::picture::stand::stand as picture;
use crate::stand::Identity;
use crate::wording::number::{LATITUDES, LONGITUDES};
use crate::wording::texts::{checks, passport as texts, record, units};
use crate::wording::{Number, Text};

/// The name of the stand with its model and serial number.
pub(super) fn name_of_the_stand(stand: &Identity) -> Words {
    let name = stand.name.as_ref().map_or_else(|| Words::Inline(Box::new(record::TEST_STAND.into())), given);
    let [model, serial] = [stand.model.as_str(), stand.serial.as_str()].map(given);
    vec![name, " ".into(), model, " №\u{a0}".into(), serial].into()
}

/// The stand, the code of the file with the fields for signature and stamp, the checks, and the passport itself.
pub(super) fn below_the_answers(page: &PassportPage) -> Vec<Block> {
    let azimuth_deg = page.content.site.frame_axis_azimuth_deg();
    let stand = drawn(move |languages| {
        languages.figure("stand", &picture(languages, azimuth_deg), &texts::FIGURE_STAND.into())
    });
    let sha256 = page.sha256.clone();
    let code = drawn(move |languages| parts::code(&sha256, languages.spoken(texts::CODE)).unwrap_or_default());
    let front = vec![
        Block::Drawn(stand),
        Block::Within("proof", vec![Block::Drawn(code), signature(record::ISSUED_BY)]),
        Block::Within("note", vec![say([texts::PAPER_IS_NOT_SIGNED])]),
    ];
    let checked = [Block::Within("front", front), table(page)];
    checked.into_iter().chain(general::of_the_passport(&page.content.passport, Some(&page.key))).collect()
}

/// The four answers on the front of a passport: its validity, its site, its certificate, and how to check the file.
pub(super) fn answers(page: &PassportPage) -> Block {
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
