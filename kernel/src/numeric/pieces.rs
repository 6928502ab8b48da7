//! Piecewise polynomials that replace many straight lines between samples.
//!
//! An acceleration given by samples and interpolated linearly changes its slope at each sample. An integrator
//! that steps from corner to corner takes one step per sample, however smooth the samples are. The moving
//! mass sees the acceleration only through two integrals. The projection of the lines on Legendre polynomials
//! has the same integral and first moment as the lines, so that speed and position (the first and the second
//! integral) agree at both ends of each piece. Between the ends they differ by no more than the given limits.

/// Degree of the polynomials.
pub const DEGREE: usize = 10;

/// Smallest number of lines that a polynomial replaces.
const MIN_LINES: usize = 12;

/// Number of lines of the first polynomial tried.
const FIRST_LINES: usize = 64;

/// Coefficients, constant first, of a polynomial in the position from -1 to 1 between two samples.
pub type Polynomial = [f64; DEGREE + 1];

/// Consecutive lines.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// The sample at which the first line begins.
    pub first: usize,
    /// Number of lines.
    pub lines: usize,
    /// The polynomial that replaces them, if any.
    pub polynomial: Option<Box<Polynomial>>,
}

/// Pieces for the lines between samples at ascending times. The first integral of each polynomial differs
/// from that of the lines by at most `limits.0` and the second integral by at most `limits.1`; at both ends
/// they differ only by rounding.
pub fn pieces(times: &[f64], values: &[f64], limits: (f64, f64)) -> Vec<Piece> {
    let last = times.len() - 1;
    let fit = |first: usize, lines: usize| {
        let samples = first..=first + lines;
        fitted(&times[samples.clone()], &values[samples], limits).map(Box::new)
    };
    let mut all: Vec<Piece> = Vec::new();
    let (mut first, mut guess) = (0, FIRST_LINES);
    while first < last {
        let left = last - first;
        let mut lines = guess.min(left);
        let mut polynomial = fit(first, lines);
        if polynomial.is_some() {
            let mut more = lines.div_ceil(4);
            while lines < left {
                let longer = (lines + more).min(left);
                let Some(found) = fit(first, longer) else { break };
                (lines, polynomial, more) = (longer, Some(found), 2 * more);
            }
        }
        while polynomial.is_none() && lines / 2 >= MIN_LINES {
            lines /= 2;
            polynomial = fit(first, lines);
        }
        guess = lines.max(2 * MIN_LINES);
        match all.last_mut() {
            Some(before) if polynomial.is_none() && before.polynomial.is_none() => before.lines += lines,
            _ => all.push(Piece { first, lines, polynomial }),
        }
        first += lines;
    }
    all
}

/// The polynomial for these lines; `None` if it differs by more than the limits.
fn fitted(times: &[f64], values: &[f64], limits: (f64, f64)) -> Option<Polynomial> {
    let n = times.len() - 1;
    if n < MIN_LINES {
        return None;
    }
    let half = 0.5 * (times[n] - times[0]);
    let place = |i: usize| match i {
        0 => -1.0,
        i if i == n => 1.0,
        i => (times[i] - times[0]) / half - 1.0,
    };
    let mut legendre = [0.0; DEGREE + 1];
    let (mut s, mut slope) = (-1.0, 0.0);
    for i in 0..n {
        let (a, b, next) = (values[i], values[i + 1], place(i + 1));
        let length = next - s;
        legendre[0] += 0.25 * length * (a + b);
        legendre[1] += 0.25 * length * (a * (2.0 * s + next) + b * (s + 2.0 * next));
        let next_slope = (b - a) / length;
        if i > 0 {
            // The lines are the sum of one straight line and a bend at each inner sample. The integral of a
            // bend times a Legendre polynomial is a second integral of that polynomial.
            let bend = next_slope - slope;
            let p = legendre_at(s);
            for k in 2..=DEGREE {
                let two = 2.0 * k as f64;
                let outer = (p[k + 2] - p[k]) / (two + 3.0) - (p[k] - p[k - 2]) / (two - 1.0);
                legendre[k] += 0.5 * bend * outer;
            }
        }
        (s, slope) = (next, next_slope);
    }
    let polynomial = by_powers(&legendre);
    holds(times, values, half, &polynomial, limits).then_some(polynomial)
}

/// The Legendre polynomials up to degree [`DEGREE`] + 2 at `s`.
fn legendre_at(s: f64) -> [f64; DEGREE + 3] {
    let mut p = [1.0; DEGREE + 3];
    p[1] = s;
    for k in 1..DEGREE + 2 {
        let n = k as f64;
        p[k + 1] = ((2.0 * n + 1.0) * s * p[k] - n * p[k - 1]) / (n + 1.0);
    }
    p
}

/// Converts coefficients of Legendre polynomials to coefficients of ascending powers.
fn by_powers(legendre: &Polynomial) -> Polynomial {
    let (mut before, mut now) = ([0.0; DEGREE + 1], [0.0; DEGREE + 1]);
    now[0] = 1.0;
    let mut sum = [0.0; DEGREE + 1];
    for (k, c) in legendre.iter().enumerate() {
        sum.iter_mut().zip(&now).for_each(|(sum, term)| *sum += c * term);
        let n = k as f64;
        let mut next = [0.0; DEGREE + 1];
        for power in 0..=DEGREE {
            let raised = if power > 0 { now[power - 1] } else { 0.0 };
            next[power] = ((2.0 * n + 1.0) * raised - n * before[power]) / (n + 1.0);
        }
        (before, now) = (now, next);
    }
    sum
}

/// Whether both integrals of a polynomial agree with those of the lines to within the limits. They are
/// compared at each sample and at two points between samples, where the integral of a parabola's excess over
/// its chord is large.
fn holds(times: &[f64], values: &[f64], half: f64, polynomial: &Polynomial, limits: (f64, f64)) -> bool {
    let (mut once, mut twice) = ([0.0; DEGREE + 2], [0.0; DEGREE + 3]);
    for (k, c) in polynomial.iter().enumerate() {
        once[k + 1] = c / (k + 1) as f64;
        twice[k + 2] = once[k + 1] / (k + 2) as f64;
    }
    let at = |coefficients: &[f64], s: f64| coefficients.iter().rev().fold(0.0, |sum, c| sum * s + c);
    // both integrals are 0 at the start of the piece
    once[0] = -at(&once, -1.0);
    twice[1] = once[0];
    twice[0] = -at(&twice, -1.0);
    let (limit, second_limit) = (limits.0 / half, limits.1 / (half * half));
    let (mut sum, mut second) = (0.0, 0.0);
    for i in 1..times.len() {
        let (a, b) = (values[i - 1], values[i]);
        let (from, length) = ((times[i - 1] - times[0]) / half - 1.0, (times[i] - times[i - 1]) / half);
        for share in [0.25, 0.75, 1.0] {
            let (distance, end) = (share * length, a + share * (b - a));
            let first = sum + 0.5 * distance * (a + end);
            let next = second + distance * (sum + distance * (2.0 * a + end) / 6.0);
            let s = from + distance;
            let near = (at(&once, s) - first).abs() <= limit && (at(&twice, s) - next).abs() <= second_limit;
            if !near {
                return false;
            }
        }
        second += length * (sum + length * (2.0 * a + b) / 6.0);
        sum += 0.5 * length * (a + b);
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampled(rate: f64, f: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let times: Vec<f64> = (0..=(2.0 * rate) as usize).map(|i| i as f64 / rate).collect();
        let values = times.iter().map(|t| f(*t)).collect();
        (times, values)
    }

    #[test]
    fn polynomials_agree_with_the_samples_within_the_limits() {
        let sine = |t: f64| 10.0 * (std::f64::consts::TAU * 3.0 * t).sin();
        for (rate, limits, fewest) in [(1e4, (1e-10, 1e-12), 150.0), (1e3, (1e-7, 1e-10), 15.0)] {
            let (times, values) = sampled(rate, sine);
            let all = pieces(&times, &values, limits);
            let mut next = 0;
            let (mut speed, mut place) = (0.0_f64, 0.0_f64);
            for piece in &all {
                assert_eq!(piece.first, next);
                next += piece.lines;
                let polynomial = piece.polynomial.as_ref().unwrap();
                let half = 0.5 * (times[next] - times[piece.first]);
                // Simpson's rule on the difference, ten steps per line
                let (mut sum, mut second) = (0.0, 0.0);
                for i in piece.first..next {
                    let step = (times[i + 1] - times[i]) / 10.0;
                    for part in 0..10 {
                        let differs = |share: f64| {
                            let share = (f64::from(part) + share) / 10.0;
                            let t = times[i] + share * (times[i + 1] - times[i]);
                            let s = (t - times[piece.first]) / half - 1.0;
                            let value = polynomial.iter().rev().fold(0.0, |sum, c| sum * s + c);
                            value - (values[i] + share * (values[i + 1] - values[i]))
                        };
                        let before = sum;
                        sum += step * (differs(0.0) + 4.0 * differs(0.5) + differs(1.0)) / 6.0;
                        second += 0.5 * step * (before + sum);
                        (speed, place) = (speed.max(sum.abs()), place.max(second.abs()));
                    }
                }
                assert!(sum.abs() < 1e-13 && second.abs() < 0.1 * limits.1, "{sum:e} {second:e}");
            }
            assert_eq!(next, times.len() - 1);
            assert!(speed < 1.2 * limits.0 && place < 1.2 * limits.1, "{speed:e} {place:e}");
            let each = next as f64 / all.len() as f64;
            assert!(each > fewest, "{each} lines per piece");
        }
    }

    #[test]
    fn samples_that_jump_stay_lines() {
        let (times, values) = sampled(1e3, |t| (t * 1e4).sin());
        let all = pieces(&times, &values, (1e-8, 1e-10));
        assert_eq!(all, [Piece { first: 0, lines: times.len() - 1, polynomial: None }]);
    }
}
