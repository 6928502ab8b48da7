//! Lyapunov exponents against exact answers: linear oscillators, wells, the saddle, impacts, rest and chaos.

mod command;
mod stiff;

use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

use interwell::dynamics::{EventKind, Jacobian, Model, STANDARD_GRAVITY};
use interwell_studies::study::{ExponentOptions, Lyapunov, NoExponents, average_exponents, exponents};

use crate::support::{build, documented, model, near, near_relative, of_kind, preset, run, unit_well};

static NEVER: AtomicBool = AtomicBool::new(false);

fn of(model: &Model) -> Lyapunov {
    exponents(model, &ExponentOptions::default(), &NEVER).unwrap()
}

fn over(model: &Model, periods: u32) -> Lyapunov {
    exponents(model, &ExponentOptions { periods, ..ExponentOptions::default() }, &NEVER).unwrap()
}

/// Asserts both exponents of a periodic motion, and their sum, relatively.
#[track_caller]
fn both(found: &Lyapunov, first: f64, second: f64, bound: f64) {
    near_relative(found.first.per_s, first, bound);
    near_relative(found.second.per_s, second, bound);
    assert_eq!((found.first.error, found.second.error), (0.0, 0.0));
    near_relative(found.exact_sum.unwrap(), first + second, bound);
}

/// A linear oscillator with a natural frequency of 1 rad/s, shaken at 0.2 Hz.
fn oscillator(ratio: f64, rest: &str) -> Model {
    model(&format!(
        "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, 1]), damping: Ratio({ratio:?}), \
         excitation: Sine(frequency_hz: 0.2, amplitude_g: 0.02), run: (duration_s: 100, tolerance: 1e-12), \
         start: At(x_mm: 100, v_m_per_s: 0.2) {rest}"
    ))
}

#[test]
fn a_linear_oscillator_loses_as_much_both_ways() {
    // exp((-z w +- i w sqrt(1 - z^2)) T)
    for ratio in [0.02, 0.1, 0.5, 0.9] {
        let found = of(&oscillator(ratio, ""));
        both(&found, -ratio, -ratio, 1e-12);
        near_relative(found.sum, -2.0 * ratio, 1e-11);
        assert_eq!((found.period, found.dimension(), found.is_irregular()), (Some(1), 0.0, false));
    }
}

#[test]
fn the_second_exponent_keeps_its_digits_hundreds_of_powers_of_e_below_the_first() {
    for ratio in [1.5_f64, 5.0, 40.0, 400.0] {
        let root = (ratio * ratio - 1.0).sqrt();
        // (z + root) (z - root) = 1, without cancellation
        let found = of(&oscillator(ratio, ""));
        both(&found, -1.0 / (ratio + root), -(ratio + root), 1e-9);
        near_relative(found.sum, -2.0 * ratio, 1e-8);
    }
    // where a 512th of a period leaves less than rounding of an area, the derivatives do not tell how much
    assert!(of(&oscillator(4000.0, "")).sum.is_nan());
}

#[test]
fn wells_and_saddle_without_a_drive() {
    let at = |c: f64, x_mm: f64| {
        let rest = format!(
            "damping: Coefficient(c_n_s_per_m: {c:?}), start: At(x_mm: {x_mm:?}, v_m_per_s: 0), \
             run: (duration_s: 10, tolerance: 1e-12)"
        );
        of(&unit_well(&rest))
    };
    // In a well w^2 = 2: at rest from the first, and after a swing that dies away.
    for x_mm in [1000.0, 1200.0] {
        both(&at(0.2, x_mm), -0.1, -0.1, 1e-11);
        let root = 2.0_f64.sqrt();
        both(&at(4.0, x_mm), root - 2.0, -2.0 - root, 1e-9);
    }
    // At the barrier w^2 = -1.
    for c in [0.0_f64, 0.2, 3.0] {
        let root = (0.25 * c * c + 1.0).sqrt();
        let found = at(c, 0.0);
        near_relative(found.first.per_s, root - 0.5 * c, 1e-11);
        near_relative(found.second.per_s, -root - 0.5 * c, 1e-11);
        let dimension = if c == 0.0 { 2.0 } else { 1.0 + (root - 0.5 * c) / (root + 0.5 * c) };
        near(found.dimension(), dimension, 1e-11);
        assert!(!found.is_irregular(), "it stands still");
    }
}

#[test]
fn both_exponents_of_a_motion_with_an_impact_in_every_period() {
    // An oscillator with one stop at x = -d (Shaw and Holmes 1983). The map over a period after an impact is
    // the saltation matrix of the impact, [-e, 0; (a_out + e a_in)/v_in, -e] with the accelerations before
    // and after it, after a period of free oscillation.
    let (ratio, restitution, amplitude) = (0.05_f64, 0.6, 0.05);
    for (frequency, d_mm) in [(0.2, 1.0), (0.25, 100.0)] {
        let model = model(&format!(
            "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, 1]), damping: Ratio({ratio:?}), \
             excitation: Sine(frequency_hz: {frequency:?}, amplitude_g: {amplitude:?}), \
             stops: Uneven(left_mm: {d_mm:?}, restitution_left: {restitution:?}), \
             start: At(x_mm: 300, v_m_per_s: 0), run: (duration_s: 2000, settle_s: 1800, tolerance: 1e-13)"
        ));
        let found = of(&model);
        assert_eq!(found.period, Some(1));
        let run = run(&model);
        let impact = *of_kind(&run, EventKind::Impact).last().unwrap();
        assert_eq!((run.summary.impacts, run.summary.rests), (run.summary.periods, 0), "one in every period");

        let period = 1.0 / frequency;
        let w = (1.0 - ratio * ratio).sqrt();
        let (decay, (sine, cosine)) = ((-ratio * period).exp(), (w * period).sin_cos());
        let free = Jacobian::mechanical([
            [decay * (cosine + ratio / w * sine), decay * sine / w],
            [-decay * sine / w, decay * (cosine - ratio / w * sine)],
        ]);
        let base = amplitude * STANDARD_GRAVITY * (TAU * frequency * impact.t).sin();
        let acceleration = |v: f64| d_mm * 1e-3 - 2.0 * ratio * v - base;
        let (before, after) = (acceleration(impact.v_in), acceleration(impact.v_out));
        let turned = (after + restitution * before) / impact.v_in;
        let saltation = Jacobian::mechanical([[-restitution, 0.0], [turned, -restitution]]);
        let determinant = (-2.0 * ratio * period).exp() * restitution * restitution;
        let multipliers = saltation.after(&free).multipliers(determinant);
        let rate = |place: usize| multipliers[place].magnitude().ln() / period;
        let [first, second] = [rate(0), rate(1)];
        both(&found, first, second, 1e-9);
        near_relative(found.exact_sum.unwrap(), -2.0 * ratio + 2.0 * restitution.ln() * frequency, 1e-14);
        near_relative(found.sum, found.exact_sum.unwrap(), 1e-10);
    }
}

#[test]
fn a_rest_leaves_nothing() {
    for model in [
        preset("paper", &["excitation.amplitude_g=1"]),
        // at rest throughout: pressed by the mechanism, and by gravity
        preset("paper", &["excitation.amplitude_g=0.1"]),
        preset("paper", &["excitation=None"]),
        preset("bouncing-ball", &[]),
    ] {
        let found = of(&model);
        assert!(found.rests() && found.period.is_some(), "{found:?}");
        let nothing = f64::NEG_INFINITY;
        assert_eq!((found.first.per_s, found.second.per_s), (nothing, nothing));
        assert_eq!((found.sum, found.exact_sum), (nothing, Some(nothing)));
        assert_eq!((found.first.error, found.second.error, found.dimension()), (0.0, 0.0, 0.0));
        assert!(!found.is_irregular());
    }
    // averages say the same
    let model = preset("paper", &["excitation.amplitude_g=1"]);
    assert!(average_exponents(&model, (1e-3, 0.1), 0.2, 50, &NEVER).unwrap().rests());
}

#[test]
fn the_sum_is_that_of_damping_and_impacts_on_chaos_too() {
    for (model, bound) in [
        (preset("duffing-chaos", &["run.tolerance=1e-13"]), 1e-12),
        (preset("paper-unconstrained", &["excitation.amplitude_g=1.5", "run.tolerance=1e-13"]), 1e-9),
        (preset("first-look", &["run.tolerance=1e-13"]), 1e-10),
        (preset("nominal-cubic", IMPACTS), 1e-9),
    ] {
        let found = over(&model, 1000);
        println!("{:?} {:e}", found, found.sum / found.exact_sum.unwrap() - 1.0);
        near_relative(found.sum, found.exact_sum.unwrap(), bound);
        near_relative(found.first.per_s + found.second.per_s, found.exact_sum.unwrap(), 1e-14);
        assert!(found.is_irregular() && found.first.per_s > 8.0 * found.first.error, "{found:?}");
        assert!(found.dimension() > 1.0 && found.dimension() < 2.0);
        let damped = -model.damping() / model.mass();
        match model.stops() {
            None => near_relative(found.exact_sum.unwrap(), damped, 1e-12),
            Some(_) => assert!(found.exact_sum.unwrap() < 1.1 * damped, "impacts take their part"),
        }
    }
}

/// In a period in which the mass lingers near the top of the barrier changes grow up to 1e6-fold; in 1000
/// periods from one of these starts or another there are some.
#[test]
fn the_sum_keeps_its_digits_where_the_mass_lingers_on_a_barrier() {
    for k in 0..8 {
        let tolerance = format!("run.tolerance={:e}", 1e-13 * (1.0 + 1e-3 * f64::from(k)));
        let model = preset("paper-unconstrained", &["excitation.amplitude_g=1.5", &tolerance]);
        let start = (7e-3, 0.01 * f64::from(k));
        let found = average_exponents(&model, start, 0.0, 1000, &NEVER).unwrap();
        near_relative(found.sum, found.exact_sum.unwrap(), 1e-11);
    }
}

/// Irregular motion with impacts on both sides.
const IMPACTS: &[&str] = &[
    "stops=Rigid(travel_limit_mm: 7, restitution: 0.9)",
    "excitation.amplitude_g=1.5",
    "run.duration_s=100",
    "run.settle_s=50",
    "run.tolerance=1e-13",
];

/// The first exponent of x'' + c x' + f(x) = a sin t and its standard error, over so many periods after 200,
/// by means that share nothing with the program: motion and change by the method of Runge and Kutta with 500
/// steps a period, the error from the means of batches.
fn by_runge_kutta(f: [f64; 2], (c, a): (f64, f64), periods: usize) -> (f64, f64) {
    let slope = |t: f64, [x, v, dx, dv]: [f64; 4]| {
        let stiffness = f[0] + 3.0 * f[1] * x * x;
        [v, a * t.sin() - c * v - f[0] * x - f[1] * x * x * x, dv, -c * dv - stiffness * dx]
    };
    let step = TAU / 500.0;
    let mut y = [0.5, 0.0, 1.0, 0.0];
    let mut growth = Vec::new();
    for number in 0..200 + periods {
        for i in 0..500 {
            let t = f64::from(i) * step;
            let plus = |k: [f64; 4], part: f64| std::array::from_fn(|i| y[i] + part * step * k[i]);
            let k1 = slope(t, y);
            let k2 = slope(t + 0.5 * step, plus(k1, 0.5));
            let k3 = slope(t + 0.5 * step, plus(k2, 0.5));
            let k4 = slope(t + step, plus(k3, 1.0));
            y = std::array::from_fn(|i| y[i] + step / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        }
        let size = y[2].hypot(y[3]);
        y = [y[0], y[1], y[2] / size, y[3] / size];
        if number >= 200 {
            growth.push(size.ln() / TAU);
        }
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let means: Vec<f64> = growth.chunks(periods / 50).map(mean).collect();
    let whole = mean(&growth);
    let squares: f64 = means.iter().map(|value| (value - whole) * (value - whole)).sum();
    let count = means.len() as f64;
    (whole, (squares / count / (count - 1.0)).sqrt())
}

#[test]
fn exponents_of_forced_oscillators_are_those_of_another_integrator() {
    // the strange attractors of Ueda (1979) and of the double well (Holmes 1979)
    for (title, f, c, force) in
        [("Hard spring of Ueda", [0.0, 1.0], 0.05, 7.5), ("Double well of Holmes", [-1.0, 1.0], 0.25, 0.4)]
    {
        let model = build(&documented(title));
        let found = over(&model, 20_000);
        let (other, error) = by_runge_kutta(f, (c, force), 20_000);
        println!("{other} +- {error}, {found:?}");
        assert!(found.first.error < 2e-3 && error < 2e-3 && other > 0.05);
        near(found.first.per_s, other, 4.0 * found.first.error.hypot(error));
        near(found.dimension(), 1.0 + other / (c + other), 0.01);
        near_relative(found.first.per_s + found.second.per_s, -c, 1e-13);
    }
}

#[test]
fn an_average_along_a_periodic_motion_tends_to_its_multipliers() {
    // Period 5; the sum of what is left after the first vector has turned is bounded.
    let model = preset("duffing", &["run.tolerance=1e-12"]);
    let exact = of(&model);
    assert_eq!(exact.period, Some(5));
    assert!(exact.first.per_s > exact.second.per_s);
    let settled = run(&model).summary;
    let phase = model.drive_phase(settled.window.1).unwrap();
    let start = (settled.final_x, settled.final_v);
    let found = average_exponents(&model, start, phase, 1000, &NEVER).unwrap();
    near(found.first.per_s, exact.first.per_s, 1e-8);
    near(found.second.per_s, exact.second.per_s, 1e-8);
    assert!(found.period.is_none() && !found.is_irregular() && found.dimension() == 0.0);
}

#[test]
fn growth_in_proportion_to_time_is_not_irregular() {
    // Without any loss neighbours of different energy part as time goes on, and no faster.
    let box_ = of(&preset("elastic-box", &[]));
    assert_eq!((box_.sum, box_.exact_sum, box_.dimension()), (0.0, Some(0.0), 2.0));
    let swing =
        of(&unit_well("start: At(x_mm: 1500, v_m_per_s: 0), run: (duration_s: 20, tolerance: 1e-12)"));
    near(swing.sum, 0.0, 1e-11);
    for found in [box_, swing] {
        assert!(found.period.is_none() && found.first.per_s < 0.02 && !found.is_irregular(), "{found:?}");
        near(found.first.per_s + found.second.per_s, 0.0, 1e-15);
    }
}

#[test]
fn compliant_stops_have_no_exact_sum() {
    let stops = "stops=Hertz(travel_limit_mm: 1.5, stiffness_n_per_m1_5: 1e9, loss_s_per_m: 2)";
    let found = over(&preset("paper", &[stops, "run.tolerance=1e-12"]), 200);
    assert_eq!(found.exact_sum, None);
    near_relative(found.first.per_s + found.second.per_s, found.sum, 1e-12);
    // each impact takes more than damping alone
    assert!(found.is_irregular() && found.sum < -4.4, "{found:?}");
}

#[test]
fn what_has_no_exponents_says_why() {
    for drive in [
        "Noise(rms_g: 1, low_hz: 1, high_hz: 9, seed: 1)",
        "Chirp(from_hz: 1, to_hz: 9, over_s: 3, amplitude_g: 1)",
        "AmplitudeRamp(frequency_hz: 3, from_g: 0, to_g: 1, over_s: 5)",
    ] {
        let model = preset("paper", &[&format!("excitation={drive}")]);
        let problem = exponents(&model, &ExponentOptions::default(), &NEVER);
        assert_eq!(problem, Err(NoExponents::NoPeriod), "{drive}");
    }
    let told = AtomicBool::new(true);
    for name in ["duffing-chaos", "elastic-box"] {
        let model = preset(name, &[]);
        assert_eq!(exponents(&model, &ExponentOptions::default(), &told), Err(NoExponents::Cancelled));
        assert_eq!(average_exponents(&model, model.start(), 0.0, 10, &told), Err(NoExponents::Cancelled));
    }
    let far = preset("paper", &["stops=None", "excitation.amplitude_g=40"]);
    let problem = exponents(&far, &ExponentOptions::default(), &NEVER).unwrap_err();
    assert!(matches!(problem, NoExponents::EndedEarly(_)), "{problem:?}");
    assert!(problem.to_string().contains("left_table"), "{problem}");
}
