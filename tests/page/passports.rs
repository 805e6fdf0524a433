//! What Chromium, zbar and PyYAML find on the pages of passports.

use crate::cases::{self, Case};
use crate::pages::{Page, browsed, strings};
use crate::programs;
use dtg_passport::report::Language;
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// Every case, and what was found on its page.
pub struct Passports {
    pub folder: PathBuf,
    pub cases: Vec<Case>,
    found: Value,
}

/// The pages are opened once for all tests.
pub static PASSPORTS: LazyLock<Passports> = LazyLock::new(|| {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("page");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    let cases = cases::all();
    for case in &cases {
        fs::write(folder.join(format!("{}.html", case.name)), case.html()).unwrap();
        fs::write(folder.join(format!("{}.yaml", case.name)), &case.passport).unwrap();
    }
    let found = browsed(&folder, cases.iter().map(|case| case.name));
    Passports { folder, cases, found }
});

impl Passports {
    /// Each case with what was found on its page.
    pub fn each(&self) -> impl Iterator<Item = (&Case, &Value)> {
        self.cases.iter().map(|case| (case, &self.found[case.name]))
    }

    /// The same as pages.
    pub fn pages(&self) -> impl Iterator<Item = Page<'_>> {
        self.each().map(|(case, found)| Page {
            name: case.name,
            folder: &self.folder,
            languages: &case.languages,
            own_words: &case.passport,
            found,
        })
    }
}

#[test]
fn a_page_is_small() {
    for (case, found) in PASSPORTS.each() {
        let bytes = found["bytes"].as_u64().unwrap();
        println!("{:<15} {:>7} bytes", case.name, bytes);
        // Twenty-four positions are drawn twenty-four times.
        let most = match case.name {
            "usual-both" => 150_000,
            many if many.starts_with("many") => 450_000,
            _ => 300_000,
        };
        assert!(bytes < most, "{}: {bytes} bytes", case.name);
    }
}

/// Every number, day and word of the file on the page is the file's own, or its rounding; the annex is the file.
#[test]
fn the_page_says_what_the_signed_file_says() {
    let pages = PASSPORTS.folder.join("found.json");
    for (case, _) in PASSPORTS.each() {
        let mut python = programs::python();
        python.arg(programs::project("tests/page/signed_file.py")).arg(&pages).arg(case.name);
        python.arg(PASSPORTS.folder.join(format!("{}.yaml", case.name)));
        assert_eq!(programs::output(python).trim(), "", "{}", case.name);
    }
}

/// The code on the first page, scanned from its picture, and the file that the page offers to save.
#[test]
fn code_text_and_saved_file_are_of_the_signed_file() {
    for (case, found) in PASSPORTS.each() {
        let sum = format!("{:x}", Sha256::digest(case.passport.as_bytes()));
        for colours in ["light", "dark"] {
            let mut scanner = programs::on_path("zbarimg");
            scanner.args(["--quiet", "--raw"]).arg(PASSPORTS.folder.join(format!("{}-code-{colours}.png", case.name)));
            assert_eq!(programs::output(scanner).trim(), sum, "{} {colours}", case.name);
        }
        let said = &found["said"];
        assert!(strings(&said["codes"]).contains(&sum.as_str()), "{}: the sum as text", case.name);
        let address = said["download"]["address"].as_str().unwrap();
        let mut decoder = programs::python();
        let script = "import base64, sys; sys.stdout.buffer.write(base64.b64decode(sys.argv[1].split(',', 1)[1], validate=True))";
        decoder.args(["-c", script, address]);
        assert_eq!(programs::output(decoder), case.passport, "{}: the file to save", case.name);
        let file = said["download"]["name"].as_str().unwrap();
        assert!(file.ends_with("-1.yaml") || file.ends_with("-2.yaml"), "{}: {file}", case.name);
    }
}

/// What is good but may not be used says so in its largest words; everything else is in force.
#[test]
fn the_verdict_is_large() {
    for (case, found) in PASSPORTS.each() {
        let said = &found["said"];
        let headline = said["headline"].as_str().unwrap();
        let (russian, english) = match case.name {
            "elsewhere-en" | "elsewhere-both" => (
                "Не применять: относится к другому стенду, выдан для другого места установки",
                "Not to be used: issued for another stand, issued for another site",
            ),
            "expired-ru" => ("Не применять: срок действия истёк", "Not to be used: expired"),
            _ => ("Действует", "In force"),
        };
        let words = |language| if language == Language::Russian { russian } else { english };
        let due: Vec<&str> = case.languages.iter().map(words).collect();
        let refused = !["Действует", "In force"].contains(&due[0]);
        let mark = if refused { "✕" } else { "●" };
        // A second language says it in a sentence of its own, with the day.
        let large = if refused { due.join(" ") } else { due[0].to_owned() };
        assert_eq!(headline.replace('\u{a0}', " "), format!("{mark} {large}"), "{}", case.name);
        assert_eq!(said["refused"].as_bool().unwrap(), refused, "{}", case.name);
    }
}

#[test]
fn a_second_language_says_the_status_with_its_end() {
    let both = [Language::English, Language::Russian];
    for (case, due) in [
        (cases::usual("usual-both", &both), "Действует по 01.11.2028 включительно"),
        (cases::bare("bare-both", &both), "Действует; срок действия не указан"),
    ] {
        assert!(case.html().replace('\u{a0}', " ").contains(due), "{}: {due}", case.name);
    }
}

/// Names of the checks in English and Russian, in the order of contract and command line.
const CHECKS: [[&str; 2]; 11] = [
    ["Form of the file", "Форма"],
    ["Signature", "Подпись"],
    ["Content", "Содержание"],
    ["Signing key", "Ключ подписи"],
    ["Revocation", "Отзыв"],
    ["Numbers", "Числа"],
    ["Validity period", "Срок действия"],
    ["Issuer", "Организация"],
    ["Stand", "Стенд"],
    ["Place", "Место"],
    ["Register", "Реестр"],
];

/// What was not asked is said so: no case has a list of revoked keys or a register, and only some ask for issuer, stand and place.
#[test]
fn what_was_not_asked_is_not_called_passed() {
    for (case, found) in PASSPORTS.each() {
        let tables = found["said"]["tables"].as_array().unwrap();
        let english = case.languages.iter().next() == Some(Language::English);
        let head = if english { "Check" } else { "Проверка" };
        let table = tables.iter().find(|table| strings(&table["heads"])[0].starts_with(head)).unwrap();
        let rows = table["rows"].as_array().unwrap();
        let cell = |row: &Value, place: usize| row[place]["text"].as_str().unwrap().to_owned();
        let states = CHECKS.map(|names| {
            let name = names[usize::from(!english)].to_lowercase();
            let mut named = rows.iter().filter(|row| cell(row, 0).to_lowercase().contains(&name));
            let state = cell(named.next().unwrap(), 1);
            assert!(named.next().is_none(), "{}: {name} has two rows", case.name);
            state
        });
        let in_force =
            ["In force", "Действует"].iter().any(|words| found["said"]["headline"].as_str().unwrap().ends_with(words));
        for words in [("withdrawal not checked", Language::English), ("отзыв не проверялся", Language::Russian)]
        {
            let said = found["said"]["status"].as_str().unwrap().replace('\u{a0}', " ").contains(words.0);
            assert_eq!(said, in_force && case.languages.iter().any(|language| language == words.1), "{}", case.name);
        }
        let not_asked = |place: usize| states[place].starts_with("○ ");
        let question = &case.question;
        let due =
            [(4, true), (7, question.issuer.is_none()), (8, question.serial.is_none()), (9, question.place.is_none())];
        for (place, due) in due.into_iter().chain([(10, true)]).chain([0, 1, 2, 3, 5, 6].map(|place| (place, false))) {
            assert_eq!(not_asked(place), due, "{}: check {place}: {}", case.name, states[place]);
        }
        // Those that were not asked have one row.
        let count = |mark: &str| states.iter().filter(|state| state.starts_with(mark)).count();
        assert_eq!(rows.len(), 11 + 1 - count("○ "), "{}", case.name);
        assert!(found["said"]["greens"].as_array().unwrap().iter().all(|green| !green.as_str().unwrap().contains('○')));
    }
}

/// By hand: the largest deviation, 90.4″ or 180″, is drawn as 10°.
#[test]
fn a_caption_states_how_much_the_deviations_are_enlarged() {
    let mut seen = 0;
    for (case, found) in PASSPORTS.each() {
        let factor = match case.name {
            "usual-en" | "usual-ru" => "×400.",
            "many-en" | "many-ru" => "×200.",
            _ => continue,
        };
        let words = found["said"]["words"].as_array().unwrap();
        let stated = words.iter().filter(|word| word["text"].as_str().unwrap().contains(factor)).count();
        assert_eq!(stated, 1, "{}", case.name);
        seen += 1;
    }
    assert_eq!(seen, 4);
}

/// A passport without a self-check has no currents, and its page names none.
#[test]
fn a_caption_names_the_columns_that_there_are() {
    for (case, found) in PASSPORTS.each() {
        let tables = found["said"]["tables"].as_array().unwrap();
        let heads = |table: &Value| strings(&table["heads"]).concat();
        let vectors = tables.iter().find(|table| heads(table).contains("nx")).unwrap();
        let caption = vectors["caption"].as_str().unwrap();
        let named = caption.contains("currents J") || caption.contains("токи J");
        assert_eq!(named, heads(vectors).contains("Jx"), "{}: {caption}", case.name);
        assert_eq!(named, case.passport.contains("self_check:"), "{}", case.name);
    }
}

/// In the text of a passport such words are words: escaped.
#[test]
fn words_of_a_passport_are_no_markup() {
    for case in &PASSPORTS.cases {
        let html = case.html();
        for element in ["<script", "<img", "<link", "<iframe", "<object", "<b>", "@import url(https:"] {
            let allowed = usize::from(element == "@import url(https:") * html.matches("-- @import url(https:").count();
            assert_eq!(html.matches(element).count(), allowed, "{}: {element}", case.name);
        }
    }
}
