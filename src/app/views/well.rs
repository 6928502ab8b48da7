//! View of the potential well, with the mass on it.
//!
//! The mass moves on the potential that the push of the base tips ([`TippedPotential`]), which is drawn
//! thick, the potential of the mechanism alone thin. The vertical range follows the largest push in a few
//! coarse steps, so that the curve tilts and does not rescale, and it holds while the mechanism changes.

use std::sync::Arc;

use eframe::egui::{Stroke, Ui};

use crate::app::task::Identity;
use crate::app::ui::style::BALL;
use crate::app::words::numbers::{energy, three};
use crate::dynamics::Model;
use crate::mechanics::Barrier;
use crate::output::{
    DISPLACEMENT, Layer, Marks, Panel, PlotAxis, Role, TippedPotential, axis_name, suited_unit, well_panel,
};
use crate::scene::Start;

use super::ghosts::{REFERENCE, circle, dashed, ghost};
use super::labels::ago;
use super::mass::mass_ui;
use super::plot::{kept, plot_ui};
use super::ranges::{bottom, room_for_push};
use super::stops::{BEST_STOPS, WALL, add_walls, asked_place, best_stops, stops_ui, travel_limits};
use super::view::Axis;
use super::{Cover, View, ViewContext};

/// Share of the axes that an end of the bracket of the barrier takes to either side.
const BRACKET: f64 = 0.008;

/// Room above the highest energy as a share of the range, twice that below the lowest.
const ROOM: f64 = 0.22;

/// Greatest radius of the ball as a share of the distance between the stops, and its least in points.
const GAP_SHARE: f64 = 0.3;
const LEAST_BALL: f32 = 6.0;

/// The potential without the push, and the unit of its axis.
struct Level<'a> {
    potential: TippedPotential<'a>,
    unit: &'static str,
}

impl Level<'_> {
    /// An energy in J as text, in the unit of the axis if its usual unit is another one.
    fn written(&self, joule: f64) -> String {
        let text = energy(joule);
        let has_unit = text.split_once(' ').is_some_and(|(_, unit)| unit == self.unit);
        if has_unit { text } else { format!("{} {}", three(joule * self.potential.per_joule), self.unit) }
    }
}

pub fn well_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (area, style) = (ui.max_rect(), context.style);
    let (low, high) = energy_ends(context);
    let suited = suited_unit("J", std::iter::once(high - low));
    // ends that were chosen by hand are in the unit of their time
    let is_chosen = context.memory.axes.chosen(Axis::Up(View::Well)).is_some();
    let unit = context.memory.frozen.unit.filter(|_| is_chosen).unwrap_or(suited);
    let (per_joule, unit) = *context.memory.frozen.unit.insert(unit);
    let (span, state) = (context.memory.place(context.session), context.session.player.state());
    let model = Arc::clone(context.session.shown());
    let level = Level { potential: TippedPotential::new(&model, 0.0, per_joule), unit };
    let tipped = level.potential.at_acceleration(state.base_accel);
    let automatic = [(span.low * 1e3, span.high * 1e3), (low * per_joule, high * per_joule)];
    let ends = context.memory.ends(View::Well, automatic);
    let range = (ends[0].0 * 1e-3, ends[0].1 * 1e-3);
    let is_shaken = model.is_shaken();
    let mut panel = kept(ui, (Identity(Arc::clone(&model)), ends), || {
        let [across, up] = automatic;
        let up = PlotAxis::between(up.0, up.1, &axis_name("energy", unit));
        let across = PlotAxis::between(across.0, across.1, DISPLACEMENT);
        let mut panel = well_panel(&level.potential, range, (across, up), is_shaken);
        panel.layers.retain(|layer| layer.role == Role::Reference);
        barrier(&mut panel, &model, &level, ends);
        panel
    });
    add_walls(&mut panel, context.session);
    let points = tipped.points(range);
    // the potential of the reference, where it differs from the present one
    let seen = 0.01 * (high - low) * per_joule;
    let ghost = ghost(context);
    let of_ghost = ghost
        .as_ref()
        .map(|ghost| (ghost, TippedPotential::new(&ghost.model, ghost.state.base_accel, per_joule)));
    if let Some((_, curve)) = &of_ghost {
        let compared: Vec<_> = points.iter().map(|point| (point.0, curve.at(point.0))).collect();
        let differs = compared.iter().zip(&points).any(|(other, now)| (other.1 - now.1).abs() > seen);
        panel.layer(Role::Compared, REFERENCE, Marks::Path(if differs { compared } else { Vec::new() }));
    }
    panel.layers.extend(tipped.line(points).into_iter().map(|layer| {
        Layer {
            name: match layer.role {
                Role::Beyond => "beyond the stops",
                _ if is_shaken => "with the push",
                _ => "potential",
            }
            .to_owned(),
            ..layer
        }
    }));
    // while a question is asked it would be that of the motion before
    if !is_shaken && context.cover != Cover::Future {
        let kinetic = model.energies(state.x, state.v).0;
        let energy = tipped.at(state.x * 1e3) + kinetic * per_joule;
        panel.layer(Role::Separatrix, "energy of the mass", Marks::Horizontals(vec![energy]));
    }
    if best_stops(context).is_some() {
        panel.layer(Role::BestStop, BEST_STOPS, Marks::Path(Vec::new()));
    }
    let plotted = plot_ui(ui, context.memory, View::Well, &style, area, &panel);
    let frame = plotted.frame();
    context.memory.drawing.beside = (frame.left() - area.left(), area.right() - frame.right());
    let shared = std::mem::replace(&mut context.span, plotted.span());
    let (left, right) = model.stop_positions();
    // a mass between close stops leaves the curve to be seen
    let gap =
        left.zip(right).map_or(f64::INFINITY, |(left, right)| (right - left) * context.span.scale(frame));
    let radius = BALL.min((GAP_SHARE * gap) as f32).max(LEAST_BALL);
    let on_curve = |x: f64, curve: &TippedPotential<'_>| plotted.place((x * 1e3, curve.at(x * 1e3)));
    let painter = ui.painter().with_clip_rect(frame);
    if let Some((ghost, _)) = &of_ghost {
        ghost.stops(&painter, context, frame, 0.0);
    }
    let at = on_curve(state.x, &tipped);
    stops_ui(ui, context, frame, (frame.top(), frame.bottom()), (0.0, true));
    mass_ui(ui, context, at, frame);
    if let Some(x) = asked_place(context, state.x) {
        let edge = Stroke::new(1.5, style.mass_edge());
        painter.extend(dashed(&circle(on_curve(x, &tipped), radius), edge));
    }
    // whole at an end of an axis
    let over = ui.painter().with_clip_rect(frame.expand(BALL + 1.0).intersect(area));
    if let Some((ghost, curve)) = &of_ghost {
        ghost.outline(&over, &style, &circle(on_curve(ghost.state.x, curve), radius));
    }
    // set off from a wall, over which it stands as a mark
    let is_over = |stop: Option<f64>| {
        stop.is_some_and(|x| (context.span.screen_from_world(x, frame) - at.x).abs() < radius + WALL)
    };
    if is_over(left) || is_over(right) {
        over.circle_stroke(at, radius + 2.0, Stroke::new(2.5, style.ground()));
    }
    over.circle(at, radius, style.mass(), Stroke::new(1.5, style.mass_edge()));
    travel_limits(&painter, context, frame);
    match ago(context.session) {
        Some(ago) => plotted.write(ui, &style, &ago),
        None => plotted.read(ui, &style, &panel),
    }
    context.span = shared;
}

/// The lowest places in m to the left and to the right of the barrier that the stops leave to the mass;
/// `None` if no stop stands between a well and the barrier, or one stands beyond the barrier.
fn feet(model: &Model, barrier: &Barrier) -> Option<[f64; 2]> {
    let (left, right) = model.stop_positions();
    let feet = [
        left.map_or(barrier.left_well, |stop| stop.max(barrier.left_well)),
        right.map_or(barrier.right_well, |stop| stop.min(barrier.right_well)),
    ];
    let is_cut = feet != [barrier.left_well, barrier.right_well];
    (is_cut && feet[0] < barrier.x && feet[1] > barrier.x).then_some(feet)
}

/// The height of the barrier as a bracket below its top, named by its energy. Between stops inside the wells
/// the bracket has a mark at the energy that the mass has at each stop.
fn barrier(panel: &mut Panel, model: &Model, level: &Level<'_>, ends: [(f64, f64); 2]) {
    let Some(barrier) = model.mechanism().landscape.barrier else { return };
    let potential = |x: f64| model.mechanism().curve.potential(x);
    let joule = potential(barrier.x) - bottom(model).0;
    let feet = feet(model, &barrier);
    let heights = feet.map_or([joule; 2], |feet| feet.map(|foot| potential(barrier.x) - potential(foot)));
    let middle = barrier.x * 1e3;
    let aside = BRACKET * (ends[0].1 - ends[0].0);
    let at = |height: f64| (joule - height) * level.potential.per_joule;
    let (top, foot) = (at(0.0), at(joule));
    const GAP: (f64, f64) = (f64::NAN, f64::NAN);
    let mut path =
        vec![(middle - aside, top), (middle + aside, top), GAP, (middle, top), (middle, foot), GAP];
    path.extend([(middle - aside, foot), (middle + aside, foot)]);
    panel.layer(Role::Joined, format!("barrier {}", level.written(joule)), Marks::Path(path));
    if feet.is_some() {
        // as high as a mass on each stop
        let [left, right] = heights.map(at);
        let marks =
            vec![(middle, left), (middle - aside, left), GAP, (middle, right), (middle + aside, right)];
        let [left, right] = heights.map(|height| level.written(height));
        let name = if left == right {
            format!("{left} from a stop")
        } else {
            // the unit stands once if they share it
            let shared = left.split_once(' ').filter(|(_, unit)| right.ends_with(unit));
            format!("{}, {right} from the stops", shared.map_or(left.as_str(), |(number, _)| number))
        };
        panel.layer(Role::Joined, name, Marks::Path(marks));
    }
}

/// The ends of the vertical axis in J: those of the potential energies that the mass reaches, with a margin.
fn energy_ends(context: &mut ViewContext<'_>) -> (f64, f64) {
    let model = context.session.shown();
    let compared = ghost(context).map_or(0.0, |ghost| ghost.model.largest_base_acceleration());
    let largest = model.largest_base_acceleration().max(compared).max(context.memory.push_of_lesson);
    let push = room_for_push(largest);
    let curve = &model.mechanism().curve;
    let landscape = &model.mechanism().landscape;
    let tilt = if model.is_shaken() { model.mass() * push } else { 0.0 };
    let zero = bottom(model).0;
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut show = |x: f64, tilted: bool| {
        let (v, side) = (curve.potential(x) - zero, if tilted { tilt * x.abs() } else { 0.0 });
        (low, high) = (low.min(v - side), high.max(v + side));
    };
    match landscape.barrier {
        Some(barrier) => {
            show(barrier.left_well, true);
            show(barrier.right_well, true);
            show(barrier.x, false);
        }
        None => {
            let (left, right) = model.stop_positions();
            let domain = curve.domain();
            for x in [left.unwrap_or(context.span.low), right.unwrap_or(context.span.high)] {
                show(x.clamp(domain.0, domain.1), true);
            }
            show(0.0, false);
        }
    }
    // the energy with which an unshaken mass begins, unless the wells would be too small beside it
    if let (false, Start::At { x_mm, v_m_per_s, .. }) = (model.is_shaken(), context.session.scene().start) {
        let (kinetic, potential) = model.energies(x_mm * 1e-3, v_m_per_s);
        high = high.max((kinetic + potential - zero).min(high + 2.0 * (high - low)));
    }
    if !(high - low > 0.0) {
        (low, high) = (low - 1e-3, low + 1e-3);
    }
    let room = ROOM * (high - low);
    let in_gesture = context.session.editor.in_gesture();
    let ends = (low - 0.5 * room, high + room);
    let frozen = &mut context.memory.frozen;
    if frozen.room == push {
        frozen.energy.hold(ends, in_gesture)
    } else {
        frozen.room = if in_gesture { frozen.room } else { push };
        frozen.energy.keep(ends, in_gesture)
    }
}
