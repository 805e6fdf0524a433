//! A fleet: tables say which stand goes where.

use crate::place::{Place, example};
use crate::programs::{self, with_angles};
use serde_json::{Value, json};
use std::fs;

const TABLE: &str = "stand,site,valid_until,customer\n\
                     SPS-2/0017,moscow-bmstu,2027-06-30,\"Gyro Works, Moscow\"\n\
                     # a stand at two sites\n\
                     SPS-2/0018,torino-inrim,,Torino Lab\n\
                     SPS-2/0018,moscow-bmstu,,\n";

/// `init` and `keygen --identity` are enough for a workspace that issues, to all of its sites.
#[test]
fn a_workspace_gets_its_key_and_its_issuer() {
    let place = Place::before_issue();
    place.good("init new");
    place.good("keygen --identity works@example.org --no-passphrase --workspace new");
    let settings = place.read("new/dtg-passport.toml");
    assert!(settings.contains("\nidentity = \"works@example.org\"\n"), "{settings}");
    for name in ["stands/SPS-2/0017/stand.yaml", "sites/moscow-bmstu.yaml", "sites/torino-inrim.yaml"] {
        place.write(format!("new/{name}"), place.read(format!("factory/{name}")));
    }
    place.good("issue SPS-2/0017 --site * --workspace new --allow-uncalibratable");
    for site in ["moscow-bmstu", "torino-inrim"] {
        place.good(&format!("verify SPS-2/0017/{site}/1 --issuer works@example.org --workspace new"));
    }
    // Another key is not the workspace's, and a second issuer is not stated.
    place.good("keygen other --identity other@example.org --no-passphrase --workspace new");
    assert_eq!(place.read("new/dtg-passport.toml"), settings);
}

#[test]
fn each_row_of_a_table_is_a_passport_and_an_archive() {
    let place = Place::before_issue();
    place.write("table.csv", TABLE);
    let issue = "issue --deliveries table.csv --workspace factory --allow-uncalibratable";
    let said = place.good(issue);
    assert!(said.contains("SPS-2/0017/moscow-bmstu/1"), "{said}");
    // Expected: the cells of each row, and the date of the certificate where it states none.
    for (name, customer, valid_until) in [
        ("0017/moscow-bmstu-1.yaml", Some("Gyro Works, Moscow"), Some("2027-06-30")),
        ("0018/torino-inrim-1.yaml", Some("Torino Lab"), None),
        ("0018/moscow-bmstu-1.yaml", None, None),
    ] {
        let text = place.read(format!("factory/passports/SPS-2/{name}"));
        assert!(text.contains("format: \"dtg-passport/1\""), "{name}");
        states_customer(&text, customer);
        assert!(valid_until.is_none_or(|day| text.contains(&format!("valid_until: \"{day}\""))), "{name}\n{text}");
    }
    let product = place.path("factory/passports/SPS-2/0017/torino-inrim-1.yaml");
    assert!(!product.exists(), "the cross product is not asked for");
    // The same again changes nothing.
    let before = place.files();
    place.good(issue);
    assert!(place.files() == before);

    let said = place.good("deliver --deliveries table.csv --out archives --workspace factory");
    assert!(said.contains(&place.fingerprint("factory/factory.key.pub")), "{said}");
    for (name, holds, lacks) in [
        ("0017/moscow-bmstu", "0017/moscow-bmstu-1.yaml", "0018"),
        ("0018/torino-inrim", "0018/torino-inrim-1.yaml", "moscow-bmstu-1.yaml"),
        ("0018/moscow-bmstu", "0018/moscow-bmstu-1.yaml", "torino-inrim-1.yaml"),
    ] {
        let archive = fs::read(place.path("archives/SPS-2").join(name).with_extension("zip")).unwrap();
        let text = String::from_utf8_lossy(&archive);
        assert!(text.contains(holds) && !text.contains(lacks), "{name}");
    }
}

/// Fails unless a file states this customer, and no other.
fn states_customer(text: &str, customer: Option<&str>) {
    assert_eq!(text.matches("customer: ").count(), usize::from(customer.is_some()), "{text}");
    assert!(customer.is_none_or(|customer| text.contains(&format!("customer: \"{customer}\""))), "{text}");
}

#[test]
fn a_table_with_a_mistake_issues_nothing() {
    let place = Place::before_issue();
    let before = place.files();
    for (table, words) in [
        ("stand,site\nSPS-2/0017,moscow-bmstu\nSPS-2/0017,moscow-bmstu\n", "each stand once for a site"),
        ("stand,site\nSPS-2/0017,\n", "a name"),
        ("stand,site,valid_until\nSPS-2/0017,moscow-bmstu,30.06.2027\n", "valid_until"),
        ("stand,site,customer\nSPS-2/0017,moscow-bmstu,a\u{202e}b\n", "customer"),
        ("stand,site\nSPS-2/0019,moscow-bmstu\n", "0019"),
        ("stand,sites\nSPS-2/0017,moscow-bmstu\n", "site"),
        ("stand,site\n", "no row"),
        ("stand;site\nSPS-2/0017;samara\n", "samara"),
    ] {
        place.write("table.csv", table);
        let (code, _, said) = place.said("issue --deliveries table.csv --workspace factory --allow-uncalibratable");
        assert!([1, 2].contains(&code) && said.contains(words), "{table}\n{said}");
        fs::remove_file(place.path("table.csv")).unwrap();
        assert!(place.files() == before, "{table}");
    }
}

/// The header of the example without what a table states, and the readings of stands that differ by `shift` arcseconds.
fn readings(place: &Place, serials: &[&str]) {
    let header = example("docs/header.yaml");
    let open: Vec<&str> =
        header.lines().filter(|line| !line.contains("  number:") && !line.contains("  issued:")).collect();
    place.write("header.yaml", open.join("\n").replace("serial: \"0017\", ", "") + "\n");
    let angles = example("docs/angles.csv");
    for (shift, serial) in serials.iter().enumerate() {
        let shift = |column: u32| if column == 3 { shift as f64 } else { 0.0 };
        place.write(format!("angles/{serial}.csv"), with_angles(&angles, |_, _, column, was| was + shift(column)));
    }
}

#[test]
fn one_header_certifies_a_fleet() {
    let place = Place::before_issue();
    readings(&place, &["0101", "0102", "0103"]);
    let table = "serial,number,issued,customer,temperature_c\n\
                 0101,C-2026-0201,2026-11-03,Gyro Works,20.5\n0102,C-2026-0202,2026-11-04,,\n0103,C-2026-0203,2026-11-05,,\n";
    place.write("table.csv", table);
    place.good("certify angles --stand header.yaml --certificates table.csv --out stands");
    for (serial, number, issued, customer, temperature) in [
        ("0101", "C-2026-0201", "2026-11-03", Some("Gyro Works"), "20.5"),
        ("0102", "C-2026-0202", "2026-11-04", None, "20"),
    ] {
        let text = place.read(format!("stands/SPS-2/{serial}/stand.yaml"));
        let words = [format!("serial: \"{serial}\""), format!("number: \"{number}\""), format!("issued: \"{issued}\"")];
        assert!(words.iter().all(|words| text.contains(words)), "{text}");
        assert!(text.contains(&format!("temperature_c: {temperature}")), "{text}");
        states_customer(&text, customer);
    }
    // The same angles as with a header of its own. Expected: `certify` of one stand.
    place.change("header.yaml", "model: \"SPS-2\"", "model: \"SPS-2\", serial: \"0103\"");
    let certificate = "certificate:\n  number: \"C-2026-0203\"\n  issued: \"2026-11-05\"\n";
    place.change("header.yaml", "certificate:\n", certificate);
    place.good("certify angles/0103.csv --stand header.yaml -o own-stand.yaml");
    assert!(place.read("own-stand.yaml") == place.read("stands/SPS-2/0103/stand.yaml"));
}

/// A year's fleet, from readings to archives. Expected: a certificate, a passport in force and an archive for each row, and
/// only its own customer in it.
#[test]
fn two_hundred_stands_take_three_commands_and_two_tables() {
    let place = Place::before_issue();
    let serials: Vec<String> = (1001..1201).map(|serial| serial.to_string()).collect();
    readings(&place, &serials.iter().map(String::as_str).collect::<Vec<_>>());
    let table = |head: &str, row: &dyn Fn(&String) -> String| {
        format!("{head}\n{}\n", serials.iter().map(row).collect::<Vec<_>>().join("\n"))
    };
    let certificates = table("serial,number,issued", &|serial| format!("{serial},C-{serial},2026-11-03"));
    let deliveries =
        table("stand,site,customer", &|serial| format!("SPS-2/{serial},moscow-bmstu,Customer of {serial}"));
    place.write("certificates.csv", certificates);
    place.write("deliveries.csv", deliveries);
    place.good("certify angles --stand header.yaml --certificates certificates.csv --out factory/stands");
    place.good("issue --deliveries deliveries.csv --workspace factory");
    place.good("deliver --deliveries deliveries.csv --out archives --workspace factory");
    let listed = place.json("register factory/passports --trust factory/allowed_signers", 0);
    assert_eq!(listed["stands"].as_array().unwrap().len(), serials.len());
    for serial in &serials {
        let archive = fs::read(place.path(format!("archives/SPS-2/{serial}/moscow-bmstu.zip"))).unwrap();
        assert!(String::from_utf8_lossy(&archive).contains(&format!("{serial}/moscow-bmstu-1.yaml")), "{serial}");
        let text = place.read(format!("factory/passports/SPS-2/{serial}/moscow-bmstu-1.yaml"));
        assert!(text.contains(&format!("number: \"C-{serial}\"")), "{text}");
        states_customer(&text, Some(&format!("Customer of {serial}")));
    }
}

#[test]
fn a_row_or_a_file_without_its_partner_is_refused_and_the_others_are_done() {
    let place = Place::before_issue();
    readings(&place, &["0101", "0102", "0103", "0104", "0105"]);
    let table = "serial,number,issued\n0101,C-2026-0201,2026-11-03\n0102,C-2026-0202,2026-11-04\n\
                 0103,C-2026-0202,2026-11-04\n0104,C-2026-0204,2026-11-04\n0104,C-2026-0205,2026-11-04\n\
                 0109,C-2026-0209,2026-11-04\n";
    place.write("table.csv", table);
    let certify = "certify angles --stand header.yaml --certificates table.csv --out stands";
    let said = place.refused(certify, "serial 0109: the table");
    for words in
        ["certificate C-2026-0202 has two rows", "serial 0104 has two rows", "the table has no row for serial 0105"]
    {
        assert!(said.contains(words), "lacks {words}\n{said}");
    }
    assert_eq!(place.names("stands/SPS-2"), ["0101"]);
}

#[test]
fn what_is_due_is_listed_by_its_days() {
    let place = Place::before_issue();
    place.write("table.csv", TABLE.replace("Torino Lab", "=1+1").replace("2027-06-30", "2027-01-15"));
    place.good("issue --deliveries table.csv --workspace factory --allow-uncalibratable");
    place.good("register factory/passports --renew --fresh-until 2027-01-10 --workspace factory");
    let status = |days: u32, more: &str| place.good(&format!("status --days {days} --workspace factory {more}"));
    let now = "--time 2026-12-01";
    let found = place.json(&format!("status --days 60 --workspace factory {now}"), 0);
    let due = found["due"].as_array().unwrap();
    let rows: Vec<[&str; 3]> =
        due.iter().map(|row| ["date", "what", "id"].map(|key| row[key].as_str().unwrap_or_default())).collect();
    assert_eq!(
        rows,
        [
            ["2027-01-10", "register_stale", "SPS-2/0017"],
            ["2027-01-10", "register_stale", "SPS-2/0018"],
            ["2027-01-15", "passport_expires", "SPS-2/0017/moscow-bmstu/1"],
        ]
    );
    assert_eq!(due[2]["days_left"], 45);
    let names = ["site", "certificate", "customer"].map(|key| due[2][key].as_str().unwrap());
    assert_eq!(names, ["moscow-bmstu", "C-2026-0142", "Gyro Works, Moscow"]);
    let said = status(60, now);
    assert!(said.contains("2027-01-15") && said.contains("Gyro Works, Moscow"), "{said}");
    assert!(status(3, now).contains("nothing is due within 3 days"));

    // As a table, in which no cell is a formula; in Russian as spreadsheet programs there expect it.
    let csv = status(900, &format!("{now} --format csv"));
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines[0], "date,days_left,what,id,site,certificate,customer");
    let due =
        "2027-01-15,45,passport_expires,SPS-2/0017/moscow-bmstu/1,moscow-bmstu,C-2026-0142,\"Gyro Works, Moscow\"";
    assert!(lines.contains(&due), "{csv}");
    assert!(csv.contains(",'=1+1\n") && !csv.contains(",=1+1"), "{csv}");
    let russian = status(900, &format!("{now} --format csv --lang ru"));
    assert!(russian.starts_with("\u{feff}date;days_left;what;"), "{russian}");
    assert_eq!(russian.lines().count(), lines.len());

    // As a calendar. Expected: RFC 5545, 3.1 (lines), 3.6.1 (events), 3.8.4.7 (UID).
    let calendar = |time: &str| status(60, &format!("--time {time} --format ics"));
    let ics = calendar("2026-12-01");
    assert!(ics.starts_with("BEGIN:VCALENDAR\r\nVERSION:2.0\r\n") && ics.ends_with("END:VCALENDAR\r\n"), "{ics}");
    assert!(ics.split("\r\n").all(|line| line.len() <= 75 && !line.contains('\n')), "{ics}");
    assert_eq!(ics.matches("BEGIN:VEVENT").count(), 3);
    assert!(ics.contains("DTSTART;VALUE=DATE:20270115"), "{ics}");
    let unfolded = ics.replace("\r\n ", "");
    assert!(unfolded.contains("C-2026-0142\\, Gyro Works\\, Moscow\r\n"), "{unfolded}");
    let uids = |ics: &str| ics.lines().filter(|line| line.starts_with("UID:")).map(str::to_owned).collect::<Vec<_>>();
    let mut all = uids(&ics);
    assert_eq!(all, uids(&calendar("2026-12-05")), "the same events on another day");
    all.sort();
    all.dedup();
    assert_eq!(all.len(), 3);
}

/// Expected: SHA-256 of coreutils, and the names of the files that the test makes.
#[test]
fn a_certificate_is_found_by_its_number() {
    let place = Place::before_issue();
    place.write("factory/header.yaml", example("docs/header.yaml").replace("C-2026-0143", "C-2026-0102"));
    place.copy("docs/angles.csv", "factory/readings/a.csv");
    place.good(
        "certify factory/readings/a.csv --stand factory/header.yaml -o factory/stands/SPS-2/0017/stand.yaml --force --report \
         factory/record.html",
    );
    place.good("issue SPS-2/0017 --site moscow-bmstu --workspace factory");
    place.good("reissue SPS-2/0017/moscow-bmstu/1 --reason again --same-content --workspace factory");
    let traced = |number: &str| place.json(&format!("history {number} --workspace factory"), 0);
    // The second number begins with a Cyrillic letter.
    let found = traced("C-2026-0102");
    assert_eq!(found, traced("\u{421}-2026-0102"));
    let sha256 = programs::sha256(&place.path("factory/readings/a.csv"));
    assert_eq!(found["readings"], json!([{"path": "factory/readings/a.csv", "sha256": sha256}]));
    for (key, path) in [
        ("header", "factory/header.yaml"),
        ("record", "factory/record.html"),
        ("stand_file", "factory/stands/SPS-2/0017/stand.yaml"),
    ] {
        assert_eq!(found[key], path);
    }
    let passports = found["passports"].as_array().unwrap().iter();
    let states: Vec<[&Value; 2]> = passports.map(|at| [&at["id"], &at["state"]]).collect();
    let [first, second] = ["SPS-2/0017/moscow-bmstu/1", "SPS-2/0017/moscow-bmstu/2"];
    assert_eq!(states, [[first, "superseded"], [second, "current"]]);
    assert_eq!((&found["missing"], &found["changed"]), (&json!([]), &json!([])));

    // What is missing or has changed is said.
    place.change("factory/stands/SPS-2/0017/stand.yaml", "alpha_arcsec: ", "alpha_arcsec: 9");
    place.write("factory/readings/a.csv", "i,j,run\n");
    let found = traced("C-2026-0102");
    assert_eq!(found["missing"], json!(["readings", "stand_file"]));
    assert_eq!(found["changed"], json!(["factory/stands/SPS-2/0017/stand.yaml"]));
    let said = place.good("history C-2026-0102 --workspace factory");
    assert!(said.contains("not found") && said.contains("stand.yaml: has changed"), "{said}");
    place.refused("history C-2026-0999 --workspace factory", "states certificate C-2026-0999");
}
