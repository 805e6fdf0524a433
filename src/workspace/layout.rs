//! A new workspace: its folders and files.

use super::WORKSPACE_FILE;
use crate::files::{self, Access, FileError};
use crate::folder::search::LISTS_FOLDER;
use crate::text::rule;
use std::fs;
use std::path::{Path, PathBuf};

const FOLDERS: [&str; 5] = ["stands", "sites", "readings", "passports", LISTS_FOLDER];

const GITIGNORE: &str = "# Private keys stay on the machine that signs.\n*.key\n";

const GITATTRIBUTES: &str =
    "# Passports are signed byte for byte: git must not change their line ends.\n*.yaml -text\n";

const READ_ME: &str = "# Workspace of dtg-passport\n\
     \n\
     This folder holds calibration passports of gyro test stands, and what they are made from.\n\
     \n\
     | path | content |\n\
     |---|---|\n\
     | `dtg-passport.toml` | key, issuer, trusted keys and folders that the commands use |\n\
     | `factory.key` | the signing key: secret, never copied, never in version control |\n\
     | `allowed_signers` | the trusted keys: protect it from changes |\n\
     | `stands/MODEL/SERIAL/stand.yaml` | certified deviations of a stand |\n\
     | `sites/ID.yaml` | a place of use |\n\
     | `readings/` | measured angles and currents |\n\
     | `passports/MODEL/SERIAL/SITE-REVISION.yaml` | signed passports: never edited, never deleted |\n\
     | `revocations/revocation-N.yaml` | signed lists of withdrawn passports: never deleted, copied with the passports |\n\
     \n\
     In this folder:\n\
     \n\
     ```sh\n\
     export DTG_PASSPORT_WORKSPACE=\"$PWD\"\n\
     dtg-passport status                                   # what is here, in force, expiring, wrong\n\
     dtg-passport issue MODEL/SERIAL --site ID             # a passport\n\
     dtg-passport verify MODEL/SERIAL/ID/1                 # may it be used?\n\
     dtg-passport revoke MODEL/SERIAL/ID/1 --reason TEXT   # withdraw it\n\
     ```\n";

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

/// Makes the folders and files of a workspace in `root`, for the issuer `identity` if known, and returns their paths.
///
/// Existing files are replaced only with `force`; without it nothing is written if one exists. After an error, the new
/// files and folders are removed.
pub(crate) fn make(root: &Path, identity: Option<&str>, force: bool) -> Result<Vec<PathBuf>, NotMade> {
    let written = [
        (root.join(WORKSPACE_FILE), settings(identity)?),
        (root.join(".gitignore"), GITIGNORE.to_owned()),
        (root.join(".gitattributes"), GITATTRIBUTES.to_owned()),
        (root.join("README.md"), READ_ME.to_owned()),
    ];
    files::check_replaceable(written.iter().map(|(path, _)| path), force)?;
    let mut made = Made::default();
    let done =
        made.folders(root).and_then(|()| written.iter().try_for_each(|(path, text)| made.file(path, text, force)));
    if let Err(error) = done {
        made.undo();
        return Err(error.into());
    }
    let folders = FOLDERS.iter().map(|name| root.join(name));
    Ok(written.iter().map(|(path, _)| path.clone()).chain(folders).collect())
}

/// New files and folders, in the order of their creation.
#[derive(Default)]
struct Made {
    files: Vec<PathBuf>,
    folders: Vec<PathBuf>,
}

impl Made {
    fn folders(&mut self, root: &Path) -> Result<(), FileError> {
        let missing: Vec<&Path> = root.ancestors().take_while(|folder| !folder.exists()).collect();
        // The path of the current folder is empty.
        let missing = missing.into_iter().rev().filter(|folder| !folder.as_os_str().is_empty()).map(Path::to_owned);
        for folder in missing.chain(FOLDERS.iter().map(|name| root.join(name))).collect::<Vec<_>>() {
            if folder.is_dir() {
                continue;
            }
            fs::create_dir(&folder).map_err(|error| FileError::Write { path: folder.clone(), error })?;
            self.folders.push(folder);
        }
        Ok(())
    }

    fn file(&mut self, path: &Path, text: &str, force: bool) -> Result<(), FileError> {
        let is_new = !path.exists();
        if force {
            files::write_replaceable(path, text.as_bytes(), force)?;
        } else {
            files::write_new(path, text.as_bytes(), Access::Shared)?;
        }
        if is_new {
            self.files.push(path.to_owned());
        }
        Ok(())
    }

    /// Removes what was made; what cannot be removed is left, because the first error counts.
    fn undo(self) {
        self.files.iter().for_each(|path| drop(fs::remove_file(path)));
        self.folders.iter().rev().for_each(|path| drop(fs::remove_dir(path)));
    }
}

fn settings(identity: Option<&str>) -> Result<String, NotMade> {
    let identity = match identity {
        None => "# identity = \"factory@example.org\"".to_owned(),
        Some(identity) if identity.chars().all(rule::allowed_in_string) && !identity.contains(['"', '\\']) => {
            format!("identity = \"{identity}\"")
        }
        Some(_) => return Err(NotMade::Identity),
    };
    Ok(format!(
        "# Workspace of dtg-passport: what its commands take where an option is not given. It is used only if\n\
         # --workspace or DTG_PASSPORT_WORKSPACE names this folder. Paths are relative to this folder.\n\
         \n\
         # Signing key. `dtg-passport keygen factory.key --allowed-signers allowed_signers` creates it here.\n\
         key = \"factory.key\"\n\
         # Issuer: the name before that key in allowed_signers.\n\
         {identity}\n\
         # Trusted keys: your own, and those of factories whose passports you use.\n\
         trust = \"allowed_signers\"\n\
         \n\
         # Passports; new signed lists of withdrawn passports are in the folder revocations next to this one.\n\
         passports = \"passports\"\n\
         # Files of stands (MODEL/SERIAL/stand.yaml) and of sites.\n\
         stands = \"stands\"\n\
         sites = \"sites\"\n"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::Workspace;

    fn files(root: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(root).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn it_is_whole_and_its_own_reader_reads_it() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().join("a/b");
        make(&root, Some("factory@example.org"), false).unwrap();
        let due = [
            ".gitattributes",
            ".gitignore",
            "README.md",
            "dtg-passport.toml",
            "passports",
            "readings",
            "revocations",
            "sites",
            "stands",
        ];
        assert_eq!(files(&root), due);
        let workspace = Workspace::read(&root).unwrap();
        assert_eq!(workspace.identity.as_deref(), Some("factory@example.org"));
        assert_eq!(workspace.key, Some(root.join("factory.key")));
        assert_eq!(workspace.passports, Some(root.join("passports")));
        fs::write(root.join("README.md"), "mine").unwrap();
        assert!(make(&root, None, false).unwrap_err().to_string().contains("dtg-passport.toml: already exists"));
        assert_eq!(fs::read_to_string(root.join("README.md")).unwrap(), "mine");
        make(&root, None, true).unwrap();
        assert_eq!(Workspace::read(&root).unwrap().identity, None);
    }

    #[test]
    fn after_an_error_nothing_is_left() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("stands"), "a file").unwrap();
        assert!(make(folder.path(), None, false).is_err());
        assert_eq!(files(folder.path()), ["stands"]);
        assert!(make(&folder.path().join("stands/below"), None, false).is_err());
        assert!(matches!(make(&folder.path().join("new"), Some("a\"b"), false), Err(NotMade::Identity)));
        assert_eq!(files(folder.path()), ["stands"]);
    }
}
