//! Limits on the dimensions of flexures.
//!
//! Every limit is linear in its fields, as the check of a sweep's corners requires, and none is an absolute
//! size, so that a scaled geometry stays valid.

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
    let bad = |checked: &Checked, field: &str| has_fault(&format!("{at}.{field}"), checked);
    let no_length = |checked: &Checked, group: &str| bad(checked, &format!("{group}.length_mm"));
    if no_length(checked, "buckling") {
        return;
    }
    let limit = buckling.length_mm / LENGTH_OVER_BOW;
    if *initial_bow_mm > limit * ROUNDING && !bad(checked, "initial_bow_mm") {
        let problem = format!(
            "must be 0 to {}, a twentieth of {at}.buckling.length_mm = {}; a stronger bow is an arch \
             and not a flexure",
            number_text(limit),
            number_text(buckling.length_mm)
        );
        checked.fault(format!("{at}.initial_bow_mm"), number_text(*initial_bow_mm), problem);
    }
    if no_length(checked, "parallel") {
        return;
    }
    let (shorter, field) = shorter(at, parallel, buckling);
    let limit = shorter / LENGTH_OVER_PRELOAD;
    if *preload_mm > limit * ROUNDING && !bad(checked, "preload_mm") {
        let problem = format!(
            "must be 0 to {} mm, half of the shorter flexure ({field} = {}); lower it or lengthen the \
             flexure",
            number_text(limit),
            number_text(shorter)
        );
        checked.fault(format!("{at}.preload_mm"), number_text(*preload_mm), problem);
    }
    let limit = shorter / LENGTH_OVER_THICKNESS;
    if *thickness_mm > limit * ROUNDING && !bad(checked, "thickness_mm") {
        let problem = format!(
            "must be at most {} mm, a tenth of the shorter flexure ({field} = {}); a thicker one is no beam",
            number_text(limit),
            number_text(shorter)
        );
        checked.fault(format!("{at}.thickness_mm"), number_text(*thickness_mm), problem);
    }
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
