//! Verb `init`: a new workspace.

use super::options::{Force, Formatted};
use super::{Code, Failure, key_options, output};
use crate::text::{name_of, shown};
use crate::workspace::{Kind, NotMade, make};
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Make a workspace: folders, dtg-passport.toml, .gitignore and a README
#[derive(Args)]
pub(super) struct Options {
    /// Folder of the workspace
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Issuer to state in dtg-passport.toml
    #[arg(long, value_name = "WHO", value_parser = key_options::identity)]
    identity: Option<String>,
    /// Make the workspace of a laboratory, which receives passports and calibrates gyros
    #[arg(long, conflicts_with = "identity")]
    laboratory: bool,
    #[command(flatten)]
    force: Force,
    #[command(flatten)]
    _format: Formatted,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let kind = match options.laboratory {
        true => Kind::Laboratory(&[]),
        false => Kind::Factory(options.identity.as_deref()),
    };
    let made = make(&options.folder, &kind, options.force.replace).map_err(|error| match error {
        NotMade::File(error) => Failure::from(error),
        error => Failure::usage(error),
    })?;
    let names = || made.iter().map(|path| name_of(path)).collect::<Vec<_>>();
    output::write(
        || json!({ "workspace": name_of(&options.folder), "made": names() }),
        || made.iter().map(|path| format!("{}\n", shown(path))).collect(),
    )?;
    if options.laboratory {
        let folder = quoted(&options.folder);
        output::say(&format!("next, receive what the factory sent:\ndtg-passport receive FILE.zip {folder}"));
        return Ok(0);
    }
    let identity = if options.identity.is_some() { "" } else { " --identity WHO" };
    let folder = quoted(&options.folder);
    output::say(&format!(
        "next, create the signing key, and look at the workspace:\n\
         dtg-passport keygen{identity} --workspace {folder}\n\
         dtg-passport status --workspace {folder}"
    ));
    Ok(0)
}

/// Returns a path as every shell takes it for one argument.
fn quoted(path: &Path) -> String {
    let text = shown(path).to_string();
    if text.contains(char::is_whitespace) { format!("\"{text}\"") } else { text }
}
