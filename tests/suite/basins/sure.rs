//! Which answers are sure, and that no answer depends on other starts: against closed forms, against runs
//! with 31 digits, and against maps of other starts and at other tolerances.

use super::*;
use crate::properties::harness::multiplied;
use crate::shared::build;

/// Double wells in which the basins are finely mixed: smooth, with stops, and beside a circuit.
fn mixed() -> [Document; 3] {
    let drive = "excitation: Force(amplitude_n: 0.2, frequency_rad_per_s: 1)";
    let run = "run: (duration_s: 400*pi, tolerance: 1e-9)";
    let with = |more: &str| well(&format!("damping: Coefficient(c_n_s_per_m: 0.15), {drive}, {more} {run}"));
    [
        with(""),
        with("stops: Rigid(travel_limit_mm: 1400, restitution: 0.9),"),
        with("transducer: Piezoelectric(coupling_n_per_v: 0.05, capacitance_nf: 1e8, load_kohm: 0.2),"),
    ]
}

/// The ranges of starts around both wells, in mm and m/s.
fn ranges(document: &Document) -> ((f64, f64), (f64, f64)) {
    let model = build(document);
    let (x, v) = (1e3 * model.scales().length, model.scales().speed);
    let (left, right) = model.stop_positions();
    let within = |x_mm: f64| x_mm.max(left.unwrap_or(-1e3) * 1e3).min(right.unwrap_or(1e3) * 1e3);
    ((within(-1.2 * x), within(1.2 * x)), (-0.8 * v, 0.8 * v))
}

/// The attractor to which a start really goes; `None` if it has not come near one.
fn truth(basins: &BasinMap, answer: &Answer, row: usize) -> Option<usize> {
    let period = basins.model().forcing_period().unwrap();
    let scales = basins.model().scales();
    let (x_mm, v) = basins.starts().at(row);
    let start = MapState { x: x_mm / 1e3, v, electrical: basins.model().start_electrical() };
    [40.0, 120.0, 360.0].into_iter().find_map(|periods| {
        let model = basins.model().with_start(start).with_duration(periods * period, 0.0);
        let end = model.run_reference(&Request::default(), 1e-24).summary;
        let is_near = |state: &(f64, f64)| {
            let off = ((state.0 - end.final_x) / scales.length).hypot((state.1 - end.final_v) / scales.speed);
            off < 1e-2
        };
        answer.attractors.iter().position(|attractor| attractor.states.iter().any(is_near))
    })
}

/// Whether two rows of two maps are the same but for the numbers of the attractors.
#[track_caller]
fn same_row(one: (&Answer, usize), other: (&Answer, usize)) {
    let (a, b) = (one.0.rows[one.1], other.0.rows[other.1]);
    assert_eq!(a.map(|found| found.1), b.map(|found| found.1), "periods");
    assert_eq!(one.0.sure[one.1], other.0.sure[other.1], "sure");
    if a.is_some() {
        let (a, b) = (attractor(one.0, one.1), attractor(other.0, other.1));
        assert_eq!((a.regime, a.period, a.side), (b.regime, b.period, b.side));
        near(a.states[0].0, b.states[0].0, 1e-9);
        near(a.states[0].1, b.states[0].1, 1e-9);
    }
}

/// The same starts alone, at either end of lines and in a grid, for one thread and three.
#[test]
fn no_answer_depends_on_other_starts() {
    let mut draw = Draw(5);
    for document in mixed().iter().chain([&changed("duffing-chaos", &[]), &changed("paper", &[])]) {
        let ((left, right), (slow, fast)) = ranges(document);
        for _ in 0..multiplied(2) {
            let x = [draw.between(left, right), draw.between(left, right)];
            let v = [draw.between(slow, fast), draw.between(slow, fast)];
            let (x, v) = ([x[0].min(x[1]), x[0].max(x[1])], [v[0].min(v[1]), v[0].max(v[1])]);
            let (x_range, v_range) = ((x[0], x[1], 5), (v[0], v[1], 4));
            let (basins, grid) = map(document, x_range, v_range);
            let mut again = refused(document, x_range, v_range).unwrap().checked();
            let alone = whole_on(&mut again, 1);
            assert_eq!(alone, grid);
            for row in [0, 3, 16, 19] {
                let (x_mm, v) = basins.starts().at(row);
                let (_, single) = map(document, (x_mm, x_mm, 1), (v, v, 1));
                same_row((&grid, row), (&single, 0));
                let (_, line) = map(document, (x_mm, right, 3), (v, v, 1));
                same_row((&grid, row), (&line, 0));
                let (_, line) = map(document, (x_mm, x_mm, 1), (2.0 * slow, v, 7));
                same_row((&grid, row), (&line, 6));
            }
        }
    }
}

/// A start next to an edge: the error of the integration decides where it goes, whatever else is in the grid.
#[test]
fn a_start_within_the_error_of_an_edge_has_one_answer_that_is_not_sure() {
    let [document, ..] = mixed();
    let (basins, first) = map(&document, (1600.0, 2000.0, 5), (0.0, 0.1, 2));
    let (_, second) = map(&document, (1600.0, 1700.0, 2), (0.0, 0.1, 2));
    let (_, third) = map(&document, (1600.0, 1600.0, 1), (0.0, 0.0, 1));
    for other in [&second, &third] {
        same_row((&first, 0), (other, 0));
    }
    let all = map(&document, (-1600.0, 1600.0, 9), (0.0, 0.0, 1)).1;
    let place = truth(&basins, &all, 0).unwrap();
    assert!(all.attractors[place].states[0].0 < 0.0, "the well to the left");
    let is_right = attractor(&first, 0).states[0].0 < 0.0;
    assert!(is_right || !first.sure[0]);
}

/// Lines across edges, ever shorter: on some of them the distance to the edge is about the error.
#[test]
fn no_wrong_answer_is_sure() {
    let (mut draw, mut wrong, mut sure, mut edges) = (Draw(8), 0, 0, 0);
    for document in &mixed() {
        let ((left, right), (slow, fast)) = ranges(document);
        for _ in 0..multiplied(2) {
            let x = draw.between(left, right);
            let (mut from, mut to) = (slow, fast);
            for zoom in 0..8 {
                let (basins, answer) = map(document, (x, x, 1), (from, to, 33));
                let number = |row: usize| answer.rows[row].map(|found| found.0);
                let borders: Vec<usize> = (0..32).filter(|row| number(*row) != number(row + 1)).collect();
                if borders.is_empty() {
                    break;
                }
                let border = borders[(draw.unit() * borders.len() as f64) as usize];
                if zoom > 1 {
                    edges += 1;
                    for row in [border, border + 1] {
                        let Some(found) = number(row) else { continue };
                        let Some(place) = truth(&basins, &answer, row) else { continue };
                        let is_wrong = place != found as usize - 1;
                        assert!(!(is_wrong && answer.sure[row]), "{x} {:?}", basins.starts().at(row));
                        wrong += u32::from(is_wrong);
                        sure += u32::from(answer.sure[row]);
                    }
                }
                (from, to) = (basins.starts().at(border).1, basins.starts().at(border + 1).1);
            }
        }
    }
    assert!(edges > 10 && wrong > 3 && sure > 5, "{edges} {wrong} {sure}");
}

/// Random starts on lines across the stable manifold of the saddle, whose side of it is known.
#[test]
fn a_start_beside_a_border_is_sure_and_one_on_it_is_not() {
    let c = 0.1_f64;
    let document = well("damping: Coefficient(c_n_s_per_m: 0.1), run: (duration_s: 10, tolerance: 1e-9)");
    let decay = -0.5 * c - (0.25 * c * c + 1.0).sqrt();
    let border = |x: f64| decay * x - x * x * x / (4.0 * decay + c);
    let mut draw = Draw(11);
    let mut wrong = 0;
    for number in 0..120 {
        let x_mm = draw.between(0.5, 1.0) * [1.0, -1.0][number % 2];
        let share = 10.0_f64.powf(draw.between(-12.0, -1.0)) * [1.0, -1.0][number / 2 % 2];
        let v = border(x_mm / 1e3) * (1.0 + share);
        let (_, answer) = map(&document, (x_mm, x_mm, 1), (v, v, 1));
        let passes = (attractor(&answer, 0).states[0].0 > 0.0) != (x_mm > 0.0);
        let is_wrong = passes != (share > 0.0);
        if share.abs() > 1e-5 {
            assert!(!is_wrong && answer.sure[0], "{x_mm} {share:e}");
        }
        wrong += u32::from(is_wrong);
        assert!(!(is_wrong && answer.sure[0]), "{x_mm} {share:e}");
    }
    assert!(wrong > 5, "{wrong}");
}

/// Few starts are not sure though neither ten times the tolerance, nor a tenth, nor an error of about the
/// same size at tolerances nearby sends them elsewhere; and two sure answers never differ.
#[test]
fn starts_that_another_tolerance_sends_elsewhere_are_not_sure_and_few_others() {
    for document in &mixed() {
        let ends = |tolerance: f64| {
            let mut document = document.clone();
            document.scene.run.tolerance = tolerance;
            let (x_mm, v) = ranges(&document);
            let starts = Starts::random(x_mm, v, multiplied(500).into(), 3).unwrap();
            let mut basins = BasinMap::new(&document.scene, mechanism(&document), starts).unwrap().checked();
            let answer = whole(&mut basins);
            assert_eq!((answer.undecided, answer.lost), (0, 0));
            let right = |row: usize| attractor(&answer, row).states[0].0 > 0.0;
            ((0..answer.rows.len()).map(right).collect::<Vec<bool>>(), answer.sure)
        };
        let (first, sure) = ends(1e-9);
        let tolerances = [1e-8, 2.5e-9, 1.8e-9, 1.4e-9, 1.2e-9, 0.8e-9, 0.7e-9, 0.55e-9, 0.4e-9, 1e-10];
        let others: Vec<(Vec<bool>, Vec<bool>)> =
            tolerances.iter().map(|tolerance| ends(*tolerance)).collect();
        let differs = |row: usize, other: &(Vec<bool>, Vec<bool>)| first[row] != other.0[row];
        let both =
            |row: &usize| others.iter().any(|other| sure[*row] && other.1[*row] && differs(*row, other));
        assert_eq!((0..first.len()).find(both), None, "two sure answers differ");
        let changes = |row: &usize| others.iter().any(|other| differs(*row, other));
        let unsure: Vec<usize> = (0..first.len()).filter(|row| !sure[*row]).collect();
        let need = (0..first.len()).filter(changes).count();
        let more = unsure.iter().filter(|row| !changes(row)).count();
        assert!(need > 30 && 10 * more <= need, "{} not sure, {more} of them beyond {need}", unsure.len());
    }
}
