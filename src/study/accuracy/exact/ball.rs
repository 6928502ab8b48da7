//! A ball that is dropped or thrown on a rigid floor under a constant force, in closed form.

use super::dd;
use crate::numeric::{DoubleDouble, Number, Scalar};

/// Time in s of the first hit after a drop from `height` in m under `gravity` in m/s^2: sqrt(2 h/g).
pub fn first_hit(height: f64, gravity: f64) -> DoubleDouble {
    (dd(2.0) * dd(height) / dd(gravity)).sqrt()
}

/// Time of the `n`-th impact, from 1, of a dropped ball that first hits at `first`:
/// first (1 + 2 (e + e^2 + .. + e^(n-1))).
pub fn impact_time(first: DoubleDouble, restitution: f64, n: u32) -> DoubleDouble {
    let mut sum = DoubleDouble::zero();
    let mut power = dd(1.0);
    for _ in 1..n {
        power = power * dd(restitution);
        sum += power;
    }
    first * (dd(1.0) + sum + sum)
}

/// Time at which it rests, the sum of all flights: first (1 + e)/(1 - e).
pub fn rest_time(first: DoubleDouble, restitution: f64) -> DoubleDouble {
    first * (dd(1.0) + dd(restitution)) / (dd(1.0) - dd(restitution))
}
