//! "May I use this passport, on this stand, here, now?"
//!
//! Verification is a function of bytes, trusted keys and a time: no file, no clock, so that it can run anywhere. The
//! steps come in an order that parses nothing before the signature holds, and computes nothing before the signer is
//! trusted: anybody can sign a file that costs much to compute.

use super::checks::{Check, CheckName, Code};
use super::content::{Content, Dated, PASSPORT_FORMAT};
use super::{NAMESPACE, place, read, recomputed};
use crate::coefficients::Coefficients;
use crate::document::sha256_hex;
use crate::document::{Malformed, SignedText};
use crate::earth::Place;
use crate::revocation::{Entry, Series};
use crate::text::scalar::day;
use crate::trust::{AllowedSigners, NotAuthorised, PublicKey, RevokedKeys};
use jiff::Timestamp;
use std::fmt::Display;

/// Whom to trust.
#[derive(Debug, Clone)]
pub struct Trust {
    /// The keys that may sign, each with its principals, purposes and times.
    pub signers: AllowedSigners,
    /// Keys that no longer count, whatever they signed and when.
    pub revoked: Vec<RevokedKeys>,
    /// The lists of withdrawn passports, themselves verified.
    pub withdrawn: Series,
}

impl Trust {
    /// These signers, nothing revoked and nothing withdrawn.
    pub fn of(signers: AllowedSigners) -> Self {
        Self { signers, revoked: Vec::new(), withdrawn: Series::default() }
    }
}

/// What is asked.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// Now, or the time that is asked about.
    pub time: Timestamp,
    /// The issuer it must be.
    pub issuer: Option<String>,
    /// The serial number of the stand that stands here.
    pub serial: Option<String>,
    /// Where it stands.
    pub place: Option<Place>,
}

impl Question {
    /// Only whether the passport is good and in force at `time`.
    pub fn at(time: Timestamp) -> Self {
        Self { time, issuer: None, serial: None, place: None }
    }

    /// Returns `true` if it asks for no issuer, stand or place.
    pub(crate) fn is_open(&self) -> bool {
        self.issuer.is_none() && self.serial.is_none() && self.place.is_none()
    }

    /// Returns `true` if a passport with this content is of the issuer, the stand and the place asked for.
    pub(crate) fn concerns(&self, content: &Content) -> bool {
        self.issuer.as_ref().is_none_or(|issuer| content.passport.issuer == *issuer)
            && self.serial.as_ref().is_none_or(|serial| content.stand.serial.as_str() == serial)
            && self.place.is_none_or(|place| place::verdict(content, place).0 == Code::Ok)
    }
}

/// The answer: every check, and the passport's content as far as it may be believed.
#[derive(Debug, Clone, PartialEq)]
pub struct Verification {
    checks: Vec<Check>,
    key: Option<PublicKey>,
    content: Option<Box<Content>>,
}

/// A passport that passed every check that was asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct VerifiedPassport {
    content: Box<Content>,
    key: PublicKey,
}

impl VerifiedPassport {
    /// What it says.
    pub fn content(&self) -> &Content {
        &self.content
    }

    /// The key that signed it.
    pub fn key(&self) -> &PublicKey {
        &self.key
    }

    /// What a calibration with it works with.
    pub fn coefficients(&self) -> Coefficients {
        self.content.coefficients()
    }
}

impl Verification {
    /// Every check, in the order of [`CheckName`].
    pub fn checks(&self) -> &[Check] {
        &self.checks
    }

    /// Whether every check passed.
    pub fn valid(&self) -> bool {
        self.checks.iter().all(|check| check.code == Code::Ok)
    }

    /// The code of one check.
    pub fn code(&self, name: CheckName) -> Option<Code> {
        self.checks.iter().find(|check| check.name == name).map(|check| check.code)
    }

    /// Returns the passport's id, once its signature is correct and its content is good, whoever signed it.
    pub fn id_from_anyone(&self) -> Option<&str> {
        self.content.as_ref().map(|content| content.passport.id.as_str())
    }

    /// Returns the content, once the signature is correct and the content is good: whoever signed it, and whatever else
    /// failed. For what the issuer says, call [`Verification::passport`] or [`Verification::authentic`].
    pub fn content_from_anyone(&self) -> Option<&Content> {
        self.content.as_deref()
    }

    /// Adds a check that needs more than the passport's own bytes.
    pub(crate) fn with(mut self, check: Check) -> Self {
        self.checks.push(check);
        self
    }

    /// Returns the key that the signature names, once the signature's form is good: anyone can name a key.
    pub fn key_from_anyone(&self) -> Option<&PublicKey> {
        self.key.as_ref()
    }

    /// The content and the key that signed it, when it is the issuer's own word: text, signature, numbers and signer
    /// hold, the key is not revoked, and the issuer is the one asked for. Whether it may be used, here and now, the other
    /// checks say.
    pub fn authentic(&self) -> Option<(&Content, &PublicKey)> {
        let issuer = self.code(CheckName::Issuer).is_none_or(|code| code == Code::Ok);
        // They are not computed for a signer who is not trusted, or whose key is revoked.
        let numbers = self.code(CheckName::Recomputed) == Some(Code::Ok);
        self.content_from_anyone().filter(|_| issuer && numbers).zip(self.key_from_anyone())
    }

    /// Returns the entry that withdraws this passport, whose file is `bytes`.
    ///
    /// A passport with wrong numbers, or past its time, can be withdrawn; one of another signer cannot: its id may be
    /// that of a good passport.
    ///
    /// # Errors
    /// The first check that failed, if the signer is not trusted or nothing is known of the content.
    pub(crate) fn withdrawal(
        &self,
        bytes: &[u8],
        revoked_at: Timestamp,
        reason: &str,
    ) -> Result<Entry, Option<&Check>> {
        let signed = self.code(CheckName::Signer) == Some(Code::Ok);
        let Some(id) = self.id_from_anyone().filter(|_| signed) else {
            return Err(self.checks.iter().find(|check| check.passed() == Some(false)));
        };
        Ok(Entry { id: id.to_owned(), sha256: sha256_hex(bytes), revoked_at, reason: reason.to_owned() })
    }

    /// The passport, when every check passed; otherwise the checks say what failed.
    pub fn passport(&self) -> Option<VerifiedPassport> {
        let (content, key) = self.content.clone().zip(self.key.clone()).filter(|_| self.valid())?;
        Some(VerifiedPassport { content, key })
    }
}

/// Verifies the bytes of a passport; `name` is the file's name, for messages.
///
/// Steps 1 to 3 are the check `grammar`, 4 `signature`, 5 `schema`, 6 `signer`, `revocation` and `in_force`; then every
/// number is computed again, and what the question names is compared. Behind a signer who is not trusted nothing is run.
pub fn verify(name: &str, bytes: &[u8], trust: &Trust, question: &Question) -> Verification {
    let mut run = Run { checks: Vec::new() };
    let mut verification = Verification { checks: Vec::new(), key: None, content: None };
    if let Some(text) = run.grammar(name, bytes) {
        verification.key = Some(text.key().clone());
        if let Some(payload) = run.signature(&text, trust) {
            verification.content = run.schema(name, payload).map(Box::new);
            let counts = run.revocation(bytes, text.key(), trust);
            if let Some(content) = &verification.content
                && run.signer(text.key(), content, trust)
                && counts
            {
                run.recomputed(content);
                run.in_force(content, question.time);
                run.asked(content, question);
            }
        }
    }
    run.note_what_was_not_run(question);
    run.checks.sort_by_key(|check| check.name);
    verification.checks = run.checks;
    verification
}

/// The answer about a file that could not be read: nothing was run. `why` is what the system says.
pub(crate) fn unreadable(why: &str, question: &Question) -> Verification {
    let mut run = Run { checks: Vec::new() };
    run.note(CheckName::Grammar, Code::Unreadable, why);
    run.note_what_was_not_run(question);
    run.checks.sort_by_key(|check| check.name);
    Verification { checks: run.checks, key: None, content: None }
}

/// The checks made so far.
struct Run {
    checks: Vec<Check>,
}

impl Run {
    fn note(&mut self, name: CheckName, code: Code, detail: impl Display) {
        self.checks.push(Check::new(name, code, detail));
    }

    fn grammar<'a>(&mut self, name: &str, bytes: &'a [u8]) -> Option<SignedText<'a>> {
        match SignedText::split(name, bytes, NAMESPACE) {
            Ok(text) => {
                self.note(
                    CheckName::Grammar,
                    Code::Ok,
                    "the file has the canonical form, which all programs read \
                     alike",
                );
                Some(text)
            }
            Err(Malformed { fault, other_namespace }) => {
                let code = if other_namespace.is_some() { Code::WrongNamespace } else { Code::Malformed };
                self.note(CheckName::Grammar, code, fault);
                None
            }
        }
    }

    fn signature<'a>(&mut self, text: &SignedText<'a>, trust: &Trust) -> Option<&'a str> {
        match text.payload_signed_by_any(&trust.signers) {
            Ok(payload) => {
                self.note(
                    CheckName::Signature,
                    Code::Ok,
                    format!("the text has not changed since {} signed it", text.key().fingerprint()),
                );
                Some(payload)
            }
            Err(error) => {
                let detail = format!("{error}; get the file from the issuer again");
                self.note(CheckName::Signature, Code::Altered, detail);
                None
            }
        }
    }

    fn schema(&mut self, name: &str, payload: &str) -> Option<Content> {
        match read::content(name, payload) {
            Ok(content) => {
                self.note(
                    CheckName::Schema,
                    Code::Ok,
                    format!(
                        "the content is complete and conforms to \
                    {PASSPORT_FORMAT}"
                    ),
                );
                Some(content)
            }
            Err(error) => {
                // A line for each mistake.
                let (name, detail) = (CheckName::Schema, error.to_string());
                self.checks.push(Check { name, code: Code::BadContent, detail });
                None
            }
        }
    }

    /// Returns `true` if the key is not revoked, whatever became of the passport.
    fn revocation(&mut self, bytes: &[u8], key: &PublicKey, trust: &Trust) -> bool {
        if let Some(why) = trust.revoked.iter().find_map(|list| list.revokes(key)) {
            let detail = format!("the signing key {} was revoked: {why}", key.fingerprint());
            self.note(CheckName::Revocation, Code::KeyRevoked, detail);
            return false;
        }
        if let Some(entry) = trust.withdrawn.entry(&sha256_hex(bytes)) {
            self.note(CheckName::Revocation, Code::PassportRevoked, entry.to_string());
            return true;
        }
        let detail = match (trust.withdrawn.newest(), trust.revoked.is_empty()) {
            (Some(list), _) => format!("not withdrawn: list {} of {} does not list it", list.sequence, list.issued_at),
            (None, false) => "the signing key is not revoked; no list of withdrawn passports was given".to_owned(),
            (None, true) => "no revocation list was given (--revoked)".to_owned(),
        };
        self.note(CheckName::Revocation, Code::Ok, detail);
        true
    }

    /// Returns `true` if the key is that of the issuer.
    fn signer(&mut self, key: &PublicKey, content: &Content, trust: &Trust) -> bool {
        let header = &content.passport;
        match trust.signers.authorise(key, &header.issuer, NAMESPACE, header.issued_at) {
            Ok(()) => {
                self.note(CheckName::Signer, Code::Ok, format!("the key belongs to {}", header.issuer));
                true
            }
            Err(miss) => {
                let code = match miss {
                    NotAuthorised::UnknownKey => Code::UnknownKey,
                    NotAuthorised::WrongPrincipal { .. } => Code::WrongPrincipal,
                    NotAuthorised::WrongNamespace { .. } => Code::WrongNamespace,
                    NotAuthorised::NotYetValid { .. } => Code::KeyNotYetValid,
                    NotAuthorised::Expired { .. } => Code::KeyExpired,
                };
                let (issuer, at) = (&header.issuer, header.issued_at);
                let detail = format!("{miss} (key {}, issuer {issuer}, issued {at})", key.fingerprint());
                self.note(CheckName::Signer, code, detail);
                false
            }
        }
    }

    fn recomputed(&mut self, content: &Content) {
        match recomputed::compare(content) {
            Ok(()) => {
                let detail = "all numbers, recomputed, agree with the signed deviations and site";
                self.note(CheckName::Recomputed, Code::Ok, detail);
            }
            Err(wrong) => {
                let others = wrong.len() - 1;
                let more = if others > 0 { format!(" (and {others} more)") } else { String::new() };
                let first = wrong.first().map(ToString::to_string).unwrap_or_default();
                let detail = format!("the signature is correct, but {first}{more}; report this to the issuer");
                self.note(CheckName::Recomputed, Code::WrongNumber, detail);
            }
        }
    }

    fn in_force(&mut self, content: &Content, time: Timestamp) {
        let issued_at = content.passport.issued_at;
        let last = content.last_day();
        let (code, detail) = match last {
            _ if issued_at > time => {
                (Code::NotYetValid, format!("issued at {issued_at}, which is later than {time}; check the clock"))
            }
            // The whole of the last second belongs to the last day.
            Some((last, which)) if time.as_second() > day(last).1.as_second() => {
                let remedy = match which {
                    Dated::Certificate => "have the stand recertified",
                    Dated::Passport => "request a new passport from the issuer",
                };
                (
                    Code::Expired,
                    format!(
                        "the {which} was valid until {last} (inclusive), verified as of {time}; \
                         {remedy}"
                    ),
                )
            }
            Some((last, which)) => {
                (Code::Ok, format!("issued {issued_at}; the {which} is valid until {last} (inclusive)"))
            }
            None => (
                Code::Ok,
                format!(
                    "issued {issued_at}; neither the passport nor the certificate has an expiry \
                     date"
                ),
            ),
        };
        self.note(CheckName::InForce, code, detail);
    }

    fn asked(&mut self, content: &Content, question: &Question) {
        if let Some(issuer) = &question.issuer {
            let found = &content.passport.issuer;
            let code = if found == issuer { Code::Ok } else { Code::WrongIssuer };
            let detail = if found == issuer {
                format!("issued by {found}")
            } else {
                format!("issued by {found}, not by {issuer}")
            };
            self.note(CheckName::Issuer, code, detail);
        }
        if let Some(serial) = &question.serial {
            let found = content.stand.serial.as_str();
            let stand = format!("the passport is for stand {} {found}", content.stand.model);
            let (code, detail) = if found == serial {
                (Code::Ok, stand)
            } else {
                (Code::WrongStand, format!("{stand}, not {serial}; its deviations do not apply to stand {serial}"))
            };
            self.note(CheckName::Stand, code, detail);
        }
        if let Some(place) = question.place {
            let (code, detail) = place::verdict(content, place);
            self.note(CheckName::Place, code, detail);
        }
    }

    fn note_what_was_not_run(&mut self, question: &Question) {
        use CheckName::{Grammar, InForce, Issuer, Place, Recomputed, Revocation, Schema, Signature, Signer, Stand};
        let always = [Grammar, Signature, Schema, Signer, Revocation, Recomputed, InForce];
        let asked = [
            question.issuer.as_ref().map(|_| Issuer),
            question.serial.as_ref().map(|_| Stand),
            question.place.map(|_| Place),
        ];
        for name in always.into_iter().chain(asked.into_iter().flatten()) {
            if !self.checks.iter().any(|check| check.name == name) {
                self.note(name, Code::NotRun, "not run: an earlier check failed");
            }
        }
    }
}
