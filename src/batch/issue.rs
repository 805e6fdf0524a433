//! Batch that issues revision 1 of every stand at every site, with one new register for each stand.

use super::catalogue::Catalogue;
use super::deliveries::Terms;
use super::{Batch, Event, Failure, Listener, Outcome, Settled, fail, parallel};
use crate::folder::{Folder, StandFolder};
use crate::passport::content::passport_id;
use crate::passport::issue::{Issue, PreparedStand};
use crate::site::Site;
use crate::stand::Stand;
use std::collections::{BTreeMap, BTreeSet};
use std::io::BufRead;
use std::path::PathBuf;

/// Number of passports that are issued side by side, if they are of several stands: their outcomes are kept until the
/// registers of the stands are written.
const AT_ONCE: usize = 1024;

/// Number of sites, and of stands with existing passports, with which the coordinates of a site are compared.
const COMPARED: usize = 8;

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

impl Batch<'_> {
    /// Issues a passport of every stand for every site.
    ///
    /// All files are read first, so that every error in them is reported before anything is signed. An unusable file
    /// costs only its own passports. A stand whose passports state other angles under the
    /// number of its certificate is refused; one with passports from another certificate is remarked upon.
    pub(crate) fn issue(&self, job: &Job, list: &mut dyn BufRead, tell: Listener) {
        let (stands, bad_stands) = Catalogue::<Stand>::read(job.stands, list, self.threads, tell);
        let (sites, bad_sites) = Catalogue::<Site>::read(job.sites, list, self.threads, tell);
        let bad_files = bad_sites.iter().filter(|failure| failure.passports.is_none()).count();
        fail(bad_stands, (sites.documents.len() + bad_files) as u64, tell);
        fail(bad_sites, stands.documents.len() as u64, tell);
        let names = sites.ids().map(|id| format!("{id}-{}.yaml", job.order.revision)).collect();
        let mut stands = stands.documents;
        stands.retain(|stand| self.shard.has(&stand.stand.id()));
        let run = Run { batch: self, job, sites: sites.documents, names };
        tell(Event::Planned(stands.iter().map(|stand| run.orders(stand, &run.sites).count() as u64).sum()));
        // A dry run writes no register, so the outcomes of a stand at many sites need not be kept.
        let sites_at_once = if self.is_dry() { AT_ONCE.min(run.sites.len()) } else { run.sites.len() }.max(1);
        let parts = stands.iter().enumerate().flat_map(|(place, stand)| {
            let parts = run.sites.chunks(sites_at_once).enumerate();
            parts.map(move |(part, sites)| Part { place, stand, sites, is_first: part == 0 })
        });
        let parts: Vec<Part> = parts.collect();
        self.each_stand(&parts, (AT_ONCE / sites_at_once).max(1), |part, threads| run.part(part, threads), tell);
    }
}

/// Stand, the sites for which it gets passports, and its place among the stands.
struct Part<'a> {
    place: usize,
    stand: &'a Stand,
    sites: &'a [Site],
    is_first: bool,
}

struct Run<'a> {
    batch: &'a Batch<'a>,
    job: &'a Job<'a>,
    sites: Vec<Site>,
    /// Names of all files that this run writes into the folder of each stand.
    names: BTreeSet<String>,
}

impl Run<'_> {
    /// Returns the sites at which a passport of a stand is to be issued, each with what is agreed for it.
    fn orders<'s>(&self, stand: &Stand, sites: &'s [Site]) -> impl Iterator<Item = (&'s Site, Terms)> {
        let id = stand.stand.id();
        sites.iter().filter_map(move |site| match self.job.rows {
            Some(rows) => Some((site, rows.get(&(id.clone(), site.id.to_string()))?.clone())),
            None => Some((site, Terms::default())),
        })
    }

    /// Issues the passports of one stand and writes its register. A stand that contradicts its certificate, or whose
    /// register is not accepted, is refused.
    fn part(&self, part: &Part, threads: usize) -> Vec<Event> {
        let id = part.stand.stand.id();
        let stand = PreparedStand::new(part.stand.clone());
        let opened = StandFolder::open(self.job.folder, &id, &self.batch.authority, |name| self.names.contains(name));
        let (folder, others) =
            match opened.and_then(|folder| folder.against_certificate(&stand).map(|others| (folder, others))) {
                Ok(opened) => opened,
                Err(_) if !part.is_first => return Vec::new(),
                Err(why) => {
                    let passports = self.orders(part.stand, &self.sites).count() as u64;
                    let failure = Failure { passports: Some(passports), ..Failure::folder(id, &why) };
                    return vec![Event::Done(Outcome::Failed(failure))];
                }
            };
        let remark = |words| Event::Remark { file: id.clone(), words, is_warning: false };
        let mut events: Vec<Event> = others.into_iter().map(remark).collect();
        if part.place < COMPARED && part.is_first {
            events.extend(self.misplaced(&folder));
        }
        let orders: Vec<(&Site, Terms)> = self.orders(part.stand, part.sites).collect();
        let settled = parallel::map(&orders, threads, |(site, terms)| {
            (!self.batch.cancelled()).then(|| Settled::from(self.one(&folder, &stand, site, terms)))
        });
        events.extend(self.batch.finish(&folder, settled.into_iter().flatten().collect()));
        events
    }

    /// Returns warnings of sites whose coordinates seem to be exchanged: compared with the others, with those of existing
    /// passports of a stand, and with the towns that their names mention.
    fn misplaced(&self, folder: &StandFolder) -> Vec<Event> {
        let known = folder.sites(COMPARED).into_iter().chain(self.sites.iter().take(COMPARED).cloned());
        let known: BTreeMap<_, _> = known.filter_map(|site| Some((site.id.clone(), site.place()?))).collect();
        let warning = |site: &Site| {
            let others = known.iter().filter(|(id, _)| **id != site.id);
            let others: Vec<_> = others.map(|(id, place)| (format!("the site {id}"), *place)).collect();
            let words = site.misplaced(&others)?;
            Some(Event::Remark { file: site.id.to_string(), words, is_warning: true })
        };
        self.sites.iter().filter_map(warning).collect()
    }

    /// Issues a single passport.
    fn one(&self, folder: &StandFolder, stand: &PreparedStand, site: &Site, terms: &Terms) -> Outcome {
        let of_row = terms.valid_until.map(|day| Issue { valid_until: Some(day), ..self.job.order.clone() });
        let order = of_row.as_ref().unwrap_or(self.job.order);
        let of_customer = terms.customer.clone().map(|customer| {
            let mut stand = stand.stand().clone();
            stand.stand.customer = Some(customer);
            PreparedStand::new(stand)
        });
        let stand = of_customer.as_ref().unwrap_or(stand);
        let id = || passport_id(&stand.stand().stand, &site.id, order.revision);
        self.batch.settled(folder, id, || folder.next_first(stand, site, order))
    }
}
