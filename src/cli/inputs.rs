//! Input files of the verbs: documents read, and several inputs of which one that fails does not stop the others.

use super::output::language;
use super::{Code, Failure, output};
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
use serde::Serialize;
use std::ops::RangeInclusive;
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
    gyro_type.iter().flat_map(GyroType::remarks).for_each(|words| output::warn(&said(&words, language())));
    Ok(gyro_type)
}

/// Reads a laboratory file, or returns the paper's meter without a path.
pub(super) fn laboratory(path: Option<&Path>) -> Result<Laboratory, Failure> {
    let Some(path) = path else { return Ok(Laboratory::paper()) };
    let laboratory = document(path, Kind::Laboratory.words(), Laboratory::from_yaml)?;
    laboratory.remarks().iter().for_each(|words| output::warn(&said(words, language())));
    Ok(laboratory)
}

/// Returns a parser of a number within limits; `what` is its quantity with the unit.
pub(super) fn number(
    what: &'static str,
    limits: RangeInclusive<f64>,
) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync + 'static {
    move |text| {
        let (first, last) = (limits.start(), limits.end());
        text.parse().ok().filter(|value: &f64| value.is_finite() && limits.contains(value)).ok_or_else(|| {
            match last.is_finite() {
                true => format!("expected {what} from {first} to {last}, with a decimal point"),
                false => format!("expected {what} ≥ {first}, with a decimal point"),
            }
        })
    }
}

/// Returns a parser of a whole number within limits; a limit that is the largest number is none.
pub(super) fn whole<T: TryFrom<u64>>(
    limits: RangeInclusive<u64>,
) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync + 'static {
    move |text| {
        let value = text.parse().ok().filter(|value| limits.contains(value)).and_then(|value| T::try_from(value).ok());
        value.ok_or_else(|| match (limits.start(), *limits.end()) {
            (first, u64::MAX) => format!("expected a whole number of {first} or more"),
            (first, last) => format!("expected a whole number from {first} to {last}"),
        })
    }
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

/// Answer on one of several inputs, for programs and for people, and its exit code.
pub(super) struct Answer<T> {
    pub value: T,
    pub text: String,
    pub code: Code,
}

/// What is printed for each input: its JSON on one line, its text, or nothing where files are the result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lines {
    Json,
    Text,
    None,
}

impl Lines {
    /// Returns JSON if it is the format of the results, and otherwise `text`.
    pub(super) fn or(text: Self) -> Self {
        if output::is_json() { Self::Json } else { text }
    }
}

/// Result of an input, or why there is none, with the name of its file, for programs.
#[derive(Serialize)]
pub(super) struct Named<T> {
    pub file: String,
    #[serde(flatten)]
    pub result: T,
}

/// Calls `work` for every input, and reports its answer or its failure. An error of the output ends the work.
///
/// Returns the highest exit code, and the failures.
pub(super) fn each<T: Serialize>(
    arguments: &[PathBuf],
    purpose: Purpose,
    lines: Lines,
    mut work: impl FnMut(&Path) -> Result<Answer<T>, Failure>,
) -> Result<(Code, Vec<Failed>), Failure> {
    let (mut code, mut failures) = (0, Vec::new());
    for input in paths::files(arguments, &mut std::io::stdin().lock(), purpose) {
        let answer = match input {
            Ok(path) => work(&path).map_err(|failure| (name_of(&path), failure)),
            Err(failed) => Err((failed.what.clone(), Failure::input(&failed))),
        };
        code = code.max(match &answer {
            Ok(answer) => answer.code,
            Err((_, failure)) => failure.code,
        });
        // The result comes before the message about it.
        match answer {
            Ok(answer) => match lines {
                Lines::Json => output::json_line(&answer.value)?,
                Lines::Text => output::text(&answer.text)?,
                Lines::None => {}
            },
            Err((file, failure)) => {
                let heard = match lines {
                    Lines::Json => output::json_line(&Named { file: file.clone(), result: failure.failed.document() }),
                    Lines::Text => output::text(&issued::failed_line(&file, &failure.failed, language())),
                    Lines::None => Ok(()),
                };
                failure.complain(&words(&file, &failure));
                heard?;
                failures.push(failure.failed);
            }
        }
    }
    Ok((code, failures))
}

/// Returns the message about the failure of an input, which states its name.
fn words(file: &str, failure: &Failure) -> String {
    let (name, message) = (Printable(file).to_string(), &failure.failed.message);
    if message.contains(&name) { message.clone() } else { format!("{name}: {message}") }
}
