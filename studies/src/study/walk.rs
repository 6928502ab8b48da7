//! Models that differ in one field of their scene, and walks over its values, in which each run continues
//! from the state of the one before.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::Task;
use crate::dynamics::{MapState, Model, Request, Run, Summary};
use crate::mechanics::{BuildError, Mechanism};
use crate::scene::{Fault, FieldPath, Files, Scene};
use crate::system::threads::Pool;

/// A scene, the field that changes, and the mechanism of the scene as it is.
#[derive(Debug)]
pub struct Family<'a> {
    scene: &'a Scene,
    files: &'a Files,
    mechanism: &'a Arc<Mechanism>,
    path: FieldPath,
    /// A second field, with its value.
    second: Option<(FieldPath, f64)>,
}

impl<'a> Family<'a> {
    /// The family of a scene with its mechanism, built from `files`, over the numeric field `field`.
    pub fn new(scene: &'a Scene, files: &'a Files, mechanism: &'a Arc<Mechanism>, field: &str) -> Self {
        Self { scene, files, mechanism, path: FieldPath::new(field), second: None }
    }

    /// The family over the same field with a second field at this value.
    #[must_use]
    pub fn with(&self, second: &FieldPath, value: f64) -> Self {
        Self { path: self.path.clone(), second: Some((second.clone(), value)), ..*self }
    }

    /// The model for this value of the field, or why there is none.
    pub fn model(&self, value: f64) -> Result<Model, NoModel> {
        let mut scene = self.scene.clone();
        let has_second = self.second.as_ref().is_none_or(|(path, value)| path.set(&mut scene, *value));
        if !(has_second && self.path.set(&mut scene, value)) {
            return Err(NoModel::NoField);
        }
        let mechanism = match scene.mechanism == self.scene.mechanism {
            true => Arc::clone(self.mechanism),
            false => match Mechanism::build(&scene.mechanism, self.files) {
                Ok(mechanism) => Arc::new(mechanism),
                Err(BuildError::Wrong(fault)) => return Err(NoModel::Faults(vec![fault])),
                Err(BuildError::Unsolved(_)) => return Err(NoModel::Unsolved),
            },
        };
        Model::build(&scene, mechanism).map_err(NoModel::Faults)
    }
}

/// Why a value of a field makes no model.
#[derive(Debug, Clone, PartialEq)]
pub enum NoModel {
    /// The scene does not have the field.
    NoField,
    /// The scene has faults.
    Faults(Vec<Fault>),
    /// Its mechanism is valid but not solved.
    Unsolved,
}

words! {
    /// The direction in which the values of a field are taken.
    Direction {
        /// In their order.
        Up = "up",
        /// From the last to the first.
        Down = "down",
    }
}

words! {
    /// In which directions the last field of a grid is walked.
    Carry {
        /// In the order of its values.
        Up = "up",
        /// Backwards.
        Down = "down",
        /// Both, as two separate walks.
        Both = "both",
    }
}

impl Carry {
    /// The directions, in the order of the rows.
    pub fn directions(self) -> &'static [Direction] {
        match self {
            Self::Up => &[Direction::Up],
            Self::Down => &[Direction::Down],
            Self::Both => &Direction::ALL,
        }
    }
}

/// Cells that are run one after the other. The first run begins at the start of its scene, each further one
/// in the state of the run before after a whole number of forcing periods. A single cell is a walk of length
/// 1.
pub(crate) struct Walk {
    /// The first of its cells in the order of the grid.
    begin: u64,
    /// Number of its cells.
    pub length: u64,
    pub direction: Option<Direction>,
    /// Which draw of the uncertain fields it has, 0 for none.
    pub draw: u64,
    /// Number of cells that have been run.
    pub done: u64,
    pub carried: Carried,
}

/// The model of the last run of a walk, and the state from which the next one continues.
#[derive(Default)]
pub(crate) struct Carried(Option<(Model, MapState)>);

impl Carried {
    /// The next model, which continues from the run before.
    pub fn continued(&self, model: Model) -> Model {
        if let Some((before, state)) = &self.0 { model.carried_on(before, *state) } else { model }
    }

    /// Stores the state from which the next run continues.
    pub fn keep(&mut self, model: &Model, run: &Run) {
        if let Some(state) = run.carried.filter(|state| state.x.is_finite() && state.v.is_finite()) {
            self.0 = Some((model.clone(), state));
        }
    }
}

impl Walk {
    pub fn new(begin: u64, length: u64, direction: Option<Direction>, draw: u64) -> Self {
        Self { begin, length, direction, draw, done: 0, carried: Carried::default() }
    }

    pub fn cell(&self) -> u64 {
        match self.direction {
            Some(Direction::Down) => self.begin + self.length - 1 - self.done,
            Some(Direction::Up) | None => self.begin + self.done,
        }
    }
}

/// The fault of a drive without a period, which `what` needs.
pub(crate) fn without_a_period(model: &Model, scene: &Scene, what: &str) -> Option<Fault> {
    let problem = format!(
        "has no period that repeats, which {what} needs; take a Sine, or a Sum of sines whose frequencies \
         have a common period"
    );
    (!model.repeats()).then(|| excitation_fault(scene, problem))
}

pub(crate) fn excitation_fault(scene: &Scene, problem: String) -> Fault {
    choice_fault(scene, "excitation", problem)
}

/// A fault of a choice of a scene, such as its excitation, named by its kind.
pub(crate) fn choice_fault(scene: &Scene, field: &str, problem: String) -> Fault {
    let kind = FieldPath::new(field).word(scene);
    Fault { field: field.into(), value: kind.unwrap_or_else(|| "None".to_owned()), problem }
}

/// Largest number of stroboscopic states that are kept of one run.
const MAX_STROBES: usize = 60;

/// A run of a walk.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Visit {
    /// The direction of its walk.
    pub direction: Direction,
    /// The value of the field.
    pub value: f64,
    /// Its summary.
    pub summary: Summary,
    /// Displacements in m at phase 0 of each forcing period: the last 60 of the settled window.
    pub strobes: Vec<f64>,
}

/// Walks a family over `values` (ascending) in each of these directions at the same time, and passes on each
/// run as soon as it has ended. Values without a model are skipped. False if cancelled.
pub fn up_and_down(
    family: &Family,
    values: &[f64],
    directions: &[Direction],
    pool: &Pool,
    task: &Task,
    each: &(dyn Fn(Visit) + Sync),
) -> bool {
    let request =
        Request { section: Some(0.0), carry: true, cancel: Some(task.cancel), ..Request::default() };
    let walk = |number: usize| {
        let direction = directions[number];
        let mut values: Vec<f64> = values.to_vec();
        if direction == Direction::Down {
            values.reverse();
        }
        walk_over(family, &values, &request, |value, run| {
            let skipped = run.section.len().saturating_sub(MAX_STROBES);
            let strobes = run.section[skipped..].iter().map(|point| point.x).collect();
            if !task.is_cancelled() {
                each(Visit { direction, value, summary: run.summary, strobes });
                (task.tick)();
            }
            !task.is_cancelled()
        });
        if task.is_cancelled() { Err(()) } else { Ok(()) }
    };
    pool.map(directions.len(), walk).is_ok()
}

/// Runs the family at one value after the other, each run from the final state of the one before, until
/// `each` returns false. Values without a model are skipped; returns their number.
pub(crate) fn walk_over(
    family: &Family,
    values: &[f64],
    request: &Request,
    mut each: impl FnMut(f64, &Run) -> bool,
) -> usize {
    let (mut carried, mut unfit) = (Carried::default(), 0);
    for value in values {
        let Ok(model) = family.model(*value) else {
            unfit += 1;
            continue;
        };
        let model = carried.continued(model);
        let run = model.run(request);
        if !each(*value, &run) {
            break;
        }
        carried.keep(&model, &run);
    }
    unfit
}
