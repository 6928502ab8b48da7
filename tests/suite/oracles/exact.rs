//! The closed forms themselves, against each other and against known values.

use interwell::numeric::{DoubleDouble, Number, Scalar};
use interwell_studies::study::accuracy::exact::{
    Coupled, Forcing, Oscillator, elliptic_k, exp, sin_cos, sine_turns,
};

fn dd(value: f64) -> DoubleDouble {
    DoubleDouble::of(value)
}

/// 20 g on 50 N/m with 0.08 N s/m, shaken, with a circuit.
fn coupled(coupling: f64, loss: f64) -> Coupled {
    let tone = (9.0, 7.0, 0.125);
    let (storage, loss) = (dd(0.5), dd(loss));
    Coupled { mass: 0.02, damping: 0.08, stiffness: 50.0, force: 0.0, coupling, storage, loss, tone }
}

fn apart(a: DoubleDouble, b: DoubleDouble) -> f64 {
    (a - b).abs().to_f64()
}

#[test]
fn uncoupled_it_is_the_oscillator_and_a_decay() {
    let tone = Forcing::Tone { amplitude: 9.0, growth: dd(0.0), frequency: 7.0, phase: 0.125 };
    let oscillator = Oscillator::new(0.02, 0.08, 50.0);
    let start = [dd(0.002), dd(-0.1), dd(0.3)];
    for t in [0.3, 1.7, 20.0] {
        let (x, v) = oscillator.state((start[0], start[1]), dd(0.1), dd(t), &[tone]);
        let found = coupled(0.0, 4.0).state(start, dd(0.1), dd(t));
        let state = start[2] * exp(-(dd(8.0) * (dd(t) - dd(0.1))));
        let errors = [apart(found[0], x), apart(found[1], v), apart(found[2], state)];
        assert!(errors.iter().all(|error| *error < 1e-26), "{t}: {errors:?}");
    }
}

#[test]
fn without_a_loss_it_is_a_spring() {
    // K^2/S is added to the stiffness; from x = 0 without a charge the state is K x/S
    let system = coupled(3.0, 0.0);
    let spring = Oscillator::new(0.02, 0.08, 50.0 + 18.0);
    let tone = Forcing::Tone { amplitude: 9.0, growth: dd(0.0), frequency: 7.0, phase: 0.125 };
    for t in [0.05, 1.0, 30.0] {
        let (x, v) = spring.state((dd(0.0), dd(0.4)), dd(0.0), dd(t), &[tone]);
        let found = system.state([dd(0.0), dd(0.4), dd(0.0)], dd(0.0), dd(t));
        let errors = [apart(found[0], x), apart(found[1], v), apart(found[2], dd(6.0) * x)];
        assert!(errors.iter().all(|error| *error < 1e-26), "{t}: {errors:?}");
    }
}

#[test]
fn a_fast_circuit_keeps_the_digits() {
    // time constant 0.1 us; two successive spans must give the state of the whole
    let system = coupled(3.0, 5e6);
    let start = [dd(0.002), dd(-0.1), dd(0.3)];
    let whole = system.state(start, dd(0.0), dd(2.0));
    let parts = system.state(system.state(start, dd(0.0), dd(0.7)), dd(0.7), dd(2.0));
    for (whole, part) in whole.into_iter().zip(parts) {
        assert!(apart(whole, part) < 1e-22 * whole.abs().to_f64().max(1e-6), "{whole:?} {part:?}");
    }
}

#[test]
fn exponentials_multiply_and_invert() {
    for x in [-300.0, -1.7, -1e-9, 0.0, 0.3, 1.0, 42.0, 600.0] {
        let product = exp(dd(x)) * exp(dd(-x));
        assert!((product - dd(1.0)).to_f64().abs() < 1e-28, "{x}");
        assert!((exp(dd(x)).to_f64() / x.exp() - 1.0).abs() < 4e-16, "{x}");
    }
    // e to 32 digits
    let e = dd(std::f64::consts::E) + dd(1.445_646_891_729_250_2e-16);
    assert!((exp(dd(1.0)) - e).to_f64().abs() < 1e-29);
}

#[test]
fn an_angle_comes_back_from_its_sine() {
    for angle in [0.0, 1e-9, 0.1, 0.125, 0.2, 0.249_999_999, 0.25] {
        let (sine, _) = sin_cos(DoubleDouble::tau() * dd(angle));
        let found = sine_turns(sine);
        // near a quarter turn the error is the root of the rounding of the sine
        let allowed = if angle < 0.249 { 1e-30 } else { 1e-15 };
        assert!((found - dd(angle)).to_f64().abs() < allowed, "{angle}");
    }
}

#[test]
fn the_elliptic_integral_at_its_ends() {
    // K(0) = pi/2; K near 1 is ln(4/k') to first order
    assert!((elliptic_k(dd(1.0)).to_f64() - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    let near = elliptic_k(dd(1e-24)).to_f64();
    assert!((near / (4e12_f64).ln() - 1.0).abs() < 1e-15, "{near}");
}
