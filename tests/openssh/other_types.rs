//! Keys that cannot sign passports: in lists they are skipped, as by OpenSSH, and a signature by one is refused by its type.
//!
//! The real `ssh-keygen` makes RSA, ECDSA and certificates. ML-DSA needs OpenSSH 10.4, so its lines and its armor are put
//! together here by the form of the draft (draft-miller-sshm-mldsa44-ed25519-composite-sigs) and of PROTOCOL.sshsig.

use crate::allowed_signers::with_case;
use crate::{Bench, Finished, NAMESPACE, PRINCIPAL, SIGNATURE_LINE, armored, joined, project, string};
use base64ct::{Base64, Encoding as _};
use dtg_passport::trust::{AllowedSigners, RevokedKeys, Signature, SignatureError};
use std::process::Command;

const ML_DSA: &str = "ssh-mldsa44-ed25519@openssh.com";
const CERTIFICATE: &str = "ssh-ed25519-cert-v01@openssh.com";
const NOW: &str = "20260315120000Z";

/// The key of ML-DSA-44 (1,312 bytes, FIPS 204) and the one of Ed25519, in one string.
fn ml_dsa_blob() -> Vec<u8> {
    [string(ML_DSA.as_bytes()), string(&[7; 1312 + 32])].concat()
}

fn line_of(algorithm: &str, blob: &[u8]) -> String {
    format!("{algorithm} {}", Base64::encode_string(blob))
}

fn ml_dsa() -> String {
    line_of(ML_DSA, &ml_dsa_blob())
}

/// A block of SSHSIG with a signature of ML-DSA-44 (2,420 bytes, FIPS 204) and one of Ed25519.
fn ml_dsa_armor() -> String {
    let signature = [string(ML_DSA.as_bytes()), string(&[9; 2420 + 64])].concat();
    let fields = [&ml_dsa_blob()[..], NAMESPACE.as_bytes(), b"", b"sha512", &signature].map(string).concat();
    armored(&[b"SSHSIG\0\0\0\x01", &fields[..]].concat())
}

/// Makes keys of other types, and a certificate of `key`; returns their lines.
fn others(bench: &Bench) -> Vec<String> {
    for (kind, bits) in [("rsa", "2048"), ("ecdsa", "256"), ("ecdsa", "384"), ("ecdsa", "521"), ("dsa", "1024")] {
        bench.made(&format!("{kind}{bits}"), &["-t", kind, "-b", bits, "-N", ""]);
    }
    bench.new_key("authority");
    let signed = bench.keygen(&["-q", "-s", "authority", "-I", "id", "-n", PRINCIPAL, "key.pub"]);
    assert!(signed.good, "{}", signed.errors);
    let names = ["rsa2048", "ecdsa256", "ecdsa384", "ecdsa521", "dsa1024", "key-cert"];
    let made = names.iter().map(|name| bench.read(&format!("{name}.pub")).trim_end().to_owned());
    // A type of the future, whose name begins in no known way.
    let future = "hqc-ed25519@example.org";
    made.chain([ml_dsa(), line_of(future, &[string(future.as_bytes()), string(b"x")].concat())]).collect()
}

#[test]
fn in_allowed_signers_they_are_skipped_as_by_ssh_keygen() {
    with_case(|case| {
        let text: String = others(case.bench).iter().map(|line| format!("{PRINCIPAL} {line}\n")).collect();
        case.compare(&text, NOW);
        let own = format!("{PRINCIPAL} {}\n", case.key.public_key().to_openssh());
        case.compare(&format!("{text}{own}"), NOW);
        case.compare(&format!("{own}{PRINCIPAL} namespaces=\"git\" {}\n", ml_dsa()), NOW);
        // A damaged line is an error here, whatever its type.
        for damaged in [&ml_dsa()[..ml_dsa().len() - 3], &ml_dsa()[..ml_dsa().len() - 4]] {
            let refused = AllowedSigners::parse("f", format!("{own}a {damaged}\n").as_bytes()).unwrap_err().to_string();
            assert!(refused.starts_with("f:2:35: key: found damaged public key ("), "{refused}");
        }
    });
}

/// Expected: `ssh-keygen -Y verify -r`, which stops at a type that it does not know, so it gets the known ones alone; a
/// certificate revokes its key.
#[test]
fn in_lists_of_keys_they_are_skipped_and_a_certificate_revokes_its_key() {
    let bench = Bench::new();
    let keys = ["key", "other"].map(|name| bench.new_key(name));
    let lines = others(&bench);
    for (known, unknown) in [(&lines[..5], &lines[6..]), (&lines[5..6], &lines[..0])] {
        bench.write("revoked", known.join("\n") + "\n");
        let list = [known, unknown].concat().join("\n") + "\n";
        let ours = RevokedKeys::parse("revoked", list.as_bytes()).unwrap();
        for key in &keys {
            bench.write_signers(&key.public_key());
            let armor = key.sign(NAMESPACE, b"text").unwrap().to_armor();
            let theirs = bench.verify("signers", &armor, b"text", &["-r", "revoked"]);
            assert_eq!(ours.revokes(&key.public_key()).is_some(), !theirs.good, "{list}{}", theirs.errors);
        }
        assert_eq!(ours.revokes(&keys[0].public_key()).is_some(), unknown.is_empty());
    }
}

fn verify(bench: &Bench, file: &str, more: &[&str]) -> (Finished, serde_json::Value) {
    let mut program = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
    program.args(["verify", file, "--trust", "signers", "--time", "2026-12-01", "--format", "json"]).args(more);
    let finished = bench.run(&mut program, b"");
    let json = serde_json::from_str(&finished.output).unwrap_or_default();
    (finished, json)
}

fn bench_with_passport() -> Bench {
    let bench = Bench::new();
    bench.write("good.yaml", project("passports/SPS-2/0017/moscow-bmstu-1.yaml"));
    bench.write("signers", project("docs/allowed_signers"));
    bench.new_key("key");
    bench
}

#[test]
fn a_signature_by_one_is_refused_by_its_type() {
    let bench = bench_with_passport();
    others(&bench);
    let text = bench.read("good.yaml");
    let (payload, _) = text.split_once(SIGNATURE_LINE).unwrap();
    let armor = |key: &str| bench.sign(key, payload.as_bytes());
    let signed = [
        (ML_DSA, ml_dsa_armor()),
        ("ssh-rsa", armor("rsa2048")),
        ("ecdsa-sha2-nistp256", armor("ecdsa256")),
        ("ecdsa-sha2-nistp521", armor("ecdsa521")),
        (CERTIFICATE, armor("key-cert.pub")),
    ];
    for (due, armor) in signed {
        assert_eq!(Signature::from_armor(&armor), Err(SignatureError::KeyType(due.to_owned())));
        bench.write("other.yaml", joined(payload, &armor));
        let (finished, json) = verify(&bench, "other.yaml", &[]);
        let check = &json[0]["checks"][0];
        assert_eq!((&check["name"], &check["code"]), (&"grammar".into(), &"unsupported_key".into()), "{due}");
        let detail = check["detail"].as_str().unwrap();
        assert!(detail.contains(due) && !finished.good, "{detail}");
        assert!(!["damage", "changed", "altered"].iter().any(|word| detail.contains(word)), "{detail}");
        // Cut or altered, it is damaged.
        for damaged in [armor.replacen("U1NIU0lH", "U1NIU0lI", 1), armor.replacen("\n-----END", "A\n-----END", 1)] {
            let refused = Signature::from_armor(&damaged);
            assert!(matches!(refused, Err(SignatureError::Damaged(_))), "{due}: {refused:?}");
        }
    }
    assert!((5_390..5_420).contains(&ml_dsa_armor().len()), "{}", ml_dsa_armor().len());
}

/// Expected: the good passport stays valid, and one remark has the number of all that were skipped.
#[test]
fn skipped_keys_are_one_remark() {
    let bench = bench_with_passport();
    let lines = others(&bench);
    let signers: String = lines.iter().map(|line| format!("a {line}\n")).collect();
    bench.write("signers", bench.read("signers") + &signers);
    bench.write("revoked", format!("{}\n{}\n", lines[0], ml_dsa()));
    for (more, due) in [(&[][..], "8 keys were skipped"), (&["--revoked", "revoked"], "10 keys were skipped")] {
        let (finished, json) = verify(&bench, "good.yaml", more);
        assert!(finished.good && json[0]["valid"] == true, "{}{}", finished.output, finished.errors);
        assert_eq!(finished.errors.matches("skipped").count(), 1, "{}", finished.errors);
        assert!(finished.errors.contains(due), "{}", finished.errors);
    }
}
