//! Issue of one passport into a folder.

use super::enquiry::{date, read, time, trust};
use super::{Asked, Failed, UNWRITABLE};
use crate::folder::{Authority, Folder, FolderRefused, Issued, StandFolder};
use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::passport::Stated;
use crate::passport::issue::{Issue, PreparedStand, time_of_issue};
use crate::signing::{Signer, own_trust};
use crate::site::Site;
use crate::stand::Stand;
use crate::text::Field;
use crate::trust::check_identity;
use jiff::Timestamp;
use std::path::Path;

/// Name and content of a file.
type File<'a> = (&'a str, &'a [u8]);

/// Issues the passport of a stand for a site into the folder `out`, as the program's `issue` does. An equal passport is
/// left unchanged, and no passport is replaced. The register of the stand, next to it, lists it.
///
/// The files are names and contents. `order` is JSON, `{identity, issued_at, valid_until, allow_uncalibratable}`, of
/// which only `identity` must be present; `issued_at` is `now` by default. With `accuracy` the passport states the
/// uncertainty of a calibration, by default that of the paper's gyro and meter. With `signers`, an allowed_signers file,
/// it is written only if it passes verification. The second part of the result is what the factory should know about the
/// passport, a sentence each; empty for a passport that existed.
///
/// # Errors
/// Returns [`Failed`] if an input cannot be used, if the passport is refused, or if it cannot be signed or written. No
/// file is then left.
pub fn issue(
    [stand, site]: [File; 2],
    order: &str,
    accuracy: Option<[Option<File>; 2]>,
    signer: &(dyn Signer + Sync),
    signers: Option<File>,
    out: &Path,
    now: Timestamp,
) -> Result<(Issued, Vec<String>), Failed> {
    let stand = PreparedStand::new(Stand::from_yaml(stand.0, stand.1)?);
    let site = Site::from_yaml(site.0, site.1)?;
    let now = Timestamp::from_second(now.as_second()).unwrap_or(now);
    let order = Issue { accuracy: accuracy.map(stated).transpose()?, ..ordered(order, now)? };
    check_identity(&order.issuer).map_err(Failed::unusable)?;
    let trust = signers.map(|signers| trust(signers, &[])).transpose()?;
    let folder = Folder::new(out);
    let trust = trust.or_else(|| own_trust(&order.issuer, &signer.public_key()?, None));
    let unknown =
        || Failed::unusable("the public half of the key is not known before it signs; specify allowed_signers");
    let (trust, clock) = (trust.ok_or_else(unknown)?, || now);
    let authority = Authority::new(&order.issuer, signer, &trust, &clock);
    let failed = |refused| match refused {
        FolderRefused::File(error) => Failed { code: UNWRITABLE, ..error.into() },
        refused if refused.is_unusable() => Failed::unusable(refused),
        refused => Failed::refused(refused),
    };
    let name = format!("{}-{}.yaml", site.id, order.revision);
    let of_stand = StandFolder::open(&folder, &stand.stand().stand.id(), &authority, |other| other == name);
    let of_stand = of_stand.map_err(failed)?;
    let mut words = of_stand.against_certificate(&stand).map_err(failed)?;
    let issued = of_stand.settle(|| of_stand.next_first(&stand, &site, &order)).map_err(failed)?;
    of_stand.list().map_err(failed)?;
    if issued.new {
        words.extend(issued.remarks.words());
    }
    Ok((issued, words))
}

/// Parses an order; its accuracy is not in it.
fn ordered(order: &str, now: Timestamp) -> Result<Issue, Failed> {
    let mut asked = Asked::new("order", order)?;
    let identity = asked.key("identity", String::read);
    let (issued_at, valid_until) = (asked.key("issued_at", String::read), asked.key("valid_until", String::read));
    let allow_uncalibratable = asked.key("allow_uncalibratable", bool::read).unwrap_or_default();
    asked.done()?;
    let identity = identity.ok_or_else(|| Failed::unusable("identity: missing, expected the principal of the key"))?;
    let issued_at = issued_at.map(|text| read("issued_at", &text, time));
    let valid_until = valid_until.map(|text| read("valid_until", &text, date));
    let issued_at = time_of_issue(issued_at.transpose()?, now).map_err(Failed::refused)?;
    let first = Issue::first(&identity, issued_at);
    Ok(Issue { valid_until: valid_until.transpose()?, allow_uncalibratable, ..first })
}

/// Reads a gyro type and a laboratory, by default those of the paper.
pub(super) fn stated([gyro, laboratory]: [Option<File>; 2]) -> Result<Stated, Failed> {
    let gyro = gyro.map_or_else(|| Ok(GyroType::gvk_6()), |(name, bytes)| GyroType::from_yaml(name, bytes))?;
    let paper = || Ok(Laboratory::paper());
    let laboratory = laboratory.map_or_else(paper, |(name, bytes)| Laboratory::from_yaml(name, bytes))?;
    Ok(Stated { gyro, laboratory })
}
