//! Verb `completions`: completion scripts for shells.

use super::{Code, Failure, output};
use clap::Args;

/// Name of each shell, and its script, as tests/generated.rs makes it.
const SCRIPTS: [(&str, &str); 5] = [
    ("bash", include_str!("generated/bash")),
    ("elvish", include_str!("generated/elvish")),
    ("fish", include_str!("generated/fish")),
    ("powershell", include_str!("generated/powershell")),
    ("zsh", include_str!("generated/zsh")),
];

/// Print the completion script for a shell
#[derive(Args)]
pub(super) struct Options {
    /// Shell
    #[arg(value_parser = SCRIPTS.map(|(name, _)| name))]
    shell: String,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let script = SCRIPTS.iter().find(|(name, _)| *name == options.shell);
    output::own(script.map_or("", |(_, script)| script))?;
    Ok(0)
}
