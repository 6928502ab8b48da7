//! Statistics and energy ledger of a run.

use super::outcome::{Outcome, Place, Regime};

/// Where the energy went over the whole run, each term integrated on its own.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Ledger {
    /// Work of the base on the mass in J.
    pub work_j: f64,
    /// Taken by damping in J.
    pub damping_j: f64,
    /// Taken by impacts in J, the loss of compliant stops among them.
    pub impact_j: f64,
    /// Taken by the load of a transducer in J; none without one.
    pub harvested_j: Option<f64>,
    /// Taken by the coil of a transducer in J; none without one.
    pub coil_j: Option<f64>,
    /// Change of kinetic energy and potential in J.
    pub stored_j: f64,
    /// work - damping - impact - harvested - coil - stored in J.
    pub residual_j: f64,
    /// |residual| over the sum of the magnitudes moved; 0 where nothing moved.
    pub energy_residual: f64,
}

/// What a transducer gives over the settled window; none where the run ended before it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Harvest {
    /// Mean power into the load in W.
    pub mean_load_power: Option<f64>,
    /// Mean power lost in the coil in W.
    pub mean_coil_power: Option<f64>,
    /// Root mean square of the voltage over the load in V.
    pub voltage_rms: Option<f64>,
    /// Share of the work of the base that the load takes; none without work or ledger.
    pub load_share: Option<f64>,
}

/// When something happened first.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct First {
    /// Time in s.
    pub t: f64,
    /// Size of the amplitude of the base's acceleration then in m/s^2, where the drive is one amplitude ramp.
    pub amplitude: Option<f64>,
}

/// What happened first in a run under a drive that changes: an amplitude ramp, a chirp, noise, a record,
/// tones without a common period.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Firsts {
    /// The mass left a stop on which it rested.
    pub release: Option<First>,
    /// It crossed the barrier.
    pub crossing: Option<First>,
    /// From this crossing on it crossed in every forcing period up to the end of the run; none where the
    /// drive has none.
    pub crossing_in_every_period: Option<First>,
}

/// Statistics of a run; those of the settled window come first.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Summary {
    /// Displacement at the end in m.
    pub final_x: f64,
    /// Velocity at the end in m/s.
    pub final_v: f64,
    /// RMS velocity over the settled window in m/s; none where the run ended before it.
    pub rms_velocity: Option<f64>,
    /// What the motion is over the settled window.
    pub regime: Regime,
    /// Crossings in the settled window.
    pub crossings: u64,
    /// Impacts in the settled window that are faster than
    /// [`least_impact_speed`](crate::dynamics::Model::least_impact_speed); the contacts of a compliant stop
    /// are impacts too.
    pub impacts: u64,
    /// Speed in m/s of the fastest impact in the settled window; none without one.
    pub impact_speed_max: Option<f64>,
    /// Releases in the settled window.
    pub releases: u64,
    /// Largest |x| in the settled window in m; none where the run ended before it.
    pub max_abs_x: Option<f64>,
    /// Smallest and largest displacement in the settled window in m; none where the run ended before it.
    pub range: Option<(f64, f64)>,
    /// Mean displacement over the settled window in m; none where the run ended before it, or no ledger was
    /// asked for.
    pub mean_x: Option<f64>,
    /// Where the motion is in the settled window; none where the run ended before it, and for one well.
    pub side: Option<Place>,
    /// Begin and end of the settled window in s, as far as the run came.
    pub window: (f64, f64),
    /// Forcing periods in the settled window; 0 where the drive has none.
    pub periods: u64,
    /// Forcing periods of the settled window with a crossing in them.
    pub crossing_periods: u64,
    /// Forcing periods of the settled window with a release in them.
    pub release_periods: u64,
    /// Whether the motion has settled: it has a [period](Self::period), or the mass rests. None under a drive
    /// that changes.
    pub settled: Option<bool>,
    /// Whether averages over the window are steady: the motion has settled, or RMS velocity and crossings in
    /// both halves of the window agree within three standard errors. None under a drive that changes, where
    /// the run ended early, and where a motion that has not settled has fewer than 8 forcing periods.
    pub steady: Option<bool>,
    /// Since when in s the motion repeats; none where it does not.
    pub settles_at: Option<f64>,
    /// What happened first, under a drive that changes.
    pub firsts: Option<Firsts>,
    /// Share of the work that impacts took in the settled window; none without work or ledger.
    pub impact_share: Option<f64>,
    /// Share of the settled window spent at rest on a stop, or in contact with a compliant one.
    pub rested_share: Option<f64>,
    /// Crossings over the whole run.
    pub total_crossings: u64,
    /// The same over the whole run.
    pub total_impacts: u64,
    /// Chatters that were summed in closed form.
    pub chatter_sums: u64,
    /// Times the mass came to rest on a stop.
    pub rests: u64,
    /// Period of the motion in forcing periods; none where it does not repeat after at most 12 of them, or
    /// the mass rests.
    pub period: Option<u32>,
    /// Largest force in N of a compliant stop on the mass over the whole run; none where the stops are not
    /// compliant.
    pub peak_contact_force: Option<f64>,
    /// Pressure in Pa at the middle of the contact under that force; none where the stop's material is not
    /// known.
    pub peak_contact_pressure: Option<f64>,
    /// Whether that pressure is one at which the material yields.
    pub contact_yields: bool,
    /// What the transducer gives; none without one.
    pub harvest: Option<Harvest>,
    /// How the run ended.
    pub outcome: Outcome,
    /// Steps of the integrator.
    pub steps: u64,
    /// Taylor expansions of the equation of motion.
    pub evaluations: u64,
    /// CPU time of the run in s.
    pub cpu_s: f64,
    /// Energy ledger, where it was asked for.
    pub ledger: Option<Ledger>,
}

impl Summary {
    /// Whether its words and averages may be those of a transient: the motion has not settled, and is not
    /// irregular with steady averages, over the barrier or where there is none to cross.
    pub fn is_transient(&self) -> bool {
        let irregular = matches!(self.regime, Regime::Irregular | Regime::OneWell);
        let chaotic = irregular && self.steady == Some(true);
        self.settled == Some(false) && !chaotic
    }

    /// Peak to peak displacement in the settled window in m; none where the run ended before it.
    pub fn travel(&self) -> Option<f64> {
        self.range.map(|(low, high)| high - low)
    }
}
