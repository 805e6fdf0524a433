//! Succession of registers: a later one has every entry of an earlier one, and takes nothing back.

use super::{Register, State, VerifiedRegister};

/// Difference between two registers of a stand, neither of which continues the other, in words.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Contradiction(String);

impl State {
    /// Returns `true` if a passport in this state may later be in the state `later`.
    fn may_become(self, later: Self) -> bool {
        self == later || self == Self::Current || later == Self::Withdrawn
    }
}

impl Register {
    /// Returns what shows that this register does not continue an `earlier` one, or `None` if it does: it has every
    /// entry of that one, in the same order, and no state has gone back.
    fn breaks(&self, earlier: &Self) -> Option<String> {
        if self.header().stand != earlier.header().stand {
            return Some(format!("it is of another stand, {}", self.header().stand));
        }
        if self.header().issued_at < earlier.header().issued_at {
            return Some("it was issued earlier".to_owned());
        }
        let mut later = self.passports.iter();
        for old in &earlier.passports {
            let Some(new) = later.find(|new| new.id == old.id) else {
                return Some(format!("{} is missing, or out of order", old.id));
            };
            if new.sha256 != old.sha256 {
                return Some(format!("{} has another SHA-256", old.id));
            }
            if !old.state.may_become(new.state) {
                return Some(format!("{} was {} and is {}", old.id, old.state.key(), new.state.key()));
            }
        }
        None
    }
}

impl VerifiedRegister {
    /// Checks that this register is the same as `other`, or that the one with the higher sequence number continues the
    /// other.
    ///
    /// # Errors
    /// Returns [`Contradiction`] if the registers have one number and different bytes, or if the later one lacks an entry
    /// or takes a state back.
    pub fn agree(&self, other: &Self) -> Result<(), Contradiction> {
        let same = self.header().sequence == other.header().sequence;
        let (later, earlier) =
            if self.header().sequence >= other.header().sequence { (self, other) } else { (other, self) };
        let what = match same {
            true if self.sha256 == other.sha256 => return Ok(()),
            true => "two registers have the same number".to_owned(),
            false => match later.content().breaks(earlier.content()) {
                None => return Ok(()),
                Some(what) => what,
            },
        };
        let [one, other] = [later, earlier].map(|of| format!("{} (SHA-256 {})", of.header().sequence, of.sha256));
        Err(Contradiction(format!(
            "sequence {one} does not continue sequence {other}: {what}; ask the factory, which can join them with `register \
             DIR --renew --with OTHER`"
        )))
    }
}
