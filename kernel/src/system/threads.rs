//! Threads, and the distribution of work among them.
//!
//! [`Pool::new`] is the only function that fails, with [`NoThreads`], where the system grants no thread.
//! Results come in the order of their parts, whatever the number of threads. A panic in a part goes on in
//! the caller.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use rayon::prelude::*;
use web_time::Instant;

/// Largest number of threads that a person may ask for; starting more takes minutes and makes nothing faster.
#[doc(hidden)]
pub const MAX_THREADS: u16 = 1024;

/// Number of processors that the program may use; from 1 to [`MAX_THREADS`].
pub fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from).min(MAX_THREADS.into())
}

/// Stack size in bytes of a thread for studies. Without optimisation the integrator needs more than the
/// default of 2 MB. The system provides memory only for the part that is used.
const STACK: usize = 16 << 20;

/// Runs `work` on a new thread; in a web page on this one, before it returns. Returns false if the thread
/// cannot be started.
#[doc(hidden)]
pub fn spawn(work: impl FnOnce() + Send + 'static) -> bool {
    if cfg!(target_arch = "wasm32") {
        work();
        return true;
    }
    std::thread::Builder::new().name("study".into()).stack_size(STACK).spawn(work).is_ok()
}

/// Suspends this thread.
#[doc(hidden)]
pub fn sleep(time: Duration) {
    std::thread::sleep(time);
}

/// A pool of threads that share the parts of one study; or the calling thread alone, which works on one part
/// after the other, as in a web page, where no thread can be started.
///
/// ```
/// # use interwell_kernel as interwell;
/// use interwell::system::threads::{Pool, processors};
///
/// let pool = Pool::new(processors())?;
/// let squares = pool.map(4, |part| Ok::<_, std::convert::Infallible>(part * part));
/// assert_eq!(squares, Ok(vec![0, 1, 4, 9]));
/// # Ok::<(), interwell::system::threads::NoThreads>(())
/// ```
#[derive(Debug)]
pub struct Pool {
    /// `None` for the calling thread.
    threads: Option<rayon::ThreadPool>,
    /// The process that started them: one that is forked from it has no threads of the pool.
    process: u32,
}

/// Failure to start threads.
#[derive(Debug, thiserror::Error)]
#[error("cannot start {count} threads: {reason}")]
pub struct NoThreads {
    count: usize,
    reason: String,
}

/// The number of this process; a web page has none.
fn process() -> u32 {
    if cfg!(target_arch = "wasm32") { 0 } else { std::process::id() }
}

impl Pool {
    /// Starts `count` threads. In a web page, where there are none, the pool is the calling thread.
    ///
    /// # Errors
    ///
    /// [`NoThreads`] where the system grants no thread.
    pub fn new(count: usize) -> Result<Self, NoThreads> {
        if cfg!(target_arch = "wasm32") {
            return Ok(Self::calling_thread());
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).stack_size(STACK).build();
        let threads = pool.map_err(|error| NoThreads { count, reason: error.to_string() })?;
        Ok(Self { threads: Some(threads), process: process() })
    }

    /// The calling thread.
    pub fn calling_thread() -> Self {
        Self { threads: None, process: process() }
    }

    /// Number of threads.
    pub fn count(&self) -> usize {
        self.threads.as_ref().map_or(1, rayon::ThreadPool::current_num_threads)
    }

    /// Whether its threads are there: they are not in a process that was forked from the one of the pool.
    #[doc(hidden)]
    pub fn is_alive(&self) -> bool {
        self.process == process()
    }

    /// The results of parts 0 to `parts` (exclusive) in order, or the first error, after which no later part
    /// begins.
    pub fn map<R: Send, E: Send>(
        &self,
        parts: usize,
        part: impl Fn(usize) -> Result<R, E> + Sync,
    ) -> Result<Vec<R>, E> {
        let Some(threads) = &self.threads else { return (0..parts).map(part).collect() };
        let done = Mutex::new(Vec::with_capacity(parts));
        let errors = Mutex::new(BTreeMap::new());
        let fails = |number| match part(number) {
            Ok(result) => {
                lock(&done).push((number, result));
                false
            }
            Err(error) => lock(&errors).insert(number, error).is_none(),
        };
        let error = first(threads, parts, &fails).and_then(|number| lock(&errors).remove(&number));
        error.map_or_else(|| Ok(in_order(done.into_inner().unwrap_or_else(PoisonError::into_inner))), Err)
    }

    /// The result of the first of parts 0 to `parts` (exclusive) that has one. `state` creates data that is
    /// reused from part to part.
    pub fn find_first<S, R: Send>(
        &self,
        parts: u64,
        state: impl Fn() -> S + Sync,
        part: impl Fn(&mut S, u64) -> Option<R> + Sync,
    ) -> Option<R> {
        let within = |mut parts: Range<u64>| {
            let mut state = state();
            parts.find_map(|number| part(&mut state, number))
        };
        let Some(threads) = &self.threads else { return within(0..parts) };
        let found = Mutex::new(BTreeMap::new());
        let finds = |block: usize| {
            let from = block as u64 * PARTS_WITH_A_STATE;
            let result = within(from..parts.min(from + PARTS_WITH_A_STATE));
            result.is_some_and(|result| lock(&found).insert(block, result).is_none())
        };
        let block = first(threads, parts.div_ceil(PARTS_WITH_A_STATE) as usize, &finds)?;
        lock(&found).remove(&block)
    }

    /// Computes results on all threads and passes them in order to `receive` on this thread, while further
    /// results are being computed.
    ///
    /// Each thread calls `work` once. The first argument of `work` returns the next task, an index below
    /// `count`, as from a [`Queue`]; the second one takes an index of a result and the result. Each task has
    /// `per_task` results with consecutive indices, which must be delivered in order. `receive` gets several
    /// results at a time, and all results of a task together if there are at most 256. At most `ahead` tasks
    /// are begun beyond the last one whose results have all been received. The function returns early if
    /// `receive` returns false. It also returns early if a `work` returns while tasks remain, after passing
    /// on the results that are complete and in order.
    #[doc(hidden)]
    pub fn in_order<R: Send>(
        &self,
        count: usize,
        per_task: usize,
        ahead: usize,
        work: impl Fn(&dyn Fn(UnderWay) -> Option<usize>, &dyn Fn(usize, R)) + Sync,
        receive: impl FnMut(Vec<R>) -> bool,
    ) {
        let queue = Queue { ahead, ..Queue::new(count, self.count()) };
        let mut delivery = Delivery { queue: &queue, per_task, waiting: BTreeMap::new(), passed: 0, receive };
        let Some(threads) = &self.threads else {
            let (delivery, is_over) = (RefCell::new(delivery), Cell::new(false));
            let done = |index, result| {
                // runs that were under way end later
                if !is_over.get() && !delivery.borrow_mut().pass([(index, result)]) {
                    is_over.set(true);
                    queue.stop();
                }
            };
            return work(&|under_way| queue.take(under_way), &done);
        };
        let (sender, receiver) = channel();
        let compute = || {
            let sender = EndNotice(sender.clone());
            let pending = RefCell::new((Vec::new(), Instant::now()));
            let send = || {
                let done = std::mem::take(&mut pending.borrow_mut().0);
                let _ = sender.0.send(Message::Done(done));
                pending.borrow_mut().1 = Instant::now();
            };
            let take = |under_way: UnderWay| {
                queue.take(under_way).or_else(|| {
                    let idle = under_way.runs == 0;
                    idle.then(&send)?;
                    queue.wait()
                })
            };
            let done = |index, result| {
                pending.borrow_mut().0.push((index, result));
                if pending.borrow().1.elapsed() > SEND_INTERVAL {
                    send();
                }
            };
            work(&take, &done);
            send();
        };
        on_all(threads, &compute, &mut || {
            // Stops the queue on every exit, including a panic of `receive`, so that no thread keeps waiting.
            let _stop = StopOnDrop(&queue);
            let mut working = self.count();
            while working > 0 {
                match receiver.recv() {
                    Ok(Message::Done(results)) => {
                        if !delivery.pass(results) {
                            return;
                        }
                    }
                    Ok(Message::Ended) => {
                        // If tasks remain, this thread has given up or panicked (the scope propagates the
                        // panic after all threads have ended). Some results will then be missing, and no
                        // thread may wait for them.
                        queue.stop();
                        working -= 1;
                    }
                    Err(_) => break,
                }
            }
        });
    }

    /// Runs `work` on each thread.
    pub fn everywhere(&self, work: impl Fn() + Sync) {
        match &self.threads {
            Some(threads) => on_all(threads, &work, &mut || ()),
            None => work(),
        }
    }
}

// What follows is not generic: rayon's code is compiled once, not for every study.

/// The first of parts 0 to `parts` (exclusive) that `is_it`; no later part begins then.
fn first(threads: &rayon::ThreadPool, parts: usize, is_it: &(dyn Fn(usize) -> bool + Sync)) -> Option<usize> {
    threads.install(|| (0..parts).into_par_iter().with_max_len(1).find_first(|part| is_it(*part)))
}

/// Calls `each` on every thread of the pool while `here` runs on this one.
fn on_all(threads: &rayon::ThreadPool, each: &(dyn Fn() + Sync), here: &mut dyn FnMut()) {
    threads.in_place_scope(|scope| {
        scope.spawn_broadcast(|_, _| each());
        here();
    });
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The numbered results in their order.
fn in_order<R>(mut all: Vec<(usize, R)>) -> Vec<R> {
    all.sort_unstable_by_key(|(number, _)| *number);
    all.into_iter().map(|(_, result)| result).collect()
}

/// Results that wait for earlier ones, and their receiver.
struct Delivery<'a, R, F> {
    queue: &'a Queue,
    per_task: usize,
    waiting: BTreeMap<usize, R>,
    /// Number of results that have been received.
    passed: usize,
    receive: F,
}

impl<R, F: FnMut(Vec<R>) -> bool> Delivery<'_, R, F> {
    /// Takes results, each with its index, and passes on what is in order. Returns false once the receiver
    /// wants no more.
    fn pass(&mut self, results: impl IntoIterator<Item = (usize, R)>) -> bool {
        self.waiting.extend(results);
        loop {
            // all results of one or more tasks, or a part of the results of one large task
            let (step, limit) = match self.per_task <= MAX_BATCH {
                true => (self.per_task, MAX_BATCH),
                false => (1, MAX_BATCH.min(self.per_task - self.passed % self.per_task)),
            };
            let ends = (1..=limit / step).map(|steps| self.passed + steps * step);
            let until = ends.take_while(|end| self.waiting.contains_key(&(end - 1))).last();
            let in_order = self.passed..until.unwrap_or(self.passed);
            let next: Vec<R> = in_order.map_while(|index| self.waiting.remove(&index)).collect();
            if next.is_empty() {
                return true;
            }
            self.passed += next.len();
            self.queue.set_finished(self.passed / self.per_task);
            if !(self.receive)(next) {
                return false;
            }
        }
    }
}

/// The results of tasks 0 to `count` (exclusive) in order, or an error of one of them. Each thread of the
/// pool, or this thread without a pool, calls `work`, which takes tasks as from a [`Queue`] and returns their
/// results.
#[doc(hidden)]
pub fn share<R: Send, E: Send>(
    pool: Option<&Pool>,
    count: usize,
    work: impl Fn(&dyn Fn(UnderWay) -> Option<usize>) -> Result<Vec<(usize, R)>, E> + Sync,
) -> Result<Vec<R>, E> {
    let queue = Queue::new(count, pool.map_or(1, Pool::count));
    share_from(pool, &|under_way| queue.take(under_way), work)
}

/// Like [`share`], for the tasks that `take` returns, as from a [`Queue`].
#[doc(hidden)]
pub fn share_from<R: Send, E: Send>(
    pool: Option<&Pool>,
    take: &(dyn Fn(UnderWay) -> Option<usize> + Sync),
    work: impl Fn(&dyn Fn(UnderWay) -> Option<usize>) -> Result<Vec<(usize, R)>, E> + Sync,
) -> Result<Vec<R>, E> {
    let part = || work(&take);
    let all: Vec<(usize, R)> = match pool {
        Some(pool) => pool.map(pool.count(), |_| part())?.into_iter().flatten().collect(),
        None => part()?,
    };
    Ok(in_order(all))
}

/// Smallest time between two messages of a thread; faster results are sent several at a time.
const SEND_INTERVAL: Duration = Duration::from_millis(1);

/// Number of parts that share a state where the first of many is searched for.
const PARTS_WITH_A_STATE: u64 = 64;

/// Largest number of results that are passed on at once.
const MAX_BATCH: usize = 256;

/// Work in progress of a thread that asks for a task.
#[derive(Debug, Clone, Copy, Default)]
#[doc(hidden)]
pub struct UnderWay {
    /// Number of runs in progress.
    pub runs: usize,
    /// Whether these runs fill the lanes of the thread. A [`Queue`] then gives it only the last tasks, 16 per
    /// thread. Their runs start early and take turns with the others, so that all end at about the same time.
    /// Runs that start one after another would leave more and more lanes empty at the end.
    pub full: bool,
}

/// Number of tasks per thread, at the end of a queue, that threads with full lanes may take.
const LAST_PER_THREAD: usize = 16;

/// Queue of tasks, given by their indices; each is taken once, by one of several threads.
#[derive(Debug)]
#[doc(hidden)]
pub struct Queue {
    count: usize,
    /// Largest number of unfinished tasks that have been taken.
    ahead: usize,
    threads: usize,
    state: Mutex<Progress>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct Progress {
    next: usize,
    finished: usize,
    stopped: bool,
}

impl Queue {
    /// A queue of `count` tasks for `threads` threads.
    pub fn new(count: usize, threads: usize) -> Self {
        Self { count, ahead: usize::MAX, threads, state: Mutex::default(), changed: Condvar::new() }
    }

    /// The next task for a thread with this work in progress. Returns `None` if no task is left, or if the
    /// thread should not get one now, for example because it already has its share of a small number of
    /// tasks.
    pub fn take(&self, under_way: UnderWay) -> Option<usize> {
        self.take_from(&mut self.lock(), under_way)
    }

    /// The next task for a thread without work in progress; waits until there is one. Returns `None` only if
    /// no task is left.
    fn wait(&self) -> Option<usize> {
        let must_wait =
            |state: &mut Progress| !state.stopped && state.next < self.count && self.is_full(state);
        let waited = self.changed.wait_while(self.lock(), must_wait);
        let mut state = waited.unwrap_or_else(PoisonError::into_inner);
        self.take_from(&mut state, UnderWay::default())
    }

    fn take_from(&self, state: &mut Progress, under_way: UnderWay) -> Option<usize> {
        if under_way.full && self.count - state.next > LAST_PER_THREAD * self.threads {
            return None;
        }
        let has_its_share = under_way.runs > 0 && under_way.runs >= self.count.div_ceil(self.threads);
        if state.stopped || state.next == self.count || has_its_share || self.is_full(state) {
            return None;
        }
        state.next += 1;
        Some(state.next - 1)
    }

    fn is_full(&self, state: &Progress) -> bool {
        state.next - state.finished >= self.ahead
    }

    /// Records that the first `finished` tasks are finished.
    fn set_finished(&self, finished: usize) {
        self.lock().finished = finished;
        self.changed.notify_all();
    }

    fn stop(&self) {
        self.lock().stopped = true;
        self.changed.notify_all();
    }

    fn lock(&self) -> MutexGuard<'_, Progress> {
        lock(&self.state)
    }
}

/// A message from a thread to the receiver of its results.
enum Message<R> {
    /// Results, each with its index.
    Done(Vec<(usize, R)>),
    /// The thread has ended, possibly by a panic.
    Ended,
}

/// Sends [`Message::Ended`] when it is dropped, which a panic does too.
struct EndNotice<R>(Sender<Message<R>>);

impl<R> Drop for EndNotice<R> {
    fn drop(&mut self) {
        let _ = self.0.send(Message::Ended);
    }
}

struct StopOnDrop<'a>(&'a Queue);

impl Drop for StopOnDrop<'_> {
    fn drop(&mut self) {
        self.0.stop();
    }
}

/// Runs `work`, and sets its argument after `timeout` so that it can stop.
#[doc(hidden)]
pub fn within<R>(timeout: Duration, work: impl FnOnce(&AtomicBool) -> R) -> R {
    let cancel = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let (done, wait) = channel::<()>();
        let cancel = &cancel;
        scope.spawn(move || {
            if wait.recv_timeout(timeout) == Err(RecvTimeoutError::Timeout) {
                cancel.store(true, Ordering::Relaxed);
            }
        });
        let result = work(cancel);
        drop(done);
        result
    })
}

#[cfg(test)]
mod tests;
