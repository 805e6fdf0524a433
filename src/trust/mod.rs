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
//! * `identity`: names of signers in lists of allowed signers.
//! * `error`: errors of keys and signatures.
//!
//! A correct signature shows that the bytes are those that the key signed; [`AllowedSigners`] and [`RevokedKeys`]
//! decide whether the key is trusted.

pub(crate) mod allowed_signers;
pub(crate) mod error;
pub(crate) mod identity;
mod krl;
mod lines;
mod pattern;
pub(crate) mod public_key;
pub(crate) mod revoked_keys;
mod signer_line;
#[cfg(feature = "factory")]
pub(crate) mod signing_key;
pub(crate) mod sshsig;
mod wire;

pub use allowed_signers::{AllowedSigners, NotAuthorised};
pub use error::{KeyError, SignatureError};
pub use identity::BadIdentity;
pub(crate) use identity::check_identity;
pub use public_key::PublicKey;
pub use revoked_keys::RevokedKeys;
#[cfg(feature = "factory")]
pub use signing_key::SigningKey;
pub use sshsig::{KeyPoint, Message, Signature};

/// Largest trust file (allowed signers, revoked keys) that is read, in bytes: enough for 100,000 keys.
pub(crate) const LARGEST_TRUST_FILE_BYTES: usize = 1 << 24;

#[cfg(all(test, feature = "factory"))]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Reads the bytes with every reader of this module; none may panic.
    fn read_all(bytes: &[u8]) {
        let _ = AllowedSigners::parse("f", bytes).map_err(|error| error.to_string());
        let _ = RevokedKeys::parse("f", bytes).map_err(|error| error.to_string());
        let text = String::from_utf8_lossy(bytes);
        let _ = PublicKey::from_openssh(&text);
        let _ = Signature::from_armor(&text);
        let _ = SigningKey::from_openssh(&text, None);
    }

    fn examples() -> Vec<Vec<u8>> {
        let key = SigningKey::generate().unwrap();
        let line = key.public_key().to_openssh();
        vec![
            format!("\"a b,!ж*\" namespaces=\"x\\\",y\",valid-after=\"20260101Z\" {line} комментарий\n# end\r\n")
                .into_bytes(),
            format!("a,b cert-authority,valid-before=\"202601010000Z\" {line}").into_bytes(),
            b"SSHKRL\n\0\0\0\0\x01________________________\0\0\0\0\0\0\0\0\x02\0\0\0\x05\0\0\0\x01x".to_vec(),
            key.sign("n", b"m").unwrap().to_armor().into_bytes(),
            key.to_openssh("c", None).unwrap().as_bytes().to_vec(),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn no_reader_panics_on_any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
            read_all(&bytes);
        }

        #[test]
        fn no_reader_panics_on_any_text(text in "[a-z\",=!\\\\ \\tжZ0-9#\n-]{0,120}") {
            read_all(text.as_bytes());
        }

        #[test]
        fn no_reader_panics_on_altered_files(edits in prop::collection::vec((any::<usize>(), any::<u8>(), 0..4_u8), 1..8)) {
            for mut bytes in examples() {
                for (at, byte, kind) in &edits {
                    let at = at % (bytes.len() + 1);
                    match kind {
                        0 => bytes.truncate(at),
                        1 => bytes.insert(at, *byte),
                        _ => bytes.iter_mut().skip(at).take(1).for_each(|old| *old = *byte),
                    }
                }
                read_all(&bytes);
            }
        }
    }
}
