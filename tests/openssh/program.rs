//! The program signs with what OpenSSH holds: a key in ssh-agent, a token, an encrypted key file.

use crate::agent::Agent;
use crate::token::provider;
use crate::{Bench, Finished};
use dtg_passport::trust::PublicKey;
use std::path::Path;
use std::process::Command;

/// `issue` with a key, in an environment, then `verify` with its public half.
fn issue(bench: &Bench, key: &str, environment: &[(&str, &Path)]) -> Finished {
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut program = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
    program.arg("issue").arg(project.join("passports/SPS-2/0017/stand.yaml"));
    program.arg("--site").arg(project.join("sites/braunschweig-ptb.yaml"));
    program.args(["--key", key, "--identity", "factory", "--issued-at", "2026-11-09T09:00:00Z", "--out", "out"]);
    program.env_remove("SSH_AUTH_SOCK").envs(environment.iter().copied());
    bench.run(&mut program, b"")
}

fn assert_issued(bench: &Bench, issued: &Finished) {
    assert!(issued.good && issued.output.starts_with("issued"), "{}{}", issued.output, issued.errors);
    let key = PublicKey::from_openssh(&bench.read("key.pub")).unwrap();
    bench.write("signers", format!("factory {}\n", key.to_openssh()));
    let mut program = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
    program.args(["verify", "out/SPS-2/0017/braunschweig-ptb-1.yaml", "--trust", "signers", "--time", "2026-12-01"]);
    let verified = bench.run(&mut program, b"");
    assert!(verified.good && verified.output.starts_with("VALID"), "{}{}", verified.output, verified.errors);
}

#[test]
fn a_key_in_the_agent_signs_a_passport() {
    let bench = Bench::new();
    bench.new_key("key");
    let agent = Agent::start(&bench);
    let added = bench.run(Command::new("ssh-add").env("SSH_AUTH_SOCK", &agent.socket).args(["-q", "key"]), b"");
    assert!(added.good, "{}", added.errors);
    std::fs::remove_file(bench.path("key")).unwrap();
    assert_issued(&bench, &issue(&bench, "key.pub", &[("SSH_AUTH_SOCK", &agent.socket)]));
}

#[test]
fn an_agent_that_is_not_there_is_said_and_nothing_is_written() {
    let bench = Bench::new();
    bench.new_key("key");
    std::fs::remove_file(bench.path("key")).unwrap();
    let issued = issue(&bench, "key.pub", &[]);
    assert!(!issued.good && issued.errors.contains("is ssh-agent running with this key"), "{}", issued.errors);
    assert!(!bench.path("out").exists());
}

#[test]
fn a_token_signs_a_passport_by_its_handle_file() {
    let bench = Bench::new();
    let mut keygen = Command::new("ssh-keygen");
    keygen.env("SSH_SK_PROVIDER", provider()).args(["-q", "-t", "ed25519-sk", "-N", "", "-C", "token", "-f", "key"]);
    let made = bench.run(&mut keygen, b"");
    assert!(made.good, "{}{}", made.output, made.errors);
    assert_issued(&bench, &issue(&bench, "key", &[("SSH_SK_PROVIDER", provider())]));
}

#[test]
fn an_encrypted_key_of_openssh_signs_with_its_passphrase() {
    let bench = Bench::new();
    let made = bench.keygen(&["-q", "-t", "ed25519", "-N", "correct horse", "-C", "factory", "-f", "key"]);
    assert!(made.good, "{}", made.errors);
    let wrong = issue(&bench, "key", &[("DTG_PASSPORT_PASSPHRASE", Path::new("wrong horse"))]);
    assert!(!wrong.good && wrong.errors.contains("passphrase"), "{}", wrong.errors);
    assert_issued(&bench, &issue(&bench, "key", &[("DTG_PASSPORT_PASSPHRASE", Path::new("correct horse"))]));
}
