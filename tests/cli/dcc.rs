//! Digital Calibration Certificates: valid by PTB's rules, read back bit for bit by another program, and refused with every
//! missing or contradicting key.

use crate::place::Place;
use crate::programs;
use base64ct::{Base64, Encoding};
use roxmltree::{Document, Node};
use serde_json::Value;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

const MOSCOW: &str = "passports/SPS-2/0017/moscow-bmstu-1.yaml";
const EVERY: [&str; 3] =
    [MOSCOW, "passports/SPS-2/0017/beijing-nim-1.yaml", "passports/SPS-1/0203/moscow-bmstu-1.yaml"];

/// Complete administrative file for every example passport; each line can be left out by its key.
const ADMINISTRATIVE: &str = r#"format: "dtg-dcc/1"
country: "RU"
language: "en"
location: "laboratory"
laboratory: {city: "Moscow", street: "Example street", street_no: "1", post_code: "105005", country: "RU", email: "a@example.org"}
customer: {name: "A customer", city: "Kazan"}
responsible: ["A. Person", "B. Person"]
performed: {from: "2026-10-20", to: "2026-10-30"}
"#;

const TRUST: &str = "--trust docs/allowed_signers --time 2026-11-20";

/// A folder with the example passports, and the files that they are used with.
fn folder() -> Place {
    let more = ["docs/allowed_signers", "docs/currents.csv", "docs/laboratory.yaml"];
    Place::of(&[&EVERY[..], &more].concat().into_iter().map(|name| (name, name)).collect::<Vec<_>>())
}

/// Exports `passport` with the administrative text, to `out`: exit code, standard error.
fn export(folder: &Place, passport: &str, administrative: &str, more: &str) -> (i32, String) {
    folder.write("dcc.yaml", administrative);
    let arguments = format!("export {passport} {TRUST} --to dcc --out out --administrative dcc.yaml {more}");
    let (code, stdout, said) = folder.said(&arguments);
    assert_eq!(stdout, "");
    (code, said)
}

/// Returns the only file in `out`, moved to `name`, and its text.
fn taken(folder: &Place, name: &str) -> (PathBuf, String) {
    let names = folder.names("out");
    let [file] = &names[..] else { panic!("{names:?}") };
    fs::rename(folder.path("out").join(file), folder.path(name)).unwrap();
    (folder.path(name), folder.read(name))
}

/// Returns what PTB's rules and units find, and what PyDCC reads; PTB's schema too, where `DCC_XSD` names its folder.
fn judged(files: &[&Path]) -> Vec<Value> {
    let mut python = programs::python();
    python.arg(programs::project("tests/readers/certificates.py"));
    match std::env::var_os("DCC_XSD") {
        Some(folder) => {
            python.arg("--xsd").arg(folder);
        }
        None => {
            // Unlike a print, this is shown of tests that pass, too.
            const WORDS: &[u8] =
                b"\nNOT CHECKED AGAINST THE XSD: DCC_XSD does not name the folder of PTB's schemas (docs/dcc.md)\n";
            std::io::stderr().write_all(WORDS).unwrap();
        }
    }
    python.args(files);
    let Value::Array(judged) = serde_json::from_str(&programs::output(python)).unwrap() else { panic!() };
    judged
}

/// Fails unless PTB has nothing to object.
fn assert_good(judged: &Value, xml: &str) {
    assert_eq!(judged["findings"], Value::Array(Vec::new()), "{xml}");
    assert_eq!(judged["invalid_units"], Value::Array(Vec::new()));
    // Information that some elements are there: the rules were applied.
    assert!(judged["rules"].as_u64().unwrap() >= 3, "{judged}");
    if std::env::var_os("DCC_XSD").is_some() {
        assert_eq!(judged["schema"], Value::Array(Vec::new()), "{xml}");
    }
    assert_eq!(misplaced(xml), Vec::<String>::new());
}

/// Children of an element in their order: `?` may be absent, `*` and `+` may be repeated. Source: PTB's schema of the
/// DCC 3.3.0 and of D-SI 2.2.1, as far as this program writes it.
const CHILDREN: &str = "
digitalCalibrationCertificate: administrativeData measurementResults document?
administrativeData: dccSoftware refTypeDefinitions coreData items calibrationLaboratory respPersons customer \
  statements?
dccSoftware: software+
usedSoftware: software+
software: name release type
refTypeDefinitions: refTypeDefinition+
refTypeDefinition: name namespace link
coreData: countryCodeISO3166_1 usedLangCodeISO639_1+ mandatoryLangCodeISO639_1 uniqueIdentifier identifications? \
  receiptDate? beginPerformanceDate endPerformanceDate performanceLocation issueDate? previousReport?
identifications: identification+
identification: issuer value name
previousReport: referral referralID procedure value
certificate: referral referralID procedure value description?
items: item
item: name manufacturer? model? identifications
manufacturer: name
calibrationLaboratory: calibrationLaboratoryCode? contact
contact: name eMail? phone? location
customer: name eMail? phone? location
location: street? streetNo? postOfficeBox? postCode? city? state? countryCode? further?
respPersons: respPerson+
respPerson: person mainSigner?
person: name
statements: statement+
statement: name traceable? reference? declaration? date? conformity? data?
measurementResults: measurementResult+
measurementResult: name description? usedMethods usedSoftware measuringEquipments? influenceConditions results \
  measurementMetaData?
usedMethods: usedMethod+
usedMethod: name description link?
measuringEquipments: measuringEquipment+
measuringEquipment: name certificate? manufacturer? model? identifications
influenceConditions: influenceCondition+
influenceCondition: name data
results: result+
result: name description? data
data: quantity* list* byteData*
list: quantity+
quantity: name real? realListXMLList? measurementMetaData?
measurementMetaData: metaData+
metaData: name declaration? conformityXMLList? data?
real: value unit measurementUncertaintyUnivariate?
realListXMLList: labelXMLList? valueXMLList unitXMLList measurementUncertaintyUnivariateXMLList?
measurementUncertaintyUnivariate: standardMU
standardMU: valueStandardMU
measurementUncertaintyUnivariateXMLList: standardMUXMLList
standardMUXMLList: valueStandardMUXMLList
document: name description fileName mimeType dataBase64
byteData: name description fileName mimeType dataBase64
declaration: content+
further: content+
";

/// Returns every element with other children than [`CHILDREN`] states; elements of texts are `content`, all others have
/// text alone.
fn misplaced(xml: &str) -> Vec<String> {
    let document = Document::parse(xml).unwrap();
    let mut wrong = Vec::new();
    for element in document.descendants().filter(Node::is_element) {
        let children: Vec<&str> =
            element.children().filter(Node::is_element).map(|child| child.tag_name().name()).collect();
        let name = element.tag_name().name();
        let is_text = ["name", "description", "referral"].contains(&name);
        let rule = CHILDREN.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(": "));
        let rule = rule.unwrap_or(if is_text { "content+" } else { "" });
        let mut rest = &children[..];
        let mut fits = true;
        for one in rule.split_ascii_whitespace() {
            let name = one.trim_end_matches(['?', '*', '+']);
            let most = if one.ends_with(['*', '+']) { usize::MAX } else { 1 };
            let least = usize::from(!one.ends_with(['?', '*']));
            let count = rest.iter().take(most).take_while(|child| **child == name).count();
            fits &= count >= least;
            rest = &rest[count..];
        }
        let text = element.text().unwrap_or_default();
        fits &= rest.is_empty() && (!children.is_empty() || !text.is_empty() && text == text.trim());
        if !fits {
            wrong.push(format!("{name}: {children:?}"));
        }
    }
    wrong
}

/// Returns the passport in a certificate.
fn enclosed(document: &Document) -> String {
    let base64 = document.descendants().find(|node| node.has_tag_name(("https://ptb.de/dcc", "dataBase64")));
    String::from_utf8(Base64::decode_vec(base64.unwrap().text().unwrap()).unwrap()).unwrap()
}

/// Returns the bits of a number as the reader in Python prints them.
fn bits(value: &Value) -> Value {
    Value::String(format!("{:016x}", value.as_f64().unwrap().to_bits()))
}

/// Expected: PTB's Schematron, its units, its schema where it is at hand, and the numbers of the signed passports, read by
/// PyDCC from the DCC and by serde_json from the export as JSON.
#[test]
fn every_example_is_valid_and_reads_back_bit_for_bit() {
    let folder = folder();
    let mut files = Vec::new();
    for (index, passport) in EVERY.into_iter().enumerate() {
        for lang in ["en", "ru", "en,ru"] {
            let (code, said) = export(&folder, passport, ADMINISTRATIVE, &format!("--lang {lang}"));
            assert_eq!(code, 0, "{said}");
            assert!(said.contains("the DCC is not signed"), "{said}");
            let (file, xml) = taken(&folder, &format!("{index}-{lang}.xml"));
            let languages: Vec<_> = if lang == "ru" { vec!["ru", "en"] } else { lang.split(',').collect() };
            for used in &languages {
                assert!(xml.contains(&format!("<dcc:usedLangCodeISO639_1>{used}</dcc:usedLangCodeISO639_1>")));
            }
            assert_eq!(xml.matches("<dcc:usedLangCodeISO639_1>").count(), languages.len());
            files.push((file, passport, xml));
        }
    }
    let judged = judged(&files.iter().map(|(file, ..)| file.as_path()).collect::<Vec<_>>());
    assert_eq!(judged.len(), files.len());
    for (judged, (_, passport, xml)) in judged.iter().zip(&files) {
        assert_good(judged, xml);
        let document = Document::parse(xml).unwrap();
        assert_eq!(enclosed(&document), folder.read(passport), "{passport}");
        let shown = folder.json(&format!("show {passport} {TRUST}"), 0);
        assert_eq!(judged["number"], shown["certificate"]["number"]);
        assert_eq!(judged["laboratory"], shown["certificate"]["laboratory"]);
        assert_eq!(judged["day"], "2026-10-30");
        let columns = [
            ("i", None, r"\one"),
            ("j", None, r"\one"),
            ("theta_deg", None, r"\degree"),
            ("phi_deg", None, r"\degree"),
            ("alpha_arcsec", Some("u_alpha_arcsec"), r"\arcsecond"),
            ("beta_arcsec", Some("u_beta_arcsec"), r"\arcsecond"),
            ("gamma_arcsec", Some("u_gamma_arcsec"), r"\arcsecond"),
            ("degrees_of_freedom", None, r"\one"),
        ];
        for symbol in ["alpha", "beta", "gamma"] {
            let kinds = format!("basic_measuredValue dtg_{symbol}");
            let of_kind = document.descendants().find(|node| node.attribute("refType") == Some(&kinds)).unwrap();
            assert_eq!(["id", "refId"].map(|name| of_kind.attribute(name)), [Some(symbol), Some("i j")]);
        }
        let results = judged["results"].as_array().unwrap();
        let positions = shown["positions"].as_array().unwrap();
        let stated = positions.iter().any(|at| at["degrees_of_freedom"].is_number());
        assert_eq!(results.len(), if stated { columns.len() } else { columns.len() - 1 });
        for (found, (key, u, unit)) in results.iter().zip(columns) {
            let column = |key: &str| Value::Array(positions.iter().map(|at| bits(&at[key])).collect());
            assert_eq!(found["values"], column(key), "{passport} {key}");
            assert_eq!(found["u"], u.map_or(Value::Null, column), "{passport} {key}");
            assert_eq!(found["unit"], unit);
        }
    }
}

/// What is not stated is NaN in the list, or the list is absent; other positions and free texts of the passport go
/// through as they are. Expected: the stand file that was signed.
#[test]
fn an_odd_passport_goes_through_as_it_is() {
    let folder = folder();
    let stand = r#"format: "dtg-stand/1"
stand: {manufacturer: "<A> & ]]> \"B\" 'C'", model: "M", serial: "1", name: " </dcc:content><x/> ", customer: "<!--"}
certificate:
  number: " № 1/<2>&3 "
  issued: "2026-11-05"
  received: "2026-10-01"
  laboratory: "&lt; &amp; &#0;"
  address: "<?xml?> 中文"
  authorized_by: "D"
  accreditation: "<E>"
  references: [{number: "<C>&1", laboratory: "<F>", issued: "2025-06-30", sha256: "0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a"}]
  cmc_arcsec: 0.6
positions:
  - {i: 3, j: 7, theta_deg: -12.5, phi_deg: 1.0e-05, alpha_arcsec: 0.1, beta_arcsec: -0.0, gamma_arcsec: 1.0e+05, u_alpha_arcsec: 0.30000000000000004}
  - {i: 3, j: 8, theta_deg: 33.3, phi_deg: 77.7, alpha_arcsec: 5.0e-324, beta_arcsec: 1, gamma_arcsec: -161999.99999999997}
"#;
    folder.write("stand.yaml", stand);
    folder.copy(programs::KEY, "key");
    folder.copy("sites/moscow-bmstu.yaml", "site.yaml");
    folder.good(
        "issue stand.yaml --site site.yaml --key key --identity examples@dtg-passport.test --issued-at \
         2026-11-09T09:00:00Z --allow-uncalibratable",
    );
    let passport = "passports/M/1/moscow-bmstu-1.yaml";
    let administrative = r#"format: "dtg-dcc/1"
country: "CN"
language: "ru"
location: "customerBranch"
laboratory: {name: "&lt; &amp; &#0;"}
customer: {city: "]]>", post_office_box: "<&>", state: "'\""}
responsible: ["D", "E", "E"]
performed: {from: "2026-10-20", to: "2026-10-20"}
method: "<script>alert(1)</script>"
temperature_c: -1.5
"#;
    let (code, said) = export(&folder, passport, administrative, "");
    assert_eq!(code, 0, "{said}");
    assert!(folder.path("out/_ 1__2__3.xml").is_file(), "{said}");
    let (file, xml) = taken(&folder, "odd.xml");
    let judged = &judged(&[&file])[0];
    assert_good(judged, &xml);
    assert_eq!((&judged["number"], &judged["laboratory"]), (&"№ 1/<2>&3".into(), &"&lt; &amp; &#0;".into()));
    let alpha = &judged["results"][4];
    assert_eq!(alpha["values"], serde_json::json!([bits(&0.1.into()), bits(&5e-324.into())]));
    assert_eq!(alpha["u"][0], bits(&0.300_000_000_000_000_04.into()));
    assert!(number(&alpha["u"][1]).is_nan());
    assert_eq!(judged["results"][5]["u"], Value::Null);
    let document = Document::parse(&xml).unwrap();
    let texts: Vec<&str> = document.descendants().filter(Node::is_element).filter_map(|node| node.text()).collect();
    for text in [
        "<A> & ]]> \"B\" 'C'",
        "</dcc:content><x/>",
        "<!--",
        "<?xml?> 中文",
        "<E>",
        "<C>&1",
        "Кем и\u{a0}когда выдан: <F>, 30.06.2025.",
        "0.6",
        "<script>alert(1)</script>",
        "'\"",
    ] {
        assert!(texts.contains(&text), "{text}: {xml}");
    }
    // The person who authorised the certificate is the main signer; each name is there once.
    let persons: Vec<_> = document.descendants().filter(|node| node.tag_name().name() == "respPerson").collect();
    assert_eq!(persons.len(), 2);
    assert_eq!(persons[0].descendants().filter(|node| node.tag_name().name() == "mainSigner").count(), 1);
    assert_eq!(enclosed(&document), folder.read(passport));
}

/// Every key that is missing is named with the element that needs it, all at once, and nothing is written.
#[test]
fn everything_that_is_missing_is_named() {
    let folder = folder();
    let needs = [
        ("country", "coreData/countryCodeISO3166_1"),
        ("location", "coreData/performanceLocation"),
        ("laboratory.city", "calibrationLaboratory/contact/location"),
        ("customer.name", "customer/name"),
        ("customer.city", "customer/location"),
        ("responsible", "respPersons/respPerson"),
        ("performed.from", "coreData/beginPerformanceDate"),
        ("performed.to", "coreData/endPerformanceDate"),
    ];
    // SPS-1's passport does not state the day of measurement. At last all keys are left out but the format.
    for left_out in ["country", "location", "laboratory", "customer", "responsible", "performed", ""] {
        let there = ADMINISTRATIVE.lines().filter(|line| line.starts_with("format") || !line.starts_with(left_out));
        let administrative: String = there.map(|line| format!("{line}\n")).collect();
        let (code, said) = export(&folder, EVERY[2], &administrative, "");
        assert_eq!(code, 1, "{said}");
        let due = needs.iter().filter(|(key, _)| key.starts_with(left_out));
        for (key, element) in due.clone() {
            let line = said.lines().find(|line| line.contains(&format!(" {key}: missing")));
            assert!(line.is_some_and(|line| line.contains(element)), "{key}: {said}");
        }
        assert_eq!(said.matches(": missing").count(), due.count(), "{said}");
        assert!(!folder.path("out").exists());
    }
    // Without any file, for programs; tests/cmd/dcc.md shows it for people.
    let refusal = folder.json(&format!("export {MOSCOW} {TRUST} --to dcc --out out"), 1);
    assert!(refusal.to_string().contains("missing_data"), "{refusal}");
}

/// Nothing in the file may contradict the signed passport.
#[test]
fn what_contradicts_the_passport_is_refused() {
    let folder = folder();
    let with = |from: &str, to: &str| {
        assert!(ADMINISTRATIVE.contains(from));
        ADMINISTRATIVE.replace(from, to)
    };
    let stated = [
        ("number", format!("{ADMINISTRATIVE}number: \"C-2026-0143\"\n")),
        ("issued", format!("{ADMINISTRATIVE}issued: \"2026-11-03\"\n")),
        ("method", format!("{ADMINISTRATIVE}method: \"another\"\n")),
        ("temperature_c", format!("{ADMINISTRATIVE}temperature_c: 20.1\n")),
        ("laboratory.name", with("{city: \"Moscow\"", "{name: \"Another\", city: \"Moscow\"")),
        // The passport states 2026-10-29, and that the certificate was issued on 2026-11-02.
        ("performed", with("2026-10-30", "2026-10-28")),
        ("performed.to", with("2026-10-30", "2026-11-03")),
    ];
    for (key, administrative) in stated {
        let (code, said) = export(&folder, MOSCOW, &administrative, "");
        assert_eq!(code, 1, "{said}");
        assert!(said.contains(&format!(" {key}: found ")), "{key}: {said}");
        assert!(!folder.path("out").exists());
    }
    // What is the same contradicts nothing.
    let same = format!(
        "{ADMINISTRATIVE}number: \"C-2026-0142\"\nissued: \"2026-11-02\"\ntemperature_c: 20\ntraceable: true\n"
    );
    let (code, said) = export(&folder, MOSCOW, &same, "");
    assert_eq!(code, 0, "{said}");
    assert!(taken(&folder, "same.xml").1.contains("<dcc:traceable>true</dcc:traceable>"));
}

/// Administrative file of the gyro's certificate.
const OF_GYRO: &str = r#"format: "dtg-dcc/1"
country: "RU"
language: "en"
location: "laboratory"
number: "G-7"
issued: "2026-11-20"
laboratory: {city: "Moscow"}
customer: {name: "A customer", city: "Kazan"}
responsible: ["A. Person"]
method: "procedure <7> & 8"
"#;

/// Calibrates the example gyro, and writes `gyro.xml`: exit code, JSON result, standard error.
fn calibrate(folder: &Place, administrative: &str, gyro: Option<&str>, more: &[&str]) -> (i32, Value, String) {
    folder.write("dcc.yaml", administrative);
    let mut program = folder.program();
    program.args(["calibrate", MOSCOW, "docs/currents.csv", "--laboratory", "docs/laboratory.yaml"]);
    program.args(TRUST.split(' ')).args(["--format", "json", "--force"]).args(DCC.split(' ')).args(more);
    if let Some(gyro) = gyro {
        folder.write("gyro.yaml", gyro);
        program.args(["--gyro", "gyro.yaml"]);
    }
    let output = program.output().unwrap();
    let result = serde_json::from_slice(&output.stdout).unwrap_or(Value::Null);
    (output.status.code().unwrap(), result, String::from_utf8(output.stderr).unwrap())
}

const DCC: &str = "--dcc gyro.xml --administrative dcc.yaml";
const KNOWN: [&str; 6] = ["--gyro-serial", "7 <b>", "--date", "2026-11-19", "--temperature-c", "21.5"];

fn number(bits: &Value) -> f64 {
    f64::from_bits(u64::from_str_radix(bits.as_str().unwrap(), 16).unwrap())
}

/// Expected: PTB's rules, the JSON result of the same calibration, and its decisions. Drifts per g are compared with the
/// quotient by the passport's g, their uncertainties with the law of propagation.
#[test]
fn a_gyro_has_its_certificate_with_decisions() {
    let folder = folder();
    let gvk_6 = fs::read_to_string(programs::project("docs/gvk-6.yaml")).unwrap();
    let gyros = [
        None,
        Some(gvk_6.clone()),
        // Far from the type: fail. At the limit: the decision is conditional.
        Some(gvk_6.replace("[95, 9.5], [9.5, 95]", "[95.2, 9.5], [9.5, 95.048]")),
        Some(gvk_6.replace("omega0_deg_per_h: 0.01", "omega0_deg_per_h: 0.0001")),
    ];
    let mut files = Vec::new();
    for (index, gyro) in gyros.iter().enumerate() {
        let lang = ["en", "en,ru"][index % 2];
        let (code, result, said) =
            calibrate(&folder, OF_GYRO, gyro.as_deref(), &[&KNOWN[..], &["--lang", lang]].concat());
        assert_eq!(code, i32::from(index == 2), "{said}");
        assert!(said.contains("wrote gyro.xml") && said.contains("not signed"), "{said}");
        let file = folder.path(format!("{index}.xml"));
        fs::rename(folder.path("gyro.xml"), &file).unwrap();
        let xml = fs::read_to_string(&file).unwrap();
        files.push((file, result, xml));
    }
    let mut seen = std::collections::BTreeSet::new();
    let judged = judged(&files.iter().map(|(file, ..)| file.as_path()).collect::<Vec<_>>());
    for (judged, (_, result, xml)) in judged.iter().zip(&files) {
        assert_good(judged, xml);
        assert_eq!(
            (&judged["number"], &judged["day"], &judged["laboratory"]),
            (&"G-7".into(), &"2026-11-19".into(), &"Gyro laboratory".into())
        );
        let best = result["results"].as_array().unwrap().first().unwrap();
        assert_eq!(best["method"], "least-squares");
        let [k, omega_0, drift] = [0, 1, 2].map(|place| &judged["results"][place]);
        let rows = |value: &Value| {
            Value::Array(value.as_array().unwrap().iter().flat_map(|row| row.as_array().unwrap()).map(bits).collect())
        };
        let list = |value: &Value| Value::Array(value.as_array().unwrap().iter().map(bits).collect());
        let u = &best["standard_uncertainty"];
        assert_eq!((&k["values"], &k["u"]), (&rows(&best["k_deg_per_h_per_ma"]), &rows(&u["k_deg_per_h_per_ma"])));
        assert_eq!(
            (&omega_0["values"], &omega_0["u"]),
            (&list(&best["omega0_deg_per_h"]), &list(&u["omega0_deg_per_h"]))
        );
        let g = result["gravity_m_per_s2"].as_f64().unwrap();
        let u_g = result["gravity_u_m_per_s2"].as_f64().unwrap();
        for (place, key) in ["omega_g_deg_per_h_per_g", "omega_k_deg_per_h_per_g"].iter().enumerate() {
            let (value, u) = (best[key].as_f64().unwrap(), u[key].as_f64().unwrap());
            assert!((number(&drift["values"][place]) * g / value - 1.0).abs() < 1e-15);
            let expected = (u * u + (value * u_g / g).powi(2)).sqrt() / g;
            assert!((number(&drift["u"][place]) / expected - 1.0).abs() < 1e-12);
        }
        // u and correlation are the covariance of the result, with the common uncertainty of g.
        let correlation = judged["results"].as_array().unwrap().last().unwrap()["values"].as_array().unwrap();
        let u: Vec<f64> = [k, omega_0, drift].iter().flat_map(|one| one["u"].as_array().unwrap()).map(number).collect();
        let of_g = |place: usize| match place {
            6 => best["omega_g_deg_per_h_per_g"].as_f64().unwrap() * u_g / g,
            7 => best["omega_k_deg_per_h_per_g"].as_f64().unwrap() * u_g / g,
            _ => 0.0,
        };
        assert_eq!((correlation.len(), u.len()), (64, 8));
        for (at, found) in correlation.iter().enumerate() {
            let (row, column) = (at / 8, at % 8);
            let unit: f64 = [row, column].iter().map(|place| if *place > 5 { g } else { 1.0 }).product();
            let local = result["covariance"][row][column].as_f64().unwrap() + of_g(row) * of_g(column);
            assert!((number(found) - local / unit / (u[row] * u[column])).abs() < 1e-12, "{row}, {column}");
        }
        let document = Document::parse(xml).unwrap();
        let texts = |name: &str| -> Vec<&str> {
            let named = document.descendants().filter(|node| node.tag_name().name() == name);
            named.filter_map(|node| node.text()).collect()
        };
        let sum = |file: &str| programs::sha256(&programs::project(file));
        assert!(texts("value").contains(&sum(MOSCOW).as_str()) && texts("value").contains(&"7 <b>"), "{xml}");
        assert_eq!(texts("referralID"), ["SPS-2/0017/moscow-bmstu/1"]);
        assert_eq!(texts("reference"), [sum("docs/currents.csv")]);
        assert!(texts("content").contains(&"procedure <7> & 8"));
        let Some(verdict) = result.get("verdict") else {
            assert!(texts("conformity").is_empty() && texts("conformityXMLList").is_empty());
            continue;
        };
        let decision = |key: &str| {
            let rows = verdict["parameters"].as_array().unwrap();
            let row = rows.iter().find(|row| row["parameter"] == key).unwrap();
            match (row["guarded"].as_str().unwrap(), row["simple"].as_str().unwrap()) {
                ("undecided", "pass") => "conditionalPass",
                ("undecided", "fail") => "conditionalFail",
                ("pass", _) => "pass",
                _ => "fail",
            }
        };
        let keys = ["k_x k_xy k_yx k_y", "omega_0x omega_0y", "omega_g omega_k"];
        let expected = keys.map(|keys| keys.split(' ').map(decision).collect::<Vec<_>>().join(" "));
        assert_eq!(texts("conformityXMLList"), expected);
        let every = keys.join(" ");
        assert_eq!(texts("labelXMLList"), [&keys[..], &[every.as_str()]].concat());
        // Without these a reader could only multiply u by 2. The uncertainty of g adds degrees of freedom.
        let freedom = judged["results"][3]["values"].as_array().unwrap();
        for (key, found) in every.split(' ').zip(freedom) {
            let (due, found) = (result["degrees_of_freedom"][key].as_f64().unwrap(), number(found));
            assert!(
                found == due || found > due && key.starts_with("omega_") && !key.contains('0'),
                "{key}: {found} {due}"
            );
        }
        seen.extend(expected.iter().flat_map(|decisions| decisions.split(' ')).map(str::to_owned));
        let overall = texts("conformity")[0];
        match verdict["overall"].as_str().unwrap() {
            "undecided" => assert!(overall.starts_with("conditional"), "{overall}"),
            decided => assert_eq!(overall, decided),
        }
        // A value is between the limits, in its own unit, if simple acceptance passes it.
        let lists = texts("valueXMLList");
        for (group, keys) in keys.iter().enumerate() {
            let numbers =
                |place: usize| lists[4 * group + place].split(' ').map(|number| number.parse::<f64>().unwrap());
            let rows = verdict["parameters"].as_array().unwrap();
            for (risk, key) in numbers(3).zip(keys.split(' ')) {
                let row = rows.iter().find(|row| row["parameter"] == key).unwrap();
                let due = row.get("specific_risk").map(|risk| risk.as_f64().unwrap());
                assert!(due.map_or(risk.is_nan(), |due| due == risk), "{key}: {risk}, {due:?}");
            }
            for (((value, lower), upper), key) in numbers(0).zip(numbers(1)).zip(numbers(2)).zip(keys.split(' ')) {
                let simple = ["pass", "conditionalPass"].contains(&decision(key));
                assert_eq!((lower..=upper).contains(&value), simple, "{key}: {lower} {value} {upper}");
            }
        }
    }
    assert_eq!(Vec::from_iter(seen), ["conditionalFail", "conditionalPass", "fail", "pass"]);
}

/// Everything that is missing for a gyro is named, and what is no result of this gyro gets no certificate.
#[test]
fn a_gyro_without_facts_or_result_has_no_certificate() {
    let folder = folder();
    let (code, _, said) = calibrate(&folder, "format: \"dtg-dcc/1\"\n", None, &[]);
    assert_eq!(code, 1, "{said}");
    let missing = "country location number performed.from performed.to laboratory.city customer.name customer.city \
                   responsible temperature_c --gyro-serial";
    for key in missing.split(' ') {
        assert!(said.contains(&format!(" {key}: missing")), "{key}: {said}");
    }
    assert_eq!(said.matches(": missing").count(), missing.split(' ').count(), "{said}");
    for (option, count) in [("--date", 2), ("--temperature-c", 1)] {
        assert_eq!(said.matches(&format!("add it, or use {option}")).count(), count, "{option}: {said}");
    }
    let refused: [(&str, &str, &[&str], i32, &str); 5] = [
        ("", "", &["--drift"], 2, "--drift"),
        ("", "", &["--model", "general"], 1, "the paper's model"),
        ("{city", "{name: \"Another\", city", &[], 1, "laboratory.name: found Another"),
        ("method", "temperature_c: 22\nmethod", &[], 1, "temperature_c: found 22"),
        ("method", "performed: {from: \"2026-11-20\"}\nmethod", &[], 1, "performed: found 2026-11-20 to 2026-11-19"),
    ];
    for (from, to, more, expected, words) in refused {
        let administrative = OF_GYRO.replacen(from, to, 1);
        let (code, _, said) = calibrate(&folder, &administrative, None, &[&KNOWN[..], more].concat());
        assert_eq!(code, expected, "{said}");
        assert!(said.contains(words), "{words}: {said}");
    }
    // Readings of which one is far from the others.
    let currents = folder.read("docs/currents.csv");
    let row = currents.lines().rfind(|line| line.starts_with("1,")).unwrap();
    let (head, last) = row.rsplit_once(',').unwrap();
    let wrong = format!("{head},{}", last.parse::<f64>().unwrap() + 0.01);
    folder.change("docs/currents.csv", row, &wrong);
    let (code, _, said) = calibrate(&folder, OF_GYRO, None, &KNOWN);
    assert_eq!(code, 1, "{said}");
    assert!(said.contains("no DCC was written"), "{said}");
    assert!(!folder.path("gyro.xml").exists());
}
