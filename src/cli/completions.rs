//! Verb `completions`: completion scripts for shells.

use super::{Code, Failure, help, output};
use clap::Args;
use clap_complete::Shell;

/// Print the completion script for a shell
#[derive(Args)]
pub(super) struct Options {
    /// Shell
    shell: Shell,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(options.shell, &mut help::command(), "dtg-passport", &mut script);
    output::own(&String::from_utf8_lossy(&script))?;
    Ok(0)
}
