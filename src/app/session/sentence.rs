//! Choice of the sentence about the open scene.

use crate::app::words::kind::Kind;
use crate::app::words::status::{self, Sentence, Told};

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
        match self.facts() {
            Some(facts) if self.keeps_remedy => Sentence { remedy: String::new(), ..status::driven(&facts) },
            Some(facts) => status::driven(&facts),
            None if self.settled.is_running() => Sentence::waiting(),
            None => stopped(),
        }
    }

    /// What the sentence about a driven motion is made from, once it is known.
    pub(super) fn facts(&self) -> Option<Told<'_>> {
        let settled = self.settled.answer()?;
        Some(Told {
            scene: self.scene(),
            model: &self.model,
            summary: settled,
            thresholds: self.thresholds.answer(),
            origin: self.settled.question()?.from,
            now: self.player.watch().time(),
        })
    }
}

/// While it is not known what the motion settles to, because a person has stopped that.
fn stopped() -> Sentence {
    let text = "Stopped before it was known what this settles to: a shorter run length is known sooner.";
    Sentence { kind: Kind::Other, text: text.to_owned(), remedy: String::new() }
}
