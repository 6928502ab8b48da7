//! Collocation at Gauss-Legendre points: integrals of a function up to each point from its values.

use std::sync::OnceLock;

use super::lanes::Lanes;
use super::quadrature::even_half;
use super::scalar::{Number, Scalar};

/// Number of points in a group: the number of doubles in the widest registers.
pub const GROUP: usize = 8;

/// Largest number of groups.
pub const MAX_GROUPS: usize = 6;

/// Values at the points, group by group; values beyond the last point are not used.
pub type Values<T> = [Lanes<GROUP, T>; MAX_GROUPS];

/// Gauss-Legendre points on \[-1, 1], ascending, with their weights and integration matrices.
///
/// For a function that is analytic in the ellipse with foci -1 and 1 and half axes of sum r, the error of the
/// interpolation falls like r^-points, and that of the integral from -1 to 1 like its square.
#[derive(Debug)]
pub struct Collocation {
    groups: usize,
    places: Values<f64>,
    weights: Values<f64>,
    /// Legendre polynomial k at each point, times half the weight.
    legendre: Vec<Values<f64>>,
    /// Integrals from -1 to each point of the interpolating polynomial that is 1 at point k, 0 at the others.
    integrals: Vec<Values<f64>>,
    /// Integrals of the same polynomials from -1 to 0.
    halves: Values<f64>,
}

impl Collocation {
    /// The rule with at least `points` points, up to the largest number; each rule is computed once.
    pub fn of(points: usize) -> &'static Self {
        static ALL: [OnceLock<Collocation>; MAX_GROUPS] = [const { OnceLock::new() }; MAX_GROUPS];
        let groups = points.div_ceil(GROUP).clamp(1, MAX_GROUPS);
        ALL[groups - 1].get_or_init(|| Self::new(groups))
    }

    fn new(groups: usize) -> Self {
        let none = [Lanes([0.0; GROUP]); MAX_GROUPS];
        let points = groups * GROUP;
        let all = || vec![none; points];
        let (legendre, integrals) = (all(), all());
        let mut rule = Self { groups, places: none, weights: none, legendre, integrals, halves: none };
        for (i, (place, weight)) in even_half(points / 2).into_iter().enumerate() {
            for (i, place) in [(i, -place), (points - 1 - i, place)] {
                rule.places[i / GROUP].0[i % GROUP] = place;
                rule.weights[i / GROUP].0[i % GROUP] = weight;
            }
        }
        for group in 0..groups {
            let (mut before, mut value) = (Lanes::zero(), Lanes::of(1.0));
            for k in 0..points {
                rule.legendre[k][group] = value * rule.weights[group] * Lanes::of(0.5);
                (before, value) = (value, next(k, rule.places[group], (before, value)));
            }
        }
        for k in 0..points {
            let mut unit = none;
            unit[k / GROUP].0[k % GROUP] = 1.0;
            let unit = rule.coefficients(&unit);
            for group in 0..groups {
                rule.integrals[k][group] = rule.integral(&unit, rule.places[group], Lanes::all).0;
            }
            rule.halves[k / GROUP].0[k % GROUP] = rule.integral(&unit, 0.0, |value| value).0;
        }
        rule
    }

    /// Number of groups of points.
    #[inline(always)]
    pub fn groups(&self) -> usize {
        self.groups
    }

    /// The points of a group.
    #[inline(always)]
    pub fn places<T: Scalar>(&self, group: usize) -> Lanes<GROUP, T> {
        self.places[group].map(T::of)
    }

    /// The integral from -1 to 1.
    #[inline(always)]
    pub fn total<T: Scalar>(&self, values: &Values<T>) -> T {
        self.product(&self.weights, values)
    }

    /// The integral from -1 to 0.
    pub fn half<T: Scalar>(&self, values: &Values<T>) -> T {
        self.product(&self.halves, values)
    }

    /// Integrates `slopes` from -1, starting with `first`, to each point.
    #[inline(always)]
    pub fn integrals<T: Scalar>(&self, first: T, slopes: &Values<T>, into: &mut Values<T>) {
        for (group, into) in into[..self.groups].iter_mut().enumerate() {
            let mut sum = Lanes::all(first);
            for (rows, slopes) in self.integrals.chunks_exact(GROUP).zip(slopes) {
                for (row, slope) in rows.iter().zip(slopes.0) {
                    sum += Lanes::all(slope) * row[group].map(T::of);
                }
            }
            *into = sum;
        }
    }

    /// The coefficients of the interpolating polynomial in Legendre polynomials of degree k, over 2 k + 1.
    pub fn coefficients<T: Scalar>(&self, values: &Values<T>) -> Values<T> {
        let mut coefficients = [Lanes::zero(); MAX_GROUPS];
        for (k, row) in self.legendre.iter().enumerate() {
            coefficients[k / GROUP].0[k % GROUP] = self.product(row, values);
        }
        coefficients
    }

    /// The integral from -1 to `place` of the polynomial with these coefficients, and its value at `place`.
    /// `place` may be several positions in lanes; `all` copies a coefficient to every lane.
    #[inline(always)]
    pub fn integral<T: Scalar, N: Number>(
        &self,
        coefficients: &Values<T>,
        place: N,
        all: impl Fn(T) -> N,
    ) -> (N, N) {
        let (mut sum, mut value) = (N::zero(), N::zero());
        let (mut before, mut now) = (N::of(-1.0), N::of(1.0));
        let coefficients = coefficients[..self.groups].iter().flat_map(|group| group.0);
        for (k, coefficient) in coefficients.enumerate() {
            let share = all(coefficient);
            let after = next(k, place, (before, now));
            sum += share * (after - before);
            value += share * N::whole(2 * k + 1) * now;
            (before, now) = (now, after);
        }
        (sum, value)
    }

    /// An estimate of the error of the interpolating polynomial's integrals: the larger of the last two
    /// coefficients in Legendre polynomials.
    #[inline(always)]
    pub fn unresolved<T: Scalar>(&self, values: &Values<T>) -> T {
        let last = |k: usize| self.product(&self.legendre[k], values).abs();
        let points = self.legendre.len();
        last(points - 1).larger(last(points - 2)) * T::of(2.0)
    }

    /// The scalar product of a row and the values, with one partial sum for each point of a group.
    #[inline(always)]
    fn product<T: Scalar>(&self, row: &Values<f64>, values: &Values<T>) -> T {
        let mut sums = Lanes::all(T::zero());
        for (row, values) in row[..self.groups].iter().zip(values) {
            sums += *values * row.map(T::of);
        }
        let [a, b, c, d, e, f, g, h] = sums.0;
        ((a + b) + (c + d)) + ((e + f) + (g + h))
    }
}

/// The Legendre polynomial of degree `k` + 1 at `x`, from those of degrees `k` - 1 and `k`.
#[inline(always)]
fn next<T: Number>(k: usize, x: T, (before, value): (T, T)) -> T {
    (T::whole(2 * k + 1) * x * value - T::whole(k) * before) * T::ratio(1.0, (k + 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrals_of_powers_are_exact_and_those_of_a_pole_fall_with_its_ellipse() {
        for points in [8, 16, 24, 48] {
            let rule = Collocation::of(points);
            assert_eq!(rule.groups() * GROUP, points);
            let at = |f: &dyn Fn(f64) -> f64| rule.places.map(|places| places.map(f));
            for power in [0, 1, 2, points as i32 - 1] {
                let values = at(&|x| x.powi(power));
                let exact = |x: f64| (x.powi(power + 1) - (-1.0_f64).powi(power + 1)) / f64::from(power + 1);
                let mut sums = values;
                rule.integrals(0.5, &values, &mut sums);
                for i in 0..points {
                    let (sum, place) = (sums[i / GROUP].0[i % GROUP], rule.places[i / GROUP].0[i % GROUP]);
                    assert!((sum - 0.5 - exact(place)).abs() < 1e-14, "{points} {power} {i}");
                }
                assert!((rule.total(&values) - exact(1.0)).abs() < 1e-14);
                assert!((rule.half(&values) - exact(0.0)).abs() < 1e-14);
                let (integral, value) = rule.integral(&rule.coefficients(&values), 0.3, |value| value);
                assert!((integral - exact(0.3)).abs() < 1e-14 && (value - 0.3_f64.powi(power)).abs() < 1e-13);
            }
            // 1/(1 + x^2), whose pole i lies on the ellipse of sum 1 + sqrt 2
            let values = at(&|x| 1.0 / (1.0 + x * x));
            let fall = (1.0 + 2.0_f64.sqrt()).powi(-(points as i32));
            let off = (rule.total(&values) - std::f64::consts::FRAC_PI_2).abs();
            assert!(off < 10.0 * fall * fall + 1e-15, "{points} {off:e}");
            // the function is even: the last nonzero term is the last but one
            let (unresolved, last) = (rule.unresolved(&values), fall * (1.0 + 2.0_f64.sqrt()).powi(2));
            let error = fall / points as f64;
            assert!(unresolved < last + 1e-15 && unresolved > 0.1 * last - 1e-15, "{points} {unresolved:e}");
            let (integral, value) = rule.integral(&rule.coefficients(&values), 0.4, |value| value);
            let off = integral - (0.4_f64.atan() + std::f64::consts::FRAC_PI_4);
            assert!(off.abs() < 10.0 * error + 1e-15, "{points} {off:e}");
            assert!((value - 1.0 / 1.16).abs() < 10.0 * fall + 1e-14);
        }
    }
}
