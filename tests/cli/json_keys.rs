//! The keys of every JSON result and of a passport, in their order, as programs rely on them; and the numbers of
//! `show --format json` against those that PyYAML finds in the file.

use crate::programs;
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A folder with the files that the transcripts use, and the published test key.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        for name in ["stand.yaml", "allowed_signers"] {
            std::fs::copy(programs::project("tests/cmd/files").join(name), folder.path(name)).unwrap();
        }
        for name in ["here.yaml", "there.yaml"] {
            std::fs::copy(programs::project("tests/cmd/files/sites").join(name), folder.path(name)).unwrap();
        }
        std::fs::copy(programs::project("tests/keys/examples"), folder.path("key")).unwrap();
        // Git does not keep this mode, and a private key that others can read is refused.
        assert!(Command::new("chmod").arg("600").arg(folder.path("key")).status().unwrap().success());
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Standard output, and whether the exit code is the one expected.
    fn run(&self, arguments: &str, code: i32) -> String {
        let mut command = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
        let output = command.args(arguments.split(' ')).current_dir(self.0.path()).output().unwrap();
        let words = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments}\n{words}");
        String::from_utf8(output.stdout).unwrap()
    }

    fn json(&self, arguments: &str, code: i32) -> Keys {
        serde_json::from_str(&self.run(&format!("{arguments} --format json"), code)).unwrap()
    }
}

const SIGN: &str = "--key key --identity factory";
const TRUST: &str = "--trust allowed_signers --time 2026-11-20";
const PASSPORT: &str = "passports/SPS-2/0017/here-1.yaml";

/// A JSON value with the keys of its objects in the order of the text, which `serde_json` sorts.
#[derive(Debug, Clone, PartialEq)]
enum Keys {
    Object(Vec<(String, Keys)>),
    List(Vec<Keys>),
    Value(String),
}

impl Keys {
    fn at(&self, key: &str) -> &Keys {
        let Keys::Object(entries) = self else { panic!("{key}: no object") };
        entries.iter().find(|(name, _)| name == key).map_or_else(|| panic!("no key {key}"), |(_, value)| value)
    }

    fn items(&self) -> &[Keys] {
        let Keys::List(items) = self else { panic!("no list") };
        items
    }

    fn first(&self) -> &Keys {
        &self.items()[0]
    }

    /// The keys of an object, with blanks between them.
    fn names(&self) -> String {
        let Keys::Object(entries) = self else { panic!("no object") };
        entries.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(" ")
    }

    fn text(&self) -> &str {
        let Keys::Value(text) = self else { panic!("no value") };
        text
    }
}

impl<'de> Deserialize<'de> for Keys {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Any;
        impl<'de> Visitor<'de> for Any {
            type Value = Keys;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("JSON")
            }
            fn visit_unit<E>(self) -> Result<Keys, E> {
                Ok(Keys::Value("null".to_owned()))
            }
            fn visit_bool<E>(self, value: bool) -> Result<Keys, E> {
                Ok(Keys::Value(value.to_string()))
            }
            fn visit_u64<E>(self, value: u64) -> Result<Keys, E> {
                Ok(Keys::Value(value.to_string()))
            }
            fn visit_f64<E>(self, value: f64) -> Result<Keys, E> {
                Ok(Keys::Value(value.to_string()))
            }
            fn visit_str<E>(self, value: &str) -> Result<Keys, E> {
                Ok(Keys::Value(value.to_owned()))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Keys, A::Error> {
                let mut items = Vec::new();
                while let Some(item) = list.next_element()? {
                    items.push(item);
                }
                Ok(Keys::List(items))
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Keys, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Keys::Object(entries))
            }
        }
        deserializer.deserialize_any(Any)
    }
}

#[test]
fn verify_gives_every_check_in_its_order() {
    let folder = Folder::new();
    folder.run(&format!("issue stand.yaml --site here.yaml {SIGN} --issued-at 2026-11-03"), 0);
    let asked = "--issuer factory --serial 0017 --at 55.7658,37.6856";
    let verdicts = folder.json(&format!("verify {PASSPORT} stand.yaml {TRUST} {asked}"), 1);
    for verdict in verdicts.items() {
        assert_eq!(verdict.names(), "file valid id not_asked remarks checks");
        let not_asked: Vec<&str> = verdict.at("not_asked").items().iter().map(Keys::text).collect();
        assert_eq!(not_asked, ["revocation", "register"]);
        assert_eq!(verdict.at("remarks").items(), []);
        assert!(verdict.at("checks").items().iter().all(|check| check.names() == "name passed code detail"));
        let names: Vec<&str> = verdict.at("checks").items().iter().map(|check| check.at("name").text()).collect();
        let order = "grammar signature schema signer revocation recomputed in_force issuer stand place register";
        assert_eq!(names.join(" "), order);
    }
    let [good, bad] = verdicts.items() else { panic!("{verdicts:?}") };
    let of = |verdict: &Keys, key: &str| -> Vec<String> {
        verdict.at("checks").items().iter().map(|check| check.at(key).text().to_owned()).collect()
    };
    assert_eq!((good.at("valid").text(), good.at("id").text()), ("true", "SPS-2/0017/here/1"));
    // Expected: the contract; a check without a list or a register has no result, so it cannot have passed.
    assert_eq!(of(good, "passed").join(" "), "true true true true null true true true true true null");
    assert_eq!(of(good, "code").join(" "), "ok ok ok ok not_asked ok ok ok ok ok not_asked");
    assert_eq!((bad.at("valid").text(), bad.at("id").text()), ("false", "null"));
    assert_eq!(of(bad, "passed").iter().filter(|passed| *passed == "null").count(), 10);
    assert_eq!(of(bad, "code").iter().filter(|code| *code == "not_run").count(), 8);
}

/// Expected: the contract, one element per line in every verb with several inputs, refusals included.
#[test]
fn ndjson_has_a_line_for_each_input() {
    let folder = Folder::new();
    let stand = std::fs::read_to_string(folder.path("stand.yaml")).unwrap();
    std::fs::write(folder.path("other.yaml"), stand.replace("0017", "0018").replace("C-2026-0142", "C-2")).unwrap();
    let lines = |arguments: &str, code: i32| -> Vec<Keys> {
        let printed = folder.run(&format!("{arguments} --format ndjson"), code);
        printed.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    };
    let issue = format!("issue stand.yaml other.yaml --site here.yaml {SIGN} --issued-at 2026-11-03");
    let issued = lines(&issue, 0);
    let ids: Vec<&str> = issued.iter().map(|line| line.at("id").text()).collect();
    assert_eq!(ids, ["SPS-2/0017/here/1", "SPS-2/0018/here/1"]);
    let both = "passports/SPS-2/0017/here-1.yaml passports/SPS-2/0018/here-1.yaml";
    let verdicts = lines(&format!("verify {both} stand.yaml {TRUST}"), 1);
    let valid: Vec<&str> = verdicts.iter().map(|line| line.at("valid").text()).collect();
    assert_eq!(valid, ["true", "true", "false"]);
    // The same elements as in the list.
    assert_eq!(folder.json(&format!("verify {both} stand.yaml {TRUST}"), 1).items(), verdicts);
    let register = lines(&format!("register passports {TRUST}"), 0);
    assert_eq!(folder.json(&format!("register passports {TRUST}"), 0).at("stands").items(), register);
    assert_eq!(register.len(), 2);
    for (verb, code) in [("show", 1), ("export --to json", 1)] {
        let shown = lines(&format!("{verb} {both} stand.yaml {TRUST}"), code);
        assert_eq!(shown.len(), 3, "{verb}");
    }
    let refused = lines(&format!("verify {PASSPORT} --trust nowhere"), 2);
    assert_eq!((refused.len(), refused[0].names().as_str()), (1, "error"));
    let withdrawn =
        lines(&format!("revoke SPS-2/*/here/* --reason x {SIGN} --trust allowed_signers --passports passports"), 0);
    assert_eq!(withdrawn.len(), 2);
}

#[test]
fn issue_and_reissue_report_alike() {
    let folder = Folder::new();
    let issue = format!("issue stand.yaml --site here.yaml {SIGN} --issued-at 2026-11-03");
    for state in ["issued", "unchanged"] {
        let report = folder.json(&issue, 0);
        assert_eq!(report.first().names(), "id state file sha256 noise_growth");
        assert_eq!(report.first().at("state").text(), state);
        assert_eq!(report.first().at("noise_growth").names(), "k omega_0 omega_g omega_k");
    }
    let reissue = format!("reissue {PASSPORT} --same-content --reason x {SIGN} {TRUST} --issued-at 2026-11-20");
    assert_eq!(folder.json(&reissue, 0).first().names(), "id state file sha256 noise_growth");
    let refused = folder.json(&format!("{reissue} --valid-until 2027-01-01"), 1);
    assert_eq!(refused.first().names(), "id state reason");
    assert_eq!(refused.first().at("state").text(), "refused");
}

/// The keys of a passport with everything in it, in the order in which the format has them.
#[test]
fn a_plan_has_its_keys() {
    let folder = Folder::new();
    let found = folder.json("plan --site here.yaml --frame-axis east,north", 0);
    assert_eq!(
        found.names(),
        "criterion value frame_axis_azimuth_deg readings order standard_uncertainty paper worse has_matrices \
         has_general_model common_errors drift_over_tolerance_per_deg_per_h gravity_over_tolerance turn_on_over_tolerance \
         beyond_range exhaustive not_stated"
    );
    assert!(found.at("readings").items().iter().all(|at| at.names() == "theta_deg phi_deg visits"));
    assert_eq!(found.at("order").items().len(), 8);
    assert!(found.at("order").items().iter().all(|visit| visit.items().len() == 2));
    let parameters = "k_deg_per_h_per_ma omega0_deg_per_h omega_g_deg_per_h_per_g omega_k_deg_per_h_per_g";
    assert_eq!(found.at("standard_uncertainty").names(), parameters);
    assert_eq!(found.at("paper").names(), "value standard_uncertainty");
    assert_eq!(found.at("paper").at("standard_uncertainty").names(), parameters);
    let effect = "change largest_over_tolerance largest_residual_deg_per_h residuals_over_noise";
    assert_eq!(found.at("common_errors").first().names(), format!("error size unit {effect} paper"));
    assert_eq!(found.at("common_errors").first().at("paper").names(), effect);
    // Σ (u/T)², T the tolerances of the GVK-6.
    let number = |of: &Keys| of.text().parse::<f64>().unwrap();
    let sum = |found: &Keys| {
        let u = found.at("standard_uncertainty");
        let k = u.at("k_deg_per_h_per_ma");
        let [kx, kxy, kyx, ky] = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| number(&k.items()[i].items()[j]));
        let omega0 = u.at("omega0_deg_per_h").items();
        let drifts = [&omega0[0], &omega0[1], u.at("omega_g_deg_per_h_per_g"), u.at("omega_k_deg_per_h_per_g")];
        let main = [kx, ky].map(|u| u / 95.0 / 0.0005);
        let cross = [kxy, kyx].map(|u| u / 9.5 / 0.005);
        let drifts = drifts.map(|u| number(u) / 0.01);
        main.iter().chain(&cross).chain(&drifts).map(|share| share * share).sum::<f64>()
    };
    for found in [&found, found.at("paper")] {
        assert!((sum(found) / number(found.at("value")) - 1.0).abs() < 1e-12);
    }
    let found = folder.json("plan --site here.yaml --stand stand.yaml --readings 9 --criterion worst", 0);
    assert!(found.at("readings").items().iter().all(|at| at.names() == "theta_deg phi_deg i j visits"));
    assert!(!found.names().contains("paper"), "8 does not divide 9");
    let visits: u64 =
        found.at("readings").items().iter().map(|at| at.at("visits").text().parse::<u64>().unwrap()).sum();
    assert_eq!((visits, found.at("order").items().len()), (9, 9));
}

#[test]
fn show_has_the_keys_of_the_passport_in_their_order() {
    let folder = Folder::new();
    folder.run(&format!("issue stand.yaml --site here.yaml {SIGN} --issued-at 2026-11-03"), 0);
    folder.run(&format!("reissue {PASSPORT} --same-content --reason x {SIGN} {TRUST} --issued-at 2026-11-20"), 0);
    let passport = folder.json(&format!("show passports/SPS-2/0017/here-2.yaml {TRUST}"), 0);
    assert_eq!(
        passport.names(),
        "format passport stand certificate datum positions site earth matrices vectors self_check verified sha256 \
         checks"
    );
    assert_eq!(passport.at("checks").first().names(), "name passed code detail");
    let expected = [
        ("passport", "id revision issued_at issuer valid_until issued_with reissued_from supersedes"),
        ("stand", "manufacturer model serial configuration name"),
        (
            "certificate",
            "number issued performed valid_until valid_until_basis laboratory method traceability temperature_c \
             temperature_range_c repeatability_arcsec repeatability_degrees_of_freedom common_platform_arcsec \
             common_base_arcsec",
        ),
        ("datum", "level azimuth gyro_seat"),
        ("site", "id latitude_deg longitude_deg height_m deflection_arcsec azimuth_mark uncertainty"),
        (
            "earth",
            "rate_deg_per_h latitude_deg horizontal_deg_per_h vertical_deg_per_h gravity_m_per_s2 valid_radius_m \
             valid_within_deg_per_h azimuth_deg azimuth_u_arcsec",
        ),
        ("matrices", "delta b_deg_per_h c_deg_per_h_per_g n1 n2 n2_inverse omega1_deg_per_h omega2_deg_per_h"),
        ("self_check", "currents k_deg_per_h_per_ma omega0_deg_per_h omega_g_deg_per_h_per_g omega_k_deg_per_h_per_g"),
    ];
    for (key, names) in expected {
        assert_eq!(passport.at(key).names(), names, "{key}");
    }
    assert_eq!(passport.at("passport").at("reissued_from").names(), "id sha256 reason changed");
    let position = "i j theta_deg phi_deg alpha_arcsec beta_arcsec gamma_arcsec u_alpha_arcsec u_beta_arcsec \
                    u_gamma_arcsec";
    assert_eq!(passport.at("positions").first().names(), position);
    let vector = "i j specific_force_g specific_force_z_g omega_deg_per_h";
    assert_eq!(passport.at("vectors").first().names(), vector);
    assert_eq!(passport.at("self_check").at("currents").first().names(), "i j jx_ma jy_ma");
    assert_eq!(passport.at("site").at("deflection_arcsec").names(), "xi eta u");
    assert_eq!(
        passport.at("site").at("azimuth_mark").names(),
        "name latitude_deg longitude_deg pillar_latitude_deg pillar_longitude_deg position_u_m"
    );
    assert_eq!(passport.at("site").at("uncertainty").names(), "latitude_arcsec azimuth_arcsec level_arcsec");
}

/// Compares the YAML of a passport, the signature aside, with its JSON: types, keys and their order, every binary64.
const COMPARE: &str = r#"
import json, sys, yaml
shown = json.load(open(sys.argv[2], encoding="utf-8"))
signed = yaml.safe_load(open(sys.argv[1], encoding="utf-8"))
del signed["signature"]
# What the verification found comes after the keys of the file.
assert [shown.popitem()[0] for _ in range(3)] == ["checks", "sha256", "verified"]
numbers = 0
def same(a, b, at):
    global numbers
    assert type(a) is type(b), (at, a, b)
    if isinstance(a, dict):
        assert list(a) == list(b), (at, list(a), list(b))
        for key in a: same(a[key], b[key], f"{at}.{key}")
    elif isinstance(a, list):
        assert len(a) == len(b), at
        for index, (x, y) in enumerate(zip(a, b)): same(x, y, f"{at}[{index}]")
    elif isinstance(a, float):
        numbers += 1
        assert a.hex() == b.hex(), (at, a.hex(), b.hex())
    else:
        assert a == b, (at, a, b)
same(signed, shown, "")
print(numbers)
"#;

#[test]
fn show_as_json_has_the_numbers_that_pyyaml_finds() {
    let folder = Folder::new();
    let cheap = programs::project("passports/SPS-1/0203/stand.yaml").display().to_string();
    folder
        .run(&format!("issue stand.yaml {cheap} --site here.yaml --site there.yaml {SIGN} --issued-at 2026-11-05"), 0);
    for name in ["SPS-2/0017/here-1", "SPS-2/0017/there-1", "SPS-1/0203/here-1", "SPS-1/0203/there-1"] {
        let shown = folder.run(&format!("show passports/{name}.yaml {TRUST} --format json"), 0);
        std::fs::write(folder.path("shown.json"), shown).unwrap();
        let numbers = compared(&folder.path(&format!("passports/{name}.yaml")), &folder.path("shown.json"));
        assert!(numbers > 150, "{name}: only {numbers} numbers");
    }
}

fn compared(yaml: &Path, json: &Path) -> usize {
    let mut python = programs::python();
    python.args(["-c", COMPARE]).args([yaml, json]);
    programs::output(python).trim().parse().unwrap()
}
