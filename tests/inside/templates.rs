//! Templates of hand-written files: the readers of all of them accept them but for `CHANGE`.

use crate::dcc::Administrative;
use crate::earth::Place;
use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::site::Site;
use crate::template::{self, DCC, GYRO, LABORATORY};
use crate::text::{Problems, advice, yaml};

/// Fills in what is `CHANGE`, cells of a table with different numbers.
fn filled(template: &str) -> String {
    let mut number = 0;
    let mut cell = |cell: &str| {
        number += 1;
        if cell == "CHANGE" { format!("0.{number:03}") } else { cell.to_owned() }
    };
    let mut line = |line: &str| line.split(',').map(&mut cell).collect::<Vec<_>>().join(",") + "\n";
    let filled =
        template.lines().map(&mut line).collect::<String>().replace("issued: \"CHANGE", "issued: \"2026-01-31");
    filled.replace("\"CHANGE", "\"entered").replace(": CHANGE", ": 12.5")
}

fn site(id: &str, place: Option<Place>, height_m: Option<f64>) -> String {
    filled(&template::site(id, place, height_m))
}

#[test]
fn what_is_a_comment_is_right_too() {
    let uncommented = |text: &str| {
        let lines = text.lines().map(|line| match line.trim_start().strip_prefix("# ") {
            Some(rest)
                if rest.contains(": ") && !rest.contains('…') && rest.starts_with(|c: char| c.is_lowercase()) =>
            {
                format!("{}{rest}\n", &line[..line.len() - line.trim_start().len()])
            }
            _ => format!("{line}\n"),
        });
        lines.collect::<String>()
    };
    let place = Place { latitude_deg: 45.0, longitude_deg: -0.5 };
    let site = site("here", Some(place), None);
    let text = uncommented(&site);
    assert!(text.contains("\ndeflection_arcsec") && text.contains("\ngravity_m_per_s2"), "{text}");
    Site::from_yaml("here.yaml", text.as_bytes()).unwrap();
    Laboratory::from_yaml("laboratory.yaml", filled(&uncommented(LABORATORY)).as_bytes()).unwrap();
    let gyro = uncommented(GYRO).replace("_m_per_s2: CHANGE", "_m_per_s2: 9.8");
    GyroType::from_yaml("gyro.yaml", gyro.as_bytes()).unwrap();
    let dcc = filled(&uncommented(DCC));
    let read = Administrative::from_yaml("dcc.yaml", dcc.as_bytes()).unwrap();
    assert!(read.traceable == Some(true) && read.issued.is_some(), "{dcc}");
}

/// Expected: by hand. A comment and another word that begins like the placeholder are none.
#[test]
fn every_placeholder_is_found_at_its_place() {
    let text = "a: \"CHANGE\"  # CHANGE\nb: {c: [\"good\", \"CHANGE: where from\"]}\nd: \"CHANGED\"\n";
    let (node, text) = yaml::tree("f.yaml", text.as_bytes()).unwrap();
    let mut problems = Problems::default();
    advice::check_placeholders(&node, &mut problems);
    let refused = problems.refuse("f.yaml", &text).to_string();
    assert!(refused.contains("f.yaml:1:4: a: found \"CHANGE\", expected your value"), "{refused}");
    assert!(refused.contains("b.c[1]: found \"CHANGE: where from\""), "{refused}");
    assert_eq!(refused.matches("f.yaml:").count(), 2, "{refused}");
}
