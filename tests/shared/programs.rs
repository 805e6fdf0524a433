//! The programs that the tests run, as the test command installed them. Nothing is skipped: what is missing fails.

// Every crate of tests uses its own part.
#![allow(dead_code)]

use std::path::{Path, PathBuf};
use std::process::Command;

/// A file of the project, by its path from the top.
pub fn project(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Python with PyYAML (its C loader too), ruamel.yaml and NumPy.
pub fn python() -> Command {
    let mut command = Command::new(installed("target/test-tools/venv/bin/python"));
    // The folders of the project are read, not filled with compiled files.
    command.env("PYTHONDONTWRITEBYTECODE", "1").env_remove("PYTHONPATH").env("PYTHONIOENCODING", "utf-8");
    command
}

/// Node.js with js-yaml and yaml; `require` finds them from any folder.
pub fn node() -> Command {
    let mut command = on_path("node");
    command.env("NODE_PATH", installed("target/test-tools/node/node_modules"));
    command
}

/// Node.js with playwright-core, axe-core and html-validate.
pub fn node_for_pages() -> Command {
    let mut command = on_path("node");
    command.env("NODE_PATH", installed("target/test-tools/page/node_modules"));
    command
}

/// Ruby, which brings Psych.
pub fn ruby() -> Command {
    on_path("ruby")
}

/// A program of the system.
pub fn on_path(program: &str) -> Command {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    match std::env::split_paths(&folders).map(|folder| folder.join(program)).find(|file| file.is_file()) {
        Some(file) => Command::new(file),
        None => panic!("{program} is missing: run tests/run"),
    }
}

fn installed(path: &str) -> PathBuf {
    // The stamp is written last: without it the installation was broken off.
    let finished = project("target/test-tools/stamp").is_file();
    let file = project(path);
    assert!(finished && file.exists(), "{path} is missing: run tests/run");
    file
}

/// What the command prints; anything but success fails the test with its words.
pub fn output(mut command: Command) -> String {
    let name = format!("{command:?}");
    let output = command.output().unwrap_or_else(|error| panic!("{name}: {error}"));
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{name}: {}\n{errors}", output.status);
    String::from_utf8(output.stdout).unwrap_or_else(|error| panic!("{name}: {error}"))
}
