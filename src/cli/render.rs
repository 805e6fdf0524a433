//! Verb `render`: the printed form of a verified passport.

use super::inputs::{self, Answer, Lines};
use super::options::{Force, Out, PAGE, Printed, file_or_folder};
use super::output::languages;
use super::trust_options::TrustAmong;
use super::{Code, Failure, defaults, output};
use crate::batch::{Purpose, paths};
use crate::files;
use crate::folder::Folder;
use crate::report::{PassportPage, style, verdict};
use crate::text::{Kind, name_of, shown};
use clap::Args;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Write the printed passport: one HTML file for paper, screen and phone, or a PDF
///
/// With a folder to write to, PASSPORT is a file, a quoted pattern, or a folder; a - reads a list of paths from standard input.
#[derive(Args)]
pub(super) struct Options {
    /// Passport files; in a workspace also their identifiers
    #[arg(required = true, value_name = "PASSPORT", value_parser = defaults::passport())]
    passports: Vec<PathBuf>,
    /// File for the page of one passport, where FILE.pdf is printed by an installed Chromium, Chrome or Edge; or folder for
    /// the pages of several, <model>/<serial>/<site>-<revision>.html
    #[arg(short, long, visible_alias = "output", value_name = "FILE.html|DIR", value_parser = file_or_folder(PAGE))]
    out: Out,
    #[command(flatten)]
    trust: TrustAmong,
    /// Print the signed file verbatim too; the page has it for the screen and as a download in any case
    #[arg(long)]
    annex: bool,
    /// Print the blank forms of GOST R 2.610 in any language; with --lang ru alone they are always printed
    #[arg(long)]
    forms: bool,
    #[command(flatten)]
    force: Force,
    #[command(flatten)]
    _printed: Printed,
}

/// The written page, and the verdict on its passport.
#[derive(Serialize)]
struct Rendered {
    page: String,
    #[serde(flatten)]
    verdict: verdict::Verdict,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let enquiry = options.trust.load()?;
    let write = |passport: &Path| {
        let bytes = inputs::bytes(passport, Kind::Passport.words())?;
        let name = name_of(passport);
        let mut page = PassportPage::of(&bytes, &enquiry.question, enquiry.verification(&name, &bytes))
            .map_err(|refused| Failure::verdict("no page was written", &name, &refused, &enquiry.question))?;
        (page.prints_annex, page.prints_forms) = (options.annex, options.forms);
        let verdict = verdict::Verdict::of(&name, &page.verification, &enquiry.remarks());
        let path = match &options.out {
            Out::File(path) => path.clone(),
            Out::Folder(folder) => {
                let folder = Folder::new(folder);
                let path = verdict.id.as_deref().and_then(|id| folder.path_of_id(id));
                let path = path.ok_or_else(|| Failure::refused("the passport has no identifier"))?;
                let path = path.with_extension("html");
                folder.check_place(&path).map_err(Failure::refused)?;
                path
            }
        };
        let page_bytes = output::page(&path, page.html(&languages()), options.force.replace)?;
        files::write_replaceable(&path, &page_bytes, options.force.replace)?;
        if !output::is_json() && !verdict.valid {
            let document = verdict::document(&verdict, &page.verification, &enquiry.question);
            output::say_verdict(&style::plain(&output::typed(&document)));
        }
        let so = if verdict.valid { "" } else { "; it says that the passport may not be used" };
        output::say(&format!("wrote {}{so}", shown(&path)));
        Ok::<_, Failure>(Rendered { page: name_of(&path), verdict })
    };
    if let Out::File(path) = &options.out {
        let Some(passport) = paths::one_file(&options.passports) else {
            let words = "is the page of one passport; for several specify a folder with -o DIR";
            return Err(Failure::usage(format!("{}: {words}", shown(path))));
        };
        let rendered = write(passport)?;
        return output::write(|| rendered, String::new).map(|()| 0);
    }
    let (code, _) = inputs::each(&options.passports, Purpose::Passports, Lines::or(Lines::None), |path| {
        Ok(Answer { value: write(path)?, text: String::new(), code: 0 })
    })?;
    Ok(code)
}
