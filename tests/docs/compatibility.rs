//! The promises of docs/compatibility.md that no other test holds. Nothing writes tests/golden again.

use crate::fixtures;
use crate::programs;
use dtg_passport::gyro::GyroType;
use dtg_passport::laboratory::Laboratory;
use dtg_passport::site::Site;
use dtg_passport::stand::Stand;
use dtg_passport::trust::SigningKey;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

fn read(path: &str) -> String {
    fs::read_to_string(programs::project(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Runs the program in the project: exit code, standard output, standard error.
fn run(arguments: &str, more: &[&Path]) -> (i32, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
    command.args(arguments.split(' ')).args(more).current_dir(programs::project(""));
    let output = command.output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

const TRUST: &str = "--trust docs/allowed_signers --time 2026-12-01";

#[test]
fn files_of_format_1_are_read() {
    let bytes = |name: &str| read(&format!("tests/golden/{name}-1.yaml")).into_bytes();
    assert_eq!(Stand::from_yaml("stand", &bytes("stand")).unwrap().positions.len(), 8);
    assert_eq!(Site::from_yaml("site", &bytes("site")).unwrap().id.as_str(), "braunschweig-ptb");
    assert_eq!(GyroType::from_yaml("gyro", &bytes("gyro")).unwrap().r#type, "GVK-6");
    assert_eq!(Laboratory::from_yaml("laboratory", &bytes("laboratory")).unwrap().meter.range_ma, 1.0);
    let out = tempfile::tempdir().unwrap();
    let passport = "tests/golden/passport-1-reissued.yaml";
    let dcc = format!("export {passport} --to dcc --administrative tests/golden/dcc-1.yaml {TRUST} --out");
    assert_eq!(run(&dcc, &[out.path()]).0, 0);
    let verify = |passport: &str| {
        let (code, words, _) = run(&format!("verify {passport} {TRUST} --register tests/golden/register-1.yaml"), &[]);
        (code, words.lines().next().unwrap().to_owned())
    };
    let (code, words) = verify(passport);
    assert!(code == 0 && words.starts_with("◐ VALID SO FAR"), "{words}");
    assert_eq!(verify("passports/SPS-2/0017/moscow-bmstu-1.yaml").0, 1, "superseded");
}

/// Passports are in tests/inside/forgeries.rs.
#[test]
fn files_of_a_later_format_are_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let key = SigningKey::from_openssh(&read("tests/keys/examples"), None).unwrap();
    let register = read("tests/golden/register-1.yaml").replace("dtg-register/1", "dtg-register/2");
    let later = fixtures::signed_as("dtg-register", register.split("signature: |\n").next().unwrap(), &key);
    let path = folder.path().join("register.yaml");
    fs::write(&path, later).unwrap();
    let verify = format!("verify tests/golden/passport-1-reissued.yaml {TRUST} --register");
    let (code, words, _) = run(&verify, &[&path]);
    assert!(code == 1 && words.contains("update the program"), "{words}");
    for name in ["stand", "site", "gyro", "laboratory"] {
        let path = folder.path().join(name);
        fs::write(&path, read(&format!("tests/golden/{name}-1.yaml")).replacen("/1\"", "/2\"", 1)).unwrap();
        let site = if name == "site" { "" } else { "--site sites/moscow-bmstu.yaml " };
        let (code, _, words) = run(&format!("plan {site}--{name}"), &[&path]);
        assert!(code == 2 && words.contains(&format!("dtg-{name}/2")), "{name}: {code} {words}");
    }
}

/// Fails unless every key of the old value is in the new one, with a value of the same type.
fn keeps(new: &Value, old: &Value, at: &str) {
    match (new, old) {
        (Value::Object(new), Value::Object(old)) => {
            for (key, value) in old {
                keeps(new.get(key).unwrap_or_else(|| panic!("{at}: {key} is gone")), value, &format!("{at}.{key}"));
            }
        }
        (Value::Array(new), Value::Array(old)) => {
            assert!(new.len() >= old.len(), "{at}");
            new.iter().zip(old).for_each(|(new, old)| keeps(new, old, &format!("{at}[]")));
        }
        (new, old) => assert_eq!(std::mem::discriminant(new), std::mem::discriminant(old), "{at}: {new}, before {old}"),
    }
}

/// The golden results are cut to the first two elements of each list.
#[test]
fn results_keep_their_keys() {
    let moscow = "passports/SPS-2/0017/moscow-bmstu-1.yaml --trust docs/allowed_signers --time 2026-11-20";
    let trust = "--trust docs/allowed_signers --time 2026-11-20";
    let out = tempfile::tempdir().unwrap();
    let stand = out.path().join("stand.yaml");
    let register = "--register passports/SPS-2/0017/register.yaml";
    let calibrate = "docs/currents.csv --gyro docs/gvk-6.yaml --laboratory docs/laboratory.yaml --budget";
    for (name, arguments) in [
        ("verify", format!("verify {moscow} {register}")),
        ("register", format!("register passports {trust}")),
        ("calibrate", format!("calibrate {moscow} {calibrate}")),
        ("certify", format!("certify docs/angles.csv --stand docs/header.yaml -o {}", stand.display())),
        ("plan", "plan --site sites/moscow-bmstu.yaml".to_owned()),
        ("history", format!("history SPS-2/0017 --passports passports {trust}")),
    ] {
        let old = serde_json::from_str(&read(&format!("tests/golden/{name}-1.json"))).unwrap();
        let (code, now, words) = run(&format!("{arguments} --format json"), &[]);
        assert_eq!(code, 0, "{name}: {words}");
        keeps(&serde_json::from_str(&now).unwrap(), &old, name);
    }
    // A result is an input too.
    let previous = format!(
        "calibrate {moscow} docs/currents.csv --laboratory docs/laboratory.yaml --gyro docs/gvk-6.yaml --previous tests/golden/calibrate-1.json"
    );
    let (code, _, words) = run(&previous, &[]);
    assert_ne!(code, 2, "{words}");
}

/// Prototypes without the names of the parameters, which are no part of the ABI.
const C_FUNCTIONS: [&str; 8] = [
    "int dtg_load(const char *, const char *, const char *, dtg_passport **, char **)",
    "int dtg_matrix(const dtg_passport *, const char *, double *)",
    "size_t dtg_positions(const dtg_passport *)",
    "int dtg_position(const dtg_passport *, size_t, uint32_t *, double *, double *)",
    "int dtg_calibrate_csv(const dtg_passport *, const char *, const char *, char **)",
    "int dtg_calibrate(const dtg_passport *, const double *, size_t, const char *, char **)",
    "void dtg_free(dtg_passport *)",
    "void dtg_string_free(char *)",
];

#[test]
fn functions_of_the_c_library_stay() {
    let header = read("c/dtg_passport.h");
    let words: String = header.split_whitespace().collect::<Vec<_>>().join(" ");
    for function in C_FUNCTIONS {
        let (name, parameters) = function.split_once('(').unwrap();
        let (_, found) = words.split_once(&format!("{name}(")).unwrap_or_else(|| panic!("{name} is gone"));
        let found = found.split(')').next().unwrap().split(", ");
        let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let types = found.map(|parameter| parameter.trim_end_matches(is_name).trim_end());
        assert_eq!(types.collect::<Vec<_>>().join(", ") + ")", parameters, "{name}");
    }
}

#[test]
fn the_least_versions_are_those_of_the_manifests() {
    let page = read("docs/compatibility.md");
    let stated = |manifest: &str, key: &str| {
        let text = read(manifest);
        let (_, value) = text.split_once(key).unwrap_or_else(|| panic!("{manifest}: no {key}"));
        value.split('"').nth(1).unwrap().trim_start_matches(">=").to_owned()
    };
    for (name, version) in [
        ("Rust", stated("Cargo.toml", "rust-version")),
        ("Rust", stated("c/Cargo.toml", "rust-version")),
        ("Python", stated("python/pyproject.toml", "requires-python")),
    ] {
        assert!(page.contains(&format!("{name} {version}")), "{name} {version}");
    }
    assert!(read("python/Cargo.toml").contains("\"abi3-py310\""));
}
