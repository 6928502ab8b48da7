//! Tests of the distribution of work among threads.

use std::hint::black_box;

use super::*;

fn not_full(runs: usize) -> UnderWay {
    UnderWay { runs, full: false }
}

fn full(runs: usize) -> UnderWay {
    UnderWay { runs, full: true }
}

/// A pool of `threads`, or the calling thread for none.
fn pool_of(threads: usize) -> Pool {
    if threads == 0 { Pool::calling_thread() } else { Pool::new(threads).unwrap() }
}

#[test]
fn results_come_in_order_and_none_is_begun_too_far_ahead() {
    for threads in [0, 1, 2, 5] {
        let pool = pool_of(threads);
        let (begun, received) = (Mutex::new(0), Mutex::new(Vec::new()));
        let work = |next: &dyn Fn(UnderWay) -> Option<usize>, done: &dyn Fn(usize, usize)| {
            while let Some(first) = next(not_full(0)) {
                // two at a time if there are two, the later one first
                let pair = [next(not_full(1)), Some(first)];
                for i in pair.into_iter().flatten() {
                    *begun.lock().unwrap() += 1;
                    done(i, i * i);
                }
            }
        };
        let receive = |results: Vec<usize>| {
            let mut received = received.lock().unwrap();
            assert!(*begun.lock().unwrap() <= received.len() + results.len() + 7);
            received.extend(results);
            true
        };
        pool.in_order(500, 1, 7, work, receive);
        assert_eq!(received.into_inner().unwrap(), (0..500).map(|i| i * i).collect::<Vec<_>>());

        let mut few = Vec::new();
        let receive = |results: Vec<usize>| {
            few.extend(results);
            few.len() < 3
        };
        pool.in_order(1_000_000_000, 1, 4, work, receive);
        assert_eq!(few[..3], [0, 1, 4]);
        pool.in_order(0, 1, 4, work, |_| unreachable!());
    }
}

/// The result of `work`; panics if it does not end within a minute.
fn ends<R: Send + 'static>(work: impl FnOnce() -> R + Send + 'static) -> R {
    let (done, wait) = channel();
    spawn(move || drop(done.send(work())));
    wait.recv_timeout(Duration::from_secs(60)).expect("it does not end")
}

#[test]
fn a_thread_that_gives_up_while_others_wait_ends_all() {
    for (threads, after) in (1..=8).flat_map(|threads| [0, 1, 3, 40].map(|after| (threads, after))) {
        let received = ends(move || {
            let work = |next: &dyn Fn(UnderWay) -> Option<usize>, done: &dyn Fn(usize, usize)| {
                while let Some(number) = next(not_full(0)) {
                    if number == after {
                        return sleep(Duration::from_millis(5)); // the others wait for it by then
                    }
                    done(number, number);
                }
            };
            let mut received = Vec::new();
            Pool::new(threads).unwrap().in_order(1_000_000_000, 1, 5, work, |results| {
                received.extend(results);
                true
            });
            received
        });
        assert_eq!(received, (0..after).collect::<Vec<_>>());
    }
}

#[test]
fn a_panic_of_the_receiver_ends_all() {
    for threads in 1..=8 {
        assert!(ends(move || {
            let work = |next: &dyn Fn(UnderWay) -> Option<usize>, done: &dyn Fn(usize, usize)| {
                std::iter::from_fn(|| next(not_full(0))).for_each(|number| done(number, number));
            };
            let receive =
                |results: Vec<usize>| results.iter().all(|number| *number < 9 || panic!("the ninth"));
            let run = || Pool::new(threads).unwrap().in_order(usize::MAX, 1, 3, work, receive);
            std::panic::catch_unwind(std::panic::AssertUnwindSafe(run)).is_err()
        }));
    }
}

#[test]
fn results_of_a_task_are_received_together_unless_they_are_too_many() {
    for (threads, each) in (0..=8).flat_map(|threads| [1, 7, 255, 256, 257, 300, 700].map(|n| (threads, n))) {
        let all = 2000 / each + 3;
        let work = |next: &dyn Fn(UnderWay) -> Option<usize>, done: &dyn Fn(usize, usize)| {
            while let Some(number) = next(not_full(0)) {
                let pair = [Some(number), next(not_full(1))]; // side by side
                for row in 0..each {
                    pair.iter().flatten().for_each(|taken| done(taken * each + row, taken * each + row));
                }
            }
        };
        let mut received = Vec::new();
        pool_of(threads).in_order(all, each, 4, work, |results| {
            assert!(results.len() <= MAX_BATCH);
            let (first, last) = (results[0], results[results.len() - 1]);
            let together = first % each == 0 && (last + 1) % each == 0;
            assert!(if each <= MAX_BATCH { together } else { first / each == last / each });
            received.extend(results);
            true
        });
        assert_eq!(received, (0..all * each).collect::<Vec<_>>());
    }
}

#[test]
fn shared_results_come_in_order_and_an_error_is_returned() {
    let here = Pool::calling_thread();
    assert_eq!(here.map(3, |part| if part < 2 { Ok(part) } else { Err("third") }), Err("third"));
    assert_eq!(here.find_first(9, || 1, |_, part| (part > 4).then_some(part)), Some(5));
    let pool = Pool::new(3).unwrap();
    for first in [0, 1, 63, 64, 65, 321, 999] {
        let fails = |part: usize| if part < first { Ok(part) } else { Err(part) };
        assert_eq!(pool.map(1000, fails), Err(first));
        assert_eq!(pool.map(first, fails), Ok((0..first).collect()));
        let found = |parts| pool.find_first(parts, || (), |(), part| fails(part as usize).err());
        assert_eq!((found(1000), found(first as u64)), (Some(first), None));
    }
    let squares = |next: &dyn Fn(UnderWay) -> Option<usize>| {
        Ok::<_, ()>(std::iter::from_fn(|| next(not_full(0))).map(|i| (i, i * i)).collect())
    };
    assert_eq!(share(Some(&pool), 100, squares), Ok((0..100).map(|i| i * i).collect()));
    assert_eq!(share(None, 0, squares), Ok(Vec::new()));
    assert_eq!(share(Some(&pool), 9, |_| Err::<Vec<(usize, ())>, _>("wrong")), Err("wrong"));
}

#[test]
fn no_thread_takes_more_than_its_share() {
    let queue = Queue::new(5, 2);
    assert_eq!([0, 1, 2].map(|runs| queue.take(not_full(runs))), [Some(0), Some(1), Some(2)]);
    assert_eq!([3, 0, 2, 1, 0].map(|runs| queue.take(not_full(runs))), [None, Some(3), Some(4), None, None]);
}

#[test]
fn a_thread_with_full_lanes_gets_some_of_the_last_tasks() {
    let queue = Queue::new(40, 2);
    assert_eq!([not_full(16), full(16)].map(|under_way| queue.take(under_way)), [Some(0), None]);
    (1..8).for_each(|next| assert_eq!(queue.take(not_full(0)), Some(next)));
    assert_eq!([17, 19, 20].map(|runs| queue.take(full(runs))), [Some(8), Some(9), None]);
}

#[test]
fn a_panic_in_a_part_ends_all() {
    let pool = Pool::new(2).unwrap();
    let work = |next: &dyn Fn(UnderWay) -> Option<usize>, done: &dyn Fn(usize, usize)| {
        while let Some(number) = next(not_full(0)) {
            assert!(number != 3, "part 3");
            done(number, number);
        }
    };
    let run = || pool.in_order(usize::MAX, 1, 2, work, |_| true);
    assert!(std::panic::catch_unwind(std::panic::AssertUnwindSafe(run)).is_err());
}

/// The sum of all depths up to this one, in frames of 8 KB each: 2.4 MB of stack for 300.
fn deep(depth: u64) -> u64 {
    let frame = black_box([depth; 1 << 10]);
    let below = if depth == 0 { 0 } else { deep(depth - 1) };
    below + black_box(&frame)[0]
}

#[test]
fn threads_of_studies_have_room_for_large_frames() {
    let sum = 300 * 301 / 2;
    assert_eq!(ends(|| deep(300)), sum);
    let all = Pool::new(2).unwrap().map(4, |_| Ok::<_, ()>(deep(300)));
    assert_eq!(all, Ok(vec![sum; 4]));
}
