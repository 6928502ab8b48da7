//! Markers, legends, and the captions above and below a picture.

use serde_json::{Map, Value, json};

use super::figure::{Area, Figure, Point};
use super::font;
use super::page::wrapped_to;
use super::role::Look;
use super::style::{self, Ink, Theme};
use crate::output::manifest::origin;
use crate::scene::{Document, PROGRAM};

/// The shape of a marker.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Marker {
    Disc,
    Square,
    Diamond,
    /// An arrow to the left and to the right.
    DoubleArrow,
    Triangle,
    /// Two bars across each other.
    Cross,
}

/// The regimes with a colour of their own, in the order of [`Theme::regimes`], and their markers.
pub const REGIMES: [(&str, Marker); 5] = [
    ("rest", Marker::Square),
    ("intrawell", Marker::Disc),
    ("irregular", Marker::Diamond),
    ("interwell", Marker::DoubleArrow),
    ("crossing", Marker::Triangle),
];

/// The word of a regime as a picture has it.
pub fn regime_words(name: &str) -> &str {
    if name == "rest" { "at rest" } else { name }
}

/// Draws a marker with an outline of `edge`; `size` is half its height.
pub fn marker(figure: &mut Figure, marker: Marker, at: Point, size: f64, ink: Ink, edge: Ink) {
    for (size, ink) in [(size + 2.0, edge), (size, ink)] {
        dot(figure, marker, at, size, ink);
    }
}

/// Draws a marker without an outline.
pub fn dot(figure: &mut Figure, marker: Marker, (x, y): Point, size: f64, ink: Ink) {
    let (flat, reach, wide, low) = (0.86 * size, 1.25 * size, 1.15 * size, 0.85 * size);
    let mut polygon = |points: &[Point]| {
        figure.polygon(points.iter().map(|(dx, dy)| (x + dx, y + dy)).collect(), ink);
    };
    match marker {
        Marker::Disc => figure.disc((x, y), size, ink),
        // a polygon, since rectangles are rounded to whole pixels
        Marker::Square => polygon(&[(-flat, -flat), (flat, -flat), (flat, flat), (-flat, flat)]),
        Marker::Diamond => polygon(&[(0.0, -reach), (reach, 0.0), (0.0, reach), (-reach, 0.0)]),
        Marker::Triangle => polygon(&[(0.0, -1.2 * size), (wide, low), (-wide, low)]),
        Marker::Cross => {
            let (near, far) = (0.55 * size, 0.95 * size);
            for way in [1.0, -1.0] {
                let bar = [(-far, -near), (-near, -far), (far, near), (near, far)];
                polygon(&bar.map(|(dx, dy)| (way * dx, dy)));
            }
        }
        Marker::DoubleArrow => {
            let (tip, neck, bar) = (1.6 * size, 0.35 * size, 0.32 * size);
            polygon(&[(-tip, 0.0), (-neck, -size), (-neck, size)]);
            polygon(&[(tip, 0.0), (neck, -size), (neck, size)]);
            polygon(&[(-size, -bar), (size, -bar), (size, bar), (-size, bar)]);
        }
    }
}

/// The sample of an entry of a legend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sample {
    Line(Look),
    Marker(Look),
    Patch(Look),
    /// A patch as that of a missing cell.
    Missing,
    /// Two short upright lines.
    Ticks(Ink),
}

/// Draws the sample of an entry in `area`.
pub fn entry(figure: &mut Figure, theme: &Theme, sample: Sample, area: Area) {
    let Area { left, top, right, bottom } = area;
    let middle = (0.5 * (left + right), 0.5 * (top + bottom));
    let canvas = figure.canvas;
    match sample {
        Sample::Line(look) => figure.styled(&[(left, middle.1), (right, middle.1)], &look, canvas),
        Sample::Marker(look) => mark(figure, &look, middle, style::MARKER, theme),
        Sample::Patch(look) => {
            figure.filled(area, look.ink, look.hatch);
            figure.outline(area, style::GRID, theme.soft);
        }
        Sample::Missing => {
            figure.missing(area, theme);
            figure.outline(area, style::GRID, theme.soft);
        }
        Sample::Ticks(ink) => {
            for at in [middle.0 - 7.0, middle.0 + 7.0] {
                figure.line(&[(at, top), (at, bottom)], style::LINE, ink, canvas);
            }
        }
    }
}

/// Draws the marker of a look, with an outline.
pub fn mark(figure: &mut Figure, look: &Look, at: Point, size: f64, theme: &Theme) {
    if let Some(halo) = look.halo {
        dot(figure, look.marker, at, size + 5.0, theme.ink);
        marker(figure, look.marker, at, size, look.ink, halo);
        return;
    }
    marker(figure, look.marker, at, size, look.ink, if size < 5.0 { theme.paper } else { theme.ink });
    if look.hollow {
        dot(figure, look.marker, at, size - 3.0, theme.paper);
    }
}

/// Captions of a picture.
///
/// [`Chart::figure`](super::Chart::figure) takes it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Caption {
    /// Over it: the scene's title.
    pub title: String,
    /// Under it: what was run.
    pub footer: String,
    /// Provenance, for the file of the picture.
    pub origin: Map<String, Value>,
}

/// Approximate largest number of lines of a footer.
const MAX_FOOTER_LINES: usize = 8;

/// Separator of the parts of a footer.
const PART: &str = " \u{b7} ";

impl Caption {
    /// The caption of a picture of a document, made by this `version`: its title, where it came from and what
    /// arguments changed.
    pub fn new(document: &Document, version: &str) -> Self {
        let (scene, name) = (&document.scene, &document.name);
        let mut footer = format!("interwell {version}{PART}{name}{PART}tolerance {:e}", scene.run.tolerance);
        document.changes().for_each(|change| footer += &format!("{PART}{change}"));
        Self { title: scene.title.clone(), footer, origin: origin(document, version) }
    }

    /// The caption with other scenes, called by letters, at its foot.
    #[must_use]
    pub fn with_others<'a>(mut self, others: impl IntoIterator<Item = &'a Document>) -> Self {
        for (letter, other) in ('A'..).zip(others) {
            self.footer += &format!("{PART}{letter}: {}", other.name);
            other.changes().for_each(|change| self.footer += &format!(", {change}"));
        }
        self
    }

    /// The caption of a picture of what was identified from the record in a file called `name`, made by this
    /// `version`.
    pub fn of_record(name: &str, of: &str, version: &str) -> Self {
        let footer = format!("interwell {version}{PART}identify {name} --of {of}");
        let origin = json!({ "program": PROGRAM, "version": version, "record": name, "of": of });
        Self::of(name, footer, &origin)
    }

    /// The caption of a picture without a scene, with the names and values of its provenance.
    pub fn of(title: &str, footer: String, origin: &Value) -> Self {
        let origin = origin.as_object().cloned().unwrap_or_default();
        Self { title: title.to_owned(), footer, origin }
    }

    /// The footer in lines no longer than `room`, broken between its parts if possible.
    pub fn footer_lines(&self, room: f64) -> Vec<String> {
        let fits = |words: &str| font::width(words, style::FOOTER, false) <= room;
        let mut lines: Vec<String> = Vec::new();
        for part in self.footer.split(PART) {
            match lines.last_mut() {
                Some(line) if fits(&format!("{line}{PART}{part}")) => *line += &format!("{PART}{part}"),
                _ => lines.push(part.to_owned()),
            }
        }
        let most = MAX_FOOTER_LINES.saturating_sub(lines.len() - 1).max(1);
        lines.truncate(MAX_FOOTER_LINES);
        lines.iter().flat_map(|line| wrapped_to(line, style::FOOTER, false, room, most)).collect()
    }
}
