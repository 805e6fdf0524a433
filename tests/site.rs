//! A site: latitude, rates, gravity, radius, mark, and the check of place. Expected values by hand or from the sources named.

#![cfg(feature = "cli")]

use dtg_passport::earth::{Place, place_at};
use dtg_passport::passport::checks::{CheckName, Code};
use dtg_passport::passport::{Question, Trust, Verification, issue, verify};
use dtg_passport::signing::allowed_signers_line;
use dtg_passport::site::Site;
use dtg_passport::stand::Stand;
use dtg_passport::trust::{AllowedSigners, SigningKey};

/// 0.1″ in degrees.
const TENTH_OF_ARCSECOND_DEG: f64 = 0.1 / 3600.0;

fn site(keys: &str) -> Site {
    let text = format!("format: \"dtg-site/1\"\nid: \"here\"\n{keys}");
    Site::from_yaml("here.yaml", text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_stand_hangs_on_the_plumb_line() {
    // Φ = φ + ξ: 3600″ would be a degree; 36″ are 0.01°.
    let deflected = site("latitude_deg: 45.0\ndeflection_arcsec: {xi: 36.0, eta: 0.0}");
    assert!((deflected.earth().latitude_deg - 45.01).abs() < 1e-13);
    let measured = site("astronomic_latitude_deg: 45.01\ndeflection_arcsec: {xi: 36.0, eta: 0.0}");
    assert_eq!(measured.earth().latitude_deg, 45.01);
    assert!((measured.geodetic_deg() - 45.0).abs() < 1e-13);
    // At 45° both rates are Ω/√2.
    let rate = 15.041_066_876_065_45 / std::f64::consts::SQRT_2;
    let earth = site("latitude_deg: 45.0").earth();
    assert!((earth.horizontal_deg_per_h - rate).abs() < 4e-15 && (earth.vertical_deg_per_h - rate).abs() < 4e-15);
    // South: the vertical rate points down.
    assert!(site("latitude_deg: -45.0").earth().vertical_deg_per_h < 0.0);
}

#[test]
fn gravity_is_the_measured_one_or_the_normal_one() {
    assert_eq!(site("latitude_deg: 55.0\ngravity_m_per_s2: 9.8156").earth().gravity_m_per_s2, 9.8156);
    // WGS 84 normal gravity at 45°, 9.8061977694 m/s²; above the ellipsoid, in mGal with h in m (Heiskanen and Moritz,
    // section 2-10): less by (0.30877 − 0.00045 sin²φ) h − 0.000072 h², here by 308.473.
    let normal = site("latitude_deg: 45.0").earth().gravity_m_per_s2;
    assert!((normal - 9.8061977694).abs() < 6e-11);
    let high = site("latitude_deg: 45.0\nheight_m: 1000.0").earth().gravity_m_per_s2;
    assert!((normal - high - 0.00308473).abs() < 1e-7);
}

#[test]
fn the_mark_gives_an_astronomic_azimuth() {
    let pillar = Place { latitude_deg: 45.0, longitude_deg: 10.0 };
    let mark = place_at(pillar, 30.0, 2000.0);
    let keys = |deflection: &str| {
        format!(
            "latitude_deg: 45.0\nlongitude_deg: 10.0\n{deflection}azimuth_mark: {{latitude_deg: {}, longitude_deg: {}, \
             pillar_latitude_deg: 45.0, pillar_longitude_deg: 10.0, position_u_m: 0.02}}",
            mark.latitude_deg, mark.longitude_deg
        )
    };
    // η tan 45° = η: 3.6″ are 0.001°. Across the line of sight 0.02·√2 m at 2 km are 2.917″; with η's 1″: 3.084″.
    let earth = site(&keys("deflection_arcsec: {xi: 0.0, eta: 3.6, u: 1.0}\n")).earth();
    assert!((earth.azimuth_deg.unwrap() - 30.001).abs() < TENTH_OF_ARCSECOND_DEG, "{earth:?}");
    assert!((earth.azimuth_u_arcsec.unwrap() - 3.084).abs() < 1e-3, "{earth:?}");
    // Unknown deflection: η = 0 with u = 10″.
    let earth = site(&keys("")).earth();
    assert!((earth.azimuth_deg.unwrap() - 30.0).abs() < TENTH_OF_ARCSECOND_DEG);
    assert!((earth.azimuth_u_arcsec.unwrap() - (10.0_f64 * 10.0 + 2.917 * 2.917).sqrt()).abs() < 2e-3);
}

/// Issues a passport for `site` and asks about `place`.
fn ask(site: &Site, place: Place) -> Verification {
    let stand = include_bytes!("../passports/SPS-2/0017/stand.yaml");
    let stand = Stand::from_yaml("stand.yaml", stand).unwrap();
    let key = SigningKey::generate().unwrap();
    let order = issue::Issue::first("factory", "2026-11-09T09:00:00Z".parse().unwrap());
    let passport = issue::draft(&stand, site, &order).unwrap().sign(&key).unwrap();
    let line = allowed_signers_line("factory", &key.public_key()).unwrap();
    let trust = Trust::of(AllowedSigners::parse("signers", line.as_bytes()).unwrap());
    let question = Question { place: Some(place), ..Question::at("2026-12-01T00:00:00Z".parse().unwrap()) };
    let answer = verify("passport", passport.as_bytes(), &trust, &question);
    assert_eq!(answer.code(CheckName::Recomputed), Some(Code::Ok), "{:?}", answer.checks());
    answer
}

#[test]
fn the_place_is_checked_by_distance() {
    let here = site("latitude_deg: 55.7658\nlongitude_deg: 37.6856");
    let centre = Place { latitude_deg: 55.7658, longitude_deg: 37.6856 };
    for (azimuth, metres, code) in [(0.0, 512.0, Code::Ok), (90.0, 512.0, Code::Ok), (180.0, 514.0, Code::WrongPlace)] {
        assert_eq!(
            ask(&here, place_at(centre, azimuth, metres)).code(CheckName::Place),
            Some(code),
            "{azimuth} {metres}"
        );
    }
}

#[test]
fn without_longitude_the_latitude_alone_is_checked() {
    let here = site("latitude_deg: 55.7658");
    for (longitude_deg, latitude_deg, code) in
        [(-120.0, 55.7658, Code::Ok), (37.0, 55.7703, Code::Ok), (37.0, 55.7705, Code::WrongPlace)]
    {
        // 513 m are 0.0046° of latitude.
        let answer = ask(&here, Place { latitude_deg, longitude_deg });
        assert_eq!(answer.code(CheckName::Place), Some(code), "{latitude_deg} {longitude_deg}");
        let detail = &answer.checks().last().unwrap().detail;
        assert!(detail.contains("the site's longitude is unknown"), "{detail}");
    }
}

#[test]
fn an_astronomic_latitude_without_deflection_allows_thirty_arcseconds() {
    // 30″ are 927 m: with the 513 m of Moscow 1,440 m.
    let here = site("astronomic_latitude_deg: 55.7658\nlongitude_deg: 37.6856");
    let centre = Place { latitude_deg: 55.7658, longitude_deg: 37.6856 };
    for (metres, code) in [(1430.0, Code::Ok), (1450.0, Code::WrongPlace)] {
        let answer = ask(&here, place_at(centre, 0.0, metres));
        assert_eq!(answer.code(CheckName::Place), Some(code), "{metres}");
        assert!(answer.checks().last().unwrap().detail.contains("30 arcsec"));
    }
}
