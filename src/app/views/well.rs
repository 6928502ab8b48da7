//! View of the potential well, with the mass on it.
//!
//! In the frame of the base, the force of the mechanism and the push -m a_b act on the mass. The potential of
//! the push is m a_b x, and the mass moves like a ball on the sum of both potentials. The sum is drawn thick,
//! the potential of the mechanism alone thin. The vertical range follows the largest push in a few coarse
//! steps, so that the curve tilts and does not rescale.

use eframe::egui::{self, Align2, Pos2, Rangef, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};

use crate::app::ui::style::BALL;
use crate::app::words::wells::well_name;

use super::chart::{CURVE_STEP, x_axis};
use super::ghosts::{dashed, ghosts};
use super::hand::axes_input;
use super::labels::{ago, free_place, haloed};
use super::legend::{LEGEND, Symbol};
use super::mass::mass_ui;
use super::ranges::room_for_push;
use super::stops::{WALL, stops_ui};
use super::view::Axis;
use super::{View, ViewContext, too_small_ui};

pub fn well_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (area, response) = ui.allocate_exact_size(ui.available_size(), Sense::DRAG);
    if area.width() < 60.0 || area.height() < 60.0 {
        return too_small_ui(ui, &context.style, area);
    }
    let style = context.style;
    let rect = Rect::from_min_max(area.min + vec2(0.0, LEGEND), area.max - vec2(0.0, 22.0));
    let painter = ui.painter().with_clip_rect(area);
    painter.rect_filled(area, 0.0, style.ground());
    let axis = EnergyAxis::of(ui, context, rect);
    axes_input(ui, context.memory, View::Well, &response, (area, rect));
    x_axis(&painter, context, rect);

    let state = context.drawn.state(context.session);
    let model = context.drawn.model(context.session);
    let (curve, mass) = (&model.mechanism().curve, model.mass());
    let tilt = mass * state.base_accel;
    let (left, right) = model.stop_positions();
    let domain = curve.domain();
    let (low, high) = (context.span.low.max(domain.0), context.span.high.min(domain.1));
    let count = (rect.width() / CURVE_STEP).max(2.0) as usize;
    let place = |i: usize| low + (high - low) * i as f64 / count as f64;
    let height = |x: f64, tilt: f64| {
        let screen = pos2(
            context.span.screen_from_world(x, rect),
            axis.screen_from_world(curve.potential(x) + tilt * x),
        );
        // clamped far outside the view
        pos2(screen.x, screen.y.clamp(rect.top() - 4000.0, rect.bottom() + 4000.0))
    };
    let line = |tilt: f64| (0..=count).map(|i| height(place(i), tilt)).collect::<Vec<Pos2>>();
    let clipped = painter.with_clip_rect(rect);
    clipped.add(Shape::line(line(0.0), style.ghost_stroke()));
    let between = |x: f64| left.is_none_or(|stop| x >= stop) && right.is_none_or(|stop| x <= stop);
    let reachable: Vec<Pos2> =
        (0..=count).map(place).filter(|x| between(*x)).map(|x| height(x, tilt)).collect();
    clipped.extend(Shape::dashed_line(&line(tilt), style.ghost_stroke(), 5.0, 5.0));
    clipped.add(Shape::line(reachable, style.tray_stroke()));

    let mut balls = Vec::new();
    for ghost in ghosts(context) {
        let (state, tilted) = (ghost.state, ghost.model.mass() * ghost.state.base_accel);
        let curve = &ghost.model.mechanism().curve;
        let height = |x: f64| {
            let energy = curve.potential(x.clamp(curve.domain().0, curve.domain().1)) + tilted * x;
            let y = axis.screen_from_world(energy).clamp(rect.top() - 4000.0, rect.bottom() + 4000.0);
            pos2(context.span.screen_from_world(x, rect), y)
        };
        // its potential, where it differs from the present one
        let pinned: Vec<Pos2> = (0..=count).map(|i| height(place(i))).collect();
        if pinned.iter().zip(line(tilt)).any(|(pinned, present)| (pinned.y - present.y).abs() > 2.0) {
            clipped.extend(dashed(&pinned, ghost.place, style.ghost_stroke()));
        }
        ghost.stops(&clipped, context, rect, 0.0);
        balls.push((height(state.x) - vec2(0.0, BALL), ghost));
    }
    landmarks(&clipped, context, rect);
    let ball = height(state.x, tilt) - vec2(0.0, BALL);
    stops_ui(ui, context, rect, (rect.top() + 4.0, rect.bottom()), 0.0);
    mass_ui(ui, context, ball, rect);
    // drawn after the stops, since their letters may overlap one
    balls.iter().for_each(|(at, ghost)| ghost.ball(&clipped, &style, *at, BALL));
    let painter = ui.painter().with_clip_rect(rect);
    painter.circle(ball, BALL, style.mass(), Stroke::new(1.5, style.mass_edge()));
    legend(ui, context, area);
}

/// Writes the names of wells and barrier in a row below the curve, without those that do not fit.
fn landmarks(painter: &egui::Painter, context: &ViewContext<'_>, rect: Rect) {
    let (style, model) = (context.style, context.drawn.model(context.session));
    let Some(barrier) = model.mechanism().landscape.barrier else { return };
    let (left, right) = model.stop_positions();
    let screen = |x: f64| context.span.screen_from_world(x, rect);
    let wall = |stop: f64, side: f32| {
        let face = screen(stop);
        Rangef::new(face.min(face + side * WALL), face.max(face + side * WALL))
    };
    let mut taken: Vec<Rangef> =
        left.map(|x| wall(x, -1.0)).into_iter().chain(right.map(|x| wall(x, 1.0))).collect();
    let wells = model.mechanism().landscape.wells();
    let names = wells.iter().enumerate().map(|(number, well)| (well.x, well_name(number, wells.len())));
    for (x, name) in std::iter::once((barrier.x, "barrier".to_owned())).chain(names) {
        let width = painter.layout_no_wrap(name.clone(), style.small(), style.faint()).size().x;
        let Some(place) = free_place(screen(x), width, rect.x_range(), &taken) else { continue };
        let at = (pos2(place, rect.bottom() - 3.0), Align2::LEFT_BOTTOM);
        haloed(painter, &style, at, &name, (style.small(), style.faint()));
        taken.push(Rangef::new(place, place + width));
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
        let tilt = model.mass() * room;
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut show = |x: f64, tilted: bool| {
            let (v, side) = (curve.potential(x), if tilted { tilt * x.abs() } else { 0.0 });
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
        let ends = context.memory.frozen.energy.keep(ends, in_gesture);
        let (low, high) = context.memory.axes.ends(Axis::Up(View::Well), ends);
        let id = ui.scope_id();
        let ease = |name: &str, value: f64| {
            let target = (value * 1e6) as f32;
            f64::from(ui.ctx().animate_value_with_time(id.with(name), target, 0.3)) * 1e-6
        };
        Self { low: ease("low", low), high: ease("high", high), rect }
    }

    fn screen_from_world(&self, energy: f64) -> f32 {
        let share = (energy - self.low) / (self.high - self.low);
        self.rect.bottom() - (share * f64::from(self.rect.height())) as f32
    }
}

fn legend(ui: &Ui, context: &ViewContext<'_>, area: Rect) {
    let style = context.style;
    let entries = [
        (Symbol::Line(style.tray_stroke()), "potential with the push"),
        (Symbol::Line(style.ghost_stroke()), "the mechanism's own"),
    ];
    let y = area.top() + 0.5 * LEGEND;
    let mut right = area.right();
    if let Some(ago) = ago(context.session) {
        let at = (pos2(area.right() - 8.0, y), Align2::RIGHT_CENTER);
        let painter = ui.painter().with_clip_rect(area);
        right = haloed(&painter, &style, at, &ago, (style.small(), style.ink())).left();
    }
    super::legend::legend(ui, &style, area, right, &entries);
}
