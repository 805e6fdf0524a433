//! Verb `demo`: the whole work of factory and laboratory on a built-in example.

use super::{Code, Failure, Format, REFUSED, output, trust_options};
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
    #[arg(short, long, visible_alias = "output", value_name = "DIR", value_parser = output::folder(""))]
    out: Option<PathBuf>,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let folder = options.out.clone().unwrap_or_else(demonstration::free_folder);
    let mut steps = Vec::new();
    let passed = demonstration::run(&folder, trust_options::now(), &mut |line| match options.format {
        Format::Text => output::text(&format!("{line}\n")).is_ok(),
        _ => {
            steps.push(style::plain(line));
            true
        }
    });
    let passed = passed.map_err(Failure::unusable)?;
    if options.format != Format::Text {
        options.format.json(&json!({ "folder": name_of(&folder), "passed": passed, "steps": steps }))?;
    }
    Ok(if passed { 0 } else { REFUSED })
}
