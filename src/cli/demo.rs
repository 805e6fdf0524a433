//! Verb `demo`: the whole work of factory and laboratory on a built-in example.

use super::{Code, Failure, REFUSED, output, trust_options};
use crate::demonstration;
use clap::Args;
use std::path::PathBuf;

/// Demonstrate the work of factory and laboratory with a built-in example, and keep its files
#[derive(Args)]
pub(super) struct Options {
    /// Folder for the files, empty or not existing [default: dtg-passport-demo, numbered if it exists]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let folder = options.out.clone().unwrap_or_else(demonstration::free_folder);
    match demonstration::run(&folder, trust_options::now(), &mut |line| output::result(&format!("{line}\n")).is_ok()) {
        Ok(true) => Ok(0),
        Ok(false) => Ok(REFUSED),
        Err(error) => Err(Failure::unusable(error)),
    }
}
