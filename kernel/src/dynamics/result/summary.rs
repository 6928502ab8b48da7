//! Statistics and energy ledger of a run.

use serde::{Deserialize, Serialize};

use super::outcome::{Outcome, Place, Regime};

/// Energy balance over the whole run, each term integrated separately.
///
/// A run has it if [`Request::ledger`](super::Request::ledger) asks for it.
/// [`energy_residual`](Self::energy_residual) is a check of the accuracy: it is of the size of the tolerance,
/// and a run in which it is not ends with [`Outcome::Inaccurate`](super::Outcome::Inaccurate).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Ledger {
    /// Work of the base on the mass in J.
    pub work_j: f64,
    /// Taken by damping in J.
    pub damping_j: f64,
    /// Taken by impacts in J, including the loss of compliant stops.
    pub impact_j: f64,
    /// Taken by the load of a transducer in J; `None` without one.
    pub harvested_j: Option<f64>,
    /// Taken by the coil of a transducer in J; `None` without one.
    pub coil_j: Option<f64>,
    /// Change of kinetic energy and potential in J.
    pub stored_j: f64,
    /// work - damping - impact - harvested - coil - stored in J.
    pub residual_j: f64,
    /// |residual| over the sum of the magnitudes of the terms; 0 if all are 0.
    pub energy_residual: f64,
}

/// Output of a transducer over the settled window; each value is `None` if the run ended before it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Harvest {
    /// Mean power into the load in W.
    pub mean_load_power: Option<f64>,
    /// Mean power lost in the coil in W.
    pub mean_coil_power: Option<f64>,
    /// Root mean square of the voltage over the load in V.
    pub voltage_rms: Option<f64>,
    /// Share of the work of the base that the load takes; `None` without work or ledger.
    pub load_share: Option<f64>,
}

/// The first occurrence of an event.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct First {
    /// Time in s.
    pub t: f64,
    /// Magnitude of the amplitude of the base acceleration then in m/s^2, if the drive is one amplitude ramp.
    pub amplitude: Option<f64>,
}

/// First events of a run under a drive that changes: an amplitude ramp, a chirp, noise, a record, tones
/// without a common period.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Firsts {
    /// The mass left a stop on which it rested.
    pub release: Option<First>,
    /// It crossed the barrier.
    pub crossing: Option<First>,
    /// The first of the crossings that continue in every forcing period up to the end of the run; `None` if
    /// the drive has no period.
    pub crossing_in_every_period: Option<First>,
}

/// Statistics of a run; those of the settled window come first.
///
/// Values are in SI units. Those of the settled window are averages and counts over whole forcing periods
/// where the drive has them; they are `None`, or 0 for a count, if the run ended before the window began, as
/// [`outcome`](Self::outcome) says. Energies are in the ledger, which a [`Request`](super::Request) asks for.
///
/// ```
/// # use interwell_kernel as interwell;
/// use std::sync::Arc;
/// use interwell::dynamics::{Model, Outcome, Request};
/// use interwell::mechanics::Mechanism;
/// use interwell::scene::Document;
///
/// let document = Document::preset("nominal-cubic")?;
/// let mechanism = Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
/// let model = Model::build(&document.scene, Arc::new(mechanism)).unwrap();
/// let summary = model.run(&Request { ledger: true, ..Request::default() }).summary;
/// assert_eq!(summary.outcome, Outcome::Done);
/// // what the base does is lost in impacts and damping, or kept
/// assert!(summary.ledger.unwrap().energy_residual < 1e-9);
/// # Ok::<(), interwell::scene::SceneError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Summary {
    /// Displacement at the end in m.
    pub final_x: f64,
    /// Velocity at the end in m/s.
    pub final_v: f64,
    /// State of the circuit at the end in A or V; 0 without one.
    pub final_electrical: f64,
    /// RMS velocity over the settled window in m/s; `None` if the run ended before it.
    pub rms_velocity: Option<f64>,
    /// Regime of the motion over the settled window.
    pub regime: Regime,
    /// Crossings in the settled window.
    pub crossings: u64,
    /// Impacts in the settled window faster than
    /// [`min_impact_speed`](crate::dynamics::Model::min_impact_speed), including the contacts of a
    /// compliant stop.
    pub impacts: u64,
    /// Speed in m/s of the fastest impact in the settled window; `None` without one.
    pub impact_speed_max: Option<f64>,
    /// Releases in the settled window.
    pub releases: u64,
    /// Largest |x| in the settled window in m; `None` if the run ended before it.
    pub max_abs_x: Option<f64>,
    /// Smallest and largest displacement in the settled window in m; `None` if the run ended before it.
    pub range: Option<(f64, f64)>,
    /// Mean displacement over the settled window in m; `None` if the run ended before it, or without
    /// a ledger.
    pub mean_x: Option<f64>,
    /// Side of the barrier in the settled window; `None` if the run ended before it, and for one well.
    pub side: Option<Place>,
    /// Start and end of the settled window in s, or of the part that the run reached.
    pub window: (f64, f64),
    /// Forcing periods in the settled window; 0 if the drive has none.
    pub periods: u64,
    /// Forcing periods of the settled window with a crossing in them.
    pub crossing_periods: u64,
    /// Forcing periods of the settled window with a release in them.
    pub release_periods: u64,
    /// Whether the motion has settled: it repeats and a periodic orbit attracts it, so that it has a
    /// [period](Self::period), or the mass rests. `None` under a drive that changes.
    pub settled: Option<bool>,
    /// Whether averages over the window are steady: the motion has settled, or RMS velocity and crossings in
    /// both halves of the window agree within three standard errors. `None` under a drive that changes, if
    /// the run ended early, and if a motion that has not settled has fewer than 8 forcing periods.
    pub steady: Option<bool>,
    /// Time in s since which the motion repeats; `None` if it has no period.
    pub settles_at: Option<f64>,
    /// First events, under a drive that changes.
    pub firsts: Option<Firsts>,
    /// Share of the work that impacts took in the settled window; `None` without work or ledger.
    pub impact_share: Option<f64>,
    /// Share of the settled window spent at rest on a stop, or in contact with a compliant one.
    pub rested_share: Option<f64>,
    /// Crossings over the whole run.
    pub total_crossings: u64,
    /// Impacts over the whole run, counted as in [`impacts`](Self::impacts).
    pub total_impacts: u64,
    /// Chatters that were summed in closed form.
    pub chatter_sums: u64,
    /// Times the mass came to rest on a stop.
    pub rests: u64,
    /// Period in forcing periods of the orbit that attracts the motion; `None` if it does not repeat after at
    /// most 12 of them, if no orbit attracts it, or if the mass rests.
    pub period: Option<u32>,
    /// Largest force in N of a compliant stop on the mass over the whole run; `None` if the stops are
    /// not compliant.
    pub peak_contact_force: Option<f64>,
    /// Pressure in Pa at the middle of the contact under that force; `None` if the stop's material
    /// is unknown.
    pub peak_contact_pressure: Option<f64>,
    /// Whether the material yields at that pressure.
    pub contact_yields: bool,
    /// Output of the transducer; `None` without one.
    pub harvest: Option<Harvest>,
    /// How the run ended.
    pub outcome: Outcome,
    /// Steps of the integrator.
    pub steps: u64,
    /// Taylor expansions of the equation of motion.
    pub evaluations: u64,
    /// CPU time of the run in s.
    pub cpu_s: f64,
    /// Energy ledger, if it was requested.
    pub ledger: Option<Ledger>,
}

impl Summary {
    /// Whether regime and averages may be those of a transient: the motion has not settled, and it is not
    /// irregular (or with one well) with steady averages.
    pub fn is_transient(&self) -> bool {
        let irregular = matches!(self.regime, Regime::Irregular | Regime::OneWell);
        let chaotic = irregular && self.steady == Some(true);
        self.settled == Some(false) && !chaotic
    }

    /// Peak to peak displacement in the settled window in m; `None` if the run ended before it.
    pub fn travel(&self) -> Option<f64> {
        self.range.map(|(low, high)| high - low)
    }
}
