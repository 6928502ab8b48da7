//! Forecast of a sweep: its cost, estimated from a few cells, and the commands that run it.

use std::sync::Mutex;
use std::time::Duration;

use interwell::output::rows;
use interwell::questions::Error;
use interwell::system::clock::WallClock;
use interwell::system::threads::{Pool, within};
use interwell_studies::study::{Shard, Task};

use super::super::Failure;
use super::super::progress::duration;
use super::super::shard::{command, value};
use super::super::support::{arguments, counted};
use super::prepared::Prepared;

/// Cells of the first sample for each thread.
const CELLS_PER_THREAD: u64 = 64;
/// Time in s that a sample must take for its mean to be used.
const MIN_SAMPLE_S: f64 = 0.3;
/// Longest time of a sample.
const PATIENCE: Duration = Duration::from_secs(10);

/// Time in s above which a sweep is split into more than the usual number of shards.
const LONG_S: f64 = 3600.0;
/// Time in s of each shard of such a sweep.
const SHARD_S: f64 = 1800.0;

/// Approximate memory of the program itself in bytes.
const PROGRAM_BYTES: u64 = 20_000_000;

/// Prints the number of cells, the time, the memory and the commands.
pub fn print(prepared: &Prepared, pool: &Pool) -> Result<(), Failure> {
    let Prepared { document, sweep, slice, columns, .. } = prepared;
    let (picture, sharded) = (prepared.picture.is_some(), prepared.options.shard.is_some());
    let wrong =
        within(PATIENCE, |cancel| sweep.validate_rows(slice, 0, pool, &Task { tick: &|| (), cancel }));
    wrong.map_err(|cell| Error::cells_of(document, vec![cell]))?;
    let (count, threads, runs) = (slice.rows(), pool.count(), sweep.runs_per_row());
    // Multiples of the golden section are evenly spread and do not resonate with the axes (Weyl 1916).
    let place = |i: u64| ((i as f64 + 0.5) * 0.618_033_988_749_895).fract() * count as f64;
    let mut sample = count.min(CELLS_PER_THREAD * threads as u64);
    let (run, bytes, seconds) = loop {
        let cells: Vec<u64> = (0..sample).map(|i| sweep.cell(slice.row(place(i) as u64))).collect();
        let found = Mutex::new((0_u64, 0));
        let clock = WallClock::start();
        within(PATIENCE, |cancel| {
            let each = |index, cell| {
                // a draw makes numbers of about the same length
                let text = rows(&sweep.table(index, vec![cell; runs as usize]), 0..1).len();
                if let Ok(mut found) = found.lock() {
                    *found = (found.0 + 1, found.1 + text);
                }
            };
            sweep.run_cells(pool, &Task { tick: &|| (), cancel }, &cells, &each)
        });
        let (run, bytes) = found.into_inner().unwrap_or_default();
        if clock.seconds() > MIN_SAMPLE_S || sample == count {
            break (run, bytes, clock.seconds() / run.max(1) as f64 * (runs * count) as f64);
        }
        sample = (4 * sample).min(count);
    };

    let axes = sweep.grid().axes().iter().zip(sweep.grid().columns());
    let axes: Vec<String> = axes.map(|(axis, name)| format!("{} {name}", axis.values.len())).collect();
    let (shard, all) = (slice.shard(), sweep.rows());
    let of = if sharded { format!(" of the shard {shard}, of {all}") } else { String::new() };
    println!("{}{of}: {}; {} columns", counted(count, "row"), axes.join(" x "), columns.len());
    let about = duration(seconds);
    match run {
        0 if count == 0 => println!("nothing to compute"),
        0 => println!("more than {about} on {threads} threads: no cell came to its end in {PATIENCE:?}"),
        _ => {
            let size = bytes as f64 / run as f64 * count as f64 / 1e6;
            println!(
                "about {about} on {threads} threads, estimated from {run} cells; about {size:.1} MB of rows"
            );
        }
    }
    // the table that a picture needs
    let table = if picture { 16 * sweep.rows() * sweep.empty_table().columns().len() as u64 } else { 0 };
    let memory = PROGRAM_BYTES + sweep.memory(threads) + table;
    let kept = if picture { ", with the table that the picture needs" } else { "" };
    println!("at most about {} MB of memory{kept}", memory.div_ceil(1_000_000));

    let arguments = arguments();
    let out = value(&arguments, "--out").unwrap_or("map.csv");
    if sharded {
        let shard = slice.shard().to_string();
        println!("\n{}", command(&arguments, &["--shard", &shard, "--out", out, "--resume"]));
        return Ok(());
    }
    println!("\nIn one process, repeated until the file is complete:");
    println!("  {}", command(&arguments, &["--out", out, "--resume"]));
    if picture {
        return Ok(());
    }
    let shards = if seconds > LONG_S { (seconds / SHARD_S).ceil().min(1000.0) as u64 } else { 4 };
    let stem = out.strip_suffix(".csv").unwrap_or(out);
    let name = format!("{stem}-{{shard}}.csv");
    println!("In {shards} processes, on any machines:");
    let listed = if shards <= 8 { shards } else { 2 };
    for number in (1..=listed).chain((listed < shards).then_some(shards)) {
        if number > listed + 1 {
            println!("  ...");
        }
        let shard = Shard::new(number, shards).map_err(Failure::argument)?.to_string();
        println!("  {}", command(&arguments, &["--shard", &shard, "--out", &name, "--resume"]));
    }
    println!("  interwell --headless merge {stem}-*-of-{shards}.csv --out {out}");
    Ok(())
}
