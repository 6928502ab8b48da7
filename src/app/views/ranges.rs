//! Ranges of the axes of velocity, power and base acceleration.
//!
//! An axis that follows the motion tells nothing of its size. These reach to what the scene lets expect, go a
//! coarse step further where the motion needs it, and are chosen anew only once a change has settled.

use crate::app::session::Session;
use crate::app::session::pins::Pin;
use crate::dynamics::{Model, STANDARD_GRAVITY};
use crate::numeric::round::round_up;

/// Pushes in g that an axis of the base's acceleration has room for.
const PUSHES: [f64; 14] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.35, 0.6, 1.0, 1.5, 2.2, 3.2, 5.0, 10.0, 20.0];

/// Ends of an axis within a power of ten.
const ENDS: [f64; 10] = [1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0];

/// Room above the largest value, as a factor.
const ROOM: f64 = 1.05;

/// Share of the scene's own speed that is shown where no barrier sets one.
const SHARE: f64 = 0.3;

/// Acceleration in m/s^2 up to which an axis reaches that has to show `push`.
pub fn room_for_push(push: f64) -> f64 {
    PUSHES.iter().map(|g| g * STANDARD_GRAVITY).find(|room| *room >= push).unwrap_or(push)
}

/// The end of an axis that holds `value`, which is above 0.
pub fn axis_end(value: f64) -> f64 {
    let end = round_up(value, &ENDS);
    if end.is_finite() && end > 0.0 { end } else { 1.0 }
}

/// The potential in J of the lowest place between the stops, where there is one.
pub fn floor(model: &Model) -> Option<f64> {
    let (left, right) = model.stop_positions();
    let inside = |x: &f64| left.is_none_or(|stop| *x >= stop) && right.is_none_or(|stop| *x <= stop);
    let landscape = &model.mechanism().landscape;
    let wells = landscape.equilibria.iter().filter(|own| own.stable).map(|own| own.x).filter(inside);
    let places = wells.chain(left).chain(right);
    places.map(|x| model.mechanism().curve.potential(x)).reduce(f64::min)
}

/// The largest speed in m/s, powers in W and energy in J that have been seen since the last change, and the
/// way out from the middle in m.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Extremes {
    speed: f64,
    power: f64,
    load: f64,
    kinetic: f64,
    low: f64,
    high: f64,
}

impl Extremes {
    fn or(self, other: Self) -> Self {
        Self {
            speed: self.speed.max(other.speed),
            power: self.power.max(other.power),
            load: self.load.max(other.load),
            kinetic: self.kinetic.max(other.kinetic),
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }
}

/// How many means of the power into a load its axis has room for at least.
const MEANS: f64 = 3.0;

/// What the axes have to hold; kept between frames.
#[derive(Debug, Clone, Copy, Default)]
pub struct Ranges {
    /// What the scene lets expect.
    expected: Extremes,
    /// What has been seen since the last change, and what the axes held before it.
    seen: Extremes,
    kept: Extremes,
    /// What has been seen since the start.
    ever: Extremes,
    /// Time in s of that change, and up to which the motion has been looked at.
    since: Option<f64>,
    looked_to: f64,
}

impl Ranges {
    /// Takes in what has happened since the last time.
    pub fn follow(&mut self, session: &Session) -> &Self {
        let changed_at = session.changed_at();
        let watch = session.player.watch();
        if watch.time() < self.looked_to {
            self.ever = Extremes::default();
        }
        if self.since != Some(changed_at) || watch.time() < self.looked_to {
            self.kept = self.kept.or(self.seen);
            self.seen = Extremes::default();
            self.since = Some(changed_at);
            self.looked_to = changed_at;
        }
        if session.settling().is_none() {
            self.kept = Extremes::default();
        }
        let model = session.model();
        for watch in session.pins.all().iter().map(Pin::watch).chain([watch]) {
            let first = watch.samples().partition_point(|sample| sample.t < self.looked_to);
            for sample in watch.samples().range(first..) {
                self.seen = self.seen.or(Extremes {
                    speed: sample.v.abs(),
                    power: sample.work_rate(model.mass()).abs(),
                    load: watch.model_at(sample.t).output(sample).map_or(0.0, |own| own.power),
                    kinetic: model.energies(sample.x, sample.v).0,
                    low: sample.x,
                    high: sample.x,
                });
            }
        }
        self.looked_to = watch.time();
        let falls = match model.mechanism().landscape.barrier {
            Some(barrier) => barrier.from_left_j.max(barrier.from_right_j),
            None if !model.is_shaken() => {
                let (kinetic, potential) = model.energies(model.start().0, model.start().1);
                kinetic + potential - floor(model).unwrap_or(potential)
            }
            None => 0.0,
        };
        let speed = match falls > 0.0 {
            true => (2.0 * falls / model.mass()).sqrt(),
            false => SHARE * model.scales().speed,
        };
        let power = SHARE * speed * model.mass() * room_for_push(model.largest_base_acceleration());
        let kinetic = 0.5 * model.mass() * speed * speed;
        let mean = session.settled_now().and_then(|own| own.harvest?.mean_load_power);
        let load = MEANS * mean.unwrap_or(0.0);
        self.expected = Extremes { speed, power, load, kinetic, ..Extremes::default() };
        self.ever = self.ever.or(self.seen);
        self
    }

    fn whole(&self) -> Extremes {
        self.expected.or(self.seen).or(self.kept)
    }

    /// The displacements in m that an axis has to show: those seen since the last change, or where the past
    /// is looked at since the start.
    pub fn reach(&self, session: &Session) -> (f64, f64) {
        let own = if session.player.is_past() { self.ever } else { self.whole() };
        (own.low, own.high)
    }

    /// The end of an axis of velocity in m/s.
    pub fn speed(&self) -> f64 {
        axis_end(ROOM * self.whole().speed)
    }

    /// The end of an axis of power in W.
    pub fn power(&self) -> f64 {
        axis_end(ROOM * self.whole().power)
    }

    /// The end of an axis of power into a load in W; a milliwatt where there is none.
    pub fn load_power(&self) -> f64 {
        let load = self.whole().load;
        if load > 0.0 { axis_end(ROOM * load) } else { 1e-3 }
    }

    /// The largest kinetic energy in J to be shown.
    pub fn kinetic(&self) -> f64 {
        self.whole().kinetic
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_coarse_and_hold_the_value() {
        assert_eq!(axis_end(0.346), 0.4);
        assert_eq!(axis_end(8.1), 10.0);
        assert!(axis_end(0.0) > 0.0 && axis_end(f64::NAN) > 0.0);
        for value in [1e-6, 0.123, 1.0, 7.7, 1e9] {
            assert!(axis_end(value) >= value && axis_end(value) <= 1.3 * value);
        }
    }
}
