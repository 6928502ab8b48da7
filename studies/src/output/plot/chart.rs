//! Picture as data: panels with axes and layers, independent of pixels and colours.
//!
//! The table of a study becomes a [`Chart`]; [`Chart::figure`] lays it out for a screen or a sheet of paper.
//! The [`Role`] of a layer determines its colour, width, dash and marker. The legend contains the layers that
//! have a name.

use serde::{Deserialize, Serialize};

use super::assembly::Assembly;
use super::axis::PlotAxis;
use super::cells::{Colours, Shades};
use super::figure::Point;
use super::role::Role;
use crate::mechanics::{Equilibrium, Landscape};
use crate::study::Table;

/// A picture as data: panels with axes and layers, without pixels and colours. [`figure`](Self::figure) lays
/// it out.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Chart {
    /// The columns of panels, side by side; on a narrow canvas they are stacked.
    pub columns: Vec<PanelColumn>,
    /// A caption in one sentence.
    pub subtitle: String,
    /// The drawn data, one row per point, cell or mark, with its kind in the column `series`.
    pub data: Table,
}

/// Panels one above the other. Neighbours with the same horizontal axis share its numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PanelColumn {
    /// Its width relative to the other columns.
    pub width: f64,
    /// From top to bottom.
    pub panels: Vec<Panel>,
}

/// Layers over two axes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Panel {
    /// Its heading; empty for none.
    pub heading: String,
    /// The horizontal axis.
    pub x: PlotAxis,
    /// The vertical axis.
    pub y: PlotAxis,
    /// The layers, from back to front.
    pub layers: Vec<Layer>,
    /// The axis of the colour scale beside it.
    pub bar: Option<PlotAxis>,
    /// Its height relative to the other panels of the column.
    pub height: f64,
    /// Lines of text below it.
    pub notes: Vec<Note>,
}

/// A line of text, with the marker of a role before it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Note {
    /// The text.
    pub words: String,
    /// The role whose marker stands before it.
    pub role: Option<Role>,
}

/// Marks of one role.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Layer {
    /// The marks, in the units of the axes.
    pub marks: Marks,
    /// Its meaning.
    pub role: Role,
    /// Its words in the legend; empty for none.
    pub name: String,
}

/// A side of a panel or of a wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Side {
    /// To the left.
    Left,
    /// To the right.
    Right,
    /// Above.
    Top,
    /// Below.
    Bottom,
}

/// The marks of a layer. Points that are not finite are left out and interrupt a line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Marks {
    /// A line through points in any order.
    Path(Vec<Point>),
    /// A line through points with ascending x, of which there may be millions.
    Trace(Vec<Point>),
    /// A marker at each point.
    Points(Vec<Point>),
    /// Small markers, whose size decreases with their number.
    Cloud(Vec<Point>),
    /// Small markers, each in the colour of its value.
    Valued(Vec<(Point, f64)>, Colours),
    /// A line from the lower edge to each point.
    Sticks(Vec<Point>),
    /// A line from the second to the third value at each x.
    Intervals(Vec<[f64; 3]>),
    /// The area between the second and the third value over x.
    Band(Vec<[f64; 3]>),
    /// A bar at each y from one x to another; the last number is its height in units of the axis.
    Bars(Vec<[f64; 3]>, f64),
    /// Spans of x over the whole height.
    Spans(Vec<(f64, f64)>),
    /// Lines from the lower to the upper edge.
    Verticals(Vec<f64>),
    /// Lines from the left to the right edge.
    Horizontals(Vec<f64>),
    /// A wall at a value, solid on this side of it.
    Wall(f64, Side),
    /// Short ticks along this edge; close ticks are left out.
    Ticks(Vec<f64>, Side),
    /// Texts beside their places: to the right, or where a line or a marker lies there on another side.
    Words(Vec<(Point, String)>),
    /// A colour for each cell of a grid.
    Cells(Shades),
    /// The cells as a surface in projection, over a third axis.
    Surface(Shades, PlotAxis),
    /// Only an entry of the legend.
    Patch,
    /// Markers of regimes by their words; close markers on a line are left out. No picture with them is ever
    /// written as data, so that it is the last: a message counts the others.
    #[serde(skip)]
    Regimes(Vec<(Point, &'static str)>, bool),
    /// A mechanism as a drawing. As the one before, it is never written as data.
    #[serde(skip)]
    Mechanism(Box<Assembly>),
}

impl Chart {
    /// A chart of panels one above the other.
    pub fn stack(panels: Vec<Panel>, subtitle: impl Into<String>, data: Table) -> Self {
        Self { columns: vec![PanelColumn { width: 1.0, panels }], subtitle: subtitle.into(), data }
    }

    /// The first panel.
    pub fn first_panel(&mut self) -> Option<&mut Panel> {
        self.columns.first_mut()?.panels.first_mut()
    }

    /// All panels, column by column.
    pub fn panels(&self) -> impl Iterator<Item = &Panel> {
        self.columns.iter().flat_map(|column| &column.panels)
    }
}

impl Layer {
    /// Marks of a role, with their words in the legend.
    pub fn new(role: Role, name: &str, marks: Marks) -> Self {
        Self { marks, role, name: name.to_owned() }
    }

    /// A curve, `y` over x from one of its `points` to the next: dashed beyond these stops.
    pub fn curve(name: &str, mut points: Vec<Point>, stops: (f64, f64), y: impl Fn(f64) -> f64) -> Vec<Self> {
        let ends = points.first().zip(points.last()).map_or((0.0, 0.0), |(first, last)| (first.0, last.0));
        let faces = [stops.0, stops.1].into_iter().filter(|stop| *stop > ends.0 && *stop < ends.1);
        points.extend(faces.map(|stop| (stop, y(stop))));
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let part = |role, name: &str, is_in: &dyn Fn(f64) -> bool| {
            let points = points.iter().copied().filter(|point| is_in(point.0)).collect();
            Self::new(role, name, Marks::Path(points))
        };
        let mut layers = vec![
            part(Role::Beyond, "beyond the stops", &|x| x <= stops.0),
            part(Role::Beyond, "beyond the stops", &|x| x >= stops.1),
        ];
        layers.retain(|layer| matches!(&layer.marks, Marks::Path(points) if points.len() > 1));
        layers.push(part(Role::Curve, name, &|x| !(x < stops.0 || x > stops.1)));
        layers
    }
}

impl Panel {
    /// A panel without layers.
    pub fn new(x: PlotAxis, y: PlotAxis) -> Self {
        Self { heading: String::new(), x, y, layers: Vec::new(), bar: None, height: 1.0, notes: Vec::new() }
    }

    /// Whether a point lies within both axes.
    pub fn contains(&self, (x, y): Point) -> bool {
        self.x.contains(x) && self.y.contains(y)
    }

    /// Whether a part of a layer may lie within the axes; true for a layer that is only an entry of the
    /// legend.
    pub fn shows(&self, layer: &Layer) -> bool {
        let reaches = |axis: &PlotAxis, a: f64, b: f64| a.max(b) >= axis.low && a.min(b) <= axis.high;
        // a segment counts if its bounding box and the frame overlap
        let is_crossed = |points: &[Point]| {
            points.len() < 2
                || points.windows(2).any(|pair| {
                    reaches(&self.x, pair[0].0, pair[1].0) && reaches(&self.y, pair[0].1, pair[1].1)
                })
        };
        let spans_x = |rows: &[[f64; 3]]| rows.iter().any(|row| self.x.contains(row[0]));
        match &layer.marks {
            Marks::Points(points) | Marks::Cloud(points) => {
                points.is_empty() || points.iter().any(|point| self.contains(*point))
            }
            Marks::Valued(points, _) => points.iter().any(|(point, _)| self.contains(*point)),
            Marks::Path(points) | Marks::Trace(points) => is_crossed(points),
            Marks::Sticks(points) => points.iter().any(|point| self.x.contains(point.0)),
            Marks::Intervals(rows) => spans_x(rows),
            Marks::Band(rows) => rows.windows(2).any(|pair| reaches(&self.x, pair[0][0], pair[1][0])),
            Marks::Spans(spans) => spans.is_empty() || spans.iter().any(|(a, b)| reaches(&self.x, *a, *b)),
            Marks::Verticals(values) | Marks::Ticks(values, _) => {
                values.iter().any(|value| self.x.contains(*value))
            }
            Marks::Horizontals(values) => values.iter().any(|value| self.y.contains(*value)),
            Marks::Wall(..)
            | Marks::Regimes(..)
            | Marks::Bars(..)
            | Marks::Words(_)
            | Marks::Cells(_)
            | Marks::Surface(..)
            | Marks::Mechanism(_)
            | Marks::Patch => true,
        }
    }

    /// Adds a layer without an entry in the legend.
    pub fn draw(&mut self, role: Role, marks: Marks) {
        self.layer(role, "", marks);
    }

    /// Adds a layer with its words in the legend.
    pub fn layer(&mut self, role: Role, name: impl Into<String>, marks: Marks) {
        self.layers.push(Layer { marks, role, name: name.into() });
    }

    /// Adds a layer with its words in the legend, unless it is a list of points, places, intervals or spans
    /// without any.
    pub fn layer_if_any(&mut self, role: Role, name: impl Into<String>, marks: Marks) {
        let is_empty = match &marks {
            Marks::Path(points) | Marks::Points(points) | Marks::Cloud(points) => points.is_empty(),
            Marks::Verticals(at) | Marks::Horizontals(at) | Marks::Ticks(at, _) => at.is_empty(),
            Marks::Intervals(rows) | Marks::Bars(rows, _) => rows.is_empty(),
            Marks::Spans(spans) => spans.is_empty(),
            _ => false,
        };
        if !is_empty {
            self.layer(role, name, marks);
        }
    }

    /// Adds the stops that lie in the range of the horizontal axis, in its units.
    pub fn upright_stops(&mut self, stops: (f64, f64)) {
        for (at, side) in [(stops.0, Side::Left), (stops.1, Side::Right)] {
            if self.x.contains(at) {
                self.layer(Role::Stop, "stop", Marks::Wall(at, side));
            }
        }
    }

    /// Adds the equilibria of a landscape that lie in the range of the horizontal axis, in mm, each at this
    /// height.
    pub fn equilibria(&mut self, landscape: &Landscape, height: impl Fn(&Equilibrium) -> f64) {
        for (stable, role, name) in
            [(true, Role::Stable, "stable equilibrium"), (false, Role::Unstable, "unstable equilibrium")]
        {
            let of_kind = landscape.equilibria.iter().filter(|equilibrium| equilibrium.stable == stable);
            let points = of_kind.map(|equilibrium| (equilibrium.x * 1e3, height(equilibrium)));
            let points = points.filter(|point| self.x.contains(point.0)).collect();
            self.layer_if_any(role, name, Marks::Points(points));
        }
    }

    /// Adds the stops that lie in the range of the vertical axis, in its units.
    pub fn level_stops(&mut self, stops: (f64, f64)) {
        for (at, side) in [(stops.0, Side::Bottom), (stops.1, Side::Top)] {
            if self.y.contains(at) {
                self.layer(Role::Stop, "stop", Marks::Wall(at, side));
            }
        }
    }
}
