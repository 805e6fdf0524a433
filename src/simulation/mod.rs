//! The paper's table and its Fig. 4, computed again.
//!
//! * [`accuracy`]: how far found parameters are from nominal ones, over stands and currents drawn at random.
//! * [`convergence`]: how many steps successive approximation takes.
//! * [`picture`]: Fig. 4 as SVG.
//! * [`draw`]: stands and currents at random.

pub mod accuracy;
pub mod convergence;
pub mod draw;
pub mod picture;
