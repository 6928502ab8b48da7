//! Lines of a walk up and down over a field: gaps where the motion jumps, ranges in which the ways differ.

use super::picture::is_transient;
use crate::output::{Point, Quantity, RMS, as_numbers};
use crate::study::{Table, Visit};

/// Relative difference up to which two RMS velocities are the same.
const SAME: f64 = 0.02;

/// Share of the largest RMS velocity of a walk below which a velocity is none.
const NONE: f64 = 1e-6;

/// The columns besides that of the quantity by which the motions of a walk are told apart; the regime is
/// always there.
pub(super) const OF_WALK: [&str; 2] = ["period", RMS];

/// A run of a walk, with what tells its motion from others.
#[doc(hidden)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WalkedRun {
    /// Value of the field.
    pub at: f64,
    /// The quantity that is drawn; NaN where it has no value.
    pub value: f64,
    /// RMS velocity in m/s; NaN where it is not known.
    pub rms: f64,
    /// The word of its regime.
    pub regime: &'static str,
    /// Whether it repeats or rests.
    pub repeats: bool,
    /// Whether it is known not to have settled.
    pub unsettled: bool,
    /// Whether its numbers may be those of a transient.
    pub is_transient: bool,
}

impl WalkedRun {
    /// A run with this value of the quantity that is drawn.
    pub fn of(visit: &Visit, value: f64) -> Self {
        let summary = &visit.summary;
        let regime = summary.regime.name();
        Self {
            at: visit.value,
            value,
            rms: summary.rms_velocity.unwrap_or(f64::NAN),
            regime,
            repeats: summary.period.is_some() || regime == "rest",
            unsettled: summary.settled == Some(false),
            is_transient: summary.is_transient(),
        }
    }

    /// The runs of these rows of the sweep over the field `x`.
    pub(super) fn of_rows(rows: &Table, x: &str, quantity: &Quantity, order: &[usize]) -> Vec<Self> {
        let number = |name: &str, row: usize| {
            rows.numbers(name).and_then(|column| column.get(row)).copied().unwrap_or(f64::NAN)
        };
        let word = |name: &str, row: usize| rows.words(name).get(row).copied().unwrap_or("");
        let periods = rows.column(OF_WALK[0]).and_then(as_numbers).unwrap_or_default();
        let run = |&row: &usize| Self {
            at: number(x, row),
            value: quantity.values[row],
            rms: number(RMS, row),
            regime: word("regime", row),
            repeats: periods.get(row).is_some_and(|period| period.is_finite())
                || word("regime", row) == "rest",
            unsettled: word("settled", row) == "false",
            is_transient: is_transient(rows, row),
        };
        order.iter().map(run).collect()
    }

    fn crosses(&self) -> bool {
        ["interwell", "irregular", "crossing"].contains(&self.regime)
    }

    /// Whether the motions of two runs at one value differ: one is interwell and the other stays in a well,
    /// one repeats and the other is irregular for good, or both repeat and their RMS velocities differ.
    /// Mirror images are the same motion. Velocities below `least` count as none.
    fn differs(&self, other: &Self, least: f64) -> bool {
        let apart = (self.rms - other.rms).abs() > SAME * self.rms.max(other.rms).max(least);
        let stays = |run: &Self| ["rest", "intrawell"].contains(&run.regime);
        let is_irregular = |run: &Self| run.unsettled && !run.is_transient;
        let are_of_two_kinds =
            |a: &Self, b: &Self| a.regime == "interwell" && stays(b) || a.repeats && is_irregular(b);
        let both_repeat = self.repeats && other.repeats;
        are_of_two_kinds(self, other) || are_of_two_kinds(other, self) || both_repeat && apart
    }
}

/// The runs of a walk on the way up and on the way down, each by rising value.
#[doc(hidden)]
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Walk {
    /// The runs of each way.
    pub ways: [Vec<WalkedRun>; 2],
    /// The ranges in which the motions of the two ways differ: from the first to the last of several values
    /// in a row. At a single value irregular motions may differ by chance.
    pub differing: Vec<(f64, f64)>,
    /// Whether the two ways differ at no value that both have.
    pub is_same: bool,
}

impl Walk {
    /// A walk of these runs.
    pub fn new(ways: [Vec<WalkedRun>; 2]) -> Self {
        let [up, down] = &ways;
        let fastest = ways.iter().flatten().map(|run| run.rms).fold(0.0, f64::max);
        let beside = |run: &WalkedRun| down.iter().find(|other| other.at == run.at);
        let compared = up.iter().filter_map(|run| Some((run.at, run.differs(beside(run)?, NONE * fastest))));
        let compared: Vec<(f64, bool)> = compared.collect();
        let rows = compared.chunk_by(|a, b| a.1 && b.1).filter(|row| row.len() > 1);
        let differing = rows.map(|row| (row[0].0, row[row.len() - 1].0)).collect();
        Self { is_same: compared.iter().all(|(_, differs)| !differs), differing, ways }
    }

    /// The line of a way, with a gap where its motion jumps.
    pub fn line(&self, way: usize) -> Vec<Point> {
        let gap = (f64::NAN, f64::NAN);
        let runs = self.ways[way].chunk_by(|a, b| !self.jumps(way, a, b));
        runs.flat_map(|run| run.iter().map(|run| (run.at, run.value)).chain([gap])).collect()
    }

    /// Whether the motion of a way jumps between two neighbours: it begins or ceases to cross, or a range in
    /// which the ways differ ends there and this way changes by more than the other one.
    fn jumps(&self, way: usize, a: &WalkedRun, b: &WalkedRun) -> bool {
        let is_within = |at: f64| self.differing.iter().any(|(from, to)| (*from..=*to).contains(&at));
        let other = |run: &WalkedRun| self.ways[1 - way].iter().find(|other| other.at == run.at);
        let changes_more = || match (other(a), other(b)) {
            (Some(before), Some(after)) => (b.value - a.value).abs() > (after.value - before.value).abs(),
            _ => false,
        };
        a.crosses() != b.crosses() || is_within(a.at) != is_within(b.at) && changes_more()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::Request;
    use crate::questions::Simulation;
    use crate::study::Direction;

    fn run(preset: &str) -> WalkedRun {
        let summary = Simulation::preset(preset).unwrap().run(&Request::default()).summary;
        let visit = Visit { direction: Direction::Up, value: 1.0, summary, strobes: Vec::new() };
        WalkedRun::of(&visit, 0.0)
    }

    #[test]
    fn ways_that_differ_at_a_single_value_are_not_hysteresis() {
        let flags = [false, true, false, true, true, true, false, true];
        let way = |count: usize, speed: f64| -> Vec<WalkedRun> {
            let run = |(place, differs): (f64, bool)| WalkedRun {
                at: place,
                rms: if differs { speed } else { 1.0 },
                repeats: true,
                ..run("paper")
            };
            (0_u8..).map(f64::from).zip(flags).take(count).map(run).collect()
        };
        let walk = |count: usize| Walk::new([way(count, 1.0), way(count, 2.0)]);
        assert_eq!((walk(8).differing, walk(8).is_same), (vec![(3.0, 5.0)], false));
        assert_eq!((walk(3).differing, walk(1).is_same), (vec![], true));
    }

    #[test]
    fn a_chaotic_motion_differs_from_a_periodic_one() {
        let (periodic, chaotic, rest) = (run("paper"), run("duffing-chaos"), run("first-look"));
        assert!(periodic.repeats && chaotic.unsettled && !chaotic.is_transient, "{chaotic:?}");
        assert!(periodic.differs(&chaotic, 0.0) && chaotic.differs(&periodic, 0.0));
        assert!(!periodic.differs(&periodic, 0.0) && !chaotic.differs(&chaotic, 0.0));
        let rest = WalkedRun { regime: "rest", rms: 0.0, repeats: true, ..rest };
        let hops = WalkedRun { regime: "intrawell", rms: 1.0, ..rest };
        assert!(rest.differs(&hops, 1e-6) && rest.differs(&periodic, 1e-6) && !rest.differs(&rest, 1e-6));
    }
}
