//! Fit of a smooth piecewise polynomial to the points of a table.
//!
//! The curve is a chain of least-squares polynomials that interpolate the samples at their ends, so that it
//! is continuous for any data. The chain is built from left to right, or for odd data from the middle
//! outwards, and each piece is as long as the tolerance allows. At a break that is not a corner of the data a
//! piece starts with the final slope of the previous piece, so that the fit adds no kinks.
//!
//! The chain is greedy because pieces that share only a sample and a slope can be tried one at a time: a
//! table of about a hundred points takes milliseconds. Optimising all breaks together would save perhaps one
//! piece in ten.
//!
//! **Degree against number of pieces.** Both slow a run: the Taylor coefficients of a piece of degree n cost
//! about n series products per step (half of that for an odd polynomial), and each crossing of a break ends a
//! step early and starts another. The chain is therefore built for several limits of the degree, and the one
//! with the lowest [`running_cost`] is kept.
//!
//! **Oscillations.** A least-squares polynomial over m roughly even intervals does not oscillate up to a
//! degree of about 2 sqrt(m) (Rakhmanov 2007, "Bounds for polynomials with a unit discrete norm"). In
//! addition every piece is compared half-way between its samples with the local interpolant through six
//! neighbours. It may differ by a few tolerances plus the difference between the interpolants through six
//! and four neighbours.

mod chain;
mod piece;

use std::sync::atomic::AtomicBool;

use super::curve::{FitReport, ForceCurve, Piece};
use super::local::{between, corners, roughness, slopes};
use super::table::ForceTable;

/// Limits of the degree that are tried. Above 13 the monomial form loses digits, and the steps cost more than
/// the restarts that longer pieces save.
const DEGREES: [usize; 5] = [5, 7, 9, 11, 13];

/// Estimated number of steps of a traversal of the whole curve without breaks; each break adds about one.
const STEPS_PER_TRAVERSAL: f64 = 20.0;

/// Estimated cost of a step apart from the force, in series products of the same order: the sine of the
/// drive, the step size and the search for events.
const OTHER_PRODUCTS: f64 = 3.0;

/// Share of the tolerance by which odd data may deviate from symmetry; the rest is left to the fit.
const ODD_SHARE: f64 = 0.5;

/// Number of pieces above which a warning is given, since each break slows a run.
const MANY_PIECES: usize = 24;

/// Fits a curve to a table.
///
/// Returns the curve with its [`FitReport`]; it is within `tolerance` times [`force_scale`] of every sample,
/// or within rounding if that is larger. Breaks lie on samples; the domain is from the first to the last
/// sample. Data that are odd to within half the tolerance give a curve that is odd bit for bit.
///
/// Preconditions: a table as [`ForceTable::parse`] guarantees it, `tolerance` above 0.
///
/// Fails only if the magnitudes leave the range of double precision; the error is a sentence.
///
/// A smaller `tolerance` gives a closer fit with more pieces, which slow every run; below the roughness of
/// the data the curve follows the roughness.
pub fn fit(table: &ForceTable, tolerance: f64) -> Result<ForceCurve, String> {
    fit_cancellable(table, tolerance, None)
}

/// Like [`fit`], but fails, with any message, soon after `cancel` is set.
pub fn fit_cancellable(
    table: &ForceTable,
    tolerance: f64,
    cancel: Option<&AtomicBool>,
) -> Result<ForceCurve, String> {
    let scale = force_scale(table);
    let allowed = vec![allowed_error(table, tolerance); table.x.len()];
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
    let (worst_at_m, samples) = (Some(worst_at_m), Some(table.x.len()));
    let report = FitReport { worst_n, worst_at_m, scale_n: scale, samples, warnings };
    Ok(curve.with_fit(report))
}

/// Allowed error in N at the samples of a table: `tolerance` times [`force_scale`] plus a few
/// units of rounding.
pub(super) fn allowed_error(table: &ForceTable, tolerance: f64) -> f64 {
    tolerance * force_scale(table) + 8.0 * f64::EPSILON * largest(&table.force)
}

/// Fits a curve, without a report, that differs from each sample of a table by at most the `allowed` error in
/// N, using the limit among `degrees` with the lowest running cost. Fails like [`fit_cancellable`].
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
        if best.as_ref().is_none_or(|(lowest, ..)| cost < *lowest) {
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
/// This is the largest |F| between the outermost stable equilibria of the samples (where the force changes
/// from below to above 0), which does not depend on a steep wall outside the wells. If there are fewer than
/// two such equilibria, or the force between them is less than ten times the roughness of the data (noise
/// about 0 looks like wells), it is the largest |F| of all samples.
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
    values.iter().fold(0.0, |largest, v| largest.max(v.abs()))
}

/// Largest distance of a curve from the samples in N, and its position.
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

/// Cost of a traversal of the whole curve in series products; see the module's documentation.
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
    products * (STEPS_PER_TRAVERSAL + breaks as f64)
}

/// The samples that the chain is built from: all of them, or the right half of odd data.
struct Samples<'a> {
    /// Building the chain stops without a result if another thread sets this.
    cancel: Option<&'a AtomicBool>,
    x: Vec<f64>,
    force: Vec<f64>,
    /// Allowed error of the curve at each sample in N.
    allowed: Vec<f64>,
    /// Whether the slope jumps at each sample.
    corner: Vec<bool>,
    /// Slope in N/m at each sample, from its neighbours up to the next corner.
    slope: Vec<f64>,
    /// Force half-way from each sample to the next by local interpolation, and the allowed error there.
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
        // The right half, starting at 0 whether or not there is a sample.
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
        // If 0 is not a sample, there is nothing to compare with between 0 and the first sample.
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

    /// The curve from the pieces of the chain, mirrored bit for bit if the data are odd.
    fn assemble(&self, pieces: Vec<Piece>, ends: &[usize]) -> ForceCurve {
        let last = self.x[self.x.len() - 1];
        let right: Vec<f64> = ends[..ends.len() - 1].iter().map(|i| self.x[*i]).collect();
        if !self.odd {
            return ForceCurve::joined(pieces, right, (self.x[0], last), false, None);
        }
        ForceCurve::odd(pieces, &right, last)
    }
}
