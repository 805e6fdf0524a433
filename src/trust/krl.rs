//! OpenSSH's binary key revocation list (OpenSSH's PROTOCOL.krl), as far as it revokes plain keys.
//!
//! Certificate sections revoke nothing here, because passports are not signed with certificates. Every byte of them is
//! still read as OpenSSH reads it, because one changed bit can turn a section of fingerprints into a section of
//! certificates. For the same reason, a list is refused that any supported version of OpenSSH refuses, from 9.2 on:
//! extensions (unknown before 9.4), signatures (refused from 9.4 on) and authorities with a DSA or an ML-DSA key.
//! `ssh-keygen` writes neither extensions nor signatures.

use super::wire::{Truncated, Wire};
use crate::text::problem::Problem;
use std::collections::BTreeSet;

/// First bytes of a key revocation list.
pub(super) const MAGIC: &[u8] = b"SSHKRL\n\0";

/// Revoked keys: the keys as SSH transmits them, and SHA-1 and SHA-256 hashes of such keys.
#[derive(Debug, Clone, Default)]
pub(super) struct Revoked {
    pub(super) keys: BTreeSet<Vec<u8>>,
    pub(super) sha1: BTreeSet<Vec<u8>>,
    pub(super) sha256: BTreeSet<Vec<u8>>,
}

impl From<Truncated> for Problem {
    fn from(truncated: Truncated) -> Self {
        refusal(truncated.to_string(), "a whole list")
    }
}

fn refusal(found: impl Into<String>, expected: &str) -> Problem {
    Problem::whole(found, expected, "transfer the list again, or create it again with `ssh-keygen -k`")
}

/// Largest mpint that OpenSSH reads, in bytes without the zero before a number whose highest bit is set.
const LARGEST_MPINT_BYTES: usize = 2048;

/// Smallest modulus of an RSA key that OpenSSH reads, in bytes.
const SMALLEST_RSA_BYTES: usize = 128;

/// First byte of the only form of a point of ECDSA that OpenSSH reads (SEC 1, section 2.3.3).
const UNCOMPRESSED: u8 = 4;

/// Reads a list without skipping any byte.
pub(super) fn read(bytes: &[u8]) -> Result<Revoked, Problem> {
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
    while !wire.rest.is_empty() {
        let at = wire.offset;
        let kind = wire.byte()?;
        let body = wire.nested()?;
        // PROTOCOL.krl, section 1.
        match kind {
            1 => certificates(body)?,
            2 => collect(body, None, &mut revoked.keys)?,
            3 => collect(body, Some(20), &mut revoked.sha1)?,
            5 => collect(body, Some(32), &mut revoked.sha256)?,
            unknown => return Err(unknown_section(unknown, at)),
        }
    }
    Ok(revoked)
}

fn unknown_section(kind: u8, at: usize) -> Problem {
    refusal(format!("a section of type {kind} at byte {at}"), "a section type that OpenSSH reads")
}

/// Collects the strings of a section, each with the given length if any.
fn collect(mut body: Wire, length: Option<usize>, into: &mut BTreeSet<Vec<u8>>) -> Result<(), Problem> {
    while !body.rest.is_empty() {
        let at = body.offset;
        let item = body.string()?;
        if let Some(length) = length.filter(|length| *length != item.len()) {
            let found = format!("a fingerprint of {} bytes at byte {at}", item.len());
            return Err(refusal(found, &format!("{length} bytes")));
        }
        into.insert(item.to_vec());
    }
    Ok(())
}

/// Checks a section of certificates of one or any authority; it revokes no plain key.
fn certificates(mut body: Wire) -> Result<(), Problem> {
    let at = body.offset;
    let authority = body.string()?;
    if !authority.is_empty() && is_authority(authority) != Some(true) {
        let found =
            format!("certificate authority at byte {at}: a damaged key, or one of a type that not every OpenSSH reads");
        return Err(refusal(found, "an RSA, ECDSA or Ed25519 key"));
    }
    let _reserved = body.string()?;
    while !body.rest.is_empty() {
        let at = body.offset;
        let kind = body.byte()?;
        let mut part = body.nested()?;
        // PROTOCOL.krl, section 2: serial numbers one by one, as a range and as a bitmap, and names of certificates.
        match kind {
            0x20 => {
                while !part.rest.is_empty() {
                    serials(part.u64()?, 0, at)?;
                }
            }
            0x21 => {
                let (first, last) = (part.u64()?, part.u64()?);
                serials(first, last.checked_sub(first).ok_or_else(|| bad_serials(at))?, at)?;
            }
            0x22 => bitmap(&mut part, at)?,
            0x23 => {
                while !part.rest.is_empty() {
                    name(&mut part)?;
                }
            }
            unknown => return Err(unknown_section(unknown, at)),
        }
        if !part.rest.is_empty() {
            return Err(refusal(format!("{} unread bytes at byte {}", part.rest.len(), part.offset), "none"));
        }
    }
    Ok(())
}

/// Checks the serial numbers `first` to `first + more`: zero is not allowed, and the last one must fit in 64 bits.
fn serials(first: u64, more: u64, at: usize) -> Result<(), Problem> {
    if first == 0 || first.checked_add(more).is_none() { Err(bad_serials(at)) } else { Ok(()) }
}

fn bad_serials(at: usize) -> Problem {
    refusal(format!("invalid serial numbers at byte {at}"), "numbers from 1 to 2^64 - 1, in order")
}

/// Checks a bitmap of serial numbers, in which bit N means the first number plus N.
fn bitmap(part: &mut Wire, at: usize) -> Result<(), Problem> {
    let (first, bits) = (part.u64()?, part.string()?);
    let significant = mpint(bits).ok_or_else(|| bad_serials(at))?;
    let Some(top) = significant.first() else { return Ok(()) };
    let lowest_is_set = significant.last().is_some_and(|byte| byte & 1 != 0);
    let highest = 8 * significant.len() as u64 - 1 - u64::from(top.leading_zeros());
    // Only set bits are serial numbers; if the lowest bit is not set, the first number is larger than `first`.
    serials(if lowest_is_set { first } else { first.max(1) }, highest, at)
}

/// Returns the bytes of an mpint (RFC 4251, section 5) without zeros before them, or `None` if it is negative or too
/// large for OpenSSH.
fn mpint(bytes: &[u8]) -> Option<&[u8]> {
    let zeros = bytes.iter().take_while(|byte| **byte == 0).count();
    let is_small = bytes.len() <= LARGEST_MPINT_BYTES + usize::from(zeros > 0);
    let is_negative = bytes.first().is_some_and(|byte| byte & 0x80 != 0);
    (is_small && !is_negative).then(|| &bytes[zeros..])
}

/// Returns `Some(true)` if every supported OpenSSH reads the key of an authority; the point of an ECDSA key may lie beside
/// its curve.
fn is_authority(blob: &[u8]) -> Option<bool> {
    let mut wire = Wire::new(blob);
    let algorithm = wire.string().ok()?;
    let first = wire.string().ok()?;
    let is_on = |curve: &[u8], bytes: usize, point: &[u8]| {
        first == curve && point.len() == 1 + 2 * bytes && point[0] == UNCOMPRESSED
    };
    let is_good = match algorithm {
        b"ssh-ed25519" | b"sk-ssh-ed25519@openssh.com" => first.len() == 32,
        b"ssh-rsa" => {
            let (_exponent, modulus) = (mpint(first)?, mpint(wire.string().ok()?)?);
            modulus.len() > SMALLEST_RSA_BYTES || (modulus.len() == SMALLEST_RSA_BYTES && modulus[0] >= 0x80)
        }
        b"ecdsa-sha2-nistp256" | b"sk-ecdsa-sha2-nistp256@openssh.com" => is_on(b"nistp256", 32, wire.string().ok()?),
        b"ecdsa-sha2-nistp384" => is_on(b"nistp384", 48, wire.string().ok()?),
        b"ecdsa-sha2-nistp521" => is_on(b"nistp521", 66, wire.string().ok()?),
        _ => false,
    };
    if algorithm.starts_with(b"sk-") {
        let _application = name(&mut wire).ok()?;
    }
    Some(is_good && wire.rest.is_empty())
}

/// Reads a string that OpenSSH treats as a C string: NUL is allowed only at its end.
fn name<'a>(wire: &mut Wire<'a>) -> Result<&'a [u8], Problem> {
    let at = wire.offset;
    let text = wire.string()?;
    let text = text.strip_suffix(b"\0").unwrap_or(text);
    if text.contains(&0) {
        return Err(refusal(format!("a NUL within the text at byte {at}"), "text without NUL"));
    }
    Ok(text)
}
