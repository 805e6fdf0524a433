//! Known forgeries, one named case each, with the check that must refuse it and its code.
//!
//! The forger has no key, a key that is trusted for something else, stock `ssh-keygen`, or a rightly trusted key and
//! wrong words. Where stock `ssh-keygen -Y verify` accepts what is refused here, the case says so, and a test asks it.

use crate::inside::fixtures;
use crate::inside::fixtures::{ISSUER, at, issued_plus, question, signed, trust, trust_as, trust_without};
use crate::inside::programs;
use crate::inside::written;
use base64ct::{Base64, Encoding as _};
use dtg_passport::document::join;
use dtg_passport::earth::{Place, place_at};
use dtg_passport::passport::annotations::payload;
use dtg_passport::passport::checks::{CheckName, Code};
use dtg_passport::passport::content::{Content, Predecessor, derive};
use dtg_passport::passport::{NAMESPACE, Question, Trust, verify};
use dtg_passport::trust::SigningKey;
use std::collections::BTreeSet;
use std::fs;
use std::io::Write as _;
use std::ops::Range;
use std::process::Stdio;

const SIGNATURE_LINE: &str = "signature: |\n";
const FIRST_LINE: &str = "  -----BEGIN SSH SIGNATURE-----\n";

/// The issuer's key, and a right passport that was signed with it.
struct Bench {
    key: SigningKey,
    content: Content,
    good: String,
}

impl Bench {
    fn new() -> Self {
        let key = SigningKey::generate().unwrap();
        let content = fixtures::content(&fixtures::stand(fixtures::ARC_MINUTES), &fixtures::site(fixtures::SITE));
        let good = written(&content, &key);
        Self { key, content, good }
    }

    fn payload(&self) -> &str {
        self.good.split_once(SIGNATURE_LINE).unwrap().0
    }

    /// The armor, indented as in the file.
    fn armor(&self) -> &str {
        self.good.split_once(SIGNATURE_LINE).unwrap().1
    }

    /// The good file with a part of it replaced, once.
    fn replaced(&self, old: &str, new: &str) -> String {
        assert!(self.good.contains(old), "{old:?} is not in the passport");
        self.good.replacen(old, new, 1)
    }

    /// The same in the payload alone, rightly signed.
    fn resigned(&self, old: &str, new: &str) -> String {
        assert!(self.payload().contains(old), "{old:?} is not in the payload");
        signed(&self.payload().replacen(old, new, 1), &self.key)
    }

    /// Other content, written as it should be and rightly signed.
    fn rewritten(&self, change: impl FnOnce(&mut Content)) -> String {
        let mut content = self.content.clone();
        change(&mut content);
        written(&content, &self.key)
    }

    /// The file with the blob of its signature changed, armored as OpenSSH does.
    fn with_blob(&self, change: impl FnOnce(&mut Vec<u8>)) -> String {
        let mut blob = blob_of(self.armor());
        change(&mut blob);
        self.with_armor(&armored(&blob, 70))
    }

    /// The file with its own signature in lines of another width.
    fn wrapped_at(&self, width: usize) -> String {
        self.with_armor(&armored(&blob_of(self.armor()), width))
    }

    fn with_armor(&self, armor: &str) -> String {
        format!("{}{SIGNATURE_LINE}{armor}", self.payload())
    }

    /// Requires that a file is valid, so that what differs from it in little is refused for that alone.
    fn accept(&self, name: &str, file: &str) {
        accept(name, file, &trust(&self.key), &question());
    }

    /// Requires the refusal that is due of cases that differ in their bytes alone.
    fn refuse<'a>(&self, due: (CheckName, Code), files: impl IntoIterator<Item = (&'a str, impl Into<Vec<u8>>)>) {
        let case = |(name, bytes)| Case::new(name, bytes, trust(&self.key), question(), due);
        refuse_all(&files.into_iter().map(case).collect::<Vec<_>>());
    }
}

const MALFORMED: (CheckName, Code) = (CheckName::Grammar, Code::Malformed);
const BAD_CONTENT: (CheckName, Code) = (CheckName::Schema, Code::BadContent);
const WRONG_NUMBER: (CheckName, Code) = (CheckName::Recomputed, Code::WrongNumber);

#[track_caller]
fn accept(name: &str, file: &str, trust: &Trust, question: &Question) {
    let answer = verify(name, file.as_bytes(), trust, question);
    assert!(answer.valid(), "{name}: {:#?}", answer.checks());
}

fn blob_of(armor: &str) -> Vec<u8> {
    let base64: String = armor.lines().map(str::trim).filter(|line| !line.starts_with('-')).collect();
    Base64::decode_vec(&base64).unwrap()
}

fn armored(blob: &[u8], width: usize) -> String {
    let base64 = Base64::encode_string(blob);
    let lines: Vec<_> = base64.as_bytes().chunks(width).map(|line| str::from_utf8(line).unwrap()).collect();
    format!("{FIRST_LINE}  {}\n  -----END SSH SIGNATURE-----\n", lines.join("\n  "))
}

/// What a forger shows, whom and what the victim asks, and the refusal that is due.
struct Case {
    name: String,
    bytes: Vec<u8>,
    trust: Trust,
    question: Question,
    due: (CheckName, Code),
}

impl Case {
    fn new(name: &str, bytes: impl Into<Vec<u8>>, trust: Trust, question: Question, due: (CheckName, Code)) -> Self {
        Self { name: name.to_owned(), bytes: bytes.into(), trust, question, due }
    }
}

/// Every case must be refused, by the check and with the code that is due.
fn refuse_all(cases: &[Case]) {
    for case in cases {
        let answer = verify(&case.name, &case.bytes, &case.trust, &case.question);
        assert!(!answer.valid() && answer.passport().is_none(), "{} was accepted", case.name);
        let (check, code) = case.due;
        assert_eq!(answer.code(check), Some(code), "{}: {:#?}", case.name, answer.checks());
        // What comes before it in the order of trust must not have failed: the case would show something else.
        let earlier = answer.checks().iter().find(|found| found.passed() == Some(false)).map(|found| found.name);
        assert_eq!(earlier, Some(check), "{}", case.name);
    }
    println!("{} forgeries: accepted 0", cases.len());
}

#[test]
fn the_bench_is_good() {
    let bench = Bench::new();
    bench.accept("good", &bench.good);
    // What is compared with below as "written as it should be" is what `issue` writes.
    assert_eq!(bench.rewritten(|_| ()), bench.good);
}

/// No key at all: text where none may stand, and texts that readers read differently. Stock `ssh-keygen -Y verify`, fed by
/// a script that cuts the file at the first line `signature: |` and takes the indent away, accepts those of
/// [`what_stock_openssh_accepts_is_refused_here`].
#[test]
fn forms_of_the_file() {
    let bench = Bench::new();
    let (good, payload, armor) = (&bench.good, bench.payload(), bench.armor());
    let line = |line: &str| bench.replaced(SIGNATURE_LINE, line);
    let first_armor_line = armor.lines().nth(1).unwrap();
    let refused = [
        ("text after the armor", format!("{good}site: \"elsewhere\"\n")),
        ("text after the armor, indented", format!("{good}  revoked: true\n")),
        ("a comment after the armor", format!("{good}# note\n")),
        ("a blank line after the armor", format!("{good}\n")),
        ("a document after the armor", format!("{good}---\nformat: \"dtg-passport/1\"\n")),
        ("no line feed at the end", good.trim_end().to_owned()),
        ("text before the armor", bench.replaced(FIRST_LINE, &format!("  x\n{FIRST_LINE}"))),
        ("a blank line before the armor", bench.replaced(FIRST_LINE, &format!("\n{FIRST_LINE}"))),
        ("text beside the armor's first line", bench.replaced("SIGNATURE-----\n", "SIGNATURE----- x\n")),
        ("CR at the end of the signature line", line("signature: |\r\n")),
        ("CR in the signature line", line("signature: |\rx: 1\n")),
        ("CR LF throughout", good.replace('\n', "\r\n")),
        ("NEL at the end of the signature line", line("signature: |\u{85}\n")),
        ("NEL as the end of the signature line", line("signature: |\u{85}")),
        ("NEL and text in the signature line", line("signature: |\u{85}x: 1\n")),
        ("a line separator in the signature line", line("signature: |\u{2028}\n")),
        ("a paragraph separator in the signature line", line("signature: |\u{2029}x: 1\n")),
        ("a blank behind the signature line", line("signature: | \n")),
        ("a comment behind the signature line", line("signature: | # x\n")),
        ("a chomping indicator", line("signature: |-\n")),
        ("an indentation indicator", line("signature: |2\n")),
        ("a folded scalar", line("signature: >\n")),
        ("an indented signature line", line(" signature: |\n")),
        ("a signature line of two blanks", line("signature:  |\n")),
        ("a tagged signature", line("signature: !!str |\n")),
        ("an anchored signature", line("signature: &s |\n")),
        ("the quoted key in place of the signature line", line("\"signature\": |\n")),
        ("an explicit key in place of the signature line", line("? signature\n: |\n")),
        ("the quoted signature before it", line("\"signature\": |\n  x\nsignature: |\n")),
        ("an explicit signature key before it", line("? signature\n: \"x\"\nsignature: |\n")),
        ("two signature lines", line("signature: |\nsignature: |\n")),
        ("two signatures", format!("{good}{SIGNATURE_LINE}{armor}")),
        ("two armors under one line", format!("{good}{armor}")),
        ("an armor in front of the payload", format!("{SIGNATURE_LINE}{armor}{good}")),
        ("no signature", payload.to_owned()),
        ("no armor", format!("{payload}{SIGNATURE_LINE}")),
        ("nothing", String::new()),
        ("a signature of nothing", format!("{SIGNATURE_LINE}{armor}")),
        ("one line of the armor indented by three", bench.replaced("  -----END", "   -----END")),
        ("one line of the armor indented by one", bench.replaced("  -----END", " -----END")),
        ("a line of the armor indented by a tab", bench.replaced("  -----END", "\t-----END")),
        ("an armor line that ends in a blank", bench.replaced(first_armor_line, &format!("{first_armor_line} "))),
        ("a byte order mark", format!("\u{FEFF}{good}")),
        ("a document marker in front", format!("---\n{good}")),
        ("a directive in front", format!("%YAML 1.1\n---\n{good}")),
        ("a tab", bench.replaced("serial: ", "serial:\t")),
        ("an anchor", bench.replaced("theta_deg: 0.0", "theta_deg: &a 0.0")),
        ("an alias", bench.replaced("theta_deg: 0.0", "theta_deg: *a")),
        ("a merge key", bench.replaced("datum:\n", "datum:\n  <<: {level: \"x\"}\n")),
        ("a block scalar", bench.replaced("datum:\n", "datum: |\n")),
        ("single quotes", bench.replaced("\"SPS-2\"", "'SPS-2'")),
        ("a bidirectional override", bench.replaced("Two-axis", "Two\u{202E}axis")),
        ("an isolate", bench.replaced("Two-axis", "Two\u{2067}axis")),
        ("a zero-width space", bench.replaced("SPS-2", "SPS\u{200B}-2")),
        ("a zero-width joiner", bench.replaced("SPS-2", "SPS\u{200D}-2")),
        ("a soft hyphen", bench.replaced("SPS-2", "SPS\u{AD}-2")),
        ("a combining accent", bench.replaced("Two-axis", "Two\u{301}axis")),
        ("a bidirectional override in a comment", bench.replaced("# Axes", "# \u{202E}Axes")),
    ];
    bench.refuse(MALFORMED, refused);
    // The same with a rightly trusted key that signs the wrong form.
    let key = &bench.key;
    let refused = [
        ("an anchor, rightly signed", bench.resigned("theta_deg: 0.0", "theta_deg: &a 0.0")),
        ("a merge key, rightly signed", bench.resigned("datum:\n", "datum:\n  <<: {level: \"x\"}\n")),
        ("a block scalar, rightly signed", bench.resigned("datum:\n", "datum: |\n")),
        ("a bidirectional override, rightly signed", bench.resigned("Two-axis", "Two\u{202E}axis")),
        ("CR LF throughout, rightly signed", signed(&payload.replace('\n', "\r\n"), key)),
        ("an exponent in capitals, rightly signed", bench.resigned("theta_deg: 90.0", "theta_deg: 9.0E+01")),
        ("a document marker, rightly signed", signed(&format!("---\n{payload}"), key)),
        ("a second signature in the payload", signed(good, key)),
        ("a quoted signature in the payload", signed(&format!("{payload}\"signature\": |\n  x\n"), key)),
    ];
    bench.refuse(MALFORMED, refused);
}

/// The block of the signature: what of it is not signed, and what another key or another purpose makes of it.
#[test]
fn blocks_of_the_signature() {
    let bench = Bench::new();
    // Preamble, version, key, namespace: then the reserved field and the hash's name.
    let reserved = 6 + 4 + (4 + 51) + (4 + NAMESPACE.len());
    let hash = |end: [u8; 3]| bench.with_blob(|blob| blob[reserved + 11..reserved + 14].copy_from_slice(&end));
    let mut armor_lines: Vec<&str> = bench.armor().lines().collect();
    armor_lines.swap(1, 2);
    let refused = [
        ("version 0", bench.with_blob(|blob| blob[9] = 0)),
        ("version 2", bench.with_blob(|blob| blob[9] = 2)),
        ("version 2^24 + 1", bench.with_blob(|blob| blob[6] = 1)),
        ("reserved bytes", bench.with_blob(|blob| drop(blob.splice(reserved..reserved + 4, *b"\0\0\0\x02xy")))),
        ("another preamble", bench.with_blob(|blob| blob[0] = b's')),
        ("a byte behind the signature", bench.with_blob(|blob| blob.push(0))),
        ("a block cut by a byte", bench.with_blob(|blob| blob.truncate(blob.len() - 1))),
        ("a hash called sha256", hash(*b"256")),
        ("a hash called sha1", hash(*b"\0\0\0")),
        ("a key type with an escape sequence", bench.with_blob(|blob| blob[18] = 0x1B)),
        ("base64 in one line", bench.wrapped_at(1000)),
        ("base64 in lines of 64", bench.wrapped_at(64)),
        ("base64 in lines of 76", bench.wrapped_at(76)),
        ("lines of base64 exchanged", bench.with_armor(&format!("{}\n", armor_lines.join("\n")))),
        ("another label", bench.good.replace("SSH SIGNATURE", "SSH SIGNATURF")),
        ("a huge armor", bench.with_armor(&format!("{FIRST_LINE}{}", "  AAAA\n".repeat(100_000)))),
    ];
    bench.refuse(MALFORMED, refused);
    let without = bench.good.replace("=\n", "\n").replace("=\n", "\n");
    assert_ne!(without, bench.good, "a block of this length has padding");
    bench.refuse(MALFORMED, [("missing padding", without)]);
    let other = SigningKey::generate().unwrap();
    let of_other_text = fixtures::content(&fixtures::stand(fixtures::DEGREES), &fixtures::site(fixtures::SITE));
    let of_other_text = bench.key.sign(NAMESPACE, payload(&of_other_text).as_bytes()).unwrap();
    // The issuer's key beside the signature of another: the block is whole, and proves nothing.
    let theirs = other.sign(NAMESPACE, bench.payload().as_bytes()).unwrap();
    let with_signature = |signature: &[u8]| {
        bench.with_blob(|blob| {
            let start = blob.len() - 64;
            blob[start..].copy_from_slice(signature);
        })
    };
    let mixed = with_signature(blob_of(&theirs.to_armor()).last_chunk::<64>().unwrap());
    // S + L is a second encoding of S that a lax verifier accepts.
    let malleable = bench.with_blob(|blob| {
        let order = [
            0xED, 0xD3, 0xF5, 0x5C, 0x1A, 0x63, 0x12, 0x58, 0xD6, 0x9C, 0xF7, 0xA2, 0xDE, 0xF9, 0xDE, 0x14, 0, 0, 0, 0,
            0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x10,
        ];
        let start = blob.len() - 32;
        let mut carry = 0_u16;
        for (byte, add) in blob[start..].iter_mut().zip(order) {
            carry += u16::from(*byte) + add;
            *byte = carry.to_le_bytes()[0];
            carry >>= 8;
        }
    });
    let refused = [
        ("the signature of another passport", join(bench.payload(), &of_other_text)),
        ("the issuer's key beside another's signature", mixed),
        ("a signature of zeros", with_signature(&[0; 64])),
        ("the second encoding of the signature", malleable),
        ("the comments of the payload changed", bench.replaced("# Passport", "# passport")),
        ("a blank line more", bench.replaced("datum:\n", "\ndatum:\n")),
        ("a key twice", bench.replaced("  level:", "  level: \"x\"\n  level:")),
        ("a quoted text as signature before it", bench.replaced(SIGNATURE_LINE, "signature: \"x\"\nsignature: |\n")),
    ];
    bench.refuse((CheckName::Signature, Code::Altered), refused);
    let list = "format: \"dtg-register/1\"\nregister: {stand: \"a/b\", sequence: 1, issuer: \"x\"}\npassports:\n";
    let shown = ("a register shown as a passport", fixtures::signed_as("dtg-register", list, &bench.key));
    let purposes = ["dtg-register", "git", "file", "dtg-passport2", "DTG-PASSPORT", "dtg-passport\0", "*", "\u{1B}[2J"];
    let for_purpose = |purpose| (purpose, fixtures::signed_as(purpose, bench.payload(), &bench.key));
    let files = purposes.map(for_purpose).into_iter().chain([shown]);
    bench.refuse((CheckName::Grammar, Code::WrongNamespace), files);
}

/// A rightly trusted key under a text that is not written as this format is written.
/// Expected: the contract's code for a later format number and for a key that this version does not know, with the remedy.
#[test]
fn texts_of_a_later_version_ask_for_an_update() {
    let bench = Bench::new();
    let with = |old: &str, new: &str| bench.resigned(old, new);
    let in_flow = |new: &str| with("{i: 1, j: 1, theta_deg: 0.0,", new);
    let later = [
        ("a later format", with("dtg-passport/1", "dtg-passport/2")),
        ("a much later format with other keys", with("dtg-passport/1\"\n", "dtg-passport/12\"\nkinds: [1, 2]\n")),
        ("an unknown key", with("datum:\n", "accuracy_of_all: 1.0\ndatum:\n")),
        ("an unknown section", with("datum:\n", "rate_table:\n  model: \"x\"\ndatum:\n")),
        ("an unknown key in a section", with("  level:", "  flatness_arcsec: 1.0\n  level:")),
        ("an unknown key at the end of a section", with("matrices:\n", "  rate: 1.0\nmatrices:\n")),
        ("an unknown key in a position", in_flow("{i: 1, j: 1, n: 1, theta_deg: 0.0,")),
        ("an unknown key at the end", signed(&format!("{}zenith: \"x\"\n", bench.payload()), &bench.key)),
    ];
    for (name, file) in &later {
        let answer = verify(name, file.as_bytes(), &trust(&bench.key), &question());
        let schema = answer.checks().iter().find(|check| check.name == CheckName::Schema).unwrap();
        let remedy = "; update the program, because a later version wrote this file";
        assert!(schema.detail.ends_with(remedy), "{}", schema.detail);
    }
    bench.refuse((CheckName::Schema, Code::NewerFormat), later);
}

#[test]
fn texts_that_are_not_canonical() {
    let bench = Bench::new();
    let with = |old: &str, new: &str| bench.resigned(old, new);
    let lines: Vec<&str> = bench.payload().split_inclusive('\n').collect();
    let line = |beginning: &str| lines.iter().position(|line| line.starts_with(beginning)).unwrap();
    let swapped = |a: usize, b: usize| {
        let mut lines = lines.clone();
        lines.swap(a, b);
        signed(&lines.concat(), &bench.key)
    };
    let without = |beginning: &str| {
        let at = line(beginning);
        signed(&[&lines[..at], &lines[at + 1..]].concat().concat(), &bench.key)
    };
    let first = line("  - {i: 1, j: 1, theta");
    let in_flow = |new: &str| with("{i: 1, j: 1, theta_deg: 0.0,", new);
    let refused = [
        ("keys in another order", swapped(line("  number:"), line("  laboratory:"))),
        ("keys of a flow mapping in another order", in_flow("{j: 1, i: 1, theta_deg: 0.0,")),
        ("positions in another order", swapped(first, first + 1)),
        ("two blanks in a flow mapping", in_flow("{i: 1,  j: 1, theta_deg: 0.0,")),
        ("no blank in a flow mapping", in_flow("{i: 1,j: 1, theta_deg: 0.0,")),
        ("a blank after a brace", in_flow("{ i: 1, j: 1, theta_deg: 0.0,")),
        ("a quoted key", in_flow("{\"i\": 1, j: 1, theta_deg: 0.0,")),
        ("a flow mapping over two lines", in_flow("{i: 1, j: 1,\n    theta_deg: 0.0,")),
        ("a blank at the end of a line", with("revision: 1\n", "revision: 1 \n")),
        ("two blanks after a colon", with("revision: 1\n", "revision:  1\n")),
        ("another indent", with("  level:", "   level:")),
        ("a list without indent", with("  - {i: 1, j: 1, theta", "- {i: 1, j: 1, theta")),
        ("a block in place of a flow mapping", with("  - {i: 1, j: 1, ", "  - i: 1\n    j: 1\n  - {")),
        ("an integer for a number", with("theta_deg: 0.0", "theta_deg: 0")),
        ("a number for an integer", with("revision: 1\n", "revision: 1.0\n")),
        ("a number in quotes", with("theta_deg: 0.0", "theta_deg: \"0.0\"")),
        ("a text without quotes", with("serial: \"0017\"", "serial: 0017")),
        ("minus zero", with("theta_deg: 0.0", "theta_deg: -0.0")),
        ("a plus sign", with("alpha_arcsec: 12.4", "alpha_arcsec: +12.4")),
        ("a zero in front", with("alpha_arcsec: 12.4", "alpha_arcsec: 012.4")),
        ("a zero behind", with("alpha_arcsec: 12.4", "alpha_arcsec: 12.40")),
        ("no digit behind the point", with("theta_deg: 90.0", "theta_deg: 90.")),
        ("no digit before the point", with("valid_within_deg_per_h: 0.001", "valid_within_deg_per_h: .001")),
        ("an exponent without a point", with("valid_within_deg_per_h: 0.001", "valid_within_deg_per_h: 1e-03")),
        ("an exponent where a point will do", with("alpha_arcsec: 12.4", "alpha_arcsec: 1.24e+01")),
        ("an exponent of one digit", with("alpha_arcsec: 12.4", "alpha_arcsec: 1.24e+1")),
        ("an exponent without a sign", with("alpha_arcsec: 12.4", "alpha_arcsec: 1.24e01")),
        ("more digits than binary64 has", with("alpha_arcsec: 12.4", "alpha_arcsec: 12.4000000000000000001")),
        ("digits in groups", with("theta_deg: 90.0", "theta_deg: 9_0.0")),
        ("sexagesimal", with("theta_deg: 90.0", "theta_deg: 1:30.0")),
        ("hexadecimal", with("revision: 1\n", "revision: 0x1\n")),
        ("octal", with("revision: 1\n", "revision: 01\n")),
        ("a comma as decimal mark", with("alpha_arcsec: 12.4", "alpha_arcsec: 12,4")),
        ("not a number", with("alpha_arcsec: 12.4", "alpha_arcsec: .nan")),
        ("infinity", with("alpha_arcsec: 12.4", "alpha_arcsec: .inf")),
        ("minus infinity", with("alpha_arcsec: 12.4", "alpha_arcsec: -.inf")),
        ("a number that is infinite", with("alpha_arcsec: 12.4", "alpha_arcsec: 1.0e+999")),
        ("a text that says nan", with("alpha_arcsec: 12.4", "alpha_arcsec: nan")),
        ("null", with("alpha_arcsec: 12.4", "alpha_arcsec: null")),
        ("nothing", with("alpha_arcsec: 12.4", "alpha_arcsec: ")),
        ("a key twice", with("  level:", "  level: \"x\"\n  level:")),
        ("a key twice in a position", in_flow("{i: 1, j: 1, j: 1, theta_deg: 0.0,")),
        ("a section twice", with("datum:\n", "datum: {level: \"x\"}\ndatum:\n")),
        ("the quoted key as signature", signed(&format!("{}\"signature\": \"x\"\n", bench.payload()), &bench.key)),
        ("no certificate number", without("  number:")),
        ("no site id", without("  id: \"bench\"")),
        ("an empty text", with("serial: \"0017\"", "serial: \"\"")),
        ("a folder in the serial number", with("serial: \"0017\"", "serial: \"../0017\"")),
        ("a Cyrillic letter in the model", with("model: \"SPS-2\"", "model: \"S\u{420}S-2\"")),
        ("an earlier format number", with("dtg-passport/1", "dtg-passport/0")),
        ("another format", with("dtg-passport/1", "dtg-stand/1")),
        ("a wrong id", with("id: \"SPS-2/0017/bench/1\"", "id: \"SPS-2/0018/bench/1\"")),
        ("the id of a later revision", with("id: \"SPS-2/0017/bench/1\"", "id: \"SPS-2/0017/bench/2\"")),
        ("another serial number under the id", with("serial: \"0017\"", "serial: \"0018\"")),
        ("a time with an offset", with("08:00:00Z\"", "08:00:00+00:00\"")),
        ("a time in lower case", with("T08:00:00Z\"", "t08:00:00z\"")),
        ("a time with a fraction", with("08:00:00Z\"", "08:00:00.5Z\"")),
        ("a leap second", with("08:00:00Z\"", "07:59:60Z\"")),
        ("a day that does not exist", with("valid_until: \"2028-11-01\"", "valid_until: \"2028-02-30\"")),
        ("a day of one digit", with("valid_until: \"2028-11-01\"", "valid_until: \"2028-11-1\"")),
        ("issued before its certificate", with("2026-11-09T08", "2026-11-01T08")),
        ("nothing but comments", signed("# a passport\n", &bench.key)),
        ("a list", signed("- {i: 1}\n", &bench.key)),
        ("a text", signed("\"passport\"\n", &bench.key)),
        ("an empty payload line", signed("\n", &bench.key)),
    ];
    bench.refuse(BAD_CONTENT, refused);
    let predecessor = |sha256: String| Predecessor {
        id: "SPS-2/0017/bench/1".to_owned(),
        sha256,
        reason: "test".to_owned(),
        changed: "nothing".to_owned(),
    };
    let changed = |name: &'static str, change: &dyn Fn(&mut Content)| (name, bench.rewritten(change));
    let refused = [
        changed("revision 0", &|content| {
            content.passport.revision = 0;
            content.passport.id = content.id_of_parts();
        }),
        changed("supersedes without reissued_from", &|content| content.passport.supersedes = Some(true)),
        changed("reissued_from without supersedes", &|content| {
            content.passport.reissued_from = Some(predecessor("0".repeat(64)));
        }),
        changed("a predecessor's sha256 of no such form", &|content| {
            content.passport.supersedes = Some(true);
            content.passport.reissued_from = Some(predecessor("A".repeat(64)));
        }),
        changed("a position twice", &|content| content.positions.insert(0, content.positions[0].clone())),
        changed("no position", &|content| content.positions.clear()),
        changed("position 0", &|content| content.positions[0].i = 0),
        changed("the eight with another angle", &|content| content.positions[0].phi_deg = 1.0),
        changed("a deviation over 45 degrees", &|content| content.positions[0].alpha_arcsec = 162_001.0),
        changed("a negative uncertainty", &|content| content.positions[0].u_alpha_arcsec = Some(-1.0)),
        changed("latitude 91", &|content| content.site.latitude_deg = Some(91.0)),
        changed("the pole", &|content| {
            content.site.deflection_arcsec = None;
            content.site.latitude_deg = Some(90.0);
        }),
        changed("both latitudes", &|content| content.site.astronomic_latitude_deg = Some(55.0)),
        changed("no latitude", &|content| content.site.latitude_deg = None),
        // Beyond the pole every radius is infinite, and with it the limit of what may be stated in its place.
        changed("a deflection over the pole", &|content| {
            content.site.latitude_deg = None;
            content.site.astronomic_latitude_deg = Some(89.99);
            content.site.deflection_arcsec.as_mut().unwrap().xi = -150.0;
            recompute(content);
            content.earth.valid_radius_m = 1e9;
        }),
        changed("an uncertainty that makes others infinite", &|content| {
            content.site.azimuth_mark.as_mut().unwrap().position_u_m = Some(1.7e308);
            recompute(content);
            content.earth.azimuth_u_arcsec = Some(0.1);
        }),
    ];
    bench.refuse(BAD_CONTENT, refused);
}

/// Everything that follows from the inputs, as they are now.
fn recompute(content: &mut Content) {
    let gyro = content.self_check.as_ref().unwrap().parameters();
    let derived = derive(&content.positions, &content.site, &gyro).unwrap();
    content.earth = derived.earth;
    content.matrices = derived.matrices;
    content.vectors = derived.vectors;
    content.self_check = derived.self_check;
}

/// A rightly trusted key, a text in the right form, and numbers that do not follow from the inputs.
#[test]
fn numbers_that_do_not_follow() {
    let bench = Bench::new();
    let wrong = |name: &'static str, change: &dyn Fn(&mut Content)| (name, bench.rewritten(change));
    // Without all of the eight positions there are no matrices.
    let mut seven = fixtures::stand(fixtures::ARC_MINUTES);
    seven.positions.pop();
    let seven = fixtures::content(&seven, &fixtures::site(fixtures::SITE));
    bench.accept("seven", &written(&seven, &bench.key));
    let (matrices, self_check) = (&bench.content.matrices, &bench.content.self_check);
    assert!(matrices.is_some() && self_check.is_some());
    let dressed = |with_matrices: bool, with_check: bool| {
        let matrices = matrices.clone().filter(|_| with_matrices);
        let self_check = self_check.clone().filter(|_| with_check);
        written(&Content { matrices, self_check, ..seven.clone() }, &bench.key)
    };
    // A position beside the eight whose index is large must not lend its size to the limit of the currents.
    let mut nine = fixtures::stand(fixtures::ARC_MINUTES);
    let mut extra = nine.positions[0].clone();
    (extra.i, extra.j) = (u32::MAX, u32::MAX);
    nine.positions.push(extra);
    let nine = fixtures::content(&nine, &fixtures::site(fixtures::SITE));
    bench.accept("nine", &written(&nine, &bench.key));
    let mut loosened = nine.clone();
    loosened.self_check.as_mut().unwrap().currents[3].jx_ma += 1e-3;
    // A gyro whose K_x is tiny: currents along x of 2e7 mA must not lend their size to the limit of those along y.
    let mut uneven = bench.content.clone();
    uneven.self_check.as_mut().unwrap().k_deg_per_h_per_ma = [[1e-6, 0.0], [0.0, 95.0]];
    recompute(&mut uneven);
    bench.accept("uneven", &written(&uneven, &bench.key));
    uneven.self_check.as_mut().unwrap().currents[3].jy_ma += 3e-12;
    // Seven positions determine the parameters by least squares: their self-check counts, and may be wrong.
    let mut unlike = seven.clone();
    unlike.self_check.as_mut().unwrap().currents[3].jy_ma += 1e-9;
    let mut other_gyro = seven.clone();
    other_gyro.self_check.as_mut().unwrap().omega_k_deg_per_h_per_g += 1e-9;
    // No calibration needs the self-check: a passport may be without.
    bench.accept("without", &bench.rewritten(|content| content.self_check = None));
    let refused = [
        wrong("matrices removed", &|content| content.matrices = None),
        wrong("the azimuth removed", &|content| content.earth.azimuth_deg = None),
        wrong("the azimuth's uncertainty removed", &|content| content.earth.azimuth_u_arcsec = None),
        wrong("a vector removed", &|content| content.vectors.truncate(7)),
        wrong("all vectors removed", &|content| content.vectors.clear()),
        wrong("a vector twice", &|content| content.vectors.push(content.vectors[0].clone())),
        wrong("two vectors exchanged", &|content| content.vectors.swap(0, 1)),
        wrong("a current removed", &|content| content.self_check.as_mut().unwrap().currents.truncate(7)),
        wrong("two currents exchanged", &|content| content.self_check.as_mut().unwrap().currents.swap(0, 1)),
        ("matrices without the eight", dressed(true, false)),
        ("a self-check without the eight", dressed(false, true)),
        ("both without the eight", dressed(true, true)),
        ("a wrong current of seven positions", written(&unlike, &bench.key)),
        ("another gyro than that of the currents of seven positions", written(&other_gyro, &bench.key)),
        wrong("a gyro without K", &|content| {
            content.self_check.as_mut().unwrap().k_deg_per_h_per_ma = [[0.0, 0.0], [0.0, 0.0]];
        }),
        // The currents would be infinite, and an infinite limit would let any pass.
        wrong("a gyro whose currents are infinite", &|content| {
            let check = content.self_check.as_mut().unwrap();
            check.k_deg_per_h_per_ma = [[1e-9, 0.0], [0.0, 1e-9]];
            check.omega0_deg_per_h = [1.7e308, 1.7e308];
        }),
        ("a wrong current beside a large index", written(&loosened, &bench.key)),
        ("a wrong current along y beside large ones along x", written(&uneven, &bench.key)),
        wrong("the earth of another place", &|content| {
            content.earth = fixtures::site(&fixtures::SITE.replace("55.7658\nlong", "55.7659\nlong")).earth();
        }),
        wrong("the numbers of another stand", &|content| {
            let other = fixtures::content(&fixtures::stand(fixtures::DEGREES), &fixtures::site(fixtures::SITE));
            content.matrices = other.matrices;
        }),
    ];
    bench.refuse(WRONG_NUMBER, refused);
    // Consistent, and of no use: no software finds such parameters again.
    let mut absurd = bench.content.clone();
    let coefficients = absurd.coefficients();
    let check = absurd.self_check.as_mut().unwrap();
    check.omega0_deg_per_h = [1e9, 1e9];
    let gyro = check.parameters().to_model();
    for (current, at) in check.currents.iter_mut().zip(&coefficients.positions) {
        [current.jx_ma, current.jy_ma] = gyro.currents_ma(at).unwrap().into();
    }
    let absurd = [("a gyro that its currents do not give back", written(&absurd, &bench.key))];
    bench.refuse(WRONG_NUMBER, absurd);
}

/// Numbers that nothing in a passport can contradict: they are inputs, and no computed number depends on them. Whoever
/// signs one of them wrong signs a wrong passport that verifies.
const INPUTS_THAT_NOTHING_CONTRADICTS: &[&str] = &[
    "certificate.common_base_arcsec",
    "certificate.common_platform_arcsec",
    "certificate.repeatability_arcsec",
    "certificate.repeatability_degrees_of_freedom",
    "certificate.temperature_c",
    "certificate.temperature_range_c",
    "positions.degrees_of_freedom",
    "positions.u_alpha_arcsec",
    "positions.u_beta_arcsec",
    "positions.u_gamma_arcsec",
    "site.longitude_deg",
    "site.uncertainty.azimuth_arcsec",
    "site.uncertainty.latitude_arcsec",
    "site.uncertainty.level_arcsec",
];

/// A number of a payload: where it stands, and the section and key that it belongs to.
struct Number {
    place: Range<usize>,
    key: String,
}

/// Every number of a payload, outside strings and comments.
fn numbers(payload: &str) -> Vec<Number> {
    let (mut found, mut path, mut end) = (Vec::new(), Vec::new(), 0);
    for line in payload.split_inclusive('\n') {
        let content = line.trim_start_matches(' ');
        let depth = (line.len() - content.len()) / 2;
        let mut in_text = content.starts_with('#');
        for part in line.split_inclusive([' ', ',', '[', ']', '{', '}', '\n']) {
            end += part.len();
            let word = &part[..part.len() - 1];
            in_text ^= word.matches('"').count() % 2 == 1;
            if let Some(key) = word.strip_suffix(':').filter(|_| !in_text) {
                path.truncate(depth);
                path.push(key);
            } else if !in_text && word.ends_with(|c: char| c.is_ascii_digit()) {
                found.push(Number { place: end - part.len()..end - 1, key: path.join(".") });
            }
        }
    }
    found
}

/// The number with its last digit changed, written as it must be.
fn with_last_digit_changed(number: &str) -> String {
    let last = number.find('e').unwrap_or(number.len()) - 1;
    let digit = if &number[last..=last] == "9" { '8' } else { char::from(number.as_bytes()[last] + 1) };
    format!("{}{digit}{}", &number[..last], &number[last + 1..])
}

#[test]
fn every_number_changed_in_its_last_digit_and_rightly_signed() {
    for stand in [fixtures::ARC_MINUTES, fixtures::DEGREES] {
        let key = SigningKey::generate().unwrap();
        let payload = payload(&fixtures::content(&fixtures::stand(stand), &fixtures::site(fixtures::SITE)));
        let trust = trust(&key);
        let verdict = |number: &Number, changed: &str| {
            let altered = format!("{}{changed}{}", &payload[..number.place.start], &payload[number.place.end..]);
            let answer = verify(&number.key, signed(&altered, &key).as_bytes(), &trust, &question());
            let failed = answer.checks().iter().find(|check| check.passed() == Some(false));
            failed.map(|check| (check.name, check.code))
        };
        let (mut refused, mut within_limit, mut uncovered) = (0, 0, BTreeSet::new());
        let numbers = numbers(&payload);
        assert!(numbers.len() > 200, "{}", numbers.len());
        for number in &numbers {
            let text = &payload[number.place.clone()];
            let value: f64 = text.parse().unwrap();
            let changed = with_last_digit_changed(text);
            let computed =
                ["earth.", "matrices.", "vectors.", "self_check."].iter().any(|at| number.key.starts_with(at));
            match verdict(number, &changed) {
                Some(WRONG_NUMBER | BAD_CONTENT) => refused += 1,
                None if !computed => drop(uncovered.insert(number.key.clone())),
                // The last of sixteen digits, or a micrometre of the radius: the platform may have rounded it so.
                None => {
                    let off = (changed.parse::<f64>().unwrap() - value).abs();
                    let rounded = ["earth.valid_radius_m", "earth.azimuth_u_arcsec", "earth.azimuth_deg"];
                    let limit = if rounded.contains(&number.key.as_str()) { 1.5e-6 } else { 1e-10 };
                    assert!(off < limit, "{} {text} -> {changed}", number.key);
                    within_limit += 1;
                    let step = if limit > 1e-9 { 1e-5 } else { 1e-9 };
                    let changed = dtg_passport::text::number::decimal(value + step);
                    assert_eq!(verdict(number, &changed), Some(WRONG_NUMBER), "{} {text} -> {changed}", number.key);
                    refused += 1;
                }
                other => panic!("{} {text} -> {changed}: {other:?}", number.key),
            }
        }
        println!(
            "{} numbers: {refused} refused ({within_limit} of them only from 1e-9 on, their last digit being within 1e-12)",
            numbers.len()
        );
        for key in &uncovered {
            assert!(INPUTS_THAT_NOTHING_CONTRADICTS.contains(&key.as_str()), "{key} is not covered");
        }
        if stand == fixtures::ARC_MINUTES {
            let found: Vec<&str> = uncovered.iter().map(String::as_str).collect();
            assert_eq!(found, INPUTS_THAT_NOTHING_CONTRADICTS);
        }
    }
}

/// Keys that do not count: nobody's, somebody else's, for something else, too early, too late, revoked.
#[test]
fn keys_that_do_not_count() {
    let bench = Bench::new();
    let (key, other) = (&bench.key, SigningKey::generate().unwrap());
    let case = |name: &str, trust: Trust, code: Code| {
        Case::new(name, bench.good.as_bytes(), trust, question(), (CheckName::Signer, code))
    };
    let signed_by_other = |name: &str, trust: Trust, code: Code| {
        let bytes = written(&bench.content, &other);
        Case::new(name, bytes, trust, question(), (CheckName::Signer, code))
    };
    let issued_by = |issuer: &str, principals: &str| {
        let bytes = bench.rewritten(|content| content.passport.issuer = issuer.to_owned());
        let due = (CheckName::Signer, Code::WrongPrincipal);
        Case::new(&format!("{issuer} by {principals}"), bytes, trust_as(principals, key), question(), due)
    };
    let now = "20261109080000Z";
    let mut refused = vec![
        signed_by_other("an unknown key", trust(key), Code::UnknownKey),
        signed_by_other("another's key", trust_as("lab@example.org", &other), Code::WrongPrincipal),
        case("a principal's name cut", trust_as("factory@example.or", key), Code::WrongPrincipal),
        case("a pattern that does not fit", trust_as("*@lab.example.org", key), Code::WrongPrincipal),
        case("a pattern that excludes", trust_as("!factory@*,*", key), Code::WrongPrincipal),
        case("a pattern of nothing but exclusion", trust_as("!lab@*", key), Code::WrongPrincipal),
        case("another letter case", trust_as("Factory@example.org", key), Code::WrongPrincipal),
        case("for git", trust_as(&format!("{ISSUER} namespaces=\"git\""), key), Code::WrongNamespace),
        case("for lists", trust_as(&format!("{ISSUER} namespaces=\"dtg-register\""), key), Code::WrongNamespace),
        case("for all but", trust_as(&format!("{ISSUER} namespaces=\"*,!dtg-passport\""), key), Code::WrongNamespace),
        case("a second late", trust_as(&format!("{ISSUER} valid-before=\"20261109075959Z\""), key), Code::KeyExpired),
        case(
            "a second early",
            trust_as(&format!("{ISSUER} valid-after=\"20261109080001Z\""), key),
            Code::KeyNotYetValid,
        ),
        case("expired long ago", trust_as(&format!("{ISSUER} valid-before=\"20200101Z\""), key), Code::KeyExpired),
        // The issuer is a name, whatever it looks like.
        issued_by("*", "lab@example.org"),
        issued_by("factory@example.org,lab@example.org", ISSUER),
        issued_by("factory@example.org ", ISSUER),
        issued_by("f\u{430}ctory@example.org", ISSUER),
        issued_by("?actory@example.org", ISSUER),
    ];
    let line = key.public_key().to_openssh();
    let revoked = [
        ("revoked in a list of keys", format!("# lost\n{line}\n").into_bytes()),
        ("revoked by a KRL", krl("", &line)),
        ("revoked by its SHA-1 in a KRL", krl("sha1: ", &line)),
        ("revoked by its SHA-256 in a KRL", krl("sha256: ", &line)),
    ];
    refused.extend(revoked.iter().map(|(name, list)| {
        let due = (CheckName::Revocation, Code::KeyRevoked);
        Case::new(name, bench.good.as_bytes(), trust_without(key, list), question(), due)
    }));
    refuse_all(&refused);
    // What differs from these in little is accepted: both ends of a key's validity belong to it.
    for options in [
        "namespaces=\"dtg-*\"".to_owned(),
        format!("valid-after=\"{now}\",valid-before=\"20261109080001Z\""),
        format!("valid-after=\"20261109075959Z\",valid-before=\"{now}\""),
    ] {
        accept(&options, &bench.good, &trust_as(&format!("*@example.org {options}"), key), &question());
    }
    let others = trust_without(key, format!("{}\n", other.public_key().to_openssh()).as_bytes());
    accept("others", &bench.good, &others, &question());
}

/// A good passport at the wrong time, on the wrong stand, at the wrong place, from the wrong issuer.
#[test]
fn good_passports_where_they_do_not_count() {
    let bench = Bench::new();
    let case = |name: &str, question: Question, check: CheckName, code: Code| {
        Case::new(name, bench.good.as_bytes(), trust(&bench.key), question, (check, code))
    };
    let time = |text: &str| Question::at(at(text));
    let ask = |change: &dyn Fn(&mut Question)| {
        let mut question = question();
        change(&mut question);
        question
    };
    let here = Place { latitude_deg: 55.7658, longitude_deg: 37.6856 };
    let radius = bench.content.earth.valid_radius_m;
    let away = |azimuth: f64, metres: f64| ask(&|question| question.place = Some(place_at(here, azimuth, metres)));
    let serial = |serial: &str| ask(&|question| question.serial = Some(serial.to_owned()));
    let issuer = |issuer: &str| ask(&|question| question.issuer = Some(issuer.to_owned()));
    let lost =
        |latitude_deg, longitude_deg| ask(&|question| question.place = Some(Place { latitude_deg, longitude_deg }));
    refuse_all(&[
        case("issued in the future", Question::at(issued_plus(-1)), CheckName::InForce, Code::NotYetValid),
        case("after its last day", time("2028-11-02T00:00:00Z"), CheckName::InForce, Code::Expired),
        case("of another stand", serial("0018"), CheckName::Stand, Code::WrongStand),
        case("of a stand without zeros", serial("17"), CheckName::Stand, Code::WrongStand),
        case("of the model", serial("SPS-2"), CheckName::Stand, Code::WrongStand),
        case("of no stand", serial(""), CheckName::Stand, Code::WrongStand),
        case("of any stand", serial("*"), CheckName::Stand, Code::WrongStand),
        case("a metre too far north", away(0.0, radius + 1.0), CheckName::Place, Code::WrongPlace),
        case("a metre too far east", away(90.0, radius + 1.0), CheckName::Place, Code::WrongPlace),
        case("on the other side", lost(-55.7658, 37.6856), CheckName::Place, Code::WrongPlace),
        case("nowhere", lost(f64::NAN, 37.6856), CheckName::Place, Code::WrongPlace),
        case("beyond the pole", lost(1e300, f64::INFINITY), CheckName::Place, Code::WrongPlace),
        case("from another issuer", issuer("lab@example.org"), CheckName::Issuer, Code::WrongIssuer),
        case("from any issuer", issuer("*@example.org"), CheckName::Issuer, Code::WrongIssuer),
    ]);
    for question in [
        Question::at(issued_plus(0)),
        time("2028-11-01T23:59:59Z"),
        time("2028-11-01T23:59:59.999Z"),
        away(180.0, radius - 1.0),
        serial("0017"),
        issuer(ISSUER),
    ] {
        accept("good", &bench.good, &trust(&bench.key), &question);
    }
    // Of the two last days, the passport's and the certificate's, the earlier counts.
    let expired = |passport: Option<&str>, certificate: Option<&str>, until: &str| {
        let bytes = bench.rewritten(|content| {
            content.passport.valid_until = passport.map(|day| day.parse().unwrap());
            content.certificate.valid_until = certificate.map(|day| day.parse().unwrap());
            content.certificate.valid_until_basis = None;
        });
        accept(until, &bytes, &trust(&bench.key), &time(until));
        let after = Question::at(jiff::Timestamp::from_second(at(until).as_second() + 1).unwrap());
        Case::new(until, bytes, trust(&bench.key), after, (CheckName::InForce, Code::Expired))
    };
    refuse_all(&[
        expired(Some("2027-04-01"), Some("2028-11-01"), "2027-04-01T23:59:59Z"),
        expired(Some("2029-04-01"), Some("2028-11-01"), "2028-11-01T23:59:59Z"),
        expired(None, Some("2028-11-01"), "2028-11-01T23:59:59Z"),
        expired(Some("2027-04-01"), None, "2027-04-01T23:59:59Z"),
    ]);
    // "For ever" is beyond what instants reach, and must not be read as long ago.
    let for_ever = bench.rewritten(|content| content.passport.valid_until = Some("9999-12-31".parse().unwrap()));
    bench.accept("for ever", &for_ever);
}

/// Runs `ssh-keygen` in a folder and gives whether it was content, and what it printed.
fn ssh_keygen(folder: &std::path::Path, arguments: &[&str], input: &[u8]) -> (bool, Vec<u8>) {
    let mut command = programs::on_path("ssh-keygen");
    command.args(arguments).current_dir(folder).env_remove("SSH_AUTH_SOCK").env_remove("SSH_ASKPASS");
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
    let mut child = command.spawn().unwrap();
    // A program that refuses at once closes its input.
    let _ = child.stdin.take().unwrap().write_all(input);
    let output = child.wait_with_output().unwrap();
    (output.status.success(), output.stdout)
}

/// A key revocation list as `ssh-keygen -k` makes it of one line.
fn krl(kind: &str, line: &str) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("lines"), format!("{kind}{line}\n")).unwrap();
    assert!(ssh_keygen(folder.path(), &["-q", "-k", "-f", "krl", "lines"], b"").0);
    fs::read(folder.path().join("krl")).unwrap()
}

/// The verdict of stock OpenSSH on a file that a script has cut at its first line `signature: |`.
fn stock_accepts(file: &str, key: &SigningKey) -> bool {
    let folder = tempfile::tempdir().unwrap();
    let (payload, armor) = file.split_once(SIGNATURE_LINE).unwrap_or((file, ""));
    let armor: String = armor.lines().map(|line| format!("{}\n", line.trim_start())).collect();
    fs::write(folder.path().join("sig"), armor).unwrap();
    fs::write(folder.path().join("signers"), format!("{ISSUER} {}\n", key.public_key().to_openssh())).unwrap();
    let arguments = ["-Y", "verify", "-n", NAMESPACE, "-I", ISSUER, "-s", "sig", "-f", "signers"];
    ssh_keygen(folder.path(), &arguments, payload.as_bytes()).0
}

/// Why the split, the text rule and the canonical form are checked here: OpenSSH knows nothing of them.
#[test]
fn what_stock_openssh_accepts_is_refused_here() {
    let bench = Bench::new();
    let (good, key) = (&bench.good, &bench.key);
    assert!(stock_accepts(good, key));
    let accepted = [
        ("text after the armor", format!("{good}site: \"elsewhere\"\n"), MALFORMED),
        ("a second signature", format!("{good}{SIGNATURE_LINE}{}", bench.armor()), MALFORMED),
        ("version 0 of the block", bench.with_blob(|blob| blob[9] = 0), MALFORMED),
        ("base64 in one line", bench.wrapped_at(1000), MALFORMED),
        ("another indent", good.replace("\n  -----END", "\n     -----END"), MALFORMED),
        ("a merge key, signed", bench.resigned("datum:\n", "datum:\n  <<: {level: \"x\"}\n"), MALFORMED),
        ("a hidden character, signed", bench.resigned("SPS-2", "SPS\u{200B}-2"), MALFORMED),
        ("a key twice, signed", bench.resigned("  level:", "  level: \"x\"\n  level:"), BAD_CONTENT),
        ("another form of a number, signed", bench.resigned("0.001\n", "1e-3\n"), BAD_CONTENT),
        ("a wrong number, signed", bench.rewritten(|content| content.earth.latitude_deg += 1e-6), WRONG_NUMBER),
        ("no matrices, signed", bench.rewritten(|content| content.matrices = None), WRONG_NUMBER),
    ];
    for (name, file, due) in accepted {
        assert!(stock_accepts(&file, key), "ssh-keygen has become stricter: {name}");
        bench.refuse(due, [(name, file)]);
    }
    for (name, file) in [
        ("version 2 of the block", bench.with_blob(|blob| blob[9] = 2)),
        ("CR in the signature line", bench.replaced(SIGNATURE_LINE, "signature: |\r\n")),
        ("an altered digit", bench.replaced("alpha_arcsec: 12.4", "alpha_arcsec: 12.5")),
    ] {
        assert!(!stock_accepts(&file, key), "{name}");
        assert!(!verify(name, file.as_bytes(), &trust(key), &question()).valid(), "{name}");
    }
}

/// What stock `ssh-keygen -Y sign` makes: good with an Ed25519 key and SHA-512, refused by name with anything else.
#[test]
fn signatures_of_stock_openssh() {
    let bench = Bench::new();
    let folder = tempfile::tempdir().unwrap();
    let sign = |kind: &str, more: &[&str]| {
        let made = fs::exists(folder.path().join(kind)).unwrap();
        assert!(made || ssh_keygen(folder.path(), &["-q", "-t", kind, "-N", "", "-f", kind], b"").0, "{kind}");
        let arguments = [&["-Y", "sign", "-q", "-f", kind, "-n", NAMESPACE], more].concat();
        let (good, armor) = ssh_keygen(folder.path(), &arguments, bench.payload().as_bytes());
        assert!(good, "{kind}");
        let armor: String = str::from_utf8(&armor).unwrap().lines().map(|line| format!("  {line}\n")).collect();
        format!("{}{SIGNATURE_LINE}{armor}", bench.payload())
    };
    let line = |kind: &str| fs::read_to_string(folder.path().join(format!("{kind}.pub"))).unwrap();
    let trust_of = |kind: &str| {
        let signers = format!("{ISSUER} {}", line(kind));
        let signers = dtg_passport::trust::AllowedSigners::parse("s", signers.as_bytes()).unwrap();
        Trust::of(signers)
    };
    let theirs = sign("ed25519", &[]);
    accept("ed25519", &theirs, &trust_of("ed25519"), &question());
    let case = |name: &str, file: String, kind: &str, code: Code| {
        Case::new(name, file, trust_of(kind), question(), (CheckName::Grammar, code))
    };
    // Each of these stock `ssh-keygen -Y verify` accepts under the same allowed signers.
    refuse_all(&[
        case("SHA-256", sign("ed25519", &["-O", "hashalg=sha256"]), "ed25519", Code::Malformed),
        case("RSA", sign("rsa", &[]), "rsa", Code::UnsupportedKey),
        case("ECDSA", sign("ecdsa", &[]), "ecdsa", Code::UnsupportedKey),
    ]);
}
