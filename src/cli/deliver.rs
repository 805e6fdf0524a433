//! Verb `deliver`: what a laboratory gets, in one file.

use super::inputs::{self, Answer, Lines};
use super::options::{ARCHIVE, Force, Out, Printed, file_or_folder};
use super::output::language;
use super::trust_options::TrustOptions;
use super::{Code, Failure, open_workspace, output};
use crate::batch::Purpose;
use crate::delivery::{Delivery, NotDelivered, Wanted, deliver, tell};
use crate::files;
use crate::folder::Folder;
use crate::passport::{Question, Trust};
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
    #[arg(long, value_name = "TABLE.csv", conflicts_with = "wanted")]
    deliveries: Option<PathBuf>,
    /// Folder of passports
    #[arg(long, value_name = "DIR", default_value = "passports")]
    passports: PathBuf,
    /// Archive to write; with --deliveries the folder of the archives, <model>/<serial>/<site>.zip
    #[arg(short, long, visible_alias = "output", value_name = "FILE.zip|DIR", value_parser = file_or_folder(ARCHIVE))]
    out: Out,
    #[command(flatten)]
    trust: TrustOptions,
    #[command(flatten)]
    force: Force,
    #[command(flatten)]
    _printed: Printed,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let (trust, question) = options.trust.load()?;
    match (&options.deliveries, &options.out) {
        (Some(table), Out::Folder(folder)) => each(options, (table, folder), &trust, &question),
        (Some(_), Out::File(path)) => Err(Failure::usage(format!(
            "{}: is one archive, but --deliveries writes one for each row; specify a folder with -o DIR",
            shown(path)
        ))),
        (None, Out::Folder(folder)) => Err(Failure::usage(format!(
            "{}: is a folder, but this is one archive; specify it with -o FILE.zip",
            shown(folder)
        ))),
        (None, Out::File(path)) => {
            let delivery = of(&options.passports, &options.wanted, &trust, &question)?;
            files::write_replaceable(path, &delivery.archive, options.force.replace)?;
            output::show(|| &delivery, || delivery.document(&shown(path).to_string()))?;
            Ok(0)
        }
    }
}

/// Writes an archive for each row of a table, with one line for each.
fn each(options: &Options, (table, out): (&Path, &Path), trust: &Trust, question: &Question) -> Result<Code, Failure> {
    let rows = inputs::deliveries(table)?;
    let wanted = rows.rows().map(|(stand, site)| format!("{stand}/{site}").parse::<Wanted>());
    let wanted: Vec<Wanted> = wanted.collect::<Result<_, _>>().map_err(|why| {
        Failure::unusable(format!("{}: a stand and a site are named by their identifiers here: {why}", shown(table)))
    })?;
    let mut keys = BTreeSet::new();
    let folder = Folder::new(out);
    let write = |path: &Path| {
        let wanted = wanted.iter().filter(|wanted| path == wanted.path_in(out)).cloned().collect::<Vec<_>>();
        let delivery = of(&options.passports, &wanted, trust, question)?;
        folder.check_place(path).map_err(Failure::refused)?;
        files::write_replaceable(path, &delivery.archive, options.force.replace)?;
        let name = name_of(path);
        let text = output::typed(&delivery.row(&name));
        keys.extend(delivery.keys.iter().cloned());
        Ok(Answer { value: Archive { archive: name, delivery }, text, code: 0 })
    };
    let paths: Vec<PathBuf> = wanted.iter().map(|wanted| wanted.path_in(out)).collect();
    let (code, _) = inputs::each(&paths, Purpose::Tables, Lines::or(Lines::Text), write)?;
    if !output::is_json() {
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
    let memory = open_workspace::workspace().map(Workspace::memory).cloned();
    deliver(passports, wanted, (trust, question), memory, language()).map_err(|refused| match refused {
        NotDelivered::File(error) => error.into(),
        NotDelivered::NotValid(name, verification) => {
            Failure::verdict("nothing was handed over", &name, &verification, question)
        }
        refused => Failure::refused(refused),
    })
}
