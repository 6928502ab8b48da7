//! Rows of branches and loci over every kind of field, held against the motion itself: it comes back to its
//! state after its period, with the impacts that the row names.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use interwell::dynamics::Outcome;
use interwell::mechanics::Mechanism;
use interwell_studies::study::{
    BranchEnd, BranchEvent, BranchOptions, Family, FieldRange, LocusEvent, NoOrbit, OrbitAnswer, Task,
    branch, loci,
};
use proptest::prelude::*;

use super::{at, document, over};
use crate::properties::harness::{Verdict, hold_for};
use crate::support::near;

/// A scene that equals its mirror image, and a range of a field that may break that.
#[derive(Debug, Clone)]
struct Case {
    text: String,
    /// The field, from its value in the scene or near it to the other end.
    field: (&'static str, (f64, f64)),
    /// A field for loci, likewise.
    second: (&'static str, (f64, f64)),
}

/// A field and its range, by a number from 0 to 1 that says how far it goes.
fn field(stops: bool, w: f64, far: f64) -> impl Strategy<Value = (&'static str, (f64, f64))> {
    let smooth = vec![
        ("excitation.0.amplitude_m_per_s2", (1.0, 1.0 - 0.9 * far)),
        ("excitation.0.amplitude_m_per_s2", (1.0, 1.0 + far)),
        ("excitation.0.frequency_rad_per_s", (w, w * (1.0 + 0.5 * far))),
        ("excitation.1.amplitude_m_per_s2", (0.0, 0.5 * far)),
        ("excitation.2.accel_g", (0.0, 0.05 * far)),
        ("excitation.2.accel_g", (-0.01, 0.05 * far)),
        ("mechanism.coefficients_si.0", (0.0, 0.3 * far)),
        ("mechanism.coefficients_si.1", (-1.0, -1.0 + far)),
        ("mechanism.coefficients_si.2", (0.0, -0.3 * far)),
        ("mechanism.coefficients_si.3", (1.0, 1.0 + far)),
        ("damping.c_n_s_per_m", (0.3, 0.3 + far)),
        ("mass_g", (1000.0, 1000.0 + 500.0 * far)),
    ];
    let at_stops = vec![
        ("stops.left_mm", (1200.0, 1200.0 - 700.0 * far)),
        ("stops.right_mm", (1200.0, 1200.0 + 500.0 * far)),
        ("stops.restitution_left", (0.7, 0.7 - 0.6 * far)),
        ("stops.restitution_right", (0.7, 0.7 + 0.25 * far)),
    ];
    prop::sample::select(if stops { [at_stops, smooth].concat() } else { smooth })
}

fn cases() -> impl Strategy<Value = Case> {
    let drawn = (any::<bool>(), 0.6..1.8f64, 0.2..1.4f64, 0.05..1.0f64, 0.05..1.0f64);
    drawn.prop_flat_map(|(stops, w, amplitude, far, further)| {
        (field(stops, w, far), field(stops, w, further)).prop_map(move |(field, second)| {
            let stops = match stops {
                true => {
                    "stops: Uneven(left_mm: 1200, right_mm: 1200, restitution_left: 0.7, restitution_right: \
                     0.7), "
                }
                false => "",
            };
            let text = format!(
                "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, -1, 0, 1]), damping: \
                 Coefficient(c_n_s_per_m: 0.3), {stops}excitation: Sum([Cosine(amplitude_m_per_s2: \
                 {amplitude}, frequency_rad_per_s: {w}), Cosine(amplitude_m_per_s2: 0, frequency_rad_per_s: \
                 {}), Constant(accel_g: 0)]), start: At(x_mm: 0, v_m_per_s: 0), run: (duration_s: 600, \
                 settle_s: 500)",
                2.0 * w
            );
            let scaled = |(name, (from, to)): (&'static str, (f64, f64))| match name {
                "excitation.0.amplitude_m_per_s2" => (name, (from * amplitude, to * amplitude)),
                _ => (name, (from, to)),
            };
            Case { text, field: scaled(field), second: scaled(second) }
        })
    })
}

impl Case {
    /// Holds the rows of the branch, and of the loci from its events; false without a branch.
    fn check(&self, period: Option<u32>) -> Result<bool, TestCaseError> {
        let document = document(&self.text);
        let mechanism = Arc::new(Mechanism::build(&document.scene.mechanism, &document.files).unwrap());
        let (name, range) = self.field;
        let family = Family::new(&document.scene, &document.files, &mechanism, name);
        let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
        let options = BranchOptions { step: 0.03, count: 80, ..BranchOptions::new(0.0, period) };
        let found = match branch(&family, name, range, &options, &task) {
            Err(error) => {
                prop_assert_ne!(error, NoOrbit::Unrepeated);
                return Ok(false);
            }
            Ok(found) => found,
        };
        for ((orbit, value), event) in found.orbits.iter().zip(&found.values).zip(&found.events) {
            repeats(&family, orbit, *value, *event == Some(BranchEvent::Grazing))?;
        }
        let (name, second) = self.second;
        if name == self.field.0 {
            return Ok(true);
        }
        let options = BranchOptions { step: 0.05, count: 12, ..options };
        let second = FieldRange { field: name.to_owned(), range: second };
        for of in [BranchEvent::Fold, BranchEvent::Symmetry, BranchEvent::Flip, BranchEvent::Grazing] {
            let path = interwell::scene::FieldPath::new(name);
            // the branch is at the first value of the second field
            let family = family.with(&path, second.range.0);
            let found = branch(&family, self.field.0, range, &options, &task);
            let Ok(found) = found else { continue };
            for locus in loci(&family, &found, range, (of, &second), &options, &task).unwrap() {
                for ((orbit, values), event) in locus.orbits.iter().zip(&locus.values).zip(&locus.events) {
                    let is_smooth = [None, Some(LocusEvent::Cusp), Some(LocusEvent::FoldFlip)];
                    let grazes = of == BranchEvent::Grazing || !is_smooth.contains(event);
                    repeats(&family.with(&path, values[1]), orbit, values[0], grazes)?;
                }
            }
        }
        Ok(true)
    }
}

/// Holds the motion from the state of an orbit over its whole period. One that grazes may strike or miss the
/// stop by rounding, and is held where it comes back all the same.
fn repeats(family: &Family, orbit: &OrbitAnswer, value: f64, grazes: bool) -> Verdict {
    let map = family.model(value).unwrap().stroboscopic_map(0.0).unwrap();
    let (passage, slopes) = map.pass_with_jacobian(orbit.state, orbit.period);
    prop_assert_eq!(passage.outcome, Outcome::Done);
    let (x, v) = passage.state;
    let off = (x - orbit.state.x).abs().max((v - orbit.state.v).abs());
    let stretch =
        slopes.rows().as_flattened().iter().fold(1.0, |largest: f64, slope| largest.max(slope.abs()));
    let rests = passage.rests() > 0;
    if grazes {
        prop_assert!(off <= 1e-3 * stretch.min(100.0), "{value} {orbit:?}: off by {off:e}");
        return Ok(());
    }
    prop_assert!(off <= 1e-7 * stretch, "{value} {orbit:?}: off by {off:e}, {passage:?}");
    prop_assert!(rests || passage.impacts == orbit.passage.impacts, "{value}: {orbit:?} {passage:?}");
    Ok(())
}

#[test]
fn rows_over_every_kind_of_field_repeat() {
    let show = |case: &Case| format!("{case:?}");
    hold_for("rows repeat", 30, 0.5, cases(), show, |case| case.check(Some(1)));
}

/// The motion of the double well that begins symmetric, over a constant acceleration of the base: its last
/// row is the motion with which a branch from there begins.
#[test]
fn a_branch_over_a_field_that_breaks_the_symmetry_ends_where_one_from_there_begins() {
    let scene = |constant: f64| {
        document(&format!(
            "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, -1, 0, 1]), damping: \
             Coefficient(c_n_s_per_m: 0.3), excitation: Sum([Cosine(amplitude_m_per_s2: 1, \
             frequency_rad_per_s: 1), Constant(accel_g: {constant})]), start: At(x_mm: 0, v_m_per_s: 0), \
             run: (duration_s: 2000, tolerance: 1e-12)"
        ))
    };
    let over = |constant, range| over("excitation.1.accel_g", &scene(constant), range, 0.0, Some(1));
    let (away, back) = (over(0.0, (0.0, 0.02)), over(0.02, (0.02, 0.0)));
    near(away.orbits.last().unwrap().state.x, back.orbits[0].state.x, 1e-9);
    near(away.orbits.last().unwrap().state.x, -1.38495, 5e-6);
    near(away.orbits[0].state.x, back.orbits.last().unwrap().state.x, 1e-9);
    assert!(at(&away, BranchEvent::Symmetry).is_empty());
}

/// Beyond a grazing the motion goes on with one impact more, to the end of the range.
#[test]
fn a_branch_goes_on_beyond_a_grazing_with_an_impact_more() {
    let scene = "mass_g: 45.12895528783495, mechanism: Polynomial(coefficients_si: [0, 118.00753911321786]), \
         damping: Coefficient(c_n_s_per_m: 0.46276058395152525), \
         stops: Uneven(left_mm: 1.1292699821575831, restitution_left: 1, right_mm: 1.1292699821575831, \
         restitution_right: 1), \
         excitation: Force(frequency_rad_per_s: 36.77356344310319, amplitude_n: 0.05858264928203443, \
         phase_deg: -113.53556912024604), \
         run: (duration_s: 68.344590177137, settle_s: 61.510131159423295, tolerance: 1e-12)";
    let range = (1.1292699821575831, 0.30677157960888707);
    let found = over("stops.right_mm", &document(scene), range, 0.0, Some(1));
    let impacts: Vec<u64> = found.orbits.iter().map(|orbit| orbit.passage.impacts).collect();
    assert_eq!((found.end, found.values.last()), (BranchEnd::Range, Some(&range.1)));
    assert_eq!((impacts.first(), impacts.last()), (Some(&0), Some(&2)), "{impacts:?}");
    near(at(&found, BranchEvent::Grazing)[0], 0.9851324720470797, 1e-9);
}
