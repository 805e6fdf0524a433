//! Verb `demo`: the whole work of factory and laboratory on a built-in example.

use super::options::{Formatted, folder};
use super::{Code, Failure, REFUSED, output, trust_options};
use crate::demonstration;
use crate::report::style;
use crate::text::name_of;
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

/// Demonstrate the work of factory and laboratory with a built-in example, and keep its files
#[derive(Args)]
pub(super) struct Options {
    /// Folder for the files, empty or not existing [default: dtg-passport-demo, numbered if it exists]
    #[arg(short, long, visible_alias = "output", value_name = "DIR", value_parser = folder(""))]
    out: Option<PathBuf>,
    #[command(flatten)]
    _format: Formatted,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let folder = options.out.clone().unwrap_or_else(demonstration::free_folder);
    let mut steps = Vec::new();
    let passed = demonstration::run(&folder, trust_options::now(), &mut |line| {
        steps.push(style::plain(line));
        output::is_json() || output::text(&format!("{line}\n")).is_ok()
    });
    let passed = passed.map_err(Failure::unusable)?;
    if output::is_json() {
        output::value(&json!({ "folder": name_of(&folder), "passed": passed, "steps": steps }))?;
    }
    Ok(if passed { 0 } else { REFUSED })
}
