//! A map: one row of CSV on standard output for each travel limit and amplitude, computed in parallel.
//!
//! `cargo run --release --example sweep`

use std::error::Error;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use interwell::output;
use interwell::scene::Document;
use interwell::study::{Grid, Sweep, SweepEnd, Table, Task};
use interwell::system::threads::{Pool, processors};

/// Fields of the scene and their values: a range with its step, or a list.
pub const OVER: [&str; 2] = ["stops.travel_limit_mm=2:6:1", "excitation.amplitude_g=0.5,1,1.5"];

/// The rows of the map, headed by the names of the columns; and how many cells were run.
pub fn run() -> Result<(String, u64), Box<dyn Error>> {
    // A built-in scene, one field changed.
    let mut document = Document::load("nominal-cubic")?;
    document.set("run.tolerance=1e-6")?;
    document.check()?;
    let grid = Grid::new(document.axes(&OVER)?)?;
    let sweep = Sweep::new(&document.scene, &document.files, grid);

    // Threads, a counter of the cells that are done, and a flag that another thread may set to stop it.
    let pool = Pool::new(processors())?;
    let (done, cancel) = (AtomicU64::new(0), AtomicBool::new(false));
    let tick = || {
        done.fetch_add(1, Ordering::Relaxed);
    };
    let task = Task { tick: &tick, cancel: &cancel };
    sweep.validate(&pool, &task).map_err(|wrong| format!("{}: {:?}", wrong.cell, wrong.faults))?;

    // Rows come in order and in chunks; true asks for more.
    let mut text = output::header(&sweep.empty_table());
    let write = |table: &Table| -> Result<bool, std::fmt::Error> {
        text += &output::rows(table, 0..table.rows());
        Ok(true)
    };
    sweep.run(&pool, &task, write).map_err(|end| match end {
        SweepEnd::Cancelled => "cancelled".to_owned(),
        SweepEnd::Write(error) => error.to_string(),
    })?;
    Ok((text, done.into_inner()))
}

fn main() -> Result<(), Box<dyn Error>> {
    let (text, cells) = run()?;
    print!("{text}");
    eprintln!("{cells} cells");
    Ok(())
}
