//! Energy ledger as bars: what came in to the right, what was taken to the left, and what that leaves.

use super::axis::PlotAxis;
use super::chart::{Marks, Panel};
use super::names::axis_name;
use super::role::Role;
use crate::dynamics::LiveLedger;
use crate::numeric::{decimals, elementary, extent};

/// A row of a ledger.
#[doc(hidden)]
#[derive(Debug, Clone, Copy)]
pub struct LedgerTerm {
    /// Its name.
    pub name: &'static str,
    /// What its bar stands for.
    pub role: Role,
    /// Its energy in J, above 0 where it came in.
    pub energy: fn(&LiveLedger) -> f64,
}

const fn term(name: &'static str, role: Role, energy: fn(&LiveLedger) -> f64) -> LedgerTerm {
    LedgerTerm { name, role, energy }
}

impl LedgerTerm {
    /// What is left in the mass and its mechanism.
    pub const STORED: Self = term("stored", Role::Motion, |ledger| ledger.stored_j);
    /// What a person put in.
    pub const BY_HAND: Self = term("by changes", Role::ByHand, |ledger| ledger.by_hand_j);
    /// What load and coil of a transducer took.
    pub const TRANSDUCER: Self =
        term("transducer", Role::Motion, |ledger| -(ledger.harvested_j + ledger.coil_j));

    /// All rows from top to bottom.
    pub const ALL: [Self; 6] = [
        term("work in", Role::Drive, |ledger| ledger.work_j),
        Self::BY_HAND,
        term("damping", Role::Taken, |ledger| -ledger.damping_j),
        term("impacts", Role::Impact, |ledger| -ledger.impact_j),
        Self::TRANSDUCER,
        Self::STORED,
    ];
}

/// Height of a bar relative to that of its row.
const BAR: f64 = 0.5;
/// Distance of the bar of another motion from the middle of a row.
const OTHER: f64 = 0.3;
/// Room for a number beside the bars, relative to their range.
const ROOM: f64 = 0.45;

/// Decimals of all numbers of a ledger: three, or one if any number has three digits before the point, or
/// where all are small as many as give the largest three digits, but no more than five.
#[doc(hidden)]
pub fn ledger_decimals(ledger: &LiveLedger, unit: f64) -> usize {
    let largest = LedgerTerm::ALL.iter().map(|term| (term.energy)(ledger).abs()).fold(0.0, f64::max) / unit;
    match largest {
        largest if largest >= 100.0 => 1,
        largest if largest > 0.0 => decimals(largest, 3).clamp(3, 5),
        _ => 3,
    }
}

fn is_nothing(joule: f64, unit: f64, decimals: usize) -> bool {
    (joule / unit).abs() < 0.5 * elementary::powi(0.1, decimals as i32)
}

/// An energy of a ledger as text with its sign, in the given unit in J.
#[doc(hidden)]
pub fn ledger_number(joule: f64, unit: f64, decimals: usize) -> String {
    match is_nothing(joule, unit, decimals) {
        true => format!("{:.decimals$}", 0.0),
        false => format!("{:+.decimals$}", joule / unit).replace('-', "\u{2212}"),
    }
}

/// What was taken as a share of the work of the base, in whole percent; `None` for what was put in, and where
/// there is no work or the energy rounds to nothing.
#[doc(hidden)]
pub fn share_of_work(joule: f64, ledger: &LiveLedger, (unit, decimals): (f64, usize)) -> Option<String> {
    let share = -100.0 * joule / ledger.work_j;
    let is_taken = ledger.work_j > 0.0 && joule < 0.0 && !is_nothing(joule, unit, decimals);
    is_taken.then(|| format!("{share:.0} %"))
}

/// The bars of these rows of a ledger in a unit in J, without their numbers, and beside them those of another
/// motion. The axis of the energy reaches to `largest` in J both ways.
#[doc(hidden)]
pub fn ledger_bars(
    terms: &[LedgerTerm],
    ledger: &LiveLedger,
    other: Option<&LiveLedger>,
    (unit, largest): (f64, f64),
) -> Panel {
    let (count, end) = (terms.len() as f64, largest / unit);
    let decimals = ledger_decimals(ledger, unit);
    let value = |term: &LedgerTerm, ledger: &LiveLedger| {
        let joule = (term.energy)(ledger);
        if is_nothing(joule, unit, decimals) { 0.0 } else { joule / unit }
    };
    let middle = |row: usize| count - row as f64 - 0.5;
    let ticks = terms.iter().enumerate().map(|(row, term)| (middle(row), term.name.to_owned())).collect();
    let mut panel = Panel::new(PlotAxis::between(-end, end, ""), PlotAxis::given(0.0, count, ticks, ""));
    for (row, term) in terms.iter().enumerate() {
        let value = value(term, ledger);
        if value != 0.0 {
            panel.draw(term.role, Marks::Bars(vec![[middle(row), value.min(0.0), value.max(0.0)]], BAR));
        }
        if let Some(other) = other {
            let up = middle(row) - OTHER;
            panel.draw(Role::Compared, Marks::Path(vec![(0.0, up), (value_of(term, other, unit), up)]));
        }
    }
    panel.draw(Role::Reference, Marks::Verticals(vec![0.0]));
    panel
}

fn value_of(term: &LedgerTerm, ledger: &LiveLedger, unit: f64) -> f64 {
    (term.energy)(ledger) / unit
}

/// The panel of a ledger over a range of times in s, with its numbers and the shares of the work of the base,
/// in a unit in J with this name.
pub(crate) fn ledger_panel(
    ledger: &LiveLedger,
    has_transducer: bool,
    (from, to): (&str, &str),
    (unit, name): (f64, &str),
) -> Panel {
    let is_shown = |term: &LedgerTerm| {
        term.name != LedgerTerm::BY_HAND.name && (has_transducer || term.name != LedgerTerm::TRANSDUCER.name)
    };
    let terms: Vec<LedgerTerm> = LedgerTerm::ALL.into_iter().filter(is_shown).collect();
    let mut panel = ledger_bars(&terms, ledger, None, (unit, unit));
    let decimals = ledger_decimals(ledger, unit);
    let written = |(place, term): (&(f64, String), &LedgerTerm)| {
        let joule = (term.energy)(ledger);
        let number = ledger_number(joule, unit, decimals);
        let is_share = term.name != LedgerTerm::STORED.name;
        let share = share_of_work(joule, ledger, (unit, decimals)).filter(|_| is_share);
        let words = share.map_or(number.clone(), |share| format!("{number} ({share})"));
        (((joule / unit).max(0.0), place.0), words)
    };
    let words = panel.y.ticks.iter().zip(&terms).map(written).collect();
    let (low, high) = extent(terms.iter().map(|term| value_of(term, ledger, unit)).chain([0.0]));
    let room = if high > low { high - low } else { 1.0 };
    panel.x = PlotAxis::between(low - 0.05 * room, high + ROOM * room, &axis_name("energy", name));
    panel.draw(Role::Motion, Marks::Words(words));
    panel.heading = format!("energy from {from} to {to} s: came in +, taken \u{2212}");
    panel
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_a_ledger_have_their_sign() {
        assert_eq!(ledger_number(1.2345e-3, 1e-3, 3), "+1.234");
        assert_eq!(ledger_number(-0.25, 1e-3, 1), "\u{2212}250.0");
        assert_eq!(ledger_number(-1e-9, 1e-3, 3), "0.000");
        // one large number sets the decimals of all
        let ledger = LiveLedger { work_j: 0.3, damping_j: 1e-3, ..LiveLedger::default() };
        assert_eq!(ledger_decimals(&ledger, 1e-3), 1);
        assert_eq!(ledger_decimals(&LiveLedger::default(), 1e-3), 3);
        let small = LiveLedger { work_j: 3.12e-6, impact_j: 2.91e-6, ..LiveLedger::default() };
        let decimals = ledger_decimals(&small, 1e-3);
        assert_eq!((decimals, ledger_number(small.work_j, 1e-3, 5)), (5, "+0.00312".to_owned()));
        assert_eq!(share_of_work(-small.impact_j, &small, (1e-3, decimals)).as_deref(), Some("93 %"));
        assert_eq!(share_of_work(small.work_j, &small, (1e-3, decimals)), None);
    }

    /// A bar ends at its energy, and what rounds to nothing has none.
    #[test]
    fn the_bars_are_as_long_as_their_energies() {
        let ledger = LiveLedger { work_j: 2e-3, impact_j: 1e-3, damping_j: 1e-9, ..LiveLedger::default() };
        let panel = ledger_bars(&LedgerTerm::ALL, &ledger, Some(&ledger), (1e-3, 2e-3));
        let bars = panel.layers.iter().filter_map(|layer| match &layer.marks {
            Marks::Bars(rows, _) => Some((layer.role, rows[0])),
            _ => None,
        });
        let bars: Vec<(Role, [f64; 3])> = bars.collect();
        assert_eq!(bars, [(Role::Drive, [5.5, 0.0, 2.0]), (Role::Impact, [2.5, -1.0, 0.0])]);
    }
}
