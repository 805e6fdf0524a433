//! Registers of stands: folders of an earlier version, several runs at once, and keys of two people.

use crate::programs;
use crate::workshop::{SIGN, Said, Workshop};
use std::collections::BTreeSet;
use std::fs;
use std::process::Output;

/// The key of the factory and who trusts it.
const OWN: &str = "--key key --identity factory --trust allowed_signers";

/// List of an earlier version, which withdraws one passport.
const OLD_LIST: &str = r#"# Withdrawn passports. Of several lists, the one with the highest sequence number applies.
# Signed verbatim: any change makes the signature invalid.
format: "dtg-revocation/1"
sequence: 1
issued_at: "2026-11-28T15:33:46Z"
issuer: "factory"
entries:
  - {id: "SPS-2/0000/site-00000/1", sha256: "28e78d7896c94b8c2ec025da70e31401c183f2a0a52ff75c59e2b5afaa2b033d", revoked_at: "2026-11-28T15:33:46Z", reason: "latitude of another pillar"}
signature: |
  -----BEGIN SSH SIGNATURE-----
  U1NIU0lHAAAAAQAAADMAAAALc3NoLWVkMjU1MTkAAAAgy/hli6t5jj2ByTUDnGZMfrCmQj
  L+MjF81HMsFZL0paUAAAAOZHRnLXJldm9jYXRpb24AAAAAAAAABnNoYTUxMgAAAFMAAAAL
  c3NoLWVkMjU1MTkAAABAoXvOYo6doizWKam33yY0YOeRxVpkKOs9eL9le7LCoMo3VRnCIt
  /ESKzVwqd4Js5lmGFzOtk4+YMInktyPAp3Dw==
  -----END SSH SIGNATURE-----
"#;

/// Passports of two stands at two sites as an earlier version left them: without registers, and with a list of withdrawn
/// passports in the workspace.
fn of_an_earlier_version() -> Workshop {
    let workshop = Workshop::new(2, 2);
    let text = workshop.read("stands/0001/stand.yaml");
    workshop.write("stands/0001/stand.yaml", &text.replace("C-2026-0142", "C-2026-0143").replace("12.4", "12.9"));
    workshop.run(&format!("issue stands --site sites {SIGN}"), 0);
    for stand in ["0000", "0001"] {
        fs::remove_file(workshop.path(format!("passports/SPS-2/{stand}/register.yaml"))).unwrap();
        fs::remove_file(workshop.path(format!("passports/SPS-2/{stand}/.register.lock"))).unwrap();
    }
    workshop.write("revocations/revocation-1.yaml", OLD_LIST);
    workshop
}

/// State of each listed passport, by the verb `register`, which must find nothing to complain about.
fn states(workshop: &Workshop) -> BTreeSet<(String, String)> {
    let said = workshop.run("register passports --trust allowed_signers --format csv", 0);
    let cells = said.results.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>());
    cells.map(|cells| (cells[2].to_owned(), cells[0].to_owned())).collect()
}

/// The same command, with an argument that contains spaces.
fn with_reason(workshop: &Workshop, arguments: &str, reason: &str) -> Output {
    workshop.command(arguments).args(["--reason", reason]).output().unwrap()
}

#[test]
fn a_folder_of_an_earlier_version_gets_registers_once_every_withdrawn_passport_is_decided_on() {
    const ID: &str = "SPS-2/0000/site-00000/1";
    for withdrawn in [true, false] {
        let workshop = of_an_earlier_version();
        let before = workshop.snapshot(".");
        // Nothing goes on without registers: the command that makes them is named.
        let said = workshop.run(&format!("reissue passports --same-content --reason new {OWN}"), 1);
        assert!(said.words.contains("no register; make it with `register DIR --renew`"), "{}", said.words);
        let said = workshop.run("register passports --trust allowed_signers", 1);
        assert_eq!(said.words.matches("ALARM (no_register): ").count(), 2, "{}", said.words);
        // The list of the earlier version: its file and its passports are named, and nothing is believed.
        for dry in ["", " --dry-run"] {
            let said = workshop.run(&format!("register passports --renew {OWN}{dry}"), 1);
            let why = format!("revocations/revocation-1.yaml: withdraws {ID}, in a format of an earlier version");
            said.says(&why);
            said.says("--withdrawn ID --reason TEXT or --not-withdrawn ID");
        }
        // A decision on another passport is none on this one.
        let other = format!("register passports --renew {OWN} --not-withdrawn SPS-2/0000/site-00001/1");
        assert!(workshop.run(&other, 1).words.contains(ID));
        assert_eq!(workshop.snapshot("."), before);
        let said = match withdrawn {
            true => {
                let renew = format!("register passports --renew {OWN} --withdrawn {ID}");
                Said::of(with_reason(&workshop, &renew, "latitude of another pillar"), 0)
            }
            false => workshop.run(&format!("register passports --renew {OWN} --not-withdrawn {ID}"), 0),
        };
        let state = if withdrawn { "withdrawn" } else { "current" };
        assert!(said.results.contains(&format!("{ID}: {state}")), "{}", said.results);
        let others = ["SPS-2/0000/site-00001/1", "SPS-2/0001/site-00000/1", "SPS-2/0001/site-00001/1"];
        let due = others.map(|id| (id, "current")).into_iter().chain([(ID, state)]);
        assert_eq!(states(&workshop), due.map(|(id, state)| (id.to_owned(), state.to_owned())).collect());
        // The passports and the list themselves are untouched, and the work goes on.
        let after = workshop.snapshot(".");
        assert!(before.is_subset(&after));
        let said = workshop.run(&format!("reissue passports --same-content --reason new {OWN} --format csv"), 0);
        assert_eq!(said.ids("issued").len(), if withdrawn { 3 } else { 4 });
    }
}

/// Expected: without a register, superseded passports are recognised by what their successors state.
#[test]
fn a_first_register_concludes_which_passports_are_superseded() {
    let workshop = Workshop::new(1, 2);
    workshop.run(&format!("issue stands --site sites {SIGN}"), 0);
    workshop.run(&format!("reissue passports/SPS-2/0000/site-00000-1.yaml --same-content --reason new {OWN}"), 0);
    let before = states(&workshop);
    fs::remove_file(workshop.path("passports/SPS-2/0000/register.yaml")).unwrap();
    let said = workshop.run(&format!("register passports --renew {OWN} --dry-run"), 0);
    assert!(said.results.contains("site-00000/1: superseded (SPS-2/0000/site-00000/2)"), "{}", said.results);
    assert!(!workshop.path("passports/SPS-2/0000/register.yaml").exists());
    workshop.run(&format!("register passports --renew {OWN}"), 0);
    assert_eq!(states(&workshop), before);
}

/// Expected: the passports of all runs, each listed once; every register has the SHA-256 of the one before.
#[test]
fn eight_runs_at_once_on_one_stand_lose_no_update() {
    const RUNS: usize = 8;
    const SITES: usize = 40;
    let workshop = Workshop::new(1, SITES);
    // The first register is that of a run of its own: without one, passports of others stop a run.
    workshop.run(&format!("issue stands --site sites/site-00000.yaml {SIGN}"), 0);
    let said = workshop.together((0..RUNS).map(|run| {
        let sites = (0..SITES).filter(|site| site % RUNS == run);
        let sites: String = sites.map(|site| format!("--site sites/site-{site:05}.yaml ")).collect();
        format!("issue stands {sites}{SIGN} --format csv")
    }));
    assert_eq!(said.iter().map(|said| said.ids("issued").len()).sum::<usize>(), SITES - 1);
    let due = (0..SITES).map(|site| (format!("SPS-2/0000/site-{site:05}/1"), "current".to_owned())).collect();
    assert_eq!(states(&workshop), due);
    // One register for each run, in a chain without a gap.
    let text = workshop.read("passports/SPS-2/0000/register.yaml");
    assert!(text.contains(&format!("sequence: {}, previous_sha256: ", 1 + RUNS)), "{text}");
    assert!(workshop.leftovers("passports").is_empty());
}

/// Expected: withdrawals and issues at once, and none is undone by another.
#[test]
fn withdrawals_and_issues_at_once_are_all_in_the_register() {
    let workshop = Workshop::new(1, 8);
    workshop.run(&format!("issue stands --site sites/site-0000[0-3].yaml {SIGN}"), 0);
    workshop.together((0..8).map(|run| match run {
        0..4 => format!("revoke SPS-2/0000/site-0000{run}/1 --reason wrong {OWN}"),
        _ => format!("issue stands --site sites/site-0000{run}.yaml {SIGN}"),
    }));
    let state = |site: usize| if site < 4 { "withdrawn" } else { "current" };
    let due = (0..8).map(|site| (format!("SPS-2/0000/site-{site:05}/1"), state(site).to_owned())).collect();
    assert_eq!(states(&workshop), due);
}

/// A workshop in which one key signs passports, and that of a second person registers.
fn of_two_people() -> Workshop {
    let workshop = Workshop::new(1, 3);
    workshop.run("keygen second --identity factory --no-passphrase", 0);
    let first = fs::read_to_string(programs::project("tests/keys/examples.pub")).unwrap();
    let second = workshop.read("second.pub");
    let line = |namespace: &str, key: &str| format!("factory namespaces=\"{namespace}\" {}\n", key.trim_end());
    workshop.write("allowed_signers", &(line("dtg-passport", &first) + &line("dtg-register", &second)));
    workshop
}

#[test]
fn with_two_keys_the_key_of_the_passports_alone_makes_nothing_count() {
    let workshop = of_two_people();
    let issue = format!("issue stands --site sites {SIGN} --trust allowed_signers");
    // The key of the passports cannot sign the register, and the same key is not that of a second person.
    workshop.run(&issue, 1).says("dtg-register");
    workshop.run(&format!("{issue} --register-key key --out other"), 2).says("--register-key: is the key of --key");
    assert!(!workshop.path("other").exists());
    assert!(!workshop.path("passports").exists(), "a passport was written that no register lists");
    // Nor can it renew, or withdraw.
    workshop.run(&format!("{issue} --without-register"), 0);
    workshop.run(&format!("register passports --renew {OWN}"), 1).says("dtg-register");
    assert!(!workshop.path("passports/SPS-2/0000/register.yaml").exists());
    // With both keys, the same command lists what is written.
    let said = workshop.run(&format!("{issue} --register-key second --format csv"), 0);
    assert_eq!(said.ids("unchanged").len(), 3);
    assert_eq!(states(&workshop).len(), 3);
    workshop.run(&format!("revoke SPS-2/0000/site-00000/1 --reason stolen {OWN}"), 1).says("dtg-register");
    assert!(states(&workshop).iter().all(|(_, state)| state == "current"));
    // Nor can that of the registers sign passports.
    let sign = SIGN.replace("--key key", "--key second");
    workshop.run(&format!("issue stands --site sites {sign} --trust allowed_signers --out other"), 1);
    assert!(workshop.sound("other").is_empty());
}

#[test]
fn a_second_person_takes_over_what_the_first_has_issued() {
    let workshop = of_two_people();
    let issue =
        format!("issue stands --site sites/site-00000.yaml {SIGN} --trust allowed_signers --register-key second");
    workshop.run(&issue, 0);
    let without = format!("issue stands --site sites {SIGN} --trust allowed_signers --without-register --format csv");
    let said = workshop.run(&without, 0);
    assert_eq!(said.ids("issued").len(), 2);
    said.says("do not count until a second person lists them");
    let verify = |code: i32| {
        let passport = "passports/SPS-2/0000/site-00001-1.yaml";
        workshop.run(&format!("verify {passport} --trust allowed_signers --register passports --format json"), code)
    };
    assert!(verify(1).results.contains("\"not_listed\""));
    let said = workshop.run("register passports --trust allowed_signers --format csv", 1);
    assert_eq!(said.words.matches("ALARM (not_listed)").count(), 2, "{}", said.words);
    // The second person reads which ones they are, and takes over one of the two.
    let renew = "register passports --renew --identity factory --trust allowed_signers";
    let said = workshop.run(&format!("{renew} --dry-run"), 0);
    assert_eq!(said.results.matches("to take it over, add --adopt").count(), 2, "{}", said.results);
    let sha256 = {
        use sha2::{Digest, Sha256};
        let bytes = fs::read(workshop.path("passports/SPS-2/0000/site-00001-1.yaml")).unwrap();
        format!("{:x}", Sha256::digest(&bytes))
    };
    let before = workshop.snapshot("passports");
    // Not with the key of the passports, and no file that is not there.
    workshop.run(&format!("{renew} --adopt {sha256} --key key"), 1);
    let said = workshop.run(&format!("{renew} --adopt {} --register-key second", "0".repeat(64)), 1);
    said.says("found no unlisted passport and no outdated register");
    assert_eq!(workshop.snapshot("passports"), before);
    workshop.run(&format!("{renew} --adopt {sha256} --register-key second"), 0);
    assert!(verify(0).results.contains("\"register\""));
    let said = workshop.run("register passports --trust allowed_signers --format csv", 1);
    assert_eq!((said.results.lines().count(), said.words.matches("ALARM (not_listed)").count()), (3, 1));
    // The first person's own command lists nothing; with both keys it completes the register.
    let said = workshop.run(&without, 0);
    assert_eq!(said.ids("unchanged").len(), 3);
    assert_eq!(workshop.run("register passports --trust allowed_signers", 1).words.matches("ALARM").count(), 1);
    workshop.run(&without.replace("--without-register", "--register-key second"), 0);
    assert_eq!(states(&workshop).len(), 3);
}

/// Expected: a register whose key is revoked counts no more, until a person takes it over by its SHA-256.
#[test]
fn a_register_under_a_revoked_key_is_taken_over_by_a_person() {
    let workshop = of_two_people();
    let sign = format!("{SIGN} --trust allowed_signers");
    workshop.run(&format!("issue stands --site sites {sign} --register-key second"), 0);
    workshop.run("keygen third --identity factory --no-passphrase", 0);
    let third = workshop.read("third.pub");
    let signers = workshop.read("allowed_signers");
    workshop.write("allowed_signers", &format!("{signers}factory namespaces=\"dtg-register\" {third}"));
    let trust = "--trust allowed_signers --revoked second.pub";
    workshop.run(&format!("register passports {trust}"), 1).says("ALARM (register_unknown)");
    let renew = format!("register passports --renew --identity factory --register-key third {trust}");
    let said = workshop.run(&renew, 1);
    let sha256 = said.words.split("--adopt ").nth(1).expect("the SHA-256 to adopt")[..64].to_owned();
    let said = workshop.run(&format!("{renew} --adopt {sha256}"), 0);
    assert_eq!(said.results.matches(": current, before: not remembered").count(), 3, "{}", said.results);
    let said = workshop.run(&format!("register passports {trust} --format csv"), 0);
    assert_eq!(said.results.lines().count(), 4);
}

/// Expected: a withdrawal that was killed is completed by the same command, and what is done already is no error.
#[test]
fn the_same_withdrawal_again_is_done_already() {
    let workshop = of_an_earlier_version();
    fs::remove_file(workshop.path("revocations/revocation-1.yaml")).unwrap();
    workshop.run(&format!("register passports --renew {OWN}"), 0);
    let one = "SPS-2/0000/site-00000/1";
    workshop.run(&format!("revoke {one} --reason wrong {OWN}"), 0);
    let before = workshop.snapshot("passports");
    for ids in [one, "SPS-2/0000/site-00000/*"] {
        let said = workshop.run(&format!("revoke {ids} --reason wrong {OWN}"), 0);
        assert_eq!(
            (said.results.as_str(), said.words.as_str()),
            ("", "dtg-passport: already withdrawn; nothing was written\n")
        );
    }
    workshop.run(&format!("revoke {one} --reason other {OWN}"), 1).says("already withdrawn at");
    assert_eq!(workshop.snapshot("passports"), before);
    // Together with one that is not yet withdrawn, as after a kill.
    workshop.run(&format!("revoke {one} SPS-2/0001/site-00000/1 --reason wrong {OWN}"), 0);
    assert_eq!(states(&workshop).iter().filter(|(_, state)| state == "withdrawn").count(), 2);
}
