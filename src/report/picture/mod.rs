//! Pictures of the contents of a document, as SVG within a page or in a file.
//!
//! Each picture is a function of the content and of the languages of the page. All pictures are readable in black and
//! white, describe themselves to screen readers, and take their colours from the page.
//!
//! * [`stand`]: the stand with its parts, axes and angles named.
//! * [`positions`]: the positions of the stand, drawn.
//! * [`deviations`]: α, β and γ of every position.
//! * [`accuracy`]: the expected calibration uncertainty, as shares of the tolerances.
//! * [`residuals`], [`tolerances`], [`convergence`]: pictures of a calibration.
//! * [`budget`], [`simulation`], `plan`, `history`: picture files of a budget, of the paper's Fig. 4, of a plan, and of
//!   a stand over the years.
//! * [`drawing`], [`file`], [`label`]: common parts.

pub(crate) mod accuracy;
pub(crate) mod budget;
pub(crate) mod convergence;
pub(crate) mod deviations;
pub(crate) mod drawing;
pub(crate) mod file;
#[cfg(feature = "factory")]
pub(crate) mod history;
pub(crate) mod label;
#[cfg(feature = "factory")]
pub(crate) mod plan;
pub(crate) mod positions;
pub(crate) mod residuals;
pub(crate) mod shares;
pub(crate) mod simulation;
pub(crate) mod stand;
pub(crate) mod tolerances;

/// Style of the pictures within a page; it uses the colours of the page.
pub(crate) const STYLE: &str = include_str!("style.css");
