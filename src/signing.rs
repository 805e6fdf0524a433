//! Signing: with a key file, plain or encrypted, or with `ssh-keygen` and an agent or a FIDO token.

pub use crate::document::{Signer, SigningFailed};
use crate::files::{self, FileError};
use crate::passport::{NAMESPACE, Trust};
use crate::register;
use crate::text::{Printable, Unreadable, name_of, shown};
use crate::trust::{
    AllowedSigners, BadIdentity, KeyError, LARGEST_TRUST_FILE_BYTES, PublicKey, Signature, SigningKey, check_identity,
};
use jiff::Timestamp;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Mutex, PoisonError};
use zeroize::Zeroizing;

/// Environment variable with the passphrase, for use without a terminal. Programs started here do not inherit it.
pub(crate) const PASSPHRASE_VARIABLE: &str = "DTG_PASSPORT_PASSPHRASE";

const LARGEST_KEY_FILE_BYTES: usize = 1 << 16;

/// Reason why a key cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum KeyFileError {
    /// File that cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// File without a key that can sign.
    #[error("{}: {}", shown(.0), .1)]
    Key(PathBuf, KeyError),
    /// File whose key cannot be used, and why, in words.
    #[error("{}: {}", shown(.0), Printable(.1))]
    Unusable(PathBuf, String),
}

/// Function that asks for the passphrase of a key file; it is called only for an encrypted key.
pub(crate) type AskPassphrase<'a> = &'a dyn Fn(&Path) -> Result<Zeroizing<String>, String>;

/// Prevents core dumps of this process, which would contain the key and its passphrase, and keeps other processes of
/// the same user from reading its memory. On systems without these settings it has no effect.
pub(crate) fn forbid_core_dumps() {
    #[cfg(unix)]
    {
        use rustix::process::{Resource, Rlimit, setrlimit};
        let _ = setrlimit(Resource::Core, Rlimit { current: Some(0), maximum: Some(0) });
    }
    // A program that collects core dumps ignores the limit.
    #[cfg(target_os = "linux")]
    {
        use rustix::process::{DumpableBehavior, set_dumpable_behavior};
        let _ = set_dumpable_behavior(DumpableBehavior::NotDumpable);
    }
}

/// Returns the signer for a key file: the key itself, or `ssh-keygen` for a `.pub` whose private half is in the agent
/// or on a token.
///
/// This function finds the private half and checks once that it can be used. Otherwise `ssh-keygen` would ask for the
/// passphrase at every signature.
///
/// # Errors
/// Returns [`KeyFileError`] if the key cannot be read or used, or if others can read the private key (as in OpenSSH).
pub fn signer(path: &Path, ask: AskPassphrase) -> Result<Box<dyn Signer + Sync>, KeyFileError> {
    let ssh_keygen = |public_key, in_agent| -> Box<dyn Signer + Sync> {
        Box::new(SshKeygen { key: path.to_owned(), public_key, in_agent, turn: Mutex::new(()) })
    };
    if !is_public(path) {
        return Ok(private_key(path, ask)?.map_or_else(|| ssh_keygen(None, false), |key| Box::new(key)));
    }
    let (public, private) = private_half(path)?;
    let Some(private) = private else { return Ok(ssh_keygen(Some(public), true)) };
    match private_key(&private, ask)? {
        Some(key) if key.public_key() != public => Err(other_half(path, private)),
        Some(key) => Ok(Box::new(key)),
        None => Ok(ssh_keygen(Some(public), false)),
    }
}

/// Returns the refusal of a private key next to a public key that does not belong to it.
fn other_half(path: &Path, private: PathBuf) -> KeyFileError {
    let why = format!("is not the private half of {}; use the matching key file", shown(path));
    KeyFileError::Unusable(private, why)
}

fn is_public(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "pub")
}

/// Returns the key in a `.pub` file, and the file with its private half, or `None` if ssh-agent has that.
fn private_half(path: &Path) -> Result<(PublicKey, Option<PathBuf>), KeyFileError> {
    let public = PublicKey::from_openssh(text(path)?.trim_end());
    let public = public.map_err(|error| KeyFileError::Key(path.to_owned(), error))?;
    if is_in_agent(&public) {
        return Ok((public, None));
    }
    let private = path.with_extension("");
    if !private.exists() {
        let why = format!(
            "found only the public half, expected the private half in ssh-agent or in {}; check that OpenSSH is installed and \
             that ssh-agent has this key (ssh-add -L)",
            shown(&private)
        );
        return Err(KeyFileError::Unusable(path.to_owned(), why));
    }
    Ok((public, Some(private)))
}

/// Returns the key in a private key file, or `None` if the file is only the handle of a key on a token.
fn private_key(path: &Path, ask: AskPassphrase) -> Result<Option<SigningKey>, KeyFileError> {
    let text = private_text(path)?;
    let key = match SigningKey::from_openssh(&text, None) {
        Err(KeyError::Encrypted) => {
            let asked = ask(path);
            let encrypted = |why| KeyFileError::Unusable(path.to_owned(), format!("the key is encrypted: {why}"));
            let passphrase = asked.map_err(encrypted)?;
            SigningKey::from_openssh(&text, Some(&passphrase))
        }
        key => key,
    };
    match key {
        Ok(key) => Ok(Some(key)),
        Err(KeyError::SecurityKey) => Ok(None),
        Err(error) => Err(KeyFileError::Key(path.to_owned(), error)),
    }
}

/// Returns the public half of the key with which [`signer`] would sign, as far as this can be checked without a
/// passphrase and without signing.
///
/// # Errors
/// Returns the errors of [`signer`], except those of a passphrase and of what it decrypts.
pub(crate) fn key_to_sign_with(path: &Path) -> Result<PublicKey, KeyFileError> {
    if is_public(path) {
        let (public, private) = private_half(path)?;
        return match private {
            Some(private) if key_to_sign_with(&private)? != public => Err(other_half(path, private)),
            _ => Ok(public),
        };
    }
    let text = private_text(path)?;
    let public = match SigningKey::from_openssh(&text, None) {
        Ok(key) => Ok(key.public_key()),
        Err(KeyError::Encrypted | KeyError::SecurityKey) => PublicKey::of_key_file(&text),
        Err(error) => Err(error),
    };
    public.map_err(|error| KeyFileError::Key(path.to_owned(), error))
}

/// Returns the reason why passports that `key` signs as `identity` at `time` would fail verification by `trust`, or
/// `None` if they would not.
pub(crate) fn distrust(trust: &Trust, key: &PublicKey, identity: &str, time: Timestamp) -> Option<String> {
    let authorised = trust.signers.authorise(key, identity, NAMESPACE, time);
    let revoked = || trust.revoked.iter().find_map(|list| list.revokes(key));
    authorised.err().map(|miss| miss.to_string()).or_else(revoked)
}

/// Returns the text of a file for a private key. Others may read the file only if it contains none.
fn private_text(path: &Path) -> Result<Zeroizing<String>, KeyFileError> {
    let text = text(path)?;
    if text.contains("PRIVATE KEY") {
        refuse_exposed(path)?;
    }
    Ok(text)
}

fn text(path: &Path) -> Result<Zeroizing<String>, KeyFileError> {
    let bytes = Zeroizing::new(files::read(path, LARGEST_KEY_FILE_BYTES)?);
    let why = "found binary data, expected a private key in OpenSSH format or a .pub file";
    let text = std::str::from_utf8(&bytes).map_err(|_| KeyFileError::Unusable(path.to_owned(), why.to_owned()))?;
    Ok(Zeroizing::new(text.to_owned()))
}

/// Returns `true` if ssh-agent has the private half of a key; `false` also without an agent or without OpenSSH.
fn is_in_agent(public: &PublicKey) -> bool {
    let listed = openssh("ssh-add").arg("-L").stdin(Stdio::null()).output();
    let lines = listed.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    lines.lines().any(|line| PublicKey::from_openssh(line).is_ok_and(|key| key == *public))
}

/// Returns the command for a program of OpenSSH, without the passphrase in its environment.
fn openssh(program: &str) -> Command {
    let mut command = Command::new(program);
    command.env_remove(PASSPHRASE_VARIABLE);
    command
}

#[cfg(unix)]
fn refuse_exposed(path: &Path) -> Result<(), KeyFileError> {
    use std::os::unix::fs::PermissionsExt;
    let failed = |error| FileError::Read(path.to_owned(), error);
    let mode = std::fs::metadata(path).map_err(failed)?.permissions().mode() & 0o7777;
    if mode & 0o077 != 0 {
        let why = format!("mode {mode:04o} allows others to read the private key; restrict it with chmod 600");
        return Err(KeyFileError::Unusable(path.to_owned(), why));
    }
    Ok(())
}

#[cfg(not(unix))]
fn refuse_exposed(_: &Path) -> Result<(), KeyFileError> {
    Ok(())
}

/// Returns what protects a new private key on this system, if that is not the key file's own mode.
pub(crate) fn protection_remark(path: &Path) -> Option<String> {
    let words = "Windows protects the private key only by the permissions of its folder; to restrict them, run";
    cfg!(windows).then(|| format!("{words} `icacls {} /inheritance:r /grant:r \"%USERNAME%:R\"`", shown(path)))
}

/// Returns the line of allowed_signers that trusts `key` as `identity` for passports and registers.
///
/// # Errors
/// Returns [`BadIdentity`] if the identity could be read as a pattern of several identities.
pub fn allowed_signers_line(identity: &str, key: &PublicKey) -> Result<String, BadIdentity> {
    check_identity(identity)?;
    Ok(format!("{identity} namespaces=\"{NAMESPACE},{}\" {}", register::REGISTER_NAMESPACE, key.to_openssh()))
}

/// Returns the trust of an issuer in what its own keys sign, or `None` for an identity that no list can contain.
/// `register_key` signs registers in place of `key`.
pub(crate) fn own_trust(identity: &str, key: &PublicKey, register_key: Option<&PublicKey>) -> Option<Trust> {
    let mut lines = allowed_signers_line(identity, key).ok()?;
    if let Some(other) = register_key {
        lines += &format!("\n{identity} namespaces=\"{}\" {}", register::REGISTER_NAMESPACE, other.to_openssh());
    }
    AllowedSigners::parse("own key", lines.as_bytes()).ok().map(Trust::of)
}

/// Reason why no line was appended to the allowed signers.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub(crate) enum NotAppended {
    /// File that cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// File that would not be a list of allowed signers with the new line.
    #[error("{0}\nnothing was appended")]
    Unreadable(#[from] Unreadable),
}

/// Returns the allowed signers of a file with one more line; a missing final line feed is added first. A file that does
/// not exist counts as empty, unless a link leads to it.
pub(crate) fn with_signer(path: &Path, line: &str) -> Result<Vec<u8>, NotAppended> {
    let mut text = match files::read(path, LARGEST_TRUST_FILE_BYTES) {
        Err(error) if error.is_missing() && path.is_symlink() => {
            return Err(FileError::Exists { path: path.to_owned(), replaceable: false }.into());
        }
        Err(error) if error.is_missing() => Vec::new(),
        read => read?,
    };
    append_line(&mut text, line);
    AllowedSigners::parse(&name_of(path), &text)?;
    Ok(text)
}

/// Appends a line to a text; a missing final line feed is added first.
pub(crate) fn append_line(text: &mut Vec<u8>, line: &str) {
    let end: &[u8] = if text.last().is_some_and(|last| *last != b'\n') { b"\n" } else { b"" };
    text.extend([end, line.as_bytes(), b"\n"].concat());
}

/// Appends a line to the allowed signers of a file, completely or not at all; a missing file is created.
///
/// # Errors
/// Returns [`NotAppended`] as [`with_signer`] does, or if the file cannot be written; the file is then unchanged.
pub(crate) fn append_signer(path: &Path, line: &str) -> Result<(), NotAppended> {
    let _turn = files::wait_for_turn(files::folder_of(path));
    Ok(files::rewrite(path, &with_signer(path, line)?)?)
}

/// Signer that runs `ssh-keygen -Y sign`, which uses ssh-agent and FIDO tokens.
#[derive(Debug)]
pub struct SshKeygen {
    key: PathBuf,
    public_key: Option<PublicKey>,
    in_agent: bool,
    /// Lock, because a token makes one signature at a time.
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
            // Use only the agent. If it loses the key, ssh-keygen must not look for key files and ask for their
            // passphrases.
            .args(self.in_agent.then_some("-U"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| failed(format!("{error}; check that OpenSSH is installed")))?;
        if let Some(mut stdin) = child.stdin.take() {
            // A child that has failed closes its end; the error is in its own output.
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
