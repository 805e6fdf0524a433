//! Tests that take more than some seconds or ask other programs: `tests/quick` leaves them out.

#[cfg(feature = "cli")]
mod alone;
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
mod simulation;
#[cfg(feature = "factory")]
mod tampering;
#[cfg(all(feature = "factory", feature = "report"))]
mod uncertainty;
#[cfg(feature = "factory")]
mod yaml_readers;
