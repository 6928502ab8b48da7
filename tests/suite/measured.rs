//! Measured records: reading, comparison with a run, and what is identified from them.

mod comparison;
mod curve;
mod damping;
mod drive;
mod force;
mod impacts;
mod pictures;
mod reading;
mod restitution;

use std::f64::consts::TAU;

use interwell::study::{Identified, Identity};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Independent normal numbers of standard deviation 1.
pub struct Noise(ChaCha8Rng);

impl Noise {
    pub fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// The next one (Box and Muller 1958).
    pub fn next(&mut self) -> f64 {
        let (radius, angle) = ((-2.0 * (1.0 - self.even()).ln()).sqrt(), TAU * self.even());
        radius * angle.cos()
    }

    /// A number from 0 to 1, all equally likely.
    pub fn even(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The number called `name`.
pub fn number(found: &Identified, name: &str) -> Identity {
    *found.summary.iter().find(|own| own.name == name).unwrap_or_else(|| panic!("no {name}"))
}

/// Seeds of a test of coverage.
pub const SEEDS: u64 = 200;

/// Asserts that 95 of 100 intervals, as far as so many cases tell, hold the exact number: of 200 cases 190 do
/// on average, and fewer than 177 once in 5000 times.
#[track_caller]
pub fn covered(hits: u64, what: &str) {
    assert!((178..=200).contains(&hits), "{hits} of {SEEDS} intervals of {what} hold its value");
}

/// Whether the interval holds a number.
pub fn holds(own: Identity, exact: f64) -> bool {
    (own.interval.0..=own.interval.1).contains(&exact)
}
