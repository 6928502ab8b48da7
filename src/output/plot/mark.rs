//! Markers, legends, and the lines above and below a picture.

use super::figure::{Align, Area, Figure, Point, Text, fitted};
use super::font;
use super::style::{self, Ink, Theme};
use crate::scene::Document;

/// A shape that stands for something.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Marker {
    /// A disc.
    Disc,
    /// A square.
    Square,
    /// A square on its corner.
    Diamond,
    /// An arrow to the left and to the right.
    DoubleArrow,
    /// A triangle on its base.
    Triangle,
}

/// The regimes with a colour of their own, in the order of [`Theme::regimes`], and their markers.
pub const REGIMES: [(&str, Marker); 4] = [
    ("rest", Marker::Square),
    ("intrawell", Marker::Disc),
    ("irregular", Marker::Diamond),
    ("interwell", Marker::DoubleArrow),
];

/// Marker and colour of a regime by its word in the tables; ink and a disc where it has none.
pub fn regime(word: &str, theme: &Theme) -> (Marker, Ink) {
    let place = REGIMES.iter().position(|(own, _)| *own == word);
    place.map_or((Marker::Disc, theme.ink), |place| (REGIMES[place].1, theme.regimes[place]))
}

/// Draws a marker with an outline of `edge`; `size` is half its height.
pub fn marker(figure: &mut Figure, marker: Marker, at: Point, size: f64, ink: Ink, edge: Ink) {
    for (size, ink) in [(size + 2.0, edge), (size, ink)] {
        dot(figure, marker, at, size, ink);
    }
}

/// Draws a marker without an outline.
pub fn dot(figure: &mut Figure, marker: Marker, (x, y): Point, size: f64, ink: Ink) {
    let flat = 0.86 * size;
    let polygon = |points: &[Point]| points.iter().map(|(dx, dy)| (x + dx, y + dy)).collect::<Vec<Point>>();
    match marker {
        Marker::Disc => figure.disc((x, y), size, ink),
        Marker::Square => figure.rect(Area::new(x - flat, y - flat, x + flat, y + flat), ink),
        Marker::Diamond => {
            let reach = 1.25 * size;
            figure.polygon(polygon(&[(0.0, -reach), (reach, 0.0), (0.0, reach), (-reach, 0.0)]), ink);
        }
        Marker::Triangle => {
            let (wide, low) = (1.15 * size, 0.85 * size);
            figure.polygon(polygon(&[(0.0, -1.2 * size), (wide, low), (-wide, low)]), ink);
        }
        Marker::DoubleArrow => {
            let (tip, neck, bar) = (1.6 * size, 0.35 * size, 0.32 * size);
            figure.polygon(polygon(&[(-tip, 0.0), (-neck, -size), (-neck, size)]), ink);
            figure.polygon(polygon(&[(tip, 0.0), (neck, -size), (neck, size)]), ink);
            figure.polygon(polygon(&[(-size, -bar), (size, -bar), (size, bar), (-size, bar)]), ink);
        }
    }
}

/// What an entry of a legend shows beside its words.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sample {
    /// A line, dashed where there is a dash.
    Line(Ink, f64, Option<(f64, f64)>),
    /// The same with an outline, as over a map.
    Outlined(Ink, Option<(f64, f64)>),
    /// A marker.
    Marker(Marker, Ink),
    /// A filled patch, hatched where there is a second colour.
    Patch(Ink, Option<Ink>),
    /// A patch with a cross in it.
    Crossed(Ink, Ink),
    /// Two short upright lines.
    Ticks(Ink),
}

/// Draws a row of entries from `left` on at the height `middle`; those that do not fit start another row
/// below. Returns the lower edge.
pub fn legend(
    figure: &mut Figure,
    theme: &Theme,
    entries: &[(Sample, &str)],
    left: f64,
    right: f64,
    middle: f64,
) -> f64 {
    const SAMPLE: f64 = 44.0;
    const GAP: f64 = 12.0;
    const BETWEEN: f64 = 38.0;
    const ROW: f64 = 38.0;
    let (mut x, mut y) = (left, middle);
    for (sample, words) in entries {
        let width = SAMPLE + GAP + font::width(words, style::TICK, false);
        if x > left && x + width > right {
            (x, y) = (left, y + ROW);
        }
        entry(figure, theme, *sample, Area::new(x, y - 12.0, x + SAMPLE, y + 12.0));
        figure.text(Text {
            words: fitted(words, style::TICK, false, right - x - SAMPLE - GAP),
            at: (x + SAMPLE + GAP, y + 0.5 * style::TICK * font::CAPITAL),
            size: style::TICK,
            ink: theme.ink,
            bold: false,
            align: Align::Left,
            upright: false,
        });
        x += width + BETWEEN;
    }
    y + 0.5 * ROW
}

fn entry(figure: &mut Figure, theme: &Theme, sample: Sample, area: Area) {
    let Area { left, top, right, bottom } = area;
    let middle = (0.5 * (left + right), 0.5 * (top + bottom));
    let ends = [(left, middle.1), (right, middle.1)];
    let canvas = Figure::canvas();
    let mut across = |width: f64, ink: Ink, dash: Option<(f64, f64)>| match dash {
        Some(dash) => figure.dashed(&ends, width, ink, dash, canvas),
        None => figure.line(&ends, width, ink, canvas),
    };
    match sample {
        Sample::Line(ink, width, dash) => across(width, ink, dash),
        Sample::Outlined(ink, dash) => {
            across(style::GUIDE + 4.0, style::BLACK, None);
            across(style::GUIDE, ink, dash);
        }
        Sample::Marker(shape, ink) => marker(figure, shape, middle, style::MARKER, ink, theme.ink),
        Sample::Patch(ink, hatch) => {
            figure.rect(area, ink);
            if let Some(hatch) = hatch {
                figure.hatch(area, style::HATCH, hatch);
            }
            outline(figure, area, theme.soft);
        }
        Sample::Crossed(paper, ink) => {
            figure.rect(area, paper);
            cross(figure, area, ink);
            outline(figure, area, theme.soft);
        }
        Sample::Ticks(ink) => {
            for at in [middle.0 - 7.0, middle.0 + 7.0] {
                figure.line(&[(at, top), (at, bottom)], style::LINE, ink, canvas);
            }
        }
    }
}

fn outline(figure: &mut Figure, area: Area, ink: Ink) {
    let Area { left, top, right, bottom } = area;
    let corners = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
    figure.line(&corners, style::GRID, ink, Figure::canvas());
}

/// A cross from corner to corner.
pub fn cross(figure: &mut Figure, area: Area, ink: Ink) {
    let Area { left, top, right, bottom } = area;
    figure.line(&[(left, top), (right, bottom)], style::THIN, ink, area);
    figure.line(&[(left, bottom), (right, top)], style::THIN, ink, area);
}

/// What stands over and under a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Caption {
    /// Over it: the scene's title.
    pub title: String,
    /// Under it: what was run.
    pub footer: String,
}

impl Caption {
    /// The caption of a picture of a document, made by this `version`: its title, where it came from and what
    /// arguments changed.
    pub fn new(document: &Document, version: &str) -> Self {
        let (scene, name) = (&document.scene, &document.name);
        let mut footer =
            format!("interwell {version} \u{b7} {name} \u{b7} tolerance {:e}", scene.run.tolerance);
        for change in document.changes() {
            footer += &format!(" \u{b7} {change}");
        }
        Self { title: scene.title.clone(), footer }
    }

    /// Draws title, subtitle and footer between `left` and the right edge.
    pub fn draw(&self, figure: &mut Figure, theme: &Theme, subtitle: &str, left: f64) {
        let room = f64::from(style::SIZE.0) - left - 30.0;
        let mut row = |words: &str, size: f64, bold: bool, ink: Ink, height: f64| {
            figure.text(Text {
                words: fitted(words, size, bold, room),
                at: (left, height),
                size,
                ink,
                bold,
                align: Align::Left,
                upright: false,
            });
        };
        row(&self.title, style::TITLE, true, theme.ink, 58.0);
        row(subtitle, style::SUBTITLE, false, theme.soft, 100.0);
        row(&self.footer, style::FOOTER, false, theme.soft, f64::from(style::SIZE.1) - 16.0);
    }
}
