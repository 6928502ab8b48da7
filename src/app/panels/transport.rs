//! Transport bar: play, pause, step, events, speed, the time bar of the recorded motion, and its accuracy.

use std::collections::VecDeque;

use eframe::egui::{
    self, Align2, ComboBox, Pos2, Rect, RichText, Sense, Shape, Stroke, Ui, UiBuilder, pos2, vec2,
};

use crate::app::session::player::{Goal, SPEEDS};
use crate::app::session::{OFFER_TO_STOP, Session};
use crate::app::ui::style::Style;
use crate::app::ui::widgets::{Icon, arrows, icon_button_ui, polygon, tell};
use crate::app::words::meanings::{explained, meaning};
use crate::app::words::status::{Kind, speed};
use crate::dynamics::{Event, EventKind};

/// Time in s of the motion within which the next event is searched.
pub const EVENT_AHEAD: f64 = 5.0;

/// Widths in points of the buttons, and of the one that plays.
const BUTTON: (f32, f32) = (32.0, 40.0);
/// Width in points of the time, and where there is no row below the bar, with the note below the time.
const TIME: (f32, f32) = (72.0, 140.0);
/// Width in points of the length of the run, and for a long one of the part that the bar shows too.
const LENGTH: (f32, f32) = (48.0, 96.0);
/// Height in points of the bar with the signs of crossings above it.
const SIGNS: f32 = 28.0;
/// Height in points of the row below the bar, and of the note below the time.
const BELOW: f32 = 16.0;

/// Length in s from which on a run is long: its bar ends earlier while little of it has been seen.
const LONG: f64 = 200.0;
/// While less than this share of a long run's bar has been seen, counting at least this time in s, the length
/// of the bar is divided by the last number.
const SEEN: (f64, f64, f64) = (0.1, 5.0, 4.0);
/// Width in points of the dots behind a bar that ends before the run does.
const DOTS: f32 = 18.0;

/// Share of the bar by which an arrow key moves; with Shift, ten times as much.
const KEY_SHARE: f64 = 0.002;

/// Least interval in points of the bar of which only the first crossing is shown.
const TICK: f32 = 5.0;

/// Distance in points of the signs above the bar.
const SIGN: f32 = 11.5;
/// Distance in points of the bar from the lower end of the signs.
const BAR: f32 = 12.0;

/// Draws the transport bar; it shows no events while results are covered.
pub fn transport_ui(ui: &mut Ui, session: &mut Session, style: &Style, covered: bool) {
    // the whole bar is grey while a lesson asks what is expected
    let button_ui = |ui: &mut Ui, icon: Icon, size: f32, name: &str, hover: &str| {
        let response = icon_button_ui(ui, icon, size, name, hover);
        response.on_disabled_hover_text("First choose what you expect").clicked()
    };
    ui.horizontal_centered(|ui| {
        if button_ui(ui, Icon::Restart, BUTTON.0, "restart", "From the start again") {
            session.restart();
        }
        let previous = "To the event before: a release, a crossing, an impact (PageUp)";
        if button_ui(ui, Icon::PreviousEvent, BUTTON.0, "previous event", previous) {
            session.player.seek_event(false, EVENT_AHEAD);
        }
        let playing = session.player.is_playing();
        let (icon, name) = if playing { (Icon::Pause, "pause") } else { (Icon::Play, "play") };
        if button_ui(ui, icon, BUTTON.1, name, "Play and pause (space)") {
            session.play_or_pause();
        }
        if button_ui(ui, Icon::NextEvent, BUTTON.0, "next event", "To the next event (PageDown)") {
            session.player.seek_event(true, EVENT_AHEAD);
        }
        if button_ui(ui, Icon::Step, BUTTON.0, "step", "A little further, then stand (full stop)") {
            session.player.step();
        }
        speed_ui(ui, session);
        let (note, left) = (note(session, covered), egui::Layout::left_to_right(egui::Align::Center));
        if ui.available_height() >= SIGNS + BELOW - 2.0 {
            ui.allocate_ui_with_layout(vec2(TIME.0, SIGNS), left, |ui| clock_ui(ui, session));
            scrub_ui(ui, session, style, covered, Some(&note));
        } else {
            // at most as high as the bar
            let (place, _) = ui.allocate_exact_size(vec2(TIME.1, ui.available_height()), Sense::hover());
            let lines = egui::Layout::top_down(egui::Align::Min);
            let mut beside = ui.new_child(UiBuilder::new().max_rect(place).layout(lines));
            two_lines_ui(&mut beside, session, style, (&note, covered));
            scrub_ui(ui, session, style, covered, None);
        }
    });
}

/// Height in points of the time above a note.
const ONE_LINE: f32 = 17.0;

/// The time and, below it, the note or else the length of the run.
fn two_lines_ui(ui: &mut Ui, session: &mut Session, style: &Style, (note, covered): (&str, bool)) {
    ui.set_width(TIME.1);
    ui.spacing_mut().item_spacing.y = 0.0;
    ui.add_space((0.5 * (ui.available_height() - ONE_LINE - BELOW)).max(0.0));
    ui.spacing_mut().interact_size.y = ONE_LINE;
    let left = egui::Layout::left_to_right(egui::Align::Center);
    ui.allocate_ui_with_layout(vec2(TIME.1, ONE_LINE), left, |ui| {
        clock_ui(ui, session);
        to_present_ui(ui, session, "to now");
    });
    if !(note.is_empty() && (skip_ui(ui, session, covered) || stop_ui(ui, session))) {
        let length = format!("of {}", length_words(session));
        note_ui(ui, style, if note.is_empty() { &length } else { note });
    }
}

/// The length of the run, which may have been passed.
fn length_words(session: &Session) -> String {
    let end = session.end_of_run().max(session.player.watch().time());
    if end < 10.0 { format!("{end:.1} s") } else { format!("{end:.0} s") }
}

fn clock_ui(ui: &mut Ui, session: &Session) {
    ui.set_min_width(TIME.0);
    ui.label(format!("{:.3} s", session.player.time()));
}

fn speed_ui(ui: &mut Ui, session: &mut Session) {
    let speed = session.player.speed;
    let other = || match 1.0 / speed {
        parts if parts > 1.0 && (parts - parts.round()).abs() < 1e-9 * parts => format!("1/{parts:.0}"),
        _ => format!("{speed}"),
    };
    let name = SPEEDS.iter().find(|row| row.0 == speed).map_or_else(other, |row| row.1.to_owned());
    let combo = ComboBox::from_id_salt("speed").width(96.0).selected_text(name).show_ui(ui, |ui| {
        for (key, (value, name)) in (1..).zip(SPEEDS) {
            ui.selectable_value(&mut session.player.speed, value, format!("{name}  ({key})"));
        }
    });
    let response = combo.response.on_hover_text("Speed of the motion on the screen (keys 1 to 7)");
    tell(&response, egui::Role::ComboBox, "speed");
}

/// The time of the first crossing in every interval. The length of the intervals in s is the least power of
/// two that is not below `least`, and they begin at its multiples, so that signs do not change with time.
fn crossings(events: &VecDeque<Event>, begin: f64, end: f64, least: f64) -> Vec<f64> {
    let interval = least.max(f64::MIN_POSITIVE).log2().ceil().exp2();
    let mut last = None;
    let is_first = |t: &f64| {
        let number = Some((t / interval).floor());
        number != std::mem::replace(&mut last, number)
    };
    let all = events.iter().filter(|event| event.kind == EventKind::Crossing).map(|event| event.t);
    all.filter(|t| (begin..=end).contains(t)).filter(is_first).collect()
}

/// The sign of a crossing at `at`.
fn sign(at: Pos2, style: &Style) -> Shape {
    polygon(at, 1.0, &[(0.0, -4.0), (3.5, 0.0), (0.0, 4.0), (-3.5, 0.0)], style.kind(Kind::Interwell))
}

/// The length in s of the bar of a run of this length, of which so much has been seen: the whole run, or,
/// while little of a long run has been seen, a part of it, so that the part that has been seen is visible.
fn length_of_bar(run: f64, seen: f64) -> f64 {
    let (share, least, factor) = SEEN;
    let mut length = run;
    while run > LONG && share * length > seen.max(least) {
        length /= factor;
    }
    length.max(seen)
}

/// The run as a bar, as far as it has been seen with signs of its crossings. Dragging, or the arrow keys
/// while the bar has the focus, shows an earlier time. With a `note` the length of the run stands at the end
/// of the bar, and there is a row below it: the meaning of the signs, the accuracy, and the note.
fn scrub_ui(ui: &mut Ui, session: &mut Session, style: &Style, covered: bool, note: Option<&str>) {
    let watch = session.player.watch();
    let (begin, seen) = (watch.begin(), watch.time());
    let end = session.end_of_run().max(seen);
    let beside = if end - begin > LONG { LENGTH.1 } else { LENGTH.0 };
    let width = (ui.available_width() - if note.is_some() { beside } else { 0.0 }).max(40.0);
    let height = if note.is_some() { SIGNS + BELOW } else { SIGNS };
    let (whole, _) = ui.allocate_exact_size(vec2(width, height), Sense::hover());
    let rect = whole.with_max_y(whole.top() + SIGNS);
    let response = ui.interact(rect, ui.scope_id().with("bar"), Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::slider(true, session.player.time(), "time"));
    let span = length_of_bar(end - begin, seen - begin).max(1e-9);
    let is_whole = begin + span >= end;
    let mut bar =
        Rect::from_center_size(pos2(rect.center().x, rect.bottom() - BAR), vec2(rect.width() - 12.0, 4.0));
    if !is_whole {
        bar.max.x -= DOTS;
    }
    let screen_from_time = |t: f64| bar.left() + ((t - begin) / span) as f32 * bar.width();
    let painter = ui.painter();
    painter.rect_filled(bar, 2.0, style.track());
    painter.rect_filled(bar.with_max_x(screen_from_time(seen)), 2.0, style.edge());
    let least = f64::from(TICK / bar.width()) * span;
    let crossings = if covered { Vec::new() } else { crossings(watch.events(), begin, seen, least) };
    painter.extend(crossings.iter().map(|t| sign(pos2(screen_from_time(*t), bar.center().y - SIGN), style)));
    let mut at = pos2(bar.right() + 12.0, bar.center().y);
    if !is_whole {
        let dots = [5.0, 10.0, 15.0].map(|x| bar.right_center() + vec2(x, 0.0));
        dots.into_iter().for_each(|dot| _ = painter.circle_filled(dot, 1.5, style.edge()));
        at.x += DOTS;
    }
    if note.is_some() {
        let part = if is_whole { String::new() } else { format!("{:.0} of ", begin + span) };
        let length = part + &length_words(session);
        painter.text(at, Align2::LEFT_CENTER, length, style.small(), style.faint());
    }
    let now = pos2(screen_from_time(session.player.time()), bar.center().y);
    painter.circle(now, 7.0, style.mass(), Stroke::new(1.5, style.mass_edge()));
    let by_key = if response.has_focus() { arrows(ui, response.id) } else { 0.0 };
    if let Some(pointer) = response.interact_pointer_pos() {
        session.player.seek(begin + f64::from((pointer.x - bar.left()) / bar.width()) * span);
    } else if by_key != 0.0 {
        session.player.seek(session.player.time() + by_key * KEY_SHARE * span);
    }
    let Some(note) = note else { return };
    let below = whole.with_min_y(rect.bottom());
    let hint = if response.hovered() { "drag, or press the arrow keys, to look back" } else { "" };
    let layout = egui::Layout::right_to_left(egui::Align::Center);
    ui.scope_builder(UiBuilder::new().max_rect(below).layout(layout), |ui| {
        ui.spacing_mut().interact_size.y = BELOW;
        to_present_ui(ui, session, "past: go to now");
        if !(note.is_empty() && skip_ui(ui, session, covered)) {
            note_ui(ui, style, if note.is_empty() { hint } else { note });
        }
        ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
            if !crossings.is_empty() {
                let (place, _) = ui.allocate_exact_size(vec2(9.0, BELOW), Sense::hover());
                ui.painter().add(sign(place.center(), style));
                line_ui(ui, style, "crossing");
            }
            if !covered {
                accuracy_ui(ui, session, style);
            }
        });
    });
}

fn line_ui(ui: &mut Ui, style: &Style, text: &str) -> egui::Response {
    ui.add(egui::Label::new(RichText::new(text).small().color(style.faint())).truncate())
}

/// How accurate the motion is, whether the mass was moved, and the offer to stop computing.
fn accuracy_ui(ui: &mut Ui, session: &mut Session, style: &Style) {
    ui.spacing_mut().item_spacing.x = 12.0;
    if let Some((short, long)) = session.trust() {
        let meaning = meaning(&short).map_or_else(String::new, |meaning| format!("{meaning}\n\n"));
        line_ui(ui, style, &short).on_hover_text(format!("{meaning}{long}"));
    }
    if session.was_set_on_stop() {
        let hover = "A stop that was moved or switched on would have gone through it.";
        line_ui(ui, style, "The mass was set on the stop").on_hover_text(hover);
    }
    stop_ui(ui, session);
}

/// Offers to cancel background work that has taken long, in a link. Returns whether it does.
fn stop_ui(ui: &mut Ui, session: &mut Session) -> bool {
    let Some(worked) = session.working() else { return false };
    if worked < OFFER_TO_STOP {
        ui.ctx().request_repaint_after(OFFER_TO_STOP - worked);
        return false;
    }
    let hover = "Time spent in the background on the settled motion, on what it would take to cross and on \
                 the accuracy. The motion continues without these results; the next change starts anew.";
    let text = RichText::new(format!("Stop computing ({} s)", worked.as_secs())).small();
    ui.ctx().request_repaint_after_secs(1.0);
    if ui.link(text).on_hover_text(hover).clicked() {
        session.stop_working();
    }
    true
}

/// The note on the time that is shown: its event, or the goal.
fn note(session: &Session, covered: bool) -> String {
    let player = &session.player;
    match player.goal() {
        Some(Goal::Time(_) | Goal::Settled(_)) => "going on; any key stops".to_owned(),
        Some(Goal::First(kind, _)) => format!("looking for a {}; any key stops", kind.name()),
        None if covered => String::new(),
        None => player.event().map_or_else(String::new, event_words),
    }
}

fn note_ui(ui: &mut Ui, style: &Style, note: &str) {
    if !note.is_empty() {
        let text = RichText::new(note).small().color(style.faint());
        explained(ui.add(egui::Label::new(text).truncate()), note);
    }
}

/// A link back to the present, if the past is shown.
fn to_present_ui(ui: &mut Ui, session: &mut Session, text: &str) {
    let hover = "The past is shown, with the shaking and the stops of that time. A click goes back to now.";
    let is_past = session.player.is_past();
    if is_past && ui.link(RichText::new(text).small()).on_hover_text(hover).clicked() {
        session.player.to_present();
    }
}

/// Least time in s that can be skipped.
const LEAST_SKIPPED: f64 = 0.05;

/// A link to the time from which on the motion has settled, while it settles. Returns whether there is one.
fn skip_ui(ui: &mut Ui, session: &mut Session, covered: bool) -> bool {
    let settling = session.settling().filter(|_| !covered && !session.player.is_past());
    let settling = settling.filter(|(gone, whole)| whole - gone >= LEAST_SKIPPED);
    let Some((gone, whole)) = settling else { return false };
    let hover = "What is left until the motion has settled after your last change. A click goes on to there \
                 at once.";
    let text = RichText::new(format!("skip settling ({:.1} s)", whole - gone)).small();
    if ui.link(text).on_hover_text(hover).clicked() {
        let until = session.player.watch().time() + whole - gone;
        session.player.go_to(Goal::Settled(until));
    }
    true
}

fn event_words(event: &Event) -> String {
    let side = event.side.name();
    let speed = |v: f64| speed(v.abs());
    match event.kind {
        EventKind::Impact => format!("impact, {side}, {} to {} mm/s", speed(event.v_in), speed(event.v_out)),
        EventKind::Contact => format!("contact, {side}, {} mm/s", speed(event.v_in)),
        EventKind::Separate => format!("release, {side}, {} mm/s", speed(event.v_out)),
        EventKind::Rest => format!("comes to rest, {side}"),
        EventKind::Release => format!("release, {side}"),
        EventKind::Crossing => format!("crossing to the {side}, {} mm/s", speed(event.v_out)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::Side;

    fn event(t: f64, kind: EventKind) -> Event {
        Event { t, kind, side: Side::Left, v_in: 0.0, v_out: 0.0 }
    }

    #[test]
    fn of_a_long_run_more_than_a_sliver_is_seen() {
        // a short one is whole
        assert_eq!(
            [(20.0, 0.0), (120.0, 1.0), (120.0, 150.0)].map(|run| length_of_bar(run.0, run.1)),
            [20.0, 120.0, 150.0]
        );
        let run = 5236.0;
        assert_eq!(length_of_bar(run, run), run);
        let lengths: Vec<f64> = (1..5236).map(|seen| length_of_bar(run, f64::from(seen))).collect();
        for (i, length) in lengths.iter().enumerate() {
            let seen = (i + 1) as f64;
            assert!(seen <= *length && (seen < 5.0 || seen >= 0.1 * length), "{seen} of {length}");
        }
        // it grows at times, and is never shorter again
        assert!(lengths.is_sorted());
        assert_eq!(lengths.windows(2).filter(|pair| pair[0] != pair[1]).count(), 4);
    }

    #[test]
    fn crossings_keep_their_distance() {
        let kinds = [EventKind::Impact, EventKind::Release, EventKind::Crossing, EventKind::Crossing];
        let all = (0..4000).map(|i| event(f64::from(i) * 0.01, kinds[i as usize % 4]));
        let all: VecDeque<Event> = all.collect();
        let few = crossings(&all, 0.0, 40.0, 0.3);
        // one in each interval of half a second
        assert_eq!(few.len(), 80);
        assert!(few.windows(2).all(|pair| pair[1] - pair[0] > 0.3));
        // later they are the same
        let later = crossings(&all, 3.2, 40.0, 0.4);
        assert!(later.iter().skip(1).all(|t| few.contains(t)));
        // a lone one is seen
        let lone: VecDeque<Event> = [event(7.0, EventKind::Crossing)].into();
        assert_eq!(crossings(&lone, 0.0, 1e9, 1.0), [7.0]);
        assert!(crossings(&VecDeque::new(), 0.0, 1.0, 0.1).is_empty());
    }
}
