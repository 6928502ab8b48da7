//! Trail of the scene: where on the axes of a map its live motion has been.

use std::collections::VecDeque;

use crate::scene::{FieldPath, Scene};

/// The number of scenes that are remembered.
const LENGTH: usize = 400;

/// The scenes that the live motion has had, the oldest first.
#[derive(Default)]
pub struct Trail {
    scenes: VecDeque<Scene>,
    /// Where they stand on `fields`, the two of the map that was drawn last.
    places: Vec<[Option<f64>; 2]>,
    fields: [String; 2],
}

impl Trail {
    pub(in crate::app::session) fn note(&mut self, scene: &Scene) {
        self.scenes.push_back(Scene { title: String::new(), notes: String::new(), ..scene.clone() });
        if self.scenes.len() > LENGTH {
            self.scenes.pop_front();
        }
        self.places.clear();
    }

    /// Forgets all but where the scene is now.
    pub fn clear(&mut self) {
        self.scenes.drain(..self.scenes.len().saturating_sub(1));
        self.places.clear();
    }

    /// Whether the scene has been nowhere but where it is now.
    pub fn is_clear(&self) -> bool {
        self.scenes.len() < 2
    }

    /// Where they stand on these two fields, each place once in a row; none on a field that a scene lacks.
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
