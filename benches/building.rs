//! Cost of getting ready: `cargo bench --bench building`. Reading and checking a scene, building its curve
//! and its model, and what a sweep adds to the runs of its cells.

mod shared;

use std::fmt::Write as _;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use cpu_time::ProcessTime;
use interwell::dynamics::Model;
use interwell::mechanics::Mechanism;
use interwell::scene::{Document, Files};
use interwell_studies::study::{Grid, Sweep, Table, Task};

/// Repetitions of each piece of work, as it comes in units of a microsecond or of a tenth of a second.
const QUICK: usize = 1001;
const SLOW: usize = 9;

fn main() {
    println!("| work | CPU, us |");
    println!("| --- | --- |");
    let text = include_str!("../presets/nominal-cubic.ron");
    let read = || Document::from_text("scene.ron", text, Files::default()).unwrap();
    row("read a scene's text", QUICK, read);
    let cubic = read();
    row("check it", QUICK, || cubic.check().unwrap());
    let build = |document: &Document| Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
    row("curve of a cubic, with its landscape", QUICK, || build(&cubic));
    let paper = shared::changed("paper", &[]);
    row("curve of the preset `paper`: solve its flexures", SLOW * 11, || build(&paper));
    let solid = shared::changed("paper-table", &[]);
    row("curve of the preset `paper-table`: read and fit a table", SLOW * 11, || build(&solid));
    for points in [100, 1000, 10_000] {
        let table = table(points);
        let fit = || Mechanism::from_table(&table, 1e-3).unwrap();
        row(&format!("curve of a smooth table of {points} points"), SLOW, fit);
    }
    let mechanism = Arc::new(build(&cubic));
    row("model of a scene whose curve is there", QUICK, || {
        Model::build(&cubic.scene, mechanism.clone()).unwrap()
    });
    sweep();
}

fn row<R>(name: &str, many: usize, mut work: impl FnMut() -> R) {
    let mut times: Vec<f64> = (0..shared::rounds(many)).map(|_| shared::cpu(&mut work)).collect();
    println!("| {name} | {:.1} |", shared::median(&mut times) * 1e6);
}

/// The cubic double well with wells at 7 mm, as a table.
fn table(points: u32) -> String {
    let mut text = String::from("x_m,force_n\n");
    for i in 0..points {
        let x = 0.02 * (f64::from(i) / f64::from(points - 1) - 0.5);
        writeln!(text, "{x:e},{:e}", 40.0 * x * ((x / 7e-3).powi(2) - 1.0)).unwrap();
    }
    text
}

/// A sweep of cells in which nothing moves: what is left is the sweep itself, its scenes, models and rows.
fn sweep() {
    let document = shared::changed("nominal-cubic", &["excitation.amplitude_g=0", "stops=None"]);
    let over = ["run.duration_s=10:11:0.0001"];
    let grid = Grid::new(document.axes(&over).unwrap()).unwrap();
    let cells = grid.cells() as f64;
    let sweep = Sweep::new(&document.scene, &document.files, grid);
    let pool = interwell::system::threads::Pool::new(1).unwrap();
    let cancel = AtomicBool::new(false);
    let task = Task { tick: &|| (), cancel: &cancel };
    let mut times: Vec<f64> = (0..shared::rounds(SLOW))
        .map(|_| {
            let watch = ProcessTime::now(); // the pool's thread is not this one
            sweep.run(&pool, &task, |_: &Table| Ok::<_, ()>(true)).unwrap();
            watch.elapsed().as_secs_f64() / cells
        })
        .collect();
    println!("| a cell of a sweep in which nothing moves | {:.1} |", shared::median(&mut times) * 1e6);
}
