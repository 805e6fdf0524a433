//! Failure of a verb: the message and an exit code for people, and the same as JSON for programs.

use super::{Code, REFUSED, UNUSABLE, open_workspace, output};
use crate::files::FileError;
use crate::folder::Folder;
use crate::interface::{self, Failed, Place};
use crate::passport::{Check, Question, Verification};
use crate::report::{issued, style, verdict};
use crate::text::{Unreadable, name_of, shown};
use std::path::Path;
use std::process::ExitCode;

/// Code of a failure in JSON, besides those of the library and of a passport's checks.
const USAGE: &str = "usage";

const IN_A_WORKSPACE: &str =
    "identifiers of passports can be used only in a workspace; specify it with --workspace, or give the file";

/// A failure that ends a verb at once, and its exit code.
#[derive(Debug)]
pub(super) struct Failure {
    pub failed: Failed,
    /// Exit code.
    pub code: Code,
    /// `true` if the message begins with a verdict, before which the name of the program is omitted.
    pub is_verdict: bool,
}

impl From<Failed> for Failure {
    fn from(failed: Failed) -> Self {
        let refused = [interface::REFUSED, interface::EXISTS, interface::MISSING_DATA].contains(&failed.code);
        let code = if refused { REFUSED } else { UNUSABLE };
        Self { failed, code, is_verdict: false }
    }
}

/// An existing file is a refusal, any other error of a file is not.
impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        Self::of_file(error, None)
    }
}

/// The message includes the lines with mistakes.
impl From<Unreadable> for Failure {
    fn from(error: Unreadable) -> Self {
        Failed::from(error).into()
    }
}

impl Failure {
    pub(super) fn refused(error: impl std::fmt::Display) -> Self {
        Failed::refused(error).into()
    }

    pub(super) fn unusable(error: impl std::fmt::Display) -> Self {
        Failed::unusable(error).into()
    }

    /// Creates the failure for arguments that cannot be used.
    pub(super) fn usage(error: impl std::fmt::Display) -> Self {
        Failed::new(USAGE, error.to_string(), Vec::new()).into()
    }

    pub(super) fn input(failed: &crate::batch::Failure) -> Self {
        if let Some(unreadable) = &failed.unreadable {
            return Unreadable::clone(unreadable).into();
        }
        let words = issued::failure(failed);
        if failed.unusable { Self::unusable(words) } else { Self::refused(words) }
    }

    /// Reports the failure, which ends the program, and returns the exit code.
    pub(super) fn report(&self) -> ExitCode {
        self.print();
        self.complain(&self.failed.message);
        ExitCode::from(self.code)
    }

    /// Writes the failure as JSON instead of a result. An error is ignored, because the message and the exit code remain.
    pub(super) fn print(&self) {
        if output::is_json() {
            let _ = output::value(&self.failed.document());
        }
    }

    /// Writes the message, or `words` that contain it.
    pub(super) fn complain(&self, words: &str) {
        if self.is_verdict { output::verdict(words) } else { output::complain(words) }
    }

    pub(super) fn with_advice(mut self, advice: &str) -> Self {
        self.failed.message += &format!("; {advice}");
        self
    }

    /// Creates the failure for a file; if neither it nor one with a similar name exists, the message says what is `expected`,
    /// or where the identifier of a passport can be used.
    pub(super) fn of_file(error: FileError, expected: Option<&str>) -> Self {
        let is_id = Folder::new("").path_of_id(&error.path().to_string_lossy()).is_some();
        let advice = match expected {
            _ if !error.is_unlike_any() => None,
            _ if is_id && open_workspace::workspace().is_none() => Some(IN_A_WORKSPACE.to_owned()),
            expected => expected.map(|expected| format!("expected {expected}")),
        };
        let failure = Self::from(Failed::from(error));
        advice.into_iter().fold(failure, |failure, advice| failure.with_advice(&advice))
    }

    /// Creates the failure for a folder found instead of the file that `expected` describes.
    pub(super) fn folder(path: &Path, expected: &str) -> Self {
        let message = format!("{}: found a folder, expected {expected}; specify a file in it", shown(path));
        let problems = vec![Place::file(name_of(path), message.clone())];
        Failed::new(interface::UNREADABLE, message, problems).into()
    }

    /// Creates the failure for the passport `name`, which did not pass every check; `words` follow its verdict.
    pub(super) fn verdict(words: &str, name: &str, verification: &Verification, question: &Question) -> Self {
        let verdict = verdict::Verdict::of(name, verification, &[]);
        let failed: Vec<_> = verdict.checks.iter().filter(|check| check.passed() == Some(false)).collect();
        let kind = failed.first().map_or(interface::REFUSED, |check| check.code.as_str());
        let place = |check: &&Check| Place::file(name.to_owned(), format!("{}: {}", check.name.as_str(), check.detail));
        let problems = failed.iter().map(place).collect();
        let words = style::plain(&output::typed(&verdict::document(&verdict, verification, question))) + words;
        Self { failed: Failed::new(kind, words.trim_end().to_owned(), problems), code: REFUSED, is_verdict: true }
    }
}
