//! Tests that count memory: it is counted for the whole process, so each runs in one of its own.

use std::process::Command;

/// Set in the process of a test that runs alone.
const ALONE: &str = "DTG_PASSPORT_TEST_ALONE";

/// Runs a test, the closure that is all of a test function, in a process of its own.
pub fn alone<T: FnOnce()>(test: T) {
    if std::env::var_os(ALONE).is_some() {
        return test();
    }
    // The name of a closure begins with those of the crate and of the function.
    let name = std::any::type_name::<T>().strip_suffix("::{{closure}}").and_then(|name| name.split_once("::"));
    let (_, name) = name.expect("a closure in a function");
    let mut command = Command::new(std::env::current_exe().expect("the tests' own file"));
    command.args([name, "--exact", "--include-ignored", "--nocapture"]).env(ALONE, "1");
    let output = command.output().expect("the tests' own program runs");
    let [said, errors] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    print!("{said}");
    // A name that is no test's passes none.
    assert!(output.status.success() && said.contains(" 1 passed;"), "{said}\n{errors}");
}
