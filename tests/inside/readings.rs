//! Currents in CSV: what is read, and every way in which a file is refused.

use crate::inside::reference::*;
use dtg_passport::calibration::readings::Exclusion;
use dtg_passport::calibration::{Readings, Setup};
use dtg_passport::coefficients::PositionIndex;

/// (file, what the message must say).
const BAD: [(&str, &[&str]); 48] = [
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
    ("i,j,jx_ua,jy_ma\n", &["c.csv:1:5", "\"jx_ua\"", "convert the numbers from µA to mA, then name it jx_ma"]),
    ("i,j,jx_ma,jy_ma,Cycles\n", &["c.csv:1:17", "\"Cycles\"", "did you mean cycle?"]),
    ("i,j,jx_ma,jy_ma,time_min\n", &["c.csv:1:17", "convert the numbers from min to s, then name it time_s"]),
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
    ("ROW 1,1,0.1mA,0.2\n", &["c.csv:2:5", "in the unit that the name states"]),
    ("ROW 1,1,(0.1),0.2\n", &["c.csv:2:5", "with a minus, without parentheses"]),
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

/// Expected: of currents that are cut at a limit in two positions of an axis, those positions; nothing of good ones.
#[test]
fn a_limit_of_the_meter_is_remarked_upon() {
    let setup = paper();
    assert_eq!(read(&setup, &good(&setup)).unwrap().remarks, Vec::<String>::new());
    let each = setup.coefficients().positions.iter().zip(currents(&setup, &gvk_6()));
    let cut = each.map(|(at, j)| format!("{},{},{:.6},{:.6}\n", at.index.i, at.index.j, j.x.max(-0.25), j.y));
    let found = read(&setup, &format!("i,j,jx_ma,jy_ma\n{}", cut.collect::<String>())).unwrap();
    let due = "c.csv: jx_ma: exactly -0.25, the largest current, in positions (1, 4), (2, 3); check whether the meter or the \
               feedback loop was at its limit";
    assert_eq!(found.remarks, [due]);
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
    let seven = read(&setup, &without("2,3,")).unwrap();
    assert_eq!((seven.positions().len(), seven.left_out.as_slice()), (7, [PositionIndex { i: 2, j: 3 }].as_slice()));
    let error = read(&setup, &good.replace("2,3,", "2,2,")).unwrap_err();
    assert!(error.contains("position (2, 2) occurs 2 times; check whether one of these rows"), "{error}");
    assert_eq!(
        read(&setup, &format!("{good}2,2,0.1,0.1\n")).unwrap().positions()[5]
            .visits
            .iter()
            .flat_map(|visit| &visit.each_ma)
            .count(),
        2
    );
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

/// (cycle, number, rows) of the visits to position (1, 1).
fn visits(text: &str) -> Vec<(u32, u32, usize)> {
    let setup = paper();
    let rest: String = good(&setup).lines().skip(2).map(|line| format!("{line},1,9,0\n")).collect();
    let (header, rows) = text.split_once('\n').unwrap();
    let all = format!("{header}\n{rows}{}", if header.contains("cycle") { rest } else { rest.replace(",1,9,0", "") });
    let readings = read(&setup, &all).unwrap();
    readings.positions()[0].visits.iter().map(|visit| (visit.cycle, visit.number, visit.each_ma.len())).collect()
}

/// Expected: the contract: without `visit` rows of a position that follow each other are one visit; another position or
/// another cycle begins a new one; with it the number counts, in any order of rows.
#[test]
fn visits_are_told_by_the_column_or_by_the_order() {
    let plain = "i,j,jx_ma,jy_ma\n1,1,0.1,0.2\n1,1,0.1,0.3\n1,2,0.1,0.3\n1,1,0.1,0.4\n";
    assert_eq!(visits(plain), [(1, 1, 2), (1, 2, 1)]);
    let header = "i,j,jx_ma,jy_ma,cycle,visit,time_s\n";
    let numbered =
        ["1,1,0.1,0.2,1,2,5.5", "1,1,0.1,0.3,1,1,0", "1,1,0.1,0.2,2,1,12", "1,2,0.1,0.2,2,1,13", "1,1,0.1,0.5,1,2,9"]
            .join("\n");
    assert_eq!(visits(&format!("{header}{numbered}\n")), [(1, 2, 2), (1, 1, 1), (2, 1, 1)]);
    let setup = paper();
    let good = good(&setup);
    let thrice = |line: &str| {
        let x = line.rsplit_once(',').unwrap().0;
        [(1, 1), (2, 2), (3, 2)].map(|(row, cycle)| format!("{x},0.{row},{cycle}\n"))
    };
    let cycles: String = good.lines().skip(1).flat_map(thrice).collect();
    let readings = read(&setup, &format!("i,j,jx_ma,jy_ma,cycle\n{cycles}")).unwrap();
    let first: Vec<_> = readings.positions()[0].visits.iter().map(|v| (v.cycle, v.number, v.each_ma.len())).collect();
    assert_eq!(first, [(1, 1, 1), (2, 1, 2)]);
}

/// Expected by hand: the mean of the visits' means, not of the rows.
#[test]
fn a_visit_counts_once_however_often_it_is_read() {
    let setup = paper();
    let rest: String = good(&setup).lines().skip(2).map(|line| format!("{line}\n")).collect();
    let rows = "1,1,0.1,0.2\n1,1,0.3,0.2\n1,1,0.2,0.2\n";
    let text = format!("i,j,jx_ma,jy_ma\n{rows}{rest}1,1,0.4,0.4\n");
    let mean = read(&setup, &text).unwrap().positions()[0].mean_ma;
    assert!((mean - nalgebra::Vector2::new(0.3, 0.3)).amax() < 1e-15, "{mean}");
}

/// A column with a name of its own is left out of account and named; its cells may be quoted.
#[test]
fn other_columns_are_named_and_left_out() {
    let setup = paper();
    let good = good(&setup);
    let mut lines = good.lines();
    let header = format!("{},operator,temp_c\n", lines.next().unwrap());
    let rows: String = lines.map(|line| format!("{line},\"N. N., \"\"day\"\" shift\" , 20.1\n")).collect();
    let found = read(&setup, &format!("{header}{rows}")).unwrap();
    assert_eq!(found.means_ma(), read(&setup, &good).unwrap().means_ma());
    assert_eq!(found.remarks, ["c.csv: the columns \"operator\", \"temp_c\" are ignored"]);
    assert_eq!(read(&setup, &good).unwrap().remarks, [""; 0]);
}

/// Expected: the paper's angles of its positions; 450° is 90°, and 270° is not 90°.
#[test]
fn nominal_angles_are_compared() {
    let setup = paper();
    let good = good(&setup);
    let with = |angles: [&str; 8]| {
        let rows: String = good.lines().skip(1).zip(angles).map(|(row, angle)| format!("{row},{angle}\n")).collect();
        read(&setup, &format!("i,j,jx_ma,jy_ma,theta_deg,phi_deg\n{rows}"))
    };
    let due = ["0,0", "0,90.2", "360,180", "0,-90", "90,0", "90,450", "89.5,180", "90,270"];
    assert_eq!(with(due).unwrap(), read(&setup, &good).unwrap());
    let clockwise = ["0,0", "0,270", "0,180", "0,90", "90,0", "90,270", "90,180", "90,90"];
    let error = with(clockwise).unwrap_err();
    for words in ["c.csv:3:", "phi_deg: found 270, expected 90, the nominal angle of position (1, 2)", "check i and j"]
    {
        assert!(error.contains(words), "{error}");
    }
    let error = with(["90,0", "0,90", "0,180", "0,270", "0,0", "90,90", "90,180", "90,270"]).unwrap_err();
    assert!(error.contains("theta_deg: found 90, expected 0"), "{error}");
    assert!(error.contains("theta_deg: found 0, expected 90"), "{error}");
}

/// Two visits at once, a cycle that visits one position alone, an exclusion that is not there: refused with the numbers.
#[test]
fn visits_and_cycles_that_cannot_be() {
    let setup = paper();
    let timed = |rows: &str| {
        let rest: String = good(&setup).lines().skip(1).map(|line| format!("{line},1,1,0\n")).collect();
        read(&setup, &format!("i,j,jx_ma,jy_ma,cycle,visit,time_s\n{rest}{rows}"))
    };
    let error = timed("1,1,0.1,0.2,1,2,60\n1,2,0.1,0.2,1,2,70\n1,1,0.1,0.2,1,2,80\n").unwrap_err();
    assert!(error.contains("c.csv:12:15") && error.contains("visit 2 of position (1, 1) again"), "{error}");
    let error = timed("1,1,0.1,0.2,2,1,60\n").unwrap_err();
    assert!(error.contains("one position alone in turn-on 2"), "{error}");

    let error = timed("1,1,0.1,0.2,2,1,-60\n1,2,0.1,0.2,2,1,-50\n").unwrap_err();
    assert!(error.contains("c.csv:10:17") && error.contains("after the last one of cycle 1, 0 s"), "{error}");
    let rows: String = good(&setup).lines().skip(1).zip(0..).map(|(row, t)| format!("{row},{}\n", 100 - t)).collect();
    let error = read(&setup, &format!("i,j,jx_ma,jy_ma,time_s\n{rows}")).unwrap_err();
    assert!(error.contains("c.csv:3:") && error.contains("not before that of the row above, 100 s"), "{error}");
    // Seconds of the day across midnight, and a clock set back by an hour: sorting the rows would turn a drift around.
    let times = |time: fn(u32) -> u32| {
        let rows =
            good(&setup).lines().skip(1).zip(0..).map(|(row, at)| format!("{row},{}\n", time(at))).collect::<String>();
        read(&setup, &format!("i,j,jx_ma,jy_ma,time_s\n{rows}")).unwrap_err()
    };
    let error = times(|at| (86_000 + 120 * at) % 86_400);
    assert!(error.contains("c.csv:6:") && error.contains("at midnight: add 86400 s"), "{error}");
    let error = times(|at| 10_000 + 120 * at - if at > 4 { 3600 } else { 0 });
    assert!(error.contains("c.csv:7:") && error.contains("set back by an hour: add 3600 s"), "{error}");
    let error = timed("1,1,0.1,0.2,1,3,60\n1,1,0.1,0.2,1,2,90\n").unwrap_err();
    assert!(error.contains("visit 2, 90 s; number the visits in the order of time"), "{error}");
    let error = timed("1,1,0.1,0.2,1,2,86300\n1,1,0.1,0.2,1,3,40\n").unwrap_err();
    assert!(
        error.contains("c.csv:11:17") && error.contains("not before that of the row above, 86300 s; the times seem"),
        "{error}"
    );

    // Three rounds of which every row says visit 1.
    let rows = good(&setup).lines().skip(1).map(|line| format!("{line},1\n")).collect::<String>();
    let merged = read(&setup, &format!("i,j,jx_ma,jy_ma,visit\n{}", rows.repeat(3))).unwrap();
    let said = merged.remarks.join(" ");
    assert!(said.contains("visit 1 to position (1, 1) are not next to each other"), "{said}");

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
    let setup = paper();
    let good = good(&setup);
    let remarks = |step: f64, cycles: u32, between: f64| {
        let rows = (1..=cycles).flat_map(|cycle| {
            let start = f64::from(cycle - 1) * between;
            let each = good.lines().skip(1).enumerate();
            each.map(move |(row, line)| format!("{line},{cycle},{}\n", start + step * row as f64))
        });
        let rows: String =
            rows.enumerate().map(|(place, row)| row.replacen(",0.", &format!(",0.0{place}"), 1)).collect();
        read(&setup, &format!("i,j,jx_ma,jy_ma,cycle,time_s\n{rows}")).map(|readings| readings.remarks)
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
    let rounds = (0..3).flat_map(|_| good.lines().skip(1)).enumerate();
    let rows: String = rounds.map(|(row, line)| format!("{line},{}\n", 5 * row)).collect();
    let minutes = read(&setup, &format!("i,j,jx_ma,jy_ma,time_s\n{rows}")).unwrap().remarks.join(" ");
    assert!(minutes.contains("23 moves to another position within 120 s, 5.0 s for each"), "{minutes}");
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
