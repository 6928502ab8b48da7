//! Chain of pieces through the samples, each as long as the tolerance allows.

use std::sync::atomic::Ordering;

use super::Samples;
use crate::mechanics::curve::Piece;

impl Samples<'_> {
    /// The whole chain with pieces of at most `degree`, and the sample at which each piece ends.
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
                self.longest(from, limit, if self.odd { Left::Mirror } else { Left::Free }, degree)?
            } else if self.corner[from] {
                self.longest(from, limit, Left::Free, degree)?
            } else {
                self.continued(&mut links, from, limit, degree)?
            };
            from = link.end;
            links.push(link);
        }
        Some(links.into_iter().map(|link| (link.piece, link.end)).unzip())
    }

    /// The piece after the last of `links`, with the same slope at the break if possible.
    ///
    /// The slope of a least-squares piece is least accurate at its end. If keeping that slope makes the next
    /// piece less than half as long as a free one, both pieces are tried with a better slope: that of the
    /// free piece, that of the neighbouring samples, or a mean. If no slope works for both, the original
    /// slope is kept, even if that takes more pieces, because coarse or rough data do not have corners for
    /// that reason alone.
    fn continued(&self, links: &mut [Link], from: usize, limit: usize, degree: usize) -> Option<Link> {
        let before = links.last_mut()?;
        let slope = before.piece.stiffness(self.x[from]);
        let kept = self.longest(from, limit, Left::Slope(slope), degree);
        if kept.as_ref().is_some_and(|link| link.end == limit) {
            return kept;
        }
        let free = self.longest(from, limit, Left::Free, degree)?;
        let far_enough = |link: &Link| 2 * (link.end - from) >= free.end - from;
        if kept.as_ref().is_some_and(far_enough) {
            return kept;
        }
        let free_slope = free.piece.stiffness(self.x[from]);
        let local = self.slope[from];
        for slope in [free_slope, 0.5 * (free_slope + slope), local, 0.5 * (free_slope + local)] {
            // The condition uses up a term (two degrees of an odd piece), so allow one more.
            let room = degree + if matches!(before.left, Left::Mirror) { 2 } else { 1 };
            let Some(piece) = self.piece(before.start..from, before.left, Some(slope), room) else {
                continue;
            };
            // The slope as computed rather than as prescribed: the break must be smooth to rounding.
            let slope = piece.stiffness(self.x[from]);
            if let Some(link) = self.longest(from, limit, Left::Slope(slope), degree).filter(far_enough) {
                before.piece = piece;
                return Some(link);
            }
        }
        kept.or(Some(free))
    }

    /// The longest piece from sample `from` that ends at or before sample `limit`.
    ///
    /// A long piece may succeed where a shorter one fails (it may have a higher degree), so the search
    /// shortens the piece by a seventh until it succeeds, and then bisects between the last failure
    /// and the success.
    fn longest(&self, from: usize, limit: usize, left: Left, degree: usize) -> Option<Link> {
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
        // If only the shortest piece is possible, it ends with the slope of the neighbouring samples. With a
        // free slope a chain of such pieces would oscillate about the data: a parabola passes a slope error
        // from its start to its end with the opposite sign.
        if end == shortest && limit > shortest {
            piece = self.piece(from..end, left, Some(self.slope[end]), degree).unwrap_or(piece);
        }
        Some(Link { start: from, end, left, piece })
    }
}

/// A piece of the chain with its condition at the left end.
struct Link {
    start: usize,
    end: usize,
    left: Left,
    piece: Piece,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Left {
    /// Any slope.
    Free,
    /// A prescribed slope in N/m.
    Slope(f64),
    /// The piece is odd and begins at x = 0, the middle of an odd curve.
    Mirror,
}
