//! Limits on the sizes of flexures.
//!
//! Every limit is linear in the fields that it joins, as the check of a sweep's corners needs, and none is an
//! absolute size: a drawing that is scaled stays valid.

use super::check::{Checked, known_bad};
use super::mechanism::{FlexureGroup, Mechanism};
use super::ranges::number_text;

/// The shorter flexure over the largest preload. Not far beyond it the loops of a flexure touch each other.
const LENGTH_OVER_PRELOAD: f64 = 2.0;

/// The shorter flexure over the largest preload that is known to be solved.
const LENGTH_OVER_SURE_PRELOAD: f64 = 4.0;

/// The shorter flexure over the largest thickness: a thicker strip is no beam.
const LENGTH_OVER_THICKNESS: f64 = 10.0;

/// The buckling flexure over its largest stress-free bow: a larger one is an arch, whose length along the
/// curve is no longer that between its clamps.
const LENGTH_OVER_BOW: f64 = 20.0;

/// A limit counts as reached and not as passed within the rounding of what a person wrote in decimals.
const ROUNDING: f64 = 1.0 + 1e-12;

/// The relations between the sizes of flexures, each a fault of the field that is most likely meant. Sizes
/// outside their own range are not blamed twice.
pub(super) fn check(at: &str, mechanism: &Mechanism, checked: &mut Checked) {
    let Mechanism::Flexures { preload_mm, thickness_mm, parallel, buckling, initial_bow_mm, .. } = mechanism
    else {
        return;
    };
    let bad = |checked: &Checked, field: &str| known_bad(&format!("{at}.{field}"), checked);
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

/// What is valid and hardly meant, or beyond what is sure to be solved; for sizes without a fault.
pub(super) fn hints(at: &str, mechanism: &Mechanism, warnings: &mut Vec<String>) {
    let Mechanism::Flexures { preload_mm, thickness_mm, parallel, buckling, .. } = mechanism else { return };
    let (shorter, field) = shorter(at, parallel, buckling);
    let sure = shorter / LENGTH_OVER_SURE_PRELOAD;
    if *preload_mm > sure * ROUNDING {
        warnings.push(format!(
            "{at}.preload_mm = {}: beyond {} mm, a quarter of the shorter flexure ({field} = {}), the \
             flexures may not be solved",
            number_text(*preload_mm),
            number_text(sure),
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

/// The length of the shorter flexure in mm, and its field.
fn shorter(at: &str, parallel: &FlexureGroup, buckling: &FlexureGroup) -> (f64, String) {
    if buckling.length_mm < parallel.length_mm {
        (buckling.length_mm, format!("{at}.buckling.length_mm"))
    } else {
        (parallel.length_mm, format!("{at}.parallel.length_mm"))
    }
}
