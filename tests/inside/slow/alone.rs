//! Tests that count memory: it is counted for the whole process, so each runs in one of its own.

use std::process::Command;

/// Set in the process of a test that runs alone.
const ALONE: &str = "DTG_PASSPORT_TEST_ALONE";

/// Runs a test in a process of its own. Its name is that of the module (`module_path!()`) and of the function.
pub fn alone(module: &str, function: &str, test: impl FnOnce()) {
    if std::env::var_os(ALONE).is_some() {
        return test();
    }
    let (_, module) = module.split_once("::").expect("the crate's name and the module's");
    let mut command = Command::new(std::env::current_exe().expect("the tests' own file"));
    command.args([&format!("{module}::{function}"), "--exact", "--include-ignored", "--nocapture"]).env(ALONE, "1");
    let output = command.output().expect("the tests' own program runs");
    let [said, errors] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    print!("{said}");
    // A name that is no test's passes none.
    assert!(output.status.success() && said.contains(" 1 passed;"), "{said}\n{errors}");
}
