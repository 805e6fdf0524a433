//! Key files: ours before `ssh-keygen`, theirs before us.

use crate::Bench;
use dtg_passport::trust::{KeyError, PublicKey, SigningKey};

const PASSPHRASE: &str = "wet towel 湿";

#[test]
fn ssh_keygen_reads_what_we_write() {
    let bench = Bench::new();
    for (name, passphrase) in [("plain", None), ("encrypted", Some(PASSPHRASE)), ("short", Some("x"))] {
        let key = SigningKey::generate().unwrap();
        bench.write_key(name, &key.to_openssh("bench 7, hall Ж", passphrase).unwrap());
        let public = bench.keygen(&["-y", "-P", passphrase.unwrap_or(""), "-f", name]);
        assert!(public.good, "{name}: {}", public.errors);
        assert_eq!(public.output, format!("{} bench 7, hall Ж\n", key.public_key().to_openssh()));
        let printed = bench.keygen(&["-l", "-f", name]).output;
        assert_eq!(printed.split(' ').nth(1), Some(key.public_key().fingerprint().as_str()), "{printed}");
        let wrong = bench.keygen(&["-y", "-P", "another", "-f", name]);
        assert_eq!(wrong.good, passphrase.is_none(), "{name}");
    }
}

#[test]
fn we_read_what_ssh_keygen_writes() {
    let bench = Bench::new();
    let ciphers = [
        "aes256-ctr",
        "aes192-ctr",
        "aes128-ctr",
        "aes256-cbc",
        "aes128-cbc",
        "aes256-gcm@openssh.com",
        "aes128-gcm@openssh.com",
        "chacha20-poly1305@openssh.com",
    ];
    for (index, cipher) in [None].into_iter().chain(ciphers.map(Some)).enumerate() {
        let name = format!("key{index}");
        let passphrase = cipher.map(|_| PASSPHRASE);
        let mut arguments = vec!["-t", "ed25519", "-N", passphrase.unwrap_or(""), "-C", "lab"];
        arguments.extend(cipher.iter().flat_map(|cipher| ["-Z", cipher]));
        bench.made(&name, &arguments);
        let pem = bench.read(&name);
        let key = SigningKey::from_openssh(&pem, passphrase).unwrap_or_else(|error| panic!("{cipher:?}: {error}"));
        let line = bench.read(&format!("{name}.pub"));
        assert_eq!(PublicKey::from_openssh(&line), Ok(key.public_key()));
        assert_eq!(line, format!("{} lab\n", key.public_key().to_openssh()));
        if cipher.is_some() {
            assert_eq!(SigningKey::from_openssh(&pem, None).unwrap_err(), KeyError::Encrypted);
            assert_eq!(SigningKey::from_openssh(&pem, Some("another")).unwrap_err(), KeyError::WrongPassphrase);
        }
    }
}

#[test]
fn files_of_other_kinds_are_named() {
    let bench = Bench::new();
    let made: [(&str, &[&str], &str); 8] = [
        ("rsa", &["-t", "rsa", "-b", "2048", "-N", ""], "found a key of type ssh-rsa, expected ssh-ed25519"),
        ("sealed", &["-t", "rsa", "-b", "2048", "-N", "passphrase"], "found a key of type ssh-rsa"),
        ("ecdsa", &["-t", "ecdsa", "-N", ""], "found a key of type ecdsa-sha2-nistp256"),
        ("dsa", &["-t", "dsa", "-N", ""], "found a key of type ssh-dss"),
        ("pem", &["-t", "rsa", "-b", "2048", "-N", "", "-m", "PEM"], "an RSA key in PEM"),
        ("ecpem", &["-t", "ecdsa", "-N", "", "-m", "PEM"], "an ECDSA key in PEM"),
        ("pkcs8", &["-t", "rsa", "-b", "2048", "-N", "", "-m", "PKCS8"], "a private key in PKCS#8"),
        ("3des", &["-t", "ed25519", "-N", "passphrase", "-Z", "3des-cbc"], "encrypted with 3des-cbc"),
    ];
    for (name, arguments, words) in made {
        bench.made(name, arguments);
        let refused = SigningKey::from_openssh(&bench.read(name), None).unwrap_err().to_string();
        assert!(refused.contains(words), "{name}: {refused}");
        let refused = SigningKey::from_openssh(&bench.read(&format!("{name}.pub")), None).unwrap_err().to_string();
        assert!(refused.contains("found a public key"), "{name}.pub: {refused}");
    }
}
