//! Input files of the verbs: documents read, and several inputs of which one that fails does not stop the others.

use super::{Code, Failure, Format, lang, output};
use crate::batch::catalogue::Listed as _;
use crate::batch::deliveries::Deliveries;
use crate::batch::{Purpose, paths};
use crate::dcc::Administrative;
use crate::files::{self, FileError};
use crate::gyro::GyroType;
use crate::interface::{Failed, MISSING_DATA, REFUSED};
use crate::laboratory::Laboratory;
use crate::report::doc::said;
use crate::report::issued;
use crate::site::Site;
use crate::stand::Stand;
use crate::text::problem::MISSING;
use crate::text::{Kind, LARGEST_DOCUMENT_BYTES, Printable, Problems, Unreadable, name_of, shown};
use serde::{Serialize, Serializer};
use std::ops::RangeBounds;
use std::path::{Path, PathBuf};

pub(super) const HEADER: &str = "a header (dtg-stand/1)";

/// Reads the bytes of a document; `expected` says what it should be, for the message about a folder or a file that does not
/// exist.
pub(super) fn bytes(path: &Path, expected: &str) -> Result<Vec<u8>, Failure> {
    files::read(path, LARGEST_DOCUMENT_BYTES).map_err(|error| match error {
        FileError::Folder(path) => Failure::folder(&path, expected),
        error => Failure::of_file(error, Some(expected)),
    })
}

/// Reads a document with its own reader, such as `Stand::from_yaml`.
pub(super) fn document<T>(
    path: &Path,
    expected: &str,
    reader: impl FnOnce(&str, &[u8]) -> Result<T, Unreadable>,
) -> Result<T, Failure> {
    Ok(reader(&name_of(path), &bytes(path, expected)?)?)
}

pub(super) fn stand(path: &Path) -> Result<Stand, Failure> {
    document(path, Kind::Stand.words(), Stand::from_yaml)
}

/// Reads a table of deliveries.
pub(super) fn deliveries(path: &Path) -> Result<Deliveries, Failure> {
    document(path, "a table of deliveries (CSV)", Deliveries::read)
}

/// Reads a site file, and remarks on a file that has not the name of its site.
pub(super) fn site(path: &Path) -> Result<Site, Failure> {
    let site = document(path, Kind::Site.words(), Site::from_yaml)?;
    if let Some(words) = site.remark(path) {
        output::say(&format!("{}: {words}", shown(path)));
    }
    Ok(site)
}

pub(super) fn gyro(path: Option<&Path>) -> Result<Option<GyroType>, Failure> {
    let gyro_type = path.map(|path| document(path, Kind::Gyro.words(), GyroType::from_yaml)).transpose()?;
    gyro_type.iter().flat_map(GyroType::remarks).for_each(|words| output::warn(&said(&words, lang::of_text())));
    Ok(gyro_type)
}

/// Reads a laboratory file, or returns the paper's meter without a path.
pub(super) fn laboratory(path: Option<&Path>) -> Result<Laboratory, Failure> {
    let Some(path) = path else { return Ok(Laboratory::paper()) };
    let laboratory = document(path, Kind::Laboratory.words(), Laboratory::from_yaml)?;
    laboratory.remarks().iter().for_each(|words| output::warn(&said(words, lang::of_text())));
    Ok(laboratory)
}

/// Parses a number within limits; `expected` describes it.
pub(super) fn number(text: &str, limits: impl RangeBounds<f64>, expected: String) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|value| limits.contains(value))
        .ok_or_else(|| format!("expected {expected}, with a decimal point"))
}

/// Administrative file that was read, or none.
pub(super) struct AdministrativeFile {
    name: String,
    text: String,
    pub content: Option<Administrative>,
}

impl AdministrativeFile {
    /// Reads the file. Without one, everything that it would state is missing.
    pub(super) fn read(path: Option<&Path>) -> Result<Self, Failure> {
        let Some(path) = path else {
            return Ok(Self { name: "--administrative".to_owned(), text: String::new(), content: None });
        };
        let name = name_of(path);
        let bytes = bytes(path, Kind::Dcc.words())?;
        let content = Administrative::from_yaml(&name, &bytes)?;
        let text = String::from_utf8_lossy(&bytes);
        let text = text.strip_prefix('\u{FEFF}').unwrap_or(&text).to_owned();
        Ok(Self { name, text, content: Some(content) })
    }

    /// Returns the refusal of a DCC, with the lines of the file.
    pub(super) fn refuse(&self, problems: Problems) -> Failed {
        let error = match &self.content {
            Some(_) => problems.refuse(&self.name, &self.text).in_text(self.text.as_bytes()),
            None => problems.refuse_by_field(&self.name),
        };
        let is_missing = error.problems().iter().any(|problem| problem.found == MISSING);
        Failed { code: if is_missing { MISSING_DATA } else { REFUSED }, ..Failed::from(error) }
    }
}

/// Result of a verb for one of several inputs.
#[derive(Serialize)]
#[serde(untagged)]
pub(super) enum Each<T> {
    Done(T),
    Refused {
        file: String,
        #[serde(flatten, serialize_with = "as_document")]
        refusal: Failed,
    },
}

fn as_document<S: Serializer>(refusal: &Failed, to: S) -> Result<S::Ok, S::Error> {
    refusal.document().serialize(to)
}

/// Calls `work` for every input, reports those that fail, and returns the highest exit code.
///
/// `hear` gets each result or refusal in the order of the inputs; an error of it ends the work.
pub(super) fn each<T>(
    arguments: &[PathBuf],
    purpose: Purpose,
    mut work: impl FnMut(&Path) -> Result<(T, Code), Failure>,
    mut hear: impl FnMut(Each<T>) -> Result<(), Failure>,
) -> Result<Code, Failure> {
    let mut code = 0;
    for input in paths::files(arguments, &mut std::io::stdin().lock(), purpose) {
        let done = match input {
            Ok(path) => work(&path).map_err(|failure| (name_of(&path), failure)),
            Err(failed) => Err((failed.what.clone(), Failure::input(&failed))),
        };
        code = code.max(match &done {
            Ok((_, code)) => *code,
            Err((_, failure)) => failure.code,
        });
        // The result comes before the message about it.
        match done {
            Ok((result, _)) => hear(Each::Done(result))?,
            Err((file, failure)) => {
                let words = words(&file, &failure);
                let heard = hear(Each::Refused { file, refusal: failure.failed.clone() });
                failure.complain(&words);
                heard?;
            }
        }
    }
    Ok(code)
}

/// Returns the message about the failure of an input, which states its name.
fn words(file: &str, failure: &Failure) -> String {
    let (name, message) = (Printable(file).to_string(), &failure.failed.message);
    if message.contains(&name) { message.clone() } else { format!("{name}: {message}") }
}

/// Prints the result for one of several inputs: its JSON on one line, or its text.
pub(super) fn print<T: Serialize>(result: &Each<(T, String)>, format: Format) -> Result<(), Failure> {
    match (format, result) {
        (Format::Text, Each::Done((_, text))) => output::text(text),
        (Format::Text, Each::Refused { file, refusal }) => {
            output::text(&issued::failed_line(file, refusal, lang::of_text()))
        }
        (_, Each::Done((value, _))) => output::json_line(value),
        (_, refused @ Each::Refused { .. }) => output::json_line(refused),
    }
}
