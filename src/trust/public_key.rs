//! Public keys that can sign passports.

use super::error::KeyError;
use super::wire::{Wire, string};
use crate::text::without_secrets;
use base64ct::{Base64, Encoding};
use sha2::{Digest, Sha256};
use ssh_key::Algorithm;
use ssh_key::public::KeyData;

/// Key types that OpenSSH writes into a public key line, with the number of fields after the type. Certificates are
/// excluded, because this project trusts keys, not authorities.
const KEY_TYPES: [(&str, usize); 8] = [
    ("ssh-ed25519", 1),
    ("sk-ssh-ed25519@openssh.com", 2),
    ("ecdsa-sha2-nistp256", 2),
    ("ecdsa-sha2-nistp384", 2),
    ("ecdsa-sha2-nistp521", 2),
    ("sk-ecdsa-sha2-nistp256@openssh.com", 3),
    ("ssh-rsa", 2),
    ("ssh-dss", 4),
];

/// Public key that can sign passports: `ssh-ed25519` or `sk-ssh-ed25519@openssh.com`.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PublicKey {
    pub(super) data: KeyData,
    /// Key as SSH transmits it, from which fingerprints are computed.
    pub(super) blob: Vec<u8>,
}

/// Returns the fingerprint of a key as SSH transmits it, as `ssh-keygen -l` prints it.
pub(super) fn fingerprint(blob: &[u8]) -> String {
    let base64 = Base64::encode_string(&Sha256::digest(blob));
    format!("SHA256:{}", base64.trim_end_matches('='))
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
        fingerprint(&self.blob)
    }

    /// Returns the key type as OpenSSH names it.
    pub(crate) fn algorithm(&self) -> &'static str {
        if self.data.is_sk_ed25519() { KEY_TYPES[1].0 } else { KEY_TYPES[0].0 }
    }

    /// Returns `true` if the private half is in a security key (FIDO token).
    pub fn is_security_key(&self) -> bool {
        self.data.is_sk_ed25519()
    }

    /// Creates the public half of a private key of this process.
    pub(super) fn of_ed25519(key: ssh_key::public::Ed25519PublicKey) -> Self {
        let blob = [string(KEY_TYPES[0].0.as_bytes()), string(&key.0)].concat();
        Self { data: key.into(), blob }
    }

    /// Checks a decoded key by the rules for a key line.
    pub(super) fn from_data(data: KeyData) -> Result<Self, KeyError> {
        // OpenSSH reads the application as a C string, and refuses one with an embedded NUL.
        if data.sk_ed25519().is_some_and(|key| key.application().contains('\0')) {
            return Err(KeyError::DamagedPublicKey("its application contains a NUL byte".to_owned()));
        }
        match data.algorithm() {
            Algorithm::Ed25519 | Algorithm::SkEd25519 => {}
            other => return Err(KeyError::OtherKeyType(other.to_string())),
        }
        let damaged = |error: ssh_key::Error| KeyError::DamagedPublicKey(error.to_string());
        let blob = ssh_key::PublicKey::from(data.clone()).to_bytes().map_err(damaged)?;
        Ok(Self { data, blob })
    }
}

fn not_a_public_key<T>(found: &str) -> Result<T, KeyError> {
    Err(KeyError::NotAPublicKey(found.to_owned()))
}

/// Public key of any type that OpenSSH knows, because lists may contain keys that cannot sign passports.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct AnyKey {
    algorithm: &'static str,
    /// Key as SSH transmits it.
    pub(super) blob: Vec<u8>,
}

impl AnyKey {
    /// Returns `true` if `word` has the form of a key type, known or not.
    pub(super) fn is_type(word: &str) -> bool {
        ["ssh-", "ecdsa-", "sk-"].iter().any(|family| word.starts_with(family)) && !word.contains(['=', ',', '"'])
    }

    pub(super) fn read(algorithm: &str, base64: &str) -> Result<Self, KeyError> {
        let Some(&(algorithm, fields)) = KEY_TYPES.iter().find(|(name, _)| *name == algorithm) else {
            return match algorithm {
                certificate if certificate.contains("-cert-v0") => {
                    not_a_public_key(&format!("a certificate ({})", shortened(certificate)))
                }
                unknown => not_a_public_key(&format!("`{}`, which is not a key type", shortened(unknown))),
            };
        };
        let blob = Base64::decode_vec(base64)
            .map_err(|_| KeyError::DamagedPublicKey("its base64 is truncated or changed".to_owned()))?;
        check_fields(&blob, algorithm, fields).map_err(KeyError::DamagedPublicKey)?;
        Ok(Self { algorithm, blob })
    }

    pub(super) fn signing(self) -> Result<PublicKey, KeyError> {
        if self.algorithm != KEY_TYPES[0].0 && self.algorithm != KEY_TYPES[1].0 {
            return Err(KeyError::OtherKeyType(self.algorithm.to_owned()));
        }
        let key = ssh_key::PublicKey::from_bytes(&self.blob)
            .map_err(|error| KeyError::DamagedPublicKey(error.to_string()))?;
        PublicKey::from_data(key.key_data().clone())
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

/// Checks that bytes are a key of a type that OpenSSH knows, as SSH transmits it, or returns their fault in words.
pub(super) fn check_blob(blob: &[u8]) -> Result<(), String> {
    let named = Wire::new(blob).string()?;
    match KEY_TYPES.iter().find(|(name, _)| name.as_bytes() == named) {
        Some((algorithm, fields)) => check_fields(blob, algorithm, *fields),
        None => Err(format!("`{}`, which is not a key type", shortened(&String::from_utf8_lossy(named)))),
    }
}

/// Checks that a key consists of the name of its type and as many strings as the type has fields.
fn check_fields(blob: &[u8], algorithm: &str, fields: usize) -> Result<(), String> {
    let mut wire = Wire::new(blob);
    let named = wire.string()?;
    if named != algorithm.as_bytes() {
        let found = shortened(&String::from_utf8_lossy(named));
        return Err(format!("it says {algorithm}, its base64 says `{found}`"));
    }
    for _ in 0..fields {
        let field = wire.string()?;
        if algorithm == KEY_TYPES[0].0 && field.len() != 32 {
            return Err(format!("a key of {} bytes, expected 32", field.len()));
        }
    }
    match wire.rest.len() {
        0 => Ok(()),
        more => Err(format!("{more} bytes after its end")),
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
    fn a_line_is_read_and_written_without_its_comment() {
        let key = PublicKey::from_openssh(LINE).unwrap();
        assert_eq!(key.to_openssh(), LINE.rsplit_once(' ').unwrap().0);
        assert_eq!(PublicKey::from_openssh(&format!("{LINE}\r\n")), Ok(key.clone()));
        assert!(!key.is_security_key());
        assert!(key.fingerprint().starts_with("SHA256:") && key.fingerprint().len() == 50);
    }

    #[test]
    fn other_texts_are_told_apart() {
        assert!(refused("").contains("found nothing"));
        assert!(refused("ssh-ed25519").contains("a single word"));
        assert!(refused(&format!("{LINE}\n{LINE}")).contains("several lines"));
        assert!(refused("-----BEGIN OPENSSH PRIVATE KEY-----\nAAAA").contains("a private key file"));
        assert!(refused("ssh-foo AAAA").contains("`ssh-foo`, which is not a key type"));
        assert!(refused("ssh-ed25519-cert-v01@openssh.com AAAA").contains("a certificate"));
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

    #[test]
    fn other_key_types_are_named() {
        let blob = b"\0\0\0\x07ssh-rsa\0\0\0\x03\x01\0\x01\0\0\0\x03\x05\0\x01";
        let line = format!("ssh-rsa {}", Base64::encode_string(blob));
        assert_eq!(PublicKey::from_openssh(&line), Err(KeyError::OtherKeyType("ssh-rsa".to_owned())));
    }
}
