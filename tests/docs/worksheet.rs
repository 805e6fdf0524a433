//! The worksheet leads to K: its printed lines, computed as they stand, from the printed decimals alone.

use crate::programs;
use std::collections::HashMap;
use std::fs;
use std::process::Command;

const MOSCOW: &str = "passports/SPS-2/0017/moscow-bmstu-1.yaml";
const EXAMPLES: [&str; 4] = [
    MOSCOW,
    "passports/SPS-2/0017/beijing-nim-1.yaml",
    "passports/SPS-1/0203/moscow-bmstu-1.yaml",
    "passports/SPS-1/0203/beijing-nim-1.yaml",
];
/// Largest effect of the nine decimals on K, °/(h·mA), that docs/worksheet.md states.
const LARGEST_EFFECT: f64 = 2e-6;

fn printed(arguments: &[&str]) -> String {
    let mut program = Command::new(env!("CARGO_BIN_EXE_dtg-passport"));
    program.args(arguments).args(["--trust", "docs/allowed_signers", "--time", "2026-11-20"]);
    program.current_dir(programs::project(""));
    programs::output(program)
}

/// A line of the sheet: what it computes, and its result for the self-check.
struct Line {
    formula: String,
    result: String,
}

fn sheet(passport: &str) -> Vec<Line> {
    let text = printed(&["show", passport, "--worksheet"]);
    let lines = text.lines().filter(|line| line.starts_with("  ("));
    let lines: Vec<Line> = lines
        .map(|line| {
            let mut parts = line.split("  ").map(str::trim).filter(|part| !part.is_empty()).skip(1);
            let mut next = || parts.next().unwrap().to_owned();
            Line { formula: next(), result: next() }
        })
        .collect();
    assert_eq!(lines.len(), 21);
    lines
}

/// Currents by their names on the sheet, such as `J_x11`, mA: of rows `i, j, jx, jy`.
fn by_name(rows: impl Iterator<Item = [f64; 4]>) -> HashMap<String, f64> {
    rows.flat_map(|[i, j, x, y]| [(format!("J_x{i}{j}"), x), (format!("J_y{i}{j}"), y)]).collect()
}

fn numbers<const N: usize>(line: &str, between: char) -> Option<[f64; N]> {
    let each: Option<Vec<f64>> =
        line.split(between).filter(|word| !word.is_empty()).map(|word| word.parse().ok()).collect();
    each?.try_into().ok()
}

/// The example of the documentation.
fn currents_of_the_example() -> HashMap<String, f64> {
    let text = fs::read_to_string(programs::project("docs/currents.csv")).unwrap();
    by_name(text.lines().filter_map(|line| numbers(line, ',')))
}

/// The currents of the self-check, as the table of vectors prints them: its last column stands below the others.
fn currents_of_the_self_check(shown: &str) -> HashMap<String, f64> {
    let table = || shown.split("Vectors of the positions").nth(1).unwrap().lines();
    let rows =
        table().filter_map(|line| numbers::<8>(line, ' ')).zip(table().filter_map(|line| numbers::<3>(line, ' ')));
    by_name(rows.map(|(row, [i, j, y])| {
        assert_eq!(row[..2], [i, j]);
        [i, j, row[7], y]
    }))
}

/// Computes each line as it is written, from the results of the lines before it, each with nine decimals.
fn computed(sheet: &[Line], currents: &HashMap<String, f64>) -> Vec<f64> {
    assert_eq!(currents.len(), 16);
    let mut results: Vec<f64> = Vec::new();
    for line in sheet {
        let factor = |word: &str| match word.strip_prefix('(') {
            Some(number) => results[number.trim_end_matches(')').parse::<usize>().unwrap() - 1],
            None => currents.get(word).copied().unwrap_or_else(|| word.parse().unwrap()),
        };
        let formula = line.formula.split(" = ").last().unwrap();
        let (mut sum, mut product, mut operation) = (0.0, 1.0, "×");
        for word in formula.split(' ') {
            match word {
                "+" | "-" => {
                    sum += product;
                    (product, operation) = (if word == "-" { -1.0 } else { 1.0 }, "×");
                }
                "×" | "/" => operation = word,
                _ if operation == "/" => product /= factor(word),
                _ => product *= factor(word),
            }
        }
        results.push(format!("{:.9}", sum + product).parse().unwrap());
    }
    results
}

/// Expected: K of the reference gyro from which the self-check was computed (contract of the passport).
#[test]
fn the_self_check_on_the_sheet_leads_to_its_gyro() {
    for passport in EXAMPLES {
        let sheet = sheet(passport);
        let shown = printed(&["show", passport]);
        let results = computed(&sheet, &currents_of_the_self_check(&shown));
        for (line, result) in sheet.iter().zip(&results) {
            let decimals = line.result.split_once('.').unwrap().1.len();
            assert_eq!(line.result, format!("{result:.decimals$}"), "{passport}: {}", line.formula);
            for number in line.formula.split(' ').filter(|word| word.contains('.')) {
                assert!(shown.contains(number.trim_start_matches('-')), "{passport}: {number} is not in `show`");
            }
        }
        for (found, due) in results[17..].iter().zip([95.0, 9.3, -8.7, 93.0]) {
            assert!((found - due).abs() < LARGEST_EFFECT, "{passport}: {found}, not {due}");
        }
    }
}

/// Expected: `calibrate --method analytic`, which uses all digits of the passport. The rows of the guide are the lines of the
/// sheet with the numbers written out.
#[test]
fn the_worked_example_is_the_sheet_computed_and_leads_to_the_result_of_the_program() {
    let sheet = sheet(MOSCOW);
    let currents = currents_of_the_example();
    let results = computed(&sheet, &currents);
    let guide = fs::read_to_string(programs::project("docs/worksheet.md")).unwrap();
    let rows: Vec<&str> = guide.lines().filter(|line| line.starts_with("| (")).collect();
    assert_eq!(rows.len(), sheet.len());
    for (place, (line, row)) in sheet.iter().zip(rows).enumerate() {
        let typed = |value: f64| if value < 0.0 { format!("({value:.9})") } else { format!("{value:.9}") };
        let written = line.formula.split(' ').map(|word| match word.strip_prefix('(') {
            Some(number) => typed(results[number.trim_end_matches(')').parse::<usize>().unwrap() - 1]),
            None if word.starts_with("K_") => format!("**{word}**"),
            None => currents.get(word).map_or_else(|| word.to_owned(), |current| typed(*current)),
        });
        let decimals = line.result.split_once('.').unwrap().1.len();
        let written = written.collect::<Vec<_>>().join(" ");
        let due = format!("| ({}) | {written} | {:.decimals$} |", place + 1, results[place]);
        assert_eq!(row.replace('−', "-"), due);
    }
    let json = printed(&["calibrate", MOSCOW, "docs/currents.csv", "--method", "analytic", "--format", "json"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let k = &json["results"][0]["k_deg_per_h_per_ma"];
    for (place, found) in results[17..].iter().enumerate() {
        let due = k[place / 2][place % 2].as_f64().unwrap();
        assert!((found - due).abs() < LARGEST_EFFECT, "{found}, not {due}");
    }
}
