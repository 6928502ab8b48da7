//! Runs of designs in their environments, several at a time.

use std::sync::{Arc, Mutex, PoisonError};

use super::{BestQuestion, DesignRange, NoBest, Optimum, Tried};
use crate::dynamics::{Model, Outcome, Request, Run, Summary};
use crate::mechanics::{BuildError, Mechanism};
use crate::scene::{Fault, FieldPath, Scene, check, is_whole};
use crate::study::Task;
use crate::study::settled::{followed, followed_until, settled_within, shared_runs, widened};
use crate::system::threads::Pool;

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

/// The summary of a run, or what is wrong with its scene.
type Ran = Result<Box<Summary>, Vec<Fault>>;

pub(super) struct Evaluator<'a> {
    pub question: &'a BestQuestion,
    /// The ranges of the question, in which fields of whole numbers are marked.
    pub over: Vec<DesignRange>,
    pub pool: &'a Pool,
    task: &'a Task<'a>,
    paths: Vec<FieldPath>,
    varied: Vec<FieldPath>,
    /// The mechanism of each environment's scene, if it could be built.
    mechanisms: Vec<Option<Arc<Mechanism>>>,
    /// The designs that were judged so far, without those that vary.
    tried: Mutex<Vec<Tried>>,
}

impl<'a> Evaluator<'a> {
    pub fn new(question: &'a BestQuestion, pool: &'a Pool, task: &'a Task<'a>) -> Result<Self, NoBest> {
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
            paths: question.over.iter().map(|range| path(&range.field)).collect(),
            varied: question.vary.iter().map(|variation| path(&variation.field)).collect(),
            mechanisms,
            tried: Mutex::default(),
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
        Ok(judged)
    }

    /// The value of a design from runs that are followed for twice as long, if a motion has not repeated by
    /// the end of its run under a drive that does; NaN if it then has no value.
    pub fn later(&self, at: &[f64]) -> Result<Option<f64>, NoBest> {
        let model = |environment: usize| self.model((at, &[]), environment).map(widened);
        let run = |environment: usize, longer: f64| -> Ran {
            let model = model(environment)?;
            let until = longer * self.question.until_settled.unwrap_or_else(|| followed_until(&model));
            let summary = settled_within(&model, Some(until), self.task.cancel);
            summary.map(Box::new).ok_or_else(Vec::new)
        };
        let environments = 0..self.question.environments.len();
        let is_open = |environment: usize| {
            model(environment).is_ok_and(|model| model.repeats())
                && run(environment, 1.0).is_ok_and(|summary| summary.settled == Some(false))
        };
        let runs =
            environments.clone().any(is_open).then(|| environments.map(|each| run(each, 2.0)).collect());
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
        let model = |job: usize| {
            let model = self.model(design(job / each), job % each).map_err(|faults| ticked(Err(faults)))?;
            let (model, request) = followed(model, self.question.until_settled);
            Ok((model, Request { ledger, ..request }))
        };
        let summary = |run: &Run| ticked(Ok(Box::new(run.summary)));
        let runs = shared_runs(Some(self.pool), self.task, count * each, model, summary);
        let summaries = runs.ok_or(NoBest::Cancelled)?;
        Ok(summaries.chunks(each).map(|runs| self.judged(runs)).collect())
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
        let summaries = match runs.iter().map(Result::as_ref).collect::<Result<Vec<_>, _>>() {
            Ok(summaries) => summaries,
            Err(faults) => return Judged::Invalid(faults.clone()),
        };
        if summaries.iter().any(|summary| summary.outcome != Outcome::Done) {
            return Judged::Missing;
        }
        let (mut broken, mut results) = (0.0, Vec::new());
        for constraint in &self.question.subject_to {
            let mut furthest: Option<(f64, f64)> = None;
            for summary in &summaries {
                let Some(result) = constraint.of.number(summary) else { return Judged::Missing };
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
        let of_each: Option<Vec<f64>> =
            summaries.iter().map(|summary| self.question.maximise.number(summary)).collect();
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
