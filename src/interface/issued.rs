//! Issue of one passport into a folder.

use super::enquiry::{date, read, time, trust};
use super::{Asked, Failed, UNWRITABLE};
use crate::folder::{Folder, FolderRefused, Issued, Seal};
use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::passport::Stated;
use crate::passport::issue::{Issue, PreparedStand, time_of_issue};
use crate::signing::{Signer, own_trust};
use crate::site::Site;
use crate::stand::Stand;
use crate::text::Field;
use jiff::Timestamp;
use std::path::Path;

/// Name and content of a file.
type File<'a> = (&'a str, &'a [u8]);

/// Issues the passport of a stand for a site into the folder `out`, as the program's `issue` does. An equal passport is
/// left unchanged, and no file is replaced.
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
    let trust = signers.map(|signers| trust(signers, &[], now)).transpose()?;
    let folder = Folder::new(out);
    let believed = trust.clone().or_else(|| own_trust(&order.issuer, &signer.public_key()?));
    let known = |trust| folder.against_certificate(&stand, &trust, now.max(order.issued_at));
    let failed = |refused| match refused {
        FolderRefused::File(error) => Failed { code: UNWRITABLE, ..error.into() },
        refused if refused.is_unusable() => Failed::unusable(refused),
        refused => Failed::refused(refused),
    };
    let mut words = believed.map_or_else(|| Ok(Vec::new()), known).map_err(failed)?;
    let issued = folder.issue(&stand, &site, &order, Seal { signer, trust: trust.as_ref() }).map_err(failed)?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trust::SigningKey;

    const STAND: (&str, &[u8]) = ("stand.yaml", include_bytes!("../../passports/SPS-2/0017/stand.yaml"));
    const SITE: (&str, &[u8]) = ("site.yaml", include_bytes!("../../sites/moscow-bmstu.yaml"));

    fn order(order: &str, out: &Path) -> Result<(Issued, Vec<String>), Failed> {
        let key = SigningKey::generate().unwrap();
        issue([STAND, SITE], order, None, &key, None, out, "2026-11-20T00:00:00.5Z".parse().unwrap())
    }

    /// Expected: the messages of the program, and no file.
    #[test]
    fn what_cannot_be_issued_leaves_no_file() {
        let folder = tempfile::tempdir().unwrap();
        for (asked, code, words) in [
            ("{}", "unusable", "identity: missing"),
            (r#"{"identity": "a b"}"#, "unusable", "a b"),
            (r#"{"identity": "w", "issued_at": "2026-11-10T08:00"}"#, "unusable", "the time zone is missing"),
            (r#"{"identity": "w", "issued_at": "2026-12-20"}"#, "refused", "later than the clock"),
            (
                r#"{"identity": "w", "valid_until": "2026-02-30"}"#,
                "unusable",
                "valid_until: found \"2026-02-30\"; month 02",
            ),
            (r#"{"identity": "w", "valid_until": "2099-01-01"}"#, "refused", "certificate"),
        ] {
            let failed = order(asked, folder.path()).unwrap_err();
            assert_eq!((failed.code, failed.message.contains(words)), (code, true), "{asked}: {failed}");
        }
        let file = folder.path().join("file");
        std::fs::write(&file, "x").unwrap();
        assert_eq!(order(r#"{"identity": "w"}"#, &file).unwrap_err().code, "unwritable");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    /// Expected: the time of the clock in whole seconds, and no remarks on a passport that exists.
    #[test]
    fn the_same_order_leaves_the_passport_as_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let (first, words) = order(r#"{"identity": "w"}"#, folder.path()).unwrap();
        let text = std::fs::read_to_string(&first.path).unwrap();
        assert!(first.new && !words.is_empty() && text.contains("2026-11-20T00:00:00Z"));
        let (second, words) = order(r#"{"identity": "w"}"#, folder.path()).unwrap();
        assert_eq!((second.new, second.sha256, words), (false, first.sha256, Vec::new()));
    }
}
