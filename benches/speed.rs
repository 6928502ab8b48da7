//! Where the time goes, as the tables of docs/speed.md: `cargo bench --bench speed`.
//!
//! The flexure preset's work against precision; how time grows with duration, impacts and the size of a map;
//! what a step costs against what the processor can do; and what each measure saves, switched off one by one.

mod shared;

use std::hint::black_box;

use interwell::dynamics::{Model, Request};
use interwell::scene::Document;
use interwell_studies::study::Grid;
use pulp::{Arch, Simd, WithSimd};

/// Runs that a sweep hands to one thread at a time.
const TOGETHER: usize = 128;

/// Tolerance of the runs in some 31 digits.
const REFERENCE: f64 = 1e-27;

/// Rounds of which each figure is the median.
const ROUNDS: usize = 9;

fn main() {
    flexures();
    against_the_cubic();
    duration();
    impacts();
    map_size();
    step();
    measures();
    compliant();
}

/// CPU time in s of a run alone, and of one in a batch, medians.
fn alone_and_together(model: &Model) -> (f64, f64) {
    let many = vec![model.clone(); TOGETHER];
    let (mut alone, mut together) = (Vec::new(), Vec::new());
    for _ in 0..shared::rounds(ROUNDS) {
        let some = &many[..8];
        alone.push(
            shared::cpu(|| some.iter().map(|each| each.run(&Request::default()).summary.steps).sum::<u64>())
                / 8.0,
        );
        together.push(shared::cpu(|| Model::run_together(&many, &Request::default())) / TOGETHER as f64);
    }
    (shared::median(&mut alone), shared::median(&mut together))
}

/// CPU time in s of some models, in a batch or each alone, the median.
fn cpu_of(models: &[Model], together: bool) -> f64 {
    let mut all = Vec::new();
    for _ in 0..shared::rounds(3) {
        all.push(match together {
            true => shared::cpu(|| {
                models
                    .chunks(TOGETHER)
                    .map(|some| Model::run_together(some, &Request::default()).len())
                    .sum::<usize>()
            }),
            false => shared::cpu(|| {
                models.iter().map(|model| model.run(&Request::default()).summary.steps).sum::<u64>()
            }),
        });
    }
    shared::median(&mut all)
}

/// The cells of a scene over as many travel limits, as far as its own map goes, and amplitudes.
fn cells(document: &Document, (limits, amplitudes): (usize, usize)) -> Vec<Model> {
    let mechanism =
        interwell::mechanics::Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
    let mechanism = std::sync::Arc::new(mechanism);
    let mut scene = document.scene.clone();
    let grid = grid(document, (limits, amplitudes));
    let cell = |index| {
        grid.apply(index, &mut scene);
        Model::build(&scene, mechanism.clone()).unwrap()
    };
    let all: Vec<Model> = (0..grid.cells()).map(cell).collect();
    if shared::is_measured() { all } else { all.into_iter().step_by(97).collect() }
}

fn grid(document: &Document, (limits, amplitudes): (usize, usize)) -> Grid {
    let axis = |field: &str, from: f64, to: f64, count: usize| match count {
        1 => format!("{field}={from}"),
        _ => format!("{field}={from}:{to}:{}", (to - from) / (count - 1) as f64),
    };
    let widest = if document.name.contains("cubic") { 8.0 } else { 6.5 };
    let mut axes = vec![axis("excitation.amplitude_g", 0.0, 2.0, amplitudes)];
    if limits > 0 {
        axes.insert(0, axis("stops.travel_limit_mm", 0.5, widest, limits));
    }
    Grid::new(document.axes(&axes).unwrap()).unwrap()
}

fn flexures() {
    println!("\n| `paper` | tolerance | error | steps | CPU | batched |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for (name, changes) in [
        ("without stops, 1 g", &["stops=None", "excitation.amplitude_g=1"][..]),
        ("stops, its cycle comes back", &[]),
        ("stops, integrated to its end", &["run.recurrence=false"]),
    ] {
        let model = shared::preset("paper", changes);
        let exact = model.run_reference(&Request::default(), REFERENCE).summary.rms_velocity.unwrap();
        for tolerance in [1e-3, 1e-6, 1e-9, 1e-12] {
            let tried = model.with_tolerance(tolerance);
            let run = tried.run(&Request::default()).summary;
            let error = (run.rms_velocity.unwrap() / exact - 1.0).abs();
            let (alone, together) = alone_and_together(&tried);
            let (alone, together) = (alone * 1e6, together * 1e6);
            println!(
                "| {name} | {tolerance:.0e} | {error:.1e} | {} | {alone:.0} us | {together:.0} us |",
                run.steps
            );
        }
    }
}

/// Runs of the flexures beside the same of the cubic of their span, without stops.
fn against_the_cubic() {
    println!("\n| without stops, at 1e-6 | cubic, a run | flexures, a run | ratio |");
    println!("| --- | --- | --- | --- |");
    let names = ["nominal-cubic", "paper"];
    let at = |name: &str, amplitude: f64| {
        let amplitude = format!("excitation.amplitude_g={amplitude}");
        shared::preset(name, &["stops=None", "run.tolerance=1e-6", &amplitude])
    };
    let one = names.map(|name| alone_and_together(&at(name, 1.1)));
    let unlike = names.map(|name| {
        let all: Vec<Model> = (0..shared::rounds(2001)).map(|i| at(name, 1.1 + 1e-6 * i as f64)).collect();
        cpu_of(&all, true) / all.len() as f64
    });
    for (what, [cubic, flexures]) in [
        ("1.1 g, alone", one.map(|costs| costs.0)),
        ("1.1 g, among 128 like it", one.map(|costs| costs.1)),
        ("2001 from 1.1 to 1.102 g, batched", unlike),
    ] {
        println!("| {what} | {:.0} us | {:.0} us | {:.1} |", cubic * 1e6, flexures * 1e6, flexures / cubic);
    }
}

fn duration() {
    println!("\n| duration | P1, no stops, batched | P2, its cycle comes back | P2, integrated |");
    println!("| --- | --- | --- | --- |");
    for seconds in ["1", "10", "100", "1000"] {
        let (duration, settle) = (format!("run.duration_s={seconds}"), format!("run.settle_s={seconds}e-1"));
        let at = |changes: &[&str]| {
            let changes = [changes, &["run.tolerance=1e-6", &duration, &settle]].concat();
            shared::preset("nominal-cubic", &changes)
        };
        let (_, free) = alone_and_together(&at(&["stops=None", "excitation.amplitude_g=1.1"]));
        let (closed, _) = alone_and_together(&at(&[]));
        let (integrated, _) = alone_and_together(&at(&["run.recurrence=false"]));
        println!(
            "| {seconds} s | {:.0} us | {:.0} us | {:.0} us |",
            free * 1e6,
            closed * 1e6,
            integrated * 1e6
        );
    }
}

fn impacts() {
    println!("\n| restitution | impacts | steps | CPU | a step |");
    println!("| --- | --- | --- | --- | --- |");
    for restitution in ["0", "0.2", "0.36", "0.5", "0.6"] {
        let change = format!("stops.restitution={restitution}");
        let model = shared::preset("nominal-cubic", &[&change, "run.tolerance=1e-6", "run.recurrence=false"]);
        let run = model.run(&Request::default()).summary;
        let (alone, _) = alone_and_together(&model);
        let (cpu, step) = (alone * 1e6, alone * 1e9 / run.steps as f64);
        println!("| {restitution} | {} | {} | {cpu:.0} us | {step:.0} ns |", run.total_impacts, run.steps);
    }
}

fn map_size() {
    println!("\n| map | cells | with stops | a cell | without stops | a cell |");
    println!("| --- | --- | --- | --- | --- | --- |");
    let stopped = shared::changed("nominal-cubic", &["run.tolerance=1e-6"]);
    let free = shared::changed("nominal-cubic", &["run.tolerance=1e-6", "stops=None"]);
    for (limits, amplitudes) in [(6, 11), (21, 51), (41, 101), (81, 201)] {
        let with = cells(&stopped, (limits, amplitudes));
        let without = cells(&free, (0, amplitudes));
        let (stops, none) = (cpu_of(&with, true), cpu_of(&without, true));
        println!(
            "| {limits} x {amplitudes} | {} | {:.3} s | {:.1} us | {:.4} s ({amplitudes} cells) | {:.0} us |",
            with.len(),
            stops,
            stops / with.len() as f64 * 1e6,
            none,
            none / without.len() as f64 * 1e6
        );
    }
}

/// Products and sums as fast as the processor does them, in sixteen independent chains.
struct Peak {
    rounds: usize,
}

impl WithSimd for Peak {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> usize {
        let factor = simd.splat_f64s(black_box(0.999_999));
        let term = simd.splat_f64s(black_box(1e-6));
        let mut chains = [simd.splat_f64s(black_box(1.0)); 16];
        for _ in 0..self.rounds {
            for chain in &mut chains {
                *chain = simd.add_f64s(simd.mul_f64s(*chain, factor), term);
            }
        }
        black_box(chains);
        size_of::<S::f64s>() / size_of::<f64>()
    }
}

/// Products and sums of a step of order `order` under an odd cubic: its series, state and check.
fn operations(order: usize) -> usize {
    let series: usize = (0..order - 1).map(|k| 2 * (k.div_ceil(2) + 1) + 2 * (k + 1) + 10).sum();
    series + 8 * order + 80
}

fn step() {
    println!("\n| P1 | order | a step alone | batched | operations | alone | batched |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    let rounds = if shared::is_measured() { 2_000_000 } else { 10 };
    let peak = |simd: bool| {
        let mut all: Vec<f64> = (0..shared::rounds(5))
            .map(|_| {
                let mut width = 1;
                let arch = if simd { Arch::new() } else { Arch::Scalar };
                let time = shared::cpu(|| width = arch.dispatch(Peak { rounds }));
                time / (rounds * 16 * 2 * width) as f64
            })
            .collect();
        1.0 / shared::median(&mut all)
    };
    let (scalar, wide) = (peak(false), peak(true));
    for (tolerance, order) in [("1e-3", 9), ("1e-6", 13), ("1e-9", 16), ("1e-12", 20)] {
        let tolerance = format!("run.tolerance={tolerance}");
        let model =
            shared::preset("nominal-cubic", &["stops=None", "excitation.amplitude_g=1.1", &tolerance]);
        let steps = model.run(&Request::default()).summary.steps as f64;
        let (alone, together) = alone_and_together(&model);
        let work = operations(order) as f64;
        println!(
            "| {tolerance} | {order} | {:.0} ns | {:.0} ns | {work} | {:.0} % of the peak | \
             {:.0} % of the peak |",
            alone / steps * 1e9,
            together / steps * 1e9,
            100.0 * work * steps / alone / scalar,
            100.0 * work * steps / together / wide
        );
    }
    println!(
        "\nPeak: {:.1} G products and sums of doubles a second one at a time, \
         {:.0} G in the widest registers.",
        scalar * 1e-9,
        wide * 1e-9
    );
}

fn measures() {
    println!("\n| at 1e-6 | as it is | without batches | without recurrence | without both |");
    println!("| --- | --- | --- | --- | --- |");
    let rows = [
        ("201 cells without stops", "nominal-cubic", &["stops=None", "run.tolerance=1e-6"][..], (0, 201)),
        ("P3, 41 x 101 cells", "nominal-cubic", &["run.tolerance=1e-6"], (41, 101)),
        ("`paper`, 41 x 101 cells", "paper", &["run.tolerance=1e-6"], (41, 101)),
    ];
    for (name, scene, changes, size) in rows {
        let on = cells(&shared::changed(scene, changes), size);
        let mut off = on.clone();
        off.iter_mut().for_each(|model| *model = model.with_recurrence(false));
        let all = [cpu_of(&on, true), cpu_of(&on, false), cpu_of(&off, true), cpu_of(&off, false)];
        let text: Vec<String> =
            all.iter().map(|time| format!("{time:.3} s ({:.1})", time / all[0])).collect();
        println!("| {name} | {} |", text.join(" | "));
    }
}

/// A map of the prototype on compliant stops of aluminium against the same on rigid ones, integrated.
fn compliant() {
    println!("\n| `paper`, 7 x 11 cells | tolerance | rigid, integrated | compliant | steps | ratio |");
    println!("| --- | --- | --- | --- | --- | --- |");
    let stops = "stops=Hertz(travel_limit_mm: 1.5, radius_mm: 5, young_gpa: 69, loss_s_per_m: 4.854)";
    for tolerance in ["1e-3", "1e-6", "1e-9"] {
        let change = format!("run.tolerance={tolerance}");
        let of =
            |changes: &[&str]| cells(&shared::changed("paper", &[changes, &[&change]].concat()), (7, 11));
        let (rigid, compliant) = (of(&["run.recurrence=false"]), of(&[stops]));
        let runs = |models: &[Model]| {
            let run = |model: &Model| model.run(&Request::default()).summary;
            models.iter().map(run).collect::<Vec<_>>()
        };
        let moves: Vec<bool> = runs(&compliant).iter().map(|run| run.regime.name() != "rest").collect();
        for moving in [true, false] {
            let some = |models: &[Model]| {
                let chosen = models.iter().zip(&moves).filter(|(_, moves)| **moves == moving);
                chosen.map(|(model, _)| model.clone()).collect::<Vec<_>>()
            };
            let (rigid, compliant) = (some(&rigid), some(&compliant));
            let steps: u64 = runs(&compliant).iter().map(|run| run.steps).sum();
            let (hard, soft, ratio) =
                shared::compare(shared::rounds(5), || runs(&rigid), || runs(&compliant));
            let a_cell = |time: f64| time / compliant.len().max(1) as f64 * 1e3;
            println!(
                "| {} that {} | {tolerance} | {:.3} ms a cell | {:.2} ms | {} | {ratio:.0} |",
                compliant.len(),
                if moving { "move" } else { "rest" },
                a_cell(hard),
                a_cell(soft),
                steps / compliant.len().max(1) as u64
            );
        }
    }
}
