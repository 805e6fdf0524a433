//! Templates of hand-written files: the readers of all of them accept them but for `CHANGE`.

use crate::calibration::Readings;
use crate::certification::{AngleReadings, Header};
use crate::coefficients::{EarthRate, StandGeometry};
use crate::dcc::Administrative;
use crate::earth::Place;
use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::site::Site;
use crate::stand::{CertifiedPosition, Stand};
use crate::template::{self, DCC, GYRO, LABORATORY, Positions, currents, header, readings, stand};
use crate::text::{Problems, placeholder, yaml};

const EIGHT: Positions = Positions(None);

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
fn stand_header_readings_and_currents_pass_their_readers() {
    let set = &EIGHT;
    let stand = Stand::from_yaml("stand.yaml", filled(&stand(set)).as_bytes()).unwrap();
    let header = Header::from_yaml("header.yaml", filled(&header(set)).as_bytes()).unwrap();
    assert_eq!((stand.positions.len(), header.positions.len()), (8, 8));
    let readings = filled(&readings(set, 5));
    let read = AngleReadings::from_csv("readings.csv", readings.as_bytes(), &header.positions).unwrap();
    assert_eq!((read.runs, read.each_arcsec.len()), (vec![1, 2, 3, 4, 5], 8));
    let positions: Vec<_> = stand.positions.iter().map(CertifiedPosition::to_model).collect();
    let coefficients = StandGeometry::new(&positions).unwrap().at(EarthRate::at_astronomic_latitude(45.0));
    let currents = filled(&currents(set));
    let read = Readings::from_csv("currents.csv", currents.as_bytes(), &coefficients, 1.0).unwrap();
    assert_eq!(read.positions().len(), 8);
}

#[test]
fn gyro_laboratory_and_site_pass_their_readers() {
    // A type that states no g would be compared at 9.80665 m/s², so the template asks for it.
    let type_at_9_8 = GYRO.replace("\ngravity_m_per_s2: CHANGE", "\ngravity_m_per_s2: 9.8");
    let gyro = GyroType::from_yaml("gyro.yaml", type_at_9_8.as_bytes()).unwrap();
    assert_eq!((gyro.nominal.clone(), gyro.gravity()), (GyroType::gvk_6().nominal, 9.8));
    assert!(GyroType::from_yaml("gyro.yaml", GYRO.as_bytes()).unwrap_err().to_string().contains("gravity_m_per_s2"));
    Laboratory::from_yaml("laboratory.yaml", filled(LABORATORY).as_bytes()).unwrap();
    Administrative::from_yaml("dcc.yaml", filled(DCC).as_bytes()).unwrap();
    let read = |text: &str| Site::from_yaml("here.yaml", text.as_bytes()).unwrap();
    // A site without a place is refused, with one error for each coordinate.
    let unknown = template::site("here", None, None).replace("\"CHANGE", "\"entered");
    let refused = Site::from_yaml("here.yaml", unknown.as_bytes()).unwrap_err().to_string();
    let told = "found \"CHANGE\", expected a number in degrees; replace the word from the template";
    assert_eq!(refused.matches(told).count(), 2, "{refused}");
    read(&site("here", None, None));
    // Expected: normal gravity of WGS 84 at 45° on the ellipsoid (NIMA TR8350.2, Somigliana), 9.80619769 m/s².
    let place = Place { latitude_deg: 45.0, longitude_deg: -0.5 };
    let on_the_ellipsoid = site("here", Some(place), Some(0.0));
    assert!(on_the_ellipsoid.contains("gravity_m_per_s2: 9.80620"), "{on_the_ellipsoid}");
    assert!(!on_the_ellipsoid.contains("_deg: CHANGE"));
    let read = read(&on_the_ellipsoid);
    assert_eq!((read.latitude_deg, read.longitude_deg, read.height_m), (Some(45.0), Some(-0.5), Some(0.0)));
    assert_eq!(read.id.as_str(), "here");
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
    placeholder::check(&node, &mut problems);
    let refused = problems.refuse("f.yaml", &text).to_string();
    assert!(refused.contains("f.yaml:1:4: a: found \"CHANGE\", expected your value"), "{refused}");
    assert!(refused.contains("b.c[1]: found \"CHANGE: where from\""), "{refused}");
    assert_eq!(refused.matches("f.yaml:").count(), 2, "{refused}");
}
