//! Verb `render`: the printed form of a verified passport.

use super::lang::{self, Lang};
use super::trust_options::TrustAmong;
use super::{Code, Failure, Format, defaults, inputs, output};
use crate::batch::Purpose;
use crate::folder::Folder;
use crate::report::{PassportPage, doc, style, verdict};
use crate::text::{Kind, name_of, shown};
use clap::Args;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Write the printed passport: one HTML file for paper, screen and phone, or a PDF
///
/// With --out, PASSPORT is a file, a quoted pattern, or a folder; a - reads a list of paths from standard input.
#[derive(Args)]
pub(super) struct Options {
    /// Passport files; in a workspace also their identifiers
    #[arg(required = true, value_name = "PASSPORT", value_parser = defaults::passport())]
    passports: Vec<PathBuf>,
    /// Write the page of one passport to this file; FILE.pdf is printed by an installed Chromium, Chrome or Edge
    #[arg(short, long, value_name = "FILE.html", value_parser = output::path_of(output::PAGE), required_unless_present = "out", conflicts_with = "out")]
    output: Option<PathBuf>,
    /// Folder for the pages of several passports: <model>/<serial>/<site>-<revision>.html
    #[arg(long, value_name = "DIR", value_parser = output::folder("; for one page use -o FILE.html"))]
    out: Option<PathBuf>,
    #[command(flatten)]
    trust: TrustAmong,
    #[command(flatten)]
    lang: Lang,
    /// Print the signed file verbatim too; the page has it for the screen and as a download in any case
    #[arg(long)]
    annex: bool,
    /// Print the blank forms of GOST R 2.610 in any language; with --lang ru alone they are always printed
    #[arg(long)]
    forms: bool,
    /// Replace an existing page
    #[arg(long)]
    force: bool,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
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
    let folder = options.out.as_deref().map(Folder::new);
    let write = |passport: &Path, output: Option<&Path>| {
        let bytes = inputs::bytes(passport, Kind::Passport.words())?;
        let name = name_of(passport);
        let mut page = PassportPage::of(&bytes, &enquiry.question, enquiry.verification(&name, &bytes))
            .map_err(|refused| Failure::verdict("no page was written", &name, &refused, &enquiry.question))?;
        (page.prints_annex, page.prints_forms) = (options.annex, options.forms);
        let verdict = verdict::Verdict::of(&name, &page.verification, &enquiry.remarks());
        let in_folder = || Some(folder.as_ref()?.path_of_id(verdict.id.as_deref()?)?.with_extension("html"));
        let output = output.map(Path::to_owned).or_else(in_folder);
        let output = output.ok_or_else(|| Failure::usage("missing -o FILE.html or --out DIR"))?;
        folder.iter().try_for_each(|folder| folder.check_place(&output)).map_err(Failure::refused)?;
        let html = page.html(&options.lang.languages());
        output::file(&output, output::page(&output, html, options.force)?, options.force)?;
        if options.format == Format::Text && !verdict.valid {
            let document = verdict::document(&verdict, &page.verification, &enquiry.question);
            output::say_verdict(&style::plain(&doc::typed(&document, lang::of_text())));
        }
        let so = if verdict.valid { "" } else { "; it says that the passport may not be used" };
        output::say(&format!("wrote {}{so}", shown(&output)));
        Ok(Rendered { page: name_of(&output), verdict })
    };
    let Some(output) = &options.output else {
        let write = |passport: &Path| write(passport, None).map(|rendered| (rendered, 0));
        let mut results = Vec::new();
        let code = inputs::each(&options.passports, Purpose::Passports, write, |rendered| {
            results.push(rendered);
            Ok(())
        })?;
        if options.format != Format::Text {
            options.format.json(&results)?;
        }
        return Ok(code);
    };
    let [passport] = options.passports.as_slice() else {
        return Err(Failure::usage("-o FILE.html is for one passport; give --out DIR for several"));
    };
    if passport.is_dir() {
        let words = "found a folder, but -o FILE.html is for one passport; give --out DIR for those in it";
        return Err(Failure::usage(format!("{}: {words}", shown(passport))));
    }
    let rendered = write(passport, Some(output))?;
    if options.format != Format::Text {
        options.format.json(&rendered)?;
    }
    Ok(0)
}
