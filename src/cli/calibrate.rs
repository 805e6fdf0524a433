//! Verb `calibrate`: the gyro's parameters from a passport and currents.

use super::administrative::AdministrativeFile;
use super::output::Format;
use super::render::{Written, languages};
use super::show::{PassportOptions, Read};
use super::simulate::{MethodName, read_gyro};
use super::{Code, Failure, REFUSED, output, uncertainty};
use crate::calibration::document::{CalibrationDocument, Subject};
use crate::calibration::iterative::StopRule;
use crate::calibration::readings::Exclusion;
use crate::calibration::verdict::Decision;
use crate::calibration::{Method, Model, Options as CalibrationOptions, Readings};
use crate::coefficients::PositionIndex;
use crate::dcc::{self, Calibrated};
use crate::document::sha256_hex;
use crate::files;
use crate::interface::calibrated::Prepared;
use crate::laboratory::Laboratory;
use crate::passport::{Content, Question, Trust, Verification};
use crate::report::calibration as report;
use crate::report::page::{CalibrationPage, PassportPage, UsedPassport};
use crate::text::{LARGEST_DOCUMENT_BYTES, name_of, shown};
use crate::uncertainty::document::WholeDocument;
use clap::{Args, ValueEnum};
use jiff::Timestamp;
use std::path::{Path, PathBuf};

/// Calibrate a gyro: parameters, their uncertainty, the fit, and the decision for its type
#[derive(Args)]
pub(super) struct Options {
    #[command(flatten)]
    passport: PassportOptions,
    /// Currents: CSV with the header i,j,jx_ma,jy_ma and optionally cycle, visit, time_s; without visit, successive
    /// rows of a position belong to one visit
    #[arg(value_name = "CURRENTS.csv")]
    currents: PathBuf,
    /// Calibration methods; least squares gives the adopted result
    #[arg(long, value_enum, value_delimiter = ',', default_value = "analytic,iterative,least-squares")]
    method: Vec<MethodName>,
    /// Gyro type (dtg-gyro/1) for the decision on conformity
    #[arg(long, value_name = "FILE")]
    gyro: Option<PathBuf>,
    /// Laboratory (dtg-laboratory/1) [default: the paper's meter, 0.015 %]
    #[arg(long, value_name = "FILE")]
    laboratory: Option<PathBuf>,
    /// Previous result of this gyro (from --format json), to report the change
    #[arg(long, value_name = "RESULT.json")]
    previous: Option<PathBuf>,
    /// Stop limit of the iteration for the main scale factors, percent
    #[arg(long, value_name = "P", default_value_t = 0.1, value_parser = limit, allow_hyphen_values = true)]
    delta1_percent: f64,
    /// Stop limit of the iteration for ω_g and ω_k, deg/(h·g)
    #[arg(long, value_name = "D", default_value_t = 0.001, value_parser = limit, allow_hyphen_values = true)]
    delta2_deg_per_h: f64,
    /// Visit to leave out, as i,j,visit or i,j,visit,cycle; visits count within a cycle and position. May be repeated
    #[arg(long, value_name = "I,J,VISIT[,CYCLE]", value_parser = excluded, requires = "why")]
    exclude: Vec<(PositionIndex, u32, Option<u32>)>,
    /// Reason for leaving a visit out; one for each --exclude, in the same order, or one for all
    #[arg(long, value_name = "TEXT", requires = "exclude")]
    why: Vec<String>,
    /// Serial number of the gyro; --previous then refuses the result of another one
    #[arg(long, value_name = "SERIAL")]
    gyro_serial: Option<String>,
    /// Who took the readings
    #[arg(long, value_name = "NAME")]
    operator: Option<String>,
    /// Day of the readings
    #[arg(long, value_name = "YYYY-MM-DD")]
    date: Option<jiff::civil::Date>,
    /// Temperature during the readings, °C
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    temperature_c: Option<f64>,
    /// Model of the g-sensitive drift: the paper's, or the full 2×3 matrix, with a test whether it is needed
    #[arg(long, value_enum, default_value = "paper")]
    model: ModelName,
    /// Fit one linear drift of ω_0 in time; needs the column time_s
    #[arg(long)]
    drift: bool,
    /// Also fit the anisoelastic coefficient by least squares; the eight positions alone do not determine it
    #[arg(long, conflicts_with = "model")]
    anisoelasticity: bool,
    #[command(flatten)]
    uncertainty: uncertainty::UncertaintyOptions,
    /// Report to write, for paper, screen and phone, with fields for handwritten signatures
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
    /// Digital Calibration Certificate of the gyro to write; needs --gyro-serial, --administrative and a verified passport
    #[arg(long, value_name = "FILE.xml", conflicts_with_all = ["no_verify", "anisoelasticity", "drift"])]
    dcc: Option<PathBuf>,
    /// Administrative data of --dcc (dtg-dcc/1); `new dcc` writes a template
    #[arg(long, value_name = "FILE", requires = "dcc")]
    administrative: Option<PathBuf>,
    /// Languages of --report and --dcc; the first sets the number format: en, ru, or en,ru for both side by side
    #[arg(long, value_enum, value_delimiter = ',', default_value = "en", value_name = "LANGUAGE")]
    lang: Vec<Written>,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

/// Parses a visit to leave out.
fn excluded(text: &str) -> Result<(PositionIndex, u32, Option<u32>), String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[i, j, visit]) => Ok((PositionIndex { i, j }, visit, None)),
        Some(&[i, j, visit, cycle]) => Ok((PositionIndex { i, j }, visit, Some(cycle))),
        _ => Err("three or four whole numbers: i,j,visit or i,j,visit,cycle".to_owned()),
    }
}

#[derive(Clone, Copy, ValueEnum)]
enum ModelName {
    Paper,
    General,
}

/// Parses a stop limit: the largest change in the last step of the iteration.
fn limit(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value| (0.0..f64::INFINITY).contains(value));
    value.ok_or_else(|| "a number ≥ 0, with a decimal point".to_owned())
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let Read { content, bytes: passport, verification } = options.passport.read()?;
    let laboratory = read_laboratory(options.laboratory.as_deref())?;
    let gyro_type = read_gyro(options.gyro.as_deref())?;
    let previous = previous(options)?;
    let bytes = files::read(&options.currents, LARGEST_DOCUMENT_BYTES).map_err(Failure::file)?;
    let name = name_of(&options.currents);
    let prepared = Prepared::new(&content, &laboratory, gyro_type.as_ref(), (&name, &bytes));
    let mut prepared = prepared.map_err(Failure::stopped)?;
    exclude(options, &mut prepared.readings)?;
    if let Some(remark) = prepared.readings.remark() {
        output::say(remark);
    }
    let administrative = AdministrativeFile::read(options.administrative.as_deref())?;
    let asked = options.asked();
    let done = prepared.run(&asked, verification.is_some(), options.subject(), previous.as_ref());
    let done = done.map_err(Failure::stopped)?;
    if let Some(warning) = &done.warning {
        output::complain(&format!("WARNING: {warning}"));
    }
    let tolerance = gyro_type.as_ref().map(|gyro_type| &gyro_type.tolerance);
    let uncertainty = options.uncertainty.find(&done.setup, &done.readings, &done.calibration, (&asked, tolerance))?;
    if let Some(path) = &options.dcc {
        let laboratory = options.laboratory.is_some().then_some(&laboratory);
        let calibrated = Calibrated::new(&content, &sha256_hex(&passport), laboratory, gyro_type.as_ref(), &done);
        write_dcc(options, path, &calibrated.map_err(Failure::refused)?, &administrative)?;
    }
    if let Some(path) = &options.report {
        let page = CalibrationPage {
            passport: used(&content, &passport, verification.as_ref())?,
            time: verification.as_ref().map_or_else(Timestamp::now, |(_, _, question)| question.time),
            currents: (&name, sha256_hex(&bytes)),
            gyro: gyro_type.as_ref(),
            laboratory: options.laboratory.is_some().then_some(&laboratory),
            calibration: &done.calibration,
            missing: &done.missing,
            document: &done.document,
            budget: uncertainty.budget(),
            monte_carlo: uncertainty.monte_carlo(),
        };
        output::file(path, &page.html(&languages(&options.lang)), options.uncertainty.force)?;
        output::say(&format!("wrote {}", shown(path)));
    }
    match options.format {
        Format::Json => {
            let (budget, monte_carlo) = uncertainty.documents();
            output::json(&WholeDocument { calibration: &done.document, budget, monte_carlo })?;
        }
        Format::Text => {
            let (document, name) = (&done.document, gyro_type.as_ref().map(|gyro_type| gyro_type.r#type.as_str()));
            let context = report::Context {
                passport_id: &content.passport.id,
                passport_verified: verification.is_some(),
                gravity_m_per_s2: (document.gravity_m_per_s2, document.gravity_u_m_per_s2),
                missing: &done.missing,
                mistake: document.mistake.as_ref(),
                verdict: name.zip(document.verdict.as_ref()),
                change: done.earlier.as_ref().map(|earlier| (earlier, document.change.as_ref())),
                readings: Some((&done.readings, done.cost_of_missing)),
                further: done.further,
            };
            output::text(&(report::text(&done.calibration, &context) + &uncertainty.text()))?;
        }
    }
    let failed = done.document.verdict.is_some_and(|verdict| verdict.overall == Decision::Fail);
    Ok(if failed { REFUSED } else { 0 })
}

impl Options {
    /// Returns how the library shall calibrate.
    fn asked(&self) -> CalibrationOptions {
        CalibrationOptions {
            methods: self.method.iter().copied().map(Method::from).collect(),
            stop_rule: StopRule { delta1_percent: self.delta1_percent, delta2_deg_per_h: self.delta2_deg_per_h },
            model: match self.model {
                _ if self.anisoelasticity => Model::Anisoelastic,
                ModelName::Paper => Model::Paper,
                ModelName::General => Model::General,
            },
            drift: self.drift,
        }
    }

    /// Returns what was calibrated, and under which conditions.
    fn subject(&self) -> Subject {
        Subject {
            gyro_serial: self.gyro_serial.clone(),
            operator: self.operator.clone(),
            date: self.date,
            temperature_c: self.temperature_c,
            currents_sha256: String::new(),
        }
    }
}

/// Writes the gyro's certificate.
fn write_dcc(
    options: &Options,
    path: &Path,
    calibrated: &Calibrated,
    administrative: &AdministrativeFile,
) -> Result<(), Failure> {
    let dcc = dcc::of_gyro(calibrated, administrative.content(), Some(&languages(&options.lang)));
    let dcc = dcc.map_err(|problems| {
        let refused = administrative.refuse(problems);
        Failure { code: REFUSED, ..Failure::unreadable(refused) }
    })?;
    output::file(path, &dcc.xml, options.uncertainty.force)?;
    output::say(&format!("wrote {}", shown(path)));
    output::say("the DCC is not signed; the passport of the stand is, and its SHA-256 is in the DCC");
    Ok(())
}

/// Returns the passport in the form that the report takes.
fn used<'a>(
    content: &'a Content,
    bytes: &'a [u8],
    verification: Option<&'a (Verification, Trust, Question)>,
) -> Result<UsedPassport<'a>, Failure> {
    let Some((verification, trust, question)) = verification else {
        return Ok(UsedPassport::NotVerified { content, sha256: sha256_hex(bytes) });
    };
    match PassportPage::of(bytes, trust, question, verification.clone()) {
        Ok(page) => Ok(UsedPassport::Verified(Box::new(page))),
        // The passport has just passed every check.
        Err(_) => Err(Failure::refused("the passport cannot be used in a report")),
    }
}

/// Reads a laboratory file. Without a path it returns the paper's meter.
pub(super) fn read_laboratory(path: Option<&Path>) -> Result<Laboratory, Failure> {
    let Some(path) = path else { return Ok(Laboratory::paper()) };
    let bytes = files::read(path, LARGEST_DOCUMENT_BYTES).map_err(Failure::file)?;
    Laboratory::from_yaml(&name_of(path), &bytes).map_err(Failure::unreadable)
}

fn previous(options: &Options) -> Result<Option<CalibrationDocument>, Failure> {
    let Some(path) = &options.previous else { return Ok(None) };
    let bytes = files::read(path, LARGEST_DOCUMENT_BYTES).map_err(Failure::file)?;
    let document = CalibrationDocument::from_json(&name_of(path), &bytes).map_err(Failure::unreadable)?;
    if document.answer().is_none() {
        return Err(Failure::unusable(format!("{}: contains no result", shown(path))));
    }
    Ok(Some(document))
}

/// Leaves out the visits that `--exclude` names.
fn exclude(options: &Options, readings: &mut Readings) -> Result<(), Failure> {
    if options.why.len() > 1 && options.why.len() != options.exclude.len() {
        let (visits, reasons) = (options.exclude.len(), options.why.len());
        return Err(Failure::unusable(format!(
            "{visits} --exclude and {reasons} --why; give one --why for each, or for all"
        )));
    }
    let reasons = options.why.iter().chain(options.why.last().into_iter().cycle());
    for (&(index, visit, cycle), why) in options.exclude.iter().zip(reasons) {
        readings.exclude(Exclusion { index, visit, cycle, why: why.clone() }).map_err(Failure::unusable)?;
    }
    Ok(())
}
