//! Calibration with a passport: from currents as CSV to the JSON of `calibrate`.

use super::{Failed, json};
use crate::calibration::document::Subject;
use crate::calibration::mistake::Mistake;
use crate::calibration::stated::temperature_remark;
use crate::calibration::verdict::against_type;
use crate::calibration::{self, CalibrationDocument, Method, Options, Parameter, Readings, Setup};
use crate::document::sha256_hex;
use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::passport::Content;

/// Result of a calibration by one method.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibrated {
    /// The JSON of `calibrate`, with one element in `results`.
    pub json: String,
    /// Covariance of the parameters, 8×8, in the order and units of [`Parameter::EIGHT`].
    pub covariance: [[f64; 8]; 8],
    /// Remarks on the currents and the laboratory, a sentence each.
    pub remarks: Vec<String>,
}

/// Calibrates a gyro with the content of a passport. `verified` states whether the passport was verified.
///
/// `currents` are the name and content of a CSV file with the columns `i`, `j`, `jx_ma`, `jy_ma`; `method` is
/// `analytic`, `iterative` or `least-squares`. Without a laboratory the paper's meter is used; without a gyro type the
/// result has no verdict.
///
/// # Errors
/// Returns [`Failed`] if the method is unknown, if the currents cannot be read, or if they do not determine the
/// parameters.
pub fn calibrate(
    content: &Content,
    verified: bool,
    (name, currents): (&str, &[u8]),
    method: &str,
    laboratory: Option<&Laboratory>,
    gyro_type: Option<&GyroType>,
) -> Result<Calibrated, Failed> {
    let known = Method::ALL.iter().copied().find(|known| known.key() == method);
    let names = Method::ALL.map(Method::key).join(", ");
    let method = known.ok_or_else(|| Failed::unusable(format!("method {method:?}, expected one of {names}")))?;
    let (paper, usual) = (Laboratory::paper(), GyroType::gvk_6());
    let laboratory = laboratory.unwrap_or(&paper);
    let stated = Setup::stated(&content.certificate, &content.positions, &content.site, laboratory);
    let (setup, mut missing) = stated.map_err(Failed::refused)?;
    let setup = setup.of_gyro(gyro_type.and_then(|gyro_type| gyro_type.noise.as_ref()));
    let readings = Readings::from_csv(name, currents, setup.coefficients(), laboratory.meter.range_ma)?;
    let options = Options { methods: vec![method], ..Options::default() };
    let calibration = calibration::calibrate(&setup, &readings, &options).map_err(Failed::refused)?;
    missing.extend(calibration.noise_not_stated());
    if let Some(words) = calibration.meaningless() {
        return Err(Failed::refused(words));
    }
    let Some(result) = calibration.answer() else {
        let words = calibration.refused.iter().map(|(method, why)| format!("{}: {why}", method.key()));
        return Err(Failed::refused(words.collect::<Vec<_>>().join("\n")));
    };
    let gravity = (content.earth.gravity_m_per_s2, content.site.gravity_u_m_per_s2());
    let mut document = CalibrationDocument::new(&content.passport.id, verified, gravity, &calibration, &missing);
    let currents_sha256 = sha256_hex(currents);
    let subject = Subject { currents_sha256, ..Subject::default() };
    document.record(subject, &readings);
    let found = result.found(gravity.0, gravity.1.unwrap_or(0.0));
    let rate = content.earth.rate(&content.site);
    document.mistake = Mistake::explaining(&calibration, &found, &rate, gyro_type, &usual.nominal.to_model());
    document.verdict = gyro_type.map(|gyro_type| against_type(&found, gyro_type));
    let place = |index: usize| Parameter::EIGHT[index].place();
    let covariance = |row, column| result.covariance.get((place(row), place(column))).copied().unwrap_or(f64::NAN);
    let covariance = std::array::from_fn(|row| std::array::from_fn(|column| covariance(row, column)));
    let remarks = readings.remark().map(str::to_owned).into_iter();
    let remarks = remarks.chain(temperature_remark(&content.certificate, laboratory)).collect();
    Ok(Calibrated { json: json(&document), covariance, remarks })
}

/// Returns rows of i, j, J_x, J_y (mA) as the CSV that [`calibrate`] reads, each number to its last bit.
pub fn currents_csv(rows: &[[f64; 4]]) -> Vec<u8> {
    let mut csv = "i,j,jx_ma,jy_ma\n".to_owned();
    for [i, j, jx_ma, jy_ma] in rows {
        csv += &format!("{i},{j},{jx_ma},{jy_ma}\n");
    }
    csv.into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::passport::content_from_anyone;

    const PASSPORT: &[u8] = include_bytes!("../../passports/SPS-2/0017/moscow-bmstu-1.yaml");

    /// Expected: the parameters stated in the self-check, and the limit of 1e-9 of each.
    #[test]
    fn the_currents_of_the_self_check_give_its_gyro_by_every_method() {
        let content = content_from_anyone("p", PASSPORT).unwrap();
        let check = content.self_check.clone().unwrap();
        let rows: Vec<_> =
            check.currents.iter().map(|at| [f64::from(at.i), f64::from(at.j), at.jx_ma, at.jy_ma]).collect();
        for method in ["analytic", "least-squares"] {
            let found = calibrate(&content, true, ("c", &currents_csv(&rows)), method, None, None).unwrap();
            let document = CalibrationDocument::from_json("r", found.json.as_bytes()).unwrap();
            let result = document.answer().unwrap();
            let errors = check.errors(&result.parameters);
            assert!(errors.iter().all(|error| *error <= 1e-9), "{method}: {errors:?}");
            for (place, u) in result.standard_uncertainty.iter().enumerate() {
                assert!((found.covariance[place][place].sqrt() - u).abs() <= 1e-15 * u);
            }
        }
    }

    #[test]
    fn what_is_no_current_is_refused_with_its_line() {
        let content = content_from_anyone("p", PASSPORT).unwrap();
        let rows = [[1.0, 1.0, 0.1, 0.1], [1.5, 2.0, 0.1, 0.1], [1.0, 3.0, f64::NAN, f64::INFINITY]];
        let failed = calibrate(&content, true, ("c", &currents_csv(&rows)), "analytic", None, None).unwrap_err();
        for place in ["c:3:1", "c:4:5", "c:4:9"] {
            assert!(failed.message.contains(place), "{failed}");
        }
        let failed = calibrate(&content, true, ("c", b""), "exact", None, None).unwrap_err();
        assert!(failed.message.contains("expected one of analytic, iterative, least-squares"), "{failed}");
    }
}
