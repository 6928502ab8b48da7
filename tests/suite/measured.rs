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
mod spoiled;

use std::f64::consts::TAU;

use interwell_studies::study::{Identified, Identity};
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

    /// A number from 0 to 1, each as likely.
    pub fn even(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number between these, each as likely.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.even()
    }

    /// A number between these, each decade as likely.
    pub fn of_any_size(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }
}

/// The number called `name`.
pub fn number(found: &Identified, name: &str) -> Identity {
    *found.summary.iter().find(|identity| identity.name == name).unwrap_or_else(|| panic!("no {name}"))
}

/// Asserts that of the intervals of records that were drawn at random 95 in 100 hold the exact number: of 600
/// and more 93 to 97 in 100, of fewer no less than four standard deviations of the binomial law below 95.
#[track_caller]
pub fn hold_95_of_100(hits: usize, drawn: usize, what: &str) {
    let (share, count) = (hits as f64 / drawn as f64, drawn as f64);
    let (low, high) =
        if drawn < 600 { (0.95 - 4.0 * (0.95 * 0.05 / count).sqrt(), 1.0) } else { (0.93, 0.97) };
    println!("{what}: {hits} of {drawn}");
    assert!((low..=high).contains(&share), "{hits} of {drawn} intervals of {what} hold its value");
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
pub fn holds(identity: Identity, exact: f64) -> bool {
    (identity.interval.0..=identity.interval.1).contains(&exact)
}
