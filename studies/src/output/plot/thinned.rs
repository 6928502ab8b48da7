//! Points and marks of which some are left out, since they lie too close together to be seen.

use std::collections::HashSet;

use super::figure::{Point, distance};

/// Keeps one of the points in the same half pixel.
pub(super) fn once(places: &mut Vec<Point>) {
    let mut taken = HashSet::new();
    places.retain(|at| taken.insert(((2.0 * at.0) as i64, (2.0 * at.1) as i64)));
}

/// The first, smallest, largest and last point of a column, in their order.
pub(super) fn extremes(column: &[Point]) -> Vec<Point> {
    let by = |better: fn(f64, f64) -> bool| {
        (1..column.len()).fold(0, |best, i| if better(column[i].1, column[best].1) { i } else { best })
    };
    let mut kept = vec![0, by(|a, b| a < b), by(|a, b| a > b), column.len() - 1];
    kept.sort_unstable();
    kept.dedup();
    kept.into_iter().map(|i| column[i]).collect()
}

/// The marks of a line at a distance of at least `apart` from the one before, or `close` if the word changes.
pub(super) fn thinned<'a>(marks: &[(Point, &'a str)], apart: f64, close: f64) -> Vec<(Point, &'a str)> {
    let mut kept: Vec<(Point, &str)> = Vec::new();
    for (at, word) in marks {
        let least = |other: &str| if other == *word { apart } else { close.min(apart) };
        if kept.last().is_none_or(|(last, other)| distance(*last, *at) >= least(other)) {
            kept.push((*at, word));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markers_on_a_line_stand_apart_and_a_change_is_seen() {
        let marks: Vec<(Point, &str)> = (0..100)
            .map(|i| ((f64::from(i) * 4.0, 0.0), if i < 50 { "rest" } else { "interwell" }))
            .collect();
        let kept = thinned(&marks, 40.0, 10.0);
        assert!(kept.windows(2).all(|pair| {
            let step = pair[1].0.0 - pair[0].0.0;
            step >= 40.0 || (pair[0].1 != pair[1].1 && step >= 10.0)
        }));
        let first = kept.iter().find(|mark| mark.1 == "interwell").unwrap();
        assert!(first.0.0 <= 200.0 + 10.0, "{first:?}");
        assert_eq!(thinned(&marks, 0.0, 10.0), marks);
    }
}
