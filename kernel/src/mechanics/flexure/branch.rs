//! Equilibrium branch: the stable states of the mechanism as x grows from 0.
//!
//! The branch is a chain of segments in x. Within a segment the same flexures have a bump and everything
//! is analytic in x. It ends where a bump vanishes (or, in a soft mechanism, appears): a pitchfork
//! bifurcation, at which the slope of the force jumps. The pitchfork is a regular solution of the
//! equations in the square of the bump's amplitude, so it is solved like any other state, to rounding.
//! Every state on the way is tested for stability, so that the S-shaped branch that continues the taut
//! branch inwards is never followed.

use super::beam::Shape;
use super::equilibrium::{Prescribed, stays_straight};
use super::point::Point;
use super::solver::{Failure, Solver};

const MAX_HALVINGS: u32 = 40;

/// Largest number of intermediate states if an interpolated guess does not lead to the wanted state.
const MAX_APPROACH_STEPS: u32 = 200;

const GUESS_POINTS: usize = 6;

/// End of the curve relative to the position of the last kink.
const BEYOND_KINK: f64 = 1.15;

/// Smallest end of the curve relative to the shortest flexure.
const MIN_END: f64 = 0.1;

/// Smallest end of the curve relative to the position of the well. The wells of thick flexures, whose taut
/// branch rises slowly, may lie far beyond the kink.
const BEYOND_WELL: f64 = 1.1;

/// Relative distance below which two kinks are one: equal groups lose their bumps together.
const SAME_KINK: f64 = 1e-11;

/// Largest number of segments. Two groups of flexures have fewer; a longer chain repeats itself.
const MAX_SEGMENTS: usize = 8;

/// A range of x over which the same flexures have a bump.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Segment {
    pub from: f64,
    pub to: f64,
    /// Solved states, ascending in x.
    pub points: Vec<Point>,
}

impl Segment {
    pub fn last(&self) -> &Point {
        &self.points[self.points.len() - 1]
    }

    /// A guess for the state at `x` from the nearest ones.
    pub fn guess(&self, x: f64) -> Point {
        let mut nearest: Vec<&Point> = self.points.iter().collect();
        nearest.sort_by(|a, b| (a.x - x).abs().total_cmp(&(b.x - x).abs()));
        nearest.truncate(GUESS_POINTS);
        Point::between(&nearest, x, self.from == 0.0)
    }

    /// The state at `x`, which is solved and stored if it is not known.
    pub fn at(&mut self, solver: &mut Solver, x: f64) -> Result<Point, Failure> {
        let place = self.points.partition_point(|p| p.x < x);
        if let Some(known) = self.points.get(place).filter(|p| p.x == x) {
            return Ok(known.clone());
        }
        let point = self.solve_at(solver, x)?;
        self.points.insert(place, point.clone());
        Ok(point)
    }

    /// Solves the state at `x`, even if it is known.
    pub fn solve_at(&self, solver: &mut Solver, x: f64) -> Result<Point, Failure> {
        match solver.solve(&self.guess(x), Prescribed::Displacement(x)) {
            Ok(point) => Ok(point),
            Err(failure) => self.approach(solver, x).ok_or(failure),
        }
    }

    /// Solves the state at `x` by continuation from the nearest known state. Near a rounded kink an
    /// interpolated guess leads to a wrong state or none.
    fn approach(&self, solver: &mut Solver, x: f64) -> Option<Point> {
        let mut from = self.points.iter().min_by(|a, b| (a.x - x).abs().total_cmp(&(b.x - x).abs()))?.clone();
        let mut step = x - from.x;
        for _ in 0..MAX_APPROACH_STEPS {
            let to = if step.abs() >= (x - from.x).abs() { x } else { from.x + step };
            match solver.solve(&from, Prescribed::Displacement(to)) {
                Ok(point) if to == x => return Some(point),
                Ok(point) => (from, step) = (point, 2.0 * step),
                Err(_) => step *= 0.5,
            }
        }
        None
    }
}

/// The chain of segments from 0 to the end of the curve.
pub(super) fn trace(solver: &mut Solver) -> Result<Vec<Segment>, Failure> {
    let bow = solver.bow;
    solver.set_bow([0.0; 2]);
    let start = start(solver)?;
    let min_end = MIN_END * solver.shortest();
    let straight = chain(solver, start, min_end)?;
    if bow == [0.0; 2] {
        return Ok(straight);
    }
    // A bow removes the kink; the end of the curve is taken from the flexures without it.
    solver.set_bow(bow);
    let start = bowed_start(solver, &straight[0].points[0])?;
    chain(solver, start, straight[straight.len() - 1].to)
}

/// The segments from `start` to beyond the last kink, and at least to `min_end`.
fn chain(solver: &mut Solver, mut start: Point, min_end: f64) -> Result<Vec<Segment>, Failure> {
    let mut segments: Vec<Segment> = Vec::new();
    loop {
        let from = start.x;
        let end = (BEYOND_KINK * from).max(min_end);
        let buckled = start.shapes.contains(&Shape::Bump);
        let (mut segment, mut next) = if buckled {
            march(solver, start, 0.35 * (solver.taut_at() - from).abs().max(0.02 * end), None)?
        } else {
            let part = if start.shapes.contains(&Shape::Bowed) { 0.1 } else { 0.25 };
            march(solver, start, part * (end - from), Some(end))?
        };
        while next.is_none() {
            let Some(farther) = beyond_well(solver, &mut segment)? else { break };
            let last = segment.last().clone();
            let step = 0.5 * (farther - last.x);
            let (rest, after) = march(solver, last, step, Some(farther))?;
            segment.points.extend(rest.points.into_iter().skip(1));
            segment.to = rest.to;
            next = after;
        }
        segments.push(segment);
        match next {
            Some(point) if segments.len() < MAX_SEGMENTS => start = point,
            Some(point) => return Err(Failure::Unstable { x: point.x }),
            None => return Ok(segments),
        }
    }
}

/// The new end of a segment that ends too close to its well or before it; `None` if it is long enough.
fn beyond_well(solver: &mut Solver, segment: &mut Segment) -> Result<Option<f64>, Failure> {
    let pulled = segment.points.iter().rposition(|p| p.x > 0.0 && p.force < 0.0);
    let Some(pulled) = pulled else { return Ok(None) };
    let Some(next) = segment.points.get(pulled + 1) else {
        return Ok(Some(BEYOND_KINK * segment.to));
    };
    let (mut low, mut high) = (segment.points[pulled].x, next.x);
    if BEYOND_WELL * high <= segment.to {
        return Ok(None);
    }
    // so close to the end that the position of the well matters
    while high - low > 1e-3 * high {
        let middle = segment.at(solver, 0.5 * (low + high))?;
        if middle.force < 0.0 { low = middle.x } else { high = middle.x }
    }
    Ok(Some(BEYOND_WELL * high).filter(|end| *end > segment.to))
}

/// The stable state at x = 0: straight, or with the bumps that lower the energy.
fn start(solver: &mut Solver) -> Result<Point, Failure> {
    let straight = solver.straight();
    let stays = solver.terms(&straight).each_ref().map(stays_straight);
    if stays == [true, true] {
        return solver.solve(&straight, Prescribed::Displacement(0.0));
    }
    // The group that buckles under the smaller total load takes up the preload; both groups buckle if the
    // load of the other is reached as well.
    let first = if solver.buckling_load(0) < solver.buckling_load(1) { 0 } else { 1 };
    let mut failure = Failure::Unstable { x: 0.0 };
    for bumps in [[first == 0, first == 1], [true, true], [first == 1, first == 0]] {
        match buckled(solver, &straight, bumps) {
            Ok(point) if point.q.iter().all(|q| *q >= 0.0) && solver.is_stable(&point) => return Ok(point),
            Ok(_) => {}
            Err(found) => failure = found,
        }
    }
    Err(failure)
}

/// A state at x = 0 with the groups in `bumps` buckled. If the iteration does not converge at once, the
/// preload is raised from a smaller one.
fn buckled(solver: &mut Solver, straight: &Point, bumps: [bool; 2]) -> Result<Point, Failure> {
    let preload = solver.preload;
    let shapes = bumps.map(|b| if b { Shape::Bump } else { Shape::Straight });
    let loads: Vec<f64> = (0..2).filter(|g| bumps[*g]).map(|g| solver.buckling_load(g)).collect();
    let load = loads.iter().sum::<f64>() / loads.len() as f64;
    let mut reached = None::<(f64, Point)>;
    let mut target = preload;
    let mut failure = Failure::Unstable { x: 0.0 };
    for _ in 0..MAX_HALVINGS {
        let guess = reached.as_ref().map_or_else(
            || {
                let mut point = solver.reshaped(straight, shapes);
                point.compression = load;
                let shortening = (target - load * solver.compliance()).max(0.0) / loads.len() as f64;
                for g in (0..2).filter(|g| bumps[*g]) {
                    point.q[g] = solver.bump_of_shortening(g, shortening);
                }
                point
            },
            |(_, point)| point.clone(),
        );
        solver.preload = target;
        let solved = solver.solve(&guess, Prescribed::Displacement(0.0));
        solver.preload = preload;
        match solved {
            Ok(point) if target == preload => return Ok(point),
            Ok(point) => {
                reached = Some((target, point));
                target = preload;
            }
            Err(found) => {
                failure = found;
                target = 0.5 * (target + reached.as_ref().map_or(0.0, |(p, _)| *p));
            }
        }
    }
    Err(failure)
}

/// The state at x = 0 of bowed flexures, from that of straight ones; the bow is raised from a smaller
/// one if needed.
fn bowed_start(solver: &mut Solver, straight: &Point) -> Result<Point, Failure> {
    let whole = solver.bow;
    let mut guess = solver.straight().padded(straight.even[0].len());
    if straight.shapes.contains(&Shape::Bump) {
        guess.compression = straight.compression;
        for g in 0..2 {
            guess.odd[g] = straight.odd[g].clone();
            guess.q[g] = straight.q[g];
            if guess.shapes[g] == Shape::Bowed {
                let size = straight.q[g].max(0.0).sqrt();
                guess.odd[g].iter_mut().for_each(|a| *a *= size);
                guess.odd[g].resize(straight.even[0].len(), 0.0);
                guess.q[g] = 1.0;
            } else {
                guess.shapes[g] = straight.shapes[g];
            }
        }
    }
    let (mut reached, mut share) = (0.0, 1.0);
    let mut failure = Failure::Unstable { x: 0.0 };
    for _ in 0..MAX_HALVINGS {
        solver.set_bow(whole.map(|b| b * share));
        let solved = solver.solve(&guess, Prescribed::Displacement(0.0));
        solver.set_bow(whole);
        match solved {
            Ok(point) if share == 1.0 => {
                // A bow takes up preload, so the other group may no longer buckle.
                let changed = changed(solver, &point);
                if changed == [false, false] {
                    return Ok(point);
                }
                let mut shapes = point.shapes;
                for g in (0..2).filter(|g| changed[*g]) {
                    shapes[g] = if shapes[g] == Shape::Bump { Shape::Straight } else { Shape::Bump };
                }
                guess = solver.reshaped(&point, shapes);
            }
            Ok(point) => (guess, reached, share) = (point, share, 1.0),
            Err(found) => {
                failure = found;
                share = 0.5 * (share + reached);
            }
        }
    }
    Err(failure)
}

/// Follows the states from `start` to `end`, or until a bump vanishes or appears. Returns the segment, and
/// the first state of the next one, if any.
fn march(
    solver: &mut Solver,
    start: Point,
    mut step: f64,
    end: Option<f64>,
) -> Result<(Segment, Option<Point>), Failure> {
    let from = start.x;
    // an upper bound of the displacement, at which both flexures would lie flat
    let max_x = 4.0 * (solver.taut_at() + solver.shortest());
    let mut segment = Segment { from, to: from, points: vec![start] };
    let mut halvings = 0;
    loop {
        let last = segment.last().x;
        let x = match end {
            Some(end) if last + 1.01 * step >= end => end,
            _ => last + step,
        };
        if x > max_x {
            return Err(Failure::Unstable { x });
        }
        let guess = if halvings % 2 == 0 { segment.guess(x) } else { segment.last().clone() };
        match solver.solve(&guess, Prescribed::Displacement(x)) {
            Err(failure) => {
                halvings += 1;
                step *= 0.5;
                if halvings > MAX_HALVINGS || last + step == last {
                    return Err(failure);
                }
            }
            Ok(point) => {
                let changed = changed(solver, &point);
                if changed != [false, false] {
                    return pitchfork(solver, segment, &point, changed);
                }
                if !solver.is_stable(&point) {
                    return Err(Failure::Unstable { x });
                }
                segment.points.push(point);
                segment.to = x;
                if Some(x) == end {
                    return Ok((segment, None));
                }
                step *= 1.5;
            }
        }
    }
}

/// The groups whose shape in `point` is no longer valid: a bump whose square q is negative has vanished, and
/// a straight flexure buckles if a bump lowers its energy.
fn changed(solver: &mut Solver, point: &Point) -> [bool; 2] {
    let terms = solver.terms(point);
    std::array::from_fn(|g| match point.shapes[g] {
        Shape::Straight => !stays_straight(&terms[g]),
        Shape::Bump => point.q[g] < 0.0,
        Shape::Bowed => false,
    })
}

/// Ends a segment at the first pitchfork between its last state and `beyond`.
fn pitchfork(
    solver: &mut Solver,
    mut segment: Segment,
    beyond: &Point,
    changed: [bool; 2],
) -> Result<(Segment, Option<Point>), Failure> {
    let last = segment.last().clone();
    let mut first: Option<(usize, Point)> = None;
    let mut kinks = [None; 2];
    let mut failure = Failure::Unstable { x: beyond.x };
    for g in (0..2).filter(|g| changed[*g]) {
        let vanishes = beyond.shapes[g] == Shape::Bump;
        let mut shapes = beyond.shapes;
        shapes[g] = Shape::Bump;
        let x = if vanishes {
            // q is approximately linear in x^2
            let part = last.q[g] / (last.q[g] - beyond.q[g]);
            (last.x * last.x + part * (beyond.x * beyond.x - last.x * last.x)).sqrt()
        } else {
            0.5 * (last.x + beyond.x)
        };
        let mut extended = segment.clone();
        extended.points.push(beyond.clone());
        let guess = solver.reshaped(&extended.guess(x), shapes);
        match solver.solve(&guess, Prescribed::BumpVanishes(g)) {
            Ok(kink) => {
                kinks[g] = Some(kink.x);
                let within = kink.x >= segment.from && kink.x <= beyond.x;
                if within && first.as_ref().is_none_or(|(_, other)| kink.x < other.x) {
                    first = Some((g, kink));
                }
            }
            Err(found) => failure = found,
        }
    }
    let (g, kink) = first.ok_or(failure)?;
    // the state at the kink on either side; both have the same force and position
    let mut shapes = kink.shapes;
    shapes[g] = Shape::Straight;
    let is_same = |(a, b): (f64, f64)| (a - b).abs() <= SAME_KINK * kink.x;
    if beyond.shapes == [Shape::Bump; 2] && kinks[0].zip(kinks[1]).is_some_and(is_same) {
        shapes = [Shape::Straight; 2];
    }
    let straight = solver.reshaped(&kink, shapes);
    let straight = solver.solve(&straight, Prescribed::Displacement(kink.x))?;
    let (inner, outer) = if beyond.shapes[g] == Shape::Bump { (kink, straight) } else { (straight, kink) };
    segment.to = inner.x;
    segment.points.push(inner);
    Ok((segment, Some(outer)))
}
