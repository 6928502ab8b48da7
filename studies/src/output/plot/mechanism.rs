//! Picture of mechanisms between their stops, seen from the base.

use std::sync::atomic::AtomicBool;

use super::assembly::Assembly;
use super::axis::PlotAxis;
use super::chart::{Chart, Marks, Panel, PanelColumn, Side};
use super::names::DISPLACEMENT;
use super::role::Role;
use crate::curve::drawn_shapes;
use crate::dynamics::Model;
use crate::mechanics::flexure::State;
use crate::numeric::short;
use crate::study::{StatesError, Table, Task, states};

/// Room beyond wells, stops and mass, as a share of their range.
const ROOM: f64 = 0.12;

/// The picture of the mechanisms of models, each with its mass at a displacement in m, side by side over the
/// same axis; the second one is called A. Flexures have their true shape; mass, stops and the parts beside
/// them are not to scale.
///
/// # Errors
///
/// [`StatesError::Outside`] for a displacement that is not on the curve of its flexures,
/// [`StatesError::Unsolved`] if they have no solution there.
pub fn mechanism_chart(of: &[(&Model, f64)]) -> Result<Chart, StatesError> {
    let task = Task { tick: &|| (), cancel: &AtomicBool::new(false) };
    let bend = |(model, x): &(&Model, f64)| match &model.mechanism().flexures {
        Some(_) => states(model.mechanism(), &[*x], &task),
        None => Ok(Vec::new()),
    };
    let bent = of.iter().map(bend).collect::<Result<Vec<Vec<State>>, _>>()?;
    let places = of.iter().zip(&bent).flat_map(|(of, bent)| places(*of, bent));
    let across = PlotAxis::around(places.map(|x| x * 1e3), ROOM, DISPLACEMENT);
    let (mut columns, mut data) = (Vec::new(), Table::new());
    for (place, ((model, x), bent)) in of.iter().zip(&bent).enumerate() {
        let mut panel = panel(model, *x, bent.first(), across.clone());
        if of.len() > 1 {
            panel.heading = ["this scene", "A"][place.min(1)].to_owned();
        }
        columns.push(PanelColumn { width: 1.0, panels: vec![panel] });
        let [left, right] = <[_; 2]>::from(model.stop_positions()).map(|stop| stop.unwrap_or(f64::NAN));
        data.append(&drawn_shapes(bent, (left, right), &[*x]));
    }
    let at: Vec<String> = of.iter().map(|(_, x)| format!("at {} mm", short(x * 1e3))).collect();
    let is_bent = bent.iter().any(|bent| !bent.is_empty());
    let scale = if is_bent { "sideways stretched, mass not to scale" } else { "not to scale upward" };
    let subtitle = format!("mass {}; {scale}", at.join(", of A ")).replace('-', "\u{2212}");
    Ok(Chart { columns, subtitle, data })
}

/// The displacements in m that a drawing shows: wells, stops, mass, flexures.
fn places((model, x): (&Model, f64), bent: &[State]) -> Vec<f64> {
    let wells = model.mechanism().landscape.equilibria.iter().map(|equilibrium| equilibrium.x);
    let stops = <[_; 2]>::from(model.stop_positions()).into_iter().flatten();
    let bends = bent.iter().flat_map(|state| &state.lines).flat_map(|line| &line.points);
    wells.chain(stops).chain([x, 0.0]).chain(bends.map(|point| point[2])).collect()
}

fn panel(model: &Model, x: f64, bent: Option<&State>, across: PlotAxis) -> Panel {
    let ends = (across.low * 1e-3, across.high * 1e-3);
    let assembly = Assembly::of(model, x, bent, ends);
    let mut panel = Panel::new(across, PlotAxis::given(0.0, 1.0, Vec::new(), ""));
    panel.draw(Role::Motion, Marks::Mechanism(Box::new(assembly)));
    panel.draw(Role::Motion, Marks::Ticks(vec![x * 1e3], Side::Bottom));
    let limits = <[_; 2]>::from(model.stop_positions()).into_iter().flatten().map(|x| x * 1e3).collect();
    panel.layer_if_any(Role::Limit, "travel limit", Marks::Ticks(limits, Side::Bottom));
    panel
}
