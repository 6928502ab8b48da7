//! Scales of a scene: the length, speed and time to which the tolerance is relative.
//!
//! The rule is covariant under a change of units. It uses mechanism, drive and start alone, since a stop that
//! is never reached must not change a bit of the result:
//!
//! - rate w: the square root of the largest stiffness magnitude over mass among the wells' inner sides and
//!   the barrier (one well: at the well; none: at the start); without stiffness the drive's fastest tone;
//!   without both, sqrt(acceleration over length), or speed over length. The inner side of a well that lies
//!   beyond a kink is the slope just inside the kink, as for a damping ratio: flexures rest a few um beyond
//!   their kink, where the stiffness is 30 times as large, and the scales must not jump when a slider moves
//!   the well across the kink;
//! - length L: the largest of half the distance between the wells, the start's distance from the barrier (or
//!   the single equilibrium, or 0), start speed over w, and the sum over the parts of the drive of amplitude
//!   over w and the larger of w and the rate of the part (the first kick of a fast part moves the mass as
//!   far as that);
//! - speed L w, time 1/w.
//!
//! Two stops that leave the mass less than a hundredth of L are a tighter bound than L: the mass soon meets
//! one of them, or it rests. L then decreases with that room, and equals the room if that is at most a
//! ten-thousandth of L; w rises to the rate at which drive and start speed move the mass by the new L.

use super::excitation::ExcitationParts;
use super::stops::StopPair;
use crate::mechanics::{Hertz, Mechanism};
use crate::numeric::elementary;
use crate::scene::Scene;

/// Impacts slower than this share of the speed scale are not counted and may be part of a chatter that is
/// summed in closed form. It is far above rounding and far below the slowest impact visible in a trace.
pub(in crate::dynamics) const MIN_IMPACT: f64 = 1e-6;

/// Length in m, speed in m/s, time in s; all above 0 and finite.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Scales {
    /// Length in m.
    pub length: f64,
    /// Speed in m/s.
    pub speed: f64,
    /// Time in s.
    pub time: f64,
    /// The longest step of the integrator in s, at high and at low order: some radians of the rate, or the
    /// whole run if nothing sets a rate.
    pub(crate) longest_step: (f64, f64),
}

/// The longest step in units of the time scale, at high and at low order. It limits only motions far smaller
/// than the length, since the tolerance is relative to the length. At high order a longer step would add
/// rounding errors. At low order the limit keeps the series of an oscillation accurate relative to its size
/// (at order 16 to 3^17/17! = 4e-7), so that small motions are accurate too.
const LONGEST_STEP: (f64, f64) = (8.0, 3.0);

/// Largest ratio of the length to the room between the stops.
const MAX_LENGTH_OVER_ROOM: f64 = 100.0;

/// The input of the rule. All SI, magnitudes.
#[derive(Debug, Clone, Default)]
pub(crate) struct Landmarks {
    /// Largest stiffness magnitude over mass, 1/s^2.
    pub stiffness_over_mass: f64,
    /// Half the distance between the wells, m; 0 without a pair.
    pub half_distance: f64,
    /// Distance of the start from the reference point, m.
    pub start_distance: f64,
    /// Start speed, m/s.
    pub start_speed: f64,
    /// Acceleration by the mechanism at the start, m/s^2.
    pub start_acceleration: f64,
    /// Amplitude in m/s^2 and angular frequency in 1/s of each part of the drive; the frequency 0 means none.
    pub drive: Vec<(f64, f64)>,
    /// Duration of the run in s.
    pub duration: f64,
    /// Half of the distance that two stops leave the mass, m; `None` if a side is open.
    pub room: Option<f64>,
}

impl Scales {
    pub(crate) fn new(l: &Landmarks) -> Self {
        let stiff = l.stiffness_over_mass.sqrt();
        let usable = |x: f64| x.is_finite() && x > 0.0;
        let driven: f64 = l.drive.iter().map(|part| part.0).sum();
        let reach = |rate: f64| -> f64 { l.drive.iter().map(|(a, w)| a / (rate * rate.max(*w))).sum() };
        let fastest = l.drive.iter().map(|part| part.1).fold(0.0, f64::max);
        let acceleration = l.start_acceleration.max(driven);
        let rated = usable(stiff) || usable(fastest);
        let (length, rate) = if rated {
            let rate = if usable(stiff) { stiff } else { fastest };
            let by_start = if usable(stiff) { 0.0 } else { l.start_acceleration / (rate * rate) };
            let length = l.half_distance.max(l.start_distance).max(l.start_speed / rate);
            (length.max(reach(rate)).max(by_start), rate)
        } else if usable(acceleration) {
            let length = l.start_distance.max(l.start_speed * l.start_speed / acceleration);
            let length = if usable(length) { length } else { acceleration * l.duration * l.duration };
            (length, (acceleration / length).sqrt())
        } else if usable(l.start_speed) {
            let length = if usable(l.start_distance) { l.start_distance } else { l.start_speed * l.duration };
            (length, l.start_speed / length)
        } else {
            (l.start_distance, 1.0 / l.duration)
        };
        let room =
            l.room.filter(|room| usable(*room) && usable(length) && length > MAX_LENGTH_OVER_ROOM * room);
        let length = if usable(length) { length } else { 1.0 };
        let rate = if usable(rate) { rate } else { 1.0 };
        let longest = |radians: f64| if rated { radians * (1.0 / rate) } else { l.duration };
        let longest_step = (longest(LONGEST_STEP.0), longest(LONGEST_STEP.1));
        let (length, rate) = match room {
            None => (length, rate),
            Some(room) => {
                let within = room.max(MAX_LENGTH_OVER_ROOM * room * (MAX_LENGTH_OVER_ROOM * room / length));
                let driven = if rated { reach(rate) } else { acceleration / (rate * rate) };
                let faster = (driven / within).sqrt().max(l.start_speed / rate / within);
                (within, rate * faster.max(1.0))
            }
        };
        Self { length, speed: length * rate, time: 1.0 / rate, longest_step }
    }

    /// The power of two of a second nearest to the time scale.
    pub(crate) fn unit(&self) -> f64 {
        elementary::exp2(elementary::log2(self.time).round().clamp(-900.0, 900.0))
    }
}

/// The scales of a scene.
pub(crate) fn scales(
    scene: &Scene,
    mass: f64,
    mechanism: &Mechanism,
    drive: &ExcitationParts,
    start: (f64, f64),
    (stops, compliant): (Option<StopPair>, Option<Hertz>),
) -> Scales {
    let Mechanism { landscape, curve, .. } = mechanism;
    let (mut stiffness, mut reference, mut half_distance) = (0.0_f64, 0.0, 0.0);
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
    // If two barriers are equally near to x = 0, the one on the side of the start.
    let start_x = if landscape.left_barrier.is_some() { start.0.abs() } else { start.0 };
    let landmarks = Landmarks {
        stiffness_over_mass: stiffness / mass,
        half_distance,
        start_distance: (start_x - reference).abs(),
        start_speed: start.1.abs(),
        start_acceleration: curve.force(start.0).abs() / mass,
        drive: drive.parts(),
        duration: scene.run.duration_s,
        room: None,
    };
    let open = Scales::new(&landmarks);
    let Some(StopPair { left: Some(left), right: Some(right) }) = stops else { return open };
    // A compliant stop adds the depth to which the mass could press it without its loss.
    let depth = compliant.map_or(0.0, |stop| Hertz { loss: 0.0, ..stop }.depth(mass, open.speed));
    let room = 0.5 * (right.x - left.x) + depth;
    Scales::new(&Landmarks { room: Some(room), ..landmarks })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_is_covariant_and_never_fails() {
        let base = Landmarks {
            stiffness_over_mass: 5263.0,
            half_distance: 7e-3,
            start_distance: 4e-3,
            start_speed: 0.2,
            start_acceleration: 12.0,
            drive: vec![(9.8, 18.8), (0.5, 0.0)],
            duration: 10.0,
            room: None,
        };
        let (l, t) = (1e6, 1e-7);
        let scaled = Landmarks {
            stiffness_over_mass: base.stiffness_over_mass / (t * t),
            half_distance: base.half_distance * l,
            start_distance: base.start_distance * l,
            start_speed: base.start_speed * l / t,
            start_acceleration: base.start_acceleration * l / (t * t),
            drive: base.drive.iter().map(|(a, w)| (a * l / (t * t), w / t)).collect(),
            duration: base.duration * t,
            room: None,
        };
        for drop in 0..32 {
            let thin = |mut m: Landmarks| {
                if drop & 1 > 0 {
                    m.stiffness_over_mass = 0.0;
                    m.half_distance = 0.0;
                }
                if drop & 2 > 0 {
                    m.drive.clear();
                }
                if drop & 4 > 0 {
                    m.start_distance = 0.0;
                    m.start_speed = 0.0;
                }
                if drop & 8 > 0 {
                    m.start_acceleration = 0.0;
                }
                m
            };
            let tight =
                |m: Landmarks, unit: f64| Landmarks { room: (drop & 16 > 0).then_some(1e-5 * unit), ..m };
            let (a, b) = (tight(thin(base.clone()), 1.0), tight(thin(scaled.clone()), l));
            let (a, b) = (Scales::new(&a), Scales::new(&b));
            assert!(a.length > 0.0 && a.speed.is_finite() && a.time > 0.0, "{drop} {a:?}");
            if a.length != 1.0 {
                assert!((b.length / a.length / l - 1.0).abs() < 1e-12, "{drop}");
                assert!((b.time / a.time / t - 1.0).abs() < 1e-12, "{drop}");
            }
        }
    }
}
