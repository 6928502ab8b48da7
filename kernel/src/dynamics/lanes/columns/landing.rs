//! Arrivals of steps of all lanes at breaks, and their turning points.
//!
//! A single motion does the same arithmetic (`step/exit.rs`, `record/steps.rs`) and gets the same bits.

use super::{Clocks, Columns};
use crate::dynamics::series::polynomial;
use crate::dynamics::step::chord::{CLEARANCE, Chord, ROUNDING};
use crate::numeric::{Lanes, Scalar, single_root};

/// The ends of the steps of all lanes.
pub(super) struct Arrivals<const W: usize> {
    pub length: Lanes<W>,
    pub x: Lanes<W>,
    pub v: Lanes<W>,
    pub acceleration: Lanes<W>,
    pub at: Clocks<W>,
    /// The drive and its time derivative per unit amplitude.
    pub unit: (Lanes<W>, Lanes<W>),
}

type Three<const W: usize> = (Lanes<W>, Lanes<W>, Lanes<W>);

impl<const W: usize> Columns<W> {
    /// The drive and its time derivative per unit amplitude.
    #[inline(always)]
    pub(super) fn drive_at(&self, at: &Clocks<W>) -> (Lanes<W>, Lanes<W>) {
        let (mut value, mut slope) = (at.phase, at.phase);
        for lane in 0..W {
            let turns = at.phase.0[lane] * self.frequency.0[lane] + self.turn.0[lane];
            let (s, c) = f64::sin_cos_turns(turns);
            let omega = f64::tau() * self.frequency.0[lane];
            value.0[lane] = if self.quarter[lane] { c } else { s };
            slope.0[lane] = if self.quarter[lane] { -(s * omega) } else { c * omega };
        }
        (value, slope)
    }

    /// Shortens steps of `candidates` to the break that they meet, the break ahead or the one just left, if
    /// the root is found at once. Returns the lanes whose steps end there.
    #[inline(always)]
    pub(super) fn land(
        &self,
        candidates: &[bool; W],
        y: &[Lanes<W>],
        bound: &Lanes<W>,
        to: &mut Arrivals<W>,
    ) -> [bool; W] {
        let (mut meets, mut returns, mut level) = ([false; W], [false; W], to.x);
        for lane in 0..W {
            let (from, x, v) = (self.x.0[lane], to.x.0[lane], self.v.0[lane]);
            let (low, high) = (self.low_break.0[lane], self.high_break.0[lane]);
            let (ahead_low, ahead_high) = ((v < 0.0) & (from > low), (v > 0.0) & (from < high));
            let back_low = (self.touch.0[lane] < 0.0) & (self.high_end.0[lane] - from > bound.0[lane]);
            let back_high = (self.touch.0[lane] > 0.0) & (from - self.low_end.0[lane] > bound.0[lane]);
            let falls = (x < low) & (ahead_low | back_low);
            let rises = (x > high) & (ahead_high | back_high);
            meets[lane] = candidates[lane] & !self.logged[lane] & (falls | rises);
            returns[lane] = falls & (self.touch.0[lane] < 0.0) | rises & (self.touch.0[lane] > 0.0);
            level.0[lane] = if falls { low } else { high };
        }
        if !meets.contains(&true) {
            return meets;
        }
        let (from, whole) = (self.x - level, to.length);
        let (v, last, past) = (self.v * whole, to.v * whole, to.x - level);
        let mut g = polynomial::scaled(y, whole);
        let second = g[2];
        // a lane that returns to the break: the gap divided by the time since the start
        g[0] = from;
        for k in 0..y.len() {
            g[k] = choose(&returns, g[k], g[k + 1]);
        }
        let first = (choose(&returns, from, v), choose(&returns, v, second));
        let last = (past, choose(&returns, last, last - past));
        let (share, found) = roots(&g[..y.len()], &meets, first, last);
        let length = choose(&found, whole, share * whole);
        let arrival = polynomial::slope(y, length);
        let acceleration = polynomial::curvature(y, length);
        let deviations = polynomial::chord_deviations(y, length);
        let square = length * length;
        let (slopes, curvatures) =
            ((self.v * length, arrival * length), ((y[2] + y[2]) * square, acceleration * square));
        let mut landed = [false; W];
        for lane in 0..W {
            let chord = chord(lane, slopes, curvatures, deviations);
            let alone = if returns[lane] { chord.bends_one_way() } else { chord.is_monotone() };
            let outward = (arrival.0[lane] > 0.0) == (past.0[lane] > 0.0);
            landed[lane] = found[lane] & alone & outward & (arrival.0[lane] != 0.0);
        }
        to.length = choose(&landed, whole, length);
        to.x = choose(&landed, to.x, level);
        to.v = choose(&landed, to.v, arrival);
        to.acceleration = choose(&landed, to.acceleration, acceleration);
        to.at = self.at.advance(&to.length, &self.period);
        to.unit = self.drive_at(&to.at);
        landed
    }

    /// Evaluates steps at four times in their interior. Sets `clear` for lanes that stay clear of the low and
    /// of the high end of the mode, and resets `turning` for lanes that do not turn beyond the extremes.
    #[inline(always)]
    pub(super) fn look_closer(
        &self,
        y: &[Lanes<W>],
        to: &Arrivals<W>,
        (bound, deviation): (&Lanes<W>, &Lanes<W>),
        (low, high): (&Lanes<W>, &Lanes<W>),
        clear: &mut ([bool; W], [bool; W]),
        turning: &mut [bool; W],
    ) {
        let at = |share: f64| to.length * Lanes([share; W]);
        let times = (at(0.2), at(0.4), at(0.6), at(0.8));
        let (a, b, c, d) = polynomial::at_four_times(y.len(), |k| y[k], 0, times);
        for (lane, turning) in turning.iter_mut().enumerate() {
            let positions = [a, b, c, d].map(|value| value.0[lane] + self.origin.0[lane]);
            let (start, end) = (y[0].0[lane] + self.origin.0[lane], to.x.0[lane]);
            let lowest = positions.into_iter().fold(start.min(end), f64::min);
            let highest = positions.into_iter().fold(start.max(end), f64::max);
            // five chords, each of a fifth of the length
            let off = deviation.0[lane] * (CLEARANCE / 25.0) + bound.0[lane] * ROUNDING;
            clear.0[lane] |= lowest - off > self.low_end.0[lane];
            clear.1[lane] |= highest + off < self.high_end.0[lane];
            *turning &= (lowest - off < low.0[lane]) | (highest + off > high.0[lane]);
        }
    }

    /// Includes in the extremes the turning points of those `turning` lanes that turn once. Returns these
    /// lanes.
    #[inline(always)]
    pub(super) fn turn(
        &self,
        turning: &[bool; W],
        y: &[Lanes<W>],
        to: &Arrivals<W>,
        (slopes, curvatures, deviations): ((Lanes<W>, Lanes<W>), (Lanes<W>, Lanes<W>), Three<W>),
        (low, high): (&mut Lanes<W>, &mut Lanes<W>),
    ) -> [bool; W] {
        let curvatures = (curvatures.0, polynomial::curvature(y, to.length) * (to.length * to.length));
        let mut turned = [false; W];
        for (lane, turned) in turned.iter_mut().enumerate() {
            *turned = turning[lane] & chord(lane, slopes, curvatures, deviations).turns_once();
        }
        let velocity = polynomial::scaled_slope(y, to.length);
        let ends = ((slopes.0, curvatures.0), (slopes.1, curvatures.1));
        let (share, turned) = roots(&velocity[..y.len() - 1], &turned, ends.0, ends.1);
        let x = polynomial::value(y, share * to.length) + self.origin;
        for (lane, turned) in turned.iter().enumerate() {
            let x = x.0[lane].max(self.low_end.0[lane]).min(self.high_end.0[lane]);
            let (lowest, highest) = (low.0[lane].min(x), high.0[lane].max(x));
            low.0[lane] = if *turned { lowest } else { low.0[lane] };
            high.0[lane] = if *turned { highest } else { high.0[lane] };
        }
        turned
    }
}

/// Bounds of a lane's velocity and acceleration over a step.
#[inline(always)]
fn chord<const W: usize>(
    lane: usize,
    slopes: (Lanes<W>, Lanes<W>),
    curvatures: (Lanes<W>, Lanes<W>),
    deviations: Three<W>,
) -> Chord<f64> {
    let far = f64::INFINITY;
    Chord {
        start: 0.0,
        end: 0.0,
        bound: far,
        deviations: (far, deviations.1.0[lane], deviations.2.0[lane]),
        slopes: (slopes.0.0[lane], slopes.1.0[lane]),
        curvatures: (curvatures.0.0[lane], curvatures.1.0[lane]),
        limits: (-far, far),
    }
}

/// The roots of the `wanted` lanes, from values and slopes at both ends, and the lanes in which one is found.
#[inline(always)]
fn roots<const W: usize>(
    g: &[Lanes<W>],
    wanted: &[bool; W],
    first: (Lanes<W>, Lanes<W>),
    last: (Lanes<W>, Lanes<W>),
) -> (Lanes<W>, [bool; W]) {
    let (mut share, mut found) = (first.0, [false; W]);
    for lane in 0..W {
        let pair = |(value, slope): (Lanes<W>, Lanes<W>)| (value.0[lane], slope.0[lane]);
        share.0[lane] = single_root::guess(pair(first), pair(last));
    }
    for _ in 0..single_root::MAX_STEPS {
        let (value, slope, half_curvature) = single_root::expansion(g, share);
        let mut missing = false;
        for lane in 0..W {
            let expansion = (value.0[lane], slope.0[lane], half_curvature.0[lane]);
            let (next, near) = single_root::next(share.0[lane], expansion);
            share.0[lane] = if found[lane] { share.0[lane] } else { next };
            found[lane] |= near;
            missing |= wanted[lane] & !found[lane];
        }
        if !missing {
            break;
        }
    }
    for lane in 0..W {
        let inside = (share.0[lane] > 0.0) & (share.0[lane] <= 1.0);
        found[lane] = found[lane] & wanted[lane] & inside;
    }
    (share, found)
}

/// For each lane the second number if `which` is true, else the first.
#[inline(always)]
fn choose<const W: usize>(which: &[bool; W], first: Lanes<W>, second: Lanes<W>) -> Lanes<W> {
    let mut chosen = first;
    for (lane, which) in which.iter().enumerate() {
        chosen.0[lane] = if *which { second.0[lane] } else { first.0[lane] };
    }
    chosen
}
