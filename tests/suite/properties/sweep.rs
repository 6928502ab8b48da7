//! Bytes of a random grid over a random scene for any number of threads.

use std::sync::atomic::AtomicBool;

use interwell::output;
use interwell::scene::{Axis, FieldPath, Files, Mechanism, Scene, corners, numeric_fields};
use interwell_studies::study::{Grid, Sweep, Task};
use proptest::prelude::*;

use super::harness::{hold_for, text};
use super::scenes::scene;

/// Two of the numbers that the scene has.
fn fields(scene: &Scene, picks: [usize; 2]) -> [String; 2] {
    let solved = matches!(scene.mechanism, Mechanism::Flexures { .. }); // one for each cell would take long
    let fields: Vec<String> = numeric_fields(scene)
        .into_iter()
        .filter(|field| FieldPath::new(field).get(scene).is_some())
        .filter(|field| !(solved && field.starts_with("mechanism")))
        .collect();
    picks.map(|pick| fields[pick % fields.len()].clone())
}

/// An axis over each of them, around its value in the scene; none where the scene would not allow it.
fn axes(scene: &Scene, picks: [usize; 2]) -> Option<Vec<Axis>> {
    let fields = fields(scene, picks);
    let around = |field: &String| {
        let value = FieldPath::new(field).get(scene)?;
        let values = [0.8, 1.0, 1.1].map(|share| format!("{:?}", value * share)).join(",");
        Axis::parse(&format!("{field}={values}"), scene).ok()
    };
    let axes: Vec<Axis> = fields.iter().map(around).collect::<Option<_>>()?;
    (fields[0] != fields[1] && corners(scene, &axes).is_empty()).then_some(axes)
}

#[test]
fn a_sweep_is_the_same_bytes_for_any_number_of_threads() {
    let scenes = (scene(), any::<[usize; 2]>());
    let name = "a_sweep_is_the_same_bytes_for_any_number_of_threads";
    let show = |(scene, picks): &(Scene, [usize; 2])| format!("{}\n{:?}", text(scene), fields(scene, *picks));
    hold_for(name, 200, 0.4, scenes, show, |(scene, picks)| {
        let Some(axes) = axes(scene, *picks) else { return Ok(false) };
        let cancel = AtomicBool::new(false);
        let task = Task { tick: &|| (), cancel: &cancel };
        let mut bytes = Vec::new();
        for threads in [1, 2, 3] {
            let grid = Grid::new(axes.clone()).unwrap();
            let sweep = Sweep::new(scene, &Files::default(), grid);
            let pool = interwell::system::threads::Pool::new(threads).unwrap();
            if sweep.validate(&pool, &task).is_err() {
                return Ok(false);
            }
            let mut text = output::header(&sweep.empty_table());
            sweep
                .run(&pool, &task, |table| {
                    text += &output::rows(table, 0..table.rows());
                    Ok::<_, ()>(true)
                })
                .unwrap();
            bytes.push(text);
        }
        prop_assert!(bytes.iter().all(|csv| *csv == bytes[0] && csv.lines().count() == 10), "{:?}", bytes);
        Ok(true)
    });
}
