//! Signatures in OpenSSH's format SSHSIG (OpenSSH's PROTOCOL.sshsig; for security keys PROTOCOL.u2f).
//!
//! The signed data are `SSHSIG`, the namespace, an empty reserved field, the name of the hash algorithm and the hash of
//! the message. They do not include the version of the block, and base64 can be wrapped in many ways. Therefore only
//! version 1 in OpenSSH's own form is accepted, so that no byte of the block can be changed.

use super::public_key::AnyKey;
use super::wire::Wire;
use super::{KeyError, PublicKey, SignatureError};
use base64ct::{Base64, Encoding};
use ed25519_dalek::VerifyingKey;
use sha2::{Digest, Sha256};
use ssh_encoding::{Decode, Encode};
use ssh_key::public::KeyData;
use ssh_key::{HashAlg, SshSig};

/// Longest armor that is read, in bytes: enough for a security key with an unusually long application string, and to name
/// the type of a key that cannot sign passports (5,402 bytes with ML-DSA).
const LONGEST_ARMOR: usize = 8192;
/// Line length of OpenSSH's base64.
const LINE_LENGTH: usize = 70;
const FIRST_LINE: &str = "-----BEGIN SSH SIGNATURE-----";
const LAST_LINE: &str = "-----END SSH SIGNATURE-----";

/// Bytes with the namespace that they are signed for, hashed once for signing and verification.
#[derive(Debug, Clone)]
pub struct Message<'a> {
    pub(crate) namespace: &'a str,
    pub(crate) bytes: &'a [u8],
    /// Data that the key signs; `None` without a namespace, for which nothing is signed.
    pub(crate) signed: Option<Vec<u8>>,
}

impl<'a> Message<'a> {
    /// Creates the message `bytes` for the namespace `namespace`.
    pub fn new(namespace: &'a str, bytes: &'a [u8]) -> Self {
        Self { namespace, bytes, signed: SshSig::signed_data(namespace, HashAlg::Sha512, bytes).ok() }
    }
}

/// Signature whose form is correct; [`Signature::verify`] checks it against a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Signature {
    inner: SshSig,
    key: PublicKey,
    armor: String,
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
        match as_openssh_writes_it(armor) {
            Some(inner) => Self::checked(inner, armor.to_owned()),
            None => Err(why_refused(armor)),
        }
    }

    /// Writes a signature block in the form that OpenSSH writes.
    pub(super) fn of(inner: SshSig) -> Result<Self, SignatureError> {
        let armor = inner.to_pem(ssh_key::LineEnding::LF).map_err(refusal)?;
        Self::checked(inner, armor)
    }

    /// Checks the fields of a block that has this armor.
    fn checked(inner: SshSig, armor: String) -> Result<Self, SignatureError> {
        if inner.version() != SshSig::VERSION {
            return Err(SignatureError::Version(inner.version()));
        }
        if !inner.reserved().is_empty() {
            return Err(SignatureError::Reserved(inner.reserved().len()));
        }
        if inner.hash_alg() != HashAlg::Sha512 {
            return Err(SignatureError::HashAlgorithm(inner.hash_alg().to_string()));
        }
        let key_type = inner.public_key().algorithm();
        let key = PublicKey::from_data(inner.public_key().clone()).map_err(|error| match error {
            KeyError::OtherKeyType(found) => SignatureError::KeyType(found),
            damaged => SignatureError::Damaged(damaged.to_string()),
        })?;
        if inner.algorithm() != key_type {
            return Err(SignatureError::Algorithm {
                key: key_type.to_string(),
                signature: inner.algorithm().to_string(),
            });
        }
        Ok(Self { inner, key, armor })
    }

    /// Returns the block as OpenSSH writes it: 70 columns wide, with a line feed after the last line.
    pub fn to_armor(&self) -> String {
        self.armor.clone()
    }

    pub(crate) fn armor(&self) -> &str {
        &self.armor
    }

    pub(crate) fn namespace(&self) -> &str {
        self.inner.namespace()
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

    /// Verifies a message that is already hashed, with the key's curve point if that is already known.
    pub(crate) fn verify_message(&self, message: &Message, point: Option<&KeyPoint>) -> Result<(), SignatureError> {
        if self.namespace() != message.namespace {
            let found = self.namespace().to_owned();
            return Err(SignatureError::WrongNamespace { found, expected: message.namespace.to_owned() });
        }
        let signed = message.signed.as_deref().ok_or(SignatureError::DoesNotHold)?;
        let own;
        let point = match point.filter(|point| point.is_of(&self.key)) {
            Some(point) => point,
            None => {
                own = KeyPoint::of(&self.key).ok_or(SignatureError::DoesNotHold)?;
                &own
            }
        };
        let bytes = self.inner.signature_bytes();
        match &self.key.data {
            KeyData::SkEd25519(key) => {
                let (signature, flags_and_counter) =
                    bytes.split_at_checked(ed25519_dalek::SIGNATURE_LENGTH).ok_or(SignatureError::DoesNotHold)?;
                point.verify(&signed_by_token(key.application(), flags_and_counter, signed), signature)
            }
            _ => point.verify(signed, bytes),
        }
    }
}

/// Parses a block that is byte for byte as OpenSSH writes it; returns `None` for any other.
fn as_openssh_writes_it(armor: &str) -> Option<SshSig> {
    let base64 = base64_of(armor);
    if wrapped(&base64, LINE_LENGTH) != armor {
        return None;
    }
    // Unused bits must be 0, so that no two texts encode the same bytes.
    let bytes = Base64::decode_vec(&base64).ok()?;
    let block = SshSig::decode(&mut bytes.as_slice()).ok()?;
    let mut written = Vec::with_capacity(bytes.len());
    block.encode(&mut written).ok()?;
    (written == bytes).then_some(block)
}

/// Returns the reason why a block that is not as OpenSSH writes it is refused.
fn why_refused(armor: &str) -> SignatureError {
    let base64 = base64_of(armor);
    if let Some(other) = Base64::decode_vec(&base64).ok().and_then(|block| other_key_type(&block)) {
        return SignatureError::KeyType(other);
    }
    // A block that was wrapped again is not damaged.
    match SshSig::from_pem(wrapped(&base64, LINE_LENGTH)).map_err(refusal) {
        Ok(_) => SignatureError::NotCanonical,
        Err(SignatureError::Damaged(_)) => SignatureError::Damaged(damage(armor).to_owned()),
        Err(known) => known,
    }
}

/// Returns the type of the key in a whole block (OpenSSH's PROTOCOL.sshsig) if that type cannot sign passports.
fn other_key_type(block: &[u8]) -> Option<String> {
    let mut wire = Wire::new(block.strip_prefix(b"SSHSIG")?);
    let (_version, key) = (wire.u32().ok()?, wire.string().ok()?);
    let (_namespace, _reserved, _hash) = (wire.string().ok()?, wire.string().ok()?, wire.string().ok()?);
    let mut signature = Wire::new(wire.string().ok().filter(|_| wire.rest.is_empty())?);
    let (_algorithm, _signature) = (signature.string().ok()?, signature.string().ok()?);
    match AnyKey::from_blob(key).ok()? {
        AnyKey::Other { algorithm, .. } => Some(algorithm),
        AnyKey::Signing(_) => None,
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

/// Returns a block whose lines of base64 have this length.
fn wrapped(base64: &str, length: usize) -> String {
    let lines: Vec<_> = base64.as_bytes().chunks(length).map(String::from_utf8_lossy).collect();
    format!("{FIRST_LINE}\n{}\n{LAST_LINE}\n", lines.join("\n"))
}

/// Returns the data that a security key signs instead of the message (PROTOCOL.u2f, SSH U2F Signatures).
fn signed_by_token(application: &str, flags_and_counter: &[u8], message: &[u8]) -> Vec<u8> {
    [&Sha256::digest(application)[..], flags_and_counter, &Sha256::digest(message)].concat()
}

/// Curve point of a public key, decoded once for many signatures.
#[derive(Debug, Clone)]
pub struct KeyPoint(pub(super) VerifyingKey);

impl KeyPoint {
    /// Decodes the curve point of a key; returns `None` if its bytes are not a point.
    pub(super) fn of(key: &PublicKey) -> Option<Self> {
        VerifyingKey::from_bytes(point_bytes(key)?).ok().map(Self)
    }

    fn is_of(&self, key: &PublicKey) -> bool {
        point_bytes(key) == Some(self.0.as_bytes())
    }

    fn verify(&self, message: &[u8], signature: &[u8]) -> Result<(), SignatureError> {
        let signature = ed25519_dalek::Signature::from_slice(signature).map_err(|_| SignatureError::DoesNotHold)?;
        self.0.verify_strict(message, &signature).map_err(|_| SignatureError::DoesNotHold)
    }
}

fn point_bytes(key: &PublicKey) -> Option<&[u8; 32]> {
    match &key.data {
        KeyData::Ed25519(key) => Some(&key.0),
        KeyData::SkEd25519(key) => Some(&key.public_key().0),
        _ => None,
    }
}

fn refusal(error: ssh_key::Error) -> SignatureError {
    match error {
        ssh_key::Error::Version { number } => SignatureError::Version(number),
        other => SignatureError::Damaged(other.to_string()),
    }
}

#[cfg(all(test, feature = "factory"))]
mod tests {
    use super::*;
    use crate::trust::SigningKey;

    const NAMESPACE: &str = "dtg-passport";
    const MESSAGE: &[u8] = b"format: \"dtg-passport/1\"\n";

    fn armored(blob: &[u8], width: usize) -> String {
        wrapped(&Base64::encode_string(blob), width)
    }

    fn blob(armor: &str) -> Vec<u8> {
        Base64::decode_vec(&armor.lines().filter(|line| !line.starts_with('-')).collect::<String>()).unwrap()
    }

    fn accepted(armor: &str) -> bool {
        Signature::from_armor(armor).is_ok_and(|signature| signature.verify(NAMESPACE, MESSAGE).is_ok())
    }

    fn signed() -> String {
        SigningKey::generate().unwrap().sign(NAMESPACE, MESSAGE).unwrap().to_armor()
    }

    #[test]
    fn a_signature_holds_for_its_text_and_namespace_alone() {
        let key = SigningKey::generate().unwrap();
        let signature = key.sign(NAMESPACE, MESSAGE).unwrap();
        let read = Signature::from_armor(&signature.to_armor()).unwrap();
        assert_eq!(read, signature);
        assert_eq!((read.namespace(), read.public_key()), (NAMESPACE, &key.public_key()));
        assert_eq!(read.verify(NAMESPACE, MESSAGE), Ok(()));
        assert_eq!(read.verify(NAMESPACE, &MESSAGE[1..]), Err(SignatureError::DoesNotHold));
        let (found, expected) = (NAMESPACE.to_owned(), "dtg-revocation".to_owned());
        let wrong = Err(SignatureError::WrongNamespace { found, expected });
        assert_eq!(read.verify("dtg-revocation", MESSAGE), wrong);
        assert_eq!(key.sign("", MESSAGE).unwrap_err(), crate::trust::KeyError::Namespace);
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
        let forged = Signature::from_armor(&armored(&forged, 70)).unwrap();
        assert_eq!(forged.public_key(), &key.public_key());
        for point in [None, Some(&other.point()), Some(&key.point())] {
            assert_eq!(forged.verify_message(&message, point), Err(SignatureError::DoesNotHold));
        }
    }

    /// Each bit of the block is in one character of the armor, so this also changes every bit of the block.
    #[test]
    fn every_single_bit_and_byte_of_the_armor_counts() {
        let armor = signed();
        assert!(accepted(&armor));
        for at in 0..armor.len() {
            for bit in 0..8 {
                let mut bytes = armor.clone().into_bytes();
                bytes[at] ^= 1 << bit;
                assert!(!String::from_utf8(bytes).is_ok_and(|text| accepted(&text)), "bit {bit} of byte {at}");
            }
            for byte in (0..128).filter(|byte| *byte != armor.as_bytes()[at]) {
                let mut bytes = armor.clone().into_bytes();
                bytes[at] = byte;
                assert!(!accepted(std::str::from_utf8(&bytes).unwrap()), "byte {at} changed to {byte}");
            }
            let (before, after) = armor.split_at(at);
            assert!(!accepted(&format!("{before}{}", &after[1..])), "byte {at} removed");
            assert!(!accepted(&format!("{before}{}{after}", &after[..1])), "byte {at} doubled");
            assert!(!accepted(before), "cut at {at}");
        }
    }

    #[test]
    fn every_deviation_of_the_block_has_its_own_words() {
        let refused = |blob: &[u8], width| Signature::from_armor(&armored(blob, width)).unwrap_err();
        let good = blob(&signed());
        for version in [0, 2] {
            let mut altered = good.clone();
            altered[9] = version;
            assert_eq!(refused(&altered, 70), SignatureError::Version(u32::from(version)));
        }
        // The reserved field and the name of the hash algorithm follow the preamble, the version, the key and the
        // namespace.
        let reserved = 6 + 4 + (4 + 51) + (4 + NAMESPACE.len());
        assert_eq!(&good[reserved..reserved + 14], b"\0\0\0\0\0\0\0\x06sha512");
        let with_reserved = [&good[..reserved], b"\0\0\0\x02xy", &good[reserved + 4..]].concat();
        assert_eq!(refused(&with_reserved, 70), SignatureError::Reserved(2));
        let sha256 = [&good[..reserved + 8], b"sha256", &good[reserved + 14..]].concat();
        assert_eq!(refused(&sha256, 70), SignatureError::HashAlgorithm("sha256".to_owned()));
        assert_eq!(refused(&good, 64), SignatureError::NotCanonical);
        assert_eq!(refused(&good, 76), SignatureError::NotCanonical);
        let longer = [&good[..], b"x"].concat();
        assert!(matches!(refused(&longer, 70), SignatureError::Damaged(_)));
        let of_length = |bytes| Signature::from_armor(&"x".repeat(bytes)).unwrap_err().to_string();
        assert!(of_length(8193).contains("8193 bytes, expected at most 8192"));
        assert!(!of_length(8192).contains("expected at most"));
        let crlf = armored(&good, 70).replace('\n', "\r\n");
        assert_eq!(Signature::from_armor(&crlf), Err(SignatureError::NotCanonical));
    }
}
