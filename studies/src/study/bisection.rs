//! Bisection among the multiples of a resolution, several of which may be evaluated at a time.

use std::collections::VecDeque;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Trial {
    NotBegun,
    UnderWay,
    Known(bool),
}

/// The next value of a bisection to evaluate: the one that follows from the known answers or, while that is
/// under way, one that may be needed after it. `None` if `ahead` values are under way or no value is left.
pub(crate) fn next_between(
    trial: impl Fn(f64) -> Trial,
    span: (f64, f64),
    resolution: f64,
    ahead: usize,
) -> Option<f64> {
    let (mut spans, mut under_way) = (VecDeque::from([span]), 0);
    while under_way < ahead
        && let Some((low, high)) = spans.pop_front()
    {
        let Some(middle) = between(low, high, resolution) else { continue };
        match trial(middle) {
            Trial::NotBegun => return Some(middle),
            Trial::Known(true) => spans.push_front((low, middle)),
            Trial::Known(false) => spans.push_front((middle, high)),
            Trial::UnderWay => {
                under_way += 1;
                spans.extend([(low, middle), (middle, high)]);
            }
        }
    }
    None
}

/// The multiple of `resolution` in the middle between two values; `None` if none lies between them.
pub(crate) fn between(low: f64, high: f64, resolution: f64) -> Option<f64> {
    let middle = multiple(0.5 * (low + high), resolution);
    let near = [middle, multiple(middle - resolution, resolution), multiple(middle + resolution, resolution)];
    near.into_iter().find(|value| *value > low && *value < high)
}

/// The multiple of `unit` nearest to a value; for a decimal unit, the double nearest to the decimal.
pub(crate) fn multiple(value: f64, unit: f64) -> f64 {
    let count = (value / unit).round();
    let whole = (1.0 / unit).round();
    if (whole * unit - 1.0).abs() < 1e-9 { count / whole } else { count * unit }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn evaluation_ahead_does_not_change_the_result() {
        for (ahead, at) in [1, 2, 3, 7].into_iter().flat_map(|ahead| [0.51, 0.77, 1.0].map(|at| (ahead, at)))
        {
            let mut trials: Vec<(f64, Trial)> = Vec::new();
            loop {
                let trial = |trials: &[(f64, Trial)], value| {
                    trials.iter().find(|entry| entry.0 == value).map_or(Trial::NotBegun, |entry| entry.1)
                };
                while let Some(next) = next_between(|value| trial(&trials, value), (0.5, 1.0), 0.01, ahead) {
                    trials.push((next, Trial::UnderWay));
                }
                let open = trials.iter().filter(|entry| entry.1 == Trial::UnderWay).count();
                assert!(open <= ahead);
                // the last that was asked is answered first
                let Some(last) = trials.iter_mut().rfind(|entry| entry.1 == Trial::UnderWay) else { break };
                last.1 = Trial::Known(last.0 >= at);
            }
            let does = |value: f64| trials.contains(&(value, Trial::Known(true)));
            let hundredths = (51..100).map(|i| f64::from(i) / 100.0);
            let least = hundredths.into_iter().find(|value| does(*value)).unwrap_or(1.0);
            assert_eq!(least, at);
            assert!(ahead > 1 || trials.len() <= 6);
        }
    }
}
