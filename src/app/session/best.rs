//! Background search for the best stops of the open scene, with a coarse scan first.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::app::task::{Background, Wake, pool};
use crate::app::words::best_stops::{Found, sentence};
use crate::scene::{Files, Scene};
use crate::study::{
    BestDesign, BestQuestion, DesignRange, Environment, NoBest, Optimum, SummaryField, Task, best,
};

/// The field whose best value is searched for.
pub const LIMIT: &str = "stops.travel_limit_mm";

/// A part of the answer of a search.
pub(super) enum Part {
    /// The optimum of the coarse scan.
    Preview(Optimum),
    /// The answer, or why there is none.
    Whole(Result<BestDesign, NoBest>),
}

/// A search: the scene, from rest with its least travel limit, and the range of travel limits.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Search {
    pub scene: Scene,
    pub range: DesignRange,
    pub column: &'static str,
    /// Length of a run in s under a drive that does not repeat.
    pub duration_s: Option<f64>,
}

/// The search for the best stops, and its result. Both are dropped when the scene changes.
#[derive(Default)]
pub struct BestStops {
    pub(super) search: Background<Search, Part>,
    /// Number of runs that the search has made.
    runs: Arc<AtomicU64>,
    /// Why there can be no search.
    pub(super) refusal: Option<&'static str>,
    /// Whether the search is not offered, as its result may be the answer of a lesson.
    pub is_off: bool,
}

impl BestStops {
    /// Whether there is anything to say.
    pub fn is_shown(&self) -> bool {
        self.search.question().is_some() || self.refusal.is_some()
    }

    /// Whether the search is running.
    pub fn is_running(&self) -> bool {
        self.search.is_running()
    }

    /// Ends the search and forgets its result.
    pub fn close(&mut self) {
        *self = Self { is_off: self.is_off, ..Self::default() };
    }

    /// The best travel limit in mm so far, at first that of the coarse scan; `None` if no limit stands out.
    pub fn limit_mm(&self) -> Option<f64> {
        match self.search.answer()? {
            Part::Whole(Ok(design)) => (!design.flat).then(|| design.optimum.at[0]),
            Part::Whole(Err(_)) => None,
            Part::Preview(best) => (best.value != 0.0).then(|| best.at[0]),
        }
    }

    /// What is known so far, in one or two sentences.
    pub fn words(&self) -> String {
        if let Some(why) = self.refusal {
            return why.to_owned();
        }
        let Some(search) = self.search.question() else { return String::new() };
        let runs = self.runs.load(Ordering::Relaxed);
        let found = match self.search.answer() {
            Some(Part::Whole(answer)) => Found::Whole(answer),
            _ if !self.is_running() => Found::Nothing,
            Some(Part::Preview(optimum)) => Found::Searching(runs, Some(optimum)),
            None => Found::Searching(runs, None),
        };
        sentence(&found, search.column, &search.range, search.duration_s)
    }

    pub(super) fn start(&mut self, search: Search, files: Files, wake: &Wake) {
        let runs = Arc::clone(&self.runs);
        self.search.ask(search, wake, move |Search { scene, range, column, .. }, cancel, each| {
            let environment = Environment { name: String::new(), weight: 1.0, scene: scene.clone(), files };
            let question = BestQuestion {
                over: vec![range.clone()],
                maximise: SummaryField::find(column)?,
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
            match best(&question, &pool()?, &task, &mut |optimum| each(Part::Preview(optimum.clone()))) {
                Err(NoBest::Cancelled) => None,
                found => Some(Part::Whole(found)),
            }
        });
    }
}
