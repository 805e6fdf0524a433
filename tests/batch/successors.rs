//! Passports of a whole folder issued anew: those that a change concerns, and no others.

use crate::workshop::{SIGN, Said, Workshop};
use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::fs;

/// Weeks later.
const ANEW: &str = "--key key --identity factory --trust allowed_signers --issued-at 2026-11-20 --format csv";

/// Two stands at five sites, revision 1 of each.
fn issued() -> Workshop {
    let workshop = Workshop::new(2, 5);
    workshop.run(&format!("issue stands --site sites {SIGN}"), 0);
    workshop
}

/// A new certificate of a stand, in a folder of its own.
fn certified_again(workshop: &Workshop, stand: &str, number: &str) {
    let text = workshop.read(format!("stands/{stand}/stand.yaml"));
    let text = text.replace("C-2026-0142", number).replace("alpha_arcsec: 12.4", "alpha_arcsec: 12.9");
    workshop.write(format!("new/{stand}/stand.yaml"), &text);
}

fn ids(stand: &str, sites: &[u32], revision: u32) -> BTreeSet<String> {
    sites.iter().map(|site| format!("SPS-2/{stand}/site-{site:05}/{revision}")).collect()
}

const ALL: [u32; 5] = [0, 1, 2, 3, 4];

#[test]
fn a_new_certificate_re_issues_all_that_hangs_on_it_once() {
    let workshop = issued();
    certified_again(&workshop, "0001", "C-2027-0001");
    let before = workshop.snapshot("passports");
    let again = format!("reissue passports --stand new/0001/stand.yaml --reason recertified {ANEW}");
    let said = workshop.run(&format!("{again} --dry-run"), 0);
    assert_eq!(said.ids("planned"), ids("0001", &ALL, 2));
    assert_eq!(workshop.snapshot("passports"), before);
    let before = workshop.snapshot_of_passports("passports");
    let said = workshop.run(&again, 0);
    assert_eq!((said.ids("issued"), said.results.lines().count()), (ids("0001", &ALL, 2), 6));
    assert_eq!(workshop.sound("passports").len(), 15);
    assert!(before.is_subset(&workshop.snapshot_of_passports("passports")));
    let after = workshop.snapshot("passports");
    // Nothing hangs on the old certificate any more.
    let said = workshop.run(&again, 0);
    assert_eq!(said.ids("unchanged"), ids("0001", &ALL, 2));
    assert_eq!(said.ids("skipped"), ids("0001", &ALL, 1));
    assert_eq!(workshop.snapshot("passports"), after);
    // The folder of all stands, of which one has changed once more.
    certified_again(&workshop, "0001", "C-2027-0002");
    fs::rename(workshop.path("new/0001/stand.yaml"), workshop.path("stands/0001/stand.yaml")).unwrap();
    let said = workshop.run(&format!("reissue passports --stand stands --reason corrected {ANEW}"), 0);
    assert_eq!(said.ids("issued"), ids("0001", &ALL, 3));
    assert_eq!(said.ids("unchanged"), ids("0000", &ALL, 1));
    let text = workshop.read("passports/SPS-2/0001/site-00002-3.yaml");
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
fn a_site_file_that_cannot_be_read_lets_nothing_be_issued_with_old_numbers() {
    let workshop = issued();
    let text = workshop.read("sites/site-00002.yaml");
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
    said.says("no stand file is for SPS-2/0000");
}

/// `revoke`, but for the passports and the reason.
const REVOKE: &str = "--key key --identity factory --trust allowed_signers";

#[test]
fn withdrawn_passports_are_skipped_and_a_stand_without_a_good_register_is_left() {
    let workshop = issued();
    workshop.run(&format!("revoke SPS-2/0000/site-00001/1 --reason wrong {REVOKE}"), 0);
    let said = workshop.run(&format!("reissue passports --same-content --reason rotated {ANEW}"), 0);
    assert_eq!(said.ids("skipped"), ids("0000", &[1], 1));
    assert_eq!(said.ids("issued").len(), 9);
    // Missing or damaged, the register of one stand stops that stand, and no other.
    let register = workshop.path("passports/SPS-2/0000/register.yaml");
    let text = fs::read_to_string(&register).unwrap();
    for (revision, damaged, why) in [
        (3, None, "no register; make it with `register DIR --renew`, or restore it from the backup"),
        (4, Some(text.replace("wrong", "right")), "passports/SPS-2/0000/register.yaml: "),
    ] {
        match damaged {
            Some(damaged) => fs::write(&register, damaged).unwrap(),
            None => fs::remove_file(&register).unwrap(),
        }
        let before = workshop.snapshot("passports/SPS-2/0000");
        let said = workshop.run(&format!("reissue passports --same-content --reason again-{revision} {ANEW}"), 1);
        said.says(why);
        assert_eq!(
            (said.ids("refused"), said.ids("issued")),
            (["SPS-2/0000".to_owned()].into(), ids("0001", &ALL, revision))
        );
        assert_eq!(workshop.snapshot("passports/SPS-2/0000"), before);
    }
}

#[test]
fn a_passport_has_one_successor_and_a_copy_that_went_its_own_way_does_not_count() {
    let workshop = issued();
    let old = "passports/SPS-2/0000/site-00000-1.yaml";
    assert!(workshop.shell("cp -r passports elsewhere").status().unwrap().success());
    workshop.run(&format!("reissue {old} --same-content --reason one {ANEW}"), 0);
    workshop.run(&format!("reissue elsewhere/SPS-2/0000/site-00000-1.yaml --same-content --reason other {ANEW}"), 0);
    // A second successor is refused, at this site and for another one. In another folder, whose register does not know of
    // the first one, it is a warning.
    let other = format!("reissue {old} --reason more --same-content --out third {ANEW}");
    assert!(workshop.run(&other, 0).words.contains("WARNING: superseded by SPS-2/0000/site-00000/2"));
    for more in ["--same-content", "--site sites/site-00001.yaml --moved"] {
        let said = workshop.run(&format!("reissue {old} --reason more {more} {ANEW}"), 1);
        let there = ["SPS-2/0000/site-00000/2", "SPS-2/0000/site-00000-2.yaml"];
        assert!(there.iter().any(|there| said.words.contains(there)), "{more}: {}", said.words);
    }
    // Restored from the copy, the file is not the listed one, and the other passports go on.
    let file = "SPS-2/0000/site-00000-2.yaml";
    fs::copy(workshop.path("elsewhere").join(file), workshop.path("passports").join(file)).unwrap();
    let said = workshop.run(&format!("reissue passports --same-content --reason rotated {ANEW}"), 1);
    assert_eq!(said.ids("issued").len(), 9);
    assert_eq!(said.ids("refused"), BTreeSet::from([format!("passports/{file}")]));
    assert!(said.words.contains("is not the listed file; restore it from the backup"), "{}", said.words);
    workshop.run("register passports --trust allowed_signers", 1).says(&format!("ALARM (differs): passports/{file}: "));
    // The withdrawal is of the listed passport, whatever is in its place.
    let said = workshop.run(&format!("revoke SPS-2/0000/site-00000/2 --reason wrong {REVOKE}"), 0);
    assert!(
        said.words.contains("ALARM: ") && said.words.contains("is another file than the listed one"),
        "{}",
        said.words
    );
    let said = workshop.run(&format!("reissue passports --same-content --reason rotated {ANEW}"), 0);
    assert!(said.ids("skipped").contains("SPS-2/0000/site-00000/2"), "{}", said.results);
}

#[test]
fn what_is_broken_or_missing_or_in_another_place_is_refused_and_the_rest_goes_on() {
    let workshop = issued();
    let (folder, other) = (workshop.path("passports/SPS-2/0000"), workshop.path("passports/SPS-2/0001"));
    let text = fs::read_to_string(folder.join("site-00000-1.yaml")).unwrap();
    fs::write(folder.join("site-00000-1.yaml"), text.replace("12.4", "12.6")).unwrap();
    fs::rename(folder.join("site-00001-1.yaml"), other.join("site-00009-1.yaml")).unwrap();
    fs::write(folder.join("site-00003-1.yaml"), vec![b'#'; 2 << 20]).unwrap();
    let said = workshop.run(&format!("reissue passports --same-content --reason rotated {ANEW}"), 2);
    let refused = ["0000/site-00000", "0000/site-00001", "0000/site-00003"];
    assert_eq!(said.ids("refused"), refused.map(|file| format!("passports/SPS-2/{file}-1.yaml")).into());
    for words in
        ["site-00000-1.yaml: is not the listed file", "listed in the register, but missing", "more than 1048576"]
    {
        said.says(words);
    }
    let issued = ids("0000", &[2, 4], 2).into_iter().chain(ids("0001", &ALL, 2)).collect();
    assert_eq!(said.ids("issued"), issued);
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
        let text = workshop.read(format!("passports/SPS-2/0000/hall-{revision}.yaml"));
        assert!(text.contains(&format!("    id: \"SPS-2/0000/site-{:05}/1\"\n", revision - 1)), "{revision}");
    }
    // Only the last is in force at the end: the same command again adds nothing.
    let before = workshop.snapshot("passports");
    let said = workshop.run(&format!("reissue passports/SPS-2/0000 --site hall.yaml --reason moved {ANEW}"), 0);
    let mut moved = ids("0000", &ALL, 1);
    moved.extend((1..5).map(|revision| format!("SPS-2/0000/hall/{revision}")));
    let last = BTreeSet::from(["SPS-2/0000/hall/5".to_owned()]);
    assert_eq!((said.ids("skipped"), said.ids("unchanged")), (moved, last));
    assert_eq!(workshop.snapshot("passports"), before);
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
    let before = workshop.snapshot("one");
    let moved = "reissue one/SPS-2/renamed/site-00000-2.yaml --same-content --reason y";
    workshop.run(&format!("{moved} {ANEW}"), 2).says("--out");
    assert_eq!(workshop.snapshot("one"), before);
    workshop.run(&format!("{moved} --out three {ANEW}"), 0);
    assert_eq!(workshop.sound("three"), ids("0000", &[0], 3));
}

/// A key that was stolen takes all that it signed with it: every passport is made anew from the factory's own files.
#[test]
fn after_a_theft_all_is_made_anew_from_the_factorys_files() {
    let workshop = issued();
    workshop.run("keygen new --identity factory --no-passphrase", 0);
    fs::copy(crate::programs::project("tests/keys/examples.pub"), workshop.path("stolen.pub")).unwrap();
    let signers = workshop.read("allowed_signers");
    let new = workshop.read("new.pub");
    workshop.write("allowed_signers", &format!("{signers}factory {new}"));
    let anew = format!("{} --revoked stolen.pub", ANEW.replace("--key key", "--key new"));
    // A register under a revoked key does not count: a person takes over each.
    let again = format!("reissue passports --stand stands --sites sites --reason stolen {anew}");
    let said = workshop.run(&again, 1);
    assert!(said.words.contains("was revoked") && said.ids("issued").is_empty(), "{}", said.words);
    let renew = "register passports --renew --key new --identity factory --trust allowed_signers --revoked stolen.pub";
    let hashes = ["0000", "0001"].map(|stand| {
        let register = fs::read(workshop.path(format!("passports/SPS-2/{stand}/register.yaml"))).unwrap();
        format!("--adopt {:x}", Sha256::digest(&register))
    });
    workshop.run(renew, 1).says(&hashes[0]);
    workshop.run(&format!("{renew} {}", hashes.join(" ")), 0);
    let said = workshop.run(&again, 0);
    assert_eq!(said.ids("issued").len(), 10);
    let said = workshop.run(&format!("{again} --dry-run"), 0);
    assert_eq!(said.ids("unchanged").len(), 10);
    let verify = "verify passports/*/*/*-2.yaml --trust allowed_signers --revoked stolen.pub --register passports";
    workshop.run(verify, 0);
}
