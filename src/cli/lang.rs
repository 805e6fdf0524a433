//! Option `--lang`, which every verb has that prints a document. A workspace may state its value.

use crate::report::{Language, Languages};
use clap::{ArgMatches, Args};
use std::sync::OnceLock;

/// Language of the text of this process.
static OF_TEXT: OnceLock<Language> = OnceLock::new();

/// Takes the language from the arguments, once, before anything is written.
pub(super) fn set(matches: &ArgMatches) {
    let stated = matches.subcommand().and_then(|(_, verb)| verb.try_get_one("lang").ok().flatten());
    stated.into_iter().for_each(|language| {
        let _ = OF_TEXT.set(*language);
    });
}

/// Returns the language of the text.
pub(super) fn of_text() -> Language {
    OF_TEXT.get().copied().unwrap_or(Language::English)
}

#[derive(Args)]
pub(super) struct Lang {
    /// Language of the text and of pages: en, ru, or for a page both side by side, as in en,ru; the first is that of the text
    /// and sets the format of numbers [default: that of the workspace, or en]
    #[arg(long, value_enum, value_delimiter = ',', value_name = "LANGUAGE")]
    lang: Vec<Language>,
}

impl Lang {
    /// Returns the languages, or `None` if neither the option nor the workspace states any.
    pub(super) fn stated(&self) -> Option<Languages> {
        let (first, others) = self.lang.split_first()?;
        Some(Languages::new(*first, others.iter().copied()))
    }

    pub(super) fn languages(&self) -> Languages {
        self.stated().unwrap_or_else(|| Language::English.into())
    }
}
