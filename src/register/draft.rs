//! The next register of a stand: entries are added, states end, and nothing is taken back.

use super::{
    Entry, FORM, FORMAT, LONGEST_REASON, MOST_ENTRIES, REGISTER_NAMESPACE, Register, RegisterHeader, RegisterRefused,
    State, VerifiedRegister,
};
use crate::document::{self, Signer, SigningFailed};
use crate::passport::{Content, Trust};
use crate::text::record::OneLine;
use crate::text::rule;
use crate::trust::{BadIdentity, SignatureError, check_identity};
use jiff::Timestamp;
use jiff::civil::Date;
use std::collections::HashMap;

/// Space for the signature, in bytes; signatures of tokens, which are the longest, need 500.
const SIGNATURE_BYTES: usize = 1024;

/// Reason why no register was written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoRegister {
    /// The change or the clock breaks a rule of registers, in words.
    #[error("{0}")]
    Rule(String),
    /// The issuer's name cannot be a principal of allowed_signers.
    #[error(transparent)]
    Identity(#[from] BadIdentity),
    /// The new register failed verification.
    #[error("the new register failed verification ({0}); check the keys, --identity and --trust")]
    Refused(#[from] RegisterRefused),
    /// The signer produced no signature.
    #[error(transparent)]
    Signing(#[from] SigningFailed),
    /// The signer produced a wrong signature.
    #[error("verification of the new signature failed: {0}")]
    BadSignature(#[from] SignatureError),
}

/// Register to be issued.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Draft {
    header: RegisterHeader,
    entries: Vec<Entry>,
    /// Place of each entry, by the identifier of its passport.
    places: HashMap<String, usize>,
    /// Last revision of each site.
    last: HashMap<String, u32>,
    previous_issued_at: Option<Timestamp>,
}

impl Draft {
    /// Creates the register of a stand, `<model>/<serial>`, that follows `previous`, or the first one. `now` is the time of
    /// its issue.
    pub(crate) fn after(previous: Option<&VerifiedRegister>, stand: &str, issuer: &str, now: Timestamp) -> Self {
        let before = previous.map(VerifiedRegister::header);
        let header = RegisterHeader {
            stand: stand.to_owned(),
            sequence: before.map_or(1, |before| before.sequence.saturating_add(1)),
            previous_sha256: previous.map(|previous| previous.sha256().to_owned()),
            issued_at: Timestamp::from_second(now.as_second()).unwrap_or(now),
            fresh_until: before.and_then(|before| before.fresh_until),
            issuer: issuer.to_owned(),
            issued_with: Some(concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION")).to_owned()),
        };
        let entries = previous.map_or_else(Vec::new, |previous| previous.entries().to_vec());
        let (places, last, previous_issued_at) =
            (HashMap::new(), HashMap::new(), before.map(|before| before.issued_at));
        let mut draft = Self { header, entries: Vec::new(), places, last, previous_issued_at };
        draft.set(entries);
        draft
    }

    fn set(&mut self, entries: Vec<Entry>) {
        self.places = entries.iter().map(|entry| entry.id.clone()).zip(0..).collect();
        // Ascending revisions: the last one remains.
        self.last = entries.iter().map(Entry::site_and_revision).map(|(site, last)| (site.to_owned(), last)).collect();
        self.entries = entries;
    }

    pub(crate) fn entries(&self) -> &[Entry] {
        &self.entries
    }

    pub(crate) fn sequence(&self) -> u64 {
        self.header.sequence
    }

    /// Sets the last day of freshness (inclusive), or none.
    pub(crate) fn fresh_until(&mut self, last: Option<Date>) {
        self.header.fresh_until = last;
    }

    /// Sets a higher sequence number than the next one.
    pub(crate) fn at_least(&mut self, sequence: u64) {
        self.header.sequence = self.header.sequence.max(sequence);
    }

    /// Returns the entry of a passport that is issued now.
    pub(crate) fn entry_of(content: &Content, sha256: &str) -> Entry {
        Entry {
            id: content.passport.id.clone(),
            sha256: sha256.to_owned(),
            issued_at: content.passport.issued_at,
            certificate: content.certificate.number.clone(),
            valid_until: content.last_day().map(|(last, _)| last),
            state: State::Current,
            since: None,
            by: None,
            reason: None,
        }
    }

    pub(crate) fn entry(&self, id: &str) -> Option<&Entry> {
        self.entries.get(*self.places.get(id)?)
    }

    fn entry_mut(&mut self, id: &str) -> Option<&mut Entry> {
        self.entries.get_mut(*self.places.get(id)?)
    }

    /// Adds a passport, unless it is listed as current already. It supersedes the current one for its site.
    ///
    /// # Errors
    /// Returns [`NoRegister`] if its identifier is listed for another file, or in an ended state.
    pub(crate) fn add(&mut self, entry: Entry) -> Result<(), NoRegister> {
        match self.entry_mut(&entry.id) {
            Some(there) if there.sha256 == entry.sha256 && there.state == State::Current => Ok(()),
            Some(there) => {
                let file = if there.sha256 == entry.sha256 { "this file" } else { "another file" };
                Err(listed(there, file))
            }
            None => {
                let (site, revision) = entry.site_and_revision();
                let last = self.last.insert(site.to_owned(), revision);
                if let Some(last) = last.filter(|last| *last >= revision) {
                    let id = &entry.id;
                    return Err(NoRegister::Rule(format!("{id}: cannot be listed after revision {last} for its site")));
                }
                let before = last.map(|last| format!("{}/{site}/{last}", self.header.stand));
                let id = entry.id.clone();
                self.places.insert(id.clone(), self.entries.len());
                self.entries.push(entry);
                match before.filter(|before| self.entry(before).is_some_and(|entry| entry.state == State::Current)) {
                    Some(before) => self.supersede(&before, &id, State::Superseded),
                    None => Ok(()),
                }
            }
        }
    }

    /// Ends the passport `id`, which `by` supersedes. One that is not listed, or withdrawn, stays as it is.
    ///
    /// # Errors
    /// Returns [`NoRegister`] if another passport supersedes it.
    pub(crate) fn supersede(&mut self, id: &str, by: &str, state: State) -> Result<(), NoRegister> {
        let since = Some(self.header.issued_at);
        match self.entry_mut(id) {
            Some(entry) if entry.state == State::Current => {
                *entry = Entry { state, since, by: Some(by.to_owned()), ..entry.clone() };
                Ok(())
            }
            Some(Entry { id, by: Some(other), .. }) if other != by => {
                Err(NoRegister::Rule(format!("{id}: superseded by {other} already; re-issue that passport")))
            }
            _ => Ok(()),
        }
    }

    /// Withdraws the passport `id`, whatever its state.
    ///
    /// # Errors
    /// Returns [`NoRegister`] if it is not listed, already withdrawn, or the reason cannot be signed.
    pub(crate) fn withdraw(&mut self, id: &str, reason: &str) -> Result<(), NoRegister> {
        let fits = (1..=LONGEST_REASON).contains(&reason.chars().count());
        if !fits || !reason.chars().all(rule::allowed_in_string) {
            return Err(NoRegister::Rule(format!(
                "the reason {reason:?} is empty, longer than {LONGEST_REASON} characters, or contains a character that is \
                 not allowed in signed files; state it in plain words"
            )));
        }
        let since = self.header.issued_at;
        let not_listed = || NoRegister::Rule(format!("{id}: not listed in the register"));
        let entry = self.entry_mut(id).ok_or_else(not_listed)?;
        if let (State::Withdrawn, Some(since), Some(reason)) = (entry.state, entry.since, &entry.reason) {
            return Err(NoRegister::Rule(format!("{id}: already withdrawn at {since}: {reason}")));
        }
        let reason = Some(reason.to_owned());
        *entry = Entry { state: State::Withdrawn, since: Some(since), by: None, reason, ..entry.clone() };
        Ok(())
    }

    /// Takes entries, freshness and number from a draft that was made from the same register.
    ///
    /// # Errors
    /// Returns [`NoRegister`] if that draft follows another register, whose later entries it would lose.
    pub(crate) fn take_from(&mut self, other: Self) -> Result<(), NoRegister> {
        if self.header.previous_sha256 != other.header.previous_sha256 {
            let words = "another run has replaced the register meanwhile; run the command again";
            return Err(NoRegister::Rule(words.to_owned()));
        }
        self.header.fresh_until = other.header.fresh_until;
        self.header.sequence = self.header.sequence.max(other.header.sequence);
        self.previous_issued_at = self.previous_issued_at.max(other.previous_issued_at);
        self.set(other.entries);
        Ok(())
    }

    /// Adds the entries of another register of the same stand, and the stricter state of each.
    ///
    /// # Errors
    /// Returns [`NoRegister`] if both list one identifier with different files.
    pub(crate) fn join(&mut self, other: &VerifiedRegister) -> Result<(), NoRegister> {
        let theirs: HashMap<&str, usize> = other.entries().iter().map(|entry| entry.id.as_str()).zip(0..).collect();
        let (mut joined, mut next) = (Vec::new(), 0);
        for ours in std::mem::take(&mut self.entries) {
            let Some(&place) = theirs.get(ours.id.as_str()) else {
                joined.push(ours);
                continue;
            };
            // What the other register lists before a common entry stays before it, so that both orders are kept.
            joined.extend(other.entries()[next.min(place)..place].iter().cloned());
            next = place + 1;
            let other = &other.entries()[place];
            if other.sha256 != ours.sha256 {
                return Err(listed(&ours, "another file"));
            }
            joined.push(if other.state > ours.state { other.clone() } else { ours });
        }
        joined.extend(other.entries()[next..].iter().cloned());
        self.set(joined);
        self.at_least(other.header().sequence.saturating_add(1));
        self.previous_issued_at = self.previous_issued_at.max(Some(other.header().issued_at));
        Ok(())
    }

    /// Signs the register and verifies it with `trust`, because a register that its recipients cannot verify would make
    /// every passport of the stand unusable. Returns the whole file, and the register.
    ///
    /// # Errors
    /// Returns [`NoRegister`] if a time or the size breaks a rule, or the signature cannot be made or verified.
    pub(crate) fn sign(
        self,
        name: &str,
        signer: &dyn Signer,
        trust: &Trust,
    ) -> Result<(String, VerifiedRegister), NoRegister> {
        check_identity(&self.header.issuer)?;
        let now = self.header.issued_at;
        let of_register = self.previous_issued_at.map(|at| ("the register before it", at));
        let of_entries = self.entries.iter().map(|entry| (entry.id.as_str(), entry.issued_at));
        if let Some((of, at)) = of_register.into_iter().chain(of_entries).find(|(_, at)| *at > now) {
            return Err(NoRegister::Rule(format!(
                "the register would be issued at {now}, before {of}, issued at {at}; check the clock"
            )));
        }
        let entries = self.entries.len();
        let (format, register) = (FORMAT.to_owned(), OneLine(self.header));
        let payload = Register { format, register, passports: self.entries }.payload();
        let bytes = payload.len() + SIGNATURE_BYTES;
        if entries > MOST_ENTRIES || bytes > FORM.limits.bytes {
            return Err(NoRegister::Rule(format!(
                "the register would have {entries} entries and {bytes} bytes, more than {MOST_ENTRIES} or {}",
                FORM.limits.bytes
            )));
        }
        let text: String = document::sign::<NoRegister>(&payload, REGISTER_NAMESPACE, signer)?;
        let verified = VerifiedRegister::verify(name, text.as_bytes(), trust, now)?;
        Ok((text, verified))
    }
}

/// Returns the refusal of an entry that is listed already.
fn listed(entry: &Entry, file: &str) -> NoRegister {
    NoRegister::Rule(format!("{}: listed in the register as {}, with {file}", entry.id, entry.state.key()))
}
