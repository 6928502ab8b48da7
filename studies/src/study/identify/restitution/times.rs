//! Coefficient of restitution from the times of impacts alone.

use crate::numeric::regression::{geometric, student};
use crate::study::identify::{Identified, Identity, Unidentified};
use crate::study::table::{Table, Values};

/// Restitution of the impacts at these `times` in s of a body that bounces on one stop under a constant
/// acceleration: then each flight is as much shorter than the one before, and the times follow
/// c + a e^k, which is fitted by least squares.
///
/// Rows, one for each impact between two flights: `t_s,restitution,restitution_low,restitution_high`.
pub fn restitution_of_times(times: &[f64]) -> Result<Identified, Unidentified> {
    let none = |why| Unidentified::NoBounces(times.len(), why);
    let law = geometric(times).ok_or_else(|| none("give more, or such as lie between bounces alone"))?;
    let e = law.coefficients[2];
    if !(e > 0.0 && law.coefficients[1] < 0.0) {
        return Err(none("the flights do not become shorter; give such as lie between bounces alone"));
    }
    let misfit =
        |(k, t): (usize, &f64)| (t - law.coefficients[0] - law.coefficients[1] * e.powi(k as i32)).powi(2);
    let noise = (times.iter().enumerate().map(misfit).sum::<f64>() / law.freedom as f64).sqrt();
    let row = |times: &[f64]| {
        let flight = times[1] - times[0];
        let ratio = (times[2] - times[1]) / flight;
        let error = noise / flight * (1.0 + ratio.powi(2) + (1.0 + ratio).powi(2)).sqrt();
        [times[1], ratio, student(law.freedom) * error]
    };
    let rows: Vec<[f64; 3]> = times.windows(3).map(row).collect();
    let rows = Table::new()
        .each("t_s", &rows, |row| row[0])
        .with("restitution", rows.iter().map(|row| row[1]).collect::<Values>())
        .each("restitution_low", &rows, |row| row[1] - row[2])
        .each("restitution_high", &rows, |row| row[1] + row[2]);
    let half = student(law.freedom) * law.covariance[(2, 2)].sqrt();
    let remarks = vec![
        "of impact times: the ratio of successive flights, which is the restitution where the acceleration \
         of the flights is constant"
            .to_owned(),
    ];
    let summary = vec![Identity::new("restitution", e, half)];
    Ok(Identified { rows, fitted: Table::new(), summary, remarks })
}
