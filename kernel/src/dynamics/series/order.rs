//! Orders of the series, room for their coefficients, and the trait of a drive that is continued as a series.

use crate::numeric::Number;

pub(crate) const MAX_ORDER: usize = 32;
/// Room for coefficients 0..=MAX_ORDER.
pub(crate) const ROOM: usize = MAX_ORDER + 2;
/// Number of coefficients of the drive that are known from the start.
pub(crate) const SEEDED: usize = 4;

pub(crate) trait Tail<T: Number> {
    /// State carried along a series.
    type Cursor: Default;

    /// The order from which on all coefficients are 0, if there is one. If it is a compile-time constant, no
    /// code adds them.
    #[inline(always)]
    fn zero_from(&self) -> Option<usize> {
        None
    }

    /// The acceleration that a circuit takes at order `k`, from y\[0..=k+1\]; `None` without a circuit. To be
    /// called in ascending order; each call also computes the next coefficient of the circuit's state.
    #[inline(always)]
    fn couple(&self, _k: usize, _y: &[T; ROOM], _cursor: &mut Self::Cursor) -> Option<T> {
        None
    }

    /// Computes a\[k\], k >= `SEEDED`, once for each `k`, in ascending order; `inverse[n]` is 1/(n(n-1)).
    fn extend(&self, k: usize, a: &mut [T; ROOM], inverse: &[T; ROOM], cursor: &mut Self::Cursor);
}
