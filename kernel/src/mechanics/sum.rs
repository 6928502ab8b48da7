//! Sum of force curves that act in parallel on one mass.

use super::curve::{ForceCurve, Piece};

/// Breaks closer together than this share of their distance from x = 0 are merged.
const SAME_BREAK: f64 = 8.0 * f64::EPSILON;

/// The sum of `parts` on the intersection of their domains; `None` if that is empty. Its breaks are those of
/// all parts, and each of its pieces is the sum of their polynomials.
///
/// Guarantee: exact but for rounding. Polynomials about the same origin are added coefficient by coefficient;
/// others are first expanded about a common origin. The sum is odd bit for bit if every part is.
///
/// Precondition: at least one curve.
pub fn sum(parts: &[&ForceCurve]) -> Option<ForceCurve> {
    let low = parts.iter().map(|part| part.domain().0).fold(f64::NEG_INFINITY, f64::max);
    let high = parts.iter().map(|part| part.domain().1).fold(f64::INFINITY, f64::min);
    if low >= high {
        return None;
    }
    let odd = parts.iter().all(|part| part.is_odd());
    let inside = |x: &f64| *x > low && *x < high;
    let mut breaks: Vec<f64> = parts.iter().flat_map(|part| part.breaks()).copied().filter(inside).collect();
    breaks.sort_by(f64::total_cmp);
    breaks.dedup_by(|next, kept| *next - *kept <= SAME_BREAK * kept.abs());
    if !odd {
        let ends: Vec<f64> = [&[low], &breaks[..], &[high]].concat();
        let pieces = ends.windows(2).map(|pair| piece(parts, pair[0], pair[1])).collect();
        return Some(ForceCurve::from_pieces(pieces, breaks, (low, high), false, None));
    }
    let in_middle = breaks.contains(&0.0);
    let right: Vec<f64> = breaks.into_iter().filter(|x| *x > 0.0).collect();
    let first = if in_middle { 0.0 } else { -right.first().copied().unwrap_or(high) };
    let ends: Vec<f64> = [&[first], &right[..], &[high]].concat();
    let half = ends.windows(2).map(|pair| piece(parts, pair[0], pair[1])).collect();
    Some(ForceCurve::odd(half, &ends[usize::from(!in_middle)..ends.len() - 1], high))
}

/// The sum from `left` to `right`, an interval without a break of any part.
fn piece(parts: &[&ForceCurve], left: f64, right: f64) -> Piece {
    let middle = match (left.is_finite(), right.is_finite()) {
        (true, true) => 0.5 * left + 0.5 * right,
        (true, false) => left + left.abs().max(1.0),
        (false, true) => right - right.abs().max(1.0),
        (false, false) => 0.0,
    };
    let pieces: Vec<&Piece> = parts.iter().map(|part| &part.pieces()[part.piece_index(middle)]).collect();
    // A line can be written about any origin to rounding; a curved piece loses digits far from its own.
    let mut curved = pieces.iter().filter(|piece| piece.coefficients.len() > 2);
    let origin = match curved.next() {
        None => pieces[0].origin,
        Some(first) if curved.all(|piece| piece.origin == first.origin) => first.origin,
        Some(_) => middle,
    };
    let mut coefficients = vec![0.0];
    for piece in pieces {
        let moved = shifted_to(piece, origin);
        coefficients.resize(coefficients.len().max(moved.len()), 0.0);
        coefficients.iter_mut().zip(moved).for_each(|(sum, c)| *sum += c);
    }
    let keep = coefficients.iter().rposition(|c| *c != 0.0).map_or(1, |i| i + 1);
    coefficients.truncate(keep);
    Piece::new(origin, coefficients)
}

/// The coefficients of a piece expanded about another origin, by synthetic division.
fn shifted_to(piece: &Piece, origin: f64) -> Vec<f64> {
    let mut shifted = piece.coefficients.clone();
    let step = origin - piece.origin;
    if step != 0.0 {
        for i in 0..shifted.len().saturating_sub(1) {
            for j in (i..shifted.len() - 1).rev() {
                shifted[j] += step * shifted[j + 1];
            }
        }
    }
    shifted
}
