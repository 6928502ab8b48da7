//! Periodic motions, their multipliers and branches against closed forms.

mod circuit;
mod closing;
mod events;
mod leaps;
mod literature;
mod loci;
mod one_stop;
mod switch;

use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use interwell::dynamics::{Model, Multiplier, Outcome, STANDARD_GRAVITY};
use interwell::mechanics::Mechanism;
use interwell::scene::{Document, Files};
use interwell_studies::study::{
    BranchAnswer, BranchEnd, BranchEvent, BranchOptions, Family, NoOrbit, OrbitAnswer, Task, branch, orbit,
    orbit_near,
};

use crate::support::{changed, model, near, near_relative, preset};

const AMPLITUDE: &str = "excitation.amplitude_g";

fn find(model: &Model, phase: f64, period: Option<u32>) -> Result<OrbitAnswer, NoOrbit> {
    orbit(model, phase, period, &AtomicBool::new(false))
}

/// The branch over a field of a scene, of motions with their states at this phase in turns.
fn over(
    field: &str,
    document: &Document,
    range: (f64, f64),
    phase: f64,
    period: Option<u32>,
) -> BranchAnswer {
    let mechanism = Arc::new(Mechanism::build(&document.scene.mechanism, &document.files).unwrap());
    let family = Family::new(&document.scene, &document.files, &mechanism, field);
    let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
    let options = BranchOptions::new(phase, period);
    branch(&family, field, range, &options, &task).unwrap_or_else(|error| panic!("{error}"))
}

/// The branch over the amplitude of a scene.
fn over_amplitude(document: &Document, range: (f64, f64), period: Option<u32>) -> BranchAnswer {
    over(AMPLITUDE, document, range, 0.0, period)
}

/// The multipliers of an orbit without a circuit.
fn two(orbit: &OrbitAnswer) -> [Multiplier; 2] {
    orbit.multipliers().try_into().unwrap()
}

fn at(branch: &BranchAnswer, event: BranchEvent) -> Vec<f64> {
    let all = branch.events.iter().zip(&branch.values);
    all.filter(|(seen, _)| **seen == Some(event)).map(|(_, value)| *value).collect()
}

fn document(text: &str) -> Document {
    Document::from_text("test", &format!("(title: \"test\", {text})"), Files::default()).unwrap()
}

/// Amplitude and phase of the steady motion of a unit mass on a unit spring with damping `c`, driven by
/// -sin(w t): x = r sin(w t + p).
fn response(w: f64, c: f64) -> (f64, f64) {
    let (re, im) = (1.0 - w * w, c * w);
    (1.0 / re.hypot(im), PI - im.atan2(re))
}

#[test]
fn the_steady_motion_of_a_linear_oscillator() {
    let (frequency, ratio, g) = (0.2, 0.05, 0.02);
    let model = model(&format!(
        "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, 1]), damping: Ratio({ratio}), \
         excitation: Sine(frequency_hz: {frequency}, amplitude_g: {g}), \
         run: (duration_s: 400, settle_s: 300)"
    ));
    let (size, lag) = response(TAU * frequency, 2.0 * ratio);
    let size = size * g * STANDARD_GRAVITY;
    for phase in [0.0, 0.4] {
        let found = find(&model, phase, None).unwrap();
        let angle = TAU * phase + lag;
        near(found.state.x, size * angle.sin(), 1e-12);
        near(found.state.v, size * TAU * frequency * angle.cos(), 1e-12);
        let [first, second] = two(&found);
        let turn = (1.0 - ratio * ratio).sqrt() / frequency;
        near(first.re, (-ratio / frequency).exp() * turn.cos(), 1e-13);
        near(first.im, (-ratio / frequency).exp() * turn.sin().abs(), 1e-13);
        assert_eq!((found.period, second.re, second.im), (1, first.re, -first.im));
        assert!(found.is_stable());
    }
}

/// A ball on a table that shakes with amplitude `a` g, seen from the table: it is pulled to the left, onto
/// the stop. In the motion with one impact a period it rises and falls for the whole period, so that the
/// speed of the table at the impact is w = g T/2 (1 - e)/(1 + e); its acceleration there, q, gives the
/// multipliers: their sum is 1 + e^2 + (1 + e)^2 q/g, their product e^2 (Guckenheimer and Holmes 1983,
/// section 2.4).
#[derive(Debug, Clone)]
struct Ball {
    e: f64,
    frequency: f64,
}

impl Ball {
    /// Speed of the table at the impact over g T / (2 pi).
    fn pace(&self) -> f64 {
        PI * (1.0 - self.e) / (1.0 + self.e)
    }

    /// Amplitude in g at which a multiplier is -1.
    fn flip(&self) -> f64 {
        let e = self.e;
        (2.0 * (1.0 + e * e) / (1.0 + e).powi(2)).hypot(self.pace())
    }

    /// Sum of the multipliers at an amplitude in g.
    fn sum(&self, a: f64) -> f64 {
        let q = -(a * a - self.pace().powi(2)).sqrt();
        1.0 + self.e * self.e + (1.0 + self.e).powi(2) * q
    }

    /// The scene, with the ball leaving the table at the impact of the motion at amplitude `a`.
    fn document(&self, a: f64) -> Document {
        let Self { e, frequency } = self;
        let g = STANDARD_GRAVITY;
        let phase = PI + (self.pace() / a).acos();
        let leaves = g / frequency / 2.0 - self.pace() * g / (TAU * frequency);
        document(&format!(
            "mass_g: 1000, mechanism: Polynomial(coefficients_si: [{g}]), \
             stops: Uneven(left_mm: 1, restitution_left: {e}), \
             excitation: Sine(frequency_hz: {frequency}, amplitude_g: {a}, phase_deg: {}), \
             start: At(x_mm: -1, v_m_per_s: {leaves}), run: (duration_s: {})",
            phase.to_degrees(),
            400.0 / frequency
        ))
    }
}

#[test]
fn a_bouncing_ball_doubles_its_period_where_the_formula_says() {
    for ball in [Ball { e: 0.5, frequency: 5.0 }, Ball { e: 0.8, frequency: 20.0 }] {
        let a = 0.5 * (ball.pace() + ball.flip());
        let found = over_amplitude(&ball.document(a), (a, 1.1 * ball.flip()), Some(1));
        assert_eq!(found.end, BranchEnd::Range);
        let flips = at(&found, BranchEvent::Flip);
        assert_eq!(flips.len(), 1);
        near_relative(flips[0], ball.flip(), 1e-8);
        for (value, orbit) in found.values.iter().zip(&found.orbits) {
            let [first, second] = two(orbit);
            near(first.re + second.re, ball.sum(*value), 1e-7);
            near(orbit.determinant(), ball.e * ball.e, 1e-15);
            assert_eq!(orbit.passage.impacts, 1);
        }
        // and back, to where the motion ends: the speed of the table is no longer enough
        let found = over_amplitude(&ball.document(a), (a, 0.5 * ball.pace()), Some(1));
        let folds = at(&found, BranchEvent::Fold);
        assert!(!folds.is_empty(), "{:?} {:?}", found.end, found.values.last());
        near_relative(folds[0], ball.pace(), 1e-8);
    }
}

#[test]
fn a_linear_oscillator_grazes_its_stop_where_its_amplitude_is_the_distance() {
    let document = Document::load("impact-oscillator").unwrap();
    let found = over_amplitude(&document, (0.05, 0.06), Some(1));
    let (size, _) = response(0.7, 0.2);
    let grazing = at(&found, BranchEvent::Grazing);
    assert_eq!(grazing.len(), 1);
    near_relative(grazing[0], 1.0 / size / STANDARD_GRAVITY, 1e-8);
    // it turns back there: an unstable motion that touches the stop begins, and ends in a stable one
    let flips = at(&found, BranchEvent::Flip);
    assert_eq!((flips.len(), found.end), (1, BranchEnd::Range));
    assert_eq!(found.orbits.first().unwrap().passage.impacts, 0);
    assert_eq!(found.orbits.last().unwrap().passage.impacts, 1);
    // the other way round the same
    let back = over_amplitude(&document, (0.056, 0.05), Some(1));
    near_relative(at(&back, BranchEvent::Grazing)[0], grazing[0], 1e-8);
    near_relative(at(&back, BranchEvent::Flip)[0], flips[0], 1e-10);
    // near the grazing the multiplier goes like the inverse of the root of the distance (Nordmark 1991), so
    // like the inverse of the impact speed: their product has a limit, to which it goes in proportion
    let rows =
        back.orbits.iter().filter_map(|orbit| Some((orbit.gentlest_impact()?, orbit.multipliers()[0].re)));
    let near_it: Vec<(f64, f64)> = rows.filter(|(speed, _)| (1e-3..0.03).contains(speed)).collect();
    let limit = |pair: &[(f64, f64)]| {
        let [(a, b), (c, d)] = [pair[0], pair[1]].map(|(speed, multiplier)| (speed, speed * multiplier));
        (b * c - d * a) / (c - a)
    };
    let limits: Vec<f64> = near_it.windows(2).map(limit).collect();
    assert!(limits.len() >= 4, "{near_it:?}");
    limits.iter().for_each(|other| near_relative(*other, limits[0], 0.01));
}

#[test]
fn doublings_follow_each_other_by_feigenbaums_ratio() {
    let document = Document::load("duffing-cascade").unwrap();
    let steps = [(1, 0.0346), (2, 0.0355), (4, 0.0363), (8, 0.03652)];
    let flips = steps.map(|(period, from)| {
        at(&over_amplitude(&document, (from, 0.037), Some(period)), BranchEvent::Flip)[0]
    });
    let ratio = |i: usize| (flips[i + 1] - flips[i]) / (flips[i + 2] - flips[i + 1]);
    // 4.669201609 from period to period, approached
    assert!((ratio(0) - 4.669_201_609).abs() < 0.6 && (ratio(1) - 4.669_201_609).abs() < 0.1, "{flips:?}");
}

#[test]
fn a_symmetric_motion_breaks_its_symmetry_and_a_fold_is_where_two_motions_meet() {
    // beside the faster one of the motions at 1.2 g that cross in every period
    let document = changed("paper-unconstrained", &["start=At(x_mm: 5.15, v_m_per_s: -0.3)"]);
    let down = over_amplitude(&document, (1.2, 1.0), Some(1));
    let fold = at(&down, BranchEvent::Fold);
    assert_eq!((fold.len(), down.end), (1, BranchEnd::Range));
    // it comes back up as an unstable motion
    assert!(down.values.last().is_some_and(|last| *last == 1.2));
    assert!(down.orbits.first().unwrap().is_stable() && !down.orbits.last().unwrap().is_stable());
    let up = over_amplitude(&document, (1.2, 1.5), Some(1));
    assert_eq!(at(&up, BranchEvent::Symmetry).len(), 1);
    // motions above the fold near it: the multiplier nears 1 like the root of the distance
    let beside: Vec<f64> = down
        .values
        .iter()
        .zip(&down.orbits)
        .filter(|(value, orbit)| **value - fold[0] < 2e-4 && **value > fold[0] && orbit.is_stable())
        .map(|(value, orbit)| (1.0 - orbit.multipliers()[0].re) / (value - fold[0]).sqrt())
        .collect();
    beside.windows(2).for_each(|pair| near_relative(pair[0], pair[1], 0.2));
}

#[test]
fn a_motion_that_rests_has_multipliers_of_zero_and_a_table_says_so() {
    let found = find(&preset("paper", &["excitation.amplitude_g=1"]), 0.25, None).unwrap();
    assert_eq!((found.period, found.determinant(), found.is_stable()), (1, 0.0, true));
    assert!(found.multipliers().iter().all(|multiplier| multiplier.magnitude() == 0.0));
    let still = find(&preset("paper", &["excitation.amplitude_g=0.5"]), 0.0, None).unwrap();
    assert_eq!((still.period, still.state, still.passage.impacts), (1, (1.5e-3, 0.0).into(), 0));
    let table = found.table();
    assert_eq!(table.numbers("multiplier_1_re").unwrap(), [0.0]);
    assert!(table.numbers("gentlest_impact_m_per_s").unwrap()[0] > 0.1);
}

#[test]
fn what_is_not_there_is_said() {
    let irregular = preset("duffing-chaos", &[]);
    assert_eq!(find(&irregular, 0.0, None), Err(NoOrbit::NotSettled));
    // an unstable one is found beside it
    let unstable = find(&irregular, 0.0, Some(1)).unwrap();
    assert!(unstable.period == 1 && !unstable.is_stable());
    let single = preset("paper", &["excitation.amplitude_g=1"]);
    assert_eq!(find(&single, 0.0, Some(3)), Err(NoOrbit::Shorter(1)));
    assert_eq!(orbit(&single, 0.0, None, &AtomicBool::new(true)), Err(NoOrbit::Cancelled));
    let still = preset("paper", &["excitation=None"]);
    assert_eq!(find(&still, 0.0, None), Err(NoOrbit::NotSettled));
    // a guess beyond the stop is held at it
    let map = single.stroboscopic_map(0.0).unwrap();
    assert_eq!(orbit_near(&map, (1.0, 3.0), 1).unwrap().period, 1);
}

#[test]
fn a_cancelled_search_integrates_nothing() {
    let stop = AtomicBool::new(true);
    let map = preset("duffing-chaos", &[]).stroboscopic_map(0.0).unwrap().cancelled_by(&stop);
    let (passage, _) = map.pass_with_jacobian((0.3, 0.0), 300);
    assert_eq!((passage.outcome, passage.state), (Outcome::Cancelled { at: map.first_strobe() }, (0.3, 0.0)));
    assert_eq!(map.pass((0.3, 0.0), 1).outcome, passage.outcome);
    assert_eq!(orbit_near(&map, (0.3, 0.0), 300), Err(NoOrbit::Cancelled));
}

/// The flag is set with the last orbit, after which nothing but the correction of that orbit looks at it.
#[test]
fn a_branch_that_is_cancelled_at_its_last_orbit_is_no_answer() {
    let document = changed("nominal-cubic", &["stops=None", "excitation.amplitude_g=0.6"]);
    let mechanism = Arc::new(Mechanism::build(&document.scene.mechanism, &document.files).unwrap());
    let family = Family::new(&document.scene, &document.files, &mechanism, AMPLITUDE);
    let options = BranchOptions::new(0.0, Some(1));
    let until = |last: u64| {
        let (ticks, cancel) = (AtomicU64::new(0), AtomicBool::new(false));
        let tick = || cancel.store(ticks.fetch_add(1, Ordering::Relaxed) + 1 == last, Ordering::Relaxed);
        let found = branch(&family, AMPLITUDE, (0.6, 0.61), &options, &Task { tick: &tick, cancel: &cancel });
        (found, ticks.into_inner())
    };
    let (whole, count) = until(u64::MAX);
    assert_eq!(whole.unwrap().end, BranchEnd::Range);
    assert_eq!(until(count), (Err(NoOrbit::Cancelled), count));
}
