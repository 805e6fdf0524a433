//! Currents in CSV: what is read, and every way in which a file is refused.

use crate::inside::reference::*;
use dtg_passport::calibration::readings::Exclusion;
use dtg_passport::calibration::{Readings, Setup};
use dtg_passport::coefficients::PositionIndex;
use nalgebra::Vector2;

/// (file, what the message must say).
const BAD: [(&str, &[&str]); 46] = [
    ("", &["empty file"]),
    ("# nothing\n\n", &["only spaces and comments"]),
    ("i;j;jx_ma;jy_ma\n1;1;0,1;0.2\n", &["c.csv:2:9", "decimal commas from line 2 on", "the whole file"]),
    ("i;j;jx_ma;jy_ma\n1,1,0.1,0.2\n", &["c.csv:2:1", "1 value,", "separate columns as in the header"]),
    ("1;1;0,1;0,2\n", &["c.csv:1:1", "numbers instead of the header"]),
    ("Kreisel 12, Stand 17;;;\n", &["c.csv:1:1", "no columns i, j, jx_ma, jy_ma", "put # before the lines"]),
    ("\"i,j,jx_ma,jy_ma\"\n", &["c.csv:1:1", "each row is one quoted cell"]),
    ("i j jx_ma jy_ma\n", &["c.csv:1:1", "separate columns by commas, semicolons or tabs"]),
    ("i;j;jx_ma;jy_ma\n1;1;−0,1;0,2\n", &["c.csv:2:5", "\"−0,1\""]),
    ("i;j,jx_ma,jy_ma\n", &["c.csv:1:1", "commas and semicolons", "commas between columns"]),
    ("i;j;jx_ma;jy_ma\n1;1;0,1\n", &["c.csv:2:1", "3 values", "omit the whole row"]),
    ("i\tj\tjx_ma,jy_ma\n", &["c.csv:1:1", "tabs and commas"]),
    ("i\tj\tjx_ma\tjy_ma\n1\t1\t\t0.2\n", &["c.csv:2:5", "jx_ma", "found nothing"]),
    ("i\tj\tjx_ma\tjy_ma\n1\t1\t0,1\t0.2\n", &["c.csv:2:9", "decimal commas from line 2 on"]),
    ("i,j,jx_ma\n1,1,0.1\n", &["c.csv:1:1", "no column jy_ma"]),
    ("i,j,Jx (mA),Jy (mA)\n", &["c.csv:1:5", "name it jx_ma, which states the unit"]),
    ("Gyro 12,,,\ni,j,jx_ma,jy_ma\n", &["c.csv:1:1", "no columns i, j, jx_ma, jy_ma", "put # before the lines"]),
    (
        "i,j,jx_ma,jy_ma,time_s\n1,1,0.1,0.2,45000.1\n1,2,0.1,0.2,45000.2\n",
        &["1 moves to another position within 0.10 s", "in days"],
    ),
    ("j,jx_ua,jy_ma\n", &["c.csv:1:3", "name it jx_ma", "found no column i, expected the header"]),
    ("i,j,jx_ua,jy_ma\n", &["c.csv:1:5", "\"jx_ua\"", "convert the numbers, then name it jx_ma"]),
    ("i,j,jx_ma,jy_ma,Cycles\n", &["c.csv:1:17", "\"Cycles\"", "did you mean cycle?"]),
    ("i,j,jx_ma,jy_ma,time_min\n", &["c.csv:1:17", "convert the numbers, then name it time_s"]),
    ("i,j,jx_ma,jy_ma,time\n", &["c.csv:1:17", "did you mean time_s?"]),
    ("i,j,jx_ma,jy_ma,visit\n1,1,0.1,0.2,0\n", &["c.csv:2:13", "visit", "a whole number of 1 or more"]),
    ("i,j,jx_ma,jy_ma,cycle\n1,1,0.1,0.2,\n", &["c.csv:2:13", "cycle", "found nothing"]),
    ("i,j,jx_ma,jy_ma,time_s\n1,1,0.1,0.2,noon\n", &["c.csv:2:13", "time_s", "a number"]),
    ("i,j,jx_ma,jy_ma,note\n1,1,0.1,0.2,\"a, b\n", &["c.csv:2:13", "a quoted cell without a closing quote"]),
    ("i,j,jx_ma,jy_ma,note\n1,1,0.1,0.2,a, b\n", &["c.csv:2:1", "6 values"]),
    ("i,j,jx_ma,jx_ma,jy_ma\n", &["c.csv:1:11", "duplicate column"]),
    ("1,1,0.1,0.2\n", &["c.csv:1:1", "add the header"]),
    ("ROW 1,1,0,1,0,2\n", &["c.csv:2:1", "6 values", "decimal comma"]),
    ("ROW 1,1,0.1\n", &["c.csv:2:1", "3 values", "4, for i, j, jx_ma, jy_ma"]),
    ("ROW 1\n", &["c.csv:2:1", "1 value,"]),
    ("ROW 1,1,#DIV/0!,0.2\n", &["c.csv:2:5", "jx_ma", "\"#DIV/0!\"", "a number; omit the whole row"]),
    ("ROW 1,1, NaN,0.2\n", &["c.csv:2:6", "a number; omit the whole row"]),
    ("ROW 1,1,0.1,inf\n", &["c.csv:2:9", "jy_ma", "a number; omit the whole row"]),
    ("ROW 1,1,0.1,\n", &["c.csv:2:9", "found nothing", "omit the whole row"]),
    ("ROW 1,1,9.9E+37,0.2\n", &["c.csv:2:5", "found 9.9E+37", "for an overload"]),
    ("ROW 1,1,1e6,0.2\n", &["c.csv:2:5", "found 1e6", "the range of the meter"]),
    ("ROW 1,1,-104.9,0.2\n", &["c.csv:2:5", "it may be in microamperes"]),
    ("ROW 3,1,0.1,0.2\n", &["c.csv:2:1", "position (3, 1)", "stand, and that i and j are not exchanged"]),
    ("ROW 5,1,0.1,0.2\n", &["c.csv:2:1", "position (5, 1)", "check that this is the passport of this stand"]),
    ("ROW 90,270,0.1,0.2\n", &["c.csv:2:1", "position (90, 270)", "not degrees"]),
    ("ROW 0,1,0.1,0.2\n", &["c.csv:2:1", "a whole number of 1 or more; count from 1"]),
    ("ROW 1,1.5,0.1,0.2\n", &["c.csv:2:3", "a whole number of 1 or more"]),
    ("ROW 1,1,x,0.2\n1,2,0.1,2.5\n", &["c.csv:2:5", "c.csv:3:9"]),
];

const HEADER: &str = "i,j,jx_ma,jy_ma";

fn paper() -> Setup {
    setup(&eight([[1e-3; 3]; 8]), LATITUDE_DEG)
}

fn read(text: &str) -> Result<Readings, String> {
    Readings::from_csv("c.csv", text.as_bytes(), paper().coefficients(), 1.0).map_err(|error| error.to_string())
}

/// A good file of the paper's gyro, with the currents as `shown`.
fn file(shown: impl Fn(Vector2<f64>) -> String) -> String {
    let setup = paper();
    let each = setup.coefficients().positions.iter().zip(currents(&setup, &gvk_6()));
    let rows = each.map(|(at, j)| format!("{},{},{}\n", at.index.i, at.index.j, shown(j)));
    format!("{HEADER}\n{}", rows.collect::<String>())
}

fn good() -> String {
    file(|j| format!("{},{}", j.x, j.y))
}

/// The rows of the good file from a place on, each followed by the cells that `more` gives for its number, from 0.
fn rows(from: usize, more: impl Fn(usize) -> String) -> String {
    good().lines().skip(1 + from).enumerate().map(|(row, line)| format!("{line}{}\n", more(row))).collect()
}

/// Reads the good file with another column.
fn with_column(name: &str, cell: impl Fn(usize) -> String) -> Result<Readings, String> {
    read(&format!("{HEADER},{name}\n{}", rows(0, |row| format!(",{}", cell(row)))))
}

#[track_caller]
fn refused(found: Result<Readings, String>, words: &[&str]) {
    let error = found.unwrap_err();
    assert!(words.iter().all(|word| error.contains(word)), "{error:?} without one of {words:?}");
}

/// Expected: of currents that are cut at a limit in two positions of an axis, those positions; nothing of good ones.
#[test]
fn a_limit_of_the_meter_is_remarked_upon() {
    assert_eq!(read(&good()).unwrap().remarks, Vec::<String>::new());
    let found = read(&file(|j| format!("{:.6},{:.6}", j.x.max(-0.25), j.y))).unwrap();
    let due = "c.csv: jx_ma: exactly -0.25, the largest current, in positions (1, 4), (2, 3); check whether the meter or the \
               feedback loop was at its limit";
    assert_eq!(found.remarks, [due]);
}

#[test]
fn bad_files_are_refused_with_their_place() {
    for (text, words) in BAD {
        let text = text.replace("ROW ", &format!("{HEADER}\n"));
        let error = read(&text).expect_err(&text);
        for word in words {
            assert!(error.contains(word), "{text:?} gives {error:?}, without {word:?}");
        }
    }
}

#[test]
fn a_position_missing_or_double() {
    let good = good();
    let seven: String = good.lines().filter(|line| !line.starts_with("2,3,")).map(|line| format!("{line}\n")).collect();
    let seven = read(&seven).unwrap();
    assert_eq!((seven.positions().len(), seven.left_out.as_slice()), (7, [PositionIndex { i: 2, j: 3 }].as_slice()));
    let words = ["position (2, 2) occurs 2 times; check whether one of these rows"];
    refused(read(&good.replace("2,3,", "2,2,")), &words);
    let double = read(&format!("{good}2,2,0.1,0.1\n")).unwrap();
    assert_eq!(double.positions()[5].visits.iter().map(|visit| visit.each_ma.len()).sum::<usize>(), 2);
}

/// Order of columns and rows, comments, blanks, a byte order mark and CR LF change nothing.
#[test]
fn form_does_not_matter() {
    let expected = read(&good()).unwrap();
    assert_eq!(expected.means_ma(), currents(&paper(), &gvk_6()));
    let reordered = |line: &str| match line.split(',').collect::<Vec<_>>()[..] {
        [i, j, x, y] => format!(" {y} , {j},{i}, {x}"),
        _ => unreachable!("four cells"),
    };
    let mut rows: Vec<String> = good().lines().map(reordered).collect();
    rows[1..].reverse();
    rows.insert(1, "# a comment, with a comma".to_owned());
    rows.insert(3, String::new());
    let other = format!("\u{feff}{}\r\n", rows.join("\r\n"));
    assert_eq!(read(&other).unwrap(), expected);
}

/// (cycle, number, rows) of the visits to position (1, 1), in a file whose other positions are read once.
fn visits(columns: &str, of_first: &str) -> Vec<(u32, u32, usize)> {
    let rest = rows(1, |_| if columns.is_empty() { String::new() } else { ",1,9,0".to_owned() });
    let readings = read(&format!("{HEADER}{columns}\n{of_first}\n{rest}")).unwrap();
    readings.positions()[0].visits.iter().map(|visit| (visit.cycle, visit.number, visit.each_ma.len())).collect()
}

/// Expected: the contract: without `visit` rows of a position that follow each other are one visit; another position or
/// another cycle begins a new one; with it the number counts, in any order of rows.
#[test]
fn visits_are_told_by_the_column_or_by_the_order() {
    let plain = "1,1,0.1,0.2\n1,1,0.1,0.3\n1,2,0.1,0.3\n1,1,0.1,0.4";
    assert_eq!(visits("", plain), [(1, 1, 2), (1, 2, 1)]);
    let numbered =
        ["1,1,0.1,0.2,1,2,5.5", "1,1,0.1,0.3,1,1,0", "1,1,0.1,0.2,2,1,12", "1,2,0.1,0.2,2,1,13", "1,1,0.1,0.5,1,2,9"]
            .join("\n");
    assert_eq!(visits(",cycle,visit,time_s", &numbered), [(1, 2, 2), (1, 1, 1), (2, 1, 1)]);
    let good = good();
    let thrice = |line: &str| {
        let x = line.rsplit_once(',').unwrap().0;
        [(1, 1), (2, 2), (3, 2)].map(|(row, cycle)| format!("{x},0.{row},{cycle}\n"))
    };
    let cycles: String = good.lines().skip(1).flat_map(thrice).collect();
    let readings = read(&format!("{HEADER},cycle\n{cycles}")).unwrap();
    let first: Vec<_> = readings.positions()[0].visits.iter().map(|v| (v.cycle, v.number, v.each_ma.len())).collect();
    assert_eq!(first, [(1, 1, 1), (2, 1, 2)]);
}

/// Expected by hand: the mean of the visits' means, not of the rows.
#[test]
fn a_visit_counts_once_however_often_it_is_read() {
    let rest = rows(1, |_| String::new());
    let text = format!("{HEADER}\n1,1,0.1,0.2\n1,1,0.3,0.2\n1,1,0.2,0.2\n{rest}1,1,0.4,0.4\n");
    let mean = read(&text).unwrap().positions()[0].mean_ma;
    assert!((mean - Vector2::new(0.3, 0.3)).amax() < 1e-15, "{mean}");
}

/// A column with a name of its own is left out of account and named; its cells may be quoted.
#[test]
fn other_columns_are_named_and_left_out() {
    let found = with_column("operator,temp_c", |_| "\"N. N., \"\"day\"\" shift\" , 20.1".to_owned()).unwrap();
    assert_eq!(found.means_ma(), read(&good()).unwrap().means_ma());
    assert_eq!(found.remarks, ["c.csv: the columns \"operator\", \"temp_c\" are ignored"]);
}

/// Expected: the paper's angles of its positions; 450° is 90°, and 270° is not 90°.
#[test]
fn nominal_angles_are_compared() {
    let with = |angles: [&str; 8]| with_column("theta_deg,phi_deg", |row| angles[row].to_owned());
    let due = ["0,0", "0,90.2", "360,180", "0,-90", "90,0", "90,450", "89.5,180", "90,270"];
    assert_eq!(with(due).unwrap(), read(&good()).unwrap());
    let clockwise = ["0,0", "0,270", "0,180", "0,90", "90,0", "90,270", "90,180", "90,90"];
    let nominal = "phi_deg: found 270, expected 90, the nominal angle of position (1, 2)";
    refused(with(clockwise), &["c.csv:3:", nominal, "check i and j"]);
    let exchanged = ["90,0", "0,90", "0,180", "0,270", "0,0", "90,90", "90,180", "90,270"];
    refused(with(exchanged), &["theta_deg: found 90, expected 0", "theta_deg: found 0, expected 90"]);
}

/// Reads a run whose positions are visited once at 0 s, and `more` rows of it.
fn timed(more: &str) -> Result<Readings, String> {
    read(&format!("{HEADER},cycle,visit,time_s\n{}{more}", rows(0, |_| ",1,1,0".to_owned())))
}

/// Two visits at once, a cycle that visits one position alone, times that go back: refused with the numbers.
#[test]
fn visits_and_cycles_that_cannot_be() {
    for (more, words) in [
        (
            "1,1,0.1,0.2,1,2,60\n1,2,0.1,0.2,1,2,70\n1,1,0.1,0.2,1,2,80\n",
            ["c.csv:12:15", "visit 2 of position (1, 1) again"],
        ),
        ("1,1,0.1,0.2,2,1,60\n", ["c.csv: found one position", "alone in turn-on 2"]),
        ("1,1,0.1,0.2,2,1,-60\n1,2,0.1,0.2,2,1,-50\n", ["c.csv:10:17", "after the last one of cycle 1, 0 s"]),
        (
            "1,1,0.1,0.2,1,3,60\n1,1,0.1,0.2,1,2,90\n",
            ["c.csv:10:17", "visit 2, 90 s; number the visits in the order of time"],
        ),
        (
            "1,1,0.1,0.2,1,2,86300\n1,1,0.1,0.2,1,3,40\n",
            ["c.csv:11:17", "not before that of the row above, 86300 s; the times seem"],
        ),
    ] {
        refused(timed(more), &words);
    }
    let times = |time: fn(usize) -> usize| with_column("time_s", |row| time(row).to_string());
    refused(times(|row| 100 - row), &["c.csv:3:", "not before that of the row above, 100 s"]);
    // Seconds of the day across midnight, and a clock set back by an hour: sorting the rows would turn a drift around.
    refused(times(|row| (86_000 + 120 * row) % 86_400), &["c.csv:6:", "at midnight: add 86400 s"]);
    let set_back = times(|row| 10_000 + 120 * row - if row > 4 { 3600 } else { 0 });
    refused(set_back, &["c.csv:7:", "set back by an hour: add 3600 s"]);
    // Three rounds of which every row says visit 1.
    let merged = read(&format!("{HEADER},visit\n{}", rows(0, |_| ",1".to_owned()).repeat(3))).unwrap();
    let said = merged.remarks.join(" ");
    assert!(said.contains("visit 1 to position (1, 1) are not next to each other"), "{said}");
}

#[test]
fn an_exclusion_is_of_one_visit_that_there_is() {
    let (first, other) = (PositionIndex { i: 1, j: 1 }, PositionIndex { i: 1, j: 2 });
    let exclusion =
        |PositionIndex { i, j }, visit, cycle| Exclusion { i, j, visit, cycle, why: "table was knocked".to_owned() };
    let mut readings = timed("1,1,0.1,0.2,2,1,60\n1,2,0.1,0.2,2,1,70\n1,2,0.3,0.2,1,2,50\n").unwrap();
    let error = readings.exclude(exclusion(first, 1, None)).unwrap_err();
    assert!(error.contains("turn-ons 1, 2") && error.contains("as in 1,1,1,1"), "{error}");
    let error = readings.exclude(exclusion(first, 7, None)).unwrap_err();
    assert!(error.contains("no visit 7 to position (1, 1)"), "{error}");
    readings.exclude(exclusion(other, 2, None)).unwrap();
    assert_eq!(readings.exclusions, [exclusion(other, 2, Some(1))]);
    assert_eq!(readings.positions()[1].visits.len(), 2);
    readings.exclude(exclusion(PositionIndex { i: 2, j: 4 }, 1, None)).unwrap();
    assert_eq!(readings.left_out, [PositionIndex { i: 2, j: 4 }]);
}

/// Expected: eight positions two minutes apart, counted in seconds, in minutes and in milliseconds; over three days between
/// two turn-ons, which are no moves; hours and days are refused. A position that is read again is moved to again.
#[test]
fn times_that_may_be_in_another_unit_are_named() {
    let remarks = |step: f64, cycles: usize, between: f64| {
        let each =
            |cycle: usize| rows(0, |row| format!(",{},{}", cycle + 1, between * cycle as f64 + step * row as f64));
        // A second round is no copy of the first.
        let rounds = (0..cycles).map(|cycle| each(cycle).replace(",0.", if cycle == 0 { ",0." } else { ",0.0" }));
        read(&format!("{HEADER},cycle,time_s\n{}", rounds.collect::<String>())).map(|readings| readings.remarks)
    };
    let none = Vec::<String>::new();
    assert_eq!(remarks(120.0, 1, 0.0), Ok(none.clone()));
    assert_eq!(remarks(120.0, 2, 259_200.0), Ok(none));
    let minutes = remarks(2.0, 1, 0.0).unwrap();
    assert!(minutes[0].contains("7 moves") && minutes[0].contains("14 s, 2.0 s for each"), "{minutes:?}");
    assert!(minutes[0].contains("in minutes") && minutes[0].ends_with("60 times too large"), "{minutes:?}");
    let milliseconds = remarks(120_000.0, 1, 0.0).unwrap();
    assert!(milliseconds[0].contains("in milliseconds") && milliseconds[0].ends_with("1000 times too small"));
    assert!(remarks(120.0 / 3600.0, 1, 0.0).unwrap_err().contains("seconds"));
    let rounds: String = (0..3).map(|round| rows(0, |row| format!(",{}", 5 * (8 * round + row)))).collect();
    let minutes = read(&format!("{HEADER},time_s\n{rounds}")).unwrap().remarks.join(" ");
    assert!(minutes.contains("23 moves to another position within 120 s, 5.0 s for each"), "{minutes}");
}

#[test]
fn an_axis_without_current() {
    refused(read(&file(|_| "0.0,0.0".to_owned())), &["all zero"]);
    refused(read(&file(|j| format!("{},0.0", j.x))), &["J_y"]);
    refused(read(&file(|j| format!("0.0,{}", j.y))), &["J_x"]);
}
