//! Robustness of a design under tolerances, and a more robust design inward of it.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::evaluate::{Design, Evaluator};
use super::plan::{Part, Plan};
use super::search::{Found, Side, rounded};
use super::{NoBest, Optimum, Spread, Tolerance};

/// Number of samples of the fields that vary.
pub const SAMPLES: usize = 200;

/// The share of the samples below the quantile.
const QUANTILE: f64 = 0.05;

/// Number of designs from the optimum inward that are sampled.
const PLACES: usize = 16;

/// Smallest distance of the inward search in steps of the scan, as when the first field does not vary.
const MIN_REACH: f64 = 16.0;

/// The spread at the optimum, and the design with the largest worst case among those inward along the first
/// field, away from the nearer margin; `None` if that is the optimum itself, or if nothing varies.
pub(super) fn robust(
    evaluator: &Evaluator,
    plan: &mut Plan,
    found: &Found,
    margins: &[[Side; 2]],
) -> Result<(Spread, Option<(Optimum, Spread)>), NoBest> {
    let best = &found.optimum;
    if evaluator.question.vary.is_empty() {
        return Ok((Spread { worst: best.value, quantile_5: best.value }, None));
    }
    let range = &evaluator.over[0];
    // inward is away from the nearer margin
    let [low, high] = margins[0].map(|side| side.margin.unwrap_or(f64::INFINITY));
    let way = if high <= low { -1.0 } else { 1.0 };
    let shift = |tolerance: &Tolerance| {
        let size = if tolerance.relative { best.at[0].abs() } else { 1.0 };
        let furthest = tolerance.low.abs().max(tolerance.high.abs());
        if tolerance.field == range.field { furthest * size } else { 0.0 }
    };
    let shifts: f64 = evaluator.question.vary.iter().map(shift).sum();
    let reach = (3.0 * shifts).max(MIN_REACH * range.step());
    let mut places: Vec<Vec<f64>> = Vec::new();
    for i in 0..=PLACES {
        // designs are closer together near the optimum
        let share = (i as f64 / PLACES as f64).powi(2);
        let mut at = best.at.clone();
        if i > 0 {
            at[0] = rounded(range, at[0] + way * reach * share);
        }
        if places.last() != Some(&at) {
            places.push(at);
        }
    }
    plan.is_at(Part::Samples, LEAST_SAMPLES);
    let judged = evaluator.judge(&places[1..])?;
    let back = places[1..].iter().zip(&judged).filter_map(|(at, design)| design.optimum(at));
    let mut all: Vec<Sampled> =
        std::iter::once(best.clone()).chain(back).map(|optimum| Sampled::new(evaluator, optimum)).collect();
    let everything: Vec<usize> = (0..SAMPLES).collect();
    evaluate(evaluator, &mut all[..1], &everything)?;
    // samples that are bad here are usually bad elsewhere, and the worst known sample bounds the worst case
    // of a design, so that few designs need all samples
    let mut order = everything;
    order.sort_by(|a, b| all[0].values[*a].total_cmp(&all[0].values[*b]));
    evaluate(evaluator, &mut all[1..], &order[..TOGETHER])?;
    loop {
        let ahead =
            (1..all.len()).fold(0, |first, i| if all[i].worst() > all[first].worst() { i } else { first });
        let known = all[ahead].known;
        if known == SAMPLES {
            let first = all[0].spread();
            let back = (ahead > 0).then(|| (all[ahead].at.clone(), all[ahead].spread()));
            return Ok((first, back));
        }
        plan.is_at(Part::Samples, (SAMPLES - known) as u64);
        let next = &order[known..(2 * known).min(SAMPLES)];
        evaluate(evaluator, &mut all[ahead..=ahead], next)?;
    }
}

/// Number of samples that are evaluated together for a design.
const TOGETHER: usize = 8;

/// The least number of designs that are run where something varies: those inward, all samples of the optimum
/// and of one of them, and some of the others.
pub(super) const LEAST_SAMPLES: u64 = (PLACES + 2 * SAMPLES + (PLACES - 1) * TOGETHER) as u64;

/// A design with its samples; the deviations are the same for all designs.
struct Sampled {
    at: Optimum,
    /// Values of the varied fields in each sample.
    varied: Vec<Vec<f64>>,
    /// Values of the known samples, minus infinity if missing; infinity for unknown ones.
    values: Vec<f64>,
    known: usize,
}

impl Sampled {
    fn new(evaluator: &Evaluator, at: Optimum) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(evaluator.question.seed);
        let mut uniform = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        let nominal = evaluator.values_of_varied(&at.at);
        let mut sample = || {
            let vary = evaluator.question.vary.iter().zip(&nominal).map(|(tolerance, value)| {
                let size = if tolerance.relative { *value } else { 1.0 };
                let middle = 0.5 * (tolerance.low + tolerance.high) * size;
                let half = 0.5 * (tolerance.high - tolerance.low) * size;
                value + (middle + half * (2.0 * uniform() - 1.0))
            });
            vary.collect()
        };
        let varied = (0..SAMPLES).map(|_| sample()).collect();
        Self { at, varied, values: vec![f64::INFINITY; SAMPLES], known: 0 }
    }

    fn worst(&self) -> f64 {
        self.values.iter().copied().fold(f64::INFINITY, f64::min)
    }

    fn spread(&self) -> Spread {
        let mut values = self.values.clone();
        values.sort_by(f64::total_cmp);
        let shown = |value: f64| if value.is_finite() { value } else { f64::NAN };
        let place = (QUANTILE * SAMPLES as f64) as usize;
        Spread { worst: shown(values[0]), quantile_5: shown(values[place]) }
    }
}

fn evaluate(evaluator: &Evaluator, places: &mut [Sampled], samples: &[usize]) -> Result<(), NoBest> {
    let of = |place: &Sampled, sample: usize| (place.at.at.clone(), place.varied[sample].clone());
    let designs: Vec<Design> =
        places.iter().flat_map(|place| samples.iter().map(move |sample| of(place, *sample))).collect();
    let judged = evaluator.judge_varied(&designs)?;
    for (place, judged) in places.iter_mut().zip(judged.chunks(samples.len())) {
        for (sample, judged) in samples.iter().zip(judged) {
            place.values[*sample] = judged.value().unwrap_or(f64::NEG_INFINITY);
        }
        place.known += samples.len();
    }
    Ok(())
}
