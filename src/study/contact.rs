//! What does a compliant stop do at which impact speed, and does it yield?

use super::table::{Table, Values};
use crate::dynamics::{Model, Summary};
use crate::mechanics::Hertz;
use crate::numeric::short;

/// Positions of the speed on a table: more than a picture needs.
const SPEEDS: usize = 401;

/// One impact on the model's compliant stop and nothing else, over the speed in even steps from 0 to the first of 1, 2 or
/// 5 times a power of ten that is twice the scene's own speed; none where the stops are not compliant.
///
/// Columns `speed_m_per_s,restitution,rigid_restitution,contact_time_s,depth_m,peak_force_n,peak_pressure_pa`; the
/// restitution of a rigid stop is the constant `rigid`, and where there is no time (at speed 0) or the material is not
/// known the value is missing. All are closed forms: see [`Hertz`].
pub fn contact(model: &Model, rigid: f64) -> Option<Table> {
    let stop = model.compliant?;
    let top = round_up(2.0 * model.scales.speed);
    let last = (SPEEDS - 1) as f64;
    let speeds: Vec<f64> = (0..SPEEDS).map(|i| top * i as f64 / last).collect();
    let column = |of: &dyn Fn(f64) -> f64| Values::Numbers(speeds.iter().map(|v| of(*v)).collect());
    let force = |v: f64| stop.peak_force(model.mass, v);
    let time = |v: f64| if v > 0.0 { stop.contact_time(model.mass, v) } else { f64::NAN };
    let table = Table::new()
        .with("restitution", column(&|v| stop.restitution(v)))
        .with("rigid_restitution", column(&|_| rigid))
        .with("contact_time_s", column(&time))
        .with("depth_m", column(&|v| stop.depth(model.mass, v)))
        .with("peak_force_n", column(&force))
        .with("peak_pressure_pa", column(&|v| stop.pressure(force(v)).unwrap_or(f64::NAN)));
    let mut whole = Table::new().with("speed_m_per_s", Values::Numbers(speeds));
    for own in table.columns() {
        whole = whole.with(&own.name, own.values.clone());
    }
    Some(whole)
}

/// The impact speed in m/s from which on the contact yields; none where its material is not known.
///
/// By halving: the largest force grows with the speed, and the speed scale is within a factor of 1e30 of it.
pub fn yield_speed(stop: &Hertz, mass: f64) -> Option<f64> {
    let material = stop.material?;
    let yields = |v: f64| material.pressure(stop.peak_force(mass, v)) > material.yield_pressure();
    let (mut low, mut high) = (-30.0, 30.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if yields(10_f64.powf(middle)) { &mut high } else { &mut low }) = middle;
    }
    Some(10_f64.powf(high))
}

/// One sentence where the contact of a run was pressed beyond what its material bears.
pub fn yield_warning(model: &Model, summary: &Summary) -> Option<String> {
    let material = model.compliant?.material?;
    let pressure = summary.peak_contact_pressure.filter(|own| *own > material.yield_pressure())?;
    let gpa = |pascal: f64| short(pascal / 1e9);
    Some(format!(
        "the contact with a stop reaches {} GPa ({} N) and yields from {} GPa on, 1.6 times its yield strength of {} GPa \
         (stops.yield_gpa); the model does not follow yielding",
        gpa(pressure),
        short(summary.peak_contact_force.unwrap_or(f64::NAN)),
        gpa(material.yield_pressure()),
        gpa(material.yield_strength)
    ))
}

/// The first of 1, 2 or 5 times a power of ten that is not below `value`, which is above 0.
fn round_up(value: f64) -> f64 {
    let exponent = value.log10().floor() as i32;
    let steps = [1.0, 2.0, 5.0, 10.0];
    let found = steps.iter().map(|step| format!("{step}e{exponent}").parse().unwrap_or(value));
    found.into_iter().find(|step| *step >= value).unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_of_speeds_ends_on_a_round_number() {
        for (value, up) in [(0.96, 1.0), (1.0, 1.0), (1.01, 2.0), (0.003, 0.005), (70.0, 100.0)] {
            assert_eq!(round_up(value), up);
        }
    }
}
