//! Batch that issues revision 1 of every stand at every site, with one new register for each stand.

use super::catalogue::{Catalogue, Listed};
use super::deliveries::Terms;
use super::{Batch, Event, Failure, Listener, Outcome, Purpose, fail, parallel, paths, sweep};
use crate::files::folder_of;
use crate::files::walk::Visited;
use crate::folder::{Folder, StandFolder};
use crate::passport::content::passport_id;
use crate::passport::issue::{Issue, PreparedStand};
use crate::site::Site;
use std::collections::{BTreeMap, BTreeSet};
use std::io::BufRead;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

/// Numbers of stands and sites that are in memory at a time, beyond those that a catalogue keeps.
const STANDS_AT_ONCE: usize = 16;
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
    /// Stands and sites that belong together, by their identifiers; every stand and every site if `None`.
    pub rows: Option<&'a BTreeMap<(String, String), Terms>>,
}

impl Job<'_> {
    /// Returns what is agreed for a stand at a site, or `None` if no passport is to be issued for it.
    fn terms(&self, stand: &PreparedStand, site: &Site) -> Option<Terms> {
        let id = || (stand.stand().stand.id(), site.id.to_string());
        self.rows.map_or_else(|| Some(Terms::default()), |rows| rows.get(&id()).cloned())
    }
}

/// Stand whose passports are being issued. Their outcomes are reported once its register lists them.
struct Work<'a> {
    folder: StandFolder<'a>,
    stand: Arc<PreparedStand>,
    outcomes: Vec<Option<Outcome>>,
}

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
        let all = job.rows.map_or(stands.len() * sites.len(), BTreeMap::len);
        tell(Event::Planned(self.shard.share(all as u64)));
        let names = sites.ids().map(|id| format!("{id}-{}.yaml", job.order.revision)).collect();
        let run = Run { batch: self, job, swept: Visited::default(), names };
        if !self.is_dry() {
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
    /// Names of all files that this run writes into the folder of each stand.
    names: BTreeSet<String>,
}

impl<'a> Run<'a> {
    fn all(&self, stands: &Catalogue<PreparedStand>, sites: &Catalogue<Site>, tell: Listener) {
        // The outcomes of stands are kept until their registers are written.
        let at_once = if sites.len() > SITES_AT_ONCE { 1 } else { STANDS_AT_ONCE };
        for some_stands in ranges(stands.len(), at_once) {
            let mut stands = self.load(stands, some_stands, sites.len(), tell);
            stands.retain(|stand| self.batch.shard.has(&stand.stand().stand.id()));
            let mut works = self.open(stands, sites.len(), tell);
            for some_sites in ranges(sites.len(), SITES_AT_ONCE) {
                let sites = self.load(sites, some_sites, works.len(), tell);
                self.remark_on_misplaced(&works, &sites, tell);
                let pairs: Vec<(usize, &Site)> =
                    (0..works.len()).flat_map(|work| sites.iter().map(move |site| (work, &**site))).collect();
                let is_wanted = |(work, site): &(usize, &Site)| self.job.terms(&works[*work].stand, site).is_some();
                let pairs: Vec<_> = pairs.into_iter().filter(is_wanted).collect();
                for chunk in pairs.chunks(self.batch.chunk()) {
                    if self.batch.cancelled() {
                        break;
                    }
                    let done = parallel::map(chunk, self.batch.threads, |(work, site)| self.one(&works[*work], site));
                    for ((work, _), outcome) in chunk.iter().zip(done) {
                        match self.batch.is_dry() {
                            true => tell(Event::Done(Some(outcome))),
                            false => works[*work].outcomes.push(Some(outcome)),
                        }
                    }
                }
            }
            self.finish(works, tell);
            if self.batch.cancelled() {
                return;
            }
        }
    }

    /// Examines the folders of stands; those that contradict their certificates, or whose register is not accepted, are
    /// refused. Reports the other certificates from which stands have passports.
    fn open(&self, stands: Vec<Arc<PreparedStand>>, each_costs: usize, tell: Listener) -> Vec<Work<'a>> {
        let opened = parallel::map(&stands, self.batch.threads, |stand| {
            let (folder, authority) = (self.job.folder, &self.batch.authority);
            let id = stand.stand().stand.id();
            let folder = StandFolder::open(folder, &id, authority, |name| self.names.contains(name))?;
            folder.against_certificate(stand).map(|remarks| (folder, remarks))
        });
        let mut works = Vec::new();
        for (stand, opened) in stands.into_iter().zip(opened) {
            let id = stand.stand().stand.id();
            match opened {
                Ok((folder, remarks)) => {
                    let remark = |words| Event::Remark { file: id.clone(), words, is_warning: false };
                    remarks.into_iter().for_each(|words| tell(remark(words)));
                    works.push(Work { folder, stand, outcomes: Vec::new() });
                }
                Err(why) => self.lost(Failure::folder(id, &why), each_costs, tell),
            }
        }
        works
    }

    /// Writes the registers, and reports the outcomes.
    fn finish(&self, works: Vec<Work>, tell: Listener) {
        let (folders, mut outcomes): (Vec<_>, Vec<_>) =
            works.into_iter().map(|work| (work.folder, work.outcomes)).unzip();
        let written: Vec<&Outcome> = outcomes.iter().flatten().flatten().collect();
        let synced = self.batch.sync(written);
        let listed = parallel::map(&folders, self.batch.threads, |folder| self.batch.list(folder, &synced));
        for (outcomes, listed) in outcomes.iter_mut().zip(listed) {
            if let Err(failure) = listed {
                outcomes.iter_mut().flatten().for_each(|outcome| outcome.not_listed(&failure));
            }
        }
        outcomes.into_iter().flatten().for_each(|outcome| tell(Event::Done(outcome)));
    }

    /// Reports sites whose coordinates seem to be exchanged: compared with the others, with those of existing passports of the
    /// stands, and with the towns that their names mention.
    fn remark_on_misplaced(&self, works: &[Work], sites: &[Arc<Site>], tell: Listener) {
        const MOST: usize = 8;
        let issued = works.iter().take(MOST).flat_map(|work| work.folder.sites(MOST));
        let given = sites.iter().take(MOST).map(|site| Site::clone(site));
        let known = issued.chain(given).filter_map(|site| Some((site.id.clone(), site.place()?)));
        let known: BTreeMap<_, _> = known.collect();
        for site in sites {
            let others = known.iter().filter(|(id, _)| **id != site.id);
            let others: Vec<_> = others.map(|(id, place)| (format!("the site {id}"), *place)).collect();
            if let Some(words) = site.misplaced(&others) {
                tell(Event::Remark { file: site.id.to_string(), words, is_warning: true });
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

    /// Issues a single passport; every passport of a batch is made here.
    fn one(&self, Work { folder, stand, .. }: &Work, site: &Site) -> Outcome {
        let Terms { valid_until, customer } = self.job.terms(stand, site).unwrap_or_default();
        let of_row = valid_until.map(|day| Issue { valid_until: Some(day), ..self.job.order.clone() });
        let order = of_row.as_ref().unwrap_or(self.job.order);
        let of_customer = customer.map(|customer| {
            let mut stand = stand.stand().clone();
            stand.stand.customer = Some(customer);
            PreparedStand::new(stand)
        });
        let stand = of_customer.as_ref().unwrap_or(stand);
        if !self.batch.is_dry() {
            sweep(&self.swept, folder_of(&folder.path_of(site.id.as_str(), order.revision)));
        }
        let settled = match self.batch.is_dry() {
            false => folder.issue(stand, site, order).map(Outcome::There),
            true => folder.next_first(stand, site, order).map(Outcome::from),
        };
        let id = || passport_id(&stand.stand().stand, &site.id, order.revision);
        settled.unwrap_or_else(|why| Outcome::Failed(Failure::folder(id(), &why)))
    }
}

/// Returns `0..length` in pieces of at most `size`.
fn ranges(length: usize, size: usize) -> impl Iterator<Item = Range<usize>> {
    (0..length).step_by(size).map(move |start| start..length.min(start + size))
}
