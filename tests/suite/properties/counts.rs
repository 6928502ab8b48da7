//! Impacts are counted by one rule: alike in a run, on its periodic motion, in a section, and at every
//! tolerance.

use std::cell::Cell;
use std::sync::atomic::AtomicBool;

use interwell::dynamics::{EventKind, Model, Outcome, Request, Summary};
use interwell_studies::study::{SectionAt, SectionOptions, orbit, section};
use proptest::prelude::*;

use super::harness::hold_for;
use crate::shared::{build, changed};

/// Scenes of the prototype and of the cubic: preset, distance of the stops in mm, amplitude in g,
/// restitution.
type Drawn = (usize, f64, f64, f64);

const NAMES: [&str; 2] = ["paper", "nominal-cubic"];

fn fields(drawn: &Drawn) -> [String; 3] {
    [
        format!("stops.travel_limit_mm={}", drawn.1),
        format!("excitation.amplitude_g={}", drawn.2),
        format!("stops.restitution={}", drawn.3),
    ]
}

/// The run, where the motion repeats and no impact is within a thousandth of the speed from which on impacts
/// count: rounding decides whether such a one does.
fn clear(model: &Model) -> Option<Summary> {
    let run = model.run(&Request { events: true, ..Request::default() });
    let edge = |speed: f64| (speed / model.min_impact_speed() - 1.0).abs() < 1e-3;
    let near = run.events.iter().any(|event| event.kind == EventKind::Impact && edge(event.v_in.abs()));
    (run.summary.outcome == Outcome::Done && run.summary.period.is_some() && !near).then_some(run.summary)
}

#[test]
fn impacts_are_counted_alike_by_runs_orbits_and_sections_at_any_tolerance() {
    let drawn = (0..NAMES.len(), 0.5..7.0f64, 0.3..2.0f64, 0.05..0.9f64);
    let (impacts, rests, compared) = (Cell::new(0), Cell::new(0), Cell::new(0));
    let name = "impacts_are_counted_alike_by_runs_orbits_and_sections_at_any_tolerance";
    let show = |drawn: &Drawn| format!("{} {:?}", NAMES[drawn.0], fields(drawn));
    hold_for(name, 200, 0.25, drawn, show, |drawn| {
        let fields = fields(drawn);
        let changes: Vec<&str> = fields.iter().map(String::as_str).chain(["run.duration_s=30"]).collect();
        let document = changed(NAMES[drawn.0], &changes);
        let model = build(&document);
        let Some(expected) = clear(&model) else { return Ok(false) };
        if expected.total_impacts == 0 {
            return Ok(false);
        }
        impacts.set(impacts.get() + expected.impacts);
        rests.set(rests.get() + expected.rests);
        // a periodic motion, at its own finer tolerance
        let found = orbit(&model, 0.0, None, &AtomicBool::new(false));
        let found = found.map_err(|error| TestCaseError::fail(error.to_string()))?;
        prop_assert_eq!(Some(found.period), expected.period);
        let laps = expected.periods / u64::from(found.period);
        if expected.periods == laps * u64::from(found.period) {
            prop_assert_eq!(found.passage.impacts * laps, expected.impacts);
        }
        let options =
            SectionOptions { at: SectionAt::Impacts, periods: None, until_settled: None, carry: None };
        let (table, summary) = section(&model, &document.scene, &options, &AtomicBool::new(false)).unwrap();
        prop_assert_eq!((table.rows() as u64, summary.impacts), (expected.impacts, expected.impacts));
        for tolerance in [1e-6, 1e-7, 1e-8, 1e-10, 1e-12, 1e-14] {
            let other = model.with_tolerance(tolerance);
            let Some(other) = clear(&other) else { continue };
            // the same motion: where the start leads depends on the tolerance beside a border of basins
            let (a, b) = (expected.rms_velocity.unwrap(), other.rms_velocity.unwrap());
            if other.period == expected.period && (a / b - 1.0).abs() < 1e-5 {
                prop_assert_eq!(other.impacts, expected.impacts, "{}", tolerance);
                compared.set(compared.get() + 1);
            }
        }
        Ok(true)
    });
    assert!(impacts.get() > 10_000 && rests.get() > 1000, "{} {}", impacts.get(), rests.get());
    assert!(compared.get() > 400, "{}", compared.get());
}

#[test]
fn the_prototype_has_26_impacts_a_period_at_every_tolerance() {
    let even = "stops.restitution=0.36";
    let uneven = "stops=Uneven(left_mm: 1.5, right_mm: 1.7, restitution_left: 0.36, restitution_right: 0.36)";
    for stops in [even, uneven] {
        let reference = build(&changed("paper", &[stops])).run(&Request::default()).summary;
        for tolerance in [1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14] {
            let tolerance = format!("run.tolerance={tolerance:e}");
            let model = build(&changed("paper", &[&tolerance, stops]));
            let summary = model.run(&Request::default()).summary;
            assert_eq!(
                (summary.impacts, summary.total_impacts),
                (reference.impacts, reference.total_impacts),
                "{tolerance}"
            );
            let found = orbit(&model, 0.0, None, &AtomicBool::new(false)).unwrap();
            assert_eq!(found.passage.impacts * summary.periods, summary.impacts, "{tolerance} {stops}");
            if stops == even {
                assert_eq!(found.passage.impacts, 26, "{tolerance}");
            }
        }
    }
}
