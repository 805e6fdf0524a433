//! Signatures: ours before `ssh-keygen -Y verify`, theirs before us.

use crate::{Bench, NAMESPACE, PRINCIPAL};
use base64ct::{Base64, Encoding as _};
use dtg_passport::trust::{Signature, SignatureError, SigningKey};

fn message(length: usize) -> Vec<u8> {
    (0..length).map(|index| (index * 7 + index / 251) as u8).collect()
}

fn bench_with_key() -> (Bench, SigningKey) {
    let bench = Bench::new();
    let key = bench.new_key("key");
    bench.write_signers(&key.public_key());
    (bench, key)
}

#[test]
fn both_sign_the_same_bytes_and_each_verifies_the_other() {
    let (bench, key) = bench_with_key();
    for length in [0, 1, 2, 31, 32, 63, 64, 65, 111, 112, 127, 128, 129, 1_000, 4_096, 65_536, 1 << 20] {
        let message = message(length);
        let ours = key.sign(NAMESPACE, &message).unwrap();
        let theirs = bench.sign("key", &message);
        assert_eq!(ours.to_armor(), theirs, "{length} bytes");
        let verified = bench.verify("signers", &ours.to_armor(), &message, &[]);
        assert!(verified.good, "{length} bytes: {}", verified.errors);
        let read = Signature::from_armor(&theirs).unwrap();
        assert_eq!(read.verify(NAMESPACE, &message), Ok(()));
        assert_eq!(read.public_key(), &key.public_key());
    }
}

#[test]
fn altered_text_and_another_namespace_are_refused_by_both() {
    let (bench, key) = bench_with_key();
    let good = key.sign(NAMESPACE, b"alpha: 1.0\n").unwrap();
    assert!(!bench.verify("signers", &good.to_armor(), b"alpha: 1.1\n", &[]).good);
    assert_eq!(good.verify(NAMESPACE, b"alpha: 1.1\n"), Err(SignatureError::DoesNotHold));
    let other = key.sign("dtg-register", b"alpha: 1.0\n").unwrap();
    assert!(!bench.verify("signers", &other.to_armor(), b"alpha: 1.0\n", &[]).good);
    assert!(matches!(other.verify(NAMESPACE, b"alpha: 1.0\n"), Err(SignatureError::WrongNamespace { .. })));
}

#[test]
fn what_ssh_keygen_accepts_and_we_refuse() {
    let (bench, key) = bench_with_key();
    let armor = key.sign(NAMESPACE, b"text").unwrap().to_armor();
    let base64: String = armor.lines().filter(|line| !line.starts_with('-')).collect();
    let mut blob = Base64::decode_vec(&base64).unwrap();
    let armored = |base64: &str| format!("-----BEGIN SSH SIGNATURE-----\n{base64}\n-----END SSH SIGNATURE-----\n");
    // Base64 in one line, text behind the armor, and a version that is not signed.
    let one_line = armored(&base64);
    let followed = format!("{armor}revoked: true\n");
    blob[9] = 0;
    let version = armored(&Base64::encode_string(&blob));
    for (name, altered) in [("one line", one_line), ("text behind", followed), ("version 0", version)] {
        assert!(bench.verify("signers", &altered, b"text", &[]).good, "{name}");
        assert!(Signature::from_armor(&altered).is_err(), "{name}");
    }
}

/// The neutral element as a public key, with the signature that any text has under it: R neutral, S zero.
#[test]
fn a_weak_key_that_signs_everything_is_refused() {
    let bench = Bench::new();
    let mut neutral = [0; 32];
    neutral[0] = 1;
    let key = ssh_key::public::KeyData::from(ssh_key::public::Ed25519PublicKey(neutral));
    let line = ssh_key::PublicKey::from(key.clone()).to_openssh().unwrap();
    bench.write("signers", format!("{PRINCIPAL} {line}\n"));
    let zero = [neutral, [0; 32]].concat();
    let signature = ssh_key::Signature::new(ssh_key::Algorithm::Ed25519, zero).unwrap();
    let block = ssh_key::SshSig::new(key, NAMESPACE, ssh_key::HashAlg::Sha512, signature).unwrap();
    let armor = block.to_pem(ssh_key::LineEnding::LF).unwrap();
    assert!(bench.verify("signers", &armor, b"anything", &[]).good, "ssh-keygen has become stricter");
    let read = Signature::from_armor(&armor).unwrap();
    assert_eq!(read.verify(NAMESPACE, b"anything"), Err(SignatureError::DoesNotHold));
}
