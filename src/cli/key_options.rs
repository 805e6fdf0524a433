//! Values of the options `--key` and `--identity`: the signing key and the issuer. The passphrase of an encrypted key comes
//! from a terminal or from the environment.

use super::Failure;
use crate::document::Signer;
use crate::passport::Trust;
pub(super) use crate::signing::PASSPHRASE_VARIABLE;
use crate::signing::{self, KeyFileError};
use crate::text::shown;
use crate::trust::{BadIdentity, PublicKey, check_identity};
use jiff::Timestamp;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use zeroize::Zeroizing;

/// Returns the path of the public half of a key.
pub(super) fn with_pub(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".pub");
    PathBuf::from(name)
}

pub(super) fn identity(text: &str) -> Result<String, BadIdentity> {
    check_identity(text).map(|()| text.to_owned())
}

pub(super) fn signer_of(key: &Path) -> Result<Box<dyn Signer + Sync>, Failure> {
    signing::forbid_core_dumps();
    signing::signer(key, &ask).map_err(unusable)
}

/// Returns the public half of the key that would sign, for a dry run: no passphrase is asked for.
pub(super) fn key_to_sign_with(key: &Path) -> Result<PublicKey, Failure> {
    signing::forbid_core_dumps();
    signing::key_to_sign_with(key).map_err(unusable)
}

/// Refuses a dry run whose passports would fail verification by `trust`, as the passports themselves will be refused.
pub(super) fn refuse_distrusted(
    trust: &Trust,
    key: &PublicKey,
    identity: &str,
    issued_at: Timestamp,
) -> Result<(), Failure> {
    let Some(why) = signing::distrust(trust, key, identity, issued_at) else { return Ok(()) };
    Err(Failure::refused(format!(
        "--identity {identity}: the new passports would fail verification by --trust ({why}); check --key, --identity \
         and --trust"
    )))
}

fn unusable(error: KeyFileError) -> Failure {
    match error {
        KeyFileError::File(error) => error.into(),
        error => Failure::unusable(error),
    }
}

/// Reads the passphrase of an existing key.
fn ask(key: &Path) -> Result<Zeroizing<String>, String> {
    passphrase(&format!("Passphrase of {}: ", shown(key)))
}

/// Reads a passphrase from the environment, or from the terminal.
pub(super) fn passphrase(prompt: &str) -> Result<Zeroizing<String>, String> {
    if let Ok(passphrase) = std::env::var(PASSPHRASE_VARIABLE) {
        return Ok(Zeroizing::new(passphrase));
    }
    if !std::io::stdin().is_terminal() {
        return Err(format!("no terminal is available for the passphrase of the key; set {PASSPHRASE_VARIABLE}"));
    }
    rpassword::prompt_password(prompt).map(Zeroizing::new).map_err(|error| match error.kind() {
        std::io::ErrorKind::UnexpectedEof => "no passphrase was entered; enter one".to_owned(),
        _ => error.to_string(),
    })
}
