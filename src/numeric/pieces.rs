//! Polynomials that stand for many straight lines between samples at once.
//!
//! An acceleration that is given by samples, with straight lines between them, changes its slope at each. An
//! integrator that steps from corner to corner takes one step a sample, however smooth the samples are. What
//! it moves sees the acceleration through two integrals. The projection of the lines on Legendre polynomials
//! has the integral and the first moment of the lines, so speed and place, the first and the second integral,
//! are the same at both ends of each piece; in between they must differ by no more than the limits say.

/// Degree of the polynomials.
pub const DEGREE: usize = 10;

/// Fewer lines than this are not worth a polynomial.
const FEWEST: usize = 12;

/// Lines of the first polynomial that is tried.
const FIRST: usize = 64;

/// A polynomial of the place from -1 to 1 between two samples, by ascending powers.
pub type Polynomial = [f64; DEGREE + 1];

/// Consecutive lines.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// The sample at which the first line begins.
    pub first: usize,
    /// How many lines there are.
    pub lines: usize,
    /// What stands for them, where something does.
    pub polynomial: Option<Box<Polynomial>>,
}

/// Pieces for the lines between samples at ascending times: the first integral of each polynomial differs
/// from that of the lines by up to `limits.0` and the second one by up to `limits.1` anywhere, and at both
/// ends by rounding alone.
pub fn pieces(times: &[f64], values: &[f64], limits: (f64, f64)) -> Vec<Piece> {
    let last = times.len() - 1;
    let fitted = |first: usize, lines: usize| {
        let samples = first..=first + lines;
        fitted(&times[samples.clone()], &values[samples], limits).map(Box::new)
    };
    let mut all: Vec<Piece> = Vec::new();
    let (mut first, mut guess) = (0, FIRST);
    while first < last {
        let left = last - first;
        let mut lines = guess.min(left);
        let mut polynomial = fitted(first, lines);
        if polynomial.is_some() {
            let mut more = lines.div_ceil(4);
            while lines < left {
                let longer = (lines + more).min(left);
                let Some(found) = fitted(first, longer) else { break };
                (lines, polynomial, more) = (longer, Some(found), 2 * more);
            }
        }
        while polynomial.is_none() && lines / 2 >= FEWEST {
            lines /= 2;
            polynomial = fitted(first, lines);
        }
        guess = lines.max(2 * FEWEST);
        match all.last_mut() {
            Some(before) if polynomial.is_none() && before.polynomial.is_none() => before.lines += lines,
            _ => all.push(Piece { first, lines, polynomial }),
        }
        first += lines;
    }
    all
}

/// The polynomial for these lines; none where it differs by more than the limits.
fn fitted(times: &[f64], values: &[f64], limits: (f64, f64)) -> Option<Polynomial> {
    let n = times.len() - 1;
    if n < FEWEST {
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
        let onward = (b - a) / length;
        if i > 0 {
            // The lines are a straight one and a bend at each sample, whose integral with each polynomial is
            // a second integral of that.
            let bend = onward - slope;
            let p = legendre_at(s);
            for k in 2..=DEGREE {
                let two = 2.0 * k as f64;
                let outer = (p[k + 2] - p[k]) / (two + 3.0) - (p[k] - p[k - 2]) / (two - 1.0);
                legendre[k] += 0.5 * bend * outer;
            }
        }
        (s, slope) = (next, onward);
    }
    let polynomial = by_powers(&legendre);
    holds(times, values, (half, &polynomial), limits).then_some(polynomial)
}

/// Legendre polynomials up to two degrees more at `s`.
fn legendre_at(s: f64) -> [f64; DEGREE + 3] {
    let mut p = [1.0; DEGREE + 3];
    p[1] = s;
    for k in 1..DEGREE + 2 {
        let n = k as f64;
        p[k + 1] = ((2.0 * n + 1.0) * s * p[k] - n * p[k - 1]) / (n + 1.0);
    }
    p
}

/// A sum of Legendre polynomials by ascending powers.
fn by_powers(legendre: &Polynomial) -> Polynomial {
    let (mut before, mut now) = ([0.0; DEGREE + 1], [0.0; DEGREE + 1]);
    now[0] = 1.0;
    let mut sum = [0.0; DEGREE + 1];
    for (k, c) in legendre.iter().enumerate() {
        sum.iter_mut().zip(&now).for_each(|(sum, own)| *sum += c * own);
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

/// Whether both integrals of a polynomial are within the limits of those of the lines, at each sample and
/// twice between two, where a parabola's excess over its chord has its largest integral.
fn holds(times: &[f64], values: &[f64], (half, polynomial): (f64, &Polynomial), limits: (f64, f64)) -> bool {
    let (mut once, mut twice) = ([0.0; DEGREE + 2], [0.0; DEGREE + 3]);
    for (k, c) in polynomial.iter().enumerate() {
        once[k + 1] = c / (k + 1) as f64;
        twice[k + 2] = once[k + 1] / (k + 2) as f64;
    }
    let at = |coefficients: &[f64], s: f64| coefficients.iter().rev().fold(0.0, |sum, c| sum * s + c);
    // both vanish where the piece begins
    once[0] = -at(&once, -1.0);
    twice[1] = once[0];
    twice[0] = -at(&twice, -1.0);
    let (limit, second_limit) = (limits.0 / half, limits.1 / (half * half));
    let (mut sum, mut second) = (0.0, 0.0);
    for i in 1..times.len() {
        let (a, b) = (values[i - 1], values[i]);
        let (from, length) = ((times[i - 1] - times[0]) / half - 1.0, (times[i] - times[i - 1]) / half);
        for share in [0.25, 0.75, 1.0] {
            let (way, end) = (share * length, a + share * (b - a));
            let first = sum + 0.5 * way * (a + end);
            let next = second + way * (sum + way * (2.0 * a + end) / 6.0);
            let s = from + way;
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

    fn sampled(rate: f64, of: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let times: Vec<f64> = (0..=(2.0 * rate) as usize).map(|i| i as f64 / rate).collect();
        let values = times.iter().map(|t| of(*t)).collect();
        (times, values)
    }

    #[test]
    fn polynomials_of_samples_stand_for_them_to_the_limits() {
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
                // by Simpson's rule on the difference, ten steps a line
                let (mut sum, mut second) = (0.0, 0.0);
                for i in piece.first..next {
                    let step = (times[i + 1] - times[i]) / 10.0;
                    for part in 0..10 {
                        let differs = |share: f64| {
                            let share = (f64::from(part) + share) / 10.0;
                            let t = times[i] + share * (times[i + 1] - times[i]);
                            let s = (t - times[piece.first]) / half - 1.0;
                            let own = polynomial.iter().rev().fold(0.0, |sum, c| sum * s + c);
                            own - (values[i] + share * (values[i + 1] - values[i]))
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
            assert!(each > fewest, "{each} lines a piece");
        }
    }

    #[test]
    fn samples_that_jump_stay_lines() {
        let (times, values) = sampled(1e3, |t| (t * 1e4).sin());
        let all = pieces(&times, &values, (1e-8, 1e-10));
        assert_eq!(all, [Piece { first: 0, lines: times.len() - 1, polynomial: None }]);
    }
}
