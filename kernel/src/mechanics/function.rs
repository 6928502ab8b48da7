//! Force curves that a program gives: made of a function, or of polynomials in a scene.

use super::curve::{FitReport, ForceCurve, Piece};
use super::fit::{fit, force_scale};
use super::table::{ForceTable, MAX_POINTS};
use crate::scene;

/// Smallest and largest tolerance of [`ForceCurve::from_fn`].
const TOLERANCES: (f64, f64) = (1e-10, 0.1);

/// Intervals between two given breaks at first.
const INTERVALS: usize = 64;

/// Comparisons with the function in each interval between samples.
const CHECKS: usize = 5;

/// Share of the tolerance that the fit may use at the samples; between them the error is a little larger.
const AT_SAMPLES: f64 = 0.5;

/// Width of an interval, relative to the range, below which a function that is not followed has a step.
const NARROWEST: f64 = 1e-12;

/// Why a function has no force curve.
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
    /// The function has no finite value somewhere.
    #[error("the force at x = {0} m is {1}; it must be finite in the whole range")]
    NotFinite(f64, f64),
    /// No curve follows the function.
    #[error("no continuous curve follows the force near x = {0} m; a force must have no steps")]
    Step(f64),
    /// The fit of the samples failed.
    #[error("the force {0}")]
    Fit(String),
}

impl ForceCurve {
    /// The curve of a function: the force in N at a position in m, over a range in m.
    ///
    /// The curve differs from the function by at most `tolerance` (1e-10 to 0.1) times the largest force
    /// between the wells. The error that was found at five places between any two samples is in
    /// [`fit`](Self::fit). Places where the function bends sharply are found; those that are known are better
    /// given as `breaks`, in m. A function that is odd over a symmetric range gives a curve that is odd bit
    /// for bit.
    ///
    /// ```
    /// use interwell_kernel::mechanics::ForceCurve;
    ///
    /// let curve = ForceCurve::from_fn(|x| -40.0 * x + 8e5 * x.powi(3), (-9e-3, 9e-3), 1e-8, &[])?;
    /// assert!((curve.force(7e-3) - (-0.28 + 0.2744)).abs() < 1e-9);
    /// # Ok::<(), interwell_kernel::mechanics::FunctionError>(())
    /// ```
    pub fn from_fn(
        force: impl Fn(f64) -> f64,
        range: (f64, f64),
        tolerance: f64,
        breaks: &[f64],
    ) -> Result<Self, FunctionError> {
        let (low, high) = range;
        if !(low < high && low.is_finite() && high.is_finite()) {
            return Err(FunctionError::Range(low, high));
        }
        if !(TOLERANCES.0 <= tolerance && tolerance <= TOLERANCES.1) {
            return Err(FunctionError::Tolerance(tolerance));
        }
        if let Some(outside) = breaks.iter().find(|x| !(low < **x && **x < high)) {
            return Err(FunctionError::Break(*outside));
        }
        let finite = |x: f64| match force(x) {
            value if value.is_finite() => Ok(value),
            value => Err(FunctionError::NotFinite(x, value)),
        };
        let mut ends = [&[low], breaks, &[high]].concat();
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        let even = |pair: &[f64]| {
            let (from, to) = (pair[0], pair[1]);
            (0..INTERVALS).map(move |i| {
                let share = i as f64 / INTERVALS as f64;
                from * (1.0 - share) + to * share
            })
        };
        let x: Vec<f64> = ends.windows(2).flat_map(even).chain([high]).collect();
        let values = x.iter().map(|x| finite(*x)).collect::<Result<Vec<f64>, _>>()?;
        let mut table = ForceTable { x, force: values };
        loop {
            let curve = fit(&table, AT_SAMPLES * tolerance).map_err(FunctionError::Fit)?;
            let compared = compared(&curve, &table, tolerance, &finite)?;
            let Some(first) = compared.refined.first() else {
                return Ok(curve.with_fit(compared.report));
            };
            let narrow = |x: &f64| {
                let right = table.x.partition_point(|sample| sample < x);
                table.x[right] - table.x[right - 1] < NARROWEST * (high - low)
            };
            if compared.refined.iter().any(narrow) || table.x.len() + compared.refined.len() > MAX_POINTS {
                let at = compared.refined.iter().copied().find(narrow).unwrap_or(*first);
                return Err(FunctionError::Step(at));
            }
            let added = compared.refined.iter().map(|x| Ok((*x, finite(*x)?)));
            let known = table.x.iter().copied().zip(table.force.iter().copied()).map(Ok);
            let mut rows = known.chain(added).collect::<Result<Vec<(f64, f64)>, FunctionError>>()?;
            rows.sort_by(|a, b| a.0.total_cmp(&b.0));
            (table.x, table.force) = rows.into_iter().unzip();
        }
    }

    /// The curve of polynomials in a scene that has passed its check.
    pub(super) fn as_written(ends: &[f64], pieces: &[scene::ForcePiece], error: f64) -> Self {
        let piece = |piece: &scene::ForcePiece| Piece::new(piece.origin_m, piece.coefficients_si.clone());
        let pieces: Vec<Piece> = pieces.iter().map(piece).collect();
        let (last, breaks) = (pieces.len(), ends[1..pieces.len()].to_vec());
        let is_odd = (0..=last).all(|i| ends[i] == -ends[last - i])
            && pieces.iter().zip(pieces.iter().rev()).all(|(left, right)| *left == right.mirrored());
        let curve = Self::from_pieces(pieces, breaks, (ends[0], ends[last]), is_odd, None);
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

/// A curve compared with its function.
struct Compared {
    /// The largest error that was found.
    report: FitReport,
    /// Middles of the intervals between samples in which the curve is too far off.
    refined: Vec<f64>,
}

fn compared(
    curve: &ForceCurve,
    table: &ForceTable,
    tolerance: f64,
    force: &impl Fn(f64) -> Result<f64, FunctionError>,
) -> Result<Compared, FunctionError> {
    let scale = force_scale(table);
    let allowed = tolerance * scale
        + 16.0 * f64::EPSILON * table.force.iter().fold(0.0_f64, |largest, force| largest.max(force.abs()));
    let (low, high) = curve.domain();
    let (mut worst, mut at, mut refined) = (0.0_f64, low, Vec::new());
    for pair in table.x.windows(2) {
        let mut largest = 0.0_f64;
        for check in 1..=CHECKS {
            let share = check as f64 / (CHECKS + 1) as f64;
            let x = (pair[0] * (1.0 - share) + pair[1] * share).clamp(low, high);
            let error = (curve.force(x) - force(x)?).abs();
            if error > worst {
                (worst, at) = (error, x);
            }
            largest = largest.max(error);
        }
        if largest > allowed {
            refined.push(0.5 * (pair[0] + pair[1]));
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
