//! The list of withdrawn passports (`dtg-revocation/1`): signed like a passport, in a namespace of its own.
//!
//! A revoked key and a revoked passport are different things: the first no longer speaks for anybody, the second was a
//! mistake of an issuer whose key is still good.

use crate::document::{self, Malformed, SignedText, Signer, SigningFailed};
use crate::text::problem::Unreadable;
use crate::text::{Path, Printable, Problems, canonical, record, rule};
use crate::trust::{AllowedSigners, Message, NotAuthorised, RevokedKeys, SignatureError};
use jiff::Timestamp;
use std::collections::BTreeSet;

/// The format of a list.
pub const REVOCATION_FORMAT: &str = "dtg-revocation/1";

/// Whether a file says that it is such a list.
pub fn claims_to_be_a_list(bytes: &[u8]) -> bool {
    let claim = b"format: \"dtg-revocation/";
    bytes.windows(claim.len()).any(|window| window == claim)
}

/// The namespace that lists are signed for.
pub const REVOCATION_NAMESPACE: &str = "dtg-revocation";

record! {
    /// A withdrawn passport.
    #[derive(Eq, PartialOrd, Ord)]
    pub struct Entry {
        /// Its id.
        pub id: String,
        /// SHA-256 of its file, lower-case hexadecimal.
        pub sha256: String,
        /// When it was withdrawn.
        pub revoked_at: Timestamp,
        /// Why.
        pub reason: String,
    }
}

record! {
    /// A list of withdrawn passports. Of several the one with the highest sequence number counts.
    pub struct RevocationList {
        /// Always "dtg-revocation/1".
        pub format: String,
        /// Counts from 1 and only grows.
        pub sequence: u32,
        /// When it was issued; never before an earlier list.
        pub issued_at: Timestamp,
        /// Who issued it: a principal of allowed_signers.
        pub issuer: String,
        /// Every passport withdrawn so far.
        pub entries: Vec<Entry>,
    }
}

/// Why a list does not count.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ListRefused {
    /// Its form is not good.
    #[error("{}", .0.fault)]
    Malformed(Malformed),
    /// The text is not the one that was signed.
    #[error("{}: {error}", Printable(name))]
    Altered {
        /// The file.
        name: String,
        /// What is wrong.
        error: SignatureError,
    },
    /// Its content breaks a rule.
    #[error(transparent)]
    Content(#[from] Unreadable),
    /// Its key does not count for its issuer.
    #[error("{}: {miss}", Printable(name))]
    NotAuthorised {
        /// The file.
        name: String,
        /// Why.
        miss: NotAuthorised,
    },
    /// Its key was revoked.
    #[error("{}: its signing key was revoked: {}", Printable(name), Printable(why))]
    KeyRevoked {
        /// The file.
        name: String,
        /// Why.
        why: String,
    },
    /// It was issued later than now.
    #[error("{}: issued at {issued_at}, which is after {now}: is the clock right?", Printable(name))]
    FromTheFuture {
        /// The file.
        name: String,
        /// When it says it was issued.
        issued_at: Timestamp,
        /// The time asked about.
        now: Timestamp,
    },
}

/// Why no new list was made.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoNewList {
    /// The passport is on the list already.
    #[error("{id}: was withdrawn already, at {revoked_at}: {}", Printable(reason))]
    AlreadyRevoked {
        /// The passport.
        id: String,
        /// When.
        revoked_at: Timestamp,
        /// Why.
        reason: String,
    },
    /// The new list would be older than the last.
    #[error("the new list would be issued at {now}, before the last one, {last}: is the clock right?")]
    BeforeLast {
        /// When it would be issued.
        now: Timestamp,
        /// When the last one was.
        last: Timestamp,
    },
    /// A text that cannot be signed.
    #[error("{0:?} is empty or holds a character that no signed text may hold")]
    BadText(String),
    /// The signer gave no signature.
    #[error(transparent)]
    Signing(#[from] SigningFailed),
    /// The signer gave a signature that does not hold.
    #[error("the signature just made does not hold: {0}")]
    BadSignature(#[from] SignatureError),
}

impl ListRefused {
    /// Returns `true` if the file is no whole list (steps 1 to 5), so that nobody can tell what it withdraws; `false` if it
    /// is one that does not count.
    pub fn is_damage(&self) -> bool {
        matches!(self, Self::Malformed(_) | Self::Altered { .. } | Self::Content(_))
    }
}

impl std::fmt::Display for Entry {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{} was withdrawn at {}: {}", self.id, self.revoked_at, self.reason)
    }
}

impl RevocationList {
    /// Verifies the bytes of a list as those of a passport are verified, and reads it.
    ///
    /// # Errors
    /// See [`ListRefused`].
    pub fn verify(
        name: &str,
        bytes: &[u8],
        signers: &AllowedSigners,
        revoked_keys: &[RevokedKeys],
        now: Timestamp,
    ) -> Result<Self, ListRefused> {
        let text = SignedText::split(name, bytes, REVOCATION_NAMESPACE).map_err(ListRefused::Malformed)?;
        let name = name.to_owned();
        let payload = match text.signed_payload() {
            Ok(payload) => payload,
            Err(error) => return Err(ListRefused::Altered { name, error }),
        };
        let list: Self = document::parse(&name, payload, Self::check)?;
        if let Err(miss) = signers.authorise(text.key(), &list.issuer, REVOCATION_NAMESPACE, list.issued_at) {
            return Err(ListRefused::NotAuthorised { name, miss });
        }
        if let Some(why) = revoked_keys.iter().find_map(|keys| keys.revokes(text.key())) {
            return Err(ListRefused::KeyRevoked { name, why });
        }
        if list.issued_at > now {
            return Err(ListRefused::FromTheFuture { name, issued_at: list.issued_at, now });
        }
        Ok(list)
    }

    fn check(&self, problems: &mut Problems) {
        let at = Path::Root;
        if self.format != REVOCATION_FORMAT {
            problems.at(&at.key("format"), format!("{:?}", self.format), format!("{REVOCATION_FORMAT:?}"), "");
        }
        if self.sequence == 0 {
            problems.at(&at.key("sequence"), "0", "a whole number from 1", "");
        }
        let entries = at.key("entries");
        for (index, entry) in self.entries.iter().enumerate() {
            let at = entries.item(index);
            if !document::is_sha256_hex(&entry.sha256) {
                let expected = "64 lower-case hexadecimal digits";
                problems.at(&at.key("sha256"), format!("{:?}", entry.sha256), expected, "");
            }
        }
    }

    /// Returns the entry of a passport by the SHA-256 of its file, or `None` if it is not withdrawn. Another file of the
    /// same id is another passport: of two, one can be withdrawn and the other one stay.
    pub fn entry(&self, sha256: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.sha256 == sha256)
    }

    /// Whether every entry of `other` is in it.
    fn has_all_of(&self, other: &Self) -> bool {
        let own: BTreeSet<&Entry> = self.entries.iter().collect();
        other.entries.iter().all(|entry| own.contains(entry))
    }

    /// The name of its file. Of a list under another name somebody may want to be believed that it is newer.
    pub fn file_name(&self) -> String {
        format!("revocation-{}.yaml", self.sequence)
    }

    /// The list that follows `last`: its entries, and these; `None` begins a new series.
    ///
    /// # Errors
    /// See [`NoNewList`].
    pub fn following(last: Option<&Self>, issuer: &str, now: Timestamp, new: Vec<Entry>) -> Result<Self, NoNewList> {
        let texts = new.iter().flat_map(|entry| [&entry.id, &entry.reason]).map(String::as_str).chain([issuer]);
        for text in texts {
            if text.is_empty() || !text.chars().all(rule::allowed_in_string) {
                return Err(NoNewList::BadText(text.to_owned()));
            }
        }
        let mut entries = last.map(|list| list.entries.clone()).unwrap_or_default();
        for entry in new {
            if let Some(there) = entries.iter().find(|there| there.sha256 == entry.sha256) {
                let Entry { id, revoked_at, reason, .. } = there.clone();
                return Err(NoNewList::AlreadyRevoked { id, revoked_at, reason });
            }
            entries.push(entry);
        }
        if let Some(last) = last.filter(|last| last.issued_at > now) {
            return Err(NoNewList::BeforeLast { now, last: last.issued_at });
        }
        let sequence = last.map_or(1, |last| last.sequence.saturating_add(1));
        let (format, issuer) = (REVOCATION_FORMAT.to_owned(), issuer.to_owned());
        Ok(Self { format, sequence, issued_at: now, issuer, entries })
    }

    /// The signed file.
    ///
    /// # Errors
    /// [`NoNewList::Signing`], [`NoNewList::BadSignature`].
    pub fn sign(&self, signer: &dyn Signer) -> Result<String, NoNewList> {
        let comments = |path: &str| match path {
            "format" => vec![
                "Withdrawn passports. Of several lists the one with the highest sequence number counts.".to_owned(),
                "Signed as it stands: any change makes the signature fail.".to_owned(),
            ],
            _ => Vec::new(),
        };
        let payload = canonical::write(self, &comments);
        let message = Message::new(REVOCATION_NAMESPACE, payload.as_bytes());
        let signature = signer.sign_message(&message)?;
        signature.verify_message(&message, None)?;
        Ok(document::join(&payload, &signature))
    }
}

/// Verified lists in the order of their sequence numbers, and what is wrong with the series.
///
/// A gap, two lists of one number, an entry that was lost again, or a time that steps back means that somebody shows old
/// lists for new ones: an alarm.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// The list with the highest number: the one that counts. Entries that only other lists have are added to it: nobody
    /// can tell which of contradicting lists is right, and what was withdrawn once must not come back in silence.
    pub newest: Option<RevocationList>,
    /// What is wrong.
    pub alarms: Vec<SeriesAlarm>,
}

/// What is wrong with a series of lists.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum SeriesAlarm {
    /// Its beginning is not there.
    #[error("the series of revocation lists begins with {first}, not with 1: a gap")]
    Beginning {
        /// The first list that is there.
        first: u32,
    },
    /// Lists in between are not there.
    #[error("after revocation list {from} comes {to}: a gap")]
    Gap {
        /// The last list before it.
        from: u32,
        /// The first list after it.
        to: u32,
    },
    /// Two lists have one number.
    #[error("two different revocation lists have the number {0}: a fork")]
    Fork(u32),
    /// A later list was issued earlier.
    #[error("revocation list {to} is older than list {from}: a step back in time")]
    StepBack {
        /// The earlier list.
        from: u32,
        /// The later list.
        to: u32,
    },
    /// A later list has lost an entry.
    #[error("revocation list {to} has lost an entry of list {from}")]
    LostEntry {
        /// The earlier list.
        from: u32,
        /// The later list.
        to: u32,
    },
}

impl SeriesAlarm {
    /// Whether the lists contradict each other; otherwise some are only missing, as when single lists are shown.
    pub fn is_contradiction(self) -> bool {
        !matches!(self, Self::Beginning { .. } | Self::Gap { .. })
    }
}

impl Series {
    /// Puts lists in order.
    pub fn of(mut lists: Vec<RevocationList>) -> Self {
        lists.sort_by_key(|list| (list.sequence, list.issued_at));
        lists.dedup();
        let first = lists.first().map(|list| list.sequence).filter(|first| *first != 1);
        let mut alarms: Vec<SeriesAlarm> = first.map(|first| SeriesAlarm::Beginning { first }).into_iter().collect();
        for pair in lists.windows(2) {
            let [earlier, later] = pair else { continue };
            let (from, to) = (earlier.sequence, later.sequence);
            if from == to {
                alarms.push(SeriesAlarm::Fork(from));
            } else if to - from > 1 {
                alarms.push(SeriesAlarm::Gap { from, to });
            }
            if later.issued_at < earlier.issued_at {
                alarms.push(SeriesAlarm::StepBack { from, to });
            }
            if from != to && !later.has_all_of(earlier) {
                alarms.push(SeriesAlarm::LostEntry { from, to });
            }
        }
        let mut newest = lists.pop();
        if let Some(newest) = &mut newest {
            let known: BTreeSet<Entry> = newest.entries.iter().cloned().collect();
            let mut others: BTreeSet<Entry> = lists.into_iter().flat_map(|list| list.entries).collect();
            others.retain(|entry| !known.contains(entry));
            newest.entries.extend(others);
        }
        Self { newest, alarms }
    }
}

#[cfg(all(test, feature = "factory"))]
mod tests {
    use super::*;
    use crate::trust::SigningKey;

    fn list(sequence: u32, second: i64, ids: &[&str]) -> RevocationList {
        let at = Timestamp::from_second(second).unwrap();
        let entry = |id: &&str| Entry {
            id: (*id).to_owned(),
            sha256: "0".repeat(64),
            revoked_at: at.min(Timestamp::from_second(100).unwrap()),
            reason: "wrong site".to_owned(),
        };
        let entries = ids.iter().map(entry).collect();
        RevocationList { format: REVOCATION_FORMAT.to_owned(), sequence, issued_at: at, issuer: "f".into(), entries }
    }

    #[test]
    fn a_series_that_only_grows_is_good() {
        let series = Series::of(vec![list(2, 300, &["a", "b"]), list(1, 200, &["a"]), list(1, 200, &["a"])]);
        assert_eq!(series.newest.unwrap().sequence, 2);
        assert!(series.alarms.is_empty());
    }

    #[test]
    fn gaps_forks_and_steps_back_are_alarms() {
        let cases = [
            (vec![list(2, 200, &["a"])], "begins with 2"),
            (vec![list(1, 200, &["a"]), list(3, 300, &["a"])], "a gap"),
            (vec![list(1, 200, &["a"]), list(1, 200, &["b"])], "a fork"),
            (vec![list(1, 300, &["a"]), list(2, 200, &["a"])], "a step back"),
            (vec![list(1, 200, &["a"]), list(2, 300, &["b"])], "lost an entry"),
        ];
        for (lists, words) in cases {
            let alarms: Vec<String> = Series::of(lists).alarms.iter().map(ToString::to_string).collect();
            assert!(alarms.iter().any(|alarm| alarm.contains(words)), "{alarms:?}");
        }
    }

    #[test]
    fn what_was_withdrawn_once_does_not_come_back() {
        let withdrawn = |lists| -> Vec<String> {
            Series::of(lists).newest.unwrap().entries.into_iter().map(|entry| entry.id).collect()
        };
        assert_eq!(withdrawn(vec![list(1, 200, &["a"]), list(1, 250, &["b"])]), ["b", "a"]);
        assert_eq!(
            withdrawn(vec![list(1, 200, &["a", "c"]), list(2, 300, &["a"]), list(3, 300, &["b"])]),
            ["b", "a", "c"]
        );
        assert_eq!(withdrawn(vec![list(1, 200, &["a"]), list(2, 300, &["a", "b"])]), ["a", "b"]);
    }

    #[test]
    fn single_lists_are_no_contradiction() {
        let alarms = |lists| Series::of(lists).alarms.into_iter().filter(|alarm| alarm.is_contradiction()).count();
        assert_eq!(alarms(vec![list(2, 200, &["a"]), list(5, 300, &["a", "b"])]), 0);
        assert_eq!(alarms(vec![list(2, 200, &["a"]), list(2, 300, &["b"])]), 1);
    }

    #[test]
    fn a_signed_list_is_read_again_and_an_altered_one_is_not() {
        let key = SigningKey::generate().unwrap();
        let text = list(1, 200, &["SPS-2/0017/moscow-bmstu/1"]).sign(&key).unwrap();
        let line = format!("f {}", key.public_key().to_openssh());
        let signers = AllowedSigners::parse("signers", line.as_bytes()).unwrap();
        let now = Timestamp::from_second(1_000).unwrap();
        let read = RevocationList::verify("list", text.as_bytes(), &signers, &[], now).unwrap();
        assert_eq!(read, list(1, 200, &["SPS-2/0017/moscow-bmstu/1"]));
        let altered = text.replace("wrong site", "wrong sight");
        let refused = RevocationList::verify("list", altered.as_bytes(), &signers, &[], now).unwrap_err();
        assert!(matches!(refused, ListRefused::Altered { .. }), "{refused}");
        let past = Timestamp::from_second(100).unwrap();
        let refused = RevocationList::verify("list", text.as_bytes(), &signers, &[], past).unwrap_err();
        assert!(matches!(refused, ListRefused::FromTheFuture { .. }), "{refused}");
        let passports_only = format!("f namespaces=\"dtg-passport\" {}", key.public_key().to_openssh());
        let signers = AllowedSigners::parse("signers", passports_only.as_bytes()).unwrap();
        let refused = RevocationList::verify("list", text.as_bytes(), &signers, &[], now).unwrap_err();
        assert!(matches!(refused, ListRefused::NotAuthorised { .. }), "{refused}");
    }
}
