//! Result of a map of basins: attractors, in the order of the first start of each, and rows.

use serde::{Deserialize, Serialize};

use super::BasinMap;
use super::rounds::{Fate, Kind};
use super::stroboscopic::final_state;
use crate::dynamics::{MapState, Model, Outcome, Place, Regime, Request, Summary};
use crate::numeric::decimals;
use crate::study::{ColumnOf, State, Table, Task, column};

/// Quantile of the normal distribution for a two-sided 95 % interval.
const NORMAL_95: f64 = 1.959_963_984_540_054;

/// Number of forcing periods over which an attractor is described: twice the longest recognised period.
const WINDOW: u32 = 24;

/// Difference that distinguishes two attractors: of their RMS velocities as a share of these, or of their
/// mean displacements as a share of the reach.
const MIN_DIFFERENCE: f64 = 0.02;

/// A share with its 95 % confidence interval (Wilson 1927).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Shares {
    /// The share.
    pub share: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Shares {
    /// The share `some` / `all`; `all` must be at least 1.
    pub fn of(some: u64, all: u64) -> Self {
        let (n, share, square) = (all as f64, some as f64 / all as f64, NORMAL_95 * NORMAL_95);
        let middle = (share + square / (2.0 * n)) / (1.0 + square / n);
        let half =
            NORMAL_95 / (1.0 + square / n) * (share * (1.0 - share) / n + square / (4.0 * n * n)).sqrt();
        Self { share, low: (middle - half).clamp(0.0, share), high: (middle + half).clamp(share, 1.0) }
    }
}

/// One attractor.
///
/// It is a motion that settles, at rest or periodic, or an irregular motion; two motions that mirror each
/// other are two attractors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Attractor {
    /// The regime of the motion.
    pub regime: Regime,
    /// Its period in forcing periods, if it moves and repeats.
    pub period: Option<u32>,
    /// Its side of the barrier, if there is one.
    pub side: Option<Place>,
    /// Its RMS velocity in m/s.
    pub rms_velocity: Option<f64>,
    /// The mean of its displacement in m.
    pub mean_x: Option<f64>,
    /// Its largest distance from the middle in m.
    pub reach: Option<f64>,
    /// Its states in m and m/s at the phase of the drive at which motions start: one per forcing period of
    /// its period, or a single one without a period.
    pub states: Vec<(f64, f64)>,
    /// The number of starts that go to it.
    pub starts: u64,
    /// Their share of all starts between the limits of displacement.
    pub share: Shares,
}

impl Attractor {
    /// A text with its regime and side, and with its period unless that is one forcing period.
    fn kind(&self) -> String {
        let mut words = match self.regime.name() {
            "" => "one well",
            name => name,
        }
        .to_owned();
        if let Some(side) = self.side.map(Place::name).filter(|side| *side != Place::Both.name()) {
            words += &format!(" {side}");
        }
        match (self.period, self.regime) {
            (Some(1), _) => {}
            (Some(period), _) => words += &format!(", period {period}"),
            (None, Regime::Intrawell | Regime::Interwell) => words += ", irregular",
            (None, _) => {}
        }
        words
    }

    /// Whether the means of the displacement differ by more than a small share of the reach.
    fn has_other_mean(&self, other: &Self) -> bool {
        let apart = |a: f64, b: f64| (a - b).abs() > MIN_DIFFERENCE * self.reach.unwrap_or(f64::INFINITY);
        self.mean_x.zip(other.mean_x).is_some_and(|(a, b)| apart(a, b))
    }
}

/// Results of a map of basins so far; [`BasinsAnswer`](crate::questions::BasinsAnswer) has both its tables.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// The attractors in the order of their numbers, which begin at 1.
    pub attractors: Vec<Attractor>,
    /// For each start the number of its attractor and the forcing periods that it took to get there; `None`
    /// if it has not been run, lies outside the limits, or reaches no attractor.
    pub rows: Vec<Option<(u32, u32)>>,
    /// Number of starts outside the limits of displacement.
    pub outside: u64,
    /// Whether the answer of each row is [sure](crate::questions::Basins); empty if it was not checked.
    pub sure: Vec<bool>,
    /// Number of starts whose run ended early.
    pub lost: u64,
    /// Number of those that used up the work allowed for one start.
    pub spent: u64,
    /// Number of starts whose attractor is not known.
    pub undecided: u64,
}

impl Answer {
    /// The rows from `begin` to before `end`.
    pub fn table(&self, basins: &BasinMap, begin: usize, end: usize) -> Table {
        let row = |row: usize| {
            let found = self.rows[row];
            StartRow {
                start: basins.starts().at(row),
                found,
                sure: found.and_then(|_| self.sure.get(row).copied()),
            }
        };
        let rows: Vec<StartRow> = (begin..end.min(self.rows.len())).map(row).collect();
        Table::new().with_columns(&start_columns(), &rows)
    }

    /// A distinct description of each attractor: regime, side and period and, if another one has the same,
    /// its RMS velocity, its mean displacement, or its displacement at the beginning of a period.
    pub fn words(&self) -> Vec<String> {
        let speed = |attractor: &Attractor| attractor.rms_velocity.unwrap_or(0.0);
        let three = |value: f64| format!("{value:.0$}", decimals(value.abs(), 3));
        let words = |attractor: &Attractor| {
            let kind = attractor.kind();
            let is_other = |other: &&Attractor| !std::ptr::eq(*other, attractor) && other.kind() == kind;
            let others: Vec<&Attractor> = self.attractors.iter().filter(is_other).collect();
            let velocity = speed(attractor);
            let differs = |other: &&Attractor| (speed(other) - velocity).abs() > MIN_DIFFERENCE * velocity;
            let mm = |x: f64| format!("{} mm", three(1e3 * x).replace('-', "\u{2212}"));
            match attractor.mean_x {
                _ if others.is_empty() => kind,
                _ if others.iter().all(differs) => format!("{kind}, {} mm/s", three(1e3 * velocity)),
                Some(mean) if others.iter().all(|other| attractor.has_other_mean(other)) => {
                    format!("{kind}, on average at {}", mm(mean))
                }
                _ => format!("{kind}, at {} when a period begins", mm(attractor.states[0].0)),
            }
        };
        self.attractors.iter().map(words).collect()
    }

    /// Number of rows whose answer is not sure.
    pub fn unsure(&self) -> u64 {
        self.rows.iter().zip(&self.sure).filter(|(row, sure)| row.is_some() && !**sure).count() as u64
    }

    /// The attractors, one row each.
    pub fn attractors_table(&self) -> Table {
        let rows: Vec<(u64, &Attractor)> = (1..).zip(&self.attractors).collect();
        Table::new().with_columns(&attractor_columns(), &rows)
    }
}

/// What a row of a start is made of.
pub(super) struct StartRow {
    /// Displacement in mm and velocity in m/s.
    start: (f64, f64),
    /// The number of its attractor, and the periods until it was known.
    found: Option<(u32, u32)>,
    sure: Option<bool>,
}

/// The columns of the table of starts.
pub(super) fn start_columns() -> Vec<ColumnOf<'static, StartRow>> {
    vec![
        column("x_mm", "", |row: &StartRow| row.start.0),
        column(
            "v_m_per_s",
            "displacement and velocity at the start; a circuit begins in the `electrical` state of the \
             scene's start, at rest without one",
            |row: &StartRow| row.start.1,
        ),
        column(
            "attractor",
            "number of the attractor that it goes to: 1 is that of the first row that has one, and so on. \
             Empty: the start lies beyond a stop or outside the force curve, its run ended early, or it did \
             not settle within 1000 periods; the last line on standard error says how many of each",
            |row: &StartRow| row.found.map(|(number, _)| u64::from(number)),
        ),
        column(
            "periods",
            "forcing periods that it took, see below; without an excitation, periods of small oscillations \
             in the stiffest well",
            |row: &StartRow| row.found.map(|(_, periods)| u64::from(periods)),
        ),
        column(
            "sure",
            "`true` where the error of the integration cannot change the answer: a second run at a \
             thousandth of the tolerance stays within a tenth of the scene's scales of the first one up to \
             the attractor; `false` otherwise; empty without an attractor. The last line on standard error \
             says how many are not sure",
            |row: &StartRow| row.sure,
        ),
    ]
}

/// An attractor with its number, from 1.
type Numbered<'a> = (u64, &'a Attractor);

/// The columns of the table of attractors.
pub(super) fn attractor_columns<'a>() -> Vec<ColumnOf<'a, Numbered<'a>>> {
    vec![
        column("attractor", "", |row: &Numbered| Some(row.0)),
        column("regime", "", |row: &Numbered| row.1.regime.name()),
        column("period", "", |row: &Numbered| row.1.period.map(u64::from)),
        column("side", "", |row: &Numbered| row.1.side.map_or("", Place::name)),
        column("rms_velocity_m_per_s", "its number; the others as in a summary", |row: &Numbered| {
            row.1.rms_velocity
        }),
        column("x_m", "", |row: &Numbered| row.1.states[0].0),
        column(
            "v_m_per_s",
            "one of its states at time 0 of the drive; of several that with the largest displacement",
            |row: &Numbered| row.1.states[0].1,
        ),
        column("starts", "how many starts go to it", |row: &Numbered| Some(row.1.starts)),
        column("share", "their share of all starts that the mass has room for", |row: &Numbered| {
            row.1.share.share
        }),
        column("share_low", "", |row: &Numbered| row.1.share.low),
        column(
            "share_high",
            "its 95 % interval (Wilson 1927), as of starts drawn at random",
            |row: &Numbered| row.1.share.high,
        ),
    ]
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Key {
    Kind(u32),
    /// A cycle of releases, by the smallest of their indices.
    Cycle(u32),
}

impl BasinMap {
    /// The results so far; `None` if cancelled.
    pub fn answer(&self, task: &Task) -> Option<Answer> {
        let after: Vec<Option<(Key, u32)>> =
            (0..self.rounds.releases.len()).map(|place| self.after(place as u32)).collect();
        // each with the first row that goes to it and the number of such rows
        let mut keys: Vec<(Key, usize, u64)> = Vec::new();
        let (mut outside, mut lost, mut spent, mut undecided) = (0, 0, 0, 0);
        let mut rows = Vec::with_capacity(self.rounds.fates.len());
        for (row, fate) in self.rounds.fates.iter().enumerate() {
            let key = match *fate {
                Fate::Kind(kind, periods) => Some((Key::Kind(kind), periods)),
                Fate::Release(place, periods) => {
                    after[place as usize].map(|(key, more)| (key, periods.saturating_add(more)))
                }
                Fate::NotRun | Fate::Outside | Fate::Lost { .. } | Fate::Undecided => None,
            };
            let end = match *fate {
                Fate::Release(place, _) if key.is_none() => self.chain(place).1,
                other => other,
            };
            outside += u64::from(end == Fate::Outside);
            lost += u64::from(matches!(end, Fate::Lost { .. }));
            spent += u64::from(end == Fate::Lost { spent: true });
            undecided += u64::from(end == Fate::Undecided);
            rows.push(key.map(|(key, periods)| {
                let known = keys.iter().position(|(known, ..)| *known == key);
                let place = known.unwrap_or_else(|| {
                    keys.push((key, row, 0));
                    keys.len() - 1
                });
                keys[place].2 += 1;
                (place as u32 + 1, periods)
            }));
        }
        let run = self.rounds.fates.iter().filter(|fate| **fate != Fate::NotRun).count() as u64;
        let inside = (run - outside).max(1);
        let mut attractors = Vec::with_capacity(keys.len());
        for (key, row, starts) in keys {
            let settled = rows[row].map_or(0, |(_, periods)| periods);
            let (summary, states) = self.describe(key, row, settled, task)?;
            attractors.push(Attractor {
                regime: summary.regime,
                period: summary.period,
                side: summary.side,
                rms_velocity: summary.rms_velocity,
                mean_x: summary.mean_x,
                reach: summary.max_abs_x,
                states,
                starts,
                share: Shares::of(starts, inside),
            });
        }
        Some(Answer { attractors, rows, sure: self.sure(), outside, lost, spent, undecided })
    }

    /// The sequence of releases from `release` on, each with the forcing periods up to it, and the fate that
    /// ends it: none of them, or one once more.
    pub(super) fn chain(&self, release: u32) -> (Vec<(u32, u32)>, Fate) {
        let (mut passed, mut at, mut periods) = (Vec::new(), release, 0_u32);
        loop {
            if passed.iter().any(|(known, _): &(u32, u32)| *known == at) {
                return (passed, Fate::Release(at, periods));
            }
            passed.push((at, periods));
            match self.rounds.releases[at as usize].next {
                Fate::Release(next, more) => (at, periods) = (next, periods.saturating_add(more)),
                other => return (passed, other),
            }
        }
    }

    /// The attractor reached after a release, and the number of forcing periods up to it.
    fn after(&self, release: u32) -> Option<(Key, u32)> {
        let (passed, end) = self.chain(release);
        match end {
            Fate::Kind(kind, more) => Some((Key::Kind(kind), passed.last()?.1.saturating_add(more))),
            Fate::Release(again, _) => {
                let begin = passed.iter().position(|(known, _)| *known == again)?;
                let least = passed[begin..].iter().map(|(known, _)| *known).min()?;
                Some((Key::Cycle(least), passed[begin].1))
            }
            _ => None,
        }
    }

    /// The summary and the states of an attractor, from a run that begins in a state of the orbit or, without
    /// one, at the start `row`, which settles after `settled` periods.
    fn describe(&self, key: Key, row: usize, settled: u32, task: &Task) -> Option<(Summary, Vec<State>)> {
        let period = self.model.forcing_period().unwrap_or(1.0);
        let (x_mm, v) = self.starts.at(row);
        let electrical = self.model.start_electrical();
        let (mut start, mut settle) = (MapState { x: x_mm / 1e3, v, electrical }, 0.0);
        match key {
            Key::Cycle(_) => settle = f64::from(settled) * period,
            Key::Kind(kind) => match &self.rounds.kinds[kind as usize] {
                (Kind::Orbit(orbit), _) => {
                    let first = self.rounds.orbit_of.iter().position(|number| number == orbit)?;
                    start = self.rounds.captures[first].state;
                }
                (Kind::Rest(side), _) => {
                    let x = self.model.stop(*side).map_or(start.x, |stop| stop.x);
                    start = MapState { x, v: 0.0, electrical };
                }
                (Kind::Judged(_), summary) => {
                    let summary = summary.as_ref()?;
                    return Some((**summary, vec![(summary.final_x, summary.final_v)]));
                }
            },
        }
        let window = self.model.with_start(start).with_duration(settle + f64::from(WINDOW) * period, settle);
        let summary =
            window.run(&Request { cancel: Some(task.cancel), ledger: true, ..Request::default() }).summary;
        task.check_cancelled().ok()?;
        let states = states(&self.model, final_state(&summary), summary.period.unwrap_or(1), period);
        (!task.is_cancelled()).then_some((summary, states))
    }
}

/// The states of a settled motion once a forcing period, beginning with the one farthest to the right.
fn states(model: &Model, state: MapState, count: u32, period: f64) -> Vec<State> {
    let times: Vec<f64> = (0..count).map(|number| f64::from(number) * period).collect();
    let request = Request { sample_times: &times, ..Request::default() };
    let run = model.with_start(state).with_duration(f64::from(count) * period, 0.0).run(&request);
    if run.summary.outcome != Outcome::Done || run.samples.len() != times.len() {
        return vec![(state.x, state.v)];
    }
    let mut states: Vec<State> = run.samples.iter().map(|sample| (sample.x, sample.v)).collect();
    let by_state = |a: &State, b: &State| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1));
    let first = (0..states.len()).max_by(|a, b| by_state(&states[*a], &states[*b])).unwrap_or(0);
    states.rotate_left(first);
    states
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_of_a_share_is_wilsons() {
        // Wilson 1927, with the 0.975 quantile: 81 of 263, as in Newcombe (1998), Table I
        let share = Shares::of(81, 263);
        assert!((share.low - 0.2553).abs() < 5e-5 && (share.high - 0.3662).abs() < 5e-5, "{share:?}");
        let none = Shares::of(0, 20);
        assert_eq!((none.share, none.low), (0.0, 0.0));
        assert!((none.high - 0.1611).abs() < 5e-5, "{none:?}");
        let all = Shares::of(20, 20);
        assert_eq!((all.share, all.high), (1.0, 1.0));
    }

    #[test]
    fn no_two_attractors_have_the_same_words() {
        let words = |all: &[(f64, f64)], mean_x: Option<f64>| {
            let attractor = |(rms, x): &(f64, f64)| Attractor {
                regime: Regime::Interwell,
                period: Some(1),
                side: None,
                rms_velocity: Some(*rms),
                mean_x: mean_x.map(|mean| mean * x.signum()),
                reach: Some(2e-3),
                states: vec![(*x, 0.0)],
                starts: 1,
                share: Shares::of(1, 2),
            };
            let attractors = all.iter().map(attractor).collect();
            let (rows, sure) = (Vec::new(), Vec::new());
            Answer { attractors, rows, outside: 0, sure, lost: 0, spent: 0, undecided: 0 }.words()
        };
        assert_eq!(words(&[(0.05, 0.0)], None), ["interwell"]);
        let faster = ["interwell, 50.0 mm/s", "interwell, 80.0 mm/s"];
        assert_eq!(words(&[(0.05, 0.0), (0.08, 0.0)], None), faster);
        let mirrored = [(0.05, -1.5e-3), (0.05, 1.5e-3)];
        let ends = words(&mirrored, Some(1e-5));
        assert!(ends[0].ends_with(", at \u{2212}1.50 mm when a period begins"), "{ends:?}");
        assert!(ends[1].ends_with(", at 1.50 mm when a period begins"), "{ends:?}");
        let means = ["interwell, on average at \u{2212}1.20 mm", "interwell, on average at 1.20 mm"];
        assert_eq!(words(&mirrored, Some(1.2e-3)), means);
    }
}
