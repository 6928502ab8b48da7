//! Small widgets: dialogs, hover texts, icons, the shapes of regimes.

use eframe::egui::containers::menu::{MenuButton, MenuConfig};
use eframe::egui::text::{LayoutJob, TextFormat};
use eframe::egui::{
    self, Color32, FontFamily, FontId, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, Vec2, pos2, vec2,
};

use crate::app::words::kind::Kind;
use crate::app::words::numbers::unbroken;

use super::style::{BODY, CONTROL, LEAST, NARROW_BELOW, STATUS, Style};

/// A dialog at most `width` points wide, with its contents below a heading. Returns the value of the
/// contents, and whether the dialog was closed by a key or by a click beside it.
pub fn dialog_ui<R>(
    ui: &Ui,
    (id, width): (&str, f32),
    (heading, space): (impl Into<egui::RichText>, f32),
    contents: impl FnOnce(&mut Ui) -> R,
) -> (R, bool) {
    let frame = egui::Frame::popup(&ui.ctx().global_style()).inner_margin(16.0);
    let answer = egui::Modal::new(egui::Id::unique(id)).frame(frame).show(ui.ctx(), |ui| {
        ui.set_max_width((ui.ctx().content_rect().width() - 60.0).clamp(60.0, width));
        ui.label(heading.into().heading().size(STATUS));
        ui.add_space(space);
        contents(ui)
    });
    let is_closed = answer.should_close();
    (answer.inner, is_closed)
}

/// A menu that stays open until there is a click beside it, with widgets as they are outside of menus: the
/// style of menus would hide that numbers can be typed. Returns its button.
pub fn choices_ui(ui: &mut Ui, name: &str, contents: impl FnOnce(&mut Ui)) -> Response {
    let config = MenuConfig::new().close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside);
    let menu = MenuButton::new(name).config(config).ui(ui, |ui| {
        *ui.style_mut() = (*ui.ctx().global_style()).clone();
        contents(ui);
    });
    menu.0
}

/// The frame of a panel, with margins in points. It has no fill: the window is cleared to that colour, and a
/// processor that paints would fill every pixel twice.
pub fn panel_frame(x: i8, y: i8) -> egui::Frame {
    egui::Frame::new().inner_margin(egui::Margin::symmetric(x, y))
}

/// A panel with this frame and no line beside it.
pub fn bare(panel: egui::Panel, x: i8, y: i8) -> egui::Panel {
    panel.frame(panel_frame(x, y)).show_separator_line(false)
}

/// A text in parts: code between backticks has letters of one width.
pub fn prose(text: &str) -> Vec<(&str, FontFamily)> {
    let family =
        |i: usize| if i.is_multiple_of(2) { FontFamily::Proportional } else { FontFamily::Monospace };
    text.split('`').enumerate().map(|(i, part)| (part, family(i))).collect()
}

/// A label of a text with code between backticks.
pub fn prose_ui(ui: &mut Ui, text: &str) {
    parts_ui(ui, &prose(text), BODY);
}

/// The height in points that such a label takes.
pub fn prose_height(ui: &Ui, text: &str, width: f32) -> f32 {
    taken(ui, &prose(text), BODY, width).y
}

/// Gives a widget its role and its name for screen readers.
pub fn tell(response: &Response, role: egui::Role, name: &str) {
    response.widget_info(|| egui::WidgetInfo::labeled(role, true, name));
}

/// The width and the height in points of texts one after another, wrapped at `width`.
fn taken(ui: &Ui, texts: &[(&str, FontFamily)], size: f32, width: f32) -> Vec2 {
    let mut job = job(texts, size, Color32::PLACEHOLDER);
    job.wrap.max_width = width;
    ui.fonts_mut(|fonts| fonts.layout_job(job)).size()
}

/// Texts one after another, in these fonts; lines are not broken between a number and its unit.
fn job(parts: &[(&str, FontFamily)], size: f32, ink: Color32) -> LayoutJob {
    let mut job = LayoutJob::default();
    for (text, family) in parts {
        job.append(&unbroken(text), 0.0, TextFormat::simple(FontId::new(size, family.clone()), ink));
    }
    job
}

/// A label of texts one after another, in these fonts; a screen reader is told their words.
pub fn parts_ui(ui: &mut Ui, parts: &[(&str, FontFamily)], size: f32) -> Response {
    let response = ui.add(egui::Label::new(job(parts, size, ui.visuals().text_color())).wrap());
    tell(&response, egui::Role::Label, &parts.iter().map(|part| part.0).collect::<String>());
    response
}

/// The text size at which texts fit into `room` one after another: `largest` in one row, or else the size of
/// body text in several rows, or less where they would not fit.
///
/// Returns the size, and the height in points that they take.
pub fn fitting(ui: &Ui, texts: &[(&str, FontFamily)], room: Vec2, largest: f32) -> (f32, f32) {
    let in_a_row = taken(ui, texts, largest, f32::INFINITY);
    if in_a_row.x <= room.x {
        return (largest, in_a_row.y);
    }
    let mut size = BODY.min(largest);
    while size > LEAST && taken(ui, texts, size, room.x).y > room.y {
        size -= 0.5;
    }
    (size, taken(ui, texts, size, room.x).y)
}

/// Shows a hover text beside its widget where the window has a column of controls, since below it would cover
/// the next one. After an input on the widget it stays hidden until the pointer has left and come back.
pub fn hover_beside(response: Response, text: &str) -> Response {
    if !response.enabled() {
        return response.on_disabled_hover_text(text);
    }
    let hidden = egui::Id::unique("hidden hover text");
    let is_hidden = || response.ctx.data(|data| data.get_temp(hidden)) == Some(response.id);
    if response.changed() || response.dragged() || response.is_pointer_button_down_on() {
        response.ctx.data_mut(|data| data.insert_temp(hidden, response.id));
    } else if is_hidden() && !response.contains_pointer() {
        response.ctx.data_mut(|data| data.remove::<egui::Id>(hidden));
    }
    if is_hidden() {
        return response;
    }
    if response.ctx.content_rect().width() < NARROW_BELOW {
        return response.on_hover_text(text);
    }
    let mut tooltip = egui::Tooltip::for_enabled(&response);
    tooltip.popup = tooltip.popup.align(egui::RectAlign::RIGHT_START);
    tooltip.show(|ui| ui.label(text));
    response
}

/// Gives a widget the keyboard focus if no other one has it.
pub fn focus_first(ui: &Ui, widget: &Response) {
    if ui.memory(|memory| memory.focused().is_none()) {
        widget.request_focus();
    }
}

/// The button that closes a message; it takes a free keyboard focus, so that Enter closes the message.
pub fn close_ui(ui: &mut Ui) -> bool {
    let button = ui.button("Close");
    focus_first(ui, &button);
    button.clicked()
}

/// Has the left and right keys, or all arrow keys, stay with a widget instead of moving the focus.
pub fn keep_arrows(ui: &Ui, id: egui::Id, all: bool) {
    let filter = egui::EventFilter { horizontal_arrows: true, vertical_arrows: all, ..Default::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(id, filter));
}

/// Steps to the right by the arrow keys, ten times as many with Shift; the keys do not move the focus.
pub fn arrows(ui: &Ui, id: egui::Id) -> f64 {
    keep_arrows(ui, id, false);
    ui.input(|input| {
        let presses = |key| f64::from(u32::try_from(input.num_presses(key)).unwrap_or(0));
        let steps = presses(egui::Key::ArrowRight) - presses(egui::Key::ArrowLeft);
        if input.modifiers.shift { 10.0 * steps } else { steps }
    })
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Icon {
    Play,
    Pause,
    /// A bar and a triangle to the left.
    Restart,
    /// A triangle and a bar: one step.
    Step,
    PreviousEvent,
    NextEvent,
    /// A square: one view over the whole window.
    Fill,
    /// Four squares: all views again.
    Restore,
    /// Two axes and a line: a figure of a view.
    Figure,
    Held,
    Free,
}

/// An outlined button with an icon; screen readers and tests call it `name`.
pub fn icon_button_ui(ui: &mut Ui, icon: Icon, width: f32, name: &str, hover: &str) -> Response {
    let (rect, response) = ui.allocate_exact_size(vec2(width, CONTROL), Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, ui.is_enabled(), name));
    let visuals = ui.style().interact(&response);
    let (corner, stroke) = (visuals.corner_radius, visuals.bg_stroke);
    ui.painter().rect(rect, corner, visuals.weak_bg_fill, stroke, egui::StrokeKind::Inside);
    ui.painter().extend(icon_shapes(icon, icon_place(rect), visuals.fg_stroke.color));
    response.on_hover_text(hover)
}

/// A button of `size` without an outline, whose icon is drawn while `shown` is set or it has the keyboard
/// focus; screen readers and tests call it `name`.
pub fn tool_ui(ui: &mut Ui, icon: Icon, size: f32, name: &str, hover: &str, shown: bool) -> Response {
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(size), Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, ui.is_enabled(), name));
    let visuals = ui.style().interact(&response);
    if response.hovered() {
        ui.painter().rect_filled(rect, visuals.corner_radius, visuals.weak_bg_fill);
    }
    if shown || response.has_focus() {
        let color = if response.hovered() { visuals.fg_stroke.color } else { ui.visuals().weak_text_color() };
        ui.painter().extend(icon_shapes(icon, icon_place(rect), color));
    }
    response.on_hover_text(hover)
}

fn icon_place(button: Rect) -> Rect {
    Rect::from_center_size(button.center(), Vec2::splat(0.48 * button.height()))
}

/// One of several choices side by side, with an outline whether or not it is chosen.
pub fn segment_ui<T: PartialEq>(ui: &mut Ui, value: &mut T, choice: T, name: &str) -> Response {
    let is_chosen = *value == choice;
    let button = ui.add(egui::Button::selectable(is_chosen, name).frame_when_inactive(true));
    if button.clicked() {
        *value = choice;
    }
    button
}

/// The button of the primary action, which is filled.
pub fn primary(ui: &Ui, text: &str) -> egui::Button<'static> {
    let style = Style::of(ui.ctx(), false);
    let text = egui::RichText::new(text).color(style.on_action());
    egui::Button::new(text).fill(style.action()).stroke(Stroke::NONE)
}

fn icon_shapes(icon: Icon, rect: Rect, color: Color32) -> Vec<Shape> {
    let triangle = |r: Rect, right: bool| {
        let (tip, back) = if right { (r.right(), r.left()) } else { (r.left(), r.right()) };
        let points = vec![pos2(tip, r.center().y), pos2(back, r.top()), pos2(back, r.bottom())];
        Shape::convex_polygon(points, color, Stroke::NONE)
    };
    let frame = |r: Rect| Shape::rect_stroke(r, 0.0, Stroke::new(1.5, color), egui::StrokeKind::Inside);
    let bar = |x: f32, width: f32| {
        let bar = Rect::from_min_max(pos2(x, rect.top()), pos2(x + width, rect.bottom()));
        Shape::rect_filled(bar, 0.0, color)
    };
    let thin = rect.width() * 0.2;
    let part = |from: f32, to: f32| {
        let x = |share: f32| rect.left() + share * rect.width();
        Rect::from_min_max(pos2(x(from), rect.top()), pos2(x(to), rect.bottom()))
    };
    let diamond = |x: f32| polygon(pos2(x, rect.center().y), rect.width() * 0.22, &DIAMOND, color);
    match icon {
        Icon::Play => vec![triangle(rect, true)],
        Icon::Pause => {
            vec![bar(rect.left() + thin * 0.5, thin * 1.4), bar(rect.right() - thin * 1.9, thin * 1.4)]
        }
        Icon::Restart => vec![bar(rect.left(), thin), triangle(part(0.25, 1.0), false)],
        Icon::Step => vec![triangle(part(0.0, 0.7), true), bar(rect.right() - thin, thin)],
        Icon::PreviousEvent => {
            vec![triangle(part(0.5, 1.0), false), diamond(rect.left() + rect.width() * 0.2)]
        }
        Icon::NextEvent => vec![triangle(part(0.0, 0.5), true), diamond(rect.right() - rect.width() * 0.2)],
        Icon::Restore => [rect.left_top(), rect.right_top(), rect.left_bottom(), rect.right_bottom()]
            .map(|corner| frame(Rect::from_two_pos(corner, rect.center() + (corner - rect.center()) * 0.24)))
            .to_vec(),
        Icon::Figure => {
            let place = |(x, y): (f32, f32)| rect.lerp_inside(vec2(x, y));
            let line = |points: &[(f32, f32)]| {
                Shape::line(points.iter().map(|point| place(*point)).collect(), Stroke::new(1.5, color))
            };
            let axes = line(&[(0.0, 0.0), (0.0, 1.0), (1.0, 1.0)]);
            vec![axes, line(&[(0.2, 0.75), (0.45, 0.3), (0.65, 0.6), (1.0, 0.1)])]
        }
        Icon::Held | Icon::Free => {
            let body = rect.with_min_y(rect.top() + 0.45 * rect.height()).shrink2(vec2(1.0, 0.0));
            let (middle, radius) = (body.center_top(), 0.3 * rect.width());
            let lift = if icon == Icon::Free { 0.2 * rect.height() } else { 0.0 };
            let arc = |i: i32| {
                let turn = std::f32::consts::PI * (1.0 + i as f32 / 8.0);
                middle + radius * Vec2::angled(turn) - vec2(0.0, 1.0 + lift)
            };
            let feet = [(-radius, 0.0), (radius, -lift)].map(|(x, y)| middle + vec2(x, y));
            let shackle = [feet[0]].into_iter().chain((0..=8).map(arc)).chain([feet[1]]).collect();
            let body = match icon {
                Icon::Held => Shape::rect_filled(body, 1.0, color),
                _ => Shape::rect_stroke(body, 1.0, Stroke::new(1.3, color), egui::StrokeKind::Inside),
            };
            vec![Shape::line(shackle, Stroke::new(1.3, color)), body]
        }
        Icon::Fill => vec![frame(rect)],
    }
}

/// The shape of a kind of motion: square, circle, diamond, double arrow; a ring where it has no name.
pub fn kind_shapes(kind: Kind, center: Pos2, radius: f32, color: Color32) -> Vec<Shape> {
    let r = radius;
    match kind {
        Kind::Other => vec![Shape::circle_stroke(center, 0.8 * r, Stroke::new(0.35 * r, color))],
        Kind::Resting => {
            vec![Shape::rect_filled(Rect::from_center_size(center, Vec2::splat(1.7 * r)), 0.0, color)]
        }
        Kind::Intrawell => vec![Shape::circle_filled(center, r, color)],
        Kind::Irregular => vec![polygon(center, 1.2 * r, &DIAMOND, color)],
        Kind::Interwell | Kind::Crossing => {
            let head = |side: f32| {
                let points = [(side * 1.4, 0.0), (side * 0.4, -0.9), (side * 0.4, 0.9)];
                polygon(center, r, &points, color)
            };
            let shaft = [center - vec2(0.6 * r, 0.0), center + vec2(0.6 * r, 0.0)];
            vec![head(-1.0), head(1.0), Shape::line_segment(shaft, Stroke::new(0.4 * r, color))]
        }
        Kind::Fault => vec![polygon(center, r, &[(0.0, -1.0), (1.1, 0.9), (-1.1, 0.9)], color)],
    }
}

pub const DIAMOND: [(f32, f32); 4] = [(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)];

/// A convex polygon: its corners, each from the centre in units of `scale` points.
pub fn polygon(center: Pos2, scale: f32, corners: &[(f32, f32)], color: Color32) -> Shape {
    let points = corners.iter().map(|(x, y)| center + scale * vec2(*x, *y)).collect();
    Shape::convex_polygon(points, color, Stroke::NONE)
}
