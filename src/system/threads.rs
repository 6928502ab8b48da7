//! Threads.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

use rayon::prelude::*;

/// How many processors the program may use; at least 1.
pub fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Does `work` on a thread of its own. Whether the system has one to give.
pub fn spawn(work: impl FnOnce() + Send + 'static) -> bool {
    std::thread::Builder::new().name("study".into()).spawn(work).is_ok()
}

/// Lets this thread stand still.
pub fn sleep(time: Duration) {
    std::thread::sleep(time);
}

/// Threads that share the parts of one study.
#[derive(Debug)]
pub struct Pool(rayon::ThreadPool);

/// Why threads cannot be started.
#[derive(Debug, thiserror::Error)]
#[error("cannot start {count} threads: {reason}")]
pub struct NoThreads {
    count: usize,
    reason: String,
}

impl Pool {
    /// So many threads.
    pub fn new(count: usize) -> Result<Self, NoThreads> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
        pool.map(Self).map_err(|error| NoThreads { count, reason: error.to_string() })
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.0.current_num_threads()
    }

    /// The results of all parts from 0 to `parts`, in order, or an error of one of them, after which no other
    /// part begins. `state` makes what a thread keeps from part to part.
    pub fn map<S, R: Send, E: Send>(
        &self,
        parts: usize,
        state: impl Fn() -> S + Sync,
        part: impl Fn(&mut S, usize) -> Result<R, E> + Sync,
    ) -> Result<Vec<R>, E> {
        self.0.install(|| (0..parts).into_par_iter().with_max_len(1).map_init(&state, &part).collect())
    }

    /// The first of the parts from 0 to `parts` for which there is an answer, with it.
    pub fn find_first<S, R: Send>(
        &self,
        parts: u64,
        state: impl Fn() -> S + Sync,
        part: impl Fn(&mut S, u64) -> Option<R> + Sync,
    ) -> Option<R> {
        let all = || (0..parts).into_par_iter().map_init(&state, &part);
        self.0.install(|| all().find_first(Option::is_some).flatten())
    }

    /// Does the `parts`, each on one of the threads, and hands the results over in order, here, while others
    /// are still worked on. At most so many are begun `ahead` of the last one that was handed over. Ends
    /// early where `take` wants no more.
    pub fn in_order<S, P, R: Send>(
        &self,
        ahead: usize,
        parts: impl Iterator<Item = P> + Send,
        state: impl Fn() -> S + Sync,
        part: impl Fn(&mut S, P) -> R + Sync,
        mut take: impl FnMut(R) -> bool,
    ) {
        let (permit, permits) = channel();
        // Each thread takes one more, by which it learns that there are no more parts.
        for _ in 0..ahead.max(self.count()) {
            let _ = permit.send(());
        }
        let parts = Mutex::new((permits, parts.enumerate()));
        let next = || {
            let mut parts = parts.lock().ok()?;
            parts.0.recv().ok()?;
            parts.1.next()
        };
        let stop = AtomicBool::new(false);
        let (tell, news) = channel();
        self.0.in_place_scope(|scope| {
            scope.spawn_broadcast(|_, _| {
                let farewell = Farewell(tell.clone());
                let mut own = state();
                while let Some((number, given)) = next().filter(|_| !stop.load(Ordering::Relaxed)) {
                    let _ = farewell.0.send(News::Done(number, part(&mut own, given)));
                }
            });
            let (mut waiting, mut taken, mut working) = (BTreeMap::new(), 0, self.count());
            while working > 0 && !stop.load(Ordering::Relaxed) {
                match news.recv() {
                    Ok(News::Done(number, result)) => drop(waiting.insert(number, result)),
                    Ok(News::Ended { whole: true }) => working -= 1,
                    // The panic goes on when all threads have ended.
                    Ok(News::Ended { whole: false }) | Err(_) => stop.store(true, Ordering::Relaxed),
                }
                while let Some(result) = waiting.remove(&taken).filter(|_| !stop.load(Ordering::Relaxed)) {
                    taken += 1;
                    let _ = permit.send(());
                    stop.fetch_or(!take(result), Ordering::Relaxed);
                }
            }
            drop(permit);
        });
    }

    /// Does the same on each thread.
    pub fn everywhere(&self, work: impl Fn() + Sync) {
        self.0.broadcast(|_| work());
    }
}

/// What a thread tells whoever waits for its results.
enum News<R> {
    /// The result of the part of this number.
    Done(usize, R),
    /// It has come to its end, and not by a panic.
    Ended { whole: bool },
}

/// Tells, however a thread ends, that it has ended.
struct Farewell<R>(Sender<News<R>>);

impl<R> Drop for Farewell<R> {
    fn drop(&mut self) {
        let _ = self.0.send(News::Ended { whole: !std::thread::panicking() });
    }
}

/// What `work` gives, which is told to stop, by its argument, once `patience` is over.
pub fn within<R>(patience: Duration, work: impl FnOnce(&AtomicBool) -> R) -> R {
    let cancel = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let (done, wait) = channel::<()>();
        let cancel = &cancel;
        scope.spawn(move || {
            if wait.recv_timeout(patience) == Err(RecvTimeoutError::Timeout) {
                cancel.store(true, Ordering::Relaxed);
            }
        });
        let found = work(cancel);
        drop(done);
        found
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_order_and_none_is_begun_too_far_ahead() {
        for threads in [1, 2, 5] {
            let pool = Pool::new(threads).unwrap();
            let (begun, taken) = (Mutex::new(0), Mutex::new(Vec::new()));
            let part = |_: &mut (), i: usize| {
                *begun.lock().unwrap() += 1;
                // the earlier of two takes longer
                let work = (0..(1 - i % 2) * 20_000).fold(0.0_f64, |sum, k| sum + (k as f64).sqrt());
                assert!(work >= 0.0);
                i * i
            };
            let take = |result| {
                let mut taken = taken.lock().unwrap();
                taken.push(result);
                assert!(*begun.lock().unwrap() <= taken.len() + 7);
                true
            };
            pool.in_order(7, 0..500, || (), part, take);
            assert_eq!(taken.into_inner().unwrap(), (0..500).map(|i| i * i).collect::<Vec<_>>());

            let mut few = Vec::new();
            let take = |result| {
                few.push(result);
                few.len() < 3
            };
            pool.in_order(4, 0..1_000_000_000, || (), |(), i: u64| i, take);
            assert_eq!(few, [0, 1, 2]);
            pool.in_order(4, 0..0, || (), |(), i: u64| i, |_| unreachable!());
        }
    }

    #[test]
    fn a_panic_in_a_part_ends_all() {
        let pool = Pool::new(2).unwrap();
        let part = |_: &mut (), i: u64| if i == 3 { panic!("part 3") } else { i };
        let run = || pool.in_order(2, 0..u64::MAX, || (), part, |_| true);
        assert!(std::panic::catch_unwind(std::panic::AssertUnwindSafe(run)).is_err());
    }
}
