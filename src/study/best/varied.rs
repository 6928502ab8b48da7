//! What becomes of a design whose fields come out a little otherwise, and how far to step back for it.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::design::{NoBest, Optimum, Spread, Variation};
use super::evaluate::{Design, Evaluator};
use super::search::{Found, rounded};

/// Samples of what varies.
pub const SAMPLES: usize = 200;

/// The share of the samples below the quantile.
const QUANTILE: f64 = 0.05;

/// Places from the optimum inward at which the samples are taken.
const PLACES: usize = 16;

/// How far inward is looked, in steps of the scan, where what varies is no part of the first field.
const LEAST_BACK: f64 = 16.0;

/// The spread at the optimum, and the place with the largest worst case of those inward of it along the first
/// field, away from the nearer cliff; none where the optimum is that place, or where nothing varies.
pub(super) fn robust(
    evaluator: &Evaluator,
    found: &Found,
    margins: &[[Option<f64>; 2]],
) -> Result<(Spread, Option<(Optimum, Spread)>), NoBest> {
    let best = &found.optimum;
    if evaluator.question.vary.is_empty() {
        return Ok((Spread { worst: best.value, quantile_5: best.value }, None));
    }
    let range = &evaluator.question.over[0];
    // the nearer cliff is the one to step back from
    let [low, high] = margins[0].map(|own| own.unwrap_or(f64::INFINITY));
    let way = if high <= low { -1.0 } else { 1.0 };
    let shift = |own: &Variation| {
        let size = if own.relative { best.at[0].abs() } else { 1.0 };
        if own.field == range.field { own.by * size } else { 0.0 }
    };
    let own: f64 = evaluator.question.vary.iter().map(shift).sum();
    let reach = (3.0 * own).max(LEAST_BACK * range.step());
    let mut places: Vec<Vec<f64>> = Vec::new();
    for i in 0..=PLACES {
        // closer together near the optimum
        let share = (i as f64 / PLACES as f64).powi(2);
        let mut at = best.at.clone();
        if i > 0 {
            at[0] = rounded(range, at[0] + way * reach * share);
        }
        if places.last() != Some(&at) {
            places.push(at);
        }
    }
    let judged = evaluator.judge(&places)?;
    let (mut first, mut back): (Option<Spread>, Option<(Optimum, Spread)>) = (None, None);
    for (at, own) in places.iter().zip(&judged) {
        let Some(own) = own.optimum(at) else { continue };
        let spread = spread(evaluator, at)?;
        let most = back.as_ref().map_or(first, |own| Some(own.1));
        match most {
            None => first = Some(spread),
            Some(most) if spread.worst > most.worst || most.worst.is_nan() && !spread.worst.is_nan() => {
                back = Some((own, spread));
            }
            _ => {}
        }
    }
    Ok((first.unwrap_or(Spread { worst: f64::NAN, quantile_5: f64::NAN }), back))
}

/// The spread at a place: the same samples at each.
fn spread(evaluator: &Evaluator, at: &[f64]) -> Result<Spread, NoBest> {
    let mut random = ChaCha8Rng::seed_from_u64(evaluator.question.seed);
    let mut uniform = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let nominal = evaluator.values_of_varied(at);
    let designs: Vec<Design> = (0..SAMPLES)
        .map(|_| {
            let vary = evaluator.question.vary.iter().zip(&nominal).map(|(own, value)| {
                let by = if own.relative { own.by * value } else { own.by };
                value + by * (2.0 * uniform() - 1.0)
            });
            (at.to_vec(), vary.collect())
        })
        .collect();
    let judged = evaluator.judge_varied(&designs)?;
    let mut values: Vec<f64> = judged.iter().map(|own| own.value().unwrap_or(f64::NEG_INFINITY)).collect();
    values.sort_by(f64::total_cmp);
    let shown = |value: f64| if value.is_finite() { value } else { f64::NAN };
    let place = (QUANTILE * SAMPLES as f64) as usize;
    Ok(Spread { worst: shown(values[0]), quantile_5: shown(values[place]) })
}
