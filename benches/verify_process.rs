//! Process `dtg-passport verify` compared with `ssh-keygen -Y verify` on the same signed text, alternating in one run.
//!
//! `cargo bench --bench verify_process` prints the median time of each, and the median of their ratio in each pair. The
//! variable `DTG_PASSPORT` names another program than that of the benchmark, such as the static one.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

const PAIRS: usize = 300;
const ISSUER: &str = "examples@dtg-passport.test";

fn main() {
    // `cargo test --benches` only checks that it builds and runs.
    let pairs = if std::env::args().any(|argument| argument == "--bench") { PAIRS } else { 1 };
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let passport = project.join("passports/SPS-2/0017/moscow-bmstu-1.yaml");
    let signers = project.join("tests/keys/allowed_signers");
    let text = std::fs::read_to_string(&passport).expect("the shipped passport");
    let (payload, armor) = text.split_once("signature: |\n").expect("a signature");
    let (payload_file, armor_file) = (folder.join("bench.text"), folder.join("bench.sig"));
    std::fs::write(&payload_file, payload).expect("the payload");
    std::fs::write(&armor_file, armor.replace("  ", "")).expect("the armor");

    let built = || env!("CARGO_BIN_EXE_dtg-passport").into();
    let mut ours = Command::new(std::env::var_os("DTG_PASSPORT").unwrap_or_else(built));
    ours.arg("verify").arg(&passport).arg("--trust").arg(&signers).args(["--time", "2026-12-01T00:00:00Z"]);
    let mut theirs = Command::new("ssh-keygen");
    theirs.args(["-Y", "verify", "-n", "dtg-passport", "-I", ISSUER, "-O", "verify-time=20261109090000Z", "-f"]);
    theirs.arg(&signers).arg("-s").arg(&armor_file);

    let mut times: Vec<(f64, f64)> =
        (0..pairs).map(|_| (seconds(&mut ours, None), seconds(&mut theirs, Some(&payload_file)))).collect();
    let mut ratios: Vec<f64> = times.iter().map(|(ours, theirs)| ours / theirs).collect();
    let ratio = median(&mut ratios);
    let (mut ours, mut theirs): (Vec<f64>, Vec<f64>) = times.drain(..).unzip();
    println!("dtg-passport verify:  {:.2} ms", 1e3 * median(&mut ours));
    println!("ssh-keygen -Y verify: {:.2} ms", 1e3 * median(&mut theirs));
    println!("ratio, pair by pair:  {ratio:.2} (median of {pairs})");
}

fn seconds(command: &mut Command, stdin: Option<&Path>) -> f64 {
    let stdin = stdin.map_or_else(Stdio::null, |path| Stdio::from(File::open(path).expect("the payload")));
    let start = Instant::now();
    let status = command.stdin(stdin).stdout(Stdio::null()).stderr(Stdio::null()).status();
    let elapsed = start.elapsed().as_secs_f64();
    assert!(status.is_ok_and(|status| status.success()), "{command:?} failed");
    elapsed
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
