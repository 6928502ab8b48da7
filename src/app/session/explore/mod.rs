//! Studies of the open scene for the views that show them: asked for frame by frame, begun when no hand
//! changes the scene, stopped when no view looks.

mod explored;
mod walks;

pub use explored::Explored;
pub use walks::{WalkQuantity, WalkQuestion, Walks};

/// What the views of the layout Explore ask.
#[derive(Default)]
pub struct Explore {
    /// The scene walked up and down over a field.
    pub walks: Walks,
}

impl Explore {
    /// Takes in what has come.
    pub(super) fn poll(&mut self) {
        self.walks.found.poll();
    }

    /// To be called once a frame: what no view has asked for stops.
    pub fn end_frame(&mut self) {
        self.walks.found.end_frame();
    }
}
