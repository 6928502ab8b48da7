//! A scene whose runs are computed once, when a condition first needs them.

use std::cell::{OnceCell, RefCell};
use std::sync::Arc;

use super::judge::Unjudged;
use crate::dynamics::{Model, Request, Run, Summary};
use crate::mechanics::Mechanism;
use crate::scene::lesson::{Condition, Lesson};
use crate::scene::{Axis, Excitation, FieldPath, Files, Scene, Start};
use crate::study::settled::shared_runs;
use crate::study::walk::walk_over;
use crate::study::{Family, SummaryField, Task};
use crate::system::threads::Pool;

/// A scene to which conditions apply.
pub struct Subject<'a> {
    scene: &'a Scene,
    files: &'a Files,
    task: &'a Task<'a>,
    pool: Option<&'a Pool>,
    lesson: &'a Lesson,
    mechanism: OnceCell<Arc<Mechanism>>,
    run: OnceCell<Summary>,
    from: RefCell<Vec<(Start, Summary)>>,
    over_seeds: OnceCell<Vec<Summary>>,
    ends: OnceCell<[Summary; 2]>,
    turns: OnceCell<[Option<f64>; 2]>,
}

impl<'a> Subject<'a> {
    /// The subject of a scene with its files, in a step of a lesson.
    pub fn new(scene: &'a Scene, files: &'a Files, lesson: &'a Lesson, task: &'a Task<'a>) -> Self {
        Self {
            scene,
            files,
            task,
            pool: None,
            lesson,
            mechanism: OnceCell::new(),
            run: OnceCell::new(),
            from: RefCell::default(),
            over_seeds: OnceCell::new(),
            ends: OnceCell::new(),
            turns: OnceCell::new(),
        }
    }

    /// The subject with a mechanism that has already been built.
    #[must_use]
    pub fn with_mechanism(self, mechanism: Arc<Mechanism>) -> Self {
        Self { mechanism: OnceCell::from(mechanism), ..self }
    }

    /// The subject with the threads of a pool for its runs.
    #[must_use]
    pub fn on(self, pool: Option<&'a Pool>) -> Self {
        Self { pool, ..self }
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        self.scene
    }

    pub(super) fn is_of(&self, scene: &Scene, files: &Files) -> bool {
        *self.scene == *scene && *self.files == *files
    }

    pub(super) fn run(&self) -> Result<&Summary, Unjudged> {
        once(&self.run, || {
            let run = self.together(&[self.model(self.scene)?])?;
            run.into_iter().next().ok_or(Unjudged::Cancelled)
        })
    }

    pub(super) fn from(&self, starts: &[Start]) -> Result<Vec<Summary>, Unjudged> {
        let known = |start: &Start| self.from.borrow().iter().any(|entry| entry.0 == *start);
        let new: Vec<Start> = starts.iter().filter(|start| !known(start)).copied().collect();
        let model = |start: &Start| self.model(&Scene { start: *start, ..self.scene.clone() });
        let models = new.iter().map(model).collect::<Result<Vec<_>, _>>()?;
        let runs = self.together(&models)?;
        self.from.borrow_mut().extend(new.into_iter().zip(runs));
        let from = self.from.borrow();
        let of = |start: &Start| from.iter().find(|entry| entry.0 == *start).map(|entry| entry.1);
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
            let seeds = 1..=u64::from(self.lesson.seeds.unwrap_or(0));
            self.together(&seeds.map(of_seed).collect::<Result<Vec<_>, _>>()?)
        });
        runs.map(Vec::as_slice)
    }

    /// The runs at the scene's own value of the walked field, reached on the upward and on the downward walk.
    pub(super) fn walked_to(&self) -> Result<&[Summary; 2], Unjudged> {
        once(&self.ends, || {
            let axis = self.axis()?;
            let path = FieldPath::new(&axis.field);
            let present = path
                .get(self.scene)
                .ok_or_else(|| Unjudged::of(&axis.field, "the scene has no such field"))?;
            let values = axis.values.iter().copied();
            let before = values.clone().filter(|value| *value < present).chain([present]).collect();
            let after = values.rev().filter(|value| *value > present).chain([present]).collect();
            let [up, down] = self.walks(&axis.field, [before, after], |_, last, _, summary| {
                *last = Some(*summary);
                true
            })?;
            up.zip(down).map(|(up, down)| [up, down]).ok_or(Unjudged::Cancelled)
        })
    }

    /// The values at which the motion starts to cross on the upward walk and stops on the downward walk.
    pub(super) fn turns(&self) -> Result<[Option<f64>; 2], Unjudged> {
        let turns = once(&self.turns, || {
            let Axis { field, values, .. } = self.axis()?;
            let downwards: Vec<f64> = values.iter().rev().copied().collect();
            // the last value at which it crosses, and whether it crosses at the last value of all
            let walks =
                self.walks(&field, [values, downwards], |way, seen: &mut (_, bool), value, summary| {
                    seen.1 = summary.crossings > 0;
                    seen.0 = if seen.1 { Some(value) } else { seen.0 };
                    seen.1 == (way == 1)
                });
            let [up, down] = walks?;
            Ok([up.0, down.0.filter(|_| !down.1)])
        });
        turns.copied()
    }

    fn axis(&self) -> Result<Axis, Unjudged> {
        let axis = self.lesson.walk.as_ref().ok_or_else(|| Unjudged::of("walk", "the lesson has none"))?;
        Axis::from_scene(axis, self.scene).map_err(|(_, problem)| Unjudged::of("walk", &problem))
    }

    /// Walks the scene over two sequences of values at the same time, each run from the final state of the
    /// one before, until `each` returns false; returns the states that `each` accumulated for each sequence.
    fn walks<S: Default + Send>(
        &self,
        field: &str,
        rows: [Vec<f64>; 2],
        each: impl Fn(usize, &mut S, f64, &Summary) -> bool + Sync,
    ) -> Result<[S; 2], Unjudged> {
        let mechanism = self.mechanism_of(self.scene)?;
        let family = Family::new(self.scene, self.files, &mechanism, field);
        let (task, request) = (self.task, Request { carry: true, ..self.request() });
        let walk = |row: usize| {
            let mut seen = S::default();
            let unfit = walk_over(&family, &rows[row], &request, |value, run| {
                (task.tick)();
                !task.is_cancelled() && each(row, &mut seen, value, &run.summary)
            });
            match unfit {
                _ if task.is_cancelled() => Err(Unjudged::Cancelled),
                0 => Ok(seen),
                _ => Err(Unjudged::of(field, "a value of the walk makes no scene that can be run")),
            }
        };
        let seen = match self.pool {
            Some(pool) => pool.map(2, walk)?,
            None => vec![walk(0)?, walk(1)?],
        };
        seen.try_into().map_err(|_| Unjudged::Cancelled)
    }

    fn request(&self) -> Request<'a> {
        let ledger = self.lesson.conditions().any(needs_ledger);
        Request { ledger, cancel: Some(self.task.cancel), ..Request::default() }
    }

    fn together(&self, models: &[Model]) -> Result<Vec<Summary>, Unjudged> {
        let (task, request) = (self.task, self.request());
        let model = |number: usize| Ok((models[number].clone(), request));
        let summary = |run: &Run| {
            (task.tick)();
            Box::new(run.summary)
        };
        let runs = shared_runs(self.pool, task, models.len(), model, summary).ok_or(Unjudged::Cancelled)?;
        Ok(runs.into_iter().map(|summary| *summary).collect())
    }

    /// The model of a scene that differs from the subject's in a few fields.
    fn model(&self, scene: &Scene) -> Result<Model, Unjudged> {
        Model::build(scene, self.mechanism_of(scene)?).map_err(|faults| {
            let first = faults.first().map_or(("", "cannot be run"), |fault| (&fault.field, &fault.problem));
            Unjudged::of(first.0, first.1)
        })
    }

    /// The mechanism of a scene; that of the subject if it is the same.
    fn mechanism_of(&self, scene: &Scene) -> Result<Arc<Mechanism>, Unjudged> {
        let build = || {
            Mechanism::build(&scene.mechanism, self.files)
                .map(Arc::new)
                .map_err(|error| Unjudged::of("mechanism", &error.to_string()))
        };
        if scene.mechanism == self.scene.mechanism { once(&self.mechanism, build).cloned() } else { build() }
    }
}

/// Whether a condition names a field of the energy ledger.
fn needs_ledger(condition: &Condition) -> bool {
    let name = condition.field().and_then(|field| field.split_once('.'));
    let field = name.and_then(|(_, name)| SummaryField::find(name));
    field.is_some_and(|field| field.needs_ledger) || condition.parts().iter().any(needs_ledger)
}

/// The value of `cell`, made on first use.
fn once<T>(cell: &OnceCell<T>, make: impl FnOnce() -> Result<T, Unjudged>) -> Result<&T, Unjudged> {
    if let Some(value) = cell.get() {
        return Ok(value);
    }
    let value = make()?;
    Ok(cell.get_or_init(|| value))
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;

    use super::*;
    use crate::lesson::result_fields;
    use crate::scene::Document;
    use crate::scene::lesson::LessonDocument;

    #[test]
    fn a_subject_is_of_a_scene_with_its_files() {
        let lesson = LessonDocument::load("1", &result_fields()).unwrap().lesson;
        let document = Document::load("paper-table").unwrap();
        let of = |text: &str| {
            let mut files = document.files.clone();
            files.cached.insert("force.csv".to_owned(), text.to_owned());
            files
        };
        let files = of("x_m,force_n\n0,0\n1,1\n");
        let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
        let subject = Subject::new(&document.scene, &files, &lesson, &task);
        assert!(subject.is_of(&document.scene, &files.clone()));
        assert!(!subject.is_of(&document.scene, &of("x_m,force_n\n0,0\n1,2\n")));
        assert!(!subject.is_of(&Scene { mass_g: 1.0, ..document.scene.clone() }, &files));
    }
}
