//! What must be typed for the jobs of a factory: with every option spelt out, and in a workspace. Both ways are really
//! gone, and lead to passports with the same contents.

use crate::programs;
use serde_json::Value;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// What follows every command that signs or verifies, if there is no workspace.
const SIGN: &str = "--key factory.key --identity factory@example.org --trust allowed_signers";

/// One way of doing the jobs, in a folder of its own.
struct Way {
    folder: tempfile::TempDir,
    workspace: bool,
    typed: usize,
    files: usize,
}

impl Way {
    fn new(workspace: bool) -> Self {
        Self { folder: tempfile::tempdir().unwrap(), workspace, typed: 0, files: 0 }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Runs a command, whose characters do not count.
    fn run(&self, command: &str) -> String {
        let built = PathBuf::from(env!("CARGO_BIN_EXE_dtg-passport")).parent().unwrap().to_owned();
        let path = std::env::join_paths([built, "/usr/bin".into(), "/bin".into()]).unwrap();
        let mut shell = Command::new("sh");
        shell.args(["-c", command]).current_dir(&self.folder).env_clear().env("PATH", path).stdin(Stdio::null());
        // A shell of one command does not keep what `export` says.
        if self.workspace && self.path("dtg-passport.toml").exists() {
            shell.env("DTG_PASSPORT_WORKSPACE", ".");
        }
        let output = shell.output().unwrap();
        assert!(output.status.success(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    }

    /// Types a command and the key that ends the line.
    fn types(&mut self, command: &str) {
        self.typed += command.chars().count() + 1;
        self.run(command);
    }

    /// Types values in place of others in a file, which counts as one.
    fn fills_in(&mut self, file: &str, values: &[(&str, &str)]) {
        let mut text = fs::read_to_string(self.path(file)).unwrap();
        for (old, new) in values {
            assert!(text.contains(old), "{file}: {old}");
            text = text.replacen(old, new, 1);
            self.typed += new.chars().count();
        }
        fs::write(self.path(file), text).unwrap();
        self.files += 1;
    }

    /// Returns what was typed since the last time: characters and files.
    fn counted(&mut self) -> (usize, usize) {
        (std::mem::take(&mut self.typed), std::mem::take(&mut self.files))
    }

    /// A file from an instrument, or one that was there before.
    fn gets(&self, from: &str, name: &str) {
        fs::create_dir_all(self.path(name).parent().unwrap()).unwrap();
        fs::copy(programs::project(from), self.path(name)).unwrap();
    }

    fn first_passport(&mut self) {
        self.gets("docs/angles.csv", "readings/0017.csv");
        if self.workspace {
            self.types("dtg-passport init . --identity factory@example.org");
            self.types("export DTG_PASSPORT_WORKSPACE=$PWD");
        }
        let key = "dtg-passport keygen factory.key --identity factory@example.org --allowed-signers allowed_signers";
        self.types(&format!("{key} --no-passphrase"));
        self.types("dtg-passport new header header.yaml");
        let header = [
            ("\"CHANGE\"", "\"Example Stand Works\""),
            ("\"CHANGE\"", "\"SPS-2\""),
            ("\"CHANGE\"", "\"0017\""),
            ("\"CHANGE\"", "\"C-2026-0142\""),
            ("\"CHANGE\"", "\"2026-11-02\""),
            ("\"CHANGE\"", "\"Angle laboratory\""),
            ("CHANGE: instruments, set-up, number of runs", "two autocollimators, five runs"),
            ("CHANGE: certificates of the instruments", "A-17, A-18"),
            ("CHANGE: surface that is levelled", "base plate"),
            ("CHANGE: surface or mirror that faces north", "mirror M1"),
            ("CHANGE: surface and pins that locate the gyro", "face P, pins 1, 2"),
        ];
        self.fills_in("header.yaml", &header);
        self.types("dtg-passport new site sites/riga.yaml --at 56.9496,24.1052 --height-m 30");
        self.fills_in("sites/riga.yaml", &[("CHANGE: where the numbers come from", "GNSS, 2026-10-30")]);
        self.types("dtg-passport certify readings/0017.csv --stand header.yaml -o stands/SPS-2/0017/stand.yaml");
        match self.workspace {
            true => self.types("dtg-passport issue SPS-2/0017 --site riga"),
            false => self.types(&format!(
                "dtg-passport issue stands/SPS-2/0017/stand.yaml --site sites/riga.yaml --out passports {SIGN}"
            )),
        }
    }

    fn second_site(&mut self) {
        self.types("dtg-passport new site sites/oslo.yaml --at 59.9139,10.7522 --height-m 60");
        self.fills_in("sites/oslo.yaml", &[("CHANGE: where the numbers come from", "GNSS, 2026-11-03")]);
        match self.workspace {
            true => self.types("dtg-passport issue SPS-2/0017 --site oslo"),
            false => self.types(&format!(
                "dtg-passport issue stands/SPS-2/0017/stand.yaml --site sites/oslo.yaml --out passports {SIGN}"
            )),
        }
    }

    /// Three more places, which are not typed: five in force.
    fn three_more(&self) {
        for site in ["beijing-nim", "singapore-nus", "teddington-npl"] {
            self.gets(&format!("sites/{site}.yaml"), &format!("sites/{site}.yaml"));
            let stand = "stands/SPS-2/0017/stand.yaml";
            self.run(&format!("dtg-passport issue {stand} --site sites/{site}.yaml --out passports {SIGN}"));
        }
    }

    fn recertification(&mut self) {
        let old = fs::read_to_string(programs::project("docs/angles.csv")).unwrap();
        // Two of the runs: the same readings are refused, and so are those that hardly differ from them.
        let first_two = |line: &&str| line.starts_with(['#', 'i']) || matches!(line.split(',').nth(2), Some("1" | "2"));
        let new = old.lines().filter(first_two).map(|line| format!("{line}\n"));
        fs::write(self.path("readings/0017-2.csv"), new.collect::<String>()).unwrap();
        if self.workspace {
            self.types(
                "dtg-passport recertify SPS-2/0017/riga/1 readings/0017-2.csv --number C-2026-0300 --issued 2026-11-20 \
                 --reason recertified",
            );
            return;
        }
        self.types("dtg-passport certify readings/0017-2.csv --against stands/SPS-2/0017/stand.yaml");
        let values = [("\"C-2026-0142\"", "\"C-2026-0300\""), ("\"2026-11-02\"", "\"2026-11-20\"")];
        self.fills_in("header.yaml", &values);
        let stand = "stands/SPS-2/0017/stand.yaml";
        self.types(&format!("dtg-passport certify readings/0017-2.csv --stand header.yaml -o {stand} --force"));
        for site in ["riga", "oslo", "beijing-nim", "singapore-nus", "teddington-npl"] {
            let passport = format!("passports/SPS-2/0017/{site}-1.yaml");
            self.types(&format!("dtg-passport reissue {passport} --stand {stand} --reason recertified {SIGN}"));
        }
    }

    fn withdrawal(&mut self) {
        match self.workspace {
            true => self.types("dtg-passport revoke SPS-2/0017/oslo/2 --reason 'wrong building'"),
            false => self.types(&format!(
                "dtg-passport revoke SPS-2/0017/oslo/2 --passports passports --reason 'wrong building' {SIGN}"
            )),
        }
    }

    /// The signed contents of all passports in the order of their names, without times and what depends on them, and
    /// their states.
    fn signed(&self) -> (Vec<Value>, Vec<String>) {
        let trust = "--trust allowed_signers";
        // In a workspace `show` refuses what is superseded or withdrawn; `register` verifies all.
        let shown = self.run("dtg-passport show passports --format json --no-verify");
        let contents = shown.lines().map(|line| {
            let mut content: Value = serde_json::from_str(line).unwrap();
            // What the verification found is of this file and this moment.
            for key in ["sha256", "checks"] {
                content.as_object_mut().unwrap().remove(key).unwrap();
            }
            let passport = content["passport"].as_object_mut().unwrap();
            passport.remove("issued_at").unwrap();
            if let Some(from) = passport.get_mut("reissued_from") {
                from.as_object_mut().unwrap().remove("sha256").unwrap();
            }
            content
        });
        let register: Value =
            serde_json::from_str(&self.run(&format!("dtg-passport register passports {trust} --format json"))).unwrap();
        let lines = register["stands"][0]["rows"].as_array().unwrap().iter();
        let states = lines.map(|line| format!("{} {}", line["id"].as_str().unwrap(), line["state"].as_str().unwrap()));
        // The two ways issue in another order.
        let mut states: Vec<String> = states.collect();
        states.sort();
        (contents.collect(), states)
    }
}

/// Expected: the table of docs/development/figures.md.
#[test]
fn a_workspace_saves_what_the_page_says() {
    let mut ways = [Way::new(false), Way::new(true)];
    type Job = fn(&mut Way);
    let jobs: [(&str, Job); 4] = [
        ("first passport from nothing", Way::first_passport),
        ("a second site", Way::second_site),
        ("recertification with five sites in force", Way::recertification),
        ("withdrawal", Way::withdrawal),
    ];
    let page = fs::read_to_string(programs::project("docs/development/figures.md")).unwrap();
    let mut missing = String::new();
    for (name, job) in jobs {
        let counted = ways.each_mut().map(|way| {
            if name.starts_with("recertification") {
                way.three_more();
            }
            job(way);
            way.counted()
        });
        let [(spelt_out, files), (short, short_files)] = counted;
        let row = format!("| {name} | {spelt_out}, {files} | {short}, {short_files} |\n");
        if !page.contains(&row) {
            missing += &row;
        }
        let [(contents, states), (same_contents, same_states)] = ways.each_ref().map(Way::signed);
        assert!(!contents.is_empty() && contents == same_contents, "{name}: other contents");
        assert_eq!(states, same_states, "{name}");
    }
    let in_force = ways[1].signed().1.iter().filter(|state| state.ends_with(" current")).count();
    assert_eq!(in_force, 4, "five places, one of them withdrawn");
    assert!(missing.is_empty(), "docs/development/figures.md lacks\n{missing}");
}
