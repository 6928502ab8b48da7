//! Limits on the dimensions of flexures.
//!
//! Every limit is linear in its fields, because a sweep is checked only at its corners. No limit is an
//! absolute size, so that a scaled geometry stays valid.

use super::check::{Checked, has_fault};
use super::mechanism::{FlexureGroup, Mechanism};
use crate::numeric::number_text;

/// Smallest length of the shorter flexure relative to the preload. At slightly larger preloads the loops of a
/// flexure touch each other.
const LENGTH_OVER_PRELOAD: f64 = 2.0;

/// Length of the shorter flexure relative to the largest preload that is known to be solvable.
const LENGTH_OVER_SOLVED_PRELOAD: f64 = 4.0;

/// Smallest length of the shorter flexure relative to the thickness: a thicker strip is not a beam.
const LENGTH_OVER_THICKNESS: f64 = 10.0;

/// Smallest length of the buckling flexure relative to its stress-free bow: with a larger bow it is an arch,
/// whose arc length differs from the distance between its clamps.
const LENGTH_OVER_BOW: f64 = 20.0;

/// Tolerance of the limits, for the rounding of decimal input.
const ROUNDING: f64 = 1.0 + 1e-12;

/// Checks the relations between the dimensions of flexures. Each fault names the most likely field; fields
/// that already have a fault are skipped.
pub(super) fn check(at: &str, mechanism: &Mechanism, checked: &mut Checked) {
    let Mechanism::Flexures { preload_mm, thickness_mm, parallel, buckling, initial_bow_mm, .. } = mechanism
    else {
        return;
    };
    let no_length = |group: &str, checked: &Checked| has_fault(&format!("{at}.{group}.length_mm"), checked);
    let at_most = |name: &str, value: f64, limit: f64, problem: String, checked: &mut Checked| {
        let field = format!("{at}.{name}");
        if value > limit * ROUNDING && !has_fault(&field, checked) {
            checked.fault(field, number_text(value), problem);
        }
    };
    if no_length("buckling", checked) {
        return;
    }
    let limit = buckling.length_mm / LENGTH_OVER_BOW;
    let problem = format!(
        "must be 0 to {}, a twentieth of {at}.buckling.length_mm = {}; a stronger bow is an arch and not a \
         flexure",
        number_text(limit),
        number_text(buckling.length_mm)
    );
    at_most("initial_bow_mm", *initial_bow_mm, limit, problem, checked);
    if no_length("parallel", checked) {
        return;
    }
    let (shorter, field) = shorter(at, parallel, buckling);
    let named = format!("the shorter flexure ({field} = {})", number_text(shorter));
    let limit = shorter / LENGTH_OVER_PRELOAD;
    let shown = number_text(limit);
    let problem = format!("must be 0 to {shown} mm, half of {named}; lower it or lengthen the flexure");
    at_most("preload_mm", *preload_mm, limit, problem, checked);
    let limit = shorter / LENGTH_OVER_THICKNESS;
    let shown = number_text(limit);
    let problem = format!("must be at most {shown} mm, a tenth of {named}; a thicker one is no beam");
    at_most("thickness_mm", *thickness_mm, limit, problem, checked);
}

/// Warnings about valid but unlikely dimensions, and about preloads that may not be solvable. The dimensions
/// have no faults.
pub(super) fn hints(at: &str, mechanism: &Mechanism, warnings: &mut Vec<String>) {
    let Mechanism::Flexures { preload_mm, thickness_mm, parallel, buckling, .. } = mechanism else { return };
    let (shorter, field) = shorter(at, parallel, buckling);
    let solved = shorter / LENGTH_OVER_SOLVED_PRELOAD;
    if *preload_mm > solved * ROUNDING {
        warnings.push(format!(
            "{at}.preload_mm = {}: beyond {} mm, a quarter of the shorter flexure ({field} = {}), the \
             flexures may not be solved",
            number_text(*preload_mm),
            number_text(solved),
            number_text(shorter)
        ));
    }
    for (name, group) in [("parallel", parallel), ("buckling", buckling)] {
        if group.width_mm < *thickness_mm {
            warnings.push(format!(
                "{at}.{name}.width_mm = {}: less than the thickness of {} mm; such a flexure bends \
                 sideways first, which the model does not follow",
                number_text(group.width_mm),
                number_text(*thickness_mm)
            ));
        }
    }
}

/// Length of the shorter flexure in mm, and its field.
fn shorter(at: &str, parallel: &FlexureGroup, buckling: &FlexureGroup) -> (f64, String) {
    if buckling.length_mm < parallel.length_mm {
        (buckling.length_mm, format!("{at}.buckling.length_mm"))
    } else {
        (parallel.length_mm, format!("{at}.parallel.length_mm"))
    }
}
