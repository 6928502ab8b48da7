//! View of the potential well, with the mass on it.
//!
//! The mass moves like a ball on the potential that the push of the base tips ([`TippedPotential`]), which is
//! drawn thick, the potential of the mechanism alone thin. The vertical range follows the largest push in a
//! few coarse steps, so that the curve tilts and does not rescale, and it holds while the mechanism changes.

use std::sync::Arc;

use eframe::egui::{self, Align2, Pos2, Rangef, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};

use crate::app::task::Identity;
use crate::app::ui::style::BALL;
use crate::app::words::numbers::{energy, three};
use crate::app::words::wells::well_name;
use crate::dynamics::Model;
use crate::mechanics::Barrier;
use crate::output::{
    Chart, DISPLACEMENT, Layer, Marks, PlotAxis, Role, TippedPotential, axis_name, suited_unit, well_panel,
};
use crate::scene::Start;
use interwell_studies::study::Table;

use super::ghosts::{Ghost, PINNED, circle, dashed, ghosts};
use super::hand::axes_input;
use super::labels::{Taken, ago, free_place};
use super::mass::mass_ui;
use super::pane::{LEGEND, Pane, Place, kept_pane_ui};
use super::ranges::{bottom, room_for_push};
use super::stops::{
    BEST_STOPS, WALL, asked_place, best_stops, outlined, sides, stops_ui, travel_limits, wall,
};
use super::view::Axis;
use super::{Cover, Span, View, ViewContext};

/// Distance in points between two samples of what the curve sweeps over.
const STEP: f32 = 2.0;

/// Height in points of the names of wells and barrier below the curve.
const NAMES: f32 = 17.0;

/// Largest distance of the ball above the curve, in radii.
const LIFT: f32 = 2.5;

/// Height in points of what stands below the picture.
const BELOW: f32 = 43.0;

/// Radius in points of the dot on the curve below the ball.
const PLACE: f32 = 3.5;

/// Greatest radius of the ball as a share of the distance between the stops, and its least in points.
const GAP_SHARE: f64 = 0.3;
const LEAST_BALL: f32 = 6.0;

/// Distance in points from the bracket from which on a line joins its label to it.
const LEADER: f32 = 80.0;

/// Half the width in points of an end of the bracket.
const BRACKET: f32 = 5.0;

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
    let (low, high) = energy_ends(ui, context, area.height());
    let (per_joule, unit) = suited_unit("J", std::iter::once(high - low));
    let (span, state) = (context.span, context.drawn.state(context.session));
    let model = Arc::clone(context.drawn.model(context.session));
    let level = Level { potential: TippedPotential::new(&model, 0.0, per_joule), unit };
    let tipped = level.potential.at_acceleration(state.base_accel);
    let points = tipped.points((span.low, span.high));
    // the potential of a pinned motion, where it differs from the present one
    let seen = 0.01 * (high - low) * per_joule;
    let all = ghosts(context);
    let of_ghosts: Vec<TippedPotential<'_>> = all
        .iter()
        .map(|ghost| TippedPotential::new(&ghost.model, ghost.state.base_accel, per_joule))
        .collect();
    let mut layers = Vec::new();
    for (ghost, curve) in all.iter().zip(&of_ghosts) {
        let pinned: Vec<_> = points.iter().map(|point| (point.0, curve.at(point.0))).collect();
        if pinned.iter().zip(&points).any(|(pinned, present)| (pinned.1 - present.1).abs() > seen) {
            layers.push(Layer::new(Role::Pin(ghost.place), "", Marks::Path(pinned)));
        }
    }
    let mut other: Vec<Role> = all.iter().map(|ghost| Role::Pin(ghost.place)).collect();
    other.extend(best_stops(context).map(|_| Role::BestStop));
    // while a question is asked it would be that of the motion before
    let has_energy = !model.is_shaken() && context.cover != Cover::Future;
    let key =
        (Identity(Arc::clone(&model)), [span.low, span.high, low, high], other.clone(), style, has_energy);
    let pane = kept_pane_ui(ui, &style, Place::in_line(ui, area, Sense::DRAG, (0.0, 0.0)), key, || {
        let across = PlotAxis::between(span.low * 1e3, span.high * 1e3, DISPLACEMENT);
        let up = PlotAxis::between(low * per_joule, high * per_joule, &axis_name("energy", unit));
        still(&level.potential, (&model, has_energy), span, (across, up), &other)
    });
    let Some(frame) = pane.frame(0) else { return };
    axes_input(ui, context.memory, View::Well, &pane.response, (area, frame));
    let (left, right) = model.stop_positions();
    // a mass between close stops leaves the curve to be seen
    let gap = left.zip(right).map_or(f64::INFINITY, |(left, right)| (right - left) * span.scale(frame));
    let radius = BALL.min((GAP_SHARE * gap) as f32).max(LEAST_BALL);
    layers.extend(tipped.line(points));
    if has_energy {
        let kinetic = model.energies(state.x, state.v).0;
        let energy = tipped.at(state.x * 1e3) + kinetic * per_joule;
        layers.push(Layer::new(Role::Separatrix, "", Marks::Horizontals(vec![energy])));
    }
    let painter = ui.painter().with_clip_rect(frame);
    pane.draw(&painter, &style, 0, &layers);
    let on_curve = |x: f64, curve: &TippedPotential<'_>| {
        let ahead = 0.1 * f64::from(radius) / span.scale(frame);
        let [at, ahead] =
            [x * 1e3, (x + ahead) * 1e3].map(|mm| pane.place(0, (mm, curve.at(mm))).unwrap_or(frame.min));
        let slope = (ahead.y - at.y) / (ahead.x - at.x).max(1e-6);
        at - vec2(0.0, radius * 1.0_f32.hypot(slope).min(LIFT))
    };
    let balls: Vec<(Pos2, &Ghost)> =
        all.iter().zip(&of_ghosts).map(|(ghost, curve)| (on_curve(ghost.state.x, curve), ghost)).collect();
    all.iter().for_each(|ghost| ghost.stops(&painter, context, frame, 0.0));
    let mut taken = Taken::default();
    landmarks(&painter, context, (&pane, frame), &level, &mut taken);
    let at = on_curve(state.x, &tipped);
    stops_ui(ui, context, frame, (frame.top() + 4.0, frame.bottom()), (0.0, true));
    mass_ui(ui, context, at, frame);
    if let Some(x) = asked_place(context, state.x) {
        let edge = Stroke::new(1.5, style.mass_edge());
        painter.extend(dashed(&circle(on_curve(x, &tipped), radius), 0, edge));
    }
    // drawn after the stops, since their letters may overlap one; whole at an end of an axis
    let over = ui.painter().with_clip_rect(frame.expand(BALL + 1.0).intersect(area));
    balls.iter().for_each(|(at, ghost)| ghost.ball(&over, &style, *at, radius));
    // set off from a wall, over which it stands as a mark
    let is_over = |stop: Option<f64>| {
        stop.is_some_and(|x| (context.span.screen_from_world(x, frame) - at.x).abs() < radius + WALL)
    };
    if is_over(left) || is_over(right) {
        over.circle_stroke(at, radius + 2.0, Stroke::new(2.5, style.ground()));
    }
    over.circle(at, radius, style.mass(), Stroke::new(1.5, style.mass_edge()));
    // where it is, and the potential that it has there
    let place = pane.place(0, (state.x * 1e3, tipped.at(state.x * 1e3))).unwrap_or(at);
    over.circle(place, PLACE, style.mass(), Stroke::new(1.5, style.mass_edge()));
    if let (Some(left), Some(right)) = (left, right) {
        // where the ball comes between the stops
        let largest = model.largest_base_acceleration();
        let highest = [left, right].into_iter().flat_map(|x| {
            [-largest, largest].map(|accel| level.potential.at_acceleration(accel).at(x * 1e3))
        });
        let highest = pane.place(0, (0.0, highest.fold(f64::NEG_INFINITY, f64::max))).unwrap_or(at);
        let across = [left, right].map(|x| context.span.screen_from_world(x, frame));
        let up = highest.y - 2.0 * radius..=frame.bottom();
        taken.places.push(Rect::from_x_y_ranges(across[0]..=across[1], up));
    }
    travel_limits(&painter, context, frame, &mut taken);
    if let Some(ago) = ago(context.session) {
        pane.reading(ui, &style, 0.0, &ago);
    }
}

/// The parts that stay the same from frame to frame: axes, the potential without the push, and the legend,
/// also for the `other` motions and stops.
fn still(
    level: &TippedPotential<'_>,
    (model, has_energy): (&Model, bool),
    span: Span,
    axes: (PlotAxis, PlotAxis),
    other: &[Role],
) -> Chart {
    let mut panel = well_panel(level, (span.low, span.high), axes, model.is_shaken());
    if has_energy {
        panel.layer(Role::Separatrix, "energy of the mass", Marks::Path(Vec::new()));
    }
    for role in other {
        let name = if let Role::Pin(place) = role { PINNED[place % PINNED.len()] } else { BEST_STOPS };
        panel.layer(*role, name, Marks::Path(Vec::new()));
    }
    Chart::stack(vec![panel], "", Table::new())
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

/// Draws the height of the barrier as a bracket below its top, with its name where no curve comes that the
/// `largest` push tips to either side; and the names of the wells in a row below, without those that do not
/// fit. Between stops inside the wells the bracket has a mark at the energy that the mass has at each stop.
fn landmarks(
    painter: &egui::Painter,
    context: &ViewContext<'_>,
    (pane, rect): (&Pane, Rect),
    level: &Level<'_>,
    taken: &mut Taken,
) {
    let (style, model) = (context.style, context.drawn.model(context.session));
    let Some(barrier) = model.mechanism().landscape.barrier else { return };
    let look = (style.small(), style.faint());
    let screen = |x: f64| context.span.screen_from_world(x, rect);
    let outlined = outlined(context).map(|(mm, side, _)| (mm / 1e3, side));
    taken.places.extend(sides(model).chain(outlined).map(|(x, side)| wall(rect, screen(x), side)));
    let pinned = ghosts(context);
    for (x, _) in pinned.iter().flat_map(|ghost| sides(&ghost.model)) {
        taken.lines.push(vec![pos2(screen(x), rect.top()), pos2(screen(x), rect.bottom())]);
    }
    let potential = |x: f64| model.mechanism().curve.potential(x);
    let joule = potential(barrier.x) - bottom(model).0;
    let place = |x: f64, energy: f64| pane.place(0, (x * 1e3, energy)).unwrap_or(rect.min);
    let feet = feet(model, &barrier);
    let heights = feet.map_or([joule; 2], |feet| feet.map(|foot| potential(barrier.x) - potential(foot)));
    let below_top = |height: f64| place(barrier.x, (joule - height) * level.potential.per_joule);
    let (top, foot) = (below_top(0.0), below_top(joule));
    let mut bracket = Vec::new();
    if foot.y - top.y > 4.0 * BRACKET && foot.y < rect.bottom() {
        let stroke = Stroke::new(style.width(1.3), style.faint());
        let [left, right] = [-BRACKET, BRACKET].map(|aside| vec2(aside, 0.0));
        let mut lines = vec![[top + left, top + right], [top, foot], [foot + left, foot + right]];
        if feet.is_some() {
            // as high as a mass on each stop
            let [on_left, on_right] = heights.map(below_top);
            lines.extend([[on_left, on_left + left], [on_right, on_right + right]]);
        }
        taken.lines.extend(lines.iter().map(|line| line.to_vec()));
        bracket.extend(lines.into_iter().map(|line| Shape::line_segment(line, stroke)));
    }
    let zero = place(barrier.x, 0.0).y;
    taken.lines.push(vec![pos2(rect.left(), zero), pos2(rect.right(), zero)]);
    let largest = model.largest_base_acceleration();
    let swept = |x: f32| {
        let x = context.span.world_from_screen(x, rect);
        let tipped = |accel: f64| level.potential.at_acceleration(accel).at(x * 1e3);
        [-largest, 0.0, largest].map(|accel| place(x, tipped(accel))).into()
    };
    let count = (rect.width() / STEP) as usize;
    taken.lines.extend((0..=count).map(|i| swept(rect.left() + STEP * i as f32)));
    let (line, lines) = match feet {
        None => {
            let line = format!("barrier {}", level.written(joule));
            let lines = line.replacen(' ', "\n", 1);
            (line, lines)
        }
        Some(_) if (heights[0] - heights[1]).abs() < 5e-3 * joule => {
            let (climb, whole) = (level.written(heights[0]), level.written(joule));
            let line = format!("barrier {whole}, {climb} from a stop");
            (line, format!("barrier\n{whole},\n{climb}\nfrom a stop"))
        }
        Some(_) => {
            let [whole, left, right] = [joule, heights[0], heights[1]].map(|height| level.written(height));
            let line = format!("barrier {whole}, {left} from the left stop, {right} from the right");
            (line, format!("barrier\n{whole},\n{left}\nfrom the left,\n{right}\nfrom the right"))
        }
    };
    let narrow = lines.replace("from ", "from\n");
    let (x, row) = (foot.x, rect.bottom() - 3.0);
    let places = [
        (line.as_str(), foot + vec2(0.0, 4.0), Align2::CENTER_TOP),
        (lines.as_str(), pos2(x + 5.0, foot.y - 4.0), Align2::LEFT_BOTTOM),
        (lines.as_str(), pos2(x - 5.0, foot.y - 4.0), Align2::RIGHT_BOTTOM),
        (lines.as_str(), foot + vec2(0.0, 4.0), Align2::CENTER_TOP),
        (line.as_str(), pos2(x, row), Align2::CENTER_BOTTOM),
        (lines.as_str(), pos2(x, row), Align2::CENTER_BOTTOM),
    ];
    // between close stops there is no room
    let stops: Vec<f32> = sides(model).map(|(stop, _)| screen(stop)).collect();
    let (low, high) = stops.iter().fold((x, x), |(low, high), stop| (low.min(*stop), high.max(*stop)));
    let behind = (5..=20).step_by(3).flat_map(|tenths| {
        let y = egui::lerp(top.y..=foot.y, 0.1 * tenths as f32);
        let right = (lines.as_str(), pos2(high + WALL + 6.0, y), Align2::LEFT_CENTER);
        [right, (lines.as_str(), pos2(low - WALL - 6.0, y), Align2::RIGHT_CENTER)]
    });
    let beside = [0.15, 0.25, 0.35, 0.65, 0.75, 0.85].into_iter().flat_map(|share| {
        let at = |up: f32| pos2(egui::lerp(rect.x_range(), share), row - up * NAMES);
        [1.0, 3.0, 5.0].map(|up| (lines.as_str(), at(up), Align2::CENTER_BOTTOM))
    });
    let narrow = (narrow.as_str(), foot + vec2(0.0, 4.0), Align2::CENTER_TOP);
    let places = places.into_iter().chain(behind).chain([narrow]).chain(beside);
    // a bracket without its number says nothing
    if let Some(place) = taken.write(painter, rect, look.clone(), places) {
        painter.extend(bracket);
        if place.distance_to_pos(foot) > LEADER {
            painter.line_segment([place.clamp(foot), foot], Stroke::new(1.0, style.faint()));
        }
    }
    let wells = model.mechanism().landscape.wells();
    let ranges: Vec<Rangef> = taken.places.iter().map(|place| place.x_range()).collect();
    let names = wells.iter().enumerate().map(|(number, well)| {
        let name = well_name(number, wells.len());
        let width = painter.layout_no_wrap(name.clone(), style.small(), style.faint()).size().x;
        Some((name, free_place(screen(well.x), width, rect.x_range(), &ranges)?))
    });
    // all of them, or none
    for (name, place) in names.collect::<Option<Vec<_>>>().unwrap_or_default() {
        taken.write(painter, rect, look.clone(), [(name.as_str(), pos2(place, row), Align2::LEFT_BOTTOM)]);
    }
}

/// The ends of the vertical axis in J for a view of this height in points: those of the potential energies
/// that the mass reaches, with a margin, and with room for names at the bottom.
fn energy_ends(ui: &Ui, context: &mut ViewContext<'_>, height: f32) -> (f64, f64) {
    let model = context.drawn.model(context.session);
    let pinned =
        ghosts(context).iter().map(|ghost| ghost.model.largest_base_acceleration()).fold(0.0, f64::max);
    let largest = model.largest_base_acceleration().max(pinned).max(context.memory.push_of_lesson);
    let room = room_for_push(largest);
    let curve = &model.mechanism().curve;
    let landscape = &model.mechanism().landscape;
    let tilt = if model.is_shaken() { model.mass() * room } else { 0.0 };
    let (zero, push) = (bottom(model).0, room);
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
    let frame = height - LEGEND - BELOW;
    // room for the ball above the highest place
    let ball = LIFT * BALL / (frame - LIFT * BALL).max(LIFT * BALL);
    let room = f64::from(ball).max(0.22) * (high - low);
    let in_gesture = context.session.editor.in_gesture();
    let ends = (low - 0.5 * room, high + room);
    let frozen = &mut context.memory.frozen;
    let ends = if frozen.room == push {
        frozen.energy.hold(ends, in_gesture)
    } else {
        frozen.room = if in_gesture { frozen.room } else { push };
        frozen.energy.keep(ends, in_gesture)
    };
    let (low, high) = context.memory.axes.ends(Axis::Up(View::Well), ends);
    let id = ui.scope_id();
    let ease = |name: &str, value: f64| {
        let target = (value * 1e6) as f32;
        f64::from(ui.ctx().animate_value_with_time(id.with(name), target, 0.3)) * 1e-6
    };
    let (low, high) = (ease("low", low), ease("high", high));
    let names = if frame > 4.0 * NAMES { NAMES / (frame - NAMES) } else { 0.0 };
    (low - f64::from(names) * (high - low), high)
}
