//! Picture of basins of attraction: the attractor of each start as colour, and the states of the attractors.

use super::axis::PlotAxis;
use super::drawn::Drawn;
use super::figure::{Area, Figure};
use super::frame::Frame;
use super::mark::{Caption, Marker, Sample, marker};
use super::style::{self, Ink, KINDS, Theme};
use super::sweep::{MAX_PICTURE_CELLS, NoPicture};
use super::swept::{LEAST, LEFT, below_legend};
use crate::numeric::short;
use crate::study::{Answer, Attractor, Basins, Edges, Starts, Table};

/// Markers of attractors, in turn.
const MARKERS: [Marker; 4] = [Marker::Disc, Marker::Square, Marker::Diamond, Marker::Triangle];

/// Number of attractors that the legend names, those with the largest shares.
const MAX_NAMED: usize = 9;

/// Whether a map of these starts can be drawn.
pub fn can_show_starts(starts: &Starts) -> Result<(), NoPicture> {
    let count = starts.count() as u64;
    if count > MAX_PICTURE_CELLS { Err(NoPicture::Starts(count)) } else { Ok(()) }
}

/// The picture of a map, which may be incomplete.
pub fn basins_figure(basins: &Basins, answer: &Answer, caption: &Caption, theme: &Theme) -> Figure {
    let mut figure = Figure::new(theme, caption, LEAST);
    let entries = entries(basins, answer, theme);
    let entries: Vec<(Sample, &str)> =
        entries.iter().map(|(sample, words)| (*sample, words.as_str())).collect();
    let top = below_legend(&mut figure, theme, &entries);
    let (across, up) = match basins.starts().axes() {
        Some((x_mm, v)) => (Edges::new(x_mm).ends(), Edges::new(v).ends()),
        None => {
            let all = || (0..basins.starts().count()).map(|row| basins.starts().at(row));
            let around = |values: Vec<f64>| {
                let axis = PlotAxis::around(values, 0.02, 8, "");
                (axis.low, axis.high)
            };
            (around(all().map(|start| start.0).collect()), around(all().map(|start| start.1).collect()))
        }
    };
    let upward = PlotAxis::between(up.0, up.1, 7, "velocity at the start, m/s");
    let rightward = PlotAxis::between(across.0, across.1, 8, "displacement at the start, mm");
    let frame = Frame::whole(&figure, (LEFT, top), rightward, upward);
    match basins.starts().axes() {
        Some((x_mm, v)) => cells(&mut figure, &frame, (x_mm, v), basins, answer, theme),
        None => dots(&mut figure, &frame, basins, answer, theme),
    }
    let (left, right) = basins.model().stop_positions();
    for (stop, is_left) in [(left, true), (right, false)] {
        if let Some(mm) = stop.map(|x| 1e3 * x).filter(|mm| *mm > across.0 && *mm < across.1) {
            frame.wall_across(&mut figure, mm, is_left, theme);
        }
    }
    for (place, attractor) in answer.attractors.iter().enumerate() {
        for (x, v) in &attractor.states {
            let at = frame.place((1e3 * x, *v));
            if frame.area.contains(at) {
                marker(&mut figure, shape(place), at, style::MARKER + 5.0, style::BLACK, style::BLACK);
                marker(&mut figure, shape(place), at, style::MARKER, attractor_colour(place), style::WHITE);
            }
        }
    }
    frame.axes(&mut figure, theme);
    figure.data = drawn(basins, answer);
    caption.draw(&mut figure, theme, &about(basins, answer), LEFT);
    figure
}

/// The data of the picture: the starts with the numbers of their attractors, and the attractors' states.
fn drawn(basins: &Basins, answer: &Answer) -> Table {
    let mut drawn = Drawn::new(["x_mm", "v_m_per_s", "attractor"], &[]);
    let source = source_row(basins);
    for row in 0..answer.rows.len() {
        let (x_mm, v) = basins.starts().at(row);
        let number = answer.rows[source(row)].map_or(f64::NAN, |found| f64::from(found.0));
        drawn.put("start", &[x_mm, v, number], &[]);
    }
    for (place, attractor) in answer.attractors.iter().enumerate() {
        for (x, v) in &attractor.states {
            drawn.put("attractor", &[1e3 * x, *v, (place + 1) as f64], &[]);
        }
    }
    drawn.table()
}

/// The colour of an attractor by its index; the colours repeat after eight.
pub fn attractor_colour(place: usize) -> Ink {
    KINDS[place % KINDS.len()]
}

fn shape(place: usize) -> Marker {
    MARKERS[place % MARKERS.len()]
}

/// The hatching of an attractor whose colour is used a second time.
fn hatch(place: usize) -> Option<Ink> {
    let dark = |Ink(r, g, b): Ink| 2 * u32::from(r) + 5 * u32::from(g) + u32::from(b) < 8 * 128;
    let over = if dark(attractor_colour(place)) { style::WHITE } else { style::BLACK };
    (place >= KINDS.len()).then_some(over)
}

/// The attractor of each start of a grid as the colour of its cell.
fn cells(
    figure: &mut Figure,
    frame: &Frame,
    (x_mm, v): (&[f64], &[f64]),
    basins: &Basins,
    answer: &Answer,
    theme: &Theme,
) {
    let (across, up) = (Edges::new(x_mm), Edges::new(v));
    let source = source_row(basins);
    for (column, x_mm) in x_mm.iter().enumerate() {
        let attractor = |row: usize| answer.rows[source(column * v.len() + row)].map(|found| found.0);
        let all: Vec<Option<u32>> = (0..v.len()).map(attractor).collect();
        let (low, high) = basins.room();
        let outside = x_mm / 1e3 < low || x_mm / 1e3 > high;
        let mut row = 0;
        for run in all.chunk_by(|a, b| a == b) {
            let (left, right) = (frame.across(across.edges[column]), frame.across(across.edges[column + 1]));
            let (bottom, top) = (frame.down(up.edges[row]), frame.down(up.edges[row + run.len()]));
            row += run.len();
            let Some(area) = Area::new(left, top, right, bottom).common(frame.area) else { continue };
            match run[0].map(|number| number as usize - 1) {
                Some(place) => {
                    figure.rect(area, attractor_colour(place));
                    if let Some(over) = hatch(place) {
                        figure.hatch(area, over);
                    }
                }
                None if outside => {}
                None => {
                    figure.rect(area, theme.rest);
                    figure.hatch(area, theme.rest_hatch);
                }
            }
        }
    }
}

/// Maps each row to the row whose answer is shown for it: itself, or the nearest one that has been run.
fn source_row(basins: &Basins) -> impl Fn(usize) -> usize {
    let (levels, done) = basins.levels();
    move |row| {
        if basins.is_whole() || done == 0 { row } else { levels.stand_in(row as u64, done - 1) as usize }
    }
}

/// Random starts as discs in the colours of their attractors.
fn dots(figure: &mut Figure, frame: &Frame, basins: &Basins, answer: &Answer, theme: &Theme) {
    let size = (700.0 / (answer.rows.len() as f64).sqrt()).clamp(2.5, 9.0);
    for (row, found) in answer.rows.iter().enumerate() {
        let (x_mm, v) = basins.starts().at(row);
        let (low, high) = basins.room();
        if x_mm / 1e3 < low || x_mm / 1e3 > high {
            continue;
        }
        let at = frame.place((x_mm, v));
        figure.disc(at, size, theme.soft);
        figure.disc(
            at,
            0.85 * size,
            found.map_or(theme.rest, |found| attractor_colour(found.0 as usize - 1)),
        );
    }
}

/// Entries of the legend: the attractors with their shares. If there are many, only the largest are named.
fn entries(basins: &Basins, answer: &Answer, theme: &Theme) -> Vec<(Sample, String)> {
    let mut named: Vec<usize> = (0..answer.attractors.len()).collect();
    named.sort_by_key(|place| std::cmp::Reverse(answer.attractors[*place].starts));
    let more = named.split_off(named.len().min(MAX_NAMED)).len();
    named.sort_unstable();
    let mut entries: Vec<(Sample, String)> = Vec::new();
    for place in named {
        let words = words(place, &answer.attractors[place], basins.starts().is_grid());
        entries.push((Sample::Patch(attractor_colour(place), hatch(place)), words));
    }
    if more > 0 {
        entries.push((Sample::Patch(theme.paper, None), format!("{more} more")));
    }
    if answer.lost + answer.undecided > 0 {
        entries.push((Sample::Patch(theme.rest, Some(theme.rest_hatch)), "none found".into()));
    }
    entries
}

/// An attractor in words, with its number and its share; for random starts with the interval of the share.
fn words(place: usize, attractor: &Attractor, is_grid: bool) -> String {
    let mut words = format!("{} {}", place + 1, attractor.words());
    let percent = |share: f64| short((1e3 * share).round() / 10.0);
    let share = &attractor.share;
    words += &match is_grid {
        true => format!(": {} %", percent(share.share)),
        false => {
            format!(": {} % ({} to {})", percent(share.share), percent(share.low), percent(share.high))
        }
    };
    words
}

/// The subtitle: which starts were run.
fn about(basins: &Basins, answer: &Answer) -> String {
    let counted = match basins.starts().axes() {
        Some((x_mm, v)) => format!("{} \u{d7} {} starts", x_mm.len(), v.len()),
        None => format!("{} random starts", answer.rows.len()),
    };
    let period = basins.model().forcing_period().filter(|_| basins.model().is_shaken());
    let when = period.map_or_else(String::new, |_| " at time 0 of the drive".to_owned());
    format!("Where motions go from {counted}{when}; markers: the attractors")
}
