//! Batch: motions in groups by the degree of their force, and the steps that a group takes together.

use std::collections::VecDeque;

use super::columns::{Columns, LaneMotion};
use super::trial::Trial;
use crate::dynamics::drive::form::clock;
use crate::dynamics::drive::tone::Sine;
use crate::dynamics::equation::Equation;
use crate::dynamics::model::Model;
use crate::dynamics::motion::Motion;
use crate::dynamics::result::{Outcome, Pursuit, Request};
use crate::dynamics::series::{Integrals, SEEDED, Series};
use crate::dynamics::state::Contact;
use crate::dynamics::step::stepper::Step;
use crate::numeric::{GaussLegendre, Lanes};
use crate::system::threads::UnderWay;

/// Steps of a group between two checks of the budget and the cancel flag.
const BATCH_STEPS: u64 = 256;

/// Maximum number of motions under way at a time, in widths of the batch: enough for one group to fill its
/// lanes if the forces have two or three different degrees.
const MOTIONS_PER_LANE: usize = 4;

/// Below this number, motions are faster one after another: a step of all lanes takes as long as about five
/// single steps, no matter how many lanes are in use.
const MIN_MOTIONS: usize = 5;

/// A run and the data it needs.
pub(super) struct Prepared<'a> {
    pub model: &'a Model,
    pub request: &'a Request<'a>,
    pub equation: &'a Equation<f64>,
    pub drive: &'a Sine<f64>,
    pub pursuit: Option<&'a Pursuit<'a>>,
    pub place: usize,
}

/// Supplier of runs and receiver of their results.
pub(super) trait Source<'a> {
    /// The next run. `None` means that no run is available now; while no run is under way, it means that
    /// there will be no more.
    fn next(&mut self, under_way: UnderWay) -> Option<Prepared<'a>>;

    /// Takes a motion that has ended, and its outcome.
    fn ended(&mut self, run: &Prepared<'a>, motion: LaneMotion<'a>, outcome: Outcome);
}

/// A motion under way.
struct Member<'a> {
    /// Its number in order of start.
    index: usize,
    run: Prepared<'a>,
    motion: Box<LaneMotion<'a>>,
}

/// Motions of one order whose forces have the same degree at present.
struct Group<const W: usize> {
    order: usize,
    tolerance_log2: f64,
    rule: GaussLegendre<Lanes<W>>,
    columns: Box<Columns<W>>,
    series: Box<Series<Lanes<W>>>,
    trial: Box<Trial<W>>,
    lanes: [Option<usize>; W],
    /// Motions that wait for a lane, in order of arrival.
    waiting: VecDeque<usize>,
    rounds: u64,
}

impl<const W: usize> Group<W> {
    /// Number of motions whose next step is taken by this group.
    fn ready(&self) -> usize {
        self.lanes.iter().flatten().count() + self.waiting.len()
    }
}

pub(super) struct Batch<'a, 'r, const W: usize> {
    source: &'r mut dyn Source<'a>,
    /// Number of runs started so far.
    started: usize,
    members: Vec<Option<Member<'a>>>,
    free: Vec<usize>,
    groups: Vec<Group<W>>,
}

impl<'a, 'r, const W: usize> Batch<'a, 'r, W> {
    pub fn new(source: &'r mut dyn Source<'a>) -> Self {
        Self {
            source,
            started: 0,
            members: (0..MOTIONS_PER_LANE * W).map(|_| None).collect(),
            free: (0..MOTIONS_PER_LANE * W).rev().collect(),
            groups: Vec::new(),
        }
    }

    #[inline(always)]
    pub fn run(mut self) {
        while let Some(group) = self.fullest() {
            self.step(group);
        }
    }

    /// The group with the most motions ready for it, once it can fill its lanes or no more runs can be
    /// started. Returns `None` at the end. The last few motions are finished one by one.
    fn fullest(&mut self) -> Option<usize> {
        loop {
            let fullest = (0..self.groups.len()).max_by_key(|group| self.groups[*group].ready());
            let ready = fullest.map_or(0, |group| self.groups[group].ready());
            if ready >= W || !self.start_next(false) {
                if ready >= MIN_MOTIONS.min(W / 2) {
                    while ready >= W && self.under_way() < 2 * W && self.start_next(true) {}
                    return fullest;
                }
                self.finish_alone();
                if !self.start_next(false) {
                    return None;
                }
            }
        }
    }

    #[inline(never)] // called once per batch
    fn finish_alone(&mut self) {
        for group in 0..self.groups.len() {
            for lane in 0..W {
                if let Some((_, group, member)) = self.member(group, lane) {
                    group.columns.store(lane, &mut member.motion);
                    group.lanes[lane] = None;
                }
            }
            self.groups[group].waiting.clear();
        }
        for place in 0..self.members.len() {
            if let Some(member) = &mut self.members[place] {
                let outcome = member.motion.run_to_end();
                self.end(place, outcome);
            }
        }
    }

    fn under_way(&self) -> usize {
        self.members.len() - self.free.len()
    }

    /// Starts the next run; returns false if there is none, or no room. `full`: whether the lanes are full.
    fn start_next(&mut self, full: bool) -> bool {
        let Some(place) = self.free.last().copied() else { return false };
        let Some(run) = self.source.next(UnderWay { runs: self.under_way(), full }) else { return false };
        self.free.pop();
        let clock = clock(run.model, run.equation.unit);
        let (model, request) = (run.model, run.request);
        let motion = Motion::new(model, request, model.tolerance, run.equation, clock, run.drive);
        let mut motion = Box::new(match run.pursuit {
            Some(pursuit) => motion.pursuing(pursuit),
            None => motion.with_recurrence(model.recurrence),
        });
        motion.begin();
        self.members[place] = Some(Member { index: self.started, run, motion });
        self.started += 1;
        self.wait(place);
        true
    }

    fn end(&mut self, place: usize, outcome: Outcome) {
        if let Some(Member { run, motion, .. }) = self.members[place].take() {
            self.source.ended(&run, *motion, outcome);
            self.free.push(place);
        }
    }

    /// Puts a member in the queue of the group of its force, once its steps are event-free.
    fn wait(&mut self, place: usize) {
        if let Some(group) = self.prepare(place) {
            self.groups[group].waiting.push_back(place);
        }
    }

    /// Runs a motion alone until its steps are event-free. Returns the group of its force, or `None` if the
    /// motion has ended.
    fn prepare(&mut self, place: usize) -> Option<usize> {
        while let Some(member) = &mut self.members[place] {
            let left = match member.motion.left() {
                Ok(left) => left,
                Err(outcome) => {
                    self.end(place, outcome);
                    continue;
                }
            };
            let motion = &mut member.motion;
            if motion.state.contact == Contact::Free
                && motion.stepper.flies_freely(&motion.state)
                && motion.has_budget_for(4 * BATCH_STEPS)
            {
                let force = &motion.stepper.mode(&motion.state).force;
                let settings = &motion.stepper.settings;
                let (order, tolerance_log2) = (settings.order, settings.tolerance_log2);
                let alike = |group: &Group<W>| {
                    group.columns.accepts(force)
                        && (group.order, group.tolerance_log2) == (order, tolerance_log2)
                };
                let found = self.groups.iter().position(alike);
                return Some(found.unwrap_or_else(|| {
                    self.groups.push(Group {
                        order,
                        tolerance_log2,
                        rule: motion.record.rule_of_steps().map(|value| Lanes([value; W])),
                        columns: Box::new(Columns::new(force)),
                        series: Box::new(Series::new(force.degree())),
                        trial: Box::new(Trial::new()),
                        lanes: [None; W],
                        waiting: VecDeque::new(),
                        rounds: 0,
                    });
                    self.groups.len() - 1
                }));
            }
            if let Some(outcome) = motion.proceed(left).or_else(|| motion.spent()) {
                self.end(place, outcome);
            }
        }
        None
    }

    /// Steps a group until it has fewer motions than lanes; at least once.
    #[inline(always)]
    fn step(&mut self, group: usize) {
        loop {
            self.fill(group);
            let Group { columns, series, trial, rounds, order, tolerance_log2, rule, .. } =
                &mut self.groups[group];
            loop {
                columns.step(series, rule, *order, *tolerance_log2, trial);
                *rounds += 1;
                let logs = (0..W).any(|lane| trial.taken[lane] & columns.logged[lane]);
                let leaves = trial.stopped.contains(&true) | trial.passed.contains(&true);
                if logs || leaves || *rounds % BATCH_STEPS == 0 {
                    break;
                }
            }
            let check = *rounds % BATCH_STEPS == 0;
            for lane in 0..W {
                let Group { columns, trial, .. } = &self.groups[group];
                if trial.taken[lane] & columns.logged[lane] {
                    self.log_step(group, lane);
                } else if trial.passed[lane] {
                    self.enter_neighbour(group, lane);
                } else if trial.stopped[lane] {
                    self.store(group, lane);
                }
            }
            if check {
                self.check_budgets(group);
            }
            if self.groups[group].ready() < W {
                return;
            }
        }
    }

    fn fill(&mut self, group: usize) {
        for lane in 0..W {
            if self.groups[group].lanes[lane].is_none() {
                let Some(place) = self.groups[group].waiting.pop_front() else { return };
                self.load(group, lane, place);
            }
        }
    }

    /// The motion of a lane, if it holds one.
    fn member(&mut self, group: usize, lane: usize) -> Option<(usize, &mut Group<W>, &mut Member<'a>)> {
        let group = &mut self.groups[group];
        let place = group.lanes[lane]?;
        let member = self.members[place].as_mut()?;
        Some((place, group, member))
    }

    /// Stores a lane back to its motion, which takes the step with a possible event alone; loads it again if
    /// it stays in the group.
    fn store(&mut self, group: usize, lane: usize) {
        let Some((place, current, member)) = self.member(group, lane) else { return };
        let trial = &current.trial;
        let motion = &mut member.motion;
        current.lanes[lane] = None;
        current.columns.store(lane, motion);
        let left = motion.stepper.clock.between(&motion.state.at, &motion.stepper.end);
        let flow = if trial.holds[lane] && trial.length.0[lane] < left {
            copy_lane(&current.series, lane, current.order, &mut motion.stepper.series);
            let single = &mut motion.stepper.series;
            let measured =
                Integrals { until: trial.length.0[lane], squared: trial.squared.0[lane], work: 0.0 };
            single.measured.set(trial.measured[lane].then_some(measured));
            motion.stepper.evaluations += 1;
            let unit = (trial.unit.0.0[lane], trial.unit.1.0[lane]);
            motion.stepper.cursor = Some((trial.at.get(lane), unit));
            motion.take(&Step { length: trial.length.0[lane], arrival: None, end: trial.end(lane) })
        } else {
            motion.fly(left)
        };
        if let Some(outcome) = flow.or_else(|| motion.spent()) {
            self.end(place, outcome);
        }
        match self.prepare(place) {
            Some(other) if other == group => self.load(group, lane, place),
            Some(other) => self.groups[other].waiting.push_back(place),
            None => {}
        }
    }

    /// Moves the motion of a lane, which stands on a break, into the neighbouring mode.
    fn enter_neighbour(&mut self, group: usize, lane: usize) {
        let Some((place, group, member)) = self.member(group, lane) else { return };
        if !group.columns.enter_neighbour(lane, &member.run.equation.modes) {
            group.lanes[lane] = None;
            group.columns.store(lane, &mut member.motion);
            let exit = group.columns.exit(lane);
            member.motion.enter_neighbour(exit);
            self.wait(place);
        }
    }

    fn load(&mut self, group: usize, lane: usize, place: usize) {
        if let Some(member) = &self.members[place] {
            self.groups[group].columns.load(lane, member.index, &member.motion);
            self.groups[group].lanes[lane] = Some(place);
        }
    }

    fn log_step(&mut self, group: usize, lane: usize) {
        let Some((_, group, member)) = self.member(group, lane) else { return };
        let trial = &group.trial;
        let motion = &mut member.motion;
        copy_lane(&group.series, lane, group.order, &mut motion.stepper.series);
        let mode = motion.stepper.mode(&motion.state);
        let (length, end) = (trial.length.0[lane], trial.end(lane));
        let state = (end.y + mode.origin, end.v);
        let step = motion.stepper.step_data(&motion.state, (length, length, length), end.bound, state);
        if let Some(log) = &mut motion.log {
            log.add_step(&motion.stepper.series, &step);
        }
        group.columns.copy_state(lane, motion);
        motion.mark();
        group.columns.logged[lane] = motion.log.is_some();
    }

    fn check_budgets(&mut self, group: usize) {
        for lane in 0..W {
            let Some((place, group, member)) = self.member(group, lane) else { continue };
            let motion = &mut member.motion;
            group.lanes[lane] = None;
            group.columns.store(lane, motion);
            if motion.stepper.work.is_cancelled() {
                let outcome = Outcome::Cancelled { at: motion.stepper.clock.seconds(&motion.state.at) };
                self.end(place, outcome);
            } else {
                self.wait(place);
            }
        }
    }
}

fn copy_lane<const W: usize>(all: &Series<Lanes<W>>, lane: usize, order: usize, single: &mut Series<f64>) {
    for k in 0..=order {
        single.y[k] = all.y[k].0[lane];
    }
    for k in 0..(order - 1).max(SEEDED) {
        single.a[k] = all.a[k].0[lane];
    }
    single.known = order + 1;
}
