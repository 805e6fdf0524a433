//! What became of an order, and what the factory should know before it hands the passport over.

use crate::calibration::prediction::NoiseGrowth;
use crate::folder::Issued;
use crate::passport::issue::{NOISE_WARNING, Remarks};
use serde::Serialize;
use std::fmt::Write;

/// From this growth of K's uncertainty towards the poles on, the factory is warned.
const POLAR_WARNING: f64 = 3.0;

/// What became of one order.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// The passport's id; of a re-issue that was refused, the old passport's file.
    pub id: String,
    /// "issued", "unchanged" or "refused".
    pub state: &'static str,
    /// The passport's file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// SHA-256 of the file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sha256: Option<String>,
    /// How much noisier a calibration is on this stand than on a perfect one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise_growth: Option<Noise>,
    /// What is not known, and what that costs.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub absences: Vec<String>,
    /// Why it was refused.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

/// Ratios of standard uncertainties, this stand's to a perfect one's.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Noise {
    k: f64,
    omega_0: f64,
    omega_g: f64,
    omega_k: f64,
}

impl From<NoiseGrowth> for Noise {
    fn from(growth: NoiseGrowth) -> Self {
        Self { k: growth.k, omega_0: growth.omega0, omega_g: growth.omega_g, omega_k: growth.omega_k }
    }
}

impl Report {
    /// A passport that is there now, new or as before.
    pub fn of(issued: &Issued) -> Self {
        Self {
            id: issued.id.clone(),
            state: if issued.new { "issued" } else { "unchanged" },
            file: Some(issued.path.display().to_string()),
            sha256: Some(issued.sha256.clone()),
            noise_growth: issued.remarks.noise.map(Noise::from),
            absences: issued.remarks.absences.clone(),
            reason: None,
        }
    }

    /// An order that was refused.
    pub fn refused(id: String, reason: String) -> Self {
        let absences = Vec::new();
        Self { id, state: "refused", file: None, sha256: None, noise_growth: None, absences, reason: Some(reason) }
    }
}

/// Warnings for the factory, and what the passport cannot state.
pub fn warnings(remarks: &Remarks) -> Vec<String> {
    let mut words = Vec::new();
    match &remarks.noise {
        None => words.push(
            "WARNING: from these positions at this site least squares cannot determine all parameters of a gyro"
                .to_owned(),
        ),
        Some(growth) if growth.worst() > NOISE_WARNING => words.push(format!(
            "WARNING: a calibration on this stand is up to {:.2} times as noisy as on a perfect one",
            growth.worst()
        )),
        Some(_) => {}
    }
    if remarks.uncertainty_growth > POLAR_WARNING {
        words.push(format!(
            "WARNING: so near the pole the uncertainty of K is {:.1} times that at the equator",
            remarks.uncertainty_growth
        ));
    }
    words.extend(remarks.absences.iter().cloned());
    words
}

/// A line for each order, with the noise under it.
pub fn text(reports: &[Report]) -> String {
    let mut text = String::new();
    for report in reports {
        let file = report.file.as_deref().unwrap_or("nothing was written");
        let _ = writeln!(text, "{:<9}  {}  {file}", report.state, report.id);
        if let Some(sha256) = &report.sha256 {
            let _ = writeln!(text, "           sha256 {sha256}");
        }
        if let Some(Noise { k, omega_0, omega_g, omega_k }) = report.noise_growth {
            let _ = writeln!(
                text,
                "           noise, against a perfect stand: K {k:.2}, omega_0 {omega_0:.2}, omega_g {omega_g:.2}, \
                 omega_k {omega_k:.2}"
            );
        }
    }
    text
}
