//! Currents in CSV: what is read, and every way in which a file is refused.

#![cfg(feature = "cli")]

mod support;

use dtg_passport::calibration::{Readings, Setup};
use support::*;

/// (file, what the message must say).
const BAD: [(&str, &[&str]); 21] = [
    ("", &["empty file"]),
    ("# nothing\n\n", &["nothing but blanks and comments"]),
    ("i;j;jx_ma;jy_ma\n1;1;0,1;0,2\n", &["c.csv:1:1", "semicolons", "commas between the columns"]),
    ("i\tj\tjx_ma\tjy_ma\n", &["c.csv:1:1", "tabs"]),
    ("i,j,jx_ma\n1,1,0.1\n", &["c.csv:1:1", "no column jy_ma"]),
    ("i,j,jx_ua,jy_ma\n", &["c.csv:1:5", "\"jx_ua\"", "did you mean jx_ma?"]),
    ("i,j,jx_ma,jx_ma,jy_ma\n", &["c.csv:1:11", "a second time"]),
    ("1,1,0.1,0.2\n", &["c.csv:1:1", "add the header"]),
    ("ROW 1,1,0,1,0,2\n", &["c.csv:2:1", "6 values", "decimal comma"]),
    ("ROW 1,1,0.1\n", &["c.csv:2:1", "3 values"]),
    ("ROW 1,1,abc,0.2\n", &["c.csv:2:5", "jx_ma", "\"abc\"", "a number"]),
    ("ROW 1,1, NaN,0.2\n", &["c.csv:2:6", "a finite number"]),
    ("ROW 1,1,0.1,inf\n", &["c.csv:2:9", "jy_ma", "a finite number"]),
    ("ROW 1,1,0.1,\n", &["c.csv:2:9", "found nothing", "leave out the whole row"]),
    ("ROW 1,1,0.1mA,0.2\n", &["c.csv:2:5", "the unit is in the column's name"]),
    ("ROW 1,1,1e6,0.2\n", &["c.csv:2:5", "1000000", "the meter's range"]),
    ("ROW 1,1,-104.9,0.2\n", &["c.csv:2:5", "is it in microamperes?"]),
    ("ROW 3,1,0.1,0.2\n", &["c.csv:2:1", "position (3, 1)", "is it the passport of this stand?"]),
    ("ROW 0,1,0.1,0.2\n", &["c.csv:2:1", "a whole number from 1"]),
    ("ROW 1,1.0,0.1,0.2\n", &["c.csv:2:3", "a whole number from 1"]),
    ("ROW 1,1,x,0.2\n1,2,0.1,2.5\n", &["c.csv:2:5", "c.csv:3:9"]),
];

fn paper() -> Setup {
    setup(&eight([[1e-3; 3]; 8]), LATITUDE_DEG)
}

fn read(setup: &Setup, text: &str) -> Result<Readings, String> {
    Readings::from_csv("c.csv", text.as_bytes(), setup.coefficients(), 1.0).map_err(|error| error.to_string())
}

/// A good file of the paper's gyro.
fn good(setup: &Setup) -> String {
    let each = setup.coefficients().positions.iter().zip(currents(setup, &gvk_6()));
    let rows = each.map(|(at, j)| format!("{},{},{},{}\n", at.index.i, at.index.j, j.x, j.y));
    format!("i,j,jx_ma,jy_ma\n{}", rows.collect::<String>())
}

#[test]
fn bad_files_are_refused_with_their_place() {
    let setup = paper();
    for (text, words) in BAD {
        let text = text.replace("ROW ", "i,j,jx_ma,jy_ma\n");
        let error = read(&setup, &text).expect_err(&text);
        for word in words {
            assert!(error.contains(word), "{text:?} gives {error:?}, without {word:?}");
        }
    }
}

#[test]
fn a_position_missing_or_double() {
    let setup = paper();
    let good = good(&setup);
    let without = |start: &str| good.lines().filter(|line| !line.starts_with(start)).collect::<Vec<_>>().join("\n");
    let error = read(&setup, &without("2,3,")).unwrap_err();
    assert!(error.contains("no reading of position (2, 3)"), "{error}");
    let error = read(&setup, &good.replace("2,3,", "2,2,")).unwrap_err();
    assert!(error.contains("position (2, 2) stands 2 times: is one of them this one?"), "{error}");
    assert_eq!(read(&setup, &format!("{good}2,2,0.1,0.1\n")).unwrap().positions()[5].each_ma.len(), 2);
}

#[test]
fn an_axis_without_current() {
    let setup = paper();
    let good = good(&setup);
    let with = |x: bool, y: bool| {
        let rows = good.lines().skip(1).map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            let cell = |keep: bool, place: usize| if keep { cells[place] } else { "0.0" };
            format!("{},{},{},{}\n", cells[0], cells[1], cell(x, 2), cell(y, 3))
        });
        read(&setup, &format!("i,j,jx_ma,jy_ma\n{}", rows.collect::<String>())).unwrap_err()
    };
    assert!(with(false, false).contains("all zero"));
    assert!(with(true, false).contains("J_y"));
    assert!(with(false, true).contains("J_x"));
}

/// Order of columns and rows, comments, blanks, a byte order mark and CR LF change nothing.
#[test]
fn form_does_not_matter() {
    let setup = paper();
    let good = good(&setup);
    let expected = read(&setup, &good).unwrap();
    assert_eq!(expected.means_ma(), currents(&setup, &gvk_6()));
    let mut rows: Vec<String> = good
        .lines()
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            format!(" {} , {},{}, {}", cells[3], cells[1], cells[0], cells[2])
        })
        .collect();
    rows[1..].reverse();
    rows.insert(1, "# a comment, with a comma".to_owned());
    rows.insert(3, String::new());
    let other = format!("\u{feff}{}\r\n", rows.join("\r\n"));
    assert_eq!(read(&setup, &other).unwrap(), expected);
}
