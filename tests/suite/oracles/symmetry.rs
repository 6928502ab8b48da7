//! Bits of mirrored scenes.

use interwell::dynamics::{Model, Run};

use crate::properties::mirror::assert_mirrored;
use crate::support::*;

/// Runs both, sampled 200 times, and asserts that one mirrors the other and that something moved.
#[track_caller]
fn mirror(a: &Model, b: &Model) -> Run {
    let times = every(a.duration() / 200.0, 199);
    let (a, b) = (run_at(a, &times), run_at(b, &times));
    assert_mirrored(&a, &b);
    assert!(a.summary.travel().unwrap() > 0.0);
    a
}

#[test]
fn chaos_is_mirrored_to_the_last_bit() {
    // (x, v, a_b) -> (-x, -v, -a_b) on 300 periods of chaos, where one bit would show: by a negative
    // amplitude, and by a phase half a turn on.
    let start = ["start.x_mm=300", "start.v_m_per_s=0.4"];
    let opposite = ["start.x_mm=-300", "start.v_m_per_s=-0.4"];
    let base = preset("duffing-chaos", &start);
    let amplitude = "excitation.amplitude_g=-0.050985810648896415";
    let run = mirror(&base, &preset("duffing-chaos", &[&opposite[..], &[amplitude]].concat()));
    assert!(run.summary.total_crossings > 100);
    mirror(&base, &preset("duffing-chaos", &[&opposite[..], &["excitation.phase_deg=90"]].concat()));
    mirror(&base, &preset("duffing-chaos", &[&opposite[..], &["excitation.phase_deg=-270"]].concat()));
}

#[test]
fn half_a_turn_of_phase_is_a_negative_amplitude() {
    // sin(x + 180 degrees) = -sin x, exactly, for any phase whose sum is exact; and whole turns do nothing.
    for phase in [0.0, 30.0, 90.0, 137.25, 251.5] {
        let with = |phase: f64, amplitude: f64| {
            let change =
                format!("excitation=Sine(frequency_hz: 3, amplitude_g: {amplitude:?}, phase_deg: {phase:?})");
            run(&preset("nominal-cubic", &[&change]))
        };
        let base = with(phase, 1.5);
        assert!(base.summary.total_impacts > 100);
        same_bits(&base, &with(phase + 180.0, -1.5));
        same_bits(&base, &with(phase - 180.0, -1.5));
        same_bits(&base, &with(phase + 720.0, 1.5));
    }
}

#[test]
fn stops_chatter_and_rest_are_mirrored_to_the_last_bit() {
    // P2 from the right stop, and with the opposite drive from the left one; the same with a ramp and a sum.
    for (drive, opposite) in [
        ("Sine(frequency_hz: 3, amplitude_g: 1.5)", "Sine(frequency_hz: 3, amplitude_g: -1.5)"),
        (
            "AmplitudeRamp(frequency_hz: 3, from_g: 0.5, to_g: 2, over_s: 7.7)",
            "AmplitudeRamp(frequency_hz: 3, from_g: -0.5, to_g: -2, over_s: 7.7)",
        ),
        (
            "Sum([Constant(accel_g: 0.1), Sine(frequency_hz: 3, amplitude_g: 1.5), Sine(frequency_hz: 7, \
             amplitude_g: 0.3, phase_deg: 45)])",
            "Sum([Constant(accel_g: -0.1), Sine(frequency_hz: 3, amplitude_g: -1.5), Sine(frequency_hz: 7, \
             amplitude_g: 0.3, phase_deg: 225)])",
        ),
    ] {
        let scene = |x: &str, drive: &str| {
            preset(
                "nominal-cubic",
                &[&format!("start=At(x_mm: {x}, v_m_per_s: 0)"), &format!("excitation={drive}")],
            )
        };
        let run = mirror(&scene("4", drive), &scene("-4", opposite));
        assert!(run.summary.total_impacts > 100 && run.summary.rests > 5);
    }
}

#[test]
fn uneven_stops_are_mirrored_to_the_last_bit() {
    // Left and right exchanged, one side open included.
    for (stops, exchanged) in [
        (
            "Uneven(left_mm: 3, right_mm: 5.5, restitution_left: 0.3, restitution_right: 0.8)",
            "Uneven(left_mm: 5.5, right_mm: 3, restitution_left: 0.8, restitution_right: 0.3)",
        ),
        ("Uneven(left_mm: 3, restitution_left: 0.6)", "Uneven(right_mm: 3, restitution_right: 0.6)"),
    ] {
        let scene = |stops: &str, sign: f64| {
            preset(
                "nominal-cubic",
                &[
                    &format!("stops={stops}"),
                    &format!("start=At(x_mm: {:?}, v_m_per_s: {:?})", 2.0 * sign, 0.3 * sign),
                    &format!("excitation.amplitude_g={:?}", 1.5 * sign),
                ],
            )
        };
        let run = mirror(&scene(stops, 1.0), &scene(exchanged, -1.0));
        assert!(run.summary.total_impacts > 20);
    }
}

#[test]
fn a_curve_of_many_pieces_is_mirrored_to_the_last_bit() {
    // The prototype, its table and its flexures, odd by structure, crossing the breaks, with and without
    // stops.
    let all = ["None", "Rigid(travel_limit_mm: 4, restitution: 0.36)"];
    for (name, stops) in ["paper", "paper-table"].into_iter().flat_map(|name| all.map(|stops| (name, stops)))
    {
        let scene = |sign: f64| {
            preset(
                name,
                &[
                    &format!("stops={stops}"),
                    &format!("start=At(x_mm: {:?}, v_m_per_s: {:?})", 3.9 * sign, -0.2 * sign),
                    &format!("excitation.amplitude_g={:?}", 1.6 * sign),
                ],
            )
        };
        let run = mirror(&scene(1.0), &scene(-1.0));
        assert!(run.summary.total_crossings > 5);
    }
}

#[test]
fn an_odd_polynomial_of_high_degree_is_mirrored_to_the_last_bit() {
    // Degree 7 with two wells; degree 4 is not odd, and its mirror image has the even coefficients negated.
    for (coefficients, image) in [
        ("[0, -40, 0, 5e5, 0, 4e9, 0, 1e13]", "[0, -40, 0, 5e5, 0, 4e9, 0, 1e13]"),
        ("[0.02, -40, 300, 8e5, 1e6]", "[-0.02, -40, -300, 8e5, -1e6]"),
    ] {
        let scene = |coefficients: &str, sign: f64| {
            model(&format!(
                "mass_g: 15.2, mechanism: Polynomial(coefficients_si: {coefficients}),
                 damping: Coefficient(c_n_s_per_m: 0.05), stops: Rigid(travel_limit_mm: 6, restitution: 0.7),
                 excitation: Sine(frequency_hz: 3, amplitude_g: {:?}),
                 start: At(x_mm: {:?}, v_m_per_s: {:?}), run: (duration_s: 10)",
                1.3 * sign,
                2.5 * sign,
                0.1 * sign
            ))
        };
        let run = mirror(&scene(coefficients, 1.0), &scene(image, -1.0));
        assert!(run.summary.total_impacts > 20);
    }
}

/// Three wells between two barriers that are equally near to x = 0: crossings are counted at the one on the
/// side of the start, or of the first push.
#[test]
fn of_two_equal_barriers_the_one_that_mirrors_is_taken() {
    let (near, far) = (2e-3_f64.powi(2), 5e-3_f64.powi(2));
    let stiffness = 100.0 / (near * far);
    let coefficients = [0.0, 100.0, 0.0, -stiffness * (near + far), 0.0, stiffness];
    let mut draw = Draw(3);
    let (mut sides, mut crossings) = ([0, 0], 0);
    for number in 0..60 {
        let x_mm = if number % 3 == 0 { 0.0 } else { draw.between(-6.0, 6.0) };
        let v = if number % 2 == 0 { 0.0 } else { draw.between(-0.1, 0.1) };
        let (amplitude, phase) = (draw.between(-1.5, 1.5), [0.0, 90.0, 37.0][number % 3]);
        let scene = |sign: f64| {
            model(&format!(
                "mass_g: 15, mechanism: Polynomial(coefficients_si: {coefficients:?}),
                 damping: Coefficient(c_n_s_per_m: 0.05), run: (duration_s: 3),
                 excitation: Sine(frequency_hz: 3, amplitude_g: {:?}, phase_deg: {phase}),
                 start: At(x_mm: {:?}, v_m_per_s: {:?})",
                amplitude * sign,
                x_mm * sign,
                v * sign
            ))
        };
        let level = scene(1.0).crossing_level().unwrap();
        sides[usize::from(level > 0.0)] += 1;
        assert!(x_mm == 0.0 || level.signum() == x_mm.signum());
        crossings += mirror(&scene(1.0), &scene(-1.0)).summary.total_crossings;
    }
    assert!(sides.iter().all(|count| *count > 15) && crossings > 100, "{sides:?} {crossings}");
}

/// A mass that stands on the barrier, or between two equal ones, is on neither side.
#[test]
fn a_mass_that_nothing_moves_off_the_middle_has_no_side() {
    for coefficients in ["[0, -40, 0, 5e5]", "[0, 40, 0, -5e6, 0, 1e11]"] {
        let scene = model(&format!(
            "mass_g: 15, mechanism: Polynomial(coefficients_si: {coefficients}), run: (duration_s: 1),
             start: At(x_mm: 0, v_m_per_s: 0)"
        ));
        let summary = run(&scene).summary;
        assert_eq!((summary.side, summary.regime.name(), summary.final_x), (None, "rest", 0.0));
    }
}
