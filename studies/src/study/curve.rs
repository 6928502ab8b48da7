//! Force, potential and stiffness of a mechanism over the displacement.

use super::Table;
use crate::mechanics::{Equilibrium, Mechanism};
use crate::numeric::Decimal;
use crate::numeric::round::decade;
use crate::scene::Scene;

/// Default number of positions of a force curve.
pub const CURVE_POINTS: u32 = 401;

/// Positions of its picture: more than the picture has columns.
pub const CURVE_PICTURE_POINTS: usize = 3001;

/// A position at which the curve is not known.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "{} mm is not on the force curve, which reaches from {} to {} mm",
    x * 1e3, domain.0 * 1e3, domain.1 * 1e3
)]
pub struct OutsideCurve {
    /// The position in m.
    pub x: f64,
    /// Ends of the curve in m.
    pub domain: (f64, f64),
}

/// The table `x_m,force_n,potential_j,stiffness_n_per_m` at these positions in m, in their order.
pub fn curve(mechanism: &Mechanism, positions: Vec<f64>) -> Result<Table, OutsideCurve> {
    check_positions(mechanism, &positions)?;
    let curve = &mechanism.curve;
    Ok(Table::new()
        .each("x_m", &positions, |x| *x)
        .each("force_n", &positions, |x| curve.force(*x))
        .each("potential_j", &positions, |x| curve.potential(*x))
        .each("stiffness_n_per_m", &positions, |x| curve.stiffness(*x)))
}

/// Whether the curve is known at all of these positions in m.
pub(super) fn check_positions(mechanism: &Mechanism, positions: &[f64]) -> Result<(), OutsideCurve> {
    let domain = mechanism.curve.domain();
    match positions.iter().find(|x| !(x.is_finite() && **x >= domain.0 && **x <= domain.1)) {
        Some(&x) => Err(OutsideCurve { x, domain }),
        None => Ok(()),
    }
}

/// `points` positions in m over the range that shows what matters: 1.15 times as far as the outermost
/// equilibrium or stop (10 mm without one), rounded up to two digits, cut to where the curve is known.
pub fn default_positions(scene: &Scene, mechanism: &Mechanism, points: usize) -> Vec<f64> {
    const MARGIN: f64 = 1.15;
    const PLAIN: f64 = 10.0;
    let equilibria = mechanism.landscape.equilibria.iter().map(|equilibrium| equilibrium.x.abs() * 1e3);
    let farthest = equilibria.chain(scene.stops.limits_mm().into_iter().flatten()).fold(0.0, f64::max);
    let reach = if farthest > 0.0 { two_digits_up(MARGIN * farthest) } else { PLAIN };
    let (left, right) = mechanism.curve.domain();
    let range_mm = ((-reach).max(left * 1e3), reach.min(right * 1e3));
    even_positions(range_mm, points).into_iter().map(|mm| metres(mm).clamp(left, right)).collect()
}

/// `value` above 0 rounded up to two significant digits, as the double nearest to that decimal.
fn two_digits_up(value: f64) -> f64 {
    let exponent = decade(value) - 1;
    let digits = (value / 10_f64.powi(exponent)).ceil();
    format!("{digits}e{exponent}").parse().unwrap_or(value)
}

/// `mm` in m: the double nearest to the decimal that `mm` spells, so that 0.3 mm is 3e-4 m.
pub fn metres(mm: f64) -> f64 {
    let shifted = Decimal::shortest(mm).map(|decimal| Decimal { exponent: decimal.exponent - 3, ..decimal });
    shifted.map_or(mm / 1e3, |decimal| decimal.value().copysign(mm))
}

/// Positions in m of the left and the right stop; NaN without one.
pub fn stop_positions(scene: &Scene) -> (f64, f64) {
    let [left, right] = scene.stops.limits_mm().map(|stop| stop.map_or(f64::NAN, metres));
    (-left, right)
}

/// `points` positions evenly from `range.0` to `range.1`, both ends exact and the middle exactly
/// 0 where the range is symmetric and `points` odd; one point is the left end.
pub fn even_positions(range: (f64, f64), points: usize) -> Vec<f64> {
    let last = points.saturating_sub(1).max(1) as f64;
    // Weighted ends, not left + i*step: exact at both and mirrored about the middle.
    (0..points).map(|i| (range.0 * (last - i as f64) + range.1 * i as f64) / last).collect()
}

/// Frequency in Hz of small free oscillations of `mass` in kg about an equilibrium; `None` if it is not
/// stable to first order. On a corner of the curve the half swings differ in stiffness: 1/f = pi
/// sqrt(m/k_left) + pi sqrt(m/k_right), which without a corner is the usual formula.
pub fn small_amplitude_frequency(mass: f64, equilibrium: &Equilibrium) -> Option<f64> {
    let Equilibrium { stable, stiffness_left, stiffness_right, .. } = *equilibrium;
    let half = |stiffness: f64| std::f64::consts::PI * (mass / stiffness).sqrt();
    (stable && stiffness_left > 0.0 && stiffness_right > 0.0)
        .then(|| 1.0 / (half(stiffness_left) + half(stiffness_right)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::{ForceCurve, Landscape};

    fn cubic() -> Mechanism {
        let curve = ForceCurve::polynomial(&[0.0, -40.0, 0.0, 8e5]);
        Mechanism { landscape: Landscape::default(), ..Mechanism::new(curve) }
    }

    #[test]
    fn positions_have_exact_ends_and_middle() {
        let positions = even_positions((-8e-3, 8e-3), 401);
        assert_eq!((positions[0], positions[200], positions[400]), (-8e-3, 0.0, 8e-3));
        assert!((0..401).all(|i| positions[i] == -positions[400 - i]));
        assert_eq!(even_positions((1.0, 2.0), 1), [1.0]);
        assert!(even_positions((1.0, 2.0), 0).is_empty());
        let metres: Vec<f64> = even_positions((-8.0, 8.0), 401).into_iter().map(metres).collect();
        assert_eq!((metres[0], metres[201], metres[207]), (-8e-3, 4e-5, 2.8e-4));
    }

    #[test]
    fn the_range_is_a_short_number() {
        assert_eq!((two_digits_up(7.912), two_digits_up(8.0), two_digits_up(0.0123)), (8.0, 8.0, 0.013));
    }

    #[test]
    fn rows_keep_the_order_of_the_positions() {
        let table = curve(&cubic(), vec![3e-3, 0.0, -3e-3]).unwrap();
        assert_eq!(table.numbers("x_m").unwrap(), [3e-3, 0.0, -3e-3]);
        assert_eq!(table.numbers("potential_j").unwrap()[1], 0.0);
        assert_eq!(table.numbers("stiffness_n_per_m").unwrap()[1], -40.0);
        assert!(curve(&cubic(), vec![f64::NAN]).is_err());
    }

    #[test]
    fn a_corner_mixes_the_two_half_swings() {
        let smooth = Equilibrium { x: 0.0, stable: true, stiffness_left: 4.0, stiffness_right: 4.0 };
        let frequency = small_amplitude_frequency(1.0, &smooth).unwrap();
        assert!((frequency - 2.0 / std::f64::consts::TAU).abs() < 1e-15);
        let unstable = Equilibrium { stable: false, ..smooth };
        assert_eq!(small_amplitude_frequency(1.0, &unstable), None);
    }
}
