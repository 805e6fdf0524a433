//! Registers in folders, as readers of passports ask them: the register of a stand is one file, and nothing else is opened.
//!
//! A workspace remembers the last accepted register of each stand outside its folder of passports, so that an older one is
//! recognised.

use crate::files::{self, Durability, FileError};
use crate::passport::{Question, Trust, Verification};
use crate::register::{Doubt, FILE_NAME, FORM, RegisterRefused, VerifiedRegister};
use crate::text::{name_of, shown};
use jiff::Timestamp;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Largest step of the sequence number since the last accepted register that needs no confirmation by a person.
const LARGEST_STEP: u64 = 1000;

/// Folder in which the last accepted register of each stand is kept: `<model>/<serial>.yaml`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Memory(PathBuf);

/// Register that was found, and whether it counts.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Found {
    pub register: VerifiedRegister,
    pub doubt: Option<Doubt>,
    /// Remark on the remembered register, for the user.
    pub remark: Option<String>,
}

impl Found {
    /// Verifies the register that was read from a path, and compares it with the last one of its stand in a memory.
    ///
    /// # Errors
    /// Returns [`RegisterRefused`] if it is not accepted, or if the remembered one is damaged.
    pub(super) fn of(
        path: &Path,
        bytes: &[u8],
        trust: &Trust,
        now: Timestamp,
        memory: Option<&Memory>,
    ) -> Result<Self, RegisterRefused> {
        let register = VerifiedRegister::verify(&name_of(path), bytes, trust, now)?;
        let last = memory.map(|memory| memory.last(&register.header().stand, trust, now)).transpose()?;
        let (last, remark) = last.unwrap_or_default();
        let doubt = last.and_then(|last| doubt(&register, &last));
        Ok(Self { register, doubt, remark })
    }
}

/// Registers under a path: a register, or a folder of passports. Each is read and verified once.
#[derive(Debug)]
pub(crate) struct Registers {
    path: PathBuf,
    trust: Trust,
    now: Timestamp,
    memory: Option<Memory>,
    known: Mutex<HashMap<String, Result<Arc<Found>, RegisterRefused>>>,
}

impl Memory {
    pub(crate) fn new(folder: PathBuf) -> Self {
        Self(folder)
    }

    pub(crate) fn path_of(&self, stand: &str) -> PathBuf {
        self.0.join(format!("{stand}.yaml"))
    }

    /// Returns the last accepted register of a stand, and a remark if one is set aside because its key was revoked or is
    /// no longer trusted.
    ///
    /// # Errors
    /// Returns an error if the remembered file is damaged.
    pub(crate) fn last(
        &self,
        stand: &str,
        trust: &Trust,
        now: Timestamp,
    ) -> Result<(Option<VerifiedRegister>, Option<String>), RegisterRefused> {
        let path = self.path_of(stand);
        match read(&path, trust, now) {
            Ok(last) => Ok((Some(last), None)),
            Err(RegisterRefused::Missing(_)) => Ok((None, None)),
            Err(refused @ (RegisterRefused::KeyRevoked(_) | RegisterRefused::NotAuthorised(_))) => {
                let remark = format!("the remembered register is set aside: {refused}");
                Ok((None, Some(remark)))
            }
            Err(refused) => Err(refused),
        }
    }

    /// Keeps the bytes of an accepted register of a stand.
    pub(crate) fn keep(&self, stand: &str, bytes: &[u8]) -> Result<(), FileError> {
        let path = self.path_of(stand);
        match files::read(&path, FORM.limits.bytes) {
            Ok(there) if there == bytes => Ok(()),
            _ => files::replace(&path, bytes, Durability::Named),
        }
    }

    /// Returns `true` if no register of a stand was accepted so far.
    pub(crate) fn is_empty_for(&self, stand: &str) -> bool {
        !self.path_of(stand).exists()
    }
}

/// Reads and verifies the register at a path. Links are not followed.
///
/// # Errors
/// Returns [`RegisterRefused`] if there is no such file, if it cannot be read, or if it is not accepted.
pub(crate) fn read(path: &Path, trust: &Trust, now: Timestamp) -> Result<VerifiedRegister, RegisterRefused> {
    VerifiedRegister::verify(&name_of(path), &bytes(path)?, trust, now)
}

/// Reads the bytes of a register. Links are not followed, and nothing but a regular file is opened.
pub(crate) fn bytes(path: &Path) -> Result<Vec<u8>, RegisterRefused> {
    let refused = |why: &str| RegisterRefused::Unreadable(format!("{}: {why}", shown(path)));
    if path.is_symlink() {
        return Err(refused("is a link, which is not followed"));
    }
    files::read(path, FORM.limits.bytes).map_err(|error| match error {
        FileError::Folder(_) | FileError::Special(_) => refused("is not a file"),
        error if error.is_missing() => RegisterRefused::Missing(shown(path).to_string()),
        error => RegisterRefused::Unreadable(error.to_string()),
    })
}

impl Registers {
    /// Creates the registers under `path`: a register, or a folder that has the register of each stand as
    /// `<model>/<serial>/register.yaml`, or of one stand as `register.yaml`.
    pub(crate) fn new(path: &Path, trust: Trust, now: Timestamp, memory: Option<Memory>) -> Self {
        Self { path: path.to_owned(), trust, now, memory, known: Mutex::default() }
    }

    /// Adds the answer of the register of its stand to the verification of a passport.
    pub(crate) fn asked(&self, verification: Verification, question: &Question) -> Verification {
        let Some(stand) = verification.content_from_anyone().map(|content| content.stand.id()) else {
            return verification.with_register(Err(&RegisterRefused::Missing(String::new())), question);
        };
        let found = self.of(&stand);
        let register = found.as_ref().map(|found| (&found.register, found.doubt.as_ref()));
        verification.with_register(register, question)
    }

    /// Returns the remarks on the registers that were read.
    pub(crate) fn remarks(&self) -> Vec<String> {
        let known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let mut remarks: Vec<String> = known.values().filter_map(|found| found.as_ref().ok()?.remark.clone()).collect();
        remarks.sort();
        remarks
    }

    /// Returns the register of a stand, `<model>/<serial>`.
    pub(crate) fn of(&self, stand: &str) -> Result<Arc<Found>, RegisterRefused> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        known.entry(stand.to_owned()).or_insert_with(|| self.found(stand).map(Arc::new)).clone()
    }

    fn found(&self, stand: &str) -> Result<Found, RegisterRefused> {
        let (path, bytes) = self.bytes_of(stand)?;
        let mut found = Found::of(&path, &bytes, &self.trust, self.now, self.memory.as_ref())?;
        if let Some(memory) = &self.memory
            && found.doubt.is_none()
            && found.register.header().stand == stand
            && let Err(error) = memory.keep(stand, &bytes)
        {
            found.remark.get_or_insert(format!("the register is not remembered: {error}"));
        }
        Ok(found)
    }

    /// Reads the register of a stand, and returns its path and its bytes.
    pub(crate) fn bytes_of(&self, stand: &str) -> Result<(PathBuf, Vec<u8>), RegisterRefused> {
        let read = |path: PathBuf| bytes(&path).map(|bytes| (path, bytes));
        if !self.path.is_dir() {
            return read(self.path.clone());
        }
        let of_stand = self.path.join(stand);
        let way = [of_stand.parent().unwrap_or(&self.path), &of_stand];
        if let Some(link) = way.into_iter().find(|folder| folder.is_symlink()) {
            let why = format!("{}: is a link, which is not followed", shown(link));
            return Err(RegisterRefused::Unreadable(why));
        }
        match read(of_stand.join(FILE_NAME)) {
            Err(missing @ RegisterRefused::Missing(_)) => {
                read(self.path.join(FILE_NAME)).map_err(|other| match other {
                    RegisterRefused::Missing(_) => missing,
                    other => other,
                })
            }
            found => found,
        }
    }
}

/// Returns why a register does not count, given the last one accepted; `None` if it does.
pub(crate) fn doubt(register: &VerifiedRegister, last: &VerifiedRegister) -> Option<Doubt> {
    if let Err(contradiction) = register.agree(last) {
        return Some(Doubt::Contradicted(contradiction));
    }
    let (number, known) = (register.header().sequence, last.header().sequence);
    match number {
        _ if number < known => Some(Doubt::Older(known)),
        _ if number - known > LARGEST_STEP => Some(Doubt::Unconfirmed(format!(
            "register {number} follows {known}, the last one accepted, by more than {LARGEST_STEP}; ask the issuer, and if \
             this is right, remove the remembered register"
        ))),
        _ => None,
    }
}
