//! Verb `man`: manual pages.

use super::{Code, Failure, Format, output};
use crate::files::together::write_replaceable_together;
use crate::text::{name_of, shown};
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

/// Manual pages, as tests/generated.rs makes them: each after a comment with its name.
const PAGES: &str = include_str!("generated/man");

/// Write the manual pages, one for each command, into a folder
#[derive(Args)]
pub(super) struct Options {
    /// Folder for the pages, such as ~/.local/share/man/man1
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Replace existing pages
    #[arg(long)]
    force: bool,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let pages = PAGES.split(".\\\" ").filter_map(|page| page.split_once('\n'));
    let file = |(name, page)| (options.folder.join(format!("{name}.1")), page);
    let pages: Vec<(PathBuf, &str)> = pages.map(file).collect();
    // All or none: the page of an older version would contradict the others.
    write_replaceable_together(&pages, options.force)?;
    output::say(&format!("wrote {} pages to {}", pages.len(), shown(&options.folder)));
    if options.format != Format::Text {
        options.format.json(&json!({ "pages": pages.iter().map(|(path, _)| name_of(path)).collect::<Vec<_>>() }))?;
    }
    Ok(0)
}
