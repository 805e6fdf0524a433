//! Public keys that can sign passports.

use super::error::KeyError;
use super::wire::{Wire, string};
use crate::text::without_secrets;
use base64ct::{Base64, Encoding};
use sha2::{Digest, Sha256};

/// Key types that can sign passports, without and with a security key, and the type of their certificates.
const SIGNING: [(&str, &str); 2] = [
    ("ssh-ed25519", "ssh-ed25519-cert-v01@openssh.com"),
    ("sk-ssh-ed25519@openssh.com", "sk-ssh-ed25519-cert-v01@openssh.com"),
];

/// Longest name of a key type (RFC 4251, section 6).
const LONGEST_TYPE: usize = 64;

/// Public key that can sign passports: `ssh-ed25519` or `sk-ssh-ed25519@openssh.com`.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PublicKey {
    /// Key as SSH transmits it, from which fingerprints are computed.
    pub(super) blob: Vec<u8>,
    /// Encoded curve point.
    pub(super) point: [u8; 32],
    /// Application that a security key signs with each message.
    pub(super) application: Option<String>,
}

impl PublicKey {
    /// Reads a line of OpenSSH's public key format, `ssh-ed25519 AAAA… comment` (sshd(8), AUTHORIZED_KEYS FILE FORMAT,
    /// without options).
    ///
    /// # Errors
    /// Returns [`KeyError::NotAPublicKey`] for any other text, [`KeyError::DamagedPublicKey`] if type and base64 are
    /// inconsistent, and [`KeyError::OtherKeyType`] for a correct key that cannot sign passports.
    pub fn from_openssh(line: &str) -> Result<Self, KeyError> {
        let mut words = line.split_ascii_whitespace();
        match (words.next(), words.next()) {
            _ if line.contains("PRIVATE KEY-----") => not_a_public_key("a private key file"),
            _ if line.trim_end().contains('\n') => not_a_public_key("several lines"),
            (None, _) => not_a_public_key("nothing"),
            (Some(_), None) => not_a_public_key("a single word"),
            (Some(algorithm), Some(base64)) => AnyKey::read(algorithm, base64)?.signing(),
        }
    }

    /// Returns the key as OpenSSH writes it, without a comment.
    pub fn to_openssh(&self) -> String {
        format!("{} {}", self.algorithm(), Base64::encode_string(&self.blob))
    }

    /// Returns the fingerprint as `ssh-keygen -l` prints it, `SHA256:…`.
    pub fn fingerprint(&self) -> String {
        let base64 = Base64::encode_string(&Sha256::digest(&self.blob));
        format!("SHA256:{}", base64.trim_end_matches('='))
    }

    /// Returns the key type as OpenSSH names it.
    pub(crate) fn algorithm(&self) -> &'static str {
        SIGNING[usize::from(self.is_security_key())].0
    }

    /// Returns `true` if the private half is in a security key (FIDO token).
    pub fn is_security_key(&self) -> bool {
        self.application.is_some()
    }

    /// Creates a key from its point, and from the application if it is in a security key.
    pub(super) fn new(point: [u8; 32], application: Option<String>) -> Self {
        let (algorithm, _) = SIGNING[usize::from(application.is_some())];
        let mut blob = [string(algorithm.as_bytes()), string(&point)].concat();
        blob.extend(application.iter().flat_map(|application| string(application.as_bytes())));
        Self { blob, point, application }
    }
}

fn not_a_public_key<T>(found: &str) -> Result<T, KeyError> {
    Err(KeyError::NotAPublicKey(found.to_owned()))
}

/// Public key of any type, because lists and signatures may contain keys that cannot sign passports.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum AnyKey {
    Signing(PublicKey),
    /// Key of another type, or a certificate; `certified` is the key that it certifies if that can sign passports.
    Other {
        algorithm: String,
        certified: Option<PublicKey>,
    },
}

impl AnyKey {
    /// Returns `true` if `word` has the form of a key type, known or not.
    pub(super) fn is_type(word: &str) -> bool {
        ["ssh-", "ecdsa-", "sk-"].iter().any(|family| word.starts_with(family)) && !word.contains(['=', ',', '"'])
    }

    /// Returns the key if it can sign passports.
    pub(super) fn signing(self) -> Result<PublicKey, KeyError> {
        match self {
            Self::Signing(key) => Ok(key),
            Self::Other { algorithm, .. } => Err(KeyError::OtherKeyType(algorithm)),
        }
    }

    /// Reads the first two words of a public key line.
    pub(super) fn read(algorithm: &str, base64: &str) -> Result<Self, KeyError> {
        let damaged = |why: String| match Self::is_type(algorithm) {
            true => KeyError::DamagedPublicKey(why),
            false => KeyError::NotAPublicKey(format!("`{}`, which is not a key type", shortened(algorithm))),
        };
        let blob = Base64::decode_vec(base64).map_err(|_| damaged("its base64 is truncated or changed".to_owned()))?;
        match Wire::new(&blob).string() {
            Ok(named) if named == algorithm.as_bytes() => Self::from_blob(&blob).map_err(damaged),
            Ok(named) => {
                let found = shortened(&String::from_utf8_lossy(named));
                Err(damaged(format!("it says {algorithm}, its base64 says `{found}`")))
            }
            Err(truncated) => Err(damaged(truncated.to_string())),
        }
    }

    /// Reads a key as SSH transmits it (RFC 4253, section 6.6): the name of its type, then one or more strings.
    pub(super) fn from_blob(blob: &[u8]) -> Result<Self, String> {
        let mut wire = Wire::new(blob);
        let algorithm = String::from_utf8_lossy(wire.string()?).into_owned();
        if !(1..=LONGEST_TYPE).contains(&algorithm.len()) || !algorithm.bytes().all(|byte| byte.is_ascii_graphic()) {
            return Err(format!("`{}`, which is not a key type", shortened(&algorithm)));
        }
        let is_own = |(plain, certificate): &(&str, &str)| [*plain, *certificate].contains(&&*algorithm);
        let Some(place) = SIGNING.iter().position(is_own) else {
            // Only certificates also have other fields than strings.
            wire.string()?;
            while !algorithm.contains("-cert-v") && !wire.rest.is_empty() {
                wire.string()?;
            }
            return Ok(Self::Other { algorithm, certified: None });
        };
        let is_certificate = algorithm == SIGNING[place].1;
        if is_certificate {
            let _nonce = wire.string()?;
        }
        let point = wire.string()?;
        let point = point.try_into().map_err(|_| format!("a key of {} bytes, expected 32", point.len()))?;
        let application = if place == 1 { Some(application(wire.string()?)?) } else { None };
        let key = PublicKey::new(point, application);
        match wire.rest.len() {
            _ if is_certificate => Ok(Self::Other { algorithm, certified: Some(key) }),
            0 => Ok(Self::Signing(key)),
            more => Err(format!("{more} bytes after its end")),
        }
    }
}

/// Returns the application of a security key, which OpenSSH reads as a C string: it refuses one with an embedded NUL.
fn application(bytes: &[u8]) -> Result<String, String> {
    match std::str::from_utf8(bytes) {
        Ok(text) if text.contains('\0') => Err("its application contains a NUL byte".to_owned()),
        Ok(text) => Ok(text.to_owned()),
        Err(_) => Err("its application is not UTF-8".to_owned()),
    }
}

pub(super) fn shortened(word: &str) -> String {
    const LONGEST: usize = 60;
    let word = without_secrets(word);
    match word.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &word[..end]),
        None => word,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINE: &str = "ssh-ed25519 AAAAC3NzaC1lZDI1NTE5AAAAIBlFzDUVEFWiGFAFfTmbF2eTTQwbWmzvq3kJGoz5x1kO lab@factory";

    fn refused(line: &str) -> String {
        PublicKey::from_openssh(line).unwrap_err().to_string()
    }

    #[test]
    fn other_texts_are_told_apart() {
        assert!(refused("").contains("found nothing"));
        assert!(refused("ssh-ed25519").contains("a single word"));
        assert!(refused(&format!("{LINE}\n{LINE}")).contains("several lines"));
        assert!(refused("-----BEGIN OPENSSH PRIVATE KEY-----\nAAAA").contains("a private key file"));
        assert!(refused("foo AAAA").contains("`foo`, which is not a key type"));
        assert!(refused("ssh-foo AAAA").contains("the public key is damaged: an item of 4 bytes"));
    }

    #[test]
    fn damage_is_named() {
        assert!(refused(&LINE.replacen("AAAAC3", "AAAAC", 1)).contains("base64"));
        assert!(
            refused("ssh-rsa AAAAC3NzaC1lZDI1NTE5AAAAIBlFzDUVEFWiGFAFfTmbF2eTTQwbWmzvq3kJGoz5x1kO")
                .contains("its base64 says `ssh-ed25519`")
        );
        assert!(
            refused("ssh-ed25519 AAAAC3NzaC1lZDI1NTE5AAAAIBlFzDUVEFWiGFAFfTmbF2eTTQwbWmzvq3kJGoz5x1kOAAAA")
                .contains("3 bytes after its end")
        );
        assert!(refused("ssh-ed25519 AAAAC3NzaC1lZDI1NTE5AAAAIBlF").contains("only 2 bytes are left"));
    }
}
