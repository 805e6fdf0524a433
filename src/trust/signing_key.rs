//! Private signing keys: Ed25519, in OpenSSH's file format (OpenSSH's PROTOCOL.key).

use super::public_key::{AnyKey, shortened};
use super::wire::{Truncated, Wire};
use super::{KeyError, KeyPoint, Message, PublicKey, Signature};
use crate::text::Kind;
use base64ct::{Base64, Encoding};
use ed25519_dalek::Signer as _;
use ssh_key::private::{Ed25519Keypair, KeypairData};
use ssh_key::rand_core::{OsRng, RngCore as _};
use ssh_key::{Cipher, Kdf, LineEnding, PrivateKey};
use std::fmt::{self, Debug, Formatter};
use zeroize::Zeroizing;

/// Number of bcrypt rounds, which slow down guessing of the passphrase; newer releases of OpenSSH use as many.
const BCRYPT_ROUNDS: u32 = 24;
/// Number of bcrypt rounds above which the file is reported as damaged, because opening it would take hours.
const MOST_BCRYPT_ROUNDS: u32 = 10_000;
/// Longest private key file that is read, in bytes: far more than the largest RSA key needs.
const LONGEST_FILE: usize = 1 << 16;
const FIRST_LINE: &str = "-----BEGIN OPENSSH PRIVATE KEY-----";
const LAST_LINE: &str = "-----END OPENSSH PRIVATE KEY-----";

/// Ed25519 signing key. The secret is erased from memory when the key is dropped, and is never printed.
pub struct SigningKey {
    key: ed25519_dalek::SigningKey,
}

impl Debug for SigningKey {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        f.debug_struct("SigningKey").field("public_key", &self.public_key().fingerprint()).finish_non_exhaustive()
    }
}

impl SigningKey {
    /// Creates a new key from the operating system's random bytes.
    ///
    /// # Errors
    /// Returns [`KeyError::NoRandomness`] if the operating system provides none.
    pub fn generate() -> Result<Self, KeyError> {
        let mut secret = Zeroizing::new([0; 32]);
        random(&mut *secret)?;
        Ok(Self { key: ed25519_dalek::SigningKey::from_bytes(&secret) })
    }

    /// Reads an OpenSSH private key file. A passphrase for a file that is not encrypted is ignored.
    ///
    /// # Errors
    /// Returns [`KeyError::NotAPrivateKey`] for other files and formats, [`KeyError::OtherKeyType`] or
    /// [`KeyError::SecurityKey`] for other key types, [`KeyError::Encrypted`] for an encrypted file without a
    /// passphrase, [`KeyError::WrongPassphrase`] for a wrong passphrase, [`KeyError::Encryption`] for an unsupported
    /// encryption, and [`KeyError::DamagedPrivateKey`] for a damaged file.
    pub fn from_openssh(pem: &str, passphrase: Option<&str>) -> Result<Self, KeyError> {
        let pem = pem.trim_start_matches('\u{feff}').trim();
        check_kind(pem)?;
        check_header(pem)?;
        let file = PrivateKey::from_openssh(pem).map_err(damaged)?;
        let opened = if file.is_encrypted() { decrypted(&file, passphrase)? } else { file };
        match opened.key_data() {
            KeypairData::Ed25519(pair) => {
                let key = ed25519_dalek::SigningKey::try_from(pair).map_err(damaged)?;
                Ok(Self { key })
            }
            _ => Err(KeyError::OtherKeyType(opened.algorithm().to_string())),
        }
    }

    /// Writes the key in OpenSSH's format; with a passphrase, it is encrypted with aes256-ctr and bcrypt, as by
    /// `ssh-keygen`.
    ///
    /// # Errors
    /// Returns [`KeyError::EmptyPassphrase`] for an empty passphrase, [`KeyError::Comment`] for a comment with a
    /// control character, and [`KeyError::NoRandomness`] if the operating system provides no random bytes.
    pub fn to_openssh(&self, comment: &str, passphrase: Option<&str>) -> Result<Zeroizing<String>, KeyError> {
        if comment.chars().any(char::is_control) {
            return Err(KeyError::Comment);
        }
        if passphrase == Some("") {
            return Err(KeyError::EmptyPassphrase);
        }
        let pair = KeypairData::from(Ed25519Keypair::from(&self.key));
        let plain = PrivateKey::new(pair, comment).map_err(damaged)?;
        match passphrase {
            None => plain.to_openssh(LineEnding::LF).map_err(damaged),
            Some(passphrase) => {
                let (mut salt, mut check) = (vec![0; 16], [0; 4]);
                random(&mut salt)?;
                random(&mut check)?;
                let kdf = Kdf::Bcrypt { salt, rounds: BCRYPT_ROUNDS };
                let sealed = plain
                    .encrypt_with(Cipher::Aes256Ctr, kdf, u32::from_be_bytes(check), passphrase)
                    .map_err(damaged)?;
                sealed.to_openssh(LineEnding::LF).map_err(damaged)
            }
        }
    }

    /// Returns the public key.
    pub fn public_key(&self) -> PublicKey {
        PublicKey::new(self.key.verifying_key().to_bytes(), None)
    }

    pub(crate) fn point(&self) -> KeyPoint {
        KeyPoint(self.key.verifying_key())
    }

    /// Signs `message` for `namespace`. The signature is deterministic, and equal to that of `ssh-keygen -Y sign`.
    ///
    /// # Errors
    /// Returns [`KeyError::Namespace`] if the namespace is empty.
    pub fn sign(&self, namespace: &str, message: &[u8]) -> Result<Signature, KeyError> {
        self.sign_message(&Message::new(namespace, message))
    }

    pub(crate) fn sign_message(&self, message: &Message) -> Result<Signature, KeyError> {
        let signature = self.key.sign(message.signed.as_deref().ok_or(KeyError::Namespace)?);
        Ok(Signature::of(self.public_key(), message.namespace, &signature.to_bytes()))
    }
}

fn random(bytes: &mut [u8]) -> Result<(), KeyError> {
    OsRng.try_fill_bytes(bytes).map_err(|error| KeyError::NoRandomness(error.to_string()))
}

fn damaged(error: ssh_key::Error) -> KeyError {
    KeyError::DamagedPrivateKey(error.to_string())
}

/// Decrypts a key. A wrong passphrase and altered bytes cannot be distinguished, because both produce random bytes.
fn decrypted(file: &PrivateKey, passphrase: Option<&str>) -> Result<PrivateKey, KeyError> {
    if let Kdf::Bcrypt { rounds, .. } = file.kdf()
        && *rounds > MOST_BCRYPT_ROUNDS
    {
        return Err(KeyError::Encryption(format!("{rounds} rounds of bcrypt")));
    }
    file.decrypt(passphrase.ok_or(KeyError::Encrypted)?).map_err(|error| match error {
        ssh_key::Error::Crypto => KeyError::WrongPassphrase,
        other => damaged(other),
    })
}

impl PublicKey {
    /// Reads the public half of a key from the text of its file, private or public. It is not encrypted in either.
    pub(crate) fn of_key_file(text: &str) -> Result<Self, KeyError> {
        let text = text.trim_start_matches('\u{feff}').trim();
        if !text.contains("PRIVATE KEY-----") {
            return Self::from_openssh(text);
        }
        check_kind(text)?;
        let file = PrivateKey::from_openssh(text).map_err(damaged)?;
        let blob = file.public_key().to_bytes().map_err(damaged)?;
        AnyKey::from_blob(&blob).map_err(KeyError::DamagedPublicKey)?.signing()
    }
}

/// Beginnings of other files, with what they are and advice.
const OTHER_FILES: [(&str, &str, &str); 7] = [
    ("-----BEGIN PRIVATE KEY", "a private key in PKCS#8 (PEM)", NEW_KEY),
    ("-----BEGIN ENCRYPTED PRIVATE KEY", "a private key in PKCS#8 (PEM)", NEW_KEY),
    ("-----BEGIN RSA", "an RSA key in PEM", NEW_KEY),
    ("-----BEGIN EC", "an ECDSA key in PEM", NEW_KEY),
    ("PuTTY-User-Key-File", "a private key of PuTTY", "export it with puttygen as an OpenSSH key"),
    ("-----BEGIN CERTIFICATE", "a certificate", NEW_KEY),
    ("---- BEGIN SSH2", "a public key", PRIVATE_HALF),
];
const NEW_KEY: &str = "create a key with `keygen`";
const PRIVATE_HALF: &str = "give the private key, the file without .pub";

/// Refuses a file that is not an OpenSSH private key, and reports its actual format.
fn check_kind(pem: &str) -> Result<(), KeyError> {
    if pem.starts_with(FIRST_LINE) {
        let whole = pem.len() <= LONGEST_FILE && pem.ends_with(LAST_LINE);
        let cut = || KeyError::DamagedPrivateKey(format!("it does not end with `{LAST_LINE}`"));
        return whole.then_some(()).ok_or_else(cut);
    }
    let (found, advice) = match OTHER_FILES.iter().find(|(start, ..)| pem.starts_with(start)) {
        Some((_, found, advice)) => (*found, *advice),
        None if pem.is_empty() => ("an empty file", "give the file that `keygen` wrote"),
        None if pem.split_ascii_whitespace().next().is_some_and(AnyKey::is_type) => ("a public key", PRIVATE_HALF),
        None => {
            let found = Kind::of(pem.as_bytes()).map_or("no private key", Kind::words);
            (found, "give the file that `keygen` or `ssh-keygen -t ed25519` wrote")
        }
    };
    Err(KeyError::NotAPrivateKey { found, advice })
}

/// Reads the unencrypted header of the file, and checks the key type and the encryption.
fn check_header(pem: &str) -> Result<(), KeyError> {
    let body = pem.strip_prefix(FIRST_LINE).and_then(|rest| rest.strip_suffix(LAST_LINE)).unwrap_or_default();
    let base64: Zeroizing<String> = Zeroizing::new(body.split_ascii_whitespace().collect());
    let bytes = Base64::decode_vec(&base64)
        .map(Zeroizing::new)
        .map_err(|_| KeyError::DamagedPrivateKey("its base64 is truncated or changed".to_owned()))?;
    let rest = bytes
        .strip_prefix(b"openssh-key-v1\0")
        .ok_or_else(|| KeyError::DamagedPrivateKey("its first bytes are not those of an OpenSSH key".to_owned()))?;
    // The cipher, and the type of the first key (PROTOCOL.key, sections 1 and 2).
    let header = || -> Result<[String; 2], Truncated> {
        let mut wire = Wire::new(rest);
        let cipher = wire.string()?;
        let (_kdf, _kdf_options, _keys) = (wire.string()?, wire.string()?, wire.u32()?);
        let key_type = wire.nested()?.string()?;
        Ok([cipher, key_type].map(|bytes| String::from_utf8_lossy(bytes).into_owned()))
    };
    let [cipher, key_type] = header().map_err(|error| KeyError::DamagedPrivateKey(error.to_string()))?;
    match key_type.as_str() {
        "ssh-ed25519" => {}
        "sk-ssh-ed25519@openssh.com" | "sk-ecdsa-sha2-nistp256@openssh.com" => {
            return Err(if cipher == "none" { KeyError::SecurityKey } else { KeyError::EncryptedSecurityKey });
        }
        other => return Err(KeyError::OtherKeyType(shortened(other))),
    }
    match cipher.parse::<Cipher>() {
        Ok(Cipher::TDesCbc) | Err(_) => Err(KeyError::Encryption(shortened(&cipher))),
        Ok(_) => Ok(()),
    }
}

#[cfg(all(test, feature = "factory"))]
mod tests {
    use super::*;
    use crate::trust::wire::string;

    fn refused(pem: &str) -> KeyError {
        SigningKey::from_openssh(pem, None).unwrap_err()
    }

    #[test]
    fn a_key_file_needs_a_passphrase_with_characters_and_a_comment_without_controls() {
        let key = SigningKey::generate().unwrap();
        assert_eq!(key.to_openssh("", Some("")), Err(KeyError::EmptyPassphrase));
        assert_eq!(key.to_openssh("a\nb", None), Err(KeyError::Comment));
        let sealed = key.to_openssh("", Some("пароль")).unwrap();
        assert_eq!(SigningKey::from_openssh(&sealed, Some("")).unwrap_err(), KeyError::WrongPassphrase);
        let plain = key.to_openssh("lab@factory", None).unwrap().replace('\n', "\r\n");
        assert_eq!(SigningKey::from_openssh(&plain, Some("ignored")).unwrap().public_key(), key.public_key());
    }

    #[test]
    fn the_secret_is_not_printed() {
        let key = SigningKey::generate().unwrap();
        let printed = format!("{key:?}");
        assert_eq!(printed, format!("SigningKey {{ public_key: {:?}, .. }}", key.public_key().fingerprint()));
    }

    #[test]
    fn other_files_are_told_apart() {
        let public = SigningKey::generate().unwrap().public_key().to_openssh();
        for (text, words) in [
            ("", "an empty file"),
            ("-----BEGIN ENCRYPTED PRIVATE KEY-----", "PKCS#8"),
            ("-----BEGIN CERTIFICATE-----", "found a certificate, expected an OpenSSH private key file"),
            ("---- BEGIN SSH2 PUBLIC KEY ----", "found a public key, expected an OpenSSH private key file"),
            (public.as_str(), "give the private key, the file without .pub"),
            ("PuTTY-User-Key-File-3: ssh-ed25519", "puttygen"),
            ("hello", "found no private key, expected"),
            ("-----BEGIN OPENSSH PRIVATE KEY-----\nAAAA", "does not end with"),
        ] {
            let refused = refused(text).to_string();
            assert!(refused.contains(words), "{text}: {refused}");
        }
    }

    fn armored(bytes: &[u8]) -> String {
        let base64 = Base64::encode_string(bytes);
        let lines: Vec<_> = base64.as_bytes().chunks(70).map(String::from_utf8_lossy).collect();
        format!("{FIRST_LINE}\n{}\n{LAST_LINE}", lines.join("\n"))
    }

    /// Expected: PROTOCOL.key, section 1, and the names of ciphers and key types in OpenSSH.
    #[test]
    fn the_header_tells_what_cannot_be_opened() {
        let checked = |cipher: &str, key_type: &str| {
            let key = string(&string(key_type.as_bytes()));
            let kdf = [string(b"bcrypt"), string(b"")].concat();
            let count = 1_u32.to_be_bytes();
            let file = [b"openssh-key-v1\0", &string(cipher.as_bytes())[..], &kdf, &count, &key].concat();
            check_header(&armored(&file))
        };
        let other = |found: &str| Err(KeyError::OtherKeyType(found.to_owned()));
        let encryption = |found: &str| Err(KeyError::Encryption(found.to_owned()));
        for (cipher, key_type, expected) in [
            ("none", "ssh-ed25519", Ok(())),
            ("aes256-ctr", "ssh-ed25519", Ok(())),
            ("none", "ssh-rsa", other("ssh-rsa")),
            ("aes256-ctr", "ecdsa-sha2-nistp256", other("ecdsa-sha2-nistp256")),
            ("none", "sk-ssh-ed25519@openssh.com", Err(KeyError::SecurityKey)),
            ("aes256-ctr", "sk-ssh-ed25519@openssh.com", Err(KeyError::EncryptedSecurityKey)),
            ("aes256-ctr", "sk-ecdsa-sha2-nistp256@openssh.com", Err(KeyError::EncryptedSecurityKey)),
            ("3des-cbc", "ssh-ed25519", encryption("3des-cbc")),
            ("rot13", "ssh-ed25519", encryption("rot13")),
        ] {
            assert_eq!(checked(cipher, key_type), expected, "{cipher}, {key_type}");
        }
    }

    #[test]
    fn a_file_that_would_take_hours_to_open_is_refused_at_once() {
        let sealed = SigningKey::generate().unwrap().to_openssh("", Some("x")).unwrap();
        let base64: String = sealed.lines().filter(|line| !line.starts_with('-')).collect();
        let mut bytes = Base64::decode_vec(&base64).unwrap();
        // The options of bcrypt are the salt, 16 bytes, and the number of rounds (PROTOCOL.key, section 3).
        let kdf = bytes.windows(10).position(|window| window == string(b"bcrypt")).unwrap();
        let rounds = kdf + 10 + 4 + (4 + 16);
        assert_eq!(bytes[rounds..rounds + 4], 24_u32.to_be_bytes());
        bytes[rounds..rounds + 4].copy_from_slice(&10_001_u32.to_be_bytes());
        let found = "10001 rounds of bcrypt".to_owned();
        let refused = SigningKey::from_openssh(&armored(&bytes), Some("x")).unwrap_err();
        assert_eq!(refused, KeyError::Encryption(found));
    }

    #[test]
    fn damage_anywhere_is_refused_without_a_panic() {
        let key = SigningKey::generate().unwrap();
        let pem = key.to_openssh("c", None).unwrap();
        for at in 0..pem.len() {
            let mut bytes = pem.as_bytes().to_vec();
            bytes[at] ^= 1;
            let altered = String::from_utf8(bytes).unwrap();
            // The check numbers and the comment are not part of the key; a change to any other byte must be detected.
            if let Ok(read) = SigningKey::from_openssh(&altered, None) {
                assert_eq!(read.public_key(), key.public_key(), "byte {at}");
            }
            let _ = SigningKey::from_openssh(&pem[..at], None);
        }
    }
}
