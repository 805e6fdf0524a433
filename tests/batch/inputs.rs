//! What a batch is given: folders, patterns, lists, parts of a job; and what is bad among it.

use crate::workshop::{SIGN, Said, Workshop, site};
use std::collections::BTreeSet;
use std::fs;
use std::io::Write;
use std::os::unix::fs::symlink;
use std::process::Stdio;

#[test]
fn of_ten_thousand_sites_one_bad_latitude_costs_one_passport() {
    let workshop = Workshop::new(1, 10_000);
    workshop
        .write("sites/site-04321.yaml", &site("site-04321", 0).replace("latitude_deg: 1.0000", "latitude_deg: 91.5"));
    let said = workshop.run(&format!("issue stands --site sites {SIGN} --no-sync"), 2);
    assert_eq!(said.results, "✕ issued 9,999, unchanged 0, refused 1 (inputs that cannot be used: 1)\n");
    let words: Vec<&str> = said.words.lines().collect();
    assert!(words[0].starts_with("dtg-passport: sites/site-04321.yaml:3:15: latitude_deg: found 91.5"), "{words:?}");
    let ids = workshop.sound("passports");
    assert_eq!(ids.len(), 9_999);
    assert!(!ids.contains("SPS-2/0000/site-04321/1"));
    // Corrected and run again, it issues the one that is missing and touches nothing else.
    let before = workshop.snapshot_of_passports("passports");
    workshop.write("sites/site-04321.yaml", &site("site-04321", 4321));
    let said = workshop.run(&format!("issue stands --site sites/site-04*.yaml {SIGN} --no-sync"), 0);
    assert_eq!(said.results, "● issued 1, unchanged 999, refused 0\n");
    let after = workshop.snapshot_of_passports("passports");
    let new: Vec<_> = after.difference(&before).collect();
    assert!(new.len() == 1 && new[0].0.ends_with("SPS-2/0000/site-04321-1.yaml") && before.is_subset(&after));
}

#[test]
fn every_stand_is_issued_for_every_site_in_order_and_as_one_at_a_time() {
    let workshop = Workshop::new(7, 30);
    let said = workshop.run(&format!("issue stands --site sites {SIGN} --format csv"), 0);
    let ids: Vec<&str> = said.results.lines().skip(1).map(|line| line.split(',').nth(1).unwrap()).collect();
    let due: Vec<String> =
        (0..7).flat_map(|stand| (0..30).map(move |site| format!("SPS-2/{stand:04}/site-{site:05}/1"))).collect();
    assert_eq!(ids, due);
    assert_eq!(workshop.sound("passports").len(), 210);
    // The bytes are those of a run for this pair alone, on one thread.
    let one = "issue stands/0003/stand.yaml --site sites/site-00011.yaml --out one --threads 1";
    workshop.run(&format!("{one} {SIGN}"), 0);
    let file = "SPS-2/0003/site-00011-1.yaml";
    assert_eq!(
        fs::read(workshop.path("one").join(file)).unwrap(),
        fs::read(workshop.path("passports").join(file)).unwrap()
    );
}

#[test]
fn of_two_sites_with_one_id_neither_counts_unless_they_are_the_same() {
    let workshop = Workshop::new(2, 3);
    workshop.write("sites/other.yaml", &site("site-00001", 999));
    let said = workshop.run(&format!("issue stands --site sites {SIGN} --format csv"), 1);
    let why = "sites/other.yaml: has the id site-00001, like sites/site-00001.yaml, but different content; keep one file (passports not issued: 2)";
    said.says(why);
    assert_eq!(said.ids("issued").len(), 4);
    assert!(workshop.sound("passports").iter().all(|id| !id.contains("site-00001")));
    // The same bytes twice are one site.
    workshop.write("sites/other.yaml", &site("site-00001", 1));
    let said = workshop.run(&format!("issue stands --site sites {SIGN} --format csv"), 0);
    said.says("sites/site-00001.yaml: duplicate of site site-00001, used once");
    assert_eq!(workshop.sound("passports").len(), 6);
    // A site copied two hundred times without a new id is named by its first files.
    for number in 0..200 {
        workshop.write(format!("sites/copy-{number:03}.yaml"), &site("site-00002", 1000 + number));
    }
    let said = workshop.run(&format!("issue stands --site sites {SIGN} --format csv"), 1);
    let others = "copy-001.yaml, sites/copy-002.yaml, sites/copy-003.yaml, sites/copy-004.yaml, sites/copy-005.yaml";
    let why = format!("sites/copy-000.yaml: has the id site-00002, like sites/{others} and 195 more, but different");
    said.says(&why);
}

#[test]
fn links_lead_nowhere_and_nothing_is_written_through_them() {
    let workshop = Workshop::new(1, 1);
    let outside = tempfile::tempdir().unwrap();
    fs::copy(workshop.path("stand.yaml"), outside.path().join("stand.yaml")).unwrap();
    symlink(outside.path(), workshop.path("stands/linked")).unwrap();
    symlink("/etc/hostname", workshop.path("sites/linked.yaml")).unwrap();
    let said = workshop.run(&format!("issue stands --site sites {SIGN} --format csv"), 1);
    assert_eq!(said.ids("refused"), ["sites/linked.yaml", "stands/linked"].map(str::to_owned).into());
    assert_eq!(workshop.sound("passports").len(), 1);
    // A stand's folder among the passports that leads elsewhere, and a passport that does.
    fs::create_dir_all(workshop.path("out/SPS-2")).unwrap();
    symlink(outside.path(), workshop.path("out/SPS-2/0000")).unwrap();
    let said = workshop.run(&format!("issue stands/0000 --site sites/site-00000.yaml {SIGN} --out out"), 1);
    assert!(said.words.contains("out/SPS-2/0000: is a link; specify its target with --out"), "{}", said.words);
    assert_eq!(fs::read_dir(outside.path()).unwrap().count(), 1);
    fs::remove_file(workshop.path("out/SPS-2/0000")).unwrap();
    fs::create_dir(workshop.path("out/SPS-2/0000")).unwrap();
    symlink(workshop.path("nowhere"), workshop.path("out/SPS-2/0000/site-00000-1.yaml")).unwrap();
    let said = workshop.run(&format!("issue stands/0000 --site sites/site-00000.yaml {SIGN} --out out"), 1);
    said.says("site-00000-1.yaml: is a link");
}

#[test]
fn a_passport_in_the_wrong_place_for_its_id_is_not_taken_for_the_right_one() {
    let workshop = Workshop::new(2, 2);
    workshop.run(&format!("issue stands/0000 --site sites {SIGN}"), 0);
    fs::create_dir(workshop.path("passports/SPS-2/0001")).unwrap();
    let file = |stand: &str| workshop.path(format!("passports/SPS-2/{stand}/site-00001-1.yaml"));
    fs::copy(file("0000"), file("0001")).unwrap();
    let said = workshop.run(&format!("issue stands --site sites {SIGN} --format csv"), 1);
    assert_eq!((said.ids("unchanged").len(), said.ids("issued").len()), (2, 1));
    assert_eq!(said.ids("refused"), BTreeSet::from(["SPS-2/0001/site-00001/1".to_owned()]));
    said.says("already exists with different content (stand serial '0000' -> '0001')");
    assert_eq!(fs::read(file("0000")).unwrap(), fs::read(file("0001")).unwrap());
}

#[test]
fn a_name_in_another_unicode_form_is_refused_with_its_place() {
    let workshop = Workshop::new(1, 1);
    let text = site("koeln", 1).replace("id: \"koeln\"\n", "id: \"koeln\"\nname: \"Ko\u{308}ln\"\n");
    workshop.write("sites/koeln.yaml", &text);
    // The file's own name may be in any form.
    workshop.write("sites/Mu\u{308}nchen.yaml", &site("muenchen", 2));
    let said = workshop.run(&format!("issue stands --site sites {SIGN} --format csv"), 2);
    said.says("sites/koeln.yaml:3:7: name: found character U+0308");
    let issued = ["SPS-2/0000/muenchen/1", "SPS-2/0000/site-00000/1"].map(str::to_owned);
    assert_eq!(said.ids("issued"), issued.into());
}

#[test]
fn patterns_folders_and_lists_name_the_same() {
    let workshop = Workshop::new(3, 4);
    let ids = |arguments: &str, list: &[u8]| {
        let mut command = workshop.command(&format!("issue {arguments} {SIGN} --dry-run --format csv"));
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        child.stdin.take().unwrap().write_all(list).unwrap();
        Said::of(child.wait_with_output().unwrap(), 0).ids("planned")
    };
    let all = ids("stands --site sites", b"");
    assert_eq!(all.len(), 12);
    assert_eq!(ids("stands/*/stand.yaml --site sites/*.yaml", b""), all);
    assert_eq!(ids("stands/000[0-2] --site sites/site-0000?.yaml", b""), all);
    assert_eq!(ids("- --site sites", b"stands/0000/stand.yaml\nstands/0001/stand.yaml\nstands/0002/stand.yaml\n"), all);
    assert_eq!(ids("- --site sites", b"stands/0000/stand.yaml\0stands/0001\0stands/0002/stand.yaml"), all);
    let sites: String = (0..4).map(|site| format!("sites/site-{site:05}.yaml\n")).collect();
    assert_eq!(ids("stands --site -", sites.as_bytes()), all);
    // A file whose name looks like a pattern is that file.
    fs::rename(workshop.path("stands/0001"), workshop.path("stands/[0]*")).unwrap();
    assert_eq!(ids("stands/[0]*/stand.yaml --site sites", b"").len(), 4);

    let said = workshop.run(&format!("issue stands/x* --site sites {SIGN}"), 2);
    assert_eq!(said.words, "dtg-passport: stands/x*: no file matches this pattern\n");
    let said = workshop.run(&format!("issue - --site - {SIGN}"), 2);
    assert_eq!(said.words, "dtg-passport: standard input can supply only one list, that of stands or that of sites\n");
}

#[test]
fn a_dry_run_says_all_and_writes_nothing() {
    let workshop = Workshop::new(2, 5);
    workshop.run(&format!("issue stands/0000 --site sites {SIGN}"), 0);
    let text = workshop.read("sites/site-00002.yaml");
    workshop.write("sites/site-00002.yaml", &text.replace("height_m: 150.0", "height_m: 151.0"));
    let before = workshop.snapshot(".");
    let said =
        workshop.run("issue stands --site sites --identity factory --trust allowed_signers --dry-run --format csv", 1);
    assert_eq!((said.ids("unchanged").len(), said.ids("planned").len()), (4, 5));
    assert_eq!(said.ids("refused"), BTreeSet::from(["SPS-2/0000/site-00002/1".to_owned()]));
    said.says("already exists with different content (site height_m 150.0 -> 151.0)");
    assert_eq!(workshop.snapshot("."), before);
    // A key that is given must be usable.
    let said = workshop.run("issue stands --site sites --identity factory --key no/such/key --dry-run --out new", 2);
    said.says("no/such/key: cannot be read: no such file or folder");
    let said = workshop.run(&format!("issue stands --site sites {SIGN} --dry-run --out new"), 0);
    assert_eq!(said.results.matches("planned    SPS-2/").count(), 10);
    assert!(!workshop.path("new").exists());
}

#[test]
fn progress_is_shown_on_a_terminal_and_nowhere_else() {
    let workshop = Workshop::new(5, 60);
    let issue = format!("issue stands --site sites {SIGN} --no-sync");
    let said = workshop.run(&issue, 0);
    assert_eq!(said.words, "");
    // `script` gives the program a terminal, and prints what would be seen on it.
    fs::remove_dir_all(workshop.path("passports")).unwrap();
    let command = workshop.shell(&format!("script -qec \"$DTG {issue}\" /dev/null")).env("TERM", "xterm").output();
    let seen = Said::of(command.unwrap(), 0).results;
    assert!(seen.contains(" of 300, "), "{seen:?}");
    assert!(seen.contains("left") && seen.contains("issued 300, unchanged 0, refused 0"), "{seen:?}");
    // Nothing is to be done, so there is no bar.
    let issue = issue.replace("--site sites", "--site nowhere");
    let command = workshop.shell(&format!("script -qec \"$DTG {issue}\" /dev/null")).env("TERM", "xterm").output();
    let seen = Said::of(command.unwrap(), 2).results;
    assert!(seen.contains("nowhere: cannot be read") && !seen.contains(" of 0"), "{seen:?}");
}

#[test]
fn a_pipe_or_a_device_is_refused_at_once_wherever_a_file_is_named() {
    let workshop = Workshop::new(1, 1);
    workshop.run(&format!("issue stands --site sites {SIGN}"), 0);
    fs::rename(workshop.path("passports/SPS-2/0000/site-00000-1.yaml"), workshop.path("good.yaml")).unwrap();
    workshop.write("currents.csv", include_str!("../cmd/files/currents.csv"));
    let header = "format: \"dtg-stand/1\"\nstand: {model: \"SPS-2\", serial: \"0000\"}\n\
                  certificate: {number: \"1\", issued: \"2026-01-01\", laboratory: \"x\"}\n\
                  positions:\n  - {i: 1, j: 1, theta_deg: 0, phi_deg: 0}\n";
    workshop.write("header.yaml", header);
    assert!(workshop.shell("mkfifo pipe").status().unwrap().success());
    let trust = "--trust allowed_signers --time 2026-12-01";
    let sign = "--key key --identity factory --reason why";
    let named = [
        format!("verify FILE {trust}"),
        "verify good.yaml --trust FILE".to_owned(),
        format!("verify good.yaml {trust} --revoked FILE"),
        format!("show FILE {trust}"),
        "show FILE --no-verify".to_owned(),
        format!("render FILE -o page.html {trust}"),
        format!("calibrate FILE currents.csv {trust}"),
        format!("calibrate good.yaml FILE {trust}"),
        format!("calibrate good.yaml currents.csv {trust} --gyro FILE"),
        format!("calibrate good.yaml currents.csv {trust} --laboratory FILE"),
        format!("calibrate good.yaml currents.csv {trust} --previous FILE"),
        "certify FILE --stand header.yaml -o new.yaml".to_owned(),
        "certify currents.csv --stand FILE -o new.yaml".to_owned(),
        format!("issue FILE --site sites {SIGN} --out out"),
        format!("issue stands --site FILE {SIGN} --out out"),
        "issue stands --site sites --key FILE --identity factory --out out".to_owned(),
        format!("reissue FILE {sign} {trust} --out out"),
        format!("reissue good.yaml {sign} {trust} --out out --stand FILE"),
        format!("reissue good.yaml {sign} {trust} --out out --site FILE"),
        format!("issue stands --site sites {SIGN} --register-key FILE --out out"),
        "simulate accuracy --trials 1 --stand FILE --site sites/site-00000.yaml".to_owned(),
    ];
    for arguments in named {
        for file in ["pipe", "/dev/zero", "sites"] {
            // These take the files of a folder.
            let take_folders = [
                "issue FILE",
                "issue stands --site FILE",
                "reissue",
                "show FILE",
                "render FILE",
                "calibrate good.yaml FILE",
                "certify FILE",
            ];
            let of_a_folder = take_folders.iter().any(|verb| arguments.starts_with(verb));
            if file == "sites" && of_a_folder {
                continue;
            }
            let arguments = arguments.replace("FILE", file);
            let mut child = workshop.command(&arguments).stderr(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
            // Without a writer a pipe keeps its reader for ever.
            let deadline = std::time::Instant::now() + std::time::Duration::from_secs(60);
            while child.try_wait().unwrap().is_none() {
                if std::time::Instant::now() > deadline {
                    child.kill().unwrap();
                    panic!("{arguments}: waits for ever");
                }
                std::thread::sleep(std::time::Duration::from_millis(2));
            }
            let said = Said::of(child.wait_with_output().unwrap(), 2);
            let expected =
                if file == "sites" { "found a folder" } else { "found a pipe, a device or a socket, expected a file" };
            assert!(said.words.contains(expected), "{arguments}: {}", said.words);
        }
    }
    assert!(!workshop.path("out").exists());
}

#[test]
fn names_that_differ_only_in_case_do_not_stand_side_by_side() {
    let workshop = Workshop::new(2, 2);
    let stand = |model: &str, serial: &str| {
        let text = include_str!("../cmd/files/stand.yaml");
        text.replace("\"SPS-2\"", &format!("\"{model}\"")).replace("\"0017\"", &format!("\"{serial}\""))
    };
    workshop.write("stands/0003/stand.yaml", &stand("SPS-2", "a1"));
    workshop.write("stands/0004/stand.yaml", &stand("SPS-2", "A1"));
    workshop.write("stands/0005/stand.yaml", &stand("sps-2", "0005"));
    workshop.write("sites/twice.yaml", &site("SITE-00001", 7));
    // In a batch the first of the two counts.
    let said = workshop.run(&format!("issue stands --site sites {SIGN} --format csv"), 1);
    for words in [
        "stands/0004/stand.yaml: stand SPS-2/A1: found SPS-2/A1, but SPS-2/a1 in stands/0003/stand.yaml",
        "stands/0005/stand.yaml: stand sps-2/0005: found sps-2, but SPS-2 in stands/0000/stand.yaml",
        "sites/twice.yaml: site SITE-00001: found SITE-00001, but site-00001 in sites/site-00001.yaml",
    ] {
        said.says(words);
    }
    assert_eq!(workshop.sound("passports").len(), 3 * 2);
    // And beside what is there already, nothing is written.
    let before = workshop.snapshot("passports");
    for (arguments, words) in [
        ("stands/0004/stand.yaml --site sites/site-00000.yaml", "passports/SPS-2/A1: found passports/SPS-2/a1"),
        ("stands/0005/stand.yaml --site sites/site-00000.yaml", "passports/sps-2: found passports/SPS-2"),
        (
            "stands/0003/stand.yaml --site sites/twice.yaml",
            "passports/SPS-2/a1/SITE-00001-1.yaml: found passports/SPS-2/a1/site-00001",
        ),
    ] {
        workshop.run(&format!("issue {arguments} {SIGN}"), 1).says(words);
    }
    assert_eq!(workshop.snapshot("passports"), before);
}
