//! Signatures in OpenSSH's format SSHSIG (OpenSSH's PROTOCOL.sshsig; for security keys PROTOCOL.u2f).
//!
//! The signed data are `SSHSIG`, the namespace, an empty reserved field, the name of the hash algorithm and the hash of
//! the message. They do not include the version of the block, and base64 can be wrapped in many ways. Therefore only
//! version 1 in OpenSSH's own form is accepted, so that no byte of the block can be changed.

use super::public_key::{AnyKey, shortened};
use super::wire::{Truncated, Wire, string};
use super::{PublicKey, SignatureError};
use base64ct::{Base64, Encoding};
use ed25519_dalek::{SIGNATURE_LENGTH, VerifyingKey};
use sha2::{Digest, Sha256, Sha512};

/// Longest armor that is read, in bytes: enough for a security key with an unusually long application string, and to name
/// the type of a key that cannot sign passports (5,402 bytes with ML-DSA).
const LONGEST_ARMOR: usize = 8192;
/// Line length of OpenSSH's base64.
const LINE_LENGTH: usize = 70;
const FIRST_LINE: &str = "-----BEGIN SSH SIGNATURE-----";
const LAST_LINE: &str = "-----END SSH SIGNATURE-----";

/// First bytes of a block, and of what is signed.
const PREAMBLE: &[u8] = b"SSHSIG";
const VERSION: u32 = 1;
const HASH_ALGORITHM: &str = "sha512";

/// Number of bytes after the signature of a security key: flags, and a counter.
const FLAGS_AND_COUNTER_BYTES: usize = 5;

/// Bytes with the namespace that they are signed for, hashed once for signing and verification.
#[derive(Debug, Clone)]
#[doc(hidden)]
pub struct Message<'a> {
    pub(crate) namespace: &'a str,
    pub(crate) bytes: &'a [u8],
    /// Data that the key signs; `None` without a namespace, for which nothing is signed.
    pub(crate) signed: Option<Vec<u8>>,
}

impl<'a> Message<'a> {
    /// Creates the message `bytes` for the namespace `namespace`.
    pub fn new(namespace: &'a str, bytes: &'a [u8]) -> Self {
        let signed = || [PREAMBLE, &purpose(namespace), &string(&Sha512::digest(bytes))].concat();
        Self { namespace, bytes, signed: (!namespace.is_empty()).then(signed) }
    }
}

/// Returns what a block and the signed data say of their purpose: namespace, reserved field and hash algorithm.
fn purpose(namespace: &str) -> Vec<u8> {
    [namespace, "", HASH_ALGORITHM].map(|text| string(text.as_bytes())).concat()
}

/// Signature whose form is correct; [`Signature::verify`] checks it against a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Signature {
    key: PublicKey,
    namespace: String,
    signature: [u8; SIGNATURE_LENGTH],
    /// What a security key signs with the message; empty for other keys.
    flags_and_counter: Vec<u8>,
    armor: String,
}

impl From<Truncated> for SignatureError {
    fn from(truncated: Truncated) -> Self {
        Self::Damaged(truncated.to_string())
    }
}

impl Signature {
    /// Reads a signature block, from `-----BEGIN SSH SIGNATURE-----` to the line feed after its last line.
    ///
    /// # Errors
    /// Returns any variant of [`SignatureError`] except [`SignatureError::WrongNamespace`] and
    /// [`SignatureError::DoesNotHold`].
    pub fn from_armor(armor: &str) -> Result<Self, SignatureError> {
        if armor.len() > LONGEST_ARMOR {
            return Err(SignatureError::Damaged(format!("{} bytes, expected at most {LONGEST_ARMOR}", armor.len())));
        }
        let base64 = base64_of(armor);
        // It refuses unused bits that are not 0, so no two texts encode the same bytes.
        let block = Base64::decode_vec(&base64).map_err(|error| SignatureError::Damaged(error.to_string()));
        match block.and_then(|block| Self::from_block(&block, armor)) {
            Err(SignatureError::Damaged(_)) => Err(SignatureError::Damaged(damage(armor).to_owned())),
            // A block that was wrapped again is not damaged.
            Ok(_) if wrapped(&base64) != armor => Err(SignatureError::NotCanonical),
            read => read,
        }
    }

    /// Reads a block that has this armor, to its last byte. Every field has only one encoding.
    fn from_block(block: &[u8], armor: &str) -> Result<Self, SignatureError> {
        let damaged = |why: &str| Err(SignatureError::Damaged(why.to_owned()));
        let Some(fields) = block.strip_prefix(PREAMBLE) else { return damaged("another preamble") };
        let mut wire = Wire::new(fields);
        match wire.u32()? {
            VERSION => {}
            other => return Err(SignatureError::Version(other)),
        }
        let key = AnyKey::from_blob(wire.string()?).map_err(SignatureError::Damaged)?;
        let (namespace, reserved, hash_algorithm) = (wire.string()?, wire.string()?, wire.string()?);
        let mut of_key = wire.nested()?;
        let (algorithm, signature) = (of_key.string()?, of_key.string()?);
        let namespace = match std::str::from_utf8(namespace) {
            Ok(namespace) if !namespace.is_empty() && wire.rest.is_empty() => namespace.to_owned(),
            _ => return damaged("no namespace, or bytes after the end"),
        };
        if !reserved.is_empty() {
            return Err(SignatureError::Reserved(reserved.len()));
        }
        let name = |bytes: &[u8]| shortened(&String::from_utf8_lossy(bytes));
        if hash_algorithm != HASH_ALGORITHM.as_bytes() {
            return Err(SignatureError::HashAlgorithm(name(hash_algorithm)));
        }
        let key = match key {
            AnyKey::Signing(key) => key,
            AnyKey::Other { algorithm, .. } => return Err(SignatureError::KeyType(algorithm)),
        };
        if algorithm != key.algorithm().as_bytes() {
            return Err(SignatureError::Algorithm { key: key.algorithm().to_owned(), signature: name(algorithm) });
        }
        let trailer = if key.is_security_key() { FLAGS_AND_COUNTER_BYTES } else { 0 };
        match signature.try_into() {
            Ok(signature) if of_key.rest.len() == trailer => {
                Ok(Self { key, namespace, signature, flags_and_counter: of_key.rest.to_vec(), armor: armor.to_owned() })
            }
            _ => damaged("a signature of another length"),
        }
    }

    /// Writes the block of a signature by a key that is not in a security key, in the form that OpenSSH writes.
    #[cfg(feature = "factory")]
    pub(super) fn of(key: PublicKey, namespace: &str, signature: &[u8; SIGNATURE_LENGTH]) -> Self {
        let of_key = [string(key.algorithm().as_bytes()), string(signature)].concat();
        let version = VERSION.to_be_bytes();
        let block = [PREAMBLE, &version, &string(&key.blob), &purpose(namespace), &string(&of_key)].concat();
        let (namespace, flags_and_counter) = (namespace.to_owned(), Vec::new());
        Self {
            key,
            namespace,
            signature: *signature,
            flags_and_counter,
            armor: wrapped(&Base64::encode_string(&block)),
        }
    }

    /// Returns the block as OpenSSH writes it: 70 columns wide, with a line feed after the last line.
    pub fn to_armor(&self) -> String {
        self.armor.clone()
    }

    pub(crate) fn namespace(&self) -> &str {
        &self.namespace
    }

    /// Returns the key in the block; the list of allowed signers decides whether to trust it.
    pub fn public_key(&self) -> &PublicKey {
        &self.key
    }

    /// Verifies that the key in the block signed exactly `message` for `namespace`.
    ///
    /// Ed25519 is verified strictly: weak keys and second encodings of a signature are refused. A signature of a
    /// security key is accepted whatever its flags, as with `ssh-keygen -Y verify`, because the owner of the key chose
    /// whether the token requires a touch.
    ///
    /// # Errors
    /// Returns [`SignatureError::WrongNamespace`] if the signature was made for another namespace, and
    /// [`SignatureError::DoesNotHold`] if the text or the signature was altered.
    pub fn verify(&self, namespace: &str, message: &[u8]) -> Result<(), SignatureError> {
        self.verify_message(&Message::new(namespace, message), None)
    }

    /// Checks that the signature was made for the namespace `expected`.
    pub(crate) fn check_namespace(&self, expected: &str) -> Result<(), SignatureError> {
        if self.namespace == expected {
            return Ok(());
        }
        Err(SignatureError::WrongNamespace { found: self.namespace.clone(), expected: expected.to_owned() })
    }

    /// Verifies a message that is already hashed, with the key's curve point if that is already known.
    pub(crate) fn verify_message(&self, message: &Message, point: Option<&KeyPoint>) -> Result<(), SignatureError> {
        self.check_namespace(message.namespace)?;
        let signed = message.signed.as_deref().ok_or(SignatureError::DoesNotHold)?;
        let known = point.filter(|point| point.is_of(&self.key)).cloned();
        let point = known.or_else(|| KeyPoint::of(&self.key)).ok_or(SignatureError::DoesNotHold)?;
        let signature = ed25519_dalek::Signature::from_bytes(&self.signature);
        let by_token = |application| signed_by_token(application, &self.flags_and_counter, signed);
        let by_token = self.key.application.as_deref().map(by_token);
        let verified = point.0.verify_strict(by_token.as_deref().unwrap_or(signed), &signature);
        verified.map_err(|_| SignatureError::DoesNotHold)
    }
}

/// Returns what is damaged in a block that cannot be read.
fn damage(armor: &str) -> &'static str {
    let armor = armor.trim();
    match () {
        () if !armor.starts_with(FIRST_LINE) => "its first line has changed",
        () if !armor.ends_with(LAST_LINE) => "its last line is missing or has changed",
        () if Base64::decode_vec(&base64_of(armor)).is_err() => "its base64 is truncated or has changed",
        () => "its content is truncated or has changed",
    }
}

/// Returns the base64 between the first and the last line of a block, without white space.
fn base64_of(armor: &str) -> String {
    let body = armor.trim().trim_start_matches(FIRST_LINE).trim_end_matches(LAST_LINE);
    body.split_ascii_whitespace().collect()
}

/// Returns a block with lines of OpenSSH's length.
fn wrapped(base64: &str) -> String {
    let lines: Vec<_> = base64.as_bytes().chunks(LINE_LENGTH).map(String::from_utf8_lossy).collect();
    format!("{FIRST_LINE}\n{}\n{LAST_LINE}\n", lines.join("\n"))
}

/// Returns the data that a security key signs instead of the message (PROTOCOL.u2f, SSH U2F Signatures).
fn signed_by_token(application: &str, flags_and_counter: &[u8], message: &[u8]) -> Vec<u8> {
    [&Sha256::digest(application)[..], flags_and_counter, &Sha256::digest(message)].concat()
}

/// Curve point of a public key, decoded once for many signatures.
#[derive(Debug, Clone)]
#[doc(hidden)]
pub struct KeyPoint(pub(super) VerifyingKey);

impl KeyPoint {
    /// Decodes the curve point of a key; returns `None` if its bytes are not a point.
    pub(super) fn of(key: &PublicKey) -> Option<Self> {
        VerifyingKey::from_bytes(&key.point).ok().map(Self)
    }

    fn is_of(&self, key: &PublicKey) -> bool {
        key.point == *self.0.as_bytes()
    }
}

#[cfg(all(test, feature = "factory"))]
mod tests {
    use super::*;
    use crate::trust::{KeyError, SigningKey};

    const NAMESPACE: &str = "dtg-passport";
    const MESSAGE: &[u8] = b"format: \"dtg-passport/1\"\n";

    fn blob(armor: &str) -> Vec<u8> {
        Base64::decode_vec(&base64_of(armor)).unwrap()
    }

    fn armored(blob: &[u8]) -> String {
        wrapped(&Base64::encode_string(blob))
    }

    /// Expected: the key in the block decides, whichever point is given.
    #[test]
    fn a_point_of_another_key_is_not_used() {
        let (key, other) = (SigningKey::generate().unwrap(), SigningKey::generate().unwrap());
        let message = Message::new(NAMESPACE, MESSAGE);
        let [own, theirs] = [&key, &other].map(|key| key.sign(NAMESPACE, MESSAGE).unwrap());
        assert_eq!(own.verify_message(&message, Some(&other.point())), Ok(()));
        // The signature of one key in a block with the other one; the key follows the preamble, the version, two
        // lengths and the type.
        let at = 6 + 4 + 4 + (4 + 11) + 4;
        let mut forged = blob(&theirs.to_armor());
        forged[at..at + 32].copy_from_slice(&blob(&own.to_armor())[at..at + 32]);
        let forged = Signature::from_armor(&armored(&forged)).unwrap();
        assert_eq!(forged.public_key(), &key.public_key());
        for point in [None, Some(&other.point()), Some(&key.point())] {
            assert_eq!(forged.verify_message(&message, point), Err(SignatureError::DoesNotHold));
        }
        assert_eq!(key.sign("", MESSAGE), Err(KeyError::Namespace));
    }

    #[test]
    fn every_deviation_of_the_block_has_its_own_words() {
        let refused = |blob: &[u8]| Signature::from_armor(&armored(blob)).unwrap_err();
        let good = blob(&SigningKey::generate().unwrap().sign(NAMESPACE, MESSAGE).unwrap().to_armor());
        for version in [0, 2] {
            let mut altered = good.clone();
            altered[9] = version;
            assert_eq!(refused(&altered), SignatureError::Version(u32::from(version)));
        }
        // The reserved field and the name of the hash algorithm follow the preamble, the version, the key and the
        // namespace.
        let reserved = 6 + 4 + (4 + 51) + (4 + NAMESPACE.len());
        assert_eq!(&good[reserved..reserved + 14], b"\0\0\0\0\0\0\0\x06sha512");
        let with_reserved = [&good[..reserved], b"\0\0\0\x02xy", &good[reserved + 4..]].concat();
        assert_eq!(refused(&with_reserved), SignatureError::Reserved(2));
        let sha256 = [&good[..reserved + 8], b"sha256", &good[reserved + 14..]].concat();
        assert_eq!(refused(&sha256), SignatureError::HashAlgorithm("sha256".to_owned()));
        // No namespace, bytes after the signature, and a signature of 63 bytes.
        let unnamed = [&good[..65], &[0; 4], &good[reserved..]].concat();
        let longer = [&good[..], b"x"].concat();
        let mut shorter = good[..good.len() - 1].to_vec();
        shorter[reserved + 17] -= 1;
        shorter[reserved + 36] -= 1;
        for damaged in [unnamed, longer, shorter] {
            let why = "its content is truncated or has changed".to_owned();
            assert_eq!(refused(&damaged), SignatureError::Damaged(why));
        }
        let of_length = |bytes| Signature::from_armor(&"x".repeat(bytes)).unwrap_err().to_string();
        assert!(of_length(8193).contains("8193 bytes, expected at most 8192"));
        assert!(!of_length(8192).contains("expected at most"));
        for other in [armored(&good).replace('\n', "\r\n"), armored(&good).replacen('\n', "\n\n", 1)] {
            assert_eq!(Signature::from_armor(&other), Err(SignatureError::NotCanonical));
        }
    }
}
