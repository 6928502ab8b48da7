//! The mechanism as a drawing, over the well and on its x axis, seen from the base.
//!
//! Where the force comes from flexures they are drawn as they are bent ([`flexures`](super::flexures)); else a schematic
//! has clamps, flexures and the mass in the right places along x, not to scale across it. The base stands
//! still in it, and the push that the mass feels instead is an arrow; the base's own motion is far larger than the travel
//! and has an inset at its own scale. An impact is a ring whose size is the energy that it takes.

use eframe::egui::{self, Align2, Color32, Pos2, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};

use crate::app::style::{BALL, RING_SECONDS};
use crate::dynamics::{EventKind, STANDARD_GRAVITY, Side};

use super::flexures::{CLAMP, Place, Scale, bulge_words, clamp, state_at};
use super::labels::ago;
use super::stops::stops_beside_ui;
use super::well::mass_ui;
use super::{ViewContext, too_small_ui};

/// Points of a drawn flexure.
const FLEXURE_POINTS: usize = 24;

/// Length in points of an arrow's head.
const ARROW_HEAD: f32 = 12.0;

/// Room in points that the base's own motion needs.
const INSET: f32 = 184.0;

/// A ring that grows and fades.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ring {
    /// Screen time in s at which it began.
    began: f64,
    /// Share of the energy scale.
    size: f64,
}

/// Draws it. Whether something changed.
pub fn mechanism_ui(ui: &mut Ui, context: &mut ViewContext<'_>) -> bool {
    let (rect, _) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
    if rect.width() < 60.0 || rect.height() < 60.0 {
        too_small_ui(ui, &context.style, rect);
        return false;
    }
    // an axis of its own only where no other view stands on it
    let shared = context.span;
    let changed = drawing_ui(ui, context, rect);
    context.span = shared;
    changed
}

fn drawing_ui(ui: &mut Ui, context: &mut ViewContext<'_>, rect: Rect) -> bool {
    let style = context.style;
    let painter = ui.painter().with_clip_rect(rect);
    painter.rect_filled(rect, 0.0, style.ground());
    let state = context.session.player.state();
    let (top, bottom) = (rect.top() + 28.0, rect.bottom() - 12.0);
    // as wide as the ball on the well, so that it touches the stops when it should
    let half = vec2(BALL, ((bottom - top) * 0.13).clamp(14.0, 30.0));
    for (y, above) in [(top, true), (bottom, false)] {
        let y = if above { y - CLAMP..=y } else { y..=y + CLAMP };
        clamp(&painter, &style, Rect::from_x_y_ranges(rect.x_range().shrink(6.0), y), above);
    }
    let place = Place { top, bottom, half };
    let (middle, words) = match bent_ui(&painter, context, rect, place, state.x) {
        Some(drawn) => drawn,
        None => {
            let middle = 0.5 * (top + bottom);
            let x = context.span.screen_from_world(state.x, rect);
            flexures(&painter, context, rect, (x, middle, half), (top, bottom));
            (middle, "schematic, seen from the base".to_owned())
        }
    };
    let x = context.span.screen_from_world(state.x, rect);
    let body = Rect::from_center_size(pos2(x, middle), half * 2.0);
    let edge = Stroke::new(1.5, style.mass_edge());
    painter.rect(body, 3.0, style.mass(), edge, egui::StrokeKind::Inside);
    let heights = (middle - half.y - 4.0, middle + half.y + 4.0);
    let mut changed = stops_beside_ui(ui, context, rect, heights, BALL);
    changed |= mass_ui(ui, context, pos2(x, middle), rect);
    rings(ui, context, rect, middle);
    push_arrow(&painter, context, body, state.base_accel, rect);
    words_ui(&painter, context, rect, &words, state.base_accel);
    changed
}

/// The flexures as they are bent, where there are such: the middle of the body, and what is said of the drawing.
fn bent_ui(
    painter: &egui::Painter,
    context: &mut ViewContext<'_>,
    rect: Rect,
    place: Place,
    x: f64,
) -> Option<(f32, String)> {
    let bent = state_at(context, x)?;
    let style = context.style;
    let mechanism = &context.session.shown().mechanism;
    let geometry = mechanism.flexures.as_ref()?.geometry();
    let scale = Scale::of(geometry, place);
    let reach = mechanism.landscape.right_stable().map_or(0.0, |well| well.x.abs());
    if context.filled
        && let Some(own) = scale.true_span(reach, rect)
    {
        context.span = own;
    }
    painter.extend(scale.shapes(geometry, &bent, context.span, rect, style.flexure_stroke()));
    scale.bar(painter, &style, pos2(rect.right() - 18.0, place.bottom - 8.0));
    let words = bulge_words(&bent);
    // beside the feet of the flexures, where these never are
    let at = pos2(rect.left() + 12.0, place.bottom - 5.0);
    painter.text(at, Align2::LEFT_BOTTOM, words, style.body(), style.ink());
    let words = format!("seen from the base, {}", scale.words(context.span, rect));
    Some((scale.middle(&bent), words))
}

/// Two guided flexures below the mass and the buckled one above it.
fn flexures(
    painter: &egui::Painter,
    context: &ViewContext<'_>,
    rect: Rect,
    (x, middle, half): (f32, f32, egui::Vec2),
    (top, bottom): (f32, f32),
) {
    let stroke = context.style.flexure_stroke();
    let zero = context.span.screen_from_world(0.0, rect);
    let landscape = &context.session.shown().mechanism.landscape;
    // The bump is largest at the barrier and gone at the wells, where the flexure is straight.
    let (place, well) = match landscape.barrier {
        Some(barrier) => {
            (x - context.span.screen_from_world(barrier.x, rect), barrier.right_well - barrier.x)
        }
        None => (0.0, 0.0),
    };
    let reach = (context.span.scale(rect) * well) as f32;
    let left = if reach > 0.0 { (1.0 - (place / reach).powi(2)).max(0.0) } else { 0.0 };
    let bump = 0.35 * (middle - top) * left.sqrt();
    let shape = |from: Pos2, to: Pos2, bump: f32| {
        let point = |i: usize| {
            let s = i as f32 / FLEXURE_POINTS as f32;
            let guided = s * s * (3.0 - 2.0 * s);
            let bulge = (std::f32::consts::PI * s).sin().powi(2);
            pos2(from.x + (to.x - from.x) * guided + bump * bulge, from.y + (to.y - from.y) * s)
        };
        Shape::line((0..=FLEXURE_POINTS).map(point).collect(), stroke)
    };
    for side in [-0.6, 0.6] {
        let foot = pos2(zero + side * half.x, bottom);
        painter.add(shape(foot, pos2(x + side * half.x, middle + half.y), 0.0));
    }
    painter.add(shape(pos2(zero, top), pos2(x, middle - half.y), bump));
}

/// What pushes the mass in the base's frame, -m a_b, as an arrow of m a_b / (m g). It lies at the mass's height on the
/// inner side of the body, where neither flexures nor stops are.
fn push_arrow(painter: &egui::Painter, context: &ViewContext<'_>, body: Rect, base_accel: f64, rect: Rect) {
    if !context.session.shown().is_shaken() {
        return;
    }
    let style = context.style;
    let full = f64::from(rect.width()) * 0.16;
    let room = context.session.shown().largest_push().max(1e-9);
    let push = (-base_accel / room * full) as f32;
    let inner = if body.center().x > rect.center().x { -1.0 } else { 1.0 };
    let near = body.center().x + inner * (body.width() * 0.5 + 6.0);
    let far = near + inner * push.abs();
    let (y, stroke) = (body.center().y, style.arrow_stroke());
    if push.abs() > 3.0 {
        let (tail, tip) = if push * inner > 0.0 { (near, far) } else { (far, near) };
        let head = ARROW_HEAD.min(push.abs()) * push.signum();
        painter.line_segment([pos2(tail, y), pos2(tip - 0.5 * head, y)], stroke);
        let points = vec![pos2(tip, y), pos2(tip - head, y - 6.0), pos2(tip - head, y + 6.0)];
        painter.add(Shape::convex_polygon(points, stroke.color, Stroke::NONE));
    }
}

/// The row over the drawing, where nothing moves: when, what is seen, how hard it is pushed, and how the base moves.
fn words_ui(painter: &egui::Painter, context: &ViewContext<'_>, rect: Rect, words: &str, base_accel: f64) {
    let style = context.style;
    let mut at = rect.left_top() + vec2(10.0, 4.0);
    let mut put = |text: String, color: Color32| {
        at.x = painter.text(at, Align2::LEFT_TOP, text, style.small(), color).right() + 14.0;
    };
    if let Some(ago) = ago(context.session) {
        put(ago, style.ink());
    }
    put(words.to_owned(), style.faint());
    if context.session.shown().is_shaken() {
        put(format!("push {:.2} g", (base_accel / STANDARD_GRAVITY).abs()), style.base());
    }
    inset(painter, context, Rect::from_min_max(pos2(at.x, rect.top()), rect.max), base_accel);
}

/// The base's own motion at its own scale, for a sine, whose displacement is -a/(2 pi f)^2.
fn inset(painter: &egui::Painter, context: &ViewContext<'_>, rect: Rect, base_accel: f64) {
    let Some((amplitude, rate)) = context.session.shown().single_sine() else { return };
    let (swing, place) = (amplitude / (rate * rate), -base_accel / (rate * rate));
    if !(swing > 0.0 && swing.is_finite()) || rect.width() < INSET {
        return;
    }
    let style = context.style;
    let half = 34.0;
    let track = pos2(rect.right() - half - 20.0, rect.top() + 11.0);
    painter.line_segment([track - vec2(half, 0.0), track + vec2(half, 0.0)], style.ghost_stroke());
    let at = track + vec2((place / swing) as f32 * half, 0.0);
    painter.rect_filled(Rect::from_center_size(at, vec2(14.0, 9.0)), 2.0, style.base());
    let text = format!("base: ±{:.1} mm", swing * 1e3);
    let left = track - vec2(half + 14.0, 0.0);
    painter.text(left, Align2::RIGHT_CENTER, text, style.small(), style.base());
}

/// Impacts since the last frame begin a ring, one at a time a side; rings under way are drawn.
fn rings(ui: &Ui, context: &mut ViewContext<'_>, rect: Rect, y: f32) {
    let now = ui.input(|input| input.time);
    let (from, to) = (context.memory.seen_to, context.session.player.time());
    context.memory.seen_to = to;
    let model = context.session.shown();
    let (left, right) = model.stop_positions();
    if to > from && !context.reduce_motion {
        let watch = context.session.player.watch();
        let first = watch.events().partition_point(|event| event.t <= from);
        let scale = model.scales.speed * model.scales.speed;
        for event in watch.events().range(first..).take_while(|event| event.t <= to) {
            let side = usize::from(event.side == Side::Right);
            let busy = context.memory.rings[side].is_some_and(|ring| now - ring.began < RING_SECONDS);
            // A compliant stop takes its share over the contact that begins here.
            let kept = match &model.compliant {
                Some(stop) => stop.restitution(event.v_in.abs()) * event.v_in,
                None => event.v_out,
            };
            let taken = (event.v_in * event.v_in - kept * kept) / scale;
            if matches!(event.kind, EventKind::Impact | EventKind::Contact) && !busy && taken > 1e-4 {
                context.memory.rings[side] = Some(Ring { began: now, size: taken.min(1.0) });
            }
        }
    }
    let style = context.style;
    let painter = ui.painter().with_clip_rect(rect);
    for (side, stop) in [left, right].into_iter().enumerate() {
        let (Some(ring), Some(stop)) = (context.memory.rings[side], stop) else { continue };
        let age = (now - ring.began) / RING_SECONDS;
        if !(0.0..1.0).contains(&age) {
            context.memory.rings[side] = None;
            continue;
        }
        let way = if side == 0 { -BALL } else { BALL };
        let center = pos2(context.span.screen_from_world(stop, rect) + way, y);
        let radius = (8.0 + 42.0 * ring.size.sqrt() * age) as f32;
        let color: Color32 = style.impact().gamma_multiply((1.0 - age) as f32);
        painter.circle_stroke(center, radius, Stroke::new(2.5, color));
        ui.ctx().request_repaint();
    }
}
