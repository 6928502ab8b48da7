//! The session's search for the best stops, and the move of the stops to them.

use std::sync::Arc;
use std::time::Duration;

use crate::app::session::Session;
use crate::app::session::map::ground;
use crate::app::task::wait_while;
use crate::app::words::fields::info;
use crate::dynamics::Model;
use crate::scene::{FieldPath, Stops, SweepAxis};
use crate::study::{DesignRange, INTERVALS};

use super::{LIMIT, Search};

/// The column to maximise: the mean power into the load if there is a transducer, else the RMS velocity.
fn maximised_column(model: &Model) -> &'static str {
    if model.has_transducer() { "mean_load_power_w" } else { "rms_velocity_m_per_s" }
}

impl Session {
    /// Searches for the best travel limit of the present scene, started from rest.
    pub fn find_best_stops(&mut self) {
        if self.best.is_off {
            return;
        }
        self.end_gesture();
        match self.best_search() {
            Ok(search) => {
                let (files, wake) = (self.editor.document().files.clone(), Arc::clone(&self.wake));
                self.best.start(search, files, &wake);
            }
            Err(why) => {
                self.best.close();
                self.best.refusal = Some(why);
            }
        }
    }

    /// The search for the present scene, or why there can be none.
    fn best_search(&self) -> Result<Search, &'static str> {
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
            return Err("The stops that would come do not stand equally far out.");
        }
        let range = DesignRange::new(LIMIT, (reach.low, reach.high), INTERVALS[0]);
        let duration_s = (!self.model().repeats()).then_some(scene.run.duration_s);
        Ok(Search { scene, range, column: maximised_column(self.model()), duration_s })
    }

    /// Receives results, and drops them once the scene has changed; to be called once a frame.
    pub fn follow_best(&mut self) {
        self.best.poll();
        let same = |search: &Search| self.best_search().as_ref() == Ok(search);
        let is_stale = match &self.best.search {
            Some(search) => !same(search),
            None => self.best.refusal.is_some_and(|why| self.best_search() != Err(why)),
        };
        if is_stale {
            self.best.close();
        }
    }

    /// Whether the stops stand at the best travel limit known.
    pub fn is_at_best_stops(&self) -> bool {
        let limit = self.best.limit_mm();
        limit.is_some() && limit == FieldPath::new(LIMIT).get(self.scene())
    }

    /// Moves the stops to the best travel limit known, as one gesture.
    pub fn go_to_best_stops(&mut self) {
        let (Some(limit), Some(search)) = (self.best.limit_mm(), &self.best.search) else { return };
        let stops = search.scene.stops;
        self.edit_once(|scene| {
            if scene.stops == Stops::None {
                scene.stops = stops;
            }
            let is_set = FieldPath::new(LIMIT).set(scene, limit);
            debug_assert!(is_set, "the stops of the search have a travel limit");
        });
    }

    /// Waits at most `timeout` for the answer. Returns whether it has come.
    pub fn wait_for_best_stops(&mut self, timeout: Duration) -> bool {
        wait_while(timeout, || {
            self.best.poll();
            self.best.is_running()
        });
        self.best.answer.is_some()
    }
}
