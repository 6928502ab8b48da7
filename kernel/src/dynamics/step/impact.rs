//! An impact on a compliant stop in one step, from touch to separation.
//!
//! Depth d in the stop and inward speed w obey d' = w and w' = A - k d^1.5 (1 + a w), where A is the
//! acceleration by everything but the stop, A0 at touch. With G(w) = w/a - ln(1 + a w)/a^2, which is w^2/2
//! without loss,
//!
//! ```text
//! J = G(w) + (2/5) k d^2.5 - A0 d
//! ```
//!
//! would be constant if A were A0 (1 + a w) (Hunt and Crossley 1975, for A0 = 0). So it changes little,
//! however slow the impact:
//!
//! ```text
//! dJ/dt = w B,    B = (A - A0 - a w A0)/(1 + a w).
//! ```
//!
//! Let m be the root of the depth at which the mass would turn with this J, J = (2/5) k m^5 - A0 m^2, and let
//! y, from -1 at touch to 1 at separation, be such that the root of the depth is m c, c = 1 - y^2. Then w is
//! a function of m and y,
//!
//! ```text
//! G(w) = q^2/2,    q = -y m r,    r^2 = (4/5) k m^3 (1 + c + c^2 + c^3 + c^4) - 2 A0 (1 + c),
//! ```
//!
//! and with D = k m^3 - A0
//!
//! ```text
//! dt/dy = -y 4 m^2 c/(w (1 - c^2 B/D)),    dm/dy = w B/(2 m D) dt/dy,
//! ```
//!
//! both analytic from end to end. m is nearly constant and is found by iteration: each sweep integrates the
//! slopes from the last m and t, by collocation at Gauss-Legendre points, and reduces the error to some
//! hundredths or less. The slopes of t are corrected for the new m to first order, since t depends on m as q
//! does, whereas m depends on t only through the change of the drive. (Picard iteration at these points:
//! Clenshaw and Norton 1963, "The solution of nonlinear ordinary differential equations in Chebyshev
//! series".) The singularities of an elastic impact, where c^5 = 1, lie on an ellipse with foci -1 and 1 and
//! a sum of half axes of 2, at any speed.

use std::cell::OnceCell;

use crate::dynamics::equation::Compliant;
use crate::dynamics::series::Series;
use crate::numeric::{
    Collocation, GROUP, Lanes, MAX_GROUPS, Number, Scalar, Values, fast_exp2, fast_log2, widest,
};

/// w/q as a series in p = a q: G(w) = q^2/2 is p^2/2 = z - ln(1 + z) for z = a w.
const STRETCH: [f64; 40] = stretch();
/// Radius of convergence, |p| = 2 sqrt(pi), where 1 + z is 1 again after one turn around 0.
const STRETCH_RADIUS: f64 = 3.544;

/// The coefficients, from z z' = p (1 + z).
const fn stretch() -> [f64; 40] {
    let mut c = [0.0; 40];
    c[0] = 1.0;
    let mut n = 1;
    while n < c.len() {
        let (mut sum, mut k) = (c[n - 1], 1);
        while k < n {
            sum -= c[k] * (n + 1 - k) as f64 * c[n - k];
            k += 1;
        }
        c[n] = sum / (n + 2) as f64;
        n += 1;
    }
    c
}

/// Maximum number of sweeps before the step is given up.
const MAX_SWEEPS: usize = 12;

/// Largest ratio of the pressing force to the elastic force at the turn, times 5/2; beyond it the mass does
/// not make an impact but oscillates on its stop.
const MAX_PRESSED: f64 = 0.8;

/// Terms used of the base's acceleration over time.
pub(crate) const DRIVE_TERMS: usize = 6;
/// Terms used of the mechanism's force over depth.
pub(crate) const FORCE_TERMS: usize = 5;

/// Largest ratio of the speeds after and before the impact for which the series of the speed is valid.
const MAX_GAIN: f64 = 1.1;

/// An impact from touch to separation in y, and the workspace.
#[derive(Debug, Clone)]
pub(crate) struct Impact<T: Copy> {
    /// The base's acceleration over time.
    pub series: Series<T>,
    /// The mechanism's force about the surface.
    pub about: Vec<T>,
    /// The mode of that force.
    pub about_mode: Option<usize>,
    pub stop: Compliant<T>,
    pub sign: T,
    /// Displacement of the untouched stop from the piece's origin.
    pub surface: T,
    pub damping: T,
    pub rule: &'static Collocation,
    /// Inward acceleration by everything but the stop at touch, A0.
    pub pressing: T,
    pub touch_speed: T,
    /// m at touch.
    pub first: T,
    /// Upper bound of m.
    pub max_root: T,
    /// Terms of [`STRETCH`].
    terms: usize,
    amplitude: Values<T>,
    /// At the points: root of the depth, inward speed, time (at the beginning of the last sweep), and the
    /// slopes of m and t over y.
    pub root: Values<T>,
    pub speed: Values<T>,
    pub time: Values<T>,
    pub amplitude_slope: Values<T>,
    pub time_slope: Values<T>,
    /// Change of the slopes by the last sweep, over m and the duration of the impact.
    change: Values<T>,
    /// Coefficients of the slopes of m and t in Legendre polynomials, once they are needed.
    pub between: OnceCell<[Values<T>; 2]>,
}

/// The motion at a point: root of the depth, inward speed, and the slopes of t and m over y.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place<N> {
    pub root: N,
    pub speed: N,
    pub time_slope: N,
    pub amplitude_slope: N,
    /// Derivative of ln w with respect to ln m at constant y and t.
    gain: N,
}

/// End of an impact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Separation<T> {
    pub time: T,
    /// Inward speed, below 0.
    pub speed: T,
}

impl<T: Scalar> Impact<T> {
    pub fn new(stop: Compliant<T>) -> Self {
        let zeros = [Lanes::zero(); MAX_GROUPS];
        Self {
            series: Series::new(0),
            about: Vec::new(),
            about_mode: None,
            stop,
            sign: T::of(1.0),
            surface: T::zero(),
            damping: T::zero(),
            rule: Collocation::of(1),
            pressing: T::zero(),
            touch_speed: T::zero(),
            first: T::zero(),
            max_root: T::zero(),
            terms: 1,
            amplitude: zeros,
            root: zeros,
            speed: zeros,
            time: zeros,
            amplitude_slope: zeros,
            time_slope: zeros,
            change: zeros,
            between: OnceCell::new(),
        }
    }

    /// Solves for the impact that begins at `speed`, to `tolerance` relative to the speed, and to `between`
    /// inside the step. Returns `None` if it is no whole impact, or is not resolved.
    pub fn solve(&mut self, speed: T, (tolerance, between): (T, T)) -> Option<Separation<T>> {
        let stiffness = self.stop.stiffness;
        self.pressing = -(self.sign * (self.about[0] + self.series.a[0]));
        self.touch_speed = speed;
        self.between.take();
        let q = self.begin(speed, tolerance)?;
        self.first = self.turn_of(q * q * T::of(0.5))?;
        let cube = self.first * self.first * self.first;
        if !(self.pressing < stiffness * cube * T::of(0.4 * MAX_PRESSED)) {
            return None;
        }
        let (amplitude, time) = match T::WIDE {
            true => widest(
                #[inline(always)]
                || self.iterate(tolerance),
            )?,
            false => self.iterate(tolerance)?,
        };
        let share = |slopes: &Values<T>, of: T| self.rule.unresolved(slopes) / of;
        let unresolved = share(&self.time_slope, time).larger(share(&self.amplitude_slope, amplitude));
        if !(unresolved <= between && unresolved * unresolved <= tolerance) {
            return None;
        }
        let end = self.motion(|value| value, T::sqrt, [amplitude, time, T::of(1.0)]).speed;
        let groups = self.amplitude[..self.rule.groups()].iter();
        // also between the points
        self.max_root = groups.flat_map(|group| group.0).fold(self.first, T::larger) * T::of(1.001);
        (end < T::zero() && -end <= speed * T::of(MAX_GAIN)).then_some(Separation { time, speed: end })
    }

    /// |q| at touch. Also sets the number of terms of the series needed for speeds up to there.
    fn begin(&mut self, speed: T, tolerance: T) -> Option<T> {
        // p^2 = 2 (z - ln(1 + z)) is near z^2/(1 + 2z/3), and below z^2/(1 + z/2).
        let z_at_touch = self.stop.loss * speed;
        let near = |share: f64| z_at_touch / (T::of(1.0) + z_at_touch * T::of(share)).sqrt();
        let size = near(0.5).to_f64().max(1e-9) * MAX_GAIN;
        let needed = fast_log2(tolerance.to_f64() * 1e-3) / (fast_log2(size) - fast_log2(STRETCH_RADIUS));
        self.terms = needed as usize + 2;
        if !(needed >= 0.0 && self.terms <= STRETCH.len()) {
            return None;
        }
        if !(self.stop.loss > T::zero()) {
            return Some(speed);
        }
        let mut p = near(2.0 / 3.0);
        for _ in 0..6 {
            // z' = p (1 + z)/z
            let z = p * self.stretch(p);
            let change = (z_at_touch - z) * z / (p * (T::of(1.0) + z));
            p += change;
            if change.abs() <= p * T::of(T::ROUGH) {
                break;
            }
        }
        Some(p / self.stop.loss)
    }

    /// m for this J.
    fn turn_of(&self, stored: T) -> Option<T> {
        let fifth = self.stop.stiffness * T::of(0.4);
        let power = |x: T, exponent: f64| T::of(fast_exp2(fast_log2(x.to_f64()) * exponent));
        let mut m = power(stored / fifth, 0.2);
        if self.pressing > T::zero() {
            m += power(self.pressing / fifth, 1.0 / 3.0) * T::of(0.5);
        }
        let newton = |m: T| {
            let cube = fifth * m * m * m;
            let value = (cube - self.pressing) * (m * m) - stored;
            value / (m * (T::of(5.0) * cube - T::of(2.0) * self.pressing))
        };
        for _ in 0..20 {
            let change = newton(m);
            m -= change;
            if change.abs() <= m * T::of(T::ROUGH) {
                return Some(m - newton(m));
            }
        }
        None
    }

    /// Sweeps until m and t at the end converge. Returns both.
    #[inline(always)]
    fn iterate(&mut self, tolerance: T) -> Option<(T, T)> {
        let groups = self.rule.groups();
        // Estimates of the duration, and of the share of it that has passed at the points.
        let (mut m, mut t) = (self.first, self.first * self.first / self.touch_speed * T::of(3.0));
        self.amplitude[..groups].fill(Lanes::all(m));
        self.amplitude_slope[..groups].fill(Lanes::zero());
        self.time_slope[..groups].fill(Lanes::zero());
        for group in 0..groups {
            let y = self.rule.places(group);
            let passed = (Lanes::of(2.0) + y * (Lanes::of(3.0) - y * y)) * Lanes::of(0.25);
            self.time[group] = Lanes::all(t) * passed;
        }
        let (mut last, mut rate) = (T::of(1.0), T::zero());
        for sweep in 0..MAX_SWEEPS {
            self.sweep((m, t));
            m = self.first + self.rule.total(&self.amplitude_slope);
            t = self.rule.total(&self.time_slope);
            let change = self.rule.total(&self.change);
            if sweep > 0 {
                rate = rate.larger(change / last);
                // the first change is relative to slopes of 0 and does not measure the rate
                if sweep > 1 && change * rate <= tolerance {
                    return Some((m, t));
                }
                if !(rate < T::of(0.5)) {
                    return None;
                }
            }
            last = change;
            self.rule.integrals(T::zero(), &self.time_slope, &mut self.time);
        }
        None
    }

    /// Computes m at all points from the slopes by the last m and t; corrects the motion to first order in m.
    #[inline(always)]
    fn sweep(&mut self, (m, t): (T, T)) {
        let all = Lanes::<GROUP, T>::all;
        let (inverse_time, inverse_amplitude) = (all(T::of(1.0) / t), all(T::of(3.0) / m));
        let none: Values<T> = [Lanes::zero(); MAX_GROUPS];
        let (mut passing, mut gains) = (none, none);
        for group in 0..self.rule.groups() {
            let (m, t, y) = (self.amplitude[group], self.time[group], self.rule.places(group));
            let place = self.motion(Lanes::all, |value| value.map(T::sqrt), [m, t, y]);
            self.change[group] =
                (place.amplitude_slope - self.amplitude_slope[group]).abs() * inverse_amplitude;
            self.amplitude_slope[group] = place.amplitude_slope;
            (self.root[group], self.speed[group]) = (place.root, place.speed);
            (passing[group], gains[group]) = (place.time_slope, place.gain);
        }
        let last = self.amplitude;
        self.rule.integrals(self.first, &self.amplitude_slope, &mut self.amplitude);
        let (one, two, inverse) = (Lanes::of(1.0), Lanes::of(2.0), all(T::of(1.0) / self.first));
        for group in 0..self.rule.groups() {
            let grown = (self.amplitude[group] - last[group]) * inverse;
            let gain = gains[group];
            self.root[group] = self.root[group] * (one + grown);
            self.speed[group] = self.speed[group] * (one + gain * grown);
            let slope = passing[group] * (one + (two - gain) * grown);
            self.change[group] += (slope - self.time_slope[group]).abs() * inverse_time;
            self.time_slope[group] = slope;
        }
    }

    /// The motion at m, t and y.
    #[inline(always)]
    pub fn motion<N: Number>(
        &self,
        all: impl Fn(T) -> N,
        sqrt: impl Fn(N) -> N,
        [m, t, y]: [N; 3],
    ) -> Place<N> {
        let (one, two) = (N::of(1.0), N::of(2.0));
        let (stiffness, loss) = (all(self.stop.stiffness), all(self.stop.loss));
        let pressing = all(self.pressing);
        let c = one - y * y;
        let elastic = stiffness * (m * m * m);
        let square = c * c;
        let shape = N::of(0.8) * elastic * ((one + c) * (one + square) + square * square);
        let r_square = shape - two * pressing * (one + c);
        let r = sqrt(r_square);
        let q = -(y * m * r);
        let stretch = self.stretch(loss * q);
        let (w, u) = (q * stretch, m * c);
        let changed = self.changed(all, [t, u * u, w]);
        let z = one + loss * w;
        // (1 + a w) B, and (1 + a w) D (1 - c^2 B/D)
        let b = changed - loss * w * pressing;
        let net = (elastic - pressing) * z;
        let rest = net - square * b;
        let (r_stretch, m_rest) = (r * stretch, m * rest);
        let inverse = one / (r_stretch * r_stretch * m_rest);
        let slope = two * u * r_stretch * inverse;
        // d ln q/d ln m is 1 + 3/2 of the elastic share of r^2, d ln w/d ln q is (1 + a w)/stretch^2
        let gain = z * (r_square + N::of(1.5) * shape) * m_rest * inverse;
        Place { root: u, speed: w, time_slope: two * slope * m * net, amplitude_slope: slope * w * b, gain }
    }

    /// Change since touch of the inward acceleration by all but the stop, at a time, a depth and a speed.
    #[inline(always)]
    pub fn changed<N: Number>(&self, all: impl Fn(T) -> N, [t, d, w]: [N; 3]) -> N {
        let outward =
            |k: usize| all(if k.is_multiple_of(2) { self.sign * self.about[k] } else { self.about[k] });
        let [f1, f2, f3, f4] = [1, 2, 3, 4].map(outward);
        let [a1, a2, a3, a4, a5] = [1, 2, 3, 4, 5].map(|k| all(self.sign * self.series.a[k]));
        let force = d * (f1 + d * (f2 + d * (f3 + d * f4)));
        let base = t * (a1 + t * (a2 + t * (a3 + t * (a4 + t * a5))));
        -(force + base + all(self.damping) * w)
    }

    /// w/q at p = a q.
    #[inline(always)]
    fn stretch<N: Number>(&self, p: N) -> N {
        STRETCH[..self.terms].iter().rev().fold(N::zero(), |sum, c| sum * p + N::of(*c))
    }
}
