//! Passports issued anew: those that were named, and of a folder those that the change concerns.
//!
//! Of a folder a passport is issued anew when it is in force or has expired and no other supersedes it, by the rules of
//! the [`register`]. Those that say already what they would say are left.

use super::catalogue::Catalogue;
use super::paths::{self, Named};
use super::{Batch, Event, Failure, Listener, Outcome, Purpose, Sweeper, parallel};
use crate::document::sha256_hex;
use crate::files::walk::{Entry, Walk};
use crate::files::{self, FileError, folder_of};
use crate::folder::Issued;
use crate::folder::search::{self, Withdrawn, is_numbered, is_revocation_list};
use crate::passport::issue::PreparedStand;
use crate::passport::reissue::{Order, ReissueRefused, Successor, successor};
use crate::passport::{Question, Trust, verify};
use crate::register::{self, Line, State, examine, examined};
use crate::site::Site;
use crate::text::{LARGEST_DOCUMENT_BYTES, name_of, shown};
use jiff::Timestamp;
use std::collections::{BTreeMap, HashMap};
use std::io::BufRead;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The line without which a passport supersedes none. Its one form makes it stand on a line of its own.
const SUPERSEDES: &[u8] = b"\n  supersedes: true\n";

const FORKED: &str = "comes from a passport that several supersede: `register` names them; withdraw with `revoke` what \
                      does not count";

/// What is to change, and by whose trust the old passports must hold.
pub struct Change<'a> {
    /// What all have in common; the stand is that of [`Self::stands`].
    pub order: Order,
    /// Files of stands: each for the passports of its stand. Of a folder no others are concerned.
    pub stands: &'a [PathBuf],
    /// Files of sites: each for the passports of its site, which stay at it.
    pub sites: &'a [PathBuf],
    /// The trust in the old passports.
    pub trust: Trust,
    /// What is asked of them.
    pub question: Question,
}

/// A passport to be looked at.
struct Candidate {
    path: PathBuf,
    /// The folder in which it was found; `None` when it was named itself.
    folder: Option<Arc<Searched>>,
}

/// What is known of a folder as a whole.
struct Searched {
    /// With the revocation lists that stand there.
    trust: Trust,
    chains: Chains,
    /// Passports of a site that is called as revocation lists are.
    no_lists: Vec<PathBuf>,
}

/// Whether a file is a revocation list by its name, and none of those that are not.
fn is_list(path: &Path, no_lists: &[PathBuf]) -> bool {
    is_revocation_list(path) && !no_lists.iter().any(|other| other == path)
}

/// What supersedes what.
#[derive(Default)]
struct Chains {
    followers: HashMap<Digest, Follower>,
    /// Of those, each with the one that it supersedes.
    superseded: HashMap<Digest, Digest>,
}

/// The first half of a SHA-256.
type Digest = u128;

/// What supersedes a passport.
struct Follower {
    id: Box<str>,
    digest: Digest,
    /// Whether another one that was not withdrawn does too.
    forked: bool,
    withdrawn: bool,
}

/// A candidate that was looked at.
enum Examined {
    Done(Option<Outcome>),
    /// It is to be followed by this one.
    Next(String, Box<Successor>),
}

impl Batch<'_> {
    /// Issues anew what was named: files, and of folders those that the change concerns.
    pub fn reissue(&self, passports: &[PathBuf], list: &mut dyn BufRead, change: Change, tell: Listener) {
        let mut none = std::io::empty();
        let files = paths::files(change.stands, &mut none, Purpose::Stands);
        let (stands, bad_stands) = Catalogue::read(files, self.threads, tell);
        let mut none = std::io::empty();
        let files = paths::files(change.sites, &mut none, Purpose::Sites);
        let (sites, bad_sites) = Catalogue::read(files, self.threads, tell);
        let sites_missing = !bad_sites.is_empty();
        for failure in bad_stands.into_iter().chain(bad_sites) {
            // Whose passports it would have been for, only the file could say.
            tell(Event::Done(Some(Outcome::Failed(Failure { passports: Some(0), ..failure }))));
        }
        let sweeper = Sweeper::default();
        let mut run = Run { batch: self, change, stands, sites, sites_missing, sweeper, candidates: Vec::new() };
        if self.seal.is_some() {
            run.sweeper.sweep(self.folder.root());
        }
        for named in paths::named(passports, list) {
            match named {
                Err(failure) => run.push(Err(failure), tell),
                Ok(Named::File(path)) => {
                    tell(Event::Planned(1));
                    if self.shard.has_file(&path) {
                        run.push(Ok(Candidate { path, folder: None }), tell);
                    } else {
                        tell(Event::Done(None));
                    }
                }
                Ok(Named::Folder(root)) => run.folder(&root, tell),
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
    /// Whether a file of a site could not be read: whose it is, nobody knows.
    sites_missing: bool,
    sweeper: Sweeper,
    candidates: Vec<Result<Candidate, Failure>>,
}

impl Run<'_> {
    fn push(&mut self, candidate: Result<Candidate, Failure>, tell: Listener) {
        self.candidates.push(candidate);
        if self.candidates.len() == self.batch.chunk() {
            self.chunk(tell);
        }
    }

    /// The passports of a folder, in three walks: its names, the chains, the passports themselves.
    fn folder(&mut self, root: &Path, tell: Listener) {
        let searched = match self.search(root, tell) {
            Ok(searched) => Arc::new(searched),
            Err(failure) => return self.push(Err(failure), tell),
        };
        for entry in Walk::deep(root, is_numbered) {
            let path = match paths::found(entry) {
                Ok(path) if is_list(&path, &searched.no_lists) || !self.batch.shard.has_file(&path) => continue,
                path => path,
            };
            self.push(path.map(|path| Candidate { path, folder: Some(Arc::clone(&searched)) }), tell);
            if self.batch.cancelled() {
                return;
            }
        }
    }

    fn search(&self, root: &Path, tell: Listener) -> Result<Searched, Failure> {
        let mut lists = Vec::new();
        let mut passports = 0;
        for entry in Walk::deep(root, is_numbered) {
            match entry {
                Ok(Entry::File(path)) if is_revocation_list(&path) => lists.push(path),
                Ok(Entry::File(path)) if self.batch.shard.has_file(&path) => passports += 1,
                _ => {}
            }
        }
        tell(Event::Planned(passports));
        let mut trust = self.change.trust.clone();
        let Withdrawn { alarms, no_lists } = search::withdraw(&lists, &mut trust, self.change.question.time);
        if !alarms.is_empty() {
            tell(Event::Lost(passports));
            let words: Vec<_> = alarms.into_iter().map(|alarm| alarm.words).collect();
            let why = format!("{}: what was withdrawn is not certain: {}", shown(root), words.join("; "));
            return Err(Failure { passports: Some(passports), ..Failure::refused(root, why) });
        }
        let chains = self.chains(root, &trust, &no_lists);
        Ok(Searched { trust, chains, no_lists })
    }

    /// What supersedes what, by the word of every passport that says so and counts.
    fn chains(&self, root: &Path, trust: &Trust, no_lists: &[PathBuf]) -> Chains {
        let mut chains = Chains::default();
        // What cannot be read is told when its turn comes.
        let mut files = Walk::deep(root, is_numbered).flatten().filter_map(|entry| match entry {
            Entry::File(path) if !is_list(&path, no_lists) => Some(path),
            _ => None,
        });
        loop {
            let some: Vec<PathBuf> = files.by_ref().take(self.batch.chunk()).collect();
            if some.is_empty() || self.batch.cancelled() {
                return chains;
            }
            let time = self.change.question.time;
            let links = parallel::map(&some, self.batch.threads, |path| link(path, trust, time));
            links.into_iter().flatten().for_each(|(superseded, follower)| chains.add(superseded, follower));
        }
    }

    fn chunk(&mut self, tell: Listener) {
        let candidates = std::mem::take(&mut self.candidates);
        let examined = parallel::map(&candidates, self.batch.threads, |candidate| match candidate {
            Ok(candidate) => {
                self.examine(candidate).unwrap_or_else(|failure| Examined::Done(Some(Outcome::Failed(failure))))
            }
            Err(failure) => Examined::Done(Some(Outcome::Failed(failure.clone()))),
        });
        // Several old passports may have successors of one stand at one site: they come one after the other.
        let mut places: BTreeMap<(String, &str), Vec<usize>> = BTreeMap::new();
        for (index, examined) in examined.iter().enumerate() {
            if let Examined::Next(_, successor) = examined {
                let place = (successor.stand().stand.id(), successor.site().id.as_str());
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
            Examined::Next(..) => settled.remove(&index).flatten(),
        });
        self.batch.tell(outcomes.collect(), tell);
    }

    /// The successor: every one of a batch is made here.
    fn follow(&self, examined: &Examined) -> Option<Outcome> {
        let Examined::Next(name, successor) = examined else { return None };
        let folder = self.batch.folder;
        if self.batch.seal.is_some() {
            let path = folder.path_of(&successor.stand().stand, &successor.site().id, successor.first_revision());
            self.sweeper.sweep(folder_of(&path));
        }
        Some(self.batch.settle(
            || name.clone(),
            || folder.next_successor(successor),
            |seal| folder.reissue(successor, seal),
        ))
    }

    fn examine(&self, candidate: &Candidate) -> Result<Examined, Failure> {
        let path = &candidate.path;
        let name = name_of(path);
        let change = &self.change;
        let refused = |why: String| Failure::refused(path, why);
        let bytes = files::read(path, LARGEST_DOCUMENT_BYTES).map_err(|error| match error {
            FileError::TooLarge { .. } if candidate.folder.is_some() => refused(error.to_string()),
            _ => Failure::unusable(path, error.to_string()),
        })?;
        let trust = candidate.folder.as_ref().map_or(&change.trust, |folder| &folder.trust);
        let verification = verify(&name, &bytes, trust, &change.question);
        if let Some(folder) = &candidate.folder
            && let Some(done) = self.settled_by_folder(
                path,
                folder,
                &examined(&name, &bytes, &verification, change.question.time, None),
            )?
        {
            return Ok(Examined::Done(done));
        }
        let order = self.order(candidate, verification.content())?;
        let changed = order.stand.is_some() || order.site.is_some();
        let next = successor(&bytes, &verification, &order).map_err(|error| match error {
            ReissueRefused::BadReason => Failure::unusable(path, error.to_string()),
            _ => refused(error.to_string()),
        })?;
        let done = next.says_the_same() && (changed || next.for_the_same_reason());
        if candidate.folder.is_some() && done {
            let id = verification.id().unwrap_or_default().to_owned();
            let remarks = next.draft(next.first_revision()).map_err(|error| refused(error.to_string()))?.remarks();
            let there = Issued { id, path: path.clone(), sha256: sha256_hex(&bytes), new: false, remarks };
            return Ok(Examined::Done(Some(Outcome::There(there))));
        }
        Ok(Examined::Next(name, Box::new(next)))
    }

    /// What becomes of a passport by what else its folder holds; `None` when it is to be issued anew.
    fn settled_by_folder(
        &self,
        path: &Path,
        folder: &Searched,
        examined: &register::Examined,
    ) -> Result<Option<Option<Outcome>>, Failure> {
        let refused = |why: String| Failure::refused(path, why);
        let line = examined.line();
        let of_another_stand = |stand: &String| !self.change.stands.is_empty() && !self.stands.has(stand);
        if line.stand.as_ref().is_some_and(of_another_stand) {
            return Ok(Some(None));
        }
        if line.state == State::Broken {
            return Err(refused(format!("the passport does not hold ({})", line.why)));
        }
        if let Some(words) = examined.misplaced() {
            return Err(refused(format!("is in the wrong folder: {words}")));
        }
        if let Some(why) = folder.chains.why_not(line) {
            let id = line.id.clone().unwrap_or_default();
            return Ok(Some(Some(Outcome::Skipped { id, file: path.to_owned(), why })));
        }
        if examined.supersedes().is_some_and(|old| folder.chains.forked(old)) {
            return Err(refused(FORKED.to_owned()));
        }
        Ok(None)
    }

    /// The order for one passport: with the files that are for its stand and site.
    fn order(&self, candidate: &Candidate, old: Option<&crate::passport::Content>) -> Result<Order, Failure> {
        let mut order = self.change.order.clone();
        let Some(old) = old else { return Ok(order) };
        if !self.change.stands.is_empty() {
            let stand = match self.stands.get(&old.stand.id())? {
                // The only one given is refused as that of another stand.
                None if self.stands.len() == 1 => self.stands.load(0..1, 1).remove(0).map(Some)?,
                stand => stand,
            };
            let missing = || Failure::refused(&candidate.path, format!("no stand file is of {}", old.stand.id()));
            order.stand = Some(stand.ok_or_else(missing)?);
        }
        if let Some(site) = self.sites.get(old.site.id.as_str())? {
            order.site = Some(Site::clone(&site));
        } else if self.sites_missing {
            let why = format!("no file is of its site, {}, among those of --sites that can be read", old.site.id);
            return Err(Failure::refused(&candidate.path, why));
        }
        Ok(order)
    }
}

impl Chains {
    fn add(&mut self, superseded: Digest, follower: Follower) {
        self.superseded.insert(follower.digest, superseded);
        match self.followers.get_mut(&superseded) {
            // A copy of the same file is one successor, not two.
            Some(known) if known.digest == follower.digest => {}
            // One that was withdrawn still supersedes, but leaves no doubt which of the two counts.
            Some(known) if known.withdrawn => *known = follower,
            Some(known) => known.forked |= !follower.withdrawn,
            None => drop(self.followers.insert(superseded, follower)),
        }
    }

    /// Why a passport is not issued anew.
    fn why_not(&self, line: &Line) -> Option<String> {
        let follower = digest(&line.sha256).and_then(|digest| self.followers.get(&digest));
        match (line.state, follower) {
            (State::Revoked, _) => Some(format!("revoked: {}", line.why)),
            (State::InForce | State::Expiring | State::Expired, Some(by)) => Some(format!("superseded by {}", by.id)),
            _ => None,
        }
    }

    /// Whether a passport comes from one that several supersede.
    fn forked(&self, superseded: &str) -> bool {
        let ancestors = std::iter::successors(digest(superseded), |digest| self.superseded.get(digest).copied());
        ancestors.filter_map(|digest| self.followers.get(&digest)).any(|follower| follower.forked)
    }
}

/// What a file supersedes, and as what.
fn link(path: &Path, trust: &Trust, time: Timestamp) -> Option<(Digest, Follower)> {
    let bytes = files::read(path, LARGEST_DOCUMENT_BYTES).ok()?;
    memchr::memmem::find(&bytes, SUPERSEDES)?;
    let examined = examine(&name_of(path), &bytes, trust, time, None);
    let (superseded, line) = (digest(examined.supersedes()?)?, examined.line());
    let id = line.id.clone()?.into();
    Some((
        superseded,
        Follower { id, digest: digest(&line.sha256)?, forked: false, withdrawn: line.state == State::Revoked },
    ))
}

fn digest(sha256: &str) -> Option<Digest> {
    Digest::from_str_radix(sha256.get(..32)?, 16).ok()
}
