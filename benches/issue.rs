//! A factory's fleet against its floor and against Python, all in one run: `cargo bench --bench issue`.
//!
//! 50 stands × 200 sites. Floor: SHA-512 and Ed25519 signature of the same bytes, the file written and renamed. Python:
//! benches/issue_python.py, from `target/test-tools` where the tests have installed it, otherwise as `python3`. Stand by
//! stand one after the other, so that all share the machine's mood; nothing is synced, what syncing costs is apart.
//!
//! `-- --memory N` issues N passports and prints the memory of the process; `-- --linear` times 1,000, 10,000, 100,000.

mod fleet;

use dtg_passport::folder::{Folder, Seal};
use dtg_passport::passport::issue::{Issue, PreparedStand, draft};
use dtg_passport::site::Site;
use dtg_passport::stand::Stand;
use dtg_passport::text::Field;
use dtg_passport::trust::SigningKey;
use ed25519_dalek::Signer as _;
use fleet::{Time, median, on_threads, option, resident_mib, scratch, timed, write_and_rename};
use serde_json::{Value, json};
use sha2::{Digest, Sha512};
use std::fs;
use std::hint::black_box;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const STANDS: usize = 50;
const SITES: usize = 200;
/// Stands that Python makes the passports of.
const PYTHON_STANDS: usize = 2;
/// How often.
const PYTHON_ROUNDS: usize = 5;
/// Passports that are synced.
const SYNCED: usize = 400;
/// The secret of the bench's key.
const SECRET: [u8; 32] = [7; 32];

struct Fleet {
    stands: Vec<Stand>,
    sites: Vec<Site>,
    order: Issue,
    key: SigningKey,
    folder: PathBuf,
}

impl Fleet {
    fn new(stands: usize, sites: usize) -> Self {
        let (stands, sites) = (fleet::stands(stands), fleet::sites(sites));
        let key = SigningKey::from_openssh(&openssh_key(), None).expect("a key");
        Self { stands, sites, order: fleet::order(), key, folder: scratch("bench-issue") }
    }

    fn path(&self, stand: &Stand, site: &Site) -> PathBuf {
        self.folder.join(stand.stand.serial.as_str()).join(format!("{}-1.yaml", site.id))
    }

    /// The folder of a stand, empty.
    fn clear(&self, stand: &Stand) {
        let folder = self.folder.join(stand.stand.serial.as_str());
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).expect("a folder");
    }

    /// Issues the passports of a stand: its time.
    fn ours(&self, stand: &Stand, threads: usize) -> Time {
        self.clear(stand);
        timed(|| {
            let prepared = PreparedStand::new(stand.clone());
            on_threads(threads, self.sites.len(), |site| {
                let site = &self.sites[site];
                let text =
                    prepared.draft(site, &self.order).and_then(|draft| draft.sign(&self.key)).expect("a passport");
                write_and_rename(&self.path(stand, site), text.as_bytes()).expect("a file");
            });
        })
    }

    /// Signs and writes what `ours` has written: its time.
    fn floor(&self, stand: &Stand, threads: usize) -> Time {
        let files: Vec<_> =
            self.sites.iter().map(|site| fs::read(self.path(stand, site)).expect("a passport")).collect();
        let payloads: Vec<_> = files.iter().map(|file| payload(file)).collect();
        self.clear(stand);
        let key = ed25519_dalek::SigningKey::from_bytes(&SECRET);
        timed(|| {
            on_threads(threads, files.len(), |at| {
                black_box(key.sign(&fleet::signed_data(&Sha512::digest(payloads[at]))));
                write_and_rename(&self.path(stand, &self.sites[at]), &files[at]).expect("a file");
            });
        })
    }

    /// The same through the library's own writer, which syncs file and folder: its time for so many passports.
    fn synced(&self, passports: usize) -> Time {
        let folder = Folder::new(scratch("bench-issue-synced"));
        let seal = Seal { signer: &self.key, trust: None };
        timed(|| issue_all(&folder, &self.stands, &self.sites, &self.order, seal, passports))
    }
}

/// A whole job as a factory runs it: `passports` of stands × sites into a folder.
fn issue_all(folder: &Folder, stands: &[Stand], sites: &[Site], order: &Issue, seal: Seal, passports: usize) {
    let pairs = stands.iter().flat_map(|stand| sites.iter().map(move |site| (stand, site)));
    for (stand, site) in pairs.take(passports) {
        folder.issue(stand, site, order, seal).expect("a passport");
    }
}

fn payload(file: &[u8]) -> &[u8] {
    let line = b"\nsignature: |\n";
    let end = file.windows(line.len()).position(|window| window == line).expect("a signature");
    &file[..=end]
}

/// The bench's key as OpenSSH writes it.
fn openssh_key() -> String {
    let pair = ssh_key::private::Ed25519Keypair::from_seed(&SECRET);
    let key = ssh_key::PrivateKey::from(pair);
    key.to_openssh(ssh_key::LineEnding::LF).expect("a key").to_string()
}

/// Seconds of one process of Python for the passports of `stands`, and what it computed.
fn python(fleet: &Fleet, stands: &[Stand]) -> Option<Value> {
    let input = json!({
        "stands": stands.iter().map(|stand| stand.write()).collect::<Vec<_>>(),
        "sites": fleet.sites.iter().map(|site| site.write()).collect::<Vec<_>>(),
        "issuer": fleet::ISSUER,
        "issued_at": fleet::ISSUED_AT,
        "secret": SECRET,
        "folder": scratch("bench-issue-python"),
    });
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let installed = project.join("target/test-tools/venv/bin/python");
    let python = if installed.is_file() { installed } else { "python3".into() };
    let script = project.join("benches/issue_python.py");
    let mut child = Command::new(python).arg(script).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().ok()?;
    child.stdin.take()?.write_all(input.to_string().as_bytes()).ok()?;
    serde_json::from_slice(&child.wait_with_output().ok()?.stdout).ok()
}

/// Whether two numbers agree to 1e-12 of the largest of their matrix or set.
fn agree(found: &Value, due: &[f64], what: &str) {
    fn flat(value: &Value, into: &mut Vec<f64>) {
        match value {
            Value::Array(items) => items.iter().for_each(|item| flat(item, into)),
            other => into.extend(other.as_f64()),
        }
    }
    let mut numbers = Vec::new();
    flat(found, &mut numbers);
    assert_eq!(numbers.len(), due.len(), "{what}");
    let largest = due.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    for (found, due) in numbers.iter().zip(due) {
        assert!((found - due).abs() <= 1e-12 * largest, "Python does other work: {what} {found} {due}");
    }
}

/// Every passport of Python has our Δ, B, C and ω.
fn compare(fleet: &Fleet, stands: &[Stand], computed: &Value) {
    let pairs = stands.iter().flat_map(|stand| fleet.sites.iter().map(move |site| (stand, site)));
    let computed = computed.as_array().map_or(&[][..], Vec::as_slice);
    assert_eq!(computed.len(), stands.len() * fleet.sites.len());
    for ((stand, site), numbers) in pairs.zip(computed) {
        let content = draft(stand, site, &fleet.order).expect("a passport").content().clone();
        let matrices = content.matrices.expect("the eight positions");
        for (at, rows) in [matrices.delta, matrices.b_deg_per_h, matrices.c_deg_per_h_per_g].iter().enumerate() {
            agree(&numbers[at], rows.as_flattened(), ["delta", "B", "C"][at]);
        }
        let omega: Vec<f64> = content.vectors.iter().flat_map(|at| at.omega_deg_per_h).collect();
        agree(&numbers[3], &omega, "omega");
    }
}

fn main() {
    if let Some(passports) = option("--memory") {
        return memory(passports);
    }
    if std::env::args().any(|word| word == "--linear") {
        return linear();
    }
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let fleet = Fleet::new(STANDS, SITES);
    // Both have run once before anything counts.
    fleet.ours(&fleet.stands[0], threads);
    fleet.floor(&fleet.stands[0], threads);
    let each: Vec<(Time, Time)> =
        fleet.stands.iter().map(|stand| (fleet.ours(stand, threads), fleet.floor(stand, threads))).collect();
    let ratios: Vec<f64> = each.iter().map(|(ours, floor)| floor.wall / ours.wall).collect();
    let (ours, floor): (Vec<Time>, Vec<Time>) = each.into_iter().unzip();
    let (ours, floor): (Time, Time) = (ours.into_iter().sum(), floor.into_iter().sum());
    println!("{STANDS} stands x {SITES} sites, {threads} threads, nothing synced");
    say("ours ", STANDS * SITES, ours);
    say("floor", STANDS * SITES, floor);
    println!(
        "ours / floor: {:.2}, median of the stands; {:.2} by processor time (asked for: 0.5)",
        median(&ratios),
        floor.processor / ours.processor
    );

    let stands = &fleet.stands[..PYTHON_STANDS];
    let passports = stands.len() * SITES;
    let (mut ratios, mut processor) = (Vec::new(), Vec::new());
    for round in 0..PYTHON_ROUNDS {
        let ours: Time = stands.iter().map(|stand| fleet.ours(stand, 1)).sum();
        let found = python(&fleet, stands).expect("Python with NumPy, PyYAML and cryptography");
        if round == 0 {
            compare(&fleet, stands, &found["computed"]);
        }
        let number = |key: &str| found[key].as_f64().unwrap_or(f64::NAN);
        let theirs = Time { wall: number("seconds"), processor: number("processor_seconds") };
        ratios.push(theirs.wall / ours.wall);
        processor.push(theirs.processor / ours.processor);
        if round + 1 == PYTHON_ROUNDS {
            say("ours, one thread   ", passports, ours);
            say("Python, one process", passports, theirs);
        }
    }
    println!(
        "ours / Python: {:.1}, median of {PYTHON_ROUNDS} rounds; {:.1} by processor time (asked for: 15)",
        median(&ratios),
        median(&processor)
    );

    say("synced file by file, one thread", SYNCED, fleet.synced(SYNCED));
}

fn say(what: &str, passports: usize, time: Time) {
    println!(
        "{what}: {:.0} passports/s; {:.0} us of processor each",
        passports as f64 / time.wall,
        1e6 * time.processor / passports as f64
    );
}

/// One job of so many passports, timed, in a folder of its own.
fn job(passports: usize) -> Time {
    let stands = fleet::stands(passports.div_ceil(SITES));
    let (sites, order) = (fleet::sites(SITES), fleet::order());
    let key = SigningKey::from_openssh(&openssh_key(), None).expect("a key");
    let folder = Folder::new(scratch("bench-issue-job"));
    let seal = Seal { signer: &key, trust: None };
    timed(|| issue_all(&folder, &stands, &sites, &order, seal, passports))
}

fn memory(passports: usize) {
    let time = job(passports);
    println!("{passports} passports: {:.1} s, {:.1} MiB", time.wall, resident_mib().unwrap_or(f64::NAN));
}

fn linear() {
    for passports in [1_000, 10_000, 100_000] {
        say(&format!("{passports} passports"), passports, job(passports));
    }
}
