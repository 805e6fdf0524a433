//! A new passport from an old one: another site, a corrected stand, a corrected site, another key.

use super::accuracy::Stated;
use super::checks::{CheckName, Code};
use super::content::{Content, Predecessor};
use super::issue::{Draft, Issue, IssueRefused, PreparedStand, Reissued};
use super::verification::Verification;
use crate::document::sha256_hex;
use crate::site::Site;
use crate::stand::{STAND_FORMAT, Stand};
use crate::text::{Field, Node, number, rule};
use jiff::Timestamp;
use jiff::civil::Date;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What is to be issued anew, and by whom.
#[derive(Debug, Clone, PartialEq)]
pub struct Order {
    /// A corrected stand, or the factory's file of it; the old passport's when `None`.
    pub stand: Option<Arc<PreparedStand>>,
    /// Another or a corrected site; the old passport's when `None`.
    pub site: Option<Site>,
    /// The stand has left the old site, whose passport is superseded.
    pub moved: bool,
    /// Why.
    pub reason: String,
    /// The issuer.
    pub issuer: String,
    /// When.
    pub issued_at: Timestamp,
    /// Last day of the passport; when `None` the old passport's, or a new stand's certificate's.
    pub valid_until: Option<Date>,
    /// Whether a passport is issued even if its positions do not determine the parameters of a gyro.
    pub allow_uncalibratable: bool,
}

/// Why a passport is not issued anew.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReissueRefused {
    /// The old passport does not hold.
    #[error("the predecessor failed verification ({check}: {detail})")]
    OldDoesNotHold {
        /// The check that failed.
        check: &'static str,
        /// In its words.
        detail: String,
    },
    /// Its signature no longer counts, and the factory's files were not given.
    #[error(
        "the predecessor can be referenced but not used as input ({check}: {detail}); pass the factory's files with \
         --stand and --site (for many passports: --sites)"
    )]
    NeedsFactoryFiles {
        /// The check that failed.
        check: &'static str,
        /// In its words.
        detail: String,
    },
    /// The stand file is of another stand.
    #[error("the stand file is for {given}, but the predecessor is for {old}; use `issue` for another stand")]
    OtherStand {
        /// Model and serial in the file.
        given: String,
        /// Model and serial in the passport.
        old: String,
    },
    /// `moved` without another site.
    #[error(
        "the site is the same ({0}); omit --moved, because a new passport for the same site always supersedes its \
             predecessor"
    )]
    NotMoved(String),
    /// The reason cannot stand in a passport.
    #[error("the reason is empty or contains a character that is not allowed in signed files")]
    BadReason,
    /// The new passport would be older than the old one.
    #[error("issued_at {issued_at} is earlier than that of the predecessor, {old}; check the clock")]
    BeforeOld {
        /// When the new one would be issued.
        issued_at: Timestamp,
        /// When the old one was.
        old: Timestamp,
    },
    /// No such passport can be issued.
    #[error(transparent)]
    Issue(#[from] IssueRefused),
}

/// What a new passport is made of; only its revision is open.
#[derive(Debug, Clone, PartialEq)]
pub struct Successor {
    stand: Arc<PreparedStand>,
    site: Site,
    same_site: bool,
    old_revision: u32,
    issue: Issue,
    says_the_same: bool,
    for_the_same_reason: bool,
    rival: Option<PathBuf>,
}

/// Decides what follows from the old passport: everything, when every check passed; its id and hash alone, when its key
/// is no longer trusted or its time is over; nothing, when it does not hold.
///
/// `old_bytes` is the whole old file, `verification` the answer about it.
///
/// # Errors
/// See [`ReissueRefused`].
pub fn successor(old_bytes: &[u8], verification: &Verification, order: &Order) -> Result<Successor, ReissueRefused> {
    if order.reason.is_empty() || !order.reason.chars().all(rule::allowed_in_string) {
        return Err(ReissueRefused::BadReason);
    }
    let usable = usable(verification)?;
    let Some(old) = verification.content_from_anyone() else {
        return Err(ReissueRefused::OldDoesNotHold { check: "schema", detail: "it has no content".to_owned() });
    };
    if let (Usable::NameOnly { check, detail }, false) = (&usable, order.stand.is_some() && order.site.is_some()) {
        return Err(ReissueRefused::NeedsFactoryFiles { check, detail: detail.clone() });
    }
    if order.issued_at < old.passport.issued_at {
        let (issued_at, old) = (order.issued_at, old.passport.issued_at);
        return Err(ReissueRefused::BeforeOld { issued_at, old });
    }
    let prepared = order.stand.clone().unwrap_or_else(|| Arc::new(PreparedStand::new(stand_of(old))));
    let stand = prepared.stand();
    let site = order.site.clone().unwrap_or_else(|| old.site.clone());
    let name = |model: &dyn std::fmt::Display, serial: &dyn std::fmt::Display| format!("{model} {serial}");
    let (given, known) = (name(&stand.stand.model, &stand.stand.serial), name(&old.stand.model, &old.stand.serial));
    if given != known {
        return Err(ReissueRefused::OtherStand { given, old: known });
    }
    let same_site = site.id == old.site.id;
    if same_site && order.moved {
        return Err(ReissueRefused::NotMoved(site.id.to_string()));
    }
    let old_last_day = old.passport.valid_until.filter(|_| order.stand.is_none());
    let predecessor = Predecessor {
        id: old.passport.id.clone(),
        sha256: sha256_hex(old_bytes),
        reason: order.reason.clone(),
        changed: match &usable {
            Usable::Whole => changes(old, stand, &site, &order.issuer),
            Usable::NameOnly { .. } => {
                "not compared: issued from the factory's files, with only a reference to the predecessor".into()
            }
        },
    };
    let issue = Issue {
        issuer: order.issuer.clone(),
        issued_at: order.issued_at,
        valid_until: order.valid_until.or(old_last_day),
        revision: 0,
        reissued: Some(Reissued { from: predecessor, supersedes: same_site || order.moved }),
        // Of a passport that may only be named nothing is taken over, whoever may have signed it.
        accuracy: match &usable {
            Usable::Whole => old.accuracy.as_ref().map(Stated::of),
            Usable::NameOnly { .. } => None,
        },
        allow_uncalibratable: order.allow_uncalibratable,
    };
    let says_the_same = matches!(usable, Usable::Whole)
        && *stand == stand_of(old)
        && site == old.site
        && issue.issuer == old.passport.issuer
        && issue.valid_until.or(stand.certificate.valid_until) == old.passport.valid_until;
    let for_the_same_reason = old.passport.reissued_from.as_ref().is_some_and(|from| from.reason == order.reason);
    let old_revision = old.passport.revision;
    Ok(Successor {
        stand: prepared,
        site,
        same_site,
        old_revision,
        issue,
        says_the_same,
        for_the_same_reason,
        rival: None,
    })
}

/// How much of an old passport may be used.
enum Usable {
    /// All of it.
    Whole,
    /// Its id and its hash: the key was lost or revoked, or its time is over.
    NameOnly { check: &'static str, detail: String },
}

fn usable(verification: &Verification) -> Result<Usable, ReissueRefused> {
    let mut usable = Usable::Whole;
    for check in verification.checks() {
        let (name, detail) = (check.name.as_str(), check.detail.clone());
        match (check.name, check.code) {
            // What is not computed of a signer who is no longer trusted is not needed to name the passport.
            (_, Code::Ok) | (CheckName::Recomputed | CheckName::InForce, Code::NotRun) => {}
            (CheckName::Signer, Code::UnknownKey)
            | (CheckName::Revocation, Code::KeyRevoked)
            | (CheckName::InForce, Code::Expired) => usable = Usable::NameOnly { check: name, detail },
            _ => return Err(ReissueRefused::OldDoesNotHold { check: name, detail }),
        }
    }
    Ok(usable)
}

fn stand_of(old: &Content) -> Stand {
    Stand {
        format: STAND_FORMAT.to_owned(),
        stand: old.stand.clone(),
        certificate: old.certificate.clone(),
        datum: old.datum.clone(),
        positions: old.positions.clone(),
    }
}

impl Successor {
    /// Whether it is for the old passport's site: then it is its next revision, and supersedes it.
    pub(crate) fn same_site(&self) -> bool {
        self.same_site
    }

    /// Whether it would say of stand, site, issuer and last day what the old passport says.
    pub(crate) fn says_the_same(&self) -> bool {
        self.says_the_same
    }

    /// Whether the old passport was itself issued anew, and for the reason given now.
    pub(crate) fn for_the_same_reason(&self) -> bool {
        self.for_the_same_reason
    }

    /// Returns `true` if the old passport will no longer be used.
    pub(crate) fn supersedes(&self) -> bool {
        self.issue.reissued.as_ref().is_some_and(|reissued| reissued.supersedes)
    }

    /// Returns the same successor beside `rival`, the file of a passport that supersedes the same old one.
    pub(crate) fn beside(self, rival: Option<PathBuf>) -> Self {
        Self { rival, ..self }
    }

    /// Returns the file of another passport that supersedes the same old one, or `None` if none is known.
    pub(crate) fn rival(&self) -> Option<&Path> {
        self.rival.as_deref()
    }

    /// The stand it is of.
    pub(crate) fn stand(&self) -> &Stand {
        self.stand.stand()
    }

    /// The site it is for.
    pub(crate) fn site(&self) -> &Site {
        &self.site
    }

    /// SHA-256 of the old passport.
    pub(crate) fn old_sha256(&self) -> &str {
        self.issue.reissued.as_ref().map_or("", |reissued| &reissued.from.sha256)
    }

    /// The revision that it has at least: the next one at the same site, 1 at another.
    pub(crate) fn first_revision(&self) -> u32 {
        if self.same_site { self.old_revision.saturating_add(1) } else { 1 }
    }

    /// The passport with this revision, ready to be signed.
    ///
    /// # Errors
    /// See [`IssueRefused`].
    pub fn draft(&self, revision: u32) -> Result<Draft, IssueRefused> {
        self.stand.draft(&self.site, &Issue { revision, ..self.issue.clone() })
    }
}

/// What differs from the old passport, in words.
pub(crate) fn changes(old: &Content, stand: &Stand, site: &Site, issuer: &str) -> String {
    const MOST: usize = 12;
    let mut changes = Vec::new();
    let compare = |key: &str, old: Option<Node>, new: Option<Node>, changes: &mut Vec<String>| {
        compare(key, old.as_ref(), new.as_ref(), changes);
    };
    if old.site.id == site.id {
        compare("site", old.site.write(), site.write(), &mut changes);
    } else {
        changes.push(format!("site {} -> {}", old.site.id, site.id));
    }
    compare("stand", old.stand.write(), stand.stand.write(), &mut changes);
    compare("certificate", old.certificate.write(), stand.certificate.write(), &mut changes);
    compare("datum", old.datum.write(), stand.datum.write(), &mut changes);
    for position in &stand.positions {
        let name = format!("position {}", position.index());
        let before = old.positions.iter().find(|other| other.index() == position.index());
        compare(&name, before.and_then(Field::write), position.write(), &mut changes);
    }
    for position in &old.positions {
        if !stand.positions.iter().any(|other| other.index() == position.index()) {
            changes.push(format!("position {} removed", position.index()));
        }
    }
    if old.passport.issuer != issuer {
        changes.push(format!("issuer {} -> {issuer}", old.passport.issuer));
    }
    let more = changes.len().saturating_sub(MOST);
    changes.truncate(MOST);
    if more > 0 {
        changes.push(format!("and {more} more"));
    }
    if changes.is_empty() { "no changes in stand, site or issuer".to_owned() } else { changes.join("; ") }
}

fn compare(path: &str, old: Option<&Node>, new: Option<&Node>, changes: &mut Vec<String>) {
    match (old, new) {
        (old, new) if old == new => {}
        (Some(Node::Map(before)), Some(Node::Map(after))) => {
            let keys = before.iter().chain(after.iter().filter(|(key, _)| !before.iter().any(|(name, _)| name == key)));
            for (key, _) in keys {
                let of = |entries: &[(String, Node)]| {
                    entries.iter().find(|(name, _)| name == key).map(|(_, value)| value.clone())
                };
                compare(&format!("{path} {key}"), of(before).as_ref(), of(after).as_ref(), changes);
            }
        }
        (None, Some(Node::Map(_))) => changes.push(format!("{path} added")),
        (Some(Node::Map(_)), None) => changes.push(format!("{path} removed")),
        (old, new) => changes.push(format!("{path} {} -> {}", words(old), words(new))),
    }
}

fn words(node: Option<&Node>) -> String {
    match node {
        None => "nothing".to_owned(),
        Some(Node::Text(text)) => format!("'{text}'"),
        Some(Node::Number(value)) => number::decimal(*value),
        Some(Node::List(items)) => {
            let items: Vec<String> = items.iter().map(|item| words(Some(item))).collect();
            format!("[{}]", items.join(", "))
        }
        Some(other) => other.describe(),
    }
}
