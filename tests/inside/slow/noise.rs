//! The noise of a stand against NumPy: the same ratio from a design matrix written down anew in Python.

use crate::inside::programs;
use dtg_passport::attitude::Deviation;
use dtg_passport::calibration::prediction::noise_growth;
use dtg_passport::coefficients::{Position, StandGeometry};
use dtg_passport::gyro::GyroType;
use dtg_passport::laboratory::Laboratory;
use dtg_passport::site::Site;
use dtg_passport::stand::{CertifiedPosition, Stand};
use std::fs;

/// Reads a stand and a latitude; prints the worst ratio of the standard uncertainties of K, ω_0, ω_g, ω_k.
const PROGRAM: &str = r#"
import sys, numpy as np, yaml
stand, latitude = yaml.safe_load(open(sys.argv[1], "rb")), np.radians(float(sys.argv[2]))
rx = lambda t: np.array([[1, 0, 0], [0, np.cos(t), np.sin(t)], [0, -np.sin(t), np.cos(t)]])
ry = lambda t: np.array([[np.cos(t), 0, -np.sin(t)], [0, 1, 0], [np.sin(t), 0, np.cos(t)]])
rz = lambda t: np.array([[np.cos(t), np.sin(t), 0], [-np.sin(t), np.cos(t), 0], [0, 0, 1]])
K, w0 = np.array([[95, 9.5], [9.5, 95]]), np.array([20, 20])
earth = 7.292115e-5 * 3600 * 180 / np.pi * np.array([0, np.cos(latitude), np.sin(latitude)])
def uncertainties(perfect):
    rows, c = [], []
    for p in stand["positions"]:
        a, b, g = (0 if perfect else np.radians(p[k] / 3600) for k in ("alpha_arcsec", "beta_arcsec", "gamma_arcsec"))
        A = rz(g) @ ry(b) @ rx(a) @ rz(np.radians(p["phi_deg"])) @ rx(np.radians(p["theta_deg"]))
        n, w = A[:2, 2], (A @ earth)[:2]
        J = np.linalg.solve(K, w - w0 - np.array([[10, -10], [10, 10]]) @ n)
        rows += [[J[0], J[1], 0, 0, 1, 0, n[0], -n[1]], [0, 0, J[0], J[1], 0, 1, n[1], n[0]]]
        c.append(np.linalg.inv(K @ np.diag((8.7e-5 * J) ** 2 + 1e-12) @ K.T))
    X, W = np.array(rows), np.zeros((2 * len(c), 2 * len(c)))
    for i, weight in enumerate(c):
        W[2 * i:2 * i + 2, 2 * i:2 * i + 2] = weight
    return np.sqrt(np.diag(np.linalg.inv(X.T @ W @ X)))
r = uncertainties(False) / uncertainties(True)
print(max(r[:4]), max(r[4:6]), r[6], r[7])
"#;

#[test]
fn the_ratio_is_that_of_numpy() {
    let site_file = fs::read(programs::project("sites/beijing-nim.yaml")).unwrap();
    let site = Site::from_yaml("beijing-nim.yaml", &site_file).unwrap();
    let earth = site.earth();
    for path in ["passports/SPS-1/0203/stand.yaml", "passports/SPS-2/0017/stand.yaml"] {
        let stand = Stand::from_yaml(path, &fs::read(programs::project(path)).unwrap()).unwrap();
        let positions: Vec<_> = stand.positions.iter().map(CertifiedPosition::to_model).collect();
        let (gyro, meter) = (GyroType::gvk_6().nominal.to_model(), (&Laboratory::paper().meter).into());
        let at = |positions: &[Position]| StandGeometry::new(positions).unwrap().at(earth.rate(&site));
        let ideal = positions.iter().map(|at| Position { deviation: Deviation::default(), ..*at });
        let found = noise_growth(&at(&positions), &at(&ideal.collect::<Vec<_>>()), &gyro, meter).unwrap();
        let mut python = programs::python();
        python.args(["-c", PROGRAM]).arg(programs::project(path)).arg(earth.latitude_deg.to_string());
        let expected: Vec<f64> =
            programs::output(python).split_whitespace().map(|number| number.parse().unwrap()).collect();
        for (found, expected) in [found.k, found.omega0, found.omega_g, found.omega_k].iter().zip(&expected) {
            // The normal equations in the Python program square a condition of some hundreds.
            assert!((found / expected - 1.0).abs() < 1e-9, "{path}: {found} {expected}");
        }
    }
}
