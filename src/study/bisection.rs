//! Bisection among the multiples of a resolution, several of which may be evaluated at a time.

use std::collections::VecDeque;

/// The next value of a bisection to evaluate: the one that follows from the known answers or, while that is
/// under way, one that may follow it. `None` if `ahead` values are under way or nothing is left. `answer` is
/// `None` for a value that was not asked, and `Some(None)` for one under way.
pub(super) fn next_between(
    answer: impl Fn(f64) -> Option<Option<bool>>,
    span: (f64, f64),
    resolution: f64,
    ahead: usize,
) -> Option<f64> {
    let (mut spans, mut under_way) = (VecDeque::from([span]), 0);
    while under_way < ahead
        && let Some((low, high)) = spans.pop_front()
    {
        let Some(middle) = between(low, high, resolution) else { continue };
        match answer(middle) {
            None => return Some(middle),
            Some(Some(true)) => spans.push_front((low, middle)),
            Some(Some(false)) => spans.push_front((middle, high)),
            Some(None) => {
                under_way += 1;
                spans.extend([(low, middle), (middle, high)]);
            }
        }
    }
    None
}

/// The multiple of `resolution` in the middle between two values; `None` if none lies between them.
pub(super) fn between(low: f64, high: f64, resolution: f64) -> Option<f64> {
    let middle = multiple(0.5 * (low + high), resolution);
    let near = [middle, multiple(middle - resolution, resolution), multiple(middle + resolution, resolution)];
    near.into_iter().find(|value| *value > low && *value < high)
}

/// The multiple of `unit` nearest to a value; for a decimal unit, the double nearest to the decimal.
pub(super) fn multiple(value: f64, unit: f64) -> f64 {
    let count = (value / unit).round();
    let whole = (1.0 / unit).round();
    if (whole * unit - 1.0).abs() < 1e-9 { count / whole } else { count * unit }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_asked_ahead_changes_nothing() {
        for (ahead, at) in [1, 2, 3, 7].into_iter().flat_map(|ahead| [0.51, 0.77, 1.0].map(|at| (ahead, at)))
        {
            let mut trials: Vec<(f64, Option<bool>)> = Vec::new();
            loop {
                let answer = |trials: &[(f64, Option<bool>)], value| {
                    trials.iter().find(|entry| entry.0 == value).map(|entry| entry.1)
                };
                while let Some(next) = next_between(|value| answer(&trials, value), (0.5, 1.0), 0.01, ahead) {
                    trials.push((next, None));
                }
                let open = trials.iter().filter(|entry| entry.1.is_none()).count();
                assert!(open <= ahead);
                // the last that was asked is answered first
                let Some(last) = trials.iter_mut().rfind(|entry| entry.1.is_none()) else { break };
                last.1 = Some(last.0 >= at);
            }
            let does = |value: f64| trials.contains(&(value, Some(true)));
            let hundredths = (51..100).map(|i| f64::from(i) / 100.0);
            let least = hundredths.into_iter().find(|value| does(*value)).unwrap_or(1.0);
            assert_eq!(least, at);
            assert!(ahead > 1 || trials.len() <= 6);
        }
    }
}
