//! `docs/Verify.java`, which was written from the documentation alone, against this program: both must give the same
//! answer on text, signature and signer. Needs a JDK (Debian: default-jdk-headless).

use crate::{Bench, NAMESPACE, SIGNATURE_LINE, armored, joined, project, run};
use base64ct::{Base64, Encoding as _};
use dtg_passport::passport::{Question, Trust, verify};
use dtg_passport::trust::{AllowedSigners, SigningKey};
use std::fs;
use std::path::Path;
use std::process::Command;

const ISSUER: &str = "examples@dtg-passport.test";

/// What both are asked, and whether it is good.
struct Case {
    name: String,
    file: Vec<u8>,
    signers: String,
    due: bool,
}

impl Case {
    fn new(name: &str, file: impl Into<Vec<u8>>, signers: &str, due: bool) -> Self {
        Self { name: name.to_owned(), file: file.into(), signers: signers.to_owned(), due }
    }

    /// Returns the library's answer.
    fn is_good(&self) -> bool {
        let Ok(signers) = AllowedSigners::parse("signers", self.signers.as_bytes()) else { return false };
        let question = Question::at("2026-12-01T00:00:00Z".parse().unwrap());
        let answer = verify(&self.name, &self.file, &Trust::of(signers), &question);
        let asked = |name: &str| ["grammar", "signature", "signer"].contains(&name);
        answer.checks().iter().filter(|check| asked(check.name.as_str())).all(|check| check.passed() == Some(true))
    }
}

/// Returns the file with the block of its signature changed, armored as OpenSSH does.
fn with_block(file: &str, change: impl FnOnce(&mut Vec<u8>)) -> String {
    let (payload, armor) = file.split_once(SIGNATURE_LINE).unwrap();
    let base64: String = armor.lines().map(str::trim).filter(|line| !line.starts_with('-')).collect();
    let mut block = Base64::decode_vec(&base64).unwrap();
    change(&mut block);
    joined(payload, &armored(&block))
}

/// Returns a passport signed by a token in software, and its line of allowed signers.
fn by_token(bench: &Bench, payload: &str) -> (String, String) {
    bench.with_token(&["-q", "-t", "ed25519-sk", "-N", "", "-C", "token", "-f", "token"], b"");
    let armor = bench.with_token(&["-Y", "sign", "-q", "-f", "token", "-n", NAMESPACE], payload.as_bytes());
    (joined(payload, &armor), format!("{ISSUER} {}", bench.read("token.pub")))
}

/// Good passports, and what only their lines of allowed signers decide.
fn good_and_their_signers(bench: &Bench) -> Vec<Case> {
    let signers = project("docs/allowed_signers");
    let passports = [
        "passports/SPS-1/0203/beijing-nim-1.yaml",
        "passports/SPS-1/0203/moscow-bmstu-1.yaml",
        "passports/SPS-2/0017/beijing-nim-1.yaml",
        "passports/SPS-2/0017/moscow-bmstu-1.yaml",
        "docs/self_check.yaml",
        "tests/golden/passport-1-gvk-6.yaml",
    ];
    let mut cases: Vec<Case> = passports.iter().map(|path| Case::new(path, project(path), &signers, true)).collect();
    let passport = project(passports[3]);
    let (payload, _) = passport.split_once(SIGNATURE_LINE).unwrap();
    let at = payload.split_once("issued_at: \"").unwrap().1;
    let digits: String = at[..20].chars().filter(char::is_ascii_digit).collect();
    let second: u64 = digits.parse().unwrap();
    let (_, key) = signers.split_once("ssh-ed25519 ").unwrap();
    let key = format!("ssh-ed25519 {}", key.trim());
    for (line, due) in [
        (format!("{ISSUER} {key}"), true),
        (format!("{ISSUER} {key} a comment"), true),
        (format!("\t{ISSUER}  \t{key}\r\n"), true),
        (format!("# a comment\n\n{ISSUER} ssh-rsa AAAAB3NzaC1yc2EAAAADAQABAAAAAQA=\n{ISSUER} {key}"), true),
        (format!("\"{ISSUER}\" {key}"), true),
        (format!("other@example.org,{ISSUER} {key}"), true),
        (format!("*@dtg-passport.test {key}"), true),
        (format!("example?@dtg-passport.tes? {key}"), true),
        (format!("* {key}"), true),
        (format!("*,!{ISSUER} {key}"), false),
        (format!("!examples*,* {key}"), false),
        (format!("!{ISSUER} {key}"), false),
        (format!("EXAMPLES@dtg-passport.test {key}"), false),
        (format!("examples@dtg-passport.tes {key}"), false),
        (format!("examples@dtg-passport.test.org {key}"), false),
        (format!("example?s@dtg-passport.test {key}"), false),
        (format!("examples@dtg.passport.test {key}"), false),
        (format!("{ISSUER} namespaces=\"dtg-passport\" {key}"), true),
        (format!("{ISSUER} namespaces=\"git,dtg-*\" {key}"), true),
        (format!("{ISSUER} namespaces=\"dtg-register\" {key}"), false),
        (format!("{ISSUER} namespaces=\"*,!dtg-passport\" {key}"), false),
        (format!("{ISSUER} valid-after=\"{second}Z\" {key}"), true),
        (format!("{ISSUER} valid-before=\"{second}Z\" {key}"), true),
        (format!("{ISSUER} valid-after=\"{}Z\" {key}", second + 1), false),
        (format!("{ISSUER} valid-before=\"{}Z\" {key}", second - 1), false),
        (format!("{ISSUER} namespaces=\"dtg-passport\",valid-after=\"2026010100Z\" {key}"), false),
        (format!("{ISSUER} valid-after=\"20260101Z\",valid-before=\"202701010000Z\" {key}"), true),
        (format!("{ISSUER} valid-before=\"20260101Z\" {key}\n{ISSUER} valid-after=\"20260101Z\" {key}"), true),
        (format!("{ISSUER} valid-after=\"20260101\" {key}"), false),
        (format!("{ISSUER} cert-authority {key}"), false),
        (format!("{ISSUER} no-touch-required {key}"), false),
        (format!("# {ISSUER} {key}"), false),
        (format!("{ISSUER} {}", SigningKey::generate().unwrap().public_key().to_openssh()), false),
        (String::new(), false),
    ] {
        cases.push(Case::new(&line, passport.clone(), &line, due));
    }
    let (signed, signers) = by_token(bench, payload);
    cases.push(Case::new("a token", signed.clone(), &signers, true));
    let end = with_block(&signed, |block| *block.last_mut().unwrap() ^= 1);
    cases.push(Case::new("another counter of the token", end, &signers, false));
    let flags = with_block(&signed, |block| {
        let place = block.len() - 5;
        block[place] ^= 1;
    });
    cases.push(Case::new("other flags of the token", flags, &signers, false));
    cases
}

/// Texts that somebody signed whose key is trusted, in a form that no signed text has.
fn rightly_signed(payload: &str) -> Vec<Case> {
    let key = SigningKey::generate().unwrap();
    let signers = format!("{ISSUER} {}\n", key.public_key().to_openssh());
    let signed_as =
        |namespace: &str, payload: &str| joined(payload, &key.sign(namespace, payload.as_bytes()).unwrap().to_armor());
    let signed = |payload: &str| signed_as(NAMESPACE, payload);
    let changed = |old: &str, new: &str| {
        assert!(payload.contains(old), "{old}");
        signed(&payload.replacen(old, new, 1))
    };
    let mut cases = vec![Case::new("signed again", signed(payload), &signers, true)];
    for (name, file) in [
        ("another namespace", signed_as("dtg-register", payload)),
        ("an anchor", changed("theta_deg: 0.0", "theta_deg: &a 0.0")),
        ("an alias", changed("theta_deg: 0.0", "theta_deg: *a")),
        ("a merge key", changed("datum:\n", "datum:\n  <<: {level: \"x\"}\n")),
        ("a block scalar", changed("datum:\n", "datum: |\n")),
        ("single quotes", changed("\"SPS-2\"", "'SPS-2'")),
        ("a plain text", changed("\"SPS-2\"", "SPS-2")),
        ("a bidirectional override", changed("\"SPS-2\"", "\"SPS\u{202E}-2\"")),
        ("a zero-width space", changed("\"SPS-2\"", "\"SPS\u{200B}-2\"")),
        ("a character outside the basic plane", changed("\"SPS-2\"", "\"SPS\u{1F600}-2\"")),
        ("a combining accent", changed("\"SPS-2\"", "\"SPS\u{301}-2\"")),
        ("another escape", changed("\"SPS-2\"", "\"SPS\\n-2\"")),
        ("a string on two lines", changed("\"SPS-2\"", "\"SPS\n  -2\"")),
        ("letters in a comment", changed("# Passport", "# \u{41F}assport")),
        ("CR LF", signed(&payload.replace('\n', "\r\n"))),
        ("a tab", changed("  serial: ", "  serial:\t")),
        ("an exponent in capitals", changed("theta_deg: 90.0", "theta_deg: 9.0E+01")),
        ("no blank in a flow mapping", changed("{i: 1, j: 1,", "{i: 1,j: 1,")),
        ("an open bracket", changed("delta: [[", "delta: [[[")),
        ("a document marker", signed(&format!("---\n{payload}"))),
        ("a byte order mark", signed(&format!("\u{FEFF}{payload}"))),
        ("a second signature", signed(&signed(payload))),
        ("a later format", changed("dtg-passport/1", "dtg-passport/2")),
        ("nothing", signed("")),
    ] {
        cases.push(Case::new(name, file, &signers, false));
    }
    cases
}

/// What somebody without a key makes of a passport, of its text and of the block of its signature, which is not all signed.
fn altered(good: &str, signers: &str) -> Vec<Case> {
    let (payload, _) = good.split_once(SIGNATURE_LINE).unwrap();
    let mut cases: Vec<Case> = Vec::new();
    let mut add = |name: &str, file: Vec<u8>| {
        if file != good.as_bytes() {
            cases.push(Case::new(name, file, signers, false));
        }
    };
    let mut length = 0;
    with_block(good, |block| length = block.len());
    for bit in 0..8 * length {
        add(
            &format!("bit {bit} of the block"),
            with_block(good, |block| block[bit / 8] ^= 1 << (bit % 8)).into_bytes(),
        );
    }
    for at in 0..=length {
        add(&format!("a block of {at} bytes"), with_block(good, |block| block.resize(at, 0)).into_bytes());
        add(&format!("a byte at {at} of the block"), with_block(good, |block| block.insert(at, 0)).into_bytes());
    }
    for at in payload.len()..good.len() {
        add(&format!("no byte {at}"), [&good.as_bytes()[..at], &good.as_bytes()[at + 1..]].concat());
        add(&format!("byte {at} twice"), [&good.as_bytes()[..=at], &good.as_bytes()[at..]].concat());
    }
    for (name, file) in [
        ("text after the armor", format!("{good}site: \"elsewhere\"\n")),
        ("a comment after the armor", format!("{good}# note\n")),
        ("two armors", format!("{good}{}", good.split_once(SIGNATURE_LINE).unwrap().1)),
        ("the signature twice", format!("{good}{}", &good[payload.len()..])),
        ("NEL in the signature line", good.replace(SIGNATURE_LINE, "signature: |\u{85}\n")),
        ("a line separator in the signature line", good.replace(SIGNATURE_LINE, "signature: |\u{2028}\n")),
        ("CR LF", good.replace('\n', "\r\n")),
        ("no padding", good.replace("=\n", "\n")),
    ] {
        add(name, file.into_bytes());
    }
    // In turn a bit flipped, a byte removed, two exchanged, the file cut; 5 is prime to 4.
    for at in (0..payload.len() - 1).step_by(5) {
        let mut file = good.as_bytes().to_vec();
        match at % 4 {
            0 => file[at] ^= 1 << (at / 4 % 8),
            1 => drop(file.remove(at)),
            2 => file.swap(at, at + 1),
            _ => file.truncate(at),
        }
        add(&format!("byte {at} of the text"), file);
    }
    cases
}

#[test]
fn a_verifier_in_java_gives_the_same_answers() {
    let bench = Bench::new();
    let (good, signers) = (project("passports/SPS-2/0017/moscow-bmstu-1.yaml"), project("docs/allowed_signers"));
    let mut cases = good_and_their_signers(&bench);
    cases.extend(rightly_signed(good.split_once(SIGNATURE_LINE).unwrap().0));
    cases.extend(altered(&good, &signers));
    let folder = bench.path("cases");
    fs::create_dir(&folder).unwrap();
    for (number, case) in cases.iter().enumerate() {
        fs::write(folder.join(format!("{number}.yaml")), &case.file).unwrap();
        fs::write(folder.join(format!("{number}.signers")), &case.signers).unwrap();
    }
    let sources = ["docs/Verify.java", "tests/openssh/Verdicts.java"]
        .map(|path| Path::new(env!("CARGO_MANIFEST_DIR")).join(path));
    let java = |program: &str, arguments: &[&str]| {
        let finished = run(Command::new(program).args(arguments), b"");
        assert!(finished.good, "{program}: {}", finished.errors);
        finished.output
    };
    let [verify, verdicts] = sources.each_ref().map(|path| path.to_str().unwrap());
    let classes = bench.path("classes");
    let classes = classes.to_str().unwrap();
    java("javac", &["-encoding", "UTF-8", "-Xlint:all", "-Werror", "-d", classes, verify, verdicts]);
    let answers = java("java", &["-cp", classes, "Verdicts", folder.to_str().unwrap()]);
    let answers: Vec<&str> = answers.lines().collect();
    assert_eq!(answers.len(), cases.len());
    let (mut accepted, mut refused) = (0, 0);
    for (case, answer) in cases.iter().zip(answers) {
        let found = answer == format!("good: {ISSUER}");
        assert_eq!((found, case.is_good()), (case.due, case.due), "{}: {answer}", case.name);
        *(if found { &mut accepted } else { &mut refused }) += 1;
    }
    println!("good {accepted}, refused {refused}");
    assert!(refused > 2_000, "{refused}");
    // As a user runs it.
    let passport = bench.write("passport.yaml", &good);
    let signers = bench.write("signers", &signers);
    let alone = |file: &Path| run(Command::new("java").arg(verify).arg(file).arg(&signers), b"");
    assert!(alone(&passport).good);
    assert!(!alone(&bench.write("altered.yaml", good.replacen("12.4", "12.5", 1))).good);
    assert!(fs::read_to_string(verify).unwrap().lines().count() < 100);
}
