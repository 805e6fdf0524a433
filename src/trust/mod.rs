//! Trust: keys, signatures, allowed signers and revoked keys. Its results depend only on bytes and a time; it uses no
//! files, clock, process or environment.
//!
//! All formats are OpenSSH's own. Stock `ssh-keygen` therefore verifies the signatures of this program, and this
//! program verifies those of `ssh-keygen -Y sign`, also through ssh-agent or a FIDO token.
//!
//! * `sshsig`: signatures over a message for one namespace (OpenSSH's PROTOCOL.sshsig, PROTOCOL.u2f).
//! * `public_key`: keys that can sign passports.
//! * `signing_key`: private signing keys (OpenSSH's PROTOCOL.key).
//! * `allowed_signers`: principals, namespaces and validity periods of keys (ssh-keygen(1), ALLOWED SIGNERS).
//! * `revoked_keys`: keys that are no longer trusted, in a key revocation list (OpenSSH's PROTOCOL.krl) or a list of
//!   public keys.
//! * `principal`: names of signers in lists of allowed signers, and patterns of them.
//! * `error`: errors of keys and signatures.
//!
//! A correct signature shows that the bytes are those that the key signed; [`AllowedSigners`] and [`RevokedKeys`]
//! decide whether the key is trusted.

pub(crate) mod allowed_signers;
pub(crate) mod error;
mod krl;
mod lines;
pub(crate) mod principal;
pub(crate) mod public_key;
pub(crate) mod revoked_keys;
mod signer_line;
#[cfg(feature = "factory")]
pub(crate) mod signing_key;
pub(crate) mod sshsig;
mod wire;

pub use allowed_signers::{AllowedSigners, NotAuthorised};
pub use error::{KeyError, SignatureError};
pub use principal::BadIdentity;
pub(crate) use principal::check_identity;
pub use public_key::PublicKey;
pub use revoked_keys::RevokedKeys;
#[cfg(feature = "factory")]
pub use signing_key::SigningKey;
pub use sshsig::{KeyPoint, Message, Signature};

/// Largest trust file (allowed signers, revoked keys) that is read, in bytes: enough for 100,000 keys.
pub const LARGEST_TRUST_FILE_BYTES: usize = 1 << 24;
