//! `recertify`: one step from readings to the passports of all places, or nothing at all.

use crate::deliver::Place;
use crate::programs;
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
        ("tests/keys/examples", "key"),
        ("docs/angles.csv", "angles.csv"),
        ("docs/header.yaml", "header.yaml"),
    ]);
    fs::write(factory.path("new.csv"), new_readings(6.0)).unwrap();
    factory.good("certify angles.csv --stand header.yaml -o passports/SPS-2/0017/stand.yaml");
    let stand = "passports/SPS-2/0017/stand.yaml";
    factory.good(&format!("issue {stand} --site here.yaml --site there.yaml {SIGN} --issued-at 2026-11-03"));
    factory
}

/// Every file under `passports` with its content.
fn passports(factory: &Place) -> BTreeMap<String, Vec<u8>> {
    let files = fs::read_dir(factory.path("passports/SPS-2/0017")).unwrap().map(|entry| entry.unwrap().path());
    let named = files.map(|path| (path.file_name().unwrap().to_str().unwrap().to_owned(), fs::read(path).unwrap()));
    named.filter(|(name, _)| name != ".register.lock").collect()
}

fn states(factory: &Place) -> Vec<String> {
    let register = factory.json(&format!("register passports {TRUST}"), 0);
    let line = |line: &Value| format!("{} {}", line["id"].as_str().unwrap(), line["state"].as_str().unwrap());
    register["stands"][0]["rows"].as_array().unwrap().iter().map(line).collect()
}

/// The readings of the guide, each slightly different, and γ of position (2, 3) changed by `shift_arcsec`.
fn new_readings(shift_arcsec: f64) -> String {
    let text = fs::read_to_string(programs::project("docs/angles.csv")).unwrap();
    let lines = text.lines().enumerate().map(|(number, line)| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if cells.len() == 6 && cells[0] != "i" {
            for (column, cell) in cells.iter_mut().enumerate().skip(3) {
                let shift = if line.starts_with("2,3,") && column == 5 { shift_arcsec } else { 0.0 };
                let noise = ((number * 7 + column * 5) % 13) as f64 / 26.0;
                *cell = format!("{:.3}", cell.parse::<f64>().unwrap() + noise + shift);
            }
        }
        cells.join(",") + "\n"
    });
    lines.collect()
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
    let ids: Vec<&str> = found["passports"].as_array().unwrap().iter().map(|at| at["id"].as_str().unwrap()).collect();
    assert_eq!(ids, ["SPS-2/0017/here/2", "SPS-2/0017/there/2"]);
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
    let header = fs::read_to_string(factory.path("header.yaml")).unwrap();
    let dropped = ["performed", "valid_until", "temperature_c"];
    let header: String = header
        .lines()
        .filter(|line| !dropped.iter().any(|key| line.trim_start().starts_with(key)))
        .map(|line| match line.trim_start().split(':').next() {
            Some("number") => "  number: \"C-2026-0300\"\n".to_owned(),
            Some("issued") => "  issued: \"2026-11-20\"\n".to_owned(),
            _ => format!("{line}\n"),
        })
        .collect();
    fs::write(factory.path("new-header.yaml"), header).unwrap();
    factory.good("certify new.csv --stand new-header.yaml -o certified.yaml");
    // `certify` does not know when the previous certificate expires.
    let stand = String::from_utf8(after["stand.yaml"].clone()).unwrap();
    let (no_expiry, rest): (Vec<&str>, Vec<&str>) = stand
        .split_inclusive('\n')
        .partition(|line| line.contains("valid until 2028-11-01 (inclusive); this one has no"));
    assert_eq!(no_expiry.len(), 1, "{stand}");
    assert_eq!(rest.concat(), fs::read_to_string(factory.path("certified.yaml")).unwrap());

    // What has changed: γ of (2, 3), by 6 arcsec and the mean of the noise.
    let changes = found["changes"].as_array().unwrap();
    assert_eq!(changes.len(), 24);
    let ratio = |key: &str| changes.iter().find(|at| at["key"] == key).unwrap()["ratio"].as_f64().unwrap();
    assert!(ratio("positions[2,3].gamma_arcsec") > 3.0 && ratio("positions[1,1].alpha_arcsec").abs() < 1.0);
    assert_eq!(found["comparison"]["same_stand"], false);

    // Again: nothing to do; and half done by a kill between two files: completed.
    let again = factory.json(&format!("{recertify} --key key"), 0);
    assert!(again["passports"].as_array().unwrap().iter().all(|at| at["state"] == "unchanged"), "{again}");
    assert_eq!(passports(&factory), after);
    let put_back = |names: &[&str]| {
        let folder = factory.path("passports/SPS-2/0017");
        names.iter().for_each(|name| fs::write(folder.join(name), &before[*name]).unwrap());
        let completed = factory.json(&format!("{recertify} --key key"), 0);
        let states = completed["passports"].as_array().unwrap().iter();
        states.map(|at| at["state"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
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
    let (code, _, said) = factory.said(&format!("{recertify} --key key"));
    assert!(code == 2 && said.contains("there-2.yaml: cannot be read"), "{code}: {said}");
}

#[test]
fn a_header_and_a_place_can_be_chosen() {
    let factory = factory();
    let order = format!("{ORDER} --valid-until 2028-11-19 --header header.yaml --site here");
    let (code, stdout, said) = factory.said(&format!("recertify {HERE} new.csv {order} {SIGN} {TRUST}"));
    assert_eq!(code, 0, "{said}");
    assert!(stdout.contains("issued     SPS-2/0017/here/2") && !stdout.contains("there/2"), "{stdout}");
    let words = stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("WARNING: in force under certificate C-2026-0143 still: SPS-2/0017/there/1"), "{stdout}");
    let stand = String::from_utf8(passports(&factory)["stand.yaml"].clone()).unwrap();
    assert!(stand.contains("valid_until: \"2028-11-19\"") && stand.contains("performed: \"2026-10-29\""), "{stand}");
    // The other place follows, with a corrected site.
    let site = fs::read_to_string(factory.path("there.yaml"))
        .unwrap()
        .replace("id: \"there\"", "id: \"there\"\nname: \"Hall 2\"");
    fs::write(factory.path("there.yaml"), site).unwrap();
    let order = order.replace("--site here", "--site there.yaml");
    factory.good(&format!("recertify passports/SPS-2/0017/there-1.yaml new.csv {order} {SIGN} {TRUST}"));
    let there = String::from_utf8(passports(&factory)["there-2.yaml"].clone()).unwrap();
    assert!(there.contains("name: \"Hall 2\"") && there.contains("C-2026-0300"));
    assert!(states(&factory).iter().filter(|line| line.ends_with("current")).all(|line| line.contains("/2 ")));
}

/// A stand that returns after its certificate has expired: the passports that expired with the given one get successors,
/// but not one that was withdrawn, nor one that was valid for a shorter time.
#[test]
fn an_expired_passport_is_recertified() {
    let factory = factory();
    let here = fs::read_to_string(factory.path("here.yaml")).unwrap();
    fs::write(factory.path("brief.yaml"), here.replace("id: \"here\"", "id: \"brief\"")).unwrap();
    fs::write(factory.path("again.yaml"), here.replace("id: \"here\"", "id: \"again\"")).unwrap();
    let issue = format!("issue passports/SPS-2/0017/stand.yaml {SIGN} --issued-at 2026-11-03");
    factory.good(&format!("{issue} --site brief.yaml --valid-until 2026-12-31"));
    factory.good(&format!("{issue} --site again.yaml"));
    let revoke = "revoke SPS-2/0017/there/1 --reason pier --trust allowed_signers";
    factory.good(&format!("{revoke} {SIGN}"));
    let late = "--trust allowed_signers --time 2099-01-01";
    let recertify = format!("recertify {HERE} new.csv {ORDER} {SIGN} {late}");
    let found = factory.json(&recertify, 0);
    let ids: Vec<&str> = found["passports"].as_array().unwrap().iter().map(|at| at["id"].as_str().unwrap()).collect();
    assert_eq!((ids, &found["remaining"]), (vec!["SPS-2/0017/here/2", "SPS-2/0017/again/2"], &Value::Array(vec![])));
    let shown = factory.json(&format!("show passports/SPS-2/0017/here-2.yaml {late}"), 0);
    let changed = shown["passport"]["reissued_from"]["changed"].as_str().unwrap();
    assert!(changed.contains("certificate number 'C-2026-0143' -> 'C-2026-0300'"), "{changed}");
    let again = factory.json(&recertify, 0);
    assert_eq!(again["passports"].as_array().unwrap().len(), 2);
    assert!(again["passports"].as_array().unwrap().iter().all(|at| at["state"] == "unchanged"), "{again}");
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
        let (code, _, said) = factory.said(&format!("{order} --reason moved {SIGN} {trust} {at}"));
        assert_eq!((code, passports(&factory)), (1, before.clone()), "{said}");
        // The message may be wrapped.
        let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(said.contains("withdrawn"), "{said}");
    }
}

/// Every refusal leaves all files as they were.
#[test]
fn a_refusal_writes_nothing() {
    let factory = factory();
    let text = fs::read_to_string(factory.path("angles.csv")).unwrap();
    let one_run: String = text
        .lines()
        .filter(|line| line.starts_with(['#', 'i']) || line.split(',').nth(2) == Some("1"))
        .map(|line| format!("{line}\n"))
        .collect();
    fs::write(factory.path("one.csv"), one_run).unwrap();
    // The angles of every position are those of the next one: another stand.
    let rotated: String = text
        .lines()
        .map(|line| {
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            if cells.len() == 6 && cells[0] != "i" {
                let j: u32 = cells[1].parse().unwrap();
                cells[1] = (j % 4 + 1).to_string();
            }
            cells.join(",") + "\n"
        })
        .collect();
    fs::write(factory.path("rotated.csv"), rotated).unwrap();
    // φ runs the wrong way, for all positions (half of them then agree) and for two.
    for (name, frames) in [("reversed.csv", ["1", "2"].as_slice()), ("exchanged.csv", &["2"])] {
        let exchanged = |line: &str| match line.split(',').collect::<Vec<_>>()[..] {
            [i, j @ ("2" | "4"), ref rest @ ..] if frames.contains(&i) => {
                format!("{i},{},{}\n", if j == "2" { "4" } else { "2" }, rest.join(","))
            }
            _ => format!("{line}\n"),
        };
        fs::write(factory.path(name), text.lines().map(exchanged).collect::<String>()).unwrap();
    }
    let altered = fs::read_to_string(factory.path(HERE)).unwrap().replacen("alpha_arcsec: ", "alpha_arcsec: 1", 1);
    fs::create_dir_all(factory.path("other/SPS-2/0017")).unwrap();
    fs::write(factory.path("other/SPS-2/0017/here-1.yaml"), altered).unwrap();
    fs::copy(factory.path(HERE), factory.path("alone.yaml")).unwrap();
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
    let (code, stdout, said) = factory.said(&format!("certify new.csv --against {HERE}"));
    assert!(code == 2 && stdout.is_empty() && said.contains("found a passport; specify --trust"), "{said}");
    let altered = fs::read_to_string(factory.path(HERE)).unwrap().replacen("gamma_arcsec: ", "gamma_arcsec: 1", 1);
    fs::write(factory.path("altered.yaml"), altered).unwrap();
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
    let (code, _, said) = factory.said(&format!("{recertify} --key key"));
    assert!(code == 1 && said.contains("record.html: already exists") && passports(&factory) == before, "{said}");
    let (code, _, said) = factory.said(&format!("{recertify} --key key").replace(".html", ".pdf"));
    assert!(code == 2 && said.contains("no-browser-of-this-name") && passports(&factory) == before, "{said}");
    let found = factory.json(&format!("{recertify} --key key --force --exclude 2,3,4 --why lamp"), 0);
    let page = fs::read_to_string(factory.path("record.html")).unwrap();
    // Expected: the number of the JSON, and one bar for each of the 24 deviations above the axis.
    let changes = found["changes"].as_array().unwrap();
    let gamma = changes.iter().find(|at| at["key"] == "positions[2,3].gamma_arcsec").unwrap();
    assert!(page.contains(&format!("{:.1}", gamma["difference"].as_f64().unwrap())));
    let section = page.split("id=\"change\"").nth(1).unwrap().split("</section>").next().unwrap();
    assert_eq!(section.matches("picture strip").count(), changes.len() + 1);
    assert!(page.contains("lamp"));
    // Expected: `certify` with the same exclusion, whose readings the certificate names.
    let stand = String::from_utf8(passports(&factory)["stand.yaml"].clone()).unwrap();
    assert!(stand.contains("{i: 2, j: 3, run: 4, why: \"lamp\"}"), "{stand}");
    factory.good(&format!("verify passports/SPS-2/0017/here-2.yaml {TRUST}"));
    for (arguments, words) in [
        ("--exclude 2,3,9 --why lamp", "found no reading of position (2, 3) in run 9 to exclude"),
        ("--exclude 2,3,4 --exclude 1,1,1 --exclude 1,1,2 --why a --why b", "found 2 --why for 3 --exclude"),
    ] {
        let (code, _, said) =
            factory.said(&format!("recertify {HERE} new.csv {ORDER} --identity factory {TRUST} --dry-run {arguments}"));
        assert!(code == 2 && said.contains(words), "{said}");
    }
}

/// In a workspace the stand file is where `issue` finds it.
#[test]
fn in_a_workspace_the_stand_file_is_among_the_stands() {
    let factory = factory();
    let settings = "key = \"key\"\nidentity = \"factory\"\ntrust = \"allowed_signers\"\npassports = \"passports\"\n\
                    stands = \"stands\"\nsites = \".\"\n";
    fs::write(factory.path("dtg-passport.toml"), settings).unwrap();
    fs::create_dir_all(factory.path("stands/SPS-2/0017")).unwrap();
    let stand = factory.path("stands/SPS-2/0017/stand.yaml");
    fs::rename(factory.path("passports/SPS-2/0017/stand.yaml"), &stand).unwrap();
    factory.good(&format!("recertify SPS-2/0017/here/1 new.csv {ORDER} --workspace . --time 2026-11-21"));
    assert!(fs::read_to_string(&stand).unwrap().contains("C-2026-0300"));
    assert!(factory.path("stands/SPS-2/0017/stand-C-2026-0143.superseded.yaml").exists());
    assert!(!factory.path("passports/SPS-2/0017/stand.yaml").exists());
    assert!(factory.path("passports/SPS-2/0017/there-2.yaml").exists());
}
