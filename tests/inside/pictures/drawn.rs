//! What is drawn of a passport, read off by the marks of its axes, against the signed file.

use super::passport::passport;
use crate::inside::fixtures;
use crate::inside::picture::{Axis, end, english, middle, number, of_class, reach, row, svgs, tip, whole, words};
use dtg_passport::passport::content::Content;
use dtg_passport::passport::content_from_anyone;
use dtg_passport::report::picture::deviations::Bars;
use dtg_passport::report::picture::{accuracy, positions, vectors};
use roxmltree::{Document, Node};

/// Passports with deviations of minutes and of degrees, and the project's own.
fn passports() -> Vec<Content> {
    let own = include_bytes!("../../../passports/SPS-2/0017/moscow-bmstu-1.yaml");
    let minutes = passport(fixtures::ARC_MINUTES, fixtures::SITE).0;
    let degrees = passport(fixtures::DEGREES, fixtures::SITE).0;
    vec![minutes, degrees, content_from_anyone("own", own).unwrap()]
}

/// The middle of a mark: a circle of the first frame index, a square of the second.
fn centre(mark: Node) -> [f64; 2] {
    match mark.tag_name().name() {
        "circle" => [number(mark, "cx"), number(mark, "cy")],
        _ => [number(mark, "x") + 0.5 * number(mark, "width"), middle(mark)],
    }
}

#[test]
fn deviations_are_where_their_axes_say() {
    for content in passports() {
        let bars = Bars::of(&content.positions);
        let axis_text = whole(&[bars.axis(&english())]);
        let axis_page = Document::parse(&axis_text).unwrap();
        let axis = Axis::along_x(axis_page.root_element());
        let in_degrees = bars.heading(&english(), "α").into_string().contains('°');
        let unit_arcsec = if in_degrees { 3600.0 } else { 1.0 };
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

/// By hand after eq. (5): what a perfect stand would have, in the order of the positions, from ω_Γ and ω_B, or from 0 and 1.
fn ideal(h: f64, v: f64) -> [[f64; 2]; 8] {
    [[0.0, h], [h, 0.0], [0.0, -h], [-h, 0.0], [0.0, v], [v, 0.0], [0.0, -v], [-v, 0.0]]
}

#[test]
fn vectors_end_where_their_axes_say() {
    for content in passports() {
        let rates = ideal(content.earth.horizontal_deg_per_h, content.earth.vertical_deg_per_h);
        let text = whole(&[vectors::vectors(&english(), &content)]);
        let page = Document::parse(&text).unwrap();
        let panels = svgs(&page);
        assert_eq!(panels.len(), 2);
        for (place, panel) in panels.into_iter().enumerate() {
            let (x, y) = (Axis::along_x(panel), Axis::along_y(panel));
            // Every tip has its mark; a vector that is too short to be seen has no arrow.
            let tips: Vec<[f64; 2]> = of_class(panel, "mark").into_iter().map(centre).collect();
            assert_eq!(tips.len(), 8);
            for arrow in of_class(panel, "real").into_iter().map(tip) {
                let near = |mark: &&[f64; 2]| (mark[0] - arrow[0]).abs() < 0.2 && (mark[1] - arrow[1]).abs() < 0.2;
                assert!(tips.iter().any(|mark| near(&mark)), "{arrow:?} has no mark");
            }
            for (index, at) in content.vectors.iter().enumerate() {
                let real = [at.omega_deg_per_h, at.specific_force_g][place];
                let ideal = [rates, ideal(0.0, 1.0)][place][index];
                let due = [0, 1].map(|k| real[k] - ideal[k]);
                x.says(tips[index][0], due[0]);
                y.says(tips[index][1], due[1]);
            }
        }
    }
}

/// By hand after eq. (3) and (5): of Earth rate (0, h, v) the frame leaves h cos θ + v sin θ across its axis, and the platform turns that
/// by φ.
#[test]
fn of_many_positions_each_frame_index_has_its_panels() {
    let mut stand = fixtures::ARC_MINUTES.to_owned();
    for (i, j) in (3..=4).flat_map(|i| (1..=8).map(move |j| (i, j))) {
        let (theta, phi, angle) = (45 * (i - 2), 45 * (j - 1), 20 * i + 15 * j);
        stand += &format!(
            "  - {{i: {i}, j: {j}, theta_deg: {theta}, phi_deg: {phi}, alpha_arcsec: {angle}.5, beta_arcsec: -{angle}, \
             gamma_arcsec: 9{j}, u_alpha_arcsec: 1.2, u_beta_arcsec: 0.85, u_gamma_arcsec: 12.0}}\n"
        );
    }
    let content = passport(&stand, fixtures::SITE).0;
    let text = whole(&[vectors::vectors(&english(), &content)]);
    let page = Document::parse(&text).unwrap();
    let panels = svgs(&page);
    assert_eq!(panels.len(), 8);
    let earth = [(content.earth.horizontal_deg_per_h, content.earth.vertical_deg_per_h), (0.0, 1.0)];
    for (quantity, panels) in panels.chunks(4).enumerate() {
        let (h, v) = earth[quantity];
        let scale = |panel: Node| Axis::along_x(panel).value(100.0);
        for (i, panel) in (1..).zip(panels) {
            assert!((scale(*panel) / scale(panels[0]) - 1.0).abs() < 0.01, "all have one scale");
            let (x, y) = (Axis::along_x(*panel), Axis::along_y(*panel));
            let tips: Vec<[f64; 2]> = of_class(*panel, "real").into_iter().map(tip).collect();
            let mut seen = 0;
            for (at, vectors) in content.positions.iter().zip(&content.vectors).filter(|(at, _)| at.i == i) {
                let (theta, phi) = (at.theta_deg.to_radians(), at.phi_deg.to_radians());
                let across = h * libm::cos(theta) + v * libm::sin(theta);
                let real = [vectors.omega_deg_per_h, vectors.specific_force_g][quantity];
                let due = [real[0] - across * libm::sin(phi), real[1] - across * libm::cos(phi)];
                let near = |tip: &&[f64; 2]| {
                    (x.value(tip[0]) - due[0]).abs() < 3.0 * x.fineness()
                        && (y.value(tip[1]) - due[1]).abs() < 3.0 * y.fineness()
                };
                seen += usize::from(tips.iter().any(|tip| near(&tip)));
            }
            assert_eq!(seen, tips.len(), "each arrow is a position's, in panel {i}");
            assert!(seen >= if i < 3 { 2 } else { 7 }, "{seen} arrows in panel {i}");
        }
    }
}

/// By hand: a tolerance of K_x is 0.05 % of 95, of K_xy 0.5 % of 9.5, of a drift 0.01.
#[test]
fn accuracy_is_where_its_axis_says() {
    let (content, _) = passport(fixtures::ARC_MINUTES, fixtures::SITE);
    let (stated, gravity) = (content.accuracy.as_ref().unwrap(), content.earth.gravity_m_per_s2);
    let text = whole(&[accuracy::accuracy(&english(), stated, gravity)]);
    let page = Document::parse(&text).unwrap();
    let svg = svgs(&page)[0];
    let axis = Axis::along_x(svg);
    axis.says(number(of_class(svg, "limit")[0], "x1"), 100.0);
    let u = &stated.standard_uncertainty;
    let [[kx, kxy], [kyx, ky]] = u.k_deg_per_h_per_ma;
    let [x, y] = u.omega0_deg_per_h;
    let per_g = 9.80665 / gravity;
    let due = [
        ("Kx", kx, 0.0475, 1.0),
        ("Ky", ky, 0.0475, 1.0),
        ("Kxy", kxy, 0.0475, 1.0),
        ("Kyx", kyx, 0.0475, 1.0),
        ("ω0x", x, 0.01, 1.0),
        ("ω0y", y, 0.01, 1.0),
        ("ωg", u.omega_g_deg_per_h_per_g, 0.01, per_g),
        ("ωk", u.omega_k_deg_per_h_per_g, 0.01, per_g),
    ];
    for ((name, u, tolerance, factor), bar) in due.into_iter().zip(of_class(svg, "bar")) {
        axis.says(end(bar, u), 100.0 * factor * u / tolerance);
        assert_eq!(row(svg, middle(bar)), (name.to_owned(), Vec::new()));
    }
}
