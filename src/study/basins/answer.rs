//! Answer of a map of basins: its attractors, numbered by the first start that goes to each, and the rows.

use super::Basins;
use super::rounds::{Fate, Kind};
use crate::dynamics::{Model, Outcome, Place, Regime, Request, Side, Summary};
use crate::study::Task;
use crate::study::table::Table;

/// The quantile of the normal distribution that leaves 95 % within.
const NORMAL_95: f64 = 1.959_963_984_540_054;

/// Forcing periods of the window over which an attractor is described: two of the longest that is told.
const WINDOW: u32 = 24;

/// A share with its 95 % interval (Wilson 1927).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shares {
    /// The share.
    pub share: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Shares {
    /// Of `some` out of `all`, of which there is one at least.
    pub fn of(some: u64, all: u64) -> Self {
        let (n, share, square) = (all as f64, some as f64 / all as f64, NORMAL_95 * NORMAL_95);
        let middle = (share + square / (2.0 * n)) / (1.0 + square / n);
        let half =
            NORMAL_95 / (1.0 + square / n) * (share * (1.0 - share) / n + square / (4.0 * n * n)).sqrt();
        Self { share, low: (middle - half).clamp(0.0, share), high: (middle + half).clamp(share, 1.0) }
    }
}

/// One attractor.
#[derive(Debug, Clone, PartialEq)]
pub struct Attractor {
    /// What the motion is.
    pub regime: Regime,
    /// Its period in forcing periods, where it moves and repeats.
    pub period: Option<u32>,
    /// On which side of the barrier it is, where there is one.
    pub side: Option<Place>,
    /// Its RMS velocity in m/s.
    pub rms_velocity: Option<f64>,
    /// Its states once a period at the starts' phase of the drive, in m and m/s: as many as it has periods,
    /// else one.
    pub states: Vec<(f64, f64)>,
    /// The number of starts that go to it.
    pub starts: u64,
    /// Their share of all that lie in the room of the mass.
    pub share: Shares,
}

impl Attractor {
    /// Its regime, side and period in words.
    pub fn words(&self) -> String {
        let mut words = match self.regime.name() {
            "" => "one well",
            name => name,
        }
        .to_owned();
        if let Some(side) = self.side.map(Place::name).filter(|side| *side != Place::Both.name()) {
            words += &format!(" {side}");
        }
        if let Some(period) = self.period {
            words += &format!(", period {period}");
        } else if self.regime == Regime::Intrawell {
            words += ", no period";
        }
        words
    }
}

/// What a map of basins has come to so far.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The attractors, the one numbered 1 first.
    pub attractors: Vec<Attractor>,
    /// For each start the number of its attractor and the periods that it took; none where it has not been
    /// run, lies outside the room, or goes to none.
    pub rows: Vec<Option<(u32, u32)>>,
    /// Starts outside the room of the mass.
    pub outside: u64,
    /// Starts whose run ended early.
    pub lost: u64,
    /// Starts of which it is not known where they go.
    pub undecided: u64,
}

impl Answer {
    /// `x_mm,v_m_per_s,attractor,periods` of the rows from `begin` to before `end`.
    pub fn table(&self, basins: &Basins, begin: usize, end: usize) -> Table {
        let rows: Vec<usize> = (begin..end.min(self.rows.len())).collect();
        Table::new()
            .each("x_mm", &rows, |row| basins.starts().at(*row).0)
            .each("v_m_per_s", &rows, |row| basins.starts().at(*row).1)
            .each("attractor", &rows, |row| self.rows[*row].map(|own| u64::from(own.0)))
            .each("periods", &rows, |row| self.rows[*row].map(|own| u64::from(own.1)))
    }

    /// The attractors, a row each.
    pub fn attractors_table(&self) -> Table {
        let all = &self.attractors;
        let numbers: Vec<u64> = (1..=all.len() as u64).collect();
        Table::new()
            .each("attractor", &numbers, |own| Some(*own))
            .each("regime", all, |own| own.regime.name())
            .each("period", all, |own| own.period.map(u64::from))
            .each("side", all, |own| own.side.map_or("", Place::name))
            .each("rms_velocity_m_per_s", all, |own| own.rms_velocity.unwrap_or(f64::NAN))
            .each("x_m", all, |own| own.states[0].0)
            .each("v_m_per_s", all, |own| own.states[0].1)
            .each("starts", all, |own| Some(own.starts))
            .each("share", all, |own| own.share.share)
            .each("share_low", all, |own| own.share.low)
            .each("share_high", all, |own| own.share.high)
    }
}

/// What an attractor is told by.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Key {
    Kind(u32),
    /// The cycle of releases that holds this one, the least of them.
    Cycle(u32),
}

impl Basins {
    /// What is known so far; none where it was cancelled.
    pub fn answer(&self, task: &Task) -> Option<Answer> {
        let after: Vec<Option<(Key, u32)>> =
            (0..self.rounds.releases.len()).map(|place| self.after(place as u32)).collect();
        let (mut keys, mut counts): (Vec<(Key, usize)>, Vec<u64>) = (Vec::new(), Vec::new());
        let (mut outside, mut lost, mut undecided) = (0, 0, 0);
        let mut rows = Vec::with_capacity(self.rounds.fates.len());
        for (row, fate) in self.rounds.fates.iter().enumerate() {
            let key = match *fate {
                Fate::Kind(kind, periods) => Some((Key::Kind(kind), periods)),
                Fate::Release(place, periods) => {
                    after[place as usize].map(|(key, more)| (key, periods + more))
                }
                Fate::NotRun | Fate::Outside | Fate::Lost | Fate::Undecided => None,
            };
            outside += u64::from(*fate == Fate::Outside);
            undecided += u64::from(*fate == Fate::Undecided);
            lost += u64::from(*fate == Fate::Lost);
            if let Fate::Release(place, _) = *fate
                && key.is_none()
            {
                match self.end_after(place) {
                    Fate::Lost => lost += 1,
                    _ => undecided += 1,
                }
            }
            rows.push(key.map(|(key, periods)| {
                let known = keys.iter().position(|own| own.0 == key);
                let place = known.unwrap_or_else(|| {
                    keys.push((key, row));
                    counts.push(0);
                    keys.len() - 1
                });
                counts[place] += 1;
                (place as u32 + 1, periods)
            }));
        }
        let run = self.rounds.fates.iter().filter(|fate| **fate != Fate::NotRun).count() as u64;
        let inside = (run - outside).max(1);
        let mut attractors = Vec::with_capacity(keys.len());
        for ((key, row), starts) in keys.into_iter().zip(counts) {
            let settled = rows[row].map_or(0, |own| own.1);
            let (summary, states) = self.describe(key, (row, settled), task)?;
            attractors.push(Attractor {
                regime: summary.regime,
                period: summary.period,
                side: summary.side,
                rms_velocity: summary.rms_velocity,
                states,
                starts,
                share: Shares::of(starts, inside),
            });
        }
        Some(Answer { attractors, rows, outside, lost, undecided })
    }

    /// The fates that follow each other from a release on, its own first, up to one that is no release or has
    /// been passed.
    fn chain(&self, release: u32) -> (Vec<(u32, u32)>, Fate) {
        let (mut passed, mut at, mut periods) = (Vec::new(), release, 0);
        loop {
            if passed.iter().any(|own: &(u32, u32)| own.0 == at) {
                return (passed, Fate::Release(at, periods));
            }
            passed.push((at, periods));
            match self.rounds.releases[at as usize].next {
                Fate::Release(next, more) => (at, periods) = (next, periods + more),
                other => return (passed, other),
            }
        }
    }

    /// What follows a release, and after how many periods.
    fn after(&self, release: u32) -> Option<(Key, u32)> {
        let (passed, end) = self.chain(release);
        match end {
            Fate::Kind(kind, more) => Some((Key::Kind(kind), passed.last().map_or(0, |last| last.1) + more)),
            Fate::Release(again, _) => {
                let begin = passed.iter().position(|own| own.0 == again)?;
                let least = passed[begin..].iter().map(|own| own.0).min()?;
                Some((Key::Cycle(least), passed[begin].1))
            }
            _ => None,
        }
    }

    /// How the motion ends that follows a release and goes to no attractor.
    fn end_after(&self, release: u32) -> Fate {
        self.chain(release).1
    }

    /// The summary of an attractor, and its states: of an orbit from one of them, else from the start `row`,
    /// which takes so many periods.
    fn describe(
        &self,
        key: Key,
        (row, settled): (usize, u32),
        task: &Task,
    ) -> Option<(Summary, Vec<(f64, f64)>)> {
        let period = self.model.forcing_period().unwrap_or(1.0);
        let (x_mm, v) = self.starts.at(row);
        let mut start = (x_mm / 1e3, v);
        match key {
            Key::Kind(kind) => match &self.rounds.kinds[kind as usize] {
                Kind::Orbit(orbit) => {
                    let first = self.rounds.of.iter().position(|own| own == orbit)?;
                    start = self.rounds.captures[first].state;
                }
                Kind::Rest(side) => {
                    let stops = self.model.stop_positions();
                    let stop = if *side == Side::Left { stops.0 } else { stops.1 };
                    start = (stop.unwrap_or(start.0), 0.0);
                }
                Kind::Judged(_, summary) => {
                    return Some((**summary, vec![(summary.final_x, summary.final_v)]));
                }
            },
            Key::Cycle(_) => {}
        }
        let settle = if let Key::Cycle(_) = key { f64::from(settled) * period } else { 0.0 };
        let window = self.model.with_start(start).with_duration(settle + f64::from(WINDOW) * period, settle);
        let summary = window.run(&Request { cancel: Some(task.cancel), ..Request::default() }).summary;
        if task.is_cancelled() {
            return None;
        }
        let state = (summary.final_x, summary.final_v);
        let states = states(&self.model, state, summary.period.unwrap_or(1), period);
        (!task.is_cancelled()).then_some((summary, states))
    }
}

/// The state of a settled motion after each of `count` forcing periods, that with the largest displacement
/// first.
fn states(model: &Model, state: (f64, f64), count: u32, period: f64) -> Vec<(f64, f64)> {
    let times: Vec<f64> = (0..count).map(|own| f64::from(own) * period).collect();
    let request = Request { sample_times: &times, ..Request::default() };
    let run = model.with_start(state).with_duration(f64::from(count) * period, 0.0).run(&request);
    if run.summary.outcome != Outcome::Done || run.samples.len() != times.len() {
        return vec![state];
    }
    let mut states: Vec<(f64, f64)> = run.samples.iter().map(|sample| (sample.x, sample.v)).collect();
    let most = |a: &(f64, f64), b: &(f64, f64)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1));
    let first = (0..states.len()).max_by(|a, b| most(&states[*a], &states[*b])).unwrap_or(0);
    states.rotate_left(first);
    states
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_of_a_share_is_wilsons() {
        // Wilson 1927, with the 0.975 quantile: 81 of 263, as in Newcombe (1998), Table I
        let own = Shares::of(81, 263);
        assert!((own.low - 0.2553).abs() < 5e-5 && (own.high - 0.3662).abs() < 5e-5, "{own:?}");
        let none = Shares::of(0, 20);
        assert_eq!((none.share, none.low), (0.0, 0.0));
        assert!((none.high - 0.1611).abs() < 5e-5, "{none:?}");
        let all = Shares::of(20, 20);
        assert_eq!((all.share, all.high), (1.0, 1.0));
    }
}
