//! Demonstration on a built-in example: a key, a stand, two sites, passports, verification, a wrong place, a re-issue,
//! a calibration, an altered byte. It needs nothing but this program.

use crate::calibration::{self, Options, Parameter, Readings, Setup};
use crate::coefficients::PositionIndex;
use crate::earth::Place;
use crate::files::{self, Access, Durability};
use crate::folder::{Authority, Folder, Issued};
use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::passport::issue::{Issue, PreparedStand};
use crate::passport::reissue::{Reissue, successor};
use crate::passport::{CheckName, Question, Trust, Verification, verify};
use crate::report::columns::decimals;
use crate::report::doc::said;
use crate::report::style::marked;
use crate::report::verdict::{self, counts_with_names};
use crate::report::{Language, Languages, PassportPage};
use crate::signing::allowed_signers_line;
use crate::simulation::draw::CurrentError;
use crate::site::Site;
use crate::stand::{CertifiedPosition, Stand};
use crate::statistics::random::Stream;
use crate::text::scalar::day;
use crate::text::{LARGEST_DOCUMENT_BYTES, shown};
use crate::trust::{AllowedSigners, SigningKey};
use crate::units::quantity;
use jiff::Timestamp;
use std::path::{Path, PathBuf};

const STAND: &str = include_str!("../passports/SPS-1/0203/stand.yaml");
const MOSCOW: &str = include_str!("../sites/moscow-bmstu.yaml");
const BEIJING: &str = include_str!("../sites/beijing-nim.yaml");
const IDENTITY: &str = "factory@example.org";

/// Result of a step; the first step that fails stops the demonstration, and its words say why.
type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Words for a passport that was just issued but not accepted.
const REFUSED: &str = "a newly issued passport was rejected";

/// Returns `dtg-passport-demo` in the current folder, with a number if that already exists.
pub(crate) fn free_folder() -> PathBuf {
    let first = PathBuf::from("dtg-passport-demo");
    let numbered = (2..).map(|number: u32| PathBuf::from(format!("dtg-passport-demo-{number}")));
    std::iter::once(first).chain(numbered).find(|folder| !folder.exists()).unwrap_or_default()
}

/// Runs the demonstration in `folder` at the time `now`; returns `true` if every answer was the expected one.
///
/// It passes each line of its output to `tell`, which returns `false` if the reader has closed the output.
///
/// # Errors
/// Returns the error of the first step that fails; a closed output is one too.
pub(crate) fn run(folder: &Path, now: Timestamp, tell: &mut dyn FnMut(&str) -> bool) -> Result<bool> {
    if folder.exists() && !std::fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_none()) {
        let words = "already exists and is not an empty folder; specify another one with --out";
        return Err(format!("{}: {words}", shown(folder)).into());
    }
    let stand = Stand::from_yaml("stand.yaml", STAND.as_bytes())?;
    let moscow = Site::from_yaml("moscow-bmstu.yaml", MOSCOW.as_bytes())?;
    let beijing = Site::from_yaml("beijing-nim.yaml", BEIJING.as_bytes())?;
    // If the clock of the machine is behind the certificate, use the day of the certificate.
    let now = now.max(day(stand.certificate.issued).0);
    let key = SigningKey::generate()?;
    let signers = allowed_signers_line(IDENTITY, &key.public_key())? + "\n";
    let trust = Trust::of(AllowedSigners::parse("allowed_signers", signers.as_bytes())?);
    let mut stage = Stage { folder, now, key, trust, tell, as_expected: true };
    stage.key(&signers)?;
    let here = stage.issue(&stand, &moscow)?;
    stage.laboratory(&here, &moscow, &beijing)?;
    let there = stage.moved(&here, &beijing)?;
    stage.calibrated(&there)?;
    stage.altered(&there)?;
    stage.heading(&format!("The files are in {}. To verify them yourself, run:", shown(folder)))?;
    let (signers, passport) = (stage.path("allowed_signers"), shown(&there.path));
    stage.line(&format!("  dtg-passport verify {passport} --trust {} --serial 0203", shown(&signers)))?;
    Ok(stage.as_expected)
}

/// Returns a CSV file of the currents of the paper's gyro, with the errors of the paper's meter; always the same.
fn simulated_currents(setup: &Setup) -> String {
    const SEED: u64 = 1;
    let gyro = GyroType::gvk_6().nominal.to_model();
    let positions = &setup.coefficients().positions;
    let mut currents: Vec<_> = positions.iter().filter_map(|position| gyro.currents_ma(position)).collect();
    CurrentError::Independent.add(&mut Stream::new(SEED), 0.015, &mut currents);
    let rows = positions.iter().zip(&currents).map(|(position, current)| {
        let (PositionIndex { i, j }, x, y) = (position.index, current.x, current.y);
        format!("{i},{j},{x:.7},{y:.7}\n")
    });
    std::iter::once("i,j,jx_ma,jy_ma\n".to_owned()).chain(rows).collect()
}

struct Stage<'a> {
    folder: &'a Path,
    now: Timestamp,
    key: SigningKey,
    trust: Trust,
    tell: &'a mut dyn FnMut(&str) -> bool,
    as_expected: bool,
}

impl Stage<'_> {
    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Writes a file that everyone may read, and returns its path.
    fn write(&self, name: &str, text: &str) -> Result<PathBuf> {
        let path = self.path(name);
        files::write_new(&path, text.as_bytes(), Access::Shared, Durability::Named)?;
        Ok(path)
    }

    fn line(&mut self, words: &str) -> Result<()> {
        if (self.tell)(words) { Ok(()) } else { Err("standard output cannot be written".into()) }
    }

    fn file(&mut self, path: &Path) -> Result<()> {
        self.line(&format!("   {}", shown(path)))
    }

    fn heading(&mut self, words: &str) -> Result<()> {
        self.line("")?;
        self.line(words)
    }

    fn passports(&self) -> Folder {
        Folder::new(self.path("passports"))
    }

    /// Reads a passport, and verifies it for a question.
    fn verified(&self, issued: &Issued, question: &Question) -> Result<(Vec<u8>, Verification)> {
        let bytes = files::read(&issued.path, LARGEST_DOCUMENT_BYTES)?;
        let answer = verify(&issued.id, &bytes, &self.trust, question);
        Ok((bytes, answer))
    }

    fn key(&mut self, signers: &str) -> Result<()> {
        let private = self.key.to_openssh(IDENTITY, None)?;
        files::write_new(&self.path("factory.key"), private.as_bytes(), Access::Private, Durability::Named)?;
        let path = self.write("allowed_signers", signers)?;
        self.line("THE FACTORY")?;
        self.line("1. The factory creates a signing key and sends its public half to every laboratory, once:")?;
        self.file(&path)
    }

    fn issue(&mut self, stand: &Stand, moscow: &Site) -> Result<Issued> {
        self.write("stand.yaml", STAND)?;
        self.write("sites/moscow-bmstu.yaml", MOSCOW)?;
        self.write("sites/beijing-nim.yaml", BEIJING)?;
        let angles = stand.positions.iter().flat_map(CertifiedPosition::angles_arcsec);
        let largest = angles.fold(0.0, |largest: f64, angle| largest.max(angle.abs())) / 3600.0;
        self.line(&format!(
            "2. It measures the deviations of the eight positions of a low-cost stand: up to {largest:.1}°."
        ))?;
        self.line("3. It computes the calibration data for the site and signs them:")?;
        let (now, order) = (self.now, Issue::first(IDENTITY, self.now));
        let clock = || now;
        let authority = Authority::new(IDENTITY, &self.key, &self.trust, &clock);
        let issued = self.passports().issue(&PreparedStand::new(stand.clone()), moscow, &order, &authority)?;
        self.file(&issued.path)?;
        if let Some(growth) = issued.remarks.noise {
            let worst = growth.worst();
            self.line(&format!(
                "   The noise of a calibration on this stand is {worst:.2} times that on an ideal stand."
            ))?;
        }
        Ok(issued)
    }

    fn laboratory(&mut self, here: &Issued, moscow: &Site, beijing: &Site) -> Result<()> {
        let now = self.now;
        let ask = |site: &Site| Question {
            serial: Some("0203".to_owned()),
            place: site.longitude_deg.map(|longitude_deg| Place { latitude_deg: site.geodetic_deg(), longitude_deg }),
            ..Question::at(now)
        };
        self.heading("THE LABORATORY")?;
        self.line("4. The laboratory in Moscow checks that the passport is valid for stand 0203, here and now:")?;
        let (_, answer) = self.verified(here, &ask(moscow))?;
        self.answer(&answer, None)?;
        self.line("5. The laboratory in Beijing makes the same check of the same passport:")?;
        let (_, answer) = self.verified(here, &ask(beijing))?;
        self.answer(&answer, Some(CheckName::Place))
    }

    fn moved(&mut self, here: &Issued, beijing: &Site) -> Result<Issued> {
        self.heading("THE STAND MOVES")?;
        self.line("6. The factory re-issues the passport for Beijing, from its predecessor alone:")?;
        let (now, question) = (self.now, Question::at(self.now));
        let (bytes, old) = self.verified(here, &question)?;
        let (site, moved) = (Some(beijing.clone()), true);
        let order = Reissue { site, moved, ..Reissue::new(IDENTITY, now, "delivered to Beijing") };
        let clock = || now;
        let authority = Authority::new(IDENTITY, &self.key, &self.trust, &clock);
        let issued = self.passports().reissue(&successor(&bytes, &old, &order)?, &authority)?;
        self.file(&issued.path)?;
        let (bytes, answer) = self.verified(&issued, &question)?;
        self.answer(&answer, None)?;
        let page = PassportPage::of(&bytes, &question, answer).map_err(|_| REFUSED)?;
        let languages = Languages::new(Language::English, [Language::Russian]);
        let path = self.write("passport.html", &page.html(&languages))?;
        self.line(&format!("   Printed passport in English and Russian: {}", shown(&path)))?;
        Ok(issued)
    }

    /// Writes the simulated currents of a gyro of the paper's type as a CSV file, and calibrates that gyro.
    fn calibrated(&mut self, there: &Issued) -> Result<()> {
        self.heading("A GYRO")?;
        self.line(
            "7. A gyro is mounted on the stand in Beijing, and its currents are read in the eight positions (simulated here):",
        )?;
        let (_, answer) = self.verified(there, &Question::at(self.now))?;
        let Some(passport) = answer.passport() else { return Err(REFUSED.into()) };
        let content = passport.content();
        let laboratory = Laboratory::paper();
        let (setup, _) = Setup::stated(&content.certificate, &content.positions, &content.site, &laboratory)?;
        let csv = simulated_currents(&setup);
        let path = self.write("currents.csv", &csv)?;
        self.file(&path)?;
        let range_ma = laboratory.meter.range_ma;
        let readings = Readings::from_csv("currents.csv", csv.as_bytes(), setup.coefficients(), range_ma)?;
        let calibration = calibration::calibrate(&setup, &readings, &Options::default())?;
        let found = calibration.valid()?;
        self.line(
            "8. The currents and the passport give its scale factors and drifts at local g, with U (k = 2); the true \
             ones are 95, 9.5, 20 and 10:",
        )?;
        for parameters in Parameter::AS_IN_THE_PAPER.chunk_by(|a, b| a.unit() == b.unit()) {
            let value = |p: &Parameter| {
                let (value, expanded) = (found.value(*p)?, 2.0 * found.standard_uncertainty(*p)?);
                let decimals = decimals(expanded);
                Some(format!("{} {value:.decimals$} ± {expanded:.decimals$}", p.symbol()))
            };
            let values: Vec<String> = parameters.iter().filter_map(value).collect();
            self.line(&format!("   {}", quantity(&values.join(", "), parameters[0].unit())))?;
        }
        let probability = found.chi_square.probability;
        self.line(&format!("   The sixteen readings fit; the probability of a larger chi-square is {probability:.2}."))
    }

    fn altered(&mut self, there: &Issued) -> Result<()> {
        self.heading("A FORGER")?;
        self.line("9. A forger changes one digit of the passport:")?;
        let text = String::from_utf8_lossy(&files::read(&there.path, LARGEST_DOCUMENT_BYTES)?).into_owned();
        let forged = text.replacen("alpha_arcsec: 4310.0", "alpha_arcsec: 4311.0", 1);
        self.write("forged.yaml", &forged)?;
        let answer = verify("forged.yaml", forged.as_bytes(), &self.trust, &Question::at(self.now));
        self.answer(&answer, Some(CheckName::Signature))
    }

    /// Writes the answer: valid, or the first check that failed; and records whether it was the expected one.
    fn answer(&mut self, answer: &Verification, expected: Option<CheckName>) -> Result<()> {
        let failed = answer.failed();
        self.as_expected &= failed.map(|check| check.name) == expected;
        let [mark, words] = match failed {
            None => [verdict::answer(true, answer.checks()), counts_with_names(answer.checks())]
                .map(|words| said(&words, Language::English)),
            Some(check) => [marked(Some(false), "REFUSED"), format!("{}: {}", check.name.as_str(), check.detail)],
        };
        self.line(&format!("   {mark}: {words}"))
    }
}
