//! Basins of attraction of the open scene, computed coarse first.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::app::session::Session;
use crate::app::session::map::ground;
use crate::app::task::{Background, pool};
use crate::mechanics::Mechanism;
use crate::scene::{Scene, Start};
use crate::study::{Answer, Basins, EvenRange, NoBasins, Starts, Task};

pub const STARTS: u64 = 81;

/// A scene, apart from its start, and the ranges of the starts.
#[derive(Debug, Clone, PartialEq)]
pub struct BasinsQuestion {
    pub scene: Scene,
    /// Least and greatest displacement in mm.
    pub x_mm: (f64, f64),
    /// Least and greatest velocity in m/s.
    pub v: (f64, f64),
}

/// What is known after one level of starts has been run.
#[derive(Debug, Clone)]
pub struct Level {
    /// The attractors, and the attractor that each start goes to.
    pub answer: Answer,
    /// For each start the index of the start whose answer is shown: itself or a neighbour.
    pub shown: Vec<usize>,
    /// Displacements in mm and velocities in m/s of the starts.
    pub axes: (Vec<f64>, Vec<f64>),
    /// Range of displacements in m that the mass may have.
    pub room: (f64, f64),
}

/// The basins, level by level, or why there are none.
pub type BasinsFound = Background<BasinsQuestion, Result<Level, String>>;

impl Session {
    /// Asks for the basins of the present scene over a range of displacements in m and of velocities `v` in
    /// m/s; to be called in every frame that shows them.
    pub fn want_basins(&mut self, (low, high): (f64, f64), v: (f64, f64)) {
        let still = self.stands_still();
        let scene = ground(self.scene(), self.remembered_stops(), &[]);
        let question = BasinsQuestion { scene, x_mm: (low * 1e3, high * 1e3), v };
        let mechanism = Arc::clone(&self.mechanism);
        self.explore.basins.want(question, still, &self.wake, move |question, cancel, each| {
            find(question, mechanism, cancel, &|level| each(Ok(level))).err().map(Err)
        });
    }

    /// Starts the scene at a displacement in m and a velocity in m/s, from now on, as one undo step.
    pub fn start_at(&mut self, x: f64, v: f64) {
        let rounded = |value: f64, unit: f64| (value / unit).round() * unit;
        let x_mm = crate::app::words::numbers::decimal(rounded(x * 1e3, 1e-3));
        let v_m_per_s = crate::app::words::numbers::decimal(rounded(v, 1e-4));
        if self.edit_once(|scene| scene.start = Start::At { x_mm, v_m_per_s, electrical: 0.0 }) {
            self.apply();
            self.restart();
        }
    }
}

/// Finds the basins level by level; the error says why there are none.
fn find(
    question: &BasinsQuestion,
    mechanism: Arc<Mechanism>,
    cancel: &AtomicBool,
    each: &dyn Fn(Level),
) -> Result<(), String> {
    let range = |(from, to): (f64, f64)| EvenRange { from, to, count: STARTS };
    let starts = Starts::grid(&range(question.x_mm), &range(question.v)).map_err(|why| why.to_string())?;
    let message = |error: NoBasins| match error {
        NoBasins::Faults(faults) => faults.first().map_or(String::new(), |fault| fault.problem.clone()),
        other => other.to_string(),
    };
    let mut basins = Basins::new(&question.scene, mechanism, starts).map_err(message)?;
    let task = Task { tick: &|| (), cancel };
    let Some(pool) = pool() else { return Ok(()) };
    while !basins.is_whole() {
        let Some(answer) = basins.run_level(&pool, &task).then(|| basins.answer(&task)).flatten() else {
            return Ok(());
        };
        let (levels, done) = basins.levels();
        let stand_in = |row: usize| match basins.is_whole() {
            true => row,
            false => levels.stand_in(row as u64, done - 1) as usize,
        };
        let shown = (0..basins.starts().count()).map(stand_in).collect();
        let axes = basins.starts().axes().map(|(x, v)| (x.to_vec(), v.to_vec())).unwrap_or_default();
        each(Level { answer, shown, axes, room: basins.room() });
    }
    Ok(())
}
