//! Error against cost, as the README's table: `cargo bench --bench work_precision`.
//!
//! "In company": a run among 64, as in a map, in which they share their steps.
//!
//! Three problems of the preset `nominal-cubic`, ten seconds each:
//!
//! - P1: no stops, 1.1 g. Error: final displacement over the well's distance, against the same run in some
//!   31 digits.
//! - P2: stops at 4 mm, 1.5 g: 780 impacts down to 1 um/s and 60 rests. Error: the worse of the times of the
//!   impacts above 1 cm/s, in forcing periods, and the relative error of the RMS velocity, against the run in
//!   some 31 digits. Once as it is, where the cycle comes back exactly and the rest is known, and once
//!   integrated to the end.
//! - P3: its map, 41 travel limits by 101 amplitudes. Error: that of the RMS velocity, relative, against the
//!   same map at a tighter tolerance; the median over the cells that move, and the 99 % quantile over those
//!   of them that are not irregular, since the median does not see the cells near a threshold.

mod shared;

use interwell::dynamics::{Event, EventKind, Model, Regime, Request, Run, Summary};
use interwell::scene::Document;
use interwell_studies::study::Grid;

const TOLERANCES: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];

/// Tolerance of the runs in some 31 digits.
const REFERENCE: f64 = 1e-27;

/// Tolerance of the map that maps are compared with: the tightest that rounding leaves a meaning.
const MAP_REFERENCE: f64 = 1e-13;

/// Runs of P1 and P2 at each tolerance, and maps at each.
const RUNS: usize = 301;
const MAPS: usize = 3;

/// Runs that a map hands to one thread at a time.
const TOGETHER: usize = 64;

/// Distance of the wells from the top between them, m.
const WELL: f64 = 7e-3;

fn main() {
    println!("| problem | tolerance | error | 99 % of cells | steps | CPU | batched |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    runs();
    map();
}

fn runs() {
    let free = shared::preset("nominal-cubic", &["stops=None", "excitation.amplitude_g=1.1"]);
    let stopped = shared::preset("nominal-cubic", &[]);
    let integrated = shared::preset("nominal-cubic", &["run.recurrence=false"]);
    let kept = Request { events: true, ..Request::default() };
    let mut rows = Vec::new();
    for (name, model) in
        [("P1, no stops", free), ("P2, stops", stopped), ("P2, integrated to its end", integrated)]
    {
        let exact = model.run_reference(&kept, REFERENCE);
        for tolerance in TOLERANCES {
            let model = model.with_tolerance(tolerance);
            let run = model.run(&kept);
            let error = match name {
                "P1, no stops" => (run.summary.final_x - exact.summary.final_x).abs() / WELL,
                _ => late(&model, &run, &exact).max(relative(&run.summary, &exact.summary)),
            };
            let row = format!("| {name} | {tolerance:.0e} | {error:.1e} | | {} |", run.summary.steps);
            rows.push((row, model, Vec::new(), Vec::new()));
        }
    }
    for round in 0..shared::rounds(RUNS) {
        for (_, model, alone, together) in &mut rows {
            alone.push(model.run(&Request::default()).summary.cpu_s);
            if round % TOGETHER == 0 {
                let many = vec![model.clone(); TOGETHER];
                together.push(Model::run_together(&many, &Request::default())[0].summary.cpu_s);
            }
        }
    }
    for (row, _, alone, together) in &mut rows {
        println!("{row} {:.0} us | {:.0} us |", shared::median(alone) * 1e6, shared::median(together) * 1e6);
    }
}

/// The worst time error of the impacts above 1 cm/s, in forcing periods; infinite where one is missing.
fn late(model: &Model, run: &Run, exact: &Run) -> f64 {
    let times = |run: &Run| -> Vec<f64> {
        let hard = |e: &&Event| e.kind == EventKind::Impact && e.v_in.abs() > 1e-2;
        run.events.iter().filter(hard).map(|e| e.t).collect()
    };
    let (mine, exact) = (times(run), times(exact));
    if mine.len() != exact.len() {
        return f64::INFINITY;
    }
    let period = model.forcing_period().unwrap();
    mine.iter().zip(&exact).map(|(a, b)| (a - b).abs() / period).fold(0.0, f64::max)
}

fn relative(summary: &Summary, exact: &Summary) -> f64 {
    (summary.rms_velocity.unwrap() / exact.rms_velocity.unwrap() - 1.0).abs()
}

fn map() {
    let mut models = cells(&shared::changed("nominal-cubic", &[]));
    if !shared::is_measured() {
        models = models.into_iter().step_by(97).collect();
    }
    let mut at = |tolerance: f64| -> Vec<Summary> {
        models.iter_mut().for_each(|model| *model = model.with_tolerance(tolerance));
        models
            .chunks(TOGETHER)
            .flat_map(|many| Model::run_together(many, &Request::default()))
            .map(|run| run.summary)
            .collect()
    };
    let exact = at(MAP_REFERENCE);
    let mut maps: Vec<Vec<Vec<Summary>>> = TOLERANCES.map(|_| Vec::new()).into();
    for _ in 0..shared::rounds(MAPS) {
        for (tolerance, maps) in TOLERANCES.iter().zip(&mut maps) {
            maps.push(at(*tolerance));
        }
    }
    for (tolerance, maps) in TOLERANCES.iter().zip(&maps) {
        let errors = |counts: fn(Regime) -> bool| -> Vec<f64> {
            let cells = maps[0].iter().zip(&exact).filter(|cell| counts(cell.1.regime));
            cells.map(|(cell, exact)| relative(cell, exact)).collect()
        };
        let middle = shared::median(&mut errors(|regime| regime != Regime::Rest));
        let most =
            shared::quantile(&mut errors(|regime| !matches!(regime, Regime::Rest | Regime::Irregular)), 0.99);
        let steps: u64 = maps[0].iter().map(|cell| cell.steps).sum();
        // the median of each cell by itself, so that a pause in one map does not count
        let cpu: f64 = (0..exact.len())
            .map(|i| shared::median(&mut maps.iter().map(|map| map[i].cpu_s).collect::<Vec<f64>>()))
            .sum();
        println!("| P3, map | {tolerance:.0e} | {middle:.1e} | {most:.1e} | {steps} | | {cpu:.2} s |");
    }
}

/// The cells of a scene's own sweep.
fn cells(document: &Document) -> Vec<Model> {
    let grid = Grid::new(document.axes::<&str>(&[]).unwrap()).unwrap();
    let mechanism =
        interwell::mechanics::Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
    let mechanism = std::sync::Arc::new(mechanism);
    let mut scene = document.scene.clone();
    let cell = |index| {
        grid.apply(index, &mut scene);
        Model::build(&scene, mechanism.clone()).unwrap()
    };
    (0..grid.cells()).map(cell).collect()
}
