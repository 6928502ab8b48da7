//! The derivatives of the map against finite differences in double-double arithmetic, for every event.

use std::sync::Arc;

use super::{Jacobian, Kernel, StroboscopicMap};
use crate::dynamics::model::Model;
use crate::dynamics::result::EventKind;
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
fn differences(model: &Model, seconds: f64, (x, v): (f64, f64)) -> Jacobian {
    let map = StroboscopicMap::over(&model.with_tolerance(1e-29), seconds);
    let kernel = Kernel::<DoubleDouble>::new(&map.model);
    let unit = model.scales.unit();
    let dd = DoubleDouble::of;
    // The error of a central difference is of the order of the square of its step.
    let step = dd(1e-9);
    let end = |dx: DoubleDouble, dv: DoubleDouble| {
        let start = (dd(x) + dx, (dd(v) + dv) * dd(unit));
        let (x, v) = map.trace(&kernel, start, (0.0, 1.0)).end;
        (x, v / dd(unit))
    };
    let zero = dd(0.0);
    let slope = |(dx, dv): (DoubleDouble, DoubleDouble)| {
        let (above, below) = (end(dx, dv), end(zero - dx, zero - dv));
        let over = |a: DoubleDouble, b: DoubleDouble| ((a - b) / (step + step)).to_f64();
        [over(above.0, below.0), over(above.1, below.1)]
    };
    let (by_x, by_v) = (slope((step, zero)), slope((zero, step)));
    Jacobian { rows: [[by_x[0], by_v[0]], [by_x[1], by_v[1]]] }
}

/// Asserts that both agree to `share` of the largest derivative, and that the events in `must` happen.
#[track_caller]
fn agree(fields: &str, seconds: f64, start: (f64, f64), must: &[EventKind], share: f64) {
    let model = model(fields);
    let (passage, jacobian) = StroboscopicMap::over(&model, seconds).pass_with_jacobian(start, 1);
    let other = differences(&model, seconds, start);
    for kind in must {
        assert!(passage.events.iter().any(|event| event.kind == *kind), "{kind:?} {:?}", passage.events);
    }
    let largest = other.rows.iter().flatten().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    for (entry, other) in jacobian.rows.iter().flatten().zip(other.rows.iter().flatten()) {
        assert!((entry - other).abs() <= share * largest, "{entry:e} {other:e}, of {largest:e}");
    }
    if let Some(exact) = passage.determinant {
        let rounding = share * largest * largest;
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
        assert_eq!((jacobian.rows, passage.determinant), ([[0.0; 2]; 2], Some(0.0)), "{seconds}");
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
    let curve = ForceCurve::from_pieces(pieces, vec![-1.0, 0.0, 1.0], (-infinity, infinity), false, None);
    let smooth = model(&format!("{WELL}, {SINE}, {DAMPED}"));
    let model = Model { mechanism: Arc::new(Mechanism::new(curve)), ..smooth };
    let start = (0.4, -0.9);
    let (passage, jacobian) = StroboscopicMap::over(&model, 6.0).pass_with_jacobian(start, 1);
    assert!(passage.crossings() == 2 && passage.state.0 > 1.0, "{passage:?}");
    let other = differences(&model, 6.0, start);
    for (entry, other) in jacobian.rows.iter().flatten().zip(other.rows.iter().flatten()) {
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
