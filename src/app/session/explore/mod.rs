//! Studies of the open scene for the views of the layout Explore. A view asks for its study in every frame;
//! the study begins once nobody is changing the scene, and stops when no view asks for it.

mod basins;
mod walks;

use std::sync::Arc;

use crate::app::session::Session;
use crate::app::task::{Background, Identity};
use crate::dynamics::Model;
use crate::study::{Signal, Spectrum, SpectrumOptions, Task, followed_until, spectrum};

pub use basins::{BasinsFound, BasinsQuestion, Level, STARTS};
pub use walks::{WalkQuantity, WalkQuestion, Walks};

/// The studies that the views of the layout Explore ask for.
#[derive(Default)]
pub struct Explore {
    pub walks: Walks,
    pub basins: BasinsFound,
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

/// A model, and the signal of its motion to analyse.
#[derive(Debug, Clone, PartialEq)]
pub struct SpectrumQuestion {
    model: Identity<Model>,
    signal: Signal,
}

pub struct Spectra {
    pub signal: Signal,
    /// The spectrum, or why there is none.
    pub found: Background<SpectrumQuestion, Result<Spectrum, String>>,
}

impl Default for Spectra {
    fn default() -> Self {
        Self { signal: Signal::Displacement, found: Background::default() }
    }
}

impl Session {
    /// Asks for the spectrum of the present scene; to be called in every frame that shows it.
    pub fn want_spectrum(&mut self) {
        let (model, signal) = (Identity(Arc::clone(&self.model)), self.explore.spectra.signal);
        let (question, still) = (SpectrumQuestion { model, signal }, self.stands_still());
        self.explore.spectra.found.want(question, still, &self.wake, |question, cancel, _| {
            let until_settled = longest_wait(&question.model);
            let options =
                SpectrumOptions { signal: question.signal, taper: None, rate_hz: None, until_settled };
            let found = spectrum(&question.model, &options, &Task { tick: &|| (), cancel });
            Some(found.map_err(|error| error.to_string()))
        });
    }
}

/// How long in s to wait for the motion to repeat; `None` if it cannot settle.
pub fn longest_wait(model: &Model) -> Option<f64> {
    model.can_settle().then(|| followed_until(model))
}
