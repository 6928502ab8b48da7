//! Spectrum of the settled motion.

use std::sync::Arc;

use crate::app::session::Session;
use crate::dynamics::Model;
use crate::study::{Signal, Spectrum, SpectrumOptions, Task, followed_until, spectrum};

use super::Explored;

/// A model, and the signal of its motion to analyse.
#[derive(Debug, Clone)]
pub struct SpectrumQuestion {
    model: Arc<Model>,
    signal: Signal,
}

impl PartialEq for SpectrumQuestion {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.model, &other.model) && self.signal == other.signal
    }
}

pub struct Spectra {
    pub signal: Signal,
    /// The spectrum, or why there is none.
    pub found: Explored<SpectrumQuestion, Result<Spectrum, String>>,
}

impl Default for Spectra {
    fn default() -> Self {
        Self { signal: Signal::Displacement, found: Explored::default() }
    }
}

impl Session {
    /// Asks for the spectrum of the present scene; to be called in every frame that shows it.
    pub fn want_spectrum(&mut self) {
        let still = self.stands_still();
        let question =
            SpectrumQuestion { model: Arc::clone(&self.model), signal: self.explore.spectra.signal };
        let wake = Arc::clone(&self.wake);
        self.explore.spectra.found.want(&question, still, &wake, |question, cancel, each| {
            let until_settled = longest_wait(&question.model);
            let options =
                SpectrumOptions { signal: question.signal, taper: None, rate_hz: None, until_settled };
            let found = spectrum(&question.model, &options, &Task { tick: &|| (), cancel });
            each(found.map_err(|error| error.to_string()));
        });
    }
}

/// How long in s to wait for the motion to repeat; `None` if it cannot settle.
pub fn longest_wait(model: &Model) -> Option<f64> {
    model.can_settle().then(|| followed_until(model))
}
