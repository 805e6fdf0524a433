//! Verb `export`: verified passports in other forms: stand and site files, JSON, and a DCC.

use super::inputs::{self, AdministrativeFile, Answer, Lines};
use super::options::{Force, Printed, folder};
use super::output::stated_languages;
use super::trust_options::{Enquiry, TrustAmong};
use super::{Code, Failure, REFUSED, UNUSABLE, defaults, output};
use crate::batch::Purpose;
use crate::dcc;
use crate::document::sha256_hex;
use crate::files::together::write_replaceable_together;
use crate::files::{self, FileError};
use crate::folder::Folder;
use crate::interface::Failed;
use crate::passport::Content;
use crate::passport::export::{site_file, stand_file};
use crate::report::exported;
use crate::text::{LARGEST_DOCUMENT_BYTES, name_of, printable, shown};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Export verified passports as stand and site files, as JSON, or as a Digital Calibration Certificate
///
/// PASSPORT is a file, a quoted pattern, or a folder; a - reads a list of paths from standard input. Files are written
/// to DIR/<model>/<serial>/stand.yaml, DIR/<site id>.yaml, DIR/<model>/<serial>/<site id>-<revision>.json and
/// DIR/<number of the certificate>.xml.
#[derive(Args)]
#[command(mut_arg("lang", |lang| lang.help("Languages of the DCC: en, ru, or en,ru for both [default: the language in FILE, or en]")))]
pub(super) struct Options {
    /// Passports; in a workspace also their identifiers
    #[arg(required = true, value_name = "PASSPORT", value_parser = defaults::passport())]
    passports: Vec<PathBuf>,
    /// Forms to export, separated by commas
    #[arg(long, value_enum, value_delimiter = ',', required = true, value_name = "FORM")]
    to: Vec<Form>,
    #[command(flatten)]
    trust: TrustAmong,
    /// Folder to write to [default: the current folder; JSON goes to standard output, one line for each passport]
    #[arg(short, long, visible_alias = "output", value_name = "DIR", value_parser = folder("; the program names the files in it"))]
    out: Option<PathBuf>,
    /// Administrative data of the DCC that no passport states (dtg-dcc/1); `new dcc` writes a template
    #[arg(long, value_name = "FILE")]
    administrative: Option<PathBuf>,
    #[command(flatten)]
    force: Force,
    #[command(flatten)]
    _printed: Printed,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Form {
    /// Stand file (dtg-stand/1)
    Stand,
    /// Site file (dtg-site/1)
    Site,
    /// Passport with its checks, as JSON
    Json,
    /// Digital Calibration Certificate of PTB, 3.3.0, with the signed passport in it
    Dcc,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let to_dcc = options.to.contains(&Form::Dcc);
    if !to_dcc && (options.administrative.is_some() || stated_languages().is_some()) {
        return Err(Failure::usage("--administrative and --lang are for a DCC; add --to dcc, or omit them"));
    }
    let enquiry = options.trust.load()?;
    let administrative = AdministrativeFile::read(options.administrative.as_deref())?;
    let folder = Folder::new(options.out.as_deref().unwrap_or(Path::new("")));
    let mut run = Run { options, enquiry, administrative, folder, written: HashMap::new() };
    let lines = if run.prints_json() { Lines::Json } else { Lines::or(Lines::None) };
    let (code, _) = inputs::each(&options.passports, Purpose::Passports, lines, |path| run.export(path))?;
    if to_dcc && !run.written.is_empty() {
        output::say("the DCC is not signed; only the passport in it is: save that passport and verify it");
    }
    Ok(code)
}

struct Run<'a> {
    options: &'a Options,
    enquiry: Enquiry,
    administrative: AdministrativeFile,
    folder: Folder,
    /// SHA-256 of the files written so far, and the passports that they come from.
    written: HashMap<PathBuf, (String, PathBuf)>,
}

impl Run<'_> {
    /// Returns `true` if the JSON of the passports goes to standard output.
    fn prints_json(&self) -> bool {
        self.options.to.contains(&Form::Json) && self.options.out.is_none()
    }

    /// Verifies a passport, and writes its files, all or none of them.
    fn export(&mut self, path: &Path) -> Result<Answer<Value>, Failure> {
        let name = name_of(path);
        let none = format!("nothing was exported from {}", shown(path));
        let refused = |verification: &_| Failure::verdict(&none, &name, verification, &self.enquiry.question);
        let bytes = files::read_first(path, LARGEST_DOCUMENT_BYTES + 1).map_err(|error| {
            let unread = refused(&self.enquiry.unreadable(&error.to_string()));
            Failure { code: UNUSABLE, ..unread }
        })?;
        let verification = self.enquiry.verification(&name, &bytes);
        let json = exported::json(&name, sha256_hex(&bytes), &verification, self.enquiry.remarks());
        let json = serde_json::to_value(json).map_err(Failure::unusable)?;
        let answer = |value: Value, code: Code| Answer { value, text: String::new(), code };
        let Some(passport) = verification.passport() else {
            let failure = refused(&verification);
            if !self.prints_json() {
                return Err(failure);
            }
            // Its line has the checks.
            failure.complain(&failure.failed.message);
            return Ok(answer(json, REFUSED));
        };
        let files = self.files(passport.content(), &bytes, &json).map_err(|error| {
            let message = format!("{none}\n{error}");
            Failure { code: REFUSED, ..Failure::from(Failed { message, ..error }) }
        })?;
        let new = self.new_files(path, files)?;
        write_replaceable_together(&new, self.options.force.replace)?;
        let written: Vec<String> = new.iter().map(|(target, _)| name_of(target)).collect();
        for (target, text) in new {
            output::say(&format!("wrote {}", shown(&target)));
            self.written.insert(target, (sha256_hex(text.as_bytes()), path.to_owned()));
        }
        Ok(answer(if self.prints_json() { json } else { json!({ "file": name, "written": written }) }, 0))
    }

    /// Returns the files of a verified passport.
    fn files(&self, content: &Content, bytes: &[u8], json: &Value) -> Result<Vec<(PathBuf, String)>, Failed> {
        let root = self.options.out.as_deref().unwrap_or(Path::new(""));
        let stand = self.folder.stand_file(&content.stand);
        let mut files = Vec::new();
        for form in &self.options.to {
            files.push(match form {
                Form::Stand => (stand.clone(), stand_file(content)?),
                Form::Site => (root.join(format!("{}.yaml", content.site.id)), site_file(content)?),
                Form::Json if self.prints_json() => continue,
                Form::Json => {
                    let name = format!("{}-{}.json", content.site.id, content.passport.revision);
                    (stand.with_file_name(name), printable::json_line(json).map_err(Failed::unusable)? + "\n")
                }
                Form::Dcc => {
                    let dcc = dcc::of_stand(content, bytes, self.administrative.content.as_ref(), stated_languages());
                    let dcc = dcc.map_err(|problems| self.administrative.refuse(problems))?;
                    (root.join(dcc.file_name()), dcc.xml)
                }
            });
        }
        Ok(files)
    }

    /// Returns the files of one passport that are not there yet.
    fn new_files(&self, path: &Path, files: Vec<(PathBuf, String)>) -> Result<Vec<(PathBuf, String)>, Failure> {
        let advice = |failure: Failure| failure.with_advice(&format!("nothing was exported from {}", shown(path)));
        let mut new = Vec::new();
        for (target, text) in files {
            self.folder.check_place(&target).map_err(|refused| advice(Failure::refused(refused)))?;
            match self.written.get(&target) {
                Some((there, _)) if *there == sha256_hex(text.as_bytes()) => {}
                Some((_, from)) => {
                    return Err(Failure::refused(format!(
                        "{}: nothing was exported: its {} differs from that of {}; export them to different folders",
                        shown(path),
                        shown(&target),
                        shown(from)
                    )));
                }
                None if !self.options.force.replace && target.symlink_metadata().is_ok() => {
                    return Err(advice(FileError::Exists { path: target, replaceable: true }.into()));
                }
                None => new.push((target, text)),
            }
        }
        Ok(new)
    }
}
