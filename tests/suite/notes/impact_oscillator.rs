//! The linear oscillator with one stop, and its motion with one impact a period in closed form.
//!
//! Shaw and Holmes 1983, "A periodically forced piecewise linear oscillator", Journal of Sound and Vibration
//! 90, 129. Between two impacts the motion is that of the free oscillator plus a decaying swing, whose two
//! constants and the phase follow from the stop being reached after a period with -1/e of the speed with
//! which it was left.

use std::f64::consts::TAU;

use interwell::dynamics::STANDARD_GRAVITY;
use interwell::numeric::bisect;

use super::super::support::*;
use super::*;

const RATE: f64 = 0.7;
const DAMPING: f64 = 0.2;
const RESTITUTION: f64 = 0.8;

/// Amplitude of the swing that does not touch, in m for 1 m/s^2.
fn response() -> f64 {
    1.0 / (1.0 - RATE * RATE).hypot(DAMPING * RATE)
}

/// Speed of the impact and trace of the map over a period, of the motion with the slower impact; `amplitude`
/// in m/s^2.
fn one_impact(amplitude: f64) -> (f64, f64) {
    let (decay, period) = (0.5 * DAMPING, TAU / RATE);
    let damped = (1.0 - decay * decay).sqrt();
    let (sine, cosine) = (damped * period).sin_cos();
    let kept = (-decay * period).exp();
    // of a free swing over a period: [[a, b], [c, d]]
    let (a, d) = (kept * (cosine + decay / damped * sine), kept * (cosine - decay / damped * sine));
    let (b, c) = (kept * sine / damped, -kept * sine / damped);
    // speeds of the decaying swing that begins and ends at 1, after and before an impact
    let after = (1.0 - a) / b;
    let before = c + d * after;
    let reach = amplitude * response();
    let slope = (after + RESTITUTION * before) / (1.0 + RESTITUTION);
    let phase = (-slope / (reach * RATE.hypot(slope))).acos() - slope.atan2(RATE);
    let (p, rate) = (reach * phase.sin(), RATE * reach * phase.cos());
    let (v_out, v_in) = (after * (1.0 - p) + rate, before * (1.0 - p) + rate);
    near_relative(v_out, -RESTITUTION * v_in, 1e-9);
    let push = (1.0 - RATE * RATE) * p + DAMPING * rate - 1.0;
    let pulls = RESTITUTION * (push - DAMPING * v_in) + (push - DAMPING * v_out);
    (v_in, -RESTITUTION * (a + d) + b * pulls / v_in)
}

pub fn impact_oscillator(text: &mut Text) {
    let at = |amplitude: f64, more: &[&str]| {
        let change = format!("excitation.amplitude_g={amplitude:?}");
        settled("impact-oscillator", &[&[change.as_str()], more].concat())
    };
    near_relative(preset("impact-oscillator", &[]).single_sine().unwrap().1, RATE, 1e-12);
    text.says("driven at 0.7 of its own frequency, with one stop at 1 m");

    let grazing = 1.0 / (response() * STANDARD_GRAVITY);
    let (below, above) = (at(grazing - 1e-7, &["stops=None"]), at(grazing + 1e-7, &["stops=None"]));
    assert!(below.range.unwrap().1 < 1.0 && above.range.unwrap().1 > 1.0);
    text.says(&format!("reaches it at {grazing:.6} g"));

    let summary = at(0.056, &[]);
    assert_eq!((summary.period, summary.settled, summary.impacts), (Some(1), Some(true), summary.periods));
    let speed = summary.impact_speed_max.unwrap();
    near_relative(speed, one_impact(0.056 * STANDARD_GRAVITY).0, 1e-8);
    text.says(&format!(
        "At 0.056 g, as set here, there is 1 impact in each period, with {:.0} mm/s",
        1e3 * speed
    ));

    // a multiplier of -1: the trace is minus the sum of 1 and the determinant
    let determinant = RESTITUTION * RESTITUTION * (-DAMPING * TAU / RATE).exp();
    let excess = |g: f64| one_impact(g * STANDARD_GRAVITY).1 + 1.0 + determinant;
    assert!(excess(0.0545) < 0.0 && excess(0.056) > 0.0);
    let flip = bisect(0.0545, 0.056, 60, |g| excess(g) < 0.0).0;
    let (below, above) = (at(flip - 5e-5, &[]), at(flip + 5e-5, &[]));
    assert_eq!((below.period, above.period), (Some(2), Some(1)));
    text.says(&format!("loses its stability at {flip:.6} g"));
    let summary = at(0.0549, &[]);
    assert_eq!((summary.period, summary.settled, summary.impacts), (Some(2), Some(true), summary.periods));
    text.says("at 0.0549 g a harder and a lighter impact alternate, 2 in 2 periods");
    assert_eq!(at(0.05475, &[]).period, Some(4));
    text.says("At 0.05475 g the motion repeats after 4 periods");
    assert_eq!(at(0.0545, &[]).period, None);
    text.says("at 0.0545 g no period is found");
    let summary = at(0.054, &[]);
    assert_eq!((summary.period, 8 * summary.impacts), (Some(8), 5 * summary.periods));
    text.says("at 0.0540 g there are 5 impacts in 8 periods");

    let summary = at(0.0538, &[]);
    assert_eq!((summary.period, 2 * summary.impacts), (Some(2), summary.periods));
    let lag = -(DAMPING * RATE).atan2(1.0 - RATE * RATE);
    let reach = 0.0538 * STANDARD_GRAVITY * response();
    let start =
        format!("start=At(x_mm: {:?}, v_m_per_s: {:?})", -1e3 * reach * lag.sin(), -RATE * reach * lag.cos());
    assert_eq!(at(0.0538, &[&start]).total_impacts, 0);
    text.says("At 0.0538 g the mass hits the stop once in 2 periods from rest, and never if it starts");
    assert_eq!(at(0.053, &[]).impacts, 0);
    text.says("At 0.0530 g it does not touch");
}
