//! View of the mechanism as a drawing in the frame of the base, on the x axis of the well.
//!
//! The geometry is that of the pictures on paper ([`Assembly`]), with what is alive over it: the mass and the
//! stops, which a hand moves, the reference, and a ring at an impact, whose size shows the energy that
//! it takes. The base stands still, and its push on the mass is an arrow; the motion of the base is far
//! larger than the travel and is drawn in an inset at another scale.

use std::sync::Arc;

use eframe::egui::{self, Align2, Color32, Painter, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};

use crate::app::session::Session;
use crate::app::ui::style::{RING_SECONDS, Style};
use crate::app::words::capital;
use crate::app::words::meanings::explained;
use crate::app::words::numbers::{decimals_for, three};
use crate::app::words::parts::{part_words, schematic_words};
use crate::dynamics::{EventKind, Model, STANDARD_GRAVITY, Side};
use crate::mechanics::flexure::State;
use crate::output::{Area, Assembly, Frame, PlotAxis, Role, Sketch};
use crate::scene::Excitation;

use super::ghosts::{dashed, edges, ghost};
use super::labels::ago;
use super::mass::{OUTLINE, body_ui, was_dragged};
use super::memory::Ring;
use super::pane::{LEGEND_LEFT, UNIT, on_screen, paint};
use super::stops::{BEST_STOPS, asked_place, best_stops, stops_ui};
use super::{Cover, LegendRow, Span, ViewContext};

/// Height in points above and below the drawing.
const AROUND: (f32, f32) = (20.0, 4.0);

/// Smallest travel in points that is drawn at true scale.
const MIN_TRAVEL: f64 = 60.0;

/// Length in points of the dashed sample of the best stops.
const SAMPLE: f32 = 22.0;

/// Width in points that the inset with the motion of the base needs.
const INSET: f32 = 102.0;

pub fn mechanism_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
    // above the picture of the well; a true scale changes the x axis of this view only
    let shared = context.span;
    context.span = shared.beside(context.memory.drawing.beside, rect);
    let about = drawing_ui(ui, context, rect);
    context.span = shared;
    if !about.is_empty() {
        response.on_hover_text(about);
    }
}

/// Draws the mechanism. Returns the scale, the bulge and the motion of the base in words.
fn drawing_ui(ui: &mut Ui, context: &mut ViewContext<'_>, rect: Rect) -> String {
    let (style, state) = (context.style, context.session.player.state());
    let painter = ui.painter().with_clip_rect(rect);
    let bent = state_at(context, state.x);
    let model = Arc::clone(context.session.shown());
    let ends = (context.span.low, context.span.high);
    let mut assembly = Assembly::of(&model, state.x, bent.as_ref(), ends).pushed(&model, state.base_accel);
    assembly.outlined = best_stops(context).map(|mm| mm * 1e-3);
    let unit = |points: f32| f64::from(points / UNIT);
    let area = Area::new(0.0, unit(AROUND.0), unit(rect.width()), unit(rect.height() - AROUND.1));
    let along = assembly.along(area).map(|along| along * f64::from(UNIT));
    if context.filled
        && let Some(along) = along
    {
        let reach = model.mechanism().landscape.right_stable().map_or(0.0, |well| well.x.abs());
        context.span = true_span(along, reach, rect).unwrap_or(context.span);
    }
    let axis = |low: f64, high: f64| PlotAxis::given(low, high, Vec::new(), "");
    let x = axis(context.span.low * 1e3, context.span.high * 1e3);
    let is_alone = context.session.reference.apart().is_none();
    let is_new = !was_dragged(ui) && context.cover == Cover::None && is_alone;
    let asked = asked_place(context, state.x);
    let name = match (is_new, asked) {
        (true, _) => "mass: drag me",
        (false, None) => "mass",
        // the stop that is asked about may stand there
        (false, Some(_)) => "",
    };
    let sketch = assembly.sketch(&Frame { area, x, y: axis(0.0, 1.0) }, &style.theme(), name, None);
    let body = on_screen(rect.min, sketch.mass);
    let Sketch { behind, before, parts, stop_ends: (top, bottom), .. } = sketch;
    let heights = (rect.top() + top as f32 * UNIT, rect.top() + bottom as f32 * UNIT);
    paint(&painter, &style, rect.min, behind);
    for (part, area) in parts {
        let place = on_screen(rect.min, area);
        let id = ui.scope_id().with(("part", part as usize));
        let hovered = ui.interact(place.expand(2.0), id, Sense::hover());
        hovered.on_hover_text(part_words(part, &assembly));
    }
    if let Some(ghost) = ghost(context) {
        let walls = rect.with_min_y(heights.0).with_max_y(heights.1);
        ghost.stops(&painter, context, walls, 0.5 * body.width());
        let x = context.span.screen_from_world(ghost.state.x, rect);
        let at = Rect::from_center_size(pos2(x, body.center().y), body.size());
        ghost.outline(&painter, &style, &edges(at));
    }
    // over the reference
    let edge = Stroke::new(1.5, style.mass_edge());
    painter.rect(body, 3.0, style.mass(), edge, egui::StrokeKind::Inside);
    stops_ui(ui, context, rect, heights, (0.5 * body.width(), false));
    if let Some(x) = asked {
        let at = pos2(context.span.screen_from_world(x, rect), body.center().y);
        painter.extend(dashed(&edges(Rect::from_center_size(at, body.size())), edge));
    }
    // dots, by which it can be dragged
    for (i, j) in (-1..=1).flat_map(|i| [(i, -1), (i, 1)]) {
        let at = body.center() + vec2(3.0 * j as f32, 6.0 * i as f32);
        painter.circle_filled(at, 1.5, style.mass_edge());
    }
    if body_ui(ui, context, (body.center(), body), rect) {
        let stroke = style.pointing_stroke();
        painter.rect_stroke(body.expand(OUTLINE), 5.0, stroke, egui::StrokeKind::Middle);
    }
    rings(ui, context, rect, body);
    paint(&painter, &style, rect.min, before);
    let schematic = along.is_none().then(|| schematic_words(model.mechanism(), &assembly));
    let caption = Caption { painter, rect, style };
    caption.caption_ui(ui, context, schematic, state.base_accel);
    let scale = along.map(|along| scale_words(context.span.scale(rect) / along));
    let bulge = assembly.bulge().map(|words| format!("{}.", capital(&words)));
    let base = swing(&model).filter(|_| !is_pushed(context.session)).map(|swing| {
        let (size, unit) = if swing < 10.0 { (swing * 1e3, "mm") } else { (swing, "m") };
        format!("The base moves by ±{} {unit}, drawn at another scale.", three(size))
    });
    [scale, bulge, base].into_iter().flatten().collect::<Vec<_>>().join("\n")
}

/// Whether a force on the mass drives it, while the base stands still.
fn is_pushed(session: &Session) -> bool {
    matches!(session.scene().excitation, Excitation::Force { .. })
}

/// The amplitude in m of a base that moves in a sine.
fn swing(model: &Model) -> Option<f64> {
    let (amplitude, rate) = model.single_sine()?;
    Some(amplitude / (rate * rate)).filter(|swing| *swing > 0.0 && swing.is_finite())
}

/// Shape of the flexures with the mass at `x` in m, or the last known shape if the solver fails. The solver
/// runs once per frame (less than a tenth of a millisecond), so that no shape is interpolated and the bulge
/// vanishes where it should.
fn state_at(context: &mut ViewContext<'_>, x: f64) -> Option<State> {
    let mechanism = &context.session.shown().mechanism();
    let flexures = mechanism.flexures.as_ref()?;
    let (low, high) = mechanism.curve.domain();
    if let Ok(state) = flexures.state(x.clamp(low, high)) {
        context.memory.drawing.bent = Some(state);
    }
    context.memory.drawing.bent.clone()
}

/// The x axis over `rect` with `along` points to a m, as along the flexures. `None` if the travel would be
/// too small or does not fit.
fn true_span(along: f64, reach: f64, rect: Rect) -> Option<Span> {
    let half = 0.5 * f64::from(rect.width()) / along;
    (reach * along >= MIN_TRAVEL && half > 1.1 * reach).then_some(Span { low: -half, high: half })
}

/// The ratio of the scales across and along the flexures, as text.
fn scale_words(stretch: f64) -> String {
    match stretch {
        s if (s - 1.0).abs() < 0.02 => "At true scale.".to_owned(),
        s if s < 9.95 => format!("Stretched {s:.1}× across the flexures."),
        s => format!("Stretched {s:.0}× across the flexures."),
    }
}

/// A text of the row above the drawing, its colour and its priority: the lowest is left out first.
type Entry = (String, Color32, u8);

/// The row above the drawing.
struct Caption {
    painter: Painter,
    rect: Rect,
    style: Style,
}

impl Caption {
    /// Writes the row above the drawing: age, frame of reference, what is no drawing of the mechanism, push
    /// and motion of the base.
    fn caption_ui(&self, ui: &Ui, context: &ViewContext<'_>, schematic: Option<String>, base_accel: f64) {
        let Self { painter, rect, style, .. } = self;
        let model = context.session.shown();
        let is_pushed = is_pushed(context.session);
        let mut all: Vec<Entry> = schematic.into_iter().map(|words| (words, style.faint(), 1)).collect();
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
        if best_stops(context).is_some() {
            all.push((BEST_STOPS.to_owned(), style.faint(), 4));
        }
        let sample = |text: &str| if text == BEST_STOPS { SAMPLE + 5.0 } else { 0.0 };
        // as wide with any digits, so that nothing comes and goes with a number
        let width = |text: &str| {
            let text = text.replace(|c: char| c.is_ascii_digit(), "0");
            painter.layout_no_wrap(text, style.small(), style.ink()).size().x
        };
        let needed =
            |all: &[Entry]| all.iter().map(|text| width(&text.0) + sample(&text.0) + 14.0).sum::<f32>();
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
        let left = if LegendRow::given(ui).is_some() { row.left + 10.0 } else { row.left + LEGEND_LEFT };
        let mut at = pos2(left, rect.top() + 0.5 * LegendRow::HEIGHT);
        for (text, color, _) in all {
            if text == BEST_STOPS {
                let ends = [at, at + vec2(SAMPLE, 0.0)];
                painter.extend(Shape::dashed_line(&ends, style.stroke(Role::BestStop), 5.0, 4.0));
            }
            at.x += sample(&text);
            let place = painter.text(at, Align2::LEFT_CENTER, &text, style.small(), color);
            explain(ui, place, &text);
            at.x += width(&text) + 14.0;
        }
        if has_inset {
            self.inset(model, rect.with_min_x(at.x).with_max_x(row.right), base_accel);
        }
    }

    /// Draws the motion of the base at another scale, for a sine, whose displacement is -a/(2 pi f)^2.
    fn inset(&self, model: &Model, rect: Rect, base_accel: f64) {
        let Some((swing, (_, rate))) = swing(model).zip(model.single_sine()) else { return };
        if rect.width() < INSET {
            return;
        }
        let (painter, style, half) = (&self.painter, self.style, 34.0);
        let track = pos2(rect.right() - half - 20.0, rect.top() + 11.0);
        painter.line_segment([track - vec2(half, 0.0), track + vec2(half, 0.0)], style.ghost_stroke());
        let place = -base_accel / (rate * rate);
        let at = track + vec2((place / swing) as f32 * half, 0.0);
        painter.rect_filled(Rect::from_center_size(at, vec2(14.0, 9.0)), 2.0, style.base());
    }
}

fn explain(ui: &Ui, place: Rect, word: &str) {
    let id = ui.scope_id().with(("word", word.split(' ').next()));
    explained(ui.interact(place, id, Sense::hover()), word);
}

/// Starts a ring for an impact since the last frame, at most one at a time per side, and draws the rings.
fn rings(ui: &Ui, context: &mut ViewContext<'_>, rect: Rect, body: Rect) {
    let now = ui.input(|input| input.time);
    let (from, to) = (context.memory.drawing.seen_to, context.session.player.time());
    context.memory.drawing.seen_to = to;
    let model = context.session.shown();
    let (left, right) = model.stop_positions();
    if to > from && !context.reduce_motion {
        let watch = context.session.player.watch();
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
        let offset = if side == 0 { -0.5 } else { 0.5 } * body.width();
        let center = pos2(context.span.screen_from_world(stop, rect) + offset, body.center().y);
        let radius = (8.0 + 42.0 * ring.size.sqrt() * age) as f32;
        let color: Color32 = style.impact().gamma_multiply((1.0 - age) as f32);
        painter.circle_stroke(center, radius, Stroke::new(2.5, color));
        ui.ctx().request_repaint();
    }
}
