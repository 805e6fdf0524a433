//! Answer of `verify`, and the words of every check.

use super::doc::{Block, Counted, Words, either, given, joined, line, listed, longest, marked, padded, say};
pub(crate) use crate::interface::Verdict;
use crate::passport::place::Nearness;
use crate::passport::{Check, CheckName, Code, Content, Dated, Question, RegisterUsed, Verification};
use crate::wording::texts::{checks, units, verdict as texts};
use crate::wording::{Number, Outcome, Text};
use jiff::Timestamp;

/// The answer for a file, what it is based on, and a line for each of its checks.
pub(crate) fn document(verdict: &Verdict, verification: &Verification, question: &Question) -> Vec<Block> {
    let first = first_line(verdict);
    if let Some(check) = verdict.checks.iter().find(|check| check.code == Code::Unreadable) {
        return vec![first, say([given(&check.detail)])];
    }
    let checks = &verdict.checks;
    let mut lines: Vec<Vec<Words>> = Vec::new();
    for (check, passed) in checks.iter().filter_map(|check| Some((check, check.passed()?))) {
        let mut details = check.detail.split('\n').map(given);
        let detail = match passed || check.detail.lines().count() < 2 {
            true => {
                let said = said(check, verification.content_from_anyone(), question, verdict.register.as_ref());
                Words::OfLibrary(check.detail.clone(), Box::new(said))
            }
            false => details.next().unwrap_or(Words::Blank),
        };
        lines.push(vec![result(Some(passed), word(Some(passed))), name(check.name.as_str()), detail]);
        if !passed {
            lines.extend(details.filter(|_| check.detail.contains('\n')).map(|line| vec!["".into(), "".into(), line]));
        }
    }
    let not_run = named(checks, Code::NotRun);
    if not_run.len() > 1 {
        lines.push(vec![result(None, checks::NOT_RUN), texts::earlier_failed(listed(not_run))]);
    }
    let with_option = |check: &Check| Some(format!("{} ({})", check.name.as_str(), check.name.option()?));
    let not_asked: Vec<_> = checks.iter().filter(|check| !check.was_asked()).filter_map(with_option).collect();
    if !not_asked.is_empty() {
        lines.push(vec![result(None, word(None)), listed(not_asked)]);
    }
    vec![first, say([counts(checks)]), Block::Whole("  ", lines)]
}

fn result(passed: Option<bool>, word: Text) -> Words {
    const ALL: [Text; 4] = [checks::PASSED, checks::FAILED, checks::NOT_RUN, checks::NOT_ASKED];
    marked(passed, padded(word, |language| longest(ALL, language)))
}

fn name(check: &str) -> Words {
    padded(check, |_| CheckName::ALL.into_iter().map(|name| name.as_str().len()).max())
}

/// The answer for a file that could not be read, if a message has said why.
pub(crate) fn not_read(verdict: &Verdict) -> [Block; 2] {
    [first_line(verdict), say([texts::NOT_READ])]
}

fn first_line(verdict: &Verdict) -> Block {
    let id = verdict.id.as_ref().map_or_else(|| texts::NO_ID.into(), given);
    let first = joined([answer(verdict.valid, &verdict.checks), id, given(&verdict.file)], "  ");
    Block::Whole("", vec![vec![first]])
}

/// The counts of the answers for several files, of which `unread` could not be read; nothing for a single file.
pub(crate) fn summary(verdicts: &[Verdict], unread: usize) -> Option<Block> {
    let outcomes: Vec<_> = verdicts.iter().map(|verdict| outcome(verdict.valid, &verdict.checks)).collect();
    let count = |outcome| outcomes.iter().filter(|(found, _)| *found == outcome).count();
    let [valid, so_far, failed] = [Outcome::Passed, Outcome::Undecided, Outcome::Failed].map(count);
    let counts: [(usize, Counted); 4] = [
        (valid, texts::count_valid),
        (so_far, texts::count_so_far),
        (failed - unread, texts::count_refused),
        (unread, texts::count_not_read),
    ];
    let worst = match (failed, so_far) {
        (0, 0) => Outcome::Passed,
        (0, _) => Outcome::Undecided,
        _ => Outcome::Failed,
    };
    let counts = listed(counts.into_iter().filter(|(count, _)| *count > 0).map(|(count, words)| words(count)));
    (verdicts.len() > 1).then(|| line(marked(worst, texts::files(verdicts.len(), counts))))
}

/// The answer in words.
pub(crate) fn answer(valid: bool, checks: &[Check]) -> Words {
    let (outcome, word) = outcome(valid, checks);
    marked(outcome, word)
}

/// Returns the answer of a verification: undecided if everything passed, but a question on which it depends whether the
/// passport may be used on this stand, here and now was not asked.
fn outcome(valid: bool, checks: &[Check]) -> (Outcome, Text) {
    let needed = [CheckName::Stand, CheckName::Place, CheckName::Register];
    match checks.iter().any(|check| !check.was_asked() && needed.contains(&check.name)) {
        _ if !valid => (Outcome::Failed, texts::REFUSED),
        true => (Outcome::Undecided, texts::VALID_SO_FAR),
        false => (Outcome::Passed, texts::VALID),
    }
}

/// Returns the names of the checks with this result: not run, because of an earlier failure, or not requested.
fn named(checks: &[Check], code: Code) -> Vec<&'static str> {
    checks.iter().filter(|check| check.code == code).map(|check| check.name.as_str()).collect()
}

/// Which checks failed, and how many were made, were not run, or were not asked for.
fn counts(checks: &[Check]) -> Words {
    let failed = checks.iter().filter(|check| check.passed() == Some(false)).map(|check| check.name.as_str());
    let failed: Vec<&str> = failed.collect();
    let made = checks.iter().filter(|check| check.passed().is_some()).count();
    let others: [(usize, Counted); 2] =
        [(named(checks, Code::NotRun).len(), texts::not_run), (named(checks, Code::NotAsked).len(), texts::not_asked)];
    let others = others.into_iter().filter(|(count, _)| *count > 0).map(|(count, words)| words(count));
    let counts = listed([texts::checked(made)].into_iter().chain(others));
    if failed.is_empty() { counts } else { texts::failed(listed(failed), counts) }
}

/// The counts of the checks, with the names of those that were not asked for.
pub(crate) fn counts_with_names(checks: &[Check]) -> Words {
    let names = named(checks, Code::NotAsked);
    let names = (!names.is_empty()).then(|| Words::All(vec![": ".into(), listed(names)]));
    Words::All([counts(checks)].into_iter().chain(names).collect())
}

/// The result of a check in a word.
pub(crate) fn word(passed: Option<bool>) -> Text {
    passed.map_or(checks::NOT_ASKED, |passed| if passed { checks::PASSED } else { checks::FAILED })
}

/// What a check found in a passport with this `content`, by which register.
pub(crate) fn said(
    check: &Check,
    content: Option<&Content>,
    question: &Question,
    register: Option<&RegisterUsed>,
) -> Words {
    let of_library: Option<fn(Words) -> Words> = match check.code {
        Code::Malformed | Code::UnsupportedKey => Some(texts::malformed),
        Code::WrongNamespace => Some(texts::wrong_namespace),
        Code::BadContent => Some(texts::bad_content),
        Code::NewerFormat => Some(texts::newer_format),
        Code::UnknownKey | Code::WrongPrincipal | Code::KeyNotYetValid | Code::KeyExpired => Some(texts::wrong_key),
        Code::KeyRevoked => Some(texts::key_revoked),
        Code::WrongNumber => Some(texts::wrong_number),
        _ => None,
    };
    if let Some(words) = of_library {
        return words(given(&check.detail));
    }
    match (check.name, content) {
        (CheckName::Grammar, _) => checks::GRAMMAR_OK.into(),
        (CheckName::Signature, _) if check.code == Code::Altered => texts::ALTERED.into(),
        (CheckName::Signature, _) => checks::SIGNATURE_OK.into(),
        (CheckName::Recomputed, _) => checks::RECOMPUTED_OK.into(),
        (CheckName::Revocation, _) => checks::REVOCATION_OK.into(),
        (CheckName::Register, _) => of_register(check.code, register),
        (CheckName::Schema, Some(content)) => checks::schema_ok(&content.format),
        (CheckName::Signer, Some(content)) => checks::signer_ok(content.passport.issuer.as_str()),
        (CheckName::Issuer, Some(content)) => {
            let (found, asked) = (content.passport.issuer.as_str(), question.issuer.as_deref().unwrap_or_default());
            if check.code == Code::Ok {
                checks::issuer_ok(found)
            } else {
                texts::wrong_issuer(found, asked, "--issuer")
            }
        }
        (CheckName::InForce, Some(content)) => validity(content, check.code),
        (CheckName::Stand, Some(content)) => {
            let (serial, asked) = (&content.stand.serial, question.serial.as_deref().unwrap_or_default());
            if check.code == Code::Ok { checks::stand_ok(serial) } else { checks::stand_wrong(serial, asked) }
        }
        (CheckName::Place, Some(content)) => place(content, question),
        (_, None) => given(&check.detail),
    }
}

/// What the register says, with its number, time, SHA-256 and freshness.
fn of_register(code: Code, register: Option<&RegisterUsed>) -> Words {
    let text = checks::by_register!(Code, code);
    let Some(used) = register else { return text.into() };
    let fresh = used.fresh_until.map_or_else(|| "".into(), checks::register_fresh);
    let used = checks::register_used(used.sequence, time(used.issued_at), &used.sha256[..16], fresh);
    vec![text.into(), "; ".into(), used].into()
}

/// A time, in a terminal as options take it.
fn time(time: Timestamp) -> Words {
    either(Words::Time(time), time)
}

fn validity(content: &Content, code: Code) -> Words {
    match (code, content.last_day()) {
        (Code::NotYetValid, _) => checks::validity_not_yet(time(content.passport.issued_at)),
        (_, None) => checks::VALIDITY_NO_END.into(),
        (Code::Ok, Some((day, _))) => checks::validity_ok(day),
        (_, Some((day, Dated::Certificate))) => checks::validity_certificate_expired(day),
        (_, Some((day, _))) => checks::validity_expired(day),
    }
}

fn place(content: &Content, question: &Question) -> Words {
    let Some(place) = question.place else { return "".into() };
    let nearness = Nearness::of(content, place);
    let [distance, radius] = [nearness.distance_m, nearness.radius_m].map(length);
    if nearness.within() { checks::place_ok(distance, radius) } else { checks::place_wrong(distance, radius) }
}

/// Returns a length in metres, or in kilometres above 10 km.
fn length(metres: f64) -> Words {
    let (value, unit) = if metres < 1e4 { (metres, units::METRES) } else { (metres / 1000.0, units::KILOMETRES) };
    Words::Quantity(Number::fixed(value, 0), unit)
}
