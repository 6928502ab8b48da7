//! Log of the recorder calls since the first labelled release, kept for replay.

use std::cell::Cell;

use super::events::Call;
use super::laps::Totals;
use super::recorder::Recorder;
use crate::dynamics::clock::{Clock, Instant};
use crate::dynamics::series::{Integrals, Series};
use crate::dynamics::state::{Checkpoint, Label, MotionState};
use crate::dynamics::step::path::StepData;
use crate::numeric::Scalar;

/// Maximum number of entries of a log: a motion with more in a period would hardly repeat within a run.
const MAX_ENTRIES: usize = 1 << 15;

/// One recorder call, kept for replay.
#[derive(Debug, Clone)]
enum Entry<T: Copy> {
    Step(LoggedStep<T>),
    Call(Call<T>),
}

/// A step of flight; its coefficients lie in the log.
#[derive(Debug, Clone)]
struct LoggedStep<T: Copy> {
    data: StepData<T>,
    /// Index of its first coefficient in the log.
    first: usize,
    known: usize,
    base: usize,
    /// Index of its integrals in the log; a step and its mirror image share them.
    integrals: usize,
}

/// A checkpoint of the motion before a step or a rest.
#[derive(Debug, Clone, Copy)]
struct Mark<T> {
    point: Checkpoint<T>,
    entries: usize,
}

/// The recorder calls and checkpoints since the first labelled release.
#[derive(Debug, Clone)]
pub(crate) struct Log<T: Copy> {
    entries: Vec<Entry<T>>,
    coefficients: Vec<T>,
    /// Integrals over whole steps, once they have been computed.
    integrals: Vec<Cell<Option<Integrals<T>>>>,
    marks: Vec<Mark<T>>,
    /// The labelled releases: the label, the index of the mark, and the totals of the recorder at that time.
    labels: Vec<(Label<T>, usize, Totals<T>)>,
}

/// A shift in time by whole cycles of the clock.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CycleShift(pub i64);

impl CycleShift {
    fn instant<T: Scalar>(self, at: &Instant<T>) -> Instant<T> {
        Instant { cycle: at.cycle + self.0, phase: at.phase }
    }
}

impl<T: Scalar> Log<T> {
    pub fn new() -> Self {
        Self {
            entries: Vec::with_capacity(192),
            coefficients: Vec::with_capacity(2048),
            integrals: Vec::with_capacity(64),
            marks: Vec::with_capacity(128),
            labels: Vec::with_capacity(4),
        }
    }

    pub fn has_room(&self) -> bool {
        self.entries.len() < MAX_ENTRIES
    }

    pub fn add(&mut self, call: Call<T>) {
        self.entries.push(Entry::Call(call));
    }

    pub fn add_step(&mut self, series: &Series<T>, step: &StepData<T>) {
        let (y, a) = (series.coefficients(), series.base_coefficients());
        let first = self.coefficients.len();
        self.coefficients.extend_from_slice(y);
        self.coefficients.extend_from_slice(a);
        self.entries.push(Entry::Step(LoggedStep {
            data: *step,
            first,
            known: y.len(),
            base: a.len(),
            integrals: self.integrals.len(),
        }));
        self.integrals.push(Cell::new(None));
    }

    /// Cycles of the clock since the last labelled release.
    pub fn cycles_until(&self, at: &Instant<T>) -> i64 {
        self.labels
            .last()
            .and_then(|(_, mark, _)| self.marks.get(*mark))
            .map_or(0, |mark| at.cycle - mark.point.state.at.cycle)
    }

    pub fn mark(&mut self, point: Checkpoint<T>) {
        self.marks.push(Mark { point, entries: self.entries.len() });
    }

    pub fn label(&mut self, label: Label<T>, totals: Totals<T>) {
        self.labels.push((label, self.marks.len(), totals));
    }

    /// The first logged release that is `wanted`: the index of its mark, and the totals at that time.
    pub fn find(&self, wanted: impl Fn(&Label<T>) -> bool) -> Option<(usize, Totals<T>)> {
        self.labels.iter().find(|(label, ..)| wanted(label)).map(|(_, mark, totals)| (*mark, *totals))
    }

    pub fn marks(&self) -> usize {
        self.marks.len()
    }

    pub fn at(&self, mark: usize) -> Instant<T> {
        self.marks[mark].point.state.at
    }

    /// The last mark, `first` or a later one, that is not after `end` when shifted by `later`.
    pub fn last_before(&self, first: usize, later: CycleShift, end: &Instant<T>, clock: &Clock<T>) -> usize {
        let reached = |mark: &Mark<T>| clock.between(&later.instant(&mark.point.state.at), end) >= T::zero();
        first + self.marks[first + 1..].partition_point(reached)
    }

    pub fn point_later(&self, mark: usize, later: CycleShift) -> Checkpoint<T> {
        let Checkpoint { state, barrier_side } = self.marks[mark].point;
        let state = MotionState { at: later.instant(&state.at), failed_release: None, ..state };
        Checkpoint { state, barrier_side }
    }

    /// Replays the recorder calls between two marks (up to the end without a second one), shifted by `later`,
    /// in this segment of the drive, with each step in `series`. Returns the number of calls and of impacts.
    pub fn replay(
        &self,
        (record, series): (&mut Recorder<T>, &mut Series<T>),
        (from, to): (usize, Option<usize>),
        later: CycleShift,
        segment: usize,
    ) -> (usize, u64) {
        let mut impacts = 0;
        let end = to.map_or(self.entries.len(), |mark| self.marks[mark].entries);
        let entries = &self.entries[self.marks[from].entries..end];
        for entry in entries {
            match entry {
                Entry::Step(step) => {
                    let coefficients = &self.coefficients[step.first..][..step.known + step.base];
                    let (y, a) = coefficients.split_at(step.known);
                    series.y[..y.len()].copy_from_slice(y);
                    series.a[..a.len()].copy_from_slice(a);
                    series.known = y.len();
                    let integrals = &self.integrals[step.integrals];
                    series.measured.set(integrals.get());
                    let data = StepData { at: later.instant(&step.data.at), ..step.data };
                    record.step(&*series, None, &data, segment);
                    integrals.set(series.measured.get());
                }
                Entry::Call(call) => {
                    impacts += u64::from(matches!(call, Call::Impact { .. }));
                    record.report(&call.map_instants(|at| later.instant(at)), segment);
                }
            }
        }
        (entries.len(), impacts)
    }

    /// Appends the mirror image of everything from mark `first` on, delayed by half a cycle and `cycles`
    /// whole cycles of the clock; `modes` is the number of modes.
    pub fn append_mirrored(&mut self, first: usize, cycles: i64, modes: usize, clock: &Clock<T>) {
        let half = clock.period * T::of(0.5);
        let instant = |at: &Instant<T>| {
            let at = clock.advance(at, half);
            Instant { cycle: at.cycle + cycles, phase: at.phase }
        };
        let minus = |value: T| T::zero() - value;
        let (entries, marks) = (self.entries.len(), self.marks.len());
        let from = self.marks[first].entries;
        for index in first..marks {
            let Mark { point: Checkpoint { state, barrier_side }, entries: before } = self.marks[index];
            let state = MotionState { at: instant(&state.at), failed_release: None, ..state.mirrored(modes) };
            self.marks.push(Mark {
                point: Checkpoint { state, barrier_side: -barrier_side },
                entries: before + entries - from,
            });
        }
        for index in from..entries {
            let mirrored = match self.entries[index].clone() {
                Entry::Step(step) => {
                    let first = self.coefficients.len();
                    self.coefficients.extend_from_within(step.first..step.first + step.known + step.base);
                    self.coefficients[first..].iter_mut().for_each(|c| *c = minus(*c));
                    let StepData { origin, at, limits: (low, high), x, v, .. } = step.data;
                    let data = StepData {
                        origin: minus(origin),
                        at: instant(&at),
                        limits: (minus(high), minus(low)),
                        x: minus(x),
                        v: minus(v),
                        ..step.data
                    };
                    Entry::Step(LoggedStep { data, first, ..step })
                }
                Entry::Call(call) => Entry::Call(call.map_instants(instant).mirrored()),
            };
            self.entries.push(mirrored);
        }
    }
}
