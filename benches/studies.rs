//! Time and error of the studies: `cargo bench --bench studies`.
//!
//! A row a study. The error is against an answer that is known in closed form, or another run of the study,
//! named beside it; the time is that of one thread. Then two threads beside one, of a second or more of work.

mod shared;

use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

use interwell::dynamics::STANDARD_GRAVITY;
use interwell::questions::{Progress, Simulation, Threshold};
use interwell::system::threads::Pool;
use interwell_studies::study::{
    Answer, BasinMap, BranchAnswer, BranchEvent, BranchOptions, Carry, EvenRange, ExponentOptions, Family,
    Grid, Onset, OrbitAnswer, Scan, SectionAt, SectionOptions, Sections, Signal, SpectrumOptions, Starts,
    Sweep, SweepOptions, Table, Task, branch, check_lesson, exponents, result_fields, spectrum, threshold,
};

/// Times that each study is done.
const ROUNDS: usize = 21;

fn main() {
    println!("| study | problem | error | against | CPU |");
    println!("| --- | --- | --- | --- | --- |");
    spectra();
    thresholds();
    branches();
    growth();
    diagrams();
    maps();
    jobs();
}

/// Does `study`, which gives its error, several times, and prints its row.
fn row(study: &str, problem: &str, against: &str, mut work: impl FnMut() -> f64) {
    let mut error = 0.0;
    let rounds = shared::rounds(ROUNDS);
    let mut times: Vec<f64> = (0..rounds).map(|_| shared::cpu_of_all(|| error = work())).collect();
    let us = shared::median(&mut times) * 1e6;
    println!("| {study} | {problem} | {error:.1e} | {against} | {us:.1} us |");
}

fn spectra() {
    let never = AtomicBool::new(false);
    let task = Task { tick: &|| (), cancel: &never };
    let plain =
        SpectrumOptions { signal: Signal::Displacement, taper: None, rate_hz: None, until_settled: None };
    // a linear spring whose transient has died at 10 s
    let changes =
        ["mechanism.cubic_n_per_m3=0", "damping=Coefficient(c_n_s_per_m: 0.2)", "run.tolerance=1e-13"];
    let linear = shared::preset("monostable", &changes);
    let (k, m, c, w) = (40.0, linear.mass(), linear.damping(), TAU * 3.0);
    let exact = m * STANDARD_GRAVITY / (k - m * w * w).hypot(c * w);
    row("spectrum", "linear spring, 30 periods", "its response", || {
        let found = spectrum(&linear, &plain, &task).unwrap();
        let table = found.table();
        let amplitude = table.numbers("amplitude").unwrap();
        amplitude.iter().enumerate().fold(0.0, |worst: f64, (line, height)| {
            let exact_here = if line == 30 { exact } else { 0.0 };
            worst.max((height - exact_here).abs() / exact)
        })
    });
    let chaos = shared::preset("duffing-chaos", &[]);
    let rms = chaos.run(&interwell::dynamics::Request::default()).summary.rms_velocity.unwrap();
    row("spectrum", "`duffing-chaos`, 900 periods", "RMS velocity (no taper)", || {
        let options = SpectrumOptions {
            signal: Signal::Velocity,
            taper: Some(interwell::numeric::Taper::None),
            ..plain
        };
        let found = spectrum(&chaos, &options, &task).unwrap();
        let table = found.table();
        let (frequency, density) = (table.numbers("frequency_hz").unwrap(), table.numbers("psd").unwrap());
        ((density.iter().sum::<f64>() * frequency[1]).sqrt() / rms - 1.0).abs()
    });
}

fn thresholds() {
    let never = AtomicBool::new(false);
    let task = Task { tick: &|| (), cancel: &never };
    let document = shared::changed("nominal-cubic", &["excitation.amplitude_g=0.7"]);
    let mechanism =
        interwell::mechanics::Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
    let mechanism = std::sync::Arc::new(mechanism);
    let press = -mechanism.curve.force(4e-3);
    let found = |problem: &str, against: &str, scan: Scan, exact: f64| {
        row("threshold", problem, against, || {
            let found = threshold(&document.scene, &mechanism, &document.files, &scan, Onset::Release, &task)
                .unwrap();
            (found.value.unwrap() / exact - 1.0).abs()
        });
    };
    let even = |from: f64, step: f64| (0..=200).map(|i| from + step * f64::from(i)).collect::<Vec<f64>>();
    let scan = Scan {
        field: "excitation.amplitude_g".into(),
        values: even(0.0, 0.01),
        resolution: 1e-5,
        until_settled: None,
    };
    let exact = press / document.scene.mass_g * 1e3 / STANDARD_GRAVITY;
    found("release over the amplitude, a formula", "force over weight", scan, exact);
    // over the mass it is searched for
    let scan =
        Scan { field: "mass_g".into(), values: even(10.0, 0.05), resolution: 1e-9, until_settled: None };
    found(
        "release over the mass, 200 steps to 1e-9 g",
        "force over acceleration",
        scan,
        press / (0.7 * STANDARD_GRAVITY) * 1e3,
    );
}

fn branches() {
    let never = AtomicBool::new(false);
    let task = Task { tick: &|| (), cancel: &never };
    let over = |name: &str, (from, to): (f64, f64), of: &dyn Fn(&BranchAnswer) -> f64| {
        let document = shared::changed(name, &[]);
        let mechanism =
            interwell::mechanics::Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
        let mechanism = std::sync::Arc::new(mechanism);
        let field = "excitation.amplitude_g";
        let family = Family::new(&document.scene, &document.files, &mechanism, field);
        of(&branch(&family, field, (from, to), &BranchOptions::new(0.0, Some(1)), &task).unwrap())
    };
    // the swing of the linear spring whose amplitude is the distance of the stop, 1 m
    let (w, c) = (0.7_f64, 0.2);
    let grazing = (1.0 - w * w).hypot(c * w) / STANDARD_GRAVITY;
    row("orbit --branch", "`impact-oscillator`, 166 motions past a grazing", "the grazing", || {
        over("impact-oscillator", (0.05, 0.06), &|found| {
            let at = found.events.iter().position(|event| *event == Some(BranchEvent::Grazing)).unwrap();
            (found.values[at] / grazing - 1.0).abs()
        })
    });
    row("orbit --branch", "`duffing`, 0.1 to 1 g, 195 motions", "the product of the multipliers", || {
        over("duffing", (0.1, 1.0), &|found| {
            let of = |orbit: &OrbitAnswer| (orbit.jacobian.determinant() / orbit.determinant() - 1.0).abs();
            found.orbits.iter().map(of).fold(0.0, f64::max)
        })
    });
}

fn growth() {
    let never = AtomicBool::new(false);
    let chaos = shared::preset("duffing-chaos", &[]);
    let options = ExponentOptions::default();
    row("exponents", "`duffing-chaos`, 1000 periods", "the sum of both", || {
        let found = exponents(&chaos, &options, &never).unwrap();
        (found.sum / found.exact_sum.unwrap() - 1.0).abs()
    });
}

/// The states of 100 forcing periods after 200, at 90 degrees, over 400 amplitudes.
fn diagram(name: &str, changes: &[&str]) -> Table {
    sections(name, changes, &Pool::new(1).unwrap())
}

fn sections(name: &str, changes: &[&str], pool: &Pool) -> Table {
    let document = shared::changed(name, changes);
    let axes = document.axes(&["excitation.amplitude_g=0.6025:1.6:0.0025"]).unwrap();
    let options = SectionOptions {
        at: SectionAt::Phase(90.0),
        periods: Some((200, 100)),
        until_settled: None,
        carry: None,
    };
    let grid = Grid::new(axes).unwrap();
    let sections = Sections::new(&document.scene, &document.files, grid).with(options);
    let never = AtomicBool::new(false);
    let task = Task { tick: &|| (), cancel: &never };
    let mut all = Table::new();
    let write = |table: &Table| {
        all.append(table);
        Ok::<_, ()>(true)
    };
    sections.run(pool, &task, write).unwrap();
    all
}

fn diagrams() {
    let changes =
        ["mechanism.cubic_n_per_m3=0", "damping=Coefficient(c_n_s_per_m: 0.2)", "run.tolerance=1e-13"];
    let linear = shared::preset("monostable", &changes);
    let (k, m, c, w) = (40.0, linear.mass(), linear.damping(), TAU * 3.0);
    let (re, im) = (k - m * w * w, c * w);
    // -m A sin(w t) of the base, at a quarter of the period
    let exact = -m * STANDARD_GRAVITY * re / (re * re + im * im);
    let problem = "linear spring, 400 amplitudes of 300 periods";
    row("section --over", problem, "its response", || {
        let table = diagram("monostable", &changes);
        let rows = table.numbers("amplitude_g").unwrap().iter().zip(table.numbers("x_m").unwrap());
        rows.fold(0.0, |worst: f64, (g, x)| worst.max((x / (exact * g) - 1.0).abs()))
    });
    let far = |a: &Table, b: &Table| {
        let [a, b] = [a, b].map(|table| table.numbers("x_m").unwrap());
        a.iter().zip(b).fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs() / 1.5e-3))
    };
    let fine = diagram("paper", &["run.tolerance=1e-13"]);
    row("section --over", "`paper`, 400 amplitudes of 300 periods", "the same at 1e-13", || {
        far(&diagram("paper", &[]), &fine)
    });
}

/// The map of so many starts each way within the stops.
fn basins(tolerance: &str, count: u64, pool: &Pool) -> Answer {
    let document = shared::changed("paper", &["excitation.amplitude_g=0.7", tolerance]);
    let mechanism = shared::mechanism(&document);
    let range = |end: f64| EvenRange { from: -end, to: end, count };
    let starts = Starts::grid(&range(1.5), &range(0.5)).unwrap();
    let mut basins = BasinMap::new(&document.scene, mechanism, starts).unwrap();
    let never = AtomicBool::new(false);
    let task = Task { tick: &|| (), cancel: &never };
    while !basins.is_whole() {
        basins.run_level(pool, &task);
    }
    basins.answer(&task).unwrap()
}

fn maps() {
    let one = Pool::new(1).unwrap();
    let fine = basins("run.tolerance=1e-13", 200, &one);
    row("basins", "`paper` at 0.7 g, 40 000 starts", "the share of others at 1e-13", || {
        let coarse = basins("run.tolerance=1e-9", 200, &one);
        let to = |answer: &Answer, row: usize| answer.rows[row].map(|end| end.0);
        let others = (0..coarse.rows.len()).filter(|row| to(&coarse, *row) != to(&fine, *row)).count();
        others as f64 / coarse.rows.len() as f64
    });
}

/// Rounds of which each figure on jobs is the median.
const JOBS_ROUNDS: usize = 5;

/// A sweep over these axes; walked where `carry` says so.
fn sweep(name: &str, changes: &[&str], axes: &[&str], carry: Option<Carry>, pool: &Pool) {
    let document = shared::changed(name, changes);
    let grid = Grid::new(document.axes(axes).unwrap()).unwrap();
    let options = SweepOptions { carry, ..SweepOptions::default() };
    let sweep = Sweep::new(&document.scene, &document.files, grid).with(options);
    let never = AtomicBool::new(false);
    sweep.run::<()>(pool, &Task { tick: &|| (), cancel: &never }, |_| Ok(true)).unwrap();
}

fn threshold_of(pool: &Pool) {
    let simulation = Simulation::new(&shared::changed("paper-unconstrained", &[])).unwrap();
    let field = Some("excitation.amplitude_g=0.01:2:0.01".to_owned());
    let (of, resolution) = (Onset::Interwell, Some(1e-5));
    let study = Threshold { field, of, resolution, ..Threshold::default() };
    study.run(&simulation, &Progress::none().threads(pool.count())).unwrap();
}

fn lessons(pool: &Pool) {
    let all = interwell::scene::lesson::LESSONS;
    let load = |name: &str| interwell::scene::lesson::LessonDocument::load(name, &result_fields()).unwrap();
    let documents: Vec<_> = all.iter().map(|lesson| load(lesson.name)).collect();
    let never = AtomicBool::new(false);
    let task = Task { tick: &|| (), cancel: &never };
    let check = |number: usize| check_lesson(&documents[number], Some(pool), &task);
    pool.map(documents.len(), check).unwrap();
}

/// Wall time, since that is what jobs are for, and beside it without the waits for a processor that others
/// use.
fn jobs() {
    println!("\n| two jobs beside one | one | two | ratio | ratio without waits |");
    println!("| --- | --- | --- | --- | --- |");
    type Work = (&'static str, Box<dyn Fn(&Pool)>);
    let amplitudes = "excitation.amplitude_g=0:2:0.005";
    let limits = "stops.travel_limit_mm=0.5:8:0.05";
    let studies: Vec<Work> = vec![
        (
            "P3 of 151 x 401 cells",
            Box::new(move |pool| {
                sweep("nominal-cubic", &["run.tolerance=1e-6"], &[limits, amplitudes], None, pool);
            }),
        ),
        (
            "`paper-unconstrained`, 401 cells",
            Box::new(move |pool| sweep("paper-unconstrained", &[], &[amplitudes], None, pool)),
        ),
        (
            "the same, up and down",
            Box::new(move |pool| sweep("paper-unconstrained", &[], &[amplitudes], Some(Carry::Both), pool)),
        ),
        (
            "`section --over`, `paper-unconstrained`",
            Box::new(|pool| drop(sections("paper-unconstrained", &[], pool))),
        ),
        ("`basins`, `paper`, 10^6 starts", Box::new(|pool| drop(basins("run.tolerance=1e-9", 1000, pool)))),
        ("`threshold`, `paper-unconstrained`", Box::new(threshold_of)),
        ("`lesson --check`", Box::new(lessons)),
    ];
    let pools = [1, 2].map(|count| Pool::new(count).unwrap());
    for (name, work) in studies.iter().filter(|_| shared::is_measured()) {
        let mut times: [(Vec<f64>, Vec<f64>); 2] = Default::default();
        for _ in 0..JOBS_ROUNDS {
            for (pool, spent) in pools.iter().zip(&mut times) {
                let (wall, run) = shared::wall(|| work(pool));
                spent.0.push(wall);
                spent.1.push(run);
            }
        }
        let [one, two] =
            times.map(|(mut wall, mut run)| [shared::median(&mut wall), shared::median(&mut run)]);
        let (ratio, without) = (one[0] / two[0], one[1] / two[1]);
        println!("| {name} | {:.2} s | {:.2} s | {ratio:.2} | {without:.2} |", one[0], two[0]);
    }
}
