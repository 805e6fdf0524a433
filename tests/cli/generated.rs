//! Manual pages and JSON Schemas as the program writes them; tests/generated.rs compares them with the sources.

use assert_cmd::Command;
use serde_json::{Value, json};

fn program(arguments: &[&str]) -> Vec<u8> {
    let output = Command::cargo_bin("dtg-passport").unwrap().args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

/// Expected: man(7) and groff_man(7): .SH, .nf and .fi, \- for a hyphen that can be copied, and \e for a backslash.
#[test]
fn commands_of_a_page_are_not_filled() {
    let folder = tempfile::tempdir().unwrap();
    program(&["man", folder.path().to_str().unwrap()]);
    let pages =
        std::fs::read_dir(&folder).unwrap().map(|entry| std::fs::read_to_string(entry.unwrap().path()).unwrap());
    let pages: Vec<String> = pages.collect();
    assert!(pages.len() > 25, "{}", pages.len());
    for page in &pages {
        assert!(page.starts_with(".nh\n") && page.contains("\n.TH dtg-passport") && !page.contains("EXTRA"), "{page}");
        assert!(page.contains(".SH \"EXIT STATUS\"\n.nf\n  0  done"), "{page}");
    }
    let page = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let due = ".SH EXAMPLES\n.nf\n  dtg\\-passport verify moscow\\-bmstu\\-1.yaml \\-\\-trust allowed_signers \\e\n    \
               \\-\\-serial 0017 \\-\\-at 55.7660,37.6850\n";
    assert!(page("dtg-passport-verify.1").contains(due));
    assert!(page("dtg-passport-render.1").contains("\\(aqpassports/SPS\\-2/*/*.yaml\\(aq"));
}

/// Expected: the rules of docs/formats.md, that a type has one tolerance of K_xy and K_yx, and a site one latitude.
#[test]
fn of_two_keys_that_exclude_each_other_a_schema_requires_one() {
    let one_of = |keys: [&str; 2]| json!(keys.map(|key| json!({"required": [key]})));
    let tolerances = one_of(["k_cross_percent", "k_cross_deg_per_h_per_ma"]);
    let latitudes = one_of(["latitude_deg", "astronomic_latitude_deg"]);
    let formats =
        "stand,site,gyro,laboratory,dcc,passport,register-file,verify,register,calibrate,certify,plan,history";
    let schemas: Value = serde_json::from_slice(&program(&["schema", formats])).unwrap();
    assert_eq!(schemas.as_object().unwrap().len(), 13);
    // Of a result as of a format: tests/cmd compares it with what the verb prints.
    assert_eq!(schemas["verify"].pointer("/items/properties/valid/type"), Some(&json!("boolean")));
    assert_eq!(schemas["gyro"].pointer("/$defs/Tolerance/oneOf"), Some(&tolerances));
    assert_eq!(schemas["site"].pointer("/oneOf"), Some(&latitudes));
    assert_eq!(schemas["passport"].pointer("/$defs/Tolerance/oneOf"), Some(&tolerances));
    assert_eq!(schemas["passport"].pointer("/$defs/Site/oneOf"), Some(&latitudes));
}
