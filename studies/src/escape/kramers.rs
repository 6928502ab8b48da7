//! Kramers' rate of escape over a barrier under white noise.
//!
//! Noise of the base with the two-sided spectral density S of the acceleration, constant over all rates of
//! the motion, acts on a mass m with linear damping c as a bath with k_B T = m^2 S / (2 c): the acceleration
//! of a bath has S = 2 c k_B T / m^2 by the fluctuation-dissipation theorem. A noise of this root mean square
//! over a band from `low` to `high` has S = rms^2 / (2 (high - low)) in (m/s^2)^2/Hz.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::dynamics::Model;
use crate::mechanics::{Homoclinic, Well};
use crate::numeric::elementary;

/// Smallest height of the barriers over k_B T.
const MIN_HEIGHT: f64 = 3.0;
/// Smallest ratio of the upper end of the band to the rates of the motion.
const ABOVE: f64 = 10.0;
/// Smallest ratio of the slowest rate of the motion to the lower end of the band.
const BELOW: f64 = 30.0;
/// Smallest number of lines of the noise in the width of the response of the mass.
const LINES: f64 = 8.0;
/// Distance of a kink from an equilibrium, in standard deviations of thermal motion, within which the
/// curvature there does not hold.
const NEAR: f64 = 3.0;
/// Relative jump of the stiffness at an equilibrium from which on it has no curvature.
const KINK: f64 = 1e-6;
/// Points of the midpoint rule of the depopulation factor.
const POINTS: usize = 512;

words! {
    /// The condition of Kramers' rate that fails.
    NoKramers {
        /// The escape is no passage into the well behind the barrier.
        Until = "until",
        /// A circuit takes part, or damping is not linear and above 0.
        Damping = "damping",
        /// The mass does not start in a well with one barrier and a well behind it.
        Barrier = "barrier",
        /// The excitation is not one noise alone.
        Noise = "noise",
        /// The barrier is lower than 3 k_B T above either well.
        Height = "height",
        /// The curve has a kink near the well or the barrier, or no stiffness there.
        Kink = "kink",
        /// A stop or an end of a table lies before a well, or is lower than the barrier.
        Ends = "ends",
        /// The band of the noise does not reach from a 30th of the slowest rate to ten times the fastest.
        Band = "band",
        /// The noise has fewer than eight lines in the width of the response.
        Lines = "lines",
        /// The rate is too small for a number.
        Rate = "rate",
    }
}

/// Kramers' rate in 1/s of the escape from the well in which the model starts over its barrier into the well
/// behind it; of its conditions ([`NoKramers`]) the one that fails where it does not hold.
///
/// With the rates w_0 of the well and w_b of the barrier, g = c/m and the height E of the barrier over the
/// well, the rate is (sqrt(g^2/4 + w_b^2) - g/2)/w_b * w_0/(2 pi) * exp(-E/k_B T) (Kramers 1940; Hänggi,
/// Talkner and Borkovec 1990, equation 4.33), times the factor of [`depopulation`] that leads over to weak
/// damping. Its relative error is of the order k_B T/E.
pub fn kramers_rate(model: &Model) -> Result<f64, NoKramers> {
    let (mass, damping) = (model.mass(), model.total_damping());
    let landscape = &model.mechanism().landscape;
    let barrier = model.crossing_level().ok_or(NoKramers::Barrier)?;
    let curve = &model.mechanism().curve;
    if model.has_electrical_state() || !(damping > 0.0) {
        return Err(NoKramers::Damping);
    }
    let (wells, start) = (landscape.wells(), model.start().0);
    let place = wells.iter().position(|well| well.x > barrier).filter(|place| *place > 0);
    let place = place.ok_or(NoKramers::Barrier)?;
    let (left, right) = (&wells[place - 1], &wells[place]);
    let (well, behind) = if start < barrier { (left, right) } else { (right, left) };
    let within =
        |well: &Well| well.left_top.is_none_or(|x| x < start) && well.right_top.is_none_or(|x| x > start);
    if !within(well) || well.left_top.is_some() == well.right_top.is_some() {
        return Err(NoKramers::Barrier);
    }
    let temperature = mass * mass * white_noise(model).ok_or(NoKramers::Noise)? / (2.0 * damping);
    let height = curve.potential_change(well.x, barrier);
    if height.min(curve.potential_change(behind.x, barrier)) < MIN_HEIGHT * temperature {
        return Err(NoKramers::Height);
    }
    let stiffness = |x: f64| {
        let (left, right) = curve.stiffness_on_both_sides(x);
        let smooth = (left - right).abs() <= KINK * left.abs();
        let reach = NEAR * (temperature / left.abs()).sqrt();
        let kinked = landscape.kinks.iter().any(|kink| (kink.x - x).abs() < reach);
        (smooth && !kinked).then_some(left).ok_or(NoKramers::Kink)
    };
    let (well_rate, barrier_rate) =
        ((stiffness(well.x)? / mass).sqrt(), (-stiffness(barrier)? / mass).sqrt());
    if !(well_rate > 0.0 && barrier_rate > 0.0) {
        return Err(NoKramers::Kink);
    }
    let (damping_rate, domain) = (damping / mass, curve.domain());
    let ends = {
        let (left, right) = model.stop_positions();
        [left.unwrap_or(f64::NEG_INFINITY).max(domain.0), right.unwrap_or(f64::INFINITY).min(domain.1)]
    };
    let far = |x: f64| !x.is_finite() || curve.potential_change(barrier, x) >= 0.0;
    let between = ends[0] < left.x && right.x < ends[1];
    if !(between && ends.into_iter().all(far)) {
        return Err(NoKramers::Ends);
    }
    check_white(model, well_rate, barrier_rate, damping_rate)?;
    let orbit = Homoclinic::new(curve, barrier, well).ok_or(NoKramers::Barrier)?;
    let lost = damping * orbit.squared_velocity(mass) / temperature;
    // with g small beside w_b the difference of the root and g/2 is exact enough; with g large it is not
    let half = 0.5 * damping_rate;
    let over_barrier = barrier_rate / ((half * half + barrier_rate * barrier_rate).sqrt() + half);
    let rate = depopulation(lost) * over_barrier * well_rate / TAU * elementary::exp(-height / temperature);
    (rate > 0.0).then_some(rate).ok_or(NoKramers::Rate)
}

/// The two-sided spectral density of the base's acceleration in (m/s^2)^2/Hz, if that is one noise alone.
fn white_noise(model: &Model) -> Option<f64> {
    let excitation = model.excitation();
    let alone = excitation.constant == 0.0
        && excitation.chirps.is_empty()
        && excitation.records.is_empty()
        && excitation.tones.iter().all(|tone| tone.noise);
    match &excitation.noises[..] {
        [noise] if alone => Some(noise.rms * noise.rms / (2.0 * (noise.high - noise.low))),
        _ => None,
    }
}

/// Checks that the noise is white for a motion with these rates in 1/s.
fn check_white(model: &Model, well: f64, barrier: f64, damping: f64) -> Result<(), NoKramers> {
    let noises = &model.excitation().noises;
    let fastest = well.max(barrier).max(damping);
    // of the two rates of decay of an overdamped motion, about the slower one
    let slow = |rate: f64| rate.min(rate * rate / damping);
    let slowest = slow(well).min(slow(barrier));
    let width = slowest.min(damping);
    for noise in noises {
        let spacing = TAU * (noise.high - noise.low) / noise.lines as f64;
        if !(TAU * noise.high >= ABOVE * fastest && TAU * noise.low * BELOW <= slowest) {
            return Err(NoKramers::Band);
        }
        if !(LINES * spacing <= width) {
            return Err(NoKramers::Lines);
        }
    }
    Ok(())
}

/// The factor by which weak damping lowers Kramers' rate, since a mass that escapes takes its energy from the
/// others: with the energy d that damping takes in one turn of the [`Homoclinic`] orbit over k_B T it is
/// exp(1/(2 pi) integral over all l of ln(1 - exp(-d (l^2 + 1/4)))/(l^2 + 1/4)), from d where it is small to
/// 1 where it is large (Mel'nikov and Meshkov 1986).
///
/// Method: with 2 l = tan(a) the integral is smooth in a with all its derivatives 0 at the ends, where the
/// midpoint rule converges faster than any power.
pub fn depopulation(loss: f64) -> f64 {
    let step = FRAC_PI_2 / POINTS as f64;
    let term = |i: usize| {
        let cos = elementary::cos((i as f64 + 0.5) * step);
        elementary::ln(-elementary::exp_m1(-loss / (4.0 * cos * cos)))
    };
    elementary::exp(step * (0..POINTS).map(term).sum::<f64>() / FRAC_PI_2)
}
