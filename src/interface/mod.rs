//! Interface for programs in other languages: bytes, text and JSON in; JSON and numbers out.
//!
//! The packages `python`, `c` and `web` only convert types and call this module, so that every language runs the same
//! checks and computes the same numbers to the bit.
//!
//! * [`Enquiry`]: whom to trust and what to ask, and the verification of many passports.
//! * [`fn@array`], [`matrix`]: the numbers of a passport.
//! * [`Order`], [`calibrate_json`]: currents to the parameters of a gyro; [`parameters`], [`covariance`]: the numbers of its
//!   result; [`earlier`]: a result that was kept; `monte_carlo` (with `monte-carlo`): their distributions.
//! * `issue` (with `factory`), `plan` (with `monte-carlo` too): a signed passport; the best positions.
//! * [`Failed`]: refusals as JSON.
//!
//! ```
//! use dtg_passport::interface::{Enquiry, calibrate_json, content_json};
//!
//! let signers = include_bytes!("../../docs/allowed_signers");
//! let bytes = include_bytes!("../../passports/SPS-2/0017/moscow-bmstu-1.yaml");
//! let question = r#"{"time": "2026-11-20", "serial": "0017", "at": [55.7660, 37.6850]}"#;
//! let enquiry = Enquiry::new(("allowed_signers", signers), &[], question, "2026-11-20T00:00:00Z".parse()?)?;
//! let answer = enquiry.verify("moscow-bmstu-1.yaml", bytes);
//! let passport = answer.verification.passport().ok_or_else(|| answer.to_json())?;
//!
//! assert!(content_json(passport.content()).contains("b_deg_per_h"));
//! let currents = include_bytes!("../../docs/currents.csv");
//! let order = r#"{"method": "least-squares"}"#.parse()?;
//! let verified = Some((answer.time, answer.verification.register()));
//! let found = calibrate_json(passport.content(), verified, ("currents.csv", currents), &order)?;
//! assert!(found.contains("chi_square"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub(crate) mod calibrated;
pub(crate) mod enquiry;
#[cfg(feature = "factory")]
mod issued;
mod order;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod planned;

pub use calibrated::calibrate_json;
pub use order::Order;

// For the packages `python`, `c` and `web` of this workspace alone.
#[doc(hidden)]
#[cfg(feature = "monte-carlo")]
pub use calibrated::monte_carlo;
#[doc(hidden)]
pub use calibrated::{covariance, earlier, parameters};
#[doc(hidden)]
pub use enquiry::{Answer, Enquiry};
#[doc(hidden)]
#[cfg(feature = "factory")]
pub use issued::issue;
#[doc(hidden)]
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
pub use planned::plan;

use crate::document::sha256_hex;
#[cfg(feature = "factory")]
use crate::files::{self, FileError};
use crate::passport::{Check, Content, MatrixRows, RegisterUsed, Rows, Verification, content_from_anyone};
use crate::text::{Node, Path, Problem, Problems, RefusalCause, Unreadable, name_of, printable, record};
use crate::trust::LARGEST_TRUST_FILE_BYTES;
use serde::Serialize;

/// Codes of failures.
pub(crate) const REFUSED: &str = "refused";
pub(crate) const UNREADABLE: &str = "unreadable";
pub(crate) const UNUSABLE: &str = "unusable";
pub(crate) const UNWRITABLE: &str = "unwritable";
pub(crate) const EXISTS: &str = "exists";
pub(crate) const MISSING_DATA: &str = "missing_data";

/// Refusal, or input that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error, Serialize)]
#[error("{message}")]
pub struct Failed {
    /// Kind of failure: `refused` if a document or a result is refused; `unreadable` or `unusable` if an input cannot
    /// be used; `unwritable` or `exists` if a file cannot be written. The program has further ones.
    pub code: &'static str,
    /// Message, which may have several lines.
    pub message: String,
    pub(crate) problems: Vec<Place>,
    /// Findings that are the reason, as JSON.
    #[serde(skip)]
    pub(crate) findings: Vec<serde_json::Value>,
    /// Result of a calibration that is not valid, the JSON of `calibrate`.
    #[serde(skip)]
    pub result: Option<String>,
}

/// Failure as the JSON of what it ends.
#[derive(Serialize)]
pub(crate) struct Document<'a> {
    error: &'a Failed,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    findings: &'a [serde_json::Value],
}

/// Error in a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Place {
    file: String,
    line: Option<usize>,
    column: Option<usize>,
    message: String,
    /// Word of the cause, if it is a recognised one.
    #[serde(skip_serializing_if = "Option::is_none")]
    cause: Option<&'static str>,
}

impl Place {
    pub(crate) fn file(file: String, message: String) -> Self {
        Self { file, line: None, column: None, message, cause: None }
    }

    pub(crate) fn each(error: &Unreadable) -> Vec<Self> {
        let place = |problem: &Problem| Self {
            file: error.name().to_owned(),
            line: problem.location.map(|at| at.line),
            column: problem.location.map(|at| at.column),
            message: problem.to_string(),
            cause: problem.cause.map(RefusalCause::code),
        };
        error.problems().iter().map(place).collect()
    }
}

impl Failed {
    pub(crate) fn new(code: &'static str, message: String, problems: Vec<Place>) -> Self {
        Self { code, message, problems, findings: Vec::new(), result: None }
    }

    pub(crate) fn refused(why: impl std::fmt::Display) -> Self {
        Self::new(REFUSED, why.to_string(), Vec::new())
    }

    /// Creates the failure for an input that cannot be used.
    #[doc(hidden)]
    pub fn unusable(why: impl std::fmt::Display) -> Self {
        Self::new(UNUSABLE, why.to_string(), Vec::new())
    }

    /// Creates the failure for a file that cannot be read.
    #[doc(hidden)]
    pub fn unreadable(file: &str, why: impl std::fmt::Display) -> Self {
        let message = format!("{}: {why}", printable::Printable(file));
        Self::new(UNREADABLE, message.clone(), vec![Place::file(file.to_owned(), message)])
    }

    /// Returns the failure with the findings that are its reason.
    #[cfg(feature = "factory")]
    pub(crate) fn because_of(self, findings: Vec<serde_json::Value>) -> Self {
        Self { findings, ..self }
    }

    /// Returns the failure as the JSON of what it ends.
    pub(crate) fn document(&self) -> Document<'_> {
        Document { error: self, findings: &self.findings }
    }

    /// Returns the failure as JSON: `{"error": {code, message, problems: [{file, line, column, message, cause}]}}`, beside
    /// which the `findings` are that are its reason; or the result that is not valid.
    pub fn to_json(&self) -> String {
        self.result.clone().unwrap_or_else(|| json(&self.document()))
    }
}

impl From<Unreadable> for Failed {
    fn from(error: Unreadable) -> Self {
        let findings = error.findings().to_vec();
        Self { findings, ..Self::new(UNREADABLE, error.with_lines(""), Place::each(&error)) }
    }
}

#[cfg(feature = "factory")]
impl From<FileError> for Failed {
    fn from(error: FileError) -> Self {
        let code = match error {
            FileError::Exists { .. } => EXISTS,
            FileError::Write(..) => UNWRITABLE,
            _ => UNREADABLE,
        };
        let message = error.with_nearest();
        let place = Place::file(name_of(error.path()), message.clone());
        Self::new(code, message, vec![place])
    }
}

/// Verdict on one file, as `verify` prints it and every other language gets it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Verdict {
    pub file: String,
    /// `true` if every check passed.
    pub valid: bool,
    /// Id of the passport; null until the signature passes.
    pub id: Option<String>,
    /// Names of the checks that were not requested.
    pub not_asked: Vec<&'static str>,
    /// Remarks on the lists and the register by which the passport was verified.
    pub remarks: Vec<String>,
    /// Register by which the passport was checked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub register: Option<RegisterUsed>,
    pub checks: Vec<Check>,
}

impl Verdict {
    pub(crate) fn of(file: &str, verification: &Verification, remarks: &[String]) -> Self {
        let (id, checks) = (verification.id_from_anyone().map(str::to_owned), verification.checks().to_vec());
        let (file, valid, register) = (file.to_owned(), verification.valid(), verification.register().cloned());
        let not_asked = verification.not_asked();
        Self { file, valid, id, not_asked, remarks: remarks.to_vec(), register, checks }
    }
}

/// Returns the content of a passport as JSON: the keys of the file without `signature`, and the same binary64 values.
#[doc(hidden)]
pub fn content_json(content: &Content) -> String {
    json(content)
}

/// Returns the content of a passport that is not verified, and the SHA-256 of the whole file: anyone may have written it.
///
/// # Errors
/// Returns [`Failed`] if the file does not have the form of a passport.
#[doc(hidden)]
pub fn unverified(file: &str, bytes: &[u8]) -> Result<(Content, String), Failed> {
    Ok((content_from_anyone(file, bytes)?, sha256_hex(bytes)))
}

/// Value of a number that the passport does not state.
const NOT_STATED: f64 = f64::NAN;

/// Returns a matrix of the paper by its key, NaN if the passport has no matrices; `None` for an unknown key.
#[doc(hidden)]
pub fn matrix(content: &Content, key: &str) -> Option<Rows> {
    let of: fn(&MatrixRows) -> Rows = match key {
        "delta" => |of| of.delta,
        "b_deg_per_h" => |of| of.b_deg_per_h,
        "c_deg_per_h_per_g" => |of| of.c_deg_per_h_per_g,
        "n1" => |of| of.n1,
        "n2" => |of| of.n2,
        "n2_inverse" => |of| of.n2_inverse,
        "omega1_deg_per_h" => |of| of.omega1_deg_per_h,
        "omega2_deg_per_h" => |of| of.omega2_deg_per_h,
        _ => return None,
    };
    Some(content.matrices.as_ref().map_or([[NOT_STATED; 2]; 2], of))
}

/// Returns an array row by row, NaN where the passport states nothing: a [`matrix`], `gravity` (m/s²), or with a row for
/// each position `ij`, `angles` (nominal θ and φ, degrees), `n` (g), `omega` (°/h), `deviations` and `u_deviations` (″);
/// `self_check` has rows i, j, J_x, J_y (mA), none without a self-check. `None` for an unknown name.
#[doc(hidden)]
pub fn array(content: &Content, name: &str) -> Option<Vec<f64>> {
    let Content { positions, vectors, self_check, .. } = content;
    let each = |of: fn(&_) -> Vec<f64>| positions.iter().flat_map(of).collect();
    let vectors = |of: fn(&_) -> [f64; 2]| {
        let of_one = |i, j| vectors.iter().find(|at| (at.i, at.j) == (i, j)).map_or([NOT_STATED; 2], of);
        positions.iter().flat_map(|at| of_one(at.i, at.j)).collect()
    };
    Some(match name {
        "gravity" => vec![content.earth.gravity_m_per_s2],
        "ij" => each(|at| vec![at.i.into(), at.j.into()]),
        "angles" => each(|at| vec![at.theta_deg, at.phi_deg]),
        "n" => vectors(|at| at.specific_force_g),
        "omega" => vectors(|at| at.omega_deg_per_h),
        "deviations" => each(|at| vec![at.alpha_arcsec, at.beta_arcsec, at.gamma_arcsec]),
        "u_deviations" => {
            each(|at| [at.u_alpha_arcsec, at.u_beta_arcsec, at.u_gamma_arcsec].map(|u| u.unwrap_or(NOT_STATED)).into())
        }
        "self_check" => {
            let currents = self_check.iter().flat_map(|check| &check.currents);
            currents.flat_map(|at| [at.i.into(), at.j.into(), at.jx_ma, at.jy_ma]).collect()
        }
        key => matrix(content, key)?.concat(),
    })
}

/// Reads a file of any kind but a passport to be verified, so that no pipe is waited for and no memory is exhausted.
///
/// # Errors
/// Returns an error if the file cannot be read, is not a regular file, or is larger than any kind may be.
#[cfg(feature = "factory")]
#[doc(hidden)]
pub fn read(path: &std::path::Path) -> Result<Vec<u8>, FileError> {
    files::read(path, LARGEST_TRUST_FILE_BYTES)
}

/// Question or order, a JSON object, whose keys may all be absent. Null is refused: it may be a value that got lost.
struct Asked {
    /// Name in messages.
    what: &'static str,
    node: Node,
    known: Vec<&'static str>,
    problems: Problems,
}

impl Asked {
    fn new(what: &'static str, text: &str) -> Result<Self, Failed> {
        let unusable = |error| Failed::unusable(format!("the {what} is not usable JSON: {error}"));
        let node = Node::from_json(text).map_err(unusable)?;
        Ok(Self { what, node, known: Vec::new(), problems: Problems::default() })
    }

    /// Returns the value of a key as `read` reads it; `None` if there is none, or after an error.
    fn key<T>(&mut self, key: &'static str, read: impl FnOnce(&Node, &Path, &mut Problems) -> Option<T>) -> Option<T> {
        self.known.push(key);
        let (node, at) = (self.node.get(key)?, Path::Root.key(key));
        if *node == Node::Null {
            self.problems.at(&at, "null", "a value", "leave the key out if it is not asked");
            return None;
        }
        read(node, &at, &mut self.problems)
    }

    /// Refuses keys that were not asked for, duplicate keys, and every value with an error.
    fn done(mut self) -> Result<(), Failed> {
        record::entries(&self.node, &Path::Root, &mut self.problems, &self.known);
        if self.problems.is_empty() {
            return Ok(());
        }
        let error = self.problems.refuse_by_field(self.what);
        Err(Failed::new(UNUSABLE, error.to_string(), Place::each(&error)))
    }
}

/// Returns a value as JSON with invisible characters escaped. The values of this module have only text keys and finite
/// numbers, so writing cannot fail; if it did, the text would be empty and no reader would accept it.
fn json(value: &impl Serialize) -> String {
    printable::json(value).unwrap_or_default()
}
