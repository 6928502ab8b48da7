//! Picture of a measured motion over the computed one, with a second panel that shows a part closer.

use super::axis::{PlotAxis, Ranges};
use super::drawn::Drawn;
use super::figure::{Area, Figure, Point};
use super::frame::Frame;
use super::mark::{Caption, Marker, Sample, dot, legend};
use super::record::{axis_of, rms_difference};
use super::style::{self, Theme};
use crate::numeric::short;
use crate::scene::{Quantity, Timing};
use crate::study::{Comparison, Trace};

const LEFT: f64 = 150.0;
const GUTTER: f64 = 102.0;
const TOP: f64 = 175.0;
/// The least height of a canvas with one panel and with two, and the room between these.
const LEAST: [f64; 2] = [420.0, 720.0];
const BETWEEN: f64 = 108.0;

/// Fewer samples than this in a panel are dots.
const DOTS: usize = 400;

/// The picture of a run from its trace, and of what was measured of this quantity over it; `inset` are the
/// times in s of the second panel, `ranges` those of the first.
pub fn measured_figure(
    trace: &Trace,
    (found, quantity): (&Comparison, Quantity),
    inset: Option<(f64, f64)>,
    ranges: Ranges,
    caption: &Caption,
    theme: &Theme,
) -> Figure {
    let least = LEAST[usize::from(inset.is_some())];
    let mut figure = Figure::new(theme, caption, least);
    let column = |name: &str| trace.path.numbers(name).unwrap_or_default();
    let (scale, words, unit) = axis_of(quantity, &found.measured);
    let (name, label) = match quantity {
        Quantity::Velocity => ("v_m_per_s", format!("{words}, {unit}")),
        Quantity::Acceleration => ("base_accel_m_per_s2", format!("base {words}, {unit}")),
        _ => ("x_m", format!("{words}, {unit}")),
    };
    let scaled = |times: &[f64], values: &[f64]| -> Vec<Point> {
        times
            .iter()
            .zip(values)
            .map(|(t, value)| (*t, value * scale))
            .filter(|point| point.1.is_finite())
            .collect()
    };
    let computed = scaled(column("t_s"), column(name));
    let measured = scaled(&found.times, &found.measured);
    let timing = Timing::of(&found.times);
    let stops = (quantity == Quantity::Displacement).then_some(trace.stops);
    let panel =
        |(top, bottom): (f64, f64), (from, to): (f64, f64), given: Option<(f64, f64)>, count: usize| {
            let inside = |data: &[Point]| -> Vec<f64> {
                let seen = data.iter().filter(|point| (from..=to).contains(&point.0));
                seen.map(|point| point.1).collect()
            };
            let all = inside(&computed).into_iter().chain(inside(&measured));
            let up = PlotAxis::around(all, 0.09, count, &label).or_given(given, count, &label);
            let across = PlotAxis::between(from, to, 8, "time, s");
            (top, bottom, across, up)
        };
    let whole = ranges.x.unwrap_or((0.0, trace.end));
    let (bottom, right) = (figure.bottom(), figure.right());
    let first_bottom = if inset.is_some() { 0.5 * (TOP + bottom - BETWEEN) } else { bottom };
    let mut panels = vec![panel((TOP, first_bottom), whole, ranges.y, if inset.is_some() { 5 } else { 8 })];
    panels.extend(inset.map(|times| panel((first_bottom + BETWEEN, bottom), times, None, 5)));
    let left =
        |panel: &(f64, f64, PlotAxis, PlotAxis)| Frame::left(&figure, &panel.3, LEFT, panel.1 - panel.0);
    let left = panels.iter().map(left).fold(0.0, f64::max);
    let gutter = (!figure.is_narrow()).then_some(GUTTER);
    let panels: Vec<Frame> = panels
        .into_iter()
        .map(|(top, bottom, across, up)| Frame {
            gutter,
            ..Frame::new(Area::new(left, top, right, bottom), across, up)
        })
        .collect();
    if let [first, second] = &panels[..] {
        connect(&mut figure, first, second, theme);
    }
    let mut dotted = false;
    for frame in &panels {
        dotted |= draw_panel(&mut figure, frame, stops, &computed, &measured, &timing, theme);
    }
    let (of_measured, lined) = (theme.regimes[3], panels.len() > usize::from(dotted));
    let mut entries = vec![(Sample::Line(theme.ink, style::LINE, None), "computed")];
    entries.push(match lined {
        true => (Sample::Line(of_measured, style::LINE + 2.0, None), "measured"),
        false => (Sample::Marker(Marker::Disc, of_measured), "measured"),
    });
    if stops.is_some_and(|(left, right)| left.is_finite() || right.is_finite()) {
        entries.push((Sample::Patch(theme.wall_fill(), None), "stop"));
    }
    legend(&mut figure, theme, &entries, (LEFT, right), 142.0);
    let mut drawn = Drawn::new(["t_s", name], &[]);
    for (series, points) in [("computed", &computed), ("measured", &measured)] {
        points.iter().for_each(|(t, value)| drawn.put(series, &[*t, value / scale], &[]));
    }
    figure.data = drawn.table();
    let mut words = rms_difference(found.rms, scale, unit);
    if found.shift != 0.0 {
        words += &format!("; record shifted by {} s", short(found.shift)).replace('-', "\u{2212}");
    }
    caption.draw(&mut figure, theme, &words, LEFT);
    figure
}

/// Shades in the first panel the times that the second shows, and connects the two.
fn connect(figure: &mut Figure, first: &Frame, second: &Frame, theme: &Theme) {
    let Area { left, top, right, bottom } = first.area;
    let at = [second.x.low, second.x.high].map(|t| first.across(t).clamp(left, right));
    figure.rect(Area::new(at[0], top, at[1].max(at[0] + 2.0), bottom), theme.rest);
    for (from, to) in at.into_iter().zip([left, right]) {
        let ends = [(from, bottom), (to, second.area.top)];
        let between = Area::new(left, bottom, right, second.area.top);
        figure.dashed(&ends, style::THIN, theme.soft, style::DOT, between);
    }
}

/// Draws a panel with its axes: stops, the computed motion over many measured samples or below few. Returns
/// whether the samples are dots.
fn draw_panel(
    figure: &mut Figure,
    frame: &Frame,
    stops: Option<(f64, f64)>,
    computed: &[Point],
    measured: &[Point],
    timing: &Timing,
    theme: &Theme,
) -> bool {
    let color = theme.regimes[3];
    frame.grid(figure, theme);
    for (stop, below) in stops.into_iter().flat_map(|(left, right)| [(left, true), (right, false)]) {
        if stop.is_finite() {
            frame.wall_down(figure, stop * 1e3, below, theme);
        }
    }
    let inside = |point: &&Point| (frame.x.low..=frame.x.high).contains(&point.0);
    let few = measured.iter().filter(inside).count() < DOTS;
    if !few {
        for part in measured.chunk_by(|a, b| !timing.is_gap(b.0 - a.0)) {
            frame.dense_line(figure, part.iter().copied(), style::LINE + 2.0, color);
        }
    }
    frame.dense_line(figure, computed.iter().copied(), style::FINE_LINE, theme.ink);
    if few {
        let places = measured.iter().filter(inside).map(|point| frame.place(*point));
        places.filter(|at| frame.area.contains(*at)).for_each(|at| {
            dot(figure, Marker::Disc, at, 4.0, color);
        });
    }
    frame.axes(figure, theme);
    few
}
