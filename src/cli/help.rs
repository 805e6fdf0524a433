//! Help: the command line as declared, with examples and exit codes for each verb, and the version.

use super::Cli;
use crate::text::kind::FORMATS;
use clap::{Command, CommandFactory};
use std::sync::LazyLock;

const EXIT_CODES: &str = "\
Exit codes:
  0  done, or the document is valid
  1  a document or a result is refused, or what should be a passport is not one
  2  wrong usage, or another file that cannot be read or is of another kind";

/// Two examples for each verb, one a line, without the name of the program. A backslash continues a printed line on the next.
const EXAMPLES: &str = include_str!("examples.txt");

/// How to install completions, where shells look for them.
const COMPLETIONS: &str = "\
Install:
  dtg-passport completions bash \\
    > ~/.local/share/bash-completion/completions/dtg-passport
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
    let printed = |example: &str| format!("  dtg-passport {}\n", example.replace(" \\ ", " \\\n    "));
    let lines: String = examples(verb).map(printed).collect();
    let more = if verb == "completions" { COMPLETIONS } else { "" };
    format!("Examples:\n{lines}\n{more}{EXIT_CODES}")
}

fn examples(verb: &str) -> impl Iterator<Item = &'static str> {
    EXAMPLES
        .lines()
        .filter(move |example| example.strip_prefix(verb).is_some_and(|rest| rest.is_empty() || rest.starts_with(' ')))
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

    /// Splits an example as a shell does, for the quotes and backslashes that examples have.
    fn words(example: &str) -> Vec<String> {
        let example = example.replace(" \\ ", " ");
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
            let parts = verb.get_subcommands().map(|part| (format!("{name} {}", part.get_name()), part));
            for (name, verb) in parts.chain([(name.to_owned(), verb)]) {
                let after = after_help(&name);
                // clap breaks a line that is wider than the terminal, and a broken one could not be copied.
                let help = verb.clone().term_width(80).render_long_help().to_string();
                assert!(after.starts_with("Examples:\n  dtg-passport ") && help.contains(&after), "{help}");
            }
        }
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
