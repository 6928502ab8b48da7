//! Markers, legends, and the lines above and below a picture.

use serde_json::{Map, Value, json};

use super::figure::{Area, Figure, Point, Text, fitted};
use super::font;
use super::style::{self, Ink, Theme};
use crate::output::manifest::origin;
use crate::scene::{Document, PROGRAM};

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
    let place = REGIMES.iter().position(|(regime, _)| *regime == word);
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

/// Width of a legend's sample, and its distance from the words.
const SAMPLE: f64 = 44.0;
const GAP: f64 = 12.0;
/// From one row of a legend to the next.
const ROW: f64 = 38.0;

/// Where the entries of a legend between `left` and `right` begin, each with its row: those that do not fit
/// start another one.
fn laid_out(entries: &[(Sample, &str)], left: f64, right: f64) -> Vec<(f64, usize)> {
    const BETWEEN: f64 = 38.0;
    let (mut x, mut row) = (left, 0);
    let place = |(_, words): &(Sample, &str)| {
        let width = SAMPLE + GAP + font::width(words, style::TICK, false);
        if x > left && x + width > right {
            (x, row) = (left, row + 1);
        }
        let place = (x, row);
        x += width + BETWEEN;
        place
    };
    entries.iter().map(place).collect()
}

/// Draws rows of entries, the first one at the height `middle`, between these ends; on a narrow canvas from
/// edge to edge. A sheet that leaves its height open becomes higher by the rows after the first, so a legend
/// comes before the frames. Returns the lower edge.
pub fn legend(
    figure: &mut Figure,
    theme: &Theme,
    entries: &[(Sample, &str)],
    ends: (f64, f64),
    middle: f64,
) -> f64 {
    let (left, right) = figure.breadth(ends);
    let places = laid_out(entries, left, right);
    let rows = places.last().map_or(0, |place| place.1);
    figure.grow(ROW * rows as f64);
    for ((sample, words), (x, row)) in entries.iter().zip(places) {
        let y = middle + ROW * row as f64;
        entry(figure, theme, *sample, Area::new(x, y - 12.0, x + SAMPLE, y + 12.0));
        let words = fitted(words, style::TICK, false, right - x - SAMPLE - GAP);
        let at = (x + SAMPLE + GAP, y + 0.5 * style::TICK * font::CAPITAL);
        figure.text(Text::new(words, at, style::TICK, theme.ink));
    }
    middle + ROW * (rows as f64 + 0.5)
}

fn entry(figure: &mut Figure, theme: &Theme, sample: Sample, area: Area) {
    let Area { left, top, right, bottom } = area;
    let middle = (0.5 * (left + right), 0.5 * (top + bottom));
    let ends = [(left, middle.1), (right, middle.1)];
    let canvas = figure.canvas;
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
                figure.hatch(area, hatch);
            }
            figure.outline(area, style::GRID, theme.soft);
        }
        Sample::Crossed(paper, ink) => {
            figure.rect(area, paper);
            cross(figure, area, ink);
            figure.outline(area, style::GRID, theme.soft);
        }
        Sample::Ticks(ink) => {
            for at in [middle.0 - 7.0, middle.0 + 7.0] {
                figure.line(&[(at, top), (at, bottom)], style::LINE, ink, canvas);
            }
        }
    }
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
    /// What made it, for the picture's file.
    pub origin: Map<String, Value>,
}

/// What stands between the parts of a footer.
const PART: &str = " \u{b7} ";

impl Caption {
    /// The caption of a picture of a document, made by this `version`: its title, where it came from and what
    /// arguments changed.
    pub fn new(document: &Document, version: &str) -> Self {
        let (scene, name) = (&document.scene, &document.name);
        let mut footer = format!("interwell {version}{PART}{name}{PART}tolerance {:e}", scene.run.tolerance);
        for change in document.changes() {
            footer += PART;
            footer += change;
        }
        Self { title: scene.title.clone(), footer, origin: origin(document, version) }
    }

    /// The caption of a picture of what was identified from the record in a file called `name`, made by this
    /// `version`.
    pub fn of_record(name: &str, of: &str, version: &str) -> Self {
        let footer = format!("interwell {version}{PART}identify {name} --of {of}");
        let origin = json!({ "program": PROGRAM, "version": version, "record": name, "of": of });
        let origin = origin.as_object().cloned().unwrap_or_default();
        Self { title: name.to_owned(), footer, origin }
    }

    /// The footer in lines that fit on a canvas of this `width`; what does not fit into the last one is cut.
    pub fn footer_lines(&self, width: f64) -> Vec<String> {
        const MOST: usize = 4;
        let room = width - if width < style::NARROW { 48.0 } else { 220.0 };
        let fits = |words: &str| font::width(words, style::FOOTER, false) <= room;
        let mut lines: Vec<String> = Vec::new();
        for part in self.footer.split(PART) {
            match lines.last_mut() {
                Some(line) if fits(&format!("{line}{PART}{part}")) => {
                    line.push_str(PART);
                    line.push_str(part);
                }
                _ => lines.push(part.to_owned()),
            }
        }
        if lines.len() > MOST {
            let rest = lines.split_off(MOST - 1).join(PART);
            lines.push(rest);
        }
        lines.iter().map(|line| fitted(line, style::FOOTER, false, room)).collect()
    }

    /// Draws title, subtitle and footer, on a wide canvas from `left` on.
    pub fn draw(&self, figure: &mut Figure, theme: &Theme, subtitle: &str, left: f64) {
        let (canvas, on_paper) = (figure.canvas, figure.sheet.is_some());
        let (left, right) = figure.breadth((left, canvas.right - 30.0));
        let room = right - left;
        let mut row = |words: &str, size: f64, bold: bool, ink: Ink, height: f64| {
            // On paper the words are smaller before they are cut.
            let share = (room / font::width(words, size, bold)).clamp(0.7, 1.0);
            let size = if on_paper { share * size } else { size };
            let words = fitted(words, size, bold, room);
            figure.text(Text { bold, ..Text::new(words, (left, height), size, ink) });
        };
        row(&self.title, style::TITLE, true, theme.ink, 58.0);
        row(subtitle, style::SUBTITLE, false, theme.soft, 100.0);
        let lines = self.footer_lines(canvas.right);
        for (above, line) in lines.iter().rev().enumerate() {
            let height = canvas.bottom - 16.0 - style::FOOTER_LINE * above as f64;
            row(line, style::FOOTER, false, theme.soft, height);
        }
    }
}
