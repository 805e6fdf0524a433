//! Search of a folder for passports and lists of withdrawn passports, its register, and the history of one stand. Files
//! are recognised by content, never by name.

use super::claim::{Claim, is_yaml};
use crate::files::leftovers::is_lasting;
use crate::files::walk::{Entry, LINK, SPECIAL, Walk};
use crate::files::{self, FileError};
use crate::history::{History, Recorded};
use crate::parallel;
use crate::passport::Trust;
use crate::register::{Alarm, AlarmKind, Asked, Concern, Examined, Line, Register, examine};
use crate::revocation::{ListRefused, RevocationList, Series, claims_to_be_a_list};
use crate::text::{LARGEST_DOCUMENT_BYTES, name_of, shown};
use jiff::Timestamp;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// Number of first bytes by which a file in a parent folder is recognised as a list.
const BEGINNING_BYTES: usize = 4096;

/// Number of parent folders whose lists apply to a register, because its root may be a model or a stand.
const LEVELS_ABOVE: usize = 2;

/// Name of the folder next to that of the passports in which a workspace keeps its lists.
pub(crate) const LISTS_FOLDER: &str = "revocations";

#[derive(Debug, Default)]
pub(crate) struct Found {
    /// Files, sorted, without the temporary files of runs.
    pub files: Vec<PathBuf>,
    /// Links to folders or with YAML names, which were not followed because they may lead out of the folder.
    pub links: Vec<PathBuf>,
    /// Pipes, devices and sockets with YAML names, which were not opened because that may block.
    pub special: Vec<PathBuf>,
    /// Errors of subfolders that cannot be read.
    pub unreadable: Vec<FileError>,
}

/// Finds the files under `root`, at any depth; links are not followed.
///
/// # Errors
/// Returns [`FileError::Read`] if `root` cannot be read; errors of its subfolders are in [`Found::unreadable`].
pub(crate) fn find(root: &Path) -> Result<Found, FileError> {
    let mut found = Found::default();
    found.add(root);
    match found.unreadable.iter().position(|error| error.path() == root) {
        Some(of_root) => Err(found.unreadable.swap_remove(of_root)),
        None => Ok(found),
    }
}

impl Found {
    /// Finds what is under those of the folders that exist.
    fn under(folders: &[PathBuf]) -> Self {
        let mut found = Self::default();
        folders.iter().filter(|folder| folder.exists()).for_each(|folder| found.add(folder));
        found
    }

    /// Adds what is under a folder; an error of the folder itself is one more.
    fn add(&mut self, folder: &Path) {
        for entry in Walk::deep(folder, is_lasting) {
            match entry {
                Ok(Entry::Link(path)) if is_yaml(&path) || path.is_dir() => self.links.push(path),
                Ok(Entry::Special(path)) if is_yaml(&path) => self.special.push(path),
                Ok(Entry::Link(_) | Entry::Special(_)) => {}
                Ok(Entry::File(path)) => self.files.push(path),
                Err(error) => self.unreadable.push(error),
            }
        }
    }
}

/// Returns the existing folders named `revocations` next to `folder`, and next to the folders up to `levels` above it.
///
/// A folder that contains `folder` is omitted. A link counts where it is and where it leads; one that leads nowhere is
/// also returned, because its lists are unknown.
fn folders_of_lists(folder: &Path, levels: usize) -> Vec<PathBuf> {
    let real = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let named = |above: &Path| above.file_name().is_some();
    let places = [folder, &real].into_iter().flat_map(|at| at.ancestors().take_while(|at| named(at)).take(levels + 1));
    let mut found: Vec<(PathBuf, PathBuf)> = Vec::new();
    for lists in places.map(|at| at.with_file_name(LISTS_FOLDER)).filter(|lists| lists.is_dir() || lists.is_symlink()) {
        let leads_to = lists.canonicalize().unwrap_or_else(|_| lists.clone());
        if !real.starts_with(&leads_to) && found.iter().all(|(_, other)| *other != leads_to) {
            found.push((lists, leads_to));
        }
    }
    found.into_iter().map(|(lists, _)| lists).collect()
}

/// Returns the folder in which the lists for a folder of passports are kept: the one named `revocations` next to it if
/// there is one, else the folder of passports itself.
pub(crate) fn place_of_lists(passports: &Path) -> PathBuf {
    let beside = passports.file_name().map(|_| passports.with_file_name(LISTS_FOLDER));
    beside.filter(|beside| beside.is_dir()).unwrap_or_else(|| passports.to_owned())
}

/// Returns the files under `root` that claim to be passports, at any depth, with an error for each entry that was not
/// read. They are recognised by content; nothing in them is verified.
pub(crate) fn passports(root: &Path) -> Result<Vec<Result<PathBuf, FileError>>, FileError> {
    let found = find(root)?;
    let claims = found.files.into_iter().filter_map(|path| match files::read_first(&path, LARGEST_DOCUMENT_BYTES) {
        Ok(bytes) => (Claim::of(&path, &bytes) == Some(Claim::Passport)).then_some(Ok(path)),
        Err(error) => Some(Err(error)),
    });
    Ok(claims.chain(found.unreadable.into_iter().map(Err)).collect())
}

/// Returns the register of a folder and the trust extended by its lists of withdrawn passports.
///
/// Lists in the folders up to two levels above, and everything in the folders named `revocations` next to these and to
/// `root`, also count. `threads` threads do the work.
///
/// # Errors
/// Returns [`FileError::Read`] if `root` cannot be read; an unreadable file or folder below it does not hide the
/// others.
pub fn register(root: &Path, trust: Trust, asked: &Asked, threads: usize) -> Result<(Register, Trust), FileError> {
    register_of(root, None, trust, asked, threads)
}

/// Returns why passports in the folder of a stand may not be used, by their SHA-256, in words; nothing if the folder cannot
/// be read.
pub(crate) fn unusable(root: &Path, trust: &Trust, time: Timestamp, threads: usize) -> BTreeMap<String, String> {
    let lines = register(root, trust.clone(), &Asked::at(time), threads).map(|(register, _)| register.passports);
    let unusable = lines.unwrap_or_default().into_iter().filter(|line| !line.is_usable());
    let words = |line: &Line| {
        let reason = line.reason();
        let advice = match reason.starts_with("superseded by ") {
            true => {
                "; use that passport, or re-issue it with --site and --moved if the stand has returned to this site"
            }
            false => "",
        };
        format!("WARNING: this passport may not be used: {reason}{advice}")
    };
    unusable.map(|line| (line.sha256.clone(), words(&line))).collect()
}

/// Returns the register of a folder as [`register`] does, but if a `stand`, `<model>/<serial>`, is given, without the
/// passports of other stands that are in their own folders. Every entry and every alarm that concerns the stand is there.
pub(crate) fn register_of(
    root: &Path,
    stand: Option<&str>,
    trust: Trust,
    asked: &Asked,
    threads: usize,
) -> Result<(Register, Trust), FileError> {
    let mut found = find(root)?;
    folders_of_lists(root, LEVELS_ABOVE).iter().for_each(|lists| found.add(lists));
    let id = stand.map(|stand| format!("\"{stand}/"));
    let elsewhere = |path: &Path, bytes: &[u8]| {
        // A damaged file in the folder of another stand concerns that stand only, and a passport of this stand contains
        // its id wherever it is.
        let (Some(stand), Some(id)) = (stand, &id) else { return false };
        let other = matches!(concern(root, path), Concern::Stand(other) if !other.eq_ignore_ascii_case(stand));
        other && memchr::memmem::find(bytes, id.as_bytes()).is_none() && Claim::of(path, bytes) != Some(Claim::List)
    };
    let mut alarms: Vec<Alarm> = found.unreadable.iter().map(|error| unreadable(root, error)).collect();
    alarms.extend(found.links.iter().map(|path| Alarm::of_file(AlarmKind::Link, LINK, &name_of(path))));
    alarms.extend(found.special.iter().map(|path| Alarm::of_file(AlarmKind::Special, SPECIAL, &name_of(path))));
    let seen = parallel::map_with(&found.files, threads, Vec::new, |bytes, path| {
        Seen::of(root, path, bytes, elsewhere, |bytes| examine(&name_of(path), bytes, &trust, asked))
    });
    let (mut examined, mut lists) = (Vec::with_capacity(seen.len()), Vec::new());
    for Seen { passport, list, alarm } in seen {
        examined.extend(passport.map(|passport| *passport));
        lists.extend(list);
        alarms.extend(alarm);
    }
    let mut later = Vec::new();
    let trust = withdraw(lists, lists_above(root), trust, asked.question.time, &mut alarms, &mut later);
    let mut register = Register::of(examined, &trust.withdrawn, alarms);
    register.later = later;
    Ok((register, trust))
}

/// Returns the history of a stand, `<model>/<serial>`, and the register of its passports. If no file in the folder is a
/// passport of the stand, the history is `None`, and the register is that of all stands.
pub(crate) fn history(
    root: &Path,
    stand: &str,
    trust: Trust,
    time: Timestamp,
    threads: usize,
) -> Result<(Option<History>, Register), FileError> {
    let asked = Asked::at(time);
    let (found, extended) = register_of(root, Some(stand), trust.clone(), &asked, threads)?;
    let lines: Vec<_> = found.passports.iter().filter(|line| line.stand.as_deref() == Some(stand)).collect();
    if lines.is_empty() {
        return Ok((None, register(root, trust, &asked, threads)?.0));
    }
    let recorded = parallel::map(&lines, threads, |line| {
        let bytes = files::read(Path::new(&line.file), LARGEST_DOCUMENT_BYTES)?;
        Ok(Recorded::of(line, &bytes, &extended, time))
    });
    let recorded = recorded.into_iter().collect::<Result<Vec<_>, FileError>>()?;
    Ok((Some(History::of(stand, recorded, &found, &extended, time)), found))
}

/// Name and content of a file that claims to be a list.
type Claimed = (PathBuf, Vec<u8>);

/// Findings in one file: a damaged passport has an alarm too, and a file of another kind has none of the three.
#[derive(Default)]
struct Seen {
    passport: Option<Box<Examined>>,
    list: Option<Claimed>,
    alarm: Option<Alarm>,
}

impl Seen {
    fn of(
        root: &Path,
        path: &Path,
        bytes: &mut Vec<u8>,
        elsewhere: impl Fn(&Path, &[u8]) -> bool,
        examine: impl FnOnce(&[u8]) -> Examined,
    ) -> Self {
        let read = files::read_into(bytes, path, LARGEST_DOCUMENT_BYTES);
        if let Err(error @ (FileError::Read(..) | FileError::Folder(_))) = read {
            return Self { alarm: Some(unreadable(root, &error)), ..Self::default() };
        }
        if elsewhere(path, bytes) {
            return Self::default();
        }
        // For a file that is too large, `bytes` has its beginning.
        let examined = examine(bytes);
        let is_readable = examined.is_readable();
        let passport = Self { passport: Some(Box::new(examined)), ..Self::default() };
        if is_readable {
            return passport;
        }
        match Claim::of(path, bytes) {
            Some(Claim::List) => Self { list: Some((path.to_owned(), bytes.clone())), ..Self::default() },
            Some(Claim::Passport) => {
                let what = if bytes.is_empty() { "an empty file" } else { "a damaged passport or list" };
                let words = format!("{what}, which may supersede or withdraw other passports");
                let alarm = Alarm::of_file(AlarmKind::Damaged, &words, &name_of(path));
                Self { alarm: Some(alarm.concerning(concern(root, path))), ..passport }
            }
            None if !path.file_name().is_some_and(is_numbered) => Self::default(),
            None if read.is_err() => {
                let words =
                    format!("not read: it has more than {LARGEST_DOCUMENT_BYTES} bytes, the limit for a passport");
                Self { alarm: Some(Alarm::of_file(AlarmKind::TooLarge, &words, &name_of(path))), ..Self::default() }
            }
            None => passport,
        }
    }
}

/// Returns the passports that a file of unknown content concerns: in `<model>/<serial>/` those of that stand, else all.
fn concern(root: &Path, path: &Path) -> Concern {
    let folders = path.parent().and_then(|folder| folder.strip_prefix(root).ok());
    let mut folders = folders.into_iter().flat_map(Path::components);
    match (folders.next(), folders.next(), folders.next()) {
        (Some(model), Some(serial), None) => {
            let part = |part: std::path::Component| part.as_os_str().to_string_lossy().into_owned();
            Concern::Stand(format!("{}/{}", part(model), part(serial)))
        }
        _ => Concern::Everything,
    }
}

/// Extends the trust by the newest of the lists in the folder, in those above it, and already trusted.
///
/// Refused lists above raise no alarm unless they are damaged, because they are not part of this register; those that will
/// count later are added to `later`.
fn withdraw(
    lists: Vec<Claimed>,
    above: Vec<Claimed>,
    mut trust: Trust,
    time: Timestamp,
    alarms: &mut Vec<Alarm>,
    later: &mut Vec<Alarm>,
) -> Trust {
    let verify =
        |(path, bytes): &Claimed| RevocationList::verify(&name_of(path), bytes, &trust.signers, &trust.revoked, time);
    let mut good = trust.withdrawn.clone().into_lists();
    for claimed in &lists {
        match verify(claimed) {
            Ok(verified) => {
                let list = &verified.list;
                if claimed.0.file_name().is_none_or(|name| *name != *list.file_name()) {
                    alarms.push(Alarm::misnamed_list(list, &name_of(&claimed.0)));
                }
                good.push(verified);
            }
            Err(error) => alarms.push(Alarm::refused_list(&error, &name_of(&claimed.0))),
        }
    }
    let raise = |series: &Series, unknown: bool, alarms: &mut Vec<Alarm>| {
        let raised = series.alarms().iter().filter(|alarm| alarm.is_unknown() == unknown);
        alarms.extend(raised.copied().map(Alarm::series));
    };
    raise(&Series::of(good.clone()), false, alarms);
    for claimed in &above {
        match verify(claimed) {
            Ok(verified) => good.push(verified),
            Err(error) if error.is_damage() => alarms.push(Alarm::refused_list(&error, &name_of(&claimed.0))),
            Err(error @ ListRefused::FromTheFuture { .. }) => {
                later.push(Alarm::refused_list(&error, &name_of(&claimed.0)));
            }
            Err(_) => {}
        }
    }
    // The list that another one continues may be in a folder above.
    let series = Series::of(good);
    raise(&series, true, alarms);
    trust.withdrawn = series;
    trust
}

/// Returns the files in the folders above that claim to be lists.
fn lists_above(root: &Path) -> Vec<Claimed> {
    let Ok(root) = root.canonicalize() else { return Vec::new() };
    let folders = root.ancestors().skip(1).take(LEVELS_ABOVE);
    // Errors there are ignored, because those folders are not part of this register.
    let files = folders.flat_map(|folder| Walk::flat(folder, is_lasting).files());
    let lists = files.filter_map(|path| {
        let beginning = files::read_first(&path, BEGINNING_BYTES).ok()?;
        let bytes = claims_to_be_a_list(&beginning).then(|| files::read_first(&path, LARGEST_DOCUMENT_BYTES + 1));
        Some((path, bytes?.ok()?))
    });
    lists.collect()
}

/// Reason why the lists in a folder cannot be continued.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub(crate) enum NoNewestList {
    /// File or folder that cannot be read and may be a list.
    #[error(transparent)]
    File(#[from] FileError),
    /// List that was refused, or lists that contradict each other or are incomplete.
    #[error("{0}")]
    Refused(String),
}

/// Returns the lists of withdrawn passports under `folder`, which a new list in it may continue.
///
/// The folder of the `passports` and those named `revocations` next to it hold one series: if `folder` is one of them,
/// the lists in all of them are returned, because otherwise two lists could have the same number.
///
/// # Errors
/// Returns [`NoNewestList`] if a list is damaged, missing, contradictory, or from a signer who is not trusted, or if the
/// lists of the passports are in other folders.
pub(crate) fn lists(folder: &Path, passports: &Path, trust: &Trust, time: Timestamp) -> Result<Series, NoNewestList> {
    let mut together = folders_of_lists(passports, 0);
    together.push(passports.to_owned());
    let real = |folder: &Path| folder.canonicalize().ok();
    let is_folder = |other: &PathBuf| other == folder || real(other).is_some_and(|other| Some(other) == real(folder));
    if !together.iter().any(is_folder) {
        let beneath =
            together.iter().any(|other| real(folder).zip(real(other)).is_some_and(|(it, at)| it.starts_with(at)));
        if let Some(list) = any_list(&together).filter(|_| !beneath) {
            return Err(NoNewestList::Refused(format!(
                "{}: the lists for {} are elsewhere ({}), and a second series would contradict them; specify their folder \
                 with --list",
                shown(folder),
                shown(passports),
                shown(&list)
            )));
        }
        together = vec![folder.to_owned()];
    }
    let found = Found::under(&together);
    if let Some(error) = found.unreadable.into_iter().next() {
        return Err(error.into());
    }
    let mut lists = Vec::new();
    for path in found.files {
        let bytes = files::read_first(&path, LARGEST_DOCUMENT_BYTES + 1)?;
        if Claim::of(&path, &bytes) == Some(Claim::List) {
            let list = RevocationList::verify(&name_of(&path), &bytes, &trust.signers, &trust.revoked, time);
            lists.push(list.map_err(|refused| NoNewestList::Refused(refused.to_string()))?);
        }
    }
    let series = Series::of(lists);
    if series.alarms().is_empty() {
        return Ok(series);
    }
    let alarms: Vec<String> = series.alarms().iter().map(ToString::to_string).collect();
    Err(NoNewestList::Refused(alarms.join("\n")))
}

fn any_list(folders: &[PathBuf]) -> Option<PathBuf> {
    let is_list =
        |path: &PathBuf| files::read_first(path, BEGINNING_BYTES).is_ok_and(|bytes| claims_to_be_a_list(&bytes));
    Found::under(folders).files.into_iter().find(is_list)
}

fn unreadable(root: &Path, error: &FileError) -> Alarm {
    let why = match error {
        FileError::Read(_, error) => format!("cannot be read: {}", files::reason(error)),
        other => other.to_string(),
    };
    let alarm = Alarm::of_file(AlarmKind::Unreadable, &why, &name_of(error.path()));
    alarm.concerning(concern(root, error.path()))
}

/// Returns `true` if a file is named like passports and lists, `<name>-<number>.yaml`.
pub(crate) fn is_numbered(name: &OsStr) -> bool {
    numbered(name).is_some()
}

/// Returns the name and the number in `<name>-<number>.yaml`, 0 for a number that no revision has, or `None` if the name has
/// another form.
pub(super) fn numbered(name: &OsStr) -> Option<(&str, u32)> {
    let (name, number) = name.to_str()?.strip_suffix(".yaml")?.rsplit_once('-')?;
    let is_number = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
    is_number.then(|| (name, number.parse().unwrap_or(0)))
}
