//! Re-issue of passports: the given files, and those in given folders that the change concerns, with one new register for
//! each stand.
//!
//! A passport in a folder is re-issued if the register of its stand lists it as current, expired or not. A passport whose
//! content would not change is left as it is.

use super::catalogue::{self, Catalogue};
use super::{Batch, Event, Failure, Listener, Outcome, Purpose, fail, parallel, paths, sweep};
use crate::document::sha256_hex;
use crate::files;
use crate::files::walk::{Visited, Walk};
use crate::folder::place::{self, numbered};
use crate::folder::{Folder, Issued, StandFolder};
use crate::passport::checks::for_the_issuer;
use crate::passport::issue::PreparedStand;
use crate::passport::place::distant_correction;
use crate::passport::reissue::{Order, ReissueRefused, Successor, successor};
use crate::passport::{CheckName, Code, Content, Question, Verification, content_from_anyone, verify};
use crate::register::{Entry, State, VerifiedRegister};
use crate::site::Site;
use crate::text::{LARGEST_DOCUMENT_BYTES, name_of, shown};
use std::collections::BTreeMap;
use std::io::BufRead;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Change to the passports, and the question by which they are verified.
pub(crate) struct Change<'a> {
    /// Order that all passports have in common; the stand is that of [`Self::stands`].
    pub order: Order,
    /// Stand files, each for the passports of its stand; in a folder only these stands are concerned.
    pub stands: &'a [PathBuf],
    /// Site files, each for the passports of its site, which stay at it.
    pub sites: &'a [PathBuf],
    /// Returns the factory's own file of a site, for passports whose site was not given; `None` if there is none.
    pub site_file: fn(&str) -> Option<PathBuf>,
    /// Question by which the predecessors are verified.
    pub question: Question,
    /// Folder of the successors; `None` for the root that the path of each predecessor shows.
    pub folder: Option<Arc<Folder>>,
}

/// Number of stands that are examined at a time.
const STANDS_AT_ONCE: usize = 32;

/// Remark on a predecessor for another site that is not superseded.
const STAYS_CURRENT: &str = "stays in force next to the new passport; if the stand has left its site, use --moved, or \
                             withdraw it with `revoke`";

/// Passports of one stand to re-issue.
struct Job {
    stand: String,
    /// Folder of the predecessors; `None` for a file that is not in a folder of passports.
    from: Option<Arc<Folder>>,
    /// Folder of the successors.
    to: Arc<Folder>,
    /// Given files; `None` for all passports in the register.
    files: Option<Vec<PathBuf>>,
    /// `true` if the site of the order is a corrected one, which concerns only passports for that site.
    is_corrected: bool,
}

/// Passport to re-issue: its file, and its entry if it was not given itself.
struct Candidate<'a> {
    path: PathBuf,
    entry: Option<&'a Entry>,
}

enum Examined {
    Done(Option<Outcome>),
    Next(Box<Following>),
}

/// Successor of a passport, to be issued.
struct Following {
    /// Name of the predecessor's file.
    name: String,
    successor: Successor,
    /// Remarks for the case that it is issued, each with whether it is a warning.
    remarks: Vec<(String, bool)>,
}

/// Outcomes of a job, each with the file and the remarks for the case that it is issued.
type Outcomes = Vec<(Option<Outcome>, String, Vec<(String, bool)>)>;

impl Batch<'_> {
    /// Re-issues the given files, and the passports in given folders that the change concerns.
    pub(crate) fn reissue(&self, passports: &[PathBuf], list: &mut dyn BufRead, change: Change, tell: Listener) {
        let mut none = std::io::empty();
        let (stands, bad_stands) =
            Catalogue::read(paths::files(change.stands, &mut none, Purpose::Stands), self.threads, tell);
        let (sites, bad_sites) =
            Catalogue::read(paths::files(change.sites, &mut none, Purpose::Sites), self.threads, tell);
        let sites_missing = !bad_sites.is_empty();
        // The stand or site of an unreadable file is unknown, and so is the number of its passports.
        fail(bad_stands, 0, tell);
        fail(bad_sites, 0, tell);
        let mut run =
            Run { batch: self, change, stands, sites, sites_missing, swept: Visited::default(), jobs: Vec::new() };
        for named in paths::named(passports, list) {
            match named {
                Err(failure) => run.failed(failure, tell),
                Ok(root) if root.is_dir() => run.folder(&root, tell),
                Ok(path) => {
                    tell(Event::Planned(1));
                    match self.shard.has_file(&path) {
                        true => run.file(path, tell),
                        false => tell(Event::Done(None)),
                    }
                }
            }
            if self.cancelled() {
                return;
            }
        }
        run.chunk(tell);
    }
}

struct Run<'a> {
    batch: &'a Batch<'a>,
    change: Change<'a>,
    stands: Catalogue<PreparedStand>,
    sites: Catalogue<Site>,
    /// `true` if a site file could not be read, so its site is unknown.
    sites_missing: bool,
    /// Folders from which the leftovers of killed runs were removed.
    swept: Visited,
    jobs: Vec<Job>,
}

impl Run<'_> {
    fn failed(&mut self, failure: Failure, tell: Listener) {
        self.chunk(tell);
        tell(Event::Done(Some(Outcome::Failed(failure))));
    }

    fn push(&mut self, job: Job, tell: Listener) {
        self.jobs.push(job);
        if self.jobs.len() == STANDS_AT_ONCE {
            self.chunk(tell);
        }
    }

    /// Adds the stands of a folder.
    fn folder(&mut self, root: &Path, tell: Listener) {
        let stands = match place::stands(root) {
            Ok(stands) if stands.is_empty() => return self.failed(paths::contains_no(root, "passport"), tell),
            Ok(stands) => stands,
            Err(error) => return self.failed(Failure::file(error), tell),
        };
        let site = self.change.order.site.as_ref().filter(|_| !self.change.order.moved);
        let is_corrected =
            site.is_some_and(|site| stands.iter().any(|(above, id)| states_another(&above.join(id), site)));
        let mut folders: BTreeMap<PathBuf, Arc<Folder>> = BTreeMap::new();
        for (above, stand) in stands {
            if !self.batch.shard.has(&stand) {
                continue;
            }
            let new = || Arc::new(Folder::new(&above).with_durability(self.batch.durability));
            let from = Arc::clone(folders.entry(above.clone()).or_insert_with(new));
            let to = self.change.folder.clone().unwrap_or_else(|| Arc::clone(&from));
            self.push(Job { stand, from: Some(from), to, files: None, is_corrected }, tell);
            if self.batch.cancelled() {
                return;
            }
        }
    }

    /// Adds a given file to the job of its stand.
    fn file(&mut self, path: PathBuf, tell: Listener) {
        let read =
            files::read(&path, LARGEST_DOCUMENT_BYTES).map_err(|error| Failure::unusable(&path, error.with_nearest()));
        let content = read.and_then(|bytes| {
            content_from_anyone(&name_of(&path), &bytes).map_err(|error| Failure::refused(&path, error.to_string()))
        });
        let content = match content {
            Ok(content) => content,
            Err(failure) => return self.failed(failure, tell),
        };
        let root = Folder::root_of(&path, &content.stand);
        let to = match (&self.change.folder, &root) {
            (Some(folder), _) => Arc::clone(folder),
            (None, Ok(root)) => self.folder_at(root),
            (None, Err(why)) => return self.failed(Failure::unusable(&path, why.clone()), tell),
        };
        let from = root.ok().map(|root| if root == to.root() { Arc::clone(&to) } else { self.folder_at(root) });
        let stand = content.stand.id();
        match self.jobs.last_mut() {
            Some(Job { stand: other, to: other_to, files: Some(files), .. })
                if *other == stand && other_to.root() == to.root() =>
            {
                files.push(path);
            }
            _ => self.push(Job { stand, from, to, files: Some(vec![path]), is_corrected: false }, tell),
        }
    }

    fn folder_at(&self, root: &Path) -> Arc<Folder> {
        match self.jobs.last().map(|job| &job.to) {
            Some(to) if to.root() == root => Arc::clone(to),
            _ => Arc::new(Folder::new(root).with_durability(self.batch.durability)),
        }
    }

    fn chunk(&mut self, tell: Listener) {
        let jobs = std::mem::take(&mut self.jobs);
        let threads = self.batch.threads.max(1);
        // Many stands are done side by side, and few ones passport by passport.
        let each = if jobs.len() >= threads { 1 } else { threads };
        let done = parallel::map(&jobs, threads, |job| self.job(job, each));
        for (job, done) in jobs.iter().zip(done) {
            match done {
                Ok(outcomes) => {
                    if job.files.is_none() {
                        tell(Event::Planned(outcomes.len() as u64));
                    }
                    for (outcome, name, remarks) in outcomes {
                        if matches!(outcome, Some(Outcome::There(_) | Outcome::Planned { .. })) {
                            let remark = |(words, is_warning)| Event::Remark { file: name.clone(), words, is_warning };
                            remarks.into_iter().for_each(|told| tell(remark(told)));
                        }
                        tell(Event::Done(outcome));
                    }
                }
                Err(failure) => tell(Event::Done(Some(Outcome::Failed(failure)))),
            }
        }
    }

    /// Re-issues the passports of one stand and writes its register.
    fn job(&self, job: &Job, threads: usize) -> Result<Outcomes, Failure> {
        let authority = &self.batch.authority;
        if job.files.is_none() && !self.change.stands.is_empty() && !self.stands.has(&job.stand) {
            return Ok(Vec::new());
        }
        let open = |folder| {
            let opened = StandFolder::open(folder, &job.stand, authority, |_| false);
            opened.map_err(|why| Failure::folder(job.stand.clone(), &why))
        };
        if !self.batch.is_dry() {
            sweep(&self.swept, job.to.root());
            sweep(&self.swept, &job.to.root().join(&job.stand));
        }
        let to = open(&job.to)?;
        let other = job.from.as_ref().filter(|from| from.root() != job.to.root());
        let other = other.map(|from| open(from)).transpose()?;
        let from = other.as_ref().unwrap_or(&to);
        let candidates: Vec<Candidate> = match &job.files {
            Some(files) => files.iter().map(|path| Candidate { path: path.clone(), entry: None }).collect(),
            None => {
                let entries = from.register().map_or(&[][..], VerifiedRegister::entries);
                entries.iter().map(|entry| Candidate { path: from.path_of_entry(entry), entry: Some(entry) }).collect()
            }
        };
        let examined = parallel::map(&candidates, threads, |candidate| {
            let examined = self.examine(candidate, job, from);
            examined.unwrap_or_else(|failure| Examined::Done(Some(Outcome::Failed(failure))))
        });
        // Several predecessors may have successors at one site: these are issued one after the other.
        let mut places: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (index, examined) in examined.iter().enumerate() {
            if let Examined::Next(next) = examined {
                places.entry(next.successor.site.id.as_str()).or_default().push(index);
            }
        }
        let places: Vec<Vec<usize>> = places.into_values().collect();
        let settled = parallel::map(&places, threads, |place| {
            place.iter().map(|&index| (index, self.follow(&examined[index], &to))).collect::<Vec<_>>()
        });
        let mut settled: BTreeMap<usize, Option<Outcome>> = settled.into_iter().flatten().collect();
        let mut outcomes: Outcomes = Vec::with_capacity(examined.len());
        for (index, examined) in examined.into_iter().enumerate() {
            outcomes.push(match examined {
                Examined::Done(outcome) => (outcome, String::new(), Vec::new()),
                Examined::Next(next) => (settled.remove(&index).flatten(), next.name, next.remarks),
            });
        }
        let synced = self.batch.sync(outcomes.iter().filter_map(|(outcome, ..)| outcome.as_ref()).collect());
        if let Err(failure) = self.batch.list(&to, &synced) {
            outcomes.iter_mut().flat_map(|(outcome, ..)| outcome).for_each(|outcome| outcome.not_listed(&failure));
        }
        Ok(outcomes)
    }

    /// Issues a successor; every successor of a batch is made here.
    fn follow(&self, examined: &Examined, to: &StandFolder) -> Option<Outcome> {
        let Examined::Next(next) = examined else { return None };
        let Following { name, successor, .. } = &**next;
        let settled = match self.batch.is_dry() {
            false => to.reissue(successor).map(Outcome::There),
            true => to.next_successor(successor).map(Outcome::from),
        };
        Some(settled.unwrap_or_else(|why| Outcome::Failed(Failure::folder(name.clone(), &why))))
    }

    fn examine(&self, candidate: &Candidate, job: &Job, from: &StandFolder) -> Result<Examined, Failure> {
        let path = &candidate.path;
        let name = name_of(path);
        let change = &self.change;
        let refused = |why: String| Failure::refused(path, why);
        if let Some(entry) = candidate.entry
            && let Some(done) = self.settled_by_register(entry, path, job, from)
        {
            return Ok(Examined::Done(done));
        }
        let bytes = files::read(path, LARGEST_DOCUMENT_BYTES).map_err(|error| match candidate.entry {
            Some(_) if error.is_missing() => {
                refused(format!("{}: listed in the register, but missing; restore it from the backup", shown(path)))
            }
            _ => Failure::unusable(path, error.to_string()),
        })?;
        let sha256 = sha256_hex(&bytes);
        if candidate.entry.is_some_and(|entry| entry.sha256 != sha256) {
            return Err(refused(format!("{}: is not the listed file; restore it from the backup", shown(path))));
        }
        let verification = verify(&name, &bytes, self.batch.authority.trust, &change.question);
        let verification = match from.register() {
            Some(register) => verification.with_register(Ok((register, None)), &change.question),
            None => verification,
        };
        let order = self.order(path, verification.content_from_anyone())?;
        let changed = order.stand.is_some() || order.site.is_some();
        let next = successor(&bytes, &verification, &order).map_err(|error| match error {
            ReissueRefused::BadReason => Failure::unusable(path, error.to_string()),
            _ => refused(error.to_string()),
        })?;
        let done = next.says_the_same && (changed && !next.may_say_the_same || next.for_the_same_reason);
        if candidate.entry.is_some() && done {
            let id = verification.id_from_anyone().unwrap_or_default().to_owned();
            let remarks = next.draft(next.first_revision()).map_err(|error| refused(error.to_string()))?.remarks();
            let there = Issued { id, path: path.clone(), sha256, new: false, remarks };
            return Ok(Examined::Done(Some(Outcome::There(there))));
        }
        let mut warnings = match candidate.entry {
            Some(_) => Vec::new(),
            None => warnings(&verification, &next, from),
        };
        let stays = !next.supersedes() && verification.passport().is_some() && warnings.is_empty();
        let stays = stays.then(|| STAYS_CURRENT.to_owned());
        warnings.extend(verification.content_from_anyone().and_then(|old| distant_correction(old, &next.site)));
        let warnings = warnings.into_iter().map(|words| (words, true));
        let remarks = warnings.chain(stays.map(|words| (words, false))).collect();
        Ok(Examined::Next(Box::new(Following { name, successor: next, remarks })))
    }

    /// Returns the outcome of a passport that follows from its register, or `None` if it is to be re-issued.
    fn settled_by_register(
        &self,
        entry: &Entry,
        path: &Path,
        job: &Job,
        from: &StandFolder,
    ) -> Option<Option<Outcome>> {
        let skipped = |why: String| Some(Some(Outcome::Skipped { id: entry.id.clone(), file: path.to_owned(), why }));
        match (entry.state, &entry.by, &entry.reason) {
            (State::Withdrawn, _, reason) => skipped(format!("withdrawn: {}", reason.as_deref().unwrap_or_default())),
            (State::Superseded, Some(by), _) => skipped(format!("superseded by {by}")),
            (State::Moved, Some(by), _) => skipped(format!("moved: superseded by {by}")),
            _ if self.is_for_another_site(entry, job, from) => {
                skipped("for another site, which the change does not concern".to_owned())
            }
            _ => None,
        }
    }

    /// Returns `true` if only passports for other sites are to be re-issued: a corrected site concerns its own.
    fn is_for_another_site(&self, entry: &Entry, job: &Job, from: &StandFolder) -> bool {
        let Change { order, stands, sites, .. } = &self.change;
        let site = entry.site_and_revision().0;
        match &order.site {
            Some(new) => {
                let entries = from.register().map_or(&[][..], VerifiedRegister::entries);
                let was_there = || entries.iter().any(|entry| entry.site_and_revision().0 == new.id.as_str());
                !order.moved && new.id.as_str() != site && (job.is_corrected || was_there())
            }
            // A new certificate concerns the passports for all sites.
            None => stands.is_empty() && !sites.is_empty() && !self.sites_missing && !self.sites.has(site),
        }
    }

    /// Returns the order for one passport, with the files for its stand and site.
    fn order(&self, path: &Path, old: Option<&Content>) -> Result<Order, Failure> {
        let mut order = self.change.order.clone();
        let Some(old) = old else { return Ok(order) };
        if !self.change.stands.is_empty() {
            let stand = match self.stands.get(&old.stand.id())? {
                // If only one stand file is given, use it here, so that it is refused as that of another stand.
                None if self.stands.len() == 1 => self.stands.load(0..1, 1).remove(0).map(Some)?,
                stand => stand,
            };
            let missing = || Failure::refused(path, format!("no stand file is for {}", old.stand.id()));
            order.stand = Some(stand.ok_or_else(missing)?);
        }
        if let Some(site) = self.sites.get(old.site.id.as_str())? {
            order.site = Some(Site::clone(&site));
        } else if self.sites_missing {
            let why = format!("none of the readable files of --sites is for its site, {}", old.site.id);
            return Err(Failure::refused(path, why));
        } else if order.site.is_none()
            && let Some(file) = (self.change.site_file)(old.site.id.as_str())
        {
            let (site, _) = catalogue::read::<Site>(&file)?;
            if site.id != old.site.id {
                let why = format!("{}: is for site {}, expected {}", shown(&file), site.id, old.site.id);
                return Err(Failure::refused(&file, why));
            }
            order.site = Some(site);
        }
        Ok(order)
    }
}

/// Returns why a given file is not for use, by its register: it is superseded, withdrawn, or of a replaced certificate. It
/// is re-issued all the same, because its successor may be what corrects it.
fn warnings(verification: &Verification, next: &Successor, from: &StandFolder) -> Vec<String> {
    let check = verification.checks().iter().find(|check| check.name == CheckName::Register);
    let failed = check.filter(|check| check.passed() == Some(false) && check.code != Code::RegisterStale);
    let ended = failed.map(|check| for_the_issuer(&check.detail).to_owned());
    let replaced =
        if next.supersedes() { Vec::new() } else { from.against_certificate(next.prepared()).unwrap_or_default() };
    ended.into_iter().chain(replaced).collect()
}

/// Returns `true` if a passport for a site, in the folder of a stand, states that site in another way.
fn states_another(folder: &Path, site: &Site) -> bool {
    let is_there =
        |path: &PathBuf| path.file_name().and_then(numbered).is_some_and(|(other, _)| other == site.id.as_str());
    let files = Walk::flat(folder, |name| numbered(name).is_some()).files().filter(is_there);
    files.into_iter().any(|path| {
        let bytes = files::read(&path, LARGEST_DOCUMENT_BYTES).ok();
        let there = bytes.and_then(|bytes| content_from_anyone(&name_of(&path), &bytes).ok());
        there.is_some_and(|content| content.site != *site)
    })
}
