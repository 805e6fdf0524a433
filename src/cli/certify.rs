//! Verb `certify`: stand files from repeated readings of the angles, or a later check run against one.

use super::diff::past;
use super::inputs::{self, Answer, Lines};
use super::options::{ExclusionOptions, Force, Out, Printed, Report, STAND, file_or_folder};
use super::output::languages;
use super::trust_options::OptionalTrust;
use super::{Code, Failure, REFUSED, defaults, output};
use crate::batch::certificates::Certificates;
use crate::batch::once::Once;
use crate::batch::{Purpose, paths};
use crate::certification::found::Found;
use crate::certification::measured::{Measured, NotMeasured};
use crate::certification::{AngleReadings, Certification, Header, NotCertified, certify};
use crate::files;
use crate::folder::Folder;
use crate::folder::archive::Superseded;
use crate::interface::Failed;
use crate::passport::content::claims_to_be_a_passport;
use crate::passport::difference::of_deviations;
use crate::report::certification as report;
use crate::report::doc::Block;
use crate::report::page::certification::CertificationPage;
use crate::stand::Stand;
use crate::text::{Kind, LARGEST_DOCUMENT_BYTES, Printable, name_of, shown};
use clap::Args;
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Certify a stand from repeated readings of its angles, or check that it has not changed
///
/// For several stands, give several files, a quoted pattern, or a folder, whose *.csv files are read; with - the paths are
/// read from standard input. --stand is then the folder of their headers, NAME.yaml for NAME.csv. Each stand gives one
/// line of output, and with --format json one line of JSON.
#[derive(Args)]
pub(super) struct Options {
    /// Angles: CSV with the header i,j,run,alpha_arcsec,beta_arcsec,gamma_arcsec, and every position in every run
    #[arg(required = true, value_name = "READINGS.csv")]
    readings: Vec<PathBuf>,
    /// Stand file (dtg-stand/1) whose positions have no angles yet [default: that of --against]; for several stands, the
    /// folder of these files
    #[arg(long, alias = "header", value_name = "HEADER.yaml", required_unless_present = "against")]
    stand: Option<PathBuf>,
    /// Stand file to write; or folder for those of several stands, <model>/<serial>/stand.yaml
    #[arg(
        short,
        long,
        visible_alias = "output",
        value_name = "stand.yaml|DIR",
        value_parser = file_or_folder(STAND),
        required_unless_present = "against"
    )]
    out: Option<Out>,
    /// Table of certificates: --stand is then one header for all stands, which may lack serial, number and issued. CSV with the
    /// columns serial, number, issued and any of performed, received, valid_until, customer, temperature_c; the readings of a
    /// row are SERIAL.csv
    #[arg(long, value_name = "TABLE.csv", requires_all = ["out", "stand"])]
    certificates: Option<PathBuf>,
    #[command(flatten)]
    force: Force,
    /// Certified stand or passport to compare the readings with; one run is sufficient. A passport requires --trust. In a
    /// workspace also MODEL/SERIAL, or the identifier of a passport
    #[arg(long, value_name = "FILE", value_parser = defaults::certified())]
    against: Option<PathBuf>,
    #[command(flatten)]
    trust: OptionalTrust,
    #[command(flatten)]
    exclusions: ExclusionOptions,
    #[command(flatten)]
    report: Report,
    #[command(flatten)]
    _printed: Printed,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let of_one = options.against.is_some() || options.report.path.is_some() || options.exclusions.is_any();
    match (&options.out, paths::one_file(&options.readings)) {
        (Some(Out::Folder(folder)), _) if of_one => Err(Failure::usage(format!(
            "{}: --against, --report and --exclude are for one stand, whose file is specified with -o stand.yaml",
            shown(folder)
        ))),
        (Some(Out::Folder(folder)), _) => several(options, folder),
        (Some(Out::File(path)), _) if options.certificates.is_some() => Err(Failure::usage(format!(
            "{}: is one stand file, but --certificates is for several; specify a folder with -o DIR",
            shown(path)
        ))),
        (out, Some(readings)) => one(options, readings, out.as_ref().and_then(Out::file)),
        (None, None) => Err(Failure::usage("--against is for one file of readings; check each stand by itself")),
        (Some(Out::File(path)), None) => Err(Failure::usage(format!(
            "{}: is one stand file, but several files of readings are given; specify a folder with -o DIR",
            shown(path)
        ))),
    }
}

/// Result for one of several stands.
#[derive(Serialize)]
struct Line {
    file: String,
    stand_file: String,
    #[serde(flatten)]
    result: Value,
}

/// Certifies several stands, with one line for each.
fn several(options: &Options, folder: &Path) -> Result<Code, Failure> {
    let headers = options.stand.as_deref().ok_or_else(|| Failure::usage("missing --stand"))?;
    let table = options.certificates.as_deref();
    let table = table.map(|path| inputs::document(path, "a table of certificates (CSV)", Certificates::read));
    let table = table.transpose()?;
    let common = table.as_ref().map(|_| inputs::bytes(headers, inputs::HEADER)).transpose()?;
    let mut used = BTreeSet::new();
    if table.is_none() && !headers.is_dir() {
        let words = "expected a folder; with --out, --stand is the folder of the headers, NAME.yaml for NAME.csv";
        return Err(Failure::usage(format!("--stand {}: {words}", shown(headers))));
    }
    let folder = Folder::new(folder);
    let (mut measured, mut numbered) = (Once::new(), Once::new());
    let work = |readings: &Path| {
        let name = name_of(readings);
        let header = match (&table, &common) {
            (Some(table), Some(common)) => {
                let serial = readings.file_stem().unwrap_or_default().to_string_lossy();
                used.insert(serial.clone().into_owned());
                let header = table.header(&name_of(headers), common, &serial);
                header.map_err(|why| Failure::refused(format!("{}: {why}", Printable(&name))))?
            }
            _ => header_of(headers, readings)?,
        };
        let bytes = inputs::bytes(readings, Kind::Angles.words())?;
        let read = AngleReadings::from_csv(&name, &bytes, &header.positions)?;
        if let Some(remark) = &read.remark {
            output::say(&format!("{}: {remark}", Printable(&name)));
        }
        let certified = certify(&header, &read);
        let certified = certified.map_err(|why| refused(&name, &why))?;
        measured.check(read.means_arcsec(), &name, ["angles", "stand"]).map_err(Failure::refused)?;
        let number = &certified.stand.certificate.number;
        if let Some(other) = numbered.earlier(number.clone(), &name) {
            let (name, number, other) = (Printable(&name), Printable(number), Printable(other));
            output::complain(&format!(
                "{name}: WARNING: its certificate has the same number, {number}, as that of {other}"
            ));
        }
        certified.stand.certificate.odd_number().iter().for_each(|words| output::warn(words));
        let stand = &certified.stand.stand;
        let path = folder.stand_file(stand);
        folder.check_place(&path).map_err(Failure::refused)?;
        write(&path, &certified, &[], options.force.replace)?;
        let text = output::typed(&report::line(&certified, &name_of(&path)));
        let result = report::to_json(Some(&certified), None, None);
        Ok(Answer { value: Line { file: name, stand_file: name_of(&path), result }, text, code: 0 })
    };
    let (mut code, _) = inputs::each(&options.readings, Purpose::Tables, Lines::or(Lines::Text), work)?;
    let serials = table.iter().flat_map(Certificates::serials);
    for serial in serials.filter(|serial| !used.contains(*serial)) {
        output::complain(&format!("serial {}: the table has a row, but no readings are given", Printable(serial)));
        code = code.max(REFUSED);
    }
    Ok(code)
}

/// Returns the failure for readings that give no certificate.
fn refused(name: &str, why: &NotCertified) -> Failure {
    let findings = why.finding().iter().map(Found::to_json).collect();
    Failed::refused(format!("{}: {why}", Printable(name))).because_of(findings).into()
}

/// Reads the header of one of several stands: the file with the name of its readings in the folder `headers`.
fn header_of(headers: &Path, readings: &Path) -> Result<Header, Failure> {
    let name = |extension: &str| headers.join(readings.with_extension(extension).file_name().unwrap_or_default());
    let path = Some(name("yml")).filter(|path| path.is_file()).unwrap_or_else(|| name("yaml"));
    if path.symlink_metadata().is_err() {
        let advice = "`dtg-passport new header FILE` writes a template";
        let (path, readings) = (shown(&path), shown(readings));
        return Err(Failure::unusable(format!("{path}: missing, expected the header of {readings}; {advice}")));
    }
    inputs::document(&path, inputs::HEADER, Header::from_yaml)
}

/// Writes a certified stand; a stand file that it supersedes is kept. Certificates of `known` stands, and of the one that
/// is there, must not have its number with other angles.
fn write(path: &Path, certified: &Certification, known: &[&Stand], force: bool) -> Result<(), Failure> {
    // An existing output file need not be a stand file; --force replaces it in any case.
    let there = inputs::stand(path).ok();
    for stand in known {
        certified.stand.check_number(stand).map_err(Failure::refused)?;
    }
    if let Some(there) = &there {
        let in_use = |used| format!("{}: {used}; or delete this file, if no passport was issued from it", shown(path));
        certified.stand.check_number_of_file(there).map_err(|used| Failure::refused(in_use(used)))?;
    }
    let text = certified.to_yaml(&name_of(path)).map_err(Failure::refused)?;
    files::check_replaceable([path], force)?;
    let superseded = Superseded::of(path, text.as_bytes())?;
    if let Some(superseded) = &superseded {
        files::together::write_together(superseded.new_file().as_slice(), &[])?;
        output::say_after(&format!("kept the superseded stand file as {}", shown(&superseded.path)));
    }
    Ok(files::write_replaceable(path, text.as_bytes(), force)?)
}

fn one(options: &Options, readings: &Path, out: Option<&PathBuf>) -> Result<Code, Failure> {
    let against = options.against.as_deref().map(|path| certified(path, &options.trust)).transpose()?;
    let (name, bytes) = (name_of(readings), inputs::bytes(readings, Kind::Angles.words())?);
    let header = options.stand.as_deref().map(|path| inputs::document(path, inputs::HEADER, Header::from_yaml));
    let excluded = options.exclusions.excluded()?;
    let again = options.report.path.is_some();
    let measured = Measured::new(header.transpose()?, against.as_ref(), (&name, &bytes), excluded, again);
    let Measured { certified, comparison, is_own, remark } = measured.map_err(|why| match why {
        NotMeasured::Unreadable(error) => error.into(),
        NotMeasured::NoHeader => Failure::unusable(why),
        _ => Failure::refused(why),
    })?;
    remark.iter().for_each(|remark| output::say(remark));
    // A check of one run needs no certificate of its own. If an output file was requested, the program says why there
    // is none.
    let (certified, refused) = match certified {
        Ok(certified) => (Some(certified), None),
        Err(refused) if out.is_none() && options.report.path.is_none() => (None, Some(refused)),
        Err(why) => return Err(refused(&name, &why)),
    };
    let page = certified.as_ref().zip(options.report.path.as_ref()).map(|(certified, path)| {
        let change = comparison.as_ref().zip(against.as_ref());
        let change = change.map(|(comparison, old)| (comparison, of_deviations(old, &certified.stand)));
        let page = CertificationPage { certification: certified, readings: (&name, &bytes), change, dry_run: false };
        Ok::<_, Failure>((path, output::page(path, page.html(&languages()), options.force.replace)?))
    });
    // Nothing is written if the record cannot be.
    let page = page.transpose()?;
    files::check_replaceable(page.as_ref().map(|(path, _)| *path), options.force.replace)?;
    if let (Some(path), Some(certified)) = (out, &certified) {
        if options.stand.is_none() {
            against.iter().try_for_each(|stand| certified.stand.check_number(stand)).map_err(Failure::refused)?;
            let words = "-o requires --stand HEADER.yaml, because a new certificate has its own number and dates";
            return Err(Failure::unusable(words));
        }
        certified.stand.certificate.odd_number().iter().for_each(|words| output::warn(words));
        write(path, certified, &against.iter().collect::<Vec<_>>(), options.force.replace)?;
        output::say_after(&format!("wrote {}", shown(path)));
    }
    if let Some((path, page)) = &page {
        output::saved_too(path, page, options.force.replace)?;
    }
    let document = || {
        let shown = certified.as_ref().filter(|_| out.is_some() || is_own).map(report::certification);
        let compared = comparison.as_ref().map(|found| report::comparison(found, true));
        // Whether the stand has changed comes first: it decides whether the new certificate is of any use.
        let between = (compared.is_some() && shown.is_some()).then(|| vec![Block::Gap]);
        [compared, between, shown].into_iter().flatten().flatten().collect()
    };
    let as_json = || report::to_json(certified.as_ref(), refused.as_ref(), comparison.as_ref());
    output::show(as_json, document)?;
    Ok(if comparison.is_some_and(|comparison| !comparison.same_stand) { REFUSED } else { 0 })
}

/// Reads the certified stand in a stand file or, if `trust` verifies it, in a passport.
fn certified(path: &Path, trust: &OptionalTrust) -> Result<Stand, Failure> {
    let is_passport =
        files::read_first(path, LARGEST_DOCUMENT_BYTES).is_ok_and(|bytes| claims_to_be_a_passport(&bytes));
    if !is_passport {
        return inputs::stand(path);
    }
    match trust.load()? {
        Some(enquiry) => Ok(past(path, &enquiry)?.content.to_stand()),
        None => Err(Failure::unusable(format!("{}: found a passport; specify --trust to verify it", shown(path)))),
    }
}
