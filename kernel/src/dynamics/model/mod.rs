//! Model: a scene prepared for a run, in SI and checked, with all that the integrator needs.

mod characteristic;
mod describe;
pub(crate) mod excitation;
mod read;
pub(crate) mod scales;
mod start;
pub(crate) mod stops;
pub(crate) mod transducer;

use std::sync::Arc;

use crate::dynamics::result::Side;
use crate::mechanics::{Hertz, Mechanism};
use crate::numeric::elementary;
use crate::scene::{self, Damping, Fault, Scene, Start};
use excitation::{ExcitationParts, Rhythm};
pub use read::Beginning;
use scales::{Scales, scales};
use start::start_state;
use stops::{StopAt, StopPair};
use transducer::Transducer;

/// Maximum number of periods of the fastest tone that the clock counts exactly, about 2^53.
pub(in crate::dynamics) const MAX_PERIODS: f64 = 9e15;

/// Number of halvings of the duration at which an excitation that begins at 0 is searched for its first
/// nonzero acceleration.
const PROBES: i32 = 60;

/// A scene prepared for a run.
///
/// It holds all quantities in SI units, the force curve and the excitation as they are integrated, and
/// nothing is left to check: [`build`](Self::build) gives all faults of a scene at once. [`run`](Self::run)
/// takes one run, [`run_together`](Self::run_together) many side by side with the same bits. A program that
/// starts from a scene file has it from `questions::Simulation`.
#[derive(Debug, Clone)]
pub struct Model {
    pub(in crate::dynamics) mass: f64,
    /// Damping coefficient of the mechanism alone.
    pub(in crate::dynamics) damping: f64,
    pub(in crate::dynamics) transducer: Option<Transducer>,
    /// Shared between the cells of a sweep.
    pub(in crate::dynamics) mechanism: Arc<Mechanism>,
    pub(in crate::dynamics) duration: f64,
    pub(in crate::dynamics) forcing_period: Option<f64>,
    pub(in crate::dynamics) scales: Scales,
    pub(in crate::dynamics) tolerance: f64,
    pub(in crate::dynamics) recurrence: bool,
    pub(in crate::dynamics) settle: f64,
    pub(in crate::dynamics) stops: Option<StopPair>,
    pub(in crate::dynamics) compliant: Option<Hertz>,
    pub(in crate::dynamics) excitation: ExcitationParts,
    pub(in crate::dynamics) start: (f64, f64),
    /// Electrical state at the start in A or V; 0 without one.
    pub(in crate::dynamics) start_electrical: f64,
    /// Whether the mass is at rest in an equilibrium and nothing moves it.
    pub(in crate::dynamics) motionless: bool,
    /// Displacement at which crossings are counted.
    pub(in crate::dynamics) crossing_level: Option<f64>,
    pub(in crate::dynamics) one_well: bool,
    /// Cycles of the clock in a forcing period.
    pub(in crate::dynamics) cycles_per_period: i64,
    pub(in crate::dynamics) rhythm: Rhythm,
    /// Phase of the drive at the start in turns: the argument of a sine, 0 for a sum.
    pub(in crate::dynamics) start_phase: f64,
}

/// The faults of a scene, except those of its sweep, which a model does not use.
fn faults_of_check(scene: &Scene) -> Vec<Fault> {
    let mut faults = scene::check(scene).faults;
    faults.retain(|fault| !fault.field.starts_with("sweep"));
    faults
}

/// The value; for a fault, adds it to `faults` and returns the default value.
fn value_or_fault<T: Default>(value: Result<T, Fault>, faults: &mut Vec<Fault>) -> T {
    value.unwrap_or_else(|fault| {
        faults.push(fault);
        T::default()
    })
}

/// Damping coefficient in N s/m of the mechanism with this mass in kg.
fn damping_coefficient(scene: &Scene, mechanism: &Mechanism, mass: f64) -> Result<f64, Fault> {
    let xi = match scene.damping {
        Damping::None => return Ok(0.0),
        Damping::Coefficient { c_n_s_per_m } => return Ok(c_n_s_per_m),
        Damping::Ratio(xi) => xi,
    };
    let Some(k) = mechanism.damping_stiffness() else {
        let problem = "a damping ratio needs a stable equilibrium with a stiffness above 0, and this \
                       mechanism has none; use Coefficient(c_n_s_per_m: ..) instead";
        return Err(Fault::new("damping.xi", xi.to_string(), problem));
    };
    let c = 2.0 * xi * (k * mass).sqrt();
    if !c.is_finite() {
        let problem = format!(
            "makes no finite damping coefficient with the stiffness {k:e} N/m of the equilibrium; use \
             Coefficient(c_n_s_per_m: ..) instead"
        );
        return Err(Fault::new("damping.xi", xi.to_string(), problem));
    }
    Ok(c)
}

impl Model {
    /// Converts a scene that has passed its check. Returns all faults that can only be found here (no
    /// equilibrium to rest at, a damping ratio without a stable equilibrium, a start beyond a stop or the
    /// curve), and those of the check if a number of the scene is out of range.
    pub fn build(scene: &Scene, mechanism: Arc<Mechanism>) -> Result<Self, Vec<Fault>> {
        let mut faults = Vec::new();
        let mass = scene.mass_g / 1e3;
        let landscape = &mechanism.landscape;
        let damping = value_or_fault(damping_coefficient(scene, &mechanism, mass), &mut faults);
        let transducer = Transducer::of(&scene.transducer, mass);
        if transducer.is_some_and(|transducer| !transducer.is_finite()) {
            let piezoelectric = matches!(scene.transducer, scene::Transducer::Piezoelectric { .. });
            let value = if piezoelectric { "Piezoelectric(..)" } else { "Electromagnetic(..)" };
            let problem = "its rates, damping or power are not finite with this mass; give numbers closer to \
                           those of a real transducer";
            faults.push(Fault::new("transducer", value, problem));
        }
        let stops = StopPair::of(&scene.stops);
        let compliant = Hertz::of(&scene.stops);
        let start = value_or_fault(start_state(scene, &mechanism, stops, compliant), &mut faults);
        let drive = value_or_fault(ExcitationParts::new(&scene.excitation, mass), &mut faults);
        let periods = drive.fastest().unwrap_or(0.0) * scene.run.duration_s;
        if periods > MAX_PERIODS {
            let problem = format!(
                "makes {periods:e} periods of the excitation; at most {MAX_PERIODS:e} can be counted: \
                 shorten the run or lower the frequency"
            );
            faults.push(Fault::new("run.duration_s", scene.run.duration_s.to_string(), problem));
        }
        if !faults.is_empty() {
            // a number that is not finite may have caused them: report it first
            return Err(faults_of_check(scene).into_iter().chain(faults).collect());
        }
        let common = drive.common_cycles();
        let forcing_period = drive.fastest().and_then(|f| common.map(|cycles| cycles as f64 / f));
        let barrier = landscape.barrier.as_ref();
        let start_electrical = match scene.start {
            Start::At { electrical, .. } => electrical,
            Start::Rest => 0.0,
        };
        let circuit = transducer.and_then(|transducer| transducer.circuit);
        let charged = circuit.map_or(0.0, |circuit| circuit.state(start_electrical));
        // A charge can give the mass as much energy as a speed does.
        let fastest = (start.0, start.1.abs().max(charged.abs()));
        let scales = scales(scene, mass, &mechanism, &drive, fastest, (stops, compliant));
        let on_a_stop = stops
            .is_some_and(|pair| [pair.left, pair.right].into_iter().flatten().any(|stop| stop.x == start.0));
        let motionless = scene.start == Start::Rest && !on_a_stop && drive.is_still();
        let mut model = Self {
            mass,
            damping,
            transducer,
            duration: scene.run.duration_s,
            forcing_period,
            scales,
            tolerance: scene.run.tolerance,
            recurrence: scene.run.recurrence,
            settle: scene.run.settle_s.unwrap_or(scene.run.duration_s * 0.5),
            stops,
            compliant,
            rhythm: drive.rhythm(common),
            excitation: drive,
            start,
            start_electrical,
            motionless,
            crossing_level: landscape.crossing_position(),
            one_well: barrier.is_none(),
            cycles_per_period: common.map_or(0, |c| c as i64),
            start_phase: scene.harmonic().map_or(0.0, |drive| drive.phase_deg.rem_euclid(360.0) / 360.0),
            mechanism,
        };
        model.choose_barrier();
        // The full check runs only if there is a fault: a sweep builds a model for each cell.
        let faults = if scene::is_sound(scene) { Vec::new() } else { faults_of_check(scene) };
        if faults.is_empty() { Ok(model) } else { Err(faults) }
    }

    /// If two barriers are equally near to x = 0, counts crossings at the one on the side of the start; if
    /// the mass starts at x = 0 without speed, at the one towards which the base first pushes it. If nothing
    /// pushes it there, no crossing is counted.
    fn choose_barrier(&mut self) {
        let Some(left) = self.mechanism.landscape.left_barrier else { return };
        let pushes = || {
            let times = (0..=PROBES).rev().map(|halvings| self.duration * elementary::powi(0.5, halvings));
            std::iter::once(0.0).chain(times).map(|t| -self.excitation.at(t))
        };
        let towards = [self.start.0, self.start.1].into_iter().chain(pushes()).find(|side| *side != 0.0);
        self.crossing_level = match towards {
            Some(side) if side < 0.0 => Some(left),
            None if self.excitation.is_still() => None,
            _ => self.crossing_level,
        };
    }

    /// Positions of the left and the right stop in m, if there are any.
    pub fn stop_positions(&self) -> (Option<f64>, Option<f64>) {
        let (left, right) = self.sides();
        (left.map(|stop| stop.x), right.map(|stop| stop.x))
    }

    /// The stop on a side, if there is one.
    pub fn stop(&self, side: Side) -> Option<StopAt> {
        let (left, right) = self.sides();
        if side == Side::Left { left } else { right }
    }

    /// The left and the right stop, if there are any.
    pub(in crate::dynamics) fn sides(&self) -> (Option<StopAt>, Option<StopAt>) {
        let StopPair { left, right } = self.stops.unwrap_or_default();
        (left, right)
    }

    /// Kinetic and potential energy in J at a displacement in m and a velocity in m/s. The potential is 0 at
    /// x = 0 and includes the energy stored in a compliant stop.
    pub fn energies(&self, x: f64, v: f64) -> (f64, f64) {
        let potential = self.mechanism.curve.potential(x);
        let pressed = self.compliant.zip(self.pressed_depth(x)).map(|(stop, (depth, _))| stop.energy(depth));
        (0.5 * self.mass * v * v, pressed.map_or(potential, |stored| potential + stored))
    }

    /// Depth in m to which a mass at `x` in m presses into a stop, and whether that is the right stop; `None`
    /// if it is in neither.
    pub fn pressed_depth(&self, x: f64) -> Option<(f64, bool)> {
        let (left, right) = self.stop_positions();
        let right = right.map(|stop| (x - stop, true));
        left.map(|stop| (stop - x, false)).into_iter().chain(right).find(|(depth, _)| *depth > 0.0)
    }

    /// Whether the mirror image of a free motion is a motion of the same model with mirrored crossings.
    pub(crate) fn is_symmetric(&self) -> bool {
        self.is_odd() && self.crossing_level.is_none_or(|level| level == 0.0)
    }

    /// Whether the mirror image of a free motion is a motion of the same model: an odd curve, equal stops on
    /// both sides.
    fn is_odd(&self) -> bool {
        let alike = match self.sides() {
            (Some(left), Some(right)) => right == StopAt { x: -left.x, ..left },
            (None, None) => true,
            _ => false,
        };
        alike && self.mechanism.curve.is_odd()
    }

    /// Whether the mirror image of a motion, half a forcing period later, is a motion too. The drive is
    /// mirrored after that time if each of its tones makes an odd number of turns in the period.
    pub fn mirrors_in_half_a_period(&self) -> bool {
        let ExcitationParts { constant, tones, .. } = &self.excitation;
        let odd = |period: f64| tones.iter().all(|tone| (tone.frequency * period).round() % 2.0 == 1.0);
        self.is_odd() && *constant == 0.0 && self.repeats() && self.forcing_period.is_some_and(odd)
    }

    /// Whether the base moves.
    pub fn is_shaken(&self) -> bool {
        !self.excitation.is_still()
    }

    /// Number of whole forcing periods in the settled window, and the clock's cycles in one period.
    pub fn window_periods(&self) -> (u64, i64) {
        match self.forcing_period {
            Some(period) => {
                let n = ((self.duration - self.settle) / period + 1e-9).floor();
                (n.max(0.0) as u64, self.cycles_per_period)
            }
            None => (0, 0),
        }
    }

    /// Time in s at which the last amplitude ramp of the drive ends; `None` without a ramp.
    pub fn ramp_end(&self) -> Option<f64> {
        self.excitation.tones.iter().filter_map(|tone| tone.ramp.map(|ramp| ramp.1)).reduce(f64::max)
    }

    /// Whether the drive repeats: a sine, or several with a common period.
    pub fn repeats(&self) -> bool {
        self.rhythm == Rhythm::Periodic
    }

    /// Whether a run may continue until the motion repeats: the drive repeats, and the settled window holds
    /// at least two periods of it.
    pub fn can_settle(&self) -> bool {
        self.repeats() && self.window_periods().0 >= 2
    }
}
