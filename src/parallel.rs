//! Parallel processing of a list of items.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Returns the number of CPUs that this process may use, or 1 if that is unknown.
pub(crate) fn processors() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// Applies `work` to every item on up to `threads` threads, and returns the results in the order of the items.
///
/// If the system cannot start all threads, fewer do the work.
pub(crate) fn map<T: Sync, R: Send>(items: &[T], threads: usize, work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    map_with(items, threads, || (), |(), item| work(item))
}

/// Applies `work` to every item as [`map`] does; each thread first creates its own value with `make` and passes it on.
pub(crate) fn map_with<T: Sync, R: Send, S>(
    items: &[T],
    threads: usize,
    make: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, &T) -> R + Sync,
) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let run = || {
        let (mut own, mut done) = (make(), Vec::new());
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(index) else { return done };
            done.push((index, work(&mut own, item)));
        }
    };
    let mut results: Vec<Option<R>> = Vec::new();
    results.resize_with(items.len(), || None);
    thread::scope(|scope| {
        let others = 1..threads.min(items.len());
        let others: Vec<_> = others.map_while(|_| thread::Builder::new().spawn_scoped(scope, run).ok()).collect();
        let mut keep = |done: Vec<(usize, R)>| {
            done.into_iter().for_each(|(index, result)| results[index] = Some(result));
        };
        keep(run());
        for other in others {
            keep(other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        }
    });
    results.into_iter().flatten().collect()
}
