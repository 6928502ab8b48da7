//! Walks over the last field of a grid: each cell goes on from where the motion of the one before was.

use std::cell::RefCell;
use std::collections::BTreeMap;

use super::Task;
use super::cell::{Cell, SweepEnd, Tally};
use super::cells::{Cells, Direction, Question, Ran};
use super::slice::Slice;
use super::table::Table;
use crate::dynamics::{Model, Request, Run};
use crate::scene::{Fault, Scene};
use crate::system::threads::{Pool, UnderWay};

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

/// State of one walk.
struct Walk {
    /// The first cell of its row of the grid.
    begin: u64,
    direction: Direction,
    /// Number of cells it has gone through.
    done: u64,
    /// The model of the last cell that was run, and the state from which the next one goes on.
    last: Option<(Model, (f64, f64))>,
}

impl Walk {
    /// The next cell, in a row of `length` cells.
    fn cell(&self, length: u64) -> u64 {
        self.begin
            + match self.direction {
                Direction::Up => self.done,
                Direction::Down => length - 1 - self.done,
            }
    }
}

/// The fault of a drive without a period, which `what` needs.
pub(super) fn without_a_period(model: &Model, scene: &Scene, what: &str) -> Option<Fault> {
    (!model.repeats()).then(|| {
        let word = format!("{:?}", scene.excitation);
        Fault {
            field: "excitation".into(),
            value: word.split([' ', '(', '{']).next().unwrap_or_default().to_owned(),
            problem: format!(
                "has no period that repeats, which {what} needs; take a Sine, or a Sum of sines whose \
                 frequencies have a common period"
            ),
        }
    })
}

impl Cells {
    /// Walks the last field in these directions, for each combination of the others: the first cell of a walk
    /// begins at its scene's start, each further one in the state of the one before at the last instant of
    /// its run that is a whole number of forcing periods after its start. Rows in the order of the walks; a
    /// walk is a unit of the slice. Otherwise as [`run`](Self::run).
    pub fn walk<Q: Question, E>(
        &self,
        question: &Q,
        carry: Carry,
        (slice, from): (&Slice, u64),
        pool: &Pool,
        task: &Task,
        write: impl FnMut(&Table, &Tally) -> Result<bool, E>,
    ) -> Result<Tally, SweepEnd<E>> {
        let (length, directions) = (slice.unit(), carry.directions());
        let begin = |walk: usize| {
            let number = slice.row(from + walk as u64 * length) / length;
            let (row, way) = (number / directions.len() as u64, number % directions.len() as u64);
            Walk { begin: row * length, direction: directions[way as usize], done: 0, last: None }
        };
        let (request, length) = (Request { carry: true, ..question.request() }, length as usize);
        let work = |take: &dyn Fn(UnderWay) -> Option<usize>, done: &dyn Fn(usize, Ran<Q::Answer>)| {
            let mut scene = self.base.clone();
            // those that are to go on here, and those under way, by number
            let (ready, walking) = (RefCell::new(Vec::new()), RefCell::new(BTreeMap::new()));
            let ran = |number: usize, walk: Walk, cell: Cell, answer: Option<Q::Answer>| {
                if task.is_cancelled() {
                    return;
                }
                let (index, direction) = (walk.cell(length as u64), Some(walk.direction));
                done(number * length + walk.done as usize, Ran { index, direction, cell, answer });
                (task.tick)();
                let walk = Walk { done: walk.done + 1, ..walk };
                if (walk.done as usize) < length {
                    ready.borrow_mut().push((number, walk));
                }
            };
            let mut next = |under_way: UnderWay| loop {
                if task.is_cancelled() {
                    return None;
                }
                let kept = ready.borrow_mut().pop();
                let (number, walk) =
                    kept.or_else(|| take(under_way).map(|number| (number, begin(number))))?;
                match self.model(walk.cell(length as u64), &mut scene, task) {
                    Some(Ok(model)) => {
                        let model = question.model(model);
                        let model = match &walk.last {
                            Some((before, state)) => model.carried_on(before, *state),
                            None => model,
                        };
                        walking.borrow_mut().insert(number, walk);
                        return Some((number, model, Request { cancel: Some(task.cancel), ..request }));
                    }
                    Some(Err(_)) | None => ran(number, walk, Cell::Unsolved, None),
                }
            };
            let mut ended = |number: usize, model: &Model, run: Run| {
                let Some(mut walk): Option<Walk> = walking.borrow_mut().remove(&number) else { return };
                if let Some(state) = run.carried.filter(|(x, v)| x.is_finite() && v.is_finite()) {
                    walk.last = Some((model.clone(), state));
                }
                ran(number, walk, Cell::Run(run.summary), Some(question.answer(model, run)));
            };
            Model::run_from(&mut next, &mut ended);
        };
        let walks = ((slice.rows() - from) / length as u64) as usize;
        let ahead = Self::walks_ahead(length as u64) as usize * pool.count();
        self.in_order(question, (walks, length, ahead), pool, task, work, write)
    }
}
