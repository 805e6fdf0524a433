//! What a terminal gets and a pipe does not: emphasis, and never where NO_COLOR is set. The terminal is a real one, of
//! util-linux's `script`.

use std::process::Command;

const SHOW: [&str; 4] = ["show", "passports/SPS-2/0017/moscow-bmstu-1.yaml", "--trust", "docs/allowed_signers"];
const ESCAPE: u8 = 0x1b;

fn program() -> &'static str {
    env!("CARGO_BIN_EXE_dtg-passport")
}

fn in_a_terminal(no_color: Option<&str>) -> Vec<u8> {
    let mut script = Command::new("script");
    script.args(["--quiet", "--return", "--command", &format!("'{}' {}", program(), SHOW.join(" ")), "/dev/null"]);
    script.env("TERM", "xterm-256color").env_remove("NO_COLOR").env_remove("CLICOLOR").env_remove("CLICOLOR_FORCE");
    if let Some(value) = no_color {
        script.env("NO_COLOR", value);
    }
    let output = script.output().expect("`script` of util-linux runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

#[test]
fn a_terminal_gets_emphasis_and_a_pipe_none() {
    assert!(in_a_terminal(None).contains(&ESCAPE));
    let piped = Command::new(program()).args(SHOW).env_remove("CLICOLOR_FORCE").output().expect("the program runs");
    assert!(piped.status.success() && !piped.stdout.contains(&ESCAPE));
}

#[test]
fn no_color_is_obeyed() {
    assert!(!in_a_terminal(Some("1")).contains(&ESCAPE));
}

#[test]
fn no_line_is_wider_than_100_columns() {
    let piped = Command::new(program()).args(SHOW).output().expect("the program runs");
    let text = String::from_utf8(piped.stdout).expect("UTF-8");
    let widest = text.lines().map(|line| line.chars().count()).max();
    assert!(widest.is_some_and(|columns| (60..=100).contains(&columns)), "{widest:?}");
}
