//! Pages as PDF, as the program has them printed, against the same page printed by a driven browser.

use crate::pages::browsed;
use crate::programs;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// As root, Chromium starts only without its sandbox.
const BROWSER: &str = "chromium --no-sandbox";
const VERIFIED: &[&str] = &["--trust", "docs/allowed_signers", "--time", "2026-11-20"];
const PASSPORT: &str = "passports/SPS-2/0017/moscow-bmstu-1.yaml";

/// A document: the arguments before the file to be written, the language of the document, its title.
type Document<'a> = (&'a str, &'a str, &'a str);

const RENDERED: Document = (
    "render passports/SPS-2/0017/moscow-bmstu-1.yaml --lang ru,en -o",
    "ru",
    "Паспорт поворотного стенда / Passport of a test stand: SPS-2/0017/moscow-bmstu/1",
);
const CALIBRATED: Document = (
    "calibrate passports/SPS-2/0017/moscow-bmstu-1.yaml docs/currents.csv --gyro docs/gvk-6.yaml --report",
    "en",
    "Calibration of a dynamically tuned gyro: GVK-6, currents 912b9a4f",
);
const CERTIFIED: Document = (
    "certify docs/angles.csv --against passports/SPS-2/0017/stand.yaml --lang ru --report",
    "ru",
    "Протокол калибровки поворотного стенда: C-2026-0142",
);

/// Returns an empty folder.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("pdf").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn program((arguments, ..): Document, output: &Path, start: &mut Command) -> String {
    let verified = if arguments.starts_with("certify") { &[][..] } else { VERIFIED };
    start.args(arguments.split(' ')).arg(output).args(verified).current_dir(programs::project(""));
    let output = start.env("DTG_PASSPORT_BROWSER", BROWSER).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{said}");
    said
}

fn poppler(program: &str, arguments: &[&str], pdf: &Path) -> String {
    let mut command = programs::on_path(program);
    command.args(arguments).arg(pdf);
    if program == "pdftotext" {
        command.arg("-");
    }
    programs::output(command)
}

fn is_the_page_printed(name: &str, document: Document) {
    let folder = folder(name);
    let dtg_passport = || Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
    // With what an address has to escape.
    let beside = folder.join("№1 #2 100%25?");
    fs::create_dir(&beside).unwrap();
    let (pdf, html) = (beside.join("отчёт.pdf"), folder.join("page.html"));
    assert!(program(document, &pdf, &mut dtg_passport()).contains("отчёт.pdf\n"));
    let left: Vec<_> = fs::read_dir(&beside).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert_eq!(left, std::slice::from_ref(&pdf), "page and profile of the browser are removed");
    program(document, &html, &mut dtg_passport());
    browsed(&folder, ["page"].into_iter());
    let text = |pdf: &Path| poppler("pdftotext", &["-raw"], pdf);
    assert_eq!(text(&pdf), text(&folder.join("page.pdf")), "the same sheets as from the page");
    let info = poppler("pdfinfo", &[], &pdf);
    let is = |key: &str, value: &str| {
        let line = info.lines().find_map(|line| line.strip_prefix(key));
        assert_eq!(line.unwrap_or_else(|| panic!("{key} in {info}")).trim(), value);
    };
    let sheets = text(&pdf).matches('\u{c}').count();
    assert!(sheets > 1, "{sheets} sheets");
    is("Pages:", &sheets.to_string());
    is("Page size:", "594.96 x 841.92 pts (A4)");
    is("Tagged:", "yes");
    let page = fs::read_to_string(&html).unwrap();
    let title = page.split_once("<title>").unwrap().1.split_once("</title>").unwrap().0;
    assert!(title.ends_with(document.2), "{title}");
    is("Title:", title);
    let bytes = fs::read(&pdf).unwrap();
    let catalog = bytes.windows(13).position(|word| word == b"/Type /Catalo").expect("a catalog");
    let catalog = String::from_utf8_lossy(&bytes[catalog..]).split("endobj").next().unwrap().to_owned();
    assert!(catalog.contains(&format!("/Lang ({})", document.1)), "{catalog}");
    // Two lines of heads, then the name, two words of the type, one or two of the encoding, emb, sub, uni, object.
    let fonts = poppler("pdffonts", &[], &pdf);
    let embedded: Vec<_> = fonts.lines().skip(2).map(|line| line.split_whitespace().rev().nth(4).unwrap()).collect();
    assert!(embedded.len() > 3 && embedded.iter().all(|word| *word == "yes"), "{fonts}");
}

#[test]
fn a_passport_in_two_languages() {
    is_the_page_printed("passport", RENDERED);
}

#[test]
fn a_report_of_a_calibration() {
    is_the_page_printed("report", CALIBRATED);
}

#[test]
fn a_record_of_a_certification() {
    is_the_page_printed("record", CERTIFIED);
}

/// Expected: no TCP, and nothing sent by UDP. Chromium connects UDP sockets, which sends nothing, to learn its own address.
#[test]
fn nothing_is_sent_to_any_host() {
    let folder = folder("network");
    let (pdf, trace) = (folder.join("new/page.pdf"), folder.join("trace"));
    let mut strace = programs::on_path("strace");
    strace.args(["-f", "-yy", "-qq", "-e", "trace=connect,sendto,sendmsg,sendmmsg", "-o"]).arg(&trace);
    program(RENDERED, &pdf, strace.arg(env!("CARGO_BIN_EXE_dtg-passport")));
    // The folder of the output was made after the browser had printed.
    assert_eq!([&folder, &folder.join("new")].map(|folder| fs::read_dir(folder).unwrap().count()), [2, 1]);
    let trace = fs::read_to_string(trace).unwrap();
    assert!(trace.contains("<UNIX"), "the processes of the browser talk to each other, and strace sees it");
    let sent = |line: &&str| line.contains("<TCP") || line.contains("<UDP") && !line.contains("connect(");
    assert_eq!(trace.lines().filter(sent).collect::<Vec<_>>(), [""; 0]);
}

/// As the installed Chromium says it.
#[test]
fn a_browser_that_refuses_to_start_as_root_is_told_how() {
    let folder = folder("root");
    let mut start = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
    start.args(["render", PASSPORT, "-o"]).arg(folder.join("page.pdf")).args(VERIFIED);
    start.current_dir(programs::project("")).env_remove("DTG_PASSPORT_BROWSER");
    let output = start.output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    if output.status.success() {
        // A user with a sandbox.
        assert!(said.ends_with("page.pdf\n"), "{said}");
        return;
    }
    assert!(output.status.code() == Some(2) && said.contains("DTG_PASSPORT_BROWSER='"), "{said}");
    assert!(said.contains("--no-sandbox';") && said.contains("no file was left"), "{said}");
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
}
