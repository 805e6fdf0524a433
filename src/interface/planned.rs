//! The best positions to certify or to read.

use super::issued::stated;
use super::{Asked, Failed, json};
use crate::passport::Stated;
use crate::plan::candidates::Angles;
use crate::plan::criterion::Criterion;
use crate::plan::{FEWEST_READINGS, MOST_READINGS, Question};
use crate::site::Site;
use crate::stand::Stand;
use crate::text::Field;

/// Finds the best positions to certify, or with a stand which of its positions to read, as the program's `plan` does.
/// Returns the JSON of `plan`.
///
/// The files are names and contents. `question` is JSON, in which every key may be absent: `readings` (8), `step_deg`
/// of the nominal angles to choose from without a stand (quadrants), `frame_axis_azimuths_deg` to choose from (that of
/// the site), and `criterion`: `a`, `d` or `worst`. The gyro type and the laboratory are the paper's by default.
///
/// # Errors
/// Returns [`Failed`] if an input cannot be used, or if no choice determines the parameters.
pub fn plan(
    (site, bytes): (&str, &[u8]),
    stand: Option<(&str, &[u8])>,
    gyro: Option<(&str, &[u8])>,
    laboratory: Option<(&str, &[u8])>,
    question: &str,
) -> Result<String, Failed> {
    let site = Site::from_yaml(site, bytes)?;
    let stand = stand.map(|(name, bytes)| Stand::from_yaml(name, bytes)).transpose()?;
    let Stated { gyro, laboratory } = stated([gyro, laboratory])?;
    let mut asked = Asked::new("question", question)?;
    let (readings, step_deg) = (asked.key("readings", u32::read).unwrap_or(8), asked.key("step_deg", f64::read));
    let azimuths_deg: Vec<f64> = asked.key("frame_axis_azimuths_deg", Vec::read).unwrap_or_default();
    let criterion = asked.key("criterion", Criterion::read).unwrap_or(Criterion::A);
    asked.done()?;
    let unusable = |why: String| Err(Failed::unusable(why));
    if !(FEWEST_READINGS..=MOST_READINGS).contains(&readings) {
        return unusable(format!("readings: found {readings}, expected {FEWEST_READINGS} to {MOST_READINGS}"));
    }
    if step_deg.is_some() && stand.is_some() {
        let why = "step_deg: found a step and a stand, whose positions are certified; state one of the two";
        return unusable(why.to_owned());
    }
    let angles = match step_deg {
        None => Angles::QUADRANTS,
        Some(step_deg) => Angles::every(step_deg)
            .ok_or_else(|| Failed::unusable(format!("step_deg: found {step_deg}, expected {}", Angles::EXPECTED)))?,
    };
    if let Some(found) = azimuths_deg.iter().find(|azimuth| !(0.0..360.0).contains(*azimuth)) {
        return unusable(format!("frame_axis_azimuths_deg: found {found}, expected 0 or more and below 360"));
    }
    let (stand, site, gyro, laboratory) = (stand.as_ref(), &site, &gyro, &laboratory);
    let question = Question { site, stand, angles, gyro, laboratory, readings, azimuths_deg, criterion };
    let found = crate::plan::plan(&question).map_err(Failed::refused)?;
    Ok(json(&found))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SITE: (&str, &[u8]) = ("site.yaml", include_bytes!("../../sites/moscow-bmstu.yaml"));

    #[test]
    fn a_step_and_a_stand_contradict_each_other() {
        let stand = ("stand.yaml", include_bytes!("../../passports/SPS-2/0017/stand.yaml").as_slice());
        let failed = plan(SITE, Some(stand), None, None, r#"{"step_deg": 45}"#).unwrap_err();
        assert!(failed.code == "unusable" && failed.message.contains("a step and a stand"), "{failed}");
    }
}
