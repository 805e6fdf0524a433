//! Verb `man`: manual pages.

use super::{Code, Failure, Format, help, output};
use crate::files::together::write_replaceable_together;
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
    write_replaceable_together(&pages, options.force)?;
    output::say(&format!("wrote {} pages to {}", pages.len(), shown(&options.folder)));
    if options.format == Format::Json {
        output::json(&json!({ "pages": pages.iter().map(|(path, _)| name_of(path)).collect::<Vec<_>>() }))?;
    }
    Ok(0)
}

fn render(command: &Command, pages: &mut Vec<(String, String)>) -> Result<(), Failure> {
    let mut page = Vec::new();
    let below = command.get_after_long_help().map(ToString::to_string).unwrap_or_default();
    let man = clap_mangen::Man::new(command.clone());
    man.render(&mut page).map_err(Failure::unusable)?;
    // A word that is broken cannot be searched for.
    let page = format!(".nh\n{}", String::from_utf8_lossy(&page));
    // clap fills the text below the options, so that commands in it could not be copied.
    let mut extra = Vec::new();
    man.render_extra_section(&mut extra).map_err(Failure::unusable)?;
    let extra = String::from_utf8_lossy(&extra);
    let extra = extra.find(".SH").map_or("", |at| &extra[at..]);
    let name = command.get_display_name().unwrap_or_else(|| command.get_name());
    pages.push((name.to_owned(), page.replace(extra, &sections(&below))));
    let verbs = command.get_subcommands().filter(|verb| verb.get_name() != "help");
    verbs.into_iter().try_for_each(|verb| render(verb, pages))
}

/// Returns the sections below the options as they are written, line by line: each begins with a line that ends with a colon.
fn sections(below: &str) -> String {
    let mut page = String::new();
    for section in below.split("\n\n") {
        let (heading, lines) = section.split_once(":\n").unwrap_or(("", section));
        let heading = if heading == "Exit codes" { "\"EXIT STATUS\"" } else { &heading.to_uppercase() };
        // As they are, a backslash begins an instruction, and the others are printed as characters that no shell knows.
        const ESCAPES: [(&str, &str); 4] = [("\\", "\\e"), ("-", "\\-"), ("'", "\\(aq"), ("~", "\\(ti")];
        let lines = ESCAPES.iter().fold(lines.to_owned(), |lines, (plain, escaped)| lines.replace(plain, escaped));
        page += &format!(".SH {heading}\n.nf\n{}\n.fi\n", lines.trim_end());
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: man(7) and groff_man(7): .SH, .nf and .fi, and \- for a hyphen that can be copied.
    #[test]
    fn commands_of_a_page_are_not_filled() {
        let (mut command, mut pages) = (help::command(), Vec::new());
        command.build();
        render(&command, &mut pages).unwrap();
        assert!(pages.len() > 25, "{}", pages.len());
        for (name, page) in &pages {
            assert!(!page.contains("EXTRA"), "{name}");
            assert!(page.contains(".SH \"EXIT STATUS\"\n.nf\n  0  done"), "{page}");
        }
        let (_, verify) = pages.iter().find(|(name, _)| name == "dtg-passport-verify").unwrap();
        let due = ".SH EXAMPLES\n.nf\n  dtg\\-passport verify moscow\\-bmstu\\-1.yaml \\-\\-trust allowed_signers \
                   \\-\\-serial 0017 \\-\\-at 55.7660,37.6850\n";
        assert!(verify.contains(due), "{verify}");
        let (_, render) = pages.iter().find(|(name, _)| name == "dtg-passport-render").unwrap();
        assert!(render.contains("\\(aqpassports/SPS\\-2/*/*.yaml\\(aq"), "{render}");
    }
}
