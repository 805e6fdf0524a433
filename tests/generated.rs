//! JSON Schemas, completions and manual pages: what the program contains is what the sources give.
//!
//! `tests/features` runs this. `UPDATE_GENERATED=1 cargo test --locked --features generate --test generated` writes the
//! files again.

use clap::{Command, ValueEnum};
use clap_complete::Shell;
use std::fs;
use std::path::Path;

/// Expected: the text of each file in the repository, byte for byte.
#[test]
fn what_the_program_contains_is_what_the_sources_give() {
    let (mut command, schemas) = dtg_passport::cli::declared();
    let schemas = serde_json::to_string_pretty(&schemas).unwrap() + "\n";
    let mut files = vec![("src/schema/schemas.json".to_owned(), schemas)];
    for shell in Shell::value_variants() {
        let mut script = Vec::new();
        clap_complete::generate(*shell, &mut command.clone(), "dtg-passport", &mut script);
        files.push((format!("src/cli/generated/{shell}"), String::from_utf8(script).unwrap()));
    }
    command.build();
    let mut pages = String::new();
    render(&command, &mut pages).unwrap();
    files.push(("src/cli/generated/man".to_owned(), pages));
    for (name, text) in files {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(&name);
        if std::env::var_os("UPDATE_GENERATED").is_some() {
            fs::write(&path, &text).unwrap();
        }
        let is_current = fs::read_to_string(&path).is_ok_and(|committed| committed == text);
        assert!(is_current, "{name}: write it again, as tests/generated.rs says, and read the difference");
    }
}

/// Adds the page of a command and those of the commands below it.
fn render(command: &Command, pages: &mut String) -> std::io::Result<()> {
    let mut page = Vec::new();
    let below = command.get_after_long_help().map(ToString::to_string).unwrap_or_default();
    let man = clap_mangen::Man::new(command.clone());
    man.render(&mut page)?;
    // A word that is broken cannot be searched for.
    let page = format!(".nh\n{}", String::from_utf8_lossy(&page));
    // clap fills the text below the options, so that commands in it could not be copied.
    let mut extra = Vec::new();
    man.render_extra_section(&mut extra)?;
    let extra = String::from_utf8_lossy(&extra);
    let extra = extra.find(".SH").map_or("", |at| &extra[at..]);
    let name = command.get_display_name().unwrap_or_else(|| command.get_name());
    *pages += &format!(".\\\" {name}\n{}", page.replace(extra, &sections(&below)));
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
