//! Lateness of another run's impacts.

use crate::dynamics::{Event, EventKind, Model};

/// Impacts slower than this share of the scene's speed are no arrivals but come from chatter or hops.
const SLOWEST: f64 = 0.01;

/// An impact on the same stop as the previous one is an arrival, not chatter, if it is faster than the
/// previous rebound by this factor.
const FASTER: f64 = 1.2;

/// An impact of the other run matches an arrival if it has at least this share of its speed; the hops of a
/// mass that should rest are slower.
const LEAST_SPEED: f64 = 0.5;

/// How late arrivals are, in s; early ones are below 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lateness {
    /// The median.
    pub median: f64,
    /// The earliest.
    pub earliest: f64,
    /// The latest.
    pub latest: f64,
    /// How many arrivals in a row were found in both runs.
    pub matched: usize,
    /// How many of those are early.
    pub early: usize,
    /// How many there are.
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
pub(super) fn lateness(model: &Model, compared: &[Event], exact: &[Event]) -> Option<Lateness> {
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
pub(super) fn hops(impacts: &[Event], exact: &[Event]) -> u64 {
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
