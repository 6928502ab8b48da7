//! The motion of a mass on an odd cubic, with a sine or with no drive at all, and with nothing to touch,
//! written out by hand: what the general path of `dynamics` must come down to where a scene names nothing
//! else.
//!
//! The arithmetic is that of the general path, operation for operation, so the end of the run is the same bit
//! for bit: series, step rule, the check of each step and the clock are the method. What is left out is what
//! the scene does not name: stops and their search, breaks, segments of a drive, statistics, events, samples,
//! budgets, the cancel flag, the order of the force, and, where it has no drive, the sine. Crossings, which
//! every run with a well counts, can be counted here too.

use std::f64::consts::TAU;

use interwell::dynamics::Model;
use interwell::numeric::{PolynomialRoots, Scalar};

const ROOM: usize = 34;

/// A run to write out by hand.
#[derive(Debug, Clone, Copy)]
pub struct Problem {
    unit: f64,
    linear: f64,
    cubic: f64,
    damping: f64,
    /// Amplitude and turns per time unit.
    sine: Option<(f64, f64)>,
    x: f64,
    v: f64,
    cycles: i64,
    period: f64,
    order: usize,
    tolerance: f64,
    speed: f64,
    longest: f64,
}

/// How it ended. SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct End {
    pub x: f64,
    pub v: f64,
    pub steps: u64,
    /// Passages of x = 0, where they are counted.
    pub crossings: u64,
}

impl Problem {
    /// The run of a model of an odd cubic; `sine` is amplitude in g and frequency in Hz, `start` displacement
    /// in m and velocity in m/s. The duration must be a whole number of periods (without a sine, of 2^-16
    /// time units).
    pub fn new(model: &Model, sine: Option<(f64, f64)>, start: (f64, f64)) -> Self {
        let unit = model.scales().time.log2().round().exp2();
        let [0.0, linear, 0.0, cubic] = model.mechanism().curve.pieces()[0].coefficients[..] else {
            panic!("not an odd cubic");
        };
        let square = (unit * unit) / model.mass();
        let frequency = sine.map_or(1.0 / (unit * (1.0 / 65536.0)), |s| s.1);
        let cycles = model.duration() * frequency;
        assert_eq!(cycles.fract(), 0.0, "not a whole number of periods");
        let local = model.tolerance() * 0.02;
        let order = (3.0 - 1.25 * local.log10()).round().clamp(8.0, 32.0) as usize;
        Self {
            unit,
            linear: linear * square,
            cubic: cubic * square,
            damping: (model.damping() * unit) / model.mass(),
            sine: sine.map(|(g, f)| (g * interwell::dynamics::STANDARD_GRAVITY * (unit * unit), f * unit)),
            x: start.0,
            v: start.1 * unit,
            cycles: cycles as i64,
            period: 1.0 / (frequency * unit),
            order,
            tolerance: local,
            speed: model.scales().speed * unit,
            longest: if order < 20 { 3.0 } else { 8.0 } * model.scales().time / unit,
        }
    }

    /// Runs it, the motion alone.
    pub fn run(&self) -> End {
        match self.sine {
            Some((amplitude, frequency)) => self.fly::<true, false>(amplitude, frequency),
            None => self.fly::<false, false>(0.0, 0.0),
        }
    }

    /// Runs it and counts the passages of x = 0.
    pub fn run_counting(&self) -> End {
        match self.sine {
            Some((amplitude, frequency)) => self.fly::<true, true>(amplitude, frequency),
            None => self.fly::<false, true>(0.0, 0.0),
        }
    }

    fn fly<const DRIVEN: bool, const COUNT: bool>(&self, amplitude: f64, frequency: f64) -> End {
        let &Self { linear, cubic, damping, period, .. } = self;
        let order = self.order.min(ROOM - 2);
        let omega = TAU * frequency;
        let curvature = -(omega * omega);
        let mut inverse = [0.0; ROOM];
        for (k, slot) in inverse.iter_mut().enumerate().skip(2) {
            *slot = 1.0 / (k * (k - 1)) as f64;
        }
        let (mut y, mut a) = ([0.0; ROOM], [0.0; ROOM]);
        let mut row = [0.0; ROOM]; // the force over y - x, about x, without what is constant
        let (speed_log2, tolerance_log2) = (fast_log2(self.speed), self.tolerance.log2());
        let (mut cycle, mut phase) = (0, 0.0);
        let mut turned = (0.0, 1.0); // sine and cosine of the drive where a step starts
        let (mut x, mut v) = (self.x, self.v);
        let mut steps = 0;
        let mut crossings = 0;
        loop {
            let left = (self.cycles - cycle) as f64 * period + (0.0 - phase);
            if !(left > 0.0) {
                break;
            }
            if DRIVEN {
                let (s, c) = turned;
                a[0] = amplitude * s;
                a[1] = amplitude * (c * omega);
                a[2] = curvature * a[0] * 0.5;
                a[3] = curvature * a[1] / 6.0;
            }
            y[0] = x;
            y[1] = v;
            // the force about x: linear y + cubic y^3, shifted by Horner's rule
            let once = x * cubic;
            let slope = linear + x * once;
            let twice = once + x * cubic;
            let (force, stiffness, bending) = (x * slope, slope + x * twice, twice + x * cubic);
            each_order::<0>(
                order - 1,
                #[inline(always)]
                |k| {
                    if DRIVEN && k >= 4 {
                        a[k] = curvature * a[k - 2] * inverse[k];
                    }
                    let drag = damping * (k + 1) as f64 * y[k + 1];
                    let sum = if k == 0 {
                        if DRIVEN { force + a[k] } else { force }
                    } else {
                        let spring = stiffness * y[k];
                        match k {
                            1 => {}
                            2 => row[1] = bending * y[1],
                            _ => row[k - 1] = bending * y[k - 1] + cubic * inner_square(&y, k - 1),
                        }
                        let rest = inner_convolve(&y, &row, k);
                        (if DRIVEN { rest + a[k] } else { rest }) + spring
                    };
                    y[k + 2] = -(sum + drag) * inverse[k + 2];
                },
            );

            let mut radius = f64::INFINITY;
            for (j, c) in (order - 3..).zip(&y[order - 3..=order]) {
                let size = c.abs() * j as f64;
                if size > 1e-300 {
                    radius = radius.min((speed_log2 - fast_log2(size)) * (1.0 / (j - 1) as f64));
                }
            }
            let log2 = radius + tolerance_log2 / order as f64;
            let mut h = if log2 < 1000.0 { fast_exp2(log2).min(self.longest) } else { self.longest };

            let mut bound;
            let (h, position, velocity, next) = loop {
                let last = left <= h;
                if last {
                    h = left;
                }
                let (mut position, mut velocity, mut acceleration) = (0.0, v, 0.0);
                bound = 0.0;
                let (mut before, mut power) = (1.0, h);
                each_order::<2>(
                    order + 1,
                    #[inline(always)]
                    |k| {
                        acceleration += (k * (k - 1)) as f64 * y[k] * before;
                        velocity += k as f64 * y[k] * power;
                        (before, power) = (power, power * h);
                        let term = y[k] * power;
                        position += term;
                        if COUNT {
                            bound += term.abs();
                        }
                    },
                );
                let term = v * h;
                let position = x + (term + position);
                bound += term.abs(); // the mass is never further from where the step starts
                let (mut next_cycle, mut next_phase) = (cycle, phase + h);
                if next_phase >= period {
                    let whole = (next_phase / period).floor();
                    next_phase -= whole * period;
                    next_cycle += whole as i64;
                    if next_phase >= period {
                        next_phase -= period;
                        next_cycle += 1;
                    }
                    if next_phase < 0.0 {
                        next_phase = 0.0;
                    }
                }
                if DRIVEN {
                    turned = f64::sin_cos_turns(next_phase * frequency);
                }
                let base = if DRIVEN { amplitude * turned.0 } else { 0.0 };
                let sum = (acceleration + damping * velocity) + base;
                let force = ((cubic * position) * position + linear) * position;
                let residual = (force + sum).abs() * h;
                let next = if last { (self.cycles, 0.0) } else { (next_cycle, next_phase) };
                if residual <= (20.0 * order as f64 * self.tolerance) * self.speed {
                    break (h, position, velocity, next);
                }
                let size = position.abs();
                let rounding = ((cubic.abs() * size) * size + linear.abs()) * size * (2.0 * f64::EPSILON);
                let others = acceleration.abs() + (damping * velocity).abs() + base.abs();
                if residual <= (rounding + others * f64::EPSILON) * h * 32.0 {
                    break (h, position, velocity, next);
                }
                h *= 0.5;
            };
            steps += 1;
            if COUNT {
                let passed = (y[0] > 0.0) != (position > 0.0);
                if passed || y[0].abs() <= bound {
                    crossings += match bend(&y[..=order], h) < y[1].abs() {
                        true => u64::from(passed), // the velocity keeps its sign
                        false => passages(&y[..=order], h, position),
                    };
                }
            }
            (x, v) = (position, velocity);
            (cycle, phase) = next;
        }
        End { x, v: v / self.unit, steps, crossings }
    }
}

/// Does something for each order from the first on, by its number, which spares the bookkeeping of a loop.
#[inline(always)]
fn each_order<const FIRST: usize>(end: usize, mut next: impl FnMut(usize)) {
    macro_rules! each {
        ($($k:literal)*) => {
            $(
                if $k >= FIRST {
                    if end <= $k {
                        return;
                    }
                    next($k);
                }
            )*
        };
    }
    each!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19);
    for k in 20..end {
        next(k);
    }
}

/// A bound of what the velocity changes by within a step of length `h`.
fn bend(y: &[f64], h: f64) -> f64 {
    let (mut sum, mut power) = (0.0, 1.0);
    for (k, c) in y.iter().enumerate().skip(2) {
        power *= h;
        sum += c.abs() * power * f64::from((k * (k - 1)) as u32);
    }
    sum
}

/// Passages of 0 within a step of length `h` that ends at `end`.
fn passages(y: &[f64], h: f64, end: f64) -> u64 {
    let mut scaled = [0.0; ROOM];
    let mut power = 1.0;
    let sign = if y[0] < 0.0 { -1.0 } else { 1.0 };
    for (slot, c) in scaled.iter_mut().zip(y) {
        *slot = sign * (c * power);
        power *= h;
    }
    let passed = (y[0] > 0.0) != (end > 0.0);
    let count = PolynomialRoots::new(&scaled[..y.len()]).count_sign_changes() as u64;
    // The ends decide the parity: rounding may put a root just beyond one.
    if (count % 2 == 1) == passed { count } else { count.checked_sub(1).unwrap_or(1) }
}

/// Sum of a[i] b[k-i] over i = 1..k, from the middle outwards.
#[inline(always)]
fn inner_convolve(a: &[f64; ROOM], b: &[f64; ROOM], k: usize) -> f64 {
    if k < 2 {
        return 0.0;
    }
    let half = k.div_ceil(2);
    let middle = a[k - half] * b[half];
    if k == 2 {
        return middle;
    }
    let (mut low, mut high) = match k.is_multiple_of(2) {
        true => (middle + a[half - 1] * b[half + 1], a[half + 1] * b[half - 1]),
        false => (middle, a[half] * b[k - half]),
    };
    for i in (1..half - 1).rev() {
        low += a[i] * b[k - i];
        high += a[k - i] * b[i];
    }
    low + high
}

/// Sum of a[i] a[k-i] over i = 1..k, from the middle outwards.
#[inline(always)]
fn inner_square(a: &[f64; ROOM], k: usize) -> f64 {
    match k {
        0 | 1 => return 0.0,
        2 => return a[1] * a[1],
        _ => {}
    }
    let last = (k - 1) / 2;
    let mut sum = a[last] * a[k - last];
    for i in (1..last).rev() {
        sum += a[i] * a[k - i];
    }
    let twice = sum + sum;
    if k.is_multiple_of(2) { twice + a[k / 2] * a[k / 2] } else { twice }
}

#[inline]
fn fast_log2(x: f64) -> f64 {
    let bits = x.to_bits();
    let exponent = f64::from_bits(bits >> 52 | 0x4330_0000_0000_0000) - (4_503_599_627_370_496.0 + 1023.0);
    let m = f64::from_bits((bits & 0x000f_ffff_ffff_ffff) | 0x3ff0_0000_0000_0000) - 1.0;
    exponent + m * (1.3465 - 0.3465 * m)
}

#[inline]
fn fast_exp2(x: f64) -> f64 {
    let shifted = x + 6_755_399_441_055_744.0;
    let f = x - (shifted - 6_755_399_441_055_744.0);
    let mantissa = 1.0 + f * (0.7035 + 0.2402 * f);
    f64::from_bits((shifted.to_bits() << 52).wrapping_add(1023 << 52)) * mantissa
}
