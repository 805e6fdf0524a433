//! Pictures of the contents of a document, as SVG within a page or in a file.
//!
//! Each picture is a function of the content and of the languages of the page. All pictures are readable in black and
//! white, describe themselves to screen readers, and take their colours from the page.
//!
//! * [`stand`]: the stand with its parts, axes and angles named.
//! * [`positions`]: the positions of the stand, drawn.
//! * [`strips`]: strips in the cells of tables.
//! * [`simulation`], `plan`, `history`: picture files of the paper's Fig. 4, of a plan, and of a stand over the years.
//! * [`drawing`], [`file`]: common parts.

pub(crate) mod drawing;
pub(crate) mod file;
#[cfg(feature = "factory")]
pub(crate) mod history;
#[cfg(feature = "factory")]
pub(crate) mod plan;
pub(crate) mod positions;
pub(crate) mod simulation;
pub(crate) mod stand;
pub(crate) mod strips;

/// Style of the pictures within a page; it uses the colours of the page.
pub(crate) const STYLE: &str = include_str!("style.css");
