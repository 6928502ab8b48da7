//! Effect of the size of a fixed step on a scene: its path, its statistics, and how late its impacts are.

use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Deserialize, Serialize};

use super::trust::{Beside, times};
use crate::accuracy::methods::{MethodRun, Scheme, Statistics, fixed_step, path};
use crate::accuracy::precision::{MEASURED_FOR, median};
use crate::dynamics::{Event, EventKind, Model, Request};
use crate::study::finished;

/// Tolerance of the true run, unless that of the scene is tighter.
pub const TRUE_TOLERANCE: f64 = 1e-9;

/// Periods of the drive, or characteristic times of the motion, that are drawn.
const DRAWN_PERIODS: f64 = 3.0;

/// Largest number of points of a drawn path; if there are more steps, evenly spaced points take their place.
const MAX_POINTS: usize = 4_000;

/// Largest number of steps of a run: a few seconds on one core.
const MAX_STEPS: f64 = 2e7;
/// Number of sines in the drive whose evaluation takes as long as the rest of a step.
const SINES: f64 = 16.0;

/// Why a scene has no such run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
pub enum Unfit {
    /// Its stops are compliant, and clamp and bounce needs rigid ones.
    #[error("clamp and bounce is for rigid stops, and these give way")]
    Compliant,
    /// Its transducer has an electrical state, which the schemes do not step.
    #[error("the schemes step displacement and velocity, and its transducer has a state of its own")]
    ElectricalState,
    /// It was cancelled.
    #[error("cancelled")]
    Cancelled,
}

/// A run in fixed steps with clamp and bounce beside the true one, from the scene's start.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StepSize {
    /// The scheme.
    pub scheme: Scheme,
    /// Its step in s.
    pub step: f64,
    /// Time in s over which both were run: the scene's run, or as much of it as 2e7 steps reach.
    pub span: f64,
    /// Time in s that the paths cover.
    pub drawn: f64,
    /// The true path: time in s and displacement in m, impacts among its points.
    pub truth: Vec<(f64, f64)>,
    /// The other path, a point a step.
    pub ghost: Vec<(f64, f64)>,
    /// How late the mass arrives at its stops; `None` if it arrives at none, or in one run only.
    pub late: Option<Lateness>,
    /// Impacts of the run in fixed steps while the true mass rests on a stop.
    pub hops: u64,
    /// Largest difference of the displacement in m.
    pub error: f64,
    /// Time in s up to which it follows the true path within a hundredth of the travel; `None` if that is all
    /// of the time.
    pub trusted: Option<f64>,
    /// The numbers of the true run.
    pub exact: Statistics,
    /// The numbers of the run in fixed steps.
    pub stepped: Statistics,
}

impl StepSize {
    /// Relative error of the RMS velocity; above 0 if it is too high.
    pub fn rms_error(&self) -> Option<f64> {
        let (exact, stepped) = (self.exact.rms_velocity?, self.stepped.rms_velocity?);
        (exact > 0.0).then(|| stepped / exact - 1.0)
    }
}

/// Runs `model` by `scheme` in even steps of `step` in s, and once accurately.
///
/// The true run is the program's own at the scene's tolerance or [`TRUE_TOLERANCE`], whichever is tighter. In
/// chaos the differences beyond the time `trusted` are no more than those between two equally true runs.
pub fn step_size(model: &Model, scheme: Scheme, step: f64, cancel: &AtomicBool) -> Result<StepSize, Unfit> {
    if model.compliant().is_some() {
        return Err(Unfit::Compliant);
    }
    if model.has_electrical_state() {
        return Err(Unfit::ElectricalState);
    }
    let model = &within_reach(model, step).with_tolerance(model.tolerance().min(TRUE_TOLERANCE));
    let drawn = model.duration().min(DRAWN_PERIODS * model.characteristic_time());
    let (even, fine, steps) = (times(model), spread(drawn, MAX_POINTS), step_times(drawn, step));

    let request =
        |sample_times| Request { sample_times, events: true, cancel: Some(cancel), ..Request::default() };
    let run = finished(model.run(&request(&even))).ok_or(Unfit::Cancelled)?;
    let truth = finished(model.run(&request(&fine))).ok_or(Unfit::Cancelled)?;

    let bare = Request { events: false, ..request(&[]) };
    let mut stepped = fixed_step(model, scheme, step, &request(&even));
    // the same run up to where it is drawn
    let ghost = fixed_step(&model.with_duration(drawn, 0.0), scheme, step, &request(&steps)).path;
    if stepped.statistics.cpu_s <= MEASURED_FOR {
        stepped.statistics.cpu_s = median(|| fixed_step(model, scheme, step, &bare).statistics.cpu_s);
    }
    let hops = hops(&stepped.impacts, &run.events);
    let mut exact = MethodRun::from(run);
    exact.statistics.cpu_s = median(|| model.run(&bare).summary.cpu_s);
    if cancel.load(Ordering::Relaxed) {
        return Err(Unfit::Cancelled);
    }
    let beside = Beside::new(model, &stepped.path, &exact.path);
    Ok(StepSize {
        scheme,
        step,
        span: model.duration(),
        drawn,
        truth: with_impacts(model, path(&truth), &exact.impacts),
        ghost,
        late: lateness(model, &stepped.impacts, &exact.impacts),
        hops,
        error: beside.error(),
        trusted: beside.parted(),
        exact: exact.statistics,
        stepped: stepped.statistics,
    })
}

/// The model with its run shortened to what steps of this size reach in reasonable time; its settled window
/// begins at half of that at the latest.
fn within_reach(model: &Model, step: f64) -> Model {
    let reach = step * MAX_STEPS / (1.0 + model.excitation().tones.len() as f64 / SINES);
    match model.duration() > reach {
        true => model.with_duration(reach, model.settle().min(0.5 * reach)),
        false => model.clone(),
    }
}

/// Even times in s from 0 to `end`.
fn spread(end: f64, count: usize) -> Vec<f64> {
    (0..=count).map(|i| (end * (i as f64 / count as f64)).min(end)).collect()
}

/// The ends of steps from 0 to `end` in s, or as many even times as are drawn if there are more steps.
fn step_times(end: f64, step: f64) -> Vec<f64> {
    let count = (end / step).ceil();
    spread(end, if count >= 1.0 { count.min(MAX_POINTS as f64) as usize } else { 1 })
}

/// The path with its corners at impacts, which a picture with few points would cut off.
fn with_impacts(model: &Model, mut path: Vec<(f64, f64)>, impacts: &[Event]) -> Vec<(f64, f64)> {
    let end = path.last().map_or(0.0, |last| last.0);
    let corner =
        |impact: &Event| model.stop(impact.side).filter(|_| impact.t <= end).map(|stop| (impact.t, stop.x));
    path.extend(impacts.iter().filter_map(corner));
    path.sort_by(|a, b| a.0.total_cmp(&b.0));
    path
}

/// Impacts slower than this share of the scene's speed are no arrivals but come from chatter or hops.
const SLOWEST: f64 = 0.01;

/// An impact on the same stop as the previous one is an arrival, not chatter, if it is faster than the
/// previous rebound by this factor.
const FASTER: f64 = 1.2;

/// An impact of the other run matches an arrival if it has at least this share of its speed; the hops of a
/// mass that should rest are slower.
const LEAST_SPEED: f64 = 0.5;

/// How late arrivals are, in s; early ones are below 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Lateness {
    /// The median.
    pub median: f64,
    /// The earliest.
    pub earliest: f64,
    /// The latest.
    pub latest: f64,
    /// Number of arrivals in a row that were found in both runs.
    pub matched: usize,
    /// Number of those that are early.
    pub early: usize,
    /// Number of arrivals in the true run.
    pub of: usize,
}

impl Lateness {
    /// The lateness of largest magnitude.
    pub fn worst(&self) -> f64 {
        if self.latest.abs() >= self.earliest.abs() { self.latest } else { self.earliest }
    }
}

/// How late the arrivals among the impacts of `exact` are in the run whose impacts are `compared`, both in
/// order of time; `None` if no arrival is in both.
///
/// An arrival is the first impact after a flight across or after a push, not the rebounds that follow it. It
/// is looked for among the impacts of the other run on the same stop, within half the time to its neighbours.
/// If one is not found, the other run has taken another course, and the rest is not compared.
fn lateness(model: &Model, compared: &[Event], exact: &[Event]) -> Option<Lateness> {
    let arrivals = arrivals(exact, SLOWEST * model.scales().speed);
    let mut late: Vec<f64> = Vec::new();
    for (i, arrival) in arrivals.iter().enumerate() {
        let same = |other: &&Event| other.side == arrival.side;
        let gaps = [arrivals[..i].iter().rfind(same), arrivals[i + 1..].iter().find(same)];
        let gap = gaps.into_iter().flatten().map(|other| (other.t - arrival.t).abs()).reduce(f64::min);
        let room = 0.5 * gap.unwrap_or(model.characteristic_time());
        let Some(found) = nearest(compared, arrival, room) else { break };
        late.push(found.t - arrival.t);
    }
    late.sort_by(f64::total_cmp);
    let (earliest, latest) = (*late.first()?, *late.last()?);
    let median = late[late.len() / 2];
    let early = late.iter().filter(|late| **late < 0.0).count();
    Some(Lateness { median, earliest, latest, matched: late.len(), early, of: arrivals.len() })
}

/// The number of impacts while the mass of the exact run rests on a stop: hops of a mass that is pressed
/// there. `exact` are all events of that run, in order of time.
fn hops(impacts: &[Event], exact: &[Event]) -> u64 {
    let is_turn = |event: &&Event| matches!(event.kind, EventKind::Rest | EventKind::Release);
    let turns: Vec<&Event> = exact.iter().filter(is_turn).collect();
    let is_hop = |impact: &&Event| {
        let after = turns.partition_point(|turn| turn.t < impact.t);
        let (before, next) = (turns[..after].last(), turns.get(after));
        // a run whose first such event is a release has rested from the start
        let rests = before.map_or_else(
            || next.is_some_and(|next| next.kind == EventKind::Release),
            |before| before.kind == EventKind::Rest,
        );
        rests && next.is_none_or(|next| impact.t < next.t)
    };
    impacts.iter().filter(is_hop).count() as u64
}

fn arrivals(impacts: &[Event], slowest: f64) -> Vec<Event> {
    let mut before: Option<&Event> = None;
    let mut found = Vec::new();
    for impact in impacts {
        let new = before.is_none_or(|before| {
            before.side != impact.side || impact.v_in.abs() > FASTER * before.v_out.abs()
        });
        if new && impact.v_in.abs() > slowest {
            found.push(*impact);
        }
        before = Some(impact);
    }
    found
}

/// The impact on the same stop that is nearest in time, fast enough and not further than `room` in s.
fn nearest<'a>(impacts: &'a [Event], arrival: &Event, room: f64) -> Option<&'a Event> {
    let from = impacts.partition_point(|other| other.t < arrival.t - room);
    let near = impacts[from..].iter().take_while(|other| other.t <= arrival.t + room);
    let alike =
        |other: &&Event| other.side == arrival.side && other.v_in.abs() >= LEAST_SPEED * arrival.v_in.abs();
    near.filter(alike).min_by(|a, b| (a.t - arrival.t).abs().total_cmp(&(b.t - arrival.t).abs()))
}
