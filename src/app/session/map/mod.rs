//! Map of the scene: a run from rest for every cell of a grid over two fields, coarse first.
//!
//! It is the sweep of the command line, run in the background and shown while its cells come. The view that
//! shows it asks for it in every frame; a map that no view asks for pauses until a view asks for it again.

pub(super) mod axes;
pub(super) mod cells;

use std::collections::VecDeque;

use crate::app::task::Background;
use crate::scene::{FieldPath, Scene, SweepAxis};
use crate::study::{Cell, RMS_VELOCITY, STANDARD_COLUMNS, SummaryField};

pub use crate::numeric::short;
pub use axes::{ground, label, over, part};
pub use cells::Map;

/// Largest number of scenes that are remembered.
const MAX_SCENES: usize = 400;

/// The question that a map answers: a scene, apart from the fields of the axes, and the axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// The scene, with the first value of each axis.
    pub scene: Scene,
    /// Across and up.
    pub axes: [SweepAxis; 2],
    /// The column for which the runs keep an energy ledger, if they do.
    pub ledger: Option<&'static str>,
}

#[derive(Default)]
pub struct Mapping {
    /// The quantity that the map shows; `None` for the RMS velocity.
    quantity: Option<&'static SummaryField>,
    /// The earlier positions of the scene.
    pub trail: Trail,
    /// The axes that the user has chosen; `None` for the default axes.
    pub(super) chosen: Option<[SweepAxis; 2]>,
    /// The default axes, as they were when the map was first shown: they do not move with the scene.
    pub(super) default_axes: Option<[SweepAxis; 2]>,
    /// The axes of the enlarged parts of the map, each a part of the one before.
    enlarged: Vec<[SweepAxis; 2]>,
    pub(super) map: Option<Map>,
    /// The previous map, shown until the new one has a result everywhere.
    pub(super) previous: Option<Map>,
    /// The cells of the map that have come and are not in it yet.
    pub(super) cells: Background<Question, (u64, Cell)>,
    /// Number of changes of the picture.
    pub(super) version: u64,
    /// A question that waits for a pause in the gesture, and the time in s since which it has not changed.
    pub(super) waiting: Option<(Question, f64)>,
    /// Why there is no map.
    pub(super) problem: Option<String>,
}

impl Mapping {
    /// The map to show, and whether it is that of the present scene.
    pub fn shown(&self) -> Option<(&Map, bool)> {
        let newest = self.map.as_ref().filter(|map| map.is_covered() || self.previous.is_none());
        let current = self.waiting.is_none() && self.problem.is_none();
        newest.map(|map| (map, current)).or_else(|| self.previous.as_ref().map(|map| (map, false)))
    }

    /// Positions of the scene so far on the axes of the map that is shown, the oldest first.
    pub fn trail_places(&mut self) -> Vec<[Option<f64>; 2]> {
        let Some(axes) = self.shown().map(|(map, _)| map.question.axes.clone()) else { return Vec::new() };
        self.trail.places(axes.each_ref().map(|axis| axis.field.as_str())).to_vec()
    }

    /// The map of the present question, as far as it is known.
    pub fn map(&self) -> Option<&Map> {
        self.map.as_ref()
    }

    /// Number of changes of the picture.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Whether cells are being run.
    pub fn is_running(&self) -> bool {
        self.cells.is_running()
    }

    /// Why there is no map.
    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    pub fn stop(&mut self) {
        self.cells.stop();
        self.take();
        self.version += 1;
    }

    /// Continues a stopped map, or begins again if it is complete.
    pub fn go_on(&mut self) {
        self.cells.resume();
        if self.map.as_ref().is_some_and(Map::is_whole) {
            self.cells.clear();
            self.map = None;
        }
    }

    pub fn quantity(&self) -> &'static SummaryField {
        self.quantity.unwrap_or(&RMS_VELOCITY)
    }

    pub fn show(&mut self, quantity: &'static SummaryField) {
        self.quantity = Some(quantity);
    }

    /// The columns of the map's table; `None` if they are the standard ones.
    pub fn columns(&self) -> Option<Vec<&'static str>> {
        let ledger = self.map.as_ref().and_then(|map| map.question.ledger);
        let wanted = ledger.into_iter().chain([self.quantity().name]);
        let mut extra: Vec<&str> = wanted.filter(|name| !STANDARD_COLUMNS.contains(name)).collect();
        extra.dedup();
        (!extra.is_empty()).then(|| STANDARD_COLUMNS.into_iter().chain(extra).collect())
    }

    /// The map as the command line writes it; `None` until all cells are known.
    pub fn csv(&self) -> Option<String> {
        self.map
            .as_ref()
            .filter(|map| map.is_whole())
            .map(|map| map.csv(&self.columns().unwrap_or_else(|| STANDARD_COLUMNS.to_vec())))
    }

    /// Chooses axes; `None` for the default axes.
    pub fn choose(&mut self, axes: Option<[SweepAxis; 2]>) {
        (self.chosen, self.enlarged) = (axes, Vec::new());
    }

    /// Enlarges the part of the map that these axes span.
    pub fn enlarge(&mut self, axes: [SweepAxis; 2]) {
        self.enlarged.push(axes);
    }

    /// Whether a part of the map is enlarged.
    pub fn is_enlarged(&self) -> bool {
        !self.enlarged.is_empty()
    }

    /// Goes back to the axes before the last enlargement.
    pub fn show_larger(&mut self) {
        self.enlarged.pop();
    }

    /// Goes back to the whole map.
    pub fn show_whole(&mut self) {
        self.enlarged.clear();
    }

    /// The axes of the enlarged part, or those that the user has chosen.
    pub(super) fn chosen(&self) -> Option<&[SweepAxis; 2]> {
        self.enlarged.last().or(self.chosen.as_ref())
    }

    /// Receives the cells that have been computed.
    pub fn take(&mut self) {
        let cells = self.cells.take_parts();
        let Some(map) = &mut self.map else { return };
        map.took = self.cells.worked();
        if cells.is_empty() {
            return;
        }
        self.version += u64::from(map.add(cells));
        if map.is_covered() {
            self.previous = None;
        }
    }

    /// Pauses the map if no view has asked for it in this frame; to be called once a frame.
    pub fn end_frame(&mut self) {
        self.cells.end_frame();
    }
}

/// The scenes of the live motion so far, the oldest first.
#[derive(Default)]
pub struct Trail {
    scenes: VecDeque<Scene>,
    /// Their positions on `fields`, the two axes that were last asked for.
    places: Vec<[Option<f64>; 2]>,
    fields: [String; 2],
}

impl Trail {
    pub(super) fn note(&mut self, scene: &Scene) {
        self.scenes.push_back(Scene { title: String::new(), notes: String::new(), ..scene.clone() });
        if self.scenes.len() > MAX_SCENES {
            self.scenes.pop_front();
        }
        self.places.clear();
    }

    /// Forgets all scenes but the present one.
    pub fn clear(&mut self) {
        self.scenes.drain(..self.scenes.len().saturating_sub(1));
        self.places.clear();
    }

    /// Whether there is no scene but the present one.
    pub fn is_clear(&self) -> bool {
        self.scenes.len() < 2
    }

    /// Positions of the scenes on two fields, without repetitions; `None` on a field that a scene lacks.
    fn places(&mut self, fields: [&str; 2]) -> &[[Option<f64>; 2]] {
        if self.places.is_empty() || self.fields != fields {
            let paths = fields.map(FieldPath::new);
            let place = |scene: &Scene| paths.each_ref().map(|path| path.get(scene));
            self.places = self.scenes.iter().map(place).collect();
            self.places.dedup();
            self.fields = fields.map(str::to_owned);
        }
        &self.places
    }
}
