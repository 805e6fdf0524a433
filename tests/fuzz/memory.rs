//! The memory that a reader takes: of the whole process, so nothing else may run beside it.

use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// The bound that holds for every reader (docs/development/threats.md), in bytes.
pub fn bound(input_bytes: usize) -> usize {
    64 * input_bytes + (8 << 20)
}

/// Runs it; gives the most memory that it had at a time, in bytes.
pub fn peak<T>(run: impl FnOnce() -> T) -> (T, usize) {
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    let result = run();
    (result, MEMORY.peak_usage() - before)
}
