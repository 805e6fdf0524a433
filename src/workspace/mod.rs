//! Workspace of a factory or a laboratory: a folder whose `dtg-passport.toml` states the key, the issuer, the trusted
//! keys and the folders of all commands.
//!
//! * `certificate`: the files and passports of one certificate.
//! * `due`: what ends, and when.
//! * `layout`: a new workspace.
//! * `results`: calibrations in a laboratory.
//! * `status`: the contents of a workspace.

mod certificate;
pub(crate) mod due;
mod layout;
mod results;
mod status;

pub(crate) use certificate::Trace;
pub(crate) use layout::{Kind, NotMade, make};
pub(crate) use results::{NoPassport, Results, serial_of};
pub(crate) use status::{SOON_DAYS, status};

use crate::files::{self, FileError};
use crate::folder::overview::Query;
use crate::folder::{Folder, Memory};
use crate::interface::enquiry::place_of;
use crate::parallel;
use crate::passport::{Question, Trust};
use crate::text::node::{location_of, odd_character, utf8, without_byte_order_mark};
use crate::text::scalar::identifiers;
use crate::text::{LARGEST_DOCUMENT_BYTES, Location, Problem, Unreadable, misspelt, name_of};
use crate::wording::Language;
use std::path::{Path, PathBuf};
use toml::de::{DeTable, DeValue};

/// Name of the file in the folder of a workspace.
pub(crate) const WORKSPACE_FILE: &str = "dtg-passport.toml";

/// Folder of the last accepted register of each stand.
const REGISTERS_FOLDER: &str = "registers";

const KEYS: [&str; 13] = [
    "key",
    "identity",
    "register_key",
    "trust",
    "passports",
    "stands",
    "sites",
    "lang",
    "stand",
    "at",
    "laboratory",
    "gyro",
    "results",
];

/// Workspace: the values that the options of commands have if they are not given. Paths begin with that of its folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Workspace {
    pub root: PathBuf,
    pub key: Option<PathBuf>,
    /// Issuer: the principal of the key in `trust`.
    pub identity: Option<String>,
    /// Key that signs registers, if not [`Self::key`].
    pub register_key: Option<PathBuf>,
    /// Trusted signing keys (allowed_signers).
    pub trust: Option<PathBuf>,
    pub passports: Option<PathBuf>,
    pub stands: Option<PathBuf>,
    pub sites: Option<PathBuf>,
    /// Language of what is printed.
    pub lang: Option<Language>,
    /// Stands of a laboratory, `<model>/<serial>`.
    pub stand: Vec<String>,
    /// Place of the stands, as `--at` takes it.
    pub at: Option<String>,
    /// Laboratory, and type of the gyros.
    pub laboratory: Option<PathBuf>,
    pub gyro: Option<PathBuf>,
    /// Folder of the results of calibrations.
    pub results: Option<PathBuf>,
    /// Last accepted registers, in the folder `registers`.
    memory: Memory,
}

/// Reason why a workspace cannot be used.
#[derive(Debug, thiserror::Error)]
pub(crate) enum NoWorkspace {
    #[error(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    Unreadable(#[from] Unreadable),
}

impl Workspace {
    pub(crate) fn read(root: &Path) -> Result<Self, NoWorkspace> {
        let path = root.join(WORKSPACE_FILE);
        let bytes = files::read(&path, LARGEST_DOCUMENT_BYTES)?;
        Ok(Self::from_toml(root, &name_of(&path), &bytes).map_err(|unreadable| unreadable.in_text(&bytes))?)
    }

    /// Returns `true` if the workspace cannot sign. It then need not have every passport of a stand.
    pub(crate) fn is_of_a_laboratory(&self) -> bool {
        self.key.is_none()
    }

    fn from_toml(root: &Path, name: &str, bytes: &[u8]) -> Result<Self, Unreadable> {
        let bytes = without_byte_order_mark(bytes);
        let text = utf8(name, bytes, None)?;
        let (table, errors) = DeTable::parse_recoverable(text);
        if let Some((at, found, cause)) = odd_character(text).filter(|_| !errors.is_empty()) {
            return Err(Unreadable::whole(name, Some(location(bytes, at)), found, "lines of TOML", cause));
        }
        let mut problems: Vec<Problem> = errors
            .iter()
            .map(|error| {
                let at = error.span().map(|span| location(bytes, span.start));
                let found = format!("invalid TOML ({})", error.message().lines().collect::<Vec<_>>().join(", "));
                Problem::new(at, "", found, "lines such as trust = \"allowed_signers\", each key once", "")
            })
            .collect();
        let language = |tag: &str| Language::ALL.into_iter().find(|language| language.tag() == tag);
        let mut values: [Vec<String>; KEYS.len()] = Default::default();
        for (key, value) in table.get_ref().iter() {
            let Some(index) = KEYS.iter().position(|known| known == key.get_ref()) else {
                problems.push(unknown_key(key.get_ref(), location(bytes, key.span().start)));
                continue;
            };
            let name = KEYS[index];
            let one = |value: &DeValue| value.as_str().filter(|text| !text.is_empty()).map(str::to_owned);
            let found = match value.get_ref() {
                DeValue::Array(all) if name == "stand" => all.iter().map(|value| one(value.get_ref())).collect(),
                value => one(value).map(|text| vec![text]),
            };
            let mut refuse = |found: String, expected: &str, advice: &str| {
                problems.push(Problem::new(Some(location(bytes, value.span().start)), name, found, expected, advice));
            };
            let Some(found) = found else {
                refuse(text.get(value.span()).unwrap_or("nothing").to_owned(), "text", "put it in double quotes");
                continue;
            };
            let is_stand = |text: &String| named::<2>(text).is_some();
            match (name, found.first()) {
                ("lang", Some(tag)) if language(tag).is_none() => refuse(format!("{tag:?}"), "\"en\" or \"ru\"", ""),
                ("stand", _) if !found.iter().all(is_stand) => {
                    refuse(format!("{found:?}"), "\"MODEL/SERIAL\", or a list of such texts", "");
                }
                ("at", Some(at)) => match place_of(at) {
                    Ok(_) => values[index] = found,
                    Err(why) => refuse(format!("{at:?}"), "latitude and longitude", &why),
                },
                _ => values[index] = found,
            }
        }
        if !problems.is_empty() {
            problems.sort_by_key(|problem| problem.location.map(|at| (at.line, at.column)));
            return Err(Unreadable::of(name, problems));
        }
        let [key, identity, register_key, trust, passports, stands, sites, lang, stand, at, laboratory, gyro, results] =
            values;
        let path = |stated: Vec<String>| stated.first().map(|stated| root.join(stated));
        Ok(Self {
            root: root.to_owned(),
            key: path(key),
            identity: identity.into_iter().next(),
            register_key: path(register_key),
            trust: path(trust),
            passports: path(passports),
            stands: path(stands),
            sites: path(sites),
            lang: lang.first().and_then(|tag| language(tag)),
            stand,
            at: at.into_iter().next(),
            laboratory: path(laboratory),
            gyro: path(gyro),
            results: path(results),
            memory: Memory::new(root.join(REGISTERS_FOLDER)),
        })
    }

    /// Returns the workspace that [`make`] makes for a laboratory with these stands.
    pub(crate) fn of_a_new_laboratory(root: &Path, stands: &[String]) -> Result<Self, Unreadable> {
        let text = layout::settings(&Kind::Laboratory(stands)).unwrap_or_default();
        Self::from_toml(root, WORKSPACE_FILE, text.as_bytes())
    }

    /// Returns the memory of the last accepted registers.
    pub(crate) fn memory(&self) -> &Memory {
        &self.memory
    }

    /// Returns the query of a folder of passports, which is perhaps that of a workspace.
    pub(crate) fn query<'a>(workspace: Option<&'a Self>, trust: &'a Trust, question: &'a Question) -> Query<'a> {
        let may_lack = workspace.is_some_and(Self::is_of_a_laboratory);
        Query { trust, question, memory: workspace.map(Self::memory), may_lack, threads: parallel::processors() }
    }

    /// Returns the path of the stand file of `MODEL/SERIAL`, or `None` if `name` is not of this form.
    pub(crate) fn stand(&self, name: &str) -> Option<PathBuf> {
        let [model, serial] = named(name)?;
        Some(self.stands.as_ref()?.join(model).join(serial).join("stand.yaml"))
    }

    /// Returns the path of the file of the site `id`, or `None` if it is not an identifier.
    pub(crate) fn site(&self, id: &str) -> Option<PathBuf> {
        let [id] = named(id)?;
        Some(self.sites.as_ref()?.join(format!("{id}.yaml")))
    }

    /// Returns the path of the passport with the identifier `id`, or for `MODEL/SERIAL` the folder of the passports of
    /// this stand; `None` if it is neither. Without its revision the identifier leads to a path that does not exist, and
    /// next to which the passport is.
    pub(crate) fn passport(&self, id: &str) -> Option<PathBuf> {
        let root = self.passports.as_ref()?;
        match (named(id), named(id), named::<4>(id)) {
            (Some([model, serial]), ..) => Some(root.join(model).join(serial)),
            (_, Some([model, serial, site]), _) => Some(root.join(model).join(serial).join(format!("{site}.yaml"))),
            (.., Some(_)) => Folder::new(root).path_of_id(id),
            _ => None,
        }
    }
}

/// Returns the identifiers in a text as [`identifiers`] does, unless one is that of a file of YAML or of a table.
fn named<const N: usize>(text: &str) -> Option<[&str; N]> {
    let is_file = |name: &&str| [".yaml", ".yml", ".csv"].iter().any(|end| name.to_lowercase().ends_with(end));
    identifiers(text).filter(|names| !names.iter().any(is_file))
}

fn unknown_key(key: &str, at: Location) -> Problem {
    let advice = misspelt::key(&KEYS, key).map_or_else(|| "delete it".to_owned(), misspelt::question);
    Problem::new(Some(at), "", format!("unknown key {key:?}"), format!("one of {}", KEYS.join(", ")), advice)
}

/// Returns the line and column of a byte.
fn location(bytes: &[u8], place: usize) -> Location {
    location_of(&bytes[..place.min(bytes.len())])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Workspace, String> {
        Workspace::from_toml(Path::new("w"), "w.toml", text.as_bytes()).map_err(|error| error.to_string())
    }

    #[test]
    fn paths_are_relative_to_the_workspace() {
        let found =
            read("key = \"keys/f.key\" # secret\nidentity = 'f@example.org'\ntrust = \"/etc/signers\"\n").unwrap();
        assert_eq!(found.key, Some(PathBuf::from("w/keys/f.key")));
        assert_eq!(found.identity.as_deref(), Some("f@example.org"));
        assert_eq!(found.trust, Some(PathBuf::from("/etc/signers")));
        assert_eq!((&found.passports, &found.stands, &found.sites), (&None, &None, &None));
        assert_eq!(found.passport("SPS-2/0017/here/1"), None);
        let found = read("passports = \"p\"\nstands = \"s\"\r\nsites = \"t\"").unwrap();
        assert_eq!(found.passport("SPS-2/0017/here/1"), Some(PathBuf::from("w/p/SPS-2/0017/here-1.yaml")));
        assert_eq!(found.passport("../here"), None);
        assert_eq!(found.stand("SPS-2/0017"), Some(PathBuf::from("w/s/SPS-2/0017/stand.yaml")));
        assert_eq!(found.site("here"), Some(PathBuf::from("w/t/here.yaml")));
        assert!(read("").is_ok());
    }

    #[test]
    fn every_mistake_has_its_line() {
        for (text, due) in [
            (
                "trust = \"a\"\ntrusts = \"b\"",
                "w.toml:2:1: found unknown key \"trusts\", expected one of key, identity, register_key, ",
            ),
            ("trust = \"a\"\nkeys = \"b\"", "did you mean key?"),
            ("trust = \"a\"\n\ntrust = \"b\"\n", "w.toml:3:1: found invalid TOML (duplicate key"),
            ("[paths]\ntrust = \"a\"", "w.toml:1:2: found unknown key \"paths\""),
            ("trust = 5", "w.toml:1:9: trust: found 5, expected text; put it in double quotes"),
            ("trust = allowed_signers", "w.toml:1:9: found invalid TOML ("),
            ("key = \"\"", "w.toml:1:7: key: found \"\", expected text"),
            ("lang = \"de\"", "w.toml:1:8: lang: found \"de\", expected \"en\" or \"ru\""),
        ] {
            let refused = read(text).unwrap_err();
            assert!(refused.contains(due), "{text}\n{refused}\n  lacks {due}");
        }
        let two = read("kye = \"a\"\ntrust = \"b\"\nsite = \"c\"").unwrap_err();
        assert_eq!(two.lines().count(), 2, "{two}");
    }
}
