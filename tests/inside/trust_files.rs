//! Files of trust: no reader of them panics, whatever bytes it is given.

use crate::trust::{AllowedSigners, PublicKey, RevokedKeys, Signature, SigningKey};
use proptest::prelude::*;

/// Reads the bytes with every reader of trust files; none may panic.
fn read_all(bytes: &[u8]) {
    let _ = AllowedSigners::parse("f", bytes).map_err(|error| error.to_string());
    let _ = RevokedKeys::parse("f", bytes).map_err(|error| error.to_string());
    let text = String::from_utf8_lossy(bytes);
    let _ = PublicKey::from_openssh(&text);
    let _ = Signature::from_armor(&text);
    let _ = SigningKey::from_openssh(&text, None);
}

fn examples() -> Vec<Vec<u8>> {
    let key = SigningKey::generate().unwrap();
    let line = key.public_key().to_openssh();
    vec![
        format!("\"a b,!ж*\" namespaces=\"x\\\",y\",valid-after=\"20260101Z\" {line} комментарий\n# end\r\n")
            .into_bytes(),
        format!("a,b cert-authority,valid-before=\"202601010000Z\" {line}").into_bytes(),
        b"SSHKRL\n\0\0\0\0\x01________________________\0\0\0\0\0\0\0\0\x02\0\0\0\x05\0\0\0\x01x".to_vec(),
        key.sign("n", b"m").unwrap().to_armor().into_bytes(),
        key.to_openssh("c", None).unwrap().as_bytes().to_vec(),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_reader_panics_on_any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        read_all(&bytes);
    }

    #[test]
    fn no_reader_panics_on_any_text(text in "[a-z\",=!\\\\ \\tжZ0-9#\n-]{0,120}") {
        read_all(text.as_bytes());
    }

    #[test]
    fn no_reader_panics_on_altered_files(edits in prop::collection::vec((any::<usize>(), any::<u8>(), 0..4_u8), 1..8)) {
        for mut bytes in examples() {
            for (at, byte, kind) in &edits {
                let at = at % (bytes.len() + 1);
                match kind {
                    0 => bytes.truncate(at),
                    1 => bytes.insert(at, *byte),
                    _ => bytes.iter_mut().skip(at).take(1).for_each(|old| *old = *byte),
                }
            }
            read_all(&bytes);
        }
    }
}
