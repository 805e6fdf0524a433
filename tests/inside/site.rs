//! A site: latitude, rates, gravity, radius, mark, and the check of place. Expected values by hand or from the sources named.

use crate::inside::fixtures;
use dtg_passport::earth::{Place, place_at};
use dtg_passport::passport::checks::{CheckName, Code};
use dtg_passport::passport::issue::{Issue, draft};
use dtg_passport::passport::{Question, verify};
use dtg_passport::site::Site;
use dtg_passport::trust::SigningKey;

/// 0.1″ in degrees.
const TENTH_OF_ARCSECOND_DEG: f64 = 0.1 / 3600.0;

fn site(keys: &str) -> Site {
    read(keys).unwrap_or_else(|error| panic!("{error}"))
}

fn read(keys: &str) -> Result<Site, String> {
    let text = format!("format: \"dtg-site/1\"\nid: \"here\"\n{keys}");
    Site::from_yaml("here.yaml", text.as_bytes()).map_err(|error| error.to_string())
}

/// Requires that a site file is refused in one line that contains every one of `words`.
fn refused(keys: &str, words: &[&str]) {
    let message = read(keys).expect_err(keys);
    assert_eq!(message.lines().count(), 1, "{message}");
    assert!(words.iter().all(|word| message.contains(word)), "{words:?}\n{message}");
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

/// Expected: what counts as exact without a stated uncertainty is named. Normal gravity at sea level in Moscow, to four
/// decimals by Somigliana's formula: 9.8157 m/s².
#[test]
fn values_without_an_uncertainty_are_named() {
    let odd = |keys: &str| site(&format!("latitude_deg: 55.7658\n{keys}")).odd();
    let standard = odd("gravity_m_per_s2: 9.80665");
    assert!(
        standard[0].contains("standard acceleration") && standard[0].contains("9.8157 with u = 0.0071"),
        "{standard:?}"
    );
    assert!(odd("gravity_m_per_s2: 9.81")[0].contains("state gravity_u_m_per_s2"));
    assert!(odd("deflection_arcsec: {xi: 0.0, eta: 0.0}")[0].contains("state its u"));
    for stated in
        ["", "gravity_m_per_s2: 9.80665\ngravity_u_m_per_s2: 0.003", "deflection_arcsec: {xi: 1.0, eta: 2.0, u: 1.0}"]
    {
        assert!(odd(stated).is_empty(), "{stated}");
    }
}

/// Expected by hand: 1e-5 degrees are 1.11 m on the ground, u = 1.11/√12 = 0.32 m.
#[test]
fn a_mark_with_too_few_digits_is_named() {
    let mark = |u: &str| {
        let keys = "latitude_deg: 55.76582\nazimuth_mark: {latitude_deg: 55.77602, longitude_deg: 37.6857, \
                    pillar_latitude_deg: 55.7658, pillar_longitude_deg: 37.68563, position_u_m: ";
        site(&format!("{keys}{u}}}\n")).odd()
    };
    let [words] = &mark("0.02")[..] else { panic!("one sentence") };
    let due = "rounded to 0.00001 degrees, which alone gives u = 0.32 m, but position_u_m is 0.02;";
    assert!(words.contains(due), "{words}");
    assert!(mark("0.4").is_empty());
}

#[test]
fn the_azimuth_of_the_frames_axis_is_a_full_circle() {
    let with = |azimuth: &str| format!("latitude_deg: 45.0\nframe_axis_azimuth_deg: {azimuth}");
    for (azimuth, found) in [("0", 0.0), ("90.0", 90.0), ("359.999", 359.999)] {
        assert_eq!(site(&with(azimuth)).frame_axis_azimuth_deg(), found);
    }
    assert_eq!(site("latitude_deg: 45.0").frame_axis_azimuth_deg(), 90.0);
    for azimuth in ["360", "-0.001", "-90", "1e300"] {
        refused(&with(azimuth), &["here.yaml:4:", "frame_axis_azimuth_deg", "from 0 to less than 360", "clockwise"]);
    }
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

/// Expected: 0.001 °/h are 513 m or 0.0046° of latitude; the 30″ of an unknown deflection are 927 m more.
#[test]
fn the_place_is_checked_by_distance() {
    let centre = Place { latitude_deg: 55.7658, longitude_deg: 37.6856 };
    let at = |latitude_deg, longitude_deg| Place { latitude_deg, longitude_deg };
    let whole = "latitude_deg: 55.7658\nlongitude_deg: 37.6856";
    let (latitude, unknown) = ("latitude_deg: 55.7658", "the longitude of the site is unknown");
    let astronomic = "astronomic_latitude_deg: 55.7658\nlongitude_deg: 37.6856";
    for (keys, place, code, said) in [
        (whole, place_at(centre, 0.0, 512.0), Code::Ok, ""),
        (whole, place_at(centre, 90.0, 512.0), Code::Ok, ""),
        (whole, place_at(centre, 180.0, 514.0), Code::WrongPlace, ""),
        (latitude, at(55.7658, -120.0), Code::Ok, unknown),
        (latitude, at(55.7703, 37.0), Code::Ok, unknown),
        (latitude, at(55.7705, 37.0), Code::WrongPlace, unknown),
        (astronomic, place_at(centre, 0.0, 1430.0), Code::Ok, "30″"),
        (astronomic, place_at(centre, 0.0, 1450.0), Code::WrongPlace, "30″"),
    ] {
        let key = SigningKey::generate().unwrap();
        let passport = fixtures::drafted(&fixtures::stand(fixtures::ARC_MINUTES), &site(keys), 1).sign(&key).unwrap();
        let question = Question { place: Some(place), ..fixtures::question() };
        let answer = verify("passport", passport.as_bytes(), &fixtures::trust(&key), &question);
        assert_eq!(answer.code(CheckName::Recomputed), Some(Code::Ok), "{:?}", answer.checks());
        let found = answer.checks().iter().find(|check| check.name == CheckName::Place).unwrap();
        assert!(found.code == code && found.detail.contains(said), "{keys}, {place:?}: {found:?}");
    }
}

/// A site of latitude and longitude with a pillar and, due north of it, a mark.
fn with_pillar(site: [f64; 2], pillar: [f64; 2], mark_m: f64) -> String {
    let mark = place_at(Place { latitude_deg: pillar[0], longitude_deg: pillar[1] }, 0.0, mark_m);
    format!(
        "latitude_deg: {}\nlongitude_deg: {}\nazimuth_mark: {{latitude_deg: {}, longitude_deg: {}, \
         pillar_latitude_deg: {}, pillar_longitude_deg: {}}}",
        site[0], site[1], mark.latitude_deg, mark.longitude_deg, pillar[0], pillar[1]
    )
}

/// Expected: a second of latitude at 55.8° is 30.927 m (meridian radius 6,379,200 m there), so 0.044° are 4,899 m and
/// 0.046° are 5,122 m; the mark's distance is what it was placed at.
#[test]
fn the_pillar_is_near_the_site_and_the_mark_within_sight() {
    let moscow = [55.7658, 37.6856];
    site(&with_pillar(moscow, [55.7658 + 0.044, 37.6856], 2000.0));
    refused(&with_pillar(moscow, [55.7658 + 0.046, 37.6856], 2000.0), &["here.yaml:5:", "5122 m", "5000 m", "37.6856"]);
    site(&with_pillar(moscow, moscow, 49_999.0));
    refused(&with_pillar(moscow, moscow, 50_001.0), &["here.yaml:5:", "50001 m", "50000 m"]);
    // Without the site's longitude its latitude alone is compared.
    let without = |latitude| with_pillar(moscow, [latitude, 37.6856], 2000.0).replace("longitude_deg: 37.6856\na", "a");
    site(&without(55.7658 + 0.044));
    refused(&without(55.7658 + 0.046), &["5122 m in latitude", "5000 m"]);
}

#[test]
fn exchanged_coordinates_and_wrong_signs_are_named() {
    let (moscow, rio) = ([55.7658, 37.6856], [-22.8953, -43.2246]);
    for (given, pillar, words) in [
        ([37.6856, 55.7658], moscow, "latitude and longitude exchanged"),
        ([-55.7658, 37.6856], moscow, "the sign of the latitude reversed"),
        ([-22.8953, 43.2246], rio, "the sign of the longitude reversed"),
        ([22.8953, 43.2246], rio, "the signs of both reversed"),
        ([43.2246, 22.8953], rio, "latitude and longitude exchanged and the signs of both reversed"),
        ([56.7658, 37.6856], moscow, "check both"),
    ] {
        refused(&with_pillar(given, pillar, 2000.0), &["azimuth_mark.pillar_latitude_deg: ", words]);
    }
    // The mark's own coordinates exchanged, beside a good pillar.
    let keys = with_pillar(moscow, moscow, 2000.0);
    let mark = place_at(Place { latitude_deg: 55.7658, longitude_deg: 37.6856 }, 0.0, 2000.0).latitude_deg;
    let exchanged = keys.replace(
        &format!("{{latitude_deg: {mark}, longitude_deg: 37.6856"),
        &format!("{{latitude_deg: 37.6856, longitude_deg: {mark}"),
    );
    refused(&exchanged, &["azimuth_mark.latitude_deg: ", "latitude and longitude exchanged"]);
    // Mark and pillar exchanged, 2 km apart: the site is at the mark.
    let far = place_at(Place { latitude_deg: moscow[0], longitude_deg: moscow[1] }, 180.0, 2000.0);
    let words = ["azimuth_mark.pillar_latitude_deg: ", "2000 m from the site", "whether pillar and mark are exchanged"];
    refused(&with_pillar(moscow, [far.latitude_deg, far.longitude_deg], 2000.0), &words);
    // Latitudes that are none, next to longitudes that could be latitudes: Beijing.
    refused("latitude_deg: 116.3856\nlongitude_deg: 39.9658", &["here.yaml:3:15: latitude_deg: ", "exchanged"]);
    refused("astronomic_latitude_deg: 116.3856\nlongitude_deg: 39.9658", &["here.yaml:3:", "exchanged"]);
    let message = read("latitude_deg: 91.5\nlongitude_deg: 139.9").unwrap_err();
    assert!(!message.contains("exchanged"), "{message}");
}

/// Expected: normal gravity on the ellipsoid at 45° is 9.8061977694 m/s² (WGS 84), 3.0847e-3 less at 1000 m.
#[test]
fn gravity_is_near_normal_gravity() {
    let at = |height: &str, gravity: f64| format!("latitude_deg: 45.0\n{height}gravity_m_per_s2: {gravity}");
    for (height, normal, low, high) in [
        ("height_m: 0.0\n", 9.806_197_8, 5e-3, 5e-3),
        ("height_m: 1000.0\n", 9.803_113_0, 5e-3, 5e-3),
        ("", 9.806_197_8, 1.8e-2, 5e-3),
    ] {
        site(&at(height, normal - low + 1e-6));
        site(&at(height, normal + high - 1e-6));
        for gravity in [normal - low - 1e-6, normal + high + 1e-6] {
            let (found, normal) = (format!("found {gravity}, "), format!("{normal:.5}"));
            refused(&at(height, gravity), &["gravity_m_per_s2: ", &found, &normal]);
        }
    }
    // The equator's gravity at 55°: of the longitude as a latitude, too, when that is 10°.
    refused("latitude_deg: 55.0\ngravity_m_per_s2: 9.7803", &["9.7803", "9.81507"]);
    refused("latitude_deg: 55.0\nlongitude_deg: 10.0\ngravity_m_per_s2: 9.7819", &["latitude and longitude exchanged"]);
}

/// A passport that was signed before states such a site: it stays as valid as it was, and no successor is made of it.
#[test]
fn no_passport_is_issued_for_a_site_that_contradicts_itself() {
    let implausible = Site { gravity_m_per_s2: Some(9.7803), ..site("latitude_deg: 55.0") };
    let order = Issue::first(fixtures::ISSUER, fixtures::issued_plus(0));
    let refused = draft(&fixtures::stand(fixtures::ARC_MINUTES), &implausible, &order).unwrap_err().to_string();
    assert!(refused.contains("site.gravity_m_per_s2: found 9.7803"), "{refused}");
}
