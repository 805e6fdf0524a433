//! Verb `revoke`: withdrawal of passports.

use super::key_options::{self, signer_of};
use super::trust_options::{TrustOptions, now};
use super::{Code, Failure, Format, inputs};
use crate::files::{self, Access};
use crate::folder::Folder;
use crate::folder::search::{self, NoNewestList};
use crate::passport::checks::for_the_issuer;
use crate::passport::verify;
use crate::report::style;
use crate::text::scalar::latin;
use crate::text::{Kind, Printable, name_of, shown};
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Withdraw passports: add them to the signed list in a folder
#[derive(Args)]
pub(super) struct Options {
    /// Identifiers (model/serial/site/revision, looked up in --passports) or files
    #[arg(required = true, value_name = "PASSPORT-ID")]
    ids: Vec<String>,
    /// Reason, recorded in the list
    #[arg(long, value_name = "TEXT")]
    reason: String,
    /// Folder of lists of withdrawn passports, `revocations` in a workspace; a new list is written, which continues the
    /// newest one
    #[arg(long, value_name = "FOLDER")]
    list: PathBuf,
    /// Folder of passports
    #[arg(long, value_name = "DIR", default_value = "passports")]
    passports: PathBuf,
    /// Private key file, or a .pub file whose private half is in ssh-agent or a FIDO token
    #[arg(long, value_name = "KEY")]
    key: PathBuf,
    /// Issuer: the principal of the key in allowed_signers
    #[arg(long, value_name = "WHO", value_parser = key_options::identity)]
    identity: String,
    #[command(flatten)]
    trust: TrustOptions,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let (trust, question) = options.trust.load()?;
    let lists =
        search::lists(&options.list, &options.passports, &trust, question.time).map_err(|error| match error {
            NoNewestList::File(error) => Failure::from(error),
            refused => Failure::refused(refused),
        })?;
    let mut entries = Vec::new();
    for id in &options.ids {
        let path = file_of(id, &options.passports)?;
        let bytes = inputs::bytes(&path, Kind::Passport.words())?;
        let verification = verify(&name_of(&path), &bytes, &trust, &question);
        entries.push(verification.withdrawal(&bytes, now(), &options.reason).map_err(|failed| {
            let words = failed.map_or("", |check| for_the_issuer(&check.detail));
            Failure::refused(format!("{}: cannot be withdrawn: {words}", shown(&path)))
        })?);
    }
    let count = lists.count() + entries.len();
    let ids: Vec<String> = entries.iter().map(|entry| entry.id.clone()).collect();
    let list = lists.following(&options.identity, now(), entries).map_err(Failure::refused)?;
    let signer = signer_of(&options.key)?;
    let path = options.list.join(list.file_name());
    let text = list.sign_for(&name_of(&path), signer.as_ref(), &trust.signers, &trust.revoked);
    let text = text.map_err(Failure::refused)?;
    files::write_new(&path, text.as_bytes(), Access::Shared)?;
    options.format.write(
        || json!({ "file": name_of(&path), "sequence": list.sequence, "revoked": ids, "passports": count }),
        || {
            let withdrawn = style::marked(Some(true), "withdrawn");
            format!("{withdrawn}  {}  {} (passports in the list: {count})\n", ids.join(", "), shown(&path))
        },
    )?;
    Ok(0)
}

/// Returns the file of an id in `passports`, or `id` itself as a path if only that file exists.
fn file_of(id: &str, passports: &Path) -> Result<PathBuf, Failure> {
    let folder = Folder::new(passports);
    let path = folder.path_of_id(id);
    match &path {
        Some(path) if path.exists() => return Ok(path.clone()),
        _ if Path::new(id).exists() => return Ok(PathBuf::from(id)),
        _ => {}
    }
    let alike = |(_, odd)| format!("; the {odd} only looks like a Latin letter");
    let nearest = folder.nearest_id(id).map_or_else(String::new, |nearest| format!("; did you mean {nearest}?"));
    let nearest = latin(id).map_or_else(String::new, alike) + &nearest;
    let (id, passports) = (Printable(id), shown(passports));
    Err(Failure::unusable(match path {
        Some(_) => {
            let advice =
                if nearest.is_empty() { "; give the folder of the passport with --passports" } else { &nearest };
            format!("{id}: found no such passport in the folder {passports}{advice}")
        }
        None => format!(
            "{id}: found neither a file nor an identifier, expected MODEL/SERIAL/SITE/REVISION, such as \
             SPS-2/0017/moscow-bmstu/1{nearest}"
        ),
    }))
}
