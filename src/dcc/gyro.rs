//! DCC of a gyro: parameters, their standard uncertainties, and the decisions of its type.

use super::facts::{Facts, Known, stated};
use super::parts::{self, PAPER, Subject, in_words, quantity, real, units};
use super::xml::Element;
use super::{Administrative, Dcc};
use crate::calibration::document::Subject as GyroSubject;
use crate::calibration::readings::Exclusion;
use crate::calibration::stated::TemperatureOutside;
use crate::calibration::{Decision, Found, Method, Model, Parameter, ParameterVerdict, Verdict};
use crate::gyro::GyroType;
use crate::interface::calibrated::Done;
use crate::laboratory::Laboratory;
use crate::passport::Content;
use crate::report::Languages;
use crate::report::calibration::{band_of_u, not_stated, temperature_outside};
use crate::text::Problems;
use crate::wording::Text;
use crate::wording::texts::{calibration as texts, dcc as words};

/// Identifier of the decision rule, to which every decision refers.
const RULE_ID: &str = "decision_rule";

/// Identifiers of the quantities with the parameters, in the order of [`Parameter::EIGHT`].
const PARAMETERS: &str = "k omega_0 omega_g_k";

/// Calibration of a gyro with a verified passport, fit for a certificate.
pub(crate) struct Calibrated<'a> {
    content: &'a Content,
    passport_sha256: &'a str,
    laboratory: Option<&'a Laboratory>,
    done: &'a Done,
    /// Gyro, day and conditions of the calibration.
    subject: &'a GyroSubject,
    method: Method,
    /// Adopted result, drifts per local g.
    found: Found,
    /// Type of the gyro, and the decisions for it.
    judged: Option<(&'a GyroType, &'a Verdict)>,
}

impl<'a> Calibrated<'a> {
    /// Takes a calibration with the passport `content`, of which `passport_sha256` is the SHA-256, for a certificate.
    /// The laboratory is `None` if no file states it.
    ///
    /// # Errors
    /// Returns the reason if the result is not that of the gyro, or has other parameters than a certificate states.
    pub(crate) fn new(
        content: &'a Content,
        passport_sha256: &'a str,
        laboratory: Option<&'a Laboratory>,
        gyro_type: Option<&'a GyroType>,
        done: &'a Done,
    ) -> Result<Self, &'static str> {
        let document = &done.document;
        if !document.is_valid() {
            return Err("no DCC was written, because the result is not that of this gyro; omit --dcc to see why");
        }
        let answer = done
            .calibration
            .adopted()
            .filter(|answer| answer.model == Model::Paper && answer.document.drift_deg_per_h_per_h.is_none());
        let (Some(answer), Some(found), Some(subject)) = (answer, document.found(), &document.subject) else {
            return Err("no DCC was written: it states the parameters of the paper's model; omit --model, or --dcc");
        };
        let judged = gyro_type.zip(document.verdict.as_ref());
        Ok(Self { content, passport_sha256, laboratory, done, subject, method: answer.method, found, judged })
    }
}

pub(crate) fn of_gyro(
    calibrated: &Calibrated,
    administrative: Option<&Administrative>,
    lang: Option<&Languages>,
) -> Result<Dcc, Problems> {
    let known = Known {
        source: "the calibration",
        serial: Some(calibrated.subject.gyro_serial.as_deref()),
        performed: calibrated.subject.date,
        laboratory: calibrated.laboratory.and_then(|laboratory| laboratory.name.as_deref()),
        temperature_c: calibrated.subject.temperature_c.or(calibrated.laboratory.and_then(|file| file.temperature_c)),
        method_is_known: true,
        options: &[("from", "--date"), ("to", "--date"), ("temperature_c", "--temperature-c")],
        ..Known::default()
    };
    let facts = Facts::collect(&known, administrative, lang)?;
    let subject = Subject {
        identification: None,
        previous_report: None,
        item: item(calibrated),
        accreditation: None,
        statements: statements(calibrated),
        result: result(calibrated, &facts),
        document: None,
    };
    Ok(parts::certificate(&facts, subject))
}

fn item(calibrated: &Calibrated) -> Element {
    let serial = stated(calibrated.subject.gyro_serial.as_deref()).map(parts::serial);
    let model = calibrated.judged.and_then(|(gyro_type, _)| stated(Some(gyro_type.r#type.as_str())));
    Element::named("dcc:item", words::GYRO)
        .and(model.map(|model| Element::text("dcc:model", model)))
        .and(Element::new("dcc:identifications").and(serial))
}

fn statements(calibrated: &Calibrated) -> Vec<Element> {
    let conformity = calibrated.judged.map(|(gyro_type, verdict)| {
        Element::named("dcc:statement", words::conformity(&gyro_type.r#type))
            .with("id", RULE_ID)
            .with("refType", "basic_conformity")
            .and(match verdict.rule.guard_band_of_u {
                None => in_words("dcc:declaration", words::RULE_SIMPLE),
                Some(band) => in_words("dcc:declaration", words::rule_guarded(band_of_u(band))),
            })
            .and(Element::text("dcc:conformity", decided(verdict.overall, verdict.parameters.iter().all(passes))))
    });
    let currents = parts::statement(texts::CURRENTS_SHA256, None)
        .and(Element::text("dcc:reference", &calibrated.subject.currents_sha256));
    let excluded = calibrated.done.document.excluded.iter().map(|Exclusion { i, j, visit, cycle, why }| {
        let visit = format!("{i}, {j}, {visit}, {}: {why}", cycle.unwrap_or(1));
        parts::statement(texts::EXCLUDED, Some(&visit))
    });
    let suspects = calibrated.done.calibration.suspects().map(|suspect| parts::said(words::SUSPECT, suspect.said()));
    let dependent = calibrated.judged.map_or_else(Vec::new, |(_, verdict)| verdict.dependent());
    let dependent = (!dependent.is_empty()).then(|| {
        let names = dependent.iter().map(|one| one.symbol()).collect::<Vec<_>>().join(", ");
        parts::said(words::CONFORMITY_OPEN, texts::dependent(names))
    });
    let missing = calibrated.done.missing.iter().map(|what| parts::said(words::NOT_STATED, not_stated(*what)));
    let certificate = &calibrated.content.certificate;
    let outside = TemperatureOutside::of(certificate, calibrated.subject, calibrated.laboratory);
    let outside = outside.map(|outside| parts::said(texts::TEMPERATURE_IS_OUTSIDE, temperature_outside(&outside)));
    let of_readings = conformity.into_iter().chain([currents]).chain(excluded).chain(suspects);
    of_readings.chain(dependent).chain(outside).chain(missing).collect()
}

fn passes(row: &ParameterVerdict) -> bool {
    row.simple == Decision::Pass
}

/// Returns the decision by the rule. Where it is not determined, the one by simple acceptance is conditional
/// (ILAC-G8:09/2019, 4.2.3).
fn decided(decision: Decision, simple_passes: bool) -> &'static str {
    match decision {
        Decision::Pass => "pass",
        Decision::Fail => "fail",
        Decision::Undecided if simple_passes => "conditionalPass",
        Decision::Undecided => "conditionalFail",
    }
}

fn result(calibrated: &Calibrated, facts: &Facts) -> Element {
    let own = parts::method(
        in_words("dcc:name", texts::method!(Method, calibrated.method)),
        in_words("dcc:description", words::MODEL),
        Some(PAPER),
    );
    let own = own.with("refId", PARAMETERS);
    let results = parts::results(texts::PARAMETERS, words::PARAMETERS_NOTE, quantities(calibrated));
    let gravity_u_m_per_s2 = calibrated.content.site.gravity_u_m_per_s2();
    let gravity = real(calibrated.found.gravity_m_per_s2, units::M_PER_S2, gravity_u_m_per_s2);
    let conditions = parts::temperature(facts).into_iter().chain([parts::condition(words::GRAVITY, gravity)]);
    Element::named("dcc:measurementResult", texts::TITLE)
        .and(in_words("dcc:description", words::NOT_SIGNED))
        .and(Element::new("dcc:usedMethods").and(own).and(parts::stated_method(facts)))
        .and(parts::software("dcc:usedSoftware"))
        .and(Element::new("dcc:measuringEquipments").and(equipment(calibrated)))
        .and(Element::new("dcc:influenceConditions").and(conditions))
        .and(results)
}

/// Returns the stand, with its passport by identifier and SHA-256.
fn equipment(calibrated: &Calibrated) -> Element {
    let Content { stand, passport, .. } = calibrated.content;
    Element::named("dcc:measuringEquipment", words::STAND)
        .and(parts::hashed("dcc:certificate", words::PASSPORT, &passport.id, calibrated.passport_sha256))
        .and(parts::manufacturer(stand.manufacturer.as_deref()))
        .and(Element::text("dcc:model", &stand.model))
        .and(Element::new("dcc:identifications").and(parts::serial(stand.serial.as_str())))
}

/// Returns K, ω_0 and the g-sensitive drifts, each with its decisions. The drifts are per m/s², because there is no unit
/// of the local g.
fn quantities(calibrated: &Calibrated) -> Vec<Element> {
    use Parameter::{Kx, Kxy, Ky, Kyx, Omega0x, Omega0y, OmegaG, OmegaK};
    let per_m_per_s2 = calibrated.found.at_gravity(1.0);
    let labels = |parameters: &[Parameter]| parameters.iter().map(|one| one.key()).collect::<Vec<_>>().join(" ");
    let (values, u) = (per_m_per_s2.parameters.to_vector(), per_m_per_s2.standard_uncertainty);
    let group = |id: &str, kind: &str, name: Text, parameters: &[Parameter], unit: &str| {
        let each: Vec<f64> = parameters.iter().map(|one| values[one.place()]).collect();
        let uncertainties: Vec<_> = parameters.iter().map(|one| Some(u[one.place()])).collect();
        let list = parts::reals(Some(&labels(parameters)), &each, unit, &uncertainties);
        let decisions = calibrated.judged.map(|(_, verdict)| decisions(verdict, parameters, unit));
        quantity(&format!("basic_measuredValue {kind}"), name, list).and(decisions).with("id", id)
    };
    // Unlimited degrees of freedom are not stated.
    let freedom = Parameter::EIGHT.map(|one| (one, per_m_per_s2.degrees_of_freedom[one.place()]));
    let (known, each): (Vec<_>, Vec<_>) = freedom.into_iter().filter(|(_, freedom)| freedom.is_finite()).unzip();
    let freedom = (!known.is_empty()).then(|| {
        let list = parts::reals(Some(&labels(&known)), &each, units::ONE, &[]);
        quantity("dtg_degreesOfFreedom", texts::EFFECTIVE_FREEDOM, list)
    });
    let mut quantities = vec![
        group("k", "dtg_scaleFactors", words::SCALE_FACTORS, &[Kx, Kxy, Kyx, Ky], units::DEG_PER_H_PER_MA),
        group("omega_0", "dtg_constantDrift", words::CONSTANT_DRIFT, &[Omega0x, Omega0y], units::DEG_PER_H),
        group("omega_g_k", "dtg_gSensitiveDrift", words::G_DRIFT, &[OmegaG, OmegaK], units::DEG_PER_H_PER_M_PER_S2),
    ];
    quantities.extend(freedom);
    quantities.extend(correlation(calibrated, &u));
    quantities
}

/// Returns the correlation coefficients of the parameters, whose standard uncertainties are `u`, row by row; with these they
/// are the covariance. The uncertainty of the local g is common to both drifts per m/s².
fn correlation(calibrated: &Calibrated, u: &[f64; 8]) -> Option<Element> {
    let Found { parameters, gravity_m_per_s2: g, gravity_u_m_per_s2: u_g, .. } = calibrated.found;
    let values = parameters.to_vector();
    let per_g = |place: usize| [Parameter::OmegaG, Parameter::OmegaK].iter().any(|one| one.place() == place);
    let of_g = |place: usize| if per_g(place) { values[place] * u_g / g } else { 0.0 };
    let unit = |place: usize| if per_g(place) { g.recip() } else { 1.0 };
    let rows = &calibrated.done.document.covariance;
    let coefficient = |row: usize, column: usize| {
        let covariance = rows.get(row)?[column]? + of_g(row) * of_g(column);
        Some(covariance * unit(row) * unit(column) / (u[row] * u[column]))
    };
    let each: Option<Vec<f64>> = (0..64).map(|at| coefficient(at / 8, at % 8)).collect();
    let list = parts::reals(None, &each?, units::ONE, &[]);
    Some(quantity("dtg_correlation", words::CORRELATION, list).with("refId", PARAMETERS))
}

/// Returns the decisions on parameters, the limits of their tolerances and the risks, in their order and unit. The risk
/// where nothing is decided is not a number.
fn decisions(verdict: &Verdict, parameters: &[Parameter], unit: &str) -> Element {
    let rows = parameters.iter().filter_map(|one| verdict.parameter(*one));
    let rows: Vec<_> = rows.collect();
    let each: Vec<&str> = rows.iter().map(|row| decided(row.decision, passes(row))).collect();
    let limit = |kind, name, sign: f64| {
        let values: Vec<f64> = rows.iter().map(|row| limit_of(row, sign, verdict.gravity_m_per_s2)).collect();
        quantity(kind, name, parts::reals(None, &values, unit, &[]))
    };
    let risks: Vec<f64> = rows.iter().map(|row| row.specific_risk.unwrap_or(f64::NAN)).collect();
    let further = [
        limit("basic_toleranceLimitLower", words::LOWER_LIMIT, -1.0),
        limit("basic_toleranceLimitUpper", words::UPPER_LIMIT, 1.0),
        quantity("dtg_specificRisk", words::SPECIFIC_RISK, parts::reals(None, &risks, units::ONE, &[])),
    ];
    let decision = Element::named("dcc:metaData", words::DECISIONS)
        .with("refId", RULE_ID)
        .with("refType", "basic_conformity")
        .and(Element::text("dcc:conformityXMLList", each.join(" ")))
        .and(Element::new("dcc:data").and(further));
    Element::new("dcc:measurementMetaData").and(decision)
}

/// Returns a limit of the tolerance in the unit of the DCC: scale factors have tolerances in percent, and drifts per g
/// are converted with the g of the type.
fn limit_of(row: &ParameterVerdict, sign: f64, gravity_m_per_s2: f64) -> f64 {
    let tolerance = match row.unit {
        "%" => row.reference_value.abs() * row.tolerance / 100.0,
        _ => row.tolerance,
    };
    let per_g = matches!(row.parameter, Parameter::OmegaG | Parameter::OmegaK);
    (row.reference_value + sign * tolerance) / if per_g { gravity_m_per_s2 } else { 1.0 }
}
