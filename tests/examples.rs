//! The shipped passports and sites: made again byte for byte, verified, and read by the programs of the documentation.
//!
//! `UPDATE_EXAMPLES=1 cargo test --test examples` writes the passports again after a change of the format; nothing writes
//! tests/golden again.

mod tools;

use dtg_passport::passport::issue::{self, Issue};
use dtg_passport::passport::{Question, Trust, verify};
use dtg_passport::site::Site;
use dtg_passport::stand::Stand;
use dtg_passport::trust::{AllowedSigners, SigningKey};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const STANDS: [&str; 2] = ["passports/SPS-1/0203", "passports/SPS-2/0017"];
const SITES: [&str; 2] = ["moscow-bmstu", "beijing-nim"];
const ISSUER: &str = "examples@dtg-passport.test";
const ISSUED_AT: &str = "2026-11-09T09:00:00Z";

fn read(path: &str) -> Vec<u8> {
    fs::read(tools::project(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn trust() -> Trust {
    let signers = AllowedSigners::parse("allowed_signers", &read("tests/keys/allowed_signers")).unwrap();
    Trust::of(signers)
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
    let fictitious = [FICTITIOUS, "tests/self_check/stand.yaml", "tests/self_check/site.yaml"].map(str::to_owned);
    STANDS.into_iter().flat_map(of_stand).chain([fictitious.into()]).collect()
}

#[test]
fn the_passports_are_those_that_this_program_issues() {
    let key = String::from_utf8(read("tests/keys/examples")).unwrap();
    let key = SigningKey::from_openssh(&key, None).unwrap();
    let order = Issue::first(ISSUER, ISSUED_AT.parse().unwrap());
    for (path, stand, site) in passports() {
        let stand = Stand::from_yaml(&stand, &read(&stand)).unwrap();
        let site = Site::from_yaml(&site, &read(&site)).unwrap();
        let passport = issue::draft(&stand, &site, &order).unwrap().sign(&key).unwrap();
        if std::env::var_os("UPDATE_EXAMPLES").is_some() {
            fs::write(tools::project(&path), &passport).unwrap();
        }
        assert!(
            read(&path) == passport.as_bytes(),
            "{path} is not what this program issues: see the head of this file"
        );
    }
}

#[test]
fn the_passports_verify() {
    let question = Question::at("2026-12-01T00:00:00Z".parse().unwrap());
    for (path, _, _) in passports() {
        let answer = verify(&path, &read(&path), &trust(), &question);
        assert!(answer.valid(), "{path}: {:?}", answer.checks());
    }
}

/// A passport of an earlier version, with the GVK-6 in its self-check, and the trust file of then.
#[test]
fn passports_signed_before_stay_valid() {
    let path = "tests/golden/passport-1-gvk-6.yaml";
    let signers = AllowedSigners::parse("allowed_signers", &read("tests/golden/allowed_signers")).unwrap();
    let question = Question { serial: Some("0017".into()), ..Question::at("2026-12-01T00:00:00Z".parse().unwrap()) };
    let answer = verify(path, &read(path), &Trust::of(signers), &question);
    assert!(answer.valid(), "{:?}", answer.checks());
    let passport = answer.passport().unwrap();
    let gyro = passport.content().self_check.as_ref().unwrap().parameters();
    assert_eq!(gyro.k_deg_per_h_per_ma, [[95.0, 9.5], [9.5, 95.0]]);
}

#[test]
fn the_sites_are_spread_over_the_earth_and_name_their_sources() {
    let folder = fs::read_dir(tools::project("sites")).unwrap();
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

/// The Python program of docs/verifying.md finds the parameters of the self-check in every shipped passport.
#[test]
fn the_python_program_finds_the_self_check() {
    let program = tools::project("docs/self_check.py");
    assert!(fs::read_to_string(&program).unwrap().lines().count() <= 25);
    for (path, _, _) in passports() {
        let mut python = tools::python();
        python.arg(&program).arg(tools::project(&path));
        let printed = tools::output(python);
        assert_eq!(printed.lines().count(), 4, "{printed}");
    }
    // It must be able to fail: a current changed by 1e-6 mA is seen.
    let path = format!("{}/{}-1.yaml", STANDS[0], SITES[0]);
    let text = String::from_utf8(read(&path)).unwrap();
    let first = text.split("jx_ma: -0.").nth(1).unwrap();
    let changed = text.replacen(&first[..6], &format!("{:06}", first[..6].parse::<u32>().unwrap() + 1), 1);
    let wrong = scratch("self_check").join("wrong.yaml");
    fs::write(&wrong, changed).unwrap();
    let status = tools::python().arg(&program).arg(&wrong).output().unwrap().status;
    assert_eq!(status.code(), Some(1));
}

/// The recipe of docs/verifying.md, taken from the page, with stock OpenSSH: good, and altered.
#[test]
fn the_openssh_recipe_works_as_printed() {
    let page = String::from_utf8(read("docs/verifying.md")).unwrap();
    let recipe = page.split("```sh\n").nth(1).unwrap().split("```").next().unwrap();
    let path = tools::project(&format!("{}/{}-1.yaml", STANDS[1], SITES[0]));
    let run = |passport: &Path, folder: &Path| {
        let mut shell = tools::on_path("sh");
        shell.args(["-e", "-c", recipe]).current_dir(folder).env("PASSPORT", passport).env("ISSUER", ISSUER);
        shell.env("SIGNERS", tools::project("tests/keys/allowed_signers"));
        let output = shell.output().unwrap();
        (output.status.success(), String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let folder = scratch("recipe");
    let (good, words) = run(&path, &folder);
    assert!(good && words.starts_with("Good \"dtg-passport\" signature"), "{words}");
    let altered = folder.join("altered.yaml");
    let text = fs::read_to_string(&path).unwrap().replacen("alpha_arcsec: 12.4", "alpha_arcsec: 12.5", 1);
    fs::write(&altered, text).unwrap();
    assert!(!run(&altered, &folder).0);
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
    let key = folder.join("key");
    let _ = fs::remove_file(&key);
    fs::write(&key, read("tests/keys/examples")).unwrap();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(&key, fs::Permissions::from_mode(0o600)).unwrap();
    }
    let mut program = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
    program.arg("issue").args(STANDS.map(|folder| tools::project(&format!("{folder}/stand.yaml"))));
    for id in SITES {
        program.arg("--site").arg(tools::project(&format!("sites/{id}.yaml")));
    }
    program
        .arg("--key")
        .arg(&key)
        .args(["--identity", ISSUER, "--issued-at", ISSUED_AT])
        .arg("--out")
        .arg(folder.join("out"));
    tools::output(program);
    for stand in STANDS {
        for id in SITES {
            let name = format!("{}/{id}-1.yaml", stand.trim_start_matches("passports/"));
            let issued = fs::read(folder.join("out").join(&name)).unwrap();
            assert!(issued == read(&format!("passports/{name}")), "{name}");
        }
    }
}
