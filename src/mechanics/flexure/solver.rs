//! Equilibria with as many basis functions as each needs.
//!
//! As many as make the last coefficients vanish beside the largest: eight of each parity in the wells, ten
//! times as many far up the taut branch. The answer is found for each state anew, beginning with what its
//! guess had.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};

use super::basis::Basis;
use super::beam::{Beam, Shape, Terms};
use super::equilibrium::{Prescribed, System};
use super::point::Point;

/// Functions of each parity: what a state begins with, and the most that it is given.
const FEWEST_MODES: usize = 8;
pub(super) const MOST_MODES: usize = 256;

/// The work that a mechanism may take, as the sum over its states of the cubes of their functions: a thousand
/// times that of the prototype, and an end within some twenty seconds of one core for the others (10 to 45 ns
/// each, measured). It is lengths that differ a thousandfold that need it, such as one that was written in
/// another unit.
const MOST_WORK: usize = 500_000_000;

/// Leaning is less than this many times the coefficient of the bow.
const MOST_LEAN: f64 = 3.0;

/// Why no stable equilibrium was found; x in scaled units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Lost {
    NotConverged { x: f64, residual: f64 },
    Unstable { x: f64 },
    Endless { x: f64 },
}

/// The flexures, and the equations for each number of functions that was needed so far.
#[derive(Debug, Clone)]
pub(super) struct Solver<'a> {
    pub beams: [Beam; 2],
    pub preload: f64,
    /// Coefficient of the first buckling mode in the stress-free rotation of each group.
    pub bow: [f64; 2],
    /// Coefficients below this part of the largest are left out. Force and energy are stationary in the
    /// rotation, so their error is a tenth of the square of what is left out (measured in the wells and up
    /// the wall).
    pub tail: f64,
    systems: BTreeMap<usize, System>,
    /// Number of states solved for.
    pub solves: usize,
    /// The most functions that a state needed.
    pub most_modes: usize,
    /// See [`MOST_WORK`].
    work: usize,
    /// Set from elsewhere to end it: it is then lost.
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
        Self { beams, preload, bow, tail, systems, solves: 0, most_modes: 0, work: 0, cancel }
    }

    /// Gives up the tables, which are made again where they are needed; they are larger than all states
    /// together. Work begins anew.
    pub fn forget(self) -> Solver<'static> {
        Solver { systems: BTreeMap::new(), work: 0, cancel: None, ..self }
    }

    /// Another bow of the stress-free flexures.
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

    /// The equilibrium near `guess`, with as many functions as it needs.
    pub fn solve(&mut self, guess: &Point, prescribed: Prescribed) -> Result<Point, Lost> {
        let mut guess = guess.clone();
        loop {
            let modes = guess.even[0].len();
            self.solves += 1;
            self.work += modes.pow(3);
            if self.work > MOST_WORK || self.cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed)) {
                return Err(Lost::Endless { x: guess.x });
            }
            self.most_modes = self.most_modes.max(modes);
            let point = self
                .system(modes)
                .solve(&guess, prescribed)
                .map_err(|stalled| Lost::NotConverged { x: guess.x, residual: stalled.residual })?;
            let side = side(&point, &self.bow);
            if side == Side::Other || (side == Side::Leaning && !self.is_stable(&point)) {
                return Err(Lost::NotConverged { x: point.x, residual: 1.0 });
            }
            if point.tail() <= self.tail || modes >= MOST_MODES {
                return Ok(point);
            }
            guess = point.padded((modes + (modes / 4).max(2)).min(MOST_MODES));
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

    /// The state without any sway, straight or as bowed as it is made.
    pub fn straight(&mut self) -> Point {
        self.system(FEWEST_MODES).straight()
    }

    /// The compression at which a straight group buckles between its clamps, for thin flexures.
    pub fn buckling_load(&self, group: usize) -> f64 {
        let beam = &self.beams[group];
        let wave = 2.0 * std::f64::consts::PI / beam.length;
        beam.count * beam.bending * wave * wave
    }

    /// Sum of the shortenings of both straight groups under unit compression.
    pub fn compliance(&self) -> f64 {
        self.beams.iter().map(|b| b.length * b.stretch / b.count).sum()
    }

    /// The square of the bump's amplitude that shortens a flexure by this much, for small slopes.
    pub fn bump_of_shortening(&mut self, group: usize, shortening: f64) -> f64 {
        let leading = self.system(FEWEST_MODES).basis.first_buckling_mode()[0];
        4.0 * leading * leading * shortening / self.beams[group].length
    }

    /// Where the sway alone uses up the preload, for small slopes: about where the bumps vanish.
    pub fn taut_at(&self) -> f64 {
        let [a, b] = &self.beams;
        4.0 / std::f64::consts::PI * (self.preload / (1.0 / a.length + 1.0 / b.length)).sqrt()
    }

    pub fn shortest(&self) -> f64 {
        self.beams[0].length.min(self.beams[1].length)
    }
}

/// Where each bowed flexure bulges beside the side of its bow. On the way from x = 0 it does so where the
/// bulge matters; up the wall it may lean to the other side by no more than its bow. Two other states bulge
/// to the other side: a stable one outright, an unstable one.
fn side(point: &Point, bow: &[f64; 2]) -> Side {
    let mut side = Side::Own;
    for g in (0..2).filter(|g| point.shapes[*g] == Shape::Bowed) {
        let leading = point.odd[g].first().copied().unwrap_or(0.0);
        if leading * bow[g] < 0.0 {
            side = if leading.abs() > MOST_LEAN * bow[g].abs() { return Side::Other } else { Side::Leaning };
        }
    }
    side
}

/// See [`side`].
#[derive(PartialEq)]
enum Side {
    Own,
    Leaning,
    Other,
}
