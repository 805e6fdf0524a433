//! Register of a stand (`dtg-register/1`): the signed list of every passport ever issued for it, with its state.
//!
//! A passport says what the stand is; the register says which passport counts. It is written and signed like a passport,
//! in a namespace of its own, and a later register only adds entries and ends states: it never takes anything back.
//!
//! * [`content`](Register): records, and the rules of their order.
//! * `answer`: what a register says of one passport.
//! * `succession`: whether one register continues another.
//! * `draft`: the next register of a stand.
//! * `row`: an entry beside its file.

mod answer;
#[cfg(feature = "factory")]
pub(crate) mod draft;
#[cfg(feature = "factory")]
mod row;
mod succession;

pub use answer::Doubt;
#[cfg(feature = "factory")]
pub use draft::NoRegister;
#[cfg(feature = "factory")]
pub(crate) use row::{Row, days_until};
pub use succession::Contradiction;

use crate::document::{self, Form, SignedText, sha256_hex};
use crate::passport::Trust;
use crate::text::record::{LARGEST_EXACT_INTEGER, OneLine};
use crate::text::scalar::identifiers;
use crate::text::{Identifier, Limits, Path, Printable, Problems, Unreadable, canonical, record, word_of_a_key, words};
use crate::trust::{NotAuthorised, PublicKey};
use jiff::civil::Date;
use jiff::{SignedDuration, Timestamp};
use std::collections::{HashMap, HashSet};

/// Namespace of the signatures of registers.
pub const REGISTER_NAMESPACE: &str = "dtg-register";

/// Name of a register in the folder of its stand.
pub(crate) const FILE_NAME: &str = "register.yaml";

pub(crate) const FORMAT: &str = "dtg-register/1";

/// Form of registers as signed documents. The memory that a register takes follows from its size alone.
pub(crate) const FORM: Form = Form {
    namespace: REGISTER_NAMESPACE,
    format: FORMAT,
    limits: Limits { bytes: 16 << 20, brackets: usize::MAX },
    expected: "a register, which `issue` writes beside the passports of a stand",
};

/// Largest number of entries.
const MOST_ENTRIES: usize = 50_000;

/// Largest number of characters in the reason of a withdrawal.
const LONGEST_REASON: usize = 500;

/// Time by which the issuer's clock may be ahead of the reader's.
const CLOCKS_DIFFER: SignedDuration = SignedDuration::from_hours(24);

words! {
    /// State of a passport in the register of its stand.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
    #[serde(rename_all = "snake_case")]
    #[cfg_attr(feature = "generate", derive(schemars::JsonSchema), schemars(rename_all = "snake_case"))]
    #[non_exhaustive]
    pub enum State: pub key {
        /// Neither superseded nor withdrawn.
        Current = "current",
        /// Superseded by a passport for the same site.
        Superseded = "superseded",
        /// Superseded, because the stand has left the site.
        Moved = "moved",
        /// Withdrawn by the factory.
        Withdrawn = "withdrawn",
    }
}

word_of_a_key!(State, key, "");

record! {
    /// Identity, sequence and time of a register.
    #[derive(Eq)]
    pub struct RegisterHeader {
        /// Stand, `<model>/<serial>`.
        pub stand: String,
        /// Sequence number, from 1, increasing.
        pub sequence: u64,
        /// SHA-256 of the previous file; absent in the first one.
        pub previous_sha256: Option<String>,
        /// Time of issue.
        pub issued_at: Timestamp,
        /// Last day on which the register is fresh; for ever if absent.
        pub fresh_until: Option<Date>,
        /// Issuer: a principal of allowed_signers.
        pub issuer: String,
        /// Program and version.
        pub issued_with: Option<String>,
    }
}

record! {
    /// Passport in a register.
    #[derive(Eq)]
    pub struct Entry {
        /// Identifier of the passport.
        pub id: String,
        /// SHA-256 of the whole file.
        pub sha256: String,
        /// Time of issue of the passport.
        pub issued_at: Timestamp,
        /// Number of the certificate of the stand.
        pub certificate: String,
        /// Expiry date (inclusive) of passport or certificate, if any.
        pub valid_until: Option<Date>,
        /// State of the passport.
        pub state: State,
        /// Time of the change of state.
        pub since: Option<Timestamp>,
        /// Identifier of the successor.
        pub by: Option<String>,
        /// Reason for the withdrawal.
        pub reason: Option<String>,
    }
}

record! {
    /// Register of a stand; keys in the order of the file.
    #[derive(Eq)]
    pub struct Register {
        /// Always "dtg-register/1".
        pub format: String,
        /// Identity, sequence and time of the register.
        pub register: OneLine<RegisterHeader>,
        /// Passports, in the order of listing.
        pub passports: Vec<Entry>,
    }
}

/// Register whose form, signature, content and signer were verified.
#[derive(Debug, Clone, PartialEq)]
pub struct VerifiedRegister {
    content: Register,
    sha256: String,
    key: PublicKey,
    /// Place of each entry, by the identifier of its passport.
    places: HashMap<String, usize>,
}

/// Reason why a register is not accepted, in words that begin with the name of its file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RegisterRefused {
    /// There is no file of this name.
    #[error("{0}: missing; get the register of the stand from the issuer, or restore it from the backup")]
    Missing(String),
    /// The file cannot be read, was altered, breaks a rule, or is dated more than a day ahead of the clock.
    #[error("{0}")]
    Unreadable(String),
    /// The key is not trusted for registers of the issuer.
    #[error("{0}")]
    NotAuthorised(String),
    /// The signing key was revoked.
    #[error("{0}")]
    KeyRevoked(String),
}

impl Entry {
    /// Returns the site and the revision, the last two parts of the identifier.
    pub(crate) fn site_and_revision(&self) -> (&str, u32) {
        let (series, revision) = self.id.rsplit_once('/').unwrap_or((&self.id, ""));
        (series.rsplit_once('/').map_or("", |(_, site)| site), revision.parse().unwrap_or(0))
    }

    /// Returns how a passport that is not in force has ended, in words.
    pub(crate) fn ended(&self) -> String {
        let since = self.since.map_or_else(String::new, |since| format!(" since {since}"));
        match (&self.by, &self.reason, self.valid_until) {
            (Some(by), ..) => format!("{}{since} by {by}", self.state.key()),
            (None, Some(reason), _) => format!("{}{since}: {reason}", self.state.key()),
            (None, None, Some(last)) => format!("expired valid until {last} (inclusive)"),
            (None, None, None) => self.state.key().to_owned(),
        }
    }

    /// Returns `true` if the passport has expired at `time`.
    pub(crate) fn is_expired(&self, time: Timestamp) -> bool {
        self.valid_until.is_some_and(|last| is_past(last, time))
    }
}

/// Returns `true` if `time` is after the last second of a day.
fn is_past(last: Date, time: Timestamp) -> bool {
    time.as_second() > crate::text::scalar::day(last).1.as_second()
}

impl Register {
    /// Returns identity, sequence and time of the register.
    pub(crate) fn header(&self) -> &RegisterHeader {
        &self.register.0
    }

    /// Parses the content of a register without verifying its signature: anyone may have written it.
    pub(crate) fn from_anyone(name: &str, bytes: &[u8]) -> Result<Self, Unreadable> {
        let text = SignedText::split(name, bytes, &FORM).map_err(|malformed| malformed.fault)?;
        document::parse(name, text.unverified_payload(), &FORM, Self::check)
    }

    /// Returns the text to be signed.
    pub(crate) fn payload(&self) -> String {
        let comments = |path: &str| match path {
            "format" => vec![
                "Which passports of this stand count. A later register replaces this one.".to_owned(),
                "Signed verbatim: any change makes the signature invalid.".to_owned(),
            ],
            _ => Vec::new(),
        };
        canonical::write(self, &comments)
    }

    fn check(&self, problems: &mut Problems) {
        let (at, header) = (Path::Root, self.header());
        if self.format != FORMAT {
            problems.at(&at.key("format"), format!("{:?}", self.format), format!("{FORMAT:?}"), "");
        }
        let of_header = at.key("register");
        if identifiers::<2>(&header.stand).is_none() {
            problems.at(&of_header.key("stand"), format!("{:?}", header.stand), "<model>/<serial>", "");
        }
        if header.sequence == 0 {
            let expected = format!("a whole number from 1 to {LARGEST_EXACT_INTEGER}");
            problems.at(&of_header.key("sequence"), "0", expected, "");
        }
        let previous = of_header.key("previous_sha256");
        match &header.previous_sha256 {
            Some(sha256) if header.sequence > 1 => problems.sha256(&previous, sha256),
            Some(_) => problems.at(&previous, "a SHA-256", "none in the first register of a stand", ""),
            None if header.sequence > 1 => problems.missing(&of_header, "previous_sha256", "a SHA-256", ""),
            None => {}
        }
        let entries = at.key("passports");
        if self.passports.is_empty() || self.passports.len() > MOST_ENTRIES {
            let found = format!("{} entries", self.passports.len());
            return problems.at(&entries, found, format!("1 to {MOST_ENTRIES}"), "");
        }
        let ids: HashSet<&str> = self.passports.iter().map(|entry| entry.id.as_str()).collect();
        let mut known = Known { ids: HashSet::new(), files: HashSet::new(), last: HashMap::new() };
        for (index, entry) in self.passports.iter().enumerate() {
            if problems.is_full() {
                return;
            }
            self.check_entry(entry, &entries.item(index), &mut known, &ids, problems);
        }
    }

    fn check_entry<'a>(
        &self,
        entry: &'a Entry,
        at: &Path,
        known: &mut Known<'a>,
        ids: &HashSet<&str>,
        problems: &mut Problems,
    ) {
        let header = self.header();
        let mut refuse = |key: &'static str, found: String, expected: String| {
            problems.at(&at.key(key), found, expected, "");
        };
        let (site, revision) = entry.site_and_revision();
        if Identifier::new(site).is_err() || revision == 0 || entry.id != format!("{}/{site}/{revision}", header.stand)
        {
            return refuse("id", format!("{:?}", entry.id), format!("{}/<site>/<revision>", header.stand));
        }
        if !known.ids.insert(&entry.id) {
            refuse("id", format!("{:?} twice", entry.id), "each passport once".to_owned());
        }
        if !known.files.insert(&entry.sha256) {
            refuse("sha256", "a SHA-256 twice".to_owned(), "each file once".to_owned());
        }
        let last = known.last.insert(site, revision).unwrap_or(0);
        if last >= revision {
            refuse("id", format!("revision {revision} after {last}"), "ascending revisions of a site".to_owned());
        }
        let until = header.issued_at;
        for (key, time, from) in
            [("issued_at", Some(entry.issued_at), Timestamp::MIN), ("since", entry.since, entry.issued_at)]
        {
            if let Some(time) = time.filter(|time| *time < from || *time > until) {
                let from = if key == "since" { format!("from {from}, when it was issued, ") } else { String::new() };
                refuse(key, time.to_string(), format!("a time {from}until {until}, when the register was issued"));
            }
        }
        let (since, by, reason) = match entry.state {
            State::Current => (false, false, false),
            State::Superseded | State::Moved => (true, true, false),
            State::Withdrawn => (true, false, true),
        };
        for (key, is_there, due) in [
            ("since", entry.since.is_some(), since),
            ("by", entry.by.is_some(), by),
            ("reason", entry.reason.is_some(), reason),
        ] {
            if is_there != due {
                let word = |is: bool| if is { key.to_owned() } else { format!("no {key}") };
                refuse(key, word(is_there), format!("{} of a {} passport", word(due), entry.state.key()));
            }
        }
        if let Some(by) = entry.by.as_deref().filter(|by| *by == entry.id || !ids.contains(by)) {
            refuse("by", format!("{by:?}"), "another passport of this register".to_owned());
        }
        let length = entry.reason.as_ref().map_or(0, |reason| reason.chars().count());
        if length > LONGEST_REASON {
            refuse("reason", format!("{length} characters"), format!("at most {LONGEST_REASON}"));
        }
        problems.sha256(&at.key("sha256"), &entry.sha256);
    }
}

/// Entries that were checked.
struct Known<'a> {
    ids: HashSet<&'a str>,
    files: HashSet<&'a str>,
    /// Last revision of each site.
    last: HashMap<&'a str, u32>,
}

impl VerifiedRegister {
    /// Verifies the bytes of a register in the same way as those of a passport; `name` is the file name in messages.
    ///
    /// The key must be trusted for registers of the issuer both when the register was issued and `now`, and must not be
    /// revoked.
    ///
    /// # Errors
    /// Returns [`RegisterRefused`] with the first check that failed.
    pub fn verify(name: &str, bytes: &[u8], trust: &Trust, now: Timestamp) -> Result<Self, RegisterRefused> {
        let register = Self::take_over(name, bytes, trust)?;
        let (key, header) = (register.key(), register.header());
        Self::check_key(name, key, &header.issuer, trust, now)?;
        if header.issued_at.duration_since(now) > CLOCKS_DIFFER {
            let (name, issued_at) = (Printable(name), header.issued_at);
            let why = format!("{name}: issued at {issued_at}, ahead of the clock, {now}; check the clock");
            return Err(RegisterRefused::Unreadable(why));
        }
        Ok(register)
    }

    /// Checks that a key may sign registers of an issuer now.
    pub(crate) fn check_key(
        name: &str,
        key: &PublicKey,
        issuer: &str,
        trust: &Trust,
        now: Timestamp,
    ) -> Result<(), RegisterRefused> {
        if let Some(why) = trust.revoked.iter().find_map(|keys| keys.revokes(key)) {
            let (name, key, why) = (Printable(name), key.fingerprint(), Printable(why));
            return Err(RegisterRefused::KeyRevoked(format!("{name}: its signing key {key} was revoked: {why}")));
        }
        RegisterRefused::unless_authorised(name, trust, key, issuer, now)
    }

    /// Verifies the bytes of a register that a person takes over, although its key has expired or was revoked since.
    ///
    /// # Errors
    /// Returns [`RegisterRefused`] if the register is damaged, or if allowed_signers does not give its key to its issuer.
    pub(crate) fn take_over(name: &str, bytes: &[u8], trust: &Trust) -> Result<Self, RegisterRefused> {
        let malformed = |unreadable: Unreadable| RegisterRefused::Unreadable(unreadable.to_string());
        let text = SignedText::split(name, bytes, &FORM).map_err(|refused| malformed(refused.fault))?;
        let payload = text.signed_payload(Some(&trust.signers), None).map_err(|error| {
            let advice = "restore the register, or get it from the issuer again";
            RegisterRefused::Unreadable(format!("{}: {error}; {advice}", Printable(name)))
        })?;
        let content: Register = document::parse(name, payload, &FORM, Register::check).map_err(malformed)?;
        let (key, header) = (text.key(), content.header());
        RegisterRefused::unless_authorised(name, trust, key, &header.issuer, header.issued_at)?;
        let places = content.passports.iter().map(|entry| entry.id.clone()).zip(0..).collect();
        Ok(Self { key: key.clone(), sha256: sha256_hex(bytes), places, content })
    }

    /// Returns the content of the register.
    pub fn content(&self) -> &Register {
        &self.content
    }

    /// Returns identity, sequence and time of the register.
    pub fn header(&self) -> &RegisterHeader {
        self.content.header()
    }

    /// Returns the entries, in the order in which they were listed.
    pub fn entries(&self) -> &[Entry] {
        &self.content.passports
    }

    /// Returns the SHA-256 of the whole file, in lower-case hexadecimal.
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// Returns the key that signed the register.
    pub fn key(&self) -> &PublicKey {
        &self.key
    }

    /// Returns the entry of the passport with this identifier, or `None` if it is not listed.
    pub fn entry(&self, id: &str) -> Option<&Entry> {
        self.entries().get(*self.places.get(id)?)
    }

    /// Returns `true` if the register is no longer fresh at `time`.
    pub(crate) fn is_stale(&self, time: Timestamp) -> bool {
        self.header().fresh_until.is_some_and(|last| is_past(last, time))
    }
}

impl RegisterRefused {
    /// Checks that `trust` gives a key to the issuer for registers at a time. The refusal has the line that allowed_signers
    /// needs, if the key lacks this purpose only.
    pub(crate) fn unless_authorised(
        name: &str,
        trust: &Trust,
        key: &PublicKey,
        issuer: &str,
        at: Timestamp,
    ) -> Result<(), Self> {
        let Err(miss) = trust.signers.authorise(key, issuer, REGISTER_NAMESPACE, at) else { return Ok(()) };
        let mut why = miss.of_document(key, issuer, at);
        if let NotAuthorised::WrongNamespace(allowed) = miss {
            let line = format!("{issuer} namespaces=\"{allowed},{REGISTER_NAMESPACE}\" {}", key.to_openssh());
            why += &format!("; if this key may sign registers, change its line in allowed_signers to: {line}");
        }
        Err(Self::NotAuthorised(format!("{}: {why}", Printable(name))))
    }
}
