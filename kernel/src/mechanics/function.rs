//! Force curves that a program gives: made of a function, or of polynomials in a scene.

use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};

use super::curve::{FitReport, ForceCurve, Piece};
use super::fit::{fit_cancellable, force_scale};
use super::table::{ForceTable, MAX_POINTS, MIN_POINTS};
use crate::numeric::{bisect, number_text};
use crate::scene;

/// Smallest and largest tolerance of [`ForceCurve::from_fn`].
const TOLERANCES: (f64, f64) = (1e-10, 0.1);

/// Intervals between the ends of the range at first, where there are no breaks.
const INTERVALS: usize = 64;

/// Smallest number of intervals between two breaks at first.
const MIN_INTERVALS: usize = 8;

/// Comparisons with the function in each interval between samples.
const CHECKS: usize = 5;

/// Share of the tolerance that the fit may use at the samples; between them the error is a little larger.
const AT_SAMPLES: f64 = 0.5;

/// Width of an interval, relative to the range, below which a misfit is a step of the function.
const STEP_WIDTH: f64 = 1e-12;

/// Largest number of calls of the function; the fit of samples of as many intervals takes some seconds.
const MAX_CALLS: usize = 30_000;

/// Samples on each side of an interval from which a corner in it is extrapolated.
const BESIDE: usize = 4;

/// Largest error of the extrapolation, relative to the change of the force that the corner makes.
const CORNER_ERROR: f64 = 1e-3;

/// Width, relative to the range, down to which the interval around a corner is narrowed where rounding does
/// not end it earlier.
const CORNER_WIDTH: f64 = 1e-10;

/// Why a function or samples have no force curve.
///
/// It is the error of [`ForceCurve::from_fn`], [`ForceCurve::from_samples`] and [`ForceCurve::from_pieces`].
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FunctionError {
    /// The range is empty or not finite.
    #[error("the range goes from {0} to {1} m; give two finite ends, the smaller first")]
    Range(f64, f64),
    /// The tolerance is out of its range.
    #[error(
        "the tolerance is {0}; give {low:e} to {high:e}, relative to the largest force",
        low = TOLERANCES.0,
        high = TOLERANCES.1
    )]
    Tolerance(f64),
    /// A break lies outside the range.
    #[error("the break {0} m is not inside the range")]
    Break(f64),
    /// The force is not finite somewhere.
    #[error("the force at x = {at} m is {1}; it must be finite in the whole range", at = number_text(*.0))]
    NotFinite(f64, f64),
    /// The force has a step, or an infinite slope.
    #[error(
        "no curve follows the force near x = {at} m: it has a step or an infinite slope there",
        at = number_text(*.0)
    )]
    Step(f64),
    /// The allowed number of calls is not enough to follow the force.
    #[error(
        "{MAX_CALLS} values of the force are not enough to follow it near x = {at} m; give a larger \
         tolerance, all the more if the force is noisy, and the corners of the force as breaks",
        at = number_text(*.0)
    )]
    Rough(f64),
    /// Samples that are no table.
    #[error("the samples are no force curve: {0}")]
    Samples(String),
    /// The fit of the samples failed.
    #[error("the force {0}")]
    Fit(String),
    /// It was cancelled.
    #[error("cancelled")]
    Cancelled,
    /// The numbers of pieces and breaks do not fit, or the domain does not go upward.
    #[error(
        "{0} pieces have {1} breaks over {2} to {3} m; give one piece more than breaks, and the smaller end \
         first"
    )]
    Pieces(usize, usize, f64, f64),
}

impl ForceCurve {
    /// A curve of several pieces; `pieces[i]` reaches from `breaks[i - 1]` to `breaks[i]`, the outermost ones
    /// to the ends of `domain`. This sets the potentials of the pieces so that the potential is continuous
    /// and 0 at x = 0 (at the nearer end of the domain if 0 is outside).
    ///
    /// Gives [`FunctionError::Pieces`] unless there is one more piece than breaks and the domain goes upward.
    /// Preconditions: `breaks` strictly increasing inside `domain`, values continuous at the breaks; `odd`
    /// only if the pieces mirror each other bit for bit.
    pub fn from_pieces(
        pieces: Vec<Piece>,
        breaks: Vec<f64>,
        domain: (f64, f64),
        odd: bool,
        fit: Option<FitReport>,
    ) -> Result<Self, FunctionError> {
        if pieces.len() != breaks.len() + 1 || !(domain.0 < domain.1) {
            return Err(FunctionError::Pieces(pieces.len(), breaks.len(), domain.0, domain.1));
        }
        Ok(Self::joined(pieces, breaks, domain, odd, fit))
    }

    /// The curve of a function: the force in N at a position in m, over a range in m.
    ///
    /// The curve differs from the function by at most `tolerance` (1e-10 to 0.1) times the largest force
    /// between the wells. The error that was found at five places between any two samples is in
    /// [`fit`](Self::fit). Corners are found and become breaks of the curve; those that are known are better
    /// given as `breaks`, in m. A function that is odd over a symmetric range gives a curve that is odd bit
    /// for bit. The function is called at most 30 000 times.
    ///
    /// ```
    /// # use interwell_kernel as interwell;
    /// use interwell::mechanics::ForceCurve;
    ///
    /// let curve = ForceCurve::from_fn(|x| -40.0 * x + 8e5 * x.powi(3), (-9e-3, 9e-3), 1e-8, &[])?;
    /// assert!((curve.force(7e-3) - (-0.28 + 0.2744)).abs() < 1e-9);
    /// # Ok::<(), interwell::mechanics::FunctionError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`FunctionError::Range`], [`FunctionError::Tolerance`] and [`FunctionError::Break`] for these
    /// arguments, [`FunctionError::NotFinite`] and [`FunctionError::Step`] for a force that is not finite or
    /// has a step, and [`FunctionError::Rough`] if the allowed calls are not enough.
    pub fn from_fn(
        force: impl Fn(f64) -> f64,
        range: (f64, f64),
        tolerance: f64,
        breaks: &[f64],
    ) -> Result<Self, FunctionError> {
        Self::from_fn_cancellable(force, range, tolerance, breaks, &AtomicBool::new(false))
    }

    /// Like [`from_fn`](Self::from_fn), but gives [`FunctionError::Cancelled`] soon after `cancel` is set.
    pub fn from_fn_cancellable(
        force: impl Fn(f64) -> f64,
        range: (f64, f64),
        tolerance: f64,
        breaks: &[f64],
        cancel: &AtomicBool,
    ) -> Result<Self, FunctionError> {
        let (low, high) = range;
        if !(low < high && low.is_finite() && high.is_finite()) {
            return Err(FunctionError::Range(low, high));
        }
        check_tolerance(tolerance)?;
        if let Some(outside) = breaks.iter().find(|x| !(low < **x && **x < high)) {
            return Err(FunctionError::Break(*outside));
        }
        let function = Sampled { force, values: RefCell::default(), cancel };
        let mut breaks = breaks.to_vec();
        loop {
            breaks.sort_by(f64::total_cmp);
            breaks.dedup();
            match function.curve(range, tolerance, &breaks)? {
                Attempt::Curve(curve) => return Ok(curve),
                Attempt::Corners(found) => breaks.extend(mirrored(found, range)),
            }
        }
    }

    /// The curve through samples: forces in N at positions in m, at least four, in order of position. It
    /// follows them to `tolerance` (1e-10 to 0.1) times the largest force between the wells, as that of a
    /// table in a scene does. The error that was found at the samples is in [`fit`](Self::fit).
    ///
    /// # Errors
    ///
    /// [`FunctionError::Tolerance`] for the tolerance, [`FunctionError::Samples`] for samples that are no
    /// force table, [`FunctionError::Fit`] if their numbers leave the range of double precision.
    pub fn from_samples(x: &[f64], force: &[f64], tolerance: f64) -> Result<Self, FunctionError> {
        Self::from_samples_cancellable(x, force, tolerance, &AtomicBool::new(false))
    }

    /// Like [`from_samples`](Self::from_samples), but gives [`FunctionError::Cancelled`] soon after `cancel`
    /// is set.
    pub fn from_samples_cancellable(
        x: &[f64],
        force: &[f64],
        tolerance: f64,
        cancel: &AtomicBool,
    ) -> Result<Self, FunctionError> {
        check_tolerance(tolerance)?;
        let wrong = |problem: String| Err(FunctionError::Samples(problem));
        if x.len() != force.len() {
            return wrong(format!("{} positions have {} forces; give one for each", x.len(), force.len()));
        }
        if !(MIN_POINTS..=MAX_POINTS).contains(&x.len()) {
            return wrong(format!("there are {}; give {MIN_POINTS} to {MAX_POINTS}", x.len()));
        }
        if let Some(i) = (0..x.len()).find(|i| !(x[*i].is_finite() && force[*i].is_finite())) {
            return wrong(format!("number {i} is {} m, {} N; give finite numbers", x[i], force[i]));
        }
        if let Some(i) = (1..x.len()).find(|i| x[i - 1] >= x[*i]) {
            let (before, after) = (number_text(x[i - 1]), number_text(x[i]));
            return wrong(format!(
                "{after} m follows {before} m; sort them, with one force for each position"
            ));
        }
        fitted(&ForceTable { x: x.to_vec(), force: force.to_vec() }, tolerance, cancel)
    }

    /// The curve of polynomials in a scene that has passed its check.
    pub(super) fn as_written(ends: &[f64], pieces: &[scene::ForcePiece], error: f64) -> Self {
        let piece = |piece: &scene::ForcePiece| Piece::new(piece.origin_m, piece.coefficients_si.clone());
        let pieces: Vec<Piece> = pieces.iter().map(piece).collect();
        let (last, breaks) = (pieces.len(), ends[1..pieces.len()].to_vec());
        let is_odd = (0..=last).all(|i| ends[i] == -ends[last - i])
            && pieces.iter().zip(pieces.iter().rev()).all(|(left, right)| *left == right.mirrored());
        let curve = Self::joined(pieces, breaks, (ends[0], ends[last]), is_odd, None);
        if error == 0.0 {
            return curve;
        }
        let forces = ends.iter().map(|x| curve.force(*x).abs()).filter(|force| force.is_finite());
        let scale_n = forces.fold(error, f64::max);
        let report =
            FitReport { worst_n: error, worst_at_m: None, scale_n, samples: None, warnings: Vec::new() };
        curve.with_fit(report)
    }

    /// The curve as a scene writes it. A scene with it has the same curve, bit for bit.
    pub fn to_scene(&self) -> scene::Mechanism {
        let piece = |piece: &Piece| scene::ForcePiece {
            origin_m: piece.origin,
            coefficients_si: piece.coefficients.clone(),
        };
        let (low, high) = self.domain();
        scene::Mechanism::Pieces {
            ends_m: [&[low], self.breaks(), &[high]].concat(),
            pieces: self.pieces().iter().map(piece).collect(),
            error_n: self.fit().map_or(0.0, |fit| fit.worst_n),
        }
    }
}

fn fitted(table: &ForceTable, tolerance: f64, cancel: &AtomicBool) -> Result<ForceCurve, FunctionError> {
    fit_cancellable(table, tolerance, Some(cancel)).map_err(|problem| match cancel.load(Ordering::Relaxed) {
        true => FunctionError::Cancelled,
        false => FunctionError::Fit(problem),
    })
}

fn check_tolerance(tolerance: f64) -> Result<(), FunctionError> {
    match TOLERANCES.0 <= tolerance && tolerance <= TOLERANCES.1 {
        true => Ok(()),
        false => Err(FunctionError::Tolerance(tolerance)),
    }
}

/// A function with the values that are known.
struct Sampled<'a, F> {
    force: F,
    cancel: &'a AtomicBool,
    /// By the bits of the position.
    values: RefCell<HashMap<u64, f64>>,
}

/// Result of fitting a function with these breaks.
enum Attempt {
    Curve(ForceCurve),
    /// Corners that are not among the breaks.
    Corners(Vec<f64>),
}

/// A curve compared with its function.
struct Compared {
    /// The largest error that was found.
    report: FitReport,
    /// Intervals between samples in which the curve is too far off.
    refined: Vec<(f64, f64)>,
}

impl<F: Fn(f64) -> f64> Sampled<'_, F> {
    fn value(&self, x: f64) -> Result<f64, FunctionError> {
        let mut values = self.values.borrow_mut();
        if let Some(known) = values.get(&x.to_bits()) {
            return Ok(*known);
        }
        if values.len() >= MAX_CALLS {
            return Err(FunctionError::Rough(x));
        }
        if self.cancel.load(Ordering::Relaxed) {
            return Err(FunctionError::Cancelled);
        }
        let value = (self.force)(x);
        values.insert(x.to_bits(), value);
        if value.is_finite() { Ok(value) } else { Err(FunctionError::NotFinite(x, value)) }
    }

    fn curve(
        &self,
        (low, high): (f64, f64),
        tolerance: f64,
        breaks: &[f64],
    ) -> Result<Attempt, FunctionError> {
        let ends = [&[low], breaks, &[high]].concat();
        let count = INTERVALS.div_ceil(ends.len() - 1).max(MIN_INTERVALS);
        let even = |pair: &[f64]| {
            let (from, to) = (pair[0], pair[1]);
            (0..count).map(move |i| {
                let share = i as f64 / count as f64;
                from * (1.0 - share) + to * share
            })
        };
        let x: Vec<f64> = ends.windows(2).flat_map(even).chain([high]).collect();
        let values = x.iter().map(|x| self.value(*x)).collect::<Result<Vec<f64>, _>>()?;
        let mut table = ForceTable { x, force: values };
        loop {
            let curve = fitted(&table, AT_SAMPLES * tolerance, self.cancel)?;
            let compared = self.compared(&curve, &table, tolerance)?;
            if compared.refined.is_empty() {
                let corners = self.corners_beside(&curve, &table, &ends)?;
                return Ok(match corners.is_empty() {
                    true => Attempt::Curve(curve.with_fit(compared.report)),
                    false => Attempt::Corners(corners),
                });
            }
            // a corner beside a sample is seen from the intervals on both sides of it, and counts once
            let (mut corners, mut known) = (Vec::new(), ends.clone());
            for interval in &compared.refined {
                let corner = self.corner(*interval, &known)?;
                corners.extend(corner);
                known.extend(corner);
            }
            if !corners.is_empty() {
                return Ok(Attempt::Corners(corners));
            }
            let narrow = |(from, to): &&(f64, f64)| to - from < STEP_WIDTH * (high - low);
            if let Some((from, to)) = compared.refined.iter().find(narrow) {
                return Err(FunctionError::Step(0.5 * (from + to)));
            }
            let middle = |(from, to): &(f64, f64)| {
                let x = 0.5 * (from + to);
                Ok((x, self.value(x)?))
            };
            let known = table.x.iter().copied().zip(table.force.iter().copied()).map(Ok);
            let added = compared.refined.iter().map(middle);
            let mut rows = known.chain(added).collect::<Result<Vec<(f64, f64)>, FunctionError>>()?;
            rows.sort_by(|a, b| a.0.total_cmp(&b.0));
            (table.x, table.force) = rows.into_iter().unzip();
        }
    }

    fn compared(
        &self,
        curve: &ForceCurve,
        table: &ForceTable,
        tolerance: f64,
    ) -> Result<Compared, FunctionError> {
        let scale = force_scale(table);
        let largest = table.force.iter().fold(0.0_f64, |largest, force| largest.max(force.abs()));
        let allowed = tolerance * scale + 16.0 * f64::EPSILON * largest;
        let (low, high) = curve.domain();
        let (mut worst, mut at, mut refined) = (0.0_f64, low, Vec::new());
        for pair in table.x.windows(2) {
            let mut largest = 0.0_f64;
            for check in 1..=CHECKS {
                let share = check as f64 / (CHECKS + 1) as f64;
                let x = (pair[0] * (1.0 - share) + pair[1] * share).clamp(low, high);
                let error = (curve.force(x) - self.value(x)?).abs();
                if error > worst {
                    (worst, at) = (error, x);
                }
                largest = largest.max(error);
            }
            if largest > allowed {
                refined.push((pair[0], pair[1]));
            }
        }
        let samples = Some(table.x.len() + CHECKS * (table.x.len() - 1));
        let mut report =
            FitReport { worst_n: worst, worst_at_m: Some(at), scale_n: scale, samples, warnings: Vec::new() };
        if let Some(fit) = curve.fit() {
            report.warnings.clone_from(&fit.warnings);
            if fit.worst_n > worst {
                (report.worst_n, report.worst_at_m) = (fit.worst_n, fit.worst_at_m);
            }
        }
        Ok(Compared { report, refined })
    }

    /// The corners at breaks that the fit has put on samples, which may lie beside them within the tolerance.
    fn corners_beside(
        &self,
        curve: &ForceCurve,
        table: &ForceTable,
        ends: &[f64],
    ) -> Result<Vec<f64>, FunctionError> {
        let (mut corners, mut known) = (Vec::new(), ends.to_vec());
        let breaks = curve.breaks();
        for at in breaks.iter().filter(|at| !ends.contains(at)) {
            let next = table.x.partition_point(|x| x <= at);
            let before = table.x[..next].iter().rfind(|x| *x < at);
            let (Some(from), Some(to)) = (before, table.x.get(next)) else { continue };
            // between samples it may reach to another corner; then in an interval that is narrower by far
            let others = breaks.iter().chain(&known).filter(|x| *x != at);
            let apart = others.fold(f64::MAX, |apart, x| apart.min((x - at).abs()));
            let half = (0.1 * apart).min(0.1 * (to - from));
            let corner = match self.corner((*from, *to), &known)? {
                None => self.corner((at - half, at + half), &known)?,
                found => found,
            };
            corners.extend(corner);
            known.extend(corner);
        }
        Ok(corners)
    }

    /// The corner in an interval, if the function has one there and is smooth beside it, up to the next of
    /// the corners and ends of the range that are `known`. Narrower and narrower intervals around it locate
    /// it to rounding.
    fn corner(&self, interval: (f64, f64), known: &[f64]) -> Result<Option<f64>, FunctionError> {
        let (low, high) =
            known.iter().fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(*x), high.max(*x)));
        let (mut from, mut to) = interval;
        loop {
            let width = to - from;
            let beside = BESIDE as f64 * width;
            let (left, right) = (from - beside, to + beside);
            if left < low || high < right || known.iter().any(|x| left < *x && *x < right) {
                return Ok(None);
            }
            let Some((x, is_located)) = self.meeting(from, to)? else { return Ok(None) };
            if is_located || width < CORNER_WIDTH * (high - low) {
                return Ok(Some(x));
            }
            (from, to) = (x - width / 16.0, x + width / 16.0);
        }
    }

    /// Where the cubics through the samples on both sides of an interval meet, if the function follows them
    /// up to there and turns from one to the other. Also whether rounding limits the place.
    fn meeting(&self, from: f64, to: f64) -> Result<Option<(f64, bool)>, FunctionError> {
        let width = to - from;
        let side = |edge: f64, step: f64| -> Result<Vec<(f64, f64)>, FunctionError> {
            let places = (0..BESIDE).map(|i| edge + step * i as f64);
            places.map(|x| Ok((x, self.value(x)?))).collect()
        };
        let (left, right) = (side(from, -width)?, side(to, width)?);
        let difference = |x: f64| extrapolated(&left, x) - extrapolated(&right, x);
        let (before, after) = (difference(from), difference(to));
        if !(before * after < 0.0) {
            return Ok(None);
        }
        let (x, _) = bisect(from, to, 60, |x| difference(x) * before > 0.0);
        let change = (after - before).abs();
        let largest = left.iter().chain(&right).fold(0.0_f64, |largest, (_, value)| largest.max(value.abs()));
        let rounding = 64.0 * f64::EPSILON * largest;
        for i in 0..=2 * CHECKS {
            let share = i as f64 / (2 * CHECKS) as f64;
            let place = from * (1.0 - share) + to * share;
            let side = if place < x { &left } else { &right };
            if !((self.value(place)? - extrapolated(side, place)).abs() <= CORNER_ERROR * change + rounding) {
                return Ok(None);
            }
        }
        Ok((change * CORNER_ERROR > rounding).then_some((x, change * CORNER_ERROR < 16.0 * rounding)))
    }
}

/// Makes corners of a range about 0 that are each other's mirror image within rounding exactly so, and puts
/// one that is its mirror image at 0.
fn mirrored(mut corners: Vec<f64>, (low, high): (f64, f64)) -> Vec<f64> {
    if low == -high {
        for i in 0..corners.len() {
            let image = corners.iter().position(|x| (x + corners[i]).abs() < 1e-9 * high);
            match image {
                Some(image) if image == i => corners[i] = 0.0,
                Some(image) if corners[i] > 0.0 => corners[image] = -corners[i],
                _ => {}
            }
        }
    }
    corners
}

/// The value at `x` of the polynomial through these points.
fn extrapolated(points: &[(f64, f64)], x: f64) -> f64 {
    let term = |(i, (at, value)): (usize, &(f64, f64))| {
        let others = points.iter().enumerate().filter(|(j, _)| *j != i);
        others.fold(*value, |term, (_, (other, _))| term * (x - other) / (at - other))
    };
    points.iter().enumerate().map(term).sum()
}
