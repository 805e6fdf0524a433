//! Options that several verbs have: each is declared here once. `output` keeps language and format.

use super::output::Format;
use super::{Failure, inputs, output};
use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::report::Language;
use crate::stand::Excluded;
use crate::text::{Printable, rule, shown};
use clap::builder::{PathBufValueParser, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};

/// Option `--format` of a verb that prints a result; a verb that prints a table adds csv to it.
#[derive(Args)]
pub(super) struct Formatted {
    /// Output format
    #[arg(id = "format", long = "format", value_name = "FORMAT", value_parser = without_csv(), default_value = "text")]
    _format: Format,
}

fn without_csv() -> impl TypedValueParser<Value = Format> {
    let others = Format::value_variants().iter().filter(|format| **format != Format::Csv);
    PossibleValuesParser::new(others.filter_map(Format::to_possible_value))
        .map(|name| Format::from_str(&name, false).unwrap_or(Format::Text))
}

/// Option `--lang` of a verb that prints a document or a refusal.
#[derive(Args)]
pub(super) struct Lang {
    /// Language of the text and of pages: en, ru, or for a page both side by side, as in en,ru; the first is that of the text
    /// and sets the format of numbers [default: that of the workspace, or en]
    #[arg(id = "lang", long = "lang", value_enum, value_delimiter = ',', value_name = "LANGUAGE")]
    _lang: Vec<Language>,
}

/// Options of a verb that prints a document and its JSON.
#[derive(Args)]
pub(super) struct Printed {
    #[command(flatten)]
    _lang: Lang,
    #[command(flatten)]
    _format: Formatted,
}

/// Options of a verb that prints a table.
#[derive(Args)]
#[command(mut_arg("format", |format| format.value_parser(clap::value_parser!(Format))))]
pub(super) struct Tabular {
    #[command(flatten)]
    _printed: Printed,
}

#[derive(Args)]
pub(super) struct Threads {
    /// Number of threads [default: one for each processor]
    #[arg(short = 'j', long = "threads", value_name = "T", value_parser = inputs::whole::<u16>(1..=1024))]
    number: Option<u16>,
}

impl Threads {
    /// Returns the number of threads, or else `usual`.
    pub(super) fn or(&self, usual: usize) -> usize {
        self.number.map_or(usual, usize::from)
    }
}

/// Gyro type and laboratory of a verb that computes with them.
#[derive(Args)]
pub(super) struct Instruments {
    /// Gyro type (dtg-gyro/1) [default: the paper's GVK-6]
    #[arg(long, value_name = "FILE")]
    pub gyro: Option<PathBuf>,
    /// Laboratory (dtg-laboratory/1) [default: the paper's meter, 0.015 %]
    #[arg(long, value_name = "FILE")]
    pub laboratory: Option<PathBuf>,
}

impl Instruments {
    /// Returns for gyro type and laboratory whether the usual one is assumed.
    pub(super) fn assumed(&self) -> [bool; 2] {
        [self.gyro.is_none(), self.laboratory.is_none()]
    }

    pub(super) fn gyro(&self) -> Result<Option<GyroType>, Failure> {
        inputs::gyro(self.gyro.as_deref())
    }

    pub(super) fn gyro_or_usual(&self) -> Result<GyroType, Failure> {
        Ok(self.gyro()?.unwrap_or_else(GyroType::gvk_6))
    }

    pub(super) fn laboratory(&self) -> Result<Laboratory, Failure> {
        inputs::laboratory(self.laboratory.as_deref())
    }
}

#[derive(Args)]
pub(super) struct Force {
    /// Replace existing files
    #[arg(long = "force")]
    pub replace: bool,
}

/// Readings and runs that a certification leaves out, with their reasons.
#[derive(Args)]
pub(super) struct ExclusionOptions {
    /// Exclude a reading, given as i,j,run, or a whole run (repeatable); requires --why
    #[arg(long, value_name = "I,J,RUN|RUN", value_parser = exclusion, requires = "why")]
    exclude: Vec<Excluded>,
    /// Reason for the exclusion, recorded in the certificate; one for each --exclude, or one for all
    #[arg(long, value_name = "TEXT", requires = "exclude")]
    why: Vec<String>,
}

/// Parses an exclusion: a reading `i,j,run`, or a run. Its reason is given separately.
fn exclusion(text: &str) -> Result<Excluded, String> {
    let numbers = text.split(',').map(|number| number.trim().parse::<u32>().ok().filter(|number| *number > 0));
    let numbers = numbers.collect::<Option<Vec<_>>>().unwrap_or_default();
    match numbers[..] {
        [run] => Ok(Excluded { i: None, j: None, run, why: String::new() }),
        [i, j, run] => Ok(Excluded { i: Some(i), j: Some(j), run, why: String::new() }),
        _ => Err("expected i,j,run for a reading, such as 2,3,4, or the number of a run, such as 4".to_owned()),
    }
}

impl ExclusionOptions {
    pub(super) fn is_any(&self) -> bool {
        !self.exclude.is_empty()
    }

    pub(super) fn excluded(&self) -> Result<Vec<Excluded>, Failure> {
        let reasons = reasons(self.exclude.len(), &self.why)?;
        let each = self.exclude.iter().zip(reasons).map(|(excluded, why)| Excluded { why, ..excluded.clone() });
        Ok(each.collect())
    }
}

/// Returns the reason of each `--exclude`, from one `--why` for each, or one for all.
pub(super) fn reasons(excluded: usize, why: &[String]) -> Result<Vec<String>, Failure> {
    if why.len() > 1 && why.len() != excluded {
        let found = why.len();
        return Err(Failure::unusable(format!(
            "found {found} --why for {excluded} --exclude; give one for each, or one for all"
        )));
    }
    if let Some(bad) = why.iter().find(|why| why.is_empty() || !why.chars().all(rule::allowed_in_string)) {
        let words = "the reason is empty or contains a character that is not allowed in signed files; state in plain words \
                     why the reading is left out";
        return Err(Failure::unusable(format!("--why {:?}: {words}", Printable(bad).to_string())));
    }
    Ok(why.iter().chain(why.last().into_iter().cycle()).take(excluded).cloned().collect())
}

/// Printable record that a verb writes beside its result.
#[derive(Args)]
pub(super) struct Report {
    /// Write a printable record of the result, with fields for signatures; FILE.pdf is printed by an installed Chromium,
    /// Chrome or Edge
    #[arg(id = "report", long = "report", help_heading = "Report and certificate", value_name = "FILE.html", value_parser = file(PAGE))]
    pub path: Option<PathBuf>,
}

/// Picture that a verb writes beside its result.
#[derive(Args)]
pub(super) struct Picture {
    /// Write a picture to this file
    #[arg(short, long, visible_alias = "output", value_name = "FILE.svg", value_parser = file(PICTURE))]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    force: Force,
}

impl Picture {
    /// Draws and writes the picture, if one is wanted.
    pub(super) fn save(&self, draw: impl FnOnce() -> Result<String, Failure>) -> Result<(), Failure> {
        let Some(path) = &self.out else { return Ok(()) };
        output::saved_too(path, draw()?, self.force.replace)
    }
}

/// Suffixes of the pages, pictures, stand files and archives that verbs write.
pub(super) const PAGE: &[&str] = &["html", "pdf"];
pub(super) const PICTURE: &[&str] = &["svg"];
pub(super) const STAND: &[&str] = &["yaml", "yml"];
pub(super) const ARCHIVE: &[&str] = &["zip"];

/// Suffixes of documents, also of those that this program does not write: no folder is made with such a name.
const DOCUMENTS: [&str; 16] = [
    "csv", "doc", "docx", "eps", "gif", "html", "jpeg", "jpg", "json", "pdf", "png", "svg", "xml", "yaml", "yml", "zip",
];

/// Place to write to: one file, or a folder in which the program names the files.
#[derive(Debug, Clone)]
pub(super) enum Out {
    File(PathBuf),
    Folder(PathBuf),
}

impl Out {
    /// Reads the name of a file if its suffix is that of a document, otherwise that of a folder.
    fn of(path: PathBuf) -> Self {
        if has_suffix(&path, &DOCUMENTS) && !is_folder(&path) { Self::File(path) } else { Self::Folder(path) }
    }

    /// Returns the path of a file, or `None` for a folder.
    pub(super) fn file(&self) -> Option<&PathBuf> {
        match self {
            Self::File(path) => Some(path),
            Self::Folder(_) => None,
        }
    }
}

fn has_suffix(path: &Path, suffixes: &[&str]) -> bool {
    path.extension().is_some_and(|found| suffixes.iter().any(|suffix| found.eq_ignore_ascii_case(suffix)))
}

fn is_folder(path: &Path) -> bool {
    path.is_dir() || path.as_os_str().to_string_lossy().ends_with(std::path::is_separator)
}

/// Returns the refusal of the name of a document of another format, which a viewer would not open.
fn other_format(path: &Path, suffixes: &[&str], or: &str) -> String {
    format!(
        "expected a name ending in .{}, such as {}{or}",
        suffixes.join(" or ."),
        shown(&path.with_extension(suffixes[0]))
    )
}

/// Parser of `-o, --out` of a verb that writes files with these suffixes, or many of them into a folder.
pub(super) fn file_or_folder(suffixes: &'static [&'static str]) -> impl TypedValueParser<Value = Out> {
    PathBufValueParser::new().try_map(move |path| match Out::of(path) {
        Out::File(path) if !has_suffix(&path, suffixes) => Err(other_format(&path, suffixes, ", or that of a folder")),
        out => Ok(out),
    })
}

/// Parser of the path of one file to write.
pub(super) fn file(suffixes: &'static [&'static str]) -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(move |path| match Out::of(path) {
        Out::File(path) if !has_suffix(&path, suffixes) => Err(other_format(&path, suffixes, "")),
        Out::Folder(path) if is_folder(&path) => Err(format!(
            "found a folder, expected the file to write, such as {}",
            shown(&path.join("NAME").with_extension(suffixes[0]))
        )),
        Out::File(path) | Out::Folder(path) => Ok(path),
    })
}

/// Parser of the path of a folder to write to; the name of a file is refused, with `advice` on how to write one file.
pub(super) fn folder(advice: &'static str) -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(move |path| match Out::of(path) {
        Out::File(_) => Err(format!("expected the name of a folder, not of a file{advice}")),
        Out::Folder(path) => Ok(path),
    })
}

/// Parser of the path of a folder of passports.
pub(super) fn folder_of_passports() -> impl TypedValueParser<Value = PathBuf> {
    folder("; the passports in it are <model>/<serial>/<site>-<revision>.yaml")
}
