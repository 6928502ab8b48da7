//! The layers of a panel as items of a plot, and their values as a table.

use std::ops::RangeInclusive;
use std::sync::Arc;

use eframe::egui::{Color32, Id, Rect, Shape, Ui};
use egui_plot::{PlotBounds, PlotGeometry, PlotItem, PlotItemBase, PlotPoint, PlotTransform};

use crate::app::ui::style::{Style, colour};
use crate::output::{Area, Colours, Frame, Layer, Marks, Panel, PlotAxis, Role, Shade, Shades, csv};
use interwell_studies::study::{Table, Values};

use super::pane::{UNIT, on_canvas};

/// Difference of lightness to the ground below which a colour is hardly seen.
const FAINT: f32 = 0.2;

/// A layer of cells as one layer for each kind of them, which the legend names and hides; any other as it is.
pub fn by_kind(layer: Layer) -> Vec<Layer> {
    let Marks::Cells(cells) = &layer.marks else { return vec![layer] };
    let is_kind = matches!(cells.colours, Colours::Categories(_));
    let part = |role: Role, name: String, has: &dyn Fn(&Shade) -> bool| {
        let own = cells.cells.iter().map(|cell| if has(cell) { *cell } else { Shade::Blank });
        Layer { marks: Marks::Cells(Shades { cells: own.collect(), ..cells.clone() }), role, name }
    };
    let valued = (!is_kind).then(|| part(layer.role, String::new(), &|cell| cell.value().is_some()));
    let named = cells.entries().into_iter().map(|(role, name)| {
        let kind = match (&cells.colours, role) {
            (_, Role::Missing) => Shade::Missing,
            (Colours::Categories(kinds), _) => match kinds.iter().position(|kind| kind.1 == name) {
                Some(kind) => Shade::Value(kind as f64),
                None => Shade::Rest,
            },
            _ => Shade::Rest,
        };
        part(role, name, &|cell| *cell == kind)
    });
    valued.into_iter().chain(named).collect()
}

/// The values that a panel shows as CSV: a row for each point or cell, with the name of its curve.
pub fn values_as_csv(panel: &Panel) -> String {
    let (mut names, mut rows) = (Vec::new(), Vec::new());
    for layer in &panel.layers {
        let mut add = |(x, y): (f64, f64), value: f64| {
            names.push(layer.name.replace([',', '"'], ""));
            rows.push([x, y, value]);
        };
        match &layer.marks {
            Marks::Path(points)
            | Marks::Trace(points)
            | Marks::Points(points)
            | Marks::Cloud(points)
            | Marks::Sticks(points) => points.iter().for_each(|at| add(*at, f64::NAN)),
            Marks::Regimes(points, _) => points.iter().for_each(|point| add(point.0, f64::NAN)),
            Marks::Cells(cells) => {
                for (i, cell) in cells.cells.iter().enumerate().filter(|(_, cell)| **cell != Shade::Blank) {
                    let (column, row) = (i / cells.up.values.len(), i % cells.up.values.len());
                    let at = (cells.across.values[column], cells.up.values[row]);
                    add(at, cell.value().unwrap_or(f64::NAN));
                }
            }
            _ => {}
        }
    }
    let column = |of: usize| Values::Numbers(rows.iter().map(|row| row[of]).collect());
    let mut table = Table::new().with("curve", Values::Names(names));
    table = table.with(&panel.x.label, column(0)).with(&panel.y.label, column(1));
    if rows.iter().any(|row| row[2].is_finite()) {
        table = table.with("value", column(2));
    }
    csv(&table)
}

/// The shapes of a layer on the screen.
pub fn shapes_of(
    ui: &Ui,
    transform: &PlotTransform,
    axes: [&PlotAxis; 2],
    style: &Style,
    layer: &Layer,
) -> Vec<Shape> {
    let (rect, bounds) = (*transform.frame(), transform.bounds());
    let area = Area::new(0.0, 0.0, (rect.width() / UNIT).into(), (rect.height() / UNIT).into());
    let axis = |of: usize, range: RangeInclusive<f64>| axes[of].bare((*range.start(), *range.end()));
    let frame = Frame { area, x: axis(0, bounds.range_x()), y: axis(1, bounds.range_y()) };
    let shapes = frame.shapes(std::slice::from_ref(layer), &style.theme());
    on_canvas(ui.painter(), style, rect.min, shapes)
}

/// The shapes of cells as they were drawn last, and for what.
#[derive(Clone)]
struct KeptCells {
    layer: Layer,
    place: (Rect, PlotBounds, Style, f32),
    shapes: Vec<Shape>,
}

/// The shapes of a layer of cells, made anew only where they change.
fn shapes_of_cells(ui: &Ui, transform: &PlotTransform, item: &LayerItem<'_>) -> Vec<Shape> {
    let place = (*transform.frame(), *transform.bounds(), item.style, ui.pixels_per_point());
    let kept = ui.data(|data| data.get_temp::<Arc<KeptCells>>(item.id));
    if let Some(kept) = kept.filter(|kept| kept.place == place && kept.layer == *item.layer) {
        return kept.shapes.clone();
    }
    let shapes = shapes_of(ui, transform, item.axes, &item.style, item.layer);
    let kept = KeptCells { layer: item.layer.clone(), place, shapes: shapes.clone() };
    ui.data_mut(|data| data.insert_temp(item.id, Arc::new(kept)));
    shapes
}

/// A layer of a panel as an item: its shapes are those on paper, in the frame and between the ends that the
/// plot has.
pub struct LayerItem<'a> {
    id: Id,
    base: PlotItemBase,
    layer: &'a Layer,
    axes: [&'a PlotAxis; 2],
    style: Style,
    points: Vec<PlotPoint>,
}

impl<'a> LayerItem<'a> {
    /// An item with this name in the legend, whose points are found under the pointer if `read`.
    pub fn new(
        id: Id,
        (name, layer): (&str, &'a Layer),
        panel: &'a Panel,
        style: &Style,
        read: bool,
    ) -> Self {
        let points = match &layer.marks {
            _ if !read => Vec::new(),
            Marks::Path(points)
            | Marks::Trace(points)
            | Marks::Points(points)
            | Marks::Cloud(points)
            | Marks::Sticks(points) => points
                .iter()
                .filter(|at| at.0.is_finite() && at.1.is_finite())
                .map(|at| [at.0, at.1].into())
                .collect(),
            _ => Vec::new(),
        };
        let base = PlotItemBase::new(name.to_owned());
        Self { id, base, layer, axes: [&panel.x, &panel.y], style: *style, points }
    }
}

impl PlotItem for LayerItem<'_> {
    fn shapes(&self, ui: &Ui, transform: &PlotTransform, shapes: &mut Vec<Shape>) {
        shapes.extend(match &self.layer.marks {
            Marks::Cells(_) => shapes_of_cells(ui, transform, self),
            _ => shapes_of(ui, transform, self.axes, &self.style, self.layer),
        });
    }

    fn initialize(&mut self, _: RangeInclusive<f64>) {}

    /// The colour of its name in the legend: that of its outline or hatching where its own is hardly seen.
    fn color(&self) -> Color32 {
        let look = self.style.theme().look(self.layer.role);
        let (own, ground) = (colour(look.ink), self.style.ground());
        let is_seen = (own.intensity() - ground.intensity()).abs() > FAINT;
        let other = look.halo.or(look.hatch).map(colour).filter(|_| !is_seen);
        other.unwrap_or(own)
    }

    fn geometry(&self) -> PlotGeometry<'_> {
        match self.points.is_empty() {
            true => PlotGeometry::None,
            false => PlotGeometry::Points(&self.points),
        }
    }

    fn bounds(&self) -> PlotBounds {
        PlotBounds::NOTHING
    }

    fn base(&self) -> &PlotItemBase {
        &self.base
    }

    fn base_mut(&mut self) -> &mut PlotItemBase {
        &mut self.base
    }
}
