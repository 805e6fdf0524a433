//! Signed passports that let a cheap test stand calibrate a dynamically tuned gyro (DTG) as well as an expensive one.
//!
//! A DTG is calibrated in eight fixed positions of a two-axis test stand. A cheap stand is misaligned in each of them, but
//! it repeats. So its factory measures the misalignment once, certifies it, and for each site computes what
//! a calibration needs: the matrices Δ, B, C and the Earth-rate vectors of
//! [the paper](bibliography::Bibliography::Tang17). It issues them as a signed text, the passport; the laboratory's
//! software reads it, checks it, and finds the gyro's scale factors and drifts.
//!
//! The whole chain, stand → passport → signed text → verified → matrices:
//!
//! ```
//! use dtg_passport::passport::{Question, Trust, accept, issue};
//! use dtg_passport::signing::allowed_signers_line;
//! use dtg_passport::trust::{AllowedSigners, SigningKey};
//! use dtg_passport::{site::Site, stand::Stand};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let stand = Stand::from_yaml("stand.yaml", include_bytes!("../passports/SPS-2/0017/stand.yaml"))?;
//! let site = Site::from_yaml("moscow-bmstu.yaml", include_bytes!("../sites/moscow-bmstu.yaml"))?;
//! let key = SigningKey::generate()?;
//!
//! // The factory: who issues, and when.
//! let order = issue::Issue::first("factory@example.org", "2026-11-09T09:00:00Z".parse()?);
//! let passport: String = issue::draft(&stand, &site, &order)?.sign(&key)?;
//!
//! // The laboratory: whom it trusts, and what it asks.
//! let line = allowed_signers_line("factory@example.org", &key.public_key())?;
//! let trust = Trust::of(AllowedSigners::parse("allowed_signers", line.as_bytes())?);
//! let mut question = Question::at("2026-12-01T00:00:00Z".parse()?);
//! question.serial = Some("0017".into());
//! let passport = accept("moscow-bmstu-1.yaml", passport.as_bytes(), &trust, &question)?;
//! let matrices = passport.coefficients().matrices.ok_or("not all of the eight positions")?;
//! assert!((matrices.b_deg_per_h.m12 - 16.9235).abs() < 1e-4);
//! # Ok(())
//! # }
//! ```
//!
//! # The modules, in the order of the data
//!
//! A module uses only those above it. A feature of Cargo is a floor of the house: without any, bytes, keys and a time come in,
//! and an answer goes out, without files, processes or a clock. Every feature alone builds and passes its tests.
//!
//! | module | content | feature |
//! |---|---|---|
//! | [`bibliography`] | the papers and standards that formulas link to | |
//! | `units` | angles and rates: the one place that converts | |
//! | `parallel` | the same work on many things at once | |
//! | [`text`] | one canonical form out and in, tables, errors that point into the file; hand-written YAML with `yaml` | |
//! | [`trust`] | signatures, allowed signers, revocation: bytes and time in, a verdict out; private keys with `factory` | |
//! | `document` | a signed text: split, checked, parsed, joined | |
//! | [`attitude`] | eq. (3), (4): A, E, Ã | |
//! | [`coefficients`] | eq. (5), (9)-(13): n, ω_3, Δ, B, C | |
//! | `wording` | what is said to people, in each language, with its numbers; the texts are in `texts/` | |
//! | [`earth`] | Earth rate, gravity, deflection, geodesics | |
//! | [`site`], [`stand`] | the place where a stand is used; a stand and its certified deviations | |
//! | [`gyro`], [`laboratory`] | eq. (2): parameters and currents, types of gyro; the meter and the seat | |
//! | `statistics` | least squares, distributions; random streams with `monte-carlo`: no gyro in it | |
//! | [`calibration`] | from currents to parameters, their uncertainty, the fit | |
//! | [`uncertainty`] | the budget of the uncertainty; 95 % intervals with `monte-carlo`, whose trials the crate `trials` makes | |
//! | [`simulation`] | the paper's table and its Fig. 4 | `monte-carlo` |
//! | `selftest` | the reference cases of the mathematics, found again on the user's own machine | `monte-carlo` |
//! | [`passport`] | content and verification; issue and re-issue with `factory` | |
//! | [`register`] | the signed register of a stand: which passport counts | |
//! | [`certification`] | readings of the angles to a stand, and whether it is still the same one | `factory` |
//! | `history` | one stand over the years, and whether its deviations drift | `factory` |
//! | `plan` | the best positions to certify or to read, and their order | `factory` and `monte-carlo` |
//! | `files`, [`signing`], [`folder`] | whole or not at all; key files and agents; a folder of passports | `factory` |
//! | `batch` | many passports at once | `factory` |
//! | [`interface`] | what programs in other languages call: `python`, `c` and `web` | |
//! | [`report`] | what people read | `report` |
//! | `dcc` | Digital Calibration Certificates of PTB, of a stand and of a gyro | `cli` |
//! | `schema` | JSON Schemas of the formats; what makes them with `generate` | `cli` |
//! | `template` | commented files to begin with | `cli` |
//! | `workspace` | a folder that states key, trust and folders; its contents | `cli` |
//! | `delivery` | what a laboratory gets in one file: written, and received from anyone | `cli` |
//! | `pdf` | a page as PDF, printed by an installed browser | `cli` |
//! | `demonstration` | the whole story on a built-in example | `cli` |
//! | [`cli`] | the command line: read, call, write | `cli` |
//!
//! The feature `cli`, which has all the others and is the default, builds the program. Only `files`, `signing`, `folder`,
//! `batch`, `workspace`, `delivery`, `pdf` and `demonstration` touch the file system or start a program; nothing reads the
//! clock, prints, or looks at the environment (`ssh-keygen`, where it signs, looks for its agent there, and `pdf` for the
//! browser).
//!
//! # What it refuses
//!
//! Deviations over 45°, the poles, positions of the paper with other angles, keys of other types than Ed25519, text that
//! is not in its one form, and every unknown key in every file. It has no certificate authorities: a list of allowed
//! signers is the whole of its trust.

#![forbid(unsafe_code)]
#![deny(missing_docs)]
#![cfg_attr(not(test), warn(unreachable_pub))]
// What only a higher feature calls is not dead code; with all of them nothing may be unused.
#![cfg_attr(not(feature = "cli"), allow(dead_code, unused_imports))]

// Their types are part of the interface: the same versions must be used.
pub use {jiff, nalgebra};

pub mod attitude;
#[cfg(feature = "factory")]
mod batch;
pub mod bibliography;
pub mod calibration;
#[cfg(feature = "factory")]
pub mod certification;
#[cfg(feature = "cli")]
pub mod cli;
pub mod coefficients;
#[cfg(feature = "cli")]
pub(crate) mod dcc;
#[cfg(feature = "cli")]
pub(crate) mod delivery;
#[cfg(feature = "cli")]
pub(crate) mod demonstration;
pub(crate) mod document;
pub mod earth;
#[cfg(feature = "factory")]
pub(crate) mod files;
#[cfg(feature = "factory")]
pub mod folder;
pub mod gyro;
#[cfg(feature = "factory")]
pub(crate) mod history;
pub mod interface;
pub mod laboratory;
pub(crate) mod parallel;
pub mod passport;
#[cfg(feature = "cli")]
pub(crate) mod pdf;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
pub(crate) mod plan;
pub mod register;
#[cfg(feature = "report")]
pub mod report;
#[cfg(feature = "cli")]
pub(crate) mod schema;
#[cfg(feature = "monte-carlo")]
pub(crate) mod selftest;
#[cfg(feature = "factory")]
pub mod signing;
#[cfg(feature = "monte-carlo")]
pub mod simulation;
pub mod site;
pub mod stand;
pub(crate) mod statistics;
#[cfg(feature = "cli")]
pub(crate) mod template;
pub mod text;
pub mod trust;
pub mod uncertainty;
pub(crate) mod units;
// `report` makes its languages public.
#[cfg_attr(not(feature = "report"), allow(unreachable_pub))]
pub(crate) mod wording;
#[cfg(feature = "cli")]
pub(crate) mod workspace;

/// The guide's Rust is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../docs/integrator.md")]
mod integrator_guide {}

// Tests of `tests/inside` and fuzz targets name the library as its users do.
#[cfg(any(test, feature = "fuzzing"))]
extern crate self as dtg_passport;
/// Properties that every reader has for any input, checked by the tests and by the fuzzer.
#[cfg(all(any(test, feature = "fuzzing"), feature = "cli"))]
#[path = "../tests/fuzz/properties.rs"]
pub mod fuzzing;
#[cfg(test)]
#[path = "../tests/inside/mod.rs"]
mod inside;
