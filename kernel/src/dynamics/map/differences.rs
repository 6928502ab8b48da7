//! The derivatives of the map against finite differences in double-double arithmetic, for every event.

use std::sync::Arc;

use super::{Jacobian, Kernel, StroboscopicMap};
use crate::dynamics::drive::form::with_drive;
use crate::dynamics::model::Model;
use crate::dynamics::result::{EventKind, MapState};
use crate::mechanics::{ForceCurve, Mechanism, Piece};
use crate::numeric::{DoubleDouble, Number, Scalar};
use crate::scene::{Document, Files};

/// The model of a unit mass with these fields.
fn model(fields: &str) -> Model {
    let run = "run: (duration_s: 1, tolerance: 1e-13)";
    let text = format!("(title: \"test\", mass_g: 1000, {fields}, start: At(x_mm: 0, v_m_per_s: 0), {run})");
    let document = Document::from_text("test", &text, Files::default()).unwrap();
    let mechanism = Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
    Model::build(&document.scene, Arc::new(mechanism)).unwrap()
}

/// The derivatives by central differences.
fn differences(model: &Model, seconds: f64, start: MapState) -> Jacobian {
    let map = StroboscopicMap::over(&model.with_tolerance(1e-29), seconds);
    let Kernel { equation, clock, drive } = Kernel::<DoubleDouble>::new(&map.model);
    let (units, dd) = (map.kernel_units(), DoubleDouble::of);
    // The error of a central difference is of the order of the square of its step.
    let step = dd(1e-9);
    let end = |by: [DoubleDouble; 3]| {
        let si = [start.x, start.v, start.electrical];
        let start = std::array::from_fn(|i| (dd(si[i]) + by[i]) * dd(units[i]));
        let span = map.span(&clock, (0.0, 1.0));
        with_drive!(&drive, drive => map.trace(&equation, clock, drive, start, span)).end
    };
    let zero = dd(0.0);
    let slope = |j: usize| -> [f64; 3] {
        let by = |step: DoubleDouble| std::array::from_fn(|i| if i == j { step } else { zero });
        let (above, below) = (end(by(step)), end(by(zero - step)));
        std::array::from_fn(|i| ((above[i] - below[i]) / (step + step) / dd(units[i])).to_f64())
    };
    match model.has_electrical_state() {
        true => {
            let columns = [slope(0), slope(1), slope(2)];
            Jacobian::with_circuit(std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i])))
        }
        false => {
            let columns = [slope(0), slope(1)];
            Jacobian::mechanical(std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i])))
        }
    }
}

/// Asserts that both agree to `share` of the largest derivative, and that the events in `must` happen.
#[track_caller]
fn agree(fields: &str, seconds: f64, start: (f64, f64), must: &[EventKind], share: f64) {
    agree_from(fields, seconds, start.into(), must, share);
}

/// The same from a state with that of a circuit.
#[track_caller]
fn agree_from(fields: &str, seconds: f64, start: MapState, must: &[EventKind], share: f64) {
    let model = model(fields);
    let (passage, jacobian) = StroboscopicMap::over(&model, seconds).pass_with_jacobian(start, 1);
    let other = differences(&model, seconds, start);
    for kind in must {
        assert!(passage.events.iter().any(|event| event.kind == *kind), "{kind:?} {:?}", passage.events);
    }
    // in units in which a state of the circuit has the energy of the mass at the same speed
    let unit = model.electrical_scale().map_or(1.0, |scale| scale / model.scales().speed);
    let (jacobian, other) = (jacobian.in_units([1.0, 1.0, unit]), other.in_units([1.0, 1.0, unit]));
    let largest = other.rows().as_flattened().iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    for (entry, other) in jacobian.rows().as_flattened().iter().zip(other.rows().as_flattened()) {
        assert!((entry - other).abs() <= share * largest, "{entry:e} {other:e}, of {largest:e}");
    }
    if let Some(exact) = passage.determinant {
        let rounding = share * largest.powi(jacobian.size() as i32);
        assert!((jacobian.determinant() - exact).abs() <= rounding, "{} {exact}", jacobian.determinant());
    }
}

const WELL: &str = "mechanism: Cubic(linear_n_per_m: -1, cubic_n_per_m3: 1)";
const SINE: &str = "excitation: Sine(frequency_hz: 0.2, amplitude_g: 0.05)";
const DAMPED: &str = "damping: Coefficient(c_n_s_per_m: 0.2)";

#[test]
fn free_flight() {
    agree(&format!("{WELL}, {SINE}, {DAMPED}"), 5.0, (0.4, -0.3), &[EventKind::Crossing], 1e-10);
    let tones =
        "Sum([Sine(frequency_hz: 0.2, amplitude_g: 0.05), Sine(frequency_hz: 0.3, amplitude_g: 0.02)])";
    agree(&format!("{WELL}, excitation: {tones}, {DAMPED}"), 10.0, (0.4, -0.3), &[], 1e-9);
}

#[test]
fn impacts() {
    let stops = "stops: Rigid(travel_limit_mm: 800, restitution: 0.6)";
    agree(&format!("{WELL}, {SINE}, {DAMPED}, {stops}"), 5.0, (0.1, 0.9), &[EventKind::Impact], 1e-10);
    let uneven = "stops: Uneven(right_mm: 500, restitution_right: 1)";
    agree(&format!("{WELL}, {SINE}, {uneven}"), 5.0, (0.1, 0.9), &[EventKind::Impact], 1e-10);
}

#[test]
fn a_plastic_impact_that_leaves_at_once() {
    // The constant acceleration of the base pulls the mass off its stop.
    let fields = format!(
        "{WELL}, excitation: Constant(accel_g: 0.2), {DAMPED}, \
         stops: Rigid(travel_limit_mm: 800, restitution: 0)"
    );
    agree(&fields, 1.5, (0.1, 1.9), &[EventKind::Impact], 1e-10);
}

#[test]
fn a_chatter_that_does_not_end_within_the_passage() {
    let fields = format!(
        "mechanism: Polynomial(coefficients_si: [-1]), {DAMPED}, \
         stops: Uneven(right_mm: 100, restitution_right: 0.7)"
    );
    agree(&fields, 1.3, (0.0, 0.2), &[EventKind::Impact], 1e-9);
}

#[test]
fn the_state_after_a_rest_does_not_depend_on_the_start() {
    let stops = "stops: Rigid(travel_limit_mm: 500, restitution: 0.3)";
    let weak = "excitation: Sine(frequency_hz: 0.2, amplitude_g: 0.04)";
    let model = model(&format!("{WELL}, {weak}, {DAMPED}, {stops}"));
    for seconds in [4.0, 6.0, 20.0] {
        let map = StroboscopicMap::over(&model, seconds);
        let (passage, jacobian) = map.pass_with_jacobian((0.3, 0.2), 1);
        assert!(passage.rests() > 0);
        assert!(jacobian.is_zero() && passage.determinant == Some(0.0), "{seconds}");
    }
}

#[test]
fn breaks_of_the_curve() {
    // straight lines through (-1, 0), (0, 0.1), (1, 0), (2, 3)
    let line = |origin: f64, force: f64, slope: f64| Piece {
        origin,
        coefficients: vec![force, slope],
        potential_at_origin: 0.0,
    };
    let pieces = vec![line(-1.0, 0.0, 3.0), line(0.0, 0.1, 0.1), line(0.0, 0.1, -0.1), line(1.0, 0.0, 3.0)];
    let infinity = f64::INFINITY;
    let domain = (-infinity, infinity);
    let curve = ForceCurve::from_pieces(pieces, vec![-1.0, 0.0, 1.0], domain, false, None).unwrap();
    let smooth = model(&format!("{WELL}, {SINE}, {DAMPED}"));
    let model = Model { mechanism: Arc::new(Mechanism::new(curve)), ..smooth };
    let start = (0.4, -0.9);
    let (passage, jacobian) = StroboscopicMap::over(&model, 6.0).pass_with_jacobian(start, 1);
    assert!(passage.crossings() == 2 && passage.state.0 > 1.0, "{passage:?}");
    let other = differences(&model, 6.0, start.into());
    for (entry, other) in jacobian.rows().as_flattened().iter().zip(other.rows().as_flattened()) {
        assert!((entry - other).abs() < 1e-10, "{entry:e} {other:e}");
    }
}

#[test]
fn compliant_stops() {
    let stops = |loss: &str| {
        format!("stops: Hertz(travel_limit_mm: 500, stiffness_n_per_m1_5: 1e5, loss_s_per_m: {loss})")
    };
    let kinds = [EventKind::Contact, EventKind::Separate];
    for loss in ["0", "0.4", "3"] {
        agree(&format!("{WELL}, {SINE}, {DAMPED}, {}", stops(loss)), 2.0, (0.3, 0.6), &kinds, 1e-8);
    }
    // the passage ends during the contact
    agree(&format!("{WELL}, {SINE}, {}", stops("0.4")), 0.33, (0.3, 0.6), &kinds[..1], 1e-8);
}

/// A coil with inductance, and a piezoelectric layer, each coupled strongly enough to change the motion.
const CIRCUITS: [&str; 2] = [
    "transducer: Electromagnetic(coupling_v_s_per_m: 0.8, coil_ohm: 0.3, load_ohm: 0.4, inductance_mh: 900)",
    "transducer: Piezoelectric(coupling_n_per_v: 0.4, capacitance_nf: 5e8, load_kohm: 0.002)",
];

#[test]
fn circuits_in_free_flight_and_at_impacts() {
    let stops = "stops: Rigid(travel_limit_mm: 800, restitution: 0.6)";
    for circuit in CIRCUITS {
        let start = MapState { x: 0.1, v: 0.9, electrical: 0.3 };
        agree_from(&format!("{WELL}, {SINE}, {DAMPED}, {circuit}"), 5.0, start, &[], 1e-10);
        let fields = format!("{WELL}, {SINE}, {DAMPED}, {circuit}, {stops}");
        agree_from(&fields, 5.0, start, &[EventKind::Impact], 1e-10);
    }
}

/// After a rest on a stop the circuit alone remembers the start: the derivatives have one direction.
#[test]
fn a_circuit_remembers_over_a_rest() {
    let stops = "stops: Rigid(travel_limit_mm: 500, restitution: 0.3)";
    let strong = "excitation: Sine(frequency_hz: 0.2, amplitude_g: 0.05)";
    for circuit in CIRCUITS {
        let fields = format!("{WELL}, {strong}, {DAMPED}, {circuit}, {stops}");
        let mut remembered = 0;
        for seconds in [3.0, 4.5, 6.0, 8.0, 12.0, 20.0] {
            let start = MapState { x: 0.3, v: 0.2, electrical: 0.2 };
            agree_from(&fields, seconds, start, &[], 1e-8);
            let map = StroboscopicMap::over(&model(&fields), seconds);
            let (passage, jacobian) = map.pass_with_jacobian(start, 1);
            if !passage.rested {
                continue;
            }
            assert_eq!(passage.determinant, Some(0.0));
            remembered += u32::from(!jacobian.is_zero());
            let size = jacobian.trace().abs().max(jacobian.products().cbrt());
            assert!(jacobian.multipliers(0.0)[1].magnitude() <= 1e-7 * size.max(1e-3), "{jacobian:?}");
        }
        assert!(remembered > 0);
    }
}
