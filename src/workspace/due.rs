//! What of a workspace will expire or stop being fresh, in the order of its days.

use super::Workspace;
use crate::document::sha256_hex;
use crate::folder::Folder;
use crate::folder::overview::Overview;
use crate::folder::place::listed_content;
use crate::register::{Row, State, days_until};
use crate::report::columns;
use crate::report::doc::{Block, Words, given, marked};
use crate::report::style::Outcome;
use crate::text::{printable, words};
use crate::wording::texts::status as texts;
use crate::wording::{Language, Text};
use jiff::Timestamp;
use jiff::civil::Date;
use serde::Serialize;

words! {
    /// What ends on a day.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
    #[serde(rename_all = "snake_case")]
    pub(crate) enum What: pub(crate) key {
        /// Current passport.
        PassportExpires = "passport_expires",
        /// Freshness of a register.
        RegisterStale = "register_stale",
        /// Certificate in the file of a stand.
        CertificateExpires = "certificate_expires",
        /// Trusted key.
        KeyExpires = "key_expires",
    }
}

/// Last day of something.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub(crate) struct Due {
    /// Last day (inclusive).
    pub date: Date,
    /// Days until then; negative if it is past.
    pub days_left: i32,
    pub what: What,
    /// Identifier of the passport, the stand, or the principal of the key.
    pub id: String,
    pub site: Option<String>,
    pub certificate: Option<String>,
    pub customer: Option<String>,
}

/// Names of the columns.
const COLUMNS: [&str; 7] = ["date", "days_left", "what", "id", "site", "certificate", "customer"];

/// Days that are listed.
pub(super) struct Horizon {
    pub time: Timestamp,
    pub days: i32,
}

impl Horizon {
    /// Returns what ends on a day, or `None` if that is later than the days that are listed.
    pub(super) fn ends(&self, what: What, id: &str, date: Date) -> Option<Due> {
        let days_left = days_until(self.time, date);
        let (site, certificate, customer) = (None, None, None);
        let due = || Due { date, days_left, what, id: id.to_owned(), site, certificate, customer };
        (days_left <= self.days).then(due)
    }
}

/// Returns the day of a time, UTC.
pub(super) fn day(time: Timestamp) -> Date {
    time.to_zoned(jiff::tz::TimeZone::UTC).date()
}

/// Returns the passports and registers of a workspace that are due.
pub(super) fn of_passports(workspace: &Workspace, overview: &Overview, horizon: &Horizon) -> Vec<Due> {
    let is_here = |row: &&Row| row.state == State::Current && (row.file.is_some() || !workspace.is_of_a_laboratory());
    let passports = overview.rows().filter(is_here).filter_map(|row| {
        let (site, certificate) = (Some(row.site.clone()), Some(row.certificate.clone()));
        let found = horizon.ends(What::PassportExpires, &row.id, row.valid_until?)?;
        Some(Due { site, certificate, customer: customer(workspace, row), ..found })
    });
    let registers =
        overview.stands.iter().filter_map(|of| horizon.ends(What::RegisterStale, &of.stand, of.fresh_until?));
    passports.chain(registers).collect()
}

/// Returns the customer that the listed file of a row states.
fn customer(workspace: &Workspace, row: &Row) -> Option<String> {
    row.file.as_ref()?;
    let path = Folder::new(workspace.passports.as_deref()?).path_of_id(&row.id)?;
    listed_content(&path, &row.sha256)?.stand.customer
}

impl Due {
    fn text(&self) -> Text {
        match self.what {
            What::PassportExpires => texts::PASSPORT_EXPIRES,
            What::RegisterStale => texts::REGISTER_STALE,
            What::CertificateExpires => texts::CERTIFICATE_EXPIRES,
            What::KeyExpires => texts::KEY_EXPIRES,
        }
    }

    /// Returns the number of days with a minus sign: a hyphen begins a formula in a spreadsheet.
    fn days(&self) -> String {
        self.days_left.to_string().replace('-', "\u{2212}")
    }

    fn cells(&self) -> [String; 7] {
        let text = |text: &Option<String>| text.clone().unwrap_or_default();
        let [site, certificate, customer] = [&self.site, &self.certificate, &self.customer].map(text);
        [self.date.to_string(), self.days(), self.what.key().to_owned(), self.id.clone(), site, certificate, customer]
    }
}

/// Returns what is due as lines of a document.
pub(crate) fn lines(all: &[Due], days: i32) -> Vec<Block> {
    let line = |due: &Due| {
        let outcome = if due.days_left < 0 { Outcome::Failed } else { Outcome::Undecided };
        let more = [&due.certificate, &due.customer].into_iter().flatten().flat_map(|word| ["  ".into(), given(word)]);
        let id: Vec<Words> = [given(&due.id)].into_iter().chain(more).collect();
        vec![marked(outcome, due.date), texts::days_left(due.days()), due.text().into(), id.into()]
    };
    let nothing = || vec![texts::nothing_due(days.to_string())];
    let lines = if all.is_empty() { vec![nothing()] } else { all.iter().map(line).collect() };
    vec![Block::Whole("", lines)]
}

/// Returns what is due as CSV. In Russian, semicolons are between the columns and a byte order mark is in front, so that a
/// spreadsheet program opens it; no cell begins as a formula does.
pub(crate) fn csv(all: &[Due], language: Language) -> String {
    let separator = if language == Language::Russian { ";" } else { "," };
    let row = |cells: [String; 7]| columns::csv_row(separator, cells.iter().map(String::as_str));
    let start = if language == Language::Russian { "\u{FEFF}" } else { "" };
    let rows = all.iter().map(|due| row(due.cells()));
    [start.to_owned(), row(COLUMNS.map(str::to_owned))].into_iter().chain(rows).collect()
}

/// Returns what is due as a calendar ([RFC 5545](https://www.rfc-editor.org/rfc/rfc5545)), an event for each day that something
/// ends. The same event has the same UID whenever it is written.
pub(crate) fn ics(all: &[Due], time: Timestamp, language: Language) -> String {
    let mut out = String::new();
    let mut line = |text: String| {
        // A line has at most 75 bytes; a longer one goes on after a space.
        let mut length = 0;
        for c in text.chars() {
            if length + c.len_utf8() > 75 {
                out.push_str("\r\n ");
                length = 1;
            }
            out.push(c);
            length += c.len_utf8();
        }
        out.push_str("\r\n");
    };
    let escaped = |text: &str| printable(text).replace('\\', "\\\\").replace(';', "\\;").replace(',', "\\,");
    let head = ["BEGIN:VCALENDAR", "VERSION:2.0", "PRODID:-//dtg-passport//status//EN"];
    head.iter().for_each(|text| line((*text).to_owned()));
    for due in all {
        let uid = sha256_hex(format!("{}\n{}\n{}", due.id, due.what.key(), due.date).as_bytes());
        let more = [&due.certificate, &due.customer].into_iter().flatten().map(|word| format!(", {word}"));
        let summary = format!("{}: {}{}", due.text().of(language), due.id, more.collect::<String>());
        line("BEGIN:VEVENT".to_owned());
        line(format!("UID:{}@dtg-passport", &uid[..32]));
        line(format!("DTSTAMP:{}", time.strftime("%Y%m%dT%H%M%SZ")));
        line(format!("DTSTART;VALUE=DATE:{}", due.date.strftime("%Y%m%d")));
        line(format!("SUMMARY:{}", escaped(&summary)));
        line("TRANSP:TRANSPARENT".to_owned());
        line("END:VEVENT".to_owned());
    }
    line("END:VCALENDAR".to_owned());
    out
}
