//! Recognised causes of errors in tables and files: the word in JSON, the place and the remedy. Expected: by hand, from what
//! spreadsheet programs, meters, editors and PowerShell write.

use crate::inside::reference::*;
use crate::text::cause::RefusalCause;
use crate::text::table::Table;
use crate::text::{Node, Unreadable, advice};
use dtg_passport::calibration::Readings;
use dtg_passport::trust::AllowedSigners;

/// The word of the cause of the first error, or an empty text, and its message.
type First = (&'static str, String);

fn first(refused: &Unreadable) -> First {
    let problem = &refused.problems()[0];
    (problem.cause.map_or("", RefusalCause::code), refused.to_string().lines().next().unwrap_or_default().to_owned())
}

/// Requires a cause, and what the message about `written` begins with and contains.
#[track_caller]
fn told(written: &str, (found, message): First, cause: &str, beginning: &str, words: &str) {
    assert_eq!(found, cause, "{written}: {message}");
    assert!(message.starts_with(beginning) && message.contains(words), "{written}: {message}");
}

/// Currents in all positions, with `header` instead of the usual one, and a row changed by `row` (its number, from 1).
fn currents(header: &str, row: impl Fn(usize, &str) -> String) -> First {
    let rows = include_str!("../../docs/currents.csv").lines().filter(|line| line.starts_with(['1', '2']));
    let rows: Vec<String> = rows.enumerate().map(|(index, line)| row(index + 1, line)).collect();
    let text = format!("{header}\n{}\n", rows.join("\n"));
    match Readings::from_csv("c.csv", text.as_bytes(), setup(&eight([[0.0; 3]; 8]), 55.7658).coefficients(), 1.0) {
        Ok(_) => ("read", String::new()),
        Err(refused) => first(&refused),
    }
}

const HEADER: &str = "i,j,jx_ma,jy_ma";

/// Expected: the cause, and the beginning of the message.
#[test]
fn a_row_that_is_not_of_readings_has_its_cause() {
    for (before, cause, beginning) in [
        (",,mA,mA", "units_row", "c.csv:4:1: found a row of units"),
        ("-,-,[мА],[мА]", "units_row", "c.csv:4:1:"),
        (HEADER, "repeated_header", "c.csv:4:1: found the header again"),
        ("\u{FEFF}i,j,jx_ma,jy_ma", "repeated_header", "c.csv:4:1:"),
        ("mean,,0.1,0.2", "summary_row", "c.csv:4:1: found a row of a statistic"),
        ("Среднее,0.1,0.2", "summary_row", "c.csv:4:1:"),
        (",СКО,0.1,0.2", "summary_row", "c.csv:4:1:"),
        ("1,mean,0.1,0.2", "summary_row", "c.csv:4:1:"),
        ("\u{1A}", "control_character", "c.csv:4:1: found control character U+001A"),
        ("\0\0\0", "control_character", "c.csv:4:1: found control character U+0000"),
        ("1,1,\u{2212}2,003831e-01,0.1", "decimal_comma", "c.csv:4:1: found 5 values"),
    ] {
        let found = currents(HEADER, |n, line| if n == 3 { format!("{before}\n{line}") } else { line.to_owned() });
        told(before, found, cause, beginning, "");
    }
}

#[test]
fn a_header_with_units_is_told_what_to_write() {
    for (header, cause, remedy) in [
        ("i,j,\"Jx, мА\",\"Jy, мА\"", "header_unit", "name it jx_ma, which states the unit"),
        ("i,j,Jx, мА,Jy, мА", "header_unit", "name it jx_ma"),
        ("i,j,J_x/mA,J_y/mA", "header_unit", "name it jx_ma"),
        ("i,j,Jx [мкА],Jy [мкА]", "header_unit", "convert the numbers, then name it jx_ma"),
        ("i,j,jx_мА,jy_мА", "header_unit", "name it jx_ma"),
        ("i,j,jx_uA,jy_ma", "", "convert the numbers, then name it jx_ma"),
        ("i,j,j\u{445}_ma,jy_ma", "", "only looks like a Latin letter; type jx_ma again"),
    ] {
        let found = currents(header, |_, line| line.to_owned());
        told(header, found, cause, "c.csv:1:5: found column", remedy);
    }
    // Commas within the names do not separate columns where semicolons do.
    let header = "i;j;Jx, мА;Jy, мА";
    told(header, currents(header, |_, line| line.replace(',', ";")), "header_unit", "", "");
}

#[test]
fn a_cell_that_is_not_a_number_has_its_cause() {
    for (written, cause) in [
        ("10. Sep", "spreadsheet_date"),
        ("10-Sep", "spreadsheet_date"),
        ("12.янв", "spreadsheet_date"),
        ("01.Feb", "spreadsheet_date"),
        ("Sep-26", "spreadsheet_date"),
        ("10.09.2026", "spreadsheet_date"),
        ("2026-09-10", "spreadsheet_date"),
        ("9.9E+37", "overload"),
        ("-9.91E37", "overload"),
        ("99999.9", "overload"),
        ("OL", "overload"),
        ("+OVLD", "overload"),
        ("Overload", "overload"),
        ("1.#INF", "overload"),
        ("\"-0,2003\"", "decimal_comma"),
        ("\"\u{2212}2,003831e-01\"", "decimal_comma"),
        ("\"1,234.5\"", "thousands"),
        ("-1\u{A0}234.5", "thousands"),
        ("1.234.567", "thousands"),
        ("1.5 mA", ""),
        ("a lot", ""),
    ] {
        let found = currents(HEADER, |n, line| if n == 3 { format!("1,3,{written},0.1") } else { line.to_owned() });
        told(written, found, cause, "c.csv:4:5: jx_ma: found ", "");
    }
}

#[test]
fn times_that_begin_again_at_midnight_are_told() {
    let clock = |row: usize| (85_000 + 300 * row) % 86_400;
    for (header, row) in [
        (",time_s", &(|n: usize| format!("{}", clock(n))) as &dyn Fn(usize) -> String),
        (",visit,time_s", &|n| format!("1,{}", clock(n))),
        (",cycle,time_s", &|n| format!("{},{}", 1 + n / 5, clock(n))),
    ] {
        let (found, message) = currents(&format!("{HEADER}{header}"), |n, line| format!("{line},{}", row(n)));
        assert!(message.ends_with("add 86400 s to them from there on"), "{message}");
        told(header, (found, message), "midnight", "", ": time_s: found 100 s");
    }
}

/// Returns what becomes of a table with the rows of `text`, the measured columns `a` and `b`, and others.
fn table(text: &str) -> First {
    let read = Table::read("t.csv", text.as_bytes(), [&["i", "j"], &["a", "b"], &["time_s"]]);
    read.map_or_else(|refused| first(&refused), |table| ("read", format!("{} rows", table.rows.len())))
}

/// Expected: refused where a number may have been split in two, and read where no digits can be the rest of a number.
#[test]
fn decimal_commas_between_commas_are_refused() {
    for (text, line) in [
        ("i,j,a,b,c,d,e\n1,1,10,60,-32,90,,,\n", 2),
        // Without the empty cells at the end, and with a further column on the left.
        ("i,j,a,b,c,d\n1,1,10,60,-32,90\n", 2),
        ("by,i,j,a,b,c,d\nme,1,1,10,60,-32,90\n", 2),
        // One column with decimals, which a cell too many, a leading zero or single digits show.
        ("i,j,a,b,c\n1,1,10,6,-33,\n", 2),
        ("i,j,a,b,c\n1,1,10,60,-33\n1,2,10,05,-33\n", 3),
        ("i,j,a,b,c\n1,1,10,6,-33\n1,2,-7,0,41\n", 2),
        ("i,j,a,b,remark,by\n1,1,10,5,3\n", 2),
        ("i,j,a,b\n1,1,10,6,-33,4\n", 2),
        ("i,j,a,b\n1,1,\u{2212}2,003831e-01,0.1\n", 2),
    ] {
        told(text, table(text), "decimal_comma", &format!("t.csv:{line}:1: "), "");
    }
    for text in [
        "i,j,a,b,c,d,e\n1,1,10.5,60.25,21,40,,,\n",
        "i,j,a,b,c\n1,1,10,-6,21\n1,2,12,17,21\n",
        "i,j,a,b,c,d\n1,1,-10,-6,-21,-4\n",
        "i,j,a,b,c\n1,1,10,60,21\n1,2,11,-58,21\n",
        "i,j,a,b,remark\n1,1,10,60\n1,2,12,17,good\n",
        "i,j,a,b,c,\n1,1,10,60,x,\n",
        // A name that begins like a statistic.
        "by,i,j,a,b\nMaxim,1,1,10,60\n",
    ] {
        told(text, table(text), "read", "", "");
    }
}

/// Whole arcseconds as spreadsheets of two countries write them are refused. Decimals are read, even if a single number shows
/// that they are decimals.
#[test]
fn separators_of_thousands_are_not_decimal_marks() {
    for rows in ["1;1;-622;-1.064\n1;2;12.345;17", "1;1;2,697;-2,136\n1;2;-459;63"] {
        told(rows, table(&format!("i;j;a;b\n{rows}")), "thousands", "", "without thousands separators");
    }
    for rows in [
        "1;1;-622.5;-1.064\n1;2;12.345;17",
        "1;1;0.622;-1.064\n1;2;12.345;17",
        "1;1;-622.001;-1.064\n1;2;12.345;17.000",
        "1;1;-622;1064\n1;2;12345;17",
        "1;1;1234.567;-1.064\n1;2;12.345;17",
    ] {
        told(rows, table(&format!("i;j;a;b\n{rows}")), "read", "", "");
    }
}

/// Expected: RFC 4180, sections 2.5 to 2.7; columns as counted by hand. Excel omits empty cells at the end of a row.
#[test]
fn cells_are_those_of_rfc_4180() {
    let text = "i,j,a,b,remark\n1,\"1\",\"b,b\",c,\"x\"\"y\" \nµ, \"2\",3,4\n";
    let read = Table::read("t.csv", text.as_bytes(), [&["i", "j"], &["a", "b"], &["remark"]]);
    assert!(read.unwrap_err().to_string().contains("found 4 values"), "remark is used, so it must be there");
    let read = Table::read("t.csv", text.as_bytes(), [&["i", "j"], &["a", "b"], &[]]).unwrap();
    let texts: Vec<&str> = read.rows[0].iter().map(|cell| cell.text.as_str()).collect();
    assert_eq!(texts, ["1", "1", "b,b", "c"]);
    let columns: Vec<usize> = read.rows[1].iter().map(|cell| cell.location.column).collect();
    assert_eq!(columns, [1, 4, 8, 10]);
    for line in ["1,1,\"2,3", "1,1,\"2\"3,4"] {
        assert!(table(&format!("i,j,a,b\n{line}\n")).1.contains("a quoted cell without a closing quote"), "{line}");
    }
    for (line, is_declaration) in [("sep=;", true), ("\"SEP=;\"", true), ("sep=;;", false), ("sep=x", false)] {
        assert_eq!(table(&format!("{line}\ni;j;a;b\n1;1;2;3\n")).0 == "read", is_declaration, "{line}");
    }
}

#[test]
fn the_advice_on_a_row_fits_its_number_of_cells() {
    for (separator, row, due) in [
        (',', "1,2,3", "add the values that are missing; if the reading was not taken, omit the whole row"),
        (',', "1,2,0.1,x,y", "name each column in the header, or delete what goes beyond it"),
        (',', "1;2;0,1;x", "separate columns by commas, and use decimal points"),
        (';', "1;2", "add the values that are missing; if the reading was not taken, omit the whole row"),
        (';', "1;2;0,1;x;y", "name each column in the header, or delete what goes beyond it"),
        (';', "1,2,0.1,x", "separate columns as in the header"),
        ('\t', "1\t2", "add the values that are missing; if the reading was not taken, omit the whole row"),
        ('\t', "1;2;0,1;x", "separate columns as in the header"),
    ] {
        let (_, message) = table(&format!("i,j,a,b\n{row}\n").replacen(",", &separator.to_string(), 3));
        assert!(message.ends_with(due), "{message}");
    }
}

#[test]
fn a_row_of_a_million_separators_is_refused() {
    let (_, message) = table(&format!("i,j,a,b\n{}\n", ",".repeat(1_040_000)));
    assert!(message.starts_with("t.csv:2:16385: found more than 16384 values in a row"), "{message}");
}

#[test]
fn a_misspelt_column_is_told_from_another() {
    for (found, due) in [
        ("time", Some("did you mean time_s?")),
        ("time_x", Some("did you mean time_s?")),
        ("time_of_day", None),
        ("k", None),
        ("remark", None),
    ] {
        let (cause, message) = table(&format!("i,j,a,b,{found}\n1,1,2.5,3.5,x\n"));
        assert_eq!((cause == "read", message.ends_with(due.unwrap_or("1 rows"))), (due.is_none(), true), "{message}");
    }
}

/// Expected: the one remedy for what a person wrote as the value of a key.
#[test]
fn a_value_of_yaml_that_is_not_a_number_has_its_cause() {
    let on = |text: &str| {
        let advice = advice::on_yaml(&Node::Text(text.to_owned()));
        (advice.cause.map_or("", RefusalCause::code), advice.words)
    };
    for (written, cause, remedy) in [
        ("1,500", "thousands", "without separators of thousands"),
        ("1.500,5", "thousands", "without separators of thousands"),
        ("-1 000,5", "thousands", "without separators of thousands"),
        ("1_500", "thousands", "without separators of thousands"),
        ("1'500", "thousands", "without separators of thousands"),
        ("0150", "leading_zero", "octal"),
        ("-007", "leading_zero", "octal"),
        ("150,0", "decimal_comma", "use a decimal point"),
        ("0,622", "decimal_comma", "use a decimal point"),
        ("12 Sep", "spreadsheet_date", "to text"),
        ("OL", "overload", "for an overload"),
        ("1.5", "", "without quotes"),
        ("\u{2212}5", "", "an ASCII minus"),
        ("nan", "", "a finite number"),
        ("a,b", "", ""),
        ("NORTH", "", ""),
    ] {
        let (found, words) = on(written);
        assert_eq!(found, cause, "{written}: {words}");
        assert!(words.contains(remedy) && words.is_empty() == remedy.is_empty(), "{written}: {words}");
    }
    assert!(advice::on_yaml(&Node::Number(f64::INFINITY)).words.contains("finite"));
}

/// Expected: the units by hand.
#[test]
fn another_unit_is_to_be_converted() {
    let known = ["alpha_arcsec", "u_alpha_arcsec", "jx_ma", "time_s", "gravity_m_per_s2", "omega_g_deg_per_h_per_g"];
    for (found, words) in [
        ("alpha_arcmin", "convert the numbers, then name it alpha_arcsec"),
        ("jx_A", "convert the numbers, then name it jx_ma"),
        ("gravity_mGal", "convert the numbers, then name it gravity_m_per_s2"),
        ("omega_g_rad_per_s_per_g", "convert the numbers, then name it omega_g_deg_per_h_per_g"),
        ("α, ″", "name it alpha_arcsec, which states the unit"),
        ("alpha (угл. с)", "name it alpha_arcsec, which states the unit"),
        ("time [s]", "name it time_s, which states the unit"),
    ] {
        assert_eq!(advice::on_name(&known, found).map(|advice| advice.words).as_deref(), Some(words), "{found}");
    }
    for other in ["alpha_arcsecs", "alfa_arcsec", "alpha", "jx_mA", "time_of_day", "omega_k_deg_per_h_per_g", "k"] {
        assert_eq!(advice::on_name(&known, other), None, "{other}");
    }
}

/// Expected: ssh-keygen(1): options are separated by commas, without spaces.
#[test]
fn a_space_between_options_of_a_trusted_key_is_named() {
    let key = include_str!("../../docs/allowed_signers").lines().last().unwrap().split_once("ssh-ed25519").unwrap().1;
    for (line, column) in [
        ("f@e.org namespaces=\"a\", valid-after=\"20260101Z\"", 24),
        ("f@e.org namespaces=\"a\" ,valid-after=\"20260101Z\"", 23),
        ("f@e.org namespaces=\"a\" valid-after=\"20260101Z\"", 23),
        ("f@e.org namespaces= \"a\"", 20),
        ("f@e.org, g@e.org", 10),
    ] {
        let text = format!("{line} ssh-ed25519{key}\n");
        let found = first(&AllowedSigners::parse("s", text.as_bytes()).unwrap_err());
        told(line, found, "option_blank", &format!("s:1:{column}: found a space"), "");
    }
}

fn utf16(text: &str) -> Vec<u8> {
    [0xFEFF].into_iter().chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect()
}

#[cfg(feature = "factory")]
mod of_the_factory {
    use super::*;
    use dtg_passport::certification::{AngleReadings, Header};
    use dtg_passport::{site::Site, stand::Stand};

    /// Expected: 1 turn = 1,296,000″ = 360°.
    #[test]
    fn a_full_turn_is_told_with_the_angle_that_is_meant() {
        let header = Header::from_yaml("h", include_bytes!("../../docs/header.yaml")).unwrap();
        let angles = include_str!("../../docs/angles.csv");
        for (written, cause, due) in [
            ("1295964.9", "full_turn", "which gives -35.1"),
            ("-1295964.9", "full_turn", "which gives 35.1"),
            ("9.9E+37", "overload", "exclude it with --exclude 1,1,1 and --why"),
            ("400000", "", "in arcseconds"),
        ] {
            let text = angles.replacen("1,1,1,10.9,-35.1", &format!("1,1,1,10.9,{written}"), 1);
            let found = first(&AngleReadings::from_csv("a", text.as_bytes(), &header.positions).unwrap_err());
            assert!(found.1.ends_with(due), "{found:?}");
            told(written, found, cause, "", "");
        }
        let stand = include_str!("../../passports/SPS-2/0017/stand.yaml");
        for (angle, other, due) in
            [("phi_deg: 0,", "phi_deg: 360,", "write 0,"), ("phi_deg: 90,", "phi_deg: -270,", "write 90,")]
        {
            let text = stand.replacen(angle, other, 1);
            told(other, first(&Stand::from_yaml("s", text.as_bytes()).unwrap_err()), "full_turn", "", due);
        }
        for (line, due) in [("longitude_deg: 317.5", "-42.5"), ("frame_axis_azimuth_deg: 360", "this one is 0")] {
            let found = site(line);
            assert!(found.1.ends_with(due), "{found:?}");
            told(line, found, "full_turn", "", "");
        }
    }

    const SITE: &str = "format: \"dtg-site/1\"\nid: \"here\"\nlatitude_deg: 55.5\n";

    /// Returns the refusal of a site file with one wrong line.
    fn site(line: &str) -> First {
        first(&Site::from_yaml("s", format!("{SITE}{line}\n").as_bytes()).unwrap_err())
    }

    #[test]
    fn invisible_characters_of_yaml_are_named_with_their_place() {
        for (line, cause, beginning) in [
            ("height_m:\u{A0}150", "no_break_space", "s:4:10: found no-break space U+00A0"),
            ("height_m: 1\u{A0}500", "no_break_space", "s:4:12:"),
            ("height_m: 1\u{202F}500", "no_break_space", "s:4:12: found no-break space U+202F"),
            ("uncertainty:\n\u{A0}\u{A0}level_arcsec: 1", "no_break_space", "s:5:1:"),
            ("name: \"a\u{A0}b\"", "no_break_space", "s:4:9:"),
            ("name: \"x # a\u{A0}b\"", "no_break_space", "s:4:7: name: found no-break space U+00A0"),
            ("\u{1A}", "control_character", "s:4:1: found control character U+001A"),
            ("height_m: 150\n\0\0", "control_character", "s:5:1: found control character U+0000"),
            ("height_m: 0150", "leading_zero", "s:4:11: height_m: found \"0150\""),
            ("height_m: 1,500", "thousands", "s:4:11: height_m: found \"1,500\""),
            ("deflection_arcsec: {xi: 1,5, eta: 2}", "decimal_comma", "s:4:27:"),
            ("deflection_arcsec: {xi: 1,500, eta: 2}", "thousands", "s:4:27:"),
        ] {
            told(line, site(line), cause, beginning, "");
        }
        assert!(Site::from_yaml("s", format!("{SITE}height_m: 150 # a\u{A0}b\n").as_bytes()).is_ok());
        told(SITE, first(&Site::from_yaml("s", &utf16(SITE)).unwrap_err()), "utf16", "", "");
    }

    /// Expected: the great-circle distance from 37.69 N, 55.77 E to Moscow (55.8 N, 37.6 E) on a sphere (6,371 km) is 2,428 km.
    #[test]
    fn exchanged_coordinates_are_told_with_the_distance() {
        let site = |latitude: f64, longitude: f64, id: &str| {
            let text =
                format!("format: \"dtg-site/1\"\nid: \"{id}\"\nlatitude_deg: {latitude}\nlongitude_deg: {longitude}\n");
            Site::from_yaml("s", text.as_bytes()).unwrap()
        };
        let other = |place: &Site| (place.id.to_string(), place.place().unwrap());
        let here = other(&site(55.75, 37.6, "here"));
        let exchanged = "latitude and longitude exchanged";
        for (id, others, due) in [("moscow-1", vec![], exchanged), ("there", vec![here.clone()], "from here")] {
            let words = site(37.69, 55.77, id).misplaced(&others).unwrap();
            let km: f64 = words.split(" km").next().unwrap().rsplit(' ').next().unwrap().parse().unwrap();
            assert!((km - 2428.0).abs() < 15.0 && words.contains(due), "{words}");
        }
        // A distant site is not wrong by itself.
        assert_eq!(site(1.3, 103.8, "there").misplaced(&[here]), None);
        assert_eq!(site(55.7658, 37.6856, "moscow-1").misplaced(&[]), None);
        let folder = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/sites")).unwrap();
        let paths =
            folder.map(|entry| entry.unwrap().path()).filter(|path| path.extension().is_some_and(|of| of == "yaml"));
        let sites: Vec<Site> = paths.map(|path| Site::from_yaml("s", &std::fs::read(path).unwrap()).unwrap()).collect();
        for place in &sites {
            let others: Vec<_> = sites.iter().filter(|other| other.id != place.id).map(other).collect();
            assert_eq!(place.misplaced(&others), None);
        }
    }

    /// Expected: Unicode's names of the characters.
    #[test]
    fn a_number_in_cyrillic_letters_that_look_latin_is_told() {
        let mut stand = Stand::from_yaml("s", include_bytes!("../../passports/SPS-2/0017/stand.yaml")).unwrap();
        assert_eq!(stand.certificate.odd_number(), None);
        stand.certificate.number = "\u{421}-2026-0142".to_owned();
        let words = stand.certificate.odd_number().unwrap();
        assert!(words.contains("Cyrillic letter 'С' (U+0421)") && words.contains("type C-2026-0142"), "{words}");
        stand.certificate.number = "\u{41F}-2026-0142".to_owned();
        assert_eq!(stand.certificate.odd_number(), None);
    }
}

/// Expected: what PowerShell's `>` writes is named; a byte order mark is not in the way.
#[test]
fn utf_16_is_named_in_every_input() {
    let signers = include_str!("../../docs/allowed_signers");
    let refused = [
        AllowedSigners::parse("f", &utf16(signers)).unwrap_err(),
        Table::read("f", &utf16("i,j,a,b\n"), [&["i", "j"], &["a", "b"], &[]]).unwrap_err(),
        dtg_passport::calibration::CalibrationDocument::from_json("f", &utf16("{}")).unwrap_err(),
    ];
    for refused in refused {
        told("UTF-16", first(&refused), "utf16", "f: found UTF-16, expected UTF-8; ", "PowerShell");
    }
    assert!(AllowedSigners::parse("f", format!("\u{FEFF}{signers}").as_bytes()).is_ok());
}
