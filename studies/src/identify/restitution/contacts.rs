//! The stops of a record, and its contacts with them.

use std::ops::Range;

use super::Motion;
use super::drift::{Drift, Stop, stop_at, stops, unexplained};
use super::meeting::{Meeting, Sides};
use crate::identify::{Turn, turns};

/// A turning point at a stop.
#[derive(Debug, Clone)]
pub struct Contact {
    /// The sample where the record turns, and whether that is on the right stop.
    pub at: usize,
    pub right: bool,
    /// The number of the stop.
    pub stop: usize,
    /// The impact, where the velocity jumps there.
    pub impact: Option<Impact>,
    /// The samples of the flights before it and after it.
    pub flights: Range<usize>,
}

/// An impact as a first fit locates it. SI.
#[derive(Debug, Clone, Copy)]
pub struct Impact {
    pub t: f64,
    pub x: f64,
    /// Standard error of the place.
    pub error: f64,
    /// Samples nearer in time than this may lie on either side of the impact.
    pub unsure: f64,
    /// Jump of the velocity.
    pub jump: f64,
    /// Speed towards the stop, once a better fit has shown it.
    pub speed: Option<f64>,
}

/// The coefficients of the polynomials by which impacts are found.
const TERMS: usize = 3;

const FEWEST: usize = 4;

/// Samples between turning points that are the same.
const NEAR: usize = 2;

/// Impacts that tell a drift from stops at several places.
const FEW: usize = 4;

/// Standard deviations, squared, by which two intersecting polynomials must fit better than a single one.
const CLEAR: f64 = 6.0;

/// Uniform drifts in which turning points are looked for where a record has few impacts, as shares of the
/// root of its mean square velocity. A rebound slower than the drift is no turning point of the record.
const DRIFTS: [f64; 8] = [0.0625, -0.0625, 0.125, -0.125, 0.25, -0.25, 0.5, -0.5];

/// Share of the longer step to its neighbours by which the sample at a turning point may differ from the fit
/// on its side. A mass that arrives at a stop, rests and leaves again would otherwise meet beyond the stop.
const AT_TURN: f64 = 0.25;

impl Contact {
    /// Moves its impact with a record from which a drift was subtracted.
    pub fn subtract(&mut self, motion: &Motion, drift: &Drift) {
        if let Some(impact) = &mut self.impact {
            impact.x -= drift.at(motion.part(impact.t)).0;
        }
    }

    /// Its instant, as far as it is known.
    pub fn time(&self, motion: &Motion) -> f64 {
        self.impact.map_or(motion.times[self.at], |impact| impact.t)
    }
}

/// The turning points in order of time, each with an impact if the velocity jumps there.
///
/// A turning point is an impact if two parabolas that intersect there fit the samples around it better than
/// one polynomial with the same number of coefficients. Within the noise of a limit at which the record is
/// cut off there is none.
fn turning_points(motion: &Motion) -> Vec<Contact> {
    let turning = turns(&motion.x, motion.back);
    let samples = motion.x.len();
    let mut contacts = Vec::new();
    for (k, turn) in turning.iter().enumerate() {
        if turn.at == 0 || turn.at + 1 >= samples {
            continue;
        }
        // maxima and minima alternate
        let before = k.checked_sub(2).map_or(0, |k| turning[k].at);
        let after = turning.get(k + 2).map_or(samples, |turn| turn.at);
        let from = (before + 1..=turn.at).rev().find(|i| motion.is_gap(*i)).unwrap_or(before);
        let to = (turn.at + 1..after).find(|i| motion.is_gap(*i)).unwrap_or(after);
        let impact = if motion.is_hidden(*turn) { None } else { impact(motion, *turn, from..to) };
        contacts.push(Contact {
            at: turn.at,
            right: turn.maximum,
            stop: 0,
            impact,
            flights: turn.at..turn.at,
        });
    }
    contacts
}

/// The turning points of the record, and those with an impact among the `earlier` ones and, if they are few,
/// in the record with a drift.
pub fn jumps(motion: &mut Motion, earlier: Vec<Contact>) -> Vec<Contact> {
    let mut found = turning_points(motion);
    let merge = |found: &mut Vec<Contact>, more: Vec<Contact>| {
        let new = |contact: &Contact| {
            contact.impact.is_some() && found.iter().all(|other| other.at.abs_diff(contact.at) > NEAR)
        };
        let more: Vec<Contact> = more.into_iter().filter(new).collect();
        found.extend(more);
    };
    merge(&mut found, earlier);
    if found.iter().filter(|contact| contact.impact.is_some()).count() < FEW {
        let speed = motion.speed();
        for share in DRIFTS {
            let drift = Drift::uniform(share * speed * motion.half());
            let back = Drift::uniform(-share * speed * motion.half());
            motion.subtract(&drift);
            let mut more = turning_points(motion);
            motion.subtract(&back);
            more.iter_mut().for_each(|contact| contact.subtract(motion, &back));
            merge(&mut found, more);
        }
    }
    found.sort_by_key(|contact| contact.at);
    found
}

/// The contacts with the stops: the impacts whose places agree, and the turning points near them that may be
/// impacts of flights too short to show it. The rate is the one that is `unexplained`.
pub fn contacts(motion: &Motion, mut contacts: Vec<Contact>) -> (Vec<Contact>, f64) {
    let (stops, members) = stops(motion, &contacts, 0.0);
    let lone = unexplained(motion, &contacts, &stops, &members);
    let mut members = members.into_iter();
    contacts.retain_mut(|contact| {
        let member = members.next().flatten();
        let Some(stop) = member.or_else(|| stop_at(&stops, contact.right, motion.times[contact.at])) else {
            return false;
        };
        contact.stop = stop;
        let x = |i: usize| motion.x[i];
        let step = [contact.at - 1, contact.at + 1].map(|i| (x(i) - x(contact.at)).abs());
        let reach = step[0].max(step[1]) + motion.back + band(motion, &stops[stop]);
        member.is_some() || contact.impact.is_none() && (x(contact.at) - stops[stop].x).abs() < reach
    });
    limit(motion, &mut contacts, &stops);
    (contacts, lone)
}

/// The impact at a turning point, from the fewest samples that show it.
fn impact(motion: &Motion, turn: Turn, within: Range<usize>) -> Option<Impact> {
    let variance = motion.noise.powi(2);
    let mut count = FEWEST;
    loop {
        let before = turn.at.saturating_sub(count).max(within.start)..turn.at;
        let after = turn.at + 1..(turn.at + 1 + count).min(within.end);
        let samples = before.len() + after.len();
        let (short, long) = (before.len().min(after.len()), before.len().max(after.len()));
        if short < FEWEST || (count > FEWEST && long < count) {
            return None;
        }
        let near = (count / 4).max(1);
        let (first, last) = (turn.at.saturating_sub(near), (turn.at + near).min(motion.x.len() - 1));
        let inside = |t: f64| (motion.times[first]..=motion.times[last]).contains(&t);
        let sides = Sides { before: motion.fit(before.clone()), after: motion.fit(after.clone()) };
        let found = sides.meet(motion, TERMS, motion.times[turn.at], turn.maximum);
        let turns_back = |found: &Meeting| found.towards > 0.0 && found.away > 0.0 && inside(found.t);
        if let (Some(found), Some((each, _))) = (found.filter(turns_back), sides.rest(TERMS)) {
            let both = motion.fit_both(before, after).squared_residuals(2 * TERMS).unwrap_or(0.0);
            // the sample at the turning point is in neither fit
            let side = if motion.times[turn.at] < found.t { &sides.before } else { &sides.after };
            let (apart, error) = motion.residual(side, turn.at, TERMS);
            let step = [turn.at - 1, turn.at + 1].map(|i| (motion.x[i] - motion.x[turn.at]).abs());
            let follows = apart < AT_TURN * step[0].max(step[1]) + CLEAR * motion.noise * error;
            let better = both - each > CLEAR.powi(2) * variance && each < 0.25 * both.max(100.0 * variance);
            let fits = each < 4.0 * variance * samples as f64 || each < 0.1 * both;
            if better && fits && follows {
                let error = motion.noise * found.of_x.sqrt() + (each / samples as f64).sqrt();
                let unsure = motion.noise * found.of_t.sqrt();
                let jump = found.towards + found.away;
                return Some(Impact { t: found.t, x: found.x, error, unsure, jump, speed: None });
            }
        }
        count = (count * 7 / 5).max(count + 1);
    }
}

/// Samples of the longest flight from a turning point to the next of its kind, less than half way across.
pub fn longest_rebound(motion: &Motion) -> Option<usize> {
    let rebound = |turns: &[Turn]| {
        let [first, top, last] = [turns[0].at, turns[1].at, turns[2].at];
        let height = [first, last].map(|i| (motion.x[i] - motion.x[top]).abs());
        // the mass may rest before or after it
        (height[0].max(height[1]) < 0.5 * motion.range()).then(|| 2 * (top - first).min(last - top))
    };
    turns(&motion.x, motion.back).windows(3).filter_map(rebound).max()
}

/// Distance from a stop within which a mass lies on it: that of the noise, or twice the distance from the
/// stop to the outermost sample of its impacts, which is the uncertainty of its position.
fn band(motion: &Motion, stop: &Stop) -> f64 {
    motion.back.max(2.0 * stop.beyond)
}

/// Where a contact lies among the samples.
struct End {
    samples: Range<usize>,
    right: bool,
    impact: bool,
}

/// Finds the flights of each contact: from its instant to that of the next impact, or to where the mass comes
/// near a stop without one, or to a gap of the record.
pub fn limit(motion: &Motion, contacts: &mut [Contact], stops: &[Stop]) {
    let end = |contact: &Contact| {
        let between = |impact: Impact| motion.from(impact.t)..motion.from(impact.t);
        let samples = contact.impact.map_or(contact.at..contact.at + 1, between);
        End { samples, right: contact.right, impact: contact.impact.is_some() }
    };
    let ends: Vec<End> = contacts.iter().map(end).collect();
    let near = |i: usize, right: bool, part: f64| {
        let stop = stop_at(stops, right, motion.times[i]).map(|k| &stops[k]);
        stop.is_some_and(|stop| (motion.x[i] - stop.x).abs() < part * band(motion, stop))
    };
    for (k, contact) in contacts.iter_mut().enumerate() {
        let (start, side) = (ends[k].samples.start, contact.right);
        // how many of the samples on the way to another contact belong to the flight
        let flight = |samples: &mut dyn Iterator<Item = usize>, end: Option<&End>| {
            // samples near a stop belong to a flight that ends by an impact on it
            let ends_on = |right: bool| end.is_some_and(|end| end.impact && end.right == right);
            let (mut count, mut left) = (0, false);
            for i in samples {
                left |= !near(i, side, 1.0);
                let back = left && near(i, side, 0.5) && !ends_on(side);
                if back || (near(i, !side, 0.5) && !ends_on(!side)) {
                    break;
                }
                count += 1;
                if motion.is_gap(if i < start { i } else { i + 1 }) {
                    break;
                }
            }
            if left { count } else { 0 }
        };
        let (before, after) = (k.checked_sub(1).map(|k| &ends[k]), ends.get(k + 1));
        let first = before.map_or(0, |end| end.samples.end);
        let last = after.map_or(motion.x.len(), |end| end.samples.start);
        let backward = flight(&mut (first..start).rev(), before);
        let onward = flight(&mut (start..last), after);
        contact.flights = start - backward..start + onward;
    }
}
