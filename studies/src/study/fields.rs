//! Fields of a summary: the keys of `simulate`'s JSON, the columns of a sweep, the quantities of maps.

use Read::{Count, Flag, Number, Word};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::Values;
use crate::dynamics::{First, Firsts, Outcome, Place, Regime, STANDARD_GRAVITY, Summary};
use crate::scene::find_name;

/// How a field of a summary is read; `None` and an empty word are missing values.
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

/// Place of a field in the JSON of a run.
#[derive(Debug, Clone, Copy)]
pub enum InJson {
    /// Among the values of the summary, if the run has such a quantity.
    Summary(fn(&Summary) -> bool),
    /// In the object of the energy ledger.
    Ledger,
}

/// A named value of a summary.
#[derive(Debug, Clone, Copy)]
pub struct SummaryField {
    /// Its name, with the unit in it.
    pub name: &'static str,
    /// How it is read.
    pub read: Read,
    /// Its name on the screen.
    pub label: &'static str,
    /// Its explanation on the screen.
    pub about: &'static str,
    /// Its possible words; empty for a number.
    pub words: &'static [&'static str],
    /// Whether it needs the energy ledger.
    pub needs_ledger: bool,
    /// Its place in JSON.
    pub in_json: InJson,
}

impl PartialEq for SummaryField {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// By its name.
impl Serialize for SummaryField {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(self.name)
    }
}

impl<'de> Deserialize<'de> for &'static SummaryField {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        SummaryField::named(&String::deserialize(from)?).map_err(D::Error::custom)
    }
}

const fn field(name: &'static str, read: Read, label: &'static str, about: &'static str) -> SummaryField {
    let in_json = InJson::Summary(|_| true);
    SummaryField { name, read, label, about, words: &[], needs_ledger: false, in_json }
}

impl SummaryField {
    const fn words(mut self, words: &'static [&'static str]) -> Self {
        self.words = words;
        self
    }

    const fn only_if(mut self, present: fn(&Summary) -> bool) -> Self {
        self.in_json = InJson::Summary(present);
        self
    }

    const fn of_ledger(mut self) -> Self {
        self.needs_ledger = true;
        self
    }

    const fn term_of_ledger(mut self) -> Self {
        self.in_json = InJson::Ledger;
        self.of_ledger()
    }
}

/// The root mean square of the velocity, which maps show by default.
pub const RMS_VELOCITY: SummaryField = field(
    "rms_velocity_m_per_s",
    Number(|s| s.rms_velocity),
    "RMS velocity",
    "Root of the mean square of the velocity over the settled window.",
);

const FLAGS: [&str; 2] = ["true", "false"];
const SIDES: &[&str] = &[Place::Left.name(), Place::Right.name(), Place::Both.name()];
const REGIMES: &[&str] = &[
    Regime::Rest.name(),
    Regime::Intrawell.name(),
    Regime::Interwell.name(),
    Regime::Irregular.name(),
    Regime::Crossing.name(),
];

/// All fields in the order of a summary. Counts of the settled window are missing if the run ended before it;
/// 0 would mean that nothing happened in it.
#[rustfmt::skip]
pub const SUMMARY_FIELDS: &[SummaryField] = &[
    field("final_x_m", Number(|s| Some(s.final_x)), "displacement at the end", "Where the run ended."),
    field("final_v_m_per_s", Number(|s| Some(s.final_v)),
        "velocity at the end", "How fast the mass was where the run ended."),
    RMS_VELOCITY,
    field("regime", Word(|s| if s.rms_velocity.is_some() { s.regime.name() } else { "" }),
        "regime", "What kind of motion it is.").words(REGIMES),
    field("crossings", Count(|s| in_window(s, s.crossings)),
        "crossings", "How often the mass crossed the barrier in the settled window."),
    field("impacts", Count(|s| in_window(s, s.impacts)),
        "impacts", "How often it struck a stop in the settled window."),
    field("releases", Count(|s| in_window(s, s.releases)),
        "releases", "How often it left a stop on which it rested, in the settled window."),
    field("impact_speed_max_m_per_s", Number(|s| s.impact_speed_max),
        "fastest impact", "The largest speed of an impact in the settled window."),
    field("max_abs_x_m", Number(|s| s.max_abs_x),
        "reach", "The largest distance from the middle in the settled window."),
    field("min_x_m", Number(|s| s.range.map(|range| range.0)),
        "leftmost place", "The least displacement in the settled window."),
    field("max_x_m", Number(|s| s.range.map(|range| range.1)),
        "rightmost place", "The largest displacement in the settled window."),
    field("travel_m", Number(Summary::travel),
        "travel", "From the leftmost place to the rightmost one of the settled window."),
    field("mean_x_m", Number(|s| s.mean_x),
        "mean displacement", "The mean over the settled window.").of_ledger(),
    field("side", Word(|s| s.side.map_or("", |side| side.name())),
        "side", "On which side of the barrier the mass stays.").words(SIDES),
    field("impact_share", Number(|s| s.impact_share),
        "share of the work lost in impacts", "In the settled window.").of_ledger(),
    field("rested_share", Number(|s| s.rested_share),
        "share of time at rest", "The share of the settled window that the mass rests on a stop."),
    field("settled", Flag(|s| s.settled),
        "settled", "Whether the motion repeats, or the mass rests.").words(&FLAGS),
    field("steady", Flag(|s| s.steady),
        "averages steady",
        "Whether the averages over both halves of the settled window agree, though the motion may be \
         irregular.").words(&FLAGS),
    field("settles_at_s", Number(|s| s.settles_at), "settles at", "The time since when the motion repeats."),
    field("window_from_s", Number(|s| Some(s.window.0)),
        "window from", "The beginning of the settled window."),
    field("window_to_s", Number(|s| Some(s.window.1)), "window to", "Its end."),
    field("periods", Count(|s| in_window(s, s.periods)),
        "periods judged", "Forcing periods in the settled window."),
    field("crossing_periods", Count(|s| in_window(s, s.crossing_periods)),
        "periods with a crossing", "Forcing periods in which the mass crossed."),
    field("release_periods", Count(|s| in_window(s, s.release_periods)),
        "periods with a release", "Forcing periods in which it left a stop."),
    field("first_release_s", Number(|s| time(s, |firsts| firsts.release)),
        "first release, time", "When the mass first left its stop, under shaking that changes.")
        .only_if(|s| s.firsts.is_some()),
    field("first_release_g", Number(|s| amplitude(s, |firsts| firsts.release)),
        "first release, shaking", "The amplitude of a ramp at that time.").only_if(|s| s.firsts.is_some()),
    field("first_crossing_s", Number(|s| time(s, |firsts| firsts.crossing)),
        "first crossing, time", "When it first crossed the barrier, under shaking that changes.")
        .only_if(|s| s.firsts.is_some()),
    field("first_crossing_g", Number(|s| amplitude(s, |firsts| firsts.crossing)),
        "first crossing, shaking", "The amplitude of a ramp at that time.").only_if(|s| s.firsts.is_some()),
    field("crosses_always_from_s", Number(|s| time(s, |firsts| firsts.crossing_in_every_period)),
        "crosses always from, time", "The time from which on it crossed in every forcing period.")
        .only_if(|s| s.firsts.is_some()),
    field("crosses_always_from_g", Number(|s| amplitude(s, |firsts| firsts.crossing_in_every_period)),
        "crosses always from, shaking", "The amplitude of a ramp at that time.")
        .only_if(|s| s.firsts.is_some()),
    field("total_crossings", Count(|s| Some(s.total_crossings)),
        "crossings in all", "From the start of the run on."),
    field("total_impacts", Count(|s| Some(s.total_impacts)),
        "impacts in all", "From the start of the run on."),
    field("chatter_sums", Count(|s| Some(s.chatter_sums)),
        "summed chatters", "Endings of a chatter that were summed in closed form."),
    field("rests", Count(|s| Some(s.rests)),
        "arrivals at rest", "How often the mass came to rest on a stop, from the start on."),
    field("period", Count(|s| s.period.map(u64::from)),
        "period", "Forcing periods after which the motion repeats, up to 12."),
    field("peak_contact_force_n", Number(|s| s.peak_contact_force),
        "largest contact force", "Of a compliant stop on the mass.")
        .only_if(|s| s.peak_contact_force.is_some()),
    field("peak_contact_pressure_pa", Number(|s| s.peak_contact_pressure),
        "largest contact pressure", "In the middle of the contact.")
        .only_if(|s| s.peak_contact_force.is_some()),
    field("mean_load_power_w", Number(|s| s.harvest.and_then(|harvest| harvest.mean_load_power)),
        "mean power into the load", "Of the transducer, over the settled window.")
        .only_if(|s| s.harvest.is_some()),
    field("mean_coil_power_w", Number(|s| s.harvest.and_then(|harvest| harvest.mean_coil_power)),
        "mean power lost in the coil", "Of the transducer, as above.").only_if(|s| s.harvest.is_some()),
    field("voltage_rms_v", Number(|s| s.harvest.and_then(|harvest| harvest.voltage_rms)),
        "RMS voltage", "Over the load of the transducer, in the settled window.")
        .only_if(|s| s.harvest.is_some()),
    field("outcome", Word(|s| s.outcome.name()), "outcome", "How the run ended.").words(Outcome::NAMES),
    field("ended_at_s", Number(|s| s.outcome.ended_at()),
        "ended early at", "When a run ended that did not last to its end.")
        .only_if(|s| s.outcome.ended_at().is_some()),
    field("steps", Count(|s| Some(s.steps)), "steps", "Steps of the integration."),
    field("evaluations", Count(|s| Some(s.evaluations)),
        "evaluations", "Taylor expansions of the equation of motion."),
    field("work_j", Number(|s| s.ledger.map(|ledger| ledger.work_j)),
        "work of the base", "What the base did on the mass in the whole run.").term_of_ledger(),
    field("damping_j", Number(|s| s.ledger.map(|ledger| ledger.damping_j)),
        "lost to damping", "In the whole run.").term_of_ledger(),
    field("impact_j", Number(|s| s.ledger.map(|ledger| ledger.impact_j)),
        "lost in impacts", "In the whole run.").term_of_ledger(),
    field("harvested_j", Number(|s| s.ledger.and_then(|ledger| ledger.harvested_j)),
        "into the load", "Of the transducer, in the whole run.").term_of_ledger(),
    field("coil_j", Number(|s| s.ledger.and_then(|ledger| ledger.coil_j)),
        "lost in the coil", "Of the transducer, in the whole run.").term_of_ledger(),
    field("stored_j", Number(|s| s.ledger.map(|ledger| ledger.stored_j)),
        "stored", "Energy at the end less that at the start.").term_of_ledger(),
    field("energy_residual", Number(|s| s.ledger.map(|ledger| ledger.energy_residual)),
        "energy residual", "What of the energy is not accounted for, as a share.").of_ledger(),
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
    /// The field that a person calls `name`, in full or without its unit; otherwise a sentence that says
    /// which may have been meant, and which there are.
    pub fn named(name: &str) -> Result<&'static Self, String> {
        let known: Vec<&str> = SUMMARY_FIELDS.iter().map(|field| field.name).collect();
        let found = find_name("column", name, &known)?;
        Self::find(found).ok_or_else(|| format!("no such column as {found}"))
    }

    /// The field called `name`.
    pub fn find(name: &str) -> Option<&'static Self> {
        SUMMARY_FIELDS.iter().find(|field| field.name == name)
    }

    /// Its number or count; not finite after a run that diverged, which is missing.
    pub fn number(&self, summary: &Summary) -> Option<f64> {
        match self.read {
            Number(of) => of(summary).filter(|number| number.is_finite()),
            Count(of) => of(summary).map(|count| count as f64),
            Word(_) | Flag(_) => None,
        }
    }

    /// Its word, one of `words`.
    pub fn word(&self, summary: &Summary) -> Option<&'static str> {
        match self.read {
            Word(of) => Some(of(summary)).filter(|word| !word.is_empty()),
            Flag(of) => of(summary).map(|flag| FLAGS[usize::from(!flag)]),
            Number(_) | Count(_) => None,
        }
    }

    /// Its column over these summaries, of which some may be missing.
    pub fn column<'a>(&self, summaries: impl Iterator<Item = Option<&'a Summary>>) -> Values {
        match self.read {
            Number(_) => summaries.map(|s| self.number(s?)).collect(),
            Count(of) => summaries.map(|s| of(s?)).collect(),
            Word(_) | Flag(_) => {
                summaries.map(|s| s.and_then(|s| self.word(s)).unwrap_or_default()).collect()
            }
        }
    }
}
