//! Studies of the open scene for the views of the layout Explore: wanted frame by frame, begun when no hand
//! changes the scene, paused when no view shows them.

mod basins;
mod walks;

use std::sync::Arc;

use crate::app::task::{Background, Identity};
use crate::dynamics::Model;
use crate::study::{Signal, Spectrum, SpectrumOptions, Task, spectrum};

use super::Session;

pub use basins::{BasinsFound, BasinsQuestion, Level, STARTS};
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

    pub(super) fn end_frame(&mut self) {
        self.walks.found.end_frame();
        self.basins.end_frame();
        self.spectra.found.end_frame();
    }
}

pub struct Spectra {
    pub signal: Signal,
    /// The spectrum of a signal of a model, or why there is none.
    pub found: Background<(Identity<Model>, Signal), Result<Spectrum, String>>,
}

impl Default for Spectra {
    fn default() -> Self {
        Self { signal: Signal::Displacement, found: Background::default() }
    }
}

impl Session {
    /// Asks for the spectrum of the scene as it stands, in a frame that shows it.
    pub fn want_spectrum(&mut self) {
        let still = self.stands_still();
        let question = (Identity(Arc::clone(&self.model)), self.explore.spectra.signal);
        self.explore.spectra.found.want(
            question,
            still,
            &self.wake,
            |(Identity(model), signal), cancel, _| {
                let (signal, until_settled) = (*signal, longest_wait(model));
                let options = SpectrumOptions { signal, taper: None, rate_hz: None, until_settled };
                let found = spectrum(model, &options, &Task { tick: &|| (), cancel });
                Some(found.map_err(|error| error.to_string()))
            },
        );
    }
}

/// For how long in s the motion is waited for to repeat, where it may.
pub fn longest_wait(model: &Model) -> Option<f64> {
    model.forcing_period().filter(|_| model.can_settle()).map(|period| model.duration() + 200.0 * period)
}
