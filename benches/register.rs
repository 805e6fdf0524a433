//! Verb `register` on a folder, compared with its floor, all in one run: `cargo bench --bench register`.
//!
//! 50 stands x 200 sites. Floor: every file read, SHA-512 of its text, Ed25519 verification of its signature with a
//! prepared key, on the same number of threads; the end of the text and the signature are given. The register
//! additionally finds the files, checks the text rule, parses, recomputes every number, computes the SHA-256 and
//! follows the chains.

mod fleet;

use dtg_passport::folder;
use dtg_passport::passport::Trust;
use dtg_passport::passport::issue::PreparedStand;
use dtg_passport::register::{Asked, State};
use dtg_passport::signing::allowed_signers_line;
use dtg_passport::trust::{AllowedSigners, SigningKey};
use ed25519_dalek::{Signature, Signer as _, VerifyingKey};
use fleet::{Time, median, on_threads, option, scratch, timed, write_and_rename};
use sha2::{Digest, Sha512};
use std::fs;
use std::hint::black_box;
use std::path::PathBuf;

const STANDS: usize = 50;
const SITES: usize = 200;
const ROUNDS: usize = 7;

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
    let files = issue(&root, &key, &secret);
    let line = allowed_signers_line(fleet::ISSUER, &key.public_key()).expect("a line");
    let trust = Trust::of(AllowedSigners::parse("allowed_signers", line.as_bytes()).expect("a list"));
    let asked = Asked::at("2027-06-01T00:00:00Z".parse().expect("a time"));
    let ours = || {
        timed(|| {
            let register = folder::register(&root, trust.clone(), &asked, threads).expect("a register").0;
            assert!(register.alarms.is_empty() && register.counts()[&State::InForce] == files.len());
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
        "register / floor: {:.2}; {:.2} by processor time (asked for: 0.5)",
        ratio(|time| time.wall),
        ratio(|time| time.processor)
    );
}

/// Issues the fleet into a folder.
fn issue(root: &std::path::Path, key: &SigningKey, secret: &ed25519_dalek::SigningKey) -> Vec<File> {
    let (sites, order) = (fleet::sites(SITES), fleet::order());
    let mut files = Vec::new();
    for stand in fleet::stands(STANDS) {
        let folder = root.join(stand.stand.model.as_str()).join(stand.stand.serial.as_str());
        fs::create_dir_all(&folder).expect("a folder");
        let prepared = PreparedStand::new(stand);
        for site in &sites {
            let draft = prepared.draft(site, &order).expect("a passport");
            let path = folder.join(format!("{}-1.yaml", site.id));
            write_and_rename(&path, draft.sign(key).expect("a signature").as_bytes()).expect("a file");
            let text = draft.payload().as_bytes();
            let signature = secret.sign(&fleet::signed_data(&Sha512::digest(text)));
            files.push(File { path, text_bytes: text.len(), signature });
        }
    }
    files
}

fn floor(files: &[File], key: &VerifyingKey, threads: usize) -> Time {
    timed(|| {
        on_threads(threads, files.len(), |at| {
            let file = &files[at];
            let bytes = fs::read(&file.path).expect("a file");
            let signed = fleet::signed_data(&Sha512::digest(&bytes[..file.text_bytes]));
            black_box(key.verify_strict(&signed, &file.signature)).expect("a good signature");
        });
    })
}
