//! The program signs with what OpenSSH holds: a key in ssh-agent, a token, an encrypted key file.

use crate::agent::Agent;
use crate::token::provider;
use crate::{Bench, Finished, SIGNATURE_LINE};
use dtg_passport::trust::PublicKey;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A folder of programs that stand before those of OpenSSH, and tell `told` how they are called and with what
/// environment; then the real ones do the work.
fn watched(bench: &Bench) -> PathBuf {
    let folder = bench.path("watched");
    std::fs::create_dir(&folder).unwrap();
    for program in ["ssh-keygen", "ssh-add"] {
        let told = bench.path("told");
        let script = format!(
            "#!/bin/sh\nPATH=/usr/local/bin:/usr/bin:/bin\n{{ echo \"called {program} $*\"; env; }} >>'{}'\nexec {program} \"$@\"\n",
            told.display()
        );
        let path = bench.write(&format!("watched/{program}"), script);
        assert!(Command::new("chmod").arg("755").arg(path).status().unwrap().success());
    }
    folder
}

/// How often a program was called to sign, of those that were watched.
fn signatures(bench: &Bench) -> usize {
    bench.read("told").lines().filter(|line| line.starts_with("called ssh-keygen -Y sign")).count()
}

/// `issue` with a key, in an environment; with the trust in `signers`, if there is that file.
fn issue(bench: &Bench, key: &str, environment: &[(&str, &Path)]) -> Finished {
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut program = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
    program.arg("issue").arg(project.join("passports/SPS-2/0017/stand.yaml"));
    program.arg("--site").arg(project.join("sites/braunschweig-ptb.yaml"));
    program.args(["--key", key, "--identity", "factory", "--issued-at", "2026-11-09T09:00:00Z", "--out", "out"]);
    if bench.path("signers").exists() {
        program.args(["--trust", "signers"]);
    }
    program.env_remove("SSH_AUTH_SOCK").envs(environment.iter().copied());
    bench.run(&mut program, b"")
}

/// Writes the trust in the key.
fn trust(bench: &Bench) {
    let key = PublicKey::from_openssh(&bench.read("key.pub")).unwrap();
    bench.write("signers", format!("factory {}\n", key.to_openssh()));
}

/// The passport was issued, and is current in its register, by the public half of the key.
fn assert_issued(bench: &Bench, issued: &Finished) {
    assert!(issued.good && issued.output.starts_with("● issued"), "{}{}", issued.output, issued.errors);
    trust(bench);
    let mut program = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
    program.args(["verify", "out/SPS-2/0017/braunschweig-ptb-1.yaml", "--trust", "signers", "--time", "2026-12-01"]);
    program.args(["--register", "out"]);
    let verified = bench.run(&mut program, b"");
    assert!(verified.good && verified.output.starts_with("◐ VALID SO FAR"), "{}{}", verified.output, verified.errors);
    // The real OpenSSH accepts the register too, and only as one.
    let register = bench.read("out/SPS-2/0017/register.yaml");
    let (payload, armor) = register.split_once(SIGNATURE_LINE).unwrap();
    bench.write("register.sig", armor.replace("  ", ""));
    for (namespace, good) in [("dtg-register", true), ("dtg-passport", false)] {
        let mut openssh = Command::new("ssh-keygen");
        openssh.args(["-Y", "verify", "-n", namespace, "-I", "factory", "-s", "register.sig", "-f", "signers"]);
        let verified = bench.run(&mut openssh, payload.as_bytes());
        assert_eq!(verified.good, good, "{namespace}: {}{}", verified.output, verified.errors);
    }
}

#[test]
fn a_token_signs_a_passport_by_its_handle_file() {
    let bench = Bench::new();
    bench.with_token(&["-q", "-t", "ed25519-sk", "-N", "", "-C", "token", "-f", "key"], b"");
    // The handle does not tell the public half, so what is written cannot be verified without trust.
    let issued = issue(&bench, "key", &[("SSH_SK_PROVIDER", provider())]);
    assert!(!issued.good && issued.errors.contains("specify --trust"), "{}", issued.errors);
    assert!(!bench.path("out").exists());
    trust(&bench);
    assert_issued(&bench, &issue(&bench, "key", &[("SSH_SK_PROVIDER", provider())]));
}

#[test]
fn no_program_that_is_started_inherits_the_passphrase() {
    let bench = Bench::new();
    bench.new_key("key");
    let agent = Agent::start(&bench);
    let added = bench.run(Command::new("ssh-add").env("SSH_AUTH_SOCK", &agent.socket).args(["-q", "key"]), b"");
    assert!(added.good, "{}", added.errors);
    std::fs::remove_file(bench.path("key")).unwrap();
    let (passphrase, path) = (Path::new("correct horse"), watched(&bench));
    let environment =
        [("SSH_AUTH_SOCK", agent.socket.as_path()), ("DTG_PASSPORT_PASSPHRASE", passphrase), ("PATH", &path)];
    assert_issued(&bench, &issue(&bench, "key.pub", &environment));
    // Of the passport, and of the register.
    assert_eq!(signatures(&bench), 2);
    let told = bench.read("told");
    assert!(told.contains("SSH_AUTH_SOCK=") && !told.contains("horse"), "{told}");
}

#[test]
fn of_a_public_key_the_private_half_beside_it_is_opened_once_for_a_whole_batch() {
    let bench = Bench::new();
    bench.made("key", &["-t", "ed25519", "-N", "correct horse", "-C", "factory"]);
    let path = watched(&bench);
    let environment = [("DTG_PASSPORT_PASSPHRASE", Path::new("correct horse")), ("PATH", &path)];
    assert_issued(&bench, &issue(&bench, "key.pub", &environment));
    // ssh-keygen would have asked for the passphrase at every passport.
    assert_eq!(signatures(&bench), 0);
}

#[test]
fn a_public_key_without_its_private_half_is_refused_before_anything_is_signed() {
    let bench = Bench::new();
    let (path, agent) = (watched(&bench), Agent::start(&bench));
    let environment = [("SSH_AUTH_SOCK", agent.socket.as_path()), ("PATH", &path)];
    for (name, key) in [("key", None), ("other", Some("other"))] {
        bench.new_key(name);
        std::fs::remove_file(bench.path(name)).unwrap();
        if let Some(key) = key {
            bench.write_key(key, &dtg_passport::trust::SigningKey::generate().unwrap().to_openssh("", None).unwrap());
        }
        let issued = issue(&bench, &format!("{name}.pub"), &environment);
        let words = if key.is_some() { "is not the private half of other.pub" } else { "found only the public half" };
        assert!(!issued.good && issued.errors.contains(words), "{}", issued.errors);
    }
    assert_eq!(signatures(&bench), 0);
    assert!(!bench.path("out").exists());
}

#[test]
fn an_encrypted_handle_of_a_token_belongs_into_the_agent() {
    let bench = Bench::new();
    bench.with_token(&["-q", "-t", "ed25519-sk", "-N", "correct horse", "-f", "key"], b"");
    let passphrase = Path::new("correct horse");
    for key in ["key", "key.pub"] {
        let issued = issue(&bench, key, &[("SSH_SK_PROVIDER", provider()), ("DTG_PASSPORT_PASSPHRASE", passphrase)]);
        assert!(!issued.good && issued.errors.contains("add it to ssh-agent"), "{}", issued.errors);
    }
}
