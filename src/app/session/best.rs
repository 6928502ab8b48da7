//! Search for the best stops of the open scene, coarse first.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use crate::app::task::{Background, pool};
use crate::app::words::best_stops::{Found, sentence};
use crate::app::words::fields::info;
use crate::dynamics::Model;
use crate::scene::{FieldPath, Scene, Stops, SweepAxis};
use crate::study::{
    BestDesign, BestQuestion, DesignRange, Environment, INTERVALS, NoBest, Optimum, SummaryField, Task, best,
};

use super::Session;
use super::map::ground;

/// The field that is searched over.
pub const LIMIT: &str = "stops.travel_limit_mm";

/// What a search has found.
enum Part {
    /// The best place of the coarse scan.
    Preview(Optimum),
    /// The answer, or why there is none.
    Whole(Result<BestDesign, NoBest>),
}

/// The scene from rest with its least travel limit, the range, and the column that is made large.
#[derive(Debug, Clone, PartialEq)]
struct BestStopsQuestion {
    scene: Scene,
    range: DesignRange,
    column: &'static str,
}

/// The search for the best stops, and what it found.
#[derive(Default)]
pub struct BestStops {
    /// The search, or why nothing is searched for.
    search: Background<Result<BestStopsQuestion, &'static str>, Part>,
    /// Count of the runs that the search has made.
    runs: Arc<AtomicU64>,
    /// It is not offered: it may be the answer of a lesson.
    pub is_off: bool,
}

impl BestStops {
    /// Whether there is anything to say.
    pub fn is_shown(&self) -> bool {
        self.search.question().is_some()
    }

    pub fn is_running(&self) -> bool {
        self.search.is_running()
    }

    /// Ends the search, and forgets what it found.
    pub fn close(&mut self) {
        self.search.clear();
    }

    /// The best travel limit in mm, of the coarse scan while the search runs; none where all places are
    /// equally good.
    pub fn limit_mm(&self) -> Option<f64> {
        match self.search.answer()? {
            Part::Whole(Ok(design)) => (!design.flat).then(|| design.optimum.at[0]),
            Part::Whole(Err(_)) => None,
            Part::Preview(optimum) => (optimum.value != 0.0).then(|| optimum.at[0]),
        }
    }

    /// What is known so far, in a sentence or two.
    pub fn words(&self) -> String {
        let question = match self.search.question() {
            None => return String::new(),
            Some(Err(why)) => return (*why).to_owned(),
            Some(Ok(question)) => question,
        };
        let runs = self.runs.load(Ordering::Relaxed);
        let found = match self.search.answer() {
            Some(Part::Whole(answer)) => Found::Whole(answer),
            _ if !self.is_running() => Found::Nothing,
            Some(Part::Preview(optimum)) => Found::Searching(runs, Some(optimum)),
            None => Found::Searching(runs, None),
        };
        sentence(&found, question.column, &question.range, question.scene.run.duration_s)
    }
}

/// The column that is made as large as possible: the power into a load where there is one, else the RMS
/// velocity.
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
        self.best.close();
        let question = self.best_question();
        let Ok(BestStopsQuestion { scene, range, column }) = question.clone() else {
            return self.best.search.set(question, Vec::new());
        };
        let (files, runs) = (self.editor.document().files.clone(), Arc::new(AtomicU64::new(0)));
        self.best.runs = Arc::clone(&runs);
        self.best.search.ask(question, &self.wake, move |_, cancel, each| {
            let environment = Environment { name: String::new(), weight: 1.0, scene, files };
            let question = BestQuestion {
                over: vec![range],
                maximise: SummaryField::find(column)?,
                subject_to: Vec::new(),
                environments: vec![environment],
                vary: Vec::new(),
                seed: 1,
            };
            let tick = || {
                runs.fetch_add(1, Ordering::Relaxed);
            };
            let task = Task { tick: &tick, cancel };
            let mut preview = |optimum: &Optimum| each(Part::Preview(optimum.clone()));
            match best(&question, &pool()?, &task, &mut preview) {
                Err(NoBest::Cancelled) => None,
                found => Some(Part::Whole(found)),
            }
        });
    }

    /// What the search would be asked about the scene as it stands, or why nothing can be searched for.
    fn best_question(&self) -> Result<BestStopsQuestion, &'static str> {
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
        let range = DesignRange {
            field: LIMIT.to_owned(),
            low: reach.low,
            high: reach.high,
            intervals: INTERVALS[0],
        };
        Ok(BestStopsQuestion { scene, range, column: maximised(self.model()) })
    }

    /// Takes in what has come; an answer about another scene is thrown away. To be called once a frame.
    pub fn follow_best(&mut self) {
        self.best.search.poll();
        if self.best.search.question().is_some_and(|question| *question != self.best_question()) {
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
        let (Some(limit), Some(Ok(question))) = (self.best.limit_mm(), self.best.search.question()) else {
            return;
        };
        let stops = question.scene.stops;
        self.edit_once(|scene| {
            if scene.stops == Stops::None {
                scene.stops = stops;
            }
            let known = FieldPath::new(LIMIT).set(scene, limit);
            debug_assert!(known, "the stops of the search have a travel limit");
        });
    }

    /// Waits for the answer, for `limit` at the longest. Whether it is there.
    pub fn wait_for_best_stops(&mut self, limit: Duration) -> bool {
        self.best.search.wait(limit)
    }
}
