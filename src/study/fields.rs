//! Fields of a summary by name: the keys of `simulate`'s JSON and the columns of a sweep.

use super::table::Values;
use crate::dynamics::{First, Firsts, STANDARD_GRAVITY, Summary};

/// What a field of a summary is, and how it is read. A number, count or flag of `None` and an empty word are
/// missing values.
#[derive(Debug, Clone, Copy)]
pub enum Read {
    /// A real number.
    Number(fn(&Summary) -> Option<f64>),
    /// A whole number.
    Count(fn(&Summary) -> Option<u64>),
    /// A word from a fixed list.
    Word(fn(&Summary) -> &'static str),
    /// Yes or no.
    Flag(fn(&Summary) -> Option<bool>),
}

/// A named value of a summary.
#[derive(Debug, Clone, Copy)]
pub struct SummaryField {
    /// Its name, with the unit in it.
    pub name: &'static str,
    /// How it is read.
    pub read: Read,
    /// Whether it needs the energy ledger.
    pub needs_ledger: bool,
}

const fn plain(name: &'static str, read: Read) -> SummaryField {
    SummaryField { name, read, needs_ledger: false }
}

const fn of_ledger(name: &'static str, read: Read) -> SummaryField {
    SummaryField { name, read, needs_ledger: true }
}

/// All of them, in the order in which a summary has them. Counts of the settled window are missing where the
/// run ended before it: 0 would say that nothing happened in it.
pub const SUMMARY_FIELDS: &[SummaryField] = &[
    plain("final_x_m", Read::Number(|s| Some(s.final_x))),
    plain("final_v_m_per_s", Read::Number(|s| Some(s.final_v))),
    plain("rms_velocity_m_per_s", Read::Number(|s| s.rms_velocity)),
    plain("regime", Read::Word(|s| if s.rms_velocity.is_some() { s.regime.name() } else { "" })),
    plain("crossings", Read::Count(|s| in_window(s, s.crossings))),
    plain("impacts", Read::Count(|s| in_window(s, s.impacts))),
    plain("releases", Read::Count(|s| in_window(s, s.releases))),
    plain("impact_speed_max_m_per_s", Read::Number(|s| s.impact_speed_max)),
    plain("max_abs_x_m", Read::Number(|s| s.max_abs_x)),
    plain("min_x_m", Read::Number(|s| s.range.map(|range| range.0))),
    plain("max_x_m", Read::Number(|s| s.range.map(|range| range.1))),
    plain("travel_m", Read::Number(Summary::travel)),
    of_ledger("mean_x_m", Read::Number(|s| s.mean_x)),
    plain("side", Read::Word(|s| s.side.map_or("", |side| side.name()))),
    of_ledger("impact_share", Read::Number(|s| s.impact_share)),
    plain("rested_share", Read::Number(|s| s.rested_share)),
    plain("settled", Read::Flag(|s| s.settled)),
    plain("steady", Read::Flag(|s| s.steady)),
    plain("settles_at_s", Read::Number(|s| s.settles_at)),
    plain("window_from_s", Read::Number(|s| Some(s.window.0))),
    plain("window_to_s", Read::Number(|s| Some(s.window.1))),
    plain("periods", Read::Count(|s| in_window(s, s.periods))),
    plain("crossing_periods", Read::Count(|s| in_window(s, s.crossing_periods))),
    plain("release_periods", Read::Count(|s| in_window(s, s.release_periods))),
    plain("first_release_s", Read::Number(|s| time(s, |firsts| firsts.release))),
    plain("first_release_g", Read::Number(|s| amplitude(s, |firsts| firsts.release))),
    plain("first_crossing_s", Read::Number(|s| time(s, |firsts| firsts.crossing))),
    plain("first_crossing_g", Read::Number(|s| amplitude(s, |firsts| firsts.crossing))),
    plain("crosses_always_from_s", Read::Number(|s| time(s, |firsts| firsts.crossing_in_every_period))),
    plain("crosses_always_from_g", Read::Number(|s| amplitude(s, |firsts| firsts.crossing_in_every_period))),
    plain("total_crossings", Read::Count(|s| Some(s.total_crossings))),
    plain("total_impacts", Read::Count(|s| Some(s.total_impacts))),
    plain("chatter_sums", Read::Count(|s| Some(s.chatter_sums))),
    plain("rests", Read::Count(|s| Some(s.rests))),
    plain("period", Read::Count(|s| s.period.map(u64::from))),
    plain("peak_contact_force_n", Read::Number(|s| s.peak_contact_force)),
    plain("peak_contact_pressure_pa", Read::Number(|s| s.peak_contact_pressure)),
    plain("mean_load_power_w", Read::Number(|s| s.harvest.and_then(|harvest| harvest.mean_load_power))),
    plain("mean_coil_power_w", Read::Number(|s| s.harvest.and_then(|harvest| harvest.mean_coil_power))),
    plain("voltage_rms_v", Read::Number(|s| s.harvest.and_then(|harvest| harvest.voltage_rms))),
    plain("outcome", Read::Word(|s| s.outcome.name())),
    plain("ended_at_s", Read::Number(|s| s.outcome.ended_at())),
    plain("steps", Read::Count(|s| Some(s.steps))),
    plain("evaluations", Read::Count(|s| Some(s.evaluations))),
    of_ledger("work_j", Read::Number(|s| s.ledger.map(|ledger| ledger.work_j))),
    of_ledger("damping_j", Read::Number(|s| s.ledger.map(|ledger| ledger.damping_j))),
    of_ledger("impact_j", Read::Number(|s| s.ledger.map(|ledger| ledger.impact_j))),
    of_ledger("harvested_j", Read::Number(|s| s.ledger.and_then(|ledger| ledger.harvested_j))),
    of_ledger("coil_j", Read::Number(|s| s.ledger.and_then(|ledger| ledger.coil_j))),
    of_ledger("stored_j", Read::Number(|s| s.ledger.map(|ledger| ledger.stored_j))),
    of_ledger("energy_residual", Read::Number(|s| s.ledger.map(|ledger| ledger.energy_residual))),
];

fn in_window(summary: &Summary, count: u64) -> Option<u64> {
    summary.rms_velocity.map(|_| count)
}

fn time(summary: &Summary, of: fn(&Firsts) -> Option<First>) -> Option<f64> {
    summary.firsts.as_ref().and_then(of).map(|first| first.t)
}

fn amplitude(summary: &Summary, of: fn(&Firsts) -> Option<First>) -> Option<f64> {
    summary.firsts.as_ref().and_then(of)?.amplitude.map(|value| value / STANDARD_GRAVITY)
}

impl SummaryField {
    /// The field called `name`.
    pub fn find(name: &str) -> Option<&'static Self> {
        SUMMARY_FIELDS.iter().find(|field| field.name == name)
    }

    /// Its column over these summaries, of which some may be missing.
    pub fn column<'a>(&self, summaries: impl Iterator<Item = Option<&'a Summary>>) -> Values {
        match self.read {
            Read::Number(of) => {
                // (not finite after a run that diverged)
                let number = |summary: &Summary| of(summary).filter(|number| number.is_finite());
                Values::Numbers(summaries.map(|s| s.and_then(number).unwrap_or(f64::NAN)).collect())
            }
            Read::Count(of) => Values::Counts(summaries.map(|s| s.and_then(of)).collect()),
            Read::Word(of) => Values::Words(summaries.map(|s| s.map_or("", of)).collect()),
            Read::Flag(of) => {
                let word = |flag: bool| if flag { "true" } else { "false" };
                Values::Words(summaries.map(|s| s.and_then(of).map_or("", word)).collect())
            }
        }
    }
}
