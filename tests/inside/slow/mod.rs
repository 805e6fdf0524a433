//! Tests that take more than some seconds or ask other programs: `tests/quick` leaves them out.

#[cfg(feature = "cli")]
mod alone;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod causes;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod coarse_readings;
#[cfg(feature = "monte-carlo")]
mod decisions;
#[cfg(feature = "monte-carlo")]
mod diagnosis;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod findings;
#[cfg(feature = "cli")]
mod fuzz;
#[cfg(feature = "cli")]
mod hostile_input;
#[cfg(feature = "cli")]
mod hostile_memory;
#[cfg(feature = "factory")]
mod noise;
#[cfg(feature = "report")]
mod repeats;
#[cfg(feature = "monte-carlo")]
mod runs;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod same_stand;
#[cfg(feature = "report")]
mod simulation;
#[cfg(feature = "monte-carlo")]
mod stated_uncertainty;
#[cfg(feature = "factory")]
mod suites;
#[cfg(feature = "factory")]
mod tampering;
#[cfg(all(feature = "factory", feature = "report"))]
mod uncertainty;
#[cfg(feature = "factory")]
mod yaml_readers;

/// Returns the number of trials of each kind: as many as the variable `DTG_TRIALS` says, or the usual number.
#[cfg(feature = "monte-carlo")]
fn trials(usual: u64) -> u64 {
    std::env::var("DTG_TRIALS").ok().and_then(|trials| trials.parse().ok()).unwrap_or(usual)
}
