//! What holds of every page, a passport's or a report's: as Chromium, axe and html-validate find it.

use crate::certified::CERTIFIED;
use crate::passports::PASSPORTS;
use crate::programs;
use crate::reports::REPORTED;
use dtg_passport::report::Languages;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// One page and what was found on it.
pub struct Page<'a> {
    pub name: &'a str,
    /// Where it lies, with what was printed of it.
    pub folder: &'a Path,
    pub languages: &'a Languages,
    /// What files say within its sentences, in whatever language.
    pub own_words: &'a str,
    pub found: &'a Value,
}

/// The passports, the reports, and the records of certifications.
pub fn all_pages() -> impl Iterator<Item = Page<'static>> {
    PASSPORTS.pages().chain(REPORTED.pages()).chain(CERTIFIED.pages())
}

/// Has the browser look at the pages of a folder; what it finds stays there too.
pub fn browsed<'a>(folder: &Path, names: impl Iterator<Item = &'a str>) -> Value {
    let mut browser = programs::node_for_pages();
    browser
        .arg(programs::project("tests/page/browser.cjs"))
        .arg(programs::on_path("chromium").get_program())
        .arg(folder);
    let found = programs::output({
        browser.args(names);
        browser
    });
    fs::write(folder.join("found.json"), &found).unwrap();
    serde_json::from_str(&found).unwrap()
}

/// The strings of a list.
pub fn strings(list: &Value) -> Vec<&str> {
    list.as_array().expect("a list").iter().map(|item| item.as_str().expect("a string")).collect()
}

impl Page<'_> {
    /// Every list of strings below `what` is empty.
    fn nothing(&self, what: &str) {
        let lists = self.found[what].as_object().expect("lists by name");
        assert!(lists.len() > 1, "{}: {what} was not looked at", self.name);
        for (when, list) in lists {
            assert_eq!(strings(list), [""; 0], "{}: {what}, {when}", self.name);
        }
    }
}

#[test]
fn axe_finds_no_violation_in_light_and_dark() {
    all_pages().for_each(|page| page.nothing("axe"));
}

/// On paper, a telephone, a sheet's width and a screen, in light and dark.
#[test]
fn nothing_is_cut_off_or_leaves_the_page() {
    all_pages().for_each(|page| page.nothing("unfit"));
}

/// On a phone, in the pixels beside the names that stay while a table scrolls: a number without its sign would look whole.
#[test]
fn no_cut_number_is_seen_beside_the_names_of_a_table_that_scrolls() {
    for page in all_pages() {
        assert_eq!(strings(&page.found["cut"]), [""; 0], "{}", page.name);
    }
}

/// However many positions there are: measured by the boxes that the browser sets the words in.
#[test]
fn no_words_of_a_picture_lie_on_others() {
    all_pages().for_each(|page| page.nothing("crowded"));
}

/// The base of the stand is drawn once and repeated in the picture of each position.
#[test]
fn what_pictures_repeat_keeps_its_colours() {
    for page in all_pages() {
        assert_eq!(strings(&page.found["recoloured"]), [""; 0], "{}", page.name);
    }
}

/// In print: nothing below 8 pt, 6.5 pt in pictures and in the annex; decimal marks of a column one below the other; symbols of
/// quantities italic; units directly after their numbers; rows of forms 8 mm high; at the foot of a sheet no heading, caption or
/// table head without three rows, or all it has.
#[test]
fn print_is_large_enough_columns_align_and_heads_have_rows() {
    all_pages().for_each(|page| page.nothing("print"));
}

#[test]
fn nothing_is_asked_of_the_network_and_no_script_runs() {
    for page in all_pages() {
        assert_eq!(strings(&page.found["asked"]), [""; 0], "{}", page.name);
        assert_eq!(strings(&page.found["complaints"]), [""; 0], "{}", page.name);
    }
}

#[test]
fn the_validator_finds_nothing() {
    for page in all_pages() {
        assert_eq!(strings(&page.found["html"]), [""; 0], "{}", page.name);
    }
}
