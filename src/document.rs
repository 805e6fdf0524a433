//! Signed documents: text followed by its OpenSSH signature. Steps 1 to 5 of verification, and signing.
//!
//! The file consists of `payload`, `signature: |` and the armor indented by two spaces, and nothing else. The signed
//! message is every byte before `signature: |`.

use crate::text::kind::mistaken;
pub(crate) use crate::text::scalar::sha256_hex;
use crate::text::{Field, Kind, Limits, Location, Printable, Problem, Problems, Unreadable, canonical, rule};
use crate::trust::{AllowedSigners, Message, PublicKey, Signature, SignatureError};
#[cfg(feature = "factory")]
use crate::trust::{KeyError, KeyPoint, SigningKey};
use jiff::Timestamp;
use jiff::civil::Date;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Kind of signed document.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Form {
    /// Namespace of its signatures.
    pub namespace: &'static str,
    /// Value of the key `format`.
    pub format: &'static str,
    pub limits: Limits,
    /// Noun phrase of what was expected instead of another file.
    pub expected: &'static str,
}

/// Register by which a passport was checked.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct RegisterUsed {
    /// Sequence number.
    pub sequence: u64,
    /// SHA-256 of the whole file, in lower-case hexadecimal.
    pub sha256: String,
    /// Time of issue.
    pub issued_at: Timestamp,
    /// Last day on which the register counts as fresh (inclusive), if it states one.
    pub fresh_until: Option<Date>,
}

/// Line that ends the payload.
const SIGNATURE_LINE: &str = "signature: |\n";

/// Indentation of the armor.
const INDENT: &str = "  ";

#[cfg(feature = "factory")]
/// Signer of documents: a key in memory, or a program that has access to one.
pub trait Signer {
    /// Signs `message` for `namespace`.
    ///
    /// # Errors
    /// Returns [`SigningFailed`] with the reason if there is no signature.
    fn sign(&self, namespace: &str, message: &[u8]) -> Result<Signature, SigningFailed>;

    /// Signs a message that is already hashed; by default, signs its bytes with [`Signer::sign`].
    ///
    /// # Errors
    /// Returns [`SigningFailed`] with the reason if there is no signature.
    #[doc(hidden)]
    fn sign_message(&self, message: &Message) -> Result<Signature, SigningFailed> {
        self.sign(message.namespace, message.bytes)
    }

    /// Returns the key that verifies the signatures, or `None` if it is not known before signing.
    fn public_key(&self) -> Option<PublicKey> {
        None
    }

    /// Returns the curve point of the signing key, which speeds up the check of a new signature, or `None` if it is not
    /// known.
    #[doc(hidden)]
    fn point(&self) -> Option<KeyPoint> {
        None
    }
}

/// Reason why there is no signature.
#[cfg(feature = "factory")]
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}", Printable(.0))]
pub struct SigningFailed(pub String);

#[cfg(feature = "factory")]
impl From<KeyError> for SigningFailed {
    fn from(error: KeyError) -> Self {
        Self(error.to_string())
    }
}

#[cfg(feature = "factory")]
impl Signer for SigningKey {
    fn sign(&self, namespace: &str, message: &[u8]) -> Result<Signature, SigningFailed> {
        Ok(SigningKey::sign(self, namespace, message)?)
    }

    fn sign_message(&self, message: &Message) -> Result<Signature, SigningFailed> {
        Ok(SigningKey::sign_message(self, message)?)
    }

    fn public_key(&self) -> Option<PublicKey> {
        Some(SigningKey::public_key(self))
    }

    fn point(&self) -> Option<KeyPoint> {
        Some(SigningKey::point(self))
    }
}

/// Document whose form is correct (verification steps 1 to 3). None of its content has been parsed.
#[derive(Debug, Clone)]
pub(crate) struct SignedText<'a> {
    payload: &'a str,
    signature: Signature,
}

/// Fault in the form of a document, or a signature of another kind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Malformed {
    /// Description and location of the fault.
    pub fault: Unreadable,
    /// Error of the signature if that is the fault, otherwise `None`.
    pub signature: Option<Box<SignatureError>>,
}

/// Form of the signature in a document.
const BLOCK: &str = "a signature block of OpenSSH, indented by two spaces, and nothing after it";
const CHANGED: &str = "the signature or the text after it has changed; get the file from the issuer again";

/// Returns noun phrases for what was found instead of a signature and for what was expected, and the advice.
fn refusal_of(error: &SignatureError) -> (String, String, &'static str) {
    let (found, expected) = match error {
        SignatureError::KeyType(other) => {
            let what = if other.contains("-cert-v") { "an OpenSSH certificate" } else { "a key" };
            let found = format!("a text signed with {what} of type {other}");
            let expected = "a key of type ssh-ed25519 or sk-ssh-ed25519@openssh.com";
            return (found, expected.to_owned(), "ask the issuer to sign it with such a key");
        }
        SignatureError::WrongNamespace { found, expected } => {
            let advice = "it is signed as another kind of document";
            return (format!("a signature for {found:?}"), format!("a signature for {expected:?}"), advice);
        }
        SignatureError::Damaged(why) => (format!("a damaged signature block ({why})"), BLOCK),
        SignatureError::NotCanonical => {
            ("a signature block whose lines or padding are not as OpenSSH writes them".to_owned(), BLOCK)
        }
        SignatureError::Version(version) => (format!("a signature block of format version {version}"), "version 1"),
        SignatureError::Reserved(bytes) => (format!("a signature block with {bytes} reserved bytes"), "none"),
        SignatureError::HashAlgorithm(name) => (format!("a signed text hashed with {name}"), "sha512"),
        SignatureError::Algorithm { key, signature } => {
            (format!("a signature of type {signature} with a key of type {key}"), "the same type twice")
        }
        SignatureError::DoesNotHold => ("a signature of another text".to_owned(), BLOCK),
    };
    (found, expected.to_owned(), CHANGED)
}

impl<'a> SignedText<'a> {
    /// Checks the text rule, splits the file and checks the form of the signature, in this order.
    pub(crate) fn split(name: &str, bytes: &'a [u8], form: &Form) -> Result<Self, Malformed> {
        let Form { namespace, limits, .. } = *form;
        // An unsigned file of another kind is named as what it is.
        let other = || {
            let is_signed = |kind| matches!(kind, Kind::Passport | Kind::Register);
            let mistaken = || mistaken(name, bytes, form.expected, is_signed);
            signature_line(bytes).is_none().then(mistaken).flatten()
        };
        let malformed = |fault| Malformed { fault: other().unwrap_or(fault), signature: None };
        if bytes.len() > limits.bytes {
            rule::check(name, bytes, limits.bytes).map_err(malformed)?;
        }
        // The payload must obey the text rule, and the armor has only one valid form, so the file cannot contain any
        // other text.
        let payload_end = signature_line(bytes);
        let payload_bytes = &bytes[..payload_end.unwrap_or(bytes.len())];
        let payload = rule::check(name, payload_bytes, limits.bytes).map_err(malformed)?;
        let Some(payload_end) = payload_end else {
            let location = Some(Location { line: payload.lines().count() + 1, column: 1 });
            let advice = "the file is unsigned, or may be truncated; get it from the issuer again";
            return Err(malformed(Unreadable::whole(name, location, "no signature", "`signature: |`", advice)));
        };
        let tail = &bytes[payload_end + SIGNATURE_LINE.len()..];
        let unindented = |text: &str| text.split_inclusive('\n').map(|line| line.strip_prefix(INDENT)).collect();
        let armor: Option<String> = std::str::from_utf8(tail).ok().and_then(unindented);
        let refuse = |(found, expected, advice): (String, String, &str), signature| {
            let at = Location { line: payload.lines().count() + 2, column: 1 };
            Malformed { fault: Unreadable::whole(name, Some(at), found, expected, advice), signature }
        };
        let not_indented = "a line that is not indented like the signature";
        let armor = armor.ok_or_else(|| refuse((not_indented.to_owned(), BLOCK.to_owned(), CHANGED), None))?;
        let signature = Signature::from_armor(&armor);
        let signature = signature.and_then(|signature| signature.check_namespace(namespace).map(|()| signature));
        let signature = signature.map_err(|error| refuse(refusal_of(&error), Some(Box::new(error))))?;
        Ok(Self { payload, signature })
    }

    /// Returns the text before its signature is verified: anyone may have written it.
    pub(crate) fn unverified_payload(&self) -> &'a str {
        self.payload
    }

    pub(crate) fn key(&self) -> &PublicKey {
        self.signature.public_key()
    }

    /// Verifies the signature with the key that it states (step 4) and returns the signed text, which may now be
    /// parsed. It is faster if the key is one of `signers`; the result does not depend on them.
    ///
    /// # Errors
    /// Returns [`SignatureError`] if the text is not the one that was signed.
    pub(crate) fn signed_payload(
        &self,
        signers: Option<&AllowedSigners>,
        hashed: Option<&Message>,
    ) -> Result<&'a str, SignatureError> {
        let (namespace, bytes) = (self.signature.namespace(), self.payload.as_bytes());
        let hashed = hashed.filter(|message| (message.namespace, message.bytes) == (namespace, bytes));
        let message = hashed.map_or_else(|| Cow::Owned(Message::new(namespace, bytes)), Cow::Borrowed);
        self.signature.verify_message(&message, signers.and_then(|signers| signers.point(self.key())))?;
        Ok(self.payload)
    }
}

/// Parses a payload in canonical form (step 5) with the format `format`; `check` applies the rules of the content.
///
/// Call it only with text whose signature was verified.
///
/// # Errors
/// Returns another format, the first line that is not in canonical form, or every rule that the content breaks.
pub(crate) fn parse<T: Field>(
    name: &str,
    payload: &str,
    form: &Form,
    check: impl Fn(&T, &mut Problems),
) -> Result<T, Unreadable> {
    let stated = payload.lines().find_map(|line| line.strip_prefix("format: \"")?.strip_suffix('"'));
    if let Some(found) = stated.filter(|found| *found != form.format) {
        let advice = if rule::is_later_format(found, form.format) { rule::UPDATE } else { "" };
        let other = Problem::new(None, "format", format!("{found:?}"), format!("{:?}", form.format), advice);
        return Err(Unreadable::of(name, vec![other]));
    }
    let content: T = canonical::read(payload, form.limits).map_err(|problem| Unreadable::of(name, vec![problem]))?;
    let mut problems = Problems::default();
    check(&content, &mut problems);
    if problems.is_empty() { Ok(content) } else { Err(problems.refuse_by_field(name)) }
}

/// Returns the end of the payload, which is the first line `signature: |`, or `None` without such a line.
fn signature_line(bytes: &[u8]) -> Option<usize> {
    let begins_a_line = |at: &usize| *at > 0 && bytes[at - 1] == b'\n';
    memchr::memmem::find_iter(bytes, SIGNATURE_LINE).find(begins_a_line)
}

#[cfg(feature = "factory")]
/// Signs a payload, verifies the new signature, and returns the whole file.
///
/// # Errors
/// Returns [`SigningFailed`] if the signer fails, and [`SignatureError`] if its signature is wrong.
pub(crate) fn sign<E>(payload: &str, namespace: &str, signer: &dyn Signer) -> Result<String, E>
where
    E: From<SigningFailed> + From<SignatureError>,
{
    let message = Message::new(namespace, payload.as_bytes());
    let signature = signer.sign_message(&message)?;
    signature.verify_message(&message, signer.point().as_ref())?;
    Ok(join(payload, &signature))
}

#[cfg(feature = "factory")]
/// Joins payload and signature into the file that [`SignedText::split`] separates.
pub(crate) fn join(payload: &str, signature: &Signature) -> String {
    let armor = signature.to_armor();
    let mut text = String::with_capacity(payload.len() + 2 * armor.len());
    text.extend([payload, SIGNATURE_LINE]);
    armor.split_inclusive('\n').for_each(|line| text.extend([INDENT, line]));
    text
}
