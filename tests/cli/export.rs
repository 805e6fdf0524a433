//! `export`: what it writes makes the same passport again, and other programs read it.

use crate::place::Place;
use crate::programs;
use serde_json::Value;

const TRUST: &str = "--trust docs/allowed_signers --time 2026-11-20";
const EVERY: [&str; 3] = [
    "passports/SPS-1/0203/moscow-bmstu-1.yaml",
    "passports/SPS-2/0017/beijing-nim-1.yaml",
    "passports/SPS-2/0017/moscow-bmstu-1.yaml",
];

/// A folder with the example passports, their allowed signers and the key that signed them.
fn folder() -> Place {
    let files = EVERY.map(|name| (name, name));
    let more = [("docs/allowed_signers", "docs/allowed_signers"), (programs::KEY, "key")];
    Place::of(&[&files[..], &more].concat())
}

/// Expected: the original file. The signature of Ed25519 is deterministic, so a passport that is issued from the exported
/// files by the same key at the same time is the same file if every number and every text survived.
#[test]
fn the_exported_files_make_the_same_passport() {
    let folder = folder();
    for (number, passport) in EVERY.into_iter().enumerate() {
        let out = format!("out-{number}");
        let (code, stdout, said) = folder.said(&format!("export {passport} {TRUST} --to stand,site --out {out}"));
        assert_eq!((code, stdout.as_str()), (0, ""), "{said}");
        let original = folder.read(passport);
        let value = |key: &str| {
            let line = original.lines().find(|line| line.trim_start().starts_with(key)).unwrap();
            line.split_once(": ").unwrap().1.trim_matches('"').to_owned()
        };
        let again = format!(
            "issue {out} --site {out} --key key --identity {} --issued-at {} --out again-{number}{}",
            value("issuer:"),
            value("issued_at:"),
            if original.contains("\naccuracy:") { " --accuracy" } else { "" }
        );
        folder.good(&again);
        let path = passport.replacen("passports", &format!("again-{number}"), 1);
        assert_eq!(folder.read(path), original, "{passport}");
    }
}

/// A folder: one line for each passport, the refused one without content; stands and sites once each.
#[test]
fn many_are_lines_of_json() {
    let folder = folder();
    let altered = folder.read(EVERY[0]).replacen("alpha_arcsec: ", "alpha_arcsec: 1", 1);
    folder.write("passports/SPS-1/0203/altered-1.yaml", altered);
    let (code, stdout, said) = folder.said(&format!("export passports {TRUST} --to json,stand,site"));
    assert_eq!(code, 1, "{said}");
    let lines: Vec<Value> = stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let verified: Vec<_> = lines.iter().map(|line| line["verified"].as_bool().unwrap()).collect();
    assert_eq!(verified, [false, true, true, true]);
    assert!(lines[0].get("positions").is_none() && lines[0]["checks"][1]["code"] == "altered");
    assert!(said.contains("REFUSED") && said.contains("nothing was exported"), "{said}");
    // Expected: sha256sum, and `show --format json`.
    for (line, file) in lines[1..].iter().zip(EVERY) {
        assert_eq!(line["sha256"], programs::sha256(&folder.path(file)));
        assert_eq!(line["file"], file);
        let shown = folder.json(&format!("show {file} {TRUST}"), 0);
        for (key, value) in shown.as_object().unwrap() {
            if key != "positions" {
                assert_eq!(&line[key], value, "{key}");
            }
        }
        for (exported, shown) in
            line["positions"].as_array().unwrap().iter().zip(shown["positions"].as_array().unwrap())
        {
            for (key, value) in exported.as_object().unwrap() {
                assert_eq!(value, shown.get(key).unwrap_or(&Value::Null), "{key}");
            }
            assert_eq!(exported.as_object().unwrap().len(), 11);
        }
    }
    let stands = said.lines().filter(|line| line.ends_with("stand.yaml")).count();
    assert_eq!((stands, folder.path("beijing-nim.yaml").exists()), (2, true), "{said}");
}
