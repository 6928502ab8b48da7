//! Time: play, pause, step, go to events, choose a speed, and scrub through what has been seen.

use std::collections::VecDeque;

use eframe::egui::{self, ComboBox, Rect, RichText, Sense, Stroke, Ui, pos2, vec2};

use crate::dynamics::{Event, EventKind};

use super::player::SPEEDS;
use super::session::Session;
use super::style::Style;
use super::widgets::{Icon, icon_button_ui};

/// How far ahead in s of the motion an event is looked for.
pub const EVENT_AHEAD: f64 = 5.0;

/// Size of a button in points.
const BUTTON: f32 = 32.0;

/// Room in points for the time, and for a way back from the past.
const TIME: f32 = 196.0;

/// Least distance in points between two ticks of events, of a few.
const TICK: f32 = 5.0;

/// The most events that are looked at for one tick.
const MOST_EVENTS: usize = 64;

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

/// One event for every stretch of time that has some, at least `least` seconds long: a crossing before a release, a
/// release before an impact, and of several the first. The stretches are powers of two of a second and begin at
/// multiples of themselves, so that the ticks stay while time goes on.
fn ticks(events: &VecDeque<Event>, begin: f64, end: f64, least: f64) -> Vec<Event> {
    let stretch = least.max(f64::MIN_POSITIVE).log2().ceil().exp2();
    let rank = |event: &Event| match event.kind {
        EventKind::Crossing => 0,
        EventKind::Release => 1,
        EventKind::Impact | EventKind::Rest | EventKind::Contact | EventKind::Separate => 2,
    };
    let mut shown = Vec::new();
    let mut number = (begin / stretch).floor();
    while number * stretch <= end {
        let first = events.partition_point(|event| event.t < number * stretch);
        let Some(next) = events.get(first) else { break };
        // over stretches with nothing in them
        number = (next.t / stretch).floor().max(number) + 1.0;
        let own = events.range(first..).take_while(|event| event.t < number * stretch);
        shown.extend(own.take(MOST_EVENTS).min_by_key(|event| rank(event)));
    }
    shown
}

/// The remembered past as a bar with a tick for every event; dragging looks at it.
fn scrub_ui(ui: &mut Ui, session: &mut Session, style: &Style) -> bool {
    let width = (ui.available_width() - TIME).max(40.0);
    let (rect, response) = ui.allocate_exact_size(vec2(width, BUTTON), Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::slider(true, session.player.time(), "time"));
    let watch = session.player.watch();
    let (begin, end) = (watch.begin(), watch.time());
    let span = (end - begin).max(1e-9);
    let bar = Rect::from_center_size(rect.center(), vec2(rect.width() - 12.0, 5.0));
    let screen_from_time = |t: f64| bar.left() + ((t - begin) / span) as f32 * bar.width();
    let painter = ui.painter();
    painter.rect_filled(bar, 2.0, style.grid());
    for event in ticks(watch.events(), begin, end, f64::from(TICK / bar.width()) * span) {
        let (color, height) = match event.kind {
            EventKind::Crossing => (style.kind(super::status::Kind::Interwell), 9.0),
            EventKind::Release => (style.stop(), 7.0),
            _ => (style.faint(), 5.0),
        };
        let x = screen_from_time(event.t);
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
    ui.label(format!("{:.3} s", session.player.time()));
    if session.player.is_past() {
        let text = RichText::new("past: go to now").small();
        let hover =
            "The past is shown, with the shaking and the stops that were then. A click goes back to now.";
        if ui.button(text).on_hover_text(hover).clicked() {
            session.player.to_present();
            changed = true;
        }
    }
    changed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::Side;

    fn event(t: f64, kind: EventKind) -> Event {
        Event { t, kind, side: Side::Left, v_in: 0.0, v_out: 0.0 }
    }

    #[test]
    fn ticks_keep_their_distance_and_their_order() {
        let kinds = [EventKind::Impact, EventKind::Impact, EventKind::Release, EventKind::Crossing];
        let all = (0..4000).map(|i| event(f64::from(i) * 0.01, kinds[i as usize % 4]));
        let all: VecDeque<Event> = all.collect();
        let few = ticks(&all, 0.0, 40.0, 0.3);
        // stretches of half a second, a crossing in each
        assert_eq!(few.len(), 80);
        assert!(few.iter().all(|event| event.kind == EventKind::Crossing));
        assert!(few.windows(2).all(|pair| pair[1].t - pair[0].t > 0.3));
        // later they are the same
        let later = ticks(&all, 3.2, 40.0, 0.4);
        assert!(later.iter().skip(1).all(|event| few.contains(event)));
        // a lone impact is seen
        let lone: VecDeque<Event> = [event(7.0, EventKind::Impact)].into();
        assert_eq!(ticks(&lone, 0.0, 1e9, 1.0).len(), 1);
        assert!(ticks(&VecDeque::new(), 0.0, 1.0, 0.1).is_empty());
    }
}
