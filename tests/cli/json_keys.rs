//! The keys of JSON results in their order, as programs rely on them; keys and numbers of `show --format json` against those that
//! PyYAML finds in the file.

use crate::place::Place;
use crate::programs;
use serde_json::{Value, json};

/// A folder with the files that the transcripts use, and the published test key.
fn folder() -> Place {
    Place::of(&[
        ("tests/cmd/files/stand.yaml", "stand.yaml"),
        ("tests/cmd/files/allowed_signers", "allowed_signers"),
        ("tests/cmd/files/sites/here.yaml", "here.yaml"),
        ("tests/cmd/files/sites/there.yaml", "there.yaml"),
        (programs::KEY, "key"),
    ])
}

const SIGN: &str = "--key key --identity factory";
const TRUST: &str = "--trust allowed_signers --time 2026-11-20";
const PASSPORT: &str = "passports/SPS-2/0017/here-1.yaml";

/// The keys of an object in the order of the text, with blanks between them.
fn names(object: &Value) -> String {
    object.as_object().unwrap().keys().map(String::as_str).collect::<Vec<_>>().join(" ")
}

/// A key of each element of a list.
fn each(list: &Value, key: &str) -> Vec<Value> {
    list.as_array().unwrap().iter().map(|element| element[key].clone()).collect()
}

#[test]
fn verify_gives_every_check_in_its_order() {
    let folder = folder();
    folder.good(&format!("issue stand.yaml --site here.yaml {SIGN} --issued-at 2026-11-03"));
    let asked = "--issuer factory --serial 0017 --at 55.7658,37.6856";
    let verdicts = folder.json(&format!("verify {PASSPORT} stand.yaml {TRUST} {asked}"), 1);
    for verdict in verdicts.as_array().unwrap() {
        assert_eq!(names(verdict), "file valid id not_asked remarks checks");
        assert_eq!((&verdict["not_asked"], &verdict["remarks"]), (&json!(["revocation", "register"]), &json!([])));
        assert!(verdict["checks"].as_array().unwrap().iter().all(|check| names(check) == "name passed code detail"));
        let order = "grammar signature schema signer revocation recomputed in_force issuer stand place register";
        assert_eq!(each(&verdict["checks"], "name"), order.split(' ').collect::<Vec<_>>());
    }
    let (good, bad) = (&verdicts[0], &verdicts[1]);
    assert_eq!((&good["valid"], &good["id"]), (&json!(true), &json!("SPS-2/0017/here/1")));
    // Expected: the contract; a check without a list or a register has no result, so it cannot have passed.
    for (place, (passed, code)) in each(&good["checks"], "passed").iter().zip(each(&good["checks"], "code")).enumerate()
    {
        let due =
            if [4, 10].contains(&place) { (&Value::Null, json!("not_asked")) } else { (&json!(true), json!("ok")) };
        assert_eq!((passed, code), due, "{place}");
    }
    assert_eq!((&bad["valid"], &bad["id"]), (&json!(false), &Value::Null));
    assert_eq!(each(&bad["checks"], "passed").iter().filter(|passed| passed.is_null()).count(), 10);
    assert_eq!(each(&bad["checks"], "code").iter().filter(|code| *code == "not_run").count(), 8);
}

/// Expected: the contract, one element per line in every verb with several inputs, refusals included.
#[test]
fn ndjson_has_a_line_for_each_input() {
    let folder = folder();
    let stand = folder.read("stand.yaml");
    folder.write("other.yaml", stand.replace("0017", "0018").replace("C-2026-0142", "C-2"));
    let lines = |arguments: &str, code: i32| -> Value {
        let (found, printed, said) = folder.said(&format!("{arguments} --format ndjson"));
        assert_eq!(found, code, "{arguments}\n{said}");
        printed.lines().map(|line| serde_json::from_str::<Value>(line).unwrap()).collect()
    };
    let issue = format!("issue stand.yaml other.yaml --site here.yaml {SIGN} --issued-at 2026-11-03");
    assert_eq!(each(&lines(&issue, 0), "id"), ["SPS-2/0017/here/1", "SPS-2/0018/here/1"]);
    let both = "passports/SPS-2/0017/here-1.yaml passports/SPS-2/0018/here-1.yaml";
    let verdicts = lines(&format!("verify {both} stand.yaml {TRUST}"), 1);
    assert_eq!(each(&verdicts, "valid"), [true, true, false]);
    // The same elements as in the list.
    assert_eq!(folder.json(&format!("verify {both} stand.yaml {TRUST}"), 1), verdicts);
    let register = lines(&format!("register passports {TRUST}"), 0);
    assert_eq!(folder.json(&format!("register passports {TRUST}"), 0)["stands"], register);
    assert_eq!(register.as_array().unwrap().len(), 2);
    for verb in ["show", "export --to json"] {
        let shown = lines(&format!("{verb} {both} stand.yaml {TRUST}"), 1);
        assert_eq!(shown.as_array().unwrap().len(), 3, "{verb}");
    }
    let refused = lines(&format!("verify {PASSPORT} --trust nowhere"), 2);
    assert_eq!((refused.as_array().unwrap().len(), names(&refused[0]).as_str()), (1, "error"));
    let withdrawn =
        lines(&format!("revoke SPS-2/*/here/* --reason x {SIGN} --trust allowed_signers --passports passports"), 0);
    assert_eq!(withdrawn.as_array().unwrap().len(), 2);
}

#[test]
fn issue_and_reissue_report_alike() {
    let folder = folder();
    let issue = format!("issue stand.yaml --site here.yaml {SIGN} --issued-at 2026-11-03");
    for state in ["issued", "unchanged"] {
        let report = folder.json(&issue, 0);
        assert_eq!(names(&report[0]), "id state file sha256 noise_growth");
        assert_eq!(report[0]["state"], state);
        assert_eq!(names(&report[0]["noise_growth"]), "k omega_0 omega_g omega_k");
    }
    let reissue = format!("reissue {PASSPORT} --same-content --reason x {SIGN} {TRUST} --issued-at 2026-11-20");
    assert_eq!(names(&folder.json(&reissue, 0)[0]), "id state file sha256 noise_growth");
    let refused = folder.json(&format!("{reissue} --valid-until 2027-01-01"), 1);
    assert_eq!((names(&refused[0]).as_str(), &refused[0]["state"]), ("id state reason", &json!("refused")));
}

/// Compares the YAML of a passport, the signature aside, with its JSON: types, keys and their order, every binary64.
const COMPARE: &str = r#"
import json, sys, yaml
shown = json.load(open(sys.argv[2], encoding="utf-8"))
signed = yaml.safe_load(open(sys.argv[1], encoding="utf-8"))
del signed["signature"]
# What the verification found comes after the keys of the file.
assert [shown.popitem()[0] for _ in range(5)] == ["checks", "remarks", "not_asked", "sha256", "verified"]
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
    let folder = folder();
    let cheap = programs::project("passports/SPS-1/0203/stand.yaml").display().to_string();
    folder.good(&format!("issue stand.yaml {cheap} --site here.yaml --site there.yaml {SIGN} --issued-at 2026-11-05"));
    for name in ["SPS-2/0017/here-1", "SPS-2/0017/there-1", "SPS-1/0203/here-1", "SPS-1/0203/there-1"] {
        folder.write("shown.json", folder.good(&format!("show passports/{name}.yaml {TRUST} --format json")));
        let files = [format!("passports/{name}.yaml"), "shown.json".to_owned()].map(|name| folder.path(name));
        let compared = programs::output(programs::python().args(["-c", COMPARE]).args(files));
        let numbers: usize = compared.trim().parse().unwrap();
        assert!(numbers > 150, "{name}: only {numbers} numbers");
    }
}
