//! Program `register` on a folder, compared with its floor, all in one run: `cargo bench --bench register`.
//!
//! 50 stands x 200 sites. Floor: every file read, SHA-256 of the file, SHA-512 of its text, Ed25519 verification of its
//! signature with a prepared key, on the same number of threads; the end of the text and the signature are given. The
//! program verifies 50 registers, and compares every file with its entry.
//!
//! Then `verify` of one passport, with `--register` of the whole folder and without it, in pairs; and the same for a
//! stand whose register has 10,000 entries.

mod fleet;

use dtg_passport::signing::allowed_signers_line;
use dtg_passport::trust::SigningKey;
use ed25519_dalek::{Signature, Signer as _, VerifyingKey};
use fleet::{Time, median, on_threads, option, scratch, timed};
use serde_json::json;
use sha2::{Digest, Sha256, Sha512};
use std::fs;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

const STANDS: usize = 50;
const SITES: usize = 200;
const ROUNDS: usize = 7;
/// Entries of the register of the stand that has many.
const ENTRIES: usize = 10_000;
const PAIRS: usize = 60;
/// Within the validity of every passport.
const TIME: &str = "2027-06-01";

/// A passport for the floor.
struct File {
    path: PathBuf,
    text_bytes: usize,
    signature: Signature,
}

fn main() {
    let threads = option("--threads").unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from));
    let root = scratch("bench-register");
    let secret = ed25519_dalek::SigningKey::from_bytes(&fleet::SECRET);
    let key = SigningKey::from_openssh(&fleet::openssh_key(), None).expect("a key");
    let line = allowed_signers_line(fleet::ISSUER, &key.public_key()).expect("a line");
    fs::write(root.join("allowed_signers"), line).expect("a list");
    let files = issue(&root, &secret, STANDS, SITES);
    let ours = || {
        timed(|| {
            let mut command = program(&root);
            command.args(["register", "passports", "--trust", "allowed_signers", "--format", "csv"]);
            let output = command.args(["--time", TIME]).stderr(Stdio::inherit()).output().expect("the program");
            let lines = output.stdout.iter().filter(|byte| **byte == b'\n').count();
            assert!(output.status.success() && lines == files.len() + 1, "{lines} lines");
        })
    };
    ours();
    floor(&files, &secret.verifying_key(), threads);
    let each: Vec<(Time, Time)> =
        (0..ROUNDS).map(|_| (ours(), floor(&files, &secret.verifying_key(), threads))).collect();
    let say = |what: &str, times: &[Time]| {
        let wall = median(&times.iter().map(|time| time.wall).collect::<Vec<_>>()) / files.len() as f64;
        let processor = median(&times.iter().map(|time| time.processor).collect::<Vec<_>>()) / files.len() as f64;
        println!("{what}: {:.1} us each, {:.1} us of processor", 1e6 * wall, 1e6 * processor);
    };
    let ratio =
        |of: fn(&Time) -> f64| median(&each.iter().map(|(ours, floor)| of(floor) / of(ours)).collect::<Vec<_>>());
    let (ours, floor): (Vec<Time>, Vec<Time>) = each.iter().copied().unzip();
    println!("{} passports, {threads} threads, medians of {ROUNDS} rounds", files.len());
    say("register", &ours);
    say("floor   ", &floor);
    println!(
        "floor / register: {:.2}; {:.2} by processor time (asked for: 0.45)",
        ratio(|time| time.wall),
        ratio(|time| time.processor)
    );
    verify(&root, "one of 50 registers of 200 entries");
    let other = scratch("bench-register-long");
    fs::copy(root.join("allowed_signers"), other.join("allowed_signers")).expect("a list");
    issue(&other, &secret, 1, ENTRIES);
    verify(&other, "a register of 10,000 entries");
}

/// Verifies one passport with the register of its stand and without, in pairs.
fn verify(root: &Path, what: &str) {
    let passport = "passports/SPS-2/00000/laboratory-00000-1.yaml";
    let process = |register: &[&str]| {
        let mut command = program(root);
        command.args(["verify", passport, "--trust", "allowed_signers", "--time", TIME]).args(register);
        let start = Instant::now();
        let status = command.stdout(Stdio::null()).status().expect("the program");
        assert!(status.success(), "{register:?}");
        start.elapsed().as_secs_f64()
    };
    process(&["--register", "passports"]);
    let times: Vec<(f64, f64)> = (0..PAIRS).map(|_| (process(&["--register", "passports"]), process(&[]))).collect();
    let ratio = median(&times.iter().map(|(with, without)| with / without).collect::<Vec<_>>());
    let (with, without): (Vec<f64>, Vec<f64>) = times.into_iter().unzip();
    println!(
        "verify, {what}: {:.2} ms with --register, {:.2} ms without, ratio {ratio:.2}",
        1e3 * median(&with),
        1e3 * median(&without)
    );
}

/// Returns the program, run in a folder. It uses all processors, so `--threads` is for the floor.
fn program(folder: &Path) -> Command {
    let built = || env!("CARGO_BIN_EXE_dtg-passport").into();
    let mut command = Command::new(std::env::var_os("DTG_PASSPORT").unwrap_or_else(built));
    command.current_dir(folder);
    command
}

/// Issues the fleet into `passports/` with the program, registers included.
fn issue(root: &Path, secret: &ed25519_dalek::SigningKey, stands: usize, sites: usize) -> Vec<File> {
    fleet::write_key(&root.join("key")).expect("a key");
    let write = |path: PathBuf, mut file: serde_json::Value, format: &str| {
        file["format"] = json!(format);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, file.to_string()).expect("a file");
    };
    for stand in fleet::stands(stands) {
        let path = root.join("stands").join(stand.stand.serial.as_str()).join("stand.yaml");
        write(path, json!(stand), "dtg-stand/1");
    }
    for site in fleet::sites(sites) {
        write(root.join(format!("sites/{}.yaml", site.id)), json!(site), "dtg-site/1");
    }
    let mut command = program(root);
    command.args(["issue", "stands", "--site", "sites", "--key", "key", "--identity", fleet::ISSUER, "--no-sync"]);
    command.args(["--issued-at", fleet::ISSUED_AT]).stdout(Stdio::null());
    assert!(command.status().expect("the program").success());
    let mut files = Vec::new();
    for stand in fleet::stands(stands) {
        let folder = root.join("passports").join(stand.stand.model.as_str()).join(stand.stand.serial.as_str());
        for site in fleet::sites(sites) {
            let path = folder.join(format!("{}-1.yaml", site.id));
            let text = fs::read_to_string(&path).expect("a passport");
            let text_bytes = text.find("signature: |\n").expect("a signature");
            let signature = secret.sign(&fleet::signed_data(&Sha512::digest(&text.as_bytes()[..text_bytes])));
            files.push(File { path, text_bytes, signature });
        }
    }
    files
}

fn floor(files: &[File], key: &VerifyingKey, threads: usize) -> Time {
    timed(|| {
        on_threads(threads, files.len(), |at| {
            let file = &files[at];
            let bytes = fs::read(&file.path).expect("a file");
            black_box(Sha256::digest(&bytes));
            let signed = fleet::signed_data(&Sha512::digest(&bytes[..file.text_bytes]));
            black_box(key.verify_strict(&signed, &file.signature)).expect("a good signature");
        });
    })
}
