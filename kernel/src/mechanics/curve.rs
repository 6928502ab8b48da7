//! Restoring force as a piecewise polynomial, the common representation of every mechanism, and the sum of
//! several.
//!
//! Each piece between two breaks is a polynomial about its own origin. Potential and stiffness follow
//! exactly, by integration and differentiation of the same coefficients. During a run the piece is a *mode*
//! of the motion: it changes only at a located crossing of a break and is never looked up by x, because
//! rounding could put x on the wrong side of the break.

use crate::numeric::shift;

/// One polynomial piece: `F(x) = sum coefficients[i] (x - origin)^i`. [`ForceCurve::from_pieces`] joins
/// several.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// Origin of the local coordinate in m.
    pub origin: f64,
    /// Force coefficients from the constant up, in N/m^i; never empty.
    pub coefficients: Vec<f64>,
    /// Potential at the origin in J, so that the potential is continuous and 0 at x = 0.
    pub potential_at_origin: f64,
}

impl Piece {
    /// A piece whose potential is not yet known; [`ForceCurve::from_pieces`] sets it.
    pub(super) fn new(origin: f64, coefficients: Vec<f64>) -> Self {
        Self { origin, coefficients, potential_at_origin: 0.0 }
    }

    /// Force dV/dx at `x` in N (the force that holds the mass there).
    pub fn force(&self, x: f64) -> f64 {
        let y = x - self.origin;
        self.coefficients.iter().rev().fold(0.0, |sum, c| sum * y + c)
    }

    /// Stiffness dF/dx at `x` in N/m.
    pub fn stiffness(&self, x: f64) -> f64 {
        let y = x - self.origin;
        let mut sum = 0.0;
        for (i, c) in self.coefficients.iter().enumerate().skip(1).rev() {
            sum = sum * y + c * i as f64;
        }
        sum
    }

    /// Potential at `x` in J.
    pub fn potential(&self, x: f64) -> f64 {
        let y = x - self.origin;
        let mut sum = 0.0;
        for (i, c) in self.coefficients.iter().enumerate().rev() {
            sum = sum * y + c / (i + 1) as f64;
        }
        self.potential_at_origin + sum * y
    }

    /// Potential at `b` less that at `a`, in J. It is computed as a divided difference times `b - a`, so that
    /// a small change far from the origin has as many correct digits as the force there, and the change is
    /// exactly 0 if `a` and `b` are equal.
    pub fn potential_change(&self, a: f64, b: f64) -> f64 {
        let (from, to) = (a - self.origin, b - self.origin);
        let (mut value, mut slope) = (0.0, 0.0);
        for (i, c) in self.coefficients.iter().enumerate().rev() {
            slope = slope * to + value;
            value = value * from + c / (i + 1) as f64;
        }
        // the potential is `value` times the local coordinate
        slope = slope * to + value;
        if a == b { 0.0 } else { slope * (b - a) }
    }

    /// The piece of -F(-x): the mirror image of this one in an odd curve, bit for bit.
    pub fn mirrored(&self) -> Self {
        let sign = |i: usize| if i.is_multiple_of(2) { -1.0 } else { 1.0 };
        Self {
            origin: -self.origin,
            coefficients: self.coefficients.iter().enumerate().map(|(i, c)| sign(i) * c).collect(),
            potential_at_origin: self.potential_at_origin,
        }
    }
}

/// How well a fitted curve follows its data.
///
/// [`ForceCurve::fit`] gives it for a curve of a table, a function, samples or magnets. For flexures see
/// [`Flexures::accuracy`](super::Flexures::accuracy).
#[derive(Debug, Clone, PartialEq)]
pub struct FitReport {
    /// Largest |fit - data| over the samples in N.
    pub worst_n: f64,
    /// Position of that sample in m, if it is known.
    pub worst_at_m: Option<f64>,
    /// The force that the tolerance is relative to, in N.
    pub scale_n: f64,
    /// Number of samples, if it is known.
    pub samples: Option<usize>,
    /// Warnings for the user, each a sentence.
    pub warnings: Vec<String>,
}

/// The restoring force of a mechanism as a piecewise polynomial.
///
/// Force in N, potential in J (0 at x = 0) and stiffness in N/m are exact derivatives of each other at every
/// displacement in m. The pieces meet at breaks, where smoothness ends; a curve of a table or a function ends
/// at its [`domain`](Self::domain), and a run ends where the mass leaves that. [`fit`](Self::fit) says how
/// well it follows what it was made of.
///
/// ```
/// # use interwell_kernel as interwell;
/// use interwell::mechanics::ForceCurve;
///
/// // F = -40 x + 8e5 x^3: wells at sqrt(40 / 8e5) m
/// let curve = ForceCurve::polynomial(&[0.0, -40.0, 0.0, 8e5]);
/// let well = (40.0_f64 / 8e5).sqrt();
/// assert!(curve.force(well).abs() < 1e-15);
/// assert!((curve.stiffness(well) - 80.0).abs() < 1e-9);
/// assert!((curve.potential(well) + 40.0 * well.powi(2) / 4.0).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ForceCurve {
    pieces: Vec<Piece>,
    breaks: Vec<f64>,
    domain: (f64, f64),
    odd: bool,
    fit: Option<FitReport>,
}

impl ForceCurve {
    /// The largest number of coefficients that a piece may have.
    pub const MAX_COEFFICIENTS: usize = 16;

    /// One polynomial on the whole line: `F(x) = sum coefficients[i] x^i`. Trailing zeros are dropped.
    ///
    /// Preconditions: finite coefficients, at most [`Self::MAX_COEFFICIENTS`] after trimming.
    pub fn polynomial(coefficients: &[f64]) -> Self {
        let keep = coefficients.iter().rposition(|c| *c != 0.0).map_or(1, |i| i + 1);
        let mut coefficients: Vec<f64> = coefficients.iter().take(keep).copied().collect();
        if coefficients.is_empty() {
            coefficients.push(0.0);
        }
        let odd = coefficients.iter().step_by(2).all(|c| *c == 0.0);
        Self {
            pieces: vec![Piece::new(0.0, coefficients)],
            breaks: Vec::new(),
            domain: (f64::NEG_INFINITY, f64::INFINITY),
            odd,
            fit: None,
        }
    }

    /// Like [`from_pieces`](Self::from_pieces), for pieces that are known to fit.
    pub(super) fn joined(
        mut pieces: Vec<Piece>,
        breaks: Vec<f64>,
        domain: (f64, f64),
        odd: bool,
        fit: Option<FitReport>,
    ) -> Self {
        let zero = 0.0_f64.clamp(domain.0, domain.1);
        let middle = breaks.partition_point(|b| *b < zero);
        let level_at = |piece: &mut Piece, x: f64, level: f64| {
            piece.potential_at_origin = 0.0;
            piece.potential_at_origin = level - piece.potential(x);
        };
        pieces[middle].potential_at_origin = 0.0;
        pieces[middle].potential_at_origin = -pieces[middle].potential(zero);
        for i in middle + 1..pieces.len() {
            let level = pieces[i - 1].potential(breaks[i - 1]);
            level_at(&mut pieces[i], breaks[i - 1], level);
        }
        for i in (0..middle).rev() {
            let level = pieces[i + 1].potential(breaks[i]);
            level_at(&mut pieces[i], breaks[i], level);
        }
        Self { pieces, breaks, domain, odd, fit }
    }

    /// The odd curve from -`end` to `end` with these pieces and breaks at x >= 0. Without a break at 0 the
    /// first piece is odd and reaches to both sides of it.
    pub(super) fn odd(right: Vec<Piece>, breaks: &[f64], end: f64) -> Self {
        let in_middle = breaks.first() == Some(&0.0);
        let left = right.iter().skip(usize::from(!in_middle)).rev().map(Piece::mirrored);
        let pieces = left.chain(right.iter().cloned()).collect();
        let left = breaks.iter().skip(usize::from(in_middle)).rev().map(|x| -x);
        let breaks = left.chain(breaks.iter().copied()).collect();
        Self::joined(pieces, breaks, (-end, end), true, None)
    }

    /// The same curve with a report of how well it follows its data.
    pub fn with_fit(mut self, report: FitReport) -> Self {
        self.fit = Some(report);
        self
    }

    /// The highest degree of any piece.
    pub fn max_degree(&self) -> usize {
        self.pieces.iter().map(|p| p.coefficients.len() - 1).max().unwrap_or(0)
    }

    /// The pieces from left to right.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// The positions in m where one piece ends and the next begins.
    pub fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    /// The interval in m on which the curve is known; infinite ends for a polynomial.
    pub fn domain(&self) -> (f64, f64) {
        self.domain
    }

    /// Ends in m of piece `index`.
    pub fn piece_interval(&self, index: usize) -> (f64, f64) {
        let left = if index == 0 { self.domain.0 } else { self.breaks[index - 1] };
        let right = self.breaks.get(index).copied().unwrap_or(self.domain.1);
        (left, right)
    }

    /// Whether F(-x) = -F(x) bit for bit.
    pub fn is_odd(&self) -> bool {
        self.odd
    }

    /// How well the curve follows its data, if it was fitted.
    pub fn fit(&self) -> Option<&FitReport> {
        self.fit.as_ref()
    }

    /// Index of the piece that contains `x`; on a break, the one towards x = 0.
    pub fn piece_index(&self, x: f64) -> usize {
        if x >= 0.0 {
            self.breaks.partition_point(|b| *b < x)
        } else {
            self.breaks.partition_point(|b| *b <= x)
        }
    }

    /// Index of the piece that contains `x`; on a break, the one to its right or left.
    pub(crate) fn piece_beside(&self, x: f64, right: bool) -> usize {
        self.breaks.partition_point(|b| *b < x || (right && *b == x))
    }

    /// Force dV/dx at `x` in N, for `x` in m inside the domain; beyond it, NaN.
    pub fn force(&self, x: f64) -> f64 {
        self.inside(x).map_or(f64::NAN, |p| p.force(x))
    }

    /// Potential at `x` in J; beyond the domain, NaN.
    pub fn potential(&self, x: f64) -> f64 {
        self.inside(x).map_or(f64::NAN, |p| p.potential(x))
    }

    /// Potential at `b` less that at `a`, in J, both in m inside the domain, summed over the pieces between
    /// them; as accurate as [`Piece::potential_change`].
    pub fn potential_change(&self, a: f64, b: f64) -> f64 {
        if a > b {
            return -self.potential_change(b, a);
        }
        let (first, last) = (self.piece_index(a), self.piece_index(b));
        let change = |i: usize| {
            let (left, right) = self.piece_interval(i);
            let from = if i == first { a } else { left };
            self.pieces[i].potential_change(from, if i == last { b } else { right })
        };
        (first..=last).map(change).sum()
    }

    /// Stiffness at `x` in N/m; on a break that of the piece towards x = 0; beyond the domain, NaN.
    pub fn stiffness(&self, x: f64) -> f64 {
        self.inside(x).map_or(f64::NAN, |p| p.stiffness(x))
    }

    /// Stiffness in N/m just left and just right of `x`; NaN on a side that is outside the domain.
    pub fn stiffness_on_both_sides(&self, x: f64) -> (f64, f64) {
        let left = self.breaks.partition_point(|b| *b < x);
        let right = self.breaks.partition_point(|b| *b <= x);
        let at = |i: usize, inside: bool| if inside { self.pieces[i].stiffness(x) } else { f64::NAN };
        (at(left, x > self.domain.0), at(right, x < self.domain.1))
    }

    fn inside(&self, x: f64) -> Option<&Piece> {
        (x >= self.domain.0 && x <= self.domain.1).then(|| &self.pieces[self.piece_index(x)])
    }
}

/// Breaks closer together than this share of their distance from x = 0 are merged.
const SAME_BREAK: f64 = 8.0 * f64::EPSILON;

/// The sum of `parts` on the intersection of their domains; `None` if that is empty. Its breaks are those of
/// all parts, and each of its pieces is the sum of their polynomials.
///
/// Guarantee: exact up to rounding. Polynomials about the same origin are added coefficient by coefficient;
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
        let pieces = ends.windows(2).map(|pair| piece_of_sum(parts, pair[0], pair[1])).collect();
        return Some(ForceCurve::joined(pieces, breaks, (low, high), false, None));
    }
    let in_middle = breaks.contains(&0.0);
    let right: Vec<f64> = breaks.into_iter().filter(|x| *x > 0.0).collect();
    let first = if in_middle { 0.0 } else { -right.first().copied().unwrap_or(high) };
    let ends: Vec<f64> = [&[first], &right[..], &[high]].concat();
    let half = ends.windows(2).map(|pair| piece_of_sum(parts, pair[0], pair[1])).collect();
    Some(ForceCurve::odd(half, &ends[usize::from(!in_middle)..ends.len() - 1], high))
}

/// The sum from `left` to `right`, an interval without a break of any part.
fn piece_of_sum(parts: &[&ForceCurve], left: f64, right: f64) -> Piece {
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
        let mut moved = piece.coefficients.clone();
        if origin != piece.origin {
            shift(&mut moved, origin - piece.origin);
        }
        coefficients.resize(coefficients.len().max(moved.len()), 0.0);
        coefficients.iter_mut().zip(moved).for_each(|(sum, c)| *sum += c);
    }
    let keep = coefficients.iter().rposition(|c| *c != 0.0).map_or(1, |i| i + 1);
    coefficients.truncate(keep);
    Piece::new(origin, coefficients)
}
