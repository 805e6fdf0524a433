//! The reader of signed passports and a general reader of YAML: both take the same texts, with the same content.

use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::passport::accuracy::Stated;
use crate::passport::annotations;
use crate::passport::content::{self, Content, Predecessor};
use crate::passport::issue::{Issue, Reissued, draft};
use crate::site::Site;
use crate::stand::Stand;
use crate::text::number::decimal;
use crate::text::{Field, Path, Problems, canonical, rule, yaml};

const PASSPORTS: [&str; 2] = [
    include_str!("../../passports/SPS-1/0203/moscow-bmstu-1.yaml"),
    include_str!("../../passports/SPS-2/0017/beijing-nim-1.yaml"),
];

/// Returns a payload that uses every key of a passport.
fn full() -> String {
    let site = r#"format: "dtg-site/1"
id: "bench"
name: "A bench \\ with a \"mark\", 北京"
latitude_deg: 55.7658
longitude_deg: 37.6856
height_m: 150.5
deflection_arcsec: {xi: -3.2, eta: 4.1, u: 1.5}
gravity_m_per_s2: 9.8156
gravity_u_m_per_s2: 1.0e-06
azimuth_mark: {name: "mark", latitude_deg: 55.7772, longitude_deg: 37.6924, pillar_latitude_deg: 55.7658, pillar_longitude_deg: 37.6856, position_u_m: 0.02}
valid_within_deg_per_h: 0.001
uncertainty: {}
"#;
    let stand = include_bytes!("../../passports/SPS-2/0017/stand.yaml");
    let stand = Stand::from_yaml("stand", stand).unwrap();
    let site = Site::from_yaml("site", site.as_bytes()).unwrap();
    let predecessor = Predecessor {
        id: "SPS-2/0017/moscow-bmstu/1".to_owned(),
        sha256: "0123456789abcdef".repeat(4),
        reason: "moved".to_owned(),
        changed: "site".to_owned(),
    };
    let order = Issue {
        reissued: Some(Reissued { from: predecessor, supersedes: true }),
        accuracy: Some(Stated { gyro: GyroType::gvk_6(), laboratory: Laboratory::paper() }),
        ..Issue::first("factory@example.org", "2026-11-09T08:00:00Z".parse().unwrap())
    };
    draft(&stand, &site, &order).unwrap().payload().to_owned()
}

fn payloads() -> Vec<String> {
    let shipped = PASSPORTS.iter().map(|text| text.split("signature: |").next().unwrap_or_default().to_owned());
    shipped.chain([full()]).collect()
}

/// Parses the text with a general YAML reader; returns `None` if its content, written again, gives different lines.
fn general(text: &str) -> Option<Content> {
    let (node, _) = yaml::tree("t", text.as_bytes()).ok()?;
    let mut problems = Problems::default();
    let content = Content::read(&node, &Path::Root, &mut problems)?;
    content.check(&mut problems);
    let same = rule::differs(text, &canonical::write_bare(&content)).is_none();
    (problems.is_empty() && same && content.format == "dtg-passport/1").then_some(content)
}

/// Returns `true` if the reader accepts the text. Among the texts that obey the rule of signed texts, it must
/// accept exactly those that a general YAML reader accepts, with the same content.
fn readers_agree(text: &str) -> bool {
    let read = content::read("t", text).ok();
    if read.is_some() || rule::check("t", text.as_bytes(), 1 << 20).is_ok() {
        // Compare as text, because 0.0 and -0.0 are equal as numbers.
        assert_eq!(format!("{read:?}"), format!("{:?}", general(text)), "{text}");
    }
    read.is_some()
}

#[test]
fn both_readers_take_every_passport() {
    for payload in payloads() {
        assert!(readers_agree(&payload), "{payload}");
        let content = content::read("t", &payload).unwrap();
        assert_eq!(annotations::payload(&content), payload);
    }
}

#[test]
fn readers_agree_on_every_altered_byte() {
    const OTHERS: &[u8] = b" \n:,-+.e09\"\\[]{}a#_\t~";
    let mut taken = 0;
    // The shipped payloads contain nothing that the full one does not.
    for payload in payloads().split_off(1) {
        for at in
            (0..payload.len()).step_by(2).filter(|at| payload.is_char_boundary(*at) && payload.is_char_boundary(at + 1))
        {
            let (before, after) = payload.split_at(at);
            let other = char::from(OTHERS[(at / 3) % OTHERS.len()]);
            // Alter every byte in one of three ways, chosen by its place.
            let altered = match at % 3 {
                0 => format!("{before}{other}{}", &after[1..]),
                1 => format!("{before}{}", &after[1..]),
                _ => format!("{before}{other}{after}"),
            };
            taken += usize::from(readers_agree(&altered));
        }
    }
    // Some altered comments, names and independent numbers are still accepted.
    assert!(taken > 1000, "{taken}");
}

#[test]
fn readers_agree_on_every_other_spelling_of_a_number() {
    for payload in payloads() {
        let digit = |c: char| c.is_ascii_digit() || "+-.e".contains(c);
        let mut at = 0;
        while let Some(start) = payload[at..].find([' ', '[']).map(|found| at + found + 1) {
            at = start;
            let word = &payload[start..start + payload[start..].find(|c| !digit(c)).unwrap_or(0)];
            let Ok(value) = word.parse::<f64>() else { continue };
            let of_word = ["+W", "0W", "W0", "-W", "\"W\"", "We+00"].map(|form| form.replace('W', word));
            let of_value = [format!("{value:e}"), format!("{value}"), decimal(-value), decimal(value.next_up())];
            let no_numbers = ["-0.0", ".inf", "inf", "nan", "1.0e+999"].map(str::to_owned);
            for other in of_word.into_iter().chain(of_value).chain(no_numbers) {
                let (before, after) = (&payload[..start], &payload[start + word.len()..]);
                readers_agree(&format!("{before}{other}{after}"));
            }
        }
    }
}
