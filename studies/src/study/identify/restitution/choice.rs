//! The window and the degree from which an estimate is taken, and its interval.

use std::collections::BTreeMap;

/// What is varied: the number of the window, the wider the higher, and the number of coefficients.
pub type Setting = (usize, usize);

/// Estimates of one number by setting: its value, and half of the 95 % interval that noise makes.
pub type Estimates = BTreeMap<Setting, (f64, f64)>;

/// An estimate and half of its 95 % interval.
#[derive(Debug, Clone, Copy)]
pub struct Choice {
    pub setting: Setting,
    pub value: f64,
    pub half: f64,
}

/// The estimate with the narrowest interval.
///
/// Polynomials of few terms over wide windows have little noise, but do not follow the motion. Where they do
/// not, a further term, a term less or a narrower window gives another value. The greatest difference from
/// these four neighbours (of windows the next two) counts as an error besides that of noise, and the squares
/// of both are added. Without noise the interval is the difference alone. Values that differ by noise make
/// an interval a little too wide, and the narrowest of many is a little too narrow: over records drawn at
/// random both cancel, which `tests/suite/measured/impacts.rs` holds.
///
/// A setting without a neighbour of fewer terms is not taken, since nothing shows whether it has enough.
pub fn narrowest(estimates: &Estimates) -> Option<Choice> {
    let choice = |(&setting, &(value, noise)): (&Setting, &(f64, f64))| {
        let (window, terms) = setting;
        let apart = |other: Setting| estimates.get(&other).map(|(other, _)| (value - other).abs());
        let fewer = apart((window, terms - 1))?;
        let narrower = |by: usize| (window.wrapping_sub(by), terms);
        let neighbours = [(window, terms + 1), narrower(1), narrower(2)];
        let difference = neighbours.into_iter().filter_map(apart).fold(fewer, f64::max);
        Some(Choice { setting, value, half: noise.hypot(difference) })
    };
    estimates.iter().filter_map(choice).min_by(|a, b| a.half.total_cmp(&b.half))
}
