//! What the register of a stand says of one passport.

use super::{Contradiction, RegisterRefused, State, VerifiedRegister};
use crate::passport::checks::{ASK_THE_ISSUER, Check, CheckName, Code};
use crate::passport::{Content, Question, RegisterUsed, Verification};

/// Reason why a verified register does not count.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Doubt {
    /// A later register is known: its sequence number.
    #[error("older than register {0}, the last one known; restore it from the backup")]
    Older(u64),
    /// Another known register contradicts this one.
    #[error("{0}")]
    Contradicted(Contradiction),
    /// The number is so much higher than that of the last known register that a person must confirm it; in words.
    #[error("{0}")]
    Unconfirmed(String),
}

impl VerifiedRegister {
    /// Returns sequence, SHA-256 and dates of this register, as results state them.
    pub fn used(&self) -> RegisterUsed {
        let header = self.header();
        RegisterUsed {
            sequence: header.sequence,
            sha256: self.sha256().to_owned(),
            issued_at: header.issued_at,
            fresh_until: header.fresh_until,
        }
    }

    /// Checks a passport with this content, whose file has this SHA-256. A register never makes a passport valid again
    /// that failed another check.
    fn check(&self, content: &Content, sha256: &str, question: &Question, doubt: Option<&Doubt>) -> (Code, String) {
        let header = self.header();
        if header.stand != content.stand.id() {
            return (Code::RegisterUnknown, format!("the register is of another stand, {}", header.stand));
        }
        if header.issuer != content.passport.issuer {
            let (register, passport) = (&header.issuer, &content.passport.issuer);
            let detail = format!("the register is of {register}, and the passport is of {passport}");
            return (Code::RegisterUnknown, detail);
        }
        let entry = self.entry(&content.passport.id).filter(|entry| entry.sha256 == sha256);
        let since = |entry: &super::Entry| entry.since.unwrap_or(header.issued_at);
        if let Some(entry) = entry.filter(|entry| entry.state == State::Withdrawn) {
            let reason = entry.reason.as_deref().unwrap_or_default();
            return (Code::Withdrawn, format!("withdrawn at {}: {reason}; {ASK_THE_ISSUER}", since(entry)));
        }
        match doubt {
            Some(Doubt::Contradicted(contradiction)) => return (Code::RegisterContradicted, contradiction.to_string()),
            Some(Doubt::Older(known)) => {
                let advice = "get the last one from the issuer, or restore it from the backup";
                let detail =
                    format!("register {} is older than {known}, the last known one; {advice}", header.sequence);
                return (Code::RegisterOlder, detail);
            }
            Some(Doubt::Unconfirmed(words)) => return (Code::RegisterUnknown, words.clone()),
            None => {}
        }
        let Some(entry) = entry else {
            let found = match self.entry(&content.passport.id) {
                Some(_) => "lists another file with this identifier",
                None => "does not list this passport",
            };
            return (Code::NotListed, format!("register {} {found}; {ASK_THE_ISSUER}", header.sequence));
        };
        if let (State::Superseded | State::Moved, Some(by)) = (entry.state, &entry.by)
            && question.time >= since(entry)
        {
            let (code, what) = match entry.state {
                State::Moved => (Code::Moved, "the stand has left this site; the passport for the new one is"),
                _ => (Code::Superseded, "superseded by"),
            };
            return (code, format!("{what} {by}, since {}; use that passport", since(entry)));
        }
        if let Some(last) = header.fresh_until.filter(|_| self.is_stale(question.time.max(question.now))) {
            let advice = "get the last one from the issuer";
            let detail = format!("register {} was fresh until {last} (inclusive); {advice}", header.sequence);
            return (Code::RegisterStale, detail);
        }
        let fresh = header.fresh_until.map_or_else(String::new, |last| format!(", fresh until {last} (inclusive)"));
        let sha256 = &self.sha256()[..16];
        let detail =
            format!("current in register {} of {} (SHA-256 {sha256}…){fresh}", header.sequence, header.issued_at);
        (Code::Ok, detail)
    }
}

impl Verification {
    /// Adds the check [`CheckName::Register`]: the answer of a register to `question`, or why there is none.
    #[must_use]
    pub fn with_register(
        self,
        register: Result<(&VerifiedRegister, Option<&Doubt>), &RegisterRefused>,
        question: &Question,
    ) -> Self {
        let not_run = || (Code::NotRun, "not run: an earlier check failed".to_owned());
        let (code, detail) = match (self.content_from_anyone(), register) {
            (None, _) => not_run(),
            (Some(_), Err(refused)) => (Code::RegisterUnknown, refused.to_string()),
            (Some(content), Ok((register, doubt))) => register.check(content, self.sha256(), question, doubt),
        };
        let used = register.ok().map(|(register, _)| register.used());
        self.with_used(Check::new(CheckName::Register, code, detail), used)
    }
}
