//! What is printed on A4, read back by poppler.

use crate::pages::{Page, all_pages, strings};
use crate::passports::PASSPORTS;
use crate::programs;

impl Page<'_> {
    fn pdf(&self) -> std::path::PathBuf {
        self.folder.join(format!("{}.pdf", self.name))
    }

    /// Its sheets, as text.
    fn sheets(&self, order: &str) -> Vec<String> {
        let mut pdftotext = programs::on_path("pdftotext");
        pdftotext.args(["-enc", "UTF-8", order]).arg(self.pdf()).arg("-");
        let text = programs::output(pdftotext);
        text.trim_end_matches('\u{c}').split('\u{c}').map(str::to_owned).collect()
    }

    fn info(&self, key: &str) -> String {
        let mut pdfinfo = programs::on_path("pdfinfo");
        pdfinfo.arg(self.pdf());
        let info = programs::output(pdfinfo);
        let line = info.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(':'));
        line.unwrap_or_else(|| panic!("{key} in {info}")).trim().to_owned()
    }

    fn prints_annex(&self) -> bool {
        self.found["said"]["annexPrinted"].as_bool().unwrap()
    }

    /// The last word of its title: the id of a passport, the first digits of the SHA-256 of a report's currents, or the number of
    /// a record's certificate.
    fn id(&self) -> &str {
        self.found["said"]["title"].as_str().unwrap().rsplit(' ').next().unwrap()
    }
}

/// Without blanks, which print sets as it likes.
fn packed(text: &str) -> String {
    text.chars().filter(|c| !c.is_whitespace()).collect()
}

fn lines(sheet: &str) -> Vec<&str> {
    sheet.lines().filter(|line| !line.trim().is_empty()).collect()
}

/// Chromium makes all type smaller if anything is wider than the sheet. The numbers of tables are of 8 pt, and poppler takes
/// 1.1165 em for the height of their font.
#[test]
fn no_sheet_is_made_smaller() {
    for page in all_pages() {
        let mut pdftotext = programs::on_path("pdftotext");
        pdftotext.arg("-bbox").arg(page.pdf()).arg("-");
        let words = programs::output(pdftotext);
        let at = |line: &str, key: &str| {
            let (_, rest) = line.split_once(&format!("{key}=\""))?;
            rest.split_once('"')?.0.parse::<f64>().ok()
        };
        let height = |line: &str| Some(at(line, "yMax")? - at(line, "yMin")?);
        let is_whole = |height: f64| (height - 1.1165 * 8.0).abs() < 0.005;
        assert!(words.lines().filter_map(height).any(is_whole), "{}", page.name);
    }
}

#[test]
fn the_usual_passport_and_report_have_few_sheets_of_a4() {
    for page in all_pages() {
        let sheets: usize = page.info("Pages").parse().unwrap();
        println!("{:<20} {sheets} sheets", page.name);
        assert_eq!(page.info("Page size"), "594.96 x 841.92 pts (A4)", "{}", page.name);
        // Twenty-four positions have three times the numbers and pictures. `full` and `elsewhere` have all that a file can
        // state, and a reason of half a page; `hostile` has names of 500 characters; `whole` has a budget, a Monte Carlo
        // and an earlier result.
        let long = ["full", "elsewhere", "hostile", "whole"].iter().any(|long| page.name.starts_with(long));
        let most = match (page.name.contains("many") || long, page.languages.single()) {
            _ if page.name == "brief-en" => 2,
            _ if ["usual-en", "brief-budget-en"].contains(&page.name) => 3,
            _ if page.name == "usual-both" => 4,
            _ if ["usual-ru", "many-en"].contains(&page.name) => 5,
            (false, true) => 6,
            (true, true) => 8,
            (false, false) => 8,
            (true, false) => 11,
        };
        assert!(sheets <= most, "{}: {sheets} sheets", page.name);
    }
}

#[test]
fn every_sheet_says_which_passport_and_which_page_it_is() {
    for page in all_pages() {
        let sheets = page.sheets("-layout");
        // Only the id of a passport has parts.
        let (place, revision) = page.id().rsplit_once('/').unwrap_or((page.id(), ""));
        let warning = ["Not to be used", "Не применять", "NOT VERIFIED", "НЕ ПРОВЕРЕН"];
        let headline = page.found["said"]["headline"].as_str().unwrap();
        let warned = warning.iter().any(|words| headline.contains(words));
        for (index, sheet) in sheets.iter().enumerate() {
            let at = format!("{}, sheet {}", page.name, index + 1);
            // A long name or verdict takes two lines of the margin.
            let head: String = lines(sheet).into_iter().take(3).collect();
            let named = head.contains(page.id()) || (head.contains(place) && head.contains(&format!(" {revision}")));
            assert!(named, "{at}: {head}");
            assert_eq!(warning.iter().any(|words| head.contains(words)), warned, "{at}: {head}");
            let foot = lines(sheet).pop().unwrap();
            assert!(packed(foot).ends_with(&format!("{}/{}", index + 1, sheets.len())), "{at}: {foot}");
            assert!(foot.contains("SHA-256"), "{at}: {foot}");
        }
    }
}

/// Everything that the browser shows is on paper; where it has an annex, every line of it.
#[test]
fn the_text_is_complete_in_print() {
    for page in all_pages() {
        // A paragraph may go on on the next sheet: what stands in the margins between its halves is left out. Each sheet
        // begins with it.
        let margins: Vec<String> = strings(&page.found["said"]["margins"]).into_iter().map(packed).collect();
        assert_eq!(margins.len(), 3, "{}", page.name);
        let sheets = page.sheets("-raw");
        let without_margins = |(index, sheet): (usize, &String)| {
            let number = format!("{}/{}", index + 1, sheets.len());
            margins.iter().chain([&number]).fold(packed(sheet), |sheet, words| {
                let at = sheet.find(words).unwrap_or_else(|| panic!("{}, sheet {}: {words}", page.name, index + 1));
                sheet[..at].to_owned() + &sheet[at + words.len()..]
            })
        };
        let printed: String = sheets.iter().enumerate().map(without_margins).collect();
        let blocks = strings(&page.found["said"]["blocks"]);
        assert!(blocks.len() > 100, "{}: only {} blocks", page.name, blocks.len());
        for block in blocks {
            // Small capitals are printed as capitals.
            let (block, upper) = (packed(block), packed(&block.to_uppercase()));
            assert!(printed.contains(&block) || printed.contains(&upper), "{}: {block} is not printed", page.name);
        }
        let annex = if page.prints_annex() { page.found["said"]["annex"].as_str().unwrap() } else { "" };
        for line in annex.lines() {
            assert!(printed.contains(&packed(line)), "{}: {line} is not printed", page.name);
        }
    }
}

/// No line of the annex is cut, or painted a second time in part.
#[test]
fn every_line_of_the_annex_is_whole() {
    for page in all_pages() {
        let said = &page.found["said"];
        let Some(annex) = said["annex"].as_str().filter(|annex| !annex.is_empty() && page.prints_annex()) else {
            continue;
        };
        let known = packed(annex) + &strings(&said["blocks"]).into_iter().map(packed).collect::<String>();
        let margins: Vec<String> =
            strings(&said["margins"]).into_iter().map(packed).filter(|m| !m.is_empty()).collect();
        let sheets = page.sheets("-raw").join("\n");
        let mut checked = 0;
        // Without the number of the line, or the mark that it goes on.
        let text_of = |line: &str| packed(line.trim_start_matches(|c: char| c.is_ascii_digit() || c == '↳'));
        let first = packed(annex.lines().next().unwrap());
        let is_start = |line: &str| !text_of(line).is_empty() && first.starts_with(&text_of(line));
        for line in sheets.lines().skip_while(|line| !is_start(line)) {
            let text = text_of(line);
            let is_margin = margins.iter().any(|margin| margin.contains(&text) || text.contains(margin));
            let is_number_of_sheet = line.split('/').all(|part| part.trim().parse::<u32>().is_ok());
            if is_margin || is_number_of_sheet {
                continue;
            }
            assert!(known.contains(&text), "{}: {line:?} is no part of the annex", page.name);
            checked += 1;
        }
        assert!(checked > 40, "{}: only {checked} lines", page.name);
    }
}

/// No heading and no caption is the last thing on a sheet.
#[test]
fn no_heading_is_parted_from_what_it_heads() {
    for page in all_pages() {
        let headings: Vec<String> = strings(&page.found["said"]["headings"]).into_iter().map(packed).collect();
        for (index, sheet) in page.sheets("-layout").iter().enumerate() {
            let lines = lines(sheet);
            let [.., last, _foot] = lines.as_slice() else { panic!("{}: an empty sheet", page.name) };
            let last = packed(last);
            let heading =
                headings.iter().find(|heading| **heading == last || (last.len() > 12 && heading.ends_with(&last)));
            assert_eq!(heading, None, "{}, sheet {}", page.name, index + 1);
        }
    }
}

/// Every font of the print is within the file, so it prints the same everywhere.
#[test]
fn fonts_are_embedded() {
    for page in all_pages() {
        let mut pdffonts = programs::on_path("pdffonts");
        pdffonts.arg(page.pdf());
        let fonts = programs::output(pdffonts);
        let fonts: Vec<&str> = fonts.lines().skip(2).collect();
        assert!(fonts.len() >= 3, "{}: {fonts:?}", page.name);
        for font in fonts {
            // name, type, encoding, embedded, subset, Unicode, object.
            let embedded = font.split_whitespace().rev().nth(4);
            assert_eq!(embedded, Some("yes"), "{}: {font}", page.name);
        }
    }
}

/// No sheet but the last leaves a third empty: its lowest word is below seven tenths.
#[test]
fn no_sheet_leaves_a_third_empty() {
    for page in all_pages() {
        let mut pdftotext = programs::on_path("pdftotext");
        pdftotext.args(["-enc", "UTF-8", "-bbox"]).arg(page.pdf()).arg("-");
        let text = programs::output(pdftotext);
        let sheets: Vec<&str> = text.split("<page ").skip(1).collect();
        for (index, sheet) in sheets.iter().enumerate().take(sheets.len() - 1) {
            let ends = sheet.split("yMax=\"").skip(1).filter_map(|rest| rest.split('"').next()?.parse::<f64>().ok());
            // The foot of the sheet is in its margin of 14 mm.
            let lowest = ends.filter(|end| *end < 842.0 - 40.0).fold(0.0, f64::max);
            assert!(lowest > 0.7 * 842.0, "{}, sheet {}: {lowest} pt", page.name, index + 1);
        }
    }
}

/// Without a warning beside it, the name of the document takes one line of the margin.
#[test]
fn the_running_head_is_one_line() {
    // A name of 500 characters has no line that is long enough.
    for page in all_pages().filter(|page| !page.name.starts_with("hostile")) {
        let margins = strings(&page.found["said"]["margins"]);
        if !margins[1].is_empty() {
            continue;
        }
        for (index, sheet) in page.sheets("-layout").iter().enumerate() {
            assert_eq!(packed(lines(sheet)[0]), packed(margins[0]), "{}, sheet {}", page.name, index + 1);
        }
    }
}

/// On the last sheet the two columns of the annex end at one height, but for a line of the file, which stays whole.
#[test]
fn columns_of_the_annex_end_together() {
    for page in all_pages().filter(Page::prints_annex) {
        let mut pdftotext = programs::on_path("pdftotext");
        let sheets = page.info("Pages");
        pdftotext.args(["-enc", "UTF-8", "-bbox", "-f", &sheets, "-l", &sheets]).arg(page.pdf()).arg("-");
        let text = programs::output(pdftotext);
        let number = |word: &str, key: &str| -> f64 {
            let (_, rest) = word.split_once(&format!("{key}=\"")).unwrap();
            rest.split('"').next().unwrap().parse().unwrap()
        };
        let words = text.split("<word ").skip(1).map(|word| [number(word, "xMin"), number(word, "yMin")]);
        // Between the margins of the sheet; a column without a word ends at its top.
        let words: Vec<[f64; 2]> = words.filter(|[_, y]| (43.0..842.0 - 40.0).contains(y)).collect();
        let end =
            |right: bool| words.iter().filter(|[x, _]| (*x > 297.6) == right).map(|[_, y]| *y).fold(43.0, f64::max);
        assert!((end(false) - end(true)).abs() < 90.0, "{}: {} and {} pt", page.name, end(false), end(true));
    }
}

/// A table that goes on on the next sheet has its headings there again; none stands on a sheet without a row.
#[test]
fn long_tables_repeat_their_headings() {
    let page = PASSPORTS.pages().find(|page| page.name == "many-en").unwrap();
    let rows = |sheet: &String| sheet.lines().filter(|line| is_row(line)).count();
    let heads = |sheet: &String| sheet.lines().filter(|line| line.contains("θ") && line.contains("U(γ)")).count();
    let sheets = page.sheets("-layout");
    assert_eq!(sheets.iter().map(rows).sum::<usize>(), 24);
    for sheet in sheets {
        assert_eq!(heads(&sheet), usize::from(rows(&sheet) > 0), "{sheet}");
    }
}

/// The fields of the site and of the certificate, the longest lists of a passport, have their heading on every sheet that
/// they are on. Those of the usual passport in one language are on one sheet.
#[test]
fn long_lists_of_fields_have_their_heading() {
    const OF_SITE: &[&str] = &[
        "Height above the ellipsoid",
        "Высота над эллипсоидом",
        "u of the level of the base",
        "u горизонтирования основания",
        "Source of the data",
        "Источник этих данных",
    ];
    const OF_CERTIFICATE: &[&str] = &["Date of measurement", "Дата измерений", "Traceability", "Прослеживаемость  "];
    let lists = [
        (OF_SITE, ["Site (", "Место установки ("]),
        (OF_CERTIFICATE, ["Calibration certificate", "Сертификат калибровки"]),
    ];
    for (page, (fields, heads)) in lists.into_iter().flat_map(|list| PASSPORTS.pages().map(move |page| (page, list))) {
        let sheets = page.sheets("-layout");
        let with_fields = sheets.iter().filter(|sheet| fields.iter().any(|field| sheet.contains(field)));
        let with_fields: Vec<&String> = with_fields.collect();
        let usual = page.name.starts_with("usual") && page.languages.single();
        // These files state none of the fields.
        let state_none: &[&str] = if fields == OF_SITE { &["hostile-en", "bare", "four"] } else { &["bare"] };
        assert!(!with_fields.is_empty() || state_none.iter().any(|name| page.name.starts_with(name)), "{}", page.name);
        assert!(with_fields.len() == 1 || !usual, "{}: {}", page.name, with_fields.len());
        for sheet in with_fields {
            assert!(heads.iter().any(|head| sheet.contains(head)), "{}: {sheet}", page.name);
        }
    }
}

/// A row of the table of deviations: i, j, two angles of whole degrees, then at least six decimals.
fn is_row(line: &str) -> bool {
    let cells: Vec<&str> = line.split_whitespace().collect();
    let whole = |cell: &&str| cell.parse::<u32>().is_ok();
    cells.len() >= 10 && cells[..4].iter().all(whole) && cells[4].replace('\u{2212}', "-").parse::<f64>().is_ok()
}
