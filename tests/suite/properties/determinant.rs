//! The determinant of the stroboscopic map of any scene, through every event.

use std::cell::Cell;

use interwell::dynamics::Outcome;
use proptest::prelude::*;

use super::harness::hold;
use super::scenes::{model, rigid_stops, scene_with, sine};
use interwell::scene::Stops;

#[test]
fn the_determinant_is_that_of_damping_and_impacts() {
    let (worst, impacts) = (Cell::new(0.0_f64), Cell::new(0));
    let stops = prop_oneof![1 => Just(Stops::None), 4 => rigid_stops()];
    hold("the_determinant_is_that_of_damping_and_impacts", 1000, 0.5, scene_with(stops, sine()), |scene| {
        let Some(model) = model(scene) else { return Ok(false) };
        let (left, right) = model.stop_positions();
        let x = model.start().0;
        if [left, right].contains(&Some(x)) || model.mechanism().curve.breaks().contains(&x) {
            return Ok(false); // the derivatives are those of one side
        }
        let Some(map) = model.with_tolerance(1e-12).stroboscopic_map(0.0) else { return Ok(false) };
        let (passage, jacobian) = map.pass_with_jacobian(model.start(), 1);
        let Some(exact) = passage.determinant.filter(|_| passage.outcome == Outcome::Done) else {
            return Ok(false);
        };
        let [[a, b], [c, d]] = jacobian.of_motion();
        // The determinant is the difference of two products, whose digits it loses; where all has died away
        // the derivatives are roundings of what they were.
        let size = (a * d).abs() + (b * c).abs() + 1e-6;
        if !size.is_finite() {
            return Ok(false); // a touch without speed
        }
        let error = (jacobian.determinant() - exact).abs();
        worst.set(worst.get().max(error / size));
        impacts.set(impacts.get() + passage.impacts);
        prop_assert!(error <= 1e-8 * size, "{} is not {exact}, of {size:e}", jacobian.determinant());
        Ok(true)
    });
    println!("to {:.1e} of the products, through {} impacts", worst.get(), impacts.get());
    assert!(impacts.get() > 1000);
}
