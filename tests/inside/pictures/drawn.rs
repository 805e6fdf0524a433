//! What is drawn of a passport, read off by the marks of its axes, against the signed file.

use super::passport::passport;
use crate::inside::fixtures;
use crate::inside::picture::{Axis, end, english, number, of_class, reach, svgs, whole, words};
use dtg_passport::passport::content::Content;
use dtg_passport::passport::content_from_anyone;
use dtg_passport::report::page::Language;
use dtg_passport::report::picture::positions;
use dtg_passport::report::picture::strips::{Accuracies, Deviations};
use roxmltree::Document;

/// Passports with deviations of minutes and of degrees, and the project's own.
fn passports() -> Vec<Content> {
    let own = include_bytes!("../../../passports/SPS-2/0017/moscow-bmstu-1.yaml");
    let minutes = passport(fixtures::ARC_MINUTES, fixtures::SITE).0;
    let degrees = passport(fixtures::DEGREES, fixtures::SITE).0;
    vec![minutes, degrees, content_from_anyone("own", own).unwrap()]
}

#[test]
fn deviations_are_where_their_axes_say() {
    for content in passports() {
        let bars = Deviations::of(&content.positions);
        let axis = Axis::drawn_along_x(bars.axis().drawn(Language::English));
        let unit_arcsec = if bars.unit().en == "°" { 3600.0 } else { 1.0 };
        let says = |place: f64, arcsec: f64| axis.says(place, arcsec / unit_arcsec);
        let deviations = content.positions.iter().flat_map(|at| at.angles_arcsec().into_iter().zip(at.u_arcsec()));
        for (value, u) in deviations {
            let text = whole(&[bars.bar((value, u))]);
            let page = Document::parse(&text).unwrap();
            says(number(of_class(page.root(), "zero")[0], "x1"), 0.0);
            says(end(of_class(page.root(), "bar")[0], value), value);
            if let Some(u) = u {
                let [from, to] = reach(of_class(page.root(), "whisker")[0]);
                says(from, value - 2.0 * u);
                says(to, value + 2.0 * u);
            }
        }
    }
}

/// Index and nominal angles of each position.
#[test]
fn positions_are_named_as_in_the_file() {
    for content in passports() {
        let text = whole(&[positions::positions(&english(), &content.positions, 90.0)]);
        let page = Document::parse(&text).unwrap();
        for (at, panel) in content.positions.iter().zip(svgs(&page)) {
            let said: Vec<String> = panel.descendants().filter(|node| node.has_tag_name("text")).map(words).collect();
            let (i, j, theta, phi) = (at.i, at.j, at.theta_deg, at.phi_deg);
            assert_eq!(said, [&format!("({i}, {j})\u{2002}θ {theta}°\u{2002}φ {phi}°"), "x", "y", "z"]);
        }
    }
}

/// By hand: a tolerance of K_x is 0.05 % of 95, of K_xy 0.5 % of 9.5, of a drift 0.01, per the type's g for the last two.
#[test]
fn accuracy_is_where_its_axis_says() {
    let (content, _) = passport(fixtures::ARC_MINUTES, fixtures::SITE);
    let (stated, gravity) = (content.accuracy.as_ref().unwrap(), content.earth.gravity_m_per_s2);
    let shares = Accuracies::of(stated, gravity);
    let axis = Axis::drawn_along_x(shares.axis().drawn(Language::English));
    let u = &stated.standard_uncertainty;
    let [[kx, kxy], [kyx, ky]] = u.k_deg_per_h_per_ma;
    let [x, y] = u.omega0_deg_per_h;
    let [g, k] = [u.omega_g_deg_per_h_per_g, u.omega_k_deg_per_h_per_g].map(|u| u * 9.80665 / gravity / 0.01);
    let due = [kx / 0.0475, ky / 0.0475, kxy / 0.0475, kyx / 0.0475, x / 0.01, y / 0.01, g, k];
    for (place, share) in due.into_iter().enumerate() {
        let text = whole(&[shares.strip(place)]);
        let page = Document::parse(&text).unwrap();
        let one = |class| of_class(page.root(), class)[0];
        axis.says(number(one("zero"), "x1"), 0.0);
        axis.says(number(one("limit"), "x1"), 100.0);
        axis.says(end(one("bar"), share), 100.0 * share);
        axis.says(end(one("bar-open"), share), 200.0 * share);
    }
}
