//! The real OpenSSH against `trust`, both ways: signatures, key files, allowed signers, revocation, tokens, the agent.
//!
//! Needs `ssh-keygen`, `ssh-add`, `ssh-agent` (Debian: openssh-client) and, for the token in software, gcc and OpenSSL's
//! headers (gcc, libssl-dev), and for the verifier in Java a JDK (default-jdk-headless). What is missing fails its tests:
//! nothing is skipped.

#![cfg(feature = "cli")]

mod agent;
mod allowed_signers;
mod java;
mod keys;
mod other_types;
mod program;
mod revocation;
mod signatures;
mod token;

use base64ct::{Base64, Encoding as _};
use dtg_passport::trust::{PublicKey, SigningKey};
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const NAMESPACE: &str = "dtg-passport";
const PRINCIPAL: &str = "lab@factory";

/// A folder of its own for one test.
struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a temporary folder") }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        fs::write(&path, bytes).expect("a file in the temporary folder");
        path
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// A private key file as `ssh-keygen` wants it: readable by its owner alone.
    fn write_key(&self, name: &str, pem: &str) -> PathBuf {
        use std::os::unix::fs::PermissionsExt as _;
        let path = self.write(name, pem);
        fs::set_permissions(&path, fs::Permissions::from_mode(0o600)).expect("mode 0600");
        path
    }

    /// A new key of ours, its file and that of its public half.
    fn new_key(&self, name: &str) -> SigningKey {
        let key = SigningKey::generate().unwrap();
        self.write_key(name, &key.to_openssh("test key", None).unwrap());
        self.write(&format!("{name}.pub"), key.public_key().to_openssh() + " test key\n");
        key
    }

    /// Trusts a key.
    fn write_signers(&self, key: &PublicKey) {
        self.write("signers", format!("{PRINCIPAL} {}\n", key.to_openssh()));
    }

    /// Runs `ssh-keygen` in the folder.
    fn keygen(&self, arguments: &[&str]) -> Finished {
        self.run(Command::new("ssh-keygen").args(arguments), b"")
    }

    /// Runs `ssh-keygen`, which must succeed, with a token in software.
    fn with_token(&self, arguments: &[&str], input: &[u8]) -> String {
        let mut command = Command::new("ssh-keygen");
        let finished = self.run(command.env("SSH_SK_PROVIDER", token::provider()).args(arguments), input);
        assert!(finished.good, "{}{}", finished.output, finished.errors);
        finished.output
    }

    /// Makes a key with `ssh-keygen`, which must succeed.
    fn made(&self, name: &str, arguments: &[&str]) {
        let made = self.keygen(&[&["-q", "-f", name][..], arguments].concat());
        assert!(made.good, "{name}: {}", made.errors);
    }

    /// Signs with `ssh-keygen -Y sign` and gives the armor.
    fn sign(&self, key: &str, message: &[u8]) -> String {
        let mut command = Command::new("ssh-keygen");
        let finished = self.run(command.args(["-Y", "sign", "-q", "-f", key, "-n", NAMESPACE]), message);
        assert!(finished.good, "ssh-keygen -Y sign: {}", finished.errors);
        finished.output
    }

    /// Verifies an armor with `ssh-keygen -Y verify`; `more` are further arguments.
    fn verify(&self, signers: &str, armor: &str, message: &[u8], more: &[&str]) -> Finished {
        self.write("verified.sig", armor);
        let mut command = Command::new("ssh-keygen");
        command
            .args(["-Y", "verify", "-n", NAMESPACE, "-I", PRINCIPAL, "-s", "verified.sig", "-f", signers])
            .args(more);
        self.run(&mut command, message)
    }

    fn run(&self, command: &mut Command, input: &[u8]) -> Finished {
        command.current_dir(self.folder.path()).env_remove("SSH_ASKPASS").env_remove("DISPLAY");
        if command.get_envs().all(|(name, _)| name != "SSH_AUTH_SOCK") {
            command.env_remove("SSH_AUTH_SOCK");
        }
        run(command, input)
    }
}

/// A string of SSH (RFC 4251, section 5).
fn string(bytes: &[u8]) -> Vec<u8> {
    [&u32::try_from(bytes.len()).unwrap().to_be_bytes()[..], bytes].concat()
}

/// A block of SSHSIG as OpenSSH writes it.
fn armored(block: &[u8]) -> String {
    let base64 = Base64::encode_string(block);
    let lines: Vec<_> = base64.as_bytes().chunks(70).map(|line| str::from_utf8(line).unwrap()).collect();
    format!("-----BEGIN SSH SIGNATURE-----\n{}\n-----END SSH SIGNATURE-----\n", lines.join("\n"))
}

/// The line between a text and its signature in a file.
const SIGNATURE_LINE: &str = "signature: |\n";

/// A file as `issue` writes it: a text and its signature.
fn joined(payload: &str, armor: &str) -> String {
    let armor: String = armor.lines().map(|line| format!("  {line}\n")).collect();
    format!("{payload}{SIGNATURE_LINE}{armor}")
}

/// A file of the project.
fn project(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

/// How a program ended.
#[derive(Debug)]
struct Finished {
    good: bool,
    output: String,
    errors: String,
}

/// Runs a program; that it cannot be started fails the test with what to install.
fn run(command: &mut Command, input: &[u8]) -> Finished {
    let name = Path::new(command.get_program()).display().to_string();
    let mut child =
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap_or_else(|error| {
            panic!("`{name}` cannot be started ({error}); install it (Debian: openssh-client gcc libssl-dev)")
        });
    let mut pipe = child.stdin.take().expect("a pipe");
    let Output { status, stdout, stderr } = std::thread::scope(|scope| {
        // A program that ends without reading its input closes the pipe: its own words say why.
        scope.spawn(move || pipe.write_all(input).ok());
        child.wait_with_output().expect("the end of the program")
    });
    let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
    Finished { good: status.success(), output: text(&stdout[..]), errors: text(&stderr[..]) }
}
