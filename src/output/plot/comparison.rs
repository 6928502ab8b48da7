//! Picture of scenes side by side: one row for each scene, one panel for each quantity, the best marked.

use std::collections::BTreeSet;

use super::axis::PlotAxis;
use super::figure::{Align, Area, Figure, Text, fitted};
use super::font;
use super::frame::Frame;
use super::mark::{Caption, Marker, REGIMES, Sample, legend, marker, regime};
use super::run::speed_unit;
use super::style::{self, Ink, Theme};
use crate::numeric::round::decade;
use crate::numeric::short;
use crate::study::{Rated, SEARCHED_SPAN, Table, Values};

/// What the picture of a comparison is drawn from.
#[derive(Debug, Clone, Copy)]
pub struct ComparisonPicture<'a> {
    /// The scenes, one row each.
    pub rated: &'a [Rated],
    /// The drive's frequency in Hz.
    pub frequency_hz: f64,
}

/// Least width of a panel.
const LEAST_WIDTH: f64 = 186.0;
/// Room between two panels.
const BETWEEN: f64 = 34.0;
/// Largest width of the names of the scenes.
const NAME_WIDTH: f64 = 330.0;
/// Room over a panel for its title in two lines.
const TITLE: f64 = 74.0;
/// Room under a panel for the numbers of its axis.
const NUMBERS: f64 = 74.0;
/// Least height of a row.
const ROW: f64 = 46.0;
/// Height of a bar: the largest, and as a share of its row.
const BAR: (f64, f64) = (46.0, 0.5);
/// Room behind the longest bar for its number.
const NUMBER: f64 = 88.0;
/// Height of the first line of the legend.
const LEGEND: f64 = 146.0;

/// A frequency within this factor of an end of the search counts as that end.
const NEAR: f64 = 1.001;

/// Which value of a panel is best.
#[derive(Clone, Copy, PartialEq)]
enum Best {
    Least,
    Most,
}

/// A value of a scene: the ends of its bar and the text at it.
#[derive(Clone)]
struct Entry {
    from: f64,
    to: f64,
    words: String,
}

/// What is marked beside the bars of a panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mark {
    None,
    /// The threshold of release.
    Release,
    /// The regime of the motion.
    Regime,
}

struct Panel {
    title: &'static str,
    mark: Mark,
    unit: String,
    best: Best,
    entries: Vec<Entry>,
    /// Whether the entries are bands of frequencies, on a logarithmic axis.
    is_band: bool,
}

impl Panel {
    /// The number by which entries are compared.
    fn merit(&self, entry: &Entry) -> f64 {
        if self.is_band { entry.to / entry.from } else { entry.to }
    }

    /// The index of the best entry. Returns `None` unless at least two have a value and one is the best
    /// alone.
    fn best(&self) -> Option<usize> {
        let merits: Vec<f64> = self.entries.iter().map(|entry| self.merit(entry)).collect();
        let known = || merits.iter().enumerate().filter(|merit| merit.1.is_finite());
        let by = |a: &(usize, &f64), b: &(usize, &f64)| a.1.total_cmp(b.1);
        let best = match self.best {
            Best::Least => known().min_by(by),
            Best::Most => known().max_by(by),
        };
        let (place, merit) = best?;

        (merits.iter().filter(|value| *value == merit).count() == 1 && known().count() > 1).then_some(place)
    }
}

/// A number rounded to three digits, as text.
fn three(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return short(value);
    }
    let digit = 10_f64.powi(decade(value) - 2);
    short((value / digit).round() * digit)
}

/// The picture of a comparison.
pub fn comparison_figure(picture: &ComparisonPicture<'_>, caption: &Caption, theme: &Theme) -> Figure {
    let ComparisonPicture { rated, .. } = *picture;
    let panels = panels(picture);
    let names = names(rated);
    let widest = names.iter().map(|name| font::width(name, style::TICK, false)).fold(0.0, f64::max);
    // the number of panels side by side depends on the width alone
    let probe = Figure::new(theme, caption, 0.0);
    let (left, right) = probe.breadth((60.0, probe.right()));
    let name_width = widest.min(NAME_WIDTH).min(0.3 * (right - left));
    let room = right - left - name_width - 20.0;
    let fits = ((room + BETWEEN) / (LEAST_WIDTH + BETWEEN)).floor().max(1.0) as usize;
    let rows = panels.len().div_ceil(fits);
    let each = panels.len().div_ceil(rows);
    let least_row = TITLE + NUMBERS + ROW * rated.len() as f64;
    let mut figure = Figure::new(theme, caption, rows as f64 * least_row + 60.0);

    let entries = legend_entries(rated, &panels, theme);
    let top = LEGEND.max(legend(&mut figure, theme, &entries, (left, right), LEGEND)) + 12.0;
    // below each frame are numbers but no label
    let end = figure.bottom() + 40.0 + NUMBERS;
    let height = (end - top) / rows as f64;
    let width = (room - BETWEEN * (each as f64 - 1.0)) / each as f64;
    for (i, panel) in panels.iter().enumerate() {
        let (row, column) = (i / each, i % each);
        let from = left + name_width + 20.0 + column as f64 * (width + BETWEEN);
        let above = top + row as f64 * height;
        let bottom = (above + height - NUMBERS).max(above + TITLE + 10.0);
        let area = Area::new(from, above + TITLE, from + width, bottom);
        let frame = draw(&mut figure, picture, panel, area, theme);
        for (scene, name) in names.iter().enumerate().filter(|_| column == 0) {
            let step = (area.bottom - area.top) / names.len() as f64;
            let size = style::TICK.min(0.9 * step);
            let at = (from - 18.0, frame.down(place(rated, scene)) + 0.5 * size * font::CAPITAL);
            let text = Text::new(fitted(name, size, false, name_width), at, size, theme.ink);
            figure.text(Text { align: Align::Right, ..text });
        }
    }
    figure.data = drawn(rated);
    let about = "from rest; speeds, reach and impacts over the settled window, numbers to three digits";
    caption.draw(&mut figure, theme, about, left);
    figure
}

/// The position of a scene on the vertical axis.
fn place(rated: &[Rated], scene: usize) -> f64 {
    rated.len() as f64 - scene as f64 - 0.5
}

/// The names of the scenes, without folders if they stay distinct.
fn names(rated: &[Rated]) -> Vec<String> {
    let last = |scene: &Rated| scene.name.rsplit(['/', '\\']).next().unwrap_or(&scene.name).to_owned();
    let names: Vec<String> = rated.iter().map(last).collect();
    let apart: BTreeSet<&String> = names.iter().collect();
    if apart.len() == names.len() { names } else { rated.iter().map(|scene| scene.name.clone()).collect() }
}

/// The quantities that are above 0 for at least one of the scenes.
fn panels(picture: &ComparisonPicture<'_>) -> Vec<Panel> {
    let ComparisonPicture { rated, frequency_hz } = *picture;
    let panel = |title, unit: &str, best, scale: f64, of: &dyn Fn(&Rated) -> Option<f64>| {
        let entry = |scene: &Rated| {
            let to = of(scene).map_or(f64::NAN, |value| value * scale);
            let words = match to {
                to if to.is_nan() => "\u{2013}".to_owned(),
                to if to.is_infinite() => "lost".to_owned(),
                0.0 => "none".to_owned(),
                to => three(to),
            };
            Entry { from: 0.0, to, words }
        };
        let entries = rated.iter().map(entry).collect();
        Panel { title, mark: Mark::None, unit: unit.to_owned(), best, entries, is_band: false }
    };
    let speed = |scene: &Rated| scene.summary.rms_velocity;
    // without impacts the impact speed is 0
    let impact = |scene: &Rated| speed(scene).map(|_| scene.summary.impact_speed_max.unwrap_or(0.0));
    let power = |scene: &Rated| scene.summary.harvest.and_then(|harvest| harvest.mean_load_power);
    let (per_speed, speed_name) = speed_unit(rated.iter().filter_map(speed));
    let (per_impact, impact_name) = speed_unit(rated.iter().filter_map(impact));
    let (per_watt, watt) = match rated.iter().filter_map(power).fold(0.0, f64::max) {
        largest if largest >= 1.0 => (1.0, "W"),
        largest if largest >= 1e-3 => (1e3, "mW"),
        _ => (1e6, "\u{b5}W"),
    };
    let sensitivity = |scene: &Rated| scene.sensitivity.as_ref().map(|change| change.0);
    let all = [
        Panel { mark: Mark::Release, ..panel("crosses from", "g", Best::Least, 1.0, &Rated::crossing_g) },
        Panel { mark: Mark::Regime, ..panel("RMS velocity", speed_name, Best::Most, per_speed, &speed) },
        panel("power", watt, Best::Most, per_watt, &power),
        panel("reach", "mm", Best::Least, 1e3, &|scene| scene.summary.max_abs_x),
        panel("fastest impact", impact_name, Best::Least, per_impact, &impact),
        bands(rated, frequency_hz),
        panel("sensitivity", "% for 1 % of a size", Best::Least, 100.0, &sensitivity),
    ];
    all.into_iter().filter(|panel| panel.entries.iter().any(|entry| entry.to > 0.0)).collect()
}

/// The bands of frequencies. An end that coincides with that of the search is marked, as it may lie further
/// out.
fn bands(rated: &[Rated], frequency_hz: f64) -> Panel {
    let entry = |scene: &Rated| {
        let Some((from, to)) = scene.crosses_hz else {
            return Entry { from: f64::NAN, to: f64::NAN, words: "\u{2013}".to_owned() };
        };
        let at_most = if from < frequency_hz / SEARCHED_SPAN * NEAR { "\u{2264}" } else { "" };
        let at_least = if to * NEAR > frequency_hz * SEARCHED_SPAN { "\u{2265}" } else { "" };
        Entry { from, to, words: format!("{at_most}{}\u{2013}{at_least}{}", three(from), three(to)) }
    };
    let entries = rated.iter().map(entry).collect();
    Panel {
        title: "crosses at",
        mark: Mark::None,
        unit: "Hz".to_owned(),
        best: Best::Most,
        entries,
        is_band: true,
    }
}

/// The axis of the frequencies that were searched for crossings.
fn searched(frequency_hz: f64) -> PlotAxis {
    let (low, high) = ((frequency_hz / SEARCHED_SPAN).log10(), (frequency_hz * SEARCHED_SPAN).log10());
    let powers = low.ceil() as i32..=high.floor() as i32;
    let ticks = powers.map(|power| (f64::from(power), short(10_f64.powi(power)))).collect();
    PlotAxis { low, high, ticks, label: String::new() }
}

/// A panel with its title.
fn draw(
    figure: &mut Figure,
    picture: &ComparisonPicture<'_>,
    panel: &Panel,
    area: Area,
    theme: &Theme,
) -> Frame {
    let ComparisonPicture { rated, frequency_hz } = *picture;
    let ends = panel.entries.iter().map(|entry| entry.to).filter(|end| end.is_finite());
    let longest = ends.fold(0.0, f64::max);
    let count = ((area.right - area.left) / 95.0).floor().clamp(1.0, 4.0) as usize;
    let across = match panel.is_band {
        true => searched(frequency_hz),
        // with room for the number behind the longest bar
        false if longest > 0.0 => {
            let width = area.right - area.left;
            PlotAxis::between(0.0, longest * width / (width - NUMBER), count, "")
        }
        false => PlotAxis::between(0.0, 1.0, count, ""),
    };
    let up = PlotAxis { low: 0.0, high: rated.len() as f64, ticks: Vec::new(), label: String::new() };
    let frame = Frame::new(area, across, up);
    frame.grid(figure, theme);
    if panel.is_band {
        frame.vertical(figure, frequency_hz.log10(), style::THIN, theme.shaking, Some(style::DASH));
    }
    let best = panel.best();
    let step = (area.bottom - area.top) / rated.len() as f64;
    let half = 0.5 * BAR.0.min(BAR.1 * step);
    for (scene, entry) in panel.entries.iter().enumerate() {
        let y = frame.down(place(rated, scene));
        let ink = if best == Some(scene) { theme.stable } else { theme.soft.over(theme.paper, 0.35) };
        bar(figure, &frame, panel, entry, (y - half, y + half), ink);
        words(figure, &frame, panel, entry, (y, 0.95 * step), best == Some(scene), theme);
        if panel.mark == Mark::Release
            && let Some(release) = rated[scene].release_g
        {
            let at = (frame.across(release), y);
            marker(figure, Marker::Triangle, at, style::MARKER, theme.unstable, theme.ink);
        }
        if panel.mark == Mark::Regime && entry.to.is_finite() {
            let name = rated[scene].summary.regime.name();
            let (shape, ink) = regime(name, theme);
            let x = (area.left + 18.0).max(frame.across(entry.to));
            if !name.is_empty() {
                marker(figure, shape, (x.min(area.right - 16.0), y), style::MARKER, ink, theme.ink);
            }
        }
    }
    frame.axes(figure, theme);
    let better = match (panel.best, panel.is_band) {
        (_, true) => "wide",
        (Best::Least, _) => "small",
        (Best::Most, _) => "large",
    };
    let unit = format!("{}, {better} is good", panel.unit);
    for (text, size, ink, y) in
        [(panel.title, style::TICK, theme.ink, 42.0), (&*unit, style::FOOTER, theme.soft, 14.0)]
    {
        let size =
            size * ((area.right - area.left + BETWEEN - 8.0) / font::width(text, size, false)).min(1.0);
        figure.text(Text::new(text, (area.left, area.top - y), size, ink));
    }
    frame
}

/// The bar of a value, or of a band.
fn bar(figure: &mut Figure, frame: &Frame, panel: &Panel, entry: &Entry, rows: (f64, f64), ink: Ink) {
    let (top, bottom) = rows;
    let ends = match panel.is_band {
        true => [entry.from.log10(), entry.to.log10()],
        false => [0.0, entry.to],
    };
    if ends.iter().all(|end| end.is_finite()) {
        let [left, right] = ends.map(|end| frame.across(end));
        figure.rect(Area::new(left, top, right.max(left + 2.0), bottom), ink);
    } else if entry.to == f64::INFINITY {
        // an infinite value: hatched over the whole width
        let area = Area::new(frame.area.left, top, frame.area.right, bottom);
        figure.hatch(area, ink);
    }
}

/// The text of a bar: behind it, or inside if there is no room behind.
fn words(
    figure: &mut Figure,
    frame: &Frame,
    panel: &Panel,
    entry: &Entry,
    (y, max_size): (f64, f64),
    is_best: bool,
    theme: &Theme,
) {
    let Area { left, right, .. } = frame.area;
    let size = style::FOOTER.min(max_size);
    let width = font::width(&entry.words, size, is_best);
    let end = match panel.is_band {
        true if entry.to.is_finite() => frame.across(entry.to.log10()),
        false if entry.to.is_finite() => frame.across(entry.to),
        _ => left,
    };
    let behind = end + if panel.mark == Mark::Regime { 24.0 } else { 8.0 };
    let is_behind = behind + width <= right - 4.0;
    let x = if is_behind { behind } else { (left + 8.0).min(right - width) };
    // the colour of the best bar is light in both themes
    let ink = if is_best && !is_behind { style::BLACK } else { theme.ink };
    let text = Text::new(&entry.words, (x, y + 0.5 * size * font::CAPITAL), size, ink);
    figure.text(Text { bold: is_best, ..text });
}

/// Entries of the legend for the marks and colours that are drawn.
fn legend_entries(rated: &[Rated], panels: &[Panel], theme: &Theme) -> Vec<(Sample, &'static str)> {
    let mut entries = Vec::new();
    if panels.iter().any(|panel| panel.best().is_some()) {
        entries.push((Sample::Patch(theme.stable, None), "best of its panel"));
    }
    if rated.iter().any(|scene| scene.release_g.is_some()) {
        entries.push((Sample::Marker(Marker::Triangle, theme.unstable), "leaves its stop from"));
    }
    for (name, _) in REGIMES {
        if rated
            .iter()
            .any(|scene| scene.summary.regime.name() == name && scene.summary.rms_velocity.is_some())
        {
            let (shape, ink) = regime(name, theme);
            entries.push((Sample::Marker(shape, ink), name));
        }
    }
    entries.push((Sample::Line(theme.shaking, style::THIN, Some(style::DASH)), "frequency of the drive"));
    if panels.iter().flat_map(|panel| &panel.entries).any(|entry| entry.to == f64::INFINITY) {
        let patch = Sample::Patch(theme.paper, Some(theme.soft.over(theme.paper, 0.35)));
        entries.push((patch, "crossing lost by 1 % of a size"));
    }
    entries
}

/// The data of the picture, one row for each value, in SI.
fn drawn(rated: &[Rated]) -> Table {
    let (mut series, mut scenes, mut values) = (Vec::new(), Vec::new(), Vec::new());
    for scene in rated {
        let summary = &scene.summary;
        let power = summary.harvest.and_then(|harvest| harvest.mean_load_power);
        let all = [
            ("release_g", scene.release_g),
            ("crossing_g", scene.crossing_g()),
            ("crossing_low_g", scene.crossing.and_then(|found| found.low)),
            ("crossing_high_g", scene.crossing.and_then(|found| found.high)),
            ("crossing_undecided", scene.crossing.map(|found| f64::from(u8::from(found.undecided)))),
            ("rms_velocity_m_per_s", summary.rms_velocity),
            ("mean_load_power_w", power),
            ("max_abs_x_m", summary.max_abs_x),
            ("impact_speed_max_m_per_s", summary.impact_speed_max),
            ("crosses_from_hz", scene.crosses_hz.map(|band| band.0)),
            ("crosses_to_hz", scene.crosses_hz.map(|band| band.1)),
            ("threshold_sensitivity", scene.sensitivity.as_ref().map(|change| change.0)),
        ];
        for (name, value) in all {
            let Some(value) = value else { continue };
            series.push(name);
            scenes.push(scene.name.clone());
            values.push(value);
        }
    }
    Table::new()
        .with("series", Values::Words(series))
        .with("scene", Values::Names(scenes))
        .with("value", Values::Numbers(values))
}
