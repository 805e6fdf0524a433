//! Passports of a whole folder issued anew: those that a change concerns, and no others.

use crate::workshop::{SIGN, Said, Workshop, snapshot};
use std::collections::BTreeSet;
use std::fs;

/// Weeks later.
const ANEW: &str =
    "--key key --identity factory --trust allowed_signers --time 2026-11-20 --issued-at 2026-11-20 --format csv";

/// Two stands at five sites, revision 1 of each.
fn issued() -> Workshop {
    let workshop = Workshop::new(2, 5);
    workshop.run(&format!("issue stands --site sites {SIGN}"), 0);
    workshop
}

/// A new certificate of a stand, in a folder of its own.
fn certified_again(workshop: &Workshop, stand: &str, number: &str) {
    let text = fs::read_to_string(workshop.path(&format!("stands/{stand}/stand.yaml"))).unwrap();
    let text = text.replace("C-2026-0142", number).replace("alpha_arcsec: 12.4", "alpha_arcsec: 12.9");
    workshop.write(&format!("new/{stand}/stand.yaml"), &text);
}

/// The stand file of a certificate so many years before, which is two years long.
fn years_earlier(workshop: &Workshop, stand: &str, years: i32) -> String {
    let text = fs::read_to_string(workshop.path(&format!("stands/{stand}/stand.yaml"))).unwrap();
    let year = |year: i32| format!("\"{}-", year - years);
    text.replace("\"2026-", &year(2026)).replace("\"2028-", &year(2028))
}

/// Passports that last until long after the clock's time, which is when lists are made that withdraw them.
fn issued_for_long() -> Workshop {
    let workshop = Workshop::new(2, 5);
    for stand in ["0000", "0001"] {
        let text = fs::read_to_string(workshop.path(&format!("stands/{stand}/stand.yaml"))).unwrap();
        workshop.write(&format!("stands/{stand}/stand.yaml"), &text.replace("\"2028-", "\"2098-"));
    }
    workshop.run(&format!("issue stands --site sites {SIGN}"), 0);
    workshop
}

/// By the clock, as the lists that withdraw passports are.
const NOW: &str = "--key key --identity factory --trust allowed_signers --format csv";

fn ids(stand: &str, sites: &[u32], revision: u32) -> BTreeSet<String> {
    sites.iter().map(|site| format!("SPS-2/{stand}/site-{site:05}/{revision}")).collect()
}

const ALL: [u32; 5] = [0, 1, 2, 3, 4];

#[test]
fn a_new_certificate_re_issues_all_that_hangs_on_it_once() {
    let workshop = issued();
    certified_again(&workshop, "0001", "C-2027-0001");
    let before = snapshot(&workshop.path("passports"));
    let again = format!("reissue passports --stand new/0001/stand.yaml --reason recertified {ANEW}");
    let said = workshop.run(&format!("{again} --dry-run"), 0);
    assert_eq!(said.ids("planned"), ids("0001", &ALL, 2));
    assert_eq!(snapshot(&workshop.path("passports")), before);
    let said = workshop.run(&again, 0);
    assert_eq!((said.ids("issued"), said.results.lines().count()), (ids("0001", &ALL, 2), 6));
    assert_eq!(workshop.sound("passports").len(), 15);
    let after = snapshot(&workshop.path("passports"));
    assert!(before.is_subset(&after));
    // Nothing hangs on the old certificate any more.
    let said = workshop.run(&again, 0);
    assert_eq!(said.ids("unchanged"), ids("0001", &ALL, 2));
    assert_eq!(said.ids("skipped"), ids("0001", &ALL, 1));
    assert_eq!(snapshot(&workshop.path("passports")), after);
    // The folder of all stands, of which one has changed once more.
    certified_again(&workshop, "0001", "C-2027-0002");
    fs::rename(workshop.path("new/0001/stand.yaml"), workshop.path("stands/0001/stand.yaml")).unwrap();
    let said = workshop.run(&format!("reissue passports --stand stands --reason corrected {ANEW}"), 0);
    assert_eq!(said.ids("issued"), ids("0001", &ALL, 3));
    assert_eq!(said.ids("unchanged"), ids("0000", &ALL, 1));
    let text = fs::read_to_string(workshop.path("passports/SPS-2/0001/site-00002-3.yaml")).unwrap();
    assert!(text.contains("    id: \"SPS-2/0001/site-00002/2\"\n") && text.contains("C-2027-0002"), "{text}");
}

#[test]
fn without_files_all_is_issued_anew_once_for_a_reason() {
    let workshop = issued();
    let everything: BTreeSet<String> = ids("0000", &ALL, 2).into_iter().chain(ids("0001", &ALL, 2)).collect();
    let said = workshop.run(&format!("reissue passports --same-content --reason rotated {ANEW}"), 0);
    assert_eq!(said.ids("issued"), everything);
    let said = workshop.run(&format!("reissue passports --same-content --reason rotated {ANEW}"), 0);
    assert_eq!(said.ids("unchanged"), everything);
    let said = workshop.run(&format!("reissue passports/SPS-2/0000 --same-content --reason otherwise {ANEW}"), 0);
    assert_eq!(said.ids("issued"), ids("0000", &ALL, 3));
    assert_eq!(workshop.sound("passports").len(), 25);
}

#[test]
fn parts_of_a_folder_are_disjoint_and_complete() {
    let workshop = issued();
    let mut together = BTreeSet::new();
    for part in ["2/2", "1/2"] {
        let said = workshop.run(&format!("reissue passports --same-content --reason rotated --shard {part} {ANEW}"), 0);
        let issued = said.ids("issued");
        assert!(!issued.is_empty() && together.is_disjoint(&issued));
        together.extend(issued);
    }
    assert_eq!(together.len(), 10);
    assert_eq!(workshop.sound("passports").len(), 20);
}

#[test]
fn what_has_expired_is_issued_anew_with_the_factorys_files() {
    let workshop = Workshop::new(2, 5);
    for stand in ["0000", "0001"] {
        workshop.write(&format!("old/{stand}/stand.yaml"), &years_earlier(&workshop, stand, 10));
    }
    workshop.run(&format!("issue old --site sites {}", SIGN.replace("2026", "2016")), 0);
    workshop.write("new.yaml", &years_earlier(&workshop, "0000", 8));
    let later = ANEW.replace("2026-11-20", "2018-11-03");
    let said = workshop.run(&format!("reissue passports --stand new.yaml --reason recertified {later}"), 1);
    assert_eq!(said.ids("refused").len(), 5);
    assert!(said.words.contains("--sites"), "{}", said.words);
    fs::remove_file(workshop.path("sites/site-00003.yaml")).unwrap();
    let with_sites = format!("reissue passports --stand new.yaml --sites sites --reason recertified {later}");
    let said = workshop.run(&with_sites, 1);
    assert_eq!(said.ids("issued"), ids("0000", &[0, 1, 2, 4], 2));
    assert_eq!(said.ids("refused"), BTreeSet::from(["passports/SPS-2/0000/site-00003-1.yaml".to_owned()]));
}

#[test]
fn a_site_file_that_cannot_be_read_lets_nothing_be_issued_with_old_numbers() {
    let workshop = issued();
    let text = fs::read_to_string(workshop.path("sites/site-00002.yaml")).unwrap();
    workshop.write("sites/site-00002.yaml", &text.replace("height_m: 150.0", "height_m: 151.0"));
    workshop.write("sites/site-00003.yaml", "rubbish\n");
    let said = workshop.run(&format!("reissue passports --sites sites --reason surveyed {ANEW}"), 2);
    let corrected: BTreeSet<String> = ["0000", "0001"].iter().flat_map(|stand| ids(stand, &[2], 2)).collect();
    assert_eq!(said.ids("issued"), corrected);
    assert_eq!(said.ids("unchanged").len(), 6);
    assert_eq!(said.ids("refused").len(), 3);
    // The same with a stand: no passport is issued anew with the old one's numbers.
    workshop.write("bad.yaml", "rubbish\n");
    let named = "passports/SPS-2/0000/site-00001-1.yaml";
    let said = workshop.run(&format!("reissue {named} --stand bad.yaml --reason recertified {ANEW}"), 2);
    assert_eq!(said.ids("refused"), BTreeSet::from(["bad.yaml".to_owned(), named.to_owned()]));
    assert!(said.words.contains("no stand file is for SPS-2/0000"), "{}", said.words);
}

#[test]
fn withdrawn_passports_are_skipped_and_uncertain_lists_stop_the_folder() {
    let workshop = issued_for_long();
    let revoke = "revoke SPS-2/0000/site-00001/1 --list passports --reason wrong --key key --identity factory";
    workshop.run(&format!("{revoke} --trust allowed_signers"), 0);
    let said = workshop.run(&format!("reissue passports --same-content --reason rotated {NOW}"), 0);
    assert_eq!(said.ids("skipped"), ids("0000", &[1], 1));
    assert_eq!(said.ids("issued").len(), 9);
    // The first list is missing.
    let revoke = revoke.replace("site-00001", "site-00002");
    workshop.run(&format!("{revoke} --trust allowed_signers"), 0);
    fs::remove_file(workshop.path("passports/revocation-1.yaml")).unwrap();
    let before = snapshot(&workshop.path("passports"));
    let said = workshop.run(&format!("reissue passports --same-content --reason otherwise {NOW}"), 1);
    assert!(said.words.starts_with("dtg-passport: passports: the withdrawals are uncertain: "), "{}", said.words);
    assert_eq!(snapshot(&workshop.path("passports")), before);
}

#[test]
fn of_a_fork_neither_branch_goes_on_until_one_is_withdrawn() {
    let workshop = issued_for_long();
    let old = "passports/SPS-2/0000/site-00000-1.yaml";
    workshop.run(&format!("reissue {old} --same-content --reason other --out elsewhere {ANEW}"), 0);
    workshop.run(&format!("reissue {old} --same-content --reason one {ANEW}"), 0);
    // Where the first one is seen, a second successor is refused: another folder, another site.
    workshop.run(&format!("reissue {old} --same-content --reason more --out third {ANEW}"), 1);
    let said = workshop.run(&format!("reissue {old} --reason sold --site sites/site-00001.yaml --moved {ANEW}"), 1);
    assert!(said.words.contains("site-00000-2.yaml: already supersedes this passport"), "{}", said.words);
    workshop.run(
        &format!(
            "reissue elsewhere/SPS-2/0000/site-00000-2.yaml --same-content --reason another --out passports {ANEW}"
        ),
        0,
    );
    // Restored from a copy that had gone its own way: two passports supersede the first one.
    fs::create_dir_all(workshop.path("passports/restored/SPS-2/0000")).unwrap();
    let other = "SPS-2/0000/site-00000-2.yaml";
    fs::rename(workshop.path("elsewhere").join(other), workshop.path("passports/restored").join(other)).unwrap();
    let said = workshop.run(&format!("reissue passports --same-content --reason rotated {ANEW}"), 1);
    assert_eq!(said.ids("issued").len(), 9);
    let [one, another] = [2, 3].map(|revision| format!("passports/SPS-2/0000/site-00000-{revision}.yaml"));
    assert_eq!(said.ids("refused"), [one.clone(), another].into());
    assert!(said.words.contains("its predecessor has several successors"), "{}", said.words);
    let revoke = "--list passports --reason wrong --key key --identity factory --trust allowed_signers";
    let forked = || {
        let register = workshop.command("register passports --trust allowed_signers").output().unwrap();
        String::from_utf8(register.stdout).unwrap().contains("ALARM (forked): SPS-2/0000/site-00000/1 has 2 successors")
    };
    assert!(forked());
    workshop.run(&format!("revoke {one} {revoke}"), 0);
    assert!(!forked());
    let said = workshop.run(&format!("reissue passports --same-content --reason rotated {NOW}"), 0);
    assert_eq!(said.ids("issued"), ids("0000", &[0], 4));
}

#[test]
fn what_is_broken_or_misplaced_or_a_link_is_refused_and_the_rest_goes_on() {
    let workshop = issued();
    let (folder, other) = (workshop.path("passports/SPS-2/0000"), workshop.path("passports/SPS-2/0001"));
    let text = fs::read_to_string(folder.join("site-00000-1.yaml")).unwrap();
    fs::write(folder.join("site-00000-1.yaml"), text.replace("12.4", "12.6")).unwrap();
    fs::rename(folder.join("site-00001-1.yaml"), other.join("site-00009-1.yaml")).unwrap();
    fs::rename(folder.join("site-00002-1.yaml"), workshop.path("site-00002-1.yaml")).unwrap();
    std::os::unix::fs::symlink(workshop.path("site-00002-1.yaml"), folder.join("site-00002-1.yaml")).unwrap();
    fs::write(folder.join("site-00003-1.yaml"), vec![b'#'; 2 << 20]).unwrap();
    let said = workshop.run(&format!("reissue passports --same-content --reason rotated {ANEW}"), 1);
    // Of the stand whose passport is altered nothing is known: that one might supersede the others.
    let refused = ["0000/site-00000", "0000/site-00002", "0000/site-00003", "0000/site-00004", "0001/site-00009"];
    assert_eq!(said.ids("refused"), refused.map(|file| format!("passports/SPS-2/{file}-1.yaml")).into());
    for words in [
        "failed verification (signature",
        "the file of SPS-2/0000/site-00001/1 must be",
        "links are not followed",
        "more than 1048576",
    ] {
        assert!(said.words.contains(words), "{words}: {}", said.words);
    }
    assert_eq!(said.ids("issued"), ids("0001", &ALL, 2));
}

#[test]
fn several_that_move_to_one_site_follow_each_other_in_order() {
    let workshop = issued();
    workshop.write("hall.yaml", &crate::workshop::site("hall", 70_000));
    let said = workshop.run(&format!("reissue passports/SPS-2/0000 --site hall.yaml --reason moved --moved {ANEW}"), 0);
    let rows: Vec<&str> = said.results.lines().skip(1).map(|line| line.split(',').nth(1).unwrap()).collect();
    let due: Vec<String> = (1..=5).map(|revision| format!("SPS-2/0000/hall/{revision}")).collect();
    assert_eq!(rows, due);
    for revision in 1..=5 {
        let text = fs::read_to_string(workshop.path(&format!("passports/SPS-2/0000/hall-{revision}.yaml"))).unwrap();
        assert!(text.contains(&format!("    id: \"SPS-2/0000/site-{:05}/1\"\n", revision - 1)), "{revision}");
    }
    // Only the last is in force at the end: the same command again adds nothing.
    let before = snapshot(&workshop.path("passports"));
    let said = workshop.run(&format!("reissue passports/SPS-2/0000 --site hall.yaml --reason moved {ANEW}"), 0);
    let mut moved = ids("0000", &ALL, 1);
    moved.extend((1..5).map(|revision| format!("SPS-2/0000/hall/{revision}")));
    let last = BTreeSet::from(["SPS-2/0000/hall/5".to_owned()]);
    assert_eq!((said.ids("skipped"), said.ids("unchanged")), (moved, last));
    assert_eq!(snapshot(&workshop.path("passports")), before);
}

#[test]
fn passports_by_pattern_are_named_ones() {
    let workshop = issued();
    let said =
        workshop.run(&format!("reissue passports/SPS-2/*/site-00001-?.yaml --same-content --reason rotated {ANEW}"), 0);
    assert_eq!(said.ids("issued").len(), 2);
    let said = workshop.run(&format!("reissue passports/SPS-2/000[01] --same-content --reason rotated {ANEW}"), 0);
    assert_eq!((said.ids("issued").len(), said.ids("unchanged").len(), said.ids("skipped").len()), (8, 2, 2));
    let list = format!("ls passports/SPS-2/0001/*-2.yaml | \"$DTG\" reissue - --same-content --reason listed {ANEW}");
    let said = Said::of(workshop.shell(&list).output().unwrap(), 0);
    assert_eq!(said.ids("issued"), ids("0001", &ALL, 3));
}

#[test]
fn a_successor_is_written_into_the_root_that_its_predecessor_shows() {
    let workshop = Workshop::new(1, 2);
    for out in ["one", "two/deep"] {
        workshop.run(&format!("issue stands --site sites {SIGN} --out {out}"), 0);
    }
    let said =
        workshop.run(&format!("reissue one two/deep/SPS-2/0000/site-00001-1.yaml --same-content --reason x {ANEW}"), 0);
    assert_eq!((said.ids("issued").len(), said.results.lines().count()), (2, 4));
    assert_eq!(workshop.sound("one").len(), 4);
    assert_eq!(workshop.sound("two/deep").len(), 3);
    assert!(!workshop.path("passports").exists());
    // A path that shows no root: nothing is written anywhere until one is named.
    fs::rename(workshop.path("one/SPS-2/0000"), workshop.path("one/SPS-2/renamed")).unwrap();
    let before = snapshot(&workshop.path("one"));
    let moved = "reissue one/SPS-2/renamed/site-00000-2.yaml --same-content --reason y";
    let said = workshop.run(&format!("{moved} {ANEW}"), 2);
    assert!(said.words.contains("--out"), "{}", said.words);
    assert_eq!(snapshot(&workshop.path("one")), before);
    workshop.run(&format!("{moved} --out three {ANEW}"), 0);
    assert_eq!(workshop.sound("three"), ids("0000", &[0], 3));
}

/// A key that was stolen takes all that it signed with it: every passport is made anew from the factory's own files.
#[test]
fn after_a_theft_all_is_made_anew_from_the_factorys_files() {
    let workshop = issued();
    workshop.run("keygen new --identity factory --no-passphrase", 0);
    fs::copy(crate::programs::project("tests/keys/examples.pub"), workshop.path("stolen.pub")).unwrap();
    let signers = fs::read_to_string(workshop.path("allowed_signers")).unwrap();
    let new = fs::read_to_string(workshop.path("new.pub")).unwrap();
    workshop.write("allowed_signers", &format!("{signers}factory {new}"));
    let anew = format!("{} --revoked stolen.pub", ANEW.replace("--key key", "--key new"));
    // The register of a folder cannot follow the word of a revoked key: which passports are meant must be said.
    let said = workshop.run(&format!("reissue passports --stand stands --sites sites --reason stolen {anew}"), 0);
    assert_eq!((said.ids("skipped").len(), said.ids("issued").len()), (10, 0));
    let named = "reissue passports/*/*/*.yaml --stand stands --sites sites";
    let said = workshop.run(&format!("{named} --reason stolen {anew}"), 0);
    assert_eq!(said.ids("issued").len(), 10);
    let said = workshop.run(&format!("{named} --reason stolen {anew} --dry-run"), 0);
    assert_eq!(said.ids("unchanged").len(), 10);
}
