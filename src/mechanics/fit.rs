//! Smooth piecewise polynomial through the points of a table.
//!
//! The curve is a chain of least-squares polynomials that interpolate the samples at their ends (so it
//! is continuous whatever the data), found from left to right, or for odd data from the middle outwards: each
//! piece reaches as far as the tolerance allows. At a break that is not a corner of the data a piece
//! begins with the slope with which the one before it ended, so that the curve has no kinks of its own.
//!
//! Why a greedy chain: pieces that share nothing but a sample and a slope can be tried one at a time, so
//! that a table of some hundred points takes milliseconds; shifting all breaks at once would save
//! perhaps one piece in ten.
//!
//! **Degree against number of pieces.** A run pays for both: the Taylor coefficients of a piece of
//! degree n cost about n series products a step (an odd polynomial half of that), and each crossing of a
//! break ends a step early and starts another. The chain is therefore made for several limits of the degree
//! and the cheapest by [`running_cost`] is kept.
//!
//! **No wiggles.** A least-squares polynomial over m roughly even intervals is tame up to a degree of about 2
//! sqrt(m) (Rakhmanov 2007, "Bounds for polynomials with a unit discrete norm"). Rather than trust this
//! alone, every piece is compared half-way between its samples with the local interpolant through six
//! neighbours; it may be off by a few times the tolerance and by what six neighbours say that four do not.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use super::curve::{FitReport, ForceCurve, Piece};
use super::local::{between, corners, roughness, slopes};
use super::table::ForceTable;
use crate::numeric::fit::lowest_degree;

/// The limits of the degree that are tried. Above 13 the monomial form begins to lose digits and a
/// step costs more than the restart that a longer piece saves.
const DEGREES: [usize; 5] = [5, 7, 9, 11, 13];

/// Steps that a swing through the whole curve is taken to need when no break is in the way; a break adds
/// about one. An estimate, not measured.
const STEPS_OF_A_SWING: f64 = 20.0;

/// What a step costs beside the force, in series products of the same order: the drive's sine, the step size,
/// the looking for events. An estimate as well.
const OTHER_PRODUCTS: f64 = 3.0;

/// Share of the tolerance that the two halves of odd data may differ by; the rest is left to the fit.
const ODD_SHARE: f64 = 0.5;

/// Least squares use at most this many samples of a piece, evenly picked; all are checked. More would
/// average noise better, at a cost that grows with the table.
const MOST_SAMPLES_OF_A_FIT: usize = 256;

/// More breaks than this draw a warning: a run pays for each.
const MANY_PIECES: usize = 24;

/// Fits a curve to a table.
///
/// Returns the curve with its [`FitReport`]; every sample is met within `tolerance` times [`force_scale`], or
/// to rounding where that is larger. Breaks lie on samples; the domain is the first to the last sample. Data
/// that are odd within half the tolerance give a curve that is odd bit for bit.
///
/// Preconditions: a table as [`ForceTable::parse`] guarantees it, `tolerance` above 0.
///
/// Fails only where the magnitudes leave the range of double precision; says so in a sentence.
///
/// `tolerance` trades pieces (and so the speed of every run) for closeness; below the roughness of the
/// data it makes the curve follow the roughness.
pub fn fit(table: &ForceTable, tolerance: f64) -> Result<ForceCurve, String> {
    fit_unless(table, tolerance, None)
}

/// As [`fit`]; once `cancel` is set, it soon fails with any sentence.
pub fn fit_unless(
    table: &ForceTable,
    tolerance: f64,
    cancel: Option<&AtomicBool>,
) -> Result<ForceCurve, String> {
    let scale = force_scale(table);
    let largest = largest(&table.force);
    let allowed = tolerance * scale + 8.0 * f64::EPSILON * largest;
    let samples = Samples { cancel, ..Samples::new(table, allowed) };
    let mut best: Option<(f64, Vec<Piece>, Vec<usize>)> = None;
    for degree in DEGREES {
        let Some((pieces, ends)) = samples.chain(degree) else { continue };
        let cost = running_cost(&samples, &pieces, &ends);
        if best.as_ref().is_none_or(|(least, ..)| cost < *least) {
            best = Some((cost, pieces, ends));
        }
    }
    let curve = best
        .map(|(_, pieces, ends)| samples.assemble(pieces, &ends))
        .filter(|curve| curve.pieces().iter().all(|p| p.potential_at_origin.is_finite()))
        .ok_or_else(|| {
            "has numbers so large or small, or positions so close together, that no curve through them can \
             be computed in double precision"
                .to_owned()
        })?;
    let mut warnings = table.warnings();
    if curve.pieces().len() > MANY_PIECES {
        warnings.push(format!(
            "following the table to {tolerance:e} of {scale:.3e} N takes {} pieces, which slows every run: \
             if its roughness is noise, raise the tolerance",
            curve.pieces().len()
        ));
    }
    let (worst_n, worst_at_m) = worst(&curve, table);
    let report = FitReport { worst_n, worst_at_m, scale_n: scale, samples: table.x.len(), warnings };
    Ok(curve.with_fit(report))
}

/// The force in N that the tolerance is relative to.
///
/// The largest |F| between the outermost stable equilibria of the samples (where the force changes from below
/// to above 0), which a wall outside the wells does not touch. Where there are not two of them, or the force
/// between them does not stand out ten-fold from the roughness of the data (noise about 0 makes "wells" of
/// its own): the largest |F| of all.
pub fn force_scale(table: &ForceTable) -> f64 {
    let force = &table.force;
    let rising = |i: &usize| force[*i] < 0.0 && force[*i + 1] >= 0.0;
    let wells = 0..force.len() - 1;
    if let (Some(first), Some(last)) = (wells.clone().find(rising), wells.rev().find(rising))
        && first < last
    {
        let between = largest(&force[first + 1..=last]);
        if between > 10.0 * roughness(table) {
            return between;
        }
    }
    largest(force)
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, v| most.max(v.abs()))
}

/// Largest distance of a curve from the samples in N, and where.
fn worst(curve: &ForceCurve, table: &ForceTable) -> (f64, f64) {
    let (low, high) = curve.domain();
    let mut worst = (0.0, table.x[0]);
    for (x, force) in table.x.iter().zip(&table.force) {
        let error = (curve.force(x.clamp(low, high)) - force).abs();
        if error > worst.0 {
            worst = (error, *x);
        }
    }
    worst
}

/// What a swing through the whole curve costs, in series products: see the module's head.
fn running_cost(samples: &Samples, pieces: &[Piece], ends: &[usize]) -> f64 {
    let (from, to) = (samples.x[0], samples.x[samples.x.len() - 1]);
    let (mut left, mut products) = (if samples.odd { 0.0 } else { from }, 0.0);
    let whole = to - left;
    for (piece, end) in pieces.iter().zip(ends) {
        let terms = piece.coefficients.iter().skip(1).filter(|c| **c != 0.0).count();
        products += (OTHER_PRODUCTS + terms as f64) * (samples.x[*end] - left) / whole;
        left = samples.x[*end];
    }
    let breaks = (pieces.len() - 1) * if samples.odd { 2 } else { 1 };
    products * (STEPS_OF_A_SWING + breaks as f64)
}

/// The samples as the chain sees them: all of them, or the right half of odd data.
struct Samples<'a> {
    /// Set from elsewhere to end it: there is then no chain.
    cancel: Option<&'a AtomicBool>,
    x: Vec<f64>,
    force: Vec<f64>,
    /// How far the curve may be from `force` at each sample in N.
    allowed: Vec<f64>,
    /// Whether the slope jumps at each sample.
    corner: Vec<bool>,
    /// Slope at each sample in N/m, as its neighbours up to the next corner have it.
    slope: Vec<f64>,
    /// Force half-way from each sample to the next by local interpolation, and how far the curve may be from
    /// it.
    between: Vec<(f64, f64)>,
    odd: bool,
}

impl Samples<'_> {
    fn new(table: &ForceTable, allowed: f64) -> Self {
        let n = table.x.len();
        let mirror = |i: usize| n - 1 - i;
        let reach = largest(&table.x);
        let odd = (0..n).all(|i| {
            (table.x[i] + table.x[mirror(i)]).abs() <= 1e-12 * reach
                && (table.force[i] + table.force[mirror(i)]).abs() <= 2.0 * ODD_SHARE * allowed
        });
        let mut corner = corners(&table.x, &table.force, allowed);
        if odd {
            corner = (0..n).map(|i| corner[i] || corner[mirror(i)]).collect();
        }
        let slope = slopes(&table.x, &table.force, &corner);
        let between = between(&table.x, &table.force, &corner, allowed);
        if !odd {
            let (x, force) = (table.x.clone(), table.force.clone());
            return Self { cancel: None, x, force, allowed: vec![allowed; n], corner, slope, between, odd };
        }
        // The right half, from 0 on whether or not there is a sample.
        let mut half = Self {
            cancel: None,
            x: vec![0.0],
            force: vec![0.0],
            allowed: vec![0.0],
            corner: vec![false],
            slope: vec![0.0],
            between: Vec::new(),
            odd,
        };
        // Between 0 and the first sample there is nothing to compare with where 0 is no sample itself.
        half.between.push(if n % 2 == 1 { between[n / 2] } else { (0.0, f64::INFINITY) });
        for i in n.div_ceil(2)..n {
            let j = mirror(i);
            half.x.push(table.x[i]);
            half.force.push(0.5 * (table.force[i] - table.force[j]));
            half.allowed.push(allowed - 0.5 * (table.force[i] + table.force[j]).abs());
            half.corner.push(corner[i]);
            half.slope.push(0.5 * (slope[i] + slope[j]));
            if i + 1 < n {
                half.between.push(between[i]);
            }
        }
        half
    }

    /// The whole chain with pieces of at most `degree`, and the sample at which each ends.
    fn chain(&self, degree: usize) -> Option<(Vec<Piece>, Vec<usize>)> {
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

    /// The piece of lowest degree from sample `span.start` to sample `span.end`, both interpolated, that
    /// meets all between (and ends with the slope `right`); none where the limit of the degree is too low or
    /// something overflows.
    fn piece(&self, span: Range<usize>, left: Left, right: Option<f64>, degree: usize) -> Option<Piece> {
        let odd = matches!(left, Left::Mirror);
        let Frame { origin, half, base, shape } = self.frame(&span, left, right);
        let intervals = span.len() * if odd { 2 } else { 1 };
        let inner = span.start + 1..span.end;
        let room = degree.min(1 + (3.0 * (intervals as f64).sqrt()) as usize);
        let room = (room + 1).saturating_sub(base.len()).min(ForceCurve::MAX_COEFFICIENTS - base.len());
        let terms = (room / if odd { 2 } else { 1 }).min(inner.len());
        let stride = inner.len().div_ceil(MOST_SAMPLES_OF_A_FIT).max(1);
        let (mut points, mut weights, mut values) = (Vec::new(), Vec::new(), Vec::new());
        for i in inner.clone().step_by(stride) {
            let t = (self.x[i] - origin) / half;
            points.push(if odd { 2.0 * t * t - 1.0 } else { t });
            weights.push(value(&shape, t));
            values.push(self.force[i] - value(&base, t));
        }
        let meets =
            |piece: &Piece, i: usize| (piece.force(self.x[i]) - self.force[i]).abs() <= self.allowed[i];
        let follows = |piece: &Piece, i: usize| {
            let (force, allowed) = self.between[i];
            (piece.force(0.5 * (self.x[i] + self.x[i + 1])) - force).abs() <= allowed
        };
        let mut accepted = None;
        lowest_degree(&points, &weights, &values, terms, |q| {
            let local = combine(&base, &shape, q, odd);
            let piece = self.in_metres(&local, origin, half, &span, left);
            // The picked samples first: most trials end there. A single interval is accepted whatever the
            // curve does between its ends, so that there is a chain; but over an interval a million times
            // longer than the one before it, a slope that is kept drowns the ends themselves in rounding.
            let good = inner.clone().step_by(stride).all(|i| meets(&piece, i))
                && [span.start, span.end].iter().all(|i| meets(&piece, *i))
                && (stride == 1 || inner.clone().all(|i| meets(&piece, i)))
                && (span.len() == 1 || span.clone().all(|i| follows(&piece, i)))
                && piece.coefficients.iter().all(|c| c.is_finite());
            if good {
                accepted = Some(piece);
            }
            good
        });
        accepted
    }

    fn frame(&self, span: &Range<usize>, left: Left, right: Option<f64>) -> Frame {
        let (a, b) = (self.x[span.start], self.x[span.end]);
        let (force_a, force_b) = (self.force[span.start], self.force[span.end]);
        let (origin, half) = match left {
            Left::Mirror => (0.0, b),
            _ => (0.5 * a + 0.5 * b, 0.5 * (b - a)),
        };
        let (mean, difference) = (0.5 * (force_a + force_b), 0.5 * (force_b - force_a));
        let (mut base, mut shape) = match left {
            Left::Free => (vec![mean, difference], vec![1.0, 0.0, -1.0]),
            Left::Slope(slope) => {
                let bend = 0.5 * (difference - slope * half);
                (vec![mean - bend, difference, bend], vec![1.0, 1.0, -1.0, -1.0])
            }
            Left::Mirror => (vec![0.0, force_b], vec![0.0, 1.0, 0.0, -1.0]),
        };
        if let Some(slope) = right {
            let at_end = |c: &[f64]| c.iter().enumerate().map(|(i, c)| i as f64 * c).sum::<f64>();
            let share = (slope * half - at_end(&base)) / at_end(&shape);
            let odd = matches!(left, Left::Mirror);
            base = combine(&base, &shape, &[share], odd);
            shape = product(&shape, if odd { &[1.0, 0.0, -1.0] } else { &[1.0, -1.0] });
        }
        Frame { origin, half, base, shape }
    }

    /// From the local variable to metres, with the ends met to rounding.
    fn in_metres(&self, local: &[f64], origin: f64, half: f64, span: &Range<usize>, left: Left) -> Piece {
        let mut coefficients = Vec::with_capacity(local.len());
        let mut unit = 1.0;
        for c in local {
            coefficients.push(c / unit);
            unit *= half;
        }
        let mut piece = Piece { origin, coefficients, potential_at_origin: 0.0 };
        let (a, b) = (self.x[span.start], self.x[span.end]);
        for _ in 0..2 {
            let at_b = self.force[span.end] - piece.force(b);
            match left {
                Left::Mirror => piece.coefficients[1] += at_b / b,
                _ => {
                    let at_a = self.force[span.start] - piece.force(a);
                    piece.coefficients[0] += 0.5 * (at_a + at_b);
                    piece.coefficients[1] += (at_b - at_a) / (b - a);
                }
            }
        }
        piece
    }

    /// The curve of the chain's pieces, mirrored bit for bit where the data are odd.
    fn assemble(&self, pieces: Vec<Piece>, ends: &[usize]) -> ForceCurve {
        let last = self.x[self.x.len() - 1];
        let right: Vec<f64> = ends[..ends.len() - 1].iter().map(|i| self.x[*i]).collect();
        if !self.odd {
            return ForceCurve::from_pieces(pieces, right, (self.x[0], last), false, None);
        }
        let mut all: Vec<Piece> = pieces.iter().skip(1).rev().map(Piece::mirrored).collect();
        all.extend(pieces);
        let breaks = right.iter().rev().map(|b| -b).chain(right.iter().copied()).collect();
        ForceCurve::from_pieces(all, breaks, (-last, last), true, None)
    }
}

/// A piece as base + shape q in t = (x - origin)/half: base meets the samples at the ends (and the slope),
/// shape vanishes there. For odd data q is a polynomial in 2 t^2 - 1.
struct Frame {
    origin: f64,
    half: f64,
    base: Vec<f64>,
    shape: Vec<f64>,
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
enum Left {
    /// With the slope that suits it.
    Free,
    /// With this slope in N/m.
    Slope(f64),
    /// It is the middle of an odd curve: it begins at its mirror image.
    Mirror,
}

fn value(coefficients: &[f64], t: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

/// base + shape q in monomials of t; q is one in t, or for odd data in 2 t^2 - 1.
fn combine(base: &[f64], shape: &[f64], q: &[f64], in_squares: bool) -> Vec<f64> {
    // Horner's scheme on polynomials.
    let mut in_t: Vec<f64> = Vec::new();
    for c in q.iter().rev() {
        let factor: &[f64] = if in_squares { &[-1.0, 0.0, 2.0] } else { &[0.0, 1.0] };
        in_t = product(&in_t, factor);
        if in_t.is_empty() {
            in_t.push(0.0);
        }
        in_t[0] += c;
    }
    let mut sum = product(&in_t, shape);
    sum.resize(sum.len().max(base.len()), 0.0);
    for (s, b) in sum.iter_mut().zip(base) {
        *s += b;
    }
    if in_squares {
        sum.iter_mut().step_by(2).for_each(|even| *even = 0.0);
    }
    sum
}

fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    if a.is_empty() || b.is_empty() {
        return Vec::new();
    }
    let mut out = vec![0.0; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            out[i + j] += x * y;
        }
    }
    out
}
