//! The pool shares independent pieces of work among threads, each piece on one.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

/// Does `work` on every item, by `jobs` threads; `done` hears of each result as it comes,
/// with its number. Results do not depend on the number of threads.
///
/// Errors: the first that `done` returns; what is at work is finished, the rest left.
pub fn run<T: Sync, R: Send, E>(
    items: &[T],
    jobs: usize,
    work: impl Fn(&T) -> R + Sync,
    mut done: impl FnMut(usize, R) -> Result<(), E>,
) -> Result<(), E> {
    let next = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..jobs.clamp(1, items.len().max(1)) {
            let (next, work) = (&next, &work);
            let sender = sender.clone();
            scope.spawn(move || {
                loop {
                    let n = next.fetch_add(1, Ordering::Relaxed);
                    let Some(item) = items.get(n) else { break };
                    if sender.send((n, work(item))).is_err() {
                        break; // nobody listens any more
                    }
                }
            });
        }
        drop(sender);
        let mut outcome = Ok(());
        for (n, result) in receiver {
            outcome = done(n, result);
            if outcome.is_err() {
                next.store(items.len(), Ordering::Relaxed);
                break;
            }
        }
        outcome
    })
}

/// Does `work` on every item, by `jobs` threads, and gives the results in the order of the
/// items; `progress` hears of every one that is done.
pub fn all<T: Sync, R: Send>(
    items: &[T],
    jobs: usize,
    work: impl Fn(&T) -> R + Sync,
    progress: &mut dyn FnMut(),
) -> Vec<R> {
    let mut results: Vec<(usize, R)> = Vec::new();
    let done: Result<(), std::convert::Infallible> = run(items, jobs, work, |n, result| {
        results.push((n, result));
        progress();
        Ok(())
    });
    let Ok(()) = done;
    results.sort_by_key(|(n, _)| *n);
    results.into_iter().map(|(_, result)| result).collect()
}
