//! Compliant stops: impacts over the impact speed, yielding, and the impact speeds of a scene.

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use super::{Table, finished};
use crate::dynamics::{EventKind, Model, Request, Summary};
use crate::identify::median;
use crate::mechanics::Hertz;
use crate::numeric::round::{ONE_TWO_FIVE, round_up};
use crate::numeric::{bisect, elementary, short};
use crate::scene::{Scene, Stops};
use crate::system::threads;

/// Number of speeds in a table: more than a picture needs.
const SPEEDS: usize = 401;

/// A single impact on the model's compliant stop over the impact speed, in even steps up to twice the speed
/// scale, rounded up to 1, 2 or 5 times a power of ten; `None` if the stops are not compliant. `rigid` is the
/// restitution of a rigid stop beside it. Values are missing without a contact time (at speed 0) or a known
/// material. All are closed forms: see [`Hertz`].
pub fn contact(model: &Model, rigid: f64) -> Option<Table> {
    let stop = model.compliant()?;
    let top = round_up(2.0 * model.scales().speed, &ONE_TWO_FIVE);
    let last = (SPEEDS - 1) as f64;
    let speeds: Vec<f64> = (0..SPEEDS).map(|i| top * i as f64 / last).collect();
    let force = |v: &f64| stop.peak_force(model.mass(), *v);
    let time = |v: &f64| (*v > 0.0).then(|| stop.contact_time(model.mass(), *v));
    let table = Table::new()
        .each("speed_m_per_s", &speeds, |v| *v)
        .each("restitution", &speeds, |v| stop.restitution(*v))
        .each("rigid_restitution", &speeds, |_| rigid)
        .each("contact_time_s", &speeds, time)
        .each("depth_m", &speeds, |v| stop.depth(model.mass(), *v))
        .each("peak_force_n", &speeds, force)
        .each("peak_pressure_pa", &speeds, |v| stop.pressure(force(v)));
    Some(table)
}

/// The impact speed in m/s above which the contact yields; `None` if its material is not known.
///
/// By halving: the force grows with the speed, and the speed scale is within a factor of 1e30.
pub fn yield_speed(stop: &Hertz, mass: f64) -> Option<f64> {
    let material = stop.material?;
    let yields = |v: f64| material.pressure(stop.peak_force(mass, v)) > material.yield_pressure();
    Some(elementary::powf(10_f64, bisect(-30.0, 30.0, 60, |power| !yields(elementary::powf(10.0, power))).1))
}

/// A warning, one sentence, if the contact of a run was pressed beyond the yield pressure of its material.
pub fn yield_warning(model: &Model, summary: &Summary) -> Option<String> {
    let material = model.compliant()?.material?;
    let pressure = summary.peak_contact_pressure.filter(|pressure| *pressure > material.yield_pressure())?;
    let force = short(summary.peak_contact_force.unwrap_or(f64::NAN));
    let pascals = [pressure, material.yield_pressure(), material.yield_strength];
    let [reached, yields, strength] = pascals.map(|pascal| short(pascal / 1e9));
    Some(format!(
        "the contact with a stop reaches {reached} GPa ({force} N) and yields from {yields} GPa on, 1.6 \
         times its yield strength of {strength} GPa (stops.yield_gpa); the model does not follow yielding"
    ))
}

/// Speeds of the impacts on the stops of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strikes {
    /// Median speed in m/s of the first impacts.
    pub speed: f64,
    /// Number of first impacts.
    pub count: usize,
    /// Whether they are those of the settled window; of the whole run, where it has none.
    pub settled: bool,
}

/// The first impacts of flights in one run: those after a crossing, a release or an impact on the other stop,
/// without the rebounds that follow. `None` without an impact, or if cancelled.
pub fn strikes(model: &Model, cancel: &AtomicBool) -> Option<Strikes> {
    let run = finished(model.run(&Request { events: true, cancel: Some(cancel), ..Request::default() }))?;
    let mut last = None;
    let mut first: Vec<(f64, f64)> = Vec::new();
    for event in &run.events {
        match event.kind {
            EventKind::Impact | EventKind::Contact => {
                if last != Some(event.side) && event.v_in != 0.0 {
                    first.push((event.t, event.v_in.abs()));
                }
                last = Some(event.side);
            }
            EventKind::Crossing | EventKind::Release => last = None,
            EventKind::Rest | EventKind::Separate => {}
        }
    }
    let settled = first.iter().any(|(t, _)| *t >= model.settle());
    let counted = first.into_iter().filter(|(t, _)| !settled || *t >= model.settle());
    let speeds: Vec<f64> = counted.map(|(_, speed)| speed).collect();
    Some(Strikes { count: speeds.len(), speed: median(speeds)?, settled })
}

/// Longest computing time for which `check` runs a scene to find the speeds of impacts.
const PATIENCE: Duration = Duration::from_secs(1);

/// Restitutions for which `check` gives the loss of a compliant stop.
const WANTED: [f64; 4] = [0.8, 0.5, 0.36, 0.2];

/// One sentence on the impact speed of `model` and compliant stops: their restitution at that speed and the
/// loss for other restitutions; for rigid stops of its `scene`, the loss that gives their restitution, or why
/// there can be no compliant ones. `None` without impacts, or if the run takes longer than a second.
pub fn strikes_in_words(model: &Model, scene: &Scene) -> Option<String> {
    let stops = &scene.stops;
    if *stops == Stops::None {
        return None;
    }
    let Strikes { speed, count, settled } = threads::within(PATIENCE, |cancel| strikes(model, cancel))?;
    let loss = |restitution: f64| Hertz::loss_times_speed(restitution).map(|struck| short(struck / speed));
    let window = if settled { "in the settled window" } else { "in the run, before its settled window" };
    let detail = match model.compliant() {
        Some(stop) => {
            let wanted = WANTED.map(|e| format!("{e} takes {} s/m", loss(e).unwrap_or_default()));
            format!("restitution {} there; {}", short(stop.restitution(speed)), wanted.join(", "))
        }
        None if scene.transducer.has_state() => {
            "compliant ones (`Hertz`) are not followed beside a current or voltage with a state of its own"
                .to_owned()
        }
        None => {
            let sides = stops.limits_mm().into_iter().zip(stops.restitutions());
            let mut restitutions: Vec<f64> =
                sides.filter_map(|(limit, restitution)| limit.and(restitution)).collect();
            restitutions.dedup();
            let losses = restitutions.into_iter().map(|e| match loss(e) {
                Some(loss) => format!("a restitution of {e} there takes loss_s_per_m: {loss}"),
                None => format!("no loss gives a restitution of {e}"),
            });
            let [left, right] = stops.limits_mm();
            let kind = match left == right {
                true => "compliant in their place (`Hertz`)",
                false => "compliant ones (`Hertz`), which stand equally far out on both sides",
            };
            format!("{kind}, {}", losses.collect::<Vec<_>>().join(", "))
        }
    };
    let flights = if count == 1 { "one flight".to_owned() } else { format!("{count} flights") };
    Some(format!(
        "stops are struck at {} m/s (median of the first impacts of {flights} {window}): {detail}",
        short(speed)
    ))
}
