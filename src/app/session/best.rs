//! Search for the best stops of the open scene, on a thread of its own, coarse first.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use crate::app::task::{Job, Wake, pool, wait_while};
use crate::app::words::best_stops::{Found, sentence};
use crate::app::words::fields::info;
use crate::dynamics::Model;
use crate::scene::{FieldPath, Files, Scene, Stops, SweepAxis};
use crate::study::{
    BestDesign, BestQuestion, DesignRange, Environment, INTERVALS, NoBest, Optimum, SummaryField, Task, best,
};

use super::Session;
use super::map::ground;

/// The field that is searched over.
pub const LIMIT: &str = "stops.travel_limit_mm";

/// What is made as large as may be: the power into a load where there is one, else the RMS velocity.
fn maximised(model: &Model) -> &'static str {
    if model.has_transducer() { "mean_load_power_w" } else { "rms_velocity_m_per_s" }
}

/// What has come of a search.
enum Part {
    /// The best place of the coarse scan.
    Preview(Optimum),
    /// The answer, or why there is none.
    Whole(Result<BestDesign, NoBest>),
}

/// What is asked: the scene from rest with its least travel limit, and the range.
#[derive(Debug, Clone, PartialEq)]
struct Asked {
    scene: Scene,
    range: DesignRange,
    column: &'static str,
}

/// The search for the best stops, and what it found. An answer to another scene is thrown away.
#[derive(Default)]
pub struct BestStops {
    asked: Option<Asked>,
    job: Option<Job<Part>>,
    runs: Arc<AtomicU64>,
    preview: Option<Optimum>,
    answer: Option<Result<BestDesign, NoBest>>,
    /// Why nothing is searched for.
    refusal: Option<&'static str>,
    /// It is not offered: it may be the answer of a lesson.
    pub is_off: bool,
}

impl BestStops {
    /// Whether there is anything to say.
    pub fn is_shown(&self) -> bool {
        self.asked.is_some() || self.refusal.is_some()
    }

    /// Whether it is being searched.
    pub fn is_running(&self) -> bool {
        self.job.is_some()
    }

    /// Ends the search, and forgets what it found.
    pub fn close(&mut self) {
        *self = Self { is_off: self.is_off, ..Self::default() };
    }

    /// The best travel limit in mm, be it of the coarse scan; none where no place is better than another.
    pub fn limit_mm(&self) -> Option<f64> {
        match &self.answer {
            Some(Ok(design)) => (!design.flat).then(|| design.optimum.at[0]),
            Some(Err(_)) => None,
            None => self.preview.as_ref().filter(|own| own.value != 0.0).map(|own| own.at[0]),
        }
    }

    /// What is known so far, in a sentence or two.
    pub fn words(&self) -> String {
        if let Some(why) = self.refusal {
            return why.to_owned();
        }
        let Some(asked) = &self.asked else { return String::new() };
        let run = asked.scene.run;
        let found = match (&self.answer, &self.preview) {
            (Some(answer), _) => Found::Whole(answer),
            (None, preview) if self.job.is_some() => {
                Found::Searching(self.runs.load(Ordering::Relaxed), preview.as_ref())
            }
            (None, _) => Found::Nothing,
        };
        sentence(&found, asked.column, &asked.range, run.duration_s)
    }

    fn poll(&mut self) {
        let Some(job) = &self.job else { return };
        let (mut preview, mut answer) = (None, None);
        let more = job.take(|part| match part {
            Part::Preview(own) => preview = Some(own),
            Part::Whole(own) => answer = Some(own),
        });
        self.preview = preview.or(self.preview.take());
        self.answer = answer.or(self.answer.take());
        if !more {
            self.job = None;
        }
    }

    fn start(&mut self, asked: Asked, files: Files, wake: &Wake) {
        self.close();
        let (runs, question) = (Arc::clone(&self.runs), asked.clone());
        self.job = Job::start(wake, move |cancel, each| {
            let Some(maximise) = SummaryField::find(question.column) else { return };
            let Some(pool) = pool() else { return };
            let environment = Environment { name: String::new(), weight: 1.0, scene: question.scene, files };
            let question = BestQuestion {
                over: vec![question.range],
                maximise,
                subject_to: Vec::new(),
                environments: vec![environment],
                vary: Vec::new(),
                seed: 1,
            };
            let tick = || {
                runs.fetch_add(1, Ordering::Relaxed);
            };
            let task = Task { tick: &tick, cancel };
            let found = best(&question, &pool, &task, &mut |own| each(Part::Preview(own.clone())));
            if !matches!(found, Err(NoBest::Cancelled)) {
                each(Part::Whole(found));
            }
        });
        self.asked = Some(asked);
    }
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
        let range = DesignRange {
            field: LIMIT.to_owned(),
            low: reach.low,
            high: reach.high,
            intervals: INTERVALS[0],
        };
        Ok(Asked { scene, range, column: maximised(self.model()) })
    }

    /// Takes in what has come; what is about another scene is thrown away.
    pub(super) fn follow_best(&mut self) {
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
