//! Common part of `issue` and `reissue`: running a batch and reporting its progress.

use super::key_options::{IssuerOptions, Keys};
use super::options::{Tabular, Threads};
use super::output::{Format, language};
use super::{Code, Failure, REFUSED, UNUSABLE, interrupt, long_run, output};
use crate::batch::shard::Shard;
use crate::batch::{Batch, Event, Listener, Outcome};
use crate::files::{self, Durability};
use crate::folder::Folder;
use crate::parallel;
use crate::passport::{NAMESPACE, Trust};
use crate::report::issued::{Report, Reports, Told, failure};
use crate::text::{LARGEST_DOCUMENT_BYTES, shown};
use crate::trust::{AllowedSigners, NotAuthorised, PublicKey};
use clap::Args;
use indicatif::{ProgressBar, ProgressDrawTarget};
use jiff::Timestamp;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

#[derive(Args)]
pub(super) struct BatchOptions {
    #[command(flatten)]
    pub issuer: IssuerOptions,
    /// Process only the stands of part K of N; the parts are disjoint and together complete
    #[arg(long, value_name = "K/N")]
    shard: Option<Shard>,
    /// Issue even if the positions of the stand do not determine the parameters of a gyro
    #[arg(long)]
    pub allow_uncalibratable: bool,
    /// Do not sync to disk: faster, but a power failure may lose files
    #[arg(long)]
    no_sync: bool,
    #[command(flatten)]
    threads: Threads,
    #[command(flatten)]
    _printed: Tabular,
}

impl BatchOptions {
    /// Warns if a file `allowed_signers` next to the key gives the key to another identity. The file is not trusted:
    /// without `--trust` nothing depends on it.
    pub(super) fn warn_of_other_identity(&self, public: &PublicKey, issued_at: Timestamp) {
        let Some(key) = &self.issuer.signing.key else { return };
        let path = files::folder_of(key).join("allowed_signers");
        let Ok(bytes) = files::read(&path, LARGEST_DOCUMENT_BYTES) else { return };
        let Ok(signers) = AllowedSigners::parse("allowed_signers", &bytes) else { return };
        if signers.lines().iter().any(|line| line.key == *public) {
            self.warn_unless_authorised(&signers, public, issued_at, &shown(&path).to_string());
        }
    }

    /// Warns if `signers`, described by `source`, do not give the key to the identity.
    pub(super) fn warn_unless_authorised(
        &self,
        signers: &AllowedSigners,
        public: &PublicKey,
        issued_at: Timestamp,
        source: &str,
    ) {
        let who = self.issuer.signing.identity();
        if let Err(miss) = signers.authorise(public, who, NAMESPACE, issued_at) {
            let refuse = "laboratories with that list will refuse the new passports";
            output::warn(&match miss {
                NotAuthorised::UnknownKey => format!(
                    "--identity {who}: the list of trusted keys ({source}) does not contain the signing key; {refuse}; use a \
                     listed key, or add the line of this key"
                ),
                miss => format!(
                    "--identity {who}: {miss} (according to {source}); {refuse}; use the identity of this key, or another key"
                ),
            });
        }
    }

    pub(super) fn folder(&self, root: &Path) -> Folder {
        Folder::new(root).with_durability(self.durability())
    }

    fn durability(&self) -> Durability {
        if self.no_sync { Durability::None } else { Durability::NameLater }
    }

    /// Runs a batch and reports each outcome as it occurs.
    pub(super) fn run(&self, keys: &Keys, trust: &Trust, work: impl FnOnce(&Batch, Listener)) -> Result<Code, Failure> {
        let cancel = interrupt::cancelled_by_ctrl_c()?;
        let batch = Batch {
            durability: self.durability(),
            authority: keys.authority(trust),
            shard: self.shard.unwrap_or(Shard::WHOLE),
            threads: self.threads.or(parallel::processors()),
            cancel: Some(&cancel),
        };
        let mut reporter = Reporter::new(Arc::clone(&cancel))?;
        work(&batch, &mut |event| reporter.hear(event));
        let code = reporter.end()?;
        keys.say_without_register();
        Ok(code)
    }
}

/// Reporter of a batch: reports on standard output, messages and a progress bar on standard error.
struct Reporter {
    reports: Reports,
    told: Told,
    /// Messages of failures whose reports are held back, so that the verdict comes first.
    held: Vec<String>,
    bar: ProgressBar,
    code: Code,
    cancel: Arc<AtomicBool>,
    unwritten: Option<Failure>,
}

impl Reporter {
    fn new(cancel: Arc<AtomicBool>) -> Result<Self, Failure> {
        let bar = long_run::bar(0, "passports")?;
        bar.set_draw_target(ProgressDrawTarget::hidden());
        Ok(Self {
            reports: Reports::new(output::format(), language()),
            told: Told::new(language()),
            held: Vec::new(),
            bar,
            code: 0,
            cancel,
            unwritten: None,
        })
    }

    fn hear(&mut self, event: Event) {
        match event {
            Event::Planned(more) => {
                if more > 0 && self.bar.is_hidden() {
                    self.bar.set_draw_target(long_run::target());
                }
                self.bar.inc_length(more);
            }
            Event::Remark { file, words, is_warning } => self.told.add(&file, words, is_warning),
            Event::Done(outcome) => {
                // An input that cannot be used is not one of the passports.
                let is_input = matches!(&outcome, Outcome::Failed(failure) if failure.passports.is_some());
                self.outcome(&outcome);
                self.bar.inc(u64::from(!is_input));
            }
        }
    }

    fn outcome(&mut self, outcome: &Outcome) {
        if let Some((id, remarks)) = outcome.remarks() {
            self.told.add_all(id, remarks);
        }
        if let Outcome::Failed(failed) = outcome {
            self.code = self.code.max(if failed.unusable { UNUSABLE } else { REFUSED });
            self.held.push(failure(failed));
        }
        let text = self.reports.add(Report::of(outcome));
        self.write(&text);
        if !self.reports.holds() {
            self.complain();
        }
    }

    fn complain(&mut self) {
        self.bar.suspend(|| self.held.drain(..).for_each(|words| output::complain(&words)));
    }

    /// Writes a report. A failure ends the batch, because the user would not know what was issued.
    fn write(&mut self, text: &str) {
        if text.is_empty() || self.unwritten.is_some() {
            return;
        }
        let out = if output::format() == Format::Text { output::text } else { output::result };
        if let Err(failure) = self.bar.suspend(|| out(text)) {
            self.unwritten = Some(failure);
            self.cancel.store(true, Ordering::Relaxed);
        }
    }

    fn end(mut self) -> Result<Code, Failure> {
        self.bar.finish_and_clear();
        if self.reports.is_empty() && self.code == 0 {
            output::say("found no passport to issue; check the folder and the options that select passports");
        }
        let text = self.reports.end();
        self.write(&text);
        self.complain();
        self.told.lines(output::is_quiet()).iter().for_each(|line| output::complain(line));
        if let Some(failure) = self.unwritten {
            return Err(failure);
        }
        if self.cancel.load(Ordering::Relaxed) {
            output::complain("interrupted; to complete the job, run the same command again");
            self.code = self.code.max(REFUSED);
        }
        Ok(self.code)
    }
}
