//! Studies of the open scene for the views that show them: asked for frame by frame, begun when no hand
//! changes the scene, stopped when no view looks.

mod basins;
mod explored;
mod spectra;
mod walks;

pub use basins::{BasinsFound, BasinsQuestion, Level, STARTS};
pub use explored::Explored;
pub use spectra::{Spectra, longest_wait};
pub use walks::{WalkQuantity, WalkQuestion, Walks};

/// What the views of the layout Explore ask.
#[derive(Default)]
pub struct Explore {
    /// The scene walked up and down over a field.
    pub walks: Walks,
    /// Where the motion goes from every start.
    pub basins: BasinsFound,
    /// The spectrum of the settled motion.
    pub spectra: Spectra,
}

impl Explore {
    pub(super) fn poll(&mut self) {
        self.walks.found.poll();
        self.basins.poll();
        self.spectra.found.poll();
    }

    /// To be called once a frame: what no view has asked for stops.
    pub fn end_frame(&mut self) {
        self.walks.found.end_frame();
        self.basins.end_frame();
        self.spectra.found.end_frame();
    }
}
