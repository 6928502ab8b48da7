//! The scene as run: SI units, checked, everything the integrator needs.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::base::BaseMotion;
use super::regime::Rhythm;
use super::result::Run;
use super::scales::{Landmarks, Scales};
use crate::mechanics::{Hertz, Mechanism};
use crate::numeric::DoubleDouble;
use crate::scene::{Damping, Fault, Scene, Start, Stops};

/// The most periods of the fastest tone that the clock counts exactly, about 2^53.
const MOST_PERIODS: f64 = 9e15;

/// A scene as run.
#[derive(Debug, Clone)]
pub struct Model {
    /// Proof mass in kg.
    pub mass: f64,
    /// Damping coefficient in N s/m.
    pub damping: f64,
    /// The mechanism, shared between the cells of a sweep.
    pub mechanism: Arc<Mechanism>,
    /// Duration in s.
    pub duration: f64,
    /// Period of the drive in s, where it has one.
    pub forcing_period: Option<f64>,
    /// Length, speed and time that the tolerance is relative to.
    pub scales: Scales,
    /// Local error allowed, relative to the scales.
    pub tolerance: f64,
    /// Whether a run may be completed from a cycle that comes back exactly.
    pub recurrence: bool,
    pub(crate) settle: f64,
    pub(crate) stops: Option<StopPair>,
    /// What the stops are made of, where they are compliant.
    pub compliant: Option<Hertz>,
    pub(crate) drive: BaseMotion,
    pub(crate) start: (f64, f64),
    /// At rest in an equilibrium with nothing to move it.
    pub(crate) motionless: bool,
    /// Where a crossing is counted.
    pub(crate) crossing_level: Option<f64>,
    pub(crate) one_well: bool,
    /// Cycles of the clock in a forcing period.
    cycles_per_period: i64,
    pub(super) rhythm: Rhythm,
}

/// The stops of a scene; a side without one is open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StopPair {
    pub left: Option<StopAt>,
    pub right: Option<StopAt>,
}

/// One stop. SI. A compliant one takes energy by its own law and has the restitution 1 here.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StopAt {
    pub x: f64,
    pub restitution: f64,
}

/// What a run should keep.
#[derive(Debug, Clone, Copy, Default)]
pub struct Request<'a> {
    /// Times in s at which to sample, ascending, within 0..=duration.
    pub sample_times: &'a [f64],
    /// Whether to keep the list of events.
    pub events: bool,
    /// Whether to keep the energy ledger (a sweep does not need it).
    pub ledger: bool,
    /// Set from elsewhere to end the run early with the outcome `Cancelled`.
    pub cancel: Option<&'a AtomicBool>,
    /// Goes on, window after window, until the motion repeats or the next window would end after this time in s. Under a
    /// drive that does not repeat, and where the window holds less than two forcing periods, nothing changes.
    pub until_settled: Option<f64>,
}

fn fault(field: &str, value: impl ToString, problem: impl Into<String>) -> Fault {
    Fault { field: field.into(), value: value.to_string(), problem: problem.into() }
}

impl Model {
    /// Converts a scene that has passed its check; faults that only show here (no equilibrium to rest
    /// at, a ratio without a stable equilibrium, a start beyond a stop or the curve) are all reported.
    pub fn build(scene: &Scene, mechanism: Arc<Mechanism>) -> Result<Self, Vec<Fault>> {
        let mut faults = Vec::new();
        let mass = scene.mass_g / 1e3;
        let landscape = &mechanism.landscape;
        let damping = match scene.damping {
            Damping::None => 0.0,
            Damping::Coefficient { c_n_s_per_m } => c_n_s_per_m,
            Damping::Ratio(xi) => match mechanism.damping_stiffness() {
                Some(k) => {
                    let c = 2.0 * xi * (k * mass).sqrt();
                    if !c.is_finite() {
                        let problem = format!(
                            "makes no finite damping coefficient with the stiffness {k:e} N/m of the equilibrium; use \
                             Coefficient(c_n_s_per_m: ..) instead"
                        );
                        faults.push(fault("damping.xi", xi, problem));
                    }
                    c
                }
                None => {
                    faults.push(fault(
                        "damping.xi",
                        xi,
                        "a damping ratio needs a stable equilibrium with a stiffness above 0, and this \
                         mechanism has none; use Coefficient(c_n_s_per_m: ..) instead",
                    ));
                    0.0
                }
            },
        };
        let stops = stop_pair(&scene.stops);
        let compliant = Hertz::of(&scene.stops);
        let start = match start_state(scene, &mechanism, stops.as_ref(), compliant.as_ref()) {
            Ok(start) => start,
            Err(found) => {
                faults.push(found);
                (0.0, 0.0)
            }
        };
        let drive = BaseMotion::new(&scene.excitation).unwrap_or_else(|found| {
            faults.push(found);
            BaseMotion::default()
        });
        let periods = drive.fastest().unwrap_or(0.0) * scene.run.duration_s;
        if periods > MOST_PERIODS {
            faults.push(fault(
                "run.duration_s",
                scene.run.duration_s,
                format!(
                    "makes {periods:e} periods of the excitation; at most {MOST_PERIODS:e} can be counted: \
                     shorten the run or lower the frequency"
                ),
            ));
        }
        if !faults.is_empty() {
            return Err(faults);
        }
        let common = drive.common_cycles();
        let forcing_period = drive.fastest().and_then(|f| common.map(|cycles| cycles as f64 / f));
        let barrier = landscape.barrier.as_ref();
        let crossing_level = landscape.crossing_position();
        let scales = scales(scene, mass, &mechanism, &drive, start, (stops, compliant));
        let (left, right) = (stops.and_then(|s| s.left), stops.and_then(|s| s.right));
        let on_a_stop = left.is_some_and(|s| s.x == start.0) || right.is_some_and(|s| s.x == start.0);
        let motionless = scene.start == Start::Rest && !on_a_stop && drive.is_still();
        Ok(Self {
            mass,
            damping,
            duration: scene.run.duration_s,
            forcing_period,
            scales,
            tolerance: scene.run.tolerance,
            recurrence: scene.run.recurrence,
            settle: scene.run.settle_s.unwrap_or(scene.run.duration_s * 0.5),
            stops,
            compliant,
            rhythm: drive.rhythm(common),
            drive,
            start,
            motionless,
            crossing_level,
            one_well: barrier.is_none(),
            cycles_per_period: common.map_or(0, |c| c as i64),
            mechanism,
        })
    }

    /// Runs the model once.
    ///
    /// Returns samples, events and statistics in SI. Never fails: a run that cannot go on says so in its
    /// outcome. The result does not depend on what is asked for or on threads.
    pub fn run(&self, request: &Request) -> Run {
        super::prepare::run::<f64>(self, request, self.tolerance, self.recurrence)
    }

    /// Runs several models with nothing listed, many at once where the processor can: what [`run`](Self::run) gives for
    /// each, bit for bit, in their order; `until_settled` as in [`Request`]. The CPU time of all is shared evenly between them.
    pub fn run_all(models: &[Self], until_settled: Option<f64>, cancel: Option<&AtomicBool>) -> Vec<Run> {
        super::lanes::run_all(models, &Request { cancel, until_settled, ..Request::default() }, usize::MAX)
    }

    /// [`run_all`](Self::run_all) in 4, 8 or 16 lanes, for tests; none where the processor has not so many.
    #[doc(hidden)]
    pub fn run_all_in_lanes(models: &[Self], width: usize) -> Option<Vec<Run>> {
        let run = || super::lanes::run_all(models, &Request::default(), width);
        super::lanes::has_lanes(width).then(run)
    }

    /// Runs the model once in double-double arithmetic, some 31 digits, with its own `tolerance` (1e-28 is
    /// sensible): the reference that a run in doubles is measured against. About a hundred times slower; nothing of it is
    /// completed from a cycle.
    pub fn run_reference(&self, request: &Request, tolerance: f64) -> Run {
        super::prepare::run::<DoubleDouble>(self, request, tolerance, false)
    }

    /// Positions of the left and the right stop in m, where there are any.
    pub fn stop_positions(&self) -> (Option<f64>, Option<f64>) {
        let at = |stop: Option<StopAt>| stop.map(|stop| stop.x);
        self.stops.map_or((None, None), |pair| (at(pair.left), at(pair.right)))
    }

    /// Kinetic energy and potential in J at a displacement in m and a velocity in m/s; the potential is 0 at x = 0 and
    /// holds what a compliant stop stores.
    pub fn energies(&self, x: f64, v: f64) -> (f64, f64) {
        let potential = self.mechanism.curve.potential(x);
        let pressed = self.compliant.zip(self.pressed_depth(x)).map(|(own, (depth, _))| own.energy(depth));
        (0.5 * self.mass * v * v, pressed.map_or(potential, |stored| potential + stored))
    }

    /// How deep in m a mass at `x` in m has pressed a stop in, and whether that is the right one; none outside both.
    pub fn pressed_depth(&self, x: f64) -> Option<(f64, bool)> {
        let (left, right) = self.stop_positions();
        let right = right.map(|stop| (x - stop, true));
        left.map(|stop| (stop - x, false)).into_iter().chain(right).find(|(depth, _)| *depth > 0.0)
    }

    /// Whether the mirror image of a free motion is one, and crosses where the motion does: an odd curve, stops alike on
    /// both sides.
    pub(crate) fn is_symmetric(&self) -> bool {
        let (left, right) = self.stops.map_or((None, None), |pair| (pair.left, pair.right));
        let alike = match (left, right) {
            (Some(left), Some(right)) => left.x == -right.x && left.restitution == right.restitution,
            (None, None) => true,
            _ => false,
        };
        alike && self.mechanism.curve.is_odd() && self.crossing_level.is_none_or(|level| level == 0.0)
    }

    /// Whether the base moves at all.
    pub fn is_shaken(&self) -> bool {
        !self.drive.is_still()
    }

    /// Begin of the settled window in s.
    pub fn settle(&self) -> f64 {
        self.settle
    }

    /// Acceleration of the base in m/s^2 at time `t` in s.
    pub fn base_acceleration(&self, t: f64) -> f64 {
        super::prepare::base_acceleration(self, t)
    }

    /// Whole forcing periods in the settled window, and the clock's cycles in one.
    pub(crate) fn window_periods(&self) -> (u64, i64) {
        match self.forcing_period {
            Some(period) => {
                let n = ((self.duration - self.settle) / period + 1e-9).floor();
                (n.max(0.0) as u64, self.cycles_per_period)
            }
            None => (0, 0),
        }
    }

    /// Time in s at which the last amplitude ramp of the drive ends; none without one.
    pub fn ramp_end(&self) -> Option<f64> {
        self.drive.tones.iter().filter_map(|tone| tone.ramp.map(|ramp| ramp.1)).reduce(f64::max)
    }

    /// Whether the drive repeats: a sine, or several with a common period.
    pub fn repeats(&self) -> bool {
        self.rhythm == Rhythm::Periodic
    }

    /// Whether a run may go on until the motion repeats: the drive does, and the settled window holds two periods of it.
    pub fn can_settle(&self) -> bool {
        self.repeats() && self.window_periods().0 >= 2
    }

    /// The model in words: a line for each thing that is modelled, then what is left out.
    pub fn describe(&self) -> Vec<String> {
        super::describe::describe(self)
    }
}

fn stop_pair(stops: &Stops) -> Option<StopPair> {
    let at = |mm: f64, sign: f64, restitution: f64| Some(StopAt { x: sign * (mm / 1e3), restitution });
    match *stops {
        Stops::None => None,
        Stops::Hertz { travel_limit_mm, .. } => {
            let [left, right] = [-1.0, 1.0].map(|sign| at(travel_limit_mm, sign, 1.0));
            Some(StopPair { left, right })
        }
        Stops::Rigid { travel_limit_mm, restitution } => {
            let [left, right] = [-1.0, 1.0].map(|sign| at(travel_limit_mm, sign, restitution));
            Some(StopPair { left, right })
        }
        Stops::Uneven { left_mm, right_mm, restitution_left, restitution_right } => {
            let of = |own: Option<f64>, other: Option<f64>| own.or(other).unwrap_or(1.0);
            Some(StopPair {
                left: left_mm.and_then(|mm| at(mm, -1.0, of(restitution_left, restitution_right))),
                right: right_mm.and_then(|mm| at(mm, 1.0, of(restitution_right, restitution_left))),
            })
        }
    }
}

fn start_state(
    scene: &Scene,
    mechanism: &Mechanism,
    stops: Option<&StopPair>,
    compliant: Option<&Hertz>,
) -> Result<(f64, f64), Fault> {
    let (left, right) = (stops.and_then(|s| s.left), stops.and_then(|s| s.right));
    let domain = mechanism.curve.domain();
    match scene.start {
        Start::Rest => {
            let Some(equilibrium) = mechanism.landscape.right_stable() else {
                return Err(fault(
                    "start",
                    "Rest",
                    "this mechanism has no stable equilibrium to rest at; use At(x_mm: .., v_m_per_s: ..)",
                ));
            };
            let mut x = equilibrium.x;
            if let Some(stop) = right {
                x = x.min(stop.x);
            }
            if let Some(stop) = left {
                x = x.max(stop.x);
            }
            if let Some(hertz) = compliant.filter(|_| x != equilibrium.x) {
                x = pressed_in(mechanism, hertz, x, equilibrium.x);
            }
            Ok((x, 0.0))
        }
        Start::At { x_mm, v_m_per_s } => {
            let x = x_mm / 1e3;
            if let Some(stop) = right.filter(|s| x > s.x).or(left.filter(|s| x < s.x)) {
                return Err(fault(
                    "start.x_mm",
                    x_mm,
                    format!("lies beyond the stop at {} mm; start between the stops", stop.x * 1e3),
                ));
            }
            if x < domain.0 || x > domain.1 {
                return Err(fault(
                    "start.x_mm",
                    x_mm,
                    format!(
                        "lies outside the force curve, which is known from {} to {} mm",
                        domain.0 * 1e3,
                        domain.1 * 1e3
                    ),
                ));
            }
            Ok((x, v_m_per_s))
        }
    }
}

/// Where a mass rests that the mechanism presses on the compliant stop at `surface` towards the equilibrium at
/// `equilibrium` beyond it, in m: where the stop's force is the mechanism's. The two meet between the surface, where the
/// mechanism alone presses, and the equilibrium, where it does not.
fn pressed_in(mechanism: &Mechanism, hertz: &Hertz, surface: f64, equilibrium: f64) -> f64 {
    let sign = (equilibrium - surface).signum();
    let pressed = |depth: f64| -sign * mechanism.curve.force(surface + sign * depth);
    let excess = |depth: f64| hertz.stiffness * depth * depth.sqrt() - pressed(depth);
    let (mut low, mut high) = (0.0, (equilibrium - surface).abs());
    // The depth is far less than the way to the equilibrium: halve its logarithm first.
    let near = hertz.static_depth(pressed(0.0).max(0.0));
    for guess in [0.5 * near, 2.0 * near] {
        if guess > low && guess < high {
            *(if excess(guess) > 0.0 { &mut high } else { &mut low }) = guess;
        }
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        *(if excess(middle) > 0.0 { &mut high } else { &mut low }) = middle;
    }
    surface + sign * high
}

fn scales(
    scene: &Scene,
    mass: f64,
    mechanism: &Mechanism,
    drive: &BaseMotion,
    start: (f64, f64),
    (stops, compliant): (Option<StopPair>, Option<Hertz>),
) -> Scales {
    let landscape = &mechanism.landscape;
    let curve = &mechanism.curve;
    let mut stiffness: f64 = 0.0;
    let mut reference = 0.0;
    let mut half_distance = 0.0;
    match (&landscape.barrier, landscape.equilibria.as_slice()) {
        (Some(barrier), equilibria) => {
            reference = barrier.x;
            half_distance = 0.5 * (barrier.right_well - barrier.left_well);
            for e in equilibria {
                if e.x == barrier.left_well || e.x == barrier.right_well {
                    stiffness = stiffness.max(landscape.inner_stiffness(e).abs());
                } else if e.x == barrier.x {
                    stiffness = stiffness.max(e.stiffness_left.abs()).max(e.stiffness_right.abs());
                }
            }
        }
        (None, [single]) => {
            reference = single.x;
            stiffness = single.stiffness_left.abs().max(single.stiffness_right.abs());
        }
        (None, _) => {}
    }
    if !(stiffness > 0.0 && stiffness.is_finite()) {
        stiffness = curve.stiffness(start.0).abs();
    }
    let landmarks = Landmarks {
        stiffness_over_mass: stiffness / mass,
        half_distance,
        start_distance: (start.0 - reference).abs(),
        start_speed: start.1.abs(),
        start_acceleration: curve.force(start.0).abs() / mass,
        drive: drive.parts(),
        duration: scene.run.duration_s,
        room: None,
    };
    let open = Scales::new(&landmarks);
    let Some(StopPair { left: Some(left), right: Some(right) }) = stops else { return open };
    // A compliant stop leaves as much more as the mass could press it in, even without its loss.
    let depth = compliant.map_or(0.0, |own| Hertz { loss: 0.0, ..own }.depth(mass, open.speed));
    let room = 0.5 * (right.x - left.x) + depth;
    Scales::new(&Landmarks { room: Some(room), ..landmarks })
}
