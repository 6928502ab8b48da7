//! Search for the release root under a drive of any form.
//!
//! The search advances in strides. Over a stride the contact acceleration is a polynomial, the series of the
//! drive; its first root is the release. Without a root the search continues with the next stride.

use super::{ContactAcceleration, Drive, ReleaseRoot, Span};
use crate::dynamics::clock::{Clock, Instant};
use crate::dynamics::series::{SEEDED, Series};
use crate::numeric::{PolynomialRoots, Scalar, decay};

/// Length of a stride in radians of the fastest tone.
const STRIDE_RADIANS: f64 = 2.0;
/// Order of the series of a stride: the first neglected term, 2^27/27!, is below rounding.
const STRIDE_ORDER: usize = 26;

/// Work after which a search is interrupted: a few milliseconds, more than the common period of two or three
/// tones of usual frequencies takes.
const SEARCH_WORK: u64 = 500_000;

/// Cost of a stride without the parts of the drive, in units of [`work`](crate::dynamics::step::work).
const STRIDE_WORK: u64 = 80;
/// Cost that each part of the drive adds to a stride.
const STRIDE_WORK_OF_A_PART: u64 = 8;

/// Two searches that differ by no more than this share of a quarter cycle have found the same root.
const SAME_ROOT: f64 = 1e-12;

/// A search in one segment of a drive, and its workspace.
pub(super) struct Search<'a, T: Scalar, D: Drive<T>> {
    pub drive: &'a D,
    pub clock: &'a Clock<T>,
    pub acceleration: ContactAcceleration<T>,
    pub segment: usize,
    /// Angular frequency of the fastest part of the drive that moves; 0 without one.
    pub fastest: T,
    pub reach: T,
    /// Cycles of the clock after which the drive repeats from this segment on, if it does.
    pub common_cycles: Option<i64>,
    /// Number of parts of the drive, each weighted by its cost.
    pub parts: usize,
    /// An acceleration that decays and adds to the drive's, if there is one.
    pub decaying: Option<Decaying<T>>,
    /// The series of the drive over a stride.
    pub series: Series<T>,
}

/// An acceleration that acts like the base's, `push` at first, and decays exponentially.
#[derive(Debug, Clone, Copy)]
pub(super) struct Decaying<T> {
    pub push: T,
    pub rate: T,
    pub since: Instant<T>,
}

/// The contact acceleration over a stride, as a polynomial in the fraction of the stride.
struct Stride<T> {
    g: [T; STRIDE_ORDER + 1],
    order: usize,
}

impl<T: Scalar, D: Drive<T>> Search<'_, T, D> {
    /// The first release in the span, and the work that it took to find it.
    pub fn first(&mut self, span: &Span<T>, cursor: &mut D::Cursor) -> (ReleaseRoot<T>, u64) {
        let Span { from, until, since, .. } = *span;
        let clock = self.clock;
        let stride_work = STRIDE_WORK + STRIDE_WORK_OF_A_PART * self.parts as u64;
        let mut work = 0;
        let turning = self.fastest > T::zero();
        let longest = T::of(STRIDE_RADIANS) / self.fastest;
        let mut at = from;
        while work < SEARCH_WORK {
            work += stride_work;
            let left = clock.between(&at, &until);
            if left <= T::zero() {
                return (ReleaseRoot::Never, work);
            }
            let h = if turning { longest.smaller(left) } else { left };
            let Stride { g, order } = self.stride(&at, h, cursor);
            // A parabola below 0 by no more than rounding only touches 0; this is the distance to its bottom.
            let rounding = (self.acceleration.threshold.abs() + self.reach) * T::of(8.0 * T::EPSILON);
            let touches = |slope: T, curvature: T| {
                curvature > T::zero() && slope * slope <= T::of(2.0) * curvature * rounding
            };
            let across = |curvature: T| T::of(4.0) * (rounding / curvature).sqrt();
            let acceleration = PolynomialRoots::new(&g[..=order]);
            let (s, slope, curvature) = if g[0] > T::zero() {
                let Some(s) = acceleration.first() else {
                    at = clock.advance(&at, h);
                    if self.common_cycles.is_some_and(|cycles| at.cycle > since.cycle + cycles) {
                        return (ReleaseRoot::Never, work); // one common period without a root: there is none
                    }
                    continue;
                };
                let (_, slope, curvature) = acceleration.value_and_slopes(s);
                (s, slope, curvature)
            } else {
                (T::zero(), g[1], T::of(2.0) * g[2.min(order)])
            };
            if touches(slope, curvature) {
                at = clock.advance(&at, (s + across(curvature)) * h);
            } else if s == T::zero() && slope > T::zero() {
                // rounding: it rises, the root comes later
                at = clock.advance(&at, T::of(2.0) * rounding / slope * h);
            } else {
                let root = clock.advance(&at, s * h);
                let exact = self.exact_root(&root, cursor);
                let exact = exact.filter(|(at, _)| clock.between(&from, at) > T::zero());
                let (root, turn) = exact.map_or((root, None), |(at, turn)| (at, Some(turn)));
                return (ReleaseRoot::within(clock, root, turn, &until), work);
            }
        }
        (ReleaseRoot::NotBefore(at), work)
    }

    /// The contact acceleration over a stride of length `h` from `at`.
    fn stride(&mut self, at: &Instant<T>, h: T, cursor: &mut D::Cursor) -> Stride<T> {
        let Self { drive, series, acceleration: ContactAcceleration { threshold, sign, .. }, .. } = self;
        drive.seed(at, self.segment, &mut series.a, cursor);
        let order = if self.fastest > T::zero() { STRIDE_ORDER } else { 1 };
        for k in SEEDED..=order {
            series.extend_drive(k, *drive, cursor);
        }
        let mut g = [T::zero(); STRIDE_ORDER + 1];
        let mut power = T::of(1.0);
        for (k, slot) in g[..=order].iter_mut().enumerate() {
            *slot = -(*sign * series.a[k]) * power;
            power = power * h;
        }
        g[0] += *threshold;
        if let Some(decaying) = &self.decaying {
            let mut term =
                *sign * decaying.push * decay(decaying.rate * self.clock.between(&decaying.since, at)).0;
            for (k, slot) in g[..=order].iter_mut().enumerate() {
                *slot -= term;
                term = -(term * (decaying.rate * h) / T::whole(k + 1));
            }
        }
        Stride { g, order }
    }

    /// The release near `root`, computed from the drive alone so that it does not depend on where the search
    /// began, and the clock's cycle within the common period. `None` if the drive does not repeat, or if the
    /// two roots differ by more than rounding.
    fn exact_root(&mut self, root: &Instant<T>, cursor: &mut D::Cursor) -> Option<(Instant<T>, i64)> {
        let cycles = self.common_cycles?;
        if !(self.fastest > T::zero()) {
            return None;
        }
        // Quarters of the cycle: strides that are the same for every search and in every cycle.
        let clock = self.clock;
        let stride = clock.period * T::of(0.25);
        let quarter = (root.phase / stride).floor().smaller(T::of(3.0));
        let start = Instant { cycle: root.cycle, phase: quarter * stride };
        let Stride { g, order } = self.stride(&start, stride, cursor);
        let near = clock.between(&start, root) / stride;
        let mut found = None;
        PolynomialRoots::new(&g[..=order]).each_sign_change(&mut |s| {
            if (s - near).abs() <= T::of(SAME_ROOT) {
                found = Some(s);
            }
            found.is_none()
        });
        let exact = clock.advance(&start, found? * stride);
        Some((exact, exact.cycle.rem_euclid(cycles)))
    }
}
