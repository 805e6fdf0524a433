//! `recertify`: one step from readings to the passports of all places, or nothing at all.

use crate::place::{Place, example};
use crate::programs::{KEY, in_one_line, with_angles};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;

const HERE: &str = "passports/SPS-2/0017/here-1.yaml";
const SIGN: &str = "--key key --identity factory";
const TRUST: &str = "--trust allowed_signers --time 2026-11-21";
const ORDER: &str =
    "--number C-2026-0300 --issued 2026-11-20 --issued-at 2026-11-20T10:00:00Z --reason recertified --accept-change";

/// A factory's folder with a certified stand and its passports for two places.
fn factory() -> Place {
    let factory = Place::of(&[
        ("tests/cmd/files/allowed_signers", "allowed_signers"),
        ("tests/cmd/files/sites/here.yaml", "here.yaml"),
        ("tests/cmd/files/sites/there.yaml", "there.yaml"),
        (KEY, "key"),
        ("docs/angles.csv", "angles.csv"),
        ("docs/header.yaml", "header.yaml"),
    ]);
    factory.write("new.csv", new_readings());
    factory.good("certify angles.csv --stand header.yaml -o passports/SPS-2/0017/stand.yaml");
    let stand = "passports/SPS-2/0017/stand.yaml";
    factory.good(&format!("issue {stand} --site here.yaml --site there.yaml {SIGN} --issued-at 2026-11-03"));
    factory
}

/// Every file of the stand with its content.
fn passports(factory: &Place) -> BTreeMap<String, String> {
    let names = factory.names("passports/SPS-2/0017").into_iter().filter(|name| name != ".register.lock");
    names.map(|name| (name.clone(), factory.read(format!("passports/SPS-2/0017/{name}")))).collect()
}

/// A key of every passport of a result.
fn of_each<'a>(result: &'a Value, key: &str) -> Vec<&'a str> {
    result["passports"].as_array().unwrap().iter().map(|at| at[key].as_str().unwrap()).collect()
}

fn states(factory: &Place) -> Vec<String> {
    let register = factory.json(&format!("register passports {TRUST}"), 0);
    let line = |line: &Value| format!("{} {}", line["id"].as_str().unwrap(), line["state"].as_str().unwrap());
    register["stands"][0]["rows"].as_array().unwrap().iter().map(line).collect()
}

/// The readings of the guide, each slightly different, and γ of position (2, 3) changed by 6 arcsec.
fn new_readings() -> String {
    with_angles(&example("docs/angles.csv"), |line, row, column, angle| {
        let shift = if line.starts_with("2,3,") && column == 5 { 6.0 } else { 0.0 };
        angle + f64::from((row * 7 + column * 5) % 13) / 26.0 + shift
    })
}

#[test]
fn all_places_get_the_new_certificate() {
    let factory = factory();
    let before = passports(&factory);
    let recertify = format!("recertify {HERE} new.csv {ORDER} --identity factory {TRUST}");
    let planned = factory.json(&format!("{recertify} --dry-run"), 0);
    assert_eq!(passports(&factory), before, "a dry run writes nothing");
    assert_eq!((&planned["dry_run"], &planned["passports"][0]["state"]), (&Value::Bool(true), &"planned".into()));

    // Expected: the places under the old certificate, and nothing written, until the change is accepted.
    let careful = format!("{recertify} --key key").replace(" --accept-change", "");
    let (code, stdout, _) = factory.said(&format!("{careful} --format json --report record.html"));
    let refused: Value = serde_json::from_str(&stdout).unwrap();
    let sites = refused["in_question"].as_array().unwrap().iter().map(|at| at["site"].as_str().unwrap());
    assert_eq!((code, sites.collect::<Vec<_>>()), (1, vec!["here", "there"]), "{stdout}");
    let (code, stdout, _) = factory.said(&careful);
    assert!(code == 1 && stdout.starts_with("✕ CHANGED") && stdout.contains("ISO/IEC 17025, 7.10"), "{stdout}");
    assert!(
        passports(&factory) == before && !factory.path("record.html").exists(),
        "an unaccepted change writes nothing"
    );

    let found = factory.json(&format!("{recertify} --key key"), 0);
    assert_eq!(of_each(&found, "id"), ["SPS-2/0017/here/2", "SPS-2/0017/there/2"]);
    assert_eq!(
        states(&factory),
        [
            "SPS-2/0017/here/1 superseded",
            "SPS-2/0017/there/1 superseded",
            "SPS-2/0017/here/2 current",
            "SPS-2/0017/there/2 current"
        ]
    );
    let after = passports(&factory);
    let names: Vec<&str> = after.keys().map(String::as_str).collect();
    let expected = [
        "here-1.yaml",
        "here-2.yaml",
        "register.yaml",
        "stand-C-2026-0143.superseded.yaml",
        "stand.yaml",
        "there-1.yaml",
        "there-2.yaml",
    ];
    assert_eq!(names, expected);
    assert_eq!(after["stand-C-2026-0143.superseded.yaml"], before["stand.yaml"]);
    let replaced = ["stand.yaml", "register.yaml"];
    let kept = before.iter().filter(|(name, _)| !replaced.contains(&name.as_str()));
    kept.for_each(|(name, bytes)| assert_eq!(&after[name], bytes));

    // Expected: `certify` with a header that omits the results and the dates of the old measurement.
    let line = |line: &str| match line.trim_start().split(':').next() {
        Some("performed" | "valid_until" | "valid_until_basis" | "temperature_c") => String::new(),
        Some("number") => "  number: \"C-2026-0300\"\n".to_owned(),
        Some("issued") => "  issued: \"2026-11-20\"\n".to_owned(),
        _ => format!("{line}\n"),
    };
    factory.write("new-header.yaml", factory.read("header.yaml").lines().map(line).collect::<String>());
    factory.good("certify new.csv --stand new-header.yaml -o certified.yaml");
    // `certify` does not know when the previous certificate expires.
    let stand = &after["stand.yaml"];
    let (no_expiry, rest): (Vec<&str>, Vec<&str>) = stand
        .split_inclusive('\n')
        .partition(|line| line.contains("valid until 2028-11-01 (inclusive); this one has no"));
    assert_eq!(no_expiry.len(), 1, "{stand}");
    assert_eq!(rest.concat(), factory.read("certified.yaml"));

    // What has changed: γ of (2, 3), by 6 arcsec and the mean of the noise.
    let changes = found["changes"].as_array().unwrap();
    assert_eq!(changes.len(), 24);
    let ratio = |key: &str| changes.iter().find(|at| at["key"] == key).unwrap()["ratio"].as_f64().unwrap();
    assert!(ratio("positions[2,3].gamma_arcsec") > 3.0 && ratio("positions[1,1].alpha_arcsec").abs() < 1.0);
    assert_eq!(found["comparison"]["same_stand"], false);

    // Again: nothing to do; and half done by a kill between two files: completed.
    let again = factory.json(&format!("{recertify} --key key"), 0);
    assert!(of_each(&again, "state").iter().all(|state| *state == "unchanged"), "{again}");
    assert_eq!(passports(&factory), after);
    let put_back = |names: &[&str]| {
        names.iter().for_each(|name| factory.write(format!("passports/SPS-2/0017/{name}"), &before[*name]));
        let completed = factory.json(&format!("{recertify} --key key"), 0);
        of_each(&completed, "state").into_iter().map(str::to_owned).collect::<Vec<_>>()
    };
    // Before the stand file, after the register.
    assert_eq!(put_back(&["stand.yaml"]), ["unchanged", "unchanged"]);
    assert_eq!(passports(&factory), after, "the same files, byte by byte");
    // Before the register, which has another time now, and between two passports.
    fs::remove_file(factory.path("passports/SPS-2/0017/there-2.yaml")).unwrap();
    assert_eq!(put_back(&["stand.yaml", "register.yaml"]), ["unchanged", "issued"]);
    let mut completed = passports(&factory);
    assert!(completed.contains_key("register.yaml"));
    completed.insert("register.yaml".to_owned(), after["register.yaml"].clone());
    assert_eq!(completed, after, "the same files, byte by byte");
    assert_eq!(states(&factory).iter().filter(|state| state.ends_with("current")).count(), 2);
    // A listed passport that is gone is not made again by itself.
    fs::remove_file(factory.path("passports/SPS-2/0017/there-2.yaml")).unwrap();
    factory.ends(&format!("{recertify} --key key"), 2, "there-2.yaml: cannot be read");
}

#[test]
fn a_header_and_a_place_can_be_chosen() {
    let factory = factory();
    let order = format!("{ORDER} --valid-until 2028-11-19 --header header.yaml --site here");
    let stdout = factory.good(&format!("recertify {HERE} new.csv {order} {SIGN} {TRUST}"));
    assert!(stdout.contains("issued     SPS-2/0017/here/2") && !stdout.contains("there/2"), "{stdout}");
    let words = in_one_line(&stdout);
    assert!(words.contains("WARNING: in force under certificate C-2026-0143 still: SPS-2/0017/there/1"), "{stdout}");
    let stand = &passports(&factory)["stand.yaml"];
    assert!(stand.contains("valid_until: \"2028-11-19\"") && stand.contains("performed: \"2026-10-29\""), "{stand}");
    // The other place follows, with a corrected site.
    factory.change("there.yaml", "id: \"there\"", "id: \"there\"\nname: \"Hall 2\"");
    let order = order.replace("--site here", "--site there.yaml");
    factory.good(&format!("recertify passports/SPS-2/0017/there-1.yaml new.csv {order} {SIGN} {TRUST}"));
    let there = &passports(&factory)["there-2.yaml"];
    assert!(there.contains("name: \"Hall 2\"") && there.contains("C-2026-0300"));
    assert!(states(&factory).iter().filter(|line| line.ends_with("current")).all(|line| line.contains("/2 ")));
}

/// A stand that returns after its certificate has expired: the passports that expired with the given one get successors,
/// but not one that was withdrawn, nor one that was valid for a shorter time.
#[test]
fn an_expired_passport_is_recertified() {
    let factory = factory();
    for id in ["brief", "again"] {
        factory.write(format!("{id}.yaml"), factory.read("here.yaml").replace("\"here\"", &format!("\"{id}\"")));
    }
    let issue = format!("issue passports/SPS-2/0017/stand.yaml {SIGN} --issued-at 2026-11-03");
    factory.good(&format!("{issue} --site brief.yaml --valid-until 2026-12-31"));
    factory.good(&format!("{issue} --site again.yaml"));
    let revoke = "revoke SPS-2/0017/there/1 --reason pier --trust allowed_signers";
    factory.good(&format!("{revoke} {SIGN}"));
    let late = "--trust allowed_signers --time 2099-01-01";
    let recertify = format!("recertify {HERE} new.csv {ORDER} {SIGN} {late}");
    let found = factory.json(&recertify, 0);
    assert_eq!(of_each(&found, "id"), ["SPS-2/0017/here/2", "SPS-2/0017/again/2"]);
    assert_eq!(found["remaining"], Value::Array(vec![]));
    let shown = factory.json(&format!("show passports/SPS-2/0017/here-2.yaml {late}"), 0);
    let changed = shown["passport"]["reissued_from"]["changed"].as_str().unwrap();
    assert!(changed.contains("certificate number 'C-2026-0143' -> 'C-2026-0300'"), "{changed}");
    let again = factory.json(&recertify, 0);
    assert_eq!(of_each(&again, "state"), ["unchanged", "unchanged"]);
}

/// Expected: a withdrawal counts at every time, so nothing is issued as of a time before it: what is issued now would have a
/// predecessor that is withdrawn now.
#[test]
fn a_passport_that_was_withdrawn_later_gets_no_successor() {
    let factory = factory();
    let trust = "--trust allowed_signers";
    factory.good(&format!("revoke SPS-2/0017/here/1 --reason pier {trust} {SIGN}"));
    let before = passports(&factory);
    let at = "--time 2026-11-03T00:00:01Z --issued-at 2026-11-03T00:00:02Z";
    for order in [
        format!("recertify {HERE} new.csv --number C-3 --issued 2026-11-03"),
        format!("reissue {HERE} --site there.yaml --moved"),
    ] {
        let said = factory.refused(&format!("{order} --reason moved {SIGN} {trust} {at}"), "withdrawn");
        assert_eq!(passports(&factory), before, "{said}");
    }
}

/// Every refusal leaves all files as they were.
#[test]
fn a_refusal_writes_nothing() {
    let factory = factory();
    let text = factory.read("angles.csv");
    let one_run = text.lines().filter(|line| line.starts_with(['#', 'i']) || line.split(',').nth(2) == Some("1"));
    factory.write("one.csv", one_run.map(|line| format!("{line}\n")).collect::<String>());
    // The readings under other j.
    type Renamed = fn(i: &str, j: u32) -> u32;
    let renamed: [(&str, Renamed); 3] = [
        // The angles of every position are those of the next one: another stand.
        ("rotated.csv", |_, j| j % 4 + 1),
        // φ runs the wrong way, for all positions (half of them then agree) and for two.
        ("reversed.csv", |_, j| [1, 4, 3, 2][j as usize - 1]),
        ("exchanged.csv", |i, j| if i == "2" { [1, 4, 3, 2][j as usize - 1] } else { j }),
    ];
    for (name, renamed) in renamed {
        let line = |line: &str| match line.split(',').collect::<Vec<_>>()[..] {
            [i, j, ref rest @ ..] if rest.len() == 4 && i != "i" => {
                format!("{i},{},{}\n", renamed(i, j.parse().unwrap()), rest.join(","))
            }
            _ => format!("{line}\n"),
        };
        factory.write(name, text.lines().map(line).collect::<String>());
    }
    let here = factory.read(HERE);
    factory.write("other/SPS-2/0017/here-1.yaml", here.replacen("alpha_arcsec: ", "alpha_arcsec: 1", 1));
    factory.write("alone.yaml", here);
    let before = passports(&factory);
    let good = format!("{ORDER} {SIGN} {TRUST}");
    let number = |number: &str| good.replace("C-2026-0300", number);
    let cases: Vec<(String, i32, &str)> = vec![
        (
            format!("{HERE} new.csv {good} --site nowhere"),
            1,
            "no passport of the stand is in force for site nowhere; found here, there",
        ),
        (
            format!("{HERE} new.csv {}", number("C-2026-0143")),
            1,
            "certificate C-2026-0143 is the certificate of the passport",
        ),
        (format!("{HERE} one.csv {good}"), 1, "found one run, expected at least two"),
        (format!("{HERE} rotated.csv {good}"), 1, "check that these are the readings of this stand"),
        (format!("{HERE} reversed.csv {good}"), 1, "Positions (1, 2) and (1, 4) are exchanged"),
        (format!("{HERE} exchanged.csv {good}"), 1, "Positions (2, 2) and (2, 4) are exchanged"),
        (format!("{HERE} absent.csv {good}"), 2, "no such file"),
        (format!("{HERE} here.yaml {good}"), 2, "here.yaml"),
        (format!("other/SPS-2/0017/here-1.yaml new.csv {good}"), 1, "failed verification (signature"),
        (format!("alone.yaml new.csv {good}"), 1, "specify the folder of passports with --out"),
        (
            format!("{HERE} new.csv {}", good.replace("--identity factory", "--identity somebody")),
            1,
            "the signing key belongs to factory, not to this issuer",
        ),
        (format!("{HERE} new.csv {}", good.replace("--issued 2026-11-20", "--issued 2026-11-21")), 1, "certificate"),
        (format!("{HERE} new.csv {}", good.replace("--time 2026-11-21", "--time 2026-11-01")), 1, "in_force"),
        (format!("{HERE} new.csv {good} --serial 0018"), 1, "not 0018"),
    ];
    for (arguments, due, words) in cases {
        let (code, stdout, said) = factory.said(&format!("recertify {arguments}"));
        assert_eq!((code, stdout.as_str()), (due, ""), "{arguments}: {said}");
        assert!(said.contains(words), "{arguments}: {said}");
        assert_eq!(passports(&factory), before, "{arguments}");
    }
    // A file is in the way of the second passport: the first is not written either.
    fs::create_dir(factory.path("passports/SPS-2/0017/there-2.yaml")).unwrap();
    let (code, _, said) = factory.said(&format!("recertify {HERE} new.csv {good}"));
    assert!(code != 0 && !factory.path("passports/SPS-2/0017/here-2.yaml").exists(), "{said}");
    fs::remove_dir(factory.path("passports/SPS-2/0017/there-2.yaml")).unwrap();
    assert_eq!(passports(&factory), before);
}

/// A laboratory has only the passport: it checks its stand against that.
#[test]
fn a_passport_is_enough_for_a_check() {
    let factory = factory();
    let (code, stdout, said) = factory.said(&format!("certify new.csv --against {HERE} {TRUST}"));
    let of_passport = stdout.clone();
    assert_eq!(code, 1, "{said}");
    assert!(stdout.starts_with("✕ CHANGED") && stdout.contains("Position (2, 3) has changed"), "{stdout}");
    let (_, stdout, _) = factory.said("certify new.csv --against passports/SPS-2/0017/stand.yaml");
    assert_eq!(of_passport, stdout, "the passport and the stand file say the same");
    factory.write("altered.yaml", factory.read(HERE).replacen("gamma_arcsec: ", "gamma_arcsec: 1", 1));
    let (code, stdout, said) = factory.said(&format!("certify new.csv --against altered.yaml {TRUST}"));
    assert!(code == 1 && stdout.is_empty() && said.contains("FAILED     signature"), "{said}");
}

/// The record of the certification shows what has changed, and the exclusion is in the certificate.
#[test]
fn the_record_shows_the_change_and_the_exclusion() {
    let factory = factory();
    let before = passports(&factory);
    let recertify = format!("recertify {HERE} new.csv {ORDER} --identity factory {TRUST} --report record.html");
    factory.good(&format!("{recertify} --dry-run --exclude 2,3,4 --why lamp"));
    assert_eq!(passports(&factory), before, "a dry run writes the record alone");
    factory.refused(&format!("{recertify} --key key"), "record.html: already exists");
    factory.ends(&format!("{recertify} --key key").replace(".html", ".pdf"), 2, "no-browser-of-this-name");
    assert_eq!(passports(&factory), before);
    let found = factory.json(&format!("{recertify} --key key --force --exclude 2,3,4 --why lamp"), 0);
    let page = factory.read("record.html");
    // Expected: the number of the JSON, and one bar for each of the 24 deviations above the axis.
    let changes = found["changes"].as_array().unwrap();
    let gamma = changes.iter().find(|at| at["key"] == "positions[2,3].gamma_arcsec").unwrap();
    assert!(page.contains(&format!("{:.1}", gamma["difference"].as_f64().unwrap())));
    let section = page.split("id=\"change\"").nth(1).unwrap().split("</section>").next().unwrap();
    assert_eq!(section.matches("picture strip").count(), changes.len() + 1);
    assert!(page.contains("lamp"));
    // Expected: `certify` with the same exclusion, whose readings the certificate names.
    let stand = &passports(&factory)["stand.yaml"];
    assert!(stand.contains("{i: 2, j: 3, run: 4, why: \"lamp\"}"), "{stand}");
    factory.good(&format!("verify passports/SPS-2/0017/here-2.yaml {TRUST}"));
    for (arguments, words) in [
        ("--exclude 2,3,9 --why lamp", "found no reading of position (2, 3) in run 9 to exclude"),
        ("--exclude 2,3,4 --exclude 1,1,1 --exclude 1,1,2 --why a --why b", "found 2 --why for 3 --exclude"),
    ] {
        let dry_run = format!("recertify {HERE} new.csv {ORDER} --identity factory {TRUST} --dry-run {arguments}");
        factory.ends(&dry_run, 2, words);
    }
}

/// In a workspace the stand file is where `issue` finds it.
#[test]
fn in_a_workspace_the_stand_file_is_among_the_stands() {
    let factory = factory();
    let settings = "key = \"key\"\nidentity = \"factory\"\ntrust = \"allowed_signers\"\npassports = \"passports\"\n\
                    stands = \"stands\"\nsites = \".\"\n";
    factory.write("dtg-passport.toml", settings);
    fs::create_dir_all(factory.path("stands/SPS-2/0017")).unwrap();
    let stand = factory.path("stands/SPS-2/0017/stand.yaml");
    fs::rename(factory.path("passports/SPS-2/0017/stand.yaml"), &stand).unwrap();
    factory.good(&format!("recertify SPS-2/0017/here/1 new.csv {ORDER} --workspace . --time 2026-11-21"));
    assert!(fs::read_to_string(&stand).unwrap().contains("C-2026-0300"));
    assert!(factory.path("stands/SPS-2/0017/stand-C-2026-0143.superseded.yaml").exists());
    assert!(!factory.path("passports/SPS-2/0017/stand.yaml").exists());
    assert!(factory.path("passports/SPS-2/0017/there-2.yaml").exists());
}
