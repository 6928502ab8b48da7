//! The picture of one run: displacement, velocity and base acceleration over time, and the phase portrait.

use super::axis::Axis;
use super::figure::{Align, Area, Figure, Point, Text};
use super::font;
use super::frame::Frame;
use super::mark::{Caption, Sample, legend, marker, regime};
use super::style::{self, Ink, Theme};
use crate::dynamics::{STANDARD_GRAVITY, Summary};
use crate::mechanics::Mechanism;
use crate::numeric::short;
use crate::study::{Trace, Values};

const LEFT: f64 = 150.0;
const MIDDLE: f64 = 985.0;
const GUTTER: f64 = 102.0;
const PORTRAIT: Area = Area { left: 1150.0, top: 175.0, right: 1565.0, bottom: 600.0 };
const PANELS: [(f64, f64); 3] = [(175.0, 425.0), (447.0, 657.0), (679.0, 869.0)];

/// The picture of a run from its trace and its summary.
pub fn run_figure(
    trace: &Trace,
    summary: &Summary,
    mechanism: &Mechanism,
    caption: &Caption,
    theme: &Theme,
) -> Figure {
    let mut figure = Figure::new(theme.paper);
    let column = |name: &str| trace.path.numbers(name).unwrap_or_default();
    let (t, x, v) = (column("t_s"), column("x_m"), column("v_m_per_s"));
    let accel = column("base_accel_m_per_s2");
    let time = Axis::between(0.0, trace.duration, 6, "time, s");
    let millis = |value: &f64| value * 1e3;
    let x_axis = |count: usize| {
        // Stops count where the mass comes near them, so that a far one does not press the motion flat.
        let far = x.iter().map(|x| x.abs()).filter(|x| x.is_finite()).fold(0.0, f64::max);
        let near = [trace.stops.0, trace.stops.1].into_iter().filter(move |stop| stop.abs() <= 1.3 * far);
        Axis::around(x.iter().copied().chain(near).map(|x| x * 1e3), 0.11, count, "displacement, mm")
    };
    let (speed, speed_unit) = speed_unit(v.iter().copied());
    let speed_label = format!("velocity, {speed_unit}");
    let v_axis = Axis::around(v.iter().map(|v| v * speed), 0.08, 5, &speed_label);
    let g_axis =
        Axis::around(accel.iter().map(|a| a / STANDARD_GRAVITY).chain([0.0]), 0.1, 4, "base accel., g");
    let framed = |(top, bottom): (f64, f64), x, y| {
        Frame { gutter: Some(GUTTER), ..Frame::new(Area::new(LEFT, top, MIDDLE, bottom), x, y) }
    };
    let frames = [
        framed(PANELS[0], time.clone().silent(), x_axis(6)),
        framed(PANELS[1], time.clone().silent(), v_axis),
        framed(PANELS[2], time, g_axis),
    ];
    for (i, frame) in frames.iter().enumerate() {
        let strength = if i == 0 { 1.0 } else { 0.5 };
        rests(&mut figure, frame, trace, theme.rest.over(theme.paper, strength));
        frame.grid(&mut figure, theme);
    }
    frames[1].horizontal(&mut figure, 0.0, style::THIN, theme.soft, None);
    frames[2].horizontal(&mut figure, 0.0, style::THIN, theme.soft, None);
    for (stop, below) in [(trace.stops.0, true), (trace.stops.1, false)] {
        if stop.is_finite() {
            frames[0].wall_down(&mut figure, stop * 1e3, below, theme);
        }
    }
    let wells: Vec<f64> = mechanism.landscape.equilibria.iter().filter(|e| e.stable).map(|e| e.x).collect();
    let shown = |y: f64| y >= frames[0].y.low && y <= frames[0].y.high;
    for well in &wells {
        frames[0].horizontal(&mut figure, well * 1e3, style::LINE, theme.stable, Some(style::DASH));
    }
    let lines: [(&[f64], f64, Ink); 3] =
        [(x, 1e3, theme.ink), (v, speed, theme.second), (accel, 1.0 / STANDARD_GRAVITY, theme.shaking)];
    for (frame, (values, scale, ink)) in frames.iter().zip(lines) {
        let pairs = t.iter().zip(values).map(|(t, value)| (*t, value * scale));
        frame.dense_line(&mut figure, pairs.filter(|pair| pair.1.is_finite()), style::FINE_LINE, ink);
    }
    impacts(&mut figure, &frames[0], trace, theme);
    frames.iter().for_each(|frame| frame.axes(&mut figure, theme));

    // The phase portrait.
    let from = t.partition_point(|t| *t < trace.portrait_from);
    let (px, pv) = (&x[from..], &v[from..]);
    let stops = [trace.stops.0, trace.stops.1];
    let far = px.iter().map(|x| x.abs()).filter(|x| x.is_finite()).fold(0.0, f64::max);
    let near = stops.into_iter().filter(|stop| stop.abs() <= 1.3 * far);
    let portrait = Frame::new(
        PORTRAIT,
        Axis::around(px.iter().copied().chain(near).map(|x| x * 1e3), 0.1, 6, "displacement, mm"),
        Axis::around(pv.iter().map(|v| v * speed), 0.08, 8, &speed_label),
    );
    portrait.grid(&mut figure, theme);
    for (stop, left) in [(trace.stops.0, true), (trace.stops.1, false)] {
        if stop.is_finite() {
            portrait.wall_across(&mut figure, stop * 1e3, left, theme);
        }
    }
    for well in &wells {
        portrait.vertical(&mut figure, well * 1e3, style::LINE, theme.stable, Some(style::DASH));
    }
    let path = px.iter().map(millis).zip(pv.iter().map(|v| v * speed));
    portrait.path(&mut figure, path, style::FINE_LINE, theme.second);
    portrait.axes(&mut figure, theme);

    let mut entries = Vec::new();
    if trace.impacts.rows() > 0 {
        entries.push((Sample::Ticks(theme.ink), "impact"));
    }
    if trace.rests.rows() > 0 {
        entries.push((Sample::Patch(theme.rest, None), "at rest on a stop"));
    }
    if trace.stops.0.is_finite() || trace.stops.1.is_finite() {
        entries.push((Sample::Patch(theme.wall_fill(), None), "stop"));
    }
    if wells.iter().any(|well| shown(well * 1e3)) {
        entries.push((Sample::Line(theme.stable, style::LINE, Some(style::DASH)), "well"));
    }
    legend(&mut figure, theme, &entries, LEFT, MIDDLE, 142.0);
    let span = format!("phase portrait from {} s on", short(trace.portrait_from));
    note(&mut figure, &span, (PORTRAIT.left, 152.0), style::TICK, theme.ink, false);
    account(&mut figure, summary, trace, speed_unit, speed, theme);
    caption.draw(&mut figure, theme, &subtitle(summary), LEFT);
    figure
}

/// The unit in which speeds up to those given are short numbers, with the factor from m/s.
pub fn speed_unit(values: impl Iterator<Item = f64>) -> (f64, &'static str) {
    let greatest = values.filter(|value| value.is_finite()).fold(0.0_f64, |a, b| a.max(b.abs()));
    if greatest < 2.0 { (1e3, "mm/s") } else { (1.0, "m/s") }
}

fn words<'a>(values: Option<&'a Values>) -> &'a [&'static str] {
    match values {
        Some(Values::Words(words)) => words,
        _ => &[],
    }
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

/// A tick for each impact at the edge on its stop's side, one a pixel where they lie closer.
fn impacts(figure: &mut Figure, frame: &Frame, trace: &Trace, theme: &Theme) {
    const TICK: f64 = 20.0;
    let times = trace.impacts.numbers("t_s").unwrap_or_default();
    let sides = words(trace.impacts.column("side").map(|column| &column.values));
    let mut last = [f64::NEG_INFINITY; 2];
    for (t, side) in times.iter().zip(sides) {
        let left = *side == "left";
        let at = frame.across(*t);
        if at - last[usize::from(left)] >= 1.5 {
            last[usize::from(left)] = at;
            let edge = if left { frame.area.bottom } else { frame.area.top };
            let inner = if left { edge - TICK } else { edge + TICK };
            figure.line(&[(at, edge), (at, inner)], 2.0, theme.ink, frame.area);
        }
    }
}

fn subtitle(summary: &Summary) -> String {
    match summary.outcome.ended_at() {
        Some(at) => format!("ended early at {} s: {}", short(at), summary.outcome.name().replace('_', " ")),
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
fn account(figure: &mut Figure, summary: &Summary, trace: &Trace, unit: &str, scale: f64, theme: &Theme) {
    let mut y = 738.0;
    let name = summary.regime.name();
    if summary.rms_velocity.is_some() && !name.is_empty() {
        let (shape, ink) = regime(name, theme);
        marker(figure, shape, (PORTRAIT.left + 14.0, y - 10.0), style::MARKER + 1.0, ink, theme.ink);
        note(figure, name, (PORTRAIT.left + 42.0, y), style::SUBTITLE, theme.ink, true);
        y += 40.0;
    }
    let mut lines = Vec::new();
    if let Some(rms) = summary.rms_velocity {
        lines.push(format!("settled, from {} s on:", short(trace.settle)));
        lines.push(format!("RMS velocity {} {unit}", short(rms * scale)));
    }
    if summary.rms_velocity.is_some() {
        let share = summary.rested_share.filter(|share| *share > 0.0);
        lines.push(match name {
            "" => format!("{} impacts", summary.impacts),
            _ => format!("{} crossings, {} impacts", summary.crossings, summary.impacts),
        });
        lines.extend(share.map(|share| format!("at rest {:.0} % of the time", 100.0 * share)));
    }
    if trace.path.rows() > 0 && lines.is_empty() {
        lines.push("ended before its settled window".to_owned());
    }
    for line in lines {
        note(figure, &line, (PORTRAIT.left, y), style::TICK, theme.ink, false);
        y += 36.0;
    }
}

fn note(figure: &mut Figure, words: &str, at: Point, size: f64, ink: Ink, bold: bool) {
    let room = f64::from(style::SIZE.0) - at.0 - 10.0;
    let words = super::figure::fitted(words, size, bold, room);
    debug_assert!(font::width(&words, size, bold) <= room + 1.0);
    figure.text(Text { words, at, size, ink, bold, align: Align::Left, upright: false });
}
