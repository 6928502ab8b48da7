//! Properties of one run of any scene, of its mirror image, and of the same run watched otherwise.

use std::cell::Cell;

use interwell::dynamics::{Outcome, Request, Run};
use interwell::scene::{Scene, Stops};
use proptest::prelude::*;

use super::harness::{Verdict, hold};
use super::mirror::{image, same_in_a_mirror};
use super::scenes::{elastic, excitation, model, rigid_stops, scene, scene_with};
use super::sound::{LEDGER, ledger_in_tolerances, sound};

/// Steps in which a scene of these sizes must be through where no stop is elastic.
const STEPS: u64 = 200_000;

pub fn times(scene: &Scene, n: usize) -> Vec<f64> {
    let end = scene.run.duration_s;
    (0..=n).map(|i| (end * i as f64 / n as f64).min(end)).collect()
}

#[test]
fn any_scene_runs_soundly() {
    let worst = Cell::new(0.0_f64);
    hold("any_scene_runs_soundly", 2000, 0.8, scene(), |scene| {
        let Some(model) = model(scene) else { return Ok(false) };
        let times = times(scene, 300);
        let run =
            model.run(&Request { sample_times: &times, events: true, ledger: true, ..Request::default() });
        if run.summary.outcome == Outcome::Done {
            prop_assert_eq!(run.samples.len(), times.len());
        }
        prop_assert!(elastic(&scene.stops) || run.summary.steps < STEPS, "{} steps", run.summary.steps);
        sound(scene, &model, &run, LEDGER)?;
        if !matches!(run.summary.outcome, Outcome::NotFinite { .. }) {
            worst.set(worst.get().max(ledger_in_tolerances(&model, &run)));
        }
        Ok(true)
    });
    println!("the ledger closes to {:.2} tolerances", worst.get());
}

#[test]
fn a_mirrored_scene_has_the_mirrored_run() {
    hold("a_mirrored_scene_has_the_mirrored_run", 1000, 0.5, scene(), |scene| {
        let Some(image) = image(scene) else { return Ok(false) };
        let (Some(plain), Some(other)) = (model(scene), model(&image)) else { return Ok(false) };
        let times = times(scene, 100);
        let request = Request { sample_times: &times, events: true, ledger: true, ..Request::default() };
        same_in_a_mirror(&plain.run(&request), &other.run(&request))?;
        Ok(true)
    });
}

pub fn same_bits(a: &Run, b: &Run) -> Verdict {
    for (p, q) in a.samples.iter().zip(&b.samples) {
        prop_assert_eq!(p, q);
    }
    prop_assert_eq!(a.samples.len(), b.samples.len());
    prop_assert!(a.events == b.events, "other events");
    let mut summary = b.summary;
    summary.cpu_s = a.summary.cpu_s;
    prop_assert_eq!(a.summary, summary);
    Ok(())
}

#[test]
fn a_stop_that_is_never_reached_changes_no_bit() {
    let scenes = scene_with(Just(Stops::None), excitation());
    hold("a_stop_that_is_never_reached_changes_no_bit", 1000, 0.6, scenes, |scene| {
        let mut open = scene.clone();
        open.run.settle_s = Some(0.0);
        let Some(open_model) = model(&open) else { return Ok(false) };
        let times = times(scene, 100);
        let request = Request { sample_times: &times, events: true, ledger: true, ..Request::default() };
        let run = open_model.run(&request);
        if run.summary.outcome != Outcome::Done {
            return Ok(false);
        }
        // The reach is that of the settled window, which is all of the run where the drive has no period.
        let seen = run.samples.iter().fold(run.summary.max_abs_x.unwrap(), |most, s| most.max(s.x.abs()));
        let beyond = if open_model.forcing_period().is_none() { 1.0 + 1e-9 } else { 1.5 };
        let just = (seen * 1e3 * beyond).max(1e-12);
        let hertz = Stops::Hertz {
            travel_limit_mm: just * 1.5,
            stiffness_n_per_m1_5: Some(1e6),
            loss_s_per_m: 1.0,
            radius_mm: None,
            young_gpa: None,
            poisson: None,
            yield_gpa: None,
        };
        let one = |left_mm, right_mm| Stops::Uneven {
            left_mm,
            right_mm,
            restitution_left: Some(0.3),
            restitution_right: None,
        };
        let mut compared = 0;
        for stops in [
            Stops::Rigid { travel_limit_mm: just, restitution: 0.36 },
            Stops::Rigid { travel_limit_mm: just * 1e4, restitution: 1.0 },
            one(Some(just), None),
            one(None, Some(just * 2.0)),
            hertz,
        ] {
            let stopped = Scene { stops, ..open.clone() };
            let Some(stopped_model) = model(&stopped) else { continue };
            // Stops far inside all that the mass could do otherwise set the scale: it is soon at one of them,
            // unless the run is shorter.
            if stopped_model.scales() != open_model.scales() {
                continue;
            }
            let mut watched = stopped_model.run(&request);
            watched.summary.peak_contact_force = None; // none where there is nothing to touch
            same_bits(&run, &watched).map_err(|e| TestCaseError::fail(format!("{e}, with {stops:?}")))?;
            compared += 1;
        }
        Ok(compared > 0)
    });
}

#[test]
fn watching_changes_no_bit() {
    hold("watching_changes_no_bit", 800, 0.8, scene(), |scene| {
        let Some(model) = model(scene) else { return Ok(false) };
        let times = times(scene, 97);
        let few: Vec<f64> = times.iter().step_by(13).copied().collect();
        let full =
            model.run(&Request { sample_times: &times, events: true, ledger: true, ..Request::default() });
        for (sample_times, events, ledger) in
            [(&[][..], false, false), (&few, false, false), (&few, true, false), (&times, false, true)]
        {
            let run = model.run(&Request { sample_times, events, ledger, ..Request::default() });
            let mut expected = full.clone();
            expected.samples.retain(|sample| sample_times.contains(&sample.t));
            expected.events.retain(|_| events);
            if !ledger {
                (expected.summary.ledger, expected.summary.mean_x) = (None, None);
                expected.summary.impact_share = None;
            }
            same_bits(&expected, &run)?;
        }
        Ok(true)
    });
}

#[test]
fn threads_change_no_bit() {
    hold("threads_change_no_bit", 300, 0.8, scene_with(rigid_stops(), excitation()), |scene| {
        let Some(model) = model(scene) else { return Ok(false) };
        let request =
            Request { sample_times: &times(scene, 20), events: true, ledger: true, ..Request::default() };
        let alone = model.run(&request);
        let others: Vec<Run> = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..3).map(|_| scope.spawn(|| model.run(&request))).collect();
            threads.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        others.iter().try_for_each(|other| same_bits(&alone, other))?;
        Ok(true)
    });
}
