//! Motions of a linear oscillator with one impact a period on one stop, or one in each half of it on two, in
//! closed form, and where a branch of them folds, doubles its period or breaks its symmetry.

use std::f64::consts::TAU;

use interwell::dynamics::STANDARD_GRAVITY;
use interwell::scene::Document;
use interwell_studies::study::{BranchEnd, BranchEvent};

use super::{at, over_amplitude, response, two};
use crate::support::{changed, near, near_relative};

/// The damping of the built-in scene.
const DAMPING: f64 = 0.2;

/// A unit mass on a unit spring with a stop at 1 m, driven at `w` rad/s (Shaw and Holmes 1983); or with two
/// at 1 m on both sides, of which half a period and the mirror image are taken in place of a period.
///
/// With p and q for displacement and velocity of the swing without a stop at the instant of the impact, what
/// is left of the motion is free: from (1 - p, -e u - q) just after an impact of speed u to (1 - p, u - q)
/// just before the next. That makes p and q linear in u. The map from impact to impact is that of the free
/// motion, then of the impact, [[-e, 0], [(1 + e)(f - 1)/u, -e]], where f is the drive's acceleration; so its
/// trace gives u, and the size of the swing the drive.
#[derive(Debug, Clone)]
pub struct OneStop {
    pub w: f64,
    pub e: f64,
    pub damping: f64,
    pub mirrored: bool,
}

impl OneStop {
    fn time(&self) -> f64 {
        TAU / self.w * if self.mirrored { 0.5 } else { 1.0 }
    }

    /// Amplitude in g at which the swing without impacts reaches the stop.
    pub fn grazing(&self) -> f64 {
        1.0 / response(self.w, self.damping).0 / STANDARD_GRAVITY
    }

    /// What the free motion makes of a state in a period.
    pub fn free(&self) -> [[f64; 2]; 2] {
        let decay = 0.5 * self.damping;
        let turn = (1.0 - decay * decay).sqrt();
        let time = self.time();
        let kept = (-decay * time).exp() * if self.mirrored { -1.0 } else { 1.0 };
        let (sine, cosine) = (turn * time).sin_cos();
        [
            [kept * (cosine + decay / turn * sine), kept * sine / turn],
            [-kept * sine / turn, kept * (cosine - decay / turn * sine)],
        ]
    }

    /// 1 - p and q over the speed of the impact.
    fn share(&self) -> (f64, f64) {
        let ([[a, b], [c, d]], e) = (self.free(), self.e);
        let determinant = (a - 1.0) * (1.0 - d) + b * c;
        let (right, below) = (e * b, 1.0 + e * d);
        ((right * (1.0 - d) + b * below) / determinant, ((a - 1.0) * below - c * right) / determinant)
    }

    /// (f - 1)/u less -w^2/u.
    fn push(&self) -> f64 {
        let (p, q) = self.share();
        self.damping * q - (1.0 - self.w * self.w) * p
    }

    pub fn determinant(&self) -> f64 {
        self.e * self.e * (-self.damping * self.time()).exp()
    }

    /// The sum of the multipliers at an impact of this speed.
    pub fn sum(&self, speed: f64) -> f64 {
        let [[a, b], [_, d]] = self.free();
        (1.0 + self.e) * (self.push() - self.w * self.w / speed) * b - self.e * (a + d)
    }

    /// Speed of the impact and amplitude in g where a multiplier is this, 1 or -1.
    pub fn critical(&self, multiplier: f64) -> (f64, f64) {
        let [[a, b], [_, d]] = self.free();
        let needed = (multiplier * (1.0 + self.determinant()) + self.e * (a + d)) / b / (1.0 + self.e);
        let speed = self.w * self.w / (self.push() - needed);
        let (p, q) = self.share();
        let size = (1.0 - p * speed).hypot(q * speed / self.w);
        (speed, size * self.grazing())
    }

    fn document(&self) -> Document {
        let Self { w, e, .. } = self;
        changed(
            "impact-oscillator",
            &[&format!("excitation.frequency_hz={:?}", w / TAU), &format!("stops.restitution_right={e:?}")],
        )
    }

    /// The branch over amplitudes in g, whose motions with one impact have the multipliers of the formula.
    fn branch(&self, range: (f64, f64)) -> interwell_studies::study::BranchAnswer {
        let found = over_amplitude(&self.document(), range, Some(1));
        assert_eq!(found.end, BranchEnd::Range);
        for orbit in &found.orbits {
            let Some(speed) = orbit.gentlest_impact().filter(|speed| *speed > 0.05) else { continue };
            assert_eq!(orbit.passage.impacts, 1);
            let [first, second] = two(orbit);
            near_relative(first.re + second.re, self.sum(speed), 1e-9);
            near(orbit.determinant(), self.determinant(), 1e-15);
        }
        found
    }
}

#[test]
fn it_doubles_its_period_where_the_formula_says() {
    for (w, e, range) in
        [(0.7, 0.8, (0.056, 0.0545)), (0.7, 0.6, (0.056, 0.0545)), (0.8, 0.8, (0.053, 0.0515))]
    {
        let oscillator = OneStop { w, e, damping: DAMPING, mirrored: false };
        let found = oscillator.branch(range);
        let (speed, amplitude) = oscillator.critical(-1.0);
        let place = found.events.iter().position(|event| *event == Some(BranchEvent::Flip)).unwrap();
        assert_eq!(at(&found, BranchEvent::Flip).len(), 1);
        near_relative(found.values[place], amplitude, 1e-11);
        near_relative(found.orbits[place].gentlest_impact().unwrap(), speed, 1e-9);
    }
}

#[test]
fn it_folds_where_the_formula_says_and_grazes_where_the_swing_reaches_the_stop() {
    let oscillator = OneStop { w: 1.5, e: 0.8, damping: DAMPING, mirrored: false };
    let found = oscillator.branch((0.2, 0.05));
    let (speed, amplitude) = oscillator.critical(1.0);
    let place = found.events.iter().position(|event| *event == Some(BranchEvent::Fold)).unwrap();
    assert_eq!(at(&found, BranchEvent::Fold).len(), 1);
    near_relative(found.values[place], amplitude, 1e-10);
    near_relative(found.orbits[place].gentlest_impact().unwrap(), speed, 1e-5);
    // the unstable motions end where the swing that misses the stop begins
    let grazing = at(&found, BranchEvent::Grazing);
    assert_eq!((grazing.len(), found.orbits.last().unwrap().passage.impacts), (1, 0));
    near_relative(grazing[0], oscillator.grazing(), 1e-11);
}
