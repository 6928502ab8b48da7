//! Choice of the sentence about the motion of the open scene.

use crate::app::words::kind::Kind;
use crate::app::words::status::{self, DrivenMotion, Sentence};

use super::Session;

impl Session {
    /// What the status line says.
    pub fn sentence(&self) -> Sentence {
        if let Some(fault) = &self.fault {
            return Sentence::fault(fault);
        }
        let state = self.player.state();
        if self.player.is_held() {
            return status::held(&self.model, &state);
        }
        if let Some(outcome) = self.player.ended() {
            return status::ended(&self.model, outcome);
        }
        if !self.model.is_shaken() {
            return status::unshaken(&self.model, &state);
        }
        match self.sentence_facts() {
            Some(facts) if self.keeps_remedy => Sentence { remedy: String::new(), ..status::driven(&facts) },
            Some(facts) => status::driven(&facts),
            None if self.settled.is_running() => Sentence::waiting(),
            None => stopped(),
        }
    }

    /// The facts for the sentence about a driven motion; `None` until it is known what the motion settles to.
    pub(super) fn sentence_facts(&self) -> Option<DrivenMotion<'_>> {
        let settled = self.settled.current()?;
        Some(DrivenMotion {
            scene: self.scene(),
            model: &self.model,
            summary: settled,
            thresholds: self.thresholds.current(),
            origin: self.settled_from,
            now: self.player.watch().time(),
        })
    }
}

/// The sentence after the user has stopped the computation of what the motion settles to.
fn stopped() -> Sentence {
    let text = "Stopped before it was known what this settles to: a shorter run length is known sooner.";
    Sentence { kind: Kind::Other, text: text.to_owned(), remedy: String::new() }
}
