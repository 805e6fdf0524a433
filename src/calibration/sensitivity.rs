//! First-order sensitivities of the misclosures e = ω_3 − K J − ω_0 − ω_n n of all positions (two each) to every input.
//!
//! Rotations are passive. If the case rotates by the small vector δ, the coordinates v of a fixed vector change by
//! v × δ. If the base rotates by δ about east, north and up, Ã w changes by Ã (w × δ), with w in these axes.

use super::repeats::Repeats;
use super::unknowns::Unknowns;
use super::{Cause, Setup};
use nalgebra::{DMatrix, Matrix2, Matrix2x3, Vector2, Vector3};

/// Change of the misclosure of one position, °/h, per unit change of an input.
type Change = Vector2<f64>;

/// Vectors of one position in case coordinates, or their change per radian.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct VectorChange {
    pub(crate) earth_rate_deg_per_h: Vector3<f64>,
    pub(crate) vertical: Vector3<f64>,
}

impl VectorChange {
    /// Returns the change of vectors per radian of a rotation of the case about the unit vector `axis` (case coordinates).
    pub(crate) fn turned(&self, axis: &Vector3<f64>) -> Self {
        Self { earth_rate_deg_per_h: self.earth_rate_deg_per_h.cross(axis), vertical: self.vertical.cross(axis) }
    }
}

impl Setup {
    /// Returns the vectors of position `place`, in case coordinates.
    pub(crate) fn in_case(&self, place: usize) -> VectorChange {
        let attitude = &self.turns[place].attitude;
        VectorChange {
            earth_rate_deg_per_h: attitude * self.earth_rate_east_north_up(),
            vertical: attitude.column(2).into_owned(),
        }
    }

    /// Returns the change of the vectors of position `place` per radian of a rotation of the base about the unit vector
    /// `axis` (east, north, up).
    pub(crate) fn base_turned(&self, place: usize, axis: &Vector3<f64>) -> VectorChange {
        let attitude = &self.turns[place].attitude;
        VectorChange {
            earth_rate_deg_per_h: attitude * self.earth_rate_east_north_up().cross(axis),
            vertical: attitude * Vector3::z().cross(axis),
        }
    }

    /// Returns the change of the vectors of position `place` per radian of latitude: ω_Γ falls by ω_B, ω_B rises by
    /// ω_Γ.
    pub(crate) fn latitude_changed(&self, place: usize) -> VectorChange {
        let earth = self.earth_rate_east_north_up();
        let change = self.turns[place].attitude * Vector3::new(0.0, -earth.z, earth.y);
        VectorChange { earth_rate_deg_per_h: change, vertical: Vector3::zeros() }
    }

    /// Returns the change of the vectors of position `place` per unit of a cause; 0 for causes in the currents or the
    /// gyro's drift.
    pub(crate) fn changed(&self, place: usize, cause: Cause) -> VectorChange {
        let turned = |axis: &Vector3<f64>| self.in_case(place).turned(axis);
        match cause {
            Cause::Angle(index, angle) if index == self.coefficients().positions[place].index => {
                turned(&self.turns[place].axes[angle])
            }
            Cause::Return(_, axis) | Cause::Platform(axis) | Cause::Seat(axis) => turned(&Vector3::ith(axis, 1.0)),
            Cause::Base(axis) | Cause::Level(axis) => self.base_turned(place, &Vector3::ith(axis, 1.0)),
            Cause::Azimuth | Cause::Mark => self.base_turned(place, &Vector3::z()),
            Cause::Latitude | Cause::Deflection => self.latitude_changed(place),
            _ => VectorChange { earth_rate_deg_per_h: Vector3::zeros(), vertical: Vector3::zeros() },
        }
    }
}

/// Sensitivities of the misclosures at one solution.
pub(crate) struct Sensitivity<'a> {
    setup: &'a Setup,
    unknowns: &'a Unknowns,
}

impl<'a> Sensitivity<'a> {
    pub(crate) fn new(setup: &'a Setup, unknowns: &'a Unknowns) -> Self {
        Self { setup, unknowns }
    }

    /// Returns the change of the misclosure of position `place` for a change of its vectors.
    fn of_vectors(&self, place: usize, change: &VectorChange) -> Change {
        let VectorChange { earth_rate_deg_per_h, vertical } = change;
        let at = &self.setup.coefficients().positions[place];
        let unknowns = self.unknowns;
        let drift = unknowns.parameters.omega_n_deg_per_h_per_g() * vertical.xy() + unknowns.beyond_the_paper(vertical);
        // d(n n_z) = dn n_z + n dn_z (paper, eq. (2)).
        let anisoelastic = vertical.xy() * at.specific_force_z_g + at.specific_force_g * vertical.z;
        earth_rate_deg_per_h.xy() - drift - anisoelastic * unknowns.anisoelasticity_deg_per_h_per_g2
    }

    /// Returns the changes of the misclosure of position `place`, °/h per radian, for rotations of the case about x, y and
    /// z, 2×3.
    pub(crate) fn to_case_turns(&self, place: usize) -> Matrix2x3<f64> {
        let (axes, here) = ([Vector3::x(), Vector3::y(), Vector3::z()], self.setup.in_case(place));
        Matrix2x3::from_columns(&axes.map(|axis| self.of_vectors(place, &here.turned(&axis))))
    }

    /// Returns the covariance of the own part of a position, (°/h)², 2×2. It includes the specification of the meter,
    /// the repeatability, the noise of the readings and that of the gyro according to `repeats`, and the certified angles.
    pub(crate) fn own_covariance(&self, place: usize, current_ma: &Vector2<f64>, repeats: &Repeats) -> Matrix2<f64> {
        let meter = self.setup.uncertainty().meter;
        let noise = repeats.noise_variance_ma2(place);
        let k = &self.unknowns.parameters.k_deg_per_h_per_ma;
        let currents = current_ma.map(|current| meter.own_variance_ma2(current) + noise);
        let meter = k * Matrix2::from_diagonal(&currents) * k.transpose();
        let gyro = Matrix2::from_diagonal_element(repeats.drift_variance(place));
        self.with_return(meter, place, repeats.return_share(place)) + self.of_certified_angles(place) + gyro
    }

    /// Returns the covariance of one visit from the repeatability, (°/h)², 2×2.
    pub(crate) fn of_return(&self, place: usize) -> Matrix2<f64> {
        self.with_return(Matrix2::zeros(), place, 1.0)
    }

    /// Returns `covariance` plus that of the repeatability, multiplied by `share`.
    fn with_return(&self, covariance: Matrix2<f64>, place: usize, share: f64) -> Matrix2<f64> {
        let u = self.setup.uncertainty().repeatability_rad * share.sqrt();
        if u == 0.0 {
            return covariance;
        }
        self.to_case_turns(place).column_iter().fold(covariance, |sum, turn| {
            let change = turn * u;
            sum + change * change.transpose()
        })
    }

    /// Returns the covariance of a position from its certified angles, (°/h)², 2×2.
    pub(crate) fn of_certified_angles(&self, place: usize) -> Matrix2<f64> {
        self.to_certified_angles(place).iter().map(|change| change * change.transpose()).sum()
    }

    /// Returns the changes of the misclosure of a position, °/h, for one standard uncertainty of each of its certified
    /// angles α, β, γ.
    pub(crate) fn to_certified_angles(&self, place: usize) -> [Change; 3] {
        let angles = self.setup.uncertainty().angles_rad.get(place).copied().unwrap_or_default();
        let (axes, here) = (&self.setup.turns[place].axes, self.setup.in_case(place));
        std::array::from_fn(|angle| match angles[angle] {
            0.0 => Change::zeros(),
            u => self.of_vectors(place, &here.turned(&axes[angle])) * u,
        })
    }

    /// Returns the errors of the misclosures for one standard uncertainty of each common input, °/h (two rows per
    /// position × inputs): platform and seat, base with level and azimuth, latitude, meter gain and offset, and the mean
    /// of the turn-ons. Exact inputs have no column.
    pub(crate) fn shared(&self, currents_ma: &[Vector2<f64>], repeats: &Repeats) -> DMatrix<f64> {
        let u = self.setup.uncertainty();
        let case = [0, 1, 2].map(|axis| (Cause::Seat(axis), libm::hypot(u.common_platform_rad, u.seating_rad[axis])));
        let at_site = [u.level_rad, u.level_rad, libm::hypot(u.azimuth_rad, u.mark_rad)];
        let base = [0, 1, 2].map(|axis| (Cause::Base(axis), libm::hypot(u.common_base_rad, at_site[axis])));
        let others = [
            (Cause::Latitude, libm::hypot(u.latitude_rad, u.deflection_rad)),
            (Cause::Gain, u.meter.gain),
            (Cause::Offset, u.meter.offset_ma),
        ];
        let turn_ons = [0, 1].map(|axis| (Cause::TurnOn(axis), repeats.turn_on_of_mean_deg_per_h()));
        let scale = [0, 1, 2, 3].map(|element| (Cause::Scale(element), repeats.scale_of_mean(element)));
        let inputs = case.into_iter().chain(base).chain(others).chain(turn_ons).chain(scale);
        self.columns(currents_ma, &inputs.filter(|(_, u)| *u > 0.0).collect::<Vec<_>>())
    }

    /// Returns the errors of the misclosures for one standard uncertainty of each of the `inputs`, °/h (two rows per position
    /// × inputs).
    pub(crate) fn columns(&self, currents_ma: &[Vector2<f64>], inputs: &[(Cause, f64)]) -> DMatrix<f64> {
        let mut columns = DMatrix::zeros(2 * currents_ma.len(), inputs.len());
        for (mut column, (cause, u)) in columns.column_iter_mut().zip(inputs) {
            for (place, current_ma) in currents_ma.iter().enumerate() {
                column.fixed_rows_mut::<2>(2 * place).copy_from(&(self.to(place, current_ma, *cause) * *u));
            }
        }
        columns
    }

    /// Returns the change of the misclosure of position `place` per unit of a cause, °/h.
    pub(crate) fn to(&self, place: usize, current_ma: &Vector2<f64>, cause: Cause) -> Change {
        let (k, here) =
            (&self.unknowns.parameters.k_deg_per_h_per_ma, self.setup.coefficients().positions[place].index);
        match cause {
            _ if cause.position().is_some_and(|at| at != here) => Change::zeros(),
            Cause::Reading(_, axis) => -k.column(axis) * current_ma[axis],
            Cause::Floor(_, axis) | Cause::Noise(_, axis) => -k.column(axis),
            Cause::Visits(_, axis) | Cause::TurnOn(axis) => -Change::ith(axis, 1.0),
            Cause::Scale(element) => -Change::ith(element / 2, current_ma[element % 2]),
            Cause::Differences(_) => Change::zeros(),
            Cause::Gain => -(k * current_ma),
            Cause::Offset => -(k * Vector2::repeat(1.0)),
            _ => self.of_vectors(place, &self.setup.changed(place, cause)),
        }
    }
}
