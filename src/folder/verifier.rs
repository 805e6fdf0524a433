//! Verification of passports against the register of a folder, which tells which are superseded or withdrawn.

use super::search;
use crate::files::FileError;
use crate::parallel;
use crate::passport::{Question, Trust, Verification, verify};
use crate::register::{Asked, Register};
use std::path::Path;

/// Trust and question of a command, and the register of its folder of passports, which is read once.
pub(crate) struct Verifier {
    /// Trusted keys, and the lists of withdrawn passports that were given or are in the folder.
    pub trust: Trust,
    pub question: Question,
    pub register: Option<Register>,
}

impl Verifier {
    /// Reads the register of `folder`, if there is one, and its lists of withdrawn passports.
    pub(crate) fn new(trust: Trust, question: Question, folder: Option<&Path>) -> Result<Self, FileError> {
        let Some(folder) = folder else { return Ok(Self { trust, question, register: None }) };
        let asked = Asked::at(question.time);
        let (register, trust) = search::register(folder, trust, &asked, parallel::processors())?;
        Ok(Self { trust, question, register: Some(register) })
    }

    pub(crate) fn verify(&self, name: &str, bytes: &[u8]) -> Verification {
        let verification = verify(name, bytes, &self.trust, &self.question);
        match &self.register {
            Some(register) => register.asked(verification, bytes),
            None => verification,
        }
    }
}
