//! Picture of a compliant stop: restitution over impact speed, beside a rigid stop's constant.

use super::axis::PlotAxis;
use super::chart::{Chart, Marks, Panel};
use super::drawn::of_rows;
use super::figure::Point;
use super::role::Role;
use crate::mechanics::Hertz;
use crate::numeric::short;
use crate::study::{Table, yield_speed};

/// The picture of `table` (as [`contact`](crate::study::contact) gives it) for `stop` and a mass in kg.
pub fn contact_chart(table: &Table, stop: &Hertz, mass: f64) -> Chart {
    let column = |name: &str| table.numbers(name).unwrap_or_default();
    let speeds = column("speed_m_per_s");
    let top = speeds.last().copied().unwrap_or(1.0);
    let rigid = column("rigid_restitution").first().copied().unwrap_or(f64::NAN);
    let pairs =
        |name: &str| -> Vec<Point> { speeds.iter().copied().zip(column(name).iter().copied()).collect() };
    let across = PlotAxis::between(0.0, top, "impact speed (m/s)");
    let mut panel = Panel::new(across, PlotAxis::between(0.0, 1.05, "restitution"));
    panel.layer(Role::Curve, "compliant stop", Marks::Path(pairs("restitution")));
    let name = format!("rigid stop, {}", short(rigid));
    panel.layer(Role::Separatrix, name, Marks::Path(pairs("rigid_restitution")));
    if let Some(speed) = yield_speed(stop, mass).filter(|speed| *speed < top) {
        let name = format!("yields from {} m/s on", short(speed));
        panel.layer(Role::UnstableMotion, name, Marks::Verticals(vec![speed]));
    }
    let names = ["speed_m_per_s", "restitution", "rigid_restitution"];
    let about = format!(
        "one contact alone: {} N/m^1.5, loss {} s/m; {} ms at {} m/s",
        short(stop.stiffness),
        short(stop.loss),
        short(stop.contact_time(mass, 0.5 * top) * 1e3),
        short(0.5 * top)
    );
    Chart::stack(vec![panel], about, of_rows("contact", table, &names, |_| true))
}
