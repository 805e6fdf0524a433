//! Passports of every kind that a page must stand: the usual one, all that a file can state, hardly anything, hostile words.

use crate::fixtures;
use dtg_passport::earth::Place;
use dtg_passport::gyro::GyroType;
use dtg_passport::laboratory::Laboratory;
use dtg_passport::passport::Predecessor;
use dtg_passport::passport::Stated;
use dtg_passport::passport::issue::{Issue, Reissued, draft};
use dtg_passport::passport::{Question, Trust};
use dtg_passport::report::Language::{English, Russian};
use dtg_passport::report::{Language, Languages, PassportPage};
use dtg_passport::trust::{AllowedSigners, SigningKey};

/// One page: a passport, whom to trust, what is asked, in which languages.
pub struct Case {
    pub name: &'static str,
    pub passport: String,
    pub trust: Trust,
    pub question: Question,
    pub languages: Languages,
    /// With the annex and the forms in print.
    pub in_full: bool,
}

impl Case {
    /// The page, or the test's failure with what verification said.
    pub fn html(&self) -> String {
        let page = PassportPage::verified(self.name, self.passport.as_bytes(), &self.trust, &self.question);
        let mut page = page.unwrap_or_else(|refused| panic!("{}: {:?}", self.name, refused.checks()));
        (page.prints_annex, page.prints_forms) = (self.in_full, self.in_full);
        page.html(&self.languages)
    }

    fn asking(self, question: Question) -> Self {
        Self { question, ..self }
    }
}

/// Every case.
pub fn all() -> Vec<Case> {
    let elsewhere = Place { latitude_deg: 40.2455, longitude_deg: 116.2240 };
    let here = Place { latitude_deg: 55.7658, longitude_deg: 37.6856 };
    let about = |serial: &str, place, issuer: Option<&str>| {
        let mut question = fixtures::question();
        (question.serial, question.place) = (Some(serial.to_owned()), Some(place));
        question.issuer = issuer.map(str::to_owned);
        question
    };
    let (wrong, right) = (about("0203", elsewhere, None), about("0017", here, Some(fixtures::ISSUER)));
    vec![
        usual("usual-en", &[English]),
        usual("usual-ru", &[Russian]),
        usual("usual-both", &[English, Russian]),
        Case { in_full: true, ..usual("in-full-en", &[English]) },
        Case { in_full: true, ..full("in-full-both", &[English, Russian]) },
        full("full-en", &[English]).asking(right.clone()),
        full("full-ru", &[Russian]).asking(right),
        case("hostile-both", &hostile(fixtures::ARC_MINUTES), fixtures::SITE, &[Russian, English]),
        case("hostile-en", &hostile(fixtures::DEGREES), BARE_SITE, &[English]),
        many("many-en", &[English]),
        many("many-ru", &[Russian]),
        case("four-ru", &four_positions(), BARE_SITE, &[Russian]),
        case("north-both", fixtures::DEGREES, &pointing(0.0), &[Russian, English]),
        case("many-north-west-en", &many_positions(), &pointing(321.5), &[English]),
        bare("bare-en", &[English]),
        bare("bare-ru", &[Russian]),
        full("elsewhere-en", &[English]).asking(wrong.clone()),
        full("elsewhere-both", &[Russian, English]).asking(wrong),
        usual("expired-ru", &[Russian]).asking(Question::at(fixtures::at("2028-11-02T00:00:00Z"))),
    ]
}

/// The project's own example.
pub fn usual(name: &'static str, languages: &[Language]) -> Case {
    let passport = include_str!("../../passports/SPS-2/0017/moscow-bmstu-1.yaml").to_owned();
    let signers = include_bytes!("../../docs/allowed_signers");
    let trust = Trust::of(AllowedSigners::parse("allowed_signers", signers).unwrap());
    let question = Question::at(fixtures::at("2026-11-20T12:00:00Z"));
    Case { name, passport, trust, question, languages: of(languages), in_full: false }
}

/// Hardly anything stated, and no expiry date.
pub fn bare(name: &'static str, languages: &[Language]) -> Case {
    case(name, BARE_STAND, BARE_SITE, languages)
}

fn of(languages: &[Language]) -> Languages {
    Languages::new(languages[0], languages[1..].iter().copied())
}

fn first() -> Issue {
    Issue::first(fixtures::ISSUER, fixtures::at(fixtures::ISSUED_AT))
}

fn case(name: &'static str, stand: &str, site: &str, languages: &[Language]) -> Case {
    let mut order = first();
    order.allow_uncalibratable = true;
    issued(name, stand, site, &order, languages)
}

fn issued(name: &'static str, stand: &str, site: &str, order: &Issue, languages: &[Language]) -> Case {
    let key = SigningKey::generate().unwrap();
    let passport = draft(&fixtures::stand(stand), &fixtures::site(site), order).unwrap().sign(&key).unwrap();
    let (trust, question, languages) = (fixtures::trust(&key), fixtures::question(), of(languages));
    Case { name, passport, trust, question, languages, in_full: false }
}

/// Twenty-four positions at a surveyed site, with the expected uncertainty.
fn many(name: &'static str, languages: &[Language]) -> Case {
    let mut order = first();
    order.accuracy = Some(stated());
    issued(name, &many_positions(), fixtures::SITE, &order, languages)
}

/// All that a file can state, after a re-issue for a reason that took a page to tell.
fn full(name: &'static str, languages: &[Language]) -> Case {
    let reason = "the building was renovated, and the pillar was set up anew on a foundation of its own; ".repeat(8);
    let predecessor = Predecessor {
        id: "SPS-2/0017/bench/1".to_owned(),
        sha256: "64a869ad7cf4e10a8ce5ee8aae48f3ce96b9b3ee146ea8acb68d4b9c878881de".to_owned(),
        reason,
        changed: "site: deflection_arcsec, azimuth_mark".to_owned(),
    };
    let mut order = first();
    (order.accuracy, order.revision) = (Some(stated()), 2);
    order.reissued = Some(Reissued { from: predecessor, supersedes: true });
    let stand = fixtures::ARC_MINUTES
        .replace("name: \"Two-axis", "customer: \"Gyro laboratory, Moscow\", name: \"Two-axis")
        .replace("  number:", "  received: \"2026-10-20\"\n  address: \"1, Example Street, Exampleton\"\n  authorized_by: \"A. N. Other, head of laboratory\"\n  accreditation: \"example accreditation 000\"\n  number:")
        .replace("datum:", TYPE_B);
    let site = fixtures::SITE.replace("height_m", "gravity_m_per_s2: 9.81563\ngravity_u_m_per_s2: 2.5e-05\nheight_m");
    issued(name, &stand, &site, &order, languages)
}

fn stated() -> Stated {
    Stated {
        gyro: GyroType::from_yaml("gyro", FULL_GYRO.as_bytes()).unwrap(),
        laboratory: Laboratory::from_yaml("laboratory", FULL_LABORATORY.as_bytes()).unwrap(),
    }
}

const TYPE_B: &str = r#"  type_b:
    - {source: "autocollimator, calibration C-17", acts_on: "position", u_arcsec: 0.31}
    - {source: "mirror cube, calibration C-18", acts_on: "platform", u_arcsec: 0.25, degrees_of_freedom: 12.5}
    - {source: "theodolite <T2>, calibration C-19", acts_on: "base", u_arcsec: 0.42}
  evidence: {readings_sha256: "9c56cc51b374c3ba189210d5b6d4bf57790d351c96c47c02190ecf1e430635ab", runs: 5}
datum:"#;

/// Words that would be markup, styles or scripts anywhere else, words without a blank, words in other scripts.
fn hostile(stand: &str) -> String {
    let manufacturer = "</style></title><script>alert('x')</script><img src=https://example.org/x onerror=alert(1)> & \
                        'single' \\\"double\\\" &amp; {serial} \\\\";
    let unbroken = "ManufacturerWithoutABlank".repeat(20);
    let names = format!(
        "stand: {{manufacturer: \"{manufacturer}\", customer: \"{unbroken}\", name: \"陀螺测试台 ジャイロ試験台 «стенд»\", model"
    );
    let method = "method: \"<b>bold</b> -- @import url(https://example.org/x.css);\"\n  traceability: \"国家角度基准\"";
    // The example's own words give way; what it has not gets these.
    let kept: Vec<String> = stand
        .lines()
        .filter(|line| !line.trim_start().starts_with("method:") && !line.trim_start().starts_with("traceability:"))
        .map(|line| match line.strip_prefix("stand: {") {
            Some(rest) => {
                let model = rest.find("model").expect("a model");
                let serial_end = rest.find(", configuration").or_else(|| rest.find(", name")).unwrap_or(rest.len() - 1);
                format!("{names}{}}}", &rest[model + "model".len()..serial_end])
            }
            None => line.to_owned(),
        })
        .collect();
    kept.join("\n").replace("  number:", &format!("  {method}\n  number:")) + "\n"
}

/// The example's eight positions and sixteen more, every 45 degrees.
fn many_positions() -> String {
    let mut stand = fixtures::ARC_MINUTES.to_owned();
    for i in 3..=4 {
        for j in 1..=8 {
            let (theta, phi) = (45 * (i - 2), 45 * (j - 1));
            stand += &format!(
                "  - {{i: {i}, j: {j}, theta_deg: {theta}, phi_deg: {phi}, alpha_arcsec: {}.25, beta_arcsec: -{}.5, \
                 gamma_arcsec: 1{j}0, u_alpha_arcsec: 1.2, u_beta_arcsec: 0.85, u_gamma_arcsec: 12.0}}\n",
                10 * i + j,
                j * j
            );
        }
    }
    stand
}

/// The first four of the example's eight.
fn four_positions() -> String {
    let lines: Vec<&str> = fixtures::ARC_MINUTES.lines().filter(|line| !line.contains("{i: 2")).collect();
    lines.join("\n") + "\n"
}

const BARE_STAND: &str = r#"format: "dtg-stand/1"
stand: {model: "SPS-2", serial: "0017"}
certificate: {number: "C-1", issued: "2026-11-02", laboratory: "L"}
positions:
  - {i: 1, j: 1, theta_deg: 0, phi_deg: 0, alpha_arcsec: 12.4, beta_arcsec: -31.0, gamma_arcsec: 7.7}
  - {i: 1, j: 2, theta_deg: 0, phi_deg: 90, alpha_arcsec: -48.9, beta_arcsec: 15, gamma_arcsec: -62.125}
  - {i: 1, j: 3, theta_deg: 0, phi_deg: 180, alpha_arcsec: 77.2, beta_arcsec: 40.6, gamma_arcsec: 21.5}
  - {i: 1, j: 4, theta_deg: 0, phi_deg: 270, alpha_arcsec: -5.8, beta_arcsec: -90.4, gamma_arcsec: 33.0}
  - {i: 2, j: 1, theta_deg: 90, phi_deg: 0, alpha_arcsec: 64.3, beta_arcsec: 8.1, gamma_arcsec: -17.6}
  - {i: 2, j: 2, theta_deg: 90, phi_deg: 90, alpha_arcsec: -22.7, beta_arcsec: 55.9, gamma_arcsec: 44.2}
  - {i: 2, j: 3, theta_deg: 90, phi_deg: 180, alpha_arcsec: 18.0, beta_arcsec: -73.5, gamma_arcsec: -9.3}
  - {i: 2, j: 4, theta_deg: 90, phi_deg: 270, alpha_arcsec: 39.6, beta_arcsec: 26.8, gamma_arcsec: -81.4}
"#;

/// The usual site with the frame's axis at an azimuth.
fn pointing(azimuth_deg: f64) -> String {
    format!("{}frame_axis_azimuth_deg: {azimuth_deg:?}\n", fixtures::SITE)
}

const BARE_SITE: &str = r#"format: "dtg-site/1"
id: "somewhere"
astronomic_latitude_deg: -35.25
"#;

const FULL_GYRO: &str = r#"format: "dtg-gyro/1"
type: "GVK-6"
nominal: {k_deg_per_h_per_ma: [[95, 9.5], [9.5, 95]], omega0_deg_per_h: [20, 20], omega_g_deg_per_h_per_g: 10, omega_k_deg_per_h_per_g: 10}
tolerance: {k_main_percent: 0.05, k_cross_percent: 0.5, omega0_deg_per_h: 0.01, omega_g_deg_per_h_per_g: 0.01, omega_k_deg_per_h_per_g: 0.01}
gravity_m_per_s2: 9.80665
"#;

const FULL_LABORATORY: &str = r#"format: "dtg-laboratory/1"
name: "Gyro laboratory"
meter: {range_ma: 1.0, reading_percent: 0.0087, gain_percent: 0.001, offset_ma: 2.0e-06, floor_ma: 1.0e-06}
seating_arcsec: {about_x: 5.0, about_y: 5.0, about_z: 10.0}
base: {azimuth_arcsec: 10.0, level_arcsec: 3.0}
temperature_c: 21.0
"#;
