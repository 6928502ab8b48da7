//! Vectors of numbers for the same arithmetic on each lane.
//!
//! The arithmetic has a fixed width and no branch, so that the compiler turns it into vector instructions, as
//! wide as the target features of the caller allow. Each lane gets the bits that it would get alone: nothing
//! is fused or reordered. Doubles have no loops: a batch inlines thousands of these operations into one
//! function, which takes minutes to compile if each is a loop.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::scalar::{Number, assign_operators};

/// `W` numbers side by side.
///
/// Its arithmetic is that of each number alone, bit for bit; batches of runs compute with it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub struct Lanes<const W: usize, T = f64>(pub [T; W]);

impl<const W: usize, T: Number> Lanes<W, T> {
    /// The vector whose lane i is `f(i)`.
    #[inline(always)]
    pub fn from_fn(f: impl FnMut(usize) -> T) -> Self {
        Self(std::array::from_fn(f))
    }

    /// The same number in all lanes.
    #[inline(always)]
    pub fn all(value: T) -> Self {
        Self([value; W])
    }
}

impl<const W: usize, T> Lanes<W, T> {
    /// Applies `f` to each lane.
    #[inline(always)]
    pub fn map<U>(self, f: impl FnMut(T) -> U) -> Lanes<W, U> {
        Lanes(self.0.map(f))
    }
}

/// Calls `f` for each lane; written out for numbers that are quick, except in a page, which is to be small.
#[inline(always)]
fn each<const W: usize, T: Number>(mut f: impl FnMut(usize)) {
    macro_rules! calls {
        ($($lane:literal)*) => {{ $(f($lane);)* }};
    }
    let written_out = T::QUICK && !cfg!(target_arch = "wasm32");
    match W {
        4 if written_out => calls!(0 1 2 3),
        8 if written_out => calls!(0 1 2 3 4 5 6 7),
        16 if written_out => calls!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15),
        _ => {
            let mut lane = 0;
            while lane < W {
                f(lane);
                lane += 1;
            }
        }
    }
}

macro_rules! lane_by_lane {
    ($trait:ident, $method:ident, $operator:tt) => {
        impl<const W: usize, T: Number> $trait for Lanes<W, T> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let mut result = self;
                each::<W, T>(|lane| result.0[lane] = self.0[lane] $operator other.0[lane]);
                result
            }
        }
    };
}

lane_by_lane!(Add, add, +);
lane_by_lane!(Sub, sub, -);
lane_by_lane!(Mul, mul, *);
lane_by_lane!(Div, div, /);

impl<const W: usize, T: Number> Neg for Lanes<W, T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let mut result = self;
        each::<W, T>(|lane| result.0[lane] = -self.0[lane]);
        result
    }
}

assign_operators!([const W: usize, T: Number] Lanes<W, T>);

impl<const W: usize, T: Number> Number for Lanes<W, T> {
    const QUICK: bool = T::QUICK;

    #[inline(always)]
    fn of(value: f64) -> Self {
        Self([T::of(value); W])
    }
    #[inline(always)]
    fn ratio(over: f64, under: f64) -> Self {
        Self([T::ratio(over, under); W])
    }
    #[inline(always)]
    fn abs(self) -> Self {
        let mut result = self;
        each::<W, T>(|lane| result.0[lane] = self.0[lane].abs());
        result
    }
}

/// Runs `work` with the widest vector instructions of this processor. Nothing is fused, so the bits are the
/// same on every processor. Everything that `work` calls must be inlined into it.
#[inline]
pub(crate) fn widest<R>(work: impl FnOnce() -> R) -> R {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        if let Some(wide) = pulp::x86::V4::try_new() {
            return wide.vectorize(Wide(work));
        }
        if let Some(wide) = pulp::x86::V3::try_new() {
            return wide.vectorize(Wide(work));
        }
    }
    work()
}

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
struct Wide<F>(F);

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
impl<R, F: FnOnce() -> R> pulp::NullaryFnOnce for Wide<F> {
    type Output = R;

    #[inline(always)]
    fn call(self) -> R {
        (self.0)()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_lane_computes_like_a_single_number() {
        let a = Lanes([1.5, -2.0, 0.1, 1e300]);
        let b = Lanes([0.5, 3.0, 0.2, 1e-300]);
        for i in 0..4 {
            let (x, y) = (a.0[i], b.0[i]);
            let all = [
                (a + b, x + y),
                (a - b, x - y),
                (a * b, x * y),
                (a / b, x / y),
                (-a, -x),
                (a.abs(), x.abs()),
            ];
            assert!(all.iter().all(|(lanes, alone)| lanes.0[i].to_bits() == alone.to_bits()));
        }
        assert_eq!(Lanes::<2>::ratio(1.0, 3.0).0, [1.0 / 3.0; 2]);
    }
}
