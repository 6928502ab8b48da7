//! A chart in a view: an [`egui_plot::Plot`] whose items are the layers of the chart.
//!
//! Data, names and colours are those of the picture on paper. Legend, panning and the box are egui_plot's;
//! the wheel and the double click are the same in all views, and the ends of the axes are kept in
//! [`Memory`], which other views may share.

use std::cell::RefCell;
use std::collections::HashSet;
use std::ops::RangeInclusive;
use std::time::Duration;

use eframe::egui::{
    Align2, AsIdSalt, CursorIcon, Id, Painter, Pos2, Rect, Response, Sense, TextStyle, Ui, UiBuilder, Vec2,
    pos2, vec2,
};
use egui_plot::{
    ColorConflictHandling, Corner, GridInput, GridMark, HoverPosition, Legend, Plot, PlotBounds, PlotPoint,
    PlotTransform,
};

use crate::app::ui::style::{CONTROL, GRAB, Style};
use crate::app::ui::widgets::{Icon, tool_ui};
use crate::app::words::numbers::{three, with_minus};
use crate::output::{Layer, Marks, Panel, PlotAxis};

use super::hand::zoom_input;
use super::labels::plated;
use super::layer::{LayerItem, shapes_of, values_as_csv};
use super::memory::Memory;
use super::span::Span;
use super::view::{Axis, View};
use super::zoom::Ends;

/// Distance in points of the numbers on the horizontal and the vertical axis, at least.
const APART: (f32, f32) = (80.0, 40.0);

/// Least distance in points of the numbers on a low vertical axis.
pub const LEAST: f32 = 16.0;

/// Height in points of a horizontal axis, and that of a plot below which it has no name.
const LEVEL: f32 = 36.0;
const NAMELESS: f32 = 160.0;

/// Margins in points beside a plot, and above and below it.
const MARGIN: f32 = 8.0;
const ABOVE: f32 = 7.0;

/// Least width in points of what is read.
const READING: f32 = 110.0;

/// Share of an axis below which a value is read as zero.
const ZERO: f64 = 1e-4;

/// Width in points of a vertical axis, so that frames above each other begin at the same place.
pub const UPRIGHT: f32 = 58.0;

/// Height in points of a name in a legend, and the width of what stands beside it.
const ROW: f32 = 20.0;
const BESIDE_NAME: f32 = 44.0;

/// A panel as it was drawn.
pub struct Plotted {
    pub response: Response,
    /// The values of the axes where it was clicked, once it is known that this is no double click, or for
    /// which the menu was asked.
    pub clicked: Option<(f64, f64)>,
    transform: PlotTransform,
    /// The place of the legend, under which nothing is pointed at.
    legend: Rect,
    /// The name of the curve under the pointer, and its point there.
    nearest: Option<(String, (f64, f64))>,
}

impl Plotted {
    pub fn frame(&self) -> Rect {
        *self.transform.frame()
    }

    /// The place on the screen of a point of the panel.
    pub fn place(&self, (x, y): (f64, f64)) -> Pos2 {
        self.transform.position_from_point(&PlotPoint::new(x, y))
    }

    /// The values of the axes at a place on the screen.
    pub fn values(&self, at: Pos2) -> (f64, f64) {
        let PlotPoint { x, y } = self.transform.value_from_position(at);
        (x, y)
    }

    /// The values of the axes under the pointer.
    pub fn pointed(&self) -> Option<(f64, f64)> {
        Some(self.values(self.response.hover_pos().filter(|at| !self.legend.contains(*at))?))
    }

    /// The handle of the upright line at a value, or at the edge beyond which it lies. A drag that begins
    /// there does not pan.
    pub fn handle(&self, ui: &Ui, name: impl AsIdSalt, value: f64) -> Response {
        let frame = self.frame();
        let at = frame.clamp(self.place((value, 0.0))).x;
        let strip = Rect::from_x_y_ranges(at - 0.5 * GRAB..=at + 0.5 * GRAB, frame.y_range());
        let handle = ui.interact(strip.intersect(frame), self.response.id.with(name), Sense::drag());
        handle.on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal)
    }

    /// The displacements in m over the frame of a picture over displacements in mm.
    pub fn span(&self) -> Span {
        let bounds = self.transform.bounds();
        Span { low: bounds.min()[0] * 1e-3, high: bounds.max()[0] * 1e-3 }
    }

    /// Draws a layer over what the view has drawn on the plot.
    pub fn draw(&self, ui: &Ui, style: &Style, panel: &Panel, layer: &Layer) {
        let shapes = shapes_of(ui, &self.transform, [&panel.x, &panel.y], style, layer);
        ui.painter().with_clip_rect(self.frame()).extend(shapes);
    }

    /// Writes what is read in its corner.
    pub fn write(&self, ui: &Ui, style: &Style, text: &str) {
        let frame = self.frame();
        let is_beside = self.legend.top() < frame.center().y;
        let right = if is_beside { self.legend.left().max(frame.left() + READING) } else { frame.right() };
        plated_at(ui.painter(), style, frame.with_max_x(right), text);
    }

    /// Writes the values of the curve under the pointer.
    pub fn read(&self, ui: &Ui, style: &Style, panel: &Panel) {
        let Some((name, (x, y))) = self.nearest.as_ref().filter(|_| !self.response.dragged()) else { return };
        let number = |axis: &PlotAxis, value: f64| {
            let number = match axis.is_logarithmic() {
                true => format!("{:.2e}", 10_f64.powf(value)),
                // near zero by rounding
                false if value.abs() < ZERO * (axis.high - axis.low) => three(0.0),
                false => three(value),
            };
            axis.unit().map_or(number.clone(), |unit| format!("{number} {unit}"))
        };
        let name = if name.is_empty() { String::new() } else { format!("{name}: ") };
        self.write(ui, style, &format!("{name}{} at {}", number(&panel.y, *y), number(&panel.x, *x)));
    }
}

impl Memory {
    /// The ends of the axes of a view in the units of its picture: those chosen by hand, or else the
    /// automatic ones.
    pub(super) fn ends(&mut self, view: View, automatic: [Ends; 2]) -> [Ends; 2] {
        let Some([across, up]) = view.axes() else { return automatic };
        [self.ends_of(across, automatic[0]), self.ends_of(up, automatic[1])]
    }

    fn ends_of(&mut self, axis: Axis, (low, high): Ends) -> Ends {
        let per = axis.per_own();
        let (low, high) = self.axes.ends(axis, (low / per, high / per));
        (low * per, high * per)
    }
}

/// What `make` gives for a key; made anew when the key changes.
pub fn kept<K, T>(ui: &Ui, key: K, make: impl FnOnce() -> T) -> T
where
    K: Clone + PartialEq + Send + Sync + 'static,
    T: Clone + Send + Sync + 'static,
{
    let id = ui.scope_id().with("kept");
    let before = ui.data(|data| data.get_temp::<(K, T)>(id)).filter(|kept| kept.0 == key);
    before.map(|kept| kept.1).unwrap_or_else(|| {
        let made = make();
        ui.data_mut(|data| data.insert_temp(id, (key, made.clone())));
        made
    })
}

/// Writes what is read in the upper left corner of a picture.
pub fn plated_at(painter: &Painter, style: &Style, frame: Rect, text: &str) {
    let inside = frame.shrink(4.0);
    let galley = painter.layout(with_minus(text), style.small(), style.ink(), inside.width());
    plated(painter, style, (inside.left_top(), Align2::LEFT_TOP), galley);
}

/// The width in points of a text in the letters of a picture.
pub fn width(ui: &Ui, style: &Style, text: &str) -> f32 {
    ui.painter().layout_no_wrap(text.to_owned(), style.small(), style.ink()).size().x
}

/// The name of an axis, or its unit where a length in points has no room for it.
pub fn name_within(ui: &Ui, style: &Style, axis: &PlotAxis, length: f32) -> String {
    let unit = axis.unit().filter(|_| width(ui, style, &axis.label) > length);
    unit.unwrap_or(&axis.label).to_owned()
}

/// The names of a legend in a frame of this size: as many as cover half of its height, those of lines before
/// those of marks, and none that is wider.
fn names<'a>(ui: &Ui, style: &Style, panel: &'a Panel, size: Vec2) -> HashSet<&'a str> {
    let is_marks = |layer: &&Layer| matches!(layer.marks, Marks::Points(_));
    let (marks, lines): (Vec<_>, Vec<_>) = panel.layers.iter().partition(is_marks);
    let mut names = HashSet::new();
    for layer in lines.into_iter().chain(marks).filter(|layer| !layer.name.is_empty()) {
        let is_whole = width(ui, style, &layer.name) + BESIDE_NAME <= size.x;
        if is_whole && 2.0 * ROW * (names.len() + 1) as f32 <= size.y {
            names.insert(layer.name.as_str());
        }
    }
    names
}

/// The corner of the legend of a view, in which its curves seldom are, or where they are oldest.
fn corner(view: View) -> Corner {
    match view {
        View::UpAndDown | View::Map | View::Basins => Corner::RightBottom,
        _ if view.is_over_time() => Corner::LeftBottom,
        _ => Corner::RightTop,
    }
}

/// About the place of a legend with these names in a frame.
fn legend_place(ui: &Ui, style: &Style, frame: Rect, corner: Corner, names: &HashSet<&str>) -> Rect {
    if names.is_empty() {
        return Rect::NOTHING;
    }
    let widest = names.iter().map(|name| width(ui, style, name)).fold(0.0, f32::max);
    let size = vec2(widest + BESIDE_NAME, ROW * names.len() as f32 + 8.0);
    let align = match corner {
        Corner::LeftTop => Align2::LEFT_TOP,
        Corner::RightTop => Align2::RIGHT_TOP,
        Corner::LeftBottom => Align2::LEFT_BOTTOM,
        Corner::RightBottom => Align2::RIGHT_BOTTOM,
    };
    align.align_size_within_rect(size, frame)
}

fn legend(corner: Corner) -> Legend {
    let legend = Legend::default().follow_insertion_order(true).text_style(TextStyle::Small).position(corner);
    legend.color_conflict_handling(ColorConflictHandling::PickFirst)
}

/// Time in s after that of a double click at which a single one is known for certain.
const LATER: f64 = 0.02;

/// A click that may become a double click: its time in s, and what is there.
type Click<T> = Option<(f64, T)>;

/// A plot of a view: its name if the view has several, and the axes whose ends are chosen by hand.
pub struct Part<'a> {
    pub view: View,
    pub name: &'a str,
    pub axes: [Option<Axis>; 2],
}

/// What was clicked, once it is known that the click is a single one.
pub fn single_click<T: Clone + Send + Sync + 'static>(
    ui: &Ui,
    plot: Id,
    response: &Response,
    at: impl FnOnce(Pos2) -> T,
) -> Option<T> {
    let now = ui.input(|input| input.time);
    let delay = ui.ctx().options(|options| options.input_options.max_double_click_delay);
    let mut click: Click<T> = ui.data(|data| data.get_temp(plot)).flatten();
    let known = click.take_if(|(then, _)| now - *then > delay);
    if response.double_clicked() {
        click = None;
    } else if let Some(place) = response.interact_pointer_pos().filter(|_| response.clicked()) {
        click = Some((now, at(place)));
    }
    if known.is_some() {
        // for the views that were drawn before this one
        ui.ctx().request_repaint();
    }
    if let Some((then, _)) = click {
        // a frame after that time, though no pointer moves
        ui.request_repaint_after(Duration::from_secs_f64((then + delay - now).max(0.0) + LATER));
    }
    ui.data_mut(|data| data.insert_temp(plot, click));
    known.map(|(_, at)| at)
}

/// Draws the panel of a view in `area`, with the axes that were chosen for the view by hand.
pub fn plot_ui(
    ui: &mut Ui,
    memory: &mut Memory,
    view: View,
    style: &Style,
    area: Rect,
    panel: &Panel,
) -> Plotted {
    let axes = view.axes().map_or([None; 2], |axes| axes.map(Some));
    part_ui(ui, memory, Part { view, name: "", axes }, style, area, (panel, [None; 2]))
}

/// Draws a panel of a view; the ends of its axes are these unless they were chosen by hand.
pub fn part_ui(
    ui: &mut Ui,
    memory: &mut Memory,
    Part { view, name: part, axes }: Part<'_>,
    style: &Style,
    area: Rect,
    (panel, given): (&Panel, [Option<Ends>; 2]),
) -> Plotted {
    let id = ui.scope_id().with(("plot", view, part));
    let area = area.shrink2(vec2(MARGIN, ABOVE));
    let ends = [0, 1].map(|of| {
        let axis = [&panel.x, &panel.y][of];
        let automatic = given[of].unwrap_or((axis.low, axis.high));
        axes[of].map_or(automatic, |axis| memory.ends_of(axis, automatic))
    });
    let height = (area.height() - LEVEL).max(1.0);
    let counts = [area.width() / APART.0, area.height() / APART.1].map(|count| count.max(2.0) as usize);
    let ticked = |of: usize, ends: (f64, f64)| {
        let axis = [&panel.x, &panel.y][of];
        let is_whole = ends == (axis.low, axis.high);
        if is_whole { axis.with_ticks(counts[of]) } else { axis.zoomed(ends).with_ticks(counts[of]) }
    };
    let name = |of: usize| {
        let length = if of == 1 { height } else { area.width() - UPRIGHT };
        name_within(ui, style, &ticked(of, ends[of]), length)
    };
    // the ticks of both axes, which are asked for before the words at them
    let ticks: [RefCell<Vec<(f64, String)>>; 2] = Default::default();
    let marks = |of: usize| {
        let (ticked, ticks) = (&ticked, &ticks[of]);
        move |input: GridInput| {
            let (low, high) = input.bounds;
            let all = ticked(of, (low, high)).ticks;
            let every =
                if of == 1 { (LEAST * all.len() as f32 / height).ceil().max(1.0) as usize } else { 1 };
            // as the marks are placed: an axis of counts is not even
            let axis = [&panel.x, &panel.y][of];
            let placed = |value: f64| axis.low + axis.share(value) * (axis.high - axis.low);
            let all = all.into_iter().step_by(every).map(|(value, words)| (placed(value), words));
            ticks.replace(all.collect());
            ticks.borrow().iter().map(|tick| GridMark { value: tick.0, step_size: high - low }).collect()
        }
    };
    let words = |of: usize| {
        let ticks = &ticks[of];
        move |mark: GridMark, _: &RangeInclusive<f64>| {
            let ticks = ticks.borrow();
            let near = |tick: &&(f64, String)| (tick.0 - mark.value).abs() < 1e-9 * mark.step_size;
            ticks.iter().find(near).map_or_else(String::new, |tick| tick.1.clone())
        }
    };
    let nearest = RefCell::new(None);
    let label = |position: &HoverPosition<'_>| {
        if let HoverPosition::NearDataPoint { plot_name, position, .. } = position {
            nearest.replace(Some((plot_name.to_string(), (position.x, position.y))));
        }
        None
    };
    let over_time = axes[0] == Some(Axis::Time);
    // time is panned alone, as long as the other axis shows all
    let upright = axes[1].is_some_and(|axis| !over_time || memory.axes.chosen(axis).is_some());
    let has_both = !axes.contains(&None);
    let mut plot = Plot::new("plot")
        .id(id)
        .width(area.width())
        .height(area.height())
        .x_axis_label(if area.height() < NAMELESS { String::new() } else { name(0) })
        .y_axis_label(name(1))
        .y_axis_min_width(UPRIGHT)
        .x_grid_spacer(marks(0))
        .y_grid_spacer(marks(1))
        .x_axis_formatter(words(0))
        .y_axis_formatter(words(1))
        .grid_color(style.grid())
        .grid_fade(0.0)
        .legend(legend(corner(view)))
        .allow_drag([axes[0].is_some(), upright])
        .allow_boxed_zoom(has_both)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_axis_zoom_drag(false)
        .allow_double_click_reset(false)
        .show_crosshair(over_time)
        .show_y(false)
        .cursor_color(style.faint())
        .label_formatter(label);
    if over_time {
        plot = plot.link_cursor(Id::unique("time under the pointer"), [true, false]);
    }
    let names = names(ui, style, panel, vec2(area.width() - UPRIGHT, height));
    let bounds = PlotBounds::from_min_max([ends[0].0, ends[1].0], [ends[0].1, ends[1].1]);
    let shown = ui.scope_builder(UiBuilder::new().max_rect(area), |ui| {
        ui.style_mut().text_styles.insert(TextStyle::Body, style.small());
        plot.show(ui, |plot| {
            plot.set_plot_bounds(bounds);
            for (i, layer) in panel.layers.iter().enumerate() {
                let name = if names.contains(layer.name.as_str()) { &layer.name } else { "" };
                plot.add(LayerItem::new(id.with(i), (name, layer), panel, style, !over_time));
            }
        })
    });
    let (response, transform) = (shown.inner.response, shown.inner.transform);
    let values = |at: Pos2| {
        let PlotPoint { x, y } = transform.value_from_position(at);
        (x, y)
    };
    let legend = legend_place(ui, style, *transform.frame(), corner(view), &names);
    let clicked = single_click(ui, id.with("click"), &response, |at| (values(at), legend.contains(at)));
    let clicked = clicked.filter(|clicked| !clicked.1).map(|clicked| clicked.0);
    let nearest = nearest.into_inner();
    let nearest = nearest.filter(|_| response.hover_pos().is_some_and(|at| !legend.contains(at)));
    let mut plotted = Plotted { response, clicked, transform, legend, nearest };
    let moved = plotted.transform.bounds();
    for (axis, before, now) in [(axes[0], ends[0], moved.range_x()), (axes[1], ends[1], moved.range_y())] {
        let now = (*now.start(), *now.end());
        if let Some(axis) = axis.filter(|_| now != before) {
            memory.axes.choose(axis, (now.0 / axis.per_own(), now.1 / axis.per_own()));
        }
    }
    if axes != [None; 2] {
        zoom_input(ui, memory, (view, axes), &plotted.response, (area, plotted.frame()));
        menu_ui(ui, memory, view, (id.with("menu"), panel), &mut plotted);
    }
    if has_both {
        let name = if part.is_empty() { view.name() } else { part };
        changed_ui(ui, memory, (view, axes), name, (area, plotted.frame()));
    }
    plotted
}

/// The tool in the corner of a picture whose axes were changed, which brings them back.
fn changed_ui(
    ui: &mut Ui,
    memory: &mut Memory,
    (view, axes): (View, [Option<Axis>; 2]),
    name: &str,
    (area, frame): (Rect, Rect),
) {
    if axes.into_iter().flatten().all(|axis| memory.axes.chosen(axis).is_none()) {
        return;
    }
    let corner = Rect::from_min_max(pos2(area.left(), frame.bottom()), pos2(frame.left(), area.bottom()));
    let side = corner.height().min(CONTROL);
    let mut child = ui.new_child(UiBuilder::new().max_rect(corner));
    let name = format!("axes of {name} as they were");
    let hover = "The axes were changed. A click brings them back, as a double click in the picture does.";
    if tool_ui(&mut child, Icon::Restore, side, &name, hover, true).clicked() {
        memory.free_axes(view);
    }
}

/// The menu of a plot. What it sets, it sets as a click would where the menu was asked for.
fn menu_ui(ui: &Ui, memory: &mut Memory, view: View, (id, panel): (Id, &Panel), plotted: &mut Plotted) {
    let response = plotted.response.clone();
    if let Some(at) = plotted.pointed().filter(|_| response.secondary_clicked()) {
        ui.data_mut(|data| data.insert_temp(id, at));
    }
    response.context_menu(|ui| {
        if ui.button("Axes as they were").clicked() {
            memory.free_axes(view);
        }
        if ui.button("Copy values").on_hover_text("What is drawn, as CSV.").clicked() {
            ui.copy_text(values_as_csv(panel));
        }
        if ui.button("Save figure..").clicked() {
            memory.figure = Some(view);
        }
        if let Some(action) = view.action()
            && ui.button(action).clicked()
        {
            plotted.clicked = ui.data(|data| data.get_temp(id));
        }
    });
}
