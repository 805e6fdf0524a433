//! ZIP archives of deliveries. One from a stranger is refused as a whole unless every byte of it is accounted for: members
//! follow each other without a gap, both of their headers agree, and nothing but regular files of expected names is in it.

use crate::folder::place::numbered;
use crate::register::FILE_NAME;
use crate::text::{Identifier, Printable, printable};
use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fmt::Display;
use std::io::{Cursor, Read, Write};
use zip::read::ZipReadOptions;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

/// Folder of passports in an archive, as in a workspace.
pub(super) const PASSPORTS: &str = "passports";

/// Page that says what to do first.
pub(super) const PAGE: &str = "START-HERE.html";

/// Public keys, for people: a reader takes them from the signatures.
pub(super) const KEYS: &str = "signing_keys.pub";

/// Most bytes of all members, unpacked.
const LARGEST_BYTES: usize = 16 << 20;

/// Most members, with folders.
const MOST_MEMBERS: usize = 200;

/// Most bytes of an archive: stored members, and headers.
pub(crate) const LARGEST_ARCHIVE_BYTES: usize = LARGEST_BYTES + (1 << 20);

/// Record at the end of an archive: signature, and its length without a comment.
const END: (&[u8], usize) = (b"PK\x05\x06", 22);

/// Flags of a member: how it was deflated, a data descriptor, a name in UTF-8.
const KNOWN_FLAGS: u16 = 0x080e;

/// Type of a file in a Unix mode, and those of a regular file and of a folder.
const TYPE: u32 = 0o170_000;
const REGULAR: u32 = 0o100_000;
const FOLDER: u32 = 0o040_000;

/// Reason why an archive is refused as a whole, in words.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub(crate) struct BadArchive(String);

impl From<zip::result::ZipError> for BadArchive {
    fn from(error: zip::result::ZipError) -> Self {
        damaged(Printable(error))
    }
}

fn damaged(why: impl Display) -> BadArchive {
    BadArchive(format!("is not a ZIP archive, or it is damaged ({why})"))
}

fn stray_bytes() -> BadArchive {
    BadArchive("has bytes before, between or after its members".to_owned())
}

fn too_many() -> BadArchive {
    BadArchive(format!("has more than {MOST_MEMBERS} members"))
}

fn too_large() -> BadArchive {
    BadArchive(format!("has members of more than {} MiB in all", LARGEST_BYTES >> 20))
}

fn member(name: &str, why: &str) -> BadArchive {
    BadArchive(format!("member {name}: {why}"))
}

/// Returns the members of an archive.
///
/// # Errors
/// Returns [`BadArchive`] for the first thing that a delivery does not have.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<(Member, Vec<u8>)>, BadArchive> {
    let end = bytes.len().checked_sub(END.1).filter(|end| bytes[*end..].starts_with(END.0));
    let end = end.ok_or_else(|| damaged("it does not end as one, or has bytes after its end"))?;
    // With this record at the end there is no comment.
    let number = |at: usize| usize::from(u16::from_le_bytes([bytes[at], bytes[at + 1]]));
    let long = |at: usize| number(at) | number(at + 2) << 16;
    // The counts on this disk and in all, and what the directory's length and place leave to the end.
    if number(end + 8) > MOST_MEMBERS || number(end + 10) > MOST_MEMBERS {
        return Err(too_many());
    }
    let directory = long(end + 16);
    if directory.checked_add(long(end + 12)) != Some(end) {
        return Err(stray_bytes());
    }
    let mut archive = ZipArchive::new(Cursor::new(bytes))?;
    let is_at_its_place = archive.offset() == 0 && archive.central_directory_start() == directory as u64;
    if !is_at_its_place || archive.len() != number(end + 10) {
        return Err(stray_bytes());
    }
    let mut ranges = Vec::new();
    for index in 0..archive.len() {
        let entry = archive.by_index_data(index)?;
        let name = printable(String::from_utf8_lossy(entry.name_raw()));
        if entry.encrypted() {
            return Err(member(&name, "is encrypted"));
        }
        if ![CompressionMethod::Stored, CompressionMethod::Deflated].contains(&entry.compression()) {
            return Err(member(&name, "is compressed by another method than deflate"));
        }
        ranges.push((entry.header_start() as usize, entry.compressed_size() as usize));
    }
    archive.validate_header_consistency()?;
    check_bytes(bytes, ranges, directory)?;
    let (mut members, mut names, mut left) = (Vec::new(), BTreeSet::new(), LARGEST_BYTES);
    for index in 0..archive.len() {
        let options = ZipReadOptions::new().enforce_header_consistency(true);
        let mut file = archive.by_index_with_options(index, options)?;
        let raw = file.name_raw().to_vec();
        let name = printable(String::from_utf8_lossy(&raw));
        if !names.insert(raw.to_ascii_lowercase()) {
            return Err(member(&name, "another one has this name, or differs from it only in case"));
        }
        let due = if file.is_dir() { FOLDER } else { REGULAR };
        if file.unix_mode().is_some_and(|mode| ![0, due].contains(&(mode & TYPE))) || file.is_dir() && file.size() > 0 {
            return Err(member(&name, "is not a regular file"));
        }
        let unknown = || member(&name, "no file of this name belongs in a delivery");
        let place = std::str::from_utf8(&raw).ok().and_then(place_of).ok_or_else(unknown)?;
        let stated = usize::try_from(file.size()).ok().filter(|size| *size <= left).ok_or_else(too_large)?;
        let mut content = Vec::new();
        // One byte more than stated shows that the statement is false.
        let unpacked = (&mut file).take(stated as u64 + 1).read_to_end(&mut content);
        unpacked.map_err(|error| damaged(format_args!("{name}: {error}")))?;
        if content.len() != stated {
            return Err(member(&name, "its length is not the one that is stated"));
        }
        left -= stated;
        members.push((place, content));
    }
    Ok(members)
}

/// Checks that members, each with the places of its header and its length, follow each other from the first byte to the
/// directory, with a data descriptor after one whose header announces it.
fn check_bytes(bytes: &[u8], mut members: Vec<(usize, usize)>, directory: usize) -> Result<(), BadArchive> {
    members.sort_unstable();
    let mut at = 0;
    for (index, (start, length)) in members.iter().enumerate() {
        let header = bytes.get(*start..*start + 30).filter(|_| *start == at).ok_or_else(stray_bytes)?;
        if u16::from_le_bytes([header[6], header[7]]) & !KNOWN_FLAGS != 0 {
            return Err(damaged("it has flags of no known meaning"));
        }
        let variable = [26, 28].map(|at| usize::from(u16::from_le_bytes([header[at], header[at + 1]])));
        at = start + 30 + variable.iter().sum::<usize>() + length;
        let next = members.get(index + 1).map_or(directory, |(start, _)| *start);
        // CRC and two lengths, with or without a signature.
        if header[6] & 8 != 0 {
            at += [12, 16].into_iter().find(|length| at + length == next).ok_or_else(stray_bytes)?;
        }
    }
    if at == directory { Ok(()) } else { Err(stray_bytes()) }
}

/// Returns an archive with these members, the same bytes at any time.
///
/// # Errors
/// Returns [`BadArchive`] if there are more members or bytes than a reader takes.
pub(super) fn write(members: &[(String, Vec<u8>)]) -> Result<Vec<u8>, BadArchive> {
    if members.len() > MOST_MEMBERS {
        return Err(too_many());
    }
    if members.iter().map(|(_, bytes)| bytes.len()).sum::<usize>() > LARGEST_BYTES {
        return Err(too_large());
    }
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated).unix_permissions(0o644);
    for (name, bytes) in members {
        archive.start_file(name.as_str(), options)?;
        archive.write_all(bytes).map_err(damaged)?;
    }
    Ok(archive.finish()?.into_inner())
}

/// What a member of an archive is by its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Member {
    /// Register of a stand, `<model>/<serial>`.
    Register(String),
    /// Passport of a stand, with its name.
    Passport(String, String),
    /// Folder, or file for people, of which nothing is taken.
    Other,
}

/// Returns what has this name, or `None` if nothing in a delivery has it.
pub(super) fn place_of(name: &str) -> Option<Member> {
    if [PAGE, KEYS].contains(&name) {
        return Some(Member::Other);
    }
    let names: Vec<&str> = name.strip_suffix('/').unwrap_or(name).split('/').collect();
    let (first, inner) = names.split_first()?;
    let is_good = *first == PASSPORTS && inner.iter().all(|name| Identifier::new(name).is_ok());
    match *inner {
        _ if !is_good => None,
        [] | [_] | [_, _] if name.ends_with('/') => Some(Member::Other),
        [model, serial, FILE_NAME] if !name.ends_with('/') => Some(Member::Register(format!("{model}/{serial}"))),
        [model, serial, file] if !name.ends_with('/') && numbered(OsStr::new(file)).is_some() => {
            Some(Member::Passport(format!("{model}/{serial}"), file.to_owned()))
        }
        _ => None,
    }
}

/// Returns the name of a file of a stand in an archive.
pub(super) fn name_of(stand: &str, file: &str) -> String {
    format!("{PASSPORTS}/{stand}/{file}")
}
