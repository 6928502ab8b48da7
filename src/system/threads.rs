//! Threads.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use rayon::prelude::*;

/// How many processors the program may use; at least 1.
pub fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Stack of a thread that studies run on: compiled without optimisation, the integrator takes more than the
/// 2 MB that a thread has by default. The system provides memory only for what is used.
const STACK: usize = 16 << 20;

/// Does `work` on a thread of its own. Whether the system has one to give.
pub fn spawn(work: impl FnOnce() + Send + 'static) -> bool {
    std::thread::Builder::new().name("study".into()).stack_size(STACK).spawn(work).is_ok()
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
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).stack_size(STACK).build();
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

    /// Has each thread `work` on the numbers from 0 to `count` that it takes by the first argument, as from a
    /// [`Queue`], and hand over their results by the second one, so many of `each` number, numbered through
    /// and those of one number in order. They leave in order, here, some at a time and those of a number
    /// together where they are not very many, while others are still worked on. At most so many numbers
    /// are begun `ahead` of the last one whose results have left. Ends early where `leave` wants no more, and
    /// where a `work` ends while there are more: those of the others that can still leave do.
    pub fn in_order<R: Send>(
        &self,
        (count, each, ahead): (usize, usize, usize),
        work: impl Fn(&dyn Fn(UnderWay) -> Option<usize>, &dyn Fn(usize, R)) + Sync,
        mut leave: impl FnMut(Vec<R>) -> bool,
    ) {
        let queue = Queue { ahead, ..Queue::new(count, self.count()) };
        let (tell, news) = channel();
        self.0.in_place_scope(|scope| {
            scope.spawn_broadcast(|_, _| {
                let farewell = Farewell(tell.clone());
                let held = RefCell::new((Vec::new(), Instant::now()));
                let send = || {
                    let done = std::mem::take(&mut held.borrow_mut().0);
                    let _ = farewell.0.send(News::Done(done));
                    held.borrow_mut().1 = Instant::now();
                };
                let take = |under_way: UnderWay| {
                    queue.take(under_way).or_else(|| {
                        let idle = under_way.runs == 0;
                        idle.then(&send)?;
                        queue.wait()
                    })
                };
                let done = |number, result| {
                    held.borrow_mut().0.push((number, result));
                    if held.borrow().1.elapsed() > SOON {
                        send();
                    }
                };
                work(&take, &done);
                send();
            });
            // However this ends, be it by a panic of `leave`: no thread waits for more.
            let _over = Over(&queue);
            let (mut waiting, mut left, mut working) = (BTreeMap::new(), 0, self.count());
            while working > 0 {
                match news.recv() {
                    Ok(News::Done(results)) => waiting.extend(results),
                    Ok(News::Ended) => {
                        // While there is more it has given up, or panics, which goes on when all threads have
                        // ended: some results will never come, and nobody is to wait for them.
                        queue.stop();
                        working -= 1;
                    }
                    Err(_) => break,
                }
                loop {
                    // whole numbers, or of a large one some, none beyond its end
                    let (step, most) = match each <= MOST {
                        true => (each, MOST),
                        false => (1, MOST.min(each - left % each)),
                    };
                    let ends = (1..=most / step).map(|more| left + more * step);
                    let until = ends.take_while(|end| waiting.contains_key(&(end - 1))).last();
                    let in_order = (left..until.unwrap_or(left)).map_while(|own| waiting.remove(&own));
                    let next: Vec<R> = in_order.collect();
                    if next.is_empty() {
                        break;
                    }
                    left += next.len();
                    queue.leave(left / each);
                    if !leave(next) {
                        return;
                    }
                }
            }
        });
    }

    /// Does the same on each thread.
    pub fn everywhere(&self, work: impl Fn() + Sync) {
        self.0.broadcast(|_| work());
    }
}

/// The results of all numbers from 0 to `count`, in order, or an error of one of them. Each thread of a pool,
/// or without one this one, asks `work` for those of the numbers that it takes, as from a [`Queue`].
pub fn share<R: Send, E: Send>(
    pool: Option<&Pool>,
    count: usize,
    work: impl Fn(&dyn Fn(UnderWay) -> Option<usize>) -> Result<Vec<(usize, R)>, E> + Sync,
) -> Result<Vec<R>, E> {
    let queue = Queue::new(count, pool.map_or(1, Pool::count));
    share_from(pool, &|held| queue.take(held), work)
}

/// The same of all numbers that `take` gives, as of a [`Queue`], in their order.
pub fn share_from<R: Send, E: Send>(
    pool: Option<&Pool>,
    take: &(dyn Fn(UnderWay) -> Option<usize> + Sync),
    work: impl Fn(&dyn Fn(UnderWay) -> Option<usize>) -> Result<Vec<(usize, R)>, E> + Sync,
) -> Result<Vec<R>, E> {
    let part = || work(&take);
    let mut all: Vec<(usize, R)> = match pool {
        Some(pool) => pool.map(pool.count(), || (), |(), _| part())?.into_iter().flatten().collect(),
        None => part()?,
    };
    all.sort_unstable_by_key(|own| own.0);
    Ok(all.into_iter().map(|own| own.1).collect())
}

/// Results that come faster than this are handed over some at a time.
const SOON: Duration = Duration::from_millis(1);

/// The most that leave at once.
const MOST: usize = 256;

/// What a thread holds when it asks for a number.
#[derive(Debug, Clone, Copy, Default)]
pub struct UnderWay {
    /// Runs that are under way.
    pub runs: usize,
    /// Whether they fill its lanes. A [`Queue`] then gives it only the last of all numbers, 16 for each
    /// thread: these runs begin early, take turns with those before them, and all end about together. Begun
    /// in turn they would leave more and more lanes empty.
    pub full: bool,
}

/// The last numbers that a thread with full lanes is given, for each thread.
const LAST: usize = 16;

/// Numbers from 0 on that threads take from each other, each of them once.
#[derive(Debug)]
pub struct Queue {
    count: usize,
    /// How many may be taken before the first of them has left.
    ahead: usize,
    threads: usize,
    state: Mutex<Taken>,
    moved: Condvar,
}

#[derive(Debug, Default)]
struct Taken {
    next: usize,
    left: usize,
    stopped: bool,
}

impl Queue {
    /// So many numbers for so many threads.
    pub fn new(count: usize, threads: usize) -> Self {
        Self { count, ahead: usize::MAX, threads, state: Mutex::default(), moved: Condvar::new() }
    }

    /// One more number for a thread that holds this. None where none is left, or at present none is for
    /// this thread: of few numbers none holds more than its share.
    pub fn take(&self, held: UnderWay) -> Option<usize> {
        self.take_from(&mut self.lock(), held)
    }

    /// The same for a thread that holds none: none only where none is left.
    fn wait(&self) -> Option<usize> {
        let is_full = |own: &mut Taken| !own.stopped && own.next < self.count && self.is_full(own);
        let mut state = self.moved.wait_while(self.lock(), is_full).unwrap_or_else(PoisonError::into_inner);
        self.take_from(&mut state, UnderWay::default())
    }

    fn take_from(&self, state: &mut Taken, held: UnderWay) -> Option<usize> {
        if held.full && self.count - state.next > LAST * self.threads {
            return None;
        }
        let has_its_share = held.runs > 0 && held.runs >= self.count.div_ceil(self.threads);
        if state.stopped || state.next == self.count || has_its_share || self.is_full(state) {
            return None;
        }
        state.next += 1;
        Some(state.next - 1)
    }

    fn is_full(&self, state: &Taken) -> bool {
        state.next - state.left >= self.ahead
    }

    /// So many, from 0 on, have left.
    fn leave(&self, left: usize) {
        self.lock().left = left;
        self.moved.notify_all();
    }

    /// Gives no more.
    fn stop(&self) {
        self.lock().stopped = true;
        self.moved.notify_all();
    }

    fn lock(&self) -> MutexGuard<'_, Taken> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What a thread tells whoever waits for its results.
enum News<R> {
    /// Results, each with its number.
    Done(Vec<(usize, R)>),
    /// It has come to its end, be it by a panic.
    Ended,
}

/// Tells, however a thread ends, that it has ended.
struct Farewell<R>(Sender<News<R>>);

impl<R> Drop for Farewell<R> {
    fn drop(&mut self) {
        let _ = self.0.send(News::Ended);
    }
}

/// Stops a queue, however what uses it ends.
struct Over<'a>(&'a Queue);

impl Drop for Over<'_> {
    fn drop(&mut self) {
        self.0.stop();
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
mod tests;
