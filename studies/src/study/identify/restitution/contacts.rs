//! The stops of a record, and its contacts with them.

use std::ops::Range;

use super::meeting::{Meeting, Sides};
use super::{Motion, median};
use crate::study::identify::{Turn, turns};

/// A turning point at a stop.
#[derive(Debug, Clone)]
pub struct Contact {
    /// The sample where the record turns, and whether that is on the right stop.
    pub at: usize,
    pub right: bool,
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
    /// Speed towards the stop, once a better fit has shown it.
    pub speed: Option<f64>,
}

/// The coefficients of the polynomials by which impacts are found.
const TERMS: usize = 3;

const FEWEST: usize = 4;

/// Standard deviations, squared, by which two intersecting polynomials must fit better than a single one.
const CLEAR: f64 = 6.0;

/// Impacts on one stop differ in place by less than this share of the range and six standard errors.
const SAME_STOP: f64 = 0.005;

/// Impacts belong to a given stop if they are nearer to it than this share of the range.
const NEAR_GIVEN: f64 = 0.05;

impl Contact {
    /// Its instant, as far as it is known.
    pub fn time(&self, motion: &Motion) -> f64 {
        self.impact.map_or(motion.times[self.at], |impact| impact.t)
    }
}

/// The contacts in order of time, and the places of the left and the right stop where impacts show them.
///
/// A turning point is an impact if two parabolas that intersect there fit the samples around it better than
/// one polynomial with the same number of coefficients. A stop is at the outermost of these impacts, with no
/// sample beyond, or at the impacts near a `given` position. Turning points elsewhere are not contacts, nor
/// are those within the noise of a limit at which the record is cut off.
pub fn contacts(motion: &Motion, given: [Option<f64>; 2]) -> (Vec<Contact>, [Option<f64>; 2]) {
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
        let cut = motion.cut[usize::from(turn.maximum)];
        let is_hidden = cut.is_some_and(|cut| (motion.x[turn.at] - cut.limit).abs() < motion.back);
        let impact = if is_hidden { None } else { impact(motion, *turn, from..to) };
        contacts.push(Contact { at: turn.at, right: turn.maximum, impact, flights: turn.at..turn.at });
    }
    let stops = [false, true].map(|right| stop(motion, &contacts, right, given[usize::from(right)]));
    contacts.retain(|contact| {
        let Some(stop) = stops[usize::from(contact.right)] else { return false };
        let x = |i: usize| motion.x[i];
        match &contact.impact {
            Some(impact) => (impact.x - stop).abs() < 6.0 * impact.error + SAME_STOP * motion.range(),
            None => {
                let step = [contact.at - 1, contact.at + 1].map(|i| (x(i) - x(contact.at)).abs());
                let reach = step[0].max(step[1]) + motion.back + band(motion, &stops, contact.right);
                (x(contact.at) - stop).abs() < reach
            }
        }
    });
    limit(motion, &mut contacts, &stops);
    (contacts, stops)
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
            let better = both - each > CLEAR.powi(2) * variance && each < 0.25 * both.max(100.0 * variance);
            let fits = each < 4.0 * variance * samples as f64 || each < 0.1 * both;
            if better && fits {
                let error = motion.noise * found.of_x.sqrt() + (each / samples as f64).sqrt();
                let unsure = motion.noise * found.of_t.sqrt();
                return Some(Impact { t: found.t, x: found.x, error, unsure, speed: None });
            }
        }
        count = (count * 7 / 5).max(count + 1);
    }
}

/// The place of a stop: the median of the outermost impacts.
fn stop(motion: &Motion, contacts: &[Contact], right: bool, given: Option<f64>) -> Option<f64> {
    let (sign, edge) = if right { (1.0, motion.extent.1) } else { (-1.0, -motion.extent.0) };
    let same = |impact: &Impact| 6.0 * impact.error + SAME_STOP * motion.range();
    let counts = |impact: &Impact| match given {
        Some(place) => (impact.x - place).abs() < NEAR_GIVEN * motion.range(),
        None => sign * impact.x + same(impact) + motion.back > edge,
    };
    let of_side = contacts.iter().filter(|contact| contact.right == right);
    let impacts: Vec<Impact> = of_side.filter_map(|contact| contact.impact).filter(counts).collect();
    let inner = impacts.iter().map(|impact| sign * impact.x - 3.0 * impact.error);
    let outermost = inner.fold(f64::NEG_INFINITY, f64::max);
    let outer = impacts.iter().filter(|impact| sign * impact.x + same(impact) >= outermost);
    median(outer.map(|impact| impact.x).collect())
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
/// stop to the outermost sample, which is the uncertainty of its position.
fn band(motion: &Motion, stops: &[Option<f64>; 2], right: bool) -> f64 {
    let edge = if right { motion.extent.1 } else { motion.extent.0 };
    stops[usize::from(right)].map_or(0.0, |stop| motion.back.max(2.0 * (edge - stop).abs()))
}

/// Where a contact lies among the samples.
struct End {
    samples: Range<usize>,
    right: bool,
    impact: bool,
}

/// Finds the flights of each contact: from its instant to that of the next impact, or to where the mass comes
/// near a stop without one, or to a gap of the record.
pub fn limit(motion: &Motion, contacts: &mut [Contact], stops: &[Option<f64>; 2]) {
    let end = |contact: &Contact| {
        let between = |impact: Impact| motion.from(impact.t)..motion.from(impact.t);
        let samples = contact.impact.map_or(contact.at..contact.at + 1, between);
        End { samples, right: contact.right, impact: contact.impact.is_some() }
    };
    let ends: Vec<End> = contacts.iter().map(end).collect();
    let bands = [false, true].map(|right| band(motion, stops, right));
    let near = |i: usize, right: bool, part: f64| {
        let side = usize::from(right);
        stops[side].is_some_and(|stop| (motion.x[i] - stop).abs() < part * bands[side])
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
