//! Pictures of a passport.

use crate::inside::fixtures;
use crate::inside::picture::{ROUNDING, both, english, number, of_class, reach, svgs, tip, whole};
use dtg_passport::gyro::GyroType;
use dtg_passport::laboratory::Laboratory;
use dtg_passport::passport::accuracy::Stated;
use dtg_passport::passport::content::Content;
use dtg_passport::passport::issue::{Issue, draft};
use dtg_passport::report::page::{Language, Languages};
use dtg_passport::report::picture::strips::Deviations;
use dtg_passport::report::picture::{positions, stand};
use dtg_passport::site::Site;
use dtg_passport::stand::{CertifiedPosition, Stand};
use roxmltree::{Document, Node};
use std::collections::BTreeSet;

/// A passport's content and its text; with an accuracy for the paper's gyro and meter.
pub fn passport(stand: &str, site: &str) -> (Content, String) {
    let stand = Stand::from_yaml("stand.yaml", stand.as_bytes()).unwrap();
    let site = Site::from_yaml("site.yaml", site.as_bytes()).unwrap();
    let gyro = GyroType::gvk_6();
    let mut order = Issue::first(fixtures::ISSUER, fixtures::at(fixtures::ISSUED_AT));
    order.accuracy = Some(Stated { gyro, laboratory: Laboratory::paper() });
    let draft = draft(&stand, &site, &order).unwrap();
    (draft.content().clone(), draft.payload().to_owned())
}

fn all_pictures(languages: &Languages, content: &Content) -> String {
    let pictures = [stand::stand(languages, 90.0), positions::positions(languages, &content.positions, 90.0)];
    whole(&pictures)
}

fn position(i: u32, j: u32, angles_deg: [f64; 2], deviation_deg: [f64; 3]) -> CertifiedPosition {
    let [alpha_arcsec, beta_arcsec, gamma_arcsec] = deviation_deg.map(|degrees| 3600.0 * degrees);
    CertifiedPosition {
        i,
        j,
        theta_deg: angles_deg[0],
        phi_deg: angles_deg[1],
        alpha_arcsec,
        beta_arcsec,
        gamma_arcsec,
        u_alpha_arcsec: None,
        u_beta_arcsec: None,
        u_gamma_arcsec: None,
        degrees_of_freedom: None,
    }
}

/// Tips of the axes x, y, z of each position, from the middle of its panel.
fn axes(drawn: &[CertifiedPosition], middle: [f64; 2]) -> Vec<[[f64; 2]; 3]> {
    axes_at(90.0, drawn, middle)
}

/// The same on a base whose frame axis points to an azimuth.
fn axes_at(frame_axis_azimuth_deg: f64, drawn: &[CertifiedPosition], middle: [f64; 2]) -> Vec<[[f64; 2]; 3]> {
    let text = whole(&[positions::positions(&english(), drawn, frame_axis_azimuth_deg)]);
    let page = Document::parse(&text).unwrap();
    let of_panel = |svg: Node| {
        let tips: Vec<[f64; 2]> = of_class_of(svg, "axis");
        [0, 1, 2].map(|axis| [tips[axis][0] - middle[0], tips[axis][1] - middle[1]])
    };
    svgs(&page).into_iter().map(of_panel).collect()
}

fn of_class_of(svg: Node, class: &str) -> Vec<[f64; 2]> {
    let arrows = svg.descendants().filter(|node| node.attribute("class") == Some(class));
    arrows.map(tip).collect()
}

/// East, north and up as they are drawn, and the middle: from position (1, 1) of a perfect stand, where the case's axes are the
/// base's (paper, fig. 3), and position (1, 3), where x and y point the other way.
fn drawn_directions() -> ([[f64; 2]; 3], [f64; 2]) {
    let found = axes(&[position(1, 1, [0.0, 0.0], [0.0; 3]), position(1, 3, [0.0, 180.0], [0.0; 3])], [0.0, 0.0]);
    let middle = [0, 1].map(|k| 0.5 * (found[0][0][k] + found[1][0][k]));
    ([0, 1, 2].map(|axis| [0, 1].map(|k| found[0][axis][k] - middle[k])), middle)
}

#[track_caller]
fn same(found: [f64; 2], expected: [f64; 2]) {
    let near = |k: usize| (found[k] - expected[k]).abs() < 3.0 * ROUNDING;
    assert!(near(0) && near(1), "{found:?}, expected {expected:?}");
}

fn combination(parts: &[(f64, [f64; 2])]) -> [f64; 2] {
    [0, 1].map(|k| parts.iter().map(|(factor, vector)| factor * vector[k]).sum())
}

#[test]
fn up_is_up_and_the_view_is_from_the_south_east() {
    let ([east, north, up], _) = drawn_directions();
    assert!(up[0].abs() < ROUNDING && up[1] < -20.0, "{up:?}");
    // To the right and nearer, so lower; to the right and farther, so higher.
    assert!(east[0] > 20.0 && east[1] > 5.0, "{east:?}");
    assert!(north[0] > 10.0 && north[1] < -5.0, "{north:?}");
}

/// By hand after eq. (3), A = Rz(φ)·Rx(θ): where x, y, z point in each of the eight positions.
#[test]
fn the_eight_positions_point_where_the_paper_says() {
    let ([e, n, u], middle) = drawn_directions();
    let [w, s, d] = [e, n, u].map(|[x, y]| [-x, -y]);
    let expected = [
        ((1, 1), [e, n, u]),
        ((1, 2), [n, w, u]),
        ((1, 3), [w, s, u]),
        ((1, 4), [s, e, u]),
        ((2, 1), [e, u, s]),
        ((2, 2), [u, w, s]),
        ((2, 3), [w, d, s]),
        ((2, 4), [d, e, s]),
    ];
    let stand: Vec<CertifiedPosition> = expected
        .iter()
        .map(|((i, j), _)| position(*i, *j, [90.0 * f64::from(i - 1), 90.0 * f64::from(j - 1)], [0.0; 3]))
        .collect();
    for (found, (index, axes)) in axes(&stand, middle).iter().zip(&expected) {
        for (found, expected) in found.iter().zip(axes) {
            println!("{index:?}");
            same(*found, *expected);
        }
    }
}

/// By hand: E turns about the platform's own axes, so γ moves x towards y, β moves x away from z, α moves y towards z.
#[test]
fn deviations_turn_the_axes_the_right_way() {
    let ([e, n, u], middle) = drawn_directions();
    let (sin, cos) = libm::sincos(20_f64.to_radians());
    let stand = [
        position(1, 1, [0.0, 0.0], [0.0, 0.0, 20.0]),
        position(1, 1, [0.0, 0.0], [0.0, 20.0, 0.0]),
        position(1, 1, [0.0, 0.0], [20.0, 0.0, 0.0]),
        position(2, 1, [90.0, 0.0], [20.0, 0.0, 0.0]),
    ];
    let found = axes(&stand, middle);
    same(found[0][0], combination(&[(cos, e), (sin, n)]));
    same(found[0][2], u);
    same(found[1][0], combination(&[(cos, e), (-sin, u)]));
    same(found[2][1], combination(&[(cos, n), (sin, u)]));
    // At θ = 90° y is up and z south.
    same(found[3][1], combination(&[(cos, u), (-sin, n)]));
}

/// By hand: the view turns with the frame's axis, so at every azimuth the axes are drawn where they are at 90°, and east
/// and north turn. With the axis at 0°, y is west, so east is drawn where −y is, and north where x is.
#[test]
fn the_frames_axis_points_to_its_azimuth() {
    let ([x, y, up], middle) = drawn_directions();
    let first = [position(1, 1, [0.0, 0.0], [0.0; 3])];
    let opposite = |[x, y]: [f64; 2]| [-x, -y];
    let at_60 = [combination(&[(0.75_f64.sqrt(), x), (-0.5, y)]), combination(&[(0.5, x), (0.75_f64.sqrt(), y)])];
    for (azimuth_deg, [east, north]) in [
        (0.0, [opposite(y), x]),
        (60.0, at_60),
        (90.0, [x, y]),
        (180.0, [y, opposite(x)]),
        (270.0, [opposite(x), opposite(y)]),
    ] {
        for (found, expected) in axes_at(azimuth_deg, &first, middle)[0].iter().zip([x, y, up]) {
            same(*found, expected);
        }
        let text = whole(&[stand::stand(&english(), azimuth_deg)]);
        let page = Document::parse(&text).unwrap();
        let along = |arrow: Node| {
            let shaft = arrow.children().find(|node| node.has_tag_name("line")).unwrap();
            let ([x, y], [x1, y1]) = (tip(arrow), [number(shaft, "x1"), number(shaft, "y1")]);
            [x - x1, y - y1]
        };
        // The arrows of east, north and up are one unit of 36 long, an axis of the positions 1.27 of 52.
        let scale = 36.0 / (1.27 * 52.0);
        for (arrow, expected) in of_class(page.root(), "meridian").into_iter().zip([east, north, up]) {
            same(along(arrow), expected.map(|part| scale * part));
        }
        // The arrow of ξ is 0.4 units of 86 long.
        let scale = 0.4 * 86.0 / (1.27 * 52.0);
        same(along(of_class(page.root(), "base-axis")[0]), x.map(|part| scale * part));
    }
}

#[test]
fn any_number_of_positions_at_any_angles() {
    for count in [4, 24] {
        let stand: Vec<CertifiedPosition> = (0..count)
            .map(|k| position(3 + k / 6, 1 + k % 6, [f64::from(37 * k), f64::from(61 * k)], [1.0; 3]))
            .collect();
        let text = whole(&[positions::positions(&both(), &stand, 90.0)]);
        let page = Document::parse(&text).unwrap();
        assert_eq!(svgs(&page).len(), count as usize);
        let text = whole(&[Deviations::of(&stand).bar((1.0, None))]);
        assert!(!text.contains("whisker"), "no uncertainty is stated");
    }
}

/// By hand: drawn are 10.04°, 8°, 11.1°, 10°, and 20° as it is.
#[test]
fn small_deviations_are_exaggerated() {
    let factor = |deviation_deg: f64| {
        let stand = [position(1, 1, [0.0, 0.0], [0.0, 0.0, deviation_deg])];
        let text = whole(&[positions::positions(&english(), &stand, 90.0)]);
        let page = Document::parse(&text).unwrap();
        let drawn: Vec<[f64; 2]> = of_class_of(svgs(&page)[0], "axis");
        (positions::exaggeration(&stand), drawn)
    };
    let cases = [(90.4 / 3600.0, 400.0), (0.004, 2000.0), (-80.0 / 3600.0, 500.0), (2.5, 4.0), (20.0, 1.0), (0.0, 1.0)];
    for (deviation_deg, due) in cases {
        assert!((factor(deviation_deg).0 - due).abs() < 1e-6 * due, "{deviation_deg}°");
    }
    // Drawn where the deviation is fifty times as large.
    let ((_, small), (_, large)) = (factor(0.15), factor(7.5));
    for (one, other) in small.into_iter().zip(large) {
        same(one, other);
    }
}

#[test]
fn bars_are_as_long_as_deviations_are_large() {
    let (content, _) = passport(fixtures::ARC_MINUTES, fixtures::SITE);
    // The largest one, β of (1, 4), gives the scale: 90.4.
    let bars = Deviations::of(&content.positions);
    let drawn = |value: f64, u: f64| {
        let text = whole(&[bars.bar((value, Some(u)))]);
        let page = Document::parse(&text).unwrap();
        let (bar, zero) = (of_class(page.root(), "bar")[0], of_class(page.root(), "zero")[0]);
        (number(bar, "x"), number(bar, "width"), number(zero, "x1"), reach(of_class(page.root(), "whisker")[0]))
    };
    let scale = drawn(-90.4, 1.2).1 / 90.4;
    assert!(scale > 0.3, "{scale}");
    for at in &content.positions {
        let (value, u) = (at.alpha_arcsec, at.u_alpha_arcsec.unwrap());
        let (x, width, zero, [from, to]) = drawn(value, u);
        let end = if value > 0.0 { x + width } else { x };
        assert!((end - zero - scale * value).abs() < 0.3, "{value}: from {zero} to {end}");
        assert!((to - from - scale * 4.0 * u).abs() < 0.3, "plus and minus 2u of {u}: from {from} to {to}");
        assert!((0.5 * (from + to) - end).abs() < 0.3);
    }
}

#[test]
fn pictures_have_words_and_no_colours_of_their_own() {
    for languages in [english(), Languages::from(Language::Russian), both()] {
        let (content, _) = passport(fixtures::DEGREES, fixtures::SITE);
        let text = all_pictures(&languages, &content);
        let page = Document::parse(&text).unwrap();
        let ids: Vec<&str> = page.descendants().filter_map(|node| node.attribute("id")).collect();
        let unique: BTreeSet<&str> = ids.iter().copied().collect();
        assert_eq!(ids.len(), unique.len(), "an id stands twice");
        for svg in svgs(&page) {
            let labels: Vec<&str> = svg.attribute("aria-labelledby").unwrap().split(' ').collect();
            assert_eq!(labels.len(), 2 * languages.iter().count());
            for label in labels {
                let node = svg.descendants().find(|node| node.attribute("id") == Some(label)).unwrap();
                assert!(node.text().unwrap().len() > 8 && !node.text().unwrap().contains(['{', '}']), "{label}");
            }
            let reference = svg.descendants().find_map(|node| node.attribute("fill"));
            if let Some(fill) = reference {
                let id = fill.strip_prefix("url(#").unwrap().strip_suffix(')').unwrap();
                assert!(unique.contains(id), "{id}");
            }
        }
        // What is drawn again is part of the same page.
        for used in page.descendants().filter_map(|node| node.attribute("href")) {
            assert!(unique.contains(used.strip_prefix('#').unwrap()), "{used}");
        }
        for attribute in ["stroke=", "color=", "rgb(", "NaN", "inf"] {
            assert!(!text.contains(attribute), "{attribute}");
        }
    }
}

/// A page may stand once for each language, and ids differ then too.
#[test]
fn ids_differ_from_one_language_to_the_other() {
    let (content, _) = passport(fixtures::DEGREES, fixtures::SITE);
    let (one, other) =
        (all_pictures(&english(), &content), all_pictures(&Languages::from(Language::Russian), &content));
    let ids = |text: &str| -> BTreeSet<String> {
        let page = Document::parse(text).unwrap();
        page.descendants().filter_map(|node| node.attribute("id").map(str::to_owned)).collect()
    };
    assert!(ids(&one).is_disjoint(&ids(&other)));
}
