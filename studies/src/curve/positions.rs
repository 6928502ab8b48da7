//! Positions of a mechanism, its force curve and the states of its flexures there, and their stress.

use crate::mechanics::flexure::{FlexureError, Flexures, State};
use crate::mechanics::{Equilibrium, Mechanism};
use crate::numeric::round::decade;
use crate::numeric::{Decimal, elementary, extent, short};
use crate::scene::Scene;
use crate::study::{Table, Task};

/// Default number of positions of a force curve.
pub const CURVE_POINTS: u32 = 401;

/// Number of positions in a picture of the curve: more than it has pixel columns.
pub const CURVE_PICTURE_POINTS: usize = 3001;

/// A position outside the force curve.
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
    Ok(rows(mechanism, &positions))
}

pub(super) fn rows(mechanism: &Mechanism, positions: &[f64]) -> Table {
    let curve = &mechanism.curve;
    Table::new()
        .each("x_m", positions, |x| *x)
        .each("force_n", positions, |x| curve.force(*x))
        .each("potential_j", positions, |x| curve.potential(*x))
        .each("stiffness_n_per_m", positions, |x| curve.stiffness(*x))
}

fn check_positions(mechanism: &Mechanism, positions: &[f64]) -> Result<(), OutsideCurve> {
    let domain = mechanism.curve.domain();
    match positions.iter().find(|x| !(x.is_finite() && **x >= domain.0 && **x <= domain.1)) {
        Some(&x) => Err(OutsideCurve { x, domain }),
        None => Ok(()),
    }
}

/// `points` positions in m that show all equilibria and stops: up to 1.15 times the distance of the outermost
/// one (10 mm without one), rounded up to two digits and cut to the domain of the curve.
pub fn default_positions(scene: &Scene, mechanism: &Mechanism, points: usize) -> Vec<f64> {
    const MARGIN: f64 = 1.15;
    const DEFAULT_REACH_MM: f64 = 10.0;
    let equilibria = mechanism.landscape.equilibria.iter().map(|equilibrium| equilibrium.x.abs() * 1e3);
    let stops = scene.stops.limits_mm().into_iter().flatten().map(f64::abs);
    let farthest = equilibria.chain(stops).fold(0.0, f64::max);
    let reach = if farthest > 0.0 { two_digits_up(MARGIN * farthest) } else { DEFAULT_REACH_MM };
    let (left, right) = mechanism.curve.domain();
    let range_mm = ((-reach).max(left * 1e3), reach.min(right * 1e3));
    even_positions(range_mm, points).into_iter().map(|mm| metres(mm).clamp(left, right)).collect()
}

/// `value` above 0 rounded up to two significant digits, as the double nearest to that decimal.
fn two_digits_up(value: f64) -> f64 {
    let exponent = decade(value) - 1;
    let digits = (value / elementary::powi(10.0, exponent)).ceil();
    format!("{digits}e{exponent}").parse().unwrap_or(value)
}

/// `mm` in m: the double nearest to the decimal that `mm` spells, so that 0.3 mm is 3e-4 m.
pub fn metres(mm: f64) -> f64 {
    let shifted = Decimal::shortest(mm).map(|decimal| Decimal { exponent: decimal.exponent - 3, ..decimal });
    shifted.map_or(mm / 1e3, |decimal| decimal.value().copysign(mm))
}

/// Positions in m of the left and the right stop; NaN without one.
pub fn stop_positions(scene: &Scene) -> (f64, f64) {
    scene.stops.positions_mm().map(|stop| stop.map_or(f64::NAN, metres)).into()
}

/// `points` even positions from `range.0` to `range.1`. Both ends are exact, and the middle is exactly 0 if
/// the range is symmetric and `points` is odd. A single point is the left end.
pub fn even_positions(range: (f64, f64), points: usize) -> Vec<f64> {
    let last = points.saturating_sub(1).max(1) as f64;
    // a weighted mean of the ends is exact at both and symmetric, unlike left + i*step
    (0..points).map(|i| (range.0 * (last - i as f64) + range.1 * i as f64) / last).collect()
}

/// Frequency in Hz of small free oscillations of `mass` in kg about an equilibrium; `None` if it is not
/// stable to first order. At a kink of the force the two half swings differ in stiffness: 1/f = pi
/// sqrt(m/k_left) + pi sqrt(m/k_right).
pub fn small_amplitude_frequency(mass: f64, equilibrium: &Equilibrium) -> Option<f64> {
    let Equilibrium { stable, stiffness_left, stiffness_right, .. } = *equilibrium;
    let half = |stiffness: f64| std::f64::consts::PI * (mass / stiffness).sqrt();
    (stable && stiffness_left > 0.0 && stiffness_right > 0.0)
        .then(|| 1.0 / (half(stiffness_left) + half(stiffness_right)))
}

/// Why the states of flexures cannot be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StatesError {
    /// The mechanism is not made of flexures.
    #[error(
        "this mechanism has no flexures, only a force; shapes, axial force and stress need `mechanism: \
         Flexures(..)`"
    )]
    NoFlexures,
    /// A position beyond the curve.
    #[error(transparent)]
    Outside(#[from] OutsideCurve),
    /// No solution at a position.
    #[error(transparent)]
    Unsolved(#[from] FlexureError),
    /// It was cancelled.
    #[error("cancelled")]
    Cancelled,
}

/// The states of the flexures at these positions in m, in this order; each is solved anew.
pub fn states(mechanism: &Mechanism, positions: &[f64], task: &Task) -> Result<Vec<State>, StatesError> {
    let flexures = mechanism.flexures.as_deref().ok_or(StatesError::NoFlexures)?;
    check_positions(mechanism, positions)?;
    let state = |x: &f64| {
        task.check_cancelled().map_err(|_| StatesError::Cancelled)?;
        let state = flexures.state(*x)?;
        (task.tick)();
        Ok(state)
    };
    positions.iter().map(state).collect()
}

/// A warning in one sentence if the bending stress of some `states` exceeds the limit of the scene. It gives
/// the range of |x|, the largest stress and the limit.
pub fn stress_warning(flexures: &Flexures, states: &[State]) -> Option<String> {
    let limit = flexures.geometry().yield_stress;
    let (_, farthest) = extent(states.iter().map(|state| state.x.abs()));
    let above: Vec<&State> = states.iter().filter(|state| state.max_stress > limit).collect();
    let worst = above.iter().max_by(|a, b| a.max_stress.total_cmp(&b.max_stress))?;
    let (from, to) = extent(above.iter().map(|state| state.x.abs()));
    let end = if to < farthest { format!("to {} mm", short(to * 1e3)) } else { "on".to_owned() };
    let [begin, place] = [from, worst.x].map(|metres| short(metres * 1e3));
    let [limit, largest] = [limit, worst.max_stress].map(|pascal| short(pascal / 1e9));
    Some(format!(
        "from |x| = {begin} mm {end} the bending stress exceeds mechanism.yield_gpa = {limit}: {largest} GPa \
         at x = {place} mm; the model does not follow yielding"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Document, Files};

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
    fn a_corner_mixes_the_two_half_swings() {
        let smooth = Equilibrium { x: 0.0, stable: true, stiffness_left: 4.0, stiffness_right: 4.0 };
        let frequency = small_amplitude_frequency(1.0, &smooth).unwrap();
        assert!((frequency - 2.0 / std::f64::consts::TAU).abs() < 1e-15);
        let unstable = Equilibrium { stable: false, ..smooth };
        assert_eq!(small_amplitude_frequency(1.0, &unstable), None);
    }

    fn state(x: f64, max_stress: f64) -> State {
        State {
            x,
            force: 0.0,
            potential: 0.0,
            stiffness: 0.0,
            axial: 5.0,
            bump: 1e-3,
            max_stress,
            lines: Vec::new(),
        }
    }

    #[test]
    fn a_warning_says_from_where_on() {
        let text = "(title: \"t\", mass_g: 15.2, mechanism: Flexures(preload_mm: 2.7, thickness_mm: 0.1, \
                    young_gpa: 190, yield_gpa: 1.5, parallel: (count: 2, length_mm: 26, width_mm: 20), \
                    buckling: (count: 1, length_mm: 27.7, width_mm: 6.8)), run: (duration_s: 1))";
        let scene = Document::from_text("t", text, Files::default()).unwrap().scene;
        let mechanism = Mechanism::build(&scene.mechanism, &Files::default()).unwrap();
        let flexures = mechanism.flexures.unwrap();
        let warning = |stresses: [(f64, f64); 3]| {
            let states = stresses.map(|(mm, gpa)| state(mm * 1e-3, gpa * 1e9));
            stress_warning(&flexures, &states)
        };
        assert_eq!(warning([(-2.0, 1.4), (0.0, 0.0), (2.0, 1.5)]), None);
        let text = warning([(-6.0, 1.6), (0.0, 1.0), (7.0, 1.75)]).unwrap();
        assert!(text.starts_with("from |x| = 6 mm on ") && text.lines().count() == 1, "{text}");
        assert!(text.contains("mechanism.yield_gpa = 1.5: 1.75 GPa at x = 7 mm"), "{text}");
        let text = warning([(0.0, 1.6), (0.5, 1.55), (7.0, 1.0)]).unwrap();
        assert!(text.starts_with("from |x| = 0 mm to 0.5 mm "), "{text}");
    }
}
