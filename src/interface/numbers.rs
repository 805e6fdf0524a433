//! Numbers of a passport by name, as binary64.

use crate::passport::{Content, MatrixRows, Rows};

/// Value of a number that the passport does not state.
const NOT_STATED: f64 = f64::NAN;

/// Returns a matrix of the paper by its key, NaN if the passport has no matrices; `None` for an unknown key.
pub fn matrix(content: &Content, key: &str) -> Option<Rows> {
    let of: fn(&MatrixRows) -> Rows = match key {
        "delta" => |of| of.delta,
        "b_deg_per_h" => |of| of.b_deg_per_h,
        "c_deg_per_h_per_g" => |of| of.c_deg_per_h_per_g,
        "n1" => |of| of.n1,
        "n2" => |of| of.n2,
        "n2_inverse" => |of| of.n2_inverse,
        "omega1_deg_per_h" => |of| of.omega1_deg_per_h,
        "omega2_deg_per_h" => |of| of.omega2_deg_per_h,
        _ => return None,
    };
    Some(content.matrices.as_ref().map_or([[NOT_STATED; 2]; 2], of))
}

/// Returns an array row by row, NaN where the passport states nothing: a [`matrix`], `gravity` (m/s²), or with a row for
/// each position `ij`, `angles` (nominal θ and φ, degrees), `n` (g), `omega` (°/h), `deviations` and `u_deviations` (″);
/// `self_check` has rows i, j, J_x, J_y (mA), none without a self-check. `None` for an unknown name.
pub fn array(content: &Content, name: &str) -> Option<Vec<f64>> {
    let Content { positions, vectors, self_check, .. } = content;
    let each = |of: fn(&_) -> Vec<f64>| positions.iter().flat_map(of).collect();
    let vectors = |of: fn(&_) -> [f64; 2]| {
        let of_one = |i, j| vectors.iter().find(|at| (at.i, at.j) == (i, j)).map_or([NOT_STATED; 2], of);
        positions.iter().flat_map(|at| of_one(at.i, at.j)).collect()
    };
    Some(match name {
        "gravity" => vec![content.earth.gravity_m_per_s2],
        "ij" => each(|at| vec![at.i.into(), at.j.into()]),
        "angles" => each(|at| vec![at.theta_deg, at.phi_deg]),
        "n" => vectors(|at| at.specific_force_g),
        "omega" => vectors(|at| at.omega_deg_per_h),
        "deviations" => each(|at| vec![at.alpha_arcsec, at.beta_arcsec, at.gamma_arcsec]),
        "u_deviations" => {
            each(|at| [at.u_alpha_arcsec, at.u_beta_arcsec, at.u_gamma_arcsec].map(|u| u.unwrap_or(NOT_STATED)).into())
        }
        "self_check" => {
            let currents = self_check.iter().flat_map(|check| &check.currents);
            currents.flat_map(|at| [at.i.into(), at.j.into(), at.jx_ma, at.jy_ma]).collect()
        }
        key => matrix(content, key)?.concat(),
    })
}
