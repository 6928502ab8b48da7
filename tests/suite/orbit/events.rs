//! Events of branches: each holds its own equation, lies between its neighbours, and is listed once.

use std::cell::Cell;
use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use interwell::dynamics::{MapState, Model, STANDARD_GRAVITY, Side};
use interwell::mechanics::Mechanism;
use interwell::scene::{Document, Excitation, Files, Scene, Stops};
use interwell_studies::study::{
    BranchAnswer, BranchEnd, BranchEvent, BranchOptions, Family, OrbitAnswer, Task, branch, orbit, settled,
};
use proptest::prelude::*;

use super::one_stop::OneStop;
use super::{AMPLITUDE, Ball, at, document, over_amplitude, response, two};
use crate::properties::harness::{Verdict, hold_for, text};
use crate::properties::mechanisms::built;
use crate::properties::scenes::{rigid_stops, scene_with, sine};
use crate::support::{changed, near};

/// The longest step of a branch as a share of its range, twice for that over an event.
const LONGEST: f64 = 0.02;

/// Every event holds its equation, lies between its neighbours, and is there once.
fn holds(found: &BranchAnswer, model: &Model, range: (f64, f64)) -> Verdict {
    let scales = model.scales();
    let unit = (range.1 - range.0).abs();
    let place = |i: usize| {
        let MapState { x, v, .. } = found.orbits[i].state;
        [x / scales.length, v / scales.speed, found.values[i] / unit]
    };
    let far =
        |i: usize, j: usize| place(i).iter().zip(place(j)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let events: Vec<usize> = (0..found.values.len()).filter(|i| found.events[*i].is_some()).collect();
    for &i in &events {
        let orbit = &found.orbits[i];
        let to = |unit: f64| {
            let far = two(orbit).map(|one| (one.re - unit).hypot(one.im));
            far[0].min(far[1])
        };
        let off = match found.events[i] {
            Some(BranchEvent::Grazing) => {
                let gap = orbit.passage.nearest_miss().unwrap_or(f64::INFINITY) / scales.length;
                let speed = orbit.gentlest_impact().unwrap_or(f64::INFINITY) / scales.speed;
                1e3 * gap.min(speed)
            }
            Some(BranchEvent::Flip) => to(-1.0),
            _ => to(1.0),
        };
        prop_assert!(off <= 1e-6, "{:?} at {}: {off:e}", found.events[i], found.values[i]);
        for other in [i.checked_sub(1), Some(i + 1)].into_iter().flatten() {
            // the state at the phase of the rows may change as fast as it will
            let value = found.values.get(other).copied().unwrap_or(found.values[i]);
            let between = (value - found.values[i]).abs() <= LONGEST * unit;
            prop_assert!(between, "{:?} at {}", found.events[i], found.values[i]);
        }
        let again =
            events.iter().filter(|other| found.events[**other] == found.events[i] && far(i, **other) < 1e-7);
        prop_assert!(again.count() == 1, "{:?} at {} twice", found.events[i], found.values[i]);
    }
    Ok(())
}

/// A branch of a linear oscillator, from the swing without impacts upward or from what a run comes to
/// downward.
#[derive(Debug, Clone)]
pub struct Drawn {
    pub closed: OneStop,
    /// Distance of the stops from the middle in m, which the closed form has as 1: amplitudes and speeds go
    /// in proportion.
    pub gap: f64,
    /// Ends of the range over the amplitude of the grazing.
    ends: (f64, f64),
    upward: bool,
}

pub fn drawn() -> impl Strategy<Value = Drawn> {
    let ends = (0.02..0.9f64, prop_oneof![1.001..1.1f64, 1.1..2.0f64], any::<bool>());
    let oscillator = (0.3..2.5f64, 0.0..0.95f64, 0.02..1.0f64, any::<bool>());
    (oscillator, -3.0..2.0f64, ends).prop_map(|((w, e, damping, mirrored), gap, (low, high, upward))| {
        let ends = if high < 1.1 { (1.0 - low * (high - 1.0) * 10.0, high) } else { (1.0 - low, high) };
        Drawn { closed: OneStop { w, e, damping, mirrored }, gap: 10f64.powf(gap), ends, upward }
    })
}

impl Drawn {
    /// Amplitude in g at which the swing without impacts reaches the stop.
    fn grazing(&self) -> f64 {
        self.gap * self.closed.grazing()
    }

    pub fn range(&self) -> (f64, f64) {
        let [low, high] = [self.ends.0, self.ends.1].map(|end| end * self.grazing());
        if self.upward { (low, high) } else { (high, low) }
    }

    /// The scene, which begins on the swing without impacts where that reaches no stop.
    pub fn document(&self) -> Document {
        let OneStop { w, e, damping, mirrored } = self.closed;
        let from = self.range().0;
        let (size, lag) = response(w, damping);
        let size = size * from * STANDARD_GRAVITY;
        let (x, v) = if size < self.gap { (size * lag.sin(), size * w * lag.cos()) } else { (0.0, 0.0) };
        let limit = 1e3 * self.gap;
        let stops = match mirrored {
            true => format!("Rigid(travel_limit_mm: {limit:?}, restitution: {e:?})"),
            false => format!("Uneven(right_mm: {limit:?}, restitution_right: {e:?})"),
        };
        document(&format!(
            "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, 1]), \
             damping: Coefficient(c_n_s_per_m: {damping:?}), stops: {stops}, \
             excitation: Sine(frequency_hz: {:?}, amplitude_g: {from:?}), \
             start: At(x_mm: {:?}, v_m_per_s: {v:?}), run: (duration_s: {:?})",
            w / TAU,
            1e3 * x,
            40.0 * TAU / w
        ))
    }

    /// Speed of the impact of a motion of the closed form.
    pub fn speed(&self, orbit: &OrbitAnswer) -> Option<f64> {
        let impacts: Vec<_> = orbit.contacts();
        match (&impacts[..], self.closed.mirrored) {
            ([one], false) => Some(one.v_in.abs()),
            ([one, other], true) => {
                let (a, b) = (one.v_in.abs(), other.v_in.abs());
                (one.side != other.side && (a - b).abs() <= 1e-7 * a).then_some(a)
            }
            _ => None,
        }
    }

    fn check(&self) -> Result<bool, TestCaseError> {
        let document = self.document();
        let mechanism = Arc::new(Mechanism::build(&document.scene.mechanism, &document.files).unwrap());
        let family = Family::new(&document.scene, &document.files, &mechanism, AMPLITUDE);
        let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
        let range = self.range();
        let Ok(found) = branch(&family, AMPLITUDE, range, &BranchOptions::new(0.0, Some(1)), &task) else {
            prop_assert!(!self.upward, "the swing without impacts is not found");
            return Ok(false);
        };
        holds(&found, &family.model(range.0).unwrap(), range)?;
        let unit = (range.1 - range.0).abs();
        let grazing = at(&found, BranchEvent::Grazing);
        let missing = found.orbits.iter().any(|orbit| orbit.passage.impacts == 0);
        for (i, value) in found.values.iter().enumerate() {
            if found.events[i] == Some(BranchEvent::Grazing) && found.orbits[i].passage.impacts == 0 {
                prop_assert!((value - self.grazing()).abs() <= 1e-9 * unit, "grazing at {value}");
            }
        }
        if missing {
            prop_assert!(!grazing.is_empty(), "no grazing: {:?} {:?}", found.end, found.values.last());
        }
        self.critical_points(&found, unit)?;
        // near a grazing the derivatives are lost in rounding: a branch may end there, but most go on
        Ok(missing && ![BranchEnd::Grazing, BranchEnd::Lost].contains(&found.end))
    }

    /// The events of motions of the closed form are where it has them, and none of them is left out.
    fn critical_points(&self, found: &BranchAnswer, unit: f64) -> Verdict {
        let at_minus_one = if self.closed.mirrored { BranchEvent::Symmetry } else { BranchEvent::Flip };
        for (multiplier, event) in [(1.0, BranchEvent::Fold), (-1.0, at_minus_one)] {
            let (speed, amplitude) = self.closed.critical(multiplier);
            let (speed, amplitude) = (speed * self.gap, amplitude * self.gap);
            let rows = 0..found.values.len();
            let located = rows.clone().filter(|i| found.events[*i] == Some(event));
            let located: Vec<usize> = located.filter(|i| self.speed(&found.orbits[*i]).is_some()).collect();
            for &i in &located {
                let off = (found.values[i] - amplitude).abs();
                prop_assert!(off <= 1e-9 * unit, "{event:?} at {} for {amplitude}", found.values[i]);
            }
            let speeds: Vec<Option<f64>> = rows
                .filter(|i| found.events[*i].is_none_or(|other| other == BranchEvent::Grazing))
                .map(|i| match found.events[i] {
                    Some(_) if found.orbits[i].contacts().is_empty() => Some(0.0),
                    _ => self.speed(&found.orbits[i]),
                })
                .collect();
            let passes = |pair: &&[Option<f64>]| {
                let [Some(a), Some(b)] = **pair else { return false };
                (a - speed) * (b - speed) < 0.0
            };
            let passed = speeds.windows(2).filter(passes).count();
            // nearer to a grazing than motions are looked at
            let hidden = speed < 1e-3 * self.gap && located.len() < passed;
            // a branch of motions that are not their own mirror images turns at one that is, without a pass
            let turned = event == BranchEvent::Symmetry && located.len() > passed;
            let all = passed == located.len() || hidden || turned;
            prop_assert!(all, "{event:?}: {passed} passed, {} located", located.len());
        }
        Ok(())
    }
}

#[test]
fn linear_oscillators_have_their_events_where_formulas_say() {
    let show = |drawn: &Drawn| format!("{drawn:?} {:?}", drawn.range());
    hold_for("branches_of_linear_oscillators", 40, 0.6, drawn(), show, Drawn::check);
}

/// A ball on a shaken table, from the middle of the amplitudes of its stable motion with one impact a period.
fn balls() -> impl Strategy<Value = Ball> {
    (0.1..0.95f64, 2.0..50.0f64).prop_map(|(e, frequency)| Ball { e, frequency })
}

#[test]
fn bouncing_balls_have_their_events_where_formulas_say() {
    let check = |ball: &Ball| {
        let a = 0.5 * (ball.pace() + ball.flip());
        let ends = [(BranchEvent::Flip, ball.flip(), 1.1), (BranchEvent::Fold, ball.pace(), 0.9)];
        for (event, amplitude, beyond) in ends {
            let range = (a, beyond * amplitude);
            let document = ball.document(a);
            let found = over_amplitude(&document, range, Some(1));
            let mechanism = Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
            holds(&found, &Model::build(&document.scene, Arc::new(mechanism)).unwrap(), range)?;
            let rows = (0..found.values.len()).filter(|i| found.events[*i] == Some(event));
            let simple = rows.filter(|i| found.orbits[*i].passage.impacts == 1);
            let values: Vec<f64> = simple.map(|i| found.values[i]).collect();
            prop_assert!(values.len() == 1, "{event:?}: {values:?} for {amplitude}");
            let off = (values[0] - amplitude).abs() / (range.1 - range.0).abs();
            prop_assert!(off <= 1e-9, "{event:?} at {} for {amplitude}", values[0]);
        }
        Ok(true)
    };
    hold_for("branches_of_bouncing_balls", 12, 1.0, balls(), |ball| format!("{ball:?}"), check);
}

/// With the stops farther away, a motion that grazes one and strikes none comes back after its period, having
/// turned where the stop was.
fn turns_at_the_stop(scene: &Scene, found: &BranchAnswer) -> Verdict {
    const FARTHER: f64 = 1e-3;
    let mut scene = scene.clone();
    let (Stops::Rigid { travel_limit_mm: limit, .. } | Stops::Uneven { right_mm: Some(limit), .. }) =
        &mut scene.stops
    else {
        return Ok(());
    };
    let farther = FARTHER * *limit / 1e3;
    *limit *= 1.0 + FARTHER;
    for (i, orbit) in found.orbits.iter().enumerate() {
        if found.events[i] != Some(BranchEvent::Grazing) || orbit.passage.impacts > 0 {
            continue;
        }
        if let Excitation::Sine { amplitude_g, .. } = &mut scene.excitation {
            *amplitude_g = found.values[i];
        }
        let model = Model::build(&scene, built(&scene.mechanism)).unwrap().with_tolerance(1e-14);
        let passage = model.stroboscopic_map(0.0).unwrap().pass(orbit.state, orbit.period);
        let gap = passage.nearest_miss().unwrap_or(f64::INFINITY);
        let off = [(gap - farther) / model.scales().length, (passage.state.0 - orbit.state.x) / farther];
        let exact = off[0].abs() <= 1e-8 && off[1].abs() <= 1e-4;
        prop_assert!(exact && passage.impacts == 0, "at {}: {off:?}", found.values[i]);
    }
    Ok(())
}

/// A nonlinear oscillator, and how much farther than its swing without impacts reaches its stops are.
#[derive(Debug, Clone)]
struct Swing {
    cubic: f64,
    w: f64,
    damping: f64,
    amplitude: f64,
    farther: f64,
    e: f64,
    /// Stops on both sides, or on the right alone.
    both: bool,
}

fn swings() -> impl Strategy<Value = Swing> {
    let oscillator = (-0.05..1.0f64, 0.3..1.7f64, 0.05..0.6f64, 0.005..0.1f64);
    (oscillator, 1.001..1.1f64, 0.0..0.95f64, any::<bool>()).prop_map(
        |((cubic, w, damping, amplitude), farther, e, both)| Swing {
            cubic,
            w,
            damping,
            amplitude,
            farther,
            e,
            both,
        },
    )
}

impl Swing {
    /// The scene with stops, which begins at a state.
    fn document(&self, stops: &str, (x, v): (f64, f64)) -> Document {
        let Self { cubic, w, damping, amplitude, .. } = self;
        document(&format!(
            "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, 1, 0, {cubic:?}]), \
             damping: Coefficient(c_n_s_per_m: {damping:?}), stops: {stops}, \
             excitation: Sine(frequency_hz: {:?}, amplitude_g: {amplitude:?}), \
             start: At(x_mm: {:?}, v_m_per_s: {v:?}), run: (duration_s: {:?})",
            w / TAU,
            1e3 * x,
            60.0 * TAU / w
        ))
    }

    /// Whether its branch over the amplitude, up to twice, comes to a grazing of the swing without impacts.
    fn check(&self) -> Result<bool, TestCaseError> {
        let cancel = AtomicBool::new(false);
        let free = self.document("None", (0.0, 0.0));
        let free = Model::build(&free.scene, built(&free.scene.mechanism)).unwrap();
        let Some(swing) = settled(&free, &cancel).filter(|swing| swing.period == Some(1)) else {
            return Ok(false);
        };
        let (Some((low, high)), Ok(motion)) = (swing.range, orbit(&free, 0.0, Some(1), &cancel)) else {
            return Ok(false);
        };
        let (limit, e) = (1e3 * self.farther * if self.both { high.max(-low) } else { high }, self.e);
        let stops = match self.both {
            true => format!("Rigid(travel_limit_mm: {limit:?}, restitution: {e:?})"),
            false => format!("Uneven(right_mm: {limit:?}, restitution_right: {e:?})"),
        };
        let document = self.document(&stops, (motion.state.x, motion.state.v));
        let mechanism = built(&document.scene.mechanism);
        let family = Family::new(&document.scene, &document.files, &mechanism, AMPLITUDE);
        let task = Task { tick: &|| (), cancel: &cancel };
        let range = (self.amplitude, 2.0 * self.amplitude);
        let found = branch(&family, AMPLITUDE, range, &BranchOptions::new(0.0, Some(1)), &task);
        let found = found.map_err(|error| TestCaseError::fail(error.to_string()))?;
        holds(&found, &family.model(range.0).unwrap(), range)?;
        turns_at_the_stop(&document.scene, &found)?;
        let touches =
            |i: usize| found.events[i] == Some(BranchEvent::Grazing) && found.orbits[i].passage.impacts == 0;
        let grazing = (0..found.values.len()).find(|i| touches(*i));
        // without one the swing never reached its stop
        let struck = found.orbits.iter().any(|orbit| orbit.passage.impacts > 0);
        prop_assert!(grazing.is_some() || !struck, "no grazing: {:?} {:?}", found.end, found.values.last());
        Ok(grazing.is_some())
    }
}

/// Grazings of nonlinear oscillators, held by motions that are followed anew with the stops farther away.
#[test]
fn nonlinear_oscillators_graze_where_their_swing_reaches_the_stop() {
    hold_for(
        "branches_of_nonlinear_oscillators",
        40,
        0.8,
        swings(),
        |swing| format!("{swing:?}"),
        Swing::check,
    );
}

/// A scene of any kind between rigid stops, whose amplitude rises or falls by a fifth.
#[test]
fn events_of_any_scene_hold_their_equations() {
    /// The most motions of a branch that is looked at.
    const MOST_ROWS: u32 = 200;
    let scenes = (scene_with(rigid_stops(), sine()), prop_oneof![Just(0.8), Just(1.2)]);
    let (events, show) = (Cell::new(0), |drawn: &(Scene, f64)| format!("{}\nto {}", text(&drawn.0), drawn.1));
    let check = |(scene, to): &(Scene, f64)| {
        let mut scene = scene.clone();
        let Excitation::Sine { frequency_hz, amplitude_g, .. } = scene.excitation else { return Ok(false) };
        if amplitude_g == 0.0 {
            return Ok(false);
        }
        (scene.run.duration_s, scene.run.settle_s) = (60.0 / frequency_hz, None);
        let (range, files) = ((amplitude_g, to * amplitude_g), Files::default());
        let mechanism = built(&scene.mechanism);
        let family = Family::new(&scene, &files, &mechanism, AMPLITUDE);
        let (rows, cancel) = (AtomicU32::new(0), AtomicBool::new(false));
        let tick = || {
            let before = rows.fetch_add(1, Ordering::Relaxed);
            cancel.store(before >= MOST_ROWS, Ordering::Relaxed);
        };
        let task = Task { tick: &tick, cancel: &cancel };
        let Ok(found) = branch(&family, AMPLITUDE, range, &BranchOptions::new(0.0, None), &task) else {
            return Ok(false);
        };
        holds(&found, &family.model(range.0).unwrap(), range)?;
        turns_at_the_stop(&scene, &found)?;
        events.set(events.get() + found.events.iter().flatten().count());
        Ok(true)
    };
    hold_for("events_of_any_scene", 60, 0.1, scenes, show, check);
    println!("{} events", events.get());
    assert!(events.get() > 3);
}

/// A grazing was placed where nothing touches, or left out, for ranges that begin far below it.
#[test]
fn a_grazing_is_where_the_swing_reaches_the_stop_from_any_start() {
    let oscillator = Document::load("impact-oscillator").unwrap();
    let closed = OneStop { w: 0.7, e: 0.8, damping: 0.2, mirrored: false };
    for range in [(0.045, 0.06), (0.03, 0.055), (0.05, 0.06), (0.06, 0.045), (0.06, 0.05)] {
        let found = over_amplitude(&oscillator, range, Some(1));
        let grazing = at(&found, BranchEvent::Grazing);
        assert_eq!((grazing.len(), found.end), (1, BranchEnd::Range), "{range:?}");
        near(grazing[0], closed.grazing(), 1e-13);
        assert_eq!(found.values.last(), Some(&range.1));
        assert_eq!(at(&found, BranchEvent::Flip).len(), usize::from(range != (0.03, 0.055)), "{range:?}");
    }
}

/// A motion that is its own mirror image grazes both stops at once, and goes on with an impact on each.
#[test]
fn a_symmetric_motion_grazes_both_stops_once() {
    let scene = ["excitation.amplitude_g=1.3", "run.duration_s=200", "stops.travel_limit_mm=7.9"];
    let scene = changed("paper", &scene);
    let mechanism = Arc::new(Mechanism::build(&scene.scene.mechanism, &scene.files).unwrap());
    let family = Family::new(&scene.scene, &scene.files, &mechanism, "stops.travel_limit_mm");
    let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
    for range in [(7.5, 8.0), (8.0, 7.0), (8.0, 7.8)] {
        let found =
            branch(&family, "stops.travel_limit_mm", range, &BranchOptions::new(0.25, None), &task).unwrap();
        holds(&found, &family.model(range.0).unwrap(), range).unwrap();
        let place = |i: &usize| found.events[*i] == Some(BranchEvent::Grazing);
        let grazing = (0..found.values.len()).filter(place);
        // from 7 mm a branch comes back, to another motion that grazes
        let free = |i: &usize| found.orbits[*i].passage.impacts == 0 && found.values[*i] < 7.85;
        let free: Vec<usize> = grazing.filter(free).collect();
        assert_eq!(free.len(), 1, "{range:?}");
        near(found.values[free[0]], 7.845_018_451_532_7, 1e-11);
        let sides = |i: usize| found.orbits[i].contacts().iter().map(|event| event.side).collect::<Vec<_>>();
        let beside = [sides(free[0] - 1), sides(free[0] + 1)];
        let both = |sides: &Vec<Side>| sides.len() == 2 && sides[0] != sides[1];
        assert!(beside.iter().any(Vec::is_empty) && beside.iter().any(both), "{beside:?}");
    }
}
