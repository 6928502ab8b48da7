//! Thresholds against closed forms, against runs of their own at what they name, and against each other.

use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use interwell::dynamics::{Model, Regime, Request, STANDARD_GRAVITY, Summary};
use interwell::mechanics::Mechanism;
use interwell::questions::{Progress, Simulation, Threshold};
use interwell::scene::{Document, FieldPath, Files, Scene};
use interwell::system::threads::Pool;
use interwell_studies::study::{Alternative, Found, Onset, Scan, Task, alternatives, threshold, thresholds};
use proptest::prelude::*;

use super::harness::hold_for;

const AMPLITUDE: &str = "excitation.amplitude_g";

/// Two wells with a barrier V = B (x^2/q^2 - 1)^2 between them, and what shakes the mass. Stops stand at a
/// share of q, and the drive has a share of the frequency of small oscillations.
#[derive(Debug, Clone, Copy)]
struct Drawn {
    mass_g: f64,
    barrier_mj: f64,
    damping: f64,
    limit: Option<f64>,
    restitution: f64,
    frequency: f64,
    /// Forcing periods of the run, of which the second half is the settled window.
    periods: u32,
}

const WELL_MM: f64 = 7.0;

impl Drawn {
    fn frequency_hz(&self) -> f64 {
        let stiffness = 8.0 * self.barrier_mj * 1e3 / (WELL_MM * WELL_MM);
        self.frequency * (stiffness / (self.mass_g * 1e-3)).sqrt() / TAU
    }

    fn text(&self) -> String {
        let Self { mass_g, barrier_mj, damping, limit, restitution, periods, .. } = *self;
        let stops = limit.map_or_else(
            || "None".to_owned(),
            |share| format!("Rigid(travel_limit_mm: {:?}, restitution: {restitution:?})", share * WELL_MM),
        );
        let (frequency, duration) = (self.frequency_hz(), f64::from(periods) / self.frequency_hz());
        format!(
            "(title: \"drawn\", mass_g: {mass_g:?}, damping: Ratio({damping:?}), stops: {stops}, \
             mechanism: DoubleWell(equilibrium_mm: {WELL_MM:?}, barrier_mj: {barrier_mj:?}), \
             excitation: Sine(frequency_hz: {frequency:?}, amplitude_g: 0.3), \
             run: (duration_s: {duration:?}, tolerance: 1e-9))"
        )
    }

    fn scene(&self) -> Scene {
        Document::from_text("drawn", &self.text(), Files::default()).unwrap().scene
    }

    /// The amplitude in g whose push is the force at a share of q.
    fn push_g(&self, share: f64) -> f64 {
        let force = 4.0 * self.barrier_mj / WELL_MM * share * (1.0 - share * share);
        force / (self.mass_g * 1e-3) / STANDARD_GRAVITY
    }

    /// The largest force against which the mass must be moved to the barrier, in the same way.
    fn most_g(&self) -> f64 {
        self.push_g(self.limit.unwrap_or(1.0).min(3.0_f64.sqrt().recip()))
    }
}

fn drawn(
    limits: impl Strategy<Value = Option<f64>>,
    dampings: std::ops::Range<f64>,
    frequencies: std::ops::Range<f64>,
    periods: u32,
) -> impl Strategy<Value = Drawn> {
    (1.0..100.0_f64, 0.01..1.0_f64, dampings, limits, 0.0..0.8_f64, frequencies).prop_map(
        move |(mass_g, barrier_mj, damping, limit, restitution, frequency)| Drawn {
            mass_g,
            barrier_mj,
            damping,
            limit,
            restitution,
            frequency,
            periods,
        },
    )
}

fn mechanism(scene: &Scene) -> Arc<Mechanism> {
    Arc::new(Mechanism::build(&scene.mechanism, &Files::default()).unwrap())
}

/// So many even steps of a field; to a thousandth of a step, and followed up to a time in s.
fn scan(field: &str, (low, high): (f64, f64), steps: u32, until_settled: Option<f64>) -> Scan {
    let step = (high - low) / f64::from(steps);
    let values = (0..=steps).map(|i| low + step * f64::from(i)).collect();
    Scan { field: field.to_owned(), values, resolution: 1e-3 * step, until_settled }
}

fn found(scene: &Scene, scan: &Scan, onset: Onset) -> Found {
    let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
    threshold(scene, &mechanism(scene), &Files::default(), scan, onset, &task).unwrap()
}

/// The least mass, and the least amplitude, that a push moves off the stop on which it rests are force over
/// acceleration and force over weight.
#[test]
fn release_is_where_the_push_is_the_force() {
    let all = drawn((0.05..0.95_f64).prop_map(Some), 0.0..0.5, 0.05..2.0, 6);
    hold_for("release", 24, 1.0, all, Drawn::text, |drawn| {
        let scene = drawn.scene();
        let exact = drawn.push_g(drawn.limit.unwrap());
        let over_amplitude = scan(AMPLITUDE, (0.0, 2.0 * exact), 10, None);
        let amplitude = found(&scene, &over_amplitude, Onset::Release);
        let value = amplitude.value.unwrap();
        prop_assert!((value / exact - 1.0).abs() < 1e-9, "{value} is not {exact}");
        prop_assert_eq!(
            (amplitude.low, amplitude.high, amplitude.undecided),
            (Some(value), Some(value), false)
        );
        // all of a range above it releases, and nothing of one below it
        let ends = |scan: &Scan| {
            let Found { value, low, high, undecided, .. } = found(&scene, scan, Onset::Release);
            (value, low, high, undecided)
        };
        let above = scan(AMPLITUDE, (1.2 * exact, 3.0 * exact), 10, None);
        let first = above.values.first().copied();
        prop_assert_eq!(ends(&above), (first, None, first, false));
        let below = scan(AMPLITUDE, (0.1 * exact, 0.9 * exact), 10, None);
        prop_assert_eq!(ends(&below), (None, below.values.last().copied(), None, false));
        // the amplitude is 0.3 g: the mass that this releases
        let exact = drawn.mass_g * exact / 0.3;
        let over_mass = scan("mass_g", (0.5 * exact, 1.6 * exact), 11, None);
        let mass = found(&scene, &over_mass, Onset::Release);
        let (low, high) = (mass.low.unwrap(), mass.high.unwrap());
        // (a heavier mass may fly throughout the window, which is no release)
        prop_assert!(!mass.undecided && mass.value == Some(high), "{mass:?}");
        prop_assert!(low <= exact * (1.0 + 1e-9) && exact <= high * (1.0 + 1e-9), "{mass:?} not {exact}");
        prop_assert!(high - low <= 1.001 * over_mass.resolution, "{mass:?}");
        Ok(true)
    });
}

/// Pushed slowly off a stop inside the largest force, the mass is across as soon as it is off.
#[test]
fn a_slow_push_crosses_where_it_releases() {
    let all = drawn((0.1..0.55_f64).prop_map(Some), 0.02..0.5, 0.004..0.01, 4);
    hold_for("slow crossing", 24, 1.0, all, Drawn::text, |drawn| {
        let releases = drawn.push_g(drawn.limit.unwrap());
        let scan = scan(AMPLITUDE, (0.0, 2.0 * releases), 20, None);
        let crossing = found(&drawn.scene(), &scan, Onset::Crossing);
        let (low, high) = (crossing.low.unwrap(), crossing.high.unwrap());
        prop_assert!(!crossing.undecided && high - low <= 1.001 * scan.resolution, "{crossing:?}");
        let excess = high / releases - 1.0;
        prop_assert!((-1e-9..0.02).contains(&excess), "{excess} above {releases}");
        Ok(true)
    });
}

/// What a run of its own does, followed as the search follows: whether it crosses, and whether that goes on.
fn told(scene: &Scene, amplitude: f64, until_settled: f64) -> (bool, bool) {
    let mut scene = scene.clone();
    assert!(FieldPath::new(AMPLITUDE).set(&mut scene, amplitude));
    let model = Model::build(&scene, mechanism(&scene)).unwrap();
    let request = Request { until_settled: Some(until_settled), ..Request::default() };
    let Summary { crossings, settled, period, regime, .. } = model.run(&request).summary;
    (crossings > 0, settled == Some(true) && (period.is_some() || regime == Regime::Rest))
}

/// Runs at `value`, `low` and `high`, at the scan's values and just below the threshold do what the columns
/// say, where the time is so short that much is left undecided.
#[test]
fn what_a_threshold_names_is_what_its_runs_do() {
    let limits = prop_oneof![2 => Just(None), 1 => (0.3..1.3_f64).prop_map(Some)];
    let all = drawn(limits, 0.005..0.15, 0.3..1.6, 16);
    let undecided = std::cell::Cell::new(0);
    hold_for("named values", 40, 0.7, all, Drawn::text, |drawn| {
        let scene = drawn.scene();
        let until = 60.0 / drawn.frequency_hz();
        let mut scan = scan(AMPLITUDE, (0.0, 2.0 * drawn.most_g()), 16, Some(until));
        scan.resolution *= 20.0;
        let found = found(&scene, &scan, Onset::Crossing);
        let each: Vec<(f64, (bool, bool))> =
            scan.values.iter().map(|value| (*value, told(&scene, *value, until))).collect();
        let Some(value) = found.value else {
            prop_assert!(each.iter().all(|(_, (crosses, _))| !crosses), "{found:?} {each:?}");
            prop_assert_eq!((found.high, found.windows), (None, 0));
            prop_assert_eq!(found.undecided, !each[16].1.1);
            return Ok(false);
        };
        prop_assert!(told(&scene, value, until).0, "{found:?}");
        prop_assert!(each.iter().all(|(at, (crosses, _))| *at >= value || !crosses), "{found:?} {each:?}");
        let above: Vec<bool> = each.iter().filter(|tried| tried.0 >= value).map(|tried| tried.1.0).collect();
        let changes = above.windows(2).filter(|pair| pair[0] != pair[1]).count() as u64;
        prop_assert_eq!(found.windows, changes, "{:?} {:?}", found, each);
        for (named, does) in [(found.low, false), (found.high, true)] {
            let Some(named) = named else { continue };
            prop_assert_eq!(told(&scene, named, until), (does, true), "{:?} at {}", found, named);
        }
        prop_assert!(found.low.is_none_or(|low| low < value) && found.high.is_none_or(|high| high >= value));
        let known = each.iter().filter(|tried| tried.1.1);
        let known_low =
            known.clone().filter(|tried| tried.0 < value).map(|tried| tried.0).fold(-1.0, f64::max);
        prop_assert!(found.low.unwrap_or(-1.0) >= known_low, "{found:?} {each:?}");
        if found.undecided {
            undecided.set(undecided.get() + 1);
            let apart = |end: Option<f64>| end.is_none_or(|end| (value - end).abs() > 0.5 * scan.resolution);
            prop_assert!(found.high != Some(value) || apart(found.low.map(|low| low + scan.resolution)));
        } else {
            prop_assert_eq!(found.high, Some(value));
            let near =
                found.low.map_or(value == scan.values[0], |low| value - low <= 1.001 * scan.resolution);
            prop_assert!(near, "{found:?}");
        }
        Ok(true)
    });
    assert!(undecided.get() >= 4, "{}", undecided.get());
}

/// Above the least amplitude that crosses those of the bisection are tried, and the hundredths of it up to
/// one and a half times it: `high` is the first of them all that is known to cross.
#[test]
fn a_comparison_names_the_first_amplitude_that_is_known_to_cross() {
    let limits = prop_oneof![2 => Just(None), 1 => (0.3..1.3_f64).prop_map(Some)];
    let all = drawn(limits, 0.005..0.15, 0.3..1.6, 16);
    let pool = Pool::new(2).unwrap();
    let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
    let apart = std::cell::Cell::new(0);
    hold_for("known to cross", 30, 0.5, all, Drawn::text, |drawn| {
        let (scene, until) = (drawn.scene(), 60.0 / drawn.frequency_hz());
        let alone = Alternative {
            name: "drawn".to_owned(),
            scene: scene.clone(),
            files: Files::default(),
            mechanism: mechanism(&scene),
        };
        let found = alternatives(&[alone], Some(until), &pool, &task).unwrap()[0].crossing.unwrap();
        let Some(value) = found.value else {
            prop_assert_eq!((found.high, found.windows), (None, 0));
            return Ok(false);
        };
        let unit = found.resolution.unwrap();
        let per_unit = (1.0 / unit).round();
        let hundredth = |i: u32| (value * (1.0 + 0.01 * f64::from(i)) / unit).round() / per_unit;
        let known = |amplitude: f64| told(&scene, amplitude, until) == (true, true);
        let first = std::iter::once(value).chain((1..=50).map(hundredth)).find(|at| known(*at));
        match found.high {
            // one of the bisection may come before the first of these
            Some(high) => {
                prop_assert!(high >= value && known(high), "{found:?}");
                prop_assert!(first.is_none_or(|first| high <= first), "{found:?} {first:?}");
            }
            None => prop_assert_eq!(first, None),
        }
        apart.set(apart.get() + u32::from(found.high != Some(value)));
        Ok(true)
    });
    assert!(apart.get() >= 4, "{}", apart.get());
}

/// Without stops the mass of the harvester moves irregularly near its threshold, and a transient that crosses
/// was taken for one that goes on: both searches bracket the same threshold.
#[test]
fn two_searches_of_a_harvester_without_stops_bracket_one_threshold() {
    let mut document = Document::load("harvester").unwrap();
    document.set("stops=None").unwrap();
    let Document { scene, files, .. } = document;
    let mechanism = Arc::new(Mechanism::build(&scene.mechanism, &files).unwrap());
    let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
    let alone = thresholds(&scene, &mechanism, &task).unwrap().crossing;
    let scan = scan(AMPLITUDE, (1.3, 1.44), 7, None);
    let scanned = threshold(&scene, &mechanism, &files, &scan, Onset::Crossing, &task).unwrap();
    let ends = |found: Found| (found.low.unwrap_or(0.0), found.high.unwrap_or(f64::INFINITY));
    let ((low, high), (other_low, other_high)) = (ends(alone), ends(scanned));
    assert!(low > 1.0 && low <= other_high && other_low <= high, "{alone:?} {scanned:?}");
}

/// Without a range `threshold`, `compare` and the window give one threshold to the last bit, whose step and
/// resolution are said: no step of the scan below it crosses.
#[test]
fn without_a_range_all_ask_by_one_search() {
    let limits = prop_oneof![1 => Just(None), 2 => (0.2..1.2_f64).prop_map(Some)];
    let all = drawn(limits, 0.02..0.3, 0.1..1.2, 12);
    let pool = Pool::new(1).unwrap();
    let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
    hold_for("one search", 20, 0.6, all, Drawn::text, |drawn| {
        let (scene, until) = (drawn.scene(), Some(60.0 / drawn.frequency_hz()));
        let alone = Alternative {
            name: "drawn".to_owned(),
            scene: scene.clone(),
            files: Files::default(),
            mechanism: mechanism(&scene),
        };
        let compared = alternatives(&[alone], until, &pool, &task).unwrap()[0].crossing.unwrap();
        let simulation = Simulation::from_text("drawn", &drawn.text()).unwrap();
        let question = Threshold { until_settled: until, ..Threshold::default() };
        let table = question.run(&simulation, &Progress::none().threads(2)).unwrap();
        let number = |name: &str| Some(table.numbers(name).unwrap()[0]).filter(|value| !value.is_nan());
        let Found { value, low, high, step, resolution, .. } = compared;
        for (name, known) in
            [("value", value), ("low", low), ("high", high), ("step", step), ("resolution", resolution)]
        {
            prop_assert_eq!(number(name), known, "{}: {:?}", name, compared);
        }
        prop_assert_eq!(table.words("undecided")[0], compared.undecided.to_string());
        let (Some(value), Some(step), Some(resolution)) = (value, step, resolution) else { return Ok(false) };
        let most = drawn.most_g();
        prop_assert!(step <= 0.0126 * value.max(most), "{step} {compared:?}");
        prop_assert!((0.39e-5..1.01e-5).contains(&(resolution / most)), "{most} {compared:?}");
        if step < 0.0101 * most {
            let per_unit = (1.0 / step).round();
            let steps = (1..(value / step).ceil() as u32).map(|i| f64::from(i) / per_unit);
            let crossing =
                steps.filter(|at| *at < value - step).find(|at| told(&scene, *at, until.unwrap()).0);
            prop_assert_eq!(crossing, None, "{:?}", compared);
        }
        Ok(true)
    });
}

/// A cosine and a force are searched in the unit of their own amplitude, also beside a tilt in a sum, where
/// the same motion of a sine has the same sharp threshold.
#[test]
fn the_default_field_is_the_amplitude_of_the_drive_that_there_is() {
    let all = drawn((0.15..0.5_f64).prop_map(Some), 0.05..0.4, 0.004..0.01, 4);
    hold_for("default field", 12, 1.0, all, Drawn::text, |drawn| {
        let simulation = Simulation::from_text("drawn", &drawn.text()).unwrap();
        let (hz, mass) = (drawn.frequency_hz(), drawn.mass_g * 1e-3);
        let rate = TAU * hz;
        let exact = drawn.push_g(drawn.limit.unwrap()) * STANDARD_GRAVITY;
        let sine = format!("Sine(frequency_hz: {hz:?}, amplitude_g: 0)");
        for (drive, per_unit) in [
            (format!("Cosine(frequency_rad_per_s: {rate:?}, amplitude_m_per_s2: 0, phase_deg: -90)"), 1.0),
            (format!("Force(frequency_rad_per_s: {rate:?}, amplitude_n: 0, phase_deg: 90)"), 1.0 / mass),
            (format!("Sum([Constant(accel_g: 0), {sine}])"), STANDARD_GRAVITY),
            (sine.clone(), STANDARD_GRAVITY),
        ] {
            let simulation = simulation.with("excitation", &*drive).unwrap();
            for of in [Onset::Crossing, Onset::Release] {
                let question = Threshold { of, ..Threshold::default() };
                let table = question.run(&simulation, &Progress::none().threads(1)).unwrap();
                let value = table.numbers("value").unwrap()[0] * per_unit;
                let excess = value / exact - 1.0;
                let most = if of == Onset::Release { 2e-4 } else { 0.02 };
                prop_assert!((-1e-9..most).contains(&excess), "{} {}: {}", drive, of.name(), excess);
            }
        }
        Ok(true)
    });
}

/// A sharp threshold is the same for any step of the scan and for the search that needs none.
#[test]
fn a_sharp_threshold_does_not_depend_on_the_scan() {
    let all = drawn((0.15..0.9_f64).prop_map(Some), 0.02..0.3, 0.1..0.8, 12);
    hold_for("sharp", 24, 0.6, all, Drawn::text, |drawn| {
        let scene = drawn.scene();
        let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
        let alone = thresholds(&scene, &mechanism(&scene), &task).unwrap().crossing;
        let (Some(value), Some(low)) = (alone.value, alone.low) else { return Ok(false) };
        if alone.undecided || alone.windows > 0 {
            return Ok(false);
        }
        let resolution = 10_f64.powf((value - low).log10().round());
        for steps in [15, 40, 150] {
            let scan = Scan { resolution, ..scan(AMPLITUDE, (0.0, 1.5 * value), steps, None) };
            let found = found(&scene, &scan, Onset::Crossing);
            if found.windows > 0 {
                return Ok(false);
            }
            let apart = (found.value.unwrap() - value).abs();
            // (the values of the scan are no multiples of the resolution, and the least may be one of them)
            prop_assert!(!found.undecided && apart <= 1.001 * resolution, "{steps}: {found:?} {alone:?}");
        }
        Ok(true)
    });
}
