//! Comparison of a measured force over the position with the computed force curve.

use super::numbers::{Row, assembled, rms};
use crate::mechanics::Mechanism;
use crate::numeric::short;
use crate::study::table::Table;

/// A measured force beside the computed one, at the measured positions on the force curve.
#[derive(Debug, Clone, PartialEq)]
pub struct ForceComparison {
    /// `quantity,unit,measured,computed,difference,difference_percent`.
    pub table: Table,
    /// Positions in m, in the order in which they were measured.
    pub positions: Vec<f64>,
    /// The measured force there, N.
    pub measured: Vec<f64>,
    /// The computed one.
    pub computed: Vec<f64>,
    /// RMS of the difference in N, and in percent of the RMS of what was measured.
    pub rms: (f64, f64),
    /// Where the two differ most: the position in m, and computed less measured there in N.
    pub largest: (f64, f64),
    /// Remarks, each a sentence.
    pub remarks: Vec<String>,
}

/// Too few positions lie on the force curve.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "{on} of {samples} positions lie on the force curve, which reaches from {} to {} mm; at least 2 are \
     needed: check the unit and the zero of the positions",
    domain.0, domain.1
)]
pub struct OffTheCurve {
    /// How many lie on it.
    on: usize,
    /// Of how many.
    samples: usize,
    /// Its ends in mm.
    domain: (String, String),
}

/// Compares the force `force` in N that was measured at `x` in m with the one that holds the mass there.
pub fn compare_force(
    mechanism: &Mechanism,
    x: &[f64],
    force: &[f64],
) -> Result<ForceComparison, OffTheCurve> {
    let curve = &mechanism.curve;
    let domain = curve.domain();
    let on = |sample: &(&f64, &f64)| (domain.0..=domain.1).contains(sample.0);
    let (positions, measured): (Vec<f64>, Vec<f64>) = x.iter().zip(force).filter(on).unzip();
    if positions.len() < 2 {
        let domain = (short(domain.0 * 1e3), short(domain.1 * 1e3));
        return Err(OffTheCurve { on: positions.len(), samples: x.len(), domain });
    }
    let computed: Vec<f64> = positions.iter().map(|x| curve.force(*x)).collect();
    let apart: Vec<f64> = measured.iter().zip(&computed).map(|(m, c)| c - m).collect();
    let by_size = |a: &usize, b: &usize| apart[*a].abs().total_cmp(&apart[*b].abs());
    let worst = (0..apart.len()).max_by(by_size).unwrap_or(0);
    let fold = |values: &[f64], of: fn(f64, f64) -> f64| values.iter().copied().fold(f64::NAN, of);
    let both = |name, of: &dyn Fn(&[f64]) -> f64| -> Row { (name, "N", of(&measured), of(&computed)) };
    let (of_measured, rms_apart) = (rms(&measured), rms(&apart));
    let rows = vec![
        ("rms_difference", "N", f64::NAN, f64::NAN),
        ("largest_difference", "N", measured[worst], computed[worst]),
        ("largest_difference_at", "m", positions[worst], positions[worst]),
        both("rms", &rms),
        both("minimum", &|values| fold(values, f64::min)),
        both("maximum", &|values| fold(values, f64::max)),
    ];
    let mut remarks = Vec::new();
    if positions.len() < x.len() {
        let outside = x.len() - positions.len();
        let [low, high] = [domain.0, domain.1].map(|end| short(end * 1e3));
        remarks.push(format!(
            "{outside} of {} samples lie beyond the force curve, which reaches from {low} to {high} mm",
            x.len()
        ));
    }
    Ok(ForceComparison {
        table: assembled(&rows, rms_apart, of_measured),
        rms: (rms_apart, 100.0 * rms_apart / of_measured),
        largest: (positions[worst], apart[worst]),
        positions,
        measured,
        computed,
        remarks,
    })
}
