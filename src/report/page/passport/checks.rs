//! Checks of a verification in words. A page is made only if text, signature, content, signer and numbers pass, so
//! failures of these checks are never printed.

use super::PassportPage;
use crate::passport::{Check, CheckName, Code};
use crate::report::doc::{Block, Rows, Words, listed, marked, note, outcome_box, told};
use crate::report::verdict::{said, word};
use crate::wording::Text;
use crate::wording::texts::checks as texts;

/// Returns `true` if nothing shows whether the passport has been withdrawn.
pub(crate) fn withdrawal_not_checked(page: &PassportPage) -> bool {
    page.verification.code(CheckName::Revocation) == Some(Code::NotAsked)
}

/// Why the passport may not be used, in large letters; nothing if it may.
pub(super) fn refusal(page: &PassportPage) -> Option<Block> {
    let time = note(told(texts::genuine(Words::Time(page.question.time))));
    let why = Block::List(failed(page).map(|check| told(words(page, check))).collect());
    (!page.verification.valid()).then(|| outcome_box(Some(false), headline(page), vec![time, why]))
}

/// "In force", or the reasons why the passport may not be used.
fn headline(page: &PassportPage) -> Words {
    let failed: Vec<Text> = failed(page).map(|check| texts::reason!(Code, check.code)).collect();
    match failed.is_empty() {
        true => texts::IN_FORCE.into(),
        false => told(vec![texts::NOT_TO_BE_USED.into(), ": ".into(), listed(failed)]),
    }
}

/// The warning for the head of every sheet, empty for a valid passport; in two languages it has no room for reasons.
pub(super) fn warning(page: &PassportPage, is_single: bool) -> Words {
    match (page.verification.valid(), is_single) {
        (true, _) => "".into(),
        (false, true) => headline(page),
        (false, false) => texts::NOT_TO_BE_USED.into(),
    }
}

fn failed<'a>(page: &'a PassportPage) -> impl Iterator<Item = &'a Check> {
    page.verification.checks().iter().filter(|check| check.passed() == Some(false))
}

/// Every check with its result; those that were not asked have one row.
pub(crate) fn table(page: &PassportPage) -> Block {
    let (not_asked, asked): (Vec<&Check>, Vec<_>) =
        page.verification.checks().iter().partition(|check| check.passed().is_none());
    let name = |check: &Check| texts::check!(CheckName, check.name);
    let row = |check: &Check| (Words::from(name(check)), check.passed(), told(words(page, check)));
    let mut rows: Vec<(Words, Option<bool>, Words)> = asked.into_iter().map(row).collect();
    if !not_asked.is_empty() {
        let not_given = |check: &&Check| texts::not_given!(CheckName, check.name);
        let [names, inputs] =
            [listed(not_asked.iter().map(|check| name(check))), listed(not_asked.iter().map(not_given))].map(told);
        rows.push((names, None, inputs));
    }
    let table = Rows::of(&rows, "checks")
        .named(texts::CHECK, |(name, ..)| name.clone())
        .column(texts::RESULT, |(_, passed, _)| marked(*passed, word(*passed)))
        .column(texts::FOUND, |(.., found)| found.clone());
    table.captioned(texts::CHECK, told(texts::caption(Words::Time(page.question.time))))
}

fn words(page: &PassportPage, check: &Check) -> Words {
    said(check, Some(&page.content), page.question, page.verification.register())
}
