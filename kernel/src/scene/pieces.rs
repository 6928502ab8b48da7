//! Checks of a force that is given as polynomials.

use super::check::Checked;
use super::field_table::MAX_COEFFICIENTS;
use super::mechanism::{ForcePiece, Mechanism};
use crate::numeric::number_text;

/// Largest number of pieces; a fitted curve has a few dozen.
const MAX_PIECES: usize = 10_000;

/// Largest coefficient, that of a `Polynomial`.
const MAX_COEFFICIENT: f64 = 1e200;

/// Largest step between two pieces, relative to the largest force where pieces meet: rounding.
const ROUNDING: f64 = 1e-9;

impl ForcePiece {
    fn force(&self, x: f64) -> f64 {
        self.coefficients_si.iter().rev().fold(0.0, |sum, c| sum * (x - self.origin_m) + c)
    }
}

/// Checks the numbers of a mechanism that is `Pieces`, and that the pieces meet.
pub(super) fn check(at: &str, described: &Mechanism, checked: &mut Checked) {
    let Mechanism::Pieces { ends_m, pieces, error_n } = described else { return };
    if !(1..=MAX_PIECES).contains(&pieces.len()) {
        let problem = format!("must have 1 to {MAX_PIECES} pieces");
        return checked.fault(format!("{at}.pieces"), format!("a list of {}", pieces.len()), problem);
    }
    if ends_m.len() != pieces.len() + 1 {
        let problem =
            format!("{} pieces have {} ends; give one more than pieces", pieces.len(), pieces.len() + 1);
        return checked.fault(format!("{at}.ends_m"), format!("a list of {}", ends_m.len()), problem);
    }
    for (i, piece) in pieces.iter().enumerate() {
        let (field, count) = (format!("{at}.pieces.{i}"), piece.coefficients_si.len());
        if !(1..=MAX_COEFFICIENTS).contains(&count) {
            let problem = format!("must have 1 to {MAX_COEFFICIENTS} coefficients");
            return checked.fault(format!("{field}.coefficients_si"), format!("a list of {count}"), problem);
        }
        let is_bad = |value: &&f64| !(value.abs() <= MAX_COEFFICIENT);
        if let Some(bad) = piece.coefficients_si.iter().chain([&piece.origin_m]).find(is_bad) {
            let problem =
                format!("must be {:e} to {MAX_COEFFICIENT:e}; give finite numbers", -MAX_COEFFICIENT);
            return checked.fault(field, number_text(*bad), problem);
        }
    }
    let inner = &ends_m[1..pieces.len()];
    // ends that ascend are infinite at no other place
    if let Some(pair) = ends_m.windows(2).find(|pair| !(pair[0] < pair[1])) {
        let problem = "must ascend, in m; the first may be -inf and the last inf";
        return checked.fault(format!("{at}.ends_m"), number_text(pair[1]), problem);
    }
    let forces: Vec<(f64, f64)> =
        inner.iter().zip(pieces.windows(2)).map(|(x, pair)| (pair[0].force(*x), pair[1].force(*x))).collect();
    let largest =
        forces.iter().fold(0.0_f64, |largest, (left, right)| largest.max(left.abs()).max(right.abs()));
    let allowed = 2.0 * error_n + ROUNDING * largest;
    let steps = inner.iter().zip(&forces);
    if let Some((x, (left, right))) =
        steps.into_iter().find(|(_, (left, right))| !((left - right).abs() <= allowed))
    {
        let (x, left, right) = (number_text(*x), number_text(*left), number_text(*right));
        let problem = format!("the force steps from {left} to {right} N at x = {x} m; it must be continuous");
        checked.fault(format!("{at}.pieces"), format!("{} pieces", pieces.len()), problem);
    }
}
