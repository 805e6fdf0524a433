//! Differences of two passports, number by number, in units of their standard uncertainties where both state one.

use super::content::Content;
use crate::attitude::ANGLES;
use crate::calibration::inputs::Turn;
use crate::stand::{Certificate, CertifiedPosition, Stand};
use crate::text::{Field, Node};
use crate::units::ARCSECONDS_PER_DEGREE;
use nalgebra::Matrix3;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Number that differs, or that only one of the two passports states.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NumberDifference {
    /// Key of the number, such as `positions[1,2].alpha_arcsec` or `matrices.delta[1,2]` (row and column from 1).
    pub key: String,
    /// Number in the first passport.
    pub a: Option<f64>,
    /// Number in the second passport.
    pub b: Option<f64>,
    /// Standard uncertainty of `b` − `a`; `None` unless both passports state the uncertainty of the number.
    pub standard_uncertainty: Option<f64>,
}

impl NumberDifference {
    /// Returns `b` − `a`, of longitudes and azimuths the shorter way round; `None` if only one of the passports states the
    /// number.
    pub(crate) fn difference(&self) -> Option<f64> {
        let difference = self.b? - self.a?;
        let is_round = ["longitude_deg", "azimuth_deg"].iter().any(|key| self.key.ends_with(key));
        let turn = if is_round && difference.abs() > 180.0 { 360.0_f64.copysign(difference) } else { 0.0 };
        Some(difference - turn)
    }

    /// Returns the difference in units of its standard uncertainty, or `None` without one.
    pub(crate) fn ratio(&self) -> Option<f64> {
        let u = self.standard_uncertainty.filter(|u| *u > 0.0)?;
        Some(self.difference()? / u)
    }
}

/// Text, date, whole number or part that differs, or that only one of the two passports contains.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct OtherDifference {
    /// Key, as in [`NumberDifference::key`].
    pub key: String,
    pub a: Option<Node>,
    pub b: Option<Node>,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Differences {
    /// Number of binary64 numbers that at least one of the passports states.
    pub compared: usize,
    /// Numbers that differ, in the order of the file.
    pub numbers: Vec<NumberDifference>,
    /// Other values that differ, in the order of the file.
    pub others: Vec<OtherDifference>,
}

impl Differences {
    /// Compares the contents of two passports; signatures and comments are not compared.
    ///
    /// The uncertainties of the two passports are taken as independent: a contribution that both certificates share,
    /// such as that of one autocollimator, makes the stated uncertainty of a difference too large, never too small.
    pub(crate) fn of(a: &Content, b: &Content) -> Self {
        let mut found = Self { compared: 0, numbers: Vec::new(), others: Vec::new() };
        found.compare("", a.write().as_ref(), b.write().as_ref());
        let (of_a, of_b) = (uncertainties(a), uncertainties(b));
        for number in &mut found.numbers {
            number.standard_uncertainty =
                of_a.get(&number.key).zip(of_b.get(&number.key)).map(|(a, b)| libm::hypot(*a, *b));
        }
        found
    }

    fn compare(&mut self, key: &str, a: Option<&Node>, b: Option<&Node>) {
        match (a, b) {
            (None, None) => {}
            (Some(Node::Map(_)) | None, Some(Node::Map(_)) | None) => {
                for (name, a, b) in entries(a, b) {
                    let below = if key.is_empty() { name.to_owned() } else { format!("{key}.{name}") };
                    self.compare(&below, a, b);
                }
            }
            (Some(Node::List(_)) | None, Some(Node::List(_)) | None) => {
                let (a, b) = (items(a), items(b));
                for place in a.keys().chain(b.keys()).collect::<BTreeSet<_>>() {
                    self.compare(&format!("{key}[{}]", in_words(place)), a.get(place).copied(), b.get(place).copied());
                }
            }
            (Some(Node::Number(_)) | None, Some(Node::Number(_)) | None) => {
                let number = |node: Option<&Node>| match node {
                    Some(Node::Number(value)) => Some(*value),
                    _ => None,
                };
                let (a, b) = (number(a), number(b));
                self.compared += 1;
                if a != b {
                    self.numbers.push(NumberDifference { key: key.to_owned(), a, b, standard_uncertainty: None });
                }
            }
            (a, b) if a == b => {}
            (a, b) => self.others.push(OtherDifference { key: key.to_owned(), a: a.cloned(), b: b.cloned() }),
        }
    }
}

/// Returns the certified deviations of two certificates of one stand, unchanged ones too: those of the first, then those
/// of positions that only the second has.
pub(crate) fn of_deviations(a: &Stand, b: &Stand) -> Vec<NumberDifference> {
    let mut numbers: Vec<NumberDifference> = Vec::new();
    let only_in_b = b.positions.iter().filter(|at| a.positions.iter().all(|other| other.index() != at.index()));
    for position in a.positions.iter().chain(only_in_b) {
        let of = |stand: &Stand| {
            let at = stand.positions.iter().find(|at| at.index() == position.index())?.clone();
            let u = u_of_deviations_arcsec(&at, &stand.certificate);
            Some((at.angles_arcsec(), u))
        };
        let (old, new) = (of(a), of(b));
        for (angle, name) in ANGLES.into_iter().enumerate() {
            let key = format!("positions[{},{}].{name}_arcsec", position.i, position.j);
            let u = |of: &Option<([f64; 3], [Option<f64>; 3])>| of.as_ref().and_then(|(_, u)| u[angle]);
            numbers.push(NumberDifference {
                key,
                a: old.as_ref().map(|(values, _)| values[angle]),
                b: new.as_ref().map(|(values, _)| values[angle]),
                standard_uncertainty: u(&old).zip(u(&new)).map(|(a, b)| libm::hypot(a, b)),
            });
        }
    }
    numbers
}

/// Key of two mappings, and its value in each.
type EntryOfBoth<'n> = (&'n str, Option<&'n Node>, Option<&'n Node>);

/// Returns the entries of two mappings, those of the first before those that only the second has.
pub(super) fn entries<'n>(a: Option<&'n Node>, b: Option<&'n Node>) -> Vec<EntryOfBoth<'n>> {
    let of = |node: Option<&'n Node>| -> &'n [(String, Node)] {
        match node {
            Some(Node::Map(entries)) => entries,
            _ => &[],
        }
    };
    let get = |node: Option<&'n Node>, name: &str| node.and_then(|node| node.get(name));
    let only_in_b = of(b).iter().filter(|(name, _)| get(a, name).is_none());
    of(a).iter().chain(only_in_b).map(|(name, _)| (name.as_str(), get(a, name), get(b, name))).collect()
}

/// Place of an item in a list: its indices i and j, or its number from 1; for a matrix, row and column.
type Place = Vec<i64>;

fn in_words(place: &Place) -> String {
    place.iter().map(i64::to_string).collect::<Vec<_>>().join(",")
}

/// Returns the items of a list by their places; the rows of a matrix are resolved into its elements.
fn items(list: Option<&Node>) -> BTreeMap<Place, &Node> {
    let Some(Node::List(items)) = list else { return BTreeMap::new() };
    let mut found = BTreeMap::new();
    for (number, item) in (1..).zip(items) {
        match (item, item.get("i"), item.get("j")) {
            (_, Some(Node::Integer(i)), Some(Node::Integer(j))) => {
                found.insert(vec![*i, *j], item);
            }
            (Node::List(row), ..) => {
                found.extend((1..).zip(row).map(|(column, element)| (vec![number, column], element)));
            }
            _ => {
                found.insert(vec![number], item);
            }
        }
    }
    found
}

/// Returns the stated standard uncertainties of the numbers of a passport, by their keys, in the units of the numbers.
fn uncertainties(content: &Content) -> HashMap<String, f64> {
    let mut stated = HashMap::new();
    for position in &content.positions {
        let all = u_of_deviations_arcsec(position, &content.certificate);
        for (angle, u) in ANGLES.into_iter().zip(all) {
            let index = format!("{},{}", position.i, position.j);
            stated.extend(u.map(|u| (format!("positions[{index}].{angle}_arcsec"), u)));
        }
    }
    let site = &content.site;
    let arcsec = |u: f64| u / ARCSECONDS_PER_DEGREE;
    let latitude = site.uncertainty.as_ref().and_then(|base| base.latitude_arcsec).map(arcsec);
    let deflection = site.deflection_arcsec.as_ref().and_then(|deflection| deflection.u);
    let known = |u: f64| Some(u).filter(|u| *u > 0.0);
    let [horizontal, vertical] = content.earth.rate_u_deg_per_h(site).map(known);
    let single = [
        ("site.latitude_deg", latitude),
        ("site.astronomic_latitude_deg", latitude),
        ("site.deflection_arcsec.xi", deflection),
        ("site.deflection_arcsec.eta", deflection),
        ("site.gravity_m_per_s2", site.gravity_u_m_per_s2),
        ("earth.latitude_deg", known(arcsec(site.astronomic_latitude_u_arcsec()))),
        ("earth.horizontal_deg_per_h", horizontal),
        ("earth.vertical_deg_per_h", vertical),
        ("earth.gravity_m_per_s2", site.gravity_u_m_per_s2()),
        ("earth.azimuth_deg", content.earth.azimuth_u_arcsec.map(arcsec)),
    ];
    stated.extend(single.into_iter().filter_map(|(key, u)| Some((key.to_owned(), u?))));
    stated
}

/// Returns the combined standard uncertainties of α, β and γ of a position, arcsec: its own part, and the parts common
/// to all positions, which turn the case by the same amount about every axis. An element is `None` if its own part is
/// not stated; common parts that are not stated are omitted.
pub(crate) fn u_of_deviations_arcsec(position: &CertifiedPosition, certificate: &Certificate) -> [Option<f64>; 3] {
    // The certificate is about the axes of its own laboratory, wherever the base points at a site.
    let turn = Turn::of(&position.to_model(), &Matrix3::identity());
    let to_angles = turn.angles_of_rotation();
    let common = [certificate.common_platform_arcsec, certificate.common_base_arcsec];
    let common = common.into_iter().flatten().map(|u| u * u).sum::<f64>();
    let own = position.u_arcsec();
    [0, 1, 2].map(|angle| {
        let own = own[angle]?;
        Some((own * own + common * to_angles.row(angle).norm_squared()).sqrt())
    })
}

#[cfg(all(test, feature = "factory"))]
mod tests {
    use super::*;

    fn passport(name: &str) -> Content {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("passports").join(name);
        crate::passport::content_from_anyone(name, &std::fs::read(path).unwrap()).unwrap()
    }

    /// Expected: the difference of two directions is at most half a turn.
    #[test]
    fn directions_differ_by_the_shorter_way_round() {
        let difference = |key: &str, a: f64, b: f64| {
            let number = NumberDifference { key: key.to_owned(), a: Some(a), b: Some(b), standard_uncertainty: None };
            number.difference().unwrap()
        };
        assert!((difference("earth.azimuth_deg", 359.75, 0.5) - 0.75).abs() < 1e-12);
        assert!((difference("site.frame_axis_azimuth_deg", 0.0, 359.75) + 0.25).abs() < 1e-12);
        assert!((difference("site.longitude_deg", 179.5, -179.75) - 0.75).abs() < 1e-12);
        assert!((difference("site.longitude_deg", -100.0, 79.0) - 179.0).abs() < 1e-12);
        assert!((difference("site.height_m", 900.0, 100.0) + 800.0).abs() < 1e-12);
    }

    /// Expected: by hand; the deflection of both sites is unknown, so the latitude of each has u = 10″, and the derivative
    /// of Ω cos Φ is −Ω sin Φ.
    #[test]
    fn places_differ_with_the_uncertainty_of_their_latitudes() {
        let found =
            Differences::of(&passport("SPS-2/0017/moscow-bmstu-1.yaml"), &passport("SPS-2/0017/beijing-nim-1.yaml"));
        let u =
            |key: &str| found.numbers.iter().find(|number| number.key == key).unwrap().standard_uncertainty.unwrap();
        let due = [
            ("earth.latitude_deg", std::f64::consts::SQRT_2 * 10.0 / 3600.0),
            ("earth.horizontal_deg_per_h", 4.848_137e-5 * libm::hypot(12.435_125_599_9, 9.717_457_3)),
            ("earth.vertical_deg_per_h", 4.848_137e-5 * libm::hypot(8.461_757_742_8, 11.480_623_5)),
        ];
        for (key, due) in due {
            assert!((u(key) / due - 1.0).abs() < 1e-5, "{key}: {}, {due}", u(key));
        }
    }

    /// Expected: by hand from the changes made; u = √(u_α² + c_p² + c_b²) of either certificate for a small deviation.
    #[test]
    fn every_change_is_found_with_its_uncertainty() {
        let a = passport("SPS-2/0017/moscow-bmstu-1.yaml");
        let mut b = a.clone();
        b.positions[2].beta_arcsec += 2.5;
        b.positions[2].u_beta_arcsec = Some(3.0);
        b.certificate.common_platform_arcsec = Some(4.0);
        b.certificate.common_base_arcsec = None;
        b.certificate.number = "other".to_owned();
        b.matrices.as_mut().unwrap().delta[1][0] += 0.5;
        let found = Differences::of(&a, &b);
        let keys: Vec<&str> = found.numbers.iter().map(|number| number.key.as_str()).collect();
        let index = format!("{},{}", a.positions[2].i, a.positions[2].j);
        let expected = [
            "certificate.common_platform_arcsec",
            "certificate.common_base_arcsec",
            &format!("positions[{index}].beta_arcsec"),
            &format!("positions[{index}].u_beta_arcsec"),
            "matrices.delta[2,1]",
        ];
        assert_eq!(keys, expected);
        let (u, c) = (a.positions[2].u_beta_arcsec.unwrap(), &a.certificate);
        let common = [c.common_platform_arcsec, c.common_base_arcsec].map(|u| u.unwrap().powi(2));
        let due = (u * u + common[0] + common[1] + 9.0 + 16.0).sqrt();
        let beta = &found.numbers[2];
        assert!((beta.standard_uncertainty.unwrap() / due - 1.0).abs() < 1e-6, "{beta:?}, {due}");
        assert!((beta.ratio().unwrap() - 2.5 / due).abs() < 1e-6);
        assert_eq!((found.numbers[1].b, found.numbers[1].difference()), (None, None));
        assert!((found.numbers[4].difference().unwrap() - 0.5).abs() < 1e-12);
        assert_eq!(found.others.len(), 1);
        assert_eq!(found.others[0].key, "certificate.number");
    }
}
