//! Impact oscillators of the literature, as docs/scene.md has them, against closed forms of their equations.

use std::f64::consts::{PI, TAU};

use interwell::dynamics::EventKind;
use interwell::numeric::bisect;
use interwell_studies::study::BranchEvent;

use super::one_stop::OneStop;
use super::{at, find, over, two};
use crate::support::{Draw, build, documented, near, near_relative, of_kind, run};

/// A unit mass on a unit spring with a stop of restitution `e` at the place of rest, and on it the force
/// sin(w t) (Thompson and Ghaffari 1982), with one impact in every `n` periods of the force.
///
/// From (0, e u) after an impact to (0, -u) before the next the motion is the swing (p, q) of the force plus
/// a free one over the time T = 2 pi n/w. Both conditions give p = -(1 + e) u/2 cot(T/2) and
/// q = -(1 - e) u/2 at the impact, and p^2 + (q/w)^2 = 1/(w^2 - 1)^2 the speed u. The map from impact to
/// impact is the free motion, then [[-e, 0], [-(1 + e) a/u, -e]] with the acceleration a = (1 - w^2) p.
struct AtRest {
    e: f64,
    n: u32,
}

impl AtRest {
    /// Half the angle by which a free motion turns from impact to impact.
    fn half_turn(&self, w: f64) -> f64 {
        PI * f64::from(self.n) / w
    }

    fn speed(&self, w: f64) -> f64 {
        let (keeps, loses) = (1.0 + self.e, 1.0 - self.e);
        2.0 / (w * w - 1.0) / (keeps / self.half_turn(w).tan()).hypot(loses / w)
    }

    /// The sum of the multipliers.
    fn sum(&self, w: f64) -> f64 {
        let (cosine, keeps) = ((2.0 * self.half_turn(w)).cos(), 1.0 + self.e);
        -2.0 * self.e * cosine - 0.5 * keeps * keeps * (w * w - 1.0) * (1.0 + cosine)
    }

    /// The frequency above the resonance where a multiplier is -1.
    fn flip(&self) -> f64 {
        let offset = 4.0 * self.e / (1.0 + self.e).powi(2) - 1.0;
        let excess = |w: f64| self.half_turn(w).cos().powi(2) - 1.0 / (w * w + offset);
        let resonance = 2.0 * f64::from(self.n);
        bisect(resonance, resonance + 1.0, 100, |w| excess(w) < 0.0).0
    }
}

#[test]
fn the_oscillator_of_thompson_and_ghaffari_resonates_and_doubles_its_period_by_the_formulas() {
    for (e, n) in [(0.8, 1), (0.8, 2), (0.6, 1), (0.5, 3)] {
        let oscillator = AtRest { e, n };
        let mut document = documented("Impact oscillator of Thompson and Ghaffari");
        let resonance = 2.0 * f64::from(n);
        document.set(&format!("stops.restitution_left={e}")).unwrap();
        document.set(&format!("excitation.frequency_rad_per_s={resonance}")).unwrap();

        let found = find(&build(&document), 0.25, None).unwrap();
        assert_eq!((found.period, found.passage.impacts), (n, 1));
        let peak = 2.0 * resonance / (resonance * resonance - 1.0) / (1.0 - e);
        near_relative(found.gentlest_impact().unwrap(), peak, 1e-11);
        near_relative(oscillator.speed(resonance), peak, 1e-14);
        // of a double multiplier a rounding leaves the square root
        two(&found).iter().for_each(|one| near((one.re - e).hypot(one.im), 0.0, 1e-6));

        let range = (resonance, resonance + 0.8);
        let branch = over("excitation.frequency_rad_per_s", &document, range, 0.25, Some(n));
        for (w, orbit) in branch.values.iter().zip(&branch.orbits) {
            assert_eq!(orbit.passage.impacts, 1);
            near_relative(orbit.gentlest_impact().unwrap(), oscillator.speed(*w), 1e-9);
            let [first, second] = two(orbit);
            near(first.re + second.re, oscillator.sum(*w), 1e-8);
            near(orbit.determinant(), e * e, 1e-14);
        }
        let flips = at(&branch, BranchEvent::Flip);
        assert_eq!(flips.len(), 1, "{flips:?}");
        near_relative(flips[0], oscillator.flip(), 1e-9);
    }
    let page = include_str!("../../../docs/scene.md");
    assert!(page.contains(&format!("at w = {:.6}.", AtRest { e: 0.8, n: 1 }.flip())));
}

/// The scene of docs/scene.md: its damping, frequency and restitution, and its stop at 1 m.
const NORDMARK: OneStop = OneStop { w: 1.5, e: 0.8, damping: 0.2, mirrored: false };

/// The force whose swing just reaches the stop: 1 m times the impedance of the oscillator.
fn grazing_force() -> f64 {
    let OneStop { w, damping, .. } = NORDMARK;
    (1.0 - w * w).hypot(damping * w)
}

#[test]
fn the_oscillator_of_nordmark_grazes_at_its_force_and_multipliers_grow_as_one_over_the_speed() {
    let document = documented("Grazing oscillator of Nordmark");
    let branch = over("excitation.amplitude_n", &document, (1.9, 0.5), 0.0, Some(1));
    let grazing = at(&branch, BranchEvent::Grazing);
    assert_eq!(grazing.len(), 1);
    near_relative(grazing[0], grazing_force(), 1e-11);
    let page = include_str!("../../../docs/scene.md");
    assert!(page.contains(&format!("F = {:.6},", grazing_force())));

    let OneStop { w, e, .. } = NORDMARK;
    let limit = -(1.0 + e) * w * w * NORDMARK.free()[0][1];
    assert!(page.contains(&format!("here {limit:.2}.")), "{limit}");
    let mut nearest = f64::INFINITY;
    for orbit in &branch.orbits {
        let Some(speed) = orbit.gentlest_impact().filter(|speed| *speed > 1e-6) else { continue };
        let [first, second] = two(orbit);
        near(first.re + second.re, NORDMARK.sum(speed), 1e-9 * (1.0 + 1.0 / speed));
        if speed < 0.1 {
            // what is left is in proportion to the speed
            near(first.re * speed, limit, 0.2 * speed);
            nearest = nearest.min(speed);
        }
    }
    assert!(nearest < 0.03, "{nearest}");
}

#[test]
fn a_swing_that_would_pass_the_stop_strikes_it_with_the_square_root_of_the_excess() {
    let OneStop { w, damping, .. } = NORDMARK;
    let mut draw = Draw(31);
    for _ in 0..60 {
        let size = 1.0 + 10_f64.powf(draw.between(-7.0, -0.5));
        // the swing size cos(w t + turn) of the force, whose phase is ahead by the lag
        let (turn, lag) = (TAU * draw.between(0.4, 0.85), (damping * w).atan2(1.0 - w * w));
        let (sine, cosine) = turn.sin_cos();
        let mut document = documented("Grazing oscillator of Nordmark");
        for change in [
            "run.duration_s=5".to_owned(),
            format!("excitation.amplitude_n={:?}", size * grazing_force()),
            format!("excitation.phase_deg={:?}", (turn + lag).to_degrees()),
            format!("start.x_mm={:?}", 1e3 * size * cosine),
            format!("start.v_m_per_s={:?}", -w * size * sine),
        ] {
            document.set(&change).unwrap();
        }
        let run = run(&build(&document));
        let impact = of_kind(&run, EventKind::Impact)[0];
        assert!(impact.t < TAU / w);
        near(impact.v_in.powi(2), w * w * (size - 1.0) * (size + 1.0), 1e-11);
    }
}
