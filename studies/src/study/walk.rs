//! Walks over the last field of a grid: each cell goes on from where the motion of the one before was.

use crate::dynamics::{Model, Run};
use crate::scene::{Fault, FieldPath, Scene};

/// The direction in which the values of a field are gone through.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// In their order.
    Up,
    /// From the last to the first.
    Down,
}

impl Direction {
    /// The word in the CSV.
    pub fn name(self) -> &'static str {
        match self {
            Self::Up => "up",
            Self::Down => "down",
        }
    }
}

/// In which directions the last field of a grid is walked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Carry {
    /// In the order of its values.
    Up,
    /// Backwards.
    Down,
    /// Both, each for itself.
    Both,
}

impl Carry {
    /// What is called `up`, `down` or `both`.
    pub fn named(word: &str) -> Option<Self> {
        [Self::Up, Self::Down, Self::Both].into_iter().find(|carry| carry.name() == word)
    }

    /// The word in an argument.
    pub fn name(self) -> &'static str {
        match self {
            Self::Up => "up",
            Self::Down => "down",
            Self::Both => "both",
        }
    }

    /// The directions, in the order of the rows.
    pub fn directions(self) -> &'static [Direction] {
        match self {
            Self::Up => &[Direction::Up],
            Self::Down => &[Direction::Down],
            Self::Both => &[Direction::Up, Direction::Down],
        }
    }
}

/// Cells that are answered one after the other. The first begins at its scene's start, each further one in
/// the state of the one before at the last instant of its run that is a whole number of forcing periods after
/// its start. A cell alone is a walk of length 1 without a direction.
pub(super) struct Walk {
    /// The first of its cells in the order of the grid.
    begin: u64,
    /// Number of its cells.
    pub length: u64,
    pub direction: Option<Direction>,
    /// Number of cells it has gone through.
    pub done: u64,
    pub carried: Carried,
}

/// The model of the last run of a walk, and the state from which the next one goes on.
#[derive(Default)]
pub(super) struct Carried(Option<(Model, (f64, f64))>);

impl Carried {
    /// The next model, which goes on from the run before.
    pub fn on(&self, model: Model) -> Model {
        match &self.0 {
            Some((before, state)) => model.carried_on(before, *state),
            None => model,
        }
    }

    /// Keeps the state from which the next run goes on.
    pub fn keep(&mut self, model: &Model, run: &Run) {
        if let Some(state) = run.carried.filter(|(x, v)| x.is_finite() && v.is_finite()) {
            self.0 = Some((model.clone(), state));
        }
    }
}

impl Walk {
    pub fn new(begin: u64, length: u64, direction: Option<Direction>) -> Self {
        Self { begin, length, direction, done: 0, carried: Carried::default() }
    }

    /// The next cell.
    pub fn cell(&self) -> u64 {
        match self.direction {
            Some(Direction::Down) => self.begin + self.length - 1 - self.done,
            Some(Direction::Up) | None => self.begin + self.done,
        }
    }
}

/// The fault of a drive without a period, which `what` needs.
pub(super) fn without_a_period(model: &Model, scene: &Scene, what: &str) -> Option<Fault> {
    let problem = format!(
        "has no period that repeats, which {what} needs; take a Sine, or a Sum of sines whose frequencies \
         have a common period"
    );
    (!model.repeats()).then(|| excitation_fault(scene, problem))
}

/// A fault of a scene's excitation, named by its kind.
pub(super) fn excitation_fault(scene: &Scene, problem: String) -> Fault {
    let kind = FieldPath::new("excitation").word(scene);
    Fault { field: "excitation".into(), value: kind.unwrap_or_else(|| "None".to_owned()), problem }
}
