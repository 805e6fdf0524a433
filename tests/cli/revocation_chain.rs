//! Lists of withdrawn passports that are more than one file can hold, by the program itself.

use crate::fixtures;
use dtg_passport::revocation::{Entry, Series};
use dtg_passport::text::LARGEST_DOCUMENT_BYTES;
use dtg_passport::trust::SigningKey;
use sha2::{Digest, Sha256};
use std::fs;
use std::path::PathBuf;
use std::process::Command;

struct Office(tempfile::TempDir);

impl Office {
    /// A key, who trusts it, two passports, and a list of 700 others that has no room for a long reason more.
    fn new() -> Self {
        let office = Self(tempfile::tempdir().unwrap());
        let key = SigningKey::generate().unwrap();
        office.write("key", &key.to_openssh("", None).unwrap());
        assert!(Command::new("chmod").arg("600").arg(office.path("key")).status().unwrap().success());
        office.write("allowed_signers", &format!("{} {}\n", fixtures::ISSUER, key.public_key().to_openssh()));
        let (stand, site) = (fixtures::stand(fixtures::DEGREES), fixtures::site(fixtures::SITE));
        for (name, revision) in [("bench-1.yaml", 1), ("bench-2.yaml", 2)] {
            let payload = fixtures::drafted(&stand, &site, revision).payload().to_owned();
            office.write(name, &fixtures::signed(&payload, &key));
        }
        let now = fixtures::at("2020-01-01T00:00:00Z");
        let entry = |index| Entry {
            id: format!("SPS-9/{index:04}/bench/1"),
            sha256: format!("{index:064}"),
            revoked_at: now,
            reason: "x".repeat(1320),
        };
        let first = Series::default().following(fixtures::ISSUER, now, (0..700).map(entry).collect()).unwrap();
        fs::create_dir(office.path("lists")).unwrap();
        let text = first.sign(&key).unwrap();
        assert!((LARGEST_DOCUMENT_BYTES - 30_000..LARGEST_DOCUMENT_BYTES).contains(&text.len()), "{}", text.len());
        office.write("lists/revocation-1.yaml", &text);
        office
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    fn run(&self, arguments: &str, code: i32) -> String {
        let mut command = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
        let output = command.args(arguments.split(' ')).current_dir(self.0.path()).output().unwrap();
        let said = [output.stdout, output.stderr].concat();
        let said = String::from_utf8(said).unwrap();
        assert_eq!(output.status.code(), Some(code), "{}", said.chars().take(500).collect::<String>());
        said
    }

    fn revoke(&self, file: &str, reason: &str) {
        let sign = format!("--key key --identity {}", fixtures::ISSUER);
        self.run(&format!("revoke {file} --list lists --reason {reason} {sign} --trust allowed_signers"), 0);
    }
}

#[test]
fn a_list_that_is_full_is_continued_and_the_whole_chain_counts() {
    let office = Office::new();
    office.revoke("bench-1.yaml", &"y".repeat(40_000));
    office.revoke("bench-2.yaml", "z");
    let second = fs::read_to_string(office.path("lists/revocation-2.yaml")).unwrap();
    let third = fs::read_to_string(office.path("lists/revocation-3.yaml")).unwrap();
    let first = fs::read(office.path("lists/revocation-1.yaml")).unwrap();
    let sha256: String = Sha256::digest(&first).iter().map(|byte| format!("{byte:02x}")).collect();
    let continued = format!("continues:\n  sequence: 1\n  sha256: \"{sha256}\"\n");
    assert!(second.contains(&continued) && third.contains(&continued), "{}", &second[..600]);
    assert_eq!((second.matches("  - {id: ").count(), third.matches("  - {id: ").count()), (1, 2), "{}", &second[..600]);

    // With all that counts, whichever list withdraws it.
    let lists = "--revoked lists/revocation-3.yaml --revoked lists/revocation-1.yaml";
    for file in ["bench-1.yaml", "bench-2.yaml"] {
        let said = office.run(&format!("verify {file} --trust allowed_signers {lists}"), 1);
        assert!(said.contains("was withdrawn at"), "{}", &said[..300]);
    }
    let said = office.run("register . --trust allowed_signers", 1);
    let first = said.lines().next().unwrap();
    assert!(first.contains("2 revoked") && !said.contains("ALARM (revocation)"), "{first}");

    // Without the list that is named nobody knows what is withdrawn.
    let said = office.run("verify bench-1.yaml --trust allowed_signers --revoked lists/revocation-3.yaml", 2);
    assert!(said.contains("list 3 of withdrawn passports continues list 1, which is missing"), "{said}");
    fs::remove_file(office.path("lists/revocation-1.yaml")).unwrap();
    let sign = format!("--key key --identity {} --reason more --trust allowed_signers", fixtures::ISSUER);
    let said = office.run(&format!("revoke bench-1.yaml --list lists {sign}"), 1);
    assert!(said.contains("continues list 1, which is missing"), "{said}");
    let said = office.run("register lists --trust allowed_signers", 1);
    assert!(said.contains("continues list 1, which is missing"), "{said}");
}
