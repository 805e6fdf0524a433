//! Re-issue of passports: the given files, and those in given folders that the change concerns.
//!
//! A passport in a folder is re-issued if it is in force or expired and not superseded, by the rules of the
//! [`register`](crate::register). A passport whose content would not change is left as it is.

use super::catalogue::{self, Catalogue};
use super::{Batch, Event, Failure, Listener, Outcome, Purpose, fail, parallel, paths, sweep};
use crate::document::sha256_hex;
use crate::files::walk::Visited;
use crate::files::{self, FileError, folder_of};
use crate::folder::refused::THE_ONE_IN_FORCE;
use crate::folder::{Folder, Issued, Superseding, search};
use crate::interface::{Enquiry, unverified};
use crate::passport::checks::for_the_issuer;
use crate::passport::content::passport_id;
use crate::passport::issue::PreparedStand;
use crate::passport::place::distant_correction;
use crate::passport::reissue::{Order, ReissueRefused, Successor, successor};
use crate::passport::{Check, Question, Trust, Verification, verify};
use crate::register::{Alarm, AlarmKind, Asked, Line, Register, State};
use crate::site::Site;
use crate::text::{LARGEST_DOCUMENT_BYTES, name_of, shown};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::io::BufRead;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Words for a passport whose predecessor has several successors.
pub(super) const FORKED: &str = "its predecessor has several successors; list them with `register` and withdraw the \
                                 wrong ones with `revoke`";

/// Change to the passports, and the trust by which they are verified.
pub(crate) struct Change<'a> {
    /// Order that all passports have in common; the stand is that of [`Self::stands`].
    pub order: Order,
    /// Stand files, each for the passports of its stand; in a folder only these stands are concerned.
    pub stands: &'a [PathBuf],
    /// Site files, each for the passports of its site, which stay at it.
    pub sites: &'a [PathBuf],
    /// Returns the factory's own file of a site, for passports whose site was not given; `None` if there is none.
    pub site_file: fn(&str) -> Option<PathBuf>,
    /// Trust in the predecessors.
    pub trust: Trust,
    /// Question by which the predecessors are verified.
    pub question: Question,
    /// Folder of the successors; `None` for the root that the path of each predecessor shows.
    pub folder: Option<Arc<Folder>>,
}

struct Candidate {
    path: PathBuf,
    /// Folder in which it was found, and its line in the register; `None` if the file was specified itself.
    found: Option<(Arc<Searched>, usize)>,
}

/// Trust and register of a folder.
struct Searched {
    /// Trust, including the revocation lists that apply to the folder.
    trust: Trust,
    register: Register,
    /// Stands that have or had a passport for the site of the order.
    at_the_site: BTreeSet<String>,
    /// `true` if one of these passports states that site in another way: the site of the order is a corrected one.
    is_corrected: bool,
}

enum Examined {
    Done(Option<Outcome>),
    Next(Box<Following>),
}

/// Remark on a predecessor for another site that is not superseded.
const STAYS_IN_FORCE: &str = "stays in force next to the new passport; if the stand has left its site, use --moved, or \
                              withdraw it with `revoke`";

/// Registers of the folders of stands, each read once: they show which of the given files are superseded or withdrawn.
///
/// These are re-issued with a warning, because the successor may be what corrects them; in a given folder they are skipped.
#[derive(Default)]
struct Registers(Mutex<HashMap<PathBuf, Option<Arc<Enquiry>>>>);

impl Registers {
    /// Returns the register of `folder`, or `None` if it cannot be read.
    fn of(&self, folder: &Path, change: &Change) -> Option<Arc<Enquiry>> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let alone = || Enquiry::of(change.trust.clone(), change.question.clone());
        let read = || alone().with_register(folder).ok().map(Arc::new);
        known.entry(folder.to_owned()).or_insert_with(read).clone()
    }
}

/// Beginning of a remark that is a warning.
const WARNING: &str = "WARNING: ";

/// Returns the identifier of the passport in force that a warning about its predecessor names.
fn id_in_force(remark: &str) -> Option<&str> {
    let by = remark.strip_prefix(WARNING)?.strip_prefix("superseded by ")?;
    if by.contains("neither is in force") { None } else { by.split(" (").next() }
}

/// Successor of a passport, to be issued.
struct Following {
    /// Name of the predecessor's file.
    name: String,
    successor: Successor,
    folder: Arc<Folder>,
    /// Remarks for the case that it is issued.
    remarks: Vec<String>,
}

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
        let mut run = Run {
            batch: self,
            change,
            stands,
            sites,
            sites_missing,
            swept: Visited::default(),
            superseding: Superseding::default(),
            registers: Registers::default(),
            candidates: Vec::new(),
        };
        for named in paths::named(passports, list) {
            match named {
                Err(failure) => run.push(Err(failure), tell),
                Ok(root) if root.is_dir() => run.folder(&root, tell),
                Ok(path) => {
                    tell(Event::Planned(1));
                    if self.shard.has_file(&path) {
                        run.push(Ok(Candidate { path, found: None }), tell);
                    } else {
                        tell(Event::Done(None));
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
    superseding: Superseding,
    registers: Registers,
    candidates: Vec<Result<Candidate, Failure>>,
}

impl Run<'_> {
    fn push(&mut self, candidate: Result<Candidate, Failure>, tell: Listener) {
        self.candidates.push(candidate);
        if self.candidates.len() == self.batch.chunk() {
            self.chunk(tell);
        }
    }

    /// Adds the passports of a folder, in the order of their names, as its register lists them.
    fn folder(&mut self, root: &Path, tell: Listener) {
        let asked = Asked::at(self.change.question.time);
        let found = search::register(root, self.change.trust.clone(), &asked, self.batch.threads);
        let (register, trust) = match found {
            Ok(found) => found,
            Err(error) => return self.push(Err(Failure::file(error)), tell),
        };
        if register.passports.is_empty() && register.alarms.is_empty() {
            return self.push(Err(paths::contains_no(root, "passport")), tell);
        }
        let mut here: Vec<(PathBuf, usize)> =
            register.passports.iter().enumerate().map(|(index, line)| (PathBuf::from(&line.file), index)).collect();
        here.retain(|(path, _)| self.batch.shard.has_file(path));
        here.sort();
        let passports = here.len() as u64;
        tell(Event::Planned(passports));
        if let Some(alarm) = register.uncertain() {
            tell(Event::Lost(passports));
            let why = format!("{}: the withdrawals are uncertain: {}", shown(root), alarm.words);
            return self.push(Err(Failure { passports: Some(passports), ..Failure::refused(root, why) }), tell);
        }
        for failure in register.alarms.iter().filter_map(not_looked_at) {
            self.push(Err(failure), tell);
        }
        let site = self.change.order.site.as_ref().filter(|_| !self.change.order.moved);
        let is_there = |line: &&Line| site.is_some_and(|site| line.site.as_deref() == Some(site.id.as_str()));
        let there: Vec<&Line> = register.passports.iter().filter(is_there).collect();
        let states_another = |line: &&Line| {
            let bytes = files::read(Path::new(&line.file), LARGEST_DOCUMENT_BYTES).ok();
            let there = bytes.and_then(|bytes| unverified(&line.file, &bytes).ok());
            there.is_some_and(|(content, _)| Some(&content.site) != site)
        };
        let is_corrected = there.iter().any(states_another);
        let at_the_site = there.iter().filter_map(|line| line.stand.clone()).collect();
        let searched = Arc::new(Searched { trust, register, at_the_site, is_corrected });
        for (path, index) in here {
            self.push(Ok(Candidate { path, found: Some((Arc::clone(&searched), index)) }), tell);
            if self.batch.cancelled() {
                return;
            }
        }
    }

    fn chunk(&mut self, tell: Listener) {
        let candidates = std::mem::take(&mut self.candidates);
        // The registers of one chunk are kept, so memory does not grow with the number of stands.
        self.registers = Registers::default();
        let examined = parallel::map(&candidates, self.batch.threads, |candidate| match candidate {
            Ok(candidate) => {
                self.examine(candidate).unwrap_or_else(|failure| Examined::Done(Some(Outcome::Failed(failure))))
            }
            Err(failure) => Examined::Done(Some(Outcome::Failed(failure.clone()))),
        });
        // Several predecessors may have successors of one stand at one site: these are issued one after the other.
        let mut places: BTreeMap<(String, &str), Vec<usize>> = BTreeMap::new();
        for (index, examined) in examined.iter().enumerate() {
            if let Examined::Next(next) = examined {
                let successor = &next.successor;
                let place = (successor.stand().stand.id(), successor.site.id.as_str());
                places.entry(place).or_default().push(index);
            }
        }
        let places: Vec<Vec<usize>> = places.into_values().collect();
        let settled = parallel::map(&places, self.batch.threads, |place| {
            place.iter().map(|&index| (index, self.follow(&examined[index]))).collect::<Vec<_>>()
        });
        let mut settled: BTreeMap<usize, Option<Outcome>> = settled.into_iter().flatten().collect();
        let outcomes = examined.into_iter().enumerate().map(|(index, examined)| match examined {
            Examined::Done(outcome) => outcome,
            Examined::Next(next) => {
                let outcome = settled.remove(&index).flatten();
                if matches!(outcome, Some(Outcome::There(_) | Outcome::Planned { .. })) {
                    let Following { name, remarks, .. } = *next;
                    remarks.into_iter().for_each(|words| tell(Event::Remark { file: name.clone(), words }));
                }
                outcome
            }
        });
        let outcomes = outcomes.collect();
        self.batch.tell(outcomes, tell);
    }

    /// Issues a successor; every successor of a batch is made here.
    fn follow(&self, examined: &Examined) -> Option<Outcome> {
        let Examined::Next(next) = examined else { return None };
        let Following { name, successor, folder, remarks } = &**next;
        if self.batch.seal.is_some() {
            sweep(&self.swept, folder.root());
            let path = folder.path_of(&successor.stand().stand, &successor.site.id, successor.first_revision());
            sweep(&self.swept, folder_of(&path));
        }
        let mut outcome = self.batch.settle(folder, || name.clone(), || folder.next_successor(successor));
        if let Outcome::Failed(failure) = &mut outcome
            && failure.why.ends_with(THE_ONE_IN_FORCE)
            && let Some(id) = remarks.iter().find_map(|remark| id_in_force(remark))
        {
            failure.why += &format!(", {id}");
        }
        Some(outcome)
    }

    fn examine(&self, candidate: &Candidate) -> Result<Examined, Failure> {
        let path = &candidate.path;
        let name = name_of(path);
        let change = &self.change;
        let refused = |why: String| Failure::refused(path, why);
        if let Some((folder, index)) = &candidate.found
            && let Some(done) = self.settled_by_folder(path, folder, &folder.register.passports[*index])?
        {
            return Ok(Examined::Done(done));
        }
        let bytes = files::read(path, LARGEST_DOCUMENT_BYTES).map_err(|error| match error {
            FileError::TooLarge(..) if candidate.found.is_some() => refused(error.to_string()),
            _ => Failure::unusable(path, error.to_string()),
        })?;
        let trust = candidate.found.as_ref().map_or(&change.trust, |(folder, _)| &folder.trust);
        let verification = verify(&name, &bytes, trust, &change.question);
        let order = self.order(candidate, verification.content_from_anyone())?;
        let changed = order.stand.is_some() || order.site.is_some();
        let mut next = successor(&bytes, &verification, &order).map_err(|error| match error {
            ReissueRefused::BadReason => Failure::unusable(path, error.to_string()),
            _ => refused(error.to_string()),
        })?;
        let (in_folder, anew) = (candidate.found.is_some(), next.may_say_the_same);
        // This run, or an earlier one for the same reason, has nothing to correct in this passport.
        let done = in_folder && changed && !anew || next.for_the_same_reason && (in_folder || !anew);
        if next.says_the_same && done {
            let id = verification.id_from_anyone().unwrap_or_default().to_owned();
            let remarks = next.draft(next.first_revision()).map_err(|error| refused(error.to_string()))?.remarks();
            let there = Issued { id, path: path.clone(), sha256: sha256_hex(&bytes), new: false, remarks };
            return Ok(Examined::Done(Some(Outcome::There(there))));
        }
        let folder = self.folder_for(path, &next)?;
        next.rival = self.rival(path, &folder, &next, trust);
        let mut warnings = match candidate.found {
            Some(_) => Vec::new(),
            None => self.past(path, &folder, &next, (&verification, &bytes)),
        };
        let stays_in_force = !next.supersedes() && verification.passport().is_some() && warnings.is_empty();
        let stays_in_force = stays_in_force.then(|| STAYS_IN_FORCE.to_owned());
        warnings.extend(verification.content_from_anyone().and_then(|old| distant_correction(old, &next.site)));
        let warnings = warnings.into_iter().map(|words| format!("{WARNING}{words}"));
        let remarks = warnings.chain(stays_in_force).collect();
        Ok(Examined::Next(Box::new(Following { name, successor: next, folder, remarks })))
    }

    fn folder_for(&self, path: &Path, next: &Successor) -> Result<Arc<Folder>, Failure> {
        if let Some(folder) = &self.change.folder {
            return Ok(Arc::clone(folder));
        }
        let root = Folder::root_of(path, &next.stand().stand).map_err(|why| Failure::unusable(path, why))?;
        Ok(Arc::new(Folder::new(root).with_durability(self.batch.durability)))
    }

    /// Returns why a given file is not for use, by the register of its folder and of that of the new passport: it is
    /// superseded or withdrawn, or this is uncertain.
    fn past(
        &self,
        old: &Path,
        folder: &Folder,
        next: &Successor,
        (verification, bytes): (&Verification, &[u8]),
    ) -> Vec<String> {
        let stand = &next.stand().stand;
        let new = folder.path_of(stand, &next.site.id, next.first_revision());
        // Any other folder may be large, and is not one of passports.
        let old_folder = Folder::root_of(old, stand).ok().map(|_| folder_of(old));
        let folders: BTreeSet<&Path> = old_folder.into_iter().chain([folder_of(&new)]).collect();
        let registers = folders.into_iter().filter_map(|folder| self.registers.of(folder, &self.change));
        let registers: Vec<Arc<Enquiry>> = registers.collect();
        // What `next` is to correct is known, and so is that it is there already.
        let by_itself = format!("superseded by {} (", passport_id(stand, &next.site.id, next.first_revision()));
        let is_known = |check: &Check| {
            verification.code(check.name).is_some_and(|code| code == check.code) || check.detail.starts_with(&by_itself)
        };
        let mut failed = registers.iter().flat_map(|register| {
            let found = register.verification(&name_of(old), bytes);
            let failed = found.checks().iter().filter(|check| check.passed() == Some(false) && !is_known(check));
            failed.map(|check| for_the_issuer(&check.detail).to_owned()).collect::<Vec<_>>()
        });
        let registers = || registers.iter().filter_map(|enquiry| enquiry.register.as_ref());
        let uncertain = || registers().find_map(Register::uncertain).map(Alarm::reason);
        let certificate = &next.stand().certificate.number;
        let replaced = registers().filter(|_| !next.supersedes());
        let replaced = replaced.flat_map(|register| register.against_certificate(&stand.id(), certificate));
        failed.next().or_else(uncertain).into_iter().chain(replaced).collect()
    }

    /// Returns another passport that supersedes the same one, in its folder or in that of the new one.
    fn rival(&self, old: &Path, folder: &Folder, next: &Successor, trust: &Trust) -> Option<PathBuf> {
        let new = folder.path_of(&next.stand().stand, &next.site.id, next.first_revision());
        let asked = Asked::at(self.change.question.time);
        let folders = [folder_of(old), folder_of(&new)];
        let mut rivals = folders
            .into_iter()
            .filter_map(|folder| self.superseding.of(folder, next.old_sha256(), &new, trust, &asked));
        rivals.next().filter(|_| next.supersedes())
    }

    /// Returns the outcome of a passport that follows from its folder, or `None` if it is to be re-issued.
    fn settled_by_folder(
        &self,
        path: &Path,
        searched: &Searched,
        line: &Line,
    ) -> Result<Option<Option<Outcome>>, Failure> {
        let register = &searched.register;
        let refused = |why: String| Err(Failure::refused(path, why));
        let of_another_stand = |stand: &String| !self.change.stands.is_empty() && !self.stands.has(stand);
        if line.stand.as_ref().is_some_and(of_another_stand) {
            return Ok(Some(None));
        }
        let skipped = |why: String| {
            let id = line.id.clone().unwrap_or_default();
            Ok(Some(Some(Outcome::Skipped { id, file: path.to_owned(), why })))
        };
        if line.state == State::Broken {
            return refused(format!("the passport failed verification ({})", line.why));
        }
        if let Some(words) = line.misplaced() {
            return refused(format!("is in the wrong folder: {words}"));
        }
        let doubt = register.doubt(line.stand.as_deref().unwrap_or(""));
        if let (State::Unknown | State::Expired, Some(alarm)) = (line.state, doubt) {
            return refused(format!("it is unknown whether the passport is superseded: {}", alarm.reason()));
        }
        match line.state {
            State::Revoked => return skipped(format!("revoked: {}", for_the_issuer(&line.why))),
            State::Superseded | State::Moved if register.has_several(line) => {
                return refused(format!("several files have its id, {}", line.why));
            }
            State::Superseded => return skipped(line.reason()),
            State::Moved => return skipped(format!("moved: {}", line.why)),
            _ => {}
        }
        if self.is_for_another_site(line, searched) {
            return skipped("for another site, which the change does not concern".to_owned());
        }
        if register.is_of_a_fork(&line.sha256) { refused(FORKED.to_owned()) } else { Ok(None) }
    }

    /// Returns `true` if only passports for other sites are to be re-issued: a corrected site concerns its own.
    fn is_for_another_site(&self, line: &Line, searched: &Searched) -> bool {
        let Change { order, stands, sites, .. } = &self.change;
        let (Some(stand), Some(site)) = (&line.stand, &line.site) else { return false };
        match &order.site {
            Some(new) => {
                let is_for_its_own = searched.is_corrected || searched.at_the_site.contains(stand);
                !order.moved && new.id.as_str() != site && is_for_its_own
            }
            // A new certificate concerns the passports for all sites.
            None => stands.is_empty() && !sites.is_empty() && !self.sites_missing && !self.sites.has(site),
        }
    }

    /// Returns the order for one passport, with the files for its stand and site.
    fn order(&self, candidate: &Candidate, old: Option<&crate::passport::Content>) -> Result<Order, Failure> {
        let mut order = self.change.order.clone();
        let Some(old) = old else { return Ok(order) };
        if !self.change.stands.is_empty() {
            let stand = match self.stands.get(&old.stand.id())? {
                // If only one stand file is given, use it here, so that it is refused as that of another stand.
                None if self.stands.len() == 1 => self.stands.load(0..1, 1).remove(0).map(Some)?,
                stand => stand,
            };
            let missing = || Failure::refused(&candidate.path, format!("no stand file is for {}", old.stand.id()));
            order.stand = Some(stand.ok_or_else(missing)?);
        }
        if let Some(site) = self.sites.get(old.site.id.as_str())? {
            order.site = Some(Site::clone(&site));
        } else if self.sites_missing {
            let why = format!("none of the readable files of --sites is for its site, {}", old.site.id);
            return Err(Failure::refused(&candidate.path, why));
        } else if order.site.is_none()
            && let Some(file) = (self.change.site_file)(old.site.id.as_str())
        {
            let (site, _) = catalogue::read::<Site>(&file)?;
            if site.id != old.site.id {
                let (found, due) = (site.id, &old.site.id);
                let why = format!("{}: found site {found}, expected {due}; correct the file or its name", shown(&file));
                return Err(Failure::refused(&file, why));
            }
            order.site = Some(site);
        }
        Ok(order)
    }
}

/// Returns the failure for a file that the register could not examine, or `None` for an alarm about examined passports.
fn not_looked_at(alarm: &Alarm) -> Option<Failure> {
    let path = Path::new(alarm.files.first()?);
    let why = format!("{}: {}", shown(path), alarm.words);
    match alarm.kind {
        AlarmKind::Unreadable | AlarmKind::Special => Some(Failure::unusable(path, why)),
        AlarmKind::Link | AlarmKind::TooLarge => Some(Failure::refused(path, why)),
        _ => None,
    }
}
