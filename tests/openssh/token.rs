//! Security keys (FIDO tokens): signatures made here after PROTOCOL.u2f, and those that `ssh-keygen` gets from a token in
//! software, `tests/openssh/sk_software_token.c`.

use crate::{Bench, NAMESPACE, PRINCIPAL, run};
use dtg_passport::trust::{KeyError, PublicKey, Signature, SignatureError, SigningKey};
use ed25519_dalek::Signer as _;
use sha2::{Digest as _, Sha256};
use ssh_key::public::{Ed25519PublicKey, KeyData, SkEd25519};
use ssh_key::{Algorithm, HashAlg, LineEnding, SshSig};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

const MESSAGE: &[u8] = b"format: \"dtg-passport/1\"\n";

/// A security key whose secret is known, so that every part of its signature can be chosen.
struct Token {
    secret: ed25519_dalek::SigningKey,
    application: &'static str,
}

impl Token {
    fn key(&self, application: &str) -> KeyData {
        SkEd25519::new(Ed25519PublicKey(self.secret.verifying_key().to_bytes()), application).into()
    }

    /// The signed bytes of PROTOCOL.u2f, and after them flags and counter.
    fn sign(&self, namespace: &str, flags: u8, counter: u32) -> Vec<u8> {
        let signed = SshSig::signed_data(namespace, HashAlg::Sha512, MESSAGE).unwrap();
        let trailer = [&[flags][..], &counter.to_be_bytes()].concat();
        let bytes = [&Sha256::digest(self.application)[..], &trailer, &Sha256::digest(signed)].concat();
        [&self.secret.sign(&bytes).to_bytes()[..], &trailer].concat()
    }

    fn armor(&self, application: &str, signature: Vec<u8>) -> String {
        let signature = ssh_key::Signature::new(Algorithm::SkEd25519, signature).unwrap();
        let block = SshSig::new(self.key(application), NAMESPACE, HashAlg::Sha512, signature).unwrap();
        block.to_pem(LineEnding::LF).unwrap()
    }

    fn line(&self, application: &str) -> String {
        ssh_key::PublicKey::from(self.key(application)).to_openssh().unwrap()
    }
}

fn token() -> Token {
    let pem = SigningKey::generate().unwrap().to_openssh("", None).unwrap();
    let pair = ssh_key::PrivateKey::from_openssh(pem.as_bytes()).unwrap();
    let secret = ed25519_dalek::SigningKey::try_from(pair.key_data().ed25519().unwrap()).unwrap();
    Token { secret, application: "ssh:" }
}

fn accepted(armor: &str) -> bool {
    Signature::from_armor(armor).is_ok_and(|signature| signature.verify(NAMESPACE, MESSAGE).is_ok())
}

#[test]
fn signatures_after_the_protocol_are_accepted_by_both() {
    let (bench, token) = (Bench::new(), token());
    bench.write("signers", format!("{PRINCIPAL} {}\n", token.line("ssh:")));
    assert!(PublicKey::from_openssh(&token.line("ssh:")).unwrap().is_security_key());
    // User present; user verified too; neither: whether a touch is asked for is a property of the key.
    for (flags, counter) in [(1, 1), (5, 77), (1, u32::MAX), (0, 2)] {
        let armor = token.armor("ssh:", token.sign(NAMESPACE, flags, counter));
        let theirs = bench.verify("signers", &armor, MESSAGE, &[]);
        assert!(theirs.good, "flags {flags}: {}", theirs.errors);
        assert!(accepted(&armor), "flags {flags}");
        assert_eq!(Signature::from_armor(&armor).unwrap().to_armor(), armor);
    }
}

#[test]
fn every_altered_part_is_refused_by_both() {
    let (bench, token) = (Bench::new(), token());
    let good = token.sign(NAMESPACE, 1, 42);
    let lines = [token.line("ssh:"), token.line("ssh:other")].map(|line| format!("{PRINCIPAL} {line}\n"));
    bench.write("signers", lines.concat());
    // Each bit of the signature, the flags and the counter; of the first 64 bytes ssh-keygen sees one bit each.
    for bit in 0..8 * good.len() {
        let mut altered = good.clone();
        altered[bit / 8] ^= 1 << (bit % 8);
        let armor = token.armor("ssh:", altered);
        assert!(!accepted(&armor), "bit {bit}");
        if bit >= 8 * 64 || bit % 8 == 3 {
            assert!(!bench.verify("signers", &armor, MESSAGE, &[]).good, "bit {bit}");
        }
    }
    for (name, armor) in [
        ("another application", token.armor("ssh:other", good.clone())),
        ("another namespace inside", token.armor("ssh:", token.sign("dtg-register", 1, 42))),
    ] {
        assert!(!accepted(&armor), "{name}");
        assert!(!bench.verify("signers", &armor, MESSAGE, &[]).good, "{name}");
    }
    let armor = token.armor("ssh:", good);
    assert!(!bench.verify("signers", &armor, b"other text", &[]).good);
    let refused = Signature::from_armor(&armor).unwrap().verify(NAMESPACE, b"other text");
    assert_eq!(refused, Err(SignatureError::DoesNotHold));
}

#[test]
fn a_signature_of_the_other_type_than_its_key_is_refused() {
    let token = token();
    let plain = ssh_key::Signature::new(Algorithm::Ed25519, &token.sign(NAMESPACE, 1, 1)[..64]).unwrap();
    let block = SshSig::new(token.key("ssh:"), NAMESPACE, HashAlg::Sha512, plain).unwrap();
    let refused = Signature::from_armor(&block.to_pem(LineEnding::LF).unwrap());
    assert!(matches!(refused, Err(SignatureError::Algorithm { .. })), "{refused:?}");
}

#[test]
fn an_application_that_ends_early_is_refused_by_both() {
    let (bench, mut token) = (Bench::new(), token());
    token.application = "ssh:\0x";
    bench.write("signers", format!("{PRINCIPAL} {}\n", token.line(token.application)));
    let armor = token.armor(token.application, token.sign(NAMESPACE, 1, 1));
    assert!(!bench.verify("signers", &armor, MESSAGE, &[]).good);
    assert!(matches!(Signature::from_armor(&armor), Err(SignatureError::Damaged(_))));
    assert!(matches!(PublicKey::from_openssh(&token.line(token.application)), Err(KeyError::DamagedPublicKey(_))));
}

/// The provider library, built once into the target folder.
pub(crate) fn provider() -> &'static Path {
    static PROVIDER: OnceLock<PathBuf> = OnceLock::new();
    PROVIDER.get_or_init(|| {
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/openssh/sk_software_token.c");
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
        let library = folder.join("sk_software_token.so");
        let built = folder.join(format!("sk_software_token.{}.so", std::process::id()));
        let mut gcc = Command::new("gcc");
        gcc.args(["-shared", "-fPIC", "-O2", "-Wall", "-Wextra", "-Werror", "-o"])
            .arg(&built)
            .arg(source)
            .arg("-lcrypto");
        let finished = run(&mut gcc, b"");
        assert!(finished.good, "gcc (needs OpenSSL's headers, Debian: libssl-dev): {}", finished.errors);
        std::fs::rename(built, &library).expect("the library in the target folder");
        library
    })
}

#[test]
fn ssh_keygen_signs_through_a_token_and_we_verify() {
    let bench = Bench::new();
    bench.with_token(&["-q", "-t", "ed25519-sk", "-N", "", "-C", "token", "-f", "key"], b"");
    let key = PublicKey::from_openssh(&bench.read("key.pub")).unwrap();
    assert_eq!(bench.read("key.pub"), format!("{} token\n", key.to_openssh()));
    assert!(bench.keygen(&["-l", "-f", "key.pub"]).output.contains(&key.fingerprint()));
    for message in [&b""[..], MESSAGE, &[7; 100_000]] {
        let armor = bench.with_token(&["-Y", "sign", "-q", "-f", "key", "-n", NAMESPACE], message);
        let signature = Signature::from_armor(&armor).unwrap();
        assert_eq!(signature.public_key(), &key);
        assert_eq!(signature.verify(NAMESPACE, message), Ok(()));
        assert_eq!(signature.verify(NAMESPACE, b"other text"), Err(SignatureError::DoesNotHold));
        bench.write_signers(&key);
        assert!(bench.verify("signers", &armor, message, &[]).good);
    }
    assert_eq!(SigningKey::from_openssh(&bench.read("key"), None).unwrap_err(), KeyError::SecurityKey);
}
