//! Force between two dipole magnets that pass each other, in closed form and as a piecewise polynomial.
//!
//! The magnets stand beside each other at x = 0, the gap g apart; one moves with the mass, perpendicular to
//! the line that joins them there. Two point dipoles at the distance r along the unit vector n have the
//! energy U = mu_0/(4 pi) (m_1 m_2 - 3 (n m_1) (n m_2))/r^3 with scalar products of the moments (Griffiths
//! 1999, "Introduction to Electrodynamics", third edition, equation 6.35; Jackson 1999, "Classical
//! Electrodynamics", third edition, equation 4.26 for electric ones). Here r^2 = x^2 + g^2, and the strength
//! K = mu_0 m_1 m_2/(4 pi) is above 0 for parallel and below 0 for antiparallel moments. The force that holds
//! the mass is F = dU/dx:
//!
//! - moments along the line that joins the magnets at x = 0 ([`Moments::Facing`]): U = K (1/r^3 - 3 g^2/r^5),
//!   F = 3 K x (4 g^2 - x^2)/r^7, with the stiffness 12 K/g^5 at x = 0 and zeros at x = +-2 g. Parallel ones
//!   attract each other at x = 0;
//! - moments perpendicular to that line and to the motion, so that n m = 0 ([`Moments::Transverse`]):
//!   U = K/r^3, F = -3 K x/r^5, with the stiffness -3 K/g^5 at x = 0 and no other zero. Parallel ones repel
//!   each other everywhere (Cottone, Vocca and Gammaitoni 2009, "Nonlinear energy harvesting").
//!
//! The size of the magnets is neglected: magnets longer or wider than the gap are weaker than their dipoles.

use std::sync::OnceLock;

use super::curve::{FitReport, ForceCurve, Piece};
use super::fit::{allowed_error, fit_within};
use super::table::ForceTable;
use crate::numeric::elementary;
use crate::scene::Moments;

/// Half the length of the curve's domain in gaps; the force beyond is at most 4e-8 of its maximum.
const REACH: f64 = 100.0;

/// Allowed error of the pieces relative to the largest force, up to the last extremum of the force.
/// Beyond it the allowed error falls in proportion to the force, so that the far field stays accurate to
/// 2e-6 of itself.
const TOLERANCE: f64 = 1e-8;

/// Largest degree of a piece, chosen so that a run near the other magnet costs least.
const DEGREE: usize = 9;

/// Number of samples that the pieces are fitted to: enough for local interpolation between them to be more
/// accurate than the tolerance.
const SAMPLES: usize = 801;

/// Number of intervals between two samples at whose ends the error is measured.
const CHECKS_PER_SAMPLE: usize = 16;

/// Upper bound of the largest error over the largest measured one: the error has about fifteen extrema per
/// piece, and each is sampled by tens of checks.
const CHECK_MARGIN: f64 = 1.01;

/// F in units of K/g^4 at x = u g for facing moments.
fn facing_force(u: f64) -> f64 {
    let squared = u * u + 1.0;
    3.0 * u * (4.0 - u * u) / (squared.powi(3) * squared.sqrt())
}

/// F in units of K/g^4 at x = u g for transverse moments.
fn transverse_force(u: f64) -> f64 {
    let squared = u * u + 1.0;
    -3.0 * u / (squared * squared * squared.sqrt())
}

/// Force dU/dx in N at `x` in m of two magnets with facing moments, of `strength` K in N m^4 at a `gap` g in
/// m.
///
/// F = 3 K x (4 g^2 - x^2)/r^7 with r^2 = x^2 + g^2, the force of two point dipoles (Griffiths 1999, equation
/// 6.35).
pub fn magnet_force(strength: f64, gap: f64, x: f64) -> f64 {
    strength / gap.powi(4) * facing_force(x / gap)
}

/// Force dU/dx in N at `x` in m of two magnets with transverse moments, of `strength` K in N m^4 at a `gap` g
/// in m.
///
/// F = -3 K x/r^5 with r^2 = x^2 + g^2 (Cottone, Vocca and Gammaitoni 2009).
pub fn transverse_magnet_force(strength: f64, gap: f64, x: f64) -> f64 {
    strength / gap.powi(4) * transverse_force(x / gap)
}

/// The curve for strength 1 and gap 1, computed once. Its report has the error in the same units.
fn unit_curve(moments: Moments) -> Result<&'static ForceCurve, String> {
    type Unit = OnceLock<Result<ForceCurve, String>>;
    static UNITS: [Unit; 2] = [OnceLock::new(), OnceLock::new()];
    // the square of the last extremum of the force in gaps is a root of 4 s^2 - 27 s + 4 for facing moments,
    // and 1/4 for transverse ones
    let (unit, unit_force, last_extremum): (_, fn(f64) -> f64, f64) = match moments {
        Moments::Facing => (&UNITS[0], facing_force, ((27.0 + 665_f64.sqrt()) / 8.0).sqrt()),
        Moments::Transverse => (&UNITS[1], transverse_force, 0.5),
    };
    unit.get_or_init(|| {
        let last = SAMPLES as f64 - 1.0;
        let place = |i: f64| {
            let s: f64 = (2.0 * i - last) / last;
            s.signum() * elementary::sinh(s.abs() * elementary::asinh(REACH))
        };
        let x: Vec<f64> = (0..SAMPLES).map(|i| place(i as f64)).collect();
        let force = x.iter().map(|u| unit_force(*u)).collect();
        let table = ForceTable { x, force };
        let near = allowed_error(&table, TOLERANCE);
        let largest = unit_force(last_extremum);
        let falloff = |u: &f64| if u.abs() > last_extremum { unit_force(*u) / largest } else { 1.0 };
        let allowed: Vec<f64> = table.x.iter().map(|u| near * falloff(u).abs()).collect();
        let curve = fit_within(&table, &allowed, &[DEGREE], None)?;
        let checks = CHECKS_PER_SAMPLE * (SAMPLES - 1);
        let reach = curve.domain().1;
        let (mut worst_n, mut worst_at_m, mut scale_n) = (0.0_f64, 0.0, 0.0_f64);
        for i in 0..=checks {
            let u = place(i as f64 / CHECKS_PER_SAMPLE as f64).clamp(-reach, reach);
            let error = CHECK_MARGIN * (curve.force(u) - unit_force(u)).abs();
            scale_n = scale_n.max(unit_force(u).abs());
            if error > worst_n {
                (worst_n, worst_at_m) = (error, u);
            }
        }
        let warnings = Vec::new();
        let (worst_at_m, samples) = (Some(worst_at_m), Some(checks + 1));
        Ok(curve.with_fit(FitReport { worst_n, worst_at_m, scale_n, samples, warnings }))
    })
    .as_ref()
    .map_err(Clone::clone)
}

/// The curve of a magnet of `strength` in N m^4 at a `gap` in m above 0, up to 100 gaps to either side. Its
/// report has the largest error against the closed form. The force is 0 everywhere for a strength of 0.
///
/// The error, if the numbers leave the range of double precision, is a sentence.
pub fn magnet(moments: Moments, strength: f64, gap: f64) -> Result<ForceCurve, String> {
    if strength == 0.0 {
        return Ok(ForceCurve::polynomial(&[0.0]));
    }
    let unit = unit_curve(moments)?;
    let scale = strength / gap.powi(4);
    let scaled = |piece: &Piece| {
        let mut factor = scale;
        let coefficients = piece.coefficients.iter().map(|c| {
            let scaled = c * factor;
            factor /= gap;
            scaled
        });
        Piece::new(piece.origin * gap, coefficients.collect())
    };
    let pieces: Vec<Piece> = unit.pieces().iter().map(scaled).collect();
    let breaks: Vec<f64> = unit.breaks().iter().map(|u| u * gap).collect();
    let (low, high) = unit.domain();
    let fit = unit.fit().map(|fit| FitReport {
        worst_n: fit.worst_n * scale.abs(),
        worst_at_m: fit.worst_at_m.map(|u| u * gap),
        scale_n: fit.scale_n * scale.abs(),
        ..fit.clone()
    });
    let finite = pieces.iter().flat_map(|piece| &piece.coefficients).all(|c| c.is_finite());
    let curve = ForceCurve::joined(pieces, breaks, (low * gap, high * gap), true, fit);
    if scale != 0.0 && finite && curve.pieces().iter().all(|piece| piece.potential_at_origin.is_finite()) {
        return Ok(curve);
    }
    Err("has a force that leaves the range of double precision; take a gap and a strength nearer to each \
         other's size"
        .to_owned())
}
