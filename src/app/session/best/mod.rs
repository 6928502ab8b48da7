//! Search for the best stops of the open scene, on a thread of its own, coarse first.

mod of_session;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::app::task::{Job, Wake, pool};
use crate::app::words::best_stops::{Found, sentence};
use crate::scene::{Files, Scene};
use crate::study::{
    BestDesign, BestQuestion, DesignRange, Environment, NoBest, Optimum, SummaryField, Task, best,
};

/// The field that is searched over.
pub const LIMIT: &str = "stops.travel_limit_mm";

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
    /// Length of a run in s under a drive that does not repeat.
    duration_s: Option<f64>,
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
        let found = match (&self.answer, &self.preview) {
            (Some(answer), _) => Found::Whole(answer),
            (None, preview) if self.job.is_some() => {
                Found::Searching(self.runs.load(Ordering::Relaxed), preview.as_ref())
            }
            (None, _) => Found::Nothing,
        };
        sentence(&found, asked.column, &asked.range, asked.duration_s)
    }

    pub(super) fn poll(&mut self) {
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
                until_settled: None,
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
