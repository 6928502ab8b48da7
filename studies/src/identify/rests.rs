//! Equilibria of a measured force curve: position and stiffness, also near a kink.

use nalgebra::SVector;

use super::Identity;
use super::force::{Known, Pull, within};
use crate::numeric::regression::{Fit, least_squares, powers};
use crate::numeric::{bisect, elementary, golden_section};

/// Shares of the range, on each side of an equilibrium, over which the force is fitted.
const REACHES: [f64; 6] = [0.04, 0.02, 0.01, 0.005, 0.0025, 0.001];
/// Wider ones, if there are too few samples.
const WIDE: [f64; 2] = [0.08, 0.16];

/// A smaller reach, or a kink, is used if it reduces the interval of the force to less than this share.
const BETTER: f64 = 0.5;

const MIN_FREEDOM: usize = 4;

/// Smallest relative jump of the slope at a kink.
const JUMP: f64 = 0.01;

/// Number of positions of a kink that are tried.
const TRIED: usize = 40;
/// Largest number of samples that are used for that.
const LOOKED_AT: usize = 1000;
/// Smallest number of samples on each side of a kink.
const BESIDE: usize = 4;

/// Number of positions at which the sign of the force is evaluated.
const PLACES: u32 = 64;
const HALVINGS: u32 = 60;

pub struct Rest {
    /// Where it is, in m, with its interval.
    pub x: (f64, [f64; 2]),
    /// The slope of the force there in N/m, with its interval; beside a kink that of both slopes.
    pub stiffness: (f64, [f64; 2]),
    /// A kink near it: its place in m, and the slopes on its left and right in N/m.
    pub kink: Option<[f64; 3]>,
    /// Half of the interval of the force there, in N.
    half: f64,
    fits: Vec<Near>,
}

impl Rest {
    /// The equilibrium of the mean of pulls near a place where it changes sign, in a curve of length `range`.
    ///
    /// For each direction a cubic, or two cubics that join at a kink (whose position is found by least
    /// squares), is fitted over a share of the range on each side. The largest share without a kink is used,
    /// unless another fit halves the interval of the force, as it does if the force is known accurately.
    pub fn near(place: f64, pulls: &[&Pull], range: f64) -> Option<Self> {
        let mut best: Option<Self> = None;
        let fitted = |reach: f64, kinked: bool| {
            let reach = reach * range;
            let samples: Vec<_> = pulls.iter().map(|pull| samples(pull, place, reach)).collect();
            let kink = if kinked { Some(kink_of(&samples)?) } else { None };
            let fit = |samples: &Pull| Near::fit(samples, place, reach, kink);
            Self::of(place, reach, samples.iter().map(fit).collect::<Option<Vec<_>>>()?)
        };
        for reach in REACHES {
            for rest in [false, true].into_iter().filter_map(|kinked| fitted(reach, kinked)) {
                if best.as_ref().is_none_or(|best| rest.half < BETTER * best.half) {
                    best = Some(rest);
                }
            }
        }
        best.or_else(|| WIDE.into_iter().find_map(|reach| fitted(reach, false)))
    }

    /// The equilibrium of the mean of these fits.
    fn of(place: f64, reach: f64, fits: Vec<Near>) -> Option<Self> {
        let at = |x: f64, order: usize| mean(&fits, x, order);
        let force = |x: f64| at(x, 0).map_or(f64::NAN, |known| known.value);
        let (low, high) = (place - reach, place + reach);
        let step = (high - low) / f64::from(PLACES);
        let changes = (0..PLACES).map(|i| low + step * f64::from(i));
        let left = changes
            .filter(|x| force(*x) * force(x + step) <= 0.0)
            .min_by(|a, b| (a - place).abs().total_cmp(&(b - place).abs()))?;
        let sign = force(left).signum();
        let x = bisect(left, left + step, HALVINGS, |x| force(x) * sign > 0.0).1;
        // where the force can no longer be distinguished from 0
        let half = at(x, 0)?.half();
        let end = |side: f64| {
            let inside = |away: f64| force(x + side * away).abs() <= half;
            let limit = if side < 0.0 { x - low } else { high - x };
            let mut away = 1e-9 * reach;
            while away < limit && inside(away) {
                away *= 2.0;
            }
            if away < limit { x + side * bisect(0.0, away, HALVINGS, inside).1 } else { x + side * limit }
        };
        let ends = [end(-1.0), end(1.0)];
        let slope = at(x, 1)?;
        let mut stiffness = (slope.value, [slope.value - slope.half(), slope.value + slope.half()]);
        // just beside it
        let beside = |kink: f64, side: f64| at(kink + side * 1e-9 * reach, 1);
        let kink = fits.first().and_then(|fit| fit.kink);
        let sides = kink.and_then(|kink| Some([beside(kink, -1.0)?, beside(kink, 1.0)?]));
        if let (Some(kink), Some(sides)) = (kink, &sides)
            // the position of the kink has an error as well
            && (2.0 * ends[0] - x..=2.0 * ends[1] - x).contains(&kink)
        {
            let low = sides.iter().map(|slope| slope.value - slope.half());
            let high = sides.iter().map(|slope| slope.value + slope.half());
            stiffness.1 = [low.fold(stiffness.1[0], f64::min), high.fold(stiffness.1[1], f64::max)];
        }
        let kink = kink.zip(sides).map(|(kink, [left, right])| [kink, left.value, right.value]);
        // the second cubic may also fit a smooth force
        let jumps = |[_, left, right]: &[f64; 3]| (left - right).abs() > JUMP * left.abs().max(right.abs());
        let kink = kink.filter(jumps);
        Some(Self { x: (x, ends), stiffness, kink, half, fits })
    }

    /// Whether the force drives back to it.
    pub fn is_stable(&self) -> bool {
        self.stiffness.0 > 0.0
    }

    /// Place and stiffness under these names.
    pub fn identities(&self, names: [&'static str; 2]) -> [Identity; 2] {
        let named = [(names[0], self.x), (names[1], self.stiffness)];
        named.map(|(name, (value, interval))| Identity { name, value, interval: interval.into() })
    }

    /// Integral of the force in J from here to a place within reach of the fits, and force and slope there.
    pub fn work_to(&self, x: f64) -> Option<[Known; 3]> {
        let work = self.fits.iter().map(|fit| fit.work(self.x.0, x)).reduce(Known::and)?;
        Some([work, mean(&self.fits, x, 0)?, mean(&self.fits, x, 1)?])
    }

    /// How far the fits reach to either side, in m.
    pub fn reach(&self) -> f64 {
        self.fits.first().map_or(0.0, |fit| fit.reach - (self.x.0 - fit.centre).abs())
    }
}

/// The mean force of some fits at a place in m, or with an order of 1 its slope.
fn mean(fits: &[Near], x: f64, order: usize) -> Option<Known> {
    fits.iter().map(|fit| fit.known(&fit.terms(x, order), order)).reduce(Known::and)
}

/// Terms of a fit: four of a cubic, three of another beyond the kink, and the shift of the kink.
type Terms = SVector<f64, 8>;

/// The force of one direction near a place: polynomials in u = (x - centre)/reach.
struct Near {
    centre: f64,
    reach: f64,
    /// Where the slope jumps, in m.
    kink: Option<f64>,
    /// The coefficients of the second cubic.
    beyond: [f64; 3],
    fit: Polynomial,
}

enum Polynomial {
    Smooth(Box<Fit<4>>),
    Kinked(Box<Fit<8>>),
}

impl Near {
    /// The fit to samples over u, with a kink there; `None` if they are too few.
    fn fit(samples: &[(f64, f64)], centre: f64, reach: f64, kink: Option<f64>) -> Option<Self> {
        let Some(kink) = kink else {
            let smooth = |(u, force): &(f64, f64)| (powers(*u), *force);
            let fit = least_squares(&samples.iter().map(smooth).collect::<Vec<_>>())?;
            let enough = fit.freedom >= MIN_FREEDOM;
            let fit = Polynomial::Smooth(Box::new(fit));
            return enough.then_some(Self { centre, reach, kink: None, beyond: [0.0; 3], fit });
        };
        if samples.len() < MIN_FREEDOM + 8 {
            return None;
        }
        let cubics = joined(samples.iter(), kink)?.coefficients;
        let beyond = [cubics[4], cubics[5], cubics[6]];
        let row = |(u, force): &(f64, f64)| (terms(*u, kink, &beyond, 0).into(), *force);
        // the kink is already at its least-squares position; its term only contributes to the errors
        let moved: Fit<8> = least_squares(&samples.iter().map(row).collect::<Vec<_>>())?;
        let coefficients = SVector::<f64, 8>::from_fn(|k, _| if k < 7 { cubics[k] } else { 0.0 });
        let fit = Polynomial::Kinked(Box::new(Fit { coefficients, ..moved }));
        Some(Self { centre, reach, kink: Some(centre + kink * reach), beyond, fit })
    }

    /// The share of each coefficient in the force at `x` in m, or with an order of 1 in its slope in u.
    fn terms(&self, x: f64, order: usize) -> Terms {
        let local = |x: f64| (x - self.centre) / self.reach;
        terms(local(x), self.kink.map_or(f64::INFINITY, local), &self.beyond, order)
    }

    /// The value of a linear form of the coefficients, a derivative of this order; per m.
    fn known(&self, terms: &Terms, order: usize) -> Known {
        let ((value, error), freedom) = match &self.fit {
            Polynomial::Smooth(fit) => (fit.form(&terms.fixed_rows::<4>(0).into_owned()), fit.freedom),
            Polynomial::Kinked(fit) => (fit.form(terms), fit.freedom),
        };
        let unit = elementary::powi(self.reach, order as i32);
        Known { value: value / unit, error: error / unit, freedom }
    }

    /// Integral of the force in J: by Gauss's rule with two points on each side of the kink.
    fn work(&self, from: f64, to: f64) -> Known {
        let inner = self.kink.filter(|kink| (*kink - from) * (*kink - to) < 0.0);
        let ends: Vec<f64> = [Some(from), inner, Some(to)].into_iter().flatten().collect();
        let mut sum = Terms::zeros();
        for pair in ends.windows(2) {
            let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
            for side in [-1.0, 1.0] {
                sum += half * self.terms(middle + side * half / 3_f64.sqrt(), 0);
            }
        }
        self.known(&sum, 0)
    }
}

fn terms(u: f64, kink: f64, [a, b, c]: &[f64; 3], order: usize) -> Terms {
    let v = (u - kink).max(0.0);
    let beyond = if u > kink { 1.0 } else { 0.0 };
    Terms::from(match order {
        0 => {
            let moving = -beyond * (a + v * (2.0 * b + 3.0 * c * v));
            [1.0, u, u * u, u.powi(3), v, v * v, v.powi(3), moving]
        }
        _ => {
            let moving = -beyond * (2.0 * b + 6.0 * c * v);
            [0.0, 1.0, 2.0 * u, 3.0 * u * u, beyond, 2.0 * v, 3.0 * v * v, moving]
        }
    })
}

/// The fit of a cubic with another added from a kink on.
fn joined<'a>(samples: impl Iterator<Item = &'a (f64, f64)>, kink: f64) -> Option<Fit<7>> {
    let row = |(u, force): &(f64, f64)| {
        let all = terms(*u, kink, &[0.0; 3], 0);
        (std::array::from_fn(|k| all[k]), *force)
    };
    least_squares(&samples.map(row).collect::<Vec<_>>())
}

/// The samples of a pull up to `reach` away from a place, over u.
fn samples(pull: &Pull, centre: f64, reach: f64) -> Pull {
    let inside = within(pull, centre - reach, centre + reach);
    inside.iter().map(|(x, force)| ((x - centre) / reach, *force)).collect()
}

/// The place of a kink that all directions have, which leaves the least squares.
fn kink_of(directions: &[Pull]) -> Option<f64> {
    let samples = directions.iter().map(Vec::len).max()?;
    let stride = samples.div_ceil(LOOKED_AT).max(1);
    let square = |kink: f64| -> f64 {
        let left = |samples: &Pull| {
            let fit = joined(samples.iter().step_by(stride), kink);
            fit.map_or(f64::INFINITY, |fit| fit.variance * fit.freedom as f64)
        };
        directions.iter().map(left).sum()
    };
    let ends = |samples: &Pull| Some((samples.get(BESIDE)?.0, samples.iter().rev().nth(BESIDE)?.0));
    let ends = directions.iter().map(ends).collect::<Option<Vec<_>>>()?;
    let (first, last) = ends.into_iter().reduce(|all, ends| (all.0.max(ends.0), all.1.min(ends.1)))?;
    let step = (last - first) / TRIED as f64;
    let tried = (0..=TRIED).map(|i| first + step * i as f64);
    let tried = tried.map(|kink| (kink, square(kink)));
    let best = tried.filter(|tried| tried.1.is_finite()).min_by(|a, b| a.1.total_cmp(&b.1))?.0;
    Some(golden_section((best - step).max(first), (best + step).min(last), HALVINGS, square))
}
