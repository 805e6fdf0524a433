//! Work that takes long: a progress bar shows how far it is.

use super::interrupt::cancelled_by_ctrl_c;
use super::{Failure, output};
use crate::interface::Failed;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::fmt::Write;
use std::sync::atomic::{AtomicBool, Ordering};

/// Returns where bars are drawn: on standard error if it is a terminal, and nowhere if only failures are reported.
pub(super) fn target() -> ProgressDrawTarget {
    if output::is_quiet() { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() }
}

/// Returns a bar for a number of `what`.
pub(super) fn bar(length: u64, what: &str) -> Result<ProgressBar, Failure> {
    let bar = ProgressBar::with_draw_target(Some(length), target());
    let style = ProgressStyle::with_template(&format!("{{wide_bar}} {what}: {{human_pos}} of {{human_len}}{{left}}"));
    // Before the first is done, nothing is known of the time.
    let left = |state: &ProgressState, out: &mut dyn Write| {
        if state.pos() > 0 {
            let seconds = state.eta().as_secs();
            let _ = match seconds {
                0..120 => write!(out, ", {seconds} s left"),
                _ => write!(out, ", {} min left", seconds.div_ceil(60)),
            };
        }
    };
    bar.set_style(style.map_err(Failure::unusable)?.with_key("left", left));
    Ok(bar)
}

/// Runs trials with a progress bar on a terminal (none in a pipe). Ctrl-C ends them with those completed so far.
pub(super) fn trials<T>(
    length: u64,
    run: impl FnOnce(&AtomicBool, &ProgressBar) -> Result<T, Failed>,
) -> Result<T, Failure> {
    let cancel = cancelled_by_ctrl_c()?;
    let bar = bar(length, "trials")?;
    let found = run(&cancel, &bar);
    bar.finish_and_clear();
    let found = found?;
    if cancel.load(Ordering::Relaxed) {
        output::say("interrupted; the result is from the trials completed so far");
    }
    Ok(found)
}
