//! Calibrations in the workspace of a laboratory: the passport that is in force there, and the results, one after another.

use super::Workspace;
use crate::calibration::CalibrationDocument;
use crate::files::{self, FileError};
use crate::folder::{Folder, Registers};
use crate::interface::Enquiry;
use crate::passport::Verification;
use crate::register::RegisterRefused;
use crate::text::{Identifier, LARGEST_DOCUMENT_BYTES, Unreadable, name_of, printable, shown};
use jiff::civil::Date;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Reason why a workspace does not tell the passport to use, or the place of a result.
#[derive(Debug, thiserror::Error)]
pub(crate) enum NoPassport {
    #[error("the workspace states no `stand`; add it to dtg-passport.toml, or give PASSPORT")]
    NoStand,
    #[error("the workspace has {0}; choose one with --serial")]
    SeveralStands(String),
    #[error("the workspace states no {0}; add it to dtg-passport.toml, or give PASSPORT")]
    NotStated(&'static str),
    #[error(transparent)]
    Register(#[from] RegisterRefused),
    #[error("no passport of {0} is in this workspace; receive one from the factory")]
    None(String),
    #[error("{0} are in force; state the place of the stand with `at` in dtg-passport.toml, or with --at")]
    Several(String),
    #[error("none of the passports of {0} may be used: {1}")]
    Unusable(String, String),
    #[error(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    Unreadable(#[from] Unreadable),
    #[error(
        "{}: found {}, expected the serial number of the gyro as the name of the file, such as 4711.csv; rename it, or \
         give --gyro-serial",
        shown(.0),
        printable(.1)
    )]
    Serial(PathBuf, String),
}

impl Workspace {
    /// Returns the stand of a laboratory, the one with this serial number if there are several.
    pub(crate) fn stand_in_use(&self, serial: Option<&str>) -> Result<&str, NoPassport> {
        let has =
            |stand: &&String| serial.is_none_or(|serial| stand.ends_with(&format!("/{serial}")) || *stand == serial);
        let mut stands = self.stand.iter().filter(has);
        match (stands.next(), stands.next()) {
            (Some(stand), None) => Ok(stand),
            (None, _) if self.stand.is_empty() => Err(NoPassport::NoStand),
            _ => Err(NoPassport::SeveralStands(self.stand.join(", "))),
        }
    }

    /// Returns the path of the passport of `stand` that may be used by `enquiry`, or of the only one there is.
    pub(crate) fn passport_in_force(&self, stand: &str, enquiry: &Enquiry) -> Result<PathBuf, NoPassport> {
        let root = self.passports.as_deref().ok_or(NoPassport::NotStated("`passports`"))?;
        let registers = Registers::new(root, enquiry.trust.clone(), enquiry.question.now, Some(self.memory().clone()));
        let found = registers.of(stand)?;
        let mut there: Vec<(&str, PathBuf, Verification)> = Vec::new();
        for entry in found.register.entries() {
            let path = Folder::new(root).path_of_id(&entry.id).unwrap_or_default();
            match files::read(&path, LARGEST_DOCUMENT_BYTES) {
                Ok(bytes) => there.push((&entry.id, path.clone(), enquiry.verification(&name_of(&path), &bytes))),
                // A laboratory gets what is for it.
                Err(error) if error.is_missing() => {}
                Err(error) => return Err(error.into()),
            }
        }
        let good: Vec<_> = there.iter().filter(|(_, _, verification)| verification.valid()).collect();
        match (good.as_slice(), there.as_slice()) {
            ([(_, path, _)], _) | ([], [(_, path, _)]) => Ok(path.clone()),
            ([], []) => Err(NoPassport::None(stand.to_owned())),
            ([], all) => {
                let why = |(id, _, verification): &(&str, PathBuf, Verification)| {
                    format!("{id} ({})", verification.failed().map_or("", |check| check.code.as_str()))
                };
                Err(NoPassport::Unusable(stand.to_owned(), all.iter().map(why).collect::<Vec<_>>().join(", ")))
            }
            (several, _) => {
                Err(NoPassport::Several(several.iter().map(|(id, ..)| *id).collect::<Vec<_>>().join(" and ")))
            }
        }
    }
}

/// Returns the serial number of a gyro, the name of its file of currents unless another one is `given`.
pub(crate) fn serial_of(currents: &Path, given: Option<&str>) -> Result<String, NoPassport> {
    let stem = currents.file_stem().unwrap_or_default().to_string_lossy();
    let serial = given.unwrap_or(&stem);
    match Identifier::new(serial) {
        Ok(_) => Ok(serial.to_owned()),
        Err(_) => Err(NoPassport::Serial(currents.to_owned(), serial.to_owned())),
    }
}

/// Results of one gyro: `<serial>-<day>.json`, and for a further one of that day `<serial>-<day>-2.json`.
#[derive(Debug)]
pub(crate) struct Results {
    /// Path of the next result, without its extension.
    pub next: PathBuf,
    /// The last result until that day.
    pub last: Option<CalibrationDocument>,
}

impl Results {
    /// Finds the results of a gyro in a folder, which need not exist yet, until `day`.
    pub(crate) fn of(folder: &Path, serial: &str, day: Date) -> Result<Self, NoPassport> {
        let names: Vec<String> = match fs::read_dir(folder) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Vec::new(),
            Err(error) => return Err(FileError::Read(folder.to_owned(), error).into()),
            Ok(entries) => entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect(),
        };
        let numbers = names.iter().filter_map(|name| Some((number_of(name, serial)?, name)));
        let last = numbers.filter(|((of, _), _)| *of <= day).max();
        let next = last.filter(|((of, _), _)| *of == day).map_or(1, |((_, number), _)| number + 1);
        let suffix = if next == 1 { String::new() } else { format!("-{next}") };
        let read = |(_, name): (_, &String)| {
            let path = folder.join(name);
            Ok::<_, NoPassport>(CalibrationDocument::from_json(
                &name_of(&path),
                &files::read(&path, LARGEST_DOCUMENT_BYTES)?,
            )?)
        };
        Ok(Self { next: folder.join(format!("{serial}-{day}{suffix}")), last: last.map(read).transpose()? })
    }
}

/// Returns the day and the number in the name of a result of `serial`, or `None` for another file.
fn number_of(name: &str, serial: &str) -> Option<(Date, u32)> {
    let rest = name.strip_suffix(".json")?.strip_prefix(serial)?.strip_prefix('-')?;
    let (day, number) = (rest.get(..10)?, rest.get(10..)?);
    let day: Date = day.parse().ok().filter(|date: &Date| date.to_string() == day)?;
    let number =
        if number.is_empty() { 1 } else { number.strip_prefix('-')?.parse().ok().filter(|number| *number > 1)? };
    Some((day, number))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_result_of_a_gyro_is_found_by_its_name() {
        let day = |text: &str| text.parse::<Date>().unwrap();
        for (name, serial, due) in [
            ("4711-2026-11-02.json", "4711", Some((day("2026-11-02"), 1))),
            ("4711-2026-11-02-12.json", "4711", Some((day("2026-11-02"), 12))),
            ("4711-2026-11-02-1.json", "4711", None),
            ("4711-2026-11-02.html", "4711", None),
            ("4711-A-2026-11-02.json", "4711", None),
            ("4711-A-2026-11-02.json", "4711-A", Some((day("2026-11-02"), 1))),
            ("4711-2026-11-32.json", "4711", None),
            ("47110-2026-11-02.json", "4711", None),
        ] {
            assert_eq!(number_of(name, serial), due, "{name}");
        }
        assert_eq!(serial_of(Path::new("readings/4711.csv"), None).unwrap(), "4711");
        assert_eq!(serial_of(Path::new("readings/x y.csv"), Some("A-1")).unwrap(), "A-1");
        assert!(serial_of(Path::new("readings/x y.csv"), None).is_err());
    }
}
