//! Deviations relative to each other: a change of one position that the parts common to all positions hide.
//!
//! Platform and base are set up anew for every certificate, which turns all positions together. If these common parts are
//! larger than the own part of a position, its drift does not show in the deviation itself. So each deviation is also
//! compared with its expectation given the others of the same certificate, which the common parts do not change much.

use super::drift::{Series, Value, years};
use crate::calibration::inputs::Turn;
use crate::stand::{Certificate, CertifiedPosition, Stand};
use jiff::civil::Date;
use nalgebra::{DMatrix, DVector, Matrix3};

/// Returns every deviation less its expectation given the others, up to a constant, with the uncertainty of this
/// difference; `first` is the date of the first certificate. Certificates that do not state all uncertainties, and
/// positions that are not in all of the others, are left out; empty if nothing common is stated or nothing can be compared.
///
/// With the covariance V of the deviations y of a certificate, mean of all certificates, the difference of y_k from its
/// expectation is (V⁻¹ y)_k / (V⁻¹)_kk.
pub(super) fn series(certificates: &[&Stand], first: Date) -> Vec<Series> {
    let stated = |stand: &&&Stand| stand.positions.iter().all(|at| at.u_arcsec().iter().all(Option::is_some));
    let known: Vec<&Stand> = certificates.iter().filter(stated).copied().collect();
    let is_common = |stand: &&Stand| {
        let certificate = &stand.certificate;
        [certificate.common_platform_arcsec, certificate.common_base_arcsec].iter().flatten().any(|u| *u > 0.0)
    };
    if known.len() < 2 || !known.iter().any(is_common) {
        return Vec::new();
    }
    let mut wanted: Vec<&CertifiedPosition> = known[0].positions.iter().collect();
    wanted.retain(|at| known.iter().all(|stand| position(stand, at).is_some()));
    wanted.sort_by_key(|at| at.index());
    let positions =
        known.iter().map(|stand| -> Vec<_> { wanted.iter().filter_map(|at| position(stand, at)).collect() });
    let each: Vec<_> = positions
        .zip(&known)
        .map(|(positions, stand)| (covariance(&positions, &stand.certificate), positions, *stand))
        .collect();
    let size = 3 * wanted.len();
    let mean = each.iter().fold(DMatrix::zeros(size, size), |sum, (covariance, ..)| sum + covariance);
    let Some(inverse) = mean.cholesky().map(|factor| factor.inverse()) else { return Vec::new() };
    let relative = DMatrix::from_fn(size, size, |row, column| inverse[(row, column)] / inverse[(row, row)]);
    let values = each.iter().map(|(covariance, positions, stand)| {
        let deviations = DVector::from_iterator(size, positions.iter().flat_map(|at| at.angles_arcsec()));
        let variance = (&relative * covariance * relative.transpose()).diagonal();
        let differences = &relative * deviations;
        let value = |row: usize| Value {
            certificate: stand.certificate.number.clone(),
            date: stand.certificate.measured(),
            years: years(first, &stand.certificate),
            arcsec: differences[row],
            u_arcsec: Some(variance[row].sqrt()),
            degrees_of_freedom: positions[row / 3].degrees_of_freedom.unwrap_or(f64::INFINITY),
        };
        (0..size).map(value).collect::<Vec<_>>()
    });
    let values: Vec<Vec<Value>> = values.collect();
    let of_row = |row: usize| {
        let values = values.iter().map(|certificate| certificate[row].clone()).collect();
        Series::of(wanted[row / 3].index(), row % 3, values)
    };
    (0..size).map(of_row).collect()
}

/// Returns the position of a stand with the index and the nominal angles of another one.
fn position<'a>(stand: &'a Stand, other: &CertifiedPosition) -> Option<&'a CertifiedPosition> {
    let nominal = |at: &CertifiedPosition| (at.index(), at.theta_deg, at.phi_deg);
    stand.positions.iter().find(|at| nominal(at) == nominal(other))
}

/// Returns the covariance of α, β, γ of all positions, arcsec²: their own parts, and the turns of platform and base.
fn covariance(positions: &[&CertifiedPosition], certificate: &Certificate) -> DMatrix<f64> {
    let size = 3 * positions.len();
    let (mut platform, mut base) = (DMatrix::zeros(size, 3), DMatrix::zeros(size, 3));
    let mut own = DVector::zeros(size);
    for (place, at) in positions.iter().enumerate() {
        let turn = Turn::of(&at.to_model(), &Matrix3::identity());
        let to_angles = turn.angles_of_rotation();
        platform.fixed_rows_mut::<3>(3 * place).copy_from(&to_angles);
        base.fixed_rows_mut::<3>(3 * place).copy_from(&(to_angles * turn.attitude));
        for (angle, u) in at.u_arcsec().into_iter().enumerate() {
            own[3 * place + angle] = u.unwrap_or(0.0) * u.unwrap_or(0.0);
        }
    }
    let common =
        |turns: DMatrix<f64>, u: Option<f64>| &turns * turns.transpose() * (u.unwrap_or(0.0) * u.unwrap_or(0.0));
    DMatrix::from_diagonal(&own)
        + common(platform, certificate.common_platform_arcsec)
        + common(base, certificate.common_base_arcsec)
}
