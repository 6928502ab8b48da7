//! Decay of the changes of a motion from one lap to the next.

use crate::numeric::elementary;

/// Largest change in a period of a motion whose transient has decayed, as a share of the scales: four decades
/// below `STATE_MATCH`, so that its rate can be told, and well above the errors of the usual tolerances.
pub(super) const DECAYED: f64 = 1e-7;

/// A change half way between `STATE_MATCH` and [`DECAYED`], as a share of the scales.
const HALF_DECAYED: f64 = 1e-5;

/// Multiple of the time of the first half of a decay that its second half may take, and laps besides. A
/// motion in an irregular band as narrow as [`DECAYED`] comes there fast and stays.
const EVEN: (f64, f64) = (4.0, 8.0);

/// Factor, as a logarithm to base 2, by which the sizes of two changes may differ though the transient is as
/// large: a change turns from long to short axes of its ellipse.
const SWING: f64 = 2.3;

/// Largest multiplier, as a logarithm to base 2, of an orbit that attracts clearly: a motion whose change is
/// [`DECAYED`] is then off it by a three-hundredth of `STATE_MATCH` at most. It is 0.97.
const CLEAR_MULTIPLIER: f64 = -0.044;

/// A change over a period: the number of the state at its end, and its size as a share of the scales.
type Change = (u64, f64);

/// Decay of the changes over a period, since they are below `STATE_MATCH`.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Decay {
    first: Option<Change>,
    /// The number of the last one above [`HALF_DECAYED`].
    half: Option<u64>,
    /// The last one above [`DECAYED`].
    last: Option<Change>,
}

impl Decay {
    /// Adds the change that ends with the state of this number.
    pub fn add(&mut self, number: u64, size: f64) {
        self.first.get_or_insert((number, size));
        if size > HALF_DECAYED {
            self.half = Some(number);
        }
        if size > DECAYED {
            self.last = Some((number, size));
        }
    }

    /// Whether the changes after `q` states have decayed evenly, and so fast that the orbit attracts in every
    /// direction. `seen` states are known; areas of states shrink in a lap by the factor whose logarithm to
    /// base 2 is `volume`, at least. The rate of the decay is one multiplier, and the area over it the other.
    pub fn is_clear(&self, q: u32, seen: u64, volume: f64) -> bool {
        let Some(((begin, from), (end, to))) = self.first.zip(self.last) else { return false };
        let half = self.half.unwrap_or(begin);
        let [laps, before, after] =
            [end - begin, half - begin, end - half].map(|states| states as f64 / f64::from(q));
        let shrunk = elementary::log2(from / to);
        let (rate, other) = ((SWING - shrunk) / laps, volume + (shrunk + SWING) / laps);
        let is_still = end + 2 * u64::from(q) < seen;
        let is_even = after <= EVEN.0 * before + EVEN.1;
        is_still && is_even && laps > 0.0 && rate.max(other) <= CLEAR_MULTIPLIER
    }
}
