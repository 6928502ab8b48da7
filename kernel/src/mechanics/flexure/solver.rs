//! Solver for equilibria that adapts the number of basis functions to each state.
//!
//! Functions are added until the last coefficients are negligible: eight of each parity are enough in the
//! wells, and about eighty are needed far up the taut branch. Each state starts with the number of functions
//! of its guess.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};

use super::basis::Basis;
use super::beam::{Beam, Shape, Terms};
use super::equilibrium::{Prescribed, System};
use super::point::Point;

/// Number of functions of each parity that the first state starts with.
const MIN_MODES: usize = 8;
/// Largest number of functions of each parity.
pub(super) const MAX_MODES: usize = 256;

/// Largest work for a mechanism, as the sum over its states of the cube of their number of functions. This is
/// a thousand times the work for the prototype and ends after about twenty seconds on one core (10 to 45 ns
/// per unit, measured). Only lengths that differ a thousandfold exceed it, for example if one is in the wrong
/// unit.
const MAX_WORK: usize = 500_000_000;

/// Largest leading coefficient of a leaning flexure, relative to the coefficient of its bow.
const MAX_LEAN: f64 = 3.0;

/// Reason why no stable equilibrium was found; x in scaled units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Failure {
    NotConverged { x: f64, residual: f64 },
    Unstable { x: f64 },
    TooMuchWork { x: f64 },
}

/// The flexures with the equations for each number of functions used so far.
#[derive(Debug, Clone)]
pub(super) struct Solver<'a> {
    pub beams: [Beam; 2],
    pub preload: f64,
    /// Coefficient of the first buckling mode in the stress-free rotation of each group.
    pub bow: [f64; 2],
    /// Share of the largest coefficient below which coefficients are neglected. Force and energy are
    /// stationary in the rotation, so their error is a tenth of the square of this share (measured in the
    /// wells and on the taut branch).
    pub tail: f64,
    systems: BTreeMap<usize, System>,
    /// Number of states solved for.
    pub solves: usize,
    /// Largest number of functions of each parity that a state needed.
    pub max_modes: usize,
    /// See [`MAX_WORK`].
    work: usize,
    /// Solving fails soon after another thread sets this.
    cancel: Option<&'a AtomicBool>,
}

impl<'a> Solver<'a> {
    pub fn new(
        beams: [Beam; 2],
        preload: f64,
        bow: [f64; 2],
        tail: f64,
        cancel: Option<&'a AtomicBool>,
    ) -> Self {
        let systems = BTreeMap::new();
        Self { beams, preload, bow, tail, systems, solves: 0, max_modes: 0, work: 0, cancel }
    }

    /// The same solver without its cached systems, which are larger than all states together and are rebuilt
    /// when needed. The work is counted from 0 again.
    pub fn without_cache(self) -> Solver<'static> {
        Solver { systems: BTreeMap::new(), work: 0, cancel: None, ..self }
    }

    /// Sets the bow of the stress-free flexures.
    pub fn set_bow(&mut self, bow: [f64; 2]) {
        if bow != self.bow {
            self.bow = bow;
            self.systems.clear();
        }
    }

    /// The equations with this many functions of each parity.
    pub fn system(&mut self, modes: usize) -> &System {
        let (beams, bow, preload) = (&self.beams, self.bow, self.preload);
        let system = self.systems.entry(modes).or_insert_with(|| {
            let basis = Basis::new(modes);
            let mut beams = beams.clone();
            for (beam, bow) in beams.iter_mut().zip(bow).filter(|(_, bow)| *bow != 0.0) {
                beam.natural = basis.first_buckling_mode().iter().map(|c| c * bow).collect();
                beam.natural_shortening = basis.shortening(&beam.natural) * beam.length;
            }
            System { beams, preload, basis }
        });
        system.preload = preload;
        system
    }

    /// The equilibrium near `guess`, with enough functions.
    pub fn solve(&mut self, guess: &Point, prescribed: Prescribed) -> Result<Point, Failure> {
        let mut guess = guess.clone();
        loop {
            let modes = guess.even[0].len();
            self.solves += 1;
            self.work += modes.pow(3);
            if self.work > MAX_WORK || self.cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed)) {
                return Err(Failure::TooMuchWork { x: guess.x });
            }
            self.max_modes = self.max_modes.max(modes);
            let point = self
                .system(modes)
                .solve(&guess, prescribed)
                .map_err(|residual| Failure::NotConverged { x: guess.x, residual })?;
            let side = side(&point, &self.bow);
            if side == Side::Opposite || (side == Side::Leaning && !self.is_stable(&point)) {
                return Err(Failure::NotConverged { x: point.x, residual: 1.0 });
            }
            if point.tail() <= self.tail || modes >= MAX_MODES {
                return Ok(point);
            }
            guess = point.padded((modes + (modes / 4).max(2)).min(MAX_MODES));
        }
    }

    pub fn terms(&mut self, point: &Point) -> [Terms; 2] {
        self.system(point.even[0].len()).terms(point)
    }

    pub fn is_stable(&mut self, point: &Point) -> bool {
        self.system(point.even[0].len()).is_stable(point)
    }

    /// See [`Point::reshaped`].
    pub fn reshaped(&mut self, point: &Point, shapes: [Shape; 2]) -> Point {
        point.reshaped(shapes, &self.system(point.even[0].len()).basis)
    }

    /// The state without sway, straight or with the stress-free bow.
    pub fn straight(&mut self) -> Point {
        self.system(MIN_MODES).straight()
    }

    /// The axial compression at which a straight group of thin flexures buckles between its clamps.
    pub fn buckling_load(&self, group: usize) -> f64 {
        let beam = &self.beams[group];
        let wave = 2.0 * std::f64::consts::PI / beam.length;
        beam.count * beam.bending * wave * wave
    }

    /// Sum of the shortenings of both straight groups under unit compression.
    pub fn compliance(&self) -> f64 {
        self.beams.iter().map(Beam::compliance).sum()
    }

    /// The square of the bump's amplitude that causes a given shortening, for small slopes.
    pub fn bump_of_shortening(&mut self, group: usize, shortening: f64) -> f64 {
        let leading = self.system(MIN_MODES).basis.first_buckling_mode()[0];
        4.0 * leading * leading * shortening / self.beams[group].length
    }

    /// The displacement at which the sway alone uses up the preload, for small slopes: approximately where
    /// the bumps vanish.
    pub fn taut_at(&self) -> f64 {
        let [a, b] = &self.beams;
        4.0 / std::f64::consts::PI * (self.preload / (1.0 / a.length + 1.0 / b.length)).sqrt()
    }

    pub fn shortest(&self) -> f64 {
        self.beams[0].length.min(self.beams[1].length)
    }
}

/// The side to which bowed flexures bulge, relative to their bow. On the branch from x = 0 they bulge to
/// the side of the bow wherever the bulge is large; on the taut branch they may lean to the other side
/// by about the bow. Two other equilibria bulge to the opposite side: a stable one with a large bulge
/// and an unstable one.
fn side(point: &Point, bow: &[f64; 2]) -> Side {
    let of_group = |g: usize| {
        let leading = point.odd[g].first().copied().unwrap_or(0.0);
        match leading * bow[g] < 0.0 {
            true if leading.abs() > MAX_LEAN * bow[g].abs() => Side::Opposite,
            true => Side::Leaning,
            false => Side::Same,
        }
    };
    (0..2).filter(|g| point.shapes[*g] == Shape::Bowed).map(of_group).max().unwrap_or(Side::Same)
}

/// See [`side`].
#[derive(PartialEq, Eq, PartialOrd, Ord)]
enum Side {
    Same,
    Leaning,
    Opposite,
}
