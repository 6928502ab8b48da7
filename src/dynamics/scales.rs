//! Relative to what are errors small? One length, one speed, one time for a scene.
//!
//! The rule, from mechanism, drive and start alone, never from the stops (a stop that is never reached must
//! not change a bit) and covariant under a change of units:
//!
//! - rate w: the square root of the largest stiffness magnitude over mass among the wells' inner sides and
//!   the barrier (one well: at it; none: at the start); without stiffness the drive's fastest tone;
//!   without both, sqrt(acceleration over length), or speed over length;
//! - length L: the largest of half the distance between the wells, the start's distance from the
//!   barrier (or the single equilibrium, or 0), start speed over w, and drive acceleration over w and the
//!   larger of w and the fastest tone's rate (a fast drive moves the mass that far, by its first kick);
//! - speed L w, time 1/w.

/// Length in m, speed in m/s, time in s; all above 0 and finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scales {
    /// Length in m.
    pub length: f64,
    /// Speed in m/s.
    pub speed: f64,
    /// Time in s.
    pub time: f64,
}

/// What the rule looks at. All SI, magnitudes.
#[derive(Debug, Clone, Copy, Default)]
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
    /// Sum of the drive's amplitudes, m/s^2.
    pub drive_acceleration: f64,
    /// Angular frequency of the drive's fastest tone, 1/s; 0 without one.
    pub drive_rate: f64,
    /// Duration of the run in s.
    pub duration: f64,
}

impl Scales {
    pub(crate) fn new(l: &Landmarks) -> Self {
        let stiff = l.stiffness_over_mass.sqrt();
        let usable = |x: f64| x.is_finite() && x > 0.0;
        let acceleration = l.start_acceleration.max(l.drive_acceleration);
        let (length, rate) = if usable(stiff) || usable(l.drive_rate) {
            let rate = if usable(stiff) { stiff } else { l.drive_rate };
            let length = l
                .half_distance
                .max(l.start_distance)
                .max(l.start_speed / rate)
                .max(l.drive_acceleration / (rate * rate.max(l.drive_rate)))
                .max(if usable(stiff) { 0.0 } else { l.start_acceleration / (rate * rate) });
            (length, rate)
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
        let length = if usable(length) { length } else { 1.0 };
        let rate = if usable(rate) { rate } else { 1.0 };
        Self { length, speed: length * rate, time: 1.0 / rate }
    }

    /// The power of two of a second nearest to the time scale.
    pub(crate) fn unit(&self) -> f64 {
        self.time.log2().round().clamp(-900.0, 900.0).exp2()
    }
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
            drive_acceleration: 9.8,
            drive_rate: 18.8,
            duration: 10.0,
        };
        let (l, t) = (1e6, 1e-7);
        let scaled = Landmarks {
            stiffness_over_mass: base.stiffness_over_mass / (t * t),
            half_distance: base.half_distance * l,
            start_distance: base.start_distance * l,
            start_speed: base.start_speed * l / t,
            start_acceleration: base.start_acceleration * l / (t * t),
            drive_acceleration: base.drive_acceleration * l / (t * t),
            drive_rate: base.drive_rate / t,
            duration: base.duration * t,
        };
        for drop in 0..16 {
            let thin = |mut m: Landmarks| {
                if drop & 1 > 0 {
                    m.stiffness_over_mass = 0.0;
                    m.half_distance = 0.0;
                }
                if drop & 2 > 0 {
                    m.drive_acceleration = 0.0;
                    m.drive_rate = 0.0;
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
            let (a, b) = (Scales::new(&thin(base)), Scales::new(&thin(scaled)));
            assert!(a.length > 0.0 && a.speed.is_finite() && a.time > 0.0, "{drop} {a:?}");
            if a.length != 1.0 {
                assert!((b.length / a.length / l - 1.0).abs() < 1e-12, "{drop}");
                assert!((b.time / a.time / t - 1.0).abs() < 1e-12, "{drop}");
            }
        }
    }
}
