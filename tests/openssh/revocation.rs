//! Revoked keys: lists that `ssh-keygen -k` makes, and lists of public keys, with the verdicts of `ssh-keygen`.

use crate::{Bench, NAMESPACE, PRINCIPAL, string};
use base64ct::{Base64, Encoding as _};
use dtg_passport::trust::{RevokedKeys, SigningKey};
use std::fs;

const KEYS: usize = 6;

fn bench_with_keys() -> (Bench, Vec<SigningKey>) {
    let bench = Bench::new();
    let keys = (0..KEYS).map(|index| bench.new_key(&format!("key{index}"))).collect();
    bench.new_key("authority");
    for (index, serial) in [(0, "5"), (1, "9")] {
        let id = format!("id{index}");
        let public = format!("key{index}.pub");
        let made = bench.keygen(&["-q", "-s", "authority", "-I", &id, "-n", PRINCIPAL, "-z", serial, &public]);
        assert!(made.good, "{}", made.errors);
    }
    (bench, keys)
}

/// Both verdicts on every key: those of `ssh-keygen -Q` and ours.
fn compare(bench: &Bench, keys: &[SigningKey], list: &str, expected: &[usize]) {
    let bytes = fs::read(bench.path(list)).unwrap();
    let ours = RevokedKeys::parse(list, &bytes).unwrap();
    for (index, key) in keys.iter().enumerate() {
        let theirs = !bench.keygen(&["-Q", "-f", list, &format!("key{index}.pub")]).good;
        let why = ours.revokes(&key.public_key());
        assert_eq!(why.is_some(), theirs, "{list}, key {index}: {why:?}");
        assert_eq!(theirs, expected.contains(&index), "{list}, key {index}");
    }
}

#[test]
fn lists_of_every_kind_of_entry() {
    let (bench, keys) = bench_with_keys();
    let line = |index: usize| keys[index].public_key().to_openssh();
    let print = |index: usize| keys[index].public_key().fingerprint();
    let specifications: [(&str, String, &[usize]); 9] = [
        ("plain", format!("{}\n{} comment\n", line(0), line(3)), &[0, 3]),
        ("key", format!("# lost\nkey: {}\n", line(1)), &[1]),
        ("sha1", format!("sha1: {}\nsha1: {}\n", line(2), line(4)), &[2, 4]),
        ("sha256", format!("sha256: {}\n", line(5)), &[5]),
        ("hash", format!("hash: {}\nhash: {}\n", print(1), print(5)), &[1, 5]),
        ("serials", "serial: 1-100\nserial: 200\nserial: 202\nserial: 9223372036854775807\n".to_owned(), &[]),
        ("ids", "id: id0\nid: id1\n".to_owned(), &[]),
        ("mixed", format!("serial: 5\nid: id1\n{}\nsha1: {}\nsha256: {}\n", line(0), line(1), line(2)), &[0, 1, 2]),
        ("nothing", "# nobody so far\n".to_owned(), &[]),
    ];
    for (name, specification, expected) in specifications {
        let text = format!("{name}.spec");
        bench.write(&text, specification);
        let made = bench.keygen(&["-q", "-k", "-s", "authority.pub", "-z", "7", "-f", name, &text]);
        assert!(made.good, "{name}: {}", made.errors);
        compare(&bench, &keys, name, expected);
    }
}

#[test]
fn lists_that_grew_and_lists_of_certificates() {
    let (bench, keys) = bench_with_keys();
    assert!(bench.keygen(&["-q", "-k", "-f", "krl", "key4.pub"]).good);
    compare(&bench, &keys, "krl", &[4]);
    bench.write("more", format!("sha256: {}\n", keys[2].public_key().to_openssh()));
    assert!(bench.keygen(&["-q", "-k", "-u", "-f", "krl", "more"]).good);
    compare(&bench, &keys, "krl", &[2, 4]);
    // A revoked certificate does not revoke its key.
    assert!(bench.keygen(&["-q", "-k", "-f", "certificates", "key0-cert.pub", "key1-cert.pub"]).good);
    compare(&bench, &keys, "certificates", &[]);
}

#[test]
fn lists_of_public_keys_count_as_with_ssh_keygen_verify() {
    let (bench, keys) = bench_with_keys();
    bench.made("rsa", &["-t", "rsa", "-b", "2048", "-N", ""]);
    bench.made("ecdsa", &["-t", "ecdsa", "-N", ""]);
    let others = format!("{}{}", bench.read("rsa.pub"), bench.read("ecdsa.pub"));
    let (lost, sold) = (keys[1].public_key().to_openssh(), keys[3].public_key().to_openssh());
    let list = format!("# lost and sold\n{others}  {lost} lost\n\n{sold}\n");
    bench.write("revoked", &list);
    let ours = RevokedKeys::parse("revoked", list.as_bytes()).unwrap();
    for key in &keys {
        bench.write_signers(&key.public_key());
        let armor = key.sign(NAMESPACE, b"text").unwrap().to_armor();
        let theirs = !bench.verify("signers", &armor, b"text", &["-r", "revoked"]).good;
        assert_eq!(ours.revokes(&key.public_key()).is_some(), theirs);
    }
    assert_eq!(ours.revokes(&keys[1].public_key()).as_deref(), Some("listed in revoked"));
}

#[test]
fn a_list_cut_short_or_continued_is_refused_by_both() {
    let (bench, keys) = bench_with_keys();
    bench
        .write("spec", format!("{}\nsha1: {}\n", keys[0].public_key().to_openssh(), keys[1].public_key().to_openssh()));
    assert!(bench.keygen(&["-q", "-k", "-f", "krl", "spec"]).good);
    let whole = fs::read(bench.path("krl")).unwrap();
    let mut both_read = 0;
    for length in (8..whole.len()).step_by(3).chain([whole.len() - 1]) {
        bench.write("cut", &whole[..length]);
        let theirs = bench.keygen(&["-Q", "-f", "cut", "key5.pub"]);
        let ours = RevokedKeys::parse("cut", &whole[..length]);
        assert_eq!(ours.is_ok(), theirs.good, "{length} bytes: {ours:?}, {}", theirs.errors);
        both_read += usize::from(theirs.good);
    }
    assert!(both_read <= 2, "only a cut between two sections leaves a list");
    bench.write("longer", [&whole[..], &[0]].concat());
    assert!(!bench.keygen(&["-Q", "-f", "longer", "key5.pub"]).good);
    assert!(RevokedKeys::parse("longer", &[&whole[..], &[0]].concat()).is_err());
}

/// Expected: `ssh-keygen -Q` of OpenSSH 9.2 or later. One of the two refuses every list with an extension (known since
/// 9.4) or a signature (refused since 9.4).
#[test]
fn sections_that_some_openssh_refuses_are_refused() {
    let (bench, keys) = bench_with_keys();
    assert!(bench.keygen(&["-q", "-k", "-f", "krl", "key0.pub"]).good);
    let whole = fs::read(bench.path("krl")).unwrap();
    let extension = |critical: u8| [string(b"note@here"), vec![critical], string(b"x")].concat();
    let certificates = |parts: &[u8]| [vec![1], string(&[string(b""), string(b""), parts.to_vec()].concat())].concat();
    for section in [
        [vec![255], string(&extension(0))].concat(),
        [vec![255], string(&extension(1))].concat(),
        certificates(&[vec![0x39], string(&extension(0))].concat()),
        certificates(&[vec![0x39], string(&extension(1))].concat()),
        [vec![4], string(b"key"), string(b"signature")].concat(),
        [vec![6], string(b"")].concat(),
    ] {
        let list = [&whole[..], &section].concat();
        assert!(RevokedKeys::parse("list", &list).is_err(), "{section:x?}");
    }
    assert!(RevokedKeys::parse("krl", &whole).unwrap().revokes(&keys[0].public_key()).is_some());
}

/// The key of an authority revokes nothing here; a list is refused with the keys that OpenSSH refuses, and with those of
/// types that only some versions know.
#[test]
fn the_key_of_an_authority_is_read_as_openssh_reads_it() {
    let (bench, _) = bench_with_keys();
    let of = |authority: &[u8]| {
        bench.write("spec", "id: a\n");
        assert!(bench.keygen(&["-q", "-k", "-s", "authority.pub", "-f", "krl", "spec"]).good);
        let krl = fs::read(bench.path("krl")).unwrap();
        // The header of 44 bytes and a section with the key of the authority, nothing reserved, and the id.
        let id = [vec![0x23], string(&string(b"a"))].concat();
        [&krl[..44], &[1], &string(&[string(authority), string(b""), id].concat())].concat()
    };
    let blob_of = |line: &str| Base64::decode_vec(line.split(' ').nth(1).unwrap()).unwrap();
    let mut compared = [0, 0];
    for (kind, bits) in
        [("rsa", "1024"), ("rsa", "2048"), ("ecdsa", "256"), ("ecdsa", "384"), ("ecdsa", "521"), ("ed25519", "256")]
    {
        let name = format!("{kind}{bits}");
        bench.made(&name, &["-t", kind, "-b", bits, "-N", ""]);
        let blob = blob_of(&bench.read(&format!("{name}.pub")));
        // Whole, cut, continued, and with a changed byte in each length, in the name of the curve and in the first bytes
        // of each field.
        let changed = (0..blob.len().min(60)).map(|at| {
            let mut changed = blob.clone();
            changed[at] ^= 0x80;
            changed
        });
        let cut = [1, 2, 33, 40].map(|bytes| blob[..blob.len() - bytes].to_vec());
        let longer = [blob.clone(), [&blob[..], b"\0"].concat(), [&blob[..], &string(b"x")].concat()];
        for authority in changed.chain(cut).chain(longer) {
            let list = of(&authority);
            bench.write("list", &list);
            let theirs = bench.keygen(&["-Q", "-f", "list", "key5.pub"]);
            let ours = RevokedKeys::parse("list", &list);
            // The bytes of a point decide whether it lies on the curve, which is not computed here.
            if ours.is_ok() != theirs.good {
                assert!(kind == "ecdsa" && ours.is_ok(), "{name}: {authority:x?}: {ours:?}, {}", theirs.errors);
            }
            compared[usize::from(theirs.good)] += 1;
        }
    }
    assert!(compared.iter().all(|count| *count > 20), "{compared:?}");
    for kind in ["ssh-dss", "ssh-mldsa44-ed25519@openssh.com"] {
        let authority = [kind.as_bytes(), b"x", b"x", b"x", b"x"].map(string).concat();
        assert!(RevokedKeys::parse("list", &of(&authority)).is_err(), "{kind}");
    }
}

/// A list with a section of every type that `ssh-keygen -k` writes; each of the first four keys is revoked in a way of
/// its own, or not at all.
fn list_of_every_section(bench: &Bench, keys: &[SigningKey]) -> Vec<u8> {
    let line = |index: usize| keys[index].public_key().to_openssh();
    let serials = "serial: 1-9\nserial: 100\nserial: 103\nserial: 106\nserial: 4000000\n";
    let text = format!("{serials}id: id0\n{}\nsha1: {}\nsha256: {}\n", line(0), line(1), line(2));
    bench.write("every.spec", text);
    let made = bench.keygen(&["-q", "-k", "-s", "authority.pub", "-z", "7", "-f", "every", "every.spec"]);
    assert!(made.good, "{}", made.errors);
    fs::read(bench.path("every")).unwrap()
}

/// Flips bits of the list, `every`-th of all, and compares the verdicts of both programs.
///
/// What OpenSSH refuses is refused, and a key that it still finds revoked is not let through: else one damaged bit would
/// bring a lost key back. A list may be refused that OpenSSH takes: its own bytes are never signed.
fn flip_bits(every: usize) {
    let (bench, keys) = bench_with_keys();
    let whole = list_of_every_section(&bench, &keys);
    let (mut refused, mut read) = (0, 0);
    for bit in (0..8 * whole.len()).step_by(every) {
        let mut flipped = whole.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        bench.write("flipped", &flipped);
        let theirs = bench.keygen(&["-Q", "-f", "flipped", "key0.pub", "key1.pub", "key2.pub", "key3.pub"]);
        let lines: Vec<&str> = theirs.output.lines().collect();
        match RevokedKeys::parse("flipped", &flipped) {
            Err(_) => refused += 1,
            Ok(ours) => {
                assert_eq!(lines.len(), 4, "bit {bit}: OpenSSH refuses the list: {}", theirs.errors);
                for (key, line) in keys.iter().zip(lines) {
                    let why = ours.revokes(&key.public_key());
                    assert_eq!(why.is_some(), line.ends_with("REVOKED"), "bit {bit}: {line}: {why:?}");
                }
                read += 1;
            }
        }
    }
    assert!(refused > 20 && read > 20, "{refused} refused, {read} read");
}

#[test]
fn a_list_with_one_flipped_bit_counts_as_with_openssh() {
    // 11 is odd: every bit of a byte has its turn.
    flip_bits(11);
}

#[test]
#[ignore = "thousands of runs of ssh-keygen"]
fn a_list_with_any_flipped_bit_counts_as_with_openssh() {
    flip_bits(1);
}
