//! Contents of files that put hostile text wherever the program might repeat it.

use super::scene::POISON;
use base64ct::{Base64, Encoding};
use dtg_passport::trust::SigningKey;

/// The same as far as ASCII goes: names of algorithms in a signature are read up to 48 bytes.
const ASCII_POISON: &str = "a\nVALID  forged\r\t\u{8}evil\u{1b}[1m\u{1b}[45m\u{1b}]0;b\u{7}\u{7f}@z";

/// What POISON holds within one line of text without a control character.
const LINE_POISON: &str = "evil\u{202e}\u{2066}\u{2069}\u{200b}\u{2060}\u{feff}\u{ad}\u{3164}\u{e0041}\u{301}z";

/// Hostile contents for a file that is `good`, by the kind that it has.
pub fn contents(file: &str, good: &str) -> Vec<(&'static str, Vec<u8>)> {
    let escaped: String = POISON.chars().map(|c| format!("\\U{:08X}", u32::from(c))).collect();
    let json: String = POISON.encode_utf16().map(|unit| format!("\\u{unit:04x}")).collect();
    let mut all = vec![
        ("that is none", [POISON.as_bytes(), b"\xff"].concat()),
        ("of one line", format!("{LINE_POISON}\n").into_bytes()),
        ("of one key", format!("\"{escaped}\": 1\n").into_bytes()),
        ("with a tag", format!("a: !{LINE_POISON} 1\n").into_bytes()),
        ("with an alias", format!("a: *{LINE_POISON}\n").into_bytes()),
    ];
    let quoted = |text: &str| {
        // Every quoted text but the format.
        let parts = good.split('"').enumerate();
        let parts = parts.map(|(index, part)| if index % 2 == 1 && !part.starts_with("dtg-") { text } else { part });
        parts.collect::<Vec<_>>().join("\"").into_bytes()
    };
    if file.ends_with(".yaml") || file.ends_with(".json") {
        all.push(("with texts escaped", quoted(if file.ends_with(".json") { &json } else { &escaped })));
        all.push(("with texts as they are", quoted(LINE_POISON)));
        let line = |line: &str| format!("{}{line}\n", good.split("signature: |").next().unwrap_or(good)).into_bytes();
        all.push(("with one key more", line(&format!("\"{escaped}\": \"x\""))));
        all.push(("with a comment", line(&format!("# {POISON}"))));
    }
    if file.ends_with(".csv") {
        let header = good.lines().find(|line| line.starts_with(|c: char| c.is_ascii_lowercase())).unwrap();
        all.push((
            "with a cell",
            format!("{header}\n{}", header.split(',').map(|_| LINE_POISON).collect::<Vec<_>>().join(",")).into_bytes(),
        ));
        all.push(("with a column", good.replace(header, &format!("{header},{LINE_POISON}")).into_bytes()));
        all.push(("with another column", good.replace(header, &header.replacen('i', LINE_POISON, 1)).into_bytes()));
    }
    if file.contains("passport.yaml") || file == "register.yaml" {
        all.extend(signatures(good));
    }
    if file == "allowed_signers" || file == "key.pub" {
        let key = good.split(' ').skip_while(|word| !word.starts_with("ssh-")).collect::<Vec<_>>().join(" ");
        for (what, line) in [
            ("with a principal", format!("{LINE_POISON} {key}")),
            ("with a quoted principal", format!("\"a {LINE_POISON}\" {key}")),
            ("with a namespace", format!("factory namespaces=\"{LINE_POISON}\" {key}")),
            ("with an option", format!("factory {LINE_POISON}=\"a\" {key}")),
            ("with a date", format!("factory valid-after=\"{LINE_POISON}\" {key}")),
            ("with a type", format!("factory ssh-{LINE_POISON} AAAA")),
            ("with a certificate", format!("factory ssh-{LINE_POISON}-cert-v01@a AAAA")),
            ("with a type alone", format!("ssh-{LINE_POISON} AAAA")),
            (
                "with another type inside",
                format!("factory ssh-ed25519 {}", Base64::encode_string(&string(ASCII_POISON.as_bytes()))),
            ),
        ] {
            all.push((what, line.into_bytes()));
        }
        let extension = [string(POISON.as_bytes()), vec![1], string(b"")].concat();
        let head = [&b"SSHKRL\n\0\0\0\0\x01"[..], &[0; 24], &string(b""), &string(POISON.as_bytes())].concat();
        all.push(("with an extension", [head, vec![255], string(&extension)].concat()));
    }
    if file == "key" {
        for (what, cipher, kind) in [("of a cipher", POISON, "ssh-ed25519"), ("of a type", "none", POISON)] {
            let key = string(kind.as_bytes());
            let parts =
                [string(cipher.as_bytes()), string(b"none"), string(b""), vec![0, 0, 0, 1], string(&key), string(b"")];
            let base64 = Base64::encode_string(&[b"openssh-key-v1\0".to_vec(), parts.concat()].concat());
            let pem = format!("-----BEGIN OPENSSH PRIVATE KEY-----\n{base64}\n-----END OPENSSH PRIVATE KEY-----\n");
            all.push((what, pem.into_bytes()));
        }
        all.push(("of a label", format!("-----BEGIN {LINE_POISON} KEY-----\nAAAA\n").into_bytes()));
    }
    all
}

/// A string as SSH transmits it.
fn string(bytes: &[u8]) -> Vec<u8> {
    [&(bytes.len() as u32).to_be_bytes()[..], bytes].concat()
}

/// The document with other signatures under it, a label of each hostile (PROTOCOL.sshsig).
fn signatures(good: &str) -> Vec<(&'static str, Vec<u8>)> {
    let payload = good.split("signature: |").next().unwrap();
    let namespace = if payload.contains("dtg-register/1") { "dtg-register" } else { "dtg-passport" };
    let key = SigningKey::generate().unwrap();
    let line = key.public_key().to_openssh();
    let blob = Base64::decode_vec(line.split(' ').nth(1).unwrap()).unwrap();
    let algorithm = |name: &str, rest: &[u8]| string(&[string(name.as_bytes()), rest.to_vec()].concat());
    let ed25519 = string(&blob);
    let signature = algorithm("ssh-ed25519", &string(&[0; 64]));
    let block = |key: &[u8], namespace: &str, hash: &str, signature: &[u8]| {
        let parts = [
            b"SSHSIG",
            &1_u32.to_be_bytes()[..],
            key,
            &string(namespace.as_bytes()),
            &string(b""),
            &string(hash.as_bytes()),
            signature,
        ];
        let base64 = Base64::encode_string(&parts.concat());
        let lines: Vec<_> =
            base64.as_bytes().chunks(70).map(|line| format!("  {}\n", str::from_utf8(line).unwrap())).collect();
        format!(
            "{payload}signature: |\n  -----BEGIN SSH SIGNATURE-----\n{}  -----END SSH SIGNATURE-----\n",
            lines.concat()
        )
        .into_bytes()
    };
    vec![
        (
            "signed by a key of a type",
            block(&algorithm(ASCII_POISON, &string(&[0; 32])), namespace, "sha512", &signature),
        ),
        (
            "signed by a key of a long type",
            block(&algorithm(POISON, &string(&[0; 32])), namespace, "sha512", &signature),
        ),
        ("with a hash", block(&ed25519, namespace, POISON, &signature)),
        ("with a namespace", block(&ed25519, POISON, "sha512", &signature)),
        ("with an algorithm", block(&ed25519, namespace, "sha512", &algorithm(ASCII_POISON, &string(&[0; 64])))),
        ("with a long algorithm", block(&ed25519, namespace, "sha512", &algorithm(POISON, &string(&[0; 64])))),
        ("signed by another", block(&ed25519, namespace, "sha512", &signature)),
    ]
}
