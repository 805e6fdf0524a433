//! The recipes of the documentation for other tools, taken from its pages: an XML signature with `xmlsec1`, a time stamp
//! with `openssl ts`. The authorities are made by `openssl` for each test.

use crate::programs;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Runs a script in a folder; returns whether it succeeded, and all that it printed.
fn shell(folder: &Path, script: &str, variables: &[(&str, &str)]) -> (bool, String) {
    let mut shell = programs::on_path("sh");
    let output = shell.args(["-e", "-c", script]).current_dir(folder).envs(variables.iter().copied()).output().unwrap();
    let words = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    (output.status.success(), words.concat())
}

/// Returns the blocks `sh` of a section of a page.
fn blocks(page: &str, section: &str) -> Vec<String> {
    let page = fs::read_to_string(programs::project(page)).unwrap();
    let (_, section) = page.split_once(&format!("## {section}\n")).unwrap();
    let section = section.split("\n## ").next().unwrap();
    section.split("```sh\n").skip(1).map(|block| block.split("```").next().unwrap().to_owned()).collect()
}

/// An authority `ca.pem`, and `own.pem` with `own.key`, certified by it for `usage`; another authority, `other.pem`.
fn certified(folder: &Path, usage: &str) {
    let script = format!(
        "for name in ca other; do
            openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 2 -subj /CN=$name \
                -keyout $name.key -out $name.pem
        done
        openssl req -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -subj /CN=own -keyout own.key -out own.csr
        printf '{usage}' > usage
        openssl x509 -req -in own.csr -CA ca.pem -CAkey ca.key -CAcreateserial -days 1 -extfile usage -out own.pem"
    );
    let (good, words) = shell(folder, &script, &[]);
    assert!(good, "{words}");
}

#[test]
fn a_dcc_is_signed_and_verified_with_an_xml_tool() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    certified(folder, "keyUsage = digitalSignature\n");
    fs::create_dir(folder.join("docs")).unwrap();
    fs::copy(programs::project("docs/signature.xml"), folder.join("docs/signature.xml")).unwrap();
    let mut export = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
    export.args(["export", "passports/SPS-2/0017/moscow-bmstu-1.yaml", "--to", "dcc", "--time", "2026-11-20"]);
    export.args(["--administrative", "docs/dcc.yaml", "--trust", "docs/allowed_signers", "--out"]).arg(folder);
    programs::output(export.current_dir(programs::project("")));
    let [sign, verify] = &blocks("docs/dcc.md", "Sign a DCC")[..] else { panic!("two blocks") };
    let made = [("DCC", "C-2026-0142.xml"), ("KEY", "own.key"), ("CERTIFICATE", "own.pem")];
    let (good, words) = shell(folder, sign, &made);
    assert!(good, "{words}");
    let holds = |authority| shell(folder, verify, &[("AUTHORITY", authority)]);
    let (good, words) = holds("ca.pem");
    assert!(good, "{words}");
    assert!(!holds("other.pem").0);
    let signed = fs::read_to_string(folder.join("signed.xml")).unwrap();
    // PTB's rules object to empty elements, which every XML signature has, and to nothing else.
    let mut python = programs::python();
    python.arg(programs::project("tests/readers/certificates.py")).arg(folder.join("signed.xml"));
    let judged: serde_json::Value = serde_json::from_str(&programs::output(python)).unwrap();
    let findings = judged[0]["findings"].as_array().unwrap();
    assert!(findings.iter().all(|found| found.as_str().unwrap().contains("xmldsig#}Signature[1]")), "{findings:?}");
    let number = signed.replacen("C-2026-0142", "C-2026-0143", 1);
    let unsigned = fs::read_to_string(folder.join("unsigned.xml")).unwrap();
    for altered in [number, signed.replacen("URI=\"\"", "URI=\"#x\"", 1), unsigned] {
        assert_ne!(altered, signed);
        fs::write(folder.join("signed.xml"), altered).unwrap();
        assert!(!holds("ca.pem").0);
    }
}

#[test]
fn a_passport_is_stamped_and_the_stamp_verified() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    certified(folder, "extendedKeyUsage = critical,timeStamping\n");
    fs::copy(programs::project("docs/self_check.yaml"), folder.join("passport.yaml")).unwrap();
    let [ask, verify] = &blocks("docs/verifying.md", "Stamp a passport")[..] else { panic!("two blocks") };
    let (good, words) = shell(folder, ask, &[("PASSPORT", "passport.yaml")]);
    assert!(good, "{words}");
    // What the authority does.
    let authority = "printf 01 > serial
        printf '%s\\n' [tsa] default_tsa=one [one] serial=serial signer_cert=own.pem signer_key=own.key certs=ca.pem \
            signer_digest=sha256 default_policy=1.2.3.4 digests=sha256 > tsa.cnf
        openssl ts -reply -config tsa.cnf -queryfile passport.tsq -out passport.tsr";
    let (good, words) = shell(folder, authority, &[]);
    assert!(good, "{words}");
    let holds = |authority| shell(folder, verify, &[("PASSPORT", "passport.yaml"), ("AUTHORITY", authority)]);
    let (good, words) = holds("ca.pem");
    assert!(good && words.contains("Verification: OK") && words.contains("Time stamp: "), "{words}");
    assert!(!holds("other.pem").0);
    let passport = fs::read_to_string(folder.join("passport.yaml")).unwrap();
    fs::write(folder.join("passport.yaml"), passport.replacen("25571.0", "25572.0", 1)).unwrap();
    assert!(!holds("ca.pem").0);
}
