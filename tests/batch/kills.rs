//! Killed at any moment: every passport that is there verifies, what was reported is there, nothing that was there has
//! changed, what is listed is there, whole, and stays listed, and the same command again does the rest and clears up.

use crate::programs;
use crate::workshop::{Passports, SIGN, Said, Workshop};
use dtg_passport::register::State;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::Duration;

const STANDS: usize = 3;
const SITES: usize = 70;
const PASSPORTS: usize = STANDS * SITES;

/// What a job does: every passport is issued, then issued anew, every register is renewed, the stand `SPS-2/0017` is
/// certified anew, and then every passport is withdrawn.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Part {
    Issue,
    Reissue,
    Renew,
    Recertify,
    Revoke,
}

/// Number of passports of the stand that is certified anew.
const OF_RECERTIFIED: usize = 20;

/// A job that is killed again and again until it is done.
struct Job {
    workshop: Workshop,
    /// What was there after the last kill.
    known: Passports,
    /// What was listed after the last kill.
    listed: BTreeMap<String, State>,
    part: Part,
    /// Sequences of the registers when this part began.
    sequences: Vec<u64>,
}

/// What the kills met.
#[derive(Debug, Default)]
struct Accumulator {
    kills: usize,
    /// Runs that had written something before.
    at_work: usize,
    leftovers: usize,
    jobs: usize,
}

impl Job {
    fn new() -> Self {
        let workshop = Workshop::new(STANDS, SITES);
        for number in 0..STANDS {
            let text = workshop.read(format!("stands/{number:04}/stand.yaml"));
            workshop.write(format!("new/{number:04}/stand.yaml"), &text.replace("C-2026-0142", "C-2027-0001"));
        }
        fs::copy(programs::project("docs/header.yaml"), workshop.path("header.yaml")).unwrap();
        let readings = fs::read_to_string(programs::project("docs/angles.csv")).unwrap();
        workshop.write("angles.csv", &readings);
        workshop.write("again.csv", &shifted(&readings));
        Self { workshop, known: Passports::new(), listed: BTreeMap::new(), part: Part::Issue, sequences: Vec::new() }
    }

    /// Certifies the stand that is certified anew, and issues its first passports.
    fn certify(&mut self) {
        let stand = "passports/SPS-2/0017/stand.yaml";
        self.workshop.run(&format!("certify angles.csv --stand header.yaml -o {stand}"), 0);
        self.workshop
            .run(&format!("issue {stand} --site sites/site-0000*.yaml --site sites/site-0001*.yaml {SIGN}"), 0);
    }

    fn arguments(&self) -> String {
        let trust = "--trust allowed_signers";
        match self.part {
            Part::Issue => format!("issue stands --site sites {SIGN} --format csv"),
            Part::Reissue => {
                let anew = SIGN.replace("2026-11-03", "2026-11-20");
                format!("reissue passports --stand new --reason recertified {anew} {trust} --format csv")
            }
            Part::Renew => format!("register passports --renew --key key --identity factory {trust}"),
            Part::Recertify => format!(
                "recertify passports/SPS-2/0017/site-00000-1.yaml again.csv --accept-change --number C-2027-0002 --issued 2026-11-20 \
                 --issued-at 2026-11-21 --reason recertified --key key --identity factory {trust} --time 2026-11-21"
            ),
            Part::Revoke => format!("revoke SPS-2/*/*/* --reason wrong --key key --identity factory {trust}"),
        }
    }

    /// Whether nothing is left to be done.
    fn is_done(&self) -> bool {
        let count = |state: State| self.listed.values().filter(|listed| **listed == state).count();
        match self.part {
            Part::Issue => count(State::Current) == PASSPORTS,
            Part::Reissue => self.listed.len() == 2 * PASSPORTS,
            Part::Renew => self.now().iter().zip(&self.sequences).all(|(now, then)| now > then),
            Part::Recertify => {
                let stand = fs::read_to_string(self.workshop.path("passports/SPS-2/0017/stand.yaml")).unwrap();
                self.listed.len() == 2 * PASSPORTS + 2 * OF_RECERTIFIED && stand.contains("C-2027-0002")
            }
            Part::Revoke => count(State::Withdrawn) == 2 * PASSPORTS + 2 * OF_RECERTIFIED,
        }
    }

    /// Sequences of the registers.
    fn now(&self) -> Vec<u64> {
        let text =
            |number| fs::read_to_string(self.workshop.path(format!("passports/SPS-2/{number:04}/register.yaml")));
        let texts = (0..STANDS).map(|number| text(number).unwrap());
        let line = |text: String| text.split_once("sequence: ")?.1.split_once(',')?.0.parse().ok();
        texts.map(|text| line(text).expect("a sequence")).collect()
    }

    /// Runs the job and kills it once so many new files have come and a moment has passed, unless it is done before.
    /// Whether it was killed.
    fn run_and_kill(&self, after: usize, moment: Duration) -> bool {
        let report = File::create(self.workshop.path("report")).unwrap();
        let before = self.files();
        let mut command = self.workshop.command(&self.arguments());
        let mut child = command.stdout(report).stderr(Stdio::null()).spawn().unwrap();
        while self.files() < before + after && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_micros(200));
        }
        std::thread::sleep(moment);
        // On Unix this is SIGKILL.
        child.kill().unwrap();
        child.wait().unwrap().code().is_none()
    }

    /// Files in the folders of the stands, temporary ones too.
    fn files(&self) -> usize {
        let folders = (0..STANDS).chain([17]).map(|number| self.workshop.path(format!("passports/SPS-2/{number:04}")));
        folders.map(|folder| fs::read_dir(folder).map_or(0, Iterator::count)).sum()
    }

    /// What must hold after a kill. Gives how many passports are new or newly listed, or listed otherwise.
    fn check(&mut self) -> usize {
        let before = self.known.len();
        let listed = self.workshop.listed("passports");
        for (id, was) in &self.listed {
            let is = listed.get(id).unwrap_or_else(|| panic!("{id} is no longer listed"));
            assert!(is == was || *was == State::Current || *is == State::Withdrawn, "{id}: {was:?} became {is:?}");
        }
        let news = listed.iter().filter(|(id, state)| self.listed.get(*id) != Some(*state)).count();
        self.listed = listed;
        let now = self.workshop.sound_beside("passports", &self.known);
        let unchanged = |(path, passport)| now.get(path) == Some(passport);
        assert!(self.known.iter().all(unchanged), "something that was there is gone or has changed");
        self.known = now;
        let ids: BTreeSet<&str> = self.known.values().map(|(id, _)| id.as_str()).collect();
        // The last line may be cut; all others are whole.
        let report = fs::read_to_string(self.workshop.path("report")).unwrap();
        let whole = &report[..report.rfind('\n').map_or(0, |end| end + 1)];
        let lines = whole.lines().skip(1).filter(|_| matches!(self.part, Part::Issue | Part::Reissue));
        for line in lines {
            let cells: Vec<&str> = line.split(',').collect();
            let [state, id, file, hash, ..] = cells[..] else { panic!("{line}") };
            assert!(["issued", "unchanged", "skipped"].contains(&state), "{line}");
            assert!(ids.contains(id), "{id} was reported and is not there");
            assert!(self.listed.contains_key(id), "{id} was reported and is not listed");
            if !hash.is_empty() {
                assert_eq!(self.known[&self.workshop.path(file)].1, hash);
            }
        }
        news + self.known.len() - before
    }

    /// Not killed, the job is done, and nothing is left over.
    fn finish(&mut self) {
        let said = self.workshop.run(&self.arguments(), 0);
        if matches!(self.part, Part::Issue | Part::Reissue) {
            let (done, skipped) = (said.ids("issued").len() + said.ids("unchanged").len(), said.ids("skipped").len());
            assert_eq!(done, PASSPORTS, "{}", said.words);
            assert!(skipped <= PASSPORTS);
        }
        assert_eq!(self.workshop.leftovers("passports"), Vec::<PathBuf>::new());
        fs::write(self.workshop.path("report"), said.results).unwrap();
        self.check();
        assert!(self.is_done(), "{:?}", self.listed);
    }
}

/// Kills so many runs at random moments.
fn kill(kills: usize, seed: u64) -> Accumulator {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut below = |end: usize| (random.next_u64() % end as u64) as usize;
    let mut tally = Accumulator::default();
    let mut job = Job::new();
    while tally.kills < kills {
        let (files, microseconds) = match job.part {
            Part::Issue | Part::Reissue => (below(PASSPORTS / 3), below(5000)),
            // Several files at once.
            Part::Recertify => (below(OF_RECERTIFIED), below(5000)),
            // These write nothing but registers.
            Part::Renew | Part::Revoke => (1, below(5000)),
        };
        let killed = job.run_and_kill(files, Duration::from_micros(microseconds as u64));
        tally.kills += usize::from(killed);
        tally.at_work += usize::from(job.check() > 0 && killed);
        tally.leftovers += job.workshop.leftovers("passports").len();
        if !job.is_done() {
            continue;
        }
        job.finish();
        tally.jobs += 1;
        match job.part {
            Part::Issue => job.part = Part::Reissue,
            Part::Reissue => (job.sequences, job.part) = (job.now(), Part::Renew),
            Part::Renew => {
                job.certify();
                job.part = Part::Recertify;
            }
            Part::Recertify => job.part = Part::Revoke,
            Part::Revoke => job = Job::new(),
        }
    }
    job.finish();
    tally
}

/// Readings i, j, run, α, β, γ of a stand of which position (2, 3) has turned by 6 arcsec, and that differ by up to 0.5
/// arcsec.
fn shifted(readings: &str) -> String {
    programs::with_angles(readings, |line, row, column, angle| {
        let turned = if line.starts_with("2,3,") { 6.0 } else { 0.0 };
        angle + turned + f64::from((row * 7 + column * 5) % 13) / 26.0
    })
}

#[test]
fn killed_at_random_nothing_is_lost() {
    let tally = kill(60, 1);
    assert!(tally.at_work > 20, "hardly a kill met a run at work: {tally:?}");
}

/// `cargo test --release --test batch -- --ignored --nocapture a_thousand_kills`
#[test]
#[ignore = "takes many minutes"]
fn a_thousand_kills() {
    let seed = std::env::var("DTG_SEED").map_or(2, |seed| seed.parse().unwrap());
    println!("listed passports lost or torn: 0; re-runs that do not complete: 0; {:?}", kill(1000, seed));
}

/// The temporary file of a living run stays, and that of a dead one does not.
#[test]
fn leftovers_are_cleared_by_the_next_run_unless_somebody_is_at_work_on_them() {
    let workshop = Workshop::new(1, 2);
    let folder = "passports/SPS-2/0000";
    workshop.write(format!("{folder}/.dtg-passport-dead.tmp"), "half a passp");
    workshop.write("passports/.dtg-passport-dead.tmp", "");
    workshop.write(format!("{folder}/.dtg-passport-living.tmp"), "half a passp");
    let living = File::open(workshop.path(format!("{folder}/.dtg-passport-living.tmp"))).unwrap();
    living.lock().unwrap();
    workshop.run(&format!("issue stands --site sites {SIGN} --dry-run"), 0);
    assert_eq!(workshop.leftovers("passports").len(), 3);
    workshop.run(&format!("issue stands --site sites {SIGN}"), 0);
    assert_eq!(workshop.leftovers("passports"), [workshop.path(format!("{folder}/.dtg-passport-living.tmp"))]);
    drop(living);
    workshop.run(&format!("issue stands --site sites {SIGN}"), 0);
    assert!(workshop.leftovers("passports").is_empty());
}

/// On a shared folder whose locks do not reach from machine to machine, somebody may clear away what is in use.
#[test]
fn temporary_files_that_are_taken_away_cost_nothing() {
    let workshop = Workshop::new(2, 60);
    let mut command = workshop.command(&format!("issue stands --site sites {SIGN} --format csv"));
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut taken = 0;
    while child.try_wait().unwrap().is_none() {
        taken += workshop.leftovers("passports").iter().filter(|path| fs::remove_file(path).is_ok()).count();
    }
    let output = child.wait_with_output().unwrap();
    let code = output.status.code().unwrap();
    let said = Said::of(output, code);
    assert!(taken > 0, "nothing was taken away");
    // Whoever lost his file four times in a row says so.
    assert_eq!(code == 0, said.ids("refused").is_empty(), "{}", said.words);
    // What is refused may be there whole: its register was lost, so it does not count.
    assert!(workshop.sound("passports").is_superset(&said.ids("issued")), "{}", said.words);
    workshop.run(&format!("issue stands --site sites {SIGN}"), 0);
    assert_eq!(workshop.sound("passports").len(), 120);
}

/// Whoever is first writes a passport, and the others find it equal.
#[test]
fn several_batches_on_one_folder_do_the_job_together() {
    let workshop = Workshop::new(3, 60);
    let said = workshop.together((3..6).map(|day| {
        let sign = SIGN.replace("2026-11-03", &format!("2026-11-0{day}"));
        format!("issue stands --site sites {sign} --format csv")
    }));
    let sum = |state: &str| said.iter().map(|said| said.ids(state).len()).sum::<usize>();
    assert_eq!((sum("issued"), sum("unchanged")), (180, 360));
    assert_eq!(workshop.sound("passports").len(), 180);
    assert!(workshop.leftovers("passports").is_empty());
}

/// Ctrl-C: the passports that have begun are finished and reported, the list is whole, and the rest is for the next run.
#[test]
fn interrupted_it_finishes_what_it_has_begun() {
    let workshop = Workshop::new(20, 200);
    let mut command = workshop.command(&format!("issue stands --site sites {SIGN} --no-sync --format json"));
    let mut child =
        command.stdout(File::create(workshop.path("report")).unwrap()).stderr(Stdio::piped()).spawn().unwrap();
    while !workshop.path("passports/SPS-2/0000/site-00000-1.yaml").exists() {
        assert!(child.try_wait().unwrap().is_none(), "the batch has ended without a passport");
        std::thread::sleep(Duration::from_micros(200));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let said = Said::of(child.wait_with_output().unwrap(), 1);
    assert_eq!(said.words, "dtg-passport: interrupted; to complete the job, run the same command again\n");
    let report = fs::read(workshop.path("report")).unwrap();
    let report: Vec<serde_json::Value> = serde_json::from_slice(&report).unwrap();
    let reported: BTreeSet<String> = report.iter().map(|report| report["id"].as_str().unwrap().to_owned()).collect();
    assert_eq!(workshop.sound("passports"), reported);
    assert!(!reported.is_empty() && reported.len() < 4000, "{}", reported.len());
    assert!(workshop.leftovers("passports").is_empty());
}
