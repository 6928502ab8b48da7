//! A scene whose runs are made once, when a condition first asks for them.

use std::cell::{OnceCell, RefCell};
use std::sync::Arc;

use super::judge::Unjudged;
use crate::dynamics::{Model, Outcome, Request, Summary};
use crate::mechanics::Mechanism;
use crate::scene::{Axis, Excitation, FieldPath, Files, Scene, Start, SweepAxis};
use crate::study::up_and_down::walk_over;
use crate::study::{Family, Task};

/// Runs that go side by side.
const TOGETHER: usize = 32;

/// What is judged: a scene, and what it is compared with.
pub struct Subject<'a> {
    scene: &'a Scene,
    files: &'a Files,
    task: &'a Task<'a>,
    seeds: u32,
    walk: Option<&'a SweepAxis>,
    mechanism: OnceCell<Arc<Mechanism>>,
    run: OnceCell<Summary>,
    from: RefCell<Vec<(Start, Summary)>>,
    over_seeds: OnceCell<Vec<Summary>>,
    ends: OnceCell<[Summary; 2]>,
    turns: OnceCell<Turns>,
}

/// Where the motion begins to cross on the way up, and to where it goes on crossing on the way down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Turns {
    pub up_crosses_from: Option<f64>,
    pub down_crosses_to: Option<f64>,
}

impl<'a> Subject<'a> {
    /// Of a scene whose files are at hand, for a lesson with these `seeds` and this `walk`.
    pub fn new(
        scene: &'a Scene,
        files: &'a Files,
        (seeds, walk): (Option<u32>, Option<&'a SweepAxis>),
        task: &'a Task<'a>,
    ) -> Self {
        Self {
            scene,
            files,
            task,
            seeds: seeds.unwrap_or(0),
            walk,
            mechanism: OnceCell::new(),
            run: OnceCell::new(),
            from: RefCell::default(),
            over_seeds: OnceCell::new(),
            ends: OnceCell::new(),
            turns: OnceCell::new(),
        }
    }

    /// The same with a mechanism that is built already.
    #[must_use]
    pub fn with_mechanism(self, mechanism: Arc<Mechanism>) -> Self {
        Self { mechanism: OnceCell::from(mechanism), ..self }
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        self.scene
    }

    /// The run of the scene.
    pub(super) fn run(&self) -> Result<&Summary, Unjudged> {
        once(&self.run, || {
            let run = self.together(&[self.model(self.scene)?])?;
            run.into_iter().next().ok_or(Unjudged::Cancelled)
        })
    }

    /// The runs from these starts.
    pub(super) fn from(&self, starts: &[Start]) -> Result<Vec<Summary>, Unjudged> {
        let known = |start: &Start| self.from.borrow().iter().any(|own| own.0 == *start);
        let new: Vec<Start> = starts.iter().filter(|start| !known(start)).copied().collect();
        let model = |start: &Start| self.model(&Scene { start: *start, ..self.scene.clone() });
        let models = new.iter().map(model).collect::<Result<Vec<_>, _>>()?;
        let runs = self.together(&models)?;
        self.from.borrow_mut().extend(new.into_iter().zip(runs));
        let from = self.from.borrow();
        let of = |start: &Start| from.iter().find(|own| own.0 == *start).map(|own| own.1);
        Ok(starts.iter().filter_map(of).collect())
    }

    /// The runs with the seeds from 1 on.
    pub(super) fn over_seeds(&self) -> Result<&[Summary], Unjudged> {
        let runs = once(&self.over_seeds, || {
            let of_seed = |number: u64| {
                let mut scene = self.scene.clone();
                if let Excitation::Noise { seed, .. } = &mut scene.excitation {
                    *seed = number;
                }
                self.model(&scene)
            };
            let models = (1..=u64::from(self.seeds)).map(of_seed).collect::<Result<Vec<_>, _>>()?;
            self.together(&models)
        });
        runs.map(Vec::as_slice)
    }

    /// The runs at the scene's own value of the walked field, up to it and down to it.
    pub(super) fn walked_to(&self) -> Result<&[Summary; 2], Unjudged> {
        once(&self.ends, || {
            let axis = self.axis()?;
            let path = FieldPath::new(&axis.field);
            let own = path
                .get(self.scene)
                .ok_or_else(|| Unjudged::of(&axis.field, "the scene has no such field"))?;
            let before: Vec<f64> = axis.values.iter().copied().filter(|value| *value < own).collect();
            let after: Vec<f64> = axis.values.iter().rev().copied().filter(|value| *value > own).collect();
            let last = |values: Vec<f64>| {
                let all: Vec<f64> = values.into_iter().chain([own]).collect();
                let mut last = None;
                self.walk(&axis.field, &all, |_, summary| {
                    last = Some(*summary);
                    true
                })?;
                last.ok_or(Unjudged::Cancelled)
            };
            Ok([last(before)?, last(after)?])
        })
    }

    /// Where the motion begins to cross and ends to, over the whole walk.
    pub(super) fn turns(&self) -> Result<Turns, Unjudged> {
        let turns = once(&self.turns, || {
            let axis = self.axis()?;
            let (mut up, mut down) = (None, None);
            self.walk(&axis.field, &axis.values, |value, summary| {
                up = (summary.crossings > 0).then_some(value);
                up.is_none()
            })?;
            let downwards: Vec<f64> = axis.values.iter().rev().copied().collect();
            let mut ended = false;
            self.walk(&axis.field, &downwards, |value, summary| {
                ended = summary.crossings == 0;
                down = if ended { down } else { Some(value) };
                !ended
            })?;
            Ok(Turns { up_crosses_from: up, down_crosses_to: down.filter(|_| ended) })
        });
        turns.copied()
    }

    fn axis(&self) -> Result<Axis, Unjudged> {
        let axis = self.walk.ok_or_else(|| Unjudged::of("walk", "the lesson has none"))?;
        Axis::from_scene(axis, self.scene).map_err(|(_, problem)| Unjudged::of("walk", &problem))
    }

    /// Runs the scene with one value after the other, each from where the one before ended, until `each` has
    /// seen enough.
    fn walk(
        &self,
        field: &str,
        values: &[f64],
        mut each: impl FnMut(f64, &Summary) -> bool,
    ) -> Result<(), Unjudged> {
        let mechanism = self.mechanism_of(self.scene)?;
        let family = Family::new(self.scene, self.files, &mechanism, field);
        let request = Request { carry: true, ..self.request() };
        let mut ended = Ok(());
        let unfit = walk_over(&family, values, &request, |value, run| {
            ended = self.ended(&run.summary);
            ended.is_ok() && each(value, &run.summary)
        });
        match unfit {
            0 => ended,
            _ => Err(Unjudged::of(field, "a value of the walk makes no scene that can be run")),
        }
    }

    fn request(&self) -> Request<'_> {
        Request { ledger: true, cancel: Some(self.task.cancel), ..Request::default() }
    }

    fn together(&self, models: &[Model]) -> Result<Vec<Summary>, Unjudged> {
        let mut summaries = Vec::with_capacity(models.len());
        for models in models.chunks(TOGETHER) {
            for run in Model::run_together(models, &self.request()) {
                self.ended(&run.summary)?;
                summaries.push(run.summary);
            }
        }
        Ok(summaries)
    }

    fn ended(&self, summary: &Summary) -> Result<(), Unjudged> {
        (self.task.tick)();
        let cancelled = self.task.is_cancelled() || matches!(summary.outcome, Outcome::Cancelled { .. });
        if cancelled { Err(Unjudged::Cancelled) } else { Ok(()) }
    }

    /// The model of a scene that differs from the subject's in a few fields.
    fn model(&self, scene: &Scene) -> Result<Model, Unjudged> {
        Model::build(scene, self.mechanism_of(scene)?).map_err(|faults| {
            let fault = faults.into_iter().next();
            fault.map_or_else(
                || Unjudged::of("", "cannot be run"),
                |own| Unjudged::of(&own.field, &own.problem),
            )
        })
    }

    /// Its mechanism: the subject's own where it is the same.
    fn mechanism_of(&self, scene: &Scene) -> Result<Arc<Mechanism>, Unjudged> {
        let build = || {
            Mechanism::build(&scene.mechanism, self.files)
                .map(Arc::new)
                .map_err(|error| Unjudged::of("mechanism", &error.to_string()))
        };
        match scene.mechanism == self.scene.mechanism {
            true => once(&self.mechanism, build).cloned(),
            false => build(),
        }
    }
}

/// The value of `cell`, made where there is none yet.
fn once<T>(cell: &OnceCell<T>, make: impl FnOnce() -> Result<T, Unjudged>) -> Result<&T, Unjudged> {
    if let Some(value) = cell.get() {
        return Ok(value);
    }
    let value = make()?;
    Ok(cell.get_or_init(|| value))
}
