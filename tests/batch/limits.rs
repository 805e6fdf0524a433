//! No space, no file handles, a folder that cannot be written: what is there verifies, what was reported is there, nothing
//! is left over, and the job can be run again. And in which order things reach the disk.

use crate::programs;
use crate::workshop::{SIGN, Said, Workshop};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::process::{Command, Stdio};

/// A mount namespace of its own, in which a script is root: as root, or by a user namespace.
fn namespace() -> String {
    for way in ["unshare -m", "unshare -rm"] {
        let words: Vec<&str> = way.split(' ').collect();
        let mut command = programs::on_path(words[0]);
        command.args(&words[1..]).args(["sh", "-c", "mount -t tmpfs none /mnt"]).stderr(Stdio::null());
        if command.status().is_ok_and(|status| status.success()) {
            return way.to_owned();
        }
    }
    panic!("neither `unshare -m` (as root) nor `unshare -rm` can mount here: these tests need one of them");
}

/// Runs a script in a namespace; in it stand `out/`, and the exit codes and reports of its runs in `report-1`, ….
fn in_namespace(workshop: &Workshop, script: &str) {
    fs::create_dir_all(workshop.path("out")).unwrap();
    let output = workshop.shell(&format!("exec {} sh -ec '{script}'", namespace())).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// `n`-th run of a job into `out/`: its report, its words, its exit code.
fn run(number: usize, arguments: &str) -> String {
    format!(
        "set +e; \"$DTG\" {arguments} --format csv --out out >report-{number} 2>words-{number}; \
         echo $? >code-{number}; set -e; cp -a out survived-{number};"
    )
}

/// What the run left, which must be sound; what it reported must be there, and what it listed it reported.
fn survived(workshop: &Workshop, number: usize, code: i32) -> Said {
    let read = |name: &str| workshop.read(format!("{name}-{number}"));
    let said = Said { results: read("report"), words: read("words") };
    assert_eq!(read("code").trim(), code.to_string(), "{}", said.words);
    let folder = format!("survived-{number}");
    let reported = said.ids("issued").union(&said.ids("unchanged")).cloned().collect();
    assert!(workshop.sound(&folder).is_superset(&reported));
    assert_eq!(workshop.listed(&folder).into_keys().collect::<BTreeSet<_>>(), reported);
    assert!(workshop.leftovers(&folder).is_empty());
    said
}

#[test]
fn a_full_disk_costs_what_has_no_room_and_no_more() {
    let workshop = Workshop::new(1, 60);
    let issue = format!("issue stands --site sites {SIGN}");
    let script = format!(
        "mount -t tmpfs -o size=300k none out; {} mount -o remount,size=20m out; {}",
        run(1, &issue),
        run(2, &issue)
    );
    in_namespace(&workshop, &script);
    let said = survived(&workshop, 1, 2);
    // Where the register has no room, the passports that have it do not count yet.
    assert_eq!((said.ids("issued").len(), said.ids("refused").len()), (0, 60));
    said.says("not listed in the register, so it does not count");
    assert!(said.words.contains("no space left on the disk; no file was left"), "{}", said.words);
    let said = survived(&workshop, 2, 0);
    assert_eq!(said.ids("issued").len() + said.ids("unchanged").len(), 60);
    assert!(!said.ids("unchanged").is_empty(), "nothing had room");
}

#[test]
fn results_that_belong_together_are_there_or_not() {
    let workshop = Workshop::new(1, 1);
    fs::create_dir(workshop.path("gyros")).unwrap();
    fs::copy(programs::project("docs/currents.csv"), workshop.path("gyros/4711.csv")).unwrap();
    let passport = programs::project("passports/SPS-2/0017/moscow-bmstu-1.yaml");
    let read = format!(
        "{} --time 2026-11-20 --trust {}",
        passport.display(),
        programs::project("docs/allowed_signers").display()
    );
    let calibrate = read.replacen(' ', " gyros --method least-squares ", 1);
    for (job, small, large) in [
        (format!("calibrate {calibrate} --out out"), "4711.json", "4711.html"),
        (format!("export {read} --to site,json --out out"), "moscow-bmstu.yaml", "SPS-2/0017/moscow-bmstu-1.json"),
    ] {
        let size = |name: &str| fs::metadata(workshop.path(format!("out/{name}"))).map(|found| found.len());
        workshop.run(&job, 0);
        let (fits, does_not) = (size(small).unwrap(), size(large).unwrap());
        assert!(fits + 1024 < does_not, "{job}: {fits}, {does_not}");
        fs::remove_dir_all(workshop.path("out")).unwrap();
        // The limit is in units of 512 bytes; the smaller file is below it.
        let limit = fits.div_ceil(512);
        let limited = format!("trap '' XFSZ; ulimit -f {limit}; exec \"$DTG\" {job}");
        let output = workshop.shell(&limited).output().unwrap();
        let words = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(words.contains(large) && words.contains("no file was left"), "{words}");
        assert!(size(small).is_err() && size(large).is_err(), "{job}");
        // The same command does it when there is room.
        workshop.run(&job, 0);
        fs::remove_dir_all(workshop.path("out")).unwrap();
    }
}

#[test]
fn too_few_file_handles_cost_what_needs_them() {
    let workshop = Workshop::new(2, 20);
    let issue = format!("issue stands --site sites {SIGN}");
    let mut out_of_handles = 0;
    for handles in 4..14 {
        let out = format!("out-{handles}");
        let script = format!("ulimit -n {handles}; exec \"$DTG\" {issue} --threads 4 --format csv --out {out}");
        let output = workshop.shell(&script).output().unwrap();
        let code = output.status.code().expect("no signal");
        let said = Said::of(output, code);
        assert!(code == 0 || code == 2, "{code}: {}", said.words);
        assert!(workshop.sound(&out).is_superset(&said.ids("issued")));
        assert_eq!(workshop.listed(&out).into_keys().collect::<BTreeSet<_>>(), said.ids("issued"));
        assert!(workshop.leftovers(&out).is_empty());
        out_of_handles += usize::from(said.words.contains("Too many open files"));
        let said = workshop.run(&format!("{issue} --format csv --out {out}"), 0);
        assert_eq!(said.ids("issued").len() + said.ids("unchanged").len(), 40);
    }
    assert!(out_of_handles > 0, "there were always handles enough");
}

/// By the calls that the system sees: a passport is synced before it is renamed, and its folder before the register that
/// lists it is renamed and synced; only then is it reported.
#[test]
fn nothing_is_reported_before_it_is_safe() {
    let workshop = Workshop::new(2, 40);
    let issue = format!("{} issue stands --site sites {SIGN} --format csv", env!("CARGO_BIN_EXE_dtg-passport"));
    let calls = "trace=openat,fsync,rename,renameat,renameat2,mkdir,write,close";
    let trace = |more: &str| {
        let mut strace = programs::on_path("strace");
        strace.args(["-f", "-y", "-qq", "-s", "200", "-o", "trace", "-e", calls]);
        strace.args(issue.split(' ')).args(more.split(' ')).current_dir(workshop.path("."));
        programs::output(strace);
        workshop.read("trace")
    };
    let mut order = Order::default();
    trace("--out synced").lines().for_each(|line| order.note(line));
    // With one register for each stand.
    assert_eq!((order.renamed.len(), order.reported), (82, 80));
    let trace = trace("--out quick --no-sync");
    assert!(!trace.contains("fsync("), "{trace}");
    assert_eq!(workshop.sound("synced").len(), workshop.sound("quick").len());
}

/// When what happened, by the number of the call.
#[derive(Default)]
struct Order {
    calls: usize,
    synced: BTreeMap<String, usize>,
    renamed: BTreeMap<String, usize>,
    reported: usize,
}

impl Order {
    fn note(&mut self, line: &str) {
        self.calls += 1;
        // `1234 fsync(5</tmp/…/.dtg-passport-AbCdEf.tmp>) = 0`; a call that another thread interrupts has two lines, and
        // its arguments stand in the first.
        if line.contains(" fsync(") {
            let name = between(line, "<", ">").expect("the name of what is synced");
            self.synced.insert(name.to_owned(), self.calls);
        } else if line.contains(" rename") && line.contains(".tmp\"") {
            let names: Vec<&str> = line.split('"').collect();
            let (from, to) = (names[1], names[3]);
            if let Some(folder) = to.strip_suffix("/register.yaml") {
                let synced = self.synced_last(folder);
                let mut passports = self.renamed.iter().filter(|(file, _)| file.starts_with(folder));
                assert!(passports.all(|(_, at)| synced > Some(*at)), "{folder} was not synced before: {line}");
            }
            assert!(self.synced.keys().any(|synced| synced.ends_with(from)), "{from} was not synced before: {line}");
            self.renamed.insert(to.to_owned(), self.calls);
        } else if line.contains(" write(1") {
            for file in self.renamed.keys().filter(|file| line.contains(&format!(",{file},"))) {
                let folder = file.rsplit_once('/').unwrap().0;
                assert!(self.renamed[&format!("{folder}/register.yaml")] > self.renamed[file], "not listed: {line}");
                for folder in [folder, "synced/SPS-2", "synced"] {
                    assert!(self.synced_last(folder) > Some(self.renamed[file]), "{folder} was not synced: {line}");
                }
                self.reported += 1;
            }
        }
    }

    /// The number of the last call that synced a folder.
    fn synced_last(&self, folder: &str) -> Option<usize> {
        self.synced.iter().filter(|(name, _)| name.ends_with(folder)).map(|(_, call)| *call).max()
    }
}

fn between<'a>(text: &'a str, start: &str, end: &str) -> Option<&'a str> {
    text.split_once(start)?.1.split_once(end).map(|(inside, _)| inside)
}

/// While a key is in memory, no core dump can be made.
#[test]
fn a_key_in_memory_is_kept_out_of_core_dumps() {
    let workshop = Workshop::new(20, 200);
    let mut command = workshop.shell(&format!("ulimit -c unlimited; exec \"$DTG\" issue stands --site sites {SIGN}"));
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    // With the first passport the key is surely there.
    while !workshop.path("passports/SPS-2/0000/site-00000-1.yaml").exists() {
        assert!(child.try_wait().unwrap().is_none(), "the batch has ended without a passport");
        std::thread::yield_now();
    }
    let kill = |signal: &str| Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
    assert!(kill("-STOP").success());
    let limits = fs::read_to_string(format!("/proc/{}/limits", child.id())).unwrap();
    assert!(kill("-CONT").success() && kill("-ABRT").success());
    let core = limits.lines().find(|line| line.starts_with("Max core file size")).unwrap();
    assert_eq!(core.split_whitespace().skip(4).take(2).collect::<Vec<_>>(), ["0", "0"], "{core}");
    let status = child.wait().unwrap();
    assert!(status.signal().is_some() && !status.core_dumped(), "{status}");
}

/// The largest memory that a dry run takes, by the system's own account.
fn peak_kib(workshop: &Workshop, stands: &str, sites: &str) -> u64 {
    let script = "import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True, stdout=sys.stderr); \
                  print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)";
    let mut python = programs::python();
    python.args(["-c", script, env!("CARGO_BIN_EXE_dtg-passport")]).current_dir(workshop.path("."));
    python.args(format!("issue {stands} --site {sites} {SIGN} --dry-run --format csv").split(' '));
    programs::output(python).trim().parse().unwrap()
}

#[test]
fn memory_does_not_grow_with_the_number_of_passports() {
    let workshop = Workshop::new(40, 100);
    let (few, many) = (peak_kib(&workshop, "stands/0000", "sites"), peak_kib(&workshop, "stands", "sites"));
    assert!(many < 64 << 10, "{many} KiB");
    assert!(many < few + (4 << 10), "{few} KiB for 100 passports, {many} KiB for 4,000");
}

/// `cargo test --release --test batch -- --ignored --nocapture a_million_planned`
#[test]
#[ignore = "takes minutes; the figure in docs/development/figures.md"]
fn a_million_planned() {
    let workshop = Workshop::new(50, 20_000);
    let few = peak_kib(&workshop, "stands", "sites/site-000*.yaml --site sites/site-001*.yaml");
    let many = peak_kib(&workshop, "stands", "sites");
    println!("peak memory: 10,000 planned {few} KiB, 1,000,000 planned {many} KiB");
    assert!(many < 64 << 10);
}

/// `cargo test --release --test batch -- --ignored --nocapture over_ten_thousand`
#[test]
#[ignore = "issues 10,000 passports and measures the time, which means something only for an optimised program"]
fn status_and_history_over_ten_thousand() {
    let workshop = Workshop::new(50, 200);
    workshop.write(
        "dtg-passport.toml",
        "key = \"key\"\nidentity = \"factory\"\ntrust = \"allowed_signers\"\npassports = \"passports\"\n\
         stands = \"stands\"\nsites = \"sites\"\n",
    );
    workshop.run(&format!("issue stands --site sites {SIGN} --no-sync --out passports --format csv"), 0);
    let verbs = [
        ("status", "status --workspace . --time 2026-11-20", "10000 current"),
        ("history", "history SPS-2/0007 --workspace . --time 2026-11-20", "site-00199"),
    ];
    for (verb, command, due) in verbs {
        let mut seconds: Vec<f64> = (0..5)
            .map(|_| {
                let start = std::time::Instant::now();
                let said = workshop.run(command, 0);
                assert!(said.results.contains(due), "{}", said.results);
                start.elapsed().as_secs_f64()
            })
            .collect();
        seconds.sort_by(f64::total_cmp);
        println!(
            "{verb} over 10,000 passports, 50 stands, 200 sites: {:.2} s (median of {})",
            seconds[2],
            seconds.len()
        );
        assert!(cfg!(debug_assertions) || seconds[2] <= 1.0, "{verb}: {seconds:?}");
    }
}

#[test]
fn no_file_may_grow_large_enough() {
    let workshop = Workshop::new(1, 5);
    let issue = format!("issue stands --site sites {SIGN} --out out");
    // The limit is in units of 512 bytes. Ignored, the signal becomes an error; otherwise it kills in the middle.
    let limited = format!("ulimit -f 8; exec \"$DTG\" {issue}");
    let output = workshop.shell(&format!("trap '' XFSZ; {limited} --format csv")).output().unwrap();
    let said = Said::of(output, 2);
    assert_eq!(said.ids("refused").len(), 5);
    said.says("cannot be written: File too large");
    assert!(workshop.sound("out").is_empty() && workshop.leftovers("out").is_empty());
    let killed = workshop.shell(&limited).output().unwrap();
    assert!(killed.status.signal().is_some(), "{}", killed.status);
    assert!(workshop.sound("out").is_empty() && !workshop.leftovers("out").is_empty());
    let said = workshop.run(&format!("{issue} --format csv"), 0);
    assert_eq!(said.ids("issued").len(), 5);
    assert!(workshop.leftovers("out").is_empty());
}
