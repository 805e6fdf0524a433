//! How a factory signs: a key file, plain or encrypted, or `ssh-keygen` with an agent or a FIDO token.

pub use crate::document::{Signer, SigningFailed};
use crate::files::{self, FileError};
use crate::passport::{NAMESPACE, Trust};
use crate::text::{Printable, Unreadable, name_of, shown};
use crate::trust::{
    AllowedSigners, BadIdentity, KeyError, LARGEST_TRUST_FILE_BYTES, PublicKey, Signature, SigningKey, check_identity,
};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Mutex, PoisonError};
use zeroize::Zeroizing;

/// The variable from which the program takes a passphrase where no terminal asks for it. No program that is started here
/// inherits it.
pub(crate) const PASSPHRASE_VARIABLE: &str = "DTG_PASSPORT_PASSPHRASE";

/// The largest key file that is read, in bytes.
const LARGEST_KEY_FILE_BYTES: usize = 1 << 16;

/// Why a key cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum KeyFileError {
    /// The file cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// It holds no key that signs.
    #[error("{}: {error}", shown(path))]
    Key {
        /// Which file.
        path: PathBuf,
        /// What is wrong.
        error: KeyError,
    },
    /// Others can read the private key.
    #[error("{}: mode {mode:04o} allows others to read the private key; restrict it with chmod 600", shown(path))]
    Exposed {
        /// Which file.
        path: PathBuf,
        /// Its permissions.
        mode: u32,
    },
    /// There is no passphrase.
    #[error("{}: the key is encrypted: {}", shown(path), Printable(reason))]
    Passphrase {
        /// Which file.
        path: PathBuf,
        /// Why there is none.
        reason: String,
    },
    /// The private half of a public key is nowhere.
    #[error(
        "{}: found only the public half, expected the private half in ssh-agent or in {}; check that OpenSSH is \
         installed and that ssh-agent has this key (ssh-add -L)",
        shown(path),
        shown(private)
    )]
    NoPrivateHalf {
        /// The public key.
        path: PathBuf,
        /// Where its private half would be.
        private: PathBuf,
    },
    /// The private key beside a public key is another one.
    #[error("{}: is not the private half of {}; use the matching key file", shown(private), shown(path))]
    OtherPrivateHalf {
        /// The public key.
        path: PathBuf,
        /// The private key.
        private: PathBuf,
    },
    /// The file is not text.
    #[error("{}: found binary data, expected a private key in OpenSSH format or a .pub file", shown(path))]
    NotText {
        /// Which file.
        path: PathBuf,
    },
}

/// Asks for the passphrase of a key; called only for an encrypted one.
pub type AskPassphrase<'a> = &'a dyn Fn(&Path) -> Result<Zeroizing<String>, String>;

/// From here on this process leaves no core dump, which would hold the key and its passphrase; nor can another process
/// of the same user look into its memory. What the system does not know of stays as it is.
pub(crate) fn forbid_core_dumps() {
    #[cfg(unix)]
    {
        use rustix::process::{Resource, Rlimit, setrlimit};
        let _ = setrlimit(Resource::Core, Rlimit { current: Some(0), maximum: Some(0) });
    }
    // A program that collects core dumps does not ask for the limit.
    #[cfg(target_os = "linux")]
    {
        use rustix::process::{DumpableBehavior, set_dumpable_behavior};
        let _ = set_dumpable_behavior(DumpableBehavior::NotDumpable);
    }
}

/// The signer for a key file: the key itself, or `ssh-keygen` for a `.pub` whose private half is in the agent or a token.
///
/// Where the private half is, and that it can be used, is found out here, once: `ssh-keygen` would ask for a passphrase
/// at every signature.
///
/// # Errors
/// See [`KeyFileError`]. A private key that others can read is refused, as OpenSSH does.
pub fn signer(path: &Path, ask: AskPassphrase) -> Result<Box<dyn Signer + Sync>, KeyFileError> {
    let ssh_keygen = |public_key, in_agent| -> Box<dyn Signer + Sync> {
        Box::new(SshKeygen { key: path.to_owned(), public_key, in_agent, turn: Mutex::new(()) })
    };
    if path.extension().is_none_or(|extension| extension != "pub") {
        return Ok(private_key(path, ask)?.map_or_else(|| ssh_keygen(None, false), |key| Box::new(key)));
    }
    let public = PublicKey::from_openssh(text(path)?.trim_end());
    let public = public.map_err(|error| KeyFileError::Key { path: path.to_owned(), error })?;
    if is_in_agent(&public) {
        return Ok(ssh_keygen(Some(public), true));
    }
    let private = path.with_extension("");
    if !private.exists() {
        return Err(KeyFileError::NoPrivateHalf { path: path.to_owned(), private });
    }
    match private_key(&private, ask)? {
        Some(key) if key.public_key() != public => {
            Err(KeyFileError::OtherPrivateHalf { path: path.to_owned(), private })
        }
        Some(key) => Ok(Box::new(key)),
        None => Ok(ssh_keygen(Some(public), false)),
    }
}

/// The key of a private key file; `None` when the file is only the handle of a key in a token.
fn private_key(path: &Path, ask: AskPassphrase) -> Result<Option<SigningKey>, KeyFileError> {
    let text = text(path)?;
    refuse_exposed(path)?;
    let key = match SigningKey::from_openssh(&text, None) {
        Err(KeyError::Encrypted) => {
            let asked = ask(path);
            let passphrase = asked.map_err(|reason| KeyFileError::Passphrase { path: path.to_owned(), reason })?;
            SigningKey::from_openssh(&text, Some(&passphrase))
        }
        key => key,
    };
    match key {
        Ok(key) => Ok(Some(key)),
        Err(KeyError::SecurityKey) => Ok(None),
        Err(error) => Err(KeyFileError::Key { path: path.to_owned(), error }),
    }
}

fn text(path: &Path) -> Result<Zeroizing<String>, KeyFileError> {
    let bytes = Zeroizing::new(files::read(path, LARGEST_KEY_FILE_BYTES)?);
    let text = std::str::from_utf8(&bytes).map_err(|_| KeyFileError::NotText { path: path.to_owned() })?;
    Ok(Zeroizing::new(text.to_owned()))
}

/// Whether ssh-agent has the private half of a key. Without an agent, or without OpenSSH, it has none.
fn is_in_agent(public: &PublicKey) -> bool {
    let listed = openssh("ssh-add").arg("-L").stdin(Stdio::null()).output();
    let lines = listed.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    lines.lines().any(|line| PublicKey::from_openssh(line).is_ok_and(|key| key == *public))
}

/// A program of OpenSSH, which is not told the passphrase.
fn openssh(program: &str) -> Command {
    let mut command = Command::new(program);
    command.env_remove(PASSPHRASE_VARIABLE);
    command
}

#[cfg(unix)]
fn refuse_exposed(path: &Path) -> Result<(), KeyFileError> {
    use std::os::unix::fs::PermissionsExt;
    let failed = |error| FileError::Read { path: path.to_owned(), error };
    let mode = std::fs::metadata(path).map_err(failed)?.permissions().mode() & 0o7777;
    if mode & 0o077 != 0 {
        return Err(KeyFileError::Exposed { path: path.to_owned(), mode });
    }
    Ok(())
}

#[cfg(not(unix))]
fn refuse_exposed(_: &Path) -> Result<(), KeyFileError> {
    Ok(())
}

/// The line of allowed_signers that trusts `key` as `identity` for passports and their revocation lists.
///
/// # Errors
/// [`BadIdentity`] when the identity would be read as a pattern of several.
pub fn allowed_signers_line(identity: &str, key: &PublicKey) -> Result<String, BadIdentity> {
    check_identity(identity)?;
    Ok(format!("{identity} namespaces=\"{NAMESPACE},dtg-revocation\" {}", key.to_openssh()))
}

/// Returns the trust of an issuer in what its own key signs, or `None` if that key is not known.
pub(crate) fn own_trust(identity: &str, signer: &dyn Signer) -> Option<Trust> {
    let line = allowed_signers_line(identity, &signer.public_key()?).ok()?;
    AllowedSigners::parse("own key", line.as_bytes()).ok().map(Trust::of)
}

/// Why allowed signers get no further line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub(crate) enum NotAppended {
    /// The file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// With the line it would not be a list of allowed signers.
    #[error("{0}\nnothing was appended")]
    Unreadable(#[from] Unreadable),
}

/// Returns the allowed signers of a file with one line more, after a line feed where the last line has none; a file that
/// does not exist yet is empty.
///
/// # Errors
/// See [`NotAppended`].
pub(crate) fn with_signer(path: &Path, line: &str) -> Result<Vec<u8>, NotAppended> {
    let mut text = match files::read(path, LARGEST_TRUST_FILE_BYTES) {
        Err(FileError::Read { error, .. }) if error.kind() == io::ErrorKind::NotFound => Vec::new(),
        read => read?,
    };
    if text.last().is_some_and(|last| *last != b'\n') {
        text.push(b'\n');
    }
    text.extend_from_slice(line.as_bytes());
    text.push(b'\n');
    AllowedSigners::parse(&name_of(path), &text)?;
    Ok(text)
}

/// Appends a line to the allowed signers of a file, whole or not at all; one that does not exist yet is made.
///
/// # Errors
/// See [`NotAppended`]; the file then is as it was.
pub(crate) fn append_signer(path: &Path, line: &str) -> Result<(), NotAppended> {
    let _turn = files::wait_for_turn(files::folder_of(path));
    Ok(files::rewrite(path, &with_signer(path, line)?)?)
}

/// Signs through `ssh-keygen -Y sign`, which speaks to ssh-agent and to FIDO tokens.
#[derive(Debug)]
pub struct SshKeygen {
    key: PathBuf,
    public_key: Option<PublicKey>,
    in_agent: bool,
    /// A token makes one signature at a time.
    turn: Mutex<()>,
}

impl Signer for SshKeygen {
    fn public_key(&self) -> Option<PublicKey> {
        self.public_key.clone()
    }

    fn sign(&self, namespace: &str, message: &[u8]) -> Result<Signature, SigningFailed> {
        let failed =
            |what: String| SigningFailed(format!("ssh-keygen could not sign with {}: {what}", shown(&self.key)));
        let _turn = self.turn.lock().unwrap_or_else(PoisonError::into_inner);
        let mut child = openssh("ssh-keygen")
            .args(["-Y", "sign", "-q", "-n", namespace, "-f"])
            .arg(&self.key)
            // The agent or nothing: a key that it loses is not looked for in files, whose passphrase would be asked for.
            .args(self.in_agent.then_some("-U"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| failed(format!("{error}; check that OpenSSH is installed")))?;
        if let Some(mut stdin) = child.stdin.take() {
            // A child that has already given up closes its end; its own words say why.
            let _ = stdin.write_all(message);
        }
        let output = child.wait_with_output().map_err(|error| failed(error.to_string()))?;
        if !output.status.success() {
            let words = String::from_utf8_lossy(&output.stderr).trim().replace('\n', "; ");
            let advice = "check that ssh-agent has this key (ssh-add -L), or that the token is plugged in";
            return Err(failed(format!("{words} ({advice})")));
        }
        let armor = String::from_utf8_lossy(&output.stdout);
        Signature::from_armor(&armor).map_err(|error| failed(error.to_string()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: every line of many at once is there, on a line of its own, after what was there before.
    #[test]
    fn lines_are_appended_one_after_the_other() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("allowed_signers");
        let line = |name: &str| allowed_signers_line(name, &SigningKey::generate().unwrap().public_key()).unwrap();
        std::fs::write(&path, format!("# ours\r\n{}", line("first"))).unwrap();
        let before = std::fs::read(&path).unwrap();
        let lines: Vec<String> = (0..8).map(|number| line(&format!("name-{number}"))).collect();
        std::thread::scope(|scope| {
            lines.iter().for_each(|line| drop(scope.spawn(|| append_signer(&path, line).unwrap())));
        });
        let text = std::fs::read(&path).unwrap();
        assert!(text.starts_with(&before) && text[before.len()] == b'\n');
        let text = String::from_utf8(text).unwrap();
        assert!(lines.iter().all(|line| text.lines().filter(|there| there == line).count() == 1));
        assert_eq!(text.lines().count(), 2 + lines.len());
    }

    #[test]
    fn nothing_is_appended_to_what_is_no_list_of_signers() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("allowed_signers");
        let line = allowed_signers_line("factory", &SigningKey::generate().unwrap().public_key()).unwrap();
        for other in ["id: 1\n".as_bytes(), b"factory ssh-ed25519 AAAAC3Nza", b"\xff\xfea\0"] {
            std::fs::write(&path, other).unwrap();
            assert!(matches!(append_signer(&path, &line), Err(NotAppended::Unreadable(_))));
            assert_eq!(std::fs::read(&path).unwrap(), other);
        }
        assert!(matches!(append_signer(folder.path(), &line), Err(NotAppended::File(_))));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
