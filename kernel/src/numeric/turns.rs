//! Turning points and extent of a sequence of values.

/// A turning point: a maximum or minimum from which the values retreat by more than the noise.
#[doc(hidden)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Turn {
    /// Index of the sample.
    pub at: usize,
    /// Whether it is a maximum.
    pub maximum: bool,
}

/// The alternating maxima and minima of `values` from which they retreat by more than `retreat`. The first
/// one is the extremum at the beginning, which may be the first sample.
#[doc(hidden)]
pub fn turns(values: &[f64], retreat: f64) -> Vec<Turn> {
    let mut turns = Vec::new();
    let (mut lowest, mut highest) = (0, 0);
    // whether the values rise; `None` until the first turning point
    let mut rising: Option<bool> = None;
    for (i, value) in values.iter().enumerate() {
        if *value > values[highest] {
            highest = i;
        }
        if *value < values[lowest] {
            lowest = i;
        }
        if rising != Some(false) && values[highest] - value > retreat {
            turns.push(Turn { at: highest, maximum: true });
            (rising, lowest) = (Some(false), i);
        } else if rising != Some(true) && value - values[lowest] > retreat {
            turns.push(Turn { at: lowest, maximum: false });
            (rising, highest) = (Some(true), i);
        }
    }
    turns
}

/// The smallest and the largest value, ignoring NaN; `(inf, -inf)` if there are none.
#[doc(hidden)]
pub fn extent(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    values.into_iter().fold(none, |(low, high), value| (low.min(value), high.max(value)))
}
