//! The gyro: its parameters, the currents that follow from them, and type files (`dtg-gyro/1`).
//!
//! Source: [the paper](crate::bibliography::Bibliography::Tang17), eq. (2), (5) and its table.

use crate::coefficients::PositionCoefficients;
use crate::earth::STANDARD_GRAVITY_M_PER_S2;
use crate::text::{Document, Path, Problems, record, word_of_a_key, words};
use crate::wording::Words;
use crate::wording::number::Number;
use crate::wording::texts::implausible;
use nalgebra::{Matrix2, Vector2};

/// Parameters of a dynamically tuned gyro in rate mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GyroParameters {
    /// Scale factors K, °/(h·mA), 2×2: [[K_x, K_xy], [K_yx, K_y]].
    pub k_deg_per_h_per_ma: Matrix2<f64>,
    /// Constant drift ω_0 about x and y, °/h, which does not depend on g.
    pub omega0_deg_per_h: Vector2<f64>,
    /// g-sensitive drift ω_g, °/(h·g), caused by the position of the rotor's centre of mass along the spin axis.
    pub omega_g_deg_per_h_per_g: f64,
    /// g-sensitive drift ω_k, °/(h·g), caused by quadrature torques.
    pub omega_k_deg_per_h_per_g: f64,
}

impl GyroParameters {
    /// Returns ω_n = [[ω_g, −ω_k], [ω_k, ω_g]], °/(h·g), 2×2 (paper, eq. (5)).
    pub(crate) fn omega_n_deg_per_h_per_g(&self) -> Matrix2<f64> {
        let (w_g, w_k) = (self.omega_g_deg_per_h_per_g, self.omega_k_deg_per_h_per_g);
        Matrix2::new(w_g, -w_k, w_k, w_g)
    }

    /// Returns the torquer currents (J_x, J_y) in one position, mA, by solving K J + ω_0 + ω_n n = ω_3 for J (paper,
    /// eq. (5)).
    ///
    /// Returns `None` if K has no inverse.
    pub fn currents_ma(&self, position: &PositionCoefficients) -> Option<Vector2<f64>> {
        let torqued = position.earth_rate_deg_per_h
            - self.omega0_deg_per_h
            - self.omega_n_deg_per_h_per_g() * position.specific_force_g;
        Some(self.k_deg_per_h_per_ma.try_inverse()? * torqued)
    }
}

record! {
    /// Parameters of a gyro.
    pub struct Parameters {
        /// Scale factors [[K_x, K_xy], [K_yx, K_y]].
        pub k_deg_per_h_per_ma: [[f64; 2]; 2],
        /// Constant drift ω_0: [x, y].
        pub omega0_deg_per_h: [f64; 2],
        /// g-sensitive drift ω_g; of a gyro type per g of its `gravity_m_per_s2`, otherwise local g.
        pub omega_g_deg_per_h_per_g: f64,
        /// g-sensitive drift ω_k, as ω_g.
        pub omega_k_deg_per_h_per_g: f64,
    }
}

impl Parameters {
    /// Converts vectors and matrices to lists of numbers.
    pub(crate) fn of(model: &GyroParameters) -> Self {
        let k = &model.k_deg_per_h_per_ma;
        Self {
            k_deg_per_h_per_ma: [[k.m11, k.m12], [k.m21, k.m22]],
            omega0_deg_per_h: model.omega0_deg_per_h.into(),
            omega_g_deg_per_h_per_g: model.omega_g_deg_per_h_per_g,
            omega_k_deg_per_h_per_g: model.omega_k_deg_per_h_per_g,
        }
    }

    /// Converts the parameters to vectors and matrices.
    pub fn to_model(&self) -> GyroParameters {
        let ([[kx, kxy], [kyx, ky]], [x, y]) = (self.k_deg_per_h_per_ma, self.omega0_deg_per_h);
        let (w_g, w_k) = (self.omega_g_deg_per_h_per_g, self.omega_k_deg_per_h_per_g);
        GyroParameters::from_vector(&[kx, kxy, kyx, ky, x, y, w_g, w_k])
    }
}

/// Tolerance of K_x and K_y above which it is usually in another unit, percent.
const LARGEST_MAIN_PERCENT: f64 = 20.0;

/// Tolerance of K_xy and K_yx above which it is usually in another unit, percent.
const LARGEST_CROSS_PERCENT: f64 = 100.0;

record! {
    /// Tolerances of the parameters: largest permitted deviations from the nominal values.
    #[cfg_attr(feature = "generate", schemars(extend("oneOf" = [
        {"required": ["k_cross_percent"]}, {"required": ["k_cross_deg_per_h_per_ma"]}
    ])))]
    pub struct Tolerance {
        /// Tolerance of K_x and K_y, percent of nominal.
        pub k_main_percent: f64,
        /// Tolerance of K_xy and K_yx, percent of nominal.
        pub k_cross_percent: Option<f64>,
        /// Tolerance of K_xy and K_yx for nominal values near 0, instead of that in percent.
        pub k_cross_deg_per_h_per_ma: Option<f64>,
        /// Tolerance of ω_0x and ω_0y.
        pub omega0_deg_per_h: f64,
        /// Tolerance of ω_g.
        pub omega_g_deg_per_h_per_g: f64,
        /// Tolerance of ω_k.
        pub omega_k_deg_per_h_per_g: f64,
    }
}

record! {
    /// Noise of the gyro's own drift, each axis.
    pub struct GyroNoise {
        /// Standard deviation between visits to a position; estimated if absent.
        pub visit_deg_per_h: Option<f64>,
        /// Standard deviation of ω_0 between turn-ons; estimated if absent.
        pub turn_on_deg_per_h: Option<f64>,
    }
}

words! {
    /// Rule by which conformity is decided ([JCGM 106](crate::bibliography::Bibliography::Jcgm106), 8.2 and 8.3).
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[cfg_attr(feature = "generate", derive(schemars::JsonSchema), schemars(rename_all = "snake_case"))]
    #[non_exhaustive]
    pub enum Rule: pub(crate) word {
        /// Pass if the deviation is inside the tolerance by the guard band, fail if it is outside by it.
        Guarded = "guarded",
        /// Pass if the deviation is within the tolerance, otherwise fail.
        Simple = "simple",
    }
}

word_of_a_key!(Rule, word, "");

record! {
    /// Decision rule that was agreed with the customer.
    pub struct DecisionRule {
        /// "guarded": pass if |deviation| + band ≤ tolerance, fail if |deviation| − band > tolerance, otherwise
        /// undecided. "simple": without a band.
        pub rule: Rule,
        /// Guard band as a fraction of U (95.45 %), at most 1; 1 if absent. Not with "simple".
        pub guard_band_of_u: Option<f64>,
    }
}

impl DecisionRule {
    /// Returns the guard band as a fraction of U; 0 by simple acceptance.
    pub(crate) fn guard_band(&self) -> f64 {
        if self.rule == Rule::Simple { 0.0 } else { self.guard_band_of_u.unwrap_or(1.0) }
    }
}

record! {
    /// Gyro type: nominal parameters and their tolerances (`dtg-gyro/1`).
    pub struct GyroType {
        /// Name of the type.
        pub r#type: String,
        /// Nominal parameters.
        pub nominal: Parameters,
        /// Tolerances of the parameters.
        pub tolerance: Tolerance,
        /// Decision rule; guarded, with a band of U, if absent.
        pub decision: Option<DecisionRule>,
        /// Value of g to which the drifts refer; 9.80665 if absent.
        pub gravity_m_per_s2: Option<f64>,
        /// Noise of the gyro's own drift.
        pub noise: Option<GyroNoise>,
    }
}

impl Document for GyroType {
    const FORMAT: &'static str = "dtg-gyro/1";
}

impl GyroType {
    /// Reads a `dtg-gyro/1` file; `name` is the file name in messages.
    ///
    /// # Errors
    /// Returns [`crate::text::Unreadable`] with the line, column and field of every error.
    #[cfg(feature = "yaml")]
    pub fn from_yaml(name: &str, bytes: &[u8]) -> Result<Self, crate::text::Unreadable> {
        crate::text::yaml::read_document(name, bytes, |gyro: &Self, problems| gyro.check(&Path::Root, problems))
    }

    pub(crate) fn check(&self, at: &Path, problems: &mut Problems) {
        if self.nominal.to_model().k_deg_per_h_per_ma.try_inverse().is_none() {
            let nominal = at.key("nominal");
            let at = nominal.key("k_deg_per_h_per_ma");
            problems.at(&at, "a matrix without an inverse", "scale factors of two axes", "");
        }
        let tolerance = &self.tolerance;
        for (key, value) in [
            ("k_main_percent", Some(tolerance.k_main_percent)),
            ("k_cross_percent", tolerance.k_cross_percent),
            ("k_cross_deg_per_h_per_ma", tolerance.k_cross_deg_per_h_per_ma),
            ("omega0_deg_per_h", Some(tolerance.omega0_deg_per_h)),
            ("omega_g_deg_per_h_per_g", Some(tolerance.omega_g_deg_per_h_per_g)),
            ("omega_k_deg_per_h_per_g", Some(tolerance.omega_k_deg_per_h_per_g)),
        ] {
            problems.within(&at.key("tolerance").key(key), value, 0.0, f64::MAX);
        }
        if tolerance.k_cross_percent.is_some() == tolerance.k_cross_deg_per_h_per_ma.is_some() {
            let found = if tolerance.k_cross_percent.is_some() { "two tolerances" } else { "no tolerance" };
            let advice = "state k_cross_percent, or k_cross_deg_per_h_per_ma if a nominal value is 0 or near 0";
            problems.at(&at.key("tolerance"), format!("{found} of K_xy and K_yx"), "one", advice);
        }
        if let Some(DecisionRule { rule, guard_band_of_u: Some(band) }) = self.decision {
            let decision = at.key("decision");
            let at = decision.key("guard_band_of_u");
            if rule == Rule::Simple {
                problems.at(&at, format!("{band}"), "no guard band, because the rule is simple", "remove the key");
            } else if !(band > 0.0 && band <= 1.0) {
                problems.at(&at, format!("{band}"), "a number above 0, at most 1", "");
            }
        }
        problems.within(&at.key("gravity_m_per_s2"), self.gravity_m_per_s2, 9.7, 9.9);
        if let Some(noise) = &self.noise {
            let at = at.key("noise");
            problems.within(&at.key("visit_deg_per_h"), noise.visit_deg_per_h, 0.0, f64::MAX);
            problems.within(&at.key("turn_on_deg_per_h"), noise.turn_on_deg_per_h, 0.0, f64::MAX);
        }
    }

    /// Returns the tolerances that no gyro fails, a sentence each without a full stop: they are possible, but usually
    /// stated in another unit, such as parts per million instead of percent.
    pub(crate) fn remarks(&self) -> Vec<Words> {
        let Tolerance { k_main_percent, k_cross_percent, .. } = self.tolerance;
        let each = [
            ("tolerance.k_main_percent", k_main_percent, LARGEST_MAIN_PERCENT),
            ("tolerance.k_cross_percent", k_cross_percent.unwrap_or_default(), LARGEST_CROSS_PERCENT),
        ];
        let words = each
            .into_iter()
            .filter(|(_, value, largest)| value > largest)
            .map(|(key, value, _)| implausible::of_type(key, Number::exact(value)));
        words.collect()
    }

    /// Returns the value of g to which the drifts of the type refer, m/s².
    pub(crate) fn gravity(&self) -> f64 {
        self.gravity_m_per_s2.unwrap_or(STANDARD_GRAVITY_M_PER_S2)
    }

    /// Returns the decision rule with its guard band, if it has one.
    pub(crate) fn decision_rule(&self) -> DecisionRule {
        let rule = self.decision.as_ref().map_or(Rule::Guarded, |decision| decision.rule);
        let stated = self.decision.as_ref().and_then(|decision| decision.guard_band_of_u);
        DecisionRule { rule, guard_band_of_u: (rule == Rule::Guarded).then(|| stated.unwrap_or(1.0)) }
    }

    /// Creates the type of the paper's gyro, GVK-6, with its nominal values and tolerances (paper, table).
    pub fn gvk_6() -> Self {
        Self {
            r#type: "GVK-6".to_owned(),
            nominal: Parameters {
                k_deg_per_h_per_ma: [[95.0, 9.5], [9.5, 95.0]],
                omega0_deg_per_h: [20.0, 20.0],
                omega_g_deg_per_h_per_g: 10.0,
                omega_k_deg_per_h_per_g: 10.0,
            },
            tolerance: Tolerance {
                k_main_percent: 0.05,
                k_cross_percent: Some(0.5),
                k_cross_deg_per_h_per_ma: None,
                omega0_deg_per_h: 0.01,
                omega_g_deg_per_h_per_g: 0.01,
                omega_k_deg_per_h_per_g: 0.01,
            },
            decision: None,
            gravity_m_per_s2: None,
            noise: None,
        }
    }
}
