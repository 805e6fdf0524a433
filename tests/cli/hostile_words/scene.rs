//! The stage: every verb's line, the files it takes, and what is wrong with words that come back.

use crate::links::header_of;
use crate::place::example;
use crate::programs;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::os::unix::ffi::OsStringExt;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// A line that would be believed, a terminal's commands, and what cannot be seen; a slash would end a file's name.
pub const POISON: &str = "a\nVALID  forged\r\t\u{8}evil\u{1b}[1m\u{1b}[45m\u{1b}]0;b\u{7}\u{7f}\u{85}\u{9b}31m\u{202e}\u{2066}\u{2069}\
                      \u{200b}\u{2060}\u{feff}\u{2028}VALID  forged\u{2029}\u{ad}\u{a0}\u{3164}\u{2800}\u{e0041}\u{e000}\u{301}z";

/// Whether a character has no place in a terminal, a line feed aside: controls, what Unicode calls
/// Default_Ignorable_Code_Point or Bidi_Control (UAX 44, PropList 16.0), blanks that are no space, separators, private use,
/// noncharacters, and combining marks, which are drawn over what stands before them.
pub fn hidden(c: char) -> bool {
    let ranges = [
        '\u{300}'..='\u{36f}',
        '\u{a0}'..='\u{a0}',
        '\u{ad}'..='\u{ad}',
        '\u{61c}'..='\u{61c}',
        '\u{115f}'..='\u{1160}',
        '\u{1680}'..='\u{1680}',
        '\u{17b4}'..='\u{17b5}',
        '\u{180b}'..='\u{180f}',
        '\u{2000}'..='\u{200f}',
        '\u{2028}'..='\u{202f}',
        '\u{205f}'..='\u{206f}',
        '\u{2800}'..='\u{2800}',
        '\u{3000}'..='\u{3000}',
        '\u{3164}'..='\u{3164}',
        '\u{e000}'..='\u{f8ff}',
        '\u{fdd0}'..='\u{fdef}',
        '\u{fe00}'..='\u{fe0f}',
        '\u{feff}'..='\u{feff}',
        '\u{ffa0}'..='\u{ffa0}',
        '\u{fff0}'..='\u{fffb}',
        '\u{1bca0}'..='\u{1bca3}',
        '\u{1d173}'..='\u{1d17a}',
        '\u{e0000}'..='\u{10ffff}',
    ];
    (c.is_control() && c != '\n') || ranges.iter().any(|range| range.contains(&c))
}

/// Emphasis of the program and of clap: bold, faint, underlined, red, yellow, green.
pub const EMPHASIS: [&str; 7] =
    ["\u{1b}[0m", "\u{1b}[1m", "\u{1b}[2m", "\u{1b}[4m", "\u{1b}[31m", "\u{1b}[33m", "\u{1b}[32m"];

/// What is wrong with words that went out.
pub fn fault(words: &[u8]) -> Option<String> {
    let Ok(words) = std::str::from_utf8(words) else { return Some("no UTF-8".to_owned()) };
    if words.contains("evil\u{1b}") {
        return Some("emphasis of another".to_owned());
    }
    let plain = EMPHASIS.iter().fold(words.to_owned(), |words, code| words.replace(code, ""));
    let forged = plain.lines().find(|line| {
        let line = line.trim_start_matches([' ', '"']).trim_start_matches("dtg-passport: ");
        line.starts_with("VALID  forged")
    });
    if let Some(line) = forged {
        return Some(format!("a forged line: {line:?}"));
    }
    let c = plain.chars().find(|&c| hidden(c))?;
    let around = plain.lines().find(|line| line.contains(c)).unwrap_or_default();
    Some(format!("U+{:04X} in {around:?}", u32::from(c)))
}

/// A folder with all that the verbs need.
pub struct Scene {
    folder: tempfile::TempDir,
    pub runs: usize,
    faults: Vec<String>,
}

impl Scene {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let scene = Self { folder, runs: 0, faults: Vec::new() };
        for file in ["stand.yaml", "currents.csv", "gyro.yaml", "laboratory.yaml", "allowed_signers"] {
            fs::copy(programs::project("tests/cmd/files").join(file), scene.path(file)).unwrap();
        }
        fs::copy(programs::project("tests/cmd/files/sites/here.yaml"), scene.path("here.yaml")).unwrap();
        fs::copy(programs::project("tests/keys/examples"), scene.path("key")).unwrap();
        fs::copy(programs::project("tests/keys/examples.pub"), scene.path("key.pub")).unwrap();
        fs::set_permissions(scene.path("key"), fs::Permissions::from_mode(0o600)).unwrap();
        fs::write(scene.path("readings.csv"), readings()).unwrap();
        fs::write(scene.path("header.yaml"), header_of(&example("tests/cmd/files/stand.yaml"))).unwrap();
        let make = |line: &str| {
            let output = scene.output(&line.split(' ').map(OsString::from).collect::<Vec<_>>());
            assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
            output.stdout
        };
        make("issue stand.yaml --site here.yaml --key key --identity factory --issued-at 2026-11-03");
        let passport = scene.path("passports/SPS-2/0017/here-1.yaml");
        fs::copy(&passport, scene.path("passport.yaml")).unwrap();
        fs::copy(scene.path("passports/SPS-2/0017/register.yaml"), scene.path("register.yaml")).unwrap();
        make("issue stand.yaml --site here.yaml --key key --identity factory --issued-at 2026-11-03 --out withdrawn");
        make(
            "revoke SPS-2/0017/here/1 --reason why --passports withdrawn --key key --identity factory --trust \
             allowed_signers",
        );
        let result =
            make("calibrate passport.yaml currents.csv --trust allowed_signers --time 2026-11-04 --format json");
        fs::write(scene.path("result.json"), result).unwrap();
        scene
    }

    pub fn path(&self, file: impl AsRef<Path>) -> std::path::PathBuf {
        self.folder.path().join(file)
    }

    /// A terminal would get what this gets: emphasis is asked for.
    pub fn output(&self, arguments: &[OsString]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_dtg-passport"))
            .args(arguments)
            .current_dir(self.folder.path())
            .env_clear()
            .envs([("CLICOLOR_FORCE", "1"), ("PATH", "/usr/bin:/bin"), ("COLUMNS", "100")])
            .stdin(Stdio::null())
            .output()
            .unwrap()
    }

    /// Runs the program; what is wrong with its words is noted.
    pub fn run(&mut self, what: &str, arguments: &[OsString]) -> Output {
        let output = self.output(arguments);
        self.runs += 1;
        let code = output.status.code();
        if !matches!(code, Some(0..=2)) {
            self.faults.push(format!("{what}: exit code {code:?}"));
        }
        for (stream, words) in [("stdout", &output.stdout), ("stderr", &output.stderr)] {
            if let Some(fault) = fault(words) {
                self.faults.push(format!("{what}: {stream}: {fault}"));
            }
        }
        output
    }

    /// A copy of a file or folder under a hostile name.
    pub fn hostile_copy(&self, file: &str) -> OsString {
        let name = hostile_name(file);
        if !self.path(&name).exists() {
            let copied = Command::new("cp").arg("-rp").arg(self.path(file)).arg(self.path(&name)).status().unwrap();
            assert!(copied.success());
        }
        name
    }
}

/// A hostile name that ends as `file` does, and is no UTF-8.
pub fn hostile_name(file: &str) -> OsString {
    let end = file.rsplit_once('.').map_or(String::new(), |(_, extension)| format!("-1.{extension}"));
    OsString::from_vec([POISON.as_bytes(), b"\xff\xfe", end.as_bytes()].concat())
}

/// Three runs of the stand's angles: one is its certificate, the others differ by less than a second of arc.
pub fn readings() -> String {
    let stand = example("tests/cmd/files/stand.yaml");
    let mut rows = "i,j,run,alpha_arcsec,beta_arcsec,gamma_arcsec\n".to_owned();
    for (number, line) in (0..).zip(stand.lines().filter(|line| line.contains("{i: "))) {
        let value = |key: &str| {
            let rest = line.split_once(&format!("{key}: ")).unwrap().1;
            rest.split([',', '}']).next().unwrap().parse::<f64>().unwrap()
        };
        for run in 1..=3 {
            let off = |shift: i32| f64::from((number * 7 + run * 5 + shift * 3) % 11 - 5) / 10.0;
            let angles = ["alpha_arcsec", "beta_arcsec", "gamma_arcsec"].map(value);
            let [a, b, c] = [angles[0] + off(0), angles[1] + off(1), angles[2] + off(2)];
            rows += &format!("{},{},{run},{a:.1},{b:.1},{c:.1}\n", value("i"), value("j"));
        }
    }
    rows
}

/// Every verb with all that it takes, in a form that goes through. A word that begins with `@` is a file of that name; with
/// `>`, something new to be written; with `=`, a text.
pub const LINES: &[&str] = &[
    "demo --out >",
    "keygen > --identity =factory --no-passphrase",
    "keygen > --identity =factory --no-passphrase --allowed-signers @allowed_signers",
    "certify @readings.csv --stand @header.yaml -o >.yaml",
    "certify @readings.csv --against @stand.yaml --format text",
    "certify @readings.csv --against @stand.yaml --format json",
    "issue @stand.yaml --site @here.yaml --key @key --identity =factory --issued-at =2026-11-03 --valid-until =2027-11-03 --out > --accuracy --gyro @gyro.yaml --laboratory @laboratory.yaml --trust @allowed_signers --shard =1/1 --threads =1 --format text",
    "issue @stand.yaml --site @here.yaml --key @key --identity =factory --issued-at =2026-11-03 --out > --format json",
    "issue @stand.yaml --site @here.yaml --key @key --identity =factory --issued-at =2026-11-03 --out > --format csv",
    "issue @stand.yaml --site @here.yaml --key @key.pub --identity =factory --issued-at =2026-11-03 --out >",
    "reissue @passport.yaml --site @here.yaml --stand @stand.yaml --reason =why --key @key --identity =factory --out > --trust @allowed_signers --revoked @key.pub --issued-at =2026-11-05 --time =2026-11-05 --format text",
    "reissue @passport.yaml --same-content --reason =why --key @key --identity =factory --out > --trust @allowed_signers --issuer =factory --serial =0017 --at =55.7658,37.6856 --issued-at =2026-11-05 --valid-until =2027-11-03 --time =2026-11-05 --format text",
    "reissue @passport.yaml --same-content --reason =why --key @key --identity =factory --out > --trust @allowed_signers --issued-at =2026-11-05 --time =2026-11-05 --format json",
    "reissue @passports --same-content --reason =why --key @key --identity =factory --out > --trust @allowed_signers --issued-at =2026-11-05 --format csv",
    "verify @passport.yaml --trust @allowed_signers --issuer =factory --serial =0017 --at =55.7658,37.6856 --time =2026-11-04 --register @register.yaml --format text",
    "verify @passport.yaml --trust @allowed_signers --revoked @key.pub --issuer =factory --serial =0017 --time =2026-11-04 --register @passports --format json",
    "show @passport.yaml --trust @allowed_signers --revoked @key.pub --issuer =factory --serial =0017 --at =55.7658,37.6856 --time =2026-11-04 --format text",
    "show @passport.yaml --no-verify --format text",
    "show @passport.yaml --no-verify --format json",
    "render @passport.yaml -o >.html --trust @allowed_signers --issuer =factory --serial =0017 --time =2026-11-04 --register @passports --lang =en,ru",
    "calibrate @passport.yaml @currents.csv --trust @allowed_signers --time =2026-11-04 --method =analytic,iterative,least-squares --gyro @gyro.yaml --laboratory @laboratory.yaml --previous @result.json --delta1-percent =0.1 --delta2-deg-per-h =0.001 --budget --report > --lang =en,ru --format text",
    "calibrate @passport.yaml @currents.csv --no-verify --gyro @gyro.yaml --laboratory @laboratory.yaml --previous @result.json --report > --format json",
    "register @passports --trust @allowed_signers --issuer =factory --serial =0017 --time =2026-11-04 --within =9 --format text",
    "register @passports --trust @allowed_signers --revoked @key.pub --time =2026-11-04 --format json",
    "register @passports --trust @allowed_signers --time =2026-11-04 --format csv",
    "register @passports --renew --fresh-until =2098-12-31 --with @register.yaml --not-withdrawn =SPS-2/0017/here/1 --key @key --identity =factory --trust @allowed_signers --dry-run --format json",
    "register @passports --renew --adopt =0 --key @key --identity =factory --trust @allowed_signers --revoked @key.pub",
    "revoke =SPS-2/*/here/* --reason =why --passports @passports --key @key --identity =factory --trust @allowed_signers --time =2026-11-04 --dry-run --format json",
    "revoke =SPS-2/0017/here/1 --reason =why --passports @withdrawn --key @key --identity =factory --trust @allowed_signers",
    "simulate accuracy --stand @stand.yaml --site @here.yaml --gyro @gyro.yaml --current-percent =0.015 --current-error =common --method =analytic --trials =2 --seed =1 --threads =1 --format text",
    "simulate convergence --limits-deg =1,2 --trials =2 --seed =1 --threads =1 -o > --format json",
    "schema =stand,site --format =json",
    "completions =bash",
    "selftest --format =json",
    "=help =verify",
];

/// The words of a line, each with what it is: ' ' as it stands, '@', '>' or '='.
pub fn words(line: &str) -> Vec<(char, &str)> {
    line.split(' ')
        .map(|word| match word.chars().next() {
            Some(kind @ ('@' | '>' | '=')) => (kind, &word[1..]),
            _ => (' ', word),
        })
        .collect()
}

/// The line with the word at `place` replaced.
pub fn line_with(words: &[(char, &str)], place: Option<usize>, hostile: &OsStr, run: usize) -> Vec<OsString> {
    let each = words.iter().enumerate().map(|(index, (kind, word))| match kind {
        _ if Some(index) == place => hostile.to_owned(),
        '>' => format!("new-{run}-{index}{word}").into(),
        _ => (*word).into(),
    });
    each.collect()
}

pub fn named(line: &str, place: usize, how: &str) -> String {
    let before = line.split(' ').take(place + 1).collect::<Vec<_>>();
    format!("{} … {} {how}", before[0], before[before.len().saturating_sub(2)..].join(" "))
}

pub fn assert_no(scene: &Scene) {
    let faults = &scene.faults;
    assert!(faults.is_empty(), "{} of {} runs:\n{}", faults.len(), scene.runs, faults.join("\n"));
}
