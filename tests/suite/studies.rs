//! Studies: cells of a sweep, order of samples, cancelling, words about damping.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use interwell::dynamics::{Model, Request};
use interwell::mechanics::{ForceCurve, Mechanism, Piece};
use interwell::scene::{Document, Files};
use interwell::system::threads::Pool;
use interwell_studies::study::*;

fn model(document: &Document) -> Model {
    let mechanism = Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
    Model::build(&document.scene, Arc::new(mechanism)).unwrap()
}

fn pool(threads: usize) -> Pool {
    Pool::new(threads).unwrap()
}

fn sweep(over: &[&str]) -> Sweep {
    let mut document = Document::load("nominal-cubic").unwrap();
    document.set("run.duration_s=2").unwrap();
    document.set("run.settle_s=1").unwrap();
    let grid = Grid::new(document.axes(over).unwrap()).unwrap();
    Sweep::new(&document.scene, &document.files, grid)
}

const OVER: [&str; 2] = ["stops.travel_limit_mm=1,3,5", "excitation.amplitude_g=0:2:0.5"];

#[test]
fn a_cell_is_the_run_of_its_scene() {
    let cancel = AtomicBool::new(false);
    let ticks = AtomicU64::new(0);
    let tick = || {
        ticks.fetch_add(1, Ordering::Relaxed);
    };
    let task = Task { tick: &tick, cancel: &cancel };
    let sweep = sweep(&OVER);
    sweep.validate(&pool(2), &task).unwrap();
    let mut rows = Vec::new();
    let write = |table: &Table| {
        let limits = table.numbers("travel_limit_mm").unwrap();
        let amplitudes = table.numbers("amplitude_g").unwrap();
        let rms = table.numbers("rms_velocity_m_per_s").unwrap();
        rows.extend((0..table.rows()).map(|i| (limits[i], amplitudes[i], rms[i])));
        Ok::<_, ()>(true)
    };
    let tally = sweep.run(&pool(2), &task, write).unwrap();
    assert_eq!((tally.cells, tally.ended_early, ticks.into_inner()), (15, 0, 15));
    let mut expected = Vec::new();
    for limit in [1.0, 3.0, 5.0] {
        for amplitude in [0.0, 0.5, 1.0, 1.5, 2.0] {
            let mut document = Document::load("nominal-cubic").unwrap();
            for set in ["run.duration_s=2", "run.settle_s=1"] {
                document.set(set).unwrap();
            }
            document.set(&format!("stops.travel_limit_mm={limit}")).unwrap();
            document.set(&format!("excitation.amplitude_g={amplitude}")).unwrap();
            let summary = model(&document).run(&Request::default()).summary;
            expected.push((limit, amplitude, summary.rms_velocity.unwrap()));
        }
    }
    assert_eq!(rows, expected);
}

#[test]
fn a_sweep_stops_when_told() {
    let cancel = AtomicBool::new(false);
    let stop = || cancel.store(true, Ordering::Relaxed);
    let task = Task { tick: &stop, cancel: &cancel };
    let result = sweep(&OVER).run(&pool(1), &task, |_| Ok::<_, ()>(true));
    assert!(matches!(result, Err(SweepEnd::Cancelled)));

    let never = AtomicBool::new(false);
    let task = Task { tick: &|| {}, cancel: &never };
    let long = sweep(&["excitation.amplitude_g=0:1:0.001", "run.duration_s=1:2:0.5"]);
    let unwanted = long.run(&pool(1), &task, |_| Ok::<_, ()>(false)).unwrap();
    assert!(unwanted.cells < long.grid().cells());
    let failing = long.run(&pool(1), &task, |_| Err("full"));
    assert!(matches!(failing, Err(SweepEnd::Write("full"))));
}

#[test]
fn the_first_wrong_cell_is_named() {
    let never = AtomicBool::new(false);
    let task = Task { tick: &|| {}, cancel: &never };
    let sweep = sweep(&["mechanism.linear_n_per_m=-40,40", "mechanism.cubic_n_per_m3=1e5,-1e5,-2e5,1e6"]);
    for threads in [1, 2, 3] {
        let wrong = sweep.validate(&pool(threads), &task).unwrap_err();
        assert_eq!(wrong.cell, "linear_n_per_m = -40, cubic_n_per_m3 = -100000");
        assert!(!wrong.faults.is_empty());
    }
}

#[test]
fn samples_keep_the_order_of_their_times() {
    let model = model(&Document::load("paper").unwrap());
    let times = vec![3.0, 0.25, 10.0, 0.0, 0.25];
    let keep = |times: &[f64]| Keep { times: times.to_vec(), events: false, until_settled: None };
    let shuffled = simulate(&model, &keep(&times), None);
    let ascending = simulate(&model, &keep(&[0.0, 0.25, 3.0, 10.0]), None);
    assert_eq!(shuffled.samples.numbers("t_s").unwrap(), times);
    let (a, b) = (shuffled.samples.numbers("x_m").unwrap(), ascending.samples.numbers("x_m").unwrap());
    assert_eq!(a, [b[2], b[1], b[3], b[0], b[1]]);
    assert_eq!(shuffled.events.rows(), 0);
}

#[test]
fn default_samples_follow_the_drive() {
    let count = |set: &[&str]| {
        let mut document = Document::load("paper").unwrap();
        set.iter().for_each(|set| document.set(set).unwrap());
        sample_times(&document.scene, &model(&document), &Sampling::Default, None).unwrap().len()
    };
    assert_eq!(count(&[]), 1801);
    assert_eq!(count(&["excitation=None"]), 1001);
    let two =
        "excitation=Sum([Sine(frequency_hz: 3, amplitude_g: 1), Sine(frequency_hz: 2, amplitude_g: 1)])";
    assert_eq!(count(&[two]), 601);
    assert_eq!(
        count(&[
            "excitation=AmplitudeRamp(frequency_hz: 3, from_g: 0, to_g: 1, over_s: 5)",
            "run.duration_s=1"
        ]),
        181
    );
}

/// The prototype with its flexures.
fn flexures() -> Document {
    let text = "(title: \"t\", mass_g: 15.2, damping: Ratio(0.023), stops: Rigid(travel_limit_mm: 1.5, \
        restitution: 0.36), \
        mechanism: Flexures(preload_mm: 2.7, thickness_mm: 0.1, young_gpa: 190, \
        parallel: (count: 2, length_mm: 26, width_mm: 20), buckling: (count: 1, length_mm: 27.7, \
        width_mm: 6.8)), \
        excitation: Sine(frequency_hz: 3, amplitude_g: 1), run: (duration_s: 0.2, settle_s: 0))";
    Document::from_text("t", text, Files::default()).unwrap()
}

#[test]
fn each_geometry_is_solved_once() {
    let document = flexures();
    let never = AtomicBool::new(false);
    let task = Task { tick: &|| {}, cancel: &never };
    for (over, geometries) in [
        (&["excitation.amplitude_g=0:1:0.25", "mechanism.preload_mm=2.5,2.7"][..], 2),
        (&["mechanism.preload_mm=2.5,2.7", "mass_g=15,16", "mechanism.parallel.length_mm=26,26.5"], 4),
        (&["mass_g=15,16,17"], 1),
    ] {
        let grid = Grid::new(document.axes(over).unwrap()).unwrap();
        let sweep = Sweep::new(&document.scene, &document.files, grid);
        sweep.first_mechanism().unwrap();
        sweep.validate(&pool(2), &task).unwrap();
        let tally = sweep.run(&pool(2), &task, |_| Ok::<_, ()>(true)).unwrap();
        assert_eq!((tally.cells, tally.mechanisms), (sweep.grid().cells(), geometries), "{over:?}");
    }
}

#[test]
fn a_damping_ratio_is_told_in_all_its_meanings() {
    // Slopes, kink and equilibrium of the prototype's beams in round numbers.
    let (kink, past, inner, outer) = (7.18e-3, 2e-6, 137.0, 4000.0);
    let force = -outer * past;
    let cubic = 0.5 * (inner - force / kink);
    let piece = |origin, coefficients| Piece { origin, coefficients, potential_at_origin: 0.0 };
    let right = piece(kink, vec![force, outer]);
    let middle = piece(0.0, vec![0.0, force / kink - cubic, 0.0, cubic / (kink * kink)]);
    let pieces = vec![right.mirrored(), middle, right];
    let curve = ForceCurve::from_pieces(pieces, vec![-kink, kink], (-8e-3, 8e-3), true, None).unwrap();
    let mut document = Document::load("paper").unwrap();
    document.set("damping=Ratio(0.023)").unwrap();
    let lines = inspected(&document, Mechanism::new(curve));
    let of = |beginning: &str| {
        let found: Vec<&String> = lines.iter().filter(|line| line.starts_with(beginning)).collect();
        assert_eq!(found.len(), 1, "{lines:?}");
        found[0].clone()
    };
    let first = of("damping ratio 0.023: ");
    for word in
        ["k = 137 N/m", "just inside the kink at 7.18 mm", "2 um", "c = 2 xi sqrt(k m) = 0.06638", "used"]
    {
        assert!(first.contains(word), "`{word}` is not in: {first}");
    }
    let second = of("the same ratio ");
    for word in ["4000 N/m", "c = 0.3587 N s/m", "25.5 Hz", "c = 0.112 N s/m"] {
        assert!(second.contains(word), "`{word}` is not in: {second}");
    }
    // One well-defined stiffness, one line.
    for name in ["paper-table", "nominal-cubic"] {
        let document = Document::load(name).unwrap();
        let mechanism = Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
        let lines = inspected(&document, mechanism);
        let ratio = lines.iter().filter(|line| line.contains("ratio ")).collect::<Vec<_>>();
        assert!(ratio.len() == 1 && !ratio[0].contains("kink"), "{ratio:?}");
    }
}

fn inspected(document: &Document, mechanism: Mechanism) -> Vec<String> {
    inspect(&document.scene, &Model::build(&document.scene, Arc::new(mechanism)).unwrap())
}

#[test]
fn flexures_are_told_in_words() {
    let document = flexures();
    let mechanism = Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
    let text = inspected(&document, mechanism).join("\n");
    for words in [
        "flexures: 2 parallel, 26 mm long and 20 mm wide; 1 buckling, 27.7 mm long and 6.8 mm wide; \
         all 0.1 mm thick",
        "preload 2.7 mm",
        "geometrically exact (Reissner)",
        "E = 190 GPa, Poisson's ratio 0.34",
        "against fresh solutions off by at most ",
        "force curve: ",
        "kinks, ",
        "stable equilibrium at ",
    ] {
        assert!(text.contains(words), "`{words}` is not in: {text}");
    }
}
