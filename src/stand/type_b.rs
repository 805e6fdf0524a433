//! Contributions to uncertainty that repeated measurements do not show ([GUM](crate::bibliography::Bibliography::Gum),
//! 4.3), and the readings from which a certificate was computed.

use super::{Certificate, CertifiedPosition};
use crate::coefficients::PositionIndex;
use crate::text::{Path, Problems, record, word_of_a_key, words};

words! {
    /// Part of the stand that a contribution of type B rotates.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[cfg_attr(feature = "generate", derive(schemars::JsonSchema), schemars(rename_all = "snake_case"))]
    #[non_exhaustive]
    pub enum ActsOn: pub(crate) word {
        /// Each position by itself, per axis of the platform; part of u_alpha_arcsec, u_beta_arcsec and u_gamma_arcsec.
        Position = "position",
        /// All positions together, per axis of the platform; part of common_platform_arcsec.
        Platform = "platform",
        /// All positions together, per axis of the base; part of common_base_arcsec.
        Base = "base",
    }
}

word_of_a_key!(ActsOn, word, "");

record! {
    /// Contribution to the uncertainty that repeated measurements do not show (type B), such as the calibration of an
    /// instrument.
    pub struct TypeB {
        /// Source of the contribution.
        pub source: String,
        /// Uncertainty that includes the contribution: `u_*`, `common_platform_arcsec` or `common_base_arcsec`.
        pub acts_on: ActsOn,
        /// Standard uncertainty per axis.
        pub u_arcsec: f64,
        /// Degrees of freedom; infinite if absent.
        pub degrees_of_freedom: Option<f64>,
    }
}

record! {
    /// Reading or run that was excluded from the certificate.
    pub struct Excluded {
        /// Frame index; absent for a whole run.
        pub i: Option<u32>,
        /// Platform index; absent for a whole run.
        pub j: Option<u32>,
        /// Number of the run.
        pub run: u32,
        /// Reason for the exclusion.
        pub why: String,
    }
}

impl Excluded {
    /// Returns the position of the excluded reading, or `None` for a whole run.
    pub(crate) fn index(&self) -> Option<PositionIndex> {
        Some(PositionIndex { i: self.i?, j: self.j? })
    }

    pub(crate) fn describe(&self) -> String {
        match self.index() {
            Some(index) => format!("position {index} in run {}", self.run),
            None => format!("run {}", self.run),
        }
    }

    fn check(&self, at: &Path, problems: &mut Problems) {
        if self.i.is_some() != self.j.is_some() {
            problems.at(at, "one of i and j", "both, or neither for a whole run", "");
        }
        for (key, number) in [("i", self.i), ("j", self.j), ("run", Some(self.run))] {
            if number == Some(0) {
                problems.at(&at.key(key), "0", "a whole number of 1 or more", "");
            }
        }
        if self.why.is_empty() {
            problems.at(&at.key("why"), "an empty text", "the reason for the exclusion", "");
        }
    }
}

record! {
    /// Readings from which the certificate was computed.
    pub struct Evidence {
        /// SHA-256 of the file of readings.
        pub readings_sha256: String,
        /// Number of runs.
        pub runs: u32,
        /// Excluded readings and runs.
        pub excluded: Option<Vec<Excluded>>,
    }
}

impl Certificate {
    /// Returns the contributions of type B with `acts_on` equal to `on`, in the order of the file.
    pub(crate) fn type_b_on(&self, on: ActsOn) -> impl Iterator<Item = &TypeB> {
        self.type_b.iter().flatten().filter(move |line| line.acts_on == on)
    }

    /// Returns the sum of squares of the contributions of type B with `acts_on` equal to `on`, arcsec².
    pub(crate) fn type_b_arcsec2(&self, on: ActsOn) -> f64 {
        // An empty sum of floats is -0.0.
        self.type_b_on(on).map(|line| line.u_arcsec * line.u_arcsec).sum::<f64>() + 0.0
    }
}

/// Relative difference by which an uncertainty may be smaller than its part of type B, because certificates state four
/// digits.
pub(super) const ROUNDING: f64 = 5e-4;

/// Checks the contributions themselves, and that the certified uncertainties include them.
pub(super) fn check(certificate: &Certificate, positions: &[CertifiedPosition], problems: &mut Problems) {
    let at = Path::Root.key("certificate");
    let of_type_b = at.key("type_b");
    super::check_not_empty(certificate.type_b.as_ref(), &of_type_b, "at least one contribution", problems);
    for (index, line) in certificate.type_b.iter().flatten().enumerate() {
        let at = of_type_b.item(index);
        problems.within(&at.key("u_arcsec"), Some(line.u_arcsec), 0.0, f64::MAX);
        super::check_degrees_of_freedom(line.degrees_of_freedom, &at.key("degrees_of_freedom"), problems);
    }
    if let Some(evidence) = &certificate.evidence {
        let at = at.key("evidence");
        problems.sha256(&at.key("readings_sha256"), &evidence.readings_sha256);
        if evidence.runs < 2 {
            let advice = "certify from two or more runs";
            problems.at(&at.key("runs"), format!("{}", evidence.runs), "2 or more", advice);
        }
        let excluded = at.key("excluded");
        super::check_not_empty(evidence.excluded.as_ref(), &excluded, "at least one exclusion", problems);
        for (index, line) in evidence.excluded.iter().flatten().enumerate() {
            line.check(&excluded.item(index), problems);
        }
    }
    let mut contains = |at: &Path, key: &'static str, u: Option<f64>, on: ActsOn| {
        let root = certificate.type_b_arcsec2(on).sqrt();
        if let Some(u) = u.filter(|u| (0.0..root * (1.0 - ROUNDING)).contains(u)) {
            let expected = format!("at least {root:.4}, the root sum of squares of its type_b lines");
            let advice = format!("include the {} lines of type_b in it, or correct them", on.word());
            problems.at(&at.key(key), format!("{u}"), expected, advice);
        }
    };
    contains(&at, "common_platform_arcsec", certificate.common_platform_arcsec, ActsOn::Platform);
    contains(&at, "common_base_arcsec", certificate.common_base_arcsec, ActsOn::Base);
    let of_positions = Path::Root.key("positions");
    for (index, position) in positions.iter().enumerate() {
        let at = of_positions.item(index);
        for (key, u) in ["u_alpha_arcsec", "u_beta_arcsec", "u_gamma_arcsec"].into_iter().zip(position.u_arcsec()) {
            contains(&at, key, u, ActsOn::Position);
        }
    }
}
