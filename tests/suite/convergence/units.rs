//! One scene in several systems of units.

use interwell::dynamics::{EventKind, Model, Run};

use crate::support::*;

/// What a kilogram, a metre and a second of the scene as written become.
#[derive(Debug, Clone, Copy)]
struct Units {
    mass: f64,
    length: f64,
    time: f64,
}

/// A cubic well with wells at +-7 mm, 1 s long, in other units.
fn cubic(units: Units, stops: Option<(f64, f64)>, tolerance: f64) -> Model {
    let Units { mass: m, length: l, time: t } = units;
    let stops = stops.map_or("None".to_owned(), |(limit_mm, restitution)| {
        format!("Rigid(travel_limit_mm: {:?}, restitution: {restitution:?})", limit_mm * l)
    });
    model(&format!(
        "mass_g: {:?}, mechanism: Cubic(linear_n_per_m: {:?}, cubic_n_per_m3: {:?}),
         damping: Coefficient(c_n_s_per_m: {:?}), stops: {stops},
         excitation: Sine(frequency_hz: {:?}, amplitude_g: {:?}),
         start: At(x_mm: {:?}, v_m_per_s: 0), run: (duration_s: {:?}, settle_s: 0, tolerance: {tolerance:?})",
        15.2 * m,
        -40.0 * m / (t * t),
        816326.530612245 * m / (t * t * l * l),
        0.05 * m / t,
        3.0 / t,
        1.5 * l / (t * t),
        4.0 * l,
        t
    ))
}

fn scaled(units: Units, run: &Run) -> Vec<(EventKind, f64, f64)> {
    let speed = units.length / units.time;
    run.events.iter().map(|e| (e.kind, e.t / units.time, e.v_in / speed)).collect()
}

#[test]
fn units_do_not_matter() {
    // Mass, length and time each, and all together, in units of 1e-9 to 1e9: the same events at the same
    // times with the same speeds (s and m/s of the scene as written), to 5e-12; the same ledger to 1e-12; the
    // same steps, give or take two.
    let one = Units { mass: 1.0, length: 1.0, time: 1.0 };
    for stops in [Some((4.0, 0.36)), Some((5.5, 0.8)), None] {
        let base = run(&cubic(one, stops, 1e-12));
        assert!(base.summary.total_crossings > 2);
        let ledger = base.summary.ledger.unwrap();
        for factor in [1e-9, 1e-5, 1e-2, 37.0, 1e4, 1e9] {
            for units in [
                Units { mass: factor, ..one },
                Units { length: factor, ..one },
                Units { time: factor, ..one },
                Units { mass: factor, length: factor, time: 1.0 / factor },
                Units { mass: 1.0 / factor, length: factor, time: factor },
            ] {
                let converted = run(&cubic(units, stops, 1e-12));
                let (a, b) = (scaled(one, &base), scaled(units, &converted));
                assert_eq!(a.len(), b.len(), "{units:?}");
                for (a, b) in a.iter().zip(&b) {
                    assert_eq!(a.0, b.0, "{units:?}");
                    near(b.1, a.1, 5e-12);
                    near(b.2, a.2, 5e-12);
                }
                near(converted.summary.final_x / units.length, base.summary.final_x, 5e-13);
                let energy = units.mass * (units.length / units.time).powi(2);
                near_relative(converted.summary.ledger.unwrap().work_j / energy, ledger.work_j, 1e-12);
                near(converted.summary.steps as f64, base.summary.steps as f64, 2.0);
            }
        }
    }
}

#[test]
fn powers_of_two_change_no_digit() {
    // In units of 2^n of mass and time every number of the run is multiplied by a power of two, exactly.
    let one = Units { mass: 1.0, length: 1.0, time: 1.0 };
    for stops in [Some((4.0, 0.36)), None] {
        let base = run(&cubic(one, stops, 1e-9));
        for (mass, time) in [(2f64.powi(30), 1.0), (1.0, 2f64.powi(-30)), (2f64.powi(-7), 2f64.powi(20))] {
            let units = Units { mass, length: 1.0, time };
            let converted = run(&cubic(units, stops, 1e-9));
            assert_eq!(scaled(one, &base), scaled(units, &converted));
            assert_eq!(converted.summary.final_x, base.summary.final_x);
            assert_eq!(converted.summary.final_v * time, base.summary.final_v);
            assert_eq!(converted.summary.rms_velocity.unwrap() * time, base.summary.rms_velocity.unwrap());
            assert_eq!(converted.summary.steps, base.summary.steps);
        }
    }
}

#[test]
fn a_ball_without_a_scale_of_its_own_falls_alike_in_all_units() {
    // Constant force, no stiffness, no drive: the scales follow from acceleration and duration. e = 0.5 rests
    // after 3 times the fall, in any unit of length and time.
    for (length, time) in [(1e-9, 1.0), (1e9, 1.0), (1.0, 1e-9), (1.0, 1e8), (1e6, 1e-6), (1e-7, 1e-7)] {
        let g = 9.81 * length / (time * time);
        let model = model(&format!(
            "mass_g: 1000, mechanism: Polynomial(coefficients_si: [{g:?}]),
             stops: Uneven(left_mm: {:?}, restitution_left: 0.5), start: At(x_mm: 0, v_m_per_s: 0),
             run: (duration_s: {:?}, tolerance: 1e-12)",
            1e3 * length,
            5.0 * time
        ));
        let rests = of_kind(&run(&model), EventKind::Rest);
        assert_eq!(rests.len(), 1);
        near_relative(rests[0].t / time, 3.0 * (2.0 / 9.81f64).sqrt(), 1e-14);
    }
}
