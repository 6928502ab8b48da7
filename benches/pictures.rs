//! CPU time and size of pictures: `cargo bench --bench pictures`.
//!
//! A row a picture and a kind of file: the layout of its chart, and its painting.

mod shared;

use std::sync::atomic::AtomicBool;

use interwell::output::{
    Caption, Chart, Format, Overlay, Ranges, RunPanel, SweepPicture, Theme, curve_chart, run_chart,
    sweep_chart,
};
use interwell::scene::Document;
use interwell::system::threads::Pool;
use interwell_studies::study::{
    CURVE_PICTURE_POINTS, Grid, Keep, Sampling, Sweep, SweepOptions, Table, Task, curve, default_positions,
    sample_times, simulate_with_trace,
};

/// Times that each picture is made.
const ROUNDS: usize = 15;

fn main() {
    let document = shared::changed("paper", &[]);
    let caption = Caption::new(&document, "bench");
    println!("| picture | layout | PNG | SVG | PDF |");
    println!("| --- | --- | --- | --- | --- |");
    for (name, chart) in [
        ("map of 41 x 101 cells", map(&document)),
        ("run of `paper`", run(&document)),
        ("force and potential", force(&document)),
    ] {
        row(name, &chart, &caption);
    }
}

/// Prints the row of a picture.
fn row(name: &str, chart: &Chart, caption: &Caption) {
    let rounds = shared::rounds(ROUNDS);
    let mut figure = chart.figure(caption, &Theme::LIGHT);
    let mut times: Vec<f64> =
        (0..rounds).map(|_| shared::cpu(|| figure = chart.figure(caption, &Theme::LIGHT))).collect();
    print!("| {name} | {:.2} ms |", shared::median(&mut times) * 1e3);
    for format in [Format::Png, Format::Svg, Format::Pdf] {
        let mut size = 0;
        let mut times: Vec<f64> = (0..rounds)
            .map(|_| shared::cpu(|| size = format.bytes(&figure).expect("the picture is drawn").len()))
            .collect();
        print!(" {:.2} ms, {:.0} kB |", shared::median(&mut times) * 1e3, size as f64 / 1e3);
    }
    println!();
}

fn map(document: &Document) -> Chart {
    let never = AtomicBool::new(false);
    let task = Task { tick: &|| (), cancel: &never };
    let over = ["stops.travel_limit_mm=0.5:7:0.1625", "excitation.amplitude_g=0:2:0.02"].map(str::to_owned);
    let grid = Grid::new(document.axes(&over).expect("the fields exist")).expect("the cells are few");
    let sweep = Sweep::new(&document.scene, &document.files, grid).with(SweepOptions::default());
    let mut rows = Table::new();
    let pool = Pool::new(2).expect("threads can be had");
    let end = sweep.run(&pool, &task, |table| {
        rows.append(table);
        Ok::<_, ()>(true)
    });
    assert!(end.is_ok());
    let (grid, scene) = (sweep.grid(), &document.scene);
    let overlay = Overlay::of(scene, sweep.first_mechanism().ok().as_deref(), grid, &rows);
    let picture =
        SweepPicture { overlay, ..SweepPicture::of_rows(&rows, grid, scene, "rms_velocity_m_per_s") };
    sweep_chart(&picture).expect("a map can be shown")
}

fn run(document: &Document) -> Chart {
    let model = shared::preset("paper", &[]);
    let times = sample_times(&document.scene, &model, &Sampling::Default, None).expect("times are known");
    let keep = Keep { times, events: false, until_settled: None };
    let (simulation, trace) = simulate_with_trace(&model, &keep, None, None);
    run_chart(&trace, &simulation.summary, &model, &RunPanel::ALL, Ranges::default())
}

fn force(document: &Document) -> Chart {
    let mechanism = shared::mechanism(document);
    let positions = default_positions(&document.scene, &mechanism, CURVE_PICTURE_POINTS);
    let table = curve(&mechanism, positions).expect("the positions lie on the curve");
    curve_chart(&table, &mechanism, (-6e-3, 6e-3), Ranges::default())
}
