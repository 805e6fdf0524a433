//! A new workspace: its folders and files.

use super::{WORKSPACE_FILE, Workspace};
use crate::files::together::write_replaceable_together;
use crate::files::{self, FileError};
use crate::text::{LARGEST_DOCUMENT_BYTES, rule};
use std::fs;
use std::path::{Path, PathBuf};

/// What a workspace is for.
pub(crate) enum Kind<'a> {
    /// A factory, which issues as this identity if it is known.
    Factory(Option<&'a str>),
    /// A laboratory with these stands, `<model>/<serial>`.
    Laboratory(&'a [String]),
}

impl Kind<'_> {
    fn folders(&self) -> &'static [&'static str] {
        match self {
            Self::Factory(_) => &["stands", "sites", "readings", "passports"],
            Self::Laboratory(_) => &["passports", "readings", "results"],
        }
    }
}

/// Reason why a workspace was not made.
#[derive(Debug, thiserror::Error)]
pub(crate) enum NotMade {
    /// File or folder that exists or cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// Identity that cannot be written in one line.
    #[error("the identity contains a character that the file of a workspace cannot contain")]
    Identity,
}

/// Makes the folders and files of a workspace in `root`, and returns their paths.
///
/// Existing files are replaced only with `force`; without it nothing is written if one exists. After an error, the new
/// files and folders are removed.
pub(crate) fn make(root: &Path, kind: &Kind, force: bool) -> Result<Vec<PathBuf>, NotMade> {
    let readme = match kind {
        Kind::Factory(_) => include_str!("new/README.md"),
        Kind::Laboratory(_) => include_str!("new/laboratory.md"),
    };
    let written = [
        (root.join(WORKSPACE_FILE), settings(kind)?),
        (root.join(".gitignore"), include_str!("new/gitignore").to_owned()),
        (root.join(".gitattributes"), include_str!("new/gitattributes").to_owned()),
        (root.join("README.md"), readme.to_owned()),
    ];
    files::check_replaceable(written.iter().map(|(path, _)| path), force)?;
    let mut made = Vec::new();
    if let Err(error) = folders(root, kind, &mut made).and_then(|()| write_replaceable_together(&written, force)) {
        // What cannot be removed is left, because the first error counts.
        made.iter().rev().for_each(|folder| drop(fs::remove_dir(folder)));
        return Err(error.into());
    }
    let folders = kind.folders().iter().map(|name| root.join(name));
    Ok(written.iter().map(|(path, _)| path.clone()).chain(folders).collect())
}

/// Makes the folders that are missing, and adds them to `made` in the order of their creation.
fn folders(root: &Path, kind: &Kind, made: &mut Vec<PathBuf>) -> Result<(), FileError> {
    let missing: Vec<&Path> = root.ancestors().take_while(|folder| !folder.exists()).collect();
    // The path of the current folder is empty.
    let missing = missing.into_iter().rev().filter(|folder| !folder.as_os_str().is_empty()).map(Path::to_owned);
    for folder in missing.chain(kind.folders().iter().map(|name| root.join(name))) {
        if !folder.is_dir() {
            fs::create_dir(&folder).map_err(|error| FileError::Write(folder.clone(), error))?;
            made.push(folder);
        }
    }
    Ok(())
}

/// Comment that a new workspace has instead of its issuer.
const NO_IDENTITY: &str = "# identity = \"factory@example.org\"";

/// Returns the line that states the issuer.
fn identity_line(identity: &str) -> Result<String, NotMade> {
    let is_plain = identity.chars().all(rule::allowed_in_string) && !identity.contains(['"', '\\']);
    if is_plain { Ok(format!("identity = \"{identity}\"")) } else { Err(NotMade::Identity) }
}

impl Workspace {
    /// Returns the file of this workspace, which states no issuer, and its text with one.
    pub(crate) fn with_identity(&self, identity: &str) -> Result<(PathBuf, String), NotMade> {
        let path = self.root.join(WORKSPACE_FILE);
        let text = files::read(&path, LARGEST_DOCUMENT_BYTES)?;
        let (text, line) = (String::from_utf8_lossy(&text), identity_line(identity)?);
        let stated = text.replacen(NO_IDENTITY, &line, 1);
        Ok((path, if stated == text { format!("{}\n{line}\n", text.trim_end()) } else { stated }))
    }
}

/// Returns the text of the file of a new workspace.
pub(super) fn settings(kind: &Kind) -> Result<String, NotMade> {
    let identity = match kind {
        Kind::Laboratory(stands) => {
            let stands: Vec<String> = stands.iter().map(|stand| format!("{stand:?}")).collect();
            let stands = match stands.is_empty() {
                true => "# stand = [\"MODEL/SERIAL\"]".to_owned(),
                false => format!("stand = [{}]", stands.join(", ")),
            };
            return Ok(include_str!("new/laboratory.toml").replace("{stand}", &stands));
        }
        Kind::Factory(None) => NO_IDENTITY.to_owned(),
        Kind::Factory(Some(identity)) => identity_line(identity)?,
    };
    Ok(include_str!("new/dtg-passport.toml").replace("{identity}", &identity))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn files(root: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(root).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn after_an_error_nothing_is_left() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("stands"), "a file").unwrap();
        assert!(make(folder.path(), &Kind::Factory(None), false).is_err());
        assert_eq!(files(folder.path()), ["stands"]);
        assert!(make(&folder.path().join("stands/below"), &Kind::Factory(None), false).is_err());
        assert!(matches!(
            make(&folder.path().join("new"), &Kind::Factory(Some("a\"b")), false),
            Err(NotMade::Identity)
        ));
        assert_eq!(files(folder.path()), ["stands"]);
    }
}
