//! Picture of scenes side by side: one bar for each scene, one panel for each quantity, the best marked.

use std::collections::BTreeSet;

use super::{CompareAnswer, Rated, SEARCHED_SPAN};
use crate::numeric::{Ending, elementary, short, significant};
use crate::output::{Chart, Marks, Panel, PanelColumn, PlotAxis, REGIMES, Role, suited_unit};
use crate::scene::{Document, is_link};
use crate::study::Table;

/// Largest number of panels side by side.
const COLUMNS: usize = 4;

/// Height of a bar relative to that of its row.
const BAR: f64 = 0.5;
/// Smallest height of a row relative to a panel of height 1.
const ROW: f64 = 0.2;
/// Height of a line of a name relative to a panel of height 1.
const LINE: f64 = 0.14;
/// Letters of a name that a line has in a narrow picture.
const LETTERS: usize = 14;

/// Position of the marker of a regime, and smallest position of its number, as shares of the axis.
const MARKED: (f64, f64) = (0.06, 0.12);

/// Room beyond the frequencies that were searched, as a share of their axis.
const BAND_ROOM: f64 = 0.55;

/// Length of an axis relative to the longest bar, which leaves room for a number.
const ROOM: f64 = 1.45;

/// A frequency within this factor of an end of the search counts as that end.
const NEAR: f64 = 1.001;

/// Which values of a panel are good.
#[derive(Clone, Copy, PartialEq)]
enum Good {
    Small,
    Large,
    /// Wide bands of frequencies, on a logarithmic axis.
    Wide,
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
    Release,
    Regime,
}

struct Shown {
    title: &'static str,
    mark: Mark,
    unit: String,
    good: Good,
    entries: Vec<Entry>,
}

impl Shown {
    fn is_band(&self) -> bool {
        self.good == Good::Wide
    }

    /// The number by which entries are compared, the largest of which is the best.
    fn merit(&self, entry: &Entry) -> f64 {
        match self.good {
            Good::Small => -entry.to,
            Good::Large => entry.to,
            Good::Wide => entry.to / entry.from,
        }
    }

    /// The index of the best entry. Returns `None` unless at least two have a value and one is the best
    /// alone.
    fn best(&self) -> Option<usize> {
        let merits = self.entries.iter().map(|entry| self.merit(entry)).enumerate();
        let known: Vec<(usize, f64)> = merits.filter(|(_, merit)| merit.is_finite()).collect();
        let (place, most) = known.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1))?;
        (known.len() > 1 && known.iter().filter(|(_, merit)| *merit == most).count() == 1).then_some(place)
    }
}

/// A number rounded to three digits, as text without zeros at its end.
#[doc(hidden)]
pub fn three_digits(value: f64) -> String {
    significant(value, 3, Ending::Trimmed, 1e-3..1e6)
}

/// The picture of a comparison of scenes, one row each, under a drive of this frequency in Hz, of the fields
/// of a [`CompareAnswer`](crate::questions::CompareAnswer).
pub fn comparison_chart(rated: &[Rated], frequency_hz: f64) -> Chart {
    let shown = shown(rated, frequency_hz);
    let count = shown.len().div_ceil(shown.len().div_ceil(COLUMNS).max(1)).max(1);
    let names = names(rated);
    let places: Vec<f64> = (0..rated.len()).map(|scene| place(rated, scene)).collect();
    let ticks = places.iter().copied().zip(names).collect();
    let up = PlotAxis::given(0.0, rated.len() as f64, ticks, "");
    let columns = (0..count).map(|column| {
        let of_column = shown.iter().skip(column).step_by(count);
        PanelColumn {
            width: 1.0,
            panels: of_column.map(|shown| panel(rated, frequency_hz, shown, &up)).collect(),
        }
    });
    let about = "from rest; speeds, reach and impacts over the settled window, numbers to three digits";
    Chart { columns: columns.collect(), subtitle: about.to_owned(), data: drawn(rated) }
}

/// The title of the picture of a comparison.
pub fn comparison_title(answer: &CompareAnswer) -> String {
    let [amplitude, frequency] = [answer.amplitude_g, answer.frequency_hz].map(short);
    format!("{} scenes under a sine of {amplitude} g at {frequency} Hz", answer.rated.len())
}

/// The name in a comparison of the scene in an argument. That of a link says what it changes.
pub fn compared_name(spec: &str, document: &Document) -> String {
    let words = match document.name.strip_prefix("built-in ") {
        _ if !is_link(spec) => spec.to_owned(),
        Some(preset) => {
            let changes = document.changes().map(|change| format!(" {}", change.replace(['/', '\\'], "_")));
            format!("{preset}{}", changes.collect::<String>())
        }
        None => document.scene.title.replace(['/', '\\'], "_"),
    };
    // CSV would have to quote these
    words.replace([',', '"', '\n', '\r'], "_")
}

/// The position of a scene on the vertical axis.
fn place(rated: &[Rated], scene: usize) -> f64 {
    rated.len() as f64 - scene as f64 - 0.5
}

/// The names of the scenes, without folders if they stay distinct.
fn names(rated: &[Rated]) -> Vec<String> {
    let last = |scene: &Rated| scene.name.rsplit(['/', '\\']).next().unwrap_or(&scene.name).to_owned();
    let mut names: Vec<String> = rated.iter().map(last).collect();
    if names.iter().collect::<BTreeSet<_>>().len() < names.len() {
        names = rated.iter().map(|scene| scene.name.clone()).collect();
    }
    names
}

/// The quantities that are above 0 for at least one of the scenes.
fn shown(rated: &[Rated], frequency_hz: f64) -> Vec<Shown> {
    let panel = |title, unit: &str, good, scale: f64, of: &dyn Fn(&Rated) -> Option<f64>| {
        let entry = |scene: &Rated| {
            let to = of(scene).map_or(f64::NAN, |value| value * scale);
            let words = match to {
                to if to.is_nan() => "\u{2013}".to_owned(),
                to if to.is_infinite() => "lost".to_owned(),
                0.0 => "none".to_owned(),
                to => three_digits(to),
            };
            Entry { from: 0.0, to, words }
        };
        let entries = rated.iter().map(entry).collect();
        Shown { title, mark: Mark::None, unit: unit.to_owned(), good, entries }
    };
    let speed = |scene: &Rated| scene.summary.rms_velocity;
    // without impacts the impact speed is 0
    let impact = |scene: &Rated| speed(scene).map(|_| scene.summary.impact_speed_max.unwrap_or(0.0));
    let power = |scene: &Rated| scene.summary.harvest.and_then(|harvest| harvest.mean_load_power);
    let (per_speed, speed_name) = suited_unit("m/s", rated.iter().filter_map(speed));
    let (per_impact, impact_name) = suited_unit("m/s", rated.iter().filter_map(impact));
    let (per_watt, watt) = match rated.iter().filter_map(power).fold(0.0, f64::max) {
        largest if largest >= 1.0 => (1.0, "W"),
        largest if largest >= 1e-3 => (1e3, "mW"),
        _ => (1e6, "\u{b5}W"),
    };
    let sensitivity = |scene: &Rated| scene.sensitivity.as_ref().map(|change| change.0);
    let all = [
        Shown { mark: Mark::Release, ..panel("crosses from", "g", Good::Small, 1.0, &Rated::crossing_g) },
        Shown { mark: Mark::Regime, ..panel("RMS velocity", speed_name, Good::Large, per_speed, &speed) },
        panel("power", watt, Good::Large, per_watt, &power),
        panel("reach", "mm", Good::Small, 1e3, &|scene| scene.summary.max_abs_x),
        panel("fastest impact", impact_name, Good::Small, per_impact, &impact),
        bands(rated, frequency_hz),
        panel("sensitivity", "% for 1 % of a size", Good::Small, 100.0, &sensitivity),
    ];
    all.into_iter().filter(|panel| panel.entries.iter().any(|entry| entry.to > 0.0)).collect()
}

/// The bands of frequencies. An end that coincides with that of the search is marked, as it may lie further
/// out.
fn bands(rated: &[Rated], frequency_hz: f64) -> Shown {
    let entry = |scene: &Rated| {
        let Some((from, to)) = scene.crosses_hz else {
            return Entry { from: f64::NAN, to: f64::NAN, words: "\u{2013}".to_owned() };
        };
        let at_most = if from < frequency_hz / SEARCHED_SPAN * NEAR { "\u{2264}" } else { "" };
        let at_least = if to * NEAR > frequency_hz * SEARCHED_SPAN { "\u{2265}" } else { "" };
        Entry {
            from,
            to,
            words: format!("{at_most}{}\u{2013}{at_least}{}", three_digits(from), three_digits(to)),
        }
    };
    let (title, unit, entries) = ("crosses at", "Hz".to_owned(), rated.iter().map(entry).collect());
    Shown { title, mark: Mark::None, unit, good: Good::Wide, entries }
}

fn panel(rated: &[Rated], frequency_hz: f64, shown: &Shown, up: &PlotAxis) -> Panel {
    let good = match shown.good {
        Good::Small => "small",
        Good::Large => "large",
        Good::Wide => "wide",
    };
    let label = format!("{}, {good} is good", shown.unit);
    let across = match shown.is_band() {
        true => {
            let ends = [frequency_hz / SEARCHED_SPAN, frequency_hz * SEARCHED_SPAN].map(elementary::log10);
            // with room for the words beyond the widest band
            PlotAxis::powers(ends[0], ends[1] + BAND_ROOM * (ends[1] - ends[0]), &label)
        }
        false => {
            let ends = shown.entries.iter().map(|entry| entry.to).filter(|end| end.is_finite());
            let longest = ends.fold(0.0, f64::max);
            PlotAxis::between(0.0, if longest > 0.0 { ROOM * longest } else { 1.0 }, &label)
        }
    };
    let scaled = |value: f64| if shown.is_band() { elementary::log10(value) } else { value };
    let (low, high) = (across.low, across.high);
    let best = shown.best();
    let lines = up.ticks.iter().map(|tick| tick.1.chars().count().div_ceil(LETTERS)).max();
    let row = (LINE * lines.unwrap_or(0) as f64).max(ROW);
    let height = (row * rated.len() as f64).max(1.0);
    let mut panel = Panel { height, heading: shown.title.to_owned(), ..Panel::new(across, up.clone()) };
    let bars = |chosen: &dyn Fn(usize, &Entry) -> bool| -> Vec<[f64; 3]> {
        let entries = shown.entries.iter().enumerate().filter(|(scene, entry)| chosen(*scene, entry));
        let ends = |entry: &Entry| match entry.to == f64::INFINITY {
            true => [low, high],
            false => [if shown.is_band() { scaled(entry.from) } else { 0.0 }, scaled(entry.to)],
        };
        entries.map(|(scene, entry)| [place(rated, scene), ends(entry)[0], ends(entry)[1]]).collect()
    };
    let is_best = |scene: usize| best == Some(scene);
    panel.draw(Role::Other, Marks::Bars(bars(&|scene, entry| !is_best(scene) && entry.to.is_finite()), BAR));
    if best.is_some() {
        let best = bars(&|scene, entry| is_best(scene) && entry.to.is_finite());
        panel.layer(Role::Best, "best of its panel", Marks::Bars(best, BAR));
    }
    let lost = bars(&|_, entry| entry.to == f64::INFINITY);
    panel.layer_if_any(Role::Rest, "crossing lost by 1 % of a size", Marks::Bars(lost, BAR));
    let words = shown.entries.iter().enumerate().map(|(scene, entry)| {
        let end = if entry.to.is_finite() { scaled(entry.to) } else { low };
        let least = if shown.mark == Mark::Regime { low + MARKED.1 * (high - low) } else { low };
        let end = end.max(least);
        ((end, place(rated, scene)), entry.words.clone())
    });
    panel.draw(Role::Motion, Marks::Words(words.collect()));
    if shown.is_band() {
        let drive = Marks::Verticals(vec![elementary::log10(frequency_hz)]);
        panel.layer(Role::Drive, "frequency of the drive", drive);
    }
    let marks = rated.iter().enumerate();
    match shown.mark {
        Mark::None => {}
        Mark::Release => {
            let released =
                marks.filter_map(|(scene, rated_scene)| Some((rated_scene.release_g?, place(rated, scene))));
            panel.layer_if_any(Role::Gaps, "leaves its stop from", Marks::Points(released.collect()));
        }
        Mark::Regime => {
            let known = marks.filter(|(scene, _)| shown.entries[*scene].to.is_finite());
            let at = low + MARKED.0 * (high - low);
            let regimes = known.filter_map(|(scene, rated_scene)| {
                let name = rated_scene.summary.regime.name();
                REGIMES.iter().any(|regime| regime.0 == name).then_some(((at, place(rated, scene)), name))
            });
            panel.draw(Role::Motion, Marks::Regimes(regimes.collect(), false));
        }
    }
    panel
}

/// The data of the picture, one row for each value, in SI.
fn drawn(rated: &[Rated]) -> Table {
    let of_scene = |scene: &Rated| {
        let summary = &scene.summary;
        let power = summary.harvest.and_then(|harvest| harvest.mean_load_power);
        let all = [
            ("release_g", scene.release_g),
            ("crossing_g", scene.crossing_g()),
            ("crossing_low_g", scene.crossing.and_then(|found| found.low)),
            ("crossing_high_g", scene.crossing.and_then(|found| found.high)),
            ("crossing_undecided", scene.crossing.map(|found| f64::from(u8::from(found.undecided)))),
            ("crossing_step_g", scene.crossing.and_then(|found| found.step)),
            ("crossing_resolution_g", scene.crossing.and_then(|found| found.resolution)),
            ("rms_velocity_m_per_s", summary.rms_velocity),
            ("mean_load_power_w", power),
            ("max_abs_x_m", summary.max_abs_x),
            ("impact_speed_max_m_per_s", summary.impact_speed_max),
            ("crosses_from_hz", scene.crosses_hz.map(|band| band.0)),
            ("crosses_to_hz", scene.crosses_hz.map(|band| band.1)),
            ("threshold_sensitivity", scene.sensitivity.as_ref().map(|change| change.0)),
        ];
        let name = scene.name.clone();
        all.into_iter().filter_map(move |(series, value)| Some((series, name.clone(), value?)))
    };
    let rows: Vec<_> = rated.iter().flat_map(of_scene).collect();
    let table = Table::new().each("series", &rows, |row| row.0).each("scene", &rows, |row| row.1.clone());
    table.each("value", &rows, |row| row.2)
}
