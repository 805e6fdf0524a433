//! OpenSSH's binary key revocation list (OpenSSH's PROTOCOL.krl), as far as it revokes plain keys.
//!
//! Certificate sections are passed over: no certificate signs a passport. Signatures in the list are passed over too, as
//! its place among the trust files is what makes it trusted.

use super::wire::{Truncated, Wire};
use std::collections::BTreeSet;

/// What a key revocation list begins with.
pub(super) const MAGIC: &[u8] = b"SSHKRL\n\0";

/// The keys that are revoked: themselves, or by the hash of what SSH transmits of them.
#[derive(Debug, Clone, Default)]
pub(super) struct Revoked {
    pub(super) keys: BTreeSet<Vec<u8>>,
    pub(super) sha1: BTreeSet<Vec<u8>>,
    pub(super) sha256: BTreeSet<Vec<u8>>,
}

/// What was found in place of what was expected.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Refusal {
    pub(super) found: String,
    pub(super) expected: String,
}

impl From<Truncated> for Refusal {
    fn from(truncated: Truncated) -> Self {
        refusal(truncated.to_string(), "a whole list")
    }
}

fn refusal(found: impl Into<String>, expected: impl Into<String>) -> Refusal {
    Refusal { found: found.into(), expected: expected.into() }
}

/// Section types (PROTOCOL.krl, section 1).
mod section {
    pub(super) const CERTIFICATES: u8 = 1;
    pub(super) const EXPLICIT_KEYS: u8 = 2;
    pub(super) const SHA1: u8 = 3;
    pub(super) const SIGNATURE: u8 = 4;
    pub(super) const SHA256: u8 = 5;
    pub(super) const EXTENSION: u8 = 255;
}

/// Reads a list; every byte of it is accounted for.
pub(super) fn read(bytes: &[u8]) -> Result<Revoked, Refusal> {
    let mut wire = Wire::new(bytes);
    if wire.take(MAGIC.len())? != MAGIC {
        return Err(refusal("other bytes at its beginning", "the beginning of a key revocation list"));
    }
    match wire.u32()? {
        1 => {}
        version => return Err(refusal(format!("format version {version} at byte 8"), "format version 1")),
    }
    let _list_version = wire.u64()?;
    let _generated = wire.u64()?;
    let _flags = wire.u64()?;
    let _reserved = wire.string()?;
    let _comment = wire.string()?;
    let mut revoked = Revoked::default();
    let mut signed = false;
    while !wire.is_empty() {
        let at = wire.offset();
        let kind = wire.byte()?;
        let body = wire.nested()?;
        if signed && kind != section::SIGNATURE {
            return Err(refusal(
                format!("a section behind the signature, at byte {at}"),
                "only further signatures there",
            ));
        }
        match kind {
            section::CERTIFICATES => {}
            section::EXPLICIT_KEYS => collect(body, None, &mut revoked.keys)?,
            section::SHA1 => collect(body, Some(20), &mut revoked.sha1)?,
            section::SHA256 => collect(body, Some(32), &mut revoked.sha256)?,
            section::SIGNATURE => {
                // Its body is the key; the signature follows as a second string.
                let _signature = wire.string()?;
                signed = true;
            }
            section::EXTENSION => extension(body)?,
            unknown => {
                return Err(refusal(format!("a section of type {unknown} at byte {at}"), "a known type of section"));
            }
        }
    }
    Ok(revoked)
}

/// The strings of a section, each of the length given.
fn collect(mut body: Wire, length: Option<usize>, into: &mut BTreeSet<Vec<u8>>) -> Result<(), Refusal> {
    while !body.is_empty() {
        let at = body.offset();
        let item = body.string()?;
        if let Some(length) = length.filter(|length| *length != item.len()) {
            let found = format!("a fingerprint of {} bytes at byte {at}", item.len());
            return Err(refusal(found, format!("{length} bytes")));
        }
        into.insert(item.to_vec());
    }
    Ok(())
}

/// An extension that must be understood is refused, as none is known; any other is passed over.
fn extension(mut body: Wire) -> Result<(), Refusal> {
    let at = body.offset();
    let name = String::from_utf8_lossy(body.string()?).into_owned();
    let critical = body.byte()? != 0;
    let _contents = body.string()?;
    match body.rest().len() {
        _ if critical => Err(refusal(
            format!("the critical extension `{}` at byte {at}", super::public_key::shortened(&name)),
            "no extension that must be understood",
        )),
        0 => Ok(()),
        more => Err(refusal(format!("{more} bytes behind an extension, at byte {}", body.offset()), "nothing there")),
    }
}
