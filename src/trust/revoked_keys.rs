//! Revoked keys: OpenSSH's key revocation list (`ssh-keygen -k`), or a list of public keys, one per line.

use super::krl::{self, Revoked};
use super::public_key::AnyKey;
use super::signer_line::read_key;
use super::{PublicKey, lines};
use crate::text::kind::mistaken;
use crate::text::{Kind, Unreadable};
use sha1::Sha1;
use sha2::{Digest, Sha256};

/// Keys that one file revokes.
#[derive(Debug, Clone)]
pub struct RevokedKeys {
    name: String,
    revoked: Revoked,
    /// Types of the keys that were skipped, because they cannot sign passports.
    pub(crate) skipped: Vec<String>,
}

impl RevokedKeys {
    /// Reads a key revocation list or a list of public keys, distinguished by content; `name` is the file name used in
    /// messages.
    ///
    /// A list of public keys has on each line one key, without options; `#` begins a comment line. Keys that cannot sign
    /// passports are skipped; a certificate revokes its key, as with OpenSSH. A list that revokes no key yet must contain a
    /// comment, because an empty file may be the remainder of a truncated list.
    ///
    /// # Errors
    /// Returns [`Unreadable`] with every error in a list of public keys, or with the first error in a key revocation
    /// list and its offset in bytes.
    pub fn parse(name: &str, bytes: &[u8]) -> Result<Self, Unreadable> {
        let mut skipped = Vec::new();
        let is_binary = bytes.starts_with(b"SSHKRL");
        let read = if is_binary { binary(name, bytes) } else { text(name, bytes, &mut skipped) };
        let expected = "a KRL, or a list of public keys";
        let is_near = |kind| matches!(kind, Kind::KeyRevocationList | Kind::PublicKey | Kind::PrivateKey);
        let revoked = read.map_err(|refused| mistaken(name, bytes, expected, is_near).unwrap_or(refused))?;
        Ok(Self { name: name.to_owned(), revoked, skipped })
    }

    /// Returns the reason why `key` is revoked, or `None` if it is not revoked.
    pub fn revokes(&self, key: &PublicKey) -> Option<String> {
        let blob = &key.blob;
        if self.revoked.keys.contains(blob) {
            Some(format!("listed in {}", self.name))
        } else if self.revoked.sha256.contains(&Sha256::digest(blob)[..]) {
            Some(format!("its SHA-256 fingerprint is in {}", self.name))
        } else if self.revoked.sha1.contains(&Sha1::digest(blob)[..]) {
            Some(format!("its SHA-1 fingerprint is in {}", self.name))
        } else {
            None
        }
    }
}

fn binary(name: &str, bytes: &[u8]) -> Result<Revoked, Unreadable> {
    lines::check_size(name, bytes)?;
    if bytes.starts_with(b"SSHKRL\r\n") {
        let found = "a key revocation list with changed line endings (for example by git autocrlf)";
        let advice = "transfer it again as a binary file";
        return Err(Unreadable::whole(name, None, found, "the list as ssh-keygen wrote it", advice));
    }
    krl::read(bytes).map_err(|problem| Unreadable::of(name, vec![problem]))
}

fn text(name: &str, bytes: &[u8], skipped: &mut Vec<String>) -> Result<Revoked, Unreadable> {
    if bytes.trim_ascii().is_empty() {
        let advice = "if no key has been revoked, state this in a line that begins with #";
        return Err(Unreadable::whole(name, None, "an empty file", "a list of revoked keys", advice));
    }
    let mut revoked = Revoked::default();
    let read = |line: &lines::Line| {
        let start = line.text.len() - line.text.trim_start().len();
        line.control_character().map_or_else(|| read_key(line, start), Err).map_err(|problem| vec![problem])
    };
    for key in lines::read(name, bytes, read)? {
        match key {
            AnyKey::Signing(key) | AnyKey::Other { certified: Some(key), .. } => drop(revoked.keys.insert(key.blob)),
            AnyKey::Other { algorithm, .. } => skipped.push(algorithm),
        }
    }
    Ok(revoked)
}
