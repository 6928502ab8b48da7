//! Whether a motion has settled: held against its own stroboscopic states, against closed forms, and alike
//! however it is computed.

use std::cell::Cell;
use std::f64::consts::TAU;

use interwell::dynamics::{Model, Outcome, Regime, Request, StroboscopicMap, Summary};
use interwell::scene::Stops;
use proptest::prelude::*;

use super::harness::{Verdict, hold, hold_for};
use super::scenes::{elastic, excitation, model, rigid_stops, scene_with, sine, stops};

/// Two states are alike where they differ by no more than this share of the scales.
const MATCH: f64 = 1e-3;

/// The distance of two states as a share of the scales.
fn apart(model: &Model, a: (f64, f64), b: (f64, f64)) -> f64 {
    let scales = model.scales();
    ((a.0 - b.0) / scales.length).abs().max(((a.1 - b.1) / scales.speed).abs())
}

/// The states once a forcing period over the window, its first and last instants among them.
fn strobes(model: &Model, summary: &Summary) -> Option<Vec<(f64, f64)>> {
    let (from, periods) = (summary.window.0, summary.periods);
    let last = from + periods as f64 * model.forcing_period()?;
    let times: Vec<f64> = (0..=periods)
        .map(|i| (from + i as f64 * model.forcing_period().unwrap_or(0.0)).min(model.duration()))
        .collect();
    let samples = model.run(&Request { sample_times: &times, ..Request::default() }).samples;
    (last <= model.duration() * (1.0 + 1e-12) && samples.len() == times.len())
        .then(|| samples.iter().map(|sample| (sample.x, sample.v)).collect())
}

/// Whether a motion of one forcing period without a circuit clearly attracts others, by the multipliers
/// of the map from its last state; its window begins at a whole number of periods.
fn attracts(model: &Model, summary: &Summary) -> bool {
    let Some(period) = model.forcing_period() else { return false };
    let cycles = summary.window.0 / period;
    if model.circuit_state().is_some() || (cycles - cycles.round()).abs() > 1e-9 {
        return false;
    }
    let map = StroboscopicMap::over(model, period);
    let (lap, slopes) = map.pass_with_jacobian((summary.final_x, summary.final_v), 1);
    let multipliers = slopes.multipliers(slopes.determinant());
    lap.outcome == Outcome::Done && slopes.is_finite() && multipliers[0].magnitude() < 0.95
}

/// What a summary says of one motion agrees with itself.
fn agrees_with_itself(model: &Model, summary: &Summary) -> Verdict {
    let rests = summary.regime == Regime::Rest
        || (summary.regime == Regime::OneWell
            && summary.travel().is_some_and(|way| way <= 1e-12 * model.scales().length));
    match summary.settled {
        None => {
            prop_assert!(summary.period.is_none() && summary.settles_at.is_none() && summary.steady.is_none())
        }
        Some(true) => {
            prop_assert!(summary.outcome == Outcome::Done && summary.steady == Some(true), "{:?}", summary);
            prop_assert!(
                summary.period.is_some() || rests || summary.rested_share == Some(1.0),
                "{:?}",
                summary
            );
            prop_assert!(
                summary.settles_at.is_none_or(|at| at <= summary.window.0 * (1.0 + 1e-12)),
                "{:?}",
                summary
            );
        }
        Some(false) => {
            prop_assert!(summary.period.is_none() && summary.settles_at.is_none(), "{:?}", summary);
            prop_assert!(
                !(rests && summary.periods > 0 && summary.outcome == Outcome::Done),
                "{:?}",
                summary
            );
        }
    }
    if summary.period.is_some() {
        prop_assert!(summary.settled == Some(true) && summary.settles_at.is_some(), "{:?}", summary);
    }
    Ok(())
}

#[test]
fn a_motion_has_settled_where_its_states_come_back_or_it_rests() {
    let (periodic, repeat) = (Cell::new(0), Cell::new(0));
    let scenes = scene_with(stops(), prop_oneof![3 => sine(), 1 => excitation()]);
    hold("a_motion_has_settled_where_its_states_come_back_or_it_rests", 1000, 0.5, scenes, |scene| {
        let Some(mut model) = model(scene) else { return Ok(false) };
        // some more periods than are drawn, where they are not long
        let short = |period: &f64| model.repeats() && *period < 100.0 * model.scales().time;
        if let Some(period) = model.forcing_period().filter(short).filter(|_| !elastic(&scene.stops)) {
            model = model.with_duration(60.0 * period, 30.0 * period);
        }
        let summary = model.run(&Request::default()).summary;
        agrees_with_itself(&model, &summary)?;
        if !model.repeats()
            || summary.outcome != Outcome::Done
            || summary.periods < 2
            || summary.periods > 400
        {
            return Ok(true);
        }
        periodic.set(periodic.get() + 1);
        let Some(states) = strobes(&model, &summary) else { return Ok(true) };
        let comes_back = |q: usize, within: f64| {
            states.windows(q + 1).all(|pair| apart(&model, pair[0], pair[q]) <= within)
        };
        let drift = |q: usize| {
            let whole = (states.len() - 1) / (2 * q) * 2 * q;
            let laps = states.windows(whole + 1).rev().take(q);
            laps.map(|pair| apart(&model, pair[0], pair[whole])).fold(0.0, f64::max)
        };
        // within rounding of the times at which the samples are taken
        let most = MATCH * (1.0 + 1e-6);
        match summary.period {
            // The period is that of the orbit. The states of a motion that is on one side of it and on the
            // other in turn may come back after a multiple of it first.
            Some(q) => {
                let q = q as usize;
                repeat.set(repeat.get() + 1);
                let repeats = |q: usize| 2 * q < states.len() && comes_back(q, most) && drift(q) <= most;
                prop_assert!((q..=12).step_by(q).any(repeats), "{:?}", summary);
                let [.., last] = states[..] else { return Ok(true) };
                let before = states[states.len() - 1 - q];
                prop_assert!(apart(&model, before, last) <= 3.0 * most, "{:?}", summary);
            }
            // states that stand still over the whole window are not passed over, if anything attracts them
            None => {
                let still = comes_back(1, 1e-6) && drift(1) <= 1e-6 && model.tolerance() <= 1e-5;
                let clearly = still && summary.settled == Some(false) && attracts(&model, &summary);
                prop_assert!(!clearly, "{:?}", summary);
            }
        }
        Ok(true)
    });
    println!("{} under drives that repeat, {} repeat", periodic.get(), repeat.get());
    assert!(repeat.get() > 200);
}

#[test]
fn a_verdict_does_not_depend_on_how_it_is_computed() {
    let recurs = Cell::new(0);
    let stops = prop_oneof![1 => Just(Stops::None), 4 => rigid_stops()];
    let scenes = scene_with(stops, sine()).prop_filter("elastic", |scene| !elastic(&scene.stops));
    hold("a_verdict_does_not_depend_on_how_it_is_computed", 400, 0.5, scenes, |scene| {
        let Some(model) = model(scene) else { return Ok(false) };
        let Some(period) = model.forcing_period() else { return Ok(false) };
        // a window of some periods from the start on, and some more of them
        let short = model.with_duration(9.0 * period, period).with_recurrence(true);
        for until_settled in [None, Some(60.0 * period)] {
            let request = Request { until_settled, ..Request::default() };
            let summary = short.run(&request).summary;
            agrees_with_itself(&short, &summary)?;
            let plain = short.with_recurrence(false).run(&request).summary;
            recurs.set(recurs.get() + u32::from(summary.steps < plain.steps));
            let verdict = |one: &Summary| {
                let Summary { regime, settled, steady, period, periods, .. } = *one;
                let counts =
                    (one.crossings, one.impacts, one.releases, one.total_impacts, one.total_crossings);
                (regime, settled, steady, period, periods, counts)
            };
            if summary.outcome == Outcome::Done && plain.outcome == Outcome::Done {
                prop_assert_eq!(verdict(&summary), verdict(&plain));
                let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * period;
                prop_assert!(near(summary.window.0, plain.window.0));
                let same = summary.settles_at.zip(plain.settles_at).map(|(a, b)| near(a, b));
                prop_assert!(same.unwrap_or(summary.settles_at == plain.settles_at));
            }
            let together = Model::run_together(&vec![short.clone(); 3], &request);
            for mut other in together.into_iter().map(|run| run.summary) {
                other.cpu_s = summary.cpu_s;
                prop_assert_eq!(format!("{other:?}"), format!("{summary:?}"));
            }
        }
        Ok(true)
    });
    assert!(recurs.get() > 100, "{}", recurs.get());
}

/// A linear oscillator: its damping ratio, forcing periods before and in the window, the drive's rate as a
/// multiple of its own, and its start as a multiple of the steady amplitude.
type Oscillator = (f64, u32, u32, f64, f64);

#[test]
fn an_approach_has_settled_once_what_remains_is_small() {
    // x'' + 2 z x' + x = -A sin(w t): the transient shrinks by exp(-z) a unit of time, so that what remains
    // of it is known at any time
    let drawn = ((-3.5..-0.5f64), 0..120u32, 2..80u32, 0.3..3.0f64, -3.0..3.0f64);
    let (settled, open) = (Cell::new(0), Cell::new(0));
    let show = |drawn: &Oscillator| format!("{drawn:?}");
    let name = "an_approach_has_settled_once_what_remains_is_small";
    hold_for(name, 2000, 0.9, drawn, show, |(power, before, periods, rate, start)| {
        let ratio = 10f64.powf(*power);
        let period = TAU / rate;
        let (settle, duration) = (f64::from(*before) * period, f64::from(before + periods) * period);
        let model = crate::support::model(&format!(
            "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, 1]), damping: Ratio({ratio}), \
             excitation: Sine(frequency_hz: {:?}, amplitude_g: 0.1), start: At(x_mm: {:?}, v_m_per_s: 0), \
             run: (duration_s: {:?}, settle_s: {settle:?}, tolerance: 1e-12)",
            1.0 / period,
            1e3 * start,
            duration * (1.0 + 1e-12)
        ));
        let summary = model.run(&Request::default()).summary;
        prop_assert_eq!(summary.periods, u64::from(*periods));
        agrees_with_itself(&model, &summary)?;
        // the steady motion, and what the start is off it
        let push = -0.1 * interwell::dynamics::STANDARD_GRAVITY;
        let (re, im) = (1.0 - rate * rate, 2.0 * ratio * rate);
        let size = push / (re * re + im * im);
        let (x, v) = (start + size * im, -size * rate * re);
        // the norm in which the transient shrinks evenly, within its swing of some ratios
        let remains = |t: f64| (-ratio * t).exp() * x.hypot(v) / model.scales().length;
        let (first, last) = (remains(settle), remains(duration));
        if summary.period.is_some() {
            settled.set(settled.get() + 1);
            // Three states may agree by chance while the transient turns; what is known is what it shrinks
            // by over half a window.
            let half = (-ratio * 0.5 * f64::from(*periods) * period).exp();
            prop_assert!(last <= 3.0 * MATCH || half > 0.98, "{} remains of {}, {:?}", last, first, summary);
        } else {
            open.set(open.get() + 1);
            prop_assert!(first > 0.1 * MATCH, "{} remains of {}, {:?}", last, first, summary);
        }
        Ok(true)
    });
    println!("{} have settled, {} have not", settled.get(), open.get());
    assert!(settled.get() > 300 && open.get() > 300);
}
