//! Lists of withdrawn passports (`dtg-revocation/1`), signed like passports but in a separate namespace.
//!
//! A revoked key and a withdrawn passport are different. A revoked key is no longer trusted for any document. A
//! withdrawn passport was issued in error, and the issuer's key is still trusted.
//!
//! Each list repeats the entries of its predecessor. If it would become larger than a document may be, the next list
//! begins with new entries only and references the list that it continues. The entries of the whole chain apply.
//!
//! * `series`: all lists together.

pub(crate) mod series;

pub use series::{Series, SeriesAlarm};

use crate::document::{self, Malformed, SignedText, Signer, SigningFailed, sha256_hex};
use crate::text::{LARGEST_DOCUMENT_BYTES, Path, Printable, Problems, Unreadable, canonical, record};
use crate::trust::{AllowedSigners, BadIdentity, RevokedKeys, SignatureError};
use jiff::Timestamp;

pub(crate) const REVOCATION_FORMAT: &str = "dtg-revocation/1";

/// Returns `true` if the file states the format of such a list.
pub(crate) fn claims_to_be_a_list(bytes: &[u8]) -> bool {
    memchr::memmem::find(bytes, b"format: \"dtg-revocation/").is_some()
}

pub(crate) const REVOCATION_NAMESPACE: &str = "dtg-revocation";

record! {
    /// Withdrawn passport.
    #[derive(Eq, PartialOrd, Ord)]
    pub struct Entry {
        /// Identifier of the passport.
        pub id: String,
        /// SHA-256 of the file, in lower-case hexadecimal.
        pub sha256: String,
        /// Time of withdrawal.
        pub revoked_at: Timestamp,
        /// Reason for the withdrawal.
        pub reason: String,
    }
}

record! {
    /// List that is continued; its entries remain valid.
    #[derive(Eq)]
    pub struct Continued {
        /// Sequence number of the list.
        pub sequence: u32,
        /// SHA-256 of the file, in lower-case hexadecimal.
        pub sha256: String,
    }
}

record! {
    /// List of withdrawn passports. Of several lists, the one with the highest sequence number applies.
    pub struct RevocationList {
        /// Always "dtg-revocation/1".
        pub format: String,
        /// Sequence number, from 1, increasing.
        pub sequence: u32,
        /// Time of issue, not earlier than that of any list with a lower number.
        pub issued_at: Timestamp,
        /// Issuer: a principal of allowed_signers.
        pub issuer: String,
        /// Earlier list whose entries apply too and are not repeated here.
        pub continues: Option<Continued>,
        /// All passports withdrawn so far, or since the list that is continued.
        pub entries: Vec<Entry>,
    }
}

/// Verified list of withdrawn passports, with the SHA-256 of its file.
#[derive(Debug, Clone, PartialEq)]
pub struct VerifiedList {
    /// Content of the list.
    pub list: RevocationList,
    /// SHA-256 of the file, in lower-case hexadecimal, by which another list references this one.
    pub sha256: String,
}

/// Space reserved for the signature of a list, in bytes; signatures of tokens, which are the longest, need 500.
const SIGNATURE_BYTES: usize = 1024;

/// Reason why a list is not accepted.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ListRefused {
    /// The form of the file is not correct.
    #[error("{}", .0.fault)]
    Malformed(Malformed),
    /// The text in the file of this name is not the one that was signed.
    #[error("{}: {}; get the list from the issuer again", Printable(.0), .1)]
    Altered(String, SignatureError),
    /// The content breaks a rule.
    #[error(transparent)]
    Content(#[from] Unreadable),
    /// The key in the file of this name is not trusted for the issuer of the list.
    #[error("{}: this list of withdrawn passports is not trusted: {}", Printable(name), Printable(why))]
    NotAuthorised {
        /// File name.
        name: String,
        /// Reason why the key is not trusted, with its fingerprint.
        why: String,
    },
    /// The signing key was revoked.
    #[error("{}: its signing key was revoked: {}", Printable(name), Printable(why))]
    KeyRevoked {
        /// File name.
        name: String,
        /// Reason for the revocation.
        why: String,
    },
    /// The list was issued later than the time of verification.
    #[error(
        "{}: issued at {issued_at}, later than the time of verification, {now}; check the clock, and --time if it is given",
        Printable(name)
    )]
    FromTheFuture {
        /// File name.
        name: String,
        /// Time of issue that the list states.
        issued_at: Timestamp,
        /// Time of verification.
        now: Timestamp,
    },
}

/// Reason why no new list was created.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoNewList {
    /// The passport is already withdrawn.
    #[error("{id}: already withdrawn at {revoked_at}: {}", Printable(reason))]
    AlreadyRevoked {
        /// Identifier of the passport.
        id: String,
        /// Time of withdrawal.
        revoked_at: Timestamp,
        /// Reason for the withdrawal.
        reason: String,
    },
    /// The passport is given twice.
    #[error("{0}: given twice; give each passport once")]
    Twice(String),
    /// The new list would be dated before the last one.
    #[error("the new list would be issued at {now}, earlier than the last one at {last}; check the clock")]
    BeforeLast {
        /// Time of issue of the new list.
        now: Timestamp,
        /// Time of issue of the last list.
        last: Timestamp,
    },
    /// The new entries alone would make a list too large.
    #[error("{0} passports are too many for one list; withdraw them in several steps")]
    TooMany(usize),
    /// A text is empty or contains a character that cannot be signed.
    #[error(
        "the reason {0:?} is empty or contains a character that is not allowed in signed files; state it in plain words"
    )]
    BadText(String),
    /// The issuer's name cannot be a principal of allowed_signers.
    #[error(transparent)]
    Identity(#[from] BadIdentity),
    /// The new list failed verification.
    #[error("the new list failed verification ({0}); nothing was written")]
    Refused(#[from] ListRefused),
    /// The signer produced no signature.
    #[error(transparent)]
    Signing(#[from] SigningFailed),
    /// The signer produced a wrong signature.
    #[error("verification of the new signature failed: {0}")]
    BadSignature(#[from] SignatureError),
}

impl ListRefused {
    /// Returns `true` if the file is not a complete list (steps 1 to 5), so that its withdrawals are unknown; `false`
    /// if it is a list that is not accepted.
    pub(crate) fn is_damage(&self) -> bool {
        matches!(self, Self::Malformed(_) | Self::Altered { .. } | Self::Content(_))
    }
}

impl std::fmt::Display for Entry {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{} was withdrawn at {}: {}", self.id, self.revoked_at, self.reason)
    }
}

impl RevocationList {
    /// Verifies the bytes of a list in the same way as those of a passport, and parses it.
    ///
    /// # Errors
    /// Returns [`ListRefused`] if the list is damaged, or its key is not trusted, or it is dated after `now`.
    pub fn verify(
        name: &str,
        bytes: &[u8],
        signers: &AllowedSigners,
        revoked_keys: &[RevokedKeys],
        now: Timestamp,
    ) -> Result<VerifiedList, ListRefused> {
        let text = SignedText::split(name, bytes, REVOCATION_NAMESPACE).map_err(ListRefused::Malformed)?;
        let name = name.to_owned();
        let list: Self = match text.signed_payload(Some(signers)) {
            Ok(payload) => document::parse(&name, payload, REVOCATION_FORMAT, Self::check)?,
            Err(error) => return Err(ListRefused::Altered(name, error)),
        };
        if let Err(miss) = signers.authorise(text.key(), &list.issuer, REVOCATION_NAMESPACE, list.issued_at) {
            let why = miss.of_document(text.key(), &list.issuer, list.issued_at);
            return Err(ListRefused::NotAuthorised { name, why });
        }
        if let Some(why) = revoked_keys.iter().find_map(|keys| keys.revokes(text.key())) {
            return Err(ListRefused::KeyRevoked { name, why });
        }
        if list.issued_at > now {
            return Err(ListRefused::FromTheFuture { name, issued_at: list.issued_at, now });
        }
        Ok(VerifiedList { list, sha256: sha256_hex(bytes) })
    }

    fn check(&self, problems: &mut Problems) {
        let at = Path::Root;
        if self.sequence == 0 {
            problems.at(&at.key("sequence"), "0", "a whole number of 1 or more", "");
        }
        if let Some(continued) = &self.continues {
            let at = at.key("continues");
            if continued.sequence == 0 || continued.sequence >= self.sequence {
                let expected = format!("the number of a list earlier than {}", self.sequence);
                problems.at(&at.key("sequence"), format!("{}", continued.sequence), expected, "");
            }
            problems.sha256(&at.key("sha256"), &continued.sha256);
        }
        let entries = at.key("entries");
        for (index, entry) in self.entries.iter().enumerate() {
            problems.sha256(&entries.item(index).key("sha256"), &entry.sha256);
        }
    }

    /// Returns the file name of the list. Another name may be an attempt to make an old list look newer.
    pub(crate) fn file_name(&self) -> String {
        format!("revocation-{}.yaml", self.sequence)
    }

    fn payload(&self) -> String {
        let comments = |path: &str| match path {
            "format" => vec![
                "Withdrawn passports. Of several lists, the one with the highest sequence number applies.".to_owned(),
                "Signed verbatim: any change makes the signature invalid.".to_owned(),
            ],
            "continues" => vec!["The entries of this earlier list apply too; keep both lists.".to_owned()],
            _ => Vec::new(),
        };
        canonical::write(self, &comments)
    }

    /// Returns `true` if the signed file is small enough to be read again.
    fn fits(&self) -> bool {
        self.payload().len() + SIGNATURE_BYTES <= LARGEST_DOCUMENT_BYTES
    }

    /// Signs the list, verifies the new signature, and returns the whole file.
    ///
    /// # Errors
    /// Returns [`NoNewList::Signing`] if the signer fails, and [`NoNewList::BadSignature`] if its signature is wrong.
    pub fn sign(&self, signer: &dyn Signer) -> Result<String, NoNewList> {
        document::sign(&self.payload(), REVOCATION_NAMESPACE, signer)
    }

    /// Signs the list and verifies it with `signers` and `revoked_keys`, because a list that its recipients cannot
    /// verify would withdraw nothing. Returns the whole file.
    pub(crate) fn sign_for(
        &self,
        name: &str,
        signer: &dyn Signer,
        signers: &AllowedSigners,
        revoked_keys: &[RevokedKeys],
    ) -> Result<String, NoNewList> {
        let text = self.sign(signer)?;
        Self::verify(name, text.as_bytes(), signers, revoked_keys, self.issued_at)?;
        Ok(text)
    }
}

#[cfg(all(test, feature = "factory"))]
mod tests {
    use super::*;
    use crate::trust::SigningKey;

    fn list() -> RevocationList {
        let at = Timestamp::from_second(200).unwrap();
        let (id, reason) = ("SPS-2/0017/moscow-bmstu/1".to_owned(), "wrong site".to_owned());
        let entries = vec![Entry { id, sha256: "0".repeat(64), revoked_at: at, reason }];
        let (format, issuer) = (REVOCATION_FORMAT.to_owned(), "f".to_owned());
        RevocationList { format, sequence: 1, issued_at: at, issuer, continues: None, entries }
    }

    #[test]
    fn a_signed_list_is_read_again_and_an_altered_one_is_not() {
        let key = SigningKey::generate().unwrap();
        let text = list().sign(&key).unwrap();
        let line = format!("f {}", key.public_key().to_openssh());
        let signers = AllowedSigners::parse("signers", line.as_bytes()).unwrap();
        let now = Timestamp::from_second(1_000).unwrap();
        let read = RevocationList::verify("list", text.as_bytes(), &signers, &[], now).unwrap();
        assert_eq!((read.list, read.sha256), (list(), sha256_hex(text.as_bytes())));
        let altered = text.replace("wrong site", "wrong sight");
        let refused = RevocationList::verify("list", altered.as_bytes(), &signers, &[], now).unwrap_err();
        assert!(matches!(refused, ListRefused::Altered(..)), "{refused}");
        let past = Timestamp::from_second(100).unwrap();
        let refused = RevocationList::verify("list", text.as_bytes(), &signers, &[], past).unwrap_err();
        assert!(matches!(refused, ListRefused::FromTheFuture { .. }), "{refused}");
        let passports_only = format!("f namespaces=\"dtg-passport\" {}", key.public_key().to_openssh());
        let signers = AllowedSigners::parse("signers", passports_only.as_bytes()).unwrap();
        let refused = RevocationList::verify("list", text.as_bytes(), &signers, &[], now).unwrap_err();
        assert!(matches!(refused, ListRefused::NotAuthorised { .. }), "{refused}");
    }
}
