//! The estimates of variances on which standard uncertainties rest, with their degrees of freedom.
//!
//! `certify` estimates the repeatability from the readings of all positions together, as one variance per axis. The
//! certified angles of all positions, and the repeatability, which is the mean of the three variances, therefore rest
//! on three estimates and not on one per number. They are recognised by the certificate: the same degrees of freedom
//! and the same size for every position.

use super::inputs::{InputUncertainty, Setup};
use super::repeats::Repeats;

/// Largest relative difference of Σ u² between positions whose angles rest on a common estimate. It is not 0 because
/// the axes of α and γ are not quite at right angles.
const SAME_SIZE: f64 = 0.1;

/// Largest difference between equal degrees of freedom; a certificate states them to a tenth.
const ROUNDING: f64 = 0.5;

/// Estimates on which a standard uncertainty rests.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Basis {
    /// No estimate: the uncertainty is taken as known.
    #[default]
    Known,
    /// Estimate with this index.
    Estimate(usize),
    /// Mean variance of the first three estimates, those of the axes.
    Axes,
}

/// Estimates with few degrees of freedom, and the basis of each uncertainty.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Estimates {
    /// Degrees of freedom of each estimate.
    pub(crate) degrees_of_freedom: Vec<f64>,
    /// Basis of the uncertainties of α, β, γ of each position.
    pub(crate) angles: Vec<[Basis; 3]>,
    pub(crate) returns: Basis,
    pub(crate) noise: Basis,
    pub(crate) visits: Basis,
    pub(crate) turn_ons: Basis,
    /// Scatter of the elements of K between turn-ons, by rows.
    pub(crate) scale: [Basis; 4],
    pub(crate) platform: Basis,
    pub(crate) base: Basis,
}

impl Estimates {
    /// Returns the estimates behind stand and site and those from the scatter of a calibration's readings.
    pub(crate) fn new(setup: &Setup, repeats: &Repeats) -> Self {
        let u = setup.uncertainty();
        let mut all = Self::default();
        // First position, Σ u² and estimates of each group of positions that share them.
        let mut pools: Vec<(usize, f64, [Basis; 3])> = Vec::new();
        for place in 0..setup.coefficients().positions.len() {
            let known = degrees_of_freedom_of(u, place);
            let size: f64 = u.angles_rad.get(place).copied().unwrap_or_default().map(|u| u * u).iter().sum();
            let pool = pools.iter().find(|(first, sum, _)| {
                degrees_of_freedom_of(u, *first) == known && (sum - size).abs() <= SAME_SIZE * sum
            });
            let basis = match pool {
                _ if known == f64::INFINITY => [Basis::Known; 3],
                Some((.., basis)) => *basis,
                None => {
                    let basis = [(); 3].map(|()| all.add(known));
                    pools.push((place, size, basis));
                    basis
                }
            };
            all.angles.push(basis);
        }
        let axes = pools.len() == 1 && all.angles.len() > 1 && all.angles.iter().all(|basis| *basis == all.angles[0]);
        let of_axis = all.degrees_of_freedom.first().copied().unwrap_or(f64::INFINITY);
        let of_all = of_axis - ROUNDING..=3.0 * of_axis + ROUNDING;
        let rests_on_axes = axes && of_all.contains(&u.repeatability_degrees_of_freedom);
        all.returns = if rests_on_axes { Basis::Axes } else { all.add(u.repeatability_degrees_of_freedom) };
        all.platform = all.add(u.common_platform_degrees_of_freedom);
        all.base = all.add(u.common_base_degrees_of_freedom);
        all.noise = all.add(repeats.noise_degrees_of_freedom);
        if repeats.visit_degrees_of_freedom.is_finite() {
            // A variance of a visit that is not the stated one is estimated from the scatter, whatever was stated of its
            // parts.
            all.returns = all.add(repeats.visit_degrees_of_freedom);
            all.noise = all.returns;
            all.visits = all.returns;
        }
        all.turn_ons = all.add(repeats.turn_on.degrees_of_freedom);
        for pair in [[0, 3], [1, 2]].into_iter().filter(|pair| repeats.scale[pair[0]] > 0.0) {
            let basis = all.add(repeats.scale_degrees_of_freedom());
            pair.into_iter().for_each(|element| all.scale[element] = basis);
        }
        all
    }

    fn add(&mut self, degrees_of_freedom: f64) -> Basis {
        if degrees_of_freedom == f64::INFINITY {
            return Basis::Known;
        }
        self.degrees_of_freedom.push(degrees_of_freedom);
        Basis::Estimate(self.degrees_of_freedom.len() - 1)
    }

    /// Returns the index of the estimate of the scatter of visits, if they were repeated and it is in use.
    pub(crate) fn of_visits(&self) -> Option<usize> {
        if let Basis::Estimate(place) = self.visits { Some(place) } else { None }
    }

    /// Returns the degrees of freedom of a basis; for the mean of three variances, those of all three together.
    pub(crate) fn degrees_of_freedom(&self, basis: Basis) -> f64 {
        match basis {
            Basis::Known => f64::INFINITY,
            Basis::Estimate(place) => self.degrees_of_freedom[place],
            Basis::Axes => self.degrees_of_freedom.iter().take(3).sum(),
        }
    }
}

impl Basis {
    /// Returns the indices of the estimates on which a variance rests, with their shares.
    pub(crate) fn shares(self) -> impl Iterator<Item = (usize, f64)> {
        let (range, share) = match self {
            Self::Known => (0..0, 0.0),
            Self::Estimate(place) => (place..place + 1, 1.0),
            Self::Axes => (0..3, 1.0 / 3.0),
        };
        range.map(move |place| (place, share))
    }
}

fn degrees_of_freedom_of(u: &InputUncertainty, place: usize) -> f64 {
    u.angles_degrees_of_freedom.get(place).copied().unwrap_or(f64::INFINITY)
}
