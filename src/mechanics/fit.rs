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

mod chain;
mod piece;

use std::sync::atomic::AtomicBool;

use super::curve::{FitReport, ForceCurve, Piece};
use super::local::{between, corners, roughness, slopes};
use super::table::ForceTable;

/// The limits of the degree that are tried. Above 13 the monomial form begins to lose digits and a
/// step costs more than the restart that a longer piece saves.
const DEGREES: [usize; 5] = [5, 7, 9, 11, 13];

/// Steps that a traversal of the whole curve is taken to need when no break is in the way; a break adds
/// about one. An estimate, not measured.
const STEPS_OF_A_TRAVERSAL: f64 = 20.0;

/// What a step costs beside the force, in series products of the same order: the drive's sine, the step size,
/// the looking for events. An estimate as well.
const OTHER_PRODUCTS: f64 = 3.0;

/// Share of the tolerance that the two halves of odd data may differ by; the rest is left to the fit.
const ODD_SHARE: f64 = 0.5;

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
    let allowed = vec![within(table, tolerance); table.x.len()];
    let curve = fit_within(table, &allowed, &DEGREES, cancel)?;
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

/// How far in N a curve may be from the samples of a table with this tolerance: it times [`force_scale`], or
/// some roundings.
pub(super) fn within(table: &ForceTable, tolerance: f64) -> f64 {
    tolerance * force_scale(table) + 8.0 * f64::EPSILON * largest(&table.force)
}

/// The curve, without a report, that is no farther from each sample of a table than what is `allowed` there,
/// in N, with the cheapest of these limits of the degree. Fails as [`fit_unless`] does.
pub(super) fn fit_within(
    table: &ForceTable,
    allowed: &[f64],
    degrees: &[usize],
    cancel: Option<&AtomicBool>,
) -> Result<ForceCurve, String> {
    let samples = Samples { cancel, ..Samples::new(table, allowed) };
    let mut best: Option<(f64, Vec<Piece>, Vec<usize>)> = None;
    for degree in degrees.iter().copied() {
        let Some((pieces, ends)) = samples.chain(degree) else { continue };
        let cost = running_cost(&samples, &pieces, &ends);
        if best.as_ref().is_none_or(|(least, ..)| cost < *least) {
            best = Some((cost, pieces, ends));
        }
    }
    best.map(|(_, pieces, ends)| samples.assemble(pieces, &ends))
        .filter(|curve| curve.pieces().iter().all(|p| p.potential_at_origin.is_finite()))
        .ok_or_else(|| {
            "has numbers so large or small, or positions so close together, that no curve through them can \
             be computed in double precision"
                .to_owned()
        })
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

/// What a traversal of the whole curve costs, in series products: see the module's head.
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
    products * (STEPS_OF_A_TRAVERSAL + breaks as f64)
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
    fn new(table: &ForceTable, allowed: &[f64]) -> Self {
        let n = table.x.len();
        let mirror = |i: usize| n - 1 - i;
        let reach = largest(&table.x);
        let odd = (0..n).all(|i| {
            (table.x[i] + table.x[mirror(i)]).abs() <= 1e-12 * reach
                && (table.force[i] + table.force[mirror(i)]).abs() <= 2.0 * ODD_SHARE * allowed[i]
        });
        let mut corner = corners(&table.x, &table.force, allowed);
        if odd {
            corner = (0..n).map(|i| corner[i] || corner[mirror(i)]).collect();
        }
        let slope = slopes(&table.x, &table.force, &corner);
        let between = between(&table.x, &table.force, &corner, allowed);
        if !odd {
            let (x, force) = (table.x.clone(), table.force.clone());
            return Self { cancel: None, x, force, allowed: allowed.to_vec(), corner, slope, between, odd };
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
            half.allowed.push(allowed[i] - 0.5 * (table.force[i] + table.force[j]).abs());
            half.corner.push(corner[i]);
            half.slope.push(0.5 * (slope[i] + slope[j]));
            if i + 1 < n {
                half.between.push(between[i]);
            }
        }
        half
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
