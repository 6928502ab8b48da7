//! Rigid stops at any place: at 0, both on one side of it, one alone.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use interwell::dynamics::{Model, Request, Run};
use interwell::scene::{Excitation, Files, Scene, Start, Stops};
use interwell::system::threads::Pool;
use interwell_studies::study::accuracy::methods::Scheme;
use interwell_studies::study::accuracy::scene::{step_size, trust};
use interwell_studies::study::*;
use proptest::prelude::*;

use super::harness::{Verdict, hold};
use super::mirror::{image, same_in_a_mirror};
use super::runs::{same_bits, times};
use super::scenes::{excitation, model, restitution, scene_with, sine};
use super::sound::{LEDGER, sound};

/// One stop at a place and, unless that side is open, the other one a room away, in natural units.
fn stops() -> impl Strategy<Value = Stops> {
    let place = prop_oneof![2 => Just(0.0), 6 => -2.0..2.0f64, 1 => -2e-3..2e-3f64];
    let room =
        prop_oneof![1 => Just(None), 4 => (0.02..2.0f64).prop_map(Some), 1 => (1e-5..1e-3f64).prop_map(Some)];
    let given = (restitution(), prop::option::of(restitution()));
    (place, room, any::<bool>(), given).prop_map(|(place, room, mirrored, (one, other))| {
        // the distances of a left stop at the place and of the right one, or their mirror images
        let (near, far) = (Some(-place), room.map(|room| place + room));
        let (left_mm, right_mm) = if mirrored { (far, near) } else { (near, far) };
        Stops::Uneven { left_mm, right_mm, restitution_left: Some(one), restitution_right: other }
    })
}

/// No displacement is -0.
fn no_negative_zero(run: &Run) -> Verdict {
    let (low, high) = run.summary.range.unwrap_or_default();
    let all = run.samples.iter().map(|sample| sample.x).chain([run.summary.final_x, low, high]);
    prop_assert!(!all.into_iter().any(|x| x == 0.0 && x.is_sign_negative()), "-0 in {:?}", run.summary);
    Ok(())
}

#[test]
fn a_run_between_stops_anywhere_is_sound_and_mirrored() {
    let scenes = scene_with(stops(), excitation());
    hold("a_run_between_stops_anywhere_is_sound_and_mirrored", 1000, 0.7, scenes, |scene| {
        let Some(plain) = model(scene) else { return Ok(false) };
        let times = times(scene, 100);
        let request = Request { sample_times: &times, events: true, ledger: true, ..Request::default() };
        let run = plain.run(&request);
        sound(scene, &plain, &run, LEDGER)?;
        no_negative_zero(&run)?;
        if let Some(other) = image(scene).and_then(|image| model(&image)) {
            same_in_a_mirror(&run, &other.run(&request))?;
        }
        Ok(true)
    });
}

#[test]
fn runs_between_stops_anywhere_have_the_same_bits_in_company() {
    let scenes = scene_with(stops(), excitation());
    hold("runs_between_stops_anywhere_have_the_same_bits_in_company", 200, 0.7, scenes, |scene| {
        let Some(model) = model(scene) else { return Ok(false) };
        let (x, v) = model.start();
        let speed = model.scales().speed;
        let all: Vec<Model> = (0..6).map(|i| model.with_start((x, v + 0.1 * f64::from(i) * speed))).collect();
        for (together, alone) in Model::run_together(&all, &Request::default()).iter().zip(&all) {
            same_bits(&alone.run(&Request::default()), together)?;
        }
        Ok(true)
    });
}

/// The place of rest is between the stops; a mass put there without a drive stays within rounding.
#[test]
fn a_mass_rests_where_it_is_said_to() {
    let scenes = scene_with(stops(), Just(Excitation::None));
    hold("a_mass_rests_where_it_is_said_to", 400, 0.4, scenes, |drawn| {
        let scene = Scene { start: Start::Rest, ..drawn.clone() };
        let Some(model) = model(&scene) else { return Ok(false) };
        let summary = model.run(&Request::default()).summary;
        let moved = (summary.final_x - model.start().0).abs();
        prop_assert!(moved <= 1e-6 * model.scales().length, "{moved} in {summary:?}");
        Ok(true)
    });
}

/// Every study of a driven scene ends with an answer or with a reason, and what it says lies between the
/// stops.
#[test]
fn every_study_takes_stops_anywhere() {
    let never = AtomicBool::new(false);
    let task = Task { tick: &|| (), cancel: &never };
    hold("every_study_takes_stops_anywhere", 40, 0.5, scene_with(stops(), sine()), |drawn| {
        let mut scene = drawn.clone();
        scene.run.tolerance = scene.run.tolerance.max(1e-9);
        let Some(model) = model(&scene) else { return Ok(false) };
        let (mechanism, files) = (Arc::clone(model.mechanism()), Files::default());
        let (left, right) = model.stop_positions();
        let inside = |x: f64| left.is_none_or(|stop| x >= stop) && right.is_none_or(|stop| x <= stop);
        let period = model.forcing_period();
        // a longer one takes long
        let Some(period) = period.filter(|period| *period < 30.0 * model.scales().time) else {
            return Ok(false);
        };
        let until_settled = Some(model.duration() + 20.0 * period);

        prop_assert!(!inspect(&scene, &model).is_empty());
        let positions = default_positions(&scene, &mechanism, 101);
        let ends = (positions[0], positions[100]);
        let (low, high) = mechanism.curve.domain();
        for stop in [left, right].into_iter().flatten() {
            prop_assert!((ends.0..=ends.1).contains(&stop.clamp(low, high)), "{stop} outside {ends:?}");
        }
        simulate(&model, &Keep { times: times(&scene, 10), events: true, until_settled }, None);
        if let Some(standing) =
            standing(&model, &model.run(&Request { sample_times: &[0.0], ..Request::default() }).samples[0])
        {
            prop_assert!(standing.needed_j.is_finite(), "{standing:?}");
        }
        let Ok((rows, _)) = section(
            &model,
            &scene,
            &SectionOptions { periods: Some((4, 4)), until_settled, ..SectionOptions::default() },
            &never,
        ) else {
            return Ok(false);
        };
        prop_assert!(rows.numbers("x_m").unwrap().iter().all(|x| inside(*x)));
        if let Ok(found) = orbit(&model.with_duration(4.0 * period, period), 0.0, None, &never) {
            prop_assert!(inside(found.state.x), "{found:?}");
        }
        let options = ExponentOptions { periods: 10, until_settled, circuits: false };
        if let Ok(found) = exponents(&model, &options, &never) {
            prop_assert!(!found.first.per_s.is_nan() && !found.second.per_s.is_nan());
        }
        let _ = (trust(&model, &never), step_size(&model, Scheme::RungeKutta4, period / 100.0, &never));
        for onset in [Onset::Release, Onset::Crossing] {
            let values = (1..4).map(|i| 0.3 * f64::from(i)).collect();
            let scan =
                Scan { field: "excitation.amplitude_g".into(), values, resolution: 0.1, until_settled };
            let found = threshold(&scene, &mechanism, &files, &scan, onset, &task).unwrap();
            let crosses = onset == Onset::Crossing && found.value.is_some();
            prop_assert!(!crosses || can_cross(&scene, &mechanism), "{found:?}");
        }
        Ok(true)
    });
}

#[test]
fn basins_take_stops_anywhere() {
    let never = AtomicBool::new(false);
    let task = Task { tick: &|| (), cancel: &never };
    let pool = Pool::new(1).unwrap();
    hold("basins_take_stops_anywhere", 16, 0.3, scene_with(stops(), sine()), |drawn| {
        let mut scene = drawn.clone();
        scene.run.tolerance = 1e-6;
        let Some(model) = model(&scene) else { return Ok(false) };
        if model.forcing_period().is_none_or(|period| period > 10.0 * model.scales().time) {
            return Ok(false); // takes long
        }
        let (low, high) = model.mechanism().curve.domain();
        let (left, right) = model.stop_positions();
        let (low, high) = (left.unwrap_or(low), right.unwrap_or(high));
        let at = |x: f64| 1e3 * x.clamp(low, high);
        let size = model.scales().length;
        let x_mm = EvenRange { from: at(-size), to: at(size), count: 2 };
        let v = EvenRange { from: 0.0, to: 0.0, count: 1 };
        let Ok(starts) = Starts::grid(&x_mm, &v) else { return Ok(false) };
        let Ok(mut basins) = BasinMap::new(&scene, Arc::clone(model.mechanism()), starts) else {
            return Ok(false);
        };
        prop_assert!(basins.room().0 < basins.room().1);
        prop_assert!(basins.run_level(&pool, &task));
        prop_assert!(basins.answer(&task).is_some());
        Ok(true)
    });
}
