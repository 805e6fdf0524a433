//! Verb `calibrate`: the gyro's parameters from a passport and currents, or those of several gyros.

use super::inputs::{self, AdministrativeFile, Answer, Lines, Named};
use super::options::{self, Force, Instruments, Printed, Report, folder};
use super::output::{language, languages};
use super::show::{Read, Whom};
use super::trust_options::{Enquiry, date};
use super::{Code, Failure, code, defaults, open_workspace, output, uncertainty};
use crate::batch::once::Once;
use crate::batch::{Purpose, paths};
use crate::calibration::document::{Subject, another_type};
use crate::calibration::iterative::StopRule;
use crate::calibration::readings::Exclusion;
use crate::calibration::stated::TemperatureOutside;
use crate::calibration::{CalibrationDocument, Method, Model, Options as CalibrationOptions, Readings};
use crate::coefficients::PositionIndex;
use crate::dcc::{self, Calibrated};
use crate::document::sha256_hex;
use crate::files;
use crate::gyro::GyroType;
use crate::interface::calibrated::{Done, Prepared, WholeDocument};
use crate::interface::{self, Failed};
use crate::laboratory::{Laboratory, TEMPERATURES_C};
use crate::passport::{Check, Verification};
use crate::report::calibration as report;
use crate::report::gyros::{self, Gyros};
use crate::report::{CalibrationPage, PassportPage, UsedPassport};
use crate::report::{issued, style};
use crate::text::{Kind, Printable, name_of, printable, shown};
use crate::uncertainty::MonteCarlo;
use crate::wording::plain;
use crate::workspace::{NoPassport, Results, serial_of};
use clap::Args;
use clap::builder::NonEmptyStringValueParser;
use jiff::Timestamp;
use jiff::civil::Date;
use std::cell::Cell;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Calibrate a gyro: parameters, their uncertainty, the fit, and the decision on conformity with the gyro type
///
/// For several gyros on one stand, give several files, a quoted pattern, or a folder, whose *.csv files are read; with -
/// the paths are read from standard input. Each gyro gives one line of output, and with --format json one line of JSON.
///
/// In the workspace of a laboratory that states its stand, PASSPORT may be left out: the one in force is used. The name of a
/// file of currents is then the serial number of its gyro, the last result of this gyro is compared, and the new result and
/// its report are written into the folder of results.
#[derive(Args)]
#[command(mut_arg("gyro", |gyro| gyro.help("Gyro type (dtg-gyro/1) for the decision on conformity")))]
pub(super) struct Options {
    /// Passport file, in a workspace also its identifier; then the currents of a gyro: CSV with the header i,j,jx_ma,jy_ma
    /// and optionally cycle, visit, time_s; without visit, successive rows of a position belong to one visit
    // One list, because clap cannot tell which of two positional arguments is absent; the brackets make two of it in the usage.
    #[arg(required = true, value_name = "PASSPORT> <CURRENTS.csv")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    whom: Whom,
    /// Folder for the results of several gyros: <name of the currents>.json, as --format json writes it, and .html, the
    /// report
    #[arg(
        short,
        long,
        visible_alias = "output",
        value_name = "DIR",
        value_parser = folder("; for one report use --report FILE.html, for one result --format json"),
        conflicts_with_all = ["report", "dcc"]
    )]
    out: Option<PathBuf>,
    /// Calibration methods; least squares gives the adopted result
    #[arg(long, value_enum, value_delimiter = ',', default_value = "analytic,iterative,least-squares")]
    method: Vec<Method>,
    #[command(flatten)]
    instruments: Instruments,
    /// Previous result of this gyro (from --format json or --out), to report the change. May be repeated: the latest
    /// one is compared, and --report shows all
    #[arg(long, value_name = "RESULT.json")]
    previous: Vec<PathBuf>,
    /// Stop limit of the iteration for the main scale factors, percent
    #[arg(long, value_name = "P", default_value_t = 0.1, value_parser = inputs::number("a number", 0.0..=f64::INFINITY), allow_hyphen_values = true)]
    delta1_percent: f64,
    /// Stop limit of the iteration for ω_g and ω_k, °/(h·g)
    #[arg(long, value_name = "D", default_value_t = 0.001, value_parser = inputs::number("a number", 0.0..=f64::INFINITY), allow_hyphen_values = true)]
    delta2_deg_per_h: f64,
    /// Visit to leave out, as i,j,visit or i,j,visit,cycle; visits count within a turn-on and position. May be repeated
    #[arg(long, value_name = "I,J,VISIT[,CYCLE]", value_parser = excluded, requires = "why")]
    exclude: Vec<(PositionIndex, u32, Option<u32>)>,
    /// Reason for leaving a visit out; one for each --exclude, in the same order, or one for all
    #[arg(long, value_name = "TEXT", requires = "exclude")]
    why: Vec<String>,
    /// Serial number of the gyro; --previous then refuses the result of another one
    #[arg(long, value_name = "SERIAL", value_parser = NonEmptyStringValueParser::new())]
    gyro_serial: Option<String>,
    /// Person who took the readings
    #[arg(long, value_name = "NAME")]
    operator: Option<String>,
    /// Day of the readings
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = date)]
    date: Option<Date>,
    /// Temperature during the readings, °C
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = inputs::number("degrees Celsius", TEMPERATURES_C[0]..=TEMPERATURES_C[1]))]
    temperature_c: Option<f64>,
    /// Model of the g-sensitive drift: the paper's, or the full 2×3 matrix, with a test of whether it is needed
    #[arg(long, value_parser = ["paper", "general"], default_value = "paper")]
    model: String,
    /// Fit one linear drift of ω_0 in time; needs the column time_s
    #[arg(long)]
    drift: bool,
    /// Also fit the anisoelastic coefficient by least squares; the eight positions alone do not determine it
    #[arg(long, conflicts_with = "model")]
    anisoelasticity: bool,
    #[command(flatten)]
    uncertainty: uncertainty::UncertaintyOptions,
    #[command(flatten)]
    force: Force,
    #[command(flatten)]
    report: Report,
    /// Write a Digital Calibration Certificate of the gyro; needs --gyro-serial, --administrative and a verified passport
    #[arg(long, help_heading = "Report and certificate", value_name = "FILE.xml", conflicts_with_all = ["no_verify", "anisoelasticity", "drift"])]
    dcc: Option<PathBuf>,
    /// Administrative data of --dcc (dtg-dcc/1); `new dcc` writes a template
    #[arg(long, help_heading = "Report and certificate", value_name = "FILE", requires = "dcc")]
    administrative: Option<PathBuf>,
    /// Print all that the report has: risks, residuals, the paper's methods and what the residuals do not show
    #[arg(long)]
    details: bool,
    #[command(flatten)]
    _printed: Printed,
}

/// Parses a visit to leave out.
fn excluded(text: &str) -> Result<(PositionIndex, u32, Option<u32>), String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[i, j, visit]) => Ok((PositionIndex { i, j }, visit, None)),
        Some(&[i, j, visit, cycle]) => Ok((PositionIndex { i, j }, visit, Some(cycle))),
        _ => Err("expected three or four whole numbers: i,j,visit or i,j,visit,cycle".to_owned()),
    }
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let (passport, currents) = options.inputs()?;
    let one = paths::one_file(currents).filter(|_| options.out.is_none());
    if one.is_none() {
        options.check_for_several()?;
    }
    let mut enquiry = options.whom.load()?;
    let (passport, results) = match passport {
        Some(passport) => (passport, None),
        None => in_force(enquiry.as_mut())?,
    };
    let bench = Bench {
        options,
        passport: Read::of(&passport, enquiry.as_ref())?,
        enquiry,
        laboratory: options.instruments.laboratory()?,
        gyro_type: options.instruments.gyro()?,
        previous: previous(options)?,
        results: results.filter(|_| options.out.is_none()),
        lacks_pdf: Cell::new(false),
        administrative: AdministrativeFile::read(options.administrative.as_deref())?,
    };
    bench.check(&bench.subject(), &bench.previous)?;
    match one {
        Some(path) => bench.one(path),
        None => bench.several(currents),
    }
}

/// Returns the passport that is in force in the workspace of a laboratory, and its folder of results.
fn in_force(enquiry: Option<&mut Enquiry>) -> Result<(PathBuf, Option<PathBuf>), Failure> {
    let missing = "missing PASSPORT; give it, or use the workspace of a laboratory that states `stand`";
    let workspace = open_workspace::workspace().ok_or_else(|| Failure::usage(missing))?;
    let enquiry = enquiry.ok_or_else(|| Failure::usage("--no-verify needs PASSPORT"))?;
    let stand = workspace.stand_in_use(enquiry.question.serial.as_deref()).map_err(no_passport)?;
    let serial = stand.rsplit('/').next().unwrap_or(stand);
    enquiry.question.serial = Some(serial.to_owned());
    let path = workspace.passport_in_force(stand, enquiry).map_err(no_passport)?;
    Ok((path, workspace.results.clone()))
}

fn no_passport(error: NoPassport) -> Failure {
    match error {
        NoPassport::File(error) => error.into(),
        NoPassport::Unreadable(error) => error.into(),
        error @ (NoPassport::Register(_) | NoPassport::None(_) | NoPassport::Unusable(..)) => Failure::refused(error),
        error => Failure::usage(error),
    }
}

/// Everything but the currents.
struct Bench<'a> {
    options: &'a Options,
    /// `None` if the passport is not verified.
    enquiry: Option<Enquiry>,
    passport: Read,
    laboratory: Laboratory,
    gyro_type: Option<GyroType>,
    previous: Vec<CalibrationDocument>,
    /// Folder of the results of a laboratory, with which each new one is compared.
    results: Option<PathBuf>,
    /// `true` once no browser has printed a report.
    lacks_pdf: Cell<bool>,
    administrative: AdministrativeFile,
}

struct Found {
    /// Name of the file of currents, and the SHA-256 of its content.
    currents: (String, String),
    done: Done,
    previous: Vec<CalibrationDocument>,
    /// Path of the result in the folder of results, without its extension.
    place: Option<PathBuf>,
    uncertainty: uncertainty::Found,
}

impl Found {
    fn whole(&self) -> WholeDocument<'_, MonteCarlo> {
        self.uncertainty.with(&self.done.document)
    }

    fn code(&self) -> Code {
        code(false, self.done.is_refused())
    }
}

impl Bench<'_> {
    fn verified_as_of(&self) -> Option<Timestamp> {
        self.enquiry.as_ref().map(|enquiry| enquiry.question.time)
    }

    /// Returns the checks of the passport; none if it was not verified.
    fn checks(&self) -> &[Check] {
        self.passport.verification.as_ref().map_or(&[], Verification::checks)
    }

    /// Returns what is calibrated and under which conditions, without the digest of the currents.
    fn subject(&self) -> Subject {
        Subject {
            gyro_serial: self.options.gyro_serial.clone(),
            operator: self.options.operator.clone(),
            date: self.options.date,
            temperature_c: self.options.temperature_c,
            passport_verified_as_of: self.verified_as_of(),
            ..Subject::default()
        }
    }

    /// Refuses readings of a day that has not come, and warns of those from before the stand was measured, and of previous
    /// results of another gyro type or without a serial number.
    fn check(&self, subject: &Subject, previous: &[CalibrationDocument]) -> Result<(), Failure> {
        let early = subject.check_date(&self.passport.content.certificate).map_err(Failure::unusable)?;
        let another = another_type(previous, self.gyro_type.as_ref());
        let unknown = subject.unknown_gyro(previous);
        early.iter().chain(&another).chain(&unknown).for_each(|words| output::warn(words));
        Ok(())
    }

    /// Returns the laboratory if it is stated.
    fn laboratory(&self) -> Option<&Laboratory> {
        self.options.instruments.laboratory.is_some().then_some(&self.laboratory)
    }

    fn calibrate(&self, path: &Path) -> Result<Found, Failure> {
        let (options, content) = (self.options, &self.passport.content);
        let bytes = inputs::bytes(path, Kind::Currents.words())?;
        let name = name_of(path);
        let prepared = Prepared::new(content, self.laboratory(), self.gyro_type.as_ref(), (&name, &bytes));
        let mut prepared = prepared?;
        exclude(options, &name, &mut prepared.readings)?;
        prepared.readings.remarks.iter().for_each(|remark| output::say(remark));
        let asked = options.asked();
        let (mut subject, mut previous, mut place) = (self.subject(), self.previous.clone(), None);
        if let Some(folder) = &self.results {
            let serial = serial_of(path, options.gyro_serial.as_deref()).map_err(no_passport)?;
            let day = || self.verified_as_of().unwrap_or_else(Timestamp::now).to_zoned(jiff::tz::TimeZone::UTC).date();
            let results = Results::of(folder, &serial, options.date.unwrap_or_else(day)).map_err(no_passport)?;
            subject.gyro_serial = Some(serial);
            previous.extend(results.last);
            place = Some(results.next);
            self.check(&subject, &previous)?;
        }
        let mut done = prepared.run(&asked, subject, &previous)?;
        done.document.register = self.passport.verification.as_ref().and_then(Verification::register).cloned();
        let tolerance = self.gyro_type.as_ref().map(|gyro_type| &gyro_type.tolerance);
        let asked = (&asked, tolerance);
        let uncertainty = options.uncertainty.find(&done.setup, &done.readings, &done.calibration, asked)?;
        Ok(Found { currents: (name, sha256_hex(&bytes)), done, previous, place, uncertainty })
    }

    fn one(&self, path: &Path) -> Result<Code, Failure> {
        let options = self.options;
        // Nothing is written if one of the files cannot be.
        let files = || options.report.path.iter().chain(&options.dcc);
        files::check_distinct(files())?;
        let force = options.force.replace;
        files::check_replaceable(files(), force)?;
        let found = self.calibrate(path)?;
        let done = &found.done;
        let is_printed = options.report.path.is_some() || found.place.is_some();
        let html = if is_printed { self.page(&found)? } else { String::new() };
        let mut written = Vec::new();
        if let Some(path) = &options.dcc {
            written.push((path, self.dcc(done)?.into_bytes()));
        }
        if let Some(path) = &options.report.path {
            written.push((path, output::page(path, html.clone(), force)?));
        }
        written.iter().try_for_each(|(path, bytes)| output::saved_too(path, bytes, force))?;
        self.keep(&found, html)?.iter().for_each(|path| output::say_after(&format!("wrote {}", shown(path))));
        if options.dcc.is_some() {
            output::say_after("the DCC is not signed; the passport of the stand is, and its SHA-256 is in the DCC");
        }
        let trials = found.uncertainty.monte_carlo.as_ref();
        if output::is_json() {
            let doubts = report::doubts(done, trials);
            doubts.iter().for_each(|doubt| output::complain(&plain(&doubt.plain(language()))));
            output::value(&found.whole())?;
        } else {
            let of = report::Report::of(done, self.gyro_type.as_ref(), &found.previous, options.details);
            let (language, checks) = (language(), self.checks());
            let how = report::Said { language, meter_assumed: self.laboratory().is_none(), checks };
            let text = report::text(done, trials, &of, &how);
            output::text(&(text + &found.uncertainty.text(self.gyro_type.as_ref(), &done.document, language)))?;
        }
        Ok(found.code())
    }

    /// Calibrates several gyros, with one line for each.
    fn several(&self, currents: &[PathBuf]) -> Result<Code, Failure> {
        let options = self.options;
        let certificate = &self.passport.content.certificate;
        if let Some(warning) = TemperatureOutside::of(certificate, &self.subject(), Some(&self.laboratory)) {
            output::warn(&warning.to_string());
        }
        let mut written = HashMap::new();
        let mut calibrated = Once::new();
        let mut all = Gyros::new(language());
        let calibrate = |path: &Path| {
            let found = self.calibrate(path)?;
            calibrated
                .check(found.done.readings.means_ma(), &found.currents.0, ["currents", "gyro"])
                .map_err(Failure::refused)?;
            if let Some(folder) = &options.out {
                let stem = folder.join(path.file_stem().unwrap_or_default());
                if let Some(other) = written.get(&stem) {
                    let (json, other) = (with_end(&stem, ".json"), Printable(other));
                    let words = format!(
                        "nothing was written: {} is the result of {other}; specify each file of currents once, or rename one",
                        shown(&json)
                    );
                    return Err(Failed::new(interface::EXISTS, words, Vec::new()).into());
                }
                let files = result(&found, &stem, &self.page(&found)?)?;
                files::together::write_replaceable_together(&files, options.force.replace)?;
                written.insert(stem, found.currents.0.clone());
            }
            if let Some(serial) = found.done.document.gyro_serial().filter(|_| found.place.is_some()) {
                // Otherwise the second of one gyro would be compared with the first.
                let other = written.insert(PathBuf::from(serial), found.currents.0.clone());
                if let Some(other) = other {
                    let words = format!("nothing was written: gyro {serial} is that of {} too", Printable(other));
                    return Err(Failure::refused(words));
                }
                self.keep(&found, self.page(&found)?)?;
            }
            let trials = found.uncertainty.monte_carlo.as_ref();
            let text = gyros::line(&found.currents.0, &found.done, trials, self.gyro_name(), language());
            let result = serde_json::to_value(found.whole()).map_err(Failure::unusable)?;
            all.add(&found.done, self.gyro_name(), self.checks());
            Ok(Answer { value: Named { file: found.currents.0.clone(), result }, text, code: found.code() })
        };
        let (code, failed) = inputs::each(currents, Purpose::Tables, Lines::or(Lines::Text), calibrate)?;
        let folder = options.out.as_ref().or(self.results.as_ref());
        if let Some(folder) = folder.filter(|_| !written.is_empty()) {
            let (count, folder) = (written.len(), shown(folder));
            let plural = if count == 1 { "" } else { "s" };
            output::say(&format!(
                "wrote the result (.json) and the report (.html) of {count} gyro{plural} to {folder}"
            ));
        }
        failed.iter().for_each(|failed| all.add_failed(issued::outcome(failed)));
        match (output::is_json(), all.summary()) {
            (false, _) => output::text(&all.text(self.laboratory().is_none(), self.gyro_name()))?,
            (true, words) if words.is_empty() => (),
            (true, words) => output::say_verdict(&style::plain(&words)),
        }
        Ok(code)
    }

    /// Writes the result and the report into the folder of results, as PDF too where a browser prints it, and returns their
    /// paths.
    fn keep(&self, found: &Found, html: String) -> Result<Vec<PathBuf>, Failure> {
        let Some(place) = &found.place else { return Ok(Vec::new()) };
        let mut files = result(found, place, &html)?;
        if !self.lacks_pdf.get() {
            let path = with_end(place, ".pdf");
            match output::page(&path, html, false) {
                Ok(pdf) => files.push((path, pdf)),
                Err(error) => {
                    self.lacks_pdf.set(true);
                    output::say_after(&format!("no PDF was written: {error}"));
                }
            }
        }
        files::together::write_replaceable_together(&files, false)?;
        Ok(files.into_iter().map(|(path, _)| path).collect())
    }

    fn gyro_name(&self) -> Option<&str> {
        self.gyro_type.as_ref().map(|gyro_type| gyro_type.r#type.as_str())
    }

    fn page(&self, found: &Found) -> Result<String, Failure> {
        let done = &found.done;
        let (name, sha256) = &found.currents;
        let page = CalibrationPage {
            passport: used(&self.passport, self.enquiry.as_ref())?,
            time: self.verified_as_of().unwrap_or_else(Timestamp::now),
            currents: (name, sha256.clone()),
            gyro: self.gyro_type.as_ref(),
            laboratory: self.laboratory(),
            calibration: &done.calibration,
            missing: &done.missing,
            document: &done.document,
            previous: &found.previous,
            budget: found.uncertainty.budget.as_ref().map(|(budget, _)| budget),
            monte_carlo: found.uncertainty.monte_carlo.as_ref(),
            details: self.options.details,
        };
        Ok(page.html(&languages()))
    }

    fn dcc(&self, done: &Done) -> Result<String, Failure> {
        let sha256 = sha256_hex(&self.passport.bytes);
        let calibrated =
            Calibrated::new(&self.passport.content, &sha256, self.laboratory(), self.gyro_type.as_ref(), done);
        let (calibrated, languages) = (calibrated.map_err(Failure::refused)?, languages());
        let dcc = dcc::of_gyro(&calibrated, self.administrative.content.as_ref(), Some(&languages));
        Ok(dcc.map_err(|problems| self.administrative.refuse(problems))?.xml)
    }
}

impl Options {
    /// Returns the passport, or `None` if tables alone are given because the workspace tells it, and the files of currents.
    fn inputs(&self) -> Result<(Option<PathBuf>, &[PathBuf]), Failure> {
        let tells = open_workspace::workspace().is_some_and(|workspace| !workspace.stand.is_empty());
        let is_table =
            |path: &Path| path.extension().is_some_and(|end| end.eq_ignore_ascii_case("csv")) || path.is_dir();
        match &self.files[..] {
            [first, currents @ ..] if !(currents.is_empty() || tells && is_table(first)) => {
                Ok((Some(defaults::path_of_passport(first.clone()).map_err(Failure::usage)?), currents))
            }
            tables => Ok((None, tables)),
        }
    }

    /// Refuses options that describe a single gyro.
    fn check_for_several(&self) -> Result<(), Failure> {
        let given = [
            ("--gyro-serial", self.gyro_serial.is_some()),
            ("--previous", !self.previous.is_empty()),
            ("--exclude", !self.exclude.is_empty()),
            ("--report", self.report.path.is_some()),
            ("--dcc", self.dcc.is_some()),
            // Their lines have no room for it.
            ("--budget", self.uncertainty.budget && self.out.is_none() && !output::is_json()),
        ];
        let Some((option, _)) = given.into_iter().find(|(_, given)| *given) else { return Ok(()) };
        if self.out.is_some() {
            let advice = "use --report FILE.html for the report, --format json for the result";
            return Err(Failure::usage(format!("{option} is for one gyro, but --out for several; {advice}")));
        }
        let advice = match option {
            "--report" => "; --out DIR writes the reports of several",
            "--budget" => "; --out DIR or --format json states the budget of each",
            _ => "; calibrate this file alone",
        };
        Err(Failure::usage(format!(
            "{option} is for one file of currents, not for several, a pattern or a folder{advice}"
        )))
    }

    /// Returns how the library shall calibrate.
    fn asked(&self) -> CalibrationOptions {
        CalibrationOptions {
            methods: self.method.clone(),
            stop_rule: StopRule { delta1_percent: self.delta1_percent, delta2_deg_per_h: self.delta2_deg_per_h },
            model: match self.model.as_str() {
                _ if self.anisoelasticity => Model::Anisoelastic,
                "general" => Model::General,
                _ => Model::Paper,
            },
            drift: self.drift,
        }
    }
}

/// Returns the result and the report, with the paths of their files.
fn result(found: &Found, stem: &Path, html: &str) -> Result<Vec<(PathBuf, Vec<u8>)>, Failure> {
    let json = printable::json(&found.whole()).map_err(Failure::unusable)? + "\n";
    Ok(vec![(with_end(stem, ".json"), json.into_bytes()), (with_end(stem, ".html"), html.into())])
}

/// Returns a path with something after its name, which may contain a point.
fn with_end(stem: &Path, end: &str) -> PathBuf {
    let mut path = stem.as_os_str().to_owned();
    path.push(end);
    path.into()
}

/// Returns the passport in the form that the report takes.
fn used<'a>(passport: &'a Read, enquiry: Option<&'a Enquiry>) -> Result<UsedPassport<'a>, Failure> {
    let Read { content, bytes, verification } = passport;
    let Some((verification, Enquiry { question, .. })) = verification.as_ref().zip(enquiry) else {
        return Ok(UsedPassport::NotVerified { content, sha256: sha256_hex(bytes) });
    };
    let page = PassportPage::of(bytes, question, verification.clone());
    // The passport has just passed every check.
    let page = page.map_err(|_| Failure::refused("the passport cannot be used in a report"))?;
    Ok(UsedPassport::Verified(Box::new(page)))
}

/// Reads the previous results, from the earliest to the latest.
fn previous(options: &Options) -> Result<Vec<CalibrationDocument>, Failure> {
    let expected = "the JSON result of an earlier calibration";
    let read = |path: &PathBuf| inputs::document(path, expected, CalibrationDocument::from_json);
    let mut results = options.previous.iter().map(read).collect::<Result<Vec<_>, _>>()?;
    CalibrationDocument::sort(&mut results);
    Ok(results)
}

fn exclude(options: &Options, name: &str, readings: &mut Readings) -> Result<(), Failure> {
    let reasons = options::reasons(options.exclude.len(), &options.why)?;
    for (&(PositionIndex { i, j }, visit, cycle), why) in options.exclude.iter().zip(reasons) {
        let excluded = readings.exclude(Exclusion { i, j, visit, cycle, why });
        excluded.map_err(|words| Failure::unusable(format!("{}: {words}", printable(name))))?;
    }
    Ok(())
}
