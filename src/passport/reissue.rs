//! Re-issue of a passport: for another site, a corrected stand, a corrected site or another key.

use super::checks::for_the_issuer;
use super::difference::entries;
use super::issue::{Draft, Issue, IssueRefused, PreparedStand, Reissued};
use super::{CheckName, Code, Content, Predecessor, Stated, Verification};
use crate::document::sha256_hex;
use crate::site::Site;
use crate::stand::{Certificate, Identity, Stand};
use crate::text::{Field, Node, number, rule};
use jiff::Timestamp;
use jiff::civil::Date;
use std::sync::Arc;

/// Changes, reason and issuer of a re-issue.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Reissue {
    /// Corrected stand, or the factory's file of the stand; that of the predecessor if `None`.
    pub stand: Option<Arc<PreparedStand>>,
    /// Other or corrected site; that of the predecessor if `None`.
    pub site: Option<Site>,
    /// Whether the stand has left the predecessor's site, so that the predecessor is superseded.
    pub moved: bool,
    /// Reason for the re-issue.
    pub reason: String,
    /// Issuer.
    pub issuer: String,
    /// Time of issue.
    pub issued_at: Timestamp,
    /// Expiry date (inclusive); if `None`, that of the predecessor, or of the certificate if a stand is given.
    pub valid_until: Option<Date>,
    /// Whether to issue a passport even if its positions do not determine the parameters of a gyro.
    pub allow_uncalibratable: bool,
    /// Whether to issue a successor even if stand, site, issuer and expiry date are those of the predecessor.
    pub same_content: bool,
}

impl Reissue {
    /// Creates a re-issue for the predecessor's site, with the predecessor's stand and expiry date.
    pub fn new(issuer: &str, issued_at: Timestamp, reason: &str) -> Self {
        Self {
            stand: None,
            site: None,
            moved: false,
            reason: reason.to_owned(),
            issuer: issuer.to_owned(),
            issued_at,
            valid_until: None,
            allow_uncalibratable: false,
            same_content: false,
        }
    }
}

/// Reason why a passport was not re-issued.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReissueRefused {
    /// The predecessor or the order breaks a rule, in words.
    #[error("{0}")]
    Rule(String),
    /// The reason is empty or contains a character that a passport cannot contain.
    #[error("the reason is empty or contains a character that is not allowed in signed files; state it in plain words")]
    BadReason,
    /// The new passport cannot be issued.
    #[error(transparent)]
    Issue(#[from] IssueRefused),
}

/// Inputs of a new passport, complete except for its revision.
#[derive(Debug, Clone, PartialEq)]
pub struct Successor {
    stand: Arc<PreparedStand>,
    pub(crate) site: Site,
    /// `true` if the site is that of the predecessor, which the new passport, its next revision, then supersedes.
    pub(crate) same_site: bool,
    old_revision: u32,
    issue: Issue,
    /// `true` if stand, site, issuer and expiry date are those of the predecessor.
    pub(crate) says_the_same: bool,
    /// `true` if the predecessor itself was re-issued for the same reason.
    pub(crate) for_the_same_reason: bool,
    /// `true` if such a successor may be issued.
    pub(crate) may_say_the_same: bool,
}

/// Prepares the successor of a passport. If every check passed, the whole predecessor is used. If its key is no longer
/// trusted, or it was withdrawn or has expired, only its id and its hash are used. Otherwise it cannot be re-issued.
///
/// `old_bytes` is the whole file of the predecessor, `verification` the result of verifying it.
///
/// # Errors
/// Returns [`ReissueRefused`] if the predecessor cannot be used or the order contradicts it.
pub fn successor(old_bytes: &[u8], verification: &Verification, order: &Reissue) -> Result<Successor, ReissueRefused> {
    if order.reason.is_empty() || !order.reason.chars().all(rule::allowed_in_string) {
        return Err(ReissueRefused::BadReason);
    }
    let limit = limit(verification)?;
    let Some(old) = verification.content_from_anyone() else {
        return Err(does_not_hold("schema", "it has no content"));
    };
    let rule = |words: String| Err(ReissueRefused::Rule(words));
    if let Some((check, detail)) = limit.as_ref().filter(|_| order.stand.is_none() || order.site.is_none()) {
        return rule(format!(
            "the numbers of the predecessor cannot be used ({check}: {detail}); pass the factory's files with --stand and \
             --site (for many passports: --sites)"
        ));
    }
    if order.issued_at < old.passport.issued_at {
        let (issued_at, old) = (order.issued_at, old.passport.issued_at);
        return rule(format!("issued_at {issued_at} is earlier than that of the predecessor, {old}; check the clock"));
    }
    let prepared = order.stand.clone().unwrap_or_else(|| Arc::new(PreparedStand::new(old.to_stand())));
    let stand = prepared.stand();
    let site = order.site.clone().unwrap_or_else(|| old.site.clone());
    let name = |stand: &Identity| format!("{} {}", stand.model, stand.serial);
    let (given, known) = (name(&stand.stand), name(&old.stand));
    if given != known {
        return rule(format!(
            "the stand file is for {given}, but the predecessor is for {known}; use `issue` for another stand"
        ));
    }
    let [given_measured, old_measured] = [&stand.certificate, &old.certificate].map(Certificate::measured);
    if limit.is_none() && given_measured < old_measured {
        let [given, old] = [&stand.certificate, &old.certificate].map(|certificate| &certificate.number);
        return rule(format!(
            "certificate {given} was measured on {given_measured}, before certificate {old} ({old_measured}) of the \
             predecessor; use the newest stand file; if the certificate of the predecessor is wrong, withdraw the \
             predecessor, then pass the list with --revoked, and --stand and --site"
        ));
    }
    if limit.is_none() {
        stand.check_number(&old.to_stand()).map_err(ReissueRefused::Rule)?;
    }
    let same_site = site.id == old.site.id;
    if same_site && order.moved {
        return rule(format!(
            "the site is the same ({}); omit --moved, because a new passport for the same site always supersedes its \
             predecessor",
            site.id
        ));
    }
    let old_last_day = old.passport.valid_until.filter(|_| order.stand.is_none());
    let predecessor = Predecessor {
        id: old.passport.id.clone(),
        sha256: sha256_hex(old_bytes),
        reason: order.reason.clone(),
        changed: match &limit {
            None => changes(old, stand, &site, &order.issuer),
            Some(_) => "not compared: issued from the factory's files, with only a reference to the predecessor".into(),
        },
    };
    let issue = Issue {
        issuer: order.issuer.clone(),
        issued_at: order.issued_at,
        valid_until: order.valid_until.or(old_last_day),
        revision: 0,
        reissued: Some(Reissued { from: predecessor, supersedes: same_site || order.moved }),
        // A predecessor that can only be referenced may have been signed by anyone, so nothing is taken from it.
        accuracy: old.accuracy.as_ref().filter(|_| limit.is_none()).map(Stated::of),
        allow_uncalibratable: order.allow_uncalibratable,
    };
    let says_the_same = limit.is_none()
        && *stand == old.to_stand()
        && site == old.site
        && issue.issuer == old.passport.issuer
        && issue.valid_until.or(stand.certificate.valid_until) == old.passport.valid_until;
    let for_the_same_reason = old.passport.reissued_from.as_ref().is_some_and(|from| from.reason == order.reason);
    Ok(Successor {
        stand: prepared,
        site,
        same_site,
        old_revision: old.passport.revision,
        issue,
        says_the_same,
        for_the_same_reason,
        may_say_the_same: order.same_content,
    })
}

/// Returns the check, with its detail, because of which only the id and the hash of a predecessor may be used: the key was
/// lost or revoked, or the passport was withdrawn or has expired; `None` if the whole content may be used.
fn limit(verification: &Verification) -> Result<Option<(&'static str, String)>, ReissueRefused> {
    let mut limit = None;
    for check in verification.checks() {
        let (name, detail) = (check.name.as_str(), for_the_issuer(&check.detail).to_owned());
        match (check.name, check.code) {
            // A predecessor whose signer is no longer trusted is not recomputed, but it can still be referenced.
            // One that another passport supersedes may be re-issued for another site.
            (CheckName::Register, Code::Superseded | Code::Moved | Code::RegisterStale)
            | (_, Code::Ok | Code::NotAsked)
            | (CheckName::Recomputed | CheckName::InForce, Code::NotRun) => {}
            (CheckName::Signer, Code::UnknownKey)
            | (CheckName::Revocation, Code::KeyRevoked)
            | (CheckName::Register, Code::Withdrawn)
            | (CheckName::InForce, Code::Expired) => limit = Some((name, detail)),
            _ => return Err(does_not_hold(name, &detail)),
        }
    }
    Ok(limit)
}

fn does_not_hold(check: &str, detail: &str) -> ReissueRefused {
    ReissueRefused::Rule(format!("the predecessor failed verification ({check}: {detail})"))
}

impl Successor {
    pub(crate) fn supersedes(&self) -> bool {
        self.issue.reissued.as_ref().is_some_and(|reissued| reissued.supersedes)
    }

    pub(crate) fn prepared(&self) -> &PreparedStand {
        &self.stand
    }

    /// Returns the identifier and the SHA-256 of the predecessor.
    pub(crate) fn old(&self) -> (&str, &str) {
        self.issue.reissued.as_ref().map_or(("", ""), |reissued| (&reissued.from.id, &reissued.from.sha256))
    }

    /// Returns the lowest possible revision: the next one at the same site, 1 at another.
    pub(crate) fn first_revision(&self) -> u32 {
        if self.same_site { self.old_revision.saturating_add(1) } else { 1 }
    }

    /// Drafts the passport with this revision, ready to be signed.
    ///
    /// # Errors
    /// Returns the errors of [`PreparedStand::draft`].
    pub fn draft(&self, revision: u32) -> Result<Draft, IssueRefused> {
        self.stand.draft(&self.site, &Issue { revision, ..self.issue.clone() })
    }
}

/// Words of [`changes`] if there are none.
pub(crate) const NO_CHANGES: &str = "no changes in stand, site or issuer";

/// Returns the changes of stand, site and issuer, in words.
pub(crate) fn changes(old: &Content, stand: &Stand, site: &Site, issuer: &str) -> String {
    const MOST: usize = 12;
    let mut changes = Vec::new();
    if old.site.id == site.id {
        compare("site", old.site.write().as_ref(), site.write().as_ref(), &mut changes);
    } else {
        changes.push(format!("site {} -> {}", old.site.id, site.id));
    }
    compare("stand", old.stand.write().as_ref(), stand.stand.write().as_ref(), &mut changes);
    compare("certificate", old.certificate.write().as_ref(), stand.certificate.write().as_ref(), &mut changes);
    compare("datum", old.datum.write().as_ref(), stand.datum.write().as_ref(), &mut changes);
    for position in &stand.positions {
        let name = format!("position {}", position.index());
        let before = old.positions.iter().find(|other| other.index() == position.index());
        compare(&name, before.and_then(Field::write).as_ref(), position.write().as_ref(), &mut changes);
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
    if changes.is_empty() { NO_CHANGES.to_owned() } else { changes.join("; ") }
}

fn compare(path: &str, old: Option<&Node>, new: Option<&Node>, changes: &mut Vec<String>) {
    match (old, new) {
        (old, new) if old == new => {}
        (Some(Node::Map(_)), Some(Node::Map(_))) => {
            for (key, old, new) in entries(old, new) {
                compare(&format!("{path} {key}"), old, new, changes);
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
