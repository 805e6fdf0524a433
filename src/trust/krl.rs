//! OpenSSH's binary key revocation list (OpenSSH's PROTOCOL.krl), as far as it revokes plain keys.
//!
//! Certificate sections revoke nothing here, because no certificate signs a passport, but every byte of them is read as
//! OpenSSH reads it: one changed bit can turn a section of fingerprints into a section of certificates. A signature in
//! the list is refused for the same reason; `ssh-keygen` writes none, and PROTOCOL.krl says that OpenSSH supports none.

use super::public_key::{check_blob, shortened};
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
    pub(super) const SHA256: u8 = 5;
    pub(super) const EXTENSION: u8 = 255;
}

/// Section types inside a section of certificates (PROTOCOL.krl, section 2).
mod certificates {
    pub(super) const SERIAL_LIST: u8 = 0x20;
    pub(super) const SERIAL_RANGE: u8 = 0x21;
    pub(super) const SERIAL_BITMAP: u8 = 0x22;
    pub(super) const KEY_ID: u8 = 0x23;
    pub(super) const EXTENSION: u8 = 0x39;
}

/// The largest bitmap of serial numbers that OpenSSH reads, in bytes.
const LARGEST_BITMAP_BYTES: usize = 2048;

/// Reads a list; every byte of it is accounted for.
pub(super) fn read(bytes: &[u8]) -> Result<Revoked, Refusal> {
    let mut wire = Wire::new(bytes);
    if wire.take(MAGIC.len())? != MAGIC {
        return Err(refusal("other bytes at the beginning", "the beginning of a key revocation list"));
    }
    match wire.u32()? {
        1 => {}
        version => return Err(refusal(format!("format version {version} at byte 8"), "format version 1")),
    }
    let _list_version = wire.u64()?;
    let _generated = wire.u64()?;
    let _flags = wire.u64()?;
    let _reserved = wire.string()?;
    let _comment = name(&mut wire)?;
    let mut revoked = Revoked::default();
    while !wire.is_empty() {
        let at = wire.offset();
        let kind = wire.byte()?;
        let body = wire.nested()?;
        match kind {
            section::CERTIFICATES => certificates(body)?,
            section::EXPLICIT_KEYS => collect(body, None, &mut revoked.keys)?,
            section::SHA1 => collect(body, Some(20), &mut revoked.sha1)?,
            section::SHA256 => collect(body, Some(32), &mut revoked.sha256)?,
            section::EXTENSION => extension(body)?,
            unknown => return Err(unknown_section(unknown, at)),
        }
    }
    Ok(revoked)
}

fn unknown_section(kind: u8, at: usize) -> Refusal {
    refusal(format!("a section of type {kind} at byte {at}"), "a section type that OpenSSH reads")
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

/// A section of certificates of one authority, or of any. None of them revokes a plain key.
fn certificates(mut body: Wire) -> Result<(), Refusal> {
    let at = body.offset();
    let authority = body.string()?;
    if !authority.is_empty() {
        check_blob(authority)
            .map_err(|what| refusal(format!("certificate authority at byte {at}: {what}"), "a public key"))?;
    }
    let _reserved = body.string()?;
    while !body.is_empty() {
        let at = body.offset();
        let kind = body.byte()?;
        let mut part = body.nested()?;
        match kind {
            certificates::SERIAL_LIST => {
                while !part.is_empty() {
                    serials(part.u64()?, 0, at)?;
                }
            }
            certificates::SERIAL_RANGE => {
                let (first, last) = (part.u64()?, part.u64()?);
                serials(first, last.checked_sub(first).ok_or_else(|| bad_serials(at))?, at)?;
            }
            certificates::SERIAL_BITMAP => bitmap(&mut part, at)?,
            certificates::KEY_ID => {
                while !part.is_empty() {
                    name(&mut part)?;
                }
            }
            certificates::EXTENSION => {
                extension(part)?;
                continue;
            }
            unknown => return Err(unknown_section(unknown, at)),
        }
        if !part.is_empty() {
            return Err(refusal(format!("{} unread bytes at byte {}", part.rest().len(), part.offset()), "none"));
        }
    }
    Ok(())
}

/// Serial numbers from `first` on, `more` behind it: zero means that there is none, and the last has to fit 64 bits.
fn serials(first: u64, more: u64, at: usize) -> Result<(), Refusal> {
    if first == 0 || first.checked_add(more).is_none() { Err(bad_serials(at)) } else { Ok(()) }
}

fn bad_serials(at: usize) -> Refusal {
    refusal(format!("invalid serial numbers at byte {at}"), "numbers from 1 to 2^64 - 1, in order")
}

/// A bitmap of serial numbers: an mpint (RFC 4251, section 5) whose bit N is the number N behind the first.
fn bitmap(part: &mut Wire, at: usize) -> Result<(), Refusal> {
    let (first, bits) = (part.u64()?, part.string()?);
    let negative = bits.first().is_some_and(|byte| byte & 0x80 != 0);
    let significant = &bits[bits.iter().take_while(|byte| **byte == 0).count()..];
    let Some(top) = significant.first() else { return Ok(()) };
    if negative || significant.len() > LARGEST_BITMAP_BYTES {
        return Err(bad_serials(at));
    }
    let lowest_is_set = significant.last().is_some_and(|byte| byte & 1 != 0);
    let highest = 8 * significant.len() as u64 - 1 - u64::from(top.leading_zeros());
    // Only a set bit names a number; without the lowest one the numbers begin behind `first`.
    serials(if lowest_is_set { first } else { first.max(1) }, highest, at)
}

/// A string that OpenSSH reads as a C string: a NUL may end it and nothing else.
fn name<'a>(wire: &mut Wire<'a>) -> Result<&'a [u8], Refusal> {
    let at = wire.offset();
    let text = wire.string()?;
    let text = text.strip_suffix(b"\0").unwrap_or(text);
    if text.contains(&0) {
        return Err(refusal(format!("a NUL within the text at byte {at}"), "text without NUL"));
    }
    Ok(text)
}

/// An extension that must be understood is refused, as none is known; any other is passed over.
fn extension(mut body: Wire) -> Result<(), Refusal> {
    let at = body.offset();
    let name = String::from_utf8_lossy(name(&mut body)?).into_owned();
    let critical = body.byte()? != 0;
    let _contents = body.string()?;
    match body.rest().len() {
        _ if critical => {
            Err(refusal(format!("critical extension `{}` at byte {at}", shortened(&name)), "no critical extension"))
        }
        0 => Ok(()),
        more => Err(refusal(format!("{more} bytes after an extension, at byte {}", body.offset()), "nothing")),
    }
}
