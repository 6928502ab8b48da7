//! Sums and counts of a record.

use crate::numeric::{CompensatedSum, Scalar};

/// Sums over an interval of time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sums<T> {
    /// Integral of v^2, kernel units.
    pub squared_velocity: CompensatedSum<T>,
    /// - integral of a v.
    pub work: CompensatedSum<T>,
    /// Kinetic energy that impacts have taken, divided by the mass.
    pub impact: CompensatedSum<T>,
    /// Time at rest on a stop.
    pub rested: CompensatedSum<T>,
    /// Integral of the displacement; with a ledger only.
    pub displacement: CompensatedSum<T>,
    /// Integral of the squared state of a circuit.
    pub circuit: CompensatedSum<T>,
}

impl<T: Scalar> Sums<T> {
    pub fn new() -> Self {
        let sum = CompensatedSum::new();
        Self { squared_velocity: sum, work: sum, impact: sum, rested: sum, displacement: sum, circuit: sum }
    }

    /// Applies `more` to each sum and its values at two instants.
    pub fn each(
        &mut self,
        before: &Self,
        after: &Self,
        more: impl Fn(&mut CompensatedSum<T>, &CompensatedSum<T>, &CompensatedSum<T>),
    ) {
        // destructured, so that no sum can be forgotten
        let Self { squared_velocity, work, impact, rested, displacement, circuit } = self;
        more(squared_velocity, &before.squared_velocity, &after.squared_velocity);
        more(work, &before.work, &after.work);
        more(impact, &before.impact, &after.impact);
        more(rested, &before.rested, &after.rested);
        more(displacement, &before.displacement, &after.displacement);
        more(circuit, &before.circuit, &after.circuit);
    }
}

#[derive(Debug, Default, Clone, Copy)]
pub(crate) struct Counts {
    pub crossings: u64,
    pub impacts: u64,
    pub releases: u64,
    pub total_crossings: u64,
    pub total_impacts: u64,
    pub sums: u64,
    pub rests: u64,
}

impl Counts {
    /// Adds `laps` times the difference between `before` and `after`.
    pub fn repeat(&mut self, before: &Self, after: &Self, laps: u64) {
        let Self { crossings, impacts, releases, total_crossings, total_impacts, sums, rests } = self;
        let more = |count: &mut u64, before: u64, after: u64| {
            *count = count.saturating_add((after - before).saturating_mul(laps));
        };
        more(crossings, before.crossings, after.crossings);
        more(impacts, before.impacts, after.impacts);
        more(releases, before.releases, after.releases);
        more(total_crossings, before.total_crossings, after.total_crossings);
        more(total_impacts, before.total_impacts, after.total_impacts);
        more(sums, before.sums, after.sums);
        more(rests, before.rests, after.rests);
    }
}
