//! What a run returns: samples, events, statistics, outcome and ledger. All SI.

/// Whether the mass flies or is on a stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Between the stops, or touching one for an instant.
    Free,
    /// At rest on the left stop, or in contact with it where it is compliant.
    LeftStop,
    /// At rest on the right stop, or in contact with it where it is compliant.
    RightStop,
}

impl Phase {
    /// The word in the CSV.
    pub fn name(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::LeftStop => "left_stop",
            Self::RightStop => "right_stop",
        }
    }
}

/// The state at a requested time; at an event's instant, the state after it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time in s, as requested.
    pub t: f64,
    /// Displacement in m.
    pub x: f64,
    /// Velocity in m/s.
    pub v: f64,
    /// Acceleration of the base in m/s^2.
    pub base_accel: f64,
    /// Free or resting.
    pub phase: Phase,
}

impl Sample {
    /// Work of the base on the mass in a second, -m a_b v, in W; `mass` in kg. Its integral is the ledger's work.
    pub fn work_rate(&self, mass: f64) -> f64 {
        -mass * self.base_accel * self.v
    }
}

/// Left or right.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Negative x.
    Left,
    /// Positive x.
    Right,
}

impl Side {
    /// The side opposite.
    pub fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }

    /// The word in the CSV.
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventKind {
    /// A rebound from a stop.
    Impact,
    /// The mass came to rest on a stop.
    Rest,
    /// The mass left a stop on which it rested.
    Release,
    /// A passage of the barrier top.
    Crossing,
    /// The mass touched a compliant stop.
    Contact,
    /// The mass separated from a compliant stop.
    Separate,
}

impl EventKind {
    /// The word in the CSV.
    pub fn name(self) -> &'static str {
        match self {
            Self::Impact => "impact",
            Self::Rest => "rest",
            Self::Release => "release",
            Self::Crossing => "crossing",
            Self::Contact => "contact",
            Self::Separate => "separate",
        }
    }
}

/// One event of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// Time in s.
    pub t: f64,
    /// What happened.
    pub kind: EventKind,
    /// The stop, or the well entered.
    pub side: Side,
    /// Velocity before it in m/s, signed.
    pub v_in: f64,
    /// Velocity after it in m/s, signed.
    pub v_out: f64,
}

/// What the motion is over the settled window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regime {
    /// Never left the stop or the equilibrium.
    Rest,
    /// Moved without a crossing.
    Intrawell,
    /// Crosses, and the crossings repeat with a period of at most 12 forcing periods.
    Interwell,
    /// Crosses without such a period.
    Irregular,
    /// Crosses under a drive that has no period or another amplitude in each, or under none.
    Crossing,
    /// The curve has one well or none: nothing to cross.
    OneWell,
}

impl Regime {
    /// The word in the CSV; empty for one well.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rest => "rest",
            Self::Intrawell => "intrawell",
            Self::Interwell => "interwell",
            Self::Irregular => "irregular",
            Self::Crossing => "crossing",
            Self::OneWell => "",
        }
    }
}

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outcome {
    /// It reached its duration.
    Done,
    /// The mass left the range of the force curve at this time in s.
    LeftTable {
        /// Time in s.
        at: f64,
    },
    /// It used up its budget of impacts.
    ImpactBudget {
        /// Time in s.
        at: f64,
        /// Impacts made.
        count: u64,
    },
    /// It used up its budget of steps.
    StepBudget {
        /// Time in s.
        at: f64,
        /// Steps made.
        count: u64,
    },
    /// A number was no longer finite.
    NotFinite {
        /// Time in s.
        at: f64,
    },
    /// It reached its duration, but its energy does not balance: by more than a hundred tolerances, or by a tenth of what
    /// was moved. Only told of a run with a ledger.
    Inaccurate {
        /// What is unaccounted for over the sum of the magnitudes moved.
        residual: f64,
    },
    /// It was told to stop.
    Cancelled {
        /// Time in s.
        at: f64,
    },
}

impl Outcome {
    /// The word in the CSV and the summary.
    pub fn name(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::LeftTable { .. } => "left_table",
            Self::ImpactBudget { .. } => "impact_budget",
            Self::StepBudget { .. } => "step_budget",
            Self::NotFinite { .. } => "not_finite",
            Self::Inaccurate { .. } => "inaccurate",
            Self::Cancelled { .. } => "cancelled",
        }
    }

    /// Time in s at which the run ended early; none where it has reached its duration.
    pub fn ended_at(self) -> Option<f64> {
        match self {
            Self::Done | Self::Inaccurate { .. } => None,
            Self::LeftTable { at }
            | Self::ImpactBudget { at, .. }
            | Self::StepBudget { at, .. }
            | Self::NotFinite { at }
            | Self::Cancelled { at } => Some(at),
        }
    }
}

/// Where the energy went over the whole run, each term integrated on its own.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ledger {
    /// Work of the base on the mass in J.
    pub work_j: f64,
    /// Taken by damping in J.
    pub damping_j: f64,
    /// Taken by impacts in J, the loss of compliant stops among them.
    pub impact_j: f64,
    /// Change of kinetic energy and potential in J.
    pub stored_j: f64,
    /// work - damping - impact - stored in J.
    pub residual_j: f64,
    /// |residual| over the sum of the magnitudes moved; 0 where nothing moved.
    pub energy_residual: f64,
}

/// On which side of the barrier top a motion is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Never to the right of it.
    Left,
    /// Never to the left of it.
    Right,
    /// On both sides.
    Both,
}

impl Place {
    /// The word in the CSV.
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
            Self::Both => "both",
        }
    }
}

/// When something happened first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct First {
    /// Time in s.
    pub t: f64,
    /// Size of the amplitude of the base's acceleration then in m/s^2, where the drive is one amplitude ramp.
    pub amplitude: Option<f64>,
}

/// What happened first in a run under a drive that changes: an amplitude ramp, a chirp, noise, a record, tones without a
/// common period.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Firsts {
    /// The mass left a stop on which it rested.
    pub release: Option<First>,
    /// It crossed the barrier.
    pub crossing: Option<First>,
    /// From this crossing on it crossed in every forcing period up to the end of the run; none where the drive has none.
    pub crossing_in_every_period: Option<First>,
}

/// Statistics of a run; those of the settled window come first.
#[derive(Debug, Clone, Copy, PartialEq)]
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
    /// Impacts in the settled window; the contacts of a compliant stop are impacts too.
    pub impacts: u64,
    /// Speed in m/s of the fastest impact in the settled window; none without one.
    pub impact_speed_max: Option<f64>,
    /// Releases in the settled window.
    pub releases: u64,
    /// Largest |x| in the settled window in m; none where the run ended before it.
    pub max_abs_x: Option<f64>,
    /// Smallest and largest displacement in the settled window in m; none where the run ended before it.
    pub range: Option<(f64, f64)>,
    /// Mean displacement over the settled window in m; none where the run ended before it, or no ledger was asked for.
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
    /// Whether the motion has settled: it repeats, or it is irregular, at least 200 forcing periods old, and RMS velocity and
    /// crossings in both halves of the window agree within three standard errors. Without a drive, whether it is at rest.
    /// None under a drive that changes.
    pub settled: Option<bool>,
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
    /// Impacts over the whole run, those inside closed-form sums not counted.
    pub total_impacts: u64,
    /// Chatters that were summed in closed form.
    pub chatter_sums: u64,
    /// Times the mass came to rest on a stop.
    pub rests: u64,
    /// Period of the response in forcing periods; none where it has none up to 12.
    pub period: Option<u32>,
    /// Largest force in N of a compliant stop on the mass over the whole run; none where the stops are not compliant.
    pub peak_contact_force: Option<f64>,
    /// Pressure in Pa at the middle of the contact under that force; none where the stop's material is not known.
    pub peak_contact_pressure: Option<f64>,
    /// Whether that pressure is one at which the material yields.
    pub contact_yields: bool,
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
    /// Peak to peak displacement in the settled window in m; none where the run ended before it.
    pub fn travel(&self) -> Option<f64> {
        self.range.map(|(low, high)| high - low)
    }
}

/// Everything a run returns.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// The state at the requested times, up to the end of the run.
    pub samples: Vec<Sample>,
    /// Events in order of time, where they were asked for.
    pub events: Vec<Event>,
    /// Statistics, outcome and ledger.
    pub summary: Summary,
}
