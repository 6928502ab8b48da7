//! Background search for the best stops of the open scene, with a coarse scan first.

mod of_session;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::app::task::{Job, Wake, pool};
use crate::app::words::best_stops::{Found, sentence};
use crate::scene::{Files, Scene};
use crate::study::{
    BestDesign, BestQuestion, DesignRange, Environment, NoBest, Optimum, SummaryField, Task, best,
};

/// The field whose best value is searched for.
pub const LIMIT: &str = "stops.travel_limit_mm";

/// A part of the answer of a search.
enum Part {
    /// The optimum of the coarse scan.
    Preview(Optimum),
    /// The answer, or why there is none.
    Whole(Result<BestDesign, NoBest>),
}

/// A search: the scene, from rest with its least travel limit, and the range of travel limits.
#[derive(Debug, Clone, PartialEq)]
struct Search {
    scene: Scene,
    range: DesignRange,
    column: &'static str,
    /// Length of a run in s under a drive that does not repeat.
    duration_s: Option<f64>,
}

/// The search for the best stops, and its result. Both are dropped when the scene changes.
#[derive(Default)]
pub struct BestStops {
    search: Option<Search>,
    job: Option<Job<Part>>,
    runs: Arc<AtomicU64>,
    preview: Option<Optimum>,
    answer: Option<Result<BestDesign, NoBest>>,
    /// Why there can be no search.
    refusal: Option<&'static str>,
    /// Whether the search is not offered, as its result may be the answer of a lesson.
    pub is_off: bool,
}

impl BestStops {
    /// Whether there is anything to say.
    pub fn is_shown(&self) -> bool {
        self.search.is_some() || self.refusal.is_some()
    }

    /// Whether the search is running.
    pub fn is_running(&self) -> bool {
        self.job.is_some()
    }

    /// Ends the search and forgets its result.
    pub fn close(&mut self) {
        *self = Self { is_off: self.is_off, ..Self::default() };
    }

    /// The best travel limit in mm so far, at first that of the coarse scan; `None` if no limit stands out.
    pub fn limit_mm(&self) -> Option<f64> {
        match &self.answer {
            Some(Ok(design)) => (!design.flat).then(|| design.optimum.at[0]),
            Some(Err(_)) => None,
            None => self.preview.as_ref().filter(|best| best.value != 0.0).map(|best| best.at[0]),
        }
    }

    /// What is known so far, in one or two sentences.
    pub fn words(&self) -> String {
        if let Some(why) = self.refusal {
            return why.to_owned();
        }
        let Some(search) = &self.search else { return String::new() };
        let found = match (&self.answer, &self.preview) {
            (Some(answer), _) => Found::Whole(answer),
            (None, preview) if self.job.is_some() => {
                Found::Searching(self.runs.load(Ordering::Relaxed), preview.as_ref())
            }
            (None, _) => Found::Nothing,
        };
        sentence(&found, search.column, &search.range, search.duration_s)
    }

    pub(super) fn poll(&mut self) {
        let Some(job) = &self.job else { return };
        let (mut preview, mut answer) = (None, None);
        let more = job.take(|part| match part {
            Part::Preview(optimum) => preview = Some(optimum),
            Part::Whole(result) => answer = Some(result),
        });
        self.preview = preview.or(self.preview.take());
        self.answer = answer.or(self.answer.take());
        if !more {
            self.job = None;
        }
    }

    fn start(&mut self, search: Search, files: Files, wake: &Wake) {
        self.close();
        let (runs, Search { scene, range, column, .. }) = (Arc::clone(&self.runs), search.clone());
        self.job = Job::start(wake, move |cancel, each| {
            let Some(maximise) = SummaryField::find(column) else { return };
            let Some(pool) = pool() else { return };
            let environment = Environment { name: String::new(), weight: 1.0, scene, files };
            let question = BestQuestion {
                over: vec![range],
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
            let found = best(&question, &pool, &task, &mut |optimum| each(Part::Preview(optimum.clone())));
            if !matches!(found, Err(NoBest::Cancelled)) {
                each(Part::Whole(found));
            }
        });
        self.search = Some(search);
    }
}
