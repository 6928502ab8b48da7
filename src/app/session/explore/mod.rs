//! Studies of the open scene for the views of the layout Explore. A view asks for its study in every frame;
//! the study begins once nobody is changing the scene, and stops when no view asks for it.

mod basins;
mod spectra;
mod walks;

pub use basins::{BasinsFound, BasinsQuestion, Level, STARTS};
pub use spectra::{Spectra, longest_wait};
pub use walks::{WalkQuantity, WalkQuestion, Walks};

/// The studies that the views of the layout Explore ask for.
#[derive(Default)]
pub struct Explore {
    /// Walks up and down over a field.
    pub walks: Walks,
    /// Basins of attraction.
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

    /// Stops the studies that no view has asked for in this frame; to be called once a frame.
    pub fn end_frame(&mut self) {
        self.walks.found.end_frame();
        self.basins.end_frame();
        self.spectra.found.end_frame();
    }
}
