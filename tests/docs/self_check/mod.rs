//! What the self-check of a passport catches: wrong laboratory software, step by step, and what no exact data can tell apart.

mod equivalent;
mod software;
mod wrong;

use dtg_passport::passport::Content;
use dtg_passport::passport::content_from_anyone;
use software::{Read, Software};
use std::fs;
use std::path::Path;

/// The documented tolerance: |found/stated − 1| for each of the eight numbers.
const TOLERANCE: f64 = 1e-9;

const FICTITIOUS: &str = "docs/self_check.yaml";
const ALMOST_IDEAL: &str = "passports/SPS-2/0017/moscow-bmstu-1.yaml";
const WITH_THE_GVK_6: &str = "tests/golden/passport-1-gvk-6.yaml";

fn content(path: &str) -> Content {
    let bytes = fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap();
    content_from_anyone(path, &bytes).unwrap()
}

/// The largest |found/stated − 1| of K_x, K_xy, K_yx, K_y, ω_0x, ω_0y, ω_g, ω_k; NaN when any is.
fn error(calibrate: impl Fn(Read) -> [f64; 8], content: &Content) -> f64 {
    let stated = content.self_check.as_ref().unwrap();
    let [[k_x, k_xy], [k_yx, k_y]] = stated.k_deg_per_h_per_ma;
    let [omega_0x, omega_0y] = stated.omega0_deg_per_h;
    let (omega_g, omega_k) = (stated.omega_g_deg_per_h_per_g, stated.omega_k_deg_per_h_per_g);
    let due = [k_x, k_xy, k_yx, k_y, omega_0x, omega_0y, omega_g, omega_k];
    let found = calibrate(Read::of(content));
    let off = found.iter().zip(due).map(|(found, due)| (found / due - 1.0).abs());
    off.fold(0.0, |worst: f64, next| if next <= worst { worst } else { next })
}

fn passes(software: &Software, content: &Content) -> bool {
    error(|read| software.calibrate(read), content) <= TOLERANCE
}

#[test]
fn right_software_passes_on_every_passport() {
    for path in [FICTITIOUS, ALMOST_IDEAL, WITH_THE_GVK_6] {
        assert!(passes(&software::RIGHT, &content(path)), "{path}");
    }
}

/// Deviations of 5 to 15 degrees, as docs/integrator.md says.
#[test]
fn the_fictitious_stand_is_far_from_ideal() {
    for position in content(FICTITIOUS).positions {
        for arcsec in [position.alpha_arcsec, position.beta_arcsec, position.gamma_arcsec] {
            assert!((5.0..=15.0).contains(&(arcsec.abs() / 3600.0)), "{} {arcsec}", position.index());
        }
    }
}

#[test]
fn wrong_software_fails_on_the_fictitious_stand() {
    let wrong = wrong::all();
    let names: std::collections::BTreeSet<&str> = wrong.iter().map(|(name, _)| *name).collect();
    assert_eq!(names.len(), wrong.len(), "a name twice");
    assert!(wrong.len() >= 40);
    let caught = |path: &str| {
        let content = content(path);
        let passing = wrong.iter().filter(|(_, software)| passes(software, &content)).map(|(name, _)| *name);
        let passing: Vec<&str> = passing.collect();
        println!(
            "{path}: {} of {} wrong implementations caught; passing: {passing:#?}",
            wrong.len() - passing.len(),
            wrong.len()
        );
        passing
    };
    let on_almost_ideal = caught(ALMOST_IDEAL);
    let with_the_gvk_6 = caught(WITH_THE_GVK_6);
    // Why there is a fictitious stand, and why the GVK-6 had to go.
    assert!(on_almost_ideal.len() < with_the_gvk_6.len());
    assert!(with_the_gvk_6.contains(&"K transposed: K_xy and K_yx exchanged"));
    assert!(caught(FICTITIOUS).is_empty());
    let content = content(FICTITIOUS);
    let least = wrong.iter().map(|(name, software)| (error(|read| software.calibrate(read), &content), *name));
    let least = least.filter(|(error, _)| error.is_finite()).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
    println!("the smallest error among them: {:.1e}, {}", least.0, least.1);
}

/// Other ways to the same numbers: that they pass is no gap, because on exact data they are right.
#[test]
fn what_is_equivalent_on_exact_data_passes() {
    let content = content(FICTITIOUS);
    for (name, reason, calibrate) in equivalent::all() {
        let error = error(calibrate, &content);
        println!("{name}: {reason}: off by {error:.0e}");
        assert!(error <= TOLERANCE, "{name}: {error:e}");
    }
}
