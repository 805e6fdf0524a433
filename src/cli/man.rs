//! Verb `man`: manual pages.

use super::{Code, Failure, Format, help, output};
use crate::text::{name_of, shown};
use clap::{Args, Command};
use serde_json::json;
use std::path::PathBuf;

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
    let mut command = help::command();
    command.build();
    let mut pages = Vec::new();
    render(&command, &mut pages)?;
    let file = |(name, page): (String, String)| (options.folder.join(format!("{name}.1")), page);
    let pages: Vec<(PathBuf, String)> = pages.into_iter().map(file).collect();
    // All or none: the page of an older version would contradict the others.
    output::together(&pages, options.force)?;
    output::say(&format!("wrote {} pages into {}", pages.len(), shown(&options.folder)));
    if options.format == Format::Json {
        output::json(&json!({ "pages": pages.iter().map(|(path, _)| name_of(path)).collect::<Vec<_>>() }))?;
    }
    Ok(0)
}

/// Renders the page of a command and those of its subcommands.
fn render(command: &Command, pages: &mut Vec<(String, String)>) -> Result<(), Failure> {
    let mut page = Vec::new();
    clap_mangen::Man::new(command.clone()).render(&mut page).map_err(Failure::unusable)?;
    let name = command.get_display_name().unwrap_or_else(|| command.get_name());
    pages.push((name.to_owned(), String::from_utf8_lossy(&page).into_owned()));
    let verbs = command.get_subcommands().filter(|verb| verb.get_name() != "help");
    verbs.into_iter().try_for_each(|verb| render(verb, pages))
}
