//! The map of the open scene: its axes, the place of the scene on it, moves to a cell.

use std::sync::Arc;
use std::time::Duration;

use crate::app::session::Session;
use crate::app::task::wait_while;
use crate::app::words::fields::{in_words, name_and_unit};
use crate::scene::{Axis, FieldPath, Stops, SweepAxis};
use crate::study::release_line;

use super::cells::too_many;
use super::{Map, Question, axes};

impl Session {
    /// The axes of the map; none where the scene has too few fields.
    pub fn map_axes(&self) -> Option<[SweepAxis; 2]> {
        let (scene, when_on) = (self.scene(), self.remembered_stops());
        for own in [&self.map.chosen, &self.map.held].into_iter().flatten() {
            let ground = axes::ground(scene, when_on, own);
            if own.iter().all(|axis| FieldPath::new(&axis.field).get(&ground).is_some()) {
                return Some(own.clone());
            }
        }
        axes::default_axes(scene, when_on, self.well_mm())
    }

    /// The fields that a map of this scene can go over.
    pub fn map_fields(&self) -> Vec<String> {
        axes::fields(self.scene(), self.remembered_stops())
    }

    /// An axis over a field, around where the scene is.
    pub fn map_axis(&self, field: &str) -> SweepAxis {
        axes::axis(field, self.scene(), self.remembered_stops(), self.well_mm())
    }

    fn well_mm(&self) -> Option<f64> {
        self.model().mechanism().landscape.right_stable().map(|well| well.x * 1e3)
    }

    /// Asks for the map of the scene as it stands, in the frame at `time`. Whether it waits for the hand to
    /// be still.
    pub fn want_map(&mut self, time: f64) -> bool {
        let Some(axes) = self.map_axes() else {
            self.map.problem = Some("This scene has no two fields to make a map over.".to_owned());
            return false;
        };
        // a choice that the scene has no fields for at the moment is kept for when it has
        if self.map.chosen.as_ref() != Some(&axes) {
            self.map.held = Some(axes.clone());
        }
        let mut scene = axes::ground(self.scene(), self.remembered_stops(), &axes);
        for axis in &axes {
            if !FieldPath::new(&axis.field).set(&mut scene, axis.from) {
                return false;
            }
        }
        let wake = Arc::clone(self.wake());
        let in_gesture = self.editor.in_gesture();
        let quantity = self.map.quantity();
        let same =
            self.map.map.as_ref().filter(|map| map.question.scene == scene && map.question.axes == axes);
        // runs that sum up their energies have all that the others have
        let needed = || quantity.field().filter(|field| field.needs_ledger).map(|_| quantity.column);
        let ledger = same.and_then(|map| map.question.ledger).or_else(needed);
        let waits = self.map.ask(Question { scene, axes, ledger }, &self.editor, in_gesture, time, &wake);
        let mechanism = Arc::clone(self.model().mechanism());
        if let Some(map) = self.map.map.as_mut().filter(|map| map.known == 0 && map.release.is_empty())
            && !map.grid().changes_mechanism()
            && let Some(line) = release_line(&map.question.scene, &mechanism, map.sweep.grid())
        {
            let columns = map.grid().columns();
            let (x, y) = (line.numbers(&columns[0]), line.numbers(&columns[1]));
            map.release = x.into_iter().flatten().copied().zip(y.into_iter().flatten().copied()).collect();
        }
        waits
    }

    /// Where the scene stands on the axes of a map; none on an axis whose field it lacks, as a travel limit
    /// without stops.
    pub fn place_on_map(&self, question: &Question) -> [Option<f64>; 2] {
        question.axes.each_ref().map(|axis| FieldPath::new(&axis.field).get(self.scene()))
    }

    /// Why axes cannot be those of a map of the scene: which of the two is at fault, which of its parts, and
    /// a sentence. None where they can.
    pub fn map_problem(&self, axes: &[SweepAxis; 2]) -> Option<(usize, &'static str, String)> {
        let ground = axes::ground(self.scene(), self.remembered_stops(), axes);
        let mut cells = 1;
        for (i, axis) in axes.iter().enumerate() {
            match Axis::from_scene(axis, &ground) {
                Err((part, problem)) => {
                    let why = in_words(&problem, &ground);
                    return Some((i, part, format!("{}, {part}: {why}", name_and_unit(&axis.field).0)));
                }
                Ok(axis) => cells *= axis.values.len() as u64,
            }
        }
        too_many(cells).map(|problem| (1, "step", problem))
    }

    /// Takes the scene to a cell of its map, by one gesture; the motion goes on from where it is.
    pub fn go_to_cell(&mut self, column: usize, row: usize) {
        self.end_gesture();
        self.drag_to_cell(column, row);
        self.end_gesture();
    }

    /// The same as part of a gesture.
    pub fn drag_to_cell(&mut self, column: usize, row: usize) {
        let Some((map, _)) = self.map.shown() else { return };
        let (Some(x), Some(y)) = (map.edges[0].values.get(column), map.edges[1].values.get(row)) else {
            return;
        };
        let (values, axes, stops) = ([*x, *y], map.question.axes.clone(), map.question.scene.stops);
        self.edit(|scene| {
            if scene.stops == Stops::None && axes.iter().any(|axis| axis.field.starts_with("stops.")) {
                scene.stops = stops;
            }
            for (axis, value) in axes.iter().zip(values) {
                let known = FieldPath::new(&axis.field).set(scene, value);
                debug_assert!(known, "an axis of the map belongs to the scene");
            }
        });
    }

    /// Waits until the map that was asked for is whole, at most so long. Whether it is.
    pub fn wait_for_map(&mut self, most: Duration) -> bool {
        wait_while(most, || {
            self.map.take();
            self.map.is_running()
        });
        self.map.map().is_some_and(Map::is_whole)
    }
}
