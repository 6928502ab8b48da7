//! Picture of a compliant stop: restitution over impact speed, beside a rigid stop's constant.

use super::axis::PlotAxis;
use super::drawn::Drawn;
use super::figure::{Area, Figure, Point};
use super::frame::Frame;
use super::mark::{Caption, Sample, legend};
use super::style::{self, Theme};
use super::swept::{LEAST, LEFT, TOP};
use crate::mechanics::Hertz;
use crate::numeric::short;
use crate::study::{Table, yield_speed};

/// The picture of `table` (as [`contact`](crate::study::contact) gives it) for `stop` and a mass in kg.
pub fn contact_figure(table: &Table, stop: &Hertz, mass: f64, caption: &Caption, theme: &Theme) -> Figure {
    let mut figure = Figure::new(theme, caption, LEAST);
    let column = |name: &str| table.numbers(name).unwrap_or_default();
    let speeds = column("speed_m_per_s");
    let top = speeds.last().copied().unwrap_or(1.0);
    let yields = yield_speed(stop, mass).filter(|speed| *speed < top);
    let rigid = column("rigid_restitution").first().copied().unwrap_or(f64::NAN);
    let rigid = format!("rigid stop, {}", short(rigid));
    let mut entries = vec![
        (Sample::Line(theme.ink, style::LINE + 0.8, None), "compliant stop"),
        (Sample::Line(theme.soft, style::LINE, Some(style::DASH)), rigid.as_str()),
    ];
    let words = yields.map(|speed| format!("yields from {} m/s on", short(speed)));
    if let Some(words) = &words {
        entries.push((Sample::Line(theme.unstable, style::LINE, Some(style::DOT)), words));
    }
    let ends = (LEFT, figure.right());
    let above = TOP.max(legend(&mut figure, theme, &entries, ends, 142.0) + 18.0);
    let up = PlotAxis::between(0.0, 1.05, 6, "restitution");
    let left = Frame::left(&figure, &up, LEFT, figure.bottom() - above);
    let area = Area::new(left, above, figure.right(), figure.bottom() - 8.0);
    let frame = Frame::new(area, PlotAxis::between(0.0, top, 8, "impact speed, m/s"), up);
    let pairs =
        |name: &str| -> Vec<Point> { speeds.iter().copied().zip(column(name).iter().copied()).collect() };
    frame.grid(&mut figure, theme);
    if let Some(speed) = yields {
        frame.vertical(&mut figure, speed, style::LINE, theme.unstable, Some(style::DOT));
    }
    frame.dashed(&mut figure, &pairs("rigid_restitution"), style::LINE, theme.soft, style::DASH);
    frame.line(&mut figure, &pairs("restitution"), style::LINE + 0.8, theme.ink);
    frame.axes(&mut figure, theme);
    let names = ["speed_m_per_s", "restitution", "rigid_restitution"];
    let mut drawn = Drawn::new(names, &[]);
    for row in 0..speeds.len() {
        drawn.put("contact", &names.map(|name| column(name)[row]), &[]);
    }
    figure.data = drawn.table();
    let about = format!(
        "one contact alone: {} N/m^1.5, loss {} s/m; {} ms at {} m/s",
        short(stop.stiffness),
        short(stop.loss),
        short(stop.contact_time(mass, 0.5 * top) * 1e3),
        short(0.5 * top)
    );
    caption.draw(&mut figure, theme, &about, LEFT);
    figure
}
