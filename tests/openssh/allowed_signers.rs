//! Allowed signers: our verdicts next to those of `ssh-keygen -Y verify -Overify-time=…`.

use crate::{Bench, Finished, NAMESPACE, PRINCIPAL};
use dtg_passport::trust::{AllowedSigners, NotAuthorised, RevokedKeys, SigningKey};
use jiff::Timestamp;

const PRINCIPALS: [&str; 9] = [
    "lab@factory",
    "*",
    "l?b@*",
    "!lab@factory,*",
    "*,!qa@*",
    "qa@factory,*@factory",
    "Lab@factory",
    "\"qa lab,lab@factory\"",
    "lab@factory?",
];
const NAMESPACES: [&str; 6] = [
    "",
    "namespaces=\"dtg-passport\"",
    "NAMESPACES=\"git,dtg-*\"",
    "namespaces=\"git\"",
    "namespaces=\"!dtg-*,*\"",
    "namespaces=\"!git,?tg-passport\"",
];
const VALIDITY: [&str; 4] = [
    "",
    "valid-after=\"20260301Z\"",
    "valid-before=\"202604010030Z\"",
    "Valid-After=\"20260301000000Z\",valid-before=\"20260401003000z\"",
];
/// Just before, at and just after both ends.
const TIMES: [&str; 7] = [
    "20260228235959Z",
    "20260301000000Z",
    "20260301000001Z",
    "20260315120000Z",
    "20260401002959Z",
    "20260401003000Z",
    "20260401003001Z",
];

fn instant(time: &str) -> Timestamp {
    let [date, clock] = [&time[..8], &time[8..14]];
    let text =
        format!("{}-{}-{}T{}:{}:{}Z", &date[..4], &date[4..6], &date[6..], &clock[..2], &clock[2..4], &clock[4..]);
    text.parse().unwrap()
}

pub struct Case<'a> {
    pub bench: &'a Bench,
    pub key: &'a SigningKey,
}

impl Case<'_> {
    pub fn theirs(&self, signers: &str, time: &str) -> Finished {
        self.bench.write("signers", signers);
        // A place far from UTC: a date in local time would show.
        let mut command = std::process::Command::new("ssh-keygen");
        let option = format!("-Overify-time={time}");
        command.env("TZ", "Asia/Shanghai").args(["-Y", "verify", "-n", NAMESPACE, "-I", PRINCIPAL]);
        command.args(["-s", "signature", "-f", "signers", &option]);
        self.bench.run(&mut command, b"text")
    }

    fn ours(&self, signers: &str, time: &str) -> Result<(), NotAuthorised> {
        let signers = AllowedSigners::parse("signers", signers.as_bytes()).unwrap();
        signers.authorise(&self.key.public_key(), PRINCIPAL, NAMESPACE, instant(time))
    }

    pub fn compare(&self, signers: &str, time: &str) {
        let (theirs, ours) = (self.theirs(signers, time), self.ours(signers, time));
        assert_eq!(ours.is_ok(), theirs.good, "{signers} at {time}: {ours:?}, {}", theirs.errors);
        let words = match &ours {
            Err(NotAuthorised::WrongNamespace { .. }) => "not permitted for use in signature namespace",
            Err(NotAuthorised::NotYetValid { .. }) => "key is not yet valid",
            Err(NotAuthorised::Expired { .. }) => "key has expired",
            _ => "",
        };
        assert!(theirs.errors.contains(words), "{signers} at {time}: {ours:?}, {}", theirs.errors);
    }
}

pub fn with_case(test: impl FnOnce(&Case)) {
    let bench = Bench::new();
    let key = bench.new_key("key");
    let armor = key.sign(NAMESPACE, b"text").unwrap().to_armor();
    bench.write("signature", &armor);
    test(&Case { bench: &bench, key: &key });
}

fn joined(namespaces: &str, validity: &str) -> String {
    [namespaces, validity].into_iter().filter(|option| !option.is_empty()).collect::<Vec<_>>().join(",")
}

#[test]
fn every_combination_has_the_verdict_of_ssh_keygen() {
    with_case(|case| {
        let key = case.key.public_key().to_openssh();
        let mut compared = 0;
        for principals in PRINCIPALS {
            for namespaces in NAMESPACES {
                for validity in VALIDITY {
                    // Every time where time decides, one elsewhere.
                    let decides = !validity.is_empty() && namespaces.len() < 30 && principals.len() < 12;
                    let times = if decides { &TIMES[..] } else { &TIMES[3..4] };
                    for time in times {
                        case.compare(&format!("{principals} {} {key} comment\n", joined(namespaces, validity)), time);
                        compared += 1;
                    }
                }
            }
        }
        assert!(compared >= 500, "{compared}");
    });
}

#[test]
fn several_lines_comments_and_line_ends() {
    with_case(|case| {
        let key = case.key.public_key().to_openssh();
        let other = SigningKey::generate().unwrap().public_key().to_openssh();
        let now = "20260315120000Z";
        for text in [
            format!("# comment\n\n{PRINCIPAL} {other}\n\t {PRINCIPAL}\t\t{key}\n"),
            format!("{PRINCIPAL} {key}"),
            format!("{PRINCIPAL} {key} CRLF\r\n"),
            format!("{PRINCIPAL} {other}\n"),
            format!("qa {key}\n{PRINCIPAL} {other}\n"),
            format!("{PRINCIPAL} namespaces=\"git\" {key}\n{PRINCIPAL} valid-before=\"20260101Z\" {key}\n"),
            format!("{PRINCIPAL} valid-before=\"20260101Z\" {key}\n{PRINCIPAL} {key}\n"),
            format!("{PRINCIPAL} namespaces=\"a \\\"quoted\\\" one,dtg-passport\" {key}\n"),
            format!("{PRINCIPAL} namespaces=\"with blank, dtg-passport\" {key}\n"),
        ] {
            case.compare(&text, now);
        }
    });
}

#[test]
fn lines_that_ssh_keygen_cannot_read_are_refused_here_too() {
    with_case(|case| {
        let key = case.key.public_key().to_openssh();
        for line in [
            format!("{PRINCIPAL} no-touch-required {key}"),
            format!("{PRINCIPAL} verify-required {key}"),
            format!("{PRINCIPAL} valid-after=\"20260101Z\",valid-before=\"20260101Z\" {key}"),
            format!("{PRINCIPAL} valid-after=\"20260102Z\",valid-before=\"20260101Z\" {key}"),
            format!("{PRINCIPAL} namespaces=\"a\",namespaces=\"dtg-passport\" {key}"),
            format!("{PRINCIPAL} valid-after=\"20250101Z\",valid-after=\"20250101Z\" {key}"),
            format!("{PRINCIPAL} namespaces=dtg-passport {key}"),
            format!("{PRINCIPAL} namespaces=\"dtg-*\", {key}"),
            format!("{PRINCIPAL} namespaces=\"dtg-passport {key}"),
            format!("{PRINCIPAL} valid-after=\"0x60000000Z\" {key}"),
            format!("{PRINCIPAL} valid-after=\"0x60000000\" {key}"),
            format!("{PRINCIPAL} valid-after=\"19700101Z\" {key}"),
            format!("{PRINCIPAL} valid-before=\"2027Z\" {key}"),
            format!("{PRINCIPAL} valid-before=\"20271301Z\" {key}"),
            format!("{PRINCIPAL} {}", &key[..key.len() - 3]),
            format!("{PRINCIPAL} {}", key.replace("ssh-ed25519", "ssh-rsa")),
            format!("{PRINCIPAL} cert-authority {key}"),
            PRINCIPAL.to_owned(),
        ] {
            assert!(!case.theirs(&format!("{line}\n"), "20260315120000Z").good, "{line}");
            assert!(AllowedSigners::parse("signers", line.as_bytes()).is_err(), "{line}");
        }
    });
}

#[test]
fn lines_that_ssh_keygen_accepts_and_we_refuse() {
    with_case(|case| {
        let key = case.key.public_key().to_openssh();
        for (line, words) in [
            (
                format!("{PRINCIPAL} valid-after=\"20260101\" {key}"),
                "without it each verifier would apply its own local time",
            ),
            (format!("{PRINCIPAL} valid-before=\"20270230Z\" {key}"), "a calendar date"),
            (format!("{PRINCIPAL} valid-before=\"20270101UTC\" {key}"), "a date in UTC"),
            (format!("{PRINCIPAL} {key}\nqa valid-after=\"soon\" {key}"), "signers:2:16: valid-after: found \"soon\""),
        ] {
            assert!(case.theirs(&format!("{line}\n"), "20260315120000Z").good, "{line}");
            let refused = AllowedSigners::parse("signers", line.as_bytes()).unwrap_err().to_string();
            assert!(refused.contains(words), "{refused}");
        }
    });
}

/// Notepad and spreadsheets of Windows write the mark; OpenSSH takes it for part of the first name.
#[test]
fn a_byte_order_mark_does_not_belong_to_the_first_name() {
    with_case(|case| {
        let key = case.key.public_key().to_openssh();
        let now = "20260315120000Z";
        let first = format!("\u{FEFF}{PRINCIPAL} {key}\r\n");
        assert_eq!(case.ours(&first, now), Ok(()));
        assert!(!case.theirs(&first, now).good);
        case.compare(&format!("\u{FEFF}# signers\n{PRINCIPAL} {key}\n"), now);
        // A second mark, as of two files joined, is part of a name for both.
        case.compare(&format!("{PRINCIPAL}2 {key}\n\u{FEFF}{PRINCIPAL} {key}\n"), now);
        let revoked = RevokedKeys::parse("revoked", format!("\u{FEFF}{key}\n").as_bytes()).unwrap();
        assert!(revoked.revokes(&case.key.public_key()).is_some());
    });
}
