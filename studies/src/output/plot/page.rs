//! Layout of a chart: captions and legend above the panels, footer below.

use super::chart::{Chart, Layer, Marks};
use super::figure::{Area, Figure, Text};
use super::font;
use super::grid::PanelGrid;
use super::mark::{Caption, REGIMES, Sample, entry, regime_words};
use super::role::{Look, Role};
use super::sheet::canvas_width;
use super::style::{self, Theme};

/// Free space at the left and right edges of a narrow canvas and of a wide one.
const EDGE: (f64, f64) = (24.0, 40.0);
/// Line height of the title.
const TITLE_LINE: f64 = 46.0;
/// Line height of the subtitle.
const SUBTITLE_LINE: f64 = 36.0;
/// Line height of the legend, and the room after it.
const ROW: f64 = 38.0;
const AFTER_LEGEND: f64 = 10.0;
/// Width of a sample in the legend.
const SAMPLE: f64 = 44.0;
/// Distance from a sample to its text.
const GAP: f64 = 12.0;
/// Distance from the text to the next entry of the legend.
const BETWEEN_ENTRIES: f64 = 38.0;
/// Smallest height of a panel of height 1 on a page.
const MIN_HEIGHT: f64 = 230.0;
/// The same in a pane of the window.
const MIN_PANE_HEIGHT: f64 = 90.0;
/// Free space around a pane of the window.
const PANE: f64 = 16.0;
/// Height below which a pane has no subtitle.
const LOW_PANE: f64 = 600.0;
/// Height of the panels on a sheet relative to its width, if no height is given.
const PROPORTION: f64 = 0.625;

/// Wraps `words` into lines no longer than `room`, at spaces, and a word that is too long after a
/// hyphen or anywhere.
pub fn wrapped(words: &str, size: f64, bold: bool, room: f64) -> Vec<String> {
    let fits = |line: &str| font::width(line, size, bold) <= room;
    let mut lines: Vec<String> = Vec::new();
    let mut line = String::new();
    for mut word in words.split(' ') {
        let longer = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
        if fits(&longer) {
            line = longer;
            continue;
        }
        if !line.is_empty() {
            lines.push(std::mem::take(&mut line));
        }
        while !word.is_empty() && !fits(word) {
            let ends = word.char_indices().map(|(begin, letter)| begin + letter.len_utf8());
            let first = ends.clone().next().unwrap_or(word.len());
            let end = ends.take_while(|end| fits(&word[..*end])).last().unwrap_or(first);
            let end = word[..end].rfind(['-', '_']).map_or(end, |place| place + 1);
            lines.push(word[..end].to_owned());
            word = &word[end..];
        }
        word.clone_into(&mut line);
    }
    lines.push(line);
    lines
}

/// Like [`wrapped`], with a largest number of lines; if lines are dropped, the last one ends in an ellipsis.
pub fn wrapped_to(words: &str, size: f64, bold: bool, room: f64, most: usize) -> Vec<String> {
    let mut lines = wrapped(words, size, bold, room);
    if lines.len() > most {
        lines.truncate(most);
        if let Some(last) = lines.last_mut() {
            while font::width(&format!("{last}\u{2026}"), size, bold) > room && last.pop().is_some() {}
            last.push('\u{2026}');
        }
    }
    lines
}

/// Smallest relative size at which a title or a subtitle is kept in one line on paper.
const SMALLEST: f64 = 0.7;

/// Largest number of lines of a title or a subtitle.
const MAX_LINES: usize = 3;

/// Lines of text of one size.
#[derive(Default)]
pub struct Lines {
    pub lines: Vec<String>,
    pub size: f64,
}

impl Lines {
    /// On paper the text is made smaller if it then fits in one line.
    fn new(words: &str, size: f64, bold: bool, room: f64, on_paper: bool) -> Self {
        let share = room / font::width(words, size, bold);
        let fits = on_paper && (SMALLEST..1.0).contains(&share);
        let size = if fits { share * size } else { size };
        // the measured width may exceed the room by a rounding error
        Self { lines: wrapped_to(words, size, bold, room + 1e-6, MAX_LINES), size }
    }

    /// The distance of its lines, of which one of text of the size `usual` takes `step`.
    fn step(&self, step: f64, usual: f64) -> f64 {
        step * self.size / usual
    }
}

/// An entry of a legend, with its place relative to the upper left corner of the legend.
struct Entry<'a> {
    sample: Sample,
    words: &'a str,
    size: f64,
    left: f64,
    row: usize,
}

impl Chart {
    /// The chart with this caption, laid out for the sheet of the theme or for a screen.
    pub fn figure(&self, caption: &Caption, theme: &Theme) -> Figure {
        let sheet = theme.sheet;
        let width = canvas_width(sheet.as_ref());
        let edge = if theme.is_narrow() { EDGE.0 } else { EDGE.1 };
        let room = width - 2.0 * edge;
        let title = Lines::new(&caption.title, style::TITLE, true, room, sheet.is_some());
        let subtitle = Lines::new(&self.subtitle, style::SUBTITLE, false, room, sheet.is_some());
        let footer = caption.footer_lines(room);
        let captions = [
            (&title, title.step(TITLE_LINE, style::TITLE), true, theme.ink),
            (&subtitle, subtitle.step(SUBTITLE_LINE, style::SUBTITLE), false, theme.soft),
        ];
        let above = 38.0 + captions.iter().map(|(lines, step, ..)| lines.across(*step)).sum::<f64>();
        let below = 24.0 + style::FOOTER_LINE * footer.len() as f64;
        let named = self.entries(theme);
        let legend = Legend::new(&named, room);
        let mut grid = PanelGrid::new(self, theme.is_narrow());
        let around = if sheet.is_some_and(|sheet| !sheet.titled) { 0.0 } else { above + below };
        let asked = match sheet {
            None => style::SIZE.1.into(),
            Some(sheet) => sheet.height_mm.map_or(PROPORTION * width + around, |mm| mm / sheet.unit_mm()),
        };
        let body = grid.fit((edge, width - edge), asked - around - legend.height, MIN_HEIGHT) + legend.height;
        let height = above + body + below;
        let mut figure = Figure::new(theme, (width, height), (above, height - below));
        figure.origin = caption.origin.clone();
        let mut y = 24.0;
        for (lines, step, bold, ink) in captions {
            for line in &lines.lines {
                let at = (edge, y + 0.78 * step);
                figure.text(Text { bold, ..Text::new(line, at, lines.size, ink) });
                y += step;
            }
        }
        for (i, line) in footer.iter().enumerate() {
            let at = (edge, height - below + 28.0 + style::FOOTER_LINE * i as f64);
            figure.text(Text::new(line, at, style::FOOTER, theme.soft));
        }
        legend.draw(&mut figure, (edge, above), theme);
        grid.place(above + legend.height).for_each(|slot| slot.draw(&mut figure, theme));
        figure.data = self.data.clone();
        figure
    }

    /// The chart in this width and height, for a pane of the window: with the subtitle as the only caption,
    /// and without it in a low pane.
    pub fn pane(&self, (width, height): (f64, f64), theme: &Theme) -> Figure {
        let named = self.entries(theme);
        let legend = Legend::new(&named, width - 2.0 * PANE);
        let is_low = height < LOW_PANE;
        let has_subtitle = !is_low && !self.subtitle.is_empty();
        let subtitle = if has_subtitle { &self.subtitle } else { "" };
        let subtitle = wrapped_to(subtitle, style::TICK, false, width - 2.0 * PANE, MAX_LINES);
        let edge = if is_low { 0.0 } else { 0.5 * PANE };
        let above = edge + if has_subtitle { SUBTITLE_LINE * subtitle.len() as f64 } else { 0.0 };
        let below = above + legend.height;
        let mut grid = PanelGrid::new(self, width < style::NARROW);
        grid.fit((PANE, width - PANE), height - below - edge, MIN_PANE_HEIGHT);
        let mut figure = Figure::new(theme, (width, height), (0.0, height));
        for (i, line) in subtitle.iter().enumerate() {
            let at = (PANE, edge + SUBTITLE_LINE * (i as f64 + 0.75));
            figure.text(Text::new(line, at, style::TICK, theme.soft));
        }
        legend.draw(&mut figure, (PANE, above), theme);
        grid.place(below).for_each(|slot| slot.draw(&mut figure, theme));
        figure
    }

    /// The entries of the legend: those of the layers that have a name, each once.
    fn entries(&self, theme: &Theme) -> Vec<(Sample, String)> {
        let mut entries: Vec<(Sample, String)> = Vec::new();
        let mut add = |sample: Sample, name: &str| {
            if !name.is_empty() && !entries.iter().any(|entry| entry.1 == name) {
                entries.push((sample, name.to_owned()));
            }
        };
        let layers = self.panels().flat_map(|panel| panel.layers.iter().map(move |layer| (panel, layer)));
        for (panel, layer) in layers.filter(|(panel, layer)| panel.shows(layer)) {
            match &layer.marks {
                Marks::Regimes(points, _) => {
                    for (place, (name, _)) in REGIMES.iter().enumerate() {
                        if points.iter().any(|point| point.1 == *name && panel.contains(point.0)) {
                            add(Sample::Marker(theme.look(Role::Regime(place))), regime_words(name));
                        }
                    }
                }
                Marks::Cells(cells) | Marks::Surface(cells, _) => {
                    for (role, name) in cells.entries() {
                        let look = theme.look(role);
                        // a surface at rest has lines in place of a hatching
                        let hatch = look.hatch.filter(|_| panel.surface().is_none());
                        let patch = Sample::Patch(Look { hatch, ..look });
                        add(if role == Role::Missing { Sample::Missing } else { patch }, &name);
                    }
                }
                _ => add(sample(layer, theme), &layer.name),
            }
        }
        entries
    }
}

/// A legend in rows, with its height.
struct Legend<'a> {
    entries: Vec<Entry<'a>>,
    height: f64,
}

impl<'a> Legend<'a> {
    /// These entries in rows no wider than `room`.
    fn new(named: &'a [(Sample, String)], room: f64) -> Self {
        let (mut left, mut row) = (0.0, 0);
        let mut entries = Vec::new();
        for (sample, words) in named {
            let share = ((room - SAMPLE - GAP) / font::width(words, style::TICK, false)).min(1.0);
            let size = share * style::TICK;
            let width = SAMPLE + GAP + font::width(words, size, false);
            if left > 0.0 && left + width > room + 0.5 {
                (left, row) = (0.0, row + 1);
            }
            entries.push(Entry { sample: *sample, words, size, left, row });
            left += width + BETWEEN_ENTRIES;
        }
        let height = if entries.is_empty() { 0.0 } else { ROW * (row as f64 + 1.0) + AFTER_LEGEND };
        Self { entries, height }
    }

    /// Draws it with its upper left corner at a place.
    fn draw(&self, figure: &mut Figure, (left, top): (f64, f64), theme: &Theme) {
        for Entry { sample, words, size, left: from, row } in &self.entries {
            let (x, middle) = (left + from, top + ROW * (*row as f64 + 0.5));
            entry(figure, theme, *sample, Area::new(x, middle - 12.0, x + SAMPLE, middle + 12.0));
            let at = (x + SAMPLE + GAP, middle + 0.5 * size * font::CAPITAL);
            figure.text(Text::new(*words, at, *size, theme.ink));
            let right = at.0 + font::width(words, *size, false);
            figure.legend.push((Area::new(x, middle - 12.0, right, middle + 12.0), (*words).to_owned()));
        }
    }
}

/// The sample of a layer in the legend.
fn sample(layer: &Layer, theme: &Theme) -> Sample {
    let look = theme.look(layer.role);
    match &layer.marks {
        Marks::Points(_) | Marks::Cloud(_) | Marks::Valued(..) | Marks::Regimes(..) => Sample::Marker(look),
        Marks::Ticks(..) => Sample::Ticks(look.ink),
        Marks::Wall(..) => Sample::Patch(Look { ink: theme.wall_fill(), ..look }),
        Marks::Spans(_) if layer.role == Role::Missing => Sample::Missing,
        Marks::Spans(_) => Sample::Patch(Look { hatch: None, ..look }),
        Marks::Band(_) | Marks::Bars(..) | Marks::Patch | Marks::Cells(_) | Marks::Surface(..) => {
            Sample::Patch(look)
        }
        Marks::Path(_)
        | Marks::Trace(_)
        | Marks::Sticks(_)
        | Marks::Intervals(_)
        | Marks::Verticals(_)
        | Marks::Horizontals(_)
        | Marks::Mechanism(_)
        | Marks::Words(_) => Sample::Line(look),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_caption_on_paper_is_smaller_only_where_it_then_has_one_line() {
        let words = "a subtitle of several words that may be too long";
        let of = |share: f64| {
            let room = share * font::width(words, 28.0, false);
            let lines = Lines::new(words, 28.0, false, room, true);
            (lines.lines.len(), (10.0 * lines.size).round(), lines.step(36.0, 28.0).round())
        };
        assert_eq!([of(1.1), of(0.8), of(0.75)], [(1, 280.0, 36.0), (1, 224.0, 29.0), (1, 210.0, 27.0)]);
        assert_eq!(of(0.6), (2, 280.0, 36.0));
    }

    #[test]
    fn a_long_word_is_wrapped_after_a_hyphen() {
        let room = font::width("a-long-scene", 20.0, false);
        assert_eq!(wrapped("a-long-scene-name", 20.0, false, room), ["a-long-", "scene-name"]);
    }
}
