//! Layout of the panels of a chart in columns and rows, with room for numbers and labels of axes beside and
//! below the frames.

use super::axis::PlotAxis;
use super::cells::{Colours, Shades};
use super::chart::{Chart, Layer, Marks, Panel, PanelColumn};
use super::figure::{Align, Area, Figure, Text};
use super::font;
use super::frame::Frame;
use super::mark::marker;
use super::page::{Lines, wrapped};
use super::style::{self, Theme};
use super::surface::{self, Labels};

/// Height of a heading above a panel.
const HEADING: f64 = 46.0;
/// Height of a line of a note below a panel.
const NOTE: f64 = 36.0;
/// Height of the numbers below a panel.
const NUMBERS: f64 = style::TICK_LENGTH + 8.0 + 0.75 * style::TICK;
/// Height of a line of the label below a panel.
const LABEL: f64 = 38.0;
/// Distance from the frame to the numbers beside it.
const TO_NUMBERS: f64 = style::TICK_LENGTH + 7.0;
/// Distance from the numbers to the label beside them.
const TO_LABEL: f64 = 8.0;
/// Width of a line of the label beside a panel.
const LABEL_WIDTH: f64 = 36.0;
/// Distance of a colour bar from the frame, and its width.
const BAR: (f64, f64) = (22.0, 30.0);
/// Vertical distance of two panels.
const BETWEEN: f64 = 22.0;
/// Horizontal distance of two columns.
const BETWEEN_COLUMNS: f64 = 26.0;
/// Smallest width of a frame.
const MIN_WIDTH: f64 = 60.0;
/// Usual size of a frame, with which the layout begins.
const USUAL: f64 = 230.0;
/// Largest share of the canvas for the numbers or names of a vertical axis; longer ones are drawn smaller.
const MAX_NUMBERS_SHARE: f64 = 0.3;
/// Room for a tick on a vertical and on a horizontal axis.
const TICK_ROOM: (f64, f64) = (75.0, 130.0);

/// A panel with its layout.
pub struct Slot<'a> {
    panel: &'a Panel,
    /// Its axes, with as many ticks as they have room for.
    x: PlotAxis,
    y: PlotAxis,
    /// The axis and the colours of the bar to its right: its own, or that of the panel to its left with the
    /// same vertical axis, so that the name of the bar does not stand beside that axis.
    bar: Option<(PlotAxis, &'a Colours)>,
    /// Whether the axes show numbers and a label; otherwise they share those of a neighbour.
    shows_x: bool,
    shows_y: bool,
    x_label: Lines,
    y_label: Lines,
    bar_label: Lines,
    /// The labels of a surface.
    labels: Labels,
    /// Room for the numbers of the vertical axis.
    numbers: f64,
    /// Additional width of its frame compared with the column, if it has no colour bar.
    more: f64,
    /// Place of the frame.
    area: Area,
}

/// A column of slots, with the width of its frames and the room beside them.
#[derive(Default)]
struct Stack<'a> {
    slots: Vec<Slot<'a>>,
    share: f64,
    left: f64,
    right: f64,
    width: f64,
    /// The height of a panel of height 1.
    unit: f64,
}

/// Heights of a row of panels: above the frame, of the frame in proportion, and below the frame.
#[derive(Clone, Copy, Default)]
struct Row {
    over: f64,
    height: f64,
    under: f64,
}

/// The layout of the panels of a chart.
pub struct PanelGrid<'a> {
    stacks: Vec<Stack<'a>>,
    /// Whether the panels of a row are aligned vertically.
    aligned: bool,
    /// Where the first column begins.
    begin: f64,
}

impl<'a> PanelGrid<'a> {
    /// The panels of a chart; on a narrow canvas all in one column.
    pub fn new(chart: &'a Chart, narrow: bool) -> Self {
        let of_column = |column: &'a PanelColumn| (column.width, column.panels.iter().collect());
        let columns: Vec<(f64, Vec<&Panel>)> = match narrow {
            true => vec![(1.0, chart.panels().collect())],
            false => chart.columns.iter().map(of_column).collect(),
        };
        let total: f64 = columns.iter().map(|column| column.0).sum();
        let mut stacks: Vec<Stack> = Vec::new();
        for (share, panels) in columns {
            let beside = stacks.last();
            let slot = |(i, panel): (usize, &&'a Panel)| {
                let shares_x =
                    |next: &&&Panel| next.x == panel.x && next.heading.is_empty() && panel.notes.is_empty();
                let left = beside.and_then(|stack| stack.slots.get(i));
                Slot {
                    panel,
                    x: panel.x.clone(),
                    y: panel.y.clone(),
                    bar: panel.bar.clone().zip(panel.cells().map(|cells| &cells.colours)),
                    shows_x: panels.get(i + 1).filter(shares_x).is_none(),
                    shows_y: left.is_none_or(|left| left.panel.y != panel.y),
                    x_label: Lines::default(),
                    y_label: Lines::default(),
                    bar_label: Lines::default(),
                    labels: Labels::default(),
                    numbers: 0.0,
                    more: 0.0,
                    area: Area::new(0.0, 0.0, 0.0, 0.0),
                }
            };
            let mut slots: Vec<Slot> = panels.iter().enumerate().map(slot).collect();
            if let Some(beside) = stacks.last_mut() {
                for (left, slot) in beside.slots.iter_mut().zip(&mut slots) {
                    if !slot.shows_y && slot.bar.is_none() {
                        slot.bar = left.bar.take();
                    }
                }
            }
            stacks.push(Stack { slots, share: share / total, unit: USUAL, ..Stack::default() });
        }
        let aligned = stacks.iter().flat_map(|stack| &stack.slots).any(|slot| !slot.shows_y);
        Self { stacks, aligned, begin: 0.0 }
    }

    /// Finds the sizes of the frames between these edges and within this height, in which a panel of height 1
    /// has at least `least`; returns the height that is needed.
    pub fn fit(&mut self, (left, right): (f64, f64), height: f64, least: f64) -> f64 {
        self.begin = left;
        let mut needed = height;
        // the ticks depend on the size of the frames, which depends on the room for the ticks
        for _ in 0..3 {
            let last = self.stacks.len().saturating_sub(1);
            let most = MAX_NUMBERS_SHARE * (right - left);
            for (i, stack) in self.stacks.iter_mut().enumerate() {
                stack.measure(most, (if i == 0 { left } else { 0.0 }, if i == last { left } else { 0.0 }));
            }
            let beside: f64 = self.stacks.iter().map(|stack| stack.left + stack.right).sum();
            let frames = right - left - beside - BETWEEN_COLUMNS * last as f64;
            self.stacks.iter_mut().for_each(|stack| stack.width = (frames * stack.share).max(MIN_WIDTH));
            let rows: Vec<Vec<Row>> = (0..self.stacks.len()).map(|column| self.rows(column)).collect();
            let fixed = |rows: &[Row]| rows.iter().map(|row| row.over + row.under).sum::<f64>();
            let weights = |rows: &[Row]| rows.iter().map(|row| row.height).sum::<f64>();
            needed = rows.iter().map(|rows| fixed(rows) + least * weights(rows)).fold(height, f64::max);
            for (stack, rows) in self.stacks.iter_mut().zip(&rows) {
                stack.unit = (needed - fixed(rows)) / weights(rows).max(1e-3);
            }
        }
        needed
    }

    /// The rows of a column; where rows are aligned, those of all columns.
    fn rows(&self, column: usize) -> Vec<Row> {
        if !self.aligned {
            let stack = &self.stacks[column];
            return (0..stack.slots.len()).map(|i| stack.row(i)).collect();
        }
        let count = self.stacks.iter().map(|stack| stack.slots.len()).max().unwrap_or(0);
        let largest = |i: usize| {
            let rows = self.stacks.iter().filter(|stack| i < stack.slots.len()).map(|stack| stack.row(i));
            rows.fold(Row::default(), |a, b| Row {
                over: a.over.max(b.over),
                height: a.height.max(b.height),
                under: a.under.max(b.under),
            })
        };
        (0..count).map(largest).collect()
    }

    /// The slots with their places below `top`.
    pub fn place(mut self, top: f64) -> impl Iterator<Item = Slot<'a>> {
        let mut begin = self.begin;
        for column in 0..self.stacks.len() {
            let rows = self.rows(column);
            let stack = &mut self.stacks[column];
            let (left, right) = (begin + stack.left, begin + stack.left + stack.width);
            begin = right + stack.right + BETWEEN_COLUMNS;
            let mut y = top;
            for (slot, row) in stack.slots.iter_mut().zip(rows) {
                y += row.over;
                let height = stack.unit * row.height;
                slot.area = Area::new(left, y, right + slot.more, y + height);
                y += height + row.under;
            }
        }
        self.stacks.into_iter().flat_map(|stack| stack.slots)
    }
}

/// Smallest relative size at which a label is kept in one line.
const ONE_LINE: f64 = 0.85;
/// Smallest relative size at which a label that would need three lines has two.
const TWO_LINES: f64 = 0.7;

impl Lines {
    /// The label of an axis in lines no longer than `room`. It is drawn smaller if it then fits in one line
    /// or in two, or if a word is too long.
    fn of_axis(axis: &PlotAxis, room: f64) -> Self {
        let fits = |words: &str| (room / font::width(words, style::AXIS, false).max(1.0)).min(1.0);
        let whole = fits(&axis.label);
        let share =
            if whole >= ONE_LINE { whole } else { axis.label.split(' ').map(fits).fold(1.0, f64::min) };
        let lines = |share: f64| wrapped(&axis.label, share * style::AXIS, false, room + 1e-6).len();
        // a smaller size where two lines then do
        let smaller = (0..).map(|i| share - 0.05 * f64::from(i)).take_while(|share| *share >= TWO_LINES);
        let share = smaller.into_iter().find(|share| lines(*share) <= 2).unwrap_or(share);
        let size = share * style::AXIS;
        // the measured width may exceed the room by a rounding error
        let mut lines = wrapped(&axis.label, size, false, room + 1e-6);
        lines.retain(|line| !line.is_empty());
        Self { lines, size }
    }

    /// The room that its lines take, each of this `line`.
    pub fn across(&self, line: f64) -> f64 {
        line * self.lines.len() as f64
    }
}

impl Stack<'_> {
    /// Finds ticks and labels for the present sizes, and the room that they take; the canvas has these spare
    /// edges to the left and to the right.
    fn measure(&mut self, most: f64, (spare_left, spare_right): (f64, f64)) {
        (self.left, self.right) = (0.0, 0.0);
        let mut numbers: f64 = 0.0;
        for slot in &mut self.slots {
            let height = self.unit * slot.panel.height;
            let count = (height / TICK_ROOM.0).round().clamp(2.0, 8.0) as usize;
            slot.y = slot.panel.y.with_ticks(count);
            if slot.shows_y && slot.panel.surface().is_none() {
                numbers = numbers.max(slot.y.widest_number().min(most));
            }
            slot.bar = slot.bar.take().map(|(axis, colours)| (axis.with_ticks(count), colours));
            let count = (self.width / TICK_ROOM.1).round().clamp(2.0, 9.0) as usize;
            slot.x = slot.panel.x.with_ticks(count);
            let along = height + BETWEEN - 6.0;
            slot.y_label = if slot.shows_y { Lines::of_axis(&slot.y, along) } else { Lines::default() };
            let under = self.width.max(USUAL) + 10.0;
            slot.x_label = if slot.shows_x { Lines::of_axis(&slot.x, under) } else { Lines::default() };
            if let Some((_, up)) = slot.panel.surface() {
                slot.labels = Labels::new([&slot.x, &slot.y, up], (self.width.max(USUAL), height));
            }
            if let Some((axis, _)) = &slot.bar {
                slot.bar_label = Lines::of_axis(axis, along);
                let label = slot.bar_label.across(LABEL_WIDTH);
                let right = BAR.0 + BAR.1 + TO_NUMBERS + axis.widest_number() + TO_LABEL + label;
                self.right = self.right.max(right);
            }
            // half of the first and of the last number may stand beside the frame
            let half = |tick: Option<&(f64, String)>| {
                let width = tick.map_or(0.0, |tick| font::width(&tick.1, style::TICK, false));
                if slot.shows_x { 0.5 * width } else { 0.0 }
            };
            self.left = self.left.max(half(slot.x.ticks.first()) - spare_left + 2.0);
            self.right = self.right.max(half(slot.x.ticks.last()) - spare_right + 2.0);
        }
        // a frame without a colour bar takes its room, unless a frame with the same axis has a bar
        let barred: Vec<PlotAxis> =
            self.slots.iter().filter(|slot| slot.bar.is_some()).map(|slot| slot.panel.x.clone()).collect();
        for slot in &mut self.slots {
            let number = slot.x.ticks.last().map_or(0.0, |tick| font::width(&tick.1, style::TICK, false));
            let is_free = slot.bar.is_none() && !barred.contains(&slot.panel.x);
            slot.more = if is_free { (self.right - 0.5 * number).max(0.0) } else { 0.0 };
        }
        // labels of a column are aligned
        for slot in &mut self.slots {
            slot.numbers = if slot.shows_y { numbers } else { 0.0 };
            if slot.panel.surface().is_none() {
                let before = if slot.numbers > 0.0 { TO_NUMBERS + slot.numbers + TO_LABEL } else { 0.0 };
                self.left = self.left.max(before + slot.y_label.across(LABEL_WIDTH));
            }
        }
    }

    fn row(&self, i: usize) -> Row {
        let slot = &self.slots[i];
        let heading = if slot.panel.heading.is_empty() { 0.0 } else { HEADING };
        // a number stands at the upper edge of a frame
        let over = if i == 0 { heading.max(14.0) } else { heading + BETWEEN };
        let (more, axis) = match slot.panel.surface() {
            Some(_) => slot.labels.room(),
            None if slot.shows_x => (0.0, NUMBERS + slot.x_label.across(LABEL) + 8.0),
            None => (0.0, 0.0),
        };
        let over = over + more;
        Row { over, height: slot.panel.height, under: axis + NOTE * slot.panel.notes.len() as f64 }
    }
}

impl Panel {
    /// The cells of its surface and the axis of their heights.
    pub fn surface(&self) -> Option<(&Shades, &PlotAxis)> {
        self.layers.iter().find_map(|layer| match &layer.marks {
            Marks::Surface(cells, axis) => Some((cells, axis)),
            _ => None,
        })
    }

    /// The cells of its map.
    pub fn cells(&self) -> Option<&Shades> {
        self.layers.iter().find_map(|layer| match &layer.marks {
            Marks::Cells(cells) => Some(cells),
            _ => None,
        })
    }
}

impl Slot<'_> {
    /// Draws the panel in its place, with its axes, its heading and its notes.
    pub fn draw(&self, figure: &mut Figure, theme: &Theme) {
        let Area { left, top, right, .. } = self.area;
        match self.panel.surface() {
            Some((cells, up)) => {
                let axes = [&self.x, &self.y, up];
                surface::draw(figure, self.area, axes, &self.labels, cells, theme);
            }
            None => self.draw_frame(figure, theme),
        }
        if !self.panel.heading.is_empty() {
            let share = ((right - left) / font::width(&self.panel.heading, style::TICK, true)).min(1.0);
            let text = Text::new(&self.panel.heading, (left, top - 14.0), share * style::TICK, theme.ink);
            figure.text(Text { bold: true, ..text });
        }
        let under = if self.shows_x { NUMBERS + self.x_label.across(LABEL) + 8.0 } else { 0.0 };
        for (i, note) in self.panel.notes.iter().enumerate() {
            let y = self.area.bottom + under + NOTE * i as f64;
            let mut x = left;
            if let Some(role) = note.role {
                let look = theme.look(role);
                marker(figure, look.marker, (x + 14.0, y + 0.5 * NOTE), style::MARKER, look.ink, theme.ink);
                x += 38.0;
            }
            let share = ((right - x) / font::width(&note.words, style::TICK, false)).min(1.0);
            figure.text(Text::new(&note.words, (x, y + 0.75 * NOTE), share * style::TICK, theme.ink));
        }
    }

    fn draw_frame(&self, figure: &mut Figure, theme: &Theme) {
        let area = self.area;
        let frame = Frame { area, x: self.x.clone(), y: self.y.clone() };
        let is_under = |layer: &&Layer| {
            matches!(layer.marks, Marks::Band(_) | Marks::Spans(_) | Marks::Cells(_) | Marks::Patch)
        };
        let layers = &self.panel.layers;
        layers.iter().filter(is_under).for_each(|layer| frame.layer(figure, layer, theme));
        if self.panel.cells().is_none() {
            frame.grid(figure, theme);
        }
        layers.iter().filter(|layer| !is_under(layer)).for_each(|layer| frame.layer(figure, layer, theme));
        frame.ticks(figure, theme, self.shows_x, self.shows_y.then_some(self.numbers));
        figure.frames.push(frame);
        let centred = |words: &str, at: (f64, f64), size: f64, upright: bool| Text {
            upright,
            ..Text::new(words, at, size, theme.ink).aligned(Align::Centre)
        };
        let middle = (0.5 * (area.left + area.right), 0.5 * (area.top + area.bottom));
        for (i, line) in self.x_label.lines.iter().enumerate() {
            let at = (middle.0, area.bottom + NUMBERS + LABEL * (i as f64 + 0.8));
            figure.text(centred(line, at, self.x_label.size, false));
        }
        let numbers = if self.numbers > 0.0 { TO_NUMBERS + self.numbers + TO_LABEL } else { 0.0 };
        for (i, line) in self.y_label.lines.iter().enumerate() {
            let x = area.left - numbers - LABEL_WIDTH * (self.y_label.lines.len() - 1 - i) as f64 - 8.0;
            figure.text(centred(line, (x, middle.1), self.y_label.size, true));
        }
        if let Some((axis, colours)) = &self.bar {
            let from = area.right + BAR.0;
            let place = Area::new(from, area.top, from + BAR.1, area.bottom);
            colours.bar(figure, place, axis, theme);
            for (i, line) in self.bar_label.lines.iter().enumerate() {
                let begin = place.right + TO_NUMBERS + axis.widest_number() + TO_LABEL;
                let x = begin + LABEL_WIDTH * (i as f64 + 0.75);
                figure.text(centred(line, (x, middle.1), self.bar_label.size, true));
            }
        }
    }
}
