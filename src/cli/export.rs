//! Verb `export`: verified passports in other forms: stand and site files, JSON, and a DCC.

use super::inputs::{AdministrativeFile, Each};
use super::lang::Lang;
use super::trust_options::{Enquiry, TrustAmong};
use super::{Code, Failure, Format, REFUSED, UNUSABLE, defaults, output};
use crate::batch::{Purpose, paths};
use crate::dcc;
use crate::document::sha256_hex;
use crate::files::together::write_replaceable_together;
use crate::files::{self, FileError};
use crate::folder::Folder;
use crate::interface::Failed;
use crate::parallel;
use crate::passport::export::{site_file, stand_file};
use crate::passport::{Content, Verification};
use crate::report::exported;
use crate::text::{LARGEST_DOCUMENT_BYTES, name_of, printable, shown};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Number of passports that are verified at a time.
const AT_ONCE: usize = 256;

/// Export verified passports as stand and site files, as JSON, or as a Digital Calibration Certificate
///
/// PASSPORT is a file, a quoted pattern, or a folder; a - reads a list of paths from standard input. Files are written
/// to DIR/<model>/<serial>/stand.yaml, DIR/<site id>.yaml, DIR/<model>/<serial>/<site id>-<revision>.json and
/// DIR/<number of the certificate>.xml.
#[derive(Args)]
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
    #[arg(short, long, visible_alias = "output", value_name = "DIR", value_parser = output::folder("; the program names the files in it"))]
    out: Option<PathBuf>,
    /// Administrative data of the DCC that no passport states (dtg-dcc/1); `new dcc` writes a template
    #[arg(long, value_name = "FILE")]
    administrative: Option<PathBuf>,
    #[command(flatten)]
    lang: Lang,
    /// Replace existing files
    #[arg(long)]
    force: bool,
    /// Output format of what was written, with a line for each passport
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
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
    if !options.to.contains(&Form::Dcc) && (options.administrative.is_some() || options.lang.stated().is_some()) {
        return Err(Failure::usage("--administrative and --lang are for a DCC; add --to dcc, or omit them"));
    }
    let enquiry = options.trust.load()?;
    let administrative = AdministrativeFile::read(options.administrative.as_deref())?;
    let folder = Folder::new(options.out.as_deref().unwrap_or(Path::new("")));
    let written = HashMap::new();
    let mut run = Run { options, enquiry, administrative, folder, written, code: 0, next: Vec::new() };
    let mut list = std::io::stdin().lock();
    for found in paths::files(&options.passports, &mut list, Purpose::Passports) {
        match found {
            Ok(path) => run.push(path)?,
            Err(failed) => run.failed(failed.what.clone(), Failure::input(&failed), false)?,
        }
    }
    run.chunk()?;
    if options.to.contains(&Form::Dcc) && !run.written.is_empty() {
        output::say("the DCC is not signed; only the passport in it is: save that passport and verify it");
    }
    Ok(run.code)
}

/// Passport in the requested forms.
struct Exported {
    path: PathBuf,
    verification: Verification,
    /// Files to write, by their paths.
    files: Result<Vec<(PathBuf, String)>, Failed>,
    /// Line for standard output, if JSON goes there.
    line: Option<String>,
    /// `true` if the passport could not be read at all.
    unread: bool,
}

struct Run<'a> {
    options: &'a Options,
    enquiry: Enquiry,
    administrative: AdministrativeFile,
    folder: Folder,
    /// SHA-256 of the files written so far, and the passports that they come from.
    written: HashMap<PathBuf, (String, PathBuf)>,
    code: Code,
    next: Vec<PathBuf>,
}

impl Run<'_> {
    fn push(&mut self, path: PathBuf) -> Result<(), Failure> {
        self.next.push(path);
        if self.next.len() == AT_ONCE { self.chunk() } else { Ok(()) }
    }

    /// Reports the failure of one passport; the others are exported nevertheless. With `has_line`, the line of the passport,
    /// with its checks, is already on standard output.
    fn failed(&mut self, file: String, failure: Failure, has_line: bool) -> Result<(), Failure> {
        failure.complain(&failure.failed.message);
        self.code = self.code.max(failure.code);
        if has_line || self.options.format == Format::Text {
            return Ok(());
        }
        output::json_line(&Each::<Value>::Refused { file, refusal: failure.failed })
    }

    fn chunk(&mut self) -> Result<(), Failure> {
        let paths = std::mem::take(&mut self.next);
        let exported = parallel::map(&paths, parallel::processors(), |path| self.export(path));
        let mut lines = String::new();
        for exported in exported {
            let exported = exported?;
            lines.extend(exported.line.as_deref());
            self.write(&exported)?;
        }
        output::result(&lines)
    }

    fn export(&self, path: &Path) -> Result<Exported, Failure> {
        let name = name_of(path);
        let (bytes, verification, unread) = match files::read_first(path, LARGEST_DOCUMENT_BYTES + 1) {
            Ok(bytes) => {
                let verification = self.enquiry.verification(&name, &bytes);
                (bytes, verification, false)
            }
            Err(error) => (Vec::new(), self.enquiry.unreadable(&error.to_string()), true),
        };
        let to = |form: Form| self.options.to.contains(&form);
        let json = || {
            let node = exported::json(&name, sha256_hex(&bytes), &verification);
            printable::json_line(&node).map(|line| line + "\n").map_err(Failure::unusable)
        };
        let json = if to(Form::Json) && !unread { Some(json()?) } else { None };
        let passport = verification.passport();
        let content = passport.as_ref().map(|passport| passport.content());
        let files = content.map_or_else(|| Ok(Vec::new()), |content| self.files(content, &bytes, json.as_deref()));
        let line = json.filter(|_| self.options.out.is_none());
        Ok(Exported { path: path.to_owned(), verification, files, line, unread })
    }

    /// Returns the files of a verified passport.
    fn files(&self, content: &Content, bytes: &[u8], json: Option<&str>) -> Result<Vec<(PathBuf, String)>, Failed> {
        let root = self.options.out.as_deref().unwrap_or(Path::new(""));
        let stand = self.folder.stand_file(&content.stand);
        let mut files = Vec::new();
        if self.options.to.contains(&Form::Stand) {
            files.push((stand.clone(), stand_file(content)?));
        }
        if self.options.to.contains(&Form::Site) {
            files.push((root.join(format!("{}.yaml", content.site.id)), site_file(content)?));
        }
        if let Some(json) = json.filter(|_| self.options.out.is_some()) {
            let name = format!("{}-{}.json", content.site.id, content.passport.revision);
            files.push((stand.with_file_name(name), json.to_owned()));
        }
        if self.options.to.contains(&Form::Dcc) {
            let lang = self.options.lang.stated();
            let dcc = dcc::of_stand(content, bytes, self.administrative.content.as_ref(), lang.as_ref());
            let dcc = dcc.map_err(|problems| self.administrative.refuse(problems))?;
            files.push((root.join(dcc.file_name()), dcc.xml));
        }
        Ok(files)
    }

    /// Writes the files of one passport, all or none of them.
    fn write(&mut self, exported: &Exported) -> Result<(), Failure> {
        let Exported { path, verification, files, unread, line } = exported;
        let name = name_of(path);
        if !verification.valid() {
            let failure = Failure::verdict(
                &format!("nothing was exported from {}", shown(path)),
                &name,
                verification,
                &self.enquiry.question,
            );
            let failure = Failure { code: if *unread { UNUSABLE } else { REFUSED }, ..failure };
            return self.failed(name, failure, line.is_some());
        }
        let new = match self.new_files(path, files.as_ref()) {
            Ok(new) => new,
            Err(failure) => return self.failed(name, failure, false),
        };
        write_replaceable_together(&new, self.options.force)?;
        let written: Vec<String> = new.iter().map(|(target, _)| name_of(target)).collect();
        for (target, text) in new {
            output::say(&format!("wrote {}", shown(&target)));
            self.written.insert(target, (sha256_hex(text.as_bytes()), path.clone()));
        }
        if line.is_some() || self.options.format == Format::Text {
            return Ok(());
        }
        output::json_line(&json!({ "file": name, "written": written }))
    }

    /// Returns the files of one passport that are not there yet.
    fn new_files(
        &self,
        path: &Path,
        files: Result<&Vec<(PathBuf, String)>, &Failed>,
    ) -> Result<Vec<(PathBuf, String)>, Failure> {
        let files = files.map_err(|error| {
            let message = format!("nothing was exported from {}\n{error}", shown(path));
            Failure { code: REFUSED, ..Failure::from(Failed { message, ..error.clone() }) }
        })?;
        let advice = |failure: Failure| failure.with_advice(&format!("nothing was exported from {}", shown(path)));
        let mut new = Vec::new();
        for (target, text) in files {
            self.folder.check_place(target).map_err(|refused| advice(Failure::refused(refused)))?;
            let sha256 = sha256_hex(text.as_bytes());
            match self.written.get(target) {
                Some((there, _)) if *there == sha256 => {}
                Some((_, from)) => {
                    return Err(Failure::refused(format!(
                        "{}: nothing was exported: its {} differs from that of {}; export them to different folders",
                        shown(path),
                        shown(target),
                        shown(from)
                    )));
                }
                None if !self.options.force && target.symlink_metadata().is_ok() => {
                    return Err(advice(FileError::Exists { path: target.clone(), replaceable: true }.into()));
                }
                None => new.push((target.clone(), text.clone())),
            }
        }
        Ok(new)
    }
}
