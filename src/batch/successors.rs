//! Re-issue of passports: the given files, and those in given folders that the change concerns, with one new register for
//! each stand.
//!
//! A passport in a folder is re-issued if the register of its stand lists it as current, expired or not. A passport whose
//! content would not change is left as it is.

use super::catalogue::{self, Catalogue};
use super::{Batch, Event, Failure, Listener, Outcome, Settled, fail, parallel, paths};
use crate::document::sha256_hex;
use crate::files;
use crate::files::walk::Walk;
use crate::folder::place::{self, numbered};
use crate::folder::{Folder, Issued, StandFolder};
use crate::passport::checks::for_the_issuer;
use crate::passport::issue::PreparedStand;
use crate::passport::place::distant_correction;
use crate::passport::reissue::{Reissue, ReissueRefused, Successor, successor};
use crate::passport::{CheckName, Code, Content, Question, Verification, content_from_anyone, verify};
use crate::register::{Entry, State};
use crate::site::Site;
use crate::stand::Stand;
use crate::text::{LARGEST_DOCUMENT_BYTES, name_of, shown};
use std::collections::BTreeMap;
use std::io::BufRead;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Change to the passports, and the question by which they are verified.
pub(crate) struct Change<'a> {
    /// Order that all passports have in common; the stand is that of [`Self::stands`].
    pub order: Reissue,
    /// Stand files, each for the passports of its stand; in a folder only these stands are concerned.
    pub stands: &'a [PathBuf],
    /// Site files, each for the passports of its site, which stay at it.
    pub sites: &'a [PathBuf],
    /// Returns the factory's own file of a site, for passports whose site was not given; `None` if there is none.
    pub site_file: fn(&str) -> Option<PathBuf>,
    /// Question by which the predecessors are verified.
    pub question: Question,
    /// Folder of the successors; `None` for the root that the path of each predecessor shows.
    pub folder: Option<PathBuf>,
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

/// Successor of a passport, to be issued.
struct Following {
    /// Name of the predecessor's file.
    name: String,
    successor: Successor,
    /// Remarks for the case that it is issued.
    remarks: Vec<Event>,
}

impl Batch<'_> {
    /// Re-issues the given files, and the passports in given folders that the change concerns.
    pub(crate) fn reissue(&self, passports: &[PathBuf], list: &mut dyn BufRead, change: Change, tell: Listener) {
        let mut none = std::io::empty();
        let (stands, bad_stands) = Catalogue::read(change.stands, &mut none, self.threads, tell);
        let (sites, bad_sites) = Catalogue::read(change.sites, &mut none, self.threads, tell);
        let sites_missing = !bad_sites.is_empty();
        // The stand or site of an unreadable file is unknown, and so is the number of its passports.
        fail(bad_stands, 0, tell);
        fail(bad_sites, 0, tell);
        let run = Run { batch: self, change, stands, sites, sites_missing };
        let mut plan = Plan { run: &run, folders: BTreeMap::new(), jobs: Vec::new() };
        for named in paths::named(passports, list).take_while(|_| !self.cancelled()) {
            match named {
                Ok(root) if root.is_dir() => plan.folder(&root),
                Ok(path) => plan.file(path, tell),
                Err(failure) => plan.jobs.push(Err(failure)),
            }
        }
        let work = |job: &Result<Job, Failure>, threads| {
            let done = job.as_ref().map_err(Failure::clone).and_then(|job| run.job(job, threads));
            done.unwrap_or_else(|failure| vec![Event::Done(Outcome::Failed(failure))])
        };
        self.each_stand(&plan.jobs, STANDS_AT_ONCE, work, tell);
    }
}

/// Jobs of the given files and folders, in their order, and why there is none for one of them.
struct Plan<'a> {
    run: &'a Run<'a>,
    /// Folders by their roots.
    folders: BTreeMap<PathBuf, Arc<Folder>>,
    jobs: Vec<Result<Job, Failure>>,
}

impl Plan<'_> {
    /// Adds the stands of a folder.
    fn folder(&mut self, root: &Path) {
        let stands = match place::stands(root) {
            Ok(stands) if stands.is_empty() => return self.jobs.push(Err(paths::contains_no(root, "passport"))),
            Ok(stands) => stands,
            Err(error) => return self.jobs.push(Err(Failure::file(error))),
        };
        let Change { order, folder, .. } = &self.run.change;
        let site = order.site.as_ref().filter(|_| !order.moved);
        let is_corrected =
            site.is_some_and(|site| stands.iter().any(|(above, id)| states_another(&above.join(id), site)));
        for (above, stand) in stands.into_iter().filter(|(_, stand)| self.run.batch.shard.has(stand)) {
            let from = self.folder_at(&above);
            let to = folder.as_ref().map_or_else(|| Arc::clone(&from), |to| self.folder_at(to));
            self.jobs.push(Ok(Job { stand, from: Some(from), to, files: None, is_corrected }));
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
            Err(failure) => return self.jobs.push(Err(failure)),
        };
        let stand = content.stand.id();
        if !self.run.batch.shard.has(&stand) {
            return;
        }
        tell(Event::Planned(1));
        let root = Folder::root_of(&path, &content.stand);
        let to = match self.run.change.folder.as_deref().map_or(root.clone(), Ok) {
            Ok(to) => self.folder_at(to),
            Err(why) => return self.jobs.push(Err(Failure::unusable(&path, why))),
        };
        let from = root.ok().map(|root| self.folder_at(root));
        match self.jobs.last_mut() {
            Some(Ok(Job { stand: other, to: other_to, files: Some(files), .. }))
                if *other == stand && other_to.root() == to.root() =>
            {
                files.push(path);
            }
            _ => self.jobs.push(Ok(Job { stand, from, to, files: Some(vec![path]), is_corrected: false })),
        }
    }

    fn folder_at(&mut self, root: &Path) -> Arc<Folder> {
        let new = || Arc::new(Folder::new(root).with_durability(self.run.batch.durability));
        Arc::clone(self.folders.entry(root.to_owned()).or_insert_with(new))
    }
}

struct Run<'a> {
    batch: &'a Batch<'a>,
    change: Change<'a>,
    stands: Catalogue<Stand>,
    sites: Catalogue<Site>,
    /// `true` if a site file could not be read, so its site is unknown.
    sites_missing: bool,
}

impl Run<'_> {
    /// Re-issues the passports of one stand and writes its register.
    fn job(&self, job: &Job, threads: usize) -> Result<Vec<Event>, Failure> {
        let given = self.stands.get(&job.stand);
        if job.files.is_none() && !self.change.stands.is_empty() && given.is_none() {
            return Ok(Vec::new());
        }
        let open = |folder| {
            let opened = StandFolder::open(folder, &job.stand, &self.batch.authority, |_| false);
            opened.map_err(|why| Failure::folder(job.stand.clone(), &why))
        };
        let to = open(&job.to)?;
        let other = job.from.as_ref().filter(|from| from.root() != job.to.root());
        let other = other.map(|from| open(from)).transpose()?;
        let from = other.as_ref().unwrap_or(&to);
        let candidates: Vec<Candidate> = match &job.files {
            Some(files) => files.iter().map(|path| Candidate { path: path.clone(), entry: None }).collect(),
            None => {
                let candidate = |entry| Candidate { path: from.path_of_entry(entry), entry: Some(entry) };
                from.entries().iter().map(candidate).collect()
            }
        };
        // If only one stand file is given, use it for every stand, so that it is refused as that of another stand.
        let given = given.or(self.stands.documents.first().filter(|_| self.stands.documents.len() == 1));
        let stand = given.map(|stand| Arc::new(PreparedStand::new(stand.clone())));
        let examined = parallel::map(&candidates, threads, |candidate| {
            let examined = self.examine(candidate, job, stand.as_ref(), from);
            examined.unwrap_or_else(|failure| Err(Box::new(Outcome::Failed(failure))))
        });
        // Several predecessors may have successors at one site: these are issued one after the other.
        let (mut settled, mut places) = (BTreeMap::new(), BTreeMap::<String, Vec<_>>::new());
        for (index, examined) in examined.into_iter().enumerate() {
            match examined {
                Err(outcome) => drop(settled.insert(index, Settled::from(*outcome))),
                Ok(next) => places.entry(next.successor.site.id.to_string()).or_default().push((index, next)),
            }
        }
        let places: Vec<Vec<(usize, Following)>> = places.into_values().collect();
        let followed = parallel::map(&places, threads, |place| {
            let follow = |(_, next): &(usize, Following)| {
                self.batch.settled(&to, || next.name.clone(), || to.next_successor(&next.successor))
            };
            place.iter().map(follow).collect::<Vec<_>>()
        });
        for ((index, next), outcome) in places.into_iter().flatten().zip(followed.into_iter().flatten()) {
            settled.insert(index, Settled { outcome, remarks: next.remarks });
        }
        let planned = job.files.is_none().then_some(Event::Planned(settled.len() as u64));
        let done = self.batch.finish(&to, settled.into_values().collect());
        Ok(planned.into_iter().chain(done).collect())
    }

    /// Returns the successor of a passport, or the outcome of one that gets none.
    fn examine(
        &self,
        candidate: &Candidate,
        job: &Job,
        stand: Option<&Arc<PreparedStand>>,
        from: &StandFolder,
    ) -> Result<Result<Following, Box<Outcome>>, Failure> {
        let path = &candidate.path;
        let name = name_of(path);
        let change = &self.change;
        let refused = |why: String| Failure::refused(path, why);
        if let Some(entry) = candidate.entry
            && let Some(why) = self.settled_by_register(entry, job, from)
        {
            let skipped = Outcome::Skipped { id: entry.id.clone(), file: path.clone(), why };
            return Ok(Err(Box::new(skipped)));
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
        let verification = match &from.register {
            Some(register) => verification.with_register(Ok((register, None)), &change.question),
            None => verification,
        };
        let order = self.order(path, stand, verification.content_from_anyone())?;
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
            return Ok(Err(Box::new(Outcome::There(there))));
        }
        let mut warnings = match candidate.entry {
            Some(_) => Vec::new(),
            None => warnings(&verification, &next, from),
        };
        let stays = !next.supersedes() && verification.passport().is_some() && warnings.is_empty();
        let stays = stays.then(|| STAYS_CURRENT.to_owned());
        warnings.extend(verification.content_from_anyone().and_then(|old| distant_correction(old, &next.site)));
        let remarks = warnings.into_iter().map(|words| (words, true)).chain(stays.map(|words| (words, false)));
        let remark = |(words, is_warning)| Event::Remark { file: name.clone(), words, is_warning };
        let remarks = remarks.map(remark).collect();
        Ok(Ok(Following { name, successor: next, remarks }))
    }

    /// Returns why a passport is not re-issued by what its register says, or `None` if it is.
    fn settled_by_register(&self, entry: &Entry, job: &Job, from: &StandFolder) -> Option<String> {
        match (entry.state, &entry.by, &entry.reason) {
            (State::Withdrawn, _, reason) => Some(format!("withdrawn: {}", reason.as_deref().unwrap_or_default())),
            (State::Superseded, Some(by), _) => Some(format!("superseded by {by}")),
            (State::Moved, Some(by), _) => Some(format!("moved: superseded by {by}")),
            _ => self
                .is_for_another_site(entry, job, from)
                .then(|| "for another site, which the change does not concern".to_owned()),
        }
    }

    /// Returns `true` if only passports for other sites are to be re-issued: a corrected site concerns its own.
    fn is_for_another_site(&self, entry: &Entry, job: &Job, from: &StandFolder) -> bool {
        let Change { order, stands, sites, .. } = &self.change;
        let site = entry.site_and_revision().0;
        match &order.site {
            Some(new) => {
                let was_there = || from.entries().iter().any(|entry| entry.site_and_revision().0 == new.id.as_str());
                !order.moved && new.id.as_str() != site && (job.is_corrected || was_there())
            }
            // A new certificate concerns the passports for all sites.
            None => stands.is_empty() && !sites.is_empty() && !self.sites_missing && self.sites.get(site).is_none(),
        }
    }

    /// Returns the order for one passport, with the files for its stand and site.
    fn order(
        &self,
        path: &Path,
        stand: Option<&Arc<PreparedStand>>,
        old: Option<&Content>,
    ) -> Result<Reissue, Failure> {
        let mut order = self.change.order.clone();
        let Some(old) = old else { return Ok(order) };
        if !self.change.stands.is_empty() {
            let missing = || Failure::refused(path, format!("no stand file is for {}", old.stand.id()));
            order.stand = Some(Arc::clone(stand.ok_or_else(missing)?));
        }
        if let Some(site) = self.sites.get(old.site.id.as_str()) {
            order.site = Some(site.clone());
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
