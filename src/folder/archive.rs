//! Stand files that a new certificate supersedes: kept under another name, next to the new one.

use crate::files::{self, FileError};
use crate::stand::Stand;
use crate::text::{LARGEST_DOCUMENT_BYTES, name_of};
use std::path::{Path, PathBuf};

/// Largest number of files that are kept for one certificate number.
const MOST: u32 = 1000;

/// Stand file that is to be kept before another one takes its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Superseded {
    /// Path under which it is kept.
    pub path: PathBuf,
    pub bytes: Vec<u8>,
    /// `true` if a file with this content is already there.
    pub kept: bool,
}

impl Superseded {
    /// Returns how the stand file at `path` is kept when `new` replaces it, or `None` if there is no file, if it is not
    /// a certified stand, or if it has the same content.
    ///
    /// The name is `stand-<certificate number>.superseded.yaml`. It is neither that of a passport nor that of a stand
    /// file, so that no search of a folder takes it for either.
    ///
    /// # Errors
    /// Returns [`FileError`] if the file cannot be read, or if too many files with this name are there.
    pub(crate) fn of(path: &Path, new: &[u8]) -> Result<Option<Self>, FileError> {
        let bytes = match files::read(path, LARGEST_DOCUMENT_BYTES) {
            Ok(bytes) => bytes,
            Err(error) if error.is_missing() => return Ok(None),
            Err(FileError::TooLarge(..)) => return Ok(None),
            Err(error) => return Err(error),
        };
        let Ok(stand) = Stand::from_yaml(&name_of(path), &bytes) else { return Ok(None) };
        if bytes == new {
            return Ok(None);
        }
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let number = in_a_name(&stand.certificate.number);
        for copy in 1..=MOST {
            let copy = if copy == 1 { String::new() } else { format!(".{copy}") };
            let kept_at = path.with_file_name(format!("{stem}-{number}{copy}.superseded.yaml"));
            match files::read(&kept_at, LARGEST_DOCUMENT_BYTES) {
                Ok(there) if there == bytes => return Ok(Some(Self { path: kept_at, bytes, kept: true })),
                Err(error) if error.is_missing() => return Ok(Some(Self { path: kept_at, bytes, kept: false })),
                _ => {}
            }
        }
        Err(FileError::Exists { path: path.to_owned(), replaceable: false })
    }

    /// Returns the file to be written under its new name, or `None` if it is already there.
    pub(crate) fn new_file(&self) -> Option<(PathBuf, Vec<u8>)> {
        (!self.kept).then(|| (self.path.clone(), self.bytes.clone()))
    }
}

/// Returns a certificate number as part of a file name: letters, digits, points and hyphens of ASCII.
fn in_a_name(number: &str) -> String {
    const MOST: usize = 64;
    let plain = |c: char| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' };
    number.chars().map(plain).take(MOST).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const STAND: &str = include_str!("../../passports/SPS-2/0017/stand.yaml");

    #[test]
    fn a_superseded_stand_is_kept_once_for_each_content() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("stand.yaml");
        assert_eq!(Superseded::of(&path, b"new").unwrap(), None);
        std::fs::write(&path, STAND).unwrap();
        assert_eq!(Superseded::of(&path, STAND.as_bytes()).unwrap(), None);
        let old = Superseded::of(&path, b"new").unwrap().unwrap();
        assert_eq!(old.path.file_name().unwrap(), "stand-C-2026-0142.superseded.yaml");
        let (kept_at, bytes) = old.new_file().unwrap();
        std::fs::write(kept_at, bytes).unwrap();
        assert_eq!(std::fs::read(&old.path).unwrap(), STAND.as_bytes());
        assert!(Superseded::of(&path, b"new").unwrap().unwrap().kept);
        std::fs::write(&path, STAND.replace("12.4", "12.5")).unwrap();
        let other = Superseded::of(&path, b"new").unwrap().unwrap();
        assert_eq!(other.path.file_name().unwrap(), "stand-C-2026-0142.2.superseded.yaml");
        std::fs::write(&path, "not a stand").unwrap();
        assert_eq!(Superseded::of(&path, b"new").unwrap(), None);
        // Neither a stand nor a passport by its name.
        assert_eq!(crate::folder::place::numbered(old.path.file_name().unwrap()), None);
        assert_eq!(in_a_name("№ 12/34"), "__12_34");
    }
}
