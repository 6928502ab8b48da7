//! Melnikov's threshold against closed forms, for any units, place and way of writing a curve.

use std::f64::consts::{PI, TAU};

use interwell::dynamics::Model;
use interwell::questions::{Progress, Simulation, Threshold};
use interwell_studies::study::melnikov_threshold;

use crate::support::{Draw, build, documented, model, near_relative};

/// The threshold in m/s^2 of m x'' + c x' - k x + a x^3 = -m A sin(w t), from
/// 4 d cosh(pi w/2)/(3 sqrt(2) pi w) in the units of the oscillator (Guckenheimer and Holmes 1983, section
/// 4.5).
fn of_duffing(mass: f64, damping: f64, linear: f64, cubic: f64, angular: f64) -> f64 {
    let rate = (linear / mass).sqrt();
    let (damping, angular) = (damping / (mass * rate), angular / rate);
    let threshold = 4.0 * damping * (0.5 * PI * angular).cosh() / (3.0 * 2_f64.sqrt() * PI * angular);
    threshold * linear * (linear / cubic).sqrt() / mass
}

fn with_force(mass: f64, damping: f64, force: &str, rest: &str) -> Model {
    model(&format!(
        "mass_g: {:?}, mechanism: {force}, damping: Coefficient(c_n_s_per_m: {damping:?}), \
         excitation: Sine(frequency_hz: 1, amplitude_g: 0), run: (duration_s: 1), {rest}",
        1e3 * mass
    ))
}

#[test]
fn it_is_that_of_the_duffing_oscillator_to_eight_digits() {
    let mut draw = Draw(1);
    for _ in 0..60 {
        let mass = 10_f64.powf(draw.between(-4.0, 1.0));
        let linear = 10_f64.powf(draw.between(-2.0, 4.0));
        let cubic = 10_f64.powf(draw.between(-2.0, 8.0));
        let damping = 10_f64.powf(draw.between(-4.0, 0.0)) * (linear * mass).sqrt();
        let angular = draw.between(0.05, 6.0) * (linear / mass).sqrt();
        let exact = of_duffing(mass, damping, linear, cubic, angular);
        let cubic_force = format!("Cubic(linear_n_per_m: {:?}, cubic_n_per_m3: {cubic:?})", -linear);
        for start in ["", "start: At(x_mm: -1e-3, v_m_per_s: 0)"] {
            let found = melnikov_threshold(&with_force(mass, damping, &cubic_force, start), angular / TAU);
            near_relative(found.unwrap(), exact, 1e-8);
        }
        // the same curve beside x = 0
        let well = (linear / cubic).sqrt();
        let shift = draw.between(-0.6, 0.6) * well;
        let coefficients = [
            linear * shift - cubic * shift.powi(3),
            3.0 * cubic * shift * shift - linear,
            -3.0 * cubic * shift,
            cubic,
        ];
        let shifted = format!("Polynomial(coefficients_si: {coefficients:?})");
        let found = melnikov_threshold(&with_force(mass, damping, &shifted, ""), angular / TAU);
        near_relative(found.unwrap(), exact, 1e-8);
        // the same curve in pieces
        let [a, b] = [draw.between(-1.0, 0.2), draw.between(0.3, 1.3)].map(|share| share * well);
        let piece = |origin: f64| {
            let at = |x: f64| {
                [cubic * x.powi(3) - linear * x, 3.0 * cubic * x * x - linear, 3.0 * cubic * x, cubic]
            };
            format!("(origin_m: {origin:?}, coefficients_si: {:?})", at(origin))
        };
        let pieces = format!(
            "Pieces(ends_m: [-inf, {a:?}, {b:?}, inf], pieces: [{}, {}, {}])",
            piece(a),
            piece(0.0),
            piece(b)
        );
        let found = melnikov_threshold(&with_force(mass, damping, &pieces, ""), angular / TAU);
        near_relative(found.unwrap(), exact, 1e-8);
    }
}

#[test]
fn each_well_of_an_asymmetric_curve_has_its_own() {
    // left of the barrier at 1 m the force x - x^2, whose threshold is d sinh(pi w)/(5 pi w^2) (Thompson
    // 1989); right of it a half of the Duffing oscillator about that point
    let force = "Pieces(ends_m: [-inf, 1, inf], pieces: [(coefficients_si: [0, 1, -1]), \
                 (origin_m: 1, coefficients_si: [0, -1, 0, 1])])";
    let mut draw = Draw(2);
    for _ in 0..20 {
        let (damping, angular) = (draw.between(0.01, 0.3), draw.between(0.2, 3.0));
        let left = with_force(1.0, damping, force, "start: At(x_mm: 0, v_m_per_s: 0)");
        let exact = damping * (PI * angular).sinh() / (5.0 * PI * angular * angular);
        near_relative(melnikov_threshold(&left, angular / TAU).unwrap(), exact, 1e-8);
        let right = with_force(1.0, damping, force, "");
        let exact = of_duffing(1.0, damping, 1.0, 1.0, angular);
        near_relative(melnikov_threshold(&right, angular / TAU).unwrap(), exact, 1e-8);
    }
}

#[test]
fn it_is_left_out_where_it_does_not_apply() {
    let duffing = "Cubic(linear_n_per_m: -1, cubic_n_per_m3: 1)";
    let of = |damping: f64, force: &str, rest: &str, frequency: f64| {
        melnikov_threshold(&with_force(1.0, damping, force, rest), frequency)
    };
    assert!(of(0.1, duffing, "", 0.2).is_some());
    // the orbit turns at sqrt(2) m
    let stops = |mm: f64| format!("stops: Rigid(travel_limit_mm: {mm}, restitution: 0.5)");
    assert_eq!(of(0.1, duffing, &stops(1420.0), 0.2), of(0.1, duffing, "", 0.2));
    assert_eq!(of(0.1, duffing, &stops(1410.0), 0.2), None);
    assert_eq!(of(0.0, duffing, "", 0.2), None);
    assert_eq!(of(0.1, duffing, "", 3.0), None, "the drive is too fast");
    // one well; a corner at the top; a table that ends below the height of the barrier
    assert_eq!(of(0.1, "Linear(n_per_m: 1)", "", 0.2), None);
    let corner = "Pieces(ends_m: [-inf, 0, inf], pieces: [(coefficients_si: [0, -1, 0, 1]), \
                  (coefficients_si: [0, -2, 0, 1])])";
    assert_eq!(of(0.1, corner, "", 0.2), None);
    let short = "Pieces(ends_m: [-1.3, 1.3], pieces: [(coefficients_si: [0, -1, 0, 1])])";
    assert_eq!(of(0.1, short, "", 0.2), None);
}

/// x'' + g x' - x (1 - x^2)/2 = f cos(w t): f = sqrt(2) g cosh(pi w/sqrt(2))/(3 pi w).
fn of_moon_and_holmes(damping: f64, angular: f64) -> f64 {
    2_f64.sqrt() * damping * (PI * angular / 2_f64.sqrt()).cosh() / (3.0 * PI * angular)
}

#[test]
fn the_beam_of_moon_and_holmes_has_its_own_as_a_force() {
    let document = documented("Magnetoelastic beam of Moon and Holmes");
    let exact = of_moon_and_holmes(0.0168, 1.0);
    assert!(include_str!("../../../docs/scene.md").contains(&format!("here {exact:.7};")), "{exact}");
    let mut draw = Draw(3);
    let mut drawn = vec![(0.0168, 1.0)];
    drawn.extend((0..20).map(|_| (draw.between(0.001, 0.3), draw.between(0.2, 4.0))));
    for (damping, angular) in drawn {
        let mut document = document.clone();
        document.set(&format!("damping.c_n_s_per_m={damping:?}")).unwrap();
        document.set(&format!("excitation.frequency_rad_per_s={angular:?}")).unwrap();
        let drive = document.scene.harmonic().unwrap();
        let found = melnikov_threshold(&build(&document), drive.frequency_hz).unwrap();
        near_relative(drive.amplitude_of(found), of_moon_and_holmes(damping, angular), 1e-8);
    }
}

#[test]
fn of_a_force_it_is_in_newtons_for_the_mass_of_each_cell() {
    let (linear, cubic, damping, angular) = (1.0, 1.0, 0.1, 0.9);
    let scene = format!(
        "(title: \"\", mass_g: 1000, mechanism: Cubic(linear_n_per_m: {:?}, cubic_n_per_m3: {cubic:?}), \
         damping: Coefficient(c_n_s_per_m: {damping:?}), run: (duration_s: 60), \
         excitation: Force(amplitude_n: 0, frequency_rad_per_s: {angular:?}))",
        -linear
    );
    let masses = [400.0, 1000.0, 2500.0];
    let simulation = Simulation::from_text("force", &scene).unwrap();
    let question = Threshold {
        over: vec![("mass_g".to_owned(), masses.to_vec())],
        field: Some("excitation.amplitude_n=0:0.01:0.005".to_owned()),
        melnikov: true,
        ..Threshold::default()
    };
    let table = question.run(&simulation, &Progress::none()).unwrap();
    let found = table.numbers("melnikov_n").unwrap();
    for (mass_g, found) in masses.iter().zip(found) {
        let mass = mass_g / 1e3;
        near_relative(*found, mass * of_duffing(mass, damping, linear, cubic, angular), 1e-8);
    }
}
