//! CPU times of pieces of work, on a machine that others use too.
//!
//! Time is the CPU time of the thread, read inside the process: a wall clock counts what others do meanwhile,
//! and the start of the process. Each figure is the median of many, and what is compared is run in turn, so
//! that a slow second slows both. (Criterion and divan measure by the wall clock and show no error beside the
//! time.)

// Each bench uses its part.
#![allow(dead_code, unused_imports)]

#[path = "../../tests/shared/mod.rs"]
mod scenes;

use std::hint::black_box;
use std::time::Instant;

use cpu_time::{ProcessTime, ThreadTime};
pub use scenes::{changed, mechanism, preset};

/// `many` under `cargo bench`; 1 where the benches are only tried, as `cargo test --benches` does.
pub fn rounds(many: usize) -> usize {
    if is_measured() { many } else { 1 }
}

/// Whether `cargo bench` runs this.
pub fn is_measured() -> bool {
    std::env::args().any(|argument| argument == "--bench")
}

/// CPU time of `work` in s.
pub fn cpu<R>(work: impl FnOnce() -> R) -> f64 {
    let watch = ThreadTime::now();
    black_box(work());
    watch.elapsed().as_secs_f64()
}

/// The same of all threads: of work on a pool, while nothing else runs.
pub fn cpu_of_all<R>(work: impl FnOnce() -> R) -> f64 {
    let watch = ProcessTime::now();
    black_box(work());
    watch.elapsed().as_secs_f64()
}

/// Wall time of `work` in s, and the same without the time in which its threads wait for a processor that
/// others use, where the system tells that (Linux).
pub fn wall<R>(work: impl FnOnce() -> R) -> (f64, f64) {
    let (watch, before) = (Instant::now(), run_and_waited());
    black_box(work());
    let time = watch.elapsed().as_secs_f64();
    let (run, waited) = run_and_waited();
    let (run, waited) = (run - before.0, waited - before.1);
    (time, if run > 0.0 { time * run / (run + waited) } else { time })
}

/// Nanoseconds that the threads of this process have run, and have waited for a processor.
fn run_and_waited() -> (f64, f64) {
    let of = |entry: std::io::Result<std::fs::DirEntry>| {
        let text = std::fs::read_to_string(entry.ok()?.path().join("schedstat")).ok()?;
        let mut numbers = text.split(' ').map_while(|word| word.parse::<f64>().ok());
        numbers.next().zip(numbers.next())
    };
    let threads = std::fs::read_dir("/proc/self/task").into_iter().flatten().filter_map(of);
    threads.fold((0.0, 0.0), |sum, thread| (sum.0 + thread.0, sum.1 + thread.1))
}

/// The median of some numbers; sorts them.
pub fn median(values: &mut [f64]) -> f64 {
    quantile(values, 0.5)
}

/// The value that the share `q` of them does not exceed; sorts them.
pub fn quantile(values: &mut [f64], q: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((values.len() - 1) as f64 * q).round() as usize]
}

/// Median CPU time in s of each of two pieces of work, and the median of the ratio of the second to the first
/// over pairs run one after the other, in alternating order.
pub fn compare<A, B>(pairs: usize, mut a: impl FnMut() -> A, mut b: impl FnMut() -> B) -> (f64, f64, f64) {
    let (mut of_a, mut of_b) = (Vec::new(), Vec::new());
    for pair in 0..pairs {
        if pair % 2 == 0 {
            of_a.push(cpu(&mut a));
            of_b.push(cpu(&mut b));
        } else {
            of_b.push(cpu(&mut b));
            of_a.push(cpu(&mut a));
        }
    }
    let mut ratios: Vec<f64> = of_a.iter().zip(&of_b).map(|(a, b)| b / a).collect();
    (median(&mut of_a), median(&mut of_b), median(&mut ratios))
}
