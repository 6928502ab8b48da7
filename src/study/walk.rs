//! Walks over the last field of a grid: each cell goes on from where the motion of the one before was.

use std::sync::Mutex;
use std::sync::atomic::Ordering;

use super::Task;
use super::cell::{Cell, SweepEnd, Tally};
use super::cells::{Cells, Direction, Question, Ran};
use super::slice::Slice;
use super::table::Table;
use crate::dynamics::{Model, Request};
use crate::scene::{Fault, Scene};
use crate::system::threads::Pool;

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
        [Self::Up, Self::Down, Self::Both].into_iter().find(|own| own.name() == word)
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

/// Walks that a thread runs together: as many as the widest processor has lanes.
const TOGETHER: usize = 16;

/// Cells of all walks of a thread between two looks at the rows.
const CELLS_PER_THREAD: usize = 256;

/// One walk: where it is.
struct Walk {
    /// The first cell of its row of the grid, in which direction it goes, and how many it has gone through.
    begin: u64,
    direction: Direction,
    done: u64,
    /// The model of the last cell that was run, and the state from which the next one goes on.
    last: Option<(Model, (f64, f64))>,
}

impl Walk {
    /// The cell that comes next of a row of so many.
    fn next(&self, length: u64) -> u64 {
        self.begin
            + match self.direction {
                Direction::Up => self.done,
                Direction::Down => length - 1 - self.done,
            }
    }
}

/// Why no state of a drive's phase 0 can be carried from a cell to the next.
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
        mut write: impl FnMut(&Table, &Tally) -> Result<bool, E>,
    ) -> Result<Tally, SweepEnd<E>> {
        let (length, directions) = (slice.unit(), carry.directions());
        let walk = |place: u64| {
            let number = slice.row(place) / length;
            let (row, way) = (number / directions.len() as u64, number % directions.len() as u64);
            Walk { begin: row * length, direction: directions[way as usize], done: 0, last: None }
        };
        let mut walks = (from..slice.rows()).step_by(length as usize).map(walk);
        let mut tally = Tally::default();
        let mut put = |table: &Table, own: &Tally| {
            tally.add(own);
            tally.mechanisms = self.built.load(Ordering::Relaxed);
            write(table, own).map_err(SweepEnd::Write)
        };
        loop {
            let mut group: Vec<Walk> = walks.by_ref().take(TOGETHER * pool.count()).collect();
            if group.is_empty() {
                return Ok(tally);
            }
            let each = group.len().div_ceil(pool.count());
            let parts: Vec<Mutex<&mut [Walk]>> = group.chunks_mut(each).map(Mutex::new).collect();
            let (mut done, mut tables) = (0, Vec::<(Table, Tally)>::new());
            while done < length {
                let most = (question.most_cells() / (parts.len() * each) as u64).max(1);
                let steps = ((CELLS_PER_THREAD / each) as u64).clamp(1, most).min(length - done);
                let ran = pool.map(
                    parts.len(),
                    || self.base.clone(),
                    |scene, part| {
                        // No other thread has this part.
                        let mut walks = parts[part].lock().map_err(|_| ())?;
                        self.go_on(question, &mut walks, (length, steps), scene, task)
                    },
                );
                let ran = ran.map_err(|()| SweepEnd::Cancelled)?;
                for (walk, rows) in ran.into_iter().flatten().enumerate() {
                    let mut own = Tally::default();
                    rows.iter().for_each(|row: &Ran<_>| own.count(&row.cell));
                    let table = question.table(&self.grid, &rows);
                    if walk == 0 {
                        if !put(&table, &own)? {
                            return Ok(tally);
                        }
                        continue;
                    }
                    tables.resize_with(tables.len().max(walk), Default::default);
                    tables[walk - 1].0.append(&table);
                    tables[walk - 1].1.add(&own);
                }
                done += steps;
            }
            for (table, own) in &tables {
                if !put(table, own)? {
                    return Ok(tally);
                }
            }
        }
    }

    /// Goes on with some walks by so many `steps`; the rows of each walk.
    fn go_on<Q: Question>(
        &self,
        question: &Q,
        walks: &mut [Walk],
        (length, steps): (u64, u64),
        scene: &mut Scene,
        task: &Task,
    ) -> Result<Vec<Vec<Ran<Q::Answer>>>, ()> {
        let request = Request { cancel: Some(task.cancel), carry: true, ..question.request() };
        let mut rows: Vec<Vec<Ran<Q::Answer>>> = walks.iter().map(|_| Vec::new()).collect();
        for _ in 0..steps {
            let (mut models, mut places) = (Vec::new(), Vec::new());
            for (place, walk) in walks.iter_mut().enumerate() {
                let index = walk.next(length);
                walk.done += 1;
                let model = self.model(index, scene, task).and_then(Result::ok);
                let cell = if model.is_some() { Cell::NotRun } else { Cell::Unsolved };
                rows[place].push(Ran { index, direction: Some(walk.direction), cell, answer: None });
                if let Some(model) = model {
                    let model = question.model(model);
                    models.push(match &walk.last {
                        Some((before, state)) => model.carried_on(before, *state),
                        None => model,
                    });
                    places.push(place);
                }
            }
            let runs = Model::run_together(&models, &request);
            if task.is_cancelled() {
                return Err(());
            }
            for ((place, model), run) in places.into_iter().zip(models).zip(runs) {
                let finite = run.carried.filter(|(x, v)| x.is_finite() && v.is_finite());
                if let Some(row) = rows[place].last_mut() {
                    row.cell = Cell::Run(run.summary);
                    row.answer = Some(question.answer(&model, run));
                }
                if let Some(state) = finite {
                    walks[place].last = Some((model, state));
                }
            }
            walks.iter().for_each(|_| (task.tick)());
        }
        Ok(rows)
    }
}
