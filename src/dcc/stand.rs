//! DCC of a stand's calibration certificate, from its verified passport.

use super::facts::{Facts, Known, stated};
use super::parts::{self, Subject, in_words, plain, quantity, real, reals, units};
use super::xml::Element;
use super::{Administrative, Dcc};
use crate::document::sha256_hex;
use crate::passport::Content;
use crate::report::Languages;
use crate::stand::{CertifiedPosition, Datum};
use crate::text::Problems;
use crate::wording::texts::{calibration as texts, dcc as words};
use crate::wording::{Text, Words};
use base64ct::{Base64, Encoding};

/// Identifiers of the quantities that say which position it is, and of those that were measured.
const INDICES: &str = "i j";
const MEASURED: &str = "alpha beta gamma";

/// Returns the DCC of the certificate in a verified passport; `bytes` is the signed file, which the DCC contains.
pub(crate) fn of_stand(
    content: &Content,
    bytes: &[u8],
    administrative: Option<&Administrative>,
    lang: Option<&Languages>,
) -> Result<Dcc, Problems> {
    let known = known(content);
    let facts = Facts::collect(&known, administrative, lang)?;
    let id = &content.passport.id;
    let predecessor = content.passport.reissued_from.as_ref();
    let sha256 = sha256_hex(bytes);
    let file_name = format!("{}-{}.yaml", content.site.id, content.passport.revision);
    let document = Element::named("dcc:document", words::PASSPORT)
        .and(in_words("dcc:description", words::passport_note(id, sha256)))
        .and(Element::text("dcc:fileName", file_name))
        .and(Element::text("dcc:mimeType", "application/yaml"))
        .and(Element::text("dcc:dataBase64", Base64::encode_string(bytes)));
    let subject = Subject {
        identification: Some(parts::identification(id, words::PASSPORT_ID)),
        previous_report: predecessor
            .map(|from| parts::hashed("dcc:previousReport", words::PREDECESSOR, &from.id, &from.sha256)),
        item: item(content),
        accreditation: content.certificate.accreditation.as_deref(),
        statements: statements(content, &facts),
        result: result(content, &facts),
        document: Some(document),
    };
    Ok(parts::certificate(&facts, subject))
}

fn known(content: &Content) -> Known<'_> {
    let certificate = &content.certificate;
    Known {
        source: "the passport",
        number: Some(&certificate.number),
        received: certificate.received,
        performed: certificate.performed,
        issued: Some(certificate.issued),
        laboratory: Some(&certificate.laboratory),
        address: certificate.address.as_deref(),
        authorized_by: certificate.authorized_by.as_deref(),
        customer: content.stand.customer.as_deref(),
        method: certificate.method.as_deref(),
        traceability: certificate.traceability.as_deref(),
        temperature_c: certificate.temperature_c,
        ..Known::default()
    }
}

fn item(content: &Content) -> Element {
    let stand = &content.stand;
    let name = stated(stand.name.as_deref()).unwrap_or(stand.model.as_str());
    let configuration =
        stated(stand.configuration.as_deref()).map(|text| parts::identification(text, words::CONFIGURATION));
    let serial = parts::serial(stand.serial.as_str());
    let identifications = Element::new("dcc:identifications").and(serial).and(configuration);
    Element::new("dcc:item")
        .and(plain("dcc:name", name))
        .and(parts::manufacturer(stand.manufacturer.as_deref()))
        .and(Element::text("dcc:model", &stand.model))
        .and(identifications)
}

fn statements(content: &Content, facts: &Facts) -> Vec<Element> {
    let certificate = &content.certificate;
    let traceability = stated(certificate.traceability.as_deref()).map(|text| {
        Element::named("dcc:statement", words::TRACEABILITY)
            .with("refType", "basic_metrologicallyTraceable")
            .and(facts.file.traceable.map(|traceable| Element::text("dcc:traceable", traceable)))
            .and(plain("dcc:declaration", text))
    });
    let valid_until = certificate.valid_until.map(|day| {
        parts::statement(words::VALID_UNTIL, certificate.valid_until_basis.as_deref())
            .and(Element::text("dcc:date", day))
    });
    let range = certificate.temperature_range_c.map(|[low, high]| {
        let limit = |kind, name, value| quantity(kind, name, real(value, units::CELSIUS, None));
        let data = [limit("math_minimum", words::LOWEST, low), limit("math_maximum", words::HIGHEST, high)];
        parts::statement(words::TEMPERATURE_RANGE, None).and(Element::new("dcc:data").and(data))
    });
    let surfaces = content.datum.iter().flat_map(|Datum { level, azimuth, gyro_seat }| {
        [(words::LEVEL, level), (words::AZIMUTH, azimuth), (words::SEAT, gyro_seat)]
    });
    let surfaces = surfaces
        .filter_map(|(name, surface)| stated(surface.as_deref()).map(|surface| parts::statement(name, Some(surface))));
    let shared = [
        ("dtg_repeatability", words::REPEATABILITY, certificate.repeatability_arcsec),
        ("dtg_commonPlatform", words::COMMON_PLATFORM, certificate.common_platform_arcsec),
        ("dtg_commonBase", words::COMMON_BASE, certificate.common_base_arcsec),
        ("dtg_cmc", words::CMC, certificate.cmc_arcsec),
    ];
    let shared = shared.into_iter().filter_map(|(kind, name, value)| {
        let value = quantity(kind, name, real(value?, units::ARCSECOND, None));
        Some(parts::statement(name, None).and(Element::new("dcc:data").and(value)))
    });
    traceability.into_iter().chain(valid_until).chain(range).chain(surfaces).chain(shared).collect()
}

fn result(content: &Content, facts: &Facts) -> Element {
    let quantities = quantities(&content.positions);
    let references = content.certificate.references.iter().flatten().map(|reference| {
        let number = parts::identification(&reference.number, words::REFERENCE);
        let issued = words::reference_issued(Words::Given(reference.laboratory.clone()), reference.issued);
        let certificate = parts::hashed("dcc:certificate", words::REFERENCE, &reference.number, &reference.sha256)
            .and(in_words("dcc:description", issued));
        Element::named("dcc:measuringEquipment", words::INSTRUMENT)
            .and(certificate)
            .and(Element::new("dcc:identifications").and(number))
    });
    let references: Vec<Element> = references.collect();
    let equipment = (!references.is_empty()).then(|| Element::new("dcc:measuringEquipments").and(references));
    Element::named("dcc:measurementResult", words::STAND_RESULT)
        .and(Element::new("dcc:usedMethods").and(parts::stated_method(facts).map(|of| of.with("refId", MEASURED))))
        .and(parts::software("dcc:usedSoftware"))
        .and(equipment)
        .and(Element::new("dcc:influenceConditions").and(parts::temperature(facts)))
        .and(parts::results(words::POSITIONS, words::POSITIONS_NOTE, quantities))
}

/// Returns one quantity for each column of the positions, its values in the order of the passport. All columns refer to
/// those of the indices, and the method to those that it measured.
fn quantities(positions: &[CertifiedPosition]) -> Vec<Element> {
    let list = |value: fn(&CertifiedPosition) -> f64, unit: &str| {
        let values: Vec<f64> = positions.iter().map(value).collect();
        reals(None, &values, unit, &[])
    };
    let index = |id: &str, name: Text, value: fn(&CertifiedPosition) -> f64| {
        quantity(&format!("dtg_{id}"), name, list(value, units::ONE)).with("id", id)
    };
    let nominal = |kind: &str, name: Text, value: fn(&CertifiedPosition) -> f64| {
        quantity(&format!("basic_nominalValue {kind}"), name, list(value, units::DEGREE)).with("refId", INDICES)
    };
    let measured = |id: &str, name: Text, value: fn(&CertifiedPosition) -> (f64, Option<f64>)| {
        let (values, u): (Vec<f64>, Vec<Option<f64>>) = positions.iter().map(value).unzip();
        let list = reals(None, &values, units::ARCSECOND, &u);
        quantity(&format!("basic_measuredValue dtg_{id}"), name, list).with("id", id).with("refId", INDICES)
    };
    let freedom = positions.iter().any(|at| at.degrees_of_freedom.is_some()).then(|| {
        let list = list(|at| at.degrees_of_freedom.unwrap_or(f64::NAN), units::ONE);
        quantity("dtg_degreesOfFreedom", texts::FREEDOM, list).with("refId", INDICES)
    });
    let mut quantities = vec![
        index("i", words::INDEX_I, |at| f64::from(at.i)),
        index("j", words::INDEX_J, |at| f64::from(at.j)),
        nominal("dtg_theta", words::THETA, |at| at.theta_deg),
        nominal("dtg_phi", words::PHI, |at| at.phi_deg),
        measured("alpha", words::ALPHA, |at| (at.alpha_arcsec, at.u_alpha_arcsec)),
        measured("beta", words::BETA, |at| (at.beta_arcsec, at.u_beta_arcsec)),
        measured("gamma", words::GAMMA, |at| (at.gamma_arcsec, at.u_gamma_arcsec)),
    ];
    quantities.extend(freedom);
    quantities
}
