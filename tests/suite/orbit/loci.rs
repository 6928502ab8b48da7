//! Loci of events in two fields, against closed forms and against branches at other values of the second
//! field.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use interwell::dynamics::STANDARD_GRAVITY;
use interwell::mechanics::Mechanism;
use interwell::scene::Document;
use interwell_studies::study::{
    BranchEvent, BranchOptions, Family, FieldRange, LocusEnd, LocusEvent, OneLocus, Task, branch, loci,
    loci_table,
};
use proptest::prelude::*;

use super::circuit::Oscillator;
use super::events::{Drawn, drawn};
use super::one_stop::OneStop;
use super::{AMPLITUDE, Ball, document, two};
use crate::cli::headless;
use crate::measured::Noise;
use crate::properties::harness::{Verdict, hold_for};
use crate::support::{changed, near, near_relative};

/// The loci that begin on the branch of a scene over a field.
fn found(
    document: &Document,
    (field, range): (&str, (f64, f64)),
    of: BranchEvent,
    second: FieldRange,
) -> Vec<OneLocus> {
    let mechanism = Arc::new(Mechanism::build(&document.scene.mechanism, &document.files).unwrap());
    let family = Family::new(&document.scene, &document.files, &mechanism, field);
    let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
    let options = BranchOptions { count: 3000, ..BranchOptions::new(0.0, Some(1)) };
    let Ok(begun) = branch(&family, field, range, &options, &task) else { return Vec::new() };
    loci(&family, &begun, range, (of, &second), &options, &task).unwrap()
}

/// Every row is inside both ranges and holds the condition of the locus, and events are said once a row.
fn holds(locus: &OneLocus, range: (f64, f64), second: (f64, f64)) -> Verdict {
    let inside = |(from, to): (f64, f64), value: f64| {
        let slack = 1e-9 * (to - from).abs();
        (from.min(to) - slack..=from.max(to) + slack).contains(&value)
    };
    for (orbit, [value, other]) in locus.orbits.iter().zip(&locus.values) {
        prop_assert!(inside(range, *value) && inside(second, *other), "{value} {other}");
        let to = |unit: f64| {
            let far = two(orbit).map(|one| (one.re - unit).hypot(one.im));
            far[0].min(far[1])
        };
        let off = match locus.of {
            BranchEvent::Grazing => orbit.passage.nearest_miss().unwrap_or(f64::INFINITY),
            BranchEvent::Flip => to(-1.0),
            _ => to(1.0),
        };
        prop_assert!(off <= 1e-6, "{:?} at {value}, {other}: {off:e}", locus.of);
    }
    prop_assert_eq!(loci_table(std::slice::from_ref(locus)).rows(), locus.orbits.len());
    Ok(())
}

/// Fields of the linear oscillator with a stop other than the amplitude.
#[derive(Debug, Clone, Copy)]
enum Other {
    Frequency,
    Damping,
    Restitution,
}

/// A locus of the linear oscillator from a branch over the amplitude.
#[derive(Debug, Clone)]
struct Case {
    drawn: Drawn,
    other: Other,
    /// Change of the other field from the first end of its range to the last, by this factor.
    by: f64,
}

fn cases() -> impl Strategy<Value = Case> {
    let other = prop_oneof![Just(Other::Frequency), Just(Other::Damping), Just(Other::Restitution)];
    let by = prop_oneof![0.7..0.98f64, 1.02..1.4f64];
    (drawn(), other, by).prop_map(|(drawn, other, by)| Case { drawn, other, by })
}

impl Case {
    fn second(&self) -> FieldRange {
        let OneStop { w, e, damping, mirrored } = self.drawn.closed;
        let (field, from, highest) = match self.other {
            Other::Frequency => ("excitation.frequency_hz", w / TAU, f64::INFINITY),
            Other::Damping => ("damping.c_n_s_per_m", damping, f64::INFINITY),
            Other::Restitution if mirrored => ("stops.restitution", e, 0.99),
            Other::Restitution => ("stops.restitution_right", e, 0.99),
        };
        FieldRange { field: field.into(), range: (from, (self.by * from).min(highest)) }
    }

    /// The oscillator at a value of the other field.
    fn at(&self, value: f64) -> OneStop {
        let mut closed = self.drawn.closed.clone();
        match self.other {
            Other::Frequency => closed.w = TAU * value,
            Other::Damping => closed.damping = value,
            Other::Restitution => closed.e = value,
        }
        closed
    }

    /// Whether there was a locus; `rows` counts those of each kind that closed forms hold.
    fn check(&self, rows: &Cell<BTreeMap<&'static str, usize>>) -> Result<bool, TestCaseError> {
        let (range, second, gap) = (self.drawn.range(), self.second(), self.drawn.gap);
        if second.range.0 == second.range.1 {
            return Ok(false);
        }
        let at_minus_one = if self.drawn.closed.mirrored { BranchEvent::Symmetry } else { BranchEvent::Flip };
        let mut any = false;
        for (of, multiplier) in
            [(BranchEvent::Grazing, None), (BranchEvent::Fold, Some(1.0)), (at_minus_one, Some(-1.0))]
        {
            for locus in found(&self.drawn.document(), (AMPLITUDE, range), of, second.clone()) {
                holds(&locus, range, second.range)?;
                for (orbit, [amplitude, other]) in locus.orbits.iter().zip(&locus.values) {
                    let closed = self.at(*other);
                    let speed = self.drawn.speed(orbit);
                    let known = match multiplier {
                        None if orbit.passage.impacts == 0 => closed.grazing(),
                        Some(multiplier) if speed.is_some() => closed.critical(multiplier).1,
                        _ => continue,
                    };
                    let off = (amplitude / (gap * known) - 1.0).abs();
                    prop_assert!(off <= 1e-8, "{of:?} at {amplitude}, {other}: {off:e}");
                    any = true;
                    let mut all = rows.take();
                    *all.entry(of.name()).or_default() += 1;
                    rows.set(all);
                }
                // nearer to a grazing than motions are looked at
                let gentlest = locus.orbits.last().and_then(|orbit| self.drawn.speed(orbit));
                let hidden = gentlest.is_some_and(|speed| speed < 1e-3 * gap);
                prop_assert!(locus.end != LocusEnd::Lost || hidden, "lost after {} rows", locus.orbits.len());
            }
        }
        Ok(any)
    }
}

#[test]
fn loci_of_linear_oscillators_lie_where_formulas_say() {
    let rows = Cell::new(BTreeMap::new());
    let check = |case: &Case| case.check(&rows);
    let show = |case: &Case| format!("{case:?} {:?} {:?}", case.drawn.range(), case.second());
    hold_for("loci_of_linear_oscillators", 40, 0.4, cases(), show, check);
    let rows = rows.take();
    println!("{rows:?}");
    for of in ["grazing", "fold", "flip", "symmetry"] {
        assert!(rows.get(of).is_some_and(|rows| *rows > 40), "{rows:?}");
    }
}

/// A ball on a shaken table with one impact a period: its flip and its fold over amplitude and restitution.
#[test]
fn loci_of_bouncing_balls_lie_where_formulas_say() {
    let balls = (0.3..0.8f64, 2.0..50.0f64, prop_oneof![Just(0.9), Just(1.1)]);
    let check = |&(e, frequency, by): &(f64, f64, f64)| {
        let ball = Ball { e, frequency };
        let a = 0.5 * (ball.pace() + ball.flip());
        let second = FieldRange { field: "stops.restitution_left".into(), range: (e, by * e) };
        for (of, to) in [(BranchEvent::Flip, 1.5 * ball.flip()), (BranchEvent::Fold, 0.5 * ball.pace())] {
            let loci = found(&ball.document(a), (AMPLITUDE, (a, to)), of, second.clone());
            let simple = |locus: &&OneLocus| locus.orbits[0].passage.impacts == 1;
            let locus = loci.iter().find(simple).unwrap();
            holds(locus, (a, to), second.range)?;
            for [amplitude, e] in &locus.values {
                let ball = Ball { e: *e, frequency };
                let known = if of == BranchEvent::Flip { ball.flip() } else { ball.pace() };
                prop_assert!((amplitude / known - 1.0).abs() <= 1e-8, "{of:?} at {amplitude}, {e}: {known}");
            }
            prop_assert!(locus.values.len() > 4 && locus.end == LocusEnd::Range, "{:?}", locus.end);
        }
        Ok(true)
    };
    hold_for("loci_of_bouncing_balls", 8, 1.0, balls, |ball| format!("{ball:?}"), check);
}

/// The flip of the motion with one impact a period ends at a grazing where half of the oscillator's own
/// period times a whole number is the period of the drive (Nordmark 1991): the stop is left and met in the
/// same phase.
#[test]
fn a_flip_ends_at_a_grazing_in_resonance() {
    let flips = FieldRange { field: "excitation.frequency_hz".into(), range: (0.1114, 0.09) };
    let scene =
        changed("impact-oscillator", &["excitation.frequency_hz=0.1114", "excitation.amplitude_g=0.07"]);
    let all = found(&scene, (AMPLITUDE, (0.07, 0.0545)), BranchEvent::Flip, flips);
    assert_eq!(all.len(), 1);
    let end = all[0].values.len() - 1;
    assert_eq!((all[0].end, all[0].events[end]), (LocusEnd::Grazing, Some(LocusEvent::GrazingFlip)));
    let w = 2.0 / 3.0 * (1.0f64 - 0.01).sqrt();
    near_relative(all[0].values[end][1], w / TAU, 1e-3);
    let closed = OneStop { w, e: 0.8, damping: 0.2, mirrored: false };
    near_relative(all[0].values[end][0], closed.grazing(), 1e-3);
}

/// The swing that grazes the right stop grazes the left one too where that stands as far away; there the
/// locus ends, at any phase of the rows and any step.
#[test]
fn a_locus_of_grazing_does_not_pass_through_the_other_stop() {
    let mut random = Noise::new(46);
    for _ in 0..12 {
        let [e, step] = [random.between(0.0, 0.9), random.between(3e-3, 0.05)];
        let (phase, last) = (random.between(0.0, 1.0), random.between(300.0, 900.0));
        let scene = changed(
            "impact-oscillator",
            &[
                &format!("stops=Uneven(left_mm:1500,right_mm:1000,restitution_right:{e:?})"),
                "excitation.amplitude_g=0.03",
            ],
        );
        let mechanism = Arc::new(Mechanism::build(&scene.scene.mechanism, &scene.files).unwrap());
        let family = Family::new(&scene.scene, &scene.files, &mechanism, AMPLITUDE);
        let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
        let options = BranchOptions { step, ..BranchOptions::new(phase, Some(1)) };
        let begun = branch(&family, AMPLITUDE, (0.03, 0.06), &options, &task).unwrap();
        let second = FieldRange { field: "stops.left_mm".into(), range: (1500.0, last) };
        let all =
            loci(&family, &begun, (0.03, 0.06), (BranchEvent::Grazing, &second), &options, &task).unwrap();
        let locus = &all[0];
        assert_eq!(locus.end, LocusEnd::Grazing, "{e} {step} {phase} {last}");
        assert_eq!(locus.events.last(), Some(&Some(LocusEvent::GrazingTwice)));
        near_relative(locus.values[locus.values.len() - 1][1], 1000.0, 1e-7);
    }
}

/// A locus of grazing begins at any stop and phase, though rounding decides whether the motion from the state
/// of one that touches misses the stop or strikes it.
#[test]
fn a_locus_of_grazing_begins_at_any_phase() {
    let mut random = Noise::new(45);
    for _ in 0..40 {
        let e = random.between(0.0, 0.95);
        let at = 1000.0 * 10f64.powf(random.between(-3.0, 1.0));
        let side = if random.between(0.0, 1.0) < 0.5 { "left" } else { "right" };
        let closed = OneStop { w: 0.7, e, damping: 0.2, mirrored: false };
        let grazing = closed.grazing() * at * 1e-3;
        let scene = changed(
            "impact-oscillator",
            &[
                &format!("stops=Uneven({side}_mm:{at:?},restitution_{side}:{e:?})"),
                &format!("excitation.amplitude_g={:?}", 0.6 * grazing),
            ],
        );
        let second = FieldRange { field: format!("stops.{side}_mm"), range: (at, 0.95 * at) };
        let all = found(&scene, (AMPLITUDE, (0.6 * grazing, 1.05 * grazing)), BranchEvent::Grazing, second);
        assert_eq!((all.len(), all[0].end), (1, LocusEnd::Range), "{side} {at} {e}");
        assert!(all[0].values.len() > 5);
        for [amplitude, at] in &all[0].values {
            near_relative(*amplitude, closed.grazing() * at * 1e-3, 1e-9);
        }
    }
}

/// Two folds of motions between equal stops meet where the symmetry breaks: a cusp over the place of one
/// stop, whose tangent lies along the amplitude.
#[test]
fn folds_meet_in_a_cusp_where_a_symmetry_breaks() {
    let stops = "stops=Uneven(left_mm:1500,right_mm:1000,restitution_right:0.8,restitution_left:0.8)";
    let scene = changed("impact-oscillator", &[stops, "excitation.amplitude_g=0.03"]);
    let second = FieldRange { field: "stops.left_mm".into(), range: (1500.0, 500.0) };
    let all = found(&scene, (AMPLITUDE, (0.03, 0.1)), BranchEvent::Fold, second);
    let rows = all.iter().flat_map(|locus| locus.events.iter().zip(&locus.values));
    let cusps: Vec<[f64; 2]> =
        rows.filter(|row| *row.0 == Some(LocusEvent::Cusp)).map(|row| *row.1).collect();
    let at_equal_stops = cusps.iter().find(|[_, left]| (left - 1000.0).abs() < 1e-3);
    assert!(at_equal_stops.is_some(), "{cusps:?}");
}

/// The folds of Duffing's oscillator meet in a cusp; each is a fold of the branch over the frequency.
#[test]
fn folds_of_a_duffing_oscillator_meet_in_a_cusp() {
    const FREQUENCY: &str = "excitation.frequency_hz";
    let scene = |amplitude: f64| {
        document(&format!(
            "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, 1, 0, 1]), \
             damping: Coefficient(c_n_s_per_m: 0.1), \
             excitation: Sine(frequency_hz: 0.13, amplitude_g: {amplitude:?}), run: (duration_s: 1000)"
        ))
    };
    let range = (0.13, 0.3);
    let second = FieldRange { field: AMPLITUDE.into(), range: (0.02, 0.001) };
    let all = found(&scene(0.02), (FREQUENCY, range), BranchEvent::Fold, second);
    // both folds lie on one locus
    assert_eq!((all.len(), all[0].end), (1, LocusEnd::Range));
    let locus = &all[0];
    holds(locus, range, (0.001, 0.02)).unwrap();
    let cusps: Vec<usize> =
        (0..locus.values.len()).filter(|i| locus.events[*i] == Some(LocusEvent::Cusp)).collect();
    assert_eq!(cusps.len(), 1);
    let lowest = locus.values[cusps[0]][1];
    assert!(locus.values.iter().all(|[_, amplitude]| *amplitude >= lowest * (1.0 - 1e-12)));
    // the numbers of folds beside it, and some rows against the branch at its amplitude
    let folds = |amplitude: f64| {
        let second = FieldRange { field: AMPLITUDE.into(), range: (amplitude, 1.001 * amplitude) };
        let all = found(&scene(amplitude), (FREQUENCY, range), BranchEvent::Fold, second);
        all.iter().map(|locus| locus.values[0][0]).collect::<Vec<f64>>()
    };
    assert_eq!((folds(0.99 * lowest).len(), folds(1.05 * lowest).len()), (0, 2));
    for [frequency, amplitude] in locus.values.iter().step_by(97) {
        let off = folds(*amplitude).into_iter().map(|fold| (fold / frequency - 1.0).abs());
        let off = off.fold(f64::INFINITY, f64::min);
        let near_the_cusp = (amplitude / lowest - 1.0).abs() < 1e-3;
        assert!(off <= 1e-8 || near_the_cusp, "{frequency} Hz at {amplitude} g: {off:e}");
    }
}

/// With a circuit a locus of grazing is where the steady response of the linear system reaches the stop.
#[test]
fn a_locus_of_grazing_beside_a_circuit_is_where_the_response_reaches_the_stop() {
    let mut random = Noise::new(47);
    for _ in 0..8 {
        let oscillator = Oscillator::random(&mut random);
        let grazing = |frequency: f64| {
            let mut there = oscillator.clone();
            there.frequency = frequency;
            0.05 / there.response() / STANDARD_GRAVITY
        };
        let first = grazing(oscillator.frequency);
        let mut scene = oscillator.clone();
        scene.amplitude_g = 0.45 * first;
        let scene = document(&scene.text(
            "stops: Uneven(right_mm: 50, restitution_right: 0.8), start: At(x_mm: 0, v_m_per_s: 0), \
             run: (duration_s: 900, settle_s: 800, tolerance: 1e-12)",
        ));
        let second = FieldRange {
            field: "excitation.frequency_hz".into(),
            range: (oscillator.frequency, 1.1 * oscillator.frequency),
        };
        let all = found(&scene, (AMPLITUDE, (0.45 * first, 1.002 * first)), BranchEvent::Grazing, second);
        assert_eq!(all.len(), 1);
        for [amplitude, frequency] in &all[0].values {
            near_relative(*amplitude, grazing(*frequency), 1e-8);
        }
        let last = all[0].values[all[0].values.len() - 1];
        assert_eq!(all[0].end, LocusEnd::Range, "{last:?}\n{}", scene.write(&scene.scene).unwrap());
    }
}

/// A locus that is followed in longer or shorter steps, or at another phase of the strobe, is the same curve.
#[test]
fn a_locus_does_not_depend_on_the_phase_of_its_rows() {
    let scene = changed("impact-oscillator", &["excitation.amplitude_g=0.056"]);
    let mechanism = Arc::new(Mechanism::build(&scene.scene.mechanism, &scene.files).unwrap());
    let family = Family::new(&scene.scene, &scene.files, &mechanism, AMPLITUDE);
    let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
    let closed = OneStop { w: 0.7, e: 0.8, damping: 0.2, mirrored: false };
    for (phase, step) in [(0.0, 1e-2), (0.3, 1e-2), (0.6, 3e-3), (0.9, 5e-2)] {
        let options = BranchOptions { step, ..BranchOptions::new(phase, Some(1)) };
        let begun = branch(&family, AMPLITUDE, (0.056, 0.054), &options, &task).unwrap();
        let second = FieldRange { field: "damping.c_n_s_per_m".into(), range: (0.2, 0.22) };
        let of = (BranchEvent::Flip, &second);
        let all = loci(&family, &begun, (0.056, 0.054), of, &options, &task).unwrap();
        let [amplitude, damping] = all[0].values[all[0].values.len() - 1];
        near_relative(amplitude, OneStop { damping, ..closed.clone() }.critical(-1.0).1, 1e-9);
        assert_eq!(all[0].end, LocusEnd::Range);
        let longest =
            all[0].values.windows(2).map(|pair| (pair[1][1] - pair[0][1]).abs()).fold(0.0, f64::max);
        assert!(longest <= 1.01 * step * 0.02 && all[0].values.len() as f64 >= 0.2 / step, "{longest}");
        near(
            all[0].orbits[0].state.v,
            begun
                .orbits
                .iter()
                .zip(&begun.events)
                .find(|row| *row.1 == Some(BranchEvent::Flip))
                .unwrap()
                .0
                .state
                .v,
            1e-9,
        );
    }
}

#[test]
fn a_branch_without_such_an_event_says_what_it_has() {
    // and where and why it ends
    let none = "orbit impact-oscillator --branch excitation.amplitude_g=0.05:0.07 --locus fold \
                --and damping.c_n_s_per_m=0.2:0.3 --period 1";
    let assert = headless(none).assert().code(1).stdout("");
    let text = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
    for words in ["has no fold but flip and grazing", "it ends at 0.07, at an end of the range"] {
        assert!(text.contains(words), "{text}");
    }
}
