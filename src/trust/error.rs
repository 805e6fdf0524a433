//! Errors of keys and signatures, with advice.

use crate::text::Printable;
use thiserror::Error;

/// Reason why a key cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum KeyError {
    /// The text is not a line of OpenSSH's public key format.
    #[error("found {}, expected a public key in one line, such as `ssh-ed25519 AAAA… comment`", Printable(.0))]
    NotAPublicKey(String),
    /// The base64 or the content of the public key is inconsistent.
    #[error("the public key is damaged: {}; copy the whole line again", Printable(.0))]
    DamagedPublicKey(String),
    /// The key is correct, but its type cannot sign passports.
    #[error("found a key of type {}, expected ssh-ed25519 or sk-ssh-ed25519@openssh.com", Printable(.0))]
    OtherKeyType(String),
    /// The file is not an OpenSSH private key file.
    #[error("found {found}, expected an OpenSSH private key file (`-----BEGIN OPENSSH PRIVATE KEY-----`); {advice}")]
    NotAPrivateKey {
        /// Content that was found instead.
        found: &'static str,
        /// Advice.
        advice: &'static str,
    },
    /// The file belongs to a security key, so the private half is in the token.
    #[error(
        "the private half of this key is in a security key (FIDO token); give the .pub file, and ssh-keygen will sign \
         with the token"
    )]
    SecurityKey,
    /// The file belongs to a security key and is encrypted: `ssh-keygen` would ask for its passphrase at every
    /// signature.
    #[error(
        "the private half of this key is in a security key (FIDO token), and the file is encrypted; add it to \
         ssh-agent (`ssh-add KEY`) and give the .pub file"
    )]
    EncryptedSecurityKey,
    /// The private key is encrypted and no passphrase was given.
    #[error("the private key is encrypted; its passphrase is needed")]
    Encrypted,
    /// The passphrase does not decrypt the private key.
    #[error("the private key cannot be decrypted (wrong passphrase or damaged file)")]
    WrongPassphrase,
    /// The passphrase for a new private key is empty.
    #[error("the passphrase is empty; give one, or request an unencrypted key")]
    EmptyPassphrase,
    /// The private key is encrypted with this cipher, or with this other property, which is not supported.
    #[error(
        "the private key is encrypted with {}, which is not supported; encrypt it again with `ssh-keygen -p -f KEY`",
        Printable(.0)
    )]
    Encryption(String),
    /// The content of the private key file is inconsistent.
    #[error("the private key file is damaged: {}; restore it from a copy", Printable(.0))]
    DamagedPrivateKey(String),
    /// The comment does not fit on the line of the public key.
    #[error("the comment of the key contains a control character; use one line of plain text")]
    Comment,
    /// The namespace is empty, and OpenSSH does not sign without one.
    #[error("the namespace of a signature is empty")]
    Namespace,
    /// The operating system provides no random bytes.
    #[error("the operating system returned no random bytes: {0}")]
    NoRandomness(String),
}

/// Reason why a signature is not accepted.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SignatureError {
    /// The text is not OpenSSH's armor, or its content is inconsistent.
    #[error("the signature block is damaged or not from OpenSSH: {}", Printable(.0))]
    Damaged(String),
    /// The format version is not 1. The version is not signed, so only one can be accepted.
    #[error("the signature block has format version {0}, expected 1")]
    Version(u32),
    /// The reserved field is not empty.
    #[error("the signature block has {0} reserved bytes, expected none")]
    Reserved(usize),
    /// The message was hashed with another algorithm.
    #[error("the signed text was hashed with {}, expected sha512", Printable(.0))]
    HashAlgorithm(String),
    /// The key type cannot sign passports.
    #[error("signed with {}, expected a key of type ssh-ed25519 or sk-ssh-ed25519@openssh.com", Printable(.0))]
    KeyType(String),
    /// The algorithm of the signature does not match the type of the key.
    #[error("the key has type {}, but its signature type {}", Printable(key), Printable(signature))]
    Algorithm {
        /// Key type.
        key: String,
        /// Signature type.
        signature: String,
    },
    /// The armor is not byte for byte as OpenSSH writes it.
    #[error("the signature block is not written as by OpenSSH (line length, line endings or padding)")]
    NotCanonical,
    /// The signature was made for another namespace.
    #[error("the signature is for the namespace \"{}\", expected {expected:?}", Printable(found))]
    WrongNamespace {
        /// Namespace of the signature.
        found: String,
        /// Namespace expected by the verifier.
        expected: String,
    },
    /// The signature does not match the key and the text.
    #[error("the signature does not match the text; the text or the signature was changed after signing")]
    DoesNotHold,
}
