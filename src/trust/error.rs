//! What can be wrong with a key or a signature, in words that say what to do.

use crate::text::Printable;
use thiserror::Error;

/// Why a key cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum KeyError {
    /// Not a line of OpenSSH's public key format.
    #[error("found {}, expected a public key in one line, such as `ssh-ed25519 AAAA… comment`", Printable(found))]
    NotAPublicKey {
        /// What was found instead.
        found: String,
    },
    /// A public key whose base64 or its content does not hold together.
    #[error("the public key is damaged: {}; copy the whole line again", Printable(.0))]
    DamagedPublicKey(String),
    /// A good key of a type that signs no passport.
    #[error("found a key of type {}, expected ssh-ed25519 or sk-ssh-ed25519@openssh.com", Printable(found))]
    OtherKeyType {
        /// The type as OpenSSH names it.
        found: String,
    },
    /// Not a private key file of OpenSSH.
    #[error("found {found}, expected a private key file of OpenSSH (`-----BEGIN OPENSSH PRIVATE KEY-----`); {advice}")]
    NotAPrivateKey {
        /// What was found instead.
        found: &'static str,
        /// What to do about it.
        advice: &'static str,
    },
    /// The file beside a security key: the private half is in the token.
    #[error(
        "the private half of this key is in a security key (FIDO token); give the .pub file, and ssh-keygen will sign \
         with the token"
    )]
    SecurityKey,
    /// The file beside a security key, encrypted: `ssh-keygen` would ask for its passphrase at every signature.
    #[error(
        "the private half of this key is in a security key (FIDO token), and the file is encrypted; add it to \
         ssh-agent \
         (`ssh-add KEY`) and give the .pub file"
    )]
    EncryptedSecurityKey,
    /// The private key is encrypted and no passphrase was given.
    #[error("the private key is encrypted; its passphrase is needed")]
    Encrypted,
    /// The passphrase does not open the private key.
    #[error("the private key cannot be decrypted (wrong passphrase or damaged file)")]
    WrongPassphrase,
    /// An empty passphrase was given to encrypt with.
    #[error("the passphrase is empty; give one, or request an unencrypted key")]
    EmptyPassphrase,
    /// The private key is encrypted in a way that is not read here.
    #[error(
        "the private key is encrypted with {}, which is not supported; encrypt it again with `ssh-keygen -p -f KEY`",
        Printable(found)
    )]
    Encryption {
        /// The cipher, or what is unusual about the encryption.
        found: String,
    },
    /// A private key file whose content does not hold together.
    #[error("the private key file is damaged: {}; restore it from a copy", Printable(.0))]
    DamagedPrivateKey(String),
    /// A comment that would not stay on the line of the public key.
    #[error("the comment of the key contains a control character; use one line of plain text")]
    Comment,
    /// A namespace that OpenSSH does not sign for.
    #[error("the namespace of a signature is empty")]
    Namespace,
    /// The operating system gives no random bytes.
    #[error("the operating system returned no random bytes: {0}")]
    NoRandomness(String),
}

/// Why a signature is not accepted.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SignatureError {
    /// The text is not OpenSSH's armor, or what it holds does not hold together.
    #[error("the signature block is damaged or not from OpenSSH: {}", Printable(.0))]
    Damaged(String),
    /// Another version of the format; the version is not signed, so only one can be accepted.
    #[error("the signature block has format version {found}, expected 1")]
    Version {
        /// The version found.
        found: u32,
    },
    /// The reserved field is not empty.
    #[error("the signature block has {length} reserved bytes, expected none")]
    Reserved {
        /// How many bytes it holds.
        length: usize,
    },
    /// The message was hashed in another way.
    #[error("the signed text was hashed with {}, expected sha512", Printable(found))]
    HashAlgorithm {
        /// The algorithm found.
        found: String,
    },
    /// Signed with a key of a type that signs no passport.
    #[error("signed with {}, expected a key of type ssh-ed25519 or sk-ssh-ed25519@openssh.com", Printable(found))]
    KeyType {
        /// The type found.
        found: String,
    },
    /// The signature is of another algorithm than its key.
    #[error("the key has type {}, but its signature type {}", Printable(key), Printable(signature))]
    Algorithm {
        /// The key's type.
        key: String,
        /// The signature's type.
        signature: String,
    },
    /// The armor is not byte for byte the one that OpenSSH writes for its content.
    #[error("the signature block is not written as by OpenSSH (line length, line ends or padding)")]
    NotCanonical,
    /// A signature made for another purpose.
    #[error("the signature is for the namespace \"{}\", expected {expected:?}", Printable(found))]
    WrongNamespace {
        /// The namespace of the signature.
        found: String,
        /// The namespace that is verified for.
        expected: String,
    },
    /// The signature is not this key's for this text.
    #[error("the signature does not match the text; the text or the signature was changed after signing")]
    DoesNotHold,
}
