//! Batch of a factory compared with its floor and with Python, all in one run: `cargo bench --bench issue`.
//!
//! 50 stands × 200 sites, the program `issue` from files to files. Floor: an Ed25519 signature of the same bytes, and
//! the file written and renamed. A stricter floor signs as OpenSSH does, which reads the bytes once, not twice. Python:
//! benches/issue_python.py, which reads back what it writes and verifies what it signs, as the batch does, and once
//! more without these checks. It runs from `target/test-tools` if the tests have installed it there, otherwise as
//! `python3`. The works alternate in rounds, so that changes in the load of the machine affect all of them. Nothing is
//! synced; the cost of syncing is measured separately.
//!
//! `-- --linear` times 1,000, 10,000 and 100,000 passports.

mod fleet;

use dtg_passport::folder::Folder;
use dtg_passport::passport::issue::draft;
use dtg_passport::site::Site;
use dtg_passport::stand::Stand;
use ed25519_dalek::Signer as _;
use fleet::{Time, median, on_threads, scratch, timed, write_and_rename};
use serde_json::{Value, json};
use sha2::{Digest, Sha512};
use std::cell::Cell;
use std::fs;
use std::hint::black_box;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const STANDS: usize = 50;
const SITES: usize = 200;
/// Number of stands for the runs of Python and for the synced runs.
const STANDS_OF_PYTHON: usize = 5;
const ROUNDS: usize = 5;

/// A whole job as a factory runs it, from files to files.
struct Job {
    stands: Vec<Stand>,
    sites: Vec<Site>,
    inputs: PathBuf,
    /// Folder that contains a separate folder for every run. ext4 avoids inodes that were freed within the last minute,
    /// so runs would otherwise be slowed by the deleted files of earlier runs.
    scratch: PathBuf,
    runs: Cell<usize>,
}

impl Job {
    fn new(name: &str, stands: usize, sites: usize) -> Self {
        let (stands, sites) = (fleet::stands(stands), fleet::sites(sites));
        let scratch = scratch(name);
        let inputs = scratch.join("inputs");
        for stand in &stands {
            let folder = inputs.join("stands").join(stand.stand.serial.as_str());
            fs::create_dir_all(&folder).expect("a folder");
            let mut file = json!(stand);
            file["format"] = json!("dtg-stand/1");
            fs::write(folder.join("stand.yaml"), file.to_string()).expect("a stand");
        }
        fs::create_dir_all(inputs.join("sites")).expect("a folder");
        for site in &sites {
            let mut file = json!(site);
            file["format"] = json!("dtg-site/1");
            let path = inputs.join("sites").join(format!("{}.yaml", site.id));
            fs::write(path, file.to_string()).expect("a site");
        }
        fleet::write_key(&scratch.join("key")).expect("a key");
        Self { stands, sites, inputs, scratch, runs: Cell::new(0) }
    }

    fn passports(&self) -> usize {
        self.stands.len() * self.sites.len()
    }

    fn folder(&self) -> Folder {
        Folder::new(self.scratch.join(self.runs.get().to_string()))
    }

    /// Issues every passport into a new folder and returns the time.
    fn run(&self, threads: usize, synced: bool) -> Time {
        self.runs.set(self.runs.get() + 1);
        let mut program = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
        program.arg("issue").arg(self.inputs.join("stands")).arg("--site").arg(self.inputs.join("sites"));
        program.arg("--out").arg(self.folder().root()).arg("--key").arg(self.scratch.join("key"));
        program.args(["--identity", fleet::ISSUER, "--issued-at", fleet::ISSUED_AT, "--threads", &threads.to_string()]);
        if !synced {
            program.arg("--no-sync");
        }
        let mut issued = 0;
        let time = timed(|| {
            let output = program.output().expect("the program");
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            // "issued 10,000, unchanged 0, refused 0"
            let summary = String::from_utf8_lossy(&output.stdout).lines().last().unwrap_or_default().to_owned();
            let count: String =
                summary.split(", ").next().unwrap_or_default().chars().filter(char::is_ascii_digit).collect();
            issued = count.parse().unwrap_or(0);
        });
        assert_eq!(issued, self.passports());
        time
    }

    /// Signs the output of the last run or floor again, writes it into a new folder, and returns the time of this
    /// alone.
    fn floor(&self, threads: usize, sign: impl Fn(&[u8]) -> ed25519_dalek::Signature + Sync) -> Time {
        let pairs = self.stands.iter().flat_map(|stand| self.sites.iter().map(move |site| (stand, site)));
        let paths_in = |folder: Folder| -> Vec<PathBuf> {
            let path = |(stand, site): (&Stand, &Site)| {
                let names = format!("{}/{}/{}-1.yaml", stand.stand.model, stand.stand.serial, site.id);
                folder.root().join(names)
            };
            pairs.clone().map(path).collect()
        };
        let files: Vec<_> = paths_in(self.folder()).iter().map(|path| fs::read(path).expect("a passport")).collect();
        self.runs.set(self.runs.get() + 1);
        let paths = paths_in(self.folder());
        for path in &paths {
            fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        }
        timed(|| {
            on_threads(threads, files.len(), |at| {
                black_box(sign(payload(&files[at])));
                write_and_rename(&paths[at], &files[at]).expect("a file");
            });
        })
    }
}

fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

fn payload(file: &[u8]) -> &[u8] {
    let line = b"\nsignature: |\n";
    let end = file.windows(line.len()).position(|window| window == line).expect("a signature");
    &file[..=end]
}

impl Drop for Job {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.scratch);
    }
}

/// Runs one Python process for the passports of a job. Returns its times in seconds and its numbers, or `None` if it
/// failed.
fn python(job: &Job, checked: bool) -> Option<Value> {
    let input = json!({
        "stands": job.stands,
        "sites": job.sites,
        "issuer": fleet::ISSUER,
        "issued_at": fleet::ISSUED_AT,
        "secret": fleet::SECRET,
        "checked": checked,
        "folder": job.scratch.join(format!("python-{}-{checked}", job.runs.get())),
    });
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let installed = project.join("target/test-tools/venv/bin/python");
    let python = if installed.is_file() { installed } else { "python3".into() };
    let script = project.join("benches/issue_python.py");
    let mut child = Command::new(python).arg(script).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().ok()?;
    child.stdin.take()?.write_all(input.to_string().as_bytes()).ok()?;
    serde_json::from_slice(&child.wait_with_output().ok()?.stdout).ok()
}

/// Asserts that numbers agree to 1e-12 of the largest of their matrix or set.
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

/// Asserts that every passport of Python has our Δ, B, C and ω.
fn compare(job: &Job, computed: &Value) {
    let pairs = job.stands.iter().flat_map(|stand| job.sites.iter().map(move |site| (stand, site)));
    let computed = computed.as_array().map_or(&[][..], Vec::as_slice);
    assert_eq!(computed.len(), job.passports());
    for ((stand, site), numbers) in pairs.zip(computed) {
        let content = draft(stand, site, &fleet::order()).expect("a passport").content().clone();
        let matrices = content.matrices.expect("the eight positions");
        for (at, rows) in [matrices.delta, matrices.b_deg_per_h, matrices.c_deg_per_h_per_g].iter().enumerate() {
            agree(&numbers[at], rows.as_flattened(), ["delta", "B", "C"][at]);
        }
        let omega: Vec<f64> = content.vectors.iter().flat_map(|at| at.omega_deg_per_h).collect();
        agree(&numbers[3], &omega, "omega");
    }
}

fn main() {
    if std::env::args().any(|word| word == "--linear") {
        return linear();
    }
    let threads = processors();
    println!("{STANDS} stands x {SITES} sites, {threads} threads, nothing synced; medians of {ROUNDS} rounds");
    // Freeing the files of one job would disturb the next, so all are dropped at the end.
    let _jobs = [against_the_floor(threads), against_python(), syncing(threads)];
}

fn against_the_floor(threads: usize) -> Job {
    let job = Job::new("bench-issue", STANDS, SITES);
    let key = ed25519_dalek::SigningKey::from_bytes(&fleet::SECRET);
    // Each work runs once before the measured rounds.
    let round = || {
        let ours = job.run(threads, false);
        let floor = job.floor(threads, |bytes| key.sign(bytes));
        [ours, floor, job.floor(threads, |bytes| key.sign(&fleet::signed_data(&Sha512::digest(bytes))))]
    };
    round();
    let [ours, floor, openssh] = by_column((0..ROUNDS).map(|_| round()));
    say("batch", job.passports(), &ours);
    say("floor: Ed25519 of the same bytes", job.passports(), &floor);
    say("floor: as OpenSSH signs", job.passports(), &openssh);
    ratio("batch / floor (asked for: 0.40)", &floor, &ours);
    ratio("batch / floor as OpenSSH signs", &openssh, &ours);
    job
}

fn against_python() -> Job {
    let job = Job::new("bench-issue-python", STANDS_OF_PYTHON, SITES);
    let round = |first: bool| {
        let ours = job.run(1, false);
        let [writing, checking] = [false, true].map(|checked| {
            let found = python(&job, checked).expect("Python with NumPy, PyYAML and cryptography");
            if first {
                compare(&job, &found["computed"]);
            }
            let number = |key: &str| found[key].as_f64().unwrap_or(f64::NAN);
            Time { wall: number("seconds"), processor: number("processor_seconds"), user: number("user_seconds") }
        });
        [ours, writing, checking]
    };
    round(true);
    let [ours, writing, checking] = by_column((0..ROUNDS).map(|_| round(false)));
    say("batch, one thread", job.passports(), &ours);
    say("Python that checks as the batch does", job.passports(), &checking);
    say("Python that checks nothing", job.passports(), &writing);
    ratio("batch / Python that checks (asked for: 15)", &checking, &ours);
    ratio("batch / Python that checks nothing", &writing, &ours);
    job
}

/// Measures the cost of syncing every file to disk.
fn syncing(threads: usize) -> Job {
    let job = Job::new("bench-issue-synced", STANDS_OF_PYTHON, SITES);
    let round = || [false, true].map(|synced| job.run(threads, synced));
    let [without, with] = by_column((0..ROUNDS).map(|_| round()));
    say("batch, synced", job.passports(), &with);
    ratio("batch with --no-sync / synced", &with, &without);
    job
}

/// Returns the rounds of several works as a list for each work.
fn by_column<const N: usize>(rounds: impl Iterator<Item = [Time; N]>) -> [Vec<Time>; N] {
    let rounds: Vec<_> = rounds.collect();
    std::array::from_fn(|work| rounds.iter().map(|round| round[work]).collect())
}

fn say(what: &str, passports: usize, times: &[Time]) {
    let of = |time: fn(&Time) -> f64| median(&times.iter().map(time).collect::<Vec<_>>());
    println!(
        "{what}: {:.0} passports/s; {:.0} us of processor each, {:.0} of them outside the system",
        passports as f64 / of(|time| time.wall),
        1e6 * of(|time| time.processor) / passports as f64,
        1e6 * of(|time| time.user) / passports as f64
    );
}

/// Prints the time of `slow` relative to `fast`: the median of the ratios of the rounds.
fn ratio(what: &str, slow: &[Time], fast: &[Time]) {
    let of = |time: fn(&Time) -> f64| {
        median(&slow.iter().zip(fast).map(|(slow, fast)| time(slow) / time(fast)).collect::<Vec<_>>())
    };
    println!("{what}: {:.2}; {:.2} by processor time", of(|time| time.wall), of(|time| time.processor));
}

fn linear() {
    let mut jobs = Vec::new();
    for passports in [1_000, 10_000, 100_000] {
        let job = Job::new(&format!("bench-issue-{passports}"), STANDS, passports / STANDS);
        let rounds = (100_000 / passports).min(ROUNDS);
        let times: Vec<_> = (0..rounds).map(|_| job.run(processors(), false)).collect();
        say(&format!("{STANDS} stands x {} sites", passports / STANDS), passports, &times);
        // Kept until the end, because freed inodes slow down later runs.
        jobs.push(job);
    }
}
