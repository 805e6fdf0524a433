//! A delivery from the factory to the laboratory, and archives that no factory made.

use crate::place::Place;
use crate::programs;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Types a line at a terminal, a real one of util-linux's `script`; returns the exit code and what the terminal shows.
fn typed(place: &Place, arguments: &str, line: &str) -> (Option<i32>, String) {
    let command = format!("'{}' {arguments}", env!("CARGO_BIN_EXE_dtg-passport"));
    let mut script = Command::new("script");
    script.args(["--quiet", "--return", "--command", &command, "/dev/null"]).current_dir(place.path(""));
    script.env("DTG_PASSPORT_BROWSER", "no-browser-of-this-name").stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut running = script.spawn().expect("`script` of util-linux runs");
    running.stdin.take().unwrap().write_all(format!("{line}\n").as_bytes()).unwrap();
    let output = running.wait_with_output().unwrap();
    (output.status.code(), String::from_utf8_lossy(&output.stdout).into_owned())
}

#[test]
fn a_fingerprint_is_typed_at_a_terminal() {
    let (place, fingerprint) = Place::with_delivery("SPS-2/0017/moscow-bmstu");
    let before = place.files();
    let one_off = format!("{}{}", &fingerprint[..49], if fingerprint.ends_with('A') { 'B' } else { 'A' });
    for line in ["", "yes", &one_off, &fingerprint[7..], &fingerprint.to_lowercase()] {
        let (code, shown) = typed(&place, "receive d.zip lab", line);
        assert!(code == Some(1) && shown.contains("as the factory told it"), "{line}: {shown}");
        // The terminal echoes what was typed.
        assert!(line == &fingerprint[7..] || !shown.contains(&fingerprint[7..]), "{line}: {shown}");
        assert!(place.files() == before, "{line}");
    }
    let (code, shown) = typed(&place, "receive d.zip lab", &format!(" {fingerprint} "));
    assert_eq!(code, Some(0), "{shown}");
    place.good("verify SPS-2/0017/moscow-bmstu/1 --workspace lab");
}

/// Returns the files of a test without the pages, which state the time of the verification.
fn without_pages(place: &Place) -> BTreeMap<PathBuf, Vec<u8>> {
    place.files().into_iter().filter(|(path, _)| !path.iter().any(|name| name == "pages")).collect()
}

/// Packs or unpacks an archive with Python's `zipfile`, a reader and writer of its own.
fn python(script: &str, arguments: &[&Path]) {
    programs::output(programs::python().args(["-c", script]).args(arguments));
}

fn unpacked(archive: &Path) -> BTreeMap<String, Vec<u8>> {
    let place = Place::empty();
    let root = place.path("");
    python("import sys, zipfile; zipfile.ZipFile(sys.argv[1]).extractall(sys.argv[2])", &[archive, &root]);
    let name = |path: &Path| path.strip_prefix(&root).unwrap().to_str().unwrap().replace('\\', "/");
    place.files().iter().map(|(path, bytes)| (name(path), bytes.clone())).collect()
}

/// The members of an archive, to be packed again.
fn members(archive: &Path) -> Vec<Entry> {
    unpacked(archive).iter().map(|(name, bytes)| entry(name.as_str(), bytes)).collect()
}

#[test]
fn a_laboratory_gets_its_stand_alone() {
    let place = Place::new();
    let said = place.good("deliver SPS-2/0017/moscow-bmstu -o d.zip --workspace factory");
    let fingerprint = place.fingerprint("factory/factory.key.pub");
    assert!(said.contains(&fingerprint), "{said}");
    let stand = "passports/SPS-2/0017";
    let unpacked = unpacked(&place.path("d.zip"));
    let (passport, register) = (format!("{stand}/moscow-bmstu-1.yaml"), format!("{stand}/register.yaml"));
    let names: Vec<&str> = unpacked.keys().map(String::as_str).collect();
    assert_eq!(names, ["START-HERE.html", &passport, &register, "signing_keys.pub"]);
    let key = place.read("factory/factory.key.pub");
    assert_eq!(unpacked["signing_keys.pub"], key.as_bytes());
    for (name, bytes) in &unpacked {
        assert!(!String::from_utf8_lossy(bytes).contains(&fingerprint[7..]), "{name} has the fingerprint");
    }
    let page = String::from_utf8(unpacked["START-HERE.html"].clone()).unwrap();
    assert!(page.contains("fingerprint") && page.contains("отпечаток"), "{page}");
    place.good("deliver SPS-2/0017/moscow-bmstu -o again.zip --workspace factory");
    assert_eq!(fs::read(place.path("again.zip")).unwrap(), fs::read(place.path("d.zip")).unwrap());

    // Nothing is believed, written or shown before the fingerprint is given.
    let before = place.files();
    let other = "SHA256:AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA";
    for given in ["", "--new-key", &format!("--fingerprint {other}"), "--format json"] {
        let said = place.refused(&format!("receive d.zip lab {given}"), "nothing was written");
        assert!(!said.contains(&fingerprint[7..]), "{given}: {said}");
        assert_eq!(place.files(), before, "{given}");
    }

    let received = place.json(&format!("receive d.zip lab --fingerprint {fingerprint}"), 0);
    assert_eq!((&received["made"], &received["keys"][0]["fingerprint"]), (&true.into(), &fingerprint.as_str().into()));
    for name in [&passport, &register] {
        assert_eq!(place.read(format!("lab/{name}")), place.read(format!("factory/{name}")), "{name}");
    }
    assert!(!place.path(format!("lab/{stand}/torino-inrim-1.yaml")).exists());
    let bare: Vec<&str> = key.split(' ').take(2).collect();
    let line = format!("factory@example.org namespaces=\"dtg-passport,dtg-register\" {}\n", bare.join(" "));
    assert_eq!(place.read("lab/allowed_signers"), line);
    let settings = place.read("lab/dtg-passport.toml");
    assert!(settings.contains("\nstand = [\"SPS-2/0017\"]\n"), "{settings}");
    assert!(!settings.lines().any(|line| line.starts_with("at ")), "a person states the place");
    assert!(place.read("lab/pages/SPS-2/0017/moscow-bmstu-1.html").contains("moscow-bmstu"));
    place.good("verify SPS-2/0017/moscow-bmstu/1 --workspace lab");
    // Again, it needs no fingerprint and changes nothing.
    let before = without_pages(&place);
    place.good("receive d.zip lab");
    assert!(without_pages(&place) == before);
}

#[test]
fn only_what_is_in_force_and_fresh_is_handed_over() {
    let place = Place::new();
    place.refused("deliver SPS-2/0019 -o d.zip --workspace factory", "register.yaml: missing");
    place.refused("deliver SPS-2/0017/samara -o d.zip --workspace factory", "no passport is in force");
    place.good("revoke SPS-2/0017/torino-inrim/1 --reason moved --workspace factory");
    let words = "no passport is in force (SPS-2/0017/torino-inrim/1 is withdrawn)";
    place.refused("deliver SPS-2/0017/torino-inrim -o d.zip --workspace factory", words);
    place.refused("deliver SPS-2/0017 -o d.zip --time 2031-01-01 --workspace factory", "valid until 2028-11-01");
    place.good("register factory/passports --renew --fresh-until 2026-01-01 --workspace factory");
    place.refused("deliver SPS-2/0017 -o d.zip --workspace factory", "fresh until 2026-01-01");
    place.write("factory/passports/SPS-2/0018/moscow-bmstu-1.yaml", "format: \"dtg-passport/1\"\n");
    place.refused("deliver SPS-2/0018 -o d.zip --workspace factory", "nothing was handed over");
    assert!(!place.path("d.zip").exists());
}

/// A header of a member; those of the file and of the directory are alike, unless a test changes one.
#[derive(Clone)]
struct Header {
    name: Vec<u8>,
    flags: u16,
    method: u16,
    crc: u32,
    packed: u32,
    size: u32,
    extra: Vec<u8>,
}

/// A member of an archive, with every field in the hand of the test. Expected: APPNOTE.TXT of PKWARE, 4.3 and 4.4.
#[derive(Clone)]
struct Entry {
    local: Header,
    listed: Header,
    data: Vec<u8>,
    /// Mode of Unix, in the upper half of the external attributes.
    mode: u32,
    /// Bytes before the header.
    before: Vec<u8>,
    is_listed: bool,
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes
        .iter()
        .fold(!0, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), |crc, _| (crc >> 1) ^ (0xedb8_8320 * (crc & 1))))
}

fn entry(name: impl Into<Vec<u8>>, data: &[u8]) -> Entry {
    let size = u32::try_from(data.len()).unwrap();
    let header =
        Header { name: name.into(), flags: 0, method: 0, crc: crc32(data), packed: size, size, extra: Vec::new() };
    Entry {
        local: header.clone(),
        listed: header,
        data: data.to_vec(),
        mode: 0o100_644,
        before: Vec::new(),
        is_listed: true,
    }
}

impl Entry {
    /// Changes both headers.
    fn both(mut self, change: impl Fn(&mut Header)) -> Self {
        change(&mut self.local);
        change(&mut self.listed);
        self
    }

    fn local(mut self, change: impl Fn(&mut Header)) -> Self {
        change(&mut self.local);
        self
    }
}

impl Header {
    fn bytes(&self) -> Vec<u8> {
        let length = u16::try_from(self.name.len()).unwrap();
        let mut bytes = [20u16, self.flags, self.method, 0, 0x21].map(u16::to_le_bytes).concat();
        bytes.extend([self.crc, self.packed, self.size].map(u32::to_le_bytes).concat());
        let extra = u16::try_from(self.extra.len()).unwrap();
        bytes.extend([length, extra].map(u16::to_le_bytes).concat());
        bytes
    }
}

/// An archive of these members with `count` in its last record, and `comment`.
fn archive_of(entries: &[Entry], count: usize, comment: &[u8]) -> Vec<u8> {
    let (mut file, mut directory) = (Vec::new(), Vec::new());
    for entry in entries {
        file.extend(&entry.before);
        let start = u32::try_from(file.len()).unwrap();
        let local = &entry.local;
        file.extend([b"PK\x03\x04", local.bytes().as_slice(), &local.name, &local.extra, &entry.data].concat());
        if entry.is_listed {
            directory
                .extend([b"PK\x01\x02".as_slice(), &(3u16 << 8 | 20).to_le_bytes(), &entry.listed.bytes()].concat());
            directory.extend([0u16, 0, 0].map(u16::to_le_bytes).concat());
            directory.extend([entry.mode << 16, start].map(u32::to_le_bytes).concat());
            directory.extend([entry.listed.name.as_slice(), &entry.listed.extra].concat());
        }
    }
    let [count, length] = [count, comment.len()].map(|number| u16::try_from(number).unwrap());
    let [size, start] = [directory.len(), file.len()].map(|number| u32::try_from(number).unwrap());
    file.extend([directory.as_slice(), b"PK\x05\x06"].concat());
    file.extend([0u16, 0, count, count].map(u16::to_le_bytes).concat());
    file.extend([size, start].map(u32::to_le_bytes).concat());
    file.extend([length.to_le_bytes().as_slice(), comment].concat());
    file
}

fn archive(entries: &[Entry]) -> Vec<u8> {
    archive_of(entries, entries.iter().filter(|entry| entry.is_listed).count(), b"")
}

/// Zeros, deflated by zlib: a thousandth of their length.
fn zeros(length: usize) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("deflated");
    let script = format!(
        "import sys, zlib; c = zlib.compressobj(9, zlib.DEFLATED, -15)\n\
         open(sys.argv[1], 'wb').write(c.compress(bytes({length})) + c.flush())"
    );
    python(&script, &[&path]);
    fs::read(path).unwrap()
}

/// Archives that no factory made, each with what is wrong in it; `good` are the members of a good one, `other` those of a good
/// one of another factory. Variants of one kind have the same words.
fn hostile(good: &[Entry], other: &[Entry]) -> Vec<(String, Vec<u8>)> {
    let mut all = Vec::new();
    let mut add = |what: &str, bytes: Vec<u8>| all.push((what.to_owned(), bytes));
    let with = |more: Entry| archive(&[good, &[more]].concat());
    let page = b"<p>hello</p>";
    let long = [b"passports/SPS-2/0017/".as_slice(), &[b'x'; 300], b"-1.yaml"].concat();
    let longest = vec![b'x'; 0xffff];
    let names: [&[u8]; 57] = [
        b"passports/SPS-2/0017/moscow-bmstu-1.yaml/",
        "..\u{ff0f}outside".as_bytes(),
        "passports/SPS-2/0017/\u{202e}lmay.1-x".as_bytes(),
        "passports/SPS-2/0017/e\u{301}-1.yaml".as_bytes(),
        b"passports/SPS-2/0017/x-1.yaml.",
        b"passports/SPS-2/0017/x-1.yaml ",
        b" passports/SPS-2/0017/x-1.yaml",
        b"passports/SPS-2/0017/x-1.yaml:stream",
        b"passports/SPS-2/0017/x-1.YAML",
        b"passports/SPS-2/0017/x--1.yaml",
        b"passports/SPS-2/0017/-1.yaml",
        b"passports/SPS-2/0017/x-0.yaml",
        b"passports/SPS-2/0017/x-01.yaml",
        b"passports/SPS-2/0017/x-99999999999.yaml",
        b"passports/SPS-2/0017/.register.lock",
        b"passports/SPS-2/0017/$(touch outside)-1.yaml",
        b"passports/SPS-2/0017/%2e%2e%2foutside-1.yaml",
        b"passports/SPS-2/0017\\x-1.yaml",
        b"passports/SPS-2/0017/\x1b[2J-1.yaml",
        b"passports/../passports/SPS-2/0017/x-1.yaml",
        b"PASSPO~1/SPS-2/0017/x-1.yaml",
        b"\\\\host\\share\\outside",
        b"\\\\?\\C:\\outside",
        b"/dev/stdout",
        b"..\xc0\xafoutside",
        b".git/hooks/post-checkout",
        b"pages/SPS-2/0017/moscow-bmstu-1.html",
        b"results/4711-2026-11-02.json",
        b"..",
        &long,
        &longest,
        b"../outside",
        b"passports/../../outside",
        b"/tmp/outside",
        b"//host/outside",
        b"..\\outside",
        b"C:\\outside",
        b"C:outside",
        b"passports/SPS-2/0017/../../../outside",
        b"passports/SPS-2/0017/\xff-1.yaml",
        b"passports/SPS-2/0017/\xd0\xb0-1.yaml",
        b"passports/SPS-2/0017/a\0-1.yaml",
        b"passports/SPS-2/0017/moscow\n-1.yaml",
        b"passports/CON/0017/x-1.yaml",
        b"",
        b".",
        b"/",
        b"passports/SPS-2/0017/./x-1.yaml",
        b"passports//0017/x-1.yaml",
        b"allowed_signers",
        b"dtg-passport.toml",
        b"registers/SPS-2/0017.yaml",
        b"passports/SPS-2/0017/x.yaml",
        b"passports/x-1.yaml",
        b"passports/SPS-2/0017/stand.yaml",
        b"passports/SPS-2/0017/deep/x-1.yaml",
        b"~/outside",
    ];
    for name in names {
        add(&format!("the name {:?}", String::from_utf8_lossy(name)), with(entry(name, page)));
    }
    let first = good[0].clone();
    let changed = |change: &dyn Fn(Entry) -> Entry| {
        let mut entries = good.to_vec();
        entries[0] = change(entries[0].clone());
        archive(&entries)
    };
    for (what, mode) in
        [("a link", 0o120_777), ("a pipe", 0o010_644), ("a device", 0o020_644), ("a folder's mode", 0o040_755)]
    {
        add(what, changed(&|entry| Entry { mode, ..entry }));
    }
    add(
        "a link of another name",
        with(Entry { mode: 0o120_777, ..entry("passports/SPS-2/0017/x-1.yaml", b"../../../outside") }),
    );
    add("a folder with content", with(entry("passports/", page)));
    add("a name twice", with(first.clone()));
    let upper = |header: &mut Header| header.name.make_ascii_uppercase();
    add("a name twice, in upper case", with(first.clone().both(upper)));
    add("another name in the file", changed(&|entry| entry.local(|header| header.name[0] = b'X')));
    add("a longer name in the file", changed(&|entry| entry.local(|header| header.name.push(b'X'))));
    add("another method in the file", changed(&|entry| entry.local(|header| header.method = 8)));
    add("another length in the file", changed(&|entry| entry.local(|header| header.size += 1)));
    add("another packed length in the file", changed(&|entry| entry.local(|header| header.packed -= 1)));
    add("another CRC in the file", changed(&|entry| entry.local(|header| header.crc ^= 1)));
    add("other flags in the file", changed(&|entry| entry.local(|header| header.flags = 1)));
    add("a wrong CRC", changed(&|entry| entry.both(|header| header.crc ^= 1)));
    add("a wrong length", changed(&|entry| entry.both(|header| header.size += 1)));
    add("encryption", changed(&|entry| entry.both(|header| header.flags |= 1)));
    add("strong encryption", changed(&|entry| entry.both(|header| header.flags |= 0x41)));
    for method in [1, 6, 9, 12, 14, 93, 95, 98, 99] {
        add("another compression", changed(&|entry| entry.both(|header| header.method = method)));
    }
    add("stored bytes that claim to be deflated", changed(&|entry| entry.both(|header| header.method = 8)));
    let deflated = |data: &[u8], length: usize, stated: u32| {
        let crc = crc32(&vec![0; length]);
        let first = entry("START-HERE.html", data);
        let first = first.both(|header| (header.method, header.size, header.crc) = (8, stated, crc));
        archive(&[&[first], &good[1..]].concat())
    };
    let of_zeros = |length: usize, stated: u32| deflated(&zeros(length), length, stated);
    add("a bomb of 17 MiB", of_zeros(17 << 20, 17 << 20));
    add("a bomb that claims to be small", of_zeros(17 << 20, 1000));
    add("a bomb that claims 4 GiB", of_zeros(1 << 20, u32::MAX));
    let many: Vec<Entry> =
        (0..200).map(|number| entry(format!("passports/SPS-2/0017/s{number}-1.yaml"), b"x")).collect();
    add("204 members", archive(&[good, &many].concat()));
    let large = vec![b' '; 9 << 20];
    let two = ["passports/SPS-2/0017/a-1.yaml", "passports/SPS-2/0017/b-1.yaml"].map(|name| entry(name, &large));
    add("18 MiB, stored", archive(&[good, &two].concat()));
    let whole = archive(good);
    add("bytes after the end", [&whole, b"x".as_slice()].concat());
    add("another archive after the end", [whole.clone(), whole.clone()].concat());
    add("bytes before the beginning", [b"#!/bin/sh\n".as_slice(), &whole].concat());
    add("bytes between members", changed(&|entry| Entry { before: b"x".to_vec(), ..entry }));
    add("a comment", archive_of(good, good.len(), b"hello"));
    add("a comment that is an end", archive_of(good, good.len(), &whole[whole.len() - 22..]));
    add("fewer members than counted", archive_of(good, good.len() + 1, b""));
    add("more members than counted", archive_of(good, good.len() - 1, b""));
    add("a member that is not listed", {
        let hidden = Entry { is_listed: false, ..entry("../outside", page) };
        archive(&[good, &[hidden]].concat())
    });
    add("no member", archive(&[]));
    add("no archive", b"hello".to_vec());
    add("an empty file", Vec::new());
    for cut in [1, 4, 22, 40, 100, whole.len() / 2, whole.len() - 4] {
        add("an end that is cut off", whole[..whole.len() - cut].to_vec());
    }
    // Two names for the bytes of one member.
    let mut twice = whole.clone();
    let start = u32::from_le_bytes(whole[whole.len() - 6..whole.len() - 2].try_into().unwrap()) as usize;
    let second = start + 46 + good[0].listed.name.len();
    twice.copy_within(start + 42..start + 46, second + 42);
    add("two members in the same bytes", twice);
    // The size of the directory and its place, which say that there is a larger record elsewhere.
    let mut sixty_four = whole.clone();
    let at = sixty_four.len() - 14;
    sixty_four[at..at + 12].fill(0xff);
    add("a promise of ZIP64", sixty_four);
    let extra = |bytes: &[u8]| changed(&|entry| entry.both(|header| header.extra = bytes.to_vec()));
    let path = [b"\x75\x70\x0f\x00\x01".as_slice(), &crc32(&first.listed.name).to_le_bytes(), b"../outside"].concat();
    add("another name as an extra field", extra(&path));
    let huge = [b"\x01\x00\x10\x00".as_slice(), &[0, 0, 0, 0, 0, 1, 0, 0].repeat(2)].concat();
    add("lengths of 1 TiB in an extra field of ZIP64", {
        changed(&|entry| {
            entry.both(|header| {
                (header.packed, header.size, header.extra) = (u32::MAX, u32::MAX, huge.clone());
            })
        })
    });
    add("an extra field of AES", extra(b"\x01\x99\x07\x00\x02\x00AE\x03\x00\x00"));
    add("an extra field that does not end", extra(b"\x55\x54\xff\xff"));
    let descriptor = |bytes: &[u8]| {
        changed(&|entry| {
            let mut entry = entry.both(|header| header.flags |= 8);
            (entry.local.crc, entry.local.packed, entry.local.size) = (0, 0, 0);
            entry.data.extend(bytes);
            entry
        })
    };
    let stated = [first.listed.crc ^ 1, first.listed.packed, first.listed.size].map(u32::to_le_bytes).concat();
    add("a promise of a descriptor", descriptor(b""));
    add("a descriptor with another CRC", descriptor(&[b"PK\x07\x08", stated.as_slice()].concat()));
    for (what, flag) in [("patched data", 1 << 5), ("masked headers", 1 << 13)] {
        add(what, changed(&|entry| entry.both(|header| header.flags |= flag)));
    }
    let packed = zeros(5000);
    add("a deflated member that is cut", deflated(&packed[..packed.len() - 3], 5000, 5000));
    add("bytes after a deflated member", deflated(&[packed.as_slice(), b"more"].concat(), 5000, 5000));
    add("a deflated member that is shorter than stated", deflated(&packed, 5001, 5001));
    add("a deflated member that is longer than stated", deflated(&packed, 4999, 4999));
    add("a block of no known kind", deflated(&[0b110; 50], 5000, 5000));
    add("deflated bytes from before the beginning", deflated(&[0x63, 0x02, 0x01, 0x00], 5, 5));
    // Numbers of the end record and of the directory. Expected: APPNOTE.TXT, 4.3.12 and 4.3.16.
    let end = whole.len() - 22;
    let patched = |at: usize, bytes: &[u8]| {
        let mut patched = whole.clone();
        patched[at..at + bytes.len()].copy_from_slice(bytes);
        patched
    };
    let length = u32::try_from(whole.len()).unwrap();
    add("no signature of the end", patched(end, b"PK\x05\x07"));
    add("no signature of the directory", patched(start, b"PK\x01\x03"));
    add("no signature of a member", patched(0, b"PK\x03\x05"));
    add("a further disk", patched(end + 4, &[1, 0]));
    add("a directory on a further disk", patched(end + 6, &[1, 0]));
    add("a member on a further disk", patched(start + 34, &[1, 0]));
    add("another number of members on this disk", patched(end + 8, &[1, 0]));
    add("a directory without length", patched(end + 12, &[0; 4]));
    add("a directory that is longer than the file", patched(end + 12, &length.to_le_bytes()));
    add("a directory behind the end", patched(end + 16, &length.to_le_bytes()));
    add("a directory at another place", patched(end + 16, &(u32::try_from(start).unwrap() - 1).to_le_bytes()));
    add("a comment that is longer than the file", patched(end + 20, &[0xff, 0xff]));
    add("a member behind the end", patched(start + 42, &length.to_le_bytes()));
    add("a member in the directory", patched(start + 42, &u32::try_from(start).unwrap().to_le_bytes()));
    add("a name that is longer than the directory", patched(start + 28, &[0xff, 0xff]));
    add("a comment of a member that is longer than the directory", patched(start + 32, &[0xff, 0xff]));
    add("an archive in the archive", with(entry("d.zip", &whole)));
    // The containers are good, and what is in them is not.
    let of = |place: usize, change: &dyn Fn(&[u8]) -> Vec<u8>| {
        let mut entries = good.to_vec();
        entries[place] = entry(entries[place].listed.name.clone(), &change(&entries[place].data));
        archive(&entries)
    };
    for (place, name) in [(1, "passport"), (2, "register")] {
        add(&format!("a {name} without content"), of(place, &|_| Vec::new()));
        add(&format!("a {name} that is cut"), of(place, &|bytes| bytes[..bytes.len() / 2].to_vec()));
        add(&format!("a {name} with a byte order mark"), of(place, &|bytes| [b"\xef\xbb\xbf", bytes].concat()));
        add(&format!("a {name} with more after its signature"), of(place, &|bytes| [bytes, b"# more\n"].concat()));
        add(&format!("a {name} with other line ends"), {
            of(place, &|bytes| String::from_utf8_lossy(bytes).replace('\n', "\r\n").into_bytes())
        });
        add(&format!("a {name} without its signature"), {
            of(place, &|bytes| String::from_utf8_lossy(bytes).split("signature: |").next().unwrap().into())
        });
        add(&format!("a {name} of another factory"), of(place, &|_| other[place].data.clone()));
    }
    add("a register instead of the passport", of(1, &|_| good[2].data.clone()));
    add("a passport instead of the register", of(2, &|_| good[1].data.clone()));
    add("keys of another factory", of(3, &|_| other[3].data.clone()));
    add("no keys", of(3, &|_| Vec::new()));
    add("keys that are none", of(3, &|_| b"ssh-ed25519 AAAA factory@example.org\n".to_vec()));
    add("an authority instead of a key", of(3, &|bytes| [b"factory@example.org cert-authority ", bytes].concat()));
    add("another factory with the same name", archive(other));
    let without = |name: &str| {
        good.iter().filter(|entry| !entry.listed.name.ends_with(name.as_bytes())).cloned().collect::<Vec<_>>()
    };
    add("no register", archive(&without("register.yaml")));
    add("no passport", archive(&without("-1.yaml")));
    add("no file of keys", archive(&without(".pub")));
    all
}

/// Kinds of archives that differ only in what the program does not read: what is written is that of the good one. Keys come from
/// the signatures; their file is for people.
const IGNORED: [&str; 9] = [
    "an extra field of AES",
    "a descriptor with another CRC",
    "bytes after a deflated member",
    "a member on a further disk",
    "keys of another factory",
    "no keys",
    "keys that are none",
    "an authority instead of a key",
    "no file of keys",
];

/// Returns the files below a folder by their names in it.
fn below<'a>(files: &'a BTreeMap<PathBuf, Vec<u8>>, folder: &Path) -> BTreeMap<&'a Path, &'a [u8]> {
    files.iter().filter_map(|(path, bytes)| Some((path.strip_prefix(folder).ok()?, bytes.as_slice()))).collect()
}

/// Makes a key whose owner calls himself like the factory.
fn key_of_another_factory(place: &Place) {
    place.good("keygen other.key --no-passphrase --identity factory@example.org --allowed-signers other_signers");
}

/// With that key the other factory signs a passport, and delivers it as `other.zip`.
fn delivered_by_the_other(place: &Place, serial: &str, site: &str) {
    place.good(&format!(
        "issue factory/stands/SPS-2/{serial}/stand.yaml --site factory/sites/{site}.yaml --key other.key --identity \
         factory@example.org --out other --allow-uncalibratable"
    ));
    place.good(&format!("deliver SPS-2/{serial} --passports other --trust other_signers -o other.zip --force"));
}

#[test]
fn hostile_archives_are_refused_whole() {
    let (place, fingerprint) = Place::with_delivery("SPS-2/0017/moscow-bmstu");
    let good = members(&place.path("d.zip"));
    // What is hostile differs from this in one thing.
    place.write("x.zip", archive(&good));
    place.good(&format!("receive x.zip good --fingerprint {fingerprint}"));
    // Another factory calls itself the same, and has signed the same stand and site.
    key_of_another_factory(&place);
    delivered_by_the_other(&place, "0017", "moscow-bmstu");
    let hostile = hostile(&good, &members(&place.path("other.zip")));
    let kinds: BTreeSet<&str> = hostile.iter().map(|(what, _)| what.as_str()).collect();
    let refused = kinds.iter().filter(|what| !IGNORED.contains(what)).count();
    println!("{} hostile archives, {} kinds, of which {refused} are refused", hostile.len(), kinds.len());
    assert!(refused >= 100, "{refused}");
    let mut believed = Vec::new();
    for (what, bytes) in &hostile {
        place.write("x.zip", bytes);
        let (before, whole) = (without_pages(&place), place.files());
        let may_pass = IGNORED.contains(&what.as_str());
        for folder in ["good", "new"] {
            let output = place.run(&format!("receive x.zip {folder} --fingerprint {fingerprint}"));
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            let is_refused = matches!(output.status.code(), Some(1 | 2)) && !said.contains("internal error");
            assert!(!is_refused || place.files() == whole, "{what}: something was written");
            let (mut after, new) = (without_pages(&place), place.path("new"));
            if may_pass && output.status.success() && new.exists() {
                let [of_new, of_good] = [&new, &place.path("good")].map(|folder| below(&after, folder));
                assert!(of_new == of_good, "{what}");
                fs::remove_dir_all(&new).unwrap();
                after = without_pages(&place);
            }
            if !(is_refused || may_pass) || after != before {
                believed.push(format!("{what}, {folder}: {said}"));
            }
        }
    }
    assert!(believed.is_empty(), "{believed:#?}");
    assert!(!place.path("outside").exists());
}

#[test]
fn an_archive_that_was_packed_again_is_received() {
    let (place, fingerprint) = Place::with_delivery("SPS-2/0017");
    // Stored, deflated, deflated into a stream that cannot be rewound (so with data descriptors), and with folders.
    const SCRIPT: &str = "
import sys, zipfile
class Stream:
    def __init__(self, file): self.write, self.flush = file.write, file.flush
old = zipfile.ZipFile(sys.argv[1])
for name, method, seeks in [('a', 0, True), ('b', 8, True), ('c', 8, False)]:
    out = open(sys.argv[2] + '/' + name + '.zip', 'wb')
    with zipfile.ZipFile(out if seeks else Stream(out), 'w', method) as new:
        if name == 'b': new.writestr('passports/', ''); new.writestr('passports/SPS-2/', '')
        for member in old.namelist(): new.writestr(member, old.read(member))
";
    python(SCRIPT, &[&place.path("d.zip"), &place.path("")]);
    for name in ["a", "b", "c"] {
        place.good(&format!("receive {name}.zip lab-{name} --fingerprint {fingerprint}"));
        place.good(&format!("verify SPS-2/0017/torino-inrim/1 --workspace lab-{name}"));
    }
}

#[test]
fn a_register_goes_forward_only_and_a_key_needs_its_fingerprint() {
    let place = Place::new();
    place.good("deliver SPS-2/0017/moscow-bmstu -o old.zip --workspace factory");
    let fingerprint = place.fingerprint("factory/factory.key.pub");
    place.good(&format!("receive old.zip lab --fingerprint {fingerprint}"));
    place.good("revoke SPS-2/0017/torino-inrim/1 --reason moved --workspace factory");
    place.good("deliver SPS-2/0017 -o new.zip --workspace factory");
    place.good("receive new.zip lab");
    let before = place.files();
    place.refused("receive old.zip lab", "is older than 2");
    // What the workspace remembers counts, whatever lies in its folder.
    let register = "lab/passports/SPS-2/0017/register.yaml";
    fs::remove_file(place.path(register)).unwrap();
    place.refused("receive old.zip lab", "is older than 2");
    place.write(register, &before[&place.path(register)]);

    // Another key of the same factory, and a stranger with its name.
    key_of_another_factory(&place);
    delivered_by_the_other(&place, "0018", "moscow-bmstu");
    let other = place.fingerprint("other.key.pub");
    let before = place.files();
    place.refused("receive other.zip lab", "trusts another key of factory@example.org");
    place.refused(&format!("receive other.zip lab --fingerprint {other}"), "trusts another key of factory@example.org");
    place.refused("receive other.zip lab --new-key", "does not trust the key");
    place.refused(&format!("receive other.zip lab --new-key --fingerprint {fingerprint}"), "no key that signed it");
    assert!(place.files() == before);
    let said = place.good(&format!("receive other.zip lab --new-key --fingerprint {other}"));
    assert!(said.contains("add SPS-2/0018 to stand"), "{said}");
    place.good("verify SPS-2/0018/moscow-bmstu/1 --workspace lab");

    // The stranger's register for a stand that is here already contradicts the one that is remembered.
    delivered_by_the_other(&place, "0017", "torino-inrim");
    let before = place.files();
    place.refused("receive other.zip lab", "nothing was written");
    assert!(place.files() == before);
    place.refused("receive new.zip factory", "is the workspace of a factory");
}

#[test]
fn what_was_changed_after_it_was_signed_is_not_received() {
    let (place, fingerprint) = Place::with_delivery("SPS-2/0017");
    let good = members(&place.path("d.zip"));
    let before = place.files();
    for (index, old, new) in
        [(1, "alpha_arcsec: 12.4", "alpha_arcsec: 12.5"), (2, "state: \"current\"", "state: \"Current\"")]
    {
        let text = String::from_utf8(good[index].data.clone()).unwrap();
        assert!(text.contains(old), "{index}");
        let mut entries = good.clone();
        entries[index] = entry(entries[index].listed.name.clone(), text.replacen(old, new, 1).as_bytes());
        place.write("x.zip", archive(&entries));
        let said = place.refused(&format!("receive x.zip lab --fingerprint {fingerprint}"), "nothing was written");
        assert!(!said.contains(&fingerprint[7..]), "{said}");
    }
    // One stand's passport at another's place.
    let mut entries = good.clone();
    for entry in &mut entries[1..4] {
        let name = String::from_utf8(entry.listed.name.clone()).unwrap().replace("0017", "0018");
        *entry = self::entry(name, &entry.data);
    }
    place.write("x.zip", archive(&entries));
    place.refused(&format!("receive x.zip lab --fingerprint {fingerprint}"), "is of another stand");
    fs::remove_file(place.path("x.zip")).unwrap();
    assert!(place.files() == before);
}

/// What a workspace writes stays in it, wherever a link in it leads.
#[cfg(unix)]
#[test]
fn nothing_is_received_through_a_link() {
    use std::os::unix::fs::symlink;
    let (place, fingerprint) = Place::with_delivery("SPS-2/0017/moscow-bmstu");
    fs::create_dir(place.path("elsewhere")).unwrap();
    for name in ["passports/SPS-2", "pages", "pages/SPS-2", "registers", "allowed_signers"] {
        place.good("init lab --laboratory");
        let link = place.path("lab").join(name);
        fs::create_dir_all(link.parent().unwrap()).unwrap();
        symlink(place.path(if name == "allowed_signers" { "elsewhere/signers" } else { "elsewhere" }), &link).unwrap();
        let before = place.files();
        let output = place.run(&format!("receive d.zip lab --fingerprint {fingerprint}"));
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(matches!(output.status.code(), Some(1 | 2)) && said.contains("link"), "{name}: {said}");
        assert!(place.files() == before, "{name}");
        fs::remove_dir_all(place.path("lab")).unwrap();
    }
}
