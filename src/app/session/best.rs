//! Background search for the best stops of the open scene, with a coarse scan first.

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::app::task::{Background, Each, Question, progress, told};
use crate::app::words::Guide;
use crate::app::words::best_stops::{answer_guide, looking};
use crate::app::words::fields::info;
use crate::questions::{Best, BestDesign, Error, Optimum};
use crate::scene::{FieldPath, Stops, SweepAxis};
use interwell_studies::study::{RMS_VELOCITY, SummaryField};

use super::Session;
use super::map::{LOAD_POWER, ground};
use super::prepared::SceneWithFiles;
use super::sliders::reach;

pub const LIMIT: &str = "stops.travel_limit_mm";

#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Part {
    /// So many runs have been made.
    Runs(u64),
    /// The optimum of the coarse scan.
    Preview(Optimum),
    /// The answer, or why there is none.
    Whole(Result<Box<BestDesign>, String>),
}

/// A search: the scene, from rest with its least travel limit, and the range of travel limits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Search {
    scene: SceneWithFiles,
    /// The field with its range, as a question takes it.
    pub over: String,
    /// Ends of the range in mm.
    pub range: (f64, f64),
    maximise: &'static SummaryField,
    /// Length of a run in s under a drive that does not repeat.
    duration_s: Option<f64>,
}

impl Question for Search {
    const NAME: &'static str = "best stops";
    type Part = Part;

    fn answer(&self, cancel: &AtomicBool, each: Each<Part>) -> Option<Part> {
        told(self.found(cancel, each).map(Box::new)).map(Part::Whole)
    }
}

impl Search {
    fn found(&self, cancel: &AtomicBool, each: Each<Part>) -> Result<BestDesign, Error> {
        let (over, maximise) = (vec![self.over.clone()], self.maximise.name.to_owned());
        let question = Best { over, maximise, ..Best::default() };
        let (document, runs) = (self.scene.document(), |done, _| each(Part::Runs(done)));
        let progress = progress(cancel).reporting_to(&runs);
        let preview = &mut |optimum: &Optimum, _| each(Part::Preview(optimum.clone()));
        Ok(question.search(question.question(&document)?, &document, &progress, preview)?.design)
    }
}

/// The search for the best stops, and its result. Both are dropped when the scene changes.
#[derive(Default)]
pub struct BestStops {
    pub(super) search: Background<Search, Part>,
    /// Why there can be no search.
    refusal: Option<&'static str>,
}

impl BestStops {
    pub fn is_shown(&self) -> bool {
        self.search.question().is_some() || self.refusal.is_some()
    }

    pub fn is_running(&self) -> bool {
        self.search.is_running()
    }

    /// Ends the search and forgets its result.
    pub fn close(&mut self) {
        *self = Self::default();
    }

    /// Number of runs that the search has made, and the newest of its other parts.
    fn known(&self) -> (u64, Option<&Part>) {
        let (parts, is_current) = self.search.parts();
        let parts = if is_current { parts } else { &[] };
        let runs = |part: &Part| if let Part::Runs(runs) = part { Some(*runs) } else { None };
        (parts.iter().filter_map(runs).max().unwrap_or(0), parts.iter().rfind(|part| runs(part).is_none()))
    }

    /// The best travel limit in mm so far, at first that of the coarse scan; `None` if no limit stands out.
    pub fn limit_mm(&self) -> Option<f64> {
        match self.known().1? {
            Part::Whole(Ok(design)) => (!design.flat).then(|| design.optimum.at[0]),
            Part::Whole(Err(_)) | Part::Runs(_) => None,
            Part::Preview(best) => (best.value != 0.0).then(|| best.at[0]),
        }
    }

    /// What is known so far.
    pub fn guide(&self) -> Guide {
        if let Some(why) = self.refusal {
            return Guide::new("", why);
        }
        let Some(search) = self.search.question() else { return Guide::default() };
        let (column, (runs, newest)) = (search.maximise.name, self.known());
        match newest {
            Some(Part::Whole(answer)) => answer_guide(answer, column, search.range, search.duration_s),
            _ if !self.is_running() => {
                Guide::new("", "The search for the best stops ended without an answer.")
            }
            Some(Part::Preview(best)) => Guide::new("", looking(runs, Some(best), column)),
            None | Some(Part::Runs(_)) => Guide::new("", looking(runs, None, column)),
        }
    }
}

impl Session {
    /// Searches for the best travel limit of the present scene, started from rest.
    pub fn find_best_stops(&mut self) {
        if self.is_lesson {
            return;
        }
        self.end_gesture();
        self.best.close();
        match self.best_search() {
            Ok(search) => self.best.search.ask(search, &self.wake),
            Err(why) => self.best.refusal = Some(why),
        }
    }

    fn best_search(&self) -> Result<Search, &'static str> {
        if self.fault().is_some() {
            return Err("The best stops are searched for once the scene can be run.");
        }
        if matches!(self.scene().stops, Stops::Uneven { .. }) {
            return Err("The best stops are searched for where both stand equally far out: under More, \
                        Advanced, switch off “different stops left and right”.");
        }
        let reach = reach(info(LIMIT).ok_or("")?, self);
        let axis = SweepAxis { field: LIMIT.to_owned(), ..SweepAxis::default() };
        let mut scene = ground(self.scene(), self.remembered_stops, std::slice::from_ref(&axis));
        if !FieldPath::new(LIMIT).set(&mut scene, reach.low) {
            return Err("The stops that would be switched on do not stand equally far out.");
        }
        let duration_s = (!self.model().repeats()).then_some(scene.run.duration_s);
        let power = SummaryField::find(LOAD_POWER).filter(|_| self.model().has_transducer());
        let maximise = power.unwrap_or(&RMS_VELOCITY);
        let (scene, range) = (self.with_files(scene), (reach.low, reach.high));
        let over = format!("{LIMIT}={}:{}", range.0, range.1);
        Ok(Search { scene, over, range, maximise, duration_s })
    }

    /// Receives results, and drops them once the scene has changed; to be called once a frame.
    pub fn follow_best(&mut self) {
        self.best.search.poll();
        let is_stale = match self.best.search.question() {
            Some(search) => self.best_search().as_ref() != Ok(search),
            None => self.best.refusal.is_some_and(|why| self.best_search() != Err(why)),
        };
        if is_stale {
            self.best.close();
        }
    }

    pub fn is_at_best_stops(&self) -> bool {
        let limit = self.best.limit_mm();
        limit.is_some() && limit == FieldPath::new(LIMIT).get(self.scene())
    }

    /// Moves the stops to the best travel limit known, as one gesture.
    pub fn go_to_best_stops(&mut self) {
        let (Some(limit), Some(search)) = (self.best.limit_mm(), self.best.search.question()) else {
            return;
        };
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
        self.best.search.wait(timeout);
        matches!(self.best.search.answer(), Some(Part::Whole(_)))
    }
}
