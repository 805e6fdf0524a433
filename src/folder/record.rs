//! History of one stand, from the files in a folder of passports.

use super::search;
use crate::files::{self, FileError};
use crate::history::{History, Recorded};
use crate::parallel;
use crate::passport::Trust;
use crate::register::{Asked, Register};
use crate::text::LARGEST_DOCUMENT_BYTES;
use jiff::Timestamp;
use std::path::Path;

/// Returns the history of a stand, `<model>/<serial>`, and the register of its passports. If no file in the folder is a
/// passport of the stand, the history is `None`, and the register is that of all stands.
///
/// # Errors
/// Returns [`FileError`] if the folder, or a passport of the stand, cannot be read.
pub(crate) fn history(
    root: &Path,
    stand: &str,
    trust: Trust,
    time: Timestamp,
    threads: usize,
) -> Result<(Option<History>, Register), FileError> {
    let asked = Asked::at(time);
    let (register, extended) = search::register_of(root, Some(stand), trust.clone(), &asked, threads)?;
    let lines: Vec<_> = register.passports.iter().filter(|line| line.stand.as_deref() == Some(stand)).collect();
    if lines.is_empty() {
        return Ok((None, search::register(root, trust, &asked, threads)?.0));
    }
    let recorded = parallel::map(&lines, threads, |line| {
        let bytes = files::read(Path::new(&line.file), LARGEST_DOCUMENT_BYTES)?;
        Ok(Recorded::of(line, &bytes, &extended, time))
    });
    let recorded = recorded.into_iter().collect::<Result<Vec<_>, FileError>>()?;
    Ok((Some(History::of(stand, recorded, &register, &extended, time)), register))
}
