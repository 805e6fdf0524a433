//! Tests that take more than some seconds or ask other programs: `tests/quick` leaves them out.

#[cfg(feature = "cli")]
mod alone;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod causes;
mod coarse_readings;
#[cfg(feature = "monte-carlo")]
mod diagnosis;
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
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod rotated_runs;
#[cfg(feature = "monte-carlo")]
mod runs;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod same_stand;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod shared_settings;
#[cfg(feature = "report")]
mod simulation;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod split_run;
#[cfg(feature = "monte-carlo")]
mod stated_uncertainty;
#[cfg(feature = "factory")]
mod suites;
#[cfg(feature = "factory")]
mod tampering;
#[cfg(all(feature = "factory", feature = "report"))]
mod uncertainty;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod unequal_axes;
#[cfg(all(feature = "factory", feature = "monte-carlo"))]
mod worse_groups;
#[cfg(feature = "factory")]
mod yaml_readers;
