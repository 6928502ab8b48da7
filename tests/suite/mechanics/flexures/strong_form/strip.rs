//! One flexure of the second method: the Taylor series of Reissner's beam over a cell, with derivatives by
//! dual numbers.

use std::array::from_fn;
use std::f64::consts::PI;
use std::ops::{Add, Mul, Sub};

/// Terms of the Taylor series of a cell.
const TERMS: usize = 20;

/// A value and its derivatives by theta and M at the beginning of a cell, by H and by Q.
#[derive(Clone, Copy)]
pub struct Dual(pub [f64; 5]);

impl Dual {
    const ZERO: Self = Self([0.0; 5]);

    fn variable(value: f64, place: usize) -> Self {
        let mut dual = Self::ZERO;
        dual.0[0] = value;
        dual.0[place] = 1.0;
        dual
    }

    fn times(self, factor: f64) -> Self {
        Self(self.0.map(|v| v * factor))
    }

    /// A function with this value and this derivative at `self`.
    fn map(self, value: f64, slope: f64) -> Self {
        Self(from_fn(|i| if i == 0 { value } else { slope * self.0[i] }))
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] - other.0[i]))
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        Self(from_fn(|i| if i == 0 { a[0] * b[0] } else { a[0] * b[i] + a[i] * b[0] }))
    }
}

/// One flexure of a group, in units of the buckling flexure's length and EI.
#[derive(Clone)]
pub struct Strip {
    pub count: f64,
    pub length: f64,
    pub bending: f64,
    pub stretch: f64,
    pub shear: f64,
    /// Amplitude of the stress-free rotation, a sine of one period.
    pub bow: f64,
}

/// What one cell adds: theta and M at its end, and the shortening, deflection and energy along it.
pub struct Cell {
    pub ends: [Dual; 2],
    pub gains: [Dual; 3],
}

impl Strip {
    pub fn natural(&self, s: f64) -> (f64, f64) {
        let wave = 2.0 * PI / self.length;
        (self.bow * (wave * s).sin(), self.bow * wave * (wave * s).cos())
    }

    pub fn cell(&self, from: f64, size: f64, [theta, moment, axial, lateral]: [f64; 4]) -> Cell {
        let start: [Dual; 4] =
            [(theta, 1), (moment, 2), (axial, 3), (lateral, 4)].map(|(v, i)| Dual::variable(v, i));
        let [theta_0, moment_0, h, q] = start;
        let mut angle = [Dual::ZERO; TERMS];
        let [mut turn, mut moment, mut sine, mut cosine, mut versine] = [angle; 5];
        let [mut normal, mut shear, mut both] = [angle; 3];
        (angle[0], moment[0]) = (theta_0, moment_0);
        let (s, c) = theta.sin_cos();
        sine[0] = theta_0.map(s, c);
        cosine[0] = theta_0.map(c, -s);
        versine[0] = theta_0.map(2.0 * (0.5 * theta).sin().powi(2), s);
        let wave = 2.0 * PI / self.length;
        let mut power = self.bow * wave;
        let sum = |a: &[Dual], b: &[Dual], k: usize| (0..=k).fold(Dual::ZERO, |sum, j| sum + a[j] * b[k - j]);
        for k in 0..TERMS {
            normal[k] = h * cosine[k] + q * sine[k];
            shear[k] = q * cosine[k] - h * sine[k];
            both[k] = sum(&normal, &shear, k);
            turn[k] = moment[k].times(1.0 / self.bending);
            // The k-th derivative of the cosine is the cosine k right angles on.
            turn[k].0[0] += power * (wave * from + 0.5 * PI * k as f64).cos();
            if k + 1 == TERMS {
                break;
            }
            let next = 1.0 / (k + 1) as f64;
            power *= wave * next;
            angle[k + 1] = turn[k].times(next);
            moment[k + 1] = (shear[k] + both[k].times(self.stretch - self.shear)).times(-next);
            sine[k + 1] = sum(&cosine, &turn, k).times(next);
            versine[k + 1] = sum(&sine, &turn, k).times(next);
            cosine[k + 1] = versine[k + 1].times(-1.0);
        }
        let mut cell = Cell { ends: [Dual::ZERO; 2], gains: [Dual::ZERO; 3] };
        let mut power = 1.0;
        for k in 0..TERMS {
            cell.ends[0] = cell.ends[0] + angle[k].times(power);
            cell.ends[1] = cell.ends[1] + moment[k].times(power);
            let rates = [
                versine[k] - sum(&normal, &cosine, k).times(self.stretch)
                    + sum(&shear, &sine, k).times(self.shear),
                sine[k]
                    + sum(&normal, &sine, k).times(self.stretch)
                    + sum(&shear, &cosine, k).times(self.shear),
                sum(&moment, &moment, k).times(0.5 / self.bending)
                    + sum(&normal, &normal, k).times(0.5 * self.stretch)
                    + sum(&shear, &shear, k).times(0.5 * self.shear),
            ];
            power *= size;
            for (gain, rate) in cell.gains.iter_mut().zip(rates) {
                *gain = *gain + rate.times(power / (k + 1) as f64);
            }
        }
        cell
    }
}
