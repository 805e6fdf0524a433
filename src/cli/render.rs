//! Verb `render`: the printed form of a verified passport.

use super::output::Format;
use super::trust_options::TrustOptions;
use super::{Code, Failure, defaults, output, register};
use crate::files;
use crate::report::page::{Language, Languages, PassportPage};
use crate::report::{style, verdict};
use crate::text::{LARGEST_DOCUMENT_BYTES, name_of, shown};
use clap::{Args, ValueEnum};
use serde::Serialize;
use std::path::PathBuf;

/// Write the printed passport: one HTML file for paper, screen and phone
#[derive(Args)]
pub(super) struct Options {
    /// Passport file; in a workspace also its identifier
    #[arg(value_name = "PASSPORT", value_parser = defaults::passport())]
    passport: PathBuf,
    /// HTML file to write
    #[arg(short, value_name = "FILE.html")]
    output: PathBuf,
    #[command(flatten)]
    trust: TrustOptions,
    /// Folder of passports: state on the page if another passport in it supersedes this one
    #[arg(long, value_name = "DIR")]
    register: Option<PathBuf>,
    /// Page languages; the first sets the number format: en, ru, or en,ru for both side by side
    #[arg(long, value_enum, value_delimiter = ',', default_value = "en", value_name = "LANGUAGE")]
    lang: Vec<Written>,
    /// Replace an existing page
    #[arg(long)]
    force: bool,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

/// The written page, and the verdict on its passport.
#[derive(Serialize)]
struct Rendered {
    page: String,
    #[serde(flatten)]
    verdict: verdict::Verdict,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Written {
    /// English
    En,
    /// Russian
    Ru,
}

impl From<Written> for Language {
    fn from(written: Written) -> Self {
        match written {
            Written::En => Self::English,
            Written::Ru => Self::Russian,
        }
    }
}

/// Returns the languages of a page: English if none is specified.
pub(super) fn languages(written: &[Written]) -> Languages {
    let mut languages = written.iter().copied().map(Language::from);
    let first = languages.next().unwrap_or(Language::English);
    Languages::new(first, languages)
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let (trust, question) = options.trust.load()?;
    let (register, trust) = register::asked(options.register.as_deref(), trust, &question)?;
    let bytes = files::read(&options.passport, LARGEST_DOCUMENT_BYTES).map_err(Failure::file)?;
    let name = name_of(&options.passport);
    let page = PassportPage::verified(&name, &bytes, &trust, &question, register.as_ref())
        .map_err(|refused| Failure::verdict("no page was written\n", &name, &refused))?;
    output::file(&options.output, &page.html(&languages(&options.lang)), options.force)?;
    output::say(&format!("wrote {}", shown(&options.output)));
    let verdict = verdict::Verdict::of(&name, page.verification());
    if options.format == Format::Json {
        output::json(&Rendered { page: name_of(&options.output), verdict })?;
    } else if !verdict.valid {
        output::say(&style::plain(&verdict::text(&[verdict])));
    }
    Ok(0)
}
