//! Evaluation of an impact solved in one step: position, time, integrals, dissipation, largest force.

use super::impact::{DRIVE_TERMS, Impact, Place};
use super::path::{InStop, Path};
use crate::dynamics::result::Phase;
use crate::dynamics::series::ROOM;
use crate::numeric::{GROUP, GaussLegendre, Lanes, MAX_GROUPS, Number, Scalar, Values, bisect};

/// Numbers at the points of a group.
type Group<T> = Lanes<GROUP, T>;

/// Halvings to find the largest force; its error is of the order of the square of the last interval.
const HALVINGS: u32 = 30;

/// Maximum number of Newton steps to the parameter of a time; each squares the error.
const MAX_STEPS: usize = 60;

impl<T: Scalar> Impact<T> {
    /// m at `y`, and the time there with its slope, from the slopes interpolated between the points.
    #[inline(always)]
    fn sums<N: Number>(&self, y: N, all: impl Fn(T) -> N + Copy) -> (N, (N, N)) {
        let slopes = [&self.amplitude_slope, &self.time_slope];
        let [m, t] = self.between.get_or_init(|| slopes.map(|slope| self.rule.coefficients(slope)));
        (all(self.first) + self.rule.integral(m, y, all).0, self.rule.integral(t, y, all))
    }

    /// Root of the depth at y = 0: m, which hardly changes.
    fn turn(&self) -> T {
        self.first + self.rule.half(&self.amplitude_slope)
    }

    /// The motion and the time at `y`.
    fn at(&self, y: T) -> (Place<T>, T) {
        let (m, (t, _)) = self.sums(y, |value| value);
        (self.motion(|value| value, T::sqrt, [m, t, y]), t)
    }

    /// The same, as accurate as at the ends, by integrals of the slopes up to `y`: the interpolated slopes
    /// are less accurate than their integrals.
    fn exactly_at(&self, y: T) -> (Place<T>, T) {
        let start = T::of(-1.0);
        let (mut m, mut t): (Values<T>, Values<T>) =
            ([Lanes::zero(); MAX_GROUPS], [Lanes::zero(); MAX_GROUPS]);
        for group in 0..self.rule.groups() {
            let point = self.between((start, y), group).0;
            (m[group], t[group]) = (point.amplitude_slope, point.time_slope);
        }
        let half = (y - start) * T::of(0.5);
        let (m, t) = (self.first + self.rule.total(&m) * half, self.rule.total(&t) * half);
        (self.motion(|value| value, T::sqrt, [m, t, y]), t)
    }

    /// The motion at the quadrature points between two values of y, and the time there.
    fn between(&self, (from, to): (T, T), group: usize) -> (Place<Lanes<GROUP, T>>, Lanes<GROUP, T>) {
        let half = (to - from) * T::of(0.5);
        let y = self.rule.places(group).map(|place: T| from + half * (T::of(1.0) + place));
        let (m, (t, _)) = self.sums(y, Lanes::all);
        (self.motion(Lanes::all, |value| value.map(T::sqrt), [m, t, y]), t)
    }

    /// The base's acceleration.
    fn base(&self, t: T) -> T {
        self.series.a[..DRIVE_TERMS].iter().rev().fold(T::zero(), |sum, c| sum * t + *c)
    }

    /// The parameter at which the value of `of` at y (given with its slope) is `time`, starting from a guess.
    fn parameter_by(&self, of: impl Fn(T) -> (T, T), time: T, guess: T) -> T {
        let (mut low, mut high, mut parameter) = (T::zero(), T::of(2.0), guess);
        for _ in 0..MAX_STEPS {
            let (value, slope) = of(parameter - T::of(1.0));
            let late = value - time;
            *(if late > T::zero() { &mut high } else { &mut low }) = parameter;
            let newton = parameter - late / slope;
            let inside = newton > low && newton < high;
            let next = if inside { newton } else { (low + high) * T::of(0.5) };
            let change = (next - parameter).abs();
            parameter = next;
            if change <= T::of(2.0 * T::EPSILON) {
                break;
            }
        }
        parameter
    }

    /// The integral over time, between two parameters, of a function of time, root of the depth and inward
    /// speed.
    fn integral(&self, (from, to): (T, T), of: impl Fn(Group<T>, Group<T>, Group<T>) -> Group<T>) -> T {
        let (one, whole) = (T::of(1.0), from == T::zero() && to == T::of(2.0));
        let half = if whole { one } else { (to - from) * T::of(0.5) };
        let mut values: Values<T> = [Lanes::zero(); MAX_GROUPS];
        for (group, value) in values[..self.rule.groups()].iter_mut().enumerate() {
            let (t, u, w, slope) = if whole {
                (self.time[group], self.root[group], self.speed[group], self.time_slope[group])
            } else {
                let (point, t) = self.between((from - one, to - one), group);
                (t, point.root, point.speed, point.time_slope)
            };
            *value = of(t, u, w) * slope;
        }
        self.rule.total(&values) * half
    }
}

/// The parameter is y + 1, from 0 to 2.
impl<T: Scalar> Path<T> for Impact<T> {
    const IN_CONTACT: bool = true;

    fn phase(&self) -> Phase {
        if self.sign < T::zero() { Phase::LeftStop } else { Phase::RightStop }
    }
    fn known(&self) -> usize {
        3
    }
    fn start(&self) -> T {
        self.surface
    }
    /// The parabola through touch, turn and separation. It turns where the motion does; nothing else of it is
    /// used, since an impact that reaches the barrier is not taken as one step.
    fn scaled(&self, _: T) -> [T; ROOM] {
        let turn = self.turn();
        let height = self.sign * (turn * turn) * T::of(4.0);
        let mut scaled = [T::zero(); ROOM];
        (scaled[0], scaled[1], scaled[2]) = (self.surface, height, -height);
        scaled
    }
    fn position(&self, parameter: T) -> T {
        let y = parameter - T::of(1.0);
        // the position at the turn is needed for nearly every impact
        let root = if y == T::zero() { self.turn() } else { self.exactly_at(y).0.root };
        self.surface + self.sign * (root * root)
    }
    fn velocity(&self, parameter: T) -> T {
        self.sign * self.exactly_at(parameter - T::of(1.0)).0.speed
    }
    fn time(&self, parameter: T) -> T {
        self.exactly_at(parameter - T::of(1.0)).1
    }
    fn parameter(&self, time: T, length: T) -> T {
        if !(time > T::zero()) {
            return T::zero();
        }
        if time >= self.rule.total(&self.time_slope) {
            return length;
        }
        let between = self.parameter_by(|y| self.sums(y, |value| value).1, time, length * T::of(0.5));
        let exactly = |y: T| {
            let (point, time) = self.exactly_at(y);
            (time, point.time_slope)
        };
        self.parameter_by(exactly, time, between)
    }
    fn integrals<const WORK: bool>(&self, _: &GaussLegendre<T>, from: T, to: T) -> (T, T) {
        let squared = self.integral((from, to), |_, _, w| w * w);
        let sign = Lanes::all(self.sign);
        let power = |t: Group<T>, _: Group<T>, w: Group<T>| t.map(|t| self.base(t)) * (sign * w);
        (squared, if WORK { self.integral((from, to), power) } else { T::zero() })
    }
    fn moment(&self, _: &GaussLegendre<T>, from: T, to: T) -> T {
        let (surface, sign) = (Lanes::all(self.surface), Lanes::all(self.sign));
        self.integral((from, to), |_, u, _| surface + sign * (u * u))
    }
}

impl<T: Scalar> InStop<T> for Impact<T> {
    fn loss(&self, _: &GaussLegendre<T>, from: T, to: T) -> T {
        self.stop.stiffness * self.stop.loss * self.integral((from, to), |_, u, w| u * u * u * (w * w))
    }

    /// The force is largest while the depth increases, when the loss adds to it.
    fn peak(&self, _: T, _: T, known: T) -> T {
        if !(self.stop.force(self.max_root, self.touch_speed) > known) {
            return known;
        }
        let grows = |y: T| {
            let (point, t) = self.at(y);
            let (u, w) = (point.root, point.speed);
            let net = self.stop.force(u, w) - self.pressing - self.changed(|value| value, [t, u * u, w]);
            T::of(1.5) * w * (T::of(1.0) + self.stop.loss * w) > self.stop.loss * (u * u) * net
        };
        let (_, place) = bisect(T::of(-1.0), T::zero(), HALVINGS, grows);
        let point = self.at(place).0;
        known.larger(self.stop.force(point.root, point.speed))
    }
}
