//! View of the mechanism as a drawing in the frame of the base, on the x axis of the well.
//!
//! Flexures are drawn in their bent shape ([`flexures`](super::flexures)). Another force is drawn as a
//! spring, and a constant force not at all. Springs, magnets and a transducer are drawn
//! [`beside`](super::beside) these. The base stands still, and its push on the mass is an arrow; the motion
//! of the base is far larger than the travel and is drawn in an inset at another scale. An impact is a ring
//! whose size shows the energy that it takes.

use eframe::egui::{self, Align2, Color32, Pos2, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};

use crate::app::ui::style::{BALL, RING_SECONDS};
use crate::app::words::meanings::explained;
use crate::app::words::numbers::{decimals_for, three};
use crate::dynamics::{EventKind, STANDARD_GRAVITY, Side};

use super::beside::{Attachments, MIN_LABELLED, Places};
use super::flexures::{CLAMP, DrawingArea, DrawingScale, Sketch, bulge_words, state_at};
use super::ghosts::ghosts;
use super::labels::{Taken, ago};
use super::mass::{OUTLINE, body_ui, was_dragged};
use super::memory::Ring;
use super::pane::{GUTTER, RIGHT};
use super::schematic::Schematic;
use super::stops::{WALL, stops_ui};
use super::{Cover, Drawn, LegendRow, ViewContext};

/// Height in points of the name of a stop above the foot of the stop, clear of the rail.
const CLEAR: f32 = 6.0;

/// Length in points of an arrow's head.
const ARROW_HEAD: f32 = 12.0;
/// Distance in points of the arrow from the body.
const BESIDE_BODY: f32 = 6.0;
/// Distance in points of the arrow from the ends of the stops.
const BESIDE_STOPS: f32 = 10.0;

/// The foot of a flexure is its part next to the clamp, one in `FOOT` of its points.
const FOOT: usize = 5;

/// Width in points that the inset with the motion of the base needs.
const INSET: f32 = 184.0;

pub fn mechanism_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (rect, _) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
    // above the picture of the well; a true scale changes the x axis of this view only
    let shared = context.span;
    context.span = shared.beside((GUTTER, RIGHT), rect);
    drawing_ui(ui, context, rect);
    context.span = shared;
}

fn drawing_ui(ui: &mut Ui, context: &mut ViewContext<'_>, rect: Rect) {
    let (style, state) = (context.style, context.drawn.state(context.session));
    let painter = ui.painter().with_clip_rect(rect);
    let (top, bottom) = (rect.top() + 28.0, rect.bottom() - 12.0);
    // as wide as the ball on the well, so that it touches the stops when it should
    let half = vec2(BALL, ((bottom - top) * 0.19).clamp(21.0, 45.0));
    let area = DrawingArea { top, bottom, half };
    let beside = Attachments::of(context.drawn.model(context.session));
    let behind = painter.add(Shape::Noop);
    let mut sketch = Sketch { painter, rect, style, area, taken: Taken::default() };
    let (middle, words, along, feet) = match sketch.bent(context, state.x) {
        Some((middle, words, along, feet)) => (middle, words, Some(along), feet),
        None => {
            let mass = pos2(context.span.screen_from_world(state.x, rect), 0.5 * (top + bottom));
            (mass.y, sketch.schematic(context, mass, &beside), None, Vec::new())
        }
    };
    let x = context.span.screen_from_world(state.x, rect);
    let body = Rect::from_center_size(pos2(x, middle), half * 2.0);
    let zero = context.span.screen_from_world(0.0, rect);
    let heights = (middle - half.y - 4.0, middle + half.y + 4.0);
    sketch.taken.places.push(body);
    sketch.taken.places.extend(walls(context, rect, heights));
    sketch.bulge_ui(ui, context);
    beside.draw(ui, &mut sketch, behind, &Places { rect, bottom, body, zero, along, feet });
    let painter = sketch.painter.clone();
    for ghost in ghosts(context) {
        let walls = rect.with_min_y(heights.0).with_max_y(heights.1);
        ghost.stops(&painter, context, walls, BALL);
        let x = context.span.screen_from_world(ghost.state.x, rect);
        ghost.body(&painter, &style, Rect::from_center_size(pos2(x, middle), half * 2.0));
    }
    // over the pinned ones
    let edge = Stroke::new(1.5, style.mass_edge());
    painter.rect(body, 3.0, style.mass(), edge, egui::StrokeKind::Inside);
    stops_ui(ui, context, rect, heights, BALL);
    // dots, by which it can be dragged
    for (i, j) in (-1..=1).flat_map(|i| [(i, -1), (i, 1)]) {
        let at = body.center() + vec2(3.0 * j as f32, 6.0 * i as f32);
        painter.circle_filled(at, 1.5, style.mass_edge());
    }
    if body_ui(ui, context, (pos2(x, middle), body), rect) {
        let stroke = style.pointing_stroke();
        painter.rect_stroke(body.expand(OUTLINE), 5.0, stroke, egui::StrokeKind::Middle);
    }
    rings(ui, context, rect, middle);
    // clear of stops, and of what is beside the flexures
    let has_stops = context.drawn.model(context.session).stop_positions() != (None, None);
    let y = match (has_stops, beside.stands_below()) {
        (false, _) => middle - beside.lift() * half.y,
        (true, false) => heights.1 + BESIDE_STOPS,
        (true, true) => heights.0 - BESIDE_STOPS,
    };
    sketch.push_arrow(context, body, y, state.base_accel);
    let is_new = !was_dragged(ui) && context.cover == Cover::None && context.drawn == Drawn::WithGhosts;
    let mass = if is_new { "mass: drag me" } else { "mass" };
    sketch.part_names(context, heights, (body, mass));
    sketch.caption_ui(ui, context, &words, state.base_accel);
}

/// The walls of the stops between these heights.
fn walls(context: &ViewContext<'_>, rect: Rect, (top, bottom): (f32, f32)) -> impl Iterator<Item = Rect> {
    let (left, right) = context.drawn.model(context.session).stop_positions();
    let (span, stops) = (context.span, [left.map(|x| (x, -1.0)), right.map(|x| (x, 1.0))]);
    stops.into_iter().flatten().map(move |(x, side)| {
        let face = span.screen_from_world(x, rect) + side * BALL;
        Rect::from_two_pos(pos2(face, top), pos2(face + side * WALL, bottom))
    })
}

/// A text of the row above the drawing, its colour and its priority: the lowest is left out first.
type Entry = (String, Color32, u8);

impl Sketch {
    /// Names the kinds of parts, each once, where nothing is drawn: the flexure or the spring at its clamp,
    /// the mass at a corner, a stop at its foot.
    fn part_names(&mut self, context: &ViewContext<'_>, heights: (f32, f32), (body, mass): (Rect, &str)) {
        if self.rect.width() < MIN_LABELLED.x || self.rect.height() < MIN_LABELLED.y {
            return;
        }
        let (rect, mechanism) = (self.rect, context.drawn.model(context.session).mechanism());
        let barrier = mechanism.landscape.barrier.map_or(0.0, |barrier| barrier.x);
        let is_spring = || Schematic::of(mechanism, context.span) == Schematic::Spring;
        let named = match mechanism.flexures {
            Some(_) => Some(("flexure", 0.0)),
            None => is_spring().then_some(("spring", barrier)),
        };
        if let Some((name, x)) = named {
            let (foot, top) = (context.span.screen_from_world(x, rect), self.area.top + 5.0);
            let aside = [16.0, 26.0, 40.0].into_iter().flat_map(|aside| [aside, -aside]);
            self.name(aside.map(|aside| {
                let align = if aside > 0.0 { Align2::LEFT_TOP } else { Align2::RIGHT_TOP };
                (name, pos2(foot + aside, top), align)
            }));
        }
        // above the stops, or below them
        let (above, below) = (heights.0.min(body.top()) - 4.0, heights.1.max(body.bottom()) + 4.0);
        let corners = [
            (body.right() + 2.0, above, Align2::LEFT_BOTTOM),
            (body.left() - 2.0, above, Align2::RIGHT_BOTTOM),
            (body.right() + 2.0, below, Align2::LEFT_TOP),
            (body.left() - 2.0, below, Align2::RIGHT_TOP),
        ];
        self.name(corners.map(|(x, y, align)| (mass, pos2(x, y), align)));
        let y = heights.1 - CLEAR;
        self.name(walls(context, rect, heights).flat_map(|wall| {
            let right = (wall.right() + 5.0, Align2::LEFT_BOTTOM);
            let left = (wall.left() - 5.0, Align2::RIGHT_BOTTOM);
            let is_left = wall.center().x < context.span.screen_from_world(0.0, rect);
            let sides = if is_left { [left, right] } else { [right, left] };
            sides.map(|(x, align)| ("stop", pos2(x, y), align))
        }));
    }

    /// Writes a name at the first of these places that is free.
    fn name<'a>(&mut self, places: impl IntoIterator<Item = (&'a str, Pos2, Align2)>) {
        let look = (self.style.small(), self.style.faint());
        self.taken.write(&self.painter, self.rect, look, places);
    }

    /// Draws the bent flexures. Returns the height of the middle of the body, the text on the scale, the
    /// points per m along the flexures and the lines of the lower feet. `None` if there are no flexures.
    fn bent(&mut self, context: &mut ViewContext<'_>, x: f64) -> Option<(f32, String, f32, Vec<Vec<Pos2>>)> {
        let (bent, rect, DrawingArea { top, bottom, .. }) = (state_at(context, x)?, self.rect, self.area);
        let mechanism = &context.drawn.model(context.session).mechanism();
        let geometry = mechanism.flexures.as_ref()?.geometry();
        let scale = DrawingScale::of(geometry, self.area);
        let reach = mechanism.landscape.right_stable().map_or(0.0, |well| well.x.abs());
        if context.filled
            && let Some(span) = scale.true_span(reach, rect)
        {
            context.span = span;
        }
        self.clamp(top - CLAMP..=top, true);
        self.clamp(bottom..=bottom + CLAMP, false);
        let lines = scale.lines(geometry, &bent, context.span, rect);
        let feet = lines[0].iter().map(|line| line[..line.len() / FOOT].to_vec()).collect();
        for line in lines.into_iter().flatten() {
            self.painter.add(Shape::line(line.clone(), self.style.flexure_stroke()));
            self.taken.lines.push(line);
        }
        let corner = pos2(rect.right() - 18.0, bottom - 8.0);
        self.taken.places.extend(scale.bar(&self.painter, &self.style, corner));
        Some((scale.middle(&bent), scale.words(context.span, rect), scale.along as f32, feet))
    }

    /// Writes the bulge of the flexures in the lower left corner, where nothing is drawn.
    fn bulge_ui(&mut self, ui: &Ui, context: &ViewContext<'_>) {
        let has_flexures = context.drawn.model(context.session).mechanism().flexures.is_some();
        let Some(bent) = context.memory.drawing.bent.as_ref().filter(|_| has_flexures) else { return };
        let (look, words) = ((self.style.body(), self.style.ink()), bulge_words(bent));
        let corner = pos2(self.rect.left() + 12.0, self.area.bottom - 5.0);
        let place = (words.as_str(), corner, Align2::LEFT_BOTTOM);
        if let Some(place) = self.taken.write(&self.painter, self.rect, look, [place]) {
            explain(ui, place, &words);
        }
    }

    /// Draws the push -m a_b on the mass as an arrow at the height `y`, relative to the largest push, on the
    /// inner side of the body.
    fn push_arrow(&self, context: &ViewContext<'_>, body: Rect, y: f32, base_accel: f64) {
        let model = context.drawn.model(context.session);
        let full = f64::from(self.rect.width()) * 0.16;
        let room = model.largest_base_acceleration().max(1e-9);
        let push = (-base_accel / room * full) as f32;
        if !model.is_shaken() || push.abs() <= 3.0 {
            return;
        }
        let zero = context.span.screen_from_world(0.0, self.rect);
        let inner = if body.center().x > zero { -1.0 } else { 1.0 };
        let near = body.center().x + inner * (body.width() * 0.5 + BESIDE_BODY);
        let far = near + inner * push.abs();
        let stroke = self.style.arrow_stroke();
        let (tail, tip) = if push * inner > 0.0 { (near, far) } else { (far, near) };
        let head = ARROW_HEAD.min(push.abs()) * push.signum();
        self.painter.line_segment([pos2(tail, y), pos2(tip - 0.5 * head, y)], stroke);
        let points = vec![pos2(tip, y), pos2(tip - head, y - 6.0), pos2(tip - head, y + 6.0)];
        self.painter.add(Shape::convex_polygon(points, stroke.color, Stroke::NONE));
    }

    /// Writes the row above the drawing: age, frame of reference, scale, push and motion of the base.
    fn caption_ui(&self, ui: &Ui, context: &ViewContext<'_>, words: &str, base_accel: f64) {
        let Self { painter, rect, style, .. } = self;
        let model = context.drawn.model(context.session);
        let is_pushed = context.drawn.is_pushed(context.session);
        let mut all = vec![(words.to_owned(), style.faint(), 1)];
        if !is_pushed {
            all.insert(0, ("seen from the base".to_owned(), style.faint(), 0));
        }
        if let Some(ago) = ago(context.session) {
            all.insert(0, (ago, style.ink(), 2));
        }
        if model.is_shaken() {
            let (factor, unit) = if is_pushed { (model.mass(), "N") } else { (1.0 / STANDARD_GRAVITY, "g") };
            // two decimals, or more for a push below 0.1
            let largest = model.largest_base_acceleration() * factor;
            let decimals = if largest < 0.1 { decimals_for(largest) } else { 2 };
            let push = base_accel.abs() * factor;
            all.push((format!("push {push:.decimals$} {unit}"), style.base(), 3));
        }
        let width = |text: &str| painter.layout_no_wrap(text.to_owned(), style.small(), style.ink()).size().x;
        let needed = |all: &[Entry]| all.iter().map(|text| width(&text.0) + 14.0).sum::<f32>();
        let row = LegendRow::of(ui, *rect);
        // the motion of the base says from where it is seen
        let has_inset = !is_pushed && model.single_sine().is_some();
        let inset_width = if has_inset { INSET } else { 0.0 };
        if needed(&all) + inset_width > row.right - row.left - 10.0 {
            all.retain(|text| text.2 > 0);
        }
        while needed(&all) > row.right - row.left - 6.0
            && let Some(lowest) = all.iter().map(|text| text.2).min()
        {
            all.retain(|text| text.2 > lowest);
        }
        let mut at = pos2(row.left + 10.0, rect.top() + 0.5 * LegendRow::HEIGHT);
        for (text, color, _) in all {
            let place = painter.text(at, Align2::LEFT_CENTER, &text, style.small(), color);
            explain(ui, place, &text);
            at.x = place.right() + 14.0;
        }
        if has_inset {
            self.inset(ui, context, rect.with_min_x(at.x).with_max_x(row.right), base_accel);
        }
    }

    /// Draws the motion of the base at another scale, for a sine, whose displacement is -a/(2 pi f)^2.
    fn inset(&self, ui: &Ui, context: &ViewContext<'_>, rect: Rect, base_accel: f64) {
        let Some((amplitude, rate)) = context.drawn.model(context.session).single_sine() else { return };
        let (swing, place) = (amplitude / (rate * rate), -base_accel / (rate * rate));
        if !(swing > 0.0 && swing.is_finite()) || rect.width() < INSET {
            return;
        }
        let (painter, style, half) = (&self.painter, self.style, 34.0);
        let track = pos2(rect.right() - half - 20.0, rect.top() + 11.0);
        painter.line_segment([track - vec2(half, 0.0), track + vec2(half, 0.0)], style.ghost_stroke());
        let at = track + vec2((place / swing) as f32 * half, 0.0);
        painter.rect_filled(Rect::from_center_size(at, vec2(14.0, 9.0)), 2.0, style.base());
        let (size, unit) = if swing < 10.0 { (swing * 1e3, "mm") } else { (swing, "m") };
        let text = format!("base: ±{} {unit}", three(size));
        let left = track - vec2(half + 14.0, 0.0);
        let place = painter.text(left, Align2::RIGHT_CENTER, &text, style.small(), style.base());
        explain(ui, place, &text);
    }
}

fn explain(ui: &Ui, place: Rect, word: &str) {
    let id = ui.scope_id().with(("word", word.split(' ').next()));
    explained(ui.interact(place, id, Sense::hover()), word);
}

/// Starts a ring for an impact since the last frame, at most one at a time per side, and draws the rings.
fn rings(ui: &Ui, context: &mut ViewContext<'_>, rect: Rect, y: f32) {
    let now = ui.input(|input| input.time);
    let (from, to) = (context.memory.drawing.seen_to, context.session.player.time());
    context.memory.drawing.seen_to = to;
    let model = context.drawn.model(context.session);
    let (left, right) = model.stop_positions();
    if to > from && !context.reduce_motion {
        let pin = context.drawn.pin(context.session);
        let watch = pin.map_or(context.session.player.watch(), |pin| &pin.watch);
        let first = watch.events().partition_point(|event| event.t <= from);
        let scale = model.scales().speed * model.scales().speed;
        for event in watch.events().range(first..).take_while(|event| event.t <= to) {
            let side = usize::from(event.side == Side::Right);
            let busy = context.memory.drawing.rings[side].is_some_and(|ring| now - ring.began < RING_SECONDS);
            // a compliant stop dissipates energy during the contact that begins here
            let v_out = match &model.compliant() {
                Some(stop) => stop.restitution(event.v_in.abs()) * event.v_in,
                None => event.v_out,
            };
            let lost = (event.v_in * event.v_in - v_out * v_out) / scale;
            if matches!(event.kind, EventKind::Impact | EventKind::Contact) && !busy && lost > 1e-4 {
                context.memory.drawing.rings[side] = Some(Ring { began: now, size: lost.min(1.0) });
            }
        }
    }
    let style = context.style;
    let painter = ui.painter().with_clip_rect(rect);
    for (side, stop) in [left, right].into_iter().enumerate() {
        let (Some(ring), Some(stop)) = (context.memory.drawing.rings[side], stop) else { continue };
        let age = (now - ring.began) / RING_SECONDS;
        if !(0.0..1.0).contains(&age) {
            context.memory.drawing.rings[side] = None;
            continue;
        }
        let offset = if side == 0 { -BALL } else { BALL };
        let center = pos2(context.span.screen_from_world(stop, rect) + offset, y);
        let radius = (8.0 + 42.0 * ring.size.sqrt() * age) as f32;
        let color: Color32 = style.impact().gamma_multiply((1.0 - age) as f32);
        painter.circle_stroke(center, radius, Stroke::new(2.5, color));
        ui.ctx().request_repaint();
    }
}
