//! Entry of a register beside its file, for lists and histories.

use super::{Entry, State};
use jiff::Timestamp;
use jiff::civil::Date;
use serde::Serialize;

/// Passport in a register, and its file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Row {
    pub id: String,
    /// File; null if it is missing or has other content.
    pub file: Option<String>,
    pub sha256: String,
    pub state: State,
    /// Whether the passport has expired.
    pub expired: bool,
    pub site: String,
    pub certificate: String,
    pub valid_until: Option<Date>,
    pub since: Option<Timestamp>,
    pub by: Option<String>,
    pub reason: Option<String>,
    #[serde(skip)]
    pub issued_at: Timestamp,
}

impl Row {
    pub(crate) fn of(entry: &Entry, time: Timestamp) -> Self {
        Self {
            id: entry.id.clone(),
            file: None,
            sha256: entry.sha256.clone(),
            state: entry.state,
            expired: entry.is_expired(time),
            site: entry.site_and_revision().0.to_owned(),
            certificate: entry.certificate.clone(),
            valid_until: entry.valid_until,
            since: entry.since,
            by: entry.by.clone(),
            reason: entry.reason.clone(),
            issued_at: entry.issued_at,
        }
    }

    /// Returns `true` if the passport is current and has not expired.
    pub(crate) fn is_in_force(&self) -> bool {
        self.state == State::Current && !self.expired
    }

    /// Returns the number of days until the last day, or `None` if the passport does not expire.
    pub(crate) fn days_left(&self, time: Timestamp) -> Option<i32> {
        self.valid_until.map(|last| days_until(time, last))
    }
}

/// Returns the number of days from a time to a day, both UTC; negative if it is past.
pub(crate) fn days_until(time: Timestamp, last: Date) -> i32 {
    time.to_zoned(jiff::tz::TimeZone::UTC).date().until(last).map_or(i32::MAX, |span| span.get_days())
}
