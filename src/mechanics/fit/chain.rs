//! Chain of pieces through the samples, each as long as the tolerance allows.

use std::sync::atomic::Ordering;

use super::Samples;
use crate::mechanics::curve::Piece;

impl Samples<'_> {
    /// The whole chain with pieces of at most `degree`, and the sample at which each ends.
    pub(super) fn chain(&self, degree: usize) -> Option<(Vec<Piece>, Vec<usize>)> {
        let last = self.x.len() - 1;
        let mut links: Vec<Link> = Vec::new();
        let mut from = 0;
        while from < last {
            if self.cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed)) {
                return None;
            }
            let limit = (from + 1..last).find(|i| self.corner[*i]).unwrap_or(last);
            let link = if links.is_empty() {
                self.reach(from, limit, if self.odd { Left::Mirror } else { Left::Free }, degree)?
            } else if self.corner[from] {
                self.reach(from, limit, Left::Free, degree)?
            } else {
                self.continued(&mut links, from, limit, degree)?
            };
            from = link.end;
            links.push(link);
        }
        Some(links.into_iter().map(|link| (link.piece, link.end)).unzip())
    }

    /// The piece after the last of `links`, with the same slope at the break if at all possible.
    ///
    /// The end of a least-squares piece has the least certain slope of all. Where keeping it stops the next
    /// piece from reaching half as far as it could, both are asked to meet at a better one: the free piece's,
    /// the neighbouring samples', their mean. Where none suits both sides the slope is kept, whatever that
    /// costs in pieces: data that are merely coarse or rough have no corners.
    fn continued(&self, links: &mut [Link], from: usize, limit: usize, degree: usize) -> Option<Link> {
        let before = links.last_mut()?;
        let slope = before.piece.stiffness(self.x[from]);
        let kept = self.reach(from, limit, Left::Slope(slope), degree);
        if kept.as_ref().is_some_and(|link| link.end == limit) {
            return kept;
        }
        let free = self.reach(from, limit, Left::Free, degree)?;
        let far_enough = |link: &Link| 2 * (link.end - from) >= free.end - from;
        if kept.as_ref().is_some_and(far_enough) {
            return kept;
        }
        let own = free.piece.stiffness(self.x[from]);
        let local = self.slope[from];
        for slope in [own, 0.5 * (own + slope), local, 0.5 * (own + local)] {
            // The condition takes up a term (two degrees of an odd piece); it may have it back.
            let room = degree + if matches!(before.left, Left::Mirror) { 2 } else { 1 };
            let Some(piece) = self.piece(before.start..from, before.left, Some(slope), room) else {
                continue;
            };
            // As it came out, not as it was asked for: the break must be smooth to rounding.
            let slope = piece.stiffness(self.x[from]);
            if let Some(link) = self.reach(from, limit, Left::Slope(slope), degree).filter(far_enough) {
                before.piece = piece;
                return Some(link);
            }
        }
        kept.or(Some(free))
    }

    /// The longest piece from sample `from` that ends at or before sample `limit`.
    ///
    /// Long pieces may succeed where short ones fail (they may have a higher degree), so the search comes
    /// from above, in steps of a seventh, and then refines between the last failure and the success.
    fn reach(&self, from: usize, limit: usize, left: Left, degree: usize) -> Option<Link> {
        let shortest = from + 1;
        let (mut end, mut failed) = (limit, limit + 1);
        let mut piece = loop {
            if let Some(piece) = self.piece(from..end, left, None, degree) {
                break piece;
            }
            if end <= shortest {
                return None;
            }
            failed = end;
            end = (from + (end - from) * 6 / 7).clamp(shortest, end - 1);
        };
        while failed - end > 1 {
            let middle = end + (failed - end) / 2;
            match self.piece(from..middle, left, None, degree) {
                Some(longer) => (end, piece) = (middle, longer),
                None => failed = middle,
            }
        }
        // The shortest piece, where it is all that the data allow, ends with the slope that the neighbouring
        // samples have. Left to end as it likes, a chain of such pieces would swing about the data: a
        // parabola that takes over a slope error hands it on with the sign changed.
        if end == shortest && limit > shortest {
            piece = self.piece(from..end, left, Some(self.slope[end]), degree).unwrap_or(piece);
        }
        Some(Link { start: from, end, left, piece })
    }
}

/// A piece of the chain and how it was made.
struct Link {
    start: usize,
    end: usize,
    left: Left,
    piece: Piece,
}

/// How a piece begins.
#[derive(Debug, Clone, Copy)]
pub(super) enum Left {
    /// With the slope that suits it.
    Free,
    /// With this slope in N/m.
    Slope(f64),
    /// It is the middle of an odd curve: it begins at its mirror image.
    Mirror,
}
