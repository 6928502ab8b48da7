//! Where the motion goes from every start: basins of attraction, coarse first.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::app::session::Session;
use crate::app::session::map::ground;
use crate::app::task::{Background, pool};
use crate::mechanics::Mechanism;
use crate::scene::{Scene, Start};
use crate::study::{Answer, Basins, EvenRange, NoBasins, Starts, Task};

/// Starts across and up.
pub const STARTS: u64 = 81;

/// A scene without its start, and the ends of the grid of starts.
#[derive(Debug, Clone, PartialEq)]
pub struct BasinsQuestion {
    pub scene: Scene,
    /// Ends of the displacements in mm.
    pub x_mm: (f64, f64),
    /// Ends of the velocities in m/s.
    pub v: (f64, f64),
}

/// What is known after a level of starts.
#[derive(Debug, Clone)]
pub struct Level {
    /// The attractors, and what each start goes to.
    pub answer: Answer,
    /// For each start the one whose answer is shown: itself, or a neighbour.
    pub shown: Vec<usize>,
    /// Displacements in mm and velocities in m/s of the starts.
    pub axes: (Vec<f64>, Vec<f64>),
    /// Least and greatest displacement in m that the mass can have.
    pub room: (f64, f64),
}

/// The basins as they become known, level by level, or why there are none.
pub type BasinsFound = Background<BasinsQuestion, Result<Level, String>>;

impl Session {
    /// Asks for the basins of the scene as it stands, in a frame that shows them over these displacements in
    /// m and velocities `v` in m/s.
    pub fn want_basins(&mut self, (low, high): (f64, f64), v: (f64, f64)) {
        let still = self.stands_still();
        let scene = ground(self.scene(), self.remembered_stops(), &[]);
        let question = BasinsQuestion { scene, x_mm: (low * 1e3, high * 1e3), v };
        let mechanism = Arc::clone(&self.mechanism);
        self.explore.basins.want(question, still, &self.wake, move |question, cancel, each| {
            find(question, mechanism, cancel, &|level| each(Ok(level))).err().map(Err)
        });
    }

    /// Sets the start of the scene to a displacement in m and a velocity in m/s and begins there; one step of
    /// undo.
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

/// Finds them, level by level; the error is why there are none.
fn find(
    question: &BasinsQuestion,
    mechanism: Arc<Mechanism>,
    cancel: &AtomicBool,
    each: &dyn Fn(Level),
) -> Result<(), String> {
    let range = |(from, to): (f64, f64)| EvenRange { from, to, count: STARTS };
    let starts =
        Starts::grid(&range(question.x_mm), &range(question.v)).map_err(|error| error.to_string())?;
    let why = |error: NoBasins| match error {
        NoBasins::Faults(faults) => faults.first().map_or(String::new(), |fault| fault.problem.clone()),
        other => other.to_string(),
    };
    let mut basins = Basins::new(&question.scene, mechanism, starts).map_err(why)?;
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
