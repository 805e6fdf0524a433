//! What a terminal gets and a pipe does not: emphasis, never where NO_COLOR is set, and lines that fit. The terminal is a
//! real one, of util-linux's `script`.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

const SHOW: [&str; 4] = ["show", "passports/SPS-2/0017/moscow-bmstu-1.yaml", "--trust", "docs/allowed_signers"];
const ESCAPE: u8 = 0x1b;

fn program() -> &'static str {
    env!("CARGO_BIN_EXE_dtg-passport")
}

fn in_a_terminal(no_color: Option<&str>) -> Vec<u8> {
    let mut script = Command::new("script");
    script.args(["--quiet", "--return", "--command", &format!("'{}' {}", program(), SHOW.join(" ")), "/dev/null"]);
    script.env("TERM", "xterm-256color").env_remove("NO_COLOR").env_remove("CLICOLOR").env_remove("CLICOLOR_FORCE");
    if let Some(value) = no_color {
        script.env("NO_COLOR", value);
    }
    let output = script.output().expect("`script` of util-linux runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

#[test]
fn a_terminal_gets_emphasis_and_a_pipe_none() {
    assert!(in_a_terminal(None).contains(&ESCAPE));
    let piped = Command::new(program()).args(SHOW).env_remove("CLICOLOR_FORCE").output().expect("the program runs");
    assert!(piped.status.success() && !piped.stdout.contains(&ESCAPE));
}

#[test]
fn no_color_is_obeyed() {
    assert!(!in_a_terminal(Some("1")).contains(&ESCAPE));
}

#[test]
fn no_line_is_wider_than_100_columns() {
    let folder = tempfile::tempdir().unwrap();
    let certify =
        format!("certify docs/angles.csv --stand docs/header.yaml -o {}", folder.path().join("a.yaml").display());
    let check = "certify docs/check.csv --against passports/SPS-2/0017/stand.yaml";
    let calibrate = format!("calibrate {} {CALIBRATE} {TRUST} --budget", SHOW[1]);
    for command_line in [&SHOW.join(" "), &certify, check, &calibrate] {
        let piped = Command::new(program()).args(command_line.split(' ')).env_remove("COLUMNS").output();
        let piped = piped.expect("the program runs");
        let text = String::from_utf8(piped.stdout).expect("UTF-8");
        let widest = text.lines().max_by_key(|line| line.chars().count()).unwrap();
        assert!((60..=100).contains(&widest.chars().count()), "{command_line}: {widest}");
    }
}

/// Expected: what a terminal of that width gets, of stdout and stderr; without a positive number, what a pipe gets.
#[test]
fn columns_are_those_of_the_variable_where_no_terminal_is() {
    let folder = tempfile::tempdir().unwrap();
    let with = |columns: Option<&str>, command_line: &str| {
        let mut piped = Command::new(program());
        piped.args(command_line.split(' ')).env_remove("COLUMNS").envs(columns.map(|columns| ("COLUMNS", columns)));
        let output = piped.output().expect("the program runs");
        let text = String::from_utf8([output.stderr, output.stdout].concat()).expect("UTF-8");
        text.lines().map(str::to_owned).collect::<Vec<_>>()
    };
    let refused = command_lines().pop().unwrap();
    for command_line in [SHOW.join(" "), refused] {
        for columns in [80, 160] {
            let due = lines_at(columns, &command_line, folder.path());
            assert_eq!(with(Some(&columns.to_string()), &command_line), due, "{columns}");
        }
        let due = with(None, &command_line);
        for columns in ["", "0", "-80", "wide"] {
            assert_eq!(with(Some(columns), &command_line), due, "{columns:?}");
        }
    }
}

const TRUST: &str = "--trust docs/allowed_signers --time 2026-11-20";
const CALIBRATE: &str = "docs/currents.csv --laboratory docs/laboratory.yaml --gyro docs/gvk-6.yaml";

/// Returns one command line or more of every verb whose result people read; `FOLDER` is an empty folder.
fn command_lines() -> Vec<String> {
    let passport = "passports/SPS-2/0017/moscow-bmstu-1.yaml";
    let key = "--key FOLDER/key --identity factory@example.org";
    vec![
        format!("verify {passport} passports/SPS-1/0203/beijing-nim-1.yaml {TRUST} --serial 0017 --at 40.2,116.2"),
        format!("verify {passport} {TRUST} --register passports"),
        format!("show {passport} {TRUST}"),
        format!("calibrate {passport} {CALIBRATE} {TRUST}"),
        format!(
            "calibrate {passport} {CALIBRATE} {TRUST} --budget --monte-carlo --trials 20000 --method least-squares"
        ),
        format!("register passports {TRUST}"),
        format!("history SPS-2/0017 --passports passports {TRUST}"),
        format!("diff {passport} passports/SPS-2/0017/beijing-nim-1.yaml {TRUST}"),
        "plan --site sites/moscow-bmstu.yaml --stand passports/SPS-2/0017/stand.yaml".to_owned(),
        "certify docs/angles.csv --stand docs/header.yaml -o FOLDER/COLUMNS.yaml".to_owned(),
        "certify docs/check.csv --against passports/SPS-2/0017/stand.yaml".to_owned(),
        "init FOLDER/COLUMNS".to_owned(),
        "status --workspace FOLDER/COLUMNS --time 2026-11-20".to_owned(),
        format!(
            "issue passports/SPS-2/0017/stand.yaml --site sites/moscow-bmstu.yaml {key} --out FOLDER/COLUMNS/out --issued-at 2026-11-09"
        ),
        "simulate accuracy --trials 2000".to_owned(),
        "simulate convergence --trials 200 --limits-deg 1,15".to_owned(),
        "selftest".to_owned(),
        "show a/passport/that/is/not/there/and-whose-name-is-so-long-that-the-message-fills-a-line.yaml".to_owned()
            + " --trust docs/allowed_signers",
    ]
}

/// Returns a name for files of the run with `columns`.
fn with_width(columns: usize) -> String {
    format!("w{columns}w")
}

/// Returns the lines that a terminal of `columns` gets. Progress bars overwrite their own line, and are left out.
fn lines_at(columns: usize, command_line: &str, folder: &Path) -> Vec<String> {
    let arguments =
        command_line.replace("FOLDER", &folder.display().to_string()).replace("COLUMNS", &with_width(columns));
    let command = format!("stty rows 50 columns {columns}; '{}' {arguments}", program());
    let mut script = Command::new("script");
    script.args(["--quiet", "--return", "--command", &command, "/dev/null"]).env("TERM", "xterm").env("NO_COLOR", "1");
    let output = script.output().expect("`script` of util-linux runs");
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let last =
        |line: &str| line.rsplit(['\r', '\u{1b}']).next().unwrap_or_default().trim_start_matches("[2K").to_owned();
    text.lines().map(|line| last(line.trim_end_matches('\r'))).collect()
}

/// The words of a text, without bars.
fn words(lines: &[String]) -> BTreeSet<&str> {
    let words = lines.iter().flat_map(|line| line.split_whitespace());
    words.filter(|word| !word.contains(|c| matches!(c, '\u{2500}'..='\u{259F}'))).collect()
}

#[test]
fn every_line_fits_the_terminal_and_no_word_is_broken() {
    let folder = tempfile::tempdir().expect("a folder");
    let keygen = ["keygen", "key", "--identity", "factory@example.org", "--no-passphrase"];
    let made = Command::new(program()).args(keygen).current_dir(&folder).output().expect("the program runs");
    assert!(made.status.success());
    for command_line in command_lines() {
        let wide = lines_at(400, &command_line, folder.path());
        assert!(wide.iter().any(|line| !line.is_empty()), "{command_line}");
        for columns in [80, 160] {
            let lines = lines_at(columns, &command_line, folder.path());
            // A single word may be longer than a line, and so may a command, which is copied as one line.
            let may_be_long = |line: &str| !line.trim().contains(' ') || line.trim().starts_with("dtg-passport ");
            let long = lines.iter().filter(|line| line.chars().count() > columns && !may_be_long(line));
            let long: Vec<_> = long.collect();
            assert!(long.is_empty(), "{command_line}, {columns} columns: {long:#?}");
            let (found, due, own) = (words(&lines), words(&wide), with_width(columns));
            let broken: Vec<_> = found.difference(&due).filter(|word| !word.contains(&own)).collect();
            assert!(broken.is_empty(), "{command_line}, {columns} columns: {broken:?}");
        }
    }
}

/// `calibrate` without `--details`: the verdict first, no line above 80 columns, at most 40 lines; also of readings that do
/// not fit, of exchanged columns, without a gyro type, and after an earlier calibration.
#[test]
fn a_calibration_fits_on_a_screen() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let currents = std::fs::read_to_string("docs/currents.csv").unwrap();
    let changed = |each: &dyn Fn(usize, Vec<&str>) -> String| {
        let rows =
            currents.lines().enumerate().map(|(place, line)| match line.starts_with(|c: char| c.is_ascii_digit()) {
                true => each(place, line.split(',').collect()),
                false => line.to_owned(),
            });
        rows.collect::<Vec<_>>().join("\n") + "\n"
    };
    let first = currents.lines().position(|line| line.starts_with(|c: char| c.is_ascii_digit())).unwrap();
    let off = file(
        "off.csv",
        &changed(&|place, row| match place == first {
            true => format!("{},{},{},{}", row[0], row[1], row[2].parse::<f64>().unwrap() + 0.05, row[3]),
            false => row.join(","),
        }),
    );
    let swapped = file("swapped.csv", &changed(&|_, row| format!("{},{},{},{}", row[0], row[1], row[3], row[2])));
    let json = Command::new(program())
        .args(["calibrate", SHOW[1]])
        .args(CALIBRATE.split(' '))
        .args(TRUST.split(' '))
        .args(["--format", "json"])
        .output()
        .unwrap();
    let earlier = file("earlier.json", &String::from_utf8(json.stdout).unwrap());
    let without_type = CALIBRATE.replace(" --gyro docs/gvk-6.yaml", "");
    assert_ne!(without_type, CALIBRATE);
    let cases = [
        (CALIBRATE.to_owned(), ["UNDECIDED", "НЕ ОПРЕДЕЛЕНО"]),
        (CALIBRATE.replace("docs/currents.csv", &off), ["INVALID", "НЕДЕЙСТВИТЕЛЬНО"]),
        (CALIBRATE.replace("docs/currents.csv", &swapped), ["INVALID", "НЕДЕЙСТВИТЕЛЬНО"]),
        (without_type.clone(), ["CALIBRATED", "ОТКАЛИБРОВАН"]),
        (format!("{without_type} --previous {earlier}"), ["CALIBRATED", "ОТКАЛИБРОВАН"]),
    ];
    for (given, words) in cases {
        for (language, word) in ["en", "ru"].into_iter().zip(words) {
            let mut calibrate = Command::new(program());
            calibrate.args(["calibrate", SHOW[1], "--lang", language]).args(given.split(' ')).args(TRUST.split(' '));
            let text = calibrate.env("COLUMNS", "80").output().unwrap().stdout;
            let text = String::from_utf8(text).unwrap();
            assert!(text.lines().next().is_some_and(|line| line.contains(word)), "{given}\n{text}");
            assert!(text.lines().all(|line| line.chars().count() <= 80), "{given}\n{text}");
            assert!(text.lines().count() <= 40, "{} lines\n{given}\n{text}", text.lines().count());
        }
    }
}
