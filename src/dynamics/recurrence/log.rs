//! What a motion did since it was let go, in the words in which the recorder was told.

use std::cell::Cell;

use super::super::clock::{Clock, Instant};
use super::super::motion::{Carried, Contact, Touch};
use super::super::path::{InTime, Path, StepView};
use super::super::record::Recorder;
use super::super::result::{Phase, Side};
use super::super::taylor;
use super::super::totals::Totals;
use super::Label;
use crate::numeric::{GaussLegendre, Scalar};

/// A motion of more entries than this is not kept: a cycle that long would hardly fit into a run twice.
const MOST_ENTRIES: usize = 1 << 15;

/// One thing that the recorder was told.
#[derive(Debug, Clone)]
pub(in super::super) enum Entry<T: Copy> {
    Step(Kept<T>),
    Stand { at: Instant<T>, until: Instant<T>, state: (T, T), phase: Phase },
    Impact { at: Instant<T>, side: Side, v_in: T, v_out: T },
    Chatter { at: Instant<T>, v: T },
    Rest { at: Instant<T>, side: Side },
    Release { at: Instant<T>, side: Side },
}

/// A step of flight; its coefficients lie in the log.
#[derive(Debug, Clone)]
pub(in super::super) struct Kept<T: Copy> {
    origin: T,
    at: Instant<T>,
    whole: T,
    length: T,
    bound: T,
    limits: (T, T),
    x: T,
    v: T,
    /// Where the coefficients begin, and how many are of the displacement and of the base.
    first: usize,
    known: usize,
    base: usize,
    /// Which of the log's integrals are those over all of it; a step and its mirror image share them.
    integrals: usize,
}

/// A kept step with its coefficients.
struct KeptPath<'a, T: Copy> {
    y: &'a [T],
    a: &'a [T],
    length: T,
    integrals: &'a Cell<Option<(T, T)>>,
}

impl<T: Scalar> InTime for KeptPath<'_, T> {
    type Number = T;

    fn coefficients(&self) -> &[T] {
        self.y
    }
    fn base_coefficients(&self) -> &[T] {
        self.a
    }
    fn integrals_in_time<const WORK: bool>(&self, rule: &GaussLegendre<T>, from: T, to: T) -> (T, T) {
        if from != T::zero() || to != self.length {
            return taylor::integrals::<T, WORK>(self.y, self.a, rule, from, to);
        }
        let known = self.integrals.get();
        let integrals = known.unwrap_or_else(|| taylor::integrals::<T, WORK>(self.y, self.a, rule, from, to));
        self.integrals.set(Some(integrals));
        integrals
    }
}

/// Where the motion stood before it went on by a step or a rest.
#[derive(Debug, Clone, Copy)]
struct Mark<T> {
    carried: Carried<T>,
    /// Entries before it.
    entries: usize,
}

/// Everything since the first labelled release.
#[derive(Debug, Clone)]
pub(in super::super) struct Log<T: Copy> {
    entries: Vec<Entry<T>>,
    coefficients: Vec<T>,
    /// Integrals over whole steps, once they have been taken.
    integrals: Vec<Cell<Option<(T, T)>>>,
    marks: Vec<Mark<T>>,
    /// The releases with a label: where they stand, and what the recorder had then.
    labels: Vec<(Label<T>, usize, Totals<T>)>,
}

/// Turns one cycle of a log into another: later by whole cycles of the clock.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Later(pub i64);

impl Later {
    fn instant<T: Scalar>(self, at: &Instant<T>) -> Instant<T> {
        Instant { cycle: at.cycle + self.0, phase: at.phase }
    }
}

impl<T: Scalar> Log<T> {
    pub fn new() -> Self {
        Self {
            entries: Vec::with_capacity(96),
            coefficients: Vec::with_capacity(1024),
            integrals: Vec::with_capacity(64),
            marks: Vec::with_capacity(64),
            labels: Vec::new(),
        }
    }

    /// Whether there is room for more.
    pub fn has_room(&self) -> bool {
        self.entries.len() < MOST_ENTRIES
    }

    pub fn add(&mut self, entry: Entry<T>) {
        self.entries.push(entry);
    }

    /// Keeps a step, where it is one in time.
    pub fn add_step<P: Path<T>>(&mut self, step: &StepView<T, P>) {
        let Some((y, a)) = step.path.in_time() else { return };
        let first = self.coefficients.len();
        self.coefficients.extend_from_slice(y);
        self.coefficients.extend_from_slice(a);
        self.entries.push(Entry::Step(Kept {
            origin: step.origin,
            at: step.at,
            whole: step.whole,
            length: step.length,
            bound: step.bound,
            limits: step.limits,
            x: step.x,
            v: step.v,
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
            .map_or(0, |mark| at.cycle - mark.carried.at.cycle)
    }

    pub fn mark(&mut self, carried: Carried<T>) {
        self.marks.push(Mark { carried, entries: self.entries.len() });
    }

    pub fn label(&mut self, label: Label<T>, totals: Totals<T>) {
        self.labels.push((label, self.marks.len(), totals));
    }

    /// The release among those kept that `wanted` says yes to: the index of its mark, and the totals of then.
    pub fn find(&self, wanted: impl Fn(&Label<T>) -> bool) -> Option<(usize, Totals<T>)> {
        self.labels.iter().find(|(label, ..)| wanted(label)).map(|(_, mark, totals)| (*mark, *totals))
    }

    /// Number of marks.
    pub fn marks(&self) -> usize {
        self.marks.len()
    }

    pub fn carried(&self, mark: usize) -> &Carried<T> {
        &self.marks[mark].carried
    }

    /// The last mark from `first` on that is not after `end` when it is `later`.
    pub fn last_before(&self, first: usize, later: Later, end: &Instant<T>, clock: &Clock<T>) -> usize {
        let reached = |mark: &Mark<T>| clock.between(&later.instant(&mark.carried.at), end) >= T::zero();
        first + self.marks[first + 1..].partition_point(reached)
    }

    /// The motion that was kept at a mark, `later`.
    pub fn carried_later(&self, mark: usize, later: Later) -> Carried<T> {
        let carried = self.marks[mark].carried;
        Carried { at: later.instant(&carried.at), refused: None, ..carried }
    }

    /// Tells the recorder once more what it was told between two marks (to the end without a second), `later`; how many
    /// entries those are.
    pub fn play<const LEDGER: bool>(
        &self,
        record: &mut Recorder<T, LEDGER>,
        (from, to): (usize, Option<usize>),
        later: Later,
        mut base: impl FnMut(&Instant<T>) -> f64,
    ) -> usize {
        let end = to.map_or(self.entries.len(), |mark| self.marks[mark].entries);
        let entries = &self.entries[self.marks[from].entries..end];
        for entry in entries {
            match entry {
                Entry::Step(step) => {
                    let (y, a) =
                        self.coefficients[step.first..][..step.known + step.base].split_at(step.known);
                    let view = StepView {
                        path: &KeptPath {
                            y,
                            a,
                            length: step.length,
                            integrals: &self.integrals[step.integrals],
                        },
                        origin: step.origin,
                        at: later.instant(&step.at),
                        whole: step.whole,
                        length: step.length,
                        duration: step.length,
                        bound: step.bound,
                        limits: step.limits,
                        x: step.x,
                        v: step.v,
                    };
                    record.step(&view, &mut base);
                }
                Entry::Stand { at, until, state, phase } => {
                    record.stand(&later.instant(at), &later.instant(until), *state, *phase, &mut base);
                }
                Entry::Impact { at, side, v_in, v_out } => {
                    record.impact(&later.instant(at), *side, *v_in, *v_out);
                }
                Entry::Chatter { at, v } => record.chatter_sum(&later.instant(at), *v),
                Entry::Rest { at, side } => record.rest(&later.instant(at), *side),
                Entry::Release { at, side } => record.release(&later.instant(at), *side),
            }
        }
        entries.len()
    }

    /// Appends the mirror image of everything from mark `first` on, later by half a cycle of the clock and `cycles`
    /// whole ones; `arenas` is their number.
    pub fn append_mirrored(&mut self, first: usize, cycles: i64, arenas: usize, clock: &Clock<T>) {
        let half = clock.period() * T::of(0.5);
        let instant = |at: &Instant<T>| {
            let at = clock.advance(at, half);
            Instant { cycle: at.cycle + cycles, phase: at.phase }
        };
        let minus = |value: T| T::zero() - value;
        let other = |phase: Phase| match phase {
            Phase::Free => Phase::Free,
            Phase::LeftStop => Phase::RightStop,
            Phase::RightStop => Phase::LeftStop,
        };
        let (entries, marks) = (self.entries.len(), self.marks.len());
        let from = self.marks[first].entries;
        for index in first..marks {
            let Mark { carried, entries: before } = self.marks[index];
            let contact = match carried.contact {
                Contact::Resting(end) => Contact::Resting(end.other()),
                contact => contact,
            };
            let touch = carried.touch.map(|touch| Touch { end: touch.end.other(), ..touch });
            self.marks.push(Mark {
                carried: Carried {
                    at: instant(&carried.at),
                    x: minus(carried.x),
                    v: minus(carried.v),
                    arena: arenas - 1 - carried.arena,
                    touch,
                    contact,
                    refused: None,
                    barrier_side: -carried.barrier_side,
                    ..carried
                },
                entries: before + entries - from,
            });
        }
        for index in from..entries {
            let mirrored = match self.entries[index].clone() {
                Entry::Step(step) => {
                    let first = self.coefficients.len();
                    for place in step.first..step.first + step.known + step.base {
                        self.coefficients.push(minus(self.coefficients[place]));
                    }
                    Entry::Step(Kept {
                        origin: minus(step.origin),
                        at: instant(&step.at),
                        limits: (minus(step.limits.1), minus(step.limits.0)),
                        x: minus(step.x),
                        v: minus(step.v),
                        first,
                        ..step
                    })
                }
                Entry::Stand { at, until, state: (x, v), phase } => Entry::Stand {
                    at: instant(&at),
                    until: instant(&until),
                    state: (minus(x), minus(v)),
                    phase: other(phase),
                },
                Entry::Impact { at, side, v_in, v_out } => Entry::Impact {
                    at: instant(&at),
                    side: side.other(),
                    v_in: minus(v_in),
                    v_out: minus(v_out),
                },
                Entry::Chatter { at, v } => Entry::Chatter { at: instant(&at), v },
                Entry::Rest { at, side } => Entry::Rest { at: instant(&at), side: side.other() },
                Entry::Release { at, side } => Entry::Release { at: instant(&at), side: side.other() },
            };
            self.entries.push(mirrored);
        }
    }
}
