//! Verb `keygen`: a new signing key.

use super::key_options::{self, PASSPHRASE_VARIABLE, passphrase, with_pub};
use super::options::Formatted;
use super::{Code, Failure, open_workspace, output};
use crate::files::{self, Access, Durability};
use crate::signing::{self, allowed_signers_line, forbid_core_dumps};
use crate::text::{name_of, shown};
use crate::trust::SigningKey;
use crate::workspace::Workspace;
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf, absolute};
use zeroize::Zeroizing;

/// Create a signing key: KEY (mode 0600) and KEY.pub; print the line for allowed_signers, or append it
///
/// The program asks for the passphrase, or reads it from DTG_PASSPORT_PASSPHRASE.
#[derive(Args)]
#[command(verbatim_doc_comment)]
pub(super) struct Options {
    /// Private key file to write; an existing file is not replaced [default: that of the workspace, which then states
    /// the owner as its issuer and gets the line]
    key: PathBuf,
    /// Owner of the key: the issuer in allowed_signers and passports [default: the file name]
    #[arg(long, value_name = "WHO", value_parser = key_options::identity)]
    identity: Option<String>,
    /// Append the line to this file instead of printing it
    #[arg(long, value_name = "FILE")]
    allowed_signers: Option<PathBuf>,
    /// Leave the key unencrypted
    #[arg(long)]
    no_passphrase: bool,
    #[command(flatten)]
    _format: Formatted,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let stem = options.key.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    let identity = options.identity.clone().or(stem).unwrap_or_default();
    let public_path = with_pub(&options.key);
    // Check first, so that the program does not ask for a passphrase in vain.
    refuse_existing(&options.key)?;
    refuse_existing(&public_path)?;
    if options.key.extension().is_some_and(|extension| extension == "pub") {
        let (key, private) = (shown(&options.key), options.key.with_extension(""));
        return Err(Failure::usage(format!(
            "{key}: is the name of a public key, expected that of the private key; give {}, and {key} is written next \
             to it",
            shown(&private)
        )));
    }
    forbid_core_dumps();
    let key = SigningKey::generate().map_err(Failure::unusable)?;
    let line = allowed_signers_line(&identity, &key.public_key()).map_err(Failure::unusable)?;
    let signers = options.allowed_signers.as_deref();
    // For the same reason, check first that the line can be appended to the file.
    signers.map(|path| signing::with_signer(path, &line)).transpose().map_err(Failure::unusable)?;
    let is_the_key = |workspace: &&Workspace| workspace.key.as_deref().is_some_and(|key| same(key, &options.key));
    let workspace = open_workspace::workspace().filter(|workspace| workspace.identity.is_none()).filter(is_the_key);
    let settings = workspace.map(|workspace| workspace.with_identity(&identity)).transpose().map_err(Failure::usage)?;
    let passphrase = new_passphrase(options)?;
    let private = key.to_openssh(&identity, passphrase.as_ref().map(|p| p.as_str())).map_err(Failure::unusable)?;
    files::write_new(&options.key, private.as_bytes(), Access::Private, Durability::Named)?;
    let public = format!("{} {identity}\n", key.public_key().to_openssh());
    files::write_new(&public_path, public.as_bytes(), Access::Shared, Durability::Named)?;
    if let Some((path, text)) = settings {
        files::rewrite(&path, text.as_bytes())?;
        output::say(&format!("stated {identity} as the issuer in {}", shown(&path)));
    }
    let wrote = format!("wrote {} (keep it secret) and {}", shown(&options.key), shown(&public_path));
    let failed = signers.and_then(|path| signing::append_signer(path, &line).err());
    let appended_to = signers.filter(|_| failed.is_none());
    match appended_to {
        Some(path) => output::say(&format!("{wrote}; appended the line of the key to {}", shown(path))),
        None => output::say(&format!("{wrote}; add this line to allowed_signers:")),
    }
    if let Some(remark) = signing::protection_remark(&options.key) {
        output::warn(&remark);
    }
    match output::is_json() {
        false if appended_to.is_none() => output::result(&format!("{line}\n"))?,
        false => {}
        // A failure is then reported instead; its message comes after that with the line.
        _ if failed.is_some() => output::say(&line),
        true => output::value(&json!({
            "key": name_of(&options.key),
            "public_key": name_of(&public_path),
            "fingerprint": key.public_key().fingerprint(),
            "line": line,
            "appended_to": appended_to.map(name_of),
        }))?,
    }
    failed.map_or(Ok(0), |failed| Err(Failure::unusable(failed)))
}

/// Returns `true` if two paths are the same; the files need not exist.
fn same(one: &Path, other: &Path) -> bool {
    matches!((absolute(one), absolute(other)), (Ok(one), Ok(other)) if one == other)
}

fn refuse_existing(path: &Path) -> Result<(), Failure> {
    if path.is_dir() {
        return Err(Failure::usage(format!("{}: found a folder, expected the name of a new file in it", shown(path))));
    }
    if path.symlink_metadata().is_ok() {
        let exists = files::FileError::Exists { path: path.to_owned(), replaceable: false };
        return Err(Failure::from(exists).with_advice("keys are never replaced; choose another name"));
    }
    Ok(())
}

fn new_passphrase(options: &Options) -> Result<Option<Zeroizing<String>>, Failure> {
    if options.no_passphrase {
        return Ok(None);
    }
    let advice = |error: String| Failure::unusable(format!("{error}, or use --no-passphrase"));
    let first = passphrase("Passphrase for the new key: ").map_err(advice)?;
    if std::env::var_os(PASSPHRASE_VARIABLE).is_none() {
        let second = passphrase("Repeat the passphrase: ").map_err(advice)?;
        if first != second {
            return Err(Failure::unusable("the two passphrases differ; no key was created"));
        }
    }
    if first.is_empty() {
        return Err(Failure::unusable("the passphrase is empty; use --no-passphrase for an unencrypted key"));
    }
    Ok(Some(first))
}
