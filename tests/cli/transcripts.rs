//! The command line as transcripts: `tests/cmd/*.md` show what is typed and what comes back, to the letter.
//!
//! In a fenced block `console` a line `$ …` is typed into `sh`, and below it stand the lines that come back: standard
//! output first, then standard error with `! ` before each line, then `? 2` when the exit code is 2 instead of 0.
//! Every heading begins in a fresh folder with the files of `tests/cmd/files` and the published test key. SHA-256,
//! the program's version, and times of the run itself are shown as `[sha256]`, `[version]` and `[now]`. What the verbs
//! with a schema print, or would print, as JSON is compared with it.
//!
//! `TRANSCRIPTS=write cargo test --test cli transcripts` writes what comes back into the transcripts: read the difference.
//!
//! `tests/windows/run` plays them with the program for Windows, which `DTG_PASSPORT_FOLDER` then names by the folder of
//! a `dtg-passport` that starts it. What comes back may differ in `\` for `/`, and under the headings that
//! `tests/windows/differences.md` lists with the reason.

use crate::programs;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A test for each transcript, so that they run side by side and have names; and one that none is left out.
macro_rules! transcripts {
    ($($test:ident: $file:literal,)*) => {
        $(
            #[test]
            fn $test() {
                is_what_comes_back($file);
            }
        )*

        #[test]
        fn every_transcript_has_a_test() {
            let mut files: Vec<String> = fs::read_dir(programs::project("tests/cmd"))
                .unwrap()
                .map(|entry| entry.unwrap().file_name().into_string().unwrap())
                .filter(|name| name.ends_with(".md"))
                .collect();
            files.sort();
            assert_eq!(files, [$($file),*]);
        }
    };
}

transcripts! {
    bad_files: "bad-files.md",
    bad_input: "bad-input.md",
    batch: "batch.md",
    calibrate: "calibrate.md",
    dcc: "dcc.md",
    demo: "demo.md",
    good: "good.md",
    hostile_folder: "hostile-folder.md",
    json_refusals: "json-refusals.md",
    keys: "keys.md",
    mistakes: "mistakes.md",
    near_the_pole: "near-the-pole.md",
    plan: "plan.md",
    register: "register.md",
    render: "render.md",
    report: "report.md",
    revisions: "revisions.md",
    russian: "russian.md",
    several: "several.md",
    templates: "templates.md",
    trust: "trust.md",
    uncertainty: "uncertainty.md",
    workspace: "workspace.md",
    years: "years.md",
}

/// Fails with the first line of a transcript that differs from what comes back.
fn is_what_comes_back(file: &str) {
    let path = programs::project("tests/cmd").join(file);
    let told = fs::read_to_string(&path).unwrap();
    if let Some(folder) = std::env::var_os(FOLDER) {
        return compare_for_windows(file, &told, folder.as_ref());
    }
    let recorder = recorder();
    let played = play(&told, recorder.path());
    results_fit_their_schemas(file, recorder.path());
    if played == told {
        return;
    }
    if std::env::var("TRANSCRIPTS").is_ok_and(|wish| wish == "write") {
        fs::write(path, played).unwrap();
        return;
    }
    let end = "(the end)";
    let pairs = told.lines().chain([end]).zip(played.lines().chain([end]));
    let different = (1..).zip(pairs).find(|(_, (told, played))| told != played);
    let (number, (told, played)) = different.expect("a line that differs, or the end of one of the two");
    panic!("{}:{number}\n  told:   {told}\n  played: {played}", path.display());
}

/// Variable with the folder of the program, where it is not the one that cargo built.
const FOLDER: &str = "DTG_PASSPORT_FOLDER";

/// Number of times that a transcript is played under Wine. About one start in two hundred loses its connection to Wine's
/// server and ends early; what is wrong with the program differs every time.
const PLAYS: usize = 4;

/// Fails unless exactly those headings differ, each time that they are played, that `tests/windows/differences.md` lists.
fn compare_for_windows(file: &str, told: &str, program: &Path) {
    let differences = fs::read_to_string(programs::project("tests/windows/differences.md")).unwrap();
    let due = parts_for_windows(told);
    let mut unequal: Vec<usize> = (0..due.len()).collect();
    let mut words = String::new();
    for _ in 0..PLAYS {
        let played = parts_for_windows(&play(told, program));
        unequal.retain(|&place| played[place] != due[place]);
        let listed = |place: &usize| differences.contains(&format!("| `{file}#{}` |", due[*place].0));
        words.clear();
        for place in unequal.iter().copied().filter(|place| !listed(place)) {
            let lines = due[place].1.lines().zip(played[place].1.lines()).filter(|(told, played)| told != played);
            let lines: String = lines.map(|(told, played)| format!("  told:   {told}\n  played: {played}\n")).collect();
            words += &format!("{file}#{}: differs\n{lines}", due[place].0);
        }
        for place in (0..due.len()).filter(|place| listed(place) && !unequal.contains(place)) {
            words += &format!("{file}#{}: listed, but equal\n", due[place].0);
        }
        if words.is_empty() {
            break;
        }
    }
    let headings = due.len() - 1; // The first part is what precedes them.
    println!("{file}: {} of {headings} headings equal", headings - unequal.len());
    assert!(words.is_empty(), "{words}");
}

/// Returns the headings of a transcript, each with what is below it, without what Windows alone says.
fn parts_for_windows(text: &str) -> Vec<(String, String)> {
    let text = text.replace(r"\\", "/").replace('\\', "/");
    let mut parts = vec![(String::new(), String::new())];
    let mut in_block = false;
    let of_keygen = |line: &str| line.contains("Windows protects the private key only by");
    let of_wine = |line: &str| line.trim_start_matches("! ").starts_with("wine client error:");
    for line in text.lines().filter(|line| !of_keygen(line) && !of_wine(line)) {
        in_block ^= line.starts_with("```");
        if !in_block && line.starts_with('#') {
            parts.push((line.trim_start_matches(['#', ' ']).to_owned(), String::new()));
        }
        let (_, part) = parts.last_mut().unwrap();
        *part += &format!("{line}\n");
    }
    parts
}

/// The transcript with what comes back now.
fn play(told: &str, program: &Path) -> String {
    let mut stage = Stage::new(program);
    let mut played = String::new();
    let mut in_console = false;
    for line in told.lines() {
        if line.starts_with("```") {
            in_console = line == "```console";
        } else if !in_console && line.starts_with('#') {
            stage = Stage::new(program);
        }
        match line.strip_prefix("$ ").filter(|_| in_console) {
            Some(command) => played += &format!("{line}\n{}", stage.run(command)),
            // What came back when this was written is played anew.
            None if in_console && line != "```console" => {}
            None => played += &format!("{line}\n"),
        }
    }
    played
}

/// A fresh folder.
struct Stage {
    folder: tempfile::TempDir,
    /// Folder of the program.
    program: PathBuf,
    /// Time at which the heading began, as RFC 3339.
    begun: String,
}

impl Stage {
    fn new(program: &Path) -> Self {
        let folder = tempfile::tempdir().unwrap();
        programs::output(
            programs::on_path("cp").arg("-r").arg(programs::project("tests/cmd/files/.")).arg(folder.path()),
        );
        let key = folder.path().join("key");
        fs::copy(programs::project(programs::KEY), &key).unwrap();
        fs::copy(programs::project("tests/keys/examples.pub"), folder.path().join("key.pub")).unwrap();
        programs::keep_secret(&key);
        Self { folder, program: program.to_owned(), begun: now() }
    }

    fn run(&self, command: &str) -> String {
        let own = programs::project("tests/cmd/bin");
        let path = std::env::join_paths([&self.program, &own, Path::new("/usr/bin"), Path::new("/bin")]).unwrap();
        let output = Command::new("sh")
            .args(["-c", command])
            .current_dir(self.folder.path())
            .env_clear()
            .envs([("PATH", path), ("LC_ALL", "C.UTF-8".into())])
            .stdin(Stdio::null())
            .output()
            .unwrap();
        let mut back = String::new();
        for line in String::from_utf8_lossy(&output.stdout).lines() {
            back += &format!("{line}\n");
        }
        for line in String::from_utf8_lossy(&output.stderr).lines() {
            back += &format!("! {line}\n");
        }
        match output.status.code() {
            Some(0) => {}
            Some(code) => back += &format!("? {code}\n"),
            None => back += &format!("? {}\n", output.status),
        }
        self.lasting(&back)
    }

    /// Without what differs from run to run and from release to release.
    fn lasting(&self, back: &str) -> String {
        let version = format!("dtg-passport {}", env!("CARGO_PKG_VERSION"));
        let folder = self.folder.path().display().to_string();
        let text = back.replace(&version, "dtg-passport [version]").replace(&folder, "[folder]");
        let mut lasting = String::new();
        let mut digits = String::new();
        for c in text.chars().chain(['\n']) {
            if c.is_ascii_digit() || ('a'..='f').contains(&c) {
                digits.push(c);
                continue;
            }
            let is_sha256 = digits.len() == 64 || (digits.len() == 16 && c == '…');
            lasting += if is_sha256 { "[sha256]" } else { &digits };
            digits.clear();
            lasting.push(c);
        }
        lasting.pop();
        // Registers are dated by the clock.
        let ended = now();
        let of_run = |start: usize| {
            lasting.get(start..start + ended.len()).filter(|time| (&*self.begun..=&*ended).contains(time))
        };
        let mut times: Vec<String> =
            lasting.match_indices(&ended[..2]).filter_map(|(start, _)| of_run(start)).map(str::to_owned).collect();
        times.dedup();
        times.iter().fold(lasting, |text, time| text.replace(time, "[now]"))
    }
}

/// A `dtg-passport` that starts the program, in a folder where it keeps what some verbs print as JSON. Commands may empty
/// the environment, so it has both paths.
fn recorder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let script = fs::read_to_string(programs::project("tests/cmd/bin/recorder")).unwrap();
    let records = folder.path().join("records");
    fs::create_dir(&records).unwrap();
    let paths = format!("PROGRAM='{}'\nRECORDS='{}'\n", env!("CARGO_BIN_EXE_dtg-passport"), records.display());
    let program = folder.path().join("dtg-passport");
    fs::write(&program, script.replacen('\n', &format!("\n{paths}"), 1)).unwrap();
    assert!(Command::new("chmod").arg("755").arg(program).status().unwrap().success());
    folder
}

/// Transcripts that surely have results of a verb.
const RECORDED: [(&str, &str); 6] = [
    ("good.md", "verify"),
    ("register.md", "register"),
    ("calibrate.md", "calibrate"),
    ("several.md", "certify"),
    ("plan.md", "plan"),
    ("years.md", "history"),
];

/// Fails unless every result that the recorder has kept fits the schema of its verb, which then leaves no key unsaid.
fn results_fit_their_schemas(file: &str, recorder: &Path) {
    let mut python = programs::python();
    python.arg(programs::project("tests/readers/results.py")).arg(programs::project("src/schema/results.json"));
    python.arg(recorder.join("records"));
    let counts: serde_json::Value = serde_json::from_str(&programs::output(python)).unwrap();
    println!("{file}: {counts}");
    for (_, verb) in RECORDED.iter().filter(|(transcript, _)| *transcript == file) {
        assert!(counts[verb].as_u64().is_some_and(|count| count > 0), "{file}: {counts}");
    }
}

/// Returns the time in UTC as RFC 3339, in whole seconds.
fn now() -> String {
    let output = Command::new("date").args(["-u", "+%FT%TZ"]).output().unwrap();
    String::from_utf8(output.stdout).unwrap().trim().to_owned()
}
