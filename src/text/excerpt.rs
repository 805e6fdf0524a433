//! Line of a file with an error, as a terminal shows it.

use super::{Printable, without_secrets};
use std::fmt::{self, Display, Formatter};

/// Number of characters shown, and how many of them precede the error; with line number and indentation, they fit in
/// 100 columns.
const MOST: usize = 76;
const BEFORE: usize = 46;

/// Mark at the end of a shortened line.
const CUT: &str = "…";

/// Step of a [`Path`](super::Path), owned.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Step {
    Key(String),
    Item(usize),
    Entry(usize),
}

/// Line and column, both counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Location {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

/// Line around the place of an error, shortened if necessary, without any character that a terminal would interpret.
///
/// The excerpt is displayed as two lines without a line feed at the end: the source with its line number, and a mark
/// below the place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Excerpt {
    line: usize,
    before: String,
    after: String,
}

impl Excerpt {
    /// Returns the line of `text` around `at`, or `None` if the text has no such line or the line may contain a secret.
    pub(crate) fn new(text: &[u8], at: Location) -> Option<Self> {
        let mut lines = text.split(|byte| *byte == b'\n').skip(at.line.checked_sub(1)?);
        let line = lines.next()?;
        // The CR of a line end is not part of the line.
        let line = line.strip_suffix(b"\r").filter(|_| lines.next().is_some()).unwrap_or(line);
        let line = String::from_utf8_lossy(line);
        if without_secrets(&line) != line {
            return None;
        }
        let column = at.column.saturating_sub(1);
        let start = column.saturating_sub(BEFORE);
        let mut characters = line.chars().skip(start);
        let before: String = characters.by_ref().take(column - start).collect();
        let after: String = characters.by_ref().take(MOST - (column - start)).collect();
        let cut = |is_cut| if is_cut { CUT } else { "" };
        let (left, right) = (cut(start > 0), cut(characters.next().is_some()));
        Some(Self {
            line: at.line,
            before: format!("{left}{}", Printable(before)),
            after: format!("{}{right}", Printable(after)),
        })
    }
}

impl Display for Excerpt {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let Self { line, before, after } = self;
        let margin = line.to_string().len();
        write!(f, "{line} | {before}{after}\n{:margin$} | {:columns$}^", "", "", columns = columns_of(before))
    }
}

/// Cuts the excerpts in the lines of a message to `columns`, around the marks below them; other lines stay as they are.
pub(crate) fn cut(lines: &mut [String], columns: usize) {
    for place in 1..lines.len() {
        let Some((margin, mark)) = margin_and_mark(&lines[place]) else { continue };
        let Some((number, source)) = lines[place - 1].split_at_checked(margin) else { continue };
        let room = columns.saturating_sub(margin);
        if !number.ends_with(" | ") || columns_of(source) <= room || room < LEAST {
            continue;
        }
        // What precedes the mark has the share of the line that it has in an excerpt.
        let start = mark.saturating_sub(room * BEFORE / MOST);
        let (mut column, mut before, mut shown) = (0, 0, String::new());
        for character in source.chars() {
            let width = columns_of(character.encode_utf8(&mut [0; 4]));
            let cut = usize::from(start > 0);
            if column < start + cut {
                before = column + width - cut;
            } else if column + width > before + room - 1 {
                break;
            } else {
                shown.push(character);
            }
            column += width;
        }
        let left = if start > 0 { CUT } else { "" };
        let right = if column < columns_of(source) { CUT } else { "" };
        lines[place - 1] = format!("{number}{left}{shown}{right}");
        lines[place] = format!("{}{:2$}^", &lines[place][..margin], "", mark - before);
    }
}

/// Fewest columns to which a source is cut.
const LEAST: usize = 16;

/// Returns the length of the margin of a line with a mark, and the columns between both; `None` for any other line.
fn margin_and_mark(line: &str) -> Option<(usize, usize)> {
    let (margin, rest) = line.split_once("| ")?;
    let blanks = rest.strip_suffix('^')?;
    let is_blank = |text: &str| text.bytes().all(|byte| byte == b' ');
    (is_blank(margin) && is_blank(blanks)).then_some((margin.len() + 2, blanks.len()))
}

/// Returns the columns that a text takes in a terminal: two for an East Asian character that [`Printable`] shows unescaped.
pub(crate) fn columns_of(text: &str) -> usize {
    let wide = ['\u{3001}'..='\u{30FF}', '\u{4E00}'..='\u{9FFF}', '\u{AC00}'..='\u{D7A3}', '\u{FF01}'..='\u{FF5E}'];
    text.chars().map(|c| if wide.iter().any(|range| range.contains(&c)) { 2 } else { 1 }).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::problem::{Problem, Unreadable};

    fn shown(text: &str, line: usize, column: usize) -> String {
        Excerpt::new(text.as_bytes(), Location { line, column }).unwrap().to_string()
    }

    #[test]
    fn the_mark_is_under_the_place() {
        assert_eq!(shown("a\nbc: 12,5\nd", 2, 5), "2 | bc: 12,5\n  |     ^");
        assert_eq!(shown("a", 1, 2), "1 | a\n  |  ^");
        assert_eq!(shown("\n", 2, 1), "2 | \n  | ^");
        assert_eq!(shown(&"\n".repeat(99), 100, 1), "100 | \n    | ^");
        assert_eq!(Excerpt::new(b"a\n", Location { line: 3, column: 1 }), None);
        assert_eq!(Excerpt::new(b"a\n", Location { line: 0, column: 0 }), None);
    }

    /// Each has two columns, by Unicode's UAX #11 (wide and fullwidth); Cyrillic letters have one.
    #[test]
    fn wide_characters_do_not_shift_the_mark() {
        assert_eq!(shown("名: \"東京\" x", 1, 9), format!("1 | 名: \"東京\" x\n  | {:11}^", ""));
        assert_eq!(shown("한국１ x", 1, 5), "1 | 한국１ x\n  |        ^");
        assert_eq!(shown("Москва x", 1, 8), "1 | Москва x\n  |        ^");
    }

    #[test]
    fn a_terminal_obeys_nothing_of_it() {
        assert_eq!(shown("\u{1b}[2Jx\r", 1, 5), "1 | \\u{1b}[2Jx\\r\n  |          ^");
        assert_eq!(shown("a\rb\r\nc", 1, 1), "1 | a\\rb\n  | ^");
        assert_eq!(shown("\t\u{202e}x", 1, 3), "1 | \\t\\u{202e}x\n  |           ^");
    }

    #[test]
    fn a_long_line_is_cut_around_the_place() {
        let text = format!("{}x{}", "o".repeat(1 << 19), "p".repeat(1 << 19));
        let due = format!("1 | …{}x{}…\n  | {:47}^", "o".repeat(46), "p".repeat(29), "");
        assert_eq!(shown(&text, 1, (1 << 19) + 1), due);
        let hostile = "\u{1b}".repeat(1 << 20);
        assert!(shown(&hostile, 1, 1 << 19).len() < 1000);
    }

    fn cut_to(columns: usize, text: &str, column: usize) -> [String; 2] {
        let mut lines: Vec<String> = shown(text, 12, column).lines().map(str::to_owned).collect();
        cut(&mut lines, columns);
        lines.try_into().unwrap()
    }

    /// Expected: by hand; the mark stays under the letter `x`, and no line is wider than the columns.
    #[test]
    fn an_excerpt_is_cut_to_the_width_of_the_terminal() {
        let text = format!("{}{}x{}", "\n".repeat(11), "a".repeat(40), "b".repeat(40));
        let [source, mark] = cut_to(30, &text, 41);
        assert_eq!(source, format!("12 | …{}x{}…", "a".repeat(14), "b".repeat(8)));
        assert_eq!(mark, format!("   | {:15}^", ""));
        // The beginning and the end of a line are not cut without need.
        let [source, mark] = cut_to(30, &text, 3);
        assert_eq!((source, mark), (format!("12 | {}…", "a".repeat(24)), "   |   ^".to_owned()));
        let [source, mark] = cut_to(30, &text, 81);
        assert_eq!((source, mark), (format!("12 | …{}b", "b".repeat(14)), format!("   | {:15}^", "")));
        let [source, mark] = cut_to(100, &text, 41);
        assert_eq!(mark.find('^').map(|at| &source[at..=at]), Some("x"));
        // A wide character takes two columns.
        let wide = format!("{}{}x{}", "\n".repeat(11), "東".repeat(30), "b".repeat(40));
        let [source, mark] = cut_to(31, &wide, 31);
        let at = columns_of(&source[..source.find('x').unwrap()]);
        assert_eq!((at, columns_of(&mark) - 1), (at, at));
        assert!(columns_of(&source) <= 31, "{source}");
        // Other lines stay.
        let mut others = ["a | b ^".to_owned(), "c".repeat(90)];
        cut(&mut others, 30);
        assert_eq!(others[1].len(), 90);
    }

    fn problem(line: usize) -> Problem {
        Problem::new(Some(Location { line, column: 1 }), "", "x", "y", "")
    }

    #[test]
    fn mistakes_at_one_place_share_its_line() {
        let refusal = Unreadable::of("f", vec![problem(1), problem(1), problem(2)]);
        assert_eq!(refusal.with_lines(""), refusal.to_string());
        let due = "f:1:1: found x, expected y\nf:1:1: found x, expected y\n1 | a\n  | ^\n\
                   f:2:1: found x, expected y (z)\n2 | b\n  | ^";
        assert_eq!(refusal.in_text(b"\xEF\xBB\xBFa\nb").with_lines(" (z)"), due);
    }

    #[test]
    fn a_private_key_does_not_come_back() {
        let refusal = Unreadable::of("f", vec![problem(2)]);
        let key = b"-----BEGIN OPENSSH PRIVATE KEY-----\nb3BlbnNzaC1rZXktdjEAAAAA\n";
        assert_eq!(refusal.clone().in_text(key).with_lines(""), refusal.to_string());
    }
}
