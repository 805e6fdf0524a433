//! What is printed on A4, read back by poppler.

use crate::cases::Case;
use crate::looked::{LOOKED, strings};
use crate::tools;
use dtg_passport::document::sha256_hex;

/// The pages of a case in print, as text.
fn sheets(case: &Case) -> Vec<String> {
    let mut pdftotext = tools::on_path("pdftotext");
    pdftotext.args(["-enc", "UTF-8", "-layout"]).arg(LOOKED.folder.join(format!("{}.pdf", case.name))).arg("-");
    let text = tools::output(pdftotext);
    text.trim_end_matches('\u{c}').split('\u{c}').map(str::to_owned).collect()
}

/// Without blanks, which print sets as it likes.
fn packed(text: &str) -> String {
    text.chars().filter(|c| !c.is_whitespace()).collect()
}

fn info(case: &Case, key: &str) -> String {
    let mut pdfinfo = tools::on_path("pdfinfo");
    pdfinfo.arg(LOOKED.folder.join(format!("{}.pdf", case.name)));
    let info = tools::output(pdfinfo);
    let line = info.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(':'));
    line.unwrap_or_else(|| panic!("{key} in {info}")).trim().to_owned()
}

#[test]
fn six_sheets_of_a4_at_most_in_one_language() {
    for case in &LOOKED.cases {
        let pages: usize = info(case, "Pages").parse().unwrap();
        println!("{:<15} {pages} pages", case.name);
        assert_eq!(info(case, "Page size"), "594.96 x 841.92 pts (A4)", "{}", case.name);
        // Twenty-four positions have three times the numbers and pictures.
        let most = match (case.name.starts_with("many"), case.languages.single()) {
            (false, true) => 6,
            (true, true) => 9,
            (_, false) => 10,
        };
        assert!(pages <= most, "{}: {pages} pages", case.name);
    }
}

#[test]
fn every_sheet_says_which_passport_and_which_page_it_is() {
    for (case, found) in LOOKED.each() {
        let sheets = sheets(case);
        let title = found["said"]["title"].as_str().unwrap();
        let id = title.rsplit(' ').next().unwrap();
        let (place, revision) = id.rsplit_once('/').unwrap();
        let refused = found["said"]["refused"].as_bool().unwrap();
        for (index, sheet) in sheets.iter().enumerate() {
            let at = format!("{}, page {}", case.name, index + 1);
            // A long name or verdict takes two lines of the margin.
            let head = sheet.lines().filter(|line| !line.trim().is_empty()).take(3).collect::<String>();
            assert!(head.contains(place) && head.contains(&format!(" {revision}")), "{at}: {head}");
            let warned = ["Not to be used", "Не применять"].iter().any(|words| head.contains(words));
            assert_eq!(warned, refused, "{at}: {head}");
            let foot = sheet.lines().rev().find(|line| !line.trim().is_empty()).unwrap();
            assert!(packed(foot).ends_with(&format!("{}/{}", index + 1, sheets.len())), "{at}: {foot}");
        }
    }
}

/// Everything that the browser shows is on paper, the annex with every line.
#[test]
fn the_text_is_complete_in_print() {
    for (case, found) in LOOKED.each() {
        let mut pdftotext = tools::on_path("pdftotext");
        pdftotext.args(["-enc", "UTF-8", "-raw"]).arg(LOOKED.folder.join(format!("{}.pdf", case.name))).arg("-");
        let printed = tools::output(pdftotext);
        // A paragraph may go on on the next sheet: what stands in the margins between its halves is left out.
        let id = found["said"]["title"].as_str().unwrap().rsplit(' ').next().unwrap();
        let place = id.rsplit_once('/').unwrap().0;
        let sum = sha256_hex(case.passport.as_bytes());
        let margin = |line: &&str| {
            let line = packed(line);
            let page = line.split('/').all(|part| !part.is_empty() && part.chars().all(|c| c.is_ascii_digit()));
            line.contains(&format!("{place},"))
                || (page && line.contains('/'))
                || (line.contains("SHA-256") && line.contains(&sum))
        };
        let printed: String = printed.lines().filter(|line| !margin(line)).map(packed).collect();
        let blocks = strings(&found["said"]["blocks"]);
        assert!(blocks.len() > 100, "{}: only {} blocks", case.name, blocks.len());
        for block in blocks {
            // Small capitals are printed as capitals.
            let (block, upper) = (packed(block), packed(&block.to_uppercase()));
            assert!(printed.contains(&block) || printed.contains(&upper), "{}: {block} is not printed", case.name);
        }
        for line in case.passport.lines() {
            assert!(printed.contains(&packed(line)), "{}: {line} is not printed", case.name);
        }
    }
}

/// No heading and no caption is the last thing on a sheet.
#[test]
fn no_heading_is_parted_from_what_it_heads() {
    for (case, found) in LOOKED.each() {
        let headings: Vec<String> = strings(&found["said"]["headings"]).into_iter().map(packed).collect();
        for (index, sheet) in sheets(case).iter().enumerate() {
            let lines: Vec<&str> = sheet.lines().filter(|line| !line.trim().is_empty()).collect();
            let [.., last, _foot] = lines.as_slice() else { panic!("{}: an empty sheet", case.name) };
            let last = packed(last);
            let heading =
                headings.iter().find(|heading| **heading == last || (last.len() > 12 && heading.ends_with(&last)));
            assert_eq!(heading, None, "{}, page {}", case.name, index + 1);
        }
    }
}

/// A table that goes on on the next sheet has its headings there again.
#[test]
fn long_tables_repeat_their_headings() {
    let (case, _) = LOOKED.each().find(|(case, _)| case.name == "many-en").unwrap();
    let rows = |sheet: &String| sheet.lines().filter(|line| is_row(line)).count();
    let heads = |sheet: &String| sheet.lines().filter(|line| line.contains("u(α)") && line.contains("u(γ)")).count();
    let sheets = sheets(case);
    let with_rows: Vec<&String> = sheets.iter().filter(|sheet| rows(sheet) > 0).collect();
    assert_eq!(with_rows.iter().map(|sheet| rows(sheet)).sum::<usize>(), 24);
    for sheet in with_rows {
        assert_eq!(heads(sheet), 1, "{sheet}");
    }
}

/// A row of the table of deviations: i, j, two angles of whole degrees, then at least six decimals.
fn is_row(line: &str) -> bool {
    let cells: Vec<&str> = line.split_whitespace().collect();
    let whole = |cell: &&str| cell.parse::<u32>().is_ok();
    cells.len() >= 10 && cells[..4].iter().all(whole) && cells[4].replace('\u{2212}', "-").parse::<f64>().is_ok()
}
