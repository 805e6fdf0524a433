//! Verification of a passport: "May I use this passport, on this stand, here, now?"
//!
//! Verification is a function of bytes, trusted keys and a time. It reads no file and no clock, so that it can run
//! anywhere. It parses no content before the signature is verified, and computes nothing before the signer is trusted,
//! because anyone can sign a file that is expensive to compute.

use super::checks::{Check, CheckName, Code, REQUEST_FROM_THE_ISSUER};
use super::content::{Content, Dated, PASSPORT_FORMAT};
use super::{FORM, NAMESPACE, content, place, recomputed};
use crate::coefficients::Coefficients;
use crate::document::{RegisterUsed, SignedText, sha256_hex};
use crate::earth::Place;
use crate::text::scalar::day;
use crate::text::{first_few, printable};
use crate::trust::{AllowedSigners, Message, NotAuthorised, PublicKey, RevokedKeys, SignatureError};
use jiff::Timestamp;
use std::collections::BTreeSet;
use std::fmt::{self, Debug, Display, Formatter};

/// Trusted signers and revoked keys.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Trust {
    /// Keys that may sign, each with its principals, purposes and validity period.
    pub signers: AllowedSigners,
    /// Revoked keys; their signatures are rejected, whatever they signed and when.
    pub revoked: Vec<RevokedKeys>,
}

impl Trust {
    /// Creates a trust in `signers`, with no key revoked.
    pub fn of(signers: AllowedSigners) -> Self {
        Self { signers, revoked: Vec::new() }
    }

    /// Returns the remark on keys that were skipped in the lists, because they cannot sign passports; `None` without any.
    pub(crate) fn skipped(&self) -> Option<String> {
        let types = self.revoked.iter().flat_map(|list| &list.skipped).chain(&self.signers.skipped);
        let distinct: Vec<_> = types.clone().collect::<BTreeSet<_>>().into_iter().collect();
        let verb = match types.count() {
            0 => return None,
            1 => "1 key was skipped, because it".to_owned(),
            many => format!("{many} keys were skipped, because they"),
        };
        Some(printable(format!("{verb} cannot sign passports: {}", first_few(&distinct))))
    }
}

/// Time, issuer, stand and place to verify a passport for.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Question {
    /// Time of verification.
    pub time: Timestamp,
    /// Time of the clock, not earlier than which the freshness of a register is judged, whatever [`Self::time`] is.
    pub now: Timestamp,
    /// Required issuer; any issuer if `None`.
    pub issuer: Option<String>,
    /// Required serial number of the stand; any stand if `None`.
    pub serial: Option<String>,
    /// Place of use; not checked if `None`.
    pub place: Option<Place>,
}

impl Question {
    /// Creates a question about validity at `time`, which is also that of the clock, for any issuer, stand and place.
    pub fn at(time: Timestamp) -> Self {
        Self { time, now: time, issuer: None, serial: None, place: None }
    }

    /// Returns `true` if no issuer, stand or place is required.
    pub(crate) fn is_open(&self) -> bool {
        self.issuer.is_none() && self.serial.is_none() && self.place.is_none()
    }

    /// Returns `true` if the issuer, the stand and the place match a passport with this content.
    pub(crate) fn concerns(&self, content: &Content) -> bool {
        self.issuer.as_ref().is_none_or(|issuer| content.passport.issuer == *issuer)
            && self.serial.as_ref().is_none_or(|serial| content.stand.serial.as_str() == serial)
            && self.place.is_none_or(|place| place::verdict(content, place).0 == Code::Ok)
    }
}

/// Result of a verification: every check, and the content as far as it was verified.
#[derive(Debug, Clone, PartialEq)]
pub struct Verification {
    checks: Vec<Check>,
    key: Option<PublicKey>,
    content: Option<Box<Content>>,
    sha256: String,
    register: Option<RegisterUsed>,
}

/// Passport that passed every requested check.
#[derive(Debug, Clone, PartialEq)]
pub struct VerifiedPassport {
    content: Box<Content>,
    key: PublicKey,
    sha256: String,
}

/// Refusal of a passport: the checks that failed. `Debug`, with which a program ends that returns an error, prints them too.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error("refused{}", checks.iter().map(|check| format!("\n  {} ({}): {}", check.name.as_str(), check.code.as_str(), check.detail)).collect::<String>())]
#[non_exhaustive]
pub struct Refused {
    /// Checks that failed.
    pub checks: Vec<Check>,
}

impl Debug for Refused {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        Display::fmt(self, f)
    }
}

impl VerifiedPassport {
    /// Returns the content of the passport.
    pub fn content(&self) -> &Content {
        &self.content
    }

    /// Returns the key that signed the passport.
    pub fn key(&self) -> &PublicKey {
        &self.key
    }

    /// Returns the SHA-256 of the whole file, in lower-case hexadecimal.
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// Returns the coefficients of the calibration equations at the site of the passport.
    pub fn coefficients(&self) -> Coefficients {
        self.content.coefficients()
    }
}

impl Verification {
    /// Returns every check, also those that were not requested, in the order of [`CheckName`].
    pub fn checks(&self) -> &[Check] {
        &self.checks
    }

    /// Returns `true` if every requested check passed.
    pub fn valid(&self) -> bool {
        self.checks.iter().all(|check| matches!(check.code, Code::Ok | Code::NotAsked))
    }

    /// Returns the names of the checks that the question did not request, whatever the passport is.
    pub fn not_asked(&self) -> Vec<&'static str> {
        self.checks.iter().filter(|check| !check.was_asked()).map(|check| check.name.as_str()).collect()
    }

    /// Returns the first check that failed, or `None` if none did.
    pub(crate) fn failed(&self) -> Option<&Check> {
        self.checks.iter().find(|check| check.passed() == Some(false))
    }

    /// Returns the detail of the first check that failed; empty if none did.
    #[cfg(feature = "factory")]
    pub(crate) fn why(&self) -> &str {
        self.failed().map_or("", |check| &check.detail)
    }

    /// Returns the result code of the check `name`: [`Code::NotAsked`] if it was not requested.
    pub fn code(&self, name: CheckName) -> Option<Code> {
        self.checks.iter().find(|check| check.name == name).map(|check| check.code)
    }

    /// Returns the passport's id if the signature and the content are correct, whoever signed it; otherwise `None`.
    pub fn id_from_anyone(&self) -> Option<&str> {
        self.content.as_ref().map(|content| content.passport.id.as_str())
    }

    /// Returns the content if the signature and the content are correct, otherwise `None`. The signer may be anyone,
    /// and other checks may have failed. For the issuer's own statements, call [`Verification::passport`] or
    /// [`Verification::authentic`].
    pub fn content_from_anyone(&self) -> Option<&Content> {
        self.content.as_deref()
    }

    /// Returns the SHA-256 of the whole file, in lower-case hexadecimal.
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// Returns the register by which the passport was checked, or `None` if none was asked or accepted.
    pub fn register(&self) -> Option<&RegisterUsed> {
        self.register.as_ref()
    }

    /// Replaces a check, which needs more than the passport's own bytes: that of a register.
    pub(crate) fn with_used(mut self, check: Check, register: Option<RegisterUsed>) -> Self {
        self.register = register;
        self.checks.iter_mut().filter(|old| old.name == check.name).for_each(|old| *old = check.clone());
        self
    }

    /// Returns the key stated in the signature if the form of the signature is correct, otherwise `None`. Anyone can
    /// state any key there.
    pub(crate) fn key_from_anyone(&self) -> Option<&PublicKey> {
        self.key.as_ref()
    }

    /// Returns the content and the signing key if the passport is authentic, otherwise `None`. Authentic means: form,
    /// signature, content, signer and numbers pass, the key is not revoked, and the issuer is the required one. The
    /// other checks tell whether the passport may be used here and now.
    pub fn authentic(&self) -> Option<(&Content, &PublicKey)> {
        let issuer = matches!(self.code(CheckName::Issuer), Some(Code::Ok | Code::NotAsked));
        // The numbers are not computed if the signer is not trusted or the key is revoked.
        let numbers = self.code(CheckName::Recomputed) == Some(Code::Ok);
        self.content_from_anyone().filter(|_| issuer && numbers).zip(self.key_from_anyone())
    }

    /// Returns the content if every requested check passed, even if the passport has expired or may have been
    /// superseded or withdrawn; otherwise `None`: for a comparison with the past, not for use.
    pub(crate) fn content_even_if_past(&self) -> Option<&Content> {
        let good = |check: &Check| match check.code {
            Code::Ok | Code::NotAsked | Code::Expired => true,
            // Every answer of a register is about the present.
            code => check.name == CheckName::Register && code != Code::NotRun,
        };
        self.content.as_deref().filter(|_| self.checks.iter().all(good))
    }

    /// Returns the passport if every requested check passed, otherwise `None`; [`Verification::checks`] then tells what
    /// failed.
    pub fn passport(&self) -> Option<VerifiedPassport> {
        let (content, key) = self.content.clone().zip(self.key.clone()).filter(|_| self.valid())?;
        Some(VerifiedPassport { content, key, sha256: self.sha256.clone() })
    }

    /// Returns the passport if every requested check passed.
    ///
    /// # Errors
    /// Returns [`Refused`] with the checks that failed.
    pub fn accepted(&self) -> Result<VerifiedPassport, Refused> {
        let failed = self.checks.iter().filter(|check| check.passed() == Some(false));
        self.passport().ok_or_else(|| Refused { checks: failed.cloned().collect() })
    }
}

/// Returns a passport if every check that [`verify`] makes passed.
///
/// # Errors
/// Returns [`Refused`] with the checks that failed.
pub fn accept(name: &str, bytes: &[u8], trust: &Trust, question: &Question) -> Result<VerifiedPassport, Refused> {
    verify(name, bytes, trust, question).accepted()
}

/// Verifies the bytes of a passport; `name` is the file name used in messages.
///
/// Steps 1 to 3 are the check `grammar`, step 4 is `signature`, step 5 is `schema`, and step 6 is `signer`,
/// `revocation` and `in_force`. Every number is then recomputed, and the requirements of the question are compared. If
/// the signer is not trusted or the key is revoked, `recomputed`, `in_force` and these requirements are not checked.
pub fn verify(name: &str, bytes: &[u8], trust: &Trust, question: &Question) -> Verification {
    verify_known(name, bytes, None, trust, question)
}

/// Text that was hashed and read before it was signed; neither is done again for a file with the same text.
#[derive(Clone, Copy)]
pub(crate) struct Known<'a> {
    pub message: &'a Message<'a>,
    /// What the reader returns for the text.
    pub content: &'a Content,
}

/// Verifies a passport whose text may be known.
pub(crate) fn verify_known(
    name: &str,
    bytes: &[u8],
    known: Option<Known>,
    trust: &Trust,
    question: &Question,
) -> Verification {
    let mut run = Run { checks: Vec::new() };
    let (mut key, mut content) = (None, None);
    if let Some(text) = run.grammar(name, bytes) {
        key = Some(text.key().clone());
        if let Some(payload) = run.signature(&text, known.map(|known| known.message), trust) {
            content = run.schema(name, payload, known).map(Box::new);
            let counts = run.revocation(text.key(), trust);
            if let Some(content) = &content
                && run.signer(text.key(), content, trust)
                && counts
            {
                run.recomputed(content);
                run.in_force(content, question.time);
                run.asked(content, question);
            }
        }
    }
    Verification { checks: run.completed(question, trust), key, content, sha256: sha256_hex(bytes), register: None }
}

/// Creates the result for a file that could not be read; no check was run. `why` is the system's error message.
pub(crate) fn unreadable(why: &str, trust: &Trust, question: &Question) -> Verification {
    let mut run = Run { checks: Vec::new() };
    run.note(CheckName::Grammar, Code::Unreadable, why);
    Verification { checks: run.completed(question, trust), ..not_run() }
}

/// Creates the result for a passport that was not verified on request: no check was run.
pub(crate) fn not_run() -> Verification {
    let checks = CheckName::ALL.map(|name| Check::not_run(name, false, "the passport was not verified"));
    Verification { checks: checks.into(), key: None, content: None, sha256: String::new(), register: None }
}

/// Checks completed so far.
struct Run {
    checks: Vec<Check>,
}

impl Run {
    fn note(&mut self, name: CheckName, code: Code, detail: impl Display) {
        self.checks.push(Check::new(name, code, detail));
    }

    fn grammar<'a>(&mut self, name: &str, bytes: &'a [u8]) -> Option<SignedText<'a>> {
        let split = SignedText::split(name, bytes, &FORM);
        let good = "all programs read it alike; it ends with a signature";
        match &split {
            Ok(_) => self.note(CheckName::Grammar, Code::Ok, good),
            Err(malformed) => {
                let code = match malformed.signature.as_deref() {
                    Some(SignatureError::WrongNamespace { .. }) => Code::WrongNamespace,
                    Some(SignatureError::KeyType(_)) => Code::UnsupportedKey,
                    _ => Code::Malformed,
                };
                self.note(CheckName::Grammar, code, &malformed.fault);
            }
        }
        split.ok()
    }

    fn signature<'a>(&mut self, text: &SignedText<'a>, hashed: Option<&Message>, trust: &Trust) -> Option<&'a str> {
        let payload = text.signed_payload(Some(&trust.signers), hashed);
        let (code, detail) = match &payload {
            Ok(_) => (Code::Ok, format!("the text has not changed since {} signed it", text.key().fingerprint())),
            Err(error) => (Code::Altered, format!("{error}; get the file from the issuer again")),
        };
        self.note(CheckName::Signature, code, detail);
        payload.ok()
    }

    fn schema(&mut self, name: &str, payload: &str, known: Option<Known>) -> Option<Content> {
        let known = known.filter(|known| known.message.bytes == payload.as_bytes());
        let content = known.map_or_else(|| content::read(name, payload), |known| Ok(known.content.clone()));
        let (code, detail) = match &content {
            Ok(_) => (Code::Ok, format!("the content is complete and conforms to {PASSPORT_FORMAT}")),
            Err(error) if error.is_of_a_later_version() => (Code::NewerFormat, error.to_string()),
            Err(error) => (Code::BadContent, error.to_string()),
        };
        // The detail has one line for each error, so `Check::new`, which makes a single line, is not used.
        self.checks.push(Check { name: CheckName::Schema, code, detail });
        content.ok()
    }

    /// Returns `true` if the key is not revoked.
    fn revocation(&mut self, key: &PublicKey, trust: &Trust) -> bool {
        if let Some(why) = trust.revoked.iter().find_map(|list| list.revokes(key)) {
            let detail = format!("the signing key {} was revoked: {why}", key.fingerprint());
            self.note(CheckName::Revocation, Code::KeyRevoked, detail);
            return false;
        }
        if !trust.revoked.is_empty() {
            self.note(CheckName::Revocation, Code::Ok, "the signing key is not revoked");
        }
        true
    }

    /// Returns `true` if the key is that of the issuer.
    fn signer(&mut self, key: &PublicKey, content: &Content, trust: &Trust) -> bool {
        let (issuer, at) = (&content.passport.issuer, content.passport.issued_at);
        let Err(miss) = trust.signers.authorise(key, issuer, NAMESPACE, at) else {
            self.note(CheckName::Signer, Code::Ok, format!("the key belongs to {issuer}"));
            return true;
        };
        let code = match miss {
            NotAuthorised::UnknownKey => Code::UnknownKey,
            NotAuthorised::WrongPrincipal { .. } => Code::WrongPrincipal,
            NotAuthorised::WrongNamespace { .. } => Code::WrongNamespace,
            NotAuthorised::NotYetValid { .. } => Code::KeyNotYetValid,
            NotAuthorised::Expired { .. } => Code::KeyExpired,
        };
        let detail = miss.of_document(key, issuer, at);
        self.note(CheckName::Signer, code, detail);
        false
    }

    fn recomputed(&mut self, content: &Content) {
        let wrong = recomputed::compare(content);
        let Some((first, others)) = wrong.split_first() else {
            let detail = "all numbers, recomputed, agree with the signed deviations and site";
            return self.note(CheckName::Recomputed, Code::Ok, detail);
        };
        let more = if others.is_empty() { String::new() } else { format!(" (and {} more)", others.len()) };
        let detail = format!("the signature is correct, but {first}{more}; report this to the issuer");
        self.note(CheckName::Recomputed, Code::WrongNumber, detail);
    }

    fn in_force(&mut self, content: &Content, time: Timestamp) {
        let issued_at = content.passport.issued_at;
        let last = content.last_day();
        let (code, detail) = match last {
            _ if issued_at > time => {
                let advice = "check the clock, and --time if it is given";
                let detail = format!("issued at {issued_at}, later than the time of verification, {time}; {advice}");
                (Code::NotYetValid, detail)
            }
            // A passport is valid until the last second of its expiry date.
            Some((last, which)) if time.as_second() > day(last).1.as_second() => {
                let remedy = match which {
                    Dated::Certificate => "have the stand recertified",
                    Dated::Passport => REQUEST_FROM_THE_ISSUER,
                };
                let which = which.word();
                let until = format!("the {which} was valid until {last} (inclusive), verified as of {time}");
                (Code::Expired, format!("{until}; {remedy}"))
            }
            Some((last, which)) => {
                (Code::Ok, format!("issued {issued_at}; the {} is valid until {last} (inclusive)", which.word()))
            }
            None => {
                (Code::Ok, format!("issued {issued_at}; neither the passport nor the certificate has an expiry date"))
            }
        };
        self.note(CheckName::InForce, code, detail);
    }

    fn asked(&mut self, content: &Content, question: &Question) {
        if let Some(issuer) = &question.issuer {
            let found = &content.passport.issuer;
            let (code, detail) = match found == issuer {
                true => (Code::Ok, format!("issued by {found}")),
                false => {
                    let remedy = "check --issuer, or get the passport from that issuer";
                    (Code::WrongIssuer, format!("issued by {found}, not by {issuer}; {remedy}"))
                }
            };
            self.note(CheckName::Issuer, code, detail);
        }
        if let Some(serial) = &question.serial {
            let found = content.stand.serial.as_str();
            let stand = format!("the passport is for stand {} {found}", content.stand.model);
            let (code, detail) = if found == serial {
                (Code::Ok, stand)
            } else if only_the_serial(content.stand.model.as_str(), serial) == found {
                (Code::WrongStand, format!("{stand}; give only the serial number, {found}, not {serial:?}"))
            } else if serial.trim_start_matches('0') == found.trim_start_matches('0') {
                (Code::WrongStand, format!("{stand}, not {serial}; the zeros before a serial number are part of it"))
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

    /// Returns all checks in their order, including those that were not run or not requested. A register is not part of
    /// the question: its answer replaces [`CheckName::Register`].
    fn completed(mut self, question: &Question, trust: &Trust) -> Vec<Check> {
        let asked = |name| match name {
            CheckName::Revocation => !trust.revoked.is_empty(),
            CheckName::Issuer => question.issuer.is_some(),
            CheckName::Stand => question.serial.is_some(),
            CheckName::Place => question.place.is_some(),
            _ => false,
        };
        let missing = |name: &CheckName| !self.checks.iter().any(|check| check.name == *name);
        let missing: Vec<_> = CheckName::ALL.into_iter().filter(missing).collect();
        self.checks.extend(missing.iter().map(|name| Check::not_run(*name, asked(*name), "an earlier check failed")));
        self.checks.sort_by_key(|check| check.name);
        self.checks
    }
}

/// Returns `given` without spaces around it and without the model of the stand before the serial number.
fn only_the_serial<'a>(model: &str, given: &'a str) -> &'a str {
    let given = given.trim();
    let after_model = given.strip_prefix(model).and_then(|rest| rest.strip_prefix(['/', ' ', '-', '_', ':']));
    after_model.map_or(given, str::trim_start)
}
