//! Pictures of sweeps: rest, missing values and categories, in all of them by the same words.

use interwell::output::{
    Caption, Cut, Marks, NoPicture, Overlay, Role, Shape, SweepPicture, Theme, View, shown_columns,
    sweep_chart,
};
use interwell::scene::Scene;
use interwell_studies::study::{Grid, Table};

use super::*;
use crate::shared::changed;

const SHORT: &str = "--set run.settle_s=None --set run.duration_s=2";
/// Runs that leave the force curve above 2.8 g.
const LEAVES: &str = "sweep paper-table --set stops=None --set run.settle_s=None --set run.duration_s=4";

fn has(texts: &[String], words: &str) -> bool {
    texts.iter().any(|text| text == words)
}

/// The picture of the RMS velocity of a sweep of a scene.
fn picture<'a>(rows: &'a Table, grid: &'a Grid, scene: &'a Scene, view: View) -> SweepPicture<'a> {
    SweepPicture { view, ..SweepPicture::of_rows(rows, grid, scene, "rms_velocity_m_per_s") }
}

#[test]
fn rest_and_missing_values_have_names_in_every_picture_of_a_sweep() {
    let line = format!("sweep paper {SHORT} --over excitation.amplitude_g=0:2:0.25");
    let one_way = [("period", "period 1"), ("side", "both"), ("regime", "interwell"), ("settled", "settled")];
    for (quantity, word) in one_way {
        for walk in ["", "--carry both"] {
            let texts = says(&format!("{line} {walk} --quantity {quantity}"), &["at rest", word]);
            let unnamed = ["rest", "left", "irregular", "crossing", "true", "false"];
            assert!(!unnamed.iter().any(|word| has(&texts, word)), "{quantity} {walk}: {texts:?}");
        }
        let texts = says(&format!("{SMALL_MAP} --quantity {quantity}"), &["at rest"]);
        assert!(!has(&texts, "rest"), "{quantity}: {texts:?}");
    }
    let outcome = says(&format!("{SMALL_MAP} --quantity outcome"), &["done"]);
    assert!(!has(&outcome, "at rest"), "{outcome:?}");
    for walk in ["", "--carry both"] {
        says(&format!("{LEAVES} --over excitation.amplitude_g=2:3:0.25 {walk}"), &["ended early"]);
    }
    let both = says(&format!("{SMALL_MAP} --carry both --quantity regime"), &["at rest"]);
    assert!(has(&both, "the same"), "{both:?}");
    let surface = "--over excitation.amplitude_g=2:3:0.25 --over mass_g=12:16:1 --surface";
    says(&format!("{LEAVES} {surface}"), &["ended early"]);
}

#[test]
fn a_cut_has_one_entry_for_rest_and_names_its_categories() {
    let cuts = format!("{SMALL_MAP} --cut travel_limit_mm=7 --cut amplitude_g=1");
    let texts = says(&cuts, &["at rest"]);
    assert!(!has(&texts, "rest"), "{texts:?}");
    for size in ["", "--plot-width-mm 170 --font-pt 9"] {
        let texts = says(&format!("{cuts} --quantity regime {size}"), &[]);
        // in the legend, and at the axis of each cut
        for word in ["at rest", "intrawell", "interwell"] {
            assert_eq!(texts.iter().filter(|text| *text == word).count(), 3, "{size} {word}: {texts:?}");
        }
        assert!(!has(&texts, "crossing"), "{size}: {texts:?}");
    }
}

#[test]
fn without_any_value_no_scale_is_invented() {
    let line = "sweep paper --set stops=None --set start=At(x_mm:7,v_m_per_s:9)";
    for quantity in ["rms_velocity_m_per_s", "period"] {
        let over = format!("--over excitation.amplitude_g=40:50:5 --quantity {quantity}");
        let texts = says(&format!("{line} {over}"), &["ended early"]);
        assert!(!["0.0", "0", "0.5", "1.0", "1"].iter().any(|number| has(&texts, number)), "{texts:?}");
    }
    let texts =
        says("exponents paper --over excitation.amplitude_g=0.1:0.3:0.1 --periods 20", &["rests on a stop"]);
    assert!(!has(&texts, "0.5") && !has(&texts, "\u{2212}1.0"), "{texts:?}");
}

#[test]
fn a_diagram_spans_what_was_swept() {
    let line = format!("section paper {SHORT} --over excitation.amplitude_g=0:1:0.25 --at impacts");
    let texts = says(&line, &["impacts"]);
    assert!(has(&texts, "0.0") && has(&texts, "0.2"), "{texts:?}");
}

#[test]
fn neighbouring_values_that_are_missing_are_hatched_spans() {
    let document = changed("paper", &[]);
    let grid = Grid::new(document.axes(&["excitation.amplitude_g=0:3:1"]).unwrap()).unwrap();
    let row = |place: usize| [0.0, 0.1, f64::NAN, f64::NAN][place];
    let rows: Vec<(usize, &'static str)> =
        (0..4).map(|i| (i, "up")).chain((0..4).rev().map(|i| (i, "down"))).collect();
    let table = |rows: &[(usize, &'static str)]| {
        let table = Table::new().each("amplitude_g", rows, |(place, _)| *place as f64);
        let table = table.each("rms_velocity_m_per_s", rows, |(place, _)| row(*place));
        let table = table.each("regime", rows, |(place, _)| ["rest", "intrawell", "", ""][*place]);
        table.each("outcome", rows, |(place, _)| ["done", "done", "left_table", "left_table"][*place])
    };
    let one = table(&rows[..4]);
    let both = table(&rows).each("direction", &rows, |(_, way)| *way);
    for (rows, count) in [(&one, 2), (&both, 4)] {
        let picture = picture(rows, &grid, &document.scene, View::default());
        let chart = sweep_chart(&picture).unwrap();
        let layer = chart.panels().flat_map(|panel| &panel.layers).find(|layer| layer.name == "ended early");
        let Marks::Spans(spans) = &layer.unwrap().marks else { panic!("{layer:?}") };
        assert_eq!((spans.len(), spans[0], spans[count - 1]), (count, (1.5, 2.5), (2.5, 3.5)));
    }
}

#[test]
fn a_cut_and_rows_of_another_sweep_are_faults() {
    let document = changed("paper", &[]);
    let over = ["stops.travel_limit_mm=1:2:1", "excitation.amplitude_g=0:1:1"];
    let grid = Grid::new(document.axes(&over).unwrap()).unwrap();
    let rows = [(1.0, 0.0), (1.0, 1.0), (2.0, 0.0), (2.0, 1.0)];
    let of_limit = Table::new().each("travel_limit_mm", &rows, |row| row.0);
    let of_limit = of_limit.each("rms_velocity_m_per_s", &rows, |row| row.1);
    let of_both = of_limit.clone().each("amplitude_g", &rows, |row| row.1);
    let fault = |rows, column: &str| {
        let view = View::Cuts(vec![Cut { column: column.to_owned(), value: 1.0 }]);
        let picture = picture(rows, &grid, &document.scene, view);
        sweep_chart(&picture).err()
    };
    assert_eq!(fault(&of_both, "amplitude_g"), None);
    let fields = "travel_limit_mm and amplitude_g".to_owned();
    assert_eq!(fault(&of_both, "mass_g"), Some(NoPicture::NoSuchCut("mass_g".to_owned(), fields)));
    assert_eq!(fault(&of_limit, "amplitude_g"), Some(NoPicture::NoSuchColumn("amplitude_g".to_owned())));
}

#[test]
fn a_map_has_dots_where_motions_may_be_transients_and_lines_that_end_inside_its_frame() {
    let document = changed("paper", &[]);
    let over = ["stops.travel_limit_mm=1:3:1", "excitation.amplitude_g=0:2:1"];
    let grid = Grid::new(document.axes(&over).unwrap()).unwrap();
    assert_eq!(shown_columns("period", &View::Top, &grid), ["period", "settled", "steady"]);
    let rows: Vec<(f64, f64)> = (0..9).map(|i| (f64::from(i / 3 + 1), f64::from(i % 3))).collect();
    let table = Table::new().each("travel_limit_mm", &rows, |row| row.0);
    let table =
        table.each("amplitude_g", &rows, |row| row.1).each("rms_velocity_m_per_s", &rows, |row| row.1);
    let table = table.each("regime", &rows, |row| if row.1 == 0.0 { "rest" } else { "interwell" });
    let table = table.each("settled", &rows, |row| if *row == (2.0, 1.0) { "false" } else { "true" });
    let table = table.each("steady", &rows, |_| "true").each("outcome", &rows, |_| "done");
    let overlay = Overlay::of(&document.scene, None, &grid, &table);
    let picture = SweepPicture { overlay, ..picture(&table, &grid, &document.scene, View::Top) };
    let chart = sweep_chart(&picture).unwrap();
    let dots = chart.panels().flat_map(|panel| &panel.layers).find(|layer| layer.role == Role::Transient);
    assert_eq!(dots.unwrap().marks, Marks::Cloud(vec![(2.0, 1.0)]));
    let figure = chart.figure(&Caption::default(), &Theme::LIGHT);
    let (frame, look) = (figure.frames[0].area, Theme::LIGHT.look(Role::FirstCrossing));
    let of_line = |shape: &Shape| match shape {
        Shape::Line(points, width, ink) if (*width, *ink) == (look.width, look.ink) => points.clone(),
        _ => Vec::new(),
    };
    // those of the legend stand above the frame
    let points = figure.shapes.iter().flat_map(of_line).filter(|at| at.1 > frame.top);
    let across: Vec<f64> = points.map(|at| at.0).collect();
    let half = 0.5 * look.width;
    assert!(across.len() > 1, "{across:?}");
    assert!(across.iter().all(|x| (frame.left + half..=frame.right - half).contains(x)), "{across:?}");
}
