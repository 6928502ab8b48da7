//! Picture of one run: displacement, velocity and base acceleration over time, and the phase portrait.

use std::ops::Range;

use super::axis::{PlotAxis, Ranges};
use super::drawn::Drawn;
use super::figure::{Area, Figure, Point, Text};
use super::font;
use super::frame::Frame;
use super::mark::{Caption, Marker, Sample, legend, marker, regime};
use super::panels::{GUTTER, LEFT, Panel, Places};
use super::style::{self, Ink, Theme};
use crate::dynamics::{Outcome, STANDARD_GRAVITY, Summary};
use crate::mechanics::Mechanism;
use crate::numeric::{extent, short};
use crate::study::{Table, Trace};

/// The picture of a run from its trace and its summary, with these panels. The trace says which times it
/// shows; `ranges` may give the axis of the displacement, in mm.
pub fn run_figure(
    trace: &Trace,
    summary: &Summary,
    mechanism: &Mechanism,
    panels: &[Panel],
    ranges: Ranges,
    caption: &Caption,
    theme: &Theme,
) -> Figure {
    let mut figure = Figure::new(theme, caption, Places::least(theme, panels));
    let column = |name: &str| trace.path.numbers(name).unwrap_or_default();
    let stable = mechanism.landscape.equilibria.iter().filter(|equilibrium| equilibrium.stable);
    let seen = Seen {
        trace,
        theme,
        t: column("t_s"),
        x: column("x_m"),
        v: column("v_m_per_s"),
        accel: column("base_accel_m_per_s2"),
        wells: stable.map(|equilibrium| equilibrium.x).collect(),
        speed: speed_unit(column("v_m_per_s").iter().copied()),
        displacements: ranges.y,
        panels,
    };
    let reach = seen.displacement(&seen.x[seen.rows(trace.shown_from)]);
    let mut entries = Vec::new();
    if trace.impacts.rows() > 0 && seen.has(Panel::Displacement) {
        entries.push((Sample::Ticks(theme.ink), "impact"));
    }
    if trace.rests.rows() > 0 && seen.is_over_time() {
        // On a compliant stop it never rests: it trembles.
        let words = if summary.peak_contact_force.is_some() { "on a stop" } else { "at rest on a stop" };
        entries.push((Sample::Patch(theme.rest, None), words));
    }
    let has_places = seen.has(Panel::Displacement) || seen.has(Panel::Portrait);
    if has_places && (trace.stops.0.is_finite() || trace.stops.1.is_finite()) {
        entries.push((Sample::Patch(theme.wall_fill(), None), "stop"));
    }
    if has_places && seen.wells.iter().any(|well| (reach.low..=reach.high).contains(&(well * 1e3))) {
        entries.push((Sample::Line(theme.stable, style::LINE, Some(style::DASH)), "well"));
    }
    let ends = (LEFT, figure.canvas.right - 615.0);
    let more = (legend(&mut figure, theme, &entries, ends, 142.0) - 161.0).max(0.0);
    let places = Places::new(&figure, more, panels);
    seen.over_time(&mut figure, &places);
    if let Some(area) = places.portrait {
        seen.portrait(&mut figure, area);
    }
    figure.data = seen.drawn();
    let judged = is_judged(summary, trace);
    if let Some(at) = places.account.filter(|_| judged) {
        account(&mut figure, at, summary, trace, seen.speed, theme);
    }
    let about = match judged || summary.outcome != Outcome::Done {
        true => subtitle(summary),
        false => format!("from {} to {} s", short(trace.shown_from), short(trace.shown_to)),
    };
    caption.draw(&mut figure, theme, &about, LEFT);
    figure
}

/// What a run's picture is drawn from. SI.
struct Seen<'a> {
    trace: &'a Trace,
    theme: &'a Theme,
    t: &'a [f64],
    x: &'a [f64],
    v: &'a [f64],
    accel: &'a [f64],
    wells: Vec<f64>,
    /// Factor from m/s and name of the unit of speed.
    speed: (f64, &'static str),
    /// The axis of the displacement in mm, where it was asked for.
    displacements: Option<(f64, f64)>,
    panels: &'a [Panel],
}

impl Seen<'_> {
    fn has(&self, panel: Panel) -> bool {
        self.panels.contains(&panel)
    }

    fn is_over_time(&self) -> bool {
        self.panels.iter().any(|panel| *panel != Panel::Portrait)
    }

    /// The rows from a time on up to where the picture ends.
    fn rows(&self, from: f64) -> Range<usize> {
        let end = self.t.partition_point(|t| *t <= self.trace.shown_to);
        self.t.partition_point(|t| *t < from).min(end)..end
    }

    /// The axis for these displacements. Stops count where the mass comes near them, so that a far one
    /// does not press the motion flat.
    fn displacement(&self, x: &[f64]) -> PlotAxis {
        const NEAR: f64 = 0.4;
        let (low, high) = extent(x.iter().copied().filter(|x| x.is_finite()));
        // A mass that does not move is shown between all that it could move to.
        let room = if low < high { NEAR * (high - low) } else { 3.0 * high.abs() };
        let stops = [self.trace.stops.0, self.trace.stops.1];
        let near = stops.into_iter().filter(|stop| (low - room..=high + room).contains(stop));
        let label = "displacement, mm";
        let axis = PlotAxis::around(x.iter().copied().chain(near).map(|x| x * 1e3), 0.11, 6, label);
        axis.or_given(self.displacements, 6, label)
    }

    /// All that is drawn.
    fn drawn(&self) -> Table {
        let Self { trace, t, x, v, accel, .. } = *self;
        let mut drawn = Drawn::new(["t_s", "x_m", "v_m_per_s", "base_accel_m_per_s2"], &["side"]);
        let shown = [Panel::Displacement, Panel::Velocity, Panel::Acceleration].map(|panel| self.has(panel));
        for i in self.rows(trace.shown_from).filter(|_| self.is_over_time()) {
            let value = |place: usize, of: &[f64]| if shown[place] { of[i] } else { f64::NAN };
            drawn.put("run", &[t[i], value(0, x), value(1, v), value(2, accel)], &[]);
        }
        for i in self.rows(trace.portrait_from).filter(|_| self.has(Panel::Portrait)) {
            drawn.put("portrait", &[t[i], x[i], v[i]], &[]);
        }
        let has_places = self.has(Panel::Displacement) || self.has(Panel::Portrait);
        let shown = trace.shown_from..=trace.shown_to;
        let impacts = Some(&trace.impacts).filter(|_| self.has(Panel::Displacement));
        let column = |table: &Table, name: &str| table.numbers(name).unwrap_or_default().to_vec();
        if let Some(impacts) = impacts {
            let sides = impacts.words("side");
            let times = column(impacts, "t_s");
            for (at, side) in times.iter().zip(sides).filter(|impact| shown.contains(impact.0)) {
                let stop = if *side == "left" { trace.stops.0 } else { trace.stops.1 };
                drawn.put("impact", &[*at, stop], &[side]);
            }
        }
        let rests = column(&trace.rests, "from_s").into_iter().zip(column(&trace.rests, "to_s"));
        let seen = |(from, to): &(f64, f64)| *to >= trace.shown_from && *from <= trace.shown_to;
        for (from, to) in rests.filter(seen).filter(|_| self.is_over_time()) {
            drawn.put("rest_from", &[from.max(trace.shown_from)], &[]);
            drawn.put("rest_to", &[to.min(trace.shown_to)], &[]);
        }
        for (at, side) in [(trace.stops.0, "left"), (trace.stops.1, "right")] {
            if at.is_finite() && has_places {
                drawn.put("stop", &[f64::NAN, at], &[side]);
            }
        }
        self.wells.iter().filter(|_| has_places).for_each(|at| drawn.put("well", &[f64::NAN, *at], &[]));
        drawn.table()
    }

    fn velocity(&self, v: &[f64], count: usize) -> PlotAxis {
        let (scale, unit) = self.speed;
        PlotAxis::around(v.iter().map(|v| v * scale), 0.08, count, &format!("velocity, {unit}"))
    }

    /// Displacement, velocity and base acceleration over time.
    fn over_time(&self, figure: &mut Figure, places: &Places) {
        let Self { trace, theme, .. } = *self;
        let time = PlotAxis::between(trace.shown_from, trace.shown_to, 6, "time, s");
        let shown = self.rows(trace.shown_from);
        let in_g = self.accel[shown.clone()].iter().map(|a| a / STANDARD_GRAVITY);
        let g_axis = PlotAxis::around(in_g.chain([0.0]), 0.1, 4, "base accel., g");
        let axes =
            [self.displacement(&self.x[shown.clone()]), self.velocity(&self.v[shown.clone()], 5), g_axis];
        let lines = [
            (self.x, 1e3, theme.ink),
            (self.v, self.speed.0, theme.second),
            (self.accel, 1.0 / STANDARD_GRAVITY, theme.shaking),
        ];
        for (i, (up, (values, scale, ink))) in axes.into_iter().zip(lines).enumerate() {
            let Some(area) = places.panels[i] else { continue };
            let across = if places.last() == Some(i) { time.clone() } else { time.clone().silent() };
            let frame = Frame { gutter: Some(GUTTER), ..Frame::new(area, across, up) };
            let strength = if i == 0 { 1.0 } else { 0.5 };
            rests(figure, &frame, trace, theme.rest.over(theme.paper, strength));
            frame.grid(figure, theme);
            if i == 0 {
                for (stop, below) in [(trace.stops.0, true), (trace.stops.1, false)] {
                    if stop.is_finite() {
                        frame.wall_down(figure, stop * 1e3, below, theme);
                    }
                }
                for well in &self.wells {
                    frame.horizontal(figure, well * 1e3, style::LINE, theme.stable, Some(style::DASH));
                }
            } else {
                frame.horizontal(figure, 0.0, style::THIN, theme.soft, None);
            }
            let pairs = shown.clone().map(|i| (self.t[i], values[i] * scale));
            frame.dense_line(figure, pairs.filter(|pair| pair.1.is_finite()), style::FINE_LINE, ink);
            if i == 0 {
                impacts(figure, &frame, trace, theme);
            }
            frame.axes(figure, theme);
        }
    }

    /// Velocity over displacement.
    fn portrait(&self, figure: &mut Figure, area: Area) {
        let Self { trace, theme, .. } = *self;
        let shown = self.rows(trace.portrait_from);
        let (x, v) = (&self.x[shown.clone()], &self.v[shown]);
        let frame = Frame::new(area, self.displacement(x), self.velocity(v, 8));
        frame.grid(figure, theme);
        for (stop, left) in [(trace.stops.0, true), (trace.stops.1, false)] {
            if stop.is_finite() {
                frame.wall_across(figure, stop * 1e3, left, theme);
            }
        }
        for well in &self.wells {
            frame.vertical(figure, well * 1e3, style::LINE, theme.stable, Some(style::DASH));
        }
        let path = x.iter().zip(v).map(|(x, v)| (x * 1e3, v * self.speed.0));
        frame.path(figure, path, style::FINE_LINE, theme.second);
        if let (Some(x), true, true) = (x.first(), still(x), still(v)) {
            let at = frame.place((x * 1e3, 0.0));
            marker(figure, Marker::Disc, at, style::MARKER, theme.second, theme.ink);
        }
        frame.axes(figure, theme);
        let words = match short(trace.portrait_from) {
            from if trace.shown_to < trace.end => {
                format!("phase portrait, {from} to {} s", short(trace.shown_to))
            }
            from => format!("phase portrait from {from} s on"),
        };
        note(figure, &words, (area.left, area.top - 23.0), style::TICK, theme.ink, false);
    }
}

/// Whether all values are the first one.
fn still(values: &[f64]) -> bool {
    values.iter().all(|value| *value == values[0])
}

/// The unit in which speeds up to those given are short numbers, with the factor from m/s.
pub fn speed_unit(values: impl Iterator<Item = f64>) -> (f64, &'static str) {
    let greatest = values.filter(|value| value.is_finite()).fold(0.0_f64, |a, b| a.max(b.abs()));
    if greatest < 2.0 { (1e3, "mm/s") } else { (1.0, "m/s") }
}

/// Spans at rest, shaded; neighbours nearer than a part of a pixel are one.
fn rests(figure: &mut Figure, frame: &Frame, trace: &Trace, ink: Ink) {
    let from = trace.rests.numbers("from_s").unwrap_or_default();
    let to = trace.rests.numbers("to_s").unwrap_or_default();
    let mut open: Option<(f64, f64)> = None;
    let mut shade = |span: Option<(f64, f64)>| {
        if let Some((left, right)) = span {
            let area = Area::new(left, frame.area.top, right, frame.area.bottom);
            if let Some(area) = area.common(frame.area) {
                figure.rect(area, ink);
            }
        }
    };
    for (from, to) in from.iter().zip(to) {
        let (left, right) = (frame.across(*from), frame.across(*to));
        open = match open {
            Some((first, last)) if left - last < 0.7 => Some((first, right.max(last))),
            other => {
                shade(other);
                Some((left, right))
            }
        };
    }
    shade(open);
}

/// A tick for each impact at the edge on its stop's side; of those that lie close, some.
fn impacts(figure: &mut Figure, frame: &Frame, trace: &Trace, theme: &Theme) {
    const TICK: f64 = 20.0;
    /// So far apart the wall is still seen between them.
    const APART: f64 = 4.5;
    let times = trace.impacts.numbers("t_s").unwrap_or_default();
    let sides = trace.impacts.words("side");
    let mut last = [f64::NEG_INFINITY; 2];
    let shown = trace.shown_from..=trace.shown_to;
    for (t, side) in times.iter().zip(sides).filter(|impact| shown.contains(impact.0)) {
        let left = *side == "left";
        let at = frame.across(*t);
        if at - last[usize::from(left)] >= APART {
            last[usize::from(left)] = at;
            let edge = if left { frame.area.bottom } else { frame.area.top };
            let inner = if left { edge - TICK } else { edge + TICK };
            figure.line(&[(at, edge), (at, inner)], 2.0, theme.ink, frame.area);
        }
    }
}

fn reason(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Done => "done",
        Outcome::LeftTable { .. } => "the mass left the force curve",
        Outcome::ImpactBudget { .. } => "more impacts than one run may make",
        Outcome::StepBudget { .. } => "more work than one run may take",
        Outcome::NotFinite { .. } => "a number was no longer finite",
        Outcome::Inaccurate { .. } => "the energy does not balance",
        Outcome::Cancelled { .. } => "told to stop",
    }
}

/// Whether the picture is one of the settled window, which the summary is about. A section of the run may
/// show other times.
fn shows_window(summary: &Summary, trace: &Trace) -> bool {
    let (from, to) = summary.window;
    !trace.is_section || (trace.shown_from <= from && trace.shown_to >= to)
}

/// Whether regime and averages are those of the times that are shown: of the settled window, or of a settled
/// motion at any time from its begin on.
fn is_judged(summary: &Summary, trace: &Trace) -> bool {
    shows_window(summary, trace) || (summary.settled == Some(true) && trace.shown_from >= summary.window.0)
}

fn subtitle(summary: &Summary) -> String {
    match summary.outcome.ended_at() {
        Some(at) => format!("ended early at {} s: {}", short(at), reason(summary.outcome)),
        None if summary.outcome != Outcome::Done => reason(summary.outcome).to_owned(),
        None => match (summary.regime.name(), summary.period) {
            ("", _) => "one well or none: nothing to cross".to_owned(),
            ("interwell", Some(1)) => "interwell: repeats in every forcing period".to_owned(),
            ("interwell", Some(n)) => format!("interwell: repeats after {n} forcing periods"),
            ("irregular", _) => "irregular: crosses without a period".to_owned(),
            ("intrawell", _) => "intrawell: moves without crossing".to_owned(),
            ("rest", _) => "at rest".to_owned(),
            (other, _) => other.to_owned(),
        },
    }
}

/// Regime and numbers, under the phase portrait.
fn account(
    figure: &mut Figure,
    (left, mut y): Point,
    summary: &Summary,
    trace: &Trace,
    (scale, unit): (f64, &str),
    theme: &Theme,
) {
    let name = summary.regime.name();
    if summary.rms_velocity.is_some() && !name.is_empty() {
        let (shape, ink) = regime(name, theme);
        marker(figure, shape, (left + 14.0, y - 10.0), style::MARKER + 1.0, ink, theme.ink);
        note(figure, name, (left + 42.0, y), style::SUBTITLE, theme.ink, true);
        y += 40.0;
    }
    let mut lines = Vec::new();
    if let Some(rms) = summary.rms_velocity {
        let (from, to) = (short(summary.window.0), short(summary.window.1));
        lines.push(match (summary.settled, summary.is_transient()) {
            (Some(true), _) => format!("settled, from {from} s on:"),
            (_, true) => format!("not settled, {from} to {to} s:"),
            (Some(false), false) => format!("averages steady, {from} to {to} s:"),
            (None, _) => format!("from {from} to {to} s:"),
        });
        lines.push(format!("RMS velocity {} {unit}", short(rms * scale)));
    }
    if summary.rms_velocity.is_some() {
        let share = summary.rested_share.filter(|share| *share > 0.0);
        let impacts = format!("{} impacts", summary.impacts);
        match name {
            _ if !shows_window(summary, trace) => {}
            "" => lines.push(impacts),
            _ if figure.is_narrow() => lines.extend([format!("{} crossings", summary.crossings), impacts]),
            _ => lines.push(format!("{} crossings, {impacts}", summary.crossings)),
        }
        let words = if summary.peak_contact_force.is_some() { "in contact" } else { "at rest" };
        lines.extend(share.map(|share| format!("{words} {:.0} % of the time", 100.0 * share)));
        if let Some(force) = summary.peak_contact_force.filter(|force| *force > 0.0) {
            lines.push(format!("contact force up to {} N", short(force)));
        }
    }
    if trace.path.rows() > 0 && lines.is_empty() {
        lines.push("ended before its settled window".to_owned());
    }
    for line in lines {
        note(figure, &line, (left, y), style::TICK, theme.ink, false);
        y += 36.0;
    }
}

fn note(figure: &mut Figure, words: &str, at: Point, size: f64, ink: Ink, bold: bool) {
    let room = figure.canvas.right - at.0 - 10.0;
    let words = super::figure::fitted(words, size, bold, room);
    debug_assert!(font::width(&words, size, bold) <= room + 1.0);
    figure.text(Text { bold, ..Text::new(words, at, size, ink) });
}
