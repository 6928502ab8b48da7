//! Whether what is said to have settled stays: motions of a driven double well, many of them beside a fold
//! or a flip, against runs twenty times as long.

use std::cell::Cell;
use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use interwell::dynamics::{Model, Outcome, Request};
use interwell::mechanics::Mechanism;
use interwell::scene::{Document, Files};
use interwell_studies::study::{
    BranchAnswer, BranchEvent, BranchOptions, Family, OrbitAnswer, Task, branch, orbit_near,
};
use proptest::prelude::*;

use super::harness::hold_for;
use crate::support::build;

/// How many times as long the other run is.
const LONGER: u32 = 20;

/// Largest difference of states that are alike, as a share of the scales.
const MATCH: f64 = 1e-3;

/// Largest change over a period of a motion that has come to its end.
const ENDED: f64 = 1e-8;

/// Least multiplier of an orbit that attracts slowly.
const SLOW: f64 = 0.99;

/// Ratio of two changes on a spiral, which turns from the short to the long axis of its ellipse.
const SWING: f64 = 5.0;

const AMPLITUDE: &str = "excitation.amplitude_m_per_s2";

/// A unit mass with the force x^3 - x under a cosine.
#[derive(Debug, Clone)]
struct Drawn {
    rate: f64,
    amplitude: f64,
    /// N s/m.
    damping: f64,
    /// Distance of the stops in m and their restitution.
    stops: Option<(f64, f64)>,
    circuit: bool,
    start: (f64, f64),
    /// Forcing periods of the run, and those before its settled window.
    periods: u32,
    settle: u32,
    /// Relative distance of the amplitude from that of the event, as a power of ten, and the side.
    beside: (f64, bool),
    /// Distance of the start from the motion at the event, as a power of ten, and its direction in turns.
    off: (f64, f64),
}

impl Drawn {
    fn period(&self) -> f64 {
        TAU / self.rate
    }

    fn text(&self) -> String {
        let Self { rate, amplitude, damping, stops, circuit, start: (x, v), periods, settle, .. } = self;
        let stops = stops.map_or_else(
            || "None".to_owned(),
            |(d, e)| format!("Rigid(travel_limit_mm: {:?}, restitution: {e:?})", 1e3 * d),
        );
        let transducer = match circuit {
            true => {
                "Electromagnetic(coupling_v_s_per_m: 0.5, coil_ohm: 0.5, load_ohm: 0.5, inductance_mh: 500)"
            }
            false => "None",
        };
        let duration = f64::from(*periods) * self.period() * (1.0 + 1e-12);
        let settle = f64::from(*settle) * self.period();
        format!(
            "(title: \"drawn\", mass_g: 1000, mechanism: Cubic(linear_n_per_m: -1, cubic_n_per_m3: 1), \
             damping: Coefficient(c_n_s_per_m: {damping:?}), stops: {stops}, transducer: {transducer}, \
             excitation: Cosine(frequency_rad_per_s: {rate:?}, amplitude_m_per_s2: {amplitude:?}), \
             start: At(x_mm: {:?}, v_m_per_s: {v:?}), \
             run: (duration_s: {duration:?}, settle_s: {settle:?}, tolerance: 1e-9))",
            1e3 * x
        )
    }

    fn document(&self) -> Document {
        Document::from_text("drawn", &self.text(), Files::default()).unwrap_or_else(|e| panic!("{e}"))
    }

    /// The scene beside a fold or a flip of the branch of motions over the amplitude, started near the motion
    /// there; `None` if the branch has none.
    fn beside_an_event(&self) -> Option<Self> {
        let document = self.document();
        let mechanism = Arc::new(Mechanism::build(&document.scene.mechanism, &document.files).unwrap());
        let family = Family::new(&document.scene, &document.files, &mechanism, AMPLITUDE);
        let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
        let options = BranchOptions { step: 0.05, count: 80, ..BranchOptions::new(0.0, None) };
        let found = branch(&family, AMPLITUDE, (self.amplitude, 0.7), &options, &task).ok()?;
        let BranchAnswer { values, orbits, events, .. } = found;
        let at = events.iter().position(|event| event.is_some_and(|event| event != BranchEvent::Grazing))?;
        let (size, angle) = (10f64.powf(self.off.0), TAU * self.off.1);
        let share = 10f64.powf(self.beside.0) * if self.beside.1 { 1.0 } else { -1.0 };
        let (x, v) = (orbits[at].state.x + size * angle.cos(), orbits[at].state.v + size * angle.sin());
        let x = self.stops.map_or(x, |(d, _)| x.clamp(-d, d));
        let beside = Self { amplitude: values[at] * (1.0 + share), start: (x, v), ..self.clone() };
        Some(beside)
    }
}

fn drawn() -> impl Strategy<Value = Drawn> {
    let power = |range: std::ops::Range<f64>| range.prop_map(|power| 10f64.powf(power));
    let stops = prop_oneof![
        3 => Just(None),
        2 => (0.3..1.7f64, 0.0..0.95f64).prop_map(Some)
    ];
    let mechanical = (0.4..2.5f64, 0.02..0.6f64, power(-2.0..-0.3), stops, prop::bool::weighted(0.1));
    let start = (-1.0..1.0f64, -0.7..0.7f64);
    let run = (16..120u32, 0.0..0.9f64);
    let beside = (-9.0..-5.0f64, any::<bool>());
    (mechanical, start, run, beside, (-6.0..-2.0f64, 0.0..1.0f64)).prop_map(
        |((rate, amplitude, damping, stops, circuit), (x, v), (periods, share), beside, off)| Drawn {
            rate,
            amplitude,
            damping,
            stops,
            circuit,
            start: (stops.map_or(1.6, |(d, _)| d) * x, v),
            periods,
            settle: (f64::from(periods) * share) as u32,
            beside,
            off,
        },
    )
}

/// The states once a forcing period from the `first` period on, in a run so many times as long as `periods`.
fn later(model: &Model, first: u32, periods: u32) -> Option<Vec<(f64, f64)>> {
    let period = model.forcing_period()?;
    let times: Vec<f64> = (first..=LONGER * periods).map(|number| f64::from(number) * period).collect();
    let model = model.with_duration(f64::from(LONGER * periods) * period * (1.0 + 1e-12), 0.0);
    let run = model.run(&Request { sample_times: &times, ..Request::default() });
    let done = run.summary.outcome == Outcome::Done && run.samples.len() == times.len();
    done.then(|| run.samples.iter().map(|sample| (sample.x, sample.v)).collect())
}

/// The states of a long run, once a forcing period, of which that with the number `end` is the last of the
/// short one.
struct Long {
    states: Vec<(f64, f64)>,
    end: usize,
    scales: (f64, f64),
}

impl Long {
    fn apart(&self, a: (f64, f64), b: (f64, f64)) -> f64 {
        ((a.0 - b.0) / self.scales.0).abs().max(((a.1 - b.1) / self.scales.1).abs())
    }

    /// The largest change after `q` periods in those before a state.
    fn change(&self, q: usize, before: usize) -> f64 {
        let pairs = (before - q..=before).map(|i| (self.states[i], self.states[i.saturating_sub(q)]));
        pairs.map(|(a, b)| self.apart(a, b)).fold(0.0, f64::max)
    }

    /// The period to which the motion comes, if it has come there.
    fn period(&self) -> Option<usize> {
        (1..=12).find(|q| self.change(*q, self.states.len() - 1) <= ENDED)
    }

    /// The largest distance from the state at the end of the short run, after `q` periods each, of those
    /// before it in its settled window, and of those after it.
    fn strays(&self, q: usize) -> (f64, f64) {
        let (before, after) = (self.states[..=self.end].iter().rev(), self.states[self.end..].iter());
        let far = |state: &(f64, f64)| self.apart(self.states[self.end], *state);
        (before.step_by(q).map(far).fold(0.0, f64::max), after.step_by(q).map(far).fold(0.0, f64::max))
    }

    /// Why the motion does not have this period, if it does not. On a slow spiral towards an orbit a change
    /// may be larger than an earlier one; it grows if no orbit there attracts, and slowly.
    fn refutes(&self, q: usize, model: &Model) -> Option<String> {
        let (far, last) = (self.strays(q).1, self.states.len() - 1);
        let (change, later) = (self.change(q, self.end), self.change(q, last));
        let shorter = (1..q).find(|p| q.is_multiple_of(*p) && self.change(*p, last) <= ENDED);
        if far > 2.0 * MATCH {
            return Some(format!("strays by {far}"));
        }
        if let Some(shorter) = shorter {
            return Some(format!("it has the period {shorter}"));
        }
        let is_slow = |size: f64| (SLOW..1.0).contains(&size);
        let is_spiral =
            || later <= SWING * change && multiplier(model, self.states[last], q).is_some_and(is_slow);
        let grows = later > ENDED.max(1.01 * change) && !is_spiral();
        grows.then(|| format!("changes grow from {change} to {later}"))
    }
}

/// The magnitude of the largest multiplier of the orbit near a state.
fn multiplier(model: &Model, state: (f64, f64), period: usize) -> Option<f64> {
    let found = model.stroboscopic_map(0.0).map(|map| orbit_near(&map, state, period as u32));
    let largest = |orbit: OrbitAnswer| orbit.multipliers()[0].magnitude();
    found.and_then(Result::ok).map(largest)
}

/// Whether the orbit to which a motion has come attracts it well: within a thousand periods.
fn attracts_well(model: &Model, state: (f64, f64), period: usize) -> bool {
    multiplier(model, state, period).is_some_and(|size| size < 0.999)
}

/// Counts of motions that have settled, that have without being said to, and that have not, or not for
/// certain.
#[derive(Debug, Default)]
struct Counts {
    settled: Cell<u32>,
    lost: Cell<u32>,
    open: Cell<u32>,
}

#[test]
fn what_has_settled_stays() {
    let counts = [Counts::default(), Counts::default()];
    let cases = (drawn(), prop::bool::weighted(0.2));
    let show = |(drawn, _): &(Drawn, bool)| drawn.text();
    hold_for("what_has_settled_stays", 100, 0.6, cases, show, |(drawn, is_beside)| {
        let beside = if *is_beside { drawn.beside_an_event() } else { Some(drawn.clone()) };
        let Some(drawn) = beside else { return Ok(false) };
        let model = build(&drawn.document());
        let summary = model.run(&Request::default()).summary;
        let Some(states) = later(&model, drawn.settle, drawn.periods) else { return Ok(false) };
        let (end, scales) = ((drawn.periods - drawn.settle) as usize, model.scales());
        let long = Long { states, end, scales: (scales.length, scales.speed) };
        let add = |count: fn(&Counts) -> &Cell<u32>| {
            let count = count(&counts[usize::from(*is_beside)]);
            count.set(count.get() + 1);
        };
        if let Some(said) = summary.period {
            add(|counts| &counts.settled);
            let refuted = long.refutes(said as usize, &model);
            prop_assert!(refuted.is_none(), "period {said}, but {}\n{}", refuted.unwrap(), drawn.text());
        } else if let Some(period) = long.period()
            && summary.settled == Some(false)
            && 2 * period as u64 <= summary.periods
            && long.strays(period).0.max(long.strays(period).1) <= 0.5 * MATCH
            && !drawn.circuit
            && attracts_well(&model, *long.states.last().unwrap(), period)
        {
            add(|counts| &counts.lost);
            println!("lost, strays by {:?} from period {period}:\n{}", long.strays(period), drawn.text());
        } else {
            add(|counts| &counts.open);
        }
        Ok(true)
    });
    let [anywhere, beside] = &counts;
    println!("anywhere {anywhere:?}, beside an event {beside:?}");
    assert!(anywhere.settled.get() > 20 && anywhere.settled.get() >= 50 * anywhere.lost.get());
}
