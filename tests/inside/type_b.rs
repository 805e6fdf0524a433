//! Uncertainty of type B in a certificate, and the readings it was made from: read, written, added once, printed.

use crate::inside::{fixtures, written};
use dtg_passport::attitude::{Deviation, deviation};
use dtg_passport::certification::{AngleReadings, Certification, Header, certify};
use dtg_passport::passport::{Content, verify};
use dtg_passport::report::{Language, passport};
use dtg_passport::stand::{ActsOn, Certificate, CertifiedPosition, Stand};
use dtg_passport::trust::SigningKey;
use nalgebra::{Matrix3, Rotation3, Vector3};

const READINGS: &str = include_str!("../../docs/angles.csv");
const HEADER: &str = include_str!("../../docs/header.yaml");
/// 0.3 and 0.4 make 0.5.
const TYPE_B: &str = r#"  type_b:
    - {source: "autocollimator, calibration C-17", acts_on: "position", u_arcsec: 0.3}
    - {source: "mirror flatness", acts_on: "position", u_arcsec: 0.4, degrees_of_freedom: 8.0}
    - {source: "mirror cube", acts_on: "platform", u_arcsec: 0.6}
    - {source: "theodolite", acts_on: "base", u_arcsec: 2.0}
"#;

const REFERENCES: &str = r#"  references: [{number: "A/1", laboratory: "M", issued: "2025-06-30", sha256: "0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a"}]
"#;

fn with_type_b(file: &str) -> String {
    file.replace("datum:", &format!("{TYPE_B}datum:"))
}

fn certified(header: &Header) -> Certification {
    let readings = AngleReadings::from_csv("angles.csv", READINGS.as_bytes(), &header.positions).unwrap();
    certify(header, &readings).unwrap()
}

fn header(text: &str) -> Header {
    Header::from_yaml("header.yaml", text.as_bytes()).unwrap()
}

/// The printed passport of a stand in English.
fn printed(content: &Content) -> String {
    dtg_passport::report::doc::typed(&passport::document(content, None), Language::English)
}

fn refused(text: &str) -> String {
    Stand::from_yaml("stand.yaml", text.as_bytes()).unwrap_err().to_string()
}

/// Squares add; degrees of freedom by Welch and Satterthwaite (GUM, eq. (G.2b)), by hand.
#[test]
fn certify_adds_it_once() {
    let (without, with) = (certified(&header(HEADER)), certified(&header(&with_type_b(HEADER))));
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-3 * expected, "{found}, {expected}");
    for (bare, full) in without.stand.positions.iter().zip(&with.stand.positions) {
        let u = [bare.u_alpha_arcsec, bare.u_beta_arcsec, bare.u_gamma_arcsec].map(Option::unwrap);
        let both = [full.u_alpha_arcsec, full.u_beta_arcsec, full.u_gamma_arcsec].map(Option::unwrap);
        u.iter().zip(both).for_each(|(u, both)| near(both, (u * u + 0.25).sqrt()));
        // Of the axis that has the fewest, which is that of the largest own scatter.
        let own = without.components.own_arcsec2.map(|axis| axis.value / 5.0);
        let freedom = |own: f64| (own + 0.25).powi(2) / (own * own / 24.0 + 0.16_f64.powi(2) / 8.0);
        let fewest = own.map(freedom).into_iter().fold(f64::INFINITY, f64::min);
        let found = full.degrees_of_freedom.unwrap();
        assert!((found / fewest - 1.0).abs() < 0.05, "{found}, {fewest}");
    }
    let of = |found: &Certification| {
        let certificate = &found.stand.certificate;
        [certificate.common_platform_arcsec, certificate.common_base_arcsec].map(Option::unwrap)
    };
    let ([platform, base], [platform_with, base_with]) = (of(&without), of(&with));
    near(platform_with, (platform * platform + 0.36).sqrt());
    near(base_with, (base * base + 4.0).sqrt());
    let repeatability = |found: &Certification| found.stand.certificate.repeatability_arcsec;
    assert_eq!(repeatability(&with), repeatability(&without), "a return at the laboratory is not measured again");
    // The header of the next certificate keeps the list and nothing that contains it.
    let again = certified(&Header::from(&with.stand));
    assert_eq!(again.stand.positions, with.stand.positions);
    assert_eq!(again.stand.certificate.common_base_arcsec, with.stand.certificate.common_base_arcsec);
    let next = Header::from(&with.stand).certificate;
    assert_eq!((next.performed, next.received, next.valid_until, next.temperature_c), (None, None, None, None));
    assert_eq!((next.repeatability_arcsec, next.valid_until_basis, next.evidence), (None, None, None));
}

/// Positions with one θ and φ: no axis of the base can be told from the platform, but its type B is known.
#[test]
fn a_base_that_cannot_be_told_states_its_type_b() {
    let of_one_attitude = |line: &str| {
        let line = line.replace("phi_deg: 90}", "phi_deg: 0}").replace("phi_deg: 180}", "phi_deg: 0}");
        let line = line.replace("phi_deg: 270}", "phi_deg: 0}");
        ["j: 2", "j: 3", "j: 4"].into_iter().fold(line, |line, j| line.replace(j, &format!("j: 1{}", &j[3..]))) + "\n"
    };
    let header = with_type_b(HEADER);
    let header: String = header.lines().filter(|line| !line.contains("i: 2")).map(of_one_attitude).collect();
    let header = self::header(&header);
    let rows = READINGS.lines().filter(|line| line.starts_with(['i', '1'])).map(|line| format!("{line}\n"));
    let renamed = |line: String| match line.strip_prefix("1,1,") {
        Some(_) => line,
        None => line.replacen("1,", "1,1", 1),
    };
    let readings: String = rows.map(renamed).collect();
    let readings = AngleReadings::from_csv("a.csv", readings.as_bytes(), &header.positions).unwrap();
    let found = certify(&header, &readings).unwrap();
    assert_eq!(found.components.base, None);
    assert_eq!(found.stand.certificate.common_base_arcsec, Some(2.0));
}

/// Through the stand file into a signed passport and back; the same text as ever without it.
#[test]
fn it_goes_through_every_document() {
    let found = certified(&header(&with_type_b(HEADER)));
    let text = found.to_yaml("stand.yaml").unwrap();
    let line = r#"    - {source: "mirror flatness", acts_on: "position", u_arcsec: 0.4, degrees_of_freedom: 8.0}"#;
    assert!(text.contains(line) && text.contains("  evidence:\n    readings_sha256: \""), "{text}");
    assert_eq!(Stand::from_yaml("stand.yaml", text.as_bytes()).unwrap(), found.stand);
    let key = SigningKey::generate().unwrap();
    let content = fixtures::content(&found.stand, &fixtures::site(fixtures::SITE));
    let text = written(&content, &key);
    assert!(text.contains(&format!("{line}\n")), "{text}");
    let answer = verify("p.yaml", text.as_bytes(), &fixtures::trust(&key), &fixtures::question());
    let verified = answer.passport().unwrap_or_else(|| panic!("{:?}", answer.checks()));
    let content = verified.content();
    assert_eq!(content.certificate, found.stand.certificate);
    assert_eq!(content.certificate.type_b_on(ActsOn::Platform).count(), 1);
    let shown = printed(content);
    for words in
        ["Type B, common part of the platform", "0.6″: mirror cube", "0.4″, ν = 8: mirror flatness", "5, SHA-256"]
    {
        assert!(shown.contains(words), "no {words:?} in\n{shown}");
    }
}

#[test]
fn what_cannot_be_so_is_refused_with_its_place() {
    let good = certified(&header(&with_type_b(HEADER))).to_yaml("stand.yaml").unwrap();
    let cases = [
        (
            r#"acts_on: "base""#,
            r#"acts_on: "seat""#,
            &["type_b[3].acts_on", "\"seat\"", "\"position\", \"platform\" or \"base\""][..],
        ),
        ("u_arcsec: 0.3}", "u_arcsec: -0.3}", &["type_b[0].u_arcsec", "-0.3"]),
        ("degrees_of_freedom: 8.0}", "degrees_of_freedom: 0}", &["type_b[1].degrees_of_freedom"]),
        ("runs: 5", "runs: 1", &["certificate.evidence.runs", "2 or more"]),
        ("readings_sha256: \"", "readings_sha256: \"g", &["readings_sha256", "64 lower-case hexadecimal digits"]),
        // The root of 0.09 + 0.16 + 1 is 1.118, and u is 0.93 or so.
        ("u_arcsec: 0.3}", "u_arcsec: 1.0}", &["positions[0].u_alpha_arcsec", "at least 1.0770", "type_b"]),
        ("u_arcsec: 2.0}", "u_arcsec: 2.1}", &["certificate.common_base_arcsec", "at least 2.1000"]),
        ("u_arcsec: 0.6}", "u_arcsec: 1.1}", &["certificate.common_platform_arcsec", "at least 1.1000"]),
    ];
    for (from, to, words) in cases {
        assert!(good.contains(from), "{from}");
        let said = refused(&good.replace(from, to));
        words.iter().for_each(|word| assert!(said.contains(word), "{said:?} without {word:?}"));
    }
    let start = good.find("  type_b:").unwrap();
    let end = good.find("  evidence:").unwrap();
    let empty = format!("{}  type_b: []\n{}", &good[..start], &good[end..]);
    assert!(refused(&empty).contains("type_b: found an empty list"), "{}", refused(&empty));
}

/// Expected: ILAC-P14, 5.4. U of two stated digits is by hand from the stand file: 2·√(u² + 0.3² + 0.4²) for u = 1.2 is 2.6.
#[test]
fn an_uncertainty_below_the_capability_is_refused() {
    let text = r#"format: "dtg-stand/1"
stand: {model: "S", serial: "1"}
certificate: {number: "C-1", issued: "2026-11-02", laboratory: "L", references: [{number: "A/1", laboratory: "M", issued: "2025-06-30", sha256: "DIGEST"}], cmc_arcsec: 2.6, common_platform_arcsec: 0.3, common_base_arcsec: 0.4}
positions:
  - {i: 1, j: 1, theta_deg: 0, phi_deg: 0, alpha_arcsec: 12.4, beta_arcsec: -31.0, gamma_arcsec: 7.7, u_alpha_arcsec: 3.0, u_beta_arcsec: 1.2}
"#;
    let text = text.replace("DIGEST", &"0a".repeat(32));
    Stand::from_yaml("s.yaml", text.as_bytes()).unwrap();
    for (from, to, said) in [
        ("cmc_arcsec: 2.6", "cmc_arcsec: 2.61", "certificate.cmc_arcsec: found 2.61, expected at most 2.6000"),
        ("cmc_arcsec: 2.6", "cmc_arcsec: 0.0", "certificate.cmc_arcsec: found 0, expected a positive number"),
        ("0a0a", "0A0A", "certificate.references[0].sha256"),
        ("issued: \"2025-06-30\", ", "", "certificate.references[0].issued: missing"),
    ] {
        assert!(refused(&text.replacen(from, to, 1)).contains(said), "{}", refused(&text.replacen(from, to, 1)));
    }
    // A new certificate: the smallest U of the example is about 2 arcseconds; a header alone states none.
    let header_of = |cmc: &str| header(&HEADER.replace("datum:", &format!("  cmc_arcsec: {cmc}\n{REFERENCES}datum:")));
    let good = certified(&header_of("0.5"));
    assert_eq!(Header::from(&good.stand).certificate.cmc_arcsec, Some(0.5));
    let content = fixtures::content(&good.stand, &fixtures::site(fixtures::SITE));
    let shown = printed(&content);
    for words in ["A/1, M, 2025-06-30, SHA-256", "0.5″"] {
        assert!(shown.contains(words), "no {words:?} in\n{shown}");
    }
    let high = header_of("9.5");
    let readings = AngleReadings::from_csv("angles.csv", READINGS.as_bytes(), &high.positions).unwrap();
    let below = certify(&high, &readings).unwrap_err().to_string();
    assert!(below.contains("below the accredited capability of 9.5 arcsec (cmc_arcsec)"), "{below}");
}

/// Four digits of 0.22360… are 0.2236: rounding alone refuses nothing.
#[test]
fn rounding_is_not_refused() {
    let text = r#"format: "dtg-stand/1"
stand: {model: "S", serial: "1"}
certificate: {number: "C-1", issued: "2026-11-02", laboratory: "L", common_base_arcsec: 0.2236, type_b: [{source: "a", acts_on: "base", u_arcsec: 0.1}, {source: "b", acts_on: "base", u_arcsec: 0.2}]}
positions:
  - {i: 1, j: 1, theta_deg: 0, phi_deg: 0, alpha_arcsec: 12.4, beta_arcsec: -31.0, gamma_arcsec: 7.7}
"#;
    Stand::from_yaml("s.yaml", text.as_bytes()).unwrap();
    assert!(refused(&text.replace("0.2236", "0.2230")).contains("at least 0.2236"));
}

#[test]
fn a_header_has_type_b_and_no_evidence() {
    let evidence = "  evidence: {readings_sha256: \"9c56cc51b374c3ba189210d5b6d4bf57790d351c96c47c02190ecf1e430635ab\", runs: 5}\ndatum:";
    let text = with_type_b(HEADER).replace("datum:", evidence);
    let said = Header::from_yaml("header.yaml", text.as_bytes()).unwrap_err().to_string();
    assert!(said.contains("certificate.evidence") && said.contains("it is computed from the readings"), "{said}");
}

/// α, β, γ of E = Rz(γ)·Ry(β)·Rx(α), eq. (4).
fn angles(e: &Matrix3<f64>) -> [f64; 3] {
    [libm::atan2(-e.m32, e.m33), libm::asin(e.m31), libm::atan2(-e.m21, e.m11)]
}

/// Expected: small rotations about each axis of the platform and of the base, applied to E.
#[test]
fn common_parts_turn_the_angles_of_a_tilted_platform() {
    let arcsec = [72_000.0, 108_000.0, -36_000.0];
    let [alpha_arcsec, beta_arcsec, gamma_arcsec] = arcsec;
    let [alpha, beta, gamma] = arcsec.map(|arcsec| (arcsec / 3600.0_f64).to_radians());
    let e = deviation(&Deviation { alpha_rad: alpha, beta_rad: beta, gamma_rad: gamma });
    assert!(angles(&e).iter().zip([alpha, beta, gamma]).all(|(found, due)| (found - due).abs() < 1e-12));
    let (platform, base, own, turn) = (0.8, 0.3, 1.2, 1e-6);
    let mut squares = [own * own; 3];
    for axis in 0..3 {
        let rotation = Rotation3::new(Vector3::ith(axis, turn)).into_inner();
        for (turned, u) in [(rotation * e, platform), (e * rotation, base)] {
            let [a, b, c] = angles(&turned);
            for (square, change) in squares.iter_mut().zip([a - alpha, b - beta, c - gamma]) {
                *square += (change / turn * u) * (change / turn * u);
            }
        }
    }
    let stand = fixtures::stand(fixtures::ARC_MINUTES);
    let certificate = Certificate {
        common_platform_arcsec: Some(platform),
        common_base_arcsec: Some(base),
        ..stand.certificate.clone()
    };
    let u = Some(own);
    let [u_alpha_arcsec, u_beta_arcsec, u_gamma_arcsec] = [u; 3];
    let at = CertifiedPosition {
        alpha_arcsec,
        beta_arcsec,
        gamma_arcsec,
        u_alpha_arcsec,
        u_beta_arcsec,
        u_gamma_arcsec,
        ..stand.positions[0].clone()
    };
    for (found, due) in certificate.combined(&at).u_arcsec().into_iter().zip(squares) {
        assert!((found.unwrap() - due.sqrt()).abs() < 1e-5, "{found:?} {}", due.sqrt());
    }
    let without = Certificate { common_base_arcsec: None, ..certificate };
    assert_eq!(without.combined(&at).u_arcsec(), [None; 3]);
}

/// `sha256sum docs/angles.csv`, and its five runs.
#[test]
fn the_evidence_is_the_readings() {
    let evidence = certified(&header(HEADER)).stand.certificate.evidence.unwrap();
    let sum = std::process::Command::new("sha256sum").arg("docs/angles.csv").output().unwrap();
    assert!(String::from_utf8(sum.stdout).unwrap().starts_with(&evidence.readings_sha256));
    assert_eq!(evidence.runs, 5);
}
