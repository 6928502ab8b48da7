//! Runs of designs in their environments, several at a time.

use std::sync::{Arc, Mutex, PoisonError};

use super::seeds::{Sample, Seeds};
use super::{BestQuestion, DesignRange, NoBest, Optimum, Tried};
use crate::dynamics::{Model, Outcome, Request, Run, Summary};
use crate::mechanics::{BuildError, Mechanism};
use crate::scene::{Fault, FieldPath, Scene, check, is_whole};
use crate::study::settled::{followed, runs_from, settled_within, widened};
use crate::study::{Task, followed_until};
use crate::system::threads::{Pool, Queue};

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Judged {
    /// It is not a valid scene.
    Invalid(Vec<Fault>),
    /// A result is missing, or a run ended early.
    Missing,
    /// Constraints are violated: the sum of the relative violations, the results, and the value.
    Broken(f64, Vec<f64>, f64),
    Value(f64, Vec<f64>),
}

impl Judged {
    pub fn value(&self) -> Option<f64> {
        if let Self::Value(value, _) = self { Some(*value) } else { None }
    }

    /// The design `at` as an optimum, if it has a value.
    pub fn optimum(&self, at: &[f64]) -> Option<Optimum> {
        let Self::Value(value, of_each) = self else { return None };
        Some(Optimum { at: at.to_vec(), value: *value, of_each: of_each.clone() })
    }
}

/// A varied design: the values of its fields, and those of the fields that vary.
pub(super) type Design = (Vec<f64>, Vec<f64>);

/// What a run comes to: the maximised number and those of the constraints, each missing where the run has no
/// such number; `None` if the run does not reach its end.
pub type Results = Option<Vec<Option<f64>>>;

/// The results of a run, or what is wrong with its scene.
type Ran = Result<Results, Vec<Fault>>;

/// A run of a search: a design in one of the environments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DesignRun<'a> {
    /// The values of the fields of the design.
    pub at: &'a [f64],
    /// Those of the fields that vary; empty for the design itself.
    pub varied: &'a [f64],
    /// Index of the environment.
    pub environment: usize,
}

/// Where the results of runs are kept, so that they need not be computed again. All threads use it.
pub trait Memory: Sync {
    /// The results of a run, if they are known.
    fn recall(&self, run: DesignRun<'_>) -> Option<Results>;
    /// Keeps the results of a run that has ended.
    fn keep(&self, run: DesignRun<'_>, results: &Results);
}

pub(super) struct Evaluator<'a> {
    pub question: &'a BestQuestion,
    /// The ranges of the question, in which fields of whole numbers are marked.
    pub over: Vec<DesignRange>,
    pub pool: &'a Pool,
    task: &'a Task<'a>,
    memory: Option<&'a dyn Memory>,
    paths: Vec<FieldPath>,
    varied: Vec<FieldPath>,
    /// The mechanism of each environment's scene, if it could be built.
    mechanisms: Vec<Option<Arc<Mechanism>>>,
    /// The designs that were judged so far, without those that vary.
    tried: Mutex<Vec<Tried>>,
    sample: Sample,
    /// Those with a value, where their values in the environments are needed.
    of_each: Mutex<Vec<Optimum>>,
}

impl<'a> Evaluator<'a> {
    pub fn new(
        question: &'a BestQuestion,
        pool: &'a Pool,
        task: &'a Task<'a>,
        memory: Option<&'a dyn Memory>,
    ) -> Result<Self, NoBest> {
        let mut mechanisms: Vec<Option<Arc<Mechanism>>> = Vec::new();
        for (i, base) in question.environments.iter().enumerate() {
            let same = |other: &usize| question.environments[*other].scene.mechanism == base.scene.mechanism;
            let built = match (0..i).find(same) {
                Some(other) => mechanisms[other].clone(),
                None => {
                    let built = Mechanism::build_cancellable(&base.scene.mechanism, &base.files, task.cancel);
                    built.ok_or(NoBest::Cancelled)?.ok().map(Arc::new)
                }
            };
            mechanisms.push(built);
        }
        let path = |field: &String| FieldPath::new(field);
        let scene = &question.environments[0].scene;
        let known =
            |range: &DesignRange| DesignRange { whole: is_whole(scene, &range.field), ..range.clone() };
        Ok(Self {
            question,
            over: question.over.iter().map(known).collect(),
            pool,
            task,
            memory,
            paths: question.over.iter().map(|range| path(&range.field)).collect(),
            varied: question.vary.iter().map(|tolerance| path(&tolerance.field)).collect(),
            mechanisms,
            tried: Mutex::default(),
            sample: Sample::new(question),
            of_each: Mutex::default(),
        })
    }

    pub fn values_of_varied(&self, at: &[f64]) -> Vec<f64> {
        let mut scene = self.question.environments[0].scene.clone();
        apply(&self.paths, at, &mut scene);
        self.varied.iter().map(|path| path.get(&scene).unwrap_or(f64::NAN)).collect()
    }

    pub fn check_cancelled(&self) -> Result<(), NoBest> {
        if self.task.is_cancelled() { Err(NoBest::Cancelled) } else { Ok(()) }
    }

    pub fn judge(&self, designs: &[Vec<f64>]) -> Result<Vec<Judged>, NoBest> {
        let judged = self.judge_each(designs.len(), |number| (&designs[number], &[]))?;
        let tried = designs.iter().zip(&judged).map(|(at, judged)| {
            let (value, keeps) = match judged {
                Judged::Invalid(_) | Judged::Missing => (None, true),
                Judged::Broken(_, _, value) => (Some(*value), false),
                Judged::Value(value, _) => (Some(*value), true),
            };
            Tried { at: at.clone(), value, keeps }
        });
        self.tried.lock().unwrap_or_else(PoisonError::into_inner).extend(tried);
        if self.sample.is_averaged() {
            let optima = designs.iter().zip(&judged).filter_map(|(at, judged)| judged.optimum(at));
            self.of_each.lock().unwrap_or_else(PoisonError::into_inner).extend(optima);
        }
        Ok(judged)
    }

    /// What the best design owes to the seeds of noises.
    pub fn seeds(&self, best: &Optimum) -> Seeds {
        self.sample.seeds(best, &self.of_each.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// The value of a design from runs that are followed for twice as long, if a motion has not repeated by
    /// the end of its run under a drive that does; NaN if it then has no value.
    pub fn later(&self, at: &[f64]) -> Result<Option<f64>, NoBest> {
        let model = |environment: usize| self.model((at, &[]), environment).map(widened);
        let run = |environment: usize, longer: f64| -> Result<Summary, Vec<Fault>> {
            let model = model(environment)?;
            let until = longer * self.question.until_settled.unwrap_or_else(|| followed_until(&model));
            settled_within(&model, Some(until), self.task.cancel).ok_or_else(Vec::new)
        };
        let environments = 0..self.question.environments.len();
        let is_open = |environment: usize| {
            model(environment).is_ok_and(|model| model.repeats())
                && run(environment, 1.0).is_ok_and(|summary| summary.settled == Some(false))
        };
        let later = |environment: usize| run(environment, 2.0).map(|summary| self.results(&summary));
        let runs = environments.clone().any(is_open).then(|| environments.map(later).collect());
        self.check_cancelled()?;
        Ok(runs.map(|runs: Vec<Ran>| match self.judged(&runs) {
            Judged::Value(value, _) | Judged::Broken(_, _, value) => value,
            Judged::Invalid(_) | Judged::Missing => f64::NAN,
        }))
    }

    /// All designs that were judged, in order.
    pub fn into_tried(self) -> Vec<Tried> {
        self.tried.into_inner().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn judge_varied(&self, designs: &[Design]) -> Result<Vec<Judged>, NoBest> {
        self.judge_each(designs.len(), |number| (&designs[number].0, &designs[number].1))
    }

    /// Judges this many designs; `design` returns the values of their fields, and of those that vary.
    fn judge_each<'d>(
        &self,
        count: usize,
        design: impl Fn(usize) -> (&'d [f64], &'d [f64]) + Sync,
    ) -> Result<Vec<Judged>, NoBest> {
        let each = self.question.environments.len();
        let constraints = self.question.subject_to.iter().map(|constraint| constraint.of);
        let ledger = constraints.chain([self.question.maximise]).any(|field| field.needs_ledger);
        let ticked = |ran: Ran| {
            (self.task.tick)();
            ran
        };
        let run_of = |job: usize| {
            let (at, varied) = design(job / each);
            DesignRun { at, varied, environment: job % each }
        };
        let model = |job: usize| {
            let run = run_of(job);
            if let Some(results) = self.memory.and_then(|memory| memory.recall(run)) {
                return Err(ticked(Ok(results)));
            }
            let model = self.model((run.at, run.varied), run.environment);
            let (model, request) =
                followed(model.map_err(|faults| ticked(Err(faults)))?, self.question.until_settled);
            Ok((model, Request { ledger, ..request }))
        };
        let ended = |job: usize, run: &Run| {
            let results = self.results(&run.summary);
            let is_whole = !matches!(run.summary.outcome, Outcome::Cancelled { .. });
            if let Some(memory) = self.memory.filter(|_| is_whole) {
                memory.keep(run_of(job), &results);
            }
            ticked(Ok(results))
        };
        let queue = Queue::new(count * each, self.pool.count());
        let runs = runs_from(Some(self.pool), self.task, &|under_way| queue.take(under_way), model, ended);
        let runs = runs.ok_or(NoBest::Cancelled)?;
        Ok(runs.chunks(each).map(|runs| self.judged(runs)).collect())
    }

    fn results(&self, summary: &Summary) -> Results {
        let constraints = self.question.subject_to.iter().map(|constraint| constraint.of);
        let fields = std::iter::once(self.question.maximise).chain(constraints);
        (summary.outcome == Outcome::Done).then(|| fields.map(|field| field.number(summary)).collect())
    }

    fn model(&self, (at, varied): (&[f64], &[f64]), environment: usize) -> Result<Model, Vec<Fault>> {
        let base = &self.question.environments[environment];
        let mut scene = Scene { sweep: Vec::new(), app: None, notes: String::new(), ..base.scene.clone() };
        apply(&self.paths, at, &mut scene);
        apply(&self.varied, varied, &mut scene);
        let faults = check(&scene).faults;
        if !faults.is_empty() {
            return Err(faults);
        }
        let mechanism = match &self.mechanisms[environment] {
            Some(mechanism) if scene.mechanism == base.scene.mechanism => Arc::clone(mechanism),
            _ => match Mechanism::build_cancellable(&scene.mechanism, &base.files, self.task.cancel) {
                Some(Ok(mechanism)) => Arc::new(mechanism),
                Some(Err(BuildError::Wrong(fault))) => return Err(vec![fault]),
                Some(Err(BuildError::Unsolved(_))) | None => return Err(Vec::new()),
            },
        };
        Model::build(&scene, mechanism)
    }

    /// The result of one design from its runs in all environments.
    fn judged(&self, runs: &[Ran]) -> Judged {
        let runs = match runs.iter().map(Result::as_ref).collect::<Result<Vec<_>, _>>() {
            Ok(runs) => runs,
            Err(faults) => return Judged::Invalid(faults.clone()),
        };
        let Some(runs) = runs.into_iter().map(Option::as_deref).collect::<Option<Vec<_>>>() else {
            return Judged::Missing;
        };
        let (mut broken, mut results) = (0.0, Vec::new());
        for (number, constraint) in (1..).zip(&self.question.subject_to) {
            let mut furthest: Option<(f64, f64)> = None;
            for run in &runs {
                let Some(result) = run[number] else { return Judged::Missing };
                let over =
                    if constraint.at_most { result - constraint.limit } else { constraint.limit - result };
                if furthest.is_none_or(|(largest, _)| over > largest) {
                    furthest = Some((over, result));
                }
            }
            let (over, result) = furthest.unwrap_or((0.0, f64::NAN));
            let unit = if constraint.limit == 0.0 { 1.0 } else { constraint.limit.abs() };
            broken += over.max(0.0) / unit;
            results.push(result);
        }
        let of_each: Option<Vec<f64>> = runs.iter().map(|run| run[0]).collect();
        let Some(of_each) = of_each else { return Judged::Missing };
        let weights = self.question.environments.iter().map(|environment| environment.weight);
        let sum: f64 = of_each.iter().zip(weights.clone()).map(|(value, weight)| value * weight).sum();
        let value = sum / weights.sum::<f64>();
        if broken > 0.0 { Judged::Broken(broken, results, value) } else { Judged::Value(value, of_each) }
    }
}

/// Sets the fields of a design in a scene that has them.
fn apply(paths: &[FieldPath], at: &[f64], scene: &mut Scene) {
    for (path, value) in paths.iter().zip(at) {
        let known = path.set(scene, *value);
        debug_assert!(known, "a design belongs to a scene that has its fields");
    }
}
