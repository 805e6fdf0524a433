//! First page: identification of the passport, its signer and signing time, the result of verification, and the SHA-256
//! to compare.

use super::{PassportPage, checks};
use crate::report::page::code;
use crate::report::page::language::Languages;
use crate::report::page::parts::{date, field, fields, given, time, wide_field};
use crate::report::page::texts::{passport as texts, words};
use maud::{Markup, html};

pub(super) fn section(page: &PassportPage, languages: &Languages) -> Markup {
    let heading = "verification-heading";
    html! {
        section id="verification" aria-labelledby=(heading) {
            h2.unseen id=(heading) { (languages.label(texts::FRONT)) }
            (checks::verdict(page, languages))
            (signed(page, languages))
            (predecessor(page, languages))
            (sum(page, languages))
            (checks::table(page, languages))
        }
    }
}

fn signed(page: &PassportPage, languages: &Languages) -> Markup {
    let header = &page.content.passport;
    fields([
        field(languages, texts::ID, Some(given(&header.id))),
        field(languages, texts::REVISION, Some(html! { (header.revision) })),
        field(languages, texts::ISSUED, Some(time(languages, header.issued_at))),
        field(languages, texts::VALID_UNTIL, header.valid_until.map(|day| date(languages, day))),
        field(languages, texts::ISSUER, Some(given(&header.issuer))),
        field(languages, texts::ISSUED_WITH, header.issued_with.as_deref().map(given)),
        wide_field(languages, texts::KEY, Some(html! { code { (page.key.fingerprint()) } })),
    ])
}

fn predecessor(page: &PassportPage, languages: &Languages) -> Markup {
    let Some(old) = &page.content.passport.reissued_from else { return html! {} };
    let superseded = if page.content.passport.supersedes == Some(true) { words::YES } else { words::NO };
    fields([
        field(languages, texts::REISSUED_FROM, Some(given(&old.id))),
        field(languages, texts::REISSUE_SUPERSEDES, Some(languages.inline(superseded))),
        wide_field(languages, texts::REISSUE_REASON, Some(given(&old.reason))),
        wide_field(languages, texts::REISSUE_CHANGED, Some(given(&old.changed))),
        wide_field(languages, texts::REISSUED_SHA256, Some(html! { code { (old.sha256) } })),
    ])
}

/// Writes the SHA-256 as text, in groups, and as a QR code.
fn sum(page: &PassportPage, languages: &Languages) -> Markup {
    html! {
        div.sum {
            @if let Some(picture) = code::picture(&page.sha256, languages.spoken(texts::CODE)) { (picture) }
            div {
                p.sum-name { (languages.label(texts::SHA256)) }
                p.sha256 { code { (page.sha256) } }
                (languages.paragraph(texts::PAPER_IS_NOT_SIGNED))
            }
        }
    }
}
