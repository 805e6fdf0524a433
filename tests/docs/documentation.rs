//! The documentation is true: its console blocks are run and compared, its links lead somewhere.
//!
//! In a block ```` ```console ```` a line `$ …` is a command of a POSIX shell, run in a folder that holds copies of `passports/`,
//! `sites/` and `docs/`; what follows is what it prints on both outputs, `…` standing for any text within a line.

use crate::programs;
use std::fs;
use std::path::{Path, PathBuf};

/// The pages, in the order in which they are run; each has a folder of its own.
fn pages() -> Vec<PathBuf> {
    let folders = ["docs", "docs/development"].map(|folder| fs::read_dir(programs::project(folder)).unwrap());
    let docs = folders.into_iter().flatten().map(|entry| entry.unwrap().path());
    let mut pages: Vec<PathBuf> =
        docs.filter(|path| path.extension().is_some_and(|extension| extension == "md")).collect();
    pages.push(programs::project("README.md"));
    pages.push(programs::project("CHANGELOG.md"));
    pages.push(programs::project("CONTRIBUTING.md"));
    pages.push(programs::project("sites/README.md"));
    pages.sort();
    pages
}

/// Commands of a page with their expected lines.
fn transcripts(page: &str) -> Vec<(String, Vec<String>)> {
    let mut transcripts: Vec<(String, Vec<String>)> = Vec::new();
    for block in page.split("```console\n").skip(1) {
        let block = block.split("```").next().unwrap();
        for line in block.lines() {
            match line.strip_prefix("$ ") {
                Some(command) => transcripts.push((command.to_owned(), Vec::new())),
                None => transcripts.last_mut().expect("a block begins with a command").1.push(line.to_owned()),
            }
        }
    }
    transcripts
}

fn matches(line: &str, pattern: &str) -> bool {
    let Some((first, pattern)) = pattern.split_once('…') else { return line == pattern };
    let Some(mut rest) = line.strip_prefix(first) else { return false };
    let (between, last) = pattern.rsplit_once('…').unwrap_or(("", pattern));
    for part in between.split('…') {
        match rest.split_once(part) {
            Some((_, after)) => rest = after,
            None => return false,
        }
    }
    rest.ends_with(last)
}

#[test]
fn console_blocks_print_what_they_say() {
    let mut commands = 0;
    for page in pages() {
        let name = page.file_stem().unwrap().to_string_lossy().into_owned();
        let mut text = fs::read_to_string(&page).unwrap();
        let transcripts = transcripts(&text);
        if transcripts.is_empty() {
            continue;
        }
        let folder = fresh_folder(&name);
        for (command, expected) in transcripts {
            let found = run(&command, &folder);
            let found: Vec<&str> = found.lines().collect();
            let alike = found.len() == expected.len() && found.iter().zip(&expected).all(|(f, e)| matches(f, e));
            if !alike && std::env::var_os("TRANSCRIPTS").is_some_and(|asked| asked == "write") {
                // Where a line still matches, what differs from run to run stays `…`; elsewhere, put it back by hand.
                let kept =
                    |line: &&str| expected.iter().find(|e| matches(line, e)).map_or(*line, |e| e.as_str()).to_owned();
                let told = |lines: &[String]| format!("$ {command}\n{}\n", lines.join("\n"));
                text = text.replacen(&told(&expected), &told(&found.iter().map(kept).collect::<Vec<_>>()), 1);
                fs::write(&page, &text).unwrap();
                continue;
            }
            assert!(alike, "{name}: $ {command}\nprints\n{}\nnot\n{}", found.join("\n"), expected.join("\n"));
            commands += 1;
        }
    }
    assert!(commands >= 6, "the README has commands");
}

fn fresh_folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("documentation").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    for part in ["passports", "sites", "docs"] {
        let mut copy = programs::on_path("cp");
        copy.arg("-r").arg(programs::project(part)).arg(&folder);
        programs::output(copy);
    }
    folder
}

/// Both outputs, in the order of writing.
fn run(command: &str, folder: &Path) -> String {
    let program = Path::new(env!("CARGO_BIN_EXE_dtg-passport")).parent().unwrap().to_owned();
    let python = programs::project("target/test-tools/venv/bin");
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths([program, python].into_iter().chain(std::env::split_paths(&path))).unwrap();
    let mut shell = programs::on_path("sh");
    shell.arg("-c").arg(format!("{{ {command}\n}} 2>&1")).current_dir(folder).env("PATH", path);
    String::from_utf8(shell.output().unwrap().stdout).unwrap()
}

/// The lists of keys are those that the program writes.
#[test]
fn every_key_is_in_the_reference() {
    let page = fs::read_to_string(programs::project("docs/keys.md")).unwrap();
    let command = page.split('`').nth(1).unwrap();
    let tables = &page[page.find("## ").unwrap()..];
    assert!(
        run(command, &fresh_folder("keys-of-the-program")) == tables,
        "docs/keys.md: write it again with `{command}`"
    );
}

/// The picture of the plan is what the command under it writes.
#[test]
fn the_picture_of_the_plan_is_that_of_its_command() {
    let page = fs::read_to_string(programs::project("docs/positions.md")).unwrap();
    let command = page.split('`').find(|code| code.starts_with("dtg-passport plan") && code.contains(" -o ")).unwrap();
    let folder = fresh_folder("picture-of-the-plan");
    let printed = run(command, &folder);
    let drawn = fs::read_to_string(folder.join("positions.svg")).expect(&printed);
    let committed = fs::read_to_string(programs::project("docs/pictures/positions.svg")).unwrap();
    assert!(drawn == committed, "run docs/pictures/make");
}

/// The guide names the verbs that print JSON: those, and no others, whose help offers it for the result.
#[test]
fn the_verbs_that_print_json_are_named() {
    let help = |verb: &str| run(&format!("dtg-passport {verb} --help"), Path::new(env!("CARGO_TARGET_TMPDIR")));
    let commands = |help: &str| -> Vec<String> {
        let listed = help.split("Commands:\n").nth(1).unwrap_or_default().split("\n\n").next().unwrap();
        let lines = listed.lines().filter_map(|line| line.strip_prefix("  ").filter(|line| !line.starts_with(' ')));
        lines.filter_map(|line| line.split(' ').next()).map(str::to_owned).collect()
    };
    let prints_json = |verb: &str| {
        let below = commands(&help(verb)).first().map(|command| help(&format!("{verb} {command}")));
        let text = below.unwrap_or_else(|| help(verb));
        text.contains("Output format") && text.contains("- json")
    };
    let verbs = commands(&help(""));
    assert!(verbs.len() > 10, "{verbs:?}");
    let due: Vec<&String> = verbs.iter().filter(|verb| *verb != "help" && prints_json(verb)).collect();
    let guide = fs::read_to_string(programs::project("docs/integrator.md")).unwrap();
    let sentence = guide.split("With `--format json`, ").nth(1).unwrap().split(" print ").next().unwrap();
    let mut named: Vec<&str> = sentence.split('`').skip(1).step_by(2).collect();
    named.sort_unstable();
    let mut due: Vec<&str> = due.into_iter().map(String::as_str).collect();
    due.sort_unstable();
    assert_eq!(named, due);
}

/// Every link to a file of the project leads to one, and every link to a heading to a heading of that page.
#[test]
fn links_lead_somewhere() {
    let (mut files, mut headings) = (0, 0);
    for page in pages() {
        let text = fs::read_to_string(&page).unwrap();
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            if link.starts_with("https://") {
                continue;
            }
            let (file, heading) = link.split_once('#').map_or((link, None), |(file, heading)| (file, Some(heading)));
            let target = if file.is_empty() { page.clone() } else { page.parent().unwrap().join(file) };
            assert!(target.exists(), "{}: {link} leads nowhere", page.display());
            files += 1;
            if let Some(heading) = heading {
                let found = anchors(&fs::read_to_string(&target).unwrap());
                assert!(
                    found.iter().any(|anchor| anchor == heading),
                    "{}: {link} is none of {found:?}",
                    page.display()
                );
                headings += 1;
            }
        }
    }
    assert!(files > 50 && headings > 10, "{files} links to files, {headings} to headings");
}

/// Link targets of the headings of a page, as GitHub makes them of plain words.
fn anchors(page: &str) -> Vec<String> {
    let mut code = false;
    let mut anchors = Vec::new();
    for line in page.lines() {
        code ^= line.starts_with("```");
        if let Some(heading) = line.strip_prefix('#').filter(|_| !code) {
            let words = heading.trim_start_matches('#').trim().to_lowercase();
            let kept = words.chars().filter(|character| character.is_alphanumeric() || " -_".contains(*character));
            anchors.push(kept.map(|character| if character == ' ' { '-' } else { character }).collect());
        }
    }
    anchors
}

/// Every test that a page names is there: `tests/file.rs::function`, `tests/cmd/page.md#Heading`.
#[test]
fn tests_that_are_named_exist() {
    let mut checked = 0;
    for page in pages() {
        let name = page.display().to_string();
        let text = fs::read_to_string(&page).unwrap();
        for span in text.split('`').skip(1).step_by(2).filter(|span| span.starts_with("tests/")) {
            let (file, function) = match span.split_once("::") {
                Some((file, function)) if !file.contains(' ') => (file, Some(function)),
                _ => (span, None),
            };
            let (file, heading) = file.split_once('#').map_or((file, None), |(file, heading)| (file, Some(heading)));
            // The first word is the file: a command may follow.
            let file = file.split(' ').next().unwrap();
            let path = programs::project(file);
            assert!(path.exists(), "{name} names {file}, which is not there");
            let function = function.map(|function| format!("fn {function}() {{"));
            for wanted in function.into_iter().chain(heading.map(|heading| format!("# {heading}"))) {
                let text = fs::read_to_string(&path).unwrap();
                assert!(text.lines().any(|line| line == wanted), "{name} names {span}: no line {wanted:?} there");
                checked += 1;
            }
        }
    }
    assert!(checked > 30, "docs/development/threats.md names tests: {checked}");
}

/// Each promise of docs/development/threats.md names a test: every row of the tables about attackers.
#[test]
fn every_promise_names_a_test() {
    let text = fs::read_to_string(programs::project("docs/development/threats.md")).unwrap();
    let attackers = text.split("\n## ").find(|section| section.starts_with("Attackers")).unwrap();
    let rows: Vec<&str> =
        attackers.lines().filter(|line| line.starts_with("| ") && !line.contains(" | what stops it | ")).collect();
    assert!(rows.len() > 15);
    for row in rows {
        let shown_by = row.trim_end_matches(" |").rsplit(" | ").next().unwrap();
        assert!(shown_by.contains("`tests/"), "no test is named in {row}");
    }
}
