//! Project Wycheproof's vectors of Ed25519. Each is put into a block of OpenSSH, so that its key, message and signature
//! reach the verification that passports go through.

use base64ct::{Base64, Encoding};
use dtg_passport::trust::{Message, Signature};
use wycheproof::TestResult;
use wycheproof::eddsa::{TestName, TestSet};

const NAMESPACE: &str = "wycheproof";

fn string(bytes: &[u8]) -> Vec<u8> {
    [&u32::try_from(bytes.len()).unwrap().to_be_bytes(), bytes].concat()
}

/// Returns a block with this key and signature, as OpenSSH's PROTOCOL.sshsig describes it.
fn block(key: &[u8], signature: &[u8]) -> String {
    let typed = |bytes| string(&[string(b"ssh-ed25519"), string(bytes)].concat());
    let version = b"SSHSIG\x00\x00\x00\x01".to_vec();
    let names = [string(NAMESPACE.as_bytes()), string(b""), string(b"sha512")].concat();
    let base64 = Base64::encode_string(&[version, typed(key), names, typed(signature)].concat());
    let lines: Vec<_> = base64.as_bytes().chunks(70).map(String::from_utf8_lossy).collect();
    format!("-----BEGIN SSH SIGNATURE-----\n{}\n-----END SSH SIGNATURE-----\n", lines.join("\n"))
}

/// Expected: the result that each vector states.
#[test]
fn every_vector_of_ed25519_has_the_stated_result() {
    let set = TestSet::load(TestName::Ed25519).unwrap();
    let [mut verified, mut refused, mut without_form] = [0; 3];
    for group in &set.test_groups {
        for test in &group.tests {
            let message = Message { namespace: NAMESPACE, bytes: &test.msg, signed: Some(test.msg.to_vec()) };
            let result = match Signature::from_armor(&block(&group.key.pk, &test.sig)) {
                Ok(signature) => {
                    let result = signature.verify_message(&message, None).is_ok();
                    *(if result { &mut verified } else { &mut refused }) += 1;
                    result
                }
                Err(_) => {
                    without_form += 1;
                    false
                }
            };
            assert_eq!(result, test.result == TestResult::Valid, "{}: {}", test.tc_id, test.comment);
        }
    }
    // So many the crate has; those without form have a signature that is not 64 bytes long.
    assert_eq!((verified, refused, without_form), (88, 51, 12));
    assert_eq!(verified + refused + without_form, set.number_of_tests);
}
