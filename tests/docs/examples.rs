//! The shipped passports, registers and sites: made again byte for byte, verified, and read by the programs of the
//! documentation.
//!
//! `UPDATE_EXAMPLES=1 cargo test --test docs examples` writes the passports and the registers again after a change of the
//! format; nothing writes tests/golden again.

use crate::fixtures;
use crate::programs;
use dtg_passport::passport::issue::{self, Issue};
use dtg_passport::passport::{CheckName, Code, Question, Trust, verify};
use dtg_passport::register::{REGISTER_NAMESPACE, State, VerifiedRegister};
use dtg_passport::site::Site;
use dtg_passport::stand::Stand;
use dtg_passport::trust::{AllowedSigners, SigningKey};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const STANDS: [&str; 2] = ["passports/SPS-1/0203", "passports/SPS-2/0017"];
const SITES: [&str; 2] = ["moscow-bmstu", "beijing-nim"];
const ISSUER: &str = "examples@dtg-passport.test";
const ISSUED_AT: &str = "2026-11-09T09:00:00Z";

fn read(path: &str) -> Vec<u8> {
    fs::read(programs::project(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn trust() -> Trust {
    let signers = AllowedSigners::parse("allowed_signers", &read("tests/keys/allowed_signers")).unwrap();
    Trust::of(signers)
}

/// The key that signed them.
fn key() -> SigningKey {
    SigningKey::from_openssh(&String::from_utf8(read("tests/keys/examples")).unwrap(), None).unwrap()
}

/// Writes a file again, if that is asked for.
fn update(path: &str, bytes: impl AsRef<[u8]>) {
    if std::env::var_os("UPDATE_EXAMPLES").is_some() {
        fs::write(programs::project(path), bytes).unwrap();
    }
}

/// The passport of a stand that does not exist, which integrators test their software with.
const FICTITIOUS: &str = "docs/self_check.yaml";

/// Each shipped passport with the files of its stand and its site.
fn passports() -> Vec<(String, String, String)> {
    let of_stand = |folder: &str| {
        let each =
            |id: &str| (format!("{folder}/{id}-1.yaml"), format!("{folder}/stand.yaml"), format!("sites/{id}.yaml"));
        SITES.map(each)
    };
    let fictitious =
        [FICTITIOUS, "tests/docs/self_check/stand.yaml", "tests/docs/self_check/site.yaml"].map(str::to_owned);
    STANDS.into_iter().flat_map(of_stand).chain([fictitious.into()]).collect()
}

#[test]
fn the_passports_are_those_that_this_program_issues() {
    let order = Issue::first(ISSUER, ISSUED_AT.parse().unwrap());
    for (path, stand, site) in passports() {
        let stand = Stand::from_yaml(&stand, &read(&stand)).unwrap();
        let site = Site::from_yaml(&site, &read(&site)).unwrap();
        let passport = issue::draft(&stand, &site, &order).unwrap().sign(&key()).unwrap();
        update(&path, &passport);
        assert!(
            read(&path) == passport.as_bytes(),
            "{path} is not what this program issues: see the head of this file"
        );
    }
}

#[test]
fn the_registers_list_the_passports() {
    let question = Question::at("2026-12-01T00:00:00Z".parse().unwrap());
    for (path, _, _) in passports().into_iter().filter(|(path, ..)| path != FICTITIOUS) {
        let name = format!("{}/register.yaml", path.rsplit_once('/').unwrap().0);
        let register = VerifiedRegister::verify(&name, &read(&name), &trust(), question.now).unwrap();
        assert_eq!((register.entries().len(), register.header().fresh_until), (SITES.len(), None));
        assert!(register.entries().iter().all(|entry| entry.state == State::Current));
        let answer = verify(&path, &read(&path), &trust(), &question).with_register(Ok((&register, None)), &question);
        assert_eq!(answer.code(CheckName::Register), Some(Code::Ok), "{path}: {:?}", answer.checks());
        assert!(answer.valid());
    }
}

/// A passport of an earlier version, with the GVK-6 in its self-check, and the trust file of then.
#[test]
fn passports_signed_before_stay_valid() {
    let path = "tests/golden/passport-1-gvk-6.yaml";
    let signers = AllowedSigners::parse("allowed_signers", &read("tests/golden/allowed_signers")).unwrap();
    let mut question = Question::at("2026-12-01T00:00:00Z".parse().unwrap());
    question.serial = Some("0017".into());
    let answer = verify(path, &read(path), &Trust::of(signers), &question);
    assert!(answer.valid(), "{:?}", answer.checks());
    let passport = answer.passport().unwrap();
    let gyro = passport.content().self_check.as_ref().unwrap().parameters();
    assert_eq!(gyro.k_deg_per_h_per_ma, [[95.0, 9.5], [9.5, 95.0]]);
}

#[test]
fn the_sites_are_spread_over_the_earth_and_name_their_sources() {
    let folder = fs::read_dir(programs::project("sites")).unwrap();
    let files: Vec<PathBuf> = folder.map(|entry| entry.unwrap().path()).collect();
    let sites: Vec<Site> = files
        .iter()
        .filter(|path| path.extension().is_some_and(|extension| extension == "yaml"))
        .map(|path| {
            let read = Site::from_yaml(&path.display().to_string(), &fs::read(path).unwrap());
            let site = read.unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(path.file_stem().unwrap(), site.id.as_str());
            assert!(site.source.as_ref().is_some_and(|source| source.len() > 20), "{}: no source", site.id);
            site
        })
        .collect();
    let latitudes: Vec<f64> = sites.iter().map(Site::geodetic_deg).collect();
    assert!(sites.len() >= 12);
    assert!(latitudes.iter().any(|latitude| *latitude < -20.0) && latitudes.iter().any(|latitude| *latitude > 20.0));
    assert!(latitudes.iter().any(|latitude| latitude.abs() < 5.0));
    assert!(latitudes.iter().any(|latitude| latitude.abs() > 65.0));
}

/// A Python program of docs/, with these options of Python.
fn documented(options: &[&str], program: &str, arguments: &[&Path]) -> Output {
    let mut python = programs::python();
    python.args(options).arg(programs::project(program)).args(arguments).output().unwrap()
}

/// Both Python programs with a passport.
fn both_documented(options: &[&str], passport: &Path, signers: &Path, issuer: &str) -> [Output; 2] {
    let (currents, issuer) = (programs::project("docs/currents.csv"), Path::new(issuer));
    [
        documented(options, "docs/self_check.py", &[passport, signers, issuer]),
        documented(options, "docs/least_squares.py", &[passport, &currents, signers, issuer]),
    ]
}

fn signers() -> PathBuf {
    programs::project("docs/allowed_signers")
}

/// The Python program of docs/integrator.md finds the parameters of the self-check in every shipped passport.
#[test]
fn the_python_program_finds_the_self_check() {
    let program = "docs/self_check.py";
    assert!(fs::read_to_string(programs::project(program)).unwrap().lines().count() <= 25);
    let run = |passport: &Path| documented(&[], program, &[passport, &signers(), Path::new(ISSUER)]);
    for (path, _, _) in passports() {
        let output = run(&programs::project(&path));
        let printed = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success() && printed.lines().count() == 4, "{path}: {printed}");
    }
    // It must be able to fail: a current changed by 1e-6 mA is seen, and one that is no number.
    let text = String::from_utf8(read(FICTITIOUS)).unwrap();
    let (payload, _) = text.split_once("signature: |\n").unwrap();
    let (before, current) = payload.split_once("jx_ma: ").unwrap();
    let (current, after) = current.split_once(',').unwrap();
    for wrong in [format!("{}", current.parse::<f64>().unwrap() + 1e-6), ".nan".to_owned()] {
        let payload = format!("{before}jx_ma: {wrong},{after}");
        let file = scratch("self_check").join("wrong.yaml");
        fs::write(&file, fixtures::signed(&payload, &key())).unwrap();
        let output = run(&file);
        assert_eq!(output.status.code(), Some(1));
        assert_eq!(String::from_utf8(output.stdout).unwrap().lines().count(), 4, "{wrong}");
    }
}

/// The recipe of docs/verifying.md, taken from the page, with stock OpenSSH; its success and what it prints.
fn recipe(passport: &Path, folder: &Path) -> (bool, String) {
    let page = String::from_utf8(read("docs/verifying.md")).unwrap();
    let recipe = page.split("```sh\n").nth(1).unwrap().split("```").next().unwrap();
    let mut shell = programs::on_path("sh");
    shell.args(["-e", "-c", recipe]).current_dir(folder).env("PASSPORT", passport).env("ISSUER", ISSUER);
    let output = shell.env("SIGNERS", signers()).output().unwrap();
    (output.status.success(), String::from_utf8_lossy(&output.stdout).into_owned())
}

#[test]
fn the_openssh_recipe_works_as_printed() {
    let folder = scratch("recipe");
    let (good, words) = recipe(&programs::project(FICTITIOUS), &folder);
    assert!(good && words.starts_with("Good \"dtg-passport\" signature"), "{words}");
}

/// Whatever is beside the signed bytes is refused before a program of the documentation reads a number.
#[test]
fn documented_programs_read_signed_bytes_alone() {
    let text = String::from_utf8(read(FICTITIOUS)).unwrap();
    let folder = scratch("signed-bytes");
    let appended = "self_check: {currents: []}\n";
    for (name, altered) in [
        ("altered", text.replacen("alpha_arcsec: 25571.0", "alpha_arcsec: 25572.0", 1)),
        ("a key after the signature", format!("{text}{appended}")),
        ("an indented line after the signature", format!("{text}  {appended}")),
        ("a second signature block with keys", format!("{text}{appended}signature: |\n")),
        ("a second document", format!("{text}---\n{text}")),
        ("a key before the block", text.replacen("signature: |\n", &format!("signature: |\n{appended}"), 1)),
        ("a key in the line of the signature", text.replacen("signature: |\n", "signature: |\r\n", 1)),
        ("the signature twice", text.replacen("signature: |\n", "signature: |\nsignature: |\n", 1)),
        ("no signature", text.split("signature: |\n").next().unwrap().to_owned()),
        ("nothing", String::new()),
    ] {
        assert_ne!(altered, text, "{name}");
        let file = folder.join("altered.yaml");
        fs::write(&file, altered).unwrap();
        for output in both_documented(&[], &file, &signers(), ISSUER) {
            let words = String::from_utf8(output.stderr).unwrap();
            assert!(output.status.code() == Some(1) && output.stdout.is_empty(), "{name}: {words}");
            assert!(words.contains(": refused: ") && !words.contains("Traceback"), "{name}: {words}");
        }
        assert!(!recipe(&file, &folder).0, "{name}");
    }
}

/// Asked for another issuer than the one that the text names, with a key that may sign for both; asserts switched off or not.
#[test]
fn documented_programs_refuse_another_issuer() {
    let everybody = scratch("issuer").join("allowed_signers");
    let line = String::from_utf8(read("tests/keys/allowed_signers")).unwrap();
    fs::write(&everybody, line.replacen(ISSUER, "*", 1)).unwrap();
    let passport = programs::project("passports/SPS-2/0017/moscow-bmstu-1.yaml");
    for options in [&[][..], &["-O"]] {
        for (issuer, due) in [(ISSUER, 0), ("somebody@example.org", 1)] {
            let outputs = both_documented(options, &passport, &everybody, issuer);
            let codes = outputs.map(|output| output.status.code());
            assert_eq!(codes, [Some(due), Some(due)], "{options:?} {issuer:?}");
        }
    }
}

#[test]
fn documented_least_squares_refuses_unusable_currents() {
    let passport = programs::project("passports/SPS-2/0017/moscow-bmstu-1.yaml");
    let csv = String::from_utf8(read("docs/currents.csv")).unwrap();
    let last = csv.lines().last().unwrap();
    let table = scratch("rows").join("currents.csv");
    for (name, altered, words) in [
        ("a row twice", format!("{csv}{last}\n"), "a second row for position (2, 4)"),
        ("other numbers for a position", format!("{csv}2,4,0.1,0.1\n"), "a second row for position (2, 4)"),
        ("a row less", csv.replace(last, ""), "not those of the passport"),
        ("another position", format!("{csv}3,1,0.1,0.1\n"), "not those of the passport"),
        ("semicolons", csv.replace(',', ";"), "expected the header i,j,jx_ma,jy_ma"),
        ("decimal commas", csv.replace("0.2003831", "\"0,2003831\""), "decimal points"),
        ("a sign", csv.replace("1,3,-0.18", "1,3,0.18"), "do not fit this stand"),
        (
            "two positions exchanged",
            csv.replace("1,1,", "0,").replace("1,2,", "1,1,").replace("\n0,", "\n1,2,"),
            "do not fit",
        ),
    ] {
        fs::write(&table, altered).unwrap();
        let output = documented(&[], "docs/least_squares.py", &[&passport, &table, &signers(), Path::new(ISSUER)]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(1) && output.stdout.is_empty() && said.contains(words), "{name}: {said}");
    }
}

fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// `.ci/run` runs this in a debug and in a release build: both issue the same bytes.
#[test]
fn the_program_issues_the_same_bytes_as_the_library() {
    let folder = scratch("issue");
    let _ = fs::remove_dir_all(folder.join("out"));
    let key_file = folder.join("key");
    fs::write(&key_file, read(programs::KEY)).unwrap();
    programs::keep_secret(&key_file);
    let mut program = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
    program.arg("issue").args(STANDS.map(|folder| programs::project(&format!("{folder}/stand.yaml"))));
    for id in SITES {
        program.arg("--site").arg(programs::project(&format!("sites/{id}.yaml")));
    }
    program.arg("--key").arg(&key_file).args(["--identity", ISSUER, "--issued-at", ISSUED_AT]);
    programs::output(program.arg("--out").arg(folder.join("out")));
    for stand in STANDS {
        for id in SITES {
            let name = format!("{}/{id}-1.yaml", stand.trim_start_matches("passports/"));
            let issued = fs::read(folder.join("out").join(&name)).unwrap();
            assert!(issued == read(&format!("passports/{name}")), "{name}");
        }
        // Registers are dated by the clock; the shipped ones are dated like their passports, and signed again.
        let name = format!("{}/register.yaml", stand.trim_start_matches("passports/"));
        let issued = fs::read_to_string(folder.join("out").join(&name)).unwrap();
        let (payload, _) = issued.split_once("signature: |\n").unwrap();
        let (before, header) = payload.split_once("register: {").unwrap();
        let (header, entries) = header.split_once('\n').unwrap();
        let (start, now) = header.split_once("issued_at: \"").unwrap();
        let now = now.split_once('"').unwrap().1;
        let payload = format!("{before}register: {{{start}issued_at: \"{ISSUED_AT}\"{now}\n{entries}");
        let due = fixtures::signed_as(REGISTER_NAMESPACE, &payload, &key());
        let name = format!("passports/{name}");
        update(&name, &due);
        assert!(read(&name) == due.as_bytes(), "{name}: see the head of this file");
    }
}
