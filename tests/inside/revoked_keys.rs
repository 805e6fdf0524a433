//! Lists of revoked keys: key revocation lists of OpenSSH, and lists of public keys.

use crate::trust::RevokedKeys;

/// First bytes of a key revocation list (PROTOCOL.krl, section 1).
const MAGIC: &[u8] = b"SSHKRL\n\0";

/// Writes a string: its length in four bytes, then its bytes (RFC 4251, section 5).
fn string(bytes: &[u8]) -> Vec<u8> {
    [&u32::try_from(bytes.len()).unwrap().to_be_bytes()[..], bytes].concat()
}

fn section(kind: u8, items: &[&[u8]]) -> Vec<u8> {
    let body: Vec<u8> = items.iter().flat_map(|item| string(item)).collect();
    [vec![kind], string(&body)].concat()
}

fn list(sections: &[Vec<u8>]) -> Vec<u8> {
    let header = [MAGIC, &[0, 0, 0, 1], &[0; 24], &[0; 4], &string(b"why")].concat();
    [header, sections.concat()].concat()
}

fn refused(bytes: &[u8]) -> String {
    RevokedKeys::parse("krl", bytes).unwrap_err().to_string()
}

#[test]
fn a_file_may_be_as_large_as_stated_and_no_larger() {
    let comment = |bytes: usize| "#".repeat(bytes).into_bytes();
    // 44 bytes precede the comment of a key revocation list.
    let empty = |bytes: usize| [MAGIC, &[0, 0, 0, 1], &[0; 24], &[0; 4], &string(&vec![b'x'; bytes - 44])].concat();
    for file in [&comment as &dyn Fn(usize) -> Vec<u8>, &empty] {
        assert!(RevokedKeys::parse("krl", &file(16_777_216)).is_ok());
        assert!(refused(&file(16_777_217)).contains("found 16777217 bytes, expected at most 16777216"));
    }
}

/// Expected: OpenSSH's krl.c, `parse_revoked_certs`.
#[test]
fn certificates_are_read_to_their_last_byte() {
    let certificates = |parts: &[(u8, Vec<u8>)]| {
        let parts: Vec<u8> = parts.iter().flat_map(|(kind, part)| [vec![*kind], string(part)].concat()).collect();
        list(&[[vec![1], string(&[string(b""), string(b""), parts].concat())].concat()])
    };
    let numbers = |numbers: &[u64]| numbers.iter().flat_map(|number| number.to_be_bytes()).collect::<Vec<u8>>();
    let bitmap = |first: u64, bits: &[u8]| [numbers(&[first]), string(bits)].concat();
    let last = u64::MAX;
    for good in [
        (0x20, numbers(&[1, 5, last])),
        (0x21, numbers(&[5, 5])),
        (0x22, bitmap(7, &[0, 0x80])),
        (0x22, bitmap(0, &[2])),
        (0x22, bitmap(last - 1, &[3])),
        (0x22, bitmap(last - 8, &[1, 0])),
        (0x22, bitmap(1, &[1; 2048])),
        (0x22, bitmap(1, &[0; 2049])),
        (0x23, [string(b"id"), string(b"other\0")].concat()),
    ] {
        assert!(RevokedKeys::parse("krl", &certificates(std::slice::from_ref(&good))).is_ok(), "{good:x?}");
    }
    for (part, words) in [
        ((0x20, numbers(&[0])), "invalid serial numbers at byte 60"),
        ((0x20, vec![1; 7]), "an item of 8 bytes"),
        ((0x21, numbers(&[6, 5])), "invalid serial numbers"),
        ((0x21, numbers(&[1, 2, 3])), "8 unread bytes"),
        ((0x22, bitmap(7, &[0x80])), "invalid serial numbers"),
        ((0x22, bitmap(0, &[1])), "invalid serial numbers"),
        ((0x22, bitmap(last - 1, &[4])), "invalid serial numbers"),
        ((0x22, bitmap(last - 7, &[1, 0])), "invalid serial numbers"),
        ((0x22, bitmap(1, &[1; 2049])), "invalid serial numbers"),
        ((0x23, string(b"a\0b")), "a NUL within the text"),
        ((0x22, bitmap(1, &[0; 2050])), "invalid serial numbers"),
        ((0x24, vec![]), "a section of type 36 at byte 60"),
        // OpenSSH 9.2 knows no extensions.
        ((0x39, [string(b"note@here"), vec![0], string(b"x")].concat()), "a section of type 57 at byte 60"),
    ] {
        let refused = refused(&certificates(&[part]));
        assert!(refused.contains(words), "{refused}");
    }
}

#[test]
fn what_cannot_be_understood_is_refused_with_its_place() {
    let extension = [vec![255], string(&[string(b"note@here"), vec![0], string(b"")].concat())].concat();
    for (bytes, words) in [
        (list(&[section(6, &[])]), "a section of type 6 at byte 47"),
        (list(&[[section(4, &[]), string(b"signature")].concat()]), "a section of type 4 at byte 47"),
        (list(&[section(1, &[&[0; 20]])]), "certificate authority at byte 52"),
        (list(&[section(3, &[&[0; 32]])]), "a fingerprint of 32 bytes at byte 52, expected 20 bytes"),
        (list(&[section(5, &[&[0; 20]])]), "a fingerprint of 20 bytes at byte 52, expected 32 bytes"),
        (list(&[extension]), "a section of type 255 at byte 47"),
        (b"SSHKRL\r\n\0\0".to_vec(), "changed line endings"),
        (b"SSHKRL".to_vec(), "only 6 bytes are left"),
        (b"SSHKRL\n\0\0\0\0\x02".to_vec(), "format version 2 at byte 8"),
        (b"SSHKRLxx".to_vec(), "other bytes at the beginning"),
        (b" \n".to_vec(), "an empty file"),
        (b"revoked: [a]\n".to_vec(), "krl:1:1: key: found `revoked:`, which is not a key type"),
    ] {
        let refused = refused(&bytes);
        assert!(refused.contains(words), "{refused}");
    }
    assert!(RevokedKeys::parse("krl", b"# none so far\n").is_ok());
    assert!(RevokedKeys::parse("krl", &list(&[])).is_ok());
}
