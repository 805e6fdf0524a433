//! Fuzz targets of the readers. What must hold is in `properties.rs`, how inputs are changed in `mutation.rs`; both are parts of
//! the library with its feature `fuzzing`, and of its tests: `tests/inside/slow/fuzz.rs` runs
//! them without a fuzzer.

pub use dtg_passport::fuzzing::mutation;
use dtg_passport::fuzzing::{TARGETS, Target};
pub use libfuzzer_sys;

/// The target of this name.
pub fn target(name: &str) -> &'static Target {
    TARGETS.iter().find(|target| target.name == name).expect("a target of that name")
}

/// The program of one target: libFuzzer's own changes and the shared ones in turn.
#[macro_export]
macro_rules! target {
    ($name:literal) => {
        use dtg_passport_fuzz::libfuzzer_sys;
        libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
            dtg_passport_fuzz::target($name).hold(bytes);
        });
        libfuzzer_sys::fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
            dtg_passport_fuzz::mutation::in_place(data, size, max_size, seed, libfuzzer_sys::fuzzer_mutate)
        });
    };
}
