//! Pictures of what a document says, as SVG within a page or in a file.
//!
//! Each is a function of the content and of the languages of the page. All of them read in black and white, say what they show
//! to screen readers, and take their colours from the page.
//!
//! * [`positions`]: the positions of the stand, drawn.
//! * [`deviations`]: α, β and γ of every position.
//! * [`vectors`]: Earth rate and specific force against the ideal ones.
//! * [`place`]: where the passport is valid.
//! * [`accuracy`]: what the stand is good for.
//! * [`residuals`], [`tolerances`], [`convergence`]: of a calibration.
//! * [`budget`], [`simulation`]: files of their own, of a budget and of the paper's Fig. 4.
//! * [`chart`], [`drawing`], [`file`], [`label`]: what they share.

pub(crate) mod accuracy;
pub(crate) mod budget;
pub(crate) mod chart;
pub(crate) mod convergence;
pub(crate) mod deviations;
pub(crate) mod drawing;
pub(crate) mod file;
pub(crate) mod label;
pub(crate) mod place;
pub(crate) mod positions;
pub(crate) mod residuals;
pub(crate) mod simulation;
pub(crate) mod tolerances;
pub(crate) mod vectors;

/// The style of the pictures within a page; it follows the colours of the page around them.
pub(crate) const STYLE: &str = include_str!("style.css");
