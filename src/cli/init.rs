//! Verb `init`: a new workspace.

use super::{Code, Failure, key_options, output};
use crate::text::shown;
use crate::workspace::{NotMade, make};
use clap::Args;
use std::path::PathBuf;

/// Make a workspace: folders, dtg-passport.toml, .gitignore and a README
#[derive(Args)]
pub(super) struct Options {
    /// Folder of the workspace
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Issuer to state in dtg-passport.toml
    #[arg(long, value_name = "WHO", value_parser = key_options::identity)]
    identity: Option<String>,
    /// Replace existing files of a workspace
    #[arg(long)]
    force: bool,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let made = make(&options.folder, options.identity.as_deref(), options.force).map_err(|error| match error {
        NotMade::File(error) => Failure::file(error),
        error => Failure::usage(error),
    })?;
    let lines: String = made.iter().map(|path| format!("{}\n", shown(path))).collect();
    output::text(&lines)?;
    let (key, signers) = (options.folder.join("factory.key"), options.folder.join("allowed_signers"));
    let identity = options.identity.as_deref().unwrap_or("WHO");
    output::say(&format!(
        "next: dtg-passport keygen {} --identity {identity} --allowed-signers {}\n\
         then: dtg-passport status --workspace {}",
        shown(&key),
        shown(&signers),
        shown(&options.folder)
    ));
    Ok(0)
}
