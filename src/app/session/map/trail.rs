//! Trail of the scene: the positions on the axes of a map that it has had.

use std::collections::VecDeque;

use crate::scene::{FieldPath, Scene};

/// Largest number of scenes that are remembered.
const MAX_SCENES: usize = 400;

/// The scenes of the live motion so far, the oldest first.
#[derive(Default)]
pub struct Trail {
    scenes: VecDeque<Scene>,
    /// Their positions on `fields`, the two axes that were last asked for.
    places: Vec<[Option<f64>; 2]>,
    fields: [String; 2],
}

impl Trail {
    pub(in crate::app::session) fn note(&mut self, scene: &Scene) {
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
    pub(super) fn places(&mut self, fields: [&str; 2]) -> &[[Option<f64>; 2]] {
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
