//! Help: the command line as declared, with examples and exit codes for each verb, and the version.

use super::Cli;
use crate::report::columns::{self, COMMAND};
use crate::report::style;
use crate::text::kind::FORMATS;
use clap::{Command, CommandFactory};
use std::sync::LazyLock;

const EXIT_CODES: &str = "\
Exit codes:
  0  done, or the document is valid
  1  a document or a result is refused, or what should be a passport is not one
  2  wrong usage, or another file that cannot be read or is of another kind";

/// Two examples for each verb, one a line, without the name of the program.
const EXAMPLES: &str = include_str!("examples.txt");

/// How to install completions, where shells look for them.
const COMPLETIONS: &str = "\
Install:
  dtg-passport completions bash > ~/.local/share/bash-completion/completions/dtg-passport
  dtg-passport completions zsh > \"${fpath[1]}/_dtg-passport\"
  dtg-passport completions fish > ~/.config/fish/completions/dtg-passport.fish

";

/// Returns the command line with the examples of its verbs.
pub(super) fn command() -> Command {
    let command = Cli::command().version(env!("CARGO_PKG_VERSION")).long_version(long_version());
    let verbs: Vec<String> = command.get_subcommands().map(|verb| verb.get_name().to_owned()).collect();
    verbs.iter().fold(command.after_long_help(EXIT_CODES), |command, name| {
        command.mut_subcommand(name, |verb| {
            let parts: Vec<String> = verb.get_subcommands().map(|part| part.get_name().to_owned()).collect();
            let verb = parts.iter().fold(verb, |verb, part| {
                verb.mut_subcommand(part, |command| command.after_long_help(after_help(&format!("{name} {part}"))))
            });
            verb.after_long_help(after_help(name))
        })
    })
}

/// Returns what the help of a verb, or of a part of it, has below the options.
fn after_help(verb: &str) -> String {
    let lines: String = examples(verb).map(|example| format!("  dtg-passport {example}\n")).collect();
    let more = if verb == "completions" { COMPLETIONS } else { "" };
    format!("Examples:\n{lines}\n{more}{EXIT_CODES}")
}

fn examples(verb: &str) -> impl Iterator<Item = &'static str> {
    EXAMPLES
        .lines()
        .filter(move |example| example.strip_prefix(verb).is_some_and(|rest| rest.is_empty() || rest.starts_with(' ')))
}

/// Width of a terminal in which every line of the help fits.
const COLUMNS: usize = 80;

/// Returns clap's words with their usage broken between the arguments, so that it fits: clap itself never breaks it.
/// Examples, which clap does break, are one line each, so that they can be copied.
pub(super) fn fitted(words: &str) -> String {
    let line = |line: &str| {
        let plain = style::plain(line);
        let is_wide = plain.starts_with("Usage: ") && plain.trim_end().chars().count() > COLUMNS;
        if is_wide { columns::fitted(&unbroken(line), COLUMNS) } else { line.to_owned() }
    };
    let whole = whole_commands(&whole_commands(words, "Examples:\n"), "Install:\n");
    whole.split_inclusive('\n').map(line).collect()
}

/// Joins the lines of each command again, which clap breaks.
fn whole_commands(words: &str, heading: &str) -> String {
    let Some(start) = words.find(heading) else { return words.to_owned() };
    let (before, rest) = words.split_at(start);
    let (commands, after) = rest.split_at(rest.find("\n\n").unwrap_or(rest.len()));
    let commands = commands.replace("\n  ", " ").replace(&format!(" {COMMAND}"), &format!("\n  {COMMAND}"));
    format!("{before}{commands}{after}")
}

/// Returns a usage with non-breaking spaces between each option and its value.
fn unbroken(usage: &str) -> String {
    let is_option = |word: &str| style::plain(word).trim_start_matches('<').starts_with("--");
    let word = |word: &str| match word.strip_suffix(' ') {
        Some(option) if is_option(option) => format!("{option}\u{A0}"),
        _ => word.to_owned(),
    };
    usage.split_inclusive(' ').map(word).collect()
}

/// Returns the version, the commit if the build was told it, and the formats.
///
/// The commit comes from variables at build time, so that equal sources and variables give equal bytes.
fn long_version() -> &'static str {
    static VERSION: LazyLock<String> = LazyLock::new(|| {
        let commit = match (option_env!("DTG_PASSPORT_COMMIT"), option_env!("DTG_PASSPORT_COMMIT_DATE")) {
            // What is generated must be the same for every commit.
            _ if cfg!(feature = "generate") => String::new(),
            (Some(commit), Some(date)) => format!("\ncommit {commit}, {date}"),
            (Some(commit), None) => format!("\ncommit {commit}"),
            _ => String::new(),
        };
        let formats = FORMATS.map(|(format, _)| format).join(", ");
        format!("{}{commit}\nformats {formats}", env!("CARGO_PKG_VERSION"))
    });
    &VERSION
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Splits an example as a shell does, for the quotes that examples have.
    fn words(example: &str) -> Vec<String> {
        let parts = example.split('"').enumerate();
        let words = parts.flat_map(|(index, part)| match index % 2 {
            0 => part.split_whitespace().map(str::to_owned).collect::<Vec<_>>(),
            _ => vec![part.to_owned()],
        });
        std::iter::once("dtg-passport".to_owned()).chain(words).collect()
    }

    #[test]
    fn every_verb_has_two_examples_that_parse() {
        let command = command();
        for verb in command.get_subcommands() {
            let name = verb.get_name();
            let examples: Vec<&str> = examples(name).collect();
            assert!(examples.len() == 2 && examples[0] != examples[1], "{name}");
            for example in &examples {
                let parsed = command.clone().try_get_matches_from(words(example));
                assert!(parsed.is_ok(), "{example}\n{}", parsed.unwrap_err());
            }
            let help = fitted(&verb.clone().term_width(COLUMNS).render_long_help().to_string());
            assert!(help.contains("Examples:\n") && help.contains(EXIT_CODES), "{help}");
            let whole = |example: &&str| help.contains(&format!("\n  dtg-passport {example}\n"));
            assert!(examples.iter().all(whole), "{help}");
            for part in verb.get_subcommands() {
                let help = fitted(&part.clone().term_width(COLUMNS).render_long_help().to_string());
                let own = format!("Examples:\n  dtg-passport {name} {} ", part.get_name());
                assert!(help.contains(&own) && help.contains(EXIT_CODES), "{help}");
            }
        }
        let completions = command.find_subcommand("completions").unwrap().clone().term_width(COLUMNS);
        let help = fitted(&completions.clone().render_long_help().to_string());
        let commands = COMPLETIONS.lines().filter(|line| line.contains(COMMAND));
        assert!(commands.clone().count() == 3, "{COMPLETIONS}");
        assert!(commands.into_iter().all(|line| help.contains(&format!("\n{line}\n"))), "{help}");
    }

    /// Adds what is printed for `--help` and `-h` of a command and of those below it.
    fn printed(whole: &Command, names: &[String], verb: &Command, all: &mut Vec<(String, String)>) {
        for flag in ["-h", "--help"] {
            let arguments = names.iter().cloned().chain([flag.to_owned()]);
            let help = whole.clone().try_get_matches_from(arguments).unwrap_err();
            all.push((format!("{} {flag}", names.join(" ")), fitted(&help.render().to_string())));
        }
        for below in verb.get_subcommands().filter(|below| below.get_name() != "help") {
            let names: Vec<String> = names.iter().cloned().chain([below.get_name().to_owned()]).collect();
            printed(whole, &names, below, all);
        }
    }

    #[test]
    fn help_fits_a_terminal_of_80_columns() {
        let (whole, mut all) = (command().term_width(COLUMNS), Vec::new());
        printed(&whole, &["dtg-passport".to_owned()], &whole, &mut all);
        assert!(all.len() > 50, "{}", all.len());
        for (name, help) in &all {
            // A command is one line, which can be copied.
            for line in help.lines().filter(|line| !line.trim_start().starts_with(COMMAND)) {
                assert!(line.chars().count() <= COLUMNS, "{name}: {line}");
            }
        }
        // An option and its value stay together, and every word is there.
        let (_, revoke) = all.iter().find(|(name, _)| name == "dtg-passport revoke -h").unwrap();
        let usage = "Usage: dtg-passport revoke [OPTIONS] --reason <TEXT> --identity <WHO>\n  \
                     --trust <SIGNERS> <PASSPORT-ID>...\n";
        assert!(revoke.contains(usage), "{revoke}");
    }

    /// Returns the words of a verb's help, and of the verbs below it, each with its name.
    fn all_help(verb: &Command, all: &mut Vec<(String, String)>) {
        all.push((format!("help::{}", verb.get_name()), verb.clone().render_long_help().to_string()));
        verb.get_subcommands().for_each(|verb| all_help(verb, all));
    }

    #[test]
    fn help_has_the_terms_of_the_glossary() {
        let mut all = Vec::new();
        command().get_subcommands().for_each(|verb| all_help(verb, &mut all));
        assert!(all.len() > 20, "{}", all.len());
        let wrong = |(name, help): &(String, String)| {
            help.lines().flat_map(|line| crate::inside::texts::wrong("en", name, line)).collect::<Vec<_>>()
        };
        assert_eq!(all.iter().flat_map(wrong).collect::<Vec<_>>(), Vec::<String>::new());
    }
}
