//! Search for the best stops of the open scene: what is asked of it, and the way there.

use std::sync::Arc;
use std::time::Duration;

use crate::app::session::Session;
use crate::app::session::map::ground;
use crate::app::task::wait_while;
use crate::app::words::fields::info;
use crate::dynamics::Model;
use crate::scene::{FieldPath, Stops, SweepAxis};
use crate::study::{DesignRange, INTERVALS};

use super::{Asked, LIMIT};

/// What is made as large as may be: the power into a load where there is one, else the RMS velocity.
fn maximised(model: &Model) -> &'static str {
    if model.has_transducer() { "mean_load_power_w" } else { "rms_velocity_m_per_s" }
}

impl Session {
    /// Searches for the travel limit at which the scene as it stands does best, from rest.
    pub fn find_best_stops(&mut self) {
        if self.best.is_off {
            return;
        }
        self.end_gesture();
        match self.best_asked() {
            Ok(asked) => {
                let (files, wake) = (self.editor.document().files.clone(), Arc::clone(&self.wake));
                self.best.start(asked, files, &wake);
            }
            Err(why) => {
                self.best.close();
                self.best.refusal = Some(why);
            }
        }
    }

    /// What would be asked of the scene as it stands, or why it cannot be.
    fn best_asked(&self) -> Result<Asked, &'static str> {
        if self.fault().is_some() {
            return Err("The best stops are searched for once the scene can be run.");
        }
        if matches!(self.scene().stops, Stops::Uneven { .. }) {
            return Err("The best stops are searched for where both stand equally far out: switch off \
                        “different stops left and right” under Advanced first.");
        }
        let Some(field) = info(LIMIT) else { return Err("") };
        let reach = field.reach(self);
        let axis = SweepAxis { field: LIMIT.to_owned(), step: reach.step, ..SweepAxis::default() };
        let mut scene = ground(self.scene(), self.remembered_stops(), std::slice::from_ref(&axis));
        if !FieldPath::new(LIMIT).set(&mut scene, reach.low) {
            return Err("The stops that would come stand not equally far out.");
        }
        let range = DesignRange::new(LIMIT, (reach.low, reach.high), INTERVALS[0]);
        let duration_s = (!self.model().repeats()).then_some(scene.run.duration_s);
        Ok(Asked { scene, range, column: maximised(self.model()), duration_s })
    }

    /// Takes in what has come; what is about another scene is thrown away. To be called once a frame.
    pub fn follow_best(&mut self) {
        self.best.poll();
        let same = |asked: &Asked| self.best_asked().as_ref() == Ok(asked);
        let is_stale = match &self.best.asked {
            Some(asked) => !same(asked),
            None => self.best.refusal.is_some_and(|why| self.best_asked() != Err(why)),
        };
        if is_stale {
            self.best.close();
        }
    }

    /// Whether the stops stand where they do best.
    pub fn is_at_best_stops(&self) -> bool {
        let limit = self.best.limit_mm();
        limit.is_some() && limit == FieldPath::new(LIMIT).get(self.scene())
    }

    /// Takes the stops to the best place that is known, by one gesture.
    pub fn go_to_best_stops(&mut self) {
        let (Some(limit), Some(asked)) = (self.best.limit_mm(), &self.best.asked) else { return };
        let stops = asked.scene.stops;
        self.edit_once(|scene| {
            if scene.stops == Stops::None {
                scene.stops = stops;
            }
            let known = FieldPath::new(LIMIT).set(scene, limit);
            debug_assert!(known, "the stops of the search have a travel limit");
        });
    }

    /// Waits for the answer, at most so long. Whether it is there.
    pub fn wait_for_best_stops(&mut self, most: Duration) -> bool {
        wait_while(most, || {
            self.best.poll();
            self.best.is_running()
        });
        self.best.answer.is_some()
    }
}
