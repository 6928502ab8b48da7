//! View of the potential well, with the mass on it.
//!
//! In the frame of the base, the force of the mechanism and the push -m a_b act on the mass. The potential of
//! the push is m a_b x, and the mass moves like a ball on the sum of both potentials. The sum is drawn thick,
//! the potential of the mechanism alone thin. The vertical range follows the largest push in a few coarse
//! steps, so that the curve tilts and does not rescale, and it holds while the mechanism changes. Energy is
//! counted from the bottom of the deepest well, or without a well from the lower stop.

use eframe::egui::{self, Align2, Pos2, Rangef, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};

use crate::app::ui::style::BALL;
use crate::app::words::numbers::energy;
use crate::app::words::wells::well_name;
use crate::output::suited_unit;

use super::chart::{CURVE_STEP, GUTTER, NAME, NUMBERS, x_axis, y_axis};
use super::ghosts::{Ghost, PINNED, dashed, ghosts};
use super::hand::axes_input;
use super::labels::{Taken, ago, free_place, haloed};
use super::legend::{LEGEND, Symbol};
use super::mass::mass_ui;
use super::plot::LOW;
use super::ranges::{bottom, room_for_push};
use super::stops::{WALL, stops_ui};
use super::view::Axis;
use super::{View, ViewContext, too_small_ui};

/// Height in points of the names of wells and barrier below the curve.
const NAMES: f32 = 17.0;

/// Largest distance of the ball above the curve, in radii.
const LIFT: f32 = 2.5;

/// Half the width in points of an end of the bracket.
const BRACKET: f32 = 5.0;

pub fn well_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (area, response) = ui.allocate_exact_size(ui.available_size(), Sense::DRAG);
    if area.width() < 60.0 || area.height() < 60.0 {
        return too_small_ui(ui, &context.style, area);
    }
    let style = context.style;
    let is_named = area.height() >= LOW;
    let below = NUMBERS + if is_named { NAME } else { 0.0 };
    let rect = Rect::from_min_max(area.min + vec2(GUTTER, LEGEND), area.max - vec2(0.0, below));
    let painter = ui.painter().with_clip_rect(area);
    painter.rect_filled(area, 0.0, style.ground());
    let names = if rect.height() > 4.0 * NAMES { NAMES } else { 0.0 };
    let axis = EnergyAxis::of(ui, context, rect.with_max_y(rect.bottom() - names));
    axes_input(ui, context.memory, View::Well, &response, (area, rect));
    x_axis(&painter, context, rect, is_named);
    axis.draw(&painter, context);

    let state = context.drawn.state(context.session);
    let model = context.drawn.model(context.session);
    let (curve, mass) = (&model.mechanism().curve, model.mass());
    let (tilt, bottom) = (mass * state.base_accel, bottom(model));
    let (left, right) = model.stop_positions();
    let domain = curve.domain();
    let (low, high) = (context.span.low.max(domain.0), context.span.high.min(domain.1));
    let count = (rect.width() / CURVE_STEP).max(2.0) as usize;
    let place = |i: usize| low + (high - low) * i as f64 / count as f64;
    let height = |x: f64, tilt: f64| {
        let screen = pos2(
            context.span.screen_from_world(x, rect),
            axis.screen_from_world(curve.potential(x) - bottom + tilt * x),
        );
        // clamped far outside the view
        pos2(screen.x, screen.y.clamp(rect.top() - 4000.0, rect.bottom() + 4000.0))
    };
    let line = |tilt: f64| (0..=count).map(|i| height(place(i), tilt)).collect::<Vec<Pos2>>();
    let clipped = painter.with_clip_rect(rect);
    clipped.add(Shape::line(line(0.0), style.ghost_stroke()));
    // the ball touches a stop at its travel limit
    let ball = f64::from(BALL) / context.span.scale(rect);
    let between =
        |x: f64| left.is_none_or(|stop| x >= stop - ball) && right.is_none_or(|stop| x <= stop + ball);
    let on_curve = |x: f64, height: &dyn Fn(f64) -> Pos2| {
        let (at, ahead) = (height(x), height(x + 0.1 * ball));
        let slope = (ahead.y - at.y) / (ahead.x - at.x).max(1e-6);
        at - vec2(0.0, BALL * 1.0_f32.hypot(slope).min(LIFT))
    };
    let reachable: Vec<Pos2> =
        (0..=count).map(place).filter(|x| between(*x)).map(|x| height(x, tilt)).collect();
    clipped.extend(Shape::dashed_line(&line(tilt), style.ghost_stroke(), 5.0, 5.0));
    clipped.add(Shape::line(reachable, style.tray_stroke()));

    let (mut balls, mut other): (Vec<(Pos2, Ghost)>, Vec<usize>) = (Vec::new(), Vec::new());
    for ghost in ghosts(context) {
        let (state, tilted) = (ghost.state, ghost.model.mass() * ghost.state.base_accel);
        let (curve, bottom) = (&ghost.model.mechanism().curve, super::ranges::bottom(&ghost.model));
        let height = |x: f64| {
            let own = curve.potential(x.clamp(curve.domain().0, curve.domain().1)) - bottom;
            let energy = own + tilted * x;
            let y = axis.screen_from_world(energy).clamp(rect.top() - 4000.0, rect.bottom() + 4000.0);
            pos2(context.span.screen_from_world(x, rect), y)
        };
        // its potential, where it differs from the present one
        let pinned: Vec<Pos2> = (0..=count).map(|i| height(place(i))).collect();
        if pinned.iter().zip(line(tilt)).any(|(pinned, present)| (pinned.y - present.y).abs() > 2.0) {
            clipped.extend(dashed(&pinned, ghost.place, style.ghost_stroke()));
            other.push(ghost.place);
        }
        ghost.stops(&clipped, context, rect, BALL);
        balls.push((on_curve(state.x, &height), ghost));
    }
    landmarks(&clipped, context, (&axis, rect), &height);
    let ball = on_curve(state.x, &|x| height(x, tilt));
    stops_ui(ui, context, rect, (rect.top() + 4.0, rect.bottom()), BALL);
    mass_ui(ui, context, ball, rect);
    // drawn after the stops, since their letters may overlap one
    balls.iter().for_each(|(at, ghost)| ghost.ball(&clipped, &style, *at, BALL));
    let painter = ui.painter().with_clip_rect(rect);
    painter.circle(ball, BALL, style.mass(), Stroke::new(1.5, style.mass_edge()));
    legend(ui, context, area.with_min_x(rect.left()), &other);
}

/// Draws the height of the barrier as a bracket below its top, with its name where no curve comes that the
/// `largest` push tips to either side; and the names of the wells in a row below, without those that do not
/// fit. The curve has a `height` on the screen for a displacement and a push in N.
fn landmarks(
    painter: &egui::Painter,
    context: &ViewContext<'_>,
    (axis, rect): (&EnergyAxis, Rect),
    height: &dyn Fn(f64, f64) -> Pos2,
) {
    let (style, model) = (context.style, context.drawn.model(context.session));
    let Some(barrier) = model.mechanism().landscape.barrier else { return };
    let look = (style.small(), style.faint());
    let screen = |x: f64| context.span.screen_from_world(x, rect);
    let (left, right) = model.stop_positions();
    let wall = |(stop, side): (f64, f32)| {
        let face = screen(stop) + side * BALL;
        Rect::from_two_pos(pos2(face, rect.top()), pos2(face + side * WALL, rect.bottom()))
    };
    let stops = [left.map(|x| (x, -1.0)), right.map(|x| (x, 1.0))].into_iter().flatten();
    let mut taken = Taken { lines: Vec::new(), places: stops.map(wall).collect() };
    let joule = model.mechanism().curve.potential(barrier.x) - bottom(model);
    let [top, foot] = [joule, 0.0].map(|energy| pos2(screen(barrier.x), axis.screen_from_world(energy)));
    if foot.y - top.y > 4.0 * BRACKET && foot.y < rect.bottom() {
        let stroke = Stroke::new(style.width(1.3), style.faint());
        let ends = [top, foot].map(|at| vec![at - vec2(BRACKET, 0.0), at + vec2(BRACKET, 0.0)]);
        taken.lines.extend(ends.into_iter().chain([vec![top, foot]]));
        painter.extend(taken.lines.iter().map(|line| Shape::line(line.clone(), stroke)));
    }
    taken.lines.push(vec![pos2(rect.left(), foot.y), pos2(rect.right(), foot.y)]);
    let largest = model.mass() * model.largest_base_acceleration();
    let swept = |x: f32| {
        let x = context.span.world_from_screen(x, rect);
        [-largest, 0.0, largest].map(|push| height(x, push)).into()
    };
    let count = (rect.width() / CURVE_STEP) as usize;
    taken.lines.extend((0..=count).map(|i| swept(rect.left() + CURVE_STEP * i as f32)));
    let line = format!("barrier {}", energy(joule));
    let lines = line.replacen(' ', "\n", 1);
    let (x, row) = (foot.x, rect.bottom() - 3.0);
    let places = [
        (line.as_str(), foot + vec2(0.0, 4.0), Align2::CENTER_TOP),
        (lines.as_str(), pos2(x + 5.0, foot.y - 4.0), Align2::LEFT_BOTTOM),
        (lines.as_str(), pos2(x - 5.0, foot.y - 4.0), Align2::RIGHT_BOTTOM),
        (lines.as_str(), foot + vec2(0.0, 4.0), Align2::CENTER_TOP),
        (line.as_str(), pos2(x, row), Align2::CENTER_BOTTOM),
        (lines.as_str(), pos2(x, row), Align2::CENTER_BOTTOM),
    ];
    taken.write(painter, rect, look.clone(), places);
    let wells = model.mechanism().landscape.wells();
    for (number, well) in wells.iter().enumerate() {
        let name = well_name(number, wells.len());
        let width = painter.layout_no_wrap(name.clone(), style.small(), style.faint()).size().x;
        let ranges: Vec<Rangef> = taken.places.iter().map(|place| place.x_range()).collect();
        let Some(place) = free_place(screen(well.x), width, rect.x_range(), &ranges) else { continue };
        taken.write(painter, rect, look.clone(), [(name.as_str(), pos2(place, row), Align2::LEFT_BOTTOM)]);
    }
}

/// The vertical axis, in J.
struct EnergyAxis {
    low: f64,
    high: f64,
    rect: Rect,
}

impl EnergyAxis {
    /// Covers the potential energies that the mass reaches, with a margin.
    fn of(ui: &Ui, context: &mut ViewContext<'_>, rect: Rect) -> Self {
        let model = context.drawn.model(context.session);
        let room = room_for_push(model.largest_base_acceleration());
        let curve = &model.mechanism().curve;
        let landscape = &model.mechanism().landscape;
        let (tilt, zero, push) = (model.mass() * room, bottom(model), room);
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
                    show(x.clamp(domain.0, domain.1), model.is_shaken());
                }
                show(0.0, false);
            }
        }
        if !(high - low > 0.0) {
            (low, high) = (low - 1e-3, low + 1e-3);
        }
        let room = 0.22 * (high - low);
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
        Self { low: ease("low", low), high: ease("high", high), rect }
    }

    /// Draws its grid, numbers and name, in a unit that suits its length.
    fn draw(&self, painter: &egui::Painter, context: &ViewContext<'_>) {
        let (factor, unit) = suited_unit("J", std::iter::once(self.high - self.low));
        let ends = (self.low * factor, self.high * factor);
        y_axis(painter, &context.style, self.rect, ends, &format!("energy ({unit})"));
    }

    fn screen_from_world(&self, energy: f64) -> f32 {
        let share = (energy - self.low) / (self.high - self.low);
        self.rect.bottom() - (share * f64::from(self.rect.height())) as f32
    }
}

/// Draws the legend: the curves, and those of the `other` motions that are pinned.
fn legend(ui: &Ui, context: &ViewContext<'_>, area: Rect, other: &[usize]) {
    let style = context.style;
    let mut entries = vec![
        (Symbol::Line(style.tray_stroke()), "potential with the push"),
        (Symbol::Line(style.ghost_stroke()), "the mechanism's own"),
    ];
    if context.drawn.model(context.session).stop_positions() != (None, None) {
        entries.push((Symbol::Dashed(style.ghost_stroke()), "beyond the stops"));
    }
    let pinned = |place: &usize| (Symbol::Dashes(style.ghost_stroke(), *place), PINNED[*place]);
    entries.extend(other.iter().map(pinned));
    let y = area.top() + 0.5 * LEGEND;
    let mut right = area.right();
    if let Some(ago) = ago(context.session) {
        let at = (pos2(area.right() - 8.0, y), Align2::RIGHT_CENTER);
        let painter = ui.painter().with_clip_rect(area);
        right = haloed(&painter, &style, at, &ago, (style.small(), style.ink())).left();
    }
    super::legend::legend(ui, &style, area, right, &entries);
}
