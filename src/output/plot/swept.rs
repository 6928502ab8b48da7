//! Rows of a sweep as its pictures need them: what a picture is drawn from, places, words, marks.

use super::axis::{PlotAxis, Ranges};
use super::drawn::{Drawn, as_numbers};
use super::figure::{Figure, Point};
use super::frame::Frame;
use super::mark::{Sample, legend, marker, regime};
use super::style::{Ink, Theme};
use crate::mechanics::Mechanism;
use crate::numeric::short;
use crate::scene::Scene;
use crate::study::{Column, DIRECTION, Grid, Table, first_crossing, label_and_unit, release_line};

pub(super) const LEFT: f64 = 160.0;
pub(super) const TOP: f64 = 185.0;
/// What a picture with one frame needs between its captions.
pub(super) const LEAST: f64 = 420.0;

/// Draws the legend of a picture with one frame; where the frame begins.
pub(super) fn below_legend(figure: &mut Figure, theme: &Theme, entries: &[(Sample, &str)]) -> f64 {
    let ends = (LEFT, figure.right());
    TOP.max(legend(figure, theme, entries, ends, 146.0) + 18.0)
}

/// The lines over a map, each where it makes sense.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overlay {
    /// The release in closed form, with the swept columns of the map.
    pub release: Option<Table>,
    /// The first crossing cell along the amplitude.
    pub first_crossing: Option<Table>,
}

impl Overlay {
    /// The lines over the rows of a sweep of this scene, where runs begin at rest and the cells have one
    /// mechanism.
    pub fn of(scene: &Scene, mechanism: Option<&Mechanism>, grid: &Grid, rows: &Table) -> Self {
        Self {
            release: mechanism.and_then(|mechanism| release_line(scene, mechanism, grid)),
            first_crossing: first_crossing(grid, rows),
        }
    }
}

/// How a sweep over two fields is shown.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum View {
    /// From the top, the quantity as colour, or as a line for each value of a field that has few.
    #[default]
    Top,
    /// As a surface whose height is the quantity.
    Surface,
    /// From the top, with lines through it beside it.
    Cuts(Vec<Cut>),
}

/// A line through a map along which one of its fields has a value.
#[derive(Debug, Clone, PartialEq)]
pub struct Cut {
    /// Column of that field.
    pub column: String,
    /// Its value, one of the map's.
    pub value: f64,
}

/// What the picture of a sweep is drawn from.
#[derive(Debug, Clone)]
pub struct SweepPicture<'a> {
    /// All rows.
    pub rows: &'a Table,
    /// Of which grid.
    pub grid: &'a Grid,
    /// Over which scene.
    pub scene: &'a Scene,
    /// Up to when in s runs went on until they repeat, where they did.
    pub until_settled: Option<f64>,
    /// The column that is shown.
    pub quantity: &'a str,
    /// The lines over a map.
    pub overlay: Overlay,
    /// How a sweep over two fields is shown.
    pub view: View,
    /// The axes of the fields, and over one field that of the quantity upward.
    pub ranges: Ranges,
}

/// The cells with the quantity and their words, only those whose fields lie in `ranges`.
pub(super) fn drawn(picture: &SweepPicture, ranges: &[(&str, Option<(f64, f64)>)]) -> Drawn {
    let SweepPicture { rows, grid, quantity, .. } = picture;
    let fields = grid.columns();
    let value = rows.column(quantity).and_then(as_numbers);
    let names = fields.iter().map(String::as_str).chain(value.is_some().then_some(*quantity));
    let ways = rows.words(DIRECTION);
    let regimes = rows.words("regime");
    let mut drawn = Drawn::new(names, if ways.is_empty() { &["regime"] } else { &["regime", DIRECTION] });
    let columns: Vec<&[f64]> = fields.iter().filter_map(|name| rows.numbers(name)).collect();
    for row in 0..rows.rows() {
        let within = |(name, range): &(&str, Option<(f64, f64)>)| {
            let number = rows.numbers(name).map_or(f64::NAN, |column| column[row]);
            range.is_none_or(|(low, high)| (low..=high).contains(&number))
        };
        if ranges.iter().all(within) {
            let places = columns.iter().map(|column| column[row]);
            let numbers: Vec<f64> = places.chain(value.as_ref().map(|values| values[row])).collect();
            let said: Vec<&str> =
                [regimes, ways].iter().filter_map(|column| column.get(row).copied()).collect();
            drawn.put("cell", &numbers, &said);
        }
    }
    drawn
}

pub(super) fn label(rows: &Table, name: &str) -> String {
    rows.column(name).map_or_else(|| name.to_owned(), Column::label)
}

/// The axis to the right over the swept field `x`.
pub(super) fn swept_axis(rows: &Table, x: &str, range: Option<(f64, f64)>) -> PlotAxis {
    let (label, values) = (label(rows, x), rows.numbers(x).unwrap_or_default());
    PlotAxis::around(values.iter().copied(), 0.02, 8, &label).or_given(range, 8, &label)
}

/// The values of the field `name`, for each of which there is a line, as a legend names them.
pub(super) fn of_each(name: &str, each: &[f64]) -> Vec<String> {
    let (words, unit) = label_and_unit(name);
    let named = |(i, value): (usize, &f64)| {
        let value = short(*value);
        let words = if i == 0 { format!("{words} {value}") } else { value };
        format!("{words} {unit}").trim_end().to_owned()
    };
    each.iter().enumerate().map(named).collect()
}

/// What a legend says of cells without a speed, by the outcomes of all cells.
pub(super) fn missing_words(outcomes: &[&'static str]) -> &'static str {
    let is = |word: &&&str| **word == "not_converged";
    let unsolved = outcomes.iter().filter(is).count();
    let early = outcomes.iter().filter(|word| !is(word) && **word != "done").count();
    match (unsolved, early) {
        (0, _) => "ended early",
        (_, 0) => "flexures not solved",
        _ => "ended early or not solved",
    }
}

/// So many times its half height apart, markers on a line are told from each other.
pub(super) const MARKER_ROOM: f64 = 5.0;

/// Marks points of the data with their regimes, outlined by `edge`, as many as stand `apart`.
pub(super) fn mark_regimes<'a>(
    figure: &mut Figure,
    frame: &Frame,
    points: impl Iterator<Item = (Point, &'a str)>,
    size: f64,
    apart: f64,
    edge: Ink,
    theme: &Theme,
) {
    let placed = points.map(|(point, word)| (frame.place(point), word));
    let marks: Vec<(Point, &str)> = placed.filter(|mark| frame.area.contains(mark.0)).collect();
    for (at, word) in thinned(&marks, apart, 1.5 * size) {
        let (shape, ink) = regime(word, theme);
        marker(figure, shape, at, size, ink, edge);
    }
}

/// The marks of a line that stand `apart` from the one before; where the word changes, `close` is enough.
fn thinned<'a>(marks: &[(Point, &'a str)], apart: f64, close: f64) -> Vec<(Point, &'a str)> {
    let mut kept: Vec<(Point, &str)> = Vec::new();
    for (at, word) in marks {
        let stands = kept.last().is_none_or(|(last, other)| {
            (at.0 - last.0).hypot(at.1 - last.1) >= if other == word { apart } else { close.min(apart) }
        });
        if stands {
            kept.push((*at, word));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markers_on_a_line_stand_apart_and_a_change_is_seen() {
        let marks: Vec<(Point, &str)> = (0..100)
            .map(|i| ((f64::from(i) * 4.0, 0.0), if i < 50 { "rest" } else { "interwell" }))
            .collect();
        let kept = thinned(&marks, 40.0, 10.0);
        assert!(kept.windows(2).all(|pair| {
            let step = pair[1].0.0 - pair[0].0.0;
            step >= 40.0 || (pair[0].1 != pair[1].1 && step >= 10.0)
        }));
        let first = kept.iter().find(|mark| mark.1 == "interwell").unwrap();
        assert!(first.0.0 <= 200.0 + 10.0, "{first:?}");
        assert_eq!(thinned(&marks, 0.0, 10.0), marks);
    }

    #[test]
    fn a_legend_says_why_a_cell_has_no_speed() {
        assert_eq!(missing_words(&["done", "left_table"]), "ended early");
        assert_eq!(missing_words(&["done", "not_converged"]), "flexures not solved");
        assert_eq!(missing_words(&["step_budget", "not_converged"]), "ended early or not solved");
    }
}
