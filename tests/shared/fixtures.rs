//! Passports for tests, with the stands, sites, keys and times that an attacker would vary.

// Every test crate uses its own part.
#![allow(dead_code)]

use dtg_passport::passport::issue::{Draft, Issue, draft};
use dtg_passport::passport::{Content, NAMESPACE, Question, Trust};
use dtg_passport::site::Site;
use dtg_passport::stand::Stand;
use dtg_passport::trust::{AllowedSigners, RevokedKeys, SigningKey};
use jiff::Timestamp;

pub const ISSUER: &str = "factory@example.org";
pub const ISSUED_AT: &str = "2026-11-09T08:00:00Z";

/// Stand file with deviations of arcminutes, everything certified.
pub const ARC_MINUTES: &str = include_str!("../../passports/SPS-2/0017/stand.yaml");
/// Stand file with deviations of degrees.
pub const DEGREES: &str = include_str!("../../passports/SPS-1/0203/stand.yaml");
/// Site file with a measured deflection, an azimuth mark and stated uncertainties.
pub const SITE: &str = r#"format: "dtg-site/1"
id: "bench"
name: "A bench with a mark"
latitude_deg: 55.7658
longitude_deg: 37.6856
height_m: 150.5
deflection_arcsec: {xi: -3.2, eta: 4.1, u: 1.5}
azimuth_mark: {name: "mark", latitude_deg: 55.7772, longitude_deg: 37.6924, pillar_latitude_deg: 55.7658, pillar_longitude_deg: 37.6856, position_u_m: 0.02}
valid_within_deg_per_h: 0.001
uncertainty: {latitude_arcsec: 1.5, azimuth_arcsec: 30.5, level_arcsec: 5.5}
source: "made up for this test"
"#;

/// Parses a time in RFC 3339.
pub fn at(text: &str) -> Timestamp {
    text.parse().unwrap()
}

/// Returns the time `seconds` after `ISSUED_AT`.
pub fn issued_plus(seconds: i64) -> Timestamp {
    Timestamp::from_second(at(ISSUED_AT).as_second() + seconds).unwrap()
}

pub fn stand(text: &str) -> Stand {
    Stand::from_yaml("stand", text.as_bytes()).unwrap()
}

pub fn site(text: &str) -> Site {
    Site::from_yaml("site", text.as_bytes()).unwrap()
}

/// Creates a correct passport of `stand` at `site`, not yet signed.
pub fn drafted(stand: &Stand, site: &Site, revision: u32) -> Draft {
    let mut order = Issue::first(ISSUER, at(ISSUED_AT));
    order.revision = revision;
    draft(stand, site, &order).unwrap()
}

/// Returns the content of a correct passport of `stand` at `site`.
pub fn content(stand: &Stand, site: &Site) -> Content {
    drafted(stand, site, 1).content().clone()
}

/// Returns any payload with a correct signature, assembled by hand as docs/formats.md describes.
pub fn signed(payload: &str, key: &SigningKey) -> String {
    signed_as(NAMESPACE, payload, key)
}

/// Returns any payload with a correct signature for this purpose.
pub fn signed_as(namespace: &str, payload: &str, key: &SigningKey) -> String {
    let armor = key.sign(namespace, payload.as_bytes()).unwrap().to_armor();
    let indented: String = armor.lines().map(|line| format!("  {line}\n")).collect();
    format!("{payload}signature: |\n{indented}")
}

/// Creates a trust in `key`, from a line of allowed signers with these principals and options.
pub fn trust_as(principals_and_options: &str, key: &SigningKey) -> Trust {
    let line = format!("{principals_and_options} {}\n", key.public_key().to_openssh());
    Trust::of(AllowedSigners::parse("allowed_signers", line.as_bytes()).unwrap())
}

/// Creates a trust in `key` as the issuer of passports and for nothing else.
pub fn trust(key: &SigningKey) -> Trust {
    trust_as(&format!("{ISSUER} namespaces=\"{NAMESPACE}\""), key)
}

/// Creates the trust of `trust` with the revocation list `revoked`.
pub fn trust_without(key: &SigningKey, revoked: &[u8]) -> Trust {
    let mut trust = trust(key);
    trust.revoked.push(RevokedKeys::parse("revoked", revoked).unwrap());
    trust
}

/// Returns the question for one hour after the issue.
pub fn question() -> Question {
    Question::at(issued_plus(3600))
}
