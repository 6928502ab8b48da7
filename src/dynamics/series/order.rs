//! Orders of the series, the room for their coefficients, and how the series of a drive goes on.

use crate::numeric::Number;

/// The highest order of a step.
pub(crate) const MAX_ORDER: usize = 32;
/// Room for coefficients 0..=MAX_ORDER.
pub(crate) const ROOM: usize = MAX_ORDER + 2;
/// Coefficients of the drive that are there from the start.
pub(crate) const SEEDED: usize = 4;

/// How the series of a drive goes on.
pub(crate) trait Tail<T: Number> {
    /// State carried along a series.
    type Cursor: Default;

    /// From here on all coefficients are 0, and are not added: an addition of nothing takes its time too.
    const ZERO_FROM: usize = usize::MAX;

    /// Fills a\[k\], k >= `SEEDED`, once each and in ascending order; `inverse[n]` is 1/(n(n-1)).
    fn extend(&self, k: usize, a: &mut [T; ROOM], inverse: &[T; ROOM], cursor: &mut Self::Cursor);
}
