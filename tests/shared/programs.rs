//! Programs that the tests run, as the test command installed them. A missing program fails the test; nothing is
//! skipped.

// Every test crate uses its own part.
#![allow(dead_code)]

use std::borrow::BorrowMut;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Returns the path of a file of the project, given relative to its top folder.
pub fn project(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The published test key.
pub const KEY: &str = "tests/keys/examples";

/// Gives a file of a key the mode that Git does not keep; a private key that others can read is refused.
pub fn keep_secret(path: &Path) {
    assert!(Command::new("chmod").arg("600").arg(path).status().unwrap().success());
}

/// Returns the SHA-256 of a file, by coreutils.
pub fn sha256(file: &Path) -> String {
    output(Command::new("sha256sum").arg(file))[..64].to_owned()
}

/// Returns a text in one line: a message may be wrapped.
pub fn in_one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Returns Python with PyYAML (including its C loader), ruamel.yaml and NumPy.
pub fn python() -> Command {
    let mut command = Command::new(installed("target/test-tools/venv/bin/python"));
    // The folders of the project must not be filled with compiled files.
    command.env("PYTHONDONTWRITEBYTECODE", "1").env_remove("PYTHONPATH").env("PYTHONIOENCODING", "utf-8");
    command
}

/// Returns Node.js with js-yaml and yaml; `require` finds them from any folder.
pub fn node() -> Command {
    let mut command = on_path("node");
    command.env("NODE_PATH", installed("target/test-tools/node/node_modules"));
    command
}

/// Returns Node.js with playwright-core, axe-core and html-validate.
pub fn node_for_pages() -> Command {
    let mut command = on_path("node");
    command.env("NODE_PATH", installed("target/test-tools/page/node_modules"));
    command
}

/// Returns Ruby, which includes Psych.
pub fn ruby() -> Command {
    on_path("ruby")
}

/// Returns a program of the system.
pub fn on_path(program: &str) -> Command {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    match std::env::split_paths(&folders).map(|folder| folder.join(program)).find(|file| file.is_file()) {
        Some(file) => Command::new(file),
        None => panic!("{program} is missing: run tests/run"),
    }
}

fn installed(path: &str) -> PathBuf {
    // The stamp is written last. Without it the installation is incomplete.
    let finished = project("target/test-tools/stamp").is_file();
    let file = project(path);
    assert!(finished && file.exists(), "{path} is missing: run tests/run");
    file
}

/// Returns the output of the command. Any failure fails the test and prints the error output.
pub fn output(mut command: impl BorrowMut<Command>) -> String {
    let command: &mut Command = command.borrow_mut();
    let name = format!("{command:?}");
    let output = command.output().unwrap_or_else(|error| panic!("{name}: {error}"));
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{name}: {}\n{errors}", output.status);
    String::from_utf8(output.stdout).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Readings i, j, run, α, β, γ with other angles, each a function of its line, the number of this line, the number of its
/// column from 0, and what it was.
pub fn with_angles(readings: &str, angle: impl Fn(&str, u32, u32, f64) -> f64) -> String {
    let line = |(row, line): (u32, &str)| {
        let cells = (0..).zip(line.split(',')).map(|(column, cell)| match (column, cell.trim().parse()) {
            (3.., Ok(was)) => format!("{:.3}", angle(line, row, column, was)),
            _ => cell.to_owned(),
        });
        cells.collect::<Vec<_>>().join(",") + "\n"
    };
    (0..).zip(readings.lines()).map(line).collect()
}
