//! Ranges of the axes of velocity, power and base acceleration.
//!
//! An axis that follows the motion hides how large it is. These ranges cover the values expected of the
//! scene, grow by coarse steps if the motion exceeds them, and shrink only once a change has settled.

use crate::app::session::Session;
use crate::dynamics::{Model, STANDARD_GRAVITY};
use crate::numeric::round::round_up;
use crate::output::zero_of_energy;

use super::stretch;

/// Ends in g of an axis of the base's acceleration.
const PUSHES: [f64; 14] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.35, 0.6, 1.0, 1.5, 2.2, 3.2, 5.0, 10.0, 20.0];

/// Ends of an axis within a decade.
const ENDS: [f64; 10] = [1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0];

/// Factor by which an axis exceeds the largest value.
const ROOM: f64 = 1.05;

/// Share of the speed scale expected as speed without a barrier, and of push times speed as power.
const SHARE: f64 = 0.3;

/// End in m/s^2 of an axis that has to show `push`.
pub fn room_for_push(push: f64) -> f64 {
    PUSHES.iter().map(|g| g * STANDARD_GRAVITY).find(|room| *room >= push).unwrap_or(push)
}

/// The end of an axis that holds `value`, which is above 0.
pub fn axis_end(value: f64) -> f64 {
    let end = round_up(value, &ENDS);
    if end.is_finite() && end > 0.0 { end } else { 1.0 }
}

/// Lowest potential in J of the wells between the stops and of the stops themselves, if there are any.
pub fn floor(model: &Model) -> Option<f64> {
    let (left, right) = model.stop_positions();
    let inside = |x: &f64| left.is_none_or(|stop| *x >= stop) && right.is_none_or(|stop| *x <= stop);
    let landscape = &model.mechanism().landscape;
    let wells = landscape.equilibria.iter().filter(|well| well.stable).map(|well| well.x).filter(inside);
    let places = wells.chain(left).chain(right);
    places.map(|x| model.mechanism().curve.potential(x)).reduce(f64::min)
}

/// The potential in J from which energy is counted, and the name of its axis.
pub fn bottom(model: &Model) -> (f64, &'static str) {
    let (left, right) = model.stop_positions();
    zero_of_energy(model.mechanism(), (left.unwrap_or(f64::NAN), right.unwrap_or(f64::NAN)))
}

/// Largest speed in m/s, powers in W and kinetic energy in J, and the range of displacements in m.
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

/// End of the axis of power into a load, in multiples of its mean, at least.
const MEANS: f64 = 3.0;

/// Values that the axes have to show; kept between frames.
#[derive(Debug, Clone, Copy, Default)]
pub struct Ranges {
    /// Values expected of the scene.
    expected: Extremes,
    /// Values of the motion since the last change.
    seen: Extremes,
    /// Values before the last change, kept until the motion has settled and they have left the traces.
    previous: Extremes,
    /// Values of the motion since the start.
    since_start: Extremes,
    /// Time in s of the last change.
    since: Option<f64>,
    /// Time in s up to which the motion has been read.
    looked_to: f64,
}

impl Ranges {
    /// Takes in the motion since the last call.
    pub fn follow(&mut self, session: &Session) -> &Self {
        let changed_at = session.changed_at;
        let watch = session.player.watch();
        let begins_anew = watch.time() < self.looked_to;
        if begins_anew {
            (self.since_start, self.previous, self.seen) = Default::default();
        }
        if self.since != Some(changed_at) || begins_anew {
            self.previous = self.previous.or(self.seen);
            self.seen = Extremes::default();
            self.since = Some(changed_at);
            self.looked_to = changed_at;
        }
        // what was before the change is drawn until it has left the traces
        let is_gone = watch.time() - changed_at > stretch(session.shown());
        if session.settling().is_none() && is_gone {
            self.previous = Extremes::default();
        }
        let model = session.model();
        for watch in session.reference.apart().map(|apart| &apart.watch).into_iter().chain([watch]) {
            let first = watch.samples().partition_point(|sample| sample.t < self.looked_to);
            for sample in watch.samples().range(first..) {
                self.seen = self.seen.or(Extremes {
                    speed: sample.v.abs(),
                    power: sample.work_rate(model.mass()).abs(),
                    load: watch.model_at(sample.t).output(sample).map_or(0.0, |output| output.power),
                    kinetic: model.energies(sample.x, sample.v).0,
                    low: sample.x,
                    high: sample.x,
                });
            }
        }
        self.looked_to = watch.time();
        let energy = match model.mechanism().landscape.barrier {
            Some(barrier) => barrier.from_left_j.max(barrier.from_right_j),
            None if !model.is_shaken() => {
                let (kinetic, potential) = model.energies(model.start().0, model.start().1);
                kinetic + potential - floor(model).unwrap_or(potential)
            }
            None => 0.0,
        };
        let speed = match energy > 0.0 {
            true => (2.0 * energy / model.mass()).sqrt(),
            false => SHARE * model.scales().speed,
        };
        let power = SHARE * speed * model.mass() * room_for_push(model.largest_base_acceleration());
        let kinetic = 0.5 * model.mass() * speed * speed;
        let mean = session.settled_now().and_then(|settled| settled.harvest?.mean_load_power);
        let load = MEANS * mean.unwrap_or(0.0);
        self.expected = Extremes { speed, power, load, kinetic, ..Extremes::default() };
        self.since_start = self.since_start.or(self.seen);
        self
    }

    fn whole(&self) -> Extremes {
        self.expected.or(self.seen).or(self.previous)
    }

    /// Range of displacements in m to show: since the last change, or since the start if the past is shown.
    pub fn reach(&self, session: &Session) -> (f64, f64) {
        let extremes = if session.player.is_past() { self.since_start } else { self.whole() };
        (extremes.low, extremes.high)
    }

    /// The end of an axis of velocity in m/s.
    pub fn speed(&self) -> f64 {
        axis_end(ROOM * self.whole().speed)
    }

    /// The end of an axis of power in W.
    pub fn power(&self) -> f64 {
        axis_end(ROOM * self.whole().power)
    }

    /// The end of an axis of power into a load in W; 1 mW if there is no power.
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
