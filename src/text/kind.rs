//! Kind of a file that was given instead of another, by its content: for messages, never for a decision.

use super::characters::without_byte_order_mark;
use super::{Unreadable, words};

/// Number of first bytes that show the kind of a file.
const BEGINNING_BYTES: usize = 4096;

words! {
    /// Kind of a file that a user may have, a noun phrase for it, and what to do with it where another one is expected.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub(crate) enum Kind: pub(crate) words, advice {
        Stand = "a stand file (dtg-stand/1)", "give this file to `issue`, or to other commands with --stand";
        Site = "a site file (dtg-site/1)", "give this file to a command with --site, such as `issue`";
        Gyro = "a gyro type (dtg-gyro/1)", "give this file to a command with --gyro, such as `calibrate`";
        Laboratory = "a laboratory file (dtg-laboratory/1)",
            "give this file to a command with --laboratory, such as `calibrate`";
        Dcc = "an administrative file (dtg-dcc/1)", "give this file to `export` or `calibrate` with --administrative";
        Passport = "a passport (dtg-passport/1)", "commands that take a passport take it as the first argument";
        Register = "a register of a stand (dtg-register/1)", "give this file with --register";
        RevocationList = "a list of withdrawn passports of an earlier version (dtg-revocation/1)",
            "the register of each stand replaces these lists; make the registers with `register DIR --renew`, which asks for \
             each passport in the list";
        Angles = "a table of angles (CSV)", "give this file to `certify`, or to `recertify` after the passport";
        Currents = "a table of currents (CSV)", "give this file to `calibrate`, after the passport";
        Result = "the result of a calibration (JSON)", "give this file to `calibrate` with --previous";
        AllowedSigners = "a list of trusted keys (allowed_signers)", "give this file with --trust";
        PublicKey = "a public key", "give the file that has this key with its owner, as `keygen` prints the line";
        PrivateKey = "a private key", "give this file with --key, and keep it secret";
        KeyRevocationList = "an OpenSSH key revocation list (KRL)", "give this file with --revoked";
        Workbook = "a ZIP archive or an Office file", "unpack it, or export the table as CSV";
        Measurement = "a data file of MATLAB or LabVIEW", "export the table as CSV";
        Pdf = "a PDF file", "give the file from which it was made";
        Html = "an HTML page", "give the file from which it was made";
    }
}

pub(crate) const FORMATS: [(&str, Kind); 8] = [
    ("dtg-stand/1", Kind::Stand),
    ("dtg-site/1", Kind::Site),
    ("dtg-gyro/1", Kind::Gyro),
    ("dtg-laboratory/1", Kind::Laboratory),
    ("dtg-dcc/1", Kind::Dcc),
    ("dtg-passport/1", Kind::Passport),
    ("dtg-register/1", Kind::Register),
    ("dtg-revocation/1", Kind::RevocationList),
];

/// First bytes of binary files: ZIP (Office Open XML), Compound File (Office 97), MATLAB 5 and 7.3 (HDF5), TDMS, PDF, KRL.
const MAGIC: [(&[u8], Kind); 7] = [
    (b"PK\x03\x04", Kind::Workbook),
    (b"\xD0\xCF\x11\xE0", Kind::Workbook),
    (b"MATLAB 5.0 MAT-file", Kind::Measurement),
    (b"\x89HDF\r\n\x1A\n", Kind::Measurement),
    (b"TDSm", Kind::Measurement),
    (b"%PDF", Kind::Pdf),
    (b"SSHKRL\n\0", Kind::KeyRevocationList),
];

impl Kind {
    /// Returns the kind of a file, or `None` if nothing in its beginning shows it.
    pub(crate) fn of(bytes: &[u8]) -> Option<Self> {
        if let Some((_, kind)) = MAGIC.iter().find(|(magic, _)| bytes.starts_with(magic)) {
            return Some(*kind);
        }
        let bytes = without_byte_order_mark(bytes);
        let beginning = String::from_utf8_lossy(&bytes[..bytes.len().min(BEGINNING_BYTES)]);
        let mut lines = beginning.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
        let first = lines.next()?;
        let format = |line: &str| Self::of_format(line.strip_prefix("format:")?.trim().trim_matches(['"', '\'']));
        Self::of_line(first, &beginning).or_else(|| std::iter::once(first).chain(lines).find_map(format))
    }

    /// Returns the kind that the first line shows.
    fn of_line(line: &str, beginning: &str) -> Option<Self> {
        let is_key_type =
            |word: &str| ["ssh-", "sk-ssh-", "ecdsa-sha2-", "sk-ecdsa-"].iter().any(|prefix| word.starts_with(prefix));
        let lower = line.to_ascii_lowercase();
        // A line of JSON may contain the name of a column as a key.
        let has_column =
            |column: &str| !line.starts_with('{') && lower.contains(column) && lower.contains([',', ';', '\t']);
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        match line {
            _ if line.starts_with("-----BEGIN") && line.contains("PRIVATE KEY") => Some(Self::PrivateKey),
            _ if line.starts_with('{') && beginning.contains("\"passport_id\"") => Some(Self::Result),
            _ if lower.starts_with("<!doctype html") || lower.starts_with("<html") => Some(Self::Html),
            _ if words.first().is_some_and(|word| is_key_type(word)) => Some(Self::PublicKey),
            _ if words.iter().any(|word| is_key_type(word)) => Some(Self::AllowedSigners),
            _ if has_column("jx_") => Some(Self::Currents),
            _ if has_column("alpha_") => Some(Self::Angles),
            _ => None,
        }
    }

    pub(crate) fn of_format(format: &str) -> Option<Self> {
        FORMATS.iter().find(|(known, _)| *known == format).map(|(_, kind)| *kind)
    }

    /// Returns `true` for documents in YAML, whose readers report the value of `format`.
    pub(crate) fn is_yaml(self) -> bool {
        FORMATS.iter().any(|(_, kind)| *kind == self)
    }
}

/// Returns the refusal of a file of another kind than `accepted`, or `None` if its kind is accepted or unknown.
pub(crate) fn mistaken(
    name: &str,
    bytes: &[u8],
    expected: &str,
    accepted: impl Fn(Kind) -> bool,
) -> Option<Unreadable> {
    let kind = Kind::of(bytes).filter(|kind| !accepted(*kind))?;
    Some(Unreadable::whole(name, None, kind.words(), expected, kind.advice()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_shows_what_it_is() {
        for (text, kind) in [
            (&b"# made up\nformat: \"dtg-stand/1\"\nstand: {}\n"[..], Kind::Stand),
            (b"\xEF\xBB\xBFid: here\r\nformat: dtg-site/1\r\n", Kind::Site),
            (include_bytes!("../../passports/SPS-2/0017/moscow-bmstu-1.yaml"), Kind::Passport),
            (include_bytes!("../../docs/currents.csv"), Kind::Currents),
            (include_bytes!("../../docs/angles.csv"), Kind::Angles),
            (include_bytes!("../../docs/allowed_signers"), Kind::AllowedSigners),
            (b"ssh-ed25519 AAAAC3 comment\n", Kind::PublicKey),
            (b"-----BEGIN OPENSSH PRIVATE KEY-----\nb3", Kind::PrivateKey),
            (b"SSHKRL\n\0\0\0", Kind::KeyRevocationList),
            (b"PK\x03\x04\x14\0", Kind::Workbook),
            (b"MATLAB 5.0 MAT-file, Platform: PCWIN64", Kind::Measurement),
            (b"TDSm\x0E\0\0\0", Kind::Measurement),
            (b"{\n  \"passport_id\": \"a\"", Kind::Result),
            (b"<!DOCTYPE html>", Kind::Html),
        ] {
            assert_eq!(Kind::of(text), Some(kind));
        }
        for text in [
            &b""[..],
            b"-----BEGIN SSH SIGNATURE-----\n",
            b"\n# x\n",
            b"hello",
            b"format: \"dtg-other/1\"\n",
            b"\xFF\xFE\0",
            b"{}",
            b"{\"id\": \"a\", \"positions\": [{\"alpha_arcsec\": 1.0}]}",
            b"i,j,k\n",
        ] {
            assert_eq!(Kind::of(text), None, "{text:?}");
        }
    }
}
