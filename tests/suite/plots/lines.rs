//! Lines over a map against the runs of its cells.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use interwell::mechanics::Mechanism;
use interwell::scene::Document;
use interwell_studies::study::{Grid, Sweep, Table, Task, Values, first_crossing, release_line};

fn swept(document: &Document, over: &[&str]) -> (Grid, Table) {
    let grid = Grid::new(document.axes(over).unwrap()).unwrap();
    let sweep = Sweep::new(&document.scene, &document.files, grid.clone());
    let pool = interwell::system::threads::Pool::new(2).unwrap();
    let cancel = AtomicBool::new(false);
    let mut rows = Table::new();
    let write = |table: &Table| {
        rows.append(table);
        Ok::<_, ()>(true)
    };
    sweep.run(&pool, &Task { tick: &|| (), cancel: &cancel }, write).unwrap();
    (grid, rows)
}

#[test]
fn release_parts_rest_from_motion() {
    let document = Document::load("paper").unwrap();
    let mechanism = Arc::new(Mechanism::build(&document.scene.mechanism, &document.files).unwrap());
    let over = ["stops.travel_limit_mm=0.5:6.5:0.5", "excitation.amplitude_g=0:1.5:0.1"];
    let (grid, rows) = swept(&document, &over);
    let line = release_line(&document.scene, &mechanism, &grid).unwrap();
    let (limits, amplitudes) =
        (line.numbers("travel_limit_mm").unwrap(), line.numbers("amplitude_g").unwrap());
    let at = |limit: f64| {
        let place = limits.partition_point(|value| *value < limit).clamp(1, limits.len() - 1);
        amplitudes[place - 1].max(amplitudes[place])
    };
    let Values::Words(regimes) = &rows.column("regime").unwrap().values else { panic!() };
    for (i, regime) in regimes.iter().enumerate() {
        let limit = rows.numbers("travel_limit_mm").unwrap()[i];
        let amplitude = rows.numbers("amplitude_g").unwrap()[i];
        // Between two points of the line it is straight; no cell lies so near to it.
        assert!((amplitude - at(limit)).abs() > 1e-3, "{limit} {amplitude}");
        assert_eq!(*regime == "rest", amplitude < at(limit), "{limit} {amplitude}");
    }
    // 0.197 N / 15.2 g in round numbers, where the force is greatest.
    assert!((amplitudes.iter().copied().fold(0.0, f64::max) - 1.32).abs() < 0.01);
}

#[test]
fn the_first_crossing_cell_is_the_first_one() {
    let mut document = Document::load("nominal-cubic").unwrap();
    document.set("run.duration_s=4").unwrap();
    document.set("run.settle_s=2").unwrap();
    // Not in order, and too weak for the last one.
    let (grid, rows) =
        swept(&document, &["excitation.amplitude_g=1,0.2,0.5,0", "stops.travel_limit_mm=1,0.5,4"]);
    let line = first_crossing(&grid, &rows).unwrap();
    assert_eq!(line.numbers("travel_limit_mm").unwrap(), [0.5, 1.0, 4.0]);
    let least = line.numbers("amplitude_g").unwrap();
    let Values::Words(regimes) = &rows.column("regime").unwrap().values else { panic!() };
    for (limit, least) in line.numbers("travel_limit_mm").unwrap().iter().zip(least) {
        let cells = (0..rows.rows()).filter(|i| {
            rows.numbers("travel_limit_mm").unwrap()[*i] == *limit
                && ["interwell", "irregular"].contains(&regimes[*i])
        });
        let expected = cells.map(|i| rows.numbers("amplitude_g").unwrap()[i]).reduce(f64::min);
        assert_eq!(expected, Some(*least).filter(|value| value.is_finite()));
    }
    assert!(least[0].is_finite());
    // Without an amplitude there is no such line.
    let (grid, rows) = swept(&document, &["mass_g=15,16", "stops.restitution=0,0.5"]);
    assert_eq!(first_crossing(&grid, &rows), None);
    let mechanism = Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
    assert_eq!(release_line(&document.scene, &mechanism, &grid), None);
}
