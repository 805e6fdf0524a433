//! Batch that issues revision 1 of every stand at every site.

use super::catalogue::{Catalogue, Listed};
use super::{Batch, Event, Failure, Listener, Outcome, Purpose, fail, parallel, paths, sweep};
use crate::files::folder_of;
use crate::files::walk::Visited;
use crate::folder::{Folder, search};
use crate::passport::Trust;
use crate::passport::content::passport_id;
use crate::passport::issue::{Issue, PreparedStand};
use crate::site::Site;
use jiff::Timestamp;
use std::collections::BTreeMap;
use std::io::BufRead;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

/// Numbers of stands and sites that are in memory at a time, beyond those that a catalogue keeps.
const STANDS_AT_ONCE: usize = 64;
const SITES_AT_ONCE: usize = 1024;

/// Input and destination of a batch.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Job<'a> {
    pub folder: &'a Folder,
    /// Stands: files, folders and patterns, as in `paths`.
    pub stands: &'a [PathBuf],
    /// Sites: files, folders and patterns, as in `paths`.
    pub sites: &'a [PathBuf],
    /// Order that all passports have in common.
    pub order: &'a Issue,
    /// Trust and time by which existing passports are verified; `None` to skip that.
    pub known: Option<(&'a Trust, Timestamp)>,
}

/// Stand and site of one passport to be issued.
type Pair = (Arc<PreparedStand>, Arc<Site>);

impl Batch<'_> {
    /// Issues a passport of every stand for every site.
    ///
    /// All files are read first, so that every error in them is reported before anything is signed. An unusable file
    /// costs only its own passports. A stand whose passports state other angles under the
    /// number of its certificate is refused; one with passports from another certificate is remarked upon.
    pub(crate) fn issue(&self, job: &Job, list: &mut dyn BufRead, tell: Listener) {
        let (stands, bad_stands) = Catalogue::read(paths::files(job.stands, list, Purpose::Stands), self.threads, tell);
        let (sites, bad_sites) = Catalogue::read(paths::files(job.sites, list, Purpose::Sites), self.threads, tell);
        let bad_files = bad_sites.iter().filter(|failure| failure.passports.is_none()).count();
        let all_sites = (sites.len() + bad_files) as u64;
        fail(bad_stands, all_sites, tell);
        fail(bad_sites, stands.len() as u64, tell);
        tell(Event::Planned(self.shard.share((stands.len() * sites.len()) as u64)));
        let mut run = Run { batch: self, job, swept: Visited::default(), pairs: Vec::new(), unusable: BTreeMap::new() };
        if self.seal.is_some() {
            sweep(&run.swept, job.folder.root());
        }
        run.all(&stands, &sites, tell);
    }
}

struct Run<'a> {
    batch: &'a Batch<'a>,
    job: &'a Job<'a>,
    /// Folders from which the leftovers of killed runs were removed.
    swept: Visited,
    pairs: Vec<Pair>,
    /// Passports that may not be used, by folder and SHA-256: each folder is read once, and only if something was there.
    unusable: BTreeMap<PathBuf, BTreeMap<String, String>>,
}

impl Run<'_> {
    /// Issues stand by stand, and site by site for each; if there are too many sites for the memory, in groups of both.
    fn all(&mut self, stands: &Catalogue<PreparedStand>, sites: &Catalogue<Site>, tell: Listener) {
        for some_stands in ranges(stands.len(), STANDS_AT_ONCE) {
            let loaded_stands = self.load(stands, some_stands, sites.len(), tell);
            let loaded_stands = self.without_contradictions(loaded_stands, sites.len(), tell);
            for some_sites in ranges(sites.len(), SITES_AT_ONCE) {
                let loaded_sites = self.load(sites, some_sites, loaded_stands.len(), tell);
                self.remark_on_misplaced(&loaded_stands, &loaded_sites, tell);
                for stand in &loaded_stands {
                    let id = stand.stand().stand.id();
                    for site in loaded_sites.iter().filter(|site| self.batch.shard.has(&id, site.id.as_str())) {
                        self.pairs.push((Arc::clone(stand), Arc::clone(site)));
                        if self.pairs.len() == self.batch.chunk() {
                            self.chunk(tell);
                        }
                        if self.batch.cancelled() {
                            return;
                        }
                    }
                }
            }
        }
        self.chunk(tell);
    }

    /// Returns the stands whose existing passports do not contradict their certificates; the others are refused. Reports
    /// the other certificates from which stands have passports.
    fn without_contradictions(
        &self,
        stands: Vec<Arc<PreparedStand>>,
        each_costs: usize,
        tell: Listener,
    ) -> Vec<Arc<PreparedStand>> {
        let Some((trust, time)) = self.job.known else { return stands };
        let found =
            parallel::map(&stands, self.batch.threads, |stand| self.job.folder.against_certificate(stand, trust, time));
        let mut good = Vec::new();
        for (stand, found) in stands.into_iter().zip(found) {
            let id = stand.stand().stand.id();
            match found {
                Ok(remarks) => {
                    remarks.into_iter().for_each(|words| tell(Event::Remark { file: id.clone(), words }));
                    good.push(stand);
                }
                Err(why) => self.lost(Failure::of(id, why.to_string(), why.is_unusable()), each_costs, tell),
            }
        }
        good
    }

    /// Reports sites whose coordinates seem to be exchanged: compared with the others, with those of existing passports of the
    /// stands, and with the towns that their names mention.
    fn remark_on_misplaced(&self, stands: &[Arc<PreparedStand>], sites: &[Arc<Site>], tell: Listener) {
        const MOST: usize = 8;
        let issued = stands.iter().take(MOST).flat_map(|stand| self.job.folder.sites_of(&stand.stand().stand, MOST));
        let given = sites.iter().take(MOST).map(|site| Site::clone(site));
        let known = issued.chain(given).filter_map(|site| Some((site.id.clone(), site.place()?)));
        let known: BTreeMap<_, _> = known.collect();
        for site in sites {
            let others = known.iter().filter(|(id, _)| **id != site.id);
            let others: Vec<_> = others.map(|(id, place)| (format!("the site {id}"), *place)).collect();
            if let Some(words) = site.misplaced(&others) {
                tell(Event::Remark { file: site.id.to_string(), words: format!("WARNING: {words}") });
            }
        }
    }

    /// Reports a failure that costs passports already counted as planned.
    fn lost(&self, failure: Failure, each_costs: usize, tell: Listener) {
        fail(vec![failure], each_costs as u64, tell);
        tell(Event::Lost(self.batch.shard.share(each_costs as u64)));
    }

    /// Loads the documents at `places`, and reports files that have become unusable since they were first read.
    fn load<T: Listed>(
        &self,
        catalogue: &Catalogue<T>,
        places: Range<usize>,
        each_costs: usize,
        tell: Listener,
    ) -> Vec<Arc<T>> {
        let mut good = Vec::new();
        for loaded in catalogue.load(places, self.batch.threads) {
            match loaded {
                Ok(value) => good.push(value),
                Err(failure) => self.lost(failure, each_costs, tell),
            }
        }
        good
    }

    fn chunk(&mut self, tell: Listener) {
        let done = parallel::map(&self.pairs, self.batch.threads, |pair| Some(self.one(pair)));
        self.pairs.clear();
        for outcome in done.iter().flatten() {
            self.remark_on_unusable(outcome, tell);
        }
        self.batch.tell(done, tell);
    }

    /// Issues a single passport; every passport of a batch is made here.
    fn one(&self, (stand, site): &Pair) -> Outcome {
        let Job { folder, order, .. } = self.job;
        if self.batch.seal.is_some() {
            sweep(&self.swept, folder_of(&folder.path_of(&stand.stand().stand, &site.id, order.revision)));
        }
        let id = || passport_id(&stand.stand().stand, &site.id, order.revision);
        self.batch.settle(folder, id, || folder.next_first(stand, site, order))
    }

    /// Reports a passport that was there already and may not be used.
    fn remark_on_unusable(&mut self, outcome: &Outcome, tell: Listener) {
        let (Outcome::There(there), Some((trust, time))) = (outcome, self.job.known) else { return };
        if there.new {
            return;
        }
        let folder = folder_of(&there.path);
        let read = || search::unusable(folder, trust, time, self.batch.threads);
        let unusable = self.unusable.entry(folder.to_owned()).or_insert_with(read);
        if let Some(words) = unusable.get(&there.sha256) {
            tell(Event::Remark { file: there.id.clone(), words: words.clone() });
        }
    }
}

/// Returns `0..length` in pieces of at most `size`.
fn ranges(length: usize, size: usize) -> impl Iterator<Item = Range<usize>> {
    (0..length).step_by(size).map(move |start| start..length.min(start + size))
}
