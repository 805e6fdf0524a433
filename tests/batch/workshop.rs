//! A factory's folder with as many stands and sites as a test wants, the program run in it, and what must hold after.

use crate::programs;
use dtg_passport::jiff::Timestamp;
use dtg_passport::passport::{Question, Trust, verify};
use dtg_passport::register::{State, VerifiedRegister};
use dtg_passport::trust::AllowedSigners;
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// Who signs, and when.
pub const SIGN: &str = "--key key --identity factory --issued-at 2026-11-03";

/// Files of passports, each with its id and SHA-256.
pub type Passports = BTreeMap<PathBuf, (String, String)>;

pub struct Workshop(tempfile::TempDir);

impl Workshop {
    /// So many stands in `stands/`, so many sites in `sites/`, the published test key and who trusts it.
    pub fn new(stands: usize, sites: usize) -> Self {
        let workshop = Self(tempfile::tempdir().unwrap());
        for name in ["stand.yaml", "allowed_signers"] {
            fs::copy(programs::project("tests/cmd/files").join(name), workshop.path(name)).unwrap();
        }
        fs::copy(programs::project(programs::KEY), workshop.path("key")).unwrap();
        programs::keep_secret(&workshop.path("key"));
        let stand = fs::read_to_string(workshop.path("stand.yaml")).unwrap();
        for number in 0..stands {
            let text = stand.replace("\"0017\"", &format!("\"{number:04}\""));
            workshop.write(format!("stands/{number:04}/stand.yaml"), &text);
        }
        fs::create_dir(workshop.path("sites")).unwrap();
        for number in 0..sites {
            workshop.write(format!("sites/site-{number:05}.yaml"), &site(&format!("site-{number:05}"), number));
        }
        workshop
    }

    pub fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn read(&self, name: impl AsRef<Path>) -> String {
        let path = self.path(name);
        fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    /// Every file below a folder, with its bytes.
    pub fn snapshot(&self, folder: &str) -> BTreeSet<(PathBuf, Vec<u8>)> {
        let root = self.path(folder);
        assert!(root.is_dir(), "{}", root.display());
        files_under(&root).into_iter().map(|path| (path.clone(), fs::read(path).unwrap())).collect()
    }

    /// The passports below a folder, without the registers, of which each run makes a new one.
    pub fn snapshot_of_passports(&self, folder: &str) -> BTreeSet<(PathBuf, Vec<u8>)> {
        let mut files = self.snapshot(folder);
        files.retain(|(path, _)| is_named_as_a_passport(path));
        files
    }

    /// A file with this text, and the folders that it stands in.
    pub fn write(&self, name: impl AsRef<Path>, text: &str) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    /// The program in the workshop. Where an argument holds blanks, push it by hand.
    pub fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
        command.args(arguments.split(' ')).current_dir(self.0.path()).stdin(Stdio::null());
        command
    }

    /// The same, run to its end; `code` is the exit code that it must have.
    pub fn run(&self, arguments: &str, code: i32) -> Said {
        Said::of(self.command(arguments).output().unwrap(), code)
    }

    /// Several runs at once; each must end with exit code 0.
    pub fn together(&self, runs: impl IntoIterator<Item = String>) -> Vec<Said> {
        let spawn =
            |arguments: String| self.command(&arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let children: Vec<_> = runs.into_iter().map(spawn).collect();
        children.into_iter().map(|child| Said::of(child.wait_with_output().unwrap(), 0)).collect()
    }

    /// A script of `sh` in the workshop; the program is `$DTG`.
    pub fn shell(&self, script: &str) -> Command {
        let mut command = programs::on_path("sh");
        command.args(["-c", script]).current_dir(self.0.path()).stdin(Stdio::null());
        command.env("DTG", env!("CARGO_BIN_EXE_dtg-passport"));
        command
    }

    /// The ids of the passports under a folder. Every one verifies and is where it belongs.
    pub fn sound(&self, folder: &str) -> BTreeSet<String> {
        self.sound_beside(folder, &BTreeMap::new()).into_values().map(|(id, _)| id).collect()
    }

    /// The passports under a folder, each with its id and SHA-256; those that are known and have not changed are not
    /// verified once more.
    pub fn sound_beside(&self, folder: &str, known: &Passports) -> Passports {
        let root = self.path(folder);
        if !root.exists() {
            return BTreeMap::new();
        }
        let trust = self.trust();
        let question = Question::at("2027-01-01T00:00:00Z".parse().unwrap());
        let verified = |path: &PathBuf| {
            let bytes = fs::read(path).unwrap();
            let hash = format!("{:x}", Sha256::digest(&bytes));
            if let Some((id, _)) = known.get(path).filter(|(_, known)| *known == hash) {
                return (path.clone(), (id.clone(), hash));
            }
            let name = path.display().to_string();
            let verification = verify(&name, &bytes, &trust, &question);
            assert!(verification.valid(), "{name}: {:?}", verification.checks());
            let id = verification.id_from_anyone().unwrap().to_owned();
            let (place, revision) = id.rsplit_once('/').unwrap();
            assert_eq!(*path, root.join(format!("{place}-{revision}.yaml")));
            (path.clone(), (id, hash))
        };
        let mut passports = files_under(&root);
        passports.retain(|path| is_named_as_a_passport(path));
        let quarter = passports.len().div_ceil(4).max(1);
        std::thread::scope(|scope| {
            let verify_all = |files: &[PathBuf]| files.iter().map(verified).collect::<Vec<_>>();
            let parts: Vec<_> = passports.chunks(quarter).map(|files| scope.spawn(move || verify_all(files))).collect();
            parts.into_iter().flat_map(|part| part.join().unwrap()).collect()
        })
    }

    fn trust(&self) -> Trust {
        let signers = fs::read(self.path("allowed_signers")).unwrap();
        Trust::of(AllowedSigners::parse("allowed_signers", &signers).unwrap())
    }

    /// The passports in the registers under a folder, with their states. Every register verifies, and the file of every
    /// listed passport is there, whole.
    pub fn listed(&self, folder: &str) -> BTreeMap<String, State> {
        let root = self.path(folder);
        let mut states = BTreeMap::new();
        for path in files_under(&root).into_iter().filter(|path| path.ends_with("register.yaml")) {
            let name = path.display().to_string();
            let register = VerifiedRegister::verify(&name, &fs::read(&path).unwrap(), &self.trust(), Timestamp::now());
            for entry in register.unwrap_or_else(|why| panic!("{name}: {why}")).entries() {
                let (place, revision) = entry.id.rsplit_once('/').unwrap();
                let bytes = fs::read(root.join(format!("{place}-{revision}.yaml")));
                let hash = bytes.map(|bytes| format!("{:x}", Sha256::digest(&bytes))).ok();
                assert_eq!(hash.as_ref(), Some(&entry.sha256), "{} is listed, and its file is lost or torn", entry.id);
                states.insert(entry.id.clone(), entry.state);
            }
        }
        states
    }

    /// Temporary files anywhere under a folder.
    pub fn leftovers(&self, folder: &str) -> Vec<PathBuf> {
        let mut files = files_under(&self.path(folder));
        files.retain(|path| path.extension().is_some_and(|extension| extension == "tmp"));
        files
    }
}

/// Files at any depth, as far as their folders can be read; links are not followed.
fn files_under(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten() {
            let entry = entry.unwrap();
            let kind = entry.file_type().unwrap();
            if kind.is_dir() {
                folders.push(entry.path());
            } else {
                files.push(entry.path());
            }
        }
    }
    files
}

/// Whether a file is named `<site>-<revision>.yaml`.
fn is_named_as_a_passport(path: &Path) -> bool {
    let name = path.file_name().unwrap().to_string_lossy();
    let parts = name.strip_suffix(".yaml").and_then(|name| name.rsplit_once('-'));
    parts.is_some_and(|(_, revision)| revision.parse::<u32>().is_ok())
}

/// A site of its own place.
pub fn site(id: &str, number: usize) -> String {
    let here = include_str!("../cmd/files/sites/here.yaml");
    let latitude = format!("{}.{:04}", 1 + number / 1000 % 80, 10 * (number % 1000));
    // The mark is 10 m north of the pillar.
    let mark = format!("{latitude}9");
    here.replace("\"here\"", &format!("\"{id}\"")).replace("55.7658", &latitude).replace("55.776", &mark)
}

/// What a run of the program said.
pub struct Said {
    pub results: String,
    pub words: String,
}

impl Said {
    pub fn of(output: Output, code: i32) -> Self {
        let [results, words] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
        assert_eq!(output.status.code(), Some(code), "{words}");
        Self { results, words }
    }

    /// Fails unless these words were said.
    #[track_caller]
    pub fn says(&self, words: &str) {
        assert!(self.words.contains(words), "lacks {words}\n{}", self.words);
    }

    /// The ids in some state, by the lines of `--format csv`.
    pub fn ids(&self, state: &str) -> BTreeSet<String> {
        let rows = self.results.lines().map(|line| line.split(',').collect::<Vec<_>>());
        rows.filter(|cells| cells[0] == state).map(|cells| cells[1].to_owned()).collect()
    }
}
