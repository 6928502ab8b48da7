//! Time: play, pause, step, go to events, choose a speed, and scrub through what has been seen.

use eframe::egui::{self, Color32, ComboBox, Rect, Sense, Stroke, Ui, pos2, vec2};

use crate::dynamics::EventKind;

use super::player::SPEEDS;
use super::session::Session;
use super::style::Style;
use super::widgets::{Icon, icon_button_ui};

/// How far ahead in s of the motion an event is looked for.
pub const EVENT_AHEAD: f64 = 5.0;

/// Size of a button in points.
const BUTTON: f32 = 32.0;

/// The most events that are looked at for their ticks.
const MOST_TICKS: usize = 2000;

/// Draws the transport. Whether something changed.
pub fn transport_ui(ui: &mut Ui, session: &mut Session, style: &Style) -> bool {
    ui.horizontal_centered(|ui| {
        let mut changed = false;
        if icon_button_ui(ui, Icon::Restart, BUTTON, "restart", "From the start again").clicked() {
            session.restart();
            changed = true;
        }
        let previous = "To the event before: a release, a crossing, an impact (PageUp)";
        if icon_button_ui(ui, Icon::PreviousEvent, BUTTON, "previous event", previous).clicked() {
            changed |= session.player.seek_event(false, EVENT_AHEAD);
        }
        let playing = session.player.is_playing();
        let (icon, name) = if playing { (Icon::Pause, "pause") } else { (Icon::Play, "play") };
        let button = icon_button_ui(ui, icon, BUTTON + 6.0, name, "Play and pause (space)");
        if button.clicked() {
            session.player.set_playing(!playing);
            changed = true;
        }
        let next = "To the next event (PageDown)";
        if icon_button_ui(ui, Icon::NextEvent, BUTTON, "next event", next).clicked() {
            changed |= session.player.seek_event(true, EVENT_AHEAD);
        }
        if icon_button_ui(ui, Icon::Step, BUTTON, "step", "A little further, then stand (full stop)")
            .clicked()
        {
            session.player.step();
            changed = true;
        }
        changed |= speed_ui(ui, session);
        changed | scrub_ui(ui, session, style)
    })
    .inner
}

fn speed_ui(ui: &mut Ui, session: &mut Session) -> bool {
    let speed = session.player.speed;
    let name =
        SPEEDS.iter().find(|own| own.0 == speed).map_or_else(|| format!("{speed}"), |own| own.1.to_owned());
    let mut changed = false;
    let combo = ComboBox::from_id_salt("speed").width(96.0).selected_text(name).show_ui(ui, |ui| {
        for (key, (value, name)) in (1..).zip(SPEEDS) {
            let text = format!("{name}  ({key})");
            changed |= ui.selectable_value(&mut session.player.speed, value, text).changed();
        }
    });
    let response = combo.response.on_hover_text("Speed of the motion on the screen (keys 1 to 5)");
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ComboBox, true, "speed"));
    changed
}

/// The remembered past as a bar with a tick for every event; dragging looks at it.
fn scrub_ui(ui: &mut Ui, session: &mut Session, style: &Style) -> bool {
    let text_width = 92.0;
    let width = (ui.available_width() - text_width).max(40.0);
    let (rect, response) = ui.allocate_exact_size(vec2(width, BUTTON), Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::slider(true, session.player.time(), "time"));
    let watch = session.player.watch();
    let (begin, end) = (watch.begin(), watch.time());
    let span = (end - begin).max(1e-9);
    let bar = Rect::from_center_size(rect.center(), vec2(rect.width() - 12.0, 5.0));
    let screen_from_time = |t: f64| bar.left() + ((t - begin) / span) as f32 * bar.width();
    let painter = ui.painter();
    painter.rect_filled(bar, 2.0, style.grid());
    let events = watch.events();
    let stride = (events.len() / MOST_TICKS).max(1);
    let mut ticks: Vec<(f32, f32, Color32)> = Vec::new();
    for event in events.iter().step_by(stride) {
        let x = screen_from_time(event.t);
        let (color, height) = match event.kind {
            EventKind::Crossing => (style.kind(super::status::Kind::Interwell), 9.0),
            EventKind::Release => (style.stop(), 7.0),
            _ => (style.faint(), 5.0),
        };
        match ticks.last_mut() {
            // of those within a point the highest is seen
            Some(last) if x - last.0 < 1.0 => {
                if height > last.1 {
                    (last.1, last.2) = (height, color);
                }
            }
            _ => ticks.push((x, height, color)),
        }
    }
    for (x, height, color) in ticks {
        painter.vline(x, bar.top() - height..=bar.top(), Stroke::new(1.0, color));
    }
    let now = pos2(screen_from_time(session.player.time()), bar.center().y);
    painter.circle(now, 7.0, style.mass(), Stroke::new(1.5, style.mass_edge()));
    let mut changed = false;
    if let Some(pointer) = response.interact_pointer_pos() {
        let t = begin + f64::from((pointer.x - bar.left()) / bar.width()) * span;
        session.player.seek(t);
        changed = true;
    }
    response.on_hover_text("What has been seen: drag to look at it again. Ticks are events.");
    let past = if session.player.is_past() { " (past)" } else { "" };
    ui.label(format!("{:.3} s{past}", session.player.time()));
    changed
}
