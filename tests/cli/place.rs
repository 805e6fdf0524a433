//! A folder of a test, and the program run in it.

use crate::programs;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

pub struct Place(tempfile::TempDir);

impl Place {
    pub fn empty() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    /// A folder with copies of files of the project, each with its name there; `key` is the published test key.
    pub fn of(files: &[(&str, &str)]) -> Self {
        let place = Self::empty();
        for (from, to) in files {
            place.copy(from, to);
        }
        place
    }

    /// The workspace of a factory with passports for two sites.
    pub fn new() -> Self {
        let place = Self::before_issue();
        place.good(
            "issue SPS-2/0017 SPS-2/0018 --site moscow-bmstu --site torino-inrim --workspace factory \
             --allow-uncalibratable",
        );
        place
    }

    /// Makes the workspace with stands and sites, but without passports.
    pub fn before_issue() -> Self {
        let place = Self::empty();
        place.good("init factory --identity factory@example.org");
        place.good(
            "keygen factory/factory.key --no-passphrase --identity factory@example.org --allowed-signers \
             factory/allowed_signers",
        );
        let stand = "factory/stands/SPS-2/0017/stand.yaml";
        place.copy("passports/SPS-2/0017/stand.yaml", stand);
        // No two stands have the same deviations.
        let other = place.read(stand).replace("\"0017\"", "\"0018\"");
        let other = other.replace("C-2026-0142", "C-2026-0143").replace("12.4", "13.4");
        place.write("factory/stands/SPS-2/0018/stand.yaml", other);
        for site in ["moscow-bmstu", "torino-inrim"] {
            place.copy(&format!("sites/{site}.yaml"), &format!("factory/sites/{site}.yaml"));
        }
        place
    }

    /// The factory has handed over these passports as `d.zip`; returns the fingerprint of its key, too.
    pub fn with_delivery(passports: &str) -> (Self, String) {
        let place = Self::new();
        place.good(&format!("deliver {passports} -o d.zip --workspace factory"));
        let fingerprint = place.fingerprint("factory/factory.key.pub");
        (place, fingerprint)
    }

    pub fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn read(&self, name: impl AsRef<Path>) -> String {
        let path = self.path(name);
        fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    /// Writes a file, and makes the folders that it is in.
    pub fn write(&self, name: impl AsRef<Path>, bytes: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }

    /// Copies a file of the project.
    pub fn copy(&self, from: &str, to: &str) {
        self.write(to, fs::read(programs::project(from)).unwrap());
        if from == programs::KEY {
            programs::keep_secret(&self.path(to));
        }
    }

    /// Changes the first `old` in a file.
    pub fn change(&self, name: &str, old: &str, new: &str) {
        let text = self.read(name);
        assert!(text.contains(old), "{name} lacks {old}\n{text}");
        self.write(name, text.replacen(old, new, 1));
    }

    /// The names in a folder, in their order.
    pub fn names(&self, folder: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(folder)).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// The program in this folder. No browser prints here; what one prints is tested elsewhere.
    pub fn program(&self) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
        command.current_dir(&self.0).stdin(Stdio::null()).env("DTG_PASSPORT_BROWSER", "no-browser-of-this-name");
        command
    }

    pub fn run(&self, arguments: &str) -> Output {
        self.program().args(arguments.split_whitespace()).output().unwrap()
    }

    /// Exit code, standard output, standard error.
    pub fn said(&self, arguments: &str) -> (i32, String, String) {
        let output = self.run(arguments);
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
    }

    /// The result as JSON of a run that must end with `code`.
    pub fn json(&self, arguments: &str, code: i32) -> Value {
        let (found, stdout, said) = self.said(&format!("{arguments} --format json"));
        assert_eq!(found, code, "{arguments}\n{said}");
        serde_json::from_str(&stdout).unwrap()
    }

    /// Runs the program, which must succeed, and returns its results.
    pub fn good(&self, arguments: &str) -> String {
        let (code, stdout, said) = self.said(arguments);
        assert_eq!(code, 0, "{arguments}: {said}");
        stdout
    }

    /// Runs the program, which must refuse with exit code 1 and the `words`, and returns all that it said.
    pub fn refused(&self, arguments: &str, words: &str) -> String {
        self.ends(arguments, 1, words)
    }

    /// Runs the program, which must end with `code` and say the `words`, and returns all that it said.
    pub fn ends(&self, arguments: &str, code: i32, words: &str) -> String {
        let (found, stdout, said) = self.said(arguments);
        assert!(found == code && said.contains(words), "{arguments}: {found}, lacks {words}\n{stdout}{said}");
        said + &stdout
    }

    /// The fingerprint as OpenSSH tells it.
    pub fn fingerprint(&self, key: &str) -> String {
        let output = Command::new("ssh-keygen").arg("-lf").arg(self.path(key)).output().unwrap();
        String::from_utf8(output.stdout).unwrap().split(' ').nth(1).unwrap().to_owned()
    }

    /// Every file below the folder of the test, with its content.
    pub fn files(&self) -> BTreeMap<PathBuf, Vec<u8>> {
        fn add(folder: &Path, all: &mut BTreeMap<PathBuf, Vec<u8>>) {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                match path.is_dir() {
                    true => add(&path, all),
                    false => drop(all.insert(path.clone(), fs::read(&path).unwrap_or_default())),
                }
            }
        }
        let mut all = BTreeMap::new();
        add(self.0.path(), &mut all);
        all
    }
}

/// A file of the project.
pub fn example(name: &str) -> String {
    fs::read_to_string(programs::project(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}
