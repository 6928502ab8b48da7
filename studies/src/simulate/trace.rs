//! Samples of a run for a picture: the path with every jump of the velocity, and the spans at rest.
//!
//! A picture must be right even if few samples are requested, so its samples are separate.

use std::sync::atomic::AtomicBool;

use super::{Keep, Recorded, events_table, in_order, samples_table};
use crate::dynamics::{Event, EventKind, Live, LiveLedger, Model, Outcome, Phase, Request, Sample, Side};
use crate::study::Table;
use crate::study::watch::ledger_over;

/// The data of a run that a picture shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// `t_s,x_m,v_m_per_s,base_accel_m_per_s2,power_w` in order of time; an impact has two rows, before and
    /// after it. The power is that into the load of a transducer or, without a transducer, that of the base
    /// on the mass.
    pub path: Table,
    /// Whether the scene has a transducer.
    pub has_load: bool,
    /// `t_s,side` of every impact.
    pub impacts: Table,
    /// `from_s,to_s,side` of every span at rest on a stop.
    pub rests: Table,
    /// `t_s,x_m,v_m_per_s` once per forcing period, at the phase of time 0, over the phase portrait.
    pub strobes: Table,
    /// First time in s of the phase portrait: that of the last forcing periods, or of a requested window.
    pub portrait_from: f64,
    /// First time in s of the motion over time: 0, that of the last periods, or of a requested window.
    pub shown_from: f64,
    /// Last time in s of both.
    pub shown_to: f64,
    /// Whether these times are a requested window.
    pub is_section: bool,
    /// Positions of the left and the right stop in m; NaN without one.
    pub stops: (f64, f64),
    /// Time in s at which the run ended.
    pub end: f64,
    /// The energy ledger over the times that are shown; all zero unless [asked for](Self::with_ledger).
    pub ledger: LiveLedger,
}

impl Trace {
    /// The trace with the ledger of this model, whose run it is, over the times that are shown.
    #[must_use]
    pub fn with_ledger(self, model: &Model, cancel: Option<&AtomicBool>) -> Self {
        let ledger = ledger_over(model, (self.shown_from, self.shown_to), cancel);
        Self { ledger, ..self }
    }
}

/// Smallest and largest number of samples over a run: several per pixel column, and a bound on memory.
const OVERVIEW: (f64, f64) = (8_000.0, 400_000.0);

/// Samples per period of the drive or of small oscillations, whichever is shorter.
const PER_PERIOD: f64 = 80.0;

/// Forcing periods in a phase portrait: the longest recognised period of a response.
const PORTRAIT_PERIODS: f64 = 12.0;

/// Number of forcing periods above which a run over time would be drawn as a filled band.
const BAND_PERIODS: f64 = 60.0;
/// Number of last forcing periods that are then shown.
const SHOWN_PERIODS: f64 = 24.0;

const MAX_STROBES: u32 = 300;

/// Samples of a phase portrait.
const PORTRAIT: f64 = 24_000.0;

/// Largest number of rows in a phase portrait; more, as from a million impacts, would cover it completely.
const MAX_PORTRAIT_ROWS: usize = 60_000;

/// Runs `model` and returns what `keep` requests and the data of a picture of a `window` in s, or of all.
pub fn simulate_with_trace(
    model: &Model,
    keep: &Keep,
    window: Option<(f64, f64)>,
    cancel: Option<&AtomicBool>,
) -> (Recorded, Trace) {
    let request = Request { cancel, until_settled: keep.until_settled, ..Request::default() };
    // the sample times depend on the end of the run and on its settled window
    let span = match keep.until_settled {
        Some(_) => model.run(&request).summary.window,
        None => (model.settle(), model.duration()),
    };
    let mut close = window.unwrap_or((portrait_from(model, span), span.1));
    let sampled = |close: (f64, f64), end: f64| {
        let strobes = strobe_times(model, close);
        (ascending(picture_times(model, close, end).into_iter().chain(strobes.clone()).collect()), strobes)
    };
    let (mut picture_samples, mut strobes) = sampled(close, span.1);
    let times = ascending(picture_samples.iter().chain(&keep.times).copied().collect());
    let run = model.run(&Request { sample_times: &times, events: true, ledger: true, ..request });
    let (left, right) = model.stop_positions();
    let end = run.summary.outcome.ended_at().unwrap_or(span.1);
    let mut shown = in_order(&picture_samples, &run.samples);
    if end < span.1 && !matches!(run.summary.outcome, Outcome::Cancelled { .. }) {
        // the run ended where it has few samples, so it is repeated with samples up to its end
        close = window.filter(|(from, _)| *from < end).map_or((0.0, end), |(from, to)| (from, to.min(end)));
        (picture_samples, strobes) = sampled(close, end);
        shown = model.run(&Request { sample_times: &picture_samples, ..request }).samples;
    }
    let path = path(model, &shown, &jumps(model, &run.events, request));
    let rows = path.numbers("t_s").unwrap_or_default();
    let (mut portrait_from, shown_to) = close;
    let until = rows.partition_point(|t| *t <= shown_to);
    if let Some(t) = until.checked_sub(MAX_PORTRAIT_ROWS).map(|first| rows[first]) {
        portrait_from = portrait_from.max(t);
    }
    let shown_from = match window {
        Some(_) => close.0,
        None if end < span.1 => 0.0,
        None => shown_from(model, end),
    };
    let is_strobe = |sample: &&Sample| sample.t >= portrait_from && strobes.contains(&sample.t);
    let strobes: Vec<&Sample> = shown.iter().filter(is_strobe).collect();
    let strobes = Table::new()
        .each("t_s", &strobes, |sample| sample.t)
        .each("x_m", &strobes, |sample| sample.x)
        .each("v_m_per_s", &strobes, |sample| sample.v);
    let trace = Trace {
        path,
        has_load: model.has_transducer(),
        strobes,
        impacts: impacts(&run.events),
        rests: rests(&run.events, run.samples.first(), end),
        portrait_from,
        shown_from,
        shown_to,
        is_section: window.is_some(),
        stops: (left.unwrap_or(f64::NAN), right.unwrap_or(f64::NAN)),
        end,
        ledger: LiveLedger::default(),
    };
    let samples = samples_table(&in_order(&keep.times, &run.samples), |sample| model.output(sample));
    let events = events_table(if keep.events { &run.events } else { &[] });
    (Recorded { samples, events, summary: run.summary }, trace)
}

/// First time in s of the phase portrait of a run with this settled window.
fn portrait_from(model: &Model, (settle, end): (f64, f64)) -> f64 {
    model.forcing_period().map_or(0.0, |period| settle.max(end - PORTRAIT_PERIODS * period).min(end))
}

fn shown_from(model: &Model, end: f64) -> f64 {
    let repeats = model.excitation().tones.iter().all(|tone| tone.ramp.is_none());
    match model.forcing_period() {
        Some(period) if repeats && end > BAND_PERIODS * period => end - SHOWN_PERIODS * period,
        _ => 0.0,
    }
}

/// The times in s of the last ends of forcing periods in a range; empty without a period.
fn strobe_times(model: &Model, (from, to): (f64, f64)) -> Vec<f64> {
    let Some(period) = model.forcing_period() else { return Vec::new() };
    let last = (to / period).floor();
    let first = (from / period).ceil().max(last - f64::from(MAX_STROBES) + 1.0);
    let numbers = (0..MAX_STROBES).map(|i| first + f64::from(i));
    numbers.take_while(|number| *number <= last).map(|number| number * period).collect()
}

fn ascending(mut times: Vec<f64>) -> Vec<f64> {
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

/// Even times up to `duration` and closer ones over the range `close`, in ascending order.
fn picture_times(model: &Model, close: (f64, f64), duration: f64) -> Vec<f64> {
    let swing = std::f64::consts::TAU * model.scales().time;
    let fastest = model.forcing_period().map_or(swing, |period| period.min(swing));
    let count = (duration / fastest * PER_PERIOD).clamp(OVERVIEW.0, OVERVIEW.1).floor();
    let even = |(from, to): (f64, f64), count: f64| {
        let time = move |i: u32| (from + (to - from) * f64::from(i) / count).min(duration);
        (0..=count as u32).map(time)
    };
    ascending(even((0.0, duration), count).chain(even(close, PORTRAIT)).collect())
}

/// The states before and after each impact, where velocity and power jump. The state of a circuit, which an
/// event does not have, is that of a sample of the same run at its time.
fn jumps(model: &Model, events: &[Event], request: Request) -> Vec<[Sample; 2]> {
    let impacts = || events.iter().filter(|event| event.kind == EventKind::Impact);
    let circuit = model.has_electrical_state() && impacts().next().is_some();
    let times = if circuit { ascending(impacts().map(|jump| jump.t).collect()) } else { Vec::new() };
    let charged = match circuit {
        true => model.run(&Request { sample_times: &times, ..request }).samples,
        false => Vec::new(),
    };
    let live = Live::new(model);
    let jump = |event: &Event| {
        let x = model.stop(event.side).map_or(f64::NAN, |stop| stop.x);
        let electrical = match charged.binary_search_by(|sample| sample.t.total_cmp(&event.t)) {
            Ok(place) => charged[place].electrical,
            Err(_) if circuit => f64::NAN,
            Err(_) => 0.0,
        };
        let base_accel = live.base_acceleration(event.t);
        let state = |v: f64| Sample { t: event.t, x, v, base_accel, phase: Phase::Free, electrical };
        [event.v_in, event.v_out].map(state)
    };
    impacts().map(jump).collect()
}

/// Samples and jumps in order of time. A sample at the time of an impact is the state after it.
fn path(model: &Model, samples: &[Sample], jumps: &[[Sample; 2]]) -> Table {
    let mut rows: Vec<&Sample> = Vec::with_capacity(samples.len() + 2 * jumps.len());
    let mut jumps = jumps.iter().peekable();
    for sample in samples {
        while let Some(jump) = jumps.next_if(|jump| jump[0].t <= sample.t) {
            rows.extend(jump);
        }
        rows.push(sample);
    }
    let work_rate = |sample: &Sample| sample.work_rate(model.mass());
    let power =
        |sample: &&Sample| model.output(sample).map_or_else(|| work_rate(sample), |output| output.power);
    Table::new()
        .each("t_s", &rows, |row| row.t)
        .each("x_m", &rows, |row| row.x)
        .each("v_m_per_s", &rows, |row| row.v)
        .each("base_accel_m_per_s2", &rows, |row| row.base_accel)
        .each("power_w", &rows, power)
}

fn impacts(events: &[Event]) -> Table {
    let struck = |event: &&Event| {
        event.kind == EventKind::Impact || (event.kind == EventKind::Contact && event.v_in != 0.0)
    };
    let impacts: Vec<&Event> = events.iter().filter(struck).collect();
    Table::new().each("t_s", &impacts, |impact| impact.t).each("side", &impacts, |impact| impact.side.name())
}

/// Share of the run below which a contact with a compliant stop is too short to be shown as a span.
const SHORTEST_SPAN: f64 = 5e-4;

/// Spans from each rest to the release that follows, or to the end of the run.
fn rests(events: &[Event], first: Option<&Sample>, end: f64) -> Table {
    let mut spans: Vec<(f64, f64, Side)> = Vec::new();
    let mut open = first.and_then(|sample| match sample.phase {
        Phase::Free => None,
        Phase::LeftStop => Some((sample.t, Side::Left)),
        Phase::RightStop => Some((sample.t, Side::Right)),
    });
    for event in events {
        match event.kind {
            EventKind::Rest | EventKind::Contact => open = open.or(Some((event.t, event.side))),
            EventKind::Separate => {
                let long = open.take().filter(|(from, _)| event.t - from > end * SHORTEST_SPAN);
                spans.extend(long.map(|(from, side)| (from, event.t, side)));
            }
            EventKind::Release => {
                spans.extend(open.take().map(|(from, side)| (from, event.t, side)));
            }
            _ => {}
        }
    }
    spans.extend(open.map(|(from, side)| (from, end, side)));
    let table = Table::new().each("from_s", &spans, |span| span.0).each("to_s", &spans, |span| span.1);
    table.each("side", &spans, |span| span.2.name())
}

/// Displacements in m and velocities in m/s at `count` - 1 even times between two samples of a flight,
/// without the samples themselves. Empty between samples at the same time or at rest.
///
/// For pictures: samples that are dense enough for an oscillation are too sparse if taut flexures reverse the
/// velocity within a hundredth of a period. The classical Runge-Kutta method integrates from one sample to
/// the next, with linear interpolation of the base acceleration; its error at the next sample is distributed
/// linearly over the points.
pub fn between(model: &Model, from: &Sample, to: &Sample, count: usize) -> Vec<(f64, f64)> {
    let whole = to.t - from.t;
    if !(whole > 0.0) || from.phase != Phase::Free || count < 2 {
        return Vec::new();
    }
    let h = whole / count as f64;
    let rate = |share: f64, (x, v): (f64, f64)| {
        let base = from.base_accel + share * (to.base_accel - from.base_accel);
        (v, model.acceleration(x, v, base))
    };
    let mut at = (from.x, from.v);
    let mut points = Vec::with_capacity(count);
    for i in 0..count {
        let share = |part: f64| (i as f64 + part) / count as f64;
        let stage = |k: (f64, f64), part: f64| (at.0 + part * h * k.0, at.1 + part * h * k.1);
        let k1 = rate(share(0.0), at);
        let k2 = rate(share(0.5), stage(k1, 0.5));
        let k3 = rate(share(0.5), stage(k2, 0.5));
        let k4 = rate(share(1.0), stage(k3, 1.0));
        let mean = |a: f64, b: f64, c: f64, d: f64| (a + 2.0 * (b + c) + d) / 6.0;
        at = (at.0 + h * mean(k1.0, k2.0, k3.0, k4.0), at.1 + h * mean(k1.1, k2.1, k3.1, k4.1));
        points.push(at);
    }
    let missed = (to.x - at.0, to.v - at.1);
    if !(missed.0.is_finite() && missed.1.is_finite()) {
        // the motion has left the force curve
        return Vec::new();
    }
    points.pop();
    for (i, point) in (1..).zip(points.iter_mut()) {
        let share = f64::from(i) / count as f64;
        *point = (point.0 + share * missed.0, point.1 + share * missed.1);
    }
    points
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;
    use std::sync::Arc;

    use super::*;
    use crate::mechanics::Mechanism;
    use crate::scene::Document;

    #[test]
    fn a_quarter_of_a_swing_is_round() {
        let mut document = Document::load("monostable").unwrap();
        for change in ["mechanism.cubic_n_per_m3=0", "damping=None", "excitation=None"] {
            document.set(change).unwrap();
        }
        let mechanism = Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
        let model = Model::build(&document.scene, Arc::new(mechanism)).unwrap();
        let w = (40.0_f64 / 15.2e-3).sqrt();
        let quarter = 0.25 * TAU / w;
        let sample =
            |t: f64, x: f64, v: f64| Sample { t, x, v, base_accel: 0.0, phase: Phase::Free, electrical: 0.0 };
        let points = between(&model, &sample(0.0, 0.0, w * 1e-3), &sample(quarter, 1e-3, 0.0), 9);
        assert_eq!(points.len(), 8);
        for (i, (x, v)) in (1..).zip(&points) {
            let (sine, cosine) = (0.25 * TAU * f64::from(i) / 9.0).sin_cos();
            assert!((x - 1e-3 * sine).abs() < 1e-7 && (v - w * 1e-3 * cosine).abs() < 1e-5, "{i} {x} {v}");
        }
        assert!(between(&model, &sample(1.0, 0.0, 1.0), &sample(1.0, 0.0, -1.0), 9).is_empty());
        let rests = Sample { phase: Phase::LeftStop, ..sample(0.0, 0.0, 0.0) };
        assert!(between(&model, &rests, &sample(1.0, 0.0, 0.0), 9).is_empty());
    }
}
