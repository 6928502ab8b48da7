//! Studies of the open scene for the views of the layout Explore. A view asks for its study in every frame;
//! the study begins once nobody is changing the scene, and stops when no view asks for it.

use std::sync::atomic::AtomicBool;

use serde::{Deserialize, Serialize};

use crate::app::session::Session;
use crate::app::session::map::{ground, is_amplitude};
use crate::app::session::prepared::{Prepared, SharedModel};
use crate::app::task::{Background, Each, Question, Uncompared, progress, told};
use crate::app::words::numbers::decimal;
use crate::output::{Chart, basins_chart, suited_unit};
use crate::questions::{
    Answer, Basins, BasinsAnswer, Error, Signal, Spectrum, SpectrumAnswer, longest_wait, walks,
};
use crate::scene::{Axis, FieldPath, Scene, Start, SweepAxis};
use interwell_studies::study::{Direction, Visit};

#[derive(Default)]
pub struct Explore {
    pub walks: Walks,
    /// The basins, level by level, or why there are none.
    pub basins: Background<BasinsQuestion, Result<Level, String>>,
    pub spectra: Spectra,
}

/// A model, and the signal of its motion to analyse.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpectrumQuestion {
    model: SharedModel,
    signal: Signal,
}

impl Question for SpectrumQuestion {
    const NAME: &'static str = "spectrum";
    type Part = Result<SpectrumAnswer, String>;

    fn answer(&self, cancel: &AtomicBool, _: Each<Self::Part>) -> Option<Self::Part> {
        let (of, until_settled) = (self.signal, longest_wait(&self.model));
        let question = Spectrum { of, until_settled, ..Spectrum::default() };
        told(question.run(&self.model.simulation(), &progress(cancel)))
    }
}

pub struct Spectra {
    pub signal: Signal,
    /// The spectrum, or why there is none.
    pub found: Background<SpectrumQuestion, Result<SpectrumAnswer, String>>,
}

impl Default for Spectra {
    fn default() -> Self {
        Self { signal: Signal::Displacement, found: Background::default() }
    }
}

impl Session {
    /// Takes the studies over from a session on another step of a lesson, without the answers about other
    /// scenes: a view would show them as those of this one until its own come.
    pub fn keep_studies_of(&mut self, other: &mut Self) {
        let chosen = self.explore.walks.chosen.take();
        self.explore = std::mem::take(&mut other.explore);
        self.explore.walks.chosen = chosen;
        let (of, walk) = (ground(self.scene(), self.remembered_stops, &[]), self.walk_question().ok());
        let scene = self.scene().clone();
        let Explore { walks, basins, spectra } = &mut self.explore;
        if basins.question().is_some_and(|asked| *asked.of.of != of) {
            basins.clear();
        }
        if walks.found.question() != walk.as_ref() {
            walks.found.clear();
        }
        if spectra.found.question().is_some_and(|asked| *asked.model.scene() != scene) {
            spectra.found.clear();
        }
    }

    /// Asks for the spectrum of the present scene; to be called in every frame that shows it.
    pub fn want_spectrum(&mut self) {
        let (model, signal) = (self.model.clone(), self.explore.spectra.signal);
        let (question, still) = (SpectrumQuestion { model, signal }, self.stands_still());
        self.explore.spectra.found.want(question, still, &self.wake);
    }
}

/// Stride of the coarse walks, which come first.
const COARSE: usize = 5;

/// The quantity that is drawn for each run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WalkQuantity {
    /// Displacements once a forcing period.
    Strobes,
    #[default]
    RmsVelocity,
    /// Mean power into the load of a transducer.
    LoadPower,
}

/// A scene, apart from its value of the field, and the axis over the field.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WalkQuestion {
    /// The scene, from rest, with the first value of the axis.
    #[serde(with = "crate::app::task::as_text")]
    pub scene: Scene,
    #[serde(with = "crate::app::task::as_text")]
    pub axis: SweepAxis,
    /// The scene, from rest, with its present value of the field.
    ground: Uncompared<Prepared>,
    /// The strides and directions of the walks, the coarse ones first.
    walks: Uncompared<Vec<(usize, Direction)>>,
}

impl Question for WalkQuestion {
    const NAME: &'static str = "walks";
    /// A run, with the stride of its walk.
    type Part = (usize, Visit);

    fn answer(&self, cancel: &AtomicBool, each: Each<Self::Part>) -> Option<Self::Part> {
        let Prepared { of, mechanism, .. } = &self.ground.0;
        let all = Axis::from_scene(&self.axis, of).ok()?.values;
        for stride in [COARSE, 1] {
            let values: Vec<f64> = all.iter().step_by(stride).copied().collect();
            let of_stride = self.walks.0.iter().filter(|walk| walk.0 == stride);
            let directions: Vec<Direction> = of_stride.map(|walk| walk.1).collect();
            let (over, each) = ((&*self.axis.field, &*values), |visit| each((stride, visit)));
            walks(&of.document(), mechanism, over, &directions, &progress(cancel), &each).ok()?;
        }
        None
    }

    #[cfg(any(test, target_arch = "wasm32"))]
    fn divide(&self, count: usize) -> Vec<Self> {
        let count = count.min(self.walks.0.len());
        let part = |first: usize| {
            let walks = self.walks.0.iter().skip(first).step_by(count).copied().collect();
            Self { walks: Uncompared(walks), ..self.clone() }
        };
        (0..count).map(part).collect()
    }
}

#[derive(Default)]
pub struct Walks {
    /// The axis that the user has chosen; `None` for an axis around the present value.
    pub chosen: Option<SweepAxis>,
    pub quantity: WalkQuantity,
    /// The runs as they come, each with the stride of its walk.
    pub found: Background<WalkQuestion, (usize, Visit)>,
}

impl Session {
    /// The axis of the walks: the chosen one if the scene has its field, else one over the amplitude of the
    /// shaking, else over the first field that a map could have. Returns `None` if there is no such field.
    pub fn walk_axis(&self) -> Option<SweepAxis> {
        let chosen = self.explore.walks.chosen.as_ref();
        if let Some(chosen) = chosen.filter(|axis| self.has_fields_of(std::slice::from_ref(axis))) {
            return Some(chosen.clone());
        }
        let known = self.map_fields();
        let path = known.iter().find(|path| is_amplitude(path)).or(known.first())?;
        Some(self.map_axis(path))
    }

    /// Asks for the walks of the present scene, or says why there are none; to be called in every frame that
    /// shows them.
    pub fn want_walks(&mut self) -> Result<(), String> {
        let (still, question) = (self.stands_still(), self.walk_question()?);
        self.explore.walks.found.want(question, still, &self.wake);
        Ok(())
    }

    pub(in crate::app) fn walk_question(&self) -> Result<WalkQuestion, String> {
        let axis = self.walk_axis().ok_or("This scene has no field to walk over.")?;
        let ground = ground(self.scene(), self.remembered_stops, std::slice::from_ref(&axis));
        Axis::from_scene(&axis, &ground).map_err(|(part, problem)| format!("{part}: {problem}"))?;
        if !self.model().repeats() {
            return Err("Each run continues the one before, from phase 0 of the drive, which needs a drive \
                        that repeats, such as a sine."
                .into());
        }
        let mut scene = ground.clone();
        let is_set = FieldPath::new(&axis.field).set(&mut scene, axis.from);
        debug_assert!(is_set, "the axis is over a field of the scene");
        let ground = Uncompared(self.prepared(ground));
        // coarse steps can lead to another motion, which would contradict the answer of a lesson
        let strides = if self.is_lesson { &[1][..] } else { &[COARSE, 1] };
        let walks = strides.iter().flat_map(|stride| Direction::ALL.map(|way| (*stride, way)));
        Ok(WalkQuestion { scene, axis, ground, walks: Uncompared(walks.collect()) })
    }

    /// Sets the field of the walks to a value, as part of a gesture.
    pub fn drag_along_walk(&mut self, value: f64) {
        let Some(axis) = self.walk_axis() else { return };
        let value = ((value / axis.step).round() * axis.step).clamp(axis.from, axis.to);
        // a value that is refused is reported where the scene is checked
        let _ = self.set_number(&axis.field, decimal(value));
    }
}

/// Number of starts of the basins along each axis.
pub const STARTS: u64 = 81;

/// A scene, apart from its start, and the ranges of the starts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BasinsQuestion {
    pub of: Prepared,
    /// Least and greatest displacement in mm.
    pub x_mm: (f64, f64),
    /// Least and greatest velocity in m/s.
    pub v: (f64, f64),
    /// Number of starts along each axis.
    pub(super) starts: u64,
}

impl Question for BasinsQuestion {
    const NAME: &'static str = "basins";
    type Part = Result<Level, String>;

    fn answer(&self, cancel: &AtomicBool, each: Each<Self::Part>) -> Option<Self::Part> {
        told(self.levels(cancel, &|level| each(Ok(level))))
    }
}

impl BasinsQuestion {
    /// The levels, of which the last is returned.
    fn levels(&self, cancel: &AtomicBool, each: &(dyn Fn(Level) + Sync)) -> Result<Level, Error> {
        let range = |(from, to): (f64, f64)| (from, to, self.starts);
        let question = Basins::of(range(self.x_mm), range(self.v));
        let Prepared { of, mechanism, .. } = &self.of;
        let begun = question.begin(&of.document(), mechanism)?.checked();
        let per_speed = suited_unit("m/s", [self.v.0, self.v.1].into_iter()).0;
        let level = |basins: &_, answer: Answer| Level {
            chart: basins_chart(basins, &answer),
            per_speed,
            answer,
            room: basins.room(),
        };
        let coarse = |basins: &_, answer| each(level(basins, answer));
        let BasinsAnswer { basins, answer } = Basins::followed(begun, &progress(cancel), Some(&coarse))?;
        Ok(level(&basins, answer))
    }
}

/// What is known of the basins after one level of starts has been run.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Level {
    /// The attractors, and the attractor that each start goes to.
    pub answer: Answer,
    /// Their picture, in which a start that has not been run shows the answer of a neighbour.
    pub chart: Chart,
    /// 1 m/s in the unit of the chart's velocities.
    pub per_speed: f64,
    /// Range of displacements in m that the mass may have.
    pub room: (f64, f64),
}

impl Session {
    /// Asks for the basins of the present scene over a range of displacements in m and of velocities `v` in
    /// m/s; to be called in every frame that shows them.
    pub fn want_basins(&mut self, (low, high): (f64, f64), v: (f64, f64)) {
        let still = self.stands_still();
        let scene = ground(self.scene(), self.remembered_stops, &[]);
        let (of, x_mm) = (self.prepared(scene), (low * 1e3, high * 1e3));
        self.explore.basins.want(BasinsQuestion { of, x_mm, v, starts: STARTS }, still, &self.wake);
    }

    /// Starts the scene at a displacement in m and a velocity in m/s, from now on, as one undo step.
    pub fn start_at(&mut self, x: f64, v: f64) {
        let rounded = |value: f64, unit: f64| decimal((value / unit).round() * unit);
        let (x_mm, v_m_per_s) = (rounded(x * 1e3, 1e-3), rounded(v, 1e-4));
        if self.edit_once(|scene| scene.start = Start::At { x_mm, v_m_per_s, electrical: 0.0 }) {
            self.apply();
            self.restart();
        }
    }
}
