//! Neighbouring areas of a picture leave no seam between them, and the text of a surface has its size.

use interwell::output::{
    Caption, Chart, Colours, Figure, Format, Ink, Marks, Panel, PlotAxis, Role, Shade, Shades, Shape, Sheet,
    SweepPicture, TICK, Theme, View, sweep_chart,
};
use interwell_studies::study::{Edges, Grid, Table};
use proptest::prelude::*;

use crate::properties::harness::hold_for;
use crate::shared::changed;

/// A map of so many columns and rows, its cells, and the parts of both axes that are shown.
type Drawn = ((usize, usize), Vec<u8>, [f64; 2], f64);

fn maps() -> impl Strategy<Value = Drawn> {
    (1..12usize, 1..12usize).prop_flat_map(|size| {
        let cells = prop::collection::vec(0..8u8, size.0 * size.1);
        (Just(size), cells, [0.0..0.4f64, 0.6..1.0f64], 0.2..3.0f64)
    })
}

/// Cells of which some are at rest, some missing, some not drawn, and the others have values.
fn cells(((columns, rows), kinds, ..): &Drawn) -> Shades {
    let cell = |kind: &u8| match kind {
        0 => Shade::Blank,
        1 => Shade::Missing,
        2 => Shade::Rest,
        kind => Shade::Value(f64::from(*kind)),
    };
    let values = |count: usize| Edges::new(&(0..count).map(|i| (i * i) as f64 + 1.0).collect::<Vec<_>>());
    Shades {
        across: values(*columns),
        up: values(*rows),
        cells: kinds.iter().map(cell).collect(),
        colours: Colours::Scale(PlotAxis::between(0.0, 8.0, "value")),
        missing: "missing".to_owned(),
    }
}

fn chart(cells: Shades, [from, to]: [f64; 2]) -> Chart {
    let part = |ends: (f64, f64)| {
        PlotAxis::between(ends.0 + from * (ends.1 - ends.0), ends.0 + to * (ends.1 - ends.0), "")
    };
    let mut panel = Panel::new(part(cells.across.ends()), part(cells.up.ends()));
    panel.bar = Some(PlotAxis::between(0.0, 8.0, "value"));
    panel.draw(Role::Motion, Marks::Cells(cells));
    Chart::stack(vec![panel], "", Table::new())
}

/// How much of the paper shows in a square of the width `side` about a place, if every edge is smoothed: each
/// rectangle covers as much of the square as lies in it.
fn paper_at(figure: &Figure, paper: Ink, side: f64, at: (f64, f64)) -> f64 {
    figure.shapes.iter().fold(1.0, |seen, shape| match shape {
        Shape::Rect(area, ink) => {
            let half = 0.5 * side;
            let covered = |low: f64, high: f64, at: f64| {
                ((high.min(at + half) - low.max(at - half)) / side).clamp(0.0, 1.0)
            };
            let share = covered(area.left, area.right, at.0) * covered(area.top, area.bottom, at.1);
            seen * (1.0 - share) + if *ink == paper { share } else { 0.0 }
        }
        _ => seen,
    })
}

/// The ink of the last rectangle that holds a place.
fn ink_at(figure: &Figure, at: (f64, f64)) -> Option<Ink> {
    let holds = |shape: &Shape| match shape {
        Shape::Rect(area, ink) => Some(*ink).filter(|_| area.contains(at)),
        _ => None,
    };
    figure.shapes.iter().rev().find_map(holds)
}

#[test]
fn the_background_shows_between_no_two_cells_and_at_no_step_of_a_colour_bar() {
    let show = |drawn: &Drawn| format!("{drawn:?}");
    // paper of a colour that no cell is near to
    let theme = Theme { paper: Ink(255, 0, 255), ..Theme::LIGHT };
    hold_for("no_seam_between_cells", 60, 0.5, maps(), show, |drawn| {
        let cells = cells(drawn);
        let figure = chart(cells.clone(), drawn.2).figure(&Caption::default(), &theme);
        let (frame, side) = (&figure.frames[0], drawn.3);
        let is_filled =
            |column: usize, row: usize| !matches!(cells.at(column, row), Shade::Blank | Shade::Missing);
        let inside = |at: &(f64, f64)| {
            let area = frame.area;
            at.0 > area.left + side
                && at.0 < area.right - side
                && at.1 > area.top + side
                && at.1 < area.bottom - side
        };
        let mut seams = Vec::new();
        let (columns, rows) = drawn.0;
        for column in 0..columns {
            for row in 0..rows {
                let middle = |edges: &[f64], i: usize| 0.5 * (edges[i] + edges[i + 1]);
                let (x, y) = (middle(&cells.across.edges, column), middle(&cells.up.edges, row));
                if column + 1 < columns && is_filled(column, row) && is_filled(column + 1, row) {
                    seams.push(frame.place((cells.across.edges[column + 1], y)));
                }
                if row + 1 < rows && is_filled(column, row) && is_filled(column, row + 1) {
                    seams.push(frame.place((x, cells.up.edges[row + 1])));
                }
                // what is not drawn stays as it is, and a cell has its own colour
                let at = frame.place((x, y));
                if inside(&at) {
                    let expected = match cells.at(column, row) {
                        Shade::Blank | Shade::Missing => theme.paper,
                        Shade::Rest => theme.rest,
                        Shade::Value(value) => cells.colours.ink(value, &theme),
                    };
                    prop_assert_eq!(ink_at(&figure, at), Some(expected), "{} {}", column, row);
                }
            }
        }
        seams.retain(inside);
        for at in &seams {
            // the edge at a quarter of a pixel
            for aside in [(0.25 * side, 0.0), (0.0, 0.25 * side), (-0.25 * side, -0.25 * side)] {
                let share = paper_at(&figure, theme.paper, side, (at.0 + aside.0, at.1 + aside.1));
                prop_assert!(share < 1e-9, "{share} of the paper shows at {at:?}");
            }
        }
        // the bar stands to the right of the frame
        let bar = frame.area.right + 37.0;
        let (top, bottom) = (frame.area.top + side, frame.area.bottom - side);
        for i in 0..400 {
            let at = (bar, top + (bottom - top) * f64::from(i) / 399.0);
            let share = paper_at(&figure, theme.paper, side, at);
            prop_assert!(share < 1e-9, "{share} of the paper shows in the bar at {at:?}");
        }
        Ok(!seams.is_empty())
    });
}

/// Columns of numbers that a surface can show, and fields that it can stand over, with long and short names.
const QUANTITIES: [&str; 6] = [
    "rms_velocity_m_per_s",
    "max_abs_x_m",
    "mean_load_power_w",
    "impact_speed_max_m_per_s",
    "impacts",
    "rested_share",
];
const FIELDS: [&str; 5] = [
    "stops.travel_limit_mm",
    "stops.restitution",
    "excitation.amplitude_g",
    "excitation.frequency_hz",
    "mechanism.parallel.width_mm",
];

#[test]
fn the_text_of_a_surface_has_the_size_that_is_asked_for() {
    let drawn = (
        0..QUANTITIES.len(),
        0..FIELDS.len(),
        1..FIELDS.len(),
        60.0..200.0f64,
        5.0..12.0f64,
        prop::option::of(60.0..200.0f64),
    );
    let document = changed("harvester", &[]);
    let show = |drawn: &(usize, usize, usize, f64, f64, Option<f64>)| format!("{drawn:?}");
    hold_for("the_text_of_a_surface_has_its_size", 60, 0.3, drawn, show, |drawn| {
        let (quantity, x, beside, width, font_pt, height) = drawn;
        let fields = [FIELDS[*x], FIELDS[(x + beside) % FIELDS.len()]];
        // narrower sheets are refused
        if width / (25.4 / 72.0 * font_pt) < 30.0 {
            return Ok(false);
        }
        let over = fields.map(|field| format!("{field}=0.1:0.3:0.1"));
        let grid = Grid::new(document.axes(&over).unwrap()).unwrap();
        let rows: Vec<(usize, usize)> = (0..9).map(|i| (i / 3, i % 3)).collect();
        let columns = grid.columns();
        let table = Table::new().each(&columns[0], &rows, |row| row.0 as f64 + 1.0);
        let table = table.each(&columns[1], &rows, |row| row.1 as f64 + 1.0);
        let table = table.each(QUANTITIES[*quantity], &rows, |row| 1e-3 * (row.0 * row.1 + 1) as f64);
        let table = table.each("regime", &rows, |_| "interwell").each("outcome", &rows, |_| "done");
        let picture = SweepPicture {
            view: View::Surface,
            ..SweepPicture::of_rows(&table, &grid, &document.scene, QUANTITIES[*quantity])
        };
        let sheet =
            Sheet { width_mm: *width, height_mm: *height, font_pt: *font_pt, dpi: 300.0, titled: false };
        let theme = Theme::of(false, Some(sheet));
        let figure = sweep_chart(&picture).unwrap().figure(&Caption::default(), &theme).without_title();
        let texts: Vec<_> = figure
            .shapes
            .iter()
            .filter_map(|shape| match shape {
                Shape::Text(text) => Some(text),
                _ => None,
            })
            .collect();
        for text in &texts {
            prop_assert!(text.size >= TICK, "`{}` has {} pt", text.words, text.size / TICK * font_pt);
            let (before, long) =
                (text.before(), interwell::output::text_width(&text.words, text.size, text.bold));
            let (from, to) = if text.upright {
                (text.at.1 - long + before, text.at.1 + before)
            } else {
                (text.at.0 - before, text.at.0 - before + long)
            };
            let (least, most) = if text.upright {
                (figure.shown.top, figure.shown.bottom)
            } else {
                (figure.shown.left, figure.shown.right)
            };
            prop_assert!(from >= least - 1.0 && to <= most + 1.0, "`{}` leaves the picture", text.words);
        }
        prop_assert!(texts.len() > 9, "{:?}", texts);
        prop_assert!(Format::Pdf.bytes(&figure).is_ok());
        Ok(true)
    });
}
