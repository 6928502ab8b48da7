//! Compliant stops: one contact against its closed forms, and contact as a phase of a run.

mod command_line;
mod impact;
mod one_step;
mod phases;
mod quasi_static;
mod together;
mod within;

use interwell::dynamics::{EventKind, Model, Run};

use crate::support::*;

/// Stiffness of the prototype's stops in N/m^1.5: 5 mm aluminium cylinders, crossed.
const STIFFNESS: f64 = 3.678e9;

/// A free mass of 15.2 g that flies from the middle at `speed` in m/s to a stop at 1 mm with this loss in
/// s/m.
fn flight(speed: f64, loss: f64, tolerance: f64) -> Model {
    let duration = 3e-3 / speed;
    model(&format!(
        "mass_g: 15.2, mechanism: Polynomial(coefficients_si: [0.0]), start: At(x_mm: 0, \
         v_m_per_s: {speed}), \
         stops: Hertz(travel_limit_mm: 1, stiffness_n_per_m1_5: {STIFFNESS}, loss_s_per_m: {loss}), \
         run: (duration_s: {duration}, settle_s: 0, tolerance: {tolerance})"
    ))
}

/// The prototype with compliant stops of aluminium and what else is changed.
fn prototype(changes: &[&str]) -> Model {
    let stops = "stops=Hertz(travel_limit_mm: 1.5, radius_mm: 5, young_gpa: 69, loss_s_per_m: 4.854)";
    preset("paper", &[&[stops][..], changes].concat())
}

/// When the only contact of a run lasted, and the speeds at its ends.
fn contact(run: &Run) -> (f64, f64, f64, f64) {
    let (touch, leave) = (of_kind(run, EventKind::Contact), of_kind(run, EventKind::Separate));
    assert_eq!((touch.len(), leave.len()), (1, 1), "{:?}", run.events);
    (touch[0].t, leave[0].t, touch[0].v_in, leave[0].v_out)
}
