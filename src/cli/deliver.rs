//! Verb `deliver`: what a laboratory gets, in one file.

use super::lang::{self, Lang};
use super::output::Format;
use super::trust_options::TrustOptions;
use super::{Code, Failure, defaults, inputs, output};
use crate::batch::Purpose;
use crate::delivery::{Delivery, NotDelivered, Wanted, deliver, tell};
use crate::folder::Folder;
use crate::passport::{Question, Trust};
use crate::report::doc::typed;
use crate::text::{name_of, shown};
use crate::workspace::Workspace;
use clap::Args;
use serde::Serialize;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Hand passports to a laboratory in one file: those in force, their register, the public keys, and a page with the first
/// steps; the fingerprints of the keys are printed, because they must go by another way
#[derive(Args)]
pub(super) struct Options {
    /// Stands, or one site of them
    #[arg(required_unless_present = "deliveries", value_name = "MODEL/SERIAL[/SITE]")]
    wanted: Vec<Wanted>,
    /// Instead of stands: the table of `issue --deliveries`, one archive for each row
    #[arg(long, value_name = "TABLE.csv", conflicts_with = "wanted", requires = "output")]
    deliveries: Option<PathBuf>,
    /// Folder of passports
    #[arg(long, value_name = "DIR", default_value = "passports")]
    passports: PathBuf,
    /// Archive to write; with --deliveries the folder of the archives, <model>/<serial>/<site>.zip
    #[arg(short, long, visible_alias = "out", value_name = "FILE.zip|DIR")]
    output: PathBuf,
    #[command(flatten)]
    trust: TrustOptions,
    /// Replace an existing archive
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    _lang: Lang,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let (trust, question) = options.trust.load()?;
    if let Some(table) = &options.deliveries {
        return each(options, table, &trust, &question);
    }
    let delivery = of(&options.passports, &options.wanted, &trust, &question)?;
    output::file(&options.output, &delivery.archive, options.force)?;
    options.format.show(|| &delivery, || delivery.document(&shown(&options.output).to_string()))?;
    Ok(0)
}

/// Writes an archive for each row of a table, with one line for each.
fn each(options: &Options, table: &Path, trust: &Trust, question: &Question) -> Result<Code, Failure> {
    let rows = inputs::deliveries(table)?;
    let wanted = rows.rows().map(|(stand, site)| format!("{stand}/{site}").parse::<Wanted>());
    let wanted: Vec<Wanted> = wanted.collect::<Result<_, _>>().map_err(|why| {
        Failure::unusable(format!("{}: a stand and a site are named by their identifiers here: {why}", shown(table)))
    })?;
    let mut keys = BTreeSet::new();
    let folder = Folder::new(&options.output);
    let write = |path: &Path| {
        let wanted =
            wanted.iter().filter(|wanted| path == wanted.path_in(&options.output)).cloned().collect::<Vec<_>>();
        let delivery = of(&options.passports, &wanted, trust, question)?;
        folder.check_place(path).map_err(Failure::refused)?;
        output::file(path, &delivery.archive, options.force)?;
        let name = name_of(path);
        let text = typed(&delivery.row(&name), lang::of_text());
        keys.extend(delivery.keys.iter().cloned());
        Ok(((Archive { archive: name, delivery }, text), 0))
    };
    let paths: Vec<PathBuf> = wanted.iter().map(|wanted| wanted.path_in(&options.output)).collect();
    let code = inputs::each(&paths, Purpose::Tables, write, |done| inputs::print(&done, options.format))?;
    if options.format == Format::Text {
        output::document(&tell(&keys.into_iter().collect::<Vec<_>>()))?;
    }
    Ok(code)
}

/// Archive of one row.
#[derive(Serialize)]
struct Archive {
    archive: String,
    #[serde(flatten)]
    delivery: Delivery,
}

fn of(passports: &Path, wanted: &[Wanted], trust: &Trust, question: &Question) -> Result<Delivery, Failure> {
    let memory = defaults::workspace().map(Workspace::memory);
    deliver(passports, wanted, (trust, question), memory, lang::of_text()).map_err(|refused| match refused {
        NotDelivered::File(error) => error.into(),
        NotDelivered::NotValid(name, verification) => {
            Failure::verdict("nothing was handed over", &name, &verification, question)
        }
        refused => Failure::refused(refused),
    })
}
